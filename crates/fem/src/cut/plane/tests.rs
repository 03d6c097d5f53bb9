use super::super::Partition;
use super::*;
use crate::Grid;
use signorini_geometry::{Ellipsoid, HalfSpace, ImplicitShape};
use std::f64::consts::PI;

struct Inside<'a>(&'a dyn ImplicitShape<2>);

impl Partition<2> for Inside<'_> {
    fn in_cell(&self, _: usize, _: &Aabb<2>) -> CellPartition<'_, 2> {
        CellPartition {
            sheets: vec![Box::new(self.0)],
            tags: vec![7],
            features: Vec::new(),
            region: Box::new(|_, v| u32::from(v[0] < 0.0)),
        }
    }
}

/// Area, perimeter, and the vector ∫ x·n n over the boundary, on an n × n grid.
fn measures(shape: &dyn ImplicitShape<2>, n: usize, order: usize) -> (f64, f64, Vector<2>, f64) {
    let bounds = Aabb::new(Point::<2>::new(-1.03, -1.03), Point::<2>::new(1.03, 1.03));
    let grid = Grid::<2>::new(bounds, [n, n], 1);
    let partition = Inside(shape);
    let (mut area, mut perimeter, mut closed, mut flux, mut total) = (0.0, 0.0, Vector::zeros(), 0.0, 0.0);
    for cell in 0..grid.cell_count() {
        let b = grid.cell_box(cell);
        let rule = cut_cell(&partition.in_cell(cell, &b), &b, order);
        total += rule.volumes.iter().flat_map(|v| &v.1).map(|p| p.weight).sum::<f64>();
        area += rule.volume(1).iter().map(|p| p.weight).sum::<f64>();
        for p in &rule.surfaces {
            assert_eq!((p.minus, p.plus, p.tag), (1, 0, 7));
            assert!(p.weight > 0.0);
            perimeter += p.weight;
            closed += p.weight * p.normal;
            flux += p.weight * p.normal.dot(&p.x);
        }
    }
    assert!((total - bounds.volume()).abs() < 1e-13);
    (area, perimeter, closed, flux)
}

#[test]
fn circles_of_any_size_have_their_area_and_perimeter() {
    // The third touches grid lines; the last lies within a cell's width.
    for (center, r) in [([0.0, 0.0], 0.6), ([0.01, 0.02], 0.9), ([0.0, 0.0], 0.618), ([0.1, -0.3], 0.2)] {
        let disc = Ellipsoid { center: center.into(), semi_axes: [r, r] };
        let (area, perimeter, closed, flux) = measures(&disc, 10, 9);
        assert!((area - PI * r * r).abs() < 1e-11, "radius {r}: {}", area - PI * r * r);
        assert!((perimeter - 2.0 * PI * r).abs() < 1e-10, "radius {r}: {}", perimeter - 2.0 * PI * r);
        assert!(closed.norm() < 1e-10);
        assert!((flux - 2.0 * area).abs() < 1e-10);
    }
}

#[test]
fn the_error_falls_with_the_order_of_the_rule() {
    let disc = Ellipsoid { center: Point::zeros(), semi_axes: [0.6, 0.6] };
    let error = |order| (measures(&disc, 10, order).1 - 1.2 * PI).abs();
    assert!(error(5) < 1e-7 && error(6) < 0.2 * error(5) && error(8) < 1e-10);
}

#[test]
fn a_straight_line_on_a_grid_line_is_found_once() {
    let line = HalfSpace { point: Point::<2>::new(0.0, 0.0), normal: Vector::<2>::new(1.0, 0.0) };
    let (area, perimeter, ..) = measures(&line, 10, 3);
    assert!((area - 2.06 * 1.03).abs() < 1e-13 && (perimeter - 2.06).abs() < 1e-13);
}
