//! What is kept of contacts between curves, whose points are found anew in every state: from the last state that was
//! accepted, and from one iterate to the next.
//!
//! A contact is the same as one before if it is of the same kind and its places along both curves have moved by less than
//! an element.

use super::measure::Stuck;
use super::search::Searched;
use signorini_geometry::Vector;
use signorini_mechanics::body::MaterialPoint;

/// What a contact is found from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A minimum of the distance of both curves.
    Crossing,
    /// A point of Gauss of the slave, by number.
    Site(usize),
}

/// Which contact of two curves: of what kind, and where along both, as elements plus parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactId {
    pub kind: Kind,
    pub places: [f64; 2],
}

/// What is kept of a contact.
#[derive(Clone, Copy, Debug)]
pub struct ContactHistory {
    pub key: ContactId,
    /// Force, negative: the multiplier of an augmented Lagrangian, and what the next increment starts with.
    pub force: f64,
    /// Multiplier of friction along the axes.
    pub traction: [f64; 2],
    /// The side from which the slave comes.
    pub normal: Vector<3>,
    pub stuck: Option<Stuck>,
    /// Slip in all while closed, along the axes.
    pub slip: [f64; 2],
}

/// What the step before predicts of a closed contact: its force, and the trial of its friction along the axes.
#[derive(Clone, Copy, Debug)]
pub struct Predicted {
    pub key: ContactId,
    pub force: f64,
    pub trial: [f64; 2],
}

/// How far along the curves, in elements, a contact may have moved and still be the same.
const SAME: f64 = 1.0;
/// How far it may have moved and still come from the same side.
const NEAR: f64 = 3.0;

impl ContactId {
    fn apart(&self, other: &ContactId, sides: &[Searched<'_>; 2]) -> f64 {
        (0..2).fold(0.0f64, |m, s| m.max(sides[s].apart(self.places[s], other.places[s])))
    }

    /// The one of a list, by its keys, that is this contact.
    pub fn of<'a, T>(&self, list: &'a [T], key: impl Fn(&T) -> ContactId, sides: &[Searched<'_>; 2]) -> Option<&'a T> {
        let same_kind = list.iter().filter(|t| key(t).kind == self.kind);
        nearest(same_kind, |t| self.apart(&key(t), sides), SAME)
    }

    /// The one of a list that is nearest, of whatever kind.
    pub fn near<'a>(&self, list: &'a [ContactHistory], sides: &[Searched<'_>; 2]) -> Option<&'a ContactHistory> {
        nearest(list.iter(), |t| self.apart(&t.key, sides), NEAR)
    }

    fn numbers(&self) -> [f64; 4] {
        let [kind, site] = match self.kind {
            Kind::Crossing => [0.0, 0.0],
            Kind::Site(k) => [1.0, k as f64],
        };
        [kind, site, self.places[0], self.places[1]]
    }

    fn from_numbers(n: &[f64]) -> Self {
        let kind = if n[0] == 0.0 { Kind::Crossing } else { Kind::Site(n[1] as usize) };
        ContactId { kind, places: [n[2], n[3]] }
    }
}

fn nearest<'a, T: 'a>(list: impl Iterator<Item = &'a T>, apart: impl Fn(&T) -> f64, most: f64) -> Option<&'a T> {
    list.map(|t| (apart(t), t)).min_by(|p, q| p.0.total_cmp(&q.0)).filter(|p| p.0 <= most).map(|p| p.1)
}

impl Predicted {
    /// Numbers that stand for one.
    pub const NUMBERS: usize = 7;

    pub fn numbers(&self) -> [f64; Self::NUMBERS] {
        let [a, b, c, d] = self.key.numbers();
        [a, b, c, d, self.force, self.trial[0], self.trial[1]]
    }

    pub fn list(numbers: &[f64]) -> Vec<Predicted> {
        let one = |n: &[f64]| Predicted { key: ContactId::from_numbers(n), force: n[4], trial: [n[5], n[6]] };
        numbers.chunks_exact(Self::NUMBERS).map(one).collect()
    }
}

impl ContactHistory {
    /// Numbers that stand for one.
    pub const NUMBERS: usize = 23;

    pub fn numbers(&self) -> [f64; Self::NUMBERS] {
        let mut out = [0.0; Self::NUMBERS];
        out[..4].copy_from_slice(&self.key.numbers());
        out[4] = self.force;
        out[5..7].copy_from_slice(&self.traction);
        out[7..10].copy_from_slice(self.normal.as_slice());
        out[10..12].copy_from_slice(&self.slip);
        if let Some(stuck) = &self.stuck {
            out[12] = 1.0;
            for side in 0..2 {
                out[13 + 2 * side] = f64::from(stuck.points[side].patch);
                out[14 + 2 * side] = stuck.points[side].xi[0];
                out[17 + 3 * side..20 + 3 * side].copy_from_slice(stuck.directions[side].as_slice());
            }
        }
        out
    }

    pub fn list(numbers: &[f64]) -> Vec<ContactHistory> {
        let vector = |n: &[f64], k: usize| Vector::<3>::new(n[k], n[k + 1], n[k + 2]);
        let stuck = |n: &[f64]| Stuck {
            points: [0, 1].map(|s| MaterialPoint { patch: n[13 + 2 * s] as u32, xi: [n[14 + 2 * s], 0.0, 0.0] }),
            directions: [0, 1].map(|s| vector(n, 17 + 3 * s)),
        };
        let one = |n: &[f64]| ContactHistory {
            key: ContactId::from_numbers(n),
            force: n[4],
            traction: [n[5], n[6]],
            normal: vector(n, 7),
            slip: [n[10], n[11]],
            stuck: (n[12] != 0.0).then(|| stuck(n)),
        };
        numbers.chunks_exact(Self::NUMBERS).map(one).collect()
    }
}
