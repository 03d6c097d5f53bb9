//! Loads: forces on sides and in volumes.

use crate::body::Bodies;
use crate::stiffness::Table;
use signorini_contact::ContactSurface;
use signorini_fem::Group;
use signorini_fem::rules::rule;
use signorini_fem::small::determinant;
use signorini_geometry::Point;
use std::collections::HashMap;

/// What a load is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LoadKind {
    /// Force per area, in a fixed direction.
    Traction,
    /// Force per area against the outward normal; the first component counts.
    Pressure,
    /// Resultant, spread evenly over the area.
    Force,
    /// Force per volume.
    BodyForce,
}

/// A load on a group of a body.
#[derive(Clone, Debug)]
pub struct Load {
    pub name: String,
    pub body: usize,
    pub group: Group,
    pub kind: LoadKind,
}

/// The forces of a load on the unknowns of all bodies.
#[inline(never)]
pub fn forces<const D: usize>(bodies: &Bodies<D>, load: &Load, value: &dyn Fn(&Point<D>) -> Point<D>) -> Vec<f64> {
    let mut out = vec![0.0; bodies.unknowns()];
    if load.kind == LoadKind::BodyForce {
        volume(bodies, load, value, &mut out);
        return out;
    }
    let surface = bodies.surface(load.body, load.group.sides.clone());
    let degree = bodies.list[load.body].degree;
    let mut trace = Vec::new();
    let mut area = 0.0;
    for face in 0..surface.sides.len() {
        for (s, w) in rule(surface.shape(face), degree + 3) {
            let point = surface.at(face, &s);
            let normal = point.area_normal();
            let w = w * surface.measure(&point.x);
            area += w * normal.norm();
            let given = value(&point.x);
            let force = match load.kind {
                LoadKind::Pressure => normal * (-given[0] * w),
                _ => given * (normal.norm() * w),
            };
            trace.clear();
            surface.trace(face, &s, &mut trace);
            for (unknown, v) in &trace {
                for i in 0..D {
                    out[*unknown as usize + i] += v * force[i];
                }
            }
        }
    }
    if load.kind == LoadKind::Force && area > 0.0 {
        out.iter_mut().for_each(|f| *f /= area);
    }
    out
}

fn volume<const D: usize>(bodies: &Bodies<D>, load: &Load, value: &dyn Fn(&Point<D>) -> Point<D>, out: &mut [f64]) {
    let body = &bodies.list[load.body];
    let mut tables: HashMap<(usize, usize), Table> = HashMap::new();
    for &cell in &load.group.cells {
        let cell = cell as usize;
        let table = tables
            .entry((body.mesh.map_number(cell), body.dofs.basis_number(cell)))
            .or_insert_with(|| Table::new(&body.mesh, &body.dofs, cell));
        for (q, (_, w)) in table.points.iter().enumerate() {
            let (x, jacobian) = body.mesh.jacobian(cell, &table.map[q]);
            let force = value(&x) * (w * determinant(&jacobian) * bodies.measure(&x));
            for ((f, sign), v) in body.dofs.cell(cell).zip(&table.basis[q].value) {
                for i in 0..D {
                    out[body.first + f as usize * D + i] += sign * v * force[i];
                }
            }
        }
    }
}

/// The sum of forces on the unknowns of the bodies: those of the vertex functions, which add up to one.
#[inline(never)]
pub fn resultant<const D: usize>(bodies: &Bodies<D>, forces: &[f64]) -> Point<D> {
    bodies.list.iter().map(|body| body.resultant(forces)).sum()
}
