//! The tangent of a contact against central differences of its residual, for pairs of every kind.

use crate::common::{ball, rigid, v};
use crate::patch::Sheet;
use signorini_contact::{Coulomb, Law};
use signorini_geometry::Point;
use signorini_geometry::rigid_shape::{Ellipsoid, Plane, Sphere, Torus};
use signorini_mechanics::body::Body;
use signorini_mechanics::contact::Contact;
use signorini_mechanics::enforcement::Enforcement;
use signorini_mechanics::pair::AxisChoice;
use signorini_mechanics::part::Part;
use signorini_mechanics::points::{Order, Sampling};
use signorini_mechanics::rigid_body::{Motion, RigidBody};
use signorini_mechanics::system::{System, SystemState};
use signorini_mechanics::testing::{self, assembled, numbering};

fn noise(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    ((*seed >> 33) as f64 / (1u64 << 31) as f64) * 2.0 - 1.0
}

fn sheet(name: &str, height: f64, up: f64) -> Sheet {
    let nodes = (0..9)
        .map(|k| {
            let (x, y) = ((k % 3) as f64 * 0.5, (k / 3) as f64 * 0.5);
            let y = if up > 0.0 { y } else { 1.0 - y };
            Point::<3>::new(x, y, height + 0.1 * (x - 0.4).powi(2) - 0.07 * up * (y - 0.6) * x)
        })
        .collect();
    Sheet { name: name.to_string(), nodes, foundation: 3.0, coordinates: 2, radius: 0.0 }
}

fn string(name: &str, points: [[f64; 3]; 3], radius: f64) -> Sheet {
    let nodes = points.map(Point::<3>::from).to_vec();
    Sheet { name: name.to_string(), nodes, foundation: 3.0, coordinates: 1, radius }
}

/// The largest difference between the tangent and differences of the residual, relative to the largest entry; and the
/// resultant force and moment of the contact, relative to the largest force. States are moved at random by `moved`.
fn check(
    slave: impl Body + 'static,
    master: impl Body + 'static,
    enforcement: Enforcement,
    law: Option<Box<dyn Law>>,
    axis: AxisChoice,
    moved: f64,
) -> f64 {
    let part = |body| Part { body, group: None };
    let mut contact =
        Contact::new("pair", (part(0), &slave), (part(1), &master), Sampling::Nodes, enforcement).unwrap();
    contact.law.friction = law;
    contact.axis = axis;
    let mut system = System {
        bodies: vec![Box::new(slave), Box::new(master)],
        contacts: vec![Box::new(contact)],
        ..System::default()
    };
    system.prepare().unwrap();
    let mut state = system.start();
    let seed = &mut 7u64;
    let random = |state: &SystemState, size: f64, seed: &mut u64, system: &System| {
        let (_, count) = numbering(system);
        let step: Vec<f64> =
            (0..count + state.multipliers.len()).map(|k| if k < count { size } else { 1.0 } * noise(seed)).collect();
        advance(system, state, &step, 1.0)
    };
    state = random(&state, 0.01, seed, &system);
    system.accept(&state).unwrap();
    // Tractions come first in what is kept of a site.
    let parts = if system.contacts[0].friction().is_some() { 3 } else { 1 };
    let mut history = system.contacts[0].history();
    let numbers = history[0].len() / (state.multipliers.len() / parts);
    for site in history[0].chunks_mut(numbers) {
        site[..3].copy_from_slice(&[0.8 + 0.1 * noise(seed), 0.1 * noise(seed), 0.1 * noise(seed)]);
    }
    system.contacts[0].restore(&history).unwrap();
    let mut state = random(&state, moved, seed, &system);
    for own in state.multipliers.chunks_mut(parts) {
        own[0] = 0.9 + 0.05 * noise(seed);
        own[1..].iter_mut().for_each(|t| *t *= 0.1);
    }
    // What slips and would slip back is linearised as sticking: the friction of such sites is turned along their slip.
    let [told, linearised] = [Order::First, Order::Second].map(|order| assembled(&system, &state, order).unwrap().0);
    let own = told.len() - state.multipliers.len();
    for (k, site) in state.multipliers.chunks_mut(parts).enumerate() {
        let rows = own + parts * k..own + parts * (k + 1);
        if told[rows.clone()] != linearised[rows] {
            site[1..].iter_mut().for_each(|t| *t = -*t);
        }
    }
    let (residual, tangent) = assembled(&system, &state, Order::Second).unwrap();
    let n = residual.len();
    let matrix = tangent.matrix(n);
    let closed: f64 = residual.iter().map(|r| r.abs()).sum();
    assert!(closed > 1e-3, "nothing touches");
    let (first, count) = numbering(&system);
    let mut dense = nalgebra::DMatrix::from_fn(n, n, |i, j| matrix.get(i, j));
    // Residuals are differentiated component by component, and the tangent is symmetric in spins where forces have a
    // potential: half a turn of the moment apart.
    for (body, first) in system.bodies.iter().zip(first) {
        for spin in body.spins() {
            let spin = spin.map(|s| (s + first) as usize);
            let moment = v(residual[spin[0]], residual[spin[1]], residual[spin[2]]).cross_matrix() * 0.5;
            for i in 0..3 {
                (0..3).for_each(|j| dense[(spin[i], spin[j])] -= moment[(i, j)]);
            }
        }
    }
    let scale = dense.amax();
    let mut worst = 0.0f64;
    for j in 0..n {
        let of = |h: f64| {
            let mut step = vec![0.0; n];
            step[j] = h;
            assembled(&system, &advance(&system, &state, &step, 1.0), Order::First).unwrap().0
        };
        let h = if j < count { 1e-6 } else { 1e-4 };
        let (plus, minus) = (of(h), of(-h));
        for i in 0..n {
            worst = worst.max((dense[(i, j)] - (plus[i] - minus[i]) / (2.0 * h)).abs() / scale);
        }
    }
    worst
}

fn advance(system: &System, at: &SystemState, step: &[f64], share: f64) -> SystemState {
    let (first, count) = numbering(system);
    let bodies = (system.bodies.iter().zip(&at.bodies).zip(first))
        .map(|((b, s), f)| b.advance(s, &step[f as usize..f as usize + b.unknowns()], share))
        .collect();
    let multipliers = at.multipliers.iter().zip(&step[count..]).map(|(m, s)| m + share * s).collect();
    testing::state(bodies, multipliers, count)
}

fn free() -> Motion {
    Motion::Free { plane: false }
}

fn laws() -> [(Option<Box<dyn Law>>, &'static str); 4] {
    [
        (None, "no friction"),
        (Some(Box::new(Coulomb::isotropic(50.0).unwrap())), "stick"),
        (Some(Box::new(Coulomb::isotropic(0.05).unwrap())), "slip"),
        (Some(Box::new(Coulomb::orthotropic([0.02, 0.06]).unwrap())), "orthotropic slip"),
    ]
}

const ALL: [Enforcement; 3] =
    [Enforcement::Penalty { wanted_penetration: None }, Enforcement::AugmentedLagrangian, Enforcement::Multiplier];

#[test]
fn surfaces_against_surfaces_and_rigid_bodies_are_exact() {
    for enforcement in ALL {
        for ((law, name), (again, _)) in laws().into_iter().zip(laws()) {
            let error = check(
                sheet("upper", 0.05, -1.0),
                sheet("lower", 0.1, 1.0),
                enforcement,
                law,
                AxisChoice::Material,
                0.02,
            );
            assert!(error < 2e-8, "sheets, {name}, {enforcement:?}: {error:e}");
            let shape = Ellipsoid::new(v(0.5, 0.5, -0.83), [1.0, 0.8, 0.9]).unwrap();
            let body = rigid("ellipsoid", shape, free(), Vec::new());
            let error = check(sheet("upper", 0.02, -1.0), body, enforcement, again, AxisChoice::Material, 0.02);
            assert!(error < 2e-7, "ellipsoid, {name}, {enforcement:?}: {error:e}");
        }
    }
}

#[test]
fn a_rope_on_a_free_torus_is_exact_with_the_axis_along_it() {
    for (law, name) in laws() {
        let rope = string("rope", [[-0.3, -0.45, 0.29], [0.0, 0.0, 0.33], [0.3, 0.5, 0.28]], 0.02);
        let torus = Torus { center: v(-1.0, 0.0, 0.0), axis: v(0.0, 0.0, 1.0), major: 1.0, minor: 0.3 };
        let torus = rigid("torus", torus, free(), Vec::new());
        let error = check(rope, torus, Enforcement::AugmentedLagrangian, law, AxisChoice::Tangent, 0.01);
        assert!(error < 2e-7, "{name}: {error:e}");
    }
}

#[test]
fn a_ball_that_rolls_far_over_a_body_that_turns_is_exact() {
    let shape = |which: usize| -> RigidBody {
        match which {
            0 => rigid("floor", Plane { point: v(0.2, 0.1, 0.0), normal: v(0.0, 0.0, 1.0) }, free(), Vec::new()),
            _ => rigid("wheel", Sphere { center: v(0.3, -0.2, -1.4), radius: 1.5 }, free(), Vec::new()),
        }
    };
    for which in 0..2 {
        for (law, name) in laws() {
            let ball = ball(v(0.2, 0.1, 0.1), 0.3, free());
            let error = check(ball, shape(which), Enforcement::Multiplier, law, AxisChoice::Material, 0.25);
            assert!(error < 2e-7, "{which}, {name}: {error:e}");
        }
    }
}

#[test]
fn a_free_ball_that_rolls_errs_only_with_the_gap() {
    for (law, name) in laws() {
        let error = |law, height: f64| {
            let ball = ball(v(0.5, 0.5, height), 0.3, free());
            check(ball, sheet("lower", 0.0, 1.0), Enforcement::Multiplier, law, AxisChoice::Material, 1e-4)
        };
        let error = error(law, 0.3);
        assert!(error < 2e-2, "{name}: {error:e}");
    }
}
