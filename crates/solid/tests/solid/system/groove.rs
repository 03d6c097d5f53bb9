//! A free rigid ball between two elastic blocks that make a groove.

use super::*;
use signorini_geometry::rigid_shape::Sphere;

fn settled(mu: Option<f64>, law: StressLaw, enforcement: Enforcement) -> (SystemState, IncrementResult) {
    let radius = 0.5;
    let centre = v(0.0, 0.03, radius * 2f64.sqrt() + 0.02);
    let site = RigidSite { x: centre, outward: None, radius, weight: 1.0 };
    let ball = RigidBody {
        name: "ball".into(),
        shape: Arc::new(Sphere { center: centre, radius }),
        motion: Motion::Free { plane: false },
        centre,
        sites: vec![site],
        size: 2.0 * radius,
        mass: None,
    };
    let mut system = System::default();
    system.bodies.push(Box::new(ball));
    // Blocks whose upper sides rise to either side of x = 0 at 45 degrees.
    for side in [-1.0, 1.0] {
        let mesh = cuboid([0.0, -0.5, -0.5], [1.0, 0.5, 0.0], [3, 3, 2], |x| {
            let across = if side > 0.0 { x[0] } else { 1.0 - x[0] };
            Point::<3>::new(side * across, x[1], x[2] + across * (1.0 + x[2] / 0.5))
        });
        let name = if side > 0.0 { "right block" } else { "left block" };
        system.bodies.push(Box::new(solid(name, mesh, 1, ELASTIC, law.clone())));
    }
    for block in 1..3 {
        system.supports.push(hold(block, "bottom", [Some(0.0); 3]));
    }
    system.loads.push(load(0, "", TimedLoad::Force(Arc::new(|_, _| v(0.0, 0.0, -2e-2)))));
    system.supports.push(hold(0, "", [None, Some(0.0), None]));
    for block in 1..3 {
        touch(&mut system, [(0, ""), (block, "top")], Sampling::Nodes, enforcement, mu);
    }
    let (state, mut results) = run(&mut system, &[1.0]);
    (state, results.remove(0))
}

fn check(law: StressLaw, enforcement: Enforcement, mu: Option<f64>) {
    let (state, result) = settled(mu, law.clone(), enforcement);
    let forces = [force(&result, 0), force(&result, 1)];
    // What keeps the ball from moving along the groove carries what the mesh, unlike to both sides, leaves there.
    let total = forces[0] + forces[1] + result.support_forces[2][0];
    assert!((total - v(0.0, 0.0, 2e-2)).norm() < 1e-9 * 2e-2, "{enforcement:?} {mu:?}: {total}");
    assert!(result.imbalance < 1e-9);
    // By symmetry each side carries half of the weight, and so is pushed to the side by the same force.
    assert!((forces[0][2] - 1e-2).abs() < 1e-8, "{mu:?}: {forces:?}");
    assert!((forces[0][0] + forces[1][0]).abs() < 1e-9);
    let site = result.sites[0][0];
    if mu.is_none() {
        // Without friction the force is along the normal, at 45 degrees but for what the block gives way.
        let normal = site.normal * site.normal.dot(&forces[0]);
        assert!((normal - forces[0]).norm() < 1e-10, "{forces:?}");
        assert!((forces[0][0].abs() - 1e-2).abs() < 2e-3, "{forces:?}");
    } else {
        let across = site.friction.norm();
        assert!(across <= 0.3 * site.pressure * (1.0 + 1e-9), "{site:?}");
    }
    assert!(state.bodies[0].configuration[0].abs() < 1e-8);
    println!("{} {enforcement:?} {mu:?}: {} iterations, {forces:?}", law.name(), result.iterations);
}

#[test]
fn a_ball_settles_between_two_blocks() {
    check(StressLaw::LinearElastic, Enforcement::AugmentedLagrangian, None);
}
