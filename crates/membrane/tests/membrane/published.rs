//! The published formulation: its multipliers, its derivatives, and its agreement with the one-sided formulation.

use signorini_fem::Grid;
use signorini_geometry::{Aabb, ClosedCurve, Ellipsoid, Jet, Point, Real};
use signorini_membrane::domain::{BoxDomain, Domain, DomainOnCells, ImplicitDomain};
use signorini_membrane::equilibrium::{Elements, Equilibrium};
use signorini_membrane::field::{Constant, Formula, SharedField};
use signorini_membrane::line_zone::LineZone;
use signorini_membrane::method::ModeSpace;
use signorini_membrane::method::{Formulation, Published, Transport, ZoneMultiplier};
use signorini_membrane::obstacle::{Obstacle, Obstacles, Side};
use signorini_membrane::plane_zone::PlaneZone;
use signorini_membrane::problem::{Measure, Membrane, Support};
use signorini_membrane::published::inf_sup;
use signorini_membrane::zone::{Zone, ZoneFronts};
use std::sync::Arc;

const SPACE: ModeSpace = ModeSpace::Fourier(5);
const H1: Formulation = of(ZoneMultiplier::H1 { length: 1.0 });
const L2: Formulation = of(ZoneMultiplier::L2);

const fn of(multiplier: ZoneMultiplier) -> Formulation {
    Formulation::Published(Published { multiplier, transport: Transport::Exact })
}

/// A disc over a curved floor, with a tension and a load that vary.
fn disc(cells: usize, formulation: Formulation) -> Membrane<2> {
    let bounds = Aabb::new(Point::<2>::new(-1.03, -1.03), Point::<2>::new(1.03, 1.03));
    let grid = Grid::new(bounds, [cells, cells], 1);
    let domain: Arc<dyn Domain<2>> =
        Arc::new(ImplicitDomain(Ellipsoid { center: Point::zeros(), semi_axes: [1.0, 1.0] }));
    varied(Membrane {
        domain: DomainOnCells::new(domain, &grid),
        cells: Arc::new(grid.clone()),
        grid,
        sizing: None,
        measure: Measure::Plain,
        tension: Arc::new(Constant(1.0)),
        load: Arc::new(Constant(-1.0)),
        obstacles: Obstacles(Vec::new()),
        supports: vec![Some(Support { index: 0, displacement: Arc::new(Constant(0.0)) })],
        support_count: 1,
        modes: Default::default(),
        formulation,
    })
}

/// The same on a mesh of triangles, or of triangles and quadrilaterals, each divided so many times.
fn on_mesh(name: &str, divisions: usize, formulation: Formulation) -> Membrane<2> {
    Membrane { formulation, ..varied(crate::common::on_mesh(crate::common::cells(name, 1, divisions))) }
}

const MESHES: [&str; 2] = ["triangles_2_6", "mixed_2_6"];

/// A membrane with a curved floor, a tension and a load that vary.
fn varied(membrane: Membrane<2>) -> Membrane<2> {
    let c = |v: f64| Jet::<2>::constant(v);
    let height: SharedField<2> =
        Arc::new(Formula(move |[x, y]: [Jet<2>; 2]| c(-0.1) - c(0.05) * x * x + c(0.03) * y * x - c(0.02) * y));
    Membrane {
        tension: Arc::new(Formula(move |[x, y]: [Jet<2>; 2]| c(1.0) + c(0.4) * x + c(0.2) * y * y)),
        load: Arc::new(Formula(move |[x, y]: [Jet<2>; 2]| c(-1.0) - c(0.3) * y + c(0.2) * x * y)),
        obstacles: Obstacles(vec![Obstacle { side: Side::Below, height, adhesion: None }]),
        ..membrane
    }
}

/// An off-centre, bent front that is not the solution.
fn bent(membrane: &Membrane<2>) -> PlaneZone {
    let points: Vec<Point<2>> = (0..24)
        .map(|i| {
            let a = std::f64::consts::TAU * f64::from(i) / 24.0;
            let r = 0.45 + 0.05 * (2.0 * a).cos() + 0.02 * (3.0 * a).sin();
            Point::<2>::new(0.07 + r * a.cos(), -0.04 + r * a.sin())
        })
        .collect();
    PlaneZone::new(&membrane.grid, vec![(Side::Below, ClosedCurve::through(&points, 9))])
}

fn state<const D: usize, Z: Zone<D>>(membrane: &Membrane<D>, zone: &Z) -> Equilibrium<D> {
    Equilibrium::solve(membrane, zone, &mut Elements::new(membrane)).expect("an equilibrium")
}

fn moments<const D: usize, Z: Zone<D>>(membrane: &Membrane<D>, zone: &Z) -> Vec<f64> {
    let equilibrium = state(membrane, zone);
    let mut b = vec![0.0; zone.mode_offsets(SPACE)[zone.front_count()]];
    for (p, rho) in equilibrium.quadrature.front.iter().zip(equilibrium.slope_jump()) {
        for (i, v) in zone.frame(p.front, &p.x, SPACE).modes {
            b[i] += p.weight * rho * v;
        }
    }
    b
}

/// The change of the moments that the domain form predicts where the fronts move by `direction` in their modes.
fn predicted<const D: usize, Z: Zone<D>>(membrane: &Membrane<D>, zone: &Z, direction: &[f64]) -> Vec<f64> {
    let equilibrium = state(membrane, zone);
    let rates = equilibrium.saddle().expect("multipliers").rates(&equilibrium.free(), zone, SPACE).expect("rates");
    let rho = equilibrium.slope_jump();
    let mut out = vec![0.0; direction.len()];
    for (i, p) in equilibrium.quadrature.front.iter().enumerate() {
        for (n, test) in zone.frame(p.front, &p.x, SPACE).modes {
            for (rate, d) in rates.iter().zip(direction) {
                out[n] += p.weight * test * d * (rate.slope_jump[i] + rho[i] * rate.stretch[i]);
            }
        }
    }
    out
}

fn sensitivity_error(membrane: &Membrane<2>) -> f64 {
    let zone = bent(membrane);
    let n = zone.mode_offsets(SPACE)[1];
    let direction: Vec<f64> = (0..n).map(|i| 1.0 + (1.7 * i as f64).sin()).collect();
    signorini_verify::taylor::central_difference_error(&predicted(membrane, &zone, &direction), 2e-3, |step| {
        let moved: Vec<f64> = direction.iter().map(|d| d * step).collect();
        moments(membrane, &zone.displaced(SPACE, &moved))
    })
}

#[test]
fn the_sensitivity_in_domain_form_fits_differences() {
    let errors: Vec<f64> = [24, 48, 96].iter().map(|&n| sensitivity_error(&disc(n, H1))).collect();
    // Cells of about 1/24 in the middle.
    assert!(errors[1] <= 1e-2, "{errors:?}");
    assert!(errors[1] < 0.5 * errors[0] && errors[2] < 0.5 * errors[1], "{errors:?}");
}

#[test]
fn so_it_does_on_meshes() {
    for mesh in MESHES {
        // Cells of about 1/6, 1/12, 1/24 and 1/48.
        let errors: Vec<f64> = (0..4).map(|divisions| sensitivity_error(&on_mesh(mesh, divisions, H1))).collect();
        assert!(errors[2] <= 1e-2 && errors[3] < errors[1] && errors[2] < errors[0], "{mesh}: {errors:?}");
    }
}

/// A round membrane over a floor, along its radius.
fn radius(cells: usize, degree: usize, formulation: Formulation) -> Membrane<1> {
    let bounds = Aabb::new(Point::<1>::new(0.0), Point::<1>::new(1.0));
    let grid = Grid::new(bounds, [cells], degree);
    let c = |v: f64| Jet::<1>::constant(v);
    let domain: Arc<dyn Domain<1>> = Arc::new(BoxDomain(bounds));
    Membrane {
        domain: DomainOnCells::new(domain, &grid),
        cells: Arc::new(grid.clone()),
        grid,
        sizing: None,
        measure: Measure::Axisymmetric,
        tension: Arc::new(Formula(move |[r]: [Jet<1>; 1]| c(1.0) + c(0.3) * r * r)),
        load: Arc::new(Formula(move |[r]: [Jet<1>; 1]| c(-1.0) - c(0.4) * r * r)),
        obstacles: Obstacles(vec![Obstacle {
            side: Side::Below,
            height: Arc::new(Formula(move |[r]: [Jet<1>; 1]| c(-0.1) - c(0.05) * r * r)),
            adhesion: None,
        }]),
        supports: vec![None, Some(Support { index: 0, displacement: Arc::new(Constant(0.0)) })],
        support_count: 1,
        modes: Default::default(),
        formulation,
    }
}

#[test]
fn along_a_radius_too_in_every_degree() {
    for (degree, bound) in [(1, 1e-2), (2, 1e-4), (3, 1e-5), (6, 1e-5)] {
        let membrane = radius(24, degree, H1);
        let at = |r: f64| LineZone::new(&membrane.grid, vec![(Side::Below, [-1.0, r])]);
        let exact = state(&membrane, &at(0.473)).quadrature.front.len();
        assert_eq!(exact, 1);
        let prediction = predicted(&membrane, &at(0.473), &[0.0, 1.0]);
        let step = match degree {
            1 => 1.0 / 24.0,
            2 => 1e-3,
            _ => 1e-4,
        };
        let error = signorini_verify::taylor::central_difference_error(&prediction, step, |step| {
            moments(&membrane, &at(0.473 + step))
        });
        assert!(error <= bound, "degree {degree}: {error}");
    }
}

#[test]
fn both_formulations_find_the_same_slope_jump() {
    type Kind = fn(usize, Formulation) -> Membrane<2>;
    let kinds: [Kind; 3] = [
        |k, formulation| disc(20 << k, formulation),
        |k, formulation| on_mesh(MESHES[0], k + 1, formulation),
        |k, formulation| on_mesh(MESHES[1], k + 1, formulation),
    ];
    for (kind, membrane) in kinds.iter().enumerate() {
        let difference = |k: usize| {
            let [one, two] = [Formulation::OneSided, H1].map(|f| {
                let membrane = membrane(k, f);
                moments(&membrane, &bent(&membrane))
            });
            let norm = |v: &mut dyn Iterator<Item = f64>| v.map(|x| x * x).sum::<f64>().sqrt();
            norm(&mut one.iter().zip(&two).map(|(a, b)| a - b)) / norm(&mut two.iter().copied())
        };
        let differences: Vec<f64> = (0..3).map(difference).collect();
        let order = (differences[0] / differences[2]).log2() / 2.0;
        assert!(order >= 1.7, "kind {kind}: {differences:?}");
    }
}

#[test]
fn the_multiplier_adds_up_to_the_force() {
    // The integral of the multiplier is the force of the zone with what acts along the front, by the equations themselves.
    for (formulation, bound) in [(H1, 1e-9), (L2, 1e-9)] {
        let membrane = disc(24, formulation);
        let equilibrium = state(&membrane, &bent(&membrane));
        let saddle = equilibrium.saddle().expect("multipliers");
        let (_, force) = saddle.zone_multiplier(&equilibrium.free()).expect("a multiplier");
        let mut expected = 0.0;
        equilibrium.for_each_point(|_, region, x, w| {
            if signorini_membrane::zone::contact_of(region).is_some() {
                expected += w * membrane.load.value(x);
            }
        });
        for (p, rho) in equilibrium.quadrature.front.iter().zip(equilibrium.slope_jump()) {
            let slope = membrane.obstacles.jet(p.side, &p.x).gradient.dot(&p.normal);
            expected += p.weight * membrane.tension.value(&p.x) * (rho + slope);
        }
        assert!((force - expected).abs() <= bound * expected.abs(), "{force} {expected}");
    }
}

/// How much larger the multiplier in the zone is at its worst than the pressure, with a front that is not at rest.
fn overshoot(cells: usize, formulation: Formulation) -> f64 {
    let membrane = disc(cells, formulation);
    let equilibrium = state(&membrane, &bent(&membrane));
    let (values, _) =
        equilibrium.saddle().expect("multipliers").zone_multiplier(&equilibrium.free()).expect("a multiplier");
    values.iter().fold(0.0, |m, v| f64::max(m, v.abs()))
}

#[test]
fn without_gradients_the_multiplier_grows_without_bound() {
    let [h1, l2] = [H1, L2].map(|f| overshoot(80, f) / overshoot(20, f));
    assert!(h1 < 1.1, "{h1}");
    assert!(l2 > 2.0, "{l2}");
}

#[test]
fn the_multiplier_along_the_front_is_stable_however_it_cuts() {
    let mut least = f64::INFINITY;
    for i in 0..100 {
        let t = f64::from(i);
        let membrane = disc(16 + i as usize % 9, H1);
        let h = membrane.grid.h();
        // Slivers: ever closer to grid lines, which straight fronts follow for many cells.
        let sliver = 10f64.powf(-1.0 - t / 9.0);
        let points: Vec<Point<2>> = (0..40)
            .map(|k| {
                let a = std::f64::consts::TAU * f64::from(k) / 40.0;
                let r = 0.5 + 0.08 * (2.0 * a + t).cos() + 0.03 * (5.0 * a - 2.0 * t).sin();
                let (sin, cos) = a.sin_cos();
                match i % 2 {
                    0 => Point::<2>::new(r * cos + 0.01 * t.sin(), r * sin),
                    // Nearly a square along grid lines.
                    _ => {
                        let side = membrane.grid.bounds().min[0] + h * (0.75 * membrane.grid.cells()[0] as f64).round();
                        let p = (cos.abs().powi(12) + sin.abs().powi(12)).powf(-1.0 / 12.0);
                        (side + sliver * h) * p * Point::<2>::new(cos, sin)
                    }
                }
            })
            .collect();
        let zone = PlaneZone::new(&membrane.grid, vec![(Side::Below, ClosedCurve::through(&points, 3))]);
        let constant = inf_sup(&membrane, &zone).expect("a factorisation").expect("multipliers");
        least = least.min(constant);
        assert!(constant >= 0.3, "{i}: {constant}");
    }
    assert!(least < 0.8, "{least}");
}

#[test]
fn it_is_stable_on_meshes_too() {
    for mesh in MESHES {
        let membrane = on_mesh(mesh, 1, H1);
        for i in 0..50 {
            let t = f64::from(i);
            // Straight along an axis, along which meshes of a disc have sides, and ever closer to it.
            let sliver = 10f64.powf(-1.0 - t / 4.5);
            let points: Vec<Point<2>> = (0..40)
                .map(|k| {
                    let (sin, cos) = (std::f64::consts::TAU * f64::from(k) / 40.0).sin_cos();
                    match i % 2 {
                        0 => (0.5 + 0.08 * (2.0 * cos + t).cos()) * Point::<2>::new(cos + 0.01 * t.sin(), sin),
                        _ => {
                            let p = (cos.abs().powi(12) + sin.abs().powi(12)).powf(-1.0 / 12.0);
                            0.3 * p * Point::<2>::new(cos, sin) + Point::<2>::new(0.0, 0.3 + sliver / 12.0)
                        }
                    }
                })
                .collect();
            let zone = PlaneZone::new(&membrane.grid, vec![(Side::Below, ClosedCurve::through(&points, 3))]);
            let constant = inf_sup(&membrane, &zone).expect("a factorisation").expect("multipliers");
            assert!(constant >= 0.3, "{mesh}, {i}: {constant}");
        }
    }
}
