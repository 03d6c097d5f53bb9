//! A tie as the system sees it.

use super::joint::{Bends, Joint, MasterAt, MasterPoint, Measured, SlaveAt};
use super::{Sampled, Start, TOUCHES, Tie};
use crate::body::{Body, BodyState, PlaceError};
use crate::contact_law::{ContactLaw, PointMeasure};
use crate::enforcement::WAVE;
use crate::interaction::{
    Assembler, Bodies, Drawn, Interaction, InteractionUnknowns, Iterated, NotItsHistory, OuterIteration, Passing,
};
use crate::part::Part;
use crate::points::{Master, SlavePoint};
use crate::shown_surface::ShownSurface;
use crate::site_result::{OfSurface, SiteResult};
use crate::surface::{Local, Surface};
use rayon::prelude::*;
use signorini_contact::law::Projected;
use signorini_contact::{Status, connected};
use signorini_geometry::{Point, Vector};
use std::collections::BTreeMap;

/// `∂c/∂u` of the nodes: for each node and axis the unknowns of the system.
pub(super) type Lines = BTreeMap<(u32, usize), Vec<(u32, f64)>>;

/// Joints that are measured side by side.
const AT_ONCE: usize = 512;

/// Both sides in a state.
struct Sides<'a> {
    slave: (&'a dyn Body, &'a BodyState),
    slave_surface: Option<Box<dyn Surface + 'a>>,
    master_surface: Option<Box<dyn Surface + 'a>>,
    master: Box<dyn Master + 'a>,
    first: [u32; 2],
    /// Displacements of both, where all is linear in them.
    moved: [&'a [f64]; 2],
}

/// All nodes in a state.
struct Found {
    /// `∫ψ_k c` of each node.
    apart: Vec<Vector<3>>,
    /// Lines of joints that are not linear.
    lines: Lines,
    /// Of each joint that is not linear its number and second derivatives.
    bends: Vec<(usize, Bends)>,
}

impl Tie {
    fn sides<'a>(&self, at: Bodies<'a>) -> Result<Sides<'a>, PlaceError> {
        let (slave, master) = (at.side(&self.slave), at.side(&self.master));
        let met = master.0.master(self.master.group.as_deref(), master.1)?;
        Ok(Sides {
            slave,
            slave_surface: slave.0.surface(self.slave.group.as_deref(), slave.1),
            master_surface: master.0.surface(self.master.group.as_deref(), master.1),
            master: met,
            first: [at.first[self.slave.body], at.first[self.master.body]],
            moved: [&slave.1.configuration, &master.1.configuration],
        })
    }

    /// The point of the slave of a joint.
    fn slave_point(&self, joint: &Joint, sides: &Sides<'_>) -> SlavePoint {
        match (joint.slave, &sides.slave_surface, &self.sampled) {
            (SlaveAt::Face(face, s), Some(surface), _) => surface.placed(face, &s),
            (SlaveAt::Site(k), _, Sampled::Sites(sites)) => sides.slave.0.placed(sides.slave.1, &sites[k]),
            _ => SlavePoint::default(),
        }
    }

    fn measure(&self, joint: &Joint, sides: &Sides<'_>) -> Measured {
        let slave = self.slave_point(joint, sides);
        match (joint.master, &sides.master_surface) {
            (MasterAt::Face(face, s), Some(surface)) => {
                let at = MasterPoint::of_face(&surface.point(face, &s), surface.dimension());
                joint.measure(&slave, &at, sides.first)
            }
            (MasterAt::Rigid(point), _) => {
                joint.measure_on_rigid(&slave, &sides.master.at(&point), self.rigid, sides.first)
            }
            (MasterAt::Material(point), _) => {
                joint.measure(&slave, &MasterPoint::of_anchor(sides.master.at(&point)), sides.first)
            }
            (MasterAt::Face(..), None) => Measured::default(),
        }
    }

    /// Whether `c` of a joint is linear in the displacements, or taken as such: of bodies of small strain.
    fn is_linear(&self, joint: &Joint) -> bool {
        let fixed = matches!(joint.master, MasterAt::Rigid(_));
        !fixed && (self.is_linear || joint.offset == Vector::<3>::zeros())
    }

    /// The nodes for which a joint counts along an axis.
    fn shares<'a>(&self, joint: &'a Joint, axis: usize) -> &'a [(u32, f64)] {
        &joint.shares[(axis + 1).min(joint.shares.len() - 1)]
    }

    fn add_lines(&self, joint: &Joint, measured: &Measured, lines: &mut Lines) {
        for axis in 0..self.dimension {
            for (node, share) in self.shares(joint, axis) {
                let own = lines.entry((*node, axis)).or_default();
                let moving = measured.movers.iter().filter(|(_, v)| v[axis] != 0.0);
                own.extend(moving.map(|(unknown, v)| (*unknown, share * v[axis])));
            }
        }
    }

    /// The lines of joints that are linear, from the bodies at the start.
    fn linear_lines(&self, at: Bodies<'_>) -> Result<&Lines, PlaceError> {
        if let Some(lines) = self.linear.get() {
            return Ok(lines);
        }
        let mut states = vec![BodyState::default(); at.states.len()];
        for part in [&self.slave, &self.master] {
            states[part.body] = at.bodies[part.body].start();
        }
        let sides = self.sides(Bodies { states: &states, ..at })?;
        let mut lines = Lines::new();
        let joints: Vec<&Joint> = self.joints.iter().filter(|j| self.is_linear(j)).collect();
        for chunk in joints.chunks(AT_ONCE) {
            let measured: Vec<Measured> = chunk.par_iter().map(|joint| self.measure(joint, &sides)).collect();
            chunk.iter().zip(&measured).for_each(|(joint, m)| self.add_lines(joint, m, &mut lines));
            lines.values_mut().for_each(signorini_contact::compress);
        }
        Ok(self.linear.get_or_init(|| lines))
    }

    fn found(&self, at: Bodies<'_>, derivatives: bool) -> Result<Found, PlaceError> {
        let sides = self.sides(at)?;
        let count = self.weight.len();
        let apart = vec![Vector::<3>::zeros(); count];
        let mut out = Found { apart, lines: Lines::new(), bends: Vec::new() };
        let ends = [0, 1].map(|side| sides.first[side]..sides.first[side] + sides.moved[side].len() as u32);
        let moved = |unknown: u32| {
            let side = usize::from(!ends[0].contains(&unknown));
            sides.moved[side].get((unknown - sides.first[side]) as usize).copied().unwrap_or(0.0)
        };
        for ((node, axis), entries) in self.linear_lines(at)? {
            out.apart[*node as usize][*axis] += entries.iter().map(|(u, d)| d * moved(*u)).sum::<f64>();
        }
        let bent: Vec<(usize, &Joint)> =
            self.joints.iter().enumerate().filter(|(_, joint)| !self.is_linear(joint)).collect();
        for chunk in bent.chunks(AT_ONCE) {
            let measured: Vec<Measured> = chunk.par_iter().map(|(_, joint)| self.measure(joint, &sides)).collect();
            for ((k, joint), m) in chunk.iter().zip(measured) {
                for axis in 0..self.dimension {
                    for (node, share) in self.shares(joint, axis) {
                        out.apart[*node as usize][axis] += share * m.apart[axis];
                    }
                }
                if derivatives {
                    self.add_lines(joint, &m, &mut out.lines);
                }
                out.bends.extend(m.bends.map(|bends| (*k, bends)));
            }
            out.lines.values_mut().for_each(signorini_contact::compress);
        }
        Ok(out)
    }

    /// `c_k` of a node as its law sees it.
    fn node_measure(&self, found: &Found, k: usize, linearises: bool) -> PointMeasure {
        let mean = |axis: usize| match self.carried.get(axis).map_or(0.0, |w| w[k]) {
            weight if weight > 0.0 => found.apart[k][axis] / weight,
            _ => 0.0,
        };
        PointMeasure {
            gap: mean(0),
            slip: [-mean(1), -mean(2)],
            slides: Some([self.dimension > 1, self.dimension > 2]),
            sticks_first: linearises,
            ..PointMeasure::default()
        }
    }

    /// The traction of a node by its law; along axes without a function of its own it has none.
    fn node_traction(&self, found: &Found, k: usize, multipliers: &[f64], linearises: bool) -> Projected {
        let measure = self.node_measure(found, k, linearises);
        let (mut projected, _) = self.law.traction(k, self.law.multiplier(k, multipliers), &measure);
        for axis in 0..self.dimension {
            if self.carried[axis][k] <= 0.0 {
                projected.traction[axis] = 0.0;
                projected.derivative[axis] = [0.0; 3];
            }
        }
        projected
    }

    /// The same of all nodes.
    fn node_tractions(&self, found: &Found, multipliers: &[f64], linearises: bool) -> Vec<Projected> {
        (0..self.weight.len()).map(|k| self.node_traction(found, k, multipliers, linearises)).collect()
    }

    /// The unknown traction at a joint, times its area.
    fn traction_at(&self, joint: &Joint, tractions: &[[f64; 3]]) -> Vector<3> {
        let along = |axis: usize| self.shares(joint, axis).iter().map(|(k, s)| s * tractions[*k as usize][axis]).sum();
        Vector::<3>::from_fn(|axis, _| if axis < self.dimension { along(axis) } else { 0.0 })
    }

    fn tractions(&self, multipliers: &[f64]) -> Vec<[f64; 3]> {
        (0..self.weight.len()).map(|k| self.law.multiplier(k, multipliers)).collect()
    }

    /// Adds forces and rows of lines.
    fn add_of_lines(
        &self,
        lines: &Lines,
        tractions: &[[f64; 3]],
        (first, derivatives): (u32, &[Projected]),
        out: &mut Assembler<'_>,
    ) {
        let slots = self.law.slots().len() as u32;
        for ((node, axis), entries) in lines {
            let k = *node as usize;
            let traction = tractions[k][*axis];
            for (unknown, value) in entries.iter().filter(|_| traction != 0.0) {
                out.residual[*unknown as usize] -= traction * value;
                out.sizes[*unknown as usize] += (traction * value).abs();
            }
            let Some(tangent) = &mut out.tangent else { continue };
            let row = first + node * slots + *axis as u32;
            let factor = -self.law.areas[k] * derivatives[k].derivative[*axis][*axis] / self.carried[*axis][k];
            for (unknown, value) in entries {
                tangent.add(*unknown, row, -value);
                if factor.is_finite() && factor != 0.0 {
                    tangent.add(row, *unknown, factor * value);
                }
            }
        }
    }

    /// The places of nodes or sites where they are now, and the mean normals of the master.
    fn places(&self, sides: &Sides<'_>) -> (Vec<Point<3>>, Vec<Vector<3>>) {
        let mut normals = vec![Vector::<3>::zeros(); self.weight.len()];
        for joint in &self.joints {
            let normal = self.measure(joint, sides).normal;
            for (node, share) in &joint.shares[0] {
                normals[*node as usize] += normal * *share;
            }
        }
        let places = match (&self.sampled, &sides.slave_surface) {
            (Sampled::Mortar { places, .. }, Some(surface)) => {
                places.iter().map(|(face, s)| surface.placed(*face, s).x).collect()
            }
            (Sampled::Sites(sites), _) => {
                sites.iter().map(|site| sides.slave.0.placed(sides.slave.1, site).x).collect()
            }
            _ => vec![Point::<3>::zeros(); self.weight.len()],
        };
        (places, normals)
    }
}

impl Interaction for Tie {
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
        let all = self.law.stiffness.iter().zip(&self.weight).map(|(c, w)| c * w);
        all.filter(|c| c.is_finite()).fold(0.0, f64::max)
    }

    fn prepare(&mut self, _: &[Box<dyn Body>], otherwise: f64) {
        for (c, w) in self.law.stiffness.iter_mut().zip(&self.law.areas) {
            *c = WAVE * if c.is_finite() { *c } else { otherwise / w };
        }
    }

    fn add_to(
        &self,
        at: Bodies<'_>,
        own: InteractionUnknowns<'_>,
        out: &mut Assembler<'_>,
    ) -> Result<usize, PlaceError> {
        let found = self.found(at, true)?;
        let linearises = out.tangent.is_some();
        let tractions = self.tractions(own.multipliers);
        let projected = self.node_tractions(&found, own.multipliers, linearises);
        let slots = self.law.slots().len() as u32;
        for (k, projected) in projected.iter().enumerate() {
            let row = own.first + k as u32 * slots;
            self.law.add_equations(k, row, tractions[k], Some(projected), out);
        }
        for lines in [self.linear_lines(at)?, &found.lines] {
            self.add_of_lines(lines, &tractions, (own.first, &projected), out);
        }
        if let Some(tangent) = &mut out.tangent {
            for (k, bends) in &found.bends {
                let lambda = self.traction_at(&self.joints[*k], &tractions);
                if lambda != Vector::<3>::zeros() {
                    let (unknowns, block) = bends.block(&lambda);
                    tangent.add_block(&unknowns, &block);
                }
            }
        }
        Ok(0)
    }

    fn results(&self, at: Bodies<'_>, own: InteractionUnknowns<'_>) -> Result<Vec<SiteResult>, PlaceError> {
        let found = self.found(at, false)?;
        let projected = self.node_tractions(&found, own.multipliers, false);
        let (places, normals) = self.places(&self.sides(at)?);
        let zones = match &self.sampled {
            Sampled::Mortar { nodes, .. } => {
                let active: Vec<bool> = self.weight.iter().map(|w| *w > 0.0).collect();
                match nodes {
                    super::Nodes::Plane(nodes) => connected(nodes, &active),
                    super::Nodes::Space(nodes) => connected(nodes, &active),
                }
            }
            Sampled::Sites(_) => vec![None; self.weight.len()],
        };
        let of = |k: usize| {
            let mut out = SiteResult { x: places[k], ..SiteResult::default() };
            let Some(normal) = normals[k].try_normalize(0.0).filter(|_| self.weight[k] > 0.0) else { return out };
            let along = |axis: usize| projected[self.carrier[axis][k] as usize].traction[axis];
            let traction = Vector::<3>::from_fn(|axis, _| if axis < self.dimension { along(axis) } else { 0.0 });
            let measure = self.node_measure(&found, k, false);
            let apart = Vector::<3>::new(measure.gap, -measure.slip[0], -measure.slip[1]);
            out.weight = self.weight[k];
            out.normal = normal;
            out.gap = Some(apart.dot(&normal));
            out.pressure = traction.dot(&normal);
            out.friction = traction - normal * out.pressure;
            out.status = Status::Stick;
            let (pressure, friction) = (out.pressure, out.friction);
            out.of_surface = zones[k].map(|zone| OfSurface { pressure, friction, area: self.weight[k], zone });
            out
        };
        Ok((0..self.weight.len()).map(of).collect())
    }

    fn accept(&mut self, at: Bodies<'_>, own: InteractionUnknowns<'_>) -> Result<(), PlaceError> {
        let found = self.found(at, false)?;
        let projected = self.node_tractions(&found, own.multipliers, false);
        self.law.accept(projected.iter().map(|p| p.traction).collect());
        Ok(())
    }

    fn augment(
        &mut self,
        at: Bodies<'_>,
        own: InteractionUnknowns<'_>,
        results: &[SiteResult],
        around: OuterIteration,
    ) -> Result<f64, PlaceError> {
        let tractions = match self.law.takes_over() {
            true => {
                let projected = self.node_tractions(&self.found(at, false)?, own.multipliers, false);
                projected.iter().map(|p| p.traction).collect()
            }
            false => Vec::new(),
        };
        Ok(self.law.augment(results, &around, &tractions))
    }

    fn history(&self) -> [Vec<f64>; 2] {
        [self.law.kept.iter().flatten().copied().collect(), self.law.scales().collect()]
    }

    fn restore(&mut self, [kept, scales]: &[Vec<f64>; 2]) -> Result<(), NotItsHistory> {
        let is_own =
            kept.len() == 3 * self.weight.len() && self.law.restore_scales(scales).is_some_and(<[f64]>::is_empty);
        if !is_own {
            return Err(NotItsHistory { contact: self.name.clone() });
        }
        self.law.kept = kept.chunks(3).map(|t| [t[0], t[1], t[2]]).collect();
        Ok(())
    }
}

impl Iterated for Tie {
    fn leave_out_held(&mut self, at: Bodies<'_>, held: &[bool]) {
        let Sampled::Mortar { nodes, places, .. } = &self.sampled else { return };
        let (body, state) = (at.bodies[self.slave.body].as_ref(), at.bodies[self.slave.body].start());
        if body.holds_change() {
            return;
        }
        let Some(surface) = body.surface(self.slave.group.as_deref(), &state) else { return };
        let first = at.first[self.slave.body];
        let is_held = |(face, s): &(usize, Local), axis: usize| {
            let placed = surface.placed(*face, s);
            let mut own = placed.functions.iter().filter(|f| f.value[axis].abs() > 1e-6).peekable();
            own.peek().is_some() && own.all(|f| held[(first + f.unknown) as usize])
        };
        let neighbours = nodes.of_faces();
        let flags: Vec<Vec<bool>> = (0..self.dimension)
            .map(|axis| {
                let all: Vec<bool> = places.iter().map(|place| is_held(place, axis)).collect();
                // What is held as a whole may still carry another body.
                let mut out = vec![false; all.len()];
                for list in &neighbours {
                    if list.iter().any(|k| !all[*k as usize]) {
                        list.iter().for_each(|k| out[*k as usize] = all[*k as usize]);
                    }
                }
                out
            })
            .collect();
        drop(surface);
        if !flags.iter().flatten().any(|held| *held) {
            return;
        }
        let (slave, master) = (self.slave.clone(), self.master.clone());
        let other = at.bodies[master.body].as_ref();
        let other_state = other.start();
        let Ok(met) = other.master(master.group.as_deref(), &other_state) else { return };
        let start = Start { slave: (&slave, body, &state), master: (&master, other, &other_state), met: met.as_ref() };
        let size = body.size().max(if other.is_rigid() { 0.0 } else { other.size() });
        self.find(&start, TOUCHES * size, Some(&flags));
    }
}

impl Passing for Tie {}

impl Drawn for Tie {
    fn surface(&self, _: Bodies<'_>, _: InteractionUnknowns<'_>) -> Result<Option<ShownSurface>, PlaceError> {
        Ok(match &self.sampled {
            Sampled::Mortar { nodes, .. } => nodes.faces(),
            Sampled::Sites(_) => None,
        })
    }
}

impl crate::heat::Conducting for Tie {}
