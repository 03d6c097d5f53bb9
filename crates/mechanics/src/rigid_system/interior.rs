//! Contact with friction by an interior point method: forces near a solution, from which Newton's method finds it.
//!
//! | symbol | meaning |
//! |---|---|
//! | `x = (r_N, r_α/μ_α)` | forces of a contact: in the cone `K = {x_0 ≥ |x_T|}` |
//! | `y = (u_N + s, μ_α u_α)` | gap and slip that they leave, with `s = |μ u_T|`: in `K` too, and `x ∘ y = 0` (de Saxcé & Feng 1998) |
//! | `y = A x + b + e_N s(y)` | the compliance of the bodies in these variables |
//!
//! Iterates stay within both cones and come to their boundaries along `x ∘ y = σ μ e`, by steps with the scaling of Nesterov &
//! Todd and the corrector of Mehrotra. With `s` as a function of `y`, and its derivative, the equations are those of friction, not
//! those of a convex problem for a given `s` (Acary, Armand, Nguyen & Shpakovych 2022).

use super::complementarity::{Block, Kind};
use nalgebra::{DMatrix, DVector, Matrix3, Vector3};
use signorini_solve::dense::Lu;

/// Residual and complementarity, relative to the loads, from which Newton's method goes on.
const NEAR: f64 = 1e-10;
const MOST_ITERATIONS: usize = 50;
/// Part of the way to the boundary of the cones that a step goes.
const INSIDE: f64 = 0.95;

/// A contact: its first row, and their number.
struct Cone {
    first: usize,
    rows: usize,
}

impl Cone {
    /// Its part of a vector, with zeros for the axes along which nothing slips.
    fn part(&self, of: &DVector<f64>) -> Vector3<f64> {
        Vector3::from_fn(|i, _| if i < self.rows { of[self.first + i] } else { 0.0 })
    }
}

/// The rows that have forces, and what they are of.
#[derive(Default)]
struct Rows {
    /// Number among all rows, and coefficient of friction; 1 for normal forces and supports.
    list: Vec<(usize, f64)>,
    cones: Vec<Cone>,
    supports: Vec<usize>,
}

impl Rows {
    /// None where friction is none that grows with pressure.
    fn of(blocks: &[Block<'_>]) -> Option<Self> {
        let mut out = Rows::default();
        for b in blocks {
            let first = out.list.len();
            out.list.push((b.first, 1.0));
            match b.kind {
                Kind::Bilateral => {
                    out.supports.push(first);
                    continue;
                }
                Kind::Contact { law: None, .. } => {}
                Kind::Contact { law: Some(law), .. } => {
                    let mu = law.per_pressure()?;
                    let slips = (1..b.rows).map(|k| (b.first + k, mu[b.axes[k - 1]]));
                    out.list.extend(slips.filter(|(_, mu)| *mu > 0.0));
                }
            }
            out.cones.push(Cone { first, rows: out.list.len() - first });
        }
        Some(out)
    }
}

/// Forces near those that solve `u = W r + q` with contact and friction of the blocks; none of laws that have no cones. `W` is
/// positive definite.
pub fn interior(blocks: &[Block<'_>], w: &DMatrix<f64>, q: &DVector<f64>) -> Option<DVector<f64>> {
    let Rows { list, cones, supports } = Rows::of(blocks)?;
    let n = list.len();
    // In units in which the mean compliance, and the largest of what loads leave, are one.
    let mut a = DMatrix::from_fn(n, n, |i, j| list[i].1 * w[(list[i].0, list[j].0)] * list[j].1);
    let mut b = DVector::from_iterator(n, list.iter().map(|(row, mu)| mu * q[*row]));
    let (stiff, load) = (n as f64 / a.trace(), b.amax());
    let mut out = DVector::zeros(q.len());
    if load == 0.0 {
        return Some(out);
    }
    a *= stiff;
    b /= load;
    let (mut x, mut y) = (DVector::zeros(n), DVector::zeros(n));
    cones.iter().for_each(|c| (x[c.first], y[c.first]) = (1.0, 1.0));
    for _ in 0..MOST_ITERATIONS {
        let mut residual = &a * &x + &b - &y;
        let mut matrix = a.clone();
        let mut mean = 0.0;
        for c in &cones {
            let own = c.part(&y);
            let slip = own[1].hypot(own[2]);
            residual[c.first] += slip;
            mean += c.part(&x).dot(&own) / cones.len() as f64;
        }
        if residual.amax() <= NEAR && mean <= NEAR {
            break;
        }
        // dy = A dx + e_N (dy_T·y_T)/|y_T| + residual
        for c in &cones {
            let own = c.part(&y);
            let slip = own[1].hypot(own[2]);
            for i in (1..c.rows).filter(|_| slip > 0.0) {
                let share = own[i] / slip;
                residual[c.first] += share * residual[c.first + i];
                for k in 0..n {
                    matrix[(c.first, k)] += share * a[(c.first + i, k)];
                }
            }
        }
        let scaled: Vec<Scaled> = cones.iter().map(|c| Scaled::new(&c.part(&x), &c.part(&y))).collect();
        let mut equations = matrix.clone();
        for (c, s) in cones.iter().zip(&scaled) {
            for i in 0..c.rows {
                for k in 0..n {
                    equations[(c.first + i, k)] =
                        (0..c.rows).map(|j| s.scaling[(i, j)] * matrix[(c.first + j, k)]).sum();
                }
                (0..c.rows).for_each(|j| equations[(c.first + i, c.first + j)] += s.inverse[(i, j)]);
            }
        }
        let factors = Lu::new(n, equations.as_slice());
        let steps = |wanted: &[Vector3<f64>]| -> (DVector<f64>, DVector<f64>) {
            let mut dx = -&residual;
            for ((c, s), wanted) in cones.iter().zip(&scaled).zip(wanted) {
                let own = s.divided(wanted) - s.scaling * c.part(&residual);
                (0..c.rows).for_each(|i| dx[c.first + i] = own[i]);
            }
            factors.solve_in_place(dx.as_mut_slice());
            let mut dy = &matrix * &dx + &residual;
            supports.iter().for_each(|k| dy[*k] = 0.0);
            (dx, dy)
        };
        let farthest = |dx: &DVector<f64>, dy: &DVector<f64>| {
            let one = |c: &Cone| within(&c.part(&x), &c.part(dx)).min(within(&c.part(&y), &c.part(dy)));
            cones.iter().map(one).fold(f64::INFINITY, f64::min)
        };
        let predicted: Vec<Vector3<f64>> = scaled.iter().map(|s| -product(&s.lambda, &s.lambda)).collect();
        let (dx, dy) = steps(&predicted);
        let share = farthest(&dx, &dy).min(1.0);
        let (ahead_x, ahead_y) = (&x + &dx * share, &y + &dy * share);
        let ahead = cones.iter().map(|c| c.part(&ahead_x).dot(&c.part(&ahead_y))).sum::<f64>() / cones.len() as f64;
        let centred = (ahead / mean).clamp(0.0, 1.0).powi(3) * mean;
        let corrected: Vec<Vector3<f64>> = (cones.iter().zip(&scaled).zip(&predicted))
            .map(|((c, s), first)| {
                let second = product(&(s.inverse * c.part(&dx)), &(s.scaling * c.part(&dy)));
                Vector3::x() * centred + first - second
            })
            .collect();
        let (dx, dy) = steps(&corrected);
        let share = (INSIDE * farthest(&dx, &dy)).min(1.0);
        if !(share > 0.0 && dx.iter().chain(dy.iter()).all(|d| d.is_finite())) {
            break;
        }
        x += dx * share;
        y += dy * share;
    }
    list.iter().zip(x.iter()).for_each(|((row, mu), x)| out[*row] = mu * x * load * stiff);
    Some(out)
}

/// The scaling of Nesterov & Todd at a point: `W y = W⁻¹ x = λ`.
struct Scaled {
    scaling: Matrix3<f64>,
    inverse: Matrix3<f64>,
    lambda: Vector3<f64>,
}

/// `x_0² - |x_T|²`, without cancellation.
fn determinant(x: &Vector3<f64>) -> f64 {
    let across = x[1].hypot(x[2]);
    (x[0] - across) * (x[0] + across)
}

impl Scaled {
    fn new(x: &Vector3<f64>, y: &Vector3<f64>) -> Self {
        let (dx, dy) = (determinant(x).sqrt(), determinant(y).sqrt());
        let (x, unit) = (x / dx, y / dy);
        let mirrored = Vector3::new(unit[0], -unit[1], -unit[2]);
        let w = (x + mirrored) / (2.0 * (0.5 * (1.0 + x.dot(&unit))).sqrt());
        let of = |sign: f64| {
            Matrix3::from_fn(|i, j| match (i, j) {
                (0, 0) => w[0],
                (0, k) | (k, 0) => sign * w[k],
                _ => f64::from(u8::from(i == j)) + w[i] * w[j] / (1.0 + w[0]),
            })
        };
        let size = (dx / dy).sqrt();
        let scaling = of(1.0) * size;
        Scaled { inverse: of(-1.0) / size, lambda: scaling * y, scaling }
    }

    /// The solution `z` of `λ ∘ z = r`.
    fn divided(&self, r: &Vector3<f64>) -> Vector3<f64> {
        let l = &self.lambda;
        let first = (l[0] * r[0] - l[1] * r[1] - l[2] * r[2]) / determinant(l);
        Vector3::new(first, (r[1] - first * l[1]) / l[0], (r[2] - first * l[2]) / l[0])
    }
}

/// `a ∘ b`.
fn product(a: &Vector3<f64>, b: &Vector3<f64>) -> Vector3<f64> {
    Vector3::new(a.dot(b), a[0] * b[1] + b[0] * a[1], a[0] * b[2] + b[0] * a[2])
}

/// How far along a direction a point of the cone stays in it: the first root of `det(x + t d)`.
fn within(x: &Vector3<f64>, d: &Vector3<f64>) -> f64 {
    let (a, b, c) = (determinant(d), x[0] * d[0] - x[1] * d[1] - x[2] * d[2], determinant(x));
    let apex = if d[0] < 0.0 { -x[0] / d[0] } else { f64::INFINITY };
    let discriminant = b * b - a * c;
    if discriminant < 0.0 {
        return apex;
    }
    let root = discriminant.sqrt();
    let first = match b <= 0.0 {
        true if root - b > 0.0 => c / (root - b),
        false if a < 0.0 => -(b + root) / a,
        _ => f64::INFINITY,
    };
    apex.min(first)
}
