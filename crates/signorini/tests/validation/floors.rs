//! Rigid shapes beside membranes: seen from above, from below, several of them, and membranes between two.

use super::{error, last_step, number, set, summary};
use signorini_verify::flat_floor::{FlatFloor, Kind};
use std::f64::consts::PI;

/// A membrane without load over a shape that is pushed up into it.
fn pushed(space: &str, shape: &str, up: f64) -> String {
    let (domain, cells) = match space {
        "plane" => ("disc = { radius = 1.0 }", "[24, 24]"),
        "line" => ("interval = { from = -1.0, to = 1.0 }", "[60]"),
        _ => ("interval = { from = 0.0, to = 1.0 }", "[60]"),
    };
    format!(
        r#"
space = "{space}"
[bodies.film.membrane]
domain.{domain}
mesh.grid = {{ cells = {cells} }}
degree = 4
tension = 1.0
[bodies.die.rigid]
shape.{shape}
motion.prescribed = {{ displacement = [0, 0, {up}] }}
[supports.rim]
on = "film:boundary"
displacement = 0.0
[contacts.touch]
between = ["film", "die"]
"#
    )
}

fn touch(case: &str) -> (f64, f64) {
    let found = summary(case, &set(&[]));
    let contact = &last_step(&found)["contacts"]["touch"];
    (number(&contact["area"]), number(&contact["force"][2]))
}

/// The radius at which a body of revolution of height `h` leaves a round membrane of radius 1: `h = h' r ln r`.
fn leaves(height: impl Fn(f64) -> f64, slope: impl Fn(f64) -> f64) -> f64 {
    let (mut low, mut high) = (1e-6, 0.9);
    for _ in 0..200 {
        let r = 0.5 * (low + high);
        // The membrane outside is h'(r) r ln(x), which meets the rim at zero.
        if height(r) > slope(r) * r * r.ln() { low = r } else { high = r }
    }
    low
}

#[test]
fn bodies_of_revolution_are_followed_exactly() {
    let up = 0.15;
    let sphere = |r: f64| (4.0 - r * r).sqrt() - 2.0 + up;
    let sphere_slope = |r: f64| -r / (4.0 - r * r).sqrt();
    let paraboloid = |r: f64| up - r * r / 3.0;
    let paraboloid_slope = |r: f64| -r / 1.5;
    let ellipsoid = |r: f64| 0.5 * (1.0 - r * r / 1.21).sqrt() - 0.5 + up;
    let ellipsoid_slope = |r: f64| -0.5 * r / (1.21 * (1.0 - r * r / 1.21).sqrt());
    let cone = |r: f64| up - 0.2 * r;
    let cone_slope = |_: f64| -0.2;
    let cases: [(&str, f64, f64); 4] = [
        ("sphere = { center = [0, 0, -2], radius = 2 }", leaves(sphere, sphere_slope), 0.0),
        (
            "paraboloid = { apex = [0, 0, 0], axis = [0, 0, -1], radius = 1.5 }",
            leaves(paraboloid, paraboloid_slope),
            1.0,
        ),
        ("ellipsoid = { center = [0, 0, -0.5], semi_axes = [1.1, 1.1, 0.5] }", leaves(ellipsoid, ellipsoid_slope), 2.0),
        ("cone = { apex = [0, 0, 0], axis = [0, 0, -1], half_angle = \"atan(5)\" }", leaves(cone, cone_slope), 3.0),
    ];
    for (shape, c, kind) in cases {
        let slope = [sphere_slope(c), paraboloid_slope(c), ellipsoid_slope(c), cone_slope(c)][kind as usize];
        for (space, tolerance) in [("axisymmetric", 1e-9), ("plane", 1e-6)] {
            let (area, force) = touch(&pushed(space, shape, up));
            assert!(((area / PI).sqrt() - c).abs() < tolerance, "{shape} in {space}: {} {c}", (area / PI).sqrt());
            assert!((force + 2.0 * PI * c * slope).abs() < 10.0 * tolerance, "{shape} in {space}: {force}");
        }
    }
}

/// On a line a cylinder: the string leaves it along its tangent.
#[test]
fn a_cylinder_under_a_string() {
    let up = 0.1;
    let (mut low, mut high) = (0.0, 0.9);
    for _ in 0..200 {
        let x = 0.5 * (low + high);
        let (h, slope) = (f64::sqrt(1.0 - x * x) - 1.0 + up, -x / f64::sqrt(1.0 - x * x));
        if h + slope * (1.0 - x) > 0.0 { low = x } else { high = x }
    }
    let (length, _) = touch(&pushed("line", "cylinder = { point = [0, -1], radius = 1 }", up));
    assert!((length - 2.0 * low).abs() < 1e-9, "{length} {}", 2.0 * low);
    let turned = "cylinder = { point = [0.1, 0, -1], axis = [0, 2, 0], radius = 1 }";
    let along = "cylinder = { point = [0, 0.1, -1], axis = [-3, 0, 0], radius = 1 }";
    // It runs on to the rim, so the membrane has to come down to it.
    let load = "[loads.press]\non = \"film\"\nnormal = -1.0\n";
    let [one, other] = [turned, along].map(|shape| touch(&(pushed("plane", shape, -0.1) + load)));
    assert!(one.0 > 0.1);
    assert!((one.0 - other.0).abs() < 1e-6 * one.0 && (one.1 - other.1).abs() < 1e-6 * one.1);
}

/// A ring touches in a ring, which a torus on a line does at its crown.
#[test]
fn a_torus_touches_in_a_ring() {
    let torus = "torus = { center = [0, 0, -0.3], axis = [0, 0, 1], major_radius = 0.5, minor_radius = 0.3 }";
    let flat = touch(&pushed("axisymmetric", torus, 0.05));
    let found = summary(&pushed("plane", torus, 0.05), &set(&[]));
    let contact = &last_step(&found)["contacts"]["touch"];
    assert_eq!((&contact["zones"], &contact["holes"]), (&1.into(), &1.into()));
    assert!((number(&contact["area"]) / flat.0 - 1.0).abs() < 1e-4, "{} {}", contact["area"], flat.0);
}

#[test]
fn shapes_that_are_no_floor_are_told() {
    for (space, shape, word) in [
        ("axisymmetric", "sphere = { center = [0.1, 0, -2], radius = 2 }", "on the axis"),
        ("plane", "sphere = { center = [0, 0, -2], radius = -2 }", "must be positive"),
        ("plane", "cylinder = { point = [0, 0, -2], radius = 2 }", "requires an `axis`"),
        ("plane", "cylinder = { point = [0, 0, -2], axis = [0, 0, 1], radius = 2 }", "must be horizontal"),
        ("plane", "paraboloid = { apex = [0, 0, 0], axis = [1, 0, -1], radius = 2 }", "vertically down"),
        (
            "plane",
            "torus = { center = [0, 0, -1], axis = [1, 0, 0], major_radius = 1, minor_radius = 0.3 }",
            "must be vertical",
        ),
        ("plane", "ellipsoid = { center = [0, 0, -1], semi_axes = [1, 0, 1] }", "positive"),
        ("axisymmetric", "ellipsoid = { center = [0, 0, -1], semi_axes = [1, 2, 1] }", "must be equal"),
        ("plane", "cone = { apex = [0, 0, 0], axis = [0, 1, -1], half_angle = 1 }", "vertically down"),
        ("plane", "cone = { apex = [0, 0, 0], axis = [0, 0, -1], half_angle = 2 }", "half angle"),
        ("plane", "level_set = { negative_inside = \"z\", min = [-1, -1, 1], max = [1, 1, -1] }", "box is empty"),
        ("plane", "level_set = { negative_inside = \"z + 0/0\", min = [-1, -1, -1], max = [1, 1, 1] }", "finite"),
        ("plane", "level_set = { negative_inside = \"z + sqrt(x)\", min = [-1, -1, -1], max = [1, 1, 1] }", "finite"),
        ("line", "stl = { file = \"none.stl\" }", "in the plane"),
        ("plane", "stl = { file = \"none.stl\" }", "cannot"),
        ("plane", "nurbs = { file = \"none.json\" }", "not available"),
    ] {
        let found = error(&pushed(space, shape, 0.0));
        assert!(found.place.is_some() && found.one_line().contains(word), "{shape}: {}", found.one_line());
    }
}

/// A ridge pressed into a string is smooth to no degree: the place is told. Smooth floors are not suspected.
#[test]
fn kinks_of_the_floor_in_contact_are_told() {
    let ridge = pushed("line", "height = \"0.0*x\"", 0.0)
        .replace("shape.height = \"0.0*x\"", "shape.height = \"-0.2*abs(x - 0.1)\"")
        .replace("[0, 0, 0]", "[0, 0, 0.1]")
        .replace("[contacts.touch]", "[loads.press]\non = \"film\"\nnormal = -2.0\n[contacts.touch]");
    let found = summary(&ridge, &set(&[]));
    let warnings = found["warnings"].to_string();
    assert!(warnings.contains("kink") && warnings.contains("(0.1"), "{warnings}");
    for smooth in [
        "sphere = { center = [0, 0, -2], radius = 2 }",
        "paraboloid = { apex = [0, 0, 0], axis = [0, 0, -1], radius = 1.5 }",
    ] {
        for space in ["axisymmetric", "plane"] {
            let found = summary(&pushed(space, smooth, 0.15), &set(&[]));
            assert!(!found["warnings"].to_string().contains("kink"), "{smooth}");
        }
    }
    let waves =
        summary(super::example("cosine_disc"), &set(&[("steps", "[]".into()), ("loads.press.normal", "-0.3".into())]));
    assert!(!waves["warnings"].to_string().contains("kink"));
}

/// Benchmark A4, a parabolic cap over a flat floor at the height of the rim: the membrane leaves the cap where
/// `ln(1/s²) = ρ²/s² - 1`. The foot of the cap is a valley, along which contact would have to pull.
#[test]
fn the_foot_of_a_cap_is_bridged() {
    let (rho, height) = (0.5, 0.1);
    let (mut low, mut high) = (1e-3, rho);
    for _ in 0..200 {
        let s: f64 = 0.5 * (low + high);
        if s.powi(-2).ln() < rho * rho / (s * s) - 1.0 { low = s } else { high = s }
    }
    let force = 4.0 * PI * height * low * low / (rho * rho);
    for (space, r2, tolerance) in [("axisymmetric", "x^2", 1e-9), ("plane", "(x^2 + y^2)", 1e-6)] {
        let cap = format!("height = \"{height} * max(0, 1 - {r2} / {rho}^2)\"");
        let found = touch(&pushed(space, &cap, 0.0));
        assert!(((found.0 / PI).sqrt() - low).abs() < tolerance, "{space}: {found:?}");
        assert!((found.1 - force).abs() < 10.0 * tolerance, "{space}: {found:?}");
    }
}

/// A string pressed into a valley of two slopes bridges it over `(2 j - 2 √(2γ/T)) T/f`, and lies in it where adhesion holds it.
#[test]
fn valleys_are_bridged_as_far_as_adhesion_lets_them() {
    let (slope, deep, at, press) = (0.3, 0.4, 0.013, 3.0);
    for (energy, zones) in [(0.0, 2), (0.005, 2), (0.03, 2), (0.08, 1)] {
        let adhesive = f64::sqrt(2.0 * energy);
        let bridged = (2.0 * (slope - adhesive) / press).max(0.0);
        // From each support down to where it touches: a parabola that leaves the floor with the adhesive slope.
        let free = |width: f64| {
            let drop = deep - slope * width;
            ((adhesive * adhesive + 2.0 * press * drop).sqrt() - adhesive) / press
        };
        let exact = 2.0 - free(1.0 - at) - free(1.0 + at) - bridged;
        let shape = format!("height = \"-{deep} + {slope} * abs(x - {at})\"");
        let mut case = pushed("line", &shape, 0.0) + &format!("adhesion.energy = {energy}\n");
        case += &format!("[loads.press]\non = \"film\"\nnormal = -{press}\n");
        let found = summary(&case, &set(&[]));
        let contact = &last_step(&found)["contacts"]["touch"];
        assert_eq!(contact["zones"], zones, "{energy}");
        assert!((number(&contact["area"]) - exact).abs() < 1e-9, "{energy}: {} {exact}", contact["area"]);
        assert_eq!(found["warnings"].to_string().contains("kink"), zones == 1, "{energy}");
    }
}

/// Three flat slopes that meet in a pit are touched in three zones, the pit and its valleys bridged.
#[test]
fn valleys_in_the_plane_divide_the_contact() {
    let pit = "height = \"-0.4 + max(0.1*x, 0.15*(y - 0.02), -0.2*x - 0.05*y)\"";
    let case = pushed("plane", pit, 0.0) + "[loads.press]\non = \"film\"\nnormal = -3.0\n";
    let finer =
        [("bodies.film.membrane.degree", "2".into()), ("bodies.film.membrane.mesh.grid.cells", "[40, 40]".into())];
    let found = summary(&case, &set(&finer));
    let contact = &last_step(&found)["contacts"]["touch"];
    assert_eq!((&contact["zones"], &contact["holes"]), (&3.into(), &0.into()));
    // On flat slopes the pressure is the load.
    assert!((number(&contact["force"][2]) / number(&contact["area"]) - 3.0).abs() < 1e-6);
}

/// Upside down everything is the same, with the other sign.
#[test]
fn bodies_above_are_those_below_upside_down() {
    for (space, below, above) in [
        ("axisymmetric", "sphere = { center = [0, 0, -2], radius = 2 }", "sphere = { center = [0, 0, 2], radius = 2 }"),
        (
            "plane",
            "ellipsoid = { center = [0.1, 0, -0.5], semi_axes = [1.1, 0.9, 0.5] }",
            "ellipsoid = { center = [0.1, 0, 0.5], semi_axes = [1.1, 0.9, 0.5] }",
        ),
        (
            "plane",
            "torus = { center = [0, 0, -0.3], axis = [0, 0, 1], major_radius = 0.5, minor_radius = 0.3 }",
            "torus = { center = [0, 0, 0.3], axis = [0, 0, 1], major_radius = 0.5, minor_radius = 0.3 }",
        ),
        (
            "axisymmetric",
            "cone = { apex = [0, 0, 0], axis = [0, 0, -1], half_angle = 1.4 }",
            "cone = { apex = [0, 0, 0], axis = [0, 0, 1], half_angle = 1.4 }",
        ),
        (
            "plane",
            "paraboloid = { apex = [0, 0.1, 0], axis = [0, 0, -1], radius = 1.5 }",
            "paraboloid = { apex = [0, 0.1, 0], axis = [0, 0, 1], radius = 1.5 }",
        ),
        ("line", "height = \"-0.3*x^2\"", "height = \"0.3*x^2\"\nside = \"above\""),
    ] {
        let up = 0.12;
        let lower = touch(&pushed(space, below, up));
        let upper = touch(&pushed(space, above, -up));
        assert!(lower.1 > 0.0 && lower.0 > 0.01, "{below}: {lower:?}");
        assert!((upper.0 - lower.0).abs() < 1e-9 && (upper.1 + lower.1).abs() < 1e-9, "{above}: {lower:?} {upper:?}");
    }
}

/// Adhesion, fits of paths and the nodal method hold above as they do below.
#[test]
fn adhesion_holds_above_too() {
    let case = super::example("snap_in");
    let below = summary(case, &set(&[]));
    let turned = case
        .replace("shape.height = \"", "side = \"above\"\nshape.height = \"-(")
        .replace("normal = \"", "normal = \"-(");
    // Every expression that was turned ends with its line.
    let turned: String = turned
        .lines()
        .map(|line| {
            if line.contains("\"-(") {
                line.trim_end_matches('"').to_string() + ")\"\n"
            } else {
                line.to_string() + "\n"
            }
        })
        .collect();
    let above = summary(&turned, &set(&[]));
    let (lower, upper) = (below["events"].as_array().expect("events"), above["events"].as_array().expect("events"));
    assert!(!lower.is_empty() && lower.len() == upper.len());
    for (a, b) in lower.iter().zip(upper) {
        assert_eq!((&a["kind"], &a["zones_after"]), (&b["kind"], &b["zones_after"]));
        assert!((number(&a["time"]) - number(&b["time"])).abs() < 1e-9);
        assert!((number(&a["force_after"]) + number(&b["force_after"])).abs() < 1e-8);
    }
}

/// A string that is pressed down on one half and up on the other, between two plates: each half is a string on a floor.
#[test]
fn a_string_between_two_plates() {
    let case = r#"
space = "line"
[bodies.film.membrane]
domain.interval = { from = -1.0, to = 1.0 }
mesh.grid = { cells = [40] }
degree = 4
tension = 1.0
[bodies.floor.rigid]
shape.plane = { point = [0, -0.1], normal = [0, 1] }
[bodies.lid.rigid]
shape.plane = { point = [0, 0.1], normal = [0, -1] }
[supports.rim]
on = "film:boundary"
displacement = 0.0
[loads.twist]
on = "film"
normal = "if(x < 0, -2, 2)"
[contacts.below]
between = ["film", "floor"]
[contacts.above]
between = ["lid", "film"]
"#;
    let exact = FlatFloor { tension: 1.0, load: 2.0, depth: 0.1, radius: 0.5, kind: Kind::String };
    for method in ["inequality_level_set = {}", "active_set = {}"] {
        let nodal = method.starts_with("active");
        let case = case.replace("[contacts.below]", &format!("[contacts.below]\nmethod.{method}"));
        let case = if nodal { case.replace("[40]", "[400]") } else { case };
        let found = summary(&case, &set(&[]));
        let step = last_step(&found);
        for (name, sign) in [("below", 1.0), ("above", -1.0)] {
            let contact = &step["contacts"][name];
            let (length, force) = (2.0 * exact.contact_radius().expect("contact"), exact.contact_force());
            let tolerance = if nodal { 1e-2 } else { 1e-9 };
            assert!((number(&contact["area"]) - length).abs() < tolerance, "{name}: {} {length}", contact["area"]);
            let off = (number(&contact["force"][2]) - sign * force).abs();
            assert!(off < 2.0 * tolerance, "{name}: {} {force}", contact["force"]);
            assert_eq!(contact["zones"], 1);
        }
    }
}

/// Two balls under one membrane, each with a contact of its own, or both as one floor; and a lid over a third place.
#[test]
fn several_bodies_under_and_over_one_membrane() {
    let case = r#"
space = "plane"
[bodies.film.membrane]
domain.rectangle = { min = [-1, -1], max = [1, 1] }
mesh.grid = { cells = [28, 28] }
degree = 3
tension = 1.0
[bodies.left.rigid]
shape.paraboloid = { apex = [-0.4, 0.2, 0.0], axis = [0, 0, -1], radius = 0.8 }
motion.prescribed = { displacement = [0, 0, "0.1*t"] }
[bodies.right.rigid]
shape.paraboloid = { apex = [0.4, 0.2, 0.0], axis = [0, 0, -1], radius = 0.8 }
motion.prescribed = { displacement = [0, 0, "0.1*t"] }
[bodies.lid.rigid]
shape.sphere = { center = [0, -0.5, 1.0], radius = 1.0 }
motion.prescribed = { displacement = [0, 0, "-0.05*t"] }
[supports.rim]
on = "film:boundary"
displacement = 0.0
CONTACTS
[[steps]]
to = 1.0
increments = 2
events = 1e-2
"#;
    let apart = case.replace(
        "CONTACTS",
        "[contacts.a]\nbetween = [\"film\", \"left\"]\n[contacts.b]\nbetween = [\"film\", \"right\"]\n\
         [contacts.c]\nbetween = [\"film\", \"lid\"]\n",
    );
    let found = summary(&apart, &set(&[]));
    let contacts = &last_step(&found)["contacts"];
    let [a, b, c] = ["a", "b", "c"].map(|name| &contacts[name]);
    assert!((number(&a["area"]) - number(&b["area"])).abs() < 1e-6, "{} {}", a["area"], b["area"]);
    assert!(number(&a["force"][2]) > 0.1 && number(&c["force"][2]) < -0.05);
    assert_eq!([&a["zones"], &b["zones"], &c["zones"]], [1, 1, 1]);
    assert!(number(&last_step(&found)["equilibrium_residual"]) < 1e-10);
    let all = summary(&case.replace("CONTACTS", "[contacts.all]\nall = true\n"), &set(&[]));
    let other = &last_step(&all)["contacts"]["all:left"];
    assert!((number(&other["area"]) - number(&a["area"])).abs() < 1e-12);
    // The two below as one floor.
    let one = case
        .replace("[bodies.right.rigid]", "[bodies.unused.rigid]")
        .replace(
            "shape.paraboloid = { apex = [-0.4, 0.2, 0.0], axis = [0, 0, -1], radius = 0.8 }",
            "shape.height = \"-((abs(x) - 0.4)^2 + (y - 0.2)^2)/1.6\"",
        )
        .replace(
            "CONTACTS",
            "[contacts.a]\nbetween = [\"film\", \"left\"]\n[contacts.c]\nbetween = [\"film\", \"lid\"]\n",
        );
    let merged = summary(&one, &set(&[]));
    let contact = &last_step(&merged)["contacts"]["a"];
    assert_eq!(contact["zones"], 2);
    let sum = number(&a["force"][2]) + number(&b["force"][2]);
    assert!((number(&contact["force"][2]) - sum).abs() < 1e-6, "{} {sum}", contact["force"]);
    let kinds: Vec<&str> =
        found["events"].as_array().expect("events").iter().filter_map(|e| e["contact"].as_str()).collect();
    assert!(["a", "b", "c"].iter().all(|name| kinds.contains(name)), "{kinds:?}");
}

#[test]
fn level_sets_and_meshes_are_seen_from_above() {
    let up = 0.15;
    let ball = touch(&pushed("plane", "sphere = { center = [0, 0, -2], radius = 2 }", up));
    let level = "level_set = { negative_inside = \"x^2 + y^2 + (z + 2)^2 - 4\", min = [-3, -3, -5], max = [3, 3, 1] }";
    let implicit = touch(&pushed("plane", level, up));
    assert!((ball.0 - implicit.0).abs() < 1e-9 && (ball.1 - implicit.1).abs() < 1e-9, "{ball:?} {implicit:?}");
    let flat = "level_set = { negative_inside = \"x^2 + (z + 2)^2 - 4\", min = [-3, -5], max = [3, 1] }";
    let line = touch(&pushed("line", "cylinder = { point = [0, -2], radius = 2 }", up));
    let implicit = touch(&pushed("line", flat, up));
    assert!((line.0 - implicit.0).abs() < 1e-9, "{line:?} {implicit:?}");

    // A ball of triangles, and one with a hole.
    let folder = std::env::temp_dir().join(format!("signorini_floor_{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let (rings, sides) = (120, 240);
    let point = |i: usize, j: usize| {
        let (a, b) = (PI * i as f64 / rings as f64, 2.0 * PI * (j % sides) as f64 / sides as f64);
        let around = if i.is_multiple_of(rings) { 0.0 } else { 2.0 * a.sin() };
        [around * b.cos(), around * b.sin(), 2.0 * a.cos() - 2.0]
    };
    let mut triangles = Vec::new();
    for i in 0..rings {
        for j in 0..sides {
            let [a, b, c, d] = [point(i, j), point(i + 1, j), point(i + 1, j + 1), point(i, j + 1)];
            if i + 1 < rings {
                triangles.push([a, b, c]);
            }
            if i > 0 {
                triangles.push([a, c, d]);
            }
        }
    }
    let write = |name: &str, triangles: &[[[f64; 3]; 3]]| {
        let mut text = String::from("solid ball\n");
        for t in triangles {
            text += "facet normal 0 0 0\nouter loop\n";
            t.iter().for_each(|v| text += &format!("vertex {} {} {}\n", v[0], v[1], v[2]));
            text += "endloop\nendfacet\n";
        }
        std::fs::write(folder.join(name), text + "endsolid\n").expect("a file");
    };
    write("ball.stl", &triangles);
    write("holed.stl", &triangles[1..]);
    let path = |name: &str| folder.join(name).display().to_string();
    let case = pushed("plane", &format!("stl = {{ file = \"{}\" }}", path("ball.stl")), up);
    let found = summary(&case, &set(&[]));
    let contact = &last_step(&found)["contacts"]["touch"];
    assert!((number(&contact["area"]) / ball.0 - 1.0).abs() < 2e-2, "{} {}", contact["area"], ball.0);
    assert!((number(&contact["force"][2]) / ball.1 - 1.0).abs() < 1e-2, "{} {}", contact["force"], ball.1);
    assert!(found["warnings"].to_string().contains("bicubic spline"));
    let holed = error(&pushed("plane", &format!("stl = {{ file = \"{}\" }}", path("holed.stl")), up));
    assert!(holed.one_line().contains("not closed"), "{}", holed.one_line());
    std::fs::remove_dir_all(&folder).expect("to be removed");
}

#[test]
fn wrong_neighbours_are_told() {
    let case = pushed("plane", "height = \"-0.1\"", 0.0);
    let lid = "[bodies.lid.rigid]\nside = \"above\"\nshape.height = \"HEIGHT\"\n[contacts.upper]\nbetween = [\"film\", \"lid\"]\n";
    let with = |height: &str| case.clone() + &lid.replace("HEIGHT", height);
    for (text, word) in [
        (with("-0.2"), "no space left"),
        (with("-0.05"), "below the displacement"),
        (with("0.1").replace("\"above\"", "\"beside\""), "beside"),
        (
            with("0.1").replace(
                "[contacts.upper]\nbetween = [\"film\", \"lid\"]",
                "[contacts.upper]\nbetween = [\"film\", \"die\"]",
            ),
            "already has the contact",
        ),
        (
            with("0.1")
                .replace("[contacts.upper]", "[contacts.upper]\nmethod.active_set = {}")
                .replace("[contacts.touch]", "[contacts.touch]\nmethod.inequality_level_set = {}"),
            "another method",
        ),
        (with("0.1").replace("side = \"above\"\n", ""), "above the displacement"),
        (case.replace("between = [\"film\", \"die\"]", "between = [\"film\"]"), "rigid body"),
        (
            with("0.1").replace("[contacts.upper]\nbetween = [\"film\", \"lid\"]", "").replace(
                "between = [\"film\", \"die\"]",
                "all = true\nmethod.inequality_level_set = { initial_zone.disc = { radius = 0.3 } }",
            ),
            "several bodies",
        ),
    ] {
        let found = error(&text);
        assert!(found.place.is_some() && found.one_line().contains(word), "{word}: {}", found.one_line());
    }
}

/// What a case is taken for before it runs: quantities with units, and what looks wrong.
#[test]
fn a_check_says_what_it_understood() {
    let check = |text: &str| {
        let problem = signorini::case::read("case.toml", text, &[]).unwrap_or_else(|e| panic!("{e}"));
        let plan = signorini::plan::plan(&problem).unwrap_or_else(|e| panic!("{}", e.one_line()));
        assert!(signorini::run::preview(&plan).expect("a picture").is_some_and(|svg| svg.contains("</svg>")));
        signorini::run::sizes(&plan).unwrap_or_else(|e| panic!("{}", e.one_line()))
    };
    let case = "units = \"mm-N-MPa\"\n".to_string()
        + &pushed("plane", "height = \"-0.01*(1 - cos(5*x)) - 0.1\"", 0.0)
            .replace("tension = 1.0", "tension = \"2 N/m\"")
            .replace("radius = 1.0", "radius = \"1 cm\"");
    let sizes = check(&case);
    let echoed = sizes["interpreted"].as_array().expect("a list");
    let told = |text: &str| echoed.iter().find(|v| v["text"] == text).unwrap_or_else(|| panic!("{text}: {sizes}"));
    assert!((number(&told("2 N/m")["value"]) - 2e-3).abs() < 1e-15);
    assert_eq!(told("2 N/m")["unit"], "N/mm");
    assert_eq!((number(&told("1 cm")["value"]), &told("1 cm")["line"]), (10.0, &5.into()));
    assert!(sizes["warnings"].to_string().contains("curves within a cell"), "{sizes}");
    assert!(
        !check(&pushed("plane", "height = \"-0.1 - 0.2*x^2\"", 0.0))["warnings"].to_string().contains("curves within")
    );
    let long = check(&case.replace("\"1 cm\"", "\"1000 km\""));
    assert!(long["warnings"].to_string().contains("m long"), "{long}");
    // Pascals where megapascals are meant.
    let stiff = check(super::example("hertz").replace("youngs_modulus = 1000", "youngs_modulus = 210e9").as_str());
    let solid = check(super::example("hertz"));
    assert!(!solid["warnings"].to_string().contains("units"), "{solid}");
    assert!(stiff["warnings"].to_string().contains("stiffer than any solid"), "{stiff}");
}

/// Beyond its rectangle nothing is known of a height map, and a map may be moved from under the membrane.
#[test]
fn a_height_map_that_does_not_reach_the_membrane_is_told() {
    let folder = std::env::temp_dir().join(format!("signorini_map_{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    let row = vec!["-0.2"; 23].join(",");
    std::fs::write(folder.join("map.csv"), vec![row; 23].join("\n")).expect("a file");
    let map = |origin: f64| {
        let file = folder.join("map.csv").display().to_string();
        format!("height_map = {{ file = \"{file}\", spacing = [0.1, 0.1], origin = [{origin}, {origin}] }}")
    };
    assert_eq!(touch(&pushed("plane", &map(-1.1), 0.0)), (0.0, 0.0));
    let short = error(&pushed("plane", &map(-0.9), 0.0));
    assert!(short.place.is_some() && short.one_line().contains("does not reach"), "{}", short.one_line());
    let moving = pushed("plane", &map(-1.1), 0.0).replace("[0, 0, 0]", "[\"0.3*t\", 0, 0]")
        + "[[steps]]\nto = 1.0\nincrements = 2\n";
    let moved = error(&moving);
    assert!(
        moved.one_line().contains("t = 0.5") && moved.one_line().contains("does not reach"),
        "{}",
        moved.one_line()
    );
    std::fs::remove_dir_all(&folder).expect("to be removed");
}
