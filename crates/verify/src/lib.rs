//! Exact solutions, error norms and observed orders: what tests, the gallery and `signorini verify` measure against.

pub mod flat_floor;
pub mod friction;
pub mod order;
pub mod taylor;
