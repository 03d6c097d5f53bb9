//! Where and when an expression is evaluated.

/// What an expression is evaluated at.
#[derive(Clone, Copy, Debug)]
pub struct Scope<R> {
    pub position: [R; 3],
    pub time: R,
}
