//! Meshes of decks: the order of nodes, the numbers of faces, groups.

use crate::written;
use signorini_fem::rules::rule;
use signorini_fem::{CellShape, Mesh};
use signorini_geometry::Point;
use signorini_import::adjust::Adjustment;
use signorini_import::element::Kind;
use signorini_import::mesh::{Selection, build};
use signorini_import::read_mesh;
use std::fmt::Write;

pub(crate) const CUBE: [[f64; 3]; 8] = [
    [0.0, 0.0, 0.0],
    [1.0, 0.0, 0.0],
    [1.0, 1.0, 0.0],
    [0.0, 1.0, 0.0],
    [0.0, 0.0, 1.0],
    [1.0, 0.0, 1.0],
    [1.0, 1.0, 1.0],
    [0.0, 1.0, 1.0],
];

/// Vertices of one element, and the edges between which CalculiX has its nodes of order 2, in its order.
pub(crate) fn element(kind: Kind) -> (&'static [[f64; 3]], &'static [[usize; 2]], &'static str) {
    const CUBE_EDGES: [[usize; 2]; 12] =
        [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
    const WEDGE: [[f64; 3]; 6] =
        [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 1.0], [0.0, 1.0, 1.0]];
    const WEDGE_EDGES: [[usize; 2]; 9] = [[0, 1], [1, 2], [2, 0], [3, 4], [4, 5], [5, 3], [0, 3], [1, 4], [2, 5]];
    const TETRAHEDRON: [[f64; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    const TETRAHEDRON_EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [1, 3], [2, 3]];
    match kind {
        Kind::Hexahedron8 => (&CUBE, &[], "C3D8"),
        Kind::Hexahedron20 => (&CUBE, &CUBE_EDGES, "C3D20R"),
        Kind::Wedge6 => (&WEDGE, &[], "C3D6"),
        Kind::Wedge15 => (&WEDGE, &WEDGE_EDGES, "C3D15"),
        Kind::Tetrahedron4 => (&TETRAHEDRON, &[], "C3D4"),
        _ => (&TETRAHEDRON, &TETRAHEDRON_EDGES, "C3D10"),
    }
}

/// A map that bends edges: of second order, so cells of 27, 18 and 10 nodes reproduce it.
pub(crate) fn bent([x, y, z]: [f64; 3]) -> [f64; 3] {
    [x + 0.1 * y * y, y - 0.05 * z * z, z + 0.1 * x * y]
}

/// A deck of one element whose nodes are counted from 101, with a surface of each face.
fn deck_of(kind: Kind, map: fn([f64; 3]) -> [f64; 3]) -> String {
    let (vertices, edges, name) = element(kind);
    let middle = |&[a, b]: &[usize; 2]| std::array::from_fn(|k| 0.5 * (vertices[a][k] + vertices[b][k]));
    let nodes: Vec<[f64; 3]> = vertices.iter().copied().chain(edges.iter().map(middle)).collect();
    let mut out = "*NODE\n".to_string();
    for (k, x) in nodes.iter().enumerate() {
        let [x, y, z] = map(*x);
        let _ = writeln!(out, "{}, {x:?}, {y:?}, {z:?}", 101 + k);
    }
    let list: Vec<String> = (0..nodes.len()).map(|k| (101 + k).to_string()).collect();
    let _ = writeln!(out, "*ELEMENT, TYPE={name}, ELSET=E\n7, {}", list.join(", "));
    for face in 1..=kind.faces().len() {
        let _ = writeln!(out, "*SURFACE, NAME=S{face}\nE, S{face}");
    }
    out
}

fn mesh_of(text: &str, selection: &Selection) -> Mesh<3> {
    let (_folder, path) = written(&[("mesh.inp", text)]);
    build::<3>(&read_mesh(&path).unwrap(), selection).unwrap()
}

pub(crate) fn volume(mesh: &Mesh<3>) -> f64 {
    let mut at = signorini_fem::hierarchic::Values::default();
    let points = rule(mesh.shape(0), 6);
    let jacobian = |xi: &[f64; 3], at: &mut _| {
        mesh.map(0).tabulate(xi, at);
        mesh.jacobian(0, at).1.determinant()
    };
    points.iter().map(|(xi, w)| w * jacobian(xi, &mut at)).sum()
}

pub(crate) const KINDS: [Kind; 6] =
    [Kind::Hexahedron8, Kind::Hexahedron20, Kind::Wedge6, Kind::Wedge15, Kind::Tetrahedron4, Kind::Tetrahedron10];

/// Every node in its place: otherwise the map is folded, or not that of the vertices, or not the bent one.
#[test]
fn nodes_of_all_elements_are_in_their_places() {
    for kind in KINDS {
        let flat = mesh_of(&deck_of(kind, |x| x), &Selection::default());
        flat.check().unwrap();
        let exact = [1.0, 0.5, 1.0 / 6.0]
            [["hexahedron", "wedge", "tetrahedron"].iter().position(|s| *s == kind.shape()).unwrap()];
        assert!((volume(&flat) - exact).abs() < 1e-14, "{kind:?}: {}", volume(&flat));
        if flat.map(0).order() == 1 {
            continue;
        }
        let curved = mesh_of(&deck_of(kind, bent), &Selection::default());
        curved.check().unwrap();
        let mut at = signorini_fem::hierarchic::Values::default();
        for xi in rule(curved.shape(0), 4).iter().map(|(xi, _)| xi) {
            flat.map(0).tabulate(xi, &mut at);
            let x = flat.position(0, &at);
            curved.map(0).tabulate(xi, &mut at);
            let want = Point::<3>::from(bent([x[0], x[1], x[2]]));
            let error = (curved.position(0, &at) - want).norm();
            assert!(error < 1e-14, "{kind:?}: {error:.1e} at {x:?}");
        }
    }
}

/// The faces of CalculiX by the plane in which they lie.
#[test]
fn faces_have_the_numbers_of_calculix() {
    let planes: [(Kind, &[[f64; 4]]); 3] = [
        (
            Kind::Hexahedron8,
            &[
                [0.0, 0.0, -1.0, 0.0],
                [0.0, 0.0, 1.0, 1.0],
                [0.0, -1.0, 0.0, 0.0],
                [1.0, 0.0, 0.0, 1.0],
                [0.0, 1.0, 0.0, 1.0],
                [-1.0, 0.0, 0.0, 0.0],
            ],
        ),
        (
            Kind::Wedge6,
            &[
                [0.0, 0.0, -1.0, 0.0],
                [0.0, 0.0, 1.0, 1.0],
                [0.0, -1.0, 0.0, 0.0],
                [1.0, 1.0, 0.0, 1.0],
                [-1.0, 0.0, 0.0, 0.0],
            ],
        ),
        (
            Kind::Tetrahedron4,
            &[[0.0, 0.0, -1.0, 0.0], [0.0, -1.0, 0.0, 0.0], [1.0, 1.0, 1.0, 1.0], [-1.0, 0.0, 0.0, 0.0]],
        ),
    ];
    for (kind, planes) in planes {
        let mesh = mesh_of(&deck_of(kind, |x| x), &Selection::default());
        for (face, [a, b, c, d]) in planes.iter().enumerate() {
            let sides = &mesh.groups()[&format!("S{}", face + 1)].sides;
            assert_eq!(sides.len(), 1, "{kind:?} S{}", face + 1);
            for node in mesh.side_vertices(sides[0]) {
                let x = mesh.nodes()[node as usize];
                assert_eq!(a * x[0] + b * x[1] + c * x[2], *d, "{kind:?} S{}", face + 1);
            }
        }
    }
}

/// A set of nodes holds a face only if the nodes of its edges are in it too.
#[test]
fn sets_hold_faces_edges_and_nodes() {
    let text = deck_of(Kind::Hexahedron20, |x| x);
    let top: Vec<u64> = [5, 6, 7, 8, 13, 14, 15, 16].map(|k| 100 + k).to_vec();
    let edge: Vec<u64> = [1, 2, 9].map(|k| 100 + k).to_vec();
    let selection = Selection {
        nodes: vec![
            ("top".into(), top.clone()),
            ("corners".into(), top[..4].to_vec()),
            ("edge".into(), edge),
            ("all".into(), (101..=120).collect()),
        ],
        sides: vec![("lid".into(), vec!["7 P2".into()])],
        ..Selection::default()
    };
    let mesh = mesh_of(&text, &selection);
    let group = |name: &str| {
        let g = &mesh.groups()[name];
        [g.sides.len(), g.cells.len(), g.vertices.len(), g.between.len()]
    };
    assert_eq!(group("top"), [1, 0, 4, 4]);
    assert_eq!(group("corners"), [0, 0, 4, 0]);
    assert_eq!(group("edge"), [0, 0, 2, 1]);
    assert_eq!(group("all"), [6, 1, 8, 12]);
    assert_eq!(mesh.groups()["lid"].sides, mesh.groups()["S2"].sides);
    assert_eq!(mesh.shape(0), CellShape::Hexahedron);
}

#[test]
fn connected_parts_are_selected_by_a_node() {
    let one = deck_of(Kind::Tetrahedron4, |x| x);
    let two = format!(
        "{one}*NODE\n1, 5, 0, 0\n2, 6, 0, 0\n3, 5, 1, 0\n4, 5, 0, 1\n*ELEMENT, TYPE=C3D4, ELSET=E\n8, 1, 2, 3, 4\n"
    );
    let select = |node| Selection { connected_to: Some(node), ..Selection::default() };
    for (node, left) in [(3, 5.0), (104, 0.0)] {
        let mesh = mesh_of(&two, &select(node));
        assert_eq!(mesh.cell_count(), 1);
        assert_eq!(mesh.nodes().iter().map(|x| x[0]).fold(f64::INFINITY, f64::min), left);
    }
    let (_folder, path) = written(&[("mesh.inp", &two)]);
    let error = build::<3>(&read_mesh(&path).unwrap(), &select(99)).unwrap_err();
    assert_eq!(error.message, "no element of the body has the node 99");
}

/// Nodes of a surface, also those in the middle of its edges, are moved to the closest points of another one.
#[test]
fn nodes_are_moved_onto_a_surface() {
    let one = deck_of(Kind::Hexahedron20, |x| x);
    // A plate below whose upper face is at z = -0.01, inclined by 0.02 along x.
    let plate = "*NODE\n1, -1, -1, -1\n2, 2, -1, -1\n3, 2, 2, -1\n4, -1, 2, -1
5, -1, -1, -0.03\n6, 2, -1, 0.03\n7, 2, 2, 0.03\n8, -1, 2, -0.03
*ELEMENT, TYPE=C3D8, ELSET=Plate\n8, 1, 2, 3, 4, 5, 6, 7, 8\n*SURFACE, NAME=Upper\nPlate, S2\n";
    let text = format!("{one}{plate}*NSET, NSET=One\n101\n");
    let select = |within, nodes: Option<&str>| Selection {
        group: Some("E".into()),
        adjust: vec![Adjustment { surface: "S1".into(), to: "Upper".into(), within, nodes: nodes.map(str::to_string) }],
        ..Selection::default()
    };
    // How far the nodes of the lower face are from the plane z = 0.02 x - 0.01.
    let left = |selection: &Selection| -> Vec<f64> {
        let mesh = mesh_of(&text, selection);
        let gap = |x: &Point<3>| (x[2] - 0.02 * x[0] + 0.01).abs() / 1.0f64.hypot(0.02);
        let mut list: Vec<f64> = mesh.nodes().iter().filter(|x| x[2] < 0.1).map(gap).collect();
        list.sort_by(f64::total_cmp);
        list
    };
    // All eight nodes of the face move, and the ninth in its middle follows.
    let all = left(&select(Some(0.1), None));
    assert!(all.len() == 9 && all[8] < 1e-15, "{all:?}");
    // At x = 0 and x = 1 nodes are 0.01 away, at x = 0.5 none.
    let near = left(&select(Some(0.005), None));
    assert!(near[2] < 1e-15 && near[3] > 0.0 && near[8] < 0.0101, "{near:?}");
    let one = left(&select(None, Some("One")));
    assert!(one[0] < 1e-15 && (one[8] - 0.01 / 1.0f64.hypot(0.02)).abs() < 1e-12, "{one:?}");
}
