//! Filament winding against closed forms and an independent integration of its equations.

use serde_json::Value;
use signorini_geometry::rigid_shape::{Cone, Cylinder, Ellipsoid, Profile, Revolution, RigidShape, Sphere, Torus};
use signorini_geometry::{Jet, Point, Vector};
use signorini_paths::PathError;
use signorini_paths::winding::{
    At, Axis, Ended, Mandrel, Slippage, Start, Until, WindingPath, circuit, coverage, patterns, slippage_for_opening,
    wind,
};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;

fn mandrel(surface: &dyn RigidShape) -> Mandrel<'_> {
    Mandrel { surface, axis: Axis { origin: Point::<3>::zeros(), direction: Vector::<3>::z() } }
}

fn start(x: [f64; 3], angle: f64) -> Start {
    Start { point: Point::<3>::from(x), angle }
}

fn lay(surface: &dyn RigidShape, from: Start, lambda: f64, until: Until, longest: f64) -> WindingPath {
    wind(&mandrel(surface), &from, &Slippage::Constant(lambda), until, longest, longest / 50.0).unwrap()
}

/// The equations of winding on `r = R cos t`, `z = b sin t`, by small steps of order four: angle, radius, length and turn
/// where the yarn is along a parallel.
fn dome_turn(r: f64, b: f64, lambda: f64, alpha: f64) -> [f64; 3] {
    let rate = |y: [f64; 3]| {
        let (sin_t, cos_t) = y[0].sin_cos();
        let m = (r * r * sin_t * sin_t + b * b * cos_t * cos_t).sqrt();
        let (k_m, k_p) = (r * b / m.powi(3), b / (r * m));
        let (sin, cos) = y[2].sin_cos();
        let rho = r * cos_t;
        let slope = -r * sin_t / m;
        [cos / m, sin / rho, lambda * (k_m * cos * cos + k_p * sin * sin) - slope * sin / rho]
    };
    let advance = |y: [f64; 3], h: f64| {
        let add = |y: [f64; 3], k: [f64; 3], h: f64| [0, 1, 2].map(|i| y[i] + h * k[i]);
        let k1 = rate(y);
        let k2 = rate(add(y, k1, 0.5 * h));
        let k3 = rate(add(y, k2, 0.5 * h));
        let k4 = rate(add(y, k3, h));
        [0, 1, 2].map(|i| y[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
    };
    let (mut y, mut s, h) = ([0.0, 0.0, alpha], 0.0, 0.005);
    loop {
        let next = advance(y, h);
        if next[2] >= FRAC_PI_2 {
            let (mut low, mut high) = (0.0, h);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if advance(y, middle)[2] < FRAC_PI_2 { low = middle } else { high = middle }
            }
            let end = advance(y, low);
            return [r * end[0].cos(), s + low, end[1]];
        }
        (y, s) = (next, s + h);
    }
}

#[test]
fn all_published_rows() {
    let data: Value = serde_json::from_str(include_str!("../data/ropes.json")).unwrap();
    let close = |a: f64, b: f64, what: &str| assert!((a - b).abs() < 1e-10 * b.abs().max(1.0), "{what}: {a} {b}");
    for row in data["filament_winding"]["rows"].as_array().unwrap() {
        let value = |key: &str| row[key].as_f64().unwrap_or_else(|| panic!("{key} in {row}"));
        let (name, lam) = (row["mandrel"].as_str().unwrap(), value("lam"));
        match name.split(' ').next().unwrap() {
            "cylinder" => {
                let shape = Cylinder { point: Point::<3>::zeros(), axis: Vector::<3>::z(), radius: value("R") };
                let path =
                    lay(&shape, start([50.0, 0.0, 0.0], value("alpha0")), lam, Until::Angle(value("alpha1")), 2000.0);
                let end = path.end();
                close(end.height, value("axial_length"), name);
                close(end.theta, value("theta"), name);
                close(end.frame.s, value("yarn_length"), name);
            }
            "cone" => {
                let half_angle = value("half_angle");
                let shape = Cone { apex: Point::<3>::zeros(), axis: Vector::<3>::z(), half_angle };
                let rho = value("rho0");
                let from = start([rho, 0.0, rho / half_angle.tan()], value("alpha0"));
                let path = lay(&shape, from, lam, Until::Length, value("length"));
                close(path.end().angle, value("alpha_end"), name);
                close(path.end().radius, value("rho_end"), name);
                close(path.end().theta, value("theta_end"), name);
            }
            "sphere" => {
                let shape = Sphere { center: Point::<3>::zeros(), radius: value("R") };
                let path = lay(&shape, start([10.0, 0.0, 0.0], 0.4), lam, Until::Length, 30.0);
                let [a, b, c] = [0, 20, 35].map(|k| path.points[k].frame.x);
                let n = (b - a).cross(&(c - a)).normalize();
                for p in &path.points {
                    close(n.dot(&p.frame.x).abs(), value("plane_distance"), name);
                }
            }
            "ellipsoidal" => {
                let (r, b) = (value("R"), value("b"));
                let shape = Ellipsoid::new(Point::<3>::zeros(), [r, r, b]).unwrap();
                let profile =
                    Profile::formula(move |t: Jet<1>| [t.cos() * r, t.sin() * b], [-FRAC_PI_2, FRAC_PI_2], 12);
                let turned =
                    Revolution { origin: Point::<3>::zeros(), axis: Vector::<3>::z(), profile: profile.unwrap() };
                for shape in [&shape as &dyn RigidShape, &turned] {
                    let path = lay(shape, start([r, 0.0, 0.0], value("alpha0")), lam, Until::Turn, 500.0);
                    assert_eq!(path.ended, Ended::AsAsked);
                    close(path.end().radius, value("polar_opening_radius"), name);
                    close(path.end().frame.s, value("yarn_length_to_turn"), name);
                    close(path.end().theta, value("theta_to_turn"), name);
                }
            }
            other => panic!("{other}"),
        }
    }
}

#[test]
fn domes_beside_the_published_ones() {
    let (r, b, alpha) = (40.0, 25.0, 30f64.to_radians());
    let shape = Ellipsoid::new(Point::<3>::zeros(), [r, r, b]).unwrap();
    for lambda in [0.15, -0.15] {
        let [radius, length, theta] = dome_turn(r, b, lambda, alpha);
        let path = lay(&shape, start([r, 0.0, 0.0], alpha), lambda, Until::Turn, 500.0);
        let end = path.end();
        assert!((end.radius - radius).abs() < 1e-8, "{} {radius}", end.radius);
        assert!((end.frame.s - length).abs() < 1e-8 && (end.theta - theta).abs() < 1e-9, "{end:?} {length} {theta}");
        // And back: the opening tells the slippage.
        let mandrel = mandrel(&shape);
        let found =
            slippage_for_opening(&mandrel, &start([r, 0.0, 0.0], alpha), end.radius, [-0.3, 0.3], 500.0).unwrap();
        assert!((found.slippage - lambda).abs() < 1e-9, "{found:?}");
        let none = slippage_for_opening(&mandrel, &start([r, 0.0, 0.0], alpha), 39.9, [-0.3, 0.3], 500.0);
        assert!(matches!(none, Err(PathError::NoSlippage { .. })));
    }
}

#[test]
fn invariants_of_cone_and_torus() {
    let (half_angle, lambda) = (20f64.to_radians(), 0.2);
    let cone = Cone { apex: Point::<3>::zeros(), axis: Vector::<3>::z(), half_angle };
    let path = lay(&cone, start([20.0, 0.0, 20.0 / half_angle.tan()], 0.7), lambda, Until::Length, 60.0);
    let invariant = |p: &signorini_paths::winding::WindingPoint| {
        p.radius * p.angle.sin() / (1.0 - lambda / half_angle.tan() * p.angle.sin())
    };
    let first = invariant(path.start());
    assert!(path.points.iter().all(|p| (invariant(p) / first - 1.0).abs() < 1e-11));
    let torus = Torus { center: Point::<3>::zeros(), axis: Vector::<3>::z(), major: 3.0, minor: 1.0 };
    let path = lay(&torus, start([4.0, 0.0, 0.0], 48f64.to_radians()), 0.0, Until::Length, 12.0);
    let first = path.start().radius * path.start().angle.sin();
    assert!(path.points.iter().all(|p| (p.radius * p.angle.sin() - first).abs() < 1e-11));
    // On the inner side the yarn bridges: the ends of the bridges are where k_n changes its sign.
    assert!(!path.bridges.is_empty(), "{:?}", path.bridges);
    for p in &path.points {
        let bridged = path.bridges.iter().any(|b| b[0] <= p.frame.s && p.frame.s <= b[1]);
        assert!(p.frame.k_n.abs() < 1e-9 || bridged == (p.frame.k_n > 0.0), "{p:?} {:?}", path.bridges);
    }
    let map = mandrel(&torus)
        .stability_map(&[path.start().frame.x, Point::<3>::new(2.0, 0.0, 0.0)], &[0.0, FRAC_PI_2])
        .unwrap();
    let expected = [[-1.0, -0.25], [-1.0, 0.5]];
    assert!((0..2).all(|i| (0..2).all(|j| (map[i][j] - expected[i][j]).abs() < 1e-12)), "{map:?}");
}

/// A constant slippage through the turn is the mirror image of itself; a variable one is followed.
#[test]
fn turns_and_variable_slippage() {
    let shape = Ellipsoid::new(Point::<3>::zeros(), [50.0, 50.0, 30.0]).unwrap();
    let from = start([50.0, 0.0, 0.0], 25f64.to_radians());
    let turn = *lay(&shape, from, 0.1, Until::Turn, 500.0).end();
    let way = signorini_paths::winding::Way::Down;
    let there = lay(&shape, from, 0.1, Until::Height { height: 0.0, way }, 500.0);
    let back = there.end();
    assert!(
        (back.angle - (PI - from.angle)).abs() < 1e-10 && (back.theta - 2.0 * turn.theta).abs() < 1e-10,
        "{back:?}"
    );
    assert!((back.frame.s - 2.0 * turn.frame.s).abs() < 1e-9 && there.turns.len() == 1);
    let grow = |at: &At| 0.002 * at.s;
    let slippage = Slippage::Variable(Arc::new(grow));
    let path = wind(&mandrel(&shape), &from, &slippage, Until::Turn, 500.0, 1.0).unwrap();
    let (largest, s) = path.largest_slippage();
    assert!((largest - 0.002 * s).abs() < 1e-15 && (s - path.end().frame.s).abs() < 1e-12);
    let slips = path.slipping(0.05);
    assert!((slips[0][0] - 25.0).abs() < 1e-9 && (slips[0][1] - s).abs() < 1e-9, "{slips:?}");
    for p in &path.points {
        assert!((p.frame.k_g + p.slippage * p.frame.k_n).abs() < 1e-15 && p.frame.gap.abs() < 1e-11, "{p:?}");
    }
}

/// A cylinder between two domes.
fn vessel(r: f64, b: f64, length: f64) -> Revolution {
    let formula = move |t: Jet<1>| {
        // The parameter is the angle on the domes, and goes on as a length over the radius between them.
        let half = 0.5 * length;
        let shift = half / r;
        if t.value > shift {
            let a = t - shift;
            [a.cos() * r, a.sin() * b + half]
        } else if t.value < -shift {
            let a = t + shift;
            [a.cos() * r, a.sin() * b - half]
        } else {
            [t * 0.0 + r, t * r]
        }
    };
    let end = 0.5 * length / r + FRAC_PI_2;
    let profile = Profile::formula(formula, [-end, end], 48).unwrap();
    Revolution { origin: Point::<3>::zeros(), axis: Vector::<3>::z(), profile }
}

#[test]
fn a_circuit_and_its_pattern() {
    let (r, b, length, alpha, band) = (50.0, 30.0, 200.0, 25f64.to_radians(), 8.0);
    let shape = vessel(r, b, length);
    let none = [Slippage::Constant(0.0), Slippage::Constant(0.0)];
    let found = circuit(&mandrel(&shape), &start([r, 0.0, 0.0], alpha), &none, 2000.0, 10.0).unwrap();
    // Geodesic: two turns on domes, and two ways along the cylinder.
    let [radius, _, theta] = dome_turn(r, b, 0.0, alpha);
    let exact = 4.0 * theta + 2.0 * length * alpha.tan() / r;
    assert!((found.angle - exact).abs() < 1e-7, "{} {exact}", found.angle);
    assert!(found.mismatch.abs() < 1e-8 && found.turns.iter().all(|t| (t.radius - radius).abs() < 1e-6));
    let cover = coverage(band, alpha, r, found.angle, 41).unwrap();
    assert_eq!(cover.circuits, 36);
    let all = patterns(found.angle, cover.circuits..=cover.circuits + 5).unwrap();
    assert_eq!((all[0].n, all[0].k, all[0].m), (41, 18, 1));
    assert!((f64::from(all[0].n) * (found.angle + all[0].dwell) / TAU - 59.0).abs() < 1e-9);
    let closed = coverage(band, alpha, r, found.angle + all[0].dwell, 41).unwrap();
    assert!(closed.gap < 1e-12 && (closed.covered - 1.0).abs() < 1e-12, "{closed:?}");
    // With slippage of opposite signs on the two halves the circuit closes as well.
    let held = [Slippage::Constant(0.05), Slippage::Constant(-0.05)];
    let wide = circuit(&mandrel(&shape), &start([r, 0.0, 0.0], alpha), &held, 2000.0, 10.0).unwrap();
    assert!(wide.mismatch.abs() < 1e-7 && wide.turns[0].radius > radius + 1.0);
    assert!((wide.turns[0].radius - wide.turns[1].radius).abs() < 1e-6);
}
