//! The summary as text: the table of the terminal, and the history as CSV.

use super::{ContactReport, ErrorEstimate, ForceBounds, StepReport, Summary, TractionKind, UnitNames, signed_size};
use crate::output::figure::{figure, told_vector};
use std::collections::{BTreeMap, BTreeSet};

/// A column of a table: its heading with the unit, its cells, and whether they are words.
#[derive(Clone, Debug, PartialEq)]
pub struct Column {
    pub heading: String,
    pub cells: Vec<String>,
    pub is_of_words: bool,
}

/// The increments as a table, one line for each contact; the columns of what no increment has are left out.
pub fn table(summary: &Summary) -> String {
    let columns = columns(summary);
    let count = columns.first().map_or(0, |column| column.cells.len());
    let mut rows: Vec<String> = vec![String::new(); count + 1];
    for Column { heading, cells, is_of_words } in &columns {
        let width = cells.iter().chain([heading]).map(|c| c.chars().count()).max().unwrap_or(0);
        for (row, text) in rows.iter_mut().zip([heading].into_iter().chain(cells)) {
            // Names stand to the left.
            *row += &if *is_of_words { format!("  {text:width$}") } else { format!("  {text:>width$}") };
        }
    }
    rows.iter().map(|row| format!("{}\n", row.trim_end())).collect()
}

/// The columns of this table.
pub fn columns(summary: &Summary) -> Vec<Column> {
    let steps = with_errors(&summary.steps);
    let lines: Vec<(&StepReport, Option<(&str, &ContactReport)>)> = (steps.iter())
        .flat_map(|step| {
            let of: Vec<_> = step.contacts.iter().map(|(name, c)| (step, Some((name.as_str(), c)))).collect();
            if of.is_empty() { vec![(step, None)] } else { of }
        })
        .collect();
    type Line<'a> = (&'a StepReport, Option<(&'a str, &'a ContactReport)>);
    type Cell = fn(&StepReport, Option<(&str, &ContactReport)>) -> Option<String>;
    /// The unit of the figures of a contact, or of all of them.
    type Unit = fn(&UnitNames, TractionKind) -> &str;
    let columns: [(&str, Unit, Cell); 11] = [
        ("t", |_, _| "", |s, _| Some(format!("{:.6}", s.time))),
        ("solves", |_, _| "", |s, _| Some(s.solves().to_string())),
        ("contact", |_, _| "", |_, c| Some(c?.0.to_string())),
        ("area", |u, c| c.units(u)[0], |_, c| c.map(|(_, c)| figure(c.area, c.error_estimate.map(|e| e.area)))),
        (
            "force",
            |u, _| &u.force,
            |_, c| c.map(|(_, c)| figure(signed_size(&c.force), c.error_estimate.map(|e| e.force))),
        ),
        ("normal force between", |u, _| &u.force, |_, c| c.and_then(|(_, c)| c.force_bounds.map(between))),
        (
            "max pressure",
            |u, c| c.units(u)[1],
            |_, c| c.map(|(_, c)| figure(c.max_pressure, c.error_estimate.and_then(|e| e.max_pressure))),
        ),
        ("radius", |u, _| &u.length, |_, c| c.and_then(|(_, c)| c.radius.map(|r| figure(r, radius_error(c, r))))),
        ("zones", |_, _| "", |_, c| Some(c?.1.zones.to_string())),
        ("holes", |_, _| "", |_, c| Some(c?.1.holes?.to_string())),
        ("balance", |_, _| "", |s, _| Some(format!("{:.1e}", s.equilibrium_residual?))),
    ];
    let several = summary.steps.iter().any(|s| s.contacts.len() > 1);
    let mut found = Vec::new();
    let carried = |line: &Line| line.1.map_or(TractionKind::Pressure, |(_, c)| c.carries);
    for (title, unit, cell) in columns {
        let cells: Vec<Option<String>> = lines.iter().map(|(s, c)| cell(s, *c)).collect();
        if cells.iter().all(Option::is_none) || (title == "contact" && !several) {
            continue;
        }
        // A unit that all lines have stands above them, others behind the figures.
        let unit_of = |line: &Line| summary.units.as_ref().map_or("", |u| unit(u, carried(line)));
        let units: Vec<&str> = lines.iter().map(unit_of).collect();
        let shared = units.first().copied().filter(|first| units.iter().all(|u| u == first));
        let behind = |unit: &str| if shared.is_some() || unit.is_empty() { String::new() } else { format!(" {unit}") };
        let written = |(text, unit): (Option<String>, &&str)| text.map_or("-".into(), |text| text + &behind(unit));
        let cells: Vec<String> = cells.into_iter().zip(&units).map(written).collect();
        let title = match (title, lines.iter().all(|line| carried(line) == TractionKind::LineLoad)) {
            ("area", true) => "length",
            ("max pressure", true) => "max line load",
            (title, _) => title,
        };
        let heading = headed(title, shared.unwrap_or_default());
        found.push(Column { heading, cells, is_of_words: title == "contact" });
    }
    found
}

/// Bounds as a figure of a table.
fn between(bounds: ForceBounds) -> String {
    let largest = bounds.largest.map_or("∞".to_string(), |f| figure(f, None));
    format!("{} and {largest}", figure(bounds.least, None))
}

/// The increments, those without ± of their own with those of the last, relative to its figures.
fn with_errors(steps: &[StepReport]) -> Vec<StepReport> {
    let mut out = steps.to_vec();
    let known = steps.last().into_iter().flat_map(|s| &s.contacts);
    for (name, known, errors) in known.filter_map(|(name, c)| Some((name, c, c.error_estimate?))) {
        for contact in out.iter_mut().filter_map(|s| s.contacts.get_mut(name)) {
            let scaled = |error: f64, of: fn(&ContactReport) -> f64| error * (of(contact) / of(known)).abs();
            let estimate = ErrorEstimate {
                front: None,
                area: scaled(errors.area, |c| c.area),
                force: scaled(errors.force, |c| signed_size(&c.force)),
                max_pressure: errors.max_pressure.map(|e| scaled(e, |c| c.max_pressure)),
            };
            contact.error_estimate.get_or_insert(estimate);
        }
    }
    out
}

/// How far a radius may be off: relatively no more than the area that it is taken from.
fn radius_error(contact: &ContactReport, radius: f64) -> Option<f64> {
    contact.error_estimate.filter(|_| contact.area > 0.0).map(|e| radius * e.area / contact.area)
}

/// A heading with its unit: `area [mm²]`.
pub fn headed(title: &str, unit: &str) -> String {
    if unit.is_empty() { title.to_string() } else { format!("{title} [{unit}]") }
}

/// The resultants of the last increment, and where free bodies have come: empty where there are neither moments nor free
/// bodies.
pub fn resultants(summary: &Summary) -> String {
    summary.steps.last().into_iter().flat_map(|step| resultants_of(step, summary.units.as_ref())).map(aligned).collect()
}

/// Titles and rows of these tables, of an increment.
pub fn resultants_of(step: &StepReport, units: Option<&UnitNames>) -> Vec<Vec<[String; 3]>> {
    let unit = |of: fn(&UnitNames) -> &String| units.map_or("", |u| of(u));
    let vector = |v: &[f64; 3]| told_vector(v, None, "");
    let mut out = Vec::new();
    if let Some(about) = step.moments_about {
        let contacts = step.contacts.iter().filter_map(|(name, c)| Some((name, &c.force, c.moment.as_ref()?)));
        let supports = step.support_forces.iter().filter_map(|(n, f)| Some((n, f, step.support_moments.get(n)?)));
        let loads = step.load_forces.iter().filter_map(|(n, f)| Some((n, f, step.load_moments.get(n)?)));
        let titles = [
            "".to_string(),
            headed("force on the body", unit(|u| &u.force)),
            headed(&format!("moment about {}", vector(&about)), unit(|u| &u.moment)),
        ];
        let line = |name: String, force: &[f64; 3], moment: &[f64; 3]| [name, vector(force), vector(moment)];
        let rows = (supports.map(|(n, f, m)| line(format!("support {n}"), f, m)))
            .chain(loads.map(|(n, f, m)| line(format!("load {n}"), f, m)))
            .chain(contacts.map(|(n, f, m)| line(format!("contact {n}"), f, m)));
        out.push(std::iter::once(titles).chain(rows).collect());
    }
    if !step.free_bodies.is_empty() {
        let titles = ["".to_string(), headed("displacement", unit(|u| &u.length)), headed("rotation vector", "rad")];
        let rows = step.free_bodies.iter();
        let rows = rows.map(|(n, p)| [format!("free body {n}"), vector(&p.displacement), vector(&p.rotation)]);
        out.push(std::iter::once(titles).chain(rows).collect());
    }
    out
}

/// Columns of text below their titles; nothing without rows.
fn aligned(all: Vec<[String; 3]>) -> String {
    if all.len() < 2 {
        return String::new();
    }
    let width = |k: usize| all.iter().map(|row| row[k].chars().count()).max().unwrap_or(0);
    let widths = [0, 1, 2].map(width);
    let line = |row: &[String; 3]| {
        let cells: Vec<String> = row.iter().zip(widths).map(|(cell, width)| format!("{cell:width$}")).collect();
        format!("  {}\n", cells.join("  ").trim_end())
    };
    all.iter().map(line).collect()
}

/// One line per increment as CSV: contacts, supports, loads, free bodies, bodies of cells and probes by their names; what there is not is left empty.
/// With the units of the case in the header, where it states some.
pub fn history(steps: &[StepReport], units: Option<&UnitNames>) -> String {
    let unit = |of: fn(&UnitNames) -> &String| units.map_or("", |u| of(u));
    fn names<'a, V: 'a>(
        steps: &'a [StepReport],
        of: impl Fn(&'a StepReport) -> &'a BTreeMap<String, V>,
    ) -> BTreeSet<&'a str> {
        steps.iter().flat_map(|s| of(s).keys().map(String::as_str)).collect()
    }
    // Whole numbers as such.
    let number = |v: Option<f64>| match v {
        Some(v) if v.fract() == 0.0 && v.abs() < 1e15 => format!("{v:.0}"),
        v => v.map_or(String::new(), |v| format!("{v:?}")),
    };
    let mut header: Vec<String> = vec!["index".into(), "time".into(), "converged".into(), "iterations".into()];
    let mut rows: Vec<Vec<String>> = (steps.iter())
        .map(|s| vec![s.index.to_string(), number(Some(s.time)), s.converged.to_string(), s.iterations.to_string()])
        .collect();
    let mut add = |title: String, unit: &str, value: &dyn Fn(&StepReport) -> Option<f64>| {
        header.push(headed(&title, unit));
        rows.iter_mut().zip(steps).for_each(|(row, step)| row.push(number(value(step))));
    };
    add("energy".into(), unit(|u| &u.energy), &|s| s.energy);
    if steps.iter().any(|s| s.plastic_dissipation.is_some()) {
        add("plastic_dissipation".into(), unit(|u| &u.energy), &|s| s.plastic_dissipation);
    }
    if steps.iter().any(|s| s.kinetic_energy.is_some()) {
        add("kinetic_energy".into(), unit(|u| &u.energy), &|s| s.kinetic_energy);
    }
    add("equilibrium_residual".into(), "", &|s| s.equilibrium_residual);
    const AXES: [&str; 3] = ["x", "y", "z"];
    for name in names(steps, |s| &s.contacts) {
        let of = |s: &StepReport| s.contacts.get(name).cloned();
        for (k, axis) in AXES.iter().enumerate() {
            add(format!("{name}:force_{axis}"), unit(|u| &u.force), &|s| Some(of(s)?.force[k]));
        }
        type Reading = fn(&ContactReport) -> Option<f64>;
        let (force, length) = (unit(|u| &u.force), unit(|u| &u.length));
        let carries = steps.iter().find_map(of).map_or(TractionKind::Pressure, |c| c.carries);
        let [area, pressure] = units.map_or([""; 2], |u| carries.units(u));
        let readings: [(&str, &str, Reading); 12] = [
            ("area", area, |c| Some(c.area)),
            ("radius", length, |c| c.radius),
            ("zones", "", |c| Some(c.zones as f64)),
            ("holes", "", |c| c.holes.map(|n| n as f64)),
            ("boundary_length", length, |c| c.boundary_length),
            ("max_penetration", length, |c| Some(c.max_penetration)),
            ("min_gap_outside", length, |c| c.min_gap_outside),
            ("max_pressure", pressure, |c| Some(c.max_pressure)),
            ("min_pressure", pressure, |c| c.min_pressure),
            ("force_error", force, |c| c.error_estimate.map(|e| e.force)),
            ("area_error", area, |c| c.error_estimate.map(|e| e.area)),
            ("max_pressure_error", pressure, |c| c.error_estimate?.max_pressure),
        ];
        for (key, unit, read) in readings {
            add(format!("{name}:{key}"), unit, &|s| read(&of(s)?));
        }
    }
    type Vectors = fn(&StepReport) -> &BTreeMap<String, [f64; 3]>;
    let vectors: [(&str, &str, Vectors); 4] = [
        ("force", unit(|u| &u.force), |s| &s.support_forces),
        ("force", unit(|u| &u.force), |s| &s.load_forces),
        ("moment", unit(|u| &u.moment), |s| &s.support_moments),
        ("moment", unit(|u| &u.moment), |s| &s.load_moments),
    ];
    for (what, unit, of) in vectors {
        for name in names(steps, of) {
            for (k, axis) in AXES.iter().enumerate() {
                add(format!("{name}:{what}_{axis}"), unit, &|s| of(s).get(name).map(|f| f[k]));
            }
        }
    }
    for name in names(steps, |s| &s.contacts) {
        if steps.iter().any(|s| s.contacts.get(name).is_some_and(|c| c.moment.is_some())) {
            for (k, axis) in AXES.iter().enumerate() {
                add(format!("{name}:moment_{axis}"), unit(|u| &u.moment), &|s| Some(s.contacts.get(name)?.moment?[k]));
            }
        }
    }
    for name in names(steps, |s| &s.contacts) {
        let of = |s: &StepReport| s.contacts.get(name).and_then(|c| c.force_bounds);
        // Without a bound the largest is left empty.
        if steps.iter().any(|s| of(s).is_some()) {
            add(format!("{name}:force_bounds_least"), unit(|u| &u.force), &|s| Some(of(s)?.least));
            add(format!("{name}:force_bounds_largest"), unit(|u| &u.force), &|s| of(s)?.largest);
        }
    }
    for name in names(steps, |s| &s.free_bodies) {
        for (k, axis) in AXES.iter().enumerate() {
            add(format!("{name}:displacement_{axis}"), unit(|u| &u.length), &|s| {
                Some(s.free_bodies.get(name)?.displacement[k])
            });
        }
        for (k, axis) in AXES.iter().enumerate() {
            add(format!("{name}:rotation_{axis}"), "rad", &|s| Some(s.free_bodies.get(name)?.rotation[k]));
        }
    }
    for name in names(steps, |s| &s.motion) {
        for (k, axis) in AXES.iter().enumerate() {
            add(format!("{name}:velocity_{axis}"), unit(|u| &u.velocity), &|s| Some(s.motion.get(name)?.velocity[k]));
        }
    }
    for name in names(steps, |s| &s.cells) {
        for (k, axis) in AXES.iter().enumerate() {
            add(format!("{name}:mean_stress_{axis}{axis}"), unit(|u| &u.pressure), &|s| {
                Some(s.cells.get(name)?.mean_stress[k])
            });
        }
        for (k, axis) in AXES.iter().enumerate() {
            add(format!("{name}:mean_strain_{axis}{axis}"), "", &|s| s.cells.get(name)?.mean_strain[k]);
        }
    }
    for name in names(steps, |s| &s.probes) {
        for (k, axis) in AXES.iter().enumerate() {
            add(format!("{name}:displacement_{axis}"), unit(|u| &u.length), &|s| {
                Some(s.probes.get(name)?.as_ref()?.displacement[k])
            });
        }
    }
    let lines = std::iter::once(header).chain(rows).map(|row| row.join(",") + "\n");
    lines.collect()
}
