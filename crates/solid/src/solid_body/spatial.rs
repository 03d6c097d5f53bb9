//! Positions and directions in space, and how deep cells are.

use crate::body::Bodies;
use signorini_fem::CellShape;
use signorini_geometry::{Point, Vector};

/// A position or direction in space.
pub fn spatial<const D: usize>(x: &Point<D>) -> Vector<3> {
    Vector::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 })
}

/// How far into a cell the force on a side of it reaches: its volume over the area of the side.
pub fn depth<const D: usize>(bodies: &Bodies<D>, side: signorini_fem::Side) -> f64 {
    use signorini_fem::rules::rule;
    use signorini_fem::small::determinant;
    let mesh = &bodies.list[0].mesh;
    let cell = side.cell as usize;
    let map = mesh.map(cell);
    let mut at = signorini_fem::hierarchic::Values::default();
    let volume: f64 = (rule(map.shape(), map.order() + 1).iter())
        .map(|(x, w)| {
            map.tabulate(x, &mut at);
            w * determinant(&mesh.jacobian(cell, &at).1)
        })
        .sum();
    let shape: CellShape = mesh.side_shape(side);
    let area: f64 = (rule(shape, map.order() + 1).iter())
        .map(|(s, w)| {
            let (x, tangents) = mesh.on_side(side, s);
            w * signorini_contact::FacePoint { x, tangents }.area_normal().norm()
        })
        .sum();
    volume / area
}
