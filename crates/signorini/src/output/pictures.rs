//! Which pictures there are of membranes: deflection, gap and pressure, the convergence, the history and a film.

use super::chart::save;
use super::history::{Drive, convergence, history, loop_of_states};
use super::labels::Labels;
use super::membrane_line::{gap_and_pressure, heights, profile};
use super::membrane_map::{Field, gap_scale, map, map_dense, own_scale};
use super::page::{Scale, sheet};
use super::render::MAP;
use super::{Folder, OutputError, film};
use crate::plan::MembranePlan;
use crate::report::{Event, StepReport};
use crate::snapshot::{DisplayMesh, Snapshot};
use rayon::prelude::*;

/// Of states whose contact is at least this part of the largest, the last one tells most.
const TELLING: f64 = 0.8;

/// Pixels of the raster per unit of the page in frames of films: a few more than films have.
const FILM: f64 = 1.0;

type Drawing<'a> = Box<dyn Fn() -> Result<String, OutputError> + Sync + 'a>;

/// Draws all pictures of a run: of its last state, of its history, and those of its most telling state on one sheet.
///
/// # Errors
/// Pictures that cannot be drawn or written.
pub fn draw<const D: usize>(
    folder: &Folder,
    plan: &MembranePlan<D>,
    mesh: &DisplayMesh<D>,
    last: &Snapshot<D>,
    frames: &[Snapshot<D>],
    (steps, events): (&[StepReport], &[Event]),
) -> Result<(), OutputError> {
    if mesh.cells.is_empty() {
        // A domain thinner than the display can show.
        return Ok(());
    }
    let labels = &Labels(plan.head.unit_names());
    let drawn = |drawings: &[(&'static str, Drawing)]| -> Result<Vec<(&'static str, String)>, OutputError> {
        drawings.par_iter().map(|(name, draw)| Ok((*name, draw()?))).collect()
    };
    let of_last = drawn(&of_state(plan, mesh, last, labels))?;
    let of_run = drawn(&of_history(plan, steps, events, labels))?;
    of_last.par_iter().chain(&of_run).try_for_each(|(name, text)| save(folder, name, text))?;
    let telling = telling(last, frames);
    let shown = if telling.time == last.time { of_last } else { drawn(&of_state(plan, mesh, telling, labels))? };
    let all: Vec<String> = shown.into_iter().chain(of_run).map(|d| d.1).collect();
    save(folder, "overview", &sheet(&all))?;
    film::write(folder, film_of(plan, mesh, frames, labels)?)
}

/// The state that an overview shows: the last with nearly the largest contact.
fn telling<'a, const D: usize>(last: &'a Snapshot<D>, frames: &'a [Snapshot<D>]) -> &'a Snapshot<D> {
    let size = |s: &Snapshot<D>| s.in_contact.iter().filter(|c| **c).count() as f64;
    let largest = frames.iter().chain([last]).map(size).fold(0.0, f64::max);
    frames.iter().chain([last]).rev().find(|s| size(s) >= TELLING * largest).unwrap_or(last)
}

/// The pictures of a state.
fn of_state<'a, const D: usize>(
    plan: &'a MembranePlan<D>,
    mesh: &'a DisplayMesh<D>,
    s: &'a Snapshot<D>,
    labels: &'a Labels,
) -> Vec<(&'static str, Drawing<'a>)> {
    let mut drawings: Vec<(&str, Drawing)> = Vec::new();
    if D == 1 {
        drawings.push(("deflection", Box::new(move || Ok(profile(plan, mesh, s, true, labels, heights(s))))));
        if s.has_obstacles() {
            drawings.push(("gap_and_pressure", Box::new(move || Ok(gap_and_pressure(plan, mesh, s, labels)))));
        }
        return drawings;
    }
    drawings.push(("deflection", Box::new(move || map(plan, mesh, s, &deflection(s, None, labels), true, labels))));
    if s.has_obstacles() {
        drawings.push(("gap", Box::new(move || map(plan, mesh, s, &gap(s, None, labels), false, labels))));
        let most = s.pressure.iter().fold(0.0f64, |m, p| m.max(*p));
        let least = s.pressure.iter().fold(0.0f64, |m, p| m.min(*p));
        let pressure = move || Field {
            values: &s.pressure,
            title: "Contact pressure",
            name: labels.pressure("p"),
            scale: Scale::between(least, most, most),
            of_contact: true,
        };
        drawings.push(("pressure", Box::new(move || map(plan, mesh, s, &pressure(), false, labels))));
    }
    drawings
}

fn deflection<'a, const D: usize>(s: &'a Snapshot<D>, scale: Option<Scale>, labels: &Labels) -> Field<'a> {
    Field {
        values: &s.displacement,
        title: "Deflection",
        name: labels.length("u"),
        scale: scale.unwrap_or_else(|| own_scale(&s.displacement)),
        of_contact: false,
    }
}

fn gap<'a, const D: usize>(s: &'a Snapshot<D>, scale: Option<Scale>, labels: &Labels) -> Field<'a> {
    let scale = scale.unwrap_or_else(|| gap_scale(s));
    Field { values: &s.gap, title: "Gap", name: labels.length("gap"), scale, of_contact: false }
}

/// The pictures of a history.
fn of_history<'a, const D: usize>(
    plan: &'a MembranePlan<D>,
    steps: &'a [StepReport],
    events: &'a [Event],
    labels: &'a Labels,
) -> Vec<(&'static str, Drawing<'a>)> {
    let mut drawings: Vec<(&str, Drawing)> = vec![("convergence", Box::new(|| Ok(convergence(steps))))];
    if steps.len() < 2 || plan.contacts.is_empty() {
        return drawings;
    }
    let names: Vec<&str> = plan.contacts.iter().map(|c| c.name.as_str()).collect();
    drawings
        .push(("history", Box::new(move || Ok(history(steps, events, &names, plan.space, &|c| c.force[2], labels)))));
    if let Some(contact) = plan.contacts.iter().find(|c| c.adhesion.is_some()).or(plan.contacts.first())
        && let Some(drive) = Drive::of(plan, steps, labels)
    {
        let title = if contact.adhesion.is_some() { "loop" } else { "load_curves" };
        let name = contact.name.as_str();
        drawings.push((title, Box::new(move || Ok(loop_of_states(&drive, steps, events, name, plan.space, labels)))));
    }
    drawings
}

/// The frames of a film: the deflection on a line, the gap in the plane, all over one range.
fn film_of<const D: usize>(
    plan: &MembranePlan<D>,
    mesh: &DisplayMesh<D>,
    frames: &[Snapshot<D>],
    labels: &Labels,
) -> Result<Vec<String>, OutputError> {
    let range =
        frames.iter().map(heights).fold((f64::INFINITY, f64::NEG_INFINITY), |a, b| (a.0.min(b.0), a.1.max(b.1)));
    let scale = frames.iter().map(frame_scale).reduce(|a, b| a.with(&b));
    frames.par_iter().map(|s| frame(plan, mesh, s, range, scale, labels, FILM)).collect()
}

fn frame_scale<const D: usize>(s: &Snapshot<D>) -> Scale {
    if s.has_obstacles() { gap_scale(s) } else { own_scale(&s.displacement) }
}

fn frame<const D: usize>(
    plan: &MembranePlan<D>,
    mesh: &DisplayMesh<D>,
    s: &Snapshot<D>,
    range: (f64, f64),
    scale: Option<Scale>,
    labels: &Labels,
    density: f64,
) -> Result<String, OutputError> {
    if D == 1 {
        return Ok(profile(plan, mesh, s, false, labels, range));
    }
    let field = if s.has_obstacles() { gap(s, scale, labels) } else { deflection(s, scale, labels) };
    map_dense(plan, mesh, s, &field, (false, density), labels)
}

/// A membrane before it touches: on a line its profile over what lies below, in the plane the gap.
///
/// # Errors
/// A picture that cannot be drawn.
pub fn preview<const D: usize>(
    plan: &MembranePlan<D>,
    mesh: &DisplayMesh<D>,
    s: &Snapshot<D>,
) -> Result<String, OutputError> {
    frame(plan, mesh, s, heights(s), None, &Labels(plan.head.unit_names()), MAP)
}
