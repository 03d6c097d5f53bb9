//! Units of the numbers of a summary, by the last keys of their paths.

use crate::report::{TractionKind, UnitNames};
use serde_json::Value;

/// The unit of a number in a summary; empty where it has none.
pub fn unit(summary: &Value, path: &str) -> String {
    let Ok(names) = serde_json::from_value::<UnitNames>(summary["units"].clone()) else { return String::new() };
    let keys: Vec<&str> =
        path.split('.').filter(|k| !matches!(*k, "x" | "y" | "z") && k.parse::<i64>().is_err()).collect();
    let has = |word: &str| keys.contains(&word);
    let carries = carried(summary, path);
    let [area, pressure] = carries.units(&names);
    let unit = match *keys.last().unwrap_or(&"") {
        _ if has("support_forces") || has("load_forces") => &names.force,
        _ if has("support_moments") || has("load_moments") => &names.moment,
        "moment" | "start_bending_moment" | "end_bending_moment" | "max_bending_moment" | "max_torque" => &names.moment,
        "area" | "stick_area" | "slip_area" | "area_before" | "area_after" => area,
        "max_pressure" | "min_pressure" => pressure,
        "pressure" | "von_mises" | "mean_stress" => &names.pressure,
        "radius"
        | "boundary_length"
        | "max_penetration"
        | "min_gap_outside"
        | "max_slip"
        | "displacement"
        | "at"
        | "length"
        | "unstrained_length"
        | "front"
        | "centroid"
        | "max_bending_moment_at"
        | "start_radius" => &names.length,
        "rotation" | "start_angle" | "theta" => "rad",
        "volume" => return format!("{}·{}", names.area, names.length),
        "tension" | "tension_limits" | "least" | "largest" => &names.force,
        "wall_seconds" | "cpu_seconds" | "audit_seconds" => "s",
        "peak_memory" => "B",
        key if key.starts_with("energy")
            || matches!(key, "adhesion_energy" | "dissipation" | "plastic_dissipation") =>
        {
            &names.energy
        }
        key if key.contains("force") || key.ends_with("_tension") => &names.force,
        _ => "",
    };
    unit.to_string()
}

/// What the contact of a path carries.
fn carried(summary: &Value, path: &str) -> TractionKind {
    let Some(rest) = path.split_once("contacts.").map(|(_, rest)| rest) else { return TractionKind::Pressure };
    let steps = summary["steps"].as_array().into_iter().flatten();
    let contacts = steps.filter_map(|step| step["contacts"].as_object()).flatten();
    let contact = contacts.filter(|(name, _)| rest.starts_with(&format!("{name}."))).max_by_key(|(name, _)| name.len());
    contact.and_then(|(_, c)| serde_json::from_value(c["carries"].clone()).ok()).unwrap_or_default()
}
