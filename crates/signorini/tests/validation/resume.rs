//! Runs that are stopped and go on: to the same digits.

use super::{example, set};
use serde_json::{Value, json};
use signorini::problem::Problem;
use signorini::report::Summary;
use signorini::run::{Begun, Ending, RunError, begun, resume, run};
use signorini_solve::{Iteration, Progress, Silent};

/// Stops a run after so many iterations.
struct Until(std::cell::Cell<usize>);

impl Progress for Until {
    fn step(&mut self, _: usize, _: usize, _: f64) {}
    fn iteration(&mut self, _: &Iteration) {
        self.0.set(self.0.get().saturating_sub(1));
    }
    fn interrupted(&self) -> bool {
        self.0.get() == 0
    }
}

/// Stops a run in its increment of that number.
struct UntilIncrement(usize);

impl Progress for UntilIncrement {
    fn step(&mut self, index: usize, _: usize, _: f64) {
        self.0 = if index >= self.0 { 0 } else { self.0 };
    }
    fn iteration(&mut self, _: &Iteration) {}
    fn interrupted(&self) -> bool {
        self.0 == 0
    }
}

/// All that must not depend on where a run was stopped.
fn results(summary: &Summary) -> Value {
    json!([summary.steps, summary.events, summary.warnings, summary.verdict])
}

#[test]
fn a_resumed_run_gives_the_same_digits() {
    // A membrane on a wavy floor with events and divided cells; a sticky one with its jumps.
    let waves = [
        ("bodies.film.membrane.mesh.grid.cells", "[24, 24]".to_string()),
        ("steps", "[{ to = 0.1, increments = 2, events = 1e-2 }, { to = 0.4, increments = 3 }]".to_string()),
    ];
    for (name, pairs, stops) in [("cosine_disc", &waves[..], [9, 45]), ("snap_in", &[][..], [30, 170])] {
        let problem = signorini::case::read("case.toml", example(name), &set(pairs)).expect("a case");
        let folder = tempfile::tempdir().expect("a folder");
        let whole = run(&problem, &folder.path().join("whole"), &mut Silent).expect("a run").summary;
        for stop in stops {
            let path = folder.path().join("parts");
            let part = run(&problem, &path, &mut Until(stop.into())).expect("a run");
            assert!(part.ending == Ending::Interrupted, "{name}, {stop}");
            let done = part.summary.steps.len();
            // Stopped once more on the way, and then to the end.
            let _ = resume(&problem, &path, &mut Until(12.into())).expect("a run");
            let rest = resume(&problem, &path, &mut Silent).expect("a run").summary;
            assert_eq!(results(&rest), results(&whole), "{name} after {done} increments");
            // A run that is done is left as it is.
            assert_eq!(begun(&problem, &path).expect("a run"), Begun::Done);
            let done = resume(&problem, &path, &mut Until(0.into())).expect("a run");
            assert_eq!((done.ending, done.summary), (Ending::Converged, rest));
        }
    }
}

#[test]
fn what_cannot_be_resumed_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("out");
    let message = |problem: &Problem| match resume(problem, &path, &mut Silent) {
        Err(RunError::Case(error)) => error.message,
        _ => panic!("resumed"),
    };
    let parse =
        |pairs: &[(&str, String)]| signorini::case::read("case.toml", example("snap_in"), &set(pairs)).expect("a case");
    let case = parse(&[]);
    assert!(message(&case).contains("no run to continue"));
    // Stopped before its first increment was kept it begins anew.
    run(&case, &path, &mut Until(1.into())).expect("a run");
    assert_eq!(begun(&case, &path).expect("a run"), Begun::Anew);
    let begun_anew = resume(&case, &path, &mut Until(1.into())).expect("a run");
    assert!(begun_anew.ending == Ending::Interrupted);
    assert!(message(&parse(&[("contacts.touch.adhesion.energy", "0.06".into())])).contains("another case"));
    run(&case, &path, &mut Until(40.into())).expect("a run");
    assert!(message(&parse(&[("contacts.touch.adhesion.energy", "0.06".into())])).contains("another case"));
    let checkpoint = path.join("checkpoint.json");
    let text = std::fs::read_to_string(&checkpoint).expect("a checkpoint");
    for damaged in [
        &text[..text.len() / 2],
        "",
        "{}",
        &text.replace("\"next\"", "\"text\""),
        &text.replace("\"zone\"", "\"zona\""),
    ] {
        std::fs::write(&checkpoint, damaged).expect("written");
        assert!(message(&case).contains("checkpoint.json"), "{}", message(&case));
    }
    std::fs::write(&checkpoint, &text).expect("written");
    assert!(resume(&case, &path, &mut Silent).is_ok());
}

/// Solids: small sliding between two bodies and with a free one, a rigid body that moves, finite sliding, between two bodies
/// and with a rigid one.
#[test]
fn solids_go_on_to_the_same_digits() {
    let more = |n: usize| ("steps", format!("[{{ to = 1, increments = {n} }}]"));
    let small = ("contacts.touch.sliding", "\"small\"".to_string());
    let coarse = ("bodies.block.solid.mesh.box.cells", "[6, 6, 3]".to_string());
    let cases: [(&str, Vec<(&str, String)>); 5] = [
        ("high_order_blocks", vec![]),
        ("cylinder_on_block", vec![more(3)]),
        ("die", vec![coarse.clone()]),
        ("die", vec![coarse, small]),
        ("ironing", vec![("steps", "[{ to = 1, increments = 2 }, { to = 1.2, increments = 2 }]".to_string())]),
    ];
    for (name, pairs) in cases {
        let folder = tempfile::tempdir().expect("a folder");
        let case = format!("{}/../../gallery/{name}/case.toml", env!("CARGO_MANIFEST_DIR"));
        let problem = signorini::case::read(&case, example(name), &set(&pairs)).expect("a case");
        let whole = run(&problem, &folder.path().join("whole"), &mut Silent).expect("a run").summary;
        assert!(whole.converged, "{name}");
        let increments = whole.steps.len();
        let path = folder.path().join("parts");
        // Stopped at every increment, and once more on the way.
        for stop in 1..increments {
            let part = run(&problem, &path, &mut UntilIncrement(stop)).expect("a run");
            assert!(part.ending == Ending::Interrupted, "{name}, {stop}");
            let _ = resume(&problem, &path, &mut UntilIncrement(increments - 1)).expect("a run");
            let rest = resume(&problem, &path, &mut Silent).expect("a run").summary;
            assert_eq!(results(&rest), results(&whole), "{name} after {stop} increments");
            for file in ["history.csv", "fields.pvd"] {
                let [a, b] = ["whole", "parts"].map(|part| std::fs::read(folder.path().join(part).join(file)).unwrap());
                assert!(a == b, "{name}: {file} after {stop} increments");
            }
            assert!(!path.join("checkpoint.json").exists());
        }
    }
}

#[test]
fn a_damaged_checkpoint_of_solids_is_told() {
    let problem = signorini::case::read("case.toml", example("high_order_blocks"), &[]).expect("a case");
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("out");
    run(&problem, &path, &mut UntilIncrement(2)).expect("a run");
    let checkpoint = path.join("checkpoint.json");
    let text = std::fs::read_to_string(&checkpoint).expect("a checkpoint");
    for (from, to) in [("\"next\":2", "\"next\":9"), ("\"contacts\":[[[", "\"contacts\":[[[77777,")] {
        assert!(text.contains(from), "{from}");
        std::fs::write(&checkpoint, text.replacen(from, to, 1)).expect("written");
        match resume(&problem, &path, &mut Silent) {
            Err(RunError::Case(error)) => assert!(error.message.contains("damaged"), "{}", error.message),
            _ => panic!("resumed with {to}"),
        }
    }
}
