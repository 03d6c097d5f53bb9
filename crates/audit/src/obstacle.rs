//! How deep a point lies in a body, where that is now.

use crate::boundary::sides;
use crate::nearest::{area_normal, extent, on_facet};
use crate::state::{Form, Placement, Rigid, Solid};
use signorini_geometry::bvh::Bvh;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::GapJet;
use signorini_geometry::{Aabb, Point, Vector};
use std::sync::OnceLock;

/// A body that others may not reach into.
pub enum Obstacle<'a> {
    Rigid { body: &'a Rigid, motion: RigidMotion },
    Solid(Box<SolidNow<'a>>),
}

/// What a point finds.
#[derive(Clone, Copy, Debug)]
pub struct Found {
    /// Negative inside.
    pub gap: f64,
    /// Outward.
    pub normal: Vector<3>,
    /// The largest curvature of what is met, where that is known; facets tell how far they may lie off instead.
    pub curvature: f64,
    pub off: f64,
    /// The size of its cells there; zero of a rigid body.
    pub cell: f64,
}

impl Rigid {
    /// The gap of a point where the body has moved.
    pub fn gap_now(&self, motion: &RigidMotion, x: &Point<3>) -> GapJet<3> {
        let turn = motion.rotation;
        let found = (self.gap)(&(turn.transpose() * (x - motion.translation)));
        GapJet { gap: found.gap, normal: turn * found.normal, hessian: turn * found.hessian * turn.transpose() }
    }
}

impl<'a> Obstacle<'a> {
    /// A body where it is now; none of a curve.
    pub fn new(form: &'a Form, placement: &'a Placement, in_space: bool) -> Option<Self> {
        match form {
            Form::Rigid(body) => Some(Obstacle::Rigid { body, motion: placement.motion() }),
            Form::Solid(solid) => Some(Obstacle::Solid(Box::new(SolidNow::new(solid, placement.points(), in_space)))),
            Form::Curve(_) => None,
        }
    }

    /// A distance that the gap of a point is not below, found with little work.
    pub fn at_least(&self, x: &Point<3>) -> f64 {
        match self {
            Obstacle::Rigid { body, motion } => body.gap_now(motion, x).gap,
            Obstacle::Solid(solid) => solid.distance_of_box(x),
        }
    }

    /// What a point finds, if its gap is at most `reach`. With the place at rest of a point of the same body what lies within
    /// a distance of that is left out.
    pub fn find(&self, x: &Point<3>, reach: f64, except: Option<(Point<3>, f64)>) -> Option<Found> {
        match self {
            Obstacle::Rigid { body, motion } => {
                let jet = body.gap_now(motion, x);
                let curvature = jet.hessian.norm();
                let found = Found { gap: jet.gap, normal: jet.normal, curvature, off: 0.0, cell: 0.0 };
                (jet.gap <= reach && jet.gap.is_finite()).then_some(found)
            }
            Obstacle::Solid(solid) => solid.find(x, reach, except),
        }
    }
}

/// A solid where it is now.
pub struct SolidNow<'a> {
    solid: &'a Solid,
    points: &'a [Point<3>],
    in_space: bool,
    cells: Bvh,
    facets: Bvh,
    /// The cells at rest, once they are asked for.
    at_rest: OnceLock<Bvh>,
}

fn around(points: &[Point<3>], list: &[u32]) -> Aabb<3> {
    let nowhere = Aabb::new(Point::<3>::zeros(), Point::<3>::zeros());
    Aabb::around(list.iter().map(|k| points[*k as usize])).unwrap_or(nowhere)
}

fn boxes(points: &[Point<3>], lists: &[Vec<u32>]) -> Bvh {
    Bvh::new(&lists.iter().map(|l| around(points, l)).collect::<Vec<_>>())
}

impl<'a> SolidNow<'a> {
    pub fn new(solid: &'a Solid, points: &'a [Point<3>], in_space: bool) -> Self {
        let [cells, facets] = [&solid.cells, &solid.boundary.facets].map(|lists| boxes(points, lists));
        SolidNow { solid, points, in_space, cells, facets, at_rest: OnceLock::new() }
    }

    /// The distance of a point from the box around the body; of a body that shows nothing all is far away.
    fn distance_of_box(&self, x: &Point<3>) -> f64 {
        if self.facets.is_empty() { f64::INFINITY } else { (x - self.facets.bounds().clamp(x)).norm() }
    }

    /// Whether a point lies in a cell, other than those that are left out.
    fn is_in(&self, x: &Point<3>, except: Option<(Point<3>, f64)>) -> bool {
        self.is_in_cells((&self.cells, self.points), x, &|cell| self.is_beside(cell, except))
    }

    /// The same with the cells where their points are now or were, but for those that are left out.
    fn is_in_cells(&self, (tree, points): (&Bvh, &[Point<3>]), x: &Point<3>, out: &dyn Fn(&[u32]) -> bool) -> bool {
        let mut inside = false;
        tree.nearest(x, 0.0, |k| {
            let cell = &self.solid.cells[k];
            inside = inside || (!out(cell) && self.cell_holds(points, cell, x));
            0.0
        });
        inside
    }

    fn is_beside(&self, list: &[u32], except: Option<(Point<3>, f64)>) -> bool {
        except.is_some_and(|(place, far)| list.iter().any(|k| (self.solid.rest[*k as usize] - place).norm() < far))
    }

    fn cell_holds(&self, points: &[Point<3>], cell: &[u32], x: &Point<3>) -> bool {
        sides(cell, self.in_space).iter().all(|side| {
            let normal = area_normal(points, side);
            let from = x - crate::nearest::centre(points, side);
            normal.dot(&from) <= 0.0
        })
    }

    /// Whether there are other cells beyond a facet at rest: cells of unlike sizes meet there.
    fn is_within(&self, facet: usize) -> bool {
        let (list, rest) = (&self.solid.boundary.facets[facet], &self.solid.rest[..]);
        let Some(normal) = area_normal(rest, list).try_normalize(0.0) else { return true };
        let beyond = self.solid.boundary.centre(rest, facet) + normal * (1e-3 * extent(rest, list));
        let tree = self.at_rest.get_or_init(|| boxes(rest, &self.solid.cells));
        self.is_in_cells((tree, rest), &beyond, &|_| false)
    }

    fn find(&self, x: &Point<3>, reach: f64, except: Option<(Point<3>, f64)>) -> Option<Found> {
        if self.distance_of_box(x) > reach {
            return None;
        }
        let inside = self.is_in(x, except);
        if !inside && reach <= 0.0 {
            return None;
        }
        let limit = if inside { f64::INFINITY } else { reach * reach };
        let (mut best, mut found) = (limit, None);
        self.facets.nearest(x, limit, |k| {
            let facet = &self.solid.boundary.facets[k];
            if self.is_beside(facet, except) {
                return best;
            }
            let foot = on_facet(x, self.points, facet);
            let square = (foot - x).norm_squared();
            if square < best && !self.is_within(k) {
                (best, found) = (square, Some((k, foot)));
            }
            best
        });
        let (facet, foot) = found?;
        let list = &self.solid.boundary.facets[facet];
        let normal = area_normal(self.points, list).try_normalize(0.0)?;
        let distance = (foot - x).norm();
        let size = extent(self.points, list);
        Some(Found {
            gap: if inside { -distance } else { distance },
            normal,
            curvature: 0.0,
            off: size * self.solid.boundary.turn[facet] / 8.0,
            cell: self.solid.cell_at(facet)[0],
        })
    }
}
