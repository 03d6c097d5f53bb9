//! What pictures of systems in the plane have of their own: rigid bodies as regions, outlines of solids, what touches, the
//! axis of rotation.

use super::OutputError;
use super::camera::{Camera, bounds};
use super::colours::{EDGE, FRONT, RIGID};
use super::level::region;
use super::outline::outlines;
use super::page::css;
use super::render::{Body, Look, Paint, insert};
use super::system::{AROUND, SystemShown, moved};
use super::system_bodies::deformable;
use super::system_scene::View;
use crate::problem::Space;
use plotters::style::RGBColor;
use signorini_geometry::Vector;
use std::fmt::Write as _;

/// What is seen around solids, as a part of their largest extent.
const AROUND_SOLIDS: f64 = 0.06;
/// A window that shows the zone of contact is larger by this part of it on every side; where it would be more than this
/// part of the whole there is none.
const WINDOW: f64 = 0.8;
const SMALL: f64 = 0.25;
/// Bodies that deform are in front of those that are rigid, by this part of the picture.
const LIFT: f64 = 1e-3;

fn flat(x: Vector<3>) -> Vector<3> {
    Vector::<3>::new(x.x, x.y, 0.0)
}

/// What of the plane a picture of the bodies shows.
pub fn frame(view: &mut View, space: Space, shown: &SystemShown) {
    let [low, high] = view.axes.map(flat);
    let around = if shown.is_of_solids() { AROUND_SOLIDS } else { AROUND };
    let pad = Vector::<3>::new(1.0, 1.0, 0.0) * (around * (high - low).max());
    let mut from = low - pad;
    if space == Space::Axisymmetric {
        // There is nothing beyond the axis.
        from.x = from.x.max(0.0_f64.min(low.x));
    }
    let room = [from, high + pad];
    (view.points, view.room, view.is_part) = (room.to_vec(), room, true);
    if shown.is_of_solids() {
        (view.axes, view.look) = (room, Look::Map);
    }
}

/// The surroundings of surfaces in contact, where they are small.
pub fn window(shown: &SystemShown) -> Option<[Vector<3>; 2]> {
    if shown.zones.is_empty() {
        return None;
    }
    let [low, high] = bounds(shown.zones.iter().flatten());
    let [from, to] = shown.bounds();
    let size = (high - low).max();
    let square = |share: f64| Vector::<3>::new(size, size, 0.0) * share;
    // Not far beyond the bodies.
    let corners = [
        (low - square(WINDOW)).sup(&(from - square(AROUND_SOLIDS))),
        (high + square(WINDOW)).inf(&(to + square(AROUND_SOLIDS))),
    ];
    (size > 0.0 && (1.0 + 2.0 * WINDOW) * size < SMALL * (to - from).max()).then_some(corners.map(flat))
}

/// Draws all bodies, and where surfaces touch.
///
/// # Errors
/// A raster without area.
pub fn draw(svg: &mut String, shown: &SystemShown, view: &View, camera: &Camera) -> Result<(), OutputError> {
    let (mut bodies, mut edges) = (Vec::new(), Vec::new());
    for rigid in &shown.rigid {
        let (triangles, edge) = region(rigid.gap.as_ref(), view.room);
        bodies.push(filled(triangles));
        edges.extend(edge);
    }
    let lift = Vector::<3>::z() * (LIFT * (view.room[1] - view.room[0]).max());
    let lifted = |body: Body| Body { points: body.points.iter().map(|x| x + lift).collect(), ..body };
    bodies.extend(deformable(shown, &view.scale).into_iter().map(lifted));
    insert(svg, &bodies, camera, view.look)?;
    path(svg, camera, edges.iter().map(|ends| ends.to_vec()), (EDGE, 1.2));
    for fields in shown.solids() {
        let now = moved(fields);
        let chain = |list: Vec<u32>| list.iter().map(|&k| now[k as usize]).collect();
        path(svg, camera, outlines(fields).into_iter().map(chain), (RGBColor(34, 34, 34), 1.0));
    }
    path(svg, camera, shown.zones.iter().map(|ends| ends.to_vec()), (FRONT, 3.5));
    Ok(())
}

/// What is inside a rigid body.
fn filled(triangles: Vec<[Vector<3>; 3]>) -> Body {
    let points: Vec<Vector<3>> = triangles.into_iter().flatten().collect();
    let triangles: Vec<[u32; 3]> = (0..points.len() as u32 / 3).map(|k| [3 * k, 3 * k + 1, 3 * k + 2]).collect();
    let normals = vec![[Vector::<3>::z(); 3]; triangles.len()];
    Body { points, triangles, normals, paint: Paint::Plain(RIGID), opacity: 1.0 }
}

/// Lines of one colour and width.
fn path(
    svg: &mut String,
    camera: &Camera,
    chains: impl Iterator<Item = Vec<Vector<3>>>,
    (colour, width): (RGBColor, f64),
) {
    let mut path = String::new();
    for chain in chains {
        let places = chain.iter().map(|x| camera.at(x)).map(|(x, y)| format!("{x:.2} {y:.2}"));
        let _ = write!(path, "M{}", places.collect::<Vec<_>>().join("L"));
    }
    let _ = write!(
        svg,
        "<path d=\"{path}\" fill=\"none\" stroke=\"{}\" stroke-width=\"{width}\" stroke-linecap=\"round\" \
         stroke-linejoin=\"round\"/>",
        css(colour)
    );
}

/// The axis of rotation, where the picture has it.
pub fn axis_of_rotation(svg: &mut String, [low, high]: [Vector<3>; 2], camera: &Camera) {
    if low.x > 0.0 {
        return;
    }
    let [(x, from), (_, to)] = [low.y, high.y].map(|y| camera.at(&Vector::<3>::new(0.0, y, 0.0)));
    let _ = write!(svg, "<path d=\"M{x:.2} {from:.2}V{to:.2}\" stroke=\"#222\" stroke-dasharray=\"12 4 3 4\"/>");
}
