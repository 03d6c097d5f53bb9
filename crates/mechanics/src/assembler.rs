//! Where interactions add what they do.

use signorini_solve::general::Entries;

/// Where residual and tangent go, in the numbers of the system.
pub struct Assembler<'a> {
    pub residual: &'a mut [f64],
    /// Sum of the sizes of all terms of each equation: the scale of its residual.
    pub sizes: &'a mut [f64],
    /// The tangent, where it is asked for.
    pub tangent: Option<&'a mut Entries>,
}
