//! The tests of this crate as one program: each more would link all crates again.

mod beams;
mod bodies;
mod common;
mod curve_pairs;
mod curve_systems;
mod edge_contacts;
mod edge_systems;
mod edges;
mod published_ropes;
mod pulley;
mod ropes;
mod strands;
mod systems;
mod unit;
