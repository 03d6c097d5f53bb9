//! Where projections exist and are unique: domains, focal sets, reach.
//!
//! A point at the signed distance `ξ` along the normal of a surface projects back as long as `1 - ξ κ > 0` for both
//! principal curvatures; a point at the distance `r` from a curve as long as `r k cos φ < 1`. That is local. The
//! projection is unique up to the medial axis; the *reach* of a shape is the distance at which that can first happen:
//! the smaller of the least radius of curvature and half the shortest double normal (Federer 1959, Aamari et al. 2019).

use crate::closest::{FeatureKind, Query, clearance_of, closest};
use crate::frame::{CurveFrame, SurfaceFrame};
use crate::shape::{Curve, Shape, Surface};
use crate::{Point, Vector};

/// Where a point stands with respect to the projection domain of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DomainReport {
    /// The closest point is interior, and a strict minimum: the coordinates of the shape exist at the point.
    pub inside: bool,
    pub feature: FeatureKind,
    /// No other point of the shape is as close.
    pub unique: bool,
    /// `1 - d κ` in the worst direction; zero on the focal set.
    pub lambda_min: f64,
    /// The point may move by this in any direction and its closest point stays unique; a guaranteed bound, not the
    /// largest one. Zero where nothing could be proved.
    pub clearance: f64,
}

/// Whether a point lies in the projection domain of a curve or surface, and how far it is from leaving.
pub fn projection_domain(p: &Point<3>, shape: &Shape) -> DomainReport {
    let point = Shape::Point(*p);
    let projection = closest(&point, shape, &Query::default());
    let found = &projection.closest;
    let interior = found.b.feature.kind == FeatureKind::Interior;
    let unique = projection.uniqueness.is_unique();
    DomainReport {
        inside: interior && unique && found.lambda_min > 0.0,
        feature: found.b.feature.kind,
        unique,
        lambda_min: found.lambda_min,
        clearance: if unique { clearance_of(p, shape, found) } else { 0.0 },
    }
}

/// The centres of curvature of a surface over one of its points: where the focal set meets the normal. `None` where a
/// principal curvature vanishes or the parametrisation is degenerate.
pub fn focal_points(surface: &Surface, u: f64, v: f64) -> [Option<Point<3>>; 2] {
    let jet = surface.jet(u, v);
    let Some(frame) = SurfaceFrame::new(&jet) else { return [None; 2] };
    frame.principal_curvatures().map(|(k, _)| (k != 0.0).then(|| jet.x + frame.normal / k))
}

/// The polar line of a curve: its centre of curvature and its direction. Points on it have no strictly closest point
/// there. `None` where the curvature vanishes.
pub fn polar_line(curve: &Curve, t: f64) -> Option<(Point<3>, Vector<3>)> {
    let jet = curve.jet(t);
    let frame = CurveFrame::frenet(&jet)?;
    Some((jet.x + frame.normal / frame.curvature, frame.binormal))
}

/// What limits the reach of a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reach {
    /// The least radius of curvature; infinite for straight and flat shapes.
    pub least_radius: f64,
    /// Half the shortest segment that is normal to the shape at both ends; infinite where there is none.
    pub half_bottleneck: f64,
}

impl Reach {
    /// Points closer to the smooth interior of the shape than this have one closest point there.
    pub fn value(&self) -> f64 {
        self.least_radius.min(self.half_bottleneck)
    }
}

/// Samples per parameter for [`reach_of_curve`].
const CURVE_SAMPLES: usize = 400;
/// Samples per parameter for [`reach_of_surface`].
const SURFACE_SAMPLES: usize = 24;

/// The reach of a curve, from samples refined to rounding. Features finer than the sampling can be missed.
pub fn reach_of_curve(curve: &Curve) -> Reach {
    let [from, to] = curve.domain();
    let radius = |t: f64| {
        let jet = curve.jet(t);
        let curvature = jet.d1.cross(&jet.d2).norm() / jet.d1.norm().powi(3);
        if curvature > 0.0 { 1.0 / curvature } else { f64::INFINITY }
    };
    let n = CURVE_SAMPLES;
    let at = |k: usize| from + (to - from) * k as f64 / n as f64;
    let worst = (0..=n).min_by(|&i, &j| radius(at(i)).total_cmp(&radius(at(j)))).unwrap_or(0);
    let (low, high) = (at(worst.saturating_sub(1)), at((worst + 1).min(n)));
    let least_radius = radius(golden(low, high, radius));
    let samples: Vec<(f64, Point<3>)> = (0..=n).map(|k| (at(k), curve.position(at(k)))).collect();
    let mut half_bottleneck = f64::INFINITY;
    let mut tried = Vec::new();
    for i in 1..n {
        for j in i + 2..n {
            // A sign change of both projections of the chord nearby.
            let changes = |k: usize, other: &Point<3>| {
                let slope = |k: usize| (samples[k].1 - other).dot(&(samples[k + 1].1 - samples[k - 1].1));
                k < 2 || k + 2 > n || slope(k) * slope(k - 1) <= 0.0 || slope(k) * slope(k + 1) <= 0.0
            };
            if changes(i, &samples[j].1) && changes(j, &samples[i].1) {
                tried.push((i, j));
            }
        }
    }
    for (i, j) in tried {
        let mut z = [samples[i].0, samples[j].0];
        let step = (to - from) / n as f64;
        for _ in 0..20 {
            let (p, q) = (curve.jet(z[0]), curve.jet(z[1]));
            let d = p.x - q.x;
            let (g, h) = (p.d1.dot(&d), -q.d1.dot(&d));
            let (a, b, c) = (p.d1.norm_squared() + p.d2.dot(&d), -p.d1.dot(&q.d1), q.d1.norm_squared() - q.d2.dot(&d));
            let det = a * c - b * b;
            z[0] -= (c * g - b * h) / det;
            z[1] -= (a * h - b * g) / det;
            if !z.iter().all(|t| (from..=to).contains(t)) {
                break;
            }
        }
        if !z.iter().all(|t| (from..=to).contains(t)) || (z[0] - z[1]).abs() < step {
            continue;
        }
        let (p, q) = (curve.jet(z[0]), curve.jet(z[1]));
        let d = p.x - q.x;
        let length = d.norm();
        let normal = |t: &Vector<3>| t.dot(&d).abs() <= 1e-9 * t.norm() * length;
        if length > 1e-9 * curve.size() && normal(&p.d1) && normal(&q.d1) {
            half_bottleneck = half_bottleneck.min(0.5 * length);
        }
    }
    Reach { least_radius, half_bottleneck }
}

/// The reach of a surface, from samples refined to rounding. Features finer than the sampling can be missed.
pub fn reach_of_surface(surface: &Surface) -> Reach {
    let [u, v] = surface.domain();
    let n = SURFACE_SAMPLES;
    let at = |i: usize, j: usize| {
        let share = |k: usize| (k as f64 + 0.5) / n as f64;
        let (mut s, mut t) = (share(i), share(j));
        if surface.is_triangle() && s + t > 1.0 {
            (s, t) = (1.0 - s, 1.0 - t);
        }
        [u[0] + (u[1] - u[0]) * s, v[0] + (v[1] - v[0]) * t]
    };
    let radius = |z: [f64; 2]| {
        SurfaceFrame::new(&surface.jet(z[0], z[1])).map_or(f64::INFINITY, |frame| {
            let [(p, _), (q, _)] = frame.principal_curvatures();
            let largest = p.abs().max(q.abs());
            if largest > 0.0 { 1.0 / largest } else { f64::INFINITY }
        })
    };
    let mut points = Vec::with_capacity(n * n);
    let mut worst = [u[0], v[0]];
    let mut least_radius = f64::INFINITY;
    for i in 0..n {
        for j in 0..n {
            let z = at(i, j);
            points.push(z);
            let r = radius(z);
            if r < least_radius {
                (least_radius, worst) = (r, z);
            }
        }
    }
    // Compass search from the worst sample.
    let mut step = [(u[1] - u[0]) / n as f64, (v[1] - v[0]) / n as f64];
    while step[0] > 1e-9 * (u[1] - u[0]) {
        let mut better = false;
        for (k, sign) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
            let mut z = worst;
            z[k] = (z[k] + sign * step[k]).clamp(surface.domain()[k][0], surface.domain()[k][1]);
            if surface.is_triangle() && z[0] + z[1] > 1.0 {
                continue;
            }
            let r = radius(z);
            if r < least_radius {
                (least_radius, worst, better) = (r, z, true);
            }
        }
        if !better {
            step = step.map(|s| 0.5 * s);
        }
    }
    let frames: Vec<Option<(Point<3>, Vector<3>)>> = points
        .iter()
        .map(|z| {
            let jet = surface.jet(z[0], z[1]);
            SurfaceFrame::new(&jet).map(|f| (jet.x, f.normal))
        })
        .collect();
    let mut half_bottleneck = f64::INFINITY;
    for i in 0..points.len() {
        for j in i + 1..points.len() {
            let (Some((x, m)), Some((y, l))) = (&frames[i], &frames[j]) else { continue };
            let d = x - y;
            let length = d.norm();
            // Nearly normal at both ends: worth a Newton.
            if 0.5 * length < half_bottleneck
                && d.dot(m).abs() > 0.95 * length
                && d.dot(l).abs() > 0.95 * length
                && let Some(found) = double_normal(surface, points[i], points[j])
            {
                half_bottleneck = half_bottleneck.min(0.5 * found);
            }
        }
    }
    Reach { least_radius, half_bottleneck }
}

/// The length of the double normal to which Newton converges from a pair of parameters.
fn double_normal(surface: &Surface, a: [f64; 2], b: [f64; 2]) -> Option<f64> {
    let domain = surface.domain();
    let closed = surface.closed();
    let mut z = nalgebra::Vector4::new(a[0], a[1], b[0], b[1]);
    let mut last = None;
    for _ in 0..20 {
        let (p, q) = (surface.jet(z[0], z[1]), surface.jet(z[2], z[3]));
        let d = p.x - q.x;
        let j = [p.u, p.v, -q.u, -q.v];
        let g = nalgebra::Vector4::from_fn(|k, _| j[k].dot(&d));
        let second = |r: usize, c: usize| match (r, c) {
            (0, 0) => p.uu.dot(&d),
            (0, 1) | (1, 0) => p.uv.dot(&d),
            (1, 1) => p.vv.dot(&d),
            (2, 2) => -q.uu.dot(&d),
            (2, 3) | (3, 2) => -q.uv.dot(&d),
            (3, 3) => -q.vv.dot(&d),
            _ => 0.0,
        };
        let h = nalgebra::Matrix4::from_fn(|r, c| j[r].dot(&j[c]) + second(r, c));
        let scale = j.iter().map(|v| v.norm()).fold(0.0, f64::max) * d.norm();
        last = (g.amax() <= 1e-9 * scale).then(|| d.norm());
        z -= h.lu().solve(&g)?;
        let inside = (0..4).all(|k| {
            let [low, high] = domain[k % 2];
            closed[k % 2] || (low..=high).contains(&z[k])
        });
        if !inside {
            return None;
        }
    }
    last.filter(|length| *length > 1e-6 * surface.size())
}

fn golden(mut low: f64, mut high: f64, f: impl Fn(f64) -> f64) -> f64 {
    let ratio = 0.5 * (5f64.sqrt() - 1.0);
    for _ in 0..60 {
        let (a, b) = (high - ratio * (high - low), low + ratio * (high - low));
        if f(a) < f(b) {
            high = b;
        } else {
            low = a;
        }
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Axes;
    use std::f64::consts::TAU;

    #[test]
    fn the_reach_of_known_shapes() {
        let axes = Axes::standard(Point::<3>::zeros());
        let ellipse = Curve::ellipse(axes, 2.0, 1.0, [0.0, TAU], true).unwrap();
        let reach = reach_of_curve(&ellipse);
        assert!((reach.least_radius - 0.5).abs() < 1e-9 && (reach.half_bottleneck - 1.0).abs() < 1e-9, "{reach:?}");
        let torus = Surface::torus(axes, 1.0, 0.4, [[0.0, TAU]; 2], [true, true]).unwrap();
        let reach = reach_of_surface(&torus);
        assert!((reach.value() - 0.4).abs() < 1e-6, "{reach:?}");
        // The hole is wider than the tube is thick; a fat torus is limited by its hole.
        let fat = Surface::torus(axes, 1.0, 0.7, [[0.0, TAU]; 2], [true, true]).unwrap();
        assert!((reach_of_surface(&fat).value() - 0.3).abs() < 1e-6);
        let segment = Curve::segment(Point::<3>::zeros(), Point::<3>::x()).unwrap();
        assert_eq!(reach_of_curve(&segment).value(), f64::INFINITY);
    }

    #[test]
    fn projection_domains_end_at_the_focal_set() {
        let axes = Axes::standard(Point::<3>::zeros());
        let graph = Surface::graph(axes, [0.5, 0.25, 0.0], [[-1.0, 1.0]; 2]).unwrap();
        // At the origin the curvatures are 1 and 1/2.
        let [near, far] = focal_points(&graph, 0.0, 0.0);
        let heights = [near.unwrap().z, far.unwrap().z];
        assert!((heights[0] - 2.0).abs() < 1e-12 && (heights[1] - 1.0).abs() < 1e-12, "{heights:?}");
        let shape: Shape = graph.into();
        let below = projection_domain(&Point::<3>::new(0.0, 0.0, 0.7), &shape);
        assert!(below.inside && (below.lambda_min - 0.3).abs() < 1e-12);
        assert!(below.clearance > 0.01 && below.clearance < 0.3, "{below:?}");
        // Moving by less than the clearance keeps the projection unique.
        for k in 0..20 {
            let direction =
                Vector::<3>::new((1.0 + f64::from(k)).sin(), (2.0 * f64::from(k)).cos(), (3.0 * f64::from(k)).sin())
                    .normalize();
            let moved =
                projection_domain(&(Point::<3>::new(0.0, 0.0, 0.7) + direction * below.clearance * 0.999), &shape);
            assert!(moved.unique && moved.lambda_min > 0.0);
        }
        let beyond = projection_domain(&Point::<3>::new(0.0, 0.0, 1.2), &shape);
        assert!(!beyond.inside && !beyond.unique);
        let outside = projection_domain(&Point::<3>::new(2.0, 0.0, 0.0), &shape);
        assert!(!outside.inside && outside.feature == FeatureKind::Edge);
        let line = polar_line(&Curve::circle(axes, 2.0, [0.0, TAU], true).unwrap(), 1.0).unwrap();
        assert!(line.0.norm() < 1e-12 && (line.1.z.abs() - 1.0).abs() < 1e-12);
    }
}
