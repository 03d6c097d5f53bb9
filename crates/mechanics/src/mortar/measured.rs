//! What the points and nodes of a mortar contact measure.

use super::cover::{CoveredPoint, FacingPart};
use crate::pair::Pair;
use crate::points::MaterialPoint;
use crate::surface::Local;
use signorini_geometry::Vector;

/// A point of the slave side with the point of the master that it was matched with at the last state.
#[derive(Clone, Debug, PartialEq)]
pub struct Matched {
    pub face: usize,
    pub s: Local,
    /// Of a surface the face and its coordinates, of a rigid body the point in its own axes.
    pub on: MaterialPoint,
    pub shares: Vec<(u32, f64)>,
}

/// What a point of the slave side meets.
#[derive(Clone, Copy, Debug)]
pub struct MetPoint {
    pub gap: f64,
    /// Unit vector outward from the master.
    pub normal: Vector<3>,
    /// Of a surface the face and its coordinates, of a rigid body the point in its own axes.
    pub on: MaterialPoint,
}

/// How far a matched point is from where it was matched, and the normal there.
#[derive(Clone, Copy, Debug)]
pub struct Apart {
    pub normal: Vector<3>,
    pub vector: Vector<3>,
}

/// All points in a state.
pub struct Measured {
    pub cover: FacingPart,
    /// What each point meets, face by face.
    pub met: Vec<Vec<Option<MetPoint>>>,
    /// How far each matched point is apart; none without friction.
    pub apart: Vec<Option<Apart>>,
    /// The points of nodes that the last state did not match, and how far they came since; none without friction.
    pub arrived: Vec<Matched>,
    pub came: Vec<Apart>,
    /// The pairs with a rigid master, of points and of matched points; else none.
    pub pairs: Vec<Vec<Option<Pair>>>,
    pub matched: Vec<Option<Pair>>,
    /// Points that could not be measured.
    pub lost: usize,
}

impl Measured {
    /// The points that meet something, with what they meet.
    pub fn points(&self) -> impl Iterator<Item = (&CoveredPoint, &MetPoint)> {
        let all = self.cover.points.iter().flatten().zip(self.met.iter().flatten());
        all.filter_map(|(point, met)| Some((point, met.as_ref()?)))
    }
}

/// A node in a state: means over the area of its dual function.
#[derive(Clone, Copy, Debug, Default)]
pub struct NodeMeasure {
    /// Area of the part that sees the master, and of the part whose slip is known: that saw it at the last state, or all that
    /// arrived since.
    pub weight: f64,
    pub matched: f64,
    pub gap: f64,
    pub slip: [f64; 2],
    pub normal: Vector<3>,
}
