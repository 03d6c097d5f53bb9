//! A membrane on the cells of a mesh over a flat floor, for tests and benches.

use signorini_fem::gmsh::GmshFile;
use signorini_fem::{Cells, MeshCells};
use signorini_membrane::domain::{DomainOnCells, MeshDomain};
use signorini_membrane::field::Constant;
use signorini_membrane::obstacle::{Obstacle, Obstacles, Side};
use signorini_membrane::problem::{Measure, Membrane, Support};
use std::sync::Arc;

/// The cells of a mesh among the test data, each divided into four so many times.
pub fn cells(name: &str, degree: usize, divisions: usize) -> Arc<MeshCells> {
    let path = format!("{}/../signorini/tests/data/meshes/{name}.msh", env!("CARGO_MANIFEST_DIR"));
    let file = GmshFile::parse(&std::fs::read(path).expect("a mesh")).expect("a mesh");
    let coarse = Arc::new(MeshCells::new(file.mesh::<2>(None).expect("a mesh"), degree));
    (0..divisions).fold(coarse, |cells, _| Arc::new(cells.refined()))
}

/// A membrane of unit tension under unit load, held all around at a height of 0.1 above the floor.
pub fn on_mesh(cells: Arc<MeshCells>) -> Membrane<2> {
    let domain = DomainOnCells::new(Arc::new(MeshDomain(cells.clone())), &*cells);
    let support = Support { index: 0, displacement: Arc::new(Constant(0.0)) };
    Membrane {
        grid: cells.grid(),
        supports: vec![Some(support); cells.pieces()],
        cells: cells as Arc<dyn Cells<2>>,
        domain,
        measure: Measure::Plain,
        tension: Arc::new(Constant(1.0)),
        load: Arc::new(Constant(-1.0)),
        obstacles: Obstacles(vec![Obstacle { side: Side::Below, height: Arc::new(Constant(-0.1)), adhesion: None }]),
        support_count: 1,
        modes: Default::default(),
        formulation: Default::default(),
    }
}
