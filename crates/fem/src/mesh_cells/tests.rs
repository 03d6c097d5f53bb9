use super::*;
use crate::cells::Cells;
use crate::cut::CellPartition;
use crate::cut::RegionId;
use crate::lagrange::Tabulation;
use crate::rules::rule;
use signorini_geometry::{Ellipsoid, ImplicitShape};
use signorini_geometry::{Matrix, Vector};

/// A curved triangle, and beside it a curved quadrilateral with a straight corner, as mesh generators put them at
/// round edges: three of its corners lie on one circle, the Jacobian at the middle one nearly vanishes.
fn cells(degree: usize) -> MeshCells {
    let on_circle = |angle: f64| Point::<2>::new(angle.cos(), angle.sin());
    let [a, b, c] = [0.6, 0.75, 0.9].map(on_circle);
    let inner = Point::<2>::new(0.6, 0.6);
    let beside = Point::<2>::new(0.75, 0.3);
    let mut nodes = vec![a, b, c, inner, beside];
    nodes.extend([on_circle(0.675), on_circle(0.825), 0.5 * (a + inner), 0.5 * (c + inner)]);
    nodes.push(0.25 * (a + b + c + inner));
    nodes.extend([0.5 * (inner + beside) + Point::<2>::new(-0.01, 0.01), 0.5 * (beside + a)]);
    let mut mesh = Mesh::<2>::new(nodes);
    // Tensor order: from `inner` along the side to a, then to c.
    mesh.add_cell(CellShape::Quadrilateral, 2, &[3, 7, 0, 8, 9, 5, 2, 6, 1]);
    mesh.add_cell(CellShape::Triangle, 2, &[3, 4, 0, 10, 11, 7]);
    mesh.check().unwrap();
    MeshCells::new(mesh, degree)
}

#[test]
fn places_are_found_again_also_beside_a_straight_corner() {
    let cells = cells(2);
    assert!(!cells.bent[0].regular && cells.bent[1].regular);
    for cell in 0..2 {
        for (xi, _) in rule(cells.mesh.shape(cell), 9) {
            let x = cells.at(cell, &xi).0;
            let found = cells.local(cell, &x);
            assert!((found[0] - xi[0]).abs() + (found[1] - xi[1]).abs() < 1e-9, "{cell}: {xi:?} {found:?}");
            assert_eq!(cells.containing(&x), Some(cell));
        }
    }
    assert_eq!(cells.containing(&Point::<2>::new(0.0, 0.0)), None);
}

#[test]
fn functions_know_positions_and_their_slopes() {
    // Straight cells, within and a little beyond: functions of degree 1 add up to the position.
    let corners = [[0.0, 0.0], [1.0, 0.1], [1.2, 0.9], [0.1, 1.1], [1.9, 0.3]].map(Point::<2>::from);
    let mut mesh = Mesh::<2>::new(corners.to_vec());
    mesh.add_cell(CellShape::Quadrilateral, 1, &[0, 1, 3, 2]);
    mesh.add_cell(CellShape::Triangle, 1, &[1, 4, 2]);
    mesh.check().unwrap();
    let straight = MeshCells::new(mesh, 1);
    let (mut numbers, mut t) = (Vec::new(), Tabulation::default());
    for (cell, x) in [(0, [0.5, 0.6]), (0, [-0.05, 0.5]), (1, [1.3, 0.4]), (1, [1.5, 0.9])] {
        let x = Point::<2>::from(x);
        straight.functions(cell, &mut numbers);
        straight.tabulate(cell, &x, &mut t);
        let (mut position, mut slopes) = (Point::<2>::zeros(), Matrix::<2>::zeros());
        for ((&f, value), gradient) in numbers.iter().zip(&t.value).zip(&t.gradient) {
            position += *value * straight.node(f as usize);
            slopes += straight.node(f as usize) * gradient.transpose();
        }
        assert!((position - x).norm() < 1e-13, "cell {cell}: {position:?} at {x:?}");
        assert!((slopes - Matrix::<2>::identity()).norm() < 1e-12, "cell {cell}: {slopes:?}");
    }
    // Curved cells: slopes are those of the values.
    let curved = cells(2);
    for cell in 0..2 {
        let x = curved.at(cell, &curved.mesh.shape(cell).centre()).0;
        curved.tabulate(cell, &x, &mut t);
        let slopes = t.gradient.clone();
        for k in 0..2 {
            let values = [-1e-6, 1e-6].map(|d| {
                let mut y = x;
                y[k] += d;
                curved.tabulate(cell, &y, &mut t);
                t.value.clone()
            });
            for (i, slope) in slopes.iter().enumerate() {
                let difference = (values[1][i] - values[0][i]) / 2e-6;
                assert!((difference - slope[k]).abs() < 1e-6 * slope.norm().max(1.0), "cell {cell}, {i}");
            }
        }
    }
}

#[test]
fn parts_of_a_cut_cell_add_up_and_fluxes_balance() {
    let cells = cells(1);
    // Each cuts off another part, the first at the vertex that the triangle and the quadrilateral share.
    for (center, radius) in [([0.62, 0.6], 0.07), ([0.75, 0.3], 0.2), ([0.0, 0.0], 0.93)] {
        let disc = Ellipsoid { center: center.into(), semi_axes: [radius; 2] };
        let partition = CellPartition {
            sheets: vec![Box::new(&disc)],
            tags: vec![0],
            features: Vec::new(),
            region: Box::new(|_, v| RegionId::from(v[0] < 0.0)),
        };
        for cell in 0..2 {
            let rule = cells.cut(cell, &partition, 14);
            let total: f64 = rule.volumes.iter().flat_map(|(_, points)| points).map(|p| p.weight).sum();
            let error = (total - cells.volume(cell)).abs() / cells.volume(cell);
            assert!(error < 1e-9, "{center:?}, cell {cell}: area {error:e}");
            for p in &rule.surfaces {
                let y = (p.x - disc.center) / radius;
                assert!((y.norm() - 1.0).abs() < 1e-9 && (p.normal - y).norm() < 1e-7 && p.minus == 1);
            }
        }
        // The part of the circle within the cells closes the boundary of what is inside.
        let mut flux = Vector::<2>::zeros();
        for cell in 0..2 {
            for p in &cells.cut(cell, &partition, 14).surfaces {
                flux += p.weight * p.normal;
            }
        }
        for side in cells.boundary_sides() {
            let n = 4000;
            for i in 0..n {
                let p = cells.on_side(&side, (i as f64 + 0.5) / n as f64);
                if disc.value(&p.x) < 0.0 {
                    flux += p.normal * (p.tangent.norm() / n as f64);
                }
            }
        }
        assert!(flux.norm() < 2e-4, "{center:?}: {flux:?}");
    }
}

#[test]
fn sides_in_the_same_groups_are_one_piece() {
    let mut mesh = cells(1).mesh;
    mesh.group_mut("arc").sides = vec![Side { cell: 0, side: 1 }, Side { cell: 0, side: 2 }];
    let cells = MeshCells::new(mesh, 1);
    assert_eq!(cells.pieces(), 2);
    let names: Vec<(&str, usize)> = cells.groups().iter().map(|(n, p)| (n.as_str(), p.len())).collect();
    assert_eq!(names, [("arc", 1), ("boundary", 2)]);
}

/// The point next to one outside is on the boundary, and the way to it is along the normal or ends in a corner.
#[test]
fn the_boundary_is_found_from_both_sides() {
    let cells = cells(1);
    let b = *cells.bounds();
    for k in 0..40 {
        let t = 0.157 * f64::from(k);
        let x = b.center() + 0.9 * b.radius() * Point::<2>::new(t.cos(), t.sin());
        let Some(y) = cells.closest_on_boundary(&x, 4.0 * b.radius()) else { panic!("none for {x:?}") };
        let sampled = cells
            .boundary_sides()
            .into_iter()
            .flat_map(|side| (0..=200).map(|i| cells.on_side(&side, f64::from(i) / 200.0).x).collect::<Vec<_>>());
        let least = sampled.map(|z| (z - x).norm()).fold(f64::INFINITY, f64::min);
        // The foot on a curve is known to a fraction of a cell, the samples to one part in two hundred of a side.
        assert!((y - x).norm() <= least + 0.02 * b.radius(), "{x:?}: {} beside {least}", (y - x).norm());
        assert!(cells.closest_on_boundary(&x, 0.9 * least - 0.02 * b.radius()).is_none() || least < 0.03);
    }
}

/// A vertex of the divided mesh is the mean of those of its parent that are named for it: so is a function of degree 1.
#[test]
fn divided_cells_know_the_functions_of_their_parent() {
    let coarse = Arc::new(cells(1));
    let fine = coarse.refined();
    let parent = fine.parent().unwrap();
    let slope = |x: &Point<2>| 0.3 + 0.7 * x[0] - 0.4 * x[1];
    for cell in 0..fine.count() {
        if !coarse.is_straight(cell / 4) {
            continue;
        }
        for &function in fine.corner_functions(cell).iter() {
            let mean: f64 = parent.nodes[function as usize].iter().map(|f| slope(&coarse.node(*f as usize))).sum();
            assert!((0.25 * mean - slope(&fine.node(function as usize))).abs() < 1e-14);
        }
    }
}
