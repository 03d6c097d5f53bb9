//! Of `multigrid::runs`.

use signorini_membrane::testing::{Run, common, dilated, find, parts, runs};

fn set(picture: &[&str], member: u8) -> Vec<Run> {
    runs(picture.len(), picture[0].len(), |i, j| picture[j].as_bytes()[i] == member)
}

#[test]
fn parts_that_touch_at_a_corner_are_one() {
    let s = set(&["xx..x..", "..x.x.x", "..x.xx.", "......x"], b'x');
    let part = parts(&s);
    let of = |row: usize, column: usize| find(&s, row, column).map(|k| part[k]);
    assert_eq!([of(0, 2), of(1, 3), of(3, 0)], [None; 3]);
    assert_eq!(of(0, 0), of(2, 2));
    assert_eq!(of(0, 4), of(3, 6));
    assert_eq!(of(0, 4), of(1, 6));
    assert_ne!(of(0, 0), of(0, 4));
}

#[test]
fn what_lies_around_a_set_and_in_common_with_another() {
    let s = set(&[".....", "..x..", ".....", "....."], b'x');
    assert_eq!(dilated(&s, 1, [5, 4]), set(&[".xxx.", ".xxx.", ".xxx.", "....."], b'x'));
    assert_eq!(dilated(&s, 2, [5, 4]), set(&["xxxxx", "xxxxx", "xxxxx", "xxxxx"], b'x'));
    let mut found = Vec::new();
    common(&set(&["xx.xx.x"], b'x'), &set(&[".xxxx.x"], b'x'), |a, b| found.push((a, b)));
    assert_eq!(found, [(1, 2), (3, 5), (6, 7)]);
}
