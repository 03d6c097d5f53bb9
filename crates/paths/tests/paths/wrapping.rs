//! Shortest paths against closed forms, published numbers and finite differences.

use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::{Cylinder, Ellipsoid, Profile, Revolution, RigidShape, Sphere, Torus};
use signorini_geometry::{Jet, Point, Vector};
use signorini_paths::friction::Friction;
use signorini_paths::wrapping::{Anchor, Body, EventKind, Minimal, Route, Station, WrappedPath, Wrapping};
use signorini_paths::{PathError, Place};
use std::f64::consts::TAU;

fn point(x: [f64; 3]) -> Point<3> {
    Point::<3>::from(x)
}

fn around(bodies: usize) -> Vec<Station> {
    (0..bodies).map(|body| Station::Around { body, turns: 0 }).collect()
}

fn route(a: [f64; 3], b: [f64; 3], stations: Vec<Station>) -> Route {
    Route { start: Anchor::fixed(point(a)), stations, end: Anchor::fixed(point(b)) }
}

fn solve(a: [f64; 3], b: [f64; 3], shape: &dyn RigidShape, turns: u32) -> WrappedPath {
    Wrapping::new(route(a, b, vec![Station::Around { body: 0, turns }])).solve(&[Body::fixed(shape)]).unwrap()
}

fn ellipsoid() -> Ellipsoid {
    Ellipsoid::new(Point::<3>::zeros(), [2.0, 1.5, 1.0]).unwrap()
}

fn torus() -> Torus {
    Torus { center: Point::<3>::zeros(), axis: Vector::<3>::z(), major: 3.0, minor: 1.0 }
}

/// Length over a circle of the plane between points at distances `a` and `b` from its middle, the angle between them given.
fn over_circle(r: f64, a: f64, b: f64, angle: f64) -> f64 {
    (a * a - r * r).sqrt() + (b * b - r * r).sqrt() + r * (angle - (r / a).acos() - (r / b).acos())
}

#[test]
fn sphere_with_and_without_turns() {
    for (r, a, b) in [(1.7f64, [-4.0, 1.0, 0.5], [3.0, 2.0, -1.0]), (0.9, [-2.0, 0.1, 0.3], [1.5, -0.2, 0.4])] {
        let sphere = Sphere { center: Point::<3>::zeros(), radius: r };
        let (pa, pb) = (point(a), point(b));
        let angle = pa.angle(&pb);
        for turns in [0, 1, 3] {
            let path = solve(a, b, &sphere, turns);
            let exact = over_circle(r, pa.norm(), pb.norm(), angle + TAU * f64::from(turns));
            assert!((path.length / exact - 1.0).abs() < 1e-12, "{turns}: {} {exact}", path.length);
            let minimal = if turns == 0 { Minimal::Locally } else { Minimal::BeyondConjugatePoint };
            assert_eq!(path.contacts[0].minimal, minimal);
        }
    }
}

#[test]
fn cylinder_with_and_without_turns() {
    let (r, a, b): (f64, [f64; 3], [f64; 3]) = (0.8, [-2.0, 0.3, 0.5], [1.4, 0.2, 1.9]);
    let cylinder = Cylinder { point: Point::<3>::zeros(), axis: Vector::<3>::z(), radius: r };
    let flat = |x: [f64; 3]| x[0].hypot(x[1]);
    let angle: f64 = (a[1].atan2(a[0]) - b[1].atan2(b[0])).rem_euclid(TAU);
    let angle = angle.min(TAU - angle);
    for turns in [0, 1, 2, 3] {
        let path = solve(a, b, &cylinder, turns);
        let exact = over_circle(r, flat(a), flat(b), angle + TAU * f64::from(turns)).hypot(b[2] - a[2]);
        assert!((path.length / exact - 1.0).abs() < 1e-12, "{turns}: {} {exact}", path.length);
    }
}

#[test]
fn published_lengths() {
    let path = solve([-3.0, 0.5, 0.3], [2.2, 1.6, -0.9], &ellipsoid(), 0);
    assert!((path.length - 5.488014095081).abs() < 1e-11, "{}", path.length);
    assert!((path.contacts[0].length - 0.588362847574).abs() < 1e-10, "{}", path.contacts[0].length);
    let path = solve([-5.5, 1.0, 0.4], [3.0, 5.0, -0.6], &torus(), 0);
    assert!((path.length - 9.5686893682).abs() < 1e-10, "{}", path.length);
    assert!((path.contacts[0].length - 1.3243013762).abs() < 1e-9, "{}", path.contacts[0].length);
}

/// A sweep through touchdown: few steps each, length and moment arm without jumps, no body where none is in the way.
fn sweep(shape: &dyn RigidShape, at: impl Fn(f64) -> [f64; 3], b: [f64; 3]) {
    let bodies = [Body::fixed(shape)];
    let mut wrapping = Wrapping::new(route(at(0.0), b, around(1)));
    wrapping.solve(&bodies).unwrap();
    let (mut steps, mut events) = (0, Vec::new());
    let mut arms = Vec::new();
    let n = 201;
    for k in 0..n {
        wrapping.set_start(Anchor::fixed(point(at(f64::from(k) / f64::from(n - 1)))));
        let path = wrapping.solve(&bodies).unwrap();
        steps += path.iterations;
        events.extend(path.events.iter().map(|e| (k, e.kind)));
        arms.push(path.moment_arm(0, &Point::<3>::zeros(), &Vector::<3>::new(0.3, 0.5, 0.81).normalize()));
        let mut cold = wrapping.clone();
        cold.forget();
        assert!((cold.solve(&bodies).unwrap().length - path.length).abs() < 1e-10, "{k}");
    }
    let mean = steps as f64 / f64::from(n);
    assert!(mean <= 3.0, "{mean}");
    assert!(events.iter().any(|e| e.1 == EventKind::Touchdown), "{events:?}");
    // Next to a jump the second difference would be as large as it.
    let jump = arms.windows(3).map(|w| (w[0] - 2.0 * w[1] + w[2]).abs()).fold(0.0, f64::max);
    let change = arms.windows(2).map(|w| (w[1] - w[0]).abs()).fold(0.0, f64::max);
    assert!(jump < 0.5 * change + 1e-3 && change < 0.1, "{jump} {change}");
}

#[test]
fn touchdown_on_an_ellipsoid() {
    sweep(&ellipsoid(), |t| [-3.0, 3.5 - 4.0 * t, 0.3], [2.2, 1.6, -0.9]);
}

#[test]
fn touchdown_on_a_torus() {
    sweep(&torus(), |t| [-5.5, 8.0 - 7.0 * t, 0.4], [3.0, 5.0, -0.6]);
}

/// Three bodies that stand and are turned anyhow.
fn three(bodies: &[RigidMotion; 3]) -> Result<WrappedPath, PathError> {
    let shapes: [&dyn RigidShape; 3] = [&ellipsoid(), &torus(), &Sphere { center: Point::<3>::zeros(), radius: 1.2 }];
    let bodies: Vec<Body<'_>> =
        shapes.iter().zip(bodies).map(|(shape, m)| Body { shape: *shape, motion: *m }).collect();
    let mut stations = around(3);
    stations.insert(2, Station::Via(Anchor::on(1, point([3.0, 2.4, 0.9]))));
    Wrapping::new(Route {
        start: Anchor::fixed(point([-4.0, 0.4, -0.8])),
        stations,
        end: Anchor::on(2, point([1.5, 0.3, -1.0])),
    })
    .solve(&bodies)
}

#[test]
fn derivatives_by_the_motion_of_every_body() {
    let place = |x: [f64; 3], turn: [f64; 3]| {
        RigidMotion::new(Vector::<3>::from(turn), Point::<3>::zeros(), Vector::<3>::from(x))
    };
    let places = [
        place([0.0, 0.0, -0.5], [0.1, 0.2, -0.3]),
        place([7.0, -1.0, 0.6], [0.1, -0.2, 0.1]),
        place([13.0, 1.0, 1.0], [0.0, 0.5, 0.2]),
    ];
    let path = three(&places).unwrap();
    assert!(path.contacts.len() == 3, "{:?}", path.contacts);
    let about = point([0.5, -0.3, 0.8]);
    let h = 1e-5;
    for body in 0..3 {
        let found = path.body_gradient(body, &about);
        for axis in 0..3 {
            let mut way = Vector::<3>::zeros();
            way[axis] = h;
            let length = |motion: RigidMotion| {
                let mut moved = places;
                moved[body] = RigidMotion {
                    rotation: motion.rotation * places[body].rotation,
                    translation: motion.point(&places[body].translation),
                    ..motion
                };
                three(&moved).unwrap().length
            };
            let zero = Vector::<3>::zeros();
            let shift =
                (length(RigidMotion::new(zero, about, way)) - length(RigidMotion::new(zero, about, -way))) / (2.0 * h);
            let turn =
                (length(RigidMotion::new(way, about, zero)) - length(RigidMotion::new(-way, about, zero))) / (2.0 * h);
            assert!((shift - found.shift[axis]).abs() < 1e-8, "{body} {axis}: {shift} {:?}", found.shift);
            assert!((turn - found.turn[axis]).abs() < 1e-8, "{body} {axis}: {turn} {:?}", found.turn);
        }
    }
}

#[test]
fn derivatives_by_ends_and_via_points() {
    let shape = Ellipsoid::new(Point::<3>::zeros(), [3.0, 2.0, 1.0]).unwrap();
    let length = |points: [[f64; 3]; 3]| {
        let mut stations = around(1);
        stations.push(Station::Via(Anchor::fixed(point(points[1]))));
        stations.extend(around(1));
        Wrapping::new(route(points[0], points[2], stations)).solve(&[Body::fixed(&shape)]).unwrap()
    };
    let points = [[-4.0, 0.5, -0.3], [0.3, 0.8, 1.05], [3.6, -1.2, -0.4]];
    let path = length(points);
    assert!(path.contacts.len() == 2, "{:?}", path.contacts);
    let [first, last] = path.end_gradients();
    let gradients = [first, path.via_gradients()[0].1, last];
    for (k, gradient) in gradients.iter().enumerate() {
        for axis in 0..3 {
            let moved = |h: f64| {
                let mut points = points;
                points[k][axis] += h;
                length(points).length
            };
            let slope = (moved(1e-5) - moved(-1e-5)) / 2e-5;
            assert!((slope - gradient[axis]).abs() < 1e-8, "{k} {axis}: {slope} {gradient:?}");
        }
    }
}

/// A tendon fastened to the body on which it lies; two such ends are a geodesic between points.
#[test]
fn ends_on_the_body() {
    let sphere = Sphere { center: Point::<3>::zeros(), radius: 1.5 };
    let path = solve([-1.5, 0.0, 0.0], [2.0, 1.0, 0.3], &sphere, 0);
    let b = point([2.0, 1.0, 0.3]);
    let angle = point([-1.0, 0.0, 0.0]).angle(&b);
    let exact = (b.norm_squared() - 2.25).sqrt() + 1.5 * (angle - (1.5 / b.norm()).acos());
    assert!((path.length - exact).abs() < 1e-11, "{} {exact}", path.length);
    let path = solve([-1.5, 0.0, 0.0], [0.9, 1.2, 0.0], &sphere, 0);
    assert!((path.length - 1.5 * (-0.6f64).acos()).abs() < 1e-11, "{}", path.length);
}

/// Between the ends of a waist the path runs straight.
#[test]
fn a_waist_is_bridged() {
    let profile = Profile::formula(
        |t: Jet<1>| [(t * t - t * t * t * t * 0.25) * 0.4 + Jet::<1>::variable(0.0, 0) * 0.0 + 0.6, t],
        [-1.9, 1.9],
        16,
    );
    let waist = Revolution { origin: Point::<3>::zeros(), axis: Vector::<3>::z(), profile: profile.unwrap() };
    let path = solve([0.35, 0.9, -2.6], [0.35, 0.9, 2.6], &waist, 0);
    assert_eq!(path.contacts.len(), 2, "{:?}", path.contacts);
    assert!(path.residual < 1e-11 && path.contacts.iter().all(|c| c.length > 0.0));
    // It is the mirror image of itself.
    let [one, two] = [path.contacts[0], path.contacts[1]];
    assert!((one.length - two.length).abs() < 1e-9 && (one.q.z + two.p.z).abs() < 1e-9);
    for p in path.points(&[Body::fixed(&waist)], 8).unwrap() {
        assert!(waist.gap(&p.x).gap > -1e-9, "{p:?}");
    }
}

#[test]
fn friction_along_and_across() {
    let (r, mu) = (1.7, 0.02);
    let sphere = Sphere { center: Point::<3>::zeros(), radius: r };
    let path = solve([-4.0, 1.0, 0.5], [3.0, 2.0, -1.0], &sphere, 0);
    let found = path.tensions(&[Body::fixed(&sphere)], &Friction::Carried { along: 0.3, across: mu }).unwrap();
    let angle = path.contacts[0].length / r;
    assert!((found.log_ratio[1] - 0.3 * angle).abs() < 1e-12 && (found.log_ratio[0] + 0.3 * angle).abs() < 1e-12);
    let sideways = found.contacts[0].1.clone().unwrap();
    assert!((sideways.drift - mu * (1.0 - angle.cos()) * r).abs() < 1e-11, "{}", sideways.drift);
    assert!((sideways.rotation - mu * angle.sin()).abs() < 1e-11);
    let corner = sideways.corner([1.0, 0.3]);
    assert!((corner[0] + 0.3 * corner[1] - sideways.support([1.0, 0.3])).abs() < 1e-14);
    assert!(
        found.utilisation(1.0, 1.0) == 0.0 && (found.utilisation(1.0, found.end_tensions(1.0)[1]) - 1.0).abs() < 1e-12
    );
}

#[test]
fn refused_routes() {
    let sphere = Sphere { center: Point::<3>::zeros(), radius: 1.0 };
    let bodies = [Body::fixed(&sphere)];
    let error = Wrapping::new(route([0.2, 0.0, 0.0], [3.0, 0.0, 0.0], around(1))).solve(&bodies).unwrap_err();
    let PathError::Inside { place: Place::Start, body: 0, depth } = error else { panic!("{error}") };
    assert!((depth - 0.8).abs() < 1e-14);
    let error = Wrapping::new(route([2.0, 0.0, 0.0], [3.0, 0.0, 0.0], around(2))).solve(&bodies).unwrap_err();
    assert!(matches!(error, PathError::NoBody { body: 1, count: 1, .. }), "{error}");
}

/// Numbers without a relation to each other, the same every time.
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

/// Routes from anywhere to anywhere over one to three bodies: every path is found, lies outside all that it goes around, and
/// is no longer than the band of nodes that any of its neighbours makes.
#[test]
fn routes_over_bodies_anywhere() {
    let mut random = Random(7);
    let cylinder =
        Cylinder { point: Point::<3>::zeros(), axis: Vector::<3>::new(0.2, 0.1, 1.0).normalize(), radius: 1.1 };
    let ring = Torus { center: Point::<3>::zeros(), axis: Vector::<3>::z(), major: 1.4, minor: 0.5 };
    let ball = Sphere { center: Point::<3>::zeros(), radius: 1.3 };
    let (egg, disc) = (ellipsoid(), Ellipsoid::new(Point::<3>::zeros(), [1.5, 1.5, 0.5]).unwrap());
    let shapes: [&dyn RigidShape; 5] = [&cylinder, &ring, &ball, &egg, &disc];
    let (mut touched, mut lost) = (0, Vec::new());
    for case in 0..300 {
        let count = 1 + case % 3;
        let bodies: Vec<Body<'_>> = (0..count)
            .map(|k| {
                let turn = random.vector(1.5);
                let place = Vector::<3>::new(5.0 * k as f64, 0.0, 0.0) + random.vector(0.5);
                let shape = shapes[(random.between(0.0, 5.0) as usize).min(4)];
                Body { shape, motion: RigidMotion::new(turn, Point::<3>::zeros(), place) }
            })
            .collect();
        let start = Point::<3>::new(-3.5, 0.0, 0.0) + random.vector(0.8);
        let end = Point::<3>::new(5.0 * count as f64 - 1.5, 0.0, 0.0) + random.vector(0.8);
        let mut wrapping = Wrapping::new(route(start.into(), end.into(), around(count)));
        match wrapping.solve(&bodies) {
            Ok(path) => {
                touched += path.contacts.len();
                for p in path.points(&bodies, 6).unwrap() {
                    for b in &bodies {
                        let inside = b.motion.rotation.transpose() * (p.x - b.motion.translation);
                        assert!(b.shape.gap(&inside).gap > -1e-8, "{case}: {p:?}");
                    }
                }
            }
            Err(PathError::Inside { .. }) => {}
            Err(error) => lost.push((case, error.to_string())),
        }
    }
    assert!(lost.is_empty(), "{} lost: {:?}", lost.len(), &lost[..lost.len().min(5)]);
    assert!(touched > 300, "{touched}");
}

/// In whatever order the bodies of a path stand, it goes through none of them; the order in which it meets them is told.
#[test]
fn a_path_goes_through_no_body_in_whatever_order_they_stand() {
    let roller = |x: f64, z: f64, radius: f64| Cylinder { point: point([x, 0.0, z]), axis: Vector::<3>::y(), radius };
    let (first, second, third) = (roller(-3.0, -0.5, 1.0), roller(0.0, 0.9, 0.8), roller(3.0, -0.9, 1.2));
    let bodies = [Body::fixed(&first), Body::fixed(&second), Body::fixed(&third)];
    let (from, to) = ([-6.0, 0.0, 0.3], [6.0, 0.2, 0.2]);
    let solve = |order: [usize; 3], motion: f64| {
        let stations = order.map(|body| Station::Around { body, turns: 0 }).to_vec();
        let mut search = Wrapping::new(route(from, to, stations));
        search.solve(&bodies).unwrap();
        // What was found is followed.
        let end = point([to[0], to[1] + motion, to[2]]);
        search.set_end(Anchor::fixed(end));
        search.solve(&bodies).unwrap()
    };
    let right = solve([0, 1, 2], 0.1);
    assert!(right.contacts.len() == 3 && right.order == [0, 1, 2]);
    for order in [[0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]] {
        let path = solve(order, 0.1);
        for body in 0..3 {
            assert!(path.crosses(&bodies, body).unwrap().is_none(), "{order:?} goes through {body}");
        }
        assert!((path.length / right.length - 1.0).abs() < 1e-12, "{order:?}: {} {}", path.length, right.length);
        let met: Vec<usize> = path.order.iter().map(|station| order[*station]).collect();
        assert_eq!(met, [0, 1, 2], "{order:?}");
        assert!(path.events.is_empty(), "{order:?}: {:?}", path.events);
    }
    // A body that is no station is not gone around: where the path goes through it is told.
    let mut search = Wrapping::new(route([-6.0, 0.1, -0.3], [-1.0, 0.1, -0.3], around(0)));
    let (x, depth) = search.solve(&bodies).unwrap().crosses(&bodies, 0).unwrap().unwrap();
    assert!((x - point([-3.0, 0.1, -0.3])).norm() < 1e-6 && depth > 0.5, "{x} {depth}");
}
