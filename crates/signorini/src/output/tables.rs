//! Histories and outlines as CSV.

use crate::snapshot::Snapshot;
use serde_json::Value;

/// One line per increment, from the steps of the summary.
pub fn history(steps: &[Value], contacts: &[&str], probes: &[String]) -> String {
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
    for name in contacts {
        // With one contact there is nothing to tell apart.
        let of = if contacts.len() > 1 { format!("{name}:") } else { String::new() };
        header += &format!(",{of}force");
        CONTACT.iter().for_each(|key| header += &format!(",{of}{key}"));
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
        for name in contacts {
            let c = &step["contacts"][*name];
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

/// One line per increment of solids: forces, area and largest pressure of every contact, forces of supports, probes.
pub fn solid_history<const D: usize>(steps: &[Value], plan: &crate::plan::solid::SolidPlan<D>) -> String {
    const ESTIMATED: [&str; 3] = ["force", "area", "max_pressure"];
    let axes = &["x", "y", "z"][..D];
    let supports: std::collections::BTreeSet<&str> =
        plan.supports.iter().map(|s| s.name.as_str()).filter(|n| *n != "axis").collect();
    let mut header: Vec<String> =
        ["index", "time", "converged", "iterations", "energy"].iter().map(|s| s.to_string()).collect();
    for c in &plan.contacts {
        header.extend(axes.iter().map(|a| format!("{}:force_{a}", c.name)));
        header.extend(["area", "max_pressure", "max_penetration"].iter().map(|k| format!("{}:{k}", c.name)));
        header.extend(ESTIMATED.iter().map(|k| format!("{}:{k}_error", c.name)));
    }
    for s in &supports {
        header.extend(axes.iter().map(|a| format!("{s}:force_{a}")));
    }
    for p in plan.probes.keys() {
        header.extend(axes.iter().map(|a| format!("{p}:displacement_{a}")));
    }
    let mut text = header.join(",") + "\n";
    let cell = |v: &Value| if v.is_null() { String::new() } else { v.to_string() };
    for step in steps {
        let mut row: Vec<String> =
            ["index", "time", "converged", "iterations", "energy"].iter().map(|k| cell(&step[*k])).collect();
        for c in &plan.contacts {
            let c = &step["contacts"][&c.name];
            row.extend((0..D).map(|k| cell(&c["force"][k])));
            row.extend(["area", "max_pressure", "max_penetration"].iter().map(|k| cell(&c[*k])));
            row.extend(ESTIMATED.iter().map(|k| cell(&c["error_estimate"][*k])));
        }
        for s in &supports {
            row.extend((0..D).map(|k| cell(&step["support_forces"][*s][k])));
        }
        for p in plan.probes.keys() {
            row.extend((0..D).map(|k| cell(&step["probes"][p]["displacement"][k])));
        }
        text += &(row.join(",") + "\n");
    }
    text
}

/// Position, pressure, gap and status of every pressure node of a contact.
pub fn pressure<const D: usize>(shown: &super::solid_fields::ContactDisplay<D>) -> String {
    let mut text = ["x", "y", "z"][..D].join(",") + ",pressure,gap,in_contact\n";
    for k in 0..shown.points.len() {
        let x: Vec<String> = shown.points[k].iter().map(|v| format!("{v:.15e}")).collect();
        text += &format!("{},{:e},{:e},{}\n", x.join(","), shown.pressure[k], shown.gap[k], u8::from(shown.active[k]));
    }
    text
}

/// Both ends of every piece of the outlines of a contact zone, where it is now; in the plane an end of the zone.
pub fn solid_outline<const D: usize>(pieces: &[[signorini_geometry::Point<D>; 2]]) -> String {
    let mut text = format!("piece,{}\n", ["x", "y", "z"][..D].join(","));
    for (k, ends) in pieces.iter().enumerate() {
        for x in &ends[..if D == 2 { 1 } else { 2 }] {
            let x: Vec<String> = x.iter().map(|v| format!("{v:.15e}")).collect();
            text += &format!("{k},{}\n", x.join(","));
        }
    }
    text
}
