//! Of `beam::element`.

use signorini_geometry::Vector;
use signorini_rope::beam::element::{CENTRELINE, Element, Forces, Nodes, SPINS};
use signorini_rope::quaternion::{exponential, product, rotation};
use signorini_rope::section::Stiffness;

fn stiffness() -> Stiffness {
    Stiffness { axial: 30.0, shear: [11.0, 9.0], torsion: 2.0, bending: [1.5, 2.5] }
}

fn moved(nodes: &Nodes, step: &Forces, share: f64) -> Nodes {
    let part = |k: usize| Vector::<3>::new(step[k], step[k + 1], step[k + 2]) * share;
    Nodes {
        centreline: std::array::from_fn(|n| nodes.centreline[n] + part(CENTRELINE[n])),
        rotations: std::array::from_fn(|a| product(&exponential(&part(SPINS[a])), &nodes.rotations[a])),
    }
}

fn direction(seed: f64) -> Forces {
    Forces::from_fn(|k, _| (seed + 1.7 * k as f64 * (1.0 + seed)).sin())
}

/// A curved reference and a state far from it.
fn example() -> (Element, Nodes) {
    let straight = Nodes {
        centreline: [
            Vector::<3>::zeros(),
            Vector::<3>::x(),
            Vector::<3>::new(1.1, 0.1, 0.0),
            Vector::<3>::new(0.98, 0.2, 0.0),
        ],
        rotations: [Vector::<3>::zeros(), Vector::<3>::new(0.0, 0.0, 0.2), Vector::<3>::new(0.05, 0.0, 0.1)]
            .map(|t| exponential(&t)),
    };
    let element = Element::new(1.1, stiffness(), &straight);
    let bent = moved(&straight, &direction(0.3), 0.4);
    (element, bent)
}

#[test]
fn forces_and_tangent_are_derivatives_of_the_energy() {
    let (element, nodes) = example();
    let tangent = element.tangent(&nodes, &element.stresses(&nodes));
    assert!((tangent - tangent.transpose()).norm() < 1e-13 * tangent.norm());
    let (energy, forces) = element.forces(&nodes);
    // Taylor: what the expansion to second order leaves falls with the cube of the step.
    for seed in [0.1, 0.9, 2.3] {
        let v = direction(seed);
        let left = |e: f64| {
            let exact = element.forces(&moved(&nodes, &v, e)).0;
            (exact - energy - e * forces.dot(&v) - 0.5 * e * e * v.dot(&(tangent * v))).abs()
        };
        let order = (left(2e-2) / left(1e-2)).log2();
        assert!((order - 3.0).abs() < 0.15, "{order}");
        let first = (element.forces(&moved(&nodes, &v, 1e-5)).0 - element.forces(&moved(&nodes, &v, -1e-5)).0) / 2e-5;
        assert!((first - forces.dot(&v)).abs() < 1e-8 * forces.norm());
    }
    // Of the components of the forces, the derivative is the tangent less half the cross matrix of each moment.
    let e = 1e-5;
    for seed in [0.4, 1.9] {
        let v = direction(seed);
        let difference =
            (element.forces(&moved(&nodes, &v, e)).1 - element.forces(&moved(&nodes, &v, -e)).1) / (2.0 * e);
        let mut expected = tangent * v;
        for at in SPINS {
            let m = Vector::<3>::new(forces[at], forces[at + 1], forces[at + 2]);
            let spin = Vector::<3>::new(v[at], v[at + 1], v[at + 2]);
            let turn = m.cross(&spin) * 0.5;
            (0..3).for_each(|i| expected[at + i] -= turn[i]);
        }
        assert!((difference - expected).norm() < 1e-8 * expected.norm());
    }
}

#[test]
fn rigid_motions_leave_no_stress_and_forces_balance() {
    let (element, nodes) = example();
    let (energy, forces) = element.forces(&nodes);
    let (turn, shift) = (exponential(&Vector::<3>::new(1.1, -2.0, 0.7)), Vector::<3>::new(3.0, -1.0, 2.0));
    let r = rotation(&turn);
    let rigid = Nodes {
        centreline: std::array::from_fn(|n| {
            r * nodes.centreline[n] + if n % 2 == 0 { shift } else { Vector::<3>::zeros() }
        }),
        rotations: nodes.rotations.map(|q| product(&turn, &q)),
    };
    let (turned_energy, turned) = element.forces(&rigid);
    assert!((energy - turned_energy).abs() < 1e-13 * energy);
    let mut resultant = Vector::<3>::zeros();
    let mut moment = Vector::<3>::zeros();
    for block in 0..7 {
        let of = |f: &Forces| Vector::<3>::new(f[3 * block], f[3 * block + 1], f[3 * block + 2]);
        assert!((r * of(&forces) - of(&turned)).norm() < 1e-13 * forces.norm());
        let f = of(&forces);
        match CENTRELINE.iter().position(|&c| c == 3 * block) {
            Some(n) => {
                moment += nodes.centreline[n].cross(&f);
                if n % 2 == 0 {
                    resultant += f;
                }
            }
            None => moment += f,
        }
    }
    assert!(resultant.norm() < 1e-13 * forces.norm() && moment.norm() < 1e-13 * forces.norm());
}

#[test]
fn predicted_stresses_are_linear_in_the_step() {
    let (element, nodes) = example();
    let v = direction(0.6);
    let now = element.stresses(&nodes);
    let left = |e: f64| {
        let (exact, predicted) = (element.stresses(&moved(&nodes, &v, e)), element.predicted(&nodes, &(v * e)));
        (0..8).map(|k| (exact[k] - predicted[k]).norm()).fold(0.0, f64::max)
    };
    assert!((left(2e-3) / left(1e-3)).log2() > 1.9);
    assert!((0..8).all(|k| (element.predicted(&nodes, &Forces::zeros())[k] - now[k]).norm() == 0.0));
}
