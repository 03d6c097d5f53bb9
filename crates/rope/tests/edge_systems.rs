//! Edges of solids in systems: forces that are known.

#[path = "common/bodies.rs"]
mod bodies;

use bodies::{at_zero, cable, clamped, field, held, part, pulled, total};
use signorini_contact::Coulomb;
use signorini_fem::block::block;
use signorini_geometry::Vector;
use signorini_mechanics::body::Body;
use signorini_mechanics::{Enforcement, IncrementResult, Part, System};
use signorini_rope::curve_pair::CurveContact;
use signorini_solid::material::Elastic;
use signorini_solid::{EdgeOf, SolidBody, Space, StressLaw};
use std::collections::BTreeMap;
use std::sync::Arc;

type V = Vector<3>;

fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| from + (to - from) * k as f64 / n as f64).collect()
}

/// A block that is mapped, with an edge.
fn solid(
    name: &str,
    size: [V; 2],
    cells: [usize; 3],
    degree: usize,
    (youngs_modulus, poissons_ratio): (f64, f64),
    map: impl FnMut(V) -> V,
    rim: EdgeOf,
) -> SolidBody<3> {
    let axes: [Vec<f64>; 3] = std::array::from_fn(|k| even(size[0][k], size[1][k], cells[k]));
    let mesh = block::<3>(&axes, 1, map);
    let groups = mesh.groups().clone();
    let law = (Elastic { youngs_modulus, poissons_ratio }, StressLaw::LinearElastic);
    let body = SolidBody::new(name, Arc::new(mesh), degree, law, Space::Solid, groups).unwrap();
    body.with_edges(&BTreeMap::from([("rim".to_string(), rim)])).unwrap()
}

fn edge(surfaces: [&str; 2], radius: f64) -> EdgeOf {
    EdgeOf { surfaces: surfaces.map(str::to_string), radius }
}

/// Square bars that cross, edge on edge, as cantilevers: the force of the theory of beams with shear.
#[test]
fn crossing_bars_touch_at_their_edges() {
    let (a, young) = (0.1f64, 1000.0);
    let bending = young * a.powi(4) / 12.0;
    let shear = 5.0 / 6.0 * young / 2.0 * a * a;
    let lengths = [2.0, 1.5];
    let at = [1.5, 1.0];
    let push = 1e-4;
    // Deflection at x by a force at y of a cantilever, x before y.
    let compliance = |x: f64, y: f64| x * x * (3.0 * y - x) / (6.0 * bending) + x / shear;
    let expected = push * compliance(at[0], lengths[0]) / (compliance(at[0], at[0]) + compliance(at[1], at[1]));
    for radius in [0.0, 0.02] {
        for enforcement in [Enforcement::AugmentedLagrangian, Enforcement::Penalty { wanted_penetration: None }] {
            let h = a / 2f64.sqrt();
            // The upper bar runs along x with an edge down, the lower one along y with one up.
            let upper =
                |x: V| V::new(x[0], (x[1] - x[2]) / 2f64.sqrt(), (x[1] + x[2]) / 2f64.sqrt() + h + 2.0 * radius);
            let lower =
                |x: V| V::new(at[0] + (x[2] - x[1]) / 2f64.sqrt(), x[0] - at[1], (x[1] + x[2]) / 2f64.sqrt() - h);
            let size = |l: f64| [V::new(0.0, -0.5 * a, -0.5 * a), V::new(l, 0.5 * a, 0.5 * a)];
            let bar = |name, l, map: &dyn Fn(V) -> V, rim| solid(name, size(l), [8, 1, 1], 3, (young, 0.0), map, rim);
            let bodies: Vec<Box<dyn Body>> = vec![
                Box::new(bar("upper", lengths[0], &upper, edge(["front", "bottom"], radius))),
                Box::new(bar("lower", lengths[1], &lower, edge(["back", "top"], radius))),
            ];
            let sides = [0, 1].map(|k| (part(k, "rim"), bodies[k].as_ref()));
            let [own, met] = sides;
            let contact = CurveContact::new("touch", own, met, enforcement).unwrap();
            let mut system = System { bodies, contacts: vec![Box::new(contact)], ..System::default() };
            let none = [None, None, None];
            system.supports = (0..2).map(|b| held(b, "left", [(); 3].map(|()| at_zero()), none.clone())).collect();
            system.loads.push(pulled(0, "right", V::new(0.0, 0.0, -push)));
            system.prepare().unwrap();
            let start = system.start();
            let (_, result) = system.solve(&start, 1.0, &mut |_, _| true).unwrap();
            let force = total(&result.sites[0]);
            println!(
                "radius {radius}, {enforcement:?}: {:.5} of {expected:.5e}, {} iterations",
                force / expected,
                result.iterations
            );
            assert!((force / expected - 1.0).abs() < 5e-3);
        }
    }
}

/// A rope over the edge of a stiff block, drawn at one end: the ratio of the tensions is that of a point of contact.
#[test]
fn a_rope_slides_over_an_edge() {
    let mu = 0.2;
    for (radius, cells) in [(0.0, 12), (0.0, 24), (0.2, 24)] {
        let block = solid(
            "block",
            [V::new(-1.0, -0.5, -1.0), V::new(0.0, 0.5, 0.0)],
            [2, 2, 2],
            1,
            (1e4, 0.3),
            |x| x,
            edge(["top", "right"], radius),
        );
        let r = radius + 0.05;
        let arc = |k: i32| r * V::new((f64::from(k) * 0.3927).sin(), 0.0, (f64::from(k) * 0.3927).cos());
        let mut points: Vec<V> = (0..5).map(|k| V::new(-1.25 + 0.25 * f64::from(k), 0.0, r)).collect();
        points.extend((0..5).map(arc));
        points.extend((1..6).map(|k| V::new(r, 0.0, -0.25 * f64::from(k))));
        let rope = cable("rope", &points, cells, 0.05);
        let bodies: Vec<Box<dyn Body>> = vec![Box::new(rope), Box::new(block)];
        let sides = [(Part::from(0), bodies[0].as_ref()), (part(1, "rim"), bodies[1].as_ref())];
        let [own, met] = sides;
        let mut contact = CurveContact::new("touch", own, met, Enforcement::AugmentedLagrangian).unwrap();
        contact.friction = Some(Box::new(Coulomb::isotropic(mu).unwrap()));
        let mut system = System { bodies, contacts: vec![Box::new(contact)], ..System::default() };
        let none = || [None, None, None];
        system.supports.push(held(1, "bottom", [(); 3].map(|()| at_zero()), none()));
        system.supports.push(held(0, "start", [None, at_zero(), at_zero()], none()));
        system.supports.push(held(0, "end", [at_zero(), at_zero(), field(|_: &V, t| -0.1 * t)], none()));
        system.loads.push(pulled(0, "start", V::new(-1.0, 0.0, 0.0)));
        system.prepare().unwrap();
        let (mut state, mut result) = (system.start(), IncrementResult::default());
        for t in [0.5, 1.0] {
            (state, result) = system.solve(&state, t, &mut |_, _| true).unwrap();
            system.accept(&state).unwrap();
        }
        println!("{radius} {cells}: {} sites, {} iterations", result.sites[0].len(), result.iterations);
        for s in result.sites[0].iter().filter(|s| s.pressure > 0.0) {
            println!("   {:?} {:.4} {:.4}", s.x, s.pressure * s.weight, s.utilisation);
        }
    }
    let _ = clamped;
}
