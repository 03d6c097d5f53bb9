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
mod shim;
#[cfg(feature = "petsc")]
mod world;

#[cfg(feature = "petsc")]
pub use world::World;

/// Variables by which starters of MPI tell a process how many there are: Open MPI, MPICH and Intel MPI, Slurm.
const COUNTS: [&str; 3] = ["OMPI_COMM_WORLD_SIZE", "PMI_SIZE", "PMIX_SIZE"];

/// How many processes this one was started with, by the environment.
pub fn started() -> usize {
    let of = |name: &&str| std::env::var(name).ok()?.trim().parse::<usize>().ok();
    COUNTS.iter().find_map(of).unwrap_or(1).max(1)
}

/// The number of this one among them, from 0.
pub fn started_as() -> usize {
    let of = |name: &&str| std::env::var(name).ok()?.trim().parse::<usize>().ok();
    ["OMPI_COMM_WORLD_RANK", "PMI_RANK", "PMIX_RANK"].iter().find_map(of).filter(|_| started() > 1).unwrap_or(0)
}

/// How many of them are on this machine.
pub fn started_here() -> usize {
    let of = |name: &&str| std::env::var(name).ok()?.trim().parse::<usize>().ok();
    ["OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS"].iter().find_map(of).unwrap_or(1).max(1)
}
