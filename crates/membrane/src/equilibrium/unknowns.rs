//! Unknowns of the parts of a membrane: each connected region has its own.

use crate::problem::Membrane;
use crate::quadrature::Quadrature;
use crate::zone::is_free;
use signorini_fem::cut::{QuadraturePoint, RegionId};
use std::collections::BTreeMap;

/// Unknowns of each cell and region.
pub(crate) struct Unknowns {
    /// For each cell where its regions begin, and for each of these where its unknowns do.
    cells: Vec<u32>,
    regions: Vec<(RegionId, u32)>,
    list: Vec<u32>,
    pub count: usize,
}

impl Unknowns {
    /// The regions of a cell with their unknowns.
    pub fn of_cell(&self, cell: usize) -> impl Iterator<Item = (RegionId, &[u32])> {
        (self.cells[cell] as usize..self.cells[cell + 1] as usize).map(|k| {
            let end = self.regions.get(k + 1).map_or(self.list.len(), |r| r.1 as usize);
            (self.regions[k].0, &self.list[self.regions[k].1 as usize..end])
        })
    }

    /// All cells and regions with their unknowns.
    pub fn all(&self) -> impl Iterator<Item = (usize, RegionId, &[u32])> {
        (0..self.cells.len() - 1).flat_map(|cell| self.of_cell(cell).map(move |(region, dofs)| (cell, region, dofs)))
    }

    /// Visits the volume rules of all cells and regions that have unknowns: the cell, the region, its unknowns, its points.
    pub fn for_each_rule<const D: usize>(
        &self,
        membrane: &Membrane<D>,
        quadrature: &Quadrature<D>,
        mut visit: impl FnMut(usize, RegionId, &[u32], &[QuadraturePoint<D>]),
    ) {
        for cell in 0..quadrature.cells.len() {
            for (region, points) in quadrature.volumes(membrane, cell) {
                if let Some(dofs) = self.of(cell, region) {
                    visit(cell, region, dofs, &points);
                }
            }
        }
    }

    pub fn of(&self, cell: usize, region: RegionId) -> Option<&[u32]> {
        self.of_cell(cell).find(|(r, _)| *r == region).map(|(_, dofs)| dofs)
    }
}

/// Numbers the unknowns, cell by cell: one for each node and free region.
pub(crate) fn number<const D: usize>(membrane: &Membrane<D>, quadrature: &Quadrature<D>) -> Unknowns {
    number_where(membrane, quadrature, is_free)
}

/// Numbers the unknowns, cell by cell: one for each node and region of some kind.
pub(crate) fn number_where<const D: usize>(
    membrane: &Membrane<D>,
    quadrature: &Quadrature<D>,
    wanted: impl Fn(RegionId) -> bool,
) -> Unknowns {
    let mut of_node: BTreeMap<RegionId, Vec<u32>> = BTreeMap::new();
    let mut out = Unknowns { cells: vec![0], regions: Vec::new(), list: Vec::new(), count: 0 };
    let mut nodes = Vec::new();
    for cell in 0..quadrature.cells.len() {
        for region in quadrature.regions(cell).into_iter().filter(|r| wanted(*r)) {
            membrane.cells.functions(cell, &mut nodes);
            let numbers = of_node.entry(region).or_insert_with(|| vec![u32::MAX; membrane.cells.function_count()]);
            out.regions.push((region, out.list.len() as u32));
            for &node in &nodes {
                let number = &mut numbers[node as usize];
                if *number == u32::MAX {
                    *number = out.count as u32;
                    out.count += 1;
                }
                out.list.push(*number);
            }
        }
        out.cells.push(out.regions.len() as u32);
    }
    out
}
