//! Of `stability`.

use nalgebra::DMatrix;
use signorini_mechanics::stability::{NEUTRAL, Pencil, outermost};
use signorini_mechanics::testing::Admissible;
use signorini_solve::general::Entries;

#[test]
fn the_eigenvalues_nearest_to_zero_are_found_with_their_vectors() {
    // `K` is diagonal but for a pair, `(1.1 2.5; 2.5 1.1)` with -1.4 and 3.6; of the others `K/S` is -6, 2 and one that is
    // neutral.
    let mut tangent = Entries::default();
    for (i, j, v) in [(0, 0, 1.1), (0, 1, 2.5), (1, 0, 2.5), (1, 1, 1.1), (2, 2, -3.0), (3, 3, 8.0), (4, 4, -1e-15)] {
        tangent.add(i, j, v);
    }
    let metric = vec![1.0, 1.0, 0.5, 4.0, 1.0];
    let pencil = Pencil { admissible: Admissible::new(5, &[], &[]), count: 5, multipliers: 0, metric, tangent };
    assert!(pencil.is_symmetric());
    let found = pencil.nearest((-1.0, NEUTRAL), &[-1.0, 0.0, 0.0, 0.0, 0.0]).unwrap();
    assert!((found.value + 1.4).abs() < 1e-6 && found.count == 2, "{}", found.value);
    let half = 0.5f64.sqrt();
    let expected = [-half, half, 0.0, 0.0, 0.0];
    assert!(found.vector.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-3), "{:?}", found.vector);
    let found = pencil.nearest((1.0, NEUTRAL), &[0.0, 0.0, 0.0, 1.0, 0.0]).unwrap();
    assert!((found.value - 2.0).abs() < 1e-6 && (found.vector[3] - 0.5).abs() < 1e-3, "{}", found.value);
}

#[test]
fn the_outermost_eigenvalue_of_a_matrix_that_is_not_symmetric() {
    // Of (1 2; 0 -3) the vector of -3 is (1, -2)/√5.
    let matrix = DMatrix::from_row_slice(2, 2, &[1.0, 2.0, 0.0, -3.0]);
    let (value, vector, count) = outermost(matrix, 1e-9).unwrap();
    assert!((value + 3.0).abs() < 1e-12 && count == 1);
    assert!((vector[0] * -2.0 - vector[1]).abs() < 1e-8, "{vector}");
    assert!(outermost(DMatrix::identity(2, 2), 1e-9).is_none());
}
