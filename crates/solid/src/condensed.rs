//! The factorised bodies as the compliance of the contacts, and rows in the unknowns that remain.

use crate::supports::Reduction;
use signorini_contact::{Compliance, WeightedGap, compress};
use signorini_solve::{Factor, SolveError};

pub(crate) struct System<'a>(pub &'a Factor);

impl Compliance for System<'_> {
    fn solve_columns(&self, b: &mut [f64]) -> Result<(), SolveError> {
        self.0.solve_columns(b)
    }

    fn solve_once(&self, b: &mut [f64]) -> Result<(), SolveError> {
        self.0.solve_once(b)
    }

    fn solve_accurately(&self, b: &[f64]) -> Result<Vec<f64>, SolveError> {
        self.0.solve_accurately(b)
    }

    fn size(&self) -> usize {
        self.0.size()
    }

    fn entries(&self) -> f64 {
        self.0.entries()
    }

    fn block(&self, unknowns: &[u32]) -> Vec<f64> {
        self.0.block(unknowns)
    }
}

/// A row in the unknowns that remain.
pub(crate) fn reduced<const D: usize>(row: &WeightedGap, reduction: &Reduction<D>, offset: &[f64]) -> WeightedGap {
    let list = |full: &[(u32, f64)]| {
        let mut out: Vec<(u32, f64)> = Vec::with_capacity(full.len());
        for (unknown, c) in full {
            out.extend(reduction.row(*unknown as usize).iter().map(|(k, t)| (*k, c * t)));
        }
        compress(&mut out);
        out
    };
    WeightedGap { gap: row.at(offset), terms: list(&row.terms), forces: list(&row.forces), ..*row }
}
