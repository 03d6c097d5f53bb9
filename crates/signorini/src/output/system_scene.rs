//! A state of a system of bodies as a picture: the bodies, where they touch and what they carry there.

use super::camera::{Camera, bounds, corners};
use super::chart::label;
use super::colours::{FRONT, RIGID};
use super::labels::Labels;
use super::page::{Page, SIZE, Scale, Sign, clip_to, text_width};
use super::render::{Body, Look, insert};
use super::system::SystemShown;
use super::system_bodies::{deformable, rigid, scale_of};
use super::system_marks::{self, Mark};
use super::{OutputError, system_contacts, system_names, system_plane};
use crate::plan::mechanics::MechanicsPlan;
use crate::problem::Space;
use signorini_geometry::Vector;

/// What is so many times higher than wide is laid down.
const UPRIGHT: f64 = 3.0;
/// Size of the letters of titles.
const TITLE: f64 = 19.0;

/// What a scene shows, and how.
pub struct View {
    /// What is shown, in words, and how much its displacements are magnified.
    pub what: String,
    pub note: String,
    /// What fills the page.
    pub points: Vec<Vector<3>>,
    /// The box along which the axes stand, and in which rigid bodies are drawn.
    pub axes: [Vector<3>; 2],
    pub room: [Vector<3>; 2],
    /// How axial forces or stresses become colours.
    pub scale: Scale,
    /// The least width of the page: that of its title.
    pub width: f64,
    pub look: Look,
    /// Whether bodies end at the edge of the picture.
    pub is_part: bool,
    /// From where it is seen, in space.
    pub from: Vector<3>,
    pub rigid: Rigid,
    pub forces: Forces,
}

/// Whether forces at tested points are drawn: not where a body hides the points.
#[derive(Clone, Copy, PartialEq)]
pub enum Forces {
    Drawn,
    LeftOut,
}

/// Whether rigid bodies are drawn in space.
#[derive(Clone, Copy, PartialEq)]
pub enum Rigid {
    Drawn,
    LeftOut,
}

/// From where bodies in space are seen.
pub fn usual() -> Vector<3> {
    Vector::<3>::new(1.0, -1.6, 0.9)
}

impl View {
    /// The view of a whole state.
    pub fn of(plan: &MechanicsPlan, shown: &SystemShown) -> Self {
        let scale = scale_of(shown);
        let what = match (shown.is_of_solids(), scale.is_empty()) {
            (false, _) => plan.head.problem.name().to_string(),
            (true, true) => "Bodies at rest".into(),
            (true, false) if shown.painted == "temperature" => "Temperature".into(),
            (true, false) => "Equivalent stress (von Mises)".into(),
        };
        let mut view = View {
            width: width_for(&titled(&what, shown.time)),
            what,
            note: String::new(),
            points: Vec::new(),
            axes: shown.bounds(),
            room: shown.room(),
            scale,
            look: Look::Solid,
            is_part: false,
            from: usual(),
            rigid: Rigid::Drawn,
            forces: Forces::Drawn,
        };
        if plan.space == Space::ThreeD {
            if shown.is_of_solids() && looks_down(shown) {
                view.from.z = -view.from.z;
            }
            let drawn = deformable(shown, &scale).into_iter().chain(rigid(shown, view.room));
            view.points = drawn.collect::<Vec<Body>>().iter().flat_map(Body::seen).copied().collect();
            // The axes stand along the box of the bodies.
            view.points.extend(corners(shown.bounds()));
        } else {
            system_plane::frame(&mut view, plan.space, shown);
        }
        view
    }

    /// With the same scale of colours and the same part of space as another one.
    pub fn joined(mut self, other: Self) -> Self {
        let join = |[a, b]: [Vector<3>; 2], [c, d]: [Vector<3>; 2]| [a.inf(&c), b.sup(&d)];
        self.points.extend(other.points);
        let (scale, width) = (self.scale.with(&other.scale), self.width.max(other.width));
        View { axes: join(self.axes, other.axes), room: join(self.room, other.room), scale, width, ..self }
    }
}

/// The width of a page with a title.
pub fn width_for(title: &str) -> f64 {
    text_width(title, TITLE) + 40.0
}

/// What is shown, and at which time.
pub fn titled(what: &str, time: f64) -> String {
    format!("{what}, t = {}", label(time))
}

/// Whether surfaces that are tested look down, so that they are seen from below.
fn looks_down(shown: &SystemShown) -> bool {
    let surfaces = shown.contacts.iter().filter(|c| c.surface.is_some());
    surfaces.map(|c| c.outward().z).sum::<f64>() < 0.0
}

/// A page with the shape of what is seen and room for its title, and the view of it.
pub fn page_for<'a>(
    [towards, above]: [&Vector<3>; 2],
    points: impl Iterator<Item = &'a Vector<3>> + Clone,
    [title, note]: [&str; 2],
    least: f64,
) -> (Page, Camera) {
    let extent_for = |above: &Vector<3>| Camera::new(towards, above, points.clone(), [0.0, 0.0, 1e3, 1e3]).extent();
    let mut extent = extent_for(above);
    let is_aslant = towards.x != 0.0 || towards.y != 0.0;
    // What is long and upright lies on the page: there is more room across it.
    let lying = towards.cross(above);
    let mut above = above;
    if is_aslant && extent[1] > UPRIGHT * extent[0] {
        above = &lying;
        extent = extent_for(above);
    }
    let (width, height) = Page::size_for(extent);
    let page = Page::new((width.max(least), height), title, note);
    let inner = page.room();
    // In space the axes stand aside, with their names.
    let area = if !is_aslant { inner } else { [inner[0] + 26.0, inner[1], inner[2] - 40.0, inner[3] - 6.0] };
    let camera = Camera::new(towards, above, points, area);
    (page, camera)
}

/// Draws a state.
///
/// # Errors
/// A raster without area.
pub fn scene(plan: &MechanicsPlan, shown: &SystemShown, view: &View, title: &str) -> Result<String, OutputError> {
    marked_scene(plan, shown, view, title, &[])
}

/// Draws a state with marks of what the case asks.
///
/// # Errors
/// A raster without area.
pub fn marked_scene(
    plan: &MechanicsPlan,
    shown: &SystemShown,
    view: &View,
    title: &str,
    marks: &[Mark],
) -> Result<String, OutputError> {
    let labels = Labels(plan.head.unit_names());
    if view.axes[0].x > view.axes[1].x {
        return Ok(Page::new(SIZE, title, &view.note).finish());
    }
    let in_space = plan.space == Space::ThreeD;
    let [towards, above] = if in_space { [view.from, Vector::<3>::z()] } else { [Vector::<3>::z(), Vector::<3>::y()] };
    let (mut page, camera) = page_for([&towards, &above], view.points.iter(), [title, &view.note], view.width);
    if in_space {
        let mut bodies = deformable(shown, &view.scale);
        if view.rigid == Rigid::Drawn {
            bodies.extend(rigid(shown, view.room));
        }
        insert(&mut page.svg, &bodies, &camera, view.look)?;
    }
    if view.is_part {
        clip_to(&mut page.svg, camera.area);
    }
    if !in_space {
        system_plane::draw(&mut page.svg, shown, view, &camera)?;
    }
    let mut key = rigid_key(shown);
    if !shown.zones.is_empty() {
        key.push((Sign::Line(FRONT), "contact".into()));
    }
    if view.forces == Forces::Drawn {
        key.extend(system_contacts::draw(&mut page, shown, &camera, (view.axes[1] - view.axes[0]).max(), &labels));
    }
    if view.is_part {
        page.svg += "</g>";
    }
    if plan.space == Space::Axisymmetric {
        system_plane::axis_of_rotation(&mut page.svg, view.room, &camera);
    }
    camera.axes(&mut page.svg, view.axes, labels.axes(plan.space).each_ref().map(String::as_str));
    key.extend(system_marks::draw(&mut page, marks, &camera));
    page.key(&key);
    system_names::write(&mut page, shown, &camera);
    bar(&mut page, shown, &view.scale, &labels);
    Ok(page.finish())
}

/// What rigid bodies beside solids are called.
pub fn rigid_key(shown: &SystemShown) -> Vec<(Sign, String)> {
    let fixed = shown.rigid.iter().filter(|r| !r.is_free && shown.is_of_solids());
    fixed.map(|r| (Sign::Area(RIGID), format!("{} (rigid)", r.name))).collect()
}

/// What the colours mean.
pub fn bar(page: &mut Page, shown: &SystemShown, scale: &Scale, labels: &Labels) {
    if shown.curves.iter().any(|c| !c.forces.is_empty()) {
        page.bar(scale, &labels.force("axial force"));
    } else if shown.is_of_solids() {
        page.bar(scale, &if shown.painted == "temperature" { labels.temperature() } else { labels.pressure("σ") });
    }
}

/// The box of what touches, with as much again around it; none where nothing touches. Surfaces are shown otherwise.
pub fn around_contact(shown: &SystemShown) -> Option<[Vector<3>; 2]> {
    let without = shown.contacts.iter().filter(|c| c.surface.is_none());
    let points: Vec<Vector<3>> = without.flat_map(|c| c.closed().into_iter().map(|k| c.at(k))).collect();
    let [low, high] = bounds(points.iter());
    let thick = shown.curves.iter().map(|c| c.radius).fold(0.0, f64::max);
    let pad = Vector::<3>::repeat((0.5 * (high - low).max()).max(6.0 * thick));
    (!points.is_empty() && pad.x > 0.0).then(|| [low - pad, high + pad])
}

/// The box of what touches of curves, with the loops between one place and another of the same curve; none where curves
/// touch nothing.
pub fn around_loops(shown: &SystemShown) -> Option<[Vector<3>; 2]> {
    let [low, high] = around_contact(shown)?;
    let thick = shown.curves.iter().map(|c| c.radius).fold(0.0, f64::max);
    let is_in = |x: &Vector<3>| (0..3).all(|k| low[k] <= x[k] && x[k] <= high[k]);
    let mut corners = vec![low, high];
    for curve in &shown.curves {
        let inside: Vec<usize> = (0..curve.points.len()).filter(|&k| is_in(&curve.points[k])).collect();
        if let (Some(&first), Some(&last)) = (inside.first(), inside.last()) {
            let pad = Vector::<3>::repeat(2.0 * thick);
            corners.extend(curve.points[first..=last].iter().flat_map(|x| [x - pad, x + pad]));
        }
    }
    (!shown.curves.is_empty()).then(|| bounds(corners.iter()))
}

/// A box about the largest force between thick curves that touch along their length, so large that their sections are seen.
pub fn around_largest(shown: &SystemShown) -> Option<[Vector<3>; 2]> {
    let thick = shown.curves.iter().map(|c| c.radius).fold(0.0, f64::max);
    let without = shown.contacts.iter().filter(|c| c.surface.is_none());
    let forces = without.flat_map(|c| c.closed().into_iter().map(|k| (c.force(k).norm(), c.at(k))));
    let (_, x) = forces.max_by(|a, b| a.0.total_cmp(&b.0))?;
    let pad = Vector::<3>::repeat(SECTIONS * thick);
    (thick > 0.0).then(|| [x - pad, x + pad])
}

/// Half a close view of curves that touch along their length, in radii: a few diameters to either side.
const SECTIONS: f64 = 10.0;

/// From where a face that is touched is seen, if it looks this little towards the usual side, as a cosine.
const AVERTED: f64 = 0.2;

/// From where that which touches rigid bodies is seen, where it looks away: from the side to which it looks on the whole,
/// and half as much from the usual one. Surfaces are shown otherwise.
pub fn facing_contact(shown: &SystemShown) -> Option<Vector<3>> {
    if shown.solids().count() != 1 || shown.rigid.is_empty() {
        return None;
    }
    let without = shown.contacts.iter().filter(|c| c.surface.is_none());
    let force = |c: &super::system::ContactShown| c.closed().into_iter().map(|k| c.force(k)).sum::<Vector<3>>();
    let side = -without.map(force).sum::<Vector<3>>().try_normalize(0.0)?;
    let towards = usual().normalize();
    let along = side.dot(&towards);
    (along < AVERTED).then(|| side + (towards - side * along).try_normalize(0.0).unwrap_or_default() * 0.5)
}
