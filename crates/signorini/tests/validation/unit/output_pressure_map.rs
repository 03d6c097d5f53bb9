//! Of `output::pressure_map`.

use signorini::testing::{directed, distance};

#[test]
fn both_sides_of_a_rim_are_told_apart() {
    // Two lines across a face, between which there is contact, whichever way their pieces run.
    let rim = [[[0.0, 0.2], [0.5, 0.25]], [[1.0, 0.3], [0.5, 0.25]], [[0.0, 0.8], [1.0, 0.8]]];
    for (piece, inwards) in directed(&rim, [0.3, 0.5]) {
        let towards = [0.5 - piece[0][0], 0.5 - piece[0][1]];
        assert!(towards[0] * inwards[0] + towards[1] * inwards[1] > 0.0, "{piece:?} {inwards:?}");
    }
    assert!((distance([2.0, 0.8], rim[2]) - 1.0).abs() < 1e-15);
}
