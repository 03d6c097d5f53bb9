//! Friction between two sides that slide little: stick and slip, and what slips count from.
//!
//! The tangential rows stand on the points, dual functions and weights of the weighted gaps. The slip of an increment
//! counts from the displacement of the last state found, which is the whole history; after an increment that failed it
//! is still that of the state before.

mod solve;

use crate::contact::{Contact, Enforcement, Method, PressureNode};
use crate::model::StepError;
use signorini_contact::friction::{NoAxis, WeightedSlip, slips_of_points, weighted_slips};
use signorini_contact::{ContactSurface, Law, Shares, Status, TestPoint};
use signorini_fem::hierarchic::Values;
use signorini_geometry::Point;
pub(crate) use solve::{Found, FrictionAt};
use std::collections::HashMap;

/// The friction of a contact.
#[derive(Debug)]
pub struct Friction<const D: usize> {
    pub law: Box<dyn Law>,
    /// The first axis of an orthotropic law; it is projected on the surface. As the sides slide little it does not matter
    /// which of them carries it. In the plane there is one tangent only, along the first axis.
    pub axis: Option<Point<D>>,
}

/// The displacement of a point of a rigid body since the start, by where it was then.
pub type RigidMotion<const D: usize> = Box<dyn Fn(&Point<D>) -> Point<D> + Sync>;

/// What the friction of a model carries from one time to the next; plain numbers, so that it can be written.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrictionHistory {
    /// The displacement that slips count from.
    pub u: Vec<f64>,
    /// By contact: the displacement of its rigid master at each point under test, component by component.
    pub motion: Vec<Vec<f64>>,
    /// Contact, number of the pressure node, and its pressure and friction along the axes of the law.
    pub traction: Vec<(usize, u32, [f64; 3])>,
    /// Contact, number of the pressure node, and how far it slipped in all.
    pub slip: Vec<(usize, u32, [f64; 3])>,
}

/// The friction at a pressure node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rubbing<const D: usize> {
    pub status: Status,
    /// Friction traction on the slave, per area.
    pub traction: Point<D>,
    /// How far the slave slipped along the master while they touched, over all increments and in the last one.
    pub slip: Point<D>,
    pub increment: Point<D>,
    /// The part of the available friction that is used: 1 where it slips.
    pub utilisation: f64,
}

impl<const D: usize> Default for Rubbing<D> {
    fn default() -> Self {
        let zero = Point::<D>::zeros();
        Rubbing { status: Status::Open, traction: zero, slip: zero, increment: zero, utilisation: 0.0 }
    }
}

/// What the friction of a contact came to.
#[derive(Clone, Debug, PartialEq)]
pub struct FrictionResult<const D: usize> {
    /// Of the friction alone, on the slave.
    pub force: Point<D>,
    /// The area in contact, by the weights of the nodes that stick and slip.
    pub stick_area: f64,
    pub slip_area: f64,
    /// The largest slip of a closed node over all increments.
    pub max_slip: f64,
    pub max_utilisation: f64,
    /// The share of the area in contact that was open in the state before: its slips count from before they touched.
    pub newly_closed: f64,
    /// Energy that friction took in the increment.
    pub dissipation: f64,
    /// The factor of all friction below which every closed node by itself has one state for every load. At 1 or less
    /// more than one equilibrium may exist, and this one depends on the state that it was reached from.
    pub uniqueness: f64,
}

/// The slips of a contact, and the motion of its rigid master.
#[derive(Clone, Debug)]
pub(crate) struct SlipHistory<const D: usize> {
    /// Beside the rows of the gaps.
    pub rows: Vec<WeightedSlip<D>>,
    /// The first point of each face in the lists of motions.
    starts: Vec<usize>,
    /// The displacement of the rigid master at every point: now, and at the last state found.
    pub now: Vec<Point<D>>,
    pub before: Vec<Point<D>>,
}

impl<const D: usize> Default for SlipHistory<D> {
    fn default() -> Self {
        SlipHistory { rows: Vec::new(), starts: Vec::new(), now: Vec::new(), before: Vec::new() }
    }
}

impl<const D: usize> Contact<D> {
    /// Where the rigid master has come to, at all points of the slave side.
    pub(crate) fn move_rigid(&mut self, motion: Option<&RigidMotion<D>>) {
        if self.friction.is_none() {
            return;
        }
        self.slips.starts.clear();
        self.slips.now.clear();
        for (face, list) in self.points.iter().enumerate() {
            self.slips.starts.push(self.slips.now.len());
            let of = |s| motion.map_or(Point::<D>::zeros(), |u| u(&s));
            let moved = list.iter().map(|p| of(self.slave.at(face, &p.s).x));
            self.slips.now.extend(moved);
        }
    }

    /// The slips of all rows.
    pub(crate) fn find_slips(&mut self, shares: &Shares) -> Result<(), StepError> {
        let Some(friction) = &self.friction else { return Ok(()) };
        let SlipHistory { starts, now, before, .. } = &self.slips;
        let motion = |face: usize, q: usize| {
            let at = starts[face] + q;
            now[at] - before.get(at).copied().unwrap_or(Point::<D>::zeros())
        };
        let master = self.master.surface();
        let found = weighted_slips(&self.slave, master, &self.points, shares, friction.axis.as_ref(), &motion);
        let mut found = found.map_err(|error| self.no_axis(&error))?;
        self.slips.rows = self.rows.iter().filter_map(|row| found[row.node as usize].take()).collect();
        Ok(())
    }

    /// The slips of all rows that are points, and where the rigid master has come to.
    pub(crate) fn find_slips_of_points(&mut self, motion: Option<&RigidMotion<D>>) -> Result<(), StepError> {
        let (Some(friction), Some(measured)) = (&self.friction, &self.measured) else { return Ok(()) };
        let zero = Point::<D>::zeros();
        let at = |point: &TestPoint| self.slave.at(point.face, &point.s).x;
        self.slips.now = self.tests.points.iter().map(|p| motion.map_or(zero, |u| u(&at(p)))).collect();
        let SlipHistory { now, before, .. } = &self.slips;
        let motion = |k: usize| now[k] - before.get(k).copied().unwrap_or(zero);
        let found = slips_of_points(&self.slave, &self.tests, measured, friction.axis.as_ref(), &motion);
        let mut found = found.map_err(|error| self.no_axis(&error))?;
        let by_number: HashMap<u32, usize> = self.tests.rows.iter().enumerate().map(|(k, r)| (r.number, k)).collect();
        self.slips.rows = self.rows.iter().filter_map(|row| found[by_number[&row.node]].take()).collect();
        Ok(())
    }

    fn no_axis(&self, error: &NoAxis<D>) -> StepError {
        let place: Vec<String> = error.x.iter().map(|v| format!("{v:.6}")).collect();
        StepError::FrictionAxis { contact: self.name.clone(), place: format!("({})", place.join(", ")) }
    }

    /// The friction of quadrature points as means over the pressure nodes.
    pub(crate) fn averaged_rubbing(&self, rows: &[Rubbing<D>], nodes: &mut [PressureNode<D>]) {
        let mut place = vec![None; self.nodes.len()];
        nodes.iter().enumerate().for_each(|(k, n)| place[n.number as usize] = Some(k));
        let mut weight = vec![0.0; nodes.len()];
        let mut at = Values::default();
        for ((rubbing, row), (face, s)) in rows.iter().zip(&self.rows).zip(&self.places) {
            self.nodes.map(*face).tabulate(s, &mut at);
            for ((node, _), v) in self.nodes.of_face(*face).iter().zip(&at.value) {
                let Some(k) = place[*node as usize] else { continue };
                let (mean, w) = (&mut nodes[k].rubbing, v * row.weight);
                weight[k] += w;
                mean.traction += rubbing.traction * w;
                mean.slip += rubbing.slip * w;
                mean.increment += rubbing.increment * w;
                // The points that a node stands for.
                if *v > 0.1 {
                    mean.utilisation = mean.utilisation.max(rubbing.utilisation);
                    mean.status = match (mean.status, rubbing.status) {
                        (Status::Slip, _) | (_, Status::Slip) => Status::Slip,
                        (Status::Stick, _) | (_, Status::Stick) => Status::Stick,
                        _ => Status::Open,
                    };
                }
            }
        }
        for (node, w) in nodes.iter_mut().zip(weight) {
            let mean = &mut node.rubbing;
            [&mut mean.traction, &mut mean.slip, &mut mean.increment].into_iter().for_each(|v| *v /= w);
        }
    }

    /// The friction at a row.
    pub(crate) fn rubbing(&self, row: usize, pressure: f64, found: &FrictionAt) -> Rubbing<D> {
        let Some(friction) = &self.friction else { return Rubbing::default() };
        let along = |t: [f64; 2]| self.slips.rows[row].axes.iter().zip(t).map(|(e, t)| e * t).sum::<Point<D>>();
        let weight = self.rows[row].weight;
        let closed = found.status != Status::Open;
        Rubbing {
            status: found.status,
            traction: along(found.traction),
            slip: Point::<D>::from_fn(|k, _| found.slip[k]),
            increment: if closed { along(found.increment.map(|y| y / weight)) } else { Point::<D>::zeros() },
            utilisation: if closed { friction.law.utilisation(found.traction, pressure) } else { 0.0 },
        }
    }
}

/// Friction is for multipliers and penalties.
pub(crate) fn refuse_unsupported<const D: usize>(contacts: &[Contact<D>]) -> Result<(), StepError> {
    for contact in contacts.iter().filter(|c| c.friction.is_some()) {
        let unlike = match (contact.method, contact.enforcement) {
            (Method::GaussPoint, Enforcement::Multiplier) => "multipliers at Gauss points are too many",
            (_, Enforcement::Multiplier | Enforcement::Penalty { .. }) => continue,
            _ => "its enforcement is another one",
        };
        return Err(StepError::FrictionUnsupported { contact: contact.name.clone(), unlike: unlike.into() });
    }
    Ok(())
}

/// Sums and extremes over the rows of a contact, whose area is known; `rows` holds the friction of each.
pub(crate) fn friction_result<const D: usize>(
    contact: &Contact<D>,
    rows: &[Rubbing<D>],
    found: &[FrictionAt],
    (force, area): (Point<D>, f64),
) -> FrictionResult<D> {
    let mut out = FrictionResult {
        force,
        stick_area: 0.0,
        slip_area: 0.0,
        max_slip: 0.0,
        max_utilisation: 0.0,
        newly_closed: 0.0,
        dissipation: 0.0,
        uniqueness: f64::INFINITY,
    };
    let mut whole = 0.0;
    let weights = contact.rows.iter().map(|row| row.weight);
    for ((weight, at), rubbing) in weights.zip(found).zip(rows).filter(|((_, at), _)| at.status != Status::Open) {
        whole += weight;
        *if at.status == Status::Stick { &mut out.stick_area } else { &mut out.slip_area } += weight;
        if !at.closed_before {
            out.newly_closed += weight;
        }
        out.max_slip = out.max_slip.max(rubbing.slip.norm());
        out.max_utilisation = out.max_utilisation.max(rubbing.utilisation);
        out.dissipation -= (0..2).map(|a| at.traction[a] * at.increment[a]).sum::<f64>();
        out.uniqueness = out.uniqueness.min(at.uniqueness);
    }
    if whole > 0.0 {
        out.stick_area *= area / whole;
        out.slip_area *= area / whole;
        out.newly_closed /= whole;
    }
    out
}
