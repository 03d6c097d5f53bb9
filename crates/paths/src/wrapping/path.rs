//! A shortest path that has been found, and the derivatives of its length.
//!
//! `L = Σ|lines| + Σℓ` is stationary in all that is free, so that its derivatives need no other solution: with unit vectors
//! `e` along the lines, `∂L/∂A = -e_first`, `∂L/∂B = e_last`, by a shift of a body `Σ(e_in - e_out)`, by a turn of it about
//! `c` `Σ((x_P - c) × e_in - (x_Q - c) × e_out)`. The moment arm of a tension on a motion is `-∂L/∂q`.

use super::newton::{Chain, Line, pinned};
use super::route::{Anchor, Body, Leg, Route, Station};
use super::topology;
use crate::PathError;
use crate::darboux::{Along, Darboux};
use crate::geodesic::geodesic;
use signorini_geometry::{Point, Vector};

/// A piece of a path on a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// Number among the stations of the route.
    pub station: usize,
    pub body: usize,
    /// Where it meets the body and where it leaves it, in space.
    pub p: Point<3>,
    pub q: Point<3>,
    /// Unit tangents there.
    pub tau_p: Vector<3>,
    pub tau_q: Vector<3>,
    /// Length on the body.
    pub length: f64,
    /// Arc length of the whole path at `p`.
    pub s: f64,
    /// Whether the piece is a shortest one between its ends: no conjugate point lies on it.
    pub minimal: Minimal,
    /// Start in the coordinates of the body.
    pub(crate) x: Point<3>,
    pub(crate) tau: Vector<3>,
}

/// Whether a geodesic is a shortest path between its ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Minimal {
    Locally,
    /// It is longer than to a conjugate point: neighbours are shorter, and the path is held only by its ends.
    BeyondConjugatePoint,
}

/// What happened to a body since the path before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Event {
    pub station: usize,
    pub kind: EventKind,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EventKind {
    Touchdown,
    LiftOff,
}

/// A fixed point of the path and the directions of the path before and after it; zero where there is none.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Fixed {
    station: Option<usize>,
    anchor: Anchor,
    x: Point<3>,
    before: Vector<3>,
    after: Vector<3>,
}

/// A shortest path.
#[derive(Clone, Debug, PartialEq)]
pub struct WrappedPath {
    pub length: f64,
    /// In the order of the path.
    pub contacts: Vec<Contact>,
    /// Newton steps of this call, over all changes of bodies.
    pub iterations: usize,
    /// The largest residual, the sine of an angle.
    pub residual: f64,
    pub events: Vec<Event>,
    /// Stations of the bodies, touched or not, in the order in which the path goes along them: that of the route, unless a path
    /// in that order goes through a body.
    pub order: Vec<usize>,
    fixed: Vec<Fixed>,
}

/// Derivatives of the length by the motion of a body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyGradient {
    /// By a shift.
    pub shift: Vector<3>,
    /// By a turn about a point.
    pub turn: Vector<3>,
}

impl WrappedPath {
    pub(crate) fn new(route: &Route, legs: &[(Leg, Chain)]) -> Self {
        let mut path = WrappedPath {
            length: 0.0,
            contacts: Vec::new(),
            iterations: 0,
            residual: 0.0,
            events: Vec::new(),
            order: legs.iter().flat_map(|(leg, _)| leg.stations()).collect(),
            fixed: Vec::with_capacity(legs.len() + 1),
        };
        let none = Vector::<3>::zeros();
        let fixed = |station: Option<usize>, anchor: Anchor, x: Point<3>| Fixed {
            station,
            anchor,
            x,
            before: none,
            after: none,
        };
        path.fixed.push(fixed(None, route.start, legs[0].0.from.1));
        let mut vias = route.stations.iter().enumerate().filter_map(|(k, s)| match s {
            Station::Via(anchor) => Some((k, *anchor)),
            Station::Around { .. } => None,
        });
        for (leg, chain) in legs {
            let pins = pinned(leg, &chain.touches);
            let m = chain.touches.len();
            let direction = |k: usize| match (k, pins) {
                (0, [true, _]) => chain.shots[0].p.tau,
                (k, [_, true]) if k == m => chain.shots[m - 1].q.tau,
                _ => chain.line(leg, k).direction(),
            };
            for (k, (touch, shot)) in chain.touches.iter().zip(&chain.shots).enumerate() {
                path.length += if k == 0 && pins[0] { 0.0 } else { chain.line(leg, k).length() };
                let around = leg.around[touch.order];
                path.contacts.push(Contact {
                    station: around.station,
                    body: around.body,
                    p: shot.p.x,
                    q: shot.q.x,
                    tau_p: shot.p.tau,
                    tau_q: shot.q.tau,
                    length: touch.length,
                    s: path.length,
                    minimal: if shot.is_minimal { Minimal::Locally } else { Minimal::BeyondConjugatePoint },
                    x: touch.x,
                    tau: touch.tau,
                });
                path.length += touch.length;
            }
            path.length += if pins[1] { 0.0 } else { chain.line(leg, m).length() };
            path.residual = path.residual.max(chain.residual);
            if let Some(last) = path.fixed.last_mut() {
                last.after = direction(0);
            }
            let mut end = match vias.next() {
                Some((k, anchor)) => fixed(Some(k), anchor, leg.to.1),
                None => fixed(None, route.end, leg.to.1),
            };
            end.before = direction(m);
            path.fixed.push(end);
        }
        path
    }

    /// Where the path goes through a body, whether it is one of its stations or not: a place of the deepest, in space, and the
    /// depth to first order.
    ///
    /// # Errors
    /// A geodesic that cannot be followed, which the search has followed.
    pub fn crosses(&self, bodies: &[Body<'_>], number: usize) -> Result<Option<(Point<3>, f64)>, PathError> {
        let points = self.points(bodies, 24)?;
        let mut worst: Option<(Point<3>, f64)> = None;
        let mut meets = |x: Point<3>, depth: f64| {
            if depth > topology::CROSSES * self.length && worst.is_none_or(|w| depth > w.1) {
                worst = Some((x, depth));
            }
        };
        for pair in points.windows(2) {
            let [a, b] = [&pair[0], &pair[1]];
            if let (Some((on, _)), Some((same, _))) = (&a.contact, &b.contact)
                && on == same
            {
                // Chords of its own body lie in it.
                if *on != number {
                    meets(b.x, -bodies[number].near_gap(&b.x));
                }
            } else if (b.x - a.x).norm() > 0.0
                && let Some(found) = topology::deepest(&bodies[number], &Line { from: a.x, to: b.x })
            {
                meets(found.x, found.depth);
            }
        }
        Ok(worst)
    }

    /// `∂L/∂A` by the start and `∂L/∂B` by the end.
    pub fn end_gradients(&self) -> [Vector<3>; 2] {
        [-self.fixed[0].after, self.fixed[self.fixed.len() - 1].before]
    }

    /// `∂L` by the via points, with their stations.
    pub fn via_gradients(&self) -> Vec<(usize, Vector<3>)> {
        self.fixed.iter().filter_map(|f| f.station.map(|k| (k, f.before - f.after))).collect()
    }

    /// `∂L` by the motion of a body, with all that the path touches and is fastened to on it.
    pub fn body_gradient(&self, body: usize, about: &Point<3>) -> BodyGradient {
        let mut sum = BodyGradient { shift: Vector::<3>::zeros(), turn: Vector::<3>::zeros() };
        let mut add = |x: &Point<3>, force: Vector<3>| {
            sum.shift += force;
            sum.turn += (x - about).cross(&force);
        };
        // Along its contacts the lines go on along the tangents.
        for c in self.contacts.iter().filter(|c| c.body == body) {
            add(&c.p, c.tau_p);
            add(&c.q, -c.tau_q);
        }
        for f in self.fixed.iter().filter(|f| f.anchor.body == Some(body)) {
            add(&f.x, f.before - f.after);
        }
        sum
    }

    /// The moment arm of the path about an axis (a point and a unit vector) about which a body turns.
    pub fn moment_arm(&self, body: usize, point: &Point<3>, axis: &Vector<3>) -> f64 {
        -axis.dot(&self.body_gradient(body, point).turn)
    }

    /// The path as a line in space, with frames where it lies on bodies: on every contact `pieces` pieces of equal length
    /// at least one. Arc lengths are of the whole path.
    ///
    /// # Errors
    /// A geodesic that cannot be followed, which the search has followed.
    pub fn points(&self, bodies: &[Body<'_>], pieces: usize) -> Result<Vec<PathPoint>, PathError> {
        let mut out = Vec::new();
        let mut contacts = self.contacts.iter().peekable();
        let mut s = 0.0;
        for (k, f) in self.fixed.iter().enumerate() {
            if let Some(last) = out.last() {
                let PathPoint { x, .. } = last;
                s += (f.x - x).norm();
            }
            out.push(PathPoint { s, x: f.x, contact: None });
            // Contacts of the leg that starts here: those before the next via point.
            let until = self.fixed.get(k + 1).and_then(|next| next.station).unwrap_or(usize::MAX);
            if k + 1 == self.fixed.len() {
                break;
            }
            while let Some(contact) = contacts.next_if(|c| c.station < until) {
                let frames = contact.frames(bodies, pieces)?;
                out.extend(frames.into_iter().map(|(body, frame)| PathPoint {
                    s: frame.s,
                    x: frame.x,
                    contact: Some((body, frame)),
                }));
                s = contact.s + contact.length;
            }
        }
        Ok(out)
    }
}

/// A point of a path; where it lies on a body, which one, and the frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PathPoint {
    pub s: f64,
    pub x: Point<3>,
    pub contact: Option<(usize, Darboux)>,
}

impl Contact {
    /// Frames in space at equal distances along the contact.
    ///
    /// # Errors
    /// A geodesic that cannot be followed.
    pub fn frames(&self, bodies: &[Body<'_>], pieces: usize) -> Result<Vec<(usize, Darboux)>, PathError> {
        let body = &bodies[self.body];
        let mut out = Vec::with_capacity(pieces.max(1) + 1);
        let (mut x, mut tau) = (self.x, self.tau);
        let step = self.length / pieces.max(1) as f64;
        for k in 0..=pieces.max(1) {
            if k > 0 {
                let way = geodesic(body.shape, &x, &tau, step)?;
                (x, tau) = (way.end().x, way.end().tau);
            }
            let level = body.shape.level(&x);
            let along = Along::new(&level, &tau);
            let mut frame = Darboux::from_parts(self.s + step * k as f64, x, tau, &along, 0.0, level.value);
            let turned = |v: &Vector<3>| body.motion.vector(v);
            frame.x = body.motion.point(&x);
            (frame.tau, frame.g, frame.n) = (turned(&tau), turned(&along.g), turned(&along.n));
            frame.gap = level.value / level.gradient.norm();
            out.push((self.body, frame));
        }
        Ok(out)
    }
}
