use super::*;
use crate::cells::Cells;
use crate::ghost::ghost_penalty;
use crate::lagrange::Tabulation;
use signorini_geometry::polygon;
use std::sync::Arc;

fn grid(degree: usize) -> RefinedGrid {
    let bounds = Aabb::new(Point::<2>::new(0.0, -1.0), Point::<2>::new(2.0, 1.0));
    let coarse = Grid::<2>::new(bounds, [4, 3], degree);
    // Towards one point off any line of the grid, and along a slanted line.
    let middle = Point::<2>::new(0.83, 0.11);
    RefinedGrid::new(&coarse, |b, level| {
        let on_line = (b.center()[0] + 0.5 * b.center()[1] - 1.6).abs() < 0.6 * b.radius();
        (b.contains(&middle) && level < 5) || (on_line && level < 2)
    })
}

#[test]
fn leaves_cover_the_box_and_neighbours_differ_by_one_division() {
    let grid = grid(1);
    assert!(grid.levels == 5);
    let area: f64 = (0..grid.count()).map(|c| grid.volume(c)).sum();
    assert!((area - 4.0).abs() < 1e-13);
    for pair in grid.neighbours() {
        let [a, b] = pair.cells.map(|c| i32::from(grid.leaves[c].level));
        assert!((a - b).abs() <= 1);
    }
    for cell in 0..grid.count() {
        assert_eq!(grid.containing(&grid.bounds_of(cell).center()), Some(cell));
    }
    // Every length of inner side is shared by one pair; and the rest is the boundary.
    let outer: f64 = grid.boundary_sides().iter().map(|s| grid.on_side(s, 0.5).tangent.norm()).sum();
    assert!((outer - 8.0).abs() < 1e-12);
}

#[test]
fn functions_are_one_at_their_own_nodes() {
    for degree in [1, 3] {
        let grid = grid(degree);
        let (mut t, mut functions) = (Tabulation::default(), Vec::new());
        for function in 0..grid.function_count() {
            let x = grid.node(function);
            let cell = grid.leaf_containing(&x);
            grid.functions(cell, &mut functions);
            grid.tabulate(cell, &x, &mut t);
            assert!(functions.contains(&(function as u32)));
            for (&f, v) in functions.iter().zip(&t.value) {
                let own = f64::from(u8::from(f as usize == function));
                assert!((v - own).abs() < 1e-9, "degree {degree}, function {function} at {x}: {f} is {v}");
            }
        }
    }
}

#[test]
fn coarser_cells_lack_the_last_divisions() {
    let mut cells: Arc<dyn Cells<2>> = Arc::new(grid(3));
    let smallest = |cells: &dyn Cells<2>| (0..cells.count()).map(|c| cells.size(c)).fold(f64::INFINITY, f64::min);
    for _ in 0..5 {
        let coarser = cells.coarser().expect("divisions");
        assert!((smallest(&*coarser) - 2.0 * smallest(&*cells)).abs() < 1e-14);
        let area: f64 = (0..coarser.count()).map(|c| coarser.volume(c)).sum();
        assert!((area - 4.0).abs() < 1e-13);
        assert_eq!(coarser.degree(), 1);
        cells = coarser;
    }
    // Three cells have no half.
    assert!(cells.coarser().is_none());
}

#[test]
fn outlines_close_across_cells_of_unlike_size() {
    let circle = |x: &Point<2>| (x - Point::<2>::new(1.0, 0.1)).norm() - 0.7;
    let loops = grid(2).linear(8).outlines(&circle).expect("closed outlines");
    assert_eq!(loops.len(), 1);
    let area = polygon::signed_area(&loops[0]) / (std::f64::consts::PI * 0.49);
    assert!((area - 1.0).abs() < 5e-3, "{area}");
    assert!(grid(1).outlines(&|x| x[0] - 1.0).is_none(), "a set that reaches beyond the cells has no closed outline");
}

#[test]
fn functions_are_continuous_and_reproduce_polynomials() {
    for degree in [1, 2, 3, 5] {
        let grid = grid(degree);
        let mut numbers = Vec::new();
        let mut t = Tabulation::default();
        // Coefficients of a polynomial, read at the nodes of cells without hanging ones.
        let f = |x: &Point<2>| (x[0] - 0.3).powi(degree as i32) - x[1].powi(degree as i32 - 1) * x[0] + 1.0;
        let mut u = vec![f64::NAN; grid.function_count()];
        for cell in 0..grid.count() {
            let nodes = grid.nodes(grid.leaves[cell]);
            let b = grid.bounds_of(cell);
            let places = grid.coarse.basis().line_nodes().to_vec();
            grid.functions(cell, &mut numbers);
            for k in 0..nodes.len() {
                let p = degree + 1;
                let x = b.at(&Point::<2>::new(places[k % p], places[k / p]));
                match grid.cells[cell].hanging.get(k) {
                    None => u[numbers[k] as usize] = f(&x),
                    Some(list) if list.len() == 1 => u[numbers[list[0].0 as usize] as usize] = f(&x),
                    _ => {}
                }
            }
        }
        assert!(u.iter().all(|v| v.is_finite()), "degree {degree}: a function without a node");
        let mut value = |cell: usize, x: &Point<2>, u: &[f64]| -> f64 {
            grid.functions(cell, &mut numbers);
            grid.tabulate(cell, x, &mut t);
            numbers.iter().zip(&t.value).map(|(&n, v)| u[n as usize] * v).sum()
        };
        for cell in 0..grid.count() {
            let x = grid.bounds_of(cell).at(&Point::<2>::new(0.3, 0.8));
            assert!((value(cell, &x, &u) - f(&x)).abs() < 1e-11, "degree {degree}");
        }
        // Any coefficients make a continuous function.
        let wild: Vec<f64> = (0..u.len()).map(|i| (i as f64 * 1.7).sin()).collect();
        for pair in grid.neighbours() {
            let [a, b] = pair.cells.map(|c| grid.bounds_of(c));
            let shared = Aabb::new(a.min.sup(&b.min), a.max.inf(&b.max));
            for s in [0.0, 0.21, 0.77, 1.0] {
                let x = shared.at(&Point::<2>::new(s, s));
                let [p, q] = pair.cells.map(|c| value(c, &x, &wild));
                assert!((p - q).abs() < 1e-12, "degree {degree} at {x:?}: {p} {q}");
            }
        }
    }
}

#[test]
fn cells_of_one_size_are_compared_as_on_a_grid() {
    let bounds = Aabb::new(Point::<2>::new(0.0, -1.0), Point::<2>::new(2.0, 1.0));
    for degree in [1, 3] {
        let fine = Grid::<2>::new(bounds, [8, 6], degree);
        let refined = RefinedGrid::new(&Grid::<2>::new(bounds, [4, 3], degree), |_, level| level < 1);
        let on_grid = [0, 1].map(|k| {
            let pairs = fine.neighbours();
            let pair = pairs.iter().find(|p| p.kind == Some(k)).expect("a pair");
            ghost_penalty(&fine, pair)
        });
        for pair in refined.neighbours() {
            let expected = &on_grid[pair.kind.expect("cells of one kind")];
            let penalty = ghost_penalty(&refined, &pair);
            assert!(penalty.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12), "degree {degree}");
        }
    }
}
