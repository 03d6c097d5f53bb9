//! The problems of `signorini verify`.

use signorini::verify::{PROBLEMS, verify};

/// What a user is shown as right is right.
#[test]
fn all_problems_with_known_answers_hold() {
    let folder = tempfile::tempdir().unwrap();
    for (k, problem) in PROBLEMS.iter().enumerate() {
        let found = verify(problem, &folder.path().join(k.to_string())).unwrap();
        assert!(found.holds(), "{}: {} for {}", found.name, found.found, found.exact);
    }
}
