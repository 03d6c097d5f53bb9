//! One increment: Newton's method from the last state to equilibrium at a time, with what enforces the contacts about it.
//!
//! A body that nothing but contact holds has no stiffness until it touches. Where the equations have no solution as they
//! stand, weak springs hold all bodies where they were and are taken back step by step; what they still carried in the
//! end shows what holds nothing.

use crate::body::{Order, Sampling};
use crate::contact::{Enforcement, SiteResult};
use crate::system::{Assembled, AssemblyError, System, SystemState, sides};
use signorini_contact::law::{Friction, stuck};
use signorini_contact::{Law, Status};
use signorini_geometry::Vector;
use signorini_solve::SolveError;
use signorini_solve::general::Analysis;
use signorini_solve::newton::{Converged, Equations, Newton, NewtonFailure, Search, newton};

/// Why an increment has no solution.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum IncrementError {
    #[error(transparent)]
    Assembly(#[from] AssemblyError),
    #[error(transparent)]
    Solve(#[from] SolveError),
    #[error("Newton's method did not converge in {} iterations{}", history.len() - 1, worst.as_deref().unwrap_or(""))]
    NotConverged { history: Vec<f64>, worst: Option<String> },
    #[error("`{body}` is free: nothing holds it against {motion}")]
    Free { body: String, motion: String },
    #[error("the tractions of the contacts still changed after {outer} outer iterations")]
    Augmentation { outer: usize, history: Vec<f64> },
    #[error("interrupted")]
    Interrupted,
}

/// What an increment came to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IncrementResult {
    pub iterations: usize,
    /// Residual over what it was to reach, before and after each iteration of the last solve.
    pub history: Vec<f64>,
    /// By contact.
    pub sites: Vec<Vec<SiteResult>>,
    /// Force and moment (of unknowns that turn) of each support on the bodies.
    pub support_forces: Vec<[Vector<3>; 2]>,
    pub energy: f64,
    pub unknowns: usize,
    /// Largest unbalanced force relative to the largest of all.
    pub imbalance: f64,
    /// Sites whose pair had no coordinates: they carry nothing.
    pub lost_sites: usize,
}

/// What holds a body when springs a hundred times weaker than its load per size carry so much of it: nothing else does.
const CARRIES: f64 = 0.1;
/// Force relative to the largest of all that is left in the end.
const TOLERANCE: f64 = 1e-10;
/// Force relative to the largest with which no state is taken for one, whatever rounding may say.
const UNBALANCED: f64 = 1e-6;
/// Change of a traction by an outer iteration, relative to the largest, that ends them.
const AUGMENTED: f64 = 1e-9;
/// Rounding of positions that were solved for, relative to the size of the bodies.
const ROUNDING: f64 = 1e-12;
const MOST_ITERATIONS: usize = 60;
const MOST_AUGMENTATIONS: usize = 60;
/// Penalty in stiffnesses of the bodies.
const PENALTY: f64 = 100.0;
/// The same where it is only a scale: of augmented Lagrangians and multipliers.
const SCALE: f64 = 10.0;
/// Stiffness of the springs that hold free bodies at first, in largest loads per size, and what they are taken back to. The
/// first let a body move by a hundredth of its size: contact reaches farther.
const SPRINGS: [f64; 7] = [1e2, 1.0, 1e-2, 1e-4, 1e-6, 1e-8, 0.0];
/// The first bit of what is out of balance that is let go, and the least.
const FIRST_BIT: f64 = 0.125;
const LEAST_BIT: f64 = 1e-4;
/// Stiffness against what nothing moves, relative to the largest: Newton's method errs by so much of a step.
const GRAIN: f64 = 1e-12;
/// A body that weak springs let go so many sizes away is not held.
const AWAY: f64 = 10.0;

/// Whether another way to the same state may help.
fn is_curable(error: &IncrementError) -> bool {
    matches!(
        error,
        IncrementError::Solve(_)
            | IncrementError::NotConverged { .. }
            | IncrementError::Assembly(AssemblyError::Body(_))
    )
}

/// Friction without a limit.
#[derive(Debug)]
struct Sticks;

impl Law for Sticks {
    fn friction(&self, trial: [f64; 2], _: f64) -> Friction {
        stuck(trial)
    }

    fn utilisation(&self, _: [f64; 2], _: f64) -> f64 {
        0.0
    }

    fn per_pressure(&self) -> Option<[f64; 2]> {
        None
    }
}

struct Problem<'a> {
    system: &'a System,
    time: f64,
    analysis: Analysis,
    /// Springs on all unknowns of bodies.
    springs: f64,
    /// A share of forces on the unknowns of bodies, and of what constraints lack, that is not there yet.
    held_back: Option<(f64, Vec<f64>, Vec<f64>)>,
    /// Unknowns that are spins.
    is_spin: Vec<bool>,
    /// Traction per gap of the rows of multipliers, over their weights.
    row_scale: Vec<f64>,
    /// What rounding of positions leaves of forces and moments.
    rounding: [f64; 2],
    /// The unknown that lacks most.
    worst: usize,
}

impl System {
    /// Prepares the contacts: scales of penalties, and where slips count from. To be called once, when all bodies, loads and
    /// contacts are there.
    ///
    /// # Errors
    /// Places that are not there.
    pub fn prepare(&mut self) -> Result<(), IncrementError> {
        let finite = |contacts: &[crate::contact::Contact]| {
            let list = contacts.iter().flat_map(|c| c.stiffness.iter().zip(c.sites()).map(|(c, s)| c * s.weight));
            list.filter(|c| c.is_finite()).fold(0.0f64, f64::max)
        };
        let mut scale = finite(&self.contacts);
        for contact in &self.contacts {
            // A deformable master of a rigid slave.
            let master = &self.bodies[contact.master.body];
            let sites = |sampling| master.sites(contact.master.group.as_deref(), sampling);
            let list = sites(Sampling::Nodes).or_else(|_| sites(Sampling::GaussPoints)).unwrap_or_default();
            let most = list.iter().map(|s| master.site_stiffness(s)).filter(|c| c.is_finite()).fold(0.0, f64::max);
            scale = scale.max(most);
        }
        // Between rigid bodies any scale serves; that of one force per length is neither large nor small.
        let scale = if scale > 0.0 { scale } else { 1.0 / self.size().max(f64::MIN_POSITIVE) };
        for contact in &mut self.contacts {
            let factor = match contact.enforcement {
                Enforcement::Penalty { .. } => PENALTY,
                _ => SCALE,
            };
            let weights: Vec<f64> = contact.sites().iter().map(|s| s.weight).collect();
            for (c, w) in contact.stiffness.iter_mut().zip(weights) {
                *c = factor * if c.is_finite() { *c } else { scale / w };
            }
        }
        self.leave_out_held_sites()?;
        // Slips count from the start, where nothing carries yet.
        self.accept(&self.start())?;
        for contact in &mut self.contacts {
            contact.memory.iter_mut().for_each(|m| m.traction = [0.0; 3]);
        }
        Ok(())
    }

    /// Leaves out sites that cannot move against a body that does not: supports carry there, and what the contact would
    /// carry is not determined.
    fn leave_out_held_sites(&mut self) -> Result<(), IncrementError> {
        let start = self.start();
        let (single, _) = self.held(&start, 0.0)?;
        let (first, count) = self.numbering();
        let mut held = vec![false; count];
        single.iter().for_each(|h| held[h.constraint.terms[0].0 as usize] = true);
        let bodies = &self.bodies;
        for contact in self.contacts.iter_mut().filter(|c| bodies[c.master.body].unknowns() == 0) {
            let (body, first) = (&bodies[contact.slave.body], first[contact.slave.body]);
            let moves = |site: &crate::body::Site| {
                let placed = body.placed(&start.bodies[contact.slave.body], site);
                placed.functions.iter().any(|f| !held[(first + f.unknown) as usize])
            };
            let kept: Vec<bool> = contact.sites().iter().map(moves).collect();
            contact.keep(&kept);
        }
        Ok(())
    }

    /// The sites of a contact as they are in a state.
    ///
    /// # Errors
    /// Places that are not there.
    pub fn sites(&self, contact: usize, state: &SystemState) -> Result<Vec<SiteResult>, IncrementError> {
        let (first, _) = self.numbering();
        let before: usize = self.contacts[..contact].iter().map(|c| c.multipliers()).sum();
        let contact = &self.contacts[contact];
        let lambda = &state.multipliers[before..before + contact.multipliers()];
        let found =
            contact.results(&sides(&self.bodies, contact, state, &first), lambda).map_err(AssemblyError::from)?;
        Ok(found.into_iter().map(|f| f.0).collect())
    }

    /// Solves for equilibrium at a time, from a state that was accepted. `report` is told each iteration and its residual
    /// over the tolerance; where it says `false` the solver stops.
    ///
    /// # Errors
    /// Why there is no such state.
    pub fn solve(
        &mut self,
        from: &SystemState,
        time: f64,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(SystemState, IncrementResult), IncrementError> {
        let mut start = from.clone();
        start.travel.iter_mut().for_each(|t| *t = 0.0);
        for (body, state) in self.bodies.iter().zip(&mut start.bodies) {
            body.prescribe(time, state);
        }
        let kept: Vec<_> = self.contacts.iter().map(|c| (c.memory.clone(), c.stiffness.clone())).collect();
        let found = self.outer(&start, time, report);
        if found.is_err() {
            for (contact, (memory, stiffness)) in self.contacts.iter_mut().zip(kept) {
                (contact.memory, contact.stiffness) = (memory, stiffness);
            }
        }
        found
    }

    /// Takes a state as the one from which slips count and the next increment starts.
    ///
    /// # Errors
    /// Places that are not there.
    pub fn accept(&mut self, state: &SystemState) -> Result<(), IncrementError> {
        let (first, _) = self.numbering();
        let mut own = 0;
        for contact in &mut self.contacts {
            let lambda = &state.multipliers[own..own + contact.multipliers()];
            own += contact.multipliers();
            let sides = sides(&self.bodies, contact, state, &first);
            contact.accept(&sides, lambda).map_err(AssemblyError::from)?;
        }
        Ok(())
    }

    /// Outer iterations: of augmented Lagrangians, and of penalties that are to leave a given penetration.
    fn outer(
        &mut self,
        start: &SystemState,
        time: f64,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(SystemState, IncrementResult), IncrementError> {
        let mut state = start.clone();
        let mut iterations = 0;
        let mut changes = Vec::new();
        for _ in 0..MOST_AUGMENTATIONS {
            let mut done = iterations;
            let mut counted = |_: usize, r: f64| {
                done += 1;
                report(done, r)
            };
            // Without a guess which sites carry, multipliers start from what penalties find.
            let guessed = state.multipliers.is_empty() || state.multipliers.iter().any(|m| *m != 0.0);
            let direct = if guessed { Some(self.inner(&state, time, &mut counted)) } else { None };
            let found = match direct {
                Some(Ok(found)) => found,
                Some(Err(error)) if state.multipliers.is_empty() || error == IncrementError::Interrupted => {
                    return Err(error);
                }
                failed => {
                    let start = self.by_penalties(start, time, &mut counted);
                    match (self.inner(start.as_ref().unwrap_or(&state), time, &mut counted), failed) {
                        (Ok(found), _) => found,
                        (Err(_), Some(Err(first))) => return Err(first),
                        (Err(error), _) => return Err(error),
                    }
                }
            };
            iterations = done;
            state = found.state;
            let rounding = self.rounding(&state, time)?;
            let result = self.result(&state, time, iterations, (found.history, rounding))?;
            if result.imbalance.is_nan() || result.imbalance > UNBALANCED {
                return Err(IncrementError::NotConverged { history: result.history, worst: None });
            }
            let change = self.augment(&state, &result)?;
            if change <= AUGMENTED {
                return Ok((state, result));
            }
            changes.push(change);
        }
        Err(IncrementError::Augmentation { outer: MOST_AUGMENTATIONS, history: changes })
    }

    /// A state near the one that is looked for, with penalties in place of multipliers, which take the tractions that these
    /// find, and with all that touches sticking: while nothing carries yet, nothing would rub. None where there is no such
    /// state either.
    fn by_penalties(
        &mut self,
        start: &SystemState,
        time: f64,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Option<SystemState> {
        let by_multipliers: Vec<bool> = self.contacts.iter().map(|c| c.multipliers() > 0).collect();
        let switch = |system: &mut System, to: Enforcement| {
            let list = system.contacts.iter_mut().zip(&by_multipliers);
            list.filter(|(_, own)| **own).for_each(|(contact, _)| contact.enforcement = to);
        };
        switch(self, Enforcement::Penalty { wanted_penetration: None });
        let sticking = |contact: &mut crate::contact::Contact| {
            contact.friction.as_mut().map(|law| std::mem::replace(law, Box::new(Sticks)))
        };
        let laws: Vec<_> = self.contacts.iter_mut().map(sticking).collect();
        let from = SystemState { multipliers: Vec::new(), ..start.clone() };
        let found = self.inner(&from, time, report).ok();
        let tractions = found.and_then(|found| {
            let (first, _) = self.numbering();
            let mut list = Vec::new();
            for contact in self.contacts.iter().zip(&by_multipliers).filter(|(_, own)| **own).map(|(c, _)| c) {
                let sites = contact.results(&sides(&self.bodies, contact, &found.state, &first), &[]).ok()?;
                list.extend(sites.iter().flat_map(|(_, t)| t[..contact.components()].to_vec()));
            }
            Some((found.state, list))
        });
        switch(self, Enforcement::Multiplier);
        self.contacts.iter_mut().zip(laws).for_each(|(contact, law)| contact.friction = law);
        let (state, multipliers) = tractions?;
        Some(SystemState { multipliers, ..state })
    }

    /// Sets multipliers to the tractions found, penalties to what leaves the penetration that is wanted; the largest
    /// relative change.
    fn augment(&mut self, state: &SystemState, result: &IncrementResult) -> Result<f64, IncrementError> {
        let (first, _) = self.numbering();
        let size = self.size();
        let mut change = 0.0f64;
        for (contact, sites) in self.contacts.iter_mut().zip(&result.sites) {
            match contact.enforcement {
                Enforcement::AugmentedLagrangian => {
                    let sides = sides(&self.bodies, contact, state, &first);
                    let found = contact.results(&sides, &[]).map_err(AssemblyError::from)?;
                    let most = found.iter().map(|f| f.1[0]).fold(0.0f64, f64::max);
                    let list = contact.memory.iter_mut().zip(&contact.stiffness).zip(found);
                    for ((memory, stiffness), (_, traction)) in list {
                        let changed = (0..3).map(|i| (memory.traction[i] - traction[i]).abs()).fold(0.0, f64::max);
                        // Gaps are known to the rounding of positions only.
                        let known = ROUNDING * size * stiffness;
                        change = change.max(if changed > known { changed / most } else { 0.0 });
                        memory.traction = traction;
                    }
                }
                Enforcement::Penalty { wanted_penetration: Some(wanted) } => {
                    let depth = sites.iter().filter(|s| s.status != Status::Open).filter_map(|s| s.gap);
                    let depth = depth.fold(0.0f64, |m, g| m.max(-g));
                    // The penetration is inverse to the penalty but for what the bodies give way.
                    if depth > 0.0 && (depth / wanted - 1.0).abs() > 1e-2 {
                        contact.stiffness.iter_mut().for_each(|c| *c *= depth / wanted);
                        change = change.max((depth / wanted - 1.0).abs());
                    }
                }
                _ => {}
            }
        }
        Ok(change)
    }

    fn inner(
        &self,
        start: &SystemState,
        time: f64,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let (first, count) = self.numbering();
        let mut is_spin = vec![false; count];
        for (body, first) in self.bodies.iter().zip(first) {
            body.spins().iter().flatten().for_each(|s| is_spin[(first + s) as usize] = true);
        }
        let mut row_scale = Vec::new();
        for contact in self.contacts.iter().filter(|c| c.multipliers() > 0) {
            row_scale.extend(contact.stiffness.iter().flat_map(|c| vec![*c; contact.components()]));
        }
        let mut problem = Problem {
            system: self,
            time,
            analysis: Analysis::default(),
            springs: 0.0,
            held_back: None,
            is_spin,
            row_scale,
            rounding: [0.0; 2],
            worst: 0,
        };
        let direct = problem.solve(start, report);
        let Err(error) = direct else { return direct };
        if !is_curable(&error) {
            return Err(error);
        }
        // A free body needs springs until it touches; what is held may take what is out of balance bit by bit.
        if !self.has_free_rigid_body() {
            match problem.bit_by_bit(start, report) {
                Err(failed) if is_curable(&failed) => {}
                found => return found,
            }
        }
        if self.contacts.is_empty() {
            return Err(problem.named(error, start));
        }
        problem.with_springs(start, error, report)
    }

    fn has_free_rigid_body(&self) -> bool {
        self.bodies.iter().any(|b| b.is_rigid() && b.unknowns() > 0)
    }

    /// What rounding of positions leaves of forces.
    fn rounding(&self, state: &SystemState, time: f64) -> Result<f64, IncrementError> {
        let at = self.assemble(state, time, Order::Second)?;
        let (_, count) = self.numbering();
        let stiffest = at.tangent.matrix(at.residual.len()).row_sizes()[..count].iter().fold(0.0f64, |m, s| m.max(*s));
        Ok(f64::EPSILON * stiffest * self.size())
    }

    /// What a state is reported as.
    fn result(
        &self,
        state: &SystemState,
        time: f64,
        iterations: usize,
        (history, rounding): (Vec<f64>, f64),
    ) -> Result<IncrementResult, IncrementError> {
        let (_, count) = self.numbering();
        let at = self.assemble(state, time, Order::First)?;
        let mut support_forces = vec![[Vector::<3>::zeros(); 2]; self.supports.len()];
        let mut add = |support: usize, component: usize, value: f64| {
            if component < 6 {
                support_forces[support][component / 3][component % 3] += value;
            }
        };
        let mut residual = at.residual.clone();
        for held in &at.single {
            let (unknown, factor) = held.constraint.terms[0];
            add(held.support, held.constraint.component, residual[unknown as usize] / factor);
            residual[unknown as usize] = 0.0;
        }
        for (held, reaction) in at.coupled.iter().zip(&state.reactions) {
            add(held.support, held.constraint.component, -reaction);
        }
        at.weakly_held.iter().for_each(|(support, force)| support_forces[*support][0] += force);
        let most = at.sizes[..count].iter().fold(f64::MIN_POSITIVE, |m, s| m.max(*s));
        // Where no force acts what is left is the rounding of the positions.
        let most = most.max(1e10 * rounding);
        let imbalance = residual[..count].iter().fold(0.0f64, |m, r| m.max(r.abs())) / most;
        let sites = (0..self.contacts.len()).map(|k| self.sites(k, state)).collect::<Result<_, _>>()?;
        Ok(IncrementResult {
            iterations,
            history,
            sites,
            support_forces,
            energy: at.energy,
            unknowns: at.residual.len(),
            imbalance,
            lost_sites: at.lost,
        })
    }
}

impl Problem<'_> {
    fn solve(
        &mut self,
        start: &SystemState,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        self.rounding = [0.0; 2];
        let predicts = start.bodies.iter().any(|b| !b.internal.is_empty());
        let search = if predicts { Search::Watchdog { patience: 6 } } else { Search::Monotone };
        let options = Newton { most_iterations: MOST_ITERATIONS, search };
        newton(self, start, &options, report).map_err(|failure| match failure {
            NewtonFailure::NotConverged { history, .. } => {
                IncrementError::NotConverged { history, worst: self.describe(self.worst) }
            }
            NewtonFailure::Equations { error, .. } => error,
            NewtonFailure::Interrupted => IncrementError::Interrupted,
        })
    }

    /// Solves with the forces that are out of balance at the start, and what supports prescribe beyond it, held back and
    /// let go bit by bit.
    fn bit_by_bit(
        &mut self,
        start: &SystemState,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let at = self.system.assemble(start, self.time, Order::First)?;
        let count = self.is_spin.len();
        let lacks: Vec<f64> = at.single.iter().chain(&at.coupled).map(|h| h.constraint.lack).collect();
        let (mut reached, mut size) = (0.0, FIRST_BIT);
        let mut state = start.clone();
        let held_back = (at.residual[..count].to_vec(), lacks);
        loop {
            let to = if reached + size > 1.0 - 1e-9 { 1.0 } else { reached + size };
            self.held_back = (to < 1.0).then(|| (1.0 - to, held_back.0.clone(), held_back.1.clone()));
            let found = self.solve(&state, report);
            self.held_back = None;
            match found {
                Ok(found) if to == 1.0 => return Ok(found),
                Ok(found) => {
                    state = found.state;
                    reached = to;
                    size *= 1.5;
                }
                Err(error) if !is_curable(&error) || size < LEAST_BIT => return Err(error),
                Err(_) => size *= 0.25,
            }
        }
    }

    /// Solves with weak springs that hold all bodies where they were, and are taken back step by step.
    fn with_springs(
        &mut self,
        start: &SystemState,
        error: IncrementError,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let load = self.load(start)?;
        let mut state = start.clone();
        let mut last = None;
        let mut before = 0.0;
        for factor in SPRINGS {
            self.springs = factor * load / self.system.size();
            match self.solve(&state, report) {
                Ok(found) => {
                    if factor < 1.0
                        && let Some(body) = self.away(&found.state, load)
                    {
                        return Err(body);
                    }
                    state = found.state.clone();
                    last = Some(found);
                }
                Err(IncrementError::Interrupted) => return Err(IncrementError::Interrupted),
                Err(_) => {
                    // What the last springs carried tells what nothing else does.
                    self.springs = before;
                    let free = last.is_some().then(|| self.away(&state, load)).flatten();
                    return Err(free.unwrap_or_else(|| self.named(error, &state)));
                }
            }
            before = self.springs;
        }
        last.ok_or(error)
    }

    /// The residual with springs, and less what is held back.
    fn assemble(&self, at: &SystemState, order: Order) -> Result<Assembled, IncrementError> {
        let mut out = self.system.assemble(at, self.time, order)?;
        if self.springs > 0.0 {
            for (k, travel) in at.travel.iter().enumerate() {
                let stiffness = self.spring(k);
                out.residual[k] += stiffness * travel;
                out.sizes[k] += (stiffness * travel).abs();
                if order == Order::Second {
                    out.tangent.add(k as u32, k as u32, stiffness);
                }
            }
        }
        if let Some((share, forces, lacks)) = &self.held_back {
            out.residual.iter_mut().zip(forces).for_each(|(r, f)| *r -= share * f);
            let count = out.residual.len() - out.coupled.len();
            let list = out.single.iter_mut().chain(&mut out.coupled);
            list.zip(lacks).for_each(|(held, lack)| held.constraint.lack -= share * lack);
            for (k, held) in out.coupled.iter().enumerate() {
                out.residual[count + k] = held.constraint.lack;
            }
        }
        Ok(out)
    }

    fn spring(&self, unknown: usize) -> f64 {
        let size = if self.is_spin[unknown] { self.system.size() } else { 1.0 };
        self.springs * size * size
    }

    /// The largest force that acts.
    fn load(&self, at: &SystemState) -> Result<f64, IncrementError> {
        let size = self.system.size();
        let sizes = self.system.assemble(at, self.time, Order::First)?.sizes;
        let force = |(k, s): (usize, &f64)| if self.is_spin[k] { s / size } else { *s };
        Ok(sizes[..self.is_spin.len()].iter().enumerate().map(force).fold(f64::MIN_POSITIVE, f64::max))
    }

    /// The body that springs let go, or that nothing but springs holds.
    fn away(&self, at: &SystemState, load: f64) -> Option<IncrementError> {
        let size = self.system.size();
        let extent = |k: usize| if self.is_spin[k] { 1.0 } else { size };
        let goes = |k: usize| at.travel[k].abs() > AWAY * extent(k);
        let carries = |k: usize| self.spring(k) * at.travel[k].abs() / load * extent(k) / size;
        let most = (0..at.travel.len()).max_by(|a, b| carries(*a).total_cmp(&carries(*b)))?;
        let far = (0..at.travel.len()).find(|&k| goes(k) || at.travel[k].is_nan());
        let unknown = far.or_else(|| (carries(most) > CARRIES).then_some(most))?;
        Some(self.free(unknown, at))
    }

    /// A body that moves as a state did, and most in one unknown.
    fn free(&self, unknown: usize, at: &SystemState) -> IncrementError {
        let (first, _) = self.system.numbering();
        let Some(k) = first.iter().rposition(|f| *f as usize <= unknown) else { return IncrementError::Interrupted };
        let body = &self.system.bodies[k];
        let travel = &at.travel[first[k] as usize..first[k] as usize + body.unknowns()];
        let modes = body.rigid_modes(&at.bodies[k]);
        let along = |mode: &Vec<f64>| {
            let square: f64 = mode.iter().map(|m| m * m).sum();
            let product: f64 = mode.iter().zip(travel).map(|(m, t)| m * t).sum();
            if square > 0.0 { product / square } else { 0.0 }
        };
        let turns = self.is_spin[unknown];
        let part = if turns { &modes[3..] } else { &modes[..3] };
        let direction = Vector::<3>::from_fn(|i, _| along(&part[i]));
        let d = direction.try_normalize(0.0).unwrap_or_default();
        let kind = if turns { "turning about" } else { "moving along" };
        let motion = format!("{kind} ({:.3}, {:.3}, {:.3})", d[0], d[1], d[2]);
        IncrementError::Free { body: body.name().to_string(), motion }
    }

    fn body_of(&self, unknown: usize) -> Option<(&str, usize)> {
        let (first, count) = self.system.numbering();
        if unknown >= count {
            return None;
        }
        let k = first.iter().rposition(|f| *f as usize <= unknown)?;
        Some((self.system.bodies[k].name(), unknown - first[k] as usize))
    }

    fn describe(&self, unknown: usize) -> Option<String> {
        match self.body_of(unknown) {
            Some((body, _)) => Some(format!("; what lacked most is a force on `{body}`")),
            None => {
                let mut row = unknown - self.is_spin.len();
                for contact in &self.system.contacts {
                    if row < contact.multipliers() {
                        return Some(format!("; what lacked most is a condition of contact `{}`", contact.name));
                    }
                    row -= contact.multipliers();
                }
                Some("; what lacked most is a support".to_string())
            }
        }
    }

    /// A system without a solution, by the body that is free to move.
    fn named(&self, error: IncrementError, at: &SystemState) -> IncrementError {
        if !matches!(error, IncrementError::Solve(_) | IncrementError::NotConverged { .. }) {
            return error;
        }
        let Ok(assembled) = self.system.assemble(at, self.time, Order::Second) else { return error };
        let (first, count) = self.system.numbering();
        let held: Vec<usize> = assembled.single.iter().map(|h| h.constraint.terms[0].0 as usize).collect();
        let matrix = assembled.tangent.matrix(assembled.residual.len());
        let largest = matrix.row_sizes().into_iter().fold(0.0f64, f64::max);
        for (k, body) in self.system.bodies.iter().enumerate() {
            for (mode, motion) in body.rigid_modes(&at.bodies[k]).iter().enumerate() {
                let mut x = vec![0.0; assembled.residual.len()];
                let range = first[k] as usize..first[k] as usize + motion.len();
                x[range].copy_from_slice(motion);
                let size = motion.iter().fold(0.0f64, |m, v| m.max(v.abs()));
                if size == 0.0 || held.iter().any(|h| x[*h] != 0.0) {
                    continue;
                }
                let moved = matrix.multiply(&x);
                if moved[..count].iter().all(|f| f.abs() <= 1e-10 * largest * size) {
                    let axis = ["x", "y", "z"][mode % 3];
                    let motion =
                        if mode < 3 { format!("moving along {axis}") } else { format!("turning about {axis}") };
                    return IncrementError::Free { body: body.name().to_string(), motion };
                }
            }
        }
        error
    }
}

impl Equations for Problem<'_> {
    type State = SystemState;
    type Error = IncrementError;

    fn measure(&mut self, at: &SystemState) -> Result<f64, IncrementError> {
        let out = self.assemble(at, Order::First)?;
        let count = self.is_spin.len();
        let size = self.system.size();
        let mut scale = [f64::MIN_POSITIVE; 2];
        for k in 0..count {
            let kind = usize::from(self.is_spin[k]);
            scale[kind] = scale[kind].max(out.sizes[k]);
        }
        // Moments of forces whose arms are not better known than the size of a body.
        scale[1] = scale[1].max(scale[0] * size * 1e-6);
        let mut held = vec![false; count];
        out.single.iter().for_each(|h| held[h.constraint.terms[0].0 as usize] = true);
        let mut worst = (0.0f64, 0);
        let mut take = |value: f64, k: usize| {
            if value > worst.0 || value.is_nan() {
                worst = (value, k);
            }
        };
        for k in (0..count).filter(|k| !held[*k]) {
            let kind = usize::from(self.is_spin[k]);
            take(out.residual[k].abs() / (TOLERANCE * scale[kind]).max(self.rounding[kind]), k);
        }
        for (k, c) in self.row_scale.iter().enumerate() {
            // Gaps no better than the rounding of positions.
            let force = out.residual[count + k].abs() * c;
            take(force / (TOLERANCE * scale[0]).max(self.rounding[0]), count + k);
        }
        for held in out.single.iter().chain(&out.coupled) {
            take(held.constraint.lack.abs() / (ROUNDING * size), held.constraint.terms[0].0 as usize);
        }
        self.worst = worst.1;
        Ok(worst.0)
    }

    fn step(&mut self, at: &SystemState) -> Result<Vec<f64>, IncrementError> {
        let mut out = self.assemble(at, Order::Second)?;
        let n = out.residual.len();
        let count = self.is_spin.len();
        let mut right: Vec<f64> = out.residual.iter().map(|r| -r).collect();
        let mut held = vec![false; n];
        for h in &out.single {
            let (unknown, factor) = h.constraint.terms[0];
            held[unknown as usize] = true;
            right[unknown as usize] = -h.constraint.lack / factor;
        }
        out.tangent.without_rows(|row| held[row as usize]);
        (0..n).filter(|k| held[*k]).for_each(|k| out.tangent.add(k as u32, k as u32, 1.0));
        let matrix = out.tangent.matrix(n);
        let sizes = matrix.row_sizes();
        let size = self.system.size();
        // That of the first state: further ones may be anywhere.
        if self.rounding == [0.0; 2] {
            for k in (0..count).filter(|k| !held[*k]) {
                let kind = usize::from(self.is_spin[k]);
                let position = if kind == 1 { 1.0 } else { size };
                self.rounding[kind] = self.rounding[kind].max(4.0 * f64::EPSILON * sizes[k] * position);
            }
        }
        if !self.system.has_free_rigid_body()
            && let Ok(found) = self.analysis.factor(matrix).and_then(|lu| lu.solve(&right))
        {
            return Ok(found);
        }
        // A ball without friction may turn, a slack rope has no stiffness: a grain of it in the matrix alone keeps them where
        // they are and changes no solution.
        let mut most = [0.0f64; 2];
        for k in (0..count).filter(|k| !held[*k]) {
            let kind = usize::from(self.is_spin[k]);
            most[kind] = most[kind].max(sizes[k]);
        }
        for k in (0..count).filter(|k| !held[*k]) {
            let kind = usize::from(self.is_spin[k]);
            let scale = if most[kind] > 0.0 { most[kind] } else { most[0].max(f64::MIN_POSITIVE) * size * size };
            out.tangent.add(k as u32, k as u32, GRAIN * scale);
        }
        let matrix = out.tangent.matrix(n);
        Ok(self.analysis.factor(matrix)?.solve(&right)?)
    }

    fn is_driven(&self, at: &SystemState) -> bool {
        if self.held_back.is_some() {
            return false;
        }
        let size = self.system.size();
        let lacks = |h: &crate::system::Held| h.constraint.lack.abs() > ROUNDING * size;
        self.system.held(at, self.time).is_ok_and(|(single, coupled)| single.iter().chain(&coupled).any(lacks))
    }

    fn advance(&self, at: &SystemState, step: &[f64], share: f64) -> SystemState {
        self.system.advance(at, step, share)
    }
}
