//! What a check found in a state.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What is checked.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Check {
    /// Bodies lie outside of each other, at the start, at the end of the increment and on the way.
    Gaps,
    /// Pressure pushes, friction stays within its limit and acts against the slip.
    Tractions,
    /// Forces on each body sum to zero, and so do moments where all parts are known.
    Balance,
    /// Friction takes energy, as much as loads and supports give and bodies do not store.
    Path,
    /// Statics and the laws of contact leave one state.
    Uniqueness,
    /// The cells are small enough for the zone of contact.
    Resolution,
    /// Strains, slips and rotations are those for which the theory holds.
    Range,
    /// The energy is least among the states near by.
    Stability,
}

/// What came of a check, from good to bad.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Outcome {
    /// Within the limit.
    Fine,
    /// The state is one, but a figure of it is less certain than it looks.
    Doubt,
    /// The state is none.
    Refused,
}

/// What a check found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Finding {
    /// What was checked.
    pub check: Check,
    /// What came of it.
    pub outcome: Outcome,
    /// What was measured; null where it is no number.
    pub value: Option<f64>,
    /// What the value should not be beyond.
    pub limit: Option<f64>,
    /// Where the worst is; null where it has no place.
    pub place: Option<[f64; 3]>,
    /// The body or the contact; null where it is all of them.
    pub on: Option<String>,
    /// In a sentence.
    pub message: String,
    /// What to do; null where nothing is to be done.
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
