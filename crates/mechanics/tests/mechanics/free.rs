//! Free rigid bodies that contact, friction and springs hold, against statics.

use crate::common::{ball, plane, rigid, v};
use signorini_contact::{Coulomb, Status, Viscous};
use signorini_geometry::Vector;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::Sphere;
use signorini_mechanics::contact::Contact;
use signorini_mechanics::enforcement::Enforcement;
use signorini_mechanics::increment_error::IncrementError;
use signorini_mechanics::part::Part;
use signorini_mechanics::points::Sampling;
use signorini_mechanics::rigid_body::{Motion, RigidSite};
use signorini_mechanics::system::{PlacedLoad, Support, System, TimedLoad};
use std::sync::Arc;

fn part(body: usize) -> Part {
    Part { body, group: None }
}

fn touching(system: &System, slave: usize, master: usize, enforcement: Enforcement, mu: Option<f64>) -> Contact {
    let of = |k: usize| (part(k), system.bodies[k].as_ref());
    let mut contact = Contact::new("touch", of(slave), of(master), Sampling::Nodes, enforcement).unwrap();
    contact.law.friction = mu.map(|mu| Box::new(Coulomb::isotropic(mu).unwrap()) as _);
    contact.reach = 3.0;
    contact
}

fn force(body: usize, force: Vector<3>) -> PlacedLoad {
    PlacedLoad { name: "weight".into(), part: part(body), load: TimedLoad::Force(Arc::new(move |_, t| force * t)) }
}

const KINDS: [Enforcement; 2] = [Enforcement::AugmentedLagrangian, Enforcement::Multiplier];

#[test]
fn a_ball_settles_in_a_groove_from_above_it() {
    // Two planes at 60 degrees to each other's normals: each carries the weight over 2 cos 45.
    for enforcement in KINDS {
        let radius = 0.5;
        let walls = [v(-1.0, 0.0, 1.0).normalize(), v(1.0, 0.0, 1.0).normalize()];
        let mut system = System::default();
        system.bodies.push(Box::new(ball(v(0.1, 0.0, 1.1), radius, Motion::Free { plane: false })));
        walls.iter().for_each(|n| system.bodies.push(Box::new(plane(v(0.0, 0.0, 0.0), *n))));
        system.loads.push(force(0, v(0.0, 0.0, -2.0)));
        system.supports.push(Support {
            name: "along".into(),
            part: part(0),
            displacement: [None, Some(Arc::new(|_, _| 0.0)), None],
            rotation: [None, None, None],
            ..Support::default()
        });
        for wall in 1..3 {
            let contact = touching(&system, 0, wall, enforcement, None);
            system.contacts.push(Box::new(contact));
        }
        system.prepare().unwrap();
        let (state, result) = system.solve(&system.start(), 1.0, &mut |_, _| true).unwrap();
        let centre = &state.bodies[0].configuration;
        assert!((centre[2] - radius * 2f64.sqrt()).abs() < 1e-9, "{centre:?}");
        assert!(centre[0].abs() < 1e-9 && result.imbalance < 1e-9);
        for (sites, wall) in result.sites.iter().zip(walls) {
            assert!((sites[0].force() - wall * 2f64.sqrt()).norm() < 1e-8, "{:?}", sites[0]);
        }
    }
}

#[test]
fn a_ball_on_an_incline_rolls_unless_something_holds_it_and_sticks_up_to_its_friction() {
    let angle = 0.3f64;
    let normal = v(-angle.sin(), 0.0, angle.cos());
    let on = |mu: f64, turns: bool| {
        let mut system = System::default();
        system.bodies.push(Box::new(ball(normal * 0.5, 0.5, Motion::Free { plane: false })));
        system.bodies.push(Box::new(plane(v(0.0, 0.0, 0.0), normal)));
        system.loads.push(force(0, v(0.0, 0.0, -1.0)));
        if !turns {
            let held: signorini_mechanics::system::TimeField = Arc::new(|_, _| 0.0);
            system.supports.push(Support {
                name: "spin".into(),
                part: part(0),
                displacement: [None, None, None],
                rotation: [Some(held.clone()), Some(held.clone()), Some(held)],
                ..Support::default()
            });
        }
        let contact = touching(&system, 0, 1, Enforcement::Multiplier, Some(mu));
        system.contacts.push(Box::new(contact));
        system.prepare().unwrap();
        system.solve(&system.start(), 1.0, &mut |_, _| true)
    };
    let (_, stuck) = on(1.01 * angle.tan(), false).unwrap();
    let site = stuck.sites[0][0];
    assert_eq!(site.status, Status::Stick);
    assert!((site.force() - v(0.0, 0.0, 1.0)).norm() < 1e-8, "{site:?}");
    // What keeps the ball from turning carries the moment of friction about its centre.
    assert!((stuck.support_forces[0][1].norm() - 0.5 * angle.sin()).abs() < 1e-8, "{:?}", stuck.support_forces);
    assert!(matches!(on(0.99 * angle.tan(), false), Err(IncrementError::Free { body, .. }) if body == "ball"));
    let rolls = on(10.0, true).map(|(state, result)| (state, result.history));
    assert!(matches!(&rolls, Err(IncrementError::Free { body, .. }) if body == "ball"), "{rolls:?}");
}

#[test]
fn a_block_on_three_feet_stands_slides_and_follows_a_turning_floor() {
    // Three corners on a plane with friction; a horizontal force below and above what friction bears.
    let corners = [v(0.0, 0.0, 0.0), v(1.0, 0.0, 0.0), v(0.2, 1.0, 0.0)];
    let on = |push: f64| {
        let shape = signorini_geometry::rigid_shape::Sphere { center: v(0.4, 0.33, 0.2), radius: 0.2 };
        let sites = corners.map(|x| RigidSite { x, outward: Some(v(0.0, 0.0, -1.0)), radius: 0.0, weight: 1.0 });
        let mut system = System::default();
        system.bodies.push(Box::new(rigid("block", shape, Motion::Free { plane: false }, sites.to_vec())));
        system.bodies.push(Box::new(plane(v(0.0, 0.0, 0.0), v(0.0, 0.0, 1.0))));
        system.loads.push(force(0, v(push, 0.0, -1.0)));
        let contact = touching(&system, 0, 1, Enforcement::Multiplier, Some(0.5));
        system.contacts.push(Box::new(contact));
        system.prepare().unwrap();
        let start = system.start();
        system.solve(&start, 1.0, &mut |_, _| true).map(|(_, result)| result)
    };
    let result = on(0.45).unwrap();
    let total: Vector<3> = result.sites[0].iter().map(|s| s.force()).sum();
    assert!((total - v(-0.45, 0.0, 1.0)).norm() < 1e-8, "{total}");
    let moment: Vector<3> = result.sites[0].iter().map(|s| (s.x - v(0.4, 0.33, 0.2)).cross(&s.force())).sum();
    assert!(moment.norm() < 1e-8, "{moment}");
    assert!(on(0.55).is_err());
}

#[test]
fn a_moved_body_drags_one_that_springs_hold() {
    // A ball between two plates with friction: the upper plate moves by 0.1, and the ball, free to turn, by half of it.
    let mut system = System::default();
    system.bodies.push(Box::new(ball(v(0.0, 0.0, 0.5), 0.5, Motion::Free { plane: false })));
    system.bodies.push(Box::new(plane(v(0.0, 0.0, 0.0), v(0.0, 0.0, 1.0))));
    let zero = Vector::<3>::zeros();
    let lid = Motion::Prescribed(Arc::new(move |t| {
        signorini_geometry::rigid::RigidMotion::new(zero, zero, v(0.1 * (t - 1.0).max(0.0), 0.0, 0.0))
    }));
    let shape = signorini_geometry::rigid_shape::Plane { point: v(0.0, 0.0, 1.0), normal: v(0.0, 0.0, -1.0) };
    system.bodies.push(Box::new(rigid("lid", shape, lid, Vec::new())));
    // The lid does not give way; a load on the ball closes the lower contact, one on both is not determined.
    system.loads.push(force(0, v(0.0, 0.0, -0.1)));
    for (master, mu) in [(1, 0.4), (2, 0.4)] {
        let penalty = Enforcement::Penalty { wanted_penetration: None };
        let mut contact = touching(&system, 0, master, penalty, Some(mu));
        contact.reach = 1.0;
        system.contacts.push(Box::new(contact));
    }
    system.prepare().unwrap();
    // Squeezed: the lower plate is lifted by a little.
    let lift: signorini_mechanics::rigid_body::PrescribedMotion =
        Arc::new(move |t| signorini_geometry::rigid::RigidMotion::new(zero, zero, v(0.0, 0.0, 0.02 * t.min(1.0))));
    let floor = signorini_geometry::rigid_shape::Plane { point: v(0.0, 0.0, 0.0), normal: v(0.0, 0.0, 1.0) };
    system.bodies[1] = Box::new(rigid("floor", floor, Motion::Prescribed(lift), Vec::new()));
    let (state, _) = system.solve(&system.start(), 1.0, &mut |_, _| true).unwrap();
    system.accept(&state).unwrap();
    let (state, result) = system.solve(&state, 2.0, &mut |_, _| true).unwrap();
    let before = system.bodies[0].start().configuration;
    let moved = state.bodies[0].configuration[0] - before[0];
    // Both contacts stick: they give way by friction over penalty.
    assert!(result.sites.iter().all(|s| s[0].status == Status::Stick), "{:?}", result.sites);
    assert!((moved - 0.05).abs() < 2e-3, "{moved}");
}

/// What turns rubs along the arc: a disc that a hand moves over a floor rolls by the way over its radius, a disc on a wheel that
/// is turned by the way of the wheel, a block on a turntable is dragged along the circle; all in one increment.
#[test]
fn slip_is_measured_along_the_arc_by_whatever_angle_a_body_turns() {
    let held = |by: f64| -> Option<signorini_mechanics::system::TimeField> {
        Some(Arc::new(move |_, t| by * (t - 1.0).max(0.0)))
    };
    // How far the disc turns, and friction takes, as the hand moves it and the wheel turns.
    let turned = |way: f64, wheel: f64, spins: bool| {
        let zero = Vector::<3>::zeros();
        let motion: signorini_mechanics::rigid_body::PrescribedMotion =
            Arc::new(move |t| RigidMotion::new(v(0.0, 0.0, wheel * (t - 1.0).max(0.0)), zero, zero));
        let mut system = System::default();
        system.bodies.push(Box::new(ball(v(0.0, 0.5, 0.0), 0.5, Motion::Free { plane: true })));
        let master: Box<dyn signorini_mechanics::body::Body> = match wheel == 0.0 {
            true => Box::new(plane(zero, v(0.0, 1.0, 0.0))),
            false => Box::new(rigid(
                "wheel",
                Sphere { center: v(0.0, -2.0, 0.0), radius: 2.0 },
                Motion::Prescribed(Arc::new(move |t| RigidMotion::new(motion(t).turn, v(0.0, -2.0, 0.0), zero))),
                Vec::new(),
            )),
        };
        system.bodies.push(master);
        system.loads.push(PlacedLoad {
            name: "weight".into(),
            part: part(0),
            load: TimedLoad::Force(Arc::new(|_, _| v(0.0, -1.0, 0.0))),
        });
        let rotation = if spins { [None, None, None] } else { [None, None, held(0.0)] };
        let support = Support {
            name: "hand".into(),
            part: part(0),
            displacement: [held(way), None, None],
            rotation,
            ..Support::default()
        };
        system.supports.push(support);
        let contact = touching(&system, 0, 1, Enforcement::Multiplier, Some(0.5));
        system.contacts.push(Box::new(contact));
        system.prepare().unwrap();
        let (state, _) = system.solve(&system.start(), 1.0, &mut |_, _| true).unwrap();
        system.accept(&state).unwrap();
        let (state, result) = system.solve(&state, 2.0, &mut |_, _| true).unwrap();
        (
            signorini_mechanics::rigid_body::Pose::of(&state.bodies[0]).turn.z,
            result.dissipated[0],
            result.sites[0][0].force(),
        )
    };
    for way in [0.1, 0.45, 2.5, -7.0] {
        let (angle, taken, _) = turned(way, 0.0, true);
        assert!((angle + way / 0.5).abs() < 1e-8 && taken.abs() < 1e-9, "{way}: {angle}, {taken}");
    }
    for wheel in [0.5, 4.0, -15.0] {
        let (angle, taken, _) = turned(0.0, wheel, true);
        assert!((angle + 4.0 * wheel).abs() < 1e-7 && taken.abs() < 1e-9, "{wheel}: {angle}, {taken}");
        let (_, taken, force) = turned(0.0, wheel, false);
        assert!((taken - 0.5 * 2.0 * wheel.abs()).abs() < 1e-9, "{wheel}: {taken}");
        assert!((force - v(-0.5 * wheel.signum(), 1.0, 0.0)).norm() < 1e-9, "{force}");
    }
}

/// With friction by velocity a ball that may not turn creeps down an incline, at the velocity of which the friction is its
/// weight along it, however time is divided.
#[test]
fn viscous_friction_creeps_down_an_incline() {
    let (angle, mu, v0) = (0.2f64, 0.3, 1e-3);
    let share = angle.tan() / mu;
    let velocity = v0 * share / (1.0 - share * share).sqrt();
    let normal = v(-angle.sin(), 0.0, angle.cos());
    for enforcement in [Enforcement::AugmentedLagrangian, Enforcement::Penalty { wanted_penetration: None }] {
        let mut system = System::default();
        system.bodies.push(Box::new(ball(normal * 0.5, 0.5, Motion::Free { plane: false })));
        system.bodies.push(Box::new(plane(v(0.0, 0.0, 0.0), normal)));
        system.loads.push(PlacedLoad {
            name: "weight".into(),
            part: part(0),
            load: TimedLoad::Force(Arc::new(|_, _| v(0.0, 0.0, -1.0))),
        });
        let held: signorini_mechanics::system::TimeField = Arc::new(|_, _| 0.0);
        system.supports.push(Support {
            name: "spin".into(),
            part: part(0),
            displacement: [None, None, None],
            rotation: [Some(held.clone()), Some(held.clone()), Some(held)],
            ..Support::default()
        });
        let mut contact = touching(&system, 0, 1, enforcement, None);
        contact.law.friction = Some(Box::new(Viscous::new(mu, v0).unwrap()));
        system.contacts.push(Box::new(contact));
        system.prepare().unwrap();
        let mut state = system.start();
        let down = v(-angle.cos(), 0.0, -angle.sin());
        let mut places = Vec::new();
        for time in [1.0, 2.0, 5.0] {
            state = system.solve(&state, time, &mut |_, _| true).unwrap().0;
            system.accept(&state).unwrap();
            let c = &state.bodies[0].configuration;
            places.push(v(c[0], c[1], c[2]).dot(&down));
        }
        // A penalty gives way once, at first.
        for (k, time) in [(1, 1.0), (2, 4.0)] {
            let crept = places[k] - places[0];
            assert!((crept - velocity * time).abs() < 1e-6 * velocity, "{enforcement:?}: {crept} {}", velocity * time);
        }
    }
}

/// However small its residual, a state as far away as this is no answer.
#[test]
fn what_is_carried_away_is_told() {
    let to = |distance: f64| {
        let mut system = System::default();
        system.bodies.push(Box::new(ball(v(0.0, 0.0, 0.0), 0.5, Motion::Free { plane: false })));
        let held: signorini_mechanics::system::TimeField = Arc::new(|_, _| 0.0);
        let moved: signorini_mechanics::system::TimeField = Arc::new(move |_, _| distance);
        system.supports.push(Support {
            name: "hand".into(),
            part: part(0),
            displacement: [Some(moved), Some(held.clone()), Some(held.clone())],
            rotation: [Some(held.clone()), Some(held.clone()), Some(held)],
            ..Support::default()
        });
        system.prepare().unwrap();
        system.solve(&system.start(), 1.0, &mut |_, _| true).map(|_| ())
    };
    to(1e3).expect("an answer");
    let error = to(1e9).expect_err("no answer");
    assert!(error.to_string().contains("`ball` was carried away"), "{error}");
}
