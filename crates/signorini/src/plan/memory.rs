//! The memory that a solve takes, beside that there is.

use super::planner::Planner;
use crate::problem::{CaseError, Location, Problem};

/// Fraction of the free memory that a solve may use.
const MEMORY_SHARE: f64 = 0.8;

impl Planner<'_> {
    /// Tells where a factorisation needs more memory than there is.
    pub(super) fn check_unknowns<const D: usize>(
        &self,
        nodes: f64,
        degree: usize,
        at: &impl Location,
    ) -> Result<(), CaseError> {
        self.check_bytes(nodes, memory_estimate(nodes, degree, D), at)
    }

    /// Tells where a solve of so many unknowns needs more bytes than there are.
    pub(super) fn check_bytes(&self, nodes: f64, bytes: f64, at: &impl Location) -> Result<(), CaseError> {
        let free = free_memory();
        if nodes < 2e9 && bytes < MEMORY_SHARE * free {
            return Ok(());
        }
        let gib = |b: f64| b / f64::from(1 << 30);
        Err(self
            .problem
            .error(
                at,
                format!("{nodes:.1e} unknowns require about {:.1} GiB, but {:.1} GiB are free", gib(bytes), gib(free)),
            )
            .help("use fewer cells, or a lower degree"))
    }
}

/// Bytes that a solve with a sparse factorisation takes, measured on this program and rounded up.
pub fn memory_estimate(unknowns: f64, degree: usize, dimension: usize) -> f64 {
    if dimension == 1 {
        return unknowns * 1e3;
    }
    let p = degree as f64;
    unknowns * (600.0 + 120.0 * p * p) + unknowns * unknowns.max(1.0).log2() * 60.0
}

/// Bytes that a solve by multigrid takes with all that is written, measured on this program and rounded up: for each
/// unknown, for each cell, and along the cuts, where the unknowns are as many as the root of all; where the tension is not
/// even the equations too.
pub fn multigrid_estimate(unknowns: f64, degree: usize, is_even: bool) -> f64 {
    let p = degree as f64;
    let stored = if is_even { 0.0 } else { 11.0 * (p + 2.0) * (p + 2.0) };
    unknowns * (450.0 + 300.0 / (p * p) + stored) + unknowns.sqrt() * 4e4 * p * p
}

/// The same on a mesh whose cells were divided, where all equations are stored, and at higher degree those around each vertex.
pub fn mesh_multigrid_estimate(unknowns: f64, degree: usize) -> f64 {
    let around = 2.0 * degree as f64 + 1.0;
    unknowns * (1300.0 + 22.0 * around * around)
}

/// Memory that a solve may take at most.
pub fn memory_at_hand() -> f64 {
    MEMORY_SHARE * free_memory()
}

/// Refuses solids whose equations need more memory than there is; `what` needs it.
pub fn check_memory(problem: &Problem, what: &str, needed: f64) -> Result<(), CaseError> {
    let gib = |bytes: f64| bytes / f64::from(1u32 << 30);
    let free = memory_at_hand();
    if needed <= free {
        return Ok(());
    }
    let message = format!("{what} require about {:.1} GiB, but {:.1} GiB are free", gib(needed), gib(free));
    Err(problem
        .error(&problem.space, message)
        .help("use fewer cells, a lower degree, symmetry, or cells graded towards the contact"))
}

/// Memory that is free, as the system tells; 8 GiB where it does not.
fn free_memory() -> f64 {
    let text = std::fs::read_to_string("/proc/meminfo").unwrap_or_default();
    let line = text.lines().find_map(|l| l.strip_prefix("MemAvailable:"));
    let kib = line.and_then(|l| l.trim().trim_end_matches("kB").trim().parse::<f64>().ok());
    kib.map_or(8.0 * f64::from(1 << 30), |k| k * 1024.0)
}
