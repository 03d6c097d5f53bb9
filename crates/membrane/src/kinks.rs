//! Kinks of a body within the contact zone. There the membrane would have to have one too: the body pushes along a ridge
//! with a line force, and along a valley it would have to pull.

use crate::obstacle::Side;
use crate::problem::Membrane;
use crate::zone::{Zone, contact_of};
use signorini_geometry::{Jet, Point, Vector};

/// A kink is suspected where the slope changes by more than this many times what the curvature explains ...
const SUSPECTED: f64 = 1.1;
/// ... and is one where it still does so many times ...
const UNEXPLAINED: f64 = 4.0;
/// ... on a way so often halved, ...
const NARROWED: usize = 10;
/// ... and by more than this fraction of itself.
const NOTABLE: f64 = 0.02;
/// Halvings of a way that find a front.
const HALVINGS: usize = 30;

/// Kinks about a point of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Kink<const D: usize> {
    /// Where the sharpest of them crosses one of the axes through the point.
    pub place: Point<D>,
    /// By how much the slope changes there.
    pub jump: f64,
    /// The line forces with which the body pushes, their mean over about a cell; negative where it pulls.
    pub pressure: f64,
}

/// The kinks within half a cell of size `h` about a point of contact, as far as the contact goes.
///
/// A membrane follows a valley of slope jump `J` where the pressure on both sides, over about a cell, outweighs its line
/// force `T J`; it bridges it otherwise. With adhesion it would peel off on both sides at once, for which
/// `J > 2 √(2γ/T)`: only what is beyond pulls.
pub fn kink<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    zone: &Z,
    side: Side,
    x: &Point<D>,
    h: f64,
    adhering: bool,
) -> Option<Kink<D>> {
    if membrane.obstacles.0.iter().all(|o| o.height.constant().is_some()) {
        return None;
    }
    let crossings = (0..D).filter_map(|axis| {
        let way = across(membrane, x, axis, h);
        sharpest(membrane, side, &way)?;
        let way = way.map(|y| within(zone, side, x, y));
        let (place, jump) = sharpest(membrane, side, &way)?;
        let held = if adhering { 2.0 * membrane.adhesive_slope(side, x).0 } else { 0.0 };
        let push = -side.sign() * jump[axis];
        let push = if push < 0.0 { (push + held).min(0.0) } else { push };
        let pressure = membrane.tension.value(x) * push / (way[1] - way[0]).norm();
        Some(Kink { place, jump: jump.norm(), pressure })
    });
    crossings.reduce(|a, b| {
        let sharper = if a.jump < b.jump { b } else { a };
        Kink { pressure: a.pressure + b.pressure, ..sharper }
    })
}

/// From half a cell before a point to half a cell after it.
fn across<const D: usize>(membrane: &Membrane<D>, x: &Point<D>, axis: usize, h: f64) -> [Point<D>; 2] {
    let bounds = membrane.grid.bounds();
    let mut half = Point::zeros();
    half[axis] = 0.5 * h;
    [bounds.clamp(&(x - half)), bounds.clamp(&(x + half))]
}

/// Where on a way there is a kink, and by how much the slope changes there.
fn sharpest<const D: usize>(membrane: &Membrane<D>, side: Side, way: &[Point<D>; 2]) -> Option<(Point<D>, Vector<D>)> {
    let at = |x: Point<D>| (x, membrane.obstacles.jet(side, &x));
    let change = |low: &(Point<D>, Jet<D>), high: &(Point<D>, Jet<D>)| (high.1.gradient - low.1.gradient).norm();
    let beyond = |low: &(Point<D>, Jet<D>), high: &(Point<D>, Jet<D>), times: f64| {
        let curvature = low.1.hessian.norm().max(high.1.hessian.norm());
        let slope = low.1.gradient.norm().max(high.1.gradient.norm());
        change(low, high) > (times * curvature * (high.0 - low.0).norm()).max(NOTABLE * slope)
    };
    let (mut low, mut high) = (at(way[0]), at(way[1]));
    // Nearly always it is smooth, and known to be so at once.
    if !beyond(&low, &high, SUSPECTED) {
        return None;
    }
    for _ in 0..NARROWED {
        let middle = at(0.5 * (low.0 + high.0));
        if change(&low, &middle) > change(&middle, &high) { high = middle } else { low = middle }
    }
    beyond(&low, &high, UNEXPLAINED).then(|| (0.5 * (low.0 + high.0), high.1.gradient - low.1.gradient))
}

fn touches<const D: usize, Z: Zone<D>>(zone: &Z, side: Side, x: &Point<D>) -> bool {
    contact_of(zone.region_at(x)).is_some_and(|c| c.0 == side)
}

/// How far one may go from a point of contact towards another point without leaving it.
fn within<const D: usize, Z: Zone<D>>(zone: &Z, side: Side, x: &Point<D>, end: Point<D>) -> Point<D> {
    if touches(zone, side, &end) {
        return end;
    }
    let (mut low, mut high) = (*x, end);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if touches(zone, side, &middle) { low = middle } else { high = middle }
    }
    low
}
