//! Sweeps: what is varied, and tables that do not depend on how the runs were made.

use super::example;
use signorini::problem::CaseError;
use signorini::sweep::{
    Counted, Keep, Manifest, Record, Sample, Setting, Status, SweepError, SweepFolder, Variation, Wanted, Watch,
    gather, run_missing, run_row, script,
};
use signorini_solve::Silent;
use std::path::Path;
use std::sync::atomic::{AtomicUsize, Ordering};

/// Stops a sweep after so many runs.
struct After(AtomicUsize);

impl Watch for After {
    fn ended(&self, _: usize, _: &Record) {
        self.0.fetch_sub(1, Ordering::SeqCst);
    }
    fn interrupted(&self) -> bool {
        self.0.load(Ordering::SeqCst) == 0
    }
}

fn wanted(vary: &[&str]) -> Wanted {
    Wanted {
        name: "string.toml".into(),
        text: example("string").into(),
        set: vec!["output.pictures=false".into()],
        vary: vary.iter().map(|v| Variation::parse(v).expect("a variation")).collect(),
        ..Wanted::default()
    }
}

fn values(vary: &[&str], sample: Option<Sample>) -> Vec<Vec<Setting>> {
    Manifest::new(&Wanted { sample, ..wanted(vary) }).expect("a sweep").rows
}

fn numbers(text: &str) -> Vec<f64> {
    let list = Variation::parse(text).and_then(|v| v.grid()).expect("values");
    let number = |v: &Setting| if let Setting::Number(v) = v { *v } else { panic!("{v:?} is no number") };
    list.iter().map(number).collect()
}

/// A sweep in a folder, of so many runs in this call; its table.
fn swept(manifest: &Manifest, path: &Path, most: usize, jobs: usize) -> (Counted, String) {
    let folder = SweepFolder::new(path);
    let (manifest, _) = manifest.clone().enter(&folder, false).expect("a folder");
    let counted = run_missing(&folder, &manifest, (jobs, 1), &After(most.into())).expect("runs");
    (counted, gather(&folder, &manifest).expect("a table").to_csv())
}

fn told(error: SweepError) -> (String, String) {
    match error {
        SweepError::Case(error) => (error.message, error.help.unwrap_or_default()),
        SweepError::Output(error) => (error.to_string(), String::new()),
    }
}

#[test]
fn values_are_ranges_or_lists() {
    assert_eq!(numbers("a.b=0:1:5"), [0.0, 0.25, 0.5, 0.75, 1.0]);
    // Without the digits of rounding.
    assert_eq!(numbers("a.b=0.1:0.5:5"), [0.1, 0.2, 0.3, 0.4, 0.5]);
    assert_eq!(numbers("a.b=1:1000:4:log"), [1.0, 10.0, 100.0, 1000.0]);
    assert_eq!(numbers("a.b=-1:-100:3:log"), [-1.0, -10.0, -100.0]);
    assert_eq!(numbers("a.b=3:9:1"), [3.0]);
    assert_eq!(numbers("a.b = 2, 1 ,-4e-3"), [2.0, 1.0, -4e-3]);
    let with_unit = Variation::parse("a=1:3 mm:3").expect("a range");
    assert_eq!((with_unit.unit.as_str(), with_unit.at(0.5).written("mm")), ("mm", "2 mm".to_string()));
    assert_eq!(with_unit.title(), "a [mm]");
    assert_eq!(Variation::parse("a=1 mm, 2 mm").expect("a list").unit, "mm");
    // Quotes and brackets hold values together; names of sides are no ranges.
    for (text, count) in [
        ("a=[1,2],[3,4]", 2),
        ("a=-min(t,1)", 1),
        ("a=film:rim,film:boundary", 2),
        ("a={mortar={}},{node={}}", 2),
        ("a=\"x,y\",z", 2),
        ("a=1 mm,2 m", 2),
        ("a=0.1*t,0.2*t", 2),
    ] {
        let list = Variation::parse(text).and_then(|v| v.grid()).expect("values");
        assert_eq!(list.len(), count, "{text}");
        assert!(list.iter().all(|v| matches!(v, Setting::Text(_))), "{text}");
    }
}

#[test]
fn wrong_variations_are_told_before_anything_runs() {
    let error = |text: &str| -> CaseError {
        let parsed = Variation::parse(text).and_then(|v| Manifest::new(&Wanted { vary: vec![v], ..wanted(&[]) }));
        parsed.err().unwrap_or_else(|| panic!("{text} is accepted"))
    };
    let tension = "bodies.film.membrane.tension";
    for (text, message) in [
        (format!("{tension}=1:2:0"), "0 is no number of values"),
        (format!("{tension}=1:nan:3"), "`nan` is not a finite number"),
        (format!("{tension}=1:inf:3"), "`inf` is not a finite number"),
        (format!("{tension}=1,NaN"), "`NaN` is not a finite number"),
        (format!("{tension}=1:2:x"), "`x` is not a number of values"),
        (format!("{tension}=1:2:3:lin"), "`lin` is not `log`"),
        (format!("{tension}=-1:2:3:log"), "meets zero"),
        (format!("{tension}=1 mm:2 m:3"), "are two units"),
        (format!("{tension}=1:2"), "needs the number of values"),
        (format!("{tension}=1,,2"), "an empty value"),
        (format!("{tension}="), "has no values"),
        (tension.to_string(), "contains no `=`"),
        ("=1:2:3".into(), "is not a key"),
        ("bodies.film.membrane.tensoin=1:2:3".into(), "tensoin"),
        ("bodies.flim.membrane.tension=1:2:3".into(), "there is no body `flim`"),
        ("bodies.film.membrane.degree=a,b".into(), ""),
    ] {
        let error = error(&text);
        assert!(error.message.contains(message), "{text}: {}", error.message);
        assert!(error.help.is_some(), "{text}: {}", error.message);
    }
    let place = error("bodies.film.membrane.tensoin=1:2:3").place.expect("a place");
    assert_eq!(place.name, "--vary");
    let many = Manifest::new(&wanted(&["steps.0.to=1:2:1000000000000"])).expect_err("more runs than can be");
    assert!(many.message.contains("more than 1000000 runs"), "{}", many.message);
    let twice = Manifest::new(&wanted(&["steps.0.to=1", "steps.0.to=2"])).expect_err("a key varied twice");
    assert!(twice.message.contains("varied twice"));
}

#[test]
fn a_grid_has_all_combinations() {
    let rows = values(&["bodies.film.membrane.tension=1:3:3", "bodies.film.membrane.degree=2,4"], None);
    let pairs: Vec<String> = rows.iter().map(|r| format!("{} {}", r[0].written(""), r[1].written(""))).collect();
    assert_eq!(pairs, ["1 2", "1 4", "2 2", "2 4", "3 2", "3 4"]);
}

#[test]
fn a_latin_hypercube_meets_every_stratum_once() {
    let vary = ["bodies.film.membrane.tension=1:3", "loads.press.normal=-1:-100:log"];
    for (count, seed) in [(1, 0), (2, 1), (7, 2), (40, 3), (100, u64::MAX)] {
        let sample = Some(Sample { count, seed });
        let rows = values(&vary, sample);
        assert_eq!(rows, values(&vary, sample));
        for k in 0..2 {
            let stratum = |row: &Vec<Setting>| {
                let Setting::Number(v) = row[k] else { panic!("no number") };
                let share = if k == 0 { (v - 1.0) / 2.0 } else { v.abs().log10() / 2.0 };
                (share * count as f64) as usize
            };
            let met: Vec<usize> = rows.iter().map(stratum).collect();
            let mut sorted = met.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..count).collect::<Vec<_>>());
            // Not in their order, and another seed gives other rows.
            assert!(count < 7 || met != sorted);
        }
        assert!(rows != values(&vary, Some(Sample { count, seed: seed ^ 9 })));
    }
}

#[test]
fn a_sweep_in_parts_gives_the_table_of_one_go() {
    let folder = tempfile::tempdir().expect("a folder");
    // One of them has no tension.
    let manifest = Manifest::new(&wanted(&["bodies.film.membrane.tension=-1,0.5,1,1.5", "loads.press.normal=-1,-0.5"]));
    let manifest = manifest.expect("a sweep");
    let (counted, whole) = swept(&manifest, &folder.path().join("whole"), 100, 1);
    assert_eq!(counted, Counted { ended: 8, failed: 2, interrupted: false });
    let parts = folder.path().join("parts");
    let (counted, part) = swept(&manifest, &parts, 3, 1);
    assert_eq!((counted.ended, counted.interrupted), (3, true));
    assert_eq!(part.matches(",missing,").count(), 5);
    // Killed in the middle of a run.
    std::fs::create_dir_all(parts.join("runs/0005")).expect("a folder");
    std::fs::write(parts.join("runs/0005/log.jsonl.part"), "{").expect("a file");
    let (counted, resumed) = swept(&manifest, &parts, 100, 2);
    assert_eq!(counted.ended, 5);
    assert_eq!(resumed, whole);
    assert_eq!(swept(&manifest, &folder.path().join("two"), 100, 2).1, whole);
    let mut lines = whole.lines();
    let header = lines.next().expect("a header");
    assert!(header.starts_with(
        "run,bodies.film.membrane.tension,loads.press.normal,status,reason,time,iterations,contacts.touch.force.x"
    ));
    assert!(header.ends_with(",message"));
    let first = lines.next().expect("a row");
    assert!(first.starts_with("1,-1,-1,failed,input,,,"), "{first}");
    assert!(first.contains("tension"), "{first}");
    assert!(lines.next().is_some_and(|line| line.starts_with("2,-1,-0.5,failed,input")));
    assert!(lines.next().is_some_and(|line| line.starts_with("3,0.5,-1,done,converged,0,")));
    assert!(parts.join("sweep.png").is_file() && parts.join("runs/0003/summary.json").is_file());
    // Row by row, as tasks of a scheduler, with summaries alone.
    let tasks = SweepFolder::new(&folder.path().join("tasks"));
    let manifest = Manifest { keep: Keep::Summary, ..manifest };
    manifest.clone().enter(&tasks, false).expect("a folder");
    let read = Manifest::read(&tasks).expect("a manifest");
    assert_eq!(read, manifest);
    for index in (0..8).rev() {
        run_row(&tasks, &read, index, &mut Silent).expect("a run");
    }
    assert_eq!(gather(&tasks, &read).expect("a table").to_csv(), whole);
    let kept: Vec<_> =
        std::fs::read_dir(tasks.run_folder(2)).expect("a folder").flatten().map(|e| e.file_name()).collect();
    assert_eq!(kept, ["summary.json"]);
}

#[test]
fn another_sweep_does_not_take_a_folder() {
    let folder = tempfile::tempdir().expect("a folder");
    let sweeps = SweepFolder::new(&folder.path().join("out"));
    let first = Manifest::new(&wanted(&["loads.press.normal=-1,-0.5"])).expect("a sweep");
    first.clone().enter(&sweeps, false).expect("a folder");
    assert!(first.clone().enter(&sweeps, false).is_ok_and(|(_, resumed)| resumed));
    let other = |change: Wanted| Manifest::new(&change).expect("a sweep");
    for (manifest, what) in [
        (other(wanted(&["loads.press.normal=-1,-0.4"])), "other variations"),
        (
            other(Wanted { text: format!("{}\n", example("string")), ..wanted(&["loads.press.normal=-1,-0.5"]) }),
            "another case",
        ),
        (other(Wanted { set: Vec::new(), ..wanted(&["loads.press.normal=-1,-0.5"]) }), "other settings"),
        (other(Wanted { keep: Keep::Summary, ..wanted(&["loads.press.normal=-1,-0.5"]) }), "--keep"),
    ] {
        let (message, help) = told(manifest.clone().enter(&sweeps, false).expect_err("another sweep"));
        assert!(message.contains(what) && help.contains("--restart"), "{message}: {help}");
    }
    assert!(other(wanted(&["loads.press.normal=-1,-0.4"])).enter(&sweeps, true).is_ok_and(|(_, resumed)| !resumed));
    let held = sweeps.lock(true).expect("a lock");
    assert!(held.is_none() || sweeps.lock(true).is_err());
    // A folder of something else stays as it is.
    let foreign = folder.path().join("foreign");
    std::fs::create_dir(&foreign).expect("a folder");
    std::fs::write(foreign.join("thesis.txt"), "mine").expect("a file");
    let (message, _) = told(first.clone().enter(&SweepFolder::new(&foreign), true).expect_err("a foreign folder"));
    assert!(message.contains("thesis.txt"), "{message}");
    assert!(foreign.join("thesis.txt").is_file());
}

#[test]
fn columns_are_chosen_by_paths() {
    let folder = tempfile::tempdir().expect("a folder");
    let collect =
        ["contacts.*.area", "steps.-1.energy", "contacts.touch.force.z", "verdict"].map(String::from).to_vec();
    let manifest = Manifest::new(&Wanted { collect, keep: Keep::Summary, ..wanted(&["loads.press.normal=-1,-0.5"]) });
    let manifest = manifest.expect("a sweep");
    let (_, csv) = swept(&manifest, &folder.path().join("out"), 100, 1);
    let header = csv.lines().next().expect("a header");
    assert!(
        header.ends_with("iterations,contacts.touch.area,steps.-1.energy,contacts.touch.force.z,verdict,message"),
        "{header}"
    );
    let row: Vec<&str> = csv.lines().nth(1).expect("a row").split(',').collect();
    // The exact length is 2 (1 - sqrt(0.2)).
    let area: f64 = row[6].parse().expect("a number");
    assert!((area - 2.0 * (1.0 - 0.2f64.sqrt())).abs() < 1e-9, "{area}");
    let wrong = Manifest::new(&Wanted { collect: vec!["contatcs.touch.area".into()], ..wanted(&["steps.0.to=1"]) });
    let error = wrong.expect_err("a wrong path");
    assert!(error.help.is_some_and(|help| help.contains("contacts")), "{}", error.message);
}

#[test]
fn a_script_runs_one_row_a_task_or_several() {
    let manifest = Manifest::new(&wanted(&["bodies.film.membrane.tension=1:2:12"])).expect("a sweep");
    let text = script(Path::new("it's"), &manifest);
    assert!(text.contains("#SBATCH --array=1-12\n") && text.contains("--task \"$SLURM_ARRAY_TASK_ID\""), "{text}");
    assert!(text.contains("it'\\''s"), "{text}");
    let rows = manifest.rows.iter().cycle().take(2500).cloned().collect();
    let text = script(Path::new("out"), &Manifest { rows, ..manifest });
    assert!(
        text.contains("#SBATCH --array=1-834\n") && text.contains("* 3 + 1") && text.contains("-gt 2500"),
        "{text}"
    );
}

#[test]
fn failed_runs_are_failed_rows() {
    let folder = tempfile::tempdir().expect("a folder");
    let manifest = Manifest::new(&wanted(&["limits.max_iterations=1,100"])).expect("a sweep");
    let (counted, csv) = swept(&manifest, &folder.path().join("out"), 100, 1);
    assert_eq!(counted.failed, 1, "{csv}");
    assert!(csv.contains("1,1,failed,limit_reached,"), "{csv}");
    let record = SweepFolder::new(&folder.path().join("out")).record(0).expect("a record").expect("a run");
    assert_eq!(record.status, Status::Failed);
}
