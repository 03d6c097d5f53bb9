//! Of `error`.

use signorini_problem::error::Place;

#[test]
fn places_are_counted_in_characters() {
    let place = Place { name: "a".into(), text: "ä = 1\nbé = 2".into(), span: 10..11 };
    assert_eq!(place.line_and_column(), (2, 3));
}
