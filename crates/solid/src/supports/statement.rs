//! What is stated of a support.

use signorini_fem::Group;
use signorini_geometry::Point;

/// What a support does.
#[derive(Clone, Debug, PartialEq)]
pub enum SupportKind {
    /// Which components are prescribed.
    Components(Vec<bool>),
    /// The component along the common normal of the group.
    Normal,
    /// Which components are the same everywhere on the group, and otherwise free.
    Uniform(Vec<bool>),
    /// Stiffness per area (or per length in the plane) of an elastic bed.
    Spring(Vec<f64>),
}

/// A support of a group of a body.
#[derive(Clone, Debug)]
pub struct Support {
    pub name: String,
    pub body: usize,
    pub group: Group,
    pub kind: SupportKind,
}

/// Supports that cannot be used.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SupportError {
    #[error("`normal` requires a flat group, but the normals of its sides differ by up to {degrees:.2} degrees")]
    NotFlat { support: String, degrees: f64 },
    #[error(
        "the supports `{first}` and `{second}` prescribe different displacements of the same point {position}: {a} and {b}"
    )]
    Contradiction { first: String, second: String, position: String, a: f64, b: f64 },
}

/// The displacement a support prescribes at a point, by component; along the normal for [`SupportKind::Normal`].
pub type Displacement<'a, const D: usize> = &'a dyn Fn(usize, &Point<D>) -> Point<D>;
