//! Meshes from files of Gmsh and from decks of other programs.

use crate::plan::placement::PlacementKeys;
use crate::plan::planner::Planner;
use crate::problem::{CaseError, Location, MeshAdjustment, MeshFile};
use signorini_fem::mesh::position;
use signorini_fem::{Mesh, Overlap};
use signorini_geometry::Point;
use signorini_geometry::mesh::TriangleMesh;
use signorini_import::adjust::Adjustment;
use signorini_import::mesh::{Selection, build};
use signorini_import::{Deck, is_deck};
use std::collections::BTreeMap;
use std::path::Path;
use std::rc::Rc;

impl Planner<'_> {
    /// Scales, turns and moves a mesh.
    pub(in crate::plan) fn place_mesh<const D: usize>(
        &self,
        mesh: &mut Mesh<D>,
        placement: &PlacementKeys,
    ) -> Result<(), CaseError> {
        if let Some(placement) = self.placement::<D>(placement)? {
            mesh.move_nodes(|x| {
                let placed = placement.point(&Point::<3>::from_fn(|k, _| if k < D { x[k] } else { 0.0 }));
                Point::<D>::from_fn(|k, _| placed[k])
            });
        }
        Ok(())
    }

    /// The mesh of a body from a file, by the ending of its name.
    pub(in crate::plan) fn mesh_of_file<const D: usize>(&self, key: &MeshFile) -> Result<Mesh<D>, CaseError> {
        let problem = self.problem;
        let placement = PlacementKeys { scale: &key.scale, rotate: &key.rotate, translate: &key.translate };
        let path = problem.source.folder().join(&key.file);
        if !is_deck(&path) {
            self.check_is_gmsh(key)?;
            return self.gmsh::<D>(&key.file, key.group.as_deref(), &placement);
        }
        let fail = |at: &dyn Location, message: String| problem.error(&at.key_in(problem), message);
        let deck = self.deck(&path).map_err(|message| fail(&key.file, message))?;
        let number = |n: &i64| u64::try_from(*n).map_err(|_| fail(n, format!("{n} is not the number of a node")));
        let mut selection = Selection {
            group: key.group.clone(),
            connected_to: key.connected_to.as_ref().map(number).transpose()?,
            ..Selection::default()
        };
        for (name, nodes) in &key.nodes {
            selection.nodes.push((name.clone(), nodes.iter().map(number).collect::<Result<_, _>>()?));
        }
        selection.sides = key.sides.iter().map(|(name, sides)| (name.clone(), sides.to_vec())).collect();
        let adjustment = |key: &MeshAdjustment| Adjustment {
            surface: key.surface.clone(),
            to: key.to.clone(),
            within: key.within,
            nodes: key.nodes.clone(),
        };
        selection.adjust = key.adjust.iter().map(adjustment).collect();
        let mut mesh = build::<D>(&deck, &selection).map_err(|e| fail(&key.file, e.to_string()))?;
        self.place_mesh(&mut mesh, &placement)?;
        let volume = if D == 2 { "area" } else { "volume" };
        mesh.check().map_err(|e| {
            fail(&key.file, format!("`{}`: {e}", path.display()))
                .help(format!("every cell needs a positive {volume}; check the cell at the given position"))
        })?;
        if let Some(Overlap { cells: [a, b], at }) = mesh.overlap() {
            let message = format!("`{}`: the cells {a} and {b} overlap at {}", path.display(), position(&at));
            return Err(fail(&key.file, message).help("select one of several parts by `group` or `connected_to`"));
        }
        Ok(mesh)
    }

    /// A deck, which several bodies may share.
    fn deck(&self, path: &Path) -> Result<Rc<Deck>, String> {
        if let Some(deck) = self.decks.borrow().get(path) {
            return Ok(Rc::clone(deck));
        }
        let deck = Rc::new(signorini_import::read_mesh(path).map_err(|e| e.to_string())?);
        self.decks.borrow_mut().insert(path.to_path_buf(), Rc::clone(&deck));
        Ok(deck)
    }

    /// Refuses what only decks have.
    fn check_is_gmsh(&self, key: &MeshFile) -> Result<(), CaseError> {
        let message =
            "only files of CalculiX, Abaqus (.inp), FEBio (.feb) and VTK (.vtu) have numbered nodes and faces";
        let wrong = |at: &dyn Location| {
            Err(self
                .problem
                .error(&at.key_in(self.problem), message)
                .help("name physical groups of a Gmsh file by `group`"))
        };
        if let Some(node) = &key.connected_to {
            return wrong(node);
        }
        if let Some((_, nodes)) = key.nodes.iter().next() {
            return wrong(nodes);
        }
        if let Some(adjustment) = key.adjust.first() {
            return wrong(adjustment);
        }
        match key.sides.iter().next() {
            Some((_, sides)) => wrong(sides),
            None => Ok(()),
        }
    }

    /// The boundary of a mesh in space as triangles.
    pub(in crate::plan) fn boundary_of_file(&self, key: &MeshFile) -> Result<TriangleMesh, CaseError> {
        let mesh = self.mesh_of_file::<3>(key)?;
        let mut numbers: BTreeMap<u32, u32> = BTreeMap::new();
        let (mut points, mut triangles) = (Vec::new(), Vec::new());
        for side in mesh.boundary() {
            let corners: Vec<u32> = (mesh.side_vertices(side).iter())
                .map(|node| {
                    *numbers.entry(*node).or_insert_with(|| {
                        points.push(mesh.nodes()[*node as usize]);
                        points.len() as u32 - 1
                    })
                })
                .collect();
            triangles.extend((2..corners.len()).map(|k| [corners[0], corners[k - 1], corners[k]]));
        }
        TriangleMesh::new(points, &triangles).map_err(|e| self.problem.error(&key.file, e.to_string()))
    }
}
