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

/// Two bars without lateral strain whose ends are joined by a lever: the force `4` on the first one is carried by
/// `k (1 + 2²)`, and the second moves twice as far, and by as much more as a node without elements is moved. In 1 and in 5³ cells
/// a bar, which other solvers take.
#[test]
fn ends_are_joined_by_a_lever() {
    for n in [1usize, 6] {
        let (folder, text) = lever(n);
        let found = summary(&text, &set(&[("output.probes.end", "[4, 1, 1]".to_string())]));
        let step = last_step(&found);
        // k = E = 1000: k u + 2 k (2 u - 0.001) = 4.
        let first = (4.0 + 2.0) / 5000.0;
        let [a, b] = ["BOT_A", "BOT_B"].map(|name| number(&step["support_forces"][name][2]));
        assert!((a + 1000.0 * first).abs() < 1e-9, "{a}");
        assert!((b + 1000.0 * (2.0 * first - 0.001)).abs() < 1e-9, "{b}");
        let end = number(&step["probes"]["end"]["displacement"][2]);
        assert!((end - (2.0 * first - 0.001)).abs() < 1e-13, "{end}");
        let sum: f64 = step["constraint_forces"].as_object().expect("forces").values().map(number).sum();
        assert!((sum - b).abs() < 1e-9, "{sum}");
        drop(folder);
    }
    // Said twice, and said otherwise.
    let (_folder, text) = lever(1);
    let again = |value: &str| {
        let terms = "{ on = \"A:node_8\", factor = [0, 0, 4] }, { on = \"B:node_108\", factor = [0, 0, -2] }";
        format!("{text}\n[constraints.again]\nterms = [{terms}]\nvalue = {value}\n")
    };
    let found = summary(&again("\"0.002*t\""), &set(&[]));
    let told = found["warnings"].to_string();
    assert!(told.contains("the constraint `equation_4` follows from supports and other constraints"), "{told}");
    let told = error(&again("0.1"));
    assert_eq!(told.message, "the constraint `equation_4` contradicts `again`");
    let told = error(&text.replace("A:node_8", "A:BOT"));
    assert!(told.message.contains("`BOT` has 4 places that can be held"), "{}", told.message);
}

/// The case of a deck with two bars of `n³` cells, and equations `2 u_A - u_B = 0.001 t` between their ends.
fn lever(n: usize) -> (TempDir, String) {
    let count = (n + 1).pow(3);
    let first = [1, 100 * n.pow(3) + 1];
    let mut deck = "*NODE\n9999, 9, 9, 9\n".to_string();
    let number = |at: [usize; 3]| at[0] + (n + 1) * (at[1] + (n + 1) * at[2]);
    let (mut ends, mut bottom) = ([Vec::new(), Vec::new()], String::new());
    for (body, first) in first.iter().enumerate() {
        for k in 0..count {
            let x = [k % (n + 1), k / (n + 1) % (n + 1), k / (n + 1).pow(2)].map(|i| i as f64 / n as f64);
            deck += &format!("{}, {}, {}, {}\n", first + k, x[0] + 3.0 * body as f64, x[1], x[2]);
            if x[2] == 1.0 {
                ends[body].push(first + k);
            }
            if x[2] == 0.0 {
                bottom += &format!("{}\n", first + k);
            }
        }
    }
    for (body, first) in first.iter().enumerate() {
        deck += &format!("*ELEMENT, TYPE=C3D8, ELSET={}\n", ["A", "B"][body]);
        for e in 0..n.pow(3) {
            let at = [e % n, e / n % n, e / n.pow(2)];
            let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
            let nodes = corners.map(|c| (first + number([at[0] + c[0], at[1] + c[1], at[2] + c[2]])).to_string());
            deck += &format!("{}, {}\n", first + e, nodes.join(", "));
        }
    }
    deck += &format!("*NSET, NSET=BOT\n{bottom}*NSET, NSET=TOP\n");
    ends[0].iter().for_each(|node| deck += &format!("{node}\n"));
    deck += "*SURFACE, NAME=END\nA, S2\n";
    deck += "*MATERIAL, NAME=EL\n*ELASTIC\n1000, 0\n*SOLID SECTION, ELSET=A, MATERIAL=EL\n*SOLID SECTION, ELSET=B, MATERIAL=EL\n";
    deck += "*EQUATION\n";
    for (a, b) in ends[0].iter().zip(&ends[1]) {
        deck += &format!("3\n{a}, 3, 2., {b}, 3, -1., 9999, 3, -1.\n");
    }
    let faces: String = (n * n * (n - 1)..n.pow(3)).map(|e| format!("{}, P2, -4\n", e + 1)).collect();
    deck += &format!(
        "*BOUNDARY\nBOT, 1, 3\n*STEP\n*STATIC\n0.5, 1.\n*BOUNDARY\n9999, 3, 3, 0.001\n*DLOAD\n{faces}*END STEP\n"
    );
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("lever.inp");
    std::fs::write(&path, deck).expect("a deck");
    let case = case_of(&path);
    (folder, case)
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

/// A sector of a tube of elements with 20 nodes under pressure, inclined in space: both cuts are held around the axis and the lower and
/// upper faces along it by `*TRANSFORM`, so that it widens as the whole tube does (Lamé, plane strain).
#[test]
fn a_tube_held_along_cylindrical_axes() {
    const EDGES: [[usize; 2]; 12] =
        [[0, 1], [1, 2], [2, 3], [3, 0], [4, 5], [5, 6], [6, 7], [7, 4], [0, 4], [1, 5], [2, 6], [3, 7]];
    const CUBE: [[usize; 3]; 8] =
        [[0, 0, 0], [2, 0, 0], [2, 2, 0], [0, 2, 0], [0, 0, 2], [2, 0, 2], [2, 2, 2], [0, 2, 2]];
    let (a, b, pressure, modulus, nu) = (1.0f64, 2.0f64, 10.0, 1000.0, 0.3);
    let (inclined, origin) = (0.7f64, [3.0, -2.0, 5.0]);
    // The axis of the tube leans by an angle in the plane of y and z.
    let turned = |[x, y, z]: [f64; 3]| {
        let (s, c) = inclined.sin_cos();
        [origin[0] + x, origin[1] + c * y - s * z, origin[2] + s * y + c * z]
    };
    let n = 3;
    let mut nodes: std::collections::BTreeMap<[usize; 3], usize> = Default::default();
    let mut elements = String::new();
    for (number, [i, j]) in (0..n * n).map(|k| [k / n, k % n]).enumerate() {
        let corner = |v: usize| [CUBE[v][0] + 2 * i, CUBE[v][1] + 2 * j, CUBE[v][2]];
        let middle = |e: &[usize; 2]| std::array::from_fn(|k| (corner(e[0])[k] + corner(e[1])[k]) / 2);
        let places: Vec<[usize; 3]> = (0..8).map(corner).chain(EDGES.iter().map(middle)).collect();
        let mut list = Vec::new();
        for place in places {
            let next = nodes.len() + 1;
            list.push(nodes.entry(place).or_insert(next).to_string());
        }
        elements += &format!("{}, {},\n{}\n", number + 1, list[..10].join(", "), list[10..].join(", "));
    }
    let (mut text, mut cut, mut low) = (String::from("*NODE, NSET=All\n"), String::new(), String::new());
    let mut by_number: Vec<_> = nodes.iter().collect();
    by_number.sort_by_key(|(_, number)| **number);
    for ([i, j, k], number) in by_number {
        let share = |v: &usize| *v as f64 / (2 * n) as f64;
        let (r, t) = (a + (b - a) * share(i), 0.9 * share(j));
        let [x, y, z] = turned([r * t.cos(), r * t.sin(), 0.2 * *k as f64]);
        text += &format!("{number}, {x:?}, {y:?}, {z:?}\n");
        if *j == 0 || *j == 2 * n {
            cut += &format!("{number}\n");
        }
        if *k != 1 {
            low += &format!("{number}\n");
        }
    }
    let [from, to] =
        [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]].map(turned).map(|x| format!("{:?}, {:?}, {:?}", x[0], x[1], x[2]));
    let pressed: String = (1..=n).map(|e| format!("{e}, P6, {pressure:?}\n")).collect();
    text += &format!(
        "*ELEMENT, TYPE=C3D20, ELSET=E\n{elements}*NSET, NSET=Cut\n{cut}*NSET, NSET=Low\n{low}*TRANSFORM, NSET=All, TYPE=C\n{from}, {to}
*MATERIAL, NAME=M\n*ELASTIC\n{modulus:?}, {nu:?}\n*SOLID SECTION, ELSET=E, MATERIAL=M\n*STEP\n*STATIC\n*BOUNDARY\nCut, 2\nLow, 3
*DLOAD\n{pressed}*END STEP\n"
    );
    let folder = tempfile::tempdir().expect("a folder");
    let deck = folder.path().join("tube.inp");
    std::fs::write(&deck, text).expect("written");
    let way = deck.display().to_string().replace('\\', "/");
    let mut case = signorini::import::case_text(&deck, &way, false).unwrap_or_else(|e| panic!("{e}"));
    let places = [(a, 0.0), (a, 0.6), (a + 1.0 / 3.0, 0.3), (b, 0.9)]
        .map(|(r, t): (f64, f64)| (r, [r * t.cos(), r * t.sin(), 0.0]));
    for (k, (_, x)) in places.iter().enumerate() {
        case += if k == 0 { "\n[output.probes]\n" } else { "" };
        case += &format!("p{k} = {:?}\n", turned(*x));
    }
    let found = summary(&case, &set(&[]));
    let scale = pressure * a * a / (b * b - a * a) * (1.0 + nu) / modulus;
    let widening = |r: f64| scale * ((1.0 - 2.0 * nu) * r + b * b / r);
    for (k, (r, x)) in places.iter().enumerate() {
        let u: [f64; 3] =
            std::array::from_fn(|i| number(&last_step(&found)["probes"][format!("p{k}")]["displacement"][i]));
        let exact = turned([x[0] / r * widening(*r), x[1] / r * widening(*r), 0.0]);
        for i in 0..3 {
            let error = (u[i] + origin[i] - exact[i]).abs() / widening(a);
            assert!(error < 5e-4, "at {x:?}: {error:.1e}");
        }
    }
}
