//! What lies along some cuts of a membrane: stored equations, and the factor of the band of nodes there.

use super::regular::Regular;
use crate::domain::DomainOnCells;
use crate::equilibrium::Equilibrium;
use crate::equilibrium::elements::Elements;
use crate::equilibrium::system::{HOLDS, System};
use crate::plane_zone::{PlaneZone, Straightened};
use crate::problem::Membrane;
use crate::quadrature::Quadrature;
use signorini_fem::cut::RegionId;
use signorini_fem::{Cells, CellsPart};
use signorini_solve::{Factor, SolveError, Symbolic, SymmetricMatrix};
use std::sync::Arc;

/// Gauss points per direction in cut cells at degree 1: on fine grids a front is nearly straight within a cell.
const ORDER: usize = 3;

/// The equations along some cuts.
pub(super) struct Band {
    cells: Arc<CellsPart<2>>,
    /// The state of these cells, and the unknown of the level for each of its own.
    state: Equilibrium<2>,
    global: Vec<u32>,
    /// Unknowns behind the nodes: of nodes that two free regions share.
    pub more: usize,
    /// Unknowns with stored rows, the nodes they stand for, the rows and the right-hand side.
    irregular: Vec<u32>,
    node_of_irregular: Vec<u32>,
    row_start: Vec<usize>,
    column: Vec<u32>,
    value: Vec<f64>,
    load: Vec<f64>,
    /// Unknowns that are solved for exactly, ascending, with their stored rows.
    solved: Vec<(u32, Option<u32>)>,
    factor: Option<Factor>,
}

impl Band {
    /// The band in some of the cells of a membrane. Nodes of those that are `inner` have their rows stored; further unknowns
    /// are numbered from `first` on; `also` are regular nodes that are solved for with the band.
    ///
    /// # Errors
    /// A band that cannot be factorised.
    pub fn new<R: Regular>(
        membrane: &Membrane<2>,
        zone: &PlaneZone,
        cells: CellsPart<2>,
        inner: &[usize],
        first: usize,
        regular: &R,
        also: &[usize],
    ) -> Result<Self, SolveError> {
        let cells = Arc::new(cells);
        let status = cells.cells().iter().map(|&c| membrane.domain.status[c]).collect();
        let domain = DomainOnCells { domain: membrane.domain.domain.clone(), status: Arc::new(status) };
        let part = Membrane { cells: cells.clone(), domain, ..membrane.clone() };
        let elements = Elements::new(&part);
        let mut band =
            Self::of(&part, &cells, System::on(&part, quadrature(&part, zone), &elements), inner, first, regular, also);
        for hold in HOLDS {
            if let Err(SolveError::NotPositiveDefinite { .. }) = band {
                let system = System::held(&part, quadrature(&part, zone), &elements, hold);
                band = Self::of(&part, &cells, system, inner, first, regular, also);
            }
        }
        band
    }

    /// That of a system at hand.
    fn of<R: Regular>(
        part: &Membrane<2>,
        cells: &Arc<CellsPart<2>>,
        system: System<2>,
        inner: &[usize],
        first: usize,
        regular: &R,
        also: &[usize],
    ) -> Result<Self, SolveError> {
        let System { quadrature, unknowns, matrix, rhs } = system;
        // The unknown of the level for each of the part: the node, or one more where another region has it already.
        let mut more = 0;
        let mut taken = vec![false; cells.nodes().len()];
        let mut global = vec![u32::MAX; unknowns.count];
        let mut node_of = vec![0; unknowns.count];
        let mut stored = vec![false; unknowns.count];
        let mut functions = Vec::new();
        for (cell, _, dofs) in unknowns.all() {
            cells.functions(cell, &mut functions);
            let inner = inner.binary_search(&cells.cells()[cell]).is_ok();
            for (&dof, &f) in dofs.iter().zip(&functions) {
                let dof = dof as usize;
                stored[dof] |= inner;
                if global[dof] != u32::MAX {
                    continue;
                }
                node_of[dof] = cells.nodes()[f as usize];
                global[dof] = if std::mem::replace(&mut taken[f as usize], true) {
                    more += 1;
                    (first + more - 1) as u32
                } else {
                    node_of[dof]
                };
            }
        }
        let mut band = Self {
            state: Equilibrium::unsolved(part.clone(), quadrature, unknowns),
            cells: cells.clone(),
            more,
            irregular: Vec::new(),
            node_of_irregular: Vec::new(),
            row_start: vec![0],
            column: Vec::new(),
            value: Vec::new(),
            load: Vec::new(),
            solved: Vec::new(),
            factor: None,
            global: Vec::new(),
        };
        for (i, row) in matrix.rows(|i| stored[i]) {
            band.solved.push((global[i], Some(band.irregular.len() as u32)));
            band.irregular.push(global[i]);
            band.node_of_irregular.push(node_of[i]);
            band.column.extend(row.iter().map(|(j, _)| global[*j]));
            band.value.extend(row.iter().map(|(_, v)| *v));
            band.row_start.push(band.column.len());
            band.load.push(rhs[i]);
        }
        let outer = (0..global.len()).filter(|&i| !stored[i]).map(|i| global[i]);
        band.solved.extend(outer.chain(also.iter().map(|node| *node as u32)).map(|node| (node, None)));
        band.global = global;
        band.factorise(regular, first + more)?;
        Ok(band)
    }

    /// Factorises the equations of the band, where the level has so many unknowns up to its last one.
    fn factorise<R: Regular>(&mut self, regular: &R, count: usize) -> Result<(), SolveError> {
        self.solved.sort_unstable();
        self.solved.dedup_by_key(|s| s.0);
        if self.solved.is_empty() {
            return Ok(());
        }
        // The place of each, counted from one; of all that is not there nothing is ever touched.
        let mut place = vec![0u32; count];
        self.solved.iter().zip(1..).for_each(|(s, k)| place[s.0 as usize] = k);
        let matrix = SymmetricMatrix::from_columns(self.solved.len(), |k, out| {
            let mut push = |j: usize, v: f64| {
                if place[j] > k as u32 {
                    out.push((place[j] as usize - 1, v));
                }
            };
            match self.solved[k] {
                (node, None) => regular.row(node as usize).for_each(|(j, v)| push(j, v)),
                (_, Some(row)) => self.row(row as usize).for_each(|(j, v)| push(j, v)),
            }
        });
        self.factor = Some(Symbolic::default().factor(matrix)?);
        Ok(())
    }

    /// The cells that it lies in, ascending.
    pub fn cells(&self) -> &[usize] {
        self.cells.cells()
    }

    /// Unknowns that are solved for exactly.
    pub fn size(&self) -> usize {
        self.solved.len()
    }

    /// Unknowns with stored rows, and the nodes that they stand for.
    pub fn irregular(&self) -> impl ExactSizeIterator<Item = (usize, usize)> + '_ {
        self.irregular.iter().zip(&self.node_of_irregular).map(|(&unknown, &node)| (unknown as usize, node as usize))
    }

    /// Columns and entries of a stored row.
    fn row(&self, k: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.row_start[k]..self.row_start[k + 1];
        range.map(|at| (self.column[at] as usize, self.value[at]))
    }

    /// The residual of a stored row.
    fn residual_of(&self, k: usize, u: &[f64], b: &[f64]) -> f64 {
        b[self.irregular[k] as usize] - self.row(k).map(|(j, v)| v * u[j]).sum::<f64>()
    }

    /// Puts the right-hand side of the stored rows in its place.
    pub fn load(&self, b: &mut [f64]) {
        self.irregular.iter().zip(&self.load).for_each(|(&i, f)| b[i as usize] = *f);
    }

    /// What the stored rows leave of the right-hand side.
    pub fn residual(&self, u: &[f64], b: &[f64], r: &mut [f64]) {
        for (k, &i) in self.irregular.iter().enumerate() {
            r[i as usize] = self.residual_of(k, u, b);
        }
    }

    /// Solves for the band exactly, the other nodes held.
    ///
    /// # Errors
    /// A factor that does not solve.
    pub fn relax<R: Regular>(&self, regular: &R, u: &mut [f64], b: &[f64]) -> Result<(), SolveError> {
        let Some(factor) = &self.factor else { return Ok(()) };
        // The next sweep refines this one.
        let mut correction: Vec<f64> = self
            .solved
            .iter()
            .map(|&(unknown, row)| match row {
                Some(k) => self.residual_of(k as usize, u, b),
                None => b[unknown as usize] - regular.row(unknown as usize).map(|(j, v)| v * u[j]).sum::<f64>(),
            })
            .collect();
        factor.solve_once(&mut correction)?;
        self.solved.iter().zip(&correction).for_each(|((unknown, _), c)| u[*unknown as usize] += c);
        Ok(())
    }

    /// The state of the cells, with the displacement of the level.
    pub fn state(&mut self, u: &[f64]) -> &Equilibrium<2> {
        let global = &self.global;
        self.state.set_values(|i| u[global[i] as usize]);
        &self.state
    }

    /// Calls `visit(region, node, unknown)` for all unknowns, for some more than once.
    pub fn for_each_unknown(&self, mut visit: impl FnMut(RegionId, u32, u32)) {
        let mut functions = Vec::new();
        for (cell, region, dofs) in self.state.unknowns().all() {
            self.cells.functions(cell, &mut functions);
            for (&dof, &f) in dofs.iter().zip(&functions) {
                visit(region, self.cells.nodes()[f as usize], self.global[dof as usize]);
            }
        }
    }
}

/// The quadrature of a membrane around a zone.
pub(super) fn quadrature(membrane: &Membrane<2>, zone: &PlaneZone) -> Quadrature<2> {
    match membrane.cells.degree() {
        1 => Quadrature::of_order(membrane, &Straightened(zone), ORDER),
        _ => Quadrature::new(membrane, zone),
    }
}
