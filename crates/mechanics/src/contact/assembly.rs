//! Residual and tangent of a contact.

use super::{Contact, MeasuredPair, Sides};
use crate::body::PlaceError;
use crate::interaction::Assembler;
use crate::pair::NoPair;
use crate::points::Sampling;
use rayon::prelude::*;
use signorini_contact::Status;

impl Contact {
    /// Adds the contact to residual and tangent. `lambda` are its own unknowns, if it has any, and `first` the number of
    /// the first of them. Returns how many sites could not be measured.
    ///
    /// # Errors
    /// A master that cannot be touched.
    pub(crate) fn add_sites(
        &self,
        sides: &Sides<'_>,
        (lambda, first): (&[f64], u32),
        out: &mut Assembler<'_>,
    ) -> Result<usize, PlaceError> {
        let master = self.met(sides)?;
        let linearises = out.tangent.is_some();
        let parts = self.components();
        let mut lost = 0;
        // Pairs are found side by side and added one after the other.
        let find = |k: usize| {
            let at = self.law.multiplier(k, lambda);
            let is_closed = |touch: &MeasuredPair| {
                linearises && self.traction(k, touch, at, ([0.0; 2], false)).projected.status != Status::Open
            };
            if self.partners.get().is_none() && self.is_far(k, sides, master.as_ref(), at) {
                return None;
            }
            let farthest = self.closes_within(k, sides, at);
            self.pair(k, sides, (master.as_ref(), farthest), is_closed).1
        };
        let count = self.sites.len();
        let is_curve = parts == 3 && sides.slave.0.curve(self.slave.group.as_deref()).is_some();
        let passes_on = linearises && is_curve && self.sampling == Sampling::Nodes;
        let at_once = if passes_on { count.max(1) } else { AT_ONCE };
        let found_in = |first: usize| -> Vec<_> {
            let end = (first + at_once).min(count);
            let found = (first..end).into_par_iter().map(find).collect::<Vec<Option<Result<MeasuredPair, NoPair>>>>();
            let redistributed =
                if passes_on { self.redistributed_friction(&found, lambda) } else { vec![[0.0; 2]; found.len()] };
            found.into_iter().zip(redistributed).collect()
        };
        for (k, (found, redistributed)) in (0..count).step_by(at_once).flat_map(found_in).enumerate() {
            let own = |i: usize| first + (parts * k + i) as u32;
            let at = self.law.multiplier(k, lambda);
            let w = self.sites[k].weight;
            let c = self.law.stiffness[k];
            let touch = match found {
                Some(Ok(touch)) => touch,
                found => {
                    lost += usize::from(matches!(found, Some(Err(NoPair::NoCoordinates))));
                    self.law.add_equations(k, own(0), at, None, out);
                    continue;
                }
            };
            // Along a curve that is drawn the tension tells which way points slip: what one does not hold the next one has to.
            let found = self.traction(k, &touch, at, (redistributed, linearises && !is_curve));
            let pair = &touch.pair;
            let [p, t1, t2] = found.projected.traction;
            let on_slave = found.axes[0] * t1 + found.axes[1] * t2;
            let n = pair.unknowns.len();
            for (a, &unknown) in pair.unknowns.iter().enumerate() {
                let friction = if parts == 3 { w * on_slave.dot(&pair.slip[a]) } else { 0.0 };
                let force = -w * p * pair.opening[a] + friction;
                out.residual[unknown as usize] += force;
                out.sizes[unknown as usize] += (w * p * pair.opening[a]).abs() + friction.abs();
            }
            self.law.add_equations(k, own(0), at, Some(&found.projected), out);
            let Some(tangent) = out.tangent.as_mut().filter(|_| found.projected.status != Status::Open) else {
                continue;
            };
            // Derivatives of the trial in the unknowns of the pair.
            let d_trial: Vec<[f64; 3]> = (0..n)
                .map(|b| {
                    let along =
                        |i: usize| c * (found.d_axes[b][i].dot(&pair.elastic) + found.axes[i].dot(&pair.d_elastic[b]));
                    let t = if parts == 3 { [along(0), along(1)] } else { [0.0; 2] };
                    let s = touch
                        .stress
                        .as_ref()
                        .map_or([0.0; 3], |s| s.change(b, (&pair.normal, &found.axes), pair, &found.d_axes));
                    [s[0] - c * pair.d_gap[b], s[1] + t[0], s[2] + t[1]]
                })
                .collect();
            let derivative = &found.projected.derivative;
            let d_traction: Vec<[f64; 3]> = (d_trial.iter())
                .map(|d| std::array::from_fn(|i| (0..3).map(|j| derivative[i][j] * d[j]).sum()))
                .collect();
            let along = |a: usize, i: usize| if parts == 3 { found.axes[i].dot(&pair.slip[a]) } else { 0.0 };
            let bent = if parts == 3 { pair.slip_hessian(&on_slave) } else { Vec::new() };
            let mut block = vec![0.0; n * n];
            for a in 0..n {
                for b in 0..n {
                    let mut v = -p * pair.d_opening[a * n + b] - d_traction[b][0] * pair.opening[a];
                    if parts == 3 {
                        v += d_traction[b][1] * along(a, 0) + d_traction[b][2] * along(a, 1);
                        let turned = found.d_axes[b][0] * t1 + found.d_axes[b][1] * t2;
                        v += turned.dot(&pair.slip[a]) + bent[a * n + b];
                    }
                    block[a * n + b] = w * v;
                }
            }
            tangent.add_block(&pair.unknowns, &block);
            // What of the trial follows the unknown itself.
            let follows = 1.0 - self.law.softness;
            for i in 0..parts {
                for (a, &unknown) in pair.unknowns.iter().enumerate() {
                    let mut column = -derivative[0][i] * pair.opening[a];
                    if parts == 3 {
                        column += derivative[1][i] * along(a, 0) + derivative[2][i] * along(a, 1);
                    }
                    tangent.add(unknown, own(i), w * follows * column);
                    tangent.add(own(i), unknown, w / c * d_traction[a][i]);
                }
            }
        }
        Ok(lost)
    }
}

/// Sites whose pairs are kept at a time.
const AT_ONCE: usize = 256;
