//! One level: regular nodes, whose equations no zone changes, and the bands along the cuts, where they are stored.

use super::band::{Band, quadrature};
use super::regular::{Ground, Layout, Regular};
use crate::equilibrium::Equilibrium;
use crate::equilibrium::unknowns::number;
use crate::plane_zone::PlaneZone;
use crate::problem::Membrane;
use crate::zone::Zone;
use signorini_fem::cut::RegionId;
use signorini_fem::lagrange::Tabulation;
use signorini_fem::{Cells, CellsPart};
use signorini_geometry::Point;
use signorini_solve::SolveError;
use std::collections::HashMap;
use std::sync::Arc;

/// A membrane around a zone on one level. Unknowns are the nodes, by their numbers, and behind them further ones for nodes
/// that two free regions share.
pub struct Level<R: Regular> {
    cells: Arc<R::Cells>,
    regular: R,
    bands: Bands,
    counts: (usize, usize),
    /// Displacement and right-hand side of all unknowns.
    pub u: Vec<f64>,
    pub b: Vec<f64>,
    /// What the equations leave, as it was last asked for.
    left: Vec<f64>,
    /// Nodes in contact near the fronts, where the displacement is known.
    in_contact: Vec<u32>,
}

/// The bands along the cuts.
struct Bands {
    /// What lies along the edge of the membrane away from all fronts.
    held: Option<Arc<Band>>,
    /// All other cuts.
    moving: Band,
}

impl Bands {
    /// Those of a layout; the one that is held may be at hand.
    fn new<R: Regular>(
        cells: &Arc<R::Cells>,
        regular: &R,
        membrane: &Membrane<2>,
        zone: &PlaneZone,
        layout: &Layout,
        held: Option<Arc<Band>>,
    ) -> Result<Self, SolveError> {
        let part = |own: &[usize]| CellsPart::new(cells.clone(), own.to_vec());
        let nodes = cells.function_count();
        let held = match held.filter(|band| band.cells() == layout.held) {
            Some(band) => Some(band),
            None if layout.held.is_empty() => None,
            None => Some(Arc::new(Band::new(membrane, zone, part(&layout.held), &layout.inner, nodes, regular, &[])?)),
        };
        let first = nodes + held.as_ref().map_or(0, |band| band.more);
        let moving = part(&layout.moving);
        let moving = Band::new(membrane, zone, moving, &layout.inner, first, regular, &layout.also)?;
        Ok(Self { held, moving })
    }

    fn iter(&self) -> impl Iterator<Item = &Band> {
        self.held.iter().map(Arc::as_ref).chain([&self.moving])
    }

    /// Unknowns with stored rows, and their nodes.
    fn irregular(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        self.iter().flat_map(Band::irregular)
    }

    /// Nodes with stored rows, but for those behind so many: unknowns there belong to a band alone.
    fn nodes(&self, count: usize) -> impl Iterator<Item = usize> + '_ {
        self.irregular().map(|(unknown, _)| unknown).filter(move |unknown| *unknown < count)
    }
}

impl<R: Regular> Level<R> {
    /// The level of a membrane on its cells. Where `whole` says so its band holds all nodes: the coarsest level is solved.
    ///
    /// # Errors
    /// A band that cannot be factorised.
    pub fn new(
        membrane: &Membrane<2>,
        ground: &Ground<R::Cells>,
        zone: &PlaneZone,
        whole: bool,
    ) -> Result<Self, SolveError> {
        let cells = ground.cells.clone();
        let mut regular = R::new(membrane, &cells)?;
        let layout = regular.lay_out(membrane, zone, whole);
        let bands = Bands::new(&cells, &regular, membrane, zone, &layout, None)?;
        let [u, b, left] = [Vec::new(), Vec::new(), Vec::new()];
        let mut level = Self { cells, regular, bands, counts: zone.counts(), u, b, left, in_contact: Vec::new() };
        level.prepare(membrane, &layout);
        Ok(level)
    }

    /// The same level around another zone, from the same displacement.
    ///
    /// # Errors
    /// A band that cannot be factorised.
    pub fn moved(&mut self, membrane: &Membrane<2>, zone: &PlaneZone) -> Result<(), SolveError> {
        let held = self.bands.held.take().filter(|_| zone.counts() == self.counts);
        let layout = self.regular.lay_out(membrane, zone, false);
        self.bands = Bands::new(&self.cells, &self.regular, membrane, zone, &layout, held)?;
        self.counts = zone.counts();
        self.prepare(membrane, &layout);
        Ok(())
    }

    /// Puts the load in its place, and the displacement where it is known or new.
    fn prepare(&mut self, membrane: &Membrane<2>, layout: &Layout) {
        let nodes = self.cells.function_count();
        let more: usize = self.bands.iter().map(|band| band.more).sum();
        self.u.resize(nodes + more, 0.0);
        self.b.resize(nodes + more, 0.0);
        self.regular.load(membrane, &mut self.b);
        self.bands.iter().for_each(|band| band.load(&mut self.b));
        for (unknown, node) in self.bands.moving.irregular().filter(|i| i.0 >= nodes) {
            self.u[unknown] = self.u[node];
        }
        // In contact the displacement is the height of what is touched. Only near the fronts is it ever needed: where these
        // retreat, and to interpolate beside them.
        self.in_contact.clear();
        let (mut taken, mut functions) = (self.active(), Vec::new());
        for &(cell, side) in &layout.contact {
            self.cells.functions(cell, &mut functions);
            for &node in &functions {
                if !std::mem::replace(&mut taken[node as usize], true) {
                    self.in_contact.push(node);
                    let height = |x: Point<2>| membrane.obstacles.height(side, &x);
                    self.u[node as usize] = self.regular.position(node as usize).map_or(0.0, height);
                }
            }
        }
    }

    /// Number of unknowns that take part.
    pub fn unknowns(&self) -> usize {
        self.bands.iter().map(|band| band.irregular().len()).sum::<usize>() + self.regular.count()
    }

    /// Unknowns that are solved for exactly in every sweep.
    pub fn band(&self) -> usize {
        self.bands.iter().map(Band::size).sum()
    }

    /// Which unknowns take part.
    fn active(&self) -> Vec<bool> {
        let mut active = vec![false; self.u.len()];
        self.for_each_active(|unknown, _| active[unknown] = true);
        active
    }

    /// Of which nodes the displacement is known: those that take part, and those in contact near the fronts.
    fn known(&self) -> Vec<bool> {
        let mut known = self.active();
        known.truncate(self.cells.function_count());
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
        let cell = self.cells.containing(x)?;
        let mut nodes = Vec::new();
        self.cells.functions(cell, &mut nodes);
        if !nodes.iter().all(|&n| self.regular.contains(n as usize)) {
            return None;
        }
        let mut t = Tabulation::default();
        self.cells.tabulate(cell, x, &mut t);
        Some(nodes.iter().zip(&t.value).map(|(&n, v)| v * self.u[n as usize]).sum())
    }

    /// The state along the cuts that fronts are near to, with the displacement as it is.
    pub(super) fn state(&mut self) -> &Equilibrium<2> {
        self.bands.moving.state(&self.u)
    }

    /// The state of the whole membrane on its cells, around the zone of this level.
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
    fn for_each_active(&self, mut visit: impl FnMut(usize, usize)) {
        self.regular.for_each(|node| visit(node, node));
        self.bands.irregular().for_each(|(unknown, node)| visit(unknown, node));
    }

    /// Takes the displacement of a state on the same cells and around the same zone.
    pub(super) fn take(&mut self, state: &Equilibrium<2>) {
        let mut value = vec![f64::NAN; self.cells.function_count()];
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

    /// Begins with the displacement of the next coarser level.
    pub(super) fn interpolate(&mut self, coarse: &Self) {
        let known = coarse.known();
        let mut u = std::mem::take(&mut self.u);
        self.for_each_active(|unknown, node| {
            u[unknown] = self.regular.first_guess(node, &coarse.regular, &coarse.u, &known);
        });
        self.u = u;
    }

    /// Adds the displacement of a coarser level, interpolated, to the nodes that take part.
    pub(super) fn add_correction(&mut self, coarse: &Self) {
        let others = self.bands.nodes(self.cells.function_count());
        self.regular.add_correction(&coarse.u, others, &mut self.u);
    }

    /// Makes the residual the right-hand side of a coarser level, by the transpose of the interpolation.
    pub(super) fn restrict_residual(&mut self, coarse: &mut Self) {
        self.find_residual();
        let others = coarse.bands.nodes(coarse.cells.function_count());
        coarse.b.fill(0.0);
        self.regular.restrict(&self.left, &coarse.regular, others, &mut coarse.b);
    }

    /// The largest residual relative to the largest right-hand side.
    pub fn relative_residual(&mut self) -> f64 {
        let largest = |v: &[f64]| v.iter().fold(0.0f64, |m, x| m.max(x.abs()));
        largest(self.residual()) / largest(&self.b).max(f64::MIN_POSITIVE)
    }

    /// The residual of all unknowns; zero where none take part.
    pub fn residual(&mut self) -> &[f64] {
        self.find_residual();
        &self.left
    }

    fn find_residual(&mut self) {
        self.left.clear();
        self.left.resize(self.u.len(), 0.0);
        self.regular.residual(&self.u, &self.b, &mut self.left);
        self.bands.iter().for_each(|band| band.residual(&self.u, &self.b, &mut self.left));
    }

    /// Relaxes the regular nodes, then solves for the bands exactly.
    pub(super) fn relax(&mut self) -> Result<(), SolveError> {
        self.regular.relax(&mut self.u, &self.b);
        self.relax_bands()
    }

    /// Solves for the bands exactly, the other nodes held.
    pub(super) fn relax_bands(&mut self) -> Result<(), SolveError> {
        self.bands.iter().try_for_each(|band| band.relax(&self.regular, &mut self.u, &self.b))
    }
}
