//! Warnings, and what the audit found that is not fine, each with its place.

use crate::folder::Results;
use crate::html::{prose, section};
use signorini::output::figure::{figure, figures};
use signorini_audit::Outcome;

/// Warnings and findings.
pub fn warnings(results: &Results) -> String {
    let unit = results.summary().and_then(|s| s.units.as_ref()).map_or("", |u| u.length.as_str());
    let place = |time: Option<f64>, at: Option<[f64; 3]>| {
        let time = time.map(|t| format!("t = {}", figure(t, None)));
        let at = at.map(|x| format!("at {} {unit}", figures(&x, None)).trim_end().to_string());
        let text = [time, at].into_iter().flatten().collect::<Vec<_>>().join(", ");
        if text.is_empty() { text } else { format!(" <span class=\"place\">({text})</span>") }
    };
    let mut lines: Vec<String> = Vec::new();
    let mut seen: Vec<String> = Vec::new();
    let mut told: Vec<&str> = Vec::new();
    let findings = results.steps().iter().flat_map(|s| s.audit.iter().map(move |f| (s.time, f)));
    for (time, finding) in findings.filter(|(_, f)| f.outcome != Outcome::Fine) {
        // What holds for many increments is told of the first.
        let about = format!("{:?} {:?} {:?}", finding.check, finding.outcome, finding.on);
        if seen.contains(&about) {
            continue;
        }
        seen.push(about);
        told.push(&finding.message);
        let class = if finding.outcome == Outcome::Refused { "bad" } else { "doubt" };
        let remedy = finding.remedy.as_ref().map_or(String::new(), |r| format!(" <em>{}</em>", prose(&sentence(r))));
        let text = sentence(&finding.message);
        lines.push(format!("<li class=\"{class}\">{}{}{remedy}</li>", prose(&text), place(Some(time), finding.place)));
    }
    // Some findings are warnings too.
    let others = results.warnings().into_iter().filter(|w| !told.contains(&w.message.as_str()));
    for warning in others {
        let text = sentence(&warning.message);
        lines.push(format!("<li class=\"doubt\">{}{}</li>", prose(&text), place(warning.time, warning.at)));
    }
    if lines.is_empty() {
        return String::new();
    }
    section("warnings", "Warnings", &format!("<ul class=\"warnings\">{}</ul>", lines.concat()))
}

/// With a capital and a full stop.
fn sentence(text: &str) -> String {
    let mut letters = text.trim().chars();
    let first = letters.next().map_or(String::new(), |c| c.to_uppercase().collect());
    let text = first + letters.as_str();
    if text.ends_with(['.', '!', '?', ':']) { text } else { text + "." }
}
