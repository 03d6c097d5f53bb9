//! Of `multigrid::interior`.

use signorini_fem::Grid;
use signorini_geometry::{Aabb, Jet, Point, Real};
use signorini_membrane::field::{Constant, Field, Formula};
use signorini_membrane::testing::{Interior, Run, runs};

/// The equations hold for the harmonic polynomials that the functions can show, on cells that are no squares, and patches
/// leave these as they are; so too where the equations are stored.
#[test]
fn harmonic_polynomials_are_solutions() {
    check(&Constant(1.7));
    check(&Formula(|_: [Jet<2>; 2]| Jet::constant(1.7)));
}

fn check(tension: &dyn Field<2>) {
    let bounds = Aabb::new(Point::<2>::zeros(), Point::<2>::new(1.2, 0.7));
    for p in 1..=8 {
        let grid = Grid::new(bounds, [5, 4], p);
        let interior = Interior::new(&grid, tension).expect("patches");
        let z = |x: &Point<2>| {
            let (mut re, mut im) = (1.0, 0.0);
            for _ in 0..p {
                (re, im) = (re * x[0] - im * x[1], re * x[1] + im * x[0]);
            }
            re + im
        };
        let exact: Vec<f64> = (0..grid.node_count()).map(|n| z(&grid.node(n))).collect();
        let zero = vec![0.0; exact.len()];
        let [columns, rows] = grid.node_counts();
        let inside = runs(rows, columns, |i, j| i > 0 && j > 0 && i < columns - 1 && j < rows - 1);
        let mut r = vec![0.0; exact.len()];
        interior.residual(&inside, &exact, &zero, &mut r);
        assert!(r.iter().all(|v| v.abs() < 1e-10), "degree {p}");
        let vertices = runs(4, 5, |i, j| i > 0 && j > 0);
        let mut u = exact.clone();
        interior.relax(&vertices, &mut u, &zero);
        let moved = u.iter().zip(&exact).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
        assert!(moved < 1e-11, "degree {p}: {moved:e}");
        // From elsewhere the last patches relaxed are solved for.
        u.iter_mut().enumerate().for_each(|(k, v)| *v += (k as f64).sin());
        let last = [Run { row: 1, begin: 3, end: 4 }];
        interior.relax(&last, &mut u, &zero);
        let patch = runs(2 * p, 4 * p, |i, j| i > 2 * p && j > 0);
        interior.residual(&patch, &u, &zero, &mut r);
        for run in patch {
            let row = &r[run.row * columns..][run.begin..run.end];
            assert!(row.iter().all(|v| v.abs() < 1e-9), "degree {p}: {row:?}");
        }
    }
}
