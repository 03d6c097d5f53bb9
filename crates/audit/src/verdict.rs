//! What the findings come to.

use crate::finding::{Finding, Outcome};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a state is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// An answer, right within the ± that is told.
    RightWithin,
    /// An answer, of which a figure is less certain than it looks.
    RightBut,
    /// No answer: a law of mechanics is broken.
    NotAnAnswer,
}

/// What an independent check of all increments came to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct Answer {
    /// Whether the run is an answer.
    pub verdict: Verdict,
    /// The same in a sentence, with the reason and what to do.
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
    /// What the findings of increments, each with its time, come to. `within` says within what the figures are right.
    pub fn new(steps: &[(f64, &[Finding])], within: &str) -> Self {
        let all = || steps.iter().flat_map(|(time, list)| list.iter().map(move |f| (*time, f)));
        let verdict = Verdict::of(all().map(|(_, f)| f));
        let told = |outcome: Outcome| {
            let mut seen: Vec<(_, Option<&String>)> = Vec::new();
            let mut list = Vec::new();
            // The same of several increments is told once, as it is in the last.
            let mut reversed: Vec<(f64, &Finding)> = all().filter(|(_, f)| f.outcome == outcome).collect();
            reversed.reverse();
            for (time, f) in reversed {
                if seen.contains(&(f.check, f.on.as_ref())) {
                    continue;
                }
                seen.push((f.check, f.on.as_ref()));
                let remedy = f.remedy.as_ref().map_or(String::new(), |r| format!(" ({r})"));
                list.push(format!("{} at t = {time}{remedy}", f.message));
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
