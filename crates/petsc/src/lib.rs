//! Systems that several processes solve together, over MPI and PETSc.
//!
//! Without the feature `petsc` nothing outside is needed, and there is one process. With it `World` implements
//! [`Processes`](signorini_mechanics::processes::Processes) by a shim in C (`shim.c`, unsafe calls in `shim.rs` alone): [`rows`] of
//! the matrix are put together here, in the [`numbering`] of the processes, and PETSc solves the linear systems of Newton's method.

pub mod numbering;
pub mod rows;

#[cfg(feature = "petsc")]
mod matrix;
#[cfg(feature = "petsc")]
mod memory;
#[cfg(feature = "petsc")]
mod shim;
#[cfg(feature = "petsc")]
mod world;

#[cfg(feature = "petsc")]
pub use world::World;

/// A number that a starter of MPI tells each process by a variable of the environment: Open MPI, MPICH and Intel MPI, Slurm.
fn told(names: &[&str]) -> Option<usize> {
    names.iter().find_map(|name| std::env::var(name).ok()?.trim().parse().ok())
}

/// How many processes this one was started with, by the environment.
pub fn started() -> usize {
    told(&["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_SIZE"]).unwrap_or(1).max(1)
}

/// The number of this one among them, from 0.
pub fn started_as() -> usize {
    told(&["OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"]).filter(|_| started() > 1).unwrap_or(0)
}

/// How many of them are on this machine.
pub fn started_here() -> usize {
    told(&["OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS"]).unwrap_or(1).max(1)
}
