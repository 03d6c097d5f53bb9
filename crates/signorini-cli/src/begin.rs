//! What helps to begin: templates, explanations, the schema, problems with known answers.

use crate::commands::{DONE, INTERRUPTED, NOT_CONVERGED, WRONG_INPUT, read, report, unknown_example};
use crate::console::{self, say, tell};
use serde_json::{Value, json};
use signorini::case::renamed::{Renamed, modernised};
use signorini::case::{schema, toml_error};
use signorini::explain::{explain as explanation, reference, words as all_words};
use signorini::gallery::{asset, find};
use signorini::output::atomic;
use signorini::problem::CaseError;
use signorini::report::words;
use signorini::reproduce::{FIGURES, reproduce as reproduced};
use signorini::template::{SCHEMA_FILE, annotated};
use signorini::verify::{PROBLEMS, verify as verified};
use std::path::{Path, PathBuf};

/// Makes a folder with a case to begin with.
pub fn new(template: &str, folder: Option<PathBuf>, json: bool) -> u8 {
    let Some(example) = find(template) else { return report(&unknown_example(template), json) };
    let folder = folder.unwrap_or_else(|| PathBuf::from(template));
    let occupied = std::fs::read_dir(&folder).is_ok_and(|mut entries| entries.next().is_some());
    if occupied || folder.is_file() {
        let error = CaseError::new(format!("`{}` already exists", folder.display()))
            .help(format!("signorini new {template} another_folder"));
        return report(&error, json);
    }
    let case = annotated(example);
    let mut files = vec![
        ("case.toml".to_string(), case.clone().into_bytes()),
        (SCHEMA_FILE.to_string(), schema_text().into_bytes()),
    ];
    let named = case.lines().filter(|l| !l.starts_with('#')).flat_map(|l| l.split('"').skip(1).step_by(2));
    files.extend(named.filter_map(|name| Some((name.to_string(), asset(name)?.to_vec()))));
    if let Err(error) = write_all(&folder, &files) {
        return report(&not_written(&folder, &error), json);
    }
    let path = folder.join("case.toml");
    if json {
        say!("{}", json!({"case": path.display().to_string()}));
    } else {
        say!("{}\n\nRun it with  signorini run {}", path.display(), path.display());
    }
    DONE
}

/// Gives the keys of earlier versions in case files their present names; standard input is printed with these.
pub fn migrate(files: &[PathBuf], json: bool) -> u8 {
    let mut all = Vec::new();
    for file in files {
        if file == Path::new("-") {
            match read(file) {
                Ok((_, text)) => console::print(format_args!("{}", modernised(&text).0)),
                Err(error) => return report(&error, json),
            }
            continue;
        }
        let renamed = match migrated(file) {
            Ok(renamed) => renamed,
            Err(error) => return report(&error, json),
        };
        let name = file.display().to_string();
        if !json {
            for key in &renamed {
                say!("{name}:{}: `{}` is now `{}`", key.line, key.old, key.new);
            }
            if renamed.is_empty() {
                say!("{name}: all keys have their present names");
            }
        }
        let keys = renamed.iter().map(|key| json!({"line": key.line, "earlier": key.old, "present": key.new}));
        all.push(json!({"file": name, "renamed": keys.collect::<Vec<_>>()}));
    }
    if json {
        say!("{}", Value::from(all));
    }
    DONE
}

/// Rewrites one file, if it has keys of earlier versions.
fn migrated(file: &Path) -> Result<Vec<Renamed>, CaseError> {
    let (name, text) = read(file)?;
    toml_error::check(&name, &text)?;
    let (text, mut renamed) = modernised(&text);
    renamed.sort_by_key(|key| key.line);
    if !renamed.is_empty() {
        atomic::write(file, text.as_bytes()).map_err(|error| not_written(file, &error))?;
    }
    Ok(renamed)
}

fn write_all(folder: &Path, files: &[(String, Vec<u8>)]) -> std::io::Result<()> {
    std::fs::create_dir_all(folder)?;
    files.iter().try_for_each(|(name, text)| std::fs::write(folder.join(name), text))
}

fn not_written(path: &Path, error: &std::io::Error) -> CaseError {
    CaseError::new(format!("cannot write `{}`: {error}", path.display()))
        .help("check that this program may write there")
}

/// Writes the manual pages of a command and its subcommands.
pub fn man(command: clap::Command, folder: &Path, json: bool) -> u8 {
    if let Err(error) = std::fs::create_dir_all(folder).and_then(|()| clap_mangen::generate_to(command, folder)) {
        return report(&not_written(folder, &error), json);
    }
    if json {
        say!("{}", json!({"folder": folder.display().to_string()}));
    } else {
        say!("Manual pages are in {}.", folder.display());
    }
    DONE
}

/// Explains a key or a word, or lists all words.
pub fn explain(word: Option<&str>, json: bool) -> u8 {
    let Some(word) = word else {
        for (word, kind) in all_words() {
            say!("{word:22} {kind}");
        }
        say!(
            "\nAnd every key of the case file and of summary.json: signorini explain contacts.method  (all of them: signorini schema --markdown)"
        );
        return DONE;
    };
    match explanation(word) {
        Err(error) => report(&error, json),
        Ok(text) => {
            if json {
                say!("{}", json!({"explanation": text}));
            } else {
                console::print(format_args!("{text}"));
            }
            DONE
        }
    }
}

fn schema_text() -> String {
    serde_json::to_string_pretty(&schema::schema()).unwrap_or_default() + "\n"
}

/// Prints what may stand in a case file, or in the summary of a run.
pub fn schema(of_summary: bool, markdown: bool) -> u8 {
    let text = match (markdown, of_summary) {
        (true, _) => reference(),
        (false, true) => serde_json::to_string_pretty(&words::schema()).unwrap_or_default() + "\n",
        (false, false) => schema_text(),
    };
    console::print(format_args!("{text}"));
    DONE
}

/// Computes figures of the publication anew, into a folder; lists them where none is named.
pub fn reproduce(names: &[String], folder: &Path) -> u8 {
    if names.is_empty() {
        for figure in &FIGURES {
            say!("{:18} {}", figure.name, figure.about);
        }
        say!("\nsignorini reproduce NAME computes one of them, signorini reproduce all computes all.");
        return DONE;
    }
    let all = names.iter().any(|n| n == "all");
    if let Some(unknown) = names.iter().find(|n| *n != "all" && FIGURES.iter().all(|f| f.name != **n)) {
        let names: Vec<&str> = FIGURES.iter().map(|f| f.name).collect();
        tell!("there is no figure `{unknown}`; valid are {} and all", names.join(", "));
        return WRONG_INPUT;
    }
    for figure in FIGURES.iter().filter(|f| all || names.iter().any(|n| n == f.name)) {
        match reproduced(figure, folder) {
            Ok(text) => say!("{text}"),
            Err(why) => {
                tell!("{}: {why}", figure.name);
                return NOT_CONVERGED;
            }
        }
    }
    say!("Pages and pictures are in {}.", folder.display());
    DONE
}

/// Runs the problems with known answers, and prints them as a table.
pub fn verify(json: bool) -> u8 {
    let mut wrong = 0;
    let mut list: Vec<Value> = Vec::new();
    if !json {
        say!("{:58} {:>14} {:>14} {:>9} {:>9}", "problem", "found", "exact", "error", "allowed");
    }
    for problem in &PROBLEMS {
        // Nobody is left to tell it, and nothing but the table comes of it.
        if console::ended() {
            return INTERRUPTED;
        }
        let folder = std::env::temp_dir().join(format!("signorini-verify-{}", std::process::id()));
        let result = verified(problem, &folder);
        // What cannot be removed stays in the folder for temporary files.
        let _ = std::fs::remove_dir_all(&folder);
        match result {
            Ok(v) => {
                wrong += u32::from(!v.holds());
                list.push(json!({
                    "problem": v.name, "found": v.found, "exact": v.exact, "error": v.error, "allowed": v.allowed,
                    "source": v.source, "holds": v.holds(),
                }));
                if !json {
                    let mark = if v.holds() { "" } else { "  WRONG" };
                    say!(
                        "{:58} {:>14.8} {:>14.8} {:>9.1e} {:>9.1e}{mark}",
                        v.name,
                        v.found,
                        v.exact,
                        v.error,
                        v.allowed
                    );
                }
            }
            Err(why) => {
                wrong += 1;
                list.push(json!({"problem": problem.name, "holds": false, "error": why}));
                if !json {
                    say!("{:58} {why}", problem.name);
                }
            }
        }
    }
    if json {
        say!("{}", Value::from(list));
    } else if wrong == 0 {
        say!("\nAll {} hold.", PROBLEMS.len());
    } else {
        say!("\n{wrong} of {} do not hold.", PROBLEMS.len());
    }
    if wrong == 0 { DONE } else { NOT_CONVERGED }
}
