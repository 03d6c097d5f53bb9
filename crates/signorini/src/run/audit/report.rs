//! What findings come to: the answer of a run, the ± of its figures, and what other checks have found.

use crate::problem::{Body, Problem};
use crate::report::{ErrorEstimate, StepReport, Warning, WarningKind};
use signorini_audit::{Answer, Check, Finding, Outcome};

/// ± of a force, and of an area or a pressure, relative to them, from which the figure is told to be uncertain.
const FORCE: f64 = 0.1;
const PEAK: f64 = 0.3;
/// Part of the largest pressure that may pull by rounding.
const PULLS: f64 = 1e-3;
/// Part of the forces that may be out of balance, and from which there is no equilibrium.
const TOLD: f64 = 1e-5;
const REFUSED: f64 = 1e-3;

/// The answer of a run; none where it has not come to its end, or nothing was checked.
pub fn answer(steps: &[StepReport], problem: &Problem) -> Option<Answer> {
    let last = steps.last()?;
    if steps.iter().all(|s| s.audit.is_empty()) {
        return None;
    }
    let findings: Vec<(f64, &[Finding])> = steps.iter().map(|s| (s.time, &s.audit[..])).collect();
    Some(Answer::new(&findings, &within(last, problem)))
}

/// Within what the figures of the last step are right.
fn within(step: &StepReport, problem: &Problem) -> String {
    let shares: Vec<[f64; 3]> = step
        .contacts
        .values()
        .filter(|c| c.zones > 0)
        .filter_map(|c| Some(shares(&c.force, c.area, c.max_pressure, &c.error_estimate?)))
        .collect();
    let most = |k: usize| shares.iter().map(|s| s[k]).filter(|s| s.is_finite()).fold(0.0, f64::max);
    if !shares.is_empty() {
        let [force, area, pressure] = [0, 1, 2].map(|k| format!("{:.1e}", most(k)));
        return format!(
            "within ±: {force} of the force, {area} of the area, {pressure} of the largest contact pressure"
        );
    }
    let deforms = |b: &Body| matches!(b, Body::Solid(_) | Body::Cells(_));
    let of_membrane = problem.bodies.values().any(|b| matches!(b, Body::Membrane(_)));
    let why = if step.contacts.values().all(|c| c.zones == 0) {
        "there is no contact, so no contact force to estimate the error of"
    } else if problem.bodies.values().any(|b| matches!(b, Body::Rope(_) | Body::Beam(_))) {
        "the discretisation error of ropes and beams is not estimated: compare with a run with twice as many cells"
    } else if of_membrane {
        "this method has no error estimate: compare with a run with smaller cells"
    } else if problem.bodies.values().any(deforms) {
        "the discretisation error is not estimated, as this would take longer than the run: compare with a run with \
         smaller cells"
    } else {
        "the bodies have no cells, so there is no discretisation error"
    };
    format!("as far as it was checked; {why}")
}

/// Part of the largest pressure over the whole area that a force is at least, but for what cancels in it, as around a ring.
const NOT_CANCELLED: f64 = 0.1;

/// The ± of force, area and largest pressure, relative to them.
fn shares(force: &[f64; 3], area: f64, pressure: f64, errors: &ErrorEstimate) -> [f64; 3] {
    let size = force.iter().map(|f| f * f).sum::<f64>().sqrt().max(NOT_CANCELLED * area * pressure);
    let share = |error: f64, of: f64| match (error > 0.0, of > 0.0) {
        (true, true) => error / of,
        (true, false) => 1.0,
        _ => 0.0,
    };
    [share(errors.force, size), share(errors.area, area), share(errors.max_pressure.unwrap_or(0.0), pressure)]
}

/// Figures whose ± is large.
pub fn of_errors(step: &StepReport) -> Vec<Finding> {
    let mut out = Vec::new();
    for (name, c) in &step.contacts {
        let Some(errors) = &c.error_estimate else { continue };
        let found = shares(&c.force, c.area, c.max_pressure, errors);
        for ((share, limit), what) in
            found.into_iter().zip([FORCE, PEAK, PEAK]).zip(["force", "area", "largest pressure"])
        {
            if share > limit {
                let message = format!("the {what} of `{name}` has an error estimate of ± {:.0} %", 100.0 * share);
                let finding = Finding::new(Check::Resolution, Outcome::Doubt, message).measured(share, limit);
                out.push(finding.on(name).remedy("use smaller cells at the contact, or a higher degree"));
                break;
            }
        }
    }
    out
}

/// Whether the ± of a contact is known and small, so that its cells are small enough however few they are.
pub fn is_resolved(step: &StepReport, name: Option<&String>) -> bool {
    let Some(c) = name.and_then(|name| step.contacts.get(name)) else { return false };
    let Some(errors) = &c.error_estimate else { return false };
    shares(&c.force, c.area, c.max_pressure, errors).into_iter().zip([FORCE, PEAK, PEAK]).all(|(s, limit)| s <= limit)
}

/// What the solvers themselves warn of, as findings about the increment that ends at a time.
pub fn of_warnings(warnings: &[Warning], time: f64) -> Vec<Finding> {
    let mut out: Vec<Finding> = Vec::new();
    for warning in warnings.iter().filter(|w| w.time == Some(time)) {
        let check = match warning.kind {
            WarningKind::SteepSlopes => Check::Range,
            WarningKind::PressureOscillates
            | WarningKind::NotResolved
            | WarningKind::NotRefined
            | WarningKind::FewerModes
            | WarningKind::SharpFront => Check::Resolution,
            WarningKind::Kink | WarningKind::FrontsAtRest => Check::Resolution,
            WarningKind::Unstable => Check::Stability,
            WarningKind::NotUnique | WarningKind::ClosesAtOnce => Check::Uniqueness,
            _ => continue,
        };
        let finding = Finding::new(check, Outcome::Doubt, warning.message.clone());
        out.push(match warning.at {
            Some(at) => finding.at(at),
            None => finding,
        });
    }
    out
}

/// What the figures of a membrane tell: its balance, the sign of its pressures, its stability.
pub fn of_membrane(step: &StepReport) -> Vec<Finding> {
    let mut out = Vec::new();
    if let Some(lack) = step.equilibrium_residual {
        let (outcome, limit) = match lack {
            l if l > REFUSED => (Outcome::Refused, REFUSED),
            l if l > TOLD => (Outcome::Doubt, TOLD),
            _ => (Outcome::Fine, TOLD),
        };
        let message = format!("the sum of the forces on the membrane is {lack:.1e} of the largest force");
        out.push(Finding::new(Check::Balance, outcome, message).measured(lack, limit));
    }
    for (name, c) in &step.contacts {
        if let Some(least) = c.min_pressure.filter(|_| c.zones > 0 && c.max_pressure > 0.0) {
            let share = (-least / c.max_pressure).max(0.0);
            // What adhesion holds may pull.
            let pulls = share > PULLS && c.adhesion_energy.is_none();
            let message = format!("the smallest contact pressure of `{name}` is {least:.3e}");
            let outcome = if pulls { Outcome::Doubt } else { Outcome::Fine };
            let finding = Finding::new(Check::Tractions, outcome, message).measured(share, PULLS).on(name);
            out.push(if pulls { finding.remedy("use smaller cells at the fronts") } else { finding });
        }
        if let Some(stable) = c.stable {
            let (outcome, what) = if stable { (Outcome::Fine, "stable") } else { (Outcome::Doubt, "unstable") };
            out.push(Finding::new(Check::Stability, outcome, format!("the state of `{name}` is {what}")).on(name));
        }
    }
    out
}
