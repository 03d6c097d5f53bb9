//! What is known of the stability of a state: it is computed where the tangent is, and told here.

use crate::finding::{Check, Finding, Outcome};

/// Whether the energy is least among the states near by.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Stability {
    #[default]
    NotTested,
    Stable,
    /// With so many directions in which the energy falls, most of all by moving a body.
    Unstable {
        negative: usize,
        body: String,
    },
}

/// An unstable state is none that a body is found in.
pub fn check(stability: &Stability) -> Option<Finding> {
    match stability {
        Stability::NotTested => None,
        Stability::Stable => Some(Finding::new(Check::Stability, Outcome::Fine, "the state is stable")),
        Stability::Unstable { negative, body } => {
            let message =
                format!("the state is unstable in {negative} direction{}", if *negative == 1 { "" } else { "s" });
            let finding = Finding::new(Check::Stability, Outcome::Refused, message).measured(*negative as f64, 0.0);
            Some(finding.on(body).remedy("use a small lateral load and smaller increments to reach the stable branch"))
        }
    }
}
