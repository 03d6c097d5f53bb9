//! The functions and vertices of a group, and its normal.

use super::direction::axis;
use super::statement::{Support, SupportError};
use crate::body::Bodies;
use signorini_contact::ContactSurface;
use signorini_geometry::Point;
use std::collections::BTreeSet;

pub(super) fn global<const D: usize>(bodies: &Bodies<D>, body: usize, function: u32) -> u32 {
    (bodies.list[body].first / D) as u32 + function
}

/// Where a function sits, for messages.
pub(super) fn place<const D: usize>(bodies: &Bodies<D>, f: u32) -> String {
    for body in &bodies.list {
        let first = (body.first / D) as u32;
        if f >= first && f < first + body.dofs.count() as u32 {
            let node = (0..body.mesh.nodes().len() as u32).find(|v| body.dofs.vertex(*v) == Some(f - first));
            if let Some(node) = node {
                let x = &body.mesh.nodes()[node as usize];
                let list: Vec<String> = x.iter().map(|v| format!("{v:.6}")).collect();
                return format!("({}) of `{}`", list.join(", "), body.name);
            }
            return format!("on an edge of `{}`", body.name);
        }
    }
    String::new()
}

/// Vertices of a support's group.
pub(super) fn vertices<const D: usize>(bodies: &Bodies<D>, support: &Support) -> BTreeSet<u32> {
    let mesh = &bodies.list[support.body].mesh;
    let mut out: BTreeSet<u32> = support.group.vertices.iter().copied().collect();
    for side in &support.group.sides {
        out.extend(mesh.side_vertices(*side));
    }
    for &cell in &support.group.cells {
        out.extend(mesh.vertices(cell as usize));
    }
    out
}

/// All functions of a support's group.
pub(crate) fn functions<const D: usize>(bodies: &Bodies<D>, support: &Support) -> BTreeSet<u32> {
    let body = &bodies.list[support.body];
    let mut out = BTreeSet::new();
    let mut add = |f: u32| out.insert(global(bodies, support.body, f));
    for v in &support.group.vertices {
        body.dofs.vertex(*v).map(&mut add);
    }
    for side in &support.group.sides {
        let list = body.dofs.functions(side.cell as usize);
        for k in body.dofs.on_side(*side) {
            add(list[k]);
        }
    }
    for &cell in &support.group.cells {
        for f in body.dofs.functions(cell as usize) {
            add(*f);
        }
    }
    out
}

/// The outward normal that all sides of a group share.
pub(super) fn common_normal<const D: usize>(bodies: &Bodies<D>, support: &Support) -> Result<Point<D>, SupportError> {
    let surface = bodies.surface(support.body, support.group.sides.clone());
    let mut normals: Vec<Point<D>> = Vec::new();
    for face in 0..surface.sides.len() {
        let shape = surface.shape(face);
        for s in shape.vertices().iter().copied().chain([shape.centre()]) {
            normals.push(surface.at(face, &s).area_normal().normalize());
        }
    }
    let mean = normals.iter().sum::<Point<D>>().normalize();
    let worst = normals.iter().map(|n| (n - mean).norm()).fold(0.0, f64::max);
    if normals.is_empty() || worst.is_nan() || worst > 1e-6 {
        return Err(SupportError::NotFlat { support: support.name.clone(), degrees: worst.to_degrees() });
    }
    // Normals along an axis are that axis exactly.
    let largest = mean.iamax();
    Ok(if mean[largest].abs() > 1.0 - 1e-12 { axis::<D>(largest) * mean[largest].signum() } else { mean })
}
