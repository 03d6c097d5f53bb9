//! Some cells of a grid: what lies along a cut, for methods that treat the rest by other means.

use crate::cells::{BoundarySide, Cells, Divided, Neighbours, SidePoint};
use crate::cut::{CellPartition, CellRule, QuadraturePoint};
use crate::grid::Grid;
use crate::lagrange::Tabulation;
use signorini_geometry::{Aabb, Point};
use std::collections::HashMap;
use std::sync::Arc;

/// Some cells of a grid, numbered through, with the functions of these.
#[derive(Clone)]
pub struct GridPart<const D: usize> {
    grid: Grid<D>,
    cells: Vec<usize>,
    number: HashMap<usize, usize>,
    /// Nodes of the grid, ascending, and for each cell after the other which of them are its own.
    nodes: Vec<u32>,
    functions: Vec<u32>,
}

impl<const D: usize> GridPart<D> {
    /// The part of a grid that consists of the given cells.
    pub fn new(grid: &Grid<D>, mut cells: Vec<usize>) -> Self {
        cells.sort_unstable();
        cells.dedup();
        let mut functions = Vec::with_capacity(cells.len() * grid.basis().len());
        let mut of_cell = Vec::new();
        for &cell in &cells {
            grid.cell_nodes(cell, &mut of_cell);
            functions.extend_from_slice(&of_cell);
        }
        let mut nodes = functions.clone();
        nodes.sort_unstable();
        nodes.dedup();
        functions.iter_mut().for_each(|node| *node = nodes.partition_point(|n| n < node) as u32);
        let number = cells.iter().enumerate().map(|(k, &cell)| (cell, k)).collect();
        Self { grid: grid.clone(), cells, number, nodes, functions }
    }

    /// The cells in the grid.
    pub fn cells(&self) -> &[usize] {
        &self.cells
    }

    /// The nodes of the grid that the functions stand for.
    pub fn nodes(&self) -> &[u32] {
        &self.nodes
    }

    /// The number of a cell of the grid, if it belongs to the part.
    pub fn number(&self, cell: usize) -> Option<usize> {
        self.number.get(&cell).copied()
    }
}

impl<const D: usize> Cells<D> for GridPart<D> {
    fn degree(&self) -> usize {
        self.grid.degree()
    }
    fn count(&self) -> usize {
        self.cells.len()
    }
    fn bounds_of(&self, cell: usize) -> Aabb<D> {
        self.grid.cell_box(self.cells[cell])
    }
    fn size(&self, _: usize) -> f64 {
        self.grid.h()
    }
    fn volume(&self, _: usize) -> f64 {
        self.grid.cell_size().iter().product()
    }
    fn containing(&self, x: &Point<D>) -> Option<usize> {
        self.number(self.grid.cell_containing(x))
    }
    fn function_count(&self) -> usize {
        self.nodes.len()
    }
    fn functions(&self, cell: usize, out: &mut Vec<u32>) {
        let count = self.grid.basis().len();
        out.clear();
        out.extend_from_slice(&self.functions[cell * count..(cell + 1) * count]);
    }
    fn tabulate(&self, cell: usize, x: &Point<D>, out: &mut Tabulation<D>) {
        self.grid.tabulate(self.cells[cell], x, out);
    }
    fn node(&self, function: usize) -> Point<D> {
        self.grid.node(self.nodes[function] as usize)
    }
    fn linear(&self, finer: usize) -> Arc<dyn Cells<D>> {
        self.grid.linear(finer)
    }
    fn raised(&self) -> Option<Arc<dyn Cells<D>>> {
        None
    }
    fn coarser(&self) -> Option<Arc<dyn Cells<D>>> {
        None
    }
    fn rule(&self, cell: usize) -> Vec<QuadraturePoint<D>> {
        self.grid.rule(self.cells[cell])
    }
    fn cut(&self, cell: usize, partition: &CellPartition<'_, D>, order: usize) -> CellRule<D> {
        self.grid.cut(self.cells[cell], partition, order)
    }
    fn kind(&self, _: usize) -> Option<usize> {
        Some(0)
    }
    fn kinds(&self) -> Vec<usize> {
        if self.cells.is_empty() { Vec::new() } else { vec![0] }
    }
    fn neighbours(&self) -> Vec<Neighbours> {
        let size = self.grid.cell_size();
        let across = |k: usize, axis: usize| {
            let upper = self.number(self.grid.upper_neighbour(self.cells[k], axis)?)?;
            Some(Neighbours { cells: [k, upper], width: size[axis], kind: Some(axis) })
        };
        (0..self.cells.len()).flat_map(|k| (0..D).filter_map(move |axis| across(k, axis))).collect()
    }
    fn boundary_sides(&self) -> Vec<BoundarySide> {
        let cells = self.grid.cells();
        let of = |k: usize| {
            let index = self.grid.cell_index(self.cells[k]);
            (0..2 * D)
                .filter(move |side| index[side / 2] == if side % 2 == 1 { cells[side / 2] - 1 } else { 0 })
                .map(move |side| BoundarySide { cell: k, side, piece: side })
        };
        (0..self.cells.len()).flat_map(of).collect()
    }
    fn on_side(&self, side: &BoundarySide, t: f64) -> SidePoint<D> {
        self.grid.on_side(&BoundarySide { cell: self.cells[side.cell], ..*side }, t)
    }
    fn divided(&self, cell: usize, n: usize) -> Divided<D> {
        self.grid.divided(self.cells[cell], n)
    }
}
