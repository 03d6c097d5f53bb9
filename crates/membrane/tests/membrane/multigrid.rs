//! Multigrid for cut membranes: how much of the error a cycle leaves, whatever is cut.

use crate::cycles::{beside_the_direct_solver, circle, contraction};
use signorini_fem::Grid;
use signorini_geometry::{Aabb, ClosedCurve, Ellipsoid, Jet, Point, Real};
use signorini_membrane::domain::{BoxDomain, Domain, DomainOnCells, ImplicitDomain, PolygonDomain};
use signorini_membrane::equilibrium::Elements;
use signorini_membrane::field::{Constant, Formula};
use signorini_membrane::ils::{self, Reason, Start, StoppingRule};
use signorini_membrane::multigrid::{Hierarchy, OnGrid, nested};
use signorini_membrane::obstacle::{Obstacle, Obstacles, Side};
use signorini_membrane::plane_zone::PlaneZone;
use signorini_membrane::problem::{Measure, Membrane, Support};
use signorini_membrane::report::Report;
use signorini_membrane::zone::{Zone, ZoneSizes};
use signorini_solve::Silent;
use signorini_verify::order::fitted;
use std::sync::Arc;

fn membrane(n: usize, degree: usize, domain: Arc<dyn Domain<2>>, half: f64) -> Membrane<2> {
    let bounds = Aabb::new(Point::<2>::new(-half, -half), Point::<2>::new(half, half));
    let grid = Grid::new(bounds, [n, n], degree);
    let support = Some(Support { index: 0, displacement: Arc::new(Constant(0.0)) });
    let floor = Obstacle { side: Side::Below, height: Arc::new(Constant(-0.1)), adhesion: None };
    Membrane {
        supports: vec![support; domain.pieces()],
        domain: DomainOnCells::new(domain, &grid),
        cells: Arc::new(grid.clone()),
        grid,
        sizing: None,
        measure: Measure::Plain,
        tension: Arc::new(Constant(1.0)),
        load: Arc::new(Constant(-1.0)),
        obstacles: Obstacles(vec![floor]),
        support_count: 1,
        modes: Default::default(),
        formulation: Default::default(),
    }
}

fn disc(n: usize, degree: usize) -> Membrane<2> {
    membrane(n, degree, Arc::new(ImplicitDomain(Ellipsoid { center: Point::zeros(), semi_axes: [1.0, 1.0] })), 1.03)
}

#[test]
fn the_solution_is_that_of_the_direct_solver() {
    // At degree 1 fronts are parabolas within each cell here.
    for (membrane, least) in [(disc(48, 1), 1e-7), (disc(32, 3), 1e-12), (uneven(disc(32, 3)), 1e-12)] {
        let front = circle(Point::zeros(), |a| 0.5 + 0.05 * (3.0 * a).cos(), 40);
        let zone = PlaneZone::new(&membrane.grid, vec![(Side::Below, front)]).on_grid(&membrane.grid);
        let (worst, points, left) = beside_the_direct_solver::<OnGrid>(&membrane, &zone, 16);
        assert!(points > 1000 && worst < least, "{worst:e} at {points} points");
        assert!(left < 1e-12, "{left:e}");
    }
}

/// The worst contraction of so many random cuts, and as many slivers of every thickness along straight edges.
fn worst_contraction(degree: usize, cuts: usize, n: usize) -> f64 {
    let mut worst = (0.0, String::new());
    let mut try_one = |membrane: &Membrane<2>, fronts: Vec<ClosedCurve>, name: String| {
        let fronts = fronts.into_iter().map(|c| (Side::Below, c)).collect();
        let zone = PlaneZone::new(&membrane.grid, fronts).on_grid(&membrane.grid);
        let rate = contraction::<OnGrid>(membrane, &zone);
        if rate > worst.0 {
            worst = (rate, name);
        }
    };
    for k in 0..cuts {
        let t = k as f64;
        let front = circle(
            Point::<2>::new(0.2 * (1.3 * t).sin(), 0.2 * (2.1 * t).cos()),
            |a| 0.45 + 0.1 * (0.7 * t).sin() * (2.0 * a + t).cos() + 0.04 * (3.0 * a).sin(),
            48,
        );
        try_one(&disc(n, degree), vec![front], format!("random {k}"));
    }
    for k in 0..cuts {
        let thin = 10f64.powf(-12.0 * k as f64 / cuts as f64);
        let half = 1.0;
        let edge = half - (2.0 / n as f64) * (1.0 - thin);
        let corners = [[-edge, -edge], [edge, -edge], [edge, edge], [-edge, edge]].map(Point::<2>::from).to_vec();
        try_one(
            &membrane(n, degree, Arc::new(PolygonDomain::new(corners)), half),
            vec![circle(Point::zeros(), |_| 0.5, 32)],
            format!("sliver {thin:e}"),
        );
    }
    println!("degree {degree}: {cuts} random cuts and as many slivers, {n} cells: at most {worst:?}");
    worst.0
}

/// What is asked for by hand, or as usual:  SIGNORINI_CUTS=100 SIGNORINI_CELLS=256 cargo test …
fn asked(name: &str, usual: usize) -> usize {
    std::env::var(name).ok().and_then(|v| v.parse().ok()).unwrap_or(usual)
}

/// A membrane that touches nothing has no band that moves.
#[test]
fn without_contact_it_is_poissons_problem() {
    for degree in [1, 3] {
        let membrane = disc(32, degree);
        let mut hierarchy = Hierarchy::<OnGrid>::new(&membrane, &PlaneZone::empty(&membrane.grid)).expect("levels");
        for _ in 0..14 {
            hierarchy.cycle().expect("a cycle");
        }
        assert!(hierarchy.finest().relative_residual() < 1e-12);
        let x = Point::<2>::new(0.21, -0.13);
        let (found, exact) = (hierarchy.finest().evaluate(&x).expect("inside"), 0.25 * (x.norm_squared() - 1.0));
        assert!((found - exact).abs() < if degree == 1 { 1e-3 } else { 1e-12 }, "degree {degree}: {found} {exact}");
    }
}

#[test]
fn a_cycle_leaves_an_eighth_whatever_is_cut() {
    let worst = worst_contraction(1, asked("SIGNORINI_CUTS", 12), asked("SIGNORINI_CELLS", 64));
    assert!(worst <= 0.12, "{worst}");
}

/// A tension that grows fourfold from one side to the other, and waves.
fn uneven(membrane: Membrane<2>) -> Membrane<2> {
    let c = |v: f64| Jet::<2>::constant(v);
    let tension = move |[x, y]: [Jet<2>; 2]| {
        let a = c(3.0) * y;
        c(1.0) + c(0.6) * x + c(0.15) * a.chain(a.value.sin(), a.value.cos(), -a.value.sin())
    };
    Membrane { tension: Arc::new(Formula(tension)), ..membrane }
}

#[test]
fn an_uneven_tension_does_not_slow_a_cycle_down() {
    for (n, degree) in [(64, 1), (32, 2), (32, 3), (32, 4)] {
        let membrane = uneven(disc(n, degree));
        let front = circle(Point::<2>::new(0.1, 0.05), |a| 0.45 + 0.05 * (3.0 * a).cos(), 48);
        let zone = PlaneZone::new(&membrane.grid, vec![(Side::Below, front)]).on_grid(&membrane.grid);
        let rate = contraction::<OnGrid>(&membrane, &zone);
        println!("degree {degree}, {n} cells: {rate:.3}");
        assert!(rate < 0.12, "degree {degree}: {rate}");
    }
}

/// Zones that coarse grids do not show, and several of them.
#[test]
fn tiny_zones_do_not_slow_a_cycle_down() {
    for (n, radius, degree) in [(256, 0.015, 1), (256, 0.004, 1), (64, 0.02, 3)] {
        let membrane = disc(n, degree);
        let centres = [[0.1, 0.2], [-0.35, 0.11], [0.02, -0.4]].map(Point::<2>::from);
        let fronts = centres.map(|c| (Side::Below, circle(c, |_| radius, 16))).to_vec();
        let zone = PlaneZone::new(&membrane.grid, fronts).on_grid(&membrane.grid);
        let rate = contraction::<OnGrid>(&membrane, &zone);
        println!("{n} cells of degree {degree}, radius {radius}: {rate:.3}");
        assert!(rate <= 0.2, "{n} cells of degree {degree}, radius {radius}: {rate}");
    }
}

/// A membrane that stays clear of the floor is told so; one that meets it only between the nodes of the first grid is not.
#[test]
fn a_free_membrane_is_free() {
    let mut membrane = disc(128, 2);
    membrane.obstacles.0[0].height = Arc::new(Constant(-0.26));
    let found = nested::solution(&membrane, (0, 0.0), &mut Silent).expect("solves").expect("a state");
    assert_eq!(found.reason, Reason::NoContact);
    let state = found.equilibrium.expect("a state");
    let x = Point::<2>::new(0.21, -0.13);
    let u = state.displacement(&found.zone, &x).expect("inside");
    assert!((u - 0.25 * (x.norm_squared() - 1.0)).abs() < 1e-9, "{u}");
}

/// A needle that the first grids do not show.
#[test]
fn a_tiny_zone_is_found() {
    let c = |v: f64| Jet::<2>::constant(v);
    let needle = move |[x, y]: [Jet<2>; 2]| {
        let r = (x - c(0.21)) * (x - c(0.21)) + (y + c(0.13)) * (y + c(0.13));
        let e = (-r.value / 1e-3).exp();
        c(-0.4) + c(0.25) * r.chain(e, -e / 1e-3, e / 1e-6)
    };
    let mut membrane = disc(512, 1);
    membrane.obstacles.0[0].height = Arc::new(Formula(needle));
    let found = nested::solution(&membrane, (0, 0.0), &mut Silent).expect("solves").expect("a state");
    assert_eq!(found.zone.counts(), (1, 0));
    let report = Report::new(&found).expect("a report");
    println!("area {:e}, force {:e}", report.area(), report.force());
    assert!(report.area() > 1e-5 && report.area() < 1e-3 && report.equilibrium_residual < 1e-9);
}

#[test]
fn a_cycle_of_higher_degree_leaves_a_seventh() {
    for degree in 2..=4 {
        let worst = worst_contraction(
            degree,
            asked("SIGNORINI_CUTS", 6),
            (asked("SIGNORINI_CELLS", 64) / degree).next_multiple_of(32),
        );
        assert!(worst <= 0.15, "degree {degree}: {worst}");
    }
}

/// The whole contact problem: the front of a round membrane on a flat floor, by the exact radius.
#[test]
fn nested_iteration_finds_the_front() {
    let exact = 0.502_474_357_08;
    let found = |n: usize, degree: usize| {
        let membrane = disc(n, degree);
        assert!(nested::is_able(&membrane));
        let found = nested::solve::<OnGrid>(&membrane, f64::INFINITY, 32, (0, 0.0), &mut Silent)
            .expect("solves")
            .expect("a state");
        assert!(found.steps.iter().skip(1).all(|s| *s <= 4), "{:?}", found.steps);
        ((area(&found.zone) / std::f64::consts::PI).sqrt() - exact).abs()
    };
    for (degree, cells, order, least) in [(1, [64usize, 128, 256], 1.6, 1e-5), (2, [32, 64, 128], 3.8, 1e-9)] {
        let errors = cells.map(|n| found(n, degree));
        let h = cells.map(|n| 1.0 / n as f64);
        assert!(errors[2] < least, "degree {degree}: {errors:?}");
        let seen = fitted(&h, &errors);
        assert!(seen > order, "degree {degree}: order {seen} {errors:?}");
    }
    for degree in [3, 4] {
        let error = found(32, degree);
        assert!(error < 1e-9, "degree {degree}: {error:e}");
    }
}

/// A floor of cosine waves.
fn wavy([x, y]: [Jet<2>; 2]) -> Jet<2> {
    let c = |v: f64| Jet::<2>::constant(v);
    let cos = |v: Jet<2>| {
        let a = c(std::f64::consts::TAU) * v;
        a.chain(a.value.cos(), -a.value.sin(), -a.value.cos())
    };
    c(-0.015) - c(0.005) * cos(x) * cos(y)
}

/// Holes where the floor hardly presses at all, so that fronts come to rest slowly: they do in the end.
#[test]
fn fronts_that_hardly_rest_come_to_rest() {
    let square = BoxDomain(Aabb::new(Point::<2>::new(-1.0, -1.0), Point::<2>::new(1.0, 1.0)));
    let mut membrane = membrane(256, 1, Arc::new(square), 1.0);
    membrane.obstacles.0[0].height = Arc::new(Formula(wavy));
    membrane.load = Arc::new(Constant(-0.4));
    membrane.tension = Arc::new(Formula(|[x, y]: [Jet<2>; 2]| {
        let c = |v: f64| Jet::<2>::constant(v);
        let a = c(3.0) * y;
        c(1.0) + c(0.3) * x + c(0.2) * a.chain(a.value.sin(), a.value.cos(), -a.value.sin())
    }));
    let found = nested::solution(&membrane, (0, 0.0), &mut Silent).expect("solves").expect("a state");
    assert_eq!(found.zone.counts(), (1, 2));
    let last = found.residuals.last().copied();
    assert!(found.is_resolved() && last.is_some_and(|r| r <= 1.0), "{:?}", found.residuals);
}

fn area(zone: &PlaneZone) -> f64 {
    zone.curves().iter().map(|c| c.signed_area()).sum()
}

/// What multigrid finds is what the direct solver finds on the same grid, to less than the error of that grid: zones, holes,
/// area, force, and the balance.
#[test]
fn multigrid_and_the_direct_solver_agree() {
    let c = |v: f64| Jet::<2>::constant(v);
    let tilted = move |[x, y]: [Jet<2>; 2]| c(-1.0) + c(0.3) * x - c(0.2) * y;
    let flat = disc(128, 1);
    let waves = |n: usize, degree: usize| {
        let mut m = disc(n, degree);
        m.obstacles.0[0].height = Arc::new(Formula(wavy));
        m.load = Arc::new(Constant(-0.4));
        m
    };
    let square = || Arc::new(BoxDomain(Aabb::new(Point::<2>::new(-1.0, -1.0), Point::<2>::new(1.0, 1.0))));
    let varied = |n: usize, degree| Membrane { load: Arc::new(Formula(tilted)), ..membrane(n, degree, square(), 1.0) };
    let ceiling = {
        let mut m = disc(128, 1);
        m.obstacles.0[0] = Obstacle { side: Side::Above, height: Arc::new(Constant(0.1)), adhesion: None };
        m.load = Arc::new(Constant(1.0));
        m
    };
    let cases = [
        ("flat", flat, [1e-5, 5e-5]),
        ("waves", waves(128, 1), [1e-5, 5e-5]),
        ("square, varied load", varied(96, 1), [1e-5, 5e-5]),
        ("ceiling", ceiling, [1e-5, 5e-5]),
        ("waves, degree 2", waves(64, 2), [1e-8, 1e-8]),
        ("square, varied load, degree 3", varied(32, 3), [1e-8, 1e-8]),
        ("waves, degree 4", waves(48, 4), [1e-8, 1e-8]),
        ("uneven tension", uneven(disc(128, 1)), [1e-5, 5e-5]),
        ("uneven tension, degree 3", uneven(varied(32, 3)), [1e-7, 1e-7]),
    ];
    for (name, membrane, least) in cases {
        let found = nested::solution(&membrane, (0, 0.0), &mut Silent).expect("solves");
        let found = found.unwrap_or_else(|| panic!("{name}: no state"));
        let direct = ils::solve::<2, PlaneZone>(
            &membrane,
            &mut Elements::new(&membrane),
            Start::Free,
            StoppingRule::Final,
            (0, 0.0),
            &mut Silent,
        );
        assert_eq!(direct.reason, Reason::Converged, "{name}");
        assert_eq!(found.zone.counts(), direct.zone.counts(), "{name}");
        let [a, b] = [&found, &direct].map(|s| Report::new(s).expect("a report"));
        assert!((a.area() - b.area()).abs() < least[0] * b.area(), "{name}: {} {}", a.area(), b.area());
        assert!((a.force() - b.force()).abs() < least[1] * b.force().abs(), "{name}: {} {}", a.force(), b.force());
        assert!(a.equilibrium_residual < 1e-10, "{name}: {:e}", a.equilibrium_residual);
    }
}
