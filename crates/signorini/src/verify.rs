//! Problems with known answers, run here and now.

use crate::run::run;
use serde_json::{Value, json};
use signorini_solve::Silent;
use signorini_verify::flat_floor::{FlatFloor, Kind};
use std::path::Path;

/// A problem with a known answer.
pub struct Problem {
    pub name: &'static str,
    /// A case of the gallery, changed in these keys.
    case: &'static str,
    set: &'static [&'static str],
    /// Where in the summary the figure stands.
    figure: &'static str,
    exact: fn() -> f64,
    /// Allowed error, relative.
    pub allowed: f64,
    /// Where the answer is from.
    pub source: &'static str,
}

/// What came of a problem.
#[derive(Clone, Debug)]
pub struct Verdict {
    pub name: &'static str,
    pub found: f64,
    pub exact: f64,
    pub error: f64,
    pub allowed: f64,
    pub source: &'static str,
}

impl Verdict {
    pub fn holds(&self) -> bool {
        self.error <= self.allowed
    }
}

/// The problems, quickest first.
pub const PROBLEMS: [Problem; 9] = [
    Problem {
        name: "a string on a flat floor: contact length",
        case: "string",
        set: &[],
        figure: "area",
        exact: || FLAT.contact_force(),
        allowed: 1e-10,
        source: "parabolas and a straight part",
    },
    Problem {
        name: "an axisymmetric membrane: area",
        case: "axisymmetric",
        set: &[],
        figure: "area",
        exact: || FlatFloor { kind: Kind::Round, ..FLAT }.contact_force(),
        allowed: 1e-9,
        source: "(1 - a²)/4 + a²/2 ln a = 0.1",
    },
    Problem {
        name: "the same in the plane, on a grid that its boundary cuts",
        case: "flat_disc",
        set: &[],
        figure: "area",
        exact: || FlatFloor { kind: Kind::Round, ..FLAT }.contact_force(),
        allowed: 1e-7,
        source: "(1 - a²)/4 + a²/2 ln a = 0.1",
    },
    Problem {
        name: "the same: force",
        case: "flat_disc",
        set: &[],
        figure: "force/2",
        exact: || FlatFloor { kind: Kind::Round, ..FLAT }.contact_force(),
        allowed: 1e-7,
        source: "the load over the contact zone",
    },
    Problem {
        name: "a cosine floor, area of a zone with a small hole",
        case: "cosine_disc",
        set: &["steps=[]", "loads.press.normal=-0.39", "bodies.film.membrane.mesh.grid.cells=[40, 40]"],
        figure: "area",
        exact: || 1.298_690_0,
        allowed: 1e-6,
        source: "degree 4, 80 x 80 cells divided three times",
    },
    Problem {
        name: "an adhesive axisymmetric membrane: time of pull-off",
        case: "snap_in",
        set: &[],
        figure: "event:pull_off",
        // The load -0.11761861487 of the closed form falls from 0.5 at t = 1 by 0.7 in a unit of time.
        exact: || 1.882_312_306_957,
        allowed: 1e-7,
        source: "closed form of the adhesive equilibria",
    },
    Problem {
        name: "an elastic cylinder on a plane: force",
        case: "hertz",
        set: &[],
        figure: "force/1",
        // Half of the cylinder.
        exact: || 26.062_15,
        allowed: 2e-3,
        source: "degrees 6 and 8 on four meshes",
    },
    Problem {
        name: "patch test: pressure at an interface of non-matching meshes",
        case: "patch_test",
        set: &[],
        figure: "max_pressure",
        exact: || 10.0,
        allowed: 1e-10,
        source: "a constant pressure",
    },
    Problem {
        name: "NAFEMS CB-1: largest pressure",
        case: "cylinder_on_block",
        set: &[],
        figure: "max_pressure",
        exact: || 3585.4,
        allowed: 1.5e-2,
        source: "Hertz, for a half space",
    },
];

/// A membrane of unit size, tension and load over a floor at 0.1: the force is the area of contact.
const FLAT: FlatFloor = FlatFloor { tension: 1.0, load: 1.0, depth: 0.1, radius: 1.0, kind: Kind::String };

/// Runs one problem, its results into a folder.
///
/// # Errors
/// In words, where a case does not run to its end.
pub fn verify(problem: &Problem, folder: &Path) -> Result<Verdict, String> {
    let example = crate::gallery::find(problem.case).ok_or_else(|| format!("no case `{}`", problem.case))?;
    let mut set: Vec<String> = problem.set.iter().map(|s| s.to_string()).collect();
    set.push("output.pictures=false".into());
    let stated = crate::case::read(example.name, example.case, &set).map_err(|e| e.one_line())?;
    let outcome = run(&stated, folder, &mut Silent).map_err(|e| e.to_string())?;
    if !outcome.summary.converged {
        return Err(outcome.summary.verdict);
    }
    let found = figure(&json!(outcome.summary), problem.figure).ok_or("the summary does not contain this quantity")?;
    let exact = (problem.exact)();
    let error = (found - exact).abs() / exact.abs();
    let Problem { name, allowed, source, .. } = *problem;
    Ok(Verdict { name, found, exact, error, allowed, source })
}

fn figure(summary: &Value, name: &str) -> Option<f64> {
    if let Some(kind) = name.strip_prefix("event:") {
        return summary["events"].as_array()?.iter().find(|e| e["kind"] == kind)?["time"].as_f64();
    }
    let contact = summary["steps"].as_array()?.last()?["contacts"].as_object()?.values().next()?;
    contact.pointer(&format!("/{name}"))?.as_f64()
}
