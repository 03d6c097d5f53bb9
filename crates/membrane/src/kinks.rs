//! Kinks of a body within the contact zone. There the membrane would have to have one too: the body pushes along a ridge
//! with a line force, and along a valley it would have to pull.

use crate::obstacle::Side;
use crate::problem::Membrane;
use crate::zone::{Zone, contact_of};
use signorini_geometry::{Point, Vector};

/// A change of slope counts as a kink beyond so many times what the curvature explains ...
const UNEXPLAINED: f64 = 4.0;
/// ... and beyond this fraction of the slope.
const NOTABLE: f64 = 0.02;
/// Part of the distance to the nearest front that is surely within the contact.
const WITHIN: f64 = 0.9;
/// Halvings of the way across a kink that find its place.
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
        if !bends(membrane, side, x, &way) {
            return None;
        }
        let way = way.map(|y| if touches(zone, side, &y) { y } else { x + (y - x) * clear(zone, x, &y) });
        bends(membrane, side, x, &way).then(|| {
            let [low, high] = way.map(|y| slope(membrane, side, &y));
            let jump = high - low;
            let held = if adhering { 2.0 * membrane.adhesive_slope(side, x).0 } else { 0.0 };
            let push = -side.sign() * jump[axis];
            let push = if push < 0.0 { (push + held).min(0.0) } else { push };
            let pressure = membrane.tension.value(x) * push / (way[1] - way[0]).norm();
            Kink { place: sharpest(membrane, side, way), jump: jump.norm(), pressure }
        })
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

fn slope<const D: usize>(membrane: &Membrane<D>, side: Side, x: &Point<D>) -> Vector<D> {
    membrane.obstacles.jet(side, x).gradient
}

/// Whether the slope changes on a way through a point by more than the curvature explains.
fn bends<const D: usize>(membrane: &Membrane<D>, side: Side, x: &Point<D>, way: &[Point<D>; 2]) -> bool {
    let [low, high] = [&way[0], &way[1]].map(|y| membrane.obstacles.jet(side, y));
    let change = (high.gradient - low.gradient).norm();
    let explained = UNEXPLAINED * (way[1] - way[0]).norm();
    change > NOTABLE * low.gradient.norm().max(high.gradient.norm())
        && change > explained * low.hessian.norm().max(high.hessian.norm())
        // Nearly always it is smooth, and known to be so without this.
        && change > explained * membrane.obstacles.jet(side, x).hessian.norm()
}

/// Where on a way the slope changes most.
fn sharpest<const D: usize>(membrane: &Membrane<D>, side: Side, way: [Point<D>; 2]) -> Point<D> {
    let [mut low, mut high] = way.map(|y| (y, slope(membrane, side, &y)));
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low.0 + high.0);
        let there = slope(membrane, side, &middle);
        if (there - low.1).norm() > (high.1 - there).norm() {
            high = (middle, there);
        } else {
            low = (middle, there);
        }
    }
    0.5 * (low.0 + high.0)
}

fn touches<const D: usize, Z: Zone<D>>(zone: &Z, side: Side, x: &Point<D>) -> bool {
    contact_of(zone.region_at(x)).is_some_and(|c| c.0 == side)
}

/// The part of a way from a point of contact that is surely within it.
fn clear<const D: usize, Z: Zone<D>>(zone: &Z, x: &Point<D>, end: &Point<D>) -> f64 {
    (WITHIN * zone.distance(x) / (end - x).norm()).min(1.0)
}
