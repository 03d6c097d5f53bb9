//! What a path goes along: bodies in their places, fixed points and the order of both.

use crate::{PathError, Place};
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::RigidShape;
use signorini_geometry::{Point, Vector};

/// A body in its place.
#[derive(Clone, Copy)]
pub struct Body<'a> {
    pub shape: &'a dyn RigidShape,
    /// From the coordinates of the shape to those of space.
    pub motion: RigidMotion,
}

impl<'a> Body<'a> {
    /// A body that stands where its shape is stated.
    pub fn fixed(shape: &'a dyn RigidShape) -> Self {
        let zero = Vector::<3>::zeros();
        Body { shape, motion: RigidMotion::new(zero, zero, zero) }
    }

    pub(crate) fn inside(&self, x: &Point<3>) -> Point<3> {
        self.motion.rotation.tr_mul(&(x - self.motion.translation))
    }

    pub(crate) fn inside_vector(&self, v: &Vector<3>) -> Vector<3> {
        self.motion.rotation.tr_mul(v)
    }

    /// The gap of a point of space to first order.
    pub(crate) fn near_gap(&self, x: &Point<3>) -> f64 {
        let level = self.shape.level(&self.inside(x));
        level.value / level.gradient.norm()
    }
}

/// A fixed point of a path: of space, or of a body with which it moves.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Anchor {
    /// In the coordinates of the body where there is one.
    pub point: Point<3>,
    pub body: Option<usize>,
}

impl Anchor {
    /// A point of space.
    pub fn fixed(point: Point<3>) -> Self {
        Anchor { point, body: None }
    }

    /// A point of a body.
    pub fn on(body: usize, point: Point<3>) -> Self {
        Anchor { point, body: Some(body) }
    }

    pub(crate) fn place(&self, bodies: &[Body<'_>]) -> Point<3> {
        self.body.map_or(self.point, |b| bodies[b].motion.point(&self.point))
    }
}

/// What a path meets on its way.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Station {
    /// A point through which it runs, without friction.
    Via(Anchor),
    /// A body that it touches where that is in the way, and goes around so many times more.
    Around { body: usize, turns: u32 },
}

/// A path from point to point.
#[derive(Clone, Debug, PartialEq)]
pub struct Route {
    pub start: Anchor,
    pub stations: Vec<Station>,
    pub end: Anchor,
}

/// Bodies between two fixed points.
#[derive(Clone, Debug)]
pub(crate) struct Leg {
    pub from: (Place, Point<3>),
    pub to: (Place, Point<3>),
    pub around: Vec<Around>,
    /// Which of the bodies `from` and `to` lie on.
    pub pinned: [Option<usize>; 2],
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Around {
    pub station: usize,
    pub body: usize,
    pub turns: u32,
}

/// Distance from a surface, relative to the size of a leg, up to which a point counts as on it.
const ON_SURFACE: f64 = 1e-9;

impl Route {
    pub(crate) fn check(&self, bodies: usize) -> Result<(), PathError> {
        let named = self.stations.iter().enumerate().map(|(k, s)| match s {
            Station::Via(anchor) => (k, anchor.body),
            Station::Around { body, .. } => (k, Some(*body)),
        });
        let ends = [(0, self.start.body), (self.stations.len(), self.end.body)];
        for (station, body) in named.chain(ends) {
            if let Some(body) = body.filter(|b| *b >= bodies) {
                return Err(PathError::NoBody { station, body, count: bodies });
            }
        }
        let points = self.stations.iter().filter_map(|s| match s {
            Station::Via(anchor) => Some(anchor.point),
            Station::Around { .. } => None,
        });
        for value in points.chain([self.start.point, self.end.point]).flat_map(<[f64; 3]>::from) {
            if !value.is_finite() {
                return Err(PathError::Input { what: "a coordinate of a path", value, valid: "a finite number" });
            }
        }
        Ok(())
    }

    pub(crate) fn legs(&self, bodies: &[Body<'_>]) -> Vec<Leg> {
        let mut legs = Vec::new();
        let mut from = (Place::Start, self.start.place(bodies));
        let mut around = Vec::new();
        for (station, what) in self.stations.iter().enumerate() {
            match *what {
                Station::Around { body, turns } => around.push(Around { station, body, turns }),
                Station::Via(anchor) => {
                    let to = (Place::Via(station), anchor.place(bodies));
                    legs.push(Leg { from, to, around: std::mem::take(&mut around), pinned: [None; 2] });
                    from = to;
                }
            }
        }
        legs.push(Leg { from, to: (Place::End, self.end.place(bodies)), around, pinned: [None; 2] });
        legs
    }
}

impl Leg {
    /// The stations of its bodies, in the order in which the path meets them.
    pub fn stations(&self) -> Vec<usize> {
        self.around.iter().map(|a| a.station).collect()
    }

    /// Takes the bodies in the order of their stations in a list.
    pub fn arrange(&mut self, stations: &[usize]) {
        self.around.sort_by_key(|a| stations.iter().position(|s| *s == a.station));
    }

    /// Which ends lie on bodies; neither may lie inside one.
    pub fn pin(&mut self, bodies: &[Body<'_>]) -> Result<(), PathError> {
        let size = (self.to.1 - self.from.1).norm();
        for (side, (place, x)) in [self.from, self.to].into_iter().enumerate() {
            for (order, around) in self.around.iter().enumerate() {
                let body = &bodies[around.body];
                let gap = body.near_gap(&x);
                if gap.abs() <= ON_SURFACE * size {
                    self.pinned[side] = Some(order);
                } else if gap < 0.0 {
                    let depth = -body.shape.gap(&body.inside(&x)).gap;
                    return Err(PathError::Inside { place, body: around.body, depth });
                }
            }
        }
        Ok(())
    }
}
