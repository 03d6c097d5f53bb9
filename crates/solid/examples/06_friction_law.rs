//! A law of friction of one's own: Coulomb's up to a shear strength, as of metals that yield before they slip. A block is
//! pressed on a plane and pushed along it.
//!
//! `cargo run --release -p signorini-solid --example 06_friction_law`

use signorini_contact::law::Friction;
use signorini_contact::{Coulomb, Law, Tresca};
use signorini_fem::block::block;
use signorini_geometry::Vector;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::Plane;
use signorini_mechanics::system::TimeField;
use signorini_mechanics::{Body, Enforcement, Mortar, Motion, Part, RigidBody, Support, System};
use signorini_solid::{Elastic, SolidBody, Space, StressLaw};
use std::sync::Arc;

type V = Vector<3>;

/// `|t| ≤ min(μ p, k)`.
#[derive(Debug)]
struct Capped {
    coulomb: Coulomb,
    strength: Tresca,
}

impl Capped {
    fn yields(&self, pressure: f64) -> bool {
        self.coulomb.mu()[0] * pressure > self.strength.limit()
    }
}

impl Law for Capped {
    fn friction(&self, trial: [f64; 2], pressure: f64) -> Friction {
        match self.yields(pressure) {
            true => self.strength.friction(trial, pressure),
            false => self.coulomb.friction(trial, pressure),
        }
    }

    fn utilisation(&self, traction: [f64; 2], pressure: f64) -> f64 {
        self.strength.utilisation(traction, pressure).max(self.coulomb.utilisation(traction, pressure))
    }

    // Not in proportion to the pressure.
    fn per_pressure(&self) -> Option<[f64; 2]> {
        None
    }
}

const MU: f64 = 0.3;
const STRENGTH: f64 = 6.0;

/// Normal force and friction after the top of a unit cube went down by a depth and then sideways.
fn pushed(depth: f64) -> [f64; 2] {
    let edge = || (0..=3).map(|k| f64::from(k) / 3.0).collect::<Vec<f64>>();
    let mesh = block::<3>(&[edge(), edge(), edge()], 1, |x| x);
    let groups = mesh.groups().clone();
    let law = (Elastic { youngs_modulus: 1000.0, poissons_ratio: 0.3 }, StressLaw::LinearElastic);
    let cube = SolidBody::<3>::new("cube", Arc::new(mesh), 1, law, Space::Solid, groups).expect("a solid");
    let plane = RigidBody {
        name: "plane".into(),
        shape: Arc::new(Plane { point: V::zeros(), normal: V::z() }),
        motion: Motion::Prescribed(Arc::new(|_| RigidMotion::new(V::zeros(), V::zeros(), V::zeros()))),
        centre: V::zeros(),
        sites: Vec::new(),
        size: 1.0,
        mass: None,
    };
    let bodies: Vec<Box<dyn Body>> = vec![Box::new(cube), Box::new(plane)];

    let sides = [(Part { body: 0, group: Some("bottom".into()) }, 0), (Part { body: 1, group: None }, 1)];
    let [slave, master] = sides.map(|(part, body)| (part, bodies[body].as_ref()));
    let mut contact = Mortar::new("touch", slave, master, Enforcement::Multiplier).expect("faces");
    let coulomb = Coulomb::isotropic(MU).expect("a coefficient");
    contact.law.friction = Some(Box::new(Capped { coulomb, strength: Tresca::new(STRENGTH).expect("a limit") }));

    // Until time 1 downwards, until time 2 along x.
    let along: TimeField = Arc::new(|_, t| 0.2 * (t - 1.0).max(0.0));
    let down: TimeField = Arc::new(move |_, t| -depth * t.min(1.0));
    let across: TimeField = Arc::new(|_, _| 0.0);
    let displacement = [Some(along), Some(across), Some(down)];
    let part = Part { body: 0, group: Some("top".into()) };
    let top = Support { name: "top".into(), part, displacement, ..Support::default() };
    let mut system = System { bodies, supports: vec![top], contacts: vec![Box::new(contact)], ..System::default() };

    system.prepare().expect("a system");
    let mut state = system.start();
    let mut force = V::zeros();
    for time in [0.5, 1.0, 1.25, 1.5, 1.75, 2.0] {
        let (next, result) = system.solve(&state, time, &mut |_, _| true).expect("an equilibrium");
        system.accept(&next).expect("a state");
        force = result.sites[0].iter().map(|site| site.force()).sum();
        state = next;
    }
    [force[2], force[0].hypot(force[1])]
}

pub fn main() {
    // Pressures of about 10 and of about 60: μ p is below the strength, then above it everywhere. The area is 1.
    let [[light, rubs], [heavy, yields]] = [0.01, 0.06].map(pushed);
    println!("normal force {light:.4}: friction {rubs:.6}, μ N = {:.6}", MU * light);
    println!("normal force {heavy:.4}: friction {yields:.6}, k A = {STRENGTH:.6}");
    assert!((rubs / (MU * light) - 1.0).abs() < 1e-6, "{rubs}");
    assert!((yields / STRENGTH - 1.0).abs() < 1e-6, "{yields}");
}
