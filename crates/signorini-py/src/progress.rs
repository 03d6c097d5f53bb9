//! Progress for Python: a callable is told of it, and Ctrl-C ends a run after its iteration.

use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use signorini::run::{Iteration, Progress};
use std::cell::{Cell, RefCell};
use std::time::{Duration, Instant};

/// Time between two looks at the signals of Python.
const PAUSE: Duration = Duration::from_millis(50);

/// Calls back, and keeps in mind what ends the run.
pub struct Told {
    callback: Option<Py<PyAny>>,
    stopped: Cell<bool>,
    looked: Cell<Option<Instant>>,
    /// What the callable raised.
    raised: RefCell<Option<PyErr>>,
}

impl Told {
    pub fn new(callback: Option<Py<PyAny>>) -> Self {
        Self { callback, stopped: Cell::new(false), looked: Cell::new(None), raised: RefCell::new(None) }
    }

    /// What the callable raised, but for an interruption.
    pub fn into_error(self) -> Option<PyErr> {
        self.raised.into_inner()
    }

    /// An interruption ends the run and keeps its results; any other exception ends it too and is raised then.
    fn note(&self, py: Python<'_>, result: PyResult<()>) {
        let Err(error) = result else { return };
        self.stopped.set(true);
        if !error.is_instance_of::<PyKeyboardInterrupt>(py) {
            self.raised.borrow_mut().get_or_insert(error);
        }
    }

    fn call(&self, arguments: impl for<'py> pyo3::call::PyCallArgs<'py> + Send) {
        let Some(callback) = &self.callback else { return };
        Python::attach(|py| {
            let result = callback.bind(py).call1(arguments).map(|_| ());
            self.note(py, result);
        });
    }
}

impl Progress for Told {
    fn step(&mut self, index: usize, count: usize, time: f64) {
        self.call(("step", index, count, time, 0, 0.0, ""));
    }

    fn iteration(&mut self, i: &Iteration) {
        self.call(("iteration", i.step, 0, i.time, i.iteration, i.residual, i.action));
    }

    fn interrupted(&self) -> bool {
        let now = Instant::now();
        let due = self.looked.get().is_none_or(|looked| now.duration_since(looked) >= PAUSE);
        if !self.stopped.get() && due {
            self.looked.set(Some(now));
            Python::attach(|py| self.note(py, py.check_signals()));
        }
        self.stopped.get()
    }
}
