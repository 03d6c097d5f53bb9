//! Finite elements: bases, meshes, grids, quadrature and cut cells.
//!
//! - [`mod@reference`]: the shapes of cells, with their edges and sides.
//! - [`hierarchic`]: integrated Legendre functions, the unknowns of solids; [`dofs`] numbers them on a mesh.
//! - [`cell_map`]: Lagrange functions that map reference cells to space; [`mesh`] and [`block`] are made of them.
//! - [`gmsh`]: meshes from files.
//! - [`adjacency`]: which cells of a mesh share sides.
//! - [`overlap`]: whether cells of a mesh cover the same place; [`pieces`]: which hang together.
//! - [`mesh_refinement`]: meshes of the plane, each cell divided into four; [`graded_mesh`]: only where it matters.
//! - [`halved`]: meshes of any cells with all of them divided.
//! - [`rules`]: quadrature on reference cells.
//! - [`lagrange`]: tensor-product Lagrange bases of any degree on Gauss-Lobatto points.
//! - [`grid`]: uniform background grids in one, two and three dimensions, with their nodes.
//! - [`cells`]: what a membrane is computed on, whatever kind of cells.
//! - [`cut`]: quadrature on cells that are divided by implicit surfaces: volume, surface and normal.
//! - [`elastic`]: linear elasticity in the plane, around an axis and in space.
//! - [`ghost`]: the ghost penalty that keeps small cuts stable.

pub mod adjacency;
pub mod block;
pub mod cell_map;
pub mod cells;
pub mod cells_part;
pub mod cut;
pub mod dofs;
pub mod elastic;
pub mod ghost;
pub mod gmsh;
pub mod graded_mesh;
pub mod grid;
pub mod halved;
pub mod hierarchic;
pub mod lagrange;
mod lists;
pub mod mesh;
pub mod mesh_cells;
pub mod mesh_refinement;
pub mod overlap;
pub mod pieces;
pub mod reference;
pub mod refined_grid;
pub mod rules;
pub mod small;

pub use cells::{CellByCell, Cells};
pub use cells_part::CellsPart;
pub use cut::{CellRule, Partition, QuadraturePoint, SurfacePoint};
pub use dofs::DofMap;
pub use ghost::ghost_penalty;
pub use grid::Grid;
pub use halved::Halved;
pub use lagrange::TensorBasis;
pub use mesh::{Group, Mesh, MeshError, Side};
pub use mesh_cells::MeshCells;
pub use overlap::Overlap;
pub use reference::{CellShape, Local};
pub use refined_grid::RefinedGrid;
pub use signorini_geometry::rule::gauss_legendre;
