//! Where a solve starts from, and what comes of it.

use crate::adhesion::Branch;
use crate::conditions::Conditions;
use crate::equilibrium::Equilibrium;
use crate::problem::Membrane;
use crate::scales::Scales;
use crate::stopping::SETTLED;

/// How a solve ended.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Reason {
    /// The slope jump vanishes on all fronts and the contact conditions hold everywhere.
    Converged,
    /// The membrane does not reach any body.
    NoContact,
    /// No equilibrium with contact was found near the zone that was asked for.
    NoSuchState,
    /// The fronts did not come to rest.
    IterationLimit,
    /// The linear solver failed; its message.
    LinearSolver(String),
    /// The user asked to stop.
    Interrupted,
}

impl Reason {
    pub fn converged(&self) -> bool {
        matches!(self, Reason::Converged | Reason::NoContact)
    }
}

/// The state at the end of a solve, whether it converged or not.
pub struct Solution<const D: usize, Z> {
    pub zone: Z,
    /// None only where even the first linear system could not be solved.
    pub equilibrium: Option<Equilibrium<D>>,
    pub conditions: Option<Conditions<D>>,
    pub scales: Option<Scales>,
    pub reason: Reason,
    /// Equilibrium solves on the cells of this state, and on larger ones before that.
    pub iterations: usize,
    pub before: usize,
    /// Residual of each iteration relative to its tolerance.
    pub residuals: Vec<f64>,
    /// Size of the largest linear system.
    pub unknowns: usize,
    /// With adhesion, the lowest eigenvalue of the second variation of the energy: stable where it is positive.
    pub lowest_eigenvalue: Option<f64>,
    /// Whether the way led through unstable states: adhesion let the contact jump.
    pub jumped: bool,
    /// With adhesion, how far the state is from its loss: the square of the lowest eigenvalue, or the least gap of a free
    /// membrane. Near that loss it vanishes linearly in the load.
    pub margin: Option<f64>,
    /// Penetration that was put up with where zones come so near to each other that the grid cannot tell whether they touch.
    pub unresolved: Option<f64>,
    /// Whether smaller cells were wanted at the fronts, but no state was found on them.
    pub unrefined: bool,
    /// Length of the last step relative to a cell, where the fronts settled on a jump of the discrete slope.
    pub settled_within: Option<f64>,
    /// Whether they were left to smaller cells before they came to rest ...
    pub unfinished: bool,
    /// ... and whether they may stay so where there are none.
    pub near_enough: bool,
    /// Whether multigrid found it, and not a factorisation.
    pub multigrid: bool,
    /// What the nodal method predicted on the way, if it was asked.
    pub predicted: Option<Z>,
}

impl<const D: usize, Z> Solution<D, Z> {
    /// Nothing but a zone.
    pub fn begin(zone: Z) -> Self {
        Self {
            zone,
            equilibrium: None,
            conditions: None,
            scales: None,
            reason: Reason::IterationLimit,
            iterations: 0,
            before: 0,
            residuals: Vec::new(),
            unknowns: 0,
            lowest_eigenvalue: None,
            jumped: false,
            margin: None,
            unresolved: None,
            unrefined: false,
            settled_within: None,
            unfinished: false,
            near_enough: false,
            multigrid: false,
            predicted: None,
        }
    }

    /// Whether the fronts came to rest no sharper than the grid can show.
    pub fn is_resolved(&self) -> bool {
        self.settled_within.is_none_or(|step| step < SETTLED)
    }
}

/// Where an increment starts from.
#[derive(Clone)]
pub enum Start<Z> {
    /// The membrane without contact.
    Free,
    /// A zone from an earlier increment, with its scales, and which of the equilibria near it is wanted.
    Zone(Z, Scales, Branch),
    /// A zone that someone asked for, and which of the equilibria near it is wanted.
    Asked(Z, Branch),
}

impl<Z> Start<Z> {
    /// The same start on the cells of a membrane.
    pub(crate) fn on<const D: usize>(self, membrane: &Membrane<D>) -> Self {
        match self {
            Start::Zone(zone, scales, branch) => Start::Zone(zone, scales.on(membrane), branch),
            other => other,
        }
    }
}
