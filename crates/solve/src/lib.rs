//! Linear and nonlinear solvers shared by all models.
//!
//! - [`sparse`]: symmetric sparse matrices assembled from element matrices.
//! - [`cholesky`]: sparse factorisation with a residual check on every solve.
//! - [`condensation`]: a matrix reduced to a few of its unknowns, factorised once.
//! - [`ldlt`]: factors of symmetric matrices that need not be positive definite, for the signs of their eigenvalues.
//! - [`acceleration`]: Anderson's for fixed-point iterations.
//! - [`dissection`]: an order of elimination for meshes in space.
//! - [`dense`]: small dense systems.
//! - [`general`]: general sparse matrices and their LU factors; [`newton`]: Newton's method with line search.
//! - [`krylov`]: equations known by products with their matrix; [`blocks`]: such matrices; [`schwarz`], [`multigrid`]: preconditioners.
//! - [`progress`]: what a solver reports while it works, and how it is interrupted.

pub mod acceleration;
pub mod blocks;
pub mod cholesky;
pub mod condensation;
pub mod dense;
pub mod dissection;
pub mod general;
pub mod krylov;
pub mod ldlt;
pub mod multigrid;
pub mod newton;
pub mod progress;
pub mod schwarz;
pub mod sparse;

pub use acceleration::Acceleration;
pub use cholesky::{Factor, SolveError, Symbolic};
pub use condensation::Condensation;
pub use progress::{Iteration, Progress, Silent};
pub use sparse::SymmetricMatrix;
