//! Which faces of whole bodies may touch each other: of two thin bodies that lie on each other only those between them.

use super::within::{Within, around, vertices};
use crate::body::{Body, PlaceError};
use crate::part::Part;
use crate::points::Master;
use crate::surface::{Faces, Surface};
use rayon::prelude::*;
use signorini_contact::{ContactSurface, is_facing};
use signorini_geometry::{Point, Vector};
use std::collections::VecDeque;

/// The faces of both sides that may touch; all of a side where nothing else is said.
#[derive(Clone, Debug, Default)]
pub(super) struct Facing {
    slave: Option<Vec<bool>>,
    master: Option<Vec<bool>>,
    /// Whether no face of the slave looks at the master at the start.
    pub is_away: bool,
    /// What may touch what, of two sides of one body.
    pub within: Option<Within>,
}

impl Facing {
    /// Of a whole body of small strains, which does not turn far, those faces that look at the other side at the start, over
    /// the closest point of the other, against its normal, and what goes on from them. Of what is stated as a group all.
    ///
    /// # Errors
    /// A side that cannot be touched.
    pub fn new(
        slave: (&Part, &dyn Body),
        surface: &dyn Surface,
        master: (&Part, &dyn Body),
    ) -> Result<Self, PlaceError> {
        let is_whole = |(part, body): (&Part, &dyn Body)| part.group.is_none() && body.is_linear();
        let states = [slave.1.start(), master.1.start()];
        if slave.0.body == master.0.body {
            let opposite = master.1.surface(master.0.group.as_deref(), &states[1]);
            let within = opposite.map(|opposite| Within::new(surface, opposite.as_ref(), slave.0 == master.0));
            return Ok(Facing { within, ..Facing::default() });
        }
        let other = master.1.master(master.0.group.as_deref(), &states[1])?;
        let size = slave.1.size().min(if master.1.is_rigid() { f64::INFINITY } else { master.1.size() });
        let looks = looking(surface, (other.as_ref(), size));
        let mut out = Facing { is_away: looks.is_none(), ..Facing::default() };
        if is_whole(slave) {
            out.slave = looks.map(|list| gone_on(surface, &list));
        }
        if let Some(faces) = master.1.surface(master.0.group.as_deref(), &states[1]).filter(|_| is_whole(master)) {
            let looks = looking(faces.as_ref(), (slave.1.master(slave.0.group.as_deref(), &states[0])?.as_ref(), size));
            out.master = looks.map(|list| gone_on(faces.as_ref(), &list));
        }
        Ok(out)
    }

    pub fn slave(&self, face: usize) -> bool {
        self.slave.as_ref().is_none_or(|list| list[face])
    }

    /// Whether a face of the slave may touch one of the master.
    pub fn sees(&self, face: usize, other: usize) -> bool {
        self.slave(face)
            && self.master.as_ref().is_none_or(|list| list[other])
            && self.within.as_ref().is_none_or(|within| within.sees(face, other))
    }

    /// How deep a face of the slave may be inside of the master.
    pub fn deepest(&self, face: usize) -> f64 {
        self.within.as_ref().map_or(f64::INFINITY, |within| within.deepest(face))
    }
}

/// What lies deeper inside, relative to the size of the smaller body, is no interference, but seen from behind.
const INTERFERENCE: f64 = 0.25;

/// Which faces look at the other side; none told where none does.
fn looking(surface: &dyn Surface, (other, size): (&dyn Master, f64)) -> Option<Vec<bool>> {
    other.prepare();
    let looks = |(x, normal): &(Point<3>, Vector<3>)| {
        let gap = other.nearest(x, f64::INFINITY, None).and_then(|met| met.gap(x));
        gap.is_some_and(|(gap, outward)| gap > -INTERFERENCE * size && is_facing(normal, &outward))
    };
    let list: Vec<bool> = centres(surface).par_iter().map(looks).collect();
    list.contains(&true).then_some(list)
}

/// Cosine of the angle to a face up to which what hangs together with it lies on the same side of a body.
const SAME_SIDE: f64 = 0.1;

/// Some faces with all that hang together with them and lie on the same side of the body, whose normal is within a right angle
/// of theirs: where the other body may slide to.
fn gone_on(surface: &dyn Surface, from: &[bool]) -> Vec<bool> {
    let corners = vertices(surface);
    let normals: Vec<Vector<3>> = centres(surface).iter().map(|(_, n)| n.try_normalize(0.0).unwrap_or(*n)).collect();
    let around = around(&corners);
    // The normal of the face from which each is reached first.
    let mut reached: Vec<Option<Vector<3>>> = from.iter().zip(&normals).map(|(is, n)| is.then_some(*n)).collect();
    let mut front: VecDeque<usize> = (0..from.len()).filter(|face| from[*face]).collect();
    while let Some(face) = front.pop_front() {
        for next in corners[face].iter().filter_map(|v| around.get(v)).flatten().map(|next| *next as usize) {
            let side = reached[face].filter(|side| reached[next].is_none() && side.dot(&normals[next]) > SAME_SIDE);
            if side.is_some() {
                reached[next] = side;
                front.push_back(next);
            }
        }
    }
    reached.iter().map(Option::is_some).collect()
}

/// Middle and normal of every face.
fn centres(surface: &dyn Surface) -> Vec<(Point<3>, Vector<3>)> {
    match surface.faces().0 {
        Faces::Plane(faces) => centres_of(faces),
        Faces::Space(faces) => centres_of(faces),
    }
}

fn centres_of<const D: usize>(faces: &dyn ContactSurface<D>) -> Vec<(Point<3>, Vector<3>)> {
    let spatial = |x: &Point<D>| Point::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 });
    let of = |face: usize| {
        let at = faces.at(face, &faces.shape(face).centre());
        (spatial(&at.x), spatial(&at.area_normal()))
    };
    (0..faces.face_count()).map(of).collect()
}
