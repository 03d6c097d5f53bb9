//! Pairs whose closest points have closed forms, restricted ranges and degenerate positions included.
//!
//! Surfaces of revolution: for a fixed profile parameter `v` the squared distance is `-2 f(v) ρ cos(u - θ)` plus what
//! does not depend on `u`, so that the best angle is `θ`, its opposite where `f < 0`, or an end of the range. For a
//! fixed angle the profile is a line or a circle in the half plane. A handful of candidates is therefore complete.

use std::f64::consts::{PI, TAU};

use super::ellipsoid;
use super::flat::end_feature;
use super::query::Query;
use super::result::{ClosestPair, Foot, Projection, Uniqueness};
use crate::feature::{Entity, Feature, FeatureKind};
use crate::patch::Border;
use crate::scale::length;
use crate::shape::{Axes, Curve, CurveKind, Surface, SurfaceKind};
use crate::straight::{along, closest_on_segment, closest_on_triangle};
use crate::{Point, Vector};

/// A candidate: foot, smallest eigenvalue.
type Candidate = (Foot, f64);

/// Picks the best of a complete set of candidates; `dimension` is that of the continuum around the best, if any.
pub(super) fn settle(p: &Point<3>, candidates: &[Candidate], dimension: usize, size: f64, query: &Query) -> Projection {
    let pair = |(foot, lambda_min): &Candidate| ClosestPair {
        distance: length(&(foot.point - p)),
        a: Foot::of_point(*p),
        b: *foot,
        lambda_min: *lambda_min,
    };
    let mut best = pair(&candidates[0]);
    let mut others = Vec::new();
    if let [_, rest @ ..] = candidates
        && !rest.is_empty()
    {
        let mut pairs: Vec<ClosestPair> = candidates.iter().map(pair).collect();
        pairs.sort_by(|x, y| x.distance.total_cmp(&y.distance));
        best = pairs[0];
        let tie = query.tie * size;
        for other in pairs.into_iter().skip(1) {
            // At a centre of curvature rounding alone separates what is one foot.
            let same = |x: &ClosestPair| {
                let radius = if x.lambda_min.min(other.lambda_min) < 1e-3 { 2e-2 } else { 1e-9 };
                length(&(x.b.point - other.b.point)) <= radius * size
            };
            if other.distance <= best.distance + tie && !same(&best) && !others.iter().any(same) {
                others.push(other);
            }
        }
    }
    let uniqueness = match (dimension, others.is_empty()) {
        (0, true) => Uniqueness::Unique,
        (0, false) => Uniqueness::Multiple,
        (dimension, _) => Uniqueness::Continuum { dimension },
    };
    Projection::known(best, uniqueness, others)
}

/// The closed form for a point and a curve, where there is one.
pub fn point_curve(p: &Point<3>, curve: &Curve, query: &Query) -> Option<Projection> {
    if query.local_minima {
        return None;
    }
    match &curve.kind {
        CurveKind::Segment { p0, p1 } => {
            let t = closest_on_segment(p, p0, p1);
            let feature = end_feature(t, [0.0, 1.0], false);
            let lambda = if feature.kind == FeatureKind::Interior { 1.0 } else { f64::INFINITY };
            Some(settle(p, &[(Foot::new(along(p0, p1, t), feature, &[t]), lambda)], 0, curve.size(), query))
        }
        CurveKind::Circle { axes, radius } => {
            let x = axes.local(p);
            let rho = x.x.hypot(x.y);
            let theta = x.y.atan2(x.x);
            let range = curve.domain();
            let centred = rho <= centre_tolerance(p, axes, *radius);
            let mut candidates = [(Foot::of_point(*p), 0.0); 3];
            let mut count = 0;
            let mut push = |u: f64, lambda: f64| {
                let feature = end_feature(u, range, curve.is_closed());
                let lambda = if feature.kind == FeatureKind::Interior { lambda } else { f64::INFINITY };
                let (sin, cos) = u.sin_cos();
                let x = axes.origin + axes.ex * (radius * cos) + axes.ey * (radius * sin);
                candidates[count] = (Foot::new(x, feature, &[u]), lambda);
                count += 1;
            };
            if centred {
                push(range[0], 0.0);
                return Some(settle(p, &candidates[..1], 1, curve.size(), query));
            }
            match inside(theta, range, curve.is_closed()) {
                Some(u) => push(u, rho / radius),
                None => {
                    push(range[0], f64::INFINITY);
                    push(range[1], f64::INFINITY);
                }
            }
            Some(settle(p, &candidates[..count], 0, curve.size(), query))
        }
        CurveKind::Ellipse { axes, a, b } if curve.is_closed() => {
            let x = axes.local(p);
            let found = ellipsoid::closest(&[*a, *b], &[x.x, x.y])?;
            let range = curve.domain();
            let candidates: Vec<Candidate> = found
                .iter()
                .map(|y| {
                    let u = range[0] + ((y[1] / b).atan2(y[0] / a) - range[0]).rem_euclid(TAU);
                    let jet = curve.jet(u);
                    let lambda = 1.0 + jet.d2.dot(&(jet.x - p)) / jet.d1.norm_squared();
                    (Foot::new(jet.x, Feature::INTERIOR, &[u]), lambda)
                })
                .collect();
            Some(settle(p, &candidates, 0, curve.size(), query))
        }
        _ => None,
    }
}

/// The closed form for a point and a surface, where there is one.
pub fn point_surface(p: &Point<3>, surface: &Surface, query: &Query) -> Option<Projection> {
    if query.local_minima {
        return None;
    }
    let size = surface.size();
    match &surface.kind {
        SurfaceKind::Plane { axes } => {
            let x = axes.local(p);
            let domain = surface.domain();
            let u = x.x.clamp(domain[0][0], domain[0][1]);
            let v = x.y.clamp(domain[1][0], domain[1][1]);
            let feature = rectangle_feature([u, v], domain, [false; 2], None);
            let lambda = if feature.kind == FeatureKind::Vertex { f64::INFINITY } else { 1.0 };
            let point = axes.origin + axes.ex * u + axes.ey * v;
            Some(settle(p, &[(Foot::new(point, feature, &[u, v]), lambda)], 0, size, query))
        }
        SurfaceKind::Triangle { nodes } => {
            let ([u, v], feature) = closest_on_triangle(p, nodes);
            let point = nodes[0] + (nodes[1] - nodes[0]) * u + (nodes[2] - nodes[0]) * v;
            let lambda = if feature.kind == FeatureKind::Vertex { f64::INFINITY } else { 1.0 };
            Some(settle(p, &[(Foot::new(point, feature, &[u, v]), lambda)], 0, size, query))
        }
        SurfaceKind::Cylinder { axes, radius } => {
            let profile = Profile::Line { start: [*radius, 0.0], direction: [0.0, 1.0] };
            Some(revolution(p, surface, axes, &profile, query))
        }
        SurfaceKind::Cone { axes, sin, cos } => {
            let profile = Profile::Line { start: [0.0, 0.0], direction: [*sin, *cos] };
            Some(revolution(p, surface, axes, &profile, query))
        }
        SurfaceKind::Sphere { axes, radius } => {
            Some(revolution(p, surface, axes, &Profile::Circle { centre: 0.0, radius: *radius }, query))
        }
        SurfaceKind::Torus { axes, major, minor } => {
            Some(revolution(p, surface, axes, &Profile::Circle { centre: *major, radius: *minor }, query))
        }
        SurfaceKind::Ellipsoid { axes, semi_axes } => {
            let full = surface.domain()[1].iter().all(|v| v.abs() >= 0.5 * PI - 1e-12);
            if !(full && surface.closed()[0]) {
                return None;
            }
            let x = axes.local(p);
            let found = ellipsoid::closest(semi_axes, &[x.x, x.y, x.z])?;
            let [a, b, c] = *semi_axes;
            let domain = surface.domain();
            let candidates: Vec<Candidate> = found
                .iter()
                .map(|y| {
                    let (cu, su) = (y[0] / a, y[1] / b);
                    let v = (y[2] / c).atan2(cu.hypot(su)).clamp(domain[1][0], domain[1][1]);
                    let u = domain[0][0] + (su.atan2(cu) - domain[0][0]).rem_euclid(TAU);
                    let feature = rectangle_feature([u, v], domain, [true, false], Some(Entity::Pole));
                    let foot =
                        Foot::new(axes.origin + axes.ex * y[0] + axes.ey * y[1] + axes.ez * y[2], feature, &[u, v]);
                    (foot, ellipsoid::lambda_min(semi_axes, y, &[x.x, x.y, x.z]))
                })
                .collect();
            Some(settle(p, &candidates, 0, size, query))
        }
        SurfaceKind::Other => None,
    }
}

/// A radius that rounding cannot tell from zero.
fn centre_tolerance(p: &Point<3>, axes: &Axes, size: f64) -> f64 {
    4.0 * f64::EPSILON * (p.amax() + axes.origin.amax() + size)
}

/// The angle shifted by whole turns into the range.
fn inside(theta: f64, [from, to]: [f64; 2], closed: bool) -> Option<f64> {
    let u = from + (theta - from).rem_euclid(TAU);
    if u <= to || closed {
        Some(u)
    } else {
        // A hair below the start is the start.
        (u - TAU >= from - 4.0 * f64::EPSILON * (1.0 + from.abs())).then_some(from)
    }
}

/// The feature of a rectangle at which parameters lie; `collapsed` is what a collapsed side at `v` is.
fn rectangle_feature(z: [f64; 2], domain: [[f64; 2]; 2], closed: [bool; 2], collapsed: Option<Entity>) -> Feature {
    let border = |k: usize, low: Border, high: Border| {
        if closed[k] {
            None
        } else if z[k] <= domain[k][0] {
            Some(low)
        } else if z[k] >= domain[k][1] {
            Some(high)
        } else {
            None
        }
    };
    match (border(0, Border::U0, Border::U1), border(1, Border::V0, Border::V1)) {
        (_, Some(v)) if collapsed.is_some() => match collapsed {
            Some(Entity::Pole) => Feature { kind: FeatureKind::Interior, entity: Entity::Pole },
            _ => Feature::vertex(Entity::Collapsed(v)),
        },
        (Some(u), Some(v)) => Feature::vertex(Entity::Corner(u, v)),
        (Some(b), None) | (None, Some(b)) => Feature::edge(b),
        (None, None) => Feature::INTERIOR,
    }
}

/// The profile of a surface of revolution in its half plane of radius and height.
enum Profile {
    /// `start + v direction`, the direction of unit length.
    Line { start: [f64; 2], direction: [f64; 2] },
    /// `(centre + radius cos v, radius sin v)`.
    Circle { centre: f64, radius: f64 },
}

impl Profile {
    fn at(&self, v: f64) -> [f64; 2] {
        match self {
            Profile::Line { start, direction } => [start[0] + v * direction[0], start[1] + v * direction[1]],
            Profile::Circle { centre, radius } => {
                let (sin, cos) = v.sin_cos();
                [centre + radius * cos, radius * sin]
            }
        }
    }
}

fn revolution(p: &Point<3>, surface: &Surface, axes: &Axes, profile: &Profile, query: &Query) -> Projection {
    let x = axes.local(p);
    let rho = x.x.hypot(x.y);
    let theta = x.y.atan2(x.x);
    let domain = surface.domain();
    let closed = surface.closed();
    let size = surface.size();
    let tolerance = centre_tolerance(p, axes, size);
    let on_axis = rho <= tolerance;
    // Angles: the one of the point, its opposite, the ends.
    let mut angles = [0.0; 4];
    let mut count = 0;
    let mut angle = |u: f64| {
        angles[count] = u;
        count += 1;
    };
    if on_axis {
        angle(domain[0][0]);
    } else {
        let facing = inside(theta, domain[0], closed[0]);
        let spindle = matches!(profile, Profile::Circle { centre, radius } if *centre > 0.0 && centre < radius);
        if let Some(u) = facing {
            angle(u);
        }
        if spindle && let Some(u) = inside(theta + PI, domain[0], closed[0]) {
            angle(u);
        }
        if (facing.is_none() || spindle) && !closed[0] {
            angle(domain[0][0]);
            angle(domain[0][1]);
        }
    }
    let mut candidates = [(Foot::of_point(*p), 0.0); 8];
    let mut found = 0;
    let mut best = (f64::INFINITY, 0);
    for &u in &angles[..count] {
        let (sin, cos) = u.sin_cos();
        let reach = if on_axis { 0.0 } else { x.x * cos + x.y * sin };
        let (mut vs, mut lambda_v, mut free_v) = ([0.0; 2], 1.0, false);
        let ends = match profile {
            Profile::Line { start, direction } => {
                let v = (reach - start[0]) * direction[0] + (x.z - start[1]) * direction[1];
                vs[0] = v.clamp(domain[1][0], domain[1][1]);
                1
            }
            Profile::Circle { centre, radius } => {
                let (r, z) = (reach - centre, x.z);
                let from_centre = r.hypot(z);
                lambda_v = from_centre / radius;
                if from_centre <= tolerance {
                    free_v = true;
                    lambda_v = 0.0;
                    vs[0] = domain[1][0];
                    1
                } else if let Some(v) = inside(z.atan2(r), domain[1], closed[1]) {
                    vs[0] = v;
                    1
                } else {
                    vs = domain[1];
                    2
                }
            }
        };
        for &v in &vs[..ends] {
            let [f, g] = profile.at(v);
            let collapses = f.abs() <= 1e-14 * size && !closed[1] && (v <= domain[1][0] || v >= domain[1][1]);
            let collapsed = collapses.then(|| match profile {
                Profile::Circle { .. } if closed[0] => Entity::Pole,
                _ => Entity::Collapsed(Border::V0),
            });
            let feature = rectangle_feature([u, v], domain, closed, collapsed);
            let point = axes.origin + (axes.ex * cos + axes.ey * sin) * f + axes.ez * g;
            let u_free = (closed[0] || !domain[0].contains(&u)) && !collapses;
            let v_free = closed[1] || !domain[1].contains(&v);
            let mut lambda = f64::INFINITY;
            if u_free {
                lambda = lambda.min(reach / f);
            }
            if v_free || free_v {
                lambda = lambda.min(lambda_v);
            }
            let distance = length(&(point - p));
            if distance < best.0 {
                best = (distance, usize::from(free_v) + usize::from(on_axis && !collapses && f != 0.0));
                // The centre of a sphere: the angle is free wherever the latitude is.
                if free_v && on_axis && matches!(profile, Profile::Circle { centre, .. } if *centre == 0.0) {
                    best.1 = 2;
                }
            }
            candidates[found] = (Foot::new(point, feature, &[u, v]), lambda);
            found += 1;
        }
    }
    settle(p, &candidates[..found], best.1, size, query)
}

/// Two whole spheres about the same centre touch nowhere more than elsewhere.
pub fn sphere_sphere(s: &Surface, t: &Surface) -> Option<Projection> {
    let (SurfaceKind::Sphere { axes: a, radius: r }, SurfaceKind::Sphere { axes: b, radius: q }) = (&s.kind, &t.kind)
    else {
        return None;
    };
    let whole = |s: &Surface| s.closed()[0] && s.domain()[1].iter().all(|v| v.abs() >= 0.5 * PI - 1e-12);
    let apart = (a.origin - b.origin).norm();
    if !(whole(s) && whole(t)) || apart > 4.0 * f64::EPSILON * (r + q + a.origin.amax()) {
        return None;
    }
    let foot = |axes: &Axes, radius: f64, surface: &Surface, direction: &Vector<3>| {
        let x = Vector::<3>::new(direction.dot(&axes.ex), direction.dot(&axes.ey), direction.dot(&axes.ez));
        let from = surface.domain()[0][0];
        let u = from + (x.y.atan2(x.x) - from).rem_euclid(TAU);
        Foot::new(axes.origin + direction * radius, Feature::INTERIOR, &[u, x.z.atan2(x.x.hypot(x.y))])
    };
    let from = s.domain()[0][0];
    let direction = a.ex * from.cos() + a.ey * from.sin();
    let closest = ClosestPair {
        distance: (r - q).abs(),
        a: foot(a, *r, s, &direction),
        b: foot(b, *q, t, &direction),
        lambda_min: 0.0,
    };
    let uniqueness = Uniqueness::Continuum { dimension: 2 };
    Some(Projection::known(closest, uniqueness, Vec::new()))
}
