//! Contact of two bodies at sites: law, enforcement, residual and tangent, history.
//!
//! At every site of the slave, standing for the area `w`, with gap `g`, slip `e` since the last state and the traction `λ`
//! (pressure, and two components of friction in the axes `E_α`), which is an unknown:
//!
//! - trial `ζ = λ - s (λ - λ_0) + c (-g, E_α·e)`, traction `(p, T_α) = Π(ζ)` by the law;
//! - virtual work `w (-p δo + T_α E_α·S)`, with the opening `o`, of which the gap is the size, and the slip variation `S`;
//! - the equation `(w/c) (Π(ζ) - λ) = 0` (Alart & Curnier 1991): a site that is closed has `g = -s/c (λ - λ_0)`;
//! - all with their derivatives.
//!
//! | enforcement | `s` | `λ_0` |
//! |---|---|---|
//! | multiplier | 0 | |
//! | penalty `c/s` | > 0 | no pressure; the friction of the last state |
//! | augmented Lagrangian | > 0 | kept while Newton's method runs, then set to the traction found (Uzawa), until it changes no more |
//! | Nitsche | 1 | the stress of the slave (`nitsche`), with its own `c` |
//!
//! So a penalty is a compliance of the contact. Which sites are closed is told by the traction predicted for them and by the
//! scale `c`, which is that of the bodies whatever the penalty: without tractions as unknowns a penalty makes a force of any
//! gap on the way, and Newton's method opens and closes sites in turns.
//!
//! The slip counts from where the sides had a common point at the last state, or would have had if they had touched.

mod assembly;
mod axes;
mod departure;
mod edges;
mod interaction;
mod partner;
mod partners;
mod redistribution;
mod state;
mod traction;

pub use crate::part::Part;
pub use partner::Pairing;

use crate::body::{Body, BodyState, PlaceError};
use crate::contact_law::ContactLaw;
use crate::enforcement::Enforcement;
use crate::inside;
use crate::nitsche::Stress;
use crate::pair::{AxisChoice, NoPair, Pair, PairGeometry, Stuck};
use crate::points::{Anchor, Direction, Master, MasterProjection, Order, Sampling, Site, SlavePoint};
pub(crate) use axes::axes;
use partner::Partners;
use signorini_geometry::{Point, Vector};

/// Two sides that may touch.
pub struct Contact {
    pub name: String,
    pub slave: Part,
    pub master: Part,
    pub sampling: Sampling,
    pub law: ContactLaw,
    pub axis: AxisChoice,
    /// Velocity of opening after an impact of rigid bodies relative to that of closing before it (Newton), from 0 to 1.
    pub restitution: f64,
    /// How far apart, or inside each other, points are looked at.
    pub reach: f64,
    /// Distance of the sites.
    spacing: f64,
    /// Where they are looked for.
    pub pairing: Pairing,
    partners: Partners,
    sites: Vec<Site>,
    /// The other sites at the node of each, on faces beyond an edge.
    beyond_edges: Vec<Vec<Site>>,
    /// What the sites remember of the last state.
    pub(crate) memory: Vec<SiteMemory>,
    /// The rotation vectors of slave and master at the last state, of rigid bodies.
    pub(crate) turned: [Vector<3>; 2],
    /// Both sides in the state from which the increment starts, where surfaces rub.
    departed: Option<[BodyState; 2]>,
}

/// What a site remembers of the last state besides its traction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SiteMemory {
    pub stuck: Option<Stuck>,
    /// How far the site slipped in all while it was closed, along the axes.
    pub slip: [f64; 2],
}

/// The two bodies of a contact in a state.
pub(crate) struct Sides<'a> {
    pub slave: (&'a dyn Body, &'a BodyState),
    pub master: (&'a dyn Body, &'a BodyState),
    pub first: [u32; 2],
}

/// A pair, with the stress of the slave where that enforces the contact.
struct MeasuredPair {
    pair: Pair,
    stress: Option<Stress>,
}

impl Contact {
    /// # Errors
    /// Places that cannot be tested or touched.
    pub fn new(
        name: &str,
        slave: (Part, &dyn Body),
        master: (Part, &dyn Body),
        sampling: Sampling,
        enforcement: Enforcement,
    ) -> Result<Self, PlaceError> {
        let is_edge =
            |(part, body): &(Part, &dyn Body)| part.group.is_some() && body.curve(part.group.as_deref()).is_some();
        if slave.0.body == master.0.body && (is_edge(&slave) || is_edge(&master)) {
            let message = "contact of an edge with its own body is possible with other edges only".to_string();
            return Err(PlaceError::Unsuitable { body: slave.1.name().to_string(), message });
        }
        let mut sites = slave.1.sites(slave.0.group.as_deref(), sampling)?;
        master.1.master(master.0.group.as_deref(), &master.1.start())?;
        // Polyhedra touch by all of their features.
        let [of_slave, of_master] = [slave.1, master.1].map(|body| body.polyhedron(&body.start()));
        if let (Some(own), Some(_)) = (of_slave, of_master) {
            let known = sites.len();
            sites.extend((0..own.features.count()).map(|k| Site {
                patch: (known + k) as u32,
                xi: [0.0; 2],
                weight: 1.0,
            }));
        }
        let stiffness = if enforcement.takes_stress() {
            if sites.first().is_some_and(|s| slave.1.traction(&slave.1.start(), s).is_none()) {
                let message =
                    "Nitsche's method is for surfaces of finite cells and of linear elastic solids".to_string();
                return Err(PlaceError::Unsuitable { body: slave.1.name().to_string(), message });
            }
            sites
                .iter()
                .map(|s| slave.1.stabilisation(s).unwrap_or_else(|| slave.1.site_stiffness(s) / s.weight))
                .collect()
        } else {
            sites.iter().map(|s| slave.1.site_stiffness(s) / s.weight).collect()
        };
        // Of a place that touches itself both sides are tested, and each carries one half.
        if slave.0 == master.0 {
            sites.iter_mut().for_each(|s| s.weight *= 0.5);
        }
        let start = slave.1.start();
        let placed: Vec<SlavePoint> = sites.iter().map(|site| slave.1.placed(&start, site)).collect();
        let has_edges = sampling == Sampling::Nodes && !slave.1.is_rigid();
        let beyond_edges = if has_edges { edges::beyond_edges(&sites, &placed) } else { vec![Vec::new(); sites.len()] };
        let spacing = inside::distance(&placed);
        let both_rigid = slave.1.is_rigid() && master.1.is_rigid();
        let enforcement = if both_rigid { enforcement.between_rigid_bodies() } else { enforcement };
        // The gap to a rigid body is known anywhere.
        let reach = if master.1.is_rigid() { f64::INFINITY } else { 0.5 * slave.1.size().min(master.1.size()) };
        Ok(Contact {
            name: name.to_string(),
            slave: slave.0,
            master: master.0,
            sampling,
            law: ContactLaw::new(enforcement, stiffness, sites.iter().map(|s| s.weight).collect()),
            axis: AxisChoice::Material,
            restitution: 0.0,
            reach,
            spacing,
            pairing: Pairing::Now,
            partners: Partners::new(),
            memory: vec![SiteMemory::default(); sites.len()],
            sites,
            beyond_edges,
            turned: [Vector::<3>::zeros(); 2],
            departed: None,
        })
    }

    /// Keeps some of the sites.
    pub(crate) fn keep(&mut self, kept: &[bool]) {
        fn filtered<T: Clone>(list: &[T], kept: &[bool]) -> Vec<T> {
            list.iter().zip(kept).filter(|(_, k)| **k).map(|(v, _)| v.clone()).collect()
        }
        self.sites = filtered(&self.sites, kept);
        self.beyond_edges = filtered(&self.beyond_edges, kept);
        self.law.stiffness = filtered(&self.law.stiffness, kept);
        self.law.areas = filtered(&self.law.areas, kept);
        self.law.kept = filtered(&self.law.kept, kept);
        self.law.history = filtered(&self.law.history, kept);
        self.memory = filtered(&self.memory, kept);
    }

    pub fn sites(&self) -> &[Site] {
        &self.sites
    }

    pub(crate) fn components(&self) -> usize {
        self.law.slots().len()
    }

    /// Itself and itself: a body that may touch itself.
    fn is_within(&self) -> bool {
        self.slave.body == self.master.body
    }

    /// The pair of a site, if it meets something no farther than a gap; with second variations where they are `wanted`.
    fn pair(
        &self,
        k: usize,
        sides: &Sides<'_>,
        (master, farthest): (&dyn Master, f64),
        wanted: impl Fn(&MeasuredPair) -> bool,
    ) -> (SlavePoint, Option<Result<MeasuredPair, NoPair>>) {
        let Some(known) = self.partners.get() else { return self.pair_now(k, sides, (master, farthest), wanted) };
        let placed = sides.slave.0.placed(sides.slave.1, &self.sites[k]);
        let Some(partner) = known[k].filter(|_| !placed.rests) else { return (placed, None) };
        let anchor = master.at(&partner.point);
        let with = |order| {
            let mut pair = partner.pair(&placed, &anchor, sides.first, order);
            if self.law.is_tangential() {
                partner.add_slip(&placed, &anchor, &mut pair);
            }
            self.with_stress(k, sides, pair)
        };
        let first = with(Order::First);
        let found = if wanted(&first) { with(Order::Second) } else { first };
        (placed, Some(Ok(found)))
    }

    /// The pair of a site with what is nearest to it now.
    fn pair_now(
        &self,
        k: usize,
        sides: &Sides<'_>,
        (master, farthest): (&dyn Master, f64),
        wanted: impl Fn(&MeasuredPair) -> bool,
    ) -> (SlavePoint, Option<Result<MeasuredPair, NoPair>>) {
        let site = &self.sites[k];
        let placed = sides.slave.0.placed(sides.slave.1, site);
        if placed.rests {
            return (placed, None);
        }
        let except = self.is_within().then_some(site);
        // What a rigid body meets is found with its gap.
        if !sides.master.0.is_rigid() && self.is_beyond(farthest, (&placed.x, placed.radius), master, except) {
            return (placed, None);
        }
        let met: Option<MasterProjection> = match &placed.averaged {
            Some(normal) if master.is_faceted() && except.is_none() => {
                master.cut(&placed.x, &normal.vector, self.reach)
            }
            // A curve; sections that turn roll over edges.
            None if placed.tangent.is_some() && placed.spin.is_empty() && except.is_none() => {
                let reach = self.reach + placed.radius;
                master.along(&placed.x, reach).or_else(|| master.nearest(&placed.x, reach, None))
            }
            _ => placed.met(master, (self.reach, self.spacing), except),
        };
        let Some(met) = met else { return (placed, None) };
        if self.is_met_beyond_an_edge(k, sides.slave, (&placed, &met)) {
            return (placed, Some(Err(NoPair::FacesAway)));
        }
        // Pairs that are kept have slips of their own.
        let friction = self.law.is_tangential() && self.pairing == Pairing::Now;
        let stuck = self.memory[k].stuck.filter(|_| friction);
        let anchor: Option<(Stuck, Anchor)> = stuck.map(|s| (s, master.at(&s.point)));
        let encounter = PairGeometry {
            slave: &placed,
            met: &met,
            first: sides.first,
            stuck: anchor.as_ref().map(|(s, a)| (s, a)),
            since: self.turned,
            friction,
            axis: self.axis,
        };
        let arrives = friction && stuck.is_none() && placed.outward.is_some() && met.outward().is_some();
        let measured = |order| {
            let mut pair = encounter.measure(order)?;
            if arrives {
                self.count_from_departure(sides, master, &mut pair);
            }
            Ok(self.with_stress(k, sides, pair))
        };
        let first = measured(Order::First);
        if !first.as_ref().is_ok_and(wanted) {
            return (placed, Some(first));
        }
        let second = measured(Order::Second);
        (placed, Some(second))
    }

    /// The gap beyond which a site is open whatever it meets.
    fn closes_within(&self, k: usize, sides: &Sides<'_>, unknown: [f64; 3]) -> f64 {
        self.opens_beyond(k, unknown, || self.stress(k, sides).map_or(f64::INFINITY, |s| s.vector.norm()))
    }

    fn opens_beyond(&self, k: usize, unknown: [f64; 3], traction: impl FnOnce() -> f64) -> f64 {
        let base = self.law.enforcement.takes_stress().then(traction);
        let pressing = self.law.pressing(k, unknown[0], base);
        self.law.farthest(k, pressing)
    }

    /// Whether a site is seen to be open without all that moves it.
    fn is_far(&self, k: usize, sides: &Sides<'_>, master: &dyn Master, unknown: [f64; 3]) -> bool {
        let site = &self.sites[k];
        let Some((x, traction)) = sides.slave.0.position_and_traction(sides.slave.1, site) else { return false };
        let farthest = self.opens_beyond(k, unknown, || traction);
        self.is_beyond(farthest, (&x, 0.0), master, self.is_within().then_some(site))
    }

    /// Whether a ball about a point is farther from the master than some gap.
    fn is_beyond(&self, gap: f64, (x, radius): (&Point<3>, f64), master: &dyn Master, except: Option<&Site>) -> bool {
        gap < self.reach && master.gap(x, self.reach + radius, except).is_some_and(|found| found > gap + radius)
    }

    /// The traction of a site by the stress of its body, where the enforcement is by that.
    fn stress(&self, k: usize, sides: &Sides<'_>) -> Option<Direction> {
        let (body, state) = sides.slave;
        self.law.enforcement.takes_stress().then(|| body.traction(state, &self.sites[k])).flatten()
    }

    fn with_stress(&self, k: usize, sides: &Sides<'_>, mut pair: Pair) -> MeasuredPair {
        let stress = self.stress(k, sides).map(|s| Stress::new(&s, sides.first[0], &mut pair));
        MeasuredPair { pair, stress }
    }
}
