//! Curves in systems.

use signorini_geometry::Vector;
use signorini_mechanics::contact::Part;
use signorini_mechanics::system::TimeField;
use signorini_mechanics::{Body, PlacedLoad, SiteResult, Support, System, TimedLoad};
use signorini_rope::beam::Beam;
use signorini_rope::cable::Cable;
use signorini_rope::cable::element::Carries;
use signorini_rope::centreline::{Closure, Continuity};
use signorini_rope::chain::body::ReferenceLength;
use signorini_rope::curve_pair::CurveContact;
use signorini_rope::path::Path;
use signorini_rope::section::Stiffness;
use std::sync::Arc;

type V = Vector<3>;

pub fn path(points: &[V]) -> Path {
    match points.len() {
        2 => Path::points(points, Closure::Open).unwrap(),
        _ => Path::spline(points, Closure::Open).unwrap(),
    }
}

pub fn beam(name: &str, points: &[V], cells: usize, stiffness: Stiffness, radius: f64) -> Beam {
    Beam::new(name, &path(points).sample(cells, Continuity::C1).unwrap(), None, stiffness, radius).unwrap()
}

pub fn cable(name: &str, points: &[V], cells: usize, radius: f64) -> Cable {
    let path = path(points).sample(cells, Continuity::C1).unwrap();
    Cable::new(name, &path, 100.0, 1.0, Carries::TensionAndCompression, ReferenceLength::Path, radius).unwrap()
}

pub fn slender(bending: f64, stiff: f64) -> Stiffness {
    Stiffness { axial: stiff, shear: [stiff; 2], torsion: bending, bending: [bending; 2] }
}

pub fn part(body: usize, group: &str) -> Part {
    Part { body, group: Some(group.to_string()) }
}

/// Displacement and rotation of an end by components, as functions of place and time.
pub fn held(
    body: usize,
    group: &str,
    displacement: [Option<TimeField>; 3],
    rotation: [Option<TimeField>; 3],
) -> Support {
    Support {
        name: format!("{group} of {body}"),
        part: part(body, group),
        displacement,
        rotation,
        ..Support::default()
    }
}

pub fn at_zero() -> Option<TimeField> {
    Some(Arc::new(|_, _| 0.0))
}

pub fn field(of: impl Fn(&V, f64) -> f64 + Send + Sync + 'static) -> Option<TimeField> {
    Some(Arc::new(of))
}

pub fn clamped(body: usize, group: &str) -> Support {
    held(body, group, [(); 3].map(|()| at_zero()), [(); 3].map(|()| at_zero()))
}

/// A force that grows with time.
pub fn pulled(body: usize, group: &str, force: V) -> PlacedLoad {
    let load = TimedLoad::Force(Arc::new(move |_, t| force * t));
    PlacedLoad { name: format!("force on {group} of {body}"), part: part(body, group), load }
}

/// Bodies with contact between the first two, or of the only one with itself.
pub fn system(bodies: Vec<Box<dyn Body>>, change: impl FnOnce(&mut CurveContact)) -> System {
    let other = bodies.len() - 1;
    let sides = [(0, bodies[0].as_ref()), (other, bodies[other].as_ref())];
    let enforcement = signorini_mechanics::Enforcement::Penalty { wanted_penetration: None };
    let mut contact = CurveContact::new("touch", sides[0], sides[1], enforcement).unwrap();
    change(&mut contact);
    System { bodies, contacts: vec![Box::new(contact)], ..System::default() }
}

pub fn total(sites: &[SiteResult]) -> f64 {
    sites.iter().map(|s| s.pressure * s.weight).sum()
}
