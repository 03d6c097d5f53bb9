//! Which cells of a plane mesh share sides.

use crate::cell_parts::{PARTS, between_parts};
use crate::lists::Lists;
use crate::mesh::{Mesh, Side};

/// The side of another cell that each side of each cell lies on.
#[derive(Clone, Debug)]
pub struct Adjacency {
    /// Places for sides of every cell, as many as the cells with most of them need: the number of the first side of cell
    /// `k` is `k` times this.
    width: usize,
    across: Vec<u32>,
}

const NONE: u32 = u32::MAX;

impl Adjacency {
    pub fn new(mesh: &Mesh<2>) -> Self {
        let width = (0..mesh.cell_count()).map(|cell| mesh.shape(cell).sides().len()).max().unwrap_or(0);
        let mut across = vec![NONE; width * mesh.cell_count()];
        // Sides by their lower vertex, with the other and their place: at each there are few.
        let sides = Lists::new(mesh.nodes().len(), |visit| {
            for_each_side(mesh, |[low, high], side| {
                visit(low as usize, (high, side.cell * width as u32 + u32::from(side.side)));
            });
        });
        for vertex in 0..mesh.nodes().len() {
            let here = sides.of(vertex);
            for (k, &(end, side)) in here.iter().enumerate() {
                if let Some(&(_, other)) = here[..k].iter().find(|(e, _)| *e == end) {
                    across[side as usize] = other;
                    across[other as usize] = side;
                }
            }
        }
        Self { width, across }
    }

    /// That of the mesh with every cell divided into four.
    pub fn refined(&self, coarse: &Mesh<2>) -> Self {
        let width = self.width;
        let mut fine = Self { width, across: vec![NONE; PARTS * self.across.len()] };
        for cell in 0..coarse.cell_count() {
            let place = |of: usize, [part, side]: [usize; 2]| (PARTS * of + part) * width + side;
            // The parts at both ends of a side have a side of the same number there.
            let sides = coarse.shape(cell).sides().len();
            for side in 0..sides {
                let of = Side { cell: cell as u32, side: side as u8 };
                let Some(Side { cell: other, side: opposite }) = self.opposite(of) else { continue };
                let (other, opposite) = (other as usize, usize::from(opposite));
                let others = coarse.shape(other).sides().len();
                // The other cell has the ends in the other order.
                let theirs = [(opposite + 1) % others, opposite];
                for (part, their) in [side, (side + 1) % sides].into_iter().zip(theirs) {
                    fine.across[place(cell, [part, side])] = place(other, [their, opposite]) as u32;
                }
            }
            for &[a, b] in between_parts(coarse.shape(cell)) {
                fine.across[place(cell, a)] = place(cell, b) as u32;
                fine.across[place(cell, b)] = place(cell, a) as u32;
            }
        }
        fine
    }

    /// Places for sides, of which cells that have fewer leave some empty.
    pub fn places(&self) -> usize {
        self.across.len()
    }

    /// The place of a side.
    pub fn place(&self, side: Side) -> usize {
        side.cell as usize * self.width + usize::from(side.side)
    }

    /// The same side as that of another cell; none on the boundary.
    pub fn opposite(&self, side: Side) -> Option<Side> {
        let other = self.across[self.place(side)] as usize;
        (other != NONE as usize).then(|| Side { cell: (other / self.width) as u32, side: (other % self.width) as u8 })
    }

    /// The cell across a side; none on the boundary.
    pub fn across(&self, side: Side) -> Option<usize> {
        self.opposite(side).map(|side| side.cell as usize)
    }

    /// Neighbours of a cell, one for each side that is not on the boundary.
    pub fn of(&self, cell: usize) -> impl Iterator<Item = usize> + '_ {
        let own = self.across[cell * self.width..(cell + 1) * self.width].iter();
        own.filter(|place| **place != NONE).map(|place| *place as usize / self.width)
    }
}

/// Calls `visit` with the ends of every side of every cell, the lower one first.
fn for_each_side(mesh: &Mesh<2>, mut visit: impl FnMut([u32; 2], Side)) {
    let mut corners = Vec::new();
    for cell in 0..mesh.cell_count() {
        corners.clear();
        corners.extend(mesh.vertices(cell));
        for (k, ends) in mesh.shape(cell).sides().iter().enumerate() {
            let [a, b] = [ends[0], ends[1]].map(|v| corners[v]);
            visit([a.min(b), a.max(b)], Side { cell: cell as u32, side: k as u8 });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::CellShape;
    use signorini_geometry::Point;

    #[test]
    fn neighbours_are_found_across_sides() {
        // A quadrilateral, a triangle on its right and one more on that.
        let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [2.0, 0.5], [2.0, 1.5]].map(Point::<2>::from);
        let mut mesh = Mesh::<2>::new(corners.to_vec());
        mesh.add_cell(CellShape::Quadrilateral, 1, &[0, 1, 3, 2]);
        mesh.add_cell(CellShape::Triangle, 1, &[1, 4, 2]);
        mesh.add_cell(CellShape::Triangle, 1, &[2, 4, 5]);
        let adjacency = Adjacency::new(&mesh);
        let across = |cell, side| adjacency.across(Side { cell, side });
        assert_eq!([0, 1, 2, 3].map(|s| across(0, s)), [None, Some(1), None, None]);
        assert_eq!([0, 1, 2].map(|s| across(1, s)), [None, Some(2), Some(0)]);
        assert_eq!([0, 1, 2].map(|s| across(2, s)), [Some(1), None, None]);
        let boundary: Vec<Side> = mesh.all_sides().filter(|s| adjacency.across(*s).is_none()).collect();
        assert_eq!(boundary, mesh.boundary());
        assert_eq!(adjacency.of(1).collect::<Vec<_>>(), [2, 0]);
        // Of divided cells neighbours follow.
        let fine = mesh.refined(&adjacency);
        assert_eq!(adjacency.refined(&mesh).across, Adjacency::new(&fine).across);
    }
}
