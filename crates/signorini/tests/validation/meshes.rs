//! Membranes on meshes from Gmsh: triangles and quadrilaterals, straight and curved.

use super::{error, last_step, number, set, summary};
use signorini_verify::flat_floor::{FlatFloor, Kind};
use std::f64::consts::PI;

fn file(name: &str) -> String {
    format!("{}/tests/data/meshes/{name}", env!("CARGO_MANIFEST_DIR")).replace('\\', "/")
}

pub fn case(mesh: &str) -> String {
    format!(
        r#"
space = "plane"
[bodies.film.membrane]
mesh.gmsh = {{ file = "{}", group = "film" }}
tension = 1.0
[bodies.floor.rigid]
shape.height = "-0.1"
[supports.rim]
on = "film:rim"
displacement = 0.0
[loads.press]
on = "film"
normal = -1.0
[contacts.touch]
between = ["film", "floor"]
"#,
        file(mesh)
    )
}

#[test]
fn the_front_converges_on_meshes_of_all_kinds() {
    let floor = FlatFloor { tension: 1.0, load: 1.0, depth: 0.1, radius: 1.0, kind: Kind::Round };
    let exact = floor.contact_radius().expect("contact");
    for (kind, order, least) in [("triangles", 1, 1.8), ("mixed", 1, 1.8), ("triangles", 2, 3.0), ("mixed", 2, 3.0)] {
        let errors = [6, 12].map(|n| {
            let found = summary(&case(&format!("{kind}_{order}_{n}.msh")), &set(&[]));
            let contact = &last_step(&found)["contacts"]["touch"];
            let error = ((number(&contact["area"]) / PI).sqrt() - exact).abs();
            let force = (number(&contact["force"][2]) - PI * exact * exact).abs();
            assert!(force < 8.0 * error, "{kind} {order} {n}: force {force:e}, radius {error:e}");
            error
        });
        let observed = (errors[0] / errors[1]).log2();
        assert!(observed > least, "{kind}, order {order}: {errors:?}, order {observed:.2}");
        assert!(errors[1] < [2e-3, 2e-5][order - 1], "{kind}, order {order}: {errors:?}");
    }
}

/// Cells of a file divided into four: at every degree the error falls as on finer files, on large meshes by multigrid.
#[test]
fn divided_cells_are_as_good_as_finer_ones() {
    let floor = FlatFloor { tension: 1.0, load: 1.0, depth: 0.1, radius: 1.0, kind: Kind::Round };
    let exact = floor.contact_radius().expect("contact");
    let divided = |mesh: &str, divisions: usize, degree: usize| {
        let text = case(mesh).replace("group = \"film\"", &format!("group = \"film\", divisions = {divisions}"));
        let found = summary(&text.replace("tension", &format!("degree = {degree}\ntension")), &set(&[]));
        let step = last_step(&found);
        let radius = (number(&step["contacts"]["touch"]["area"]) / PI).sqrt();
        (step["solver"].as_str().expect("a solver").to_string(), (radius - exact).abs())
    };
    for mesh in ["triangles_2_6.msh", "mixed_2_6.msh"] {
        let errors = [1, 2].map(|divisions| divided(mesh, divisions, 1).1);
        let observed = (errors[0] / errors[1]).log2();
        assert!(observed > 1.8, "{mesh}: {errors:?}, order {observed:.2}");
        // At degree 2 what is left is how well the curved sides of the file draw a circle.
        let error = divided(mesh, 1, 2).1;
        assert!(error < 2e-6, "{mesh}: {error:e}");
    }
    for (divisions, degree, least) in [(4, 1, 4e-6), (3, 2, 3e-7)] {
        let (solver, error) = divided("triangles_2_12.msh", divisions, degree);
        assert_eq!(solver, "multigrid");
        assert!(error < least, "degree {degree}: {error:e}");
    }
}

/// A ring held at both edges touches in a ring: beside the same ring by its radius.
#[test]
fn groups_of_a_mesh_hold_a_ring() {
    let ring = case("annulus.msh").replace("-0.1", "-0.05")
        + "[supports.hole]\non = \"film:hole\"\ndisplacement = \"-0.02 + 0.0*x\"\n";
    let found = summary(&ring, &set(&[]));
    let contact = &last_step(&found)["contacts"]["touch"];
    let round = ring
        .replace("plane", "axisymmetric")
        .replace(
            &format!("mesh.gmsh = {{ file = \"{}\", group = \"film\" }}", file("annulus.msh")),
            "domain.interval = { from = 0.2, to = 1.0 }\nmesh.grid = { cells = [60] }\ndegree = 4",
        )
        .replace("film:rim", "film:right")
        .replace("film:hole", "film:left");
    let exact_run = summary(&round, &set(&[]));
    let exact = &last_step(&exact_run)["contacts"]["touch"];
    assert_eq!((&contact["zones"], &contact["holes"]), (&1.into(), &1.into()));
    for (key, a, b) in [("area", &contact["area"], &exact["area"]), ("force", &contact["force"][2], &exact["force"][2])]
    {
        let (a, b) = (number(a), number(b));
        assert!((a - b).abs() < 1.5e-4 * b, "{key}: {a}, by the radius {b}");
    }
    let inner = &last_step(&found)["support_forces"]["hole"][2];
    let exact_inner = &last_step(&exact_run)["support_forces"]["hole"][2];
    assert!((number(inner) - number(exact_inner)).abs() < 5e-4 * number(exact_inner).abs(), "{inner} {exact_inner}");
}

#[test]
fn mistakes_are_told() {
    let good = case("triangles_1_6.msh");
    let film = "mesh.gmsh";
    for (from, to, what, place) in [
        ("film:rim", "film:rims", "rims", "film:rims"),
        ("group = \"film\"", "group = \"foil\"", "foil", "triangles"),
        ("tension = 1.0", "tension = 1.0\ndegree = 3", "degree 3", "3"),
        ("tension = 1.0", "tension = 1.0\ndegree = 7", "degree 7", "7"),
        (film, "domain.disc = { radius = 1 }\nmesh.gmsh", "is the domain", "domain"),
        ("triangles_1_6.msh", "none.msh", "cannot be read", "none.msh"),
        ("group = \"film\"", "group = \"film\", divisions = -1", "0 to 12 times, not -1", "-1"),
        ("group = \"film\"", "group = \"film\", divisions = 13", "0 to 12 times, not 13", "13"),
        ("group = \"film\"", "group = \"film\", divisions = 12", "unknowns would need", "12"),
        ("group = \"film\"", "group = \"film\", divisions = \"two\"", "expected", "two"),
        ("\"plane\"", "\"line\"", "plane", "triangles"),
        (
            "between = [\"film\", \"floor\"]",
            "between = [\"film\", \"floor\"]\nmethod.active_set = {}",
            "works on a grid",
            "triangles",
        ),
    ] {
        assert!(good.contains(from), "{from}");
        let wrong = error(&good.replace(from, to));
        assert!(wrong.message.contains(what), "{to}: {wrong}");
        let at = wrong.place.as_ref().expect("a place");
        assert!(at.text[at.span.clone()].contains(place), "{to}: {}", wrong.one_line());
    }
}

/// Damaged meshes: cut short, a node beyond the others, a cell turned over, a cell without area, a node missing.
#[test]
fn damaged_meshes_are_told() {
    let text = std::fs::read_to_string(file("triangles_1_6.msh")).expect("a mesh");
    let folder = tempfile::tempdir().expect("a folder");
    let good = case("triangles_1_6.msh");
    let elements = text.find("$Elements").expect("elements");
    let last_cell = text.trim_end().trim_end_matches("$EndElements").trim_end();
    let (kept, cell) = last_cell.rsplit_once('\n').expect("lines");
    let corners: Vec<&str> = cell.split_whitespace().collect();
    let [number, a, b, c] = corners[..] else { panic!("{cell}") };
    let with_cell = |nodes: String| format!("{kept}\n{number} {nodes}\n$EndElements\n");
    for (name, damaged) in [
        ("cut.msh", text[..elements / 2].to_string()),
        ("turned.msh", with_cell(format!("{a} {c} {b}"))),
        ("flat.msh", with_cell(format!("{a} {b} {b}"))),
        ("missing.msh", with_cell(format!("{a} {b} 999999"))),
        ("empty.msh", String::new()),
    ] {
        let path = folder.path().join(name);
        std::fs::write(&path, damaged).expect("written");
        let wrong = error(&good.replace(&file("triangles_1_6.msh"), &path.display().to_string().replace('\\', "/")));
        assert!(wrong.to_string().contains(name), "{wrong}");
    }
}

/// Bytes changed, lines dropped, doubled and swapped, numbers made huge: an error or a plan, never a panic.
#[test]
fn hostile_meshes_are_survived() {
    let text = std::fs::read_to_string(file("mixed_2_6.msh")).expect("a mesh");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("hostile.msh");
    let case = case("mixed_2_6.msh").replace(&file("mixed_2_6.msh"), &path.display().to_string().replace('\\', "/"));
    let document = signorini::case::Document::parse("case.toml", &case, &[]).expect("a case");
    let mut state = 12345u64;
    let mut random = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % n.max(1)
    };
    let (mut refused, mut accepted) = (0, 0);
    for _ in 0..300 {
        let mut lines: Vec<String> = text.lines().map(str::to_string).collect();
        for _ in 0..=random(3) {
            let at = random(lines.len());
            match random(6) {
                0 => drop(lines.remove(at)),
                1 => lines.insert(at, lines[at].clone()),
                2 => {
                    let other = random(lines.len());
                    lines.swap(at, other);
                }
                3 => lines[at] = ["1e308", "-1", "nan", "99999999999", "0 0 0", "inf inf 0"][random(6)].into(),
                4 => lines.truncate(at.max(1)),
                _ => {
                    let mut bytes = lines[at].clone().into_bytes();
                    if !bytes.is_empty() {
                        let k = random(bytes.len());
                        bytes[k] = b"0123456789 -.e"[random(14)];
                    }
                    lines[at] = String::from_utf8_lossy(&bytes).into_owned();
                }
            }
            if lines.is_empty() {
                break;
            }
        }
        std::fs::write(&path, lines.join("\n")).expect("written");
        match signorini::plan::plan(&document) {
            Ok(_) => accepted += 1,
            Err(error) => {
                assert!(error.place.is_some(), "{error}");
                refused += 1;
            }
        }
    }
    assert!(refused > 100 && accepted > 5, "{refused} refused, {accepted} accepted");
}
