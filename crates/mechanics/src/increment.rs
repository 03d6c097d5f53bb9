//! One increment: from the last state to equilibrium at a time.
//!
//! `equilibrium` solves the equations as they stand; where that fails `homotopy` looks for another way to the same state.
//! About both run the outer iterations of `augmentation`.

use crate::body::{BodyState, UnstableMaterial};
use crate::dynamics::Moved;
use crate::equilibrium::{Problem, Way};
use crate::heat::HeatResult;
use crate::increment_error::IncrementError;
use crate::interaction::Bodies;
use crate::linear_solver::{Solved, Stiffness};
use crate::points::Order;
use crate::shown_surface::ShownSurface;
use crate::site_result::{SiteResult, with_rest};
use crate::stability::{Stability, UnstableMode};
use crate::system::{Assembled, AssemblyError, Holder, System, SystemState};
use signorini_geometry::Vector;
use signorini_solve::general::Analysis;
use signorini_solve::newton::Converged;
use signorini_solve::schwarz::Inverses;

/// What an increment came to.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct IncrementResult {
    pub iterations: usize,
    /// Residual over what it was to reach, before and after each iteration of the last solve.
    pub history: Vec<f64>,
    /// Of rigid bodies: states between which they moved straight on.
    pub way: Vec<Vec<BodyState>>,
    /// By contact.
    pub sites: Vec<Vec<SiteResult>>,
    /// Force and moment (of unknowns that turn) of each support on the bodies.
    pub support_forces: Vec<[Vector<3>; 2]>,
    /// Force of each linear constraint on its nodes, per unit of their factors.
    pub constraint_forces: Vec<f64>,
    pub energy: f64,
    /// Energy that the friction of each contact took in the increment.
    pub dissipated: Vec<f64>,
    /// Energy that each body dissipated in the increment.
    pub dissipated_in_bodies: Vec<f64>,
    /// Where the material of each body is not stable.
    pub unstable_materials: Vec<Option<UnstableMaterial>>,
    pub unknowns: usize,
    /// Largest unbalanced force relative to the largest of all.
    pub imbalance: f64,
    /// Sites whose pair had no coordinates: they carry nothing.
    pub lost_sites: usize,
    /// What solved the linear equations.
    pub solved: Solved,
    /// Of rigid bodies: whether other contact forces would balance the loads as well.
    pub is_indeterminate: bool,
    /// None of systems that cannot be unstable, or whose tangent is never factorised.
    pub stability: Option<Stability>,
    /// How bodies moved; none of equilibria.
    pub moved: Option<Moved>,
    /// Temperatures and flows of heat; none where nothing is known of them.
    pub heat: Option<HeatResult>,
}

/// Force relative to the largest with which no state is taken for one, whatever rounding may say.
pub(crate) const UNBALANCED: f64 = 1e-6;
/// Change of a traction by an outer iteration, relative to the largest, that ends them.
pub(crate) const AUGMENTED: f64 = 1e-9;
pub(crate) const MOST_AUGMENTATIONS: usize = 60;

/// How Newton's method goes.
pub(crate) enum Strategy<'a> {
    /// From the last state.
    Straight,
    /// From the last state, by whole steps as they come: what is slender bends with a residual that rises before it falls.
    Whole,
    /// From the last state, down a convex energy.
    Down,
    /// Round what failed so.
    Round(IncrementError),
    /// From a little beside a state: whether there is one as well.
    Beside(&'a UnstableMode),
    /// From an unstable state, along a direction or against it.
    Along(&'a UnstableMode, f64),
}

/// Whether another way to the same state may help.
pub(crate) fn is_curable(error: &IncrementError) -> bool {
    matches!(
        error,
        IncrementError::Solve(_)
            | IncrementError::NotConverged { .. }
            | IncrementError::Assembly(AssemblyError::Body(_))
    )
}

impl System {
    /// The sites of a contact as they are in a state.
    ///
    /// # Errors
    /// Places that are not there.
    pub fn sites(&self, contact: usize, state: &SystemState) -> Result<Vec<SiteResult>, IncrementError> {
        let found = self.sites_at_limit(contact, state)?;
        let has_friction = self.contacts[contact].friction().is_some();
        Ok(if has_friction { with_rest(found, self.size()) } else { found })
    }

    /// The surface of a contact as it is drawn in a state, between the sites of [`System::sites`]; none of what has no faces.
    ///
    /// # Errors
    /// Places that are not there.
    pub fn surface(&self, contact: usize, state: &SystemState) -> Result<Option<ShownSurface>, IncrementError> {
        let (first, _) = self.numbering();
        let own = self.own(state)[contact];
        let found = self.contacts[contact].surface(self.bodies_in(state, &first), own);
        Ok(found.map_err(AssemblyError::from)?)
    }

    /// The sites of a contact, where all that is at the limit of its friction slips.
    pub(crate) fn sites_at_limit(
        &self,
        contact: usize,
        state: &SystemState,
    ) -> Result<Vec<SiteResult>, IncrementError> {
        let (first, _) = self.numbering();
        let own = self.own(state)[contact];
        let found = self.contacts[contact].results(self.bodies_in(state, &first), own);
        Ok(found.map_err(AssemblyError::from)?)
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
        let Some(heat) = self.heat.take() else { return self.solve_at_temperature(from, time, report) };
        let found = self.solve_with_heat(&heat, from, time, report);
        self.heat = Some(heat);
        found
    }

    /// The same at the temperatures of the state.
    pub(crate) fn solve_at_temperature(
        &mut self,
        from: &SystemState,
        time: f64,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(SystemState, IncrementResult), IncrementError> {
        if self.is_rigid() {
            return self.solve_rigid(from, time, report);
        }
        if let Some(dynamics) = self.dynamics {
            return self.solve_in_time(from, time, &dynamics, report);
        }
        let kept = self.histories();
        let start = self.begin(from, time)?;
        self.solve_from(&start, (from, &kept), report)
    }

    /// Ends an increment that was begun: solves it from where Newton's method is to start.
    fn solve_from(
        &mut self,
        start: &SystemState,
        (from, kept): (&SystemState, &[[Vec<f64>; 2]]),
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(SystemState, IncrementResult), IncrementError> {
        let time = start.time;
        let found = self
            .outer(start, time, report)
            .and_then(|found| self.check_inside(&found.0, false).map(|()| found))
            .and_then(|found| self.on_a_stable_branch(found, time, report));
        self.end();
        let (state, mut result) = found.inspect_err(|_| self.put_back(kept))?;
        self.locate_instability(from, (time, kept), &mut result, report)?;
        Ok((state, result))
    }

    /// Solves for a time as [`System::solve`] does, at the temperatures that are known, with Newton's method started from a state of
    /// that time: one of other laws.
    ///
    /// # Errors
    /// Why there is no state.
    pub fn solve_near(
        &mut self,
        from: &SystemState,
        guess: &SystemState,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(SystemState, IncrementResult), IncrementError> {
        let kept = self.histories();
        let start = self.begin(from, guess.time)?;
        let inner = start.bodies.into_iter().map(|body| body.internal);
        let bodies = guess.bodies.iter().cloned().zip(inner).map(|(body, internal)| BodyState { internal, ..body });
        let near = SystemState { bodies: bodies.collect(), predictions: start.predictions, ..guess.clone() };
        self.solve_from(&near, (from, &kept), report)
    }

    /// The state from which an increment to a time starts, what is prescribed brought there.
    pub(crate) fn begin(&mut self, from: &SystemState, time: f64) -> Result<SystemState, IncrementError> {
        let mut start = SystemState { time, ..from.clone() };
        start.travel.iter_mut().for_each(|t| *t = 0.0);
        for (k, (body, state)) in self.bodies.iter().zip(&mut start.bodies).enumerate() {
            if body.is_inelastic() {
                state.internal = body.renewed(state);
            }
            // What the law remembers is that of the temperature before.
            if let (Some(thermal), Some(temperature)) = (body.thermal(), self.temperatures.get(k)) {
                thermal.set_temperature(state, temperature);
            }
            body.prescribe(time, state);
        }
        if let Some((k, share)) = self.first_passage(from, &start)? {
            return Err(IncrementError::PassesThrough { contact: self.contacts[k].name().to_string(), share });
        }
        start.multipliers = self.contacts.iter().flat_map(|c| c.law().multipliers()).collect();
        start.predictions = self.contacts.iter().map(|c| c.prediction()).collect();
        let (first, _) = self.numbering();
        let at = Bodies { bodies: &self.bodies, states: &from.bodies, first: &first };
        self.contacts.iter_mut().for_each(|c| {
            c.begin_increment(time);
            c.depart(at);
        });
        Ok(start)
    }

    pub(crate) fn end(&mut self) {
        self.contacts.iter_mut().for_each(|c| c.law_mut().end());
    }

    /// Tells what lies inside of a rigid body in a state: where nothing sees it, or at the start deeper than an interference.
    ///
    /// # Errors
    /// The deepest point of the first contact that has one.
    pub fn check_inside(&self, state: &SystemState, is_start: bool) -> Result<(), IncrementError> {
        let (first, _) = self.numbering();
        let at = self.bodies_in(state, &first);
        for contact in &self.contacts {
            if let Some(found) = contact.inside(at, is_start).map_err(AssemblyError::from)? {
                let body = self.bodies[contact.bodies()[0]].name().to_string();
                let (contact, depth, x) = (contact.name().to_string(), found.depth, found.x.into());
                return Err(IncrementError::Inside { contact, body, depth, x });
            }
        }
        Ok(())
    }

    /// Outer iterations: of augmented Lagrangians, and of penalties that are to leave a given penetration.
    pub(crate) fn outer(
        &mut self,
        start: &SystemState,
        time: f64,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(SystemState, IncrementResult), IncrementError> {
        let mut state = start.clone();
        let mut iterations = 0;
        let mut changes = Vec::new();
        let mut solved = Solved::default();
        for _ in 0..MOST_AUGMENTATIONS {
            let mut done = iterations;
            let mut counted = |_: usize, r: f64| {
                done += 1;
                report(done, r)
            };
            // Without a guess which sites carry, multipliers start from what penalties find.
            let exact = self.contacts.iter().any(|c| c.law().is_exact());
            if exact && self.step.is_none() && changes.is_empty() && state.multipliers.iter().all(|m| *m == 0.0) {
                state.multipliers = self.initial_multipliers(&state, time)?;
            }
            let guessed = !exact || self.step.is_some() || state.multipliers.iter().any(|m| *m != 0.0);
            let direct = if guessed { Some(self.inner(&state, time, &mut solved, &mut counted)) } else { None };
            let found = match direct {
                Some(Ok(found)) => found,
                Some(Err(error))
                    if self.contacts.is_empty()
                        || self.step.is_some()
                        || self.follows_its_path()
                        || error == IncrementError::Interrupted =>
                {
                    return Err(error);
                }
                failed => match self.laid_from_afar(start, time, &mut solved, &mut counted) {
                    Some(laid) => laid?,
                    None => {
                        let start = self.by_penalties(start, time, &mut solved, &mut counted);
                        match (self.inner(start.as_ref().unwrap_or(&state), time, &mut solved, &mut counted), failed) {
                            (Ok(found), _) => found,
                            (Err(_), Some(Err(first))) => return Err(first),
                            (Err(error), _) => return Err(error),
                        }
                    }
                },
            };
            iterations = done;
            state = found.state;
            let rounding = self.rounding(&state, time)?;
            let mut result = self.result(&state, time, iterations, (found.history, rounding))?;
            result.solved = solved;
            if result.imbalance.is_nan() || result.imbalance > UNBALANCED {
                return Err(IncrementError::NotConverged { history: result.history, worst: None });
            }
            let change = self.augment(&state, &result, changes.last().copied())?;
            if change <= AUGMENTED {
                return Ok((state, result));
            }
            changes.push(change);
        }
        Err(IncrementError::Augmentation { outer: MOST_AUGMENTATIONS, history: changes })
    }

    /// Newton's method, by whatever way; adds to what solved its linear equations.
    pub(crate) fn inner(
        &mut self,
        start: &SystemState,
        time: f64,
        solved: &mut Solved,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        // What is slack has no stiffness at all: only where it settles has it some.
        if self.step.is_none() && self.is_slack(start) {
            match self.settled(start, time, solved, report) {
                Err(error) if is_curable(&error) => {}
                found => return found,
            }
        }
        let failed = match self.by(Strategy::Straight, start, time, solved, report) {
            Err(error) if is_curable(&error) && !self.follows_its_path() => error,
            found => return found,
        };
        // A rope that is as long as its way holds nothing across itself before it is pulled.
        if self.step.is_none() && !self.is_slack(start) && self.carries_nothing(start) {
            match self.settled(start, time, solved, report) {
                Err(error) if is_curable(&error) => {}
                found => return found,
            }
        }
        // A rope that is drawn along moves off all that it touches by a trial as stiff as it is along itself, not across; and so
        // does a plate that bends by one as stiff as its cells.
        let found = self.with_trials(&|is_soft| !is_soft, |system, changes| {
            changes.then(|| system.by(Strategy::Straight, start, time, solved, report))
        });
        match found {
            None => {}
            Some(Err(error)) if is_curable(&error) => {}
            Some(found) => {
                // What exact multipliers find does not depend on their trials: those that led to a state go on.
                let exact = self.contacts.iter_mut().map(|c| c.law_mut()).filter(|law| found.is_ok() && law.is_exact());
                exact.for_each(|law| _ = law.make_trials(!law.is_soft));
                return found;
            }
        }
        // Where there is friction the way decides which state is reached.
        if !self.has_friction()
            && let Some(found) = self.laid_down(start, time, solved, report)
        {
            return found;
        }
        if self
            .bodies
            .iter()
            .any(|body| !body.is_linear() && !body.is_rigid() && !body.is_inelastic() && body.curve(None).is_none())
        {
            match self.by(Strategy::Whole, start, time, solved, report) {
                Err(error) if is_curable(&error) => {}
                found => return found,
            }
        }
        if self.step.is_some() {
            return Err(failed);
        }
        // No other way leads where there is nothing to find.
        let (first, _) = self.numbering();
        let at = self.bodies_in(start, &first);
        if let Some(reason) = self.contacts.iter().find_map(|contact| contact.ill_conditioning(at)) {
            let history = match failed {
                IncrementError::NotConverged { history, .. } => history,
                _ => vec![0.0],
            };
            return Err(IncrementError::NotConverged { history, worst: Some(format!("; {reason}")) });
        }
        self.by(Strategy::Round(failed), start, time, solved, report)
    }

    /// Whether the state depends on the way to it, by bodies that are held: an increment without a state is to be cut, since
    /// another way leads to another state.
    fn follows_its_path(&self) -> bool {
        self.bodies.iter().any(|body| body.is_inelastic()) && !self.has_free_body()
    }

    /// What is done while the trials of contacts that can be are soft or not, by whether they were; told whether that changed
    /// any.
    pub(crate) fn with_trials<T>(&mut self, soft: &dyn Fn(bool) -> bool, of: impl FnOnce(&mut Self, bool) -> T) -> T {
        let before: Vec<bool> = self.contacts.iter().map(|contact| contact.law().is_soft).collect();
        let mut changes = false;
        for (contact, before) in self.contacts.iter_mut().zip(&before) {
            changes |= contact.law_mut().make_trials(soft(*before));
        }
        let found = of(self, changes);
        self.contacts.iter_mut().zip(before).for_each(|(contact, before)| _ = contact.law_mut().make_trials(before));
        found
    }

    /// Newton's method by one way.
    pub(crate) fn by(
        &self,
        way: Strategy<'_>,
        start: &SystemState,
        time: f64,
        solved: &mut Solved,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let mut problem = self.problem(start, time, *solved)?;
        problem.way = match way {
            Strategy::Down => Way::Down,
            Strategy::Whole => Way::Whole,
            _ => Way::ByBodies,
        };
        let found = match way {
            Strategy::Straight | Strategy::Whole => match problem.solve(start, report) {
                // Newton's method may find a body far away, where it touches nothing, or on the other side of another, or one that
                // slid though friction holds it.
                Ok(found)
                    if problem.passes(start, &found.state)
                        || self.step.is_none()
                            && ((problem.leaps(start, &found.state) && !problem.is_pulled(start))
                                || problem.slides(start, &found.state)) =>
                {
                    let history = found.history;
                    Err(IncrementError::NotConverged { history, worst: None })
                }
                found => found,
            },
            Strategy::Down => problem.solve(start, report),
            Strategy::Round(error) => self.by_another_strategy(&mut problem, start, error, report),
            Strategy::Beside(mode) => problem.beside(mode, start, report),
            Strategy::Along(mode, sign) => problem.along(mode, sign, start, report),
        };
        *solved = problem.solved;
        found
    }

    /// The equations of a time, to be solved from a state.
    pub(crate) fn problem(
        &self,
        start: &SystemState,
        time: f64,
        solved: Solved,
    ) -> Result<Problem<'_>, IncrementError> {
        let rows = self.contacts.iter().flat_map(|c| c.law().rows()).collect();
        let stiffness = self.stiffness(start)?;
        Ok(Problem {
            system: self,
            time,
            stiffness,
            solved,
            inverses: Inverses::default(),
            analysis: Analysis::default(),
            symbolic: self.dissected(),
            is_free: self.step.is_none() && stiffness != Stiffness::KeptByBodies && self.has_free_body(),
            springs: 0.0,
            metric: Vec::new(),
            way: Way::ByBodies,
            held_back: None,
            is_spin: self.is_spin(),
            rows,
            scales: Vec::new(),
            first: None,
            rounding: [0.0; 2],
            gone: 0.0,
            worst: 0,
        })
    }

    fn by_another_strategy(
        &self,
        problem: &mut Problem<'_>,
        start: &SystemState,
        error: IncrementError,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        // A free body needs springs until it touches; what is held may take what is out of balance bit by bit.
        if !(problem.is_free || self.has_friction() && self.has_unheld_body()) {
            match problem.load_homotopy(start, report) {
                Err(failed) if is_curable(&failed) => {}
                found => return found,
            }
        }
        if self.contacts.is_empty() {
            return Err(problem.named(error, start));
        }
        problem.pseudo_time(start, error, report)
    }

    /// What rounding of positions leaves of forces.
    pub(crate) fn rounding(&self, state: &SystemState, time: f64) -> Result<f64, IncrementError> {
        let stiffness = self.stiffness(state)?;
        let at = self.assemble_with(state, time, Order::Second, stiffness)?;
        let (_, count) = self.numbering();
        let stiffest = self.row_sizes(&at, stiffness)[..count].iter().fold(0.0f64, |m, s| m.max(*s));
        Ok(f64::EPSILON * stiffest * self.size())
    }

    /// The force and moment of each support on the bodies, of the residual at a state.
    pub(crate) fn support_forces(&self, at: &Assembled, state: &SystemState) -> Vec<[Vector<3>; 2]> {
        let mut out = vec![[Vector::<3>::zeros(); 2]; self.supports.len()];
        for held in &at.single {
            let (unknown, factor) = held.constraint.terms[0];
            held.add_reaction(at.residual[unknown as usize] / factor, &mut out);
        }
        for (held, reaction) in at.coupled.iter().zip(&state.reactions) {
            held.add_reaction(-reaction, &mut out);
        }
        at.weakly_held.iter().for_each(|(support, force)| out[*support][0] += force);
        out
    }

    /// What a state is reported as.
    pub(crate) fn result(
        &self,
        state: &SystemState,
        time: f64,
        iterations: usize,
        (history, rounding): (Vec<f64>, f64),
    ) -> Result<IncrementResult, IncrementError> {
        let (_, count) = self.numbering();
        let at = self.assemble(state, time, Order::First)?;
        let support_forces = self.support_forces(&at, state);
        let mut residual = at.residual.clone();
        at.single.iter().for_each(|held| residual[held.constraint.terms[0].0 as usize] = 0.0);
        let mut constraint_forces = vec![0.0; self.constraints.len()];
        for (held, reaction) in at.coupled.iter().zip(&state.reactions) {
            if let Holder::Constraint(k) = held.by {
                constraint_forces[k] = -reaction;
            }
        }
        let most = at.sizes[..count].iter().fold(f64::MIN_POSITIVE, |m, s| m.max(*s));
        // Where no force acts what is left is the rounding of the positions.
        let most = most.max(1e10 * rounding);
        let imbalance = residual[..count].iter().fold(0.0f64, |m, r| m.max(r.abs())) / most;
        let sites = (0..self.contacts.len()).map(|k| self.sites(k, state)).collect::<Result<Vec<_>, _>>()?;
        let dissipated = sites.iter().map(|list| list.iter().map(SiteResult::dissipated).sum()).collect();
        let dissipated_in_bodies = self.bodies.iter().zip(&state.bodies).map(|(b, s)| b.dissipated(s)).collect();
        let unstable_materials = self.bodies.iter().zip(&state.bodies).map(|(b, s)| b.unstable_material(s)).collect();
        Ok(IncrementResult {
            iterations,
            history,
            sites,
            support_forces,
            constraint_forces,
            energy: at.energy,
            dissipated,
            dissipated_in_bodies,
            unstable_materials,
            unknowns: at.residual.len(),
            imbalance,
            lost_sites: at.lost,
            solved: Solved::default(),
            ..IncrementResult::default()
        })
    }
}
