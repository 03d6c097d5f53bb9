//! A contact of sites as the system sees it.

use super::partner::Partners;
use super::{Contact, Sides, SiteMemory};
use crate::body::Body;
use crate::body::PlaceError;
use crate::contact_law::{ContactLaw, PointHistory};
use crate::enforcement::{SOFTER, WAVE};
use crate::heat::{Conducting, Means, first_unknowns};
use crate::inside::Inside;
use crate::interaction::{
    Assembler, Bodies, Drawn, Interaction, InteractionUnknowns, Iterated, NotItsHistory, OuterIteration, Passing,
    StatePath,
};
use crate::pair::Stuck;
use crate::part::Part;
use crate::points::{Function, MaterialPoint, Sampling, Site};
use crate::shown_surface::{ShownSurface, between_sites};
use crate::site_result::SiteResult;
use rayon::prelude::*;
use signorini_geometry::{Point, Vector};

impl<'a> Bodies<'a> {
    pub(crate) fn sides(&self, contact: &Contact) -> Sides<'a> {
        Sides {
            slave: self.side(&contact.slave),
            master: self.side(&contact.master),
            first: [self.first[contact.slave.body], self.first[contact.master.body]],
        }
    }
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

    fn parts(&self) -> [&Part; 2] {
        [&self.slave, &self.master]
    }

    fn law(&self) -> &ContactLaw {
        &self.law
    }

    fn law_mut(&mut self) -> &mut ContactLaw {
        &mut self.law
    }

    fn stiffness(&self, bodies: &[Box<dyn Body>]) -> f64 {
        let own = self.law.stiffness.iter().zip(self.sites()).map(|(c, s)| c * s.weight);
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
        if self.law.enforcement.takes_stress() {
            return;
        }
        for (c, w) in self.law.stiffness.iter_mut().zip(weights) {
            *c = WAVE * share * if c.is_finite() { c.min(given_way / w) } else { otherwise / w };
        }
    }

    fn add_to(
        &self,
        at: Bodies<'_>,
        own: InteractionUnknowns<'_>,
        out: &mut Assembler<'_>,
    ) -> Result<usize, PlaceError> {
        self.add_sites(&at.sides(self), (own.multipliers, own.first), out)
    }

    fn results(&self, at: Bodies<'_>, own: InteractionUnknowns<'_>) -> Result<Vec<SiteResult>, PlaceError> {
        Ok(self.found(&at.sides(self), own.multipliers)?.into_iter().map(|f| f.0).collect())
    }

    fn accept(&mut self, at: Bodies<'_>, own: InteractionUnknowns<'_>) -> Result<(), PlaceError> {
        let sides = at.sides(self);
        self.accept_sites(&sides, own.multipliers)
    }

    fn augment(
        &mut self,
        at: Bodies<'_>,
        own: InteractionUnknowns<'_>,
        found: &[SiteResult],
        around: OuterIteration,
    ) -> Result<f64, PlaceError> {
        let tractions = match self.law.takes_over() {
            true => self.found(&at.sides(self), own.multipliers)?.into_iter().map(|f| f.1).collect(),
            false => Vec::new(),
        };
        Ok(self.law.augment(found, &around, &tractions))
    }

    fn history(&self) -> [Vec<f64>; 2] {
        let turned = self.turned.iter().flat_map(|t| t.iter().copied());
        let scales = self.law.scales().chain(turned).collect();
        [self.law.kept.iter().zip(&self.law.history).zip(&self.memory).flat_map(numbers).collect(), scales]
    }

    fn restore(&mut self, [sites, scales]: &[Vec<f64>; 2]) -> Result<(), NotItsHistory> {
        let stranger = || NotItsHistory { contact: self.name.clone() };
        if sites.len() != NUMBERS * self.memory.len() {
            return Err(stranger());
        }
        let Some(&[a, b, c, d, e, f]) = self.law.restore_scales(scales) else { return Err(stranger()) };
        ((self.law.kept, self.law.history), self.memory) = sites.chunks(NUMBERS).map(memory).unzip();
        self.turned = [Vector::<3>::new(a, b, c), Vector::<3>::new(d, e, f)];
        Ok(())
    }
}

impl Iterated for Contact {
    fn begin(&mut self, _: f64) {
        self.partners = Partners::new();
    }

    fn depart(&mut self, from: Bodies<'_>) {
        let rubs = self.law.is_tangential() && !from.bodies[self.slave.body].is_rigid();
        self.departed = rubs.then(|| [&self.slave, &self.master].map(|part| from.side(part).1.clone()));
    }

    fn give_way(&mut self, force_per_gap: Option<f64>) -> bool {
        self.law.restore();
        if let Some(force_per_gap) = force_per_gap {
            self.law.give_way(force_per_gap);
        }
        true
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

    /// A curve under tension presses on what it lies along: what is out of balance at its nodes tells by how much.
    fn initial_multipliers(&self, at: Bodies<'_>, residual: &[f64]) -> Option<Vec<f64>> {
        let mut out = self.law.multipliers();
        let sides = at.sides(self);
        let (body, state) = sides.master;
        let is_curve = sides.slave.0.curve(self.slave.group.as_deref()).is_some();
        let master = body.master(self.master.group.as_deref(), state).ok()?;
        if !is_curve || self.sampling != Sampling::Nodes {
            return None;
        }
        let own = sides.first[0] as usize..sides.first[0] as usize + sides.slave.0.unknowns();
        for (k, values) in out.chunks_mut(self.components()).enumerate() {
            let (_, Some(Ok(touch))) = self.pair(k, &sides, (master.as_ref(), f64::INFINITY), |_| false) else {
                continue;
            };
            let terms = touch.pair.unknowns.iter().zip(&touch.pair.opening);
            let terms = terms.map(|(u, o)| (*u as usize, o)).filter(|(u, _)| own.contains(u));
            let (power, square) = terms.fold((0.0, 0.0), |(p, s), (u, o)| (p + residual[u] * o, s + o * o));
            // Of what lies so far away that a force like this would not close it nothing is known.
            let pressure = power / (square * self.sites()[k].weight);
            if pressure > self.law.stiffness[k] * touch.pair.gap.max(0.0) {
                values[0] = pressure;
            }
        }
        Some(out)
    }
}

impl Passing for Contact {
    fn free_way(&self, path: StatePath<'_>) -> Result<f64, PlaceError> {
        Ok(self.share_of_way(path))
    }

    fn inside(&self, at: Bodies<'_>, is_start: bool) -> Result<Option<Inside>, PlaceError> {
        let (body, state) = at.side(&self.slave);
        let sites: Vec<_> = self.sites().iter().map(|site| body.placed(state, site)).collect();
        at.inside([&self.slave, &self.master], &sites, is_start)
    }
}

impl Drawn for Contact {
    fn as_points(&self) -> Option<&Contact> {
        Some(self)
    }

    fn as_points_mut(&mut self) -> Option<&mut Contact> {
        Some(self)
    }

    fn surface(&self, at: Bodies<'_>, own: InteractionUnknowns<'_>) -> Result<Option<ShownSurface>, PlaceError> {
        let (body, state) = at.side(&self.slave);
        if self.sampling != Sampling::Nodes {
            return Ok(None);
        }
        let Some(surface) = body.surface(self.slave.group.as_deref(), state) else { return Ok(None) };
        let start = body.start();
        let rest: Vec<Point<3>> = self.sites.iter().map(|site| body.placed(&start, site).x).collect();
        Ok(between_sites(surface.as_ref(), &rest, &self.results(at, own)?))
    }
}

/// Numbers of the memory of a site.
const NUMBERS: usize = 22;

fn numbers(((traction, history), memory): ((&[f64; 3], &PointHistory), &SiteMemory)) -> [f64; NUMBERS] {
    let mut out = [0.0; NUMBERS];
    out[..3].copy_from_slice(traction);
    out[3..5].copy_from_slice(&memory.slip);
    if let Some(stuck) = &memory.stuck {
        out[5] = 1.0;
        out[6] = f64::from(stuck.point.patch);
        out[7..10].copy_from_slice(&stuck.point.xi);
        out[10..13].copy_from_slice(stuck.on_slave.as_slice());
        out[13..16].copy_from_slice(stuck.on_master.as_slice());
    }
    (out[16], out[17]) = (history.opened, history.offset);
    out[18..21].copy_from_slice(&history.trial);
    out[21] = history.state;
    out
}

fn memory(n: &[f64]) -> (([f64; 3], PointHistory), SiteMemory) {
    let vector = |k: usize| Vector::<3>::new(n[k], n[k + 1], n[k + 2]);
    let memory = SiteMemory {
        slip: [n[3], n[4]],
        stuck: (n[5] != 0.0).then(|| Stuck {
            point: MaterialPoint { patch: n[6] as u32, xi: [n[7], n[8], n[9]] },
            on_slave: vector(10),
            on_master: vector(13),
        }),
    };
    let history = PointHistory { opened: n[16], offset: n[17], trial: [n[18], n[19], n[20]], state: n[21] };
    (([n[0], n[1], n[2]], history), memory)
}

impl Conducting for Contact {
    fn means(&self, at: Bodies<'_>) -> Result<Option<Vec<Means>>, PlaceError> {
        let sides = at.sides(self);
        let dimensions = [sides.slave.0, sides.master.0].map(|body| body.thermal().map(|own| own.dimension()));
        let master = self.met(&sides)?;
        let of = |k: usize| {
            let (placed, pair) = self.pair(k, &sides, (master.as_ref(), f64::INFINITY), |_| false);
            let Some(Ok(touch)) = pair else { return Means::default() };
            let on_master = master.at(&touch.pair.point);
            let side = |dimension: Option<usize>, functions: &[Function]| {
                dimension.map_or(Vec::new(), |d| first_unknowns(functions, d))
            };
            [side(dimensions[0], &placed.functions), side(dimensions[1], &on_master.functions)]
        };
        Ok(Some((0..self.sites().len()).into_par_iter().map(of).collect()))
    }

    fn conducts(&self) -> bool {
        true
    }
}
