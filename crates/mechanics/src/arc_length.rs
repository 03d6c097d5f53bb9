//! Increments along a path of equilibria on which the time is an unknown: it passes the folds at which a path in time ends.
//!
//! Unknowns and time are measured by their scales: the time by the duration of the step, displacements and rotations by what they
//! would change by over the step if they went on as it begins. In each increment the one that changes most along the tangent of
//! the path is prescribed, and all others, the time among them, are found by Newton's method (local parametrisation: Rheinboldt &
//! Burkardt 1983, A locally parameterized continuation process, ACM Trans. Math. Software 9). At a fold in time that is an
//! unknown of the bodies, where the path is steep it is the time.
//!
//! With the residual `R(u, t)` and the prescribed component `m` of `z = (u, t)`, a step solves
//!
//! ```text
//! | K    ∂R/∂t | | δu |     | R           |
//! |   e_m      | | δt | = - | z_m - z_m^* |
//! ```
//!
//! which is regular at a fold, where `K` is singular. `∂R/∂t`, of loads, supports and prescribed motions, is a difference quotient.

use crate::equilibrium::{Problem, ROUNDING};
use crate::increment::{AUGMENTED, IncrementResult, MOST_AUGMENTATIONS, UNBALANCED, is_curable};
use crate::increment_error::IncrementError;
use crate::linear_solver::{Solved, Stiffness};
use crate::points::Order;
use crate::system::{System, SystemState};
use crate::unstable::Unstable;
use signorini_solve::general::Matrix;
use signorini_solve::newton::{Converged, Equations, Measured, Newton, newton};

/// Where a path stands.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Path {
    /// Change of the unknowns of the bodies and, last, of the time since the state before; empty at the start of a path, which
    /// goes towards the end of its step.
    pub direction: Vec<f64>,
    /// Scales of displacements and of rotations.
    pub scales: [f64; 2],
}

/// An increment along a path.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PathIncrement {
    pub path: Path,
    /// Change of the component that changes most, in its scale.
    pub length: f64,
    /// Beginning and end of the step; its duration is the scale of time.
    pub range: [f64; 2],
}

/// Part of the duration of a step by which the time is changed for the derivative of the residual.
const DIFFERENCE: f64 = 1e-6;

/// Part of the length of an increment by which a component may miss what the tangent predicts: beyond it the path bends too much
/// for its increments, or the state is one of another path.
const NEAR: f64 = 0.5;
/// Iterations from one state on a path to the next, which is near: beyond a fold there is none to be sought.
const MOST_ITERATIONS: usize = 20;

/// The component that is prescribed: an unknown of the bodies, or the time, which has the next number.
#[derive(Clone, Copy, Debug)]
struct Prescribed {
    component: usize,
    /// Change of the unknown since the last state, or the time.
    value: f64,
}

/// What is next on a path.
struct Prediction {
    /// The component that changes most; the unknown of the bodies that does, if it is the time.
    by_largest: Prescribed,
    by_unknown: Option<Prescribed>,
    /// Change of all components, in their scales.
    change: Vec<f64>,
}

impl PathIncrement {
    fn duration(&self) -> f64 {
        (self.range[1] - self.range[0]).abs()
    }
}

impl System {
    /// Solves for the next state on a path, from a state that was accepted: with its time, and the direction in which the path
    /// goes on. The last increment of a step ends at its end. States are what they are, stable or not.
    ///
    /// # Errors
    /// Why there is no such state.
    pub fn solve_along(
        &mut self,
        from: &SystemState,
        along: &PathIncrement,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(SystemState, IncrementResult, Path), IncrementError> {
        let kept = self.histories();
        let start = self.begin(from, from.time)?;
        let mut along = along.clone();
        if along.path.direction.is_empty() {
            along.path.scales = self.first_scales(&start, &along)?;
        }
        let stated = std::mem::replace(&mut self.unstable, Unstable::Tell);
        let mut done = 0;
        let mut counted = |_: usize, residual: f64| {
            done += 1;
            report(done, residual)
        };
        let found = self
            .next_on_path(&start, &along, &mut counted)
            .and_then(|found| self.check_inside(&found.0, false).map(|()| found))
            .and_then(|(state, result)| {
                let time = state.time;
                self.on_a_stable_branch((state, result), time, &mut counted)
            });
        self.unstable = stated;
        self.end();
        match found {
            Ok((state, result)) => {
                let direction = state.travel.iter().copied().chain([state.time - from.time]).collect();
                let path = Path { direction, scales: along.path.scales };
                Ok((state, IncrementResult { iterations: done, ..result }, path))
            }
            Err(error) => {
                self.put_back(&kept);
                Err(error)
            }
        }
    }

    fn next_on_path(
        &mut self,
        start: &SystemState,
        along: &PathIncrement,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(SystemState, IncrementResult), IncrementError> {
        let mut state = start.clone();
        let mut changes = Vec::new();
        let prediction = self.prediction(start, along)?;
        let mut prescribed = prediction.by_largest;
        let mut first = self.near(start, along, (&prediction, prescribed), report);
        // Before a fold the time changes most, but not by as much.
        if let (Err(error), Some(other)) = (&first, prediction.by_unknown)
            && is_curable(error)
        {
            prescribed = other;
            first = self.near(start, along, (&prediction, other), report);
        }
        let mut first = Some(first?);
        for _ in 0..MOST_AUGMENTATIONS {
            let found = match first.take() {
                Some(found) => found,
                None => self.on_path(&state, along, prescribed, report)?,
            };
            let is_settled = found.history.len() == 1;
            state = found.state;
            let (to, count) = (along.range[1], state.travel.len());
            if prescribed.component != count && (state.time - to) * (start.time - to) < 0.0 {
                prescribed = Prescribed { component: count, value: to };
                continue;
            }
            // What laws are at a time is known now.
            let time = state.time;
            self.contacts.iter_mut().for_each(|contact| contact.begin_increment(time));
            let rounding = self.rounding(&state, time)?;
            let result = self.result(&state, time, 0, (found.history, rounding))?;
            if result.imbalance.is_nan() || result.imbalance > UNBALANCED {
                return Err(IncrementError::NotConverged { history: result.history, worst: None });
            }
            let change = self.augment(&state, &result, changes.last().copied())?;
            if change <= AUGMENTED && is_settled {
                return Ok((state, result));
            }
            changes.push(change);
        }
        Err(IncrementError::Augmentation { outer: MOST_AUGMENTATIONS, history: changes })
    }

    /// What each unknown of the bodies and the time are measured by.
    fn scales_of(&self, along: &PathIncrement) -> Vec<f64> {
        let [moves, turns] = along.path.scales;
        let of = |is_spin: bool| if is_spin { turns } else { moves };
        self.is_spin().into_iter().map(of).chain([along.duration()]).collect()
    }

    /// What displacements and rotations would change by over a step if they, and what moves as prescribed, went on as it begins.
    fn first_scales(&self, start: &SystemState, along: &PathIncrement) -> Result<[f64; 2], IncrementError> {
        let is_spin = self.is_spin();
        let mut scales = [self.size(), 1.0];
        let mut path = OnPath::new(self, start, along, Prescribed { component: is_spin.len(), value: start.time })?;
        let rate = path.tangent(start, is_spin.len())?;
        let ends = along.range.map(|time| path.at_time(start, time).bodies);
        let prescribed = self.bodies.iter().enumerate().filter(|(_, body)| body.is_rigid()).map(|(k, _)| {
            let [from, to] = ends.each_ref().map(|bodies| &bodies[k].configuration[..3]);
            from.iter().zip(to).map(|(a, b)| (b - a).abs()).fold(0.0, f64::max)
        });
        for (turns, scale) in [false, true].into_iter().zip(&mut scales) {
            let own = rate.iter().zip(&is_spin).filter(|(_, is_spin)| **is_spin == turns);
            let most = own.map(|(z, _)| (z * along.duration()).abs()).fold(0.0, f64::max);
            let most = if turns { most } else { prescribed.clone().fold(most, f64::max) };
            if most > 0.0 && most < *scale {
                *scale = most;
            }
        }
        Ok(scales)
    }

    /// What is next along the tangent of the path.
    fn prediction(&self, start: &SystemState, along: &PathIncrement) -> Result<Prediction, IncrementError> {
        let scales = self.scales_of(along);
        let count = scales.len() - 1;
        let scaled = |z: &[f64], scales: &[f64]| z.iter().zip(scales).map(|(z, scale)| z / scale).collect::<Vec<f64>>();
        let most = |of: &[f64]| (0..of.len()).max_by(|a, b| of[*a].abs().total_cmp(&of[*b].abs())).unwrap_or(count);
        let mut before = vec![0.0; scales.len()];
        before[count] = along.range[1] - along.range[0];
        if along.path.direction.len() == scales.len() {
            before.clone_from(&along.path.direction);
        }
        let before = scaled(&before, &scales);
        let none = Prescribed { component: count, value: start.time };
        // Along the component that changed most the tangent is known well; then which way it points.
        let tangent = OnPath::new(self, start, along, none)?.tangent(start, most(&before))?;
        let time = tangent[tangent.len() - 1];
        let mut change = scaled(&[&tangent[..count], &[time]].concat(), &scales);
        let turns: f64 = change.iter().zip(&before).map(|(a, b)| a * b).sum();
        let [largest, unknown] = [most(&change), most(&change[..count])];
        let share = along.length / change[largest].abs() * turns.signum();
        change.iter_mut().for_each(|c| *c *= share);
        let end = along.range[1];
        // The step ends where it ends.
        let ahead = start.time + change[count] * scales[count];
        let time = if (ahead - end) * (start.time - end) < 0.0 { end } else { ahead };
        let of = |component: usize| Prescribed {
            component,
            value: if component == count { time } else { change[component] * scales[component] },
        };
        let by_unknown = (largest == count && unknown != count).then(|| of(unknown));
        Ok(Prediction { by_largest: of(largest), by_unknown, change })
    }

    /// A state on the path that is about where it was predicted.
    fn near(
        &self,
        start: &SystemState,
        along: &PathIncrement,
        (prediction, prescribed): (&Prediction, Prescribed),
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let found = self.on_path(start, along, prescribed, report)?;
        let scales = self.scales_of(along);
        let changes = found.state.travel.iter().copied().chain([found.state.time - start.time]).zip(&scales);
        let missed = changes.zip(&prediction.change).map(|((c, scale), predicted)| (c / scale - predicted).abs());
        if missed.fold(0.0, f64::max) > NEAR * along.length {
            return Err(IncrementError::NotConverged { history: found.history, worst: None });
        }
        Ok(found)
    }

    /// The state on the path at which a component has its value.
    fn on_path(
        &self,
        start: &SystemState,
        along: &PathIncrement,
        prescribed: Prescribed,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let mut own = OnPath::new(self, start, along, prescribed)?;
        own.problem.begin(start)?;
        let search = Newton { most_iterations: MOST_ITERATIONS, ..own.problem.search(start) };
        let found = newton(&mut own, start, &search, report);
        own.problem.converged(found)
    }
}

/// The equations of a system with the time as an unknown and one component prescribed.
struct OnPath<'a> {
    problem: Problem<'a>,
    prescribed: Prescribed,
    /// Scales of the prescribed component and of the time.
    scale: f64,
    duration: f64,
}

impl<'a> OnPath<'a> {
    fn new(
        system: &'a System,
        start: &SystemState,
        along: &PathIncrement,
        prescribed: Prescribed,
    ) -> Result<Self, IncrementError> {
        let mut problem = system.problem(start, start.time, Solved::default())?;
        (problem.stiffness, problem.symbolic) = (Stiffness::InTangent, None);
        let scale = system.scales_of(along)[prescribed.component];
        Ok(OnPath { problem, prescribed, scale, duration: along.duration() })
    }

    /// What the prescribed component lacks.
    fn lacks(&self, at: &SystemState) -> f64 {
        let now = at.travel.get(self.prescribed.component).copied().unwrap_or(at.time);
        self.prescribed.value - now
    }

    /// The state with the time moved, and with it what moves as prescribed.
    fn at_time(&self, at: &SystemState, time: f64) -> SystemState {
        let mut state = SystemState { time, ..at.clone() };
        let system = self.problem.system;
        system.bodies.iter().zip(&mut state.bodies).for_each(|(body, own)| body.prescribe(time, own));
        state
    }

    /// Residual at another time, and what the supports of single unknowns lack there, by their unknown.
    fn residual_at(&mut self, at: &SystemState, time: f64) -> Result<(Vec<f64>, Vec<(usize, f64)>), IncrementError> {
        let state = self.at_time(at, time);
        self.problem.time = time;
        let out = self.problem.assemble(&state, Order::First)?;
        let lacks = out.single.iter().map(|h| {
            let (unknown, factor) = h.constraint.terms[0];
            (unknown as usize, h.constraint.violation / factor)
        });
        let lacks = lacks.collect();
        Ok((out.residual, lacks))
    }

    /// The direction of the path at a state, by the change of a component.
    fn tangent(&mut self, at: &SystemState, component: usize) -> Result<Vec<f64>, IncrementError> {
        let (matrix, mut right) = self.bordered(at, component)?;
        right.fill(0.0);
        right.push(1.0);
        Ok(self.problem.analysis.factor(matrix)?.solve(&right)?)
    }

    /// The matrix of Newton's method bordered by the derivative in time and the row of a component; the
    /// right-hand side without that of the row.
    fn bordered(&mut self, at: &SystemState, component: usize) -> Result<(Matrix, Vec<f64>), IncrementError> {
        let h = DIFFERENCE * self.duration;
        let [before, after] = [-h, h].map(|h| self.residual_at(at, at.time + h));
        let (before, after) = (before?, after?);
        self.problem.time = at.time;
        let mut out = self.problem.assemble(at, Order::Second)?;
        let n = out.residual.len();
        let count = self.problem.is_spin.len();
        let mut right: Vec<f64> = out.residual.iter().map(|r| -r).collect();
        let rate = |a: f64, b: f64| (b - a) / (2.0 * h);
        let mut by_time: Vec<f64> = before.0.iter().zip(&after.0).map(|(a, b)| rate(*a, *b)).collect();
        by_time.resize(n, 0.0);
        let mut held = vec![false; n];
        for h in &out.single {
            let (unknown, factor) = h.constraint.terms[0];
            let k = unknown as usize;
            held[k] = true;
            right[k] = -h.constraint.violation / factor;
            by_time[k] = 0.0;
        }
        // The same supports hold in the same order, but where one begins or ends just now.
        for ((k, a), (other, b)) in before.1.iter().zip(&after.1) {
            if k == other && held[*k] {
                by_time[*k] = rate(*a, *b);
            }
        }
        if self.problem.is_free {
            let sizes = self.problem.system.row_sizes(&out, Stiffness::InTangent);
            self.problem.add_grain(&mut out, &held, &sizes);
        }
        out.tangent.hold(&held);
        let time = n as u32;
        by_time.iter().enumerate().filter(|(_, v)| **v != 0.0).for_each(|(k, v)| out.tangent.add(k as u32, time, *v));
        out.tangent.add(time, if component == count { time } else { component as u32 }, 1.0);
        Ok((out.tangent.matrix(n + 1), right))
    }
}

impl Equations for OnPath<'_> {
    type State = SystemState;
    type Error = IncrementError;

    fn measure(&mut self, at: &SystemState) -> Result<Measured, IncrementError> {
        self.problem.time = at.time;
        let found = self.problem.measure(at)?;
        let lacks = self.lacks(at).abs() / (ROUNDING * self.scale);
        Ok(Measured { error: found.error.max(lacks), ..found })
    }

    fn step(&mut self, at: &SystemState) -> Result<Vec<f64>, IncrementError> {
        let (matrix, mut right) = self.bordered(at, self.prescribed.component)?;
        right.push(self.lacks(at));
        Ok(self.problem.analysis.factor(matrix)?.solve(&right)?)
    }

    fn is_driven(&self, at: &SystemState) -> bool {
        self.lacks(at).abs() > ROUNDING * self.scale
    }

    fn farthest(&self, at: &SystemState, step: &[f64]) -> f64 {
        // Where bodies cannot be touched the residual tells.
        self.problem.system.free_way(at, &self.advance(at, step, 1.0)).unwrap_or(1.0)
    }

    fn advance(&self, at: &SystemState, step: &[f64], share: f64) -> SystemState {
        let (time, own) = step.split_last().expect("the time is an unknown");
        let state = self.problem.system.advance(at, own, share);
        self.at_time(&state, at.time + share * time)
    }
}
