//! Answers of closest points: a table, and what is told of them first.

use crate::html::{section, table};
use crate::pieces::{Look, Piece};
use crate::surface::Topology;
use serde_json::Value;
use signorini::output::figure::{figure, figures};

/// More answers than this are not read one by one.
const ROWS: usize = 100;
/// More pairs than this hide each other.
const PAIRS: usize = 5000;

/// How many there are, and how many are wrong, not unique, not certified.
pub fn sentence(answers: &[(String, Value)]) -> (bool, String) {
    let count = |is: &dyn Fn(&Value) -> bool| answers.iter().filter(|a| is(&a.1)).count();
    let wrong = count(&|v| v.get("error").is_some());
    let not_unique = count(&|v| v["unique"] == false);
    let not_certified = count(&|v| v["certified"] == false);
    let text = format!(
        "{} queries: {wrong} wrong, {not_unique} with a pair that is not unique, {not_certified} not certified.",
        answers.len()
    );
    (wrong == 0 && not_certified == 0, text)
}

/// The answers one by one.
pub fn answers(answers: &[(String, Value)]) -> String {
    let head = ["query", "distance", "closest point of a", "closest point of b", "features", "pair"].map(String::from);
    let row = |(id, v): &(String, Value)| -> Vec<String> {
        if let Some(error) = v["error"].as_str() {
            return vec![format!("`{id}`"), "–".into(), String::new(), String::new(), String::new(), error.into()];
        }
        let point = |key: &str| place(&v[key]).map_or(String::new(), |x| figures(&x, None));
        let text = |key: &str| v[key].as_str().unwrap_or_default().to_string();
        let certified = if v["certified"] == false { ", not certified" } else { "" };
        vec![
            format!("`{id}`"),
            v["distance"].as_f64().map_or("–".into(), |d| figure(d, None)),
            point("xa"),
            point("xb"),
            format!("{} – {}", text("feature_a"), text("feature_b")),
            text("uniqueness").replace('_', " ") + certified,
        ]
    };
    let rows: Vec<Vec<String>> = answers.iter().take(ROWS).map(row).collect();
    let note =
        if answers.len() > ROWS { format!("<p class=\"note\">The first {ROWS} answers.</p>") } else { String::new() };
    section("results", "Results", &(table("Closest points", &head, &rows) + &note))
}

/// The pairs as lines.
pub fn pairs(answers: &[(String, Value)]) -> Piece {
    let ends = answers.iter().filter_map(|(_, v)| Some((place(&v["xa"])?, place(&v["xb"])?, v["distance"].as_f64()?)));
    let (mut points, mut gaps) = (Vec::new(), Vec::new());
    for (a, b, gap) in ends.take(PAIRS) {
        points.extend([a, b]);
        gaps.extend([gap, gap]);
    }
    let topology = Topology { lines: (0..points.len() as u32).collect(), ..Topology::default() };
    let fields = vec![("gap".to_string(), gaps)];
    Piece { fields, ..Piece::new("closest pairs", Look::Pair, points, topology) }
}

fn place(value: &Value) -> Option<[f64; 3]> {
    let list: Vec<f64> = value.as_array()?.iter().filter_map(Value::as_f64).collect();
    list.try_into().ok()
}
