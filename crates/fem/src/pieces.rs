//! The pieces that a mesh falls into.

use crate::mesh::Mesh;
use signorini_geometry::sets::root;

impl<const D: usize> Mesh<D> {
    /// The number of the piece that each cell belongs to: cells of one piece hang together by shared vertices. Pieces are
    /// numbered by their first cells.
    pub fn pieces(&self) -> Vec<u32> {
        let mut parent: Vec<u32> = (0..self.nodes().len() as u32).collect();
        for cell in 0..self.cell_count() {
            let mut first = None;
            for vertex in self.vertices(cell) {
                let root = root(&mut parent, vertex);
                let joined = *first.get_or_insert(root);
                parent[root.max(joined) as usize] = root.min(joined);
                first = Some(root.min(joined));
            }
        }
        let mut numbers = vec![u32::MAX; parent.len()];
        let mut count = 0;
        (0..self.cell_count())
            .map(|cell| {
                let Some(vertex) = self.vertices(cell).next() else { return 0 };
                let number = &mut numbers[root(&mut parent, vertex) as usize];
                if *number == u32::MAX {
                    *number = count;
                    count += 1;
                }
                *number
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::CellShape;
    use signorini_geometry::Point;

    #[test]
    fn cells_that_share_a_vertex_are_one_piece() {
        let mut mesh = Mesh::<2>::new((0..12).map(|k| Point::<2>::new(f64::from(k), 0.0)).collect());
        for nodes in [[6, 7, 8], [0, 1, 2], [9, 10, 11], [2, 3, 4], [10, 7, 5]] {
            mesh.add_cell(CellShape::Triangle, 1, &nodes);
        }
        assert_eq!(mesh.pieces(), [0, 1, 0, 1, 0]);
    }
}
