//! Published and exact problems, run as a user runs them: from the case file to the summary.

mod adhesion;
mod arc_length;
mod architecture;
mod audit;
mod bad_input;
mod bad_starts;
mod cells;
mod closest_points;
mod cosine_floor;
mod curves;
mod docs;
mod dynamics;
mod events;
mod fit;
mod flat_floor;
mod floors;
mod free_bodies;
mod friction;
mod gallery;
mod heat;
mod imported;
mod invariance;
mod manuals;
mod materials;
mod meshes;
mod plasticity;
mod probes;
mod published;
mod refinement;
mod resume;
mod rigid_bodies;
mod rigid_boxes;
mod rigid_dynamics;
mod ropes_at_rest;
mod scenes;
mod schema;
mod sharp_edges;
mod solid_theory;
mod solids;
mod stability;
mod statement;
mod step_bodies;
mod sweep;
mod systems;
mod unit;
mod verify;
mod words;

#[path = "../../examples/04_cells.rs"]
mod cells_example;
#[path = "../../examples/03_rope.rs"]
mod rope_example;

use serde_json::Value;
use signorini::problem::CaseError;
use signorini::run::{RunError, run};
use signorini_solve::Silent;

#[test]
fn the_examples_hold() {
    rope_example::main().expect("a rope");
    cells_example::main().expect("a column");
}

/// Runs a case text with overrides and returns its summary.
pub fn summary(case: &str, set: &[String]) -> Value {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let problem = signorini::case::read("case.toml", case, set).unwrap_or_else(|e| panic!("{}", e.one_line()));
    match run(&problem, &folder.path().join("out"), &mut Silent) {
        Ok(outcome) => serde_json::json!(outcome.summary),
        Err(error) => panic!("{error}"),
    }
}

/// The error of a case that cannot run.
pub fn error(case: &str) -> CaseError {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let problem = match signorini::case::read("case.toml", case, &[]) {
        Ok(problem) => problem,
        Err(error) => return error,
    };
    match run(&problem, &folder.path().join("out"), &mut Silent) {
        Err(RunError::Case(error)) => *error,
        Err(other) => panic!("{other}"),
        Ok(outcome) => panic!("the case ran: {}", outcome.summary.verdict),
    }
}

/// The overrides `KEY=VALUE` of a run without pictures.
pub fn set(pairs: &[(&str, String)]) -> Vec<String> {
    let pictures = ("output.pictures", "false".to_string());
    pairs.iter().chain([&pictures]).map(|(k, v)| format!("{k}={v}")).collect()
}

/// The last step of a summary that must have converged.
pub fn last_step(summary: &Value) -> &Value {
    assert_eq!(summary["converged"], true, "{}", summary["verdict"]);
    summary["steps"].as_array().and_then(|s| s.last()).expect("a step")
}

pub fn number(v: &Value) -> f64 {
    v.as_f64().unwrap_or_else(|| panic!("{v} is not a number"))
}

/// Reference data, computed independently with spectral accuracy.
pub fn reference() -> Value {
    serde_json::from_str(include_str!("../data/membrane.json")).expect("reference data")
}

pub const CELLS: &str = "bodies.film.membrane.mesh.grid.cells";
pub const REFINE: &str = "bodies.film.membrane.mesh.grid.refine";
pub const DEGREE: &str = "bodies.film.membrane.degree";

/// A gallery case by name.
pub fn example(name: &str) -> &'static str {
    signorini::gallery::find(name).expect("a gallery case").case
}
