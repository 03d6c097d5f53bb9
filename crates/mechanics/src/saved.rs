//! What a system goes on from, as plain numbers: enough for the same digits.

use crate::body::{BodyState, Contribution, PlaceError};
use crate::points::Order;
use crate::resultants::resultant;
use crate::system::{System, SystemState};
use signorini_geometry::Vector;

/// A state of a system with the memory of its contacts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Saved {
    /// Configuration and internal numbers of each body.
    pub bodies: Vec<[Vec<f64>; 2]>,
    pub multipliers: Vec<f64>,
    pub reactions: Vec<f64>,
    pub time: f64,
    /// History and scales of each contact.
    pub contacts: Vec<[Vec<f64>; 2]>,
    /// Velocities, both accelerations, and what equilibrium lacks; none at rest.
    pub motion: [Vec<f64>; 4],
    /// Energy that is still to be taken from the velocities of each body.
    pub owed: Vec<f64>,
}

impl System {
    /// What to go on from after a state that was accepted.
    pub fn save(&self, state: &SystemState) -> Saved {
        Saved {
            bodies: state.bodies.iter().map(|b| [b.configuration.clone(), b.internal.clone()]).collect(),
            multipliers: state.multipliers.clone(),
            reactions: state.reactions.clone(),
            time: state.time,
            contacts: self.contacts.iter().map(|c| c.history()).collect(),
            motion: [&state.velocities, &state.accelerations, &state.balancing, &state.forces].map(Vec::clone),
            owed: state.owed.clone(),
        }
    }

    /// Goes on from what was saved; none where that is not of this system.
    pub fn restore(&mut self, saved: Saved) -> Option<SystemState> {
        let mut state = self.start();
        let (_, unknowns) = self.numbering();
        let fits = saved.bodies.len() == state.bodies.len()
            && saved.motion.iter().all(|list| list.is_empty() || list.len() == unknowns)
            && (saved.owed.is_empty() || saved.owed.len() == state.bodies.len())
            && (saved.bodies.iter().zip(&state.bodies))
                .all(|(s, b)| s[0].len() == b.configuration.len() && s[1].len() == b.internal.len())
            && saved.multipliers.len() == state.multipliers.len()
            && saved.contacts.len() == self.contacts.len();
        if !fits {
            return None;
        }
        let body = |[configuration, internal]: [Vec<f64>; 2]| BodyState { configuration, internal };
        state.bodies = saved.bodies.into_iter().map(body).collect();
        (state.multipliers, state.reactions, state.time) = (saved.multipliers, saved.reactions, saved.time);
        [state.velocities, state.accelerations, state.balancing, state.forces] = saved.motion;
        state.owed = saved.owed;
        let before = self.histories();
        for (contact, history) in self.contacts.iter_mut().zip(&saved.contacts) {
            if contact.restore(history).is_err() {
                self.put_back(&before);
                return None;
            }
        }
        Some(state)
    }

    /// What all contacts keep, to be put back.
    pub fn histories(&self) -> Vec<[Vec<f64>; 2]> {
        self.contacts.iter().map(|c| c.history()).collect()
    }

    /// Puts back what all contacts kept.
    pub fn put_back(&mut self, histories: &[[Vec<f64>; 2]]) {
        for (contact, history) in self.contacts.iter_mut().zip(histories) {
            // Its own numbers fit.
            contact.restore(history).unwrap_or_else(|error| unreachable!("{error}"));
        }
    }

    /// The force of a load at a time, and its moment about the origin.
    ///
    /// # Errors
    /// A load that cannot act where it is.
    pub fn load_resultant(&self, load: usize, state: &SystemState, time: f64) -> Result<[Vector<3>; 2], PlaceError> {
        let body = self.loads[load].part.body;
        let forces = self.load_forces(load, state, time)?;
        Ok(resultant(self.bodies[body].as_ref(), &state.bodies[body], &forces))
    }

    /// The force of a load at a time on each unknown of its body.
    ///
    /// # Errors
    /// A load that cannot act where it is.
    pub fn load_forces(&self, load: usize, state: &SystemState, time: f64) -> Result<Vec<f64>, PlaceError> {
        let load = &self.loads[load];
        let body = &self.bodies[load.part.body];
        let mut out = Contribution::new(body.unknowns());
        load.act(body.as_ref(), &state.bodies[load.part.body], time, Order::First, &mut out)?;
        Ok(out.forces.into_iter().map(|f| -f).collect())
    }
}
