//! A rigid shape of one's own: a bowl, the outside of a sphere. A ball in it, pulled aside, comes to rest where the bowl carries
//! its weight and the pull together.
//!
//! `cargo run --release -p signorini-mechanics --example 07_rigid_shape`

use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::{GapJet, RigidShape, Sphere};
use signorini_geometry::{Matrix, Point, Vector};
use signorini_mechanics::{
    Contact, Enforcement, Motion, Part, PlacedLoad, RigidBody, RigidSite, Sampling, System, TimedLoad,
};
use std::sync::Arc;

type V = Vector<3>;

/// All that is farther from a centre than a radius.
struct Bowl {
    centre: Point<3>,
    radius: f64,
}

impl RigidShape for Bowl {
    /// `g = R - |x - c|` with its gradient, which points out of the body, and its Hessian.
    fn gap(&self, x: &Point<3>) -> GapJet<3> {
        let d = x - self.centre;
        let distance = d.norm();
        let normal = -d.try_normalize(0.0).unwrap_or(-V::z());
        let across = Matrix::<3>::identity() - normal * normal.transpose();
        let curvature = if distance > 0.0 { 1.0 / distance } else { 0.0 };
        GapJet { gap: self.radius - distance, normal, hessian: across * -curvature }
    }

    fn centre(&self) -> Point<3> {
        self.centre
    }
}

const BOWL: f64 = 2.0;
const BALL: f64 = 0.5;
const WEIGHT: f64 = 3.0;
const PULL: f64 = 1.5;

pub fn main() {
    // 1. A bowl at rest, and a free ball: it is tested for contact at its centre, with its radius.
    let bowl = Bowl { centre: V::zeros(), radius: BOWL };
    let at_rest = Motion::Prescribed(Arc::new(|_| RigidMotion::new(V::zeros(), V::zeros(), V::zeros())));
    let bowl = RigidBody {
        name: "bowl".into(),
        centre: bowl.centre(),
        shape: Arc::new(bowl),
        motion: at_rest,
        sites: Vec::new(),
        size: BOWL,
        mass: None,
    };
    let centre = V::new(0.0, 0.0, -1.0);
    let ball = RigidBody {
        name: "ball".into(),
        shape: Arc::new(Sphere { center: centre, radius: BALL }),
        motion: Motion::Free { plane: false },
        centre,
        sites: vec![RigidSite { x: centre, outward: None, radius: BALL, weight: 1.0 }],
        size: BALL,
        mass: None,
    };
    let mut system = System { bodies: vec![Box::new(ball), Box::new(bowl)], ..System::default() };

    // 2. The weight of the ball, and a pull that grows with time.
    let force = TimedLoad::Force(Arc::new(|_, time| V::new(PULL * time, 0.0, -WEIGHT)));
    system.loads.push(PlacedLoad { name: "forces".into(), part: Part::from(0), load: force });

    // 3. Contact at the points of the ball.
    let side = |body: usize| (Part::from(body), system.bodies[body].as_ref());
    let contact = Contact::new("touch", side(0), side(1), Sampling::Nodes, Enforcement::Multiplier).expect("points");
    system.contacts.push(Box::new(contact));

    // 4. At rest the force of the bowl goes through both centres, at the angle of the load.
    system.prepare().expect("a system");
    let (state, result) = system.solve(&system.start(), 1.0, &mut |_, _| true).expect("a state of rest");
    let found = V::from_column_slice(&state.bodies[0].configuration[..3]);
    let load = V::new(PULL, 0.0, -WEIGHT);
    let exact = load.normalize() * (BOWL - BALL);
    println!("the ball rests at {:.8} {:.8}, exact {:.8} {:.8}", found[0], found[2], exact[0], exact[2]);
    println!("the bowl carries {:.8}, exact {:.8}", result.sites[0][0].force().norm(), load.norm());
    assert!((found - exact).norm() < 1e-7 * BOWL, "{found}");
    assert!((result.sites[0][0].force() + load).norm() < 1e-7 * load.norm());
}
