//! Two polyhedra in contact: the pairs of their features, as points that touch.
//!
//! The sites of such a contact are those of the slave, which are for other bodies, and then its features; the place of a pair is the
//! number of the feature of the master.

use super::touching::Id;
use crate::body::{Body, BodyState};
use crate::contact::{Contact, Sides};
use crate::interaction::Bodies;
use crate::pair::Pair;
use crate::points::Order;
use crate::system::{System, SystemState};
use nalgebra::Rotation3;
use signorini_geometry::polyhedra::{Feature, Meeting, Placed, meeting, meetings};
use signorini_geometry::{Matrix, Point};

/// Distance, relative to the sizes of both, within which a corner is on an edge or on another corner: rounding of their places.
const SNAP: f64 = 1e-9;

/// Part of the thickness of a polyhedron by which another one may move along it, or into it, in a step.
const PART: f64 = 0.25;

/// Two polyhedra where they are.
pub struct Polyhedra<'b> {
    bodies: [Placed<'b>; 2],
    /// The number of sites before those that are features.
    first: usize,
    snap: f64,
}

/// A pair of features with what moves it.
pub struct Faced {
    pub site: usize,
    pub place: usize,
    /// Where the slave is nearest.
    pub x: Point<3>,
    pub pair: Pair,
}

impl<'b> Polyhedra<'b> {
    /// Of a contact of polyhedra; none of others.
    pub fn of(contact: &Contact, sides: &Sides<'b>) -> Option<Self> {
        let bodies = [sides.slave.0.polyhedron(sides.slave.1)?, sides.master.0.polyhedron(sides.master.1)?];
        let first = contact.sites().len().checked_sub(bodies[0].features.count())?;
        let snap = SNAP * (bodies[0].features.radius() + bodies[1].features.radius());
        Some(Polyhedra { bodies, first, snap })
    }

    fn name(&self, met: &Meeting) -> (usize, usize) {
        let [a, b] = [0, 1].map(|k| self.bodies[k].features.number(met.on[k]));
        (self.first + a, b)
    }

    /// The features of a pair by its name.
    pub fn features(&self, id: Id) -> Option<[Feature; 2]> {
        let site = id.site.checked_sub(self.first)?;
        Some([self.bodies[0].features.feature(site), self.bodies[1].features.feature(id.place)])
    }

    /// The pairs no farther apart than `reach`, with their names.
    pub fn near(&self, reach: f64) -> Vec<((usize, usize), Meeting)> {
        let found = meetings([&self.bodies[0], &self.bodies[1]], reach, self.snap);
        found.into_iter().map(|met| (self.name(&met), met)).collect()
    }

    /// A pair by its name, which touched in a state before.
    pub fn known(&self, id: Id) -> Option<Meeting> {
        meeting([&self.bodies[0], &self.bodies[1]], self.features(id)?, f64::INFINITY)
    }

    /// The measures of a pair.
    pub fn measured(&self, met: &Meeting, contact: &Contact, sides: &Sides<'_>, order: Order) -> Option<Faced> {
        let carried = [
            sides.slave.0.carried(sides.slave.1, &met.points[0])?,
            sides.master.0.carried(sides.master.1, &met.points[1])?,
        ];
        let pair = Pair::of_features(met, [&carried[0], &carried[1]], sides.first, (order, contact.axis));
        let (site, place) = self.name(met);
        Some(Faced { site, place, x: met.points[0], pair })
    }

    /// The thickness of the thinner of both.
    fn width(&self) -> f64 {
        self.bodies[0].features.width().min(self.bodies[1].features.width())
    }

    /// The distance of both, at most `reach`; nothing where they touch or overlap.
    fn distance(&self, reach: f64) -> f64 {
        self.near(reach).iter().map(|(_, met)| met.gap.max(0.0)).fold(reach, f64::min)
    }

    /// The first body seen from the second: its place, and rotation.
    fn relative(&self) -> (Point<3>, Matrix<3>) {
        let [a, b] = &self.bodies;
        let back = b.rotation.transpose();
        (back * (a.point(&a.features.middle()) - b.centre), back * a.rotation)
    }
}

impl System {
    /// The least gap of two polyhedra that a contact names, where they are nearest; none of other contacts, and of bodies that are
    /// apart.
    pub fn deepest_overlap(&self, contact: usize, state: &SystemState) -> Option<(f64, Point<3>)> {
        let (first, _) = self.numbering();
        let at = Bodies { bodies: &self.bodies, states: &state.bodies, first: &first };
        let contact = self.contacts.get(contact)?.as_points()?;
        let both = Polyhedra::of(contact, &at.sides(contact))?;
        let found = both.near(0.0).into_iter().map(|(_, met)| (met.gap, met.points[0]));
        found.min_by(|a, b| a.0.total_cmp(&b.0))
    }
}

/// The share of a way between two states on which no polyhedron goes through another one: where they are apart by more than a part of
/// the thickness of the thinner one, as far as their distance allows (conservative advancement, Mirtich 1996); from there on by such
/// a part at once.
pub fn free_share(contacts: &[&Contact], [from, to]: [Bodies<'_>; 2]) -> f64 {
    let mut share = 1.0f64;
    for contact in contacts {
        let [start, end] = [from, to].map(|at| Polyhedra::of(contact, &at.sides(contact)));
        let (Some(start), Some(end)) = (start, end) else { continue };
        let [(before, turned), (after, then)] = [&start, &end].map(Polyhedra::relative);
        let angle = Rotation3::from_matrix_unchecked(then * turned.transpose()).angle();
        let way = (after - before).norm() + angle * start.bodies[0].features.radius();
        let part = PART * start.width();
        let at = |share: f64| -> Vec<BodyState> {
            let between = |body: &dyn Body, k: usize| body.between(&from.states[k], &to.states[k], share);
            from.bodies.iter().enumerate().map(|(k, body)| between(body.as_ref(), k)).collect()
        };
        let mut t = 0.0;
        while (share - t) * way > part {
            let states = at(t);
            let there = Bodies { states: &states, ..from };
            let Some(both) = Polyhedra::of(contact, &there.sides(contact)) else { break };
            let distance = both.distance((share - t) * way + part);
            if distance <= part {
                share = share.min(t + part / way);
                break;
            }
            t += distance / way;
        }
    }
    share
}
