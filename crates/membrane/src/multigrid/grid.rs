//! Levels on grids: regular nodes in runs, whose equations repeat from cell to cell and are never stored.

use super::interior::Interior;
use super::regular::{Ground, Layout, Regular, State};
use super::runs::{Run, common, dilated, find, of_row, parts, runs};
use super::transfer::{Interpolation, Line, combine, halfway};
use crate::domain::CellStatus;
use crate::plane_zone::PlaneZone;
use crate::problem::Membrane;
use crate::zone::Division;
use signorini_fem::cut::QuadraturePoint;
use signorini_fem::lagrange::Tabulation;
use signorini_fem::{Cells, Grid};
use signorini_geometry::Point;
use signorini_solve::SolveError;
use std::sync::Arc;

/// Cells along the longer side of the coarsest grid, below which all is solved for at once.
const COARSEST: usize = 16;

/// Cells in contact beside cut ones whose displacement is held.
const HELD: usize = 4;
/// Neighbouring cells of a cut one that belong to its band, and those whose nodes have stored rows.
const PART: usize = 2;
const STORED: usize = 1;

/// The regular nodes of a grid.
pub struct OnGrid {
    grid: Arc<Grid<2>>,
    interior: Interior,
    interpolation: Interpolation,
    /// Regular nodes, and vertices whose patches are relaxed.
    nodes: Vec<Run>,
    vertices: Vec<Run>,
}

impl OnGrid {
    /// Nodes in a row of the grid.
    fn width(&self) -> usize {
        self.grid.node_counts()[0]
    }

    /// The displacement at a node by that at nodes of the coarser grid, cubic where four neighbours in a line are known.
    fn by_cubics(&self, coarse: &Self, u: &[f64], known: &[bool], i: usize, j: usize) -> f64 {
        let [w, rows] = coarse.grid.node_counts();
        let at = |ic: isize, jc: isize| -> Option<f64> {
            let inside = (0..w as isize).contains(&ic) && (0..rows as isize).contains(&jc);
            let node = if inside { jc as usize * w + ic as usize } else { return None };
            known[node].then(|| u[node])
        };
        let (ic, jc) = ((i / 2) as isize, (j / 2) as isize);
        let along = |jc: isize| -> Option<f64> {
            if i.is_multiple_of(2) {
                return at(ic, jc);
            }
            let four = [-1, 0, 1, 2].map(|k| at(ic + k, jc));
            (four[1].is_some() || four[2].is_some()).then(|| halfway(four))
        };
        if j.is_multiple_of(2) { along(jc).unwrap_or(0.0) } else { halfway([-1, 0, 1, 2].map(|k| along(jc + k))) }
    }

    /// That by the functions of the coarser grid; where the displacement at some nodes is unknown by the others.
    fn by_functions(&self, coarse: &Self, u: &[f64], known: &[bool], i: usize, j: usize) -> f64 {
        let w = coarse.width();
        let (mut sum, mut weight) = (0.0, 0.0);
        for (jc, y) in self.interpolation.at_fine(j) {
            for (ic, x) in self.interpolation.at_fine(i) {
                if known[jc * w + ic] {
                    sum += x * y * u[jc * w + ic];
                    weight += x * y;
                }
            }
        }
        if weight > 0.5 { sum / weight } else { 0.0 }
    }
}

impl Regular for OnGrid {
    type Cells = Grid<2>;

    fn is_able<const D: usize>(membrane: &Membrane<D>) -> bool {
        let fits =
            |grid: &Grid<D>| grid.cells() == membrane.grid.cells() && membrane.cells.count() == grid.cell_count();
        membrane.cells.as_grid().is_some_and(fits) && membrane.grid.cells().iter().all(|n| can_be_halved(*n))
    }

    fn grounds(membrane: &Membrane<2>) -> Vec<Ground<Grid<2>>> {
        let mut list: Vec<Grid<2>> = membrane.cells.as_grid().cloned().into_iter().collect();
        while let Some(last) = list.last()
            && last.cells().iter().all(|n| can_be_halved(*n))
        {
            let coarser = Grid::new(*last.bounds(), last.cells().map(|n| n / 2), last.degree());
            list.push(coarser);
        }
        list.into_iter().rev().map(|grid| Ground { cells: Arc::new(grid.clone()), grid, domain: None }).collect()
    }

    fn new(membrane: &Membrane<2>, grid: &Arc<Grid<2>>) -> Result<Self, SolveError> {
        Ok(Self {
            interior: Interior::new(grid, &*membrane.tension)?,
            interpolation: Interpolation::new(grid),
            grid: grid.clone(),
            nodes: Vec::new(),
            vertices: Vec::new(),
        })
    }

    fn lay_out(&mut self, membrane: &Membrane<2>, zone: &PlaneZone, whole: bool) -> Layout {
        let [nx, ny] = self.grid.cells();
        let state = states(membrane, zone);
        let cut = runs(ny, nx, |i, j| state[j * nx + i] == State::Cut);
        let inner = dilated(&cut, STORED, [nx, ny]);

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
        let p = self.grid.degree();
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
        let [held, moving] = [false, true].map(|wanted| {
            let own = around.iter().zip(&part).filter(|(_, part)| moves[**part] == wanted).map(|(r, _)| r);
            members(own, nx).filter(|&cell| state[cell] != State::Outside).collect::<Vec<_>>()
        });
        let near = dilated(&cut, HELD, [nx, ny]);
        let contact = members(near.iter(), nx).filter_map(|cell| match state[cell] {
            State::Contact(side) => Some((cell, side)),
            _ => None,
        });
        let contact = contact.collect();
        (self.nodes, self.vertices) = (nodes, vertices);
        let mut also = Vec::new();
        if whole {
            self.for_each(|node| also.push(node));
        }
        Layout { held, moving, inner: members(inner.iter(), nx).collect(), also, contact }
    }

    fn count(&self) -> usize {
        self.nodes.iter().map(|r| r.end - r.begin).sum()
    }

    fn contains(&self, node: usize) -> bool {
        let w = self.width();
        find(&self.nodes, node / w, node % w).is_some()
    }

    fn position(&self, node: usize) -> Option<Point<2>> {
        Some(self.grid.node(node))
    }

    fn for_each(&self, mut visit: impl FnMut(usize)) {
        members(self.nodes.iter(), self.width()).for_each(&mut visit);
    }

    fn row(&self, node: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.interior.row(node)
    }

    fn load(&self, membrane: &Membrane<2>, b: &mut [f64]) {
        let (grid, w, runs) = (&self.grid, self.width(), &self.nodes);
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
        for cell in 0..grid.cell_count() {
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

    fn residual(&self, u: &[f64], b: &[f64], r: &mut [f64]) {
        self.interior.residual(&self.nodes, u, b, r);
    }

    fn relax(&self, u: &mut [f64], b: &[f64]) {
        self.interior.relax(&self.vertices, u, b);
    }

    fn first_guess(&self, node: usize, coarse: &Self, u: &[f64], known: &[bool]) -> f64 {
        let (i, j) = (node % self.width(), node / self.width());
        match self.grid.degree() {
            1 => self.by_cubics(coarse, u, known, i, j),
            _ => self.by_functions(coarse, u, known, i, j),
        }
    }

    fn add_correction(&self, coarse: &[f64], others: impl Iterator<Item = usize>, u: &mut [f64]) {
        let w = self.width();
        let wc = w / 2 + 1;
        let table = &self.interpolation;
        let across = |j: usize, line: &mut [f64]| combine(table.at_fine(j), coarse, line);
        let mut line = Line::new(wc);
        for run in &self.nodes {
            let line = line.of(run.row, across);
            for i in run.begin..run.end {
                u[run.row * w + i] += table.at_fine(i).map(|(ic, x)| x * line[ic]).sum::<f64>();
            }
        }
        for node in others {
            let (i, j) = (node % w, node / w);
            let along = |jc: usize| table.at_fine(i).map(|(ic, x)| x * coarse[jc * wc + ic]).sum::<f64>();
            u[node] += table.at_fine(j).map(|(jc, y)| y * along(jc)).sum::<f64>();
        }
    }

    fn restrict(&self, r: &[f64], coarse: &Self, others: impl Iterator<Item = usize>, b: &mut [f64]) {
        let (w, wc) = (self.width(), coarse.width());
        let (table, rows) = (&self.interpolation, self.grid.node_counts()[1]);
        let across = |j: usize, line: &mut [f64]| combine(table.at_coarse(j, rows), r, line);
        let mut line = Line::new(w);
        for run in &coarse.nodes {
            let line = line.of(run.row, across);
            for i in run.begin..run.end {
                b[run.row * wc + i] = table.at_coarse(i, w).map(|(i, x)| x * line[i]).sum();
            }
        }
        for node in others {
            let (i, j) = (node % wc, node / wc);
            let along = |jf: usize| table.at_coarse(i, w).map(|(i, x)| x * r[jf * w + i]).sum::<f64>();
            b[node] = table.at_coarse(j, rows).map(|(jf, y)| y * along(jf)).sum();
        }
    }
}

/// The members of runs, by number.
fn members<'a>(set: impl Iterator<Item = &'a Run>, width: usize) -> impl Iterator<Item = usize> {
    set.flat_map(move |r| r.row * width + r.begin..r.row * width + r.end)
}

fn states(membrane: &Membrane<2>, zone: &PlaneZone) -> Vec<State> {
    let grid = &membrane.grid;
    let [nx, ny] = grid.cells();
    let status = &membrane.domain.status;
    let mut state = Vec::with_capacity(nx * ny);
    for j in 0..ny {
        zone.for_each_stretch(j, |begin, end, region| {
            let here = State::of(region);
            state.extend(status[j * nx + begin..j * nx + end].iter().map(|status| match status {
                CellStatus::Outside => State::Outside,
                CellStatus::Crossed => State::Cut,
                CellStatus::Inside => here,
            }));
        });
    }
    for cell in zone.cells_near_fronts().filter(|&cell| status[cell] == CellStatus::Inside) {
        let fronts = zone.fronts_in(&grid.cell_box(cell));
        state[cell] = if fronts.sheets.is_empty() { State::of((fronts.region)(&[])) } else { State::Cut };
    }
    if membrane.domain.domain.is_fitted() {
        let rim = (0..nx).flat_map(|i| [i, (ny - 1) * nx + i]).chain((0..ny).flat_map(|j| [j * nx, j * nx + nx - 1]));
        rim.for_each(|cell| state[cell] = State::Cut);
    }
    state
}

/// Whether so many cells may be those of a grid with a coarser one.
fn can_be_halved(cells: usize) -> bool {
    cells.is_multiple_of(2) && cells / 2 >= COARSEST
}
