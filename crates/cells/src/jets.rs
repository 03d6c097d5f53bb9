//! Functions with their derivatives up to the third: for points that slide along a boundary that is moved.

use crate::body::CellBody;
use crate::legendre::{MAX_DEGREE, integrated_legendre_jets};
use signorini_geometry::{Aabb, Matrix, Point, Vector};

/// A function at a point.
#[derive(Clone, Copy, Debug)]
pub struct FunctionJet<const D: usize> {
    pub value: f64,
    pub gradient: Vector<D>,
    pub hessian: Matrix<D>,
    /// Derivative of the Hessian along each direction.
    pub third: [Matrix<D>; D],
}

/// A vector field at a point.
#[derive(Clone, Copy, Debug)]
pub struct VectorJet<const D: usize> {
    pub value: Vector<D>,
    /// `∂u_i / ∂x_j`.
    pub gradient: Matrix<D>,
    /// Hessian of each component.
    pub hessian: [Matrix<D>; D],
    /// Of each component, the derivative of its Hessian along each direction.
    pub third: [[Matrix<D>; D]; D],
}

impl<const D: usize> VectorJet<D> {
    /// `u''(a, b)`.
    pub fn second(&self, a: &Vector<D>, b: &Vector<D>) -> Vector<D> {
        Vector::from_fn(|i, _| a.dot(&(self.hessian[i] * b)))
    }

    /// `u'''(a, b, c)`.
    pub fn third(&self, a: &Vector<D>, b: &Vector<D>, c: &Vector<D>) -> Vector<D> {
        Vector::from_fn(|i, _| (0..D).map(|k| c[k] * a.dot(&(self.third[i][k] * b))).sum())
    }
}

impl<const D: usize> CellBody<D> {
    /// The functions of a cell at a point, in the order of [`Cell::functions`](crate::Cell::functions); beyond the cell
    /// their polynomials go on.
    pub fn jets_at(&self, cell: usize, x: &Point<D>) -> Vec<FunctionJet<D>> {
        let cell = &self.cells()[cell];
        let leaf = &self.tree.leaves()[cell.leaf];
        let mut level = usize::MAX;
        let mut lines = [[[0.0; 4]; MAX_DEGREE + 1]; D];
        let mut out = Vec::with_capacity(cell.modes.len());
        for mode in &cell.modes {
            if mode.mode.level != level {
                level = mode.mode.level;
                let b: Aabb<D> = self.tree.cell_box(level, &leaf.index.map(|i| i >> (leaf.level - level)));
                for k in 0..D {
                    let scale = 2.0 / (b.max[k] - b.min[k]);
                    lines[k] =
                        integrated_legendre_jets(self.degree(), 0.5 * scale * (2.0 * x[k] - b.min[k] - b.max[k]));
                    for jet in &mut lines[k] {
                        (1..4).for_each(|d| jet[d] *= scale.powi(d as i32));
                    }
                }
            }
            // The product of the derivatives of the orders in which each direction occurs.
            let product = |directions: &[usize]| -> f64 {
                (0..D).map(|k| lines[k][mode.factors[k]][directions.iter().filter(|d| **d == k).count()]).product()
            };
            out.push(FunctionJet {
                value: product(&[]),
                gradient: Vector::from_fn(|i, _| product(&[i])),
                hessian: Matrix::from_fn(|i, j| product(&[i, j])),
                third: std::array::from_fn(|k| Matrix::from_fn(|i, j| product(&[i, j, k]))),
            });
        }
        out
    }

    /// The displacement of a cell for coefficients of the functions, from those at a point.
    pub fn displacement_jet(&self, cell: usize, jets: &[FunctionJet<D>], u: &[f64]) -> VectorJet<D> {
        let zero = Matrix::<D>::zeros();
        let mut out = VectorJet { value: Vector::zeros(), gradient: zero, hessian: [zero; D], third: [[zero; D]; D] };
        for (f, jet) in self.cells()[cell].functions.iter().zip(jets) {
            for i in 0..D {
                let c = u[D * *f as usize + i];
                out.value[i] += c * jet.value;
                (0..D).for_each(|j| out.gradient[(i, j)] += c * jet.gradient[j]);
                out.hessian[i] += jet.hessian * c;
                (0..D).for_each(|k| out.third[i][k] += jet.third[k] * c);
            }
        }
        out
    }
}
