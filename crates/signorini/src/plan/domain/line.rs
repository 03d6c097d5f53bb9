//! Domains of membranes on a line.

use super::{OnCells, Pieces, ReadDomain, RefineEntry, Wanted};
use crate::plan::planner::Planner;
use crate::problem::units::LENGTH;
use crate::problem::{self, CaseError, Domain, Location, Space};
use signorini_fem::{Cells, Grid};
use signorini_geometry::{Aabb, Point};
use signorini_membrane::domain::{BoxDomain, Domain as MembraneDomain};
use signorini_membrane::kernel::Kernel;
use signorini_membrane::refinement::Refinement;
use std::sync::Arc;

impl ReadDomain<1> for Planner<'_> {
    const KERNEL: Kernel<1> = Kernel::LINE;

    fn planner(&self) -> &Planner<'_> {
        self
    }

    fn mesh_of_file(&self, key: &problem::DividedGmshMesh, _: &problem::Membrane) -> Result<OnCells<1>, CaseError> {
        Err(self.in_the_plane(&key.file, "a mesh from a file"))
    }

    fn mesh_of_arrays(&self, key: &problem::MeshArrays, _: &problem::Membrane) -> Result<OnCells<1>, CaseError> {
        Err(self.in_the_plane(key, "a mesh from arrays"))
    }

    fn refinement(&self, key: Option<&RefineEntry>, _: &Grid<1>) -> Result<Refinement<1>, CaseError> {
        match key {
            None => Ok(Refinement::default()),
            Some(refine) => Err(self
                .problem
                .error(refine, "cells are divided in the plane only")
                .help("leave `refine` out; in one dimension use more cells, which cost little")),
        }
    }

    fn divided(&self, grid: &Grid<1>, _: &Wanted<1>) -> Arc<dyn Cells<1>> {
        grid.as_cells()
    }

    fn shape(&self, key: &Domain) -> Result<(Arc<dyn MembraneDomain<1>>, Aabb<1>, Pieces), CaseError> {
        let Domain::Interval(interval) = key else {
            return Err(self
                .problem
                .error(key, "in one dimension the domain is an interval")
                .help("interval = { from = -1.0, to = 1.0 }, or space = \"plane\""));
        };
        let (from, to) = (self.reader.number(&interval.from, LENGTH)?, self.reader.number(&interval.to, LENGTH)?);
        if to <= from {
            return Err(self
                .problem
                .error(&interval.to, format!("the domain is empty: {to} is not greater than {from}")));
        }
        let axisymmetric = self.space == Space::Axisymmetric;
        if axisymmetric && from < 0.0 {
            return Err(self.problem.error(&interval.from, format!("a radius of {from} is negative")));
        }
        let pieces = if axisymmetric && from == 0.0 {
            // The axis is not a boundary.
            Pieces::new(&[("boundary", &[1]), ("right", &[1])])
        } else {
            Pieces::new(&[("boundary", &[0, 1]), ("left", &[0]), ("right", &[1])])
        };
        let bounds = Aabb::new(Point::<1>::new(from), Point::<1>::new(to));
        Ok((Arc::new(BoxDomain(bounds)), bounds, pieces))
    }
}

impl Planner<'_> {
    /// What belongs to a membrane in the plane.
    fn in_the_plane(&self, at: &impl Location, what: &str) -> CaseError {
        self.problem
            .error(at, format!("{what} is for a membrane in the plane"))
            .help("space = \"plane\", or mesh.grid = { cells = [100] }")
    }
}
