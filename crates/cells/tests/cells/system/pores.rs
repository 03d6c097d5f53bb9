//! Pores that close on themselves, and pairs that are kept during an increment.

use super::masters::{ALL, PENALTY, contact, disc, noise};
use super::*;
use signorini_cells::shapes::{Ellipsoid, ball};
use signorini_contact::Coulomb;

/// An elliptic pore in half of a plate, and a spheroidal one in a cylinder around its axis, pressed until they close: both
/// faces meet each other. The force on the ends, and what independent computations with fitted elements find.
fn close(
    space: Space,
    delta: f64,
    pairing: Pairing,
    how: Enforcement,
    friction: Option<f64>,
) -> (f64, f64, IncrementResult) {
    let reference: serde_json::Value = serde_json::from_str(include_str!("../../data/finite_cells.json")).unwrap();
    let key = if space == Space::Axisymmetric { "pore_3d_spheroid" } else { "pore_closure" };
    let curve = reference[key]["curve"].as_array().unwrap();
    let row = curve.iter().find(|r| (r["delta"].as_f64().unwrap() - delta).abs() < 1e-9);
    let wanted = row.map_or(f64::NAN, |row| row["F"].as_f64().unwrap());
    let pore = Ellipsoid { center: Point::<2>::zeros(), semi_axes: [0.5, 0.1] };
    let tree = CellTree::new(aabb([0.0, -1.0], [1.0, 1.0]), [5, 9]).unwrap();
    let setup = Discretisation { refine_narrow: 2, ..Discretisation::of_degree(4) };
    let domain = Domain::Complement(Box::new(Domain::shape(pore)));
    let body = CellBody::new(Arc::new(domain), tree, setup, material(space)).unwrap();
    let places = named(vec![("axis", Place::low(0)), ("top", Place::high(1)), ("base", Place::low(1))]);
    let body = CellSolid::new("plate", body, &places).unwrap();
    let itself = part(0, "boundary");
    let mut contact =
        Contact::new("pore", (itself.clone(), &body), (itself, &body), Sampling::GaussPoints, how).unwrap();
    contact.pairing = pairing;
    contact.law.friction = friction.map(coulomb);
    let mut system = System {
        supports: vec![
            support(0, "axis", [constant(0.0), None, None]),
            support(0, "top", [None, constant(-delta), None]),
            support(0, "base", [None, constant(delta), None]),
        ],
        bodies: vec![Box::new(body)],
        contacts: vec![Box::new(contact)],
        ..System::default()
    };
    system.prepare().unwrap();
    // Just before it closes, and from there.
    let (open, _) = system.solve(&system.start(), 0.85, &mut |_, _| true).unwrap();
    system.accept(&open).unwrap();
    let (_, found) = system.solve(&open, 1.0, &mut |_, _| true).unwrap();
    let force = -found.support_forces[1][0][1];
    let touches = found.sites[0].iter().any(|s| s.pressure > 0.0);
    println!(
        "{space:?} {delta} {pairing:?} {how:?}: {force} ({wanted}), touches: {touches}, {} iterations",
        found.iterations
    );
    assert!((found.support_forces[1][0][1] + found.support_forces[2][0][1]).abs() < 1e-10 * force.max(1.0));
    assert_eq!(touches, delta > 0.11);
    (force, wanted, found)
}

/// Root mean square of the deviation of pressures from a polynomial of degree 4 of their place, relative to their mean.
fn scatter(found: &IncrementResult) -> f64 {
    let sites: Vec<&SiteResult> = found.sites[0].iter().filter(|s| s.x[0] < 0.45 && s.x[1] > 0.0).collect();
    let rows = |k: usize| sites[k].weight.sqrt();
    let powers = nalgebra::DMatrix::from_fn(sites.len(), 5, |k, j| rows(k) * sites[k].x[0].powi(j as i32));
    let pressures = nalgebra::DVector::from_fn(sites.len(), |k, _| rows(k) * sites[k].pressure);
    let fit = powers.clone().svd(true, true).solve(&pressures, 1e-14).unwrap();
    let all: f64 = sites.iter().map(|s| s.weight).sum();
    let mean = sites.iter().map(|s| s.weight * s.pressure).sum::<f64>() / all;
    (powers * fit - pressures).norm() / all.sqrt() / mean
}

#[test]
fn a_pore_in_a_plate_closes_on_itself() {
    let (force, wanted, _) = close(Space::PlaneStrain, 0.05, Pairing::Now, PENALTY, None);
    assert!((force / wanted - 1.0).abs() < 1e-3, "{force} {wanted}");
    for pairing in [Pairing::Now, Pairing::AtStart] {
        let (force, wanted, _) = close(Space::PlaneStrain, 0.12, pairing, PENALTY, None);
        assert!((force / wanted - 1.0).abs() < 1e-3, "{force} {wanted}");
        let (force, wanted, _) = close(Space::PlaneStrain, 0.12, pairing, Enforcement::Nitsche, None);
        assert!((force / wanted - 1.0).abs() < 1e-3, "{force} {wanted}");
        // Farther on, where most of both faces carries.
        for how in [PENALTY, Enforcement::Nitsche] {
            let (_, _, found) = close(Space::PlaneStrain, 0.15, pairing, how, None);
            println!("scatter {}", scatter(&found));
            assert!(scatter(&found) < 0.05);
        }
    }
}

#[test]
fn a_pore_around_an_axis_closes_on_itself() {
    for pairing in [Pairing::Now, Pairing::AtStart] {
        let (force, wanted, _) = close(Space::Axisymmetric, 0.16, pairing, PENALTY, None);
        assert!((force / wanted - 1.0).abs() < 1e-3, "{force} {wanted}");
    }
}

fn coulomb(mu: f64) -> Box<dyn signorini_contact::Law> {
    Box::new(Coulomb::isotropic(mu).unwrap())
}

/// Kept pairs, without friction, sticking and slipping: tangents, and forces that cancel.
#[test]
fn kept_pairs_have_exact_tangents() {
    for friction in ALL {
        for how in [PENALTY, Enforcement::Nitsche] {
            let (upper, lower) = (disc("upper", 0.985, 3), disc("lower", -1.0, 3));
            let mut contact = contact(("skin", &upper), ("skin", &lower), Sampling::GaussPoints, how);
            contact.pairing = Pairing::AtStart;
            contact.law.friction = friction.map(coulomb);
            let bodies: Vec<Box<dyn Body>> = vec![Box::new(upper), Box::new(lower)];
            let mut system = System { bodies, contacts: vec![Box::new(contact)], ..System::default() };
            system.prepare().unwrap();
            let start = system.start();
            let n = system.linearise(&start, 1.0).unwrap().0.len();
            let seed = &mut 5u64;
            let step: Vec<f64> = (0..n).map(|_| 2e-3 * noise(seed)).collect();
            let state = system.advance(&start, &step, 1.0);
            let error = tangent_error(&system, &state, 2e-7, 20);
            let with = system.linearise(&state, 1.0).unwrap().0;
            system.contacts.clear();
            let without = system.linearise(&state, 1.0).unwrap().0;
            let force: f64 = with.iter().zip(&without).map(|(a, b)| (a - b).powi(2)).sum();
            println!("{friction:?} {how:?}: tangent {error:e}, force {:e}", force.sqrt());
            assert!(force.sqrt() > 1e-4, "nothing touches");
            assert!(error < 1e-6, "{friction:?} {how:?}: {error:e}");
        }
    }
}

/// Discs are pressed together, then one is moved along the other: with pairs that are kept as with closest points, sticking
/// and slipping, up to how far the surfaces turn within an increment.
#[test]
fn kept_pairs_rub_as_closest_points_do() {
    let press = |pairing: Pairing, mu: f64, increments: usize| {
        let disc = |name: &str, up: f64| {
            let shape = Domain::shape(ball(Point::<2>::new(0.0, up), 1.0));
            let [low, high] = if up > 0.0 { [0.0, 1.0] } else { [-1.0, 0.0] };
            let middle = if up > 0.0 { Place::high(1) } else { Place::low(1) };
            let skin = Place::boundary(move |p| p.normal[1] * up < -0.5);
            let b = aabb([-1.0, low], [1.0, high]);
            solid(name, shape, (b, [10, 5]), 3, Space::PlaneStrain, vec![("middle", middle), ("skin", skin)])
        };
        let (upper, lower) = (disc("upper", 1.0), disc("lower", -1.0));
        let mut contact = contact(("skin", &upper), ("skin", &lower), Sampling::GaussPoints, PENALTY);
        (contact.pairing, contact.law.friction) = (pairing, Some(coulomb(mu)));
        let mut top = support(0, "middle", [None, None, None]);
        top.displacement[0] = Some(Arc::new(|_, t| 0.02 * (t - 1.0f64).max(0.0)));
        top.displacement[1] = Some(Arc::new(|_, t| -0.04 * t.min(1.0)));
        let mut system = System {
            supports: vec![top, support(1, "middle", [constant(0.0), constant(0.0), None])],
            bodies: vec![Box::new(upper), Box::new(lower)],
            contacts: vec![Box::new(contact)],
            ..System::default()
        };
        system.prepare().unwrap();
        let (mut state, mut found, mut iterations) = (system.start(), IncrementResult::default(), 0);
        let moved = (1..=increments).map(|k| 1.0 + 0.5 * k as f64 / increments as f64);
        for t in [0.5, 1.0].into_iter().chain(moved) {
            (state, found) = system.solve(&state, t, &mut |_, _| true).unwrap();
            system.accept(&state).unwrap();
            iterations += found.iterations;
        }
        let force = found.support_forces[0][0];
        println!("{pairing:?} {mu}: {force:?}, {iterations} iterations");
        [force[0], -force[1]]
    };
    for mu in [0.1, 0.5] {
        let now = press(Pairing::Now, mu, 2);
        let slips = now[0] > 0.97 * mu * now[1];
        assert!(now[0] > 0.0 && slips == (mu < 0.2), "{now:?}");
        let off = |increments: usize| {
            let kept = press(Pairing::AtStart, mu, increments);
            (kept[0] / now[0] - 1.0).abs().max((kept[1] / now[1] - 1.0).abs())
        };
        let errors = [2, 8].map(off);
        println!("{errors:?}");
        assert!(errors[0] < 0.04 && errors[1] < 0.02, "{errors:?}");
    }
}
