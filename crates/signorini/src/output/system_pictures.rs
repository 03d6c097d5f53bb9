//! Which pictures there are of systems of bodies: the deformed state, where it touches, what ropes and contacts carry, the
//! history and a film.

use super::camera::corners;
use super::chart::save;
use super::labels::Labels;
use super::page::{Scale, sheet};
use super::section_forces::diagrams;
use super::system::{ContactShown, SystemShown};
use super::system_marks::marks;
use super::system_scene::{
    Forces, Rigid, View, around_contact, around_largest, around_loops, facing_contact, marked_scene, scene, titled,
};
use super::{
    Folder, OutputError, film, history, pressure_map, pressure_profile, system_contacts, system_cut, system_plane,
};
use crate::plan::mechanics::MechanicsPlan;
use crate::problem::Space;
use crate::report::{ContactReport, StepReport};
use rayon::prelude::*;
use signorini_geometry::Vector;

/// What touches is shown once more, from near by, where it takes less than this part of the picture.
const SMALL: f64 = 0.4;
/// The largest displacement of solids that nothing touches, as a part of their size.
const VISIBLE: f64 = 0.05;

/// A name and a picture.
type NamedPicture = (String, String);

/// Draws the last state, the history, and a film of the states on the way.
///
/// # Errors
/// Pictures that cannot be drawn or written.
pub fn draw(
    folder: &Folder,
    plan: &MechanicsPlan,
    shown: &SystemShown,
    mut frames: Vec<SystemShown>,
    steps: &[StepReport],
) -> Result<(), OutputError> {
    let labels = Labels(plan.head.unit_names());
    let factor = magnification(plan, shown, &frames);
    let mut shown = shown.clone();
    shown.magnify(factor);
    frames.iter_mut().for_each(|frame| frame.magnify(factor));
    let mut view = View { note: note(&shown, factor), ..View::of(plan, &shown) };
    if plan.space == Space::ThreeD && facing_contact(&shown).is_some() {
        // They are drawn in a picture from the side from which they are seen.
        view.forces = Forces::LeftOut;
    }
    let view = view;
    let mut drawn = vec![("deformed".to_string(), scene(plan, &shown, &view, &titled(&view.what, shown.time))?)];
    drawn.extend(temperature(plan, &shown, &view)?);
    drawn.extend(contact_zone(plan, &shown, &view)?);
    drawn.extend(system_cut::cut(plan, &shown, &view)?.map(|picture| ("cut".into(), picture)));
    drawn.extend(shown.curves.iter().flat_map(|curve| diagrams(curve, &labels, shown.time)));
    for contact in &shown.contacts {
        drawn.extend(of_contact(plan, contact, shown.time, &labels)?);
    }
    if steps.len() > 1 && !plan.system.contacts.is_empty() {
        let names: Vec<&str> = plan.system.contacts.iter().map(|c| c.name()).collect();
        // Contacts of curves have a length.
        let measured = if shown.curves.is_empty() { plan.space } else { Space::PlaneStrain };
        let force = |c: &ContactReport| c.force.iter().map(|v| v * v).sum::<f64>().sqrt();
        drawn.push(("history".into(), history::history(steps, &[], &names, measured, &force, &labels)));
    }
    drawn.par_iter().try_for_each(|(name, picture)| save(folder, name, picture))?;
    if drawn.len() > 1 {
        save(folder, "overview", &sheet(&drawn.into_iter().map(|d| d.1).collect::<Vec<_>>()))?;
    }
    if frames.len() > 1 {
        film::write(folder, film_of(plan, &frames, &view)?)?;
    }
    Ok(())
}

/// The temperature of solids that have one.
fn temperature(plan: &MechanicsPlan, shown: &SystemShown, view: &View) -> Result<Option<NamedPicture>, OutputError> {
    if !shown.curves.is_empty() || shown.solids().all(|body| body.array("temperature").is_none()) {
        return Ok(None);
    }
    let heated = SystemShown { painted: "temperature", ..shown.clone() };
    let own = View { note: view.note.clone(), forces: Forces::LeftOut, ..View::of(plan, &heated) };
    Ok(Some(("temperature".into(), scene(plan, &heated, &own, &titled(&own.what, heated.time))?)))
}

/// What touches from near by, or from the side to which it looks.
fn contact_zone(plan: &MechanicsPlan, shown: &SystemShown, view: &View) -> Result<Vec<NamedPicture>, OutputError> {
    let size = |[low, high]: [Vector<3>; 2]| (high - low).max();
    let in_space = plan.space == Space::ThreeD;
    let title = titled(&view.what, shown.time);
    let near = |frame: [Vector<3>; 2], view: View| View {
        points: corners(frame).collect(),
        axes: frame,
        room: frame,
        is_part: true,
        ..view
    };
    let mut out = Vec::new();
    if let Some(frame) = system_plane::window(shown).filter(|_| !in_space) {
        let zone = View { note: view.note.clone(), ..near(frame, View::of(plan, shown)) };
        out.push(("contact_zone".into(), scene(plan, shown, &zone, &title)?));
    }
    let averted = if in_space { facing_contact(shown) } else { None };
    let mut around = around_contact(shown);
    if let Some(frame) = around.as_mut().filter(|_| !in_space) {
        // Not beyond what the whole picture shows.
        *frame = [frame[0].sup(&view.room[0]), frame[1].inf(&view.room[1])];
    }
    let is_small = |frame: &[Vector<3>; 2]| size(*frame) < SMALL * size(shown.bounds());
    // Of curves with the loops between what touches, or else a part of a zone that is long.
    let close = around_loops(shown).filter(is_small).or(around.filter(is_small));
    let small = close.or_else(|| around_largest(shown).filter(|_| in_space).filter(is_small));
    if small.is_some() || (around.is_some() && averted.is_some()) {
        let mut zone = View { note: "contact zone".into(), ..View::of(plan, shown) };
        if let Some(frame) = small {
            zone = near(frame, zone);
        }
        if let Some(from) = averted {
            let below = if from.z < 0.0 { " from below" } else { "" };
            let note = format!("contact zone{below}, without rigid bodies");
            zone = View { from, rigid: Rigid::LeftOut, note, ..zone };
        }
        out.push(("contact".into(), scene(plan, shown, &zone, &title)?));
    }
    Ok(out)
}

/// What a contact carries: on a surface the pressure, elsewhere along its tested points.
fn of_contact(
    plan: &MechanicsPlan,
    contact: &ContactShown,
    time: f64,
    labels: &Labels,
) -> Result<Option<NamedPicture>, OutputError> {
    let in_space = plan.space == Space::ThreeD;
    let name = &contact.fields.name;
    let pressure = || match plan.system.contacts.len() {
        1 => "pressure".to_string(),
        _ => format!("pressure_{name}"),
    };
    Ok(match &contact.surface {
        Some(surface) if in_space => Some((pressure(), pressure_map::draw(contact, surface, time, labels)?)),
        Some(surface) => Some((pressure(), pressure_profile::draw(contact, surface, time, plan.space, labels))),
        None => {
            let chart = system_contacts::chart(contact, (!in_space).then_some(plan.space), time, labels);
            chart.map(|picture| (format!("contact_{name}"), picture))
        }
    })
}

/// The frames of a film, all with one scale of colours and one view.
fn film_of(plan: &MechanicsPlan, frames: &[SystemShown], last: &View) -> Result<Vec<String>, OutputError> {
    let Some(view) = frames.iter().map(|frame| View::of(plan, frame)).reduce(View::joined) else {
        return Ok(Vec::new());
    };
    let look = view.look.of_film();
    let view = View { look, from: last.from, what: last.what.clone(), note: last.note.clone(), ..view };
    frames.par_iter().map(|f| scene(plan, f, &view, &titled(&view.what, f.time))).collect()
}

/// A round factor that makes displacements of solids visible where nothing could touch, or one.
fn magnification(plan: &MechanicsPlan, shown: &SystemShown, frames: &[SystemShown]) -> f64 {
    if !plan.system.contacts.is_empty() || !shown.is_of_solids() || !shown.rigid.is_empty() {
        // Magnified displacements would push bodies through each other.
        return 1.0;
    }
    let [low, high] = shown.bounds_at_rest();
    let largest = frames.iter().chain([shown]).map(SystemShown::largest_displacement).fold(0.0, f64::max);
    let wanted = VISIBLE * (high - low).norm() / largest.max(f64::MIN_POSITIVE);
    if wanted < 2.0 || !wanted.is_finite() {
        return 1.0;
    }
    let power = 10f64.powf(wanted.log10().floor());
    [5.0, 2.0, 1.0].into_iter().map(|d| d * power).find(|m| *m <= wanted).unwrap_or(1.0)
}

/// How the displacements of solids are drawn.
fn note(shown: &SystemShown, factor: f64) -> String {
    match (shown.is_of_solids() && shown.largest_displacement() > 0.0, factor) {
        (false, _) => String::new(),
        (true, 1.0) => "displacements to scale".into(),
        (true, _) => format!("displacements × {factor}"),
    }
}

/// The bodies before anything happens.
///
/// # Errors
/// A picture that cannot be drawn.
pub fn preview(plan: &MechanicsPlan) -> Result<String, OutputError> {
    let shown = SystemShown::of_bodies(plan, &plan.system.start().bodies);
    let view = View { note: "at the start; loads as they are at the end".into(), ..View::of(plan, &shown) };
    // Marks are seen best on bodies without colours.
    let view = View { scale: Scale::chosen([0.0; 2], [0.0; 2]), ..view };
    marked_scene(plan, &shown, &view, plan.head.problem.name(), &marks(plan))
}
