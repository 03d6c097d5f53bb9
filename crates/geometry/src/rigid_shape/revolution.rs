//! Bodies of revolution of any smooth profile.
//!
//! The profile is a curve `c(t) = (ρ, z)` of the half plane through the axis. With `h = c''·n/|c'|²` its curvature, the gap
//! of a point is that of its place `(ρ, z)` to the profile; along the meridian `H = S/(1 + g S)` with `S = -h`, around the
//! axis `H = n·e_ρ/ρ`. Beyond its ends the profile goes on straight.

use super::{GapJet, RigidShape, any_normal, curvature, unit};
use crate::mass_properties::MassProperties;
use crate::rule::gauss_legendre;
use crate::shape::ShapeError;
use crate::{Jet, Point, Vector};
use std::f64::consts::PI;
use std::sync::Arc;

/// Places per interval at which the search for the closest point of a profile starts.
const STARTS: usize = 8;
const ITERATIONS: usize = 30;
/// Radius at an end of a profile, relative to the largest, that is rounding.
const CLOSED: f64 = 1e-9;

type Formula = dyn Fn(Jet<1>) -> [Jet<1>; 2] + Send + Sync;

/// A curve of the half plane through an axis: `(ρ, z)` with `ρ >= 0`, twice continuously differentiable.
#[derive(Clone)]
pub struct Profile {
    kind: Kind,
    /// Parameters that increase: the ends of smooth intervals.
    breaks: Vec<f64>,
    starts: Vec<(f64, [f64; 2])>,
    /// One where the outward normal is `(z', -ρ')`, minus one where it is the opposite.
    side: f64,
}

#[derive(Clone)]
enum Kind {
    Formula(Arc<Formula>),
    /// Values and second derivatives at the breaks.
    Spline([Vec<[f64; 2]>; 2]),
}

impl std::fmt::Debug for Profile {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Profile").field("breaks", &self.breaks).field("side", &self.side).finish_non_exhaustive()
    }
}

/// Position and derivatives of a profile with respect to its parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileJet {
    pub x: Vector<2>,
    pub d1: Vector<2>,
    pub d2: Vector<2>,
}

impl Profile {
    /// The cubic spline over chord lengths through points `(ρ, z)`. At an end on the axis the body is smooth: `ρ'' = 0`,
    /// `z' = 0`; at the others the third derivative is continuous at the last point but one.
    ///
    /// # Errors
    /// Fewer than four points, two equal ones in succession, a negative radius, a radius of zero between the ends.
    pub fn spline(points: &[[f64; 2]]) -> Result<Self, ShapeError> {
        let n = points.len();
        if n < 4 {
            return Err(ShapeError::new("profile", format!("{n} points: a spline needs four at least")));
        }
        let mut breaks = vec![0.0; n];
        for (k, [rho, z]) in points.iter().enumerate() {
            crate::shape::error::position("profile", &Point::<3>::new(*rho, *z, 0.0))?;
            let inside = k > 0 && k + 1 < n;
            if *rho < 0.0 || (inside && *rho == 0.0) {
                return Err(ShapeError::new("profile", format!("point {k}: radius {rho} must be greater than zero")));
            }
            if k > 0 {
                let chord = (rho - points[k - 1][0]).hypot(z - points[k - 1][1]);
                if chord == 0.0 {
                    return Err(ShapeError::new("profile", format!("points {} and {k} are the same", k - 1)));
                }
                breaks[k] = breaks[k - 1] + chord;
            }
        }
        let on_axis = [points[0][0] == 0.0, points[n - 1][0] == 0.0];
        let coordinates = [0, 1].map(|c| {
            let values: Vec<f64> = points.iter().map(|p| p[c]).collect();
            let ends = on_axis.map(|on| match (on, c) {
                (false, _) => End::NotAKnot,
                (true, 0) => End::Straight,
                (true, _) => End::Level,
            });
            let second = second_derivatives(&breaks, &values, ends);
            values.into_iter().zip(second).map(|(v, m)| [v, m]).collect()
        });
        Ok(Self::new(Kind::Spline(coordinates), breaks))
    }

    /// A formula for `(ρ, z)` over a range of its parameter, divided into `intervals` of which each turns by less than a
    /// quarter of a circle.
    ///
    /// # Errors
    /// A range that does not increase, no interval, values that are not finite, a tangent that vanishes.
    pub fn formula(
        formula: impl Fn(Jet<1>) -> [Jet<1>; 2] + Send + Sync + 'static,
        [from, to]: [f64; 2],
        intervals: usize,
    ) -> Result<Self, ShapeError> {
        if !(from < to && (to - from).is_finite()) {
            return Err(ShapeError::new("range", format!("[{from}, {to}] must increase")));
        }
        if intervals == 0 {
            return Err(ShapeError::new("intervals", "one at least"));
        }
        let breaks = (0..=intervals).map(|k| from + (to - from) * k as f64 / intervals as f64).collect();
        let profile = Self::new(Kind::Formula(Arc::new(formula)), breaks);
        for (t, _) in &profile.starts {
            let jet = profile.jet(*t);
            let finite = [jet.x, jet.d1, jet.d2].iter().all(|v| v.iter().all(|c| c.is_finite()));
            if !finite || jet.d1.norm() == 0.0 {
                return Err(ShapeError::new("formula", format!("no tangent at {t}: {jet:?}")));
            }
        }
        Ok(profile)
    }

    fn new(kind: Kind, breaks: Vec<f64>) -> Self {
        let mut profile = Profile { kind, breaks, starts: Vec::new(), side: 1.0 };
        let places = profile
            .breaks
            .windows(2)
            .flat_map(|w| (0..STARTS).map(|k| w[0] + (w[1] - w[0]) * k as f64 / STARTS as f64).collect::<Vec<_>>());
        let places: Vec<f64> = places.chain(profile.breaks.last().copied()).collect();
        profile.starts = places.into_iter().map(|t| (t, profile.jet(t).x.into())).collect();
        // Twice the area between profile and axis, positive where it goes up.
        let area: f64 = profile.starts.windows(2).map(|w| (w[0].1[0] + w[1].1[0]) * (w[1].1[1] - w[0].1[1])).sum();
        profile.side = if area < 0.0 { -1.0 } else { 1.0 };
        profile
    }

    /// The range of the parameter.
    pub fn range(&self) -> [f64; 2] {
        [self.breaks[0], self.breaks[self.breaks.len() - 1]]
    }

    /// Position and derivatives; straight beyond the ends.
    pub fn jet(&self, t: f64) -> ProfileJet {
        let [from, to] = self.range();
        let inside = t.clamp(from, to);
        let jet = match &self.kind {
            Kind::Formula(f) => {
                let [rho, z] = f(Jet::<1>::variable(inside, 0));
                let pair = |of: fn(&Jet<1>) -> f64| Vector::<2>::new(of(&rho), of(&z));
                ProfileJet { x: pair(|j| j.value), d1: pair(|j| j.gradient[0]), d2: pair(|j| j.hessian[(0, 0)]) }
            }
            Kind::Spline(coordinates) => {
                let n = self.breaks.len();
                let k = self.breaks.partition_point(|b| *b <= inside).clamp(1, n - 1) - 1;
                let [rho, z] = [0, 1].map(|c| {
                    cubic(self.breaks[k], self.breaks[k + 1], coordinates[c][k], coordinates[c][k + 1], inside)
                });
                let pair = |i: usize| Vector::<2>::new(rho[i], z[i]);
                ProfileJet { x: pair(0), d1: pair(1), d2: pair(2) }
            }
        };
        if t == inside {
            return jet;
        }
        ProfileJet { x: jet.x + jet.d1 * (t - inside), d1: jet.d1, d2: Vector::<2>::zeros() }
    }

    /// The outward normal.
    pub fn normal(&self, jet: &ProfileJet) -> Vector<2> {
        Vector::<2>::new(jet.d1[1], -jet.d1[0]) * (self.side / jet.d1.norm())
    }

    /// Parameter of the closest point.
    pub fn closest(&self, p: &Vector<2>) -> f64 {
        let squared = |x: &[f64; 2]| (x[0] - p[0]).powi(2) + (x[1] - p[1]).powi(2);
        let nearest = (0..self.starts.len())
            .min_by(|&i, &j| squared(&self.starts[i].1).total_cmp(&squared(&self.starts[j].1)))
            .unwrap_or(0);
        let last = self.starts.len() - 1;
        let mut low = if nearest == 0 { f64::NEG_INFINITY } else { self.starts[nearest - 1].0 };
        let mut high = if nearest == last { f64::INFINITY } else { self.starts[nearest + 1].0 };
        let mut t = self.starts[nearest].0;
        // Newton on (c - p)·c' = 0, held in the interval in which its sign changes.
        for _ in 0..ITERATIONS {
            let jet = self.jet(t);
            let slope = (jet.x - p).dot(&jet.d1);
            if slope > 0.0 {
                high = t;
            } else {
                low = t;
            }
            let bend = jet.d1.norm_squared() + (jet.x - p).dot(&jet.d2);
            let newton = t - slope / if bend > 0.0 { bend } else { jet.d1.norm_squared() };
            let next = if newton >= low && newton <= high { newton } else { 0.5 * (low + high) };
            let done = (next - t).abs() * jet.d1.norm() <= 4.0 * f64::EPSILON * (jet.x.norm() + p.norm());
            t = next;
            if done || !t.is_finite() {
                break;
            }
        }
        t
    }
}

/// What holds at an end of a spline.
#[derive(Clone, Copy, PartialEq, Eq)]
enum End {
    NotAKnot,
    /// No second derivative.
    Straight,
    /// No first derivative.
    Level,
}

/// Second derivatives of the cubic spline through values. The rows of the end conditions reach over three unknowns, so the
/// few hundred equations are solved as a full system.
fn second_derivatives(t: &[f64], f: &[f64], ends: [End; 2]) -> Vec<f64> {
    let n = t.len();
    let mut a = nalgebra::DMatrix::<f64>::zeros(n, n);
    let mut b = nalgebra::DVector::<f64>::zeros(n);
    let h = |k: usize| t[k + 1] - t[k];
    let slope = |k: usize| (f[k + 1] - f[k]) / h(k);
    for k in 1..n - 1 {
        a[(k, k - 1)] = h(k - 1) / 6.0;
        a[(k, k)] = (h(k - 1) + h(k)) / 3.0;
        a[(k, k + 1)] = h(k) / 6.0;
        b[k] = slope(k) - slope(k - 1);
    }
    for (end, row, [i, j, k]) in [(ends[0], 0, [0, 1, 2]), (ends[1], n - 1, [n - 1, n - 2, n - 3])] {
        let (first, second) = ((t[j] - t[i]).abs(), (t[k] - t[j]).abs());
        match end {
            End::NotAKnot => {
                a[(row, i)] = second;
                a[(row, j)] = -(first + second);
                a[(row, k)] = first;
            }
            End::Straight => a[(row, i)] = 1.0,
            End::Level => {
                a[(row, i)] = first / 3.0;
                a[(row, j)] = first / 6.0;
                b[row] = (f[j] - f[i]) / first;
            }
        }
    }
    // Rows of a spline with distinct knots are independent.
    a.lu().solve(&b).map_or_else(|| vec![0.0; n], |x| x.as_slice().to_vec())
}

/// Value and two derivatives of the cubic with given values and second derivatives at both ends.
fn cubic(t0: f64, t1: f64, [f0, m0]: [f64; 2], [f1, m1]: [f64; 2], t: f64) -> [f64; 3] {
    let h = t1 - t0;
    let (a, b) = ((t1 - t) / h, (t - t0) / h);
    let value = a * f0 + b * f1 + h * h / 6.0 * ((a * a * a - a) * m0 + (b * b * b - b) * m1);
    let d1 = (f1 - f0) / h + h / 6.0 * ((1.0 - 3.0 * a * a) * m0 + (3.0 * b * b - 1.0) * m1);
    [value, d1, a * m0 + b * m1]
}

/// A body of revolution.
#[derive(Clone, Debug)]
pub struct Revolution {
    /// Where `z = 0` on the axis.
    pub origin: Point<3>,
    /// Unit vector along the axis.
    pub axis: Vector<3>,
    pub profile: Profile,
}

impl RigidShape for Revolution {
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        let axis = &self.axis;
        let d = x - self.origin;
        let z = axis.dot(&d);
        let across = d - axis * z;
        let rho = across.norm();
        let e = unit(across, any_normal(axis));
        let p = Vector::<2>::new(rho, z);
        let jet = self.profile.jet(self.profile.closest(&p));
        let n = self.profile.normal(&jet);
        let gap = (p - jet.x).dot(&n);
        let shape = -jet.d2.dot(&n) / jet.d1.norm_squared();
        let normal = e * n[0] + axis * n[1];
        let around = axis.cross(&e);
        let along = around.cross(&normal);
        let meridian = shape / (1.0 + gap * shape);
        // On the axis of a smooth body both curvatures are the same.
        let parallel = if rho > 1e-9 * (1.0 + z.abs()) { n[0] * curvature(rho) } else { meridian };
        let hessian = along * along.transpose() * meridian + around * around.transpose() * parallel;
        GapJet { gap, normal, hessian }
    }

    fn centre(&self) -> Point<3> {
        self.origin
    }

    /// Exact for a spline; none where an end of the profile is not on the axis.
    fn mass_properties(&self) -> Option<MassProperties> {
        let ends = self.profile.range().map(|t| self.profile.jet(t).x[0]);
        // Along the axis, of each disc: volume, and moments about the axis, about a diameter and from z = 0.
        let mut sums = [0.0; 4];
        let mut widest = 0.0f64;
        for part in self.profile.breaks.windows(2) {
            for (xi, weight) in gauss_legendre(8) {
                let jet = self.profile.jet(part[0] + xi * (part[1] - part[0]));
                let [rho, z] = [jet.x[0], jet.x[1]];
                let slice = PI * rho * rho * jet.d1[1] * weight * (part[1] - part[0]);
                widest = widest.max(rho);
                let own = [slice, slice * z, 0.5 * slice * rho * rho, slice * (0.25 * rho * rho + z * z)];
                sums.iter_mut().zip(own).for_each(|(sum, own)| *sum += own);
            }
        }
        if ends.iter().any(|rho| *rho > CLOSED * widest) {
            return None;
        }
        let [volume, first, about, across] = sums.map(|sum| sum * sums[0].signum());
        let z = first / volume;
        let inertia = MassProperties::round(&self.axis, about, across - z * z * volume);
        Some(MassProperties { volume, centre: self.origin + self.axis * z, inertia })
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Cylinder, Torus, testing};
    use super::*;
    use crate::Real;
    use std::f64::consts::{FRAC_PI_2, TAU};

    fn dome() -> Profile {
        Profile::formula(|t| [t.cos() * 0.7, t.sin() * 0.4], [-FRAC_PI_2, FRAC_PI_2], 8).unwrap()
    }

    #[test]
    fn the_gap_of_a_body_of_revolution() {
        let axis = Vector::<3>::new(0.0, 0.2, 1.0).normalize();
        let body = Revolution { origin: Point::<3>::new(0.0, 0.1, 0.0), axis, profile: dome() };
        let on_it = body.origin + axis * 0.4 * 0.6 + Vector::<3>::x() * 0.7 * 0.8;
        testing::check(&body, &[on_it, body.origin + axis * 0.4]);
        testing::check_moved(&body, |m| Revolution {
            origin: m.point(&body.origin),
            axis: m.vector(&axis),
            ..body.clone()
        });
    }

    #[test]
    fn known_shapes_are_bodies_of_revolution() {
        let (origin, axis) = (Point::<3>::zeros(), Vector::<3>::z());
        let ring = Profile::formula(|t| [t.cos() * 0.2 + Jet::<1>::constant(0.8), t.sin() * 0.2], [0.0, TAU], 8);
        let ring = Revolution { origin, axis, profile: ring.unwrap() };
        let tube = Profile::spline(&[[0.3, 2.0], [0.3, 1.0], [0.3, -0.5], [0.3, -2.0]]).unwrap();
        let tube = Revolution { origin, axis, profile: tube };
        let torus = Torus { center: origin, axis, major: 0.8, minor: 0.2 };
        let cylinder = Cylinder { point: origin, axis, radius: 0.3 };
        let pairs: [(&dyn RigidShape, &dyn RigidShape); 2] = [(&ring, &torus), (&tube, &cylinder)];
        for x in testing::PLACES.map(Point::<3>::from) {
            for (one, other) in pairs {
                let (a, b) = (one.gap(&x), other.gap(&x));
                assert!((a.gap - b.gap).abs() < 1e-13 && (a.normal - b.normal).norm() < 1e-12, "{a:?} {b:?}");
                assert!((a.hessian - b.hessian).norm() < 1e-11, "{a:?} {b:?}");
            }
        }
    }

    #[test]
    fn splines_of_a_profile_converge_with_order_four() {
        let errors = [16, 32].map(|n| {
            let at = |k: usize| -FRAC_PI_2 + 2.0 * FRAC_PI_2 * k as f64 / n as f64;
            let point =
                |k| if k == 0 || k == n { [0.0, 0.4 * at(k).sin()] } else { [0.7 * at(k).cos(), 0.4 * at(k).sin()] };
            let points: Vec<[f64; 2]> = (0..=n).map(point).collect();
            let profile = Profile::spline(&points).unwrap();
            let body = Revolution { origin: Point::<3>::zeros(), axis: Vector::<3>::z(), profile };
            let exact = Revolution { profile: dome(), ..body.clone() };
            let worst =
                |x: &[f64; 3]| (body.gap(&Point::<3>::from(*x)).gap - exact.gap(&Point::<3>::from(*x)).gap).abs();
            testing::PLACES.iter().map(worst).fold(0.0, f64::max)
        });
        assert!(errors[1] < 1e-5 && errors[0] / errors[1] > 10.0, "{errors:?}");
        assert!(Profile::spline(&[[1.0, 0.0], [1.0, 0.0], [1.0, 1.0], [1.0, 2.0]]).is_err());
        assert!(Profile::spline(&[[1.0, 0.0], [0.0, 1.0], [1.0, 2.0], [1.0, 3.0]]).is_err());
    }
}
