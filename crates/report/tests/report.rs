//! Reports of gallery cases of every kind, of runs that fail, and of folders that are none.

use signorini::case;
use signorini::gallery::find;
use signorini::problem::Limits;
use signorini::run::{self, Silent};
use signorini_report::{ReportError, report, write};
use std::io::{Read, Write};
use std::path::Path;

const SMALL: usize = 5_000_000;

/// Runs a case of the gallery without pictures.
fn run_case(name: &str, settings: &[&str], folder: &Path) {
    let text = find(name).expect("a case of the gallery").case;
    let settings: Vec<String> = settings.iter().map(|s| s.to_string()).collect();
    if signorini::scene::is_scene(text) {
        let (text, _) = case::override_key::apply(name, text, &settings).unwrap();
        let scene = signorini::scene::Scene::parse(name, &text, Path::new("")).unwrap();
        signorini::scene::run(&scene, folder, &mut Silent).unwrap();
        return;
    }
    let settings = [settings, vec!["output.pictures=false".into()]].concat();
    let problem = case::read(name, text, &settings).unwrap();
    if signorini::paths::is_of_paths(&problem) {
        let case = signorini::paths::PathCase::new(&problem).unwrap();
        signorini::paths::run(&case, folder, &mut Silent).map_err(|e| e.to_string()).unwrap();
    } else {
        run::run(&problem, folder, &mut Silent).map_err(|e| e.to_string()).unwrap();
    }
}

/// The data that the scripts of a page read.
fn data(html: &str) -> serde_json::Value {
    let (_, rest) = html.split_once("id=\"data\">").expect("data");
    serde_json::from_str(rest.split_once("</script>").expect("their end").0).expect("JSON")
}

/// A page that is small, loads nothing, and leaves no place of its template empty.
fn is_sound(html: &str) {
    assert!(html.len() < SMALL, "{} bytes", html.len());
    for loads in ["src=\"http", "href=\"http", "url(http", "@import", "<link rel=\"stylesheet", "<script src"] {
        assert!(!html.contains(loads), "{loads}");
    }
    for place in ["{{title}}", "{{body}}", "{{data}}", "{{scripts}}", "{{fallback}}"] {
        assert!(!html.contains(place), "{place}");
    }
    assert!(html.contains("id=\"verdict\""));
}

fn looks(data: &serde_json::Value) -> Vec<&str> {
    data["scene"]["parts"].as_array().unwrap().iter().map(|p| p["look"].as_str().unwrap()).collect()
}

#[test]
fn every_kind_of_result_becomes_a_page() {
    let folder = tempfile::tempdir().unwrap();
    let kinds: [(&str, &[&str], &[&str]); 5] = [
        ("string", &[], &["membrane", "rigid", "outline"]),
        ("patch_test", &[], &["solid"]),
        ("crossing", &[], &["curve", "arrows"]),
        ("helix", &[], &["curve", "rigid"]),
        ("swords", &["frames=3"], &["rigid", "pair"]),
    ];
    for (name, settings, wanted) in kinds {
        let results = folder.path().join(name);
        run_case(name, settings, &results);
        let html = report(&results).unwrap();
        is_sound(&html);
        let data = data(&html);
        let looks = looks(&data);
        assert!(wanted.iter().all(|look| looks.contains(look)), "{name}: {looks:?}");
        assert!(html.contains(&format!("<title>{}</title>", title(name))), "{name}");
    }
    // Bodies have the names of the case.
    let html = report(&folder.path().join("crossing")).unwrap();
    let parts = data(&html)["scene"]["parts"].clone();
    let case: toml::Table = find("crossing").unwrap().case.parse().unwrap();
    for name in case["bodies"].as_table().unwrap().keys() {
        assert!(parts.as_array().unwrap().iter().any(|p| p["name"] == name.as_str()), "{name}");
    }
}

/// The title of a case as it stands in HTML.
fn title(name: &str) -> String {
    let case: toml::Table = find(name).unwrap().case.parse().unwrap();
    case["title"].as_str().unwrap().replace('&', "&amp;").replace('\'', "&#39;")
}

#[test]
fn runs_that_stop_tell_why_and_how_far_they_came() {
    let folder = tempfile::tempdir().unwrap();
    let text = find("patch_test").unwrap().case;
    let mut problem = case::read("patch_test", text, &["output.pictures=false".to_string()]).unwrap();
    problem.limits = Limits { max_time: None, max_iterations: Some(1) };
    run::run(&problem, folder.path(), &mut Silent).map_err(|e| e.to_string()).unwrap();
    let html = report(folder.path()).unwrap();
    is_sound(&html);
    assert!(html.contains("Stopped at a limit") || html.contains("Not converged"));
    // A run that was killed has no summary; its log tells of the iterations.
    std::fs::remove_file(folder.path().join("summary.json")).unwrap();
    let html = report(folder.path()).unwrap();
    is_sound(&html);
    assert!(html.contains("Not finished"));
}

#[test]
fn measurements_and_what_fits_them_become_a_chart() {
    let folder = tempfile::tempdir().unwrap();
    let results = folder.path().join("fitted");
    let gallery = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../gallery/blister/case.toml");
    let text = std::fs::read_to_string(&gallery).unwrap();
    let problem = case::read(&gallery.to_string_lossy(), &text, &[]).unwrap();
    signorini::fit::fit(&problem, &results).map_err(|e| e.to_string()).unwrap();
    let html = report(&results).unwrap();
    is_sound(&html);
    assert_eq!(data(&html)["histories"][0]["series"].as_array().unwrap().len(), 2);
}

#[test]
fn folders_that_are_none_are_told() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    assert!(matches!(report(&path.join("nothing")), Err(ReportError::Missing(_))));
    assert!(matches!(report(path), Err(ReportError::NotResults(_))));
    let file = path.join("log.jsonl");
    std::fs::write(&file, "{\"event\":\"other\"}\n").unwrap();
    assert!(matches!(report(&file), Err(ReportError::NotAFolder(_))));
    assert!(matches!(report(path), Err(ReportError::NotResults(_))));
    for damaged in ["", "{\"steps\": [", "[]", "{}", "{\"steps\": 3}", "{\"schema\": 2, \"steps\": []}"] {
        std::fs::write(path.join("summary.json"), damaged).unwrap();
        assert!(matches!(report(path), Err(ReportError::Damaged { .. })), "{damaged}");
    }
}

#[test]
fn answers_of_closest_points_become_a_page() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("answers.json");
    let answer = r#"{"first": {"distance": 2.0, "xa": [0, 0, 2], "xb": [0, 0, 0], "feature_a": "point", "feature_b": "vertex",
        "unique": true, "uniqueness": "unique", "certified": true}, "wrong": {"error": "b.o: missing", "line": 1}}"#;
    std::fs::write(&path, answer).unwrap();
    let html = std::fs::read_to_string(write(&path, None).unwrap()).unwrap();
    is_sound(&html);
    assert!(html.contains("2 queries: 1 wrong"));
    assert_eq!(looks(&data(&html)), ["pair"]);
}

#[test]
fn damaged_files_of_fields_are_told_in_the_page() {
    let folder = tempfile::tempdir().unwrap();
    run_case("patch_test", &[], folder.path());
    let fields: Vec<_> = std::fs::read_dir(folder.path().join("fields")).unwrap().map(|e| e.unwrap().path()).collect();
    let text = std::fs::read(&fields[0]).unwrap();
    std::fs::write(&fields[0], &text[..text.len() / 3]).unwrap();
    is_sound(&report(folder.path()).unwrap());
    for file in &fields {
        std::fs::write(file, "<VTKFile").unwrap();
    }
    is_sound(&report(folder.path()).unwrap());
}

#[test]
fn texts_of_a_case_are_no_markup() {
    let folder = tempfile::tempdir().unwrap();
    run_case("string", &["title=\"<script>alert(1)</script> {{data}}\""], folder.path());
    let html = report(folder.path()).unwrap();
    assert!(!html.contains("<script>alert"));
    assert!(html.contains("&lt;script&gt;alert(1)&lt;/script&gt; {{data}}"));
    // Twice the same folder, the same page.
    assert_eq!(html, report(folder.path()).unwrap());
}

#[test]
fn a_page_is_stored_whole_and_a_new_run_replaces_it() {
    let folder = tempfile::tempdir().unwrap();
    let results = folder.path().join("out");
    run_case("string", &[], &results);
    let path = write(&results, None).unwrap();
    assert_eq!(path, results.join("report.html"));
    assert!(std::fs::read_to_string(&path).unwrap().ends_with("</html>\n"));
    assert!(matches!(write(&results, Some(Path::new("/nowhere/at/all.html"))), Err(ReportError::Write { .. })));
    run_case("string", &[], &results);
    assert!(!path.exists());
}

#[test]
fn the_server_answers_this_computer_only() {
    let folder = tempfile::tempdir().unwrap();
    run_case("string", &[], folder.path());
    let server = signorini_report::serve::Server::new(folder.path(), 0).unwrap();
    let address = server.address().unwrap();
    assert!(address.ip().is_loopback());
    std::thread::spawn(|| server.run());
    let ask = |request: &str| {
        let mut stream = std::net::TcpStream::connect(address).unwrap();
        stream.write_all(request.as_bytes()).unwrap();
        let mut answer = String::new();
        stream.read_to_string(&mut answer).unwrap();
        answer
    };
    let host = format!("Host: {address}\r\n\r\n");
    assert!(ask(&format!("GET / HTTP/1.1\r\n{host}")).contains("const SERVED = true"));
    let state = ask(&format!("GET /state HTTP/1.1\r\n{host}"));
    assert!(state.starts_with("HTTP/1.1 200"));
    std::fs::write(folder.path().join("history.csv"), "index,time\n").unwrap();
    assert_ne!(state, ask(&format!("GET /state HTTP/1.1\r\n{host}")));
    assert!(ask("GET / HTTP/1.1\r\nHost: elsewhere.example\r\n\r\n").starts_with("HTTP/1.1 403"));
    assert!(ask(&format!("POST / HTTP/1.1\r\n{host}")).starts_with("HTTP/1.1 405"));
    assert!(ask(&format!("GET /../summary.json HTTP/1.1\r\n{host}")).starts_with("HTTP/1.1 404"));
}
