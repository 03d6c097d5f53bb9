//! From one state of rest to the next.

use super::motion::{FIRST, LONGEST, Motion, SHORTEST, Stepped};
use super::polyhedra::free_share;
use super::stability::Leaving;
use super::touching::{Id, along, twists};
use crate::body::BodyState;
use crate::equilibrium::carried_away;
use crate::free::{AWAY, motion_in_words};
use crate::increment_error::IncrementError;
use crate::stability::{Stability, Unstable};
use crate::system::{AssemblyError, SystemState};
use signorini_geometry::Vector;
use std::collections::BTreeMap;

/// The force that still moves bodies, relative to the loads, with which they rest.
const RESTS: f64 = 1e-12;
/// Steps on one leg of an increment.
const MOST_STEPS: usize = 2000;
/// Longer and shorter pseudo-times, and the part of the longest step below which they may be longer.
const LONGER: f64 = 4.0;
const SHORTER: f64 = 0.25;
const MUCH_SHORTER: f64 = 1e-3;
const SHORT: f64 = 0.3;
/// Halvings of a leg of prescribed motion, and the most legs.
const MOST_HALVINGS: usize = 10;
const MOST_LEGS: f64 = 1e5;
/// Step relative to the sizes by which an unstable state is left, and how often.
const DISTURBED: f64 = 1e-4;
const MOST_DISTURBANCES: usize = 12;

/// What a site has slipped in an increment, and the work of its friction.
#[derive(Clone, Copy, Debug, Default)]
pub struct Slipped {
    pub slip: Vector<3>,
    pub path: f64,
    pub work: f64,
}

/// What happened on the way.
#[derive(Default)]
pub struct SoFar {
    pub slipped: BTreeMap<(usize, usize), Slipped>,
    pub forces: BTreeMap<Id, [f64; 3]>,
    /// Steps of all unknowns that nothing prescribed.
    pub travel: Vec<f64>,
    pub iterations: usize,
    pub history: Vec<f64>,
    /// The states between which the bodies moved straight on, without the first and the last.
    pub way: Vec<Vec<BodyState>>,
    /// Unstable states that were met, and left.
    pub stability: Stability,
}

impl SoFar {
    /// What friction of a contact took.
    pub fn work(&self, contact: usize) -> f64 {
        self.slipped.iter().filter(|(id, _)| id.0 == contact).map(|(_, own)| own.work).sum()
    }
}

/// An increment on its way.
pub struct Increment<'a, 'b> {
    motion: &'b Motion<'a>,
    report: &'b mut dyn FnMut(usize, f64) -> bool,
    pub so_far: SoFar,
}

impl<'a, 'b> Increment<'a, 'b> {
    pub fn new(motion: &'b Motion<'a>, report: &'b mut dyn FnMut(usize, f64) -> bool) -> Self {
        let so_far = SoFar { travel: vec![0.0; motion.turns.len()], ..SoFar::default() };
        Increment { motion, report, so_far }
    }

    /// The state of rest at a time.
    pub fn solve(&mut self, from: &SystemState, time: f64) -> Result<(SystemState, Stepped<'a>), IncrementError> {
        let legs = self.legs(from, time)?;
        let mut state = from.clone();
        for k in 1..legs {
            let to = from.time + (time - from.time) * k as f64 / legs as f64;
            self.leg(&mut state, to, 0)?;
        }
        let found = self.leg(&mut state, time, 0)?;
        match self.carried_away(from, &state) {
            Some(error) => Err(error),
            None => Ok((state, found)),
        }
    }

    /// In how many legs prescribed motions and supports are followed.
    fn legs(&self, from: &SystemState, time: f64) -> Result<usize, IncrementError> {
        let mut way = 0.0f64;
        let mut state = from.clone();
        const SAMPLES: usize = 16;
        for k in 1..=SAMPLES {
            let at = from.time + (time - from.time) * k as f64 / SAMPLES as f64;
            let next = self.prescribed(&state, at);
            let moved = twists(self.motion.bodies_of(&state.bodies), &state, &next);
            let far = |t: &[Vector<3>; 2]| t[0].norm() / self.motion.size + t[1].norm();
            way += moved.iter().flatten().map(far).fold(0.0, f64::max);
            state = next;
        }
        let (single, coupled) = self.motion.system.held(&from.bodies, time)?;
        for held in single.iter().chain(&coupled) {
            let (unknown, factor) = held.constraint.terms[0];
            way = way.max(self.motion.relative(unknown as usize, held.constraint.violation / factor));
        }
        Ok((way / (0.25 * self.motion.farthest())).ceil().clamp(1.0, MOST_LEGS) as usize)
    }

    fn prescribed(&self, state: &SystemState, time: f64) -> SystemState {
        let mut out = state.clone();
        for (body, own) in self.motion.system.bodies.iter().zip(&mut out.bodies) {
            body.prescribe(time, own);
        }
        out.time = time;
        out
    }

    /// Follows what is prescribed to a time, and the bodies to rest.
    fn leg(&mut self, state: &mut SystemState, to: f64, depth: usize) -> Result<Stepped<'a>, IncrementError> {
        let target = self.prescribed(state, to);
        let moved = twists(self.motion.bodies_of(&state.bodies), state, &target);
        let still = twists(self.motion.bodies_of(&state.bodies), state, state);
        let mut drives = moved != still || self.motion.is_pulled(&state.bodies, to)?;
        if !drives {
            *state = target.clone();
        }
        let mut tau = LONGEST;
        for _ in 0..MOST_STEPS {
            if !drives && let Some(found) = self.motion.at_rest(&state.bodies, to)? {
                if !self.leave(state, &found, to)? {
                    return Ok(found);
                }
                tau = FIRST;
                continue;
            }
            let twists = if drives { &moved } else { &still };
            let found = self.motion.step(state, twists, (to, tau), &self.so_far.forces)?;
            let found = match found {
                Some(found) if self.passes(state, &found)? => None,
                found => found,
            };
            let Some(found) = found else {
                tau = if tau > FIRST { FIRST.max(MUCH_SHORTER * tau) } else { SHORTER * tau };
                // What is prescribed is followed without delay, in shorter legs.
                let halves = drives && tau <= FIRST && depth < MOST_HALVINGS;
                if !halves && tau >= SHORTEST {
                    continue;
                }
                if !halves {
                    return Err(self.lost());
                }
                let middle = 0.5 * (state.time + to);
                self.leg(state, middle, depth + 1)?;
                return self.leg(state, to, depth + 1);
            };
            self.take(state, &found, &target);
            if !drives {
                self.so_far.travel.iter_mut().zip(&found.step).for_each(|(t, s)| *t += s);
            }
            drives = false;
            let moving = self.motion.moving(&found.step, tau);
            self.so_far.history.push(moving / RESTS);
            if !(self.report)(self.so_far.iterations, moving / RESTS) {
                return Err(IncrementError::Interrupted);
            }
            if moving <= RESTS {
                if !self.leave(state, &found, to)? {
                    return Ok(found);
                }
                tau = FIRST;
                continue;
            }
            if let Some(error) = self.away(state) {
                return Err(error);
            }
            let far = self.motion.largest(&found.step);
            if far < SHORT * self.motion.farthest() {
                tau = (LONGER * tau).min(LONGEST);
            }
        }
        Err(self.lost())
    }

    /// A body so far away that rounding of its position spoils gaps by more than they are told to.
    fn carried_away(&self, from: &SystemState, state: &SystemState) -> Option<IncrementError> {
        let bodies = self.motion.system.bodies.iter().enumerate().filter(|(_, b)| b.unknowns() > 0);
        let away = bodies.map(|(k, b)| {
            let [a, c] = [from, state].map(|s| Vector::<3>::from_column_slice(&s.bodies[k].configuration[..3]));
            ((c - a).norm() / self.motion.size, b.name())
        });
        let (away, name) = away.max_by(|a, b| a.0.total_cmp(&b.0))?;
        let told = carried_away(name, away)?;
        Some(IncrementError::NotConverged { history: vec![f64::INFINITY], worst: Some(told) })
    }

    fn lost(&self) -> IncrementError {
        IncrementError::NotConverged { history: self.so_far.history.clone(), worst: None }
    }

    /// Whether something would pass through something else on a step.
    fn passes(&self, from: &SystemState, found: &Stepped<'_>) -> Result<bool, AssemblyError> {
        let to = SystemState { bodies: found.bodies.clone(), ..from.clone() };
        let between = [&from.bodies, &found.bodies].map(|states| self.motion.bodies_of(states));
        if free_share(&self.motion.contacts, between) < 1.0 {
            return Ok(true);
        }
        Ok(self.motion.system.first_passage(from, &to)?.is_some())
    }

    /// Takes a step.
    fn take(&mut self, state: &mut SystemState, found: &Stepped<'_>, target: &SystemState) {
        self.so_far.way.push(state.bodies.clone());
        state.bodies = found.bodies.clone();
        state.time = target.time;
        for (k, _) in self.motion.system.bodies.iter().enumerate().filter(|(_, b)| b.unknowns() == 0) {
            state.bodies[k] = target.bodies[k].clone();
        }
        self.so_far.iterations += found.iterations;
        self.so_far.forces = found.loaded.iter().map(|l| (l.point.id, l.force)).collect();
        for l in found.loaded.iter().filter(|l| l.force[0] > 0.0 && l.point.law.is_some()) {
            let own = self.so_far.slipped.entry((l.point.id.contact, l.point.id.site)).or_default();
            own.slip += l.slip;
            own.path += l.slip.norm();
            own.work += l.friction().dot(&l.slip);
        }
    }

    /// Whether a state is unstable, and was left for that.
    fn leave(&mut self, state: &mut SystemState, found: &Stepped<'_>, time: f64) -> Result<bool, IncrementError> {
        let told = &mut self.so_far.stability;
        told.negative_eigenvalues = 0;
        let Some(Leaving { negative, direction }) = self.motion.unstable(&state.bodies, found, time)? else {
            return Ok(false);
        };
        told.negative_eigenvalues = negative;
        let (body, own) = self.motion.system.most_moved(&direction);
        if told.body.is_none() {
            (told.body, told.direction) = (Some(body), own);
        }
        if self.motion.system.unstable == Unstable::Tell {
            return Ok(false);
        }
        if told.followed == MOST_DISTURBANCES {
            let body = self.motion.system.bodies[body].name().to_string();
            return Err(IncrementError::Unstable { body, negative_eigenvalues: negative });
        }
        told.followed += 1;
        let moved: Vec<f64> = direction.iter().map(|d| DISTURBED * d).collect();
        let at = self.motion.bodies_of(&state.bodies);
        state.bodies = along(at, state, (&moved, &twists(at, state, state)), 1.0);
        Ok(true)
    }

    /// A body that nothing holds.
    fn away(&self, state: &SystemState) -> Option<IncrementError> {
        let travel = &self.so_far.travel;
        let turn = std::f64::consts::TAU;
        let far = |k: &usize| {
            let size = if self.motion.turns[*k] { turn } else { self.motion.size / self.motion.extent[*k] };
            self.motion.relative(*k, travel[*k]) / size
        };
        let unknown = (0..travel.len()).max_by(|a, b| far(a).total_cmp(&far(b))).filter(|k| far(k) > AWAY)?;
        let bodies = &self.motion.system.bodies;
        let k =
            (0..bodies.len()).rev().find(|k| self.motion.first[*k] as usize <= unknown && bodies[*k].unknowns() > 0)?;
        let own = self.motion.first[k] as usize..self.motion.first[k] as usize + bodies[k].unknowns();
        let (step, turns) = (&travel[own.clone()], &self.motion.turns[own]);
        let motion = motion_in_words((bodies[k].as_ref(), &state.bodies[k]), (step, turns), self.motion.turns[unknown]);
        Some(IncrementError::Free { body: bodies[k].name().to_string(), motion })
    }
}
