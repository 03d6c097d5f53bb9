//! Shapes as pieces, and the tree of cells over them.

use super::bounds::{Hull, around};
use super::{Cell, Chart, Piece};
use std::collections::VecDeque;
use std::sync::OnceLock;

/// A shape as pieces and the tree over them; node 0 is the root.
#[derive(Clone, Debug)]
pub struct Atlas<const M: usize, C> {
    pub pieces: Vec<Piece<M, C>>,
    /// Groups of pieces, and the cells of the pieces that have no [`Chart::early_hull`].
    nodes: Vec<Cell<M>>,
    later: Vec<Later<M>>,
    /// Size of the shape and its largest coordinate, to scale tolerances.
    pub size: f64,
    pub magnitude: f64,
}

/// The cells of a piece with an early hull below the whole, made when the first is asked for.
#[derive(Clone, Debug)]
struct Later<const M: usize> {
    piece: u32,
    cells: OnceLock<Vec<Cell<M>>>,
}

/// Cells of a piece that are kept with the shape; a search refines further where it must.
const CELLS_PER_PIECE: usize = 127;
/// Numbers set apart for the cells of a piece that come later.
const NUMBERS: u32 = (CELLS_PER_PIECE + 1) as u32;
/// Cells flatter than this share of their size are left to the search.
const FLATNESS: f64 = 0.06;

impl<const M: usize, C: Chart<M>> Atlas<M, C> {
    pub fn new(pieces: Vec<Piece<M, C>>) -> Self {
        let roots: Vec<Cell<M>> = pieces
            .iter()
            .enumerate()
            .map(|(n, p)| match p.chart.early_hull() {
                Some(hull) => Cell::group(hull),
                None => Cell::new(n as u32, p, [0.0; M], [1.0; M]),
            })
            .collect();
        let mut order: Vec<u32> = (0..pieces.len() as u32).collect();
        let mut places = vec![0u32; pieces.len()];
        let mut nodes: Vec<Cell<M>> = Vec::with_capacity(2 * pieces.len());
        gather(&mut order, &roots, &mut nodes, &mut places);
        let mut atlas = Atlas { pieces, nodes: Vec::new(), later: Vec::new(), size: 0.0, magnitude: 0.0 };
        for (&place, root) in places.iter().zip(&roots) {
            if !root.is_group() {
                atlas.refine(&mut nodes, VecDeque::from([place]), 0);
            }
        }
        for (piece, (&place, root)) in places.iter().zip(&roots).enumerate() {
            if root.is_group() {
                let first = nodes.len() as u32 + NUMBERS * atlas.later.len() as u32;
                nodes[place as usize].children = [first, first + 1];
                atlas.later.push(Later { piece: piece as u32, cells: OnceLock::new() });
            }
        }
        gather_hulls(&mut nodes, 0);
        let [low, high] = nodes[0].hull;
        Atlas { nodes, size: (high - low).norm(), magnitude: low.amax().max(high.amax()), ..atlas }
    }

    /// The box around the shape.
    pub fn hull(&self) -> &Hull {
        &self.nodes[0].hull
    }

    /// The cell with a number, which is less than [`Atlas::count`].
    #[inline]
    pub fn node(&self, number: u32) -> &Cell<M> {
        let Some(after) = number.checked_sub(self.nodes.len() as u32) else { return &self.nodes[number as usize] };
        let later = &self.later[(after / NUMBERS) as usize];
        let first = number - after % NUMBERS;
        &later.cells.get_or_init(|| self.below(later.piece, first))[(after % NUMBERS) as usize]
    }

    /// One more than the largest number of a cell.
    #[inline]
    pub fn count(&self) -> u32 {
        self.nodes.len() as u32 + NUMBERS * self.later.len() as u32
    }

    /// The cells below the whole of a piece; the first has this number.
    fn below(&self, piece: u32, first: u32) -> Vec<Cell<M>> {
        let mut cells = self.halve(&self.cell(piece, [0.0; M], [1.0; M])).to_vec();
        self.refine(&mut cells, VecDeque::from([first, first + 1]), first);
        gather_hulls(&mut cells, first);
        cells
    }

    /// Splits the cells of one piece, of which these are given, until they are flat; `cells` are numbered from `first`.
    fn refine(&self, cells: &mut Vec<Cell<M>>, mut queue: VecDeque<u32>, first: u32) {
        let mut count = 2 * queue.len() - 1;
        while let Some(number) = queue.pop_front() {
            let cell = &cells[(number - first) as usize];
            if M == 0 || count + 2 > CELLS_PER_PIECE || cell.rho2 <= FLATNESS * (cell.radius() - cell.rho2) {
                continue;
            }
            let halves = self.halve(cell);
            let next = first + cells.len() as u32;
            cells[(number - first) as usize].children = [next, next + 1];
            cells.extend(halves);
            queue.extend([next, next + 1]);
            count += 2;
        }
    }

    /// The cell over any box of parameters of a piece.
    pub fn cell(&self, piece: u32, middle: [f64; M], half: [f64; M]) -> Cell<M> {
        Cell::new(piece, &self.pieces[piece as usize], middle, half)
    }

    /// The two halves of a cell of one piece.
    pub fn halve(&self, cell: &Cell<M>) -> [Cell<M>; 2] {
        let axis = cell.axis();
        [-0.5, 0.5].map(|side| {
            let (mut middle, mut half) = (cell.middle, cell.half);
            middle[axis] += side * half[axis];
            half[axis] *= 0.5;
            self.cell(cell.piece, middle, half)
        })
    }

    /// The cell pressed onto its low or high side in one direction.
    pub fn face(&self, cell: &Cell<M>, axis: usize, high: bool) -> Cell<M> {
        let (mut middle, mut half) = (cell.middle, cell.half);
        middle[axis] = cell.range(axis)[usize::from(high)];
        half[axis] = 0.0;
        self.cell(cell.piece, middle, half)
    }
}

/// Boxes from the leaves upwards: those of large cells are far too wide. Children come after their parents; `cells` are
/// numbered from `first`, and those of a piece that comes later are not among them.
fn gather_hulls<const M: usize>(cells: &mut [Cell<M>], first: u32) {
    for k in (0..cells.len()).rev() {
        let [left, right] = cells[k].children;
        let of = |child: u32| cells.get((child - first) as usize).map(|c| c.hull);
        if left == 0 {
            continue;
        }
        if let (Some(p), Some(q)) = (of(left), of(right)) {
            let hull = around(&p, &q);
            if cells[k].is_group() {
                cells[k] = Cell { children: [left, right], ..Cell::group(hull) };
            }
            cells[k].hull = hull;
        }
    }
}

/// Builds the groups over the roots of the pieces by halving at the median; returns the number of the node.
fn gather<const M: usize>(order: &mut [u32], roots: &[Cell<M>], nodes: &mut Vec<Cell<M>>, places: &mut [u32]) -> u32 {
    let number = nodes.len() as u32;
    if let [piece] = order {
        nodes.push(roots[*piece as usize].clone());
        places[*piece as usize] = number;
        return number;
    }
    let hulls = order.iter().map(|&p| roots[p as usize].hull);
    let [low, high] = hulls.reduce(|a, b| around(&a, &b)).expect("one piece at least");
    nodes.push(Cell::group([low, high]));
    let axis = (high - low).imax();
    order.sort_by(|&a, &b| {
        let key = |p: u32| roots[p as usize].x[axis];
        key(a).total_cmp(&key(b)).then(a.cmp(&b))
    });
    let (left, right) = order.split_at_mut(order.len() / 2);
    let first = gather(left, roots, nodes, places);
    let second = gather(right, roots, nodes, places);
    nodes[number as usize].children = [first, second];
    number
}

#[cfg(test)]
mod tests {
    use crate::Point;
    use crate::closest::{Query, closest};
    use crate::shape::{Shape, Surface};

    #[test]
    fn a_query_builds_the_pieces_it_looks_at() {
        let knots = [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 3.0, 3.0, 3.0];
        let at = |i: usize, j: usize| Point::<3>::new(i as f64, j as f64, 0.2 * ((5 * i + 3 * j) % 7) as f64);
        let points: Vec<Vec<Point<3>>> = (0..6).map(|i| (0..6).map(|j| at(i, j)).collect()).collect();
        let weight = |i: usize, j: usize| 10f64.powf(((3 * i + 4 * j) % 5) as f64 / 2.0 - 1.0);
        let weights: Vec<Vec<f64>> = (0..6).map(|i| (0..6).map(|j| weight(i, j)).collect()).collect();
        let surface = Surface::nurbs([3, 3], [&knots, &knots], &points, Some(&weights), [false; 2]).unwrap();
        let built = |s: &Shape| match s {
            Shape::Surface(s) => s.atlas.later.iter().filter(|l| l.cells.get().is_some()).count(),
            _ => unreachable!(),
        };
        let pieces = surface.atlas.pieces.len();
        let shape = Shape::from(surface);
        assert_eq!(built(&shape), 0);
        let query =
            |shape: &Shape, x: f64| closest(&Shape::Point(Point::<3>::new(x, 1.5, 1.5)), shape, &Query::default());
        let first = query(&shape, 1.0);
        assert!(built(&shape) * 4 <= pieces, "{} of {pieces}", built(&shape));
        // What was built before does not show.
        let other = shape.clone();
        query(&other, 4.0);
        assert!(built(&other) > built(&shape));
        assert_eq!(query(&other, 1.0), first);
    }
}
