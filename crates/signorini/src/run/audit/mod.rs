//! The independent check of what was found: states as plain data for `signorini-audit`, and what its findings come to.

mod forces;
mod report;
pub mod system;

pub use report::{answer, is_resolved, of_errors, of_membrane, of_warnings};

use serde_json::{Value, json};
use signorini_audit::{Acting, Placement, State, Touch};
use signorini_geometry::rigid_shape::RigidShape;
use signorini_geometry::{Aabb, Point, Vector};

/// Strain from which the theory of small strains, and the linear law of a section, are off by as much of the result.
const STRAIN: f64 = super::strain::LARGE;

/// Part of the size of a body that rounding moves its places by, over many operations.
const ROUNDING: f64 = 1e-12;
/// Points along each side of the box of a rigid body from which points on its surface are found: in the plane, in space.
const ALONG: [usize; 2] = [64, 12];

/// Points on the surface of a rigid body with an end: those nearest to points of a box around it, pulled along its normals.
fn surface(shape: &dyn RigidShape, bounds: &Aabb<3>, in_space: bool) -> Vec<Point<3>> {
    let count = ALONG[usize::from(in_space)];
    let around = bounds.scaled(1.1);
    let share = |k: usize| k as f64 / count as f64;
    let mut out = Vec::new();
    let dimension = if in_space { 3 } else { 2 };
    for axis in 0..dimension {
        for end in [0.0, 1.0] {
            let side = if in_space { (count + 1) * (count + 1) } else { count + 1 };
            for k in 0..side {
                let (s, t) = (share(k % (count + 1)), share(k / (count + 1)));
                let mut xi = Point::<3>::repeat(0.5);
                xi[axis] = end;
                xi[(axis + 1) % dimension] = s;
                if in_space {
                    xi[(axis + 2) % 3] = t;
                }
                let mut x = around.at(&xi);
                if !in_space {
                    x[2] = 0.0;
                }
                let found = shape.gap(&x);
                let foot = x - found.normal * found.gap;
                out.extend(foot.iter().all(|v| v.is_finite()).then_some(foot));
            }
        }
    }
    out
}

/// Numbers of a touch in a checkpoint.
const NUMBERS: usize = 28;

fn to_numbers(t: &Touch) -> Vec<f64> {
    let (acts_at, acting) = t.on_centre_line.unwrap_or_default();
    let vectors = [&t.x, &t.foot, &t.normal, &t.friction, &t.slip, &acts_at, &acting];
    let mut out: Vec<f64> = vectors.iter().flat_map(|v| [v[0], v[1], v[2]]).collect();
    let flags = [t.is_closed, t.slips, t.on_centre_line.is_some()].map(|flag| f64::from(u8::from(flag)));
    out.extend([t.weight, t.area, t.pressure, t.worn]);
    out.extend(flags);
    out
}

fn of_numbers(n: &[f64]) -> Option<Touch> {
    if n.len() != NUMBERS {
        return None;
    }
    let vector = |k: usize| Point::<3>::new(n[3 * k], n[3 * k + 1], n[3 * k + 2]);
    Some(Touch {
        x: vector(0),
        foot: vector(1),
        normal: vector(2),
        friction: vector(3),
        slip: vector(4),
        on_centre_line: (n[27] != 0.0).then(|| (vector(5), vector(6))),
        weight: n[21],
        area: n[22],
        pressure: n[23],
        worn: n[24],
        is_closed: n[25] != 0.0,
        slips: n[26] != 0.0,
    })
}

/// What of a state a checkpoint keeps beside the places of the bodies: touches, forces, stored energy.
fn saved(state: &State) -> Value {
    let lists: Vec<Vec<Vec<f64>>> = state.contacts.iter().map(|list| list.iter().map(to_numbers).collect()).collect();
    let forces: Vec<[f64; 3]> = state.forces.iter().map(|f| f.force.into()).collect();
    json!({"touches": lists, "forces": forces, "stored": state.stored})
}

/// A state of which [`saved`] kept that; none where it is damaged.
fn restored(value: &Value, time: f64, bodies: Vec<Placement>) -> Option<State> {
    let lists: Vec<Vec<Vec<f64>>> = serde_json::from_value(value["touches"].clone()).ok()?;
    let touches = lists.iter().map(|list| list.iter().map(|n| of_numbers(n)).collect::<Option<Vec<_>>>());
    let forces: Vec<[f64; 3]> = serde_json::from_value(value["forces"].clone()).ok()?;
    let acting = |f: [f64; 3]| Acting {
        name: String::new(),
        body: 0,
        force: Vector::<3>::from(f),
        moment: None,
        work: None,
        drives: false,
        reacts: false,
    };
    Some(State {
        way: Vec::new(),
        time,
        bodies,
        contacts: touches.collect::<Option<Vec<_>>>()?,
        forces: forces.into_iter().map(acting).collect(),
        stored: value["stored"].as_f64(),
        dissipated: Vec::new(),
        dissipated_in_bodies: 0.0,
        in_motion: false,
    })
}

/// The work of a force that was another one before, on the way of its place, and how far it may be off.
fn mean_work(before: &Vector<3>, now: &Vector<3>, moved: &Vector<3>) -> [f64; 2] {
    [0.5 * (before + now).dot(moved), 0.5 * (now - before).dot(moved).abs()]
}

/// The largest side of a box.
fn extent(bounds: &Aabb<3>, in_space: bool) -> f64 {
    let size = bounds.size();
    (0..if in_space { 3 } else { 2 }).map(|k| size[k]).fold(0.0, f64::max)
}

/// The law of friction as limits, whatever its name.
fn law_of(law: &dyn signorini_contact::Law, problem: &crate::problem::Problem, name: &str) -> signorini_audit::Law {
    use crate::problem::Friction;
    use signorini_audit::Law;
    // Contacts of all pairs have names that begin with that of their key.
    let key =
        problem.contacts.iter().filter(|(key, _)| name.starts_with(key.as_str())).max_by_key(|(key, _)| key.len());
    let is_viscous = key.is_some_and(|(_, contact)| matches!(contact.friction, Some(Friction::Viscous(_))));
    if law.has_state() {
        // It grows with the velocity without a limit.
        return Law::AtMost([f64::MAX.sqrt(); 2]);
    }
    match law.per_pressure() {
        Some(mu) if is_viscous => Law::AtMost(mu),
        Some(mu) => Law::PerPressure(mu),
        None => Law::Limit(law.friction([f64::MAX.sqrt(), 0.0], 1.0).traction[0].abs()),
    }
}
