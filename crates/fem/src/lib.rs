//! Finite elements: meshes, grids and cut cells, over the reference cells of `signorini-basis`.
//!
//! - [`mesh`] and [`block`]: cells in space; [`dofs`] numbers functions on them.
//! - [`gmsh`]: meshes from files.
//! - [`adjacency`]: which cells of a mesh share sides.
//! - [`overlap`]: whether cells of a mesh cover the same place; [`pieces`]: which hang together.
//! - [`mesh_refinement`]: meshes of the plane, each cell divided into four; [`graded_mesh`]: only where it matters.
//! - [`halved`]: meshes of any cells with all of them divided.
//! - [`nurbs`]: meshes of spline patches.
//! - [`grid`]: uniform background grids in one, two and three dimensions, with their nodes.
//! - [`cells`]: what a membrane is computed on, whatever kind of cells.
//! - [`cut`]: quadrature on cells that are divided by implicit surfaces: volume, surface and normal.
//! - [`ghost`]: the ghost penalty that keeps small cuts stable.

pub mod adjacency;
pub mod block;
mod boundary_side;
pub mod cell_parts;
pub mod cells;
pub mod cells_part;
pub mod cut;
pub mod dofs;
pub mod ghost;
pub mod gmsh;
pub mod graded_mesh;
pub mod grid;
pub mod halved;
mod lists;
pub mod mesh;
pub mod mesh_cells;
pub mod mesh_refinement;
pub mod nurbs;
pub mod overlap;
pub mod pieces;
pub mod refined_grid;
mod whole_rule;

pub use cells::{CellByCell, Cells};
pub use cells_part::CellsPart;
pub use cut::{CellRule, Partition, QuadraturePoint, SurfacePoint};
pub use dofs::DofMap;
pub use ghost::ghost_penalty;
pub use grid::Grid;
pub use halved::Halved;
pub use mesh::{Group, Mesh, MeshError, NodeBetween, Side};
pub use mesh_cells::MeshCells;
pub use nurbs::{NurbsError, NurbsPatch};
pub use overlap::Overlap;
pub use refined_grid::RefinedGrid;
pub use signorini_basis::{CellBasis, CellShape, Local, RationalBasis, TensorBasis, gauss_legendre};
pub use signorini_basis::{cell_basis, cell_map, hierarchic, lagrange, rational, reference, rules, small};
