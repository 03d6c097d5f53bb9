//! What the commands do. Each returns the exit status.

use crate::bar::{Bar, Counter};
use crate::console::{self, say, tell};
use serde_json::{Value, json};
use signorini::case::override_key;
use signorini::fit::fit;
use signorini::gallery::{all, find};
use signorini::output::chart::save_as;
use signorini::output::figure::{figures, told};
use signorini::output::{Earlier, OutputError};
use signorini::paths::{self, PathCase};
use signorini::plan::plan;
use signorini::problem::{CaseError, Limits, Problem};
use signorini::processes;
use signorini::queries::{Query, answer_file, answer_points};
use signorini::report::{Summary, UnitNames, resultants, table};
use signorini::run::{Begun, Ending, RunError, begun, preview, resume, run, sizes};
use signorini::scene::{self, Scene, SceneError};
use std::path::{Path, PathBuf};

pub const DONE: u8 = 0;
pub const WRONG_INPUT: u8 = 1;
pub const NOT_CONVERGED: u8 = 2;
pub const INTERRUPTED: u8 = 130;

/// How a case is to be run.
pub struct Wanted {
    pub output: Option<PathBuf>,
    /// Keys that replace or add others.
    pub set: Vec<String>,
    /// What stands in place of the limits of the case.
    pub limits: Limits,
    pub resume: bool,
}

pub fn run_file(case: &Path, wanted: &Wanted, json: bool) -> u8 {
    let (name, text) = match processes::all(read(case)) {
        Ok(read) => read,
        Err(error) => return report(&error, json),
    };
    let folder = wanted.output.clone().unwrap_or_else(|| default_folder(case));
    execute(&name, &text, &folder, wanted, json)
}

pub fn fit_file(case: &Path, output: Option<PathBuf>, set: &[String], json: bool) -> u8 {
    let problem = match read(case).and_then(|(name, text)| signorini::case::read(&name, &text, set)) {
        Ok(problem) => problem,
        Err(error) => return report(&error, json),
    };
    let folder = output.unwrap_or_else(|| default_folder(case));
    let replaced = Earlier::in_folder(&folder);
    match fit(&problem, &folder) {
        Err(RunError::Case(error)) => report(&error, json),
        Err(RunError::Output(error)) => report(&output_error(&error), json),
        Ok(fitted) => {
            if json {
                say!("{}", fitted.summary);
            } else {
                for warning in fitted.summary["warnings"].as_array().into_iter().flatten() {
                    say!("warning: {}", warning.as_str().unwrap_or(""));
                }
                say!("{}", fitted.summary["verdict"].as_str().unwrap_or(""));
                say!("\nResults in {}: open pictures/fit.png; numbers in summary.json and fit.csv.", folder.display());
                say_replaced(replaced);
            }
            if fitted.converged { DONE } else { NOT_CONVERGED }
        }
    }
}

/// Says which results are gone.
fn say_replaced(earlier: Option<Earlier>) {
    if let Some(Earlier { case, written }) = earlier {
        let of = case.map_or(String::new(), |case| format!(" of {case}"));
        say!("They replace those{of} that were written on {written}.");
    }
}

/// The folder called after a case.
pub fn default_folder(case: &Path) -> PathBuf {
    // A case that lies in a folder of its own is called after the folder.
    let stem = case.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    let parent = case.parent().and_then(|p| p.file_name()).map(|p| p.to_string_lossy().into_owned());
    let default = match (stem.as_str(), parent) {
        ("case", Some(parent)) => parent,
        ("" | "-", _) => "results".to_string(),
        _ => stem,
    };
    PathBuf::from(if Path::new(&default).is_file() { format!("{default}.results") } else { default })
}

pub fn run_example(name: &str, wanted: &Wanted, json: bool) -> u8 {
    match find(name) {
        Some(example) => {
            let folder = wanted.output.clone().unwrap_or_else(|| PathBuf::from(name));
            execute(&format!("{name}.toml"), example.case, &folder, wanted, json)
        }
        None => report(&unknown_example(name), json),
    }
}

pub fn show_example(name: &str, json: bool) -> u8 {
    match find(name) {
        Some(example) if json => {
            say!("{}", json!({"name": example.name, "about": example.about, "case": example.case}))
        }
        Some(example) => console::print(format_args!("{}", example.case)),
        None => return report(&unknown_example(name), json),
    }
    DONE
}

pub fn gallery(json: bool) -> u8 {
    if json {
        let list: Vec<Value> = all().map(|e| json!({"name": e.name, "about": e.about})).collect();
        say!("{}", Value::from(list));
        return DONE;
    }
    for example in all() {
        say!("{:14} {}", example.name, example.about);
    }
    say!("\nRun one with  signorini gallery run NAME");
    DONE
}

pub fn check(case: &Path, set: &[String], picture: Option<&Path>, json: bool) -> u8 {
    if let Ok((name, text)) = read(case)
        && scene::is_scene(&text)
    {
        return match read_scene(&name, &text, set) {
            Err(error) => report(&error, json),
            Ok(_) if picture.is_some() => {
                let error =
                    CaseError::new("a scene has no preview").help("run it: pictures/scene.png shows its frames");
                report(&error, json)
            }
            Ok(scene) => {
                let sizes = json!({"bodies": scene.bodies.len(), "frames": scene.times.len()});
                if json {
                    say!("{sizes}")
                } else {
                    say!("{name}: the scene is valid: {} frames.", scene.times.len())
                }
                DONE
            }
        };
    }
    let checked = read(case).and_then(|(name, text)| signorini::case::read(&name, &text, set)).and_then(|problem| {
        if paths::is_of_paths(&problem) {
            let case = PathCase::new(&problem)?;
            if let Some(file) = picture {
                let drawn = paths::preview(&case).map_err(|error| match error {
                    SceneError::Case(error) => error,
                    SceneError::Output(error) => output_error(&error),
                })?;
                save_as(file, &drawn).map_err(|e| output_error(&e))?;
            }
            return Ok((problem, json!({"paths": case.paths()})));
        }
        let plan = plan(&problem)?;
        let sizes = sizes(&plan)?;
        if let Some(file) = picture {
            let drawn = match preview(&plan) {
                Ok(drawn) => drawn,
                Err(RunError::Case(error)) => return Err(*error),
                Err(RunError::Output(error)) => return Err(output_error(&error)),
            };
            let nothing = || CaseError::new("there is nothing to draw: the membrane could not be solved for");
            save_as(file, &drawn.ok_or_else(nothing)?).map_err(|e| output_error(&e))?;
        }
        Ok((problem, sizes))
    });
    match checked {
        Err(error) => report(&error, json),
        Ok((problem, sizes)) => {
            if json {
                say!("{sizes}");
            } else {
                say!("{}: the case is valid.", problem.source.name);
                for (key, value) in sizes.as_object().into_iter().flatten() {
                    match value {
                        Value::Array(list) if list.is_empty() => {}
                        Value::Array(list) => {
                            say!("  {}", key.replace('_', " "));
                            list.iter().for_each(|v| say!("    {}", echo(v)));
                        }
                        value => say!("  {:22} {}", key.replace('_', " "), value.to_string().trim_matches('"')),
                    }
                }
                if let Some(file) = picture {
                    say!("Picture in {}.", file.display());
                }
            }
            DONE
        }
    }
}

/// An entry of a list: a text as it is, a warning, a value with a unit as it was understood.
fn echo(v: &Value) -> String {
    if let Some(message) = v["message"].as_str() {
        return message.to_string();
    }
    match (v.as_str(), &v["text"], v["value"].as_f64()) {
        (Some(text), ..) => text.to_string(),
        (None, Value::String(text), Some(value)) => {
            format!("{}: `{text}` is {value} {}", line(v), v["unit"].as_str().unwrap_or(""))
        }
        (None, Value::String(text), None) => {
            let unit = v["unit"].as_str().unwrap_or("");
            format!("{}: `{text}`, whose unit is {} {unit}", line(v), v["factor"])
        }
        _ => v.to_string(),
    }
}

/// Where a value with a unit stands.
fn line(v: &Value) -> String {
    v["line"].as_u64().map_or("--set".into(), |line| format!("line {line}"))
}

/// An error of the results folder, with what to do.
pub fn output_error(error: &OutputError) -> CaseError {
    let help = match error {
        OutputError::Foreign { .. } => "choose another folder with -o DIR, or empty this one",
        _ => "check the free space and the permission to write; or choose another folder with -o DIR",
    };
    CaseError::new(error.to_string()).help(help)
}

fn read_scene(name: &str, text: &str, set: &[String]) -> Result<Scene, CaseError> {
    let (text, origins) = override_key::apply(name, text, set)?;
    let folder = Path::new(name).parent().unwrap_or(Path::new(""));
    Scene::parse(name, &text, folder).map_err(|error| origins.relocated(error))
}

fn execute_paths(problem: &Problem, folder: &Path, json: bool) -> u8 {
    let case = match PathCase::new(problem) {
        Ok(case) => case,
        Err(error) => return report(&error, json),
    };
    let replaced = Earlier::in_folder(folder);
    let mut bar = Bar::new(json);
    let result = paths::run(&case, folder, &mut bar);
    bar.finish();
    conclude(result, json.then_some(|summary| json!(summary)), |summary| {
        paths::sentences(summary).iter().for_each(|line| say!("{line}"));
        let picture = summary.first_picture.as_ref().map_or(String::new(), |picture| format!("open {picture}, "));
        say!(
            "\nResults in {}: {picture}bodies.pvd and the paths in ParaView; numbers in summary.json and a CSV per path.",
            folder.display()
        );
        say_replaced(replaced);
    })
}

/// The end of a command: its summary, or what went wrong.
fn conclude<S>(result: Result<S, SceneError>, json: Option<fn(&S) -> Value>, tell: impl FnOnce(&S)) -> u8 {
    match result {
        Err(SceneError::Case(error)) => report(&error, json.is_some()),
        Err(SceneError::Output(error)) => report(&output_error(&error), json.is_some()),
        Ok(summary) => {
            match json {
                Some(json) => say!("{}", json(&summary)),
                None => tell(&summary),
            }
            DONE
        }
    }
}

fn execute_scene(name: &str, text: &str, folder: &Path, set: &[String], json: bool) -> u8 {
    let scene = match read_scene(name, text, set) {
        Ok(scene) => scene,
        Err(error) => return report(&error, json),
    };
    let replaced = Earlier::in_folder(folder);
    let mut bar = Bar::new(json);
    let result = scene::run(&scene, folder, &mut bar);
    bar.finish();
    conclude(result, json.then_some(Value::clone), |summary| {
        say!("{}: {} frames", scene.title, summary["frames"]);
        for (kind, count) in summary["contact_pair_kinds"].as_object().into_iter().flatten() {
            say!("  {kind:18} the contact in {count} frames");
        }
        let closest = &summary["closest"];
        let text = |key: &str| closest["pair"][key].as_str().unwrap_or_default().to_string();
        say!("closest at t = {}: {} to {}, gap {}", closest["time"], text("a"), text("b"), closest["gap"]);
        say!(
            "\nResults in {}: open pictures/scene.png (animated) in a browser, bodies.pvd and pairs.pvd in ParaView; numbers in pairs.csv.",
            folder.display()
        );
        say_replaced(replaced);
    })
}

pub fn closest(queries: &Path, to: Option<&Path>, output: &Path, local_minima: bool, json: bool) -> u8 {
    let query = Query { local_minima, ..Query::default() };
    let counter = Counter::new(json);
    let progress = &mut |answered| counter.show(answered);
    let result = match to {
        Some(shape) => answer_points(queries, shape, output, &query, progress),
        None => answer_file(queries, output, &query, progress),
    };
    counter.finish();
    let report = match result {
        Ok(report) => report,
        Err(error) => {
            if json {
                say!("{}", json!({"error": error.to_string()}));
            } else {
                tell!("error: {error}");
            }
            return WRONG_INPUT;
        }
    };
    let seconds = report.elapsed.as_secs_f64();
    let slowest = report.slowest.as_ref().map(|(id, time)| (id.as_str(), time.as_secs_f64() * 1e3));
    if json {
        let summary = json!({
            "answered": report.answered,
            "wrong": report.wrong_count,
            "errors": report.wrong,
            "not_unique": report.not_unique,
            "not_certified": report.not_certified,
            "interrupted": counter.interrupted(),
            "seconds": seconds,
            "slowest": slowest.map(|(id, ms)| json!({"id": id, "milliseconds": ms})),
            "answers": output.display().to_string(),
        });
        say!("{summary}");
    } else {
        for error in &report.wrong {
            tell!("error: {error}");
        }
        if report.wrong_count > report.wrong.len() {
            tell!("error: {} more, each with its reason in the answers", report.wrong_count - report.wrong.len());
        }
        say!(
            "{} queries in {seconds:.2} s, {} of them wrong, {} not certified, {} not unique",
            report.answered,
            report.wrong_count,
            report.not_certified,
            report.not_unique
        );
        if let Some((id, ms)) = slowest {
            say!("slowest: {id}, {ms:.2} ms");
        }
        say!("answers: {}", output.display());
    }
    match (counter.interrupted(), report.wrong_count, report.not_certified) {
        (true, ..) => INTERRUPTED,
        (false, 0, 0) => DONE,
        (false, 0, _) => NOT_CONVERGED,
        _ => WRONG_INPUT,
    }
}

fn execute(name: &str, text: &str, folder: &Path, wanted: &Wanted, json: bool) -> u8 {
    let Wanted { set, resume: resumed, limits, .. } = wanted;
    let resumed = *resumed;
    if scene::is_scene(text) {
        if let Err(error) = processes::refuse("a scene") {
            return report(&error, json);
        }
        if resumed {
            let error =
                CaseError::new("a scene cannot be resumed").help("start it from the beginning, without --resume");
            return report(&error, json);
        }
        return execute_scene(name, text, folder, set, json);
    }
    let mut problem = match processes::all(signorini::case::read(name, text, set)) {
        Ok(problem) => problem,
        Err(error) => return report(&error, json),
    };
    problem.limits.max_time = limits.max_time.or(problem.limits.max_time);
    problem.limits.max_iterations = limits.max_iterations.or(problem.limits.max_iterations);
    if paths::is_of_paths(&problem) {
        if let Err(error) = processes::refuse("paths") {
            return report(&error, json);
        }
        if resumed {
            let error =
                CaseError::new("paths cannot be resumed").help("start them from the beginning, without --resume");
            return report(&error, json);
        }
        return execute_paths(&problem, folder, json);
    }
    let earlier = match resumed.then(|| begun(&problem, folder)).transpose() {
        Ok(earlier) => earlier,
        Err(error) => return report(&error, json),
    };
    match earlier {
        Some(Begun::Anew) => {
            tell!("note: the earlier run in {} stored no increment and starts again", folder.display())
        }
        Some(Begun::Done) => {
            tell!("note: the run in {} is complete; its results are unchanged", folder.display())
        }
        _ => {}
    }
    let replaced = if resumed { None } else { Earlier::in_folder(folder) };
    let mut bar = Bar::new(json || !processes::speaks());
    let result = if resumed { resume(&problem, folder, &mut bar) } else { run(&problem, folder, &mut bar) };
    bar.finish();
    match result {
        Err(RunError::Case(error)) => report(&error, json),
        Err(RunError::Output(error)) => {
            let code = report(&output_error(&error), json);
            // Others write nothing, and do not know.
            processes::abort(code);
            code
        }
        Ok(outcome) => {
            if json {
                say!("{}", json!(outcome.summary));
            } else {
                show(&outcome.summary);
                let first = outcome.summary.first_picture.map_or(String::new(), |file| format!("open {file} first, "));
                say!("\nResults in {}: {first}fields.pvd in ParaView; numbers in summary.json.", folder.display());
                say_replaced(replaced);
            }
            match outcome.ending {
                Ending::Converged => DONE,
                Ending::NotConverged => NOT_CONVERGED,
                Ending::Interrupted => INTERRUPTED,
            }
        }
    }
}

/// The increments as a table, the events and warnings, and the verdict.
fn show(summary: &Summary) {
    say!("{}\n", summary.case);
    say!("{}", table(summary));
    let resultants = resultants(summary);
    if !resultants.is_empty() {
        say!("{resultants}");
    }
    let unit = |of: fn(&UnitNames) -> &String| summary.units.as_ref().map_or("", |u| of(u));
    for event in &summary.events {
        let place = format!("{} {}", figures(&event.at, None), unit(|u| &u.length));
        let load = told(event.load_force, None, unit(|u| &u.force));
        say!("t = {:.6}, load {load}: {} at {}", event.time, event.kind.words(), place.trim_end());
    }
    for warning in &summary.warnings {
        say!("warning: {warning}");
    }
    if let Some(answer) = &summary.answer {
        say!("{}", answer.text);
    }
    if summary.answer.as_ref().is_none_or(|answer| answer.text != summary.verdict) {
        say!("{}", summary.verdict);
    }
}

pub fn read(case: &Path) -> Result<(String, String), CaseError> {
    if case == Path::new("-") {
        let text = std::io::read_to_string(std::io::stdin())
            .map_err(|e| CaseError::new(format!("cannot read standard input: {e}")))?;
        return Ok(("standard input".into(), text));
    }
    let name = case.display().to_string();
    match std::fs::read(case) {
        Ok(bytes) => match String::from_utf8(bytes) {
            Ok(text) => Ok((name, text)),
            Err(_) => Err(CaseError::new(format!("`{name}` is not a text file")).help("a case file is TOML in UTF-8")),
        },
        Err(error) => Err(CaseError::new(format!("cannot read `{name}`: {error}"))
            .help("signorini gallery show flat_disc > case.toml  gives a case to start from")),
    }
}

pub fn unknown_example(name: &str) -> CaseError {
    let names: Vec<&str> = all().map(|e| e.name).collect();
    CaseError::new(format!("the gallery has no case `{name}`")).help(signorini::problem::suggestion(name, &names))
}

pub fn report(error: &CaseError, json: bool) -> u8 {
    if json {
        let place = error.place.as_ref().map(|p| {
            let (line, column) = p.line_and_column();
            json!({"file": p.name, "line": line, "column": column})
        });
        say!("{}", json!({"error": error.message, "help": error.help, "place": place}));
    } else {
        tell!("{:?}", miette::Report::new(error.clone()));
    }
    WRONG_INPUT
}
