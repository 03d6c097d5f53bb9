//! Which body is free to move, and what lacked most where nothing was found.

use crate::body::{Body, BodyState, Contribution};
use crate::equilibrium::Problem;
use crate::increment_error::IncrementError;
use crate::linear_solver::Stiffness;
use crate::points::Order;
use crate::system::{AssemblyError, Held, System, SystemState, TimedLoad};
use nalgebra::{DMatrix, DVector};
use signorini_contact::Status;
use signorini_geometry::Vector;

/// A body that went so many sizes away, or turned so often, is not held.
pub(crate) const AWAY: f64 = 10.0;
/// A free body that moves by more of its size, or turns by more radians, is followed in smaller steps.
const LEAP: f64 = 0.5;
/// Motion of a support, relative to the largest of all, that may draw bodies round one another in one increment.
const DRIVEN: f64 = 0.1;
/// What friction may hold is followed to rest where it moved by more of its size.
const SLIDES: f64 = 1e-2;

/// What turns as it moves: `1/√3` for a block or a rod about its corner or end, `1/√2` for a disc that rolls.
const TIPS: f64 = 0.5;
/// Share of what holds a body most that rounding leaves of what does not hold it.
const NOT_HELD: f64 = 1e-10;

impl System {
    /// A body of small strains that no contact can hold, by its number, and a rigid motion of it against which nothing else
    /// holds it.
    ///
    /// # Errors
    /// Supports and loads that cannot act.
    pub fn unheld(&self) -> Result<Option<(usize, String)>, AssemblyError> {
        let may_touch = |k: usize| self.contacts.iter().any(|c| c.bodies().contains(&k));
        let alone = |k: &usize| self.bodies[*k].is_linear() && self.bodies[*k].unknowns() > 0 && !may_touch(*k);
        for k in (0..self.bodies.len()).filter(alone) {
            if let Some(motion) = self.free_motion(k)? {
                return Ok(Some((k, motion)));
            }
        }
        Ok(None)
    }

    /// Whether a body may move freely where no contact holds it: a rigid one, or one of small strains that neither supports
    /// nor springs hold.
    pub(crate) fn has_free_body(&self) -> bool {
        let tied = self.tied_to_held();
        let is_free = |k: usize| self.bodies[k].is_rigid() || (self.bodies[k].is_linear() && self.moves_by_itself(k));
        (0..self.bodies.len()).any(|k| !tied[k] && self.bodies[k].unknowns() > 0 && is_free(k))
    }

    /// Which bodies ties hold to one that is held itself.
    fn tied_to_held(&self) -> Vec<bool> {
        let ties: Vec<[usize; 2]> = (self.contacts.iter())
            .filter(|contact| contact.law().friction.as_ref().is_some_and(|law| law.is_tied()))
            .map(|contact| contact.bodies())
            .collect();
        let mut held = vec![false; self.bodies.len()];
        for k in ties.iter().flatten() {
            held[*k] = !self.moves_by_itself(*k);
        }
        // Each pass reaches one body farther from what holds them.
        for _ in 0..ties.len() {
            for [a, b] in &ties {
                let both = held[*a] || held[*b];
                (held[*a], held[*b]) = (both, both);
            }
        }
        held
    }

    /// Whether a body may move rigidly where no contact holds it, whatever it is like.
    pub(crate) fn is_unheld(&self, body: usize) -> bool {
        self.moves_by_itself(body) && !self.tied_to_held()[body]
    }

    /// Whether a body may move rigidly where nothing but its supports holds it.
    fn moves_by_itself(&self, body: usize) -> bool {
        self.bodies[body].unknowns() > 0 && matches!(self.free_motion(body), Ok(Some(_)))
    }

    pub(crate) fn has_unheld_body(&self) -> bool {
        (0..self.bodies.len()).any(|body| self.is_unheld(body))
    }

    /// How far bodies with a prescribed motion are displaced in the increment that has begun.
    fn prescribed_travel(&self) -> f64 {
        let Some([last, now]) = self.contacts.first().map(|contact| contact.law().times) else { return 0.0 };
        let of = |body: &dyn Body| {
            let [from, to] = [last, now].map(|time| {
                let mut state = body.start();
                body.prescribe(time, &mut state);
                state.configuration
            });
            from.iter().zip(&to).take(3).map(|(a, b)| (b - a).powi(2)).sum::<f64>().sqrt()
        };
        self.bodies.iter().map(Box::as_ref).filter(|body| body.is_rigid()).map(of).fold(0.0, f64::max)
    }

    /// Whether there is friction.
    pub(crate) fn has_friction(&self) -> bool {
        self.contacts.iter().any(|contact| contact.friction().is_some())
    }

    /// The derivative of what holds places of a body by terms in its unknowns, and of its springs.
    fn springs_of(&self, k: usize, at: &SystemState) -> Result<Vec<(Vec<u32>, Vec<f64>)>, AssemblyError> {
        let (body, state) = (self.bodies[k].as_ref(), &at.bodies[k]);
        let mut out = Contribution::new(body.unknowns());
        for load in self.loads.iter().filter(|l| l.part.body == k && matches!(l.load, TimedLoad::Springs(_))) {
            load.act(body, state, 0.0, Order::Second, &mut out)?;
        }
        for support in self.supports.iter().filter(|s| s.part.body == k) {
            let on = support.part.group.as_deref();
            support.at(0.0, |hold| body.hold_weakly(on, hold, state, Order::Second, &mut out))?;
        }
        Ok(out.blocks)
    }

    /// A rigid motion of a body against which nothing holds it at rest: neither supports nor springs.
    ///
    /// # Errors
    /// Supports and loads that cannot act.
    pub fn free_motion(&self, k: usize) -> Result<Option<String>, AssemblyError> {
        let at = self.start();
        let (first, _) = self.numbering();
        let range = first[k] as usize..first[k] as usize + self.bodies[k].unknowns();
        let modes = self.bodies[k].rigid_modes(&at.bodies[k]);
        // Turns about the origin are almost translations of a body far from it: only what they add counts.
        let mut basis: Vec<(usize, DVector<f64>)> = Vec::new();
        for (number, mode) in modes.iter().enumerate() {
            let mut x = DVector::from_column_slice(mode);
            let whole = x.norm();
            (0..2).for_each(|_| basis.iter().for_each(|(_, b)| x -= b * b.dot(&x)));
            if x.norm() > NOT_HELD * whole {
                basis.push((number, x.normalize()));
            }
        }
        let mut held = DMatrix::zeros(basis.len(), basis.len());
        let (single, coupled) = self.held(&at.bodies, 0.0)?;
        for terms in single.iter().chain(&coupled).map(|held| &held.constraint.terms) {
            let size: f64 = terms.iter().map(|t| t.1 * t.1).sum();
            let own =
                |(u, c): &(u32, f64)| Some((range.contains(&(*u as usize)).then(|| *u as usize - range.start)?, *c));
            let own: Vec<(usize, f64)> = terms.iter().filter_map(own).collect();
            let along = |x: &DVector<f64>| own.iter().map(|(u, c)| c * x[*u]).sum::<f64>();
            let row = DVector::from_iterator(basis.len(), basis.iter().map(|b| along(&b.1)));
            held.ger(1.0 / size.max(f64::MIN_POSITIVE), &row, &row, 1.0);
        }
        let springs = self.springs_of(k, &at)?;
        let largest = springs.iter().flat_map(|s| &s.1).fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
        for (unknowns, block) in &springs {
            let n = unknowns.len();
            let part = DMatrix::from_fn(n, basis.len(), |i, j| basis[j].1[unknowns[i] as usize]);
            held += part.transpose() * (DMatrix::from_row_slice(n, n, block) * &part) / largest;
        }
        let nothing = NOT_HELD * held.clone().symmetric_eigenvalues().max();
        let is_free = |i: usize| held.column(i).amax() <= nothing;
        // What is free by itself is named first; otherwise some combination is.
        if let Some(i) = (0..basis.len()).find(|i| is_free(*i)) {
            let (kind, axis) = (["moving along", "turning about"][basis[i].0 / 3], ["x", "y", "z"][basis[i].0 % 3]);
            return Ok(Some(format!("{kind} {axis}")));
        }
        let least = held.symmetric_eigenvalues().min();
        Ok((least <= nothing).then(|| "a turn about some axis".to_string()))
    }
}

/// In words, how a body moves in a step of its unknowns: along the mean of its translation, or about that of its spins.
pub(crate) fn motion_in_words(
    (body, state): (&dyn Body, &BodyState),
    (step, is_spin): (&[f64], &[bool]),
    turns: bool,
) -> String {
    let modes = body.rigid_modes(state);
    if !is_spin.contains(&true)
        && let Some(turn) = turn_of(&modes, step)
    {
        return in_words("turning about", turn);
    }
    let along = |mode: &[f64]| {
        let kept = (0..step.len()).filter(|k| is_spin[*k] == turns);
        let [product, square] = kept.fold([0.0; 2], |[p, s], k| [p + mode[k] * step[k], s + mode[k] * mode[k]]);
        if square > 0.0 { product / square } else { 0.0 }
    };
    let part = if turns { &modes[3..] } else { &modes[..3] };
    let direction = Vector::<3>::from_fn(|i, _| along(&part[i]));
    in_words(if turns { "turning about" } else { "moving along" }, direction)
}

fn in_words(kind: &str, direction: Vector<3>) -> String {
    // What is rounded to zero has no sign.
    let d = direction.try_normalize(0.0).unwrap_or_default().map(|c| if c.abs() < 5e-4 { 0.0 } else { c });
    format!("{kind} ({:.3}, {:.3}, {:.3})", d[0], d[1], d[2])
}

/// The turn in a step of a body without spins, where it turns rather than moves: what tips about a corner or rolls turns by a
/// part of what it moves, in the mean over its unknowns; what slides does not turn.
fn turn_of(modes: &[Vec<f64>; 6], step: &[f64]) -> Option<Vector<3>> {
    let modes: Vec<DVector<f64>> = modes.iter().map(|mode| DVector::from_column_slice(mode)).collect();
    let without_translations = |x: DVector<f64>| {
        modes[..3].iter().filter(|t| t.norm() > 0.0).fold(x, |x, t| &x - t * (x.dot(t) / t.norm_squared()))
    };
    let turns: Vec<DVector<f64>> = modes[3..].iter().map(|mode| without_translations(mode.clone())).collect();
    let step = DVector::from_column_slice(step);
    let rest = without_translations(step.clone());
    let inertia = DMatrix::from_fn(3, 3, |i, j| turns[i].dot(&turns[j]));
    let moment = DVector::from_fn(3, |i, _| turns[i].dot(&rest));
    let least = NOT_HELD * inertia.trace();
    let turn = inertia.svd(true, true).solve(&moment, least).ok()?;
    let turned: f64 = turn.dot(&moment).max(0.0).sqrt();
    (turned > TIPS * (&step - &rest).norm()).then(|| Vector::<3>::from_fn(|i, _| turn[i]))
}

impl Problem<'_> {
    /// Whether a body has gone so far that nothing holds it.
    pub(crate) fn is_far(&self, travel: &[f64]) -> bool {
        travel.iter().enumerate().any(|(k, t)| t.is_nan() || self.sizes_gone(k, *t) > AWAY)
    }

    /// The farthest way of a point, in sizes of all bodies.
    pub(crate) fn sizes_moved(&self, travel: &[f64]) -> f64 {
        let moved = travel.iter().zip(&self.is_spin).filter(|(_, turns)| !**turns).map(|(t, _)| t.abs());
        moved.fold(0.0, f64::max) / self.system.size()
    }

    fn sizes_gone(&self, unknown: usize, travel: f64) -> f64 {
        travel.abs() / if self.is_spin[unknown] { std::f64::consts::TAU } else { self.system.size() }
    }

    /// Whether a free rigid body went so far in one solve that nothing tells what it passed.
    pub(crate) fn leaps(&self, from: &SystemState, to: &SystemState) -> bool {
        let bodies = self.system.bodies.iter().enumerate();
        bodies.filter(|(_, b)| b.is_rigid() && b.unknowns() > 0).any(|(k, body)| {
            let [a, b] = [from, to].map(|s| &s.bodies[k].configuration);
            let away = (0..3).map(|i| (b[i] - a[i]).powi(2)).sum::<f64>().sqrt();
            let cosine: f64 = (3..7).map(|i| a[i] * b[i]).sum();
            away > LEAP * body.size() || cosine.abs() < (0.5 * LEAP).cos()
        })
    }

    /// Whether the straight way between two states leads through a body, though no support moves as far: a state on the
    /// other side, which Newton's method may find by steps that are far apart.
    pub(crate) fn passes(&self, from: &SystemState, to: &SystemState) -> bool {
        self.goes_by_itself(from, to) > 0.0 && self.system.free_way(from, to).is_ok_and(|share| share < 1.0)
    }

    /// Whether a body that only contact holds moved by itself where there is friction: Newton's method may slide past where
    /// it rests.
    pub(crate) fn slides(&self, from: &SystemState, to: &SystemState) -> bool {
        let far = SLIDES * self.system.size();
        self.system.has_friction() && self.goes_by_itself(from, to) > far && self.system.has_unheld_body()
    }

    /// How far something moved between two states, if no support and no body with a prescribed motion moves about as far.
    fn goes_by_itself(&self, from: &SystemState, to: &SystemState) -> f64 {
        let moved = to.travel.iter().zip(&from.travel).zip(&self.is_spin).filter(|(_, turns)| !**turns);
        let farthest = moved.map(|((b, a), _)| (b - a).abs()).fold(0.0, f64::max);
        let reach =
            |h: &Held| h.constraint.violation.abs() * if h.constraint.turns() { self.system.size() } else { 1.0 };
        let driven = self
            .system
            .held(&from.bodies, self.time)
            .map_or(0.0, |(single, coupled)| single.iter().chain(&coupled).map(reach).fold(0.0, f64::max))
            .max(self.system.prescribed_travel());
        if driven < DRIVEN * farthest { farthest } else { 0.0 }
    }

    /// Whether a support pulls a rigid body.
    pub(crate) fn is_pulled(&self, at: &SystemState) -> bool {
        let lacks = |h: &crate::system::Held| {
            let Some(support) = h.support() else { return false };
            let (body, violation) = (self.system.supports[support].part.body, h.constraint.violation.abs());
            let size = self.system.bodies[body].size();
            self.system.bodies[body].is_rigid()
                && violation > 0.5 * LEAP * if h.constraint.turns() { 1.0 } else { size }
        };
        self.system.held(&at.bodies, self.time).is_ok_and(|(single, coupled)| single.iter().chain(&coupled).any(lacks))
    }

    /// The body that moved farthest, and how.
    pub(crate) fn free(&self, at: &SystemState) -> IncrementError {
        let gone = |k: &usize| self.sizes_gone(*k, at.travel[*k]);
        let Some(unknown) = (0..at.travel.len()).max_by(|a, b| gone(a).total_cmp(&gone(b))) else {
            return IncrementError::Interrupted;
        };
        let (first, _) = self.system.numbering();
        let Some(k) = first.iter().rposition(|f| *f as usize <= unknown) else { return IncrementError::Interrupted };
        let body = &self.system.bodies[k];
        let own = first[k] as usize..first[k] as usize + body.unknowns();
        let (travel, is_spin) = (&at.travel[own.clone()], &self.is_spin[own]);
        // Rigid motions are those from where the body was before it went.
        let mut before = at.bodies[k].clone();
        if before.configuration.len() == travel.len() {
            before.configuration.iter_mut().zip(travel).for_each(|(u, t)| *u -= t);
        }
        let motion = motion_in_words((body.as_ref(), &before), (travel, is_spin), self.is_spin[unknown]);
        let motion = if self.system.has_friction() && self.touches(k, at) {
            motion.replacen("moving", "sliding", 1)
        } else {
            motion
        };
        IncrementError::Free { body: body.name().to_string(), motion }
    }

    /// Whether a contact of a body carries.
    fn touches(&self, body: usize, at: &SystemState) -> bool {
        let own = (0..self.system.contacts.len()).filter(|k| self.system.contacts[*k].bodies().contains(&body));
        let mut sites = own.filter_map(|k| self.system.sites(k, at).ok()).flatten();
        sites.any(|site| site.status != Status::Open)
    }

    pub(crate) fn body_of(&self, unknown: usize) -> Option<(&str, usize)> {
        let (first, count) = self.system.numbering();
        if unknown >= count {
            return None;
        }
        let k = first.iter().rposition(|f| *f as usize <= unknown)?;
        Some((self.system.bodies[k].name(), unknown - first[k] as usize))
    }

    pub(crate) fn describe(&self, unknown: usize) -> Option<String> {
        match self.body_of(unknown) {
            Some((body, _)) => Some(format!("; the largest residual is a force on `{body}`")),
            None => {
                let mut row = unknown - self.is_spin.len();
                for contact in &self.system.contacts {
                    let rows = contact.law().rows().count();
                    if row < rows {
                        return Some(format!("; the largest residual is a condition of contact `{}`", contact.name()));
                    }
                    row -= rows;
                }
                Some("; the largest residual is a support condition".to_string())
            }
        }
    }

    /// A system without a solution, by the body that is free to move.
    pub(crate) fn named(&self, error: IncrementError, at: &SystemState) -> IncrementError {
        if !matches!(error, IncrementError::Solve(_) | IncrementError::NotConverged { .. }) {
            return error;
        }
        let stiffness = match self.stiffness {
            Stiffness::KeptByBodies => Stiffness::KeptByBodies,
            Stiffness::InTangent | Stiffness::Condensed => Stiffness::InTangent,
        };
        let assemble = || self.system.assemble_with(at, self.time, Order::Second, stiffness);
        let Ok(assembled) = assemble() else { return error };
        let (first, count) = self.system.numbering();
        let held: Vec<usize> = assembled.single.iter().map(|h| h.constraint.terms[0].0 as usize).collect();
        let size_of_all = assembled.residual.len();
        let largest = self.system.row_sizes(&assembled, stiffness).into_iter().fold(0.0f64, f64::max);
        let divided = self.system.division.as_ref().map(|division| division.matrix(&assembled));
        let matrix = (divided.is_none() && stiffness == Stiffness::InTangent)
            .then(|| assembled.tangent.matrix(assembled.residual.len()));
        for (k, body) in self.system.bodies.iter().enumerate() {
            for (mode, motion) in body.rigid_modes(&at.bodies[k]).iter().enumerate() {
                let mut x = vec![0.0; size_of_all];
                let range = first[k] as usize..first[k] as usize + motion.len();
                x[range].copy_from_slice(motion);
                let size = motion.iter().fold(0.0f64, |m, v| m.max(v.abs()));
                let along = |h: &Held| h.constraint.terms.iter().map(|(u, f)| f * x[*u as usize]).sum::<f64>();
                let is_held = |h: &Held| along(h).abs() > NOT_HELD * size;
                if size == 0.0 || held.iter().any(|h| x[*h] != 0.0) || assembled.coupled.iter().any(is_held) {
                    continue;
                }
                let moved = match (&divided, &matrix) {
                    (Some(divided), _) => divided.multiply(&x),
                    (None, Some(matrix)) => matrix.multiply(&x),
                    (None, None) => match assemble() {
                        Ok(again) => self.system.product(again, &x),
                        Err(_) => return error,
                    },
                };
                let rows = self.rows.iter().zip(moved.iter().skip(count)).map(|(row, f)| f * row.trial);
                if moved[..count].iter().copied().chain(rows).all(|f| f.abs() <= 1e-10 * largest * size) {
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
