//! Queries per second of certified closest points, one line per class: `cargo bench -p signorini-geometry`.

use signorini_geometry::closest::{Query, Step, Tracker, closest};
use signorini_geometry::shape::{Axes, Curve, Shape, Surface};
use signorini_geometry::{Point, Vector};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::time::Instant;

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

fn knots(n: usize, degree: usize) -> Vec<f64> {
    let mut knots = vec![0.0; degree];
    knots.extend((0..=n - degree).map(|k| k as f64));
    knots.extend(vec![(n - degree) as f64; degree]);
    knots
}

fn net(r: &mut Random, n: usize, m: usize, noise: f64) -> Vec<Vec<Point<3>>> {
    let at = |i: usize, n: usize| -1.0 + 2.0 * i as f64 / (n - 1) as f64;
    (0..n).map(|i| (0..m).map(|j| Point::<3>::new(at(i, n), at(j, m), 0.0) + r.vector(noise)).collect()).collect()
}

fn nurbs_curve(r: &mut Random, height: f64) -> Shape {
    let points: Vec<Point<3>> =
        (0..8).map(|i| Point::<3>::new(-1.0 + i as f64 * 0.28, 0.0, height) + r.vector(0.4)).collect();
    let weights: Vec<f64> = (0..8).map(|_| r.between(0.7, 1.4)).collect();
    Curve::nurbs(3, &knots(8, 3), &points, Some(&weights), false).unwrap().into()
}

fn nurbs_surface(r: &mut Random, height: f64) -> Shape {
    weighted_surface(r, height, 0.15)
}

/// Weights up to `10^±decades`.
fn weighted_surface(r: &mut Random, height: f64, decades: f64) -> Shape {
    let mut points = net(r, 6, 7, 0.2);
    points.iter_mut().flatten().for_each(|p| p.z += height);
    let mut weight = || 10f64.powf(r.between(-decades, decades));
    let weights: Vec<Vec<f64>> = (0..6).map(|_| (0..7).map(|_| weight()).collect()).collect();
    Surface::nurbs([3, 3], [&knots(6, 3), &knots(7, 3)], &points, Some(&weights), [false; 2]).unwrap().into()
}

fn analytic(r: &mut Random, k: usize) -> Shape {
    let axes = Axes::standard(r.vector(0.2));
    let turn = [0.0, TAU];
    let lat = [-FRAC_PI_2, FRAC_PI_2];
    let surface = match k % 6 {
        0 => Surface::plane(axes, [[-1.0, 1.0]; 2]),
        1 => Surface::cylinder(axes, 0.6, [turn, [-1.0, 1.0]], true),
        2 => Surface::cone(axes, 0.6, 0.8, [turn, [0.0, 1.0]], true),
        3 => Surface::sphere(axes, 0.8, [turn, lat], true),
        4 => Surface::torus(axes, 0.9, 0.3, [turn, turn], [true, true]),
        _ => Surface::ellipsoid(axes, [1.0, 0.7, 0.5], [turn, lat], true),
    };
    surface.unwrap().into()
}

fn time(name: &str, queries: &[(usize, Shape)], shapes: &[Shape]) {
    let query = Query::default();
    let mut rounds = 0;
    let mut sum = 0.0;
    let mut effort = 0;
    // The first round builds what queries look at.
    for (k, shape) in queries {
        std::hint::black_box(closest(shape, &shapes[*k], &query));
    }
    let start = Instant::now();
    while start.elapsed().as_secs_f64() < 0.4 {
        for (k, shape) in queries {
            let p = closest(shape, &shapes[*k], &query);
            sum += p.distance();
            effort += p.effort;
        }
        rounds += 1;
    }
    let count = (rounds * queries.len()) as f64;
    println!(
        "{name:23} {:>12.3e} queries/s  {:>9.3} us  {:>7.1} cell pairs   (mean distance {:.3})",
        count / start.elapsed().as_secs_f64(),
        start.elapsed().as_secs_f64() / count * 1e6,
        effort as f64 / count,
        sum / count
    );
}

/// A point that wanders slowly, followed with certificates.
fn track(name: &str, shapes: &[Shape], r: &mut Random) {
    let (mut steps, mut warm) = (0u64, 0u64);
    let paths: Vec<(Vector<3>, Vector<3>)> = shapes.iter().map(|_| (r.vector(0.8), r.vector(0.0005))).collect();
    let start = Instant::now();
    while start.elapsed().as_secs_f64() < 0.4 {
        for (shape, (from, velocity)) in shapes.iter().zip(&paths) {
            let mut tracker = Tracker::new(Query::default());
            let motion = velocity.norm() * 1.000001;
            for k in 0..1000 {
                let p = Shape::Point(from + velocity * f64::from(k));
                let (_, step) = tracker.closest(&p, shape, [motion, 0.0]);
                warm += u64::from(step == Step::Warm);
                steps += 1;
            }
        }
    }
    let seconds = start.elapsed().as_secs_f64();
    println!(
        "{name:23} {:>12.3e} steps/s    {:>8.1} % warm",
        steps as f64 / seconds,
        100.0 * warm as f64 / steps as f64
    );
}

fn main() {
    let mut r = Random(7);
    let mut run = |name: &str, partner: &str, make: &mut dyn FnMut(&mut Random, usize) -> Shape| {
        let shapes: Vec<Shape> = (0..24).map(|k| make(&mut r, k)).collect();
        let queries: Vec<(usize, Shape)> = (0..480)
            .map(|k| {
                let shape = match partner {
                    "point" => Shape::Point(r.vector(1.2)),
                    "curve" => {
                        let height = r.between(0.3, 1.2);
                        nurbs_curve(&mut r, height)
                    }
                    _ => {
                        let height = r.between(0.3, 1.2);
                        nurbs_surface(&mut r, height)
                    }
                };
                (k % 24, shape)
            })
            .collect();
        time(name, &queries, &shapes);
    };
    run("point-analytic", "point", &mut analytic);
    run("point-triangle", "point", &mut |r, _| {
        Surface::tri3(&[r.vector(1.0), r.vector(1.0), r.vector(1.0)]).unwrap().into()
    });
    run("point-curve", "point", &mut |r, _| nurbs_curve(r, 0.0));
    run("point-quad9", "point", &mut |r, _| Surface::lagrange_quad(&net(r, 3, 3, 0.25)).unwrap().into());
    run("point-tri6", "point", &mut |r, _| {
        let n: Vec<Point<3>> = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.0], [0.5, 0.5], [0.0, 0.5]]
            .iter()
            .map(|p| Point::<3>::new(p[0], p[1], 0.0) + r.vector(0.12))
            .collect();
        Surface::tri6(&n.try_into().unwrap()).unwrap().into()
    });
    run("point-bicubic", "point", &mut |r, _| Surface::bezier(&net(r, 4, 4, 0.4), None).unwrap().into());
    run("point-B-spline 6x7", "point", &mut |r, _| {
        let points = net(r, 6, 7, 0.2);
        Surface::nurbs([3, 3], [&knots(6, 3), &knots(7, 3)], &points, None, [false; 2]).unwrap().into()
    });
    run("point-NURBS 6x7", "point", &mut |r, _| nurbs_surface(r, 0.0));
    run("point-weights 0.1 to 10", "point", &mut |r, _| weighted_surface(r, 0.0, 1.0));
    run("curve-curve NURBS", "curve", &mut |r, _| nurbs_curve(r, 0.0));
    run("curve-surface NURBS", "curve", &mut |r, _| nurbs_surface(r, 0.0));
    run("surface-surface NURBS", "surface", &mut |r, _| nurbs_surface(r, 0.0));
    let mut build = |name: &str, make: &mut dyn FnMut(&mut Random) -> Shape| {
        let (mut count, start) = (0, Instant::now());
        while start.elapsed().as_secs_f64() < 0.3 {
            std::hint::black_box(make(&mut r));
            count += 1;
        }
        println!("{name:23} {:>9.1} us to build", start.elapsed().as_secs_f64() / f64::from(count) * 1e6);
    };
    println!();
    build("curve NURBS", &mut |r| nurbs_curve(r, 0.0));
    build("quad9", &mut |r| Surface::lagrange_quad(&net(r, 3, 3, 0.25)).unwrap().into());
    build("bicubic", &mut |r| Surface::bezier(&net(r, 4, 4, 0.4), None).unwrap().into());
    build("surface NURBS 6x7", &mut |r| nurbs_surface(r, 0.0));
    build("weights 0.1 to 10", &mut |r| weighted_surface(r, 0.0, 1.0));
    // Much of a surface is built when a query first looks there.
    let (mut count, start) = (0, Instant::now());
    while start.elapsed().as_secs_f64() < 0.3 {
        let surface = weighted_surface(&mut r, 0.0, 1.0);
        std::hint::black_box(closest(&Shape::Point(r.vector(1.2)), &surface, &Query::default()));
        count += 1;
    }
    println!("built and asked once   {:>9.1} us", start.elapsed().as_secs_f64() / f64::from(count) * 1e6);
    println!();
    let curves: Vec<Shape> = (0..12).map(|_| nurbs_curve(&mut r, 0.0)).collect();
    track("point-curve, warm", &curves, &mut r);
    let quads: Vec<Shape> = (0..12).map(|_| Surface::lagrange_quad(&net(&mut r, 3, 3, 0.15)).unwrap().into()).collect();
    track("point-quad9, warm", &quads, &mut r);
    let cubic: Vec<Shape> = (0..12).map(|_| Surface::bezier(&net(&mut r, 4, 4, 0.2), None).unwrap().into()).collect();
    track("point-bicubic, warm", &cubic, &mut r);
    let surfaces: Vec<Shape> = (0..12).map(|_| nurbs_surface(&mut r, 0.0)).collect();
    track("point-NURBS 6x7, warm", &surfaces, &mut r);
}
