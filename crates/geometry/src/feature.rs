//! Faces, edges and vertices of shapes: where a point of them lies.

use std::fmt;

use crate::patch::Border;

/// The kind of feature of a shape on which a closest point lies.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FeatureKind {
    Point,
    Interior,
    Edge,
    Vertex,
}

impl fmt::Display for FeatureKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            FeatureKind::Point => "point",
            FeatureKind::Interior => "interior",
            FeatureKind::Edge => "edge",
            FeatureKind::Vertex => "vertex",
        })
    }
}

/// Which feature of a shape, beyond its kind.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Entity {
    /// The smooth interior, or a shape that is a point.
    Whole,
    /// A side of the parameter domain.
    Border(Border),
    /// The corner of two sides.
    Corner(Border, Border),
    /// An interior edge of a surface or an interior vertex of a curve; they are counted along the parameters.
    Crease(u32),
    /// Where an interior edge meets a side, or another interior edge.
    CreaseEnd(u32),
    /// A side that is a single point.
    Collapsed(Border),
    /// A side that is a smooth interior point.
    Pole,
    /// A face, edge or vertex of a solid, counted from zero among those of its kind.
    Part(u32),
}

fn border_name(border: Border) -> &'static str {
    match border {
        Border::Start => "start",
        Border::End => "end",
        Border::U0 => "u0",
        Border::U1 => "u1",
        Border::V0 => "v0",
        Border::V1 => "v1",
        Border::Diagonal => "d",
    }
}

impl fmt::Display for Entity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Entity::Whole => Ok(()),
            Entity::Border(b) => f.write_str(border_name(*b)),
            Entity::Corner(a, b) => write!(f, "{}+{}", border_name(*a), border_name(*b)),
            Entity::Crease(k) => write!(f, "crease:{k}"),
            Entity::CreaseEnd(k) => write!(f, "crease-end:{k}"),
            Entity::Collapsed(b) => write!(f, "collapsed:{}", border_name(*b)),
            Entity::Pole => f.write_str("pole"),
            Entity::Part(k) => write!(f, "{k}"),
        }
    }
}

/// A feature of a shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Feature {
    pub kind: FeatureKind,
    pub entity: Entity,
}

impl Feature {
    pub const POINT: Feature = Feature { kind: FeatureKind::Point, entity: Entity::Whole };
    pub const INTERIOR: Feature = Feature { kind: FeatureKind::Interior, entity: Entity::Whole };

    pub(crate) fn edge(border: Border) -> Self {
        Feature { kind: FeatureKind::Edge, entity: Entity::Border(border) }
    }

    pub(crate) fn vertex(entity: Entity) -> Self {
        Feature { kind: FeatureKind::Vertex, entity }
    }
}
