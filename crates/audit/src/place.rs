//! A place where rigid bodies touch, and what its friction may be.

use crate::state::{Law, Setting, Space, Touch};
use signorini_geometry::Vector;

/// Part of the available friction that it may exceed, as in the check of tractions.
const BEYOND: f64 = 1e-3;

/// What friction at a place may be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Friction {
    None,
    /// At a place that slips it is known: per normal force.
    Known(Vector<3>),
    /// The same, as a force whatever the pressure.
    Given(Vector<3>),
    /// Within a circle per normal force.
    Cone(f64),
    /// Within a circle whatever the normal force.
    Disc(f64),
}

/// A place with the contact that it belongs to.
#[derive(Clone, Copy)]
pub struct Place<'a> {
    pub contact: usize,
    pub touch: &'a Touch,
    pub friction: Friction,
}

impl<'a> Place<'a> {
    pub fn new(setting: &Setting, contact: usize, touch: &'a Touch) -> Self {
        // Of a place that carries nothing it is not known how it will slip.
        let slips = touch.slips && touch.is_closed && touch.pressure > 0.0;
        let along = touch.friction / touch.pressure;
        let friction = match setting.contacts[contact].law {
            None => Friction::None,
            Some(Law::Limit(_)) if slips => Friction::Given(touch.friction * touch.weight),
            Some(Law::Limit(limit)) => Friction::Disc(limit * touch.weight),
            // A pressure that is rounding tells no direction.
            Some(law) if slips && along.norm() <= law.most(1.0) * (1.0 + BEYOND) => Friction::Known(along),
            // The axes of an ellipse are not told: the circle around it.
            Some(law) => Friction::Cone(law.most(1.0)),
        };
        Place { contact, touch, friction: if friction == Friction::Cone(0.0) { Friction::None } else { friction } }
    }

    /// The directions of the unknown forces on the first body: the normal one, then those of friction.
    pub fn directions(&self, space: Space) -> Vec<Vector<3>> {
        let n = self.touch.normal;
        let mut out = match self.friction {
            Friction::Known(along) => return vec![n + along],
            _ => vec![n],
        };
        if matches!(self.friction, Friction::Cone(_) | Friction::Disc(_)) {
            out.extend(tangents(space, &n));
        }
        out
    }
}

/// Unit vectors across a normal: one in the plane, two in space.
fn tangents(space: Space, n: &Vector<3>) -> Vec<Vector<3>> {
    if space != Space::ThreeD {
        return vec![Vector::<3>::new(-n[1], n[0], 0.0)];
    }
    let first = n.cross(&Vector::<3>::ith(n.iamin(), 1.0)).normalize();
    vec![first, n.cross(&first)]
}
