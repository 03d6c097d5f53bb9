//! Velocities that carry the membrane along with its fronts: each mode of a front, continued along the normals and faded out.

use crate::method::ModeSpace;
use crate::problem::{Measure, Membrane};
use crate::quadrature::Quadrature;
use crate::zone::Zone;
use signorini_geometry::{Point, Vector};

/// Velocities reach at least this many cells from their front ...
const LEAST_REACH: f64 = 1.5;
/// ... and at most this fraction of the extent of the membrane, ...
const MOST_REACH: f64 = 0.2;
/// ... this fraction of the way to the nearest other front, rim or axis, ...
const APART: f64 = 0.45;
/// ... and of the least radius of curvature, beyond which normals meet.
const WITHIN_FOCUS: f64 = 0.7;
/// Closer to a focus than this normals do not count as getting any denser.
const FOCUS: f64 = 0.2;

/// The velocity of a point as one mode moves its front with unit speed.
#[derive(Clone, Copy, Debug)]
pub struct Velocity<const D: usize> {
    pub mode: usize,
    pub w: Vector<D>,
    /// `gradient[i][j] = ∂w_i/∂x_j`, by rows.
    pub gradient: [Vector<D>; D],
}

impl<const D: usize> Velocity<D> {
    /// The divergence, in polar coordinates where the measure is axisymmetric.
    pub fn divergence(&self, measure: Measure, x: &Point<D>) -> f64 {
        (0..D).map(|i| self.gradient[i][i]).sum::<f64>() + measure.curvature(x, self.w[0])
    }

    /// `(∇w + ∇wᵀ) a`.
    pub fn strain_times(&self, a: &Vector<D>) -> Vector<D> {
        Vector::from_fn(|i, _| self.gradient[i].dot(a) + (0..D).map(|j| self.gradient[j][i] * a[j]).sum::<f64>())
    }

    /// `∇wᵀ a`.
    pub fn transposed_times(&self, a: &Vector<D>) -> Vector<D> {
        Vector::from_fn(|j, _| (0..D).map(|i| self.gradient[i][j] * a[i]).sum::<f64>())
    }

    /// `n · ∇w n`.
    pub fn stretch_along(&self, n: &Vector<D>) -> f64 {
        (0..D).map(|i| n[i] * self.gradient[i].dot(n)).sum()
    }

    /// The rate at which the front stretches: `div w - n · ∇w n`.
    pub fn surface_divergence(&self, measure: Measure, x: &Point<D>, n: &Vector<D>) -> f64 {
        self.divergence(measure, x) - self.stretch_along(n)
    }

    /// The rate at which the normal of the front turns: `-∇wᵀ n + (n · ∇w n) n`.
    pub fn normal_rate(&self, n: &Vector<D>) -> Vector<D> {
        n * self.stretch_along(n) - self.transposed_times(n)
    }
}

/// Velocities of all modes near the fronts of a zone.
pub struct Velocities<'a, const D: usize, Z> {
    zone: &'a Z,
    space: ModeSpace,
    /// How far each front carries its surroundings along.
    reach: Vec<f64>,
    /// Points of each front, to tell what is near.
    points: Vec<Vec<Point<D>>>,
}

impl<'a, const D: usize, Z: Zone<D>> Velocities<'a, D, Z> {
    pub fn new(membrane: &Membrane<D>, zone: &'a Z, quadrature: &Quadrature<D>, space: ModeSpace) -> Self {
        let mut points = vec![Vec::new(); zone.front_count()];
        for p in &quadrature.front {
            points[p.front].push(p.x);
        }
        let reach = (0..points.len())
            .map(|front| {
                let others = (0..points.len()).filter(|&i| i != front).flat_map(|i| &points[i]);
                let obstacles = others.chain(quadrature.rim.iter().map(|p| &p.x));
                let mut apart = obstacles.map(|y| nearest(&points[front], y)).fold(f64::INFINITY, f64::min);
                if membrane.measure == Measure::Axisymmetric {
                    apart = points[front].iter().map(|x| x[0]).fold(apart, f64::min);
                }
                let focus = if D > 1 { WITHIN_FOCUS / zone.sharpest().max(f64::MIN_POSITIVE) } else { f64::INFINITY };
                let most = (APART * apart).min(focus).min(MOST_REACH * membrane.size());
                most.max(LEAST_REACH * membrane.grid.h()).min(apart)
            })
            .collect();
        Self { zone, space, reach, points }
    }

    /// Whether a cell about `x` of a certain size may be carried along.
    pub fn near(&self, x: &Point<D>, size: f64) -> Vec<usize> {
        (0..self.points.len()).filter(|&i| nearest(&self.points[i], x) < self.reach[i] + size).collect()
    }

    /// The velocities of a point near some of the fronts.
    pub fn at(&self, fronts: &[usize], x: &Point<D>, out: &mut Vec<Velocity<D>>) {
        out.clear();
        for &front in fronts {
            let foot = self.zone.foot(front, x, self.space);
            let distance = (x - foot.position).dot(&foot.normal);
            // Near a focus the nearest point may lie on another branch; the signed distance keeps its size all the same.
            let t = (x - foot.position).norm() / self.reach[front];
            if t >= 1.0 {
                continue;
            }
            // Twice differentiable, and flat at the front: the value one, then smoothly down to none.
            let fade = 1.0 - t * t * t * (10.0 - t * (15.0 - 6.0 * t));
            let slope = -30.0 * (t * (1.0 - t)).powi(2) / self.reach[front] * distance.signum();
            let denser = 1.0 / (1.0 + foot.curvature * distance).max(FOCUS);
            for (mode, value, along) in &foot.modes {
                let n = foot.normal;
                out.push(Velocity {
                    mode: *mode,
                    w: n * (fade * value),
                    gradient: std::array::from_fn(|i| {
                        // Of the normal only the part along the front turns, by the curvature.
                        let turns = (Vector::<D>::from_fn(|k, _| f64::from(k == i)) - n * n[i]) * foot.curvature;
                        let turns = if D == 1 { Vector::zeros() } else { turns };
                        n * (slope * value * n[i]) + (along * n[i] + turns * *value) * (fade * denser)
                    }),
                });
            }
        }
    }
}

fn nearest<const D: usize>(points: &[Point<D>], x: &Point<D>) -> f64 {
    points.iter().map(|y| (x - y).norm_squared()).fold(f64::INFINITY, f64::min).sqrt()
}
