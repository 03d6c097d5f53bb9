//! What gives way: rows of a penalty, and the springs that hold bodies until contact does.

/// A spring that holds a body until contact does: it acts on one unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spring {
    pub unknown: u32,
    pub stiffness: f64,
}

/// How a row gives way: `g + c (λ - shift) = 0` where it carries. Nothing for a hard contact; `c = w/ε` for a penalty
/// `ε`, and with the pressure found before as the shift one step of the augmented Lagrangian.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Softness {
    pub compliance: f64,
    pub shift: f64,
}

/// The share of the springs that is left, one after the other: from springs that keep a body near to nearly none. Beyond
/// the last a body that contact holds feels less of its spring than of round-off.
pub(crate) const SPRINGS_LEFT: [f64; 7] = [1.0, 1e-2, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12];
