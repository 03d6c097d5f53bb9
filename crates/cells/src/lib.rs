//! Finite cells: elastic bodies of any shape on a grid of cells of high order, without a mesh.
//!
//! The body lies anywhere in a box of cells. Its shape enters by quadrature alone; supports and contact act on the
//! boundary that the quadrature recovers (Parvizian, Düster & Rank, Comput. Mech. 41, 2007; Düster, Rank & Szabó,
//! *The p-version of the finite element and finite cell methods*, 2017).
//!
//! - [`Domain`], [`shapes`]: bodies from implicit shapes; [`facets`], `polygon`: from closed surfaces of triangles; [`voxels`] and
//!   [`image`]: from images.
//! - [`region`]: the quadrature of the material in a cell and of its boundary; `rules`: of all cells, by one or several processes.
//! - [`tree`], [`space`], [`jets`], [`legendre`]: cells, refinement, functions.
//! - [`components`]: what of the material hangs together.
//! - [`moments`]: few points for many; `tensor_integrals`: sums over them, direction by direction.
//! - [`discretisation`]: how a body is made of cells; [`body`]: all of this; [`stiffness`]: the elastic integrals;
//!   `by_law`: forces and tangent of other laws; `stress_fit`: stresses with a history away from their points.
//! - [`cell_solid`]: the body in a system of bodies of any kind, with its supports, loads and contact; `nitsche`: how its
//!   recovered boundary is held; [`schwarz`]: the preconditioner.
//! - [`description`]: the same from plain data, of any dimension.
//! - [`disc_contact`]: contact by discs, between bodies of a system or within one; `spread`: points for them.
//! - [`fields`]: displacement and stress in the volume and on the boundary.

pub mod body;
mod by_law;
pub mod cell;
pub mod cell_solid;
mod check;
pub mod components;
pub mod description;
pub mod disc_contact;
pub mod discretisation;
pub mod error;
pub mod facets;
pub mod fields;
mod hierarchy;
pub mod image;
pub mod jets;
mod kept_pieces;
pub mod legendre;
mod memory;
pub mod moments;
mod nitsche;
mod numbering;
pub mod place;
mod polygon;
pub mod region;
mod rules;
pub mod schwarz;
pub mod shapes;
pub mod space;
mod spread;
pub mod stiffness;
mod stress_fit;
mod tensor_integrals;
pub mod tree;
pub mod voxels;

pub use body::CellBody;
pub use cell::{Cell, Field, Findings, Site};
pub use cell_solid::CellSolid;
pub use components::Pieces;
pub use discretisation::{Boundary, CellMaterial, Discretisation, Islands};
pub use error::CellsError;
pub use moments::VolumePoints;
pub use place::Place;
pub use region::{BoundaryPoint, Filling, Integration, Region};
pub use signorini_fem::cut::End;
pub use signorini_material::{Elastic, SolidMaterial, Space, StressLaw, von_mises};
pub use space::{Products, Tabulation};
pub use tree::{CellTree, Leaf};

/// Where a body has material: shapes, their unions, intersections and complements.
pub type Domain<const D: usize> = signorini_geometry::implicit::ImplicitBody<D>;

/// Inner parts for the tests in `tests`; no part of the interface.
#[doc(hidden)]
pub mod testing {
    pub use crate::spread::{SAME_FACE, farthest_points};
}
