//! Finite elements: bases, grids, quadrature and cut cells.
//!
//! - [`lagrange`]: tensor-product Lagrange bases of any degree on Gauss-Lobatto points.
//! - [`grid`]: uniform background grids in one, two and three dimensions, with their nodes.
//! - [`cut`]: quadrature on cells that are divided by implicit surfaces: volume, surface and normal.
//! - [`ghost`]: the ghost penalty that keeps small cuts stable.

pub mod cut;
pub mod ghost;
pub mod grid;
pub mod lagrange;

pub use cut::{CellRule, Partition, QuadraturePoint, SurfacePoint};
pub use ghost::GhostPenalty;
pub use grid::Grid;
pub use lagrange::TensorBasis;
pub use signorini_geometry::rule::gauss_legendre;
