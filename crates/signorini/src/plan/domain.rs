//! The domain of a membrane and its cells: a background grid, or a mesh from a file.

mod line;
mod mesh;
mod plane;

use super::memory::{memory_estimate, multigrid_estimate};
use super::pieces::Apart;
use super::planner::Planner;
use crate::problem::units::LENGTH;
use crate::problem::{self, CaseError, Domain, KeyPath, Location, Mesh};
use signorini_fem::{Cells, Grid};
use signorini_geometry::Aabb;
use signorini_membrane::domain::{BoxDomain, CellStatus, Domain as MembraneDomain, DomainOnCells};
use signorini_membrane::kernel::Kernel;
use signorini_membrane::refinement::Refinement;
use std::collections::BTreeSet;
use std::sync::Arc;

/// The box of a grid that the boundary cuts is larger than the domain by this factor, so that no boundary runs along
/// its edge.
pub(super) const MARGIN: f64 = 1.03;
/// Named groups of boundary pieces.
pub struct Pieces {
    pub groups: Vec<(String, Vec<usize>)>,
    /// The pieces of a mesh that falls into several, and the pieces of the boundary of each.
    pub(super) apart: Option<(Apart<2>, Vec<BTreeSet<usize>>)>,
}

impl Pieces {
    fn new(groups: &[(&str, &[usize])]) -> Self {
        Self { groups: groups.iter().map(|(n, p)| (n.to_string(), p.to_vec())).collect(), apart: None }
    }
}

/// Reads domains of one dimension.
pub(crate) trait ReadDomain<const D: usize> {
    /// What solves for membranes of this dimension.
    const KERNEL: Kernel<D>;

    /// A shape, its bounding box and its groups.
    fn shape(&self, key: &Domain) -> Result<(Arc<dyn MembraneDomain<D>>, Aabb<D>, Pieces), CaseError>;

    /// The zone of contact that a case asks for, as a shape; sides that reach the membrane's own reach beyond it.
    fn initial_zone(&self, key: &Domain, grid: &Grid<D>) -> Result<Arc<dyn MembraneDomain<D>>, CaseError> {
        let (shape, bounds, _) = self.shape(key)?;
        let whole = grid.bounds();
        if (0..D).any(|k| bounds.max[k] <= whole.min[k] || bounds.min[k] >= whole.max[k]) {
            return Err(self.planner().problem.error(key, "the initial zone lies outside the membrane"));
        }
        if !shape.is_box() {
            return Ok(shape);
        }
        let mut reaching = bounds;
        for k in 0..D {
            let size = whole.size()[k];
            if bounds.min[k] <= whole.min[k] {
                reaching.min[k] = whole.min[k] - size;
            }
            if bounds.max[k] >= whole.max[k] {
                reaching.max[k] = whole.max[k] + size;
            }
        }
        Ok(Arc::new(BoxDomain(reaching)))
    }

    fn planner(&self) -> &Planner<'_>;

    /// Where cells of about the size of a grid's are divided, by themselves and where the case says.
    fn refinement(&self, key: Option<&RefineEntry>, grid: &Grid<D>) -> Result<Refinement<D>, CaseError>;

    /// The cells of a grid, divided where a function says so.
    fn divided(&self, grid: &Grid<D>, wanted: &Wanted<D>) -> Arc<dyn Cells<D>>;

    /// The cells of a mesh from a file.
    fn mesh_of_file(&self, key: &problem::DividedGmshMesh, film: &problem::Membrane) -> Result<OnCells<D>, CaseError>;

    /// The cells of a mesh from arrays.
    fn mesh_of_arrays(&self, key: &problem::MeshArrays, film: &problem::Membrane) -> Result<OnCells<D>, CaseError>;

    /// The domain on its cells.
    fn domain(&self, film: &problem::Membrane) -> Result<OnCells<D>, CaseError> {
        let planner = self.planner();
        let grid = match &film.mesh {
            Mesh::Gmsh(key) => return self.mesh_of_file(key, film),
            Mesh::Arrays(key) => return self.mesh_of_arrays(key, film),
            Mesh::Grid(grid) => grid,
        };
        let degree = planner.degree(film)?.unwrap_or(2);
        let (shape, bounds, pieces) = self.shape(planner.domain_key(film)?)?;
        let (cells, place) = planner.cells(film, grid, &bounds)?;
        planner.check_size(&cells, degree, &place)?;
        let coarse = Grid::new(bounds, cells, degree);
        let refinement = self.refinement(grid.refine.as_ref(), &coarse)?;
        let cells: Arc<dyn Cells<D>> = match &grid.refine {
            Some(key) if key.negative_where.is_some() => self.divided(&coarse, &refinement.always),
            _ => coarse.as_cells(),
        };
        let grid = coarse;
        let domain = DomainOnCells::new(shape, &*cells);
        if domain.status.iter().all(|s| *s == CellStatus::Outside) {
            let at = film.domain.as_ref().map_or_else(|| planner.key(film), |d| planner.key(d));
            return Err(planner
                .problem
                .error(&at, "the domain is empty: no point of the grid is inside it")
                .help("check the sign (negative inside) and the bounds min and max, or use more cells"));
        }
        Ok(OnCells { cells, grid, domain, pieces, refinement })
    }
}

/// What a case says of where cells are divided.
type RefineEntry = problem::Refine;

/// Whether a cell is divided, from its box and how often it was divided.
type Wanted<const D: usize> = Arc<dyn Fn(&Aabb<D>, usize) -> bool + Send + Sync>;

/// A domain with its cells.
pub(crate) struct OnCells<const D: usize> {
    pub cells: Arc<dyn Cells<D>>,
    pub grid: Grid<D>,
    pub domain: DomainOnCells<D>,
    pub pieces: Pieces,
    pub refinement: Refinement<D>,
}

impl Planner<'_> {
    /// The degree that a membrane states.
    fn degree(&self, film: &problem::Membrane) -> Result<Option<usize>, CaseError> {
        match &film.degree {
            None => Ok(None),
            Some(d) if (1..=6).contains(d) => Ok(Some(*d as usize)),
            Some(d) => Err(self.problem.error(d, format!("degree {} is not between 1 and 6", d))),
        }
    }

    fn cells<const D: usize>(
        &self,
        film: &problem::Membrane,
        grid: &problem::GridMesh,
        bounds: &Aabb<D>,
    ) -> Result<([usize; D], KeyPath), CaseError> {
        let problem = self.problem;
        match (&grid.cells, &grid.cell_size) {
            (Some(cells), None) => {
                if cells.len() != D {
                    return Err(problem.error(cells, format!("expected {D} numbers of cells, found {}", cells.len())));
                }
                let mut out = [0; D];
                for (o, n) in out.iter_mut().zip(cells) {
                    let count = *n;
                    if count < 1 {
                        return Err(problem.error(n, format!("{count} cells: there must be at least one")));
                    }
                    *o = count as usize;
                }
                Ok((out, self.key(cells)))
            }
            (None, Some(size)) => {
                let h = self.reader.positive(size, LENGTH)?;
                let extent = bounds.size();
                let mut out = [0; D];
                for k in 0..D {
                    out[k] = (extent[k] / h).round().clamp(1.0, 1e15) as usize;
                }
                Ok((out, self.key(size)))
            }
            _ => Err(problem
                .error(&film.mesh, "the grid requires either `cells` or `cell_size`")
                .help("mesh.grid = { cells = [40, 40] }")),
        }
    }

    /// Tells before memory ends.
    fn check_size<const D: usize>(
        &self,
        cells: &[usize; D],
        degree: usize,
        at: &impl Location,
    ) -> Result<(), CaseError> {
        let nodes: f64 = cells.iter().map(|&n| n as f64 * degree as f64 + 1.0).product();
        let bytes = memory_estimate(nodes, degree, D).min(multigrid_estimate(nodes, degree, true));
        self.check_bytes(nodes, bytes, at)
    }

    fn domain_key<'f>(&self, film: &'f problem::Membrane) -> Result<&'f Domain, CaseError> {
        film.domain.as_ref().ok_or_else(|| {
            self.problem.error(film, "missing key `domain`").help("add for example  domain.disc = { radius = 1.0 }")
        })
    }
}

impl Planner<'_> {}

impl Planner<'_> {}
