//! Which pressure nodes carry: the primal-dual active set method, a semismooth Newton method (Hintermüller, Ito &
//! Kunisch 2002).
//!
//! The bodies are linear, so everything happens on the pressures: with the compliance `V = K⁻¹Bᵀ` of the nodes that were
//! ever active, each step solves a dense system for the pressures of the active set. A node is active next if
//! `λ - c g/w > 0`; after the first step one of the two is zero, so the constant `c` decides nothing and units do not
//! matter. Bodies that only contact holds are held by springs meanwhile, whose forces the same dense system takes away.

use crate::mortar::WeightedGap;
use nalgebra::{Cholesky, DMatrix, DVector, Dyn, FullPivLU};
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
    #[error("the contact state alternates between open and closed at {} points", rows.len())]
    Chatter { rows: Vec<usize> },
    #[error("no contact state was found in {iterations} iterations")]
    TooMany { iterations: usize },
    #[error("interrupted")]
    Interrupted,
}

/// The elastic system as the active set sees it: solves with the stiffness, springs included.
pub trait Compliance {
    /// `K_c⁻¹ b` for several right-hand sides, one after the other, to working precision.
    fn solve_columns(&self, b: &mut [f64]) -> Result<(), SolveError>;
    /// `K_c⁻¹ b`, refined to the round-off of the solution.
    fn solve_accurately(&self, b: &[f64]) -> Result<Vec<f64>, SolveError>;
    fn size(&self) -> usize;
}

/// A spring that holds a body until contact does: it acts on one unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    pub unknown: u32,
    pub stiffness: f64,
}

/// How a row gives way: `g + c (λ - shift) = 0` where it carries. Nothing for a hard contact; `c = w/ε` for a penalty
/// `ε`, and with the pressure found before as the shift one step of the augmented Lagrangian.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Softness {
    pub compliance: f64,
    pub shift: f64,
}

/// Columns of the compliance, kept from step to step as long as the rows stay the same.
#[derive(Default)]
pub struct ActiveSet {
    /// Terms and forces of every row, to see whether they changed.
    rows: Vec<[Vec<(u32, f64)>; 2]>,
    /// Number of rows of the last step, here or in the run that this one goes on from; zero before the first.
    count: usize,
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
/// Columns solved for at once.
const COLUMNS: usize = 32;

impl ActiveSet {
    /// Begins with these rows; with none, with those that the displacement without contact closes.
    pub fn starting_with(rows: impl IntoIterator<Item = usize>) -> Self {
        ActiveSet { active: rows.into_iter().collect(), ..Self::default() }
    }

    /// The active rows of the last step, and how many rows there were.
    pub fn save(&self) -> (Vec<usize>, usize) {
        (self.active.iter().copied().collect(), self.count)
    }

    /// Goes on from what was saved.
    pub fn restored((active, count): (Vec<usize>, usize)) -> Self {
        ActiveSet { count, ..Self::starting_with(active) }
    }

    /// Finds pressures `λ ≥ 0` with gaps `g + B u ≥ 0`, `λ (g + B u) = 0`, `K u = f + Bᵀλ`; soft rows as
    /// [`Softness`] says.
    ///
    /// `report` is called after every iteration with its number and how many nodes changed; it returns whether to go
    /// on.
    pub fn solve(
        &mut self,
        system: &dyn Compliance,
        rows: &[WeightedGap],
        soft: &[Softness],
        springs: &[Spring],
        load: &[f64],
        report: &mut dyn FnMut(usize, usize) -> bool,
    ) -> Result<ContactState, ActiveSetError> {
        debug_assert_eq!(rows.len(), soft.len());
        self.refresh(rows, springs);
        let free = system.solve_accurately(load)?;
        let free_at: Vec<f64> = self.touched.iter().map(|&i| free[i as usize]).collect();
        if self.active.is_empty() {
            self.active = start(rows, &free, springs);
        }
        let size = rows.iter().map(|r| (r.gap / r.weight).abs()).fold(0.0, f64::max);
        let mut seen: HashMap<Vec<usize>, usize> = HashMap::new();
        let mut last_flips = Vec::new();
        for iteration in 1..=MOST_ITERATIONS {
            let active: Vec<usize> = self.active.iter().copied().collect();
            let dense = self.dense(system, rows, soft, springs, &active)?;
            let gaps_now = self.defects((rows, soft), springs, &active, &free_at, (&[], &[]));
            let (pressures, forces) = dense.solve(&gaps_now)?;
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
                let open = (gaps[k] - soft[k].compliance * soft[k].shift) / row.weight;
                if !self.active.contains(&k) && open < -1e-13 * moved {
                    next.insert(k);
                }
            }
            let flips: Vec<usize> = next.symmetric_difference(&self.active).copied().collect();
            if !report(iteration, flips.len()) {
                return Err(ActiveSetError::Interrupted);
            }
            if flips.is_empty() {
                let mut found = ContactState {
                    u: Vec::new(),
                    pressure: vec![0.0; rows.len()],
                    gap: gaps,
                    active: (0..rows.len()).map(|k| self.active.contains(&k)).collect(),
                    iterations: iteration,
                };
                self.refine(system, (rows, soft, springs), load, &dense, (&active, pressures, forces), &mut found)?;
                return Ok(found);
            }
            if seen.insert(active, iteration).is_some() {
                let rows: BTreeSet<usize> = flips.into_iter().chain(last_flips).collect();
                return Err(ActiveSetError::Chatter { rows: rows.into_iter().collect() });
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
            && self.rows.iter().zip(rows).all(|(a, b)| a[0] == b.terms && a[1] == b.forces);
        if same {
            return;
        }
        self.columns.clear();
        if self.count != rows.len() && self.count != 0 {
            self.active.clear();
        }
        self.count = rows.len();
        self.rows = rows.iter().map(|r| [r.terms.clone(), r.forces.clone()]).collect();
        self.springs = springs.to_vec();
        let touched: BTreeSet<u32> =
            rows.iter().flat_map(|r| r.terms.iter().map(|t| t.0)).chain(springs.iter().map(|s| s.unknown)).collect();
        self.touched = touched.into_iter().collect();
        self.place = self.touched.iter().enumerate().map(|(k, &i)| (i, k)).collect();
    }

    fn product(&self, terms: &[(u32, f64)], at: &[f64]) -> f64 {
        terms.iter().map(|(i, c)| c * at[self.place[i]]).sum()
    }

    /// Adds the columns that are still missing, several at a time.
    fn add_columns(&mut self, system: &dyn Compliance, missing: &[(usize, &[(u32, f64)])]) -> Result<(), SolveError> {
        let n = system.size();
        for chunk in missing.chunks(COLUMNS) {
            let mut b = vec![0.0; n * chunk.len()];
            for (column, (_, terms)) in b.chunks_mut(n).zip(chunk) {
                for (i, c) in *terms {
                    column[*i as usize] += c;
                }
            }
            system.solve_columns(&mut b)?;
            for (column, (number, _)) in b.chunks(n).zip(chunk) {
                self.columns.insert(*number, self.touched.iter().map(|&i| column[i as usize]).collect());
            }
        }
        Ok(())
    }

    /// The dense system of the active rows and the springs.
    fn dense(
        &mut self,
        system: &dyn Compliance,
        rows: &[WeightedGap],
        soft: &[Softness],
        springs: &[Spring],
        active: &[usize],
    ) -> Result<Dense, ActiveSetError> {
        let held: Vec<[(u32, f64); 1]> = springs.iter().map(|s| [(s.unknown, 1.0)]).collect();
        let all = (active.iter().map(|&k| (k, rows[k].push())))
            .chain(held.iter().enumerate().map(|(s, terms)| (rows.len() + s, &terms[..])));
        let missing: Vec<(usize, &[(u32, f64)])> = all.filter(|(k, _)| !self.columns.contains_key(k)).collect();
        self.add_columns(system, &missing)?;
        let (n, m) = (active.len(), springs.len());
        let numbers: Vec<usize> = active.iter().copied().chain((0..m).map(|s| rows.len() + s)).collect();
        let symmetric = active.iter().all(|&k| rows[k].forces.is_empty());
        let mut matrix = DMatrix::<f64>::zeros(n + m, n + m);
        for r in 0..n + m {
            let spring;
            let terms: &[(u32, f64)] = if r < n {
                &rows[active[r]].terms
            } else {
                spring = [(springs[r - n].unknown, 1.0)];
                &spring
            };
            for c in 0..if symmetric { r + 1 } else { n + m } {
                let value = self.product(terms, &self.columns[&numbers[c]]);
                matrix[(r, c)] = value;
                if symmetric {
                    matrix[(c, r)] = value;
                }
            }
        }
        // Compliances of bodies and springs may differ by orders of magnitude: with a diagonal of ones pivots say
        // something.
        let own = |k: usize| matrix[(k, k)].abs() + active.get(k).map_or(0.0, |r| soft[*r].compliance);
        let scale: Vec<f64> = (0..n + m).map(|k| 1.0 / own(k).sqrt()).collect();
        for (s, spring) in springs.iter().enumerate() {
            matrix[(n + s, n + s)] -= 1.0 / spring.stiffness;
        }
        for (r, &k) in active.iter().enumerate() {
            matrix[(r, r)] += soft[k].compliance;
        }
        for r in 0..n + m {
            for c in 0..n + m {
                matrix[(r, c)] *= scale[r] * scale[c];
            }
        }
        let factor = if m == 0 && symmetric { matrix.clone().cholesky().map(Factored::Definite) } else { None };
        let factor = match factor {
            Some(factor) => factor,
            None => {
                let largest = matrix.amax();
                let lu = matrix.full_piv_lu();
                if lu.u().diagonal().iter().any(|p| p.abs() <= 1e-11 * largest) {
                    return Err(ActiveSetError::Free);
                }
                Factored::Indefinite(Box::new(lu))
            }
        };
        Ok(Dense { factor, scale, active: n })
    }

    /// Weighted gaps of the active rows, and what the springs lack, at displacements of the touched unknowns.
    fn defects(
        &self,
        (rows, soft): (&[WeightedGap], &[Softness]),
        springs: &[Spring],
        active: &[usize],
        at: &[f64],
        (pressures, forces): (&[f64], &[f64]),
    ) -> Vec<f64> {
        let gap = |(place, &k): (usize, &usize)| {
            let carried = pressures.get(place).copied().unwrap_or(0.0) - soft[k].shift;
            rows[k].gap + self.product(&rows[k].terms, at) + soft[k].compliance * carried
        };
        let lack = |s: usize, spring: &Spring| {
            self.product(&[(spring.unknown, 1.0)], at) - forces.get(s).copied().unwrap_or(0.0) / spring.stiffness
        };
        active
            .iter()
            .enumerate()
            .map(gap)
            .chain(springs.iter().enumerate().map(|(s, spring)| lack(s, spring)))
            .collect()
    }

    /// The displacement of all unknowns; what the closed gaps still lack by the round-off of the columns is made good.
    fn refine(
        &self,
        system: &dyn Compliance,
        (rows, soft, springs): (&[WeightedGap], &[Softness], &[Spring]),
        load: &[f64],
        dense: &Dense,
        (active, mut pressures, mut forces): (&[usize], Vec<f64>, Vec<f64>),
        found: &mut ContactState,
    ) -> Result<(), ActiveSetError> {
        for round in 0..2 {
            let mut b = load.to_vec();
            for (&k, p) in active.iter().zip(&pressures) {
                for (i, c) in rows[k].push() {
                    b[*i as usize] += c * p;
                }
            }
            for (spring, force) in springs.iter().zip(&forces) {
                b[spring.unknown as usize] += force;
            }
            found.u = system.solve_accurately(&b)?;
            if round == 1 || active.is_empty() {
                break;
            }
            let at: Vec<f64> = self.touched.iter().map(|&i| found.u[i as usize]).collect();
            let (more, others) =
                dense.solve(&self.defects((rows, soft), springs, active, &at, (&pressures, &forces)))?;
            pressures.iter_mut().zip(more).for_each(|(p, m)| *p += m);
            forces.iter_mut().zip(others).for_each(|(f, m)| *f += m);
        }
        for (&k, p) in active.iter().zip(&pressures) {
            found.pressure[k] = *p;
            found.gap[k] = soft[k].compliance * (soft[k].shift - p);
        }
        Ok(())
    }
}

enum Factored {
    Definite(Cholesky<f64, Dyn>),
    Indefinite(Box<FullPivLU<f64, Dyn, Dyn>>),
}

/// The factorised dense system, with the factors of its rows and columns.
struct Dense {
    factor: Factored,
    scale: Vec<f64>,
    active: usize,
}

impl Dense {
    /// Pressures of the active rows and forces at the springs that bring the defects to zero.
    fn solve(&self, defects: &[f64]) -> Result<(Vec<f64>, Vec<f64>), ActiveSetError> {
        let rhs = DVector::from_iterator(defects.len(), defects.iter().zip(&self.scale).map(|(d, s)| -d * s));
        let x = match &self.factor {
            Factored::Definite(factor) => factor.solve(&rhs),
            Factored::Indefinite(factor) => factor.solve(&rhs).ok_or(ActiveSetError::Free)?,
        };
        let mut x = x.iter().zip(&self.scale).map(|(x, s)| x * s);
        let pressures = x.by_ref().take(self.active).collect();
        Ok((pressures, x.collect()))
    }
}

fn add(at: &mut [f64], column: &[f64], factor: f64) {
    for (a, c) in at.iter_mut().zip(column) {
        *a += factor * c;
    }
}

/// The rows that the free displacement closes; where springs hold a body, also those that are nearly closest.
fn start(rows: &[WeightedGap], free: &[f64], springs: &[Spring]) -> BTreeSet<usize> {
    if springs.is_empty() {
        return (0..rows.len()).filter(|&k| rows[k].at(free) < 0.0).collect();
    }
    let gaps: Vec<f64> = rows.iter().map(|r| r.gap / r.weight).collect();
    let least = gaps.iter().copied().fold(f64::INFINITY, f64::min);
    let most = gaps.iter().copied().fold(least, f64::max);
    (0..rows.len()).filter(|&k| gaps[k] <= least + 0.05 * (most - least)).collect()
}
