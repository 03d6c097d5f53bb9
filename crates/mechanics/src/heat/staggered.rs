//! Heat and mechanics in turn, until the temperatures change no more.
//!
//! Pass `k` solves for equilibrium at the temperatures `T_k`, then for the temperatures `G(T_k)` with the pressures and slips
//! found. `T ← T + (G(T) - T)` is accelerated by the method of Anderson, since contacts whose conductance grows with the pressure
//! make the plain iteration slow, or let it diverge (Barber, Dundurs and Comninou, *J. Appl. Mech.* 47, 1980, on rods that have
//! no stable state). Where a contact opens and closes in turns, shares of the step from the best temperatures are taken. Every
//! pass starts from the same accepted state, so that slips and plastic strains count once.

use super::{Equation, Heat, HeatError};
use crate::increment::IncrementResult;
use crate::increment_error::IncrementError;
use crate::system::{System, SystemState};
use signorini_solve::Acceleration;

/// Growth of the change of a pass with which the temperatures leapt to another state of the contacts.
const LEAPS: f64 = 10.0;

/// The temperatures with the least change by a pass so far.
struct Best {
    largest: f64,
    temperatures: Vec<Vec<f64>>,
    change: Vec<f64>,
}

fn move_by(temperatures: &mut [Vec<f64>], step: &[f64], share: f64) {
    temperatures.iter_mut().flatten().zip(step).for_each(|(t, s)| *t += share * s);
}

impl System {
    /// Solves for equilibrium at a time as [`solve`](System::solve), with the temperatures that belong to it.
    pub(crate) fn solve_with_heat(
        &mut self,
        heat: &Heat,
        from: &SystemState,
        time: f64,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<(SystemState, IncrementResult), IncrementError> {
        let kept = self.histories();
        let mut temperatures = self.first_temperatures(heat, from, time)?;
        let mut acceleration = Acceleration::default();
        let mut share = 1.0;
        let mut best: Option<Best> = None;
        let (mut history, mut iterations) = (Vec::new(), 0);
        for pass in 1..=heat.most_passes {
            let before = iterations;
            let mut counted = |iteration: usize, residual: f64| {
                iterations = before + iteration;
                report(before + iteration, residual)
            };
            self.temperatures.clone_from(&temperatures);
            let found = self.solve_at_temperature(from, time, &mut counted);
            self.temperatures.clear();
            let (state, mut result) = found?;
            let found = self.solve_heat(heat, from, (&state, &result.sites), time);
            let (next, mut flows) = found.inspect_err(|_| self.put_back(&kept))?;
            let change: Vec<f64> =
                temperatures.iter().flatten().zip(next.iter().flatten()).map(|(old, new)| new - old).collect();
            let largest = change.iter().fold(0.0f64, |m, c| m.max(c.abs()));
            let wanted = self.tolerated(heat, [&temperatures, &next], from);
            history.push(if largest == 0.0 { 0.0 } else { largest / wanted });
            if largest <= wanted {
                let thermal = self.bodies.iter().zip(&state.bodies).map(|(body, state)| Some((body.thermal()?, state)));
                flows.ranges = thermal.map(|own| own.map(|(body, state)| body.range(state))).collect();
                (flows.history, flows.passes) = (history, pass);
                result.iterations = iterations;
                result.heat = Some(flows);
                return Ok((state, result));
            }
            self.put_back(&kept);
            if let Some(best) = best.as_ref().filter(|best| largest > LEAPS * best.largest) {
                // A contact that opened or closed: the state lies between.
                share *= 0.5;
                temperatures.clone_from(&best.temperatures);
                move_by(&mut temperatures, &best.change, share);
                continue;
            }
            let before = temperatures.clone();
            if share < 1.0 {
                move_by(&mut temperatures, &change, share);
                share = 0.5f64.min(2.0 * share);
            } else {
                move_by(&mut temperatures, &acceleration.next(change.clone()), 1.0);
            }
            if best.as_ref().is_none_or(|best| largest < best.largest) {
                best = Some(Best { largest, temperatures: before, change });
            }
        }
        Err(HeatError::NotConverged { passes: heat.most_passes, history }.into())
    }

    /// Temperatures to begin with: those with the contacts of the last state, or where these do not tell them, the last ones.
    fn first_temperatures(&self, heat: &Heat, from: &SystemState, time: f64) -> Result<Vec<Vec<f64>>, IncrementError> {
        let sites = (0..self.contacts.len()).map(|k| self.sites(k, from)).collect::<Result<Vec<_>, _>>()?;
        match self.solve_heat(heat, from, (from, &sites), time) {
            Ok((temperatures, _)) => Ok(temperatures),
            Err(IncrementError::Heat(HeatError::Floating { .. })) if self.conducts_by_contact(heat) => {
                let last = |k: usize| {
                    self.bodies[k].thermal().map_or(Vec::new(), |body| body.temperature(&from.bodies[k]).to_vec())
                };
                Ok((0..self.bodies.len()).map(last).collect())
            }
            Err(error) => Err(error),
        }
    }

    fn conducts_by_contact(&self, heat: &Heat) -> bool {
        heat.contacts.iter().flatten().any(|contact| contact.conductance.is_some())
    }

    /// The change of a temperature that ends the passes.
    fn tolerated(&self, heat: &Heat, of: [&[Vec<f64>]; 2], from: &SystemState) -> f64 {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        for (k, body) in self.bodies.iter().enumerate() {
            let Some(thermal) = body.thermal() else { continue };
            // The other functions tell differences.
            let unity = thermal.unity();
            for list in [&of[0][k][..], &of[1][k], thermal.temperature(&from.bodies[k])] {
                for t in list.iter().zip(&unity).filter(|(_, is)| **is).map(|(t, _)| *t) {
                    (low, high) = (low.min(t), high.max(t));
                }
            }
        }
        let rounding = 8.0 * f64::EPSILON * low.abs().max(high.abs());
        (heat.tolerance * (high - low)).max(rounding)
    }
}

impl Heat {
    /// Whether the temperatures of an increment depend on those before.
    pub fn stores(&self) -> bool {
        self.equation == Equation::Transient
    }
}
