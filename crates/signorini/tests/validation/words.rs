//! The words that results are told in.

use super::{example, set};
use signorini::run::run;
use signorini_solve::Silent;

/// The keys of a table and of all within it, but for those of tables whose keys are names of the case.
fn words(v: &serde_json::Value, out: &mut std::collections::BTreeSet<String>) {
    const NAMED: [&str; 7] =
        ["contacts", "probes", "support_forces", "load_forces", "support_moments", "load_moments", "materials"];
    match v {
        serde_json::Value::Object(table) => {
            for (key, inner) in table {
                out.insert(key.clone());
                match inner.as_object().filter(|_| NAMED.contains(&key.as_str())) {
                    Some(named) => named.values().for_each(|v| words(v, out)),
                    None => words(inner, out),
                }
            }
        }
        serde_json::Value::Array(list) => list.iter().for_each(|v| words(v, out)),
        _ => {}
    }
}

/// All files in a folder and those within it.
fn files(folder: &std::path::Path) -> Vec<std::path::PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().filter_map(|e| Some(e.ok()?.path()));
    entries.flat_map(|path| if path.is_dir() { files(&path) } else { vec![path] }).collect()
}

/// Every word of the summary, the check, the log, the tables and the files for ParaView is one that `explain` knows.
#[test]
fn every_word_of_the_results_is_explained() {
    // The headings of the terminal's tables.
    let headings = ["t", "solves", "contact", "force", "area", "max pressure", "radius", "zones", "holes", "balance"];
    let mut found: std::collections::BTreeSet<String> = headings.iter().map(|w| w.to_string()).collect();
    let probe = ("output.probes.p", "[0.1, 0]".to_string());
    let steps = ("steps", "[{ to = 1, increments = 2, events = 0.1 }]".to_string());
    let load = ("loads.press.normal", "\"-t\"".to_string());
    let adhesion = ("contacts.touch.adhesion.energy", "1e-3".to_string());
    for (name, pairs) in [
        (
            "flat_disc",
            vec![probe.clone(), steps.clone(), load, ("bodies.film.membrane.mesh.grid.cells", "[12, 12]".into())],
        ),
        ("string", vec![adhesion]),
        ("high_order_blocks", vec![probe]),
        ("capstan", vec![("steps", "[{ to = 0.1, increments = 1 }]".to_string())]),
        ("incline", vec![]),
    ] {
        let folder = tempfile::tempdir().expect("a folder");
        let problem = signorini::case::read("case.toml", example(name), &set(&pairs)).expect("a case");
        let sizes = signorini::run::sizes(&signorini::plan::plan(&problem).expect("a plan")).expect("sizes");
        words(&sizes, &mut found);
        let summary = run(&problem, folder.path(), &mut Silent).expect("a run").summary;
        let summary = serde_json::json!(summary);
        words(&summary, &mut found);
        for kind in summary["events"].as_array().into_iter().flatten() {
            found.extend(["kind", "by"].map(|key| kind[key].as_str().unwrap_or_default().to_string()));
        }
        let read = |file: &str| std::fs::read_to_string(folder.path().join(file)).expect(file);
        for line in read("log.jsonl").lines() {
            words(&serde_json::from_str(line).expect("JSON"), &mut found);
        }
        for file in files(folder.path()) {
            let text = String::from_utf8_lossy(&std::fs::read(&file).expect("a file")).into_owned();
            match file.extension().and_then(|e| e.to_str()) {
                // Columns of units, and of names of the case, are explained by what they are of.
                Some("csv") => {
                    let header = text.lines().next().unwrap_or_default();
                    let column = |w: &str| w.split('[').next().unwrap_or(w).trim().to_string();
                    found.extend(header.split(',').filter(|w| !w.starts_with("p:")).map(column));
                }
                Some("vtu" | "vtp") => {
                    found.extend(text.split("Name=\"").skip(1).filter_map(|w| w.split('"').next()).map(str::to_string));
                }
                _ => {}
            }
        }
    }
    for of_vtk in ["connectivity", "offsets", "types", "Points", "signorini", "-"] {
        found.remove(of_vtk);
    }
    found.retain(|w| !w.is_empty());
    let unknown: Vec<&String> = found.iter().filter(|w| signorini::explain::explain(w).is_err()).collect();
    assert!(unknown.is_empty() && found.len() > 70, "{unknown:?} of {}", found.len());
}
