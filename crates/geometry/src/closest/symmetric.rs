//! Pairs of shapes with a symmetry in common, whose closest points form continua.
//!
//! Shapes turned fully about one axis: at radii `ρ, σ`, heights `z, w` and angles `θ, φ` the squared distance is
//! `(ρ - σ)² + (z - w)² + 2 ρ σ (1 - cos(θ - φ))`, least at equal angles, so that it is that of the profiles in their half
//! plane. Shapes swept along one direction: the distance is no less than that of their shadows along it, and as large
//! where the closest points of the shadows have heights in common. Either way the answer is that of one dimension
//! less, with one more dimension of closest points. No search on the shapes themselves would end.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::query::Query;
use super::result::{ClosestPair, Foot, Projection, Uniqueness};
use crate::shape::{Axes, Curve, CurveKind, Shape, Surface, SurfaceKind};
use crate::{Point, Vector};

/// Finds the closest points of two shapes.
pub type Solve = fn(&Shape, &Shape, &Query) -> Projection;

/// Closest points by way of a common symmetry; `None` where there is none, or where the ends of the shapes decide.
/// `solve` answers for the profiles or shadows.
pub fn closest(a: &Shape, b: &Shape, query: &Query, solve: Solve) -> Option<Projection> {
    if query.local_minima {
        return None;
    }
    let size = a.size().max(b.size());
    let pair = Symmetric { shapes: [a, b], query, solve, size, magnitude: magnitude(a).max(magnitude(b)) };
    let turned = [a, b].iter().filter_map(|s| axis(s)).find_map(|axis| pair.turned(&axis));
    turned.or_else(|| [a, b].iter().flat_map(|s| directions(s)).find_map(|e| pair.swept(&e)))
}

fn magnitude(shape: &Shape) -> f64 {
    let bounds = shape.bounds();
    bounds.min.amax().max(bounds.max.amax())
}

/// The axis about which a shape is turned fully, if it has but one.
fn axis(shape: &Shape) -> Option<Axes> {
    match shape {
        Shape::Curve(c) => match &c.kind {
            CurveKind::Circle { axes, .. } if c.is_closed() => Some(*axes),
            _ => None,
        },
        Shape::Surface(s) if s.closed()[0] => match &s.kind {
            SurfaceKind::Cylinder { axes, .. } | SurfaceKind::Cone { axes, .. } | SurfaceKind::Torus { axes, .. } => {
                Some(*axes)
            }
            SurfaceKind::Ellipsoid { axes, semi_axes: [p, q, _] } if p == q => Some(*axes),
            SurfaceKind::Sphere { axes, .. } if !is_whole(s) => Some(*axes),
            _ => None,
        },
        _ => None,
    }
}

/// Whether a sphere has all latitudes.
fn is_whole(s: &Surface) -> bool {
    s.closed()[0] && s.domain()[1].iter().all(|v| v.abs() >= FRAC_PI_2 - 1e-12)
}

/// Unit vectors along which a shape may be swept.
fn directions(shape: &Shape) -> Vec<Vector<3>> {
    match shape {
        Shape::Curve(c) => match &c.kind {
            CurveKind::Segment { p0, p1 } => (p1 - p0).try_normalize(0.0).into_iter().collect(),
            _ => Vec::new(),
        },
        Shape::Surface(s) => match &s.kind {
            SurfaceKind::Cylinder { axes, .. } if s.closed()[0] => vec![axes.ez],
            SurfaceKind::Plane { axes } => vec![axes.ex, axes.ey],
            _ => Vec::new(),
        },
        _ => Vec::new(),
    }
}

/// A profile in the half plane `(ρ, 0, z)` of an axis, and the radius to which the shape goes all the way round.
struct Profile {
    shape: Shape,
    reach: f64,
}

/// What a shape throws onto the plane across a direction.
struct Shadow<'a> {
    shape: Shape,
    heights: Heights<'a>,
}

/// The heights of a shape above a point of its shadow.
enum Heights<'a> {
    Everywhere([f64; 2]),
    Rectangle { axes: &'a Axes, domain: [[f64; 2]; 2] },
}

impl Heights<'_> {
    fn above(&self, shadow: &Point<3>, e: &Vector<3>) -> [f64; 2] {
        match self {
            Heights::Everywhere(range) => *range,
            Heights::Rectangle { axes, domain } => {
                let mut range = [f64::NEG_INFINITY, f64::INFINITY];
                for (k, side) in [axes.ex, axes.ey].iter().enumerate() {
                    let (at, slope) = ((shadow - axes.origin).dot(side), e.dot(side));
                    // A side across the direction bounds no height.
                    if slope.abs() > 4.0 * f64::EPSILON {
                        let ends = domain[k].map(|end| (end - at) / slope);
                        range = [range[0].max(ends[0].min(ends[1])), range[1].min(ends[0].max(ends[1]))];
                    }
                }
                range
            }
        }
    }
}

struct Symmetric<'a> {
    shapes: [&'a Shape; 2],
    query: &'a Query,
    solve: Solve,
    size: f64,
    magnitude: f64,
}

impl Symmetric<'_> {
    /// What rounding of the coordinates leaves undecided.
    fn tolerance(&self) -> f64 {
        16.0 * f64::EPSILON * self.magnitude
    }

    fn is_parallel(&self, e: &Vector<3>, f: &Vector<3>) -> bool {
        e.cross(f).norm() * self.size <= self.tolerance()
    }

    fn is_across(&self, e: &Vector<3>, f: &Vector<3>) -> bool {
        e.dot(f).abs() * self.size <= self.tolerance()
    }

    /// The height of a point of an axis; `None` beside it.
    fn height(&self, axis: &Axes, x: &Point<3>) -> Option<f64> {
        let local = axis.local(x);
        (local.x.hypot(local.y) <= self.tolerance()).then_some(local.z)
    }

    fn turned(&self, axis: &Axes) -> Option<Projection> {
        let [p, q] = self.shapes.map(|s| self.profile(s, axis));
        let (p, q) = (p?, q?);
        let found = (self.solve)(&p.shape, &q.shape, self.query);
        let radii = [found.closest.a.point.x, found.closest.b.point.x];
        if radii[0] > p.reach || radii[1] > q.reach {
            return None;
        }
        // On the axis all angles are one point.
        let (added, samples) = if radii[0].max(radii[1]) <= self.tolerance() { (0, 1) } else { (1, 8) };
        let places = (0..samples).map(|k| (TAU / 8.0 * f64::from(k)).sin_cos()).map(|(sin, cos)| {
            let e = axis.ex * cos + axis.ey * sin;
            move |x: &Point<3>| axis.origin + e * x.x + axis.ez * x.z
        });
        Some(self.raised(&found, added, places))
    }

    /// The profile of a shape turned fully about an axis. A rectangle across the axis is as good as the plane up to the
    /// radius that it reaches all round.
    fn profile(&self, shape: &Shape, axis: &Axes) -> Option<Profile> {
        let at = |rho: f64, z: f64| Point::<3>::new(rho, 0.0, z);
        let segment = |p: Point<3>, q: Point<3>| Curve::segment(p, q).ok().map(Shape::from);
        // Where the shape has its own axis: how its heights become those of the axis.
        let own = |axes: &Axes| {
            let z = self.height(axis, &axes.origin)?;
            self.is_parallel(&axes.ez, &axis.ez).then_some((z, axes.ez.dot(&axis.ez).signum()))
        };
        let arc = |centre: [f64; 2], sign: f64, a: f64, b: f64, range: [f64; 2], closed: bool| {
            let axes = Axes::new(at(centre[0], centre[1]), Vector::<3>::x(), Vector::<3>::z() * sign).ok()?;
            let arc =
                if a == b { Curve::circle(axes, a, range, closed) } else { Curve::ellipse(axes, a, b, range, closed) };
            arc.ok().map(Shape::from)
        };
        let mut reach = f64::INFINITY;
        let profile = match shape {
            Shape::Curve(c) => match &c.kind {
                CurveKind::Circle { axes, radius } if c.is_closed() => Shape::Point(at(*radius, own(axes)?.0)),
                CurveKind::Segment { p0, p1 } => {
                    segment(at(0.0, self.height(axis, p0)?), at(0.0, self.height(axis, p1)?))?
                }
                _ => return None,
            },
            Shape::Surface(s) => {
                let [_, [from, to]] = s.domain();
                match &s.kind {
                    SurfaceKind::Plane { axes } if self.is_parallel(&axes.ez, &axis.ez) => {
                        let domain = s.domain();
                        let foot = axes.local(&axis.origin);
                        let sides = [
                            foot.x - domain[0][0],
                            domain[0][1] - foot.x,
                            foot.y - domain[1][0],
                            domain[1][1] - foot.y,
                        ];
                        reach = sides.into_iter().fold(f64::INFINITY, f64::min);
                        let farthest = sides.into_iter().fold(0.0, |m: f64, x| m.max(x.abs()));
                        let z = axis.local(&axes.origin).z;
                        segment(at(0.0, z), at(2.0 * farthest, z))?
                    }
                    _ if !s.closed()[0] => return None,
                    SurfaceKind::Cylinder { axes, radius } => {
                        let (z, sign) = own(axes)?;
                        segment(at(*radius, z + sign * from), at(*radius, z + sign * to))?
                    }
                    SurfaceKind::Cone { axes, sin, cos } if from >= 0.0 => {
                        let (z, sign) = own(axes)?;
                        let point = |v: f64| at(v * sin, z + sign * v * cos);
                        segment(point(from), point(to))?
                    }
                    SurfaceKind::Sphere { axes, radius } if is_whole(s) => {
                        let z = self.height(axis, &axes.origin)?;
                        arc([0.0, z], 1.0, *radius, *radius, [-FRAC_PI_2, FRAC_PI_2], false)?
                    }
                    SurfaceKind::Sphere { axes, radius } => {
                        let (z, sign) = own(axes)?;
                        arc([0.0, z], sign, *radius, *radius, [from, to], false)?
                    }
                    SurfaceKind::Ellipsoid { axes, semi_axes: [a, b, c] } if a == b => {
                        let (z, sign) = own(axes)?;
                        arc([0.0, z], sign, *a, *c, [from, to], false)?
                    }
                    SurfaceKind::Torus { axes, major, minor } if major >= minor => {
                        let (z, sign) = own(axes)?;
                        arc([*major, z], sign, *minor, *minor, [from, to], s.closed()[1])?
                    }
                    _ => return None,
                }
            }
            _ => return None,
        };
        Some(Profile { shape: profile, reach })
    }

    fn swept(&self, e: &Vector<3>) -> Option<Projection> {
        let [p, q] = self.shapes.map(|s| self.shadow(s, e));
        let (p, q) = (p?, q?);
        let found = (self.solve)(&p.shape, &q.shape, self.query);
        let [c, d] = [p.heights.above(&found.closest.a.point, e), q.heights.above(&found.closest.b.point, e)];
        let (low, high) = (c[0].max(d[0]), c[1].min(d[1]));
        if high - low <= 1e-12 * self.size {
            return None;
        }
        let closest = Projection { others: Vec::new(), ..found };
        let samples = [0.5 * (low + high), low, high].map(|height| move |x: &Point<3>| x + e * height);
        Some(self.raised(&closest, 1, samples.into_iter()))
    }

    /// The shadow of a shape that is swept along a direction, or flat along it.
    fn shadow<'b>(&self, shape: &'b Shape, e: &Vector<3>) -> Option<Shadow<'b>> {
        let across = |x: Point<3>| x - e * e.dot(&x);
        let sorted = |p: f64, q: f64| Heights::Everywhere([p.min(q), p.max(q)]);
        match shape {
            Shape::Curve(c) => match &c.kind {
                CurveKind::Segment { p0, p1 } if self.is_parallel(&(p1 - p0).try_normalize(0.0)?, e) => {
                    Some(Shadow { shape: Shape::Point(across(*p0)), heights: sorted(e.dot(p0), e.dot(p1)) })
                }
                _ => None,
            },
            Shape::Surface(s) => match &s.kind {
                SurfaceKind::Cylinder { axes, radius } if s.closed()[0] && self.is_parallel(&axes.ez, e) => {
                    let [turn, ends] = s.domain();
                    let [p, q] = ends.map(|v| e.dot(&(axes.origin + axes.ez * v)));
                    let axes = Axes { origin: across(axes.origin), ..*axes };
                    let shape = Curve::circle(axes, *radius, turn, true).ok()?.into();
                    Some(Shadow { shape, heights: sorted(p, q) })
                }
                SurfaceKind::Plane { axes } if self.is_across(&axes.ez, e) => {
                    let side = axes.ez.cross(e).try_normalize(0.0)?;
                    let domain = s.domain();
                    let corners =
                        [0, 1, 2, 3].map(|k| axes.origin + axes.ex * domain[0][k & 1] + axes.ey * domain[1][k >> 1]);
                    let by_side = |p: &&Point<3>, q: &&Point<3>| side.dot(p).total_cmp(&side.dot(q));
                    let [p, q] = [corners.iter().min_by(by_side)?, corners.iter().max_by(by_side)?].map(|x| across(*x));
                    let shape = Curve::segment(p, q).ok()?.into();
                    Some(Shadow { shape, heights: Heights::Rectangle { axes, domain } })
                }
                _ => None,
            },
            _ => None,
        }
    }

    /// The answer in the plane at places in space, the first of which is that of the closest pair; `added` dimensions of
    /// closest points belong to it.
    fn raised<F: Fn(&Point<3>) -> Point<3>>(
        &self,
        found: &Projection,
        added: usize,
        places: impl Iterator<Item = F>,
    ) -> Projection {
        let foot = |x: Point<3>, shape: &Shape| -> Foot {
            let mut foot = (self.solve)(&Shape::Point(x), shape, self.query).closest.b;
            foot.point = x;
            foot
        };
        let lambda_min = if added == 0 { f64::NAN } else { 0.0 };
        let mut pairs = Vec::new();
        for place in places {
            for pair in std::iter::once(&found.closest).chain(&found.others) {
                let (x, y) = (place(&pair.a.point), place(&pair.b.point));
                pairs.push(ClosestPair { a: foot(x, self.shapes[0]), b: foot(y, self.shapes[1]), lambda_min, ..*pair });
            }
        }
        let mut pairs = pairs.into_iter();
        Projection {
            closest: pairs.next().expect("one place at least"),
            uniqueness: match found.uniqueness {
                Uniqueness::Continuum { dimension } => Uniqueness::Continuum { dimension: dimension + added },
                other if added == 0 => other,
                _ => Uniqueness::Continuum { dimension: added },
            },
            others: pairs.collect(),
            // Symmetries are told to rounding.
            certified_to: found.certified_to + 2.0 * self.tolerance(),
            margin: 0.0,
            ..found.clone()
        }
    }
}
