//! The pages of results.

use super::runs::{signorini, text};
use serde_json::Value;

#[test]
fn a_report_lies_in_the_folder_or_where_it_is_wanted() {
    let folder = tempfile::tempdir().unwrap();
    let run = ["gallery", "run", "string", "--set", "output.pictures=false", "-o", "out"];
    assert!(signorini(folder.path()).args(run).output().unwrap().status.success());
    let told = signorini(folder.path()).args(["report", "out"]).output().unwrap();
    assert!(told.status.success(), "{}", text(&told.stderr));
    assert!(text(&told.stdout).contains("report.html"), "{}", text(&told.stdout));
    let html = std::fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    assert!(html.starts_with("<!doctype html>"));
    let told = signorini(folder.path()).args(["report", "out", "-o", "string.html", "--json"]).output().unwrap();
    let answer: Value = serde_json::from_slice(&told.stdout).unwrap();
    assert_eq!(answer["bytes"], html.len());
    assert_eq!(std::fs::read_to_string(folder.path().join("string.html")).unwrap(), html);
}

#[test]
fn folders_without_results_are_wrong_input() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::create_dir(folder.path().join("empty")).unwrap();
    for (command, of) in [("report", "nothing"), ("report", "empty"), ("view", "empty")] {
        let told = signorini(folder.path()).args([command, of]).output().unwrap();
        assert_eq!(told.status.code(), Some(1));
        assert!(text(&told.stderr).contains("give the folder of a run"), "{}", text(&told.stderr));
        let told = signorini(folder.path()).args([command, of, "--json"]).output().unwrap();
        assert_eq!(told.status.code(), Some(1));
        let answer: Value = serde_json::from_slice(&told.stdout).unwrap();
        assert!(answer["error"].as_str().unwrap().contains(of) && answer["help"].is_string());
    }
}
