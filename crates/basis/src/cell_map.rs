//! The map from a reference cell to space: Lagrange functions through the nodes of the cell.
//!
//! Cells of splines are mapped by their rational functions and control points instead.
//!
//! Nodes of tensor shapes are the Gauss-Lobatto points, the first direction fastest. Triangles and tetrahedra have their
//! vertices first, then the middles of their edges; a wedge is a triangle times a line, the triangle fastest.

use super::hierarchic::{MAX_DEGREE, Values, barycentric};
use super::lagrange::TensorBasis;
use super::rational::RationalBasis;
use super::reference::{CellShape, Local};
use std::sync::Arc;

/// Lagrange functions of one shape and order, or the functions of a span of a spline.
#[derive(Clone, Debug)]
pub struct CellMap {
    shape: CellShape,
    order: usize,
    len: usize,
    line: TensorBasis<1>,
    rational: Option<Arc<RationalBasis>>,
}

impl CellMap {
    /// # Panics
    /// If the order is not one of the shape: 1 to 8 on tensor shapes, 1 or 2 on the others.
    pub fn new(shape: CellShape, order: usize) -> Self {
        let most = if shape.is_tensor() { MAX_DEGREE } else { 2 };
        assert!((1..=most).contains(&order), "order {order} on a {}", shape.name());
        let n = order + 1;
        let len = match shape {
            CellShape::Wedge => n * triangle_nodes(order),
            CellShape::Triangle => triangle_nodes(order),
            CellShape::Tetrahedron => [4, 10][order - 1],
            tensor => n.pow(tensor.dimension() as u32),
        };
        CellMap { shape, order, len, line: TensorBasis::new(order), rational: None }
    }

    /// The map of a span of a spline, or of a face of one, by its control points.
    pub fn spline(basis: Arc<RationalBasis>) -> Self {
        let (shape, order, len) = (basis.shape(), basis.degree(), basis.len());
        CellMap { shape, order, len, line: TensorBasis::new(order), rational: Some(basis) }
    }

    /// Whether it is the polynomial map of a shape and order.
    pub fn is_polynomial(&self, shape: CellShape, order: usize) -> bool {
        self.shape() == shape && self.order() == order && self.rational().is_none()
    }

    /// The functions of a spline, where they are such.
    pub fn rational(&self) -> Option<&Arc<RationalBasis>> {
        self.rational.as_ref()
    }

    pub fn shape(&self) -> CellShape {
        self.shape
    }

    pub fn order(&self) -> usize {
        self.order
    }

    /// Number of nodes.
    pub fn len(&self) -> usize {
        self.len
    }

    pub fn is_empty(&self) -> bool {
        false
    }

    /// The node at each vertex; none of splines, whose control points are not points of the cell.
    pub fn vertex_nodes(&self) -> Vec<usize> {
        if self.rational.is_some() {
            return Vec::new();
        }
        let n = self.order;
        let upper = |x: f64| if x > 0.0 { n } else { 0 };
        (self.shape.vertices().iter().enumerate())
            .map(|(v, x)| match self.shape {
                CellShape::Triangle | CellShape::Tetrahedron => v,
                CellShape::Wedge => v % 3 + triangle_nodes(n) * upper(x[2]),
                _ => (0..self.shape.dimension()).rev().fold(0, |at, k| at * (n + 1) + upper(x[k])),
            })
            .collect()
    }

    /// Reference coordinates of the nodes; of splines the point of the cell nearest to the Greville abscissae of each function.
    pub fn nodes(&self) -> Vec<Local> {
        if let Some(basis) = &self.rational {
            return (0..basis.len()).map(|f| basis.greville(f).map(|g| g.clamp(-1.0, 1.0))).collect();
        }
        let line: Vec<f64> = self.line.line_nodes().iter().map(|x| 2.0 * x - 1.0).collect();
        let with_middles = |shape: CellShape| -> Vec<Local> {
            let vertices = shape.vertices();
            let mut nodes = vertices.to_vec();
            if self.order == 2 {
                nodes.extend(
                    shape
                        .edges()
                        .iter()
                        .map(|&[a, b]| -> Local { std::array::from_fn(|k| 0.5 * (vertices[a][k] + vertices[b][k])) }),
                );
            }
            nodes
        };
        match self.shape {
            CellShape::Triangle | CellShape::Tetrahedron => with_middles(self.shape),
            CellShape::Wedge => {
                let triangle = with_middles(CellShape::Triangle);
                line.iter().flat_map(|&z| triangle.iter().map(move |t| [t[0], t[1], z])).collect()
            }
            _ => {
                let (n, dimension) = (self.order + 1, self.shape.dimension());
                (0..self.len())
                    .map(|i| std::array::from_fn(|k| if k < dimension { line[i / n.pow(k as u32) % n] } else { 0.0 }))
                    .collect()
            }
        }
    }

    /// Values and gradients of all functions at a point of the reference cell, or near it.
    pub fn tabulate(&self, x: &Local, out: &mut Values) {
        if let Some(basis) = &self.rational {
            return basis.tabulate(x, out);
        }
        out.clear();
        if matches!(self.shape, CellShape::Triangle | CellShape::Tetrahedron) {
            return self.simplex(self.shape, x, out);
        }
        let n = self.order + 1;
        // Values and slopes along each direction.
        let lines = [0, 1, 2].map(|k| {
            let used = match self.shape {
                CellShape::Wedge => k == 2,
                shape => shape.is_tensor() && k < shape.dimension(),
            };
            if used { self.line.line(0.5 * (1.0 + x[k])) } else { [[0.0; MAX_DEGREE + 1]; 2] }
        });
        match self.shape {
            CellShape::Wedge => {
                let mut triangle = Values::default();
                self.simplex(CellShape::Triangle, x, &mut triangle);
                for k in 0..n {
                    let (value, slope) = (lines[2][0][k], 0.5 * lines[2][1][k]);
                    for (v, g) in triangle.value.iter().zip(&triangle.gradient) {
                        out.value.push(v * value);
                        out.gradient.push([g[0] * value, g[1] * value, v * slope]);
                    }
                }
            }
            shape => {
                let dimension = shape.dimension();
                for i in 0..self.len() {
                    let mut index = i;
                    let mut f = [[1.0, 0.0]; 3];
                    for (k, factor) in f.iter_mut().enumerate().take(dimension) {
                        *factor = [lines[k][0][index % n], 0.5 * lines[k][1][index % n]];
                        index /= n;
                    }
                    out.value.push(f[0][0] * f[1][0] * f[2][0]);
                    out.gradient.push([
                        f[0][1] * f[1][0] * f[2][0],
                        f[0][0] * f[1][1] * f[2][0],
                        f[0][0] * f[1][0] * f[2][1],
                    ]);
                }
            }
        }
    }

    fn simplex(&self, shape: CellShape, x: &Local, out: &mut Values) {
        let (lambda, slopes) = barycentric(shape, x);
        for a in 0..shape.vertices().len() {
            if self.order == 1 {
                out.value.push(lambda[a]);
                out.gradient.push(slopes[a]);
            } else {
                out.value.push(lambda[a] * (2.0 * lambda[a] - 1.0));
                out.gradient.push(slopes[a].map(|s| s * (4.0 * lambda[a] - 1.0)));
            }
        }
        if self.order == 2 {
            for &[a, b] in shape.edges() {
                out.value.push(4.0 * lambda[a] * lambda[b]);
                out.gradient.push(std::array::from_fn(|k| 4.0 * (lambda[a] * slopes[b][k] + lambda[b] * slopes[a][k])));
            }
        }
    }
}

fn triangle_nodes(order: usize) -> usize {
    [3, 6][order - 1]
}

#[cfg(test)]
mod tests {
    use super::*;
    use CellShape::*;

    #[test]
    fn functions_are_one_at_their_node_and_reproduce_positions() {
        for shape in [Line, Triangle, Quadrilateral, Tetrahedron, Hexahedron, Wedge] {
            for order in 1..=if shape.is_tensor() { 4 } else { 2 } {
                let map = CellMap::new(shape, order);
                let nodes = map.nodes();
                assert_eq!(nodes.len(), map.len());
                let mut at = Values::default();
                for (i, x) in nodes.iter().enumerate() {
                    map.tabulate(x, &mut at);
                    for (j, v) in at.value.iter().enumerate() {
                        assert!((v - f64::from(u8::from(i == j))).abs() < 1e-13, "{shape:?} {order}");
                    }
                }
                for (v, &node) in map.vertex_nodes().iter().enumerate() {
                    assert_eq!(nodes[node], shape.vertices()[v]);
                }
                let x = [0.2, 0.3, if shape.dimension() == 3 { 0.1 } else { 0.0 }];
                map.tabulate(&x, &mut at);
                for k in 0..shape.dimension() {
                    let position: f64 = at.value.iter().zip(&nodes).map(|(v, n)| v * n[k]).sum();
                    let slope: f64 = at.gradient.iter().zip(&nodes).map(|(g, n)| g[k] * n[k]).sum();
                    assert!((position - x[k]).abs() < 1e-13 && (slope - 1.0).abs() < 1e-12);
                }
            }
        }
    }
}
