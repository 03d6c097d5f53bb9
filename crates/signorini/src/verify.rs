//! Problems with known answers, run here and now.

use crate::run::run;
use serde_json::{Value, json};
use signorini_solve::Silent;
use signorini_verify::flat_floor::{FlatFloor, Kind};
use std::f64::consts::PI;
use std::path::Path;

/// A problem with a known answer.
pub struct Problem {
    pub name: &'static str,
    /// A case of the gallery, changed in these keys.
    case: &'static str,
    set: &'static [&'static str],
    /// Where in the summary the figure stands: a key of the first contact at the end; `event:KIND`; a path that begins with
    /// `/`, in which -1 is the last entry of a list; or the difference of two such paths.
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

/// The problems, of every kind of body.
pub const PROBLEMS: [Problem; 19] = [
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
    Problem {
        name: "a block pushed up a wedge with friction: force",
        case: "wedge",
        set: &[],
        figure: "/steps/-1/support_forces/push/0",
        exact: || (0.1 + 0.3) / (1.0 - 0.1 * 0.3),
        allowed: 1e-5,
        source: "statics, NAFEMS CGS-4",
    },
    Problem {
        name: "a press fit at finite strain that slips: dissipation",
        case: "press_fit",
        set: &[],
        figure: "dissipation",
        exact: || 0.001 * 0.829_38,
        allowed: 5e-3,
        source: "Lamé and Coulomb, small strain",
    },
    Problem {
        name: "a rope round a drum: logarithm of the ratio of tensions",
        case: "capstan",
        set: &["bodies.rope.rope.cells=120", "steps=[{ to = 0.1, increments = 1 }]"],
        figure: "rope/log_ratio/1",
        // Friction acts at the surface of the drum, tension on the centre line of the rope.
        exact: || 0.3 * 1.5 * PI / 1.02,
        allowed: 1e-2,
        source: "Euler and Eytelwein",
    },
    Problem {
        name: "a rope that slides over an elastic pulley: tension",
        case: "elastic_pulley",
        set: &[],
        figure: "/steps/-1/curves/rope/end_tension",
        exact: || 0.1 * (0.3 * PI).exp(),
        allowed: 3e-3,
        source: "Euler and Eytelwein",
    },
    Problem {
        name: "a free drum turned by a moment: difference of tensions",
        case: "belt",
        set: &[],
        figure: "/steps/-1/curves/belt/max_tension - /steps/-1/curves/belt/min_tension",
        exact: || 1.5 / 1.02,
        allowed: 1e-3,
        source: "balance of moments",
    },
    Problem {
        name: "two beams that cross, small displacements: force",
        case: "crossing",
        set: &["supports.b.displacement=[0, 0, \"-0.011*t\"]", "steps=[{ to = 1 }]"],
        figure: "force/2",
        exact: crossing_force,
        allowed: 1e-3,
        source: "Timoshenko, clamped beams",
    },
    Problem {
        name: "finite cells, a plate with a hole: displacement beside it",
        case: "plate_holes",
        set: &[],
        figure: "/steps/-1/probes/side/displacement/0",
        exact: || 3e-3,
        allowed: 1e-4,
        source: "Kirsch",
    },
    Problem {
        name: "finite cells, a disc on a plane: force",
        case: "hertz_cells",
        set: &[],
        figure: "force/1",
        // Half of the disc.
        exact: || 0.018_384_6 / 2.0,
        allowed: 1e-3,
        source: "a fitted mesh of high order",
    },
    Problem {
        name: "a shortest path over an ellipsoid: length",
        case: "geodesic",
        set: &[],
        figure: "/paths/0/frames/-1/length",
        exact: || 5.488_014_095_081,
        allowed: 1e-9,
        source: "the boundary value problem",
    },
    Problem {
        name: "a yarn wound on an ellipsoid: radius at which it turns",
        case: "dome",
        set: &[],
        figure: "/winding/0/circuit/turn_radii/0",
        exact: || 50.0 * (PI / 6.0).sin(),
        allowed: 1e-9,
        source: "Clairaut",
    },
];

/// The force between two beams of length 4 and radius 0.05, clamped at both ends, of which one is moved by 0.001 against the other one.
fn crossing_force() -> f64 {
    let (length, radius, modulus) = (4.0_f64, 0.05_f64, 1e6);
    let area = PI * radius.powi(2);
    let bending = length.powi(3) / (192.0 * modulus * area * radius.powi(2) / 4.0);
    let shear = length / (4.0 * 0.9 * modulus / 2.6 * area);
    0.001 / (2.0 * (bending + shear))
}

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
    let summary = if crate::gallery::PATHS.iter().any(|e| e.name == example.name) {
        set.pop();
        let case = crate::paths::PathCase::parse(example.name, example.case, &set).map_err(|e| e.one_line())?;
        crate::paths::run(&case, folder, &mut Silent).map_err(|e| format!("{e:?}"))?
    } else {
        let stated = crate::case::read(example.name, example.case, &set).map_err(|e| e.one_line())?;
        run(&stated, folder, &mut Silent).map_err(|e| e.to_string())?.summary
    };
    if !summary.converged {
        return Err(summary.verdict);
    }
    let found = figure(&json!(summary), problem.figure).ok_or("the summary does not contain this quantity")?;
    let exact = (problem.exact)();
    let error = (found - exact).abs() / exact.abs();
    let Problem { name, allowed, source, .. } = *problem;
    Ok(Verdict { name, found, exact, error, allowed, source })
}

fn figure(summary: &Value, name: &str) -> Option<f64> {
    if let Some(kind) = name.strip_prefix("event:") {
        return summary["events"].as_array()?.iter().find(|e| e["kind"] == kind)?["time"].as_f64();
    }
    if let Some((large, small)) = name.split_once(" - ") {
        return Some(figure(summary, large)? - figure(summary, small)?);
    }
    if name.starts_with('/') {
        return at(summary, name)?.as_f64();
    }
    at(summary, "/steps/-1/contacts")?.as_object()?.values().next()?.pointer(&format!("/{name}"))?.as_f64()
}

/// What stands at a path, in which -1 is the last entry of a list.
fn at<'a>(value: &'a Value, path: &str) -> Option<&'a Value> {
    path.split('/').skip(1).try_fold(value, |inner, key| match inner {
        Value::Array(list) if key == "-1" => list.last(),
        Value::Array(list) => list.get(key.parse::<usize>().ok()?),
        _ => inner.get(key),
    })
}
