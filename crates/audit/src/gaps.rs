//! Whether bodies lie outside of each other: global closest points from both sides, of whole bodies.
//!
//! A penetration is explained by the penetration that was asked for, by the sagitta `h² κ / 8` of cells of size `h` on a
//! surface of curvature `κ`, and where forces act near by, by a part of a cell: conditions of contact hold at points, or in the
//! mean over cells. Where nothing carries only the sagitta explains it: nothing keeps the bodies apart there.

use crate::finding::{Check, Finding, Outcome};
use crate::nearest::{mean, of_segments};
use crate::obstacle::{Found, Obstacle};
use crate::samples::{self, Sample, thickness, turns};
use crate::state::{Contact, Curve, Form, Placement, Setting, Space, State, Touch};
use rayon::prelude::*;
use signorini_geometry::bvh::Bvh;
use signorini_geometry::{Aabb, Point, Vector};

/// Penetration as a share of a cell where forces act, from which it is told: by as much forces come out wrong about.
const TOLD: f64 = 0.05;
/// And from which the state is none: the point in the middle of a cell is on the other side.
const REFUSED: f64 = 0.5;
/// The same where nothing carries: far above rounding and what iterations leave, far below what could be meant.
const NOWHERE: f64 = 0.01;
/// Cells around forces within which these act.
const NEAR: f64 = 2.0;
/// Penetration as a share of the zone of contact that is not yet refused: cells may be tiny where a corner presses.
const OF_ZONE: f64 = 0.025;
/// Sagittae are those of smooth curves: cells may be unlike.
const UNLIKE: f64 = 1.5;
/// Bodies that touch themselves do so farther along than this many cells.
const APART: f64 = 3.0;

/// Checks the gaps of all pairs that contacts name.
pub fn check(setting: &Setting, state: &State) -> Vec<Finding> {
    let mut out = Vec::new();
    for (number, contact) in setting.contacts.iter().enumerate() {
        let [a, b] = contact.bodies;
        let forms = [a, b].map(|k| &setting.bodies[k].form);
        let found = match forms {
            [Form::Curve(c), Form::Curve(d)] => between_curves(state, number, contact, [c, d]),
            _ => {
                let sides = if a == b { vec![[a, b]] } else { vec![[a, b], [b, a]] };
                sides.into_iter().filter_map(|side| deepest(setting, state, number, side)).max_by(by_excess)
            }
        };
        out.extend(found.map(|deepest| told(setting, contact, &deepest)));
        out.extend(across(setting, state, number));
    }
    if out.is_empty() && !setting.contacts.is_empty() {
        out.push(Finding::new(Check::Gaps, Outcome::Fine, "no body penetrates another one").measured(0.0, 1.0));
    }
    out
}

/// Where a contact carries across a gap to a rigid body; none where it does not.
fn across(setting: &Setting, state: &State, number: usize) -> Option<Finding> {
    let contact = &setting.contacts[number];
    let [own, other] = contact.bodies;
    let Form::Rigid(rigid) = &setting.bodies[other].form else { return None };
    let cell = match &setting.bodies[own].form {
        Form::Solid(solid) => solid.largest_cell(),
        Form::Rigid(rigid) => samples::OF_RIGID * rigid.size,
        Form::Curve(curve) => curve.longest_cell(),
    };
    let motion = state.bodies[other].motion();
    let gap = |t: &Touch| {
        let jet = rigid.gap_now(&motion, &t.x);
        let sagitta = cell * cell * jet.hessian.norm().min(1.0 / cell.max(f64::MIN_POSITIVE)) / 2.0;
        (jet.gap, 2.0 * UNLIKE * sagitta + REFUSED * cell, t.x)
    };
    let carrying = state.contacts[number].iter().filter(|t| t.is_closed && t.pressure > 0.0);
    // What acts across gaps by its law is checked by its tractions.
    if contact.surfaces.range > 0.0 {
        return None;
    }
    let (gap, limit, x) = carrying.map(gap).max_by(|a, b| (a.0 / a.1).total_cmp(&(b.0 / b.1)))?;
    let outcome = if gap > limit { Outcome::Refused } else { return None };
    let message = format!("`{}` has a contact force across a gap of {gap:.3e}", contact.name);
    Some(Finding::new(Check::Gaps, outcome, message).measured(gap, limit).at(x).on(&contact.name))
}

/// The deepest place of a pair, by what explains it.
struct Deepest {
    x: Point<3>,
    depth: f64,
    cell: f64,
    told: f64,
    refused: f64,
    /// Whether forces act near by.
    carries: bool,
    /// Whether the surface reaches deeper than it moved against the whole of its body, so that no contact force did push it out.
    is_held: bool,
    bodies: [usize; 2],
}

fn by_excess(a: &Deepest, b: &Deepest) -> std::cmp::Ordering {
    (a.depth / a.refused).total_cmp(&(b.depth / b.refused)).then((a.depth / a.told).total_cmp(&(b.depth / b.told)))
}

/// How deep the points of one body reach into another.
fn deepest(setting: &Setting, state: &State, contact: usize, bodies: [usize; 2]) -> Option<Deepest> {
    let [own, other] = bodies;
    let in_space = setting.space == Space::ThreeD;
    let obstacle = Obstacle::new(&setting.bodies[other].form, &state.bodies[other], in_space)?;
    let rigid = matches!(obstacle, Obstacle::Rigid { .. });
    let form = &setting.bodies[own].form;
    let list =
        samples::of_body(form, &state.bodies[own], rigid, &|x| if own == other { 0.0 } else { obstacle.at_least(x) });
    let closed = Closed::new(state, contact);
    let wanted = setting.contacts[contact].wanted_penetration + given_way(setting, state, contact);
    let zone = extent_of(&closed.places);
    let largest = if let Form::Solid(solid) = form { solid.largest_cell() } else { 0.0 };
    let shift = shift_of(form, &state.bodies[own]).filter(|_| rigid);
    let judge_one = |s: &Sample| {
        let except = (own == other).then_some((s.rest, APART * largest));
        let found = obstacle.find(&s.x, s.radius, except)?;
        let depth = s.radius - found.gap;
        let moved = shift.map_or(f64::INFINITY, |shift| (s.x - s.rest - shift).norm());
        (depth > 0.0).then(|| judge(s, &found, (depth, wanted, moved), (&closed, zone), bodies))
    };
    // In order, so that of equal ones it is always the same that is told.
    let judged: Vec<Deepest> = list.par_iter().filter_map(judge_one).collect();
    judged.into_iter().max_by(by_excess)
}

/// How deep rough surfaces are pressed into each other by their pressure, and how much is worn off.
fn given_way(setting: &Setting, state: &State, contact: usize) -> f64 {
    let touches = || state.contacts.get(contact).into_iter().flatten();
    let pressed = setting.contacts[contact].surfaces.gap_at.as_ref().map_or(0.0, |gap_at| {
        let most = touches().map(|t| t.pressure).fold(0.0, f64::max);
        if most > 0.0 { (-gap_at(most)).max(0.0) } else { 0.0 }
    });
    pressed + touches().map(|t| t.worn).fold(0.0, f64::max)
}

/// Places of a contact that carry.
struct Closed {
    places: Vec<Point<3>>,
    tree: Bvh,
}

impl Closed {
    fn new(state: &State, contact: usize) -> Self {
        let touches = state.contacts.get(contact).map_or(&[][..], Vec::as_slice);
        let places: Vec<_> = touches.iter().filter(|t| t.is_closed).flat_map(|t| [t.x, t.foot]).collect();
        let tree = Bvh::new(&places.iter().map(|x| Aabb::new(*x, *x)).collect::<Vec<_>>());
        Closed { places, tree }
    }

    /// Whether one is within a distance.
    fn is_near(&self, x: &Point<3>, reach: f64) -> bool {
        let mut near = false;
        self.tree.nearest(x, reach * reach, |k| {
            near = near || (self.places[k] - x).norm() <= reach;
            // Nothing more is to be found then.
            if near { -1.0 } else { reach * reach }
        });
        near
    }
}

/// The largest extent of places along the axes.
fn extent_of(places: &[Point<3>]) -> f64 {
    Aabb::around(places.iter().copied()).map_or(0.0, |bounds| bounds.size().max())
}

fn judge(
    s: &Sample,
    found: &Found,
    (depth, wanted, moved): (f64, f64, f64),
    (closed, zone): (&Closed, f64),
    bodies: [usize; 2],
) -> Deepest {
    let (cell, part) = if found.cell > s.cell { (found.cell, found.cell) } else { (s.cell, s.part) };
    let sagitta = cell * cell * found.curvature.min(1.0 / cell.max(f64::MIN_POSITIVE)) / 8.0;
    let explained = UNLIKE * (wanted + sagitta + s.off + found.off);
    let reach = NEAR * cell + s.radius;
    let carries = closed.is_near(&s.x, reach);
    let (told, refused) = if carries {
        (explained + TOLD * cell, 2.0 * explained + (REFUSED * cell).max(OF_ZONE * zone))
    } else {
        (explained + NOWHERE * part, explained + NOWHERE * part)
    };
    let is_held = carries && depth > told.max(explained + moved);
    let refused = if is_held { told } else { refused };
    Deepest { x: s.x, depth, cell, told, refused, carries, is_held, bodies }
}

/// The mean displacement of a solid; none of another body.
fn shift_of(form: &Form, placement: &Placement) -> Option<Vector<3>> {
    let (Form::Solid(solid), Placement::Points(now)) = (form, placement) else { return None };
    (!now.is_empty()).then(|| mean(now) - mean(&solid.rest))
}

fn told(setting: &Setting, contact: &Contact, deepest: &Deepest) -> Finding {
    let [own, other] = deepest.bodies.map(|k| &setting.bodies[k].name);
    let Deepest { depth, cell, told, refused, carries, is_held, x, .. } = deepest;
    let (outcome, limit) = match (depth > refused, depth > told) {
        (true, _) => (Outcome::Refused, *refused),
        (_, true) => (Outcome::Doubt, *told),
        _ => (Outcome::Fine, *told),
    };
    let share = depth / cell.max(f64::MIN_POSITIVE);
    let what = format!("`{own}` penetrates `{other}` by {depth:.3e}, {share:.2e} of a cell");
    let (message, remedy) = match (outcome, carries) {
        (Outcome::Fine, _) => (what, None),
        (_, true) if *is_held => (
            format!("{what}, though contact forces act there: the surface does not give way"),
            Some("support it elsewhere than where it is touched, or use smaller cells"),
        ),
        (_, true) => {
            (format!("{what}, near contact forces"), Some("use smaller cells there, or another contact method"))
        }
        (_, false) => (
            format!("{what}, where no contact force acts"),
            Some("separate the bodies at the start, use more increments, and name the whole bodies in the contact"),
        ),
    };
    let finding = Finding::new(Check::Gaps, outcome, message).measured(*depth, limit).at(*x).on(&contact.name);
    Finding { remedy: remedy.map(str::to_string), ..finding }
}

/// How deep two curves, or parts of one, reach into each other, by their radii.
fn between_curves(state: &State, number: usize, contact: &Contact, [c, d]: [&Curve; 2]) -> Option<Deepest> {
    let radius = c.radius + d.radius;
    let [a, b] = contact.bodies;
    let points = [a, b].map(|k| state.bodies[k].points());
    let boxes = |curve: &Curve, x: &[Point<3>]| -> Vec<Aabb<3>> {
        curve
            .pieces
            .iter()
            .map(|p| {
                let [u, v] = p.map(|k| x[k as usize]);
                Aabb::new(u.inf(&v), u.sup(&v))
            })
            .collect()
    };
    let (own, other) = (boxes(c, points[0]), boxes(d, points[1]));
    let pairs = Bvh::new(&own).pairs_within(&Bvh::new(&other), (&own, &other), radius);
    let angles = [turns(c, points[0]), turns(d, points[1])];
    let closed = Closed::new(state, number);
    let count = c.pieces.len();
    let near = |i: usize, j: usize, length: f64| {
        let along = i.abs_diff(j).min(count - i.abs_diff(j)) as f64 * length;
        a == b && along < (std::f64::consts::PI * radius).max(APART * length)
    };
    let judged = pairs.into_iter().filter_map(|(i, j)| {
        let [p, q] = c.pieces[i].map(|k| points[0][k as usize]);
        let [r, s] = d.pieces[j].map(|k| points[1][k as usize]);
        let lengths = [(q - p).norm(), (s - r).norm()];
        if near(i, j, lengths[0].max(lengths[1])) {
            return None;
        }
        let [u, v] = of_segments([&p, &q], [&r, &s]);
        let x = p + (q - p) * u;
        let depth = radius - (x - (r + (s - r) * v)).norm();
        let angle = |k: usize, piece: &[u32; 2]| angles[k][piece[0] as usize].max(angles[k][piece[1] as usize]);
        let off = (lengths[0] * angle(0, &c.pieces[i]) + lengths[1] * angle(1, &d.pieces[j])) / 8.0;
        let explained = UNLIKE * (contact.wanted_penetration + off);
        let carries = closed.is_near(&x, radius + NEAR * lengths[0].max(lengths[1]) * c.parts);
        let (told, refused) = (explained + TOLD * radius, explained + REFUSED * radius);
        let refused = if carries { refused } else { told };
        (depth > 0.0).then_some(Deepest {
            x,
            depth,
            cell: radius,
            told,
            refused,
            carries,
            is_held: false,
            bodies: contact.bodies,
        })
    });
    judged.max_by(by_excess)
}

/// Checks the state at the start: what reaches into another body by half of its thickness finds no way out.
pub fn check_start(setting: &Setting, state: &State) -> Vec<Finding> {
    let mut out = Vec::new();
    for (number, contact) in setting.contacts.iter().enumerate() {
        let [a, b] = contact.bodies;
        if a == b {
            continue;
        }
        for side in [[a, b], [b, a]] {
            let thick = side.map(|k| thickness_of(&setting.bodies[k].form, &state.bodies[k], setting.space));
            let Some(found) = deepest(setting, state, number, side) else { continue };
            let limit = 0.5 * thick[0].min(thick[1]);
            if found.depth > limit {
                let [own, other] = side.map(|k| &setting.bodies[k].name);
                let message = format!("`{own}` starts {:.4e} deep inside `{other}`", found.depth);
                let finding = Finding::new(Check::Gaps, Outcome::Refused, message).measured(found.depth, limit);
                let remedy = "separate the bodies at the start, and check the direction of plane normals and the \
                              `side` of holes";
                out.push(finding.at(found.x).on(&contact.name).remedy(remedy));
            }
        }
    }
    out
}

fn thickness_of(form: &Form, placement: &Placement, space: Space) -> f64 {
    let directions: &[usize] = if space == Space::ThreeD { &[0, 1, 2] } else { &[0, 1] };
    match form {
        Form::Solid(_) => thickness(placement.points(), directions),
        Form::Rigid(rigid) if rigid.size > 0.0 => rigid.size,
        Form::Rigid(_) | Form::Curve(_) => f64::INFINITY,
    }
}
