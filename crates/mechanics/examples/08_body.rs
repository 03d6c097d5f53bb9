//! A body of one's own: a point on springs, which its weight presses on an inclined plane.
//!
//! `cargo run --release -p signorini-mechanics --example 08_body`

use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::Plane;
use signorini_geometry::{Matrix, Point, Vector};
use signorini_mechanics::{
    Body, BodyError, BodyFields, BodyState, BoxOfMaterial, Constitution, Constraint, Contact, ContactSides,
    Contribution, Elimination, Enforcement, Function, Hold, Inertial, Kinematics, Load, Master, Motion, Order, Part,
    PlaceError, PlacedLoad, RigidBody, Sampling, Site, Slack, SlavePoint, System, TimedLoad,
};
use std::sync::Arc;

type V = Vector<3>;

/// A point that springs pull back to where it started.
struct SprungPoint {
    at: Point<3>,
    /// Force per displacement, the same along all axes.
    stiffness: f64,
}

fn refuse<T>(message: &str) -> Result<T, PlaceError> {
    Err(PlaceError::Unsuitable { body: "point".into(), message: message.into() })
}

fn axis(i: usize) -> V {
    V::from_fn(|k, _| f64::from(u8::from(k == i)))
}

impl SprungPoint {
    fn moved(state: &BodyState) -> V {
        V::from_column_slice(&state.configuration)
    }
}

impl Body for SprungPoint {
    fn name(&self) -> &str {
        "point"
    }

    fn unknowns(&self) -> usize {
        3
    }

    fn start(&self) -> BodyState {
        BodyState { configuration: vec![0.0; 3], internal: Vec::new() }
    }

    fn advance(&self, state: &BodyState, step: &[f64], share: f64) -> BodyState {
        let configuration = state.configuration.iter().zip(step).map(|(u, s)| u + share * s).collect();
        BodyState { configuration, internal: Vec::new() }
    }

    fn internal(&self, state: &BodyState, order: Order, out: &mut Contribution) -> Result<f64, BodyError> {
        let u = Self::moved(state);
        let force = u * self.stiffness;
        out.forces.iter_mut().zip(&force).for_each(|(sum, f)| *sum += f);
        if order == Order::Second {
            out.add_block(&[0, 1, 2], Matrix::<3>::from_diagonal_element(self.stiffness).as_slice());
        }
        Ok(0.5 * force.dot(&u))
    }

    fn hold(&self, _: Option<&str>, _: &Hold<'_>, _: &BodyState) -> Result<Vec<Constraint>, PlaceError> {
        refuse("springs hold it")
    }

    fn load(
        &self,
        _: Option<&str>,
        load: &Load<'_>,
        _: &BodyState,
        _: Order,
        out: &mut Contribution,
    ) -> Result<(), PlaceError> {
        let Load::Force(force) = load else { return refuse("a point takes forces only") };
        out.forces.iter_mut().zip(force).for_each(|(sum, f)| *sum -= f);
        Ok(())
    }

    fn sites(&self, _: Option<&str>, _: Sampling) -> Result<Vec<Site>, PlaceError> {
        Ok(vec![Site { weight: 1.0, ..Site::default() }])
    }

    fn placed(&self, state: &BodyState, _: &Site) -> SlavePoint {
        let function = |i: usize| Function { unknown: i as u32, value: axis(i), ..Function::default() };
        SlavePoint {
            x: self.at + Self::moved(state),
            functions: (0..3).map(function).collect(),
            frame: Matrix::<3>::identity(),
            ..SlavePoint::default()
        }
    }

    fn master<'a>(&'a self, _: Option<&str>, _: &'a BodyState) -> Result<Box<dyn Master + 'a>, PlaceError> {
        refuse("a point is tested, not touched: name it first")
    }

    fn site_stiffness(&self, _: &Site) -> f64 {
        self.stiffness
    }

    fn rigid_modes(&self, state: &BodyState) -> [Vec<f64>; 6] {
        let x = self.at + Self::moved(state);
        std::array::from_fn(|mode| if mode < 3 { axis(mode) } else { axis(mode - 3).cross(&x) }.as_slice().to_vec())
    }

    fn size(&self) -> f64 {
        1.0
    }

    fn fields(&self, state: &BodyState) -> BodyFields {
        BodyFields { points: vec![self.at], displacement: vec![Self::moved(state)], ..BodyFields::default() }
    }
}

impl Kinematics for SprungPoint {}

impl signorini_mechanics::Thermal for SprungPoint {}

impl Inertial for SprungPoint {}

impl Elimination for SprungPoint {}

impl ContactSides for SprungPoint {}

impl Slack for SprungPoint {}

impl BoxOfMaterial for SprungPoint {}

impl Constitution for SprungPoint {}

pub fn main() {
    // 1. A point on springs, at rest on a plane that is inclined.
    let (point, normal) = (SprungPoint { at: V::zeros(), stiffness: 100.0 }, V::new(0.6, 0.0, 0.8));
    let plane = RigidBody {
        name: "plane".into(),
        shape: Arc::new(Plane { point: V::zeros(), normal }),
        motion: Motion::Prescribed(Arc::new(|_| RigidMotion::new(V::zeros(), V::zeros(), V::zeros()))),
        centre: V::zeros(),
        sites: Vec::new(),
        size: 1.0,
        mass: None,
    };
    let (load, stiffness) = (V::new(0.0, 0.0, -5.0), point.stiffness);
    let mut system = System { bodies: vec![Box::new(point), Box::new(plane)], ..System::default() };

    // 2. Its weight, and contact.
    let weight = TimedLoad::Force(Arc::new(move |_, time| load * time));
    system.loads.push(PlacedLoad { name: "weight".into(), part: Part::from(0), load: weight });
    let side = |body: usize| (Part::from(body), system.bodies[body].as_ref());
    let touch = Contact::new("touch", side(0), side(1), Sampling::Nodes, Enforcement::Multiplier).expect("points");
    system.contacts.push(Box::new(touch));

    // 3. The plane carries what is across it, the springs what is along it.
    system.prepare().expect("a system");
    let (state, result) = system.solve(&system.start(), 1.0, &mut |_, _| true).expect("an equilibrium");
    let (found, exact) = (SprungPoint::moved(&state.bodies[0]), (load - normal * normal.dot(&load)) / stiffness);
    let (carried, weight) = (result.sites[0][0].pressure, -normal.dot(&load));
    println!("pressed on by {carried:.10}, exact {weight:.10}");
    println!("moved by {:.10} {:.10}, exact {:.10} {:.10}", found[0], found[2], exact[0], exact[2]);
    assert!((carried - weight).abs() < 1e-9 * weight && (found - exact).norm() < 1e-9 * exact.norm());
}
