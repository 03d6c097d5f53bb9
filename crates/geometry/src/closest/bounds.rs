//! Lower bounds of the distance of two cells, and certificates of convexity and monotonicity.
//!
//! With `D = x_A - x_B`, `J` its derivative with respect to all `N` parameters and `F = ½ D·D`: the gradient is
//! `g = J·D`, the Hessian `H_αβ = J_α·J_β + D·D_αβ`. Parameters are local to the cells, `t` in `[-1, 1]^N`. The
//! expansions and their remainders come with the cells ([`crate::patch::Cell`]); every bound here is rigorous up to
//! rounding, which the caller adds to its tolerances.

use crate::Vector;
use crate::patch::Cell;

/// The expansion of the difference vector over a pair of cells.
pub struct PairExpansion<const N: usize> {
    pub d: Vector<3>,
    pub distance: f64,
    pub g: [f64; N],
    pub gram: [[f64; N]; N],
}

/// What convexity needs beyond [`PairExpansion`].
pub struct SecondOrder<const N: usize> {
    /// Hessian at the middle of the cells.
    pub hessian: [[f64; N]; N],
    /// How far the entries of the Hessian move over the cells.
    pub drift: [[f64; N]; N],
}

impl<const N: usize> PairExpansion<N> {
    #[inline]
    pub fn new<const A: usize, const B: usize>(a: &Cell<A>, b: &Cell<B>) -> Self {
        let d = a.x - b.x;
        let mut j = [Vector::<3>::zeros(); N];
        j[..A].copy_from_slice(&a.j);
        for k in 0..B {
            j[A + k] = -b.j[k];
        }
        let mut g = [0.0; N];
        let mut gram = [[0.0; N]; N];
        for p in 0..N {
            g[p] = j[p].dot(&d);
            for q in 0..=p {
                gram[p][q] = j[p].dot(&j[q]);
                gram[q][p] = gram[p][q];
            }
        }
        PairExpansion { d, distance: d.norm(), g, gram }
    }

    /// Lower bound of the distance from the linear parts: the distance of two parallelograms, less both remainders.
    #[inline]
    pub fn linear_bound(&self, remainder: f64) -> f64 {
        let quadratic = 2.0 * least(&self.g, &self.gram);
        let squared = self.distance * self.distance + quadratic;
        let mut bound = squared.max(0.0).sqrt();
        if N > 1 {
            // The support plane: less when the parallelograms are long, more when they are skew.
            let slope: f64 = self.g.iter().map(|g| g.abs()).sum();
            bound = bound.max(self.distance - slope / self.distance.max(f64::MIN_POSITIVE));
        }
        bound - remainder
    }

    #[inline]
    pub fn second_order<const A: usize, const B: usize>(&self, a: &Cell<A>, b: &Cell<B>) -> SecondOrder<N> {
        let mut hessian = self.gram;
        let mut drift = [[0.0; N]; N];
        let spread = a.radius() + b.radius();
        let (mut norm, mut sigma) = ([0.0; N], [0.0; N]);
        for k in 0..A {
            (norm[k], sigma[k]) = (a.j_norm[k], a.sigma[k]);
        }
        for k in 0..B {
            (norm[A + k], sigma[A + k]) = (b.j_norm[k], b.sigma[k]);
        }
        for p in 0..N {
            for q in 0..=p {
                drift[p][q] = norm[p] * sigma[q] + norm[q] * sigma[p] + sigma[p] * sigma[q];
                if p < A && q < A {
                    hessian[p][q] += self.d.dot(&a.dd[p][q]);
                    drift[p][q] += spread * (a.dd_norm[p][q] + a.tau[p][q]) + self.distance * a.tau[p][q];
                } else if p >= A && q >= A {
                    let (p, q) = (p - A, q - A);
                    hessian[A + p][A + q] -= self.d.dot(&b.dd[p][q]);
                    drift[A + p][A + q] += spread * (b.dd_norm[p][q] + b.tau[p][q]) + self.distance * b.tau[p][q];
                }
                hessian[q][p] = hessian[p][q];
                drift[q][p] = drift[p][q];
            }
        }
        SecondOrder { hessian, drift }
    }

    /// Lower bound of the distance from the expansion to second order; its error is of third order in the cell size.
    #[inline]
    pub fn quadratic_bound<const A: usize, const B: usize>(
        &self,
        second: &SecondOrder<N>,
        a: &Cell<A>,
        b: &Cell<B>,
    ) -> f64 {
        let bend: f64 = a.dd_norm.iter().flatten().sum::<f64>() + b.dd_norm.iter().flatten().sum::<f64>();
        let slope: f64 = a.j_norm.iter().sum::<f64>() + b.j_norm.iter().sum::<f64>();
        let squared = self.distance * self.distance + 2.0 * least(&self.g, &second.hessian) - slope * bend;
        let mut bound = squared.max(0.0).sqrt();
        if N > 1 && self.distance > 0.0 {
            // The support plane with its curvature: H - gram is D·D_αβ.
            let mut curvature = second.hessian;
            for p in 0..N {
                for q in 0..N {
                    curvature[p][q] -= self.gram[p][q];
                }
            }
            bound = bound.max(self.distance + least(&self.g, &curvature) / self.distance);
        }
        bound - a.rho3 - b.rho3
    }
}

/// A lower bound of `g·t + ½ t·H t` over `|t_α| ≤ 1`; exact where `H` is diagonal.
#[inline]
fn least<const N: usize>(g: &[f64; N], h: &[[f64; N]; N]) -> f64 {
    let mut sum = 0.0;
    for p in 0..N {
        let mut c = h[p][p];
        for q in 0..N {
            if q != p {
                c -= h[p][q].abs();
            }
        }
        let slope = g[p].abs();
        sum -= if slope < c { 0.5 * slope * slope / c } else { slope - 0.5 * c };
    }
    sum
}

impl<const N: usize> SecondOrder<N> {
    /// Whether `F` is certainly strictly convex over the free parameters (`free` is false where a cell has no width).
    #[inline]
    pub fn is_convex(&self, free: &[bool; N]) -> bool {
        let mut lower = self.hessian;
        for p in 0..N {
            if !free[p] {
                for q in 0..N {
                    lower[p][q] = 0.0;
                    lower[q][p] = 0.0;
                }
                lower[p][p] = 1.0;
                continue;
            }
            for q in 0..N {
                lower[p][p] -= self.drift[p][q];
            }
        }
        is_positive_definite(lower)
    }

    /// The sign of `∂F/∂t_α` where it is the same over both cells, else zero.
    #[inline]
    pub fn slope_sign(&self, g: &[f64; N], p: usize) -> i8 {
        let spread: f64 = (0..N).map(|q| self.hessian[p][q].abs() + self.drift[p][q]).sum();
        if g[p] > spread {
            1
        } else if g[p] < -spread {
            -1
        } else {
            0
        }
    }
}

fn is_positive_definite<const N: usize>(mut m: [[f64; N]; N]) -> bool {
    for k in 0..N {
        let pivot = m[k][k];
        if pivot.is_nan() || pivot <= 0.0 {
            return false;
        }
        for i in k + 1..N {
            let factor = m[i][k] / pivot;
            for j in k + 1..N {
                m[i][j] -= factor * m[k][j];
            }
        }
    }
    true
}
