//! Newton's method for a chain of geodesics joined by straight lines.
//!
//! A shortest path leaves and meets each body along its tangent: with unit directions `e` of the lines before `P` and after
//! `Q`, the residual of a touch is `(e_in·n_P, e_in·g_P, e_out·n_Q, e_out·g_Q)`; `de = (I - ee)(dx_head - dx_tail)/d`. The
//! Jacobian is exact and block tridiagonal, so that a step costs as much as there are bodies. Where an end of the leg lies
//! on the body, the touch starts or ends in it.

use super::route::{Body, Leg};
use super::touch::{Shot, Variation, WrapPoint};
use crate::banded::Banded;
use signorini_geometry::{Point, Vector};

/// The residuals are sines of angles: rounding and the error of the geodesics leave this.
pub(crate) const TOLERANCE: f64 = 1e-11;
const ITERATIONS: usize = 40;
/// Halvings of a step that does not make the residual smaller.
const HALVINGS: usize = 6;

/// A straight line of a path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Line {
    pub from: Point<3>,
    pub to: Point<3>,
}

impl Line {
    pub fn length(&self) -> f64 {
        (self.to - self.from).norm()
    }

    /// Unit vector.
    pub fn direction(&self) -> Vector<3> {
        (self.to - self.from).try_normalize(0.0).unwrap_or_default()
    }

    /// `(I - ee) v / d`.
    fn turn(&self, v: &Vector<3>) -> Vector<3> {
        let e = self.direction();
        (v - e * e.dot(v)) / self.length()
    }
}

/// A chain with what Newton needs of it.
#[derive(Clone, Debug)]
pub(crate) struct Chain {
    pub touches: Vec<WrapPoint>,
    pub shots: Vec<Shot>,
    pub residual: f64,
}

/// What is kept between calls.
#[derive(Clone, Debug, Default)]
pub(crate) struct Workspace {
    matrix: Banded,
    step: Vec<f64>,
}

/// Which ends of a chain lie on their bodies.
pub(crate) fn pinned(leg: &Leg, touches: &[WrapPoint]) -> [bool; 2] {
    let same = |touch: Option<&WrapPoint>, pin: Option<usize>| touch.zip(pin).is_some_and(|(t, o)| t.order == o);
    [same(touches.first(), leg.pinned[0]), same(touches.last(), leg.pinned[1])]
}

impl Chain {
    /// `None` where a geodesic cannot be followed.
    pub fn new(leg: &Leg, bodies: &[Body<'_>], mut touches: Vec<WrapPoint>) -> Option<Self> {
        let shots: Option<Vec<Shot>> =
            touches.iter_mut().map(|t| t.shoot(&bodies[leg.around[t.order].body]).ok()).collect();
        let mut chain = Chain { touches, shots: shots?, residual: 0.0 };
        let mut residual = vec![0.0; 4 * chain.touches.len()];
        chain.equations(leg, &mut residual, None);
        chain.residual = residual.iter().fold(0.0, |a: f64, r| a.max(r.abs()));
        chain.residual.is_finite().then_some(chain)
    }

    /// The lines before, between and after the touches.
    pub fn line(&self, leg: &Leg, k: usize) -> Line {
        let from = if k == 0 { leg.from.1 } else { self.shots[k - 1].q.x };
        let to = self.shots.get(k).map_or(leg.to.1, |s| s.p.x);
        Line { from, to }
    }

    /// The residual, and the Jacobian where it is wanted.
    fn equations(&self, leg: &Leg, residual: &mut [f64], mut matrix: Option<&mut Banded>) {
        let m = self.touches.len();
        let pins = pinned(leg, &self.touches);
        let size = (leg.to.1 - leg.from.1).norm();
        for (i, shot) in self.shots.iter().enumerate() {
            let (p, q) = (&shot.p, &shot.q);
            let start = [p.forward(), p.sideways([1.0, 0.0]), p.sideways([0.0, 1.0])];
            let end = ends(shot);
            let (before, after) = (self.line(leg, i), self.line(leg, i + 1));
            let mut put = |row: usize, column: usize, value: f64| {
                if let Some(matrix) = matrix.as_deref_mut() {
                    matrix.add(row, column, value);
                }
            };
            let row = 4 * i;
            if pins[0] && i == 0 {
                // In radii, as the others are sines.
                let unit = p.curvature().unwrap_or(1.0 / size);
                let off = (p.x - leg.from.1) * unit;
                residual[0] = off.dot(&p.tau);
                residual[1] = off.dot(&p.g);
                for (c, v) in start.iter().enumerate() {
                    put(0, c, v.x.dot(&p.tau) * unit);
                    put(1, c, v.x.dot(&p.g) * unit);
                }
            } else {
                let e = before.direction();
                residual[row] = e.dot(&p.n);
                residual[row + 1] = e.dot(&p.g);
                for (c, v) in start.iter().enumerate() {
                    let de = before.turn(&v.x);
                    put(row, row + c, de.dot(&p.n) + e.dot(&v.n));
                    put(row + 1, row + c, de.dot(&p.g) + e.dot(&v.g));
                }
                if i > 0 {
                    for (c, v) in ends(&self.shots[i - 1]).iter().enumerate() {
                        let de = before.turn(&-v.x);
                        put(row, row - 4 + c, de.dot(&p.n));
                        put(row + 1, row - 4 + c, de.dot(&p.g));
                    }
                }
            }
            if pins[1] && i + 1 == m {
                let unit = q.curvature().unwrap_or(1.0 / size);
                let off = (q.x - leg.to.1) * unit;
                residual[row + 2] = off.dot(&q.tau);
                residual[row + 3] = off.dot(&q.g);
                for (c, v) in end.iter().enumerate() {
                    put(row + 2, row + c, v.x.dot(&q.tau) * unit);
                    put(row + 3, row + c, v.x.dot(&q.g) * unit);
                }
            } else {
                let e = after.direction();
                residual[row + 2] = e.dot(&q.n);
                residual[row + 3] = e.dot(&q.g);
                for (c, v) in end.iter().enumerate() {
                    let de = after.turn(&-v.x);
                    put(row + 2, row + c, de.dot(&q.n) + e.dot(&v.n));
                    put(row + 3, row + c, de.dot(&q.g) + e.dot(&v.g));
                }
                if let Some(next) = self.shots.get(i + 1) {
                    let start = [next.p.forward(), next.p.sideways([1.0, 0.0]), next.p.sideways([0.0, 1.0])];
                    for (c, v) in start.iter().enumerate() {
                        let de = after.turn(&v.x);
                        put(row + 2, row + 4 + c, de.dot(&q.n));
                        put(row + 3, row + 4 + c, de.dot(&q.g));
                    }
                }
            }
        }
    }

    /// Whether every line goes on in the direction of the path, where it has a length.
    pub fn goes_forward(&self, leg: &Leg) -> bool {
        let pins = pinned(leg, &self.touches);
        let last = self.shots.len();
        self.shots.iter().enumerate().all(|(i, shot)| {
            let before = (pins[0] && i == 0) || self.line(leg, i).direction().dot(&shot.p.tau) > 0.0;
            let after = (pins[1] && i + 1 == last) || self.line(leg, i + 1).direction().dot(&shot.q.tau) > 0.0;
            before && after
        })
    }
}

/// Variations at `Q` for a shift, a shift sideways, a turn, and the length.
fn ends(shot: &Shot) -> [Variation; 4] {
    [shot.q.forward(), shot.q.sideways(shot.a), shot.q.sideways(shot.r), shot.q.forward()]
}

/// The chain near `start` that meets all its bodies along their tangents, and the residuals on the way.
///
/// # Errors
/// The residuals, where it does not converge.
pub(crate) fn newton(
    leg: &Leg,
    bodies: &[Body<'_>],
    start: Vec<WrapPoint>,
    work: &mut Workspace,
) -> Result<(Chain, Vec<f64>), Vec<f64>> {
    let mut residuals = Vec::with_capacity(8);
    let Some(mut chain) = Chain::new(leg, bodies, start) else { return Err(residuals) };
    residuals.push(chain.residual);
    for _ in 0..ITERATIONS {
        if chain.residual <= TOLERANCE {
            return Ok((chain, residuals));
        }
        let n = 4 * chain.touches.len();
        work.matrix.reset(n, 7, 7);
        work.step.clear();
        work.step.resize(n, 0.0);
        chain.equations(leg, &mut work.step, Some(&mut work.matrix));
        if !work.matrix.factorise() {
            return Err(residuals);
        }
        work.matrix.solve(&mut work.step);
        work.step.iter_mut().for_each(|v| *v = -*v);
        let body = |t: &WrapPoint| &bodies[leg.around[t.order].body];
        let pairs = || chain.touches.iter().zip(work.step.chunks_exact(4));
        let mut share = pairs().map(|(t, step)| t.share(body(t), step)).fold(1.0, f64::min);
        let mut best: Option<Chain> = None;
        for _ in 0..HALVINGS {
            let moved: Option<Vec<WrapPoint>> = pairs().map(|(t, step)| t.moved(body(t), step, share).ok()).collect();
            let next = moved.and_then(|touches| Chain::new(leg, bodies, touches));
            if let Some(next) = next {
                let enough = next.residual <= (1.0 - 0.1 * share) * chain.residual;
                if best.as_ref().is_none_or(|b| next.residual < b.residual) {
                    best = Some(next);
                }
                if enough {
                    break;
                }
            }
            share *= 0.5;
        }
        let Some(next) = best else { return Err(residuals) };
        // Rounding is all that is left.
        let stuck = next.residual >= chain.residual && chain.residual <= 100.0 * TOLERANCE;
        if stuck {
            return Ok((chain, residuals));
        }
        chain = next;
        residuals.push(chain.residual);
    }
    if chain.residual <= TOLERANCE { Ok((chain, residuals)) } else { Err(residuals) }
}

#[cfg(test)]
mod tests {
    use super::super::route::{Anchor, Route, Station};
    use super::*;
    use signorini_geometry::rigid::RigidMotion;
    use signorini_geometry::rigid_shape::{Ellipsoid, Torus};

    /// The Jacobian against central differences, away from any solution.
    #[test]
    fn the_jacobian_is_the_derivative_of_the_residual() {
        let one = Ellipsoid::new(Point::<3>::zeros(), [2.0, 1.5, 1.0]).unwrap();
        let two = Torus { center: Point::<3>::zeros(), axis: Vector::<3>::z(), major: 2.0, minor: 0.7 };
        let shift =
            RigidMotion::new(Vector::<3>::new(0.2, 0.4, 0.1), Point::<3>::zeros(), Vector::<3>::new(6.0, 1.0, 0.3));
        let bodies = [Body::fixed(&one), Body { shape: &two, motion: shift }];
        let around = |body| Station::Around { body, turns: 0 };
        let route = Route {
            start: Anchor::fixed(Point::<3>::new(-4.0, 0.5, 0.2)),
            stations: vec![around(0), around(1)],
            end: Anchor::fixed(Point::<3>::new(9.0, -1.0, 2.0)),
        };
        let leg = route.legs(&bodies).remove(0);
        let x = Vector::<3>::x();
        let touches = vec![
            WrapPoint::near(0, &bodies[0], &Point::<3>::new(-0.3, 1.2, 0.8), &x, 1.1).unwrap(),
            WrapPoint::near(1, &bodies[1], &Point::<3>::new(6.0, 3.0, 1.5), &(x + Vector::<3>::y() * 0.3), 0.8)
                .unwrap(),
        ];
        let residual = |touches: &[WrapPoint]| {
            let chain = Chain::new(&leg, &bodies, touches.to_vec()).unwrap();
            let mut r = vec![0.0; 8];
            chain.equations(&leg, &mut r, None);
            r
        };
        let chain = Chain::new(&leg, &bodies, touches.clone()).unwrap();
        let h = 1e-5;
        for column in 0..8 {
            // The column of the Jacobian from the inverse: J (J⁻¹ e) = e would hide errors, so the difference of residuals is
            // solved for the step that made it.
            let moved = |sign: f64| {
                let mut step = [0.0; 4];
                step[column % 4] = sign * h;
                let mut touches = touches.clone();
                let k = column / 4;
                touches[k] = touches[k].moved(&bodies[k], &step, 1.0).unwrap();
                residual(&touches)
            };
            let (up, down) = (moved(1.0), moved(-1.0));
            let mut slope: Vec<f64> = up.iter().zip(&down).map(|(a, b)| (a - b) / (2.0 * h)).collect();
            let mut matrix = Banded::default();
            matrix.reset(8, 7, 7);
            chain.equations(&leg, &mut [0.0; 8], Some(&mut matrix));
            assert!(matrix.factorise());
            matrix.solve(&mut slope);
            for (k, v) in slope.iter().enumerate() {
                let expected = f64::from(u8::from(k == column));
                assert!((v - expected).abs() < 1e-8, "column {column}: {slope:?}");
            }
        }
    }
}
