//! What the findings come to.

use crate::finding::{Check, Finding, Outcome};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Verdict on a state.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// All checks hold. The results are right within the reported ±.
    RightWithin,
    /// The state is an equilibrium, but a result is less certain than it looks.
    RightBut,
    /// The state violates a law of mechanics.
    NotAnAnswer,
}

/// Result of the audit over all increments.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Answer {
    /// The verdict.
    pub verdict: Verdict,
    /// The verdict in a sentence, with the reason and what to do.
    pub text: String,
}

impl Verdict {
    /// What findings come to.
    pub fn of<'a>(findings: impl IntoIterator<Item = &'a Finding>) -> Self {
        match findings.into_iter().map(|f| f.outcome).max() {
            Some(Outcome::Refused) => Verdict::NotAnAnswer,
            Some(Outcome::Doubt) => Verdict::RightBut,
            _ => Verdict::RightWithin,
        }
    }
}

impl Answer {
    /// What the findings of increments, each with its time, come to. `within` says within what the figures are right. Zones grow
    /// from nothing: whether cells are small enough counts for the last increment.
    pub fn new<'a>(steps: &[(f64, &'a [Finding])], within: &str) -> Self {
        let count = steps.len();
        let counts = move |k: usize, f: &Finding| k + 1 == count || f.check != Check::Resolution;
        let of = move |(k, (time, list)): (usize, &(f64, &'a [Finding]))| {
            let time = *time;
            list.iter().filter(move |f| counts(k, f)).map(move |f| (time, f))
        };
        let verdict = Verdict::of(steps.iter().enumerate().flat_map(of).map(|(_, f)| f));
        let told = |outcome: Outcome| {
            let mut seen: Vec<(_, Option<&String>)> = Vec::new();
            let mut list = Vec::new();
            // The same of several increments is told once, as it is in the last.
            let backwards = steps.iter().enumerate().rev().flat_map(of);
            for (time, f) in backwards.filter(|(_, f)| f.outcome == outcome) {
                if seen.contains(&(f.check, f.on.as_ref())) {
                    continue;
                }
                seen.push((f.check, f.on.as_ref()));
                let remedy = f.remedy.as_ref().map_or(String::new(), |r| format!(" ({r})"));
                let when = format!(" at t = {time}");
                let when = if f.message.ends_with(&when) { "" } else { &when };
                list.push(format!("{}{when}{remedy}", f.message));
            }
            list.join("; ")
        };
        let text = match verdict {
            Verdict::RightWithin => format!("Right {within}."),
            Verdict::RightBut => format!("Right, but {}.", told(Outcome::Doubt)),
            Verdict::NotAnAnswer => format!("Not an answer: {}.", told(Outcome::Refused)),
        };
        Answer { verdict, text }
    }
}
