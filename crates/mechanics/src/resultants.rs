//! Resultants of forces on the unknowns of bodies where they are, along the unit motions of each body: of supports and others.

use crate::body::{Body, BodyState, Contribution, Hold, Order};
use crate::increment_error::IncrementError;
use crate::system::{Assembled, AssemblyError, Held, System, SystemState};
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

/// The groups of a curve that are one of its ends.
const ENDS: [&str; 2] = ["start", "end"];

impl System {
    /// What the supports and loads at both ends of each curve do to it, of the residual at a state: the force in the curve
    /// there, without what acts on half a cell. None of ends that are free or held in part, nor of what is no curve.
    pub(crate) fn end_forces(&self, at: &Assembled, state: &SystemState, time: f64) -> Vec<[Option<Vector<3>>; 2]> {
        (0..self.bodies.len())
            .map(|body| match self.bodies[body].curve(None) {
                Some(_) => ENDS.map(|end| self.end_force(at, state, time, (body, end))),
                None => [None; 2],
            })
            .collect()
    }

    fn end_force(
        &self,
        at: &Assembled,
        state: &SystemState,
        time: f64,
        (body, end): (usize, &str),
    ) -> Option<Vector<3>> {
        let (first, own) = (self.numbering().0[body], &state.bodies[body]);
        let still = |_: &_| 0.0;
        let still: &dyn Fn(&_) -> f64 = &still;
        let hold = Hold { displacement: [Some(still); 3], ..Hold::default() };
        let constraints = self.bodies[body].hold(Some(end), &hold, own).ok()?;
        let [x, y, z] = &constraints[..] else { return None };
        let terms = [x, y, z].map(|constraint| constraint.terms[0]);
        let mut loads = Contribution::new(self.bodies[body].unknowns());
        let is_here = |load: &&crate::PlacedLoad| load.part.body == body && load.part.group.as_deref() == Some(end);
        for load in self.loads.iter().filter(is_here) {
            load.act(self.bodies[body].as_ref(), own, time, Order::First, &mut loads).ok()?;
        }
        let mut reaction = Vector::<3>::zeros();
        let mut held = 0;
        for (k, (unknown, factor)) in terms.iter().enumerate() {
            if at.coupled.iter().any(|h| h.constraint.terms.iter().any(|term| term.0 == first + unknown)) {
                return None;
            }
            if at.single.iter().any(|h| h.constraint.terms[0].0 == first + unknown) {
                reaction[k] = at.residual[(first + unknown) as usize] / factor;
                held += 1;
            }
        }
        let load = Vector::<3>::from_fn(|k, _| -loads.forces[terms[k].0 as usize] / terms[k].1);
        match held {
            3 => Some(reaction + load),
            0 if load != Vector::<3>::zeros() => Some(load),
            _ => None,
        }
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
