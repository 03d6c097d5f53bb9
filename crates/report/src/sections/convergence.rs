//! How increments converged: iterations, residuals, solver.

use crate::folder::Results;
use crate::html::table;
use crate::sections::verdict::reason;
use signorini::output::figure::figure;
use signorini::report::StepReport;
use signorini::report::headed;

/// More increments than this are not read one by one.
const ROWS: usize = 100;

/// The table of the increments; the chart of residuals stands above it.
pub fn table_of_steps(results: &Results) -> String {
    let steps: Vec<&StepReport> = results.steps().iter().filter(|s| s.iterations + s.iterations_before > 0).collect();
    let has_linear = steps.iter().any(|s| s.linear_iterations.is_some());
    let mut head: Vec<String> =
        ["t", "ended", "iterations", "before", "last residual", "solver"].map(String::from).to_vec();
    head[4] = headed("last residual", "tolerance");
    if has_linear {
        head.push("linear iterations".into());
    }
    let row = |s: &&StepReport| {
        let residual = s.residual_history.last().map_or(String::new(), |r| format!("{r:.1e}"));
        let mut row = vec![
            figure(s.time, Some(1e-6)),
            reason(s.reason).replace('_', " "),
            s.iterations.to_string(),
            s.iterations_before.to_string(),
            residual,
            s.solver.clone(),
        ];
        if has_linear {
            row.push(s.linear_iterations.map_or(String::new(), |n| n.to_string()));
        }
        row
    };
    let from = steps.len().saturating_sub(ROWS);
    let note = if from == 0 {
        String::new()
    } else {
        format!("<p class=\"note\">The last {ROWS} of {} increments.</p>", steps.len())
    };
    table("Increments", &head, &steps[from..].iter().map(row).collect::<Vec<_>>()) + &note
}
