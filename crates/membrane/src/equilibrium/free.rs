//! The displacement of the free membrane around a zone.

use super::unknowns::Unknowns;
use crate::problem::Membrane;
use crate::quadrature::Quadrature;
use signorini_fem::cut::RegionId;
use signorini_fem::lagrange::Tabulation;
use signorini_geometry::{Point, Vector};

/// A state of the free membrane, whatever solved for it.
#[derive(Clone, Copy)]
pub struct FreeState<'a, const D: usize> {
    pub membrane: &'a Membrane<D>,
    pub quadrature: &'a Quadrature<D>,
    pub(crate) unknowns: &'a Unknowns,
    /// Values of the unknowns.
    pub(crate) u: &'a [f64],
}

/// Displacement and its gradient at a point of a cell, by the polynomial of one of its regions.
pub(super) fn evaluate<const D: usize>(
    membrane: &Membrane<D>,
    unknowns: &Unknowns,
    u: &[f64],
    cell: usize,
    region: RegionId,
    x: &Point<D>,
) -> Option<(f64, Vector<D>)> {
    let dofs = unknowns.of(cell, region)?;
    let mut t = Tabulation::default();
    membrane.cells.tabulate(cell, x, &mut t);
    Some(dofs.iter().enumerate().fold((0.0, Vector::zeros()), |(value, gradient), (a, &i)| {
        let c = u[i as usize];
        (value + c * t.value[a], gradient + c * t.gradient[a])
    }))
}
