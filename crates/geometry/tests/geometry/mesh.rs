//! Triangle meshes: closest points against every triangle, sides, defects.

use signorini_geometry::closest::{FeatureKind, Query, closest};
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::shape::{Axes, Curve, Shape, Surface};
use signorini_geometry::{Point, Vector};

struct Random(u64);

impl Random {
    fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        low + (high - low) * (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn vector(&mut self, size: f64) -> Vector<3> {
        Vector::<3>::from_fn(|_, _| self.between(-size, size))
    }
}

/// A closed, bumpy sphere.
fn ball(n: usize, centre: Point<3>) -> TriangleMesh {
    let mut vertices = vec![];
    let at = |i: usize, j: usize| {
        let (v, u) = (std::f64::consts::PI * i as f64 / n as f64, std::f64::consts::TAU * j as f64 / (2 * n) as f64);
        let r = 1.0 + 0.1 * (3.0 * u).sin() * v.sin().powi(2);
        centre + Point::<3>::new(v.sin() * u.cos(), v.sin() * u.sin(), v.cos()) * r
    };
    vertices.push(at(0, 0));
    for i in 1..n {
        for j in 0..2 * n {
            vertices.push(at(i, j));
        }
    }
    vertices.push(at(n, 0));
    let ring = |i: usize, j: usize| (1 + (i - 1) * 2 * n + j % (2 * n)) as u32;
    let last = (vertices.len() - 1) as u32;
    let mut triangles = vec![];
    for j in 0..2 * n {
        triangles.push([0, ring(1, j), ring(1, j + 1)]);
        triangles.push([last, ring(n - 1, j + 1), ring(n - 1, j)]);
        for i in 1..n - 1 {
            triangles.push([ring(i, j), ring(i + 1, j), ring(i + 1, j + 1)]);
            triangles.push([ring(i, j), ring(i + 1, j + 1), ring(i, j + 1)]);
        }
    }
    TriangleMesh::new(vertices, &triangles).unwrap()
}

/// Distance to a triangle by minimising over its plane and its sides separately.
fn exact(p: &Point<3>, [a, b, c]: &[Point<3>; 3]) -> f64 {
    let side = |p0: &Point<3>, p1: &Point<3>| {
        let d = p1 - p0;
        let t = ((p - p0).dot(&d) / d.norm_squared()).clamp(0.0, 1.0);
        (p0 + d * t - p).norm()
    };
    let mut best = side(a, b).min(side(b, c)).min(side(c, a));
    let n = (b - a).cross(&(c - a));
    let inside = |p0: &Point<3>, p1: &Point<3>| (p1 - p0).cross(&(p - p0)).dot(&n) >= 0.0;
    if inside(a, b) && inside(b, c) && inside(c, a) {
        best = best.min((p - a).dot(&n).abs() / n.norm());
    }
    best
}

#[test]
fn points_against_every_triangle() {
    let mesh = ball(20, Point::<3>::zeros());
    assert!(mesh.quality().has_inside());
    let mut r = Random(3);
    for k in 0..400 {
        let p = if k % 2 == 0 { r.vector(1.5) } else { r.vector(1.0).normalize() * r.between(0.9, 1.2) };
        let feet = mesh.closest(&p, 1e-12);
        let brute = (0..mesh.triangles().len()).map(|t| exact(&p, &mesh.corners(t))).fold(f64::INFINITY, f64::min);
        assert!((feet[0].distance - brute).abs() < 1e-13, "{k}: {} {brute}", feet[0].distance);
        assert!((mesh.position(feet[0].triangle, feet[0].parameters) - feet[0].point).norm() < 1e-15);
        // The mesh lies within a percent of r = 1 + bump.
        let gap = feet[0].gap.unwrap();

        assert!(gap.abs() == feet[0].distance);
        if p.norm() < 0.8 {
            assert!(gap < 0.0, "{p:?} is inside");
        } else if p.norm() > 1.15 {
            assert!(gap > 0.0, "{p:?} is outside");
        }
    }
}

#[test]
fn edges_and_vertices_have_numbers_of_the_mesh() {
    let cube: Vec<Point<3>> =
        (0..8).map(|k| Point::<3>::new(f64::from(k & 1), f64::from(k >> 1 & 1), f64::from(k >> 2))).collect();
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> = faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect();
    let mesh = TriangleMesh::new(cube, &triangles).unwrap();
    assert!(mesh.quality().has_inside());
    assert_eq!(mesh.edge_count(), 18);
    let corner = mesh.closest(&Point::<3>::new(2.0, 2.0, 2.0), 1e-12);
    assert_eq!((corner.len(), corner[0].kind(), corner[0].number), (1, FeatureKind::Vertex, 7));
    let edge = mesh.closest(&Point::<3>::new(2.0, 2.0, 0.5), 1e-12);
    assert_eq!((edge.len(), edge[0].kind()), (1, FeatureKind::Edge));
    assert!((edge[0].normal - Vector::<3>::new(0.5f64.sqrt(), 0.5f64.sqrt(), 0.0)).norm() < 1e-15);
    let middle = mesh.closest(&Point::<3>::new(0.5, 0.5, 0.5), 1e-12);
    assert_eq!(middle.len(), 6);
    assert_eq!(middle[0].gap, Some(-0.5));
}

#[test]
fn defects_are_counted_and_take_the_side_away() {
    let v = |x: f64, y: f64| Point::<3>::new(x, y, 0.0);
    let square = vec![v(0.0, 0.0), v(1.0, 0.0), v(1.0, 1.0), v(0.0, 1.0)];
    let mesh = TriangleMesh::new(square.clone(), &[[0, 1, 2], [0, 2, 3], [2, 0, 1], [0, 0, 1]]).unwrap();
    let q = mesh.quality();
    assert_eq!((q.duplicate_triangles, q.degenerate_triangles), (1, 1));
    assert!(!q.has_inside() && mesh.closest(&v(0.5, 0.2), 0.0)[0].gap.is_none());
    let flipped = TriangleMesh::new(square.clone(), &[[0, 1, 2], [0, 3, 2]]).unwrap();
    assert_eq!((flipped.quality().flipped_edges, flipped.quality().open_edges), (1, 4));
    assert!(TriangleMesh::new(square.clone(), &[[0, 1, 9]]).unwrap_err().to_string().contains("vertex 9"));
    assert!(TriangleMesh::new(square, &[]).is_err());
    assert!(TriangleMesh::new(vec![v(f64::NAN, 0.0); 3], &[[0, 1, 2]]).is_err());
}

#[test]
fn meshes_curves_and_surfaces_against_meshes() {
    let mesh = ball(10, Point::<3>::zeros());
    let other = ball(8, Point::<3>::new(2.6, 0.3, 0.2));
    let pair = mesh.closest_to_mesh(&other);
    let mut brute = f64::INFINITY;
    for t in 0..other.triangles().len() {
        for v in other.corners(t) {
            brute = brute.min(mesh.closest(&v, 0.0)[0].distance);
        }
    }
    assert!(pair.distance <= brute + 1e-15 && pair.distance > 0.9 * brute, "{} {brute}", pair.distance);
    let deep = ball(8, Point::<3>::new(1.5, 0.0, 0.1));
    assert!(mesh.closest_to_mesh(&deep).distance < 1e-15, "the balls intersect");

    let shape: Shape = mesh.clone().into();
    let query = Query::default();
    let helix = Curve::helix(Axes::standard(Point::<3>::new(1.6, 0.0, -1.0)), 0.3, 0.2, [0.0, 9.0]).unwrap();
    let found = closest(&helix.clone().into(), &shape, &query);
    let samples = (0..=4000).map(|k| helix.position(9.0 * f64::from(k) / 4000.0));
    let brute = samples.map(|p| mesh.closest(&p, 0.0)[0].distance).fold(f64::INFINITY, f64::min);
    assert!(found.distance() <= brute + 1e-14 && found.distance() > brute - 1e-5, "{} {brute}", found.distance());
    let on_mesh = mesh.position(found.closest.b.element, found.closest.b.parameters().try_into().unwrap());
    assert!((on_mesh - found.closest.b.point).norm() < 1e-14);
    let plane = Surface::plane(Axes::standard(Point::<3>::new(0.0, 0.0, 1.5)), [[-1.0, 1.0]; 2]).unwrap();
    let found = closest(&plane.into(), &shape, &query);
    assert!((found.distance() - 0.5).abs() < 1e-14, "{}", found.distance());
}

#[test]
fn moved_vertices_are_found_where_they_are() {
    let mut mesh = ball(12, Point::<3>::zeros());
    let moved: Vec<Point<3>> = mesh.vertices().iter().map(|v| v + Vector::<3>::new(0.3 * v.y, 1.0, 0.0)).collect();
    mesh.move_vertices(moved.clone()).unwrap();
    let fresh = TriangleMesh::new(moved, mesh.triangles()).unwrap();
    let mut r = Random(9);
    for _ in 0..100 {
        let p = r.vector(2.0);
        assert_eq!(mesh.closest(&p, 0.0)[0].distance, fresh.closest(&p, 0.0)[0].distance);
    }
    assert!(mesh.move_vertices(vec![]).is_err());
}

/// A box between two corners, its triangles facing outwards.
fn cuboid(low: [f64; 3], high: [f64; 3]) -> (Vec<Point<3>>, Vec<[u32; 3]>) {
    let corner = |k: usize| Point::<3>::from_fn(|axis, _| if k >> axis & 1 == 1 { high[axis] } else { low[axis] });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    ((0..8).map(corner).collect(), faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect())
}

#[test]
fn shells_that_overlap_or_touch_make_their_union() {
    for shift in [0.4, 0.9, 1.0, 1.5] {
        let (mut vertices, mut triangles) = cuboid([0.0; 3], [1.0; 3]);
        let (more, faces) = cuboid([shift, 0.1, 0.1], [shift + 1.0, 1.1, 1.1]);
        triangles.extend(faces.iter().map(|f| f.map(|v| v + 8)));
        vertices.extend(more);
        let mesh = TriangleMesh::new(vertices, &triangles).unwrap();
        let shape: Shape = mesh.clone().into();
        let mut r = Random(11);
        for _ in 0..2000 {
            let p = Point::<3>::new(r.between(-0.5, 3.0), r.between(-0.5, 1.5), r.between(-0.5, 1.5));
            let within = |x: f64, low: f64| low < x && x < low + 1.0;
            let inside =
                (0..3).all(|k| within(p[k], 0.0)) || (within(p.x, shift) && within(p.y, 0.1) && within(p.z, 0.1));
            let gap = mesh.closest(&p, 0.0)[0].gap.unwrap();
            assert_eq!(gap < 0.0, inside, "{p:?}, shifted by {shift}: {gap}");
            let answer = closest(&Shape::Point(p), &shape, &Query::default());
            let signed = signorini_geometry::closest::signed_gap(&answer.closest, &shape);
            assert_eq!(signed, Some(gap));
        }
    }
}

/// The sign of the gap at a point; zero where there is none.
fn side(mesh: &TriangleMesh, p: &Point<3>) -> i32 {
    mesh.closest(p, 0.0)[0].gap.map_or(0, |gap| if gap < 0.0 { -1 } else { 1 })
}

/// Prisms over polygons that cross themselves, each one connected shell, and the same inside out. The truth is how often
/// the polygon goes around a point: the sum of the angles under which its sides are seen.
#[test]
fn a_shell_that_meets_itself_holds_what_it_goes_around() {
    let star = |k: usize| (0.8 * std::f64::consts::PI * k as f64).sin_cos();
    // One inner loop within the outer one.
    let loops = |k: usize| {
        let t = std::f64::consts::TAU * k as f64 / 24.0;
        ((0.4 + t.cos()) * t.cos() - 0.6, (0.4 + t.cos()) * t.sin())
    };
    let bow = [(-0.9, -0.5), (1.0, 0.2), (1.0, -0.2), (-0.9, 0.5)];
    let mut seen = [0; 4];
    for polygon in [(0..5).rev().map(star).collect(), (0..24).map(loops).collect(), bow.to_vec()] {
        let n = polygon.len() as u32;
        let vertices: Vec<Point<3>> =
            [-0.5, 0.5].iter().flat_map(|z| polygon.iter().map(|(x, y)| Point::<3>::new(*x, *y, *z))).collect();
        let caps = (1..n - 1).flat_map(|k| [[0, k + 1, k], [n, n + k, n + k + 1]]);
        let sides = (0..n).flat_map(|k| [[k, (k + 1) % n, (k + 1) % n + n], [k, (k + 1) % n + n, k + n]]);
        let triangles: Vec<[u32; 3]> = caps.chain(sides).collect();
        let outward = TriangleMesh::new(vertices.clone(), &triangles).unwrap();
        let turned: Vec<[u32; 3]> = triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        let inward = TriangleMesh::new(vertices, &turned).unwrap();
        let mut r = Random(5);
        for _ in 0..2000 {
            let p = r.vector(1.1);
            let angles = (0..polygon.len()).map(|k| {
                let [(a, b), (c, d)] = [k, (k + 1) % polygon.len()].map(|k| (polygon[k].0 - p.x, polygon[k].1 - p.y));
                (a * d - b * c).atan2(a * c + b * d)
            });
            let around = (angles.sum::<f64>() / std::f64::consts::TAU).round() as i32;
            let around = if p.z.abs() < 0.5 { around } else { 0 };
            seen[(around + 1) as usize] += 1;
            let expected = [0, 1, -1, -1][(around + 1) as usize];
            assert_eq!(side(&outward, &p), expected, "{p:?}, {around} times around");
            assert_eq!(side(&inward, &p), -expected, "{p:?}, {around} times around, inside out");
        }
    }
    assert!(seen.iter().all(|&count| count > 20), "{seen:?}");
}

#[test]
fn an_edge_closed_by_a_triangle_without_area_has_two_sides() {
    let s = 0.267_949_192_431_122_7;
    let vertices = [
        [0.0, 0.0, 0.0],
        [0.0, 0.0, 2.0],
        [0.0, 0.0, 1.0],
        [1.0, s, 0.0],
        [1.0, s, 2.0],
        [1.0, -s, 0.0],
        [1.0, -s, 2.0],
    ];
    let triangles =
        [[0, 2, 3], [2, 4, 3], [2, 1, 4], [0, 5, 6], [0, 6, 1], [3, 4, 6], [3, 6, 5], [0, 3, 5], [1, 6, 4], [0, 1, 2]];
    let mesh = TriangleMesh::new(vertices.map(Point::<3>::from).to_vec(), &triangles).unwrap();
    for (x, y, z) in [(-0.018, -0.0466, 0.3), (-0.018, 0.0466, 1.3), (-0.05, 0.0, 1.0)] {
        let gap = mesh.closest(&Point::<3>::new(x, y, z), 0.0)[0].gap.unwrap();
        assert!((gap - x.hypot(y)).abs() < 1e-12, "{gap} at {x}, {y}, {z}");
    }
    assert!(mesh.closest(&Point::<3>::new(0.5, 0.05, 0.4), 0.0)[0].gap.unwrap() < 0.0);
}

#[test]
fn distances_scale_with_the_unit_of_length() {
    let mesh = ball(6, Point::<3>::new(0.3, -0.2, 0.1));
    let mut r = Random(21);
    for exponent in [-460, -300, -100, 0, 100, 259, 460] {
        let unit = 2f64.powi(exponent);
        let scaled = TriangleMesh::new(mesh.vertices().iter().map(|v| v * unit).collect(), mesh.triangles()).unwrap();
        for _ in 0..50 {
            let p = r.vector(2.0);
            let (one, other) = (mesh.closest(&p, 0.0)[0], scaled.closest(&(p * unit), 0.0)[0]);
            assert!((other.distance / unit / one.distance - 1.0).abs() < 1e-14, "2^{exponent}: {p:?}");
            assert_eq!(other.gap.unwrap() < 0.0, one.gap.unwrap() < 0.0, "2^{exponent}: {p:?}");
        }
    }
}
