//! An increment in time: impacts, rest, and steps without impacts between them.

use super::driven::Driven;
use super::impact::in_space;
use super::masses::Masses;
use super::step::{Forces, Smooth, Start};
use crate::body::BodyState;
use crate::increment_error::IncrementError;
use crate::points::Order;
use crate::rigid_system::increment::SoFar;
use crate::rigid_system::motion::{Loaded, Motion, Stepped, TOUCHES};
use crate::rigid_system::polyhedra::free_share;
use crate::rigid_system::touching::{Id, Touching, Wanted, touching};
use crate::system::{AssemblyError, SystemState};
use signorini_geometry::Vector;
use std::cell::Cell;
use std::collections::{BTreeMap, BTreeSet};

/// A flight between two impacts that is shorter than this part of the increment is none: it is no higher than a millionth of the
/// height that bodies fall in an increment, and endless sequences of ever shorter flights end.
const SHORT_FLIGHT: f64 = 1e-3;
/// Velocity relative to what loads give in an increment that is rounding.
const AT_REST: f64 = 1e-10;
/// Impulse relative to the largest that is rounding.
const NOTHING: f64 = 1e-14;
/// Halvings of an increment, and steps in one.
const MOST_HALVINGS: i32 = 20;
const MOST_STEPS: usize = 20_000;
/// Gap, relative to the size of the largest free body, within which polyhedra are looked at for impacts: the time of one is found by
/// secants from there on, and by halves before.
const NEAR: f64 = 0.1;
/// Tries to find the time of an impact.
const MOST_TRIES: usize = 100;

/// Impulses of a point, as they sum up in an increment.
struct Impulse<'a> {
    normal: f64,
    /// On the slave's partner.
    friction: Vector<3>,
    point: Touching<'a>,
}

/// An increment on its way.
pub struct InTime<'a, 'b> {
    motion: &'b Motion<'a>,
    masses: &'b Masses,
    pub so_far: SoFar,
    impulses: BTreeMap<Id, Impulse<'a>>,
    /// Impulses of the supports.
    pub supports: Vec<[Vector<3>; 2]>,
}

/// Bodies with their velocities.
pub struct InMotion {
    pub bodies: Vec<BodyState>,
    pub velocities: Vec<f64>,
}

/// What may touch in a state: the least of all gaps that count, and whether one is closed too far.
struct Least {
    scaled: f64,
    gap: f64,
}

impl<'a, 'b> InTime<'a, 'b> {
    pub fn new(motion: &'b Motion<'a>, masses: &'b Masses) -> Self {
        let supports = vec![[Vector::<3>::zeros(); 2]; motion.system.supports.len()];
        InTime { motion, masses, so_far: SoFar::default(), impulses: BTreeMap::new(), supports }
    }

    fn touches(&self) -> f64 {
        TOUCHES * self.motion.size
    }

    /// The bodies at a time.
    pub fn advance(
        &mut self,
        from: &SystemState,
        time: f64,
        report: &mut dyn FnMut(usize, f64) -> bool,
    ) -> Result<InMotion, IncrementError> {
        let whole = time - from.time;
        let mut now = InMotion { bodies: from.bodies.clone(), velocities: from.velocities.clone() };
        let mut t = from.time;
        let mut share = whole;
        let mut forces = Forces::new();
        for _ in 0..MOST_STEPS {
            if t >= time {
                return Ok(now);
            }
            let left = time - t;
            let to = if share >= left * (1.0 - 1e-9) { time } else { t + share };
            let driven = Driven::new(self.motion.system, &now.bodies, [t, to]);
            driven.place(0, &mut now.bodies);
            let acceleration = self.motion.acceleration(self.masses, &now.bodies, driven.times[1])?;
            // A flight of the duration `2 u / a`, or one whose height is that of rounding.
            let calm = (0.5 * SHORT_FLIGHT * whole * acceleration).max((8.0 * acceleration * self.touches()).sqrt());
            let closed = self.closed(&now.bodies);
            self.strike(&mut now, &driven, (&closed, calm))?;
            if self.rests(&mut now, &driven, AT_REST * acceleration * whole)? {
                t = to;
                continue;
            }
            let (kept, leaving) = self.parted(&now, &driven, (&closed, calm));
            let found = self.step(&now, &driven, (&kept, &leaving), &forces)?;
            let Some((found, end)) = found else {
                share = 0.5 * (to - t);
                if share < whole * 0.5f64.powi(MOST_HALVINGS) {
                    return Err(self.lost());
                }
                continue;
            };
            forces = found.loaded.iter().map(|l| (l.point.id, l.force)).collect();
            self.take(found, end - t, &mut now);
            share = whole;
            t = end;
            self.so_far.history.push(0.0);
            if !report(self.so_far.iterations, 0.0) {
                return Err(IncrementError::Interrupted);
            }
        }
        Err(self.lost())
    }

    fn lost(&self) -> IncrementError {
        let worst = Some(format!(
            " and {} steps and impacts; shorten the increments, or give contacts that rattle a smaller `restitution`",
            self.so_far.history.len()
        ));
        IncrementError::NotConverged { history: vec![f64::INFINITY; self.so_far.iterations + 1], worst }
    }

    /// The points that touch.
    fn closed(&self, bodies: &[BodyState]) -> BTreeSet<Id> {
        let still = vec![None; bodies.len()];
        let touches = self.touches();
        let by = |_: Id, gap: f64| gap <= touches;
        let wanted = Wanted::near(&by, touches);
        let at = self.motion.bodies_of(bodies);
        touching(&self.motion.contacts, at, &still, Order::First, &wanted).into_iter().map(|p| p.id).collect()
    }

    /// Impacts of what touches and closes.
    fn strike(
        &mut self,
        now: &mut InMotion,
        driven: &Driven,
        (closed, calm): (&BTreeSet<Id>, f64),
    ) -> Result<(), IncrementError> {
        let at = (&now.bodies[..], &now.velocities[..]);
        let Some(found) = self.motion.impact(self.masses, at, driven, (closed, calm))? else { return Ok(()) };
        now.velocities = found.velocities;
        for (id, work) in found.friction_work {
            self.so_far.slipped.entry((id.contact, id.site)).or_default().work += work;
        }
        for (own, more) in self.supports.iter_mut().zip(&found.supports) {
            own.iter_mut().zip(more).for_each(|(sum, m)| *sum += m);
        }
        for point in found.points {
            let force = found.impulses[&point.id];
            self.add(point, &force, 1.0);
        }
        Ok(())
    }

    /// Adds mean forces for a duration.
    fn add(&mut self, point: Touching<'a>, force: &[f64; 3], duration: f64) {
        if force[0] <= 0.0 {
            return;
        }
        let friction = in_space(&point, force) * duration;
        let normal = force[0] * duration;
        match self.impulses.get_mut(&point.id) {
            Some(own) => {
                own.normal += normal;
                own.friction += friction;
                own.point = point;
            }
            None => {
                self.impulses.insert(point.id, Impulse { normal, friction, point });
            }
        }
    }

    /// Whether bodies without velocity rest to the end of a step: there are forces within all cones that balance the loads.
    fn rests(&mut self, now: &mut InMotion, driven: &Driven, slow: f64) -> Result<bool, AssemblyError> {
        let motion = self.motion;
        let speed = |k: usize| now.velocities[k].abs() * if motion.turns[k] { motion.extent[k] } else { 1.0 };
        if (0..now.velocities.len()).any(|k| speed(k) > slow) || driven.moves() {
            return Ok(false);
        }
        let [start, middle, end] = driven.times;
        let mut found = Vec::new();
        for time in [middle, end] {
            match motion.at_rest(&now.bodies, time)? {
                Some(own) => found.push(own),
                None => return Ok(false),
            }
        }
        now.velocities.iter_mut().for_each(|v| *v = 0.0);
        let Stepped { loaded, reactions, .. } = found.swap_remove(0);
        let mut lacks: Vec<f64> = motion.loads(&now.bodies, middle)?.forces.iter().map(|f| -f).collect();
        for l in &loaded {
            let friction = l.friction();
            for (a, unknown) in l.point.pair.unknowns.iter().enumerate() {
                lacks[*unknown as usize] -= l.force[0] * l.point.pair.opening[a];
                if l.point.law.is_some() {
                    lacks[*unknown as usize] += friction.dot(&l.point.pair.slip[a]);
                }
            }
        }
        let (single, coupled) = motion.system.held(&now.bodies, middle)?;
        for (held, r) in coupled.iter().zip(&reactions) {
            held.add_reaction(-r * (end - start), &mut self.supports);
            held.constraint.terms.iter().for_each(|(u, f)| lacks[*u as usize] += f * r);
        }
        for held in &single {
            let (unknown, factor) = held.constraint.terms[0];
            held.add_reaction(lacks[unknown as usize] / factor * (end - start), &mut self.supports);
        }
        for l in loaded {
            self.add(l.point, &l.force, end - start);
        }
        Ok(true)
    }

    /// Points that stay closed, and those that open, with their velocities.
    fn parted(
        &self,
        now: &InMotion,
        driven: &Driven,
        (closed, calm): (&BTreeSet<Id>, f64),
    ) -> (BTreeSet<Id>, BTreeMap<Id, f64>) {
        let points: Vec<Touching<'a>> =
            self.motion.named(&now.bodies, &driven.at_start(), closed).into_values().collect();
        let opening = self.motion.opening(&points, &now.velocities);
        let (mut kept, mut leaving) = (BTreeSet::new(), BTreeMap::new());
        for (p, u) in points.iter().zip(opening) {
            if u <= calm {
                kept.insert(p.id);
            } else {
                leaving.insert(p.id, u);
            }
        }
        (kept, leaving)
    }

    /// A step to its end, or to the first impact on the way, with its end.
    fn step(
        &self,
        now: &InMotion,
        driven: &Driven,
        (closed, leaving): (&BTreeSet<Id>, &BTreeMap<Id, f64>),
        initial: &Forces,
    ) -> Result<Option<(Smooth<'a>, f64)>, AssemblyError> {
        let [start, _, end] = driven.times;
        let whole = end - start;
        let from = Start { bodies: &now.bodies, velocities: &now.velocities };
        let least = |bodies: &[BodyState], after: f64| -> Least {
            let found = Cell::new((f64::INFINITY, f64::INFINITY));
            let by = |id: Id, gap: f64| {
                if !closed.contains(&id) {
                    // What leaves has no gap at first: its gap per time counts.
                    let scaled = match leaving.get(&id) {
                        Some(velocity) if after == 0.0 => *velocity,
                        Some(_) => gap / after,
                        None => gap / whole,
                    };
                    if scaled < found.get().0 {
                        found.set((scaled, gap));
                    }
                }
                false
            };
            let still = vec![None; bodies.len()];
            let wanted = Wanted::near(&by, NEAR * self.motion.size);
            touching(&self.motion.contacts, self.motion.bodies_of(bodies), &still, Order::First, &wanted);
            let (scaled, gap) = found.get();
            Least { scaled, gap }
        };
        let solve = |to: f64| -> Result<Option<Smooth<'a>>, AssemblyError> {
            let driven = Driven::new(self.motion.system, &now.bodies, [start, to]);
            self.motion.smooth(self.masses, &from, &driven, (closed, initial))
        };
        let Some(mut found) = solve(end)? else { return Ok(None) };
        // Polyhedra that come near each other do so bit by bit.
        let between = [&now.bodies, &found.bodies].map(|states| self.motion.bodies_of(states));
        let share = free_share(&self.motion.contacts, between);
        let (whole, end) = (whole * share, start + whole * share);
        if share < 1.0 {
            let Some(shorter) = solve(end)? else { return Ok(None) };
            found = shorter;
        }
        if self.passes(now, &found)? {
            return Ok(None);
        }
        let at_end = least(&found.bodies, whole);
        if at_end.gap >= -self.touches() {
            return Ok(Some((found, end)));
        }
        // The first impact, by secants that keep it between both ends.
        let at_start = least(&now.bodies, 0.0);
        let (mut low, mut high) = ([0.0, at_start.scaled.max(f64::MIN_POSITIVE)], [whole, at_end.scaled]);
        for _ in 0..MOST_TRIES {
            let after = (low[0] * high[1] - high[0] * low[1]) / (high[1] - low[1]);
            let after = if after > low[0] && after < high[0] { after } else { 0.5 * (low[0] + high[0]) };
            let Some(found) = solve(start + after)? else { return Ok(None) };
            let there = least(&found.bodies, after);
            let is_narrow = high[0] - low[0] <= 1e-14 * whole;
            if there.gap.abs() <= 0.5 * self.touches() || (is_narrow && there.gap >= -self.touches()) {
                return Ok(Some((found, start + after)));
            }
            if there.scaled > 0.0 {
                low = [after, there.scaled];
                high[1] *= 0.5;
            } else {
                high = [after, there.scaled];
                low[1] *= 0.5;
            }
        }
        Ok(None)
    }

    fn passes(&self, now: &InMotion, found: &Smooth<'_>) -> Result<bool, AssemblyError> {
        let state = |bodies: &[BodyState]| SystemState { bodies: bodies.to_vec(), ..SystemState::default() };
        Ok(self.motion.system.first_passage(&state(&now.bodies), &state(&found.bodies))?.is_some())
    }

    /// Takes a step of a duration.
    fn take(&mut self, found: Smooth<'a>, duration: f64, now: &mut InMotion) {
        self.so_far.way.push(std::mem::replace(&mut now.bodies, found.bodies));
        now.velocities = found.velocities;
        self.so_far.iterations += found.iterations;
        for (own, more) in self.supports.iter_mut().zip(&found.supports) {
            own.iter_mut().zip(more).for_each(|(sum, m)| *sum += m * duration);
        }
        for l in found.loaded {
            if l.force[0] > 0.0 && l.point.law.is_some() {
                let own = self.so_far.slipped.entry((l.point.id.contact, l.point.id.site)).or_default();
                own.slip += l.slip;
                own.path += l.slip.norm();
                own.work += l.friction().dot(&l.slip);
            }
            self.add(l.point, &l.force, duration);
        }
    }

    /// The points that carried in an increment of a duration, with their mean forces: where they touch at its end, or did last.
    pub fn loaded(&mut self, bodies: &[BodyState], duration: f64) -> Vec<Loaded<'a>> {
        let ids: BTreeSet<Id> = self.impulses.keys().copied().collect();
        let mut at_end = self.motion.named(bodies, &vec![None; bodies.len()], &ids);
        let impulses = std::mem::take(&mut self.impulses);
        let touches = self.touches();
        let largest = impulses.values().map(|own| own.normal).fold(0.0, f64::max);
        impulses
            .into_iter()
            .filter(|(_, own)| own.normal > NOTHING * largest)
            .map(|(id, own)| {
                let mut point = own.point;
                if let Some(last) = at_end.remove(&id) {
                    if last.pair.gap <= touches {
                        point = last;
                    } else {
                        point.pair.gap = last.pair.gap;
                    }
                }
                let axes = point.slip_axes();
                let force = std::array::from_fn(|k| match k {
                    0 => own.normal / duration,
                    k if k < point.rows() => point.axes[axes[k - 1]].dot(&own.friction) / duration,
                    _ => 0.0,
                });
                Loaded { point, force, slip: Vector::<3>::zeros() }
            })
            .collect()
    }
}
