//! The tests of this crate as one program: each more would link all crates again.

mod elasticity;
mod mass;
mod nodes;
mod nurbs;
mod nurbs_incompressible;
mod pressed;
mod pressure;
mod punch;
mod system;
mod unit;
mod zone;

#[path = "../../examples/06_friction_law.rs"]
mod friction_law_example;
#[path = "../../examples/05_system.rs"]
mod system_example;

#[test]
fn the_examples_hold() {
    system_example::main();
    friction_law_example::main();
}
