//! Of `case::toml_error`.

use signorini_problem::testing::key_before;

/// No name of a type of the program shows in a message.
#[test]
fn wrong_kinds_of_values_are_told_in_words() {
    let head = "space = \"line\"\n[bodies.film.membrane]\ntension = 1.0\n";
    for (line, expected) in [
        ("degree = \"two\"", "expected a whole number, found the text `two`"),
        ("degree = 0.5", "expected a whole number, found `0.5`"),
        ("degree = [1]", "expected a whole number, found a list"),
        ("mesh.grid = 5", "expected a table of keys, found `5`"),
        ("mesh.grid = { cells = 40 }", "expected a list in brackets, found `40`"),
        ("domain = 3", "choice"),
        ("domain = {}", "choice"),
        ("domain = { disc.radius = 1, interval.to = 2 }", "exactly one key"),
        ("domain = \"disk\"", "unknown word `disk`"),
        ("domain.disk.radius = 3", "unknown key `disk`"),
        ("mesh.grid = { cells = [10], refine = 3 }", "expected a table of keys, found `3`"),
    ] {
        let text = format!("{head}{line}\n");
        let error = signorini_problem::case::read("case.toml", &text, &[]).expect_err(line);
        assert!(error.message.contains(expected), "{line}: {}", error.message);
        assert!(!error.message.contains("i64") && !error.message.contains("Key"), "{line}: {}", error.message);
    }
}

#[test]
fn the_choices_of_a_key_are_pointed_to() {
    for line in ["domain = 3", "domain = { disc.radius = 1, interval.to = 2 }", "domain={}"] {
        let text = format!("space = \"line\"\n[bodies.film.membrane]\ntension = 1.0\n{line}\n");
        let error = signorini_problem::case::read("case.toml", &text, &[]).expect_err(line);
        assert!(error.help.is_some_and(|h| h.contains("explain domain")), "{line}");
    }
    assert_eq!(key_before("a = { b.c = 1", Some(12..13)), Some("c"));
    assert_eq!(key_before("[1, 2]", Some(4..5)), None);
}
