//! Pictures of systems of bodies: ropes and beams as tubes between rigid bodies, and what they carry along their length.

use super::camera::Camera;
use super::chart::{label, save, viridis, word};
use super::history;
use super::labels::Labels;
use super::level::{region, surface};
use super::page::{Page, SIZE, Scale, Sign, sheet};
use super::panel::{Axis, Dots, Panel};
use super::render::{Body, Look, Paint};
use super::solid_state::{FREE, FRONT, RIGID, insert};
use super::system::{CurveShown, SystemShown, moved};
use super::{Folder, OutputError};
use crate::fields::Fields;
use crate::plan::mechanics::MechanicsPlan;
use crate::problem::Space;
use crate::report::{ContactReport, StepReport};
use plotters::style::RGBColor;
use signorini_geometry::Vector;

/// Corners of the polygon that is drawn for a section.
const AROUND_SECTION: usize = 12;
/// Curves are drawn at least so thick, as a part of the extent of the picture.
const THIN: f64 = 0.006;
/// How much a rigid body hides of what is behind it: those around curves are seen through a little.
const VEIL: f64 = 0.75;
const INK: RGBColor = RGBColor(20, 20, 20);
/// The edges of rigid bodies in the plane.
const EDGE: RGBColor = RGBColor(110, 114, 120);
/// The largest normal force is drawn as an arrow of this part of the extent.
const ARROW: f64 = 0.12;
/// At most so many arrows on a curve.
const ARROWS: usize = 40;
const WIDTH: f64 = 900.0;

/// A tube about a curve, coloured by values of its cells from 0 to 1.
pub fn tube(curve: &CurveShown, radius: f64, colours: &[f64]) -> Body {
    let n = curve.points.len();
    let mut tangents = vec![Vector::<3>::zeros(); n];
    for [a, b] in &curve.cells {
        let d = curve.points[*b as usize] - curve.points[*a as usize];
        let d = d.try_normalize(0.0).unwrap_or_default();
        tangents[*a as usize] += d;
        tangents[*b as usize] += d;
    }
    let mut across =
        signorini_mechanics::pair::any_tangent(&tangents[0].try_normalize(0.0).unwrap_or_else(Vector::<3>::x));
    let mut rings: Vec<Vec<Vector<3>>> = Vec::with_capacity(n);
    for tangent in &tangents {
        let t = tangent.try_normalize(0.0).unwrap_or_else(Vector::<3>::x);
        // Turned about the curve as little as can be.
        across = (across - t * t.dot(&across))
            .try_normalize(1e-9)
            .unwrap_or_else(|| signorini_mechanics::pair::any_tangent(&t));
        let other = t.cross(&across);
        let ring = (0..AROUND_SECTION).map(|k| {
            let angle = std::f64::consts::TAU * k as f64 / AROUND_SECTION as f64;
            across * angle.cos() + other * angle.sin()
        });
        rings.push(ring.collect());
    }
    let mut body = Body::empty(Paint::Field(Vec::new()));
    let mut values = Vec::new();
    for ([a, b], colour) in curve.cells.iter().zip(colours) {
        let first = body.points.len() as u32;
        for end in [*a as usize, *b as usize] {
            body.points.extend(rings[end].iter().map(|r| curve.points[end] + r * radius));
            values.extend(std::iter::repeat_n(*colour, AROUND_SECTION));
        }
        let m = AROUND_SECTION as u32;
        for k in 0..m {
            let next = (k + 1) % m;
            let (p, q) = (&rings[*a as usize], &rings[*b as usize]);
            body.triangles.push([first + k, first + next, first + m + next]);
            body.normals.push([p[k as usize], p[next as usize], q[next as usize]]);
            body.triangles.push([first + k, first + m + next, first + m + k]);
            body.normals.push([p[k as usize], q[next as usize], q[k as usize]]);
        }
    }
    body.paint = Paint::Field(values);
    body
}

/// What the colours tell: the axial force of curves; without any, the equivalent stress of solids.
fn scale_of(shown: &SystemShown) -> Scale {
    let all: Vec<f64> = if shown.curves.is_empty() {
        shown.solids().flat_map(|b| b.array("von_mises").unwrap_or_default().to_vec()).collect()
    } else {
        shown.curves.iter().flat_map(|c| c.forces.iter().copied()).collect()
    };
    Scale::of(&all)
}

/// The surface of a solid where it is: its cells in the plane, and in space the sides of cells that no other cell has.
fn solid(fields: &Fields, paint: Paint) -> Body {
    const SIDES: [[usize; 4]; 6] = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];
    let mut polygons: Vec<Vec<u32>> = Vec::new();
    let mut sides: std::collections::BTreeMap<Vec<[u64; 3]>, Option<Vec<u32>>> = std::collections::BTreeMap::new();
    // Cells have points of their own: the same places are the same points.
    let place = |k: u32| fields.points[k as usize].map(|v| (v + 0.0).to_bits());
    for (_, cell) in &fields.cells {
        if cell.len() != 8 {
            polygons.push(cell.clone());
            continue;
        }
        for side in SIDES {
            let mut list: Vec<u32> = side.iter().map(|k| cell[*k]).collect();
            list.dedup();
            if list.len() > 1 && list.first() == list.last() {
                list.pop();
            }
            if list.len() < 3 {
                continue;
            }
            let mut key: Vec<[u64; 3]> = list.iter().map(|k| place(*k)).collect();
            key.sort_unstable();
            sides.entry(key).and_modify(|found| *found = None).or_insert(Some(list));
        }
    }
    polygons.extend(sides.into_values().flatten());
    Body::of_polygons(moved(fields), polygons.iter().map(Vec::as_slice), paint)
}

/// The bodies in space.
fn bodies(shown: &SystemShown, scale: &Scale, in_space: bool) -> Vec<Body> {
    let [low, high] = shown.bounds();
    let thin = THIN * (high - low).max();
    let mut out: Vec<Body> = (shown.curves.iter())
        .map(|c| {
            let colours: Vec<f64> = c.forces.iter().map(|f| scale.place(*f)).collect();
            tube(c, c.radius.max(thin), &colours)
        })
        .collect();
    for fields in shown.solids() {
        let stress = fields.array("von_mises").filter(|_| shown.curves.is_empty());
        let paint = match stress {
            Some(values) => Paint::Field(values.iter().map(|v| scale.place(*v)).collect()),
            None => Paint::Plain(FREE),
        };
        out.push(solid(fields, paint));
    }
    let room = shown.room();
    for body in shown.rigid.iter().filter(|_| in_space) {
        let (points, normals, triangles) = surface(body.gap.as_ref(), room);
        let normals = triangles.iter().map(|t| t.map(|k| normals[k as usize])).collect();
        let opacity = if body.is_free { 1.0 } else { VEIL };
        out.push(Body { points, triangles, normals, paint: Paint::Plain(RIGID), opacity });
    }
    out
}

fn scene(plan: &MechanicsPlan, shown: &SystemShown, title: &str, note: &str) -> Result<String, OutputError> {
    let labels = Labels(plan.head.unit_names());
    let scale = scale_of(shown);
    let plane = plan.space != Space::ThreeD;
    let drawn = bodies(shown, &scale, !plane);
    let mut page = Page::new(SIZE, title, note);
    let inner = page.room();
    let area = [inner[0] + 26.0, inner[1], inner[2] - 10.0, inner[3] - 6.0];
    let (towards, above) =
        if plane { (Vector::<3>::z(), Vector::<3>::y()) } else { (Vector::<3>::new(1.0, -1.6, 0.9), Vector::<3>::z()) };
    let mut points: Vec<Vector<3>> = drawn.iter().flat_map(Body::seen).copied().collect();
    // The axes stand along the box of the bodies.
    let ends = shown.bounds();
    points.extend((0..8).map(|c| Vector::<3>::from_fn(|k, _| ends[c >> k & 1][k])));
    let room = shown.room();
    if plane {
        points.extend(room.map(|x| Vector::<3>::new(x.x, x.y, 0.0)));
    }
    if ends[0].x > ends[1].x {
        return Ok(page.finish());
    }
    let camera = Camera::new(&towards, &above, points.iter(), area);
    insert(&mut page.svg, &drawn, &camera, Look::Solid)?;
    if plane {
        // In the plane a rigid body is its edge.
        let flat = room.map(|x| Vector::<3>::new(x.x, x.y, 0.0));
        for body in &shown.rigid {
            for piece in region(body.gap.as_ref(), flat).1 {
                super::chart::line(&mut page.svg, &piece.map(|x| camera.at(&x)), EDGE);
            }
        }
    }
    let axes = ["x", "y", "z"].map(|a| labels.length(a));
    camera.axes(&mut page.svg, shown.bounds(), axes.each_ref().map(String::as_str));
    let slips = forces(&mut page, shown, &camera);
    for c in &shown.curves {
        if let Some(x) = c.points.get(c.points.len() / 2) {
            word(&mut page.svg, camera.at(x), &c.name, INK);
        }
    }
    for r in shown.rigid.iter().filter(|r| r.is_free) {
        word(&mut page.svg, camera.at(&r.centre), &r.name, INK);
    }
    if shown.curves.iter().any(|c| !c.forces.is_empty()) {
        page.bar(&scale, &labels.force("axial force"));
    } else if shown.solids().next().is_some() {
        page.bar(&scale, &labels.pressure("von Mises stress"));
    }
    let mut key = Vec::new();
    if !shown.contacts.is_empty() {
        key.push((Sign::Line(viridis(0.15)), "force of contact on the first body".to_string()));
    }
    if slips {
        key.push((Sign::Dot(FRONT), "slips".into()));
    }
    page.key(&key);
    Ok(page.finish())
}

/// Arrows of the contact forces, and dots where it slips; whether there are such.
fn forces(page: &mut Page, shown: &SystemShown, camera: &Camera) -> bool {
    let [low, high] = shown.bounds();
    let length = ARROW * (high - low).max();
    let mut slips = false;
    for contact in &shown.contacts {
        let (Some(pressure), Some(normal)) = (contact.array("contact_pressure"), contact.array("normal")) else {
            continue;
        };
        let friction = contact.array("friction_traction");
        let weight = contact.array("weight").unwrap_or_default();
        let status = contact.array("friction_status").unwrap_or_default();
        let force = |k: usize| {
            let n = Vector::<3>::from_column_slice(&normal[3 * k..3 * k + 3]);
            let t = friction.map_or(Vector::<3>::zeros(), |f| Vector::<3>::from_column_slice(&f[3 * k..3 * k + 3]));
            (n * pressure[k] + t) * weight[k]
        };
        let closed: Vec<usize> = (0..pressure.len()).filter(|&k| pressure[k] > 0.0).collect();
        let most = closed.iter().map(|&k| force(k).norm()).fold(0.0, f64::max);
        let every = closed.len().div_ceil(ARROWS).max(1);
        for &k in closed.iter().step_by(every) {
            let x = Vector::<3>::from(contact.points[k]);
            let end = x + force(k) * (length / most);
            super::chart::line(&mut page.svg, &[camera.at(&x), camera.at(&end)], viridis(0.15));
            if status.get(k) == Some(&2.0) {
                slips = true;
                let (a, b) = camera.at(&x);
                Sign::Dot(FRONT).draw(&mut page.svg, a - 11.0, b);
            }
        }
    }
    slips
}

/// The axial force of a curve along its length.
fn along(curve: &CurveShown, labels: &Labels, time: f64) -> String {
    let mut page = Page::new((WIDTH, 460.0), &format!("Axial force along `{}`, t = {}", curve.name, label(time)), "");
    let runs: Vec<(f64, f64)> = (curve.cells.iter().zip(&curve.forces))
        .flat_map(|([a, b], f)| {
            let (a, b) = (curve.arc[*a as usize], curve.arc[*b as usize]);
            // The last cell of a closed curve ends where the first begins.
            if b > a { vec![(a, *f), (b, *f)] } else { Vec::new() }
        })
        .collect();
    let range = |of: fn(&(f64, f64)) -> f64| {
        runs.iter().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
    };
    let names = (labels.length("length along it"), labels.force("axial force"));
    let (x, y) = (Axis::around(&names.0, range(|p| p.0)), Axis::from_zero(&names.1, range(|p| p.1)));
    let mut panel = Panel::new(&mut page.svg, [0.0, 46.0, WIDTH, 456.0], x, y);
    panel.line(&runs, Sign::Line(viridis(0.3)), 2.0);
    page.finish()
}

/// What a contact of a curve carries along the tested points.
fn carried(contact: &Fields, labels: &Labels, time: f64) -> Option<String> {
    let pressure = contact.array("contact_pressure")?;
    if contact.cells.is_empty() || contact.points.len() < 3 {
        return None;
    }
    let mut at = vec![0.0];
    for pair in contact.points.windows(2) {
        let step = (Vector::<3>::from(pair[1]) - Vector::<3>::from(pair[0])).norm();
        at.push(at.last().copied().unwrap_or(0.0) + step);
    }
    let normal: Vec<(f64, f64)> = at.iter().copied().zip(pressure.iter().copied()).collect();
    let friction: Option<Vec<(f64, f64)>> = contact
        .array("friction_traction")
        .map(|f| at.iter().copied().zip(f.chunks(3).map(|t| Vector::<3>::from_column_slice(t).norm())).collect());
    let title = format!("Contact of `{}`, t = {}", contact.name, label(time));
    let mut page = Page::new((WIDTH, 460.0), &title, "");
    let all = normal.iter().chain(friction.iter().flatten()).map(|p| p.1);
    let high = all.fold(0.0f64, f64::max);
    let names = (labels.length("length along the tested points"), "force per length".to_string());
    let x = Axis::around(&names.0, (0.0, at.last().copied().unwrap_or(1.0)));
    let y = Axis::from_zero(&names.1, (0.0, high));
    let mut panel = Panel::new(&mut page.svg, [0.0, 46.0, WIDTH, 456.0], x, y);
    panel.line(&normal, Sign::Line(viridis(0.3)), 2.0);
    let mut key = vec![(Sign::Line(viridis(0.3)), "normal".to_string())];
    if let Some(friction) = &friction {
        panel.line(friction, Sign::Line(viridis(0.7)), 2.0);
        key.push((Sign::Line(viridis(0.7)), "friction".into()));
        let status = contact.array("friction_status").unwrap_or_default();
        let slipping: Vec<(f64, f64)> =
            friction.iter().zip(status).filter(|(_, s)| **s == 2.0).map(|(p, _)| *p).collect();
        if !slipping.is_empty() {
            panel.dots(&slipping, FRONT, 3.0, Dots::Full);
            key.push((Sign::Dot(FRONT), "slips".into()));
        }
    }
    panel.key(&key);
    Some(page.finish())
}

/// Draws the last state and the history.
///
/// # Errors
/// Pictures that cannot be drawn or written.
pub fn draw(
    folder: &Folder,
    plan: &MechanicsPlan,
    shown: &SystemShown,
    steps: &[StepReport],
) -> Result<(), OutputError> {
    let labels = Labels(plan.head.unit_names());
    let title = format!("{}, t = {}", plan.head.problem.name(), label(shown.time));
    let mut drawn = vec![("deformed".to_string(), scene(plan, shown, &title, "")?)];
    for curve in shown.curves.iter().filter(|c| !c.forces.is_empty()) {
        drawn.push((format!("axial_force_{}", curve.name), along(curve, &labels, shown.time)));
    }
    for contact in &shown.contacts {
        drawn.extend(carried(contact, &labels, shown.time).map(|p| (format!("contact_{}", contact.name), p)));
    }
    if steps.len() > 1 && !plan.system.contacts.is_empty() {
        let names: Vec<&str> = plan.system.contacts.iter().map(|c| c.name()).collect();
        let force = |c: &ContactReport| c.force.iter().map(|v| v * v).sum::<f64>().sqrt();
        drawn.push(("history".into(), history::history(steps, &[], &names, Space::PlaneStrain, &force, &labels)));
    }
    drawn.iter().try_for_each(|(name, picture)| save(folder, name, picture))?;
    if drawn.len() > 1 {
        save(folder, "overview", &sheet(&drawn.into_iter().map(|d| d.1).collect::<Vec<_>>()))?;
    }
    Ok(())
}

/// The bodies before anything happens.
///
/// # Errors
/// A picture that cannot be drawn.
pub fn preview(plan: &MechanicsPlan) -> Result<String, OutputError> {
    let shown = SystemShown::of_bodies(plan, &plan.system.start());
    scene(plan, &shown, plan.head.problem.name(), "at the start")
}
