//! All processes that MPI started.

use crate::matrix::PetscMatrix;
use crate::shim::{self, Compressed, Counts, LinearSystem};
use signorini_mechanics::processes::{CellBlock, DistributedMatrix, Processes, Share};
use std::sync::OnceLock;

/// The processes of `MPI_COMM_WORLD`. There is one in a program, started once.
#[derive(Clone, Copy, Debug)]
pub struct World {
    rank: usize,
    count: usize,
}

static WORLD: OnceLock<Result<World, i32>> = OnceLock::new();

impl World {
    /// Starts MPI and PETSc, in the thread that solves; later calls return the same.
    ///
    /// # Errors
    /// In words, where they cannot be started.
    pub fn start() -> Result<Self, String> {
        let started =
            WORLD.get_or_init(|| shim::start().map(|()| World { rank: shim::rank(), count: shim::size() })).as_ref();
        started.copied().map_err(|code| format!("PETSc or MPI cannot be started (its error {code})"))
    }

    /// The processes, where they were started.
    pub fn started() -> Option<Self> {
        WORLD.get()?.as_ref().ok().copied()
    }

    /// Ends MPI and PETSc; all processes call it, and nothing of them after it.
    pub fn end(self) {
        shim::end();
    }

    /// Ends all processes at once, with an exit status.
    pub fn abort(self, code: u8) -> ! {
        shim::abort(code)
    }

    /// Adds options to those of PETSc, as on its command line.
    ///
    /// # Errors
    /// In words, where PETSc cannot read them.
    pub fn options(self, text: &str) -> Result<(), String> {
        let refused = |code| format!("PETSc refuses the options `{text}` (its error {code})");
        shim::options(text).map_err(refused)?;
        // Types that do not exist are found as a system is solved: one of an unknown for each process.
        let one = Compressed { start: vec![0, 1], columns: vec![self.rank as i32], values: vec![1.0], all: self.count };
        LinearSystem::direct(&one, (f64::EPSILON, 1)).map_err(refused)?;
        Ok(())
    }

    /// About what memory in bytes the equations of a share take, and whether iterations solve them; `factor` is that of a Cholesky
    /// factor of all.
    pub fn memory(self, share: &Share, factor: impl FnOnce() -> f64) -> (f64, bool) {
        let iterates = crate::memory::iterates(share.unknowns, share.components);
        (crate::memory::equations(share, self.count, factor), iterates)
    }

    /// The largest of the numbers of all processes.
    pub fn largest(self, own: f64) -> f64 {
        let all = shim::gather(&[own], &Counts::new(std::iter::repeat_n(1, self.count)));
        all.into_iter().fold(f64::NEG_INFINITY, f64::max)
    }

    /// Options that nothing has asked for so far.
    pub fn unused_options(self) -> Vec<String> {
        shim::unused_options()
    }
}

impl Processes for World {
    fn rank(&self) -> usize {
        self.rank
    }

    fn count(&self) -> usize {
        self.count
    }

    /// Each process sums a part, in the order of the processes, and sends it to all others.
    fn sum(&self, values: &mut [f64]) {
        let parts = |k: usize| values.len() * k / self.count;
        let sizes: Vec<usize> = (0..self.count).map(|k| parts(k + 1) - parts(k)).collect();
        let own = sizes[self.rank];
        let sent = Counts::new(sizes.iter().copied());
        let received = shim::to_all(values, &sent, &Counts::new(std::iter::repeat_n(own, self.count)));
        let mut sum = received[..own].to_vec();
        for k in 1..self.count {
            sum.iter_mut().zip(&received[k * own..(k + 1) * own]).for_each(|(s, v)| *s += v);
        }
        values.copy_from_slice(&shim::gather(&sum, &sent));
    }

    fn gather(&self, own: &[f64]) -> Vec<Vec<f64>> {
        let lengths = shim::gather(&[own.len() as f64], &Counts::new(std::iter::repeat_n(1, self.count)));
        let counts = Counts::new(lengths.iter().map(|n| *n as usize));
        let all = shim::gather(own, &counts);
        counts.ranges().map(|range| all[range].to_vec()).collect()
    }

    fn first_word(&self, own: Option<String>) -> Option<String> {
        let first = shim::least(if own.is_some() { self.rank } else { self.count });
        if first == self.count {
            return None;
        }
        let own = own.filter(|_| first == self.rank).unwrap_or_default();
        let mut length = (own.len() as u64).to_le_bytes();
        shim::broadcast(&mut length, first);
        let mut bytes = own.into_bytes();
        bytes.resize(u64::from_le_bytes(length) as usize, 0);
        shim::broadcast(&mut bytes, first);
        Some(String::from_utf8_lossy(&bytes).into_owned())
    }

    fn matrix(&self, owner: &[u32], cells: &[CellBlock], entries: &[(u32, u32, f64)]) -> Box<dyn DistributedMatrix> {
        Box::new(PetscMatrix::new(*self, owner, cells, entries))
    }
}
