//! Of `quaternion`.

use signorini_geometry::{Matrix, Vector};
use signorini_rope::quaternion::{
    conjugate, exponential, inverse_tangent_map, logarithm, of_rotation, product, pure, rotation, spin_map, vector,
};

fn samples() -> Vec<Vector<3>> {
    (0..40)
        .map(|k| {
            let k = k as f64;
            Vector::<3>::new((1.3 * k).sin(), (2.1 * k + 0.4).cos(), (0.7 * k).sin()) * (0.05 + 0.07 * k)
        })
        .collect()
}

#[test]
fn rotations_agree_in_all_their_forms() {
    for theta in samples() {
        let q = exponential(&theta);
        let r = rotation(&q);
        assert!((r - rotation(&(q * 3.0))).norm() < 1e-14);
        assert!((r * r.transpose() - Matrix::<3>::identity()).norm() < 1e-14);
        let v = Vector::<3>::new(0.3, -0.7, 1.1);
        let turned = vector(&product(&product(&q, &pure(&v)), &conjugate(&q)));
        assert!((r * v - turned).norm() < 1e-14);
        let back = of_rotation(&r);
        assert!((back - q).norm().min((back + q).norm()) < 1e-14);
        assert!((rotation(&exponential(&logarithm(&q))) - r).norm() < 1e-13);
    }
}

#[test]
fn maps_of_the_spin_are_derivatives() {
    let theta = Vector::<3>::new(0.2, 0.5, -0.4);
    for phi in samples().into_iter().filter(|p| p.norm() < 3.0) {
        let q = exponential(&phi);
        let e = 1e-6;
        let moved = |s: f64| product(&exponential(&(theta * s)), &q);
        let dq = (moved(e) - moved(-e)) / (2.0 * e);
        assert!((dq - spin_map(&q) * theta).norm() < 1e-9);
        let dphi = (logarithm(&moved(e)) - logarithm(&moved(-e))) / (2.0 * e);
        assert!((dphi - inverse_tangent_map(&phi) * theta).norm() < 1e-8 * dphi.norm().max(1.0));
    }
}
