//! Finite cells against exact solutions and independent computations.

mod bodies;
mod case;
mod cavity;
mod hertz;
mod kirsch;
mod patch;

use signorini_cells::{CellMaterial, Elastic, Space};

/// The numbers of `tests/data/finite_cells.json`.
fn reference() -> serde_json::Value {
    serde_json::from_str(include_str!("../../data/finite_cells.json")).unwrap()
}

fn material<const D: usize>(space: Space) -> CellMaterial<D> {
    CellMaterial { solid: Elastic { youngs_modulus: 1.0, poissons_ratio: 0.3 }.into(), modulus: None, space }
}
