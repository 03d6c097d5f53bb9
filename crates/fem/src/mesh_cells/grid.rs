//! A grid as fine as the cells of a mesh.

use super::MeshCells;
use crate::cells::Cells;
use crate::grid::Grid;
use crate::reference::CellShape;

impl MeshCells {
    /// A uniform grid over the mesh, with cells of the median size.
    pub fn grid(&self) -> Grid<2> {
        let mut sizes: Vec<f64> = (0..self.count()).map(|cell| self.extent(cell)).collect();
        let middle = sizes.len() / 2;
        let h = *sizes.select_nth_unstable_by(middle, f64::total_cmp).1;
        let number = |k: usize| ((self.bounds().size()[k] / h).round() as usize).clamp(1, 1 << 14);
        Grid::new(*self.bounds(), [number(0), number(1)], self.degree)
    }

    /// The side of a square as large as a cell, or as two triangles.
    pub(super) fn extent(&self, cell: usize) -> f64 {
        (self.volume(cell) * if self.mesh.shape(cell) == CellShape::Triangle { 2.0 } else { 1.0 }).sqrt()
    }
}
