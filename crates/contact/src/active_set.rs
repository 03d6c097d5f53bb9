//! Which pressure nodes carry: the primal-dual active set method, a semismooth Newton method (Hintermüller, Ito &
//! Kunisch 2002).
//!
//! The bodies are linear, so everything happens on the pressures: with the compliance `V = K⁻¹Bᵀ` of the nodes that were
//! ever active, each step solves a dense system for the pressures of the active set. A node is active next if
//! `λ - c g/w > 0`; after the first step one of the two is zero, so the constant `c` decides nothing and units do not
//! matter. Bodies that only contact holds are held by springs meanwhile, whose forces the same dense system takes away.

use crate::mortar::WeightedGap;
use nalgebra::{DMatrix, DVector};
use signorini_solve::SolveError;
use std::collections::{BTreeSet, HashMap};

/// Why no contact state was found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ActiveSetError {
    #[error(transparent)]
    Solve(#[from] SolveError),
    #[error("the contact found does not hold the bodies")]
    Free,
    /// Rows that change from one state to the other for ever.
    #[error("the contact state alternates at {} nodes", nodes.len())]
    Chatter { nodes: Vec<u32> },
    #[error("no contact state was found in {iterations} iterations")]
    TooMany { iterations: usize },
    #[error("interrupted")]
    Interrupted,
}

/// The elastic system as the active set sees it: solves with the stiffness, springs included.
pub trait Compliance {
    /// `K_c⁻¹ b`.
    fn solve(&self, b: &[f64]) -> Result<Vec<f64>, SolveError>;
    fn size(&self) -> usize;
}

/// A spring that holds a body until contact does: it acts on one unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    pub unknown: u32,
    pub stiffness: f64,
}

/// Columns of the compliance, kept from step to step as long as the rows stay the same.
#[derive(Default)]
pub struct ActiveSet {
    /// Terms of every row, to see whether they changed.
    rows: Vec<Vec<(u32, f64)>>,
    springs: Vec<Spring>,
    /// Unknowns that rows and springs touch, and their places.
    touched: Vec<u32>,
    place: HashMap<u32, usize>,
    /// Displacements of the touched unknowns under a unit pressure of a row, or a unit force of a spring.
    columns: HashMap<usize, Vec<f64>>,
    /// The set of the last step.
    active: BTreeSet<usize>,
}

/// What was found.
#[derive(Clone, Debug)]
pub struct ContactState {
    /// Displacement of all unknowns.
    pub u: Vec<f64>,
    /// Pressure and weighted gap of every row.
    pub pressure: Vec<f64>,
    pub gap: Vec<f64>,
    pub active: Vec<bool>,
    /// Solves of the dense system.
    pub iterations: usize,
}

const MOST_ITERATIONS: usize = 60;

impl ActiveSet {
    /// Finds pressures `λ ≥ 0` with gaps `g + B u ≥ 0`, `λ (g + B u) = 0`, `K u = f + Bᵀλ`.
    ///
    /// `report` is called after every iteration with its number and how many nodes changed; it returns whether to go
    /// on.
    pub fn solve(
        &mut self,
        system: &dyn Compliance,
        rows: &[WeightedGap],
        springs: &[Spring],
        load: &[f64],
        report: &mut dyn FnMut(usize, usize) -> bool,
    ) -> Result<ContactState, ActiveSetError> {
        self.refresh(rows, springs);
        let free = system.solve(load)?;
        let free_at: Vec<f64> = self.touched.iter().map(|&i| free[i as usize]).collect();
        if self.active.is_empty() {
            self.active = start(rows, &free, springs);
        }
        let size = rows.iter().map(|r| (r.gap / r.weight).abs()).fold(0.0, f64::max);
        let mut seen: HashMap<Vec<usize>, usize> = HashMap::new();
        let mut last_flips = Vec::new();
        for iteration in 1..=MOST_ITERATIONS {
            let active: Vec<usize> = self.active.iter().copied().collect();
            let (pressures, forces) = self.dense(system, rows, springs, &active, &free_at)?;
            let mut at = free_at.clone();
            for (&k, p) in active.iter().zip(&pressures) {
                add(&mut at, &self.columns[&k], *p);
            }
            for (s, force) in forces.iter().enumerate() {
                add(&mut at, &self.columns[&(rows.len() + s)], *force);
            }
            let gaps: Vec<f64> = rows.iter().map(|r| r.gap + self.product(&r.terms, &at)).collect();
            let largest = pressures.iter().fold(0.0f64, |m, p| m.max(p.abs()));
            let moved = at.iter().fold(size, |m, u| m.max(u.abs()));
            let mut next = BTreeSet::new();
            for (&k, p) in active.iter().zip(&pressures) {
                if *p > -1e-12 * largest {
                    next.insert(k);
                }
            }
            for (k, row) in rows.iter().enumerate() {
                if !self.active.contains(&k) && gaps[k] / row.weight < -1e-13 * moved {
                    next.insert(k);
                }
            }
            let flips: Vec<usize> = next.symmetric_difference(&self.active).copied().collect();
            if !report(iteration, flips.len()) {
                return Err(ActiveSetError::Interrupted);
            }
            if flips.is_empty() {
                return self.finish(system, rows, springs, load, (&active, &pressures, &forces), gaps, iteration);
            }
            if seen.insert(active, iteration).is_some() {
                let nodes = flips.iter().chain(&last_flips).map(|&k| rows[k].node).collect::<BTreeSet<_>>();
                return Err(ActiveSetError::Chatter { nodes: nodes.into_iter().collect() });
            }
            last_flips = flips;
            self.active = next;
        }
        Err(ActiveSetError::TooMany { iterations: MOST_ITERATIONS })
    }

    /// Forgets what changed since the last step.
    fn refresh(&mut self, rows: &[WeightedGap], springs: &[Spring]) {
        let same = self.rows.len() == rows.len()
            && self.springs == springs
            && self.rows.iter().zip(rows).all(|(a, b)| *a == b.terms);
        if same {
            return;
        }
        self.columns.clear();
        if self.rows.len() != rows.len() {
            self.active.clear();
        }
        self.rows = rows.iter().map(|r| r.terms.clone()).collect();
        self.springs = springs.to_vec();
        let touched: BTreeSet<u32> =
            rows.iter().flat_map(|r| r.terms.iter().map(|t| t.0)).chain(springs.iter().map(|s| s.unknown)).collect();
        self.touched = touched.into_iter().collect();
        self.place = self.touched.iter().enumerate().map(|(k, &i)| (i, k)).collect();
    }

    fn product(&self, terms: &[(u32, f64)], at: &[f64]) -> f64 {
        terms.iter().map(|(i, c)| c * at[self.place[i]]).sum()
    }

    fn column(&mut self, system: &dyn Compliance, number: usize, terms: &[(u32, f64)]) -> Result<(), SolveError> {
        if self.columns.contains_key(&number) {
            return Ok(());
        }
        let mut b = vec![0.0; system.size()];
        for (i, c) in terms {
            b[*i as usize] += c;
        }
        let x = system.solve(&b)?;
        self.columns.insert(number, self.touched.iter().map(|&i| x[i as usize]).collect());
        Ok(())
    }

    /// Pressures of the active rows and forces that undo the springs.
    fn dense(
        &mut self,
        system: &dyn Compliance,
        rows: &[WeightedGap],
        springs: &[Spring],
        active: &[usize],
        free_at: &[f64],
    ) -> Result<(Vec<f64>, Vec<f64>), ActiveSetError> {
        for &k in active {
            self.column(system, k, &rows[k].terms)?;
        }
        for (s, spring) in springs.iter().enumerate() {
            self.column(system, rows.len() + s, &[(spring.unknown, 1.0)])?;
        }
        let (n, m) = (active.len(), springs.len());
        // Rows are scaled to lengths, pressures to the stiffness, so that pivots say something.
        let terms: Vec<Vec<(u32, f64)>> = (active.iter())
            .map(|&k| rows[k].terms.iter().map(|(i, c)| (*i, c / rows[k].weight)).collect())
            .chain(springs.iter().map(|s| vec![(s.unknown, 1.0)]))
            .collect();
        let numbers: Vec<usize> = active.iter().copied().chain((0..m).map(|s| rows.len() + s)).collect();
        let mut matrix = DMatrix::<f64>::zeros(n + m, n + m);
        let mut rhs = DVector::<f64>::zeros(n + m);
        for r in 0..n + m {
            for c in 0..n + m {
                let scale = if c < n { 1.0 / rows[active[c]].weight } else { 1.0 };
                matrix[(r, c)] = scale * self.product(&terms[r], &self.columns[&numbers[c]]);
            }
            let gap = if r < n { rows[active[r]].gap / rows[active[r]].weight } else { 0.0 };
            rhs[r] = -gap - self.product(&terms[r], free_at);
        }
        for (s, spring) in springs.iter().enumerate() {
            matrix[(n + s, n + s)] -= 1.0 / spring.stiffness;
        }
        let x = if m == 0
            && let Some(factor) = matrix.clone().cholesky()
        {
            factor.solve(&rhs)
        } else {
            let scale = matrix.amax();
            let lu = matrix.full_piv_lu();
            if lu.u().diagonal().iter().any(|p| p.abs() <= 1e-11 * scale) {
                return Err(ActiveSetError::Free);
            }
            lu.solve(&rhs).ok_or(ActiveSetError::Free)?
        };
        let pressures = (0..n).map(|k| x[k] / rows[active[k]].weight).collect();
        Ok((pressures, (0..m).map(|s| x[n + s]).collect()))
    }

    #[allow(clippy::too_many_arguments)]
    fn finish(
        &self,
        system: &dyn Compliance,
        rows: &[WeightedGap],
        springs: &[Spring],
        load: &[f64],
        (active, pressures, forces): (&[usize], &[f64], &[f64]),
        mut gap: Vec<f64>,
        iterations: usize,
    ) -> Result<ContactState, ActiveSetError> {
        let mut b = load.to_vec();
        let mut pressure = vec![0.0; rows.len()];
        let mut is_active = vec![false; rows.len()];
        for (&k, p) in active.iter().zip(pressures) {
            pressure[k] = *p;
            is_active[k] = true;
            gap[k] = 0.0;
            for (i, c) in &rows[k].terms {
                b[*i as usize] += c * p;
            }
        }
        for (spring, force) in springs.iter().zip(forces) {
            b[spring.unknown as usize] += force;
        }
        let u = system.solve(&b)?;
        Ok(ContactState { u, pressure, gap, active: is_active, iterations })
    }
}

fn add(at: &mut [f64], column: &[f64], factor: f64) {
    for (a, c) in at.iter_mut().zip(column) {
        *a += factor * c;
    }
}

/// The rows that the free displacement closes; where springs hold a body, also those that are nearly closest.
fn start(rows: &[WeightedGap], free: &[f64], springs: &[Spring]) -> BTreeSet<usize> {
    let gap = |r: &WeightedGap| (r.gap + r.terms.iter().map(|(i, c)| c * free[*i as usize]).sum::<f64>()) / r.weight;
    if springs.is_empty() {
        return (0..rows.len()).filter(|&k| gap(&rows[k]) < 0.0).collect();
    }
    let gaps: Vec<f64> = rows.iter().map(|r| r.gap / r.weight).collect();
    let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    let most = gaps.iter().copied().fold(least, f64::max);
    (0..rows.len()).filter(|&k| gaps[k] <= least + 0.05 * (most - least)).collect()
}
