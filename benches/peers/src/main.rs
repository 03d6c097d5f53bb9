//! Closest points beside other libraries in one run, one thread: `cargo run --release` in this folder.
//!
//! The others do not certify; a distance larger than ours by 1e-6 of the size is counted as wrong.

use curvo::prelude::{NurbsCurve3D, NurbsSurface3D};
use nalgebra::{Point3, Point4};
use parry3d_f64::math::Vector as Parry;
use parry3d_f64::query::PointQuery;
use parry3d_f64::shape::{TriMesh, Triangle};
use signorini_geometry::bvh::Bvh;
use signorini_geometry::closest::{Query, closest};
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::shape::{Curve, Shape, Surface};
use signorini_geometry::{Aabb, Point};
use std::hint::black_box;
use std::time::Instant;
use truck_geometry::prelude as truck;
use truck_geometry::prelude::{ParametricCurve, ParametricSurface, SearchNearestParameter};

struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn vector(&mut self, size: f64) -> Point<3> {
        Point::<3>::from_fn(|_, _| self.between(-size, size))
    }
}

/// Queries per second of a function over all queries, repeated for half a second; the distances of the last round.
fn rate(count: usize, mut f: impl FnMut(usize) -> f64) -> (f64, Vec<f64>) {
    let mut out = vec![0.0; count];
    let start = Instant::now();
    let mut rounds = 0;
    while start.elapsed().as_secs_f64() < 0.5 {
        for (k, value) in out.iter_mut().enumerate() {
            *value = black_box(f(k));
        }
        rounds += 1;
    }
    ((rounds * count) as f64 / start.elapsed().as_secs_f64(), out)
}

fn compare(class: &str, peer: &str, ours: (f64, Vec<f64>), theirs: (f64, Vec<f64>)) {
    let wrong = ours.1.iter().zip(&theirs.1).filter(|(a, b)| !(**b <= **a + 1e-6)).count();
    let worse = ours.1.iter().zip(&theirs.1).filter(|(a, b)| **b < **a - 1e-9).count();
    println!(
        "{class:28} ours {:>10.3e}/s   {peer:8} {:>10.3e}/s   wrong: {peer} {wrong}, ours {worse} of {}",
        ours.0,
        theirs.0,
        ours.1.len()
    );
}

fn knots(n: usize, degree: usize) -> Vec<f64> {
    let mut knots = vec![0.0; degree];
    knots.extend((0..=n - degree).map(|k| k as f64));
    knots.extend(vec![(n - degree) as f64; degree]);
    knots
}

/// A bumpy ball of about `4 n²` triangles.
fn ball(n: usize) -> (Vec<Point<3>>, Vec<[u32; 3]>) {
    let mut vertices = Vec::new();
    for i in 0..=n {
        for j in 0..2 * n {
            let (v, u) = (std::f64::consts::PI * i as f64 / n as f64, std::f64::consts::PI * j as f64 / n as f64);
            let r = 1.0 + 0.1 * (5.0 * u).sin() * v.sin() + 0.05 * (7.0 * v).cos();
            vertices.push(Point::<3>::new(v.sin() * u.cos(), v.sin() * u.sin(), v.cos()) * r);
        }
    }
    let at = |i: usize, j: usize| (i * 2 * n + j % (2 * n)) as u32;
    let mut triangles = Vec::new();
    for i in 0..n {
        for j in 0..2 * n {
            triangles.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
            triangles.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
        }
    }
    (vertices, triangles)
}

fn main() {
    let mut r = Random(5);
    let query = Query::default();
    let parry = |p: &Point<3>| Parry::new(p.x, p.y, p.z);
    let n = 2000;
    let points: Vec<Point<3>> = (0..n).map(|_| r.vector(1.5)).collect();
    let as_shape: Vec<Shape> = points.iter().map(|p| Shape::Point(*p)).collect();

    let corners: Vec<[Point<3>; 3]> = (0..n).map(|_| [r.vector(1.0), r.vector(1.0), r.vector(1.0)]).collect();
    let own: Vec<Shape> = corners.iter().map(|c| Surface::tri3(c).unwrap().into()).collect();
    let other: Vec<Triangle> =
        corners.iter().map(|c| Triangle::new(parry(&c[0]), parry(&c[1]), parry(&c[2]))).collect();
    compare(
        "point-triangle",
        "parry",
        rate(n, |k| closest(&as_shape[k], &own[k], &query).distance()),
        rate(n, |k| (other[k].project_local_point(parry(&points[k]), false).point - parry(&points[k])).length()),
    );

    let (vertices, triangles) = ball(71);
    let own = TriangleMesh::new(vertices.clone(), &triangles).unwrap();
    let other = TriMesh::new(vertices.iter().map(parry).collect(), triangles).unwrap();
    let near: Vec<Point<3>> = points.iter().map(|p| p.normalize() * r.between(0.8, 1.4)).collect();
    compare(
        &format!("point-mesh, {} triangles", own.triangles().len()),
        "parry",
        rate(n, |k| own.closest(&near[k], 0.0)[0].distance),
        rate(n, |k| (other.project_local_point(parry(&near[k]), false).point - parry(&near[k])).length()),
    );

    let count = 24;
    let control: Vec<Vec<(Point<3>, f64)>> = (0..count)
        .map(|_| {
            (0..8)
                .map(|i| (Point::<3>::new(i as f64 * 0.28 - 1.0, 0.0, 0.0) + r.vector(0.4), r.between(0.7, 1.4)))
                .collect()
        })
        .collect();
    let own: Vec<Shape> = control
        .iter()
        .map(|c| {
            let (p, w): (Vec<Point<3>>, Vec<f64>) = c.iter().copied().unzip();
            Curve::nurbs(3, &knots(8, 3), &p, Some(&w), false).unwrap().into()
        })
        .collect();
    let homogeneous = |(p, w): &(Point<3>, f64)| Point4::new(p.x * w, p.y * w, p.z * w, *w);
    let other: Vec<NurbsCurve3D<f64>> = control
        .iter()
        .map(|c| NurbsCurve3D::try_new(3, c.iter().map(homogeneous).collect(), knots(8, 3)).unwrap())
        .collect();
    let truck_point = |(p, w): &(Point<3>, f64)| truck::Vector4::new(p.x * w, p.y * w, p.z * w, *w);
    let truck_knots = |n: usize| truck::KnotVec::from(knots(n, 3));
    let truck_distance = |found: Option<truck::Point3>, p: &Point<3>| {
        found.map_or(f64::NAN, |x| (Point::<3>::new(x.x, x.y, x.z) - p).norm())
    };
    let truck_curves: Vec<truck::NurbsCurve<truck::Vector4>> = control
        .iter()
        .map(|c| truck::NurbsCurve::new(truck::BSplineCurve::new(truck_knots(8), c.iter().map(truck_point).collect())))
        .collect();
    let distance = |found: Option<Point3<f64>>, p: &Point<3>| found.map_or(f64::NAN, |x| (x.coords - p).norm());
    compare(
        "point-curve, NURBS",
        "curvo",
        rate(480, |k| closest(&as_shape[k], &own[k % count], &query).distance()),
        rate(480, |k| distance(other[k % count].find_closest_point(&Point3::from(points[k])).ok(), &points[k])),
    );

    compare(
        "point-curve, NURBS",
        "truck",
        rate(480, |k| closest(&as_shape[k], &own[k % count], &query).distance()),
        rate(480, |k| {
            let (curve, p) = (&truck_curves[k % count], &points[k]);
            let t = curve.search_nearest_parameter(truck::Point3::new(p.x, p.y, p.z), None, 100);
            // Its Newton iteration may leave the curve and find a point of the polynomial beyond the end.
            truck_distance(t.filter(|t| (0.0..=5.0).contains(t)).map(|t| curve.subs(t)), p)
        }),
    );

    let nets: Vec<Vec<Vec<(Point<3>, f64)>>> = (0..count)
        .map(|_| {
            (0..6)
                .map(|i| {
                    (0..7)
                        .map(|j| {
                            let x = Point::<3>::new(i as f64 * 0.4 - 1.0, j as f64 / 3.0 - 1.0, 0.0);
                            (x + r.vector(0.2), r.between(0.7, 1.4))
                        })
                        .collect()
                })
                .collect()
        })
        .collect();
    let own: Vec<Shape> = nets
        .iter()
        .map(|net| {
            let p: Vec<Vec<Point<3>>> = net.iter().map(|row| row.iter().map(|c| c.0).collect()).collect();
            let w: Vec<Vec<f64>> = net.iter().map(|row| row.iter().map(|c| c.1).collect()).collect();
            Surface::nurbs([3, 3], [&knots(6, 3), &knots(7, 3)], &p, Some(&w), [false; 2]).unwrap().into()
        })
        .collect();
    let other: Vec<NurbsSurface3D<f64>> = nets
        .iter()
        .map(|net| {
            NurbsSurface3D::new(
                3,
                3,
                knots(6, 3),
                knots(7, 3),
                net.iter().map(|row| row.iter().map(homogeneous).collect()).collect(),
            )
        })
        .collect();
    compare(
        "point-surface, NURBS 6 x 7",
        "curvo",
        rate(240, |k| closest(&as_shape[k], &own[k % count], &query).distance()),
        rate(240, |k| distance(other[k % count].find_closest_point(&Point3::from(points[k]), None).ok(), &points[k])),
    );
    let truck_surfaces: Vec<truck::NurbsSurface<truck::Vector4>> = nets
        .iter()
        .map(|net| {
            let points = net.iter().map(|row| row.iter().map(truck_point).collect()).collect();
            truck::NurbsSurface::new(truck::BSplineSurface::new((truck_knots(6), truck_knots(7)), points))
        })
        .collect();
    compare(
        "point-surface, NURBS 6 x 7",
        "truck",
        rate(240, |k| closest(&as_shape[k], &own[k % count], &query).distance()),
        rate(240, |k| {
            let (surface, p) = (&truck_surfaces[k % count], &points[k]);
            let found = surface.search_nearest_parameter(truck::Point3::new(p.x, p.y, p.z), None, 100);
            let inside = |&(u, v): &(f64, f64)| (0.0..=3.0).contains(&u) && (0.0..=4.0).contains(&v);
            truck_distance(found.filter(inside).map(|(u, v)| surface.subs(u, v)), p)
        }),
    );

    println!();
    for cells in [50, 158, 500] {
        let (vertices, triangles) = ball(cells);
        let boxes: Vec<Aabb<3>> = triangles
            .iter()
            .map(|t| {
                let [a, b, c] = t.map(|v| vertices[v as usize]);
                Aabb::new(a.inf(&b).inf(&c), a.sup(&b).sup(&c))
            })
            .collect();
        let start = Instant::now();
        let mut bvh = Bvh::new(&boxes);
        let build = start.elapsed().as_secs_f64();
        let start = Instant::now();
        bvh.refit(&boxes);
        let refit = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let mesh = TriangleMesh::new(vertices, &triangles).unwrap();
        let whole = start.elapsed().as_secs_f64();
        let start = Instant::now();
        let mut sum = 0.0;
        for k in 0..1_000_000 {
            sum += mesh.closest(&near[k % n], 0.0)[0].distance;
        }
        let queries = start.elapsed().as_secs_f64();
        println!(
            "{:>8} triangles: build {:.1} ms, refit {:.1} ms, mesh with topology {:.0} ms, 1e6 queries {queries:.2} s (sum {sum:.1})",
            boxes.len(),
            build * 1e3,
            refit * 1e3,
            whole * 1e3
        );
    }
}
