//! Implicit bodies against distances that are known.

use signorini_geometry::closest::FeatureKind;
use signorini_geometry::grid_spline::GridSpline;
use signorini_geometry::implicit::{Function, ImplicitBody, ImplicitShape, Offset};
use signorini_geometry::implicit_surface::ImplicitSurface;
use signorini_geometry::jet::Jet;
use signorini_geometry::{Aabb, Matrix, Point, Vector};

/// `Σ ((x - c)/a)² - 1`, which is no distance.
fn ellipsoid(c: Point<3>, a: [f64; 3]) -> ImplicitBody<3> {
    ImplicitBody::shape(Function(move |x: &Point<3>| {
        let d = x - c;
        let w = Vector::<3>::new(a[0].powi(-2), a[1].powi(-2), a[2].powi(-2));
        Jet {
            value: d.component_mul(&d).dot(&w) - 1.0,
            gradient: d.component_mul(&w) * 2.0,
            hessian: Matrix::<3>::from_diagonal(&(w * 2.0)),
        }
    }))
}

fn surface(body: ImplicitBody<3>) -> ImplicitSurface {
    ImplicitSurface::new(body, Aabb::new(Point::<3>::repeat(-2.5), Point::<3>::repeat(2.5)), 40).unwrap()
}

fn points() -> impl Iterator<Item = Point<3>> {
    (0..60).map(|k| {
        let t = f64::from(k);
        Point::<3>::new((1.3 * t).sin() * 2.0, (0.7 * t + 1.0).cos() * 2.0, (2.1 * t + 0.5).sin() * 2.0)
    })
}

/// Gradient and Hessian of the gap against central differences of the gap and of the gradient.
fn check_variation(s: &ImplicitSurface, x: &Point<3>) {
    let foot = s.closest(x);
    let h = 1e-5;
    for k in 0..3 {
        let e = Vector::<3>::ith(k, h);
        let (p, q) = (s.closest(&(x + e)), s.closest(&(x - e)));
        let slope = (p.gap - q.gap) / (2.0 * h);
        assert!((slope - foot.normal[k]).abs() < 1e-8, "gradient at {x:?}: {slope} {}", foot.normal[k]);
        let bend = (p.normal - q.normal) / (2.0 * h);
        assert!((bend - foot.hessian.column(k)).norm() < 1e-6, "Hessian at {x:?}: {bend:?} {:?}", foot.hessian);
    }
}

#[test]
fn the_gap_of_a_sphere_is_its_distance() {
    let s = surface(ellipsoid(Point::<3>::zeros(), [1.5; 3]));
    for x in points() {
        let foot = s.closest(&x);
        assert!((foot.gap - (x.norm() - 1.5)).abs() < 1e-13, "{}", foot.gap - x.norm() + 1.5);
        let exact = (Matrix::<3>::identity() - foot.normal * foot.normal.transpose()) / x.norm();
        assert!((foot.hessian - exact).norm() < 1e-10);
    }
    let on = s.closest(&Point::<3>::new(0.9, 1.2, 0.0));
    assert!(on.gap.abs() < 1e-14 && (on.hessian.norm() - 2f64.sqrt() / 1.5).abs() < 1e-10);
}

#[test]
fn feet_on_an_ellipsoid_are_normal_and_the_gap_varies_as_it_says() {
    let s = surface(ellipsoid(Point::<3>::zeros(), [2.0, 1.5, 1.0]));
    for x in points().filter(|x| x.norm() > 1.2) {
        let foot = s.closest(&x);
        assert!((x - foot.point - foot.normal * foot.gap).norm() < 1e-12);
        check_variation(&s, &x);
    }
}

#[test]
fn unions_intersections_differences_and_offsets_have_faces_edges_and_vertices() {
    let at = |x: f64| ellipsoid(Point::<3>::new(x, 0.0, 0.0), [1.0; 3]);
    // A lens: two unit spheres half a radius from the middle meet in a circle of radius √3/2.
    let lens = surface(ImplicitBody::Intersection(vec![at(0.5), at(-0.5)]));
    let x = Point::<3>::new(0.0, 2.0, 0.0);
    let foot = lens.closest(&x);
    assert_eq!(foot.feature, FeatureKind::Edge);
    assert!((foot.gap - (2.0 - 0.75f64.sqrt())).abs() < 1e-12);
    check_variation(&lens, &Point::<3>::new(0.1, 1.5, 0.3));
    let face = lens.closest(&Point::<3>::new(1.5, 0.1, 0.0));
    assert!(face.feature == FeatureKind::Interior && (face.gap - ((2.0f64 * 2.0 + 0.01).sqrt() - 1.0)).abs() < 1e-12);
    // Inside a union the circle where the spheres meet is a re-entrant edge: it is the closest point from inside.
    let union = surface(ImplicitBody::Union(vec![at(0.5), at(-0.5)]));
    let inner = union.closest(&Point::<3>::new(0.0, 0.6, 0.0));
    assert_eq!(inner.feature, FeatureKind::Edge);
    assert!((inner.gap + 0.75f64.sqrt() - 0.6).abs() < 1e-12, "{}", inner.gap);
    // A sphere less another: the bitten face belongs to the second.
    let bite = surface(at(0.5).without(at(-0.5)));
    let bitten = bite.closest(&Point::<3>::new(0.2, 0.1, 0.0));
    assert!((bitten.gap - (1.0 - (0.49f64 + 0.01).sqrt())).abs() < 1e-12, "{}", bitten.gap);
    // Offsets add to the distance.
    let ball = surface(at(0.0));
    let grown = surface(Offset { shape: std::sync::Arc::new(ball), distance: 0.25 }.into());
    let foot = grown.closest(&Point::<3>::new(1.0, 1.0, 1.0));
    assert!((foot.gap - (3f64.sqrt() - 1.25)).abs() < 1e-11, "{}", foot.gap);
}

#[test]
fn sampled_fields_converge_with_fourth_order() {
    let exact = |x: &Point<3>| (x.x * 0.9).sin() + (x.y * 0.7).cos() * x.z;
    let error = |n: usize| {
        let h = 4.0 / (n - 1) as f64;
        let mut values = Vec::new();
        for i in 0..n {
            for j in 0..n {
                for k in 0..n {
                    values.push(exact(&Point::<3>::new(-2.0 + h * i as f64, -2.0 + h * j as f64, -2.0 + h * k as f64)));
                }
            }
        }
        let field = GridSpline::new(Point::<3>::repeat(-2.0), [h; 3], [n; 3], values).unwrap();
        let step = 1e-5;
        let x = Point::<3>::new(0.123, -0.234, 0.345);
        let jet = field.jet(&x);
        for k in 0..3 {
            let e = Vector::<3>::ith(k, step);
            let slope = (field.value(&(x + e)) - field.value(&(x - e))) / (2.0 * step);
            assert!((slope - jet.gradient[k]).abs() < 1e-8);
            let bend = (field.jet(&(x + e)).gradient - field.jet(&(x - e)).gradient) / (2.0 * step);
            assert!((bend - jet.hessian.column(k)).norm() < 1e-6);
        }
        (0..50)
            .map(|k| Point::<3>::new((1.1 * f64::from(k)).sin() * 0.8, (0.4 * f64::from(k)).cos() * 0.8, 0.3))
            .map(|x| (field.value(&x) - exact(&x)).abs())
            .fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(17), error(33));
    assert!((coarse / fine).log2() > 3.7, "{coarse:e} {fine:e}");
    assert!(GridSpline::new(Point::<3>::zeros(), [1.0; 3], [3; 3], vec![0.0; 27]).is_err());
    assert!(GridSpline::new(Point::<3>::zeros(), [1.0; 3], [4; 3], vec![0.0; 27]).is_err());
}

/// Bounds hold all values in boxes within an interval, across several and at the ends, and tell most boxes without zeros
/// from those with them; lines are what the function is on them.
#[test]
fn bounds_and_lines_of_sampled_fields_are_those_of_their_values() {
    let mut seed = 7u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    let (count, h) = ([5, 7, 6], Point::<3>::new(0.5, 0.3, 0.4));
    let values = (0..count.iter().product()).map(|_| random() - 0.5).collect();
    let field = GridSpline::new(Point::<3>::zeros(), h.into(), count, values).unwrap();
    let size = Point::<3>::from_fn(|k, _| h[k] * (count[k] - 1) as f64);
    let (mut without, mut told) = (0, 0);
    for i in 0..400 {
        // Sizes in intervals; every fourth box has no extent in one direction.
        let share = [0.1, 0.3, 1.0, 2.3][i % 4];
        let extent = Point::<3>::from_fn(|k, _| if i / 4 % 4 == k { 0.0 } else { share * h[k] });
        let min = Point::<3>::from_fn(|k, _| (1.2 * random() - 0.1).clamp(0.0, 1.0) * (size[k] - extent[k]));
        let b = Aabb::new(min, min + extent);
        let [low, high] = field.range(&b.min, &b.max);
        let samples = (0..343).map(|j| b.at(&Point::<3>::from_fn(|k, _| f64::from(j / [1, 7, 49][k] % 7) / 6.0)));
        let [least, most] =
            (samples.map(|x| field.value(&x))).fold([f64::MAX, f64::MIN], |[l, m], v| [l.min(v), m.max(v)]);
        assert!(low <= least + 1e-13 && most <= high + 1e-13, "{low} {least} {most} {high}");
        if share < 0.5 && (least > 0.0 || most < 0.0) {
            without += 1;
            told += usize::from(low > 0.0 || high < 0.0);
        }
        for axis in 0..3 {
            field.on_line(&b.min, axis, [b.min[axis], b.max[axis]], &mut |f| {
                for t in [0.0, 0.37, 0.5, 1.0] {
                    let mut x = b.min;
                    x[axis] += t * extent[axis];
                    let (value, gradient) = field.value_and_gradient(&x);
                    let (on_line, slope) = f(x[axis]);
                    assert!((on_line - value).abs() < 1e-13 && (slope - gradient[axis]).abs() < 1e-12);
                }
            });
        }
    }
    assert!(without > 100 && 10 * told > 9 * without, "{told} of {without}");
}

#[test]
fn bad_boxes_are_refused() {
    let unit = || ellipsoid(Point::<3>::zeros(), [1.0; 3]);
    let far = Aabb::new(Point::<3>::repeat(5.0), Point::<3>::repeat(6.0));
    assert!(ImplicitSurface::new(unit(), far, 10).is_err());
    let thin = Aabb::new(Point::<3>::zeros(), Point::<3>::new(1.0, 0.0, 1.0));
    assert!(ImplicitSurface::new(unit(), thin, 10).is_err());
    let nan = ImplicitBody::shape(Function(|_: &Point<3>| Jet {
        value: f64::NAN,
        gradient: Vector::<3>::zeros(),
        hessian: Matrix::<3>::zeros(),
    }));
    let unit_box = Aabb::new(Point::<3>::zeros(), Point::<3>::repeat(1.0));
    assert!(ImplicitSurface::new(nan, unit_box, 10).err().unwrap().to_string().contains("NaN"));
}
