//! What is told of rigid bodies at rest, and what their contacts remember.

use super::complementarity::Block;
use super::increment::SoFar;
use super::motion::{Loaded, Motion, Stepped};
use super::polyhedra::Polyhedra;
use super::touching::{Id, Touching, Twists, Wanted, touching};
use crate::body::BodyState;
use crate::contact::{Contact, SiteMemory};
use crate::increment::IncrementResult;
use crate::points::Order;
use crate::site_result::SiteResult;
use crate::system::{AssemblyError, Held, System, SystemState};
use nalgebra::DMatrix;
use signorini_contact::Status;
use signorini_geometry::Vector;

/// Share of the limit of friction from which a point slips.
const AT_LIMIT: f64 = 1e-8;
/// Slip relative to the size of the bodies that is more than rounding.
const MOVED: f64 = 1e-10;
/// Eigenvalues relative to the largest that are rounding.
const RANK: f64 = 1e-12;

impl Loaded<'_> {
    /// Friction on the slave's partner along the slip: that on the slave is its opposite.
    pub fn friction(&self) -> Vector<3> {
        let axes = self.point.slip_axes();
        (1..self.point.rows()).map(|k| self.point.axes[axes[k - 1]] * self.force[k]).sum()
    }

    /// Friction along both axes, per weight.
    fn tractions(&self) -> [f64; 2] {
        let axes = self.point.slip_axes();
        let mut out = [0.0; 2];
        (1..self.point.rows()).for_each(|k| out[axes[k - 1]] = self.force[k] / self.point.weight);
        out
    }

    fn utilisation(&self) -> f64 {
        let pressure = self.force[0] / self.point.weight;
        self.point.law.map_or(0.0, |law| law.utilisation(self.tractions(), pressure))
    }
}

impl<'a> Motion<'a> {
    /// Rigid bodies on their way to a time.
    ///
    /// # Errors
    /// Loads that cannot act.
    pub fn new(system: &'a System, from: &SystemState, time: f64) -> Result<Self, AssemblyError> {
        let (first, count) = system.numbering();
        let mut motion = Motion {
            system,
            contacts: system.contacts.iter().filter_map(|c| c.as_points()).collect(),
            first,
            size: 0.0,
            load: 1.0,
            turns: vec![false; count],
            extent: vec![1.0; count],
        };
        for (k, body) in system.bodies.iter().enumerate().filter(|(_, b)| b.unknowns() > 0) {
            motion.size = motion.size.max(body.size());
            let modes = body.rigid_modes(&from.bodies[k]);
            for unknown in 0..body.unknowns() {
                let place = motion.first[k] as usize + unknown;
                motion.turns[place] = modes[..3].iter().all(|m| m[unknown] == 0.0);
                motion.extent[place] = body.size();
            }
        }
        let forces = motion.loads(&from.bodies, time)?.forces;
        // As a step, in units in which a force is a step by the size, and a moment one by a turn.
        let step: Vec<f64> = (0..count)
            .map(|k| forces[k] * if motion.turns[k] { 1.0 / motion.extent[k] } else { motion.extent[k] })
            .collect();
        let load = motion.largest(&step);
        // Without loads there are no forces, whatever their unit.
        if load > 0.0 {
            motion.load = load;
        }
        Ok(motion)
    }

    /// Whether a support asks for a motion.
    ///
    /// # Errors
    /// Supports that cannot act.
    pub fn is_pulled(&self, bodies: &[BodyState], time: f64) -> Result<bool, AssemblyError> {
        let (single, coupled) = self.system.held(bodies, time)?;
        let lacks = |h: &Held| {
            let (unknown, factor) = h.constraint.terms[0];
            self.relative(unknown as usize, h.constraint.violation / factor) > 1e-12
        };
        Ok(single.iter().chain(&coupled).any(lacks))
    }

    /// The points of all contacts, and what holds the bodies.
    ///
    /// # Errors
    /// Loads and supports that cannot act.
    pub fn result(
        &self,
        state: &SystemState,
        time: f64,
        (found, so_far): (&Stepped<'_>, &SoFar),
    ) -> Result<IncrementResult, AssemblyError> {
        let loads = self.loads(&state.bodies, time)?.forces;
        let mut residual: Vec<f64> = loads.iter().map(|f| -f).collect();
        let mut sizes: Vec<f64> = loads.iter().map(|f| f.abs()).collect();
        for l in &found.loaded {
            let friction = l.friction();
            for (a, unknown) in l.point.pair.unknowns.iter().enumerate() {
                let mut force = -l.force[0] * l.point.pair.opening[a];
                if l.point.law.is_some() {
                    force += friction.dot(&l.point.pair.slip[a]);
                }
                residual[*unknown as usize] += force;
                sizes[*unknown as usize] += force.abs();
            }
        }
        let (single, coupled) = self.system.held(&state.bodies, time)?;
        let mut support_forces = vec![[Vector::<3>::zeros(); 2]; self.system.supports.len()];
        for (held, reaction) in coupled.iter().zip(&found.reactions) {
            held.add_reaction(-reaction, &mut support_forces);
            held.constraint.terms.iter().for_each(|(u, f)| residual[*u as usize] += f * reaction);
        }
        for held in &single {
            let (unknown, factor) = held.constraint.terms[0];
            held.add_reaction(residual[unknown as usize] / factor, &mut support_forces);
            residual[unknown as usize] = 0.0;
        }
        let force = |k: usize, v: f64| v.abs() / if self.turns[k] { self.extent[k] } else { 1.0 };
        let most = (0..sizes.len()).map(|k| force(k, sizes[k])).fold(f64::MIN_POSITIVE, f64::max);
        let lacks = (0..sizes.len()).map(|k| force(k, residual[k])).fold(0.0f64, f64::max);
        Ok(IncrementResult {
            iterations: so_far.iterations,
            history: so_far.history.clone(),
            way: so_far.way.clone(),
            sites: (0..self.contacts.len()).map(|c| self.sites(c, state, (found, so_far))).collect(),
            dissipated: (0..self.contacts.len()).map(|c| so_far.work(c)).collect(),
            support_forces,
            unknowns: sizes.len(),
            imbalance: lacks / most,
            is_indeterminate: self.is_indeterminate(found),
            stability: Some(so_far.stability.clone()),
            ..IncrementResult::default()
        })
    }

    /// The points of a contact; those that touch in several places are told once for each that carries.
    pub(super) fn sites(
        &self,
        contact: usize,
        state: &SystemState,
        (found, so_far): (&Stepped<'_>, &SoFar),
    ) -> Vec<SiteResult> {
        let still: Twists = vec![None; state.bodies.len()];
        let only = [self.contacts[contact]];
        let at = self.bodies_of(&state.bodies);
        let is_of_polyhedra = Polyhedra::of(only[0], &at.sides(only[0])).is_some();
        let by = |id: Id, _: f64| id.place == 0 || is_of_polyhedra;
        let wanted = Wanted::near(&by, self.size);
        let mut nearest = touching(&only, at, &still, Order::First, &wanted);
        let open = |p: &Touching<'_>| SiteResult {
            x: p.centre,
            radius: (p.centre - p.x).norm(),
            normal: p.pair.normal,
            weight: p.weight,
            gap: Some(p.pair.gap),
            ..SiteResult::default()
        };
        let carrying = |l: &Loaded<'_>, open: SiteResult| {
            let site = l.point.id.site;
            let slipped = so_far.slipped.get(&(contact, site)).copied().unwrap_or_default();
            let utilisation = l.utilisation();
            let slips = l.point.law.is_none() || (utilisation > 1.0 - AT_LIMIT && slipped.path > MOVED * self.size);
            SiteResult {
                x: l.point.centre,
                normal: l.point.pair.normal,
                gap: Some(l.point.pair.gap),
                pressure: l.force[0] / open.weight,
                friction: -l.friction() / open.weight,
                status: if slips { Status::Slip } else { Status::Stick },
                increment: slipped.slip,
                slip: slipped_before(self.contacts[contact], site) + slipped.path,
                utilisation,
                ..open
            }
        };
        let loaded = || found.loaded.iter().filter(|l| l.point.id.contact == contact && l.force[0] > 0.0);
        if is_of_polyhedra {
            // The pairs of features that carry, or the nearest.
            nearest.sort_by(|a, b| a.pair.gap.total_cmp(&b.pair.gap));
            let out: Vec<_> = loaded().map(|l| carrying(l, open(&l.point))).collect();
            return if out.is_empty() { nearest.first().map(open).into_iter().collect() } else { out };
        }
        let mut out = Vec::new();
        for p in nearest {
            let before = out.len();
            out.extend(loaded().filter(|l| l.point.id.site == p.id.site).map(|l| carrying(l, open(&p))));
            if out.len() == before {
                out.push(open(&p));
            }
        }
        out
    }

    /// The tractions of the sites of each contact, and what they remember besides.
    pub fn memory(&self, found: &Stepped<'_>, so_far: &SoFar) -> Vec<(Vec<[f64; 3]>, Vec<SiteMemory>)> {
        let none = |c: &&Contact| (vec![[0.0; 3]; c.sites().len()], vec![SiteMemory::default(); c.sites().len()]);
        let mut out: Vec<_> = self.contacts.iter().map(none).collect();
        for l in found.loaded.iter().filter(|l| l.force[0] > 0.0) {
            let id = l.point.id;
            let (tractions, memory) = &mut out[id.contact];
            let (traction, own) = (&mut tractions[id.site], &mut memory[id.site]);
            traction[0] += l.force[0] / l.point.weight;
            if id.place == 0 {
                let [a, b] = l.tractions();
                *traction = [traction[0], a, b];
                own.stuck = l.point.pair.stuck;
            }
            let slipped = so_far.slipped.get(&(id.contact, id.site)).map_or(0.0, |s| s.path);
            own.slip = [slipped_before(self.contacts[id.contact], id.site) + slipped, 0.0];
        }
        out
    }

    /// Whether other forces of the points that carry and stick would do as well.
    fn is_indeterminate(&self, found: &Stepped<'_>) -> bool {
        let n = self.turns.len();
        let carrying: Vec<&Loaded<'_>> = found.loaded.iter().filter(|l| l.force[0] > 0.0).collect();
        let (blocks, all) = self.rows(&carrying.iter().map(|l| &l.point).collect::<Vec<_>>(), &[]);
        let sticks = |l: &Loaded<'_>| l.utilisation() < 1.0 - AT_LIMIT;
        let kept = |(b, l): (&Block<'_>, &&Loaded<'_>)| b.first..b.first + if sticks(l) { b.rows } else { 1 };
        let rows: Vec<usize> = blocks.iter().zip(&carrying).flat_map(kept).collect();
        let m = rows.len();
        if m == 0 {
            return false;
        }
        let arm = |k: usize| if self.turns[k] { self.extent[k] } else { 1.0 };
        let rows = DMatrix::from_fn(m, n, |i, j| all[(rows[i], j)] / arm(j));
        let gram = if m < n { &rows * rows.transpose() } else { rows.tr_mul(&rows) };
        let eigen = gram.symmetric_eigenvalues();
        let rank = eigen.iter().filter(|v| **v > RANK * eigen.amax()).count();
        rank < m
    }
}

/// How far a site has slipped in all before the increment.
fn slipped_before(contact: &Contact, site: usize) -> f64 {
    let [a, b] = contact.memory[site].slip;
    a.hypot(b)
}

impl Contact {
    /// The values of its own unknowns with these tractions.
    pub(super) fn values(&self, tractions: &[[f64; 3]]) -> Vec<f64> {
        tractions.iter().flat_map(|traction| traction[..self.components()].to_vec()).collect()
    }
}
