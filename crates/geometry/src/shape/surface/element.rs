//! Faces of finite elements: quadrilaterals and triangles of any order.

use super::grid::{bezier_grid, control_net};
use super::{Surface, SurfaceKind};
use crate::Point;
use crate::patch::bernstein::{Control, MAX_DEGREE, combine};
use crate::patch::net::Net;
use crate::patch::{Atlas, Border, ParameterMap, Piece, Side, SurfaceChart};
use crate::shape::curve::homogeneous;
use crate::shape::error::{ShapeError, position};

impl Surface {
    /// A quadrilateral of any order over `[-1, 1]²` through a grid of nodes, `nodes[i][j]` with `i` along `u`.
    ///
    /// # Errors
    /// Rows of different length, an order out of range.
    pub fn lagrange_quad(nodes: &[Vec<Point<3>>]) -> Result<Self, ShapeError> {
        let values = control_net(nodes, None).map_err(|e| ShapeError::new("nodes", e.message))?;
        if values.degree.iter().any(|&d| d == 0 || d > MAX_DEGREE) {
            return Err(ShapeError::new("nodes", "valid are 2 to 16 nodes each way"));
        }
        let net = values
            .map_columns(|c| crate::patch::bernstein::interpolate(values.degree[0], c))
            .map_rows(|r| crate::patch::bernstein::interpolate(values.degree[1], r));
        let parts = bezier_grid([vec![-1.0, 1.0], vec![-1.0, 1.0]], [vec![true], vec![true]], vec![net]);
        Ok(Self::assemble(SurfaceKind::Other, parts, [false; 2], false))
    }

    /// Four nodes, counter-clockwise from `(-1, -1)`.
    ///
    /// # Errors
    /// Coordinates that are not finite.
    pub fn quad4(n: &[Point<3>; 4]) -> Result<Self, ShapeError> {
        Self::lagrange_quad(&[vec![n[0], n[3]], vec![n[1], n[2]]])
    }

    /// Nine nodes: corners counter-clockwise from `(-1, -1)`, middles of the sides from `(0, -1)`, centre.
    ///
    /// # Errors
    /// Coordinates that are not finite.
    pub fn quad9(n: &[Point<3>; 9]) -> Result<Self, ShapeError> {
        Self::lagrange_quad(&[vec![n[0], n[7], n[3]], vec![n[4], n[8], n[6]], vec![n[1], n[5], n[2]]])
    }

    /// A triangle of any order over `xi, eta >= 0`, `xi + eta <= 1`. Nodes sit at `(i/p, j/p)`, row by row: all of
    /// `j = 0` first, `i` fastest.
    ///
    /// # Errors
    /// A number of nodes that is not `(p + 1)(p + 2)/2`, an order above 10.
    pub fn lagrange_triangle(nodes: &[Point<3>]) -> Result<Self, ShapeError> {
        let order = (1..=10).find(|p| (p + 1) * (p + 2) / 2 == nodes.len()).ok_or_else(|| {
            ShapeError::new(
                "nodes",
                format!("{} given, valid are 3, 6, 10, ... (p + 1)(p + 2)/2 up to p = 10", nodes.len()),
            )
        })?;
        for p in nodes {
            position("nodes", p)?;
        }
        let at = |xi: f64, eta: f64| -> Control {
            let mut sum = [0.0; 4];
            let mut k = 0;
            for j in 0..=order {
                for i in 0..=order - j {
                    let shape = triangle_shape(order, [i, j], xi, eta);
                    sum = combine(1.0, &sum, shape, &homogeneous(&nodes[k], 1.0));
                    k += 1;
                }
            }
            sum
        };
        let kind = match nodes {
            [a, b, c] => SurfaceKind::Triangle { nodes: [*a, *b, *c] },
            _ => SurfaceKind::Other,
        };
        Ok(Self::triangle_of(kind, order, at))
    }

    fn triangle_of(kind: SurfaceKind, order: usize, at: impl Fn(f64, f64) -> Control) -> Self {
        let whole = SurfaceChart::bezier(&Net::interpolating([order, order], &at));
        // Three quadrilaterals around the centroid: corner, middle of a side, centroid, middle of the other side.
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let borders = [Border::V0, Border::Diagonal, Border::U0];
        let middle = |a: usize, b: usize| [0, 1].map(|k| 0.5 * (corners[a][k] + corners[b][k]));
        let pieces = (0..3)
            .map(|k| {
                let (next, before) = ((k + 1) % 3, (k + 2) % 3);
                let quad = [corners[k], middle(k, next), [1.0 / 3.0; 2], middle(k, before)];
                let map = ParameterMap::Bilinear(quad);
                let net = Net::interpolating([order, order], |s, t| {
                    let p = map.apply(&[2.0 * s - 1.0, 2.0 * t - 1.0]);
                    at(p[0], p[1])
                });
                let sides = [[Side::Boundary(borders[before]), Side::Inner], [Side::Boundary(borders[k]), Side::Inner]];
                Piece::new(SurfaceChart::bezier(&net), map, sides)
            })
            .collect();
        Surface {
            kind,
            atlas: Atlas::new(pieces),
            domain: [[0.0, 1.0]; 2],
            closed: [false; 2],
            breaks: [Vec::new(), Vec::new()],
            triangle: Some(whole),
        }
    }

    /// Three corners.
    ///
    /// # Errors
    /// Coordinates that are not finite.
    pub fn tri3(nodes: &[Point<3>; 3]) -> Result<Self, ShapeError> {
        Self::lagrange_triangle(nodes)
    }

    /// Three corners, then the middles of the sides 12, 23, 31.
    ///
    /// # Errors
    /// Coordinates that are not finite.
    pub fn tri6(n: &[Point<3>; 6]) -> Result<Self, ShapeError> {
        Self::lagrange_triangle(&[n[0], n[3], n[1], n[5], n[4], n[2]])
    }
}

/// Lagrange polynomial of the node `(i/p, j/p)` of a triangle.
fn triangle_shape(order: usize, [i, j]: [usize; 2], xi: f64, eta: f64) -> f64 {
    let p = order as f64;
    let factor = |n: usize, x: f64| (0..n).map(|k| (p * x - k as f64) / (n - k) as f64).product::<f64>();
    factor(i, xi) * factor(j, eta) * factor(order - i - j, 1.0 - xi - eta)
}
