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

/// Value and derivatives of the factors of a function, by direction.
struct Factors<'a, const D: usize>([&'a [f64; 4]; D]);

impl<const D: usize> Factors<'_, D> {
    /// The derivative of the product along some directions, a direction named as often as it is taken.
    fn derivative<const ORDER: usize>(&self, along: [usize; ORDER]) -> f64 {
        let mut orders = [0; D];
        along.into_iter().for_each(|k| orders[k] += 1);
        let mut product = 1.0;
        (0..D).for_each(|k| product *= self.0[k][orders[k]]);
        product
    }
}

impl<const D: usize> CellBody<D> {
    /// Calls `visit` with the place of each function of a cell in [`Cell::functions`](crate::Cell::functions) and its
    /// factors at a point.
    fn for_each_function(&self, cell: usize, x: &Point<D>, mut visit: impl FnMut(usize, &Factors<'_, D>)) {
        let cell = &self.cells()[cell];
        let leaf = &self.tree.leaves()[cell.leaf];
        let mut level = usize::MAX;
        let mut lines = [[[0.0; 4]; MAX_DEGREE + 1]; D];
        for (place, mode) in cell.modes.iter().enumerate() {
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
            visit(place, &Factors(std::array::from_fn(|k| &lines[k][mode.factors[k]])));
        }
    }

    /// The functions of a cell at a point, in the order of [`Cell::functions`](crate::Cell::functions); beyond the cell
    /// their polynomials go on.
    pub fn jets_at(&self, cell: usize, x: &Point<D>) -> Vec<FunctionJet<D>> {
        let mut out = Vec::with_capacity(self.cells()[cell].modes.len());
        self.for_each_function(cell, x, |_, f| {
            out.push(FunctionJet {
                value: f.derivative([]),
                gradient: Vector::from_fn(|i, _| f.derivative([i])),
                hessian: Matrix::from_fn(|i, j| f.derivative([i, j])),
            });
        });
        out
    }

    /// The displacement of a cell at a point for coefficients of the functions; without third derivatives unless they are
    /// `wanted`.
    pub fn displacement_jet(&self, cell: usize, x: &Point<D>, u: &[f64], third_is_wanted: bool) -> VectorJet<D> {
        let zero = Matrix::<D>::zeros();
        let mut out = VectorJet { value: Vector::zeros(), gradient: zero, hessian: [zero; D], third: [[zero; D]; D] };
        let functions = &self.cells()[cell].functions;
        self.for_each_function(cell, x, |place, f| {
            let c: [f64; D] = std::array::from_fn(|i| u[D * functions[place] as usize + i]);
            let value = f.derivative([]);
            (0..D).for_each(|i| out.value[i] += c[i] * value);
            for j in 0..D {
                let first = f.derivative([j]);
                (0..D).for_each(|i| out.gradient[(i, j)] += c[i] * first);
                for k in j..D {
                    let second = f.derivative([j, k]);
                    (0..D).for_each(|i| out.hessian[i][(j, k)] += c[i] * second);
                    for l in (k..D).filter(|_| third_is_wanted) {
                        let third = f.derivative([j, k, l]);
                        (0..D).for_each(|i| out.third[i][l][(j, k)] += c[i] * third);
                    }
                }
            }
        });
        // Derivatives in any order are those in the order that was summed.
        for i in 0..D {
            for j in 0..D {
                for k in 0..D {
                    out.hessian[i][(j, k)] = out.hessian[i][(j.min(k), j.max(k))];
                    for l in (0..D).filter(|_| third_is_wanted) {
                        let mut order = [j, k, l];
                        order.sort_unstable();
                        out.third[i][l][(j, k)] = out.third[i][order[2]][(order[0], order[1])];
                    }
                }
            }
        }
        out
    }
}
