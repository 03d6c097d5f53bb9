//! The curve along which a body lies at the start, and its division into elements.
//!
//! A path is a curve of the geometry layer or a sequence of points; [`Path::sample`] divides it by its length.

pub(crate) mod read;
mod sample;

pub use sample::Sampled;

use crate::centreline::Closure;
use signorini_geometry::shape::{Axes, Curve, ShapeError};
use signorini_geometry::{Point, Vector};

/// A path that cannot be followed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PathError {
    #[error("{given} points: a {what} requires at least {needed}")]
    TooFewPoints { what: &'static str, given: usize, needed: usize },
    #[error("points {first} and {second} coincide at ({}, {}, {})", at[0], at[1], at[2])]
    Repeated { first: usize, second: usize, at: [f64; 3] },
    #[error("point {index} = ({}, {}, {}) is not finite", at[0], at[1], at[2])]
    NotFinite { index: usize, at: [f64; 3] },
    #[error(
        "the path turns by {degrees:.3}° at ({}, {}, {}), but a smooth curve is required: give a spline through the \
         points, or straight cells",
        at[0], at[1], at[2]
    )]
    Kink { at: [f64; 3], degrees: f64 },
    #[error("the path crosses itself at ({:.4}, {:.4}, {:.4}), at the arc lengths {first:.4} and {second:.4}", at[0], at[1], at[2])]
    CrossesItself { at: [f64; 3], first: f64, second: f64 },
    #[error("{given} cells: the path requires at least {needed}")]
    TooFewCells { given: usize, needed: usize },
    #[error("the three points are collinear or coincide, so they define no arc")]
    NoArc,
    #[error("{name} = {value}: {valid}")]
    Number { name: &'static str, value: f64, valid: &'static str },
    #[error("line {line}: {message}")]
    File { line: u64, message: String },
    #[error(transparent)]
    Shape(#[from] ShapeError),
}

/// A curve in space with a direction.
#[derive(Clone, Debug)]
pub struct Path {
    curve: Curve,
    closure: Closure,
    /// Parameters between which the curve is smooth.
    breaks: Vec<f64>,
}

pub(crate) fn array(p: &Point<3>) -> [f64; 3] {
    [p[0], p[1], p[2]]
}

fn check(what: &'static str, points: &[Point<3>], closure: Closure) -> Result<(), PathError> {
    let needed = if closure == Closure::Closed { 3 } else { 2 };
    if points.len() < needed {
        return Err(PathError::TooFewPoints { what, given: points.len(), needed });
    }
    if let Some(index) = points.iter().position(|p| !p.iter().all(|x| x.is_finite())) {
        return Err(PathError::NotFinite { index, at: array(&points[index]) });
    }
    let last = if closure == Closure::Closed { points.len() } else { points.len() - 1 };
    for first in 0..last {
        let second = (first + 1) % points.len();
        if points[first] == points[second] {
            return Err(PathError::Repeated { first, second, at: array(&points[first]) });
        }
    }
    Ok(())
}

impl Path {
    fn through(curve: Curve, closure: Closure, pieces: usize) -> Self {
        let [from, to] = curve.domain();
        let breaks = (0..=pieces).map(|k| from + (to - from) * k as f64 / pieces as f64).collect();
        Path { curve, closure, breaks }
    }

    /// Straight from point to point; a closed one returns to the first.
    ///
    /// # Errors
    /// Too few points, points that coincide or are not finite.
    pub fn points(points: &[Point<3>], closure: Closure) -> Result<Self, PathError> {
        check("path", points, closure)?;
        let is_closed = closure == Closure::Closed;
        let pieces = if is_closed { points.len() } else { points.len() - 1 };
        Ok(Self::through(Curve::polyline(points, is_closed)?, closure, pieces))
    }

    /// The cubic spline through points, with chord lengths as parameters; natural at its ends.
    ///
    /// # Errors
    /// Too few points, points that coincide or are not finite.
    pub fn spline(points: &[Point<3>], closure: Closure) -> Result<Self, PathError> {
        check("spline", points, closure)?;
        let mut points = points.to_vec();
        if closure == Closure::Closed {
            points.push(points[0]);
        }
        let tangents = spline_derivatives(&points, closure);
        // Pieces of the Hermite curve have parameters of length one: derivatives are scaled by the chords of the piece.
        let mut pieces = Vec::new();
        for k in 0..points.len() - 1 {
            let chord = (points[k + 1] - points[k]).norm();
            pieces.push([points[k], tangents[k] * chord, points[k + 1], tangents[k + 1] * chord]);
        }
        let control: Vec<Point<3>> = (pieces.iter().enumerate())
            .flat_map(|(k, [p, t, q, u])| {
                let all = [*p, p + t / 3.0, q - u / 3.0, *q];
                all.into_iter().skip(usize::from(k > 0)).collect::<Vec<_>>()
            })
            .collect();
        let n = pieces.len();
        let knots: Vec<f64> = (std::iter::once(0.0))
            .chain((0..=n).flat_map(|k| [k as f64; 3]))
            .chain(std::iter::once(n as f64))
            .collect();
        Ok(Self::through(Curve::nurbs(3, &knots, &control, None, false)?, closure, n))
    }

    /// The arc of a circle from the first to the last of three points through the middle one.
    ///
    /// # Errors
    /// Points on a line.
    pub fn arc(points: [Point<3>; 3]) -> Result<Self, PathError> {
        check("arc", &points, Closure::Open)?;
        let (a, b) = (points[0] - points[2], points[1] - points[2]);
        let normal = a.cross(&b);
        let area = normal.norm_squared();
        if area <= 1e-20 * a.norm_squared() * b.norm_squared() || area == 0.0 {
            return Err(PathError::NoArc);
        }
        let centre = points[2] + (b * a.norm_squared() - a * b.norm_squared()).cross(&normal) / (2.0 * area);
        let ex = points[0] - centre;
        let radius = ex.norm();
        let (ex, ez) = (ex / radius, normal.normalize());
        // Seen along the normal of first, middle, last the arc runs the way the points are passed.
        let ey = ez.cross(&ex);
        let angle = |p: &Point<3>| {
            let d = p - centre;
            d.dot(&ey).atan2(d.dot(&ex)).rem_euclid(std::f64::consts::TAU)
        };
        let (middle, end) = (angle(&points[1]), angle(&points[2]));
        if middle < end {
            Self::circle(centre, ex, ey, radius, end)
        } else {
            Self::circle(centre, ex, -ey, radius, std::f64::consts::TAU - end)
        }
    }

    /// An arc about a centre, from `centre + radius ex` towards `ey`; closed where the angle is a full turn.
    ///
    /// # Errors
    /// A radius or an angle that is not positive, axes that are not orthonormal.
    pub fn circle(centre: Point<3>, ex: Vector<3>, ey: Vector<3>, radius: f64, angle: f64) -> Result<Self, PathError> {
        if !(angle > 0.0 && angle <= std::f64::consts::TAU * (1.0 + 1e-12)) {
            return Err(PathError::Number { name: "angle", value: angle, valid: "valid are 0 to 2π, without 0" });
        }
        let is_full = angle >= std::f64::consts::TAU * (1.0 - 1e-12);
        let angle = if is_full { std::f64::consts::TAU } else { angle };
        let curve = Curve::circle(Axes::new(centre, ex, ey)?, radius, [0.0, angle], false)?;
        Ok(Self::through(curve, if is_full { Closure::Closed } else { Closure::Open }, 4))
    }

    /// A helix about `axes.ez` from `origin + radius ex`, which rises by `pitch` per turn.
    ///
    /// # Errors
    /// A radius or number of turns that is not positive.
    pub fn helix(axes: Axes, radius: f64, pitch: f64, turns: f64) -> Result<Self, PathError> {
        if !(turns > 0.0 && turns.is_finite()) {
            return Err(PathError::Number { name: "turns", value: turns, valid: "valid are positive numbers" });
        }
        let range = [0.0, std::f64::consts::TAU * turns];
        let curve = Curve::helix(axes, radius, pitch / std::f64::consts::TAU, range)?;
        Ok(Self::through(curve, Closure::Open, (4.0 * turns).ceil() as usize))
    }

    /// A curve of the geometry layer, smooth between the given number of equal parts of its parameters.
    pub fn curve(curve: Curve, pieces: usize) -> Self {
        let closure = if curve.is_closed() { Closure::Closed } else { Closure::Open };
        Self::through(curve, closure, pieces.max(1))
    }

    /// The curve by itself.
    pub fn into_curve(self) -> Curve {
        self.curve
    }

    /// Straight from point to point of a table of three columns: coordinates separated by commas, semicolons, tabs or
    /// blanks; lines that start with `#` and one line of names are passed over.
    ///
    /// # Errors
    /// Lines that are not three numbers, with their number; points as in [`Path::points`].
    pub fn table(text: &str, closure: Closure) -> Result<Self, PathError> {
        Self::points(&read::points(text)?, closure)
    }

    /// The points of such a table.
    ///
    /// # Errors
    /// Lines that are not three numbers, with their number.
    pub fn read_points(text: &str) -> Result<Vec<Point<3>>, PathError> {
        read::points(text)
    }
}

/// Derivatives of the cubic spline at its points: continuous second derivatives, natural or periodic ends.
fn spline_derivatives(points: &[Point<3>], closure: Closure) -> Vec<Vector<3>> {
    let n = points.len();
    let chord: Vec<f64> = points.windows(2).map(|p| (p[1] - p[0]).norm()).collect();
    let slope: Vec<Vector<3>> = (0..n - 1).map(|k| (points[k + 1] - points[k]) / chord[k]).collect();
    let size = if closure == Closure::Closed { n - 1 } else { n };
    let mut lower = vec![0.0; size];
    let mut diagonal = vec![0.0; size];
    let mut upper = vec![0.0; size];
    let mut right = vec![Vector::<3>::zeros(); size];
    for k in 0..size {
        let [before, after] = match (closure, k) {
            (Closure::Closed, 0) => [n - 2, 0],
            (Closure::Open, 0) => {
                (diagonal[k], upper[k], right[k]) = (2.0, 1.0, slope[0] * 3.0);
                continue;
            }
            (Closure::Open, k) if k == n - 1 => {
                (lower[k], diagonal[k], right[k]) = (1.0, 2.0, slope[n - 2] * 3.0);
                continue;
            }
            _ => [k - 1, k],
        };
        let (h, g) = (chord[before], chord[after]);
        (lower[k], diagonal[k], upper[k]) = (g, 2.0 * (g + h), h);
        right[k] = (slope[before] * g + slope[after] * h) * 3.0;
    }
    let solve = |right: &[Vector<3>], diagonal: &[f64]| {
        let (mut d, mut r) = (diagonal.to_vec(), right.to_vec());
        for k in 1..size {
            let f = lower[k] / d[k - 1];
            d[k] -= f * upper[k - 1];
            let before = r[k - 1];
            r[k] -= before * f;
        }
        for k in (0..size).rev() {
            if k + 1 < size {
                let after = r[k + 1];
                r[k] -= after * upper[k];
            }
            r[k] /= d[k];
        }
        r
    };
    match closure {
        Closure::Open => solve(&right, &diagonal),
        Closure::Closed => {
            // A cyclic tridiagonal system by the formula of Sherman and Morrison.
            let (a, c) = (lower[0], upper[size - 1]);
            let gamma = -diagonal[0];
            let mut d = diagonal.clone();
            d[0] -= gamma;
            d[size - 1] -= a * c / gamma;
            let mut u = vec![Vector::<3>::zeros(); size];
            u[0] = Vector::<3>::repeat(gamma);
            u[size - 1] = Vector::<3>::repeat(c);
            let (x, z) = (solve(&right, &d), solve(&u, &d));
            let factor = (x[0] + x[size - 1] * (a / gamma)) / (1.0 + z[0][0] + z[size - 1][0] * a / gamma);
            let mut out: Vec<Vector<3>> = (0..size).map(|k| x[k] - factor * z[k][0]).collect();
            out.push(out[0]);
            out
        }
    }
}
