//! One level: regular nodes, whose equations are never stored, and the bands along the cuts, where they are.

use super::band::{Band, quadrature};
use super::interior::Interior;
use super::runs::{Run, common, dilated, find, of_row, parts, runs};
use super::transfer::Interpolation;
use crate::domain::CellStatus;
use crate::equilibrium::{Equilibrium, number};
use crate::obstacle::Side;
use crate::plane_zone::PlaneZone;
use crate::problem::Membrane;
use crate::zone::{Division, Zone, contact_of, is_free};
use signorini_fem::cut::{QuadraturePoint, RegionId};
use signorini_fem::lagrange::Tabulation;
use signorini_fem::{Cells, Grid};
use signorini_geometry::Point;
use signorini_solve::SolveError;
use std::collections::HashMap;
use std::sync::Arc;

/// Cells in contact beside cut ones whose displacement is held.
const HELD: usize = 4;
/// Neighbouring cells of a cut one that belong to its band, and those whose nodes have stored rows.
const PART: usize = 2;
const STORED: usize = 1;

/// A membrane around a zone on one grid. Unknowns are the nodes of the grid, by their number there, and behind them further
/// ones for nodes that two free regions share.
pub struct Level {
    pub(super) grid: Grid<2>,
    interior: Arc<Interior>,
    pub(super) interpolation: Arc<Interpolation>,
    /// Regular nodes, and vertices whose patches are relaxed.
    pub(super) runs: Vec<Run>,
    vertices: Vec<Run>,
    pub(super) bands: Bands,
    counts: (usize, usize),
    /// Displacement and right-hand side of all unknowns.
    pub u: Vec<f64>,
    pub b: Vec<f64>,
    /// Nodes in contact near the fronts, where the displacement is known.
    in_contact: Vec<u32>,
}

/// The bands along the cuts.
pub(super) struct Bands {
    /// What lies along the edge of the membrane away from all fronts.
    held: Option<Arc<Band>>,
    /// All other cuts.
    moving: Band,
}

impl Bands {
    pub fn iter(&self) -> impl Iterator<Item = &Band> {
        self.held.iter().map(Arc::as_ref).chain([&self.moving])
    }
}

impl Level {
    /// The level of a membrane on its grid. Where `whole` says so its band holds all nodes: the coarsest level is solved.
    ///
    /// # Errors
    /// A band that cannot be factorised.
    pub fn new(membrane: &Membrane<2>, zone: &PlaneZone, whole: bool) -> Result<Self, SolveError> {
        let tension = membrane.tension.constant().unwrap_or(1.0);
        let interior = Arc::new(Interior::new(&membrane.grid, tension)?);
        let interpolation = Arc::new(Interpolation::new(&membrane.grid));
        Self::with(membrane, zone, whole, None, [Vec::new(), Vec::new()], interior, interpolation)
    }

    /// The same level around another zone, from the same displacement.
    ///
    /// # Errors
    /// A band that cannot be factorised.
    pub fn moved(&mut self, membrane: &Membrane<2>, zone: &PlaneZone) -> Result<(), SolveError> {
        let held = self.bands.held.take().filter(|_| zone.counts() == self.counts);
        let vectors = [std::mem::take(&mut self.u), std::mem::take(&mut self.b)];
        *self = Self::with(membrane, zone, false, held, vectors, self.interior.clone(), self.interpolation.clone())?;
        Ok(())
    }

    fn with(
        membrane: &Membrane<2>,
        zone: &PlaneZone,
        whole: bool,
        held: Option<Arc<Band>>,
        [mut u, mut b]: [Vec<f64>; 2],
        interior: Arc<Interior>,
        interpolation: Arc<Interpolation>,
    ) -> Result<Self, SolveError> {
        let grid = membrane.grid.clone();
        let [nx, ny] = grid.cells();
        let state = states(membrane, zone);
        let cut = runs(ny, nx, |i, j| state[j * nx + i] == State::Cut);
        let inner = dilated(&cut, STORED, [nx, ny]);
        let is_inner = |cell: usize| find(&inner, cell / nx, cell % nx).is_some();

        // Regular nodes have free cells on all sides, and no stored row.
        let mut plain = Vec::new();
        for row in 0..ny {
            let near = of_row(&inner, row);
            let ends = near.iter().map(|r| r.begin).chain([nx]);
            let begins = [0].into_iter().chain(near.iter().map(|r| r.end));
            for (from, to) in begins.zip(ends).filter(|(from, to)| from < to) {
                let here = &state[row * nx + from..row * nx + to];
                let found = runs(1, here.len(), |i, _| here[i] == State::Free);
                plain.extend(found.into_iter().map(|r| Run { row, begin: from + r.begin, end: from + r.end }));
            }
        }
        let p = grid.degree();
        let (mut nodes, mut vertices) = (Vec::new(), Vec::new());
        for row in 0..ny {
            if row > 0 {
                common(of_row(&plain, row - 1), of_row(&plain, row), |begin, end| {
                    if begin + 1 < end {
                        vertices.push(Run { row, begin: begin + 1, end });
                    }
                    nodes.push(Run { row: row * p, begin: begin * p + 1, end: end * p });
                });
            }
            for k in 1..p {
                let inside = |r: &Run| Run { row: row * p + k, begin: r.begin * p + 1, end: r.end * p };
                nodes.extend(of_row(&plain, row).iter().map(inside));
            }
        }
        nodes.retain(|r| r.begin < r.end);

        // Bands that no front comes near stay as they are when fronts move.
        let around = dilated(&cut, PART, [nx, ny]);
        let part = parts(&around);
        let mut moves = vec![whole; around.len()];
        for cell in zone.cells_near_fronts() {
            if let Some(at) = find(&around, cell / nx, cell % nx) {
                moves[part[at]] = true;
            }
        }
        let [fixed, moving] = [false, true].map(|wanted| {
            let own = around.iter().zip(&part).filter(|(_, part)| moves[**part] == wanted).map(|(r, _)| r);
            let cells = own.flat_map(|r| r.row * nx + r.begin..r.row * nx + r.end);
            cells.filter(|&cell| state[cell] != State::Outside).collect::<Vec<_>>()
        });
        let mut first = grid.node_count();
        let band = |cells, first, also: &[Run]| {
            let w = grid.node_counts()[0];
            let also = also.iter().flat_map(|r| r.row * w + r.begin..r.row * w + r.end);
            Band::new(membrane, zone, cells, is_inner, first, &interior, also)
        };
        let held = match held.filter(|band| band.cells() == fixed) {
            Some(band) => Some(band),
            None if fixed.is_empty() => None,
            None => Some(Arc::new(band(fixed, first, &[])?)),
        };
        first += held.as_ref().map_or(0, |band| band.more);
        let moving = band(moving, first, if whole { &nodes } else { &[] })?;

        u.resize(first + moving.more, 0.0);
        b.resize(first + moving.more, 0.0);
        load(membrane, &state, &nodes, &mut b);
        let mut level = Self {
            interpolation,
            interior,
            grid,
            runs: nodes,
            vertices,
            bands: Bands { held, moving },
            counts: zone.counts(),
            u,
            b,
            in_contact: Vec::new(),
        };
        level.bands.iter().for_each(|band| band.load(&mut level.b));
        for (unknown, node) in level.bands.moving.irregular().filter(|i| i.0 >= level.grid.node_count()) {
            level.u[unknown] = level.u[node];
        }
        level.hold_contact(membrane, &dilated(&cut, HELD, [nx, ny]), &state);
        Ok(level)
    }

    /// Number of unknowns that take part.
    pub fn unknowns(&self) -> usize {
        let irregular: usize = self.bands.iter().map(|band| band.irregular().len()).sum();
        irregular + self.runs.iter().map(|r| r.end - r.begin).sum::<usize>()
    }

    /// Unknowns that are solved for exactly in every sweep.
    pub fn band(&self) -> usize {
        self.bands.iter().map(Band::size).sum()
    }

    /// Nodes in a row of the grid.
    pub(super) fn width(&self) -> usize {
        self.grid.node_counts()[0]
    }

    /// Which unknowns take part.
    fn active(&self) -> Vec<bool> {
        let mut active = vec![false; self.u.len()];
        self.for_each_active(|unknown, _| active[unknown] = true);
        active
    }

    /// Of which nodes the displacement is known: those that take part, and those in contact near the fronts.
    pub(super) fn known(&self) -> Vec<bool> {
        let mut known = self.active();
        known.truncate(self.grid.node_count());
        self.in_contact.iter().for_each(|&node| known[node as usize] = true);
        known
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
        if !nodes.iter().all(|&n| find(&self.runs, n as usize / w, n as usize % w).is_some()) {
            return None;
        }
        let mut t = Tabulation::default();
        self.grid.tabulate(cell, x, &mut t);
        Some(nodes.iter().zip(&t.value).map(|(&n, v)| v * self.u[n as usize]).sum())
    }

    /// In contact the displacement is the height of what is touched. Only near the fronts is it ever needed: where these
    /// retreat, and to interpolate beside them.
    fn hold_contact(&mut self, membrane: &Membrane<2>, near: &[Run], state: &[State]) {
        let nx = self.grid.cells()[0];
        let (mut active, mut nodes) = (self.active(), Vec::new());
        for cell in near.iter().flat_map(|r| r.row * nx + r.begin..r.row * nx + r.end) {
            let State::Contact(side) = state[cell] else { continue };
            self.grid.cell_nodes(cell, &mut nodes);
            for &node in &nodes {
                if !std::mem::replace(&mut active[node as usize], true) {
                    self.in_contact.push(node);
                    self.u[node as usize] = membrane.obstacles.height(side, &self.grid.node(node as usize));
                }
            }
        }
    }

    /// The state along the cuts that fronts are near to, with the displacement as it is.
    pub(super) fn state(&mut self) -> &Equilibrium<2> {
        self.bands.moving.state(&self.u)
    }

    /// The state of the whole membrane on its grid, around the zone of this level.
    pub(super) fn whole_state(&self, membrane: &Membrane<2>, zone: &PlaneZone) -> Equilibrium<2> {
        let quadrature = quadrature(membrane, zone);
        let unknowns = number(membrane, &quadrature);
        // Where regions share a node, each has an unknown of its own.
        let mut own: HashMap<(RegionId, u32), u32> = HashMap::new();
        for band in self.bands.iter() {
            band.for_each_unknown(|region, node, unknown| {
                own.insert((region, node), unknown);
            });
        }
        let mut functions = Vec::new();
        let mut values = vec![0.0; unknowns.count];
        for (cell, region, dofs) in unknowns.all() {
            membrane.cells.functions(cell, &mut functions);
            for (&dof, &node) in dofs.iter().zip(&functions) {
                let at = own.get(&(region, node)).copied().unwrap_or(node);
                values[dof as usize] = self.u[at as usize];
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
        self.bands.iter().flat_map(Band::irregular).for_each(|(unknown, node)| visit(unknown, node));
    }

    /// Takes the displacement of a state on the same grid and around the same zone.
    pub(super) fn take(&mut self, state: &Equilibrium<2>) {
        let mut value = vec![f64::NAN; self.grid.node_count()];
        let mut functions = Vec::new();
        for (cell, _, dofs) in state.unknowns().all() {
            state.membrane.cells.functions(cell, &mut functions);
            for (&dof, &f) in dofs.iter().zip(&functions) {
                value[f as usize] = state.values()[dof as usize];
            }
        }
        let mut u = std::mem::take(&mut self.u);
        self.for_each_active(|unknown, node| {
            if unknown < value.len() && value[node].is_finite() {
                u[unknown] = value[node];
            }
        });
        self.u = u;
    }

    /// Begins with the displacement of the next coarser level: cubic where four neighbours in a line are known.
    pub(super) fn interpolate(&mut self, coarse: &Level) {
        let w = self.width();
        let known = coarse.known();
        let mut u = std::mem::take(&mut self.u);
        self.for_each_active(|unknown, node| u[unknown] = coarse.interpolated(&known, node % w, node / w));
        self.u = u;
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
        self.bands.iter().for_each(|band| band.residual(&self.u, &self.b, &mut r));
        r
    }

    /// Relaxes the regular nodes patch by patch, then solves for the bands exactly.
    pub(super) fn relax(&mut self) -> Result<(), SolveError> {
        self.interior.relax(&self.vertices, &mut self.u, &self.b);
        self.relax_bands()
    }

    /// Solves for the bands exactly, the other nodes held.
    pub(super) fn relax_bands(&mut self) -> Result<(), SolveError> {
        self.bands.iter().try_for_each(|band| band.relax(&self.interior, &mut self.u, &self.b))
    }
}

/// What a cell is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum State {
    Outside,
    Free,
    Contact(Side),
    /// Cut, or held along a side.
    Cut,
}

fn states(membrane: &Membrane<2>, zone: &PlaneZone) -> Vec<State> {
    let grid = &membrane.grid;
    let [nx, ny] = grid.cells();
    let status = &membrane.domain.status;
    let of = |region: RegionId| match contact_of(region) {
        Some((side, _)) => State::Contact(side),
        None if is_free(region) => State::Free,
        None => State::Outside,
    };
    let mut state = Vec::with_capacity(nx * ny);
    for j in 0..ny {
        zone.for_each_stretch(j, |begin, end, region| {
            let here = of(region);
            state.extend(status[j * nx + begin..j * nx + end].iter().map(|status| match status {
                CellStatus::Outside => State::Outside,
                CellStatus::Crossed => State::Cut,
                CellStatus::Inside => here,
            }));
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
    for run in runs {
        regular[run.row * w + run.begin..run.row * w + run.end].fill(true);
        b[run.row * w + run.begin..run.row * w + run.end].fill(0.0);
    }
    // Functions and weights are the same in all cells.
    let mut t = Tabulation::default();
    let at_point = |p: &QuadraturePoint<2>| {
        grid.tabulate(0, &p.x, &mut t);
        t.value.iter().map(|v| p.weight * v).collect::<Vec<f64>>()
    };
    let rule: Vec<Vec<f64>> = grid.rule(0).iter().map(at_point).collect();
    let in_cell = |cell: usize, out: &mut Vec<f64>| {
        out.fill(0.0);
        for (p, weights) in grid.rule(cell).iter().zip(&rule) {
            let f = membrane.load.value(&p.x);
            out.iter_mut().zip(weights).for_each(|(o, v)| *o += f * v);
        }
    };
    let (mut local, mut nodes) = (vec![0.0; grid.basis().len()], Vec::new());
    let even = membrane.load.constant().is_some();
    if even {
        in_cell(0, &mut local);
    }
    for cell in (0..state.len()).filter(|&c| state[c] == State::Free || state[c] == State::Cut) {
        grid.cell_nodes(cell, &mut nodes);
        if !nodes.iter().any(|&n| regular[n as usize]) {
            continue;
        }
        if !even {
            in_cell(cell, &mut local);
        }
        for (&n, f) in nodes.iter().zip(&local) {
            if regular[n as usize] {
                b[n as usize] += f;
            }
        }
    }
}
