//! The command as a user meets it: files, messages, exit status.

use assert_cmd::Command;
use serde_json::Value;
use std::path::Path;

pub fn signorini(folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_signorini"));
    command.current_dir(folder).env("NO_COLOR", "1");
    command
}

pub fn example(name: &str) -> String {
    let path = format!("{}/../../gallery/{name}/case.toml", env!("CARGO_MANIFEST_DIR"));
    std::fs::read_to_string(path).expect("a gallery case")
}

pub fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

#[test]
fn a_run_leaves_everything_it_promises() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = signorini(folder.path()).args(["gallery", "run", "string"]).output().expect("a run");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("In contact over length 1.1055728"));
    let out = folder.path().join("string");
    for file in [
        "summary.json",
        "fields.pvd",
        "contact.pvd",
        "history.csv",
        "log.jsonl",
        "case.toml",
        "fields/fields_00000.vtu",
        "contact/contact_00000.vtp",
        "contact/outlines_00000.csv",
        "pictures/deflection.png",
        "pictures/deflection.svg",
        "pictures/gap_and_pressure.png",
        "pictures/convergence.png",
    ] {
        assert!(out.join(file).is_file(), "{file}");
    }
    let summary = std::fs::read_to_string(out.join("summary.json")).expect("a summary");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    assert_eq!(summary["converged"], true);
    // A second run takes the place of the first, and says so.
    assert!(!text(&output.stdout).contains("They replace"));
    let again = signorini(folder.path()).args(["gallery", "run", "string"]).output().expect("a run");
    assert_eq!(again.status.code(), Some(0));
    let title = summary["case"].as_str().expect("a title");
    assert!(text(&again.stdout).contains(&format!("They replace those of `{title}` that were written on 20")));
}

#[test]
fn a_run_that_is_done_is_left_alone_and_one_without_increments_begins_anew() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("case.toml"), example("string")).expect("a file");
    let resumed =
        || signorini(folder.path()).args(["run", "case.toml", "-o", "out", "--resume"]).output().expect("a run");
    let first = signorini(folder.path()).args(["run", "case.toml", "-o", "out"]).output().expect("a run");
    assert_eq!(first.status.code(), Some(0));
    let written =
        || std::fs::metadata(folder.path().join("out/history.csv")).and_then(|m| m.modified()).expect("a file");
    let before = written();
    let done = resumed();
    assert_eq!(done.status.code(), Some(0));
    assert!(text(&done.stderr).contains("is complete") && text(&done.stdout).contains("In contact"));
    assert_eq!(written(), before);
    // As if it had been killed.
    std::fs::remove_file(folder.path().join("out/summary.json")).expect("a file");
    let anew = resumed();
    assert!(anew.status.code() == Some(0) && text(&anew.stderr).contains("starts again"));
    assert_ne!(written(), before);
}

#[test]
fn wrong_input_ends_with_one_and_says_where() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("case.toml"), example("string").replace("tension", "tensoin")).expect("a file");
    let output = signorini(folder.path()).args(["run", "case.toml"]).output().expect("a run");
    assert_eq!(output.status.code(), Some(1));
    let message = text(&output.stderr);
    assert!(message.contains("case.toml:8:1") && message.contains("did you mean `tension`?"), "{message}");
    let output = signorini(folder.path()).args(["check", "case.toml", "--json"]).output().expect("a check");
    let error: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!((error["place"]["line"].as_u64(), error["place"]["column"].as_u64()), (Some(8), Some(1)));
    for arguments in
        [&["run", "missing.toml"][..], &["gallery", "run", "strnig"], &["run"], &["--threads", "0", "gallery"]]
    {
        let output = signorini(folder.path()).args(arguments).output().expect("a run");
        assert_eq!(output.status.code(), Some(1), "{arguments:?}");
        assert!(!text(&output.stderr).contains("panicked"));
    }
}

#[test]
fn a_folder_of_others_is_left_alone() {
    let folder = tempfile::tempdir().expect("a folder");
    let precious = folder.path().join("string");
    std::fs::create_dir(&precious).expect("a folder");
    std::fs::write(precious.join("thesis.tex"), "precious").expect("a file");
    let output = signorini(folder.path()).args(["gallery", "run", "string"]).output().expect("a run");
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("thesis.tex"));
    assert_eq!(std::fs::read_dir(&precious).expect("a folder").count(), 1);
    // Nor can a file be made a folder.
    let output =
        signorini(folder.path()).args(["gallery", "run", "string", "-o", "string/thesis.tex"]).output().expect("a run");
    assert_eq!(output.status.code(), Some(1), "{}", text(&output.stderr));
}

#[test]
fn keys_are_set_and_cases_read_from_standard_input() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = signorini(folder.path())
        .args(["run", "-", "-o", "out", "--json", "--set", "loads.press.normal=-0.3", "--set", "output.pictures=false"])
        .write_stdin(example("axisymmetric"))
        .output()
        .expect("a run");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    let summary: Value = serde_json::from_slice(&output.stdout).expect("JSON");
    assert_eq!(summary["reason"], "no_contact");
    assert!(!folder.path().join("out/pictures").exists());
}

#[cfg(unix)]
#[test]
fn an_interrupt_keeps_what_is_done() {
    let folder = tempfile::tempdir().expect("a folder");
    let case = example("cosine_disc").replace("increments = 4", "increments = 400").replace("[78, 78]", "[40, 40]");
    std::fs::write(folder.path().join("long.toml"), case).expect("a file");
    let mut child = std::process::Command::new(env!("CARGO_BIN_EXE_signorini"))
        .current_dir(folder.path())
        .args(["run", "long.toml", "--json"])
        .stdout(std::process::Stdio::null())
        .spawn()
        .expect("a run");
    // Wait for the first increments, then press Ctrl-C.
    let fields = folder.path().join("long/fields.pvd");
    for _ in 0..600 {
        if fields.exists() {
            break;
        }
        std::thread::sleep(std::time::Duration::from_millis(100));
    }
    let killed = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().expect("kill");
    assert!(killed.success());
    assert_eq!(child.wait().expect("an end").code(), Some(130));
    let summary = std::fs::read_to_string(folder.path().join("long/summary.json")).expect("a summary");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    assert_eq!((summary["converged"].as_bool(), summary["reason"].as_str()), (Some(false), Some("interrupted")));
    assert!(summary["steps"].as_array().is_some_and(|s| !s.is_empty()));
}

#[test]
fn queries_are_answered_and_wrong_ones_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let good = r#"{"id": "good", "a": {"type": "point", "p": [0, 0, 2]}, "b": {"type": "segment", "p0": [1, 0, 0], "p1": [3, 0, 0]}}"#;
    let bad = r#"{"id": "bad", "a": {"type": "point", "p": [0, 0, 2]}, "b": {"type": "sphere"}}"#;
    let corpus = |cases: &str| format!("{{\"format\": \"cpp-corpus-1\", \"cases\": [{cases}]}}");
    std::fs::write(folder.path().join("q.json"), corpus(good)).expect("queries");
    let output = signorini(folder.path()).args(["closest", "q.json", "-o", "a.json"]).output().expect("answers");
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("1 queries"), "{}", text(&output.stdout));
    let answers: Value =
        serde_json::from_slice(&std::fs::read(folder.path().join("a.json")).expect("answers")).unwrap();
    assert_eq!(answers["good"]["feature_b"], "vertex");

    // From standard input, with one wrong query and a report for programs.
    let both = corpus(&format!("{good}, {bad}"));
    let output = signorini(folder.path())
        .args(["closest", "-", "-o", "b.json", "--json", "--local-minima"])
        .write_stdin(both)
        .output()
        .expect("answers");
    assert_eq!(output.status.code(), Some(1));
    let report: Value = serde_json::from_slice(&output.stdout).expect("a report");
    assert_eq!((report["answered"].as_u64(), report["wrong"].as_u64()), (Some(2), Some(1)));
    assert!(report["errors"][0].as_str().unwrap().contains("bad (line 1): b.o: missing"), "{report}");

    let output = signorini(folder.path()).args(["closest", "none.json", "-o", "c.json"]).output().expect("an error");
    assert_eq!(output.status.code(), Some(1));
    assert!(text(&output.stderr).contains("none.json"));
    assert!(!folder.path().join("c.json").exists());
}

/// What the commands of the manual write lands where git does not see it.
#[test]
fn results_of_the_readme_are_ignored_by_git() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let read = |name: &str| std::fs::read_to_string(format!("{root}/{name}")).expect("a file");
    let ignored = read(".gitignore");
    assert!(ignored.lines().any(|line| line == "/out"));
    let commands: Vec<String> = read("README.md")
        .lines()
        .filter(|l| l.starts_with("cargo run") && l.contains(" run "))
        .map(String::from)
        .collect();
    assert!(!commands.is_empty() && commands.iter().all(|c| c.contains(" -o out/")), "{commands:?}");
}

/// A run that may take no more iterations keeps what is there, says so, and ends as one that has no answer.
#[test]
fn a_run_ends_at_its_limit() {
    let folder = tempfile::tempdir().expect("a folder");
    let run = |limit: &[&str]| {
        let arguments = ["gallery", "run", "string", "-o", "out"];
        signorini(folder.path()).args(arguments).args(limit).output().expect("a run")
    };
    let output = run(&["--max-iterations", "1"]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("Stopped at the limit of 1 iterations"), "{}", text(&output.stdout));
    let summary = std::fs::read_to_string(folder.path().join("out/summary.json")).expect("a summary");
    let summary: Value = serde_json::from_str(&summary).expect("JSON");
    assert_eq!(summary["reason"], "limit_reached");
    assert_eq!(run(&["--max-time", "0"]).status.code(), Some(1));
    assert_eq!(run(&["--max-time", "1000"]).status.code(), Some(0));
}

/// Pictures of paths are drawn where `check` says so; what has none is refused.
#[test]
fn a_picture_that_is_told_is_there() {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("case.toml"), example("geodesic")).expect("a file");
    let check =
        || signorini(folder.path()).args(["check", "case.toml", "--picture", "p.svg"]).output().expect("a check");
    let output = check();
    assert_eq!(output.status.code(), Some(0), "{}", text(&output.stderr));
    assert!(text(&output.stdout).contains("Picture in p.svg"));
    assert!(std::fs::read_to_string(folder.path().join("p.svg")).expect("a picture").contains("<svg"));
}

#[test]
fn a_case_of_an_earlier_version_runs_with_a_warning_until_it_is_migrated() {
    let folder = tempfile::tempdir().expect("a folder");
    let case = folder.path().join("case.toml");
    let present = example("punch");
    std::fs::write(&case, present.replace("tied = true", "uniform = true # all")).expect("a case");
    let warned = |told: &str| told.contains("`uniform` is now `tied` (line 30)");
    let checked = signorini(folder.path()).args(["check", "case.toml"]).output().expect("a check");
    assert!(checked.status.success() && warned(&text(&checked.stdout)), "{}", text(&checked.stdout));
    let migrated = signorini(folder.path()).args(["migrate", "case.toml"]).output().expect("a migration");
    assert_eq!(text(&migrated.stdout), "case.toml:30: `uniform` is now `tied`\n");
    assert_eq!(std::fs::read_to_string(&case).unwrap(), present.replace("tied = true", "tied = true # all"));
    let checked = signorini(folder.path()).args(["check", "case.toml"]).output().expect("a check");
    assert!(checked.status.success() && !text(&checked.stdout).contains("new names"));
    let wrong = signorini(folder.path()).args(["migrate", "nothing.toml"]).output().expect("a refusal");
    assert_eq!(wrong.status.code(), Some(1));
}
