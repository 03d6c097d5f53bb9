//! The native part of the Python package `signorini`: few functions on texts, plain tables and bytes. The classes of the
//! package are Python and stand in `python/signorini`.

mod closest;
mod errors;
mod node;
mod pool;
mod progress;
mod results;
mod stated;
mod sweep;

use crate::errors::{Failure, apart, guarded};
use crate::progress::Told;
use crate::stated::Stated;
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use serde_json::json;
use signorini::output::Folder;
use signorini::paths::{self, PathCase};
use signorini::plan::plan;
use signorini::run;
use signorini::scene::{self, Scene};
use signorini_report::draw::{Wanted, draw_to, format_of};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Files in memory, by the names that a case gives them.
type Given = BTreeMap<String, Vec<u8>>;

/// A folder on disk, or one in memory.
fn folder(path: Option<&PathBuf>) -> Result<Folder, signorini::output::OutputError> {
    path.map_or_else(|| Ok(Folder::in_memory()), |path| Folder::create(path))
}

/// The content of a case file as JSON, without what is left out.
///
/// # Errors
/// What is wrong in it, with its place.
#[pyfunction]
fn read(py: Python<'_>, name: &str, text: &str, settings: Vec<String>) -> PyResult<String> {
    apart(py, || {
        let problem = signorini::case::read(name, text, &settings)?;
        serde_json::to_string(&problem).map_err(|e| Failure::Internal(e.to_string()))
    })
}

/// Runs a problem. Returns its summary as JSON, states and files.
///
/// # Errors
/// What is wrong with it, by its key; a folder that cannot be written.
#[pyfunction]
#[pyo3(signature = (name, stated, settings, files, output, progress))]
fn solve<'py>(
    py: Python<'py>,
    name: String,
    stated: &Bound<'py, PyAny>,
    settings: Vec<String>,
    files: Given,
    output: Option<PathBuf>,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let stated = Stated::of(name, stated, settings, files)?;
    let (found, raised, case) = apart(py, || {
        let problem = stated.problem()?;
        let case = signorini::case::text(&problem);
        let mut told = Told::new(progress);
        let found = if paths::is_of_paths(&problem) {
            let case = PathCase::new(&problem)?;
            let folder = folder(output.as_ref())?;
            let summary = paths::run_into(&case, &folder, &mut told)?;
            (summary.to_json(), Vec::new(), folder.take_files())
        } else {
            let (outcome, files) = run::keep(&problem, output.as_deref(), &mut told)?;
            (outcome.summary.to_json(), outcome.states, files)
        };
        Ok((found, told.into_error(), case))
    })?;
    if let Some(error) = raised {
        return Err(error);
    }
    let (summary, states, files) = found;
    let out = PyDict::new(py);
    out.set_item("summary", summary)?;
    out.set_item("case", case)?;
    out.set_item("states", results::states(py, &states)?)?;
    out.set_item("files", results::files(py, files)?)?;
    Ok(out)
}

/// What a run would have to do, as JSON; with `picture` also a picture of the beginning as SVG.
///
/// # Errors
/// What is wrong with the problem, by its key.
#[pyfunction]
fn check(
    py: Python<'_>,
    name: String,
    stated: &Bound<'_, PyAny>,
    settings: Vec<String>,
    files: Given,
    picture: bool,
) -> PyResult<(String, Option<String>)> {
    let stated = Stated::of(name, stated, settings, files)?;
    apart(py, || {
        let problem = stated.problem()?;
        if paths::is_of_paths(&problem) {
            let case = PathCase::new(&problem)?;
            let drawn = if picture { Some(paths::preview(&case)?) } else { None };
            return Ok((json!({"paths": case.paths()}).to_string(), drawn));
        }
        let plan = plan(&problem)?;
        let sizes = run::sizes(&plan)?;
        let drawn = if picture { run::preview(&plan)? } else { None };
        Ok((sizes.to_string(), drawn))
    })
}

/// Fits the unknowns of a problem to measurements. Returns the summary as JSON, and files.
///
/// # Errors
/// What is wrong with the problem, by its key; a folder that cannot be written.
#[pyfunction]
#[pyo3(signature = (name, stated, settings, files, output))]
fn fit<'py>(
    py: Python<'py>,
    name: String,
    stated: &Bound<'py, PyAny>,
    settings: Vec<String>,
    files: Given,
    output: Option<PathBuf>,
) -> PyResult<(String, Bound<'py, PyDict>)> {
    let stated = Stated::of(name, stated, settings, files)?;
    let (summary, files) = apart(py, || {
        let memory = Folder::in_memory();
        let made = || if output.is_some() { folder(output.as_ref()) } else { Ok(memory.clone()) };
        let fitted = signorini::fit::fit_into(&stated.problem()?, made)?;
        Ok((fitted.summary.to_string(), memory.take_files()))
    })?;
    Ok((summary, results::files(py, files)?))
}

/// Runs a scene of moving bodies (`analysis = "closest_pairs"`). Returns the summary as JSON, and files.
///
/// # Errors
/// What is wrong with it, with its place; a folder that cannot be written.
#[pyfunction]
#[pyo3(signature = (name, text, settings, output))]
fn run_scene<'py>(
    py: Python<'py>,
    name: &str,
    text: &str,
    settings: Vec<String>,
    output: Option<PathBuf>,
) -> PyResult<(String, Bound<'py, PyDict>)> {
    let (summary, files) = apart(py, || {
        let (text, origins) = signorini::case::override_key::apply(name, text, &settings)?;
        let beside = Path::new(name).parent().unwrap_or(Path::new(""));
        let scene = Scene::parse(name, &text, beside).map_err(|error| origins.relocated(error))?;
        let folder = folder(output.as_ref())?;
        let summary = scene::run_into(&scene, &folder, &mut run::Silent)?;
        Ok((summary.to_string(), folder.take_files()))
    })?;
    Ok((summary, results::files(py, files)?))
}

/// Writes the results of a folder as one HTML page.
///
/// # Errors
/// A folder without results, a page that cannot be written.
#[pyfunction]
fn report(py: Python<'_>, folder: PathBuf, output: PathBuf) -> PyResult<()> {
    apart(py, || {
        signorini_report::write(&folder, Some(&output))?;
        Ok(())
    })
}

/// Draws the results of a folder: as bytes in a format, and into a file where one is given.
///
/// # Errors
/// A folder without results, options that cannot be understood, a picture that cannot be written.
#[pyfunction]
#[pyo3(signature = (folder, output, format, field, time, view, clips, range, scale, size))]
#[allow(clippy::too_many_arguments)]
fn draw<'py>(
    py: Python<'py>,
    folder: PathBuf,
    output: Option<PathBuf>,
    format: &str,
    field: Option<String>,
    time: Option<String>,
    view: Option<String>,
    clips: Vec<String>,
    range: Option<String>,
    scale: Option<f64>,
    size: Option<String>,
) -> PyResult<Bound<'py, PyBytes>> {
    let wanted = Wanted { field, time, view, clips, range, scale, size };
    let format = Path::new("picture").with_extension(format);
    let bytes = apart(py, || {
        let drawn = match output {
            Some(output) => draw_to(&folder, Some(&output), &wanted)?.1,
            None => signorini_report::draw::draw(&folder, &wanted, format_of(&format)?)?,
        };
        Ok(drawn.bytes)
    })?;
    Ok(PyBytes::new(py, &bytes))
}

/// Whether a text is a scene of moving bodies rather than a problem.
#[pyfunction]
fn is_scene(text: &str) -> bool {
    scene::is_scene(text)
}

/// The JSON Schema of case files.
#[pyfunction]
fn schema() -> String {
    signorini::case::schema::schema().to_string()
}

/// What a key of the case file or a word of the results means.
///
/// # Errors
/// A word that is neither.
#[pyfunction]
fn explain(py: Python<'_>, word: &str) -> PyResult<String> {
    apart(py, || Ok(signorini::explain::explain(word)?))
}

/// Name, description and text of the cases of the gallery.
#[pyfunction]
fn gallery() -> Vec<(&'static str, &'static str, &'static str)> {
    signorini::gallery::all().map(|e| (e.name, e.about, e.case)).collect()
}

/// Sets the number of threads, once and before any run.
///
/// # Errors
/// Threads that work already.
#[pyfunction]
fn set_threads(count: usize) -> PyResult<()> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(count);
    pool.build_global()
        .map_err(|e| PyRuntimeError::new_err(format!("set the number of threads before the first run: {e}")))
}

/// Panics, for the test that a fault of ours is an exception.
///
/// # Errors
/// Always.
#[pyfunction]
fn panic(py: Python<'_>) -> PyResult<()> {
    guarded(py, |_| panic!("asked for"))
}

/// The module.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::closest::closest_points;
    #[pymodule_export]
    use super::sweep::{sweep_begin, sweep_gather, sweep_missing, sweep_row};
    use super::{Bound, PyModule, PyModuleMethods, PyResult};
    #[pymodule_export]
    use super::{
        check, draw, explain, fit, gallery, is_scene, panic, read, report, run_scene, schema, set_threads, solve,
    };

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        super::pool::loaded();
        module.add("__version__", env!("CARGO_PKG_VERSION"))
    }
}
