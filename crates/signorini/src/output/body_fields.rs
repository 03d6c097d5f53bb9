//! Fields of bodies from what they show of themselves.

use crate::fields::{FieldArray, Fields};
use crate::report::vector;
use nalgebra::Matrix3;
use signorini_fem::CellShape;
use signorini_geometry::Vector;
use signorini_material::von_mises;
use signorini_mechanics::BodyFields;
use std::collections::HashMap;

/// Names of arrays as files of fields have them.
const NAMES: [&str; 10] = [
    "tension",
    "axial_force",
    "shear_force",
    "torque",
    "bending_moment",
    "arc_length",
    "element",
    "von_mises",
    "plastic_strain",
    "temperature",
];
/// What solids call their stress, and what files of fields do.
pub(super) const STRESS: [&str; 2] = ["stress", "stress_xx_yy_zz_xy_yz_xz"];
/// Points closer than this part of the size of a body are one.
const SAME: f64 = 1e-8;

/// The fields of a body.
pub(super) fn of_body(name: &str, fields: &BodyFields) -> Fields {
    let mut out = Fields {
        name: name.into(),
        points: fields.points.iter().map(vector).collect(),
        cells: fields.cells.iter().map(|c| cell(c)).collect(),
        arrays: Vec::new(),
    }
    .vector("displacement", fields.displacement.iter().flat_map(vector).collect());
    let known = |name: &str| if name == STRESS[0] { Some(STRESS[1]) } else { NAMES.into_iter().find(|n| *n == name) };
    for (name, components, values) in &fields.point_data {
        if let Some(name) = known(name) {
            out.arrays.push(FieldArray { name, components: *components, values: values.clone() });
        }
    }
    for (name, components, values) in &fields.cell_data {
        let Some(name) = known(name) else { continue };
        out.arrays.push(FieldArray { name, components: *components, values: at_points(fields, *components, values) });
    }
    out
}

/// Values of cells as means of those around each point.
fn at_points(fields: &BodyFields, components: usize, values: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0; fields.points.len() * components];
    let mut counts = vec![0.0f64; fields.points.len()];
    for (cell, own) in fields.cells.iter().zip(values.chunks(components)) {
        for &p in cell {
            counts[p as usize] += 1.0;
            own.iter().enumerate().for_each(|(k, v)| sums[p as usize * components + k] += v);
        }
    }
    sums.iter().enumerate().map(|(k, s)| s / counts[k / components].max(1.0)).collect()
}

/// The shape of a cell and its corners; tetrahedra and wedges come as hexahedra with corners that coincide.
fn cell(corners: &[u32]) -> (Option<CellShape>, Vec<u32>) {
    match *corners {
        [_, _] => (Some(CellShape::Line), corners.to_vec()),
        [_, _, _] => (Some(CellShape::Triangle), corners.to_vec()),
        [_, _, _, _] => (Some(CellShape::Quadrilateral), corners.to_vec()),
        [a, b, c, c2, d, d2, d3, d4] if c == c2 && d == d2 && d == d3 && d == d4 => {
            (Some(CellShape::Tetrahedron), vec![a, b, c, d])
        }
        [a, b, c, c2, d, e, f, f2] if c == c2 && f == f2 => (Some(CellShape::Wedge), vec![a, b, c, d, e, f]),
        [_, _, _, _, _, _, _, _] => (Some(CellShape::Hexahedron), corners.to_vec()),
        _ => (None, corners.to_vec()),
    }
}

/// The fields of a solid, whose cells have points of their own: those that are in one place and stay together become one,
/// with the mean of the stresses there.
pub(super) fn of_solid(name: &str, fields: &BodyFields) -> Fields {
    let size = fields.points.iter().map(|x| x.amax()).fold(f64::MIN_POSITIVE, f64::max);
    let rounded = |x: &Vector<3>| x.map(|v| (v / (SAME * size)).round() as i64);
    let mut numbers: HashMap<[Vector3i; 2], u32> = HashMap::new();
    let mut out = BodyFields::default();
    let mut number_of = Vec::with_capacity(fields.points.len());
    for (x, u) in fields.points.iter().zip(&fields.displacement) {
        let number = *numbers.entry([rounded(x).into(), rounded(u).into()]).or_insert_with(|| {
            out.points.push(*x);
            out.displacement.push(*u);
            out.points.len() as u32 - 1
        });
        number_of.push(number as usize);
    }
    out.cells = fields.cells.iter().map(|c| c.iter().map(|&k| number_of[k as usize] as u32).collect()).collect();
    let mut stresses = None;
    for (name, components, values) in &fields.point_data {
        let mean = means(&number_of, out.points.len(), *components, values);
        if name == STRESS[0] {
            stresses = Some(mean.clone());
        }
        out.point_data.push((name.clone(), *components, mean));
    }
    if let Some(stresses) = stresses
        && let Some(own) = out.point_data.iter_mut().find(|d| d.0 == "von_mises")
    {
        own.2 = stresses.chunks(6).map(|s| von_mises(&tensor(s))).collect();
    }
    out.cell_data.clone_from(&fields.cell_data);
    of_body(name, &out)
}

/// Coordinates in units of what tells points apart.
type Vector3i = [i64; 3];

/// A symmetric tensor of its components xx, yy, zz, xy, yz, xz.
fn tensor(s: &[f64]) -> Matrix3<f64> {
    Matrix3::new(s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2])
}

/// The mean of values that have become one.
fn means(number_of: &[usize], count: usize, components: usize, values: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0; count * components];
    let mut counts = vec![0.0f64; count];
    for (number, own) in number_of.iter().zip(values.chunks(components)) {
        counts[*number] += 1.0;
        own.iter().enumerate().for_each(|(k, v)| sums[number * components + k] += v);
    }
    sums.iter().enumerate().map(|(k, s)| s / counts[k / components]).collect()
}
