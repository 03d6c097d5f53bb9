//! What is stated of friction, what it remembers, and what is found of it.

use signorini_contact::friction::WeightedSlip;
use signorini_contact::{Law, Status};
use signorini_geometry::Point;
use std::ops::Range;

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
    pub starts: Vec<usize>,
    /// The displacement of the rigid master at every point: now, and at the last state found.
    pub now: Vec<Point<D>>,
    pub before: Vec<Point<D>>,
}

impl<const D: usize> Default for SlipHistory<D> {
    fn default() -> Self {
        SlipHistory { rows: Vec::new(), starts: Vec::new(), now: Vec::new(), before: Vec::new() }
    }
}

/// Friction at a row.
#[derive(Clone, Debug)]
pub(crate) struct FrictionAt {
    pub status: Status,
    /// Along the axes of the law, per area.
    pub traction: [f64; 2],
    /// Weighted slip of the increment along these axes.
    pub increment: [f64; 2],
    /// In all.
    pub slip: [f64; 3],
    pub closed_before: bool,
    pub uniqueness: f64,
}

/// Friction of all rows.
pub(crate) struct Found {
    pub at: Vec<FrictionAt>,
    pub unstable: bool,
}

impl Found {
    /// Of the rows of a contact.
    pub fn of(&self, rows: Range<usize>) -> &[FrictionAt] {
        &self.at[rows]
    }
}
