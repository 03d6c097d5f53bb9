//! Blocks with sharp edges on softer surfaces: points behind an edge, and on it, meet the face below and not the wall.

use super::{last_step, number, set, summary};

const MOVED: &str = r#"displacement = ["0.4*max(t - 1, 0)", "0.2*max(t - 1, 0)", "-0.01*min(t, 1)"]"#;

/// The force on a block that is pressed onto a base of 8 by 8 cells and then moved along it by more than a cell.
fn force(block: &str, base: &str, contact: &str, moves: bool) -> [f64; 3] {
    let (parts, ratio) = if moves { (2, 0.0) } else { (1, 0.3) };
    let then = if moves { "[[steps]]\nto = 2\nincrements = 1" } else { "" };
    let case = format!(
        r#"
space = "3d"
{block}
{base}
material.linear_elastic = {{ youngs_modulus = 1000, poissons_ratio = {ratio} }}
[supports.ground]
on = "base:bottom"
displacement = [0, 0, 0]
[contacts.c]
between = ["blk", "base"]
slave = "base"
{contact}
friction.coulomb = {{ mu = 0.3 }}
[[steps]]
to = 1
increments = {parts}
{then}
"#
    );
    let found = summary(&case, &set(&[]));
    let force = last_step(&found)["contacts"]["c"]["force"].clone();
    [0, 1, 2].map(|k| number(&force[k]))
}

const SOLID: &str = "[bodies.base.solid]\nmesh.box = { min = [-1, -1, -0.5], max = [1, 1, 0], cells = [8, 8, 2] }";
const CELLS: &str = "[bodies.base.cells]\ngeometry.box = { min = [-1, -1, -0.5], max = [1, 1, 0] }\n\
                     mesh.grid = { cells = [8, 8, 2], min = [-1, -1, -0.5], max = [1, 1, 0] }";

/// The side of a block of cells that moves over a base takes nothing of it along: forces are those of friction.
#[test]
fn a_wall_does_not_push_what_slides_below_it() {
    let block = format!(
        r#"
[bodies.blk.cells]
geometry.box = {{ min = [-0.5, -0.4, 0], max = [0.2, 0.3, 0.4] }}
mesh.grid = {{ cells = [3, 3, 2], min = [-0.5, -0.4, 0], max = [0.2, 0.3, 0.4] }}
degree = 1
material.linear_elastic = {{ youngs_modulus = 4000, poissons_ratio = 0 }}
[supports.head]
on = "blk:top"
{MOVED}"#
    );
    for (base, method) in [(SOLID, "gauss_point"), (CELLS, "node")] {
        let contact = format!("method.{method} = {{}}");
        let [x, y, z] = force(&block, &format!("{base}\ndegree = 1"), &contact, true);
        assert!(x.hypot(y) <= 0.31 * z && z > 9.0, "{method}: {x}, {y}, {z}");
    }
}

/// Nodes exactly under the edges of a rigid box, which friction keeps there, carry along the normal of its bottom.
#[test]
fn nodes_under_an_edge_look_at_the_bottom() {
    let block = r#"
[bodies.blk.rigid]
shape.box = { min = [-0.5, -0.5, 0], max = [0.5, 0.5, 0.4] }
motion.prescribed = { displacement = [0, 0, "-0.01*t"] }"#;
    let base = format!("{SOLID}\ndegree = 1");
    let [by_nodes, by_points] =
        ["node", "gauss_point"].map(|method| force(block, &base, &format!("method.{method} = {{}}"), false));
    assert!((by_nodes[2] / by_points[2] - 1.0).abs() < 0.05, "{by_nodes:?} and {by_points:?}");
}
