//! Levels on meshes, each with every cell of the coarser one divided into four: the equations are stored, and relaxed one
//! node after the other, those that share none first. A level of higher degree has that of degree 1 on its own mesh below it,
//! and is relaxed patch by patch.

use super::patches::Patches;
use super::regular::{Ground, Layout, Regular, State};
use super::rows::Rows;
use super::runs::{join, root_of};
use crate::domain::{Domain, MeshDomain};
use crate::plane_zone::PlaneZone;
use crate::problem::Membrane;
use crate::zone::Division;
use rayon::prelude::*;
use signorini_fem::cell_parts::PARTS;
use signorini_fem::{Cells, CellsPart, Grid, MeshCells};
use signorini_geometry::{Aabb, Point};
use signorini_solve::SolveError;
use std::collections::HashSet;
use std::sync::Arc;

/// Cells in contact, counted across sides from cut ones, whose displacement is held.
const HELD: usize = 6;

/// Nodes whose residuals are worked out at once.
const CHUNK: usize = 1024;

/// The regular nodes of a mesh.
pub struct OnMesh {
    cells: Arc<MeshCells>,
    rows: Rows,
    /// The load on the membrane without cuts.
    load: Vec<f64>,
    /// All nodes, colour by colour: those of one colour are no neighbours.
    order: Vec<u32>,
    /// Those that are regular.
    nodes: Vec<u32>,
    regular: Vec<bool>,
    /// At higher degree.
    higher: Option<Higher>,
}

/// What functions of higher degree need.
struct Higher {
    patches: Patches,
    /// For each function that of its vertex on the level below.
    below: Vec<Option<u32>>,
}

impl OnMesh {
    /// The functions of the next coarser level whose mean a function is where those are; none where it is nothing there.
    fn parents(&self, node: usize) -> Option<[u32; 4]> {
        match &self.higher {
            Some(higher) => higher.below[node].map(|n| [n; 4]),
            None => self.cells.parent().map(|parent| parent.nodes[node]),
        }
    }
}

impl Regular for OnMesh {
    type Cells = MeshCells;

    fn is_able<const D: usize>(membrane: &Membrane<D>) -> bool {
        membrane.cells.clone().mesh().is_some_and(|mesh| mesh.parent().is_some())
    }

    fn grounds(membrane: &Membrane<2>) -> Vec<Ground<MeshCells>> {
        let finest = membrane.cells.clone().mesh().into_iter();
        let mut list: Vec<_> =
            finest.map(|cells| Ground { grid: membrane.grid.clone(), cells, domain: None }).collect();
        let below = |cells: &MeshCells| match cells.degree() {
            1 => cells.parent().map(|parent| parent.cells.clone()),
            _ => Some(Arc::new(cells.of_degree_one())),
        };
        while let Some(cells) = list.last().and_then(|ground| below(&ground.cells)) {
            let domain: Arc<dyn Domain<2>> = Arc::new(MeshDomain(cells.clone()));
            list.push(Ground { grid: cells.grid(), domain: Some(domain), cells });
        }
        list.reverse();
        list
    }

    fn new(membrane: &Membrane<2>, cells: &Arc<MeshCells>) -> Result<Self, SolveError> {
        let rows = Rows::new(cells, &*membrane.tension);
        let mut load = vec![0.0; cells.function_count()];
        let mut functions = Vec::new();
        for cell in 0..cells.count() {
            cells.functions(cell, &mut functions);
            match membrane.load.constant().filter(|_| cells.degree() == 1 && cells.is_straight(cell)) {
                Some(f) => functions.iter().for_each(|&n| load[n as usize] += f * cells.volume(cell) / 3.0),
                None => cells.for_each_point(cell, &mut |p, t| {
                    let f = p.weight * membrane.load.value(&p.x);
                    functions.iter().zip(&t.value).for_each(|(&n, v)| load[n as usize] += f * v);
                }),
            }
        }
        let regular = vec![false; load.len()];
        let (higher, order) = match cells.degree() {
            1 => (None, rows.colours()),
            _ => {
                let higher = Higher { patches: Patches::new(cells, &rows)?, below: cells.functions_of_degree_one() };
                (Some(higher), (0..load.len() as u32).collect())
            }
        };
        Ok(Self { cells: cells.clone(), rows, regular, load, order, nodes: Vec::new(), higher })
    }

    fn lay_out(&mut self, _: &Membrane<2>, zone: &PlaneZone, whole: bool) -> Layout {
        let cells = &*self.cells;
        let near = Near::new(zone);
        let state = states(cells, zone, &near);
        // Nodes of cut cells and of those across a side have stored rows: so far the ghost penalty reaches.
        let mut inner: Vec<usize> = Vec::new();
        for cell in (0..state.len()).filter(|&cell| state[cell] == State::Cut) {
            inner.push(cell);
            inner.extend(cells.beside(cell));
        }
        inner.sort_unstable();
        inner.dedup();
        let mut functions = Vec::new();
        let mut stored = vec![false; self.regular.len()];
        for &cell in &inner {
            cells.functions(cell, &mut functions);
            functions.iter().for_each(|&n| stored[n as usize] = true);
        }
        // The bands are all cells that have such a node: round a node cells come one across a side of the other.
        let mut around = inner.clone();
        let mut seen: HashSet<usize> = inner.iter().copied().collect();
        let mut at = 0;
        while at < around.len() {
            for cell in cells.beside(around[at]) {
                cells.functions(cell, &mut functions);
                if functions.iter().any(|&n| stored[n as usize]) && seen.insert(cell) {
                    around.push(cell);
                }
            }
            at += 1;
        }
        around.sort_unstable();
        self.regular.fill(true);
        for cell in (0..state.len()).filter(|&cell| state[cell] != State::Free) {
            cells.functions(cell, &mut functions);
            functions.iter().for_each(|&n| self.regular[n as usize] = false);
        }
        self.regular.iter_mut().zip(&stored).for_each(|(regular, stored)| *regular &= !stored);
        let regular = &self.regular;
        self.nodes.clear();
        self.nodes.extend(self.order.iter().filter(|n| regular[**n as usize]));

        // Bands that no front comes near stay as they are when fronts move. Cells that share a node are in one band.
        let part = CellsPart::new(self.cells.clone(), around.clone());
        let mut root: Vec<usize> = (0..part.function_count()).collect();
        for k in 0..part.count() {
            part.functions(k, &mut functions);
            functions.iter().for_each(|&n| join(&mut root, functions[0] as usize, n as usize));
        }
        let mut band_of = |k: usize| {
            part.functions(k, &mut functions);
            root_of(&mut root, functions[0] as usize)
        };
        let mut moves = vec![whole; part.function_count()];
        for (k, _) in around.iter().enumerate().filter(|(_, cell)| near.touches(&cells.bounds_of(**cell))) {
            moves[band_of(k)] = true;
        }
        let (mut held, mut moving) = (Vec::new(), Vec::new());
        for (k, &cell) in around.iter().enumerate() {
            if moves[band_of(k)] { moving.push(cell) } else { held.push(cell) }
        }

        // Contact a few cells deep.
        let mut seen: HashSet<usize> = inner.iter().copied().collect();
        let mut front = inner.clone();
        let mut contact = Vec::new();
        for _ in 0..HELD {
            for &cell in &front {
                if let State::Contact(side) = state[cell] {
                    contact.push((cell, side));
                }
            }
            let next = front.iter().flat_map(|&cell| cells.beside(cell)).filter(|cell| seen.insert(*cell));
            front = next.collect();
        }
        let also = if whole { self.nodes.iter().map(|n| *n as usize).collect() } else { Vec::new() };
        Layout { held, moving, inner, also, contact }
    }

    fn count(&self) -> usize {
        self.nodes.len()
    }

    fn contains(&self, node: usize) -> bool {
        self.regular[node]
    }

    fn position(&self, node: usize) -> Option<Point<2>> {
        let is_value = self.higher.as_ref().is_none_or(|higher| higher.below[node].is_some());
        is_value.then(|| self.cells.node(node))
    }

    fn for_each(&self, visit: impl FnMut(usize)) {
        self.nodes.iter().map(|n| *n as usize).for_each(visit);
    }

    fn row(&self, node: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        [(node, self.rows.diagonal[node])].into_iter().chain(self.rows.others(node))
    }

    fn load(&self, _: &Membrane<2>, b: &mut [f64]) {
        b[..self.load.len()].copy_from_slice(&self.load);
    }

    fn residual(&self, u: &[f64], b: &[f64], r: &mut [f64]) {
        let nodes = self.regular.len();
        r[..nodes].par_chunks_mut(CHUNK).enumerate().for_each(|(chunk, r)| {
            for (node, r) in (chunk * CHUNK..).zip(r) {
                if self.regular[node] {
                    *r = b[node] - self.rows.diagonal[node] * u[node] - self.rows.sum(node, u);
                }
            }
        });
    }

    fn relax(&self, u: &mut [f64], b: &[f64]) {
        if let Some(Higher { patches, below }) = &self.higher {
            let mut scratch = Vec::new();
            for vertex in self.nodes.iter().map(|n| *n as usize).filter(|n| below[*n].is_some()) {
                patches.relax(vertex, &self.rows, u, b, &mut scratch);
            }
            return;
        }
        for node in self.nodes.iter().map(|n| *n as usize) {
            u[node] = (b[node] - self.rows.sum(node, u)) / self.rows.diagonal[node];
        }
    }

    fn first_guess(&self, node: usize, _: &Self, u: &[f64], known: &[bool]) -> f64 {
        let Some(parents) = self.parents(node) else { return 0.0 };
        let of = parents.iter().map(|n| *n as usize).filter(|n| known[*n]);
        let (count, sum) = of.fold((0.0, 0.0), |(count, sum), n| (count + 1.0, sum + u[n]));
        if count > 0.0 { sum / count } else { 0.0 }
    }

    fn add_correction(&self, coarse: &[f64], others: impl Iterator<Item = usize>, u: &mut [f64]) {
        let correction = |node: usize| {
            self.parents(node).map_or(0.0, |parents| 0.25 * parents.iter().map(|n| coarse[*n as usize]).sum::<f64>())
        };
        for (node, u) in u[..self.regular.len()].iter_mut().enumerate().filter(|(node, _)| self.regular[*node]) {
            *u += correction(node);
        }
        others.for_each(|node| u[node] += correction(node));
    }

    fn restrict(&self, r: &[f64], _: &Self, _: impl Iterator<Item = usize>, b: &mut [f64]) {
        // What goes to nodes that take no part is never looked at.
        for (node, r) in r[..self.regular.len()].iter().enumerate() {
            self.parents(node).into_iter().flatten().for_each(|n| b[n as usize] += 0.25 * r);
        }
    }
}

/// Which parts of the plane fronts are near to.
pub struct Near<'a> {
    grid: &'a Grid<2>,
    /// For each corner of the grid of a zone, cells near fronts to the left of it and below.
    sums: Vec<u32>,
}

impl<'a> Near<'a> {
    pub fn new(zone: &'a PlaneZone) -> Self {
        let grid = zone.grid();
        let [columns, rows] = grid.cells();
        let mut sums = vec![0u32; (columns + 1) * (rows + 1)];
        let mut cells = zone.cells_near_fronts().peekable();
        for row in 0..rows {
            let mut here = 0;
            for column in 0..columns {
                here += u32::from(cells.next_if_eq(&(row * columns + column)).is_some());
                let above = (row + 1) * (columns + 1) + column + 1;
                sums[above] = sums[above - columns - 1] + here;
            }
        }
        Self { grid, sums }
    }

    /// Whether fronts are near to a box, or may be.
    pub fn touches(&self, b: &Aabb<2>) -> bool {
        let width = self.grid.cells()[0] + 1;
        let [low, high] = [b.min, b.max].map(|x| self.grid.cell_index(self.grid.cell_containing(&x)));
        let to = |i: usize, j: usize| self.sums[j * width + i];
        to(high[0] + 1, high[1] + 1) + to(low[0], low[1]) > to(high[0] + 1, low[1]) + to(low[0], high[1] + 1)
    }
}

/// What each cell is. Where no front is near to a cell of a coarser mesh, all its parts are the same.
fn states(cells: &MeshCells, zone: &PlaneZone, near: &Near) -> Vec<State> {
    let mut meshes = vec![cells];
    while let Some(parent) = meshes.last().and_then(|mesh| mesh.parent()) {
        meshes.push(&parent.cells);
    }
    let mut state = vec![State::Free; cells.count()];
    let coarsest = meshes.len() - 1;
    let mut open: Vec<(usize, usize)> = (0..meshes[coarsest].count()).map(|cell| (coarsest, cell)).collect();
    while let Some((level, cell)) = open.pop() {
        let b = meshes[level].bounds_of(cell);
        if !near.touches(&b) {
            let parts = PARTS.pow(level as u32);
            let region = zone.region_away(near.grid.cell_containing(&b.center()));
            state[cell * parts..(cell + 1) * parts].fill(State::of(region));
        } else if level > 0 {
            open.extend((0..PARTS).map(|part| (level - 1, PARTS * cell + part)));
        } else {
            let fronts = zone.fronts_in(&b);
            state[cell] = if fronts.sheets.is_empty() { State::of((fronts.region)(&[])) } else { State::Cut };
        }
    }
    for side in cells.boundary_sides() {
        state[side.cell] = State::Cut;
    }
    state
}
