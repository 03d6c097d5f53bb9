//! Contact of cells with rigid bodies: balance of forces, tangents, Hertz.

use super::*;
use signorini_cells::shapes::ball;
use signorini_contact::Coulomb;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::{Plane, RigidShape, Sphere};

pub(super) fn rigid(name: &str, shape: impl RigidShape + 'static, motion: Motion) -> RigidBody {
    let centre = shape.centre();
    RigidBody {
        name: name.to_string(),
        shape: Arc::new(shape),
        motion,
        centre,
        sites: Vec::new(),
        size: 1.0,
        mass: None,
    }
}

pub(super) fn moved(along: Vector<3>) -> Motion {
    let zero = Vector::<3>::zeros();
    Motion::Prescribed(Arc::new(move |t| RigidMotion::new(zero, zero, along * t)))
}

/// A quarter of a disc on a floor, pressed from its middle: force and half width of Hertz's problem at this depth by an
/// independent computation.
#[test]
fn a_disc_pressed_on_a_floor() {
    let reference: serde_json::Value = serde_json::from_str(include_str!("../../data/finite_cells.json")).unwrap();
    let wanted = reference["hertz_2d"]["0.03"]["P"]["value"].as_f64().unwrap();
    let disc = Domain::shape(ball(Point::<2>::y(), 1.0));
    let places =
        vec![("axis", Place::low(0)), ("middle", Place::high(1)), ("skin", Place::boundary(|p| p.normal[1] < -0.5))];
    let b = aabb([0.0, 0.0], [1.0, 1.0]);
    let penalty = Enforcement::Penalty { wanted_penetration: None };
    for (friction, enforcement, sampling) in [
        (false, penalty, Sampling::GaussPoints),
        (true, penalty, Sampling::GaussPoints),
        (false, Enforcement::AugmentedLagrangian, Sampling::Nodes),
        (true, Enforcement::Multiplier, Sampling::Nodes),
        (false, Enforcement::Nitsche, Sampling::GaussPoints),
        (true, Enforcement::Nitsche, Sampling::GaussPoints),
    ] {
        let body = solid("disc", disc.clone(), (b, [8, 8]), 4, Space::PlaneStrain, places.clone());
        let floor =
            rigid("floor", Plane { point: Point::<3>::zeros(), normal: Vector::<3>::y() }, moved(v(0.0, 0.0, 0.0)));
        let mut contact =
            Contact::new("touch", (part(0, "skin"), &body), (part(1, ""), &floor), sampling, enforcement).unwrap();
        if friction {
            contact.law.friction = Some(Box::new(Coulomb::isotropic(0.3).unwrap()));
        }
        let mut system = System {
            supports: vec![
                support(0, "axis", [constant(0.0), None, None]),
                support(0, "middle", [None, constant(-0.03), None]),
            ],
            bodies: vec![Box::new(body), Box::new(floor)],
            contacts: vec![Box::new(contact)],
            ..System::default()
        };
        let (state, found) = solve(&mut system);
        let force: Vector<3> = found.sites[0].iter().map(SiteResult::force).sum();
        println!("{enforcement:?} {friction}: {} ({wanted}), {} iterations", 2.0 * force[1], found.iterations);
        assert!((2.0 * force[1] / wanted - 1.0).abs() < 1e-2);
        assert!((force[1] + found.support_forces[1][0][1]).abs() < 1e-10, "{force} {:?}", found.support_forces);
        assert!((force[0] + found.support_forces[0][0][0]).abs() < 1e-10, "{force} {:?}", found.support_forces);
        assert_eq!(force[0] != 0.0, friction);
        let error = tangent_error(&system, &state, 1e-8, 20);
        let width = found.sites[0].iter().filter(|s| s.pressure > 0.0).map(|s| s.x[0]).fold(0.0, f64::max);
        println!(
            "tangent {error:e}, half width {width}, peak {}, {:?}",
            found.sites[0].iter().map(|s| s.pressure).fold(0.0, f64::max),
            found.history
        );
        assert!(error < 1e-6, "{error:e}");
    }
}

/// A load on a ball that only a rigid stone holds, in space.
#[test]
fn a_ball_in_space_that_only_contact_holds() {
    let b = aabb([0.0, 0.0, 0.0], [1.0, 1.0, 1.0]);
    let domain = Domain::shape(ball(Point::<3>::z(), 1.0));
    let places = vec![
        ("x", Place::low(0)),
        ("y", Place::low(1)),
        ("top", Place::high(2)),
        ("skin", Place::boundary(|p| p.normal[2] < -0.6)),
    ];
    let body = solid("ball", domain, (b, [3; 3]), 2, Space::Solid, places);
    let stone = rigid("stone", Sphere { center: v(0.0, 0.0, -1.99), radius: 2.0 }, moved(v(0.0, 0.0, 0.0)));
    let contact = Contact::new(
        "touch",
        (part(0, "skin"), &body),
        (part(1, ""), &stone),
        Sampling::GaussPoints,
        Enforcement::Penalty { wanted_penetration: None },
    )
    .unwrap();
    let given = v(0.0, 0.0, -0.02);
    let mut system = System {
        supports: vec![support(0, "x", [constant(0.0), None, None]), support(0, "y", [None, constant(0.0), None])],
        loads: vec![PlacedLoad {
            name: "push".into(),
            part: part(0, "top"),
            load: TimedLoad::Force(Arc::new(move |_, t| given * t)),
        }],
        bodies: vec![Box::new(body), Box::new(stone)],
        contacts: vec![Box::new(contact)],
        ..System::default()
    };
    let (state, found) = solve(&mut system);
    let force: Vector<3> = found.sites[0].iter().map(SiteResult::force).sum();
    println!("{force}, {} iterations, {:?}", found.iterations, found.history);
    assert!((force[2] + given[2]).abs() < 1e-9, "{force}");
    let error = tangent_error(&system, &state, 1e-6, 10);
    assert!(error < 1e-6, "{error:e}");
}

/// An eighth of a ball on a plane, by the force of an independent computation.
#[test]
#[ignore = "half a minute: six thousand unknowns in space, factorised in every iteration"]
fn a_ball_pressed_on_a_plane_in_space() {
    let reference: serde_json::Value = serde_json::from_str(include_str!("../../data/finite_cells.json")).unwrap();
    let wanted = reference["hertz_3d_sphere"]["nu_0_3"]["0.06"]["P"]["value"].as_f64().unwrap();
    let b = aabb([0.0, 0.0, 0.0], [1.0, 1.0, 1.0]);
    for (sampling, enforcement) in [
        (Sampling::GaussPoints, Enforcement::Penalty { wanted_penetration: None }),
        (Sampling::Nodes, Enforcement::Multiplier),
    ] {
        let places = vec![
            ("x", Place::low(0)),
            ("y", Place::low(1)),
            ("top", Place::high(2)),
            ("skin", Place::boundary(|p| p.normal[2] < -0.8)),
        ];
        let body = solid("ball", Domain::shape(ball(Point::<3>::z(), 1.0)), (b, [6; 3]), 2, Space::Solid, places);
        let floor =
            rigid("floor", Plane { point: Point::<3>::zeros(), normal: Vector::<3>::z() }, moved(v(0.0, 0.0, 0.0)));
        let contact =
            Contact::new("touch", (part(0, "skin"), &body), (part(1, ""), &floor), sampling, enforcement).unwrap();
        let mut system = System {
            supports: vec![
                support(0, "x", [constant(0.0), None, None]),
                support(0, "y", [None, constant(0.0), None]),
                support(0, "top", [None, None, constant(-0.06)]),
            ],
            bodies: vec![Box::new(body), Box::new(floor)],
            contacts: vec![Box::new(contact)],
            ..System::default()
        };
        let begin = std::time::Instant::now();
        let (_, found) = solve(&mut system);
        let force = 4.0 * found.sites[0].iter().map(SiteResult::force).sum::<Vector<3>>()[2];
        let (sites, time) = (found.sites[0].len(), begin.elapsed());
        println!(
            "{enforcement:?}: {force} ({wanted}), {} iterations, {sites} sites, {} unknowns, {time:?}",
            found.iterations, found.unknowns
        );
        assert!((force / wanted - 1.0).abs() < 2e-2, "{force} {wanted}");
    }
}
