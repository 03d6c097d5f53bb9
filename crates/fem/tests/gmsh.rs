//! Meshes written by Gmsh 4.13 in all versions of its format, with cells of all kinds: a unit square with a round hole of
//! radius 0.2, and the same plate half as thick; groups `block`, `front` (y = 0) and `hole`.

use proptest::prelude::*;
use signorini_fem::gmsh::{GmshError, GmshFile};
use signorini_fem::hierarchic::Values;
use signorini_fem::rules::rule;
use signorini_fem::small::determinant;
use signorini_fem::{CellShape, Mesh, Side};
use signorini_geometry::Point;

fn read(name: &str) -> Vec<u8> {
    let path = format!("{}/tests/data/{name}.msh", env!("CARGO_MANIFEST_DIR"));
    std::fs::read(&path).unwrap_or_else(|e| panic!("{path}: {e}"))
}

fn volume<const D: usize>(mesh: &Mesh<D>) -> f64 {
    let mut at = Values::default();
    let mut sum = 0.0;
    for cell in 0..mesh.cell_count() {
        for (x, w) in rule(mesh.shape(cell), 5) {
            mesh.map(cell).tabulate(&x, &mut at);
            sum += w * determinant(&mesh.jacobian(cell, &at).1);
        }
    }
    sum
}

fn area<const D: usize>(mesh: &Mesh<D>, sides: &[Side]) -> f64 {
    sides
        .iter()
        .flat_map(|side| rule(mesh.side_shape(*side), 5).into_iter().map(move |r| (side, r)))
        .map(|(side, (s, w))| {
            let (_, [a, b]) = mesh.on_side(*side, &s);
            let size = if D == 2 {
                a.norm()
            } else {
                let cross = |i: usize, j: usize| a[i] * b[j] - a[j] * b[i];
                cross(1, 2).hypot(cross(2, 0)).hypot(cross(0, 1))
            };
            w * size
        })
        .sum()
}

fn check<const D: usize>(name: &str, shapes: &[CellShape], order: usize) {
    let mesh = GmshFile::parse(&read(name)).unwrap().mesh::<D>(Some("block")).unwrap();
    mesh.check().unwrap_or_else(|e| panic!("{name}: {e}"));
    assert!((0..mesh.cell_count()).all(|c| shapes.contains(&mesh.shape(c)) && mesh.map(c).order() == order), "{name}");
    let thickness = if D == 3 { 0.5 } else { 1.0 };
    // Chords of a coarse polygon, or parabolas.
    let tolerance = if order == 1 { 0.03 } else { 0.002 };
    let exact = (1.0 - std::f64::consts::PI * 0.04) * thickness;
    assert!((volume(&mesh) - exact).abs() < tolerance, "{name}: {}", volume(&mesh));
    let groups = mesh.groups();
    assert_eq!(groups["block"].cells.len(), mesh.cell_count());
    assert!((area(&mesh, &groups["front"].sides) - thickness).abs() < 1e-12, "{name}");
    let hole = 0.4 * std::f64::consts::PI * thickness;
    assert!((area(&mesh, &groups["hole"].sides) - hole).abs() < 5.0 * tolerance, "{name}");
    let boundary =
        4.0 * thickness + area(&mesh, &groups["hole"].sides) + if D == 3 { 2.0 * volume(&mesh) / 0.5 } else { 0.0 };
    assert!((area(&mesh, &groups["boundary"].sides) - boundary).abs() < 1e-9, "{name}");
}

#[test]
fn all_kinds_of_cells() {
    use CellShape::*;
    check::<2>("tri3_41_txt", &[Triangle], 1);
    check::<2>("tri6_41_txt", &[Triangle], 2);
    check::<2>("quad8_41_txt", &[Quadrilateral, Triangle], 2);
    check::<2>("quad9_41_txt", &[Quadrilateral, Triangle], 2);
    check::<3>("tet4_41_txt", &[Tetrahedron], 1);
    check::<3>("tet10_41_txt", &[Tetrahedron], 2);
    check::<3>("wedge6_41_txt", &[Wedge], 1);
    check::<3>("wedge15_41_txt", &[Wedge], 2);
    check::<3>("wedge18_41_txt", &[Wedge], 2);
    check::<3>("hex20_41_txt", &[Hexahedron, Wedge], 2);
    check::<3>("hex27_41_txt", &[Hexahedron, Wedge], 2);
}

#[test]
fn all_versions_hold_the_same_mesh() {
    fn same<const D: usize>(name: &str) {
        let [first, others @ ..] = ["41_txt", "41_bin", "22_txt", "22_bin"]
            .map(|v| GmshFile::parse(&read(&format!("{name}_{v}"))).unwrap().mesh::<D>(None).unwrap());
        for other in others {
            assert_eq!(first.cell_count(), other.cell_count());
            let names = |m: &Mesh<D>| m.groups().keys().cloned().collect::<Vec<_>>();
            assert_eq!(names(&first), names(&other));
            for cell in 0..first.cell_count() {
                let nodes =
                    |m: &Mesh<D>| m.cell_nodes(cell).iter().map(|&n| m.nodes()[n as usize]).collect::<Vec<Point<D>>>();
                let (p, q) = (nodes(&first), nodes(&other));
                assert!(p.iter().zip(&q).all(|(p, q)| (p - q).norm() < 1e-14), "{name}");
            }
            for group in first.groups().keys() {
                assert_eq!(first.groups()[group].sides.len(), other.groups()[group].sides.len());
            }
        }
    }
    same::<3>("hex20");
    same::<2>("tri6");
}

#[test]
fn mistakes_are_named() {
    let text = String::from_utf8(read("tri3_41_txt")).unwrap();
    let of = |t: &str| GmshFile::parse(t.as_bytes());
    assert_eq!(of("solid cube\n").unwrap_err(), GmshError::NotGmsh);
    assert!(matches!(of(&text.replacen("4.1", "3.7", 1)), Err(GmshError::Version { found }) if found == "3.7"));
    let line = text.lines().position(|l| l == "$Nodes").unwrap() + 2;
    let broken = of(&text.replacen("$Nodes\n", "$Nodes\nmany ", 1)).unwrap_err();
    assert_eq!(broken, GmshError::Malformed { line, wanted: "a whole number", found: "many".into() });
    assert!(matches!(of(&text[..text.len() / 2]), Err(GmshError::Truncated { .. } | GmshError::Malformed { .. })));
    let file = of(&text).unwrap();
    let missing = file.mesh::<2>(Some("blok")).unwrap_err().to_string();
    assert!(missing.contains("`blok`") && missing.contains("`block` (2)"), "{missing}");
    assert!(matches!(file.mesh::<3>(None), Err(GmshError::NoCells { dimension: 3, .. })));
    // The first element, a part of the boundary: the last of its nodes is not there.
    for name in ["tri6_41_txt", "tri6_22_txt"] {
        let text = String::from_utf8(read(name)).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        let from = lines.iter().position(|l| *l == "$Elements").unwrap() + 1;
        let first = if name.contains("41") { from + 2 } else { from + 1 };
        let start = lines[first].trim_end().rsplit_once(' ').unwrap().0;
        let mut changed = lines.clone();
        let line = format!("{start} 99999");
        changed[first] = &line;
        let error = of(&changed.join("\n")).unwrap_err().to_string();
        let place = format!("line {}: element", first + 1);
        assert!(error.starts_with(&place) && error.contains("the node 99999, which"), "{name}: {error}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(600))]
    /// No file, however damaged, does more than give an error.
    #[test]
    fn damaged_files_do_no_harm(which in 0usize..4, cut in 0.0..1.0f64, changes in prop::collection::vec((0.0..1.0f64, any::<u8>()), 0..12)) {
        let name = ["tri6_41_txt", "tri6_41_bin", "tri6_22_txt", "tri6_22_bin"][which];
        let mut bytes = read(name);
        let length = bytes.len();
        for (at, value) in changes {
            bytes[(at * (length - 1) as f64) as usize] = value;
        }
        if cut < 0.5 {
            bytes.truncate((2.0 * cut * length as f64) as usize);
        }
        if let Ok(file) = GmshFile::parse(&bytes) {
            for group in [None, Some("block")] {
                if let Ok(mesh) = file.mesh::<2>(group) {
                    let _ = mesh.check();
                }
                let _ = file.mesh::<3>(group);
            }
        }
    }
}
