//! Taylor coefficients of polynomial and rational curves and surfaces, by Horner's scheme.

use super::bernstein::Control;
use crate::Vector;

/// The vector of a homogeneous coefficient, without its weight.
fn xyz(c: &Control) -> Vector<3> {
    Vector::<3>::new(c[0], c[1], c[2])
}

/// Taylor coefficients (value, derivative, second derivative / 2, ...) of a vector polynomial.
#[inline]
pub(super) fn horner_curve<const K: usize>(c: &[Control], s: f64) -> [Control; K] {
    let mut out = [[0.0; 4]; K];
    for row in c.iter().rev() {
        for k in (1..K).rev() {
            for m in 0..4 {
                out[k][m] = out[k][m] * s + out[k - 1][m];
            }
        }
        for m in 0..4 {
            out[0][m] = out[0][m] * s + row[m];
        }
    }
    out
}

/// Derivatives of `P / w` from Taylor coefficients of both.
#[inline]
pub(super) fn quotient_curve<const K: usize>(taylor: [Control; K], rational: bool) -> [Vector<3>; K] {
    let mut x = [Vector::<3>::zeros(); K];
    let mut factorial = 1.0;
    let inverse = if rational { 1.0 / taylor[0][3] } else { 1.0 };
    for k in 0..K {
        let mut value = xyz(&taylor[k]);
        if rational {
            for j in 0..k {
                value -= x[j] * taylor[k - j][3];
            }
        }
        x[k] = value * inverse;
    }
    for (k, value) in x.iter_mut().enumerate() {
        factorial *= k.max(1) as f64;
        *value *= factorial;
    }
    x
}

/// Taylor coefficients `out[a][b]` of order `a` in the first and `b` in the second parameter, `a + b < K`.
#[inline]
pub(super) fn horner_surface<const K: usize>(degree: [usize; 2], c: &[Control], s: &[f64; 2]) -> [[Control; K]; K] {
    let mut out = [[[0.0; 4]; K]; K];
    for row in c.chunks_exact(degree[1] + 1).rev() {
        let r = horner_curve::<K>(row, s[1]);
        for a in (1..K).rev() {
            for b in 0..K - a {
                for m in 0..4 {
                    out[a][b][m] = out[a][b][m] * s[0] + out[a - 1][b][m];
                }
            }
        }
        for b in 0..K {
            for m in 0..4 {
                out[0][b][m] = out[0][b][m] * s[0] + r[b][m];
            }
        }
    }
    out
}

/// Taylor coefficients of `P / w`.
#[inline]
pub(super) fn quotient_surface<const K: usize>(t: &[[Control; K]; K], rational: bool) -> [[Vector<3>; K]; K] {
    let mut x = [[Vector::<3>::zeros(); K]; K];
    let inverse = if rational { 1.0 / t[0][0][3] } else { 1.0 };
    for order in 0..K {
        for a in 0..=order {
            let b = order - a;
            let mut value = xyz(&t[a][b]);
            if rational {
                for i in 0..=a {
                    for j in 0..=b {
                        if i + j < order {
                            value -= x[i][j] * t[a - i][b - j][3];
                        }
                    }
                }
            }
            x[a][b] = value * inverse;
        }
    }
    x
}
