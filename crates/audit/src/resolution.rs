//! Whether the cells are small enough for the zone of contact. A zone that ends within the surface has to be met by several
//! cells before its size and its pressure mean anything: both go with the size of a cell otherwise, not with the force.

use crate::finding::{Check, Finding, Outcome};
use crate::nearest::{centre, extent};
use crate::state::{Carries, Contact, Form, Setting, Space, State, Touch};
use signorini_geometry::{Point, Vector};

/// Cells across a zone, and places in it, below which pressures are off by some tenths.
const CELLS: f64 = 3.0;
const PLACES: usize = 8;
/// Cells with which a pressure is good to a few per cent.
const WANTED: f64 = 8.0;
/// Change of force under which the area should change too, and change of area that is none.
const FORCE: f64 = 0.2;
const AREA: f64 = 1e-9;

/// Cells of a rope or beam per radius of what it touches beyond which it may pass through between its points.
const PER_RADIUS: f64 = 0.5;

/// Checks the zones of all contacts of surfaces.
pub fn check(setting: &Setting, before: Option<&State>, now: &State) -> Vec<Finding> {
    let of = |(k, contact): (usize, &Contact)| {
        let earlier = before.and_then(|s| s.contacts.get(k)).map_or(&[][..], Vec::as_slice);
        of_contact(setting, now, contact, [earlier, &now.contacts[k]])
            .or_else(|| of_curve(setting, now, contact, &now.contacts[k]))
    };
    setting.contacts.iter().enumerate().filter_map(of).collect()
}

/// Whether a rope or beam passes by a rigid body that is smaller than its cells: it is tested at points in each of them.
fn of_curve(setting: &Setting, state: &State, contact: &Contact, touches: &[Touch]) -> Option<Finding> {
    let [own, other] = contact.bodies;
    let (Form::Curve(curve), Form::Rigid(rigid)) = (&setting.bodies[own].form, &setting.bodies[other].form) else {
        return None;
    };
    let cell = curve.longest_cell();
    let motion = state.bodies[other].motion();
    let carrying = touches.iter().filter(|t| t.is_closed && t.pressure > 0.0);
    let curvature = |t: &Touch| rigid.gap_now(&motion, &t.x).hessian.norm();
    let (bent, x) = carrying.map(|t| (curvature(t), t.x)).max_by(|a, b| a.0.total_cmp(&b.0))?;
    let radius = 1.0 / bent + curve.radius;
    if !bent.is_finite() || cell <= PER_RADIUS * radius {
        return None;
    }
    let [name, body] = [own, other].map(|k| &setting.bodies[k].name);
    let message = format!(
        "`{name}` has cells of {cell:.3e} and touches `{body}`, of radius {radius:.3e} with its own, at points in each cell: \
         what lies between is not seen"
    );
    let remedy = format!("use cells of {:.2e} or less there", PER_RADIUS * radius);
    let finding = Finding::new(Check::Resolution, Outcome::Doubt, message).measured(cell / radius, PER_RADIUS);
    Some(finding.at(x).on(&contact.name).remedy(remedy))
}

fn of_contact(setting: &Setting, state: &State, contact: &Contact, [before, now]: [&[Touch]; 2]) -> Option<Finding> {
    let closed: Vec<&Touch> = now.iter().filter(|t| t.is_closed).collect();
    // What touches all over ends where the body does.
    if contact.carries != Carries::Traction
        || closed.is_empty()
        || closed.len() == now.iter().filter(|t| t.weight > 0.0).count()
    {
        return None;
    }
    let most = closed.iter().max_by(|a, b| a.pressure.total_cmp(&b.pressure))?;
    let sizes = contact.bodies.iter().filter_map(|k| cell_at(setting, state, *k, &most.x));
    let cell = sizes.reduce(f64::max)?;
    let area: f64 = closed.iter().map(|t| t.area).sum();
    let width = width(setting.space, &closed);
    let cells = width / cell;
    let force = |list: &[Touch]| list.iter().filter(|t| t.is_closed).map(|t| t.force().1).sum::<Vector<3>>().norm();
    let earlier: f64 = before.iter().filter(|t| t.is_closed).map(|t| t.area).sum();
    let [f, g] = [force(before), force(now)];
    let stays = earlier > 0.0 && (area - earlier).abs() <= AREA * area && (g - f).abs() > FORCE * f.max(g);
    let few = closed.len() < if setting.space == Space::ThreeD { PLACES } else { CELLS as usize };
    let name = &contact.name;
    let what = format!("the zone of `{name}` is {cells:.2} cells wide and has {} contact points", closed.len());
    let finding = |outcome, message: String| {
        Finding::new(Check::Resolution, outcome, message).measured(CELLS / cells, 1.0).at(most.x).on(name)
    };
    if cells >= CELLS && !few && !(stays && cells < WANTED) {
        return Some(finding(Outcome::Fine, what));
    }
    let why = if stays {
        format!("{what}: its area is constant while the force changes from {f:.3e} to {g:.3e}")
    } else if few {
        format!("{what}: its area and pressure are determined by the cells")
    } else {
        format!("{what}, and the error of its area and pressure is not known")
    };
    let fine = width.min(cell) / WANTED;
    let remedy = if fine > 0.0 {
        format!("use cells of {fine:.2e} or less there instead of {cell:.2e}")
    } else {
        format!("use cells much smaller than {cell:.2e} there")
    };
    Some(finding(Outcome::Doubt, why).remedy(remedy))
}

/// How wide a zone of contact is.
pub fn width(space: Space, closed: &[&Touch]) -> f64 {
    let area: f64 = closed.iter().map(|t| t.area).sum();
    match space {
        Space::ThreeD => area.sqrt(),
        Space::Plane => area,
        Space::Axisymmetric if closed.is_empty() => 0.0,
        Space::Axisymmetric => spread(closed),
    }
}

/// The largest distance of places from the first and farthest of them.
fn spread(list: &[&Touch]) -> f64 {
    let far = |from: &Point<3>| {
        list.iter().max_by(|a, b| (a.x - from).norm().total_cmp(&(b.x - from).norm())).map_or(*from, |t| t.x)
    };
    let end = far(&list[0].x);
    (far(&end) - end).norm()
}

/// The size of the cell of a solid nearest to a place.
pub fn cell_at(setting: &Setting, state: &State, body: usize, x: &Point<3>) -> Option<f64> {
    let Form::Solid(solid) = &setting.bodies[body].form else { return None };
    let points = state.bodies[body].points();
    let distance = |facet: &&Vec<u32>| (centre(points, facet) - x).norm() - 0.5 * extent(points, facet);
    let facets = solid.boundary.facets.iter().enumerate();
    let nearest = facets.min_by(|a, b| distance(&a.1).total_cmp(&distance(&b.1)))?;
    Some(solid.cell_at(nearest.0)[0])
}
