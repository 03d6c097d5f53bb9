//! Of `history::mergers`.

use signorini_membrane::testing::at_zero;

#[test]
fn parabolas_and_lines_vanish_where_they_do() {
    let t = |m: f64| 0.3 - 0.7 * m + 0.2 * m * m;
    let points: Vec<(f64, f64)> = [0.4, 0.3, 0.1].iter().map(|m| (*m, t(*m))).collect();
    assert!((at_zero(&points) - 0.3).abs() < 1e-15);
    assert!((at_zero(&points[1..]) - 0.3).abs() < 0.01);
}
