#![no_main]
use libfuzzer_sys::fuzz_target;
use signorini_fem::MeshCells;
use signorini_fem::gmsh::GmshFile;

// Whatever a file holds: an error, or a mesh on which a membrane can be computed.
fuzz_target!(|bytes: &[u8]| {
    let Ok(file) = GmshFile::parse(bytes) else { return };
    if let Ok(mesh) = file.mesh::<2>(None)
        && mesh.check().is_ok()
        && mesh.cell_count() < 1000
    {
        let cells = MeshCells::new(mesh, 1);
        let _ = cells.grid();
    }
    let _ = file.mesh::<3>(None);
});
