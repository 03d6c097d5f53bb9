//! A site of a contact as it was found in a state.

use signorini_contact::Status;
use signorini_geometry::{Point, Vector};

/// A site as it was found.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SiteResult {
    /// Where the site is, and the outward normal of the master there.
    pub x: Point<3>,
    pub normal: Vector<3>,
    /// Of the ball or the section about it: it touches so far from `x`, against the normal.
    pub radius: f64,
    pub weight: f64,
    /// None where nothing is within reach.
    pub gap: Option<f64>,
    pub pressure: f64,
    /// Friction on the slave, per weight.
    pub friction: Vector<3>,
    /// The part of it that acts on the centre line of a section that does not turn by itself, as that of a rope: a centre line
    /// at the distance `r` of a surface of radius `R` is longer than its way on the surface, and friction on it smaller by
    /// `R/(R + r)`.
    pub on_centre_line: Option<Vector<3>>,
    pub status: Status,
    /// Slip in the last increment and in all.
    pub increment: Vector<3>,
    pub slip: f64,
    /// The part of the available friction that is used: 1 where it slips.
    pub utilisation: f64,
    /// Depth that was worn off since the start.
    pub worn: f64,
    /// Of a node of a surface that carries, where its own values are means.
    pub of_surface: Option<OfSurface>,
}

/// Slip of an increment that is rounding: relative to the largest of the contact, and to the size of the bodies.
const RESTS: f64 = 1e-8;
const ROUNDING: f64 = 1e-12;

/// Sites at the limit of their friction that did not slip in the increment stick.
pub(crate) fn with_rest(mut sites: Vec<SiteResult>, size: f64) -> Vec<SiteResult> {
    let slips = |s: &SiteResult| s.status == Status::Slip;
    let most = sites.iter().filter(|s| slips(s)).map(|s| s.increment.norm()).fold(0.0, f64::max);
    let rests = (RESTS * most).max(ROUNDING * size);
    sites.iter_mut().filter(|s| slips(s) && s.increment.norm() <= rests).for_each(|s| s.status = Status::Stick);
    sites
}

/// What a surface tells of the place of a node.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OfSurface {
    /// The recovered pressure, and friction with it: as large a part of what is available as that of the multipliers.
    pub pressure: f64,
    pub friction: Vector<3>,
    /// The part of the area in contact that counts for the node: zones end within faces.
    pub area: f64,
    /// The number of its connected zone of contact.
    pub zone: usize,
}

impl SiteResult {
    /// Where the slave touches.
    pub fn touches_at(&self) -> Point<3> {
        self.x - self.normal * self.radius
    }

    /// Where its force acts.
    pub fn acts_at(&self) -> Point<3> {
        if self.on_centre_line.is_some() { self.x } else { self.touches_at() }
    }

    /// Friction on the slave as its equilibrium has it, per weight.
    pub fn acting_friction(&self) -> Vector<3> {
        self.on_centre_line.unwrap_or(self.friction)
    }

    /// The force on the slave.
    pub fn force(&self) -> Vector<3> {
        (self.normal * self.pressure + self.acting_friction()) * self.weight
    }

    /// Energy that its friction took in the last increment.
    pub fn dissipated(&self) -> f64 {
        if self.status == Status::Open { 0.0 } else { -self.weight * self.friction.dot(&self.increment) }
    }

    /// The pressure there.
    pub fn shown_pressure(&self) -> f64 {
        self.of_surface.map_or(self.pressure, |own| own.pressure)
    }

    /// The friction there.
    pub fn shown_friction(&self) -> Vector<3> {
        self.of_surface.map_or(self.friction, |own| own.friction)
    }

    /// The area in contact that it stands for; the length or number where sites stand for those.
    pub fn contact_area(&self) -> f64 {
        match (self.status, self.of_surface) {
            (Status::Open, _) => 0.0,
            (_, Some(own)) => own.area,
            (_, None) => self.weight,
        }
    }
}
