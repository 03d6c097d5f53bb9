//! Errors as exceptions of the package.

use crate::pool;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use signorini::output::OutputError;
use signorini::problem::CaseError;
use signorini::queries::FieldError;
use signorini::run::RunError;
use signorini::scene::SceneError;
use signorini_report::ReportError;
use std::panic::{AssertUnwindSafe, catch_unwind};

/// Why there is no result.
pub enum Failure {
    Case(Box<CaseError>),
    Output(OutputError),
    Field(FieldError),
    Report(ReportError),
    /// A fault of ours.
    Internal(String),
}

impl From<CaseError> for Failure {
    fn from(error: CaseError) -> Self {
        Failure::Case(Box::new(error))
    }
}

impl From<OutputError> for Failure {
    fn from(error: OutputError) -> Self {
        Failure::Output(error)
    }
}

impl From<FieldError> for Failure {
    fn from(error: FieldError) -> Self {
        Failure::Field(error)
    }
}

impl From<ReportError> for Failure {
    fn from(error: ReportError) -> Self {
        Failure::Report(error)
    }
}

impl From<RunError> for Failure {
    fn from(error: RunError) -> Self {
        match error {
            RunError::Case(error) => Failure::Case(error),
            RunError::Output(error) => Failure::Output(error),
        }
    }
}

impl From<SceneError> for Failure {
    fn from(error: SceneError) -> Self {
        match error {
            SceneError::Case(error) => Failure::Case(Box::new(error)),
            SceneError::Output(error) => Failure::Output(error),
        }
    }
}

/// Does what needs nothing of Python, without its lock; a panic becomes an exception.
///
/// # Errors
/// Failures as exceptions.
pub fn apart<T: Send>(py: Python<'_>, work: impl FnOnce() -> Result<T, Failure> + Send) -> PyResult<T> {
    guarded(py, |py| py.detach(|| pool::within(work)))
}

/// Does some work; a panic becomes an exception.
///
/// # Errors
/// Failures as exceptions.
pub fn guarded<T>(py: Python<'_>, work: impl FnOnce(Python<'_>) -> Result<T, Failure>) -> PyResult<T> {
    let result = catch_unwind(AssertUnwindSafe(|| work(py)));
    result.unwrap_or_else(|payload| Err(Failure::Internal(told(&*payload)))).map_err(|failure| failure.raised(py))
}

/// What a panic said.
fn told(payload: &(dyn std::any::Any + Send)) -> String {
    let text = payload.downcast_ref::<String>().cloned();
    text.or_else(|| payload.downcast_ref::<&str>().map(ToString::to_string)).unwrap_or_else(|| "no message".into())
}

impl Failure {
    /// The exception.
    pub fn raised(self, py: Python<'_>) -> PyErr {
        self.exception(py).unwrap_or_else(|error| error)
    }

    fn exception(self, py: Python<'_>) -> PyResult<PyErr> {
        let errors = py.import("signorini._errors")?;
        let made = match self {
            Failure::Case(error) => {
                let fields = PyDict::new(py);
                let path = error.key.as_ref().map(|key| key.to_string()).filter(|key| !key.is_empty());
                fields.set_item("path", path)?;
                fields.set_item("help", &error.help)?;
                if let Some(place) = &error.place {
                    let (line, column) = place.line_and_column();
                    fields.set_item("file", &place.name)?;
                    fields.set_item("line", line)?;
                    fields.set_item("column", column)?;
                    fields.set_item("value", place.text.get(place.span.clone()))?;
                }
                errors.getattr("CaseError")?.call((&error.message,), Some(&fields))?
            }
            Failure::Field(FieldError { path, message }) => {
                let fields = PyDict::new(py);
                fields.set_item("path", path)?;
                errors.getattr("CaseError")?.call((message,), Some(&fields))?
            }
            Failure::Output(error) => errors.getattr("OutputError")?.call1((error.to_string(),))?,
            Failure::Report(error) => {
                errors.getattr("OutputError")?.call1((format!("{error}\n  help: {}", error.help()),))?
            }
            Failure::Internal(message) => errors.getattr("InternalError")?.call1((message,))?,
        };
        Ok(PyErr::from_value(made))
    }
}
