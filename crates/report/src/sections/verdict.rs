//! Whether the result is an answer: what a reader sees first.

use crate::folder::{Results, Told};
use crate::html::{escaped, prose};
use signorini::output::figure::figure;
use signorini::report::{Reason, StepReport, Summary};
use signorini_audit::{Outcome, Verdict};

/// How good it is, as a class of the style sheet.
#[derive(Clone, Copy, PartialEq, PartialOrd)]
enum Grade {
    Good,
    Doubt,
    Bad,
}

impl Grade {
    fn class(self) -> &'static str {
        match self {
            Self::Good => "good",
            Self::Doubt => "doubt",
            Self::Bad => "bad",
        }
    }

    fn sign(self) -> &'static str {
        match self {
            Self::Good => "✓",
            Self::Doubt => "!",
            Self::Bad => "✗",
        }
    }
}

/// One line of the verdict: what was asked, how it is, in words.
type Badge = (&'static str, Grade, String);

/// The verdict in short, its sentences, and what stands behind it.
pub fn verdict(results: &Results) -> String {
    let (grade, short, sentences, badges) = match &results.told {
        Told::Run(summary) => run(summary),
        Told::Unfinished(found) => {
            let last = found.steps.last();
            let text = match (last, results.iterations.last()) {
                (Some(step), _) => {
                    format!("The last stored increment ends at t = {}.", figure(step.time, Some(1e-6)))
                }
                (None, Some(i)) => format!("It is in the increment that ends at t = {}.", figure(i.time, Some(1e-6))),
                (None, None) => "Nothing has been stored yet.".into(),
            };
            let help =
                "The run goes on, or it was stopped before its end. To continue it: `signorini run CASE --resume`.";
            (Grade::Doubt, "Not finished".to_string(), vec![text, help.to_string()], badges(&found.steps, None, true))
        }
        Told::Answers(list) => {
            let (is_good, text) = super::answers::sentence(list);
            let (grade, short) = if is_good { (Grade::Good, "Done") } else { (Grade::Doubt, "Not all answered") };
            (grade, short.to_string(), vec![text], Vec::new())
        }
        Told::Other(value) => {
            let converged = value["converged"].as_bool().unwrap_or(true);
            let grade = if converged { Grade::Good } else { Grade::Bad };
            let short = if converged { "Done" } else { "Not converged" };
            let text = value["verdict"].as_str().map(String::from).unwrap_or_else(|| scene_sentence(value));
            (grade, short.to_string(), vec![text], Vec::new())
        }
    };
    let sentences: String =
        (sentences.iter().filter(|s| !s.is_empty())).map(|s| format!("<p>{}</p>", prose(s))).collect();
    let badge = |(name, grade, text): &Badge| {
        let (class, sign) = (grade.class(), grade.sign());
        format!(
            "<div class=\"badge {class}\"><dt>{name}</dt><dd><span aria-hidden=\"true\">{sign}</span> {}</dd></div>",
            escaped(text)
        )
    };
    let badges: String = badges.iter().map(badge).collect();
    let badges = if badges.is_empty() { String::new() } else { format!("<dl class=\"badges\">{badges}</dl>") };
    let sign = grade.sign();
    format!(
        "<section id=\"verdict\" class=\"{}\" aria-label=\"Verdict\"><p class=\"short\"><span aria-hidden=\"true\">{sign}</span> {}</p>\
         <div class=\"sentences\">{sentences}</div>{badges}</section>\n",
        grade.class(),
        escaped(&short)
    )
}

fn run(summary: &Summary) -> (Grade, String, Vec<String>, Vec<Badge>) {
    let answer = summary.answer.as_ref();
    let verdict = answer.map(|a| a.verdict);
    let (grade, short) = match (summary.converged, verdict, summary.reason) {
        (_, Some(Verdict::NotAnAnswer), _) | (_, _, Reason::Refused) => (Grade::Bad, "Not an answer"),
        (_, _, Reason::Interrupted) => (Grade::Doubt, "Interrupted"),
        (_, _, Reason::LimitReached) => (Grade::Doubt, "Stopped at a limit"),
        (false, ..) => (Grade::Bad, "Not converged"),
        (true, Some(Verdict::RightBut), _) => (Grade::Doubt, "Right, but"),
        (true, Some(Verdict::RightWithin), _) => (Grade::Good, "Right"),
        (true, None, _) => (Grade::Good, "Done"),
    };
    let mut sentences: Vec<String> = answer.map(|a| a.text.clone()).into_iter().collect();
    if !sentences.contains(&summary.verdict) {
        sentences.push(summary.verdict.clone());
    }
    if !summary.converged {
        let word = reason(summary.reason);
        let told = signorini::explain::explain(&word).unwrap_or_default();
        let about = told.split("\n\n").last().unwrap_or_default().trim();
        let (name, about) = about.split_once('\n').unwrap_or(("", about));
        let about = if about.is_empty() { name } else { about };
        sentences.push(format!("`{word}`: {}", about.split_whitespace().collect::<Vec<_>>().join(" ")));
    }
    // Longer sentences than these stand in the table of what was found.
    let unit = summary.units.as_ref().map(|u| u.length.as_str());
    let is_mechanics = summary.steps.iter().any(|s| !s.contacts.is_empty() || s.equilibrium_residual.is_some());
    let badges = if is_mechanics { badges(&summary.steps, unit, summary.converged) } else { Vec::new() };
    (grade, short.to_string(), sentences, badges)
}

/// A reason as the word of the summary.
pub fn reason(of: Reason) -> String {
    serde_json::to_value(of).ok().and_then(|v| v.as_str().map(String::from)).unwrap_or_default()
}

/// Converged, in balance, not in each other, checked.
fn badges(steps: &[StepReport], unit: Option<&str>, converged: bool) -> Vec<Badge> {
    let mut out = Vec::new();
    let done = steps.iter().filter(|s| s.converged).count();
    let count = |n: usize, what: &str| format!("{n} {what}{}", if n == 1 { "" } else { "s" });
    out.push(match steps.iter().find(|s| !s.converged) {
        _ if steps.is_empty() => ("Converged", Grade::Doubt, "no increment".into()),
        None if converged => ("Converged", Grade::Good, count(done, "increment")),
        None => ("Converged", Grade::Doubt, format!("{}, then it stopped", count(done, "increment"))),
        Some(bad) => {
            let word = reason(bad.reason).replace('_', " ");
            let was_stopped = matches!(bad.reason, Reason::Interrupted | Reason::LimitReached);
            (
                "Converged",
                if was_stopped { Grade::Doubt } else { Grade::Bad },
                format!("{}, then {word} at t = {}", count(done, "increment"), figure(bad.time, None)),
            )
        }
    });
    let shown = || steps.iter().filter(|s| s.converged);
    if let Some(worst) = shown().filter_map(|s| s.equilibrium_residual).reduce(f64::max) {
        let grade = if worst < 1e-5 { Grade::Good } else { Grade::Doubt };
        out.push(("Forces balance", grade, format!("to {worst:.0e} of the largest")));
    }
    let depths = || shown().flat_map(|s| s.contacts.values()).map(|c| c.max_penetration);
    if let Some(depth) = depths().reduce(f64::max) {
        let found: Vec<_> = shown().flat_map(|s| &s.audit).collect();
        let refused = found.iter().any(|f| f.check == signorini_audit::Check::Gaps && f.outcome == Outcome::Refused);
        let text = if depth <= 0.0 {
            "none".into()
        } else {
            format!("at most {depth:.0e} {}", unit.unwrap_or("")).trim_end().to_string()
        };
        out.push(("Penetration", if refused { Grade::Bad } else { Grade::Good }, text));
    }
    let findings: Vec<_> = steps.iter().flat_map(|s| &s.audit).collect();
    if !findings.is_empty() {
        let of = |outcome: Outcome| findings.iter().filter(|f| f.outcome == outcome).count();
        let (refused, doubts) = (of(Outcome::Refused), of(Outcome::Doubt));
        out.push(match (refused, doubts) {
            (0, 0) => ("Audit", Grade::Good, "all checks hold".into()),
            (0, n) => ("Audit", Grade::Doubt, format!("{} in doubt", count(n, "finding"))),
            (n, _) => ("Audit", Grade::Bad, format!("{} refused", count(n, "finding"))),
        });
    }
    out
}

fn scene_sentence(value: &serde_json::Value) -> String {
    let closest = &value["closest"];
    let text = |key: &str| closest["pair"][key].as_str().unwrap_or("").to_string();
    match closest["gap"].as_f64() {
        Some(gap) => format!(
            "{} frames. Closest at t = {}: {} to {}, gap {}.",
            value["frames"],
            closest["time"],
            text("a"),
            text("b"),
            figure(gap, None)
        ),
        None => String::new(),
    }
}
