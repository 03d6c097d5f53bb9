//! Rows in the unknowns that remain.

use crate::supports::Reduction;
use signorini_contact::{WeightedGap, compress};

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
