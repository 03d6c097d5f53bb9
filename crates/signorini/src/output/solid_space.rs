//! Pictures of solids in space: the deformed bodies and the rigid ones, a cut through the largest pressure, and maps of the
//! pressure.

use super::camera::Camera;
use super::chart::{FONT, label, rounded, save, word};
use super::level::{level, surface};
use super::page::{MARGIN, SIZE, Scale, magnification, room, start, stress_title};
use super::pictures::Labels;
use super::render::{Body, Look, Paint, render};
use super::solid_fields::{ContactDisplay, SolidDisplay, SolidFields};
use super::{Folder, OutputError};
use crate::plan::solid::{Opposite, SolidPlan};
use plotters::style::RGBColor;
use signorini_geometry::{Point, Vector};
use std::fmt::Write as _;

const RIGID: RGBColor = RGBColor(168, 172, 178);
const FREE: RGBColor = RGBColor(228, 228, 228);
const FRONT: &str = "#d53c28";
/// Rigid bodies are drawn this far beyond the solids, as a part of their largest extent.
const AROUND: f64 = 0.15;
/// How much a rigid body hides of what is behind it.
const VEIL: f64 = 0.4;
/// The same in a cut, where it is behind the solids or below.
const OPAQUE: f64 = 0.95;
/// Pressures below this part of the largest are drawn as none: a colour map does not tell them from zero.
const LEAST: f64 = 0.005;

fn spatial<const D: usize>(x: &Point<D>) -> Vector<3> {
    Vector::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 })
}

fn bounds<'a>(points: impl Iterator<Item = &'a Vector<3>>) -> [Vector<3>; 2] {
    let all = [Vector::<3>::repeat(f64::INFINITY), Vector::<3>::repeat(f64::NEG_INFINITY)];
    points.fold(all, |[low, high], x| [low.inf(x), high.sup(x)])
}

/// Everything that the pictures of a state show.
struct State<'a, const D: usize> {
    plan: &'a SolidPlan<D>,
    display: &'a SolidDisplay<D>,
    contacts: &'a [ContactDisplay<D>],
    labels: &'a Labels,
    scale: Scale,
    title: String,
    /// Displaced points of the display, and their places on the colour map.
    moved: Vec<Vector<3>>,
    colours: Vec<f64>,
    solids: Vec<Body>,
    rigid: Vec<(String, Body)>,
}

impl<'a, const D: usize> State<'a, D> {
    fn new(
        plan: &'a SolidPlan<D>,
        time: f64,
        display: &'a SolidDisplay<D>,
        fields: &SolidFields<D>,
        contacts: &'a [ContactDisplay<D>],
        labels: &'a Labels,
    ) -> Self {
        // Magnified displacements would push bodies through each other.
        let factor = if plan.contacts.is_empty() { magnification(display, fields) } else { 1.0 };
        let moved: Vec<Vector<3>> =
            display.points.iter().zip(&fields.displacement).map(|(x, u)| spatial(&(x + u * factor))).collect();
        let scale = Scale::of(&fields.von_mises);
        let colours: Vec<f64> = fields.von_mises.iter().map(|v| scale.place(*v)).collect();
        let solids = (0..plan.bodies.len())
            .map(|number| {
                let own = display.polygons.iter().filter(|p| display.body[p[0] as usize] as usize == number);
                Body::of_polygons(moved.clone(), own.map(Vec::as_slice), Paint::Field(colours.clone()))
            })
            .collect();
        let [low, high] = bounds(moved.iter());
        let pad = Vector::<3>::repeat(AROUND * (high - low).max());
        let mut rigid: Vec<(String, Body)> = Vec::new();
        for contact in &plan.contacts {
            let Opposite::Rigid(body) = &contact.opposite else { continue };
            if rigid.iter().any(|(name, _)| *name == body.name) {
                continue;
            }
            let Ok(gap) = body.gap_at(&plan.head.problem, time) else { continue };
            let (points, normals, triangles) = surface(&gap, [low - pad, high + pad]);
            let normals = triangles.iter().map(|t| t.map(|k| normals[k as usize])).collect();
            let sheet = Body { points, triangles, normals, paint: Paint::Plain(RIGID), opacity: VEIL };
            rigid.push((body.name.clone(), sheet));
        }
        let title = stress_title(&scale, time, factor);
        State { plan, display, contacts, labels, scale, title, moved, colours, solids, rigid }
    }

    /// A page with bodies, the axes of a box, names and the colour bar.
    fn page(
        &self,
        title: &str,
        bodies: &[Body],
        towards: Vector<3>,
        frame: [Vector<3>; 2],
    ) -> Result<String, OutputError> {
        let mut out = start(title);
        let inner = room();
        // Room for the axes below and to the left.
        let area = [inner[0] + 40.0, inner[1], inner[2] - 10.0, inner[3] - 10.0];
        let camera = Camera::new(&towards, &Vector::<3>::z(), bodies.iter().flat_map(Body::seen), area);
        insert(&mut out, bodies, &camera, Look::Solid)?;
        camera.axes(&mut out, frame, axis_names(self.labels).each_ref().map(String::as_str));
        self.scale.bar(&mut out, &self.labels.pressure("σ"));
        let mut x = MARGIN[0];
        for (name, _) in &self.rigid {
            let _ = write!(
                out,
                "<rect x=\"{x}\" y=\"{}\" width=\"22\" height=\"12\" fill=\"rgb(168,172,178)\" stroke=\"#333\"/>\
                 <text x=\"{}\" y=\"{}\" font-family=\"{FONT}\" font-size=\"14\">{name} (rigid)</text>",
                SIZE.1 - 24.0,
                x + 30.0,
                SIZE.1 - 13.0
            );
            x += 110.0 + 8.0 * name.len() as f64;
        }
        out += "</svg>\n";
        if self.solids.len() > 1 {
            for (number, body) in self.plan.bodies.iter().enumerate() {
                let own: Vec<&Vector<3>> = self
                    .moved
                    .iter()
                    .zip(&self.display.body)
                    .filter(|(_, b)| **b as usize == number)
                    .map(|p| p.0)
                    .collect();
                let middle = own.iter().copied().sum::<Vector<3>>() / own.len().max(1) as f64;
                word(&mut out, camera.at(&middle), &body.name, RGBColor(20, 20, 20));
            }
        }
        Ok(out)
    }

    fn whole(&self) -> Result<String, OutputError> {
        let from_below = self.contacts.iter().map(|c| mean_normal(c).z).sum::<f64>() < 0.0;
        let towards = Vector::<3>::new(1.0, -1.6, if from_below { -0.9 } else { 0.9 });
        let bodies: Vec<Body> = self.solids.iter().chain(self.rigid.iter().map(|r| &r.1)).cloned().collect();
        self.page(&self.title, &bodies, towards, bounds(self.moved.iter()))
    }

    /// The half of everything behind a plane through the largest pressure, along the normal of the contact there and a
    /// coordinate axis; none where nothing touches.
    fn cut(&self) -> Result<Option<String>, OutputError> {
        let mut best: Option<(f64, Vector<3>, Vector<3>)> = None;
        for shown in self.contacts {
            for (k, p) in shown.pressure.iter().enumerate().filter(|(_, p)| **p > 0.0) {
                // The first of those that are equal but for rounding.
                if best.as_ref().is_none_or(|b| *p > b.0 * (1.0 + 1e-6)) {
                    best = Some((*p, spatial(&(shown.points[k] + shown.displacement[k])), mean_normal(shown)));
                }
            }
        }
        let Some((_, place, normal)) = best else { return Ok(None) };
        // Across the axis that is not that of the contact, the second horizontal one rather than the first.
        let axis = [1, 0, 2].into_iter().find(|&k| k != normal.iamax()).unwrap_or(1);
        let [low, high] = bounds(self.moved.iter());
        let side = if high[axis] - place[axis] >= place[axis] - low[axis] { 1.0 } else { -1.0 };
        let height = |x: &Vector<3>| side * (x[axis] - place[axis]);
        let across: Vec<f64> = self.moved.iter().map(height).collect();
        let mut bodies: Vec<Body> = self.solids.iter().map(|b| b.clipped(|x, _| height(x))).collect();
        let mut outwards = Vector::<3>::zeros();
        outwards[axis] = -side;
        for number in 0..self.plan.bodies.len() {
            let own = self.display.tetrahedra().filter(|t| self.display.body[t[0] as usize] as usize == number);
            let (edges, triangles) = level(own, |k| across[k as usize]);
            let mix = |&(a, b, t): &(u32, u32, f64)| self.moved[a as usize] * (1.0 - t) + self.moved[b as usize] * t;
            let colour =
                |&(a, b, t): &(u32, u32, f64)| self.colours[a as usize] * (1.0 - t) + self.colours[b as usize] * t;
            bodies.push(Body {
                points: edges.iter().map(mix).collect(),
                normals: vec![[outwards; 3]; triangles.len()],
                triangles,
                paint: Paint::Field(edges.iter().map(colour).collect()),
                opacity: 1.0,
            });
        }
        let kept: Vec<Vector<3>> = bodies.iter().flat_map(Body::seen).copied().collect();
        for (_, body) in &self.rigid {
            bodies.push(Body { opacity: OPAQUE, ..body.clipped(|x, _| height(x)) });
        }
        let mut towards = outwards;
        let aside = [0, 1, 2].into_iter().find(|&k| k != axis && k < 2).unwrap_or(0);
        towards[aside] += 0.45;
        towards.z += 0.35;
        let title = format!(
            "{}, cut at {} = {}",
            self.title,
            ["x", "y", "z"][axis],
            label(rounded(place[axis], high[axis] - low[axis]))
        );
        self.page(&title, &bodies, towards, bounds(kept.iter())).map(Some)
    }
}

/// Puts the raster of bodies into a page.
fn insert(out: &mut String, bodies: &[Body], camera: &Camera, look: Look) -> Result<(), OutputError> {
    let [left, top, right, bottom] = camera.area;
    render(bodies, camera, look)?.insert(out, (left, right), (top, bottom))
}

fn axis_names(labels: &Labels) -> [String; 3] {
    ["x", "y", "z"].map(|name| labels.length(name))
}

/// Draws all pictures of a state.
pub fn draw<const D: usize>(
    folder: &Folder,
    plan: &SolidPlan<D>,
    time: f64,
    display: &SolidDisplay<D>,
    fields: &SolidFields<D>,
    contacts: &[ContactDisplay<D>],
    labels: &Labels,
) -> Result<(), OutputError> {
    let state = State::new(plan, time, display, fields, contacts, labels);
    save(folder, "deformed", &state.whole()?)?;
    if let Some(picture) = state.cut()? {
        save(folder, "cut", &picture)?;
    }
    for (contact, shown) in plan.contacts.iter().zip(contacts) {
        let name = if plan.contacts.len() == 1 { "pressure".into() } else { format!("pressure_{}", contact.name) };
        save(folder, &name, &map(&contact.name, time, shown, labels)?)?;
    }
    Ok(())
}

/// The bodies before they deform.
pub fn preview<const D: usize>(
    plan: &SolidPlan<D>,
    display: &SolidDisplay<D>,
    fields: &SolidFields<D>,
    labels: &Labels,
) -> Result<String, OutputError> {
    State::new(plan, 0.0, display, fields, &[], labels).whole()
}

/// The area normal of the part in contact, or of the whole slave side where nothing touches.
fn mean_normal<const D: usize>(shown: &ContactDisplay<D>) -> Vector<3> {
    let touching = |f: &Vec<u32>| f.iter().any(|&k| shown.active[k as usize]);
    let any = shown.faces.iter().any(touching);
    (shown.faces.iter().filter(|f| !any || touching(f)))
        .map(|face| {
            let x = |k: usize| spatial(&shown.points[face[k] as usize]);
            (x(1) - x(0)).cross(&(x(face.len() - 1) - x(0)))
        })
        .sum()
}

/// Pressure on the slave side, seen from outside.
fn map<const D: usize>(
    name: &str,
    time: f64,
    shown: &ContactDisplay<D>,
    labels: &Labels,
) -> Result<String, OutputError> {
    let points: Vec<Vector<3>> = shown.points.iter().map(spatial).collect();
    let zone: Vec<Vector<3>> = (0..points.len()).filter(|&k| shown.active[k]).map(|k| points[k]).collect();
    let [low, high] = bounds(points.iter());
    let window = if zone.is_empty() {
        [low, high]
    } else {
        // A quarter of the zone's size around it, within the side.
        let [from, to] = bounds(zone.iter());
        let pad = Vector::<3>::repeat(0.25 * (to - from).max());
        [low.sup(&(from - pad)), high.inf(&(to + pad))]
    };
    // Along a coordinate axis where the side is nearly across it.
    let mut towards = mean_normal(shown).try_normalize(0.0).unwrap_or_else(Vector::<3>::z);
    let main = towards.iamax();
    if towards[main].abs() > 0.99 {
        let sign = towards[main].signum();
        towards = Vector::<3>::zeros();
        towards[main] = sign;
    }
    let above = if main == 2 { Vector::<3>::y() } else { Vector::<3>::z() };
    let corners: Vec<Vector<3>> = (0..8).map(|c| Vector::<3>::from_fn(|k, _| window[c >> k & 1][k])).collect();
    let area = room();
    let camera = Camera::new(&towards, &above, corners.iter(), [area[0] + 20.0, area[1], area[2], area[3]]);
    let most = shown.pressure.iter().fold(0.0f64, |m, p| m.max(*p));
    let scale = Scale::up_to(most);
    let mut out = start(&format!("Contact pressure of `{name}`, t = {}", label(time)));
    let faces = shown.faces.iter().map(Vec::as_slice);
    let relative: Vec<f64> = shown.pressure.iter().map(|p| p / most.max(f64::MIN_POSITIVE)).collect();
    let side = Body::of_polygons(points, faces, Paint::Field(relative));
    let bodies = [Body { paint: Paint::Plain(FREE), ..side.clipped(|_, p| LEAST - p) }, side.clipped(|_, p| p - LEAST)];
    insert(&mut out, &bodies, &camera, Look::Map)?;
    for ends in &shown.boundary {
        let [a, b] = ends.map(|x| camera.at(&spatial(&x)));
        let _ = write!(
            out,
            "<line x1=\"{:.2}\" y1=\"{:.2}\" x2=\"{:.2}\" y2=\"{:.2}\" stroke=\"{FRONT}\" stroke-width=\"2\" stroke-linecap=\"round\"/>",
            a.0, a.1, b.0, b.1
        );
    }
    camera.axes(&mut out, window, axis_names(labels).each_ref().map(String::as_str));
    scale.bar(&mut out, &labels.pressure("p"));
    let (x, y) = (SIZE.0 - 112.0, SIZE.1 - 50.0);
    let _ = write!(
        out,
        "<rect x=\"{x}\" y=\"{y}\" width=\"20\" height=\"12\" fill=\"rgb(228,228,228)\" stroke=\"#888\"/>\
         <path d=\"M{x} {0}h20\" stroke=\"{FRONT}\" stroke-width=\"2.5\"/>\
         <g font-family=\"{FONT}\" font-size=\"13\"><text x=\"{1}\" y=\"{2}\">no pressure</text>\
         <text x=\"{1}\" y=\"{3}\">rim of contact</text></g>",
        y + 28.0,
        x + 26.0,
        y + 11.0,
        y + 32.0
    );
    Ok(out + "</svg>\n")
}
