//! Closed forms of the height in which a rigid shape is seen from above or below.

use crate::height_field::{HeightField, View};
use crate::{Jet, Point, Real, Vector};
use std::sync::Arc;

/// Why a shape has no height over the plane.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoHeight {
    /// The normal of a plane does not point to the viewer.
    LooksAway,
    /// The axis does not point straight away from the viewer, into the body.
    AxisNotAway,
    /// The axis is not parallel to z.
    AxisNotUpright,
    /// The axis is not parallel to the plane.
    AxisNotFlat,
    /// There is no closed form.
    NoFormula,
}

/// A round shape is followed to this fraction of the way to where it stands upright, and beyond along its tangent: a
/// membrane whose slope matters there is beyond the linear theory.
const FOLLOWED: f64 = 0.98;
/// Axes may be out of line by this much, relative to their length: what is left of rounding in their directions.
const ALIGNED: f64 = 1e-9;

/// A height by a formula on jets.
struct Formula<F>(F);

impl<F: Fn([Jet<2>; 2]) -> Jet<2> + Send + Sync> HeightField for Formula<F> {
    fn jet(&self, x: &Vector<2>) -> Jet<2> {
        (self.0)([Jet::variable(x[0], 0), Jet::variable(x[1], 1)])
    }
}

/// The height that a formula of x and y gives.
pub(super) fn formula(f: impl Fn([Jet<2>; 2]) -> Jet<2> + Send + Sync + 'static) -> Arc<dyn HeightField> {
    Arc::new(Formula(f))
}

/// The height that rises by a formula of x and y from a level towards the viewer.
pub(super) fn rising(
    view: View,
    level: f64,
    rise: impl Fn([Jet<2>; 2]) -> Jet<2> + Send + Sync + 'static,
) -> Arc<dyn HeightField> {
    let c = Jet::<2>::constant;
    formula(move |x| c(level) + c(view.sign()) * rise(x))
}

/// Whether an axis points straight away from the viewer.
pub(super) fn points_away(axis: &Vector<3>, view: View) -> bool {
    view.sign() * axis[2] < 0.0 && is_upright(axis)
}

/// Whether an axis is parallel to z.
pub(super) fn is_upright(axis: &Vector<3>) -> bool {
    axis[2] != 0.0 && axis[0].hypot(axis[1]) <= ALIGNED * axis[2].abs()
}

/// Whether an axis is parallel to the plane.
pub(super) fn is_flat(axis: &Vector<3>) -> bool {
    let length = axis[0].hypot(axis[1]);
    length != 0.0 && axis[2].abs() <= ALIGNED * length
}

/// The squared distance from a point within the plane, each direction in a unit of its own.
pub(super) fn squared_distance(x: [Jet<2>; 2], center: &Point<3>, unit: [f64; 2]) -> Jet<2> {
    let c = Jet::<2>::constant;
    let [s, t] = std::array::from_fn(|k| (x[k] - c(center[k])) / c(unit[k]));
    s * s + t * t
}

/// The height of a circle over its middle, by the square of the distance from there: `√(r² - d²)`, and its tangent beyond
/// the part that is followed.
pub(super) fn circle(squared: Jet<2>, radius: f64) -> Jet<2> {
    let c = Jet::<2>::constant;
    let edge = FOLLOWED * radius;
    if squared.value < edge * edge {
        return sqrt(c(radius * radius) - squared);
    }
    let height = (radius * radius - edge * edge).sqrt();
    c(height) - c(edge / height) * (sqrt(squared) - c(edge))
}

/// The square root of a positive jet.
pub(super) fn sqrt(a: Jet<2>) -> Jet<2> {
    let root = a.value.sqrt();
    a.chain(root, 0.5 / root, -0.25 / (root * a.value))
}
