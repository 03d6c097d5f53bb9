//! Of `case::schema`.

use signorini_problem::case::schema::{find, keys};

#[test]
fn every_key_says_what_it_means() {
    let keys = keys();
    assert!(keys.len() > 150, "{}", keys.len());
    let silent: Vec<&str> = keys.iter().filter(|k| k.about.is_empty()).map(|k| k.path.as_str()).collect();
    assert!(silent.is_empty(), "no description: {silent:#?}");
    let unknown: Vec<&str> = keys.iter().filter(|k| k.kind.is_empty()).map(|k| k.path.as_str()).collect();
    assert!(unknown.is_empty(), "no kind: {unknown:#?}");
}

#[test]
fn keys_are_found_by_their_end() {
    let paths = |word: &str| find(word).into_iter().map(|k| k.path).collect::<Vec<_>>();
    assert_eq!(paths("membrane.tension"), ["bodies.NAME.membrane.tension"]);
    assert_eq!(paths("bodies.film.membrane.tension"), ["bodies.NAME.membrane.tension"]);
    assert!(paths("radius").len() > 3);
    assert_eq!(paths("steps.to"), ["steps[].to"]);
    assert!(paths("nonsense").is_empty());
}
