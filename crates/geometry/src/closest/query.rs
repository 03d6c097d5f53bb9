//! What is asked of a closest-point search.

/// What a query asks for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Query {
    /// Minimisers whose distances differ by less than this share of the size are at the same distance.
    pub tie: f64,
    /// Whether to find every local minimiser, not only the global ones.
    pub local_minima: bool,
}

impl Default for Query {
    fn default() -> Self {
        Query { tie: 1e-10, local_minima: false }
    }
}
