//! Of `rotation`.

use crate::common::{ball, v};
use nalgebra::UnitQuaternion;
use signorini_geometry::{Matrix, Vector};
use signorini_mechanics::body::{Body, Kinematics};
use signorini_mechanics::rigid_body::{Motion, Pose};
use signorini_mechanics::testing::{between, of_spin, of_spin_change, spin, turn, unwrapped, whole_turns};
use std::f64::consts::TAU;

#[test]
fn whole_turns_are_kept() {
    for angle in [0.3, 3.0, 4.0, TAU, 7.0, -9.0, 31.4] {
        let to = Vector::<3>::new(0.0, 0.0, angle);
        assert!((between(&Vector::<3>::zeros(), &to) - to).norm() < 1e-12, "{angle}");
        assert!((to - whole_turns(&to)).norm() <= std::f64::consts::PI + 1e-12);
    }
}

#[test]
fn derivatives_are_those_of_differences() {
    let psi = Vector::<3>::new(0.3, -1.2, 0.8);
    let (way, v) = (Vector::<3>::new(-0.4, 0.2, 0.7), Vector::<3>::new(1.0, 0.5, -0.3));
    for scale in [1.0, 0.05, 0.08] {
        let psi = psi * scale;
        let h = 1e-6;
        let along = |h: f64| unwrapped(&(turn(&(way * h)) * turn(&psi)), &psi);
        let slope = (along(h) - along(-h)) / (2.0 * h);
        assert!((slope - of_spin(&psi) * way).norm() < 1e-9);
        assert!((of_spin(&psi) * spin(&psi) - Matrix::<3>::identity()).norm() < 1e-12);
        let of = |h: f64| of_spin(&(psi + way * h)) * v;
        assert!(((of(h) - of(-h)) / (2.0 * h) - of_spin_change(&psi, &way, &v)).norm() < 1e-9);
    }
}

/// A body that turns about an axis that wanders tells how far it turned in all, whole turns included, and its rotation apart from that.
#[test]
fn whole_turns_are_summed_about_a_wandering_axis() {
    let body = ball(Vector::<3>::zeros(), 1.0, Motion::Free { plane: false });
    let mut state = body.start();
    let mut sum = Vector::<3>::zeros();
    for k in 0..100 {
        let (before, angle) = (state.clone(), 0.1 * f64::from(k));
        let turn = v(0.1 * angle.cos(), 0.1 * angle.sin(), 0.3);
        state = body.advance(&state, &[0.0, 0.0, 0.0, turn.x, turn.y, turn.z], 1.0);
        sum += turn;
        let pose = Pose::of(&state);
        assert!((pose.turned - sum).norm() < 1e-12);
        // Between two states it takes the way that it took.
        let half = Pose::of(&body.between(&before, &state, 0.5));
        assert!((half.turned - (sum - turn * 0.5)).norm() < 1e-9, "{k}: {half:?}");
        let told = UnitQuaternion::from_scaled_axis(pose.turn);
        assert!(told.angle_to(&pose.rotation) < 1e-7);
    }
    assert!(sum.z > 4.0 * std::f64::consts::TAU);
}
