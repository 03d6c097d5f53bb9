//! What solves the equations, and about what memory that takes.

use crate::shim;
use signorini_mechanics::processes::Share;

/// More unknowns in a plane and in space are not factorised, where the options say nothing else: the factors of so many take about
/// a gibibyte.
const FACTORISED: [usize; 2] = [500_000, 50_000];
/// Steps that flexible GMRES keeps, with two vectors each.
pub const RESTART: usize = 60;

/// An entry of a sparse matrix with its column.
const ENTRY: f64 = 12.0;
const NUMBER: f64 = 8.0;
/// Whole vectors: states, residuals, right-hand sides, motions of the bodies.
const WHOLE_VECTORS: f64 = 30.0;
/// Levels of algebraic multigrid, with what carries from one to the next, over the matrix.
const LEVELS: f64 = 1.0;
/// Factors of MUMPS, of a matrix that is not symmetric and with as much room again for pivots that it puts off, over Cholesky's.
const FACTORS: f64 = 4.0;

/// Whether iterations solve equations of so many unknowns: where the options name a preconditioner that is no factorisation, or
/// none and there are many unknowns.
pub fn iterates(unknowns: usize, components: usize) -> bool {
    match shim::option(c"-pc_type").as_deref() {
        Some("lu" | "cholesky") => false,
        Some(_) => true,
        None => unknowns > FACTORISED[usize::from(components == 3)],
    }
}

/// About what memory in bytes the equations take on a process, without the bodies and without contact; `factor` is that of a
/// Cholesky factor of all bodies, by so many processes.
pub fn equations(share: &Share, processes: usize, factor: impl FnOnce() -> f64) -> f64 {
    let blocks = NUMBER * share.in_blocks as f64;
    let entries = ENTRY * share.entries as f64;
    let vectors = NUMBER * WHOLE_VECTORS * share.unknowns as f64;
    // Of each entry of a block one number and its column, before those of the same place are summed.
    let assembled = blocks + ENTRY * share.in_blocks as f64;
    // The rows, those without what is held, and PETSc's own.
    let solved = if iterates(share.unknowns, share.components) {
        let basis = NUMBER * (2 * RESTART * share.rows) as f64;
        // Those with springs, and PETSc's own of these; both as they are put together.
        blocks + entries * (6.0 + LEVELS) + basis
    } else {
        blocks + 3.0 * entries + FACTORS * factor() / processes as f64
    };
    vectors + assembled.max(solved)
}
