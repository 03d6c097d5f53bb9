//! The points where rigid bodies may touch in a state: gaps, slips and what moves them.

use super::polyhedra::{Faced, Polyhedra};
use crate::contact::{Contact, axes};
use crate::interaction::Bodies;
use crate::pair::{Pair, PairGeometry, Stuck};
use crate::points::{MasterProjection, Order};
use crate::rigid_body::Pose;
use crate::rotation;
use crate::system::SystemState;
use nalgebra::DMatrix;
use signorini_contact::Law;
use signorini_geometry::polyhedra::Meeting;
use signorini_geometry::{Point, Vector};
use std::collections::BTreeSet;

/// Which point of a contact it is: contact, site, and number of the place that the site may touch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Id {
    pub contact: usize,
    pub site: usize,
    pub place: usize,
}

/// A point that may touch.
pub struct Touching<'a> {
    pub id: Id,
    pub law: Option<&'a dyn Law>,
    pub weight: f64,
    /// The middle of the slave's ball, and where that touches.
    pub centre: Point<3>,
    pub x: Point<3>,
    pub pair: Pair,
    /// Axes of friction.
    pub axes: [Vector<3>; 2],
    /// Whether anything slips along each axis: in the plane nothing moves across it.
    pub moves: [bool; 2],
    /// Slip per step of the motions that are prescribed, and what they open the gap by.
    pub driven: Vector<3>,
    pub driven_gap: f64,
}

impl Touching<'_> {
    /// Rows: gap, and slip.
    pub fn rows(&self) -> usize {
        1 + if self.law.is_some() { self.moves.iter().filter(|m| **m).count() } else { 0 }
    }

    /// The axis of each row of slip.
    pub fn slip_axes(&self) -> [usize; 2] {
        if self.moves[0] { [0, 1] } else { [1, 1] }
    }

    /// Adds a matrix of the unknowns of the pair to one of all unknowns.
    pub fn add_to(&self, whole: &mut DMatrix<f64>, own: &DMatrix<f64>) {
        for (i, row) in self.pair.unknowns.iter().enumerate() {
            for (j, column) in self.pair.unknowns.iter().enumerate() {
                whole[(*row as usize, *column as usize)] += own[(i, j)];
            }
        }
    }

    /// The slip of a step of all unknowns.
    pub fn slip_of(&self, step: &[f64]) -> Vector<3> {
        let terms = self.pair.unknowns.iter().zip(&self.pair.slip);
        self.driven + terms.map(|(u, s)| s * step[*u as usize]).sum::<Vector<3>>()
    }
}

/// The motion of every body in a step as it is prescribed: of the centre, and the rotation vector; none of those that are free.
pub type Twists = Vec<Option<[Vector<3>; 2]>>;

/// The prescribed motions between two states.
pub fn twists(at: Bodies<'_>, from: &SystemState, to: &SystemState) -> Twists {
    let of = |k: usize| {
        if at.bodies[k].unknowns() > 0 {
            return None;
        }
        let [a, b] = [from, to].map(|s| Pose::of(&s.bodies[k]));
        Some([b.centre - a.centre, rotation::between(&a.turn, &b.turn)])
    };
    (0..at.bodies.len()).map(of).collect()
}

/// A state a share of a step after another: bodies as they move, prescribed ones by their twists.
pub fn along(
    at: Bodies<'_>,
    from: &SystemState,
    (step, twists): (&[f64], &Twists),
    share: f64,
) -> Vec<crate::body::BodyState> {
    (at.bodies.iter().zip(&from.bodies).enumerate())
        .map(|(k, (body, state))| match &twists[k] {
            Some([moved, turned]) => {
                let pose = Pose::of(state);
                pose.moved(&(moved * share), &(turned * share)).state()
            }
            None => {
                let first = at.first[k] as usize;
                body.advance(state, &step[first..first + body.unknowns()], share)
            }
        })
        .collect()
}

/// Sine below which a direction does not move.
const STILL: f64 = 1e-8;

/// Which points are asked for.
pub struct Wanted<'w> {
    /// By name and gap.
    pub by: &'w dyn Fn(Id, f64) -> bool,
    /// How far apart polyhedra are looked at.
    pub reach: f64,
    /// Pairs of polyhedra that are asked for wherever they are: they touched in a state before.
    pub named: &'w BTreeSet<Id>,
}

/// No pairs of polyhedra.
static NONE: BTreeSet<Id> = BTreeSet::new();

impl<'w> Wanted<'w> {
    /// By name and gap, of polyhedra within a reach.
    pub fn near(by: &'w dyn Fn(Id, f64) -> bool, reach: f64) -> Self {
        Wanted { by, reach, named: &NONE }
    }
}

/// The points of all contacts that are wanted.
pub fn touching<'a>(
    contacts: &[&'a Contact],
    at: Bodies<'_>,
    twists: &Twists,
    order: Order,
    wanted: &Wanted<'_>,
) -> Vec<Touching<'a>> {
    let mut out = Vec::new();
    for (number, contact) in contacts.iter().enumerate() {
        let sides = at.sides(contact);
        let friction = contact.law.friction.is_some();
        let mut add = |id: Id, weight: f64, centre: Point<3>, x: Point<3>, pair: Pair| {
            let velocity = |body: usize| match &twists[body] {
                Some([moved, turned]) => moved + turned.cross(&(x - Pose::of(&at.states[body]).centre)),
                None => Vector::<3>::zeros(),
            };
            let driven = velocity(contact.slave.body) - velocity(contact.master.body);
            let driven_gap = pair.normal.dot(&driven);
            let driven = driven - pair.normal * driven_gap;
            let axes = if friction { axes(&pair).0 } else { [Vector::<3>::zeros(); 2] };
            let most = pair.slip.iter().map(|s| s.norm()).fold(0.0, f64::max);
            let moves = axes.map(|e| pair.slip.iter().any(|s| e.dot(s).abs() > STILL * most));
            let law = contact.law.friction.as_deref();
            out.push(Touching { id, law, weight, centre, x, pair, axes, moves, driven, driven_gap });
        };
        if let Some(both) = Polyhedra::of(contact, &sides) {
            let id = |(site, place): (usize, usize)| Id { contact: number, site, place };
            let named = wanted.named.iter().filter(|id| id.contact == number);
            let known: Vec<Meeting> = named.filter_map(|id| both.known(*id)).collect();
            let near = if wanted.reach >= 0.0 { both.near(wanted.reach) } else { Vec::new() };
            let near = near
                .into_iter()
                .filter(|(name, met)| !wanted.named.contains(&id(*name)) && (wanted.by)(id(*name), met.gap));
            for met in known.into_iter().chain(near.map(|(_, met)| met)) {
                if let Some(Faced { site, place, x, pair }) = both.measured(&met, contact, &sides, order) {
                    add(id((site, place)), 1.0, x, x, pair);
                }
            }
            continue;
        }
        let Ok(master) = sides.master.0.master(contact.master.group.as_deref(), sides.master.1) else { continue };
        for (k, site) in contact.sites().iter().enumerate() {
            let placed = sides.slave.0.placed(sides.slave.1, site);
            for (place, met) in master.places(&placed.x).into_iter().enumerate() {
                let id = Id { contact: number, site: k, place };
                let MasterProjection::Rigid(foot) = &met else { continue };
                let gap = foot.jet.gap - placed.radius;
                if !(wanted.named.contains(&id) || (wanted.by)(id, gap)) {
                    continue;
                }
                let stuck = Stuck { point: foot.point, ..Stuck::default() };
                let anchor = master.at(&foot.point);
                let encounter = PairGeometry {
                    slave: &placed,
                    met: &met,
                    first: sides.first,
                    stuck: Some((&stuck, &anchor)),
                    since: [contact.slave.body, contact.master.body].map(|body| Pose::of(&at.states[body]).turn),
                    friction,
                    axis: contact.axis,
                };
                let Ok(pair) = encounter.measure(order) else { continue };
                add(id, site.weight, placed.x, placed.x - pair.normal * placed.radius, pair);
            }
        }
    }
    out
}
