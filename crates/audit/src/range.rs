//! Whether strains, slips and rotations are those for which the theory holds.

use crate::finding::{Check, Finding, Outcome};
use crate::nearest::centre;
use crate::resolution::width;
use crate::samples::turns;
use crate::state::{Curve, Form, Rigid, Setting, Solid, State};
use nalgebra::Matrix3;
use rayon::prelude::*;
use signorini_geometry::bvh::Bvh;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::{Aabb, Point, Vector};

/// Where half of the cells are beyond so many times the limit, the state is none.
const FAR: f64 = 4.0;
/// Directions in which a cell is thinner than this part of its size tell nothing of a gradient.
const FLAT: f64 = 1e-3;
/// Cells smaller than this part of their place are left out.
const SMALL: f64 = 1e-7;
/// Slip against small sliding as a share of a cell, and rotation of a rigid body in radians: the pairs of points and the
/// directions of friction are off by as much.
const SLIP_TOLD: f64 = 0.1;
const SLIP_REFUSED: f64 = 1.0;
const TURN: f64 = 0.1;
/// Cells smaller than this part of the zone of contact are there for its edge: slips as long as they are change little.
const OF_ZONE: f64 = 0.25;
/// Angle between normals below which a surface is flat.
const PLANE: f64 = 1e-6;

/// Checks the bodies, and the contacts of small sliding.
pub fn check(setting: &Setting, state: &State) -> Vec<Finding> {
    let mut out = Vec::new();
    for (body, placement) in setting.bodies.iter().zip(&state.bodies) {
        let found = match &body.form {
            Form::Solid(solid) => of_solid(solid, placement.points()),
            Form::Curve(curve) => of_curve(curve, placement.points()),
            Form::Rigid(_) => None,
        };
        let Some((strain, limit, x, most_of_it)) = found else { continue };
        let outcome = match (strain > limit, most_of_it) {
            (true, true) => Outcome::Refused,
            (true, false) => Outcome::Doubt,
            _ => Outcome::Fine,
        };
        let name = &body.name;
        let message = format!("the largest strain of `{name}` is {:.2} %", 100.0 * strain);
        let finding = Finding::new(Check::Range, outcome, message).measured(strain, limit).at(x).on(name);
        out.push(match (outcome, &body.form) {
            (Outcome::Fine, _) => finding,
            (_, Form::Curve(_)) => {
                finding.remedy("use a larger section or a smaller load: the law of the section is linear")
            }
            _ => finding.remedy("use finite strain or a smaller load"),
        });
    }
    for (number, _) in setting.contacts.iter().enumerate().filter(|(_, c)| c.is_small_sliding) {
        out.extend(slip(setting, state, number));
        out.extend(rotation(setting, state, number));
    }
    out
}

/// How far a prescribed body has turned against small sliding, unless it is as it was where it touches.
fn rotation(setting: &Setting, state: &State, number: usize) -> Option<Finding> {
    let contact = &setting.contacts[number];
    let [own, other] = contact.bodies;
    let (Form::Solid(solid), Form::Rigid(rigid)) = (&setting.bodies[own].form, &setting.bodies[other].form) else {
        return None;
    };
    let motion = state.bodies[other].motion();
    let is_as_it_was = |x: &Point<3>| turns_into_itself(rigid, &motion, x, solid.largest_cell());
    let mut closed = state.contacts[number].iter().filter(|t| t.is_closed);
    if contact.law.is_none() || rigid.is_free || closed.all(|t| is_as_it_was(&t.x)) {
        return None;
    }
    let angle = nalgebra::Rotation3::from_matrix_unchecked(motion.rotation).angle();
    let outcome = if angle > TURN { Outcome::Refused } else { Outcome::Fine };
    let message =
        format!("`{}` rotates by {angle:.3} rad, but the contact is for small sliding", setting.bodies[other].name);
    let finding = Finding::new(Check::Range, outcome, message).measured(angle, TURN).on(&contact.name);
    Some(if outcome == Outcome::Fine { finding } else { finding.remedy("use sliding = \"finite\"") })
}

/// The largest principal strain of the cells, its limit, its place, and whether most cells are far beyond the limit.
fn of_solid(solid: &Solid, points: &[Point<3>]) -> Option<(f64, f64, Point<3>, bool)> {
    let limit = solid.strain_limit?;
    let strains: Vec<Option<f64>> = solid.cells.par_iter().map(|cell| strain_of(&solid.rest, points, cell)).collect();
    let most = (strains.iter().enumerate()).filter_map(|(k, s)| Some((k, (*s)?))).max_by(|a, b| a.1.total_cmp(&b.1))?;
    let far = strains.iter().flatten().filter(|s| **s > FAR * limit).count();
    Some((most.1, limit, centre(points, &solid.cells[most.0]), 2 * far > strains.len()))
}

/// The largest principal strain, by its absolute value, of the linear displacement nearest to that of the points of a cell.
fn strain_of(rest: &[Point<3>], now: &[Point<3>], cell: &[u32]) -> Option<f64> {
    let (from, to) = (centre(rest, cell), centre(now, cell));
    let (mut extent, mut moved) = (Matrix3::zeros(), Matrix3::zeros());
    for k in cell {
        let d = rest[*k as usize] - from;
        extent += d * d.transpose();
        moved += (now[*k as usize] - to - d) * d.transpose();
    }
    // What is as small as the rounding of places has no strain.
    let small = SMALL * rest[cell[0] as usize].amax();
    if extent.symmetric_eigenvalues().amax() <= small * small {
        return None;
    }
    let thin = FLAT * FLAT * extent.symmetric_eigenvalues().amax();
    let gradient: Matrix3<f64> = moved * extent.pseudo_inverse(thin.max(f64::MIN_POSITIVE)).ok()?;
    let strain = (0.5 * (gradient + gradient.transpose())).symmetric_eigenvalues().amax();
    strain.is_finite().then_some(strain)
}

/// The largest strain of a curve: of its length, and of its section by bending.
fn of_curve(curve: &Curve, points: &[Point<3>]) -> Option<(f64, f64, Point<3>, bool)> {
    let limit = curve.strain_limit?;
    let length = |list: &[Point<3>], p: &[u32; 2]| (list[p[1] as usize] - list[p[0] as usize]).norm();
    let angles = [turns(curve, &curve.rest), turns(curve, points)];
    let strain = |p: &[u32; 2]| {
        let rest = length(&curve.rest, p);
        let bent = if curve.bends { (angles[1][p[0] as usize] - angles[0][p[0] as usize]).abs() } else { 0.0 };
        if rest > 0.0 { (length(points, p) / rest - 1.0).abs() + curve.radius * bent / rest } else { 0.0 }
    };
    let most = curve.pieces.iter().map(|p| (strain(p), p)).max_by(|a, b| a.0.total_cmp(&b.0))?;
    Some((most.0, limit, points[most.1[0] as usize], false))
}

/// Whether a rigid body that turned about its centre is about a place as if it had not: a body of revolution about its axis.
fn turns_into_itself(rigid: &Rigid, motion: &RigidMotion, x: &Point<3>, size: f64) -> bool {
    let moved = motion.point(&rigid.centre) - rigid.centre;
    let axes = [Vector::<3>::x(), Vector::<3>::y(), Vector::<3>::z()];
    let around = axes.iter().flat_map(|e| [x - e * size, x + e * size]);
    std::iter::once(*x).chain(around).all(|y| {
        let still = (rigid.gap)(&(y - moved));
        let turned = (rigid.gap)(&(motion.rotation.transpose() * (y - motion.translation)));
        (still.gap - turned.gap).abs() <= PLANE * size
            && (still.normal - motion.rotation * turned.normal).norm() <= PLANE
    })
}

/// How far the places of a contact of small sliding have slid since the start, as a share of a cell.
fn slip(setting: &Setting, state: &State, number: usize) -> Option<Finding> {
    let contact = &setting.contacts[number];
    let [own, other] = contact.bodies;
    let Form::Solid(solid) = &setting.bodies[own].form else { return None };
    let moved = Displacements::new(solid, state.bodies[own].points());
    let opposite = match &setting.bodies[other].form {
        Form::Solid(solid) => Some(Displacements::new(solid, state.bodies[other].points())),
        _ => None,
    };
    let slid = |x: &Point<3>, normal: &Vector<3>, zone: f64| {
        let (u, mut cell) = moved.at(x)?;
        let (by, matters) = match (&opposite, &setting.bodies[other].form) {
            (Some(opposite), _) => {
                let (by, size) = opposite.at(x)?;
                cell = cell.min(size);
                (by, true)
            }
            (None, Form::Rigid(rigid)) => {
                let motion = state.bodies[other].motion();
                let motion = match turns_into_itself(rigid, &motion, x, cell) {
                    true => RigidMotion::new(
                        Vector::<3>::zeros(),
                        Point::<3>::zeros(),
                        motion.point(&rigid.centre) - rigid.centre,
                    ),
                    false => motion,
                };
                let was = motion.rotation.transpose() * (x - motion.translation);
                // On a plane it makes no difference where.
                let [a, b] = [(rigid.gap)(&(x - u)).normal, motion.rotation * (rigid.gap)(&was).normal];
                (x - was, (a - b).norm() > PLANE)
            }
            _ => return None,
        };
        let relative = u - by;
        Some((
            if matters { (relative - normal * normal.dot(&relative)).norm() / cell.max(OF_ZONE * zone) } else { 0.0 },
            *x,
        ))
    };
    let closed = state.contacts[number].iter().filter(|t| t.is_closed);
    let zone = width(setting.space, &closed.clone().collect::<Vec<_>>());
    let (share, x) = closed.filter_map(|t| slid(&t.x, &t.normal, zone)).max_by(|a, b| a.0.total_cmp(&b.0))?;
    let (outcome, limit) = match share {
        s if s > SLIP_REFUSED => (Outcome::Refused, SLIP_REFUSED),
        s if s > SLIP_TOLD => (Outcome::Doubt, SLIP_TOLD),
        _ => (Outcome::Fine, SLIP_TOLD),
    };
    let name = &contact.name;
    let message = format!("`{name}` has slipped by {share:.2} cells, but the contact is for small sliding");
    let finding = Finding::new(Check::Range, outcome, message).measured(share, limit).at(x).on(name);
    Some(if outcome == Outcome::Fine { finding } else { finding.remedy("use sliding = \"finite\"") })
}

/// How far the boundary of a solid has moved, by where it is now.
struct Displacements<'a> {
    solid: &'a Solid,
    points: &'a [Point<3>],
    tree: Bvh,
}

impl<'a> Displacements<'a> {
    fn new(solid: &'a Solid, points: &'a [Point<3>]) -> Self {
        let boxes = solid.boundary.points.iter().map(|k| Aabb::new(points[*k as usize], points[*k as usize]));
        Displacements { solid, points, tree: Bvh::new(&boxes.collect::<Vec<_>>()) }
    }

    /// The displacement of the point of the boundary nearest to a place, and the size of the cells there.
    fn at(&self, x: &Point<3>) -> Option<(Vector<3>, f64)> {
        let (mut best, mut found) = (f64::INFINITY, None);
        self.tree.nearest(x, best, |k| {
            let point = self.solid.boundary.points[k];
            let square = (self.points[point as usize] - x).norm_squared();
            if square < best {
                (best, found) = (square, Some(point));
            }
            best
        });
        let point = found?;
        let [cell, _] = self.solid.cell_at(self.solid.boundary.facet_at(point)?);
        Some((self.points[point as usize] - self.solid.rest[point as usize], cell))
    }
}
