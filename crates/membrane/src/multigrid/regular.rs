//! What a level needs to know away from the cuts: where it is regular, the equations there, and the way between levels.

use crate::domain::{Domain, DomainOnCells};
use crate::obstacle::Side;
use crate::plane_zone::PlaneZone;
use crate::problem::Membrane;
use crate::zone::{contact_of, is_free};
use signorini_fem::cut::RegionId;
use signorini_fem::{CellByCell, Grid};
use signorini_geometry::Point;
use signorini_solve::SolveError;
use std::sync::Arc;

/// Cells of one level, and the grid on which zones are told apart there.
pub struct Ground<C> {
    pub grid: Grid<2>,
    pub cells: Arc<C>,
    /// The domain, where it is that of the cells.
    pub domain: Option<Arc<dyn Domain<2>>>,
}

impl<C: CellByCell<2> + 'static> Ground<C> {
    /// Whether these are the cells of a membrane.
    pub fn is_of(&self, membrane: &Membrane<2>) -> bool {
        self.cells.function_count() == membrane.cells.function_count()
    }

    /// The same membrane on these cells.
    pub fn membrane(&self, membrane: &Membrane<2>) -> Membrane<2> {
        if self.is_of(membrane) {
            return membrane.clone();
        }
        let domain = self.domain.as_ref().unwrap_or(&membrane.domain.domain);
        Membrane {
            grid: self.grid.clone(),
            domain: DomainOnCells::new(domain.clone(), &*self.cells),
            cells: self.cells.clone(),
            ..membrane.clone()
        }
    }
}

/// What a cell is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum State {
    Outside,
    Free,
    Contact(Side),
    /// Cut, or held along a side.
    Cut,
}

impl State {
    /// What a cell is that lies in one region.
    pub fn of(region: RegionId) -> Self {
        match contact_of(region) {
            Some((side, _)) => State::Contact(side),
            None if is_free(region) => State::Free,
            None => State::Outside,
        }
    }
}

/// Which cells belong to the bands along the cuts.
pub struct Layout {
    /// Those of bands that no front comes near, and those of the others.
    pub(super) held: Vec<usize>,
    pub(super) moving: Vec<usize>,
    /// Cells whose nodes have stored rows, ascending.
    pub(super) inner: Vec<usize>,
    /// Regular nodes that are solved for with the bands that move.
    pub(super) also: Vec<usize>,
    /// Cells in contact near the fronts, with what they touch.
    pub(super) contact: Vec<(usize, Side)>,
}

/// The nodes of a level that no cut comes near. Their equations are those of the membrane without cuts; a node has the
/// number of its function.
pub trait Regular: Sized + Send {
    type Cells: CellByCell<2> + 'static;

    /// Whether the cells of a membrane are such, and have coarser ones.
    fn is_able<const D: usize>(membrane: &Membrane<D>) -> bool;

    /// The levels of a membrane, the coarsest first and its own last; none where its cells are others.
    fn grounds(membrane: &Membrane<2>) -> Vec<Ground<Self::Cells>>;

    /// No regular nodes yet.
    ///
    /// # Errors
    /// Equations that cannot be relaxed.
    fn new(membrane: &Membrane<2>, cells: &Arc<Self::Cells>) -> Result<Self, SolveError>;

    /// Finds the regular nodes around a zone, and what belongs to the bands: everything where all is `whole`, to those that
    /// move.
    fn lay_out(&mut self, membrane: &Membrane<2>, zone: &PlaneZone, whole: bool) -> Layout;

    fn count(&self) -> usize;
    fn contains(&self, node: usize) -> bool;
    /// Where the displacement at a node is its unknown; none for unknowns of higher degree that are no value.
    fn position(&self, node: usize) -> Option<Point<2>>;
    fn for_each(&self, visit: impl FnMut(usize));

    /// The row of a regular node, itself included.
    fn row(&self, node: usize) -> impl Iterator<Item = (usize, f64)> + '_;

    /// Puts the load on the regular nodes in its place.
    fn load(&self, membrane: &Membrane<2>, b: &mut [f64]);

    /// What the equations leave of the right-hand side.
    fn residual(&self, u: &[f64], b: &[f64], r: &mut [f64]);

    /// Relaxes the equations once.
    fn relax(&self, u: &mut [f64], b: &[f64]);

    /// The displacement at a node to begin with, by those of the next coarser level that are known.
    fn first_guess(&self, node: usize, coarse: &Self, u: &[f64], known: &[bool]) -> f64;

    /// Adds what was found on the next coarser level at the regular nodes and at some others.
    fn add_correction(&self, coarse: &[f64], others: impl Iterator<Item = usize>, u: &mut [f64]);

    /// Gives what is left of the equations to the next coarser level: to its regular nodes and to some others.
    fn restrict(&self, r: &[f64], coarse: &Self, others: impl Iterator<Item = usize>, b: &mut [f64]);
}
