//! What the points of a face add to residual and tangent.

use signorini_geometry::{Matrix, Vector};

/// A row or column over the unknowns of bodies, by unknown, of a component of the traction of a node.
#[derive(Clone, Debug)]
pub struct Line {
    pub node: u32,
    /// 0 is the pressure, 1 and 2 are friction along the axes.
    pub slot: usize,
    pub entries: Vec<(u32, f64)>,
}

/// What of it is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    Forces,
    /// Rows and columns of nodes too.
    Lines,
    /// The derivatives of forces in the unknowns of bodies too.
    Tangent,
}

/// What a face adds.
#[derive(Clone, Debug, Default)]
pub struct FaceTerms {
    /// Forces on unknowns, and the sums of the sizes of their terms.
    pub forces: Vec<(u32, f64)>,
    pub sizes: Vec<(u32, f64)>,
    /// Their derivatives in the unknowns of bodies: the unknowns, and values row by row.
    pub stiffness: (Vec<u32>, Vec<f64>),
    /// Forces of a unit of traction.
    pub pushes: Vec<Line>,
    /// Derivatives of the integrals of gaps and slips over the functions of nodes.
    pub gaps: Vec<Line>,
    pub slips: Vec<Line>,
}

/// Traction at a point: with friction in space, and how that changes with the normal.
pub struct Traction {
    pub pressure: f64,
    pub friction: Vector<3>,
    pub turning: Matrix<3>,
}
