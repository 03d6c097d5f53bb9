//! Parts of a set of points: as many in each, and near each other.

use signorini_mechanics::testing::bisected;

#[test]
fn parts_are_even_and_compact() {
    let points: Vec<[f64; 3]> = (0..24 * 12 * 6).map(|k| [k % 24, k / 24 % 12, k / 288].map(f64::from)).collect();
    for parts in [1, 2, 3, 4, 7] {
        let found = bisected(&points, parts);
        let mut counts = vec![0usize; parts];
        found.iter().for_each(|part| counts[*part as usize] += 1);
        let (least, most) = (counts.iter().min().unwrap(), counts.iter().max().unwrap());
        assert!(most - least <= 2, "{parts}: {counts:?}");
        assert_eq!(found, bisected(&points, parts));
    }
    // Two parts are cut across the longest side, four once more across what is then longest.
    assert!(points.iter().zip(bisected(&points, 2)).all(|(x, part)| part == u32::from(x[0] >= 12.0)));
    let quarters = bisected(&points, 4);
    assert!(points.iter().zip(&quarters).all(|(x, part)| *part == u32::from(x[0] >= 12.0) * 2 + part % 2));
}
