//! What contacts need before the first increment: scales of penalties, and where slips count from.

use crate::increment::IncrementError;
use crate::system::System;

/// Stiffness of a half-space against a pressure wave as long as a cell is deep, `k E / (2 - 2ν²)` with `k = 2π/h`, in those
/// of a cell, `E/h`: less for trials, and sites are opened and closed by the tractions of the last step alone.
pub(crate) const WAVE: f64 = std::f64::consts::PI;

impl System {
    /// Prepares the contacts: scales of penalties, and where slips count from. To be called once, when all bodies, loads and
    /// contacts are there.
    ///
    /// # Errors
    /// Places that are not there.
    pub fn prepare(&mut self) -> Result<(), IncrementError> {
        let finite = |contacts: &[crate::contact::Contact]| {
            let list = contacts.iter().flat_map(|c| c.stiffness.iter().zip(c.sites()).map(|(c, s)| c * s.weight));
            list.filter(|c| c.is_finite()).fold(0.0f64, f64::max)
        };
        let mut scale = finite(&self.contacts);
        for contact in &self.contacts {
            // A deformable master of a rigid slave.
            let master = &self.bodies[contact.master.body];
            let sites = master.sites(contact.master.group.as_deref(), crate::body::Sampling::Nodes);
            let list = sites.unwrap_or_default();
            let most = list.iter().map(|s| master.site_stiffness(s)).filter(|c| c.is_finite()).fold(0.0, f64::max);
            scale = scale.max(most);
        }
        // Between rigid bodies any scale serves; that of one force per length is neither large nor small.
        let scale = if scale > 0.0 { scale } else { 1.0 / self.size().max(f64::MIN_POSITIVE) };
        for contact in &mut self.contacts {
            let weights: Vec<f64> = contact.sites().iter().map(|s| s.weight).collect();
            for (c, w) in contact.stiffness.iter_mut().zip(weights) {
                *c = WAVE * if c.is_finite() { *c } else { scale / w };
            }
        }
        self.leave_out_held_sites()?;
        // Slips count from the start, where nothing carries yet.
        self.accept(&self.start())?;
        for contact in &mut self.contacts {
            contact.memory.iter_mut().for_each(|m| m.traction = [0.0; 3]);
        }
        Ok(())
    }

    /// Leaves out sites that cannot move against a body that does not: supports carry there, and what the contact would
    /// carry is not determined.
    fn leave_out_held_sites(&mut self) -> Result<(), IncrementError> {
        let start = self.start();
        let (single, _) = self.held(&start, 0.0)?;
        let (first, count) = self.numbering();
        let mut held = vec![false; count];
        single.iter().for_each(|h| held[h.constraint.terms[0].0 as usize] = true);
        let bodies = &self.bodies;
        for contact in self.contacts.iter_mut().filter(|c| bodies[c.master.body].unknowns() == 0) {
            let (body, first) = (&bodies[contact.slave.body], first[contact.slave.body]);
            let moves = |site: &crate::body::Site| {
                let placed = body.placed(&start.bodies[contact.slave.body], site);
                placed.functions.iter().any(|f| !held[(first + f.unknown) as usize])
            };
            let kept: Vec<bool> = contact.sites().iter().map(moves).collect();
            contact.keep(&kept);
        }
        Ok(())
    }
}
