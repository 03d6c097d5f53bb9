//! The driver on the smallest model there is: a spring that is pressed on a wall.

use serde_json::{Value, json};
use signorini::fields::ShownState;
use signorini::output::{Folder, OutputError};
use signorini::plan::Head;
use signorini::problem::CaseError;
use signorini::report::{ContactReport, Reason, StepReport};
use signorini::testing::{Advanced, Ending, Model, Record, begin, drive, go_on, of_earlier_run};
use signorini_audit::{Check, Finding, Verdict};
use signorini_solve::{Iteration, Progress, Silent};
use std::path::Path;
use std::time::Instant;

/// A spring of stiffness two whose end is pushed by the time; a wall stands at 0.3.
struct Spring {
    head: Head,
    force: f64,
    /// The increment in which it fails, and the one whose state is no answer.
    fails_in: Option<usize>,
    refused_in: Option<usize>,
}

impl Spring {
    fn new(fails_in: Option<usize>) -> Self {
        let problem = signorini::case::read("spring.toml", signorini::gallery::GALLERY[0].case, &[]).expect("a case");
        let head = Head {
            size: None,
            problem,
            units: None,
            interpreted: Vec::new(),
            warnings: Vec::new(),
            every: 2,
            pictures: true,
        };
        Spring { head, force: 0.0, fails_in, refused_in: None }
    }
}

impl Model for Spring {
    fn head(&self) -> &Head {
        &self.head
    }
    fn increments(&self) -> usize {
        4
    }
    fn time(&self, index: usize) -> f64 {
        0.25 * (index + 1) as f64
    }
    fn advance(
        &mut self,
        index: usize,
        record: &mut Record,
        progress: &mut dyn Progress,
    ) -> Result<Advanced, CaseError> {
        progress.iteration(&Iteration {
            step: index,
            time: self.time(index),
            iteration: 0,
            residual: 0.0,
            action: "pressed",
            figures: &[],
        });
        if progress.interrupted() {
            return Ok(Advanced::Failed(Reason::Interrupted));
        }
        if self.fails_in == Some(index) {
            return Ok(Advanced::Failed(Reason::Newton));
        }
        // From the state before, as other models do.
        let pressed = (self.time(index) - 0.3).max(0.0);
        let step = if index == 0 { pressed } else { pressed - (self.time(index - 1) - 0.3).max(0.0) };
        self.force += 2.0 * step;
        let contact = ContactReport { force: [self.force, 0.0, 0.0], zones: 1, ..ContactReport::default() };
        record.steps.push(StepReport {
            index,
            time: self.time(index),
            converged: true,
            iterations: 1,
            contacts: [("wall".to_string(), contact)].into(),
            ..StepReport::default()
        });
        Ok(Advanced::State)
    }
    fn audit(&mut self, step: &StepReport) -> Vec<Finding> {
        let outcome = if self.refused_in == Some(step.index) {
            signorini_audit::Outcome::Refused
        } else {
            signorini_audit::Outcome::Fine
        };
        vec![Finding::new(Check::Balance, outcome, "the spring pulls").remedy("push it")]
    }
    fn write_fields(&mut self, index: usize, record: &mut Record) -> Result<(), OutputError> {
        record.add_frame(self.time(index), format!("{index:05}"), &[])
    }
    fn shown(&self) -> Option<ShownState> {
        Some(ShownState { time: self.force, bodies: Vec::new(), contacts: Vec::new() })
    }
    fn draw(&self, record: &Record) -> Result<(), OutputError> {
        record.folder.write("pictures/spring.svg", b"<svg/>")
    }
    fn first_picture(&self) -> Option<String> {
        Some("pictures/spring.svg".into())
    }
    fn verdict(&self, _: &Record, _: Reason) -> String {
        format!("The spring presses with {}.", self.force)
    }
    fn method(&self) -> String {
        "by hand".into()
    }
    fn save(&self, _: &Folder, _: usize) -> Result<Option<Value>, OutputError> {
        Ok(Some(json!(self.force)))
    }
    fn restore(&mut self, state: Value, _: &Path, _: usize) -> Result<(), String> {
        self.force = state.as_f64().ok_or("no number")?;
        Ok(())
    }
}

#[test]
fn a_model_runs_fails_goes_on_draws_and_reports() {
    let folder = tempfile::tempdir().expect("a folder");
    let spring = Spring::new(None);
    let head = spring.head();
    let start = std::time::Instant::now();
    let whole = folder.path().join("whole");
    let outcome = drive(&mut Spring::new(None), begin(head, &whole).expect("a folder"), 0, start, &mut Silent);
    let whole = outcome.expect("a run");
    assert!(whole.ending == Ending::Converged && whole.summary.steps.len() == 4);
    assert!((whole.summary.steps[3].contacts["wall"].force[0] - 1.4).abs() < 1e-15);
    // It fails in the third increment, and goes on from there.
    let path = folder.path().join("parts");
    let mut failing = Spring::new(Some(2));
    let failed = drive(&mut failing, begin(head, &path).expect("a folder"), 0, start, &mut Silent).expect("a run");
    assert!(failed.ending == Ending::NotConverged && failed.summary.reason == Reason::Newton);
    assert_eq!(failed.summary.steps, whole.summary.steps[..2]);
    let rest = go_on(&mut Spring::new(None), of_earlier_run(head, &path), &path, start, &mut Silent).expect("a run");
    assert_eq!(rest.summary.steps, whole.summary.steps);
    assert_eq!(rest.summary.verdict, whole.summary.verdict);
    let read = |name: &str| std::fs::read_to_string(path.join(name)).expect(name);
    assert!(read("history.csv").contains("wall:force_x") && read("pictures/spring.svg").contains("svg"));
    assert_eq!(read("fields.pvd").matches("<DataSet").count(), 2);
    assert!(!path.join("checkpoint.json").exists());
    // There is nothing to go on with any more.
    assert!(go_on(&mut Spring::new(None), of_earlier_run(head, &path), &path, start, &mut Silent).is_err());
}

/// A run that reaches its limit keeps what it has, says so, and goes on from there.
#[test]
fn a_run_stops_at_its_limit() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("limited");
    let start = Instant::now();
    let mut spring = Spring::new(None);
    spring.head.problem.limits.max_iterations = Some(3);
    let record = begin(spring.head(), &path).expect("a folder");
    let stopped = drive(&mut spring, record, 0, start, &mut Silent).expect("a run");
    assert!(stopped.ending == Ending::NotConverged && stopped.summary.reason == Reason::LimitReached);
    assert_eq!(stopped.summary.steps.len(), 2);
    let verdict = &stopped.summary.verdict;
    assert!(verdict.contains("limit of 3 iterations: 2 of 4 increments") && verdict.contains("t = 0.75"), "{verdict}");
    let mut rest = Spring::new(None);
    let record = of_earlier_run(rest.head(), &path);
    let rest = go_on(&mut rest, record, &path, start, &mut Silent).expect("a run");
    assert!(rest.ending == Ending::Converged && rest.summary.steps.len() == 4);
    // A time that is over at once.
    let mut late = Spring::new(None);
    late.head.problem.limits.max_time = Some(f64::MIN_POSITIVE);
    let record = begin(late.head(), &folder.path().join("late")).expect("a folder");
    let stopped = drive(&mut late, record, 0, start, &mut Silent).expect("a run");
    assert!(stopped.summary.reason == Reason::LimitReached && stopped.summary.steps.is_empty());
}

#[test]
fn a_state_that_is_no_answer_ends_the_run_and_stays() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("refused");
    let mut spring = Spring { refused_in: Some(2), ..Spring::new(None) };
    let record = begin(spring.head(), &path).expect("a folder");
    let run = drive(&mut spring, record, 0, std::time::Instant::now(), &mut Silent).expect("a run");
    assert!(run.ending == Ending::NotConverged && run.summary.reason == Reason::Refused && !run.summary.converged);
    assert_eq!(run.summary.steps.iter().map(|s| s.reason.is_converged()).collect::<Vec<_>>(), [true, true, false]);
    assert_eq!(run.summary.verdict, "Not an answer: the spring pulls at t = 0.75 (push it).");
    assert_eq!(run.summary.answer.map(|a| a.verdict), Some(Verdict::NotAnAnswer));
    assert!(std::fs::read_to_string(path.join("fields.pvd")).expect("fields").contains("fields_00002"));
}
