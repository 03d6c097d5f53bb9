//! Which bodies a path touches.
//!
//! A straight line that enters a body gets a touch there (touchdown). A touch whose length has become negative goes
//! (lift-off); Newton runs smoothly through zero. A touch that somewhere bends away from its body is divided by a straight
//! bridge; a bridge that has vanished is closed. Length and derivatives of the path are continuous through all of these.

use super::newton::{Chain, Line};
use super::route::{Body, Leg};
use super::touch::WrapPoint;
use crate::PathError;
use crate::darboux::Along;
use crate::geodesic::{GeodesicState, geodesic};
use signorini_geometry::{Point, Vector};

/// Places of a line at which a level function is looked at: its minima between them are followed by Newton.
const PLACES: usize = 16;
/// Depth relative to the length of a line from which on a body is in the way: above the error of a path.
const DEPTH: f64 = 1e-10;
/// Depth relative to the length of a leg from which on a path goes through a body: well above the error of a path.
pub(crate) const CROSSES: f64 = 1e-8;
/// Normal curvature times the length of a touch from which on it is divided.
const BENT_AWAY: f64 = 1e-9;

/// Where a line is deepest in a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Deepest {
    pub x: Point<3>,
    /// To first order; negative outside.
    pub depth: f64,
    /// Normal curvature along the line.
    k_n: f64,
}

/// The lowest minimum of the level function of a body inside a line.
pub(crate) fn deepest(body: &Body<'_>, line: &Line) -> Option<Deepest> {
    let (from, to) = (body.inside(&line.from), body.inside(&line.to));
    let way = to - from;
    let value = |t: f64| body.shape.level(&(from + way * t)).value;
    let places: [f64; PLACES + 1] = std::array::from_fn(|k| value(k as f64 / PLACES as f64));
    let mut found: Option<(f64, f64)> = None;
    for k in 1..PLACES {
        if places[k] > places[k - 1] || places[k] > places[k + 1] {
            continue;
        }
        let (mut low, mut high) = ((k - 1) as f64 / PLACES as f64, (k + 1) as f64 / PLACES as f64);
        let mut t = k as f64 / PLACES as f64;
        for _ in 0..30 {
            let level = body.shape.level(&(from + way * t));
            let slope = level.gradient.dot(&way);
            if slope > 0.0 {
                high = t
            } else {
                low = t
            }
            let bend = way.dot(&(level.hessian * way));
            let newton = t - slope / bend;
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            let done = (next - t).abs() < 1e-9;
            t = next;
            if done {
                break;
            }
        }
        let lowest = value(t);
        if found.is_none_or(|f| lowest < f.1) {
            found = Some((t, lowest));
        }
    }
    let (at, _) = found?;
    let x = from + way * at;
    let level = body.shape.level(&x);
    let length = level.gradient.norm();
    let e = way.normalize();
    let k_n = -e.dot(&(level.hessian * e)) / length;
    Some(Deepest { x: body.motion.point(&x), depth: -level.value / length, k_n })
}

/// A touch where a line is deepest in a body, as long as a circle of the same curvature would be touched.
pub(crate) fn touch_at(order: usize, body: &Body<'_>, line: &Line, deepest: &Deepest) -> Option<WrapPoint> {
    let e = line.direction();
    let most = 0.5 * line.length();
    let length = if deepest.k_n < 0.0 { 2.0 * (2.0 * deepest.depth.max(0.0) / -deepest.k_n).sqrt() } else { most };
    let length = length.min(most);
    WrapPoint::near(order, body, &(deepest.x - e * (0.5 * length)), &e, length).ok()
}

/// The touches with one more, where a line enters a body: the deepest of all.
pub(crate) fn touchdown(leg: &Leg, bodies: &[Body<'_>], chain: &Chain) -> Option<Vec<WrapPoint>> {
    let mut worst: Option<(f64, usize, WrapPoint)> = None;
    for k in 0..=chain.touches.len() {
        let line = chain.line(leg, k);
        let length = line.length();
        if length == 0.0 {
            continue;
        }
        let first = if k == 0 { 0 } else { chain.touches[k - 1].order };
        let last = chain.touches.get(k).map_or(leg.around.len(), |t| t.order + 1);
        for order in first..last {
            let body = &bodies[leg.around[order].body];
            let Some(found) = deepest(body, &line) else { continue };
            if found.depth > DEPTH * length && worst.as_ref().is_none_or(|w| found.depth > w.0) {
                let Some(touch) = touch_at(order, body, &line, &found) else { continue };
                worst = Some((found.depth, k, touch));
            }
        }
    }
    let (_, k, touch) = worst?;
    let mut touches = chain.touches.clone();
    touches.insert(k, pinned_start(leg, bodies, k, touches.len(), touch));
    Some(touches)
}

/// Where a path goes through a body of its leg, before or after its place in the order: the deepest place.
pub(crate) fn crossing(leg: &Leg, bodies: &[Body<'_>], chain: &Chain) -> Option<PathError> {
    let size = (leg.to.1 - leg.from.1).norm() + chain.touches.iter().map(|t| t.length).sum::<f64>();
    let mut worst: Option<(f64, usize, Point<3>)> = None;
    let mut meets = |body: usize, depth: f64, x: Point<3>| {
        if depth > CROSSES * size && worst.is_none_or(|w| depth > w.0) {
            worst = Some((depth, body, x));
        }
    };
    let lines = (0..=chain.touches.len()).map(|k| chain.line(leg, k)).filter(|line| line.length() > 0.0);
    for line in lines {
        for around in &leg.around {
            if let Some(found) = deepest(&bodies[around.body], &line) {
                meets(around.body, found.depth, found.x);
            }
        }
    }
    for touch in &chain.touches {
        let own = leg.around[touch.order].body;
        let Ok(way) = geodesic(bodies[own].shape, &touch.x, &touch.tau, touch.length) else { continue };
        for state in &way.states {
            let x = bodies[own].motion.point(&state.x);
            let others = leg.around.iter().filter(|other| other.body != own);
            others.for_each(|other| meets(other.body, -bodies[other.body].near_gap(&x), x));
        }
    }
    worst.map(|(depth, body, at)| PathError::Crosses { body, depth, at })
}

/// A first touch on the body on which the path starts begins there.
fn pinned_start(leg: &Leg, bodies: &[Body<'_>], k: usize, count: usize, touch: WrapPoint) -> WrapPoint {
    if k == 0 && leg.pinned[0] == Some(touch.order) {
        let body = &bodies[leg.around[touch.order].body];
        let way = leg.to.1 - leg.from.1;
        let length = if count == 0 && leg.pinned[1] == Some(touch.order) { way.norm() } else { touch.length };
        return WrapPoint::near(touch.order, body, &leg.from.1, &body.motion.vector(&touch.tau), length)
            .unwrap_or(touch);
    }
    touch
}

/// The touches without the one of most negative length.
pub(crate) fn lift_off(chain: &Chain) -> Option<Vec<WrapPoint>> {
    let shortest =
        (0..chain.touches.len()).min_by(|&i, &j| chain.touches[i].length.total_cmp(&chain.touches[j].length))?;
    (chain.touches[shortest].length < 0.0).then(|| {
        let mut touches = chain.touches.clone();
        touches.remove(shortest);
        touches
    })
}

/// The touches with two of the same body made one, where the bridge between them runs backwards.
pub(crate) fn close_bridge(leg: &Leg, chain: &Chain) -> Option<Vec<WrapPoint>> {
    let same = |k: usize| chain.touches[k].order == chain.touches[k + 1].order;
    let k = (0..chain.touches.len().saturating_sub(1)).find(|&k| {
        let line = chain.line(leg, k + 1);
        same(k) && (line.to - line.from).dot(&chain.shots[k].q.tau) <= 0.0
    })?;
    let bridge = chain.line(leg, k + 1).length();
    let mut touches = chain.touches.clone();
    let second = touches.remove(k + 1);
    touches[k].length += second.length - bridge;
    Some(touches)
}

/// The touches with one divided by a straight bridge over the part that bends away from its body.
pub(crate) fn open_bridge(leg: &Leg, bodies: &[Body<'_>], chain: &Chain) -> Option<Vec<WrapPoint>> {
    let k = (0..chain.touches.len())
        .find(|&k| chain.shots[k].largest * chain.touches[k].length > BENT_AWAY && chain.touches[k].length > 0.0)?;
    let touch = chain.touches[k];
    let shape = bodies[leg.around[touch.order].body].shape;
    let way = geodesic(shape, &touch.x, &touch.tau, touch.length).ok()?;
    let curvature = |s: &GeodesicState| Along::new(&shape.level(&s.x), &s.tau).k_n;
    let positive: Vec<usize> = (0..way.states.len()).filter(|&i| curvature(&way.states[i]) > 0.0).collect();
    let (&first, _) = positive.split_first()?;
    // The first run of them.
    let last = positive.windows(2).find(|w| w[1] > w[0] + 1).map_or(*positive.last()?, |w| w[0]);
    let mut touches = chain.touches.clone();
    touches.remove(k);
    let mut parts = Vec::new();
    if first > 0 {
        parts.push(WrapPoint::new(touch.order, touch.x, touch.tau, way.states[first - 1].s));
    }
    if last + 1 < way.states.len() {
        let from = way.states[last + 1];
        parts.push(WrapPoint::new(touch.order, from.x, from.tau, touch.length - from.s));
    }
    touches.splice(k..k, parts);
    Some(touches)
}

/// The direction near another one in which a geodesic from a point comes by again, and the length of that turn. Where there
/// is none close by, the one given and the turn of a circle of its curvature.
pub(crate) fn turn(body: &Body<'_>, x: &Point<3>, tau: &Vector<3>) -> Option<(Vector<3>, f64)> {
    const ITERATIONS: usize = 8;
    let level = body.shape.level(x);
    let circle = |tau: &Vector<3>| std::f64::consts::TAU / Along::new(&level, tau).k_n.abs();
    let (mut direction, mut length) = (*tau, circle(tau));
    for _ in 0..ITERATIONS {
        let longest = 2.0 * circle(&direction);
        if !longest.is_finite() {
            break;
        }
        let way = geodesic(body.shape, x, &direction, longest).ok()?;
        let ahead = |s: &GeodesicState| (s.x - x).dot(&direction);
        let Some(w) = way.states.windows(2).skip(1).find(|w| ahead(&w[0]) < 0.0 && ahead(&w[1]) >= 0.0) else { break };
        let share = ahead(&w[0]) / (ahead(&w[0]) - ahead(&w[1]));
        let between = |a: f64, b: f64| a + share * (b - a);
        length = between(w[0].s, w[1].s);
        // How far it passes at the side, and how a turn of the direction moves that.
        let g = Along::new(&level, &direction).g;
        let (aside, field) = (between((w[0].x - x).dot(&g), (w[1].x - x).dot(&g)), between(w[0].r[0], w[1].r[0]));
        if field.abs() < 0.1 * length || aside.abs() < 1e-3 * length {
            break;
        }
        let (sin, cos) = (-(aside / field).clamp(-0.5, 0.5)).sin_cos();
        direction = direction * cos + g * sin;
    }
    length.is_finite().then_some((direction, length))
}

/// Whether a chain is a path: no touch of negative length, all lines forward.
pub(crate) fn is_path(leg: &Leg, chain: &Chain) -> bool {
    chain.goes_forward(leg) && chain.touches.iter().all(|t| t.length >= 0.0)
}
