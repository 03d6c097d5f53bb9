//! Meshes and surfaces from arrays.

use super::planner::Planner;
use crate::problem::{CaseError, MeshArrays, TriangleArrays};
use signorini_fem::gmsh::{GmshFile, ListedCells};
use signorini_fem::mesh::position;
use signorini_fem::{Mesh, Overlap, Side};
use signorini_geometry::Point;
use signorini_geometry::mesh::TriangleMesh;
use std::collections::BTreeSet;

impl Planner<'_> {
    /// The mesh that arrays state, with its groups and `boundary`.
    ///
    /// # Errors
    /// Points of another dimension, cells of unknown shape or without volume, groups that are no part of the mesh.
    pub(super) fn mesh_of_arrays<const D: usize>(&self, key: &MeshArrays) -> Result<Mesh<D>, CaseError> {
        let wrong = |message: String| self.problem.error(key, message);
        let mut points = Vec::new();
        for (k, x) in key.points.iter().enumerate() {
            if x.len() != D || x.iter().any(|v| !v.is_finite()) {
                return Err(wrong(format!("point {k} is {x:?}: expected {D} finite coordinates")));
            }
            points.push(std::array::from_fn(|i| x.get(i).copied().unwrap_or(0.0)));
        }
        let blocks: Vec<ListedCells> =
            key.cells.iter().map(|block| ListedCells { shape: &block.shape, nodes: &block.nodes }).collect();
        let file = GmshFile::from_arrays(points.clone(), &blocks).map_err(wrong)?;
        let mut mesh = file.mesh::<D>(None).map_err(|e| wrong(e.to_string()))?;
        mesh.check().map_err(|e| {
            wrong(e.to_string()).help("every cell needs a positive volume; check the cell at the given position")
        })?;
        if let Some(Overlap { cells: [a, b], at }) = mesh.overlap() {
            return Err(wrong(format!("the cells {a} and {b} overlap at {}", position(&at))));
        }
        // The mesh numbers its nodes by itself: those of a group are known by their places.
        let place = |x: &[f64]| -> Vec<u64> { x.iter().map(|v| (v + 0.0).to_bits()).collect() };
        for (name, nodes) in &key.groups {
            if let Some(beyond) = nodes.iter().find(|n| **n as usize >= points.len()) {
                return Err(self
                    .problem
                    .error(nodes, format!("the group `{name}` contains the point {beyond}, which does not exist")));
            }
            let places: BTreeSet<Vec<u64>> = nodes.iter().map(|n| place(&points[*n as usize][..D])).collect();
            let vertices: Vec<u32> = (0..mesh.nodes().len() as u32)
                .filter(|n| places.contains(&place(mesh.nodes()[*n as usize].as_slice())))
                .collect();
            let within: BTreeSet<u32> = vertices.iter().copied().collect();
            let sides: Vec<Side> = mesh
                .boundary()
                .into_iter()
                .filter(|s| mesh.side_vertices(*s).iter().all(|n| within.contains(n)))
                .collect();
            let cells: Vec<u32> = (0..mesh.cell_count())
                .filter(|c| mesh.vertices(*c).all(|n| within.contains(&n)))
                .map(|c| c as u32)
                .collect();
            if sides.is_empty() && cells.is_empty() && vertices.is_empty() {
                return Err(self.problem.error(nodes, format!("the group `{name}` contains no node of the mesh")));
            }
            let group = mesh.group_mut(name);
            (group.sides, group.cells, group.vertices) = (sides, cells, vertices);
        }
        Ok(mesh)
    }

    /// The closed surface that arrays state.
    ///
    /// # Errors
    /// Triangles without area or with corners that are no points; a surface that is not closed.
    pub(super) fn surface_of_arrays(&self, key: &TriangleArrays) -> Result<TriangleMesh, CaseError> {
        let points = key.points.iter().map(|x| Point::<3>::from(*x)).collect();
        let mesh = TriangleMesh::new(points, &key.triangles).map_err(|e| self.problem.error(key, e.to_string()))?;
        if mesh.quality().has_inside() {
            return self.turned_outwards(mesh, key, "the surface");
        }
        Err(self.not_closed(&mesh, key, "the surface"))
    }
}
