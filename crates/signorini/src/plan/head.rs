//! What every plan knows besides its bodies: what its results are called, in which units, and what is written.

use super::planner::Planner;
use super::reader::Interpreted;
use crate::problem::units::Units;
use crate::problem::{CaseError, Problem};
use crate::report::{UnitNames, Warning};

/// The problem as its results tell of it.
#[derive(Clone)]
pub struct Head {
    /// Of solids; none where it is not known before the run.
    pub size: Option<Size>,
    pub problem: Problem,
    pub units: Option<Units>,
    /// What the values with units were taken for.
    pub interpreted: Vec<Interpreted>,
    pub warnings: Vec<Warning>,
    /// Increments from one file of fields to the next.
    pub every: usize,
    /// Whether pictures are wanted.
    pub pictures: bool,
}

/// How large a problem is.
#[derive(Clone, Debug)]
pub struct Size {
    /// In words.
    pub told: String,
    /// About what memory it takes, in bytes.
    pub memory: f64,
}

impl Size {
    /// Of so many unknowns, solved in some way.
    pub fn new(unknowns: usize, how: &str, memory: f64) -> Self {
        let told =
            format!("{unknowns} unknowns, solved by {how}, require about {:.2} GiB", memory / f64::from(1u32 << 30));
        Size { told, memory }
    }
}

impl Head {
    /// What the base units are called; none where the problem states none.
    pub fn unit_names(&self) -> Option<UnitNames> {
        self.units.as_ref().map(|units| UnitNames::new(units, self.problem.space))
    }
}

impl Planner<'_> {
    /// The head of a plan, after everything else was read.
    pub(super) fn head(&self, mut warnings: Vec<Warning>) -> Result<Head, CaseError> {
        let output = &self.problem.output;
        let every = match &output.every {
            None => 1,
            Some(n) if *n >= 1 => *n as usize,
            Some(n) => return Err(self.problem.error(n, "`every` must be at least 1")),
        };
        if let Some(seconds) = self.problem.limits.max_time.as_ref().filter(|s| **s <= 0.0 || s.is_nan()) {
            return Err(self.problem.error(seconds, format!("a run of {seconds} s")).help("give more than 0 seconds"));
        }
        if let Some(n) = self.problem.limits.max_iterations.as_ref().filter(|n| **n < 1) {
            return Err(self.problem.error(n, format!("a run of {n} iterations")).help("give 1 or more"));
        }
        warnings.append(&mut self.warnings.borrow_mut());
        warnings.extend(self.problem.source.renamed_keys().map(Warning::from));
        Ok(Head {
            size: None,
            problem: self.problem.clone(),
            units: self.reader.units,
            interpreted: self.reader.echo(),
            warnings,
            every,
            pictures: output.pictures.unwrap_or(true),
        })
    }
}
