//! Solver and choices, versions, how to cite.

use crate::folder::Results;
use crate::html::{list, section};
use signorini::output::figure::figure;
use std::collections::BTreeSet;

/// The publication of the method of membranes, and this software.
const SOFTWARE: &str = "The signorini developers: signorini, contact mechanics that puts geometry first";
const MEMBRANES: &str = "M. Graveleau, N. Chevaugeon, N. Moës: The inequality level-set approach to handle contact: membrane \
                         case. Advanced Modeling and Simulation in Engineering Sciences 2:16 (2015)";

/// How it was solved, and on what.
pub fn environment(results: &Results) -> String {
    let mut entries: Vec<(String, String)> = Vec::new();
    let mut add = |name: &str, text: String| {
        if !text.is_empty() {
            entries.push((name.into(), text));
        }
    };
    let solvers: BTreeSet<&str> = results.steps().iter().map(|s| s.solver.as_str()).filter(|s| !s.is_empty()).collect();
    if let Some(summary) = results.summary() {
        add("Method", format!("`{}`", summary.method));
        add("Unknowns", if summary.unknowns > 0 { summary.unknowns.to_string() } else { String::new() });
        add("Linear solver", solvers.into_iter().collect::<Vec<_>>().join(", "));
        let e = &summary.environment;
        add("Version", format!("signorini {}", e.version));
        let cpu = e.cpu_seconds.map_or(String::new(), |t| format!(", {} s of processors", figure(t, Some(0.1))));
        let threads = if e.threads == 1 { "1 thread".to_string() } else { format!("{} threads", e.threads) };
        add("Time", format!("{} s{cpu}, {threads}", figure(e.wall_seconds, Some(0.1))));
        add("Memory", e.peak_memory.map_or(String::new(), |m| format!("{:.0} MB at most", m as f64 / 1e6)));
        add(
            "Time of the audit",
            if e.audit_seconds > 0.0 { format!("{:.2} s", e.audit_seconds) } else { String::new() },
        );
        add("Hash of the case", format!("`{}`", e.input_hash));
    } else {
        let version = results.version.clone().unwrap_or_else(|| env!("CARGO_PKG_VERSION").into());
        add("Version", format!("signorini {version}"));
        add("Linear solver", solvers.into_iter().collect::<Vec<_>>().join(", "));
    }
    add("Report", format!("signorini {}", env!("CARGO_PKG_VERSION")));
    section("solution", "Solution and versions", &list(&entries))
}

/// What to cite for this run.
pub fn cite(results: &Results) -> String {
    let version = results.version.as_deref().unwrap_or(env!("CARGO_PKG_VERSION"));
    let is_of_membranes = results.summary().is_some_and(|s| s.method == "inequality_level_set");
    let mut lines = vec![format!("<li>{SOFTWARE}, version {}.</li>", crate::html::escaped(version))];
    if is_of_membranes {
        lines.push(format!("<li>{MEMBRANES}.</li>"));
    }
    section("cite", "How to cite", &format!("<ul>{}</ul>", lines.concat()))
}
