//! Values at points that are asked for: those of the point, wherever it lies in a cell.

use crate::{last_step, number, set, summary};

/// A plate pulled by a hundredth, in finite elements and finite cells: `u = (0.01 x, 0)`, and the stress is 0.01 E.
#[test]
fn a_probe_has_the_values_of_its_own_point() {
    let bodies = [
        "[bodies.b.solid]\nmesh.box = { min = [0, 0], max = [10, 10], cells = [2, 2] }",
        "[bodies.b.solid]\nmesh.box = { min = [0, 0], max = [10, 10], cells = [3, 2], map = [\"x + 0.05*x*(10-x)\", \"y\"] }\ndegree = 3",
        "[bodies.b.cells]\ngeometry.box = { min = [0, 0], max = [10, 10] }\nmesh.grid = { cells = [2, 2] }\ndegree = 2",
    ];
    for body in bodies {
        let case = format!(
            r#"
units = "mm-N-MPa"
space = "plane_strain"
{body}
material.linear_elastic = {{ youngs_modulus = 1000, poissons_ratio = 0 }}
[supports.left]
on = "b:left"
displacement = [0, "free"]
[supports.low]
on = "b:bottom"
displacement = ["free", 0]
[supports.right]
on = "b:right"
displacement = [0.1, "free"]
[output.probes]
a = [1, 1]
c = [7.3, 4.1]
e = [10, 10]
"#
        );
        let found = summary(&case, &set(&[]));
        for (name, x) in [("a", 1.0), ("c", 7.3), ("e", 10.0)] {
            let probe = &last_step(&found)["probes"][name];
            assert!((number(&probe["displacement"][0]) - 0.01 * x).abs() < 1e-9, "{body} {probe}");
            assert!((number(&probe["von_mises"]) - 10.0).abs() < 1e-6, "{body} {probe}");
        }
    }
}

/// A column that hangs under its own weight: `u = γ (h z - z²/2)/E` below its top, quadratic within cells.
#[test]
fn a_probe_follows_the_functions_of_its_cell() {
    let case = r#"
units = "mm-N-MPa"
space = "plane_stress"
[bodies.column.solid]
mesh.box = { min = [0, 0], max = [1, 30], cells = [1, 3] }
degree = 2
material.linear_elastic = { youngs_modulus = 100, poissons_ratio = 0 }
[supports.top]
on = "column:top"
displacement = [0, 0]
[loads.weight]
on = "column"
body_force = [0, -0.01]
[output.probes]
p = [0.4, 22.5]
q = [0.5, 3.7]
"#;
    let found = summary(case, &set(&[]));
    for (name, y) in [("p", 22.5), ("q", 3.7)] {
        let exact = -0.01 / 100.0 * (30.0 * (30.0 - y) - 0.5 * (30.0f64 - y).powi(2));
        let probe = number(&last_step(&found)["probes"][name]["displacement"][1]);
        assert!((probe / exact - 1.0).abs() < 1e-8, "{name} {probe} {exact}");
    }
}
