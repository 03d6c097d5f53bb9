//! Single solids against exact states: homogeneous stretches, rigid motions, resultants.

use super::*;
use signorini_fem::Side;
use signorini_solid::Volumetric;

/// A stretched bar, one side held: stretch, the stretch across that leaves no stress, and the stress (E = 1, ν = 0.3).
const HELD: [(StressLaw, [[f64; 3]; 2]); 3] = [
    (
        StressLaw::NeoHooke(Volumetric::Logarithmic),
        [[0.7, 1.1507960463303386, -0.4584239232140321], [1.5, 0.8249236422395783, 0.4024361498651765]],
    ),
    (
        StressLaw::NeoHooke(Volumetric::Quadratic),
        [[0.7, 1.1312415725341851, -0.43390521726901987], [1.5, 0.8069465847859288, 0.409958258795468]],
    ),
    (
        StressLaw::SaintVenantKirchhoff,
        [[0.7, 1.1038892283972286, -0.19615384615384615], [1.5, 0.6813851438692469, 1.0302197802197801]],
    ),
];

/// The same without side held.
const FREE: [(StressLaw, [f64; 3]); 3] = [
    (StressLaw::NeoHooke(Volumetric::Logarithmic), [0.7, 1.1079347328484763, -0.40523042431429934]),
    (StressLaw::NeoHooke(Volumetric::Quadratic), [0.7, 1.1004673201164705, -0.39616940804633327]),
    (StressLaw::SaintVenantKirchhoff, [0.7, 1.0737783756436894, -0.1785]),
];

#[test]
fn homogeneous_stretches_of_distorted_cells() {
    for (law, rows) in HELD {
        for [stretch, lateral, stress] in rows {
            for degree in [1, 2, 4] {
                let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [2, 2], 1, |x| {
                    let inner = x[0] == 0.5 && x[1] == 0.5;
                    if inner { Point::<2>::new(0.58, 0.43) } else { x }
                });
                let mut system = System::default();
                system.bodies.push(Box::new(solid("bar", mesh, degree, ELASTIC, law.clone())));
                system.supports.push(hold(0, "left", [Some(0.0), None, None]));
                system.supports.push(hold(0, "bottom", [None, Some(0.0), None]));
                system.supports.push(hold(0, "right", [Some(stretch - 1.0), None, None]));
                let (state, results) = run(&mut system, &[0.5, 1.0]);
                let last = results.last().unwrap();
                let drawn = last.support_forces[2][0][0];
                assert!((drawn - stress).abs() < 1e-9, "{} degree {degree}: {drawn} {stress}", law.name());
                let fields = system.bodies[0].fields(&state.bodies[0]);
                for (x, u) in fields.points.iter().zip(&fields.displacement) {
                    assert!(
                        (u[0] - (stretch - 1.0) * x[0]).abs() < 1e-9 && (u[1] - (lateral - 1.0) * x[1]).abs() < 1e-9
                    );
                }
                let (_, _, shown) = &fields.point_data[0];
                let cauchy = stress / lateral;
                assert!(
                    shown.chunks(6).all(|s| (s[0] - cauchy).abs() < 1e-8 && s[1].abs() < 1e-8),
                    "{cauchy} {shown:?}"
                );
                assert!(is_quadratic(&last.history), "{:?}", last.history);
            }
        }
    }
}

#[test]
fn homogeneous_stretches_in_space_in_plane_stress_and_about_an_axis() {
    for (law, [stretch, lateral, stress]) in FREE {
        let mut system = System::default();
        system.bodies.push(Box::new(solid(
            "bar",
            cuboid([0.0; 3], [1.0; 3], [1, 1, 2], |x| x),
            2,
            ELASTIC,
            law.clone(),
        )));
        system.supports.push(hold(0, "left", [Some(0.0), None, None]));
        system.supports.push(hold(0, "front", [None, Some(0.0), None]));
        system.supports.push(hold(0, "bottom", [None, None, Some(0.0)]));
        system.supports.push(hold(0, "top", [None, None, Some(stretch - 1.0)]));
        let (_, results) = run(&mut system, &[0.5, 1.0]);
        let drawn = results[1].support_forces[3][0][2];
        assert!((drawn - stress).abs() < 1e-9, "{}: {drawn} {stress}", law.name());
        for space in [Space::PlaneStress, Space::Axisymmetric] {
            let mesh = rectangle([0.0, 0.0], [1.0, 1.0], [2, 2], 1, |x| x);
            let groups = mesh.groups().clone();
            let mut system = System::default();
            let body = SolidBody::new("bar", Arc::new(mesh), 2, (ELASTIC, law.clone()), space, groups).unwrap();
            system.bodies.push(Box::new(body));
            system.supports.push(hold(0, "left", [Some(0.0), None, None]));
            system.supports.push(hold(0, "bottom", [None, Some(0.0), None]));
            system.supports.push(hold(0, "top", [None, Some(stretch - 1.0), None]));
            let (state, results) = run(&mut system, &[0.5, 1.0]);
            let area = if space == Space::Axisymmetric { std::f64::consts::PI } else { 1.0 };
            let drawn = results[1].support_forces[2][0][1] / area;
            assert!((drawn - stress).abs() < 1e-9, "{} {space:?}: {drawn} {stress}", law.name());
            let fields = system.bodies[0].fields(&state.bodies[0]);
            let cauchy = stress / (lateral * lateral);
            let (_, _, shown) = &fields.point_data[0];
            assert!(shown.chunks(6).all(|s| (s[1] - cauchy).abs() < 1e-8), "{cauchy} {shown:?}");
        }
    }
}

#[test]
fn a_rigid_motion_costs_nothing_at_finite_strain() {
    let mesh = rectangle([0.0, 0.0], [2.0, 1.0], [2, 1], 2, |x| Point::<2>::new(x[0], x[1] + 0.2 * x[0] * x[0]));
    for (law, _) in FREE {
        for degree in 2..=3 {
            let body = solid("body", mesh.clone(), degree, ELASTIC, law.clone());
            let modes = body.rigid_modes(&body.start());
            // x turned by a quarter: (-y, x), plus the shift that this needs.
            let identity: Vec<f64> = {
                // The coefficients of the position itself, from the turn about z: (-y, x) turned back.
                let turn = &modes[5];
                (0..turn.len()).map(|k| if k % 2 == 0 { turn[k + 1] } else { -turn[k - 1] }).collect()
            };
            let u: Vec<f64> = modes[5].iter().zip(&identity).map(|(t, x)| t - x).collect();
            let mut out = Contribution::new(body.unknowns());
            let state = BodyState { configuration: u, internal: Vec::new() };
            let energy = body.internal(&state, Order::First, &mut out).unwrap();
            let most = out.forces.iter().fold(0.0f64, |m, f| m.max(f.abs()));
            assert!(most < 1e-12 && energy.abs() < 1e-12, "{}: {most:e} {energy:e}", law.name());
        }
    }
}

#[test]
fn loads_have_the_resultants_that_they_state() {
    for degree in 1..=3 {
        let mesh = cuboid([0.0; 3], [1.0, 2.0, 0.5], [2, 1, 1], |mut x| {
            x[2] += 0.1 * x[0];
            x
        });
        let mut mesh = mesh;
        mesh.group_mut("corner").vertices = vec![0];
        let body = solid("body", mesh, degree, ELASTIC, StressLaw::LinearElastic);
        let given = v(1.0, -2.0, 0.5);
        let constant = move |_: &Point<3>| given;
        let modes = body.rigid_modes(&body.start());
        let top = 2.0 * 1.01f64.sqrt();
        let cases: [(Option<&str>, Load<'_>, f64); 5] = [
            (Some("top"), Load::Force(given), 1.0),
            (None, Load::Force(given), 1.0),
            (Some("corner"), Load::Force(given), 1.0),
            (Some("top"), Load::Traction(&constant), top),
            (None, Load::BodyForce(&constant), 1.0),
        ];
        for (on, load, factor) in cases {
            let mut out = Contribution::new(body.unknowns());
            body.load(on, &load, &body.start(), Order::First, &mut out).unwrap();
            for (i, mode) in modes[..3].iter().enumerate() {
                let along: f64 = mode.iter().zip(&out.forces).map(|(m, f)| -m * f).sum();
                assert!((along - factor * given[i]).abs() < 1e-12, "{on:?} {i}: {along}");
            }
        }
        let refused =
            body.load(Some("nowhere"), &Load::Force(given), &body.start(), Order::First, &mut Contribution::new(1));
        assert!(refused.unwrap_err().to_string().contains("boundary"));
    }
}

#[test]
fn a_moment_has_no_resultant_wherever_its_place_has_moved() {
    let mesh = cuboid([0.0; 3], [1.0, 2.0, 0.5], [2, 1, 1], |mut x| {
        x[2] += 0.1 * x[0];
        x
    });
    let given = v(0.3, -0.2, 0.7);
    for (law, size) in [(StressLaw::LinearElastic, 0.0), (HELD[1].0.clone(), 0.1)] {
        for degree in 1..=2 {
            let body = solid("body", mesh.clone(), degree, ELASTIC, law.clone());
            let seed = &mut 7u64;
            let configuration = (0..body.unknowns()).map(|_| size * noise(seed)).collect();
            let state = BodyState { configuration, internal: Vec::new() };
            let mut out = Contribution::new(body.unknowns());
            body.load(Some("right"), &Load::Moment(given), &state, Order::First, &mut out).unwrap();
            for (k, mode) in body.rigid_modes(&state).iter().enumerate() {
                let along: f64 = mode.iter().zip(&out.forces).map(|(m, f)| -m * f).sum();
                let wanted = if k < 3 { 0.0 } else { given[k - 3] };
                assert!((along - wanted).abs() < 1e-12, "{} degree {degree} {k}: {along}", law.name());
            }
        }
    }
    // Pure bending of a bar: stress M y/I, exact for quadratic functions.
    let mut system = System::default();
    let bar = rectangle([0.0, -0.5], [4.0, 0.5], [4, 1], 1, |x| x);
    system.bodies.push(Box::new(solid(
        "bar",
        bar,
        2,
        Elastic { poissons_ratio: 0.0, ..ELASTIC },
        StressLaw::LinearElastic,
    )));
    system.supports.push(hold(0, "left", [Some(0.0), Some(0.0), None]));
    system.loads.push(load(0, "right", TimedLoad::Moment(Arc::new(|_, t| v(0.0, 0.0, 1e-3 * t)))));
    let (state, results) = run(&mut system, &[1.0]);
    let fields = system.bodies[0].fields(&state.bodies[0]);
    let inertia = 1.0 / 12.0;
    for (x, u) in fields.points.iter().zip(&fields.displacement) {
        let known = [-1e-3 / inertia * x[0] * x[1], 0.5e-3 / inertia * x[0] * x[0]];
        assert!((u[0] - known[0]).abs() < 1e-9 && (u[1] - known[1]).abs() < 1e-9, "{x} {u} {known:?}");
    }
    let [force, moment] = results[0].support_forces[0];
    assert!(force.norm() < 1e-12, "{force} {moment}");
}

#[test]
fn an_inverted_cell_is_named() {
    let body = solid("body", rectangle([0.0, 0.0], [2.0, 1.0], [2, 1], 1, |x| x), 1, ELASTIC, HELD[0].0.clone());
    let mut state = body.start();
    let pushed = body.dofs().vertex(body.mesh().side_vertices(Side { cell: 1, side: 1 })[0]).unwrap();
    state.configuration[2 * pushed as usize] = -2.5;
    let refused = body.internal(&state, Order::First, &mut Contribution::new(body.unknowns()));
    assert!(matches!(refused, Err(BodyError::Inverted { cell: 1, .. })), "{refused:?}");
}
