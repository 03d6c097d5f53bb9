//! Of `friction::solve`.

use signorini_contact::WeightedGap;
use signorini_solid::testing::separated;

fn slip(gap: f64, terms: &[(u32, f64)]) -> WeightedGap {
    WeightedGap { gap, weight: 1.0, terms: terms.to_vec(), forces: Vec::new(), node: 0 }
}

#[test]
fn slips_that_supports_hold_are_told() {
    let [x, y] = [slip(0.3, &[(0, 1.0), (2, -0.5)]), slip(0.1, &[(1, 1.0), (3, -0.5)])];
    let both = separated(vec![x.clone(), y.clone()], 1e-7);
    assert_eq!(both, (vec![x.clone(), y], [[1.0, 0.0], [0.0, 1.0]], [false; 2]));
    assert_eq!(separated(vec![x], 1e-7).2, [false; 2]);
    assert_eq!(separated(vec![slip(0.3, &[(0, 1e-9)])], 1e-7).2, [true, false]);
    assert_eq!(separated(vec![slip(0.3, &[]), slip(0.1, &[])], 1e-7).2, [true; 2]);
    // On a plane of symmetry that is skew to the axes both slips are parts of one.
    let (s, c) = 0.4f64.sin_cos();
    let (rows, directions, held) = separated(vec![slip(0.2 * c, &[(0, c)]), slip(0.2 * s, &[(0, s)])], 1e-7);
    assert_eq!((rows.len(), held), (2, [false, true]));
    assert!((directions[0][0] - c).abs() < 1e-15 && (directions[0][1] - s).abs() < 1e-15);
    assert!((rows[0].terms[0].1 - 1.0).abs() < 1e-15 && (rows[0].gap - 0.2).abs() < 1e-15);
    assert!(rows[1].terms.is_empty() && rows[1].gap.abs() < 1e-15);
}
