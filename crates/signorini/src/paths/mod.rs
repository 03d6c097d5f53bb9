//! Paths on rigid bodies: shortest paths over bodies that move (`analysis = "wrapping"`), and paths of yarns on mandrels
//! (`analysis = "winding"`). No equations of bodies are solved.
//!
//! The bodies are stated as in every case; numbers of paths are in the base units.

mod output;
mod picture;
mod statement;
mod winding;
mod wrapping;

use crate::expression::{Expression, Names, Scope, parse};
use crate::output::Folder;
use crate::plan::{RigidBody, rigid_bodies};
use crate::problem::{CaseError, KeyPath, Problem, Space, suggestion};
use crate::run::Progress;
use crate::scene::SceneError;
use serde_json::Value;
use signorini_geometry::{Aabb, Point, Vector};
use signorini_paths::PathError;
use statement::{Analysis, Number, Statement};
use std::path::Path;

/// A case of paths that was read.
pub struct PathCase {
    problem: Problem,
    statement: Statement,
    bodies: Vec<RigidBody>,
    text: String,
}

/// Whether a file is about paths rather than mechanics.
pub fn is_path_case(text: &str) -> bool {
    toml::from_str::<toml::Table>(text)
        .is_ok_and(|t| t.get("analysis").and_then(|a| a.as_str()).is_some_and(|a| a == "wrapping" || a == "winding"))
}

impl PathCase {
    /// Reads a case; files that its bodies name are looked for beside the file `name`. `overrides` are `KEY=VALUE` pairs.
    ///
    /// # Errors
    /// What is wrong with it, and where.
    pub fn parse(name: &str, text: &str, overrides: &[String]) -> Result<Self, CaseError> {
        let (text, origins) = crate::case::override_key::apply(name, text, overrides)?;
        let statement: Statement = toml::from_str(&text)
            .map_err(|e| origins.relocated(crate::case::toml_error::from_toml(name, &text, &e)))?;
        let mut problem = Problem::new(Space::ThreeD);
        problem.title.clone_from(&statement.title);
        problem.units.clone_from(&statement.units);
        problem.constants = statement.constants.clone();
        problem.functions = statement.functions.clone();
        problem.bodies = statement.bodies.clone();
        problem.source = crate::case::source(name, text.clone(), origins);
        let bodies = rigid_bodies(&problem, &statement.around())?;
        let case = PathCase { problem, statement, bodies, text };
        case.check()?;
        Ok(case)
    }

    /// Its title, or the name of its file.
    pub fn name(&self) -> &str {
        self.problem.name()
    }

    /// How many paths it states.
    pub fn paths(&self) -> usize {
        self.statement.paths.len() + self.statement.winding.len()
    }

    fn check(&self) -> Result<(), CaseError> {
        let (wanted, other, key) = match self.statement.analysis {
            Analysis::Wrapping => (self.statement.paths.len(), self.statement.winding.len(), "paths"),
            Analysis::Winding => (self.statement.winding.len(), self.statement.paths.len(), "winding"),
        };
        if wanted == 0 || other > 0 {
            let message = format!("this analysis needs tables `[{key}.NAME]` and no other paths");
            return Err(self.error(&["analysis"], message));
        }
        match self.statement.analysis {
            Analysis::Wrapping => self.check_wrapping(),
            Analysis::Winding => self.check_winding(),
        }
    }

    fn error(&self, key: &[&str], message: impl Into<String>) -> CaseError {
        self.problem.error(&KeyPath::of_keys(key), message)
    }

    /// The number of a body.
    fn body(&self, key: &[&str], name: &str) -> Result<usize, CaseError> {
        self.bodies.iter().position(|b| b.name == name).ok_or_else(|| {
            let known: Vec<&str> = self.bodies.iter().map(|b| b.name.as_str()).collect();
            self.error(key, format!("there is no body `{name}`")).help(suggestion(name, &known))
        })
    }

    /// A number, or an expression of time.
    fn expression(&self, key: &[&str], value: &Number, variables: &[&'static str]) -> Result<Expression, CaseError> {
        match value {
            Number::Plain(v) => Ok(Expression::number(*v)),
            Number::Text(text) => {
                let names = Names { variables: variables.to_vec(), ..Names::default() };
                parse(text, &names).map_err(|e| self.error(key, format!("`{text}`: {}", e.message)))
            }
        }
    }

    /// An error of a path at its table.
    fn failed(&self, table: &str, name: &str, error: &PathError) -> CaseError {
        self.error(&[table, name], format!("the path `{name}`: {error}"))
    }
}

/// A value of an expression at a time.
fn at_time(expression: &Expression, time: f64) -> f64 {
    expression.evaluate(&Scope { position: [f64::NAN; 3], time })
}

/// Runs a case into a folder and returns its summary.
///
/// # Errors
/// A path that is not found, a motion that is not finite, files that cannot be written.
pub fn run(case: &PathCase, folder: &Path, progress: &mut dyn Progress) -> Result<Value, SceneError> {
    let folder = Folder::create(folder)?;
    folder.write("case.toml", case.text.as_bytes())?;
    let summary = match case.statement.analysis {
        Analysis::Wrapping => wrapping::run(case, &folder, progress)?,
        Analysis::Winding => winding::run(case, &folder, progress)?,
    };
    folder.write("summary.json", format!("{summary:#}\n").as_bytes())?;
    Ok(summary)
}

/// What a summary says, in sentences.
pub fn sentences(summary: &Value) -> Vec<String> {
    let mut out = Vec::new();
    let number = |v: &Value| v.as_f64().map_or("-".to_string(), |v| format!("{v:.6}"));
    for path in summary["paths"].as_array().into_iter().flatten() {
        let name = path["name"].as_str().unwrap_or_default();
        let frames = path["frames"].as_array().map_or(&[][..], Vec::as_slice);
        if let (Some(first), Some(last)) = (frames.first(), frames.last()) {
            let touched = last["contacts"].as_array().map_or(0, Vec::len);
            out.push(format!(
                "{name}: length {} at t = 0, {} at the end, where it touches {touched} times",
                number(&first["length"]),
                number(&last["length"])
            ));
            if let Some(limits) = last["tension_limits"].as_array() {
                let [low, high] = [0, 1].map(|k| limits.get(k).map_or("-".into(), number));
                out.push(format!("  friction holds tensions from {low} to {high} at its end"));
            }
            if last["slips"] == true {
                out.push(format!("  it slips: {} of the friction is used", number(&last["utilisation"])));
            }
        }
        for event in path["events"].as_array().into_iter().flatten() {
            let text = |key: &str| event[key].as_str().unwrap_or_default().replace('_', " ");
            out.push(format!("  {} of `{}` at t = {}", text("kind"), text("body"), number(&event["time"])));
        }
    }
    for path in summary["winding"].as_array().into_iter().flatten() {
        let name = path["name"].as_str().unwrap_or_default();
        out.push(format!(
            "{name}: length {}, largest slippage {}",
            number(&path["length"]),
            number(&path["largest_slippage"])
        ));
        if let Some(pattern) = path["pattern"].as_object() {
            out.push(format!(
                "  pattern of {} circuits, {} places on after each, dwell {} rad; {} covered",
                pattern["n"],
                pattern["k"],
                number(&pattern["dwell"]),
                number(&path["coverage"]["covered"])
            ));
        }
        for key in ["bridges", "slips"] {
            for part in path[key].as_array().into_iter().flatten() {
                out.push(format!("  it {key} from s = {} to {}", number(&part[0]), number(&part[1])));
            }
        }
    }
    out
}

/// The box of points, and beyond it by a part of its size.
fn box_around(points: impl Iterator<Item = Point<3>>, part: f64) -> Aabb<3> {
    let (mut low, mut high) = (Vector::<3>::repeat(f64::INFINITY), Vector::<3>::repeat(f64::NEG_INFINITY));
    for x in points {
        (low, high) = (low.inf(&x), high.sup(&x));
    }
    let pad = Vector::<3>::repeat(part * (high - low).max().max(f64::MIN_POSITIVE));
    Aabb::new(low - pad, high + pad)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::Silent;

    const WRAPPING: &str = "analysis = \"wrapping\"\nframes = 2\n\
        [bodies.egg.rigid]\nshape.ellipsoid = { center = [0, 0, 0], semi_axes = [2, 1.5, 1] }\n\
        [paths.tendon]\nfrom = [-3, \"0.5 + 4*t\", 0.3]\nto = [2.2, 1.6, -0.9]\naround = [\"egg\"]\n\
        friction.coulomb = { mu = 0.3 }\ntension = 2.0\nend_tension = \"2 + t\"\n";

    const WINDING: &str = "analysis = \"winding\"\n\
        [bodies.dome.rigid]\nshape.ellipsoid = { center = [0, 0, 0], semi_axes = [50, 50, 30] }\n\
        [winding.yarn]\non = \"dome\"\nstart = { z = 0.0, angle = \"25 deg\" }\nfriction = 0.2\n\
        polar_opening = { radius = 25.7059722868 }\n";

    fn summary(text: &str) -> (tempfile::TempDir, Value) {
        let folder = tempfile::tempdir().unwrap();
        let case = PathCase::parse("case.toml", text, &[]).unwrap();
        let summary = run(&case, &folder.path().join("out"), &mut Silent).unwrap();
        (folder, summary)
    }

    #[test]
    fn a_shortest_path_from_a_case_file() {
        let (folder, summary) = summary(WRAPPING);
        let frames = &summary["paths"][0]["frames"];
        assert!((frames[0]["length"].as_f64().unwrap() - 5.488_014_095_081).abs() < 1e-10, "{frames}");
        assert_eq!(frames[1]["contacts"].as_array().unwrap().len(), 0);
        assert_eq!(summary["paths"][0]["events"][0]["kind"], "lift_off");
        let limit = frames[0]["tension_limits"][1].as_f64().unwrap();
        assert!((limit - 2.0 * frames[0]["log_ratio"][1].as_f64().unwrap().exp()).abs() < 1e-12);
        let out = folder.path().join("out");
        for file in
            ["tendon.csv", "tendon.pvd", "bodies.pvd", "pictures/paths.png", "summary.json", "frames/tendon_0001.vtp"]
        {
            assert!(out.join(file).exists(), "{file}");
        }
        assert!(sentences(&summary).len() > 2);
    }

    #[test]
    fn a_yarn_from_a_case_file() {
        let (folder, summary) = summary(WINDING);
        let yarn = &summary["winding"][0];
        assert!((yarn["slippage_sought"].as_f64().unwrap() - 0.1).abs() < 1e-8, "{yarn}");
        assert!((yarn["length"].as_f64().unwrap() - 58.410_219_3).abs() < 1e-6 && yarn["stable"] == true, "{yarn}");
        assert!(folder.path().join("out/yarn.csv").exists());
        let varied =
            WINDING.replace("polar_opening = { radius = 25.7059722868 }", "slippage = \"0.001*s\"\nlength = 10");
        let case = PathCase::parse("case.toml", &varied, &[]).unwrap();
        let slippage = case.slippage("yarn", &case.statement.winding["yarn"]).unwrap().unwrap();
        let signorini_paths::winding::Slippage::Variable(f) = slippage else { panic!() };
        let at = signorini_paths::winding::At { s: 20.0, angle: 0.3, radius: 1.0, height: 2.0 };
        assert!((f(&at) - 0.02).abs() < 1e-15);
    }

    #[test]
    fn refused_cases_say_where() {
        let wrong = |text: &str, part: &str, line: usize| {
            let Err(error) = PathCase::parse("case.toml", text, &[]) else { panic!("{part} is not refused") };
            let place = error.place.as_ref().map(|place| place.line_and_column().0);
            assert!(error.to_string().contains(part) && place == Some(line), "{error:?}");
        };
        wrong(&WRAPPING.replace("[\"egg\"]", "[\"eg\"]"), "there is no body `eg`", 8);
        wrong(&WRAPPING.replace("frames = 2", "frames = 0"), "`frames` is 0", 2);
        wrong(&WRAPPING.replace("mu = 0.3", "mu = -0.3"), "coefficient of friction", 9);
        wrong(&WINDING.replace("25 deg", "wide deg"), "is not a number of degrees", 6);
    }
}
