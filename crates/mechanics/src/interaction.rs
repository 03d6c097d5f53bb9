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

use crate::body::MaterialPoint;
use crate::body::{Body, BodyState, PlaceError, Sampling, Site};
use crate::contact::{Contact, Enforcement, Part, Sides, SiteMemory};
use crate::increment::SOFTER;
use crate::pair::Stuck;
use crate::passage::Way;
use crate::prepare::WAVE;
use crate::simpler::{SetAside, SimplerFriction};
use crate::site_result::SiteResult;
use signorini_contact::{Law, Status};
use signorini_geometry::Vector;
use signorini_solve::general::Entries;

/// All bodies of a system in a state.
#[derive(Clone, Copy)]
pub struct Bodies<'a> {
    pub bodies: &'a [Box<dyn Body>],
    pub states: &'a [BodyState],
    /// First unknown of each body in the system.
    pub first: &'a [u32],
}

/// The numbers of an interaction in a state of the system.
#[derive(Clone, Copy)]
pub struct Own<'a> {
    pub multipliers: &'a [f64],
    /// Unknown of the system that the first multiplier is.
    pub first: u32,
    pub prediction: &'a [f64],
}

/// Where residual and tangent go, in the numbers of the system.
pub struct Target<'a> {
    pub residual: &'a mut [f64],
    /// Sum of the sizes of all terms of each equation: the scale of its residual.
    pub sizes: &'a mut [f64],
    /// The tangent, where it is asked for.
    pub tangent: Option<&'a mut Entries>,
}

/// What an outer iteration knows.
#[derive(Clone, Copy, Debug)]
pub struct Around {
    /// Rounding of positions.
    pub known: f64,
    /// The change of the iteration before, if there was one.
    pub before: Option<f64>,
}

/// Saved numbers that are not of this interaction.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the saved numbers are not those of contact `{contact}`")]
pub struct NotItsHistory {
    pub contact: String,
}

/// Something between two bodies of a system, or within one.
pub trait Interaction: Send + Sync {
    fn name(&self) -> &str;

    /// Numbers of the bodies: that on which the reported forces act first. Twice the same within a body.
    fn bodies(&self) -> [usize; 2];

    /// The law of friction; none if there is none.
    fn law(&self) -> Option<&dyn Law>;

    /// Unknowns of its own: of each the traction per gap, which scales its equation, and the weight of its site.
    fn rows(&self) -> Vec<[f64; 2]> {
        Vec::new()
    }

    /// Values of its unknowns with which an increment starts: those of the last state.
    fn remembered(&self) -> Vec<f64> {
        Vec::new()
    }

    /// Whether its unknowns are exact multipliers, which need a guess of what carries.
    fn is_exact(&self) -> bool {
        false
    }

    /// Begins an increment to a time, and ends it.
    fn begin(&mut self, _time: f64) {}
    fn end(&mut self) {}

    /// The largest stiffness of what is tested or touched, as force per length; zero if nothing has one.
    fn stiffness(&self, bodies: &[Box<dyn Body>]) -> f64;

    /// Sets penalties from the stiffness of the bodies, or where they have none from that given. Called once.
    fn prepare(&mut self, bodies: &[Box<dyn Body>], otherwise: f64);

    /// Scales the stiffness of its trials, not that of its penalties: the states are the same, the way to them is another.
    /// Whether it has trials.
    fn scale_trials(&mut self, _factor: f64) -> bool {
        false
    }

    /// Leaves out what cannot move; `held` tells which unknowns are prescribed.
    fn leave_out_held(&mut self, _at: Bodies<'_>, _held: &[bool]) {}

    /// Adds residual and, if there is room for it, tangent; how many points could not be measured.
    ///
    /// # Errors
    /// Bodies that cannot be tested or touched.
    fn add_to(&self, at: Bodies<'_>, own: Own<'_>, out: &mut Target<'_>) -> Result<usize, PlaceError>;

    /// The points that are tested as they are found in a state.
    ///
    /// # Errors
    /// Bodies that cannot be tested or touched.
    fn results(&self, at: Bodies<'_>, own: Own<'_>) -> Result<Vec<SiteResult>, PlaceError>;

    /// The prediction with which an increment starts.
    fn prediction(&self) -> Vec<f64> {
        Vec::new()
    }

    /// What a share of a step of all unknowns of the system predicts, from the state before it.
    fn predict(&self, _at: Bodies<'_>, _own: Own<'_>, _step: &[f64], _share: f64) -> Vec<f64> {
        Vec::new()
    }

    /// The share of a way between two states of the bodies that may be followed until something passes through; 1 where
    /// nothing does.
    ///
    /// # Errors
    /// Bodies that cannot be tested or touched.
    fn free_way(&self, _way: Way<'_>) -> Result<f64, PlaceError> {
        Ok(1.0)
    }

    /// Takes a state as the one from which slips count and the next increment starts.
    ///
    /// # Errors
    /// Bodies that cannot be tested or touched.
    fn accept(&mut self, at: Bodies<'_>, own: Own<'_>) -> Result<(), PlaceError>;

    /// Forgets what it carried, not where slips count from.
    fn unload(&mut self);

    /// Prepares the next outer iteration at a state with the results found in it: multipliers that are kept while Newton's
    /// method runs take the tractions, penalties what leaves the penetration that is wanted. The largest relative change.
    ///
    /// # Errors
    /// Bodies that cannot be tested or touched.
    fn augment(
        &mut self,
        at: Bodies<'_>,
        own: Own<'_>,
        found: &[SiteResult],
        around: Around,
    ) -> Result<f64, PlaceError>;

    /// Until [`Interaction::restate`]: penalties in place of multipliers, with a simpler friction where that is asked for.
    fn simplify(&mut self, friction: SimplerFriction);

    /// Ends what [`Interaction::simplify`] began.
    fn restate(&mut self);

    /// History and scales as plain numbers.
    fn history(&self) -> [Vec<f64>; 2];

    /// Goes on from numbers that [`Interaction::history`] gave.
    ///
    /// # Errors
    /// Numbers of something else.
    fn restore(&mut self, history: &[Vec<f64>; 2]) -> Result<(), NotItsHistory>;
}

/// The part of a change that the next outer iteration may leave.
const SLOW: f64 = 0.25;
/// The part of its compliance that a contact keeps then, and the least.
const HARDER: f64 = 0.1;
const HARDEST: f64 = 1e-6;

/// Takes the tractions found as those to give way from, beside the pressure per gap of each: the largest change, relative to
/// the largest pressure.
pub(crate) fn take_over<'a>(
    kept: impl Iterator<Item = (&'a mut [f64; 3], &'a f64)>,
    found: &[[f64; 3]],
    around: &Around,
) -> f64 {
    let most = found.iter().map(|f| f[0]).fold(0.0f64, f64::max);
    let mut change = 0.0f64;
    for ((kept, stiffness), traction) in kept.zip(found) {
        let changed = (0..3).map(|i| (kept[i] - traction[i]).abs()).fold(0.0, f64::max);
        // Gaps are known to the rounding of positions only.
        change = change.max(if changed > around.known * stiffness { changed / most } else { 0.0 });
        *kept = *traction;
    }
    change
}

/// The compliance to go on with: where a step leaves more than a quarter of the error, the next ones are to leave less
/// (Bertsekas 1982). What enforces has tractions as unknowns, so that Newton's method suffers no harm.
pub(crate) fn hardened(softness: f64, change: f64, around: &Around) -> f64 {
    if around.before.is_some_and(|before| change > SLOW * before) { (HARDER * softness).max(HARDEST) } else { softness }
}

/// Changes penalties so that the penetration becomes the wanted one: by how much, relative.
pub(crate) fn towards(wanted: f64, found: &[SiteResult], penalties: &mut [f64]) -> f64 {
    let Some(factor) = penalty_factor(found, wanted) else { return 0.0 };
    penalties.iter_mut().for_each(|c| *c *= factor);
    (factor - 1.0).abs()
}

/// Penetration that an outer iteration leaves, relative to the one that is wanted.
pub const NEAR_WANTED: f64 = 1e-2;

impl<'a> Bodies<'a> {
    pub(crate) fn side(&self, part: &Part) -> (&'a dyn Body, &'a BodyState) {
        (self.bodies[part.body].as_ref(), &self.states[part.body])
    }

    pub(crate) fn sides(&self, contact: &Contact) -> Sides<'a> {
        Sides {
            slave: self.side(&contact.slave),
            master: self.side(&contact.master),
            first: [self.first[contact.slave.body], self.first[contact.master.body]],
        }
    }
}

/// The factor by which penalties change to leave the penetration that is wanted; none if they leave it.
pub fn penalty_factor(found: &[SiteResult], wanted: f64) -> Option<f64> {
    let depth = found.iter().filter(|s| s.status != Status::Open).filter_map(|s| s.gap);
    let depth = depth.fold(0.0f64, |m, g| m.max(-g));
    // The penetration is inverse to the penalty but for what the bodies give way.
    (depth > 0.0 && (depth / wanted - 1.0).abs() > NEAR_WANTED).then_some(depth / wanted)
}

impl Contact {
    /// The largest stiffness of what is touched, as force per length; infinite if it is rigid.
    fn master_stiffness(&self, bodies: &[Box<dyn Body>]) -> f64 {
        let master = &bodies[self.master.body];
        let sites = |sampling| master.sites(self.master.group.as_deref(), sampling);
        let list = sites(Sampling::Nodes).or_else(|_| sites(Sampling::GaussPoints)).unwrap_or_default();
        let finite = list.iter().map(|s| master.site_stiffness(s)).filter(|c| c.is_finite());
        finite.reduce(f64::max).unwrap_or(f64::INFINITY)
    }
}

impl Interaction for Contact {
    fn name(&self) -> &str {
        &self.name
    }

    fn bodies(&self) -> [usize; 2] {
        [self.slave.body, self.master.body]
    }

    fn law(&self) -> Option<&dyn Law> {
        self.friction.as_deref()
    }

    fn rows(&self) -> Vec<[f64; 2]> {
        let list = self.stiffness.iter().zip(self.sites());
        list.flat_map(|(c, site)| vec![[*c, site.weight]; self.components()]).collect()
    }

    fn remembered(&self) -> Vec<f64> {
        self.memory.iter().flat_map(|m| m.traction[..self.components()].to_vec()).collect()
    }

    fn is_exact(&self) -> bool {
        self.enforcement == Enforcement::Multiplier
    }

    fn begin(&mut self, time: f64) {
        self.times[1] = time;
    }

    fn end(&mut self) {
        self.softness = self.enforcement.softness();
    }

    fn stiffness(&self, bodies: &[Box<dyn Body>]) -> f64 {
        let own = self.stiffness.iter().zip(self.sites()).map(|(c, s)| c * s.weight);
        // A deformable master of a rigid slave.
        let touched = Some(self.master_stiffness(bodies));
        own.chain(touched).filter(|c| c.is_finite()).fold(0.0, f64::max)
    }

    fn prepare(&mut self, bodies: &[Box<dyn Body>], otherwise: f64) {
        let is_curve = bodies[self.slave.body].curve(self.slave.group.as_deref()).is_some();
        // A curve on a solid gives way across itself, where it is much less stiff than along, and so does the solid.
        let [given_way, share] = match is_curve && !bodies[self.master.body].is_rigid() {
            true => [self.master_stiffness(bodies), SOFTER],
            false => [f64::INFINITY, 1.0],
        };
        let weights: Vec<f64> = self.sites().iter().map(|s| s.weight).collect();
        if self.enforcement == Enforcement::Nitsche {
            return;
        }
        for (c, w) in self.stiffness.iter_mut().zip(weights) {
            *c = WAVE * share * if c.is_finite() { c.min(given_way / w) } else { otherwise / w };
        }
    }

    fn leave_out_held(&mut self, at: Bodies<'_>, held: &[bool]) {
        // Against a body that moves a held site may still carry; what is held now may be free later.
        if at.bodies[self.master.body].unknowns() > 0 || at.bodies[self.slave.body].holds_change() {
            return;
        }
        let (body, state) = at.side(&self.slave);
        let first = at.first[self.slave.body];
        let moves = |site: &Site| {
            let placed = body.placed(state, site);
            placed.functions.iter().any(|f| !held[(first + f.unknown) as usize])
        };
        let kept: Vec<bool> = self.sites().iter().map(moves).collect();
        self.keep(&kept);
    }

    fn add_to(&self, at: Bodies<'_>, own: Own<'_>, out: &mut Target<'_>) -> Result<usize, PlaceError> {
        self.add_sites(&at.sides(self), (own.multipliers, own.first), out)
    }

    fn results(&self, at: Bodies<'_>, own: Own<'_>) -> Result<Vec<SiteResult>, PlaceError> {
        Ok(self.found(&at.sides(self), own.multipliers)?.into_iter().map(|f| f.0).collect())
    }

    fn free_way(&self, way: Way<'_>) -> Result<f64, PlaceError> {
        self.share_of_way(way)
    }

    fn accept(&mut self, at: Bodies<'_>, own: Own<'_>) -> Result<(), PlaceError> {
        let sides = at.sides(self);
        self.accept_sites(&sides, own.multipliers)
    }

    fn unload(&mut self) {
        self.memory.iter_mut().for_each(|m| m.traction = [0.0; 3]);
    }

    fn augment(
        &mut self,
        at: Bodies<'_>,
        own: Own<'_>,
        found: &[SiteResult],
        around: Around,
    ) -> Result<f64, PlaceError> {
        match self.enforcement {
            Enforcement::AugmentedLagrangian => {
                let found = self.found(&at.sides(self), own.multipliers)?.into_iter().map(|f| f.1).collect::<Vec<_>>();
                let kept = self.memory.iter_mut().map(|m| &mut m.traction).zip(&self.stiffness);
                let change = take_over(kept, &found, &around);
                self.softness = hardened(self.softness, change, &around);
                Ok(change)
            }
            Enforcement::Penalty { wanted_penetration: Some(wanted) } => {
                Ok(towards(wanted, found, &mut self.stiffness))
            }
            _ => Ok(0.0),
        }
    }

    fn scale_trials(&mut self, factor: f64) -> bool {
        // Nitsche's method has its stiffness in the state.
        if self.enforcement == Enforcement::Nitsche {
            return false;
        }
        self.stiffness.iter_mut().for_each(|c| *c *= factor);
        self.softness *= factor;
        true
    }

    fn simplify(&mut self, friction: SimplerFriction) {
        let kept = (&mut self.enforcement, &mut self.softness);
        self.set_aside = Some(SetAside::new(friction, &mut self.friction, kept));
    }

    fn restate(&mut self) {
        if let Some(stated) = self.set_aside.take() {
            stated.put_back(&mut self.friction, (&mut self.enforcement, &mut self.softness));
        }
    }

    fn history(&self) -> [Vec<f64>; 2] {
        let scales = self.stiffness.iter().copied().chain([self.times[0]]).collect();
        [self.memory.iter().flat_map(numbers).collect(), scales]
    }

    fn restore(&mut self, [sites, scales]: &[Vec<f64>; 2]) -> Result<(), NotItsHistory> {
        let count = self.stiffness.len();
        if sites.len() != NUMBERS * self.memory.len() || scales.len() != count + 1 {
            return Err(NotItsHistory { contact: self.name.clone() });
        }
        self.memory = sites.chunks(NUMBERS).map(memory).collect();
        self.stiffness.copy_from_slice(&scales[..count]);
        self.times = [scales[count]; 2];
        Ok(())
    }
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
