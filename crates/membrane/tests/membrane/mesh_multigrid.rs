//! Multigrid on meshes from a file with every cell divided into four, again and again.

use crate::common::{cells, on_mesh, quadrilaterals};
use crate::cycles::{beside_the_direct_solver, circle, contraction};
use signorini_geometry::{ClosedCurve, Jet, Point, Real};
use signorini_membrane::equilibrium::Elements;
use signorini_membrane::field::Formula;
use signorini_membrane::ils::{self, Reason, Start, StoppingRule};
use signorini_membrane::multigrid::{OnMesh, nested};
use signorini_membrane::obstacle::{Obstacle, Side};
use signorini_membrane::plane_zone::PlaneZone;
use signorini_membrane::problem::Membrane;
use signorini_membrane::report::Report;
use signorini_membrane::zone::{Zone, ZoneSizes};
use signorini_solve::Silent;
use signorini_verify::order::fitted;
use std::sync::Arc;

fn zone(membrane: &Membrane<2>, front: ClosedCurve) -> PlaneZone {
    PlaneZone::new(&membrane.grid, vec![(Side::Below, front)]).on_grid(&membrane.grid)
}

/// Triangles and quadrilaterals, straight and with curved sides, cut at random.
#[test]
fn a_cycle_leaves_a_sixth_whatever_is_cut() {
    let cuts = std::env::var("SIGNORINI_CUTS").ok().and_then(|v| v.parse().ok()).unwrap_or(5);
    let meshes = [
        ("triangles_2_6", 1, 3),
        ("triangles_2_12", 1, 2),
        ("triangles_1_6", 1, 4),
        ("mixed_2_6", 1, 3),
        ("triangles_2_6", 2, 2),
        ("triangles_1_6", 2, 3),
        ("mixed_2_6", 2, 2),
    ];
    let named = meshes.map(|(name, degree, divisions)| (name, degree, divisions, cells(name, degree, divisions)));
    let skew = [(1, 3), (2, 2), (3, 2), (4, 1)]
        .map(|(degree, divisions)| ("skew quadrilaterals", degree, divisions, quadrilaterals(degree, divisions)));
    for (name, degree, divisions, cells) in named.into_iter().chain(skew) {
        let membrane = on_mesh(cells);
        let rates = (0..cuts).map(|k| {
            let t = f64::from(k);
            let center = Point::<2>::new(0.2 * (1.3 * t).sin(), 0.2 * (2.1 * t).cos());
            let radius = |a: f64| 0.45 + 0.1 * (0.7 * t).sin() * (2.0 * a + t).cos() + 0.04 * (3.0 * a).sin();
            contraction::<OnMesh>(&membrane, &zone(&membrane, circle(center, radius, 48)))
        });
        let worst = rates.fold(0.0, f64::max);
        println!("{name} of degree {degree} divided {divisions} times: at most {worst:.3}");
        assert!(worst < 0.17, "{name} of degree {degree} divided {divisions} times: {worst}");
    }
}

#[test]
fn the_solution_is_that_of_the_direct_solver() {
    for name in ["triangles_2_6", "mixed_2_6"] {
        let mut membrane = on_mesh(cells(name, 1, 2));
        let c = |v: f64| Jet::<2>::constant(v);
        membrane.load = Arc::new(Formula(move |[x, y]: [Jet<2>; 2]| c(-1.0) + c(0.3) * x - c(0.2) * y));
        let zone = zone(&membrane, circle(Point::<2>::new(0.1, 0.0), |a| 0.5 + 0.05 * (3.0 * a).cos(), 40));
        let (worst, points, left) = beside_the_direct_solver::<OnMesh>(&membrane, &zone, 20);
        // Fronts are parabolas within each cell here.
        assert!(points > 1000 && worst < 1e-6, "{name}: {worst:e} at {points} points");
        assert!(left < 1e-12, "{name}: {left:e}");
    }
}

/// The whole contact problem: the front of a round membrane on a flat floor, by the exact radius.
#[test]
fn nested_iteration_finds_the_front() {
    let exact = 0.502_474_357_08;
    let errors = [2, 3, 4].map(|divisions| {
        let membrane = on_mesh(cells("triangles_2_12", 1, divisions));
        assert!(nested::is_able(&membrane));
        let found = nested::solve::<OnMesh>(&membrane, f64::INFINITY, 32, (0, 0.0), &mut Silent);
        let found = found.expect("solves").expect("a state");
        assert!(found.steps.iter().skip(1).all(|s| *s <= 4), "{:?}", found.steps);
        let area: f64 = found.zone.curves().iter().map(|c| c.signed_area()).sum();
        ((area / std::f64::consts::PI).sqrt() - exact).abs()
    });
    assert!(errors[2] < 4e-6, "{errors:?}");
    let seen = fitted(&[0.25, 0.125, 0.0625], &errors);
    assert!(seen > 1.8, "order {seen}, {errors:?}");
}

/// What multigrid finds is what the direct solver finds on the same mesh, to less than the error of that mesh: zones, holes,
/// area, force, and the balance.
#[test]
fn multigrid_and_the_direct_solver_agree() {
    let c = |v: f64| Jet::<2>::constant(v);
    let wavy = move |[x, y]: [Jet<2>; 2]| {
        let cos = |v: Jet<2>| {
            let a = c(std::f64::consts::TAU) * v;
            a.chain(a.value.cos(), -a.value.sin(), -a.value.cos())
        };
        c(-0.015) - c(0.005) * cos(x) * cos(y)
    };
    let load = |v: f64| Arc::new(Formula(move |_: [Jet<2>; 2]| c(v)));
    let mut waves = on_mesh(cells("triangles_2_12", 1, 3));
    waves.obstacles.0[0].height = Arc::new(Formula(wavy));
    waves.load = load(-0.4);
    let mut ceiling = on_mesh(cells("mixed_2_12", 1, 2));
    ceiling.obstacles.0[0] = Obstacle { side: Side::Above, height: Arc::new(Formula(move |_| c(0.1))), adhesion: None };
    ceiling.load = load(1.0);
    let mut ring = on_mesh(cells("annulus", 1, 2));
    ring.obstacles.0[0].height = Arc::new(Formula(move |[x, _]: [Jet<2>; 2]| c(-0.05) + c(0.005) * x));
    let uneven = |degree: usize, divisions: usize| {
        let mut membrane = on_mesh(cells("mixed_2_6", degree, divisions));
        membrane.tension = Arc::new(Formula(move |[x, y]: [Jet<2>; 2]| c(1.0) + c(0.5) * x - c(0.3) * y * y));
        membrane
    };
    let mut waves_of_degree_2 = on_mesh(cells("triangles_2_12", 2, 2));
    waves_of_degree_2.obstacles.0[0].height = Arc::new(Formula(wavy));
    waves_of_degree_2.load = load(-0.4);
    let cases = [
        ("waves", waves, [2e-5, 5e-5]),
        ("uneven tension", uneven(1, 3), [2e-5, 5e-5]),
        ("ceiling", ceiling, [2e-5, 5e-5]),
        ("ring", ring, [2e-5, 5e-5]),
        ("waves, degree 2", waves_of_degree_2, [1e-8, 1e-8]),
        ("uneven tension, degree 2", uneven(2, 2), [1e-8, 1e-8]),
        ("quadrilaterals, degree 3", on_mesh(quadrilaterals(3, 2)), [1e-8, 1e-8]),
        ("quadrilaterals, degree 4", on_mesh(quadrilaterals(4, 2)), [1e-8, 1e-8]),
    ];
    for (name, membrane, least) in cases {
        assert!(membrane.cells.as_grid().is_none());
        let found = nested::solution(&membrane, (0, 0.0), &mut Silent).expect("solves");
        let found = found.unwrap_or_else(|| panic!("{name}: no state"));
        assert!(found.multigrid);
        let mut elements = Elements::new(&membrane);
        let direct = ils::solve::<2, PlaneZone>(
            &membrane,
            &mut elements,
            Start::Free,
            StoppingRule::Final,
            (0, 0.0),
            &mut Silent,
        );
        assert_eq!(direct.reason, Reason::Converged, "{name}");
        assert_eq!(found.zone.counts(), direct.zone.counts(), "{name}");
        let [a, b] = [&found, &direct].map(|s| Report::new(s).expect("a report"));
        println!("{name}: {} {}, {} {}", a.area(), b.area(), a.force(), b.force());
        assert!((a.area() - b.area()).abs() < least[0] * b.area(), "{name}: {} {}", a.area(), b.area());
        assert!((a.force() - b.force()).abs() < least[1] * b.force().abs(), "{name}: {} {}", a.force(), b.force());
        assert!(a.equilibrium_residual < 1e-9, "{name}: {:e}", a.equilibrium_residual);
    }
}
/// Cuts where the ghost penalty of degree 4 does not suffice on skew cells, so that thin parts are held as in the direct solver.
#[test]
fn bands_that_are_not_positive_definite_are_held() {
    let membrane = on_mesh(quadrilaterals(4, 3));
    for radius in [0.46, 0.54, 0.56] {
        let front = circle(Point::<2>::new(0.1, 0.05), |a| radius + 0.05 * (3.0 * a).cos(), 48);
        let rate = contraction::<OnMesh>(&membrane, &zone(&membrane, front));
        println!("{radius}: {rate:.3}");
        assert!(rate < 0.17, "{radius}: {rate}");
    }
}
