//! Contact between curves in a state: forces and tangent, and whether they fit each other.

use signorini_contact::law::Status;
use signorini_contact::{Coulomb, Law};
use signorini_geometry::Vector;
use signorini_mechanics::body::{Body, BodyState, Order};
use signorini_mechanics::interaction::{Assembler, Bodies, Interaction, InteractionUnknowns, Iterated};
use signorini_mechanics::{Enforcement, SiteResult};
use signorini_rope::curve_pair::contact::CurveContact;
use signorini_solve::general::Entries;

type V = Vector<3>;

/// Bodies in contact, and the contact.
pub type Touching = (Vec<Box<dyn Body>>, CurveContact);

pub fn first_unknowns(bodies: &[&dyn Body]) -> Vec<u32> {
    let mut first = vec![0];
    bodies.iter().for_each(|b| first.push(first[first.len() - 1] + b.unknowns() as u32));
    first
}

pub struct Acted {
    pub residual: Vec<f64>,
    pub tangent: Entries,
    pub sites: Vec<SiteResult>,
}

pub fn act(
    contact: &CurveContact,
    bodies: &[Box<dyn Body>],
    states: &[BodyState],
    prediction: &[f64],
    order: Order,
) -> Acted {
    let all: Vec<&dyn Body> = bodies.iter().map(|b| b.as_ref()).collect();
    let first = first_unknowns(&all);
    let n = first[bodies.len()] as usize;
    let (mut residual, mut sizes, mut tangent) = (vec![0.0; n], vec![0.0; n], Entries::default());
    let at = Bodies { bodies, states, first: &first };
    let own = InteractionUnknowns { multipliers: &[], first: n as u32, prediction };
    let room = (order == Order::Second).then_some(&mut tangent);
    let mut target = Assembler { residual: &mut residual, sizes: &mut sizes, tangent: room };
    assert_eq!(contact.add_to(at, own, &mut target).unwrap(), 0);
    let sites = contact.results(at, own).unwrap();
    Acted { residual, tangent, sites }
}

pub fn advanced(bodies: &[Box<dyn Body>], states: &[BodyState], step: &[f64], share: f64) -> Vec<BodyState> {
    let mut done = 0;
    let mut of = |body: &dyn Body, state: &BodyState| {
        let own = &step[done..done + body.unknowns()];
        done += body.unknowns();
        body.advance(state, own, share)
    };
    bodies.iter().zip(states).map(|(b, s)| of(b.as_ref(), s)).collect()
}

/// The residual moved along a step, less what the tangent says, for two lengths of the step, relative to the largest change.
pub fn taylor(
    (bodies, mut contact): Touching,
    (law, expected): (Option<Box<dyn Law>>, Status),
    enforcement: Enforcement,
) -> [f64; 2] {
    contact.law.friction = law;
    contact.law.enforcement = enforcement;
    let n: usize = bodies.iter().map(|b| b.unknowns()).sum();
    let noise = |seed: f64| -> Vec<f64> { (0..n).map(|k| (seed + 1.3 * k as f64).sin()).collect() };
    let start: Vec<BodyState> = bodies.iter().map(|b| b.start()).collect();
    let all: Vec<&dyn Body> = bodies.iter().map(|b| b.as_ref()).collect();
    let first = first_unknowns(&all);
    let own = InteractionUnknowns { multipliers: &[], first: n as u32, prediction: &[] };
    contact.accept(Bodies { bodies: &bodies, states: &start, first: &first }, own).unwrap();
    if let Enforcement::AugmentedLagrangian = enforcement {
        // Half of the forces as multipliers, and some friction.
        let mut history = contact.history();
        for kept in history[0].chunks_mut(23) {
            kept[4] *= 0.5;
            (kept[5], kept[6]) = (-0.02 * kept[4], 0.01 * kept[4]);
        }
        contact.restore(&history).unwrap();
    }
    let states = advanced(&bodies, &start, &noise(0.9), 2e-3);
    let found = act(&contact, &bodies, &states, &[], Order::First).sites;
    let closed: Vec<&SiteResult> = found.iter().filter(|s| s.status != Status::Open).collect();
    assert!(closed.iter().any(|s| s.status == expected), "{closed:?}");
    // Forces of the geometric terms are those of the state.
    let now = act(&contact, &bodies, &states, &predictions(&contact, &bodies, &states, &first), Order::Second);
    let matrix = now.tangent.matrix(n);
    let along = noise(2.2);
    let mut product = matrix.multiply(&along);
    // Residuals are differentiated component by component; the tangent is that along geodesics.
    for (body, first) in bodies.iter().zip(&first) {
        for spin in body.spins() {
            let of = |v: &[f64]| V::from_fn(|i, _| v[(spin[i] + first) as usize]);
            let turned = of(&now.residual).cross(&of(&along)) * -0.5;
            (0..3).for_each(|i| product[(spin[i] + first) as usize] += turned[i]);
        }
    }
    let scale = product.iter().fold(0.0f64, |m, p| m.max(p.abs()));
    // Shorter than what is left to stick: the least penetration times the friction.
    [2e-6, 1e-6].map(|h| {
        let moved = act(&contact, &bodies, &advanced(&bodies, &states, &along, h), &[], Order::First);
        let error = |k: usize| (moved.residual[k] - now.residual[k] - h * product[k]).abs();
        (0..n).map(error).fold(0.0, f64::max) / (h * scale)
    })
}

/// Predictions that are the forces of a state: of a step of nothing.
pub fn predictions(contact: &CurveContact, bodies: &[Box<dyn Body>], states: &[BodyState], first: &[u32]) -> Vec<f64> {
    let n = first[first.len() - 1];
    let at = Bodies { bodies, states, first };
    let none = vec![0.0; n as usize];
    // Twice: a contact has a force that turns from its second iterate on.
    let mut prediction = contact.prediction();
    for _ in 0..2 {
        let own = InteractionUnknowns { multipliers: &[], first: n, prediction: &prediction };
        prediction = contact.predict(at, own, &none, 1.0);
    }
    prediction
}

pub fn laws() -> [(Option<Box<dyn Law>>, Status); 4] {
    [
        (None, Status::Slip),
        (Some(Box::new(Coulomb::isotropic(500.0).unwrap())), Status::Stick),
        (Some(Box::new(Coulomb::isotropic(0.02).unwrap())), Status::Slip),
        (Some(Box::new(Coulomb::orthotropic([0.01, 0.03]).unwrap())), Status::Slip),
    ]
}

/// Forces under friction in a moved state: the sum of their powers in each rigid motion, and the largest force.
pub fn balance((bodies, mut contact): Touching, law: Option<Box<dyn Law>>) -> ([f64; 6], f64) {
    contact.law.friction = law;
    let all: Vec<&dyn Body> = bodies.iter().map(|b| b.as_ref()).collect();
    let first = first_unknowns(&all);
    let n = first[bodies.len()];
    let start: Vec<BodyState> = bodies.iter().map(|b| b.start()).collect();
    let own = InteractionUnknowns { multipliers: &[], first: n, prediction: &[] };
    contact.accept(Bodies { bodies: &bodies, states: &start, first: &first }, own).unwrap();
    let noise: Vec<f64> = (0..n).map(|k| (0.7 + 1.3 * k as f64).sin()).collect();
    let states = advanced(&bodies, &start, &noise, 2e-3);
    let found = act(&contact, &bodies, &states, &[], Order::First);
    let power = |mode: usize| {
        let modes = bodies.iter().zip(&states).flat_map(|(b, s)| b.rigid_modes(s)[mode].clone());
        modes.zip(&found.residual).map(|(m, r)| m * r).sum::<f64>()
    };
    (std::array::from_fn(power), found.residual.iter().fold(0.0f64, |m, r| m.max(r.abs())))
}
