//! Closed oriented curves of the plane, as periodic splines.

use crate::rule::gauss_legendre;
use crate::spline::{MAX_DEGREE, PeriodicBasis};
use crate::{Point, Vector, polygon};

/// Samples per knot interval, from which searches start.
const SAMPLES_PER_KNOT: usize = 8;

/// A closed curve. The inside lies to the left of the direction of travel, so an outer boundary runs counter-clockwise
/// and a hole clockwise; the normal points to the right, out of the inside.
#[derive(Clone, Debug)]
pub struct ClosedCurve {
    basis: PeriodicBasis,
    coefficients: Vec<[f64; 2]>,
    /// The polynomial of each knot interval in the distance from its middle, by rising powers, one behind the other.
    pieces: Vec<Point<2>>,
    samples: Vec<Point<2>>,
}

/// A point of a curve with its frame.
#[derive(Clone, Copy, Debug)]
pub struct CurvePoint {
    pub s: f64,
    pub position: Point<2>,
    /// Unit normal, to the right of the direction of travel.
    pub normal: Vector<2>,
    /// `div n`: positive where the inside is convex.
    pub curvature: f64,
    /// Length of the derivative of the position with respect to the parameter.
    pub speed: f64,
}

impl ClosedCurve {
    /// The curve of the given degree that passes through `points` at equal steps of its parameter.
    pub fn through(points: &[Point<2>], degree: usize) -> Self {
        let basis = PeriodicBasis { degree, count: points.len() };
        let values: Vec<[f64; 2]> = points.iter().map(|p| [p[0], p[1]]).collect();
        Self::with(basis, basis.interpolate(&values))
    }

    fn with(basis: PeriodicBasis, coefficients: Vec<[f64; 2]>) -> Self {
        let n = coefficients.len() * SAMPLES_PER_KNOT;
        let powers = basis.powers();
        let piece = |cell: usize| {
            let coefficients = &coefficients;
            powers.iter().map(move |of_bumps| {
                let term = |(i, v): (usize, &f64)| *v * Point::from(coefficients[basis.bump_at(cell, i)]);
                of_bumps.iter().enumerate().map(term).sum::<Point<2>>()
            })
        };
        let pieces = (0..basis.count).flat_map(piece).collect();
        let mut curve = Self { basis, coefficients, pieces, samples: Vec::new() };
        curve.samples = (0..n).map(|i| curve.position(i as f64 / n as f64)).collect();
        curve
    }

    /// A smooth curve along a polyline: the polyline is averaged over each knot interval, so that the corners of a
    /// sampled outline do not ripple the spline.
    pub fn along(polyline: &[Point<2>], degree: usize, count: usize) -> Self {
        Self::evenly_along(polyline, degree, count, |_| 1.0)
    }

    /// The same with knots at equal steps of the integral of a density along it.
    pub fn evenly_along(
        polyline: &[Point<2>],
        degree: usize,
        count: usize,
        density: impl Fn(&Point<2>) -> f64,
    ) -> Self {
        let weighed = |a: &Point<2>, b: &Point<2>| (b - a).norm() * density(&(0.5 * (a + b)));
        let length: f64 = polygon::edges(polyline).map(|(a, b)| weighed(a, b)).sum();
        let fine = 8;
        let total = count * fine;
        let mut dense = Vec::with_capacity(total);
        let mut walked = 0.0;
        for (a, b) in polygon::edges(polyline) {
            let step = weighed(a, b);
            while dense.len() < total && length * dense.len() as f64 / total as f64 <= walked + step {
                let t = (length * dense.len() as f64 / total as f64 - walked) / step.max(f64::MIN_POSITIVE);
                dense.push(a + t.clamp(0.0, 1.0) * (b - a));
            }
            walked += step;
        }
        dense.resize(total, polyline[0]);
        let averaged: Vec<Point<2>> = (0..count)
            .map(|k| {
                let window = (0..=fine).map(|j| dense[(k * fine + total + j - fine / 2) % total]);
                window.sum::<Point<2>>() / (fine as f64 + 1.0)
            })
            .collect();
        Self::through(&averaged, degree).evenly(count, density)
    }

    /// The polynomial of the knot interval that a parameter lies in, and the distance from its middle.
    fn piece(&self, s: f64) -> (&[Point<2>], f64) {
        let (cell, t) = self.basis.interval(s);
        let terms = self.basis.degree + 1;
        (&self.pieces[cell * terms..(cell + 1) * terms], t)
    }

    /// The position at parameter `s` (period one).
    pub fn position(&self, s: f64) -> Point<2> {
        let (piece, t) = self.piece(s);
        piece.iter().rev().fold(Point::zeros(), |x, c| x * t + c)
    }

    /// The position and its first two derivatives with respect to the parameter.
    fn derivatives(&self, s: f64) -> [Point<2>; 3] {
        let (piece, t) = self.piece(s);
        let n = self.basis.count as f64;
        // Horner's rule, and its derivatives by the rule of products.
        let [x, d1, half_d2] = piece
            .iter()
            .rev()
            .fold([Point::zeros(); 3], |[x, d1, half_d2], c| [x * t + c, d1 * t + x, half_d2 * t + d1]);
        [x, d1 * n, half_d2 * (2.0 * n * n)]
    }

    /// The point at parameter `s` with its frame.
    pub fn point(&self, s: f64) -> CurvePoint {
        let [position, d1, d2] = self.derivatives(s);
        let speed = d1.norm().max(f64::MIN_POSITIVE);
        CurvePoint {
            s: s - s.floor(),
            position,
            normal: Vector::<2>::new(d1[1], -d1[0]) / speed,
            curvature: (d1[0] * d2[1] - d1[1] * d2[0]) / speed.powi(3),
            speed,
        }
    }

    /// Points along the curve at equal steps of the parameter, eight for each knot interval.
    pub fn samples(&self) -> &[Point<2>] {
        &self.samples
    }

    /// Parameter of a sample.
    pub fn sample_parameter(&self, i: usize) -> f64 {
        i as f64 / self.samples.len() as f64
    }

    /// The coefficients of the splines, from which [`ClosedCurve::from_coefficients`] makes the same curve again.
    pub fn coefficients(&self) -> &[[f64; 2]] {
        &self.coefficients
    }

    /// The curve of given coefficients; none of too few, of a degree that is not supported, or that are not finite.
    pub fn from_coefficients(degree: usize, coefficients: Vec<[f64; 2]>) -> Option<Self> {
        let finite = coefficients.iter().flatten().all(|v| v.is_finite());
        if coefficients.len() < 3 || !(1..=MAX_DEGREE).contains(&degree) || !finite {
            return None;
        }
        let basis = PeriodicBasis { degree, count: coefficients.len() };
        Some(Self::with(basis, coefficients))
    }

    /// Number of knots.
    pub fn knots(&self) -> usize {
        self.basis.count
    }

    pub fn degree(&self) -> usize {
        self.basis.degree
    }

    /// Integral of `f` over the curve with respect to arc length.
    pub fn integrate(&self, f: impl Fn(&CurvePoint) -> f64) -> f64 {
        let rule = gauss_legendre(self.basis.degree / 2 + 3);
        let n = self.basis.count as f64;
        (0..self.basis.count)
            .flat_map(|k| rule.iter().map(move |&(x, w)| ((k as f64 + x) / n, w / n)))
            .map(|(s, w)| {
                let p = self.point(s);
                w * p.speed * f(&p)
            })
            .sum()
    }

    pub fn length(&self) -> f64 {
        self.integrate(|_| 1.0)
    }

    /// Enclosed area, negative for a curve that runs clockwise (Green's theorem).
    pub fn signed_area(&self) -> f64 {
        0.5 * self.integrate(|p| p.position.dot(&p.normal))
    }

    /// Whether the curve bounds a hole: whether it runs clockwise.
    pub fn is_hole(&self) -> bool {
        polygon::signed_area(&self.samples) < 0.0
    }

    /// The largest speed at the knots over the least: one where the parameter is the arc length.
    pub fn unevenness(&self) -> f64 {
        let speeds = (0..self.knots()).map(|i| self.point(i as f64 / self.knots() as f64).speed);
        let (least, most) = speeds.fold((f64::INFINITY, 0.0f64), |(l, m), s| (l.min(s), m.max(s)));
        most / least
    }

    /// The same curve with `count` knots at equal steps of arc length.
    pub fn by_arc_length(&self, count: usize) -> Self {
        self.evenly(count, |_| 1.0)
    }

    /// The same curve with `count` knots at equal steps of the integral of a density along it, which must be as smooth as the
    /// curve is to be.
    pub fn evenly(&self, count: usize, density: impl Fn(&Point<2>) -> f64) -> Self {
        let rule = gauss_legendre(self.basis.degree / 2 + 3);
        let fine = 4 * self.basis.count.max(count);
        let speed = |s: f64| {
            let p = self.point(s);
            p.speed * density(&p.position)
        };
        let interval =
            |a: f64, b: f64| -> f64 { rule.iter().map(|&(x, w)| w * (b - a) * speed(a + x * (b - a))).sum() };
        let knot = |k: usize| k as f64 / fine as f64;
        let mut walked = vec![0.0];
        for k in 0..fine {
            walked.push(walked[k] + interval(knot(k), knot(k + 1)));
        }
        let total = walked[fine];
        let mut k = 0;
        let points: Vec<Point<2>> = (0..count)
            .map(|i| {
                let target = total * i as f64 / count as f64;
                while k + 1 < fine && walked[k + 1] < target {
                    k += 1;
                }
                // Newton on the integral within the interval; the integrand is its derivative.
                let mut s =
                    knot(k) + (target - walked[k]) / (walked[k + 1] - walked[k]).max(f64::MIN_POSITIVE) / fine as f64;
                for _ in 0..20 {
                    let step = (walked[k] + interval(knot(k), s) - target) / speed(s);
                    s -= step;
                    if step.abs() < 1e-15 {
                        break;
                    }
                }
                self.position(s)
            })
            .collect();
        Self::through(&points, self.basis.degree)
    }

    /// The curve moved by `distance` along its normal, on the same parameter.
    ///
    /// `knots` is the number of interpolation points of the new curve.
    pub fn offset(&self, knots: usize, distance: impl Fn(&CurvePoint) -> f64) -> Self {
        let points: Vec<Point<2>> = (0..knots)
            .map(|i| {
                let p = self.point(i as f64 / knots as f64);
                p.position + distance(&p) * p.normal
            })
            .collect();
        Self::through(&points, self.basis.degree)
    }

    /// The point nearest to `x`, searched from the nearest of the samples `seeds`.
    ///
    /// Newton on `(C(s) - x)·C'(s) = 0`, kept within the neighbouring samples of the seed.
    pub fn closest(&self, x: &Point<2>, seeds: impl Iterator<Item = usize>) -> CurvePoint {
        let seed = seeds
            .map(|i| (i, (self.samples[i] - x).norm_squared()))
            .fold((0, f64::INFINITY), |best, new| if new.1 < best.1 { new } else { best })
            .0;
        let width = 1.5 / self.samples.len() as f64;
        let start = self.sample_parameter(seed);
        let mut s = start;
        for _ in 0..30 {
            let [c, d1, d2] = self.derivatives(s);
            let slope = (c - x).dot(&d1);
            let full = d1.norm_squared() + (c - x).dot(&d2);
            // Beyond the centre of curvature the full second derivative is not positive; Gauss-Newton still descends.
            let second = if full > 0.1 * d1.norm_squared() { full } else { d1.norm_squared() };
            let next = (s - slope / second).clamp(start - width, start + width);
            let step = (next - s).abs();
            s = next;
            // What is left is of the order of the square.
            if step < 1e-9 {
                break;
            }
        }
        self.point(s)
    }

    /// Signed distance to the curve near `x`, negative on the inside, as `(x - C)·n` at the closest point.
    pub fn signed_distance(&self, x: &Point<2>, seeds: impl Iterator<Item = usize>) -> (f64, CurvePoint) {
        let foot = self.closest(x, seeds);
        ((x - foot.position).dot(&foot.normal), foot)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    fn circle(radius: f64, degree: usize, count: usize) -> ClosedCurve {
        let points: Vec<Point<2>> = (0..count)
            .map(|i| {
                let a = 2.0 * PI * i as f64 / count as f64;
                Point::<2>::new(0.1 + radius * a.cos(), radius * a.sin())
            })
            .collect();
        ClosedCurve::through(&points, degree)
    }

    #[test]
    fn a_circle_has_its_length_area_curvature_and_normal() {
        let c = circle(0.5, 9, 24);
        assert!((c.length() - PI).abs() < 1e-10);
        assert!((c.signed_area() - 0.25 * PI).abs() < 1e-10);
        let p = c.point(0.3);
        assert!((p.curvature - 2.0).abs() < 1e-7);
        assert!((p.normal - (p.position - Point::<2>::new(0.1, 0.0)).normalize()).norm() < 1e-9);
        assert!(!c.is_hole());
    }

    #[test]
    fn knots_lie_at_equal_steps_of_a_density() {
        // ∫ (1 + 3 cos a) r da over an arc of the circle.
        let (radius, density) = (0.5, |x: &Point<2>| 4.0 + 6.0 * (x[0] - 0.1));
        let weighed = |a: f64| radius * (4.0 * a + 6.0 * radius * a.sin());
        let count = 64;
        let even = circle(radius, 9, 48).evenly(count, density);
        for k in 0..count {
            let at = |k: usize| {
                let x = even.point(k as f64 / count as f64).position;
                x[1].atan2(x[0] - 0.1)
            };
            let arc = |a: f64, b: f64| weighed(if b < a { b + 2.0 * PI } else { b }) - weighed(a);
            let step = arc(at(k), at(k + 1)) * count as f64 / weighed(2.0 * PI);
            assert!((step - 1.0).abs() < 1e-6, "{k}: {step}");
        }
        assert!((even.length() - PI).abs() < 1e-6, "{}", even.length() - PI);
        assert!(even.unevenness() > 3.0);
    }

    #[test]
    fn closest_points_are_orthogonal_and_signed() {
        let c = circle(0.5, 7, 24);
        for i in 0..50 {
            let a = 0.37 * i as f64;
            let r = 0.5 + 0.2 * (1.7 * a).sin();
            let x = Point::<2>::new(0.1 + r * a.cos(), r * a.sin());
            let (d, foot) = c.signed_distance(&x, 0..c.samples().len());
            assert!((d - (r - 0.5)).abs() < 1e-7, "{d} {r}");
            let tangent = Vector::<2>::new(-foot.normal[1], foot.normal[0]);
            assert!((x - foot.position).dot(&tangent).abs() < 1e-12);
        }
    }

    #[test]
    fn arc_length_equalises_the_speed_and_keeps_the_shape() {
        let points: Vec<Point<2>> = (0..40)
            .map(|i| {
                let a = 2.0 * PI * (i as f64 / 40.0 + 0.05 * (2.0 * PI * i as f64 / 40.0).sin());
                Point::<2>::new(a.cos(), 0.7 * a.sin())
            })
            .collect();
        let raw = ClosedCurve::through(&points, 9);
        let even = raw.by_arc_length(40);
        assert!((raw.length() - even.length()).abs() < 1e-6);
        let speeds: Vec<f64> = (0..100).map(|i| even.point(i as f64 / 100.0).speed).collect();
        let (lo, hi) = speeds.iter().fold((f64::MAX, 0.0f64), |(l, h), &v| (l.min(v), h.max(v)));
        assert!(hi / lo < 1.0 + 1e-4);
    }
}
