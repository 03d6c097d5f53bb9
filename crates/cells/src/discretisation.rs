//! How a body is made of cells, and of what.

use crate::cell::Field;
use crate::components::Pieces;
use crate::error::CellsError;
use crate::moments::VolumePoints;
use crate::region::{Integration, Region};
use crate::space::Products;
use crate::tree::Leaf;
use signorini_material::{Elastic, SolidMaterial, Space};
use signorini_mechanics::processes::Processes;
use std::sync::Arc;

/// What is done with pieces of the body that do not hang together with the largest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Islands {
    /// An error tells of them.
    Refuse,
    Drop,
    /// Each is held by supports or contact of its own.
    Keep,
}

/// Whether a body without a boundary in the box of its cells is meant.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Boundary {
    Expected,
    /// The body may fill the whole box.
    Optional,
}

/// How a body is made of cells.
#[derive(Clone)]
pub struct Discretisation<const D: usize> {
    /// Degree of the functions, 1 to 8.
    pub degree: usize,
    pub products: Products,
    pub integration: Integration,
    pub volume_points: VolumePoints,
    /// Stiffness outside the material relative to that inside; the error in the energy norm is about `0.1 √α`.
    pub fictitious: f64,
    pub pieces: Pieces,
    pub islands: Islands,
    pub boundary: Boundary,
    /// Times that cells are halved in which the boundary faces itself or turns by more than half a radian: where a pore or a
    /// gap is narrower than a cell, around tips, and at edges.
    pub refine_narrow: usize,
    /// Memory in bytes that the body and its equations may take: the same on all processes.
    pub memory: f64,
    /// Those that make the same body together.
    pub processes: Option<Arc<dyn Processes>>,
}

impl<const D: usize> Discretisation<D> {
    /// The defaults for a degree.
    pub fn of_degree(degree: usize) -> Self {
        Discretisation {
            degree,
            products: Products::Tensor,
            integration: Integration::Exact { points: None },
            volume_points: VolumePoints::InMaterial,
            fictitious: 1e-8,
            pieces: Pieces::Split,
            islands: Islands::Refuse,
            boundary: Boundary::Expected,
            refine_narrow: 0,
            memory: f64::INFINITY,
            processes: None,
        }
    }
}

/// What the body is made of.
#[derive(Clone)]
pub struct CellMaterial<const D: usize> {
    pub solid: SolidMaterial,
    /// A factor of all moduli that varies in space, with its largest value.
    pub modulus: Option<(Field<D>, f64)>,
    pub space: Space,
}

impl<const D: usize> CellMaterial<D> {
    /// Typical constants of small strain.
    pub fn elastic(&self) -> &Elastic {
        self.solid.elastic()
    }
}

/// # Errors
/// Values of the shape at three points of a leaf that are not finite.
pub(crate) fn check_values<const D: usize>(region: &dyn Region<D>, leaf: &Leaf<D>) -> Result<(), CellsError> {
    let b = &leaf.bounds;
    match [b.min, b.center(), b.max].iter().find_map(|x| Some((x, region.defect(x)?))) {
        Some((x, value)) => Err(CellsError::NotFinite { at: x.iter().copied().collect(), value }),
        None => Ok(()),
    }
}
