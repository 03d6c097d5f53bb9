//! Reports of gallery cases of every kind, of runs that fail, and of folders that are none.

use plotters::style::RGBColor;
use signorini::case;
use signorini::gallery::find;
use signorini::output::chart::{Format, viridis};
use signorini::problem::Limits;
use signorini::run::{self, Silent};
use signorini_report::draw::{Wanted, draw, format_of};
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

#[test]
fn a_cut_shows_the_field_on_the_section_and_tells_values_that_are_drawn() {
    let folder = tempfile::tempdir().unwrap();
    run_case("patch_test", &[], folder.path());
    // The blocks widen by 0.003 y: the section at y = 0.5, where y was 0.4985, has half of what the far side has, the side
    // behind has nothing.
    let wanted = Wanted {
        field: Some("displacement_y".into()),
        view: Some("y".into()),
        clips: vec!["y<0.5".into()],
        range: Some("0:0.003".into()),
        size: Some("1000x1000".into()),
        ..Wanted::default()
    };
    let drawn = draw(folder.path(), &wanted, Format::Png).unwrap();
    assert!((drawn.ends[1] - 0.001_495_5).abs() < 1e-6 && drawn.ends[0].abs() < 1e-9, "{:?}", drawn.ends);
    let mut reader = png::Decoder::new(std::io::Cursor::new(&drawn.bytes));
    reader.set_transformations(png::Transformations::EXPAND);
    let mut reader = reader.read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
    let info = reader.next_frame(&mut pixels).unwrap();
    let at = 3 * (634 * info.width as usize + 453);
    let RGBColor(r, g, b) = viridis(0.5);
    // Light takes at most a quarter of a colour.
    for (found, full) in pixels[at..at + 3].iter().zip([r, g, b]) {
        let share = f64::from(*found) / f64::from(full);
        assert!((0.75..=1.02).contains(&share), "{:?}", &pixels[at..at + 3]);
    }
    // Of a stress that is zero there is round-off only.
    let wanted = Wanted { field: Some("stress_xy".into()), ..Wanted::default() };
    let drawn = draw(folder.path(), &wanted, Format::Svg).unwrap();
    assert_eq!(drawn.ends, [0.0, 0.0]);
    assert!(drawn.notes.iter().any(|note| note.contains("round-off")), "{:?}", drawn.notes);
}

#[test]
fn what_cannot_be_drawn_is_answered_with_what_can() {
    let folder = tempfile::tempdir().unwrap();
    run_case("patch_test", &[], folder.path());
    let wrong = [
        (Wanted { field: Some("pressure".into()), ..Wanted::default() }, "did you mean `contact_pressure`?"),
        (Wanted { field: Some("pressure".into()), ..Wanted::default() }, "von_mises"),
        (Wanted { clips: vec!["x>7".into()], ..Wanted::default() }, "x from 0 to"),
        (Wanted { clips: vec!["x*y>0".into()], ..Wanted::default() }, "x<0.5"),
        (Wanted { view: Some("up".into()), ..Wanted::default() }, "iso"),
        (Wanted { range: Some("3:1".into()), ..Wanted::default() }, "LOW:HIGH"),
        (Wanted { size: Some("1x1".into()), ..Wanted::default() }, "WIDTHxHEIGHT"),
        (Wanted { time: Some("noon".into()), ..Wanted::default() }, "last"),
    ];
    for (wanted, help) in wrong {
        let error = draw(folder.path(), &wanted, Format::Png).unwrap_err();
        assert!(error.help().contains(help), "{error}: {}", error.help());
    }
    let error = format_of(Path::new("film.mp4")).unwrap_err();
    assert!(error.to_string().contains("webp"), "{error}");
}

#[test]
fn all_times_are_frames_of_files_that_move() {
    let folder = tempfile::tempdir().unwrap();
    run_case("swords", &["frames=3"], folder.path());
    let drawn = |format: Format| draw(folder.path(), &Wanted::default(), format).unwrap();
    let count = |bytes: &[u8], what: &[u8]| bytes.windows(what.len()).filter(|w| *w == what).count();
    let webp = drawn(Format::WebP);
    assert!(webp.times.len() > 1);
    assert_eq!(count(&webp.bytes, b"ANMF"), webp.times.len());
    assert_eq!(count(&drawn(Format::Apng).bytes, b"fcTL"), webp.times.len());
    assert!(drawn(Format::Gif).bytes.starts_with(b"GIF89a"));
    assert!(drawn(Format::Pdf).bytes.starts_with(b"%PDF"));
}
