//! What contacts need before the first increment: scales of penalties, and where slips count from.

use crate::contact_law::ContactLaw;
use crate::increment_error::IncrementError;
use crate::interaction::Bodies;
use crate::linear_bodies::LinearBodies;
use crate::surface::Faces;
use crate::system::{AssemblyError, System};

impl System {
    /// Prepares the contacts: scales of penalties, and where slips count from. To be called once, when all bodies, loads and
    /// contacts are there.
    ///
    /// # Errors
    /// Places that are not there.
    pub fn prepare(&mut self) -> Result<(), IncrementError> {
        self.linear = LinearBodies::default();
        let scale = self.contacts.iter().map(|c| c.stiffness(&self.bodies)).fold(0.0f64, f64::max);
        // Between rigid bodies any scale serves; that of one force per length is neither large nor small.
        let scale = if scale > 0.0 { scale } else { 1.0 / self.size().max(f64::MIN_POSITIVE) };
        self.contacts.iter_mut().for_each(|contact| contact.prepare(&self.bodies, scale));
        let bonds = |law: &ContactLaw| law.friction.as_ref().is_some_and(|law| law.is_bond());
        for contact in &mut self.contacts {
            contact.law_mut().steepen();
            if !bonds(contact.law()) {
                continue;
            }
            let part = contact.parts()[0];
            let body = &self.bodies[part.body];
            let start = body.start();
            let surface = body.surface(part.group.as_deref(), &start);
            let is_plane = surface.is_some_and(|surface| matches!(surface.faces().0, Faces::Plane(_)));
            let count = contact.law().areas.len().max(1) as f64;
            let spacing = body.size() / if is_plane { count } else { count.sqrt() };
            contact.law_mut().spacing = spacing;
        }
        // What cannot move carries nothing: supports carry there, and what the contact would carry is not determined.
        let start = self.start();
        let (single, _) = self.held(&start.bodies, 0.0).map_err(IncrementError::Assembly)?;
        let (first, count) = self.numbering();
        let mut held = vec![false; count];
        // What is free at another time may carry then.
        let lasting = single.iter().filter(|h| h.support().is_none_or(|k| self.supports[k].is_permanent()));
        lasting.for_each(|h| held[h.constraint.terms[0].0 as usize] = true);
        let at = Bodies { bodies: &self.bodies, states: &start.bodies, first: &first };
        self.contacts.iter_mut().for_each(|contact| contact.leave_out_held(at, &held));
        // Slips count from the start, where nothing carries yet.
        self.accept(&self.start())?;
        self.contacts.iter_mut().for_each(|contact| contact.forget_tractions());
        Ok(())
    }

    /// Takes a state as the one from which slips count and the next increment starts.
    ///
    /// # Errors
    /// Places that are not there.
    pub fn accept(&mut self, state: &crate::system::SystemState) -> Result<(), IncrementError> {
        let (first, _) = self.numbering();
        let own = self.own(state);
        let at = Bodies { bodies: &self.bodies, states: &state.bodies, first: &first };
        for (contact, own) in self.contacts.iter_mut().zip(own) {
            contact.accept(at, own).map_err(AssemblyError::from)?;
        }
        Ok(())
    }
}
