//! Decks of other programs, from the file to the answer.

use super::{error, last_step, number, set, summary};
use signorini::import::{case, read};
use std::path::Path;
use tempfile::TempDir;

/// Two cubes, the lower one of 8 nodes, the upper one of 20: on planes of symmetry, pressed on each other by forces on nodes
/// and by a pressure, together `stress` on the area 1.
fn cubes(stress: f64) -> (TempDir, String) {
    let corners = [[0, 0], [2, 0], [2, 2], [0, 2]];
    let middles = [[1, 0], [2, 1], [1, 2], [0, 1]];
    let mut nodes = Vec::new();
    let mut layer = |list: &[[i32; 2]], z: f64| {
        for [x, y] in list {
            let number = nodes.len() + 1;
            nodes.push(format!("{number}, {}, {}, {z}", f64::from(*x) / 2.0, f64::from(*y) / 2.0));
        }
    };
    // 1 to 8: the lower cube; 9 to 28: the upper one, with the middles of edges below, above and between.
    [0.0, 1.0].into_iter().for_each(|z| layer(&corners, z));
    [1.0, 2.0].into_iter().for_each(|z| layer(&corners, z));
    [1.0, 2.0].into_iter().for_each(|z| layer(&middles, z));
    layer(&corners, 1.5);
    let nodes = nodes.join("\n");
    let list = |from: u32, to: u32| (from..=to).map(|k| k.to_string()).collect::<Vec<_>>().join(", ");
    let text = format!(
        "*NODE\n{nodes}
*ELEMENT, TYPE=C3D8, ELSET=Low\n1, {}
*ELEMENT, TYPE=C3D20, ELSET=High\n2, {}\n
*NSET, NSET=Bottom\n1, 2, 3, 4
*NSET, NSET=X0\n1, 4, 5, 8, 9, 12, 13, 16, 20, 24, 25, 28
*NSET, NSET=Y0\n1, 2, 5, 6, 9, 10, 13, 14, 17, 21, 25, 26
*NSET, NSET=Ledge\n5, 6, 7, 8
*SURFACE, NAME=Slave\nHigh, S1
*SURFACE, NAME=Master\nLow, S2
*MATERIAL, NAME=EL\n*ELASTIC\n1.e6, .25
*SOLID SECTION, ELSET=Low, MATERIAL=EL
*SOLID SECTION, ELSET=High, MATERIAL=EL
*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD
*CONTACT PAIR, INTERACTION=I\nSlave, Master
*BOUNDARY\nBottom, 3\nX0, 1\nY0, 2
*STEP\n*STATIC\n*DLOAD\nHigh, P2, {stress}\n*CLOAD\nLedge, 3, -0.75\n*END STEP",
        list(1, 8),
        list(9, 28)
    );
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("cubes.inp");
    std::fs::write(&path, text).expect("a deck");
    let case = case_of(&path);
    (folder, case)
}

/// The case of a deck, which may stand anywhere.
fn case_of(path: &Path) -> String {
    let deck = read(path).unwrap_or_else(|e| panic!("{e}"));
    case::text(&deck, &path.display().to_string().replace('\\', "/")).unwrap_or_else(|e| panic!("{e}"))
}

/// Uniform compression: 10 below the forces on the nodes of the ledge, which are 3 together, and 10 above.
#[test]
fn pressed_cubes_have_the_stress_of_a_bar() {
    let (_folder, text) = cubes(10.0);
    let found = summary(&text, &set(&[]));
    let step = last_step(&found);
    let contact = &step["contacts"]["Slave_Master"];
    assert!((number(&contact["force"][2]) - 10.0).abs() < 1e-9, "{contact}");
    // The cubes slide on each other by a part of their strain, 1e-5, which is also that of the pressure.
    assert!((number(&contact["max_pressure"]) / 10.0 - 1.0).abs() < 1e-5, "{contact}");
    // σ²/2E in each cube: 13 in the lower one, 10 in the upper one.
    let energy = (13.0f64.powi(2) + 10.0f64.powi(2)) / 2e6;
    assert!((number(&step["energy"]) / energy - 1.0).abs() < 1e-5, "{}", step["energy"]);
}

/// A bar of two materials that share nodes, with forces at its end and on the shared nodes: the tie between its parts carries the
/// first, and both parts stretch by their own stiffness.
#[test]
fn a_bar_of_two_materials_is_tied() {
    let corners = [[0, 0], [1, 0], [1, 1], [0, 1]];
    let nodes: Vec<String> =
        (0..12).map(|k| format!("{}, {}, {}, {}", k + 1, corners[k % 4][0], corners[k % 4][1], k / 4)).collect();
    let text = format!(
        "*NODE\n{}\n*ELEMENT, TYPE=C3D8, ELSET=LOW\n1, 1, 2, 3, 4, 5, 6, 7, 8
*ELEMENT, TYPE=C3D8, ELSET=HIGH\n2, 5, 6, 7, 8, 9, 10, 11, 12
*NSET, NSET=BOT\n1, 2, 3, 4\n*NSET, NSET=MID\n5, 6, 7, 8\n*NSET, NSET=TOP\n9, 10, 11, 12
*NSET, NSET=X0\n1, 4, 5, 8, 9, 12\n*NSET, NSET=Y0\n1, 2, 5, 6, 9, 10
*MATERIAL, NAME=A\n*ELASTIC\n1000, 0\n*MATERIAL, NAME=B\n*ELASTIC\n2000, 0
*SOLID SECTION, ELSET=LOW, MATERIAL=A\n*SOLID SECTION, ELSET=HIGH, MATERIAL=B
*BOUNDARY\nBOT, 3\nX0, 1\nY0, 2\n*STEP\n*STATIC\n*CLOAD\nTOP, 3, 1\nMID, 3, 0.5\n*END STEP",
        nodes.join("\n")
    );
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("bar.inp");
    std::fs::write(&path, text).expect("a deck");
    let found = summary(&case_of(&path), &set(&[("output.probes.end", "[1, 1, 2]".to_string())]));
    let step = last_step(&found);
    let pull = number(&step["contacts"]["LOW_HIGH_joined"]["force"][2]);
    assert!((pull - 4.0).abs() < 1e-9, "{pull}");
    let stretch = 6.0 / 1000.0 + 4.0 / 2000.0;
    let end = number(&step["probes"]["end"]["displacement"][2]);
    assert!((end - stretch).abs() < 1e-12, "{end} instead of {stretch}");
}

/// Keys of `mesh.file` that do not fit its file are told at their place.
#[test]
fn wrong_groups_of_decks_are_told() {
    let (_folder, text) = cubes(1.0);
    for (with, told) in [
        ("group = \"Lo\"", "there is no set of elements `Lo`; the file has `High`, `Low`"),
        ("group = \"Low\"\nnodes.odd = [99]", "the group `odd` contains no node of the body"),
        ("group = \"Low\"\nsides.odd = [\"1 S9\"]", "the element 1, a hexahedron, has the faces 1 to 6, not 9"),
        ("group = \"Low\"\nconnected_to = 99", "no element of the body has the node 99"),
    ] {
        let wrong = error(&text.replace("group = \"Low\"", with)).one_line();
        assert!(wrong.contains(told), "{wrong}");
    }
}
