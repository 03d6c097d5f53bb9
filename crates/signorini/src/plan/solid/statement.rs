//! Solids as they are planned: bodies, what holds and pushes them, and who may touch whom.

use super::friction::PlannedFriction;
use crate::plan::head::Head;
use crate::plan::placed::Placed;
use crate::plan::rigid::RigidBody;
use crate::problem::Space;
use signorini_fem::{Group, Mesh, Side};
use signorini_geometry::Point;
use signorini_solid::{Elastic, LoadKind, Method as ContactMethod, SupportKind};
use std::collections::BTreeMap;

/// A solid body.
#[derive(Clone)]
pub struct PlannedBody<const D: usize> {
    pub name: String,
    pub mesh: Mesh<D>,
    /// The same cells with curves of one degree more, where the mesh follows a map: for estimates of errors.
    pub raised: Option<Mesh<D>>,
    pub degree: usize,
    pub material: Elastic,
}

/// A support: where, what, and the expressions it prescribes.
#[derive(Clone)]
pub struct SolidSupport {
    pub name: String,
    pub body: usize,
    pub group: Group,
    pub kind: SupportKind,
    /// By component, or along the normal.
    pub values: Vec<Option<Placed>>,
}

/// A load: where, what, and its expressions.
#[derive(Clone)]
pub struct SolidLoad {
    pub name: String,
    pub body: usize,
    pub group: Group,
    pub kind: LoadKind,
    pub values: Vec<Placed>,
}

/// The other side of a contact.
#[derive(Clone)]
pub enum Opposite {
    Body { body: usize, sides: Vec<Side>, whole: bool },
    Rigid(RigidBody),
}

/// Two sides that may touch.
#[derive(Clone)]
pub struct SolidContact<const D: usize> {
    pub name: String,
    pub body: usize,
    pub sides: Vec<Side>,
    /// Whether `sides` are all of the body: only those that look at the other body count then.
    pub whole: bool,
    pub opposite: Opposite,
    pub method: ContactMethod,
    pub enforcement: signorini_solid::Enforcement,
    pub friction: Option<PlannedFriction<D>>,
}

/// Solids, what holds and pushes them, and who may touch whom.
#[derive(Clone)]
pub struct SolidPlan<const D: usize> {
    pub head: Head,
    pub space: Space,
    pub bodies: Vec<PlannedBody<D>>,
    pub supports: Vec<SolidSupport>,
    pub loads: Vec<SolidLoad>,
    pub contacts: Vec<SolidContact<D>>,
    pub times: Vec<f64>,
    pub probes: BTreeMap<String, (usize, Point<D>)>,
}
