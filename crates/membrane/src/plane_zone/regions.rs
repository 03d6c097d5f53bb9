//! Where a point lies: in which zone or hole, and how far from fronts.

use super::PlaneZone;
use crate::zone::{contact, free};
use signorini_fem::Grid;
use signorini_fem::cut::RegionId;
use signorini_geometry::{Aabb, Point};

impl PlaneZone {
    /// Calls `visit(first, end, region)` for stretches of the cells of a row, by their centres; together they are the row.
    pub(crate) fn for_each_stretch(&self, row: usize, mut visit: impl FnMut(usize, usize, RegionId)) {
        let columns = self.grid.cells()[0];
        let mut ends: Vec<usize> = self.rows[row].iter().flat_map(|[a, b, _]| [*a as usize, *b as usize]).collect();
        ends.extend([0, columns]);
        ends.sort_unstable();
        ends.dedup();
        for pair in ends.windows(2) {
            let enclosing = self.enclosing(row, pair[0]);
            visit(pair[0], pair[1], self.region_within(enclosing.into_iter()));
        }
    }

    /// The grid that it is told apart on.
    pub(crate) fn grid(&self) -> &Grid<2> {
        &self.grid
    }

    /// The cells that fronts are near to, ascending.
    pub(crate) fn cells_near_fronts(&self) -> impl Iterator<Item = usize> + '_ {
        self.near.cells.iter().map(|&cell| cell as usize)
    }

    /// The curves round the centre of a cell.
    fn enclosing(&self, row: usize, column: usize) -> Vec<usize> {
        let column = column as u32;
        self.rows[row].iter().filter(|[a, b, _]| (*a..*b).contains(&column)).map(|r| r[2] as usize).collect()
    }

    /// The curves round the centre of a cell.
    pub(super) fn around(&self, cell: usize) -> Vec<usize> {
        let [column, row] = self.grid.cell_index(cell);
        self.enclosing(row, column)
    }

    /// The region of a cell that no front is near to.
    pub(crate) fn region_away(&self, cell: usize) -> RegionId {
        self.region_within(self.around(cell).into_iter())
    }

    /// Pairs of curve and sample in or next to a cell.
    fn near(&self, cell: usize) -> &[(u32, u32)] {
        self.near.between(cell, cell)
    }

    pub(super) fn seeds(&self, cell: usize, curve: usize) -> Vec<usize> {
        self.near(cell).iter().filter(|(c, _)| *c as usize == curve).map(|(_, s)| *s as usize).collect()
    }

    /// The curves near a box, each with its samples there.
    pub(super) fn near_box(&self, b: &Aabb<2>) -> Vec<(usize, Vec<usize>)> {
        let inset = 1e-9 * self.grid.cell_size();
        let [low, high] = [b.min + inset, b.max - inset].map(|x| self.grid.cell_index(self.grid.cell_containing(&x)));
        let mut found: Vec<(usize, Vec<usize>)> = Vec::new();
        for j in low[1]..=high[1] {
            let row = self.near.between(self.grid.cell_at([low[0], j]), self.grid.cell_at([high[0], j]));
            for pairs in row.chunk_by(|a, b| a.0 == b.0) {
                let (c, seeds) = (pairs[0].0 as usize, pairs.iter().map(|pair| pair.1 as usize));
                match found.iter_mut().find(|(curve, _)| *curve == c) {
                    Some((_, all)) => all.extend(seeds),
                    None => found.push((c, seeds.collect())),
                }
            }
        }
        if low != high {
            for (_, seeds) in &mut found {
                seeds.sort_unstable();
                seeds.dedup();
            }
        }
        found
    }

    fn curves_near(&self, cell: usize) -> Vec<usize> {
        let mut found: Vec<usize> = self.near(cell).iter().map(|(c, _)| *c as usize).collect();
        found.dedup();
        found
    }

    /// The region inside the smallest of the curves that enclose a point.
    pub(super) fn region_within(&self, enclosing: impl Iterator<Item = usize>) -> RegionId {
        match enclosing.min_by(|&a, &b| self.areas[a].total_cmp(&self.areas[b])) {
            None => free(0),
            Some(c) if self.hole[c] => free(1 + self.number[c]),
            Some(c) => contact(self.sides[c], self.number[c]),
        }
    }

    /// Whether a signed distance to a curve means that the curve encloses the point.
    pub(super) fn encloses(&self, curve: usize, signed_distance: f64) -> bool {
        (signed_distance < 0.0) != self.hole[curve]
    }

    /// The region of a point of the membrane.
    pub(super) fn region_of_point(&self, x: &Point<2>) -> RegionId {
        let cell = self.grid.cell_containing(x);
        let near = self.curves_near(cell);
        let close = near.iter().copied().filter(|&c| {
            let (d, _) = self.curves[c].signed_distance(x, self.seeds(cell, c).into_iter());
            self.encloses(c, d)
        });
        let far = self.around(cell).into_iter().filter(|c| !near.contains(c)).collect::<Vec<_>>();
        self.region_within(far.into_iter().chain(close.collect::<Vec<_>>()))
    }

    /// Distance to the nearest front, if that is near.
    pub(super) fn distance_to_fronts(&self, x: &Point<2>, within: f64) -> f64 {
        let apart = |c: usize, s: usize| (self.curves[c].samples()[s] - x).norm();
        let Some(sizing) = &self.sizing else {
            let near = self.near(self.grid.cell_containing(x)).iter();
            return near.map(|&(c, s)| apart(c as usize, s as usize)).fold(f64::INFINITY, f64::min);
        };
        let reach = Point::<2>::repeat(within.min(sizing.at(x)));
        let near = self.near_box(&Aabb::new(x - reach, x + reach));
        near.into_iter()
            .flat_map(|(c, seeds)| seeds.into_iter().map(move |s| (c, s)))
            .map(|(c, s)| apart(c, s))
            .fold(f64::INFINITY, f64::min)
    }
}
