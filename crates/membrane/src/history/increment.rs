//! The result of an increment, whatever method found it.

use super::remark::Remark;
use crate::error_estimate::ErrorEstimate;
use crate::report::Report;
use crate::solution::Reason;
use signorini_geometry::Point;

/// What a method knows of a point.
pub struct Sample {
    pub displacement: f64,
    pub in_contact: bool,
    pub pressure: f64,
}

/// A state at any point; none outside the membrane.
pub type Sampler<const D: usize> = Box<dyn Fn(&Point<D>) -> Option<Sample>>;

/// The result of an increment.
pub struct Increment<const D: usize> {
    pub converged: bool,
    pub reason: Reason,
    /// Equilibrium solves on the cells of the state, and on larger ones before that.
    pub iterations: usize,
    pub before: usize,
    pub residuals: Vec<f64>,
    pub unknowns: usize,
    /// What solved the equations.
    pub solver: &'static str,
    pub remarks: Vec<Remark>,
    /// None where nothing was solved.
    pub report: Option<Report<D>>,
    pub outlines: Vec<Vec<Point<D>>>,
    pub sample: Option<Sampler<D>>,
    pub stability: Stability,
    /// Whether the fronts are no sharper than the grid can show.
    pub resolved: bool,
    /// What the discretisation leaves uncertain, where that was asked for.
    pub errors: Option<ErrorEstimate>,
}

/// What adhesion makes of a state.
#[derive(Clone, Copy, Debug, Default)]
pub struct Stability {
    /// Lowest eigenvalue of the second variation of the energy; none without adhesion.
    pub lowest_eigenvalue: Option<f64>,
    /// Whether the contact jumped to get there.
    pub jumped: bool,
    /// How far the state is from its loss; see `Solution::margin`.
    pub margin: Option<f64>,
}

impl<const D: usize> Increment<D> {
    /// Area of contact.
    pub fn area(&self) -> f64 {
        self.report.as_ref().map_or(0.0, |r| r.area())
    }

    /// Energy with that of adhesion.
    pub fn energy_total(&self) -> f64 {
        self.report.as_ref().map_or(f64::NAN, |r| r.energy_total())
    }
}
