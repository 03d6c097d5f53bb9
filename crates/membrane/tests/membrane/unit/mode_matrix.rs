//! Of `mode_matrix`.

use signorini_membrane::testing::{MANY_MODES, ModeMatrix};

#[test]
fn sparse_elimination_solves_what_the_dense_matrix_says() {
    // Rings of overlapping modes, with one that no point of a front sees.
    let n = MANY_MODES + 1;
    let points: Vec<Vec<(usize, f64)>> = (0..4 * MANY_MODES)
        .map(|k| {
            let t = 0.25 * (k % 4) as f64;
            let at = |i: usize| (k / 4 + i) % MANY_MODES;
            // Quadratic splines.
            let values = [0.5 * (1.0 - t).powi(2), 0.5 + t * (1.0 - t), 0.5 * t * t];
            (0..3).map(|i| (at(i), values[i])).collect()
        })
        .collect();
    let factor = |k: usize| 1.0 + (k as f64).sin().powi(2);
    let mut matrix = ModeMatrix::of_products(n, points.iter().map(|p| &p[..]), (0..points.len()).map(factor));
    let products = matrix.dense();
    let value = |p: &[(usize, f64)], mode: usize| p.iter().filter(|(i, _)| *i == mode).map(|(_, v)| v).sum::<f64>();
    for (i, j) in (0..5).flat_map(|i| (0..n).map(move |j| (i, j))) {
        let each = points.iter().enumerate().map(|(k, p)| factor(k) * value(p, i) * value(p, j));
        assert!((products[i * n + j] - each.sum::<f64>()).abs() < 1e-14, "{i}, {j}");
    }
    matrix.add(vec![(vec![MANY_MODES as u32], vec![2.0])]);
    let b: Vec<f64> = (0..n).map(|i| (1.3 * i as f64).cos()).collect();
    let x = matrix.solve(&b).expect("positive definite");
    let dense = matrix.dense();
    for (i, b) in b.iter().enumerate() {
        let row: f64 = (0..n).map(|j| dense[i * n + j] * x[j]).sum();
        assert!((row - b).abs() < 1e-10, "{row} {b}");
        assert_eq!(matrix.diagonal()[i], dense[i * n + i]);
        assert!((row - matrix.multiply(&x)[i]).abs() < 1e-12);
    }
}
