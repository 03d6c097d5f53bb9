//! Meshes of VTK: the order of nodes, groups, encodings, damaged files.

use crate::mesh::{CUBE, KINDS, bent, element, volume};
use crate::written;
use signorini_fem::Mesh;
use signorini_fem::rules::rule;
use signorini_geometry::Point;
use signorini_import::element::Kind;
use signorini_import::mesh::{Selection, build};
use signorini_import::{Deck, ImportError, read, read_mesh};

/// A file of cells, by their types and points, with arrays of integers at cells and points.
fn file_of(points: &[[f64; 3]], cells: &[(u8, Vec<usize>)], of_cells: &str, of_points: &str) -> String {
    let array = |name: &str, kind: &str, values: String| {
        format!("<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">{values}</DataArray>\n")
    };
    let list = |values: &mut dyn Iterator<Item = usize>| values.map(|v| format!("{v} ")).collect::<String>();
    let mut at = 0;
    let offsets = list(&mut cells.iter().map(|(_, c)| {
        at += c.len();
        at
    }));
    let labels = |name: &str, values: &str| match values {
        "" => String::new(),
        values => array(name, "Int32", values.into()),
    };
    format!(
        "<VTKFile type=\"UnstructuredGrid\" version=\"2.2\" byte_order=\"LittleEndian\"><UnstructuredGrid>
<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\"><PointData>{}</PointData><CellData>{}</CellData><Points>
<DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">{}</DataArray></Points><Cells>
{}{}{}</Cells></Piece></UnstructuredGrid></VTKFile>\n",
        points.len(),
        cells.len(),
        labels("set", of_points),
        labels("part", of_cells),
        points.iter().flatten().map(|v| format!("{v:?} ")).collect::<String>(),
        array("connectivity", "Int64", list(&mut cells.iter().flat_map(|(_, c)| c.iter().copied()))),
        array("offsets", "Int64", offsets),
        array("types", "UInt8", list(&mut cells.iter().map(|(t, _)| usize::from(*t)))),
    )
}

fn deck(text: impl AsRef<[u8]>) -> Result<Deck, ImportError> {
    let (folder, path) = written(&[("mesh.vtu", "")]);
    std::fs::write(&path, text).unwrap();
    let deck = read_mesh(&path);
    drop(folder);
    deck
}

fn mesh_of(text: &str) -> Mesh<3> {
    build::<3>(&deck(text).unwrap(), &Selection::default()).unwrap()
}

/// One cell of each kind, bent by a map of second order, which is met everywhere if all nodes are in their places. VTK numbers
/// edges as CalculiX does. Wedges stand either way.
#[test]
fn nodes_of_all_cells_are_in_their_places() {
    const TURNED: [usize; 15] = [3, 4, 5, 0, 1, 2, 9, 10, 11, 6, 7, 8, 12, 13, 14];
    for kind in KINDS {
        let (vertices, edges, _) = element(kind);
        let middle = |list: &[usize]| {
            std::array::from_fn(|k| list.iter().map(|v| vertices[*v][k]).sum::<f64>() / list.len() as f64)
        };
        let mut nodes: Vec<[f64; 3]> = vertices.iter().copied().chain(edges.iter().map(|e| middle(e))).collect();
        let mut listed = vec![(kind, nodes.clone(), false)];
        if edges.len() == 12 {
            let faces: [&[usize]; 6] =
                [&[0, 4, 7, 3], &[1, 2, 6, 5], &[0, 1, 5, 4], &[3, 7, 6, 2], &[0, 3, 2, 1], &[4, 5, 6, 7]];
            nodes.extend(faces.map(middle));
            nodes.push([0.5; 3]);
            listed.push((Kind::Hexahedron27, nodes.clone(), false));
        }
        if kind.shape() == "wedge" {
            listed.push((kind, TURNED[..nodes.len()].iter().map(|k| nodes[*k]).collect(), true));
        }
        if edges.len() == 9 {
            nodes.extend([[0, 1, 4, 3], [1, 2, 5, 4], [2, 0, 3, 5]].map(|f| middle(&f)));
            listed.push((Kind::Wedge18, nodes, false));
        }
        for (kind, nodes, turned) in listed {
            let number = match kind {
                Kind::Tetrahedron4 => 10,
                Kind::Hexahedron8 => 12,
                Kind::Wedge6 => 13,
                Kind::Tetrahedron10 => 24,
                Kind::Hexahedron20 => 25,
                Kind::Wedge15 => 26,
                Kind::Hexahedron27 => 29,
                _ => 32,
            };
            let map = if nodes.len() > 8 { bent } else { |x| x };
            let cell = [(number, (0..nodes.len()).collect())];
            let straight = mesh_of(&file_of(&nodes, &cell, "", ""));
            let mesh = mesh_of(&file_of(&nodes.iter().map(|x| map(*x)).collect::<Vec<_>>(), &cell, "", ""));
            mesh.check().unwrap();
            assert!(volume(&straight) > 0.16, "{kind:?} {turned}");
            let mut at = signorini_fem::hierarchic::Values::default();
            for (xi, _) in rule(mesh.shape(0), 4) {
                straight.map(0).tabulate(&xi, &mut at);
                let x = straight.position(0, &at);
                mesh.map(0).tabulate(&xi, &mut at);
                let error = (mesh.position(0, &at) - Point::<3>::from(map([x[0], x[1], x[2]]))).norm();
                assert!(error < 1e-14, "{kind:?} {turned}: {error:.1e} at {x:?}");
            }
        }
    }
}

/// A cube with three labelled faces, one of them shared by two of another kind.
fn labelled() -> String {
    let cells = [
        (12, (0..8).collect()),
        (9, vec![0, 3, 2, 1]),
        (9, vec![4, 5, 6, 7]),
        (9, vec![0, 1, 5, 4]),
        (3, vec![0, 1]),
        (1, vec![6]),
    ];
    file_of(&CUBE, &cells, "7 1 2 2 3 3", "0 0 0 0 5 5 5 5")
}

#[test]
fn arrays_of_integers_are_groups() {
    let mesh = mesh_of(&labelled());
    let group = |name: &str| {
        let g = &mesh.groups()[name];
        [g.sides.len(), g.cells.len(), g.vertices.len()]
    };
    assert_eq!(group("part=7"), [0, 1, 0]);
    assert_eq!(group("part=1"), [1, 0, 0]);
    assert_eq!(group("part=2"), [2, 0, 0]);
    assert_eq!(group("part=3"), [0, 0, 3]);
    assert_eq!(group("set=5"), [1, 0, 4]);
    assert_eq!(group("boundary"), [6, 0, 0]);
    // An array that numbers the points makes no groups.
    let numbered = file_of(&CUBE, &[(12, (0..8).collect())], "", "10 11 12 13 14 15 16 17");
    assert_eq!(mesh_of(&numbered).groups().len(), 1);
}

/// What ParaView writes: arrays in raw bytes behind the file, each with its count of bytes before it.
#[test]
fn raw_bytes_are_read() {
    let text = labelled();
    let (mut out, mut data, mut rest) = (String::new(), Vec::new(), text.as_str());
    while let Some(at) = rest.find("<DataArray") {
        let open = at + rest[at..].find('>').unwrap();
        let close = open + rest[open..].find("</DataArray>").unwrap();
        let (tag, values) = (&rest[at..open], rest[open + 1..close].split_whitespace());
        let bytes: Vec<u8> = match tag {
            t if t.contains("Float64") => values.flat_map(|v| v.parse::<f64>().unwrap().to_le_bytes()).collect(),
            t if t.contains("Int64") => values.flat_map(|v| v.parse::<i64>().unwrap().to_le_bytes()).collect(),
            t if t.contains("UInt8") => values.map(|v| v.parse::<u8>().unwrap()).collect(),
            _ => values.flat_map(|v| v.parse::<i32>().unwrap().to_le_bytes()).collect(),
        };
        out += &rest[..at];
        out += &tag.replace("format=\"ascii\"", &format!("format=\"appended\" offset=\"{}\"", data.len()));
        out += "/>";
        data.extend((bytes.len() as u32).to_le_bytes());
        data.extend(bytes);
        rest = &rest[close + "</DataArray>".len()..];
    }
    out += rest.trim_end().trim_end_matches("</VTKFile>");
    let mut file = (out + "<AppendedData encoding=\"raw\">\n_").into_bytes();
    file.extend(&data);
    file.extend(b"\n</AppendedData></VTKFile>\n");
    let [a, b] = [deck(&text), deck(&file)].map(|deck| build::<3>(&deck.unwrap(), &Selection::default()).unwrap());
    assert_eq!((a.nodes(), a.groups()), (b.nodes(), b.groups()));
    for length in (0..file.len()).step_by(97) {
        let _ = deck(&file[..length]);
    }
}

#[test]
fn mistakes_are_told() {
    let cube = |kind: u8, points: Vec<usize>| file_of(&CUBE, &[(kind, points)], "", "");
    let told = |text: &str| deck(text).map(|d| build::<3>(&d, &Selection::default())).unwrap_err().message;
    assert_eq!(
        told(&cube(14, vec![0, 1, 2, 3, 4])),
        "the cell 0 is a pyramid of 5 points: cells are triangles, quadrilaterals, tetrahedra, hexahedra and wedges of order 1 or 2"
    );
    assert!(told(&cube(10, vec![0, 1, 2])).starts_with("the cell 0 is a cell of VTK's type 10 (Tetra) of 3 points"));
    assert_eq!(told(&cube(10, vec![0, 1, 2, 8])), "the cell 0 has the point 8, which does not exist; there are 8");
    let far = cube(12, (0..8).collect()).replace("1.0 1.0 1.0", "1.0 nan 1.0");
    assert_eq!(told(&far), "the point 6 is at (NaN, 1, 1), expected finite numbers");
    let twice = labelled();
    let piece = &twice[twice.find("<Piece").unwrap()..twice.find("</UnstructuredGrid>").unwrap()];
    assert!(told(&twice.replace(piece, &piece.repeat(2))).starts_with("it has 2 pieces, expected one"));
    assert!(told("<VTKFile").starts_with("cannot be read as an unstructured grid of VTK"));
    let (_folder, path) = written(&[("mesh.vtu", &twice)]);
    assert!(read(&path).unwrap_err().message.contains("holds a mesh and nothing else"));
}

/// Bytes changed and lines dropped: a mesh or an error, never a panic.
#[test]
fn damaged_files_are_survived() {
    let text = labelled();
    let mut state = 12345u64;
    let mut random = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % n
    };
    for _ in 0..400 {
        let mut bytes = text.clone().into_bytes();
        for _ in 0..=random(3) {
            let at = random(bytes.len());
            match random(3) {
                0 => bytes[at] = b"0123456789 <>\"-"[random(15)],
                1 => drop(bytes.drain(at..(at + random(40)).min(bytes.len()))),
                _ => bytes.insert(at, b"019 "[random(4)]),
            }
        }
        let _ = deck(bytes).map(|d| build::<3>(&d, &Selection::default()));
    }
}
