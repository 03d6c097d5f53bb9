//! A cell of a body, its points, and what was found about all of them.

use crate::region::MaterialRule;
use crate::space::LocalMode;
use signorini_geometry::{Point, Vector};
use std::sync::Arc;

/// A function of position.
pub type Field<const D: usize> = Arc<dyn Fn(&Point<D>) -> f64 + Send + Sync>;

/// A cell with material: a leaf, or one piece of the material in it.
#[derive(Clone, Debug)]
pub struct Cell<const D: usize> {
    /// Number of the leaf in the tree.
    pub leaf: usize,
    pub modes: Vec<LocalMode<D>>,
    /// Number of each of its functions in the body.
    pub functions: Vec<u32>,
    pub rule: MaterialRule<D>,
    /// Share of the material in the leaf.
    pub share: f64,
    /// The cell whose polynomials give the stress on the boundary in this one: itself, or a neighbour with more material
    /// where this one holds so little that its own stress is not controlled by its energy.
    pub stress_cell: usize,
}

/// A point of the recovered boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Site<const D: usize> {
    /// Number of the cell.
    pub cell: usize,
    pub x: Point<D>,
    /// Length or area before the body deforms; around an axis, of the whole turn.
    pub weight: f64,
    /// Unit normal, out of the material.
    pub normal: Vector<D>,
}

/// What was found out about the body while it was made.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Findings {
    /// Cells in which the boundary faces itself: features as narrow as a cell.
    pub facing_cells: usize,
    /// Leaves whose material is in several pieces with unknowns of their own.
    pub split_leaves: usize,
    /// Functions that are copies of another one, for pieces of material that do not touch in its support.
    pub copies: usize,
    /// Volumes of pieces of the body that do not hang together, the largest first.
    pub parts: Vec<f64>,
    /// Volume of the pieces that were dropped.
    pub dropped: f64,
}

/// Share of material in a cell above which its functions are independent enough for the stars of its vertices alone.
pub(crate) const SMALL: f64 = 0.5;
