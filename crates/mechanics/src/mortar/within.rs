//! Contact of a surface with its own body: which faces may touch each other, and which of them is slave.
//!
//! Of two faces of one surface that see each other, one is slave and the other master; with both as slaves the conditions would
//! be stated twice. A pair of faces that lie opposite each other gets two roles, the nearest pair first; faces that hang
//! together get the same role as far as that is possible. So each role covers a connected part, and the slave is the part with
//! more faces. Faces that carry keep their roles, and with them their history.

use crate::surface::{Faces, Surface};
use signorini_contact::ContactSurface;
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

/// A slave face that sees a master face at a distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Sighting {
    pub slave: u32,
    pub master: u32,
    pub distance: f64,
}

/// Share of the depth of a cell that its face may penetrate.
const DEEPEST: f64 = 0.5;

impl Within {
    /// Of two groups of faces of one body; `is_one` if they are the same.
    pub fn new(slave: &dyn Surface, master: &dyn Surface, is_one: bool) -> Self {
        let [own, other] = [slave, master].map(vertices);
        let mut around: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (face, list) in other.iter().enumerate() {
            list.iter().for_each(|v| around.entry(*v).or_default().push(face as u32));
        }
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
    pub fn assign(&mut self, mut sightings: Vec<Sighting>, carrying: &[(u32, u32)]) -> bool {
        let Some(known) = &self.is_slave else { return false };
        let mut sides = Sides::new(known.len());
        for (slave, master) in carrying {
            sides.join(sides.anchor(), *slave as usize, false);
            sides.join(sides.anchor(), *master as usize, true);
        }
        sightings.sort_by(|a, b| a.distance.total_cmp(&b.distance).then((a.slave, a.master).cmp(&(b.slave, b.master))));
        for Sighting { slave, master, .. } in sightings {
            sides.join(slave as usize, master as usize, true);
        }
        for (face, near) in self.near.iter().enumerate() {
            near.iter().for_each(|other| sides.join(face, *other as usize, false));
        }
        let roles = sides.slaves();
        let changed = roles != *known;
        self.is_slave = Some(roles);
        changed
    }
}

fn vertices(surface: &dyn Surface) -> Vec<Vec<u32>> {
    fn of<const D: usize>(faces: &dyn ContactSurface<D>) -> Vec<Vec<u32>> {
        (0..faces.face_count()).map(|face| faces.vertices(face)).collect()
    }
    match surface.faces().0 {
        Faces::Plane(faces) => of(faces),
        Faces::Space(faces) => of(faces),
    }
}

/// Sets of faces, each with two sides: a disjoint-set forest with the side of each face relative to its parent.
struct Sides {
    /// The last entry stands for the slave side of what carries.
    parent: Vec<usize>,
    is_opposite: Vec<bool>,
    /// Members of the set of each representative.
    size: Vec<usize>,
}

impl Sides {
    fn new(faces: usize) -> Self {
        Sides { parent: (0..=faces).collect(), is_opposite: vec![false; faces + 1], size: vec![1; faces + 1] }
    }

    fn anchor(&self) -> usize {
        self.parent.len() - 1
    }

    /// The representative of the set of a face, and whether the face is on the other side than that.
    fn root(&self, mut face: usize) -> (usize, bool) {
        let mut opposite = false;
        while self.parent[face] != face {
            opposite ^= self.is_opposite[face];
            face = self.parent[face];
        }
        (face, opposite)
    }

    /// Puts two faces on the same side or on opposite sides, unless that is decided already.
    fn join(&mut self, a: usize, b: usize, opposite: bool) {
        let ((root_a, of_a), (root_b, of_b)) = (self.root(a), self.root(b));
        if root_a != root_b {
            let (small, large) =
                if self.size[root_a] < self.size[root_b] { (root_a, root_b) } else { (root_b, root_a) };
            self.parent[small] = large;
            self.is_opposite[small] = of_a ^ of_b ^ opposite;
            self.size[large] += self.size[small];
        }
    }

    /// Of each face whether it is slave: the side of the anchor, otherwise the larger one, with the first face where both are
    /// equal.
    fn slaves(&self) -> Vec<bool> {
        let roots: Vec<(usize, bool)> = (0..self.anchor()).map(|face| self.root(face)).collect();
        let mut counts: BTreeMap<usize, ([usize; 2], bool)> = BTreeMap::new();
        for (root, opposite) in &roots {
            counts.entry(*root).or_insert(([0; 2], *opposite)).0[usize::from(*opposite)] += 1;
        }
        let (anchor, of_anchor) = self.root(self.anchor());
        let slave_side = |root: usize| match counts[&root] {
            _ if root == anchor => of_anchor,
            ([same, opposite], first) if same == opposite => first,
            ([same, opposite], _) => opposite > same,
        };
        roots.iter().map(|(root, opposite)| *opposite == slave_side(*root)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Ten faces in a row, the first and the last of which lie opposite each other, and so on: a fold.
    fn fold() -> (Within, Vec<Sighting>) {
        let near = (0..10u32).map(|f| (f.saturating_sub(1)..=(f + 1).min(9)).collect()).collect();
        let sees = (0..4u32).flat_map(|k| [(k, 9 - k), (9 - k, k)]);
        let sightings = sees.map(|(slave, master)| Sighting { slave, master, distance: 1.0 - 0.1 * f64::from(slave) });
        (Within { near, deepest: vec![1.0; 10], is_slave: Some(vec![true; 10]) }, sightings.collect())
    }

    #[test]
    fn both_sides_of_a_fold_get_one_role_each() {
        let (mut within, sightings) = fold();
        assert!(within.assign(sightings.clone(), &[]));
        let slave: Vec<bool> = (0..10).map(|k| k < 5).collect();
        assert!(within.is_slave == Some(slave.clone()) || within.is_slave == Some(slave.iter().map(|s| !s).collect()));
        assert!(!within.assign(sightings.clone(), &[]));
        // What carries decides.
        for (slave, master) in [(2, 7), (7, 2)] {
            within.assign(sightings.clone(), &[(slave, master)]);
            let roles = within.is_slave.clone().unwrap();
            assert!((0..4).all(|k| roles[k] == (slave == 2) && roles[9 - k] == (slave == 7)), "{roles:?}");
        }
        assert!(within.sees(9, 0) && !within.sees(0, 9) && !within.may_meet(3, 4));
    }
}
