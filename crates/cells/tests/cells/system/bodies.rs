//! One body: linear fields, supports on sides and on the recovered boundary, loads, rigid motions, what is shown.

use super::*;
use signorini_cells::shapes::{Ellipsoid, HalfSpace, ball};
use signorini_geometry::Matrix;

/// What the fictitious stiffness of 1e-12 leaves: a tenth of its root.
const BOUND: f64 = 1e-7;

/// A block cut off by an oblique plane, held at a linear displacement by one side of the box and by the cut, loaded by
/// what the stress of that displacement is on all other sides: the largest error, and how far forces are out of balance.
fn linear_field<const D: usize>(space: Space, degree: usize, n: usize) -> [f64; 2] {
    let b = aabb([0.0; D], [1.0; D]);
    let normal = Vector::<D>::from_fn(|k, _| [1.0, 0.2, 0.4][k]).normalize();
    let cut = Domain::shape(HalfSpace { point: normal * 0.62, normal });
    let mut places = vec![("left", Place::low(0)), ("cut", Place::boundary(|_| true))];
    for (k, name) in ["", "y", "z"].into_iter().enumerate().take(D).skip(1) {
        places.push((if k == 1 { "low y" } else { "low z" }, Place::low(k)));
        places.push((if k == 1 { "high y" } else { "high z" }, Place::high(k)));
        assert!(!name.is_empty());
    }
    let body = solid("block", cut, (b, [n; D]), degree, space, places.clone());
    let gradient = Matrix::<3>::from_fn(|i, j| {
        if i < D && j < D { 0.3 - 0.1 * i as f64 + 0.25 * j as f64 - 0.2 * (i * j) as f64 } else { 0.0 }
    });
    let stress = body.cells().stress_at(&b.center(), &gradient);
    let exact = move |x: &Point<3>| gradient * x + v(0.1, 0.1, 0.1);
    let held = || -> [Option<Arc<dyn Fn(&Point<3>) -> f64 + Send + Sync>>; 3] {
        std::array::from_fn(|k| {
            let field: Arc<dyn Fn(&Point<3>) -> f64 + Send + Sync> = Arc::new(move |x: &Point<3>| exact(x)[k]);
            (k < D).then_some(field)
        })
    };
    let mut system = System {
        supports: vec![support(0, "left", held()), support(0, "cut", held())],
        bodies: vec![Box::new(body)],
        ..System::default()
    };
    let mut pull = Vector::<3>::zeros();
    for (name, place) in &places[2..] {
        let Place::Side { axis, end } = place else { panic!() };
        let n = Vector::<3>::from_fn(|k, _| if k == *axis { end.sign() } else { 0.0 });
        let load = TimedLoad::Traction(Arc::new(move |_, t| stress * n * t));
        system.loads.push(PlacedLoad { name: name.to_string(), part: part(0, name), load });
    }
    let (state, found) = solve(&mut system);
    for load in 0..system.loads.len() {
        pull += system.load_resultant(load, &state, 1.0).unwrap()[0];
    }
    let mut errors = [0.0f64; 2];
    for site in system.bodies[0].sites(Some("cut"), Sampling::GaussPoints).unwrap() {
        let rest = system.bodies[0].placed(&system.bodies[0].start(), &site).x;
        let now = system.bodies[0].placed(&state.bodies[0], &site);
        let wanted = (exact(&rest) - v(0.0, 0.0, if D == 2 { 0.1 } else { 0.0 })) + rest;
        errors[0] = errors[0].max((now.x - wanted).norm());
        // The normal of a plane that a linear map moves.
        let turned = (Matrix::<3>::identity() + gradient).try_inverse().unwrap().transpose();
        let n = turned * Vector::<3>::from_fn(|k, _| if k < D { normal[k] } else { 0.0 });
        errors[1] = errors[1].max((now.outward.unwrap() - n.normalize()).norm());
    }
    let samples = system.bodies[0].samples(&state.bodies[0]).unwrap();
    let [material, displacement, stresses, _] = &samples.data[..] else { panic!() };
    let place = |i: usize| {
        [i % samples.counts[0], i / samples.counts[0] % samples.counts[1], i / samples.counts[0] / samples.counts[1]]
    };
    for (i, there) in material.2.iter().enumerate() {
        let x = Point::<3>::from_fn(|k, _| samples.origin[k] + (place(i)[k] as f64 + 0.5) * samples.spacing[k]);
        let is_in = (0..D).map(|k| normal[k] * x[k]).sum::<f64>() < 0.62;
        assert_eq!(*there, f64::from(u8::from(is_in)));
        let wanted = Vector::<3>::from_fn(|k, _| if k < D { exact(&x)[k] } else { 0.0 }) * *there;
        errors[0] = errors[0].max((Vector::<3>::from_column_slice(&displacement.2[3 * i..3 * i + 3]) - wanted).norm());
        errors[0] = errors[0].max((stresses.2[6 * i + 3] - stress[(0, 1)] * there).abs() / ELASTIC.youngs_modulus);
    }
    println!("{space:?}, degree {degree}: displacement {:e}, normal {:e}", errors[0], errors[1]);
    let error = errors[0].max(errors[1]);
    let forces: Vector<3> = found.support_forces.iter().map(|f| f[0]).sum();
    [error, (forces + pull).norm() / found.support_forces[1][0].norm()]
}

#[test]
fn linear_fields_are_exact_with_nitsche_and_forces_balance() {
    for space in [Space::PlaneStrain, Space::PlaneStress] {
        for degree in 1..=3 {
            let [error, imbalance] = linear_field::<2>(space, degree, 4);
            println!("{space:?}, degree {degree}: {error:e}, {imbalance:e}");
            assert!(error < BOUND && imbalance < 1e-10, "{space:?} {degree}: {error:e} {imbalance:e}");
        }
    }
    let [error, imbalance] = linear_field::<3>(Space::Solid, 2, 2);
    println!("space, degree 2: {error:e}, {imbalance:e}");
    assert!(error < BOUND && imbalance < 1e-10, "{error:e} {imbalance:e}");
}

/// A half ball around its axis under pressure: `u = -p (1 - 2ν) x / E`; nothing leaves the axis.
#[test]
fn a_ball_around_its_axis_under_pressure() {
    let b = aabb([0.0, 0.0], [1.1, 1.1]);
    let domain = Domain::shape(ball(Point::<2>::zeros(), 0.9));
    let body = solid("ball", domain, (b, [4, 4]), 3, Space::Axisymmetric, vec![("middle", Place::low(1))]);
    let volume = 2.0 / 3.0 * std::f64::consts::PI * 0.729;
    let pressure = TimedLoad::Pressure(Arc::new(|_, t| 2.0 * t));
    let force = TimedLoad::Force(Arc::new(|_, _| Vector::<3>::zeros()));
    let mut system = System {
        supports: vec![support(0, "middle", [None, constant(0.0), None])],
        loads: vec![
            PlacedLoad { name: "sea".into(), part: part(0, "boundary"), load: pressure },
            PlacedLoad { name: "none".into(), part: part(0, ""), load: force },
        ],
        bodies: vec![Box::new(body)],
        ..System::default()
    };
    let (state, found) = solve(&mut system);
    for site in system.bodies[0].sites(None, Sampling::GaussPoints).unwrap() {
        let x = system.bodies[0].placed(&system.bodies[0].start(), &site).x;
        let now = system.bodies[0].placed(&state.bodies[0], &site).x;
        assert!((now - x * (1.0 - 0.8)).norm() < 1e-7, "{x} {now}");
    }
    // The middle carries the pressure on the projection of the half ball.
    let wanted = 2.0 * std::f64::consts::PI * 0.81;
    let force = found.support_forces[0][0][1];
    assert!((force / wanted - 1.0).abs() < 1e-8, "{force} {wanted}");
    // Energy: ½ σ:ε V with σ = -p 1.
    let energy = 0.5 * 2.0 * 3.0 * 0.8 * volume;
    assert!((found.energy / energy - 1.0).abs() < 1e-7, "{} {energy}", found.energy);
}

/// A plate with a hole, refined on one side: rigid motions cost nothing and move all points alike; loads have the
/// resultants that they state; what is held by a refined side as well.
#[test]
fn rigid_motions_and_resultants_on_refined_cells() {
    let b = aabb([-1.0, -0.7], [1.0, 1.0]);
    let hole = Ellipsoid { center: Point::<2>::new(0.1, 0.2), semi_axes: [0.3, 0.2] };
    let mut tree = CellTree::new(b, [3, 4]).unwrap();
    tree.refine(|l| l.bounds.center()[0] > 0.0).unwrap();
    tree.refine(|l| l.level == 1 && l.bounds.center()[1] > 0.5).unwrap();
    let body = cells(Domain::Complement(Box::new(Domain::shape(hole))), tree, 3, Space::PlaneStrain).unwrap();
    let places = named(vec![("top", Place::high(1)), ("hole", Place::boundary(|_| true)), ("left", Place::low(0))]);
    let body = CellSolid::new("plate", body, &places).unwrap();
    let modes = body.rigid_modes(&body.start());
    for (mode, motion) in modes.iter().enumerate() {
        if !(mode < 2 || mode == 5) {
            assert!(motion.iter().all(|m| *m == 0.0));
            continue;
        }
        let state = BodyState { configuration: motion.clone(), internal: Vec::new() };
        let mut out = Contribution::new(body.unknowns());
        let energy = body.internal(&state, Order::First, &mut out).unwrap();
        assert!(energy.abs() < 1e-13 && out.forces.iter().all(|f| f.abs() < 1e-12), "{mode}: {energy:e}");
        for place in ["top", "hole", "left"] {
            for site in body.sites(Some(place), Sampling::GaussPoints).unwrap() {
                let x = body.placed(&body.start(), &site).x;
                let moved = body.placed(&state, &site).x - x;
                let wanted = if mode < 3 { signorini_mechanics::pair::axis(mode) } else { v(-x[1], x[0], 0.0) };
                assert!((moved - wanted).norm() < 1e-12, "{mode} {x} {moved}");
            }
        }
    }
    let given = v(1.0, -2.0, 0.0);
    let uniform = move |_: &Point<3>| given;
    let area = body.cells().volume();
    assert!((area / (2.0 * 1.7 - std::f64::consts::PI * 0.06) - 1.0).abs() < 1e-7);
    let cases: [(Option<&str>, Load<'_>, Vector<3>); 5] = [
        (Some("top"), Load::Force(given), given),
        (None, Load::Force(given), given),
        (Some("top"), Load::Traction(&uniform), given * 2.0),
        (None, Load::BodyForce(&uniform), given * area),
        (Some("top"), Load::Pressure(&|_| 3.0), v(0.0, -6.0, 0.0)),
    ];
    for (on, load, wanted) in cases {
        let mut out = Contribution::new(body.unknowns());
        body.load(on, &load, &body.start(), Order::First, &mut out).unwrap();
        for i in 0..2 {
            let along: f64 = modes[i].iter().zip(&out.forces).map(|(m, f)| -m * f).sum();
            assert!((along - wanted[i]).abs() < 1e-12 * area, "{on:?} {i}: {along} {wanted}");
        }
    }
    // A side that is refined in part, pulled with a force: the support carries it.
    let mut system = System {
        supports: vec![support(0, "left", [constant(0.0), constant(0.0), None])],
        loads: vec![PlacedLoad {
            name: "pull".into(),
            part: part(0, "top"),
            load: TimedLoad::Force(Arc::new(move |_, t| given * t)),
        }],
        bodies: vec![Box::new(body)],
        ..System::default()
    };
    let (state, found) = solve(&mut system);
    assert!((found.support_forces[0][0] + given).norm() < 1e-9, "{}", found.support_forces[0][0]);
    system.supports[0] = support(0, "top", [constant(0.01), constant(0.0), None]);
    system.loads[0].part = part(0, "left");
    let (_, found) = solve(&mut system);
    assert!((found.support_forces[0][0] + given).norm() < 1e-9, "{}", found.support_forces[0][0]);
    // What is shown is the plate without its hole.
    let fields = system.bodies[0].fields(&state.bodies[0]);
    let shown: f64 = (fields.cells.iter())
        .map(|c| {
            let p: Vec<Point<3>> = c.iter().map(|k| fields.points[*k as usize]).collect();
            let twice = |i: usize| p[i].cross(&p[(i + 1) % p.len()])[2];
            0.5 * (0..p.len()).map(twice).sum::<f64>()
        })
        .sum();
    assert!((shown / area - 1.0).abs() < 3e-3, "{shown} {area}");
    assert_eq!(fields.point_data[0].2.len(), 6 * fields.points.len());
    // So is its image.
    let samples = system.bodies[0].samples(&state.bodies[0]).unwrap();
    let sampled = samples.data[0].2.iter().sum::<f64>() * samples.spacing[0] * samples.spacing[1];
    assert!((sampled / area - 1.0).abs() < 0.05, "{sampled} {area}");
}

/// Springs on the recovered boundary and a support there make the tangent that differences tell.
#[test]
fn springs_carry_a_load() {
    let disc = Domain::shape(ball(Point::<2>::zeros(), 0.8));
    let body = solid("disc", disc, (aabb([-1.0; 2], [1.0; 2]), [4, 4]), 2, Space::PlaneStress, Vec::new());
    let mut system = System {
        loads: vec![
            PlacedLoad { name: "bed".into(), part: part(0, ""), load: TimedLoad::Springs(v(0.5, 2.0, 0.0)) },
            PlacedLoad {
                name: "weight".into(),
                part: part(0, ""),
                load: TimedLoad::BodyForce(Arc::new(|_, t| v(0.1, -0.2, 0.0) * t)),
            },
        ],
        bodies: vec![Box::new(body)],
        ..System::default()
    };
    let (state, found) = solve(&mut system);
    let carried = system.load_resultant(0, &state, 1.0).unwrap()[0];
    let area = std::f64::consts::PI * 0.64;
    assert!((carried + v(0.1, -0.2, 0.0) * area).norm() < 1e-9, "{carried}");
    assert!(found.iterations <= 2, "{}", found.iterations);
    let error = tangent_error(&system, &state, 1e-3, 20);
    assert!(error < 1e-10, "{error:e}");
}

#[test]
fn what_cannot_be_is_told() {
    let disc = Domain::shape(ball(Point::<2>::zeros(), 0.8));
    let body = solid("disc", disc, (aabb([-1.0; 2], [1.0; 2]), [3, 3]), 1, Space::PlaneStrain, Vec::new());
    let start = body.start();
    let refused = |e: PlaceError| e.to_string();
    assert!(refused(body.sites(Some("rim"), Sampling::GaussPoints).unwrap_err()).contains("boundary"));
    let mut out = Contribution::new(body.unknowns());
    let moment = Load::Moment(Vector::<3>::z());
    assert!(refused(body.load(None, &moment, &start, Order::First, &mut out).unwrap_err()).contains("tractions"));
    let force = Load::BodyForce(&|_| Vector::<3>::x());
    let on = Some("boundary");
    assert!(refused(body.load(on, &force, &start, Order::First, &mut out).unwrap_err()).contains("no volume"));
}

/// What supports and springs leave free is told before anything is solved, also of a body far from the origin.
#[test]
fn a_body_that_nothing_holds_is_told() {
    for far in [0.0, 1e3] {
        let disc = Domain::shape(ball(Point::<2>::new(far, 0.0), 0.8));
        let b = aabb([far - 1.0, -1.0], [far + 1.0, 1.0]);
        let places = vec![("right", Place::boundary(move |p| p.x[0] > far + 0.6))];
        let body = solid("disc", disc, (b, [4, 4]), 2, Space::PlaneStrain, places);
        let mut system = System { bodies: vec![Box::new(body)], ..System::default() };
        let told = |system: &System| system.unheld().unwrap().map(|found| found.1);
        assert_eq!(told(&system).as_deref(), Some("moving along x"));
        system.supports = vec![support(0, "right", [constant(0.0), None, None])];
        assert_eq!(told(&system).as_deref(), Some("moving along y"));
        let spring = TimedLoad::Springs(v(0.0, 2.0, 0.0));
        system.loads = vec![PlacedLoad { name: "bed".into(), part: part(0, "right"), load: spring }];
        assert_eq!(told(&system), None);
        system.supports = vec![support(0, "right", [constant(0.0), constant(0.0), None])];
        system.loads.clear();
        assert_eq!(told(&system), None);
    }
}
