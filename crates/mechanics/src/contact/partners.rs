//! What every site faces during an increment, where pairs are kept.

use super::axes::STEEP;
use super::partner::{Pairing, Partner};
use super::{Contact, Sides};
use crate::body::PlaceError;
use crate::pair::{AxisChoice, any_tangent};
use crate::points::Master;
use rayon::prelude::*;
use signorini_geometry::Vector;

impl Contact {
    /// What may be touched, ready for many searches; what every site faces in this increment is found where pairs are kept.
    pub(super) fn met<'a>(&self, sides: &Sides<'a>) -> Result<Box<dyn Master + 'a>, PlaceError> {
        let master = sides.master.0.master(self.master.group.as_deref(), sides.master.1)?;
        if self.partners.get().is_none() {
            master.prepare();
            if self.pairing == Pairing::AtStart {
                self.find_partners(sides, master.as_ref());
            }
        }
        Ok(master)
    }

    fn find_partners(&self, sides: &Sides<'_>, master: &dyn Master) {
        let of = |k: usize| {
            let (placed, found) = self.pair_now(k, sides, (master, f64::INFINITY), |_| false);
            let pair = found?.ok()?.pair;
            let (normal, apart) = (pair.normal, placed.x - master.at(&pair.point).x);
            let radii = normal.dot(&apart) - pair.gap;
            Some(Partner { point: pair.point, normal, along: self.first_axis(k, &normal), radii, apart })
        };
        let found = (0..self.sites.len()).into_par_iter().map(of).collect();
        self.partners.get_or_init(|| found);
    }

    /// The first axis of friction across a normal: as stated, or that of the last increment.
    fn first_axis(&self, k: usize, normal: &Vector<3>) -> Vector<3> {
        let direction = match self.axis {
            AxisChoice::OnSlave(v) | AxisChoice::OnMaster(v) => Some(v),
            _ => self.memory[k].stuck.map(|s| s.on_slave),
        };
        let across = direction.and_then(|v| (v - normal * normal.dot(&v)).try_normalize(STEEP * v.norm()));
        across.unwrap_or_else(|| any_tangent(normal))
    }
}
