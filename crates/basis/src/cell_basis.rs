//! The functions of a cell, whose coefficients are unknowns.

use crate::hierarchic::{Derivatives, HierarchicBasis, Mode, Values};
use crate::rational::RationalBasis;
use crate::reference::{CellShape, Local};
use std::sync::Arc;

/// Hierarchic functions, the same on all cells of a shape and degree, or those of a span of a spline.
#[derive(Clone, Debug)]
pub enum CellBasis {
    Hierarchic(HierarchicBasis),
    Rational(Arc<RationalBasis>),
}

impl CellBasis {
    pub fn shape(&self) -> CellShape {
        match self {
            CellBasis::Hierarchic(basis) => basis.shape(),
            CellBasis::Rational(basis) => basis.shape(),
        }
    }

    pub fn degree(&self) -> usize {
        match self {
            CellBasis::Hierarchic(basis) => basis.degree(),
            CellBasis::Rational(basis) => basis.degree(),
        }
    }

    /// To which part of the cell each function belongs; of splines, whose functions belong to many cells, nothing.
    pub fn modes(&self) -> &[Mode] {
        match self {
            CellBasis::Hierarchic(basis) => basis.modes(),
            CellBasis::Rational(_) => &[],
        }
    }

    pub fn is_spline(&self) -> bool {
        matches!(self, CellBasis::Rational(_))
    }

    /// Number of functions.
    pub fn len(&self) -> usize {
        match self {
            CellBasis::Hierarchic(basis) => basis.len(),
            CellBasis::Rational(basis) => basis.len(),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Values and gradients at a point of the reference cell, or near it.
    pub fn tabulate(&self, x: &Local, out: &mut Values) {
        match self {
            CellBasis::Hierarchic(basis) => basis.tabulate(x, out),
            CellBasis::Rational(basis) => basis.tabulate(x, out),
        }
    }

    /// Values and derivatives of the functions at these places at a point of the reference cell, along two directions and up
    /// to an order of three at most; zeros stand for those beyond it.
    pub fn derivatives(
        &self,
        functions: &[usize],
        x: &Local,
        directions: &[Local; 2],
        order: usize,
    ) -> Vec<Derivatives> {
        match self {
            CellBasis::Hierarchic(basis) => basis.derivatives(functions, x, directions, order),
            CellBasis::Rational(basis) => basis.derivatives(functions, x, directions, order),
        }
    }
}
