//! Energy of an increment in time: what friction and damping took, and what contact did not.

use crate::body::Contribution;
use crate::increment_error::IncrementError;
use crate::interaction::Assembler;
use crate::points::Order;
use crate::resultants::dot;
use crate::site_result::SiteResult;
use crate::system::{AssemblyError, System, SystemState, add};
use crate::time_step::{TimeStep, Weights};
use signorini_contact::Status;
use signorini_solve::general::{Analysis, Entries};

/// An increment in time that was solved, with the sites of all contacts at its start and end.
pub(crate) struct Solved<'a> {
    pub system: &'a System,
    pub step: &'a TimeStep,
    pub start: &'a SystemState,
    pub before: Vec<Vec<SiteResult>>,
    pub after: &'a [Vec<SiteResult>],
}

/// The smaller root `s` of `½ a s² + b s + work = 0`: what share of velocities `w` added to `v` takes away an energy, with their
/// products `a = w·M w` and `b = v·M w`.
pub(crate) fn share(a: f64, b: f64, work: f64) -> Option<f64> {
    let square = b * b - 2.0 * a * work;
    (square >= 0.0).then(|| -2.0 * work / (b + square.sqrt().copysign(b))).filter(|share| share.is_finite())
}

impl Solved<'_> {
    /// The stored energy and the internal forces of a body at the start and in the state at the end.
    pub fn internal(&self, k: usize, state: &SystemState) -> Result<[(f64, Vec<f64>); 2], AssemblyError> {
        let body = &self.system.bodies[k];
        let at = |state: &SystemState| {
            let mut out = Contribution::new(body.unknowns());
            let energy = body.internal(&state.bodies[k], Order::First, &mut out)?;
            Ok::<_, AssemblyError>((energy, out.forces))
        };
        Ok([at(self.start)?, at(state)?])
    }

    /// The forces of damping by stiffness on all unknowns of bodies: zero without it.
    pub fn damping(&self, state: &SystemState) -> Result<Vec<f64>, AssemblyError> {
        let over_time = self.step.damping[1] / self.step.size;
        if over_time == 0.0 {
            return Ok(vec![0.0; self.system.numbering().1]);
        }
        let mut out = Vec::new();
        for k in 0..self.system.bodies.len() {
            let [(_, before), (_, after)] = self.internal(k, state)?;
            out.extend(after.iter().zip(&before).map(|(b, a)| over_time * (b - a)));
        }
        Ok(out)
    }

    /// The mean of a value by the weights of the forces.
    fn mean(&self, of: impl Fn(&SiteResult) -> f64, (before, after): (&SiteResult, &SiteResult)) -> f64 {
        let alpha_f = self.step.weights.alpha_f;
        alpha_f * of(before) + (1.0 - alpha_f) * of(after)
    }

    /// The sites of a contact at the start and the end.
    fn sites(&self, contact: usize) -> impl Iterator<Item = (&SiteResult, &SiteResult)> {
        self.before[contact].iter().zip(&self.after[contact])
    }

    /// What friction of each contact took, by its mean.
    pub fn rubbed(&self) -> Vec<f64> {
        let friction = |s: &SiteResult, along: &SiteResult| s.friction.dot(&along.increment);
        let one = |(a, b): (&SiteResult, &SiteResult)| match b.status {
            Status::Open => 0.0,
            _ => -b.weight * self.mean(|s| friction(s, b), (a, b)),
        };
        (0..self.after.len()).map(|contact| self.sites(contact).map(one).sum()).collect()
    }

    /// What damping, and the weights of the method, took from displacements before energy is given back: of the equation times the
    /// displacements, all but the changes of the energies and the works of forces by their means.
    pub fn damped(&self, state: &SystemState, damping: &[f64]) -> f64 {
        let (system, step, start) = (self.system, self.step, self.start);
        let Weights { alpha_m, alpha_f, .. } = step.weights;
        let u = &step.motion(system, state);
        let kinetic = |v: &[f64]| 0.5 * system.product_by_mass(v, v);
        let ends = step.accelerations.iter().zip(&state.accelerations);
        let weighted: Vec<f64> = ends.map(|(a, b)| alpha_m * a + (1.0 - alpha_m) * b).collect();
        let mut damped =
            system.product_by_mass(&weighted, u) - (kinetic(&state.velocities) - kinetic(&step.velocities));
        let uneven = 0.5 - alpha_f;
        if uneven != 0.0 {
            let change = state.forces.iter().zip(&start.forces).map(|(b, a)| b - a);
            damped += uneven * change.zip(u).map(|(f, u)| f * u).sum::<f64>();
            for (before, after) in (0..self.after.len()).flat_map(|contact| self.sites(contact)) {
                if let (Some(from), Some(to)) = (before.gap, after.gap) {
                    damped += uneven * (after.pressure - before.pressure) * after.weight * (to - from);
                    damped += uneven * (after.friction - before.friction).dot(&after.increment) * after.weight;
                }
            }
        }
        damped += step.damping[0] / step.size * system.product_by_mass(u, u);
        damped + damping.iter().zip(u).map(|(f, u)| f * u).sum::<f64>()
    }

    /// The work of contact as it closed or opened: surfaces that keep each other out do none.
    fn work_of_contact(&self) -> f64 {
        let mut work = 0.0;
        for (k, contact) in self.system.contacts.iter().enumerate() {
            // What gives way stores or spends energy by its law.
            if contact.law().friction.as_ref().is_some_and(|law| law.is_compliant() || law.is_bond()) {
                continue;
            }
            for (before, after) in self.sites(k) {
                let (Some(from), Some(to)) = (before.gap, after.gap) else { continue };
                work += self.mean(|s| s.pressure, (before, after)) * after.weight * (to - from);
            }
        }
        work
    }

    /// Gives back to the velocities at the end the energy that contact took or gave, and returns what could not be. What changes is
    /// the impulse of contact between the bodies, so momenta are conserved.
    pub fn restore(&self, state: &mut SystemState) -> Result<f64, IncrementError> {
        let work = self.work_of_contact();
        let kinetic = |state: &SystemState, v: &[f64], w: &[f64]| -> f64 { dot(&self.system.momenta(state, v), w) };
        if work.abs() <= f64::EPSILON * kinetic(state, &state.velocities, &state.velocities) {
            return Ok(0.0);
        }
        let Some(along) = self.velocities_by_contact(state)? else { return Ok(work) };
        let (a, b) = (kinetic(state, &along, &along), kinetic(state, &state.velocities, &along));
        if a <= 0.0 {
            return Ok(work);
        }
        let whole = share(a, b, work);
        let share = whole.unwrap_or(-b / a);
        state.velocities.iter_mut().zip(&along).for_each(|(v, w)| *v += share * w);
        Ok(if whole.is_some() { 0.0 } else { work - 0.5 * b * b / a })
    }

    /// The velocities by an impulse like that of contact in the increment, up to a factor; none where they are not determined.
    fn velocities_by_contact(&self, state: &SystemState) -> Result<Option<Vec<f64>>, IncrementError> {
        let system = self.system;
        let (first, count) = system.numbering();
        let rows = count + state.multipliers.len();
        let (mut residual, mut sizes) = (vec![0.0; rows], vec![0.0; rows]);
        for at in [self.start, state] {
            let mut target = Assembler { residual: &mut residual, sizes: &mut sizes, tangent: None };
            system.add_contacts(at, &mut target).map_err(AssemblyError::from)?;
        }
        let mut forces: Vec<f64> = residual[..count].iter().map(|r| -r).collect();
        let mut tangent = Entries::default();
        for (body, (own, first)) in system.bodies.iter().zip(state.bodies.iter().zip(&first)) {
            let mut out = Contribution::new(body.unknowns());
            body.internal(own, Order::Second, &mut out).map_err(AssemblyError::from)?;
            add(&out, *first, &mut residual, &mut sizes, &mut tangent);
        }
        self.step.add_to(system, state, (&mut residual, &mut sizes), Some(&mut tangent));
        let mut held = vec![false; count];
        for unknown in system.held_unknowns(state, state.time)? {
            (held[unknown], forces[unknown]) = (true, 0.0);
        }
        tangent.hold(&held);
        Ok(Analysis::default().factor(tangent.matrix(count)).and_then(|lu| lu.solve(&forces)).ok())
    }
}
