//! The four parts that a cell of the plane is divided into.

use crate::reference::CellShape;

/// Cells that a cell is divided into.
pub const PARTS: usize = 4;

/// A corner of a part of a cell, as the mean of four vertices of the cell.
pub type Corner = [u8; 4];

/// The corners of the parts of a cell: one part at each of its vertices, where it has their number, and the fourth of a
/// triangle in the middle.
pub fn parts(shape: CellShape) -> [&'static [Corner]; PARTS] {
    const A: Corner = [0, 0, 1, 1];
    const B: Corner = [1, 1, 2, 2];
    const C: Corner = [0, 0, 2, 2];
    const D: Corner = [2, 2, 3, 3];
    const E: Corner = [0, 0, 3, 3];
    const M: Corner = [0, 1, 2, 3];
    const V: [Corner; 4] = [[0; 4], [1; 4], [2; 4], [3; 4]];
    match shape {
        CellShape::Triangle => [&[V[0], A, C], &[A, V[1], B], &[C, B, V[2]], &[A, B, C]],
        _ => [&[V[0], A, M, E], &[A, V[1], B, M], &[M, B, V[2], D], &[E, M, D, V[3]]],
    }
}

/// The sides that parts of a cell share, each as that of two parts.
pub fn between_parts(shape: CellShape) -> &'static [[[usize; 2]; 2]] {
    match shape {
        CellShape::Triangle => &[[[0, 1], [3, 2]], [[1, 2], [3, 0]], [[2, 0], [3, 1]]],
        _ => &[[[0, 1], [1, 3]], [[0, 2], [3, 0]], [[1, 2], [2, 0]], [[2, 3], [3, 1]]],
    }
}
