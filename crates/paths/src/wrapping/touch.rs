//! A piece of a path on a body: a geodesic from `P` to `Q`, with the first variations of all that the conditions of a
//! shortest path are made of.
//!
//! With `k = τ·hτ`, `k_B = g·hg`, `t = -τ·hg`: along `τ` (shift `δs`, at `Q` also the length `δℓ`) `dx = τ`,
//! `dn = -kτ + t g`, `dg = -t n`; sideways by a Jacobi field `(j, j')` `dx = j g`, `dn = j (t τ - k_B g)`,
//! `dg = -j'τ + j k_B n`. At `P` the shift `δβ` is `(1, 0)` and the turn `δθ` is `(0, 1)`; at `Q` they are `(a, a')` and
//! `(r, r')`.

use super::route::Body;
use crate::PathError;
use crate::darboux::Along;
use crate::geodesic;
use crate::surface::{curvature, foot, tangent};
use signorini_geometry::{Point, Vector};

/// A geodesic on a body by its start, in the coordinates of the body: a path that has moved on with its body is the start
/// of the next search.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct WrapPoint {
    /// Which of the bodies of the leg.
    pub order: usize,
    pub x: Point<3>,
    /// Unit tangent.
    pub tau: Vector<3>,
    pub length: f64,
    /// Its geodesic, once it was followed.
    known: Option<Known>,
}

/// A geodesic that was followed, with the surface at both its ends: it is the same as long as these are, to the last digit.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Known {
    start: (Point<3>, Vector<3>, f64),
    shot: geodesic::Shot,
    ends: [Along; 2],
}

/// An end of a geodesic in space.
#[derive(Clone, Copy, Debug)]
pub(crate) struct End {
    pub x: Point<3>,
    pub tau: Vector<3>,
    pub g: Vector<3>,
    pub n: Vector<3>,
    k: f64,
    k_b: f64,
    t: f64,
}

/// First variations of position, normal and `g` at an end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Variation {
    pub x: Vector<3>,
    pub n: Vector<3>,
    pub g: Vector<3>,
}

impl End {
    fn new(body: &Body<'_>, x: &Point<3>, tau: &Vector<3>, along: &Along) -> Self {
        let turned = |v: &Vector<3>| body.motion.vector(v);
        End {
            x: body.motion.point(x),
            tau: turned(tau),
            g: turned(&along.g),
            n: turned(&along.n),
            k: along.k_n,
            k_b: along.k_b,
            t: -along.tau_g,
        }
    }

    /// The size of the curvature, where there is one.
    pub fn curvature(&self) -> Option<f64> {
        let size = self.k.hypot(self.k_b).hypot(self.t);
        (size > 0.0).then_some(size)
    }

    pub fn forward(&self) -> Variation {
        Variation { x: self.tau, n: self.g * self.t - self.tau * self.k, g: self.n * -self.t }
    }

    pub fn sideways(&self, [j, dj]: [f64; 2]) -> Variation {
        Variation {
            x: self.g * j,
            n: (self.tau * self.t - self.g * self.k_b) * j,
            g: self.n * (self.k_b * j) - self.tau * dj,
        }
    }
}

/// A touch with both its ends.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shot {
    pub p: End,
    pub q: End,
    /// Jacobi fields at `Q`.
    pub a: [f64; 2],
    pub r: [f64; 2],
    /// The largest normal curvature on the way.
    pub largest: f64,
    /// Whether no conjugate point lies on the way.
    pub is_minimal: bool,
}

impl WrapPoint {
    pub fn new(order: usize, x: Point<3>, tau: Vector<3>, length: f64) -> Self {
        WrapPoint { order, x, tau, length, known: None }
    }

    /// Follows the geodesic, unless it is known.
    pub fn shoot(&mut self, body: &Body<'_>) -> Result<Shot, PathError> {
        let along = |x: &Point<3>, tau: &Vector<3>| Along::new(&body.shape.level(x), tau);
        let first = along(&self.x, &self.tau);
        let start = (self.x, self.tau, self.length);
        let same =
            |k: &Known| k.start == start && k.ends[0] == first && k.ends[1] == along(&k.shot.end.x, &k.shot.end.tau);
        let known = match self.known.filter(same) {
            Some(known) => known,
            None => {
                let shot = geodesic::shoot(body.shape, &self.x, &self.tau, self.length)?;
                Known { start, shot, ends: [first, along(&shot.end.x, &shot.end.tau)] }
            }
        };
        self.known = Some(known);
        let Known { shot, ends, .. } = known;
        let end = shot.end;
        Ok(Shot {
            p: End::new(body, &self.x, &self.tau, &ends[0]),
            q: End::new(body, &end.x, &end.tau, &ends[1]),
            a: end.a,
            r: end.r,
            largest: shot.largest,
            is_minimal: shot.is_minimal,
        })
    }

    /// From a point near the body and a direction, both of space.
    pub fn near(
        order: usize,
        body: &Body<'_>,
        x: &Point<3>,
        direction: &Vector<3>,
        length: f64,
    ) -> Result<Self, PathError> {
        let (x, level) = foot(body.shape, &body.inside(x))?;
        let tau = tangent(&level, &x, &body.inside_vector(direction))?;
        Ok(WrapPoint::new(order, x, tau, length))
    }

    /// How much of a Newton step may be taken: half a radian of turn, half the length or a part of the radius.
    pub fn share(&self, body: &Body<'_>, step: &[f64]) -> f64 {
        let radius = 1.0 / curvature(&body.shape.level(&self.x));
        let reach = 0.5 * self.length.abs().max(0.3 * if radius.is_finite() { radius } else { self.length.abs() });
        let moved = step[0].hypot(step[1]).max(step[3].abs());
        let share = |limit: f64, value: f64| if value > limit { limit / value } else { 1.0 };
        share(0.5, step[2].abs()).min(share(reach, moved))
    }

    /// After a step `(δs, δβ, δθ, δℓ)`: the start moves in the tangent plane and back to the surface, the tangent turns.
    pub fn moved(&self, body: &Body<'_>, step: &[f64], share: f64) -> Result<Self, PathError> {
        let along = Along::new(&body.shape.level(&self.x), &self.tau);
        let x = self.x + (self.tau * step[0] + along.g * step[1]) * share;
        let (sin, cos) = (step[2] * share).sin_cos();
        let (x, level) = foot(body.shape, &x)?;
        let tau = tangent(&level, &x, &(self.tau * cos + along.g * sin))?;
        Ok(WrapPoint::new(self.order, x, tau, self.length + share * step[3]))
    }
}
