//! One level: regular nodes by their stencil, irregular ones by stored rows, and the factor of the band round these.

use super::interior::{Interior, Run, runs};
use super::transfer::Interpolation;
use crate::domain::{CellStatus, DomainOnCells};
use crate::equilibrium::{Elements, Equilibrium, System, number};
use crate::plane_zone::{PlaneZone, Straightened};
use crate::problem::Membrane;
use crate::quadrature::Quadrature;
use crate::zone::{Division, contact_of, is_free};
use signorini_fem::cut::RegionId;
use signorini_fem::lagrange::Tabulation;
use signorini_fem::{Cells, Grid, GridPart};
use signorini_geometry::Point;
use signorini_solve::{Factor, SolveError, Symbolic, SymmetricMatrix};
use std::collections::HashMap;
use std::sync::Arc;

/// Gauss points per direction in cut cells at degree 1: on fine grids a front is nearly straight within a cell.
const ORDER: usize = 3;
/// Cells in contact beside cut ones whose displacement is held.
const HELD: usize = 4;
/// Neighbouring cells of a cut one that belong to the stored part, and those whose nodes have stored rows.
const PART: usize = 2;
const STORED: usize = 1;

/// A membrane around a zone on one grid. Unknowns are the nodes of the grid, by their number there, and behind them further
/// ones for nodes that two free regions share.
pub struct Level {
    pub(super) grid: Grid<2>,
    interior: Interior,
    pub(super) interpolation: Interpolation,
    /// Regular nodes, and vertices whose patches are relaxed.
    pub(super) runs: Vec<Run>,
    vertices: Vec<Run>,
    /// Rows of irregular unknowns.
    pub(super) irregular: Vec<u32>,
    pub(super) node_of_irregular: Vec<u32>,
    row_start: Vec<usize>,
    column: Vec<u32>,
    value: Vec<f64>,
    /// Unknowns that are solved for exactly, ascending, with their stored rows.
    band: Vec<(u32, Option<u32>)>,
    factor: Option<Factor>,
    /// Displacement and right-hand side of all unknowns.
    pub u: Vec<f64>,
    pub b: Vec<f64>,
    /// Whether a node takes part, or lies in contact, where its displacement is known.
    pub(super) known: Vec<bool>,
    /// The state of the part along the cuts, and the unknown of the level for each of its own.
    part: Equilibrium<2>,
    global: Vec<u32>,
    node_of_part: Vec<u32>,
}

impl Level {
    /// The level of a membrane on its grid. Where `whole` says so its band holds all nodes: the coarsest level is solved.
    ///
    /// # Errors
    /// A band that cannot be factorised.
    pub fn new(membrane: &Membrane<2>, zone: &PlaneZone, whole: bool) -> Result<Self, SolveError> {
        let grid = membrane.grid.clone();
        let [nx, ny] = grid.cells();
        let [columns, rows_of_nodes] = grid.node_counts();
        let state = states(membrane, zone);
        let part_cells = around(&grid, &state, |s| s == State::Cut, PART);
        let cells = Arc::new(GridPart::new(&grid, part_cells));
        let status = cells.cells().iter().map(|&c| membrane.domain.status[c]).collect();
        let domain = DomainOnCells { domain: membrane.domain.domain.clone(), status: Arc::new(status) };
        let part = Membrane { cells: cells.clone(), domain, ..membrane.clone() };
        let elements = Elements::new(&part);
        let System { quadrature, unknowns, matrix, rhs } =
            System::on(&part, quadrature(&part, zone), &elements);

        // The unknown of the level for each of the part: the node, or one more where another region has it already.
        let mut count = grid.node_count();
        let mut taken = vec![u32::MAX; cells.nodes().len()];
        let mut global = vec![u32::MAX; unknowns.count];
        let mut node_of = vec![0; unknowns.count];
        let mut functions = Vec::new();
        for (cell, regions) in unknowns.cells.iter().enumerate() {
            cells.functions(cell, &mut functions);
            for (_, dofs) in regions {
                for (&dof, &f) in dofs.iter().zip(&functions) {
                    if global[dof as usize] != u32::MAX {
                        continue;
                    }
                    let owner = &mut taken[f as usize];
                    node_of[dof as usize] = cells.nodes()[f as usize];
                    global[dof as usize] = if *owner == u32::MAX {
                        *owner = dof;
                        cells.nodes()[f as usize]
                    } else {
                        count += 1;
                        count as u32 - 1
                    };
                }
            }
        }
        // Stored rows: those whose cells are all in the part.
        let mut stored = vec![false; count];
        let mut plain: Vec<bool> = state.iter().map(|s| *s == State::Free).collect();
        for &cell in &around(&grid, &state, |s| s == State::Cut, STORED) {
            plain[cell] = false;
            let Some(k) = cells.number(cell) else { continue };
            for (_, dofs) in &unknowns.cells[k] {
                dofs.iter().for_each(|&d| stored[global[d as usize] as usize] = true);
            }
        }
        let rows = matrix.rows(|i| stored[global[i] as usize]);
        let (mut irregular, mut node_of_irregular) = (Vec::new(), Vec::new());
        let (mut row_start, mut column, mut value) = (vec![0], Vec::new(), Vec::new());
        let mut b = vec![0.0; count];
        for (i, row) in rows {
            irregular.push(global[i]);
            node_of_irregular.push(node_of[i]);
            column.extend(row.iter().map(|(j, _)| global[*j]));
            value.extend(row.iter().map(|(_, v)| *v));
            row_start.push(column.len());
            b[global[i] as usize] = rhs[i];
        }

        // Regular nodes have free cells on all sides, and no stored row.
        let p = grid.degree();
        let free = |i: usize, j: usize| i < nx && j < ny && plain[j * nx + i];
        let beside = |node: usize| (node.checked_sub(1).map_or(usize::MAX, |n| n / p), node / p);
        let regular = |i: usize, j: usize| {
            let ((left, right), (below, above)) = (beside(i), beside(j));
            free(left, below) && free(right, below) && free(left, above) && free(right, above)
        };
        let regular_nodes = runs(rows_of_nodes, columns, regular);
        let vertices = runs(ny + 1, nx + 1, |i, j| regular(i * p, j * p));
        let interior = Interior::new(&grid, membrane.tension.constant().unwrap_or(1.0))?;
        load(membrane, &state, &regular_nodes, &mut b);
        let mut level = Self {
            interpolation: Interpolation::new(&grid),
            interior,
            grid,
            runs: regular_nodes,
            vertices,
            irregular,
            node_of_irregular,
            row_start,
            column,
            value,
            band: Vec::new(),
            factor: None,
            u: vec![0.0; count],
            b,
            known: Vec::new(),
            part: Equilibrium::unsolved(part, quadrature, unknowns),
            global,
            node_of_part: cells.nodes().to_vec(),
        };
        level.hold_contact(membrane, zone, &state);
        level.factorise_band(whole)?;
        Ok(level)
    }

    /// Number of unknowns that take part.
    pub fn unknowns(&self) -> usize {
        self.irregular.len() + self.runs.iter().map(|r| r.end - r.begin).sum::<usize>()
    }

    /// Unknowns that are solved for exactly in every sweep.
    pub fn band(&self) -> usize {
        self.band.len()
    }

    /// Columns and entries of a stored row.
    fn stored_row(&self, k: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let range = self.row_start[k]..self.row_start[k + 1];
        range.map(|at| (self.column[at] as usize, self.value[at]))
    }

    /// The residual of a stored row.
    fn residual_of_row(&self, k: usize) -> f64 {
        self.b[self.irregular[k] as usize] - self.stored_row(k).map(|(j, v)| v * self.u[j]).sum::<f64>()
    }

    /// Which unknowns take part.
    fn active(&self) -> Vec<bool> {
        let mut active = vec![false; self.u.len()];
        self.for_each_active(|unknown, _| active[unknown] = true);
        active
    }

    /// Nodes in a row of the grid.
    pub(super) fn width(&self) -> usize {
        self.grid.node_counts()[0]
    }

    fn factorise_band(&mut self, whole: bool) -> Result<(), SolveError> {
        let w = self.width();
        let mut stored = vec![false; self.u.len()];
        self.irregular.iter().for_each(|&i| stored[i as usize] = true);
        let mut band: Vec<(u32, Option<u32>)> = (0..).map(Some).zip(&self.irregular).map(|(k, &i)| (i, k)).collect();
        for run in &self.runs {
            for node in run.row * w + run.begin..run.row * w + run.end {
                if whole || self.interior.row(node).any(|(j, _)| stored[j]) {
                    band.push((node as u32, None));
                }
            }
        }
        band.sort_unstable();
        let mut place = vec![usize::MAX; self.u.len()];
        band.iter().enumerate().for_each(|(k, (i, _))| place[*i as usize] = k);
        let matrix = SymmetricMatrix::from_columns(band.len(), |k, out| {
            let mut push = |j: usize, v: f64| {
                let to = place[j];
                if to != usize::MAX && to >= k {
                    out.push((to, v));
                }
            };
            match band[k] {
                (node, None) => self.interior.row(node as usize).for_each(|(j, v)| push(j, v)),
                (_, Some(row)) => self.stored_row(row as usize).for_each(|(j, v)| push(j, v)),
            }
        });
        self.band = band;
        self.factor = if self.band.is_empty() { None } else { Some(Symbolic::default().factor(matrix)?) };
        Ok(())
    }

    /// Sets the displacement of all that takes no part to zero.
    pub fn silence(&mut self) {
        let active = self.active();
        self.u.iter_mut().zip(&active).filter(|(_, a)| !**a).for_each(|(u, _)| *u = 0.0);
    }

    /// The displacement at a point away from the cuts.
    pub fn evaluate(&self, x: &Point<2>) -> Option<f64> {
        let cell = self.grid.cell_containing(x);
        let mut nodes = Vec::new();
        self.grid.cell_nodes(cell, &mut nodes);
        let w = self.width();
        let regular = |node: usize| {
            let (i, j) = (node % w, node / w);
            let near = self.runs.partition_point(|r| (r.row, r.end) <= (j, i));
            self.runs.get(near).is_some_and(|r| r.row == j && r.begin <= i && i < r.end)
        };
        if !nodes.iter().all(|&n| regular(n as usize)) {
            return None;
        }
        let mut t = Tabulation::default();
        self.grid.tabulate(cell, x, &mut t);
        Some(nodes.iter().zip(&t.value).map(|(&n, v)| v * self.u[n as usize]).sum())
    }

    /// In contact the displacement is the height of what is touched.
    fn hold_contact(&mut self, membrane: &Membrane<2>, zone: &PlaneZone, state: &[State]) {
        self.known = self.active();
        self.known.truncate(self.grid.node_count());
        let mut nodes = Vec::new();
        // Only near the fronts is it ever needed: where these retreat, and to interpolate beside them.
        for cell in around(&self.grid, state, |s| s == State::Cut, HELD) {
            if state[cell] != State::Contact {
                continue;
            }
            let Some((side, _)) = contact_of((zone.fronts_in(&self.grid.cell_box(cell)).region)(&[])) else { continue };
            self.grid.cell_nodes(cell, &mut nodes);
            for n in nodes.iter().map(|&n| n as usize) {
                if !self.known[n] {
                    self.known[n] = true;
                    self.u[n] = membrane.obstacles.height(side, &self.grid.node(n));
                }
            }
        }
    }

    /// The state along the cuts, with the displacement as it is.
    pub(super) fn state(&mut self) -> &Equilibrium<2> {
        let (u, global) = (&self.u, &self.global);
        self.part.set_values(|i| u[global[i] as usize]);
        &self.part
    }

    /// The state of the whole membrane on its grid, around the zone of this level.
    pub(super) fn whole_state(&mut self, membrane: &Membrane<2>, zone: &PlaneZone) -> Equilibrium<2> {
        let quadrature = quadrature(membrane, zone);
        let unknowns = number(membrane, &quadrature);
        // Where regions share a node, each has an unknown of its own.
        let mut own: HashMap<(RegionId, u32), u32> = HashMap::new();
        let (cells, mut functions) = (&self.part.membrane.cells, Vec::new());
        for (cell, regions) in self.part.unknowns().cells.iter().enumerate() {
            cells.functions(cell, &mut functions);
            for (region, dofs) in regions {
                for (&dof, &f) in dofs.iter().zip(&functions) {
                    own.insert((*region, self.node_of_part[f as usize]), self.global[dof as usize]);
                }
            }
        }
        let mut values = vec![0.0; unknowns.count];
        for (cell, regions) in unknowns.cells.iter().enumerate() {
            membrane.cells.functions(cell, &mut functions);
            for (region, dofs) in regions {
                for (&dof, &node) in dofs.iter().zip(&functions) {
                    let at = own.get(&(*region, node)).copied().unwrap_or(node);
                    values[dof as usize] = self.u[at as usize];
                }
            }
        }
        let mut state = Equilibrium::unsolved(membrane.clone(), quadrature, unknowns);
        state.set_values(|i| values[i]);
        state
    }

    /// Calls `visit(unknown, node)` for every unknown that takes part.
    pub(super) fn for_each_active(&self, mut visit: impl FnMut(usize, usize)) {
        let w = self.width();
        for run in &self.runs {
            (run.begin..run.end).for_each(|i| visit(run.row * w + i, run.row * w + i));
        }
        for (&unknown, &node) in self.irregular.iter().zip(&self.node_of_irregular) {
            visit(unknown as usize, node as usize);
        }
    }

    /// Takes the displacement of a state on the same grid and around the same zone.
    pub(super) fn take(&mut self, state: &Equilibrium<2>) {
        let mut value = vec![f64::NAN; self.known.len()];
        let mut functions = Vec::new();
        for (cell, regions) in state.unknowns().cells.iter().enumerate() {
            state.membrane.cells.functions(cell, &mut functions);
            for (_, dofs) in regions {
                for (&dof, &f) in dofs.iter().zip(&functions) {
                    value[f as usize] = state.values()[dof as usize];
                }
            }
        }
        let mut u = std::mem::take(&mut self.u);
        self.for_each_active(|unknown, node| {
            if unknown < self.known.len() && value[node].is_finite() {
                u[unknown] = value[node];
            }
        });
        self.u = u;
    }

    /// Goes on from the displacement on the same grid around an earlier zone.
    pub(super) fn carry_on(&mut self, earlier: &Level) {
        let mut u = std::mem::take(&mut self.u);
        self.for_each_active(|unknown, node| u[unknown] = earlier.u[node]);
        self.u = u;
    }

    /// Begins with the displacement of the next coarser level: cubic where four neighbours in a line are known.
    pub(super) fn interpolate(&mut self, coarse: &Level) {
        let w = self.width();
        let mut u = std::mem::take(&mut self.u);
        self.for_each_active(|unknown, node| u[unknown] = coarse.interpolated(node % w, node / w));
        self.u = u;
    }

    /// The residual of a regular node.
    fn residual_at(&self, node: usize) -> f64 {
        self.b[node] - self.interior.row(node).map(|(j, v)| v * self.u[j]).sum::<f64>()
    }

    /// The largest residual relative to the largest right-hand side.
    pub fn relative_residual(&self) -> f64 {
        let largest = |v: &[f64]| v.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        largest(&self.residual()) / largest(&self.b).max(f64::MIN_POSITIVE)
    }

    /// The residual of all unknowns; zero where none take part.
    pub fn residual(&self) -> Vec<f64> {
        let mut r = vec![0.0; self.u.len()];
        self.interior.residual(&self.runs, &self.u, &self.b, &mut r);
        for (k, &i) in self.irregular.iter().enumerate() {
            r[i as usize] = self.residual_of_row(k);
        }
        r
    }

    /// Relaxes the regular nodes patch by patch, then solves for the band exactly.
    pub(super) fn relax(&mut self) -> Result<(), SolveError> {
        self.interior.relax(&self.vertices, &mut self.u, &self.b);
        self.relax_band()
    }

    /// Solves for the band exactly, the other nodes held.
    pub(super) fn relax_band(&mut self) -> Result<(), SolveError> {
        let Some(factor) = &self.factor else { return Ok(()) };
        let residual: Vec<f64> = self
            .band
            .iter()
            .map(|&(unknown, row)| match row {
                Some(k) => self.residual_of_row(k as usize),
                None => self.residual_at(unknown as usize),
            })
            .collect();
        let correction = factor.solve(&residual)?;
        for ((unknown, _), c) in self.band.iter().zip(&correction) {
            self.u[*unknown as usize] += c;
        }
        Ok(())
    }
}

/// The quadrature of a membrane around a zone.
fn quadrature(membrane: &Membrane<2>, zone: &PlaneZone) -> Quadrature<2> {
    match membrane.cells.degree() {
        1 => Quadrature::of_order(membrane, &Straightened(zone), ORDER),
        _ => Quadrature::new(membrane, zone),
    }
}

/// What a cell is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Outside,
    Free,
    Contact,
    /// Cut, or held along a side.
    Cut,
}

fn states(membrane: &Membrane<2>, zone: &PlaneZone) -> Vec<State> {
    let grid = &membrane.grid;
    let [nx, ny] = grid.cells();
    let status = &membrane.domain.status;
    let of = |region| if is_free(region) { State::Free } else { State::Contact };
    let mut state = vec![State::Outside; nx * ny];
    for j in 0..ny {
        zone.for_each_stretch(j, |begin, end, region| {
            for cell in j * nx + begin..j * nx + end {
                state[cell] = match status[cell] {
                    CellStatus::Outside => State::Outside,
                    CellStatus::Crossed => State::Cut,
                    CellStatus::Inside => of(region),
                };
            }
        });
    }
    for cell in zone.cells_near_fronts().filter(|&cell| status[cell] == CellStatus::Inside) {
        let fronts = zone.fronts_in(&grid.cell_box(cell));
        state[cell] = if fronts.sheets.is_empty() { of((fronts.region)(&[])) } else { State::Cut };
    }
    if membrane.domain.domain.is_fitted() {
        let rim = (0..nx).flat_map(|i| [i, (ny - 1) * nx + i]).chain((0..ny).flat_map(|j| [j * nx, j * nx + nx - 1]));
        rim.for_each(|cell| state[cell] = State::Cut);
    }
    state
}

/// The cells at most `reach` cells away from those in a state, without what lies outside.
fn around(grid: &Grid<2>, state: &[State], which: impl Fn(State) -> bool, reach: usize) -> Vec<usize> {
    let [nx, ny] = grid.cells();
    let mut found = vec![false; state.len()];
    for cell in (0..state.len()).filter(|&c| which(state[c])) {
        let (i, j) = (cell % nx, cell / nx);
        for v in j.saturating_sub(reach)..(j + reach + 1).min(ny) {
            found[v * nx + i.saturating_sub(reach)..v * nx + (i + reach + 1).min(nx)].fill(true);
        }
    }
    (0..state.len()).filter(|&c| found[c] && state[c] != State::Outside).collect()
}

/// The load on regular nodes.
fn load(membrane: &Membrane<2>, state: &[State], runs: &[Run], b: &mut [f64]) {
    let grid = &membrane.grid;
    let w = grid.node_counts()[0];
    let area: f64 = grid.cell_size().iter().product();
    if let (Some(f), 1) = (membrane.load.constant(), grid.degree()) {
        for run in runs {
            b[run.row * w + run.begin..run.row * w + run.end].fill(f * area);
        }
        return;
    }
    let mut regular = vec![false; b.len()];
    runs.iter().for_each(|r| regular[r.row * w + r.begin..r.row * w + r.end].fill(true));
    let (mut t, mut nodes) = (Tabulation::default(), Vec::new());
    for cell in (0..state.len()).filter(|&c| state[c] == State::Free || state[c] == State::Cut) {
        grid.cell_nodes(cell, &mut nodes);
        if !nodes.iter().any(|&n| regular[n as usize]) {
            continue;
        }
        for p in grid.rule(cell) {
            grid.tabulate(cell, &p.x, &mut t);
            let f = p.weight * membrane.load.value(&p.x);
            for (&n, v) in nodes.iter().zip(&t.value) {
                if regular[n as usize] {
                    b[n as usize] += f * v;
                }
            }
        }
    }
}
