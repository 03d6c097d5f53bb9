//! Bodies of a system as they are drawn: tubes about ropes and beams, surfaces of solids, rigid bodies.

use super::colours::{FREE, RIGID};
use super::level::{CUBES, OF_HEXAHEDRON};
use super::page::Scale;
use super::render::{Body, Paint};
use super::system::{CurveShown, RigidShown, SystemShown, moved};
use super::tube::tube;
use crate::fields::Fields;
use signorini_fem::CellShape;
use signorini_geometry::Vector;
use std::collections::BTreeMap;

/// Curves are drawn at least so thick, as a part of the extent of the picture.
const THIN: f64 = 0.006;
/// How much a rigid body hides of what is behind it: those around curves are seen through a little, those around solids more.
const VEIL: f64 = 0.75;
const THIN_VEIL: f64 = 0.4;

/// What the colours tell: the axial force of curves, from zero on; without curves, the equivalent stress or the temperature of solids.
pub fn scale_of(shown: &SystemShown) -> Scale {
    if shown.curves.is_empty() {
        let all = shown.solids().flat_map(|b| b.array(shown.painted).unwrap_or_default().to_vec());
        let all: Vec<f64> = all.collect();
        // Temperatures have no zero that matters.
        let (low, high) = all.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(*v), h.max(*v)));
        return match shown.painted {
            "temperature" if low <= high => Scale::between(low, high, 0.0),
            _ => Scale::of(&all),
        };
    }
    let forces = shown.curves.iter().flat_map(|c| c.forces.iter().copied());
    let (low, high) = forces.fold((0.0f64, 0.0f64), |(low, high), f| (low.min(f), high.max(f)));
    if low == 0.0 && high == 0.0 { Scale::chosen([0.0; 2], [0.0; 2]) } else { Scale::between(low, high, 0.0) }
}

/// The axial force at the points of a curve: the mean of its cells there.
fn at_points(curve: &CurveShown) -> Vec<f64> {
    let mut sums = vec![(0.0, 0.0f64); curve.points.len()];
    for (cell, force) in curve.cells.iter().zip(&curve.forces) {
        for end in cell {
            let own = &mut sums[*end as usize];
            *own = (own.0 + force, own.1 + 1.0);
        }
    }
    sums.into_iter().map(|(sum, count)| sum / count.max(1.0)).collect()
}

/// The corners of the sides of a cell in space, seen from outside counter-clockwise.
fn sides(shape: Option<CellShape>) -> &'static [&'static [usize]] {
    match shape {
        Some(CellShape::Hexahedron) => {
            &[&[0, 3, 2, 1], &[4, 5, 6, 7], &[0, 1, 5, 4], &[1, 2, 6, 5], &[2, 3, 7, 6], &[3, 0, 4, 7]]
        }
        Some(CellShape::Wedge) => &[&[0, 2, 1], &[3, 4, 5], &[0, 1, 4, 3], &[1, 2, 5, 4], &[2, 0, 3, 5]],
        Some(CellShape::Tetrahedron) => &[&[0, 2, 1], &[0, 1, 3], &[1, 2, 3], &[2, 0, 3]],
        _ => &[],
    }
}

/// The surface of a solid where it is: its cells in the plane, and in space the sides of cells that no other cell has.
fn solid(fields: &Fields, paint: Paint) -> Body {
    let mut polygons: Vec<Vec<u32>> = Vec::new();
    let mut once: BTreeMap<Vec<u32>, Option<Vec<u32>>> = BTreeMap::new();
    for (shape, cell) in &fields.cells {
        let sides = sides(*shape);
        if sides.is_empty() {
            polygons.push(cell.clone());
        }
        for side in sides {
            let list: Vec<u32> = side.iter().map(|k| cell[*k]).collect();
            let mut key = list.clone();
            key.sort_unstable();
            once.entry(key).and_modify(|found| *found = None).or_insert(Some(list));
        }
    }
    polygons.extend(once.into_values().flatten());
    Body::of_polygons(moved(fields), polygons.iter().map(Vec::as_slice), paint)
}

/// The cells of a solid in space as tetrahedra.
pub fn tetrahedra(fields: &Fields) -> impl Iterator<Item = [u32; 4]> {
    const OF_TETRAHEDRON: [[usize; 4]; 1] = [[0, 1, 2, 3]];
    const OF_WEDGE: [[usize; 4]; 3] = [[0, 1, 2, 5], [0, 1, 5, 4], [0, 4, 5, 3]];
    fields.cells.iter().flat_map(|(shape, list)| {
        let parts: &[[usize; 4]] = match shape {
            Some(CellShape::Hexahedron) => &OF_HEXAHEDRON,
            Some(CellShape::Wedge) => &OF_WEDGE,
            Some(CellShape::Tetrahedron) => &OF_TETRAHEDRON,
            _ => &[],
        };
        parts.iter().map(|part| part.map(|k| list[k]))
    })
}

/// Ropes and beams.
fn curves(shown: &SystemShown, scale: &Scale) -> Vec<Body> {
    let [low, high] = shown.bounds();
    let thin = THIN * (high - low).max();
    let curve = |c: &CurveShown| {
        let colours = || at_points(c).iter().map(|f| scale.place(*f)).collect();
        let paint = if scale.is_empty() { Paint::Plain(FREE) } else { Paint::Field(colours()) };
        tube(&c.points, &c.cells, c.radius.max(thin), paint)
    };
    shown.curves.iter().map(curve).collect()
}

/// The solids, coloured by their stress where nothing else is coloured.
pub fn solids(shown: &SystemShown, scale: &Scale) -> Vec<Body> {
    let paint =
        |fields: &Fields| match fields.array(shown.painted).filter(|_| shown.curves.is_empty() && !scale.is_empty()) {
            Some(values) => Paint::Field(values.iter().map(|v| scale.place(*v)).collect()),
            None => Paint::Plain(FREE),
        };
    shown.solids().map(|fields| solid(fields, paint(fields))).collect()
}

/// The surfaces of rigid bodies in space, within a box.
pub fn rigid(shown: &SystemShown, room: [Vector<3>; 2]) -> Vec<Body> {
    let veil = if shown.is_of_solids() { THIN_VEIL } else { VEIL };
    let sheet = |body: &RigidShown| {
        let (points, normals, triangles) = body.surface(room, CUBES);
        let opacity = if body.is_free { 1.0 } else { veil };
        Body { points, triangles, normals, paint: Paint::Plain(RIGID), opacity }
    };
    shown.rigid.iter().map(sheet).collect()
}

/// The bodies that deform.
pub fn deformable(shown: &SystemShown, scale: &Scale) -> Vec<Body> {
    curves(shown, scale).into_iter().chain(solids(shown, scale)).collect()
}
