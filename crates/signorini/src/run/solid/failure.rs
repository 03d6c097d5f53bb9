//! Why an increment of solids has no state, in words.

use crate::plan::pieces::Apart;
use crate::plan::solid::SolidPlan;
use crate::report::Reason;
use signorini_solid::StepError;

/// A failure in words: the reason for the summary, what happened and what to try.
pub struct Failure {
    pub reason: Reason,
    pub text: String,
    /// What was left after each iteration until then.
    pub residuals: Vec<f64>,
}

impl Failure {
    pub fn new(reason: Reason, text: String) -> Self {
        Failure { reason, text, residuals: Vec::new() }
    }
}

/// The failure that an error of the solver is.
fn failure(error: &StepError) -> Failure {
    let (reason, text) = match error {
        StepError::Interrupted => (Reason::Interrupted, "interrupted".into()),
        StepError::Free { body, motion } => (
            Reason::FreeBody,
            format!(
                "body `{body}` is free {motion}: neither its supports nor its contacts restrain this motion; add a \
                 support or a spring"
            ),
        ),
        StepError::PulledAway { body, direction } => (
            Reason::FreeBody,
            format!(
                "body `{body}` is pulled away {direction}: only contact restrains it in this direction, and contact \
                 forces are compressive; reverse the load, or add a support or a spring"
            ),
        ),
        StepError::Solve(error) => (
            Reason::LinearSolver,
            format!(
                "{error}; check that all bodies are supported and that their stiffnesses do not differ by many orders \
                 of magnitude"
            ),
        ),
        StepError::Deep { contact, depth } => (
            Reason::Increment,
            format!(
                "the increment is too large: it leads to a penetration of {depth:.4e} between the bodies of \
                 `{contact}`; use more increments"
            ),
        ),
        StepError::Slides { .. } => (Reason::FreeBody, error.to_string()),
        StepError::Support(_)
        | StepError::Shape { .. }
        | StepError::FrictionUnsupported { .. }
        | StepError::FrictionAxis { .. } => (Reason::Input, error.to_string()),
        StepError::Contact { contact, error, places } => (
            Reason::Contact,
            format!(
                "contact `{contact}`: {error}{}; use more increments, or a finer mesh there",
                if places.is_empty() { String::new() } else { format!(" ({})", places.join(", ")) }
            ),
        ),
    };
    Failure::new(reason, text)
}

/// A failure, and what may be behind it: of a body that is free, that its mesh falls into pieces.
pub fn explained<const D: usize>(plan: &SolidPlan<D>, error: &StepError) -> Failure {
    let mut failed = failure(error);
    if let StepError::Free { body, .. } | StepError::PulledAway { body, .. } = error
        && let Some(apart) = plan.bodies.iter().find(|b| b.name == *body).and_then(|b| Apart::new(&b.mesh))
    {
        failed.text += &format!("; {}", apart.text(body));
    }
    failed
}
