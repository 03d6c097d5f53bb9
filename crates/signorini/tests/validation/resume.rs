//! Runs that are stopped and go on: to the same digits.

use super::{example, set};
use serde_json::Value;
use signorini::case::Document;
use signorini::run::{Ending, RunError, resume, run};
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

fn results(summary: &Value) -> [&Value; 4] {
    ["steps", "events", "warnings", "verdict"].map(|key| &summary[key])
}

#[test]
fn a_resumed_run_gives_the_same_digits() {
    // A membrane on a wavy floor with events and divided cells; a sticky one with its jumps.
    let waves = [
        ("bodies.film.membrane.mesh.grid.cells", "[24, 24]".to_string()),
        ("steps", "[{ to = 0.1, increments = 2, events = 1e-2 }, { to = 0.4, increments = 3 }]".to_string()),
    ];
    for (name, pairs, stops) in [("cosine_disc", &waves[..], [9, 45]), ("snap_in", &[][..], [30, 170])] {
        let document = Document::parse("case.toml", example(name), &set(pairs)).expect("a case");
        let folder = tempfile::tempdir().expect("a folder");
        let whole = run(&document, &folder.path().join("whole"), &mut Silent).expect("a run").summary;
        for stop in stops {
            let path = folder.path().join("parts");
            let part = run(&document, &path, &mut Until(stop.into())).expect("a run");
            assert!(part.ending == Ending::Interrupted, "{name}, {stop}");
            let done = part.summary["steps"].as_array().map_or(0, Vec::len);
            // Stopped once more on the way, and then to the end.
            let _ = resume(&document, &path, &mut Until(12.into())).expect("a run");
            let rest = resume(&document, &path, &mut Silent).expect("a run").summary;
            assert_eq!(results(&rest), results(&whole), "{name} after {done} increments");
            // A run that is done has nothing to go on with.
            assert!(matches!(resume(&document, &path, &mut Silent), Err(RunError::Case(_))));
        }
    }
}

#[test]
fn what_cannot_be_resumed_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("out");
    let message = |document: &Document| match resume(document, &path, &mut Silent) {
        Err(RunError::Case(error)) => error.message,
        _ => panic!("resumed"),
    };
    let parse =
        |pairs: &[(&str, String)]| Document::parse("case.toml", example("snap_in"), &set(pairs)).expect("a case");
    let case = parse(&[]);
    assert!(message(&case).contains("no run to go on with"));
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
    let solid = Document::parse("case.toml", example("hertz"), &[]).expect("a case");
    assert!(message(&solid).contains("solids"));
}
