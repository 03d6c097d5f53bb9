//! Newton's step with bodies of constant stiffness factorised once.
//!
//! Of such bodies contact changes a few unknowns only. With `L` their unknowns, `Y` all others - of other bodies, multipliers
//! of contacts and supports - and `C` what contacts, loads and supports add to the stiffness `K`, the equations
//!
//! ```text
//! (K + C_LL) u + C_LY y = r_L
//!      C_YL  u + C_YY y = r_Y
//! ```
//!
//! are reduced by [`Condensation`] to the unknowns of `L` that `C` changes and to `Y`: a dense system. `K` is factorised anew
//! where `C` comes to change unknowns that were eliminated, or supports hold others.

use crate::body::Contribution;
use crate::eliminated::eliminated_step;
use crate::linear_bodies::Reduced;
use crate::linear_solver::{LinearSolver, Stiffness};
use crate::points::{Order, Sampling};
use crate::system::{Assembled, AssemblyError, System, SystemState, TimedLoad};
use signorini_geometry::Point;
use signorini_solve::cholesky::Symbolic;
use signorini_solve::dense::Equilibrated;
use signorini_solve::{Condensation, SolveError, SymmetricMatrix};
use std::collections::BTreeSet;

/// Fewer unknowns of linear bodies are factorised with all others: that takes milliseconds.
const LEAST: usize = 1000;
/// More unknowns are factorised with multipliers eliminated: fewer take tenths of a second in any way.
const MANY: usize = 10_000;
/// Most unknowns that remain of few and of many: a dense factor of more takes longer than a sparse one of all, with multipliers or
/// with multipliers eliminated.
const MOST: [usize; 2] = [5000, 2000];
/// So many unknowns of surfaces that may touch remain in any case: their dense factor costs less than another one of the body.
const ALL: usize = 2000;
/// Otherwise of those that are needed so many times as many, and these more, before the body is factorised again.
const MORE: [f64; 2] = [1.5, 300.0];
/// Residual relative to the terms of the equations that is solved for once more, and that is refused after it.
const INACCURATE: f64 = 1e-11;
const REFUSED: f64 = 1e-9;
/// A pivot relative to the largest that rounding leaves of zero.
const SINGULAR: f64 = 1e-15;
const ELSEWHERE: u32 = u32::MAX;

impl System {
    /// Which bodies are condensed; none of a system in which others are solved for in another way or too few are linear.
    pub(crate) fn is_condensed(&self) -> &[bool] {
        self.linear.is_condensed.get_or_init(|| {
            let of: Vec<bool> = self.bodies.iter().map(|b| b.is_linear() && !b.places().is_empty()).collect();
            let count: usize = self.bodies.iter().zip(&of).filter(|(_, is)| **is).map(|(b, _)| b.unknowns()).sum();
            let others: usize = self.bodies.iter().zip(&of).filter(|(_, is)| !**is).map(|(b, _)| b.unknowns()).sum();
            if count < LEAST || others > MOST[0] { vec![false; of.len()] } else { of }
        })
    }

    /// The order of elimination of a Cholesky factor of all bodies; none of systems with few unknowns, or in which not all know
    /// where they are.
    pub(crate) fn dissected(&self) -> Option<Symbolic> {
        let (_, count) = self.numbering();
        if count < MANY || self.division.is_some() || self.solver != LinearSolver::Automatic {
            return None;
        }
        let places: Vec<[f64; 3]> = self.bodies.iter().flat_map(|body| body.places()).collect();
        (places.len() == count).then(|| Symbolic::dissected(places))
    }

    /// Where the stiffness of bodies goes in a state.
    pub(crate) fn stiffness(&self, state: &SystemState) -> Result<Stiffness, AssemblyError> {
        Ok(if self.step.is_some() || self.division.is_some() {
            Stiffness::InTangent
        } else if self.is_iterative(state)? {
            Stiffness::KeptByBodies
        } else if self.solver == LinearSolver::Automatic && self.is_condensed().contains(&true) {
            Stiffness::Condensed
        } else {
            Stiffness::InTangent
        })
    }

    /// Calls `of` with the linear bodies, `held` as they are.
    fn with_reduced<T>(
        &self,
        held: Option<&[bool]>,
        of: impl FnOnce(&mut Reduced) -> Result<T, SolveError>,
    ) -> Result<T, SolveError> {
        let mut guard = self.linear.reduced.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        let reduced = match &mut *guard {
            Some(found) => found,
            none => none.insert(Reduced::new(self).map_err(|_| SolveError::NotFactorised { size: 0 })?),
        };
        if let Some(held) = held {
            let is_held = reduced.unknowns.iter().map(|u| held[*u as usize]);
            if !is_held.clone().eq(reduced.is_held.iter().copied()) {
                reduced.is_held = is_held.collect();
                reduced.condensation = None;
            }
        }
        of(reduced)
    }

    /// Whether all bodies are linear, and condensed where that is worth it.
    pub(crate) fn is_all_condensed(&self) -> bool {
        self.is_condensed().iter().all(|is| *is)
    }

    /// The step of all unknowns with multipliers eliminated, of a system whose bodies are all linear.
    ///
    /// # Errors
    /// As of [`eliminated_step`].
    pub(crate) fn eliminated_step(
        &self,
        out: &Assembled,
        held: &[bool],
        right: &[f64],
        symbolic: &mut Symbolic,
    ) -> Result<Vec<f64>, SolveError> {
        self.with_reduced(None, |reduced| {
            let count = reduced.unknowns.len();
            eliminated_step((Some(&reduced.stiffness), &out.tangent), (count, held), right, symbolic)
        })
    }

    /// The largest entry of each row of the stiffness of linear bodies, as an unknown of the system.
    pub(crate) fn condensed_row_sizes(&self, sizes: &mut [f64]) {
        let _ = self.with_reduced(None, |reduced| {
            for (u, own) in reduced.unknowns.iter().zip(&reduced.row_sizes) {
                sizes[*u as usize] = sizes[*u as usize].max(*own);
            }
            Ok(())
        });
    }

    /// The step of all unknowns; `held` names unknowns whose step is known, and stands in `right`, the right-hand side.
    ///
    /// # Errors
    /// More unknowns that remain than a dense system may have; a singular system; no memory.
    pub(crate) fn condensed_step(&self, out: &Assembled, held: &[bool], right: &[f64]) -> Result<Vec<f64>, SolveError> {
        self.with_reduced(Some(held), |reduced| {
            let beside: Vec<(u32, u32, f64)> = out.tangent.list().filter(|e| !held[e.0 as usize]).collect();
            reduced.keep(&beside, held)?;
            let step = Step::new(reduced, &beside, held, right.len())?;
            let mut x = step.solve(right)?;
            let (mut error, mut left) = step.residual(&x, right);
            if error > INACCURATE {
                let more = step.solve(&left)?;
                let next: Vec<f64> = x.iter().zip(&more).map(|(x, m)| x + m).collect();
                let (next_error, next_left) = step.residual(&next, right);
                if next_error < error {
                    (x, error, left) = (next, next_error, next_left);
                }
            }
            let size = left.len();
            if error > REFUSED || error.is_nan() {
                Err(SolveError::Inaccurate { size, residual: error })
            } else {
                Ok(x)
            }
        })
    }
}

impl Reduced {
    fn new(system: &System) -> Result<Self, AssemblyError> {
        let (first, count) = system.numbering();
        let is_condensed = system.is_condensed();
        let start = system.start();
        let mut place = vec![ELSEWHERE; count];
        let (mut unknowns, mut positions): (Vec<u32>, Vec<[f64; 3]>) = (Vec::new(), Vec::new());
        let mut blocks: Vec<(Vec<u32>, Vec<f64>)> = Vec::new();
        for (k, body) in system.bodies.iter().enumerate().filter(|(k, _)| is_condensed[*k]) {
            let mut own = Contribution::new(body.unknowns());
            body.internal(&start.bodies[k], Order::Second, &mut own)?;
            for support in system.supports.iter().filter(|s| s.part.body == k) {
                let on = support.part.group.as_deref();
                support.at(0.0, |hold| body.hold_weakly(on, hold, &start.bodies[k], Order::Second, &mut own))?;
            }
            for load in system.loads.iter().filter(|l| l.part.body == k && l.load.is_constant()) {
                load.act(body.as_ref(), &start.bodies[k], 0.0, Order::Second, &mut own)?;
            }
            let begin = unknowns.len() as u32;
            let shifted = |list: Vec<u32>| list.into_iter().map(|u| u + begin).collect();
            blocks.extend(own.blocks.into_iter().map(|(list, values)| (shifted(list), values)));
            for u in 0..body.unknowns() as u32 {
                place[(first[k] + u) as usize] = unknowns.len() as u32;
                unknowns.push(first[k] + u);
            }
            positions.extend(body.places());
        }
        let stiffness = SymmetricMatrix::of_cliques(unknowns.len(), &blocks);
        let mut row_sizes = vec![0.0f64; unknowns.len()];
        for (i, j, v) in stiffness.entries() {
            row_sizes[i] = row_sizes[i].max(v.abs());
            row_sizes[j] = row_sizes[j].max(v.abs());
        }
        let sites = sites(system, &start, &place);
        let is_held = vec![false; unknowns.len()];
        Ok(Reduced { place, unknowns, stiffness, row_sizes, positions, sites, is_held, condensation: None })
    }

    /// Makes sure that unknowns that entries change remain.
    fn keep(&mut self, beside: &[(u32, u32, f64)], held: &[bool]) -> Result<(), SolveError> {
        let mut needed = vec![false; self.unknowns.len()];
        let changed = beside.iter().filter(|e| !held[e.1 as usize]).flat_map(|e| [e.0, e.1]);
        changed.filter_map(|u| self.place_of(u)).for_each(|k| needed[k] = true);
        if let Some(condensation) = &self.condensation {
            let mut remains = vec![false; needed.len()];
            condensation.kept().iter().for_each(|k| remains[*k as usize] = true);
            if needed.iter().zip(&remains).all(|(needed, remains)| !needed || *remains) {
                return Ok(());
            }
            // What was needed before may be needed again.
            condensation.kept().iter().for_each(|k| needed[*k as usize] = true);
        }
        self.condensation = None;
        let size = self.unknowns.len();
        let is_too_many = |count: usize| count > MOST[usize::from(size >= MANY)];
        if is_too_many(needed.iter().filter(|n| **n).count()) {
            return Err(SolveError::NotFactorised { size });
        }
        let mut kept = self.with_neighbours(needed);
        if is_too_many(kept.len()) {
            return Err(SolveError::NotFactorised { size });
        }
        kept.sort_unstable();
        let held: Vec<Option<f64>> = self.is_held.iter().map(|is_held| is_held.then_some(0.0)).collect();
        let mut matrix = self.stiffness.clone();
        matrix.prescribe(&held, &mut vec![0.0; size]);
        self.condensation = Some(Condensation::new(matrix, kept, self.positions.clone())?);
        Ok(())
    }

    /// The number of an unknown of the system among those of linear bodies.
    fn place_of(&self, unknown: u32) -> Option<usize> {
        self.place.get(unknown as usize).filter(|p| **p != ELSEWHERE).map(|p| *p as usize)
    }

    /// What is needed, with what of the surfaces that may touch is likely to be needed next: all if it is little, or else what
    /// lies nearest.
    fn with_neighbours(&self, mut needed: Vec<bool>) -> Vec<u32> {
        let list = |needed: &[bool]| (0..needed.len() as u32).filter(|k| needed[*k as usize]).collect::<Vec<u32>>();
        let count = |needed: &[bool]| needed.iter().filter(|n| **n).count();
        // How many more a site needs.
        let add = |needed: &mut [bool], site: &(Point<3>, Vec<u32>)| {
            let more = site.1.iter().filter(|k| !self.is_held[**k as usize]);
            more.filter(|k| !std::mem::replace(&mut needed[**k as usize], true)).count()
        };
        let mut all = needed.clone();
        self.sites.iter().for_each(|site| _ = add(&mut all, site));
        if count(&all) <= ALL {
            return list(&all);
        }
        let now: Vec<Point<3>> =
            self.sites.iter().filter(|s| s.1.iter().any(|k| needed[*k as usize])).map(|s| s.0).collect();
        if now.is_empty() {
            return list(&needed);
        }
        let away =
            |s: &(Point<3>, Vec<u32>)| now.iter().map(|x| (x - s.0).norm_squared()).fold(f64::INFINITY, f64::min);
        let mut order: Vec<(f64, usize)> = self.sites.iter().map(away).zip(0..).collect();
        order.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        let first = count(&needed);
        let (mut total, enough) = (first, MORE[0] * first as f64 + MORE[1]);
        for (_, k) in order {
            if total as f64 >= enough {
                break;
            }
            total += add(&mut needed, &self.sites[k]);
        }
        list(&needed)
    }
}

/// Where surfaces of linear bodies may touch, and the unknowns that move them.
fn sites(system: &System, start: &SystemState, place: &[u32]) -> Vec<(Point<3>, Vec<u32>)> {
    let (first, _) = system.numbering();
    let is_condensed = system.is_condensed();
    let parts: BTreeSet<(usize, Option<String>)> = (system.contacts.iter().flat_map(|contact| contact.parts()))
        .filter(|part| is_condensed[part.body])
        .map(|part| (part.body, part.group.clone()))
        .collect();
    let mut out = Vec::new();
    for (k, group) in parts {
        let body = &system.bodies[k];
        let sites = |sampling| body.sites(group.as_deref(), sampling);
        for site in sites(Sampling::GaussPoints).or_else(|_| sites(Sampling::Nodes)).unwrap_or_default() {
            let placed = body.placed(&start.bodies[k], &site);
            out.push((placed.x, placed.functions.iter().map(|f| place[(first[k] + f.unknown) as usize]).collect()));
        }
    }
    out
}

/// One linear system.
struct Step<'a> {
    reduced: &'a Reduced,
    condensation: &'a Condensation,
    beside: &'a [(u32, u32, f64)],
    held: &'a [bool],
    /// Unknowns beside those of linear bodies that are coupled with others, and those that are not, with their stiffness.
    others: Vec<u32>,
    alone: Vec<(u32, f64)>,
    factor: Equilibrated,
}

impl<'a> Step<'a> {
    fn new(
        reduced: &'a Reduced,
        beside: &'a [(u32, u32, f64)],
        held: &'a [bool],
        size: usize,
    ) -> Result<Self, SolveError> {
        let Some(condensation) = &reduced.condensation else { return Err(SolveError::NotFactorised { size }) };
        let mut diagonal = vec![0.0; size];
        let mut is_coupled = vec![false; size];
        for &(i, j, v) in beside.iter().filter(|e| !held[e.1 as usize]) {
            if i == j {
                diagonal[i as usize] += v;
            } else {
                is_coupled[i as usize] = true;
                is_coupled[j as usize] = true;
            }
        }
        let is_other = |u: &u32| !held[*u as usize] && reduced.place_of(*u).is_none();
        let (others, alone): (Vec<u32>, Vec<u32>) =
            (0..size as u32).filter(is_other).partition(|u| is_coupled[*u as usize]);
        let alone: Vec<(u32, f64)> = alone.into_iter().map(|u| (u, diagonal[u as usize])).collect();
        if alone.iter().any(|(_, d)| *d == 0.0) {
            return Err(SolveError::Singular { size });
        }
        let kept = condensation.kept().iter().map(|k| reduced.unknowns[*k as usize]);
        let n = condensation.kept().len() + others.len();
        if n > MOST[0] {
            return Err(SolveError::NotFactorised { size });
        }
        let mut number = vec![ELSEWHERE; size];
        kept.chain(others.iter().copied()).zip(0..).for_each(|(u, k)| number[u as usize] = k);
        let mut matrix = vec![0.0; n * n];
        condensation.add_to(&mut matrix, n);
        for &(i, j, v) in beside.iter().filter(|e| !held[e.1 as usize]) {
            let [i, j] = [i, j].map(|u| number[u as usize]);
            if i != ELSEWHERE && j != ELSEWHERE {
                matrix[j as usize * n + i as usize] += v;
            }
        }
        let factor = Equilibrated::new(n, matrix);
        if factor.smallest_pivot() < SINGULAR {
            return Err(SolveError::Singular { size });
        }
        Ok(Step { reduced, condensation, beside, held, others, alone, factor })
    }

    /// Solves for all unknowns, without refinement.
    fn solve(&self, right: &[f64]) -> Result<Vec<f64>, SolveError> {
        let mut out: Vec<f64> = (0..right.len()).map(|k| if self.held[k] { right[k] } else { 0.0 }).collect();
        let moved = self.product(&out);
        let left = |u: u32| right[u as usize] - moved[u as usize];
        let reduced = self.reduced;
        let of_bodies: Vec<f64> = (reduced.unknowns.iter().zip(&reduced.is_held))
            .map(|(u, is_held)| if *is_held { 0.0 } else { left(*u) })
            .collect();
        let found = self.condensation.solve(&of_bodies, |condensed| {
            let mut x: Vec<f64> = condensed.iter().copied().chain(self.others.iter().map(|u| left(*u))).collect();
            self.factor.solve_in_place(&mut x);
            let others = x.split_off(condensed.len());
            self.others.iter().zip(others).for_each(|(u, y)| out[*u as usize] = y);
            Ok::<_, SolveError>(x)
        })?;
        let free = reduced.unknowns.iter().zip(&found).zip(&reduced.is_held).filter(|(_, is_held)| !**is_held);
        free.for_each(|((u, x), _)| out[*u as usize] = *x);
        self.alone.iter().for_each(|(u, d)| out[*u as usize] = left(*u) / d);
        Ok(out)
    }

    /// The matrix times a step, but for rows of unknowns that are held.
    fn product(&self, x: &[f64]) -> Vec<f64> {
        let mut out = vec![0.0; x.len()];
        let own: Vec<f64> = self.reduced.unknowns.iter().map(|u| x[*u as usize]).collect();
        if own.iter().any(|x| *x != 0.0) {
            let moved = self.reduced.stiffness.multiply(&own);
            self.reduced.unknowns.iter().zip(moved).for_each(|(u, f)| out[*u as usize] = f);
        }
        self.beside.iter().for_each(|(i, j, v)| out[*i as usize] += v * x[*j as usize]);
        out
    }

    /// The largest residual relative to the terms of its equations, and the residual of those that are not held.
    fn residual(&self, x: &[f64], right: &[f64]) -> (f64, Vec<f64>) {
        let product = self.product(x);
        let left: Vec<f64> = (0..x.len()).map(|k| if self.held[k] { 0.0 } else { right[k] - product[k] }).collect();
        let mut sizes = vec![0.0f64; x.len()];
        // Displacements that vanish are known as well as the largest.
        let mut reach: Vec<f64> = x.iter().map(|x| x.abs()).collect();
        let own = &self.reduced.unknowns;
        let farthest = own.iter().fold(0.0f64, |m, u| m.max(reach[*u as usize]));
        own.iter().for_each(|u| reach[*u as usize] = farthest);
        own.iter().zip(&self.reduced.row_sizes).for_each(|(u, s)| sizes[*u as usize] = s * farthest);
        self.beside.iter().for_each(|(i, j, v)| sizes[*i as usize] += v.abs() * reach[*j as usize]);
        let of = |k: usize| left[k].abs() / (sizes[k] + right[k].abs()).max(f64::MIN_POSITIVE);
        let error = (0..x.len()).map(of).fold(0.0f64, |m, e| if e > m || e.is_nan() { e } else { m });
        (error, left)
    }
}

impl TimedLoad {
    /// Whether its tangent on a linear body is the same in all states.
    pub(crate) fn is_constant(&self) -> bool {
        matches!(self, TimedLoad::Springs(_))
    }
}
