//! Of `report::words`.

use signorini::case::schema::Key;
use signorini::report::words::{keys, words};

#[test]
fn every_key_and_word_says_what_it_means() {
    let silent: Vec<Key> = keys().into_iter().filter(|k| k.about.is_empty() || k.kind.is_empty()).collect();
    assert!(silent.is_empty() && keys().len() > 60, "{silent:#?}");
    assert_eq!(words().iter().filter(|w| w.kind == "reason").count(), 16);
    assert_eq!(words().iter().filter(|w| w.kind == "event").count(), 8);
}
