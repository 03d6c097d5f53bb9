//! How wide fits are to be: as wide as makes the error of the curvatures least.
//!
//! A cubic fit of radius `r` errs in the curvatures by a bias `b r²`, of what the surface has of higher degree, and by the
//! noise `σ` of the vertices through its gain, `σ |L(r)| ~ σ/(r² √n)` for `n` vertices. The estimates `S` of two radii differ
//! by `b (r₂² - r₁²)` and by the noise through the difference of their gains, which is known: what is left in the mean over
//! the vertices is the bias. So is balanced what neither a mesh with noise nor a coarse one tells by itself (bias and variance
//! of local polynomials: Fan & Gijbels 1996; comparing radii: Lepski 1991). Errors are those of the normal curvature in the
//! mean over all directions, `|E|² = ∮ (τ·Eτ)² = (2 tr E² + (tr E)²)/8`.

use super::fit::{Around, CUBIC, Fit, QUARTIC, Vertices, cubic};
use signorini_geometry::Vector;

/// Ratio of the radii that are compared: twice the vertices.
const WIDER: f64 = std::f64::consts::SQRT_2;
/// Vertices at which they are compared.
const SAMPLES: usize = 1000;
/// Widenings beyond which none is tried: fits of thousands of vertices.
const MOST: i32 = 8;

/// Fits of the least error.
#[derive(Clone, Copy, Debug)]
pub(super) struct Choice {
    /// Radius over that of the narrowest.
    pub wider: f64,
    /// Root mean square by which vertices scatter: no more than what the best of several fits leaves.
    pub noise: f64,
    /// Root mean squares of the normal curvature and of its error.
    pub curvature: f64,
    pub error: f64,
}

/// The curvatures of a fit, `∂²p/∂u²`, `∂²p/∂u∂v`, `∂²p/∂v²`, and their derivatives in the heights of vertices.
struct Bend {
    vertices: Vec<u32>,
    value: [f64; 3],
    gain: Vec<[f64; 3]>,
}

impl Bend {
    fn new(around: Around, fit: &Fit) -> Self {
        let second = |of: &dyn Fn(usize) -> f64, scale: f64| [2.0 * of(3) * scale, of(4) * scale, 2.0 * of(5) * scale];
        let inverse = 1.0 / around.radius;
        let gain = fit.gain.column_iter().map(|c| second(&|k| c[k], inverse * inverse)).collect();
        Bend { vertices: around.vertices, value: second(&|k| fit.coefficients[k], inverse), gain }
    }

    /// What noise of a unit makes of it, squared.
    fn gained(&self) -> f64 {
        self.gain.iter().map(square).sum()
    }

    /// The same of the difference to one from more vertices.
    fn gained_beside(&self, wider: &Bend) -> f64 {
        let mut own = self.vertices.iter().zip(&self.gain).peekable();
        let mut sum = 0.0;
        for (vertex, gain) in wider.vertices.iter().zip(&wider.gain) {
            let less = own.next_if(|(v, _)| *v == vertex).map_or([0.0; 3], |(_, g)| *g);
            sum += square(&[0, 1, 2].map(|k| gain[k] - less[k]));
        }
        sum
    }
}

/// The mean square over all directions.
fn square([a, b, c]: &[f64; 3]) -> f64 {
    (3.0 * (a * a + c * c) + 4.0 * b * b + 2.0 * a * c) / 8.0
}

/// The radius for the vertices of a mesh with first guesses of their normals.
///
/// # Errors
/// A vertex without a fit.
pub(super) fn choose(vertices: &Vertices<'_>, normals: &[Vector<3>]) -> Result<Choice, usize> {
    let used: Vec<usize> = (0..vertices.at.len()).filter(|k| !vertices.around[*k].is_empty()).collect();
    let mut left = [[0.0; 2]; 4];
    // One plane for all radii, so that what they see can be compared.
    let mut planes = Vec::new();
    for k in used.iter().copied().step_by(used.len().div_ceil(SAMPLES)) {
        let (around, fit) = cubic(vertices, k, &normals[k], 1.0).ok_or(k)?;
        let normal = around.normal(&fit);
        let second = Around::new(vertices, k, &normal, WIDER).ok_or(k)?;
        let fits = [Some(fit), around.fit(QUARTIC), second.fit(CUBIC), second.fit(QUARTIC)];
        for (sum, fit) in left.iter_mut().zip(fits) {
            let [square, freedom] = fit.ok_or(k)?.left;
            *sum = [sum[0] + square, sum[1] + freedom];
        }
        planes.push((k, normal));
    }
    let scattered =
        left.iter().filter(|[_, freedom]| *freedom > 1.0).map(|[square, freedom]| (square / freedom).sqrt());
    // Vertices that are too few to tell are taken as they are.
    let noise = scattered.min_by(f64::total_cmp).unwrap_or(0.0);
    let bends = |wider: f64| -> Result<Vec<Bend>, usize> {
        let bend = |(k, normal): &(usize, Vector<3>)| {
            let around = Around::new(vertices, *k, normal, wider).ok_or(*k)?;
            let fit = around.fit(CUBIC).ok_or(*k)?;
            Ok(Bend::new(around, &fit))
        };
        planes.iter().map(bend).collect()
    };
    let mean = |of: &dyn Fn(usize) -> f64| (0..planes.len()).map(of).sum::<f64>() / planes.len() as f64;
    let mut best = Choice { wider: 1.0, noise, curvature: 0.0, error: f64::INFINITY };
    let mut now = bends(1.0)?;
    for level in 0..MOST {
        let wider = WIDER.powi(level);
        let next = bends(WIDER * wider)?;
        let apart = |k: usize| square(&[0, 1, 2].map(|i| next[k].value[i] - now[k].value[i]));
        // The radii are in such a ratio that the bias doubles.
        let bias = mean(&|k| apart(k) - noise * noise * now[k].gained_beside(&next[k])).max(0.0);
        let by_noise = noise * noise * mean(&|k| now[k].gained());
        let error = (bias + by_noise).sqrt();
        if error < best.error {
            let curvature = (mean(&|k| square(&now[k].value)) - by_noise).max(0.0).sqrt();
            best = Choice { wider, noise, curvature, error };
        }
        if bias > by_noise {
            break;
        }
        now = next;
    }
    Ok(best)
}
