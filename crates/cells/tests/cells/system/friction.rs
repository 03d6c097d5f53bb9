//! Friction of cells by Nitsche's method: Cattaneo and Mindlin, ripple of pressure and friction, sticking that lasts.

use super::masters::{PENALTY, contact};
use super::*;
use signorini_cells::shapes::ball;
use signorini_contact::Coulomb;

const MU: f64 = 0.4;

/// A half of a disc of radius 1 that touches the origin, divided there.
fn half(name: &str, up: f64) -> CellSolid<2> {
    let b = if up > 0.0 { aabb([-1.0, 0.0], [1.0, 1.0]) } else { aabb([-1.0, -1.0], [1.0, 0.0]) };
    let mut tree = CellTree::new(b, [8, 4]).unwrap();
    for reach in [0.3, 0.25] {
        tree.refine(|leaf| leaf.bounds.clamp(&Point::<2>::zeros()).norm() < reach).unwrap();
    }
    let middle = if up > 0.0 { Place::high(1) } else { Place::low(1) };
    let skin = Place::boundary(move |p| p.normal[1] * up < -0.8);
    let shape = Domain::shape(ball(Point::<2>::new(0.0, up), 1.0));
    let body = cells(shape, tree, 3, Space::PlaneStrain).unwrap();
    CellSolid::new(name, body, &named(vec![("middle", middle), ("skin", skin)])).unwrap()
}

/// Alike discs, the upper one pressed down until `t = 1`, moved aside until `t = 2`.
fn pressed_and_shifted(how: Enforcement) -> System {
    let (upper, lower) = (half("upper", 1.0), half("lower", -1.0));
    let mut contact = contact(("skin", &upper), ("skin", &lower), Sampling::GaussPoints, how);
    contact.law.friction = Some(Box::new(Coulomb::isotropic(MU).unwrap()));
    let mut top = support(0, "middle", [None, None, None]);
    top.displacement[0] = Some(Arc::new(|_, t| 0.02 * (t - 1.0f64).clamp(0.0, 1.0)));
    top.displacement[1] = Some(Arc::new(|_, t| -0.06 * t.min(1.0)));
    System {
        supports: vec![top, support(1, "middle", [constant(0.0), constant(0.0), None])],
        bodies: vec![Box::new(upper), Box::new(lower)],
        contacts: vec![Box::new(contact)],
        ..System::default()
    }
}

/// The states at these times, and what was found in the last.
fn through(system: &mut System, times: &[f64]) -> (SystemState, IncrementResult) {
    system.prepare().unwrap();
    let (mut state, mut found, mut iterations) = (system.start(), IncrementResult::default(), Vec::new());
    for t in times {
        (state, found) = system.solve(&state, *t, &mut |_, _| true).unwrap();
        system.accept(&state).unwrap();
        iterations.push(found.iterations);
    }
    println!("{iterations:?} iterations");
    (state, found)
}

/// The part of values at sites that a polynomial of degree 6 leaves.
fn ripple(sites: &[(f64, f64, f64)]) -> f64 {
    let powers = nalgebra::DMatrix::from_fn(sites.len(), 7, |k, j| sites[k].1.sqrt() * sites[k].0.powi(j as i32));
    let values = nalgebra::DVector::from_fn(sites.len(), |k, _| sites[k].1.sqrt() * sites[k].2);
    let fit = powers.clone().svd(true, true).solve(&values, 1e-14).unwrap();
    (powers * fit - &values).norm() / values.norm()
}

/// Half widths, peaks and tractions by Hertz, and by Cattaneo and Mindlin: by penalties both pressure and friction ripple, by
/// the stress of the cells neither does.
#[test]
fn neither_pressure_nor_friction_ripples() {
    let found = [Enforcement::Nitsche, PENALTY].map(|how| {
        let (_, found) = through(&mut pressed_and_shifted(how), &[0.5, 1.0, 1.5, 2.0]);
        let sites = &found.sites[0];
        let force: Vector<3> = sites.iter().map(SiteResult::force).sum();
        let held = [0, 1].map(|k| found.support_forces[k][0]);
        // Friction is counted along the master at the foot, which is a gap away.
        assert!((held[0] + held[1]).norm() < 1e-10 * force.norm() && (held[0] + force).norm() < 1e-6 * force.norm());
        let (p, q) = (force[1].abs(), force[0].abs());
        // 1/E* = 2 (1 - ν²)/E, 1/R = 2.
        let modulus = 0.5 / (1.0 - 0.09);
        let a = (2.0 * p / (std::f64::consts::PI * modulus)).sqrt();
        let peak = 2.0 * p / (std::f64::consts::PI * a);
        let c = (1.0 - q / (MU * p)).sqrt();
        let middle: f64 = sites.iter().map(|s| s.weight * s.pressure * s.x[0]).sum::<f64>() / p;
        let at = |s: &SiteResult| (s.x[0] - middle) / a;
        let root = |s: f64| (1.0 - s * s).max(0.0).sqrt();
        let off = |value: &dyn Fn(&SiteResult) -> f64, wanted: &dyn Fn(f64) -> f64| {
            let sum = |f: &dyn Fn(&SiteResult) -> f64| sites.iter().map(|s| s.weight * f(s).powi(2)).sum::<f64>();
            (sum(&|s| value(s) - wanted(at(s))) / sum(&|s| wanted(at(s)))).sqrt()
        };
        let along = |s: &SiteResult| s.friction[0] * force[0].signum();
        let errors =
            [off(&|s| s.pressure, &|s| peak * root(s)), off(&along, &|s| MU * peak * (root(s) - c * root(s / c)))];
        let within = |most: f64, value: &dyn Fn(&SiteResult) -> f64| -> Vec<(f64, f64, f64)> {
            sites.iter().filter(|s| at(s).abs() < most).map(|s| (at(s), s.weight, value(s))).collect()
        };
        let ripples = [ripple(&within(0.8, &|s| s.pressure)), ripple(&within(0.9 * c, &along))];
        println!("{how:?}: P {p}, Q/μP {}, c/a {c}, off {errors:?}, ripple {ripples:?}", q / MU / p);
        (errors, ripples)
    });
    let [(errors, ripples), (_, rippled)] = found;
    assert!(errors[0] < 0.06 && errors[1] < 0.27, "{errors:?}");
    for k in 0..2 {
        assert!(ripples[k] < [0.01, 0.12][k] && rippled[k] > 4.0 * ripples[k], "{ripples:?} {rippled:?}");
    }
}

/// An increment in which nothing moves changes nothing by penalties. By Nitsche's method slips count from the state before,
/// where they vanish in the mean only: what is left of them relaxes, and the force creeps by little.
#[test]
fn what_sticks_stays() {
    for (how, most) in [(Enforcement::Nitsche, 1e-3), (PENALTY, 1e-9)] {
        let mut system = pressed_and_shifted(how);
        let (state, found) = through(&mut system, &[0.5, 1.0, 1.5]);
        let (_, again) = system.solve(&state, 1.5, &mut |_, _| true).unwrap();
        let [a, b] = [&found, &again].map(|f| f.support_forces[0][0]);
        println!("{how:?}: the force {a} changes by {}", b - a);
        assert!((b - a).norm() < most * a.norm() && (b - a)[0].abs() < most * a[0].abs(), "{how:?}: {a} {b}");
    }
}
