//! Newton's equations of a system at one time: residual, its measures and its step.
//!
//! The merit is the root of the energy `Σ r²/k` of the residual on the springs `k` of the first tangent, one for each
//! unknown: forces, moments, gaps and what supports lack count alike, in any unit.

use crate::contact_law::Row;
use crate::eliminated::eliminated_step;
use crate::increment_error::IncrementError;
use crate::linear_solver::{Solved, Stiffness};
use crate::points::Order;
use crate::system::{Assembled, System, SystemState};
use signorini_solve::cholesky::Symbolic;
use signorini_solve::general::Analysis;
use signorini_solve::newton::{Converged, Equations, Measured, Newton, NewtonFailure, Search, newton};
use signorini_solve::schwarz::Inverses;

/// Force relative to the largest of all that is left in the end.
const TOLERANCE: f64 = 1e-10;
/// Rounding of a gap relative to the size of all bodies: of positions, and of the projections and cuts of faces that lead to it,
/// where it is the larger at ends of faces.
const GAP: f64 = 1e-13;
/// Rounding of positions that were solved for, relative to the size of the bodies.
pub(crate) const ROUNDING: f64 = 1e-12;
/// Stiffness of what has none, relative to the largest, by which residuals are compared.
const SLACK: f64 = 1e-8;
/// Whole steps without a better state: bodies with predicted stresses take about six, of which the first make forces that
/// are thousands of times too large.
const PATIENCE: usize = 12;
const MOST_ITERATIONS: usize = 60;
/// Down an energy that is convex each step leads nearer, however small what is ahead lets it be.
const MOST_DOWN: usize = 400;
/// Stiffness against what nothing moves, relative to the largest: Newton's method errs by so much of a step.
const GRAIN: f64 = 1e-12;

/// How far steps of Newton's method are followed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Way {
    /// As suits the bodies.
    ByBodies,
    /// Whole, as they come.
    Whole,
    /// Down the energy, which is convex and tells how far to go.
    Down,
}

pub(crate) struct Problem<'a> {
    pub(crate) system: &'a System,
    pub(crate) time: f64,
    pub(crate) analysis: Analysis,
    /// Of the Cholesky factor with multipliers eliminated, for systems of many unknowns that have one.
    pub(crate) symbolic: Option<Symbolic>,
    /// Whether steps are found by iterations, without the stiffness of bodies in the tangent.
    pub(crate) stiffness: Stiffness,
    pub(crate) solved: Solved,
    /// Parts of its preconditioner, by which those of the next step may be known.
    pub(crate) inverses: Inverses,
    /// Whether a body may move freely where no contact holds it, in systems that are factorised.
    pub(crate) is_free: bool,
    /// Springs on all unknowns of bodies.
    pub(crate) springs: f64,
    /// What their stiffness is multiplied by at each unknown; without it 1, and the square of the size for spins.
    pub(crate) metric: Vec<f64>,
    /// How far steps are followed.
    pub(crate) way: Way,
    /// A share of forces on the unknowns of bodies, and of what constraints lack, that is not there yet.
    pub(crate) held_back: Option<(f64, Vec<f64>, Vec<f64>)>,
    /// Unknowns that are spins.
    pub(crate) is_spin: Vec<bool>,
    /// Of each multiplier.
    pub(crate) rows: Vec<Row>,
    /// Stiffness of each unknown at the start, by which residuals are compared.
    pub(crate) scales: Vec<f64>,
    /// The system at the start, for the first step.
    pub(crate) first: Option<Assembled>,
    /// What rounding of positions leaves of forces and moments, near the last state.
    pub(crate) rounding: [f64; 2],
    /// How far bodies had moved when springs were set anew, in sizes of all: positions are rounded by as much more.
    pub(crate) gone: f64,
    /// The unknown that lacks most.
    pub(crate) worst: usize,
}

/// What is told of a body that went so many sizes, if rounding of its position spoils its shape by more than forces may lack.
pub(crate) fn carried_away(body: &str, away: f64) -> Option<String> {
    (away * f64::EPSILON > TOLERANCE).then(|| {
        format!(": `{body}` was carried away, {away:.0e} times the size of all bodies: does anything hold it?")
    })
}

impl Problem<'_> {
    pub(crate) fn solve(
        &mut self,
        start: &SystemState,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<Converged<SystemState>, IncrementError> {
        self.begin(start)?;
        let options = self.search(start);
        let found = newton(self, start, &options, report);
        self.converged(found)
    }

    /// How far steps from a state are followed.
    pub(crate) fn search(&self, start: &SystemState) -> Newton {
        let predicts = (self.system.bodies.iter().zip(&start.bodies))
            .any(|(b, s)| !b.is_inelastic() && b.thermal().is_none() && !s.internal.is_empty());
        // A step that turns material stretches it, and what is nearly incompressible takes that for a change of its volume: the step
        // after it corrects that.
        let is_stiff = self.system.bodies.iter().any(|b| b.is_nearly_incompressible());
        // What leaves an unstable state turns by more than it bends: its residual rises before it falls, too.
        // Nor does anything that contact could change call for short steps where there is none.
        let whole = predicts || is_stiff || !self.metric.is_empty() || self.system.contacts.is_empty();
        let most_iterations = if self.way == Way::Down { MOST_DOWN } else { MOST_ITERATIONS };
        let search = match self.way {
            Way::Down => Search::Energy,
            Way::Whole => Search::Watchdog { patience: PATIENCE },
            Way::ByBodies if whole => Search::Watchdog { patience: PATIENCE },
            Way::ByBodies => Search::Monotone,
        };
        Newton { most_iterations, search }
    }

    /// What Newton's method found, if it is near enough, or why it found nothing.
    pub(crate) fn converged(
        &self,
        found: Result<Converged<SystemState>, NewtonFailure<SystemState, IncrementError>>,
    ) -> Result<Converged<SystemState>, IncrementError> {
        let found = found.map_err(|failure| match failure {
            NewtonFailure::NotConverged { history, .. } => {
                IncrementError::NotConverged { history, worst: self.describe(self.worst) }
            }
            NewtonFailure::Equations { error, .. } => error,
            NewtonFailure::Interrupted => IncrementError::Interrupted,
        })?;
        match self.carried_away(&found.state) {
            Some(told) => Err(IncrementError::NotConverged { history: found.history, worst: Some(told) }),
            None => Ok(found),
        }
    }

    /// What a state that lies too far away is: rounding of its positions spoils the shape of the bodies by more than forces
    /// may lack, and a residual that is small beside forces as large as these tells of no equilibrium.
    fn carried_away(&self, at: &SystemState) -> Option<String> {
        let moved = |k: &usize| if self.is_spin[*k] { 0.0 } else { at.travel[*k].abs() };
        let farthest = (0..self.is_spin.len()).max_by(|a, b| moved(a).total_cmp(&moved(b)))?;
        let away = self.sizes_moved(&at.travel);
        carried_away(self.body_of(farthest)?.0, away)
    }

    /// Measures residuals by the tangent of a state: further ones may be anywhere.
    pub(crate) fn begin(&mut self, at: &SystemState) -> Result<(), IncrementError> {
        let out = self.assemble(at, Order::Second)?;
        let count = self.is_spin.len();
        let sizes = self.system.row_sizes(&out, self.stiffness());
        let mut held = vec![false; count];
        out.single.iter().for_each(|h| held[h.constraint.terms[0].0 as usize] = true);
        let most = self.stiffest(&sizes);
        self.scales = (0..count).map(|k| sizes[k].max(SLACK * most[usize::from(self.is_spin[k])])).collect();
        self.set_rounding(&sizes, &held);
        self.first = Some(out);
        Ok(())
    }

    /// The largest of some values of unknowns: of positions and of rotations.
    fn largest(&self, values: &[f64]) -> [f64; 2] {
        let mut out = [0.0f64; 2];
        self.is_spin.iter().zip(values).for_each(|(spin, v)| out[usize::from(*spin)] = out[usize::from(*spin)].max(*v));
        out
    }

    /// The largest stiffness of unknowns, by the `sizes` of the rows of a tangent: each at least what the other gives by the size
    /// of the bodies.
    fn stiffest(&self, sizes: &[f64]) -> [f64; 2] {
        let area = self.system.size().powi(2);
        let [positions, spins] = self.largest(sizes);
        let positions = positions.max(spins / area).max(f64::MIN_POSITIVE);
        [positions, spins.max(SLACK * positions * area)]
    }

    /// What rounding of positions leaves of forces, by the `sizes` of the rows of a tangent. A rope that starts slack has its
    /// stiffness only later.
    fn set_rounding(&mut self, sizes: &[f64], held: &[bool]) {
        let size = self.system.size();
        let of = |k: usize| if held[k] { 0.0 } else { sizes[k] * if self.is_spin[k] { 1.0 } else { size } };
        let free: Vec<f64> = (0..self.is_spin.len()).map(of).collect();
        self.rounding = self.largest(&free).map(|most| 4.0 * f64::EPSILON * most);
        let most = self.stiffest(sizes);
        // Moments feel the rounding of positions by the arm that couples both, `|K_θx|² <= K_θθ K_xx`.
        self.rounding[1] = self.rounding[1].max(self.rounding[0] * (most[1] / most[0]).sqrt());
    }

    /// Root of twice the energy of a residual on the springs of the unknowns.
    fn merit(&self, out: &Assembled, held: &[bool]) -> f64 {
        let count = self.is_spin.len();
        let free = (0..count).filter(|k| !held[*k]).map(|k| out.residual[k].powi(2) / self.scales[k]);
        let of_row = |(k, row): (usize, &Row)| out.residual[count + k].powi(2) * row.trial / row.area;
        let rows = self.rows.iter().enumerate().map(of_row);
        let lacks = out.single.iter().chain(&out.coupled).map(|h| {
            // The unknowns give way together: springs in a row.
            let gives_way = |(unknown, factor): &(u32, f64)| factor * factor / self.scales[*unknown as usize];
            h.constraint.violation.powi(2) / h.constraint.terms.iter().map(gives_way).sum::<f64>()
        });
        free.chain(rows).chain(lacks).sum::<f64>().sqrt()
    }

    /// The residual with springs, and less what is held back.
    pub(crate) fn assemble(&self, at: &SystemState, order: Order) -> Result<Assembled, IncrementError> {
        let mut out = self.system.assemble_with(at, self.time, order, self.stiffness())?;
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
            list.zip(lacks).for_each(|(held, violation)| held.constraint.violation -= share * violation);
            for (k, held) in out.coupled.iter().enumerate() {
                out.residual[count + k] = held.constraint.violation;
            }
        }
        Ok(out)
    }

    /// Where the stiffness of bodies is: springs on all unknowns leave none to be eliminated beforehand.
    fn stiffness(&self) -> Stiffness {
        match self.stiffness {
            Stiffness::Condensed if self.springs > 0.0 => Stiffness::InTangent,
            other => other,
        }
    }

    /// A ball without friction may turn, a block on a plane slide, a slack rope has no stiffness: a grain of it in the matrix
    /// alone keeps them where they are and changes no solution. `sizes` are those of the rows. Linear bodies that are condensed
    /// have one where contact changes them.
    pub(crate) fn add_grain(&self, out: &mut Assembled, held: &[bool], sizes: &[f64]) {
        self.grain(out, held, sizes).into_iter().for_each(|(k, grain)| out.tangent.add(k, k, grain));
    }

    /// Unknowns and the grain of each.
    pub(crate) fn grain(&self, out: &Assembled, held: &[bool], sizes: &[f64]) -> Vec<(u32, f64)> {
        let count = self.is_spin.len();
        let size = self.system.size();
        let mut most = [0.0f64; 2];
        for k in (0..count).filter(|k| !held[*k]) {
            let kind = usize::from(self.is_spin[k]);
            most[kind] = most[kind].max(sizes[k]);
        }
        let mut changes = vec![self.stiffness() == Stiffness::InTangent; count];
        out.tangent.list().for_each(|(i, ..)| {
            if let Some(changes) = changes.get_mut(i as usize) {
                *changes = true;
            }
        });
        let (first, _) = self.system.numbering();
        for (k, _) in self.system.is_condensed().iter().enumerate().filter(|(_, is)| !**is) {
            let own = first[k] as usize..first[k] as usize + self.system.bodies[k].unknowns();
            changes[own].fill(true);
        }
        let of = |k: usize| {
            let kind = usize::from(self.is_spin[k]);
            let scale = if most[kind] > 0.0 { most[kind] } else { most[0].max(f64::MIN_POSITIVE) * size * size };
            (k as u32, GRAIN * scale)
        };
        (0..count).filter(|k| !held[*k] && changes[*k]).map(of).collect()
    }

    pub(crate) fn spring(&self, unknown: usize) -> f64 {
        if let Some(own) = self.metric.get(unknown) {
            return self.springs * own;
        }
        let size = if self.is_spin[unknown] { self.system.size() } else { 1.0 };
        self.springs * size * size
    }
}

impl Equations for Problem<'_> {
    type State = SystemState;
    type Error = IncrementError;

    fn measure(&mut self, at: &SystemState) -> Result<Measured, IncrementError> {
        // Without this a body that nothing stops is sought on and on.
        if self.is_free
            && let Some(told) = self.carried_away(at)
        {
            return Err(IncrementError::NotConverged { history: vec![f64::INFINITY], worst: Some(told) });
        }
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
        let away = 1.0 + self.gone + self.sizes_moved(&at.travel);
        let rounding = self.rounding.map(|r| r * away);
        let mut worst = (0.0f64, 0);
        let mut take = |value: f64, k: usize| {
            if value > worst.0 || value.is_nan() {
                worst = (value, k);
            }
        };
        for k in (0..count).filter(|k| !held[*k]) {
            let kind = usize::from(self.is_spin[k]);
            take(out.residual[k].abs() / (TOLERANCE * scale[kind]).max(rounding[kind]), k);
        }
        for (k, Row { stiffness, area, .. }) in self.rows.iter().enumerate() {
            // Gaps no better than the rounding of positions.
            let force = out.residual[count + k].abs() * stiffness;
            let of_gap = stiffness * area * GAP * size * away;
            take(force / (TOLERANCE * scale[0]).max(rounding[0]).max(of_gap), count + k);
        }
        for held in out.single.iter().chain(&out.coupled) {
            take(held.constraint.violation.abs() / (ROUNDING * size), held.constraint.terms[0].0 as usize);
        }
        self.worst = worst.1;
        let merit = self.merit(&out, &held);
        Ok(Measured { merit, error: worst.0 })
    }

    fn step(&mut self, at: &SystemState) -> Result<Vec<f64>, IncrementError> {
        let (mut out, is_first) = match self.first.take() {
            Some(first) => (first, true),
            None => (self.assemble(at, Order::Second)?, false),
        };
        let n = out.residual.len();
        let mut right: Vec<f64> = out.residual.iter().map(|r| -r).collect();
        let mut held = vec![false; n];
        for h in &out.single {
            let (unknown, factor) = h.constraint.terms[0];
            held[unknown as usize] = true;
            right[unknown as usize] = -h.constraint.violation / factor;
        }
        if !is_first {
            self.set_rounding(&self.system.row_sizes(&out, self.stiffness()), &held);
        }
        let system = self.system;
        if let Some(division) = &system.division {
            return self.divided_step(division, (at, &out), (&held, &right));
        }
        if self.stiffness == Stiffness::KeptByBodies {
            let (step, iterations) = self.system.iterated_step(out, &held, &right, &mut self.inverses)?;
            let (systems, most, coarse) = match self.solved {
                Solved::Iterative { systems, most_iterations, coarse } => (systems, most_iterations, coarse),
                _ => (0, 0, self.system.coarse()),
            };
            self.solved = Solved::Iterative { systems: systems + 1, most_iterations: most.max(iterations), coarse };
            return Ok(step);
        }
        if self.stiffness() == Stiffness::Condensed {
            if self.is_free {
                let sizes = self.system.row_sizes(&out, self.stiffness);
                self.add_grain(&mut out, &held, &sizes);
            }
            if self.solved != Solved::Eliminated
                && let Ok(step) = self.system.condensed_step(&out, &held, &right)
            {
                self.solved = Solved::Condensed;
                return Ok(step);
            }
            // Too many unknowns remain, or nothing holds them.
            if let Some(symbolic) = self.symbolic.as_mut().filter(|_| self.system.is_all_condensed()) {
                match self.system.eliminated_step(&out, &held, &right, symbolic) {
                    Ok(step) => {
                        self.solved = Solved::Eliminated;
                        return Ok(step);
                    }
                    Err(_) => self.symbolic = None,
                }
            }
            self.stiffness = Stiffness::InTangent;
            self.solved = Solved::Direct;
            out = self.assemble(at, Order::Second)?;
        }
        // Without it once more where a stiffness is not positive definite, or far from symmetric.
        if let Some(mut symbolic) = self.symbolic.take() {
            if self.is_free {
                let sizes = self.system.row_sizes(&out, self.stiffness());
                self.add_grain(&mut out, &held, &sizes);
            }
            let count = self.is_spin.len();
            if let Ok(step) = eliminated_step((None, &out.tangent), (count, &held), &right, &mut symbolic) {
                (self.symbolic, self.solved) = (Some(symbolic), Solved::Eliminated);
                return Ok(step);
            }
        }
        out.tangent.hold(&held);
        let matrix = out.tangent.matrix(n);
        let sizes = matrix.row_sizes();
        if !self.is_free
            && let Ok(found) = self.analysis.factor(matrix).and_then(|lu| lu.solve(&right))
        {
            return Ok(found);
        }
        self.add_grain(&mut out, &held, &sizes);
        let matrix = out.tangent.matrix(n);
        Ok(self.analysis.factor(matrix)?.solve(&right)?)
    }

    fn is_driven(&self, at: &SystemState) -> bool {
        if self.held_back.is_some() {
            return false;
        }
        let size = self.system.size();
        let lacks = |h: &crate::system::Held| h.constraint.violation.abs() > ROUNDING * size;
        self.system.held(&at.bodies, self.time).is_ok_and(|(single, coupled)| single.iter().chain(&coupled).any(lacks))
    }

    fn slope(&mut self, at: &SystemState, step: &[f64]) -> Result<f64, IncrementError> {
        let mut out = self.assemble(at, Order::First)?;
        out.single.iter().for_each(|h| out.residual[h.constraint.terms[0].0 as usize] = 0.0);
        let count = self.is_spin.len();
        Ok(out.residual[..count].iter().zip(step).map(|(r, s)| r * s).sum())
    }

    fn farthest(&self, at: &SystemState, step: &[f64]) -> f64 {
        // Where bodies cannot be touched the residual tells.
        self.system.free_way(at, &self.system.advance(at, step, 1.0)).unwrap_or(1.0)
    }

    fn advance(&self, at: &SystemState, step: &[f64], share: f64) -> SystemState {
        self.system.advance(at, step, share)
    }
}
