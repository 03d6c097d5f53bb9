//! The manual: its cases are cases, and its links lead somewhere.

use std::collections::HashMap;
use std::fs;
use std::path::{Path, PathBuf};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The Markdown files below a folder, with their texts.
fn pages(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut found = Vec::new();
    for path in fs::read_dir(folder).expect("a folder").map(|e| e.expect("an entry").path()) {
        if path.is_dir() {
            found.extend(pages(&path));
        } else if path.extension().is_some_and(|e| e == "md") {
            let text = fs::read_to_string(&path).expect("a page");
            found.push((path, text));
        }
    }
    found.sort();
    found
}

/// Manual, gallery, paper and README.
fn all_pages() -> Vec<(PathBuf, String)> {
    let root = root();
    let mut found: Vec<_> = ["docs", "gallery", "paper"].iter().flat_map(|name| pages(&root.join(name))).collect();
    found.push((root.join("README.md"), fs::read_to_string(root.join("README.md")).expect("a page")));
    found
}

/// The blocks of code of a language.
fn blocks<'a>(text: &'a str, language: &str) -> Vec<&'a str> {
    let opening = format!("```{language}\n");
    text.split(opening.as_str()).skip(1).filter_map(|rest| rest.split("\n```").next()).collect()
}

/// Whether a block states bodies and what is asked of them, not some keys only.
fn is_complete(case: &str) -> bool {
    let has = |heading: &str| case.lines().any(|line| line.starts_with(heading));
    let asks = ["[contacts.", "[paths.", "[winding.", "[ropes."];
    has("[bodies.") && asks.iter().any(|heading| has(heading)) && !case.contains('…')
}

#[test]
fn every_complete_case_of_the_manual_is_valid() {
    let mut count = 0;
    for (path, text) in all_pages() {
        for case in blocks(&text, "toml").into_iter().filter(|case| is_complete(case)) {
            count += 1;
            let place = format!("{}:\n{case}\n", path.display());
            if case.lines().any(|line| line.starts_with("analysis")) {
                let made = signorini::paths::PathCase::parse("case.toml", case, &[]);
                made.unwrap_or_else(|e| panic!("{place}{}", e.one_line()));
                continue;
            }
            let problem =
                signorini::case::read("case.toml", case, &[]).unwrap_or_else(|e| panic!("{place}{}", e.one_line()));
            signorini::plan::plan(&problem).unwrap_or_else(|e| panic!("{place}{}", e.one_line()));
        }
    }
    assert!(count > 10, "only {count}");
}

/// What a heading is called in links to it.
fn anchor(heading: &str) -> String {
    let plain = heading.trim().to_lowercase();
    plain
        .chars()
        .filter(|c| c.is_alphanumeric() || " -_".contains(*c))
        .map(|c| if c == ' ' { '-' } else { c })
        .collect()
}

/// The text without blocks of code and without code in lines.
fn prose(text: &str) -> String {
    let outside: Vec<&str> = text.split("```").step_by(2).collect();
    outside.join("\n").split('`').step_by(2).collect()
}

#[test]
fn every_link_leads_somewhere() {
    let pages = all_pages();
    let mut anchors: HashMap<PathBuf, Vec<String>> = HashMap::new();
    for (path, text) in &pages {
        let outside: Vec<&str> = text.split("```").step_by(2).collect();
        let headings = outside.join("\n");
        let headings = headings.lines().filter(|l| l.starts_with('#')).map(|l| anchor(l.trim_start_matches('#')));
        anchors.insert(path.canonicalize().expect("a path"), headings.collect());
    }
    let mut broken = Vec::new();
    for (path, text) in &pages {
        for link in prose(text).split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            if link.starts_with("http") {
                continue;
            }
            let (file, place) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { path.clone() } else { path.parent().expect("a folder").join(file) };
            let is_there = target.canonicalize().is_ok_and(|found| {
                place.is_empty() || anchors.get(&found).is_some_and(|known| known.iter().any(|a| a == place))
            });
            if !is_there {
                broken.push(format!("{}: {link}", path.display()));
            }
        }
    }
    assert!(broken.is_empty(), "{broken:#?}");
}
