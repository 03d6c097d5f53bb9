//! Changes of the unit of length, rotations and translations of space.

use crate::{Matrix, Point, Vector};

/// A change of the unit of length, then a rotation and a translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Similarity {
    pub factor: f64,
    pub rotation: Matrix<3>,
    pub translation: Vector<3>,
}

impl Similarity {
    pub fn scaling(factor: f64) -> Self {
        Similarity { factor, rotation: Matrix::<3>::identity(), translation: Vector::<3>::zeros() }
    }

    /// Where a position goes.
    pub fn point(&self, x: &Point<3>) -> Point<3> {
        self.rotation * (x * self.factor) + self.translation
    }

    /// Where a difference of positions goes.
    pub fn vector(&self, v: &Vector<3>) -> Vector<3> {
        self.rotation * (v * self.factor)
    }

    /// Where a direction goes.
    pub fn direction(&self, e: &Vector<3>) -> Vector<3> {
        self.rotation * e
    }

    /// The box around a moved box.
    pub fn hull(&self, [low, high]: &[Point<3>; 2]) -> [Point<3>; 2] {
        if self.rotation == Matrix::<3>::identity() {
            return [self.point(low), self.point(high)];
        }
        let (middle, half) =
            (self.point(&((low + high) * 0.5)), self.rotation.abs() * ((high - low) * (0.5 * self.factor)));
        [middle - half, middle + half]
    }
}
