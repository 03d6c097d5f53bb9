//! Quadrature on reference cells.

use super::reference::{CellShape, Local};
use signorini_geometry::rule::gauss_legendre;

/// Points and weights.
pub type Rule = Vec<(Local, f64)>;

/// A rule of `n` points in each direction: exact for degree `2n - 1` on tensor shapes, `2n - 2` on triangles and wedges
/// and `2n - 3` on tetrahedra, where the cube is collapsed onto the cell.
pub fn rule(shape: CellShape, n: usize) -> Rule {
    let line: Vec<(f64, f64)> = gauss_legendre(n);
    let mut out = Rule::new();
    let dimension = shape.dimension();
    let count = n.pow(dimension as u32);
    for i in 0..count {
        let mut index = i;
        let mut x = [0.0; 3];
        let mut w = 1.0;
        for value in x.iter_mut().take(dimension) {
            let (position, weight) = line[index % n];
            index /= n;
            *value = position;
            w *= weight;
        }
        let [a, b, c] = x;
        out.push(match shape {
            CellShape::Line | CellShape::Quadrilateral | CellShape::Hexahedron => {
                let mut y = [0.0; 3];
                for k in 0..dimension {
                    y[k] = 2.0 * x[k] - 1.0;
                }
                (y, w * f64::from(1u32 << dimension))
            }
            CellShape::Triangle => ([a * (1.0 - b), b, 0.0], w * (1.0 - b)),
            CellShape::Wedge => ([a * (1.0 - b), b, 2.0 * c - 1.0], 2.0 * w * (1.0 - b)),
            CellShape::Tetrahedron => {
                ([a * (1.0 - b) * (1.0 - c), b * (1.0 - c), c], w * (1.0 - b) * (1.0 - c) * (1.0 - c))
            }
        });
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn monomials_are_integrated_exactly() {
        // Integral of x^i y^j z^k over the unit tetrahedron: i! j! k! / (i + j + k + 3)!.
        let factorial = |n: u32| (1..=n).map(f64::from).product::<f64>();
        let sum = |shape, n, f: &dyn Fn(&Local) -> f64| rule(shape, n).iter().map(|(x, w)| w * f(x)).sum::<f64>();
        for (i, j, k) in [(0, 0, 0), (1, 0, 2), (2, 2, 1), (0, 3, 2)] {
            let monomial = |x: &Local| x[0].powi(i) * x[1].powi(j) * x[2].powi(k);
            let n = 4;
            let [i, j, k] = [i as u32, j as u32, k as u32];
            let simplex = factorial(i) * factorial(j) * factorial(k) / factorial(i + j + k + 3);
            assert!((sum(CellShape::Tetrahedron, n, &monomial) - simplex).abs() < 1e-15);
            let line = |k: u32| if k.is_multiple_of(2) { 2.0 / f64::from(k + 1) } else { 0.0 };
            let triangle = factorial(i) * factorial(j) / factorial(i + j + 2);
            assert!((sum(CellShape::Wedge, n, &monomial) - triangle * line(k)).abs() < 1e-15);
            assert!((sum(CellShape::Hexahedron, n, &monomial) - line(i) * line(j) * line(k)).abs() < 1e-14);
        }
    }
}
