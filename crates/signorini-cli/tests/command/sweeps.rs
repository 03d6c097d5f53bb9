//! The command `sweep` as a user meets it.

use super::runs::{example, signorini, text};
use serde_json::Value;

const VARY: &str = "bodies.film.membrane.tension=-1,1,2";

#[test]
fn a_sweep_leaves_table_picture_and_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("case.toml"), example("string")).expect("a file");
    let set = ["--set", "output.pictures=false"];
    let begin = |more: &[&str]| {
        let mut command = signorini(folder.path());
        command.args(["sweep", "case.toml", "-o", "out", "--vary", VARY]).args(set).args(more);
        command.output().expect("a sweep")
    };
    // A plan, one of its rows as a task, the rest here: one of them fails.
    let planned = begin(&["--plan"]);
    assert_eq!(planned.status.code(), Some(0), "{}", text(&planned.stderr));
    let script = std::fs::read_to_string(folder.path().join("out/sweep.slurm")).expect("a script");
    assert!(script.contains("--array=1-3"), "{script}");
    let task = signorini(folder.path()).args(["sweep", "out", "--task", "2"]).output().expect("a task");
    assert_eq!(task.status.code(), Some(0), "{}", text(&task.stderr));
    let part = signorini(folder.path()).args(["sweep", "out", "--gather", "--json"]).output().expect("a table");
    assert_eq!(part.status.code(), Some(2));
    let part: Value = serde_json::from_slice(&part.stdout).expect("JSON");
    assert_eq!((&part["missing"], &part["rows"][1]["status"]), (&2.into(), &"done".into()));
    let rest = begin(&["-j", "2"]);
    assert_eq!(rest.status.code(), Some(2), "{}", text(&rest.stderr));
    assert!(text(&rest.stdout).contains("3 runs: 2 done, 1 failed"), "{}", text(&rest.stdout));
    assert!(text(&rest.stderr).contains("1 of 3 runs have ended before"), "{}", text(&rest.stderr));
    for file in ["sweep.csv", "sweep.png", "sweep.svg", "runs/0003/summary.json", "runs/0003/history.csv"] {
        assert!(folder.path().join("out").join(file).is_file(), "{file}");
    }
    // Nothing is run again; another choice of columns is.
    let again = signorini(folder.path()).args(["sweep", "out", "--collect", "contacts.touch.area,energy"]).output();
    assert_eq!(again.expect("a table").status.code(), Some(2));
    let csv = std::fs::read_to_string(folder.path().join("out/sweep.csv")).expect("a table");
    assert!(csv.starts_with(
        "run,bodies.film.membrane.tension,status,reason,time,iterations,contacts.touch.area,energy,message\n"
    ));
    let task = signorini(folder.path()).args(["sweep", "out", "--task", "4"]).output().expect("a task");
    assert_eq!(task.status.code(), Some(1));
}

#[test]
fn wrong_sweeps_are_told_with_help() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("case.toml"), example("string")).expect("a file");
    for (arguments, message) in [
        (&["case.toml", "--vary", "loads.press.normal=1:2:0"][..], "0 is no number of values"),
        (&["case.toml", "--vary", "loads.pres.normal=1:2:2"], "did you mean `press`"),
        (&["case.toml"], "nothing is varied"),
        (&["nothing.toml", "--vary", "a=1"], "cannot read"),
        (&["case.toml", "--vary", "loads.press.normal=1,2", "--collect", "areas"], "a summary has no `areas`"),
        (&[".", "--vary", "loads.press.normal=1,2"], "states already what is varied"),
        (&["."], "there is no sweep"),
        (&["case.toml", "--vary", "loads.press.normal=1:2", "--sample", "0"], "a sample of 0 runs"),
    ] {
        let output = signorini(folder.path()).arg("sweep").args(arguments).output().expect("a sweep");
        let told = text(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{arguments:?}: {told}");
        assert!(told.contains(message) && told.contains("help"), "{arguments:?}: {told}");
    }
    assert!(!folder.path().join("case.sweep").exists());
}
