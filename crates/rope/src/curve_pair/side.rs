//! On which side of each other curves are.
//!
//! Of two ropes the side is that of the last state. An edge of a solid has an inside, the wedge behind both of its faces:
//! what is in there has come in over the edge, by a negative distance, if it is not deeper than half a cell; and an edge
//! without a rounding that crosses another one, at any distance and at none, is on that side of it to which the faces of
//! both look.

use super::search::{CurvePoint, Searched};
use signorini_geometry::Vector;
use signorini_mechanics::body::Foot;

/// Part of a normal by which it may leave the cone between the normals of two faces: rounding.
const ROUNDING: f64 = 1e-9;

/// Which way the normal is to point, if anything tells.
pub(super) enum Side {
    /// Along the connection of both points.
    Nearest,
    /// Into the half space of this vector.
    Facing(Vector<3>),
    /// No contact of these two: on another side of the body, or of its faces.
    None,
}

/// The side of two points of curves from the inside of edges, or else from the normal of the same contact before.
pub(super) fn side(
    sides: &[Searched<'_>; 2],
    points: &[CurvePoint; 2],
    feet: [&Foot; 2],
    before: Option<Vector<3>>,
) -> Side {
    let faces = [0, 1].map(|s| sides[s].curve.faces(sides[s].configuration, points[s].element, points[s].xi));
    if faces.iter().all(Option::is_none) {
        return before.map_or(Side::Nearest, Side::Facing);
    }
    let d = feet[0].jet.x - feet[1].jet.x;
    // From each curve to the other.
    let towards = [-d, d];
    let depth = (0..2).map(|s| sides[s].curve.depth(points[s].element)).fold(f64::INFINITY, f64::min);
    if feet[0].radius + feet[1].radius > 0.0 {
        let is_behind = |s: usize| faces[s].is_none_or(|list| list.iter().all(|n| n.dot(&towards[s]) < 0.0));
        return match (0..2).all(is_behind) {
            false => Side::Facing(d),
            true if d.norm() <= depth => Side::Facing(-d),
            true => Side::None,
        };
    }
    // Two sharp edges, which touch where they cross.
    let [Some(own), Some(other)] = faces else { return Side::Nearest };
    let Some(normal) = feet[0].jet.u.cross(&feet[1].jet.u).try_normalize(0.0) else { return Side::None };
    let facing = other[0] + other[1] - own[0] - own[1];
    let normal = if normal.dot(&facing) < 0.0 { -normal } else { normal };
    let is_between = in_cone(&normal, &other) && in_cone(&-normal, &own);
    if is_between && d.dot(&normal) >= -depth { Side::Facing(normal) } else { Side::None }
}

/// Whether a normal of an edge is between those of its faces.
pub fn in_cone(n: &Vector<3>, [a, b]: &[Vector<3>; 2]) -> bool {
    let (ab, na, nb) = (a.dot(b), n.dot(a), n.dot(b));
    na - ab * nb >= -ROUNDING && nb - ab * na >= -ROUNDING
}
