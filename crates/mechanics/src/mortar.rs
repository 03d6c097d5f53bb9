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
//! apart along the surface: zero in a rigid motion of both sides, and without derivatives of projections.
//!
//! The tangent is exact but for the ends of the covered part: where the cuts within it move, the integrand does not jump.
//! A rigid master is tested at the points of a rule on whole slave faces.

mod across;
mod axes;
mod cover;
mod facing;
mod interaction;
mod measure;
mod rigid;
mod saved;
mod shown;
mod small;
mod terms;

use crate::body::{Body, BodyState, PlaceError};
use crate::enforcement::Enforcement;
use crate::pair::AxisChoice;
use crate::part::Part;
use crate::simpler::SetAside;
use crate::surface::Local;
use cover::{Nodes, Search};
use facing::Facing;
use measure::{Matched, NodeMeasure};
use signorini_contact::law::Projected;
use signorini_contact::{Law, Status};
use signorini_geometry::Vector;
use small::SmallSliding;

/// Contact of a surface of faces with another one, or with a rigid body.
pub struct Mortar {
    pub name: String,
    slave: Part,
    master: Part,
    enforcement: Enforcement,
    /// Without it the sides slide freely.
    pub friction: Option<Box<dyn Law>>,
    pub axis: AxisChoice,
    search: Search,
    nodes: Nodes,
    /// Face and point of each node.
    places: Vec<(usize, Local)>,
    /// Nodes without a pressure of their own: they share that of a neighbour.
    merged: Vec<bool>,
    /// Integral of the dual function of each node over all of the slave side.
    whole: Vec<f64>,
    /// The area by which the equations of each node are weighted: that integral, or the mean of all where it has none.
    weights: Vec<f64>,
    /// Traction per unit of gap, and of slip, of each node: the scale of the trial, not the penalty.
    stiffness: Vec<f64>,
    /// That scale over the penalty.
    softness: f64,
    memory: Vec<NodeMemory>,
    /// Points matched at the last state.
    matched: Vec<Matched>,
    /// The rotation vector of the master at the last state, if it is rigid.
    turned: Vector<3>,
    /// Times of the last state and of the one that is looked for.
    times: [f64; 2],
    /// None where sides slide as far as they slide.
    small: Option<SmallSliding>,
    /// What is stated, while a start is looked for with something simpler.
    set_aside: Option<SetAside>,
}

/// What a node remembers of the last state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct NodeMemory {
    /// Pressure, and friction along the axes.
    traction: [f64; 3],
    /// How far it slipped in all while it was closed, along the axes.
    slip: [f64; 2],
    /// The direction from which the first axis is taken, in space.
    along: Vector<3>,
}

/// Part of its weight below which a node has no equations of its own (Cichosz & Bischoff 2011).
const COVERED: f64 = 1e-3;

/// Share of the limit of friction within which a node is at it, as of a site of [`Contact`](crate::contact::Contact).
const AT_LIMIT: f64 = 1e-8;

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
        Ok(Mortar {
            name: name.to_string(),
            slave: slave.0,
            master: master.0,
            enforcement,
            friction: None,
            axis: AxisChoice::Material,
            search: Search { reach, extra: 0, facing, at_rest: false },
            memory: vec![NodeMemory::default(); places.len()],
            nodes,
            places,
            merged,
            weights: weights(&whole),
            whole,
            stiffness,
            softness: enforcement.softness(),
            matched: Vec::new(),
            turned: Vector::<3>::zeros(),
            times: [0.0; 2],
            small: None,
            set_aside: None,
        })
    }

    /// Further points of each piece along each direction, beyond those that the degree asks for.
    pub fn refine(&mut self, extra: usize) {
        self.search.extra = extra;
    }

    /// Unknowns of each node.
    fn components(&self) -> usize {
        self.slots().len()
    }

    /// Which components of a traction are unknowns: in the plane there is one axis.
    fn slots(&self) -> &'static [usize] {
        match (&self.friction, self.nodes.is_plane()) {
            (None, _) => &[0],
            (Some(_), false) => &[0, 1, 2],
            (Some(_), true) if self.is_across() => &[0, 2],
            (Some(_), true) => &[0, 1],
        }
    }

    /// Whether the first axis of the law stands on a plane problem.
    fn is_across(&self) -> bool {
        matches!(self.axis, AxisChoice::OnSlave(v) | AxisChoice::OnMaster(v) if v.z.abs() > v.xy().norm())
    }

    /// The unknown traction of a node.
    fn multiplier(&self, k: usize, multipliers: &[f64]) -> [f64; 3] {
        let parts = self.slots();
        let mut out = [0.0; 3];
        parts.iter().zip(&multipliers[parts.len() * k..]).for_each(|(slot, value)| out[*slot] = *value);
        out
    }

    /// The traction with which a node that gives way has no gap and no slip.
    fn base(&self, k: usize) -> [f64; 3] {
        self.enforcement.base(self.memory[k].traction)
    }

    /// Whether enough of a node sees the master, and did at the last state.
    fn sees(&self, k: usize, weight: f64) -> bool {
        self.whole[k] > 0.0 && weight > COVERED * self.whole[k]
    }

    /// The traction of a node by its law.
    fn traction(&self, k: usize, measure: &NodeMeasure, unknown: [f64; 3]) -> Projected {
        if !self.sees(k, measure.weight) {
            return Projected::default();
        }
        let c = self.stiffness[k];
        let base = self.base(k);
        let lambda: [f64; 3] = std::array::from_fn(|i| unknown[i] - self.softness * (unknown[i] - base[i]));
        let pressure = lambda[0] - c * measure.gap;
        // What was not matched at the last state has no slip, and no friction yet.
        let Some(law) = self.friction.as_ref().filter(|_| self.sees(k, measure.matched)) else {
            let mut projected = Projected::default();
            if pressure > 0.0 {
                projected.traction[0] = pressure;
                projected.derivative[0][0] = 1.0;
                projected.status = Status::Slip;
            }
            return projected;
        };
        let moves = |slot: usize| self.slots().contains(&slot);
        let trial = |i: usize| if moves(i + 1) { lambda[i + 1] + c * measure.slip[i] } else { 0.0 };
        let per_velocity = c * (self.times[1] - self.times[0]);
        let project = |trial: [f64; 3]| law.project_in_time(trial, per_velocity);
        let mut projected = project([pressure, trial(0), trial(1)]);
        let [p, t1, t2] = projected.traction;
        if projected.status == Status::Stick && law.utilisation([t1, t2], p) > 1.0 - AT_LIMIT {
            let beyond = project([p, (1.0 + 2.0 * AT_LIMIT) * t1, (1.0 + 2.0 * AT_LIMIT) * t2]);
            (projected.derivative, projected.status) = (beyond.derivative, beyond.status);
        }
        projected
    }
}
