//! Newton's step of large systems by iterations.
//!
//! The stiffness of linear bodies is not assembled: products with it go cell by cell. Tractions that are unknowns belong to
//! one site each and are condensed there, `A - B D⁻¹ C`: what is left is that of penalties, symmetric and positive definite
//! without friction near the solution of small strains. It is solved by conjugate gradients, and where it is not symmetric
//! or not positive by conjugate residuals, with the Schwarz preconditioner of the sets that the bodies name, one more set for the unknowns of every part of the
//! tangent that is not theirs, such as the two cells that touch, and the coarse unknowns of all bodies together.

use crate::body::Body;
use crate::increment_error::IncrementError;
use crate::linear_solver::{Coarse, LinearSolver, Stiffness};
use crate::system::{Assembled, AssemblyError, System, SystemState};
use rayon::prelude::*;
use signorini_solve::blocks::{Block, BlockSum};
use signorini_solve::general::DenseBlocks;
use signorini_solve::krylov::{Stopped, conjugate_gradients, conjugate_residuals};
use signorini_solve::schwarz::{Inverses, Schwarz, Sets};
use signorini_solve::{SolveError, Symbolic, SymmetricMatrix};
use std::collections::{BTreeMap, BTreeSet};

/// Memory that a run by iterations takes, over that of its matrices: points, lists, results; 1.7 and 2.3 of balls of 16³ cells of
/// degree 3 and 30³ of degree 2, rounded up.
pub const BESIDE: f64 = 2.5;
/// Residual that iterations leave, relative to the first.
const TOLERANCE: f64 = 1e-8;
const MOST_ITERATIONS: usize = 1000;
/// Difference of an entry from its mirror image, relative to the largest of its block, that is rounding.
const ASYMMETRY: f64 = 1e-10;
/// Steps of conjugate residuals, which keep two vectors each.
const MOST_KEPT: usize = 300;

impl System {
    /// Whether Newton's steps are found by iterations: with bodies that offer them, tractions that can be condensed, and
    /// supports that hold unknowns by themselves.
    pub(crate) fn is_iterative(&self, state: &SystemState) -> Result<bool, AssemblyError> {
        let moved = || self.bodies.iter().filter(|b| b.unknowns() > 0);
        let many = moved().map(|b| b.many_unknowns()).min().flatten();
        let Some(many) = many else { return Ok(false) };
        let wanted = match self.solver {
            // Their preconditioners know no mass.
            _ if self.dynamics.is_some() || self.division.is_some() => false,
            LinearSolver::Direct => false,
            LinearSolver::Iterative => true,
            LinearSolver::Automatic => moved().map(|b| b.unknowns()).sum::<usize>() > many,
        };
        Ok(wanted && !self.contacts.iter().any(|c| c.law().is_exact()) && self.held(&state.bodies, 0.0)?.1.is_empty())
    }

    /// Whether iterations are chosen at the start, to be told.
    pub fn iterates(&self) -> bool {
        self.is_iterative(&self.start()).unwrap_or(false)
    }

    /// About what memory the bodies and the equations take, in bytes, without contacts and without bodies of few unknowns.
    pub fn memory(&self) -> f64 {
        let square = |list: &[u32]| 8.0 * (list.len() as f64).powi(2);
        let iterates = self.iterates();
        let of_body = |body: &dyn Body| {
            let own = body.subspaces();
            let coupled = if own.is_some() { Vec::new() } else { body.cliques() };
            let cliques: Vec<&[u32]> = match &own {
                Some(own) => own.stiffness.iter().map(|b| b.unknowns.as_slice()).collect(),
                None => coupled.iter().map(Vec::as_slice).collect(),
            };
            let cells: f64 = cliques.iter().map(|c| square(c)).sum();
            if let (true, Some(own)) = (iterates, &own) {
                // Cells that are alike share a matrix, and sets of unknowns of nothing else an inverse.
                let mut blocks_of: BTreeMap<*const f64, Vec<&Block<'_>>> = BTreeMap::new();
                own.stiffness.iter().for_each(|b| blocks_of.entry(b.entries.as_ptr()).or_default().push(b));
                let mut alike = vec![true; body.unknowns()];
                let alone = blocks_of.values().filter(|blocks| blocks.len() == 1).flatten();
                alone.flat_map(|b| &b.unknowns).for_each(|u| alike[*u as usize] = false);
                let cells: f64 = blocks_of.values().map(|blocks| square(&blocks[0].unknowns)).sum();
                let differs = |set: &&Vec<u32>| set.iter().any(|u| !alike[*u as usize]);
                // Inverses are kept as triangles.
                let local = 0.5 * own.sets.local.iter().filter(differs).map(|s| square(s)).sum::<f64>();
                if !own.sets.coarser.is_empty() {
                    // Rows of the coarse matrix: three directions of 27 vertices each, with their columns; coarser ones an
                    // eighth.
                    return BESIDE * (cells + local + 12.0 * 81.0 * 8.0 / 7.0 * own.sets.coarse.len() as f64);
                }
                let mut place = vec![u32::MAX; body.unknowns()];
                own.sets.coarse.iter().enumerate().for_each(|(i, (u, _))| place[*u as usize] = i as u32);
                let of = |c: &&[u32]| -> Vec<u32> {
                    c.iter().map(|u| place[*u as usize]).filter(|p| *p != u32::MAX).collect()
                };
                let pattern =
                    SymmetricMatrix::from_cliques(own.sets.coarse.len(), &cliques.iter().map(of).collect::<Vec<_>>());
                let position: Vec<[f64; 3]> = own.sets.coarse.iter().map(|c| c.1).collect();
                let coarse = Symbolic::dissected(position).cost(&pattern).map_or(0.0, |c| c.bytes);
                return BESIDE * (cells + local + coarse);
            }
            let factor = Symbolic::default().cost(&SymmetricMatrix::from_cliques(body.unknowns(), &cliques));
            // Entries with their rows and columns, before and after they are sorted; two factors with rows.
            5.0 * cells + 4.0 * factor.map_or(0.0, |c| c.bytes)
        };
        self.bodies.iter().filter(|b| b.unknowns() > 0).map(|b| of_body(b.as_ref())).sum()
    }

    /// The largest entry of each row of a tangent that was assembled, in the columns of the bodies: those of multipliers have another
    /// unit.
    pub(crate) fn row_sizes(&self, out: &Assembled, stiffness: Stiffness) -> Vec<f64> {
        let n = out.residual.len();
        let (first, count) = self.numbering();
        if let Some(division) = &self.division {
            return division.matrix(out).row_sizes(count);
        }
        if stiffness != Stiffness::KeptByBodies {
            let mut sizes = out.tangent.matrix(n).row_sizes_within(count);
            if stiffness == Stiffness::Condensed {
                self.condensed_row_sizes(&mut sizes);
            }
            return sizes;
        }
        let mut sizes = out.tangent.row_sizes(n, count);
        for (body, first) in self.bodies.iter().zip(first) {
            let mut diagonal = vec![0.0; body.unknowns()];
            for block in body.subspaces().iter().flat_map(|s| &s.stiffness) {
                let n = block.unknowns.len();
                block
                    .unknowns
                    .iter()
                    .enumerate()
                    .for_each(|(i, u)| diagonal[*u as usize] += block.entries[i * (n + 1)]);
            }
            for (size, own) in sizes[first as usize..].iter_mut().zip(&diagonal) {
                *size = size.max(own.abs());
            }
        }
        sizes
    }

    /// What the tangent at a state makes of a displacement of the bodies, iterations or not.
    pub(crate) fn product(&self, out: Assembled, x: &[f64]) -> Vec<f64> {
        let (_, count) = self.numbering();
        let condensed = Condensed::new(out, count);
        let (blocks, _) = self.blocks_and_sets(&condensed);
        BlockSum::new(blocks, vec![true; count]).multiply_all(&x[..count])
    }

    /// The matrices of bodies and of what is between them, and the sets of the preconditioner.
    fn blocks_and_sets<'a>(&'a self, condensed: &'a Condensed) -> (Vec<Block<'a>>, Sets) {
        let (first, _) = self.numbering();
        let mut sets = Sets::default();
        let mut blocks: Vec<Block<'a>> = Vec::new();
        for (body, first) in self.bodies.iter().zip(first) {
            let Some(own) = body.subspaces() else { continue };
            let shifted = |list: Vec<u32>| list.into_iter().map(|u| u + first).collect::<Vec<u32>>();
            blocks.extend(
                (own.stiffness.into_iter()).map(|b| Block { unknowns: shifted(b.unknowns), entries: b.entries }),
            );
            sets.append(own.sets, first);
        }
        let mut known: BTreeSet<Vec<u32>> = BTreeSet::new();
        for set in &sets.local {
            let mut sorted = set.clone();
            sorted.sort_unstable();
            known.insert(sorted);
        }
        for (unknowns, entries) in &condensed.blocks {
            blocks.push(Block { unknowns: unknowns.clone(), entries });
            let mut sorted = unknowns.clone();
            sorted.sort_unstable();
            sorted.dedup();
            if known.insert(sorted.clone()) {
                sets.local.push(sorted);
            }
        }
        (blocks, sets)
    }

    /// The step of all unknowns, and the number of iterations; `held` names unknowns whose step is known, and stands in
    /// `right`, the right-hand side. Inverses that are `known` from the last step are taken.
    pub(crate) fn iterated_step(
        &self,
        out: Assembled,
        held: &[bool],
        right: &[f64],
        known: &mut Inverses,
    ) -> Result<(Vec<f64>, usize), IncrementError> {
        let (_, count) = self.numbering();
        let condensed = Condensed::new(out, count);
        let equations = Reduced::new(self, &condensed, held, right);
        let kind = if condensed.is_symmetric() { Kind::Symmetric } else { Kind::General };
        let (mut x, iterations) = match equations.solve(&equations.matrix, kind, known) {
            Err(failed) if is_indefinite(&failed) => {
                // Newton's direction is that of the tangent as it is; where even that is not found, the direction without
                // what softens at least leads to less energy.
                let positive = condensed.without_negative_parts();
                let other = Reduced::new(self, &positive, held, right);
                let exact = equations.solve(&other.matrix, Kind::General, known);
                exact.or_else(|_| other.solve(&other.matrix, Kind::Symmetric, known))?
            }
            found => found?,
        };
        condensed.recover(&mut x, right);
        Ok((x, iterations))
    }

    /// How iterations solve for their coarse unknowns.
    pub(crate) fn coarse(&self) -> Coarse {
        let mut sets = self.bodies.iter().filter_map(|body| body.subspaces()).map(|own| own.sets);
        if sets.any(|sets| !sets.coarser.is_empty()) { Coarse::Multigrid } else { Coarse::Factorised }
    }
}

/// Which iteration a matrix allows.
#[derive(Clone, Copy)]
enum Kind {
    /// Conjugate gradients, unless a direction is found in which the matrix is not positive.
    Symmetric,
    /// Conjugate residuals.
    General,
}

fn is_indefinite(error: &SolveError) -> bool {
    matches!(error, SolveError::NotPositiveDefinite { .. })
}

/// The equations of the unknowns of the bodies that are free.
struct Reduced<'a> {
    matrix: BlockSum<'a>,
    sets: Sets,
    right: Vec<f64>,
    /// Steps that are known; zero where they are not.
    given: Vec<f64>,
}

impl<'a> Reduced<'a> {
    /// `held` names unknowns whose step is known, and stands in `right`.
    fn new(system: &'a System, condensed: &'a Condensed, held: &[bool], right: &[f64]) -> Self {
        let count = condensed.count;
        let (blocks, sets) = system.blocks_and_sets(condensed);
        let matrix = BlockSum::new(blocks, held[..count].iter().map(|h| !h).collect());
        let given: Vec<f64> = (0..count).map(|k| if held[k] { right[k] } else { 0.0 }).collect();
        let moved = matrix.multiply_all(&given);
        let of_bodies = condensed.right(right);
        let right = (0..count).map(|k| if held[k] { 0.0 } else { of_bodies[k] - moved[k] }).collect();
        Reduced { matrix, sets, right, given }
    }

    /// The step, and the number of iterations, preconditioned by the Schwarz method for a matrix that is like this one.
    fn solve(&self, like: &BlockSum<'_>, kind: Kind, known: &mut Inverses) -> Result<(Vec<f64>, usize), SolveError> {
        if self.right.iter().all(|b| *b == 0.0) {
            return Ok((self.given.clone(), 0));
        }
        let schwarz = Schwarz::new(like, &self.sets, known)?;
        let (mut x, iterations) = match kind {
            Kind::Symmetric => by_gradients(&self.matrix, &schwarz, &self.right)?,
            Kind::General => by_residuals(&self.matrix, &schwarz, self.right.clone())?,
        };
        let is_free = self.matrix.free();
        (0..x.len()).filter(|k| !is_free[*k]).for_each(|k| x[k] = self.given[k]);
        Ok((x, iterations))
    }
}

/// Conjugate gradients.
fn by_gradients(a: &BlockSum<'_>, schwarz: &Schwarz, b: &[f64]) -> Result<(Vec<f64>, usize), SolveError> {
    let size = b.len();
    conjugate_gradients(b, |x| a.multiply(x), |r| schwarz.apply(r), TOLERANCE, MOST_ITERATIONS)
        .map(|found| (found.x, found.iterations))
        .map_err(|stopped| match stopped {
            Stopped::Equations(error) => error,
            Stopped::TooMany { residual, .. } => SolveError::Inaccurate { size, residual },
            Stopped::Indefinite => SolveError::NotPositiveDefinite { size, pivot: 0 },
        })
}

/// Conjugate residuals.
fn by_residuals(a: &BlockSum<'_>, schwarz: &Schwarz, b: Vec<f64>) -> Result<(Vec<f64>, usize), SolveError> {
    let size = b.len();
    let iterations = std::cell::Cell::new(0);
    let product = |y: &[f64]| -> Result<Option<Vec<f64>>, SolveError> {
        iterations.set(iterations.get() + 1);
        Ok(Some(a.multiply(&schwarz.apply(y)?)))
    };
    match conjugate_residuals(b, product, TOLERANCE, MOST_KEPT)? {
        Some(y) => Ok((schwarz.apply(&y)?, iterations.get())),
        None => Err(SolveError::Inaccurate { size, residual: TOLERANCE }),
    }
}

/// A tangent without the stiffness of bodies, its own unknowns condensed site by site.
struct Condensed {
    /// Unknowns of bodies.
    count: usize,
    blocks: DenseBlocks,
    sites: Vec<SiteTerms>,
}

/// The terms of the unknowns of one site: `D`, and a row of `C` and a column of `B` for each.
#[derive(Clone)]
struct SiteTerms {
    first: usize,
    inverse: nalgebra::DMatrix<f64>,
    rows: Vec<Vec<(u32, f64)>>,
    columns: Vec<Vec<(u32, f64)>>,
}

impl Condensed {
    fn new(out: Assembled, count: usize) -> Self {
        let size = out.residual.len();
        let own = size - count;
        let (list, mut blocks) = out.tangent.into_parts();
        let mut rows: Vec<Vec<(u32, f64)>> = vec![Vec::new(); own];
        let mut columns = rows.clone();
        let mut between: Vec<(usize, usize, f64)> = Vec::new();
        // The last unknown that a site couples with one.
        let mut last: Vec<usize> = (0..own).collect();
        for (i, j, v) in list {
            match ((i as usize).checked_sub(count), (j as usize).checked_sub(count)) {
                (None, None) => {
                    let (unknowns, values) =
                        if i == j { (vec![i], vec![v]) } else { (vec![i, j], vec![0.0, v, 0.0, 0.0]) };
                    let sum = blocks.entry(unknowns).or_insert_with(|| vec![0.0; values.len()]);
                    sum.iter_mut().zip(&values).for_each(|(s, v)| *s += v);
                }
                (Some(i), None) => rows[i].push((j, v)),
                (None, Some(j)) => columns[j].push((i, v)),
                (Some(i), Some(j)) => {
                    between.push((i, j, v));
                    last[i.min(j)] = last[i.min(j)].max(i.max(j));
                }
            }
        }
        let mut site_of = vec![0; own];
        let mut starts: Vec<usize> = Vec::new();
        let mut end = 0;
        for k in 0..own {
            if k == end {
                starts.push(k);
            }
            site_of[k] = starts.len() - 1;
            end = end.max(last[k] + 1);
        }
        let length = |s: usize| starts.get(s + 1).copied().unwrap_or(own) - starts[s];
        let mut d: Vec<nalgebra::DMatrix<f64>> =
            (0..starts.len()).map(|s| nalgebra::DMatrix::zeros(length(s), length(s))).collect();
        for (i, j, v) in between {
            let s = site_of[i];
            d[s][(i - starts[s], j - starts[s])] += v;
        }
        let mut rest = rows.into_iter().zip(columns);
        let sites: Vec<SiteTerms> = (d.into_iter().zip(&starts))
            .map(|(d, first)| {
                let n = d.nrows();
                let (rows, columns) = rest.by_ref().take(n).unzip();
                let inverse = d.try_inverse().unwrap_or_else(|| nalgebra::DMatrix::zeros(n, n));
                SiteTerms { first: *first, inverse, rows, columns }
            })
            .collect();
        let mut out = Condensed { count, blocks, sites };
        out.condense();
        out
    }

    /// Subtracts `B D⁻¹ C`.
    fn condense(&mut self) {
        for site in &self.sites {
            for (i, column) in site.columns.iter().enumerate() {
                for (j, row) in site.rows.iter().enumerate() {
                    let factor = site.inverse[(i, j)];
                    if factor == 0.0 || column.is_empty() || row.is_empty() {
                        continue;
                    }
                    // Both go over the unknowns of the pair in the same order.
                    let unknowns: Vec<u32> = row.iter().map(|r| r.0).collect();
                    let n = unknowns.len();
                    debug_assert!(column.iter().map(|c| c.0).eq(unknowns.iter().copied()));
                    let sum = self.blocks.entry(unknowns).or_insert_with(|| vec![0.0; n * n]);
                    for (values, (_, b)) in sum.chunks_mut(n).zip(column) {
                        values.iter_mut().zip(row).for_each(|(s, (_, c))| *s -= b * factor * c);
                    }
                }
            }
        }
    }

    /// The same without the negative part of every block, made symmetric. A contact that is curved and carries much may
    /// soften more than the bodies resist, on the way of Newton's method and, where surfaces turn by large strains, in the
    /// solution: a preconditioner has to be positive all the same.
    fn without_negative_parts(&self) -> Self {
        let mut blocks = self.blocks.clone();
        blocks.par_iter_mut().for_each(|(unknowns, values)| {
            let n = unknowns.len();
            let whole = nalgebra::DMatrix::from_row_slice(n, n, values);
            let eigen = ((&whole + whole.transpose()) * 0.5).symmetric_eigen();
            let mut scaled = eigen.eigenvectors.clone();
            for (mut column, value) in scaled.column_iter_mut().zip(&eigen.eigenvalues) {
                column *= value.max(0.0);
            }
            values.copy_from_slice((scaled * eigen.eigenvectors.transpose()).as_slice());
        });
        Condensed { count: self.count, blocks, sites: self.sites.clone() }
    }

    fn is_symmetric(&self) -> bool {
        self.blocks.iter().all(|(unknowns, values)| {
            let n = unknowns.len();
            let most = values.iter().fold(0.0f64, |m, v| m.max(v.abs()));
            (0..n).all(|i| (0..i).all(|j| (values[i * n + j] - values[j * n + i]).abs() <= ASYMMETRY * most))
        })
    }

    /// Forces on the bodies, with what the conditions of the sites push.
    fn right(&self, right: &[f64]) -> Vec<f64> {
        let mut out = right[..self.count].to_vec();
        for site in &self.sites {
            for (i, column) in site.columns.iter().enumerate() {
                let of = |j: usize| site.inverse[(i, j)] * right[self.count + site.first + j];
                let traction: f64 = (0..site.rows.len()).map(of).sum();
                column.iter().for_each(|(u, b)| out[*u as usize] -= b * traction);
            }
        }
        out
    }

    /// Appends the unknowns of the sites.
    fn recover(&self, x: &mut Vec<f64>, right: &[f64]) {
        for site in &self.sites {
            let lacks: Vec<f64> = (site.rows.iter().enumerate())
                .map(|(j, row)| {
                    right[self.count + site.first + j] - row.iter().map(|(u, c)| c * x[*u as usize]).sum::<f64>()
                })
                .collect();
            for i in 0..lacks.len() {
                x.push((0..lacks.len()).map(|j| site.inverse[(i, j)] * lacks[j]).sum());
            }
        }
    }
}
