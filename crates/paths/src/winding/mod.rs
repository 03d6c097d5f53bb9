//! Paths of yarns on mandrels: filament winding.
//!
//! A yarn under tension holds beside a geodesic as far as friction does: `k_g = -λ k_n` with the slippage coefficient
//! `λ`. With this sign `λ > 0` makes the angle `α` from the meridian grow: on a surface of revolution
//! `dα/ds = λ (k_m cos²α + k_p sin²α) - (dr/dσ) sin α/r` with curvatures positive on a convex mandrel. The yarn is stable where
//! `|λ| <= μ` and `k_n < 0`; where `k_n >= 0` it bridges. (Koussios, Filament Winding: A Unified Approach, 2004.)

mod circuit;
mod opening;
mod pattern;

pub use circuit::{Circuit, circuit};
pub use opening::{Opening, slippage_for_opening};
pub use pattern::{Coverage, Lead, Pattern, coverage, patterns};

use crate::PathError;
use crate::darboux::{Along, Darboux};
use crate::geodesic::TOLERANCE;
use crate::ode::{Control, Next, State, System, integrate, step};
use crate::surface::{curvature, foot, restore};
use signorini_geometry::rigid_shape::RigidShape;
use signorini_geometry::{Point, Vector};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// The axis about which a mandrel turns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axis {
    pub origin: Point<3>,
    /// Unit vector.
    pub direction: Vector<3>,
}

/// A mandrel: a surface and its axis.
#[derive(Clone, Copy)]
pub struct Mandrel<'a> {
    pub surface: &'a dyn RigidShape,
    pub axis: Axis,
}

/// Where a slippage coefficient is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct At {
    pub s: f64,
    /// Angle of the yarn from the meridian.
    pub angle: f64,
    /// Distance from the axis.
    pub radius: f64,
    /// Along the axis.
    pub height: f64,
}

/// The slippage coefficient `λ` along a path.
#[derive(Clone)]
pub enum Slippage {
    Constant(f64),
    Variable(Arc<dyn Fn(&At) -> f64 + Send + Sync>),
}

impl Slippage {
    fn at(&self, at: &At) -> f64 {
        match self {
            Slippage::Constant(value) => *value,
            Slippage::Variable(f) => f(at),
        }
    }
}

/// A point of a path of winding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WindingPoint {
    pub frame: Darboux,
    /// Angle from the meridian, which goes up along the axis, towards the direction in which the mandrel turns; in `(-π, π]`.
    pub angle: f64,
    /// Angle around the axis from the start, over all turns.
    pub theta: f64,
    /// Distance from the axis.
    pub radius: f64,
    /// Along the axis.
    pub height: f64,
    /// `λ`.
    pub slippage: f64,
}

/// Where a path of winding ends before its greatest length.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Until {
    /// Only there.
    Length,
    /// Where it is along a parallel: the turn at a polar opening.
    Turn,
    /// Where the angle from the meridian reaches a value.
    Angle(f64),
    /// Where it passes a height, going up along the axis or down.
    Height { height: f64, way: Way },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    Up,
    Down,
}

/// Whether a path of winding has come to where it was to end.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    AsAsked,
    AtGreatestLength,
}

/// The start of a path of winding: a point near the surface and the angle from the meridian.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Start {
    pub point: Point<3>,
    pub angle: f64,
}

/// A path of winding.
#[derive(Clone, Debug, PartialEq)]
pub struct WindingPath {
    pub points: Vec<WindingPoint>,
    pub ended: Ended,
    /// Arc lengths between which the mandrel is not convex along the yarn: it bridges.
    pub bridges: Vec<[f64; 2]>,
    /// Where the path is along a parallel.
    pub turns: Vec<WindingPoint>,
}

impl WindingPath {
    pub fn start(&self) -> &WindingPoint {
        &self.points[0]
    }

    pub fn end(&self) -> &WindingPoint {
        &self.points[self.points.len() - 1]
    }

    /// The largest `|λ|`, with its arc length.
    pub fn largest_slippage(&self) -> (f64, f64) {
        let pairs = self.points.iter().map(|p| (p.slippage.abs(), p.frame.s));
        pairs.max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default()
    }

    /// Arc lengths between which friction does not hold the yarn, by linear interpolation between the points.
    pub fn slipping(&self, friction: f64) -> Vec<[f64; 2]> {
        intervals(self.points.iter().map(|p| (p.frame.s, p.slippage.abs() - friction)))
    }
}

/// The intervals on which a sampled function is positive.
fn intervals(samples: impl Iterator<Item = (f64, f64)>) -> Vec<[f64; 2]> {
    let mut out: Vec<[f64; 2]> = Vec::new();
    let mut last: Option<(f64, f64)> = None;
    for (s, v) in samples {
        let crossing = |(s0, v0): (f64, f64)| s0 + (s - s0) * v0 / (v0 - v);
        match last {
            Some(l) if l.1 > 0.0 => {
                if let Some(open) = out.last_mut() {
                    open[1] = if v > 0.0 { s } else { crossing(l) };
                }
            }
            Some(l) if v > 0.0 => out.push([crossing(l), s]),
            None if v > 0.0 => out.push([s, s]),
            _ => {}
        }
        last = Some((s, v));
    }
    out
}

impl Mandrel<'_> {
    /// Unit vectors along the meridian, up, and along the parallel, at a point of the surface with a normal.
    fn directions(&self, x: &Point<3>, n: &Vector<3>) -> Option<[Vector<3>; 2]> {
        let around = self.axis.direction.cross(&(x - self.axis.origin));
        let parallel = (around - n * n.dot(&around)).try_normalize(1e-14)?;
        Some([n.cross(&parallel), parallel])
    }

    fn radius_and_height(&self, x: &Point<3>) -> (f64, f64) {
        let d = x - self.axis.origin;
        let height = d.dot(&self.axis.direction);
        ((d - self.axis.direction * height).norm(), height)
    }

    /// The normal curvature of a yarn at points of the surface, for angles from the meridian: negative where it is pressed
    /// on, so that any `|λ| <= μ` is stable there. A row per point.
    ///
    /// # Errors
    /// A point without a foot, or on the axis.
    pub fn stability_map(&self, points: &[Point<3>], angles: &[f64]) -> Result<Vec<Vec<f64>>, PathError> {
        let row = |x: &Point<3>| {
            let (x, level) = foot(self.surface, x)?;
            let n = level.gradient.normalize();
            let [m, p] = self.directions(&x, &n).ok_or(PathError::NoTangent { at: x })?;
            Ok(angles.iter().map(|a| Along::new(&level, &(m * a.cos() + p * a.sin())).k_n).collect())
        };
        points.iter().map(row).collect()
    }
}

struct Yarn<'a> {
    mandrel: &'a Mandrel<'a>,
    slippage: &'a Slippage,
    unit: f64,
}

/// Position, tangent and the angle around the axis.
type Y = State<7>;

fn position(y: &Y) -> (Point<3>, Vector<3>) {
    (Point::<3>::new(y[0], y[1], y[2]), Vector::<3>::new(y[3], y[4], y[5]))
}

impl Yarn<'_> {
    fn at(&self, s: f64, x: &Point<3>, tau: &Vector<3>, n: &Vector<3>) -> At {
        let (radius, height) = self.mandrel.radius_and_height(x);
        let [m, p] = self.mandrel.directions(x, n).unwrap_or_default();
        At { s, angle: tau.dot(&p).atan2(tau.dot(&m)), radius, height }
    }

    fn point(&self, s: f64, y: &Y) -> WindingPoint {
        let (x, tau) = position(y);
        let level = self.mandrel.surface.level(&x);
        let along = Along::new(&level, &tau);
        let at = self.at(s, &x, &tau, &along.n);
        let slippage = self.slippage.at(&at);
        let gap = level.value / level.gradient.norm();
        let frame = Darboux::from_parts(s, x, tau, &along, -slippage * along.k_n, gap);
        WindingPoint { frame, angle: at.angle, theta: y[6], radius: at.radius, height: at.height, slippage }
    }

    /// Positive where the yarn goes up.
    fn rise(&self, y: &Y) -> f64 {
        let (x, tau) = position(y);
        let n = self.mandrel.surface.level(&x).gradient.normalize();
        self.mandrel.directions(&x, &n).map_or(f64::NAN, |[m, _]| tau.dot(&m))
    }

    fn k_n(&self, y: &Y) -> f64 {
        let (x, tau) = position(y);
        Along::new(&self.mandrel.surface.level(&x), &tau).k_n
    }

    /// Where a function of the state changes its sign within a step: the steps of part of its length are of the same order.
    fn locate(&self, s: f64, y: &Y, to: f64, f: impl Fn(f64, &Y) -> f64) -> (f64, Y) {
        let slope = self.slope(s, y);
        let at = |h: f64| {
            let mut state = step(self, s, y, &slope, h).0;
            self.restore(&mut state);
            state
        };
        let h = crate::root::bracketed(|h| f(s + h, &at(h)), [0.0, to - s]);
        (s + h, at(h))
    }
}

impl System<7> for Yarn<'_> {
    fn slope(&self, s: f64, y: &Y) -> Y {
        let (x, tau) = position(y);
        let along = Along::new(&self.mandrel.surface.level(&x), &tau);
        let lambda = match self.slippage {
            Slippage::Constant(value) => *value,
            Slippage::Variable(f) => f(&self.at(s, &x, &tau, &along.n)),
        };
        let bend = (along.n - along.g * lambda) * along.k_n;
        let d = x - self.mandrel.axis.origin;
        let k = self.mandrel.axis.direction;
        let across = d - k * k.dot(&d);
        let turn = tau.dot(&k.cross(&across)) / across.norm_squared();
        Y::from([tau[0], tau[1], tau[2], bend[0], bend[1], bend[2], turn])
    }

    fn restore(&self, y: &mut Y) {
        let (mut x, mut tau) = position(y);
        restore(self.mandrel.surface, &mut x, &mut tau);
        for k in 0..3 {
            y[k] = x[k];
            y[3 + k] = tau[k];
        }
    }

    fn scale(&self) -> Y {
        let l = self.unit;
        Y::from([l, l, l, 1.0, 1.0, 1.0, 1.0])
    }
}

/// The path of a yarn from a start, with a point every `spacing` at least, no longer than `longest`.
///
/// # Errors
/// A start without a foot or on the axis; lengths that are not positive; a surface that is not smooth.
pub fn wind(
    mandrel: &Mandrel<'_>,
    start: &Start,
    slippage: &Slippage,
    until: Until,
    longest: f64,
    spacing: f64,
) -> Result<WindingPath, PathError> {
    for (what, value) in [("greatest length", longest), ("spacing", spacing)] {
        if !(value.is_finite() && value > 0.0) {
            return Err(PathError::Input { what, value, valid: "a number greater than zero" });
        }
    }
    let (x, level) = foot(mandrel.surface, &start.point)?;
    let n = level.gradient.normalize();
    let [m, p] = mandrel.directions(&x, &n).ok_or(PathError::NoTangent { at: x })?;
    let tau = m * start.angle.cos() + p * start.angle.sin();
    let radius = 1.0 / curvature(&level);
    let unit = if radius.is_finite() { radius.min(longest) } else { longest };
    let yarn = Yarn { mandrel, slippage, unit };
    let mut y = Y::from([x[0], x[1], x[2], tau[0], tau[1], tau[2], 0.0]);
    let mut path = WindingPath {
        points: vec![yarn.point(0.0, &y)],
        ended: Ended::AtGreatestLength,
        bridges: Vec::new(),
        turns: Vec::new(),
    };
    if path.points[0].frame.k_n >= 0.0 {
        path.bridges.push([0.0, longest]);
    }
    // Positive before the end, negative after it.
    let first = yarn.at(0.0, &x, &tau, &n).angle;
    let ending = |s: f64, y: &Y| match until {
        Until::Length => 1.0,
        Until::Turn => yarn.rise(y) * if first.abs() > FRAC_PI_2 { -1.0 } else { 1.0 },
        Until::Angle(angle) => {
            let (x, tau) = position(y);
            let n = mandrel.surface.level(&x).gradient.normalize();
            (angle - yarn.at(s, &x, &tau, &n).angle) * if angle > first { 1.0 } else { -1.0 }
        }
        Until::Height { height, way } => {
            let beyond = height - mandrel.radius_and_height(&position(y).0).1;
            if way == Way::Up { beyond } else { -beyond }
        }
    };
    let mut s = 0.0;
    let first_step = 0.2 * unit;
    while s < longest && path.ended == Ended::AtGreatestLength {
        let to = (s + spacing).min(longest);
        let control = Control { tolerance: TOLERANCE, first: first_step };
        let mut end = None;
        let (at, reached) = integrate(&yarn, [s, to], &y, control, |s0, y0, s1, y1| {
            let stop = ending(s0, y0) > 0.0 && ending(s1, y1) <= 0.0;
            let (last, last_y) = if stop { yarn.locate(s0, y0, s1, ending) } else { (s1, *y1) };
            if yarn.rise(y0) * yarn.rise(&last_y) < 0.0 {
                let (s, y) = yarn.locate(s0, y0, last, |_, y| yarn.rise(y));
                path.turns.push(yarn.point(s, &y));
            }
            let (before, after) = (yarn.k_n(y0) >= 0.0, yarn.k_n(&last_y) >= 0.0);
            if before != after {
                let at = yarn.locate(s0, y0, last, |_, y| yarn.k_n(y)).0;
                match path.bridges.last_mut() {
                    Some(open) if before => open[1] = at,
                    _ => path.bridges.push([at, longest]),
                }
            }
            if stop {
                end = Some((last, last_y));
                return Next::Stop;
            }
            Next::Continue
        })?;
        (s, y) = end.unwrap_or((at, reached));
        if end.is_some() {
            path.ended = Ended::AsAsked;
        }
        path.points.push(yarn.point(s, &y));
    }
    if until == Until::Length {
        path.ended = Ended::AsAsked;
    }
    if until == Until::Turn && path.ended == Ended::AsAsked && path.turns.is_empty() {
        path.turns.push(*path.end());
    }
    if let Some(last) = path.bridges.last_mut() {
        last[1] = last[1].min(s);
    }
    Ok(path)
}
