//! Closest points of shapes whose coordinates are so large or so small that their products leave the range of doubles.

use super::query::Query;
use super::result::{ClosestPair, Projection};
use crate::scale::unit_for;
use crate::shape::Shape;
use crate::similarity::Similarity;

/// The answer by way of both shapes at a scale near one, where `near_one` finds it: the same digits, since the unit is a power of two. `None` where
/// the coordinates are near one, and for the shapes that see to their scale themselves.
pub fn closest(
    a: &Shape,
    b: &Shape,
    query: &Query,
    near_one: impl Fn(&Shape, &Shape, &Query) -> Projection,
) -> Option<Projection> {
    let unit = unit_of(a, b);
    let own = |p: &Shape, m: &Shape| matches!((p, m), (Shape::Point(_), Shape::Mesh(_)) if !query.local_minima);
    if unit == 1.0 || own(a, b) || own(b, a) {
        return None;
    }
    let scaling = Similarity::scaling(unit);
    let mut found = near_one(&scaling.shape(a)?, &scaling.shape(b)?, query);
    let back = 1.0 / unit;
    let lengths = [a, b].map(length_parameters);
    let scaled = |pair: &ClosestPair| ClosestPair {
        distance: pair.distance * back,
        a: pair.a.scaled(back, lengths[0]),
        b: pair.b.scaled(back, lengths[1]),
        ..*pair
    };
    found.closest = scaled(&found.closest);
    found.others.iter_mut().for_each(|pair| *pair = scaled(pair));
    found.certified_to *= back;
    found.margin *= back;
    Some(found)
}

/// The power of two that brings both shapes near one; one where they need none.
pub fn unit_of(a: &Shape, b: &Shape) -> f64 {
    unit_for(magnitude(a).max(magnitude(b)))
}

fn magnitude(shape: &Shape) -> f64 {
    match shape {
        Shape::Point(p) => p.amax(),
        Shape::Curve(c) => c.atlas.magnitude,
        Shape::Surface(s) => s.atlas.magnitude,
        Shape::Mesh(m) => m.magnitude(),
        Shape::Implicit(s) => s.mesh().magnitude(),
        Shape::Solid(s) => s.hull().min.amax().max(s.hull().max.amax()),
    }
}

fn length_parameters(shape: &Shape) -> [bool; 2] {
    if let Shape::Surface(s) = shape { s.kind.length_parameters() } else { [false; 2] }
}
