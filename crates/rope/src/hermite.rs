//! Shape functions of one element in `ξ ∈ [0, 1]`, `s = h ξ`, and rules of integration.
//!
//! The centreline is a cubic Hermite curve, `r = H_0 r_1 + h H_1 t_1 + H_2 r_2 + h H_3 t_2`: its nodes carry the position
//! `r` and the derivative `t = dr/ds`, so it is C1. Rotations are quadratic: two nodes and the middle.

use signorini_geometry::{Point, Vector};

/// The four cubic functions, in the order `r_1, t_1, r_2, t_2`.
pub fn cubic(xi: f64, h: f64) -> [f64; 4] {
    let (x, y) = (xi, 1.0 - xi);
    [y * y * (1.0 + 2.0 * x), h * x * y * y, x * x * (3.0 - 2.0 * x), -h * x * x * y]
}

/// Their first derivatives in `ξ`.
pub fn cubic_first(xi: f64, h: f64) -> [f64; 4] {
    let x = xi;
    [6.0 * x * (x - 1.0), h * (1.0 - x) * (1.0 - 3.0 * x), 6.0 * x * (1.0 - x), h * x * (3.0 * x - 2.0)]
}

/// Their second derivatives in `ξ`.
pub fn cubic_second(xi: f64, h: f64) -> [f64; 4] {
    let x = xi;
    [12.0 * x - 6.0, h * (6.0 * x - 4.0), 6.0 - 12.0 * x, h * (6.0 * x - 2.0)]
}

/// Their third derivatives in `ξ`.
pub fn cubic_third(h: f64) -> [f64; 4] {
    [12.0, 6.0 * h, -12.0, 6.0 * h]
}

/// The three quadratic functions, in the order first node, last node, middle.
pub fn quadratic(xi: f64) -> [f64; 3] {
    [(1.0 - xi) * (1.0 - 2.0 * xi), xi * (2.0 * xi - 1.0), 4.0 * xi * (1.0 - xi)]
}

/// Their first derivatives in `ξ`.
pub fn quadratic_first(xi: f64) -> [f64; 3] {
    [4.0 * xi - 3.0, 4.0 * xi - 1.0, 4.0 - 8.0 * xi]
}

/// Two Gauss points of `[0, 1]` and their weights.
pub const TWO: [(f64, f64); 2] = [(0.211_324_865_405_187_1, 0.5), (0.788_675_134_594_812_9, 0.5)];

/// Three Gauss points.
pub const THREE: [(f64, f64); 3] = [
    (0.112_701_665_379_258_31, 0.277_777_777_777_777_8),
    (0.5, 0.444_444_444_444_444_4),
    (0.887_298_334_620_741_7, 0.277_777_777_777_777_8),
];

/// Four Gauss points.
pub const FOUR: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// Gauss points of `[0, 1]` with their weights, as many as wanted: roots of the Legendre polynomial by Newton's method.
pub fn gauss(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    (0..count)
        .map(|k| {
            let mut x = -(std::f64::consts::PI * (k as f64 + 0.75) / (n + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..20 {
                let (mut p, mut before) = (1.0, 0.0);
                for j in 0..count {
                    let j = j as f64;
                    (p, before) = (((2.0 * j + 1.0) * x * p - j * before) / (j + 1.0), p);
                }
                slope = n * (x * p - before) / (x * x - 1.0);
                let dx = p / slope;
                x -= dx;
                if dx.abs() < 1e-15 {
                    break;
                }
            }
            (0.5 * (1.0 + x), 1.0 / ((1.0 - x * x) * slope * slope))
        })
        .collect()
}

/// Lobatto points of `[0, 1]` with their weights, as many as wanted, both ends among them: exact to the degree of one Gauss
/// point less. Roots of the derivative of the Legendre polynomial by Newton's method.
pub fn lobatto(count: usize) -> Vec<(f64, f64)> {
    let count = count.max(2);
    let n = (count - 1) as f64;
    (0..count)
        .map(|k| {
            let mut x = -(std::f64::consts::PI * k as f64 / n).cos();
            let mut p = 1.0;
            for _ in 0..40 {
                let before = legendre(count - 2, x);
                p = legendre(count - 1, x);
                let dx = (x * p - before) / ((n + 1.0) * p);
                x -= dx;
                if dx.abs() < 1e-15 {
                    break;
                }
            }
            (0.5 * (1.0 + x), 1.0 / (n * (n + 1.0) * p * p))
        })
        .collect()
}

fn legendre(degree: usize, x: f64) -> f64 {
    let (mut p, mut before) = (1.0, 0.0);
    for j in (0..degree).map(|j| j as f64) {
        (p, before) = (((2.0 * j + 1.0) * x * p - j * before) / (j + 1.0), p);
    }
    p
}

/// `Σ N_i x_i`.
pub fn sum(n: &[f64; 4], x: &[Vector<3>; 4]) -> Point<3> {
    x[0] * n[0] + x[1] * n[1] + x[2] * n[2] + x[3] * n[3]
}

/// Bezier points of an element: their hull holds the curve.
pub fn bezier(x: &[Vector<3>; 4], h: f64) -> [Point<3>; 4] {
    [x[0], x[0] + x[1] * (h / 3.0), x[2] - x[3] * (h / 3.0), x[2]]
}
