//! From one level to the next: bilinear interpolation and its transpose.

use super::level::Level;

/// Halfway between the second and third of four values, of which the outer ones may be missing.
fn halfway(v: [Option<f64>; 4]) -> f64 {
    match v {
        [Some(a), Some(b), Some(c), Some(d)] => (9.0 * (b + c) - a - d) / 16.0,
        [_, Some(b), Some(c), _] => 0.5 * (b + c),
        [_, Some(v), None, _] | [_, None, Some(v), _] => v,
        _ => 0.0,
    }
}

impl Level {
    /// The displacement at a node of the next finer grid.
    pub(super) fn interpolated(&self, i: usize, j: usize) -> f64 {
        let w = self.grid.cells()[0] + 1;
        let rows = self.grid.cells()[1] + 1;
        let at = |ic: isize, jc: isize| -> Option<f64> {
            let inside = (0..w as isize).contains(&ic) && (0..rows as isize).contains(&jc);
            let node = if inside { jc as usize * w + ic as usize } else { return None };
            self.known[node].then(|| self.u[node])
        };
        let (ic, jc) = ((i / 2) as isize, (j / 2) as isize);
        let along = |jc: isize| -> Option<f64> {
            if i.is_multiple_of(2) {
                return at(ic, jc);
            }
            let four = [-1, 0, 1, 2].map(|k| at(ic + k, jc));
            (four[1].is_some() || four[2].is_some()).then(|| halfway(four))
        };
        if j.is_multiple_of(2) { along(jc).unwrap_or(0.0) } else { halfway([-1, 0, 1, 2].map(|k| along(jc + k))) }
    }

    /// Adds the displacement of a coarser level, interpolated, to the nodes that take part.
    pub(super) fn add_correction(&mut self, coarse: &Level) {
        let (w, wc) = (self.grid.cells()[0] + 1, coarse.grid.cells()[0] + 1);
        let e = &coarse.u;
        let at = |i: usize, j: usize| -> f64 {
            let (ic, jc) = (i / 2, j / 2);
            let node = jc * wc + ic;
            match (i % 2, j % 2) {
                (0, 0) => e[node],
                (1, 0) => 0.5 * (e[node] + e[node + 1]),
                (0, _) => 0.5 * (e[node] + e[node + wc]),
                _ => 0.25 * (e[node] + e[node + 1] + e[node + wc] + e[node + wc + 1]),
            }
        };
        // Unknowns behind the nodes belong to the band alone.
        let nodes = self.known.len();
        let mut u = std::mem::take(&mut self.u);
        self.for_each_active(|unknown, _| {
            if unknown < nodes {
                u[unknown] += at(unknown % w, unknown / w);
            }
        });
        self.u = u;
    }

    /// Makes the residual the right-hand side of a coarser level, by the transpose of the interpolation.
    pub(super) fn restrict_residual(&self, coarse: &mut Level) {
        let r = self.residual();
        let (w, wc) = (self.grid.cells()[0] + 1, coarse.grid.cells()[0] + 1);
        let [nx, ny] = coarse.grid.cells();
        let sum = |i: usize, j: usize| -> f64 {
            let row = |jj: usize| {
                let at = jj * w + 2 * i;
                let left = if i > 0 { r[at - 1] } else { 0.0 };
                let right = if i < nx { r[at + 1] } else { 0.0 };
                r[at] + 0.5 * (left + right)
            };
            let below = if j > 0 { row(2 * j - 1) } else { 0.0 };
            let above = if j < ny { row(2 * j + 1) } else { 0.0 };
            row(2 * j) + 0.5 * (below + above)
        };
        let nodes = coarse.known.len();
        let mut b = vec![0.0; coarse.b.len()];
        coarse.for_each_active(|unknown, _| {
            if unknown < nodes {
                b[unknown] = sum(unknown % wc, unknown / wc);
            }
        });
        coarse.b = b;
    }
}
