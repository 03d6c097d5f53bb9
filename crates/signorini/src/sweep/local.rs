//! Runs that are missing, several side by side.

use super::SweepError;
use super::folder::SweepFolder;
use super::manifest::Manifest;
use super::record::{Record, Status};
use super::task::run_row;
use crate::run::{Iteration, Progress};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};

/// Who looks on while a sweep runs.
pub trait Watch: Sync {
    /// A run ended.
    fn ended(&self, index: usize, record: &Record);

    /// Whether all runs are to stop after their iterations.
    fn interrupted(&self) -> bool;
}

/// How many runs ended in a call, and how.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counted {
    pub ended: usize,
    pub failed: usize,
    /// Whether the call was interrupted before all runs ended.
    pub interrupted: bool,
}

/// Runs all rows that are missing, `jobs` of them side by side with `threads` threads each. What comes of a row depends on
/// neither.
///
/// # Errors
/// Files that cannot be written. Runs that fail are rows of the table.
pub fn run_missing(
    folder: &SweepFolder,
    manifest: &Manifest,
    (jobs, threads): (usize, usize),
    watch: &dyn Watch,
) -> Result<Counted, SweepError> {
    let missing = manifest.missing(folder);
    let next = AtomicUsize::new(0);
    let stopped = AtomicBool::new(false);
    let (counted, wrong) = (Mutex::new(Counted::default()), Mutex::new(None));
    let locked = |of: &Mutex<Counted>, change: &dyn Fn(&mut Counted)| {
        change(&mut of.lock().unwrap_or_else(PoisonError::into_inner));
    };
    let work = || {
        let mut looker = Looker { watch, stopped: &stopped };
        while !looker.interrupted() {
            let Some(&index) = missing.get(next.fetch_add(1, Ordering::SeqCst)) else { return };
            match run_row(folder, manifest, index, &mut looker) {
                Ok(Some(record)) => {
                    locked(&counted, &|c| {
                        c.ended += 1;
                        c.failed += usize::from(record.status == Status::Failed);
                    });
                    watch.ended(index, &record);
                }
                Ok(None) => locked(&counted, &|c| c.interrupted = true),
                Err(error) => {
                    stopped.store(true, Ordering::SeqCst);
                    wrong.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
                    return;
                }
            }
        }
        if next.load(Ordering::SeqCst) < missing.len() {
            locked(&counted, &|c| c.interrupted = true);
        }
    };
    std::thread::scope(|scope| {
        for _ in 0..jobs.clamp(1, missing.len().max(1)) {
            scope.spawn(|| match rayon::ThreadPoolBuilder::new().num_threads(threads).build() {
                Ok(pool) => pool.install(work),
                // The common pool does as well.
                Err(_) => work(),
            });
        }
    });
    match wrong.into_inner().unwrap_or_else(PoisonError::into_inner) {
        Some(error) => Err(error),
        None => Ok(counted.into_inner().unwrap_or_else(PoisonError::into_inner)),
    }
}

/// Asks whether to stop.
struct Looker<'a> {
    watch: &'a dyn Watch,
    stopped: &'a AtomicBool,
}

impl Progress for Looker<'_> {
    fn step(&mut self, _: usize, _: usize, _: f64) {}
    fn iteration(&mut self, _: &Iteration) {}
    fn interrupted(&self) -> bool {
        self.stopped.load(Ordering::SeqCst) || self.watch.interrupted()
    }
}
