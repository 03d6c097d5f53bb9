//! Geodesics with their natural variations.
//!
//! `x'' = k_n n`, by arc length; the Jacobi fields across it, `j'' + K j = 0`: `a` starts as `(1, 0)`, `r` as `(0, 1)`. A
//! sideways shift `β` of the start and a turn `θ` of its direction from `τ` towards `g` move the point at `ℓ` by
//! `(β a(ℓ) + θ r(ℓ)) g`. `r(ℓ) = 0` is a conjugate point: beyond it the geodesic is no shortest path (do Carmo, Differential
//! Geometry of Curves and Surfaces, 5.5).

use crate::darboux::{Along, Darboux};
use crate::ode::{Control, Next, State, System, integrate};
use crate::surface::{along, curvature, foot, restore, tangent};
use crate::{PathError, ode};
use signorini_geometry::rigid_shape::RigidShape;
use signorini_geometry::{Point, Vector};
use std::cell::Cell;

/// The error of a step along a geodesic, relative to a radius of curvature.
pub const TOLERANCE: f64 = 1e-13;

/// The same within the iteration of shortest paths, whose lengths are of second order in it.
const SHOOTING: f64 = 3e-12;

/// The share of a radius of curvature that the first step takes; the pair of order eight takes about this one at
/// [`TOLERANCE`] on a circle.
const FIRST_STEP: f64 = 0.2;

/// A point of a geodesic.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GeodesicState {
    pub s: f64,
    pub x: Point<3>,
    /// Unit tangent.
    pub tau: Vector<3>,
    /// The Jacobi field that starts as `(1, 0)`, and its derivative.
    pub a: [f64; 2],
    /// The one that starts as `(0, 1)`.
    pub r: [f64; 2],
}

/// A piece of a geodesic.
#[derive(Clone, Debug, PartialEq)]
pub struct Geodesic {
    /// At the start, after every step of the integration, and at the end.
    pub states: Vec<GeodesicState>,
}

impl Geodesic {
    pub fn end(&self) -> &GeodesicState {
        &self.states[self.states.len() - 1]
    }

    /// The first arc length at which the Jacobi field `r` vanishes, by linear interpolation between steps.
    pub fn conjugate_point(&self) -> Option<f64> {
        let pairs = self.states.windows(2).skip(1);
        pairs
            .filter(|w| w[0].r[0] * w[1].r[0] <= 0.0)
            .map(|w| {
                let share = w[0].r[0] / (w[0].r[0] - w[1].r[0]);
                w[0].s + share * (w[1].s - w[0].s)
            })
            .next()
    }

    /// The frames at the states.
    pub fn frames(&self, surface: &dyn RigidShape) -> Vec<Darboux> {
        let frame = |s: &GeodesicState| {
            let level = surface.level(&s.x);
            let gap = level.value / level.gradient.norm();
            Darboux::from_parts(s.s, s.x, s.tau, &Along::new(&level, &s.tau), 0.0, gap)
        };
        self.states.iter().map(frame).collect()
    }
}

/// The geodesic from the foot of a point in a direction, which is laid into the tangent plane.
///
/// # Errors
/// No foot, a direction along the normal, a length that is not finite, a surface that is not smooth.
pub fn geodesic(
    surface: &dyn RigidShape,
    start: &Point<3>,
    direction: &Vector<3>,
    length: f64,
) -> Result<Geodesic, PathError> {
    if !length.is_finite() {
        return Err(PathError::Input { what: "length", value: length, valid: "a finite number" });
    }
    let (x, level) = foot(surface, start)?;
    let tau = tangent(&level, &x, direction)?;
    let first = GeodesicState { s: 0.0, x, tau, a: [1.0, 0.0], r: [0.0, 1.0] };
    let mut states = vec![first];
    let system = Jacobi { surface, unit: unit(&level, length) };
    let control = Control { tolerance: TOLERANCE, first: FIRST_STEP * system.unit };
    integrate(&system, [0.0, length], &pack(&first), control, |_, _, s, y| {
        states.push(unpack(s, y));
        Next::Continue
    })?;
    Ok(Geodesic { states })
}

/// The end of a geodesic and what was met on the way to it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Shot {
    pub end: GeodesicState,
    /// The largest normal curvature.
    pub largest: f64,
    /// Whether no conjugate point was passed.
    pub is_minimal: bool,
}

/// The end of a geodesic from a point and a unit tangent of the surface, and the largest normal curvature of all stages of its
/// steps: positive where the path may lift off. For the inner loop of shortest paths; the drift from the surface stays within
/// the error of the steps.
#[inline]
pub(crate) fn shoot(surface: &dyn RigidShape, x: &Point<3>, tau: &Vector<3>, length: f64) -> Result<Shot, PathError> {
    let first = GeodesicState { s: 0.0, x: *x, tau: *tau, a: [1.0, 0.0], r: [0.0, 1.0] };
    let unit = unit(&surface.level(x), length);
    let largest = Cell::new(f64::NEG_INFINITY);
    let system = Shooting { jacobi: Jacobi { surface, unit }, largest: &largest };
    let control = Control { tolerance: SHOOTING, first: FIRST_STEP * unit };
    let mut is_minimal = true;
    let (_, y) = integrate(&system, [0.0, length], &pack(&first), control, |_, _, s, y| {
        is_minimal &= y[8] * s > 0.0;
        Next::Continue
    })?;
    Ok(Shot { end: unpack(length, &y), largest: largest.get(), is_minimal })
}

/// The length with which errors are compared: a radius of curvature, or the path itself where the surface is flatter.
fn unit(level: &signorini_geometry::Jet<3>, length: f64) -> f64 {
    let radius = 1.0 / curvature(level);
    let longest = length.abs().max(f64::MIN_POSITIVE);
    if radius.is_finite() { radius.min(4.0 * longest) } else { 2.0 * longest }
}

struct Jacobi<'a> {
    surface: &'a dyn RigidShape,
    unit: f64,
}

fn pack(s: &GeodesicState) -> State<10> {
    let (x, t) = (s.x, s.tau);
    ode::State::<10>::from([x[0], x[1], x[2], t[0], t[1], t[2], s.a[0], s.a[1], s.r[0], s.r[1]])
}

fn unpack(s: f64, y: &State<10>) -> GeodesicState {
    let x = Point::<3>::new(y[0], y[1], y[2]);
    GeodesicState { s, x, tau: Vector::<3>::new(y[3], y[4], y[5]), a: [y[6], y[7]], r: [y[8], y[9]] }
}

/// The same without the way back to the surface after every step.
struct Shooting<'a> {
    jacobi: Jacobi<'a>,
    largest: &'a Cell<f64>,
}

impl Jacobi<'_> {
    #[inline]
    fn slope_and_curvature(&self, y: &State<10>) -> (State<10>, f64) {
        let x = Point::<3>::new(y[0], y[1], y[2]);
        let tau = Vector::<3>::new(y[3], y[4], y[5]);
        let along = along(self.surface, &x, &tau);
        let bend = along.n * along.k_n;
        let k = along.gaussian_curvature();
        let slope =
            State::<10>::from([tau[0], tau[1], tau[2], bend[0], bend[1], bend[2], y[7], -k * y[6], y[9], -k * y[8]]);
        (slope, along.k_n)
    }
}

impl System<10> for Shooting<'_> {
    #[inline]
    fn slope(&self, _: f64, y: &State<10>) -> State<10> {
        let (slope, k_n) = self.jacobi.slope_and_curvature(y);
        self.largest.set(self.largest.get().max(k_n));
        slope
    }

    fn scale(&self) -> State<10> {
        self.jacobi.scale()
    }
}

impl System<10> for Jacobi<'_> {
    fn slope(&self, _: f64, y: &State<10>) -> State<10> {
        self.slope_and_curvature(y).0
    }

    fn restore(&self, y: &mut State<10>) {
        let mut x = Point::<3>::new(y[0], y[1], y[2]);
        let mut tau = Vector::<3>::new(y[3], y[4], y[5]);
        restore(self.surface, &mut x, &mut tau);
        for k in 0..3 {
            y[k] = x[k];
            y[3 + k] = tau[k];
        }
    }

    fn scale(&self) -> State<10> {
        let (l, one) = (self.unit, 1.0);
        State::<10>::from([l, l, l, one, one, one, one, 1.0 / l, l, one])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use signorini_geometry::rigid_shape::{Ellipsoid, Sphere, Torus};
    use std::f64::consts::PI;

    #[test]
    fn great_circles_and_their_conjugate_points() {
        let sphere = Sphere { center: Point::<3>::new(0.3, -0.2, 1.0), radius: 1.7 };
        let start = sphere.center + Vector::<3>::new(0.0, 2.0, 0.0);
        let g = geodesic(&sphere, &start, &Vector::<3>::new(1.0, 5.0, 0.0), 9.0).unwrap();
        let angle = 9.0 / 1.7f64;
        let exact = sphere.center + Vector::<3>::new(angle.sin(), angle.cos(), 0.0) * 1.7;
        let end = g.end();
        assert!((end.x - exact).norm() < 1e-11, "{}", (end.x - exact).norm());
        assert!((end.a[0] - angle.cos()).abs() < 1e-11 && (end.r[0] - 1.7 * angle.sin()).abs() < 1e-11);
        assert!((g.conjugate_point().unwrap() - 1.7 * PI).abs() < 0.05);
        assert!(g.frames(&sphere).iter().all(|f| f.gap.abs() < 1e-14 && (f.k_n + 1.0 / 1.7).abs() < 1e-13));
    }

    /// Clairaut: `ρ sin α` is constant on a surface of revolution.
    #[test]
    fn clairaut_on_a_torus_there_and_back() {
        let torus = Torus { center: Point::<3>::zeros(), axis: Vector::<3>::z(), major: 3.0, minor: 1.0 };
        let start = Point::<3>::new(4.0, 0.0, 0.0);
        let g = geodesic(&torus, &start, &Vector::<3>::new(0.0, 0.9, 0.5), 25.0).unwrap();
        let constant = |s: &GeodesicState| s.x.x * s.tau.y - s.x.y * s.tau.x;
        let c = constant(&g.states[0]);
        assert!(g.states.iter().all(|s| (constant(s) - c).abs() < 1e-11));
        // Back along the same way, and the Wronskian of the Jacobi fields.
        let back = geodesic(&torus, &g.end().x, &-g.end().tau, 25.0).unwrap();
        assert!((back.end().x - start).norm() < 1e-9);
        let e = g.end();
        assert!((e.a[0] * e.r[1] - e.a[1] * e.r[0] - 1.0).abs() < 1e-9);
    }

    /// The Jacobi fields are the derivatives of the end with respect to the start.
    #[test]
    fn natural_variations() {
        let body = Ellipsoid::new(Point::<3>::zeros(), [2.0, 1.5, 1.0]).unwrap();
        let (x, level) = foot(&body, &Point::<3>::new(0.4, 0.8, 0.9)).unwrap();
        let tau = tangent(&level, &x, &Vector::<3>::new(1.0, 0.3, 0.2)).unwrap();
        let at = Along::new(&level, &tau);
        let end = |theta: f64, beta: f64| {
            // A shift to the side carries the direction along: the geodesic across, and its own parallel field.
            let side = geodesic(&body, &x, &at.g, beta).unwrap();
            let here = along(&body, &side.end().x, &side.end().tau);
            let tau = here.n.cross(&side.end().tau);
            let g = tau.cross(&here.n);
            let direction = tau * theta.cos() + g * theta.sin();
            *geodesic(&body, &side.end().x, &direction, 2.0).unwrap().end()
        };
        let base = end(0.0, 0.0);
        let g_end = along(&body, &base.x, &base.tau).g;
        let h = 1e-4;
        for (up, down, field) in [(end(h, 0.0), end(-h, 0.0), base.r[0]), (end(0.0, h), end(0.0, -h), base.a[0])] {
            let moved = (up.x - down.x) / (2.0 * h);
            assert!((moved - g_end * field).norm() < 1e-7, "{moved:?} {}", g_end * field);
        }
    }
}
