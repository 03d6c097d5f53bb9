//! Of `rotation`.

use signorini_geometry::{Matrix, Vector};
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
