//! Which pictures there are of systems of bodies: the deformed state, where it touches, what ropes and contacts carry, the
//! history and a film.

use super::camera::Camera;
use super::chart::{label, save, viridis, word};
use super::labels::Labels;
use super::level::region;
use super::page::{Page, SIZE, Scale, Sign, clip_to, sheet, text_width};
use super::panel::{Axis, Panel};
use super::render::{Body, Look};
use super::solid_state::{bounds, insert};
use super::system::{CurveShown, SystemShown};
use super::system_bodies::{bodies, scale_of};
use super::{Folder, OutputError, film, history, system_contacts};
use crate::plan::mechanics::MechanicsPlan;
use crate::problem::Space;
use crate::report::{ContactReport, StepReport};
use plotters::style::RGBColor;
use rayon::prelude::*;
use signorini_geometry::Vector;

const INK: RGBColor = RGBColor(20, 20, 20);
/// The edges of rigid bodies in the plane.
const EDGE: RGBColor = RGBColor(110, 114, 120);
/// Size of the letters of names, and of titles.
const NAME: f64 = 17.0;
const TITLE: f64 = 19.0;
const WIDTH: f64 = 900.0;
/// What touches is shown once more, from near by, where it takes less than this part of the picture.
const SMALL: f64 = 0.4;

/// What a scene shows, and how.
struct View {
    /// What fills the page.
    points: Vec<Vector<3>>,
    /// The box along which the axes stand, and in which rigid bodies are drawn in the plane.
    axes: [Vector<3>; 2],
    room: [Vector<3>; 2],
    /// How axial forces or stresses become colours.
    scale: Scale,
    /// The least width of the page: that of its title.
    width: f64,
    look: Look,
    /// Whether bodies end at the edge of the picture.
    is_part: bool,
    /// From where it is seen, in space.
    from: Vector<3>,
    rigid: Rigid,
}

/// Whether rigid bodies are drawn in space.
#[derive(Clone, Copy, PartialEq)]
enum Rigid {
    Drawn,
    LeftOut,
}

/// From where bodies in space are seen.
fn usual() -> Vector<3> {
    Vector::<3>::new(1.0, -1.6, 0.9)
}

/// From where a face that is touched is seen, if it looks this little towards the usual side, as a cosine.
const AVERTED: f64 = 0.2;

/// From where that which touches rigid bodies is seen, where it looks away: from the side to which it looks on the whole,
/// and half as much from the usual one.
fn facing_contact(shown: &SystemShown) -> Option<Vector<3>> {
    if shown.solids().count() != 1 || shown.rigid.is_empty() {
        return None;
    }
    let force = |c: &super::system::ContactShown| c.closed().into_iter().map(|k| c.force(k)).sum::<Vector<3>>();
    let side = -shown.contacts.iter().map(force).sum::<Vector<3>>().try_normalize(0.0)?;
    let towards = usual().normalize();
    let along = side.dot(&towards);
    (along < AVERTED).then(|| side + (towards - side * along).try_normalize(0.0).unwrap_or_default() * 0.5)
}

/// The view of a whole state.
fn view_of(plan: &MechanicsPlan, shown: &SystemShown, title: &str) -> View {
    let scale = scale_of(shown);
    let drawn = bodies(shown, &scale, plan.space == Space::ThreeD);
    let mut points: Vec<Vector<3>> = drawn.iter().flat_map(Body::seen).copied().collect();
    // The axes stand along the box of the bodies.
    points.extend(corners(shown.bounds()));
    let room = shown.room();
    if plan.space != Space::ThreeD {
        points.extend(room.map(flat));
    }
    let width = text_width(title, TITLE) + 40.0;
    View {
        points,
        axes: shown.bounds(),
        room,
        scale,
        width,
        look: Look::Solid,
        is_part: false,
        from: usual(),
        rigid: Rigid::Drawn,
    }
}

fn flat(x: Vector<3>) -> Vector<3> {
    Vector::<3>::new(x.x, x.y, 0.0)
}

/// The corners of a box.
fn corners([low, high]: [Vector<3>; 2]) -> impl Iterator<Item = Vector<3>> {
    (0..8).map(move |c| Vector::<3>::from_fn(|k, _| [low, high][c >> k & 1][k]))
}

/// The box of the points that touch, with as much again around it; none where nothing touches.
fn around_contact(shown: &SystemShown) -> Option<[Vector<3>; 2]> {
    let closed = |c: &super::system::ContactShown| {
        c.closed().into_iter().map(|k| Vector::<3>::from(c.fields.points[k])).collect::<Vec<_>>()
    };
    let points: Vec<Vector<3>> = shown.contacts.iter().flat_map(closed).collect();
    let [low, high] = bounds(points.iter());
    let thick = shown.curves.iter().map(|c| c.radius).fold(0.0, f64::max);
    let pad = Vector::<3>::repeat((0.5 * (high - low).max()).max(6.0 * thick));
    (!points.is_empty() && pad.x > 0.0).then(|| [low - pad, high + pad])
}

fn scene(
    plan: &MechanicsPlan,
    shown: &SystemShown,
    view: &View,
    title: &str,
    note: &str,
) -> Result<String, OutputError> {
    let labels = Labels(plan.head.unit_names());
    let plane = plan.space != Space::ThreeD;
    let drawn = bodies(shown, &view.scale, !plane && view.rigid == Rigid::Drawn);
    if view.axes[0].x > view.axes[1].x {
        return Ok(Page::new(SIZE, title, note).finish());
    }
    let (towards, above) = if plane { (Vector::<3>::z(), Vector::<3>::y()) } else { (view.from, Vector::<3>::z()) };
    // The page has the shape of what is seen, and room for its title.
    let extent = Camera::new(&towards, &above, view.points.iter(), [0.0, 0.0, 1e3, 1e3]).extent();
    let (width, height) = Page::size_for(extent);
    let mut page = Page::new((width.max(view.width), height), title, note);
    let inner = page.room();
    let area = [inner[0] + 26.0, inner[1], inner[2] - 10.0, inner[3] - 6.0];
    let camera = Camera::new(&towards, &above, view.points.iter(), area);
    insert(&mut page.svg, &drawn, &camera, view.look)?;
    if view.is_part {
        clip_to(&mut page.svg, camera.area);
    }
    if plane {
        // In the plane a rigid body is its edge.
        for body in &shown.rigid {
            for piece in region(body.gap.as_ref(), view.room.map(flat)).1 {
                super::chart::line(&mut page.svg, &piece.map(|x| camera.at(&x)), EDGE);
            }
        }
    }
    system_contacts::draw(&mut page, shown, &camera, (view.axes[1] - view.axes[0]).max(), &labels);
    if view.is_part {
        page.svg += "</g>";
    }
    let axes = super::solid_state::axis_names(plan.space, &labels);
    camera.axes(&mut page.svg, view.axes, axes.each_ref().map(String::as_str));
    names(&mut page, shown, &camera);
    if shown.curves.iter().any(|c| !c.forces.is_empty()) {
        page.bar(&view.scale, &labels.force("axial force"));
    } else if shown.solids().next().is_some() {
        page.bar(&view.scale, &labels.pressure("von Mises stress"));
    }
    Ok(page.finish())
}

/// Writes the names of curves and free bodies, where there are several: at the point of a curve that is farthest from all
/// that is not it.
fn names(page: &mut Page, shown: &SystemShown, camera: &Camera) {
    let free = || shown.rigid.iter().filter(|r| r.is_free);
    if shown.curves.len() + free().count() < 2 {
        return;
    }
    let mut taken: Vec<(f64, f64)> = Vec::new();
    for r in free() {
        let at = camera.at(&r.centre);
        word(&mut page.svg, at, &r.name, INK);
        taken.push(at);
    }
    let [left, top, right, bottom] = camera.area;
    for (number, curve) in shown.curves.iter().enumerate() {
        let others = shown.curves.iter().enumerate().filter(|(k, _)| *k != number).flat_map(|(_, c)| &c.points);
        let others: Vec<(f64, f64)> = others.map(|x| camera.at(x)).chain(taken.iter().copied()).collect();
        let half = 0.5 * text_width(&curve.name, NAME);
        let inside = |&(x, y): &(f64, f64)| x - half > left && x + half < right && y > top && y < bottom;
        let room = |p: &(f64, f64)| {
            others.iter().map(|q| (p.0 - q.0).hypot(p.1 - q.1)).fold(f64::INFINITY, f64::min).min(4.0 * half)
        };
        let places = curve.points.iter().map(|x| camera.at(x)).filter(inside);
        // Of equal ones the first.
        let best = places.fold(None, |best: Option<((f64, f64), f64)>, p| match best {
            Some((_, r)) if r >= room(&p) => best,
            _ => Some((p, room(&p))),
        });
        if let Some((at, _)) = best {
            // Beside the curve.
            word(&mut page.svg, (at.0, at.1 - NAME), &curve.name, INK);
            taken.push(at);
        }
    }
}

/// What a curve carries along its length, by the names of the pictures: axial force, and of what bends the rest.
fn diagrams(curve: &CurveShown, labels: &Labels, time: f64) -> Vec<(String, String)> {
    let mut out = Vec::new();
    if !curve.forces.is_empty() {
        out.push((
            "axial_force",
            along(curve, axial_forces(curve), ("Axial force", labels.force("axial force")), labels, time),
        ));
    }
    for (file, title, values, axis) in [
        ("bending_moment", "Bending moment", &curve.bending_moments, labels.moment("bending moment")),
        ("shear_force", "Shear force", &curve.shear_forces, labels.force("shear force")),
        ("torque", "Torque", &curve.torques, labels.moment("torque")),
    ] {
        let most = values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        if most > 0.0 {
            let points = curve.arc.iter().copied().zip(values.iter().copied()).collect();
            out.push((file, along(curve, points, (title, axis), labels, time)));
        }
    }
    out.into_iter().map(|(file, picture)| (format!("{file}_{}", curve.name), picture)).collect()
}

/// The axial force over the length, constant in each piece.
fn axial_forces(curve: &CurveShown) -> Vec<(f64, f64)> {
    (curve.cells.iter().zip(&curve.forces))
        .flat_map(|([a, b], f)| {
            let (a, b) = (curve.arc[*a as usize], curve.arc[*b as usize]);
            // The last cell of a closed curve ends where the first begins.
            if b > a { vec![(a, *f), (b, *f)] } else { Vec::new() }
        })
        .collect()
}

/// Values of a curve over its length.
fn along(
    curve: &CurveShown,
    runs: Vec<(f64, f64)>,
    (title, axis): (&str, String),
    labels: &Labels,
    time: f64,
) -> String {
    let mut page = Page::new((WIDTH, 460.0), &format!("{title} along `{}`, t = {}", curve.name, label(time)), "");
    let range = |of: fn(&(f64, f64)) -> f64| {
        runs.iter().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
    };
    let length = labels.length("length along it");
    let (x, y) = (Axis::around(&length, range(|p| p.0)), Axis::from_zero(&axis, range(|p| p.1)));
    let mut panel = Panel::new(&mut page.svg, [0.0, 46.0, WIDTH, 456.0], x, y);
    panel.line(&runs, Sign::Line(viridis(0.3)), 2.0);
    page.finish()
}

/// Draws the last state, the history, and a film of the states on the way.
///
/// # Errors
/// Pictures that cannot be drawn or written.
pub fn draw(
    folder: &Folder,
    plan: &MechanicsPlan,
    shown: &SystemShown,
    frames: &[SystemShown],
    steps: &[StepReport],
) -> Result<(), OutputError> {
    let labels = Labels(plan.head.unit_names());
    let title = |time: f64| format!("{}, t = {}", plan.head.problem.name(), label(time));
    let view = view_of(plan, shown, &title(shown.time));
    let mut drawn = vec![("deformed".to_string(), scene(plan, shown, &view, &title(shown.time), "")?)];
    let size = |[low, high]: [Vector<3>; 2]| (high - low).max();
    let averted = (plan.space == Space::ThreeD).then(|| facing_contact(shown)).flatten();
    let frame = around_contact(shown);
    let near = frame.filter(|frame| size(*frame) < SMALL * size(view.axes));
    if near.is_some() || (frame.is_some() && averted.is_some()) {
        let mut touched = View { width: view.width, ..view_of(plan, shown, &title(shown.time)) };
        let mut note = "contact zone";
        if let Some(frame) = near {
            touched = View { points: corners(frame).collect(), axes: frame, room: frame, is_part: true, ..touched };
        }
        if let Some(from) = averted {
            note = "contact zone, without rigid bodies";
            touched = View { from, rigid: Rigid::LeftOut, ..touched };
        }
        drawn.push(("contact".into(), scene(plan, shown, &touched, &title(shown.time), note)?));
    }
    drawn.extend(shown.curves.iter().flat_map(|curve| diagrams(curve, &labels, shown.time)));
    let plane = plan.space != Space::ThreeD;
    for contact in &shown.contacts {
        let chart = system_contacts::chart(contact, plane, shown.time, &labels);
        drawn.extend(chart.map(|picture| (format!("contact_{}", contact.fields.name), picture)));
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
        film::write(folder, film_of(plan, frames, &title)?)?;
    }
    Ok(())
}

/// The frames of a film, all with one scale of colours and one view.
fn film_of(
    plan: &MechanicsPlan,
    frames: &[SystemShown],
    title: &(dyn Fn(f64) -> String + Sync),
) -> Result<Vec<String>, OutputError> {
    let join = |[a, b]: [Vector<3>; 2], [c, d]: [Vector<3>; 2]| [a.inf(&c), b.sup(&d)];
    let views = frames.iter().map(|f| View { look: Look::Film, ..view_of(plan, f, &title(f.time)) });
    let Some(view) = views.reduce(|mut a, b| {
        a.points.extend(b.points);
        let (scale, width) = (a.scale.with(&b.scale), a.width.max(b.width));
        View { axes: join(a.axes, b.axes), room: join(a.room, b.room), scale, width, ..a }
    }) else {
        return Ok(Vec::new());
    };
    frames.par_iter().map(|f| scene(plan, f, &view, &title(f.time), "")).collect()
}

/// The bodies before anything happens.
///
/// # Errors
/// A picture that cannot be drawn.
pub fn preview(plan: &MechanicsPlan) -> Result<String, OutputError> {
    let shown = SystemShown::of_bodies(plan, &plan.system.start().bodies);
    let title = plan.head.problem.name();
    scene(plan, &shown, &view_of(plan, &shown, title), title, "at the start")
}
