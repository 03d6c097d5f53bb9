//! Grids with cells that are divided again and again where it matters, and continuous functions on them.
//!
//! Nodes on a side that a larger cell shares hang: there the functions of the smaller cells follow those of the larger
//! one. A function is one of a node that does not hang; a cell sees all functions that its own nodes follow.

use crate::cells::{BoundarySide, Cells, Divided, Neighbours, SidePoint, divided_box, on_box_side};
use crate::cut::{CellPartition, CellRule, QuadraturePoint, cut_cell};
use crate::grid::Grid;
use crate::lagrange::{MAX_DEGREE, Tabulation};
use signorini_geometry::outline::outlines_between;
use signorini_geometry::{Aabb, Point, Vector};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::sync::Arc;

/// Most divisions of a cell of the coarse grid.
pub const MOST_LEVELS: usize = 12;

/// Cells of unlike size are compared over the nearer part of the larger one only, which holds its polynomial less firmly:
/// this makes up for it. Between 4 and 16 slivers of all kinds stay positive definite up to degree 6.
const NEARER: f64 = 8.0;

/// A cell: how often it was divided, and its place among cells of its size.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
struct Leaf {
    level: u8,
    index: [u32; 2],
}

impl Leaf {
    fn parent(self) -> Option<Self> {
        let level = self.level.checked_sub(1)?;
        Some(Self { level, index: self.index.map(|i| i / 2) })
    }
    fn children(self) -> [Self; 4] {
        [[0, 0], [1, 0], [0, 1], [1, 1]]
            .map(|o| Self { level: self.level + 1, index: [2 * self.index[0] + o[0], 2 * self.index[1] + o[1]] })
    }
}

/// A node, by what it lies on: Gauss-Lobatto points of cells of unlike size share no lattice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
enum Node {
    /// In units of the smallest cells that may be.
    Vertex([u64; 2]),
    /// Direction, level, place of the lower end in cells of that level, and number along the side.
    Edge(u8, u8, [u32; 2], u8),
    /// Level, place and number within the cell.
    Interior(u8, [u32; 2], u16),
}

/// A grid whose cells are divided where it matters; neighbours differ by at most one division.
#[derive(Clone, Debug)]
pub struct RefinedGrid {
    coarse: Grid<2>,
    leaves: Vec<Leaf>,
    number: HashMap<Leaf, u32>,
    levels: usize,
    /// Where the node of each function lies.
    nodes: Vec<Point<2>>,
    cells: Vec<Functions>,
    /// A cell of each kind: those of one level whose nodes do not hang.
    kinds: Vec<usize>,
    neighbours: Vec<Neighbours>,
}

/// The functions of a cell, and how its own nodes follow them.
#[derive(Clone, Debug)]
struct Functions {
    kind: Option<usize>,
    functions: Vec<u32>,
    /// For each node of the cell, pairs of place in `functions` and value; empty where they are the same.
    hanging: Vec<Vec<(u32, f64)>>,
}

impl RefinedGrid {
    /// Divides the cells of a grid as long as `wanted`, called with the box of a cell and how often it was divided, says so.
    pub fn new(coarse: &Grid<2>, wanted: impl Fn(&Aabb<2>, usize) -> bool) -> Self {
        let mut open: Vec<Leaf> = (0..coarse.cell_count())
            .map(|cell| Leaf { level: 0, index: coarse.cell_index(cell).map(|i| i as u32) })
            .collect();
        let mut leaves = BTreeMap::new();
        while let Some(leaf) = open.pop() {
            if usize::from(leaf.level) < MOST_LEVELS && wanted(&box_of(coarse, leaf), leaf.level.into()) {
                open.extend(leaf.children());
            } else {
                leaves.insert(leaf, ());
            }
        }
        balance(coarse, &mut leaves);
        Self::from_leaves(coarse.clone(), leaves.into_keys().collect())
    }

    fn from_leaves(coarse: Grid<2>, leaves: Vec<Leaf>) -> Self {
        let number: HashMap<Leaf, u32> = leaves.iter().enumerate().map(|(i, l)| (*l, i as u32)).collect();
        let levels = leaves.iter().map(|l| usize::from(l.level)).max().unwrap_or(0);
        let mut grid =
            Self { coarse, leaves, number, levels, nodes: vec![], cells: vec![], kinds: vec![], neighbours: vec![] };
        grid.number_functions();
        grid.find_neighbours();
        grid
    }

    fn leaf_containing(&self, x: &Point<2>) -> usize {
        let bounds = self.coarse.bounds();
        let cells = self.coarse.cells();
        for level in 0..=self.levels {
            let index = [0, 1].map(|k| {
                let n = cells[k] << level;
                let t = (x[k] - bounds.min[k]) / bounds.size()[k] * n as f64;
                (t.max(0.0) as usize).min(n - 1) as u32
            });
            if let Some(&leaf) = self.number.get(&Leaf { level: level as u8, index }) {
                return leaf as usize;
            }
        }
        // Leaves cover the box.
        0
    }

    /// The larger leaf across a side of a leaf, where there is one.
    fn larger(&self, leaf: Leaf, side: usize) -> Option<Leaf> {
        let beside = beside(&self.coarse, leaf, side)?;
        let parent = beside.parent()?;
        self.number.contains_key(&parent).then_some(parent)
    }

    fn vertex(&self, leaf: Leaf, corner: [u32; 2]) -> Node {
        let shift = MOST_LEVELS - usize::from(leaf.level);
        Node::Vertex([0, 1].map(|k| u64::from(leaf.index[k] + corner[k]) << shift))
    }

    /// The corners of a leaf and of smaller ones beside it, counter-clockwise, in units of the smallest leaves.
    fn corners(&self, leaf: Leaf) -> Vec<[u32; 2]> {
        let unit = 1 << (self.levels - usize::from(leaf.level));
        let smaller = |side: usize| {
            beside(&self.coarse, leaf, side).is_some_and(|b| !self.number.contains_key(&b))
                && self.larger(leaf, side).is_none()
        };
        let at = |o: [u32; 2]| [0, 1].map(|k| leaf.index[k] * unit + o[k] * unit / 2);
        let mut corners = Vec::with_capacity(8);
        for (corner, middle, side) in
            [([0, 0], [1, 0], 2), ([2, 0], [2, 1], 1), ([2, 2], [1, 2], 3), ([0, 2], [0, 1], 0)]
        {
            corners.push(at(corner));
            if smaller(side) {
                corners.push(at(middle));
            }
        }
        corners
    }

    /// The nodes along a side of a leaf: `p + 1` in the positive direction.
    fn side_nodes(&self, leaf: Leaf, side: usize) -> Vec<Node> {
        let (normal, upper) = (side / 2, (side % 2) as u32);
        let along = 1 - normal;
        let mut low = [0; 2];
        low[normal] = upper;
        let mut high = low;
        high[along] = 1;
        let mut from = leaf.index;
        from[normal] += upper;
        let p = self.coarse.degree();
        let inner = (1..p).map(|i| Node::Edge(along as u8, leaf.level, from, i as u8));
        [self.vertex(leaf, low)].into_iter().chain(inner).chain([self.vertex(leaf, high)]).collect()
    }

    /// The nodes of a leaf, in the order of the basis.
    fn nodes(&self, leaf: Leaf) -> Vec<Node> {
        let p = self.coarse.degree();
        let sides: [Vec<Node>; 4] = [0, 1, 2, 3].map(|side| self.side_nodes(leaf, side));
        (0..(p + 1) * (p + 1))
            .map(|k| {
                let (i, j) = (k % (p + 1), k / (p + 1));
                match (i, j) {
                    (0, _) => sides[0][j],
                    (i, _) if i == p => sides[1][j],
                    (_, 0) => sides[2][i],
                    (_, j) if j == p => sides[3][i],
                    _ => Node::Interior(leaf.level, leaf.index, k as u16),
                }
            })
            .collect()
    }

    /// Numbers the nodes that do not hang, and lets the others follow them.
    fn number_functions(&mut self) {
        // What each hanging node follows: the nodes of the larger side that it lies on.
        let mut follows: HashMap<Node, Vec<(Node, f64)>> = HashMap::new();
        let basis = self.coarse.basis();
        let places = basis.line_nodes();
        for &leaf in &self.leaves {
            for side in 0..4 {
                let Some(large) = self.larger(leaf, side) else { continue };
                let masters = self.side_nodes(large, side ^ 1);
                let along = 1 - side / 2;
                let half = f64::from(leaf.index[along] % 2);
                for (node, place) in self.side_nodes(leaf, side).into_iter().zip(places) {
                    let t = 0.5 * (half + place);
                    if let Some(same) = masters.iter().position(|m| *m == node) {
                        debug_assert!((places[same] - t).abs() < 1e-12);
                        continue;
                    }
                    let values = basis.line(t)[0];
                    let list = masters.iter().zip(values).filter(|(_, v)| *v != 0.0).map(|(m, v)| (*m, v)).collect();
                    follows.insert(node, list);
                }
            }
        }
        let mut numbers: HashMap<Node, u32> = HashMap::new();
        let mut placed = Vec::new();
        let mut kinds: Vec<Option<usize>> = vec![None; self.levels + 1];
        let mut representatives = Vec::new();
        let mut cells = Vec::with_capacity(self.leaves.len());
        for (cell, &leaf) in self.leaves.iter().enumerate() {
            let nodes = self.nodes(leaf);
            let mut functions = Vec::new();
            let mut own: Vec<Vec<(u32, f64)>> = Vec::new();
            let bounds = box_of(&self.coarse, leaf);
            for (k, node) in nodes.iter().enumerate() {
                let mut list: Vec<(u32, f64)> = Vec::new();
                // A node of a larger side may hang on a side that is larger still.
                let mut open = vec![(*node, 1.0)];
                while let Some((node, weight)) = open.pop() {
                    if let Some(masters) = follows.get(&node) {
                        open.extend(masters.iter().map(|(m, v)| (*m, v * weight)));
                        continue;
                    }
                    let function = *numbers.entry(node).or_insert_with(|| {
                        placed.push(Point::<2>::zeros());
                        placed.len() as u32 - 1
                    });
                    let at = functions.iter().position(|f| *f == function).unwrap_or_else(|| {
                        functions.push(function);
                        functions.len() - 1
                    }) as u32;
                    match list.iter_mut().find(|(a, _)| *a == at) {
                        Some((_, v)) => *v += weight,
                        None => list.push((at, weight)),
                    }
                }
                if !follows.contains_key(node) {
                    let at = [k % places.len(), k / places.len()].map(|i| places[i]);
                    placed[functions[list[0].0 as usize] as usize] = bounds.at(&Point::<2>::from(at));
                }
                own.push(list);
            }
            let hangs = nodes.iter().any(|n| follows.contains_key(n));
            let kind = (!hangs).then(|| {
                *kinds[usize::from(leaf.level)].get_or_insert_with(|| {
                    representatives.push(cell);
                    representatives.len() - 1
                })
            });
            cells.push(Functions { kind, functions, hanging: if hangs { own } else { Vec::new() } });
        }
        self.nodes = placed;
        self.cells = cells;
        self.kinds = representatives;
    }

    fn find_neighbours(&mut self) {
        let size = self.coarse.cell_size();
        let mut pairs = Vec::new();
        for (cell, &leaf) in self.leaves.iter().enumerate() {
            for side in 0..4 {
                let k = side / 2;
                let width = size[k] / f64::from(1u32 << leaf.level);
                if let Some(large) = self.larger(leaf, side) {
                    pairs.push(Neighbours { cells: [cell, self.number[&large] as usize], width, kind: None });
                } else if side % 2 == 1
                    && let Some(&other) = beside(&self.coarse, leaf, side).and_then(|b| self.number.get(&b))
                {
                    let both = self.cells[cell].kind.is_some() && self.cells[other as usize].kind.is_some();
                    // The penalty of cells of one shape does not depend on their size in the plane.
                    let kind = both.then_some(k);
                    pairs.push(Neighbours { cells: [cell, other as usize], width, kind });
                }
            }
        }
        self.neighbours = pairs;
    }
}

fn box_of(coarse: &Grid<2>, leaf: Leaf) -> Aabb<2> {
    let n = coarse.cells().map(|n| (n << leaf.level) as f64);
    let at = |o: u32| {
        coarse.bounds().at(&Point::<2>::new(f64::from(leaf.index[0] + o) / n[0], f64::from(leaf.index[1] + o) / n[1]))
    };
    Aabb::new(at(0), at(1))
}

/// The place of the same size across a side; none beyond the box.
fn beside(coarse: &Grid<2>, leaf: Leaf, side: usize) -> Option<Leaf> {
    let (k, upper) = (side / 2, side % 2 == 1);
    let mut index = leaf.index;
    index[k] = if upper { index[k] + 1 } else { index[k].checked_sub(1)? };
    let n = (coarse.cells()[k] << leaf.level) as u32;
    (index[k] < n).then_some(Leaf { level: leaf.level, index })
}

/// Divides cells until neighbours differ by at most one division.
fn balance(coarse: &Grid<2>, leaves: &mut BTreeMap<Leaf, ()>) {
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

impl Cells<2> for RefinedGrid {
    fn degree(&self) -> usize {
        self.coarse.degree()
    }
    fn count(&self) -> usize {
        self.leaves.len()
    }
    fn bounds_of(&self, cell: usize) -> Aabb<2> {
        box_of(&self.coarse, self.leaves[cell])
    }
    fn size(&self, cell: usize) -> f64 {
        self.coarse.h() / f64::from(1u32 << self.leaves[cell].level)
    }
    fn volume(&self, cell: usize) -> f64 {
        self.bounds_of(cell).volume()
    }
    fn containing(&self, x: &Point<2>) -> Option<usize> {
        Some(self.leaf_containing(x))
    }
    fn function_count(&self) -> usize {
        self.nodes.len()
    }
    fn functions(&self, cell: usize, out: &mut Vec<u32>) {
        out.clone_from(&self.cells[cell].functions);
    }
    fn tabulate(&self, cell: usize, x: &Point<2>, out: &mut Tabulation<2>) {
        let b = self.bounds_of(cell);
        let size = b.size();
        let local = (x - b.min).component_div(&size);
        let of = &self.cells[cell];
        if of.hanging.is_empty() {
            return self.coarse.basis().tabulate(&local, &size, out);
        }
        let mut own = Tabulation::default();
        self.coarse.basis().tabulate(&local, &size, &mut own);
        let n = of.functions.len();
        out.value.clear();
        out.value.resize(n, 0.0);
        out.gradient.clear();
        out.gradient.resize(n, Vector::zeros());
        for (k, list) in of.hanging.iter().enumerate() {
            for &(at, weight) in list {
                out.value[at as usize] += weight * own.value[k];
                out.gradient[at as usize] += weight * own.gradient[k];
            }
        }
    }
    fn node(&self, function: usize) -> Point<2> {
        self.nodes[function]
    }
    fn linear(&self, finer: usize) -> Arc<dyn Cells<2>> {
        let coarse = Grid::new(*self.coarse.bounds(), self.coarse.cells().map(|n| n * finer), 1);
        let parts = |leaf: &Leaf| {
            let (level, from) = (leaf.level, leaf.index.map(|i| i * finer as u32));
            let part = move |k: usize| [from[0] + (k % finer) as u32, from[1] + (k / finer) as u32];
            (0..finer * finer).map(move |k| Leaf { level, index: part(k) })
        };
        Arc::new(Self::from_leaves(coarse, self.leaves.iter().flat_map(parts).collect()))
    }
    fn as_grid(&self) -> Option<&Grid<2>> {
        Some(&self.coarse)
    }
    fn divisions(&self, cell: usize) -> usize {
        self.leaves[cell].level.into()
    }
    fn outlines(&self, value: &dyn Fn(&Point<2>) -> f64) -> Option<Vec<Vec<Point<2>>>> {
        let bounds = self.coarse.bounds();
        let ends = self.coarse.cells().map(|n| (n << self.levels) as f64);
        let place = |v: [u32; 2]| bounds.at(&Point::<2>::new(f64::from(v[0]) / ends[0], f64::from(v[1]) / ends[1]));
        let cells = self.leaves.iter().map(|&leaf| self.corners(leaf));
        outlines_between(cells, |corner| value(&place(corner)), place, 1e-12 * bounds.radius())
    }
    fn raised(&self) -> Option<Arc<dyn Cells<2>>> {
        let degree = self.coarse.degree() + 1;
        let coarse = || Grid::new(*self.coarse.bounds(), self.coarse.cells(), degree);
        (degree <= MAX_DEGREE)
            .then(|| -> Arc<dyn Cells<2>> { Arc::new(Self::from_leaves(coarse(), self.leaves.clone())) })
    }
    fn coarser(&self) -> Option<Arc<dyn Cells<2>>> {
        if self.levels == 0 {
            return self.coarse.coarser();
        }
        // Without the last divisions.
        let coarse = Grid::new(*self.coarse.bounds(), self.coarse.cells(), 1);
        let last = |leaf: &Leaf| usize::from(leaf.level) == self.levels;
        let kept: BTreeSet<Leaf> =
            self.leaves.iter().map(|leaf| leaf.parent().filter(|_| last(leaf)).unwrap_or(*leaf)).collect();
        Some(Arc::new(Self::from_leaves(coarse, kept.into_iter().collect())))
    }
    fn rule(&self, cell: usize) -> Vec<QuadraturePoint<2>> {
        self.coarse.rule_in(&self.bounds_of(cell))
    }
    fn cut(&self, cell: usize, partition: &CellPartition<'_, 2>, order: usize) -> CellRule<2> {
        cut_cell(partition, &self.bounds_of(cell), order)
    }
    fn kind(&self, cell: usize) -> Option<usize> {
        self.cells[cell].kind
    }
    fn kinds(&self) -> Vec<usize> {
        self.kinds.clone()
    }
    fn neighbours(&self) -> Vec<Neighbours> {
        self.neighbours.clone()
    }
    fn compared_over(&self, pair: &Neighbours) -> Vec<(usize, QuadraturePoint<2>)> {
        // The smaller cell is the first. Beyond its own width its polynomial would be carried too far.
        let [small, other] = pair.cells.map(|cell| self.bounds_of(cell));
        let mut beside = other;
        for k in 0..2 {
            if small.max[k] <= other.min[k] + 1e-9 * small.size()[k] {
                beside.max[k] = other.min[k] + small.size()[k];
            } else if small.min[k] >= other.max[k] - 1e-9 * small.size()[k] {
                beside.min[k] = other.max[k] - small.size()[k];
            } else {
                (beside.min[k], beside.max[k]) = (small.min[k], small.max[k]);
            }
        }
        let [level, of_other] = pair.cells.map(|cell| self.leaves[cell].level);
        let weight = if level == of_other { 1.0 } else { NEARER };
        let rule = |b: &Aabb<2>, of: usize| {
            self.coarse.rule_in(b).into_iter().map(move |p| (of, QuadraturePoint { weight: weight * p.weight, ..p }))
        };
        rule(&small, 0).chain(rule(&beside, 1)).collect()
    }
    fn boundary_sides(&self) -> Vec<BoundarySide> {
        (self.leaves.iter().enumerate())
            .flat_map(|(cell, &leaf)| {
                let outer = (0..4).filter(move |&side| beside(&self.coarse, leaf, side).is_none());
                outer.map(move |side| BoundarySide { cell, side, piece: side })
            })
            .collect()
    }
    fn on_side(&self, side: &BoundarySide, t: f64) -> SidePoint<2> {
        on_box_side(&self.bounds_of(side.cell), side.side, t)
    }
    fn divided(&self, cell: usize, n: usize) -> Divided<2> {
        divided_box(&self.bounds_of(cell), n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ghost::ghost_penalty;
    use signorini_geometry::polygon;

    fn grid(degree: usize) -> RefinedGrid {
        let bounds = Aabb::new(Point::<2>::new(0.0, -1.0), Point::<2>::new(2.0, 1.0));
        let coarse = Grid::<2>::new(bounds, [4, 3], degree);
        // Towards one point off any line of the grid, and along a slanted line.
        let middle = Point::<2>::new(0.83, 0.11);
        RefinedGrid::new(&coarse, |b, level| {
            let on_line = (b.center()[0] + 0.5 * b.center()[1] - 1.6).abs() < 0.6 * b.radius();
            (b.contains(&middle) && level < 5) || (on_line && level < 2)
        })
    }

    #[test]
    fn leaves_cover_the_box_and_neighbours_differ_by_one_division() {
        let grid = grid(1);
        assert!(grid.levels == 5);
        let area: f64 = (0..grid.count()).map(|c| grid.volume(c)).sum();
        assert!((area - 4.0).abs() < 1e-13);
        for pair in grid.neighbours() {
            let [a, b] = pair.cells.map(|c| i32::from(grid.leaves[c].level));
            assert!((a - b).abs() <= 1);
        }
        for cell in 0..grid.count() {
            assert_eq!(grid.containing(&grid.bounds_of(cell).center()), Some(cell));
        }
        // Every length of inner side is shared by one pair; and the rest is the boundary.
        let outer: f64 = grid.boundary_sides().iter().map(|s| grid.on_side(s, 0.5).tangent.norm()).sum();
        assert!((outer - 8.0).abs() < 1e-12);
    }

    #[test]
    fn functions_are_one_at_their_own_nodes() {
        for degree in [1, 3] {
            let grid = grid(degree);
            let (mut t, mut functions) = (Tabulation::default(), Vec::new());
            for function in 0..grid.function_count() {
                let x = grid.node(function);
                let cell = grid.leaf_containing(&x);
                grid.functions(cell, &mut functions);
                grid.tabulate(cell, &x, &mut t);
                assert!(functions.contains(&(function as u32)));
                for (&f, v) in functions.iter().zip(&t.value) {
                    let own = f64::from(u8::from(f as usize == function));
                    assert!((v - own).abs() < 1e-9, "degree {degree}, function {function} at {x}: {f} is {v}");
                }
            }
        }
    }

    #[test]
    fn coarser_cells_lack_the_last_divisions() {
        let mut cells: Arc<dyn Cells<2>> = Arc::new(grid(3));
        let smallest = |cells: &dyn Cells<2>| (0..cells.count()).map(|c| cells.size(c)).fold(f64::INFINITY, f64::min);
        for _ in 0..5 {
            let coarser = cells.coarser().expect("divisions");
            assert!((smallest(&*coarser) - 2.0 * smallest(&*cells)).abs() < 1e-14);
            let area: f64 = (0..coarser.count()).map(|c| coarser.volume(c)).sum();
            assert!((area - 4.0).abs() < 1e-13);
            assert_eq!(coarser.degree(), 1);
            cells = coarser;
        }
        // Three cells have no half.
        assert!(cells.coarser().is_none());
    }

    #[test]
    fn outlines_close_across_cells_of_unlike_size() {
        let circle = |x: &Point<2>| (x - Point::<2>::new(1.0, 0.1)).norm() - 0.7;
        let loops = grid(2).linear(8).outlines(&circle).expect("closed outlines");
        assert_eq!(loops.len(), 1);
        let area = polygon::signed_area(&loops[0]) / (std::f64::consts::PI * 0.49);
        assert!((area - 1.0).abs() < 5e-3, "{area}");
        assert!(
            grid(1).outlines(&|x| x[0] - 1.0).is_none(),
            "a set that reaches beyond the cells has no closed outline"
        );
    }

    #[test]
    fn functions_are_continuous_and_reproduce_polynomials() {
        for degree in [1, 2, 3, 5] {
            let grid = grid(degree);
            let mut numbers = Vec::new();
            let mut t = Tabulation::default();
            // Coefficients of a polynomial, read at the nodes of cells without hanging ones.
            let f = |x: &Point<2>| (x[0] - 0.3).powi(degree as i32) - x[1].powi(degree as i32 - 1) * x[0] + 1.0;
            let mut u = vec![f64::NAN; grid.function_count()];
            for cell in 0..grid.count() {
                let nodes = grid.nodes(grid.leaves[cell]);
                let b = grid.bounds_of(cell);
                let places = grid.coarse.basis().line_nodes().to_vec();
                grid.functions(cell, &mut numbers);
                for k in 0..nodes.len() {
                    let p = degree + 1;
                    let x = b.at(&Point::<2>::new(places[k % p], places[k / p]));
                    match grid.cells[cell].hanging.get(k) {
                        None => u[numbers[k] as usize] = f(&x),
                        Some(list) if list.len() == 1 => u[numbers[list[0].0 as usize] as usize] = f(&x),
                        _ => {}
                    }
                }
            }
            assert!(u.iter().all(|v| v.is_finite()), "degree {degree}: a function without a node");
            let mut value = |cell: usize, x: &Point<2>, u: &[f64]| -> f64 {
                grid.functions(cell, &mut numbers);
                grid.tabulate(cell, x, &mut t);
                numbers.iter().zip(&t.value).map(|(&n, v)| u[n as usize] * v).sum()
            };
            for cell in 0..grid.count() {
                let x = grid.bounds_of(cell).at(&Point::<2>::new(0.3, 0.8));
                assert!((value(cell, &x, &u) - f(&x)).abs() < 1e-11, "degree {degree}");
            }
            // Any coefficients make a continuous function.
            let wild: Vec<f64> = (0..u.len()).map(|i| (i as f64 * 1.7).sin()).collect();
            for pair in grid.neighbours() {
                let [a, b] = pair.cells.map(|c| grid.bounds_of(c));
                let shared = Aabb::new(a.min.sup(&b.min), a.max.inf(&b.max));
                for s in [0.0, 0.21, 0.77, 1.0] {
                    let x = shared.at(&Point::<2>::new(s, s));
                    let [p, q] = pair.cells.map(|c| value(c, &x, &wild));
                    assert!((p - q).abs() < 1e-12, "degree {degree} at {x:?}: {p} {q}");
                }
            }
        }
    }

    #[test]
    fn cells_of_one_size_are_compared_as_on_a_grid() {
        let bounds = Aabb::new(Point::<2>::new(0.0, -1.0), Point::<2>::new(2.0, 1.0));
        for degree in [1, 3] {
            let fine = Grid::<2>::new(bounds, [8, 6], degree);
            let refined = RefinedGrid::new(&Grid::<2>::new(bounds, [4, 3], degree), |_, level| level < 1);
            let on_grid = [0, 1].map(|k| {
                let pairs = fine.neighbours();
                let pair = pairs.iter().find(|p| p.kind == Some(k)).expect("a pair");
                ghost_penalty(&fine, pair)
            });
            for pair in refined.neighbours() {
                let expected = &on_grid[pair.kind.expect("cells of one kind")];
                let penalty = ghost_penalty(&refined, &pair);
                assert!(penalty.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "degree {degree}");
            }
        }
    }
}
