//! What a contact is found as in a state, and what it remembers of it.

use super::axes::axes;
use super::{Contact, Sides, SiteMemory};
use crate::body::PlaceError;
use crate::pair::Pair;
use crate::points::{Master, MaterialPoint, SlavePoint};
use crate::site_result::SiteResult;
use rayon::prelude::*;
use signorini_contact::Status;
use signorini_geometry::Vector;

impl Contact {
    /// The sites as they are found in a state, with their tractions along the axes.
    ///
    /// # Errors
    /// A master that cannot be touched.
    pub(crate) fn found(&self, sides: &Sides<'_>, lambda: &[f64]) -> Result<Vec<(SiteResult, [f64; 3])>, PlaceError> {
        let master = self.met(sides)?;
        let of = |k: usize| {
            let (placed, pair) = self.pair(k, sides, (master.as_ref(), f64::INFINITY), |_| false);
            let (x, radius) = (placed.x, placed.radius);
            let mut out = SiteResult { x, radius, weight: self.sites[k].weight, ..SiteResult::default() };
            let Some(Ok(touch)) = pair else { return (out, [0.0; 3]) };
            let found = self.traction(k, &touch, self.law.multiplier(k, lambda), ([0.0; 2], false));
            let pair = &touch.pair;
            let [p, t1, t2] = found.projected.traction;
            out.normal = pair.normal;
            (out.gap, out.worn) = self.law.gap_and_wear(pair.gap, &found.next);
            out.pressure = p;
            out.status = found.projected.status;
            // The traction of the law is that along the slip; on the slave acts its opposite.
            out.friction = -(found.axes[0] * t1 + found.axes[1] * t2);
            if let Some(law) =
                self.law.friction.as_ref().filter(|law| law.is_tangential() && out.status != Status::Open)
            {
                if placed.tangent.is_some() && placed.radius > 0.0 && placed.spin.is_empty() {
                    out.on_centre_line = Some(on_centre_line(&placed, sides.first[0], pair, &out.friction));
                }
                out.increment = found.axes[0] * found.slip[0] + found.axes[1] * found.slip[1];
                out.utilisation = law.utilisation([t1, t2], p);
                let before = self.memory[k].slip;
                out.slip = (before[0] + found.slip[0]).hypot(before[1] + found.slip[1]);
            }
            (out, found.projected.traction)
        };
        Ok((0..self.sites.len()).into_par_iter().map(of).collect())
    }

    /// The rotation vectors of slave and master, of rigid bodies.
    fn turns(&self, sides: &Sides<'_>, master: &dyn Master) -> [Vector<3>; 2] {
        let slave = self.sites.first().and_then(|site| sides.slave.0.placed(sides.slave.1, site).turn);
        let master = sides.master.0.is_rigid().then(|| master.at(&MaterialPoint::default()).turning).flatten();
        [slave.unwrap_or_default(), master.map_or(Vector::<3>::zeros(), |own| own.turn)]
    }

    /// Takes a state as the one that slips count from.
    ///
    /// # Errors
    /// A master that cannot be touched.
    pub(crate) fn accept_sites(&mut self, sides: &Sides<'_>, lambda: &[f64]) -> Result<(), PlaceError> {
        let master = self.met(sides)?;
        let now = self.turns(sides, master.as_ref());
        let (mut memory, mut tractions, mut history) = (Vec::new(), Vec::new(), Vec::new());
        for k in 0..self.sites.len() {
            let (placed, found) = self.pair(k, sides, (master.as_ref(), f64::INFINITY), |_| false);
            let Some(Ok(touch)) = found else {
                memory.push(SiteMemory::default());
                history.push(self.law.remembered(k, None));
                tractions.push([0.0; 3]);
                continue;
            };
            let found = self.traction(k, &touch, self.law.multiplier(k, lambda), ([0.0; 2], false));
            let pair = &touch.pair;
            let is_open = found.projected.status == Status::Open;
            // What is beside the site is not what it will meet.
            let is_beside = is_open && pair.is_beside && placed.outward.is_some() && !sides.slave.0.is_rigid();
            let mut own = SiteMemory { stuck: pair.stuck.filter(|_| !is_beside), slip: [0.0; 2] };
            let mut traction = found.projected.traction;
            if self.law.is_tangential() && found.projected.status != Status::Open {
                let before = self.memory[k].slip;
                own.slip = std::array::from_fn(|i| before[i] + found.slip[i]);
                // Friction is kept along the axes of the new anchor.
                let on_slave = found.axes[0] * traction[1] + found.axes[1] * traction[2];
                let slipped = found.axes[0] * own.slip[0] + found.axes[1] * own.slip[1];
                let (anchored, turned) = (self.memory[k].stuck, self.turned);
                (self.memory[k].stuck, self.turned) = (own.stuck, now);
                if let (_, Some(Ok(again))) = self.pair(k, sides, (master.as_ref(), f64::INFINITY), |_| false) {
                    let (new, _) = axes(&again.pair);
                    traction = [traction[0], new[0].dot(&on_slave), new[1].dot(&on_slave)];
                    own.slip = new.map(|e| e.dot(&slipped));
                }
                (self.memory[k].stuck, self.turned) = (anchored, turned);
            }
            memory.push(own);
            history.push(found.next);
            tractions.push(traction);
        }
        (self.memory, self.turned) = (memory, now);
        self.law.history = history;
        self.law.accept(tractions);
        Ok(())
    }
}

/// Friction as it acts on a point that it moves by `slip` per unit of each unknown: by the unknown that moves the point most along
/// each axis.
fn on_centre_line(placed: &SlavePoint, first: u32, pair: &Pair, friction: &Vector<3>) -> Vector<3> {
    Vector::from_fn(|i, _| {
        let Some(by) = placed.functions.iter().max_by(|a, b| a.value[i].abs().total_cmp(&b.value[i].abs())) else {
            return 0.0;
        };
        let place = pair.unknowns.iter().position(|unknown| *unknown == first + by.unknown);
        place.map_or(0.0, |a| friction.dot(&pair.slip[a]) / by.value[i])
    })
}
