//! Two elastic blocks that slide on each other at finite strain, each on facets of the other.

use super::*;
use signorini_solid::Volumetric;

const NEO_HOOKE: StressLaw = StressLaw::NeoHooke(Volumetric::Quadratic);

/// A short block pressed on a long one by `0.08` and slid along it by `slide` in so many increments: the forces on the upper
/// block, and the results.
fn slid(
    cells: [[usize; 2]; 2],
    (sampling, enforcement): (Sampling, Enforcement),
    mu: Option<f64>,
    (slide, increments): (f64, usize),
) -> (Vec<Vector<3>>, Vec<IncrementResult>) {
    let mut system = System::default();
    let lower = rectangle([0.0, 0.0], [4.0, 1.0], cells[0], 1, |x| x);
    // Round below, so that its edges do not dig in.
    let upper = rectangle([0.5, 1.0], [1.5, 1.5], cells[1], 1, |mut x| {
        let off = x[0] - 1.0;
        x[1] += 0.3 * off * off * (1.5 - x[1]) / 0.5;
        x
    });
    let stiff = Elastic { youngs_modulus: 3.0, ..ELASTIC };
    system.bodies.push(Box::new(solid("lower", lower, 1, ELASTIC, NEO_HOOKE)));
    system.bodies.push(Box::new(solid("upper", upper, 1, stiff, NEO_HOOKE)));
    system.supports.push(hold(0, "bottom", [Some(0.0), Some(0.0), None]));
    let mut held = hold(1, "top", [None, None, None]);
    let n = increments as f64;
    held.displacement[0] = Some(Arc::new(move |_, t| slide * (t - 4.0).max(0.0) / n));
    held.displacement[1] = Some(Arc::new(|_, t| -0.02 * t.min(4.0)));
    system.supports.push(held);
    touch(&mut system, [(1, "bottom"), (0, "top")], sampling, enforcement, mu);
    let times: Vec<f64> = (1..=4 + increments).map(|k| k as f64).collect();
    let (_, results) = run(&mut system, &times);
    for r in &results {
        let sum = r.support_forces[0][0] + r.support_forces[1][0];
        assert!(sum.norm() < 1e-8 * r.support_forces[1][0].norm().max(1e-6), "{sum}");
    }
    (results.iter().map(|r| force(r, 0)).collect(), results)
}

#[test]
fn one_slides_over_the_facets_of_the_other() {
    let wanted = Enforcement::Penalty { wanted_penetration: None };
    for how in [
        (Sampling::GaussPoints, wanted),
        (Sampling::Nodes, Enforcement::Multiplier),
        (Sampling::GaussPoints, Enforcement::AugmentedLagrangian),
    ] {
        for mu in [None, Some(0.3)] {
            let found = std::panic::catch_unwind(|| slid([[16, 4], [5, 3]], how, mu, (1.5, 12)));
            match found {
                Ok((forces, results)) => {
                    println!(
                        "{how:?} {mu:?}: {:?} mean {:.2}",
                        results.iter().map(|r| r.iterations).collect::<Vec<_>>(),
                        results.iter().skip(4).map(|r| r.iterations as f64).sum::<f64>() / 12.0
                    );
                }
                Err(_) => println!("{how:?} {mu:?}: stopped"),
            }
        }
    }
}
