//! The mass of the material in the cells, `∫ ρ N_a N_b`: of cut cells that of the part inside.

use super::CellSolid;
use crate::space::Tabulation;
use rayon::prelude::*;
use signorini_mechanics::Mass;

impl<const D: usize> CellSolid<D> {
    /// The body with a mass per volume.
    #[must_use]
    pub fn with_density(mut self, density: Option<f64>) -> Self {
        self.density = density;
        self
    }

    pub(super) fn mass_with(&self, density: f64) -> Mass {
        let of = |cell: usize| {
            let own = &self.body.cells()[cell];
            let n = own.functions.len();
            let mut sums = vec![0.0; n * n];
            let mut t = Tabulation::default();
            for (x, w) in self.body.volume_points(own) {
                self.body.functions_at(cell, &x, &mut t);
                let part = density * w * self.body.turn(&x);
                for (a, row) in sums.chunks_mut(n).enumerate() {
                    row.iter_mut().zip(&t.value).for_each(|(sum, b)| *sum += part * t.value[a] * b);
                }
            }
            let all = own.functions.iter().enumerate().flat_map(|(a, f)| (0..D).map(move |i| (a, i, *f)));
            let list: Vec<(usize, usize, u32)> =
                all.filter_map(|(a, i, f)| Some((a, i, self.unknown(f, i)?))).collect();
            let entry = |(a, i, _): &(usize, usize, u32), (b, j, _): &(usize, usize, u32)| {
                if i == j { sums[a * n + b] } else { 0.0 }
            };
            let values = list.iter().flat_map(|row| list.iter().map(move |column| entry(row, column))).collect();
            (list.iter().map(|(_, _, unknown)| *unknown).collect(), values)
        };
        let blocks = (0..self.body.cells().len()).into_par_iter().map(of).collect();
        Mass { blocks, spins: Vec::new() }
    }
}
