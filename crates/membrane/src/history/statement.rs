//! What a history asks of whoever states a membrane: its data at any time, and the increments that are wanted.

use crate::active_set::NodalStart;
use crate::domain::Domain;
use crate::method::{Formulation, Modes};
use crate::multigrid::LARGE;
use crate::multigrid::nested::is_able;
use crate::obstacle::Side;
use crate::problem::Membrane;
use crate::refinement::Refinement;
use signorini_fem::Grid;
use std::sync::Arc;

/// Which method finds the contact zone.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MethodChoice {
    InequalityLevelSet { modes: Modes, formulation: Formulation },
    ActiveSet(NodalStart),
}

impl Default for MethodChoice {
    fn default() -> Self {
        MethodChoice::InequalityLevelSet { modes: Modes::default(), formulation: Formulation::default() }
    }
}

impl MethodChoice {
    pub fn name(self) -> &'static str {
        match self {
            MethodChoice::InequalityLevelSet { .. } => "inequality_level_set",
            MethodChoice::ActiveSet(_) => "active_set",
        }
    }

    /// How the equilibrium beside a zone is formulated.
    pub fn formulation(self) -> Formulation {
        match self {
            MethodChoice::InequalityLevelSet { formulation, .. } => formulation,
            MethodChoice::ActiveSet(_) => Formulation::default(),
        }
    }

    /// The functions by which fronts move.
    pub fn modes(self) -> Modes {
        match self {
            MethodChoice::InequalityLevelSet { modes, .. } => modes,
            MethodChoice::ActiveSet(_) => Modes::default(),
        }
    }
}

/// One increment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlannedIncrement {
    /// Number of the step.
    pub step: usize,
    /// Time at the beginning of the step and at its end.
    pub range: [f64; 2],
    /// Time at the end of the increment, where that is given.
    pub time: f64,
    pub control: Control,
    /// Tolerance in time with which changes of topology are located; none where they are not.
    pub events: Option<f64>,
}

/// What is given in an increment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Control {
    Time,
    /// The length of the way along the path of equilibria.
    ArcLength(f64),
    /// The area of contact at the end of the step, which the increment approaches by so many parts of so many.
    Area {
        to: f64,
        part: usize,
        parts: usize,
    },
}

/// A membrane at all times, and how its history is followed.
pub trait Statement<const D: usize> {
    fn method(&self) -> MethodChoice;
    /// Where zones are told apart.
    fn grid(&self) -> &Grid<D>;
    /// Where cells are divided.
    fn refinement(&self) -> &Refinement<D>;
    /// The zone that the first increment starts from, where one is asked for.
    fn initial_zone(&self) -> Option<&(Side, Arc<dyn Domain<D>>)>;
    fn increments(&self) -> &[PlannedIncrement];
    /// Whether lengths are lengths; without units the problem may be scaled at will.
    fn has_units(&self) -> bool;
    /// The membrane at a time.
    fn at(&self, time: f64) -> Membrane<D>;
    /// Checks the fields of a membrane where they will be used.
    ///
    /// # Errors
    /// In words: which value cannot be used.
    fn check(&self, membrane: &Membrane<D>, time: f64) -> Result<(), String>;
    /// Where times lie along the path of what drives the membrane.
    fn places(&self, times: &[f64]) -> Vec<f64>;
    /// What to say where a factorisation needs more memory than there is.
    fn lacks_memory(&self) -> Option<String>;

    /// Whether an increment is solved for by multigrid: large ones are, where nothing is asked for that it cannot do.
    fn by_multigrid(&self, membrane: &Membrane<D>) -> bool {
        membrane.cells.function_count() >= LARGE
            && self.refinement().fronts == 0
            && self.initial_zone().is_none()
            && matches!(self.method(), MethodChoice::InequalityLevelSet { .. })
            && membrane.formulation == Formulation::OneSided
            && is_able(membrane)
    }
}
