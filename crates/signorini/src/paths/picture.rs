//! Bodies and paths in space: the path coloured by its normal force, with arrows of that force, and red where it slips or
//! bridges. Of paths in time their length.

use super::case::PathCase;
use super::output::{Line, LinePoint};
use super::surface::Surface;
use crate::output::camera::Camera;
use crate::output::chart::{self, save, viridis};
use crate::output::figure::exact;
use crate::output::labels::Labels;
use crate::output::page::{MARGIN, Page, Scale, Sign, text_width};
use crate::output::panel::{Axis, Panel};
use crate::output::render::{Body, Look, Paint, insert};
use crate::output::tube::tube;
use crate::output::{Folder, OutputError};
use plotters::style::RGBColor;
use signorini_geometry::Vector;
use std::collections::HashMap;

/// The largest page, and the size of the letters of its title.
const SIZE: (f64, f64) = (1060.0, 760.0);
const TITLE: f64 = 19.0;
const BODIES: [RGBColor; 3] = [RGBColor(158, 182, 214), RGBColor(226, 196, 146), RGBColor(170, 205, 170)];
const IN_THE_AIR: RGBColor = RGBColor(70, 70, 70);
const SLIPS: RGBColor = RGBColor(213, 30, 30);
/// The radius of a path, and the length of the largest arrow, as parts of the extent of what is drawn.
const THICK: f64 = 0.004;
const ARROW: f64 = 0.08;
/// At most so many arrows on a path.
const ARROWS: usize = 40;

/// The pieces of a path that a test keeps, as a tube coloured by the normal force.
fn pieces(line: &Line, keep: &dyn Fn(&LinePoint, &LinePoint) -> bool, scale: &Scale, radius: f64) -> Body {
    let cells: Vec<[u32; 2]> = (1..line.points.len() as u32)
        .map(|k| [k - 1, k])
        .filter(|[a, b]| keep(&line.points[*a as usize], &line.points[*b as usize]))
        .collect();
    let colours: Vec<f64> = line.points.iter().map(|p| scale.place(p.normal_force)).collect();
    let points: Vec<Vector<3>> = line.points.iter().map(|p| p.x).collect();
    tube(&points, &cells, radius, Paint::Field(colours))
}

/// The triangles of bodies by where they are on the page: which of them may be in front of a point.
pub struct Cover<'a> {
    camera: &'a Camera,
    triangles: Vec<[Vector<3>; 3]>,
    fields: HashMap<[i32; 2], Vec<usize>>,
}

impl<'a> Cover<'a> {
    /// Side of a field, on the page.
    const SIDE: f64 = 12.0;

    pub fn new(surfaces: &[Surface], camera: &'a Camera) -> Self {
        let corners = |s: &Surface, t: &[u32; 3]| t.map(|v| s.points[v as usize]);
        let triangles: Vec<[Vector<3>; 3]> =
            surfaces.iter().flat_map(|s| s.triangles.iter().map(move |t| corners(s, t))).collect();
        let mut cover = Cover { camera, triangles: Vec::new(), fields: HashMap::new() };
        for (k, corners) in triangles.iter().enumerate() {
            let fields = corners.each_ref().map(|x| cover.field(x));
            let range = |i: usize| {
                let along = fields.map(|f| f[i]);
                along.into_iter().min().unwrap_or(0)..=along.into_iter().max().unwrap_or(0)
            };
            for i in range(0) {
                range(1).for_each(|j| cover.fields.entry([i, j]).or_default().push(k));
            }
        }
        Cover { triangles, ..cover }
    }

    fn field(&self, x: &Vector<3>) -> [i32; 2] {
        let (x, y) = self.camera.at(x);
        [x, y].map(|v| (v / Self::SIDE).floor() as i32)
    }

    fn hides(&self, x: &Vector<3>) -> bool {
        let near = self.fields.get(&self.field(x)).map_or(&[][..], |l| l);
        near.iter().any(|&k| in_front(x, self.triangles[k], &self.camera.towards))
    }

    /// The parts of a path that lie behind a body by more than a margin.
    pub fn hidden(&self, line: &Line, margin: f64) -> Vec<Vec<Vector<3>>> {
        let between = line.points.windows(2).flat_map(|pair| {
            let way = pair[1].x - pair[0].x;
            let parts = (way.norm() / margin).ceil().max(1.0) as usize;
            (0..parts).map(move |k| pair[0].x + way * (k as f64 / parts as f64))
        });
        let told = |x: Vector<3>| (x, self.hides(&(x + self.camera.towards * margin)));
        let points: Vec<(Vector<3>, bool)> = between.chain(line.points.last().map(|p| p.x)).map(told).collect();
        let runs = points.chunk_by(|a, b| a.1 == b.1).filter(|run| run[0].1);
        runs.map(|run| run.iter().map(|(x, _)| *x).collect()).collect()
    }
}

/// Whether a triangle lies in front of a point.
fn in_front(x: &Vector<3>, [a, b, c]: [Vector<3>; 3], towards: &Vector<3>) -> bool {
    let area = |p: &Vector<3>, q: &Vector<3>| (p - x).cross(&(q - x)).dot(towards);
    let shares = [area(&b, &c), area(&c, &a), area(&a, &b)];
    let whole: f64 = shares.iter().sum();
    let inside = whole != 0.0 && shares.iter().all(|s| s / whole >= 0.0);
    inside && (a * shares[0] + b * shares[1] + c * shares[2]).dot(towards) / whole > x.dot(towards)
}

/// Where the names of paths stand: where each is seen best, without covering another name.
fn places(lines: &[&Line], camera: &Camera) -> Vec<(f64, f64)> {
    let mut taken: Vec<((f64, f64), f64)> = Vec::new();
    for line in lines {
        let faces = |p: &LinePoint| if p.body >= 0 { p.frame[2].dot(&camera.towards) } else { 0.0 };
        let half = 0.5 * text_width(&line.name, chart::WORD);
        let free = |p: &&LinePoint| {
            let (x, y) = camera.at(&p.x);
            taken.iter().all(|((u, v), other)| (x - u).abs() > half + other + 4.0 || (y - v).abs() > chart::WORD)
        };
        let best = |a: &&LinePoint, b: &&LinePoint| faces(a).total_cmp(&faces(b));
        let place = line.points.iter().filter(free).max_by(best).or_else(|| line.points.iter().max_by(best));
        taken.push((place.map_or((0.0, 0.0), |p| camera.at(&p.x)), half));
    }
    taken.into_iter().map(|(at, _)| at).collect()
}

/// Whether a case asks for pictures.
pub fn are_wanted(case: &PathCase) -> bool {
    case.problem().output.pictures != Some(false)
}

/// Draws paths over bodies into a folder.
pub fn draw(case: &PathCase, surfaces: &[Surface], lines: &[Line], folder: &Folder) -> Result<(), OutputError> {
    if !are_wanted(case) {
        return Ok(());
    }
    save(folder, "paths", &of_paths(case, surfaces, lines)?)
}

/// Paths over bodies, as SVG.
pub fn of_paths(case: &PathCase, surfaces: &[Surface], lines: &[Line]) -> Result<String, OutputError> {
    let [from, up] = case.plan.view;
    let seen: Vec<Vector<3>> = (surfaces.iter().flat_map(|s| &s.points).copied())
        .chain(lines.iter().flat_map(|l| l.points.iter().map(|p| p.x)))
        .collect();
    let bounds = crate::output::camera::bounds(seen.iter());
    let extent = (bounds[1] - bounds[0]).max();
    let mut bodies: Vec<Body> = Vec::new();
    for (k, surface) in surfaces.iter().enumerate() {
        let mut body = Body::empty(Paint::Plain(BODIES[k % BODIES.len()]));
        body.points.clone_from(&surface.points);
        body.triangles.clone_from(&surface.triangles);
        body.normals = surface.triangles.iter().map(|t| t.map(|v| surface.normals[v as usize])).collect();
        bodies.push(body);
    }
    let touches = |a: &LinePoint, b: &LinePoint| a.body >= 0 && a.body == b.body;
    let slips = |a: &LinePoint, b: &LinePoint| touches(a, b) && a.utilisation.max(b.utilisation) > 1.0 + 1e-9;
    let forces: Vec<f64> = lines.iter().flat_map(|l| &l.points).map(|p| p.normal_force.max(0.0)).collect();
    let scale = Scale::of(&forces);
    let mut key = Vec::new();
    let mut some_slip = false;
    let mut some_hidden = false;
    for line in lines {
        let kinds: [(&dyn Fn(&LinePoint, &LinePoint) -> bool, Option<RGBColor>); 3] = [
            (&|a, b| !touches(a, b), Some(IN_THE_AIR)),
            (&|a, b| slips(a, b), Some(SLIPS)),
            (&|a, b| touches(a, b) && !slips(a, b), None),
        ];
        for (k, (keep, colour)) in kinds.into_iter().enumerate() {
            // Those without a name only show what the others cover.
            let radius = if line.name.is_empty() { 0.4 * THICK } else { THICK };
            let mut body = pieces(line, keep, &scale, radius * extent);
            if let Some(colour) = colour {
                body.paint = Paint::Plain(colour);
            }
            some_slip |= k == 1 && !body.triangles.is_empty();
            bodies.push(body);
        }
    }
    bodies.retain(|b| !b.triangles.is_empty());
    let labels = Labels(case.plan.head.unit_names());
    let corners = (0..8).map(|c| Vector::<3>::from_fn(|k, _| bounds[c >> k & 1][k]));
    let around: Vec<Vector<3>> = seen.iter().copied().chain(corners).collect();
    // As high as what is seen asks for.
    let extent_seen = Camera::new(&from, &up, around.iter(), [0.0, 0.0, 1e3, 1e3]).extent();
    let size = Page::size_within(extent_seen, [SIZE.0 - MARGIN[0] - MARGIN[2], SIZE.1 - MARGIN[1] - MARGIN[3]]);
    let mut page = Page::new((size.0.max(text_width(case.name(), TITLE) + 40.0), size.1), case.name(), "");
    let inner = page.room();
    let area = [inner[0] + 26.0, inner[1], inner[2] - 40.0, inner[3] - 6.0];
    let camera = Camera::new(&from, &up, around.iter(), area);
    insert(&mut page.svg, &bodies, &camera, Look::Solid)?;
    let axes = ["x", "y", "z"].map(|a| labels.length(a));
    camera.axes(&mut page.svg, bounds, axes.each_ref().map(String::as_str));
    let largest = forces.iter().copied().fold(0.0, f64::max);
    let cover = Cover::new(surfaces, &camera);
    for line in lines.iter().filter(|l| !l.name.is_empty()) {
        let pressed: Vec<&LinePoint> = line.points.iter().filter(|p| p.body >= 0 && p.normal_force > 0.0).collect();
        for p in pressed.iter().step_by(pressed.len().div_ceil(ARROWS).max(1)) {
            // Only on the side that is seen.
            if p.frame[2].dot(&camera.towards) <= 0.0 {
                continue;
            }
            let end = p.x + p.frame[2] * (ARROW * extent * p.normal_force / largest);
            let colour = viridis(scale.place(p.normal_force));
            chart::line(&mut page.svg, &[camera.at(&p.x), camera.at(&end)], colour);
        }
        for run in cover.hidden(line, 2.0 * THICK * extent) {
            chart::dashes(&mut page.svg, &run.iter().map(|x| camera.at(x)).collect::<Vec<_>>(), IN_THE_AIR);
            some_hidden = true;
        }
    }
    let named: Vec<&Line> = lines.iter().filter(|l| !l.name.is_empty()).collect();
    if named.len() > 1 {
        for (line, at) in named.iter().zip(places(&named, &camera)) {
            chart::word(&mut page.svg, at, &line.name, IN_THE_AIR);
        }
    }
    page.bar(&scale, &labels.force_per_length("normal force"));
    if largest > 0.0 {
        key.push((
            Sign::Line(viridis(0.5)),
            "in contact: colour and arrows are the normal force per length".to_string(),
        ));
    }
    if lines.iter().any(|l| l.points.iter().any(|p| p.body < 0)) {
        key.push((Sign::Line(IN_THE_AIR), "without contact".into()));
    }
    if some_hidden {
        key.push((Sign::Dashes(IN_THE_AIR), "behind a body".into()));
    }
    if some_slip {
        key.push((Sign::Line(SLIPS), "slips or bridges".into()));
    }
    page.key(&key);
    Ok(page.finish())
}

/// A value of each path in time as lines.
pub fn history(
    case: &PathCase,
    (file, title, value_name): (&str, &str, &str),
    curves: &[(String, Vec<(f64, f64)>)],
    folder: &Folder,
) -> Result<(), OutputError> {
    if !are_wanted(case) {
        return Ok(());
    }
    let all = || curves.iter().flat_map(|c| c.1.iter());
    let range = |of: fn(&(f64, f64)) -> f64| {
        all().map(of).fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
    };
    let mut page = Page::new((900.0, 460.0), &format!("{title}: {}", case.name()), "");
    let (x, y) = (Axis::around("t", range(|p| p.0)), Axis::around(value_name, range(|p| p.1)));
    let mut panel = Panel::new(&mut page.svg, [0.0, 46.0, 900.0, 440.0], x, y);
    let mut key = Vec::new();
    for (k, (name, points)) in curves.iter().enumerate() {
        let colour = viridis(0.15 + 0.7 * k as f64 / curves.len().max(2) as f64);
        panel.line(points, Sign::Line(colour), 2.0);
        let last = points.last().map_or(0.0, |p| p.1);
        key.push((Sign::Line(colour), format!("{name}, at the end {}", exact(last, ""))));
    }
    page.key(&key);
    save(folder, file, &page.finish())
}
