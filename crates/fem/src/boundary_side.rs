//! Sides of cells on the boundary of a domain.

/// A side of a cell on the boundary of a domain that the cells fit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BoundarySide {
    pub cell: usize,
    /// Number of the side within its cell.
    pub side: usize,
    /// The piece of the boundary.
    pub piece: usize,
}
