//! Pictures of solids in the plane: the deformed bodies with their stress, the rigid ones and where they touch; the
//! pressure along a side.

use super::OutputError;
use super::camera::Camera;
use super::chart::label;
use super::labels::Labels;
use super::level::region;
use super::page::{Page, Sign, clip_to, css};
use super::panel::{Axis, Dots, Panel};
use super::render::{Body, Look, Paint};
use super::solid_fields::{ContactDisplay, SolidDisplay};
use super::solid_state::{FRONT, RIGID, State, axis_names, bounds};
use crate::problem::Space;
use plotters::style::RGBColor;
use signorini_geometry::{Point, Vector};
use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write as _;

const LINE: RGBColor = RGBColor(31, 81, 140);
/// Of the colours that those who are blind to red or green tell from the line (Okabe & Ito 2008).
const FRICTION: RGBColor = RGBColor(213, 94, 0);
/// What is seen around the bodies, as a part of their largest extent.
const AROUND: f64 = 0.06;
/// A window that shows the zone of contact is larger by this part of it on every side; where it would be more than this
/// part of the whole there is none.
const WINDOW: f64 = 0.8;
const SMALL: f64 = 0.25;
/// Pressures beyond this many times of what is usual in the zone are not drawn.
const SINGULAR: f64 = 4.0;
/// Up to so many nodes are marked.
const FEW: usize = 80;

/// What of the plane a picture of bodies shows.
pub fn view(space: Space, points: &[Vector<3>]) -> [Vector<3>; 2] {
    let [low, high] = bounds(points.iter());
    let pad = AROUND * (high - low).max();
    let mut from = low - Vector::<3>::new(pad, pad, 0.0);
    if space == Space::Axisymmetric {
        // There is nothing beyond the axis.
        from.x = from.x.max(0.0_f64.min(low.x));
    }
    [from, high + Vector::<3>::new(pad, pad, 0.0)]
}

/// The surroundings of the zone of contact, where they are small: low and high corner.
pub fn window<const D: usize>(state: &State<D>) -> Option<[Vector<3>; 2]> {
    if state.zones.is_empty() {
        return None;
    }
    let [low, high] = bounds(state.zones.iter().flatten());
    let [from, to] = bounds(state.moved.iter());
    let size = (high - low).max();
    let square = |length: f64| Vector::<3>::new(length, length, 0.0);
    // Not far beyond the bodies.
    let around = square(AROUND * size);
    let corners =
        [(low - square(WINDOW * size)).sup(&(from - around)), (high + square(WINDOW * size)).inf(&(to + around))];
    (size > 0.0 && (1.0 + 2.0 * WINDOW) * size < SMALL * (to - from).max()).then_some(corners)
}

/// The deformed bodies coloured by the equivalent stress, in a part of the plane.
///
/// # Errors
/// A raster without area.
pub fn deformed<const D: usize>(state: &State<D>, corners: [Vector<3>; 2]) -> Result<String, OutputError> {
    let extent = corners[1] - corners[0];
    let mut page = Page::new(Page::size_for([extent.x, extent.y]), &state.title, &state.note);
    let camera = Camera::of_plane(&corners, page.room());
    let (mut bodies, mut edges) = (Vec::new(), Vec::new());
    for (_, gap) in &state.tools {
        let (triangles, edge) = region(gap, corners);
        let points: Vec<Vector<3>> = triangles.into_iter().flatten().collect();
        let triangles: Vec<[u32; 3]> = (0..points.len() as u32 / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
        let normals = vec![[Vector::<3>::z(); 3]; triangles.len()];
        bodies.push(Body { points, triangles, normals, paint: Paint::Plain(RIGID), opacity: 1.0 });
        edges.extend(edge);
    }
    // Solids are in front of what is rigid.
    let lifted = |body: &Body| {
        let lift = Vector::<3>::new(0.0, 0.0, 1e-3 * extent.max());
        Body { points: body.points.iter().map(|x| x + lift).collect(), ..body.clone() }
    };
    bodies.extend(state.solids.iter().map(lifted));
    state.draw(&mut page, &bodies, &camera, Look::Map, corners)?;
    let svg = &mut page.svg;
    clip_to(svg, camera.area);
    let at = |x: &Vector<3>| {
        let (x, y) = camera.at(x);
        format!("{x:.2} {y:.2}")
    };
    let mut path = String::new();
    for [a, b] in &edges {
        let _ = write!(path, "M{}L{}", at(a), at(b));
    }
    let _ =
        write!(svg, "<path d=\"{path}\" fill=\"none\" stroke=\"#555\" stroke-width=\"1.2\" stroke-linecap=\"round\"/>");
    let mut path = String::new();
    for outline in outlines(state.display) {
        let places: Vec<String> = outline.iter().map(|&k| at(&state.moved[k as usize])).collect();
        let _ = write!(path, "M{}", places.join("L"));
    }
    let _ =
        write!(svg, "<path d=\"{path}\" fill=\"none\" stroke=\"#222\" stroke-width=\"1\" stroke-linejoin=\"round\"/>");
    let mut path = String::new();
    for [a, b] in &state.zones {
        let _ = write!(path, "M{}L{}", at(a), at(b));
    }
    let _ = write!(
        svg,
        "<path d=\"{path}\" fill=\"none\" stroke=\"{}\" stroke-width=\"3.5\" stroke-linecap=\"round\"/></g>",
        css(FRONT)
    );
    if state.plan.space == Space::Axisymmetric && corners[0].x <= 0.0 {
        let [from, to] = [corners[0].y, corners[1].y].map(|y| at(&Vector::<3>::new(0.0, y, 0.0)));
        let _ = write!(svg, "<path d=\"M{from}L{to}\" stroke=\"#222\" stroke-dasharray=\"12 4 3 4\"/>");
    }
    state.name_bodies(&mut page, &camera);
    Ok(page.finish())
}

/// The outlines of the bodies in the plane, as chains of points of their display.
fn outlines<const D: usize>(display: &SolidDisplay<D>) -> Vec<Vec<u32>> {
    let mut once: BTreeSet<(u32, u32)> = BTreeSet::new();
    for polygon in &display.polygons {
        for k in 0..polygon.len() {
            let (a, b) = (polygon[k], polygon[(k + 1) % polygon.len()]);
            let edge = (a.min(b), a.max(b));
            if !once.remove(&edge) {
                once.insert(edge);
            }
        }
    }
    let mut beside: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &(a, b) in &once {
        beside.entry(a).or_default().push(b);
        beside.entry(b).or_default().push(a);
    }
    let mut chains = Vec::new();
    while let Some(&(first, next)) = once.iter().next() {
        once.remove(&(first, next));
        let mut chain = vec![first, next];
        while let Some(&last) = chain.last()
            && let Some(&on) = beside[&last].iter().find(|&&n| once.contains(&(last.min(n), last.max(n))))
        {
            once.remove(&(last.min(on), last.max(on)));
            chain.push(on);
        }
        chains.push(chain);
    }
    chains
}

/// Pressure along the slave side, where it is now.
pub fn profile<const D: usize>(
    name: &str,
    time: f64,
    shown: &ContactDisplay<D>,
    space: Space,
    labels: &Labels,
) -> String {
    let now: Vec<Point<D>> = shown.points.iter().zip(&shown.displacement).map(|(x, u)| x + u).collect();
    let span = |values: &mut dyn Iterator<Item = f64>| {
        values.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)))
    };
    // Along the coordinate in which the side is longest.
    let along = |k: usize| span(&mut now.iter().map(|x| x[k]));
    let axis = (0..D).max_by(|&a, &b| (along(a).1 - along(a).0).total_cmp(&(along(b).1 - along(b).0))).unwrap_or(0);
    let all = along(axis);
    let zones = zones(shown, &now, axis);
    // Around the contact, nearly half as much again on either side.
    let (low, high) = span(&mut zones.iter().flatten().map(|p| p.0));
    let range = if low <= high {
        let pad = 0.4 * (high - low).max(0.02 * (all.1 - all.0));
        ((low - pad).max(all.0), (high + pad).min(all.1))
    } else {
        all
    };
    let most = shown.pressure.iter().fold(0.0f64, |m, p| m.max(*p));
    let pressure = labels.pressure("p");
    // At a sharp edge the pressure has no bound, and would leave nothing to see of the rest.
    let top = SINGULAR * usual(&zones);
    let (top, note) = match most > top && top > 0.0 {
        true => (
            top,
            format!(
                "largest {}, beyond the chart",
                pressure.replacen('p', &label(rounded_to_three(most)), 1).replace(['[', ']'], "")
            ),
        ),
        false => (most, String::new()),
    };
    let mut page = Page::new((860.0, 520.0), &format!("Contact pressure of `{name}`, t = {}", label(time)), &note);
    let names = axis_names(space, labels);
    let (x, y) = (Axis::new(&names[axis], range), Axis::from_zero(&pressure, (0.0, top)));
    let mut panel = Panel::new(&mut page.svg, [0.0, 46.0, 860.0, 516.0], x, y);
    // Nothing is drawn where nothing touches: no contact is not a contact without pressure.
    let mut key = vec![if zones.is_empty() {
        (Sign::Line(RIGID), "no contact".to_string())
    } else {
        (Sign::Line(LINE), "pressure, in contact".to_string())
    }];
    for zone in &zones {
        panel.fill(zone, 0.0, LINE, 0.18);
        panel.line(zone, Sign::Line(LINE), 2.2);
    }
    let nodes: Vec<(f64, f64)> = (0..now.len())
        .filter(|&k| shown.active[k] && shown.pressure[k] <= top)
        .map(|k| (now[k][axis], shown.pressure[k]))
        .collect();
    if nodes.len() <= FEW {
        panel.dots(&nodes, LINE, 2.6, Dots::Full);
    }
    if let Some([friction, available]) = friction(shown, &now, axis) {
        panel.line(&available, Sign::Dashes(FRICTION), 1.4);
        panel.line(&friction, Sign::Line(FRICTION), 2.0);
        key.push((Sign::Line(FRICTION), "friction traction, magnitude".into()));
        key.push((Sign::Dashes(FRICTION), "friction limit".into()));
    }
    let rims: Vec<(f64, f64)> = shown.boundary.iter().map(|b| (b[0][axis], 0.0)).collect();
    if !rims.is_empty() {
        panel.dots(&rims, FRONT, 4.5, Dots::Full);
        key.push((Sign::Dot(FRONT), "boundary of contact".into()));
    }
    panel.key(&key);
    page.finish()
}

/// Along an axis the size of the friction of nodes in contact, and what is available of it; none without friction.
fn friction<const D: usize>(shown: &ContactDisplay<D>, now: &[Point<D>], axis: usize) -> Option<[Vec<(f64, f64)>; 2]> {
    let rubbing = shown.rubbing.as_ref()?;
    let mut nodes: Vec<usize> = (0..now.len()).filter(|&k| shown.active[k]).collect();
    nodes.sort_by(|&a, &b| now[a][axis].total_cmp(&now[b][axis]));
    let size = nodes.iter().map(|&k| (now[k][axis], rubbing[k].traction.norm())).collect();
    let limit = nodes.iter().filter(|&&k| rubbing[k].utilisation > 0.0);
    let available = limit.map(|&k| (now[k][axis], rubbing[k].traction.norm() / rubbing[k].utilisation)).collect();
    Some([size, available])
}

/// Three digits of a value.
fn rounded_to_three(v: f64) -> f64 {
    let unit = 10f64.powf(v.abs().max(f64::MIN_POSITIVE).log10().floor() - 2.0);
    (v / unit).round() * unit
}

/// The pressure that is not exceeded in nine tenths of the zones.
fn usual(zones: &[Vec<(f64, f64)>]) -> f64 {
    let mut pieces: Vec<(f64, f64)> =
        zones.iter().flat_map(|z| z.windows(2)).map(|w| (0.5 * (w[0].1 + w[1].1), w[1].0 - w[0].0)).collect();
    pieces.sort_by(|a, b| a.0.total_cmp(&b.0));
    let whole: f64 = pieces.iter().map(|p| p.1).sum();
    let mut seen = 0.0;
    let found = pieces.iter().find(|(_, length)| {
        seen += length;
        seen >= 0.9 * whole
    });
    found.map_or(0.0, |p| p.0)
}

/// Position along an axis and pressure in every zone of contact, in order, from rim to rim: nodes in contact, and the rims
/// where they are beyond the last of them, to which the pressure goes down.
fn zones<const D: usize>(shown: &ContactDisplay<D>, now: &[Point<D>], axis: usize) -> Vec<Vec<(f64, f64)>> {
    let mut nodes: Vec<(f64, f64)> =
        (0..now.len()).filter(|&k| shown.active[k]).map(|k| (now[k][axis], shown.pressure[k])).collect();
    nodes.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut pieces: Vec<[f64; 2]> = (shown.intervals.iter())
        .map(|ends| ends.each_ref().map(|x| x[axis]))
        .map(|[a, b]| [a.min(b), a.max(b)])
        .collect();
    pieces.sort_by(|a, b| a[0].total_cmp(&b[0]));
    let size = nodes.first().zip(nodes.last()).map_or(0.0, |(a, b)| b.0 - a.0);
    // Faces that meet do so to rounding.
    let near = 1e-6 * pieces.last().map_or(size, |last| (last[1] - pieces[0][0]).max(size));
    let mut joined: Vec<[f64; 2]> = Vec::new();
    for piece in pieces {
        match joined.last_mut() {
            Some(last) if piece[0] <= last[1] + near => last[1] = last[1].max(piece[1]),
            _ => joined.push(piece),
        }
    }
    if joined.is_empty() {
        return if nodes.is_empty() { Vec::new() } else { vec![nodes] };
    }
    let of_zone = |[from, to]: &[f64; 2]| {
        let within = |p: &&(f64, f64)| p.0 >= from - near && p.0 <= to + near;
        let mut line: Vec<(f64, f64)> = nodes.iter().filter(within).copied().collect();
        if line.first().is_none_or(|p| p.0 > from + near) {
            line.insert(0, (*from, 0.0));
        }
        if line.last().is_none_or(|p| p.0 < to - near) {
            line.push((*to, 0.0));
        }
        line
    };
    joined.iter().map(of_zone).collect()
}
