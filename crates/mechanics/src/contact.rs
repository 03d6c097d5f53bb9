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
mod interaction;
mod partners;

pub use crate::part::Part;
pub use partners::Pairing;

use crate::body::{Body, BodyState, PlaceError};
use crate::enforcement::Enforcement;
use crate::nitsche::Stress;
use crate::pair::{AxisChoice, Encounter, NoPair, Pair, Stuck, any_tangent};
use crate::points::{Anchor, Master, Met, Order, Placed, Sampling, Site};
use crate::simpler::SetAside;
use crate::site_result::SiteResult;
use partners::Partners;
use rayon::prelude::*;
use signorini_contact::law::Projected;
use signorini_contact::{Law, Status};
use signorini_geometry::Vector;

/// Two sides that may touch.
pub struct Contact {
    pub name: String,
    pub slave: Part,
    pub master: Part,
    pub sampling: Sampling,
    pub enforcement: Enforcement,
    /// Without it the sides slide freely.
    pub friction: Option<Box<dyn Law>>,
    pub axis: AxisChoice,
    /// How far apart, or inside each other, points are looked at.
    pub reach: f64,
    /// Where they are looked for.
    pub pairing: Pairing,
    partners: Partners,
    sites: Vec<Site>,
    /// Traction per unit of gap, and of slip, of each site: the scale of the trial, not the penalty.
    pub(crate) stiffness: Vec<f64>,
    /// That scale over the penalty.
    pub(crate) softness: f64,
    /// What the sites remember of the last state.
    pub(crate) memory: Vec<SiteMemory>,
    /// Times of the last state and of the one that is looked for.
    pub(crate) times: [f64; 2],
    /// What is stated, while a start is looked for with something simpler.
    pub(crate) set_aside: Option<SetAside>,
}

/// What a site remembers of the last state.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SiteMemory {
    /// The multiplier: pressure and friction along the axes.
    pub traction: [f64; 3],
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
struct Touch {
    pair: Pair,
    stress: Option<Stress>,
}

/// A traction with its derivatives in the unknowns of the pair.
struct Traction {
    projected: Projected,
    axes: [Vector<3>; 2],
    d_axes: Vec<[Vector<3>; 2]>,
    slip: [f64; 2],
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
            let message = "an edge touches other edges of its own body, and nothing else of it".to_string();
            return Err(PlaceError::Unsuitable { body: slave.1.name().to_string(), message });
        }
        let mut sites = slave.1.sites(slave.0.group.as_deref(), sampling)?;
        master.1.master(master.0.group.as_deref(), &master.1.start())?;
        let stiffness = if enforcement.takes_stress() {
            if sites.first().is_some_and(|s| slave.1.traction(&slave.1.start(), s).is_none()) {
                let message = "Nitsche's method is for the surface of finite cells".to_string();
                return Err(PlaceError::Unsuitable { body: slave.1.name().to_string(), message });
            }
            sites.iter().map(|s| slave.1.stabilisation(s)).collect()
        } else {
            sites.iter().map(|s| slave.1.site_stiffness(s) / s.weight).collect()
        };
        if enforcement.takes_stress() && slave.0.body == master.0.body {
            sites.iter_mut().for_each(|s| s.weight *= 0.5);
        }
        let both_rigid = slave.1.is_rigid() && master.1.is_rigid();
        let enforcement = if both_rigid { enforcement.between_rigid_bodies() } else { enforcement };
        // The gap to a rigid body is known anywhere.
        let reach = if master.1.is_rigid() { f64::INFINITY } else { 0.5 * slave.1.size().min(master.1.size()) };
        Ok(Contact {
            name: name.to_string(),
            slave: slave.0,
            master: master.0,
            sampling,
            enforcement,
            friction: None,
            axis: AxisChoice::Material,
            reach,
            pairing: Pairing::Now,
            partners: Partners::new(),
            memory: vec![SiteMemory::default(); sites.len()],
            sites,
            stiffness,
            softness: enforcement.softness(),
            times: [0.0; 2],
            set_aside: None,
        })
    }

    /// Keeps some of the sites.
    pub(crate) fn keep(&mut self, kept: &[bool]) {
        fn filtered<T: Copy>(list: &[T], kept: &[bool]) -> Vec<T> {
            list.iter().zip(kept).filter(|(_, k)| **k).map(|(v, _)| *v).collect()
        }
        self.sites = filtered(&self.sites, kept);
        self.stiffness = filtered(&self.stiffness, kept);
        self.memory = filtered(&self.memory, kept);
    }

    pub fn sites(&self) -> &[Site] {
        &self.sites
    }

    pub(crate) fn components(&self) -> usize {
        if self.friction.is_some() { 3 } else { 1 }
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
        wanted: impl Fn(&Touch) -> bool,
    ) -> (Placed, Option<Result<Touch, NoPair>>) {
        let Some(known) = self.partners.get() else { return self.pair_now(k, sides, (master, farthest), wanted) };
        let placed = sides.slave.0.placed(sides.slave.1, &self.sites[k]);
        let Some(partner) = known[k].filter(|_| !placed.rests) else { return (placed, None) };
        let anchor = master.at(&partner.point);
        let with = |order| {
            let mut pair = partner.pair(&placed, &anchor, sides.first, order);
            if self.friction.is_some() {
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
        wanted: impl Fn(&Touch) -> bool,
    ) -> (Placed, Option<Result<Touch, NoPair>>) {
        let site = &self.sites[k];
        let placed = sides.slave.0.placed(sides.slave.1, site);
        if placed.rests {
            return (placed, None);
        }
        let except = self.is_within().then_some(site);
        if farthest < self.reach
            && master
                .gap(&placed.x, self.reach + placed.radius, except)
                .is_some_and(|gap| gap > farthest + placed.radius)
        {
            return (placed, None);
        }
        let met: Option<Met> = match &placed.averaged {
            Some(normal) if master.is_faceted() && except.is_none() => {
                master.cut(&placed.x, &normal.vector, self.reach)
            }
            // A curve; sections that turn roll over edges.
            None if placed.tangent.is_some() && placed.spin.is_empty() && except.is_none() => {
                let reach = self.reach + placed.radius;
                master.along(&placed.x, reach).or_else(|| master.nearest(&placed.x, reach, None))
            }
            _ => master.nearest(&placed.x, self.reach + placed.radius, except),
        };
        let Some(met) = met else { return (placed, None) };
        // Pairs that are kept have slips of their own.
        let friction = self.friction.is_some() && self.pairing == Pairing::Now;
        let stuck = self.memory[k].stuck.filter(|_| friction);
        let anchor: Option<(Stuck, Anchor)> = stuck.map(|s| (s, master.at(&s.point)));
        let encounter = Encounter {
            slave: &placed,
            met: &met,
            first: sides.first,
            stuck: anchor.as_ref().map(|(s, a)| (s, a)),
            friction,
            axis: self.axis,
        };
        let first = encounter.measure(Order::First).map(|pair| self.with_stress(k, sides, pair));
        if !first.as_ref().is_ok_and(wanted) {
            return (placed, Some(first));
        }
        let second = encounter.measure(Order::Second).map(|pair| self.with_stress(k, sides, pair));
        (placed, Some(second))
    }

    /// The gap beyond which a site is open whatever it meets.
    fn closes_within(&self, k: usize, sides: &Sides<'_>, unknown: [f64; 3]) -> f64 {
        let base = if self.enforcement.takes_stress() {
            let stress = sides.slave.0.traction(sides.slave.1, &self.sites[k]);
            stress.map_or(f64::INFINITY, |s| s.vector.norm())
        } else {
            self.base(k)[0]
        };
        let trial = unknown[0] - self.softness * (unknown[0] - base);
        (trial / self.stiffness[k]).max(0.0)
    }

    fn with_stress(&self, k: usize, sides: &Sides<'_>, mut pair: Pair) -> Touch {
        let (body, state) = sides.slave;
        let stress = self.enforcement.takes_stress().then(|| body.traction(state, &self.sites[k])).flatten();
        let stress = stress.map(|s| Stress::new(&s, sides.first[0], &mut pair));
        Touch { pair, stress }
    }

    fn traction(&self, k: usize, touch: &Touch, unknown: [f64; 3]) -> Traction {
        let c = self.stiffness[k];
        let pair = &touch.pair;
        let (axes, d_axes) = if self.friction.is_some() { axes(pair) } else { ([Vector::<3>::zeros(); 2], Vec::new()) };
        let base = touch.stress.as_ref().map_or_else(|| self.base(k), |s| s.base(&pair.normal, &axes));
        let lambda: [f64; 3] = std::array::from_fn(|i| unknown[i] - self.softness * (unknown[i] - base[i]));
        let Some(law) = &self.friction else {
            let pressure = (lambda[0] - c * pair.gap).max(0.0);
            let closed = lambda[0] - c * pair.gap > 0.0;
            let mut projected = Projected { traction: [pressure, 0.0, 0.0], ..Projected::default() };
            projected.derivative[0][0] = f64::from(u8::from(closed));
            projected.status = if closed { Status::Slip } else { Status::Open };
            return Traction { projected, axes, d_axes, slip: [0.0; 2] };
        };
        let slip = axes.map(|e| e.dot(&pair.elastic));
        // In the plane nothing moves across it, and there is no friction that way.
        let most = pair.slip.iter().map(|s| s.norm()).fold(0.0, f64::max);
        let moves = axes.map(|e| pair.slip.iter().any(|s| e.dot(s).abs() > STEEP * most));
        let trial = |i: usize| if moves[i] { lambda[i + 1] + c * slip[i] } else { 0.0 };
        let per_velocity = c * (self.times[1] - self.times[0]);
        let project = |trial: [f64; 3]| law.project_in_time(trial, per_velocity);
        let mut projected = project([lambda[0] - c * pair.gap, trial(0), trial(1)]);
        for i in (0..2).filter(|i| !moves[*i]) {
            projected.derivative.iter_mut().for_each(|row| row[i + 1] = 0.0);
        }
        let [p, t1, t2] = projected.traction;
        if projected.status == Status::Stick && law.utilisation([t1, t2], p) > 1.0 - AT_LIMIT {
            let beyond = project([p, (1.0 + 2.0 * AT_LIMIT) * t1, (1.0 + 2.0 * AT_LIMIT) * t2]);
            (projected.derivative, projected.status) = (beyond.derivative, beyond.status);
        }
        Traction { projected, axes, d_axes, slip }
    }

    /// The unknown traction of a site.
    fn multiplier(&self, k: usize, lambda: &[f64]) -> [f64; 3] {
        let own = &lambda[self.components() * k..self.components() * (k + 1)];
        [own[0], own.get(1).copied().unwrap_or(0.0), own.get(2).copied().unwrap_or(0.0)]
    }

    /// The traction with which a site that gives way has no gap and no slip.
    fn base(&self, k: usize) -> [f64; 3] {
        self.enforcement.base(self.memory[k].traction)
    }

    /// The sites as they are found in a state, with their tractions along the axes.
    ///
    /// # Errors
    /// A master that cannot be touched.
    pub(crate) fn found(&self, sides: &Sides<'_>, lambda: &[f64]) -> Result<Vec<(SiteResult, [f64; 3])>, PlaceError> {
        let master = self.met(sides)?;
        let of = |k: usize| {
            let (placed, pair) = self.pair(k, sides, (master.as_ref(), f64::INFINITY), |_| false);
            let mut out = SiteResult { x: placed.x, weight: self.sites[k].weight, ..SiteResult::default() };
            let Some(Ok(touch)) = pair else { return (out, [0.0; 3]) };
            let found = self.traction(k, &touch, self.multiplier(k, lambda));
            let pair = &touch.pair;
            let [p, t1, t2] = found.projected.traction;
            out.normal = pair.normal;
            out.gap = Some(pair.gap);
            out.pressure = p;
            out.status = found.projected.status;
            // The traction of the law is that along the slip; on the slave acts its opposite.
            out.friction = -(found.axes[0] * t1 + found.axes[1] * t2);
            if let (Some(law), true) = (&self.friction, out.status != Status::Open) {
                out.increment = found.axes[0] * found.slip[0] + found.axes[1] * found.slip[1];
                out.utilisation = law.utilisation([t1, t2], p);
                let before = self.memory[k].slip;
                out.slip = (before[0] + found.slip[0]).hypot(before[1] + found.slip[1]);
            }
            (out, found.projected.traction)
        };
        Ok((0..self.sites.len()).into_par_iter().map(of).collect())
    }

    /// Takes a state as the one that slips count from.
    ///
    /// # Errors
    /// A master that cannot be touched.
    pub(crate) fn accept_sites(&mut self, sides: &Sides<'_>, lambda: &[f64]) -> Result<(), PlaceError> {
        let master = self.met(sides)?;
        let mut memory = Vec::with_capacity(self.sites.len());
        for k in 0..self.sites.len() {
            let Some(Ok(touch)) = self.pair(k, sides, (master.as_ref(), f64::INFINITY), |_| false).1 else {
                memory.push(SiteMemory::default());
                continue;
            };
            let found = self.traction(k, &touch, self.multiplier(k, lambda));
            let pair = &touch.pair;
            let mut own = SiteMemory { traction: found.projected.traction, stuck: pair.stuck, slip: [0.0; 2] };
            if self.friction.is_some() && found.projected.status != Status::Open {
                let before = self.memory[k].slip;
                own.slip = std::array::from_fn(|i| before[i] + found.slip[i]);
                // Friction is kept along the axes of the new anchor.
                let on_slave = found.axes[0] * own.traction[1] + found.axes[1] * own.traction[2];
                let slipped = found.axes[0] * own.slip[0] + found.axes[1] * own.slip[1];
                self.memory[k].stuck = own.stuck;
                if let (_, Some(Ok(again))) = self.pair(k, sides, (master.as_ref(), f64::INFINITY), |_| false) {
                    let (new, _) = axes(&again.pair);
                    own.traction[1] = new[0].dot(&on_slave);
                    own.traction[2] = new[1].dot(&on_slave);
                    own.slip = new.map(|e| e.dot(&slipped));
                }
            }
            memory.push(own);
        }
        self.memory = memory;
        self.times[0] = self.times[1];
        Ok(())
    }
}

/// Share of the limit of friction within which a site is at it, as what slipped is when the next increment starts. Either
/// derivative serves at a switch; with that of slip a slip zone does not start each increment stuck, to be freed site by
/// site. More than the tolerance of Newton's method, which ends that near to the limit.
const AT_LIMIT: f64 = 1e-8;

/// Sine of the angle to the normal below which the projection of an axis tells no direction any more.
const STEEP: f64 = 1e-8;

/// The axes of friction of a pair, and their variations.
fn axes(pair: &Pair) -> ([Vector<3>; 2], Vec<[Vector<3>; 2]>) {
    let normal = pair.normal;
    let along = pair.axis.direction - normal * normal.dot(&pair.axis.direction);
    let length = along.norm();
    if length <= STEEP * pair.axis.direction.norm() {
        // The axis stands on the surface: without one, any will do.
        let first = any_tangent(&normal);
        return ([first, normal.cross(&first)], vec![[Vector::<3>::zeros(); 2]; pair.unknowns.len()]);
    }
    let first = along / length;
    let second = normal.cross(&first);
    let variations = (pair.d_normal.iter().zip(&pair.axis.variation))
        .map(|(dn, da)| {
            let d = da
                - normal * normal.dot(da)
                - dn * normal.dot(&pair.axis.direction)
                - normal * dn.dot(&pair.axis.direction);
            let d_first = (d - first * first.dot(&d)) / length;
            [d_first, dn.cross(&first) + normal.cross(&d_first)]
        })
        .collect();
    ([first, second], variations)
}
