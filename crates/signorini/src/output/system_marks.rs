//! What a case asks of its bodies, as marks: where they are supported, what loads them, which sides may touch.

use super::camera::Camera;
use super::chart::word;
use super::colours::{BLUE, GREEN, ORANGE, PURPLE, SKY, VERMILION};
use super::page::{Page, Sign, css};
use crate::plan::mechanics::MechanicsPlan;
use plotters::style::RGBColor;
use signorini_geometry::Vector;
use signorini_mechanics::{Part, Sampling, SystemState, TimedLoad};
use std::fmt::Write as _;

const SUPPORT: RGBColor = RGBColor(20, 90, 50);
const LOAD: RGBColor = RGBColor(190, 30, 30);
/// Of contacts, in the order of the case.
const CONTACTS: [RGBColor; 6] = [ORANGE, BLUE, GREEN, PURPLE, SKY, VERMILION];
/// More marks of one support or load hide the body, and more dots of a contact each other.
const MARKS: usize = 12;
const DOTS: usize = 400;
/// Length of an arrow and the height of a triangle, on the page.
const ARROW: f64 = 42.0;
const TRIANGLE: f64 = 9.0;

/// A place of a body with the direction to which it looks, where it has one.
type Place = (Vector<3>, Option<Vector<3>>);

/// The marks of one support, load or contact.
pub struct Mark {
    name: String,
    kind: Kind,
    places: Vec<Place>,
}

enum Kind {
    Support,
    /// The direction of the force at each place.
    Load(Vec<Vector<3>>),
    /// The number of the contact.
    Contact(usize),
}

/// All marks of a plan, at the start.
pub fn marks(plan: &MechanicsPlan) -> Vec<Mark> {
    let start = plan.system.start();
    let end = plan.times.last().copied().unwrap_or(1.0);
    let mut out = Vec::new();
    for (number, contact) in plan.system.contacts.iter().enumerate() {
        let stated = plan.head.problem.contacts.get(contact.name());
        let between = stated.and_then(|c| c.between.as_ref()).into_iter().flatten();
        let mut places: Vec<Place> =
            between.filter_map(|side| part(plan, side)).flat_map(|p| of_part(plan, &start, &p)).collect();
        if places.is_empty() {
            let sites = plan.system.sites(number, &start).unwrap_or_default();
            places = sites.iter().map(|s| (s.x, None)).collect();
        }
        out.push(Mark { name: contact.name().to_string(), kind: Kind::Contact(number), places: thinned(places, DOTS) });
    }
    for support in &plan.system.supports {
        let places = thinned(of_part(plan, &start, &support.part), MARKS);
        out.push(Mark { name: support.name.clone(), kind: Kind::Support, places });
    }
    for load in &plan.system.loads {
        let places = thinned(of_part(plan, &start, &load.part), MARKS);
        let force = |(x, outward): &Place| match &load.load {
            TimedLoad::BodyForce(f) | TimedLoad::Traction(f) => f(x, end),
            TimedLoad::Force(f) | TimedLoad::NodalForce(f) => f(x, end),
            TimedLoad::Moment(f) | TimedLoad::FollowerMoment(f) => f(x, end),
            TimedLoad::Pressure(p) => outward.unwrap_or_default() * -p(x, end),
            TimedLoad::Weight(acceleration, _) => acceleration(end),
            TimedLoad::Tension(_) | TimedLoad::Springs(_) => Vector::<3>::zeros(),
        };
        let forces = places.iter().map(force).collect();
        out.push(Mark { name: load.name.clone(), kind: Kind::Load(forces), places });
    }
    out.retain(|mark| !mark.places.is_empty());
    out
}

/// The part of a body that a case calls `BODY` or `BODY:GROUP`.
fn part(plan: &MechanicsPlan, text: &str) -> Option<Part> {
    let (body, group) = text.split_once(':').map_or((text, None), |(body, group)| (body, Some(group.to_string())));
    let body = plan.system.bodies.iter().position(|b| b.name() == body)?;
    (!plan.system.bodies[body].is_rigid()).then_some(Part { body, group })
}

/// The points of a part; none of one that has no surface.
fn of_part(plan: &MechanicsPlan, start: &SystemState, part: &Part) -> Vec<Place> {
    let (body, state) = (&plan.system.bodies[part.body], &start.bodies[part.body]);
    let group = part.group.as_deref();
    let sites = body.sites(group, Sampling::Nodes).unwrap_or_default();
    let mut places: Vec<Place> =
        (sites.iter()).map(|site| body.placed(state, site)).map(|point| (point.x, point.outward)).collect();
    if places.is_empty() {
        places.extend(body.point(group).map(|x| (x, None)));
    }
    places
}

/// So many of a list at most, evenly.
fn thinned(places: Vec<Place>, most: usize) -> Vec<Place> {
    let step = places.len().div_ceil(most).max(1);
    places.into_iter().step_by(step).collect()
}

/// Draws marks, and says what they are.
pub fn draw(page: &mut Page, marks: &[Mark], camera: &Camera) -> Vec<(Sign, String)> {
    let mut key = Vec::new();
    for mark in marks {
        match &mark.kind {
            Kind::Contact(number) => {
                let colour = CONTACTS[number % CONTACTS.len()];
                for (x, outward) in &mark.places {
                    let (u, v) = camera.at(x);
                    // What looks away is behind its body.
                    let is_seen = outward.is_none_or(|n| n.dot(&camera.towards) > -1e-9);
                    let fill = if is_seen { css(colour) } else { "none".into() };
                    let _ = write!(
                        page.svg,
                        "<circle cx=\"{u:.1}\" cy=\"{v:.1}\" r=\"2.4\" fill=\"{fill}\" stroke=\"{}\"/>",
                        css(colour)
                    );
                }
                key.push((Sign::Dot(colour), format!("contact {}", mark.name)));
            }
            Kind::Support => {
                for (x, _) in &mark.places {
                    triangle(&mut page.svg, camera.at(x));
                }
                key.push((Sign::Line(SUPPORT), format!("support {}", mark.name)));
            }
            Kind::Load(forces) => {
                let most = forces.iter().map(|f| f.norm()).fold(0.0, f64::max);
                for ((x, outward), force) in mark.places.iter().zip(forces).filter(|_| most > 0.0) {
                    arrow(&mut page.svg, camera, x, *outward, &(force / most));
                }
                key.push((Sign::Line(LOAD), format!("load {}", mark.name)));
            }
        }
    }
    let mut taken: Vec<(f64, f64)> = Vec::new();
    for mark in marks.iter().filter(|mark| !matches!(mark.kind, Kind::Contact(_))) {
        let middle = mark.places.iter().map(|p| p.0).sum::<Vector<3>>() / mark.places.len() as f64;
        let (x, mut y) = camera.at(&middle);
        while taken.iter().any(|(u, v): &(f64, f64)| (u - x).abs() < 60.0 && (v - y).abs() < 18.0) {
            y += 18.0;
        }
        taken.push((x, y));
        let colour = if matches!(mark.kind, Kind::Support) { SUPPORT } else { LOAD };
        word(&mut page.svg, (x, y + 20.0), &mark.name, colour);
    }
    key
}

/// A triangle that carries a point.
fn triangle(svg: &mut String, (x, y): (f64, f64)) {
    let (half, low) = (0.6 * TRIANGLE, y + TRIANGLE);
    let colour = css(SUPPORT);
    let _ = write!(
        svg,
        "<path d=\"M{x:.1} {y:.1}L{:.1} {low:.1}H{:.1}Z\" fill=\"white\" stroke=\"{colour}\" stroke-width=\"1.6\"/>",
        x + half,
        x - half
    );
}

/// A force at a point: towards it where it pushes on a surface, away from it elsewhere.
fn arrow(svg: &mut String, camera: &Camera, x: &Vector<3>, outward: Option<Vector<3>>, force: &Vector<3>) {
    let shift = force * (ARROW / camera.scale);
    let pushes = outward.is_some_and(|n| n.dot(force) < 0.0);
    let [from, to] = if pushes { [x - shift, *x] } else { [*x, x + shift] };
    let [(a, b), (c, d)] = [from, to].map(|x| camera.at(&x));
    let length = (c - a).hypot(d - b);
    if length < 3.0 {
        return;
    }
    let (p, q) = ((c - a) / length, (d - b) / length);
    let (u, v) = (c - 8.0 * p, d - 8.0 * q);
    let colour = css(LOAD);
    let _ = write!(
        svg,
        "<path d=\"M{a:.1} {b:.1}L{u:.1} {v:.1}\" stroke=\"{colour}\" stroke-width=\"2\"/>\
         <path d=\"M{c:.1} {d:.1}L{:.1} {:.1}L{:.1} {:.1}Z\" fill=\"{colour}\"/>",
        u - 3.4 * q,
        v + 3.4 * p,
        u + 3.4 * q,
        v - 3.4 * p
    );
}
