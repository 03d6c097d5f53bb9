//! The two shapes of a search: their trees, and pairs of their cells.

use std::cmp::Ordering;
use std::collections::HashMap;

use crate::patch::{Atlas, Cell, Chart};

/// One shape in a search: its tree and the cells added below it.
pub struct Partner<'a, const M: usize, C> {
    pub atlas: &'a Atlas<M, C>,
    extra: Vec<Cell<M>>,
    /// Children of the leaves of the tree.
    grown: HashMap<u32, [u32; 2]>,
}

impl<'a, const M: usize, C: Chart<M>> Partner<'a, M, C> {
    pub fn new(atlas: &'a Atlas<M, C>) -> Self {
        Partner { atlas, extra: Vec::new(), grown: HashMap::new() }
    }

    #[inline]
    pub fn cell(&self, id: u32) -> &Cell<M> {
        match id.checked_sub(self.atlas.count()) {
            None => self.atlas.node(id),
            Some(extra) => &self.extra[extra as usize],
        }
    }

    fn add(&mut self, cell: Cell<M>) -> u32 {
        self.extra.push(cell);
        self.atlas.count() + self.extra.len() as u32 - 1
    }

    pub fn children(&mut self, id: u32) -> [u32; 2] {
        let cell = self.cell(id);
        if cell.children != [0; 2] {
            return cell.children;
        }
        if let Some(&children) = self.grown.get(&id) {
            return children;
        }
        let halves = self.atlas.halve(cell);
        let children = halves.map(|half| self.add(half));
        match id.checked_sub(self.atlas.count()) {
            None => _ = self.grown.insert(id, children),
            Some(extra) => self.extra[extra as usize].children = children,
        }
        children
    }

    pub fn face(&mut self, id: u32, axis: usize, high: bool) -> u32 {
        let face = self.atlas.face(self.cell(id), axis, high);
        self.add(face)
    }
}

#[derive(Clone, Copy)]
pub struct Pair {
    pub bound: f64,
    pub a: u32,
    pub b: u32,
}

impl PartialEq for Pair {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Pair {}
impl PartialOrd for Pair {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Pair {
    /// The lowest bound is the greatest, as a heap wants it; the numbers of the cells decide ties.
    fn cmp(&self, other: &Self) -> Ordering {
        other.bound.total_cmp(&self.bound).then(other.a.cmp(&self.a)).then(other.b.cmp(&self.b))
    }
}

/// The sides of a pair of cells behind which the shapes do not simply go on.
pub fn held<const A: usize, const B: usize, const N: usize, CA: Chart<A>, CB: Chart<B>>(
    a: &Partner<'_, A, CA>,
    b: &Partner<'_, B, CB>,
    pair: Pair,
) -> [[bool; 2]; N] {
    fn sides<const M: usize, C: Chart<M>>(partner: &Partner<'_, M, C>, id: u32, k: usize) -> [bool; 2] {
        let cell = partner.cell(id);
        let sides = &partner.atlas.pieces[cell.piece as usize].sides[k];
        let [low, high] = cell.range(k);
        [low == -1.0 && !sides[0].is_smooth(), high == 1.0 && !sides[1].is_smooth()]
    }
    std::array::from_fn(|k| if k < A { sides(a, pair.a, k) } else { sides(b, pair.b, k - A) })
}
