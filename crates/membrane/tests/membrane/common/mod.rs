//! A membrane on the cells of a mesh over a flat floor, for tests and benches.

use signorini_fem::gmsh::GmshFile;
use signorini_fem::{CellShape, Cells, Mesh, MeshCells};
use signorini_geometry::Point;
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

/// Skew quadrilaterals of a square, each divided into four so many times.
pub fn quadrilaterals(degree: usize, divisions: usize) -> Arc<MeshCells> {
    const N: usize = 8;
    let at = |k: usize| 2.0 * (k % (N + 1)) as f64 / N as f64 - 1.0;
    let node = |k: usize| {
        let (x, y) = (at(k), at(k / (N + 1)));
        let bulge = 0.06 * (1.0 - x * x) * (1.0 - y * y);
        Point::<2>::new(x + bulge * (3.0 * y).sin(), y + bulge * (2.0 * x + y).cos())
    };
    let mut mesh = Mesh::<2>::new((0..(N + 1) * (N + 1)).map(node).collect());
    for (i, j) in (0..N).flat_map(|j| (0..N).map(move |i| (i, j))) {
        let first = (j * (N + 1) + i) as u32;
        let above = first + N as u32 + 1;
        mesh.add_cell(CellShape::Quadrilateral, 1, &[first, first + 1, above, above + 1]);
    }
    mesh.check().expect("a mesh");
    (0..divisions).fold(Arc::new(MeshCells::new(mesh, degree)), |cells, _| Arc::new(cells.refined()))
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
        sizing: None,
        measure: Measure::Plain,
        tension: Arc::new(Constant(1.0)),
        load: Arc::new(Constant(-1.0)),
        obstacles: Obstacles(vec![Obstacle { side: Side::Below, height: Arc::new(Constant(-0.1)), adhesion: None }]),
        support_count: 1,
        modes: Default::default(),
        formulation: Default::default(),
    }
}
