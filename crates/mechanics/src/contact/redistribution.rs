//! Friction that a node of a curve cannot bear, and that the next ones have to.
//!
//! A curve that is drawn along something slides from its end on, and sticks farther on. In a linear system the first node that
//! sticks bears all that those before it do not, and hides it from those behind: from system to system one more node would
//! slide. What is beyond the limit of a node the tension of the curve passes on to the next one, up to where it ends. With the
//! friction that is so passed on to it each node knows whether it slides. Nodes that would slide back are made to stick first:
//! they have slid no farther than what was passed on to them.

use super::axes::axes;
use super::traction::Traction;
use super::{Contact, MeasuredPair};
use crate::pair::NoPair;
use signorini_contact::{Law, Status};
use signorini_geometry::Vector;

impl Contact {
    /// The friction that is passed on to each site of a curve, along its axes, in the order of the curve.
    pub(super) fn redistributed_friction(
        &self,
        found: &[Option<Result<MeasuredPair, NoPair>>],
        lambda: &[f64],
    ) -> Vec<[f64; 2]> {
        let mut redistributed = vec![[0.0; 2]; found.len()];
        let Some(law) = self.law.friction.as_deref() else { return redistributed };
        let sites: Vec<Option<Loaded>> = (found.iter().enumerate())
            .map(|(k, touch)| {
                let touch = touch.as_ref()?.as_ref().ok()?;
                let at = self.law.multiplier(k, lambda);
                let Traction { projected: found, trial, .. } = self.traction(k, touch, at, ([0.0; 2], false));
                if found.status == Status::Slip && at[1] * found.traction[1] + at[2] * found.traction[2] < 0.0 {
                    redistributed[k] = trial.map(|t| -t);
                    return None;
                }
                (found.status != Status::Open).then(|| Loaded {
                    status: found.status,
                    weight: self.sites[k].weight,
                    pressure: found.traction[0],
                    friction: [at[1], at[2]],
                    axes: axes(&touch.pair).0,
                })
            })
            .collect();
        for (k, site) in sites.iter().enumerate() {
            let Some(site) = site else { continue };
            let mut beyond = site.beyond(law, [0.0; 2]);
            if beyond.norm() == 0.0 {
                continue;
            }
            // What slides beside it has passed this on to it: the one on the other side has to bear it.
            let beside = [k.checked_sub(1), Some(k + 1)].map(|j| Some((j?, sites.get(j?)?.as_ref()?)));
            let borne = |s: &Loaded| s.along().dot(&beyond) / s.pressure;
            let least = beside.into_iter().flatten().min_by(|p, q| borne(p.1).total_cmp(&borne(q.1)));
            let Some((next, _)) = least.filter(|(_, s)| s.status == Status::Stick) else { continue };
            let step = |j: usize| if next > k { Some(j + 1) } else { j.checked_sub(1) };
            let mut at = Some(next);
            while let Some((j, site)) = at.and_then(|j| Some((j, sites.get(j)?.as_ref()?))) {
                let more = site.axes.map(|e| e.dot(&beyond));
                let (size, whole) = (more[0].hypot(more[1]), beyond.norm());
                if whole == 0.0 || size == 0.0 {
                    break;
                }
                let before = site.beyond(law, redistributed[j]);
                (0..2).for_each(|a| redistributed[j][a] += more[a] * whole / (size * site.weight));
                beyond = site.beyond(law, redistributed[j]) - before;
                at = step(j);
            }
        }
        redistributed
    }
}

/// A closed site.
struct Loaded {
    status: Status,
    weight: f64,
    pressure: f64,
    friction: [f64; 2],
    axes: [Vector<3>; 2],
}

impl Loaded {
    /// Its friction, along the slip.
    fn along(&self) -> Vector<3> {
        self.axes[0] * self.friction[0] + self.axes[1] * self.friction[1]
    }

    /// The force beyond the limit of friction, along the slip.
    fn beyond(&self, law: &dyn Law, redistributed: [f64; 2]) -> Vector<3> {
        let trial = [0, 1].map(|a| self.friction[a] + redistributed[a]);
        let [_, t1, t2] = law.project([self.pressure, trial[0], trial[1]]).traction;
        (self.axes[0] * (trial[0] - t1) + self.axes[1] * (trial[1] - t2)) * self.weight
    }
}
