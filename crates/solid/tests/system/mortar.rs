//! Contact by mortar in a system: patch test, balance, objectivity.

use super::*;
use signorini_solid::Volumetric;

const NEO_HOOKE: StressLaw = StressLaw::NeoHooke(Volumetric::Quadratic);
const KINDS: [Enforcement; 2] = [Enforcement::Multiplier, Enforcement::Penalty { wanted_penetration: None }];

/// Two blocks pressed together by a dead pressure: the largest deviation from the homogeneous state of one block, relative to
/// its displacement.
fn patch<const D: usize>(meshes: [Mesh<D>; 2], degree: usize, law: StressLaw, mu: Option<f64>) -> f64 {
    let mut system = System::default();
    for (name, mesh) in ["lower", "upper"].into_iter().zip(meshes) {
        system.bodies.push(Box::new(solid(name, mesh, degree, ELASTIC, law)));
    }
    let up = D - 1;
    let sides = ["left", "front"];
    for body in 0..2 {
        for (i, side) in sides.into_iter().enumerate().take(D - 1) {
            system.supports.push(hold(body, side, std::array::from_fn(|k| (k == i).then_some(0.0))));
        }
    }
    system.supports.push(hold(0, "bottom", std::array::from_fn(|k| (k == up).then_some(0.0))));
    system.supports.push(hold(1, "top", std::array::from_fn(|k| (k == up).then_some(-0.1))));
    touch(&mut system, [(1, "bottom"), (0, "top")], Test::Mortar(0), Enforcement::Multiplier, mu);
    let (state, results) = run(&mut system, &[1.0]);
    println!("{}", told(&results));
    // The displacement is linear: lateral stretch the same everywhere.
    let mut worst = 0.0f64;
    let mut lateral = None;
    for (body, state) in system.bodies.iter().zip(&state.bodies) {
        let fields = body.fields(state);
        for (x, u) in fields.points.iter().zip(&fields.displacement) {
            worst = worst.max((u[up] + 0.1 * x[up]).abs());
            if x[0] > 1e-3 {
                let stretch = u[0] / x[0];
                worst = worst.max((stretch - *lateral.get_or_insert(stretch)).abs());
            }
        }
    }
    worst / 0.1
}

#[test]
fn a_patch_passes_in_the_plane() {
    for degree in 1..=3 {
        for law in [StressLaw::LinearElastic, NEO_HOOKE] {
            for mu in [None, Some(0.4)] {
                for cells in [[3, 4], [5, 2]] {
                    let lower = rectangle([0.0, 0.0], [1.0, 0.5], [cells[0], 2], 1, |x| x);
                    let upper = rectangle([0.0, 0.5], [1.0, 1.0], [cells[1], 2], 1, |x| x);
                    let error = patch([lower, upper], degree, law, mu);
                    println!("degree {degree} {} {mu:?} {cells:?}: {error:.1e}", law.name());
                    assert!(error < 1e-10, "degree {degree} {} {mu:?} {cells:?}: {error:e}", law.name());
                }
            }
        }
    }
}

#[test]
fn a_patch_passes_in_space() {
    for (degree, law, mu, cells) in [
        (1, StressLaw::LinearElastic, None, [2, 3]),
        (1, NEO_HOOKE, Some(0.4), [3, 2]),
        (2, NEO_HOOKE, None, [1, 2]),
    ] {
        let block = |low: f64, high: f64, n: usize| cuboid([0.0, 0.0, low], [1.0, 1.0, high], [n, n, 1], |x| x);
        let error = patch([block(0.0, 0.5, cells[0]), block(0.5, 1.0, cells[1])], degree, law, mu);
        println!("degree {degree} {} {mu:?} {cells:?}: {error:.1e}", law.name());
        assert!(error < 1e-10, "degree {degree} {} {mu:?} {cells:?}: {error:e}", law.name());
    }
}

/// Two blocks with tractions between them in any state: resultant and moment of what acts, relative to the forces.
fn balance<const D: usize>(meshes: [Mesh<D>; 2]) -> f64 {
    let mut system = System::default();
    for (name, mesh) in ["upper", "lower"].into_iter().zip(meshes) {
        system.bodies.push(Box::new(solid(name, mesh, 2, ELASTIC, StressLaw::LinearElastic)));
    }
    touch(&mut system, [(0, "bottom"), (1, "top")], Test::Mortar(0), Enforcement::Multiplier, Some(0.3));
    system.prepare().unwrap();
    let start = system.start();
    let counts: Vec<usize> = system.bodies.iter().map(|b| b.unknowns()).collect();
    let count: usize = counts.iter().sum();
    let seed = &mut 7u64;
    let mut step: Vec<f64> = (0..count + start.multipliers.len()).map(|_| 0.02 * noise(seed)).collect();
    let mut residual = |traction: f64| {
        step[count..].iter_mut().for_each(|t| *t = traction);
        system.linearise(&system.advance(&start, &step, 1.0), 0.0).unwrap().0
    };
    let (with, without) = (residual(1.0), residual(0.0));
    let state = system.advance(&start, &step, 1.0);
    let forces: Vec<f64> = with.iter().zip(&without).take(count).map(|(a, b)| a - b).collect();
    let size = forces.iter().map(|f| f.abs()).sum::<f64>();
    let mut totals = [0.0; 6];
    let mut first = 0;
    for ((body, state), n) in system.bodies.iter().zip(&state.bodies).zip(counts) {
        for (total, mode) in totals.iter_mut().zip(body.rigid_modes(state)) {
            *total += mode.iter().zip(&forces[first..first + n]).map(|(m, f)| m * f).sum::<f64>();
        }
        first += n;
    }
    totals.iter().fold(0.0f64, |m, t| m.max(t.abs())) / size
}

#[test]
fn forces_and_moments_balance() {
    let upper = rectangle([0.1, 0.1], [0.9, 0.5], [3, 1], 2, |x| x);
    let lower = rectangle([0.0, -0.5], [1.0, 0.0], [4, 1], 2, |x| x);
    let plane = balance([upper, lower]);
    let upper = cuboid([0.1, 0.1, 0.1], [0.9, 0.8, 0.5], [2, 1, 1], |x| x);
    let lower = cuboid([0.0, 0.0, -0.5], [1.0, 1.0, 0.0], [1, 2, 1], |x| x);
    let space = balance([upper, lower]);
    println!("{plane:e} {space:e}");
    assert!(plane < 1e-14 && space < 1e-14, "{plane:e} {space:e}");
}

#[test]
fn what_sticks_turns_without_slip() {
    for kind in KINDS {
        let mut system = System::default();
        let lower = rectangle([0.0, 0.0], [1.0, 0.5], [4, 2], 1, |x| x);
        let upper = rectangle([0.0, 0.5], [1.0, 1.0], [3, 2], 1, |x| x);
        system.bodies.push(Box::new(solid("lower", lower, 2, ELASTIC, NEO_HOOKE)));
        system.bodies.push(Box::new(solid("upper", upper, 2, ELASTIC, NEO_HOOKE)));
        // Pressed at time 1 and sheared, at time 2 both ends are turned by 0.7.
        let held = |body: usize, group: &str, press: [f64; 2]| {
            let mut out = hold(body, group, [None; 3]);
            for i in 0..2 {
                out.displacement[i] = Some(Arc::new(move |x: &Point<3>, t: f64| {
                    let moved = x + v(press[0], press[1], 0.0) * t.min(1.0);
                    let (s, c) = (0.7 * (t - 1.0).max(0.0)).sin_cos();
                    v(c * moved.x - s * moved.y, s * moved.x + c * moved.y, 0.0)[i] - x[i]
                }));
            }
            out
        };
        system.supports.push(held(0, "bottom", [0.0, 0.0]));
        system.supports.push(held(1, "top", [0.01, -0.05]));
        touch(&mut system, [(1, "bottom"), (0, "top")], Test::Mortar(0), kind, Some(0.8));
        let (_, results) = run(&mut system, &[1.0, 2.0]);
        let [before, after] = [0, 1].map(|k| &results[k].sites[0]);
        let slip = after.iter().map(|s| s.increment.norm()).fold(0.0f64, f64::max);
        println!("{kind:?} slip {slip:e}, {}", told(&results));
        assert!(before.iter().all(|s| s.status != signorini_contact::Status::Slip));
        assert!(slip < 1e-12, "{slip:e}");
        let [f, g] = [force(&results[0], 0), force(&results[1], 0)];
        let (s, c) = 0.7f64.sin_cos();
        let turned = v(c * f.x - s * f.y, s * f.x + c * f.y, 0.0);
        assert!((turned - g).norm() < 1e-8 * g.norm(), "{turned} {g}");
    }
}
