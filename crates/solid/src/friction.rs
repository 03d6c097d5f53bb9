//! Friction between two sides that slide little: stick and slip, and what slips count from.
//!
//! The tangential rows stand on the points, dual functions and weights of the weighted gaps. The slip of an increment
//! counts from the displacement of the last state found, which is the whole history; after an increment that failed it
//! is still that of the state before.

pub(crate) mod solve;
pub(crate) mod statement;

pub use statement::{Friction, FrictionHistory, FrictionResult, RigidMotion, Rubbing};

use crate::contact::{Contact, Enforcement, Method, PressureNode};
use crate::step_error::StepError;
use signorini_contact::friction::{NoAxis, slips_of_points, weighted_slips};
use signorini_contact::{ContactSurface, Shares, Status, TestPoint};
use signorini_fem::hierarchic::Values;
use signorini_geometry::Point;
use statement::{FrictionAt, SlipHistory};
use std::collections::HashMap;

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
            (Method::GaussPoint, Enforcement::Multiplier) => "multipliers at Gauss points over-constrain the surface",
            (_, Enforcement::Multiplier | Enforcement::Penalty { .. }) => continue,
            _ => "the contact has another enforcement",
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
