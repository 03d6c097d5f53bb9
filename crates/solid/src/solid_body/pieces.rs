//! The cells of a body in pieces, on each of which the dilatation is projected by itself: cell by cell, and of splines that hardly
//! compress on blocks of cells.

use super::SolidBody;
use crate::stiffness::{ALONE, Table, pressures, projects};
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use signorini_fem::mesh::Window;
use signorini_fem::{DofMap, Mesh};
use signorini_material::{Elastic, Space};
use std::borrow::Cow;

/// Which cells belong together.
pub(super) struct Pieces {
    /// Cells of each piece and their places in it; empty where each cell is one.
    blocks: Vec<Vec<(u32, Window)>>,
    /// The piece of each cell.
    of: Vec<u32>,
    cells: usize,
}

impl Pieces {
    pub fn new<const D: usize>(mesh: &Mesh<D>, dofs: &DofMap, elastic: &Elastic, space: Space) -> Self {
        let cells = mesh.cell_count();
        let blocks = match mesh.is_spline() && projects(dofs.basis(0), elastic, space) {
            true => mesh.macro_cells().to_vec(),
            false => Vec::new(),
        };
        let mut of = vec![0; if blocks.is_empty() { 0 } else { cells }];
        for (number, block) in blocks.iter().enumerate() {
            block.iter().for_each(|(cell, _)| of[*cell as usize] = number as u32);
        }
        Pieces { blocks, of, cells }
    }

    pub fn count(&self) -> usize {
        if self.blocks.is_empty() { self.cells } else { self.blocks.len() }
    }

    pub fn of(&self, cell: usize) -> usize {
        self.of.get(cell).map_or(cell, |piece| *piece as usize)
    }

    /// The place of a cell in its piece.
    pub fn place(&self, cell: usize) -> Window {
        let own = self.blocks.get(self.of(cell)).and_then(|cells| cells.iter().find(|(own, _)| *own as usize == cell));
        own.map_or(ALONE, |(_, place)| *place)
    }

    pub fn cells(&self, piece: usize) -> Cow<'_, [(u32, Window)]> {
        match self.blocks.get(piece) {
            Some(cells) => Cow::Borrowed(cells),
            None => Cow::Owned(vec![(piece as u32, ALONE)]),
        }
    }
}

/// A piece with its unknowns.
pub(super) struct Piece<'a> {
    pub cells: Cow<'a, [(u32, Window)]>,
    pub unknowns: Vec<u32>,
    /// The sign of each function in the basis of its cell; all +1 where there are several cells.
    pub signs: Vec<f64>,
    /// Of each cell the places of its unknowns.
    places: Vec<Vec<usize>>,
}

impl Piece<'_> {
    /// A matrix of its unknowns, in the order and sign of the basis, as a block of the body.
    pub fn block(self, matrix: &DMatrix<f64>) -> (Vec<u32>, Vec<f64>) {
        let (n, signs) = (self.unknowns.len(), &self.signs);
        let values = (0..n * n).map(|k| matrix[(k / n, k % n)] * signs[k / n] * signs[k % n]).collect();
        (self.unknowns, values)
    }

    /// The number of one of its cells among them.
    pub fn number_of(&self, cell: usize) -> usize {
        self.cells.iter().position(|(own, _)| *own as usize == cell).unwrap_or(0)
    }

    /// Adds a vector of the unknowns of a cell.
    pub fn add(&self, cell: usize, own: &DVector<f64>, out: &mut DVector<f64>) {
        self.places[cell].iter().zip(own.iter()).for_each(|(k, v)| out[*k] += v);
    }

    /// Adds columns by the unknowns of a cell.
    pub fn add_columns(&self, cell: usize, own: &DMatrix<f64>, out: &mut DMatrix<f64>) {
        for (k, column) in self.places[cell].iter().zip(own.column_iter()) {
            let mut sum = out.column_mut(*k);
            sum += column;
        }
    }

    /// Adds a matrix of the unknowns of a cell.
    pub fn add_square(&self, cell: usize, own: &DMatrix<f64>, out: &mut DMatrix<f64>) {
        for (j, column) in self.places[cell].iter().zip(own.column_iter()) {
            self.places[cell].iter().zip(column.iter()).for_each(|(i, v)| out[(*i, *j)] += v);
        }
    }
}

/// The best fit on a piece by polynomials of one degree less, discontinuous from piece to piece.
pub(super) struct Fit {
    mass: Cholesky<f64, Dyn>,
    /// The polynomials at the points of each cell, and times their weights.
    values: Vec<DMatrix<f64>>,
    weighted: Vec<DMatrix<f64>>,
}

impl Fit {
    /// Coefficients of the fit to values at the points of all cells.
    pub fn coefficients(&self, values: &[DVector<f64>]) -> DVector<f64> {
        let sum = self.weighted.iter().zip(values).map(|(m, v)| m * v).fold(DVector::zeros(self.len()), |s, v| s + v);
        self.mass.solve(&sum)
    }

    /// The fit at the points of all cells.
    pub fn fitted(&self, values: &[DVector<f64>]) -> Vec<DVector<f64>> {
        let coefficients = self.coefficients(values);
        self.values.iter().map(|psi| psi.tr_mul(&coefficients)).collect()
    }

    /// Coefficients by each unknown of a piece, of values that are linear in the unknowns: rows at the points of each cell.
    pub fn coefficients_by_unknown(&self, piece: &Piece<'_>, rows: &[DMatrix<f64>]) -> DMatrix<f64> {
        let mut sum = DMatrix::<f64>::zeros(self.len(), piece.unknowns.len());
        for (c, (weighted, rows)) in self.weighted.iter().zip(rows).enumerate() {
            piece.add_columns(c, &(weighted * rows), &mut sum);
        }
        self.mass.solve(&sum)
    }

    /// `∫ ψ_r f ψ_s` with a factor at the points of each cell.
    pub fn products(&self, factors: &[Vec<f64>]) -> DMatrix<f64> {
        let mut out = DMatrix::<f64>::zeros(self.len(), self.len());
        for ((weighted, values), factors) in self.weighted.iter().zip(&self.values).zip(factors) {
            let mut scaled = weighted.clone();
            scaled.column_iter_mut().zip(factors).for_each(|(mut column, f)| column *= *f);
            out += scaled * values.transpose();
        }
        out
    }

    /// Coefficients from integrals with each polynomial.
    pub fn solve(&self, integrals: &DMatrix<f64>) -> DMatrix<f64> {
        self.mass.solve(integrals)
    }

    fn len(&self) -> usize {
        self.values[0].nrows()
    }
}

impl<const D: usize> SolidBody<D> {
    pub(super) fn piece(&self, number: usize) -> Piece<'_> {
        let cells = self.pieces.cells(number);
        if let [(cell, _)] = *cells {
            let (unknowns, signs) = self.unknowns_of(cell as usize);
            let places = vec![(0..unknowns.len()).collect()];
            return Piece { cells, unknowns, signs, places };
        }
        let own: Vec<Vec<u32>> = cells.iter().map(|(cell, _)| self.unknowns_of(*cell as usize).0).collect();
        let mut unknowns = own.concat();
        unknowns.sort_unstable();
        unknowns.dedup();
        // Each of them is in the list.
        let place = |k: &u32| unknowns.partition_point(|other| other < k);
        let places = own.iter().map(|list| list.iter().map(place).collect()).collect();
        Piece { cells, signs: vec![1.0; unknowns.len()], places, unknowns }
    }

    /// The projection of the dilatation on a piece, where there is one, with the weights of the points of its cells.
    pub(super) fn projection(&self, piece: &Piece<'_>, weights: &[&[f64]]) -> Option<Fit> {
        let body = self.body();
        let projects =
            |(cell, _): &(u32, Window)| projects(body.dofs.basis(*cell as usize), &body.material, self.bodies.space);
        piece.cells.iter().all(projects).then(|| self.fit(&piece.cells, weights)).flatten()
    }

    /// The best fit on cells.
    pub(super) fn fit(&self, cells: &[(u32, Window)], weights: &[&[f64]]) -> Option<Fit> {
        let of = |(cell, place): &(u32, Window)| self.polynomials(*cell as usize, place, self.table(*cell as usize));
        let values: Vec<DMatrix<f64>> = cells.iter().map(of).collect();
        let mut weighted = values.clone();
        for (psi, weights) in weighted.iter_mut().zip(weights) {
            psi.column_iter_mut().zip(*weights).for_each(|(mut column, w)| column *= *w);
        }
        let mass = weighted.iter().zip(&values).map(|(m, psi)| m * psi.transpose()).reduce(|s, m| s + m)?;
        Some(Fit { mass: mass.cholesky()?, values, weighted })
    }

    /// The best fit on a cell by itself: from values at its points to those at the points of a table.
    pub(super) fn fit_to(&self, cell: usize, weights: &[f64], to: &Table) -> Option<DMatrix<f64>> {
        let fit = self.fit(&[(cell as u32, ALONE)], &[weights])?;
        Some(self.polynomials(cell, &ALONE, to).tr_mul(&fit.solve(&fit.weighted[0])))
    }

    /// The polynomials of a piece at the points of a table of one of its cells.
    pub(super) fn polynomials(&self, cell: usize, place: &Window, table: &Table) -> DMatrix<f64> {
        pressures::<D>(self.body().dofs.basis(cell), table, place)
    }
}
