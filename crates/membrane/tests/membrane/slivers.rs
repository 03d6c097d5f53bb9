//! Cuts that leave only slivers: the system stays positive definite, whatever the degree.

use signorini_fem::{Cells, Grid, RefinedGrid};
use signorini_geometry::{Aabb, ClosedCurve, Ellipsoid, HalfSpace, Point, Vector};
use signorini_membrane::domain::{Domain, DomainOnCells, ImplicitDomain};
use signorini_membrane::equilibrium::{Elements, Equilibrium};
use signorini_membrane::field::Constant;
use signorini_membrane::obstacle::{Obstacle, Obstacles, Side};
use signorini_membrane::plane_zone::PlaneZone;
use signorini_membrane::problem::{Measure, Membrane, Support};
use signorini_membrane::zone::Zone;
use std::sync::Arc;

/// A half plane cut by a straight edge; the other sides are free, so the solution is the height of the
/// support.
fn error(degree: usize, normal: Vector<2>, offset: f64, divided: bool) -> f64 {
    let bounds = Aabb::new(Point::<2>::new(0.0, 0.0), Point::<2>::new(1.0, 1.0));
    let grid = Grid::new(bounds, [8, 8], degree);
    let edge = HalfSpace { point: Point::<2>::new(0.5, 0.5) + offset * normal, normal };
    let domain: Arc<dyn Domain<2>> = Arc::new(ImplicitDomain(edge));
    // Divided towards a point near the edge, so that it cuts cells of four sizes.
    let near = |b: &Aabb<2>, level: usize| level < 3 && (b.center() - Point::<2>::new(0.43, 0.53)).norm() < b.radius();
    let cells: Arc<dyn Cells<2>> =
        if divided { Arc::new(RefinedGrid::new(&grid, near)) } else { Arc::new(grid.clone()) };
    let exact = 0.3;
    let displacement = Arc::new(Constant(exact));
    let membrane = Membrane {
        sizing: None,
        domain: DomainOnCells::new(domain, &*cells),
        cells,
        grid: grid.clone(),
        measure: Measure::Plain,
        tension: Arc::new(Constant(1.0)),
        load: Arc::new(Constant(0.0)),
        obstacles: Obstacles::default(),
        supports: vec![Some(Support { index: 0, displacement })],
        support_count: 1,
        modes: Default::default(),
        formulation: Default::default(),
    };
    let zone = PlaneZone::empty(&grid);
    let mut elements = Elements::new(&membrane);
    let state = Equilibrium::solve(&membrane, &zone, &mut elements)
        .unwrap_or_else(|e| panic!("degree {degree}, offset {offset:e}: {e}"));
    let mut worst = 0.0f64;
    state.for_each_point(|cell, region, x, _| {
        let u = state.evaluate(cell, region, x).map_or(f64::NAN, |v| v.0);
        worst = worst.max((u - exact).abs());
    });
    worst
}

#[test]
fn straight_cuts_of_every_thickness() {
    let diagonal = Vector::<2>::new(1.0, 1.0).normalize();
    let slanted = Vector::<2>::new(0.03, 1.0).normalize();
    for degree in 1..=6 {
        for normal in [Vector::<2>::new(1.0, 0.0), Vector::<2>::new(0.0, -1.0), diagonal, slanted] {
            for offset in [1e-12, 1e-8, 1e-4, 1e-2, 0.03, 0.0625, 0.09, 0.12, 0.125 - 1e-9, -1e-10] {
                for divided in [false, true] {
                    let worst = error(degree, normal, offset, divided);
                    assert!(
                        worst < 1e-7,
                        "degree {degree}, normal {normal:?}, offset {offset:e}, {divided}: {worst:e}"
                    );
                }
            }
        }
    }
}

/// Between a front and a free edge lies a ring that no cell holds well. It hangs on the front alone, so it has the height of
/// the floor.
#[test]
fn thin_rings_along_a_free_edge_are_held() {
    let bounds = Aabb::new(Point::<2>::new(-1.03, -1.03), Point::<2>::new(1.03, 1.03));
    for degree in 1..=4 {
        for thickness in [1e-9, 1e-6, 1e-4, 1e-3, 4e-3, 0.01, 0.02, 0.05] {
            let grid = Grid::new(bounds, [12, 12], degree);
            let disc = Ellipsoid { center: Point::zeros(), semi_axes: [1.0, 1.0] };
            let domain: Arc<dyn Domain<2>> = Arc::new(ImplicitDomain(disc));
            let floor = Obstacle { side: Side::Below, height: Arc::new(Constant(-0.1)), adhesion: None };
            let membrane = Membrane {
                sizing: None,
                domain: DomainOnCells::new(domain, &grid),
                cells: Arc::new(grid.clone()),
                grid,
                measure: Measure::Plain,
                tension: Arc::new(Constant(1.0)),
                load: Arc::new(Constant(0.0)),
                obstacles: Obstacles(vec![floor]),
                supports: vec![None],
                support_count: 0,
                modes: Default::default(),
                formulation: Default::default(),
            };
            let front: Vec<Point<2>> = (0..48)
                .map(|k| {
                    let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 48.0).sin_cos();
                    (1.0 - thickness) * Point::<2>::new(cos, sin)
                })
                .collect();
            let zone = PlaneZone::new(&membrane.grid, vec![(Side::Below, ClosedCurve::through(&front, 9))]);
            let state = Equilibrium::solve(&membrane, &zone, &mut Elements::new(&membrane))
                .unwrap_or_else(|e| panic!("degree {degree}, thickness {thickness:e}: {e}"));
            state.for_each_point(|cell, region, x, _| {
                let Some((u, _)) = state.evaluate(cell, region, x) else { return };
                assert!((u + 0.1).abs() < 1e-7, "degree {degree}, thickness {thickness:e}: {u}");
            });
        }
    }
}
