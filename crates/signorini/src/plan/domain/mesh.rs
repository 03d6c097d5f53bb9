//! A membrane on the cells of a mesh, which is its domain.

use super::{OnCells, Pieces, ReadDomain, RefineEntry};
use crate::plan::memory::{memory_estimate, mesh_multigrid_estimate};
use crate::plan::pieces::Apart;
use crate::plan::planner::Planner;
use crate::problem::{self, CaseError, KeyPath};
use signorini_fem::mesh_cells::MOST_ON_TRIANGLES;
use signorini_fem::{Cells, Mesh, MeshCells};
use signorini_membrane::domain::{Domain as MembraneDomain, DomainOnCells, MeshDomain};
use signorini_membrane::refinement::Refinement;
use std::collections::BTreeSet;
use std::sync::Arc;

/// How often those of a mesh from a file may be.
const MOST_MESH_DIVISIONS: i64 = 12;

impl Planner<'_> {
    /// A membrane on the cells of a mesh, each divided so often, and where the case says.
    pub(super) fn on_mesh(
        &self,
        mesh: Mesh<2>,
        place: &KeyPath,
        divided: Option<&i64>,
        refine: Option<&RefineEntry>,
        film: &problem::Membrane,
    ) -> Result<OnCells<2>, CaseError> {
        let problem = self.problem;
        if let Some(domain) = &film.domain {
            return Err(problem
                .error(domain, "the mesh defines the domain")
                .help("leave `domain` out, or use mesh.grid"));
        }
        let order = (0..mesh.cell_count()).map(|c| mesh.map(c).order()).max().unwrap_or(1);
        let degree = self.degree(film)?.unwrap_or(order);
        let triangles = (0..mesh.cell_count()).any(|c| !mesh.shape(c).is_tensor());
        if triangles && degree > MOST_ON_TRIANGLES {
            let at = film.degree.as_ref().map_or_else(|| place.clone(), |d| self.key(d));
            return Err(problem
                .error(&at, format!("degree {degree} on a mesh with triangles"))
                .help("triangles have degree 1 or 2, quadrilaterals 1 to 6"));
        }
        let divisions = divided.copied().unwrap_or(0);
        let at = divided.map_or_else(|| place.clone(), |d| self.key(d));
        if !(0..=MOST_MESH_DIVISIONS).contains(&divisions) {
            let message = format!("the number of divisions must be 0 to {MOST_MESH_DIVISIONS}, not {divisions}");
            return Err(problem.error(&at, message));
        }
        // Triangles are twice as many as their vertices.
        let share = |cell: usize| if mesh.shape(cell).is_tensor() { 1.0 } else { 0.5 };
        let vertices = (0..mesh.cell_count()).map(share).sum::<f64>() * 4f64.powi(divisions as i32);
        let unknowns = vertices * (degree * degree) as f64;
        let by_multigrid = if divisions > 0 { mesh_multigrid_estimate(unknowns, degree) } else { f64::INFINITY };
        self.check_bytes(unknowns, memory_estimate(unknowns, degree, 2).min(by_multigrid), &at)?;
        let apart = Apart::new(&mesh);
        let undivided = Arc::new(MeshCells::new(mesh, degree));
        let apart = apart.map(|apart| {
            let mut rims = vec![BTreeSet::new(); apart.count()];
            for side in undivided.boundary_sides() {
                rims[apart.of_cell[side.cell] as usize].insert(side.piece);
            }
            (apart, rims)
        });
        let cells = (0..divisions).fold(undivided, |cells, _| Arc::new(cells.refined()));
        let grid = cells.grid();
        let refinement = match refine {
            Some(refine) if degree > MOST_ON_TRIANGLES => {
                return Err(problem.error(refine, format!("degree {degree} on a mesh with local refinement")).help(
                    "such a mesh contains quadrilaterals and triangles: use degree = 1 or 2, or leave `refine` out",
                ));
            }
            None if degree > MOST_ON_TRIANGLES => Refinement::default(),
            refine => self.refinement(refine, &grid)?,
        };
        let pieces = Pieces { groups: cells.groups().to_vec(), apart };
        let domain: Arc<dyn MembraneDomain<2>> = Arc::new(MeshDomain(cells.clone()));
        let on_request = refine.is_some_and(|refine| refine.negative_where.is_some());
        let divided = on_request.then(|| cells.graded(&[], 0, &*refinement.always)).flatten();
        let cells: Arc<dyn Cells<2>> = match divided {
            Some(divided) => Arc::new(divided),
            None => cells,
        };
        Ok(OnCells { grid, domain: DomainOnCells::new(domain, &*cells), cells, pieces, refinement })
    }
}
