//! Reference cells: shapes, functions, maps to space and quadrature. What any discretisation and contact share; it knows no
//! meshes.
//!
//! - [`mod@reference`]: the shapes of cells, with their edges and sides.
//! - [`hierarchic`]: integrated Legendre functions, the unknowns of solids.
//! - [`lagrange`]: tensor-product Lagrange bases of any degree on Gauss-Lobatto points.
//! - [`cell_map`]: Lagrange functions that map reference cells to space.
//! - [`rational`]: rational spline functions on spans of knots.
//! - [`cell_basis`]: the unknowns of a cell of either kind.
//! - [`rules`]: quadrature on reference cells.
//! - [`small`]: inverses of small matrices.

pub mod cell_basis;
pub mod cell_map;
pub mod hierarchic;
pub mod lagrange;
pub mod rational;
pub mod reference;
pub mod rules;
pub mod small;

pub use cell_basis::CellBasis;
pub use lagrange::TensorBasis;
pub use rational::{RationalBasis, SpanFunctions};
pub use reference::{CellShape, Local};
pub use signorini_geometry::rule::gauss_legendre;
