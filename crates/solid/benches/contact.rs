//! Cost per unknown of a block pressed on a rigid sphere, over a ladder of sizes: `cargo bench -p signorini-solid`. The
//! largest size is given by `SIGNORINI_LADDER` (unknowns; 50 000 if left out).

use signorini_fem::block::block;
use signorini_geometry::Point;
use signorini_solid::*;
use std::time::Instant;

fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| from + (to - from) * k as f64 / n as f64).collect()
}

fn run<const D: usize>(n: usize, degree: usize) {
    let start = Instant::now();
    let up = D - 1;
    let axes: [Vec<f64>; D] = std::array::from_fn(|k| if k == up { even(0.0, 1.0, n) } else { even(-0.5, 0.5, n) });
    let mesh = block::<D>(&axes, 1, |x| x);
    let groups = mesh.groups().clone();
    let mut bodies = Bodies::<D>::new(if D == 2 { Space::PlaneStrain } else { Space::Solid });
    bodies.add("block", mesh, degree, Elastic { youngs_modulus: 1.0, poissons_ratio: 0.3 });
    let supports = vec![Support {
        name: "top".into(),
        body: 0,
        group: groups["top"].clone(),
        kind: SupportKind::Components(vec![true; D]),
    }];
    let slave = bodies.surface(0, groups["bottom"].sides.clone());
    let contact = Contact::new("touch", slave, Master::Rigid);
    let mut model = Model::new(bodies, supports, vec![contact]).expect("a block that is held");
    let built = start.elapsed().as_secs_f64();
    let start = Instant::now();
    let mut centre = Point::<D>::zeros();
    centre[up] = -1.0;
    let now = Circumstances {
        displacement: &|_, _| Point::<D>::from_fn(|k, _| if k == up { -0.02 } else { 0.0 }),
        load: vec![0.0; model.bodies.unknowns()],
        rigid: vec![Some(Box::new(move |x: &Point<D>| signorini_contact::GapJet::ball(x, &centre, 1.0)))],
        motion: vec![],
    };
    let state = model.solve(&now, &mut |_, _| true).expect("a solution");
    let solved = start.elapsed().as_secs_f64();
    let active = state.contacts[0].nodes.iter().filter(|n| n.active).count();
    println!(
        "{D} dimensions, degree {degree}: {:>7} unknowns, {active:>4} nodes in contact, {} iterations; \
         assembled and factorised in {built:>7.2} s, solved in {solved:>6.2} s, {:>6.1} us per unknown; force {:.6}",
        state.unknowns,
        state.iterations,
        (built + solved) / state.unknowns as f64 * 1e6,
        state.contacts[0].force[up]
    );
}

fn main() {
    let largest: f64 = std::env::var("SIGNORINI_LADDER").ok().and_then(|v| v.parse().ok()).unwrap_or(50_000.0);
    for degree in [1, 2] {
        for n in [16usize, 32, 64, 128, 256, 384] {
            if 2.0 * ((n * degree + 1) as f64).powi(2) <= largest {
                run::<2>(n, degree);
            }
        }
        for n in [6usize, 10, 16, 24, 32, 46] {
            if 3.0 * ((n * degree + 1) as f64).powi(3) <= largest {
                run::<3>(n, degree);
            }
        }
    }
}
