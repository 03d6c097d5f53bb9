//! Some of all cells: what lies along a cut, for methods that treat the rest by other means.

use crate::cells::{BoundarySide, CellByCell, Cells, Divided, Extension, Neighbours, SidePoint};
use crate::cut::{CellPartition, CellRule, QuadraturePoint};
use crate::lagrange::Tabulation;
use signorini_geometry::{Aabb, Point};
use std::collections::HashMap;
use std::sync::Arc;

/// Some cells, numbered through, with the functions of these.
#[derive(Clone)]
pub struct CellsPart<const D: usize> {
    whole: Arc<dyn CellByCell<D>>,
    cells: Vec<usize>,
    number: HashMap<usize, usize>,
    /// Functions of the whole, ascending, and for each cell after the other which of them are its own.
    nodes: Vec<u32>,
    start: Vec<u32>,
    functions: Vec<u32>,
}

impl<const D: usize> CellsPart<D> {
    /// The part that consists of the given cells.
    pub fn new(whole: Arc<dyn CellByCell<D>>, mut cells: Vec<usize>) -> Self {
        cells.sort_unstable();
        cells.dedup();
        let (mut start, mut functions, mut of_cell) = (vec![0], Vec::new(), Vec::new());
        for &cell in &cells {
            whole.functions(cell, &mut of_cell);
            functions.extend_from_slice(&of_cell);
            start.push(functions.len() as u32);
        }
        let mut nodes = functions.clone();
        nodes.sort_unstable();
        nodes.dedup();
        functions.iter_mut().for_each(|node| *node = nodes.partition_point(|n| n < node) as u32);
        let number = cells.iter().enumerate().map(|(k, &cell)| (cell, k)).collect();
        Self { whole, cells, number, nodes, start, functions }
    }

    /// The cells in the whole.
    pub fn cells(&self) -> &[usize] {
        &self.cells
    }

    /// The functions of the whole that those of the part are.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// The number of a cell of the whole, if it belongs to the part.
    pub fn number(&self, cell: usize) -> Option<usize> {
        self.number.get(&cell).copied()
    }

    /// A pair of neighbours as the whole numbers them.
    fn in_whole(&self, pair: &Neighbours) -> Neighbours {
        Neighbours { cells: pair.cells.map(|k| self.cells[k]), ..*pair }
    }
}

impl<const D: usize> Cells<D> for CellsPart<D> {
    fn degree(&self) -> usize {
        self.whole.degree()
    }
    fn count(&self) -> usize {
        self.cells.len()
    }
    fn bounds_of(&self, cell: usize) -> Aabb<D> {
        self.whole.bounds_of(self.cells[cell])
    }
    fn size(&self, cell: usize) -> f64 {
        self.whole.size(self.cells[cell])
    }
    fn volume(&self, cell: usize) -> f64 {
        self.whole.volume(self.cells[cell])
    }
    fn containing(&self, x: &Point<D>) -> Option<usize> {
        self.number(self.whole.containing(x)?)
    }
    fn sum_to_one(&self) -> bool {
        self.whole.sum_to_one()
    }
    fn function_count(&self) -> usize {
        self.nodes.len()
    }
    fn functions(&self, cell: usize, out: &mut Vec<u32>) {
        out.clear();
        out.extend_from_slice(&self.functions[self.start[cell] as usize..self.start[cell + 1] as usize]);
    }
    fn edges(&self, cell: usize) -> &'static [[usize; 2]] {
        self.whole.edges(self.cells[cell])
    }
    fn tabulate(&self, cell: usize, x: &Point<D>, out: &mut Tabulation<D>) {
        self.whole.tabulate(self.cells[cell], x, out);
    }
    fn extension<'a>(&'a self, cell: usize) -> Extension<'a, D> {
        self.whole.extension(self.cells[cell])
    }
    fn node(&self, function: usize) -> Point<D> {
        self.whole.node(self.nodes[function] as usize)
    }
    fn linear(&self, finer: usize) -> Arc<dyn Cells<D>> {
        self.whole.linear(finer)
    }
    fn raised(&self) -> Option<Arc<dyn Cells<D>>> {
        None
    }
    fn coarser(&self) -> Option<Arc<dyn Cells<D>>> {
        None
    }
    fn rule(&self, cell: usize) -> Vec<QuadraturePoint<D>> {
        self.whole.rule(self.cells[cell])
    }
    fn for_each_point(&self, cell: usize, visit: &mut dyn FnMut(&QuadraturePoint<D>, &Tabulation<D>)) {
        self.whole.for_each_point(self.cells[cell], visit);
    }
    fn cut(&self, cell: usize, partition: &CellPartition<'_, D>, order: usize) -> CellRule<D> {
        self.whole.cut(self.cells[cell], partition, order)
    }
    fn kind(&self, cell: usize) -> Option<usize> {
        self.whole.kind(self.cells[cell])
    }
    fn kinds(&self) -> Vec<usize> {
        // Those of the whole by cells of the part that are like them.
        let kinds = self.whole.kinds().len();
        let of = |kind: usize| (0..self.cells.len()).find(|&cell| self.kind(cell) == Some(kind));
        (0..kinds).map(|kind| of(kind).unwrap_or(0)).take_while(|_| !self.cells.is_empty()).collect()
    }
    fn neighbours(&self) -> Vec<Neighbours> {
        let (mut all, mut out) = (Vec::new(), Vec::new());
        for &cell in &self.cells {
            out.clear();
            self.whole.neighbours_of(cell, &mut out);
            all.extend(out.iter().filter_map(|pair| {
                let [a, b] = pair.cells.map(|cell| self.number(cell));
                Some(Neighbours { cells: [a?, b?], ..*pair })
            }));
        }
        all
    }
    fn compared_over(&self, pair: &Neighbours) -> Vec<(usize, QuadraturePoint<D>)> {
        self.whole.compared_over(&self.in_whole(pair))
    }
    fn boundary_sides(&self) -> Vec<BoundarySide> {
        let (mut all, mut out) = (Vec::new(), Vec::new());
        for (k, &cell) in self.cells.iter().enumerate() {
            out.clear();
            self.whole.sides_of(cell, &mut out);
            all.extend(out.iter().map(|side| BoundarySide { cell: k, ..*side }));
        }
        all
    }
    fn on_side(&self, side: &BoundarySide, t: f64) -> SidePoint<D> {
        self.whole.on_side(&BoundarySide { cell: self.cells[side.cell], ..*side }, t)
    }
    fn divided(&self, cell: usize, n: usize) -> Divided<D> {
        self.whole.divided(self.cells[cell], n)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;

    #[test]
    fn a_part_knows_its_neighbours_and_its_share_of_the_boundary() {
        let grid = Grid::new(Aabb::new(Point::<2>::zeros(), Point::<2>::new(3.0, 2.0)), [3, 2], 1);
        // The lower row but its last cell, and the one above the first.
        let part = CellsPart::new(Arc::new(grid), vec![3, 0, 1]);
        assert_eq!((part.cells(), part.function_count()), (&[0, 1, 3][..], 8));
        let pairs: Vec<[usize; 2]> = part.neighbours().iter().map(|pair| pair.cells).collect();
        assert_eq!(pairs, [[0, 1], [0, 2]]);
        let sides: Vec<(usize, usize)> = part.boundary_sides().iter().map(|s| (s.cell, s.side)).collect();
        assert_eq!(sides, [(0, 0), (0, 2), (1, 2), (2, 0), (2, 3)]);
        assert_eq!(part.containing(&Point::<2>::new(0.5, 1.5)), Some(2));
        assert_eq!(part.containing(&Point::<2>::new(2.5, 0.5)), None);
    }
}
