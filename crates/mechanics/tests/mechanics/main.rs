//! The tests of this crate as one program: each more would link all crates again.

mod common;
mod free;
mod partition;
mod patch;
mod tangents;
mod unit;

#[path = "../../examples/08_body.rs"]
mod body_example;
#[path = "../../examples/07_rigid_shape.rs"]
mod rigid_shape_example;

#[test]
fn the_examples_hold() {
    rigid_shape_example::main();
    body_example::main();
}
