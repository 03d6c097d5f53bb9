//! Rigid bodies that move with inertia, against what mechanics conserves and closed forms.

use crate::common::{at_rest, ball, plane, rigid, v};
use signorini_contact::Coulomb;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::{Plane, Sphere};
use signorini_geometry::{Matrix, Vector};
use signorini_mechanics::contact::Contact;
use signorini_mechanics::enforcement::Enforcement;
use signorini_mechanics::part::Part;
use signorini_mechanics::points::Sampling;
use signorini_mechanics::rigid_body::{Motion, RigidBody, RigidMass, RigidSite};
use signorini_mechanics::system::{PlacedLoad, Support, System, SystemState, TimedLoad};
use signorini_mechanics::{Dynamics, IncrementResult};
use std::sync::Arc;

pub const FREE: Motion = Motion::Free { plane: false };

fn mass(mass: f64, inertia: [f64; 3], velocity: Vector<3>, angular_velocity: Vector<3>) -> Option<RigidMass> {
    let inertia = Matrix::<3>::from_diagonal(&Vector::<3>::from(inertia));
    Some(RigidMass { mass, inertia, velocity, angular_velocity })
}

pub fn system(bodies: Vec<RigidBody>) -> System {
    let dynamics = Some(Dynamics { spectral_radius: 1.0, damping: [0.0; 2], tells_error: false });
    let bodies = bodies.into_iter().map(|b| Box::new(b) as _).collect();
    System { bodies, dynamics, ..System::default() }
}

pub fn touch(system: &mut System, [slave, master]: [usize; 2], mu: f64, restitution: f64) {
    let of = |k: usize| (Part::from(k), system.bodies[k].as_ref());
    let kept = Enforcement::AugmentedLagrangian;
    let mut contact = Contact::new("touch", of(slave), of(master), Sampling::Nodes, kept).unwrap();
    contact.law.friction = (mu > 0.0).then(|| Box::new(Coulomb::isotropic(mu).unwrap()) as _);
    contact.restitution = restitution;
    system.contacts.push(Box::new(contact));
}

fn force(system: &mut System, body: usize, force: Vector<3>) {
    let load = TimedLoad::Force(Arc::new(move |_, _| force));
    system.loads.push(PlacedLoad { name: "force".into(), part: Part::from(body), load });
}

/// The states at the ends of equal steps.
pub fn run(
    system: &mut System,
    to: f64,
    steps: usize,
    mut each: impl FnMut(&SystemState, &IncrementResult),
) -> SystemState {
    system.weigh(true).unwrap();
    system.prepare().unwrap();
    let mut state = system.start();
    for k in 1..=steps {
        let (next, result) = system.solve(&state, to * k as f64 / steps as f64, &mut |_, _| true).unwrap();
        system.accept(&next).unwrap();
        each(&next, &result);
        state = next;
    }
    state
}

pub fn centre(state: &SystemState, body: usize) -> Vector<3> {
    Vector::<3>::from_column_slice(&state.bodies[body].configuration[..3])
}

/// A top with three different moments of inertia, that turns about the unstable axis: energy and momenta stay to rounding in ten
/// thousand steps, and the error falls with the square of the step.
#[test]
fn a_free_top_keeps_energy_and_momenta() {
    let top = || {
        let mut body = ball(v(0.0, 0.0, 0.0), 1.0, FREE);
        body.mass = mass(1.0, [1.0, 2.0, 2.5], v(1.0, 0.5, 0.0), v(0.1, 2.0, 0.1));
        system(vec![body])
    };
    let energy = 0.5 * (0.01 + 2.0 * 4.0 + 2.5 * 0.01) + 0.5 * 1.25;
    let spin = v(0.1, 4.0, 0.25);
    run(&mut top(), 100.0, 10_000, |_, result| {
        let own = result.moved.as_ref().unwrap().after[0];
        assert!((own.kinetic_energy / energy - 1.0).abs() < 1e-12);
        // About the origin, past which the centre moves straight.
        assert!((own.angular_momentum - spin).norm() < 1e-12 * 1e2, "{}", own.angular_momentum);
    });
    let end = |steps: usize| {
        Vector::<4>::from_column_slice(&run(&mut top(), 2.0, steps, |_, _| {}).bodies[0].configuration[3..])
    };
    let fine = end(3200);
    let [coarse, middle] = [100, 200].map(|steps| (end(steps) - fine).norm());
    assert!((coarse / middle - 4.0).abs() < 0.1, "{coarse:e}, {middle:e}");
}

/// A ball slides without friction in a bowl: it stays on it, and its way has the order two.
#[test]
fn a_ball_in_a_bowl_stays_on_it() {
    let end = |steps: usize| {
        let hole = Hole(Sphere { center: v(0.0, 0.0, 0.0), radius: 1.0 });
        let mut own = ball(v(0.72, 0.0, -0.54), 0.1, FREE);
        own.mass = mass(1.0, [4e-3; 3], v(0.0, 1.0, 0.0), v(0.0, 0.0, 0.0));
        let mut system = system(vec![own, rigid("bowl", hole, at_rest(), Vec::new())]);
        touch(&mut system, [0, 1], 0.0, 0.0);
        force(&mut system, 0, v(0.0, 0.0, -10.0));
        let state = run(&mut system, 1.0, steps, |state, _| {
            assert!((centre(state, 0).norm() - 0.9).abs() < 1e-12, "{}", centre(state, 0).norm() - 0.9);
        });
        let speed = Vector::<3>::from_column_slice(&state.velocities[..3]);
        (centre(&state, 0), 0.5 * speed.norm_squared() + 10.0 * (centre(&state, 0)[2] + 0.54))
    };
    let [a, b, c] = [40, 80, 160].map(end);
    let ratio = (a.0 - b.0).norm() / (b.0 - c.0).norm();
    assert!((ratio - 4.0).abs() < 0.15, "{ratio}");
    assert!((c.1 - 0.5).abs() < 2e-5, "{}", c.1 - 0.5);
}

/// A block that is gripped follows the jaws on their way up, though 20 times less would hold it as little as more.
#[test]
fn a_gripped_block_follows_the_jaws() {
    let (weight, mu) = (10.0, 0.5);
    for (grip, lift) in [(20.0, 0.0), (20.0, 1.0), (2.5, 1.0)] {
        let up = move |t: f64| v(0.0, 0.0, 0.5 * lift * t * t);
        let jaw = move |normal: Vector<3>, motion: Motion| {
            rigid("jaw", Plane { point: normal * -0.1, normal }, motion, Vec::new())
        };
        let zero = v(0.0, 0.0, 0.0);
        let fixed = Motion::Prescribed(Arc::new(move |t| RigidMotion::new(zero, zero, up(t))));
        let mut moving = jaw(v(-1.0, 0.0, 0.0), FREE);
        moving.mass = mass(0.3, [1.0; 3], zero, zero);
        let mut block = ball(zero, 0.1, FREE);
        let corner = |k: usize| [0, 1, 2].map(|i| if k >> i & 1 == 1 { 0.1 } else { -0.1 });
        block.sites = (0..8)
            .map(|k| RigidSite { x: Vector::<3>::from(corner(k)), outward: None, radius: 0.0, weight: 1.0 })
            .collect();
        block.mass = mass(1.0, [0.04 / 6.0; 3], zero, zero);
        let mut system = system(vec![block, moving, jaw(v(1.0, 0.0, 0.0), fixed)]);
        touch(&mut system, [0, 1], mu, 0.0);
        touch(&mut system, [0, 2], mu, 0.0);
        force(&mut system, 0, v(0.0, 0.0, -weight));
        force(&mut system, 1, v(-grip * weight / (2.0 * mu), 0.0, 0.0));
        let still: signorini_mechanics::system::TimeField = Arc::new(|_, _| 0.0);
        let lifted: signorini_mechanics::system::TimeField = Arc::new(move |_, t| up(t)[2]);
        system.supports.push(Support {
            name: "guide".into(),
            part: Part::from(1),
            displacement: [None, Some(Arc::clone(&still)), Some(lifted)],
            rotation: [0, 1, 2].map(|_| Some(Arc::clone(&still))),
            ..Support::default()
        });
        let state = run(&mut system, 1.0, 50, |_, _| {});
        assert!((centre(&state, 0) - up(1.0)).norm() < 1e-12, "{grip}, {lift}: {}", centre(&state, 0) - up(1.0));
        let speed = Vector::<3>::from_column_slice(&state.velocities[..3]);
        assert!((speed - v(0.0, 0.0, lift)).norm() < 1e-12, "{grip}, {lift}: {speed}");
    }
}

/// A ball that falls into a groove strikes both walls at once and rebounds straight, with its energy; and a chain with two balls
/// that strike three sends two away.
#[test]
fn impacts_keep_symmetry_and_energy() {
    let s = 0.5f64.sqrt();
    let mut own = ball(v(0.0, 0.0, 1.0), 0.1, FREE);
    own.mass = mass(2.0, [0.01; 3], v(0.0, 0.0, -1.0), v(0.0, 0.0, 0.0));
    let walls = [s, -s].map(|n| plane(v(0.0, 0.0, 0.0), v(n, 0.0, s)));
    let mut groove = system(std::iter::once(own).chain(walls).collect());
    touch(&mut groove, [0, 1], 0.0, 1.0);
    touch(&mut groove, [0, 2], 0.0, 1.0);
    let state = run(&mut groove, 2.0, 3, |_, _| {});
    let expected = [0.0, 0.0, 1.0];
    assert!((0..3).all(|k| (state.velocities[k] - expected[k]).abs() < 1e-12), "{:?}", state.velocities);

    let row = [-1.2, -1.0, 0.0, 0.2, 0.4].map(|x| {
        let mut own = ball(v(x, 0.0, 0.0), 0.1, FREE);
        own.mass = mass(1.0, [0.004; 3], v(if x < -0.5 { 1.0 } else { 0.0 }, 0.0, 0.0), v(0.0, 0.0, 0.0));
        own
    });
    let mut cradle = system(row.into());
    (0..4).for_each(|k| touch(&mut cradle, [k, k + 1], 0.0, 1.0));
    let state = run(&mut cradle, 2.0, 4, |_, _| {});
    for (k, expected) in [0.0, 0.0, 0.0, 1.0, 1.0].into_iter().enumerate() {
        assert!((state.velocities[6 * k] - expected).abs() < 1e-12, "{k}: {}", state.velocities[6 * k]);
    }
}

/// A sphere that is touched from inside.
struct Hole(Sphere);

impl signorini_geometry::rigid_shape::RigidShape for Hole {
    fn gap(&self, x: &Vector<3>) -> signorini_geometry::rigid_shape::GapJet<3> {
        let found = self.0.gap(x);
        signorini_geometry::rigid_shape::GapJet { gap: -found.gap, normal: -found.normal, hessian: -found.hessian }
    }
    fn centre(&self) -> Vector<3> {
        self.0.center
    }
}
