//! The closest point of a boundary that is moved, `y = X + u(X)`, on one or more smooth sheets `φ_i(X) = 0`.
//!
//! On a face one sheet is active, on an edge two, at a vertex of space three. The closest point to `x` solves
//!
//! `F^T (y - x) + Σ λ_i ∇φ_i = 0`, `φ_i = 0`, with `F = ∂y/∂X`,
//!
//! by Newton's method with the matrix `F^T F + (y - x)·u'' + Σ λ_i ∇∇φ_i`, bordered by the gradients. With a basis `t_a` of
//! the directions in which all active sheets vanish and `G⁺` the least-norm inverse of the gradients,
//!
//! - `X_a = t_a`, `X_ab = -G⁺ (t_a·H_i t_b)`, `X_abc = -G⁺ (H_i'(t_a, t_b, t_c) + X_ab·H_i t_c + X_ac·H_i t_b + X_bc·H_i t_a)`,
//! - `y_a = F X_a`, `y_ab = F X_ab + u''(X_a, X_b)`, and `y_abc` alike.

use super::CellSolid;
use crate::body::CellBody;
use crate::cell::Site;
use crate::jets::{FunctionJet, VectorJet};
use nalgebra::{DMatrix, DVector};
use signorini_geometry::implicit::{Complement, HalfSpace};
use signorini_geometry::{ImplicitShape, Matrix, Point, Vector};
use std::sync::Arc;

/// The sheets of a boundary, the sides of its box after them, and the sheet of each of its points.
pub(super) struct Sheets<const D: usize> {
    pub list: Vec<Arc<dyn ImplicitShape<D>>>,
    /// None where a point lies on a facet.
    of_point: Vec<Option<usize>>,
}

/// How far from a sheet a point of it may lie, in cells: chords of sub-cells do.
const NEAR: f64 = 0.05;
/// Cosine of the angle between the normal of a point and that of its sheet.
const ALONG: f64 = 0.9;

impl<const D: usize> Sheets<D> {
    pub fn new(body: &CellBody<D>, points: &[Site<D>]) -> Self {
        let mut list = body.region.sheets();
        let b = body.tree().bounds();
        for k in 0..D {
            let normal = Vector::<D>::from_fn(|i, _| f64::from(u8::from(i == k)));
            list.push(Arc::new(HalfSpace { point: b.min, normal: -normal }));
            list.push(Arc::new(HalfSpace { point: b.max, normal }));
        }
        let mut sheets = Sheets { of_point: Vec::new(), list };
        sheets.include(body, points);
        // Gradients out of the material, as at the first point of each sheet.
        for k in 0..sheets.list.len() {
            let first = (0..points.len()).find(|p| sheets.of_point[*p] == Some(k));
            if first.is_some_and(|p| sheets.list[k].gradient(&points[p].x).dot(&points[p].normal) < 0.0) {
                sheets.list[k] = Arc::new(Complement(sheets.list[k].clone()));
            }
        }
        sheets
    }

    /// Finds the sheets of further points.
    pub fn include(&mut self, body: &CellBody<D>, points: &[Site<D>]) {
        let nearest = |p: &Site<D>| {
            let size = body.bounds_of(p.cell).size().min();
            let distance = |sheet: &Arc<dyn ImplicitShape<D>>| {
                let (value, gradient) = sheet.value_and_gradient(&p.x);
                let slope = gradient.norm();
                let is_along = gradient.dot(&p.normal).abs() > ALONG * slope && slope > 0.0;
                if is_along { value.abs() / slope } else { f64::INFINITY }
            };
            let best = (0..self.list.len()).map(|k| (distance(&self.list[k]), k)).min_by(|a, b| a.0.total_cmp(&b.0));
            best.filter(|(distance, _)| *distance < NEAR * size).map(|(_, k)| k)
        };
        let found: Vec<Option<usize>> = points.iter().map(nearest).collect();
        self.of_point.extend(found);
    }

    /// The sheet of a point: its own, or the plane of its facet.
    pub fn at(&self, number: usize, point: &Site<D>) -> Arc<dyn ImplicitShape<D>> {
        match self.of_point[number] {
            Some(k) => self.list[k].clone(),
            None => Arc::new(HalfSpace { point: point.x, normal: point.normal }),
        }
    }

    pub fn number(&self, point: usize) -> Option<usize> {
        self.of_point[point]
    }
}

/// Sheets on which a point lies; their gradients point out of the material.
pub(super) type Active<const D: usize> = Vec<Arc<dyn ImplicitShape<D>>>;

/// A material point on active sheets, where it is now.
pub(super) struct Found<const D: usize> {
    pub x: Point<D>,
    pub cell: usize,
    pub u: VectorJet<D>,
}

impl<const D: usize> Found<D> {
    pub fn now(&self) -> Point<D> {
        self.x + self.u.value
    }

    /// `F`.
    pub fn deformation(&self) -> Matrix<D> {
        Matrix::<D>::identity() + self.u.gradient
    }
}

const MOST_ITERATIONS: usize = 30;
/// Iterations after which the cell is kept: a closest point in a kink between two cells would change them for ever.
const KEEP_CELL: usize = 8;
/// The last step, relative to the size of a cell.
const CONVERGED: f64 = 1e-13;
/// The largest step in cells.
const LARGEST_STEP: f64 = 0.5;

impl<const D: usize> CellSolid<D> {
    /// The cell whose polynomials move a point: one that was known, or that which contains the point.
    fn cell_for(&self, x: &Point<D>, known: usize) -> usize {
        let tree = self.body.tree();
        let own = self.body.cells()[known].leaf;
        if self.body.bounds_of(known).scaled(1.0 + 1e-12).contains(x) || tree.leaf_at(x) == own {
            return known;
        }
        self.body.cell_at(x).unwrap_or(known)
    }

    /// A material point where it is now, without third derivatives.
    pub(super) fn found(&self, x: Point<D>, cell: usize, u: &[f64]) -> Found<D> {
        Found { x, cell, u: self.body.displacement_jet(cell, &x, u, false) }
    }

    /// The same point again, in the cell that contains it.
    pub(super) fn found_near(&self, x: Point<D>, known: usize, u: &[f64]) -> Found<D> {
        self.found(x, self.cell_for(&x, known), u)
    }

    /// The closest point to `target` on active sheets, from a start; none where Newton's method finds none.
    pub(super) fn closest(
        &self,
        target: &Point<D>,
        (start, cell): (&Point<D>, usize),
        active: &Active<D>,
        u: &[f64],
    ) -> Option<Found<D>> {
        let size = self.body.bounds_of(cell).size().min();
        let n = active.len();
        let mut at = self.found(*start, cell, u);
        let mut lambda = vec![0.0; n];
        for iteration in 0..MOST_ITERATIONS {
            let f = at.deformation();
            let d = at.now() - target;
            let mut g = f.transpose() * f;
            // From afar without curvatures, so that a minimum is looked for.
            if iteration > 0 {
                (0..D).for_each(|i| g += at.u.hessian[i] * d[i]);
            }
            let mut matrix = DMatrix::<f64>::zeros(D + n, D + n);
            let mut rhs = DVector::<f64>::zeros(D + n);
            let mut force = f.transpose() * d;
            for (i, sheet) in active.iter().enumerate() {
                let (value, gradient) = sheet.value_and_gradient(&at.x);
                force += gradient * lambda[i];
                if iteration > 0 {
                    g += sheet.hessian(&at.x) * lambda[i];
                }
                for k in 0..D {
                    matrix[(k, D + i)] = gradient[k];
                    matrix[(D + i, k)] = gradient[k];
                }
                rhs[D + i] = -value;
            }
            for k in 0..D {
                rhs[k] = -force[k];
                (0..D).for_each(|l| matrix[(k, l)] = g[(k, l)]);
            }
            let step = matrix.lu().solve(&rhs)?;
            let mut move_by = Vector::<D>::from_fn(|k, _| step[k]);
            let length = move_by.norm();
            if !length.is_finite() {
                return None;
            }
            if length > LARGEST_STEP * size {
                move_by *= LARGEST_STEP * size / length;
            }
            (0..n).for_each(|i| lambda[i] += step[D + i]);
            let x = at.x + move_by;
            let cell = if iteration < KEEP_CELL { self.cell_for(&x, at.cell) } else { at.cell };
            let is_same = cell == at.cell;
            at = self.found(x, cell, u);
            if length <= CONVERGED * size && is_same && iteration > 0 {
                return Some(at);
            }
        }
        None
    }
}

/// Position and derivatives along up to two coordinates of a point on active sheets, moved.
pub(super) struct Chart<const D: usize> {
    /// `X_a`, and `X_ab` as 11, 12, 22.
    pub first: Vec<Vector<D>>,
    pub second: [Vector<D>; 3],
    /// `y_a`, `y_ab`, `y_abc` as 111, 112, 122, 222.
    pub now: ([Vector<D>; 2], [Vector<D>; 3], [Vector<D>; 4]),
}

/// Pairs and triples of coordinates.
const PAIRS: [[usize; 2]; 3] = [[0, 0], [0, 1], [1, 1]];
const TRIPLES: [[usize; 3]; 4] = [[0, 0, 0], [0, 0, 1], [0, 1, 1], [1, 1, 1]];

impl<const D: usize> Chart<D> {
    pub fn new(at: &Found<D>, active: &Active<D>) -> Self {
        let zero = Vector::<D>::zeros();
        let gradients: Vec<Vector<D>> = active.iter().map(|s| s.gradient(&at.x)).collect();
        let hessians: Vec<Matrix<D>> = active.iter().map(|s| s.hessian(&at.x)).collect();
        let first = across(&gradients);
        let n = gradients.len();
        let gram = DMatrix::from_fn(n, n, |i, j| gradients[i].dot(&gradients[j])).lu();
        // -G⁺ r.
        let least = |r: Vec<f64>| -> Vector<D> {
            let c = gram.solve(&DVector::from_vec(r)).unwrap_or_else(|| DVector::zeros(n));
            (0..n).fold(zero, |sum, i| sum - gradients[i] * c[i])
        };
        let along = |a: usize| first.get(a).copied().unwrap_or(zero);
        let second = PAIRS.map(|[a, b]| {
            if a.max(b) >= first.len() {
                return zero;
            }
            least(hessians.iter().map(|h| along(a).dot(&(h * along(b)))).collect())
        });
        let pair = |a: usize, b: usize| second[a + b];
        // Differences of the Hessian; the step at which rounding and the next term are alike.
        let step = f64::EPSILON.cbrt() * at.x.amax().max(1e-3);
        let slopes: Vec<Vec<Matrix<D>>> = (first.iter())
            .map(|t| {
                let slope = |s: &Arc<dyn ImplicitShape<D>>| {
                    (s.hessian(&(at.x + t * step)) - s.hessian(&(at.x - t * step))) / (2.0 * step)
                };
                active.iter().map(slope).collect()
            })
            .collect();
        let third = TRIPLES.map(|[a, b, c]| {
            if c >= first.len() {
                return zero;
            }
            let of = |i: usize| {
                along(a).dot(&(slopes[c][i] * along(b)))
                    + pair(a, b).dot(&(hessians[i] * along(c)))
                    + pair(a, c).dot(&(hessians[i] * along(b)))
                    + pair(b, c).dot(&(hessians[i] * along(a)))
            };
            least((0..n).map(of).collect())
        });
        let (f, u) = (at.deformation(), &at.u);
        let now_1 = [0, 1].map(|a| f * along(a));
        let now_2: [Vector<D>; 3] = std::array::from_fn(|k| {
            let [a, b] = PAIRS[k];
            f * second[k] + u.second(&along(a), &along(b))
        });
        let now_3: [Vector<D>; 4] = std::array::from_fn(|k| {
            let [a, b, c] = TRIPLES[k];
            let bent = u.second(&pair(a, b), &along(c)) + u.second(&pair(a, c), &along(b));
            f * third[k] + bent + u.second(&pair(b, c), &along(a)) + u.third(&along(a), &along(b), &along(c))
        });
        Chart { first, second, now: (now_1, now_2, now_3) }
    }

    /// First and second derivatives of a function along the coordinates.
    pub fn slopes(&self, jet: &FunctionJet<D>) -> ([f64; 2], [f64; 3]) {
        let along = |a: usize| self.first.get(a).copied().unwrap_or_else(Vector::<D>::zeros);
        let first = [0, 1].map(|a| jet.gradient.dot(&along(a)));
        let second = std::array::from_fn(|k| {
            let [a, b] = PAIRS[k];
            jet.gradient.dot(&self.second[k]) + along(a).dot(&(jet.hessian * along(b)))
        });
        (first, second)
    }
}

/// An orthonormal basis of the directions across some vectors: the coordinate axes that are least along them, in order.
pub(super) fn across<const D: usize>(vectors: &[Vector<D>]) -> Vec<Vector<D>> {
    let mut basis: Vec<Vector<D>> = Vec::with_capacity(D);
    let reduce = |mut v: Vector<D>, basis: &[Vector<D>]| {
        // Twice is enough for round-off.
        for _ in 0..2 {
            basis.iter().for_each(|b| v -= b * b.dot(&v));
        }
        v
    };
    for v in vectors {
        if let Some(unit) = reduce(*v, &basis).try_normalize(1e-12 * v.norm()) {
            basis.push(unit);
        }
    }
    let given = basis.len();
    while basis.len() < D {
        let axis = |k: usize| Vector::<D>::from_fn(|i, _| f64::from(u8::from(i == k)));
        let candidates = (0..D).map(|k| reduce(axis(k), &basis));
        let best = candidates.max_by(|a, b| a.norm().total_cmp(&b.norm()).then(std::cmp::Ordering::Greater));
        let Some(unit) = best.and_then(|b| b.try_normalize(0.0)) else { break };
        basis.push(unit);
    }
    basis.split_off(given.min(basis.len()))
}
