//! Two-level additive Schwarz preconditioners: small sets of unknowns whose parts of a matrix are inverted, and one coarse
//! set, factorised (Widlund & Toselli, *Domain Decomposition Methods*, 2005).

use crate::blocks::BlockSum;
use crate::cholesky::{Factor, SolveError, Symbolic};
use crate::dissection::nested_dissection;
use crate::sparse::SymmetricMatrix;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn};
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The sets of unknowns of a preconditioner. Together they hold all unknowns that are free.
#[derive(Clone, Debug, Default)]
pub struct Sets {
    pub local: Vec<Vec<u32>>,
    /// With their places, by which they are ordered for elimination.
    pub coarse: Vec<(u32, [f64; 3])>,
}

/// A set with the inverse of its part of the matrix, scaled to a unit diagonal.
struct Local {
    unknowns: Vec<u32>,
    scale: Vec<f64>,
    /// Shared by sets with the same part.
    inverse: Arc<Inverse>,
}

enum Inverse {
    Factor(Cholesky<f64, Dyn>),
    /// `V Λ⁻¹ Vᵀ` over the eigenvalues above round-off.
    Spectral(DMatrix<f64>),
}

/// Eigenvalues of a set below this share of the largest are round-off.
const ROUND_OFF: f64 = 1e-14;
/// Pivots of a set above which its factor is as good as its spectrum, and far cheaper.
const PIVOT: f64 = 1e-12;

/// A preconditioner.
pub struct Schwarz {
    local: Vec<Local>,
    coarse: Vec<u32>,
    scale: Vec<f64>,
    factor: Option<Factor>,
    free: Vec<bool>,
}

impl Inverse {
    fn new(matrix: DMatrix<f64>) -> Self {
        if let Some(factor) = matrix.clone().cholesky() {
            let least = (0..matrix.nrows()).map(|i| factor.l_dirty()[(i, i)]).fold(f64::INFINITY, f64::min);
            if least * least > PIVOT {
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

/// The part of a set scaled to a unit diagonal, and the scale.
fn scaled_part(a: &BlockSum<'_>, unknowns: &[u32], place: &mut [u32]) -> (DMatrix<f64>, Vec<f64>) {
    let mut part = a.part(unknowns, place);
    let n = unknowns.len();
    let scale: Vec<f64> = (0..n).map(|i| if part[(i, i)] > 0.0 { 1.0 / part[(i, i)].sqrt() } else { 1.0 }).collect();
    for j in 0..n {
        for i in 0..n {
            part[(i, j)] *= scale[i] * scale[j];
        }
    }
    (part, scale)
}

/// What tells parts apart: all bits of their entries, mixed into two words (Fowler, Noll & Vo's mixing, from two starts).
fn signature(part: &DMatrix<f64>) -> [u64; 2] {
    let mut words: [u64; 2] = [0xcbf2_9ce4_8422_2325, 0x9e37_79b9_7f4a_7c15];
    for v in part.iter() {
        for (word, prime) in words.iter_mut().zip([0x0000_0100_0000_01b3, 0x9fb2_1c65_1e98_df25]) {
            *word = (*word ^ v.to_bits()).wrapping_mul(prime);
            *word ^= *word >> 32;
        }
    }
    words
}

/// The inverses of all sets with free unknowns; cells of a grid are alike, and so are the sets of their vertices.
fn inverses(a: &BlockSum<'_>, sets: &[Vec<u32>]) -> Vec<Local> {
    let room = || vec![u32::MAX; a.size()];
    let free: Vec<Vec<u32>> = (sets.iter())
        .map(|set| set.iter().copied().filter(|u| a.free()[*u as usize]).collect::<Vec<u32>>())
        .filter(|set| !set.is_empty())
        .collect();
    let signatures: Vec<[u64; 2]> =
        (free.par_iter()).map_init(room, |place, set| signature(&scaled_part(a, set, place).0)).collect();
    let mut first: BTreeMap<[u64; 2], usize> = BTreeMap::new();
    signatures.iter().enumerate().for_each(|(k, s)| {
        first.entry(*s).or_insert(k);
    });
    let unique: Vec<usize> = first.values().copied().collect();
    let found: Vec<Arc<Inverse>> = (unique.par_iter())
        .map_init(room, |place, k| Arc::new(Inverse::new(scaled_part(a, &free[*k], place).0)))
        .collect();
    let by_signature: BTreeMap<[u64; 2], Arc<Inverse>> = first.keys().copied().zip(found).collect();
    (free.into_par_iter().zip(signatures))
        .map_init(room, |place, (unknowns, signature)| {
            let (_, scale) = scaled_part(a, &unknowns, place);
            Local { unknowns, scale, inverse: by_signature[&signature].clone() }
        })
        .collect()
}

impl Local {
    fn apply(&self, r: &[f64]) -> DVector<f64> {
        let mut x = DVector::from_fn(self.unknowns.len(), |i, _| r[self.unknowns[i] as usize] * self.scale[i]);
        match &*self.inverse {
            Inverse::Factor(factor) => factor.solve_mut(&mut x),
            Inverse::Spectral(inverse) => x = inverse * x,
        }
        x
    }
}

impl Schwarz {
    /// The preconditioner of the symmetric part of a matrix.
    ///
    /// # Errors
    /// A coarse part that is not positive definite, as of a body that nothing holds.
    pub fn new(a: &BlockSum<'_>, sets: &Sets) -> Result<Self, SolveError> {
        let free = a.free();
        let (coarse, position): (Vec<u32>, Vec<[f64; 3]>) =
            sets.coarse.iter().filter(|c| free[c.0 as usize]).copied().unzip();
        let mut out =
            Schwarz { local: inverses(a, &sets.local), coarse, scale: Vec::new(), factor: None, free: free.to_vec() };
        if !out.coarse.is_empty() {
            out.factorise(a, &position)?;
        }
        Ok(out)
    }

    fn factorise(&mut self, a: &BlockSum<'_>, position: &[[f64; 3]]) -> Result<(), SolveError> {
        let mut place = vec![u32::MAX; a.size()];
        self.coarse.iter().enumerate().for_each(|(i, u)| place[*u as usize] = i as u32);
        let cliques: Vec<(Vec<u32>, Vec<f64>)> = (a.blocks().iter())
            .map(|b| {
                let n = b.unknowns.len();
                let own: Vec<usize> = (0..n).filter(|k| place[b.unknowns[*k] as usize] != u32::MAX).collect();
                let entry = |i: usize, j: usize| 0.5 * (b.entries[i * n + j] + b.entries[j * n + i]);
                let entries = own.iter().flat_map(|i| own.iter().map(move |j| entry(*i, *j))).collect();
                (own.iter().map(|k| place[b.unknowns[*k] as usize]).collect(), entries)
            })
            .collect();
        let matrix = SymmetricMatrix::of_cliques(self.coarse.len(), &cliques);
        self.scale = matrix.diagonal().iter().map(|d| if *d > 0.0 { 1.0 / d.sqrt() } else { 1.0 }).collect();
        let scaled = matrix.scaled(&self.scale);
        let order = nested_dissection(&scaled, position);
        self.factor = Some(Symbolic::ordered(order).factor(scaled)?);
        Ok(())
    }

    /// What is about `A⁻¹ r`.
    ///
    /// # Errors
    /// Numbers that are not finite.
    pub fn apply(&self, r: &[f64]) -> Result<Vec<f64>, SolveError> {
        let parts: Vec<DVector<f64>> = self.local.par_iter().map(|l| l.apply(r)).collect();
        let mut z: Vec<f64> = (r.iter().zip(&self.free)).map(|(r, free)| if *free { 0.0 } else { *r }).collect();
        for (l, x) in self.local.iter().zip(&parts) {
            for (i, u) in l.unknowns.iter().enumerate() {
                z[*u as usize] += x[i] * l.scale[i];
            }
        }
        if let Some(factor) = &self.factor {
            let mut x: Vec<f64> = self.coarse.iter().zip(&self.scale).map(|(u, s)| r[*u as usize] * s).collect();
            factor.solve_once(&mut x)?;
            for ((u, s), x) in self.coarse.iter().zip(&self.scale).zip(&x) {
                z[*u as usize] += x * s;
            }
        }
        Ok(z)
    }
}
