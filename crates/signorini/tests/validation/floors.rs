//! Rigid shapes under membranes, seen from above.

use super::{error, last_step, number, set, summary};
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
    let cases: [(&str, f64, f64); 3] = [
        ("sphere = { center = [0, 0, -2], radius = 2 }", leaves(sphere, sphere_slope), 0.0),
        (
            "paraboloid = { apex = [0, 0, 0], axis = [0, 0, -1], radius = 1.5 }",
            leaves(paraboloid, paraboloid_slope),
            1.0,
        ),
        ("ellipsoid = { center = [0, 0, -0.5], semi_axes = [1.1, 1.1, 0.5] }", leaves(ellipsoid, ellipsoid_slope), 2.0),
    ];
    for (shape, c, kind) in cases {
        let slope = [sphere_slope(c), paraboloid_slope(c), ellipsoid_slope(c)][kind as usize];
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
        ("plane", "cylinder = { point = [0, 0, -2], radius = 2 }", "needs an `axis`"),
        ("plane", "cylinder = { point = [0, 0, -2], axis = [0, 0, 1], radius = 2 }", "lies flat"),
        ("plane", "paraboloid = { apex = [0, 0, 0], axis = [0, 0, 1], radius = 2 }", "straight down"),
        ("plane", "torus = { center = [0, 0, -1], axis = [1, 0, 0], major_radius = 1, minor_radius = 0.3 }", "upright"),
        ("plane", "ellipsoid = { center = [0, 0, -1], semi_axes = [1, 0, 1] }", "positive"),
        ("axisymmetric", "ellipsoid = { center = [0, 0, -1], semi_axes = [1, 2, 1] }", "are equal"),
        ("plane", "cone = { apex = [0, 0, 0], axis = [0, 0, -1], half_angle = 1 }", "not available"),
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
