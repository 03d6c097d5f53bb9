//! What a contact of a surface came to, in a clause.

use crate::output::figure::{told, told_vector};
use crate::report::{ContactReport, UnitNames};

/// How much of a contact with friction sticks, unless it is a point without area.
pub fn sticking(c: &ContactReport) -> String {
    match (c.stick_area, c.slip_area) {
        (Some(stick), Some(slip)) if stick + slip > 0.0 => {
            format!(", {:.0} % of the contact in stick", 100.0 * stick / (stick + slip))
        }
        _ => String::new(),
    }
}

/// The force, over which `extent` (an area, or a length) and the largest pressure, with what the cells leave uncertain, and
/// how much of it sticks. `zones` says in how many.
pub fn contact_verdict(
    (name, c): (&str, &ContactReport),
    (dimension, extent): (usize, &str),
    units: Option<&UnitNames>,
    zones: bool,
) -> String {
    if c.zones == 0 {
        return format!("`{name}` is open");
    }
    let errors = c.error_estimate;
    let unit = |of: fn(&UnitNames) -> &String| units.map_or("", |u| of(u));
    let rubbing = c.friction_force.map_or(String::new(), |force| {
        let force = told_vector(&force[..dimension], None, unit(|u| &u.force));
        format!(", friction {force}{}", sticking(c))
    });
    let zones = match (zones, c.zones) {
        (false, _) => String::new(),
        (true, n) => format!(" in {n} zone{}", if n == 1 { "" } else { "s" }),
    };
    format!(
        "`{name}` transmits {} over {extent} {}{zones}, largest pressure {}{rubbing}",
        told_vector(&c.force[..dimension], errors.map(|e| e.force), unit(|u| &u.force)),
        told(c.area, errors.map(|e| e.area), unit(|u| &u.area)),
        told(c.max_pressure, errors.and_then(|e| e.max_pressure), unit(|u| &u.pressure)),
    )
}
