//! The volumetric ghost penalty (Preuss; Lehrenfeld & Olshanskii): two polynomials that meet at a side of a cut cell are
//! held together by the difference of their extensions over both cells.

use crate::cells::{Cells, Neighbours};
use crate::lagrange::Tabulation;

/// The matrix of `width⁻² ∫_{K1 ∪ K2} (E u1 - E u2)(E v1 - E v2)`, row by row. Where the functions of a cell are no
/// polynomials, `E` extends the polynomial closest to them, and `u - E u` is penalised likewise within the cell.
///
/// The unknowns are those of the first cell followed by those of the second, the shared ones in both: because both
/// polynomials agree there, assembling them twice is right.
pub fn ghost_penalty<const D: usize>(cells: &dyn Cells<D>, pair: &Neighbours) -> Vec<f64> {
    let mut extensions = pair.cells.map(|cell| cells.extension(cell));
    let mut values = [Vec::new(), Vec::new()];
    let mut own = Tabulation::default();
    let mut matrix = Vec::new();
    let mut jump: Vec<f64> = Vec::new();
    let mut add = |jump: &[f64], weight: f64| {
        let n = jump.len();
        matrix.resize(n * n, 0.0);
        for a in (0..n).filter(|a| jump[*a] != 0.0) {
            let scaled = weight * jump[a] / (pair.width * pair.width);
            for (m, b) in matrix[a * n..(a + 1) * n].iter_mut().zip(jump) {
                *m += scaled * b;
            }
        }
    };
    for (here, p) in cells.compared_over(pair) {
        for (extension, v) in extensions.iter_mut().zip(&mut values) {
            (extension.values)(&p.x, v);
        }
        jump.clear();
        jump.extend_from_slice(&values[0]);
        jump.extend(values[1].iter().map(|v| -v));
        add(&jump, p.weight);
        if !extensions[here].is_own {
            cells.tabulate(pair.cells[here], &p.x, &mut own);
            jump.fill(0.0);
            let first = here * values[0].len();
            for (j, (u, e)) in jump[first..].iter_mut().zip(own.value.iter().zip(&values[here])) {
                *j = u - e;
            }
            add(&jump, p.weight);
        }
    }
    let n = jump.len();
    if !cells.sum_to_one() {
        return matrix;
    }
    // Constants are free, and their rows sum to zero; what round-off makes of it goes to the diagonal, or it would show
    // up as a force without a cause: at degree 6 the extensions reach far, and the entries are large.
    for a in 0..n {
        let row = &mut matrix[a * n..(a + 1) * n];
        row[a] = -(0..n).filter(|b| *b != a).map(|b| row[b]).sum::<f64>();
    }
    matrix
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use signorini_geometry::{Aabb, Point};

    #[test]
    fn a_global_polynomial_is_free_and_a_kink_is_not() {
        let grid = Grid::new(Aabb::new(Point::<2>::zeros(), Point::<2>::new(1.0, 0.25)), [2, 1], 3);
        let pair = grid.neighbours()[0];
        let m = ghost_penalty(&grid, &pair);
        let mut nodes = Vec::new();
        let energy = |nodes: &mut Vec<u32>, f: &dyn Fn(f64, f64) -> f64| {
            let mut u = Vec::new();
            for cell in pair.cells {
                grid.cell_nodes(cell, nodes);
                u.extend(nodes.iter().map(|&n| f(grid.node(n as usize)[0], grid.node(n as usize)[1])));
            }
            (0..u.len()).map(|a| (0..u.len()).map(|b| u[a] * m[a * u.len() + b] * u[b]).sum::<f64>()).sum::<f64>()
        };
        assert!(energy(&mut nodes, &|x, y| x.powi(3) * y - y.powi(2) + 1.0).abs() < 1e-12);
        // A kink of slope 1 differs by |x - 0.5| on both cells: ∫ 2 t² over both, divided by h².
        assert!((energy(&mut nodes, &|x, _| (x - 0.5).max(0.0)) - 2.0 / 3.0 * 0.125 * 0.25 / 0.25).abs() < 1e-12);
    }
}
