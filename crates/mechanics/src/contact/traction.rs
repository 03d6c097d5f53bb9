//! The traction of a site by the law, and the axes of its friction.

use super::{Contact, MeasuredPair};
use crate::pair::{Pair, any_tangent};
use signorini_contact::Status;
use signorini_contact::law::Projected;
use signorini_geometry::Vector;

/// A traction with its derivatives in the unknowns of the pair.
pub(super) struct Traction {
    pub projected: Projected,
    pub axes: [Vector<3>; 2],
    pub d_axes: Vec<[Vector<3>; 2]>,
    pub slip: [f64; 2],
    /// Of friction.
    pub trial: [f64; 2],
}

impl Contact {
    /// The traction by the law; linearised about a trial with as much more friction as is `redistributed` on to the site.
    pub(super) fn traction(
        &self,
        k: usize,
        touch: &MeasuredPair,
        unknown: [f64; 3],
        redistributed: [f64; 2],
    ) -> Traction {
        let c = self.stiffness[k];
        let pair = &touch.pair;
        let (axes, d_axes) = if self.friction.is_some() { axes(pair) } else { ([Vector::<3>::zeros(); 2], Vec::new()) };
        let base = touch.stress.as_ref().map_or_else(|| self.base(k), |s| s.base(&pair.normal, &axes));
        let lambda: [f64; 3] = std::array::from_fn(|i| unknown[i] - self.softness * (unknown[i] - base[i]));
        let Some(law) = &self.friction else {
            let pressure = (lambda[0] - c * pair.gap).max(0.0);
            let closed = lambda[0] - c * pair.gap > 0.0;
            let mut projected = Projected { traction: [pressure, 0.0, 0.0], ..Projected::default() };
            projected.derivative[0][0] = f64::from(u8::from(closed));
            projected.status = if closed { Status::Slip } else { Status::Open };
            return Traction { projected, axes, d_axes, slip: [0.0; 2], trial: [0.0; 2] };
        };
        let slip = axes.map(|e| e.dot(&pair.elastic));
        // In the plane nothing moves across it, and there is no friction that way.
        let most = pair.slip.iter().map(|s| s.norm()).fold(0.0, f64::max);
        let moves = axes.map(|e| pair.slip.iter().any(|s| e.dot(s).abs() > STEEP * most));
        let trial = |i: usize| if moves[i] { lambda[i + 1] + c * slip[i] } else { 0.0 };
        let per_velocity = c * (self.times[1] - self.times[0]);
        let project = |trial: [f64; 3]| law.project_in_time(trial, per_velocity);
        let about = |i: usize| if moves[i] { trial(i) + redistributed[i] } else { 0.0 };
        let mut projected = project([lambda[0] - c * pair.gap, about(0), about(1)]);
        for i in (0..2).filter(|i| !moves[*i]) {
            projected.derivative.iter_mut().for_each(|row| row[i + 1] = 0.0);
        }
        let [p, t1, t2] = projected.traction;
        if projected.status == Status::Stick && law.utilisation([t1, t2], p) > 1.0 - AT_LIMIT {
            let beyond = project([p, (1.0 + 2.0 * AT_LIMIT) * t1, (1.0 + 2.0 * AT_LIMIT) * t2]);
            (projected.derivative, projected.status) = (beyond.derivative, beyond.status);
        }
        if redistributed != [0.0; 2] {
            let d = projected.derivative;
            (0..2).for_each(|a| {
                projected.traction[1 + a] -= d[1 + a][1] * redistributed[0] + d[1 + a][2] * redistributed[1]
            });
        }
        Traction { projected, axes, d_axes, slip, trial: [trial(0), trial(1)] }
    }

    /// The unknown traction of a site.
    pub(super) fn multiplier(&self, k: usize, lambda: &[f64]) -> [f64; 3] {
        let own = &lambda[self.components() * k..self.components() * (k + 1)];
        [own[0], own.get(1).copied().unwrap_or(0.0), own.get(2).copied().unwrap_or(0.0)]
    }

    /// The traction with which a site that gives way has no gap and no slip.
    pub(super) fn base(&self, k: usize) -> [f64; 3] {
        self.enforcement.base(self.memory[k].traction)
    }
}

/// Share of the limit of friction within which a site is at it, as what slipped is when the next increment starts. Either
/// derivative serves at a switch; with that of slip a slip zone does not start each increment stuck, to be freed site by
/// site. More than the tolerance of Newton's method, which ends that near to the limit.
const AT_LIMIT: f64 = 1e-7;

/// Sine of the angle to the normal below which the projection of an axis tells no direction any more.
pub(super) const STEEP: f64 = 1e-8;

/// The axes of friction of a pair, and their variations.
pub(crate) fn axes(pair: &Pair) -> ([Vector<3>; 2], Vec<[Vector<3>; 2]>) {
    let normal = pair.normal;
    let along = pair.axis.direction - normal * normal.dot(&pair.axis.direction);
    let length = along.norm();
    if length <= STEEP * pair.axis.direction.norm() {
        // The axis stands on the surface: without one, any will do.
        let first = any_tangent(&normal);
        return ([first, normal.cross(&first)], vec![[Vector::<3>::zeros(); 2]; pair.unknowns.len()]);
    }
    let first = along / length;
    let second = normal.cross(&first);
    let variations = (pair.d_normal.iter().zip(&pair.axis.variation))
        .map(|(dn, da)| {
            let d = da
                - normal * normal.dot(da)
                - dn * normal.dot(&pair.axis.direction)
                - normal * dn.dot(&pair.axis.direction);
            let d_first = (d - first * first.dot(&d)) / length;
            [d_first, dn.cross(&first) + normal.cross(&d_first)]
        })
        .collect();
    ([first, second], variations)
}
