//! From an unstable equilibrium to a stable one at the same loads, and where stability was lost.
//!
//! The state is disturbed along the direction in which its energy falls and follows from there: implicit steps of an overdamped
//! motion `S u' = -∂E/∂u` (pseudo-time; the proximal point method, Rockafellar 1976), along which the energy never rises, so
//! that it ends where it has a minimum. A step about as long as the time in which the disturbance grows makes it grow by a
//! factor of two.

use crate::equilibrium::Problem;
use crate::increment::{IncrementResult, Strategy};
use crate::increment_error::IncrementError;
use crate::linear_solver::Solved;
use crate::points::Order;
use crate::stability::{NEUTRAL, Stability, StabilityTest, Unstable, UnstableMode};
use crate::system::{System, SystemState};
use signorini_solve::newton::Converged;

/// Disturbance, relative to the size of the bodies or in radians.
const DISTURBANCE: f64 = 1e-3;
/// Springs of the first steps, in the eigenvalue of the disturbance; what is left of them after a step that slows down, and
/// what they grow to after one that fails.
const SPRINGS: f64 = 2.0;
const WEAKER: f64 = 0.25;
const STIFFER: f64 = 4.0;
const MOST_STEPS: usize = 100;
/// Unstable states that are left one after the other.
const MOST_BRANCHES: usize = 8;
/// Part of an increment to which the loss of stability is located, and the most states on the way.
const LOCATED: f64 = 1e-5;
const MOST_LOCATING: usize = 40;
/// Steps of false position to the same side after which the interval is halved.
const MOST_REPEATED: usize = 2;
/// Part of the largest force out of balance on the way at which Newton's method takes over.
const AT_REST: f64 = 0.1;
/// Part of the disturbance within which a state has come back.
const BACK: f64 = 0.5;
/// Eigenvalues that errors of the discretisation may make of a motion that nothing holds, as the turning of a round beam about
/// itself; the most iterations of Newton's method to another state of such a motion, and what of its energy is rounding.
const HARDLY_ANY: f64 = 1e-7;
const AT_ONCE: usize = 8;
const SAME: f64 = 1e-9;

impl System {
    /// The same state where it is stable; where it is not, what [`System::unstable`] asks for.
    ///
    /// # Errors
    /// No stable state.
    pub(crate) fn on_a_stable_branch(
        &mut self,
        (mut state, mut result): (SystemState, IncrementResult),
        time: f64,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(SystemState, IncrementResult), IncrementError> {
        if !self.may_be_unstable(&state)? {
            return Ok((state, result));
        }
        let mut told = Stability::default();
        let mut count = result.iterations;
        let report = &mut |_: usize, residual: f64| {
            count += 1;
            report(count, residual)
        };
        let mut neutral = NEUTRAL;
        loop {
            let mode = match self.test_stability(&state, time, neutral)? {
                StabilityTest::Unknown if told.followed == 0 => return Ok((state, result)),
                StabilityTest::Unknown | StabilityTest::Stable => break,
                StabilityTest::Unstable(mode) => mode,
            };
            if mode.value > -HARDLY_ANY && self.is_neutral(&mode, (&state, result.energy), time, report)? {
                neutral = -mode.value;
                continue;
            }
            neutral = NEUTRAL;
            let (body, direction) = self.most_moved(&mode.direction);
            if told.body.is_none() {
                (told.body, told.direction) = (Some(body), direction);
            }
            told.negative_eigenvalues = mode.negative;
            if self.unstable == Unstable::Tell {
                break;
            }
            let unstable = || IncrementError::Unstable {
                body: self.bodies[body].name().to_string(),
                negative_eigenvalues: mode.negative,
            };
            if told.followed == MOST_BRANCHES {
                return Err(unstable());
            }
            let mut solved = result.solved;
            let mut next = None;
            for sign in [1.0, -1.0] {
                match self.by(Strategy::Along(&mode, sign), &state, time, &mut solved, report) {
                    Ok(found) => next = Some(found.state),
                    Err(IncrementError::Interrupted) => return Err(IncrementError::Interrupted),
                    Err(_) => continue,
                }
                break;
            }
            let next = next.ok_or_else(unstable)?;
            // What friction holds comes back.
            let apart = self.apart(&state, &next);
            if apart < BACK * DISTURBANCE {
                told.negative_eigenvalues = 0;
                if told.followed == 0 {
                    told = Stability::default();
                }
                break;
            }
            (state, result) = self.outer(&next, time, report)?;
            told.followed += 1;
            told.negative_eigenvalues = 0;
        }
        result.iterations = count;
        result.stability = Some(told);
        Ok((state, result))
    }

    /// Whether Newton's method finds a state of the same energy at once beside another, along a mode.
    fn is_neutral(
        &mut self,
        mode: &UnstableMode,
        (state, energy): (&SystemState, f64),
        time: f64,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<bool, IncrementError> {
        let Ok(found) = self.by(Strategy::Beside(mode), state, time, &mut Solved::default(), report) else {
            return Ok(false);
        };
        let there = self.assemble(&found.state, time, Order::First)?.energy;
        // How far along the mode, whatever else is free to move: a column comes back, but may turn about itself.
        let along = |v: &dyn Fn(usize) -> f64| -> f64 {
            mode.metric.iter().zip(&mode.direction).enumerate().map(|(k, (m, d))| m * d * v(k)).sum()
        };
        let moved = along(&|k| found.state.travel[k] - state.travel[k]);
        let stays = moved / along(&|k| mode.direction[k]) / self.disturbance(mode);
        Ok(stays > BACK && (there - energy).abs() <= SAME * energy.abs())
    }

    /// The size of a disturbance along a mode.
    fn disturbance(&self, mode: &UnstableMode) -> f64 {
        let extents = self.extents();
        DISTURBANCE / mode.direction.iter().zip(&extents).map(|(v, size)| v.abs() / size).fold(0.0f64, f64::max)
    }

    /// Enters when stability was lost in an increment to a time, if it was.
    pub(crate) fn locate_instability(
        &mut self,
        from: &SystemState,
        (time, kept): (f64, &[[Vec<f64>; 2]]),
        result: &mut IncrementResult,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(), IncrementError> {
        if let Some(told) = result.stability.as_mut().filter(|told| told.body.is_some()) {
            let found = self.histories();
            told.critical_time = self.critical_time(from, time, kept, report)?;
            self.put_back(&found);
            self.contacts.iter_mut().for_each(|c| c.begin_increment(time));
            self.end();
        }
        Ok(())
    }

    /// When stability was lost between a stable state and a time at which it is lost: where the critical eigenvalue vanishes, by
    /// the rule of false position (Illinois). `kept` are the histories of the contacts in the first state.
    ///
    /// # Errors
    /// Interruption. Without a state on the way the time is the nearest that is known.
    pub(crate) fn critical_time(
        &mut self,
        from: &SystemState,
        time: f64,
        kept: &[[Vec<f64>; 2]],
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Option<f64>, IncrementError> {
        // The last state that was unstable: from it Newton's method goes on along the branch that loses its stability.
        let mut beyond: Option<SystemState> = None;
        let mut eigenvalue_at = |system: &mut Self, at: f64| {
            system.put_back(kept);
            // By Newton's method alone: other ways lead to other branches.
            let mut solved = Solved::default();
            let found = system.begin(from, at).and_then(|mut start| {
                if let Some(beyond) = &beyond {
                    start = SystemState { time: at, predictions: start.predictions, ..beyond.clone() };
                    system.bodies.iter().zip(&mut start.bodies).for_each(|(body, state)| body.prescribe(at, state));
                }
                let found = system.by(Strategy::Straight, &start, at, &mut solved, report)?;
                if system.contacts.is_empty() { Ok(found.state) } else { Ok(system.outer(&found.state, at, report)?.0) }
            });
            let value = found.and_then(|state| {
                let value = system.critical_eigenvalue(&state, at)?;
                if value.is_some_and(|v| v < 0.0) {
                    beyond = Some(state);
                }
                Ok(value)
            });
            system.end();
            value
        };
        // At the last time itself, on the branch that was left.
        let mut ends = [(from.time, 0.0), (time, 0.0)];
        for end in &mut ends {
            match eigenvalue_at(self, end.0) {
                Ok(Some(value)) => end.1 = value,
                Err(IncrementError::Interrupted) => return Err(IncrementError::Interrupted),
                _ => return Ok(None),
            }
        }
        let [mut low, mut high] = ends;
        if low.1 <= 0.0 || high.1 >= 0.0 {
            return Ok(None);
        }
        let whole = high.0 - low.0;
        let (mut last, mut repeated) = (f64::NAN, 0);
        for _ in 0..MOST_LOCATING {
            // The stable eigenvalue may be another one: then the secant hardly moves.
            let next = if repeated < MOST_REPEATED {
                (low.0 * high.1 - high.0 * low.1) / (high.1 - low.1)
            } else {
                0.5 * (low.0 + high.0)
            };
            if (next - last).abs() <= LOCATED * whole {
                return Ok(Some(next));
            }
            let is_stable = match eigenvalue_at(self, next) {
                Ok(Some(value)) => {
                    let is_stable = value > 0.0;
                    *(if is_stable { &mut low } else { &mut high }) = (next, value);
                    is_stable
                }
                Err(IncrementError::Interrupted) => return Err(IncrementError::Interrupted),
                // Where no state is found the branch that is stable has ended.
                _ => {
                    high.0 = next;
                    false
                }
            };
            repeated = if is_stable == (last < next) { repeated + 1 } else { 0 };
            if repeated > 0 {
                *(if is_stable { &mut high.1 } else { &mut low.1 }) *= 0.5;
            }
            last = next;
        }
        Ok(Some(0.5 * (low.0 + high.0)))
    }

    /// The largest motion between two states, relative to the size of the bodies or in radians.
    fn apart(&self, from: &SystemState, to: &SystemState) -> f64 {
        let sizes = self.extents();
        let moved = from.travel.iter().zip(&to.travel).zip(&sizes).map(|((a, b), size)| (b - a).abs() / size);
        moved.fold(0.0, f64::max)
    }

    /// A state a little beside another, along a direction or against it, as far as nothing is in the way.
    fn disturbed(&self, from: &SystemState, mode: &UnstableMode, sign: f64) -> SystemState {
        let size = sign * self.disturbance(mode);
        let mut step = vec![0.0; from.travel.len() + from.multipliers.len() + from.reactions.len()];
        step.iter_mut().zip(&mode.direction).for_each(|(s, v)| *s = size * v);
        let share = self.free_way(from, &self.advance(from, &step, 1.0)).unwrap_or(1.0);
        self.advance(from, &step, share)
    }

    /// What each unknown is measured by: the size of the bodies, or a radian.
    pub(crate) fn extents(&self) -> Vec<f64> {
        let size = self.size();
        self.is_spin().into_iter().map(|turns| if turns { 1.0 } else { size }).collect()
    }

    /// The body that moves most, and how: its unknowns, the largest of size 1.
    pub(crate) fn most_moved(&self, direction: &[f64]) -> (usize, Vec<f64>) {
        let (first, _) = self.numbering();
        let sizes = self.extents();
        let most = |range: &std::ops::Range<usize>| {
            range.clone().map(|k| direction[k].abs() / sizes[k]).fold(0.0f64, f64::max)
        };
        let range = |k: usize| first[k] as usize..first[k] as usize + self.bodies[k].unknowns();
        let body = (0..self.bodies.len()).max_by(|a, b| most(&range(*a)).total_cmp(&most(&range(*b)))).unwrap_or(0);
        let own = &direction[range(body)];
        let largest = own.iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
        (body, own.iter().map(|v| v / largest).collect())
    }
}

impl Problem<'_> {
    /// The state that Newton's method finds at once from beside another.
    pub(crate) fn beside(
        &mut self,
        mode: &UnstableMode,
        start: &SystemState,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let state = self.system.disturbed(start, mode, 1.0);
        self.solve(&state, &mut |iteration, residual| report(iteration, residual) && iteration < AT_ONCE)
    }

    /// Leaves an unstable state along a direction, and follows what moves until it is at rest.
    pub(crate) fn along(
        &mut self,
        mode: &UnstableMode,
        sign: f64,
        start: &SystemState,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let system = self.system;
        let mut state = system.disturbed(start, mode, sign);
        let mut total = state.travel.clone();
        self.metric.clone_from(&mode.metric);
        let norm = |travel: &[f64]| travel.iter().zip(&mode.metric).map(|(t, m)| m * t * t).sum::<f64>().sqrt();
        let mut springs = SPRINGS * mode.value.abs();
        let (mut before, mut most) = (0.0, 0.0f64);
        let mut is_back = false;
        for _ in 0..MOST_STEPS {
            match self.held_step(springs, &state, report) {
                Ok(found) => {
                    let moved = norm(&found.state.travel) * springs;
                    total.iter_mut().zip(&found.state.travel).for_each(|(t, s)| *t += s);
                    state = found.state;
                    // The force of the springs is what is out of balance: it rises as the state falls, then it fades.
                    most = most.max(moved);
                    if moved < before {
                        springs *= WEAKER;
                    }
                    before = moved;
                    if moved > AT_REST * most {
                        continue;
                    }
                    let rest = SystemState { travel: total.clone(), ..state.clone() };
                    if let Ok(found) = self.solve(&rest, report) {
                        // Newton's method may lead back to where the energy is not least.
                        let was_back = is_back;
                        is_back = system.apart(start, &found.state) < BACK * DISTURBANCE;
                        if !is_back || was_back || system.apart(start, &rest) < BACK * DISTURBANCE {
                            return Ok(found);
                        }
                    }
                }
                Err(IncrementError::Interrupted) => return Err(IncrementError::Interrupted),
                Err(_) => springs *= STIFFER,
            }
        }
        Err(IncrementError::NotConverged { history: vec![f64::INFINITY], worst: None })
    }
}
