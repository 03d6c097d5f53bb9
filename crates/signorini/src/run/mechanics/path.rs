//! Increments of a system along a path of equilibria, by its arc length.

use super::{Failure, MechanicsModel, recovered, tell_iteration};
use crate::plan::history::ArcLengthIncrement;
use crate::problem::CaseError;
use crate::report::Reason;
use serde::{Deserialize, Serialize};
use signorini_mechanics::{IncrementError, IncrementResult, Path, PathIncrement};
use signorini_solve::Progress;

/// Halvings of an increment before the path is given up.
const MOST_HALVINGS: usize = 10;
/// Part of the duration of a step within which its end is reached.
const REACHED: f64 = 1e-9;

/// Where a path stands.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct OnPath {
    /// The step that it belongs to.
    step: Option<usize>,
    /// Direction and scales; none before the first increment.
    direction: Vec<f64>,
    scales: [f64; 2],
    length: f64,
    /// Whether the step has come to its end.
    is_done: bool,
}

impl MechanicsModel {
    /// Solves an increment along a path, which is shortened where it has no solution at once; none where the step has come to its
    /// end before. Where bodies are loaded from the start the first state is that at the start.
    pub(super) fn follow(
        &mut self,
        index: usize,
        planned: ArcLengthIncrement,
        progress: &mut dyn Progress,
    ) -> Result<Option<Result<IncrementResult, Failure>>, CaseError> {
        if self.path.step != Some(planned.step) {
            self.path = OnPath { step: Some(planned.step), length: planned.length, ..OnPath::default() };
        }
        if self.path.is_done {
            return Ok(None);
        }
        // A path begins at an equilibrium.
        if index == 0 && !self.rests {
            let time = planned.range[0];
            return self.reach(index, [time, time], progress).map(Some);
        }
        let mut residuals = Vec::new();
        let mut failed = None;
        for _ in 0..=MOST_HALVINGS {
            let OnPath { direction, scales, length, .. } = self.path.clone();
            let increment = PathIncrement { path: Path { direction, scales }, length, range: planned.range };
            let time = self.state.time;
            let mut report = |iteration: usize, residual: f64| {
                tell_iteration(progress, index, time, (iteration, residual));
                residuals.push(residual);
                !progress.interrupted()
            };
            let found = self.plan.system.solve_along(&self.state, &increment, &mut report);
            if let Some(error) = self.plan.wrong.take(&self.plan.head.problem) {
                return Err(error);
            }
            match found {
                Ok((state, result, path)) => {
                    let [from, to] = planned.range;
                    self.state = state;
                    self.path.is_done = (self.state.time - to).abs() <= REACHED * (to - from);
                    if self.path.is_done {
                        self.state.time = to;
                    }
                    (self.path.direction, self.path.scales) = (path.direction, path.scales);
                    self.path.length = (2.0 * self.path.length).min(planned.length);
                    let mut result = IncrementResult { iterations: residuals.len(), history: residuals, ..result };
                    recovered::recover_at_nodes(&self.plan, &mut result);
                    return Ok(Some(Ok(result)));
                }
                Err(IncrementError::Interrupted) => {
                    return Ok(Some(Err(self.failed(&IncrementError::Interrupted, residuals))));
                }
                Err(error) => {
                    self.path.length *= 0.5;
                    failed = Some(error);
                }
            }
        }
        let error = failed.unwrap_or(IncrementError::Interrupted);
        let Failure { text, residuals, .. } = self.failed(&error, residuals);
        let text = format!("the path was lost after t = {}: {text}", self.state.time);
        Ok(Some(Err(Failure { reason: Reason::PathLost, text, residuals })))
    }
}
