//! Whether a body slides off the end of another: why a path with finite sliding may have no next state.

use crate::contact::{Contact, Master, Method};
use crate::model::Model;
use crate::sliding::Settled;
use signorini_contact::{ContactSurface, Moved};
use signorini_fem::Local;
use signorini_geometry::Point;
use std::collections::HashMap;

/// Part of the force of a contact that lies at the end of the master when the slave slides off it, and of the travel that
/// leads there: the larger part.
const MOST: f64 = 0.5;

/// A body that slides off the end of another, in the last state found.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "`{body}` slides off the end of `{over}` at {place}, after a travel of {travel:.6} along it: there may be no state beyond \
     it; end the motion before, or round the end off"
)]
pub struct SlidesOff {
    pub body: String,
    pub over: String,
    /// The end of the master side, displaced.
    pub place: String,
    /// How far what carries was displaced against the end, in all.
    pub travel: f64,
}

impl<const D: usize> Model<D> {
    /// Whether a contact may have no next state because, in the last one found, most of its force was carried within one face
    /// of the end of the master side.
    pub(crate) fn slides_off(&self, which: usize) -> Option<SlidesOff> {
        let settled = self.settled.as_ref()?;
        let contact: &Contact<D> = self.contacts.get(which)?;
        let Master::Surface(master) = &contact.master else { return None };
        let ends = ends(master, &Moved { surface: master, u: &settled.u });
        let carrying = carrying(contact, which, settled);
        let whole: f64 = carrying.iter().map(|(_, force)| force).sum();
        let reach = carrying.iter().map(|(at, _)| at.face_size).fold(0.0, f64::max);
        let near = |at: &Carrying<D>| {
            // Only over the end that it moves to, not along those beside its way.
            let travel = |end: &End<D>| at.moved - end.moved;
            let towards = |end: &&End<D>| {
                let way = travel(end);
                way.dot(&end.outward) > MOST * way.norm() * end.outward.norm()
            };
            let nearest = |a: &&End<D>, b: &&End<D>| (a.at - at.x).norm().total_cmp(&(b.at - at.x).norm());
            let end = ends.iter().filter(towards).min_by(nearest)?;
            ((end.at - at.x).norm() <= reach).then_some((end, travel(end).norm()))
        };
        let at_end: f64 = carrying.iter().filter(|(at, _)| near(at).is_some()).map(|(_, force)| force).sum();
        if carrying.is_empty() || at_end < MOST * whole {
            return None;
        }
        let (end, travel) = carrying.iter().filter_map(|(at, _)| near(at)).max_by(|a, b| a.1.total_cmp(&b.1))?;
        let place: Vec<String> = end.at.iter().map(|v| format!("{v:.6}")).collect();
        Some(SlidesOff {
            body: contact.slave.body().name.clone(),
            over: master.body().name.clone(),
            place: format!("({})", place.join(", ")),
            travel,
        })
    }
}

/// A place on the border of a surface: where it is, how it moved there, and a way outwards along the surface.
struct End<const D: usize> {
    at: Point<D>,
    moved: Point<D>,
    outward: Point<D>,
}

/// The vertices on the border of a surface: in the plane those of one face only, in space the ends of edges of one face only.
fn ends<const D: usize>(at_rest: &dyn ContactSurface<D>, moved: &dyn ContactSurface<D>) -> Vec<End<D>> {
    let mut faces_of: HashMap<Vec<u32>, usize> = HashMap::new();
    let pieces = |face: usize| -> Vec<Vec<usize>> {
        let shape = at_rest.shape(face);
        let count = shape.vertices().len();
        if D == 2 { (0..count).map(|v| vec![v]).collect() } else { shape.edges().iter().map(|e| e.to_vec()).collect() }
    };
    let key = |face: usize, piece: &[usize]| {
        let vertices = at_rest.vertices(face);
        let mut key: Vec<u32> = piece.iter().map(|&v| vertices[v]).collect();
        key.sort_unstable();
        key
    };
    for face in 0..at_rest.face_count() {
        pieces(face).iter().for_each(|piece| *faces_of.entry(key(face, piece)).or_default() += 1);
    }
    let mut out = Vec::new();
    for face in 0..at_rest.face_count() {
        let corners = at_rest.shape(face).vertices();
        for piece in pieces(face).into_iter().filter(|piece| faces_of[&key(face, piece)] == 1) {
            // An edge by its middle, too.
            let middle: Local =
                std::array::from_fn(|k| piece.iter().map(|&v| corners[v][k]).sum::<f64>() / piece.len() as f64);
            let centre = moved.at(face, &at_rest.shape(face).centre()).x;
            for s in piece.iter().map(|&v| corners[v]).chain([middle]) {
                let at = moved.at(face, &s).x;
                out.push(End { at, moved: at - at_rest.at(face, &s).x, outward: at - centre });
            }
        }
    }
    out
}

/// A place of the slave side that carries a force.
struct Carrying<const D: usize> {
    x: Point<D>,
    moved: Point<D>,
    face_size: f64,
}

/// The rows that carry in a state, where they are then, and their forces.
fn carrying<const D: usize>(contact: &Contact<D>, which: usize, settled: &Settled) -> Vec<(Carrying<D>, f64)> {
    let moved = Moved { surface: &contact.slave, u: &settled.u };
    // Rows in the mean lie at their pressure node.
    let mut place_of_node: HashMap<u32, (usize, Local)> = HashMap::new();
    for face in 0..contact.nodes.face_count() {
        for ((node, _), s) in contact.nodes.of_face(face).iter().zip(contact.nodes.map(face).nodes()) {
            place_of_node.entry(*node).or_insert((face, s));
        }
    }
    // Those in the mean that are covered no more have no row now: areas are those of faces, about.
    let place = |number: u32| match contact.method {
        Method::GaussPoint => contact.tests.rows.get(number as usize).and_then(|row| row.place),
        _ => place_of_node.get(&number).copied(),
    };
    let mut pressures: Vec<(u32, f64)> =
        settled.pressure.iter().filter(|(key, p)| key.0 == which && **p > 0.0).map(|(key, p)| (key.1, *p)).collect();
    pressures.sort_by_key(|(number, _)| *number);
    (pressures.into_iter())
        .filter_map(|(number, pressure)| {
            let (face, s) = place(number)?;
            let x = moved.at(face, &s).x;
            let corners: Vec<Point<D>> =
                contact.slave.shape(face).vertices().iter().map(|v| moved.at(face, v).x).collect();
            let face_size = corners.iter().map(|c| (c - corners[0]).norm()).fold(0.0, f64::max);
            Some((
                Carrying { x, moved: x - contact.slave.at(face, &s).x, face_size },
                pressure * face_size.powi(D as i32 - 1),
            ))
        })
        .collect()
}
