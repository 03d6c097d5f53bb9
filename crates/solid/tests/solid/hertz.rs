//! An elastic cylinder's end on a rigid plane, against a reference computed to five digits with another code (quadratic
//! elements, active sets, three grids): F = 52.13207 N/mm, a = 2.444551 mm, p0 = 13.575381 N/mm².

use signorini_fem::block::{block, graded};
use signorini_geometry::Point;
use signorini_solid::*;

const FORCE: f64 = 52.13207231412229;
const HALF_WIDTH: f64 = 2.4445512631736683;
const PRESSURE: f64 = 13.575381250701758;

struct Found {
    force: f64,
    half_width: f64,
    /// Of the ellipse fitted, and the largest of all nodes.
    pressure: f64,
    peak: f64,
    /// Largest deviation from the ellipse fitted, within eight tenths of the half width.
    ripple: f64,
    iterations: usize,
    unknowns: usize,
}

/// Cells of size `h` up to `even`, then growing.
fn axis(h: f64, even: f64, to: f64, growth: f64) -> Vec<f64> {
    let mut out = vec![0.0];
    out.extend(graded(0.0, even, (even / h).round() as usize, 1.0));
    let cells = (1..).find(|&m| h * growth * (growth.powi(m) - 1.0) / (growth - 1.0) >= to - even).unwrap();
    out.extend(graded(even, to, cells as usize, growth));
    out
}

/// `length` and `modulus` scale the units; `angle` turns everything.
fn solve(degree: usize, h: f64, growth: f64, length: f64, modulus: f64, angle: f64) -> Found {
    let axes = [axis(h, 3.75, 20.0, growth), axis(h, 1.25, 20.0, growth)];
    solve_on(&axes, degree, length, modulus, angle)
}

fn solve_on(axes: &[Vec<f64>; 2], degree: usize, length: f64, modulus: f64, angle: f64) -> Found {
    let (sin, cos) = angle.sin_cos();
    let turn = move |x: Point<2>| Point::<2>::new(cos * x[0] - sin * x[1], sin * x[0] + cos * x[1]);
    let mesh = block::<2>(axes, degree, |p| {
        let b = 100.0 - (1e4 - p[0] * p[0]).sqrt();
        turn(Point::<2>::new(p[0], b + (20.0 - b) * p[1] / 20.0) * length)
    });
    mesh.check().unwrap();
    let groups = mesh.groups().clone();
    let mut bodies = Bodies::new(Space::PlaneStrain);
    bodies.add("block", mesh, degree, Elastic { youngs_modulus: 1000.0 * modulus, poissons_ratio: 0.3 });
    let support =
        |name: &str, group: &str, kind| Support { name: name.into(), body: 0, group: groups[group].clone(), kind };
    let supports = vec![
        support("top", "top", SupportKind::Components(vec![true, true])),
        support("symmetry", "left", SupportKind::Normal),
    ];
    let slave = bodies.surface(0, groups["bottom"].sides.clone());
    let contact = Contact::new("touch", slave, Master::Rigid);
    let mut model = Model::new(bodies, supports, vec![contact]).unwrap();
    let up = turn(Point::<2>::new(0.0, 1.0));
    let now = Circumstances {
        displacement: &|s, _| if s == 0 { up * (-0.085 * length) } else { Point::<2>::zeros() },
        load: vec![0.0; model.bodies.unknowns()],
        rigid: vec![Some(Box::new(move |x: &Point<2>| signorini_contact::GapJet::flat(x.dot(&up), up)))],
        motion: vec![],
    };
    let state = model.solve(&now, &mut |_, _| true).unwrap();
    let c = &state.contacts[0];
    // The reaction of the support is the contact force but for its component across.
    assert!((c.force + state.support_forces[0]).dot(&up).abs() < 1e-10 * c.force.norm());
    let right = turn(Point::<2>::new(1.0, 0.0));
    let nodes: Vec<(f64, f64)> = c.nodes.iter().map(|n| (n.x.dot(&right) / length, n.pressure / modulus)).collect();
    let most = nodes.iter().map(|n| n.1).fold(0.0, f64::max);
    // p² over x² is a straight line.
    let fit: Vec<(f64, f64)> = nodes.iter().filter(|n| n.1 > 0.3 * most).map(|n| (n.0 * n.0, n.1 * n.1)).collect();
    let count = fit.len() as f64;
    let (mx, my) = (fit.iter().map(|p| p.0).sum::<f64>() / count, fit.iter().map(|p| p.1).sum::<f64>() / count);
    let slope =
        fit.iter().map(|p| (p.0 - mx) * (p.1 - my)).sum::<f64>() / fit.iter().map(|p| (p.0 - mx).powi(2)).sum::<f64>();
    let pressure = (my - slope * mx).sqrt();
    let half_width = pressure / (-slope).sqrt();
    let ripple = (nodes.iter().filter(|n| n.0 < 0.8 * HALF_WIDTH))
        .map(|n| (n.1 - PRESSURE * (1.0 - (n.0 / HALF_WIDTH).powi(2)).sqrt()).abs() / PRESSURE)
        .fold(0.0, f64::max);
    let force = 2.0 * c.force.dot(&up) / (length * modulus);
    Found { force, half_width, pressure, peak: most, ripple, iterations: state.iterations, unknowns: state.unknowns }
}

fn per_cent(found: f64, exact: f64) -> f64 {
    100.0 * (found / exact - 1.0)
}

#[test]
fn linear_cells() {
    for (h, growth, most) in [(0.5, 1.22, 530), (0.25, 1.22, 1144), (0.125, 1.22, 2640)] {
        let found = solve(1, h, growth, 1.0, 1.0, 0.0);
        let errors =
            [per_cent(found.force, FORCE), per_cent(found.half_width, HALF_WIDTH), per_cent(found.pressure, PRESSURE)];
        println!(
            "degree 1, h {h}: {} unknowns, F a p0 {errors:.4?} %, {} iterations",
            found.unknowns, found.iterations
        );
        assert!(found.unknowns <= most && found.iterations <= 7);
        if h <= 0.25 {
            assert!(errors.iter().all(|e| e.abs() < 0.25), "{errors:?}");
        }
    }
}

#[test]
fn quadratic_cells() {
    for (h, growth, most) in [(0.25, 1.25, 4412), (0.125, 1.22, 10310)] {
        let found = solve(2, h, growth, 1.0, 1.0, 0.0);
        let errors =
            [per_cent(found.force, FORCE), per_cent(found.half_width, HALF_WIDTH), per_cent(found.pressure, PRESSURE)];
        println!(
            "degree 2, h {h}: {} unknowns, F a p0 {errors:.4?} %, ripple {:.4} %, {} iterations",
            found.unknowns,
            100.0 * found.ripple,
            found.iterations
        );
        assert!(found.unknowns <= most && found.iterations <= 7);
        if h == 0.125 {
            assert!(errors[0].abs() < 0.01 && errors[1].abs() < 0.1 && errors[2].abs() < 0.01, "{errors:?}");
            assert!(found.ripple < 5e-4);
        }
    }
}

#[test]
fn cells_of_high_degree() {
    for (degree, h) in [(4, 1.25), (4, 0.625), (6, 1.25), (8, 1.25)] {
        let found = solve(degree, h, 1.5, 1.0, 1.0, 0.0);
        let errors =
            [per_cent(found.force, FORCE), per_cent(found.half_width, HALF_WIDTH), per_cent(found.pressure, PRESSURE)];
        println!(
            "degree {degree}, h {h}: {} unknowns, F a p0 {errors:.4?} %, {} iterations",
            found.unknowns, found.iterations
        );
        assert!(found.iterations <= 7 && errors[0].abs() < 0.1);
    }
}

/// A few cells of degree 8, with a border near the edge of contact, against quadratic ones: ten times less error for as
/// many unknowns. The reference is of degree 8 on a finer mesh.
#[test]
fn high_degree_takes_a_tenth_of_the_error() {
    let parts = |list: &[(f64, usize, f64)]| {
        let mut out = vec![0.0];
        for &(to, cells, growth) in list {
            let from = out[out.len() - 1];
            out.extend(graded(from, to, cells, growth));
        }
        out
    };
    let run = |degree, x: &[(f64, usize, f64)], y: &[(f64, usize, f64)]| {
        let found = solve_on(&[parts(x), parts(y)], degree, 1.0, 1.0, 0.0);
        println!("degree {degree}: {} unknowns, F {:.6}, peak {:.6}", found.unknowns, found.force, found.peak);
        found
    };
    let near = 2.4446;
    let exact = run(8, &[(near, 6, 1.0), (5.0, 3, 1.0), (20.0, 5, 2.0)], &[(2.0, 3, 1.0), (20.0, 7, 1.7)]);
    let high = run(8, &[(near, 2, 1.0), (5.0, 1, 1.0), (20.0, 2, 2.5)], &[(2.0, 1, 1.0), (20.0, 3, 2.2)]);
    let quadratic = run(2, &[(3.75, 15, 1.0), (20.0, 10, 1.3)], &[(1.25, 5, 1.0), (20.0, 10, 1.3)]);
    assert!(high.unknowns < quadratic.unknowns);
    for of in [|f: &Found| f.force, |f: &Found| f.peak] {
        let [a, b] = [&high, &quadratic].map(|f| (of(f) - of(&exact)).abs());
        assert!(10.0 * a < b, "{a} and {b}");
    }
}

/// The same digits in any units and in any direction.
#[test]
fn units_and_rotations_change_nothing() {
    for degree in [1, 2] {
        let plain = solve(degree, 0.5, 1.3, 1.0, 1.0, 0.0);
        for (length, modulus, angle) in [(1e-6, 1e6, 0.0), (1e6, 1e-9, 0.0), (1e-3, 1e6, 0.7), (1.0, 1.0, 2.9)] {
            let other = solve(degree, 0.5, 1.3, length, modulus, angle);
            assert_eq!(plain.iterations, other.iterations);
            for (a, b) in
                [(plain.force, other.force), (plain.half_width, other.half_width), (plain.pressure, other.pressure)]
            {
                assert!((a / b - 1.0).abs() < 1e-9, "{a} and {b} for {length}, {modulus}, {angle}");
            }
        }
    }
}
