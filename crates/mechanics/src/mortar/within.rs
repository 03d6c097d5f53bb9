//! Contact of a surface with its own body: which faces may touch each other, and which of them is slave.

use crate::surface::{Faces, Surface};
use signorini_contact::{ContactSurface, Sighting, slaves};
use std::collections::BTreeMap;

/// The faces of two sides of one body.
#[derive(Clone, Debug)]
pub(super) struct Within {
    /// Faces of the master that share a vertex with each slave face, and can not touch it.
    near: Vec<Vec<u32>>,
    /// How deep each slave face may penetrate: half of its cell, since the far side of a wall is deeper.
    deepest: Vec<f64>,
    /// Whether each face is slave; none where the sides are different groups.
    pub is_slave: Option<Vec<bool>>,
}

/// Share of the depth of a cell that its face may penetrate.
const DEEPEST: f64 = 0.5;

impl Within {
    /// Of two groups of faces of one body; `is_one` if they are the same.
    pub fn new(slave: &dyn Surface, master: &dyn Surface, is_one: bool) -> Self {
        let [own, other] = [slave, master].map(vertices);
        let around = around(&other);
        let near = |list: &Vec<u32>| {
            let mut near: Vec<u32> = list.iter().filter_map(|v| around.get(v)).flatten().copied().collect();
            near.sort_unstable();
            near.dedup();
            near
        };
        Within {
            near: own.iter().map(near).collect(),
            deepest: (0..own.len()).map(|face| DEEPEST * slave.depth(face)).collect(),
            is_slave: is_one.then(|| vec![true; own.len()]),
        }
    }

    /// Whether two faces do not hang together.
    pub fn may_meet(&self, slave: usize, master: usize) -> bool {
        self.near[slave].binary_search(&(master as u32)).is_err()
    }

    /// Whether a face, as slave, may touch another one, as master.
    pub fn sees(&self, slave: usize, master: usize) -> bool {
        let has_roles = self.is_slave.as_ref().is_none_or(|roles| roles[slave] && !roles[master]);
        has_roles && self.may_meet(slave, master)
    }

    /// How deep a slave face may be inside.
    pub fn deepest(&self, face: usize) -> f64 {
        self.deepest[face]
    }

    /// Gives roles by what sees what; `carrying` are pairs of faces that carry. Whether any role changed.
    pub fn assign(&mut self, sightings: Vec<Sighting>, carrying: &[(u32, u32)]) -> bool {
        let Some(known) = &mut self.is_slave else { return false };
        let roles = slaves(&self.near, sightings, carrying);
        let changed = roles != *known;
        *known = roles;
        changed
    }
}

/// The faces around each vertex, by the vertices of all faces.
pub(super) fn around(faces: &[Vec<u32>]) -> BTreeMap<u32, Vec<u32>> {
    let mut out: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for (face, list) in faces.iter().enumerate() {
        list.iter().for_each(|v| out.entry(*v).or_default().push(face as u32));
    }
    out
}

/// The vertices of every face.
pub(super) fn vertices(surface: &dyn Surface) -> Vec<Vec<u32>> {
    fn of<const D: usize>(faces: &dyn ContactSurface<D>) -> Vec<Vec<u32>> {
        (0..faces.face_count()).map(|face| faces.vertices(face)).collect()
    }
    match surface.faces().0 {
        Faces::Plane(faces) => of(faces),
        Faces::Space(faces) => of(faces),
    }
}
