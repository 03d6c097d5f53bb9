//! Linear solvers: `cargo bench -p signorini-solve`.
//!
//! The matrix of springs between the neighbours of a box of `n × n × n` nodes with three unknowns each, as elastic bodies have it.
//! Columns, in milliseconds: Cholesky factors with the order of elimination of minimum degree and of nested dissection; LU
//! factors; condensation to the unknowns of one side; one solve with the Cholesky factor; conjugate residuals for a matrix that
//! is changed on that side by what is not symmetric, with that factor, and their products. LU factors are left out of
//! more than 6000 unknowns. The largest size is given by `SIGNORINI_LADDER` (unknowns; 16 000 if left out).

use signorini_solve::general::{Analysis, Entries};
use signorini_solve::krylov::conjugate_residuals;
use signorini_solve::{Condensation, SolveError, Symbolic, SymmetricMatrix};
use std::cell::Cell;
use std::time::Instant;

/// More unknowns take LU factors too long.
const MOST_OF_LU: usize = 6000;

/// The elements of the box, and where each unknown is.
fn springs(n: usize) -> (Vec<(Vec<u32>, Vec<f64>)>, Vec<[f64; 3]>) {
    let node = |i: usize, j: usize, k: usize| (i * n + j) * n + k;
    let (mut elements, mut places) = (Vec::new(), Vec::new());
    for (i, j, k) in (0..n * n * n).map(|c| (c / (n * n), c / n % n, c % n)) {
        (0..3).for_each(|_| places.push([i, j, k].map(|x| x as f64)));
        let own: Vec<u32> = (0..3).map(|d| (3 * node(i, j, k) + d) as u32).collect();
        // To the ground.
        elements.push((own.clone(), vec![0.02, 0.0, 0.0, 0.0, 0.02, 0.0, 0.0, 0.0, 0.02]));
        let next = [(i + 1, j, k), (i, j + 1, k), (i, j, k + 1)];
        for (axis, (a, b, c)) in next.into_iter().enumerate().filter(|(_, (a, b, c))| *a.max(b).max(c) < n) {
            let stiffness = |d: usize, e: usize| {
                if d != e {
                    0.1
                } else if d == axis {
                    1.0
                } else {
                    0.4
                }
            };
            let both: Vec<u32> = own.iter().copied().chain((0..3).map(|d| (3 * node(a, b, c) + d) as u32)).collect();
            let sign = |r: usize, c: usize| if (r < 3) == (c < 3) { 1.0 } else { -1.0 };
            let block = (0..36).map(|k| (k / 6, k % 6)).map(|(r, c)| sign(r, c) * stiffness(r % 3, c % 3)).collect();
            elements.push((both, block));
        }
    }
    (elements, places)
}

fn milliseconds<T>(of: impl FnOnce() -> T) -> (f64, T) {
    let start = Instant::now();
    let found = of();
    (1e3 * start.elapsed().as_secs_f64(), found)
}

fn run(n: usize) {
    let (elements, places) = springs(n);
    let size = places.len();
    let matrix = SymmetricMatrix::of_cliques(size, &elements);
    let right: Vec<f64> = (0..size).map(|k| (0.3 * k as f64).cos()).collect();
    let side: Vec<u32> = (0..3 * (n * n) as u32).collect();

    let (by_degree, _) = milliseconds(|| Symbolic::default().factor(matrix.clone()).expect("a factor"));
    let mut symbolic = Symbolic::dissected(places.clone());
    let (dissected, factor) = milliseconds(|| symbolic.factor(matrix.clone()).expect("a factor"));
    let lu = (size <= MOST_OF_LU).then(|| {
        let mut entries = Entries::default();
        elements.iter().for_each(|(unknowns, values)| entries.add_block(unknowns, values));
        milliseconds(|| Analysis::default().factor(entries.matrix(size)).expect("factors")).0
    });
    let (condensed, _) = milliseconds(|| Condensation::new(matrix.clone(), side.clone(), places).expect("a reduction"));
    let (solved, _) = milliseconds(|| factor.solve(&right).expect("a solution"));

    let products = Cell::new(0);
    let product = |x: &[f64]| -> Result<Option<Vec<f64>>, SolveError> {
        products.set(products.get() + 1);
        let mut image = matrix.multiply(x);
        side.windows(2).for_each(|w| image[w[0] as usize] += 0.5 * x[w[1] as usize] + 0.5 * x[w[0] as usize]);
        factor.solve_once(&mut image)?;
        Ok(Some(image))
    };
    let (iterated, found) = milliseconds(|| {
        let mut start = right.clone();
        factor.solve_once(&mut start).and_then(|()| conjugate_residuals(start, product, 1e-12, 120))
    });
    assert!(found.is_ok_and(|x| x.is_some()), "conjugate residuals did not converge");
    println!(
        "{size:>8} {by_degree:>9.1} {dissected:>9.1} {:>9} {condensed:>12.1} {solved:>8.2} {iterated:>12.1} {:>8}",
        lu.map_or("-".to_string(), |lu| format!("{lu:.1}")),
        products.get()
    );
}

fn main() {
    let largest: usize = std::env::var("SIGNORINI_LADDER").ok().and_then(|v| v.parse().ok()).unwrap_or(16_000);
    println!("unknowns  Cholesky dissected        LU condensation    solve    residuals products");
    [6, 9, 12, 17, 24, 32].into_iter().filter(|n| 3 * n * n * n <= largest).for_each(run);
}
