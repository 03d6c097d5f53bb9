//! One Newton step of a system with contact: `cargo bench -p signorini-solid --bench newton`.
//!
//! Two elastic blocks of different cells are pressed on each other and then pushed sideways, with contact at nodes and by mortar,
//! with and without friction, at finite sliding. A line tells the unknowns, the time to assemble residual and tangent at the state that was
//! found, the iterations of the increment, and its time for each of them: assembly, factorisation, line search. The largest
//! size is given by `SIGNORINI_LADDER` (unknowns; 20 000 if left out).

use signorini_contact::Coulomb;
use signorini_fem::block::block;
use signorini_mechanics::system::TimeField;
use signorini_mechanics::*;
use signorini_solid::{Elastic, SolidBody, Space, StressLaw};
use std::sync::Arc;
use std::time::Instant;

fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| from + (to - from) * k as f64 / n as f64).collect()
}

fn solid(name: &str, (side, low): (f64, f64), n: usize) -> Box<dyn Body> {
    let mesh = block::<3>(&[even(-side, side, n), even(-side, side, n), even(low, low + 1.0, n.div_ceil(3))], 1, |x| x);
    let groups = mesh.groups().clone();
    let law = (Elastic { youngs_modulus: 1000.0, poissons_ratio: 0.3 }, StressLaw::LinearElastic);
    Box::new(SolidBody::<3>::new(name, Arc::new(mesh), 1, law, Space::Solid, groups).expect("a solid"))
}

fn part(body: usize, group: &str) -> Part {
    Part { body, group: Some(group.into()) }
}

fn run(n: usize, by_mortar: bool, mu: Option<f64>) {
    let bodies = vec![solid("lower", (1.5, 0.0), n + n / 2), solid("upper", (1.0, 1.0), n)];
    let mut system = System { bodies, ..System::default() };
    let zero = || -> TimeField { Arc::new(|_, _| 0.0) };
    let down: TimeField = Arc::new(|_, t| -0.01 * t);
    let aside: TimeField = Arc::new(|_, t| 0.001 * t);
    let floor = [Some(zero()), Some(zero()), Some(zero())];
    let moved = [Some(aside), Some(zero()), Some(down)];
    for (body, group, displacement) in [(0, "bottom", floor), (1, "top", moved)] {
        system.supports.push(Support {
            name: group.into(),
            part: part(body, group),
            displacement,
            ..Support::default()
        });
    }
    let side = |body: usize, group: &str| (part(body, group), system.bodies[body].as_ref());
    let (slave, master, how) = (side(1, "bottom"), side(0, "top"), Enforcement::Multiplier);
    let law = mu.map(|mu| Box::new(Coulomb::isotropic(mu).expect("a coefficient")) as _);
    let contact: Box<dyn Interaction> = if by_mortar {
        let mut contact = Mortar::new("touch", slave, master, how).expect("faces");
        contact.law.friction = law;
        Box::new(contact)
    } else {
        let mut contact = Contact::new("touch", slave, master, Sampling::Nodes, how).expect("nodes");
        contact.law.friction = law;
        Box::new(contact)
    };
    system.contacts.push(contact);
    system.prepare().expect("a system");
    let start = Instant::now();
    let (state, result) = system.solve(&system.start(), 1.0, &mut |_, _| true).expect("a state");
    let solved = start.elapsed().as_secs_f64();
    let start = Instant::now();
    system.linearise(&state, 1.0).expect("a tangent");
    println!(
        "{:>8} {:>6} {:>8} {:>9} {:>12.1} {:>11} {:>12.1}",
        result.unknowns,
        if by_mortar { "mortar" } else { "nodes" },
        mu.map_or("none".to_string(), |mu| mu.to_string()),
        format!("{:?}", result.solved).split_whitespace().next().unwrap_or_default(),
        1e3 * start.elapsed().as_secs_f64(),
        result.iterations,
        1e3 * solved / result.iterations as f64,
    );
}

fn main() {
    let largest: f64 = std::env::var("SIGNORINI_LADDER").ok().and_then(|v| v.parse().ok()).unwrap_or(20_000.0);
    println!("unknowns method friction    solver  assembly ms  iterations  ms/iteration");
    for n in [6usize, 10, 14, 20, 28] {
        // Of both blocks, of 1 and 3/2 n cells along their edges.
        if 4.5 * (n as f64).powi(3) <= largest {
            for by_mortar in [false, true] {
                [None, Some(0.3)].into_iter().for_each(|mu| run(n, by_mortar, mu));
            }
        }
    }
}
