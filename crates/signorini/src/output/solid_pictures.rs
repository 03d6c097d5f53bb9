//! Which pictures there are of solids: the deformed state, the contact, the history and a film.

use super::chart::save;
use super::labels::Labels;
use super::page::{Scale, sheet};
use super::solid_fields::{ContactDisplay, SolidDisplay, SolidFields};
use super::solid_state::{SolidFrame, State, bounds, spatial};
use super::{Folder, OutputError, film, history, solid_plane, solid_space};
use crate::plan::solid::SolidPlan;
use crate::report::{ContactReport, StepReport};
use rayon::prelude::*;
use signorini_geometry::Vector;

/// Draws all pictures of a run: of its last state, and of its history.
///
/// # Errors
/// Pictures that cannot be drawn or written.
pub fn draw<const D: usize>(
    folder: &Folder,
    plan: &SolidPlan<D>,
    display: &SolidDisplay<D>,
    (last, contacts): (&SolidFrame<D>, &[ContactDisplay<D>]),
    frames: &[SolidFrame<D>],
    steps: &[StepReport],
) -> Result<(), OutputError> {
    let labels = &Labels(plan.head.unit_names());
    let state = State::new(plan, display, last, None, labels);
    let mut drawn: Vec<(String, String)> = Vec::new();
    if D == 3 {
        drawn.push(("deformed".into(), solid_space::whole(&state, solid_space::look_down(contacts), None)?));
        drawn.extend(solid_space::cut(&state, contacts)?.map(|picture| ("cut".into(), picture)));
    } else {
        drawn.push(("deformed".into(), solid_plane::deformed(&state, solid_plane::view(plan.space, &state.moved))?));
        if let Some(window) = solid_plane::window(&state) {
            drawn.push(("contact_zone".into(), solid_plane::deformed(&state, window)?));
        }
    }
    for (contact, shown) in plan.contacts.iter().zip(contacts) {
        let name = if plan.contacts.len() == 1 { "pressure".into() } else { format!("pressure_{}", contact.name) };
        let picture = match D {
            3 => solid_space::pressure(&contact.name, last.time, shown, labels)?,
            _ => solid_plane::profile(&contact.name, last.time, shown, plan.space, labels),
        };
        drawn.push((name, picture));
    }
    if steps.len() > 1 && !plan.contacts.is_empty() {
        let names: Vec<&str> = plan.contacts.iter().map(|c| c.name.as_str()).collect();
        let force = |c: &ContactReport| c.force.iter().map(|v| v * v).sum::<f64>().sqrt();
        drawn.push(("history".into(), history::history(steps, &[], &names, plan.space, &force, labels)));
    }
    drawn.par_iter().try_for_each(|(name, picture)| save(folder, name, picture))?;
    if drawn.len() > 1 {
        save(folder, "overview", &sheet(&drawn.into_iter().map(|d| d.1).collect::<Vec<_>>()))?;
    }
    film::write(folder, film_of(plan, display, contacts, frames, labels)?)
}

/// The frames of a film, all with one scale of colours and one view.
fn film_of<const D: usize>(
    plan: &SolidPlan<D>,
    display: &SolidDisplay<D>,
    contacts: &[ContactDisplay<D>],
    frames: &[SolidFrame<D>],
    labels: &Labels,
) -> Result<Vec<String>, OutputError> {
    let Some(scale) = frames.iter().map(SolidFrame::scale).reduce(|a: Scale, b| a.with(&b)) else {
        return Ok(Vec::new());
    };
    let seen = (frames.iter())
        .map(|frame| {
            let moved: Vec<Vector<3>> =
                display.points.iter().zip(&frame.displacement).map(|(x, u)| spatial(&(x + u))).collect();
            if D == 3 { bounds(moved.iter()) } else { solid_plane::view(plan.space, &moved) }
        })
        .reduce(|[a, b], [c, d]| [a.inf(&c), b.sup(&d)])
        .unwrap_or_default();
    let from_below = solid_space::look_down(contacts);
    (frames.par_iter())
        .map(|frame| {
            let state = State::new(plan, display, frame, Some(scale), labels);
            if D == 3 {
                solid_space::whole(&state, from_below, Some(seen))
            } else {
                solid_plane::deformed(&state, seen)
            }
        })
        .collect()
}

/// The bodies before they deform.
///
/// # Errors
/// A picture that cannot be drawn.
pub fn preview<const D: usize>(
    plan: &SolidPlan<D>,
    display: &SolidDisplay<D>,
    fields: &SolidFields<D>,
) -> Result<String, OutputError> {
    let labels = &Labels(plan.head.unit_names());
    let state = State::new(plan, display, &SolidFrame::new(0.0, fields, &[]), None, labels);
    match D {
        3 => solid_space::whole(&state, false, None),
        _ => solid_plane::deformed(&state, solid_plane::view(plan.space, &state.moved)),
    }
}
