//! Histories and outlines as CSV.

use crate::snapshot::Snapshot;
use serde_json::Value;

/// One line per increment, from the steps of the summary.
pub fn history(steps: &[Value], contact: Option<&str>, probes: &[String]) -> String {
    let mut header = ["index", "time", "converged", "iterations", "energy", "equilibrium_residual"].join(",");
    const CONTACT: [&str; 8] = [
        "area",
        "zones",
        "holes",
        "boundary_length",
        "max_penetration",
        "min_gap_outside",
        "max_pressure",
        "min_pressure",
    ];
    if contact.is_some() {
        header += ",force,";
        header += &CONTACT.join(",");
    }
    for probe in probes {
        header += &format!(",{probe}");
    }
    let mut text = header + "\n";
    for step in steps {
        let cell = |v: &Value| if v.is_null() { String::new() } else { v.to_string().trim_matches('"').to_string() };
        let mut row: Vec<String> = ["index", "time", "converged", "iterations", "energy", "equilibrium_residual"]
            .iter()
            .map(|k| cell(&step[*k]))
            .collect();
        if let Some(name) = contact {
            let c = &step["contacts"][name];
            row.push(cell(&c["force"][2]));
            row.extend(CONTACT.iter().map(|k| cell(&c[*k])));
        }
        row.extend(probes.iter().map(|p| cell(&step["probes"][p]["displacement"])));
        text += &(row.join(",") + "\n");
    }
    text
}

/// Front number and coordinates of every point of the outlines.
pub fn outlines<const D: usize>(s: &Snapshot<D>) -> String {
    let mut text = String::from(if D == 1 { "front,x\n" } else { "front,x,y\n" });
    for (i, outline) in s.outlines.iter().enumerate() {
        for p in outline {
            let x: Vec<String> = p.iter().map(|v| format!("{v:.15e}")).collect();
            text += &format!("{i},{}\n", x.join(","));
        }
    }
    text
}
