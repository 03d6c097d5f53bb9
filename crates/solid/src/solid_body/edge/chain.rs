//! The chain of cell edges along which two surfaces of a body meet.

use super::super::SolidBody;
use super::super::faces::{Face, SMOOTH};
use signorini_fem::mesh::position;
use signorini_fem::{Local, Side};
use signorini_geometry::{Point, Vector};
use signorini_mechanics::curve::Closure;
use std::collections::{BTreeMap, HashMap};

/// An edge that cannot touch as a curve.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum EdgeError {
    #[error("edges are available for bodies in space only")]
    Plane,
    #[error("edge `{edge}`: a group with this name already exists")]
    Taken { edge: String },
    #[error("edge `{edge}`: there is no group `{group}` of sides; valid are {}", known.join(", "))]
    Unknown { edge: String, group: String, known: Vec<String> },
    #[error("edge `{edge}`: the radius is {radius}; valid are 0 and larger")]
    Radius { edge: String, radius: f64 },
    #[error("edge `{edge}`: `{}` and `{}` have no common edge", surfaces[0], surfaces[1])]
    Apart { edge: String, surfaces: [String; 2] },
    #[error("edge `{edge}`: it branches at {at}")]
    Branches { edge: String, at: String },
    #[error("edge `{edge}`: it has {pieces} pieces, one of them from {at}")]
    Pieces { edge: String, pieces: usize, at: String },
    #[error("edge `{edge}`: it has a kink at {at}, where it turns by {angle:.0} degrees")]
    Kink { edge: String, at: String, angle: f64 },
    #[error("edge `{edge}`: it is re-entrant at {at}: contact there is with its faces")]
    Reentrant { edge: String, at: String },
}

/// An edge of cells with the two faces that meet there: from which place of each to which.
pub(super) struct Link {
    pub faces: [(u32, [Local; 2]); 2],
    /// Where it begins, for messages.
    pub at: String,
}

/// The vertices of a cell edge, the lower one first.
type Ends = [u32; 2];

/// The edges of a face.
fn edges<const D: usize>(face: &Face<D>) -> impl Iterator<Item = Ends> + '_ {
    face.shape.edges().iter().map(|e| {
        let [a, b] = e.map(|k| face.vertices[k]);
        [a.min(b), a.max(b)]
    })
}

/// Where on a face a vertex is.
fn corner<const D: usize>(face: &Face<D>, vertex: u32) -> Option<Local> {
    face.vertices.iter().position(|v| *v == vertex).map(|k| face.shape.vertices()[k])
}

/// The edges along which two surfaces meet, in order.
pub(super) fn links<const D: usize>(
    body: &SolidBody<D>,
    name: &str,
    surfaces: &[String; 2],
) -> Result<(Vec<Link>, Closure), EdgeError> {
    let edge = || name.to_string();
    let around = |group: &String| -> Result<HashMap<Ends, Vec<u32>>, EdgeError> {
        let sides: &[Side] = body.groups.get(group).map_or(&[], |g| &g.sides);
        if sides.is_empty() {
            let known = body.groups.iter().filter(|g| !g.1.sides.is_empty()).map(|g| g.0.clone()).collect();
            return Err(EdgeError::Unknown { edge: edge(), group: group.clone(), known });
        }
        let mut out: HashMap<Ends, Vec<u32>> = HashMap::new();
        for face in &body.faces.surface(group).faces {
            edges(body.faces.face(*face)).for_each(|e| out.entry(e).or_default().push(*face));
        }
        Ok(out)
    };
    let [first, second] = [around(&surfaces[0])?, around(&surfaces[1])?];
    let mut found: BTreeMap<Ends, [u32; 2]> = BTreeMap::new();
    for (ends, faces) in &first {
        let others = second.get(ends).map_or(&[][..], |l| &l[..]);
        let pair = faces.iter().flat_map(|a| others.iter().map(move |b| [*a, *b])).filter(|[a, b]| a != b).min();
        found.extend(pair.map(|pair| (*ends, pair)));
    }
    if found.is_empty() || surfaces[0] == surfaces[1] {
        return Err(EdgeError::Apart { edge: edge(), surfaces: surfaces.clone() });
    }
    let at = |vertex: u32| position(&body.mesh().nodes()[vertex as usize]);
    let mut neighbours: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for [a, b] in found.keys() {
        neighbours.entry(*a).or_default().push(*b);
        neighbours.entry(*b).or_default().push(*a);
    }
    if let Some((vertex, _)) = neighbours.iter().find(|(_, list)| list.len() > 2) {
        return Err(EdgeError::Branches { edge: edge(), at: at(*vertex) });
    }
    let end = neighbours.iter().find(|(_, list)| list.len() == 1).map(|(v, _)| *v);
    let closure = if end.is_some() { Closure::Open } else { Closure::Closed };
    let start = end.or_else(|| neighbours.keys().next().copied()).unwrap_or_default();
    let mut vertices = vec![start];
    while vertices.len() <= found.len() {
        let last = vertices[vertices.len() - 1];
        let before = vertices.len().checked_sub(2).map(|k| vertices[k]);
        let Some(next) = neighbours[&last].iter().find(|v| Some(**v) != before) else { break };
        vertices.push(*next);
        if *next == start {
            break;
        }
    }
    if vertices.len() <= found.len() {
        let passed = |v: &u32| vertices.contains(v);
        let other = neighbours.keys().find(|v| !passed(v)).copied().unwrap_or_default();
        let ends = neighbours.values().filter(|list| list.len() == 1).count();
        return Err(EdgeError::Pieces { edge: edge(), pieces: (ends / 2).max(2), at: at(other) });
    }
    let mut out = Vec::with_capacity(found.len());
    for pair in vertices.windows(2) {
        let [a, b] = [pair[0], pair[1]];
        let faces = found[&[a.min(b), a.max(b)]].map(|f| {
            let face = body.faces.face(f);
            (f, [corner(face, a), corner(face, b)].map(Option::unwrap_or_default))
        });
        let link = Link { faces, at: at(a) };
        check_outward(body, name, &link)?;
        out.push(link);
    }
    Ok((out, closure))
}

/// Sine of the angle by which faces that go on straight may seem re-entrant.
const FLAT: f64 = 1e-6;

/// Whether an edge stands out: the one face lies behind the other.
fn check_outward<const D: usize>(body: &SolidBody<D>, name: &str, link: &Link) -> Result<(), EdgeError> {
    let [(a, ends), (b, _)] = link.faces;
    let middle = super::between(&ends, 0.5);
    let at = body.faces.reference(a, &middle);
    let normal = at.area_normal().normalize();
    let towards: Point<D> = body.faces.reference(b, &body.faces.face(b).shape.centre()).x - at.x;
    if towards.dot(&normal) > FLAT * towards.norm() {
        return Err(EdgeError::Reentrant { edge: name.to_string(), at: link.at.clone() });
    }
    Ok(())
}

/// Whether a chain goes on smoothly.
pub(super) fn check_kink(name: &str, link: &Link, before: Vector<3>, after: Vector<3>) -> Result<(), EdgeError> {
    let cosine = before.dot(&after) / (before.norm() * after.norm());
    if cosine < SMOOTH - FLAT {
        let angle = cosine.clamp(-1.0, 1.0).acos().to_degrees();
        return Err(EdgeError::Kink { edge: name.to_string(), at: link.at.clone(), angle });
    }
    Ok(())
}
