//! What fields are called in a page, and their units.

use signorini::report::{TractionKind, UnitNames};

/// A field that can be shown.
#[derive(Clone, Debug, PartialEq)]
pub struct Named {
    pub label: String,
    pub unit: String,
}

/// Fields that tell nothing in colours.
const LEFT_OUT: [&str; 19] = [
    "body",
    "element",
    "weight",
    "normal",
    "tangent",
    "contact_status",
    "friction_status",
    "front",
    "floor",
    "ceiling",
    "tau",
    "g",
    "n",
    "kind",
    "contact",
    "pulling_traction",
    "dragging_traction",
    "unstrained_length",
    "s",
];

/// Name and unit of a field of the files; none for what is not shown. Units of pressures of contacts are those of what a
/// contact carries.
pub fn named(name: &str, units: Option<&UnitNames>, carries: TractionKind) -> Option<Named> {
    if LEFT_OUT.contains(&name) {
        return None;
    }
    let unit = |of: fn(&UnitNames) -> &String| units.map_or(String::new(), |u| of(u).clone());
    let carried = || units.map_or(String::new(), |u| carries.units(u)[1].to_string());
    let (label, unit) = match name {
        "von_mises" => ("Equivalent stress (von Mises)", unit(|u| &u.pressure)),
        "plastic_strain" => ("Equivalent plastic strain", String::new()),
        "temperature" => ("Temperature", unit(|u| &u.temperature)),
        "contact_pressure" => match carries {
            TractionKind::Pressure => ("Contact pressure", carried()),
            TractionKind::LineLoad => ("Contact force per length", carried()),
            TractionKind::Force => ("Contact force", carried()),
        },
        "displacement" => ("Displacement", unit(|u| &u.length)),
        "gap" => ("Gap", unit(|u| &u.length)),
        "slip" => ("Slip", unit(|u| &u.length)),
        "arc_length" => ("Arc length", unit(|u| &u.length)),
        "friction_traction" => ("Friction", carried()),
        "friction_utilisation" | "utilisation" => ("Use of friction", String::new()),
        "tension" => ("Tension", unit(|u| &u.force)),
        "axial_force" => ("Axial force", unit(|u| &u.force)),
        "shear_force" => ("Shear force", unit(|u| &u.force)),
        "normal_force" => ("Normal force per length", unit(|u| &u.line_load)),
        "bending_moment" => ("Bending moment", unit(|u| &u.moment)),
        "torque" => ("Torque", unit(|u| &u.moment)),
        "normal_curvature" | "k_n" => ("Normal curvature", String::new()),
        "geodesic_curvature" | "k_g" => ("Geodesic curvature", String::new()),
        "tan_alpha" => ("Tangent of the lateral angle", String::new()),
        other => match other.strip_prefix("stress_") {
            Some(component) => {
                return Some(Named { label: format!("Stress {component}"), unit: unit(|u| &u.pressure) });
            }
            None => return Some(Named { label: sentence(other), unit: String::new() }),
        },
    };
    Some(Named { label: label.into(), unit })
}

/// A key as words: `contact_pressure` is “Contact pressure”.
pub fn sentence(key: &str) -> String {
    let text = key.replace('_', " ");
    let mut letters = text.chars();
    letters.next().map_or(String::new(), |first| first.to_uppercase().collect::<String>() + letters.as_str())
}

/// Fields that a reader wants to see first, the most wanted first.
pub const WANTED: [&str; 11] = [
    "von_mises",
    "plastic_strain",
    "temperature",
    "contact_pressure",
    "utilisation",
    "friction_utilisation",
    "tension",
    "axial_force",
    "bending_moment",
    "normal_force",
    "displacement",
];
