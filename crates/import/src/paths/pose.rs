//! Where a frame stands: a rotation and the place of its origin.

use nalgebra::{Matrix3, Quaternion, Rotation3, UnitQuaternion};
use signorini_geometry::Vector;

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Pose {
    pub(super) rotation: Matrix3<f64>,
    pub(super) origin: Vector<3>,
}

impl Pose {
    pub(super) fn rest() -> Self {
        Self { rotation: Matrix3::identity(), origin: Vector::<3>::zeros() }
    }

    pub(super) fn point(&self, x: &Vector<3>) -> Vector<3> {
        self.origin + self.rotation * x
    }

    pub(super) fn direction(&self, v: &Vector<3>) -> Vector<3> {
        self.rotation * v
    }

    /// A pose that is stated in this frame.
    pub(super) fn then(&self, inner: &Pose) -> Self {
        Self { rotation: self.rotation * inner.rotation, origin: self.point(&inner.origin) }
    }

    /// The frame in which this one is the frame of space.
    pub(super) fn inverse(&self) -> Self {
        let back = self.rotation.transpose();
        Self { rotation: back, origin: -(back * self.origin) }
    }

    /// The rotation vector, in radians.
    pub(super) fn rotation_vector(&self) -> Vector<3> {
        Rotation3::from_matrix_unchecked(self.rotation).scaled_axis()
    }
}

/// The rotation by an angle about a direction; none about zero.
pub(super) fn about(axis: &Vector<3>, angle: f64) -> Matrix3<f64> {
    match axis.try_normalize(0.0) {
        Some(axis) => Rotation3::new(axis * angle).into_inner(),
        None => Matrix3::identity(),
    }
}

/// The rotation of a quaternion, its real part first; of any length but zero.
pub(super) fn of_quaternion([w, x, y, z]: [f64; 4]) -> Option<Matrix3<f64>> {
    let q = Quaternion::new(w, x, y, z);
    (q.norm() > 0.0).then(|| UnitQuaternion::from_quaternion(q).to_rotation_matrix().into_inner())
}

/// Angles about axes one after the other: `x`, `y`, `z` turn with the body, `X`, `Y`, `Z` stay. `None` if the letters are others.
pub(super) fn of_angles(sequence: &str, angles: [f64; 3]) -> Option<Matrix3<f64>> {
    let mut out = Matrix3::identity();
    let letters: Vec<char> = sequence.chars().collect();
    if letters.len() != 3 {
        return None;
    }
    for (letter, angle) in letters.into_iter().zip(angles) {
        let axis = match letter.to_ascii_lowercase() {
            'x' => Vector::<3>::x(),
            'y' => Vector::<3>::y(),
            'z' => Vector::<3>::z(),
            _ => return None,
        };
        let turn = about(&axis, angle);
        out = if letter.is_ascii_lowercase() { out * turn } else { turn * out };
    }
    Some(out)
}
