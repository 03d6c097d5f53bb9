//! Of `run::strain`.

use signorini::fields::Fields;
use signorini::testing::largest;

#[test]
fn strains_of_a_linear_displacement_are_exact() {
    let corners = [[0.0, 0.0, 0.0], [2.0, 0.0, 0.0], [0.3, 1.0, 0.0], [0.2, 0.1, 0.7]];
    // Stretched by 7 % along x, shortened by 2 % along y, and turned a little.
    let moved = |x: &[f64; 3]| [0.07 * x[0] - 0.01 * x[1], 0.01 * x[0] - 0.02 * x[1], 0.0];
    for count in [3, 4] {
        let fields = Fields {
            points: corners[..count].to_vec(),
            cells: vec![(None, (0..count as u32).collect())],
            ..Fields::default()
        };
        let fields = fields.vector("displacement", corners[..count].iter().flat_map(moved).collect());
        let found = largest(&fields).unwrap();
        assert!((found.strain - 0.07).abs() < 1e-12, "{found:?}");
        assert!(found.warning("a", 1.0, 2).unwrap().message.contains("7 %"));
    }
}
