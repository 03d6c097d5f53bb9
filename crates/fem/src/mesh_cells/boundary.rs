//! The pieces of a mesh's boundary.

use crate::adjacency::Adjacency;
use crate::boundary_side::BoundarySide;
use crate::mesh::{Mesh, Side};
use std::collections::{BTreeMap, BTreeSet};

pub(super) type Boundary = (Vec<(String, Vec<usize>)>, Vec<BoundarySide>, usize);

/// The sides on the boundary, cell by cell. Those that belong to the same groups are one piece; pieces are numbered by the
/// names of their groups, so that those of a divided mesh have the same numbers.
pub(super) fn boundary(mesh: &Mesh<2>, adjacency: &Adjacency) -> Boundary {
    let mut names: BTreeMap<Side, BTreeSet<&str>> = BTreeMap::new();
    for (name, group) in mesh.groups() {
        for side in group.sides.iter().filter(|side| adjacency.across(**side).is_none()) {
            names.entry(*side).or_default().insert(name);
        }
    }
    let free: Vec<Side> = mesh.all_sides().filter(|side| adjacency.across(*side).is_none()).collect();
    let none = BTreeSet::new();
    let of = |side: &Side| names.get(side).unwrap_or(&none);
    let pieces: BTreeSet<&BTreeSet<&str>> = free.iter().map(of).collect();
    let pieces: Vec<&BTreeSet<&str>> = pieces.into_iter().collect();
    let mut groups: BTreeMap<String, Vec<usize>> = BTreeMap::new();
    for (piece, names) in pieces.iter().enumerate() {
        names.iter().for_each(|name| groups.entry(name.to_string()).or_default().push(piece));
    }
    groups.entry("boundary".into()).or_insert_with(|| (0..pieces.len()).collect());
    let side = |side: &Side| {
        let piece = pieces.binary_search(&of(side)).unwrap_or(0);
        BoundarySide { cell: side.cell as usize, side: side.side as usize, piece }
    };
    (groups.into_iter().collect(), free.iter().map(side).collect(), pieces.len())
}
