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
    /// Bound of `(J t)·(D_αβ t_α t_β)`, the cubic part of `|D|²`.
    cubic: f64,
}

/// The distance of the boxes around two cells.
#[inline]
pub fn box_bound<const A: usize, const B: usize>(a: &Cell<A>, b: &Cell<B>) -> f64 {
    let apart = (a.hull[0] - b.hull[1]).sup(&(b.hull[0] - a.hull[1]));
    apart.map(|x| x.max(0.0)).norm()
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
    pub fn linear_bound<const A: usize, const B: usize>(&self, a: &Cell<A>, b: &Cell<B>) -> f64 {
        let remainder = a.rho2 + b.rho2;
        let quadratic = 2.0 * least(&self.g, &self.gram);
        let squared = self.distance * self.distance + quadratic;
        let mut bound = squared.max(0.0).sqrt();
        if N > 1 {
            // The support plane: less when the parallelograms are long, more when they are skew.
            let slope: f64 = self.g.iter().map(|g| g.abs()).sum();
            bound = bound.max(self.distance - slope / self.distance.max(f64::MIN_POSITIVE));
        }
        if N > 2 {
            // Planes along the surfaces separate what lies close together side by side.
            for normal in [&a.normal, &b.normal] {
                let mut slope = 0.0;
                for j in &a.j {
                    slope += normal.dot(j).abs();
                }
                for j in &b.j {
                    slope += normal.dot(j).abs();
                }
                bound = bound.max(normal.dot(&self.d).abs() - slope);
            }
        }
        bound - remainder
    }

    /// The bound of the plane with unit normal `e`, with the curvature of the cells seen along it.
    #[inline]
    fn plane_bound<const A: usize, const B: usize>(&self, e: &Vector<3>, a: &Cell<A>, b: &Cell<B>) -> f64 {
        let height = e.dot(&self.d);
        let sign = if height < 0.0 { -1.0 } else { 1.0 };
        let mut g = [0.0; N];
        let mut h = [[0.0; N]; N];
        for p in 0..A {
            g[p] = e.dot(&a.j[p]);
            for q in 0..A {
                h[p][q] = sign * e.dot(&a.dd[p][q]);
            }
        }
        for p in 0..B {
            g[A + p] = e.dot(&b.j[p]);
            for q in 0..B {
                h[A + p][A + q] = -sign * e.dot(&b.dd[p][q]);
            }
        }
        height.abs() + least(&g, &h)
    }

    /// The Hessian and how far it moves: `J_α = j_α + Σ dd_αγ t_γ + e_α` with `|e_α| ≤ eta_α`, and likewise for `D` and
    /// its second derivatives. What is linear in `t` enters with its exact coefficients `j·dd`, which are small where
    /// the parameter lines bend along the normal only; the rest is of second order in the cell size.
    #[inline]
    pub fn second_order<const A: usize, const B: usize>(&self, a: &Cell<A>, b: &Cell<B>) -> SecondOrder<N> {
        // t[p][q][r] = J_p · D_qr, zero unless q and r belong to the same partner.
        let mut t = [[[0.0; N]; N]; N];
        for q in 0..A {
            for r in 0..A {
                for p in 0..A {
                    t[p][q][r] = a.j_dd[p][q][r];
                }
                for p in 0..B {
                    t[A + p][q][r] = -b.j[p].dot(&a.dd[q][r]);
                }
            }
        }
        for q in 0..B {
            for r in 0..B {
                for p in 0..A {
                    t[p][A + q][A + r] = -a.j[p].dot(&b.dd[q][r]);
                }
                for p in 0..B {
                    t[A + p][A + q][A + r] = b.j_dd[p][q][r];
                }
            }
        }
        let (mut norm, mut sigma, mut eta) = ([0.0; N], [0.0; N], [0.0; N]);
        for k in 0..A {
            (norm[k], sigma[k], eta[k]) = (a.j_norm[k], a.sigma[k], a.eta[k]);
        }
        for k in 0..B {
            (norm[A + k], sigma[A + k], eta[A + k]) = (b.j_norm[k], b.sigma[k], b.eta[k]);
        }
        let farthest = self.distance + a.radius() + b.radius();
        let bend = a.rho2 + b.rho2;
        let mut hessian = self.gram;
        let mut drift = [[0.0; N]; N];
        let mut cubic = 0.0;
        for p in 0..N {
            for q in 0..=p {
                let linear: f64 = (0..N).map(|r| (t[p][q][r] + t[q][p][r] + t[r][p][q]).abs()).sum();
                cubic += if p == q { linear } else { 2.0 * linear } / 3.0;
                drift[p][q] = linear + norm[p] * eta[q] + norm[q] * eta[p] + sigma[p] * sigma[q];
                if p < A {
                    hessian[p][q] += self.d.dot(&a.dd[p][q]);
                    drift[p][q] += bend * a.dd_norm[p][q] + farthest * a.tau[p][q];
                } else if q >= A {
                    hessian[p][q] -= self.d.dot(&b.dd[p - A][q - A]);
                    drift[p][q] += bend * b.dd_norm[p - A][q - A] + farthest * b.tau[p - A][q - A];
                }
                hessian[q][p] = hessian[p][q];
                drift[q][p] = drift[p][q];
            }
        }
        SecondOrder { hessian, drift, cubic }
    }

    /// Lower bound of the distance from the expansion to second order; its error is of third order in the cell size.
    #[inline]
    pub fn quadratic_bound<const A: usize, const B: usize>(
        &self,
        second: &SecondOrder<N>,
        a: &Cell<A>,
        b: &Cell<B>,
    ) -> f64 {
        let mut lowest = least(&self.g, &second.hessian);
        if N > 2 {
            // Tangents of facing surfaces depend on each other, which the diagonal cannot see.
            if let Some(reduction) = newton_decrement(second.hessian, self.g) {
                let slope: f64 = self.g.iter().map(|g| g.abs()).sum();
                lowest = lowest.max(-slope).max(-0.5 * reduction);
            }
        }
        let squared = self.distance * self.distance + 2.0 * lowest - second.cubic;
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
        if N > 2 {
            bound = bound.max(self.plane_bound(&a.normal, a, b)).max(self.plane_bound(&b.normal, a, b));
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

impl<const N: usize> SecondOrder<N> {
    /// Whether `F` certainly grows along one direction everywhere in the cells, so that they hold no minimiser.
    ///
    /// The direction is that of Newton: `v = H⁻¹ g`, the test says that the Newton point lies outside by a margin. Where
    /// cells touch a side behind which there is no neighbour (`held[p]` is the outward sign), `-v` must not leave there;
    /// such parameters are taken out.
    ///
    /// `motion[p]` is how far the gradient may move besides, through `∂F/∂t_p`: zero for the cells as they are.
    pub fn excludes_stationary(
        &self,
        gram: &[[f64; N]; N],
        g: &[f64; N],
        free: &[bool; N],
        held: &[[bool; 2]; N],
        motion: &[f64; N],
    ) -> bool {
        let mut used = *free;
        for _ in 0..=N {
            let Some(v) = self.descent(gram, g, &used) else { return false };
            // -v leaves through the low side where v > 0.
            let leaving = (0..N).find(|&p| used[p] && ((v[p] > 0.0 && held[p][0]) || (v[p] < 0.0 && held[p][1])));
            if let Some(p) = leaving {
                used[p] = false;
                continue;
            }
            let mut margin = 0.0;
            for p in 0..N {
                let mut curvature = 0.0;
                for q in 0..N {
                    curvature += self.hessian[p][q] * v[q];
                    margin -= v[q].abs() * self.drift[p][q];
                }
                margin += g[p] * v[p] - curvature.abs() - motion[p] * v[p].abs();
            }
            return margin > 0.0;
        }
        false
    }

    /// `H⁻¹ g` on the parameters in use, or with the Gram matrix where `H` is not positive definite.
    fn descent(&self, gram: &[[f64; N]; N], g: &[f64; N], used: &[bool; N]) -> Option<[f64; N]> {
        let solve = |matrix: &[[f64; N]; N], lift: f64| {
            let mut m = *matrix;
            let mut rhs = *g;
            for p in 0..N {
                m[p][p] *= 1.0 + lift;
                if !used[p] {
                    m[p] = [0.0; N];
                    for row in &mut m {
                        row[p] = 0.0;
                    }
                    m[p][p] = 1.0;
                    rhs[p] = 0.0;
                }
            }
            super::newton::solve_positive_definite(m, rhs)
        };
        solve(&self.hessian, 0.0).or_else(|| solve(gram, 0.1))
    }
}

/// `g·H⁻¹g` where `H` is positive definite: twice what the quadratic can lose anywhere.
fn newton_decrement<const N: usize>(mut h: [[f64; N]; N], mut g: [f64; N]) -> Option<f64> {
    let mut sum = 0.0;
    for k in 0..N {
        let pivot = h[k][k];
        if pivot.is_nan() || pivot <= 0.0 {
            return None;
        }
        sum += g[k] * g[k] / pivot;
        for i in k + 1..N {
            let factor = h[i][k] / pivot;
            for j in k + 1..N {
                h[i][j] -= factor * h[k][j];
            }
            g[i] -= factor * g[k];
        }
    }
    Some(sum)
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
