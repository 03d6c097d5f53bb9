//! Which pressure nodes carry: the primal-dual active set method, a semismooth Newton method (Hintermüller, Ito &
//! Kunisch 2002).
//!
//! The bodies are linear, so everything happens on the pressures: with the compliance `V = K⁻¹Bᵀ` of the nodes that were
//! ever active, each iteration solves a dense system for the pressures of the active set. A node is active next if
//! `λ - c g/w > 0`; after the first iteration one of the two is zero, so the constant `c` decides nothing and units do
//! not matter. Where the number of nodes that change does not fall any more, one node changes at a time, always the last:
//! this ends for every positive definite compliance (Murty 1974; the combination is that of Júdice & Pires 1994).
//!
//! Bodies that only contact holds are held by springs in `K`, whose forces the dense system takes away again. As long as
//! no contact holds them, all but a share of the spring is taken away, and the share goes to zero: the states tend to
//! the one without springs (Tikhonov), and the active set is that one's after a few.

mod dense;
mod equations;
mod error;

pub use error::ActiveSetError;

use crate::compliance::{Compliance, Route, Solved};
use crate::mortar::WeightedGap;
use crate::softness::{SPRINGS_LEFT, Softness, Spring};
use dense::Dense;
use equations::{Problem, by_products, defects, image, scales, solved, taken};
use nalgebra::DMatrix;
use signorini_solve::SolveError;
use std::cell::OnceCell;
use std::collections::{BTreeSet, HashMap};

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
    /// How the compliance is to be known; what costs less where nothing is said.
    pub route: Option<Route>,
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
    /// Solves of the system of the rows.
    pub iterations: usize,
    pub route: Route,
}

const MOST_ITERATIONS: usize = 200;
/// Iterations without fewer changes than ever before after which one node changes at a time.
const PATIENCE: usize = 10;
/// Columns solved for at once.
const COLUMNS: usize = 32;

/// Pressure relative to the largest, and gap relative to the displacement, below which a row keeps its state: a few digits
/// above what the equations are solved to.
const KEPT: [f64; 2] = [1e-12, 1e-13];
const KEPT_BY_PRODUCTS: [f64; 2] = [1e-10, 1e-11];

/// The equations of a set of active rows.
enum Equations {
    Dense(Box<Dense>),
    ByProducts,
}

/// Pressures and spring forces for which no row changes any more.
struct Balanced {
    equations: Equations,
    active: Vec<usize>,
    pressures: Vec<f64>,
    forces: Vec<f64>,
    gaps: Vec<f64>,
    /// The largest displacement of what the rows touch.
    moved: f64,
}

/// Counts iterations and tells of them; what comes back says whether to go on.
struct Iterations<'a> {
    count: usize,
    report: &'a mut dyn FnMut(usize, usize) -> bool,
}

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
    /// on. After an error the active set is the one before.
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
        let free = self.values(rows, springs, &free_at);
        let problem = Problem { system, rows, soft, springs, load, free_at, free, products: OnceCell::new() };
        let mut iterations = Iterations { count: 0, report };
        let before = self.active.clone();
        let balanced = self.balance(&problem, &mut iterations);
        let Balanced { equations, active, pressures, forces, gaps, .. } =
            balanced.inspect_err(|_| self.active = before)?;
        let mut found = ContactState {
            u: Vec::new(),
            pressure: vec![0.0; rows.len()],
            gap: gaps,
            active: (0..rows.len()).map(|k| self.active.contains(&k)).collect(),
            iterations: iterations.count,
            route: if let Equations::Dense(_) = equations { Route::Columns } else { Route::Products },
        };
        self.refine(&problem, &equations, (&active, pressures, forces), &mut found)?;
        Ok(found)
    }

    /// The state without springs: from the active set of before, or where that does not hold the bodies, from states with
    /// less and less of the springs.
    fn balance(&mut self, problem: &Problem<'_>, iterations: &mut Iterations<'_>) -> Result<Balanced, ActiveSetError> {
        let hopeful = |error: &ActiveSetError| !matches!(error, ActiveSetError::Solve(_) | ActiveSetError::Interrupted);
        if self.active.is_empty() {
            self.active = (0..problem.rows.len()).filter(|&k| problem.free[k] < 0.0).collect();
        }
        let mut found = self.pivot(problem, 0.0, iterations);
        if problem.springs.is_empty() {
            return found;
        }
        for left in SPRINGS_LEFT {
            match &found {
                Err(error) if hopeful(error) => {}
                _ => break,
            }
            found = match self.pivot(problem, left, iterations) {
                Err(error) if !hopeful(&error) => Err(error),
                _ => self.pivot(problem, 0.0, iterations),
            };
        }
        found
    }

    /// Changes the active set until no row wants to, with a share of the springs left.
    fn pivot(
        &mut self,
        problem: &Problem<'_>,
        left: f64,
        iterations: &mut Iterations<'_>,
    ) -> Result<Balanced, ActiveSetError> {
        let Problem { rows, soft, .. } = *problem;
        let size = rows.iter().map(|r| (r.gap / r.weight).abs()).fold(0.0, f64::max);
        let (mut fewest, mut patience) = (usize::MAX, PATIENCE);
        let mut last_flips = Vec::new();
        for _ in 0..MOST_ITERATIONS {
            let active: Vec<usize> = self.active.iter().copied().collect();
            let found = self.carried(problem, left, active)?;
            let kept = if let Equations::Dense(_) = found.equations { KEPT } else { KEPT_BY_PRODUCTS };
            let largest = found.pressures.iter().fold(0.0f64, |m, p| m.max(p.abs()));
            let moved = found.moved.max(size);
            let mut next = BTreeSet::new();
            for (&k, p) in found.active.iter().zip(&found.pressures) {
                if *p > -kept[0] * largest {
                    next.insert(k);
                }
            }
            for (k, row) in rows.iter().enumerate() {
                let open = (found.gaps[k] - soft[k].compliance * soft[k].shift) / row.weight;
                if !self.active.contains(&k) && open < -kept[1] * moved {
                    next.insert(k);
                }
            }
            let flips: Vec<usize> = next.symmetric_difference(&self.active).copied().collect();
            iterations.count += 1;
            if !(iterations.report)(iterations.count, flips.len()) {
                return Err(ActiveSetError::Interrupted);
            }
            let Some(last) = flips.last() else { return Ok(found) };
            if flips.len() < fewest {
                (fewest, patience) = (flips.len(), PATIENCE);
            } else {
                patience = patience.saturating_sub(1);
            }
            if patience > 0 {
                self.active = next;
            } else if !self.active.remove(last) {
                self.active.insert(*last);
            }
            last_flips = flips;
        }
        Err(ActiveSetError::Chatter { rows: last_flips })
    }

    /// Pressures of the active rows and forces at the springs, with the gaps under them.
    fn carried(&mut self, problem: &Problem<'_>, left: f64, active: Vec<usize>) -> Result<Balanced, ActiveSetError> {
        let rows = problem.rows;
        let defects = defects(problem, left, &active, &problem.free, (&[], &[]));
        let cheaper = || Route::cheaper(active.len(), self.touched.len(), problem.system.entries());
        let route = self.route.unwrap_or_else(cheaper);
        if route == Route::Products {
            let scale = scales(problem, &active)?;
            if left == 0.0
                && let Some(motion) = by_products(problem)?.unheld(&scale, &image(problem, left, &active, &scale))
            {
                return Err(ActiveSetError::Free { motion });
            }
            let Solved { x, product } = solved(problem, left, &active, &defects)?;
            let gaps: Vec<f64> = problem.free[..rows.len()].iter().zip(&product).map(|(f, w)| f + w).collect();
            let sizes = rows.iter().zip(&gaps).zip(&product).map(|((r, g), w)| g.abs().max(w.abs()) / r.weight);
            let moved = sizes.fold(0.0, f64::max);
            let pressures = active.iter().map(|&k| x[k]).collect();
            let forces = x[rows.len()..rows.len() + taken(problem, left).len()].to_vec();
            return Ok(Balanced { equations: Equations::ByProducts, active, pressures, forces, gaps, moved });
        }
        let dense = self.dense(problem, left, &active)?;
        let (pressures, forces) = dense.solve(&defects)?;
        let mut at = problem.free_at.clone();
        for (&k, p) in active.iter().zip(&pressures) {
            add(&mut at, &self.columns[&k], *p);
        }
        for (s, force) in forces.iter().enumerate() {
            add(&mut at, &self.columns[&(rows.len() + s)], *force);
        }
        let gaps = self.values(rows, &[], &at);
        let moved = at.iter().fold(0.0f64, |m, u| m.max(u.abs()));
        Ok(Balanced { equations: Equations::Dense(Box::new(dense)), active, pressures, forces, gaps, moved })
    }

    /// Weighted gaps of all rows, and what the springs move, at displacements of the touched unknowns.
    fn values(&self, rows: &[WeightedGap], springs: &[Spring], at: &[f64]) -> Vec<f64> {
        let of_springs = springs.iter().map(|s| at[self.place[&s.unknown]]);
        rows.iter().map(|r| r.gap + self.product(&r.terms, at)).chain(of_springs).collect()
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

    /// The dense system of the active rows, and of the springs where less than all of them is left.
    fn dense(&mut self, problem: &Problem<'_>, left: f64, active: &[usize]) -> Result<Dense, ActiveSetError> {
        let Problem { system, rows, soft, .. } = *problem;
        let springs = taken(problem, left);
        let missing: Vec<(usize, &[(u32, f64)])> =
            active.iter().filter(|k| !self.columns.contains_key(k)).map(|&k| (k, rows[k].push())).collect();
        self.add_columns(system, &missing)?;
        for (s, spring) in springs.iter().enumerate() {
            // What a spring moves is nearly rigid: only to the last digit does it tell what holds the body.
            if !self.columns.contains_key(&(rows.len() + s)) {
                let mut unit = vec![0.0; system.size()];
                unit[spring.unknown as usize] = 1.0;
                let column = system.solve_accurately(&unit)?;
                self.columns.insert(rows.len() + s, self.touched.iter().map(|&i| column[i as usize]).collect());
            }
        }
        let (n, m) = (active.len(), springs.len());
        let column = |c: usize| if c < n { active[c] } else { rows.len() + c - n };
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
                let value = self.product(terms, &self.columns[&column(c)]);
                matrix[(r, c)] = value;
                if symmetric {
                    matrix[(c, r)] = value;
                }
            }
        }
        for (r, &k) in active.iter().enumerate() {
            matrix[(r, r)] += soft[k].compliance;
        }
        for (s, spring) in springs.iter().enumerate() {
            matrix[(n + s, n + s)] -= 1.0 / (spring.stiffness * (1.0 - left));
        }
        let stiffness: Vec<f64> = springs.iter().map(|s| s.stiffness).collect();
        Dense::new(matrix, n, &stiffness, symmetric, left == 0.0)
    }

    /// The displacement of all unknowns; what the closed gaps still lack by the round-off of the columns is made good.
    fn refine(
        &self,
        problem: &Problem<'_>,
        equations: &Equations,
        (active, mut pressures, mut forces): (&[usize], Vec<f64>, Vec<f64>),
        found: &mut ContactState,
    ) -> Result<(), ActiveSetError> {
        let Problem { system, rows, soft, springs, load, .. } = *problem;
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
            let defects = defects(problem, 0.0, active, &self.values(rows, springs, &at), (&pressures, &forces));
            let (more, others) = match equations {
                Equations::Dense(dense) => dense.solve(&defects)?,
                Equations::ByProducts => {
                    let x = solved(problem, 0.0, active, &defects)?.x;
                    (active.iter().map(|&k| x[k]).collect(), x[rows.len()..].to_vec())
                }
            };
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

fn add(at: &mut [f64], column: &[f64], factor: f64) {
    for (a, c) in at.iter_mut().zip(column) {
        *a += factor * c;
    }
}

#[cfg(test)]
mod tests;
