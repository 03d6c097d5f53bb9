//! Two elastic blocks that slide on each other at finite strain, each on facets of the other.

use super::*;
use signorini_solid::Volumetric;

type How = (Test, Enforcement);
const NEO_HOOKE: StressLaw = StressLaw::NeoHooke(Volumetric::Quadratic);
const PENALTY: How = (Test::Sites(Sampling::GaussPoints), Enforcement::Penalty { wanted_penetration: None });
const AUGMENTED: How = (Test::Sites(Sampling::GaussPoints), Enforcement::AugmentedLagrangian);
const MULTIPLIER: How = (Test::Sites(Sampling::Nodes), Enforcement::Multiplier);
const MORTAR: How = (Test::Mortar(0), Enforcement::Multiplier);

/// Increments that press, before those that slide.
const PRESSING: usize = 4;

/// A block that is held below, and another one that is pressed on it by `depth`, and slides along it. Force on the upper
/// block after each increment, and the results.
fn slid<const D: usize>(
    [lower, upper]: [Mesh<D>; 2],
    (test, enforcement): How,
    mu: Option<f64>,
    (depth, slide, increments): (f64, f64, usize),
) -> (Vec<Vector<3>>, Vec<IncrementResult>) {
    let mut system = System::default();
    let stiff = Elastic { youngs_modulus: 3.0, ..ELASTIC };
    system.bodies.push(Box::new(solid("lower", lower, 1, ELASTIC, NEO_HOOKE)));
    system.bodies.push(Box::new(solid("upper", upper, 1, stiff, NEO_HOOKE)));
    let across = (D == 3).then_some(0.0);
    system.supports.push(hold(0, "bottom", [Some(0.0), Some(0.0), across]));
    let mut held = hold(1, "top", [None, None, None]);
    let (pressing, n) = (PRESSING as f64, increments as f64);
    held.displacement[0] = Some(Arc::new(move |_, t| slide * (t - pressing).max(0.0) / n));
    held.displacement[D - 1] = Some(Arc::new(move |_, t| -depth * t.min(pressing) / pressing));
    if D == 3 {
        held.displacement[1] = Some(Arc::new(|_, _| 0.0));
    }
    system.supports.push(held);
    touch(&mut system, [(1, "bottom"), (0, "top")], test, enforcement, mu);
    let times: Vec<f64> = (1..=PRESSING + increments).map(|k| k as f64).collect();
    let (_, results) = run(&mut system, &times);
    for r in &results {
        let [below, above] = [r.support_forces[0][0], r.support_forces[1][0]];
        assert!((below + above).norm() < 1e-8 * above.norm(), "{below} {above}");
        assert!((force(r, 0) + above).norm() < 1e-8 * above.norm());
    }
    (results.iter().map(|r| force(r, 0)).collect(), results)
}

/// A strip, and a block that is round below, so that its edges do not dig in.
fn strips(finer: usize) -> [Mesh<2>; 2] {
    let lower = rectangle([0.0, 0.0], [4.0, 1.0], [16 * finer, 4 * finer], 1, |x| x);
    let upper = rectangle([0.5, 1.0], [1.5, 1.5], [5 * finer, 3 * finer], 1, |mut x| {
        x[1] += 0.6 * (x[0] - 1.0).powi(2) * (1.5 - x[1]);
        x
    });
    [lower, upper]
}

fn mean(results: &[IncrementResult]) -> f64 {
    let sliding = &results[PRESSING..];
    sliding.iter().map(|r| r.iterations as f64).sum::<f64>() / sliding.len() as f64
}

#[test]
fn one_slides_over_the_facets_of_the_other() {
    let mut all = Vec::new();
    for (how, most) in [(PENALTY, 9.0), (MULTIPLIER, 7.0), (AUGMENTED, 18.0), (MORTAR, 7.0)] {
        for mu in [None, Some(0.3)] {
            // Half a facet an increment.
            let (forces, results) = slid(strips(1), how, mu, (0.08, 1.5, 12));
            println!("{how:?} {mu:?}: mean {:.2}, {}", mean(&results), told(&results));
            println!("  {:?}", forces.iter().skip(PRESSING - 1).map(|f| (f[0], f[1])).collect::<Vec<_>>());
            assert!(mean(&results) <= most, "{how:?} {mu:?}: {}", told(&results));
            let last = forces.last().unwrap();
            // Ploughing adds little to friction.
            let ratio = -last[0] / last[1];
            assert!((ratio - mu.unwrap_or(0.0)).abs() < 0.02, "{how:?} {mu:?}: {ratio}");
            all.push(last[1]);
        }
    }
    // All ways to the same force.
    assert!(all.iter().all(|f| (f / all[0] - 1.0).abs() < 0.06), "{all:?}");
}

#[test]
fn a_finer_mesh_has_the_same_forces() {
    let of = |finer: usize| slid(strips(finer), MULTIPLIER, Some(0.3), (0.08, 0.5, 4));
    let [(coarse, _), (fine, results)] = [1, 2].map(of);
    println!("{coarse:?}\n{fine:?}\n{}", told(&results));
    let (c, f) = (coarse.last().unwrap(), fine.last().unwrap());
    assert!((c[1] / f[1] - 1.0).abs() < 0.05 && (c[0] / f[0] - 1.0).abs() < 0.05, "{c} {f}");
    assert!(mean(&results) <= 9.0, "{}", told(&results));
}

#[test]
fn one_slides_over_the_facets_of_the_other_in_space() {
    let blocks = || {
        let lower = cuboid([0.0; 3], [2.0, 1.0, 0.5], [6, 3, 2], |x| x);
        let upper = cuboid([0.3, 0.2, 0.5], [0.9, 0.8, 0.9], [2, 2, 1], |mut x| {
            let off = [x[0] - 0.6, x[1] - 0.5];
            x[2] += 0.3 * (off[0] * off[0] + off[1] * off[1]) * (0.9 - x[2]);
            x
        });
        [lower, upper]
    };
    for (how, mu) in
        [(PENALTY, Some(0.3)), (MULTIPLIER, None), (MULTIPLIER, Some(0.3)), (MORTAR, None), (MORTAR, Some(0.3))]
    {
        let (forces, results) = slid(blocks(), how, mu, (0.06, 0.6, 4));
        println!("{how:?} {mu:?}: {} {:?}", told(&results), forces.last());
        assert!(mean(&results) <= 9.0, "{how:?} {mu:?}: {}", told(&results));
        let last = forces.last().unwrap();
        assert!((-last[0] / last[2] - mu.unwrap_or(0.0)).abs() < 0.03 && last[1].abs() < 0.01 * last[2], "{last}");
    }
}
