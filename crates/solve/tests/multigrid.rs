//! V-cycles of Laplace's equation on grids.

use signorini_solve::SymmetricMatrix;
use signorini_solve::krylov::conjugate_gradients;
use signorini_solve::multigrid::{Multigrid, Transfer};

/// Squares of a grid with Laplace's equation, zero around it.
fn grid(n: usize) -> SymmetricMatrix {
    SymmetricMatrix::from_columns(n * n, |j, out| {
        out.push((j, 4.0));
        if (j + 1) % n != 0 {
            out.push((j + 1, -1.0));
        }
        if j + n < n * n {
            out.push((j + n, -1.0));
        }
    })
}

/// Bilinear functions on every second point.
fn halving(n: usize) -> Transfer {
    let m = n / 2;
    let line = |i: usize| -> Vec<(usize, f64)> {
        if i % 2 == 1 { vec![(i / 2, 1.0)] } else { [i / 2, (i / 2).wrapping_sub(1)].map(|c| (c, 0.5)).to_vec() }
            .into_iter()
            .filter(|(c, _)| *c < m)
            .collect()
    };
    let row = |k: usize| {
        let (x, y) = (line(k % n), line(k / n));
        x.iter().flat_map(|(i, v)| y.iter().map(move |(j, w)| ((j * m + i) as u32, v * w))).collect()
    };
    Transfer { columns: m * m, rows: (0..n * n).map(row).collect() }
}

#[test]
fn iterations_do_not_grow_with_the_grid() {
    let mut counts = Vec::new();
    for levels in [3, 4, 5] {
        let n = (4 << levels) - 1;
        let a = grid(n);
        let sizes = (0..levels).scan(n, |n, _| {
            let now = *n;
            *n /= 2;
            Some(now)
        });
        let cycle = Multigrid::new(a.clone(), sizes.map(halving).collect()).unwrap();
        let b: Vec<f64> = (0..n * n).map(|k| ((k * 7 % 13) as f64).sin()).collect();
        let found = conjugate_gradients(&b, |x| a.multiply(x), |r| cycle.apply(r), 1e-8, 100);
        let Ok(found) = found else { panic!() };
        let image = a.multiply(&found.x);
        assert!(image.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-5));
        counts.push(found.iterations);
    }
    assert!(counts.iter().all(|c| *c <= 12), "{counts:?}");
}

#[test]
fn the_cycle_is_symmetric() {
    let n = 31;
    let cycle = Multigrid::new(grid(n), vec![halving(n), halving(n / 2)]).unwrap();
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let x: Vec<f64> = (0..n * n).map(|k| (k as f64).sin()).collect();
    let y: Vec<f64> = (0..n * n).map(|k| (1.7 * k as f64).cos()).collect();
    let [a, b] = [dot(&y, &cycle.apply(&x).unwrap()), dot(&x, &cycle.apply(&y).unwrap())];
    assert!((a - b).abs() < 1e-10 * a.abs(), "{a} {b}");
}
