//! Resultants of forces on the unknowns of bodies where they are, along the unit motions of each body: of supports and others.

use crate::body::{Body, BodyState, Contribution, Hold, Order};
use crate::increment_error::IncrementError;
use crate::system::{AssemblyError, Held, System, SystemState};
use signorini_geometry::Vector;

/// A scalar product over unknowns.
pub(crate) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The resultant of forces on the unknowns of a body in a state, and its moment about the origin.
pub(crate) fn resultant(body: &dyn Body, state: &BodyState, forces: &[f64]) -> [Vector<3>; 2] {
    let modes = body.rigid_modes(state);
    let along = |mode: usize| dot(forces, &modes[mode]);
    [Vector::<3>::from_fn(|i, _| along(i)), Vector::<3>::from_fn(|i, _| along(3 + i))]
}

impl System {
    /// The force in a curve at both of its ends: of what holds, pulls or touches it right there, without what acts on half a cell.
    /// None of closed curves and other bodies.
    pub fn end_forces(&self, number: usize, state: &SystemState, time: f64) -> Option<[Vector<3>; 2]> {
        let (body, own) = (self.bodies[number].as_ref(), &state.bodies[number]);
        body.curve(None)?;
        let mut out = Contribution::new(body.unknowns());
        body.internal(own, Order::First, &mut out).ok()?;
        for load in self.loads.iter().filter(|l| l.part.body == number && l.part.group.is_none()) {
            load.act(body, own, time, Order::First, &mut out).ok()?;
        }
        let still: &dyn Fn(&_) -> f64 = &|_| 0.0;
        let hold = Hold { displacement: [Some(still); 3], ..Hold::default() };
        let at = |end: &str| {
            let constraints = body.hold(Some(end), &hold, own).ok()?;
            let [x, y, z] = &constraints[..] else { return None };
            let forces = [x, y, z].map(|c| out.forces[c.terms[0].0 as usize] / c.terms[0].1);
            Some(Vector::<3>::from(forces))
        };
        Some([at("start")?, at("end")?])
    }

    /// The moment of each support on its body about the origin, in a state at a time.
    ///
    /// # Errors
    /// States and places that cannot be.
    pub fn support_moments(&self, state: &SystemState, time: f64) -> Result<Vec<Vector<3>>, IncrementError> {
        let (first, _) = self.numbering();
        let at = self.assemble(state, time, Order::First)?;
        let mut forces: Vec<Vec<f64>> =
            self.supports.iter().map(|s| vec![0.0; self.bodies[s.part.body].unknowns()]).collect();
        let mut add = |held: &Held, unknown: u32, force: f64| {
            let Some(support) = held.support() else { return };
            let own = unknown - first[self.supports[support].part.body];
            forces[support][own as usize] += force;
        };
        for held in &at.single {
            let (unknown, _) = held.constraint.terms[0];
            add(held, unknown, at.residual[unknown as usize]);
        }
        for (held, reaction) in at.coupled.iter().zip(&state.reactions) {
            held.constraint.terms.iter().for_each(|(unknown, factor)| add(held, *unknown, -factor * reaction));
        }
        let moment = |(support, mut forces): (&crate::Support, Vec<f64>)| {
            let (body, own) = (&self.bodies[support.part.body], &state.bodies[support.part.body]);
            let mut out = Contribution::new(body.unknowns());
            let on = support.part.group.as_deref();
            support
                .at(time, |hold| body.hold_weakly(on, hold, own, Order::First, &mut out))
                .map_err(AssemblyError::from)?;
            forces.iter_mut().zip(&out.forces).for_each(|(f, weak)| *f -= weak);
            Ok(resultant(body.as_ref(), own, &forces)[1])
        };
        self.supports.iter().zip(forces).map(moment).collect()
    }
}
