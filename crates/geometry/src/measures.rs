//! The measures of a contact pair at its closest points, with their first and second variations.
//!
//! One template serves all six pairs. With `D = x_A - x_B` and internal coordinates `ξ^a`, `a = 1..N`, stationary where
//! `D·J_a = 0`, `J_a = ∂D/∂ξ^a`, the gap is `g = D·n` along the fixed unit vector `n = ±D/|D|`, and
//!
//! - `a_ab = J_a·J_b`, `H_ab = n·D_ab`, `A_ab = a_ab + g H_ab`;
//! - `δg = n·δD`, `δξ = -A⁻¹ (w + g β)` with `w_a = J_a·δD`, `β_a = n·δD_a`;
//! - `Δδg = wᵀA⁻¹H a⁻¹w - wᵀA⁻¹β - βᵀA⁻¹w - g βᵀA⁻¹β + (1/g) δD·P⊥Δ D`, `P⊥ = I - n nᵀ - Jᵀa⁻¹J`.
//!
//! `δD` and `δD_a` are variations at fixed coordinates: whoever owns the shapes inserts its shape functions there. The
//! formulas hold for any gap, zero included where `P⊥` vanishes (pairs with a surface, and crossing curves).

use crate::shape::{CurveJet, SurfaceJet};
use crate::{Point, Vector};
use nalgebra::{SMatrix, SVector};

/// A partner of a pair as the measures see it: position and derivatives in up to two coordinates.
#[derive(Clone, Copy, Debug)]
pub enum PartnerJet<'a> {
    /// A point, or a point of a shape whose coordinate is given (a quadrature point).
    Point(&'a Point<3>),
    Curve(&'a CurveJet),
    Surface(&'a SurfaceJet),
}

impl PartnerJet<'_> {
    /// Number of coordinates.
    pub fn dimension(&self) -> usize {
        match self {
            PartnerJet::Point(_) => 0,
            PartnerJet::Curve(_) => 1,
            PartnerJet::Surface(_) => 2,
        }
    }

    fn position(&self) -> Point<3> {
        match self {
            PartnerJet::Point(p) => **p,
            PartnerJet::Curve(c) => c.x,
            PartnerJet::Surface(s) => s.x,
        }
    }

    fn first(&self, a: usize) -> Vector<3> {
        match self {
            PartnerJet::Point(_) => Vector::<3>::zeros(),
            PartnerJet::Curve(c) => c.d1,
            PartnerJet::Surface(s) => [s.u, s.v][a],
        }
    }

    fn second(&self, a: usize, b: usize) -> Vector<3> {
        match self {
            PartnerJet::Point(_) => Vector::<3>::zeros(),
            PartnerJet::Curve(c) => c.d2,
            PartnerJet::Surface(s) => [s.uu, s.uv, s.vv][a + b],
        }
    }

    fn third(&self, a: usize, b: usize, c: usize) -> Vector<3> {
        match self {
            PartnerJet::Point(_) => Vector::<3>::zeros(),
            PartnerJet::Curve(j) => j.d3,
            PartnerJet::Surface(s) => [s.uuu, s.uuv, s.uvv, s.vvv][a + b + c],
        }
    }
}

/// A variation of a pair at fixed internal coordinates: of `D`, of its first and of its second derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variation<const N: usize> {
    pub d: Vector<3>,
    pub d_a: [Vector<3>; N],
    pub d_ab: [[Vector<3>; N]; N],
}

/// The measures of a pair with `N` internal coordinates: those of the first partner, then those of the second.
#[derive(Clone, Debug)]
pub struct Measures<const N: usize> {
    pub d: Vector<3>,
    pub normal: Vector<3>,
    pub gap: f64,
    j: [Vector<3>; N],
    d_ab: [[Vector<3>; N]; N],
    d_abc: [[[Vector<3>; N]; N]; N],
    metric: SMatrix<f64, N, N>,
    inverse_metric: SMatrix<f64, N, N>,
    curvature: SMatrix<f64, N, N>,
    inverse: SMatrix<f64, N, N>,
}

impl<const N: usize> Measures<N> {
    /// The measures at closest points of two partners; `normal` is the unit vector along which the gap counts.
    ///
    /// `None` where the pair is on a focal set or has parallel tangents: its coordinates do not exist there.
    ///
    /// # Panics
    /// If `N` is not the number of coordinates of both partners.
    pub fn new(a: PartnerJet<'_>, b: PartnerJet<'_>, normal: Vector<3>) -> Option<Self> {
        let of_a = a.dimension();
        assert_eq!(of_a + b.dimension(), N, "a pair has the coordinates of both partners");
        let same = |indices: &[usize]| {
            if indices.iter().all(|&k| k < of_a) {
                Some(true)
            } else if indices.iter().all(|&k| k >= of_a) {
                Some(false)
            } else {
                None
            }
        };
        let local = |k: usize| if k < of_a { k } else { k - of_a };
        let zero = Vector::<3>::zeros();
        let d = a.position() - b.position();
        let j: [Vector<3>; N] = std::array::from_fn(|p| if p < of_a { a.first(p) } else { -b.first(p - of_a) });
        let d_ab: [[Vector<3>; N]; N] = std::array::from_fn(|p| {
            std::array::from_fn(|q| match same(&[p, q]) {
                Some(true) => a.second(p, q),
                Some(false) => -b.second(local(p), local(q)),
                None => zero,
            })
        });
        let d_abc: [[[Vector<3>; N]; N]; N] = std::array::from_fn(|p| {
            std::array::from_fn(|q| {
                std::array::from_fn(|r| match same(&[p, q, r]) {
                    Some(true) => a.third(p, q, r),
                    Some(false) => -b.third(local(p), local(q), local(r)),
                    None => zero,
                })
            })
        });
        let gap = d.dot(&normal);
        let metric = SMatrix::<f64, N, N>::from_fn(|p, q| j[p].dot(&j[q]));
        let curvature = SMatrix::<f64, N, N>::from_fn(|p, q| normal.dot(&d_ab[p][q]));
        let whole = metric + curvature * gap;
        let invert = |m: &SMatrix<f64, N, N>| -> Option<SMatrix<f64, N, N>> {
            if N == 0 {
                return Some(*m);
            }
            let lu = nalgebra::DMatrix::from_fn(N, N, |p, q| m[(p, q)]).lu();
            let inverse = lu.try_inverse()?;
            let finite = inverse.iter().all(|v| v.is_finite());
            finite.then(|| SMatrix::from_fn(|p, q| inverse[(p, q)]))
        };
        // A pair of more than three coordinates, or of tangents that depend on each other, has a singular metric; its
        // gap still varies, only the part of the curvature needs the metric.
        let inverse_metric = invert(&metric).filter(|_| N <= 2).unwrap_or_else(SMatrix::zeros);
        let inverse = invert(&whole)?;
        Some(Measures { d, normal, gap, j, d_ab, d_abc, metric, inverse_metric, curvature, inverse })
    }

    fn w(&self, v: &Variation<N>) -> SVector<f64, N> {
        SVector::from_fn(|a, _| self.j[a].dot(&v.d))
    }

    fn beta(&self, v: &Variation<N>) -> SVector<f64, N> {
        SVector::from_fn(|a, _| self.normal.dot(&v.d_a[a]))
    }

    /// `J_a·J_b`.
    pub fn metric(&self) -> &SMatrix<f64, N, N> {
        &self.metric
    }

    /// `A_ab = J_a·J_b + D·D_ab`: positive definite inside the projection domain.
    pub fn hessian(&self) -> SMatrix<f64, N, N> {
        self.metric + self.curvature * self.gap
    }

    /// `δg`.
    pub fn gap_variation(&self, v: &Variation<N>) -> f64 {
        self.normal.dot(&v.d)
    }

    /// `δξ`.
    pub fn coordinate_variation(&self, v: &Variation<N>) -> SVector<f64, N> {
        -(self.inverse * (self.w(v) + self.beta(v) * self.gap))
    }

    /// `Δδg` for two variations that are linear in the unknowns (`Δδ D = 0`); add `n·Δδ D` otherwise.
    pub fn gap_second_variation(&self, v: &Variation<N>, u: &Variation<N>) -> f64 {
        // From F = g²/2: g Δδg + δg Δg = Δδ F, with the Schur complement of the coordinates; written so that no
        // division by the gap is left where J and n span space.
        let (wv, wu) = (self.w(v), self.w(u));
        let (bv, bu) = (self.beta(v), self.beta(u));
        let rotation = wv.dot(&(self.inverse * bu)) + bv.dot(&(self.inverse * wu));
        let finite_gap = self.gap * bv.dot(&(self.inverse * bu));
        if N <= 2 {
            let curvature = wv.dot(&(self.inverse * self.curvature * self.inverse_metric * wu));
            let mut across =
                v.d.dot(&u.d) - self.normal.dot(&v.d) * self.normal.dot(&u.d) - wv.dot(&(self.inverse_metric * wu));
            if N == 2 {
                across = 0.0;
            }
            let across = if across == 0.0 { 0.0 } else { across / self.gap };
            curvature - rotation - finite_gap + across
        } else {
            // J and n more than span space: the difference quotient in g stays, the gap must not vanish.
            let tangential = v.d.dot(&u.d) - self.normal.dot(&v.d) * self.normal.dot(&u.d);
            (tangential - wv.dot(&(self.inverse * wu))) / self.gap - rotation - finite_gap
        }
    }

    /// `Δδg` of all pairs out of a list of variations, row by row: a symmetric matrix.
    pub fn gap_hessian(&self, list: &[Variation<N>]) -> Vec<f64> {
        let n = list.len();
        let w: Vec<SVector<f64, N>> = list.iter().map(|v| self.w(v)).collect();
        let beta: Vec<SVector<f64, N>> = list.iter().map(|v| self.beta(v)).collect();
        let inverse_beta: Vec<SVector<f64, N>> = beta.iter().map(|b| self.inverse * b).collect();
        let shape = self.inverse * self.curvature * self.inverse_metric;
        let curved: Vec<SVector<f64, N>> = w.iter().map(|w| shape * w).collect();
        let mut out = vec![0.0; n * n];
        for r in 0..n {
            for c in 0..=r {
                let value = if N == 2 {
                    w[r].dot(&curved[c])
                        - w[r].dot(&inverse_beta[c])
                        - inverse_beta[r].dot(&w[c])
                        - self.gap * beta[r].dot(&inverse_beta[c])
                } else {
                    self.gap_second_variation(&list[r], &list[c])
                };
                out[r * n + c] = value;
                out[c * n + r] = value;
            }
        }
        out
    }

    /// `Δδξ` for two variations that are linear in the unknowns.
    pub fn coordinate_second_variation(&self, v: &Variation<N>, u: &Variation<N>) -> SVector<f64, N> {
        let (xv, xu) = (self.coordinate_variation(v), self.coordinate_variation(u));
        let total = |k: &Variation<N>, x: &SVector<f64, N>| {
            let mut d = k.d;
            let mut j = k.d_a;
            for a in 0..N {
                d += self.j[a] * x[a];
                for b in 0..N {
                    j[a] += self.d_ab[a][b] * x[b];
                }
            }
            (d, j)
        };
        let ((dv, jv), (du, ju)) = (total(v, &xv), total(u, &xu));
        let rhs = SVector::<f64, N>::from_fn(|a, _| {
            let mut sum = dv.dot(&ju[a]) + du.dot(&jv[a]);
            for b in 0..N {
                sum += (self.j[a].dot(&v.d_a[b]) + self.d.dot(&v.d_ab[a][b])) * xu[b];
                sum += (self.j[a].dot(&u.d_a[b]) + self.d.dot(&u.d_ab[a][b])) * xv[b];
                for c in 0..N {
                    sum += (self.j[a].dot(&self.d_ab[b][c]) + self.d.dot(&self.d_abc[a][b][c])) * xv[b] * xu[c];
                }
            }
            sum
        });
        -(self.inverse * rhs)
    }
}
