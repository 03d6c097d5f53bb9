//! What is measured of a pair, and of what: a slave site and what it meets.

use crate::points::{Anchor, MasterProjection, MaterialPoint, SlavePoint};
use signorini_geometry::Vector;

/// Why two things that are near each other make no pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoPair {
    /// The slave surface faces away.
    FacesAway,
    /// The coordinates of the pair do not exist: on a focal set.
    NoCoordinates,
}

/// Where both sides had a common point: the material point of the master, and the direction in which the sections of
/// both touched, in their own axes.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Stuck {
    pub point: MaterialPoint,
    pub on_slave: Vector<3>,
    pub on_master: Vector<3>,
}

/// One unknown and how it moves the partners, at fixed coordinates.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Column {
    pub(super) unknown: u32,
    /// `δD`, `δD_a`, `δD_ab`.
    pub(super) d: Vector<3>,
    pub(super) d_a: [Vector<3>; 2],
    pub(super) d_ab: [Vector<3>; 3],
    pub(super) spin: [Vector<3>; 2],
    /// How the spin of the master changes along its first coordinate.
    pub(super) spin_slope: Vector<3>,
    /// Which of the spins of a side it is.
    pub(super) turns: Option<(usize, usize)>,
    /// Motion of the anchor, and of its tangent.
    pub(super) anchor: Vector<3>,
    pub(super) anchor_tangent: Vector<3>,
    pub(super) anchor_spin: Vector<3>,
    /// Motion of the slave's tangent.
    pub(super) tangent: Vector<3>,
    /// Turn of the axes in which vectors are compared: of a rigid master.
    pub(super) turn: Vector<3>,
}

/// A direction from which friction takes its first axis, with its variations.
#[derive(Clone, Debug, Default)]
pub struct Axis {
    pub direction: Vector<3>,
    pub variation: Vec<Vector<3>>,
}

/// The measures of a pair.
#[derive(Clone, Debug, Default)]
pub struct Pair {
    pub gap: f64,
    pub normal: Vector<3>,
    /// The material point of the master that is met.
    pub point: MaterialPoint,
    /// Whether that is beside the site, at an end or edge of the surface: another point meets the site where it comes.
    pub is_beside: bool,
    /// Unknowns of the system; one may be named twice, its contributions add up.
    pub unknowns: Vec<u32>,
    pub d_gap: Vec<f64>,
    /// What a unit of pressure opens: the variation of the gap, unless that is measured along another direction than the
    /// one in which the pressure acts.
    pub opening: Vec<f64>,
    /// Its derivative, row by row; empty where only first variations were asked for.
    pub d_opening: Vec<f64>,
    /// Variation of the normal (seen from the master if that is rigid).
    pub d_normal: Vec<Vector<3>>,
    /// Turn of the axes from which variations are seen: of a rigid master that is free, else empty.
    pub turn: Vec<Vector<3>>,
    /// Variation of the slip.
    pub slip: Vec<Vector<3>>,
    /// Slip since the anchor and its variation.
    pub elastic: Vector<3>,
    pub d_elastic: Vec<Vector<3>>,
    /// The direction from which friction takes its first axis.
    pub axis: Axis,
    /// Where the pair touches, as an anchor of what follows.
    pub stuck: Option<Stuck>,
    pub(super) second: SecondVariation,
}

/// What the second variation of the slip needs.
#[derive(Clone, Debug, Default)]
pub(super) enum SecondVariation {
    #[default]
    None,
    /// Third-order tensor, component by component: `T·δS` is the sum of `T_i` times these matrices.
    Full([Vec<f64>; 3]),
}

impl Pair {
    /// Adds unknowns that move neither side.
    pub(crate) fn include(&mut self, unknowns: &[u32]) {
        let n = self.unknowns.len();
        let m = n + unknowns.len();
        let widen = |matrix: &mut Vec<f64>| {
            if !matrix.is_empty() {
                let mut out = vec![0.0; m * m];
                out.chunks_mut(m).zip(matrix.chunks(n)).for_each(|(to, from)| to[..n].copy_from_slice(from));
                *matrix = out;
            }
        };
        let zero = Vector::<3>::zeros();
        self.unknowns.extend(unknowns);
        self.d_gap.resize(m, 0.0);
        self.opening.resize(m, 0.0);
        widen(&mut self.d_opening);
        if let SecondVariation::Full(parts) = &mut self.second {
            parts.iter_mut().for_each(widen);
        }
        let lists = [&mut self.d_normal, &mut self.turn, &mut self.slip, &mut self.d_elastic, &mut self.axis.variation];
        lists.into_iter().filter(|l| !l.is_empty()).for_each(|l| l.resize(m, zero));
    }

    /// `T · Δδ slip`, row by row.
    pub fn slip_hessian(&self, traction: &Vector<3>) -> Vec<f64> {
        let n = self.unknowns.len();
        let mut out = vec![0.0; n * n];
        if let SecondVariation::Full(parts) = &self.second {
            for (part, t) in parts.iter().zip(traction.iter()) {
                out.iter_mut().zip(part).for_each(|(o, p)| *o += t * p);
            }
        }
        out
    }
}

/// A slave site with what it meets.
pub struct PairGeometry<'a> {
    pub slave: &'a SlavePoint,
    pub met: &'a MasterProjection,
    /// First unknown of the slave's body and of the master's body in the system.
    pub first: [u32; 2],
    /// Where slips count from, with what moves it.
    pub stuck: Option<(&'a Stuck, &'a Anchor)>,
    /// The rotation vectors that slave and master had then, of rigid bodies.
    pub since: [Vector<3>; 2],
    /// Whether slip is wanted.
    pub friction: bool,
    pub axis: AxisChoice,
}

/// What carries the first axis of friction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AxisChoice {
    /// Any direction that moves with the material of the master: for laws without axes.
    #[default]
    Material,
    /// The tangent of the slave, which is a curve.
    Tangent,
    /// A direction that turns with the slave or the master if that is rigid, and else stays.
    OnSlave(Vector<3>),
    OnMaster(Vector<3>),
}

/// The unit vector along an axis.
pub fn axis(i: usize) -> Vector<3> {
    Vector::<3>::from_fn(|k, _| f64::from(u8::from(k == i)))
}

/// Some direction across a normal.
pub fn any_tangent(normal: &Vector<3>) -> Vector<3> {
    let across = axis(normal.iamin());
    (across - normal * normal.dot(&across)).normalize()
}
