//! Benchmarks from the manuals of other programs, written as a user would write them: against the closed form within what finite
//! bodies differ, and against the published figure within the band of its manual.

use super::solids::at;
use super::{last_step, set, summary};

/// Two quarters of circles that touch at their lowest and highest points: squares of which one edge follows the circle, with cells
/// of the width of the contact. Radii, half widths of the fine part, and what the bodies are made of, the upper one first.
fn quarters(space: &str, radii: [f64; 2], near: f64, cells: usize, materials: [&str; 2]) -> String {
    let [a, b] = radii;
    let (inner, outer) = (0.75 * near, 10);
    format!(
        r#"
space = "{space}"
[bodies.upper.solid]
mesh.box.axes = [
  {{ from = 0, to = [{near}, {}], cells = [{cells}, {outer}], growth = [1, 1.2] }},
  {{ from = 0, to = [{inner}, {a}], cells = [{outer}, {outer}], growth = [1, 1.2] }} ]
mesh.box.map = ["x", "{a} - sqrt({a}^2 - x^2) + y/{a}*sqrt({a}^2 - x^2)"]
degree = 2
material.linear_elastic = {}
[bodies.lower.solid]
mesh.box.axes = [
  {{ from = 0, to = [{near}, {}], cells = [{}, {outer}], growth = [1, 1.2] }},
  {{ from = -{b}, to = [-{inner}, 0], cells = [{outer}, {outer}], growth = [0.83, 1] }} ]
mesh.box.map = ["x", "-{b} + sqrt({b}^2 - x^2) + y/{b}*sqrt({b}^2 - x^2)"]
degree = 2
material.linear_elastic = {}
[contacts.touch]
between = ["upper:bottom", "lower:top"]
"#,
        0.9 * a,
        materials[0],
        0.9 * b,
        3 * cells / 4,
        materials[1],
    )
}

/// ANSYS VM191 (Chandrasekaran, Haisler & Goforth 1987): cylinders of radii 10 and 13 under 3200 N/mm. The half width 1.20 is that
/// of Hertz in plane strain. The published approach, 0.4181, is that of a mesh: it depends on the bodies away from the contact.
#[test]
fn two_cylinders_of_ansys_vm191() {
    let materials =
        [(30000, 0.25), (29120, 0.3)].map(|(e, nu)| format!("{{ youngs_modulus = {e}, poissons_ratio = {nu} }}"));
    let case = quarters("plane_strain", [10.0, 13.0], 1.6, 16, [&materials[0], &materials[1]])
        + r#"
[supports.upper_symmetry]
on = "upper:left"
normal = 0
[supports.lower_symmetry]
on = "lower:left"
normal = 0
[supports.base]
on = "lower:bottom"
displacement = ["free", 0]
[supports.head]
on = "upper:top"
displacement = ["free", "free"]
tied = [false, true]
[loads.press]
on = "upper:top"
force = [0, "-1600*t"]
[output]
probes = { head = [0, 10] }
[[steps]]
to = 1
"#;
    let found = summary(&case, &set(&[]));
    let step = last_step(&found);
    // E* = 16000, R = 130/23.
    let half_width = (4.0 * 3200.0 * 130.0 / 23.0 / (std::f64::consts::PI * 16000.0f64)).sqrt();
    let pressure = 2.0 * 3200.0 / (std::f64::consts::PI * half_width);
    let (area, most) = (at(step, "/contacts/touch/area"), at(step, "/contacts/touch/max_pressure"));
    let approach = -at(step, "/probes/head/displacement/1");
    println!("half width {area} of {half_width}, pressure {most} of {pressure}, approach {approach}");
    assert!((area / half_width - 1.0).abs() < 5e-3 && (area / 1.20 - 1.0).abs() < 5e-3, "{area} {half_width}");
    assert!((most / pressure - 1.0).abs() < 1e-2, "{most} {pressure}");
    // Johnson, *Contact Mechanics*, 5.6: each cylinder between its centre and the contact.
    let of = |radius: f64| 3200.0 / 32000.0 / std::f64::consts::PI * (2.0 * (4.0 * radius / half_width).ln() - 1.0);
    assert!(
        (approach / (of(10.0) + of(13.0)) - 1.0).abs() < 1e-2 && (approach / 0.4181 - 1.0).abs() < 0.05,
        "{approach}"
    );
    assert_eq!(found["warnings"].as_array().map(Vec::len), Some(0), "{}", found["warnings"]);
}

/// Code_Aster SSNV104: two spheres of radius 50, each pushed 2 towards the other. The published stress in the middle of the contact,
/// 2798.3, is that of Hertz for an approach of 4 between points far away; planes through the centres that move as one make the
/// spheres stiffer. The pressure of Hertz by the force has no such error.
#[test]
fn two_spheres_of_code_aster_ssnv104() {
    let material = "{ youngs_modulus = 20000, poissons_ratio = 0.3 }";
    let case = quarters("axisymmetric", [50.0, 50.0], 13.0, 20, [material, material])
        + r#"
[supports.head]
on = "upper:top"
displacement = ["free", "-2*t"]
[supports.base]
on = "lower:bottom"
displacement = ["free", "2*t"]
[[steps]]
to = 1
"#;
    let found = summary(&case, &set(&[]));
    let step = last_step(&found);
    let (force, most) = (at(step, "/contacts/touch/force/1").abs(), at(step, "/contacts/touch/max_pressure"));
    let modulus = 20000.0 / (2.0 * 0.91);
    let hertz = (6.0 * force * modulus * modulus / (std::f64::consts::PI.powi(3) * 625.0)).cbrt();
    let radius = (0.75 * force * 25.0 / modulus).cbrt();
    let area = at(step, "/contacts/touch/area");
    println!("force {force}, pressure {most} of {hertz}, radius {} of {radius}", (area / std::f64::consts::PI).sqrt());
    assert!((most / hertz - 1.0).abs() < 5e-3, "{most} {hertz}");
    assert!((most / 2798.3 - 1.0).abs() < 0.05, "{most}");
    // A radius of contact of a fifth of that of the spheres is at the end of what Hertz assumes, and strains are not small.
    assert!(((area / std::f64::consts::PI).sqrt() / radius - 1.0).abs() < 2e-2, "{area} {radius}");
    let warnings = found["warnings"].as_array().unwrap();
    assert!(warnings.iter().all(|w| w["kind"] == "large_strain"), "{warnings:?}");
}

/// ANSYS VM272 (Yang, Laursen & Meng 2005): half cylinders of radius 8 pressed together by 0.625 over their width and sheared by
/// 0.05851. Hertz, and Cattaneo and Mindlin: half width, pressure, zone of stick, traction in its middle. The friction coefficient is
/// that of the paper, 0.2. The head moves as one, so that it does not roll.
#[test]
fn half_cylinders_with_friction_of_ansys_vm272() {
    let body = |name: &str, cells: usize, [y, deep]: [&str; 2], map: &str| {
        format!(
            r#"
[bodies.{name}.solid]
mesh.box.axes = [
  {{ from = -7.2, to = [-0.9, 0.9, 7.2], cells = [8, {cells}, 8], growth = [0.75, 1, 1.33] }},
  {{ {y}, cells = [8, 8], growth = {deep} }} ]
mesh.box.map = ["x", "{map}"]
degree = 2
material.linear_elastic = {{ youngs_modulus = 200, poissons_ratio = 0.3 }}
"#
        )
    };
    let case =
        "space = \"plane_strain\"\n[functions.press]\ntable = { t = [0, 1], value = [0, 1] }\n[functions.shift]\n\
                table = { t = [1, 2], value = [0, 1] }\n"
            .to_string()
            + &body("upper", 28, ["from = 0, to = [0.9, 8]", "[1.1, 1.3]"], "8 - sqrt(64 - x^2) + y/8*sqrt(64 - x^2)")
            + &body(
                "lower",
                24,
                ["from = -8, to = [-0.9, 0]", "[0.77, 0.9]"],
                "-8 + sqrt(64 - x^2) + y/8*sqrt(64 - x^2)",
            )
            + r#"
[supports.base]
on = "lower:bottom"
displacement = [0, 0]
[supports.head]
on = "upper:top"
displacement = ["free", "free"]
tied = true
[loads.press]
on = "upper:top"
force = ["0.93622*shift(t)", "-10*press(t)"]
[contacts.touch]
between = ["upper:bottom", "lower:top"]
friction.coulomb = { mu = 0.2 }
[[steps]]
to = 1
increments = 4
[[steps]]
to = 2
increments = 4
"#;
    let found = summary(&case, &set(&[]));
    let step = last_step(&found);
    let modulus = 200.0 / (2.0 * 0.91);
    let half_width = (4.0 * 10.0 * 4.0 / (std::f64::consts::PI * modulus)).sqrt();
    let pressure = 20.0 / (std::f64::consts::PI * half_width);
    let sticks = (1.0f64 - 0.93622 / (0.2 * 10.0)).sqrt();
    let of = |key: &str| at(step, &format!("/contacts/touch/{key}"));
    println!(
        "{} of {half_width}, {} of {pressure}, {} of {sticks}",
        of("area") / 2.0,
        of("max_pressure"),
        of("stick_area") / of("area")
    );
    assert!((of("area") / 2.0 / half_width - 1.0).abs() < 5e-3, "{}", of("area"));
    assert!((of("max_pressure") / pressure - 1.0).abs() < 5e-3, "{}", of("max_pressure"));
    // Cells of 0.064: the zone of stick ends with one.
    assert!((of("stick_area") / of("area") - sticks).abs() < 0.03, "{}", of("stick_area"));
    assert!((of("force/0").abs() - 0.93622).abs() < 1e-6 && (of("force/1").abs() - 10.0).abs() < 1e-6);
}
