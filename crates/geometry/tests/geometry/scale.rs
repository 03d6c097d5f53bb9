//! The same digits at every scale, as far as coordinates are allowed: all pairs of shapes, scaled by powers of two.

use signorini_geometry::Point;
use signorini_geometry::closest::{Certificate, ClosestPair, Query, closest, signed_gap};
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::shape::{Axes, Curve, Shape, Surface};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Which parameters are lengths, by name of the shape.
fn length_parameters(name: &str) -> [bool; 2] {
    match name {
        "parabola" => [true, false],
        "plane" => [true, true],
        "cylinder" | "cone" => [false, true],
        _ => [false, false],
    }
}

/// Shapes in general position, `unit` times as large.
fn shapes(unit: f64) -> Vec<(&'static str, Shape)> {
    let p = |x: f64, y: f64, z: f64| Point::<3>::new(x, y, z) * unit;
    let axes = |k: f64| {
        let turn = nalgebra::Rotation3::new(Point::<3>::new(0.3 + k, 0.7 * k, -0.4)).into_inner();
        let e = |i: usize| turn.column(i).into_owned();
        Axes::new(p(3.0 * (2.0 * k).cos(), 3.0 * (3.0 * k).sin(), 2.0 * (5.0 * k).cos()), e(0), e(1)).unwrap()
    };
    let net = |n: usize, k: f64| -> Vec<Vec<Point<3>>> {
        let a = axes(k);
        let at = |i: usize, j: usize| {
            let z = ((5 * i + 3 * j) % 7) as f64 / 7.0;
            a.origin + (a.ex * (i as f64 * 0.6) + a.ey * (j as f64 * 0.5) + a.ez * z) * unit
        };
        (0..n).map(|i| (0..n).map(|j| at(i, j)).collect()).collect()
    };
    let turn = [0.0, TAU];
    let latitudes = [-FRAC_PI_2, FRAC_PI_2];
    let line: Vec<Point<3>> = net(4, 0.1).into_iter().map(|row| row[1]).collect();
    let flat = net(4, 2.9).concat();
    let triangles: Vec<[u32; 3]> = (0..9)
        .flat_map(|k| {
            let a = (k / 3) * 4 + k % 3;
            [[a, a + 4, a + 5], [a, a + 5, a + 1]]
        })
        .collect();
    let weights = vec![vec![1.0, 3.0, 0.5, 2.0]; 4];
    let knots = [0.0, 0.0, 0.0, 1.0, 2.0, 2.0, 2.0];
    vec![
        ("point", Shape::Point(p(0.3, -0.4, 5.0))),
        ("segment", Curve::segment(line[0], line[3]).unwrap().into()),
        ("polyline", Curve::polyline(&net(4, 0.4)[2], false).unwrap().into()),
        ("circle", Curve::circle(axes(0.7), 0.8 * unit, turn, true).unwrap().into()),
        ("ellipse", Curve::ellipse(axes(1.0), 0.9 * unit, 0.4 * unit, turn, true).unwrap().into()),
        ("parabola", Curve::parabola(axes(1.3), 0.7 / unit, [-unit, unit]).unwrap().into()),
        ("helix", Curve::helix(axes(1.6), 0.5 * unit, 0.1 * unit, [0.0, 9.0]).unwrap().into()),
        ("NURBS curve", Curve::nurbs(2, &knots, &line, Some(&weights[0]), false).unwrap().into()),
        ("plane", Surface::plane(axes(1.9), [[-unit, unit], [0.0, unit]]).unwrap().into()),
        ("cylinder", Surface::cylinder(axes(2.2), 0.6 * unit, [turn, [-unit, unit]], true).unwrap().into()),
        ("cone", Surface::cone(axes(2.5), 0.6, 0.8, [turn, [0.0, unit]], true).unwrap().into()),
        ("sphere", Surface::sphere(axes(2.8), 0.7 * unit, [turn, latitudes], true).unwrap().into()),
        (
            "ellipsoid",
            Surface::ellipsoid(axes(3.1), [0.9, 0.6, 0.4].map(|a| a * unit), [turn, latitudes], true).unwrap().into(),
        ),
        ("torus", Surface::torus(axes(3.4), 0.9 * unit, 0.3 * unit, [turn, turn], [true, true]).unwrap().into()),
        ("triangle", Surface::tri3(&[line[0], line[1], net(4, 0.2)[3][0]]).unwrap().into()),
        ("Bezier", Surface::bezier(&net(4, 4.0), None).unwrap().into()),
        ("NURBS", Surface::nurbs([2, 2], [&knots, &knots], &net(4, 4.3), Some(&weights), [false; 2]).unwrap().into()),
        ("mesh", TriangleMesh::new(flat, &triangles).unwrap().into()),
    ]
}

/// All numbers of a pair, at scale one.
fn numbers(pair: &ClosestPair, unit: f64, names: [&str; 2]) -> Vec<f64> {
    let mut all = vec![pair.distance / unit, pair.lambda_min];
    for (foot, name) in [pair.a, pair.b].iter().zip(names) {
        all.extend((foot.point / unit).iter());
        let lengths = length_parameters(name);
        all.extend(foot.parameters().iter().zip(lengths).map(|(t, is_length)| if is_length { t / unit } else { *t }));
    }
    all
}

#[test]
fn digits_do_not_depend_on_the_scale() {
    let query = Query::default();
    let at_one = shapes(1.0);
    for exponent in [-460, -300, -130, -60, 60, 130, 300, 460] {
        let unit = 2f64.powi(exponent);
        let scaled = shapes(unit);
        for i in 0..scaled.len() {
            // Pairs of surfaces at every other scale: they cost most.
            for j in i..scaled.len() {
                let ((name_a, a), (name_b, b)) = (&scaled[i], &scaled[j]);
                if a.dimension() + b.dimension() == 4 && exponent % 100 == 0 {
                    continue;
                }
                let names = [*name_a, *name_b];
                let (one, other) = (closest(&at_one[i].1, &at_one[j].1, &query), closest(a, b, &query));
                let context = format!("{names:?} at 2^{exponent}: {one:?} and {other:?}");
                let bits =
                    |pair, unit| numbers(pair, unit, names).iter().map(|x: &f64| x.to_bits()).collect::<Vec<_>>();
                assert_eq!(bits(&one.closest, 1.0), bits(&other.closest, unit), "{context}");
                assert_eq!(one.closest.a.feature, other.closest.a.feature, "{context}");
                assert_eq!(one.closest.b.feature, other.closest.b.feature, "{context}");
                assert_eq!(
                    (one.uniqueness, one.effort, one.certificate),
                    (other.uniqueness, other.effort, other.certificate),
                    "{context}"
                );
                assert_eq!(one.certified_to, other.certified_to / unit, "{context}");
                assert_eq!(one.others.len(), other.others.len(), "{context}");
                let gaps = [(&one, &at_one[j].1, 1.0), (&other, b, unit)]
                    .map(|(p, s, u)| signed_gap(&p.closest, s).map(|g| g / u));
                assert_eq!(gaps[0], gaps[1], "{context}");
                assert!(i == j || one.certificate == Certificate::Complete, "{context}");
            }
        }
    }
}

#[test]
fn points_beyond_all_scales_of_a_shape_keep_their_distance() {
    for (name, shape) in shapes(1.0) {
        for exponent in [-460, 150, 460] {
            let p = Point::<3>::new(0.6, -0.48, 0.64) * 2f64.powi(exponent);
            let found = closest(&Shape::Point(p), &shape, &Query::default());
            let exact = if exponent < 0 {
                closest(&Shape::Point(Point::<3>::zeros()), &shape, &Query::default()).distance()
            } else {
                2f64.powi(exponent)
            };
            let error = (found.distance() - exact).abs().max(found.certified_to);
            assert!(error <= 1e-14 * exact, "{name}, 2^{exponent}: {found:?}");
        }
    }
}
