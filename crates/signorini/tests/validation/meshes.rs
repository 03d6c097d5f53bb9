//! Membranes on meshes from Gmsh: triangles and quadrilaterals, straight and curved.

use super::{error, last_step, number, set, summary};
use serde_json::Value;
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
            // What is told of the error is of its size, also where cells have no functions of a higher degree.
            let area = (number(&contact["area"]) - PI * exact * exact).abs();
            // What straight cells lack of the round rim it cannot know.
            for (key, error) in [("area", area), ("force", force)].into_iter().filter(|_| order == 2) {
                let told = number(&contact["error_estimate"][key]);
                assert!(
                    told > 0.4 * error && told < 20.0 * error,
                    "{kind} {order} {n}: {key} {error:e}, told {told:e}"
                );
            }
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

const WAVES: &str = "-(15 + 5*cos(2*pi*x)*cos(2*pi*y))/1000";

/// Cells divide where zones are about to merge, twelve of them to the radius, and again where they have merged: areas and forces
/// are those of a grid of degree 3 on 32 x 32 cells, to 1e-6 at degree 2, in few solves.
#[test]
fn cells_of_meshes_divide_at_tips() {
    let exact = [(0.12, 0.243_425_012, 0.095_124_171, (4, 0)), (0.16, 0.430_629_405, 0.160_727_360, (1, 1))];
    for (mesh, degree, bound) in [("mixed_2_12.msh", 2, 1e-6), ("triangles_2_12.msh", 1, 3e-4)] {
        let text = case(mesh)
            .replace("\"-0.1\"", &format!("\"{WAVES}\""))
            .replace("normal = -1.0", "normal = \"-t\"")
            .replace("tension", &format!("degree = {degree}\ntension"));
        let steps = "[{ to = 0.1 }, { to = 0.16, increments = 3 }]";
        let found = summary(&text, &set(&[("steps", steps.to_string())]));
        last_step(&found);
        let states = found["steps"].as_array().expect("steps");
        for (load, area, force, counts) in exact {
            let at = |state: &&Value| (number(&state["time"]) - load).abs() < 1e-9;
            let contact = &states.iter().find(at).expect("the load")["contacts"]["touch"];
            assert_eq!((&contact["zones"], &contact["holes"]), (&counts.0.into(), &counts.1.into()), "{mesh} {load}");
            let off = [number(&contact["area"]) - area, number(&contact["force"][2]) - force].map(f64::abs);
            assert!(off[0] < bound && off[1] < bound, "{mesh}, degree {degree}, at {load}: off by {off:?}");
        }
        let solves: Vec<u64> = states.iter().filter_map(|state| state["iterations"].as_u64()).collect();
        assert!(solves[1..].iter().all(|n| *n <= 5), "{mesh}, degree {degree}: {solves:?}");
    }
}

/// A square of quadrilaterals, some of which become triangles as their neighbours divide: beside a grid of the same cells.
#[test]
fn quadrilaterals_divide_up_to_degree_2() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("square.msh");
    std::fs::write(&path, squares(8)).expect("a file");
    let name = path.display().to_string().replace('\\', "/");
    let on = |mesh: &str| case("").replace(&format!("{{ file = \"{}\", group = \"film\" }}", file("")), mesh);
    let of_file = |more: &str| on(&format!("{{ file = \"{name}\", group = \"film\"{more} }}"));
    let contact = |text: &str| last_step(&summary(text, &set(&[])))["contacts"]["touch"].clone();
    let on_grid = of_file("")
        .replace(&format!("mesh.gmsh = {{ file = \"{name}\", group = \"film\" }}"), "")
        .replace(
            "tension",
            "domain.rectangle = { min = [-1, -1], max = [1, 1] }\nmesh.grid = { cells = [40, 40] }\ntension",
        )
        .replace("film:rim", "film:boundary");
    let exact = number(&contact(&on_grid.replace("tension =", "degree = 4\ntension ="))["area"]);
    let undivided =
        number(&contact(&of_file(", refine = { most = 0 }").replace("tension", "degree = 2\ntension"))["area"]);
    for more in [", refine = { fronts = 2 }", ", refine = { negative_where = \"0.8 - hypot(x, y)\", levels = 2 }"] {
        let area = number(&contact(&of_file(more).replace("tension", "degree = 2\ntension"))["area"]);
        let off = [area - exact, undivided - exact].map(f64::abs);
        assert!(off[0] < 0.2 * off[1] && off[0] < 2e-4, "{more}: off by {:e}, undivided {:e}", off[0], off[1]);
    }
    // Of a higher degree they stay whole.
    let wrong = error(&of_file(", refine = { fronts = 1 }").replace("tension", "degree = 3\ntension"));
    assert!(wrong.message.contains("degree 3 on a mesh with local refinement"), "{wrong}");
    let whole = number(&contact(&of_file("").replace("tension", "degree = 4\ntension"))["area"]);
    assert!((whole - exact).abs() < 2e-4, "{whole} {exact}");
}

/// A square of so many quadrilaterals in each direction, as a file.
fn squares(n: usize) -> String {
    let node = |i: usize, j: usize| j * (n + 1) + i + 1;
    let place = |k: usize| 2.0 * k as f64 / n as f64 - 1.0;
    let nodes: Vec<String> = (0..=n)
        .flat_map(|j| (0..=n).map(move |i| (i, j)))
        .map(|(i, j)| format!("{} {} {} 0", node(i, j), place(i), place(j)))
        .collect();
    let sides = (0..n).flat_map(|k| {
        [
            [node(k, 0), node(k + 1, 0)],
            [node(n, k), node(n, k + 1)],
            [node(k + 1, n), node(k, n)],
            [node(0, k + 1), node(0, k)],
        ]
    });
    let cells = (0..n * n).map(|k| (k % n, k / n));
    let cells = cells.map(|(i, j)| [node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)]);
    let sides = sides.map(|[a, b]| format!("1 2 1 1 {a} {b}"));
    let elements: Vec<String> = sides.chain(cells.map(|[a, b, c, d]| format!("3 2 2 2 {a} {b} {c} {d}"))).collect();
    let numbered: Vec<String> = elements.iter().zip(1..).map(|(e, k)| format!("{k} {e}")).collect();
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n2\n1 1 \"rim\"\n2 2 \"film\"\n$EndPhysicalNames\n\
         $Nodes\n{}\n{}\n$EndNodes\n$Elements\n{}\n{}\n$EndElements\n",
        nodes.len(),
        nodes.join("\n"),
        numbered.len(),
        numbered.join("\n")
    )
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
        (film, "domain.disc = { radius = 1 }\nmesh.gmsh", "defines the domain", "domain"),
        ("triangles_1_6.msh", "none.msh", "cannot be read", "none.msh"),
        ("group = \"film\"", "group = \"film\", divisions = -1", "must be 0 to 12, not -1", "-1"),
        ("group = \"film\"", "group = \"film\", divisions = 13", "must be 0 to 12, not 13", "13"),
        ("group = \"film\"", "group = \"film\", divisions = 12", "unknowns require", "12"),
        ("group = \"film\"", "group = \"film\", divisions = \"two\"", "expected", "two"),
        ("group = \"film\"", "group = \"film\", refine = { most = 9 }", "must be 0 to 8, not 9", "9"),
        ("group = \"film\"", "group = \"film\", refine = { fronts = 3, most = 2 }", "more than 2", "2"),
        ("group = \"film\"", "group = \"film\", refine = { levels = 2 }", "without a region", "2"),
        ("\"plane\"", "\"line\"", "plane", "triangles"),
        (
            "between = [\"film\", \"floor\"]",
            "between = [\"film\", \"floor\"]\nmethod.active_set = {}",
            "requires a grid",
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
    let problem = signorini::case::read("case.toml", &case, &[]).expect("a case");
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
        match signorini::plan::plan(&problem) {
            Ok(_) => accepted += 1,
            Err(error) => {
                assert!(error.place.is_some(), "{error}");
                refused += 1;
            }
        }
    }
    assert!(refused > 100 && accepted > 5, "{refused} refused, {accepted} accepted");
}

/// Squares of one cell each from their lower left corners, side by side in one file of version 2.2; all are the physical
/// group `film`, and the bottom and top of the first the groups `bottom1` and `top1`.
fn separate_squares(corners: &[[f64; 2]]) -> String {
    let mut nodes = String::new();
    let mut elements = String::new();
    for (k, [x, y]) in corners.iter().enumerate() {
        let first = 4 * k + 1;
        for (i, [a, b]) in [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].iter().enumerate() {
            nodes += &format!("{} {} {} 0\n", first + i, x + a, y + b);
        }
        let n: Vec<usize> = (first..first + 4).collect();
        elements += &format!("{} 3 2 1 {} {} {} {} {}\n", 3 * k + 1, k + 1, n[0], n[1], n[2], n[3]);
        elements += &format!("{} 1 2 {} {} {} {}\n", 3 * k + 2, 2 * k + 2, 4 * k + 1, n[0], n[1]);
        elements += &format!("{} 1 2 {} {} {} {}\n", 3 * k + 3, 2 * k + 3, 4 * k + 3, n[2], n[3]);
    }
    let mut names = format!("{}\n2 1 \"film\"\n", 1 + 2 * corners.len());
    for k in 0..corners.len() {
        names += &format!("1 {} \"bottom{}\"\n1 {} \"top{}\"\n", 2 * k + 2, k + 1, 2 * k + 3, k + 1);
    }
    let (n, m) = (4 * corners.len(), 3 * corners.len());
    format!(
        "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n{names}$EndPhysicalNames\n$Nodes\n{n}\n{nodes}$EndNodes\n\
         $Elements\n{m}\n{elements}$EndElements\n"
    )
}

/// A membrane and a solid on a mesh from a file: cells that cover the same place are refused where the file is named.
#[test]
fn overlapping_cells_are_refused() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("two.msh");
    std::fs::write(&path, separate_squares(&[[0.0, 0.0], [0.4, 0.3]])).expect("a mesh");
    let path = path.display().to_string().replace('\\', "/");
    let film = case("MESH").replace(&file("MESH"), &path).replace("film:rim", "film:bottom1");
    let solid = SQUARES_HELD.replace("MESH", &path);
    for text in [film, solid] {
        let error = error(&text);
        for part in
            ["two.msh", "surface 1 (`film`) and surface 2 (`film`) overlap", "elements 1 and 4", "both cover (0."]
        {
            assert!(error.message.contains(part), "{}", error.message);
        }
        assert!(error.help.is_some_and(|h| h.contains("BooleanUnion")));
        assert!(error.place.is_some_and(|p| p.text[p.span].contains("two.msh")));
    }
}

/// A solid on a mesh of squares, of which the second is held on top, and the first lies on a plane.
const SQUARES_HELD: &str = r#"
space = "plane_strain"
[bodies.a.solid]
mesh.gmsh = { file = "MESH" }
degree = 2
material.linear_elastic = { youngs_modulus = 100, poissons_ratio = 0.3 }
[bodies.floor.rigid]
shape.plane = { point = [0, 0], normal = [0, 1] }
[supports.head]
on = "a:top2"
displacement = [0, "-0.01*t"]
[contacts.touch]
between = ["a:bottom1", "floor"]
[[steps]]
to = 1
"#;

/// A body in two pieces: where nothing holds one of them a run, and `check` by the same words, says why; where both are held
/// but lie on each other it is a warning.
#[test]
fn a_body_in_pieces_is_called_that() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("two.msh");
    let name = path.display().to_string().replace('\\', "/");
    let film = case("MESH").replace(&file("MESH"), &name).replace("film:rim", "film:top2");
    let solid = SQUARES_HELD.replace("MESH", &name);
    let checked = |text: &str| {
        let problem = signorini::case::read("case.toml", text, &[]).expect("a case");
        signorini::plan::plan(&problem).and_then(|plan| signorini::run::sizes(&plan))
    };
    for (second, lie) in [([0.0, 1.0], true), ([3.0, 0.0], false)] {
        std::fs::write(&path, separate_squares(&[[0.0, 0.0], second])).expect("a mesh");
        let apart = solid.replace("a:bottom1", "a:bottom2");
        for text in [&film, if lie { &solid } else { &apart }] {
            let error = error(text);
            for part in [
                "consists of 2 pieces that share no node: 1 cell about (0.5",
                "no support restrains the 1 cell about (0.5",
            ] {
                assert!(error.message.contains(part), "{}", error.message);
            }
            assert_eq!(error.message.contains("two of which touch at"), lie, "{}", error.message);
            assert!(error.help.as_ref().is_some_and(|h| h.contains("Coherence")));
            assert_eq!(checked(text).expect_err("an error").message, error.message);
        }
        let both = format!("{solid}\n[supports.middle]\non = \"a:top1\"\ndisplacement = [0, 0]\n");
        let found = checked(&both).expect("a case that is right");
        assert_eq!(found["warnings"].to_string().contains("2 pieces"), lie, "{}", found["warnings"]);
    }
}

/// Supports that contradict each other at a later time are refused before anything is computed.
#[test]
fn supports_that_contradict_later_are_refused_at_once() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("one.msh");
    std::fs::write(&path, separate_squares(&[[0.0, 0.0], [3.0, 0.0]])).expect("a mesh");
    let text = SQUARES_HELD.replace("MESH", &path.display().to_string().replace('\\', "/"));
    let text = text.replace("to = 1", "to = 1\nincrements = 4")
        + "[supports.middle]\non = \"a:top1\"\ndisplacement = [0, 0]\n[supports.again]\non = \"a:top1\"\ndisplacement = [0, \"max(0, t - 0.6)\"]\n";
    let problem = signorini::case::read("case.toml", &text, &[]).expect("a case");
    let out = folder.path().join("out");
    let refused = signorini::run::run(&problem, &out, &mut signorini_solve::Silent).err().expect("an error");
    assert!(refused.to_string().contains("contradict each other on `a`"), "{refused}");
    assert!(!out.exists());
}
