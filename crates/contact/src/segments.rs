//! Where a slave surface faces its master: quadrature points on pieces of slave faces, each seeing one master face.
//!
//! The slave faces are cut along the edges of the master faces, so that no point is lost or counted twice and every
//! integrand is smooth. In the plane the pieces are intervals; in space they are polygons, cut in the plane of each
//! slave facet (Puso & Laursen 2004). The gap of a point is measured along the interpolated slave normal.

mod opposite;
mod plane;
mod space;

pub use opposite::GapPoint;

use crate::multiplier::PressureNodes;
use crate::surface::ContactSurface;
use opposite::Cut;
use plane::intervals;
use rayon::prelude::*;
use signorini_basis::rules::rule;
use signorini_basis::{CellShape, Local};
use signorini_geometry::bvh::Bvh;
use signorini_geometry::{Aabb, Point};
use space::polygons;

/// What a slave face may see.
#[derive(Clone, Copy)]
pub struct Sight<'a> {
    /// The largest gap.
    pub reach: f64,
    /// The deepest penetration of a slave face, if it is less than the reach.
    pub deepest: &'a (dyn Fn(usize) -> f64 + Sync),
    /// Whether a slave face may touch a master face.
    pub sees: &'a (dyn Fn(usize, usize) -> bool + Sync),
}

impl Sight<'_> {
    /// Whether a slave face sees what is at a gap.
    pub(crate) fn includes(&self, face: usize, gap: f64) -> bool {
        gap <= self.reach && gap >= -self.reach.min((self.deepest)(face))
    }
}

/// The points of every slave face that see a master face.
pub fn segments<const D: usize>(
    slave: &dyn ContactSurface<D>,
    master: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    sight: Sight<'_>,
) -> Vec<Vec<GapPoint<D>>> {
    let candidates = candidates(slave, master, nodes, sight);
    let cut =
        |face: usize, extra: usize| pieces_of_face(Cut { slave, master, nodes, sight, extra }, face, &candidates[face]);
    let mut points: Vec<Vec<GapPoint<D>>> = (0..slave.face_count()).map(|face| cut(face, 0)).collect();
    // A constant pressure must load every function of both sides with its integral. On distorted faces the integrands
    // are no polynomials: more points are used as long as they help.
    let exact = [integrals(slave), integrals(master)];
    let mut before = defects(&points, slave, master, &exact);
    for extra in [2, 4, 8, 12] {
        let poor = |face: usize| {
            before[0][face] > ROUND_OFF
                || points[face].iter().any(|p| p.master.is_some_and(|(m, _)| before[1][m as usize] > ROUND_OFF))
        };
        let again: Vec<usize> = (0..points.len()).filter(|&f| !points[f].is_empty() && poor(f)).collect();
        if again.is_empty() {
            break;
        }
        for face in again {
            points[face] = cut(face, extra);
        }
        let now = defects(&points, slave, master, &exact);
        let helps = (0..2).any(|side| now[side].iter().zip(&before[side]).any(|(n, b)| *b > ROUND_OFF && *n < 0.2 * b));
        before = now;
        if !helps {
            break;
        }
    }
    points
}

/// The same with a rule that does not depend on the position of the sides: what changes with them changes without jumps.
/// `extra` are further points for each direction of a piece.
pub fn pieces<const D: usize>(
    slave: &dyn ContactSurface<D>,
    master: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    (sight, extra): (Sight<'_>, usize),
) -> Vec<Vec<GapPoint<D>>> {
    let candidates = candidates(slave, master, nodes, sight);
    let cut = Cut { slave, master, nodes, sight, extra };
    let of = |(face, list): (usize, &Vec<usize>)| pieces_of_face(cut, face, list);
    candidates.par_iter().enumerate().map(of).collect()
}

/// The points of a slave face on the pieces that see one of the master faces listed.
fn pieces_of_face<const D: usize>(cut: Cut<'_, D>, face: usize, list: &[usize]) -> Vec<GapPoint<D>> {
    if D == 2 { intervals(cut, face, list) } else { polygons(cut, face, list) }
}

/// Relative error of integrals that counts as rounding.
const ROUND_OFF: f64 = 1e-14;

/// Integrals of the functions of every face.
fn integrals<const D: usize>(surface: &dyn ContactSurface<D>) -> Vec<Vec<f64>> {
    let mut trace = Vec::new();
    (0..surface.face_count())
        .map(|face| {
            let mut out = Vec::new();
            for (s, w) in rule(surface.shape(face), surface.degree(face) + surface.order(face) + 4) {
                let point = surface.at(face, &s);
                let w = w * point.area_normal().norm() * surface.measure(&point.x);
                trace.clear();
                surface.trace(face, &s, &mut trace);
                out.resize(trace.len(), 0.0);
                out.iter_mut().zip(&trace).for_each(|(sum, (_, v))| *sum += w * v);
            }
            out
        })
        .collect()
}

/// For every slave and master face that is covered completely, the largest error of those integrals relative to its
/// area; zero for the others, of which nothing can be said.
fn defects<const D: usize>(
    points: &[Vec<GapPoint<D>>],
    slave: &dyn ContactSurface<D>,
    master: &dyn ContactSurface<D>,
    exact: &[Vec<Vec<f64>>; 2],
) -> [Vec<f64>; 2] {
    let mut sums = exact.clone();
    sums.iter_mut().flatten().flatten().for_each(|v| *v = 0.0);
    let mut trace = Vec::new();
    let mut add = |sums: &mut Vec<f64>, surface: &dyn ContactSurface<D>, face: usize, s: &Local, w: f64| {
        trace.clear();
        surface.trace(face, s, &mut trace);
        sums.iter_mut().zip(&trace).for_each(|(sum, (_, v))| *sum += w * v);
    };
    for (face, list) in points.iter().enumerate() {
        for p in list {
            add(&mut sums[0][face], slave, face, &p.s, p.weight);
            if let Some((other, eta)) = &p.master {
                add(&mut sums[1][*other as usize], master, *other as usize, eta, p.weight);
            }
        }
    }
    let worst = |sum: &Vec<f64>, exact: &Vec<f64>| {
        let scale = exact.iter().map(|v| v.abs()).sum::<f64>();
        let worst = sum.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / scale;
        if worst < 1e-2 { worst } else { 0.0 }
    };
    std::array::from_fn(|side| sums[side].iter().zip(&exact[side]).map(|(s, e)| worst(s, e)).collect())
}

/// The points of every slave face as a whole, wherever a rigid body is that it may touch.
pub fn whole_faces<const D: usize>(slave: &dyn ContactSurface<D>) -> Vec<Vec<GapPoint<D>>> {
    let of_face = |face: usize| {
        let n = slave.degree(face) + 2 + usize::from(slave.shape(face) == CellShape::Triangle);
        let point = |(s, w): (Local, f64)| {
            let at = slave.at(face, &s);
            let weight = w * at.area_normal().norm() * slave.measure(&at.x);
            GapPoint { s, weight, master: None, direction: Point::<D>::zeros(), gap: 0.0 }
        };
        rule(slave.shape(face), n).into_iter().map(point).collect()
    };
    (0..slave.face_count()).map(of_face).collect()
}

/// Master faces that each slave face may see, by boxes swept along the normals.
fn candidates<const D: usize>(
    slave: &dyn ContactSurface<D>,
    master: &dyn ContactSurface<D>,
    nodes: &PressureNodes<D>,
    sight: Sight<'_>,
) -> Vec<Vec<usize>> {
    let embed = |x: &Point<D>| Point::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 });
    let bounds = |points: &[Point<3>], margin: f64| {
        let low = points.iter().fold(points[0], |l, p| l.inf(p));
        let high = points.iter().fold(points[0], |h, p| h.sup(p));
        let pad = Point::<3>::repeat(margin * (high - low).norm());
        Aabb::new(low - pad, high + pad)
    };
    let slave_boxes: Vec<Aabb<3>> = (0..slave.face_count())
        .map(|face| {
            let mut points = Vec::new();
            for (s, (_, normal)) in nodes.map(face).nodes().iter().zip(nodes.of_face(face)) {
                let x = slave.at(face, s).x;
                points.push(embed(&(x + normal * sight.reach)));
                points.push(embed(&(x - normal * sight.reach)));
            }
            bounds(&points, 1e-3)
        })
        .collect();
    let master_boxes: Vec<Aabb<3>> = (0..master.face_count())
        .map(|face| {
            let shape = master.shape(face);
            let mut points: Vec<Point<3>> = shape.vertices().iter().map(|s| embed(&master.at(face, s).x)).collect();
            points.push(embed(&master.at(face, &shape.centre()).x));
            bounds(&points, if master.order(face) > 1 { 0.3 } else { 1e-6 })
        })
        .collect();
    let mut lists = vec![Vec::new(); slave.face_count()];
    if slave_boxes.is_empty() || master_boxes.is_empty() {
        return lists;
    }
    let pairs = Bvh::new(&slave_boxes).pairs_within(&Bvh::new(&master_boxes), (&slave_boxes, &master_boxes), 0.0);
    for (i, j) in pairs.into_iter().filter(|(i, j)| (sight.sees)(*i, *j)) {
        lists[i].push(j);
    }
    lists
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{ANY, Polyline};

    /// A slave from 0 to 2 at height 0.1 + 0.05 x over a master from 0.25 to 3 with other faces.
    fn sides() -> (Polyline, Polyline) {
        let slave = Polyline::at(&[0.0, 0.6, 1.3, 2.0], |x| 0.1 + 0.05 * x);
        let master = Polyline::at(&[3.0, 1.7, 0.9, 0.25], |_| 0.0);
        (slave, master)
    }

    #[test]
    fn points_cover_what_both_sides_have_in_common_with_their_gaps() {
        let (slave, master) = sides();
        let nodes = PressureNodes::new(&slave);
        let points = segments(&slave, &master, &nodes, ANY);
        let slope = 0.05f64.hypot(1.0);
        let (mut length, mut moment) = (0.0, 0.0);
        for (face, p) in points.iter().enumerate().flat_map(|(face, list)| list.iter().map(move |p| (face, p))) {
            let (m, s) = p.master.unwrap();
            let (x, y) = (slave.at(face, &p.s).x, master.at(m as usize, &s).x);
            // Along the normal of the slave to the master below it.
            assert!((x - y - p.gap * p.direction).norm() < 1e-13 && p.gap > 0.0);
            assert!((p.direction - Point::<2>::new(-0.05, 1.0) / slope).norm() < 1e-13);
            assert!((p.gap - x[1] * slope).abs() < 1e-13);
            length += p.weight;
            moment += p.weight * x[0];
        }
        // From where the normal of the slave meets the left end of the master.
        let start = (0.25 - 0.05 * 0.1) / (1.0 + 0.05 * 0.05);
        assert!((length - (2.0 - start) * slope).abs() < 1e-12, "{length}");
        assert!((moment - 0.5 * (4.0 - start * start) * slope).abs() < 1e-12, "{moment}");
    }

    #[test]
    fn what_faces_away_or_is_out_of_reach_is_not_seen() {
        let (slave, master) = sides();
        let nodes = PressureNodes::new(&slave);
        let away = Polyline(master.0.iter().rev().copied().collect());
        assert!(segments(&slave, &away, &nodes, ANY).iter().all(Vec::is_empty));
        assert!(segments(&slave, &master, &nodes, Sight { reach: 0.05, ..ANY }).iter().all(Vec::is_empty));
    }
}
