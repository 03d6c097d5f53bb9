//! Bad input: every answer names the place, the value and what would be right.

use super::{error, example};
use proptest::prelude::*;
use signorini::case::Document;

/// Replaces a line of the flat disc, and returns the error with the text it points at.
fn spoiled(from: &str, to: &str) -> (String, String, String) {
    let case = example("flat_disc");
    assert!(case.contains(from), "`{from}` is not in the case");
    let error = error(&case.replace(from, to));
    let place = error.place.clone().unwrap_or_else(|| panic!("no place: {}", error.message));
    let at = place.text[place.span.start..place.span.end.min(place.text.len())].to_string();
    (error.message, at, error.help.unwrap_or_default())
}

#[test]
fn each_mistake_is_told_at_its_place() {
    let table = [
        // what stands, what a user writes, a word of the message, the text pointed at, a word of the help
        ("tension = 1.0\n", "", "missing key `tension`", "[bodies.film.membrane]", "tension"),
        ("tension = 1.0", "tensoin = 1.0", "unknown key `tensoin`", "tensoin", "did you mean `tension`"),
        ("tension = 1.0", "tension = [1]", "expected a number", "[1]", ""),
        ("tension = 1.0", "tension = 0.0", "tension must be positive", "0.0", ""),
        ("tension = 1.0", "tension = \"-1 + x\"", "tension must be positive", "\"-1 + x\"", ""),
        ("tension = 1.0", "tension = \"1 N/m\"", "no `units`", "N/m", "units ="),
        ("tension = 1.0", "tension = \"1 + coss(x)\"", "unknown function `coss`", "coss", "`cos`"),
        ("tension = 1.0", "tension = \"1 + (x\"", "expected `)`", "", "not closed"),
        ("tension = 1.0", "tension = nan", "not a finite number", "nan", ""),
        ("tension = 1.0", "tension = \"1 + z\"", "unknown name `z`", "z", ""),
        ("degree = 4", "degree = 9", "between 1 and 6", "9", ""),
        ("degree = 4", "degree = 2.5", "a whole number", "2.5", ""),
        ("cells = [20, 20]", "cells = [0, 20]", "at least one", "0", ""),
        ("cells = [20, 20]", "cells = [20]", "expected 2", "[20]", ""),
        ("cells = [20, 20]", "cells = [1000000, 1000]", "GiB", "[1000000, 1000]", "fewer cells"),
        ("cells = [20, 20]", "cells = [9223372036854775807, 9]", "GiB", "9223372036854775807", "fewer cells"),
        ("cells = [20, 20]", "", "`cells` or `cell_size`", "", "cells ="),
        ("radius = 1.0", "radius = -1.0", "must be positive", "-1.0", ""),
        ("domain.disc = { radius = 1.0 }", "domain.dsic = { radius = 1.0 }", "unknown key `dsic`", "dsic", "`disc`"),
        (
            "domain.disc = { radius = 1.0 }",
            "domain.implicit = { negative_inside = \"x^2 + 1\", min = [-1,-1], max = [1,1] }",
            "domain is empty",
            "",
            "negative inside",
        ),
        (
            "domain.disc = { radius = 1.0 }",
            "domain.polygon = { points = [[0,0],[1,1],[1,0],[0,1]] }",
            "cross each other",
            "",
            "order",
        ),
        ("shape.height = \"-0.1\"", "shape.height = \"0.1\"", "`floor` lies above", "\"0.1\"", "lower it there"),
        (
            "shape.height = \"-0.1\"",
            "shape.height = \"-1/(x-0.3)^2*0 - 0.1 + sqrt(x-0.2)*0\"",
            "it must be a finite",
            "",
            "",
        ),
        ("shape.height = \"-0.1\"", "shape.hieght = \"-0.1\"", "unknown key `hieght`", "hieght", "`height`"),
        ("displacement = 0.0", "displacement = \"t\"", "depends on t", "\"t\"", "[[steps]]"),
        ("on = \"film:boundary\"", "on = \"film:edge\"", "no group `edge`", "\"film:edge\"", "boundary"),
        ("on = \"film:boundary\"", "on = \"flim:boundary\"", "no body `flim`", "\"flim:boundary\"", "`film`"),
        ("between = [\"film\", \"floor\"]", "between = [\"film\", \"flor\"]", "no body `flor`", "\"flor\"", "`floor`"),
        ("space = \"plane\"", "space = \"plain\"", "unknown word `plain`", "\"plain\"", "`plane`"),
        ("space = \"plane\"", "space = \"3d\"", "one of solids", "\"3d\"", "plane"),
        ("space = \"plane\"", "space = \"plane", "string", "", ""),
    ];
    for (from, to, word, place, help) in table {
        let (message, at, remedy) = spoiled(from, to);
        assert!(message.contains(word), "`{to}`: {message}");
        assert!(at.contains(place), "`{to}`: points at `{at}`");
        assert!(remedy.contains(help), "`{to}`: {remedy}");
    }
}

#[test]
fn functions_and_constants_may_not_go_in_circles() {
    let case = example("flat_disc");
    let with = |text: &str| error(&case.replace("space = \"plane\"", &format!("space = \"plane\"\n{text}"))).message;
    assert!(
        with("[functions.a]\nexpression = \"b(t)\"\n[functions.b]\nexpression = \"a(t)\"").contains("calls itself")
    );
    assert!(with("[functions.a]\nexpression = \"a(t) + 1\"").contains("calls itself"));
    assert!(with("[constants]\na = \"b\"\nb = \"a\"").contains("in a circle"));
    assert!(with("[functions.a]\ntable = { t = [0, 0], value = [1, 2] }").contains("does not increase"));
    assert!(with("[functions.a]\ntable = { t = [0], value = [1, 2] }").contains("entries"));
}

#[test]
fn a_load_that_becomes_invalid_later_keeps_what_was_found() {
    let case = example("flat_disc").replace("normal = -1.0", "normal = \"-sqrt(1 - t)\"")
        + "\n[[steps]]\nto = 2.0\nincrements = 4\n";
    let folder = tempfile::tempdir().expect("a folder");
    let out = folder.path().join("out");
    let document = Document::parse("case.toml", &case, &[]).expect("a case");
    let result = signorini::run::run(&document, &out, &mut signorini_solve::Silent);
    assert!(result.is_err());
    let text = std::fs::read_to_string(out.join("summary.json")).expect("a summary");
    let summary: serde_json::Value = serde_json::from_str(&text).expect("JSON");
    assert_eq!(summary["converged"], false);
    assert_eq!(summary["steps"].as_array().map(Vec::len), Some(2));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]
    #[test]
    fn no_text_makes_the_reader_panic(text in "\\PC{0,200}") {
        let _ = Document::parse("case.toml", &text, &[]);
    }

    #[test]
    fn no_damaged_case_makes_the_planner_panic(at in 0usize..600, cut in 0usize..12, put in "[-=.\"a-z0-9\\[\\]{}()*^ ]{0,6}") {
        let case = example("tilted_floor");
        let at = at.min(case.len());
        let end = (at + cut).min(case.len());
        if case.is_char_boundary(at) && case.is_char_boundary(end) {
            let text = format!("{}{}{}", &case[..at], put, &case[end..]);
            if let Ok(document) = Document::parse("case.toml", &text, &[]) {
                let _ = signorini::plan::plan(&document);
            }
        }
    }
}
