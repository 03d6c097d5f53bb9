//! Contact by dual mortar multipliers at finite sliding: gaps and slips in the mean over the functions of the nodes of the
//! slave side.
//!
//! | symbol | meaning |
//! |---|---|
//! | `ψ_k` | dual functions of the nodes, on the part of the slave faces that sees the master |
//! | `g` | gap along the averaged normal of the slave, which also cuts the faces |
//! | `y_k = ∫ψ_k g / ∫ψ_k` | gap of a node, and its slip likewise: over the points matched at the last state |
//! | `λ_k` | its traction: pressure and friction along axes `E_α` |
//!
//! Residual `Σ_k ∫ψ_k (-p_k δo + T_kα E_α·S)`, equations `(w/c)(Π(λ - s (λ - λ_0) + c (-y_n, y_α)) - λ) = 0` as of
//! [`Contact`](crate::contact::Contact), with the same laws and enforcements. Integrals are over the reference area, so that
//! dual functions of faces covered completely do not change; pieces and gaps are those of the current configuration
//! (Puso & Laursen 2004; Popp, Gee & Wall 2009; Gitterle et al. 2010). Slip is how far points matched at the last state are
//! apart along the surface: zero in a rigid motion of both sides, and without derivatives of projections. Nodes that saw nothing
//! then, such as those that the end of the master has slid over since, slip by how far apart the points were that match now.
//!
//! The tangent is exact but for the ends of the covered part: where the cuts within it move, the integrand does not jump.
//! A surface in contact with itself has both roles, each face one of them (`mortar/within.rs`).
//!
//! A rigid master is tested at the points of a rule on whole slave faces.

mod across;
mod at_rest;
mod axes;
mod cover;
mod face_terms;
mod facing;
mod interaction;
mod measure;
mod measured;
mod rigid;
mod saved;
mod shown;
mod small;
mod terms;
mod tie;
mod within;

pub use tie::{Tie, TieFindings};

use crate::body::{Body, BodyState, PlaceError};
use crate::contact_law::{ContactLaw, PointHistory, PointMeasure};
use crate::enforcement::Enforcement;
use crate::pair::AxisChoice;
use crate::part::Part;
use crate::surface::Local;
use at_rest::SmallSliding;
use cover::{Nodes, Search};
use facing::Facing;
use measured::{Matched, NodeMeasure};
use signorini_contact::law::Projected;
use signorini_geometry::Vector;

/// Contact of a surface of faces with another one, or with a rigid body.
pub struct Mortar {
    pub name: String,
    slave: Part,
    master: Part,
    pub law: ContactLaw,
    axis: AxisChoice,
    search: Search,
    nodes: Nodes,
    /// Face and point of each node.
    places: Vec<(usize, Local)>,
    /// Nodes without a pressure of their own: they share that of a neighbour.
    merged: Vec<bool>,
    /// Integral of the dual function of each node over all of the slave side.
    whole: Vec<f64>,
    memory: Vec<NodeMemory>,
    /// Points matched at the last state.
    matched: Vec<Matched>,
    /// The rotation vector of the master at the last state, if it is rigid.
    turned: Vector<3>,
    /// Both sides in the state from which the increment starts, where slips count.
    departed: Option<[BodyState; 2]>,
    /// None where sides slide as far as they slide.
    small: Option<SmallSliding>,
}

/// What a node remembers of the last state besides its traction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct NodeMemory {
    /// How far it slipped in all while it was closed, along the axes.
    slip: [f64; 2],
    /// The direction from which the first axis is taken, in space.
    along: Vector<3>,
}

/// Part of its weight below which a node has no equations of its own (Cichosz & Bischoff 2011).
const COVERED: f64 = 1e-3;

/// The integrals of the dual functions, and their mean for those that have none: a node that shares the pressure of another,
/// one on the axis of revolution, has the equation that its own traction vanishes.
fn weights(whole: &[f64]) -> Vec<f64> {
    let mean = whole.iter().map(|w| w.abs()).sum::<f64>() / whole.len().max(1) as f64;
    whole.iter().map(|w| if *w > COVERED * mean { *w } else { mean }).collect()
}

fn no_surface(body: &dyn Body, part: &Part) -> PlaceError {
    let message = match &part.group {
        Some(group) => format!("`{group}` has no faces for mortar"),
        None => "it has no faces for mortar".to_string(),
    };
    PlaceError::Unsuitable { body: body.name().to_string(), message }
}

impl Mortar {
    /// # Errors
    /// A slave side without faces, a master that has none and is not rigid either, or Nitsche's method.
    pub fn new(
        name: &str,
        slave: (Part, &dyn Body),
        master: (Part, &dyn Body),
        enforcement: Enforcement,
    ) -> Result<Self, PlaceError> {
        if enforcement.takes_stress() {
            let message = "Nitsche's method is for points of a surface, not for mortar".to_string();
            return Err(PlaceError::Unsuitable { body: slave.1.name().to_string(), message });
        }
        let state: BodyState = slave.1.start();
        let surface = slave.1.surface(slave.0.group.as_deref(), &state).ok_or_else(|| no_surface(slave.1, &slave.0))?;
        let other = master.1.start();
        master.1.master(master.0.group.as_deref(), &other)?;
        if master.1.surface(master.0.group.as_deref(), &other).is_none() && !master.1.is_rigid() {
            return Err(no_surface(master.1, &master.0));
        }
        let nodes = Nodes::new(surface.faces().0);
        let places = nodes.places();
        let merged = vec![false; places.len()];
        let facing = Facing::new((&slave.0, slave.1), surface.as_ref(), (&master.0, master.1))?;
        let whole = nodes.whole(surface.as_ref(), &facing, &merged).weight;
        let stiffness = places.iter().map(|(face, _)| surface.stiffness(*face)).collect();
        let reach = 0.5 * slave.1.size().min(if master.1.is_rigid() { f64::INFINITY } else { master.1.size() });
        drop(surface);
        let mut law = ContactLaw::new(enforcement, stiffness, weights(&whole));
        law.in_plane = nodes.is_plane().then_some(0);
        Ok(Mortar {
            name: name.to_string(),
            slave: slave.0,
            master: master.0,
            law,
            axis: AxisChoice::Material,
            search: Search { reach, extra: 0, facing, at_rest: false },
            memory: vec![NodeMemory::default(); places.len()],
            nodes,
            places,
            merged,
            whole,
            matched: Vec::new(),
            turned: Vector::<3>::zeros(),
            departed: None,
            small: None,
        })
    }

    /// Further points of each piece along each direction, beyond those that the degree asks for.
    pub fn refine(&mut self, extra: usize) {
        self.search.extra = extra;
    }

    /// Whether the first axis of the law stands on a plane problem.
    fn is_across(&self) -> bool {
        matches!(self.axis, AxisChoice::OnSlave(v) | AxisChoice::OnMaster(v) if v.z.abs() > v.xy().norm())
    }

    /// Whether both sides are of one body.
    fn is_within(&self) -> bool {
        self.slave.body == self.master.body
    }

    /// Whether enough of a node sees the master, and did at the last state.
    fn sees(&self, k: usize, weight: f64) -> bool {
        self.whole[k] > 0.0 && weight > COVERED * self.whole[k]
    }

    /// The direction of the first axis of friction.
    pub fn axis(&self) -> AxisChoice {
        self.axis
    }

    /// Takes another one.
    pub fn set_axis(&mut self, axis: AxisChoice) {
        self.axis = axis;
        self.law.in_plane = self.nodes.is_plane().then(|| usize::from(self.is_across()));
    }

    /// The traction of a node by its law, and what it remembers of it.
    fn traction(
        &self,
        k: usize,
        measure: &NodeMeasure,
        unknown: [f64; 3],
        linearises: bool,
    ) -> (Projected, PointHistory) {
        if !self.sees(k, measure.weight) {
            return (Projected::default(), self.law.remembered(k, None));
        }
        let point = self.point(k, measure, linearises);
        let (projected, trial) = self.law.traction(k, unknown, &point);
        (projected, self.law.remembered(k, Some((&point, trial, &projected))))
    }

    /// What its law is given at a node.
    fn point(&self, k: usize, measure: &NodeMeasure, linearises: bool) -> PointMeasure {
        let slides = [1, 2].map(|slot| self.law.slots().contains(&slot));
        // What small sliding does not match has no slip, and no friction.
        let slides = self.sees(k, measure.matched).then_some(slides);
        PointMeasure {
            gap: measure.gap,
            slip: measure.slip,
            slipped: self.memory[k].slip,
            slides,
            sticks_first: linearises,
            ..PointMeasure::default()
        }
    }
}
