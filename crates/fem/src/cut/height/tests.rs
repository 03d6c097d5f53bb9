use super::*;
use signorini_geometry::ImplicitShape;
use std::f64::consts::PI;

/// A shape from a function with its gradient.
struct Function<F>(F);

impl<const D: usize, F: Fn(&Point<D>) -> (f64, Vector<D>) + Send + Sync> ImplicitShape<D> for Function<F> {
    fn value(&self, x: &Point<D>) -> f64 {
        (self.0)(x).0
    }
    fn gradient(&self, x: &Point<D>) -> Vector<D> {
        (self.0)(x).1
    }
}

fn ball<const D: usize>(center: Point<D>, radius: f64) -> impl ImplicitShape<D> {
    Function(move |x: &Point<D>| {
        let d = x - center;
        (d.norm_squared() - radius * radius, 2.0 * d)
    })
}

struct Measures {
    volume: f64,
    surface: f64,
    closed: f64,
    points: usize,
}

/// Measures of what holds for the signs of all sheets, on `n` cells in each direction of a cube.
fn measures<const D: usize>(
    sheets: &[&dyn ImplicitShape<D>],
    inside: &(dyn Fn(&[f64]) -> bool + Sync),
    half: f64,
    n: usize,
    order: usize,
) -> Measures {
    let mut out = Measures { volume: 0.0, surface: 0.0, closed: 0.0, points: 0 };
    let mut closed = Vector::<D>::zeros();
    let (mut total, h) = (0.0, 2.0 * half / n as f64);
    for mut i in 0..n.pow(D as u32) {
        let min = Point::<D>::from_fn(|_, _| {
            let at = i % n;
            i /= n;
            h * at as f64 - half
        });
        let b = Aabb::new(min, min + Vector::<D>::repeat(h));
        let partition = CellPartition {
            sheets: sheets.iter().map(|s| Box::new(*s) as Box<dyn ImplicitShape<D> + '_>).collect(),
            tags: vec![0; sheets.len()],
            features: Vec::new(),
            region: Box::new(|_, values| u32::from(inside(values))),
        };
        let rule = height_functions(&partition, &b, order);
        out.volume += rule.volume(1).iter().map(|p| p.weight).sum::<f64>();
        total += rule.volumes.iter().flat_map(|v| &v.1).map(|p| p.weight).sum::<f64>();
        out.surface += rule.surfaces.iter().map(|p| p.weight).sum::<f64>();
        for p in &rule.surfaces {
            let outward = if p.minus == 1 { p.normal } else { -p.normal };
            closed += p.weight * outward;
        }
        if rule.cut {
            out.points += rule.volumes.iter().map(|v| v.1.len()).sum::<usize>();
        }
    }
    assert!((total / (2.0 * half).powi(D as i32) - 1.0).abs() < 1e-13);
    out.closed = closed.norm();
    out
}

fn one<const D: usize>(shape: &dyn ImplicitShape<D>, n: usize, order: usize) -> Measures {
    measures(&[shape], &|v| v[0] < 0.0, 1.03, n, order)
}

#[test]
fn discs_and_balls_are_measured_to_twelve_digits() {
    let disc = one(&ball(Point::<2>::new(0.01, 0.02), 0.9), 10, 9);
    assert!((disc.volume - PI * 0.81).abs() < 1e-13 && (disc.surface - 1.8 * PI).abs() < 1e-12);
    let solid = one(&ball(Point::<3>::zeros(), 0.9), 8, 8);
    let (v, s) = (4.0 / 3.0 * PI * 0.729, 4.0 * PI * 0.81);
    assert!((solid.volume / v - 1.0).abs() < 1e-12, "{:e}", solid.volume / v - 1.0);
    assert!((solid.surface / s - 1.0).abs() < 1e-12, "{:e}", solid.surface / s - 1.0);
    assert!(solid.closed < 1e-12);
}

/// A Gauss point more in each direction gains a digit.
#[test]
fn errors_fall_with_the_order() {
    let errors: Vec<f64> =
        [3, 5].map(|q| (one(&ball(Point::<3>::zeros(), 0.9), 8, q).volume / 3.053628059289279 - 1.0).abs()).into();
    assert!(errors[0] < 6e-7 && errors[1] < 1.2e-9, "{errors:?}");
}

#[test]
fn tori_and_gyroids_are_closed() {
    let torus = Function(|x: &Point<3>| {
        let s = x.norm_squared() + 0.65f64.powi(2) - 0.25f64.powi(2);
        let r = 4.0 * 0.65f64.powi(2);
        let gradient = 4.0 * s * x - Vector::<3>::new(2.0 * r * x[0], 2.0 * r * x[1], 0.0);
        (s * s - r * (x[0] * x[0] + x[1] * x[1]), gradient)
    });
    let m = one(&torus, 8, 5);
    let (v, s) = (2.0 * PI * PI * 0.65 * 0.0625, 4.0 * PI * PI * 0.65 * 0.25);
    assert!((m.volume / v - 1.0).abs() < 6e-8, "{:e}", m.volume / v - 1.0);
    assert!((m.surface / s - 1.0).abs() < 1.2e-6 && m.closed < 1e-6, "{:e} {:e}", m.surface / s - 1.0, m.closed);
    let gyroid = Function(|x: &Point<3>| {
        let [(sx, cx), (sy, cy), (sz, cz)] = [x[0], x[1], x[2]].map(f64::sin_cos);
        (sx * cy + sy * cz + sz * cx, Vector::<3>::new(cx * cy - sz * sx, cy * cz - sx * sy, cz * cx - sy * sz))
    });
    // Half of a period is inside; the faces of the period cancel.
    let m = measures(&[&gyroid as &dyn ImplicitShape<3>], &|v| v[0] < 0.0, PI, 6, 5);
    assert!((m.volume / (4.0 * PI.powi(3)) - 1.0).abs() < 1e-6 && m.closed < 1e-5, "{} {:e}", m.volume, m.closed);
}

#[test]
fn edges_between_two_surfaces_cost_no_order() {
    // A lens of two balls: two caps of height 0.5 of balls of radius 0.8.
    let a = ball(Point::<3>::new(0.3, 0.0, 0.0), 0.8);
    let b = ball(Point::<3>::new(-0.3, 0.0, 0.0), 0.8);
    let m = measures(&[&a, &b], &|v| v[0] < 0.0 && v[1] < 0.0, 1.03, 4, 6);
    let v = 2.0 * PI * 0.25 / 3.0 * (2.4 - 0.5);
    let s = 2.0 * 2.0 * PI * 0.8 * 0.5;
    assert!((m.volume / v - 1.0).abs() < 1e-7, "{:e}", m.volume / v - 1.0);
    assert!((m.surface / s - 1.0).abs() < 1e-6 && m.closed < 1e-6, "{:e} {:e}", m.surface / s - 1.0, m.closed);
    // A square turned by some angle is exact.
    let sides: Vec<_> = (0..4)
        .map(|i| {
            let (sin, cos) = (0.3 + 0.5 * PI * f64::from(i)).sin_cos();
            Function(move |x: &Point<2>| (cos * x[0] + sin * x[1] - 0.6, Vector::<2>::new(cos, sin)))
        })
        .collect();
    let sheets: Vec<&dyn ImplicitShape<2>> = sides.iter().map(|s| s as &dyn ImplicitShape<2>).collect();
    let m = measures(&sheets, &|v| v.iter().all(|v| *v < 0.0), 1.03, 5, 2);
    assert!((m.volume - 1.44).abs() < 1e-13 && (m.surface - 4.8).abs() < 1e-12);
}

#[test]
fn no_ball_is_lost_however_small_and_wherever_it_lies() {
    let mut seed = 12345u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 11) as f64 / (1u64 << 53) as f64
    };
    for i in 0..24 {
        let radius = 0.05 + 0.6 * random().powi(2);
        let center = Point::<3>::from_fn(|_, _| (1.0 - radius) * (2.0 * random() - 1.0));
        let m = one(&ball(center, radius), 3 + i % 2, 4);
        let s = 4.0 * PI * radius * radius;
        assert!((m.surface / s - 1.0).abs() < 2e-3, "{radius} at {center}: {:e}", m.surface / s - 1.0);
    }
}

#[test]
fn sub_cells_are_right_to_the_sagitta_and_closed() {
    use crate::cut::{space_tree, sub_cells};
    fn sums<const D: usize>(n: usize) -> [f64; 4] {
        let shape = ball(Point::<D>::zeros(), 0.7);
        let partition = CellPartition {
            sheets: vec![Box::new(&shape)],
            tags: vec![0],
            features: Vec::new(),
            region: Box::new(|_, v: &[f64]| u32::from(v[0] < 0.0)),
        };
        let b = Aabb::new(Point::<D>::repeat(-1.0), Point::<D>::repeat(1.0));
        let rule = sub_cells(&partition, &b, n, 3, 1);
        let total: f64 = rule.volumes.iter().flat_map(|v| &v.1).map(|p| p.weight).sum();
        assert!((total - 2f64.powi(D as i32)).abs() < 1e-11, "{:e}", total - 2f64.powi(D as i32));
        let sum = |points: &[QuadraturePoint<D>]| points.iter().map(|p| p.weight).sum::<f64>();
        let closed: Vector<D> = rule.surfaces.iter().map(|p| p.weight * p.normal).sum();
        assert!(closed.norm() < 1e-11, "{:e}", closed.norm());
        let flux: f64 = rule.surfaces.iter().map(|p| p.weight * p.normal.dot(&p.x)).sum();
        let area = rule.surfaces.iter().map(|p| p.weight).sum();
        [sum(rule.volume(1)), area, flux / D as f64, sum(space_tree(&partition, &b, 4, 3).volume(1))]
    }
    let exact = [[0.49 * PI, 1.4 * PI], [4.0 / 3.0 * PI * 0.343, 4.0 * PI * 0.49]];
    let mut errors = [[[0.0; 2]; 2]; 2];
    for (i, n) in [10, 20].into_iter().enumerate() {
        for (j, [volume, area, flux, tree]) in [sums::<2>(n), sums::<3>(n)].into_iter().enumerate() {
            // The flux of the position through the chords is the volume that they hold.
            assert!((flux - volume).abs() < 1e-11, "{:e}", flux - volume);
            assert!((tree / exact[j][0] - 1.0).abs() < 1e-2);
            errors[i][j] = [volume / exact[j][0] - 1.0, area / exact[j][1] - 1.0];
        }
    }
    for (coarse, fine) in errors[0].iter().flatten().zip(errors[1].iter().flatten()) {
        assert!(fine.abs() < 1e-2 && (3.0..5.5).contains(&(coarse / fine)), "{errors:?}");
    }
}
