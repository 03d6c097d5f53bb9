//! Exact Newton for the distance of two charts inside a box of parameters.

use crate::Vector;
use crate::patch::Chart;

/// Difference vector of two charts with its derivatives, at one pair of local parameters.
pub struct Difference<const N: usize> {
    pub d: Vector<3>,
    pub j: [Vector<3>; N],
    pub hessian: [[f64; N]; N],
    pub g: [f64; N],
    /// The Gram matrix of `J`, block diagonal: lengths that make steps and curvatures physical.
    pub metric: [[f64; N]; N],
}

impl<const N: usize> Difference<N> {
    #[inline]
    pub fn new<const A: usize, const B: usize>(a: &impl Chart<A>, b: &impl Chart<B>, z: &[f64; N]) -> Self {
        let p = a.jet(&std::array::from_fn(|k| z[k]));
        let q = b.jet(&std::array::from_fn(|k| z[A + k]));
        let d = p.x - q.x;
        let mut j = [Vector::<3>::zeros(); N];
        j[..A].copy_from_slice(&p.d);
        for k in 0..B {
            j[A + k] = -q.d[k];
        }
        let mut g = [0.0; N];
        let mut hessian = [[0.0; N]; N];
        let mut metric = [[0.0; N]; N];
        for r in 0..N {
            g[r] = j[r].dot(&d);
            for c in 0..=r {
                let mut value = j[r].dot(&j[c]);
                if r < A && c < A {
                    metric[r][c] = value;
                    value += p.dd[r][c].dot(&d);
                } else if r >= A && c >= A {
                    metric[r][c] = value;
                    value -= q.dd[r - A][c - A].dot(&d);
                }
                metric[c][r] = metric[r][c];
                hessian[r][c] = value;
                hessian[c][r] = value;
            }
        }
        Difference { d, j, hessian, g, metric }
    }

    /// The eigenvalues of `metric⁻¹ hessian` on the free parameters, in no order; not numbers where the parametrisation
    /// is degenerate. The second value counts them.
    pub fn eigenvalues(&self, free: &[bool; N]) -> ([f64; N], usize) {
        let mut index = [0; N];
        let mut n = 0;
        for k in 0..N {
            if free[k] {
                index[n] = k;
                n += 1;
            }
        }
        let mut out = [f64::NAN; N];
        let (m, h) = (
            |r: usize, c: usize| self.metric[index[r]][index[c]],
            |r: usize, c: usize| self.hessian[index[r]][index[c]],
        );
        match n {
            0 => {}
            1 => out[0] = h(0, 0) / m(0, 0),
            2 => {
                // The roots of det(H - λ M).
                let det = m(0, 0) * m(1, 1) - m(0, 1) * m(0, 1);
                let half_trace = 0.5 * (h(0, 0) * m(1, 1) + h(1, 1) * m(0, 0) - 2.0 * h(0, 1) * m(0, 1)) / det;
                let product = (h(0, 0) * h(1, 1) - h(0, 1) * h(0, 1)) / det;
                if det > 1e-24 * m(0, 0) * m(1, 1) {
                    let root = (half_trace * half_trace - product).max(0.0).sqrt();
                    let large = half_trace + root.copysign(half_trace);
                    out[0] = large;
                    out[1] = if large == 0.0 { 0.0 } else { product / large };
                }
            }
            _ => {
                let pick = |f: &dyn Fn(usize, usize) -> f64| nalgebra::DMatrix::from_fn(n, n, f);
                if let Some(cholesky) = pick(&m).cholesky() {
                    let hessian = pick(&h);
                    let half = cholesky.l().solve_lower_triangular(&hessian).unwrap_or(hessian);
                    let whole = cholesky.l().solve_lower_triangular(&half.transpose()).unwrap_or(half);
                    for (value, found) in out.iter_mut().zip(whole.symmetric_eigenvalues().iter()) {
                        *value = *found;
                    }
                }
            }
        }
        (out, n)
    }
}

/// What Newton arrived at.
#[derive(Clone, Copy, Debug)]
pub struct Stationary<const N: usize> {
    pub z: [f64; N],
    pub distance: f64,
    /// Whether the derivatives vanish, or press against the bounds of the box.
    pub stationary: bool,
}

/// Cosine of the angle between distance and tangent up to which a point counts as stationary.
const STATIONARY: f64 = 1e-7;

/// The most iterations; only quartic minima come near.
const MOST_ITERATIONS: usize = 60;

/// Minimises the distance inside the box by projected Newton steps with the exact Hessian.
///
/// A parameter at a bound is held while the derivative points outwards. Where the Hessian of the free parameters is
/// not positive definite it is shifted by a multiple of the metric; a step that does not reduce `F` is halved.
/// `magnitude` is the size of the coordinates, which sets what rounding allows.
pub fn minimise<const A: usize, const B: usize, const N: usize>(
    a: &impl Chart<A>,
    b: &impl Chart<B>,
    low: &[f64; N],
    high: &[f64; N],
    start: [f64; N],
    magnitude: f64,
) -> Stationary<N> {
    let mut z = start;
    for k in 0..N {
        z[k] = z[k].clamp(low[k], high[k]);
    }
    let mut here = Difference::<N>::new(a, b, &z);
    let mut squared = here.d.norm_squared();
    let mut iterations = 0;
    while iterations < MOST_ITERATIONS {
        iterations += 1;
        let distance = squared.sqrt();
        let mut free = [true; N];
        let mut done = true;
        for k in 0..N {
            let bound = (z[k] <= low[k] && here.g[k] >= 0.0) || (z[k] >= high[k] && here.g[k] <= 0.0);
            free[k] = !bound && high[k] > low[k];
            let scale = here.metric[k][k].sqrt() * (distance + magnitude);
            if free[k] && here.g[k].abs() > 4.0 * f64::EPSILON * scale {
                done = false;
            }
        }
        if done {
            break;
        }
        // Parameters on a bound that the step would leave through are held too.
        let mut step = newton_step(&here, &free);
        while let Some(k) = (0..N).find(|&k| free[k] && beyond(z[k], step[k], low[k], high[k])) {
            free[k] = false;
            step = newton_step(&here, &free);
        }
        // First the whole step, cut off at the bounds parameter by parameter; if that does not pay, along the straight
        // line, which leads downhill, as far as the first bound.
        let mut length = 1.0;
        let mut clamped = true;
        let mut moved = false;
        for _ in 0..40 {
            let mut next = z;
            let mut travel = Vector::<3>::zeros();
            let mut slope = 0.0;
            for k in 0..N {
                if free[k] {
                    next[k] = (z[k] + length * step[k]).clamp(low[k], high[k]);
                    slope += here.g[k] * (next[k] - z[k]);
                    travel += here.j[k].map(f64::abs) * (next[k] - z[k]).abs();
                }
            }
            if travel.norm() <= 2.0 * f64::EPSILON * magnitude {
                break;
            }
            let there = Difference::<N>::new(a, b, &next);
            let value = there.d.norm_squared();
            let slack = 4.0 * f64::EPSILON * (squared + magnitude * distance);
            // |D|² falls by at least a share of what its slope, 2 g, promises.
            let pays = value < squared && (!clamped || value <= squared + 0.02 * slope.min(0.0) && slope < 0.0);
            if pays || (length == 1.0 && value <= squared + slack && smaller_gradient(&there, &here, &free)) {
                (z, here, squared, moved) = (next, there, value, true);
                break;
            }
            if clamped {
                clamped = false;
                let room = |k: usize| if step[k] > 0.0 { high[k] - z[k] } else { low[k] - z[k] } / step[k];
                let first = (0..N).filter(|&k| free[k] && step[k] != 0.0).map(room).fold(f64::INFINITY, f64::min);
                if first < 1.0 {
                    length = first;
                    continue;
                }
            }
            length *= 0.5;
        }
        if !moved {
            break;
        }
    }
    let distance = squared.sqrt();
    let stationary = (0..N).all(|k| {
        let pressed = (z[k] <= low[k] && here.g[k] >= 0.0) || (z[k] >= high[k] && here.g[k] <= 0.0);
        pressed || here.g[k].abs() <= STATIONARY * here.metric[k][k].sqrt() * (distance + 1e-3 * magnitude)
    });
    Stationary { z, distance, stationary }
}

/// Whether a step leaves the interval from one of its ends.
fn beyond(z: f64, step: f64, low: f64, high: f64) -> bool {
    (z <= low && step < 0.0) || (z >= high && step > 0.0)
}

fn smaller_gradient<const N: usize>(there: &Difference<N>, here: &Difference<N>, free: &[bool; N]) -> bool {
    let size = |d: &Difference<N>| (0..N).filter(|&k| free[k]).map(|k| d.g[k] * d.g[k]).sum::<f64>();
    size(there) < 0.25 * size(here)
}

/// `-H⁻¹ g` on the free parameters, with `H` shifted towards the metric until it is positive definite.
fn newton_step<const N: usize>(at: &Difference<N>, free: &[bool; N]) -> [f64; N] {
    let mut shift = 0.0;
    loop {
        let mut matrix = at.hessian;
        let mut rhs = [0.0; N];
        for p in 0..N {
            if free[p] {
                rhs[p] = -at.g[p];
                for q in 0..N {
                    matrix[p][q] += shift * at.metric[p][q];
                }
                matrix[p][p] += shift * 1e-12 * at.metric[p][p] + f64::MIN_POSITIVE;
            } else {
                for q in 0..N {
                    matrix[p][q] = 0.0;
                    matrix[q][p] = 0.0;
                }
                matrix[p][p] = 1.0;
            }
        }
        if let Some(step) = solve_positive_definite(matrix, rhs) {
            return step;
        }
        if shift > 1e12 {
            // Degenerate parameters: a plain scaled gradient.
            return std::array::from_fn(|k| {
                if free[k] && at.metric[k][k] > 0.0 { -at.g[k] / at.metric[k][k] } else { 0.0 }
            });
        }
        shift = if shift == 0.0 { 1e-3 } else { 4.0 * shift };
    }
}

/// Solves by elimination; `None` where a pivot is not positive.
pub fn solve_positive_definite<const N: usize>(mut m: [[f64; N]; N], mut x: [f64; N]) -> Option<[f64; N]> {
    for k in 0..N {
        let pivot = m[k][k];
        let floor = 1e-15 * m[k].iter().fold(0.0f64, |s, v| s.max(v.abs()));
        if pivot.is_nan() || pivot <= floor {
            return None;
        }
        for i in k + 1..N {
            let factor = m[i][k] / pivot;
            for j in k..N {
                m[i][j] -= factor * m[k][j];
            }
            x[i] -= factor * x[k];
        }
    }
    for k in (0..N).rev() {
        for j in k + 1..N {
            x[k] -= m[k][j] * x[j];
        }
        x[k] /= m[k][k];
    }
    Some(x)
}
