//! Built-in meshes of boxes: quadrilaterals and hexahedra, graded and mapped.

use super::mesh::{Mesh, Side};
use super::reference::CellShape;
use signorini_geometry::{Aabb, Point};

/// The positions of the cell boundaries along each direction.
pub type Axes<const D: usize> = [Vec<f64>; D];

/// Cell boundaries of a stretch of an axis, without its start: `cells` cells of which each is `growth` times as long as
/// the one before.
pub fn graded(from: f64, to: f64, cells: usize, growth: f64) -> Vec<f64> {
    let weights: Vec<f64> = (0..cells).map(|k| growth.powi(k as i32)).collect();
    let total: f64 = weights.iter().sum();
    let mut sum = 0.0;
    (weights.iter().enumerate())
        .map(|(k, w)| {
            sum += w;
            if k + 1 == cells { to } else { from + (to - from) * sum / total }
        })
        .collect()
}

/// Names of the sides, low and high along each direction.
pub fn side_names(dimension: usize) -> &'static [[&'static str; 2]] {
    if dimension == 2 {
        &[["left", "right"], ["bottom", "top"]]
    } else {
        &[["left", "right"], ["front", "back"], ["bottom", "top"]]
    }
}

/// A box of cells of the given order with groups for its sides and the whole `boundary`; `map` moves every node. Opposite sides
/// that come to lie on each other node by node are joined and are no sides any more: a ring is closed.
pub fn block<const D: usize>(axes: &Axes<D>, order: usize, mut map: impl FnMut(Point<D>) -> Point<D>) -> Mesh<D> {
    let shape = if D == 2 { CellShape::Quadrilateral } else { CellShape::Hexahedron };
    let line = super::lagrange::gauss_lobatto(order);
    // Node positions along each direction.
    let positions: [Vec<f64>; D] = std::array::from_fn(|k| {
        let axis = &axes[k];
        let mut out = vec![axis[0]];
        for pair in axis.windows(2) {
            for t in &line[1..] {
                out.push(if *t == 1.0 { pair[1] } else { pair[0] + (pair[1] - pair[0]) * t });
            }
        }
        out
    });
    let counts: [usize; D] = std::array::from_fn(|k| positions[k].len());
    let total: usize = counts.iter().product();
    let nodes = (0..total)
        .map(|mut i| {
            map(Point::<D>::from_fn(|k, _| {
                let at = i % counts[k];
                i /= counts[k];
                positions[k][at]
            }))
        })
        .collect();
    let cells: [usize; D] = std::array::from_fn(|k| axes[k].len() - 1);
    let (nodes, number_of, closed) = joined(nodes, &counts, &cells);
    let mut mesh = Mesh::new(nodes);
    let per_cell = (order + 1).pow(D as u32);
    for number in 0..cells.iter().product() {
        let mut rest = number;
        let index: [usize; D] = std::array::from_fn(|k| {
            let at = rest % cells[k];
            rest /= cells[k];
            at
        });
        let list: Vec<u32> = (0..per_cell)
            .map(|mut i| {
                let mut stride = 1;
                let mut node = 0;
                for k in 0..D {
                    node += (index[k] * order + i % (order + 1)) * stride;
                    i /= order + 1;
                    stride *= counts[k];
                }
                number_of[node]
            })
            .collect();
        let cell = mesh.add_cell(shape, order, &list);
        for k in (0..D).filter(|k| !closed[*k]) {
            for high in 0..2 {
                if index[k] != if high == 0 { 0 } else { cells[k] - 1 } {
                    continue;
                }
                let side = Side { cell, side: side_of(shape, k, high) };
                mesh.group_mut(side_names(D)[k][high]).sides.push(side);
                mesh.group_mut("boundary").sides.push(side);
            }
        }
    }
    mesh
}

/// Distance of two nodes relative to the size of the mesh at which they are one.
const SAME: f64 = 1e-10;

/// Nodes without those of the high sides that lie on their partners of the low ones, the number that each node of the grid
/// then has, and the directions in which the mesh closes.
fn joined<const D: usize>(
    nodes: Vec<Point<D>>,
    counts: &[usize; D],
    cells: &[usize; D],
) -> (Vec<Point<D>>, Vec<u32>, [bool; D]) {
    let strides: [usize; D] = std::array::from_fn(|k| counts[..k].iter().product());
    let place = |node: usize, k: usize| node / strides[k] % counts[k];
    let Some(bounds) = Aabb::around(nodes.iter().copied()) else { return (nodes, Vec::new(), [false; D]) };
    let near = SAME * bounds.size().norm();
    // A side that shrinks to a point lies on everything.
    let closed: [bool; D] = std::array::from_fn(|k| {
        let mut pairs = (0..nodes.len()).filter(|n| place(*n, k) == 0).map(|n| [n, n + (counts[k] - 1) * strides[k]]);
        cells[k] > 2 && pairs.all(|[a, b]| (nodes[a] - nodes[b]).norm() <= near)
    });
    let mut kept = Vec::with_capacity(nodes.len());
    let mut number_of = vec![0; nodes.len()];
    for n in 0..nodes.len() {
        let partner =
            (0..D).filter(|k| closed[*k] && place(n, *k) == counts[*k] - 1).map(|k| (counts[k] - 1) * strides[k]);
        match n - partner.sum::<usize>() {
            own if own == n => {
                number_of[n] = kept.len() as u32;
                kept.push(nodes[n]);
            }
            // It comes first.
            partner => number_of[n] = number_of[partner],
        }
    }
    (kept, number_of, closed)
}

/// The side of a tensor cell low or high in one direction.
fn side_of(shape: CellShape, axis: usize, high: usize) -> u8 {
    let target = if high == 0 { -1.0 } else { 1.0 };
    let on = |corners: &&[usize]| corners.iter().all(|&v| shape.vertices()[v][axis] == target);
    shape.sides().iter().position(on).unwrap_or(0) as u8
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn boxes_have_their_sides_and_their_boundary() {
        let axes = [graded(0.0, 2.0, 3, 1.5), graded(0.0, 1.0, 2, 1.0), graded(-1.0, 1.0, 2, 0.5)].map(|mut a| {
            a.insert(0, if a.len() == 3 { 0.0 } else { a[0] - 0.25 });
            a
        });
        for order in 1..4 {
            let mesh = block::<3>(&axes, order, |x| x);
            mesh.check().unwrap();
            assert_eq!(mesh.cell_count(), 12);
            let mut sides = mesh.groups()["boundary"].sides.clone();
            sides.sort_unstable();
            assert_eq!(sides, mesh.boundary());
            for side in &mesh.groups()["right"].sides {
                let (x, [a, b]) = mesh.on_side(*side, &[0.3, -0.2, 0.0]);
                assert!((x[0] - 2.0).abs() < 1e-14 && a.cross(&b)[0] > 0.0);
            }
        }
        let turn = std::f64::consts::TAU;
        let ring = block::<2>(&[vec![1.0, 1.5, 2.0], (0..=8).map(|k| turn * f64::from(k) / 8.0).collect()], 2, |x| {
            Point::<2>::new(x[0] * x[1].cos(), x[0] * x[1].sin())
        });
        ring.check().unwrap();
        assert_eq!((ring.nodes().len(), ring.cell_count()), (5 * 16, 16));
        assert!(!ring.groups().contains_key("bottom") && !ring.groups().contains_key("top"));
        let mut sides = ring.groups()["boundary"].sides.clone();
        sides.sort_unstable();
        assert_eq!((sides.len(), sides), (16, ring.boundary()));
        let flat = block::<2>(&[vec![0.0, 1.0], vec![0.0, 1.0]], 1, |x| Point::<2>::new(x[1], x[0]));
        assert!(flat.check().unwrap_err().to_string().contains("inverted"));
    }
}
