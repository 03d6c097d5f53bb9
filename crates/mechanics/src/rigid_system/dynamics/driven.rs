//! What is prescribed in a step: poses of bodies, and what supports ask for, with their velocities by differences of second order.

use crate::body::{Body, BodyState};
use crate::rigid_body::Pose;
use crate::rigid_system::touching::Twists;
use crate::rotation;
use crate::system::{AssemblyError, Held, System};
use signorini_geometry::Vector;

/// The motions that are prescribed between two times: at both, and in the middle.
pub struct Driven {
    pub times: [f64; 3],
    poses: [Vec<Option<Pose>>; 3],
}

impl Driven {
    pub fn new(system: &System, bodies: &[BodyState], [from, to]: [f64; 2]) -> Self {
        let times = [from, 0.5 * (from + to), to];
        let poses = times.map(|time| {
            let own = |(body, state): (&dyn Body, &BodyState)| {
                let mut state = state.clone();
                (body.unknowns() == 0).then(|| {
                    body.prescribe(time, &mut state);
                    Pose::of(&state)
                })
            };
            system.bodies.iter().map(Box::as_ref).zip(bodies).map(own).collect()
        });
        Driven { times, poses }
    }

    /// Puts the bodies that are prescribed where they are at the start, in the middle or at the end.
    pub fn place(&self, which: usize, bodies: &mut [BodyState]) {
        for (state, pose) in bodies.iter_mut().zip(&self.poses[which]) {
            if let Some(pose) = pose {
                *state = pose.state();
            }
        }
    }

    fn twists(&self, of: impl Fn([&Pose; 3]) -> [Vector<3>; 2]) -> Twists {
        let [a, b, c] = &self.poses;
        let each = |((a, b), c): ((&Option<Pose>, &Option<Pose>), &Option<Pose>)| {
            Some(of([a.as_ref()?, b.as_ref()?, c.as_ref()?]))
        };
        a.iter().zip(b).zip(c).map(each).collect()
    }

    /// Velocities in the mean.
    pub fn mean(&self) -> Twists {
        let over = 1.0 / (self.times[2] - self.times[0]);
        self.twists(|[a, _, c]| [(c.centre - a.centre) * over, rotation::between(&a.turn, &c.turn) * over])
    }

    /// Velocities at the start.
    pub fn at_start(&self) -> Twists {
        let over = 1.0 / (self.times[2] - self.times[0]);
        self.twists(|[a, b, c]| {
            let turned = [b, c].map(|p| rotation::between(&a.turn, &p.turn));
            [((b.centre - a.centre) * 4.0 - (c.centre - a.centre)) * over, (turned[0] * 4.0 - turned[1]) * over]
        })
    }

    /// Velocities at the end.
    pub fn at_end(&self) -> Twists {
        let over = 1.0 / (self.times[2] - self.times[0]);
        self.twists(|[a, b, c]| {
            let turned = [b, a].map(|p| rotation::between(&c.turn, &p.turn));
            [((a.centre - c.centre) - (b.centre - c.centre) * 4.0) * over, (turned[1] - turned[0] * 4.0) * over]
        })
    }

    /// Whether any body moves as prescribed.
    pub fn moves(&self) -> bool {
        let nothing = Vector::<3>::zeros();
        [self.mean(), self.at_start(), self.at_end()]
            .iter()
            .any(|t| t.iter().flatten().any(|twist| *twist != [nothing; 2]))
    }

    /// What supports ask for at the end with the bodies in a state, and by how much more per time: `[unknown, alone; coupled]`.
    ///
    /// # Errors
    /// Supports that cannot act.
    pub fn held(&self, system: &System, bodies: &[BodyState], at_end: bool) -> Result<HeldInTime, AssemblyError> {
        let [start, middle, end] = self.times;
        let found = [start, middle, end].map(|time| system.held(bodies, time));
        let [a, b, c] = found;
        let (a, b, c) = (a?, b?, c?);
        let over = 1.0 / (end - start);
        // A support that begins or ends to hold on the way has no rate.
        let rates = |a: &[Held], b: &[Held], c: &[Held]| -> Vec<f64> {
            let v = |list: &[Held], k: usize| list[k].constraint.violation;
            let same = a.len() == c.len() && b.len() == c.len();
            let rate = |k: usize| match at_end {
                _ if !same => 0.0,
                true => (v(a, k) - v(c, k) - 4.0 * (v(b, k) - v(c, k))) * over,
                false => (4.0 * (v(b, k) - v(a, k)) - (v(c, k) - v(a, k))) * over,
            };
            (0..c.len()).map(rate).collect()
        };
        let single_rates = rates(&a.0, &b.0, &c.0);
        let coupled_rates = rates(&a.1, &b.1, &c.1);
        Ok(HeldInTime { single: c.0, coupled: c.1, single_rates, coupled_rates })
    }
}

/// Equations of supports at the end of a step, with the rates of their violations where the bodies stay.
pub struct HeldInTime {
    pub single: Vec<Held>,
    pub coupled: Vec<Held>,
    pub single_rates: Vec<f64>,
    pub coupled_rates: Vec<f64>,
}
