//! One increment in time: its tangent against differences, and a free rotation, which keeps angular momentum and energy.

use crate::common::{rigid, v};
use signorini_geometry::rigid_shape::Sphere;
use signorini_geometry::{Matrix, Vector};
use signorini_mechanics::rigid_body::{Motion, Pose, RigidMass};
use signorini_mechanics::system::{PlacedLoad, System, SystemState, TimedLoad};
use signorini_mechanics::testing::{assembled, in_time};
use signorini_mechanics::{Dynamics, Order, Part};
use std::sync::Arc;

const INERTIA: [f64; 3] = [1.0, 2.0, 3.5];
const SPIN: [f64; 3] = [0.7, -1.1, 2.0];

/// A free body that spins, in a step of a duration; with a force and a moment where it is pushed.
fn spinning(duration: f64, dynamics: Dynamics, is_pushed: bool) -> (System, SystemState) {
    let shape = Sphere { center: v(0.1, 0.2, 0.3), radius: 0.5 };
    let mut body = rigid("top", shape, Motion::Free { plane: false }, Vec::new());
    let inertia = Matrix::<3>::from_diagonal(&Vector::<3>::from(INERTIA));
    let (velocity, angular_velocity) = (v(0.3, -0.2, 0.5), Vector::<3>::from(SPIN));
    body.mass = Some(RigidMass { mass: 2.0, inertia, velocity, angular_velocity });
    let mut system = System { bodies: vec![Box::new(body)], dynamics: Some(dynamics), ..System::default() };
    if is_pushed {
        for load in
            [TimedLoad::Force(Arc::new(|_, _| v(1.0, 2.0, 3.0))), TimedLoad::Moment(Arc::new(|_, _| v(0.2, 0.5, -0.4)))]
        {
            system.loads.push(PlacedLoad { name: "push".into(), part: Part::from(0), load });
        }
    }
    system.weigh(true).unwrap();
    let mut start = system.start();
    start.velocities = system.bodies[0].initial_velocity();
    in_time(&mut system, &mut start, duration).unwrap();
    (system, start)
}

#[test]
fn the_tangent_is_that_of_differences() {
    let dynamics = Dynamics { spectral_radius: 1.0, damping: [0.3, 0.0], tells_error: false };
    let (system, start) = spinning(0.4, dynamics, false);
    let at = system.advance(&start, &[0.1, -0.2, 0.3, 0.5, -0.8, 0.6], 1.0);
    let (_, tangent) = assembled(&system, &at, Order::Second).unwrap();
    const H: f64 = 1e-5;
    for column in 0..6 {
        let beside = |sign: f64| {
            let mut step = [0.0; 6];
            step[column] = sign * H;
            assembled(&system, &system.advance(&at, &step, 1.0), Order::First).unwrap().0
        };
        let (high, low) = (beside(1.0), beside(-1.0));
        for row in 0..6 {
            let entries = tangent.list().filter(|e| (e.0 as usize, e.1 as usize) == (row, column));
            let (found, wanted): (f64, f64) = (entries.map(|e| e.2).sum(), (high[row] - low[row]) / (2.0 * H));
            assert!((found - wanted).abs() < 1e-7 * (1.0 + wanted.abs()), "{row} {column}: {found} {wanted}");
        }
    }
}

/// The state that solves the step, by Newton's method.
fn solved(system: &System, start: &SystemState) -> SystemState {
    let mut at = start.clone();
    for _ in 0..12 {
        let (residual, tangent) = assembled(system, &at, Order::Second).unwrap();
        let mut matrix = nalgebra::SMatrix::<f64, 6, 6>::zeros();
        tangent.list().for_each(|(i, j, v)| matrix[(i as usize, j as usize)] += v);
        let right = -nalgebra::SVector::<f64, 6>::from_column_slice(&residual);
        at = system.advance(&at, matrix.lu().solve(&right).unwrap().as_slice(), 1.0);
    }
    at
}

#[test]
fn a_free_rotation_keeps_its_angular_momentum_and_energy() {
    const DURATION: f64 = 0.6;
    let (system, start) =
        spinning(DURATION, Dynamics { spectral_radius: 1.0, damping: [0.0; 2], tells_error: false }, false);
    let pose = Pose::of(&solved(&system, &start).bodies[0]);
    let inertia = Matrix::<3>::from_diagonal(&Vector::<3>::from(INERTIA));
    let before = Vector::<3>::from(SPIN);
    // By the formula of the method, with the rotation that was found.
    let after = pose.turn * (2.0 / DURATION) - pose.matrix() * before;
    let momentum = pose.matrix() * inertia * pose.matrix().transpose() * after;
    assert!((momentum - inertia * before).norm() < 1e-12, "{momentum}");
    assert!((momentum.dot(&after) - before.dot(&(inertia * before))).abs() < 1e-12);
    assert!((pose.centre - v(0.1, 0.2, 0.3) - v(0.3, -0.2, 0.5) * DURATION).norm() < 1e-13);
}

/// Loads act with their mean: the impulse is that of a constant force, and of a moment that keeps its direction.
#[test]
fn loads_change_momenta_by_their_impulse() {
    const DURATION: f64 = 0.1;
    let (system, start) =
        spinning(DURATION, Dynamics { spectral_radius: 1.0, damping: [0.0; 2], tells_error: false }, true);
    let pose = Pose::of(&solved(&system, &start).bodies[0]);
    let moved = v(0.3, -0.2, 0.5) * DURATION + v(1.0, 2.0, 3.0) * (0.5 * DURATION * DURATION / 2.0);
    assert!((pose.centre - v(0.1, 0.2, 0.3) - moved).norm() < 1e-13);
    let inertia = Matrix::<3>::from_diagonal(&Vector::<3>::from(INERTIA));
    let before = Vector::<3>::from(SPIN);
    let after = pose.turn * (2.0 / DURATION) - pose.matrix() * before;
    let momentum = pose.matrix() * inertia * pose.matrix().transpose() * after;
    assert!((momentum - inertia * before - v(0.2, 0.5, -0.4) * DURATION).norm() < 1e-12, "{momentum}");
}
