//! The cells as leaves of a tree: their places, what is beside them, and the balance between neighbours.

use crate::grid::Grid;
use signorini_geometry::{Aabb, Point};
use std::collections::BTreeMap;

/// A cell: how often it was divided, and its place among cells of its size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub(super) struct Leaf {
    pub(super) level: u8,
    pub(super) index: [u32; 2],
}

impl Leaf {
    pub(super) fn parent(self) -> Option<Self> {
        let level = self.level.checked_sub(1)?;
        Some(Self { level, index: self.index.map(|i| i / 2) })
    }
    pub(super) fn children(self) -> [Self; 4] {
        [[0, 0], [1, 0], [0, 1], [1, 1]]
            .map(|o| Self { level: self.level + 1, index: [2 * self.index[0] + o[0], 2 * self.index[1] + o[1]] })
    }
}

pub(super) fn box_of(coarse: &Grid<2>, leaf: Leaf) -> Aabb<2> {
    let n = coarse.cells().map(|n| (n << leaf.level) as f64);
    let at = |o: u32| {
        coarse.bounds().at(&Point::<2>::new(f64::from(leaf.index[0] + o) / n[0], f64::from(leaf.index[1] + o) / n[1]))
    };
    Aabb::new(at(0), at(1))
}

/// The place of the same size across a side; none beyond the box.
pub(super) fn beside(coarse: &Grid<2>, leaf: Leaf, side: usize) -> Option<Leaf> {
    let (k, upper) = (side / 2, side % 2 == 1);
    let mut index = leaf.index;
    index[k] = if upper { index[k] + 1 } else { index[k].checked_sub(1)? };
    let n = (coarse.cells()[k] << leaf.level) as u32;
    (index[k] < n).then_some(Leaf { level: leaf.level, index })
}

/// Divides cells until neighbours differ by at most one division.
pub(super) fn balance(coarse: &Grid<2>, leaves: &mut BTreeMap<Leaf, ()>) {
    let mut open: Vec<Leaf> = leaves.keys().copied().collect();
    while let Some(leaf) = open.pop() {
        if !leaves.contains_key(&leaf) {
            continue;
        }
        for side in 0..4 {
            let Some(mut larger) = beside(coarse, leaf, side) else { continue };
            while let Some(parent) = larger.parent() {
                if leaves.contains_key(&parent) && parent.level + 1 < leaf.level {
                    leaves.remove(&parent);
                    for child in parent.children() {
                        leaves.insert(child, ());
                        open.push(child);
                    }
                    // Its part beside this leaf may still be too large.
                    open.push(leaf);
                    break;
                }
                larger = parent;
            }
        }
    }
}
