//! Closest points of two shapes: the global minimum of the distance, certified.
//!
//! [`closest`] answers for every pair of a point, curve or surface with another. It minimises `F = ½ D·D`, `D = x_A -
//! x_B`, over the closed parameter domains. A few pairs have closed forms; all others go through a branch-and-bound
//! search whose bounds prove that nothing is closer, with exact Newton at the end. The minimiser is
//! found first and named afterwards ([`FeatureKind`]): faces, edges and vertices cover space without gaps because a
//! global minimiser always exists.

pub(crate) mod bounds;
mod classify;
mod closed_form;
mod ellipsoid;
mod flat;
mod hessian;
pub(crate) mod newton;
mod partner;
mod query;
mod result;
mod scaled;
mod search;
mod symmetric;
mod track;

pub use crate::feature::{Entity, Feature, FeatureKind};
pub use hessian::gap_hessian;
pub use query::Query;
pub use result::{Certificate, ClosestPair, Foot, Projection, Uniqueness};
pub(crate) use track::clearance_of;
pub use track::{Step, Tracker};

use crate::Point;
use crate::implicit_surface::ImplicitSurface;
use crate::mesh::TriangleMesh;
use crate::patch::{Atlas, Chart, Piece, PointChart};
use crate::rigid_shape::RigidShape;
use crate::scale::{direction, length};
use crate::shape::Shape;
use crate::trimmed::TrimmedSolid;
use classify::{Named, projection};
use rayon::prelude::*;
use search::{Effort, search};

/// Closest points of many points to one shape, in the order of the points, on all threads of the current pool. The answers
/// do not depend on their number.
///
/// ```
/// use signorini_geometry::shape::{Axes, Shape, Surface};
/// use signorini_geometry::{Point, closest::{Query, closest_points}};
/// let torus = Surface::torus(Axes::standard(Point::<3>::zeros()), 2.0, 0.5, [[0.0, std::f64::consts::TAU]; 2], [true; 2]);
/// let points = [Point::<3>::new(3.0, 0.0, 0.0), Point::<3>::new(0.0, -2.0, 1.0)];
/// let answers = closest_points(&points, &torus.unwrap().into(), &Query::default());
/// assert!(answers.iter().all(|a| (a.distance() - 0.5).abs() < 1e-15));
/// ```
pub fn closest_points(points: &[Point<3>], shape: &Shape, query: &Query) -> Vec<Projection> {
    points.par_iter().map(|p| closest(&Shape::Point(*p), shape, query)).collect()
}

/// Closest points of many pairs of shapes, given by their numbers in two lists, as [`closest_points`] does.
///
/// # Panics
/// If a number is not one of a list.
pub fn closest_pairs(a: &[Shape], b: &[Shape], pairs: &[(usize, usize)], query: &Query) -> Vec<Projection> {
    pairs.par_iter().map(|&(i, j)| closest(&a[i], &b[j], query)).collect()
}

/// Closest points of two shapes.
///
/// ```
/// use signorini_geometry::shape::{Axes, Curve, Shape};
/// use signorini_geometry::{Point, closest::{Query, closest}};
/// let circle = Curve::circle(Axes::standard(Point::<3>::zeros()), 2.0, [0.0, std::f64::consts::TAU], true).unwrap();
/// let answer = closest(&Shape::Point(Point::<3>::new(0.0, 5.0, 4.0)), &circle.into(), &Query::default());
/// assert!((answer.distance() - 5.0).abs() < 1e-15);
/// ```
pub fn closest(a: &Shape, b: &Shape, query: &Query) -> Projection {
    scaled::closest(a, b, query, closest_near_one).unwrap_or_else(|| closest_near_one(a, b, query))
}

/// See [`closest`], with coordinates of which products stay in the range of doubles.
fn closest_near_one(a: &Shape, b: &Shape, query: &Query) -> Projection {
    match (a, b) {
        (Shape::Point(p), Shape::Point(q)) => point_point(p, q),
        (Shape::Point(p), Shape::Curve(c)) => closed_form::point_curve(p, c, query)
            .unwrap_or_else(|| general::<0, 1, 1, _, _>(&point_atlas(p), &c.atlas, query)),
        (Shape::Point(p), Shape::Surface(s)) => closed_form::point_surface(p, s, query)
            .unwrap_or_else(|| general::<0, 2, 2, _, _>(&point_atlas(p), &s.atlas, query)),
        (Shape::Curve(c), Shape::Curve(d)) => flat::segment_segment(c, d, query)
            .or_else(|| symmetric::closest(a, b, query, closest_near_one))
            .unwrap_or_else(|| general::<1, 1, 2, _, _>(&c.atlas, &d.atlas, query)),
        (Shape::Curve(c), Shape::Surface(s)) => symmetric::closest(a, b, query, closest_near_one)
            .unwrap_or_else(|| general::<1, 2, 3, _, _>(&c.atlas, &s.atlas, query)),
        (Shape::Surface(s), Shape::Surface(t)) => closed_form::sphere_sphere(s, t)
            .or_else(|| symmetric::closest(a, b, query, closest_near_one))
            .unwrap_or_else(|| general::<2, 2, 4, _, _>(&s.atlas, &t.atlas, query)),
        (Shape::Point(p), Shape::Mesh(m)) if !query.local_minima => point_mesh(p, m, query),
        (Shape::Point(p), Shape::Mesh(m)) => on_triangles(general::<0, 2, 2, _, _>(&point_atlas(p), m.atlas(), query)),
        (Shape::Curve(c), Shape::Mesh(m)) => on_triangles(general::<1, 2, 3, _, _>(&c.atlas, m.atlas(), query)),
        (Shape::Surface(s), Shape::Mesh(m)) => on_triangles(general::<2, 2, 4, _, _>(&s.atlas, m.atlas(), query)),
        (Shape::Mesh(m), Shape::Mesh(n)) => mesh_mesh(m, n),
        (Shape::Point(p), Shape::Implicit(s)) => point_implicit(p, s),
        (Shape::Point(p), Shape::Solid(s)) => point_solid(p, s, query),
        (_, Shape::Solid(s)) => beside_solid(a, s, query),
        (_, Shape::Implicit(s)) => {
            // The triangulation stands for the surface: a share of a cell is what it can be off.
            let mesh = Shape::Mesh(Box::new(s.mesh().clone()));
            Projection { certified_to: s.cell(), ..closest(a, &mesh, query) }
        }
        _ => swapped(closest(b, a, query)),
    }
}

/// Every triangle of a mesh is three pieces of the general search, which counts them as elements.
fn on_triangles(mut projection: Projection) -> Projection {
    for pair in std::iter::once(&mut projection.closest).chain(&mut projection.others) {
        pair.b.element /= 3;
    }
    projection
}

fn point_mesh(p: &Point<3>, mesh: &TriangleMesh, query: &Query) -> Projection {
    let mut pairs = mesh.closest(p, query.tie * mesh.size()).into_iter().map(|foot| ClosestPair {
        distance: foot.distance,
        a: Foot::of_point(*p),
        b: Foot::new(foot.point, foot.feature, &foot.parameters).on_element(foot.triangle),
        lambda_min: if foot.feature.kind == FeatureKind::Vertex { f64::INFINITY } else { 1.0 },
    });
    let closest = pairs.next().expect("a mesh has a triangle");
    let others: Vec<ClosestPair> = pairs.collect();
    let uniqueness = if others.is_empty() { Uniqueness::Unique } else { Uniqueness::Multiple };
    Projection::known(closest, uniqueness, others)
}

fn point_implicit(p: &Point<3>, surface: &ImplicitSurface) -> Projection {
    let foot = surface.closest(p);
    let closest = ClosestPair {
        distance: foot.gap.abs(),
        a: Foot::of_point(*p),
        b: Foot::new(foot.point, Feature { kind: foot.feature, entity: Entity::Whole }, &[]),
        lambda_min: f64::NAN,
    };
    let uniqueness = if foot.unique { Uniqueness::Unique } else { Uniqueness::Multiple };
    Projection { certified_to: surface.cell(), ..Projection::known(closest, uniqueness, Vec::new()) }
}

fn point_solid(p: &Point<3>, solid: &TrimmedSolid, query: &Query) -> Projection {
    let found = solid.closest_all(p, query.tie * solid.size());
    let pairs = found.iter().map(|foot| {
        let feature = Feature { kind: foot.kind(), entity: Entity::Part(foot.number() as u32) };
        let b = Foot::new(foot.point, feature, &[]);
        ClosestPair { distance: foot.distance, a: Foot::of_point(*p), b, lambda_min: f64::NAN }
    });
    let mut pairs: Vec<ClosestPair> = pairs.collect();
    let closest = pairs.remove(0);
    let uniqueness = match solid.focal(p, &found[0]) {
        0 if pairs.is_empty() => Uniqueness::Unique,
        0 => Uniqueness::Multiple,
        dimension => Uniqueness::Continuum { dimension },
    };
    Projection::known(closest, uniqueness, pairs)
}

/// The triangles of a solid stand for it: what they can be off is known.
fn beside_solid(a: &Shape, solid: &TrimmedSolid, query: &Query) -> Projection {
    let Some(mesh) = solid.mesh() else {
        let corner = Shape::Point(solid.hull().center());
        return Projection { certified_to: f64::INFINITY, ..closest(a, &corner, query) };
    };
    let found = closest(a, &Shape::Mesh(Box::new(mesh.clone())), query);
    Projection { certified_to: solid.off_triangles(), ..found }
}

/// The distance with the sign of the side of `b` on which the closest point of `a` lies: negative inside a closed mesh
/// or an implicit body, and below a surface, seen along `r_u × r_v`. `None` where there is no side.
pub fn signed_gap(pair: &ClosestPair, b: &Shape) -> Option<f64> {
    let d = pair.a.point - pair.b.point;
    let side = match b {
        Shape::Surface(s) => {
            let &[u, v] = pair.b.parameters() else { return None };
            let jet = s.jet(u, v);
            let normal = direction(&jet.u)?.cross(&direction(&jet.v)?);
            // Parallel to rounding: the surface has no normal there.
            if normal.norm() <= 1e-12 {
                return None;
            }
            d.dot(&normal)
        }
        Shape::Mesh(m) => {
            let normal = m.normal_at(pair.b.element, pair.b.feature);
            return m.signed(&pair.a.point, &d, &normal, pair.distance);
        }
        Shape::Implicit(s) => s.body().value(&pair.a.point),
        Shape::Solid(s) => s.gap(&pair.a.point).gap,
        _ => return None,
    };
    Some(if side < 0.0 { -pair.distance } else { pair.distance })
}

/// The closest pair of two meshes. Flat faces that lie parallel share a whole area; one pair of it is returned, and
/// uniqueness is judged at that pair alone.
fn mesh_mesh(m: &TriangleMesh, n: &TriangleMesh) -> Projection {
    let found = m.closest_to_mesh(n);
    let foot = |mesh: &TriangleMesh, k: usize| {
        let point = mesh.position(found.triangles[k], found.parameters[k]);
        let feature = crate::straight::closest_on_triangle(&point, &mesh.corners(found.triangles[k])).1;
        Foot::new(point, feature, &found.parameters[k]).on_element(found.triangles[k])
    };
    let closest = ClosestPair { distance: found.distance, a: foot(m, 0), b: foot(n, 1), lambda_min: f64::NAN };
    let on_face = closest.a.feature.kind == FeatureKind::Interior && closest.b.feature.kind == FeatureKind::Interior;
    let intersecting = found.distance <= 1e-15 * (m.size() + n.size());
    let uniqueness = match (intersecting, on_face) {
        (true, _) => Uniqueness::Continuum { dimension: 1 },
        (_, true) => Uniqueness::Continuum { dimension: 2 },
        _ => Uniqueness::Unique,
    };
    Projection::known(closest, uniqueness, Vec::new())
}

fn swapped(mut projection: Projection) -> Projection {
    projection.closest = projection.closest.swapped();
    for other in &mut projection.others {
        *other = other.swapped();
    }
    projection
}

fn point_atlas(p: &Point<3>) -> Atlas<0, PointChart> {
    let map = crate::patch::ParameterMap::Projective { low: [], high: [], ratio: [] };
    Atlas::new(vec![Piece::new(PointChart(*p), map, [])])
}

fn point_point(p: &Point<3>, q: &Point<3>) -> Projection {
    let closest = ClosestPair {
        distance: length(&(p - q)),
        a: Foot::of_point(*p),
        b: Foot::of_point(*q),
        lambda_min: f64::INFINITY,
    };
    Projection { margin: f64::INFINITY, ..Projection::known(closest, Uniqueness::Unique, Vec::new()) }
}

fn general<const A: usize, const B: usize, const N: usize, CA: Chart<A>, CB: Chart<B>>(
    a: &Atlas<A, CA>,
    b: &Atlas<B, CB>,
    query: &Query,
) -> Projection
where
    Piece<A, CA>: Named<A>,
    Piece<B, CB>: Named<B>,
{
    let magnitude = a.magnitude.max(b.magnitude).max(f64::MIN_POSITIVE);
    let size = a.size.max(b.size);
    let effort = Effort {
        tie: if query.local_minima { f64::INFINITY } else { query.tie * size },
        tolerance: 64.0 * f64::EPSILON * magnitude,
        proof: query.tie * size,
        most_pairs: [0, 3_000, 6_000, 15_000, 40_000][N],
        magnitude,
    };
    projection::<A, B, N, CA, CB>(a, b, query, size, search::<A, B, N, CA, CB>(a, b, effort))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::Curve;

    #[test]
    fn batches_are_single_queries_in_order() {
        let shapes: Vec<Shape> = (0..4)
            .map(|k| {
                let x = f64::from(k);
                Curve::segment(Point::<3>::new(x, 0.0, 0.0), Point::<3>::new(x, 1.0, x)).unwrap().into()
            })
            .collect();
        let points: Vec<Point<3>> = (0..50).map(|k| Point::<3>::repeat(f64::from(k) * 0.1)).collect();
        let query = Query::default();
        let batch = closest_points(&points, &shapes[2], &query);
        for (p, answer) in points.iter().zip(&batch) {
            assert_eq!(answer.closest, closest(&Shape::Point(*p), &shapes[2], &query).closest);
        }
        let pairs = [(0, 3), (3, 1), (1, 2)];
        let batch = closest_pairs(&shapes, &shapes, &pairs, &query);
        for (p, answer) in pairs.iter().zip(&batch) {
            assert_eq!(answer.distance(), closest(&shapes[p.0], &shapes[p.1], &query).distance());
        }
    }
}
