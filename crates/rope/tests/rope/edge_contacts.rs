//! Edges of solids against rigid shapes and against faces of solids: tangents, balance, and forces that are known.

use crate::common::bodies::{at_zero, held, part, pulled, total};
use signorini_contact::{Coulomb, Law};
use signorini_fem::block::block;
use signorini_geometry::Vector;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::{Ellipsoid, RigidShape};
use signorini_mechanics::body::Body;
use signorini_mechanics::interaction::{Assembler, Bodies, InteractionUnknowns};
use signorini_mechanics::{
    AxisChoice, Contact, Enforcement, Motion, Part, PlacedLoad, RigidBody, Sampling, Support, System, SystemState,
    TimedLoad,
};
use signorini_rope::centreline::{Closure, Continuity};
use signorini_rope::chain::Chain;
use signorini_rope::chain::body::ReferenceLength;
use signorini_rope::path::Path;
use signorini_rope::section::Stiffness;
use signorini_solid::Elastic;
use signorini_solid::{EdgeOf, SolidBody, Space, StressLaw};
use std::collections::BTreeMap;
use std::sync::Arc;

type V = Vector<3>;

/// The surfaces of an edge that looks up when a block is turned onto it.
const UP: [&str; 2] = ["back", "top"];

fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| from + (to - from) * k as f64 / n as f64).collect()
}

/// A block that is mapped, with an edge.
fn solid(
    name: &str,
    [low, high]: [V; 2],
    cells: [usize; 3],
    degree: usize,
    (youngs_modulus, poissons_ratio): (f64, f64),
    map: impl FnMut(V) -> V,
    (surfaces, radius): ([&str; 2], f64),
) -> SolidBody<3> {
    let axes: [Vec<f64>; 3] = std::array::from_fn(|k| even(low[k], high[k], cells[k]));
    let mesh = block::<3>(&axes, 1, map);
    let groups = mesh.groups().clone();
    let law = (Elastic { youngs_modulus, poissons_ratio }, StressLaw::LinearElastic);
    let body = SolidBody::new(name, Arc::new(mesh), degree, law, Space::Solid, groups).unwrap();
    let rim = EdgeOf { surfaces: surfaces.map(str::to_string), radius };
    body.with_edges(&BTreeMap::from([("rim".to_string(), rim)])).unwrap()
}

fn rigid(shape: impl RigidShape + 'static) -> RigidBody {
    let centre = shape.centre();
    let motion = Motion::Prescribed(Arc::new(|_| RigidMotion::new(V::zeros(), V::zeros(), V::zeros())));
    RigidBody { name: "rigid".into(), shape: Arc::new(shape), motion, centre, sites: Vec::new(), size: 1.0, mass: None }
}

fn sphere(centre: V, radius: f64) -> RigidBody {
    rigid(Ellipsoid::new(centre, [radius; 3]).unwrap())
}

#[derive(Clone, Copy, Debug)]
enum MasterProjection {
    Ball,
    Face,
}

/// A ridge of a block, bent a little, in a ball or the face of another block.
fn touching(met: MasterProjection, radius: f64, law: Option<Box<dyn Law>>) -> System {
    let half = 0.5f64.sqrt();
    let ridge = |x: V| V::new(x[0], half * (x[1] - x[2]), half * (x[1] + x[2]) + 0.02 * x[0] * x[0]);
    let size = [V::new(-1.0, -1.0, -1.0), V::zeros()];
    let own = solid("ridge", size, [2, 1, 1], 2, (100.0, 0.3), ridge, (UP, radius));
    let other: Box<dyn Body> = match met {
        MasterProjection::Ball => Box::new(sphere(V::new(-0.4, 0.05, 2.0 + radius - 0.02), 2.0)),
        MasterProjection::Face => {
            // Upside down: its top looks down.
            let map = |x: V| V::new(x[0] - 0.4, -x[1], radius - 0.02 - x[2] + 0.03 * x[1] * x[1]);
            Box::new(solid(
                "other",
                [V::new(-1.0, -1.0, -1.0), V::new(1.0, 1.0, 0.0)],
                [1, 1, 1],
                2,
                (100.0, 0.3),
                map,
                (UP, 0.0),
            ))
        }
    };
    let bodies: Vec<Box<dyn Body>> = vec![Box::new(own), other];
    let master = match met {
        MasterProjection::Ball => Part::from(1),
        MasterProjection::Face => part(1, "top"),
    };
    let sides = [(part(0, "rim"), bodies[0].as_ref()), (master, bodies[1].as_ref())];
    let [own, met] = sides;
    let mut contact = Contact::new("touch", own, met, Sampling::GaussPoints, Enforcement::Multiplier).unwrap();
    contact.law.friction = law;
    contact.axis = AxisChoice::Tangent;
    let mut system = System { bodies, contacts: vec![Box::new(contact)], ..System::default() };
    system.prepare().unwrap();
    system
}

fn laws() -> [Option<Box<dyn Law>>; 4] {
    [
        None,
        Some(Box::new(Coulomb::isotropic(50.0).unwrap())),
        Some(Box::new(Coulomb::isotropic(0.02).unwrap())),
        Some(Box::new(Coulomb::orthotropic([0.01, 0.03]).unwrap())),
    ]
}

/// A state that is moved at random, with tractions, and a direction.
fn moved(system: &System) -> (SystemState, Vec<f64>) {
    let start = system.start();
    let n = system.linearise(&start, 0.0).unwrap().0.len();
    let noise = |seed: f64| -> Vec<f64> { (0..n).map(|k| (seed + 1.3 * (k * k) as f64).sin()).collect() };
    let mut at = system.advance(&start, &noise(0.3), 2e-3);
    let parts = if system.contacts[0].friction().is_some() { 3 } else { 1 };
    for (k, m) in at.multipliers.iter_mut().enumerate() {
        *m = if k % parts == 0 { 9.0 + (k as f64).sin() } else { (k as f64).cos() };
    }
    (at, noise(2.2))
}

#[test]
fn tangents_are_derivatives() {
    for met in [MasterProjection::Ball, MasterProjection::Face] {
        for radius in [0.0, 0.1] {
            for law in laws() {
                let rubs = law.is_some();
                let system = touching(met, radius, law);
                let (at, along) = moved(&system);
                let (now, matrix) = system.linearise(&at, 0.0).unwrap();
                let product = matrix.multiply(&along);
                let scale = product.iter().fold(0.0f64, |m, p| m.max(p.abs()));
                let [coarse, fine] = [1e-5, 5e-6].map(|h| {
                    let then = system.linearise(&system.advance(&at, &along, h), 0.0).unwrap().0;
                    let off = |k: usize| (then[k] - now[k] - h * product[k]).abs();
                    (0..now.len()).map(off).fold(0.0, f64::max) / (h * scale)
                });
                println!("{met:?}, radius {radius}, friction {rubs}: {coarse:.1e} {fine:.1e}");
                assert!(fine < 1e-8 || (1.9..2.1).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
                assert!(fine < 1e-3);
            }
        }
    }
}

/// A beam that lies along a rounding, at points of Gauss between its nodes: sections of both turn, as rotations of the one and
/// with displacements of the other.
#[test]
fn tangents_of_beams_along_a_rounding() {
    let (radius, section) = (0.1, 0.05);
    for law in laws() {
        let rubs = law.is_some();
        let size = [V::new(-1.0, -1.0, -1.0), V::zeros()];
        let block = solid("block", size, [1, 2, 1], 2, (100.0, 0.3), |x| x, (["top", "right"], radius));
        let away = (radius + section - 0.01) * 0.5f64.sqrt();
        let ends = [V::new(away, -0.9, away), V::new(away + 0.01, -0.1, away)];
        let stiffness = Stiffness { axial: 100.0, shear: [40.0; 2], torsion: 1.0, bending: [1.0; 2] };
        let own = crate::common::bodies::beam("rod", &ends, 2, stiffness, section);
        let bodies: Vec<Box<dyn Body>> = vec![Box::new(own), Box::new(block)];
        let [own, met] = [(Part::from(0), bodies[0].as_ref()), (part(1, "rim"), bodies[1].as_ref())];
        let mut contact = Contact::new("touch", own, met, Sampling::GaussPoints, Enforcement::Multiplier).unwrap();
        contact.law.friction = law;
        contact.axis = AxisChoice::Tangent;
        let mut system = System { bodies, contacts: vec![Box::new(contact)], ..System::default() };
        system.prepare().unwrap();
        let (mut at, along) = moved(&system);
        // Predicted stresses are those of the state after a step of nothing.
        let rod = &system.bodies[0];
        at.bodies[0] = rod.advance(&at.bodies[0], &vec![0.0; rod.unknowns()], 0.0);
        let (now, matrix) = system.linearise(&at, 0.0).unwrap();
        let mut product = matrix.multiply(&along);
        // Residuals are differentiated component by component; the tangent is that along geodesics.
        for spin in system.bodies[0].spins() {
            let of = |v: &[f64]| V::from_fn(|i, _| v[spin[i] as usize]);
            let turned = of(&now).cross(&of(&along)) * -0.5;
            (0..3).for_each(|i| product[spin[i] as usize] += turned[i]);
        }
        let scale = product.iter().fold(0.0f64, |m, p| m.max(p.abs()));
        let [coarse, fine] = [1e-5, 5e-6].map(|h| {
            let then = system.linearise(&system.advance(&at, &along, h), 0.0).unwrap().0;
            let off = |k: usize| (then[k] - now[k] - h * product[k]).abs();
            (0..now.len()).map(off).fold(0.0, f64::max) / (h * scale)
        });
        println!("friction {rubs}: {coarse:.1e} {fine:.1e}");
        assert!(fine < 1e-8 || (1.9..2.1).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
    }
}

/// What the contact alone adds to the residual does no work in a rigid motion of both bodies.
#[test]
fn forces_have_neither_resultant_nor_moment() {
    for radius in [0.0, 0.1] {
        for law in laws() {
            let system = touching(MasterProjection::Face, radius, law);
            let (at, _) = moved(&system);
            let first = [0, system.bodies[0].unknowns() as u32];
            let count = first[1] as usize + system.bodies[1].unknowns();
            let size = count + at.multipliers.len();
            let (mut residual, mut sizes) = (vec![0.0; size], vec![0.0; size]);
            let own = InteractionUnknowns { multipliers: &at.multipliers, first: count as u32, prediction: &[] };
            let bodies = Bodies { bodies: &system.bodies, states: &at.bodies, first: &first };
            let mut target = Assembler { residual: &mut residual, sizes: &mut sizes, tangent: None };
            assert_eq!(system.contacts[0].add_to(bodies, own, &mut target).unwrap(), 0);
            let largest = residual[..count].iter().fold(0.0f64, |m, r| m.max(r.abs()));
            assert!(largest > 0.0);
            for mode in 0..6 {
                let modes = (0..2).flat_map(|b| system.bodies[b].rigid_modes(&at.bodies[b])[mode].clone());
                let power: f64 = modes.zip(&residual).map(|(m, r)| m * r).sum();
                assert!(power.abs() < 1e-12 * largest, "radius {radius}, mode {mode}: {power:e} of {largest:e}");
            }
        }
    }
}

/// A square bar with an edge down, as a cantilever, is pressed on a ball, and on the flat top of another one: the forces of the
/// theory of beams with shear.
#[test]
fn a_bar_on_its_edge_carries_as_beams_do() {
    let (a, young, push) = (0.1f64, 1000.0, 1e-4);
    let bending = young * a.powi(4) / 12.0;
    let shear = 5.0 / 6.0 * young / 2.0 * a * a;
    let (lengths, at) = ([2.0, 1.5], [1.5, 1.0]);
    let compliance = |x: f64, y: f64| x * x * (3.0 * y - x) / (6.0 * bending) + x / shear;
    let half = 0.5f64.sqrt();
    // They touch from the start on.
    let sunk = 1e-7;
    for radius in [0.0, 0.02] {
        let upper = |x: V| V::new(x[0], half * (x[1] - x[2]), half * (x[1] + x[2]) + a * half + radius - sunk);
        let size = |l: f64| [V::new(0.0, -0.5 * a, -0.5 * a), V::new(l, 0.5 * a, 0.5 * a)];
        let flat = |x: V| V::new(at[0] - x[1], x[0] - at[1], x[2] - 0.5 * a);
        for met in [MasterProjection::Ball, MasterProjection::Face] {
            let bar = solid("bar", size(lengths[0]), [8, 1, 1], 3, (young, 0.0), upper, (["front", "bottom"], radius));
            let other: Box<dyn Body> = match met {
                MasterProjection::Ball => Box::new(sphere(V::new(at[0], 0.0, -0.5), 0.5)),
                MasterProjection::Face => {
                    Box::new(solid("lower", size(lengths[1]), [8, 1, 1], 3, (young, 0.0), flat, (UP, 0.0)))
                }
            };
            let own = compliance(at[0], at[0]);
            let [gives, master] = match met {
                MasterProjection::Ball => [own, 0.0],
                MasterProjection::Face => [own + compliance(at[1], at[1]), 1.0],
            };
            let expected = push * compliance(at[0], lengths[0]) / gives;
            let bodies: Vec<Box<dyn Body>> = vec![Box::new(bar), other];
            let met_part = if master > 0.0 { part(1, "top") } else { Part::from(1) };
            let sides = [(part(0, "rim"), bodies[0].as_ref()), (met_part, bodies[1].as_ref())];
            let [own, touched] = sides;
            let contact =
                Contact::new("touch", own, touched, Sampling::Nodes, Enforcement::Penalty { wanted_penetration: None })
                    .unwrap();
            let mut system = System { bodies, contacts: vec![Box::new(contact)], ..System::default() };
            let none = || [None, None, None];
            let clamped = if master > 0.0 { 0..2 } else { 0..1 };
            system.supports = clamped.map(|b| held(b, "left", [(); 3].map(|()| at_zero()), none())).collect();
            system.loads.push(pulled(0, "right", V::new(0.0, 0.0, -push)));
            system.prepare().unwrap();
            let start = system.start();
            let (_, result) = system.solve(&start, 1.0, &mut |k, _| k < 200).unwrap();
            let ratio = total(&result.sites[0]) / expected;
            println!("{met:?}, radius {radius}: {ratio:.5} of {expected:.5e}, {} iterations", result.iterations);
            assert!((ratio - 1.0).abs() < 5e-3);
        }
    }
}

/// The end of a rope pressed on the rounding about an edge: where the forces of the end, of the rope and of the edge balance.
#[test]
fn the_end_of_a_rope_rests_on_an_edge() {
    let (radius, section, stiffness) = (0.2, 0.05, 100.0);
    let r = radius + section;
    let size = [V::new(-1.0, -0.5, -1.0), V::new(0.0, 0.5, 0.0)];
    let block = solid("block", size, [2, 2, 2], 1, (1e6, 0.3), |x| x, (["top", "right"], radius));
    let start = V::new(-1.0, 0.0, r);
    let path = Path::points(&[start, V::new(0.0, 0.0, r)], Closure::Open).unwrap().sample(8, Continuity::C0).unwrap();
    let rope = Chain::new("rope", &path, stiffness, ReferenceLength::Pretension(1.0), section).unwrap();
    let bodies: Vec<Box<dyn Body>> = vec![Box::new(rope), Box::new(block)];
    let sides = [(part(0, "end"), bodies[0].as_ref()), (part(1, "rim"), bodies[1].as_ref())];
    let [own, met] = sides;
    let contact = Contact::new("touch", own, met, Sampling::Nodes, Enforcement::Multiplier).unwrap();
    let mut system = System { bodies, contacts: vec![Box::new(contact)], ..System::default() };
    let none = || [None, None, None];
    let plane = [None, at_zero(), None];
    system.supports = vec![
        held(1, "bottom", [(); 3].map(|()| at_zero()), none()),
        held(0, "start", [(); 3].map(|()| at_zero()), none()),
        Support {
            name: "plane".into(),
            part: Part::from(0),
            displacement: plane,
            rotation: none(),
            ..Support::default()
        },
    ];
    let pull = V::new(1.0, 0.0, -0.5);
    let load = TimedLoad::Force(Arc::new(move |_, _| pull));
    system.loads.push(PlacedLoad { name: "pull".into(), part: part(0, "end"), load });
    system.prepare().unwrap();
    let (_, result) = system.solve(&system.start(), 1.0, &mut |k, _| k < 200).unwrap();
    // The angle of the end about the edge: nothing is left along the rounding.
    let unstrained = 1.0 / (1.0 + 1.0 / stiffness);
    let at = |a: f64| {
        let n = V::new(a.sin(), 0.0, a.cos());
        let back = start - n * r;
        let tension = stiffness * (back.norm() / unstrained - 1.0);
        (pull + back.normalize() * tension, n, V::new(a.cos(), 0.0, -a.sin()))
    };
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..60 {
        let a = 0.5 * (low + high);
        let (force, _, along) = at(a);
        if force.dot(&along) > 0.0 { low = a } else { high = a }
    }
    let (force, n, _) = at(low);
    let found = &result.sites[0][0];
    println!(
        "{:.6} of {:.6} at {:.5?}, {} iterations",
        found.pressure,
        -force.dot(&n),
        found.x.as_slice(),
        result.iterations
    );
    assert!((found.pressure * found.weight / -force.dot(&n) - 1.0).abs() < 1e-3);
    assert!((found.x - n * r).norm() < 1e-3);
}
