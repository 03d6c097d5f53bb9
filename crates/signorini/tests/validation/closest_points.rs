//! Files of queries: the corpus of certified cases, and input that is wrong.
//!
//! The corpus holds 457 closest-point problems of all six pairs whose answers were certified by an independent
//! subdivision proof and polished in 60-digit arithmetic.

use serde_json::{Value, json};
use signorini::queries::{QueriesError, Query, Report, answer_file, answer_points};
use std::path::Path;

fn run(text: &str) -> (Result<Report, QueriesError>, Value) {
    let folder = tempfile::tempdir().unwrap();
    let (queries, answers) = (folder.path().join("queries.json"), folder.path().join("answers.json"));
    std::fs::write(&queries, text).unwrap();
    let report = answer_file(&queries, &answers, &Query::default(), &mut |_| true);
    let answers = std::fs::read_to_string(&answers).unwrap();
    (report, serde_json::from_str(&answers).unwrap())
}

fn corpus(cases: &[&str]) -> String {
    format!("{{\"format\": \"cpp-corpus-1\", \"cases\": [{}]}}", cases.join(",\n"))
}

fn point(value: &Value) -> [f64; 3] {
    std::array::from_fn(|k| value[k].as_f64().unwrap())
}

fn apart(a: &Value, b: &Value) -> f64 {
    let (a, b) = (point(a), point(b));
    (0..3).map(|k| (a[k] - b[k]).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn the_corpus_is_right() {
    let text = include_str!("../data/closest_points.json");
    let (report, answers) = run(text);
    assert_eq!(report.unwrap().wrong_count, 0);
    let cases: Value = serde_json::from_str(text).unwrap();
    let mut wrong = Vec::new();
    for case in cases["cases"].as_array().unwrap() {
        let id = case["id"].as_str().unwrap();
        let (answer, expected) = (&answers[id], &case["expected"]);
        let tolerance = case["tol"]["point"].as_f64().unwrap();
        let scale = case["scale"].as_f64().unwrap();
        let error = (answer["distance"].as_f64().unwrap() - expected["distance"].as_f64().unwrap()).abs();
        let mut complain = |what: &str| wrong.push(format!("{id} {}: {what}", case["class"]));
        // The corpus allows 1e-9; regular and degenerate cases alike do a thousand times better.
        if error > 1e-12 * scale {
            complain(&format!("distance off by {error:e}"));
        }
        let unique = &expected["unique"];
        if !unique.is_null() && answer["unique"] != *unique {
            complain("uniqueness");
        }
        let near_continuum = case["flags"].as_array().unwrap().contains(&json!("near-continuum"));
        if expected["continuum_dim"] != 0 || (near_continuum && unique.is_null()) {
            continue;
        }
        let distance_to = |m: &Value| apart(&answer["xa"], &m["xa"]).max(apart(&answer["xb"], &m["xb"]));
        let minimisers = expected["minimisers"].as_array().unwrap();
        let best = minimisers.iter().map(distance_to).fold(f64::INFINITY, f64::min);
        if best > tolerance {
            complain(&format!("foot off by {best:e}"));
        }
        for side in ["a", "b"] {
            let accepted = minimisers.iter().filter(|m| distance_to(m) <= tolerance.max(2.0 * best)).any(|m| {
                let accept = m[format!("accept_{side}")].as_array().unwrap();
                accept.contains(&json!("*")) || accept.contains(&answer[format!("feature_{side}")])
            });
            if !accepted {
                complain(&format!("feature {}", answer[format!("feature_{side}")]));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn answers_do_not_depend_on_threads() {
    let text = include_str!("../data/closest_points.json");
    let answers = [1, 2].map(|threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| run(text).1)
    });
    assert_eq!(answers[0], answers[1]);
}

const GOOD: &str = r#"{"id": "good", "a": {"type": "point", "p": [0, 0, 2]}, "b": {"type": "segment", "p0": [1, 0, 0], "p1": [3, 0, 0]}}"#;

#[test]
fn one_wrong_query_stops_no_other() {
    let point = r#""a": {"type": "point", "p": [0,0,1]}"#;
    // The second partner, and what the error must mention.
    let partners: Vec<(String, &[&str])> = vec![
        (r#"{"type": "circle", "o": [0,0,0], "ex": [1,0,0], "ey": [0,1,0], "r": 0, "range": [0, 1]}"#.into(), &["b.r", "greater than zero"]),
        (r#"{"type": "circle", "o": [0,0,0], "ex": [1,0,0], "ey": [1,0,0], "r": 1, "range": [0, 1]}"#.into(), &["b.ey", "right angles"]),
        (r#"{"type": "circle", "o": [0,0,0], "ex": [2,0,0], "ey": [0,1,0], "r": 1, "range": [0, 1]}"#.into(), &["b.ex", "length 2"]),
        (r#"{"type": "circle", "o": [0,0,0], "ex": [1,0,0], "ey": [0,1,0], "r": 1, "range": [1, 0]}"#.into(), &["b.range", "increase"]),
        (r#"{"type": "circle", "o": [0,0,0], "ex": [1,0,0], "ey": [0,1,0], "r": 1, "range": [0, 1], "closed": true}"#.into(), &["b.closed", "2 pi"]),
        (r#"{"type": "circel"}"#.into(), &["b.type", "circel", "circle"]),
        (r#"{"type": "point"}"#.into(), &["b.p", "missing"]),
        (r#"{"type": "point", "p": [1, 2]}"#.into(), &["b.p", "2 numbers instead of 3"]),
        (r#"{"type": "point", "p": [1, 2, "x"]}"#.into(), &["b.p[2]", "\"x\""]),
        (r#"{"type": "point", "p": [1, 2, null]}"#.into(), &["b.p[2]", "null"]),
        (r#"{"type": "point", "p": [1, 2, NaN]}"#.into(), &["NaN"]),
        (r#"{"type": "point", "p": [1, 2, -Infinity]}"#.into(), &["Infinity"]),
        (r#"{"type": "segment", "p0": [1e300, 0, 0], "p1": [0, 0, 0]}"#.into(), &["b.p0", "change the unit"]),
        (r#"{"type": "segment", "p0": [1e400, 0, 0], "p1": [0, 0, 0]}"#.into(), &["b: not JSON", "out of range"]),
        (r#"{"type": "bezier", "control_points": [[0,0,0]]}"#.into(), &["b.control_points", "2 to 16"]),
        (r#"{"type": "bezier", "control_points": [[0,0,0],[1,0,0]], "weights": [1]}"#.into(), &["b.weights", "1 for 2"]),
        (r#"{"type": "bezier", "control_points": [[0,0,0],[1,0,0]], "weights": [1, -1]}"#.into(), &["b.weights", "-1"]),
        (r#"{"type": "nurbs", "degree": 1, "knots": [0, 0, 1], "control_points": [[0,0,0],[1,0,0]]}"#.into(), &["b.knots", "need 4"]),
        (r#"{"type": "nurbs", "degree": 1, "knots": [0, 1, 0, 1], "control_points": [[0,0,0],[1,0,0]]}"#.into(), &["b.knots", "less than"]),
        (r#"{"type": "nurbs", "degree": 1, "knots": [0, 0, 0, 0], "control_points": [[0,0,0],[1,0,0]]}"#.into(), &["b.knots"]),
        (r#"{"type": "nurbs", "degree": 1.5, "knots": [0, 0, 1, 1], "control_points": [[0,0,0],[1,0,0]]}"#.into(), &["b.degree", "1.5"]),
        (r#"{"type": "nurbs", "degree": 1, "knots": [0, 0, 1, 1], "control_points": [[0,0,0],[1,0,0]], "closed": true}"#.into(), &["b.closed", "do not meet"]),
        (r#"{"type": "bezier_surface", "control_points": [[[0,0,0],[1,0,0]],[[0,1,0]]]}"#.into(), &["b.control_points", "row 1"]),
        (r#"{"type": "quad4", "nodes": [[0,0,0],[1,0,0],[1,1,0]]}"#.into(), &["b.nodes", "3 points instead of 4"]),
        (r#"{"type": "triangle_mesh", "vertices": [[0,0,0]], "triangles": [[0, 1, 2]]}"#.into(), &["b.triangles", "vertex 1"]),
        (r#"{"type": "triangle_mesh", "file": "missing.stl"}"#.into(), &["b.file", "missing.stl"]),
        (r#"{"type": "implicit", "body": "x^2 +", "box": [[-1,-1,-1],[1,1,1]]}"#.into(), &["b.body.value", "x^2 +"]),
        (r#"{"type": "implicit", "body": "x^2 + 1", "box": [[-1,-1,-1],[1,1,1]]}"#.into(), &["b.box", "does not enter"]),
        (r#"{"type": "implicit", "body": {"union": []}, "box": [[-1,-1,-1],[1,1,1]]}"#.into(), &["b.body.union", "empty"]),
        (r#"{"type": "cone", "o": [0,0,0], "ex": [1,0,0], "ey": [0,1,0], "sin": 1, "cos": 1, "range": [[0,1],[0,1]]}"#.into(), &["b.sin"]),
    ];
    let mut cases = vec![GOOD.to_string()];
    for (k, (partner, _)) in partners.iter().enumerate() {
        cases.push(format!(r#"{{"id": "bad {k}", {point}, "b": {partner}}}"#));
    }
    let cases: Vec<String> = cases.into_iter().chain([GOOD.replace("good", "last")]).collect();
    let (report, answers) = run(&corpus(&cases.iter().map(String::as_str).collect::<Vec<_>>()));
    let report = report.unwrap();
    assert_eq!(report.wrong_count, partners.len(), "{:?}", report.wrong);
    assert!((answers["good"]["distance"].as_f64().unwrap() - 5f64.sqrt()).abs() < 1e-15);
    assert_eq!(answers["good"]["distance"], answers["last"]["distance"]);
    for (k, (partner, words)) in partners.iter().enumerate() {
        let error = answers[format!("bad {k}")]["error"].as_str().unwrap_or_else(|| panic!("{partner} was accepted"));
        for word in *words {
            assert!(error.contains(word), "{partner}\n  {error}\n  does not mention {word}");
        }
    }
}

#[test]
fn cases_that_are_no_queries_are_named() {
    let (report, answers) = run(&corpus(&[
        GOOD,
        GOOD,
        r#"{"id": "odd", "colour": 1, "a": {"type": "point", "p": [0,0,1]}, "b": {"type": "point", "p": [0,0,0]}}"#,
        r#"{"id": "pair", "pair": "point-curve", "a": {"type": "point", "p": [0,0,1]}, "b": {"type": "point", "p": [0,0,0]}}"#,
        r#"{"id": "cut", "a": {"type": "point", "p": [0,0,1}}"#,
        "17",
    ]));
    let report = report.unwrap();
    assert_eq!((report.answered, report.wrong_count), (6, 5), "{:?}", report.wrong);
    let text = answers.to_string();
    for word in ["given twice", "unknown key", "but the shapes are a point-point", "not JSON", "an object"] {
        assert!(text.contains(word), "{word}: {text}");
    }
}

const TETRAHEDRON: &str = r#"{"type": "triangle_mesh", "vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]],
    "triangles": [[0,2,1],[0,1,3],[0,3,2],[1,2,3]]}"#;

#[test]
fn shapes_have_names() {
    let file = |shapes: &str, b: &str| {
        format!(
            r#"{{"format": "cpp-corpus-1", {shapes} "cases": [
                {{"id": "one", "a": {{"type": "point", "p": [0.1, 0.2, -2]}}, "b": {b}}}]}}"#
        )
    };
    let shapes = format!(r#""shapes": {{"body": {TETRAHEDRON}}},"#);
    let (report, named) = run(&file(&shapes, r#""body""#));
    assert_eq!(report.unwrap().wrong_count, 0, "{named}");
    assert_eq!(named["one"]["gap"], 2.0);
    assert_eq!(named, run(&file("", TETRAHEDRON)).1);
    for (shapes, b, words) in [
        (&*shapes, r#""bodi""#, "b: no shape is called `bodi`: did you mean `body`?"),
        ("", r#""body""#, "b: no shape is called `body`: the file has no `shapes`"),
    ] {
        assert_eq!(run(&file(shapes, b)).1["one"]["error"], words);
    }
    // Shapes that are wrong end everything, with their line.
    let folder = tempfile::tempdir().unwrap();
    let (queries, answers) = (folder.path().join("q.json"), folder.path().join("a.json"));
    for (shapes, words) in [
        (r#""shapes": {"s": {"type": "point"}},"#, "line 1: shapes.s.p: missing"),
        ("\n\"shapes\": {\"s\": {\"type\": \"circel\"}},", "line 2: shapes.s.type: `circel`"),
        (r#""shapes": [],"#, "line 1: shapes: an array of 0 instead of an object"),
        (r#""shapes": {"s": {"type": "point", "p": [0,0,0]}, "s": 1},"#, "shapes.s: given twice"),
        (r#""cases": [], "shapes": {},"#, "line 1: `shapes` comes after `cases`"),
    ] {
        std::fs::write(&queries, file(shapes, r#""s""#)).unwrap();
        let error = answer_file(&queries, &answers, &Query::default(), &mut |_| true).unwrap_err().to_string();
        assert!(error.contains(words), "{error}");
    }
}

#[test]
fn points_of_a_file_are_answered_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    std::fs::write(path("body.json"), TETRAHEDRON).unwrap();
    std::fs::write(path("points.csv"), "x;y;z\n0,1;0,2;-2\n-1;0,25;0,5\n").unwrap();
    let answer = |points: &str, shape: &str, answers: &str| {
        answer_points(&path(points), &path(shape), &path(answers), &Query::default(), &mut |_| true)
    };
    let report = answer("points.csv", "body.json", "answers.json").unwrap();
    assert_eq!((report.answered, report.not_unique), (2, 0));
    let json: Value = serde_json::from_str(&std::fs::read_to_string(path("answers.json")).unwrap()).unwrap();
    assert_eq!((&json["0"]["gap"], &json["1"]["xb"]), (&json!(2.0), &json!([0.0, 0.25, 0.5])));

    for word in json["0"].as_object().unwrap().keys().map(String::as_str).chain(["id", "error", "shapes", "--to"]) {
        assert!(signorini::explain::explain(word).is_ok(), "{word}");
    }

    answer("points.csv", "body.json", "answers.csv").unwrap();
    let csv = std::fs::read_to_string(path("answers.csv")).unwrap();
    let rows: Vec<Vec<&str>> = csv.lines().map(|l| l.split(',').collect()).collect();
    assert_eq!(
        (rows.len(), &rows[0][..3], &rows[2][..3]),
        (3, &["id", "distance", "gap"][..], &["1", "1.0", "1.0"][..])
    );
    assert!(rows.iter().all(|r| r.len() == rows[0].len()), "{csv}");

    // Rows of 8 + 8 + 16 + 16 + 24 + 24 + 24 + 8 + 8 + 8 + 8 + 14 + 8 + 8 + 8 + 8 bytes after a head whose length it tells.
    answer("points.csv", "body.json", "answers.npy").unwrap();
    let npy = std::fs::read(path("answers.npy")).unwrap();
    let start = 10 + usize::from(u16::from_le_bytes([npy[8], npy[9]]));
    assert_eq!((start % 64, npy.len()), (0, start + 2 * 198));
    let head = std::str::from_utf8(&npy[10..start]).unwrap();
    assert!(head.contains("('gap', '<f8'), ('a', '<f8', (2,))") && head.contains("'shape': (2,)"), "{head}");
    let number = |at: usize| f64::from_le_bytes(npy[start + at..][..8].try_into().unwrap());
    assert!((number(0), number(8), number(198 + 8)) == (2.0, 2.0, 1.0) && number(16).is_nan());
    assert_eq!(&npy[start + 120..][..16], b"point\0\0\0interior");

    // The queries of a file are answered in tables too; a wrong one is a row without numbers.
    let wrong = r#"{"id": "wrong, indeed", "a": {"type": "point", "p": [0, 0]}, "b": {"type": "point"}}"#;
    std::fs::write(path("queries.json"), corpus(&[GOOD, wrong])).unwrap();
    for name in ["table.csv", "table.npy"] {
        let report = answer_file(&path("queries.json"), &path(name), &Query::default(), &mut |_| true).unwrap();
        assert_eq!((report.answered, report.wrong_count), (2, 1));
    }
    let csv = std::fs::read_to_string(path("table.csv")).unwrap();
    let blank = ",".repeat(25);
    assert!(csv.ends_with(&format!("\n\"wrong, indeed\"{blank}a.p: 2 numbers instead of 3\n")), "{csv}");
    assert_eq!(std::fs::read(path("table.npy")).unwrap().len(), npy.len());

    std::fs::write(path("points.csv"), "1,2,3\n4,5\n").unwrap();
    let error = answer("points.csv", "body.json", "none.npy").unwrap_err().to_string();
    assert!(error.contains("points.csv: line 2: 2 entries") && !path("none.npy").exists(), "{error}");
    let error = answer("points.csv", "body.iges", "none.npy").unwrap_err().to_string();
    assert!(error.contains("body.iges: `iges` is not a format of shapes"), "{error}");
}

#[test]
fn a_truncated_file_keeps_what_was_answered() {
    let text = corpus(&[GOOD, GOOD]);
    let (report, answers) = run(&text[..text.len() - 60]);
    let error = report.unwrap_err().to_string();
    assert!(error.contains("truncated") && error.contains("1 cases before"), "{error}");
    assert!(answers["good"]["distance"].is_number());
    let missing = answer_file(Path::new("missing.json"), Path::new("unused.json"), &Query::default(), &mut |_| true);
    assert!(matches!(missing, Err(QueriesError::Open { .. })));
}

#[test]
fn degenerate_shapes_are_answered_as_what_they_are() {
    let p = r#""a": {"type": "point", "p": [0,0,1]}"#;
    let (report, answers) = run(&corpus(&[
        &format!(r#"{{"id": "segment", {p}, "b": {{"type": "segment", "p0": [0,0,0], "p1": [0,0,0]}}}}"#),
        &format!(r#"{{"id": "bezier", {p}, "b": {{"type": "bezier", "control_points": [[0,0,0],[0,0,0],[0,0,0]]}}}}"#),
        &format!(r#"{{"id": "quad", {p}, "b": {{"type": "quad4", "nodes": [[0,0,0],[0,0,0],[0,0,0],[0,0,0]]}}}}"#),
        &format!(r#"{{"id": "triangle", {p}, "b": {{"type": "tri3", "nodes": [[0,0,0],[0,0,0],[0,0,0]]}}}}"#),
        &format!(r#"{{"id": "line", {p}, "b": {{"type": "tri3", "nodes": [[-1,0,0],[1,0,0],[3,0,0]]}}}}"#),
        &format!(
            r#"{{"id": "small", {p}, "b": {{"type": "bezier", "control_points": [[0,0,0],[1e-200,0,0],[0,1e-250,0]]}}}}"#
        ),
        r#"{"id": "far", "a": {"type": "point", "p": [1e300,0,0]}, "b": {"type": "point", "p": [-1e300,1e300,0]}}"#,
    ]));
    assert_eq!(report.unwrap().wrong_count, 0, "{answers}");
    for id in ["segment", "bezier", "quad", "triangle", "line", "small"] {
        let distance = answers[id]["distance"].as_f64().unwrap();
        assert!((distance - 1.0).abs() < 1e-14, "{id}: {distance}");
    }
    assert!((answers["far"]["distance"].as_f64().unwrap() / (5f64.sqrt() * 1e300) - 1.0).abs() < 1e-15);
}

#[test]
fn meshes_and_implicit_bodies_have_a_signed_gap() {
    let mesh = r#"{"type": "triangle_mesh", "vertices": [[0,0,0],[1,0,0],[0,1,0],[0,0,1]], "triangles": [[0,2,1],[0,1,3],[0,3,2],[1,2,3]]}"#;
    let inside = r#"{"type": "point", "p": [0.1, 0.2, 0.2]}"#;
    let outside = r#"{"type": "point", "p": [-1, 0.2, 0.2]}"#;
    let body = r#"{"type": "implicit", "box": [[-3,-3,-3],[3,3,3]], "body": {"difference": ["#;
    let ball = |x: f64| format!(r#"{{"value": "(x - {x})^2 + y^2 + z^2 - 1"}}"#);
    let (report, answers) = run(&corpus(&[
        &format!(r#"{{"id": "in", "a": {inside}, "b": {mesh}}}"#),
        &format!(r#"{{"id": "out", "a": {outside}, "b": {mesh}}}"#),
        &format!(
            r#"{{"id": "implicit", "a": {{"type": "point", "p": [2.5, 0, 0]}}, "b": {body}{}, {}]}}}}}}"#,
            ball(0.0),
            ball(-1.0)
        ),
        &format!(r#"{{"id": "curve", "a": {{"type": "segment", "p0": [-1,-1,2], "p1": [1,1,2]}}, "b": {mesh}}}"#),
    ]));
    assert_eq!(report.unwrap().wrong_count, 0, "{answers}");
    assert!((answers["in"]["gap"].as_f64().unwrap() + 0.1).abs() < 1e-15);
    assert!((answers["out"]["gap"].as_f64().unwrap() - 1.0).abs() < 1e-15);
    assert!((answers["implicit"]["gap"].as_f64().unwrap() - 1.5).abs() < 1e-13);
    assert!((answers["curve"]["distance"].as_f64().unwrap() - 1.0).abs() < 1e-14);
}

/// Cases with a few bytes changed, dropped or doubled: read or refused, and answered, without a panic.
#[test]
fn mutilated_cases_are_read_or_refused() {
    use signorini::queries::parse;
    use signorini_geometry::closest::closest;
    let cases: Value = serde_json::from_str(include_str!("../data/closest_points.json")).unwrap();
    let mut state = 7u64;
    let mut random = |n: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((state >> 33) as usize) % n
    };
    let alphabet = b"0123456789.-+eE[]{},:\"anul";
    let mut read = 0;
    for case in cases["cases"].as_array().unwrap() {
        let kept = json!({"id": case["id"], "a": case["a"], "b": case["b"]});
        let text = kept.to_string().into_bytes();
        for _ in 0..12 {
            let mut bytes = text.clone();
            for _ in 0..1 + random(3) {
                let at = random(bytes.len());
                match random(4) {
                    0 => drop(bytes.remove(at)),
                    1 => bytes.insert(at, alphabet[random(alphabet.len())]),
                    _ => bytes[at] = alphabet[random(alphabet.len())],
                }
            }
            if let Ok(query) = parse(&bytes, Path::new("")) {
                let answer = closest(&query.a, &query.b, &Query::default());
                assert!(answer.distance().is_finite(), "{}", String::from_utf8_lossy(&bytes));
                read += 1;
            }
        }
    }
    assert!(read > 500, "{read} of the mutilated cases were still queries");
}
