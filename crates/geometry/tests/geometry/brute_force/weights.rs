//! Rational curves and surfaces whose weights are orders of magnitude apart.
//!
//! The shapes are Bezier pieces joined by repeated knots. The truth is sampled in the odds `t / (1 - t)` of a piece, of
//! which powers weigh the control points: equal steps of their logarithm resolve any weights.

use super::shapes::{Random, Sample};
use super::{Objective, in_parallel, multiplier};
use signorini_geometry::Point;
use signorini_geometry::closest::{Certificate, Query, closest};
use signorini_geometry::shape::{Curve, Surface};

/// Piece and parameter in it for `z` in the unit interval.
fn piece(z: f64, pieces: usize) -> (usize, f64) {
    let k = ((z * pieces as f64) as usize).min(pieces - 1);
    (k, z * pieces as f64 - k as f64)
}

/// The share of each control point of a piece, up to a common factor, at odds from 1e-10 to 1e10.
fn powers(degree: usize, s: f64) -> Vec<f64> {
    let mut binomial = 1.0;
    (0..=degree)
        .map(|i| {
            let value = match s {
                _ if s <= 0.0 => f64::from(u8::from(i == 0)),
                _ if s >= 1.0 => f64::from(u8::from(i == degree)),
                _ => binomial * 10f64.powf((20.0 * s - 10.0) * (i as f64 - 0.5 * degree as f64)),
            };
            binomial *= (degree - i) as f64 / (i + 1) as f64;
            value
        })
        .collect()
}

fn knots(degree: usize, pieces: usize) -> Vec<f64> {
    let inner = (0..=pieces).flat_map(|k| vec![k as f64; degree]);
    std::iter::once(0.0).chain(inner).chain(std::iter::once(pieces as f64)).collect()
}

/// The place in the unit interval of a parameter of the shape.
fn unit(t: f64, pieces: usize) -> f64 {
    let (k, s) = piece(t / pieces as f64, pieces);
    let place = if s <= 0.0 || s >= 1.0 { s } else { ((s / (1.0 - s)).log10() / 20.0 + 0.5).clamp(0.0, 1.0) };
    (k as f64 + place) / pieces as f64
}

/// A shape with its number of pieces in each direction.
struct Weighted {
    sample: Sample,
    pieces: [usize; 2],
}

/// Weights up to `10^±decades`.
fn shape(random: &mut Random, dimension: usize, decades: f64) -> Weighted {
    let degree = [1 + random.below(3), if dimension == 2 { 1 + random.below(3) } else { 0 }];
    let pieces = [1 + random.below(2), if dimension == 2 { 1 + random.below(2) } else { 1 }];
    let count = [0, 1].map(|k| degree[k] * pieces[k] + 1);
    let points: Vec<Vec<Point<3>>> =
        (0..count[0]).map(|_| (0..count[1]).map(|_| random.vector(1.0)).collect()).collect();
    let weights: Vec<Vec<f64>> =
        (0..count[0]).map(|_| (0..count[1]).map(|_| 10f64.powf(random.between(-decades, decades))).collect()).collect();
    let shape = if dimension == 1 {
        let (p, w): (Vec<Point<3>>, Vec<f64>) = points.iter().zip(&weights).map(|(p, w)| (p[0], w[0])).unzip();
        Curve::nurbs(degree[0], &knots(degree[0], pieces[0]), &p, Some(&w), false).unwrap().into()
    } else {
        let [u, v] = [0, 1].map(|k| knots(degree[k], pieces[k]));
        Surface::nurbs(degree, [&u, &v], &points, Some(&weights), [false; 2]).unwrap().into()
    };
    let at = move |u: f64, v: f64| {
        let ((i0, s), (j0, t)) = (piece(u, pieces[0]), piece(v, pieces[1]));
        let (along, across) = (powers(degree[0], s), powers(degree[1], t));
        let (mut sum, mut total) = (Point::<3>::zeros(), 0.0);
        for (i, b) in along.iter().enumerate() {
            for (j, c) in across.iter().enumerate() {
                let (row, column) = (i0 * degree[0] + i, j0 * degree[1] + j);
                let w = b * c * weights[row][column];
                sum += points[row][column] * w;
                total += w;
            }
        }
        sum / total
    };
    let domain = [[0.0, 1.0], [0.0, if dimension == 2 { 1.0 } else { 0.0 }]];
    Weighted { sample: Sample { name: "weighted", shape, at: Box::new(at), domain, triangle: false }, pieces }
}

/// Fails where brute force finds anything closer than is certified, or a foot is not on its shape.
fn check(a: &Weighted, b: &Weighted, per_axis: usize, label: &str) -> Certificate {
    let answer = closest(&a.sample.shape, &b.sample.shape, &Query::default());
    let size = a.sample.shape.size().max(b.sample.shape.size());
    let brute = Objective::new(&a.sample, &b.sample).brute_force(per_axis, 12);
    let context = || format!("{label}: {brute} closer than {answer:?}");
    assert!(answer.distance() - answer.certified_to <= brute + 1e-11 * size, "{}", context());
    let pair = &answer.closest;
    for (shape, foot) in [(a, &pair.a), (b, &pair.b)] {
        let z = |k: usize| foot.parameters().get(k).map_or(0.0, |t| unit(*t, shape.pieces[k]));
        // Sixteen digits of a parameter leave so many of a position.
        assert!(((shape.sample.at)(z(0), z(1)) - foot.point).norm() <= 1e-6 * size, "not on the shape; {}", context());
    }
    if answer.certificate == Certificate::Complete {
        assert!(answer.distance() <= brute + 1e-9 * size, "{}", context());
    }
    answer.certificate
}

/// Runs pairs with weights over one to eight decades; returns how many were not certified.
fn pairs(dimensions: [usize; 2], count: usize, per_axis: usize) -> usize {
    let stopped = std::sync::atomic::AtomicUsize::new(0);
    in_parallel(count * multiplier(), |k| {
        let mut random = Random(7_000_000_003 * (1 + dimensions[0] + 3 * dimensions[1]) as u64 + k as u64);
        let decades = [0.5, 1.0, 2.0, 3.0, 4.0][k % 5];
        let b = shape(&mut random, dimensions[1], decades);
        let a = match dimensions[0] {
            0 => Weighted { sample: Sample::point(random.vector(if k % 2 == 0 { 1.0 } else { 3.0 })), pieces: [1; 2] },
            dimension => shape(&mut random, dimension, decades),
        };
        if check(&a, &b, per_axis, &format!("{dimensions:?} {k}")) == Certificate::Stopped {
            stopped.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
        }
    });
    stopped.into_inner()
}

#[test]
fn points_and_weighted_shapes_are_certified() {
    assert_eq!(pairs([0, 1], 200, 600), 0);
    assert_eq!(pairs([0, 2], 100, 60), 0);
}

#[test]
fn weighted_curves_and_shapes_are_certified() {
    assert_eq!(pairs([1, 1], 60, 80), 0);
    assert_eq!(pairs([1, 2], 20, 20), 0);
}

#[test]
fn weighted_surfaces_are_right_or_said_not_to_be() {
    let stopped = pairs([2, 2], 10, 12);
    println!("{stopped} not certified");
}
