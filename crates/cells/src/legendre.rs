//! Integrated Legendre functions of one direction (Szabó & Babuška, *Finite Element Analysis*, 1991).
//!
//! `N_0 = (1 - ξ)/2`, `N_1 = (1 + ξ)/2`, `N_k = (P_k - P_{k-2})/√(4k - 2)`, `N_k' = √((2k - 1)/2) P_{k-1}`. They are
//! polynomials, known beyond the cell too.

/// The highest degree.
pub const MAX_DEGREE: usize = 8;

/// Value and slope of the functions `0..=degree` at `ξ`; entries beyond are zero.
pub fn integrated_legendre(degree: usize, xi: f64) -> [[f64; 2]; MAX_DEGREE + 1] {
    let mut out = [[0.0; 2]; MAX_DEGREE + 1];
    out[0] = [0.5 * (1.0 - xi), -0.5];
    out[1] = [0.5 * (1.0 + xi), 0.5];
    let (mut before, mut last) = (1.0, xi);
    for k in 2..=degree {
        let n = k as f64;
        let next = ((2.0 * n - 1.0) * xi * last - (n - 1.0) * before) / n;
        out[k] = [(next - before) / (4.0 * n - 2.0).sqrt(), (n - 0.5).sqrt() * last];
        (before, last) = (last, next);
    }
    out
}

/// Value and the first three derivatives of the functions `0..=degree` at `ξ`; entries beyond are zero.
///
/// `P_k' = (2k - 1) P_{k-1} + P_{k-2}'`, and the same once more for the second derivatives.
pub fn integrated_legendre_jets(degree: usize, xi: f64) -> [[f64; 4]; MAX_DEGREE + 1] {
    let mut out = [[0.0; 4]; MAX_DEGREE + 1];
    for (k, [value, slope]) in integrated_legendre(degree, xi).into_iter().enumerate() {
        (out[k][0], out[k][1]) = (value, slope);
    }
    // Legendre polynomials with two derivatives.
    let mut p = [[0.0; 3]; MAX_DEGREE + 1];
    p[0] = [1.0, 0.0, 0.0];
    p[1] = [xi, 1.0, 0.0];
    for k in 2..=degree {
        let n = k as f64;
        p[k][0] = ((2.0 * n - 1.0) * xi * p[k - 1][0] - (n - 1.0) * p[k - 2][0]) / n;
        p[k][1] = (2.0 * n - 1.0) * p[k - 1][0] + p[k - 2][1];
        p[k][2] = (2.0 * n - 1.0) * p[k - 1][1] + p[k - 2][2];
        out[k][2] = (n - 0.5).sqrt() * p[k - 1][1];
        out[k][3] = (n - 0.5).sqrt() * p[k - 1][2];
    }
    out
}
