//! Friction on rigid bodies, at rest and moved; and orthotropic friction.

use super::*;
use signorini_contact::Coulomb;

/// A flat block on a rigid plane that only friction holds, under a dead force down a slope of `angle` degrees, towards
/// `psi` degrees from the first axis of friction; beds of this stiffness hold its top sideways.
fn on_incline(angle: f64, psi: f64, mu: [f64; 2], bed: f64) -> Result<State<3>, StepError> {
    let turned = 0.3;
    let mesh = block::<3>(&[even(-1.0, 1.0, 2), even(-1.0, 1.0, 3), even(0.0, 0.25, 1)], 1, |x| x);
    let groups = mesh.groups().clone();
    let mut bodies = Bodies::<3>::new(Space::Solid);
    bodies.add("block", mesh, 1, ELASTIC);
    let slave = bodies.surface(0, groups["bottom"].sides.clone());
    let mut contact = Contact::new("plane", slave, Master::Rigid);
    let axis = Some(Point::<3>::new(f64::cos(turned), f64::sin(turned), 0.7));
    contact.friction = Some(Friction { law: Box::new(Coulomb::orthotropic(mu).unwrap()), axis });
    let weight = Load { name: "weight".into(), body: 0, group: groups["top"].clone(), kind: LoadKind::Force };
    let (s, c) = angle.to_radians().sin_cos();
    let towards = psi.to_radians() + turned;
    let force = Point::<3>::new(s * towards.cos(), s * towards.sin(), -c);
    let load = loads::forces(&bodies, &weight, &|_| force);
    let beds = support("bed", 0, &groups, "top", SupportKind::Spring(vec![bed, bed, 0.0]));
    let supports = if bed > 0.0 { vec![beds] } else { vec![] };
    let mut model = Model::new(bodies, supports, vec![contact])?;
    assert_eq!(model.free_modes().len(), if bed > 0.0 { 3 } else { 6 });
    let now = Circumstances {
        displacement: &|_, _| Point::<3>::zeros(),
        load,
        rigid: vec![Some(flat(Point::<3>::z()))],
        motion: vec![],
    };
    let state = model.solve(&now, &mut |_, _| true)?;
    if bed == 0.0 {
        assert!((state.contacts[0].force + force).norm() < 1e-9, "{:?}", state.contacts[0].force);
    }
    Ok(state)
}

/// Where a block begins to slide on an orthotropic incline, what is said then, and which way it goes.
#[test]
fn a_block_on_an_orthotropic_incline() {
    for (psi, mu) in [(35.0f64, [0.3, 0.6]), (60.0, [0.4, 0.25]), (20.0, [0.2, 0.5])] {
        let (critical, onset) = signorini_verify::friction::orthotropic_incline(psi.to_radians(), mu);
        let (critical, onset) = (critical.to_degrees(), onset.to_degrees());
        for share in [0.5, 0.95, 0.995] {
            let state = on_incline(share * critical, psi, mu, 0.0).unwrap_or_else(|e| panic!("{share}: {e}"));
            let friction = state.contacts[0].friction.as_ref().unwrap();
            let expected = (share * critical).to_radians().sin();
            assert!((friction.force.norm() - expected).abs() < 1e-9);
            assert!(friction.max_utilisation <= 1.0 + 1e-12);
        }
        match on_incline(1.01 * critical, psi, mu, 0.0) {
            Err(StepError::Slides { body, demanded, available, .. }) => {
                let [over, limit] = [1.01, 1.0].map(|s: f64| (s * critical).to_radians().tan());
                assert!(body == "block" && (demanded / available / (over / limit) - 1.0).abs() < 1e-9);
            }
            other => panic!("{:?}", other.map(|s| s.contacts[0].force)),
        }
        // A weak bed lets it slide: so far that all nodes slide the same way.
        let state = on_incline(1.001 * critical, psi, mu, 1e-4).unwrap();
        for node in &state.contacts[0].nodes {
            let slip = node.rubbing.slip;
            let direction = (slip[1].atan2(slip[0]) - 0.3).to_degrees();
            assert!(node.rubbing.status == Status::Slip && (direction - onset).abs() < 0.3, "{direction} {onset}");
        }
    }
}

/// Two blocks of unlike cells that slide over each other: everywhere on the ellipse, and slipping normal to it.
#[test]
fn orthotropic_slip_is_associated() {
    for upper_is_slave in [false, true] {
        let mesh = |low: f64, high: f64, n: usize| {
            block::<3>(&[even(0.0, 1.0, n), even(0.0, 1.0, n), even(low, high, 1)], 1, |x| x)
        };
        let (lower, upper) = (mesh(-0.5, 0.0, 3), mesh(0.0, 0.5, 2));
        let groups = [lower.groups().clone(), upper.groups().clone()];
        let mut bodies = Bodies::<3>::new(Space::Solid);
        bodies.add("lower", lower, 1, ELASTIC);
        bodies.add("upper", upper, 1, ELASTIC);
        let all = || SupportKind::Components(vec![true; 3]);
        let supports =
            vec![support("base", 0, &groups[0], "bottom", all()), support("grip", 1, &groups[1], "top", all())];
        let [low, high] =
            [(0, "top"), (1, "bottom")].map(|(b, g): (usize, &str)| bodies.surface(b, groups[b][g].sides.clone()));
        let (slave, master) = if upper_is_slave { (high, low) } else { (low, high) };
        let mut contact = Contact::new("interface", slave, Master::Surface(master));
        let (mu, axis) = ([0.3, 0.5], Point::<3>::new(0.8, 0.6, 0.0));
        contact.friction = Some(Friction { law: Box::new(Coulomb::orthotropic(mu).unwrap()), axis: Some(axis) });
        let load = vec![0.0; bodies.unknowns()];
        let mut model = Model::new(bodies, supports, vec![contact]).unwrap();
        let displacement = |k: usize, _: &Point<3>| Point::<3>::new(0.05, 0.02, -0.002) * k as f64;
        let now = Circumstances { displacement: &displacement, load, rigid: vec![None], motion: vec![] };
        let state = model.solve(&now, &mut |_, _| true).unwrap();
        assert!(state.iterations <= 8 && state.imbalance < 1e-10);
        for node in state.contacts[0].nodes.iter().filter(|n| n.active) {
            assert!(node.rubbing.status == Status::Slip && (node.rubbing.utilisation - 1.0).abs() < 1e-9);
            // In the axes of friction.
            let [across, t, s] = [axis.yxz(), node.rubbing.traction, node.rubbing.increment];
            let across = Point::<3>::new(-across[0], across[1], 0.0);
            let [t, s] = [t, s].map(|v| [v.dot(&axis), v.dot(&across)]);
            let normal = [-t[0] / mu[0].powi(2), -t[1] / mu[1].powi(2)];
            let sine = (normal[0] * s[1] - normal[1] * s[0]) / (normal[0].hypot(normal[1]) * s[0].hypot(s[1]));
            assert!(sine.abs() < 1e-7 && normal[0] * s[0] + normal[1] * s[1] > 0.0, "{sine:e}");
        }
    }
}

/// A tube that is blown up in a rigid sleeve and pushed along it, or the sleeve along the tube: all of it slides.
#[test]
fn a_tube_in_a_sleeve() {
    let run = |degree: usize, push: f64, pull: f64| {
        let mesh = block::<2>(&[even(0.5, 1.0, 2), even(0.0, 2.0, 5)], 1, |x| x);
        let groups = mesh.groups().clone();
        let mut bodies = Bodies::<2>::new(Space::Axisymmetric);
        bodies.add("tube", mesh, degree, ELASTIC);
        let slave = bodies.surface(0, groups["right"].sides.clone());
        let mut contact = Contact::new("sleeve", slave, Master::Rigid);
        contact.friction = coulomb(0.2);
        let blow = Load { name: "p".into(), body: 0, group: groups["left"].clone(), kind: LoadKind::Pressure };
        let load = loads::forces(&bodies, &blow, &|_| Point::<2>::new(10.0, 0.0));
        let supports = vec![support("push", 0, &groups, "bottom", SupportKind::Components(vec![false, true]))];
        let mut model = Model::new(bodies, supports, vec![contact]).unwrap();
        let now = Circumstances {
            displacement: &|_, _| Point::<2>::new(0.0, push),
            load,
            rigid: vec![Some(Box::new(|x: &Point<2>| GapJet::flat(1.0 - x[0], Point::<2>::new(-1.0, 0.0))))],
            motion: vec![Some(Box::new(move |_: &Point<2>| Point::<2>::new(0.0, pull)))],
        };
        model.solve(&now, &mut |_, _| true).unwrap()
    };
    for degree in [1, 2, 4] {
        let state = run(degree, 0.05, 0.0);
        let contact = &state.contacts[0];
        let pressed: f64 = contact.nodes.iter().map(|n| n.multiplier * n.weight).sum();
        assert!(contact.nodes.iter().all(|n| n.rubbing.status == Status::Slip));
        assert!(pressed > 1.0 && (contact.force[1] / (0.2 * pressed) + 1.0).abs() < 1e-9);
        assert!((state.support_forces[0][1] + contact.force[1]).abs() < 1e-9 * pressed);
        let moved = run(degree, 0.0, -0.05);
        assert!((moved.contacts[0].force[1] / contact.force[1] - 1.0).abs() < 1e-9);
        for (a, b) in moved.contacts[0].nodes.iter().zip(&contact.nodes) {
            assert!((a.rubbing.slip - b.rubbing.slip).norm() < 1e-11 && (a.pressure - b.pressure).abs() < 1e-8);
        }
    }
}

/// A block on a rigid plane, gripped above.
fn gripped(method: Method, enforcement: Enforcement) -> Model<2> {
    let mesh = block::<2>(&[even(-1.0, 1.0, 8), even(0.0, 1.0, 4)], 1, |x| x);
    let groups = mesh.groups().clone();
    let mut bodies = Bodies::<2>::new(Space::PlaneStress);
    bodies.add("block", mesh, 2, ELASTIC);
    let slave = bodies.surface(0, groups["bottom"].sides.clone());
    let mut contact = Contact::new("plane", slave, Master::Rigid);
    contact.friction = coulomb(0.3);
    (contact.method, contact.enforcement) = (method, enforcement);
    let supports = vec![support("grip", 0, &groups, "top", SupportKind::Components(vec![true, true]))];
    Model::new(bodies, supports, vec![contact]).unwrap()
}

/// The grip pressed down and moved sideways, and the plane moved sideways.
fn moved(model: &mut Model<2>, grip: f64, plane: f64) -> State<2> {
    let now = Circumstances {
        displacement: &|_, _| Point::<2>::new(grip, -0.01),
        load: vec![0.0; model.bodies.unknowns()],
        rigid: vec![Some(flat(Point::<2>::y()))],
        motion: vec![Some(Box::new(move |_: &Point<2>| Point::<2>::new(plane, 0.0)))],
    };
    model.solve(&now, &mut |_, _| true).unwrap()
}

/// A block that is pressed on a rigid plane and moved to and fro, or the plane under it: the same, and the same digits
/// after a restart.
#[test]
fn a_plane_that_moves_under_a_block() {
    let penalty = Enforcement::Penalty { wanted_penetration: None };
    for (method, enforcement) in [
        (Method::Mortar, Enforcement::Multiplier),
        (Method::Node, Enforcement::Multiplier),
        (Method::Node, penalty),
        (Method::GaussPoint, penalty),
    ] {
        compare_moving_grip_and_plane(&|| gripped(method, enforcement));
    }
}

fn compare_moving_grip_and_plane(model: &dyn Fn() -> Model<2>) {
    let step = moved;
    let (mut by_grip, mut by_plane, mut later) = (model(), model(), model());
    let mut partial = false;
    for (k, shift) in [0.0, 0.003, 0.006, -0.002, 0.004].into_iter().enumerate() {
        let (one, other) = (step(&mut by_grip, shift, 0.0), step(&mut by_plane, 0.0, -shift));
        let friction = one.contacts[0].friction.as_ref().unwrap();
        partial |= friction.stick_area > 0.0 && friction.slip_area > 0.0;
        for (a, b) in one.contacts[0].nodes.iter().zip(&other.contacts[0].nodes) {
            assert_eq!(a.rubbing.status, b.rubbing.status);
            assert!((a.rubbing.traction - b.rubbing.traction).norm() < 1e-9, "{k}");
            assert!((a.rubbing.slip - b.rubbing.slip).norm() < 1e-12);
        }
        if k >= 3 {
            assert_eq!(step(&mut later, 0.0, -shift).u, other.u);
        }
        if k == 2 {
            let first = Circumstances {
                displacement: &|_, _| Point::<2>::zeros(),
                load: vec![0.0; later.bodies.unknowns()],
                rigid: vec![Some(flat(Point::<2>::y()))],
                motion: vec![],
            };
            later.restore(by_plane.save(), &first).unwrap();
        }
    }
    assert!(partial);
}

/// With a penalty the friction of a path with reversals tends to that of multipliers as the penetration goes to zero; at
/// points it is nearly that of the mortar method.
#[test]
fn a_penalty_tends_to_multipliers() {
    let path = |method: Method, enforcement: Enforcement| -> Vec<f64> {
        let mut model = gripped(method, enforcement);
        [0.0, 0.003, 0.006, -0.002, 0.004].map(|s| moved(&mut model, s, 0.0).contacts[0].force[0]).to_vec()
    };
    let exact = path(Method::Mortar, Enforcement::Multiplier);
    let error = |method: Method, penetration: f64| {
        let found = path(method, Enforcement::Penalty { wanted_penetration: Some(penetration) });
        found.iter().zip(&exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / exact[2].abs()
    };
    let [coarse, fine] = [1e-5, 1e-6].map(|penetration| error(Method::Mortar, penetration));
    assert!(coarse < 0.01 && (7.0..14.0).contains(&(coarse / fine)), "{coarse:e} {fine:e}");
    for method in [Method::Node, Method::GaussPoint] {
        assert!(error(method, 1e-6) < 0.02, "{method:?}: {}", error(method, 1e-6));
    }
}

/// A leaning column gives way sideways under pressure: with much friction more than one equilibrium may exist.
#[test]
fn too_much_friction_is_told() {
    let uniqueness = |mu: f64| {
        let mesh =
            block::<2>(&[even(0.0, 0.3, 2), even(-2.0, 0.0, 8)], 1, |x| Point::<2>::new(x[0] + 0.7 * x[1], x[1]));
        let groups = mesh.groups().clone();
        let mut bodies = Bodies::<2>::new(Space::PlaneStrain);
        bodies.add("column", mesh, 2, ELASTIC);
        let slave = bodies.surface(0, groups["top"].sides.clone());
        let mut contact = Contact::new("lid", slave, Master::Rigid);
        contact.friction = coulomb(mu);
        let supports = vec![support("foot", 0, &groups, "bottom", SupportKind::Components(vec![true, true]))];
        let mut model = Model::new(bodies, supports, vec![contact]).unwrap();
        let now = Circumstances {
            displacement: &|_, _| Point::<2>::zeros(),
            load: vec![0.0; model.bodies.unknowns()],
            rigid: vec![Some(Box::new(|x: &Point<2>| GapJet::flat(-0.001 - x[1], -Point::<2>::y())))],
            motion: vec![],
        };
        let state = model.solve(&now, &mut |_, _| true).unwrap();
        state.contacts[0].friction.as_ref().unwrap().uniqueness
    };
    let (little, much) = (uniqueness(0.1), uniqueness(2.0));
    assert!(little > 1.0 && much < 1.0 && (20.0 * much / little - 1.0).abs() < 1e-9, "{little} {much}");
}

#[test]
fn what_friction_cannot_do_is_refused() {
    let contact = || {
        let mesh = block::<3>(&[even(0.0, 1.0, 1), even(0.0, 1.0, 1), even(0.0, 1.0, 1)], 1, |x| x);
        let groups = mesh.groups().clone();
        let mut bodies = Bodies::<3>::new(Space::Solid);
        bodies.add("block", mesh, 1, ELASTIC);
        let slave = bodies.surface(0, groups["bottom"].sides.clone());
        let mut contact = Contact::new("plane", slave, Master::Rigid);
        contact.friction = coulomb(0.3);
        let supports = vec![support("grip", 0, &groups, "top", SupportKind::Components(vec![true; 3]))];
        (bodies, supports, contact)
    };
    let refused = |change: &dyn Fn(&mut Contact<3>)| {
        let (bodies, supports, mut contact) = contact();
        change(&mut contact);
        matches!(Model::new(bodies, supports, vec![contact]), Err(StepError::FrictionUnsupported { .. }))
    };
    assert!(refused(&|c| c.enforcement = Enforcement::Nitsche));
    assert!(refused(&|c| c.enforcement = Enforcement::AugmentedLagrangian));
    assert!(refused(&|c| c.method = Method::GaussPoint));
    assert!(!refused(&|c| c.method = Method::Node));
    assert!(!refused(&|_| ()));
    let (bodies, supports, mut contact) = contact();
    let law = Box::new(Coulomb::orthotropic([0.1, 0.2]).unwrap());
    contact.friction = Some(Friction { law, axis: Some(Point::<3>::z()) });
    let mut model = Model::new(bodies, supports, vec![contact]).unwrap();
    let now = Circumstances {
        displacement: &|_, _| -Point::<3>::z() * 0.01,
        load: vec![0.0; model.bodies.unknowns()],
        rigid: vec![Some(flat(Point::<3>::z()))],
        motion: vec![],
    };
    assert!(matches!(model.solve(&now, &mut |_, _| true), Err(StepError::FrictionAxis { .. })));
}
