//! The threads that work: those of the process. A process that was forked has none of its parent's, and gets its own.

use rayon::{ThreadPool, ThreadPoolBuilder};
use std::process::id;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// The process in which the module was loaded.
static LOADED_IN: OnceLock<u32> = OnceLock::new();
/// The threads of a forked process.
static FORKED: Mutex<Option<(u32, Arc<ThreadPool>)>> = Mutex::new(None);

/// Notes the process in which the module is loaded.
pub fn loaded() {
    LOADED_IN.get_or_init(id);
}

/// Does some work with threads that exist in this process.
pub fn within<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    match forked() {
        Some(pool) => pool.install(work),
        None => work(),
    }
}

/// The threads of this process, if it was forked after the module was loaded and threads can be started.
fn forked() -> Option<Arc<ThreadPool>> {
    let process = id();
    if LOADED_IN.get().is_none_or(|first| *first == process) {
        return None;
    }
    let mut kept = FORKED.lock().unwrap_or_else(PoisonError::into_inner);
    match &*kept {
        Some((of, pool)) if *of == process => Some(pool.clone()),
        _ => {
            let pool = Arc::new(ThreadPoolBuilder::new().num_threads(rayon::current_num_threads()).build().ok()?);
            // What is left of the pool of the parent has no threads to end.
            std::mem::forget(kept.replace((process, pool.clone())));
            Some(pool)
        }
    }
}
