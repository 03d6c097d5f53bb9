//! The derivatives of the method against central differences: slope jump and energy, with tension and load that vary.

use signorini_fem::Grid;
use signorini_geometry::{Aabb, ClosedCurve, Ellipsoid, Jet, Point, Real};
use signorini_membrane::adhesion::Branch;
use signorini_membrane::domain::{Domain, DomainOnCells, ImplicitDomain};
use signorini_membrane::equilibrium::{Elements, Equilibrium};
use signorini_membrane::field::{Constant, Formula, SharedField};
use signorini_membrane::front::{Fronts, Step, StepKind};
use signorini_membrane::ils::{Reason, Start, StoppingRule, solve};
use signorini_membrane::method::ModeSpace;
use signorini_membrane::obstacle::{Obstacle, Obstacles, Side};
use signorini_membrane::plane_zone::PlaneZone;
use signorini_membrane::problem::{Measure, Membrane, Support};
use signorini_membrane::scales::Scales;
use signorini_membrane::shape_rate::ShapeRate;
use signorini_membrane::zone::{ZoneFronts, ZoneMotion, contact_index, is_free};
use signorini_solve::Silent;
use std::sync::Arc;

const SPACE: ModeSpace = ModeSpace::Coarse(6);

/// A disc over a curved floor, with a tension and a load that vary; or all that upside down.
fn membrane(cells: usize, degree: usize, side: Side) -> Membrane<2> {
    let bounds = Aabb::new(Point::<2>::new(-1.03, -1.03), Point::<2>::new(1.03, 1.03));
    let grid = Grid::new(bounds, [cells, cells], degree);
    let domain: Arc<dyn Domain<2>> =
        Arc::new(ImplicitDomain(Ellipsoid { center: Point::zeros(), semi_axes: [1.0, 1.0] }));
    let c = |v: f64| Jet::<2>::constant(v);
    let up = c(side.sign());
    let height: SharedField<2> =
        Arc::new(Formula(move |[x, y]: [Jet<2>; 2]| up * (c(-0.1) - c(0.05) * x * x + c(0.03) * y * x - c(0.02) * y)));
    Membrane {
        domain: DomainOnCells::new(domain, &grid),
        cells: Arc::new(grid.clone()),
        grid,
        sizing: None,
        measure: Measure::Plain,
        tension: Arc::new(Formula(move |[x, y]: [Jet<2>; 2]| c(1.0) + c(0.4) * x + c(0.2) * y * y)),
        load: Arc::new(Formula(move |[x, y]: [Jet<2>; 2]| up * (c(-1.0) - c(0.3) * y + c(0.2) * x * y))),
        obstacles: Obstacles(vec![Obstacle { side, height, adhesion: None }]),
        supports: vec![Some(Support { index: 0, displacement: Arc::new(Constant(0.0)) })],
        support_count: 1,
        modes: Default::default(),
        formulation: Default::default(),
    }
}

/// An off-centre, bent front that is not the solution.
fn zone(membrane: &Membrane<2>) -> PlaneZone {
    zone_of(membrane, 0.45)
}

fn zone_of(membrane: &Membrane<2>, radius: f64) -> PlaneZone {
    let points: Vec<Point<2>> = (0..24)
        .map(|i| {
            let a = std::f64::consts::TAU * f64::from(i) / 24.0;
            let r = radius + 0.05 * (2.0 * a).cos() + 0.02 * (3.0 * a).sin();
            Point::<2>::new(0.07 + r * a.cos(), -0.04 + r * a.sin())
        })
        .collect();
    let side = membrane.obstacles.0[0].side;
    PlaneZone::new(&membrane.grid, vec![(side, ClosedCurve::through(&points, 9))])
}

/// A round front about the centre, of so many knots.
fn round(membrane: &Membrane<2>, radius: f64, knots: u32, degree: usize) -> PlaneZone {
    let points: Vec<Point<2>> = (0..knots)
        .map(|i| std::f64::consts::TAU * f64::from(i) / f64::from(knots))
        .map(|a| Point::<2>::new(radius * a.cos(), radius * a.sin()))
        .collect();
    PlaneZone::new(&membrane.grid, vec![(Side::Below, ClosedCurve::through(&points, degree))])
}

/// `∫ ρ ω_n dΓ` for all modes, with the modes carried along by the front.
fn moments(membrane: &Membrane<2>, zone: &PlaneZone, modes: &PlaneZone) -> Vec<f64> {
    let mut elements = Elements::new(membrane);
    let equilibrium = Equilibrium::solve(membrane, zone, &mut elements).expect("an equilibrium");
    let n = modes.mode_offsets(SPACE)[1];
    let mut b = vec![0.0; n];
    for (p, rho) in equilibrium.quadrature.front.iter().zip(equilibrium.slope_jump()) {
        for (i, v) in zone.frame(p.front, &p.x, SPACE).modes {
            b[i] += p.weight * rho * v;
        }
    }
    b
}

/// The relative error of the predicted change of the slope jump.
fn slope_jump_error(cells: usize, degree: usize, side: Side) -> f64 {
    let membrane = membrane(cells, degree, side);
    let zone = zone(&membrane);
    let mut elements = Elements::new(&membrane);
    let equilibrium = Equilibrium::solve(&membrane, &zone, &mut elements).expect("an equilibrium");
    let fronts = Fronts::new(&equilibrium, false);
    let n = zone.mode_offsets(SPACE)[1];
    let direction: Vec<f64> = (0..n).map(|i| 1.0 + (1.7 * i as f64).sin()).collect();
    let frames: Vec<_> = equilibrium.quadrature.front.iter().map(|p| zone.frame(p.front, &p.x, SPACE)).collect();
    let speed: Vec<f64> = frames.iter().map(|f| f.modes.iter().map(|(i, v)| v * direction[*i]).sum::<f64>()).collect();
    let rate = fronts.slope_jump_rate(&zone, &speed).expect("a rate");
    // d/dτ ∫ ρ ω dΓ = ∫ (ρ° + κ ρ w) ω dΓ for modes carried along the normal.
    let mut predicted = vec![0.0; n];
    for (i, p) in equilibrium.quadrature.front.iter().enumerate() {
        let change = rate[i] + frames[i].curvature * fronts.slope_jump[i] * speed[i];
        for (mode, v) in &frames[i].modes {
            predicted[*mode] += p.weight * change * v;
        }
    }
    signorini_verify::taylor::central_difference_error(&predicted, 1e-3, |step| {
        let moved: Vec<f64> = direction.iter().map(|d| d * step).collect();
        moments(&membrane, &zone.displaced(SPACE, &moved), &zone)
    })
}

#[test]
fn the_change_of_the_slope_jump_is_predicted() {
    for side in Side::BOTH {
        let errors: Vec<f64> = [1, 2, 4].iter().map(|&p| slope_jump_error(20, p, side)).collect();
        assert!(errors[2] <= 1e-3, "{errors:?}");
        assert!(errors[0] > errors[1] && errors[1] > errors[2], "{errors:?}");
    }
}

/// `∫ ρ ω_n` in the finest modes of a zone, of the state around another.
fn fine_moments(membrane: &Membrane<2>, zone: &PlaneZone, modes: &PlaneZone) -> Vec<f64> {
    let state = Equilibrium::solve(membrane, zone, &mut Elements::new(membrane)).expect("an equilibrium");
    let mut b = vec![0.0; modes.mode_offsets(ModeSpace::Fine)[1]];
    for (p, rho) in state.quadrature.front.iter().zip(state.slope_jump()) {
        for (i, v) in modes.frame(p.front, &p.x, ModeSpace::Fine).modes {
            b[i] += p.weight * rho * v;
        }
    }
    b
}

fn size(v: &[f64]) -> f64 {
    v.iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// In all modes that the grid tells apart, and far from a solution as well, unlike the derivative in the continuum.
#[test]
fn the_change_of_the_discrete_slope_jump_is_predicted() {
    for (degree, side) in [(1, Side::Below), (2, Side::Above), (3, Side::Below), (4, Side::Above)] {
        let membrane = membrane(20, degree, side);
        let zone = zone(&membrane);
        let elements = Elements::new(&membrane);
        let state = Equilibrium::solve(&membrane, &zone, &mut Elements::new(&membrane)).expect("an equilibrium");
        let n = zone.mode_offsets(ModeSpace::Fine)[1];
        let direction: Vec<f64> = (0..n).map(|i| 1.0 + (1.7 * i as f64).sin()).collect();
        let rate = ShapeRate::new(&state, &elements, &zone, ModeSpace::Fine);
        let predicted = rate.of_moments(&direction).expect("a rate");
        let error = signorini_verify::taylor::central_difference_error(&predicted, 1e-6, |step| {
            let moved: Vec<f64> = direction.iter().map(|d| d * step).collect();
            fine_moments(&membrane, &zone.displaced(ModeSpace::Fine, &moved), &zone)
        });
        // What is left is that of the quadrature in cut cells.
        let least = [4e-3, 4e-4, 2e-5, 1e-6][degree - 1];
        assert!(error < least, "degree {degree}: {error:e}");
    }
}

/// The solution with a front that is off by a thousandth of a cell in all waves, and its scales.
fn beside_the_solution(membrane: &Membrane<2>, elements: &mut Elements<2>) -> (PlaneZone, Scales) {
    let solution = solve::<2, PlaneZone>(membrane, elements, Start::Free, StoppingRule::Final, (0, 0.0), &mut Silent);
    assert_eq!(solution.reason, Reason::Converged);
    let n = solution.zone.mode_offsets(ModeSpace::Fine)[1];
    let off: Vec<f64> = (0..n).map(|i| 1e-3 * membrane.grid.h() * (1.0 + (0.9 * i as f64).sin())).collect();
    let zone = solution.zone.advanced(&membrane.grid, ModeSpace::Fine, &off, 1.0).zone;
    (zone, solution.scales.expect("scales"))
}

#[test]
fn fronts_come_to_rest_quadratically() {
    for degree in 1..=3 {
        let membrane = membrane(24, degree, Side::Below);
        let mut elements = Elements::new(&membrane);
        let (mut zone, scales) = beside_the_solution(&membrane, &mut elements);
        let mut left = Vec::new();
        for _ in 0..3 {
            let state = Equilibrium::solve(&membrane, &zone, &mut elements).expect("an equilibrium");
            let fronts = Fronts::new(&state, false);
            left.push(fronts.residual(&zone, ModeSpace::Fine));
            let step = fronts.discrete_step(&zone, &elements, &scales, None).expect("a step").expect("near a solution");
            zone = zone.advanced(&membrane.grid, ModeSpace::Fine, &step.coefficients, 1.0).zone;
        }
        // Three digits, then six. At degree 1 the derivative has kinks where fronts pass corners of cells: beside one, as on
        // 20 x 20 cells, it is two digits, then three.
        assert!(left[1] < 1e-3 * left[0] && left[2] < 1e-5 * left[0], "degree {degree}: {left:?}");
    }
}

/// The same with adhesion that varies from place to place: then all of the derivative counts, in the continuum and in cells.
#[test]
fn fronts_held_by_adhesion_come_to_rest_quadratically() {
    for (degree, side) in [(1, Side::Below), (2, Side::Above), (3, Side::Below)] {
        let mut membrane = membrane(24, degree, side);
        let c = |v: f64| Jet::<2>::constant(v);
        let energy = move |[x, y]: [Jet<2>; 2]| c(0.01) + c(0.004) * x - c(0.003) * x * y;
        membrane.obstacles.0[0].adhesion = Some(Arc::new(Formula(energy)));
        let mut elements = Elements::new(&membrane);
        let (begin, scales) = beside_the_solution(&membrane, &mut elements);
        let mut left = [Vec::new(), Vec::new()];
        for (discrete, left) in [true, false].into_iter().zip(&mut left) {
            let mut zone = begin.clone();
            for _ in 0..3 {
                let state = Equilibrium::solve(&membrane, &zone, &mut elements).expect("an equilibrium");
                let fronts = Fronts::new(&state, true);
                left.push(fronts.residual(&zone, ModeSpace::Fine));
                let linearised = fronts.linearise(&zone, ModeSpace::Fine, &scales).expect("a derivative");
                let factor = linearised.factor().expect("not singular");
                let step = match discrete {
                    true => fronts.discrete_step(&zone, &elements, &scales, Some(&factor)).expect("a step"),
                    false => None,
                };
                let step = step.unwrap_or_else(|| linearised.step(Branch::Nearest, &scales));
                assert_eq!(step.kind == StepKind::Exact, discrete);
                zone = zone.advanced(&membrane.grid, ModeSpace::Fine, &step.coefficients, 1.0).zone;
            }
        }
        let [discrete, continuum] = left;
        assert!(discrete[1] < 1e-3 * discrete[0] && discrete[2] < 1e-5 * discrete[0], "degree {degree}: {discrete:?}");
        // At degree 3 cells change little of it.
        let gained = degree == 3 || discrete[2] < 1e-2 * continuum[2];
        assert!(gained, "degree {degree}: {discrete:?} {continuum:?}");
    }
}

/// On a circle waves are the eigenfunctions of the norm of `H⁻¹`, in which the residual is told.
#[test]
fn short_waves_count_less_in_the_residual() {
    let membrane = membrane(24, 3, Side::Below);
    let radius = 0.5;
    let zone = round(&membrane, radius, 32, 9);
    let equilibrium = Equilibrium::solve(&membrane, &zone, &mut Elements::new(&membrane)).expect("an equilibrium");
    let mut fronts = Fronts::new(&equilibrium, false);
    let length = membrane.size() / std::f64::consts::TAU;
    for k in 0..6 {
        let wave = |x: &Point<2>| (f64::from(k) * x[1].atan2(x[0])).cos();
        fronts.slope_jump = equilibrium.quadrature.front.iter().map(|p| wave(&p.x)).collect();
        let square = if k == 0 { std::f64::consts::TAU } else { std::f64::consts::PI } * radius;
        let exact = (square / (1.0 + (f64::from(k) * length / radius).powi(2))).sqrt();
        let residual = fronts.residual(&zone, ModeSpace::Fine);
        assert!((residual / exact - 1.0).abs() < 1e-4, "{k}: {residual} {exact}");
        assert!((fronts.project(&zone, ModeSpace::Fine).norm / square.sqrt() - 1.0).abs() < 1e-4, "{k}");
    }
}

/// A step on a circle, whose modes are all alike: a wave of them keeps its shape and loses the factor that its length says.
#[test]
fn short_waves_are_left_out_of_a_step() {
    let membrane = membrane(24, 3, Side::Below);
    let radius = 0.5;
    let zone = round(&membrane, radius, 64, 7);
    let state = Equilibrium::solve(&membrane, &zone, &mut Elements::new(&membrane)).expect("an equilibrium");
    let fronts = Fronts::new(&state, false);
    let n = zone.mode_offsets(ModeSpace::Fine)[1];
    let length = 0.1;
    for k in 0..8 {
        let wave: Vec<f64> = (0..n).map(|i| (std::f64::consts::TAU * (k * i) as f64 / n as f64).cos()).collect();
        let step = Step {
            length: 1.0,
            space: ModeSpace::Fine,
            coefficients: wave.clone(),
            kind: StepKind::Local,
            reach: f64::INFINITY,
        };
        let left = 1.0 / (1.0 + (k as f64 * length / radius).powi(2));
        let smoothed = fronts.smoothed(&zone, &step, length);
        let off = smoothed.iter().zip(&wave).map(|(a, b)| (a - left * b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-3, "{k}: {off}");
    }
}

#[test]
fn the_change_of_the_energy_is_half_the_squared_slope_jump() {
    let membrane = membrane(20, 4, Side::Above);
    let zone = zone(&membrane);
    let energy = |zone: &PlaneZone| {
        let mut elements = Elements::new(&membrane);
        let equilibrium = Equilibrium::solve(&membrane, zone, &mut elements).expect("an equilibrium");
        let mut energy = 0.0;
        equilibrium.for_each_point(|cell, region, x, w| {
            let (u, gradient) = match contact_index(region) {
                Some(_) => {
                    let h = membrane.obstacles.0[0].height.jet(x);
                    (h.value, h.gradient)
                }
                None if is_free(region) => equilibrium.evaluate(cell, region, x).expect("a state"),
                None => return,
            };
            energy += w * (0.5 * membrane.tension.value(x) * gradient.norm_squared() - membrane.load.value(x) * u);
        });
        (energy, equilibrium)
    };
    let n = zone.mode_offsets(SPACE)[1];
    let direction: Vec<f64> = (0..n).map(|i| 1.0 + 0.5 * (2.3 * i as f64).cos()).collect();
    let (_, equilibrium) = energy(&zone);
    let predicted: f64 = equilibrium
        .quadrature
        .front
        .iter()
        .zip(equilibrium.slope_jump())
        .map(|(p, rho)| {
            let w: f64 = zone.frame(p.front, &p.x, SPACE).modes.iter().map(|(i, v)| v * direction[*i]).sum();
            p.weight * 0.5 * membrane.tension.value(&p.x) * rho * rho * w
        })
        .sum();
    let error = signorini_verify::taylor::central_difference_error(&[predicted], 1e-3, |step| {
        let moved: Vec<f64> = direction.iter().map(|d| d * step).collect();
        vec![energy(&zone.displaced(SPACE, &moved)).0]
    });
    assert!(error <= 1e-3, "{error}");
}

/// An adhesion that varies.
fn sticky(cells: usize, degree: usize, side: Side) -> Membrane<2> {
    let c = |v: f64| Jet::<2>::constant(v);
    let energy = move |[x, y]: [Jet<2>; 2]| c(0.002) + c(0.001) * x - c(0.0008) * y * y;
    let mut membrane = membrane(cells, degree, side);
    membrane.obstacles.0[0].adhesion = Some(Arc::new(Formula(energy)));
    membrane
}

#[test]
fn the_change_of_the_adhesive_condition_is_predicted() {
    let membrane = sticky(20, 4, Side::Above);
    // Too large a zone, which the floor would have to hold.
    let zone = zone_of(&membrane, 0.72);
    let excess = |zone: &PlaneZone| {
        let mut elements = Elements::new(&membrane);
        let equilibrium = Equilibrium::solve(&membrane, zone, &mut elements).expect("an equilibrium");
        let scales = Scales::of_free(&equilibrium);
        let fronts = Fronts::new(&equilibrium, true);
        let linearised = fronts.linearise(zone, SPACE, &scales).expect("a derivative");
        // The front itself becomes longer, which the method leaves out: it vanishes with the residual.
        let n = zone.mode_offsets(SPACE)[1];
        let mut stretch = vec![0.0; n * n];
        for (p, rho) in equilibrium.quadrature.front.iter().zip(&fronts.slope_jump) {
            let residual = rho - membrane.adhesive_slope(p.side, &p.x).0;
            assert!(residual > 0.0, "the zone is too small for this test");
            let frame = zone.frame(p.front, &p.x, SPACE);
            for &(i, v) in &frame.modes {
                for &(j, w) in &frame.modes {
                    stretch[i * n + j] += p.weight * frame.curvature * residual * v * w;
                }
            }
        }
        (linearised.residual, linearised.rate, stretch)
    };
    let (residual, rate, stretch) = excess(&zone);
    let n = residual.len();
    let direction: Vec<f64> = (0..n).map(|i| 1.0 + (1.7 * i as f64).sin()).collect();
    let predicted: Vec<f64> =
        (0..n).map(|i| (0..n).map(|j| (rate[i * n + j] + stretch[i * n + j]) * direction[j]).sum()).collect();
    let error = signorini_verify::taylor::central_difference_error(&predicted, 1e-3, |step| {
        let moved: Vec<f64> = direction.iter().map(|d| d * step).collect();
        excess(&zone.displaced(SPACE, &moved)).0
    });
    assert!(error <= 5e-3, "{error}");
}

#[test]
fn stability_is_the_second_change_of_the_energy() {
    let membrane = sticky(20, 4, Side::Below);
    let mut elements = Elements::new(&membrane);
    let start: Start<PlaneZone> = Start::Asked(zone_of(&membrane, 0.6), Branch::Nearest);
    let solution = solve(&membrane, &mut elements, start, StoppingRule::Final, (0, 0.0), &mut Silent);
    assert_eq!(solution.reason, Reason::Converged);
    let energy = |zone: &PlaneZone| {
        let state = Equilibrium::solve(&membrane, zone, &mut Elements::new(&membrane)).expect("an equilibrium");
        let mut sum = 0.0;
        state.for_each_point(|cell, region, x, w| {
            let (u, gradient, stuck) = match contact_index(region) {
                Some(_) => {
                    let body = &membrane.obstacles.0[0];
                    let h = body.height.jet(x);
                    (h.value, h.gradient, body.adhesion.as_ref().expect("an adhesion").value(x))
                }
                None if is_free(region) => {
                    let (u, gradient) = state.evaluate(cell, region, x).expect("a state");
                    (u, gradient, 0.0)
                }
                None => return,
            };
            let elastic = 0.5 * membrane.tension.value(x) * gradient.norm_squared();
            sum += w * (elastic - membrane.load.value(x) * u - stuck);
        });
        sum
    };
    let zone = &solution.zone;
    let equilibrium = solution.equilibrium.as_ref().expect("a state");
    let scales = solution.scales.expect("scales");
    let fronts = Fronts::new(equilibrium, true);
    let linearised = fronts.linearise(zone, ModeSpace::Fine, &scales).expect("a derivative");
    let n = zone.mode_offsets(ModeSpace::Fine)[1];
    for frequency in [0.0, 1.0, 2.0] {
        let mode = |i: usize| (std::f64::consts::TAU * frequency * i as f64 / n as f64).cos();
        let direction: Vec<f64> = (0..n).map(mode).collect();
        let step = 4e-3;
        let at =
            |s: f64| energy(&zone.displaced(ModeSpace::Fine, &direction.iter().map(|d| d * s).collect::<Vec<_>>()));
        let change = (at(step) - 2.0 * energy(zone) + at(-step)) / (step * step);
        let predicted = linearised.second_variation(&direction);
        assert!((change / predicted - 1.0).abs() < 1e-2, "{frequency}: {change} {predicted}");
        assert!(predicted > 0.0);
    }
}

/// As a front passes a corner of cells, one more of them holds a sliver of the free membrane, which two neighbours would
/// each have go on as they do. The slope jump does not jump.
#[test]
fn the_slope_jump_is_continuous_where_fronts_pass_corners_of_cells() {
    for degree in 1..=4 {
        let membrane = membrane(12, degree, Side::Below);
        let centre = Point::<2>::new(0.07, -0.04);
        let corner = membrane.grid.cell_box(membrane.grid.cell_containing(&Point::<2>::new(0.35, 0.3))).min;
        let circle = |radius: f64| {
            let points: Vec<Point<2>> = (0..24)
                .map(|i| {
                    let (sin, cos) = (std::f64::consts::TAU * f64::from(i) / 24.0).sin_cos();
                    centre + radius * Point::<2>::new(cos, sin)
                })
                .collect();
            PlaneZone::new(&membrane.grid, vec![(Side::Below, ClosedCurve::through(&points, 9))])
        };
        let through = (corner - centre).norm();
        let change = |from: f64, to: f64| {
            let [a, b] = [from, to].map(|part| circle(through + part * membrane.grid.h()));
            let [a, b] = [moments(&membrane, &a, &a), moments(&membrane, &b, &a)];
            size(&a.iter().zip(&b).map(|(a, b)| b - a).collect::<Vec<_>>()) / size(&a)
        };
        // Across the corner it changes as it does beside it.
        let (across, beside) = (change(-1e-4, 1e-4), change(2e-2, 2e-2 + 2e-4));
        assert!(across < 2.0 * beside, "degree {degree}: {across:e} against {beside:e}");
    }
}
