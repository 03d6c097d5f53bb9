//! What a check found in a state.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Check {
    /// Gaps: bodies do not penetrate at the start, at the end of the increment and on the way.
    Gaps,
    /// Tractions: pressure is compressive, and friction is within its limit and opposes the slip.
    Tractions,
    /// Balance: the forces on each body sum to zero, and so do the moments if all parts are known.
    Balance,
    /// Path: energy balance of an increment. The dissipation is not negative.
    Path,
    /// Uniqueness: equilibrium and contact laws determine one state.
    Uniqueness,
    /// Resolution: the cells are small enough for the contact zone.
    Resolution,
    /// Range: strains, slips and rotations are within the range of the theory.
    Range,
    /// Stability: no small disturbance lowers the energy.
    Stability,
}

/// Outcome of a check.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Within the limit.
    Fine,
    /// The state is an equilibrium, but a result is less certain than it looks.
    Doubt,
    /// The state is refused.
    Refused,
}

/// A finding of the audit.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Finding {
    /// The check.
    pub check: Check,
    /// Outcome of the check.
    pub outcome: Outcome,
    /// Measured value. Null if there is no number.
    pub value: Option<f64>,
    /// Limit of the value.
    pub limit: Option<f64>,
    /// Position of the largest violation. Null if it has none.
    pub place: Option<[f64; 3]>,
    /// Name of the body or contact. Null if it is about all of them.
    pub on: Option<String>,
    /// The finding in a sentence.
    pub message: String,
    /// What to do. Null if nothing is needed.
    pub remedy: Option<String>,
}

impl Finding {
    /// A finding in a sentence, without figures.
    pub fn new(check: Check, outcome: Outcome, message: impl Into<String>) -> Self {
        Self { check, outcome, value: None, limit: None, place: None, on: None, message: message.into(), remedy: None }
    }

    /// The same with the value and its limit.
    #[must_use]
    pub fn measured(self, value: f64, limit: f64) -> Self {
        let finite = |v: f64| v.is_finite().then_some(v);
        Self { value: finite(value), limit: finite(limit), ..self }
    }

    #[must_use]
    pub fn at(self, place: impl Into<[f64; 3]>) -> Self {
        Self { place: Some(place.into()), ..self }
    }

    #[must_use]
    pub fn on(self, name: &str) -> Self {
        Self { on: Some(name.to_string()), ..self }
    }

    #[must_use]
    pub fn remedy(self, remedy: impl Into<String>) -> Self {
        Self { remedy: Some(remedy.into()), ..self }
    }

    /// How far beyond its limit it is: the worst of a check is told.
    fn excess(&self) -> f64 {
        match (self.value, self.limit) {
            (Some(value), Some(limit)) if limit > 0.0 => value / limit,
            _ => 0.0,
        }
    }
}

/// All that is in doubt or refused, and of each check without such the finding that came nearest to its limit.
pub fn worst(findings: Vec<Finding>) -> Vec<Finding> {
    let mut out: Vec<Finding> = Vec::new();
    for finding in findings {
        match out.iter_mut().find(|f| f.check == finding.check && (f.outcome, &f.on) == (finding.outcome, &finding.on))
        {
            Some(kept) if finding.excess() > kept.excess() => *kept = finding,
            Some(_) => {}
            None => out.push(finding),
        }
    }
    let bad: Vec<Check> = out.iter().filter(|f| f.outcome != Outcome::Fine).map(|f| f.check).collect();
    out.retain(|f| f.outcome != Outcome::Fine || !bad.contains(&f.check));
    let mut kept: Vec<Finding> = Vec::new();
    for finding in out {
        let same = |f: &&mut Finding| f.check == finding.check && f.outcome == Outcome::Fine;
        match kept.iter_mut().find(same) {
            Some(other) if finding.excess() > other.excess() => *other = finding,
            Some(_) => {}
            None => kept.push(finding),
        }
    }
    kept.sort_by_key(|f| f.check);
    kept
}
