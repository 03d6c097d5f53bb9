//! Which faces of a surface that touches itself are slave, and which master.
//!
//! Of two faces that see each other one is slave and the other master; with both as slaves the conditions would be stated twice.
//! A pair of faces that lie opposite each other gets two roles, the nearest pair first; faces that hang together get the same role
//! as far as that is possible. So each role covers a connected part, and the slave is the part with more faces. Faces that carry
//! keep their roles.

use std::collections::BTreeMap;

/// A slave face that sees a master face at a distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sighting {
    pub slave: u32,
    pub master: u32,
    pub distance: f64,
}

/// Whether each face is slave, by the faces that hang together with each, by what sees what, and by the pairs of slave and master
/// that carry.
pub fn slaves(near: &[Vec<u32>], mut sightings: Vec<Sighting>, carrying: &[(u32, u32)]) -> Vec<bool> {
    let mut sides = Sides::new(near.len());
    for (slave, master) in carrying {
        sides.join(sides.anchor(), *slave as usize, false);
        sides.join(sides.anchor(), *master as usize, true);
    }
    sightings.sort_by(|a, b| a.distance.total_cmp(&b.distance).then((a.slave, a.master).cmp(&(b.slave, b.master))));
    for Sighting { slave, master, .. } in sightings {
        sides.join(slave as usize, master as usize, true);
    }
    for (face, near) in near.iter().enumerate() {
        near.iter().for_each(|other| sides.join(face, *other as usize, false));
    }
    sides.slaves()
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

    #[test]
    fn both_sides_of_a_fold_get_one_role_each() {
        // Ten faces in a row, the first and the last of which lie opposite each other, and so on; two are in the fold.
        let near: Vec<Vec<u32>> = (0..10u32).map(|f| (f.saturating_sub(1)..=(f + 1).min(9)).collect()).collect();
        let sees = (0..4u32).flat_map(|k| [(k, 9 - k), (9 - k, k)]);
        let sightings: Vec<Sighting> = sees
            .map(|(slave, master)| Sighting { slave, master, distance: 1.0 - 0.1 * f64::from(slave.min(master)) })
            .collect();
        // Those in the fold go with one side, which has more faces then.
        assert_eq!(slaves(&near, sightings.clone(), &[]), (0..10).map(|k| k < 6).collect::<Vec<_>>());
        // What carries decides.
        for (slave, master) in [(2, 7), (7, 2)] {
            let roles = slaves(&near, sightings.clone(), &[(slave, master)]);
            assert!((0..4).all(|k| roles[k] == (slave == 2) && roles[9 - k] == (slave == 7)), "{roles:?}");
        }
    }
}
