//! Paths of equilibria of systems through folds, against a closed form and the balance of forces.

use super::{error, last_step, number, set, summary};
use serde_json::Value;

fn steps(found: &Value) -> &Vec<Value> {
    found["steps"].as_array().expect("steps")
}

/// A thick sphere of incompressible neo-Hooke's rubber: with the stretches `a` inside and `b` outside, `b³ - 1 = (a³ - 1)(A/B)³`,
/// the pressure is `μ (f(b) - f(a))`, `f(λ) = 2/λ + 1/2λ⁴` (Green & Zerna, Theoretical Elasticity). It has a maximum.
#[test]
fn a_rubber_sphere_is_inflated_through_its_largest_pressure() {
    let case = r#"
space = "axisymmetric"
[bodies.ball.solid]
mesh.box = { min = [0, 0], max = [1, 1], cells = [2, 4], map = ["(1 + 0.5*x)*cos(pi/2*y)", "(1 + 0.5*x)*sin(pi/2*y)"] }
degree = 3
strain = "finite"
material.mooney_rivlin = { c10 = 0.5, c01 = 0, bulk_modulus = 10000 }
[supports.equator]
on = "ball:bottom"
displacement = ["free", 0]
[supports.axis]
on = "ball:top"
displacement = [0, "free"]
[loads.inside]
on = "ball:left"
pressure = "t"
[[steps]]
to = 2
control.arc_length = { size = 0.25 }
increments = 14
[output]
probes.inner = [1, 0]
"#;
    let found = summary(case, &set(&[]));
    assert_eq!(found["converged"], true, "{}", found["verdict"]);
    let mut most = 0.0f64;
    for step in steps(&found).iter().filter(|step| number(&step["time"]) > 0.0) {
        let (time, a) = (number(&step["time"]), 1.0 + number(&step["probes"]["inner"]["displacement"][0]));
        let b = (1.0 + (a.powi(3) - 1.0) / 1.5f64.powi(3)).cbrt();
        let f = |stretch: f64| 2.0 / stretch + 0.5 / stretch.powi(4);
        // The bulk modulus leaves 1e-4; the mesh less.
        assert!((time / (f(b) - f(a)) - 1.0).abs() < 1e-3, "{time} at {a}");
        most = most.max(time);
    }
    let last = last_step(&found);
    assert!(number(&last["time"]) < 0.8 * most, "{last}");
    assert_eq!(last["stability"]["stable"], false);
    assert_eq!(steps(&found)[0]["stability"]["stable"], true);
}

/// An arch over a floor.
const ARCH: &str = r#"
space = "plane_stress"
[bodies.arch.solid]
mesh.box = { min = [0, 0], max = [1, 1], cells = [10, 1], map = ["100*x - 50", "5*sin(pi*x) + y - 0.5"] }
degree = 2
strain = "finite"
material.neo_hooke = { youngs_modulus = 1000, poissons_ratio = 0 }
[bodies.floor.rigid]
shape.plane = { point = [0, -3], normal = [0, 1] }
[supports.left]
on = "arch:left"
displacement = [0, 0]
[supports.right]
on = "arch:right"
displacement = [0, 0]
[loads.push]
on = "arch:top"
traction = [0, "-0.02*t"]
[contacts.touch]
between = ["arch:bottom", "floor"]
[output]
probes.crown = [0, 5]
"#;

#[test]
fn an_arch_snaps_through_onto_a_floor() {
    let case = format!("{ARCH}[[steps]]\nto = 0.4\ncontrol.arc_length = {{ size = 0.4 }}\nincrements = 150\n");
    let found = summary(&case, &set(&[]));
    assert_eq!(found["converged"], true, "{}", found["verdict"]);
    let times: Vec<f64> = steps(&found).iter().map(|s| number(&s["time"])).collect();
    // It rises, falls, and ends where the step does.
    assert!(times.windows(2).any(|pair| pair[1] < pair[0]), "{times:?}");
    let last = last_step(&found);
    assert_eq!(last["time"], 0.4);
    // The supports, the floor and the load balance; the arch stays symmetric.
    let up = |group: &str, name: &str| number(&last[group][name][1]);
    let (left, right) = (up("support_forces", "left"), up("support_forces", "right"));
    let floor = number(&last["contacts"]["touch"]["force"][1]);
    let load = up("load_forces", "push");
    assert!((left + right + floor + load).abs() < 1e-9 && floor > 0.3, "{left} {right} {floor} {load}");
    assert!((left - right).abs() < 1e-7, "{left} {right}");
}

#[test]
fn what_a_path_cannot_follow_is_told() {
    let control = |control: &str| format!("{ARCH}[[steps]]\nto = 1\n{control}\n");
    let area = error(&control("control.area = { of = \"touch\", to = 3 }"));
    assert!(area.to_string().contains("area control of solids"), "{area}");
    let size = error(&control("control.arc_length = { size = 2 }"));
    assert!(size.to_string().contains("between 0.000001 and 1"), "{size}");
}
