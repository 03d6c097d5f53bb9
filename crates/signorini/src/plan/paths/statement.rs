//! Paths as they are planned.

use crate::plan::head::Head;
use crate::plan::located::LocatedExpression;
use crate::plan::rigid::RigidBody;
use crate::problem::KeyPath;
use signorini_geometry::{Point, Vector};
use signorini_paths::curve::Curve;
use signorini_paths::friction::Friction;
use signorini_paths::winding::Slippage;

/// Paths on rigid bodies.
pub struct PathPlan {
    pub head: Head,
    pub bodies: Vec<RigidBody>,
    /// The directions to the eye and up, of pictures.
    pub view: [Vector<3>; 2],
    pub task: Task,
}

/// What is sought.
pub enum Task {
    Wrapping { frames: usize, paths: Vec<PlannedPath> },
    Winding(Vec<PlannedWinding>),
    EulerEytelwein(Vec<PlannedRope>),
}

/// A shortest path.
pub struct PlannedPath {
    pub name: String,
    pub key: KeyPath,
    pub from: PlannedEnd,
    pub to: PlannedEnd,
    pub stations: Vec<PlannedStation>,
    pub friction: Option<Friction>,
    pub tension: Option<LocatedExpression>,
    pub end_tension: Option<LocatedExpression>,
}

/// A fixed point of a path: of space, by time, or of a body.
pub enum PlannedEnd {
    Space([LocatedExpression; 3]),
    OnBody(usize, Point<3>),
}

/// What a path passes.
pub enum PlannedStation {
    Via(PlannedEnd),
    Around { body: usize, turns: u32 },
}

/// A path of a yarn.
pub struct PlannedWinding {
    pub name: String,
    pub key: KeyPath,
    pub body: usize,
    /// Along the axis, around it, and the angle from the meridian.
    pub start: [f64; 3],
    pub slippage: Option<Slippage>,
    pub friction: Option<f64>,
    pub opening: Option<f64>,
    pub band: Option<f64>,
    /// A number of circuits; `Some(None)` for as few as cover the mandrel.
    pub pattern: Option<Option<u32>>,
    pub axis: Vector<3>,
    pub length: Option<f64>,
    pub spacing: Option<f64>,
}

/// A rope on a given curve.
pub struct PlannedRope {
    pub name: String,
    pub key: KeyPath,
    pub body: usize,
    pub curve: Box<dyn Curve>,
    pub friction: Friction,
    pub tension: f64,
    pub end_tension: Option<f64>,
}
