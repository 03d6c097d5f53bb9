//! What a system goes on from, as plain numbers: enough for the same digits.

use crate::body::{BodyState, MaterialPoint};
use crate::contact::SiteMemory;
use crate::pair::Stuck;
use crate::system::{System, SystemState};
use signorini_geometry::Vector;

/// A state of a system with the memory of its contacts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Saved {
    /// Configuration and internal numbers of each body.
    pub bodies: Vec<[Vec<f64>; 2]>,
    pub multipliers: Vec<f64>,
    pub reactions: Vec<f64>,
    /// Of each contact the memories of its sites, one after the other, and the scales of its sites with the time.
    pub contacts: Vec<[Vec<f64>; 2]>,
}

/// Numbers of the memory of a site.
const NUMBERS: usize = 16;

fn numbers(memory: &SiteMemory) -> [f64; NUMBERS] {
    let mut out = [0.0; NUMBERS];
    out[..3].copy_from_slice(&memory.traction);
    out[3..5].copy_from_slice(&memory.slip);
    if let Some(stuck) = &memory.stuck {
        out[5] = 1.0;
        out[6] = f64::from(stuck.point.patch);
        out[7..10].copy_from_slice(&stuck.point.xi);
        out[10..13].copy_from_slice(stuck.on_slave.as_slice());
        out[13..].copy_from_slice(stuck.on_master.as_slice());
    }
    out
}

fn memory(n: &[f64]) -> SiteMemory {
    let vector = |k: usize| Vector::<3>::new(n[k], n[k + 1], n[k + 2]);
    SiteMemory {
        traction: [n[0], n[1], n[2]],
        slip: [n[3], n[4]],
        stuck: (n[5] != 0.0).then(|| Stuck {
            point: MaterialPoint { patch: n[6] as u32, xi: [n[7], n[8], n[9]] },
            on_slave: vector(10),
            on_master: vector(13),
        }),
    }
}

impl System {
    /// What to go on from after a state that was accepted.
    pub fn save(&self, state: &SystemState) -> Saved {
        Saved {
            bodies: state.bodies.iter().map(|b| [b.configuration.clone(), b.internal.clone()]).collect(),
            multipliers: state.multipliers.clone(),
            reactions: state.reactions.clone(),
            contacts: (self.contacts.iter())
                .map(|c| {
                    let scales = c.stiffness.iter().copied().chain([c.times[0]]).collect();
                    [c.memory.iter().flat_map(numbers).collect(), scales]
                })
                .collect(),
        }
    }

    /// Goes on from what was saved; none where that is not of this system.
    pub fn restore(&mut self, saved: Saved) -> Option<SystemState> {
        let mut state = self.start();
        let fits = saved.bodies.len() == state.bodies.len()
            && (saved.bodies.iter().zip(&state.bodies))
                .all(|(s, b)| s[0].len() == b.configuration.len() && s[1].len() == b.internal.len())
            && saved.multipliers.len() == state.multipliers.len()
            && saved.contacts.len() == self.contacts.len()
            && (saved.contacts.iter().zip(&self.contacts))
                .all(|(s, c)| s[0].len() == NUMBERS * c.memory.len() && s[1].len() == c.stiffness.len() + 1);
        if !fits {
            return None;
        }
        let body = |[configuration, internal]: [Vec<f64>; 2]| BodyState { configuration, internal };
        state.bodies = saved.bodies.into_iter().map(body).collect();
        (state.multipliers, state.reactions) = (saved.multipliers, saved.reactions);
        for (contact, [sites, scales]) in self.contacts.iter_mut().zip(saved.contacts) {
            contact.memory = sites.chunks(NUMBERS).map(memory).collect();
            let count = contact.stiffness.len();
            contact.stiffness.copy_from_slice(&scales[..count]);
            contact.times = [scales[count]; 2];
        }
        Some(state)
    }

    /// The force of a load at a time, and its moment about the origin.
    ///
    /// # Errors
    /// A load that cannot act where it is.
    pub fn load_resultant(
        &self,
        load: usize,
        state: &SystemState,
        time: f64,
    ) -> Result<[Vector<3>; 2], crate::body::PlaceError> {
        let load = &self.loads[load];
        let body = &self.bodies[load.part.body];
        let own = &state.bodies[load.part.body];
        let mut out = crate::body::Contribution::new(body.unknowns());
        load.act(body.as_ref(), own, time, crate::body::Order::First, &mut out)?;
        let modes = body.rigid_modes(own);
        let along = |k: usize| -out.forces.iter().zip(&modes[k]).map(|(f, m)| f * m).sum::<f64>();
        Ok([Vector::<3>::from_fn(|i, _| along(i)), Vector::<3>::from_fn(|i, _| along(3 + i))])
    }
}
