//! The functions around each vertex of a mesh, and their equations solved for at once.
//!
//! On a mesh of higher degree a node alone cannot be relaxed: what the vertices of the same mesh leave of the error is
//! smooth within no cell. All functions that vanish beyond the cells around a vertex are solved for together, one vertex
//! after the other; with functions of degree 1 for the rest this leaves a part of the error that depends neither on the
//! size of the cells nor on the degree. (L. F. Pavarino, Numer. Math. 66, 1993.)

use super::rows::Rows;
use nalgebra::DMatrix;
use signorini_fem::{Cells, MeshCells};
use signorini_solve::SolveError;

/// For each vertex, its patch.
pub(super) struct Patches {
    start: Vec<u32>,
    functions: Vec<u32>,
    /// The lower triangles of the Cholesky factors, row by row, with the inverse of each diagonal entry in its place.
    factor_start: Vec<usize>,
    factor: Vec<f64>,
}

impl Patches {
    /// The patches of all vertex functions; those of other functions are empty.
    ///
    /// # Errors
    /// A patch whose equations are not positive definite.
    pub fn new(cells: &MeshCells, rows: &Rows) -> Result<Self, SolveError> {
        let count = rows.diagonal.len();
        let mut lists: Vec<Vec<u32>> = vec![Vec::new(); count];
        for cell in 0..cells.count() {
            let corners = cells.corner_functions(cell);
            cells.for_each_function_at_corners(cell, |function, at| {
                for &corner in at {
                    let list = &mut lists[corners[corner] as usize];
                    if !list.contains(&function) {
                        list.push(function);
                    }
                }
            });
        }
        let mut out = Self { start: vec![0], functions: Vec::new(), factor_start: vec![0], factor: Vec::new() };
        for list in &lists {
            out.functions.extend(list);
            out.start.push(out.functions.len() as u32);
            let n = list.len();
            let mut matrix = DMatrix::zeros(n, n);
            for (a, &i) in list.iter().enumerate() {
                matrix[(a, a)] = rows.diagonal[i as usize];
                for (j, v) in rows.others(i as usize) {
                    if let Some(b) = list.iter().position(|k| *k as usize == j) {
                        matrix[(a, b)] = v;
                    }
                }
            }
            let factor = matrix.cholesky().ok_or(SolveError::NotPositiveDefinite { size: n, pivot: 0 })?;
            let lower = factor.l_dirty();
            for a in 0..n {
                out.factor.extend((0..a).map(|b| lower[(a, b)]));
                out.factor.push(1.0 / lower[(a, a)]);
            }
            out.factor_start.push(out.factor.len());
        }
        Ok(out)
    }

    /// Solves for the patch of a vertex, all else held. `left` is scratch.
    pub fn relax(&self, vertex: usize, rows: &Rows, u: &mut [f64], b: &[f64], left: &mut Vec<f64>) {
        let functions = &self.functions[self.start[vertex] as usize..self.start[vertex + 1] as usize];
        let factor = &self.factor[self.factor_start[vertex]..self.factor_start[vertex + 1]];
        left.clear();
        left.extend(functions.iter().map(|&i| {
            let i = i as usize;
            b[i] - rows.diagonal[i] * u[i] - rows.sum(i, u)
        }));
        let n = left.len();
        let row = |a: usize| &factor[a * (a + 1) / 2..(a + 1) * (a + 2) / 2];
        for a in 0..n {
            let sum: f64 = row(a)[..a].iter().zip(&left[..]).map(|(l, x)| l * x).sum();
            left[a] = (left[a] - sum) * row(a)[a];
        }
        for a in (0..n).rev() {
            left[a] *= row(a)[a];
            let x = left[a];
            left[..a].iter_mut().zip(row(a)).for_each(|(r, l)| *r -= l * x);
        }
        functions.iter().zip(left.iter()).for_each(|(&i, c)| u[i as usize] += c);
    }
}
