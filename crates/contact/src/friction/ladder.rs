//! What is tried for a friction problem, one after the other: no choice of `c` in the semismooth Newton method ends in
//! every problem, each cycles where another does not.
//!
//! 0. `c_t = 1e-3/W_tt` in the plane, `0.1/W_tt` in space;
//! 1. `1/W_tt`;
//! 2. `1/W_tt` with a line search;
//! 3. from the state without friction, with all nodes slipping along what they then slide;
//! 4. a few problems with the friction of given pressures (of Tresca's kind), then Newton's method again;
//! 5. many of them.
//!
//! In the plane a slipping node whose friction has the wrong sign jumps to the opposite slip with `1/W_tt`, and its
//! neighbours make it jump back; with a small `c_t` it sticks first. In space a small `c_t` follows the curved edge of what
//! is admissible badly: of 52 states of spheres shifted to and fro and round, 19 take more than 20 solves with `1/W_tt`,
//! none more than 5 with `0.1/W_tt` and none more than 6 with `0.01/W_tt`; of 180 random compliances none, 3 and 18 do. A
//! set of states that comes again is no solution: only the natural residual tells.

use super::newton::{End, Outcome, Settings, newton};
use super::problem::{Friction, Problem, Residual, RowCompliance};
use crate::law::Projected;
use signorini_solve::SolveError;

/// Why no tractions were found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum FrictionError {
    #[error(transparent)]
    Solve(#[from] SolveError),
    /// Tractions that satisfy no equation: the contact found does not hold the bodies, or its rows depend on each other.
    #[error("the computed contact does not restrain the bodies")]
    Singular,
    /// The nodes whose answers differ most from their tractions.
    #[error("the stick and slip zones did not converge in {solves} solves")]
    NotFound { solves: usize, nodes: Vec<usize> },
    #[error("interrupted")]
    Interrupted,
}

/// Tractions that satisfy the law.
#[derive(Clone, Debug)]
pub struct Solution {
    pub z: Vec<f64>,
    /// Weighted gaps and slips.
    pub y: Vec<f64>,
    /// Of every node.
    pub answers: Vec<Projected>,
    /// Solves of the dense system.
    pub solves: usize,
    /// The step of the ladder that found it.
    pub level: usize,
}

/// Solves of one level.
const MOST_SOLVES: usize = 20;
const MOST_SOLVES_SEARCHING: usize = 40;
/// Problems of given pressures before Newton's method is tried again, and at most.
const FEW_LOOPS: usize = 12;
const MOST_LOOPS: usize = 200;

struct Ladder<'a, 'b> {
    problem: &'a Problem<'a>,
    w: &'b mut dyn RowCompliance,
    report: &'b mut dyn FnMut(usize, usize) -> bool,
    solves: usize,
}

impl Ladder<'_, '_> {
    fn newton(
        &mut self,
        friction: Friction<'_>,
        start: Vec<f64>,
        settings: &Settings,
    ) -> Result<Outcome, FrictionError> {
        let (solves, report) = (&mut self.solves, &mut self.report);
        let mut counted = |changed: usize| {
            *solves += 1;
            report(*solves, changed)
        };
        let found = newton(self.problem, self.w, friction, start, settings, &mut counted)?;
        if found.end == End::Interrupted { Err(FrictionError::Interrupted) } else { Ok(found) }
    }

    /// Problems in which the friction is that of the pressures before.
    fn given_pressures(&mut self, start: Vec<f64>, loops: usize) -> Result<Outcome, FrictionError> {
        let settings = [1.0, 1e-3].map(|factor| Settings { factor, most: MOST_SOLVES, line_search: false });
        let mut z = start;
        for _ in 0..loops {
            let pressures: Vec<f64> = self.problem.nodes.iter().map(|n| z[n.first].max(0.0)).collect();
            let mut found = self.newton(Friction::Fixed(&pressures), z.clone(), &settings[0])?;
            if found.end != End::Accepted {
                found = self.newton(Friction::Fixed(&pressures), z, &settings[1])?;
            }
            z = found.z;
            if !z.iter().all(|z| z.is_finite()) {
                break;
            }
            let whole = self.problem.residual(self.w, Friction::Law, (&z, &found.y), 1.0)?;
            if whole.relative <= super::newton::ACCEPTED {
                return Ok(Outcome { z, residual: whole, end: End::Accepted, y: found.y });
            }
        }
        let still = Settings { most: 0, ..settings[0] };
        self.newton(Friction::Law, z, &still)
    }

    /// The state without friction, with the friction of nodes that slip along what they slide in it.
    fn slipping(&mut self, start: Vec<f64>) -> Result<Vec<f64>, FrictionError> {
        let settings = Settings { factor: 1.0, most: MOST_SOLVES_SEARCHING, line_search: false };
        let mut pressed = start;
        for node in self.problem.nodes {
            node.rows().skip(1).for_each(|r| pressed[r] = 0.0);
        }
        let mut found = self.newton(Friction::None, pressed, &settings)?;
        for node in self.problem.nodes {
            let (Some(law), p) = (node.law, found.z[node.first]) else { continue };
            let mut slip = [0.0; 2];
            for (row, v) in node.rows().skip(1).zip(&node.directions) {
                slip = [slip[0] + found.y[row] * v[0], slip[1] + found.y[row] * v[1]];
            }
            let size = slip[0].hypot(slip[1]);
            if p > 0.0 && size > 0.0 {
                // The traction closest to one far away, against the slip.
                let far = FAR * law.coupling(slip.map(|s| s / size)).max(1.0) * p / size;
                let t = law.friction(slip.map(|s| -far * s), p).traction;
                for (row, v) in node.rows().skip(1).zip(&node.directions) {
                    found.z[row] = t[0] * v[0] + t[1] * v[1];
                }
            }
        }
        Ok(found.z)
    }
}

/// How far away a trial is, in terms of what friction makes available, so that its return is along it.
const FAR: f64 = 1e6;

/// Finds the tractions, from those of the last state; `report` gets the number of solves and how many nodes changed, and
/// returns whether to go on.
///
/// # Errors
/// Nothing found.
pub fn solve(
    problem: &Problem<'_>,
    w: &mut dyn RowCompliance,
    last: &[f64],
    report: &mut dyn FnMut(usize, usize) -> bool,
) -> Result<Solution, FrictionError> {
    let planar = problem.nodes.iter().all(|n| n.tangents < 2);
    let plain = |factor: f64| Settings { factor, most: MOST_SOLVES, line_search: false };
    let first = if planar { [plain(1e-3), plain(1.0)] } else { [plain(0.1), plain(1.0)] };
    let searching = Settings { factor: 1.0, most: MOST_SOLVES_SEARCHING, line_search: true };
    let mut ladder = Ladder { problem, w, report, solves: 0 };
    let mut singular = true;
    let mut nodes = Vec::new();
    for level in 0..=5 {
        let start = last.to_vec();
        let found = match level {
            0 | 1 => ladder.newton(Friction::Law, start, &first[level])?,
            2 => ladder.newton(Friction::Law, start, &searching)?,
            3 => {
                let slipping = ladder.slipping(start)?;
                ladder.newton(Friction::Law, slipping, &first[0])?
            }
            4 => {
                let near = ladder.given_pressures(start, FEW_LOOPS)?;
                if near.end == End::Accepted { near } else { ladder.newton(Friction::Law, near.z, &first[0])? }
            }
            _ => ladder.given_pressures(start, MOST_LOOPS)?,
        };
        if found.end == End::Accepted {
            let Outcome { z, y, residual, .. } = found;
            return Ok(Solution { z, y, answers: residual.answers, solves: ladder.solves, level });
        }
        singular &= found.end == End::Singular;
        nodes = worst(problem, &found.residual);
    }
    Err(if singular { FrictionError::Singular } else { FrictionError::NotFound { solves: ladder.solves, nodes } })
}

/// Nodes named in a message.
const NAMED: usize = 5;

/// The nodes with the largest residuals.
fn worst(problem: &Problem<'_>, residual: &Residual) -> Vec<usize> {
    let size = |k: &usize| problem.nodes[*k].rows().map(|r| residual.difference[r].abs()).fold(0.0, f64::max);
    let mut list: Vec<usize> = (0..problem.nodes.len()).filter(|k| size(k) > 0.0).collect();
    list.sort_by(|a, b| size(b).total_cmp(&size(a)).then(a.cmp(b)));
    list.truncate(NAMED);
    list
}
