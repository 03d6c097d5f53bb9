//! Conjugate gradients with additive Schwarz blocks.
//!
//! One block for each *vertex star* (all functions that vanish outside the cells around a vertex), one for each cut cell
//! (where functions become almost dependent), and one coarse level of all functions of vertices. The condition is then
//! independent of the cuts, of the number of cells and nearly of the degree: in space the functions themselves, not the
//! cuts, are the larger part of the trouble. Stars of full cells of the grid are alike and share one factor.

use crate::body::CellBody;
use crate::error::CellsError;
use crate::region::Filling;
use crate::system::Scaled;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rayon::prelude::*;
use signorini_solve::SymmetricMatrix;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A block: its unknowns, and the inverse of its part of the matrix, scaled to a unit diagonal.
struct Block {
    unknowns: Vec<u32>,
    scale: Vec<f64>,
    inverse: Arc<Inverse>,
}

enum Inverse {
    Factor(Cholesky<f64, Dyn>),
    /// `V Λ⁻¹ Vᵀ` over the eigenvalues above round-off.
    Spectral(DMatrix<f64>),
}

/// Eigenvalues of a block below this share of the largest are round-off.
const ROUND_OFF: f64 = 1e-14;

/// The preconditioner of a matrix.
pub struct Schwarz<'a> {
    matrix: Rows,
    blocks: Vec<Block>,
    coarse: (Vec<u32>, Scaled),
    free: &'a [bool],
}

/// What conjugate gradients found.
#[derive(Clone, Debug)]
pub struct Found {
    pub x: Vec<f64>,
    pub iterations: usize,
    /// Condition of the preconditioned matrix, from the coefficients of the iteration (Lanczos).
    pub condition: f64,
}

/// Whole rows of a symmetric matrix.
struct Rows {
    start: Vec<usize>,
    column: Vec<u32>,
    value: Vec<f64>,
}

impl Rows {
    fn new(matrix: &SymmetricMatrix) -> Self {
        let n = matrix.size();
        let mut start = vec![0usize; n + 1];
        for (i, j, _) in matrix.entries() {
            start[i + 1] += 1;
            if i != j {
                start[j + 1] += 1;
            }
        }
        for i in 0..n {
            start[i + 1] += start[i];
        }
        let mut fill = start.clone();
        let (mut column, mut value) = (vec![0u32; start[n]], vec![0.0; start[n]]);
        let mut put = |i: usize, j: usize, v: f64| {
            (column[fill[i]], value[fill[i]]) = (j as u32, v);
            fill[i] += 1;
        };
        for (i, j, v) in matrix.entries() {
            put(i, j, v);
            if i != j {
                put(j, i, v);
            }
        }
        Rows { start, column, value }
    }

    fn multiply(&self, x: &[f64]) -> Vec<f64> {
        let row = |i: usize| {
            let range = self.start[i]..self.start[i + 1];
            range.map(|k| self.value[k] * x[self.column[k] as usize]).sum()
        };
        (0..x.len()).into_par_iter().map(row).collect()
    }

    /// The part of some unknowns, scaled to a unit diagonal, and the scale.
    fn part(&self, unknowns: &[u32]) -> (DMatrix<f64>, Vec<f64>) {
        let place: BTreeMap<u32, usize> = unknowns.iter().enumerate().map(|(i, u)| (*u, i)).collect();
        let n = unknowns.len();
        let mut out = DMatrix::<f64>::zeros(n, n);
        for (i, u) in unknowns.iter().enumerate() {
            for k in self.start[*u as usize]..self.start[*u as usize + 1] {
                if let Some(j) = place.get(&self.column[k]) {
                    out[(i, *j)] = self.value[k];
                }
            }
        }
        let scale: Vec<f64> = (0..n).map(|i| if out[(i, i)] > 0.0 { 1.0 / out[(i, i)].sqrt() } else { 1.0 }).collect();
        for i in 0..n {
            for j in 0..n {
                out[(i, j)] *= scale[i] * scale[j];
            }
        }
        (out, scale)
    }
}

impl Inverse {
    fn new(matrix: DMatrix<f64>) -> Self {
        // A factor with pivots well above round-off is as good as the spectrum, and far cheaper.
        if let Some(factor) = matrix.clone().cholesky() {
            let least = (0..matrix.nrows()).map(|i| factor.l_dirty()[(i, i)]).fold(f64::INFINITY, f64::min);
            if least * least > 1e-12 {
                return Inverse::Factor(factor);
            }
        }
        let eigen = matrix.symmetric_eigen();
        let most = eigen.eigenvalues.max();
        let mut scaled = eigen.eigenvectors.clone();
        for (mut column, value) in scaled.column_iter_mut().zip(&eigen.eigenvalues) {
            column *= if *value > ROUND_OFF * most { 1.0 / value } else { 0.0 };
        }
        Inverse::Spectral(scaled * eigen.eigenvectors.transpose())
    }
}

impl<'a> Schwarz<'a> {
    /// The preconditioner of the matrix of a body, in which rows that are not free are decoupled from the others.
    ///
    /// # Errors
    /// A coarse level that cannot be factorised, as of a body that nothing holds.
    pub fn new<const D: usize>(
        body: &CellBody<D>,
        matrix: &SymmetricMatrix,
        free: &'a [bool],
    ) -> Result<Self, CellsError> {
        let rows = Rows::new(matrix);
        let functions = body.function_count();
        let mut cells_of: Vec<Vec<usize>> = vec![Vec::new(); functions];
        for (c, cell) in body.cells().iter().enumerate() {
            cell.functions.iter().for_each(|f| cells_of[*f as usize].push(c));
        }
        let mut covered = vec![false; functions];
        let mut sets: Vec<(Vec<u32>, bool)> = Vec::new();
        for v in (0..functions).filter(|f| body.is_vertex(*f)) {
            let around = &cells_of[v];
            let mut members: Vec<u32> =
                around.iter().flat_map(|c| body.cells()[*c].functions.iter().copied()).collect();
            members.sort_unstable();
            members.dedup();
            members.retain(|f| cells_of[*f as usize].iter().all(|c| around.binary_search(c).is_ok()));
            members.sort_by_key(|f| place_in_star(body, *f as usize));
            members.iter().for_each(|f| covered[*f as usize] = true);
            let full = |c: &usize| {
                body.cells()[*c].rule.filling == Filling::Full && body.tree().leaves()[body.cells()[*c].leaf].level == 0
            };
            let alike = around.len() == 1 << D && around.iter().all(full) && body.is_homogeneous();
            sets.push((members, alike));
        }
        for cell in body.cells().iter().filter(|c| c.rule.filling == Filling::Cut) {
            sets.push((cell.functions.clone(), false));
        }
        sets.extend((0..functions).filter(|f| !covered[*f]).map(|f| (vec![f as u32], false)));
        let unknowns_of = |set: &[u32]| -> Vec<u32> {
            let all = set.iter().flat_map(|f| (0..D as u32).map(move |k| D as u32 * f + k));
            all.filter(|u| free[*u as usize]).collect()
        };
        // Stars that neither a support nor the box of the cells touches are alike: one of them is factorised.
        let smallest = sets.iter().filter(|s| s.1).map(|s| s.0.len()).min().unwrap_or(0);
        let is_alike =
            |(set, alike): &(Vec<u32>, bool)| *alike && set.len() == smallest && unknowns_of(set).len() == D * smallest;
        let shared = sets.iter().find(|s| is_alike(s)).map(|(set, _)| {
            let (part, scale) = rows.part(&unknowns_of(set));
            (Arc::new(Inverse::new(part)), scale)
        });
        let blocks = (sets.par_iter())
            .filter_map(|set| {
                let unknowns = unknowns_of(&set.0);
                if unknowns.is_empty() {
                    return None;
                }
                if let (Some((inverse, scale)), true) = (&shared, is_alike(set)) {
                    return Some(Block { unknowns, scale: scale.clone(), inverse: inverse.clone() });
                }
                let (part, scale) = rows.part(&unknowns);
                Some(Block { unknowns, scale, inverse: Arc::new(Inverse::new(part)) })
            })
            .collect();
        let coarse: Vec<u32> =
            unknowns_of(&(0..functions as u32).filter(|f| body.is_vertex(*f as usize)).collect::<Vec<u32>>());
        let mut place = vec![u32::MAX; matrix.size()];
        coarse.iter().enumerate().for_each(|(i, u)| place[*u as usize] = i as u32);
        let mut columns: Vec<Vec<(usize, f64)>> = vec![Vec::new(); coarse.len()];
        for (i, j, v) in matrix.entries() {
            let (a, b) = (place[i], place[j]);
            if a != u32::MAX && b != u32::MAX {
                columns[a.min(b) as usize].push((a.max(b) as usize, v));
            }
        }
        let part = SymmetricMatrix::from_columns(coarse.len(), |j, out| out.extend_from_slice(&columns[j]));
        let position: Vec<[f64; D]> = coarse.iter().map(|u| body.position(*u as usize / D).into()).collect();
        let factor = Scaled::at(&position, part)?;
        Ok(Schwarz { matrix: rows, blocks, coarse: (coarse, factor), free })
    }

    fn apply(&self, r: &[f64]) -> Result<Vec<f64>, CellsError> {
        let parts: Vec<DVector<f64>> = (self.blocks.par_iter())
            .map(|b| {
                let mut x = DVector::from_fn(b.unknowns.len(), |i, _| r[b.unknowns[i] as usize] * b.scale[i]);
                match &*b.inverse {
                    Inverse::Factor(factor) => factor.solve_mut(&mut x),
                    Inverse::Spectral(inverse) => x = inverse * x,
                }
                x
            })
            .collect();
        let mut z: Vec<f64> = (0..r.len()).map(|i| if self.free[i] { 0.0 } else { r[i] }).collect();
        for (b, x) in self.blocks.iter().zip(&parts) {
            for (i, u) in b.unknowns.iter().enumerate() {
                z[*u as usize] += x[i] * b.scale[i];
            }
        }
        let (unknowns, factor) = &self.coarse;
        let of_coarse: Vec<f64> = unknowns.iter().map(|u| r[*u as usize]).collect();
        for (u, x) in unknowns.iter().zip(factor.solve_once(&of_coarse)?) {
            z[*u as usize] += x;
        }
        Ok(z)
    }

    /// Solves `A x = b` to a relative residual in the norm of the preconditioner.
    ///
    /// # Errors
    /// Not reached in as many iterations.
    pub fn conjugate_gradients(&self, b: &[f64], tolerance: f64, most: usize) -> Result<Found, CellsError> {
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        // What is not free is known at once.
        let diagonal = |i: usize| {
            let range = self.matrix.start[i]..self.matrix.start[i + 1];
            range.clone().find(|k| self.matrix.column[*k] as usize == i).map_or(1.0, |k| self.matrix.value[k])
        };
        let mut x: Vec<f64> = (0..b.len()).map(|i| if self.free[i] { 0.0 } else { b[i] / diagonal(i) }).collect();
        let mut r: Vec<f64> = (0..b.len()).map(|i| if self.free[i] { b[i] } else { 0.0 }).collect();
        let mut z = self.apply(&r)?;
        let mut p = z.clone();
        let mut rz = dot(&r, &z);
        let first = rz;
        let (mut steps, mut ratios): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
        while rz > tolerance * tolerance * first {
            if steps.len() == most {
                return Err(CellsError::Iterations { iterations: most, residual: (rz / first).sqrt() });
            }
            let ap = self.matrix.multiply(&p);
            let step = rz / dot(&p, &ap);
            for i in 0..x.len() {
                x[i] += step * p[i];
                r[i] -= step * ap[i];
            }
            z = self.apply(&r)?;
            let next = dot(&r, &z);
            let ratio = next / rz;
            rz = next;
            steps.push(step);
            ratios.push(ratio);
            for i in 0..p.len() {
                p[i] = z[i] + ratio * p[i];
            }
        }
        Ok(Found { x, iterations: steps.len(), condition: condition(&steps, &ratios) })
    }
}

/// The condition from the tridiagonal matrix that the coefficients of conjugate gradients make.
fn condition(steps: &[f64], ratios: &[f64]) -> f64 {
    let n = steps.len();
    if n == 0 {
        return 1.0;
    }
    let mut t = DMatrix::<f64>::zeros(n, n);
    for i in 0..n {
        t[(i, i)] = 1.0 / steps[i] + if i > 0 { ratios[i - 1] / steps[i - 1] } else { 0.0 };
        if i + 1 < n {
            t[(i, i + 1)] = ratios[i].sqrt() / steps[i];
            t[(i + 1, i)] = t[(i, i + 1)];
        }
    }
    let values = t.symmetric_eigenvalues();
    values.max() / values.min()
}

/// Sorts the functions of a star in the same way wherever the star lies.
fn place_in_star<const D: usize>(body: &CellBody<D>, function: usize) -> Vec<usize> {
    let mode = body.mode(function);
    let mut out = vec![mode.level];
    for k in 0..D {
        let n = body.tree().count(mode.level, k);
        let id = mode.ids[k];
        let bubbles = body.degree().max(2) - 1;
        out.extend(if id <= n { [2 * id, 0] } else { [2 * ((id - n - 1) / bubbles) + 1, (id - n - 1) % bubbles] });
    }
    out
}
