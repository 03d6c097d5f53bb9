//! Tables of what was found, with units.

use crate::folder::{Results, Told};
use crate::html::{section, table};
use signorini::output::figure::{figure, figures, told, told_vector};
use signorini::report::{ContactEvent, Event, StepReport, Summary, UnitNames, columns, headed, resultants_of};

/// More rows than this are not read; the table of the folder has all.
const ROWS: usize = 60;

/// The increments, the resultants of the last, and what else there is.
pub fn results(results: &Results) -> String {
    let body = match &results.told {
        Told::Run(summary) => of_summary(summary),
        Told::Unfinished(found) => {
            of_steps(&found.steps, None)
                + &events(&found.events, None)
                + &contact_events(&found.contact_events)
                + &increments_without_units(&found.steps)
        }
        Told::Answers(list) => return super::answers::answers(list),
        Told::Other(_) => return String::new(),
    };
    section("results", "Results", &body)
}

fn of_summary(summary: &Summary) -> String {
    let has_contacts = summary.steps.iter().any(|s| !s.contacts.is_empty() || s.equilibrium_residual.is_some());
    let increments = if has_contacts { increments(summary) } else { String::new() };
    increments
        + &events(&summary.events, summary.units.as_ref())
        + &contact_events(&summary.contact_events)
        + &of_steps(&summary.steps, summary.units.as_ref())
}

/// The table of the terminal.
fn increments(summary: &Summary) -> String {
    let columns = columns(summary);
    let head: Vec<String> = columns.iter().map(|c| c.heading.clone()).collect();
    let count = columns.first().map_or(0, |c| c.cells.len());
    let rows: Vec<Vec<String>> =
        (0..count).map(|k| columns.iter().map(|c| c.cells.get(k).cloned().unwrap_or_default()).collect()).collect();
    shortened("Contacts at the end of each increment", &head, rows)
}

/// A table of the first and the last rows where there are too many.
fn shortened(caption: &str, head: &[String], mut rows: Vec<Vec<String>>) -> String {
    let count = rows.len();
    if count <= ROWS {
        return table(caption, head, &rows);
    }
    let last = rows.split_off(count - ROWS / 2);
    rows.truncate(ROWS / 2);
    let mut gap = vec![String::new(); head.len()];
    if let Some(first) = gap.first_mut() {
        *first = "…".into();
    }
    rows.push(gap);
    rows.extend(last);
    let note = format!("<p class=\"note\">{} of {count} rows; history.csv has all.</p>", ROWS);
    table(caption, head, &rows) + &note
}

fn increments_without_units(steps: &[StepReport]) -> String {
    let head: Vec<String> = ["t", "contact", "area", "force", "max pressure", "zones"].map(String::from).to_vec();
    let rows = steps.iter().flat_map(|s| {
        s.contacts.iter().map(move |(name, c)| {
            let told =
                [figure(c.area, None), figures(&c.force, None), figure(c.max_pressure, None), c.zones.to_string()];
            [figure(s.time, Some(1e-6)), format!("`{name}`")].into_iter().chain(told).collect::<Vec<String>>()
        })
    });
    shortened("Contacts at the end of each increment", &head, rows.collect())
}

/// Forces, moments, free bodies, probes, ropes and bodies of cells at the end.
fn of_steps(steps: &[StepReport], units: Option<&UnitNames>) -> String {
    let Some(step) = steps.iter().rev().find(|s| s.converged).or(steps.last()) else { return String::new() };
    let unit = |of: fn(&UnitNames) -> &String| units.map_or("", |u| of(u));
    let (force, length) = (unit(|u| &u.force), unit(|u| &u.length));
    let vector = |v: &[f64; 3]| told_vector(v, None, "");
    let heads = |titles: &[String]| titles.to_vec();
    let mut out = String::new();
    if step.moments_about.is_none() {
        let supports = step.support_forces.iter().map(|(n, f)| vec![format!("support `{n}`"), vector(f)]);
        let loads = step.load_forces.iter().map(|(n, f)| vec![format!("load `{n}`"), vector(f)]);
        let rows: Vec<Vec<String>> = supports.chain(loads).collect();
        out += &table("Forces at the end", &heads(&["".into(), headed("force on the body", force)]), &rows);
    }
    for mut rows in resultants_of(step, units) {
        let head = rows.remove(0).to_vec();
        let rows: Vec<Vec<String>> = rows.into_iter().map(|r| r.to_vec()).collect();
        out += &table("Resultants at the end", &head, &rows);
    }
    let probes = step.probes.iter().filter_map(|(name, p)| {
        let p = p.as_ref()?;
        let von_mises = p.von_mises.or(p.pressure).map_or(String::new(), |v| told(v, None, unit(|u| &u.pressure)));
        Some(vec![format!("`{name}`"), vector(&p.at), vector(&p.displacement), von_mises])
    });
    let head = ["probe".into(), headed("at", length), headed("displacement", length), "stress or pressure".into()];
    out += &table("Probes at the end", &heads(&head), &probes.collect::<Vec<_>>());
    let curves = step.curves.iter().map(|(name, c)| {
        let list = [c.start_tension, c.end_tension, c.min_tension, c.max_tension].map(|v| figure(v, None));
        std::iter::once(format!("`{name}`")).chain(list).collect::<Vec<String>>()
    });
    let titles = ["at the start", "at the end", "smallest", "largest"].map(|t| headed(t, force));
    let head: Vec<String> = std::iter::once("axial force".to_string()).chain(titles).collect();
    out += &table("Ropes and beams at the end", &head, &curves.collect::<Vec<_>>());
    let cells = step.cells.iter().map(|(name, c)| {
        let strain = c.mean_strain.map(|v| v.map_or("–".into(), |v| figure(v, None))).join(", ");
        vec![format!("`{name}`"), vector(&c.mean_stress), format!("({strain})")]
    });
    let head = ["body".into(), headed("mean stress", unit(|u| &u.pressure)), "mean strain".into()];
    out + &table("Bodies of cells at the end", &heads(&head), &cells.collect::<Vec<_>>())
}

fn events(events: &[Event], units: Option<&UnitNames>) -> String {
    let unit = |of: fn(&UnitNames) -> &String| units.map_or("", |u| of(u));
    let rows = events.iter().map(|e| {
        let zones = format!("{} → {}", e.zones_before, e.zones_after);
        let at = told_vector(&e.at, None, "");
        vec![
            figure(e.time, Some(e.within)),
            format!("`{}`", e.contact),
            e.kind.words().into(),
            at,
            figure(e.load_force, None),
            zones,
        ]
    });
    let head = [
        "t".into(),
        "contact".into(),
        "what".into(),
        headed("at", unit(|u| &u.length)),
        headed("load", unit(|u| &u.force)),
        "zones".into(),
    ];
    shortened("Changes of the contact zones", &head, rows.collect())
}

fn contact_events(events: &[ContactEvent]) -> String {
    let row =
        |e: &ContactEvent| vec![figure(e.time, Some(e.within)), format!("`{}`", e.contact), e.kind.words().into()];
    let head = ["t", "contact", "from then on it"].map(String::from);
    shortened("Events of the contacts", &head, events.iter().map(row).collect())
}
