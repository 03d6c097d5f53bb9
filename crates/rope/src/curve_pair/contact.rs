//! Contact of two curves, or of a curve with itself: where they touch, and with which forces.
//!
//! Every contact, a minimum of the distance of both curves or a point of Gauss of the slave with a nearest point of the
//! master, has the force `N = min(0, λ + ε g)`, `λ = 0` for a penalty alone, times its share `c` of the blend. Residual and
//! tangent are `c N δg` and `c (ε δg δgᵀ + N' Δδg) + N δg ⊗ dc`, and those of friction under the pressure `-N`. As with the
//! stresses of a thin beam, the geometric term takes the force `N'` that the step before predicts, and none when a contact is
//! new: where a first iterate penetrates deeply, its force is far too large to turn with the gap. A contact that the step
//! before predicts to be closed stays closed in the next linear system even where the gap has opened a little, as gaps do
//! that are not linear in the unknowns: the set of closed contacts is that of the linear problem, and does not alternate.
//! Forces that are told, and residuals that decide about convergence ([`Order::First`]), are those of the law.
//!
//! Of a curve with itself both points of a line test each other, with half of the penalty each.

use super::blend::Blend;
use super::friction::{CurveFriction, Linearised, Tangential, tangential};
use super::history::{ContactHistory, ContactId, Kind, Predicted};
use super::measure::{CurvePair, NoPair, Wanted, elastic_slip, measure, parallel};
use super::search::{CurvePoint, SearchScope, Searched, crossings};
use super::side::{Side, side};
use crate::hermite::gauss;
use signorini_geometry::bvh::Bvh;
use signorini_mechanics::body::{Body, Foot, Order};
use signorini_mechanics::curve::{Closure, Curve, are_apart, boxes, minima};
use signorini_mechanics::{ContactLaw, Enforcement, Part};

/// Which forces act.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// One force at each minimum of the distance.
    Point,
    /// Forces at points of Gauss of the slave.
    Line,
    /// Both, by how far the distance is from a valley along the curves.
    Blend(Blend),
}

/// Whether ends make contacts of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    Touch,
    PassBy,
}

/// Force per penetration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Penalties {
    /// At a point.
    pub point: f64,
    /// Along a line: per length besides.
    pub line: f64,
}

/// Contact that cannot be.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum CurveContactError {
    #[error("`{place}` is not a curve: contact between curves is for ropes, beams and edges of solids")]
    NotACurve { place: String },
}

/// Two curves that may touch, or one that may touch itself.
pub struct CurveContact {
    pub name: String,
    /// Slave and master; twice the same for a curve with itself.
    pub parts: [Part; 2],
    pub form: Form,
    pub ends: Ends,
    /// With friction along the slave and around it.
    pub law: ContactLaw,
    /// Penalties that are stated; otherwise they come from the stiffness of the bodies.
    pub stated: Option<Penalties>,
    /// How far apart surfaces are looked at, and how far inside each other curves may be in an iterate and still be parted.
    pub reach: f64,
    pub(super) penalties: Penalties,
    pub(super) history: Vec<ContactHistory>,
}

/// A contact as it is now.
pub struct CurveContactPoint {
    pub key: ContactId,
    pub pair: CurvePair,
    /// Points of both curves.
    pub points: [CurvePoint; 2],
    /// Length that the contact stands for; 1 at a point.
    pub weight: f64,
    /// Force per penetration.
    pub penalty: f64,
    /// Share of the blend, and its derivative in `CurvePair::parallel`.
    pub share: (f64, f64),
    /// `λ + ε g`, at most zero.
    pub force: f64,
    /// The same without the bound.
    pub(super) trial: f64,
    /// What the step before predicts of it.
    pub(super) predicted: Option<Predicted>,
    pub(super) kept: Option<ContactHistory>,
}

/// Contacts that were found, and how many pairs have no coordinates.
pub type Touches = (Vec<CurveContactPoint>, usize);

/// A curve of the system.
fn curve<'a>(part: &Part, body: &'a dyn Body) -> Result<Box<dyn Curve + 'a>, CurveContactError> {
    let place = || match &part.group {
        Some(group) => format!("{}:{group}", body.name()),
        None => body.name().to_string(),
    };
    body.curve(part.group.as_deref()).ok_or_else(|| CurveContactError::NotACurve { place: place() })
}

/// Points of Gauss of an element at which the gap along it can vanish: that of cubic curves has two unknowns at each node.
/// With more of them, what is to keep the gap exactly, or nearly so, finds forces that have no end and do no work, or closes
/// and opens points in turns.
const SATISFIABLE: usize = 2;

/// Points of Gauss of each element that are tested: all that the curve asks for where gaps are given way to.
fn points(curve: &dyn Curve, enforcement: Enforcement) -> usize {
    match enforcement {
        Enforcement::Penalty { wanted_penetration: None } => curve.contact_points(),
        _ => curve.contact_points().min(SATISFIABLE),
    }
}

/// Distance of these points, in the mean.
fn spacing(curve: &dyn Curve, enforcement: Enforcement) -> f64 {
    curve.length() / (curve.elements() * points(curve, enforcement)) as f64
}

impl CurveContact {
    /// Contact of two curves, bodies or parts of them by their numbers in the system, by point and line forces as the angle asks; multipliers that
    /// come and go with contacts are those of an augmented Lagrangian. The slave is that whose points are tested.
    ///
    /// # Errors
    /// Places that are no curves.
    pub fn new(
        name: &str,
        slave: (impl Into<Part>, &dyn Body),
        master: (impl Into<Part>, &dyn Body),
        enforcement: Enforcement,
    ) -> Result<Self, CurveContactError> {
        let parts: [Part; 2] = [slave.0.into(), master.0.into()];
        let (slave_curve, master_curve) = (curve(&parts[0], slave.1)?, curve(&parts[1], master.1)?);
        let curves = [slave_curve.as_ref(), master_curve.as_ref()];
        let radii = curves.map(|c| c.radius());
        // Lines without a section touch where they cross, and nowhere else.
        let is_sharp = radii == [0.0; 2];
        let enforcement = match enforcement {
            Enforcement::Multiplier => Enforcement::AugmentedLagrangian,
            other => other,
        };
        // Iterates may be an element apart from what they come to.
        let element = |c: &dyn Curve| c.length() / c.elements() as f64;
        Ok(CurveContact {
            name: name.to_string(),
            parts,
            form: if is_sharp {
                Form::Point
            } else {
                Form::Blend(Blend::resolved(spacing(curves[0], enforcement), radii))
            },
            ends: if is_sharp { Ends::PassBy } else { Ends::Touch },
            law: ContactLaw::new(enforcement, Vec::new(), Vec::new()),
            stated: None,
            reach: radii[0] + radii[1] + element(curves[0]).max(element(curves[1])),
            penalties: Penalties { point: 1.0, line: 1.0 },
            history: Vec::new(),
        })
    }

    pub(super) fn between(&self) -> SearchScope {
        if self.parts[0] == self.parts[1] { SearchScope::Itself } else { SearchScope::Two }
    }

    /// Penalties from the stiffness of both bodies, of an element in the mean: clamped at its ends it is as much stiffer than
    /// a rod as the cube of their number, and a penalty that is stiffer still only hides the rod from Newton's method.
    pub(super) fn set_penalties(&mut self, curves: [&dyn Curve; 2]) {
        let mean = |k: usize| {
            let n = curves[k].elements();
            (0..n).map(|e| curves[k].stiffness(e)).sum::<f64>() / n as f64
        };
        // One after the other.
        let point = 1.0 / (1.0 / mean(0) + 1.0 / mean(1));
        self.penalties =
            self.stated.unwrap_or(Penalties { point, line: point / spacing(curves[0], self.law.enforcement) });
    }

    /// Whether a point is an end of its curve.
    fn is_end(curve: &dyn Curve, point: &CurvePoint) -> bool {
        let u = point.element as f64 + point.xi;
        point.coordinates == 0 && curve.closure() == Closure::Open && (u == 0.0 || u == curve.elements() as f64)
    }

    fn touch(
        &self,
        key: ContactId,
        points: [CurvePoint; 2],
        pair: CurvePair,
        (weight, penalty, share): (f64, f64, (f64, f64)),
        (kept, predicted): (Option<ContactHistory>, Option<&Predicted>),
    ) -> CurveContactPoint {
        let multiplier = match self.law.enforcement {
            Enforcement::Penalty { .. } => 0.0,
            _ => kept.map_or(0.0, |k| k.force),
        };
        let trial = multiplier + penalty * pair.gap;
        let predicted = predicted.copied();
        CurveContactPoint { key, pair, points, weight, penalty, share, force: trial.min(0.0), trial, predicted, kept }
    }

    /// All contacts of two curves within reach, slave first; `first` are their first unknowns.
    pub fn touches(
        &self,
        sides: [Searched<'_>; 2],
        first: [u32; 2],
        order: Order,
        prediction: &[Predicted],
    ) -> Touches {
        let rubs = self.law.friction.is_some();
        let mut out = Vec::new();
        let mut lost = 0;
        let mut add =
            |key: ContactId, feet: [&Foot; 2], points: [CurvePoint; 2], weight: f64, penalty: f64, blended: Blended| {
                let kept = key.of(&self.history, |k| k.key, &sides).copied();
                let before = kept.as_ref().or_else(|| key.near(&self.history, &sides)).map(|k| k.normal);
                let facing = match side(&sides, &points, feet, before) {
                    Side::None => return,
                    Side::Nearest => None,
                    Side::Facing(normal) => Some(normal),
                };
                let bends = [0, 1].map(|s| match (rubs, order) {
                    (true, Order::Second) => {
                        sides[s].curve.spin_bends(sides[s].configuration, points[s].element, points[s].xi)
                    }
                    _ => Vec::new(),
                });
                let wanted = if rubs { Wanted::GapAndSlip(bends.each_ref().map(Vec::as_slice)) } else { Wanted::Gap };
                match measure(feet, first, facing, (wanted, order)) {
                    Ok(pair) => {
                        let share = blended.share(pair.parallel);
                        let predicted = key.of(prediction, |p| p.key, &sides);
                        out.push(self.touch(key, points, pair, (weight, penalty, share), (kept, predicted)));
                    }
                    Err(error) => lost += usize::from(error == NoPair::NoCoordinates),
                }
            };
        let foot = |s: usize, p: &CurvePoint, coordinates: usize| {
            sides[s].curve.foot(sides[s].configuration, p.element, p.xi, coordinates)
        };
        if self.form != Form::Line || self.ends == Ends::Touch {
            for near in crossings(sides[0], sides[1], self.between(), self.reach) {
                let is_crossing = (0..2).all(|s| !Self::is_end(sides[s].curve, &near.points[s]));
                if if is_crossing { self.form == Form::Line } else { self.ends == Ends::PassBy } {
                    continue;
                }
                let feet = [0, 1].map(|s| foot(s, &near.points[s], near.points[s].coordinates));
                let blended = match self.form {
                    Form::Blend(blend) if is_crossing => Blended::Point(blend),
                    _ => Blended::Not,
                };
                if blended.share(parallel([&feet[0], &feet[1]])).0 > 0.0 {
                    let places = near.points.map(|p| p.element as f64 + p.xi);
                    let key = ContactId { kind: Kind::Crossing, places };
                    add(key, [&feet[0], &feet[1]], near.points, 1.0, self.penalties.point, blended);
                }
            }
        }
        if self.form == Form::Point {
            return (out, lost);
        }
        let blended = match self.form {
            Form::Blend(blend) => Blended::Line(blend),
            _ => Blended::Not,
        };
        let [slave, master] = sides;
        let boxes = boxes(master.curve, master.configuration);
        let tree = Bvh::new(&boxes);
        let reach = self.reach + slave.curve.radius() + master.curve.radius();
        let half = if self.between() == SearchScope::Itself { 0.5 } else { 1.0 };
        let rule = gauss(points(slave.curve, self.law.enforcement));
        for element in 0..slave.curve.elements() {
            let length = slave.curve.arc(element, 1.0) - slave.curve.arc(element, 0.0);
            for (number, (xi, share)) in rule.iter().enumerate() {
                let own = CurvePoint { element, xi: *xi, coordinates: 0 };
                let x = slave.curve.jet(slave.configuration, element, *xi).x;
                let mut near = Vec::new();
                tree.nearest(&x, reach * reach, |e| {
                    near.extend(minima(master.curve, master.configuration, e, &x));
                    reach * reach
                });
                near.sort_by(|p, q| (p.element as f64 + p.xi).total_cmp(&(q.element as f64 + q.xi)));
                for m in near {
                    let met = CurvePoint { element: m.element, xi: m.xi, coordinates: m.coordinates };
                    let arc = |c: &CurvePoint| slave.curve.arc(c.element, c.xi);
                    let is_next = self.between() == SearchScope::Itself
                        && !are_apart(slave.curve, arc(&own), arc(&met), m.distance);
                    // Beyond an end there is no curve to lie along.
                    if m.distance > reach || is_next || Self::is_end(master.curve, &met) {
                        continue;
                    }
                    let feet = [foot(0, &own, 0), foot(1, &met, met.coordinates)];
                    if blended.share(parallel([&feet[0], &feet[1]])).0 > 0.0 {
                        let kind = Kind::Site(element * rule.len() + number);
                        let places = [own, met].map(|p| p.element as f64 + p.xi);
                        let weight = share * length * half;
                        let penalty = self.penalties.line * weight;
                        add(ContactId { kind, places }, [&feet[0], &feet[1]], [own, met], weight, penalty, blended);
                    }
                }
            }
        }
        (out, lost)
    }

    /// Friction of a contact, if there is any: none where nothing was near at the last state, and none without a force.
    pub fn tangential(
        &self,
        touch: &CurveContactPoint,
        sides: [Searched<'_>; 2],
        first: [u32; 2],
        order: Order,
    ) -> Option<Tangential> {
        if touch.acting(order) == 0.0 { None } else { self.rubbing(touch, sides, first, order) }
    }

    /// The same where there may be no force.
    pub(super) fn rubbing(
        &self,
        touch: &CurveContactPoint,
        sides: [Searched<'_>; 2],
        first: [u32; 2],
        order: Order,
    ) -> Option<Tangential> {
        let law = self.law.friction.as_deref()?;
        let kept = touch.kept?;
        let stuck = kept.stuck?;
        let linearised = match (order, touch.predicted) {
            (Order::First, _) => Linearised::Here,
            (_, None) => Linearised::New,
            (_, Some(Predicted { force, trial, .. })) => Linearised::About([-force, trial[0], trial[1]]),
        };
        let feet = [0, 1].map(|s| {
            let point = stuck.points[s];
            sides[s].curve.foot(sides[s].configuration, point.patch as usize, point.xi[0], 1)
        });
        let slip = elastic_slip(&stuck, [&feet[0], &feet[1]], first);
        let d_pressing: Vec<f64> = touch.pair.d_gap.iter().map(|d| -touch.penalty * d).collect();
        let multiplier = match self.law.enforcement {
            Enforcement::Penalty { .. } => [0.0; 2],
            _ => kept.traction,
        };
        let duration = self.law.duration();
        let friction = CurveFriction { law, multiplier, penalty: touch.penalty, duration };
        Some(tangential(&touch.pair, &slip, (-touch.acting(order), &d_pressing), friction, linearised, order))
    }
}

/// How a force depends on the angle of the curves.
#[derive(Clone, Copy)]
enum Blended {
    Not,
    Point(Blend),
    Line(Blend),
}

impl Blended {
    /// Share and derivative for the squared cosine of the angle.
    fn share(self, parallel: f64) -> (f64, f64) {
        match self {
            Blended::Not => (1.0, 0.0),
            Blended::Point(blend) => blend.point_share(parallel),
            Blended::Line(blend) => {
                let (point, slope) = blend.point_share(parallel);
                (1.0 - point, -slope)
            }
        }
    }
}

impl CurveContactPoint {
    /// The force, and in a linear system that of a contact which is predicted to be closed.
    pub(super) fn acting(&self, order: Order) -> f64 {
        if order == Order::Second && self.predicted.is_some() { self.trial } else { self.force }
    }

    /// The force of the geometric term.
    pub(super) fn geometric(&self) -> f64 {
        self.predicted.map_or(0.0, |p| p.force)
    }

    /// Force on the slave along the normal, its share included.
    pub fn pressing(&self) -> f64 {
        -self.force * self.share.0
    }
}
