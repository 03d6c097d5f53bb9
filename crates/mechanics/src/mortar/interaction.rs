//! Mortar contact as the system sees it.

use super::at_rest::{AtRest, SmallSliding};
use super::cover::CoveredPoint;
use super::face_terms::{FaceTerms, Wanted};
use super::measure::{Facing, Opposite, Sides};
use super::measured::{Matched, Measured, MetPoint, NodeMeasure};
use super::rigid;
use super::shown::{shared_of, show, zone_of};
use super::terms::{Assembly, NodeTractions};
use super::{Mortar, NodeMemory};
use crate::body::{Body, PlaceError};
use crate::contact_law::{ContactLaw, PointHistory};
use crate::enforcement::WAVE;
use crate::heat::{Conducting, Means};
use crate::inside::Inside;
use crate::interaction::{
    Assembler, Bodies, Drawn, Interaction, InteractionUnknowns, Iterated, NotItsHistory, OuterIteration, Passing,
    StatePath,
};
use crate::pair::{AxisChoice, any_tangent};
use crate::part::Part;
use crate::passage::{TrackedPoint, share_of_way};
use crate::points::{MaterialPoint, SlavePoint};
use crate::shown_surface::ShownSurface;
use crate::site_result::SiteResult;
use crate::surface::Surface;
use rayon::prelude::*;
use signorini_contact::Status;
use signorini_contact::law::Projected;
use signorini_geometry::Vector;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A contact measured in a state.
struct Found<'a> {
    sides: Sides<'a>,
    measured: Arc<Measured>,
    /// Rows and columns that do not change, of small sliding.
    linear: Option<Arc<AtRest>>,
    measures: Vec<NodeMeasure>,
    projected: Vec<Projected>,
    /// What the nodes remember of the state.
    next: Vec<PointHistory>,
}

/// Faces whose terms are held at a time, made side by side.
const AT_ONCE: usize = 256;

/// Zones of contact are several cells wide: trials of exact multipliers are as stiff as against waves of eight cells, which
/// takes a fifth less iterations than those of one cell where surfaces slide or bend.
const OF_ZONE: f64 = 0.125;

/// Gap beyond the least one, relative to the size of the body, of what touches at the same time.
const NEAREST: f64 = 1e-9;

impl Mortar {
    fn found<'a>(&self, at: Bodies<'a>, multipliers: &[f64], linearises: bool) -> Result<Found<'a>, PlaceError> {
        let sides = Sides::new(self, at)?;
        let (linear, measured, measures) = match &self.small {
            Some(small) => {
                let (at_rest, measures) = small.found(self, at)?;
                let measured = Arc::clone(&at_rest.measured);
                (Some(at_rest), measured, measures)
            }
            None => {
                let measured = Arc::new(sides.measured(self));
                let measures = self.measures(&measured);
                (None, measured, measures)
            }
        };
        let of = |(k, measure)| self.traction(k, measure, self.law.multiplier(k, multipliers), linearises);
        let (projected, next) = measures.iter().enumerate().map(of).unzip();
        Ok(Found { sides, measured, linear, measures, projected, next })
    }

    /// The nodes that see the master, with their measures.
    fn seen<'a>(&'a self, found: &'a Found<'_>) -> impl Iterator<Item = (usize, &'a NodeMeasure)> {
        found.measures.iter().enumerate().filter(|(k, m)| self.sees(*k, m.weight))
    }

    /// Gives the faces of a surface in contact with itself their roles, those that carry theirs. Whether any changed.
    fn assign_roles(&mut self, slave: &dyn Surface, carries: Option<&Found<'_>>) -> bool {
        let Some(within) = self.search.facing.within.as_mut().filter(|within| within.is_slave.is_some()) else {
            return false;
        };
        let sightings = self.nodes.sightings(slave, (self.search.reach, within));
        let mut carrying = Vec::new();
        if let Some(found) = carries {
            let is_closed = |(node, _): &(u32, f64)| found.projected[*node as usize].status != Status::Open;
            let closed = found.measured.points().filter(|(point, _)| point.shares.iter().any(is_closed));
            carrying.extend(closed.map(|(point, met)| (point.face as u32, met.on.patch)));
        }
        carrying.dedup();
        within.assign(sightings, &carrying)
    }

    /// The points of the slave with what they meet now.
    fn matched_in(&self, measured: &Measured) -> Vec<Matched> {
        let of = |(point, met): (&CoveredPoint, &MetPoint)| Matched {
            face: point.face,
            s: point.s,
            on: met.on,
            shares: point.shares.clone(),
        };
        if self.law.is_tangential() { measured.points().map(of).collect() } else { Vec::new() }
    }

    /// The nodes where they are in a state.
    fn placed(&self, at: Bodies<'_>) -> Result<Vec<SlavePoint>, PlaceError> {
        let (body, state) = at.side(&self.slave);
        let surface = body.surface(self.slave.group.as_deref(), state);
        let surface = surface.ok_or_else(|| super::no_surface(body, &self.slave))?;
        Ok(self.places.iter().map(|(face, s)| surface.placed(*face, s)).collect())
    }

    /// The nodes as they are found.
    fn node_results(&self, found: &Found<'_>) -> Vec<SiteResult> {
        // The force of friction of each node, with the axes of its points.
        let mut rubbed = vec![Vector::<3>::zeros(); self.whole.len()];
        for (point, met) in found.measured.points() {
            for (node, share) in &point.shares {
                let [_, t1, t2] = found.projected[*node as usize].traction;
                if let Some(axes) = self.axes(*node, &met.normal).filter(|_| self.law.is_tangential()) {
                    rubbed[*node as usize] -= (axes.e[0] * t1 + axes.e[1] * t2) * *share;
                }
            }
        }
        let of = |k: usize| {
            let (face, s) = &self.places[k];
            let (measure, projected) = (&found.measures[k], &found.projected[k]);
            let placed = found.sides.slave.placed(*face, s);
            let mut out = SiteResult { x: placed.x, ..SiteResult::default() };
            if !self.sees(k, measure.weight) {
                return out;
            }
            let [p, t1, t2] = projected.traction;
            out.weight = measure.weight;
            out.normal = measure.normal;
            (out.gap, out.worn) = self.law.gap_and_wear(measure.gap, &found.next[k]);
            out.pressure = p;
            out.status = projected.status;
            out.friction = rubbed[k] / measure.weight;
            if let Some(law) =
                self.law.friction.as_ref().filter(|law| law.is_tangential() && out.status != Status::Open)
            {
                let axes = self.axes(k as u32, &measure.normal.normalize());
                out.increment =
                    axes.map_or(Vector::<3>::zeros(), |a| a.e[0] * measure.slip[0] + a.e[1] * measure.slip[1]);
                out.utilisation = law.utilisation([t1, t2], p);
                let before = self.memory[k].slip;
                out.slip = (before[0] + measure.slip[0]).hypot(before[1] + measure.slip[1]);
            }
            out
        };
        let mut results: Vec<SiteResult> = (0..self.whole.len()).map(of).collect();
        // Along the normal of the slave the way to a surface that is inclined to it is longer than the distance.
        for (result, slant) in results.iter_mut().zip(found.sides.slants(&found.measured, self.whole.len())) {
            result.gap = result.gap.map(|gap| if result.status == Status::Open { gap * slant } else { gap });
        }
        let law = self.law.friction.as_deref();
        show(&self.nodes, found.sides.slave.faces().0, found.measured.as_ref(), law, &mut results);
        results
    }

    /// Forces of all faces, with their derivatives.
    fn add_faces(
        &self,
        found: &Found<'_>,
        assembly: &Assembly<'_>,
        carried: &NodeTractions<'_>,
        out: &mut Assembler<'_>,
    ) {
        let wanted = if out.tangent.is_some() { Wanted::Tangent } else { Wanted::Forces };
        let measured = found.measured.as_ref();
        let mut add = |list: Vec<FaceTerms>| list.iter().for_each(|terms| assembly.add(terms, out));
        match found.sides.facing() {
            Facing::Surfaces(sides) => {
                for faces in measured.cover.points.chunks(AT_ONCE) {
                    add(faces.par_iter().map(|points| sides.terms(carried, points, wanted)).collect());
                }
                let matched: Vec<&[Matched]> = self.matched.chunk_by(|a, b| a.face == b.face).collect();
                for faces in matched.chunks(AT_ONCE).filter(|_| wanted == Wanted::Tangent) {
                    add(faces.par_iter().map(|list| sides.slips(carried, list, false)).collect());
                }
                // How the points that match change is how the points move along each other.
                let arrived: Vec<&[Matched]> = measured.arrived.chunk_by(|a, b| a.face == b.face).collect();
                for faces in arrived.chunks(AT_ONCE).filter(|_| wanted == Wanted::Tangent) {
                    add(faces.par_iter().map(|list| sides.slips(carried, list, true)).collect());
                }
            }
            Facing::OnRigid(sides) => {
                let faces: Vec<_> = measured.cover.points.iter().zip(&measured.pairs).collect();
                for faces in faces.chunks(AT_ONCE) {
                    let of = |(points, pairs): &(&Vec<_>, &Vec<_>)| sides.terms(carried, (points, pairs), wanted);
                    add(faces.par_iter().map(of).collect());
                }
                let list = self.matched.iter().zip(&measured.matched);
                let list: Vec<_> = list.filter_map(|(m, pair)| Some((m, pair.as_ref()?))).collect();
                for of_face in list.chunk_by(|a, b| a.0.face == b.0.face).filter(|_| wanted == Wanted::Tangent) {
                    add(vec![rigid::slips(carried, of_face, false)]);
                }
            }
        }
    }

    /// The direction of the first axis of a node, by what is asked for; `normal` is that of the node.
    fn along(&self, found: &Found<'_>, normal: &Vector<3>) -> Vector<3> {
        match (self.axis, &found.sides.master) {
            (AxisChoice::OnMaster(v), Opposite::Rigid(master)) => master.at(&MaterialPoint::default()).frame * v,
            (AxisChoice::OnSlave(v) | AxisChoice::OnMaster(v), _) => v,
            (AxisChoice::Material | AxisChoice::Tangent, _) => any_tangent(normal),
        }
    }
}

impl Interaction for Mortar {
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

    fn stiffness(&self, _: &[Box<dyn Body>]) -> f64 {
        self.law.stiffness.iter().zip(&self.whole).map(|(c, w)| c * w).fold(0.0, f64::max)
    }

    fn prepare(&mut self, _: &[Box<dyn Body>], _: f64) {
        self.law.scale = if self.law.is_exact() { OF_ZONE } else { 1.0 };
        let scale = WAVE * self.law.scale;
        self.law.stiffness.iter_mut().for_each(|c| *c *= scale);
    }

    fn add_to(
        &self,
        at: Bodies<'_>,
        own: InteractionUnknowns<'_>,
        out: &mut Assembler<'_>,
    ) -> Result<usize, PlaceError> {
        let found = self.found(at, own.multipliers, out.tangent.is_some())?;
        let assembly = Assembly { contact: self, own, measures: &found.measures, projected: &found.projected };
        assembly.add_nodes(out);
        let carried = assembly.carried();
        match &found.linear {
            Some(at_rest) => assembly.add_linear(&at_rest.terms, &carried, out),
            None => self.add_faces(&found, &assembly, &carried, out),
        }
        Ok(found.measured.lost)
    }

    fn results(&self, at: Bodies<'_>, own: InteractionUnknowns<'_>) -> Result<Vec<SiteResult>, PlaceError> {
        Ok(self.node_results(&self.found(at, own.multipliers, false)?))
    }

    fn accept(&mut self, at: Bodies<'_>, own: InteractionUnknowns<'_>) -> Result<(), PlaceError> {
        let found = self.found(at, own.multipliers, false)?;
        let (mut memory, mut tractions) = (Vec::new(), Vec::new());
        for (k, (measure, projected)) in found.measures.iter().zip(&found.projected).enumerate() {
            let (face, s) = &self.places[k];
            let normal = match measure.normal.try_normalize(0.0) {
                Some(normal) => normal,
                None => -found.sides.slave.normal(*face, s).normalize(),
            };
            let mut next = NodeMemory { along: self.along(&found, &normal), ..NodeMemory::default() };
            let mut traction = projected.traction;
            if self.law.is_tangential() && projected.status != Status::Open {
                let before = self.memory[k].slip;
                next.slip = std::array::from_fn(|i| before[i] + measure.slip[i]);
                // Friction goes on along the new axes.
                if let Some(old) = self.axes(k as u32, &normal) {
                    self.memory[k].along = next.along;
                    let new = self.axes(k as u32, &normal).unwrap_or(old);
                    let turned = |v: [f64; 2]| new.e.map(|e| e.dot(&(old.e[0] * v[0] + old.e[1] * v[1])));
                    let [p, t1, t2] = traction;
                    let [t1, t2] = turned([t1, t2]);
                    traction = [p, t1, t2];
                    next.slip = turned(next.slip);
                }
            }
            memory.push(next);
            tractions.push(traction);
        }
        self.memory = memory;
        self.law.history.clone_from(&found.next);
        // Small sliding keeps what sees what at rest.
        self.matched = match self.small.is_none() && self.assign_roles(found.sides.slave.as_ref(), Some(&found)) {
            true => self.matched_in(&found.sides.measured(self)),
            false => self.matched_in(&found.measured),
        };
        let displacements = [&self.slave, &self.master].map(|part| at.side(part).1.configuration.clone());
        if let Some(small) = &mut self.small {
            small.forget();
            small.since = displacements;
        }
        let turned = found.sides.turn();
        self.turned = turned;
        self.law.accept(tractions);
        Ok(())
    }

    fn augment(
        &mut self,
        at: Bodies<'_>,
        own: InteractionUnknowns<'_>,
        found: &[SiteResult],
        around: OuterIteration,
    ) -> Result<f64, PlaceError> {
        let tractions = match self.law.takes_over() {
            true => self.found(at, own.multipliers, false)?.projected.iter().map(|p| p.traction).collect(),
            false => Vec::new(),
        };
        Ok(self.law.augment(found, &around, &tractions))
    }

    fn history(&self) -> [Vec<f64>; 2] {
        self.numbers()
    }

    fn restore(&mut self, history: &[Vec<f64>; 2]) -> Result<(), NotItsHistory> {
        self.take_numbers(history).ok_or_else(|| NotItsHistory { contact: self.name.clone() })
    }
}

impl Iterated for Mortar {
    fn begin(&mut self, _: f64) {
        self.small.iter_mut().for_each(SmallSliding::forget);
    }

    fn depart(&mut self, from: Bodies<'_>) {
        let counts = self.law.is_tangential() && self.small.is_none();
        self.departed = counts.then(|| [&self.slave, &self.master].map(|part| from.side(part).1.clone()));
    }

    fn leave_out_held(&mut self, at: Bodies<'_>, held: &[bool]) {
        self.small.iter_mut().for_each(SmallSliding::forget);
        let Ok(sides) = Sides::new(self, at) else { return };
        self.assign_roles(sides.slave.as_ref(), None);
        for (k, (face, s)) in self.places.iter().enumerate() {
            let placed = sides.slave.placed(*face, s);
            let normal = sides.slave.normal(*face, s).normalize();
            let pushed = |v: &Vector<3>| v.dot(&normal).abs() > 1e-6 * v.norm();
            let moves = |f: &crate::points::Function| !held[(sides.first[0] + f.unknown) as usize];
            self.merged[k] = !placed.functions.iter().any(|f| pushed(&f.value) && moves(f));
        }
        self.whole = self.nodes.whole(sides.slave.as_ref(), &self.search.facing, &self.merged).weight;
        self.law.areas = super::weights(&self.whole);
    }

    /// A body that only contact with another one holds is pressed on it first where the gap is least.
    fn initial_multipliers(&self, at: Bodies<'_>, residual: &[f64]) -> Option<Vec<f64>> {
        if self.is_within() {
            return None;
        }
        let mut out = self.law.multipliers();
        let found = self.found(at, &out, false).ok()?;
        let least = self.seen(&found).map(|(_, m)| m.gap).fold(f64::INFINITY, f64::min);
        let near = NEAREST * at.bodies[self.slave.body].size();
        let force = residual.iter().fold(0.0f64, |m, r| m.max(r.abs()));
        for (k, m) in self.seen(&found).filter(|(_, m)| m.gap <= least + near) {
            out[k * self.law.slots().len()] = 2.0 * self.law.stiffness[k] * m.gap.max(0.0) + force / m.weight;
        }
        Some(out)
    }

    fn least_gap(&self, at: Bodies<'_>) -> Option<f64> {
        if self.is_within() {
            return None;
        }
        let found = self.found(at, &self.law.multipliers(), false).ok()?;
        self.seen(&found).map(|(_, m)| m.gap).reduce(f64::min)
    }

    fn ill_conditioning(&self, _: Bodies<'_>) -> Option<String> {
        let told = || format!("no part of the slave of contact `{}` faces the master", self.name);
        self.search.facing.is_away.then(told)
    }
}

impl Passing for Mortar {
    /// Solids see each other only where they face each other: what a step takes through a rigid body is followed.
    fn free_way(&self, path: StatePath<'_>) -> Result<f64, PlaceError> {
        if !path.from.bodies[self.master.body].is_rigid()
            || !(path.moves(self.slave.body) || path.moves(self.master.body))
        {
            return Ok(1.0);
        }
        let body = &path.from.bodies[self.slave.body];
        let spacing = body.size() / (self.places.len() as f64).sqrt();
        let [from, to] = [self.placed(path.from)?, self.placed(path.to)?];
        let point = |(a, b): (&SlavePoint, &SlavePoint)| TrackedPoint {
            from: a.x,
            to: b.x,
            radius: 0.0,
            is_surface: true,
            spacing,
        };
        let tested = from.iter().zip(&to).map(point).collect();
        Ok(share_of_way([&self.slave, &self.master], (tested, |k: usize| from[k].outward), path))
    }

    fn inside(&self, at: Bodies<'_>, is_start: bool) -> Result<Option<Inside>, PlaceError> {
        at.inside([&self.slave, &self.master], &self.placed(at)?, is_start)
    }
}

impl Drawn for Mortar {
    fn surface(&self, at: Bodies<'_>, own: InteractionUnknowns<'_>) -> Result<Option<ShownSurface>, PlaceError> {
        let found = self.found(at, own.multipliers, false)?;
        let (slave, results) = (found.sides.slave.as_ref(), self.node_results(&found));
        let points = found.measured.as_ref();
        let zone = zone_of(&self.nodes, slave.faces().0, points, &results);
        let shared = shared_of(&self.nodes, slave.faces().0, points, &results);
        Ok(self.nodes.faces().map(|faces| ShownSurface { shared, ..faces.with_zone(&zone, slave) }))
    }
}

impl Conducting for Mortar {
    /// Means weighted by the dual functions of the nodes.
    fn means(&self, at: Bodies<'_>) -> Result<Option<Vec<Means>>, PlaceError> {
        let own = [&self.slave, &self.master].map(|part| at.bodies[part.body].thermal().is_some());
        let found = self.found(at, &self.law.multipliers(), false)?;
        let slave = found.sides.slave.as_ref();
        let mut sums = vec![[BTreeMap::<u32, f64>::new(), BTreeMap::new()]; self.whole.len()];
        for (point, met) in found.measured.points() {
            let mut on_slave = slave.point(point.face, &point.s).functions;
            let mut on_master = match &found.sides.master {
                Opposite::Surface(master) => master.point(met.on.patch as usize, &met.on.xi).functions,
                Opposite::Rigid(_) => Vec::new(),
            };
            for (list, _) in [&mut on_slave, &mut on_master].into_iter().zip(own).filter(|(_, own)| !own) {
                list.clear();
            }
            for (node, share) in &point.shares {
                let weight = share / found.measures[*node as usize].weight;
                for (sum, list) in sums[*node as usize].iter_mut().zip([&on_slave, &on_master]) {
                    list.iter().for_each(|f| *sum.entry(f.unknown).or_default() += weight * f.value);
                }
            }
        }
        Ok(Some(sums.into_iter().map(|sides| sides.map(|side| side.into_iter().collect())).collect()))
    }

    fn conducts(&self) -> bool {
        true
    }
}
