//! Heights over a plane: what is seen of bodies from above or from below.

use crate::{Jet, Real, Vector};

/// From where a body is looked at along z.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    FromAbove,
    FromBelow,
}

impl View {
    /// The direction along z in which the viewer is.
    pub fn sign(self) -> f64 {
        match self {
            Self::FromAbove => 1.0,
            Self::FromBelow => -1.0,
        }
    }
}

/// A height over x and y with its derivatives.
pub trait HeightField: Send + Sync {
    fn jet(&self, x: &Vector<2>) -> Jet<2>;

    fn value(&self, x: &Vector<2>) -> f64 {
        self.jet(x).value
    }

    /// The rectangle beyond which nothing is known of the height, by its corners; none where there is no such place.
    fn known_within(&self) -> Option<[Vector<2>; 2]> {
        None
    }
}

impl std::fmt::Debug for dyn HeightField {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("HeightField")
    }
}

/// The height at a place, with derivatives where the place is a jet; not a number where the place is none.
pub fn evaluate<R: Real>(height: &dyn HeightField, x: R, y: R) -> R {
    let at = Vector::<2>::new(x.value(), y.value());
    if !at.iter().all(|v| v.is_finite()) {
        return R::constant(f64::NAN);
    }
    if x.is_constant() && y.is_constant() {
        return R::constant(height.value(&at));
    }
    height.jet(&at).expanded([x - R::constant(at[0]), y - R::constant(at[1])])
}
