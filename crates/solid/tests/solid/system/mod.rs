//! Solids as bodies of a system: finite strain, sliding with friction, free rigid bodies.

use signorini_contact::Coulomb;
use signorini_fem::Mesh;
use signorini_fem::block::block;
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::rigid_shape::RigidShape;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::*;
use signorini_solid::{Elastic, SolidBody, Space, StressLaw};
use std::sync::Arc;

mod blocks;
mod bodies;
mod condensed;
mod contacts;
mod groove;
mod held;
mod laws;
mod mortar;
mod ring;
mod sliding;
mod tangents;
mod tied;

const ELASTIC: Elastic = Elastic { youngs_modulus: 1.0, poissons_ratio: 0.3 };

fn v(x: f64, y: f64, z: f64) -> Vector<3> {
    Vector::<3>::new(x, y, z)
}

fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| from + (to - from) * k as f64 / n as f64).collect()
}

fn noise(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    ((*seed >> 33) as f64 / (1u64 << 31) as f64) * 2.0 - 1.0
}

fn rectangle(
    low: [f64; 2],
    high: [f64; 2],
    n: [usize; 2],
    order: usize,
    map: impl FnMut(Point<2>) -> Point<2>,
) -> Mesh<2> {
    block::<2>(&[even(low[0], high[0], n[0]), even(low[1], high[1], n[1])], order, map)
}

fn cuboid(low: [f64; 3], high: [f64; 3], n: [usize; 3], map: impl FnMut(Point<3>) -> Point<3>) -> Mesh<3> {
    block::<3>(&std::array::from_fn(|k| even(low[k], high[k], n[k])), 1, map)
}

pub fn solid<const D: usize>(
    name: &str,
    mesh: Mesh<D>,
    degree: usize,
    elastic: Elastic,
    law: StressLaw,
) -> SolidBody<D> {
    let space = if D == 2 { Space::PlaneStrain } else { Space::Solid };
    let groups = mesh.groups().clone();
    SolidBody::new(name, Arc::new(mesh), degree, (elastic, law.clone()), space, groups).unwrap()
}

pub fn part(body: usize, group: &str) -> Part {
    Part { body, group: (!group.is_empty()).then(|| group.to_string()) }
}

/// Holds the components of which a value is given, all over a group, at that value times the time.
pub fn hold(body: usize, group: &str, values: [Option<f64>; 3]) -> Support {
    let field = |value: f64| -> TimeField { Arc::new(move |_, t| value * t) };
    Support {
        name: group.into(),
        part: part(body, group),
        displacement: values.map(|v| v.map(field)),
        rotation: [None, None, None],
        ..Support::default()
    }
}

pub fn load(body: usize, group: &str, load: TimedLoad) -> PlacedLoad {
    PlacedLoad { name: group.into(), part: part(body, group), load }
}

type TimeField = signorini_mechanics::system::TimeField;

pub fn rigid(shape: impl RigidShape + 'static, motion: impl Fn(f64) -> Vector<3> + Send + Sync + 'static) -> RigidBody {
    let zero = Vector::<3>::zeros();
    let centre = shape.centre();
    let motion = Motion::Prescribed(Arc::new(move |t| RigidMotion::new(zero, zero, motion(t))));
    RigidBody { name: "tool".into(), shape: Arc::new(shape), motion, centre, sites: Vec::new(), size: 1.0, mass: None }
}

/// Where contact is tested.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Test {
    Sites(Sampling),
    /// In the mean over dual functions, with so many further points of each piece.
    Mortar(usize),
}

impl From<Sampling> for Test {
    fn from(sampling: Sampling) -> Test {
        Test::Sites(sampling)
    }
}

/// Adds a contact between groups of two bodies.
fn touch(
    system: &mut System,
    [slave, master]: [(usize, &str); 2],
    test: impl Into<Test>,
    enforcement: Enforcement,
    mu: Option<f64>,
) {
    let of = |(body, group): (usize, &str)| (part(body, group), system.bodies[body].as_ref());
    let friction = mu.map(|mu| Box::new(Coulomb::isotropic(mu).unwrap()) as _);
    match test.into() {
        Test::Sites(sampling) => {
            let mut contact = Contact::new("touch", of(slave), of(master), sampling, enforcement).unwrap();
            contact.law.friction = friction;
            system.contacts.push(Box::new(contact));
        }
        Test::Mortar(extra) => {
            let mut contact = Mortar::new("touch", of(slave), of(master), enforcement).unwrap();
            contact.refine(extra);
            contact.law.friction = friction;
            system.contacts.push(Box::new(contact));
        }
    }
}

/// Force of a contact on its slave.
pub fn force(result: &IncrementResult, contact: usize) -> Vector<3> {
    result.sites[contact].iter().map(SiteResult::force).sum()
}

/// Solves at one time after the other; the last state and all results.
pub fn run(system: &mut System, times: &[f64]) -> (SystemState, Vec<IncrementResult>) {
    system.prepare().unwrap();
    let mut state = system.start();
    let mut results = Vec::new();
    for &time in times {
        let found = system.solve(&state, time, &mut |_, _| true);
        let (next, result) = found.unwrap_or_else(|e| panic!("at {time} after {}: {e}\n{e:?}", told(&results)));
        system.accept(&next).unwrap();
        state = next;
        results.push(result);
    }
    (state, results)
}

/// Iterations and last steps of Newton's method, increment by increment.
fn told(results: &[IncrementResult]) -> String {
    let last = |h: &[f64]| h.iter().rev().take(4).rev().map(|m| format!("{m:.0e}")).collect::<Vec<_>>().join(" ");
    results.iter().map(|r| format!("[{}: {}] ", r.iterations, last(&r.history))).collect()
}

/// Whether the last steps of Newton's method square the residual, from where it is small until rounding.
fn is_quadratic(history: &[f64]) -> bool {
    // The measure is the residual over 1e-10 of the largest force.
    let r: Vec<f64> = history.iter().map(|m| m * 1e-10).collect();
    r.windows(2).filter(|w| w[0] < 1e-4 && w[0] > 1e-8).all(|w| w[1] <= (300.0 * w[0] * w[0]).max(1e-10))
}
