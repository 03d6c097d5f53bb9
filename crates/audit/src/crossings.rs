//! Whether ropes and beams went through each other within an increment.
//!
//! Two straight pieces that move steadily meet where their four ends come into one plane, between their ends. Each meeting has a
//! sign, that of the side to which one goes over. The sum of the signs is what the linking of two lines changed by, whatever
//! other ways they took: if it is not zero they went through each other. Over an end nothing is counted.

use crate::finding::{Check, Finding, Outcome};
use crate::state::{Form, Setting, State};
use signorini_geometry::{Aabb, Point, Vector};

/// Places on the way between which the side is compared: pieces turn little in an increment.
const STEPS: usize = 16;
const HALVINGS: usize = 60;
/// Distance of lines, relative to the size of the pieces, that is rounding: lines without sections touch.
const TOUCHING: f64 = 1e-9;

/// A piece before and after the increment.
type Moving = [[Point<3>; 2]; 2];

/// Checks the way from one state to the next.
pub fn check(setting: &Setting, before: &State, now: &State) -> Vec<Finding> {
    let mut out = Vec::new();
    for contact in &setting.contacts {
        let [a, b] = contact.bodies;
        let [Form::Curve(one), Form::Curve(other)] = [a, b].map(|k| &setting.bodies[k].form) else { continue };
        if a == b {
            continue;
        }
        let moving = |body: usize, pieces: &[[u32; 2]]| -> Vec<(Moving, Aabb<3>)> {
            let places = [before, now].map(|s| s.bodies[body].points());
            let of = |piece: &[u32; 2]| {
                let moving = places.map(|x| piece.map(|k| x[k as usize]));
                (moving, Aabb::around(moving.into_iter().flatten()).expect("a piece has ends"))
            };
            pieces.iter().map(of).collect()
        };
        let [ones, others] = [moving(a, &one.pieces), moving(b, &other.pieces)];
        let met: Vec<(Point<3>, i32)> = (ones.iter())
            .flat_map(|p| others.iter().filter(|q| !p.1.is_apart(&q.1)).flat_map(|q| meetings(&p.0, &q.0)))
            .collect();
        if met.iter().map(|m| m.1).sum::<i32>() != 0 {
            let [one, other] = [a, b].map(|k| &setting.bodies[k].name);
            let message = format!("`{one}` passed through `{other}` within the increment");
            let finding = Finding::new(Check::Gaps, Outcome::Refused, message);
            out.push(finding.at(met[0].0).on(&contact.name).remedy("use more increments"));
        }
    }
    out
}

/// Where two pieces meet on their ways, and to which side they go over.
fn meetings(p: &Moving, q: &Moving) -> Vec<(Point<3>, i32)> {
    let at = |piece: &Moving, t: f64| [0, 1].map(|k| piece[0][k] + (piece[1][k] - piece[0][k]) * t);
    // The distance of the lines along their common normal, times its length.
    let side = |t: f64| {
        let ([a, b], [c, d]) = (at(p, t), at(q, t));
        (c - a).dot(&(b - a).cross(&(d - c)))
    };
    let share = |k: usize| k as f64 / STEPS as f64;
    let scale = |t: f64| {
        let ([a, b], [c, d]) = (at(p, t), at(q, t));
        let (u, v) = (b - a, d - c);
        TOUCHING * u.norm().max(v.norm()) * u.cross(&v).norm()
    };
    let mut out = Vec::new();
    // The last place at which they were clearly apart.
    let mut from = (0.0, 0.0);
    for t in (0..=STEPS).map(share) {
        let now = side(t);
        if now.abs() <= scale(t) {
            continue;
        }
        if from.1 * now < 0.0 {
            let (mut low, mut high) = (from.0, t);
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                if side(middle) * now > 0.0 { high = middle } else { low = middle }
            }
            if let Some(x) = common(at(p, high), at(q, high)) {
                out.push((x, if now > 0.0 { 1 } else { -1 }));
            }
        }
        from = (t, now);
    }
    out
}

/// The common point of two segments in one plane, each without its second end.
fn common([a, b]: [Point<3>; 2], [c, d]: [Point<3>; 2]) -> Option<Point<3>> {
    let (u, v, w): (Vector<3>, Vector<3>, Vector<3>) = (b - a, d - c, c - a);
    let n = u.cross(&v);
    let square = n.norm_squared();
    if square == 0.0 {
        return None;
    }
    let (s, t) = (w.cross(&v).dot(&n) / square, w.cross(&u).dot(&n) / square);
    ((0.0..1.0).contains(&s) && (0.0..1.0).contains(&t)).then(|| a + u * s)
}
