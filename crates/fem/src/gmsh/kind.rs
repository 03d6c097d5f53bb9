//! The types of elements of Gmsh, and the order of their nodes.

use super::error::GmshError;
use crate::cell_map::CellMap;
use crate::reference::{CellShape, Local};
use signorini_geometry::Point;
use std::collections::HashMap;

/// A type of element.
pub(super) struct Kind {
    /// `None` for a point.
    pub(super) shape: Option<CellShape>,
    pub(super) order: usize,
    /// Vertices between which the nodes after the vertices lie, in the order of Gmsh.
    between: &'static [&'static [usize]],
}

const HEX_EDGES: [&[usize]; 12] =
    [&[0, 1], &[0, 3], &[0, 4], &[1, 2], &[1, 5], &[2, 3], &[2, 6], &[3, 7], &[4, 5], &[4, 7], &[5, 6], &[6, 7]];

const HEX_27: [&[usize]; 19] = [
    HEX_EDGES[0],
    HEX_EDGES[1],
    HEX_EDGES[2],
    HEX_EDGES[3],
    HEX_EDGES[4],
    HEX_EDGES[5],
    HEX_EDGES[6],
    HEX_EDGES[7],
    HEX_EDGES[8],
    HEX_EDGES[9],
    HEX_EDGES[10],
    HEX_EDGES[11],
    &[0, 3, 2, 1],
    &[0, 1, 5, 4],
    &[0, 4, 7, 3],
    &[1, 2, 6, 5],
    &[2, 3, 7, 6],
    &[4, 5, 6, 7],
    &[0, 1, 2, 3, 4, 5, 6, 7],
];

const WEDGE_18: [&[usize]; 12] = [
    &[0, 1],
    &[0, 2],
    &[0, 3],
    &[1, 2],
    &[1, 4],
    &[2, 5],
    &[3, 4],
    &[3, 5],
    &[4, 5],
    &[0, 1, 4, 3],
    &[0, 2, 5, 3],
    &[1, 2, 5, 4],
];

const QUAD_9: [&[usize]; 5] = [&[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 1, 2, 3]];

const TETRAHEDRON_10: [&[usize]; 6] = [&[0, 1], &[1, 2], &[2, 0], &[3, 0], &[2, 3], &[1, 3]];

pub(super) fn kind(number: i64) -> Option<Kind> {
    use CellShape::*;
    let make = |shape, order, between| Some(Kind { shape: Some(shape), order, between });
    match number {
        1 => make(Line, 1, &[]),
        2 => make(Triangle, 1, &[]),
        3 => make(Quadrilateral, 1, &[]),
        4 => make(Tetrahedron, 1, &[]),
        5 => make(Hexahedron, 1, &[]),
        6 => make(Wedge, 1, &[]),
        8 => make(Line, 2, &QUAD_9[..1]),
        9 => make(Triangle, 2, &[&[0, 1], &[1, 2], &[2, 0]]),
        10 => make(Quadrilateral, 2, &QUAD_9),
        11 => make(Tetrahedron, 2, &TETRAHEDRON_10),
        12 => make(Hexahedron, 2, &HEX_27),
        13 => make(Wedge, 2, &WEDGE_18),
        15 => Some(Kind { shape: None, order: 1, between: &[] }),
        16 => make(Quadrilateral, 2, &QUAD_9[..4]),
        17 => make(Hexahedron, 2, &HEX_27[..12]),
        18 => make(Wedge, 2, &WEDGE_18[..9]),
        _ => None,
    }
}

pub(super) fn node_count(element: u64, number: i64) -> Result<usize, GmshError> {
    match kind(number) {
        Some(kind) => Ok(kind.vertices() + kind.between.len()),
        None => {
            let what = match number {
                7 | 14 | 19 => "pyramid".to_string(),
                other => format!("cell of type {other}"),
            };
            Err(GmshError::Element { element, what })
        }
    }
}

impl Kind {
    pub(super) fn vertices(&self) -> usize {
        self.shape.map_or(1, |s| s.vertices().len())
    }

    /// The nodes in the order of [`CellMap`]; those that serendipity cells lack are made.
    pub(super) fn arrange<const D: usize>(
        &self,
        shape: CellShape,
        given: &[u32],
        positions: &mut Vec<Point<D>>,
        added: &mut HashMap<Vec<u32>, u32>,
    ) -> Vec<u32> {
        let corners = shape.vertices();
        let middle = |between: &[usize]| -> Local {
            std::array::from_fn(|k| between.iter().map(|&v| corners[v][k]).sum::<f64>() / between.len() as f64)
        };
        let places: Vec<Local> = corners.iter().copied().chain(self.between.iter().map(|b| middle(b))).collect();
        CellMap::new(shape, self.order)
            .nodes()
            .iter()
            .map(|x| {
                if let Some(k) = places.iter().position(|p| close(p, x)) {
                    return given[k];
                }
                // The corners of the side or cell in whose middle the node lies.
                let around: Vec<usize> = (0..corners.len())
                    .filter(|&v| shape == CellShape::Hexahedron && close(x, &[0.0; 3]) || on_common_side(shape, v, x))
                    .collect();
                let mut key: Vec<u32> = around.iter().map(|&v| given[v]).collect();
                key.sort_unstable();
                if let Some(&node) = added.get(&key) {
                    return node;
                }
                let of_edges = if around.len() == 8 { 0.25 } else { 0.5 };
                let mut position = Point::<D>::zeros();
                for &v in &around {
                    position -= positions[given[v] as usize] * 0.25;
                }
                for (k, between) in self.between.iter().enumerate() {
                    if between.iter().all(|v| around.contains(v)) {
                        position += positions[given[corners.len() + k] as usize] * of_edges;
                    }
                }
                positions.push(position);
                let node = positions.len() as u32 - 1;
                added.insert(key, node);
                node
            })
            .collect()
    }
}

/// Whether a vertex belongs to the quadrilateral (a side, or the cell itself) whose middle is `x`.
fn on_common_side(shape: CellShape, vertex: usize, x: &Local) -> bool {
    if shape == CellShape::Quadrilateral {
        return true;
    }
    shape.sides().iter().any(|corners| {
        let centre: Local = std::array::from_fn(|k| {
            corners.iter().map(|&v| shape.vertices()[v][k]).sum::<f64>() / corners.len() as f64
        });
        corners.len() == 4 && close(&centre, x) && corners.contains(&vertex)
    })
}

pub(super) fn close(p: &Local, q: &Local) -> bool {
    (0..3).all(|k| (p[k] - q[k]).abs() < 1e-9)
}
