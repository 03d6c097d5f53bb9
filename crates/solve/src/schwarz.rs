//! Two-level additive Schwarz preconditioners: small sets of unknowns whose parts of a matrix are inverted, and one coarse
//! set, factorised or solved by one cycle of multigrid (Widlund & Toselli, *Domain Decomposition Methods*, 2005).
//!
//! Inverses are kept by what they are inverses of: sets with the same part share one, and a matrix that differs from
//! the last in some places only has most of its inverses already.

use crate::blocks::{BlockSum, dot};
use crate::cholesky::{Factor, SolveError, Symbolic};
use crate::dense::positive_inverse;
use crate::multigrid::{Multigrid, Transfer};
use crate::sparse::SymmetricMatrix;
use nalgebra::DMatrix;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The sets of unknowns of a preconditioner. Together they hold all unknowns that are free.
#[derive(Clone, Debug, Default)]
pub struct Sets {
    pub local: Vec<Vec<u32>>,
    /// With their places, by which they are ordered for elimination.
    pub coarse: Vec<(u32, [f64; 3])>,
    /// How the coarse unknowns, in their order, are made of those of ever coarser levels; none where they are few enough to
    /// be factorised.
    pub coarser: Vec<Transfer>,
}

impl Sets {
    /// Adds the sets of other unknowns, which begin at `first`.
    pub fn append(&mut self, other: Sets, first: u32) {
        let shifted = |list: Vec<u32>| list.into_iter().map(|u| u + first).collect::<Vec<u32>>();
        let mut sizes = [self.coarse.len(), other.coarse.len()];
        self.local.extend(other.local.into_iter().map(shifted));
        self.coarse.extend(other.coarse.into_iter().map(|(u, x)| (u + first, x)));
        // What has no coarser level stays as it is while others are coarsened.
        let same = |n: usize| Transfer { columns: n, rows: (0..n as u32).map(|k| vec![(k, 1.0)]).collect() };
        let levels = self.coarser.len().max(other.coarser.len());
        let mut theirs = other.coarser.into_iter();
        for level in 0..levels {
            if level == self.coarser.len() {
                self.coarser.push(same(sizes[0]));
            }
            let own = &mut self.coarser[level];
            let theirs = theirs.next().unwrap_or_else(|| same(sizes[1]));
            let before = own.columns as u32;
            sizes = [own.columns, theirs.columns];
            own.columns += theirs.columns;
            let moved = |row: Vec<(u32, f64)>| row.into_iter().map(|(j, v)| (j + before, v)).collect();
            own.rows.extend(theirs.rows.into_iter().map(moved));
        }
    }
}

/// A set with the inverse of its part of the matrix, scaled to a unit diagonal.
struct Local {
    unknowns: Vec<u32>,
    scale: Vec<f64>,
    /// Shared by sets with the same part.
    inverse: Arc<Inverse>,
}

/// The lower triangle of a symmetric matrix, row by row.
struct Inverse(Vec<f64>);

/// Inverses by what tells parts apart.
#[derive(Clone, Default)]
pub struct Inverses(BTreeMap<[u64; 2], Arc<Inverse>>);

/// How the coarse set is solved.
enum Coarse {
    None,
    Factor(Factor, Vec<f64>),
    Cycle(Multigrid),
}

/// Eigenvalues of a set below this share of the largest are round-off.
const ROUND_OFF: f64 = 1e-14;
/// Pivots of a set above which its factor is as good as its spectrum, and far cheaper.
const PIVOT: f64 = 1e-12;

/// A preconditioner.
pub struct Schwarz {
    local: Vec<Local>,
    coarse: Vec<u32>,
    solver: Coarse,
    free: Vec<bool>,
}

impl Inverse {
    fn new(matrix: DMatrix<f64>) -> Self {
        if let Some(inverse) = positive_inverse(matrix.clone(), PIVOT) {
            return Inverse(inverse);
        }
        let n = matrix.nrows();
        let eigen = matrix.symmetric_eigen();
        let most = eigen.eigenvalues.max();
        let mut scaled = eigen.eigenvectors.clone();
        for (mut column, value) in scaled.column_iter_mut().zip(&eigen.eigenvalues) {
            column *= if *value > ROUND_OFF * most { 1.0 / value } else { 0.0 };
        }
        let inverse = scaled * eigen.eigenvectors.transpose();
        Inverse((0..n).flat_map(|i| (0..=i).map(move |j| (i, j))).map(|place| inverse[place]).collect())
    }

    /// The product with a vector.
    fn multiply(&self, x: &[f64]) -> Vec<f64> {
        let mut y = vec![0.0; x.len()];
        let mut rest = &self.0[..];
        for i in 0..x.len() {
            let (row, after) = rest.split_at(i + 1);
            rest = after;
            let (before, own) = y.split_at_mut(i);
            own[0] = row[i] * x[i] + dot(&row[..i], &x[..i]);
            before.iter_mut().zip(row).for_each(|(y, a)| *y += a * x[i]);
        }
        y
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
fn inverses(a: &BlockSum<'_>, sets: &[Vec<u32>], known: &mut Inverses) -> Vec<Local> {
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
    known.0.retain(|signature, _| first.contains_key(signature));
    let new: Vec<([u64; 2], usize)> = first.into_iter().filter(|(s, _)| !known.0.contains_key(s)).collect();
    let found: Vec<Arc<Inverse>> = (new.par_iter())
        .map_init(room, |place, (_, k)| Arc::new(Inverse::new(scaled_part(a, &free[*k], place).0)))
        .collect();
    known.0.extend(new.into_iter().map(|n| n.0).zip(found));
    let known = &known.0;
    (free.into_par_iter().zip(signatures))
        .map_init(room, |place, (unknowns, signature)| {
            let (_, scale) = scaled_part(a, &unknowns, place);
            Local { unknowns, scale, inverse: known[&signature].clone() }
        })
        .collect()
}

impl Local {
    fn apply(&self, r: &[f64]) -> Vec<f64> {
        let x: Vec<f64> = self.unknowns.iter().zip(&self.scale).map(|(u, s)| r[*u as usize] * s).collect();
        let mut x = self.inverse.multiply(&x);
        x.iter_mut().zip(&self.scale).for_each(|(x, s)| *x *= s);
        x
    }
}

impl Schwarz {
    /// The preconditioner of the symmetric part of a matrix; inverses that are `known` are taken, and those that are used are
    /// left there.
    ///
    /// # Errors
    /// A coarse part that is not positive definite, as of a body that nothing holds.
    pub fn new(a: &BlockSum<'_>, sets: &Sets, known: &mut Inverses) -> Result<Self, SolveError> {
        let free = a.free();
        let kept: Vec<usize> = (0..sets.coarse.len()).filter(|k| free[sets.coarse[*k].0 as usize]).collect();
        let coarse: Vec<u32> = kept.iter().map(|k| sets.coarse[*k].0).collect();
        let local = inverses(a, &sets.local, known);
        let solver = if coarse.is_empty() {
            Coarse::None
        } else if let [finest, others @ ..] = &sets.coarser[..] {
            let finest =
                Transfer { columns: finest.columns, rows: kept.iter().map(|k| finest.rows[*k].clone()).collect() };
            let transfers = std::iter::once(finest).chain(others.iter().cloned()).collect();
            Coarse::Cycle(Multigrid::new(coarse_part(a, &coarse), transfers)?)
        } else {
            let matrix = coarse_part(a, &coarse);
            let scale: Vec<f64> =
                matrix.diagonal().iter().map(|d| if *d > 0.0 { 1.0 / d.sqrt() } else { 1.0 }).collect();
            let scaled = matrix.scaled(&scale);
            let position: Vec<[f64; 3]> = kept.iter().map(|k| sets.coarse[*k].1).collect();
            Coarse::Factor(Symbolic::dissected(position).factor(scaled)?, scale)
        };
        Ok(Schwarz { local, coarse, solver, free: free.to_vec() })
    }

    /// What is about `A⁻¹ r`.
    ///
    /// # Errors
    /// Numbers that are not finite.
    pub fn apply(&self, r: &[f64]) -> Result<Vec<f64>, SolveError> {
        let parts: Vec<Vec<f64>> = self.local.par_iter().map(|l| l.apply(r)).collect();
        let mut z: Vec<f64> = (r.iter().zip(&self.free)).map(|(r, free)| if *free { 0.0 } else { *r }).collect();
        for (l, x) in self.local.iter().zip(&parts) {
            l.unknowns.iter().zip(x).for_each(|(u, x)| z[*u as usize] += x);
        }
        let own: Vec<f64> = self.coarse.iter().map(|u| r[*u as usize]).collect();
        let x = match &self.solver {
            Coarse::None => own,
            Coarse::Factor(factor, scale) => {
                let mut x: Vec<f64> = own.iter().zip(scale).map(|(r, s)| r * s).collect();
                factor.solve_once(&mut x)?;
                x.iter_mut().zip(scale).for_each(|(x, s)| *x *= s);
                x
            }
            Coarse::Cycle(cycle) => cycle.apply(&own)?,
        };
        self.coarse.iter().zip(&x).for_each(|(u, x)| z[*u as usize] += x);
        Ok(z)
    }
}

/// The part of the coarse unknowns.
fn coarse_part(a: &BlockSum<'_>, coarse: &[u32]) -> SymmetricMatrix {
    let mut place = vec![u32::MAX; a.size()];
    coarse.iter().enumerate().for_each(|(i, u)| place[*u as usize] = i as u32);
    let cliques: Vec<(Vec<u32>, Vec<f64>)> = (a.blocks().iter())
        .map(|b| {
            let n = b.unknowns.len();
            let own: Vec<usize> = (0..n).filter(|k| place[b.unknowns[*k] as usize] != u32::MAX).collect();
            let entry = |i: usize, j: usize| 0.5 * (b.entries[i * n + j] + b.entries[j * n + i]);
            let entries = own.iter().flat_map(|i| own.iter().map(move |j| entry(*i, *j))).collect();
            (own.iter().map(|k| place[b.unknowns[*k] as usize]).collect(), entries)
        })
        .collect();
    SymmetricMatrix::of_cliques(coarse.len(), &cliques)
}
