//! Of `mesh_file`.

use signorini::mesh_file::{mended, read};
use signorini_geometry::Point;
use signorini_geometry::mesh::TriangleMesh;
use std::path::{Path, PathBuf};

const FACES: [[u32; 4]; 6] = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];

fn corner(k: u32) -> [u32; 3] {
    [k & 1, k >> 1 & 1, k >> 2]
}

fn write(name: &str, bytes: &[u8]) -> (tempfile::TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    (folder, path)
}

fn triangles() -> Vec<[u32; 3]> {
    FACES.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]]).collect()
}

fn binary_stl() -> Vec<u8> {
    let mut bytes = vec![0u8; 80];
    bytes.extend(12u32.to_le_bytes());
    for t in triangles() {
        bytes.extend([0u8; 12]);
        for v in t {
            corner(v).iter().for_each(|&x| bytes.extend((x as f32).to_le_bytes()));
        }
        bytes.extend([0u8; 2]);
    }
    bytes
}

#[test]
fn the_same_cube_from_every_format() {
    let mut ascii = String::from("solid cube\n");
    for t in triangles() {
        ascii += "facet normal 0 0 0\nouter loop\n";
        for v in t {
            let [x, y, z] = corner(v);
            ascii += &format!("vertex {x} {y} {z}\n");
        }
        ascii += "endloop\nendfacet\n";
    }
    ascii += "endsolid cube\n";
    let mut obj = String::new();
    let mut ply = String::from(
        "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n",
    );
    for k in 0..8 {
        let [x, y, z] = corner(k);
        obj += &format!("v {x} {y} {z}\n");
        ply += &format!("{x} {y} {z}\n");
    }
    for f in FACES {
        obj += &format!("f {} {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1, f[3] + 1);
        ply += &format!("4 {} {} {} {}\n", f[0], f[1], f[2], f[3]);
    }
    let files: [(&str, Vec<u8>); 4] =
        [("a.stl", binary_stl()), ("b.STL", ascii.into()), ("c.obj", obj.into()), ("d.ply", ply.into())];
    for (name, bytes) in files {
        let (_folder, path) = write(name, &bytes);
        let mesh = read(&path).unwrap();
        assert_eq!((mesh.vertices().len(), mesh.triangles().len(), mesh.edge_count()), (8, 12, 18), "{name}");
        assert!(mesh.quality().has_inside(), "{name}");
        assert_eq!(mesh.closest(&Point::<3>::new(0.5, 0.5, 0.9), 0.0)[0].gap, Some(0.9 - 1.0), "{name}");
    }
}

/// Corners that rounding took apart, doubled triangles and slivers are no holes; a triangle that is missing is one.
#[test]
fn what_is_nearly_closed_is_mended() {
    let corners: Vec<Point<3>> = (triangles().iter().flatten().enumerate())
        .map(|(i, k)| Point::<3>::from(corner(*k).map(f64::from)).add_scalar(1e-5 * (i as f64).sin()))
        .collect();
    let mut own: Vec<[u32; 3]> = (0..12).map(|t| [3 * t, 3 * t + 1, 3 * t + 2]).collect();
    own.push([0, 1, 1]);
    let mesh = TriangleMesh::new(corners.clone(), &own).unwrap();
    assert!(!mesh.quality().has_inside());
    let (closed, distance) = mended(&mesh).unwrap();
    assert_eq!((closed.vertices().len(), closed.triangles().len()), (8, 12));
    assert!((1e-5..1e-3).contains(&distance), "{distance}");
    assert!(mended(&TriangleMesh::new(corners, &own[1..]).unwrap()).is_none());
}

#[test]
fn damaged_files_are_refused() {
    let mut cut = binary_stl();
    cut.truncate(200);
    let mut huge = binary_stl();
    huge[80..84].copy_from_slice(&u32::MAX.to_le_bytes());
    let cases: [(&str, &[u8]); 7] = [
        ("a.stl", &cut),
        ("b.stl", &huge),
        ("c.stl", b""),
        ("d.obj", b"v 0 0 0\nf 1 2 3\n"),
        ("e.ply", b"ply\nformat ascii 1.0\nelement vertex 1\n"),
        ("f.ply", b"ply\nformat ascii 1.0\nend_header\n"),
        ("g.step", b"ISO-10303-21;"),
    ];
    for (name, bytes) in cases {
        let (_folder, path) = write(name, bytes);
        let error = read(&path).unwrap_err();
        assert!(error.to_string().contains(name), "{error}");
    }
    assert!(read(Path::new("nothing.stl")).is_err());
}
