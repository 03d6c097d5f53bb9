//! Hierarchic shape functions: linear at the vertices, integrated Legendre polynomials on edges, faces and inside.
//!
//! On tensor shapes the functions are products of `N_0 = (1 - ξ)/2`, `N_1 = (1 + ξ)/2` and
//! `N_k = (P_k - P_{k-2}) / √(4k - 2)` (Szabó & Babuška, *Finite Element Analysis*, 1991), of any degree. Triangles,
//! tetrahedra and wedges have degree 1 and 2, with the same traces on edges and quadrilateral sides, so that all shapes
//! fit together in one mesh.

use super::reference::{CellShape, Local};

mod derivatives;

pub use derivatives::Derivatives;
pub(crate) use derivatives::{TIMES, along, place, product};

/// The highest degree.
pub const MAX_DEGREE: usize = 8;

/// To which part of a cell a function belongs; it vanishes on all others that do not contain it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mode {
    Vertex(u8),
    /// Edge, and the degree along it.
    Edge(u8, u8),
    /// Quadrilateral side of a solid, and the degrees along the first two axes of the reference cell that it spans.
    Side(u8, [u8; 2]),
    Interior,
}

/// How a function is made of factors.
#[derive(Clone, Copy, Debug)]
enum Factors {
    /// Degrees of the factors in each direction.
    Tensor([u8; 3]),
    /// Barycentric coordinates of the triangle or tetrahedron: one, or two for an edge; and the factor along the third
    /// direction of a wedge.
    Simplex { first: u8, second: Option<u8>, along: Option<u8> },
}

/// The functions of one shape and degree.
#[derive(Clone, Debug)]
pub struct HierarchicBasis {
    shape: CellShape,
    degree: usize,
    modes: Vec<Mode>,
    factors: Vec<Factors>,
}

/// Values and gradients of all functions at a point, with respect to the reference coordinates.
#[derive(Clone, Debug, Default)]
pub struct Values {
    pub value: Vec<f64>,
    pub gradient: Vec<Local>,
}

impl Values {
    pub(crate) fn clear(&mut self) {
        self.value.clear();
        self.gradient.clear();
    }
}

impl HierarchicBasis {
    /// # Panics
    /// If the degree is not one of the shape: 1 to 8 on tensor shapes, 1 or 2 on the others.
    pub fn new(shape: CellShape, degree: usize) -> Self {
        let most = if shape.is_tensor() { MAX_DEGREE } else { 2 };
        assert!((1..=most).contains(&degree), "degree {degree} on a {}", shape.name());
        let mut basis = HierarchicBasis { shape, degree, modes: Vec::new(), factors: Vec::new() };
        if shape.is_tensor() {
            basis.tensor()
        } else {
            basis.simplex()
        }
        basis
    }

    fn push(&mut self, mode: Mode, factors: Factors) {
        self.modes.push(mode);
        self.factors.push(factors);
    }

    fn tensor(&mut self) {
        let (shape, degree) = (self.shape, self.degree as u8);
        let dimension = shape.dimension();
        let vertices = shape.vertices();
        let nodal = |v: usize| -> [u8; 3] { std::array::from_fn(|k| u8::from(vertices[v][k] > 0.0)) };
        for v in 0..vertices.len() {
            self.push(Mode::Vertex(v as u8), Factors::Tensor(nodal(v)));
        }
        if dimension > 1 {
            for (e, &[a, b]) in shape.edges().iter().enumerate() {
                let axis = (0..3).find(|&k| vertices[a][k] != vertices[b][k]).unwrap_or(0);
                for k in 2..=degree {
                    let mut factors = nodal(a);
                    factors[axis] = k;
                    self.push(Mode::Edge(e as u8, k), Factors::Tensor(factors));
                }
            }
        }
        if dimension == 3 {
            for (s, corners) in shape.sides().iter().enumerate() {
                let axes = spanned(shape, corners);
                for i in 2..=degree {
                    for j in 2..=degree {
                        let mut factors = nodal(corners[0]);
                        (factors[axes[0]], factors[axes[1]]) = (i, j);
                        self.push(Mode::Side(s as u8, [i, j]), Factors::Tensor(factors));
                    }
                }
            }
        }
        let inner = |k: usize| if k < dimension { 2..=degree } else { 0..=0 };
        for i in inner(0) {
            for j in inner(1) {
                for k in inner(2) {
                    self.push(Mode::Interior, Factors::Tensor([i, j, k]));
                }
            }
        }
    }

    fn simplex(&mut self) {
        let shape = self.shape;
        let wedge = shape == CellShape::Wedge;
        // Vertices of a wedge: three below, three above.
        let split = |v: usize| if wedge { ((v % 3) as u8, Some((v / 3) as u8)) } else { (v as u8, None) };
        for v in 0..shape.vertices().len() {
            let (first, along) = split(v);
            self.push(Mode::Vertex(v as u8), Factors::Simplex { first, second: None, along });
        }
        if self.degree < 2 {
            return;
        }
        for (e, &[a, b]) in shape.edges().iter().enumerate() {
            let ((first, along), (second, other)) = (split(a), split(b));
            let factors = if first == second {
                Factors::Simplex { first, second: None, along: Some(2) }
            } else {
                debug_assert_eq!(along, other);
                Factors::Simplex { first, second: Some(second), along }
            };
            self.push(Mode::Edge(e as u8, 2), factors);
        }
        if wedge {
            for (s, corners) in shape.sides().iter().enumerate().filter(|(_, c)| c.len() == 4) {
                let factors =
                    Factors::Simplex { first: corners[0] as u8, second: Some(corners[1] as u8), along: Some(2) };
                self.push(Mode::Side(s as u8, [2, 2]), factors);
            }
        }
    }

    pub fn shape(&self) -> CellShape {
        self.shape
    }

    pub fn degree(&self) -> usize {
        self.degree
    }

    pub fn modes(&self) -> &[Mode] {
        &self.modes
    }

    /// Number of functions.
    pub fn len(&self) -> usize {
        self.modes.len()
    }

    pub fn is_empty(&self) -> bool {
        self.modes.is_empty()
    }

    /// Values and gradients at a point of the reference cell, or near it.
    pub fn tabulate(&self, x: &Local, out: &mut Values) {
        out.clear();
        if self.shape.is_tensor() {
            let lines =
                [0, 1, 2].map(|k| if k < self.shape.dimension() { line(self.degree, x[k]) } else { LineValues::one() });
            for factors in &self.factors {
                let Factors::Tensor(index) = *factors else { continue };
                let f: [[f64; 2]; 3] = std::array::from_fn(|k| lines[k].0[index[k] as usize]);
                out.value.push(f[0][0] * f[1][0] * f[2][0]);
                out.gradient.push([
                    f[0][1] * f[1][0] * f[2][0],
                    f[0][0] * f[1][1] * f[2][0],
                    f[0][0] * f[1][0] * f[2][1],
                ]);
            }
            return;
        }
        let (lambda, slopes) = barycentric(self.shape, x);
        let along_line = line(2, x[2]);
        for factors in &self.factors {
            let Factors::Simplex { first, second, along } = *factors else { continue };
            let a = first as usize;
            let (mut value, mut gradient) = (lambda[a], slopes[a]);
            if let Some(b) = second {
                let b = b as usize;
                gradient = std::array::from_fn(|k| -ROOT_6 * (lambda[a] * slopes[b][k] + lambda[b] * slopes[a][k]));
                value = -ROOT_6 * lambda[a] * lambda[b];
            }
            if let Some(k) = along {
                let [n, dn] = along_line.0[k as usize];
                gradient = [gradient[0] * n, gradient[1] * n, value * dn];
                value *= n;
            }
            out.value.push(value);
            out.gradient.push(gradient);
        }
    }
}

/// `N_2 = (3/2)(ξ² - 1)/√6` is `-√6` times the product of the barycentric coordinates.
const ROOT_6: f64 = 2.449_489_742_783_178;

/// The axes of the reference hexahedron along a side, in increasing order.
pub fn spanned(shape: CellShape, corners: &[usize]) -> [usize; 2] {
    let vertices = shape.vertices();
    let varies = |k: &usize| corners.iter().any(|&c| vertices[c][*k] != vertices[corners[0]][*k]);
    let mut axes = (0..3).filter(varies);
    [axes.next().unwrap_or(0), axes.next().unwrap_or(1)]
}

/// Barycentric coordinates and their gradients; of the triangle for a wedge.
pub(crate) fn barycentric(shape: CellShape, x: &Local) -> ([f64; 4], [Local; 4]) {
    if shape == CellShape::Tetrahedron {
        ([1.0 - x[0] - x[1] - x[2], x[0], x[1], x[2]], [[-1.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]])
    } else {
        ([1.0 - x[0] - x[1], x[0], x[1], 0.0], [[-1.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0; 3]])
    }
}

/// Value and slope of the functions of one direction.
struct LineValues([[f64; 2]; MAX_DEGREE + 1]);

impl LineValues {
    fn one() -> Self {
        let mut line = LineValues([[0.0; 2]; MAX_DEGREE + 1]);
        line.0[0] = [1.0, 0.0];
        line
    }
}

fn line(degree: usize, x: f64) -> LineValues {
    let mut out = LineValues([[0.0; 2]; MAX_DEGREE + 1]);
    out.0[0] = [0.5 * (1.0 - x), -0.5];
    out.0[1] = [0.5 * (1.0 + x), 0.5];
    let (mut before, mut last) = (1.0, x);
    for k in 2..=degree {
        let n = k as f64;
        let next = ((2.0 * n - 1.0) * x * last - (n - 1.0) * before) / n;
        // P_{k-2} is `before`, P_{k-1} is `last`.
        out.0[k] = [(next - before) / (4.0 * n - 2.0).sqrt(), (n - 0.5).sqrt() * last];
        (before, last) = (last, next);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use CellShape::*;

    fn cases() -> Vec<HierarchicBasis> {
        let mut list = Vec::new();
        for shape in [Line, Triangle, Quadrilateral, Tetrahedron, Hexahedron, Wedge] {
            for degree in 1..=if shape.is_tensor() { 5 } else { 2 } {
                list.push(HierarchicBasis::new(shape, degree));
            }
        }
        list
    }

    #[test]
    fn gradients_are_those_of_the_values_and_vertices_sum_to_one() {
        for basis in cases() {
            let x = [0.23, 0.31, 0.17];
            let (mut at, mut plus, mut minus) = (Values::default(), Values::default(), Values::default());
            basis.tabulate(&x, &mut at);
            assert_eq!(at.value.len(), basis.len());
            for k in 0..basis.shape().dimension() {
                let h = 1e-5;
                let moved = |h: f64| {
                    let mut y = x;
                    y[k] += h;
                    y
                };
                basis.tabulate(&moved(h), &mut plus);
                basis.tabulate(&moved(-h), &mut minus);
                for i in 0..basis.len() {
                    let difference = (plus.value[i] - minus.value[i]) / (2.0 * h);
                    assert!((difference - at.gradient[i][k]).abs() < 1e-8, "{:?}", basis.modes()[i]);
                }
            }
            let sum: f64 =
                at.value.iter().zip(basis.modes()).filter(|(_, m)| matches!(m, Mode::Vertex(_))).map(|v| v.0).sum();
            assert!((sum - 1.0).abs() < 1e-14);
        }
    }

    #[test]
    fn functions_vanish_on_sides_that_do_not_contain_them() {
        for basis in cases() {
            let shape = basis.shape();
            if shape == Line {
                continue;
            }
            for (side, corners) in shape.sides().iter().enumerate() {
                let (x, _) = shape.on_side(side, &[0.21, 0.37, 0.0]);
                let mut at = Values::default();
                basis.tabulate(&x, &mut at);
                for (mode, value) in basis.modes().iter().zip(&at.value) {
                    let on = match mode {
                        Mode::Vertex(v) => corners.contains(&(*v as usize)),
                        Mode::Edge(e, _) => shape.edges()[*e as usize].iter().all(|v| corners.contains(v)),
                        Mode::Side(s, _) => *s as usize == side,
                        Mode::Interior => false,
                    };
                    assert_eq!(on, value.abs() > 1e-12, "{shape:?} {mode:?} on side {side}: {value}");
                }
            }
        }
    }
}
