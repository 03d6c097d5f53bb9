//! What acts between bodies of a system: forces and tangent, what is kept from increment to increment, and how both are
//! enforced.
//!
//! A [`Contact`] tests points of one body against another; contact between curves, in the crate of ropes, finds its points
//! anew in every state. To the system both are interactions. An interaction may have
//!
//! - *multipliers*, unknowns of its own: as many in all states;
//! - a *prediction*, numbers that Newton's method carries from one iterate to the next, such as forces that the step before
//!   predicts: as many as it likes. They change the tangent, never the forces that decide about convergence;
//! - a *history*, numbers that count from the last state that was accepted.

pub use crate::assembler::Assembler;
pub use crate::outer::{NEAR_WANTED, OuterIteration, penalty_factor};

use crate::body::{Body, BodyState, PlaceError};
use crate::contact::Contact;
use crate::contact_law::ContactLaw;
pub use crate::heat::Conducting;
use crate::inside::{self, Inside};
use crate::part::Part;
use crate::points::SlavePoint;
use crate::shown_surface::ShownSurface;
use crate::site_result::SiteResult;
use signorini_contact::Law;

/// All bodies of a system in a state.
#[derive(Clone, Copy)]
pub struct Bodies<'a> {
    pub bodies: &'a [Box<dyn Body>],
    pub states: &'a [BodyState],
    /// First unknown of each body in the system.
    pub first: &'a [u32],
}

/// A way between two states of all bodies, on which positions and turns change in proportion.
#[derive(Clone, Copy)]
pub struct StatePath<'a> {
    pub from: Bodies<'a>,
    pub to: Bodies<'a>,
}

impl StatePath<'_> {
    /// A body on the way: `t` from 0 to 1.
    pub fn at(&self, body: usize, t: f64) -> BodyState {
        let [from, to] = [self.from, self.to].map(|b| &b.states[body]);
        self.from.bodies[body].between(from, to, t)
    }

    pub(crate) fn moves(&self, body: usize) -> bool {
        self.from.states[body] != self.to.states[body]
    }
}

/// The numbers of an interaction in a state of the system.
#[derive(Clone, Copy)]
pub struct InteractionUnknowns<'a> {
    pub multipliers: &'a [f64],
    /// Unknown of the system that the first multiplier is.
    pub first: u32,
    pub prediction: &'a [f64],
}

/// Saved numbers that are not of this interaction.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the stored data do not belong to contact `{contact}`")]
pub struct NotItsHistory {
    pub contact: String,
}

/// Something between two bodies of a system, or within one.
pub trait Interaction: Iterated + Passing + Drawn + Conducting + Send + Sync {
    fn name(&self) -> &str;

    /// The parts of bodies that may touch: that on which the reported forces act first.
    fn parts(&self) -> [&Part; 2];

    /// Law, enforcement, and the tractions that are unknowns.
    fn law(&self) -> &ContactLaw;

    fn law_mut(&mut self) -> &mut ContactLaw;

    /// The largest stiffness of what is tested or touched, as force per length; zero if nothing has one.
    fn stiffness(&self, bodies: &[Box<dyn Body>]) -> f64;

    /// Sets penalties from the stiffness of the bodies, or where they have none from that given. Called once.
    fn prepare(&mut self, bodies: &[Box<dyn Body>], otherwise: f64);

    /// Adds residual and, if there is room for it, tangent; how many points could not be measured.
    ///
    /// # Errors
    /// Bodies that cannot be tested or touched.
    fn add_to(
        &self,
        at: Bodies<'_>,
        own: InteractionUnknowns<'_>,
        out: &mut Assembler<'_>,
    ) -> Result<usize, PlaceError>;

    /// The points that are tested as they are found in a state.
    ///
    /// # Errors
    /// Bodies that cannot be tested or touched.
    fn results(&self, at: Bodies<'_>, own: InteractionUnknowns<'_>) -> Result<Vec<SiteResult>, PlaceError>;

    /// Takes a state as the one from which slips count and the next increment starts.
    ///
    /// # Errors
    /// Bodies that cannot be tested or touched.
    fn accept(&mut self, at: Bodies<'_>, own: InteractionUnknowns<'_>) -> Result<(), PlaceError>;

    /// Prepares the next outer iteration at a state with the results found in it: multipliers that are kept while Newton's
    /// method runs take the tractions, penalties what leaves the penetration that is wanted. The largest relative change.
    ///
    /// # Errors
    /// Bodies that cannot be tested or touched.
    fn augment(
        &mut self,
        at: Bodies<'_>,
        own: InteractionUnknowns<'_>,
        found: &[SiteResult],
        around: OuterIteration,
    ) -> Result<f64, PlaceError>;

    /// History and scales as plain numbers.
    fn history(&self) -> [Vec<f64>; 2];

    /// Goes on from numbers that [`Interaction::history`] gave.
    ///
    /// # Errors
    /// Numbers of something else.
    fn restore(&mut self, history: &[Vec<f64>; 2]) -> Result<(), NotItsHistory>;
}

impl dyn Interaction + '_ {
    /// Numbers of the bodies. Twice the same within a body.
    pub fn bodies(&self) -> [usize; 2] {
        self.parts().map(|part| part.body)
    }

    /// Begins an increment to a time.
    pub(crate) fn begin_increment(&mut self, time: f64) {
        let law = self.law_mut();
        law.times[1] = time;
        law.friction.iter_mut().for_each(|law| law.begin(time));
        self.begin(time);
    }

    /// Forgets what it carried, not where slips count from.
    pub(crate) fn forget_tractions(&mut self) {
        self.law_mut().unload();
        self.unload();
    }

    /// The law of what acts along the surface; none if nothing does.
    pub fn friction(&self) -> Option<&dyn Law> {
        self.law().friction.as_deref().filter(|law| law.is_tangential())
    }
}

/// What Newton's method asks of an interaction besides residual and tangent.
pub trait Iterated {
    /// Begins an increment to a time.
    fn begin(&mut self, _time: f64) {}

    /// Takes the state that the increment starts from.
    fn depart(&mut self, _from: Bodies<'_>) {}

    /// Leaves out what cannot move; `held` tells which unknowns are prescribed.
    fn leave_out_held(&mut self, _at: Bodies<'_>, _held: &[bool]) {}

    /// From now on gives way by a force per penetration, a function of the gap alone, without friction; as before with none.
    /// Whether it can do so.
    fn give_way(&mut self, _force_per_gap: Option<f64>) -> bool {
        false
    }

    /// Forgets what it carried besides the tractions of its law, not where slips count from.
    fn unload(&mut self) {}

    /// Values of its unknowns that would bear forces that are out of balance without them; none where that is no good start.
    fn initial_multipliers(&self, _at: Bodies<'_>, _residual: &[f64]) -> Option<Vec<f64>> {
        None
    }

    /// The least gap in a state, if [`initial_multipliers`](Iterated::initial_multipliers) may carry a body that nothing else holds.
    fn least_gap(&self, _at: Bodies<'_>) -> Option<f64> {
        None
    }

    /// Why a state may have none near it, in words with the place.
    fn ill_conditioning(&self, _at: Bodies<'_>) -> Option<String> {
        None
    }

    /// The prediction with which an increment starts.
    fn prediction(&self) -> Vec<f64> {
        Vec::new()
    }

    /// What a share of a step of all unknowns of the system predicts, from the state before it.
    fn predict(&self, _at: Bodies<'_>, _own: InteractionUnknowns<'_>, _step: &[f64], _share: f64) -> Vec<f64> {
        Vec::new()
    }
}

/// What keeps bodies from passing through each other between two states.
pub trait Passing {
    /// The share of a path between two states of the bodies that may be followed until something passes through; 1 where
    /// nothing does.
    ///
    /// # Errors
    /// Bodies that cannot be tested or touched.
    fn free_way(&self, _path: StatePath<'_>) -> Result<f64, PlaceError> {
        Ok(1.0)
    }

    /// What lies inside of a rigid body in a state where nothing sees it; at the start also what lies in it deeper than an
    /// interference that contact could undo.
    ///
    /// # Errors
    /// Bodies that cannot be tested or touched.
    fn inside(&self, _at: Bodies<'_>, _is_start: bool) -> Result<Option<Inside>, PlaceError> {
        Ok(None)
    }
}

/// How an interaction is looked at from outside.
pub trait Drawn {
    /// A contact of points, as such.
    fn as_points(&self) -> Option<&Contact> {
        None
    }

    fn as_points_mut(&mut self) -> Option<&mut Contact> {
        None
    }

    /// The surface of the first body as it is drawn in a state, between the points of [`Interaction::results`]; none of what
    /// has no faces.
    ///
    /// # Errors
    /// Bodies that cannot be tested or touched.
    fn surface(&self, _at: Bodies<'_>, _own: InteractionUnknowns<'_>) -> Result<Option<ShownSurface>, PlaceError> {
        Ok(None)
    }
}

impl<'a> Bodies<'a> {
    /// [`Interaction::inside`] of the sites of a slave.
    pub(crate) fn inside(
        &self,
        [slave, master]: [&Part; 2],
        sites: &[SlavePoint],
        is_start: bool,
    ) -> Result<Option<Inside>, PlaceError> {
        let (body, state) = self.side(master);
        let are_balls = sites.iter().all(|s| s.outward.is_none());
        if !body.is_rigid()
            || slave.body == master.body
            || (are_balls && !(is_start && self.bodies[slave.body].is_rigid()))
        {
            return Ok(None);
        }
        let met = body.master(master.group.as_deref(), state)?;
        Ok(match is_start {
            true if are_balls => inside::balls_at_start(met.as_ref(), sites, self.bodies[slave.body].size()),
            true => inside::at_start(met.as_ref(), sites, self.bodies[slave.body].size()),
            false => inside::unseen(met.as_ref(), sites),
        })
    }

    pub(crate) fn side(&self, part: &Part) -> (&'a dyn Body, &'a BodyState) {
        (self.bodies[part.body].as_ref(), &self.states[part.body])
    }
}
