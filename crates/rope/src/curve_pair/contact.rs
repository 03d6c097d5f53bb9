//! Contact of curves, with friction or without: forces and tangent by penalty or augmented Lagrangian.
//!
//! Every contact, a minimum of the distance of both curves or a point of Gauss of the slave with the nearest point of the
//! master, has the force `N = min(0, λ + ε g)`, `λ = 0` for a penalty alone, times its share of the blend. Residual and
//! tangent are `c N δg` and `c (ε δg δgᵀ + N' Δδg) + N δg ⊗ dc`. As with the stresses of a thin beam, the geometric term takes
//! the force `N'` that the step before predicts, and none when a contact is new: where a first iterate penetrates deeply,
//! its force is far too large to turn with the gap. A contact that the step before predicts to be closed stays closed in the
//! next linear system even where the gap has opened a little, as gaps do that are not linear in the unknowns: the set of
//! closed contacts is that of the linear problem, and does not alternate. Forces that are told, and residuals that decide
//! about convergence ([`Order::First`]), are those of the law.

use super::blend::Blend;
use super::friction::{CurveFriction, Tangential, followed, tangential};
use super::measure::{CurvePair, Stuck, elastic_slip, measure};
use super::search::{Between, CurvePoint, Searched, crossings};
use signorini_contact::law::Status;
use signorini_geometry::Vector;
use signorini_mechanics::body::{Contribution, Met, Order, Sampling};

/// Which forces act.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// One force at each minimum of the distance.
    Point,
    /// Forces at points of Gauss of the slave.
    Line,
    /// Both, by the angle of the curves.
    Blend(Blend),
}

/// Whether ends make contacts of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    Touch,
    PassBy,
}

/// Which contact of a pair of curves.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Key {
    /// Point of Gauss.
    Site(usize),
    /// Positions along both curves: elements plus parameters.
    Places([f64; 2]),
}

/// What is kept of a contact from one iteration to the next.
#[derive(Clone, Copy, Debug)]
struct Kept {
    key: Key,
    predicted: f64,
    multiplier: f64,
    normal: Vector<3>,
    stuck: Option<Stuck>,
}

/// A contact as it is now.
pub struct Contact {
    key: Key,
    pub pair: CurvePair,
    /// Points of both curves.
    pub points: [CurvePoint; 2],
    /// Force per penetration.
    pub penalty: f64,
    /// Share of the blend, and its derivative in the squared cosine of the angle.
    pub share: (f64, f64),
    /// `λ + ε g`, at most zero.
    pub force: f64,
    /// The same without the bound.
    trial: f64,
    /// The force of the geometric term.
    geometric: f64,
}

/// Two curves that may touch, or one that may touch itself.
#[derive(Clone, Debug)]
pub struct CurveContact {
    pub form: Form,
    pub ends: Ends,
    pub between: Between,
    /// Force per penetration at a point.
    pub point_penalty: f64,
    /// Force per penetration and length along a line.
    pub line_penalty: f64,
    /// How far curves may pass through each other, or apart, in one iteration and still be followed.
    pub reach: f64,
    pub friction: Option<CurveFriction>,
    kept: Vec<Kept>,
}

/// How far along the curves, in elements, a minimum may have moved and still be the same.
const SAME: f64 = 1.0;

impl CurveContact {
    /// Contact without history.
    pub fn new(form: Form, between: Between, point_penalty: f64, line_penalty: f64) -> Self {
        CurveContact {
            form,
            ends: Ends::Touch,
            between,
            point_penalty,
            line_penalty,
            reach: 0.0,
            friction: None,
            kept: Vec::new(),
        }
    }

    fn kept(&self, key: Key) -> Option<&Kept> {
        let apart = |k: &Kept| match (k.key, key) {
            (Key::Site(i), Key::Site(j)) if i == j => 0.0,
            (Key::Places(u), Key::Places(v)) => (u[0] - v[0]).abs().max((u[1] - v[1]).abs()),
            _ => f64::INFINITY,
        };
        self.kept.iter().min_by(|p, q| apart(p).total_cmp(&apart(q))).filter(|k| apart(k) <= SAME)
    }

    fn contact(&self, key: Key, points: [CurvePoint; 2], pair: CurvePair, penalty: f64, share: (f64, f64)) -> Contact {
        let kept = self.kept(key);
        let multiplier = kept.map_or(0.0, |k| k.multiplier);
        let trial = multiplier + penalty * pair.gap;
        let geometric = kept.map_or(0.0, |k| k.predicted);
        Contact { key, pair, points, penalty, share, force: trial.min(0.0), trial, geometric }
    }

    /// All contacts of two curves within reach, slave first; `first` are their first unknowns.
    pub fn contacts(&self, sides: [Searched<'_>; 2], first: [u32; 2], order: Order) -> Vec<Contact> {
        let reach = self.reach;
        let mut out = Vec::new();
        if self.form != Form::Line || self.ends == Ends::Touch {
            for near in crossings(sides[0], sides[1], self.between, reach) {
                let is_crossing = near.points.iter().all(|p| p.coordinates == 1);
                if if is_crossing { self.form == Form::Line } else { self.ends == Ends::PassBy } {
                    continue;
                }
                let feet = [0, 1].map(|s| {
                    let CurvePoint { element, xi, coordinates } = near.points[s];
                    sides[s].body.foot(&sides[s].state.configuration, element, xi, coordinates)
                });
                let key = Key::Places(near.points.map(|p| p.element as f64 + p.xi));
                let facing = self.kept(key).map(|k| k.normal);
                let Ok(pair) = measure([&feet[0], &feet[1]], first, facing, order) else { continue };
                let share = match self.form {
                    Form::Blend(blend) if is_crossing => blend.point_share(pair.parallel),
                    _ => (1.0, 0.0),
                };
                if share.0 > 0.0 {
                    out.push(self.contact(key, near.points, pair, self.point_penalty, share));
                }
            }
        }
        if self.form == Form::Point {
            return out;
        }
        let sites = sides[0].body.sites(None, Sampling::GaussPoints).unwrap_or_default();
        let Ok(master) = sides[1].body.master(None, sides[1].state) else { return out };
        for (index, site) in sites.iter().enumerate() {
            let slave = sides[0].body.foot(&sides[0].state.configuration, site.patch as usize, site.xi[0], 0);
            let except = (self.between == Between::Itself).then_some(site);
            let Some(Met::Foot(foot)) = master.nearest(&slave.jet.x, reach + slave.radius, except) else { continue };
            // Beyond an end there is no curve to lie along.
            if foot.coordinates == 0 {
                continue;
            }
            let facing = self.kept(Key::Site(index)).map(|k| k.normal);
            let Ok(pair) = measure([&slave, &foot], first, facing, order) else { continue };
            let share = match self.form {
                Form::Blend(blend) => {
                    let (point, slope) = blend.point_share(pair.parallel);
                    (1.0 - point, -slope)
                }
                _ => (1.0, 0.0),
            };
            if share.0 > 0.0 {
                let at = |element: u32, xi: f64, coordinates: usize| CurvePoint {
                    element: element as usize,
                    xi,
                    coordinates,
                };
                let points = [at(site.patch, site.xi[0], 0), at(foot.point.patch, foot.point.xi[0], 1)];
                out.push(self.contact(Key::Site(index), points, pair, self.line_penalty * site.weight, share));
            }
        }
        out
    }

    /// Adds forces and tangent, in the numbers of the system.
    pub fn act(&self, sides: [Searched<'_>; 2], first: [u32; 2], order: Order, out: &mut Contribution) {
        for contact in self.contacts(sides, first, order) {
            contact.act(order, out);
            if let Some(t) = self.tangential(&contact, sides, first, order) {
                let share = contact.share;
                for (u, f) in t.unknowns.iter().zip(&t.forces) {
                    out.forces[*u as usize] += share.0 * f;
                }
                if order == Order::Second {
                    let m = t.unknowns.len();
                    let mut block: Vec<f64> = t.tangent.iter().map(|v| v * share.0).collect();
                    for (k, f) in t.forces.iter().enumerate() {
                        let d = &contact.pair.d_parallel;
                        (0..d.len()).for_each(|l| block[k * m + l] += f * share.1 * d[l]);
                    }
                    out.add_block(&t.unknowns, &block);
                }
            }
        }
    }

    /// Friction of a contact, if there is any: none before points have touched at the end of an increment.
    pub fn tangential(
        &self,
        contact: &Contact,
        sides: [Searched<'_>; 2],
        first: [u32; 2],
        order: Order,
    ) -> Option<Tangential> {
        let friction = self.friction.as_ref()?;
        let stuck = self.kept(contact.key)?.stuck?;
        if contact.force == 0.0 {
            return None;
        }
        let feet = [0, 1].map(|s| {
            let point = stuck.points[s];
            sides[s].body.foot(&sides[s].state.configuration, point.patch as usize, point.xi[0], 1)
        });
        let slip = elastic_slip(&stuck, [&feet[0], &feet[1]], first);
        let d_pressing: Vec<f64> = contact.pair.d_gap.iter().map(|d| -contact.penalty * d).collect();
        Some(tangential(&contact.pair, &slip, (-contact.force, &d_pressing), friction, order))
    }

    /// Ends an increment: points that touch are kept as those from which slip counts, and follow where they slip.
    pub fn settle(&mut self, sides: [Searched<'_>; 2], first: [u32; 2]) {
        let Some(friction) = self.friction.clone() else { return };
        let contacts = self.contacts(sides, first, Order::First);
        let kept = (contacts.iter())
            .map(|c| {
                let stuck = (c.force < 0.0).then(|| match self.tangential(c, sides, first, Order::First) {
                    None => c.pair.stuck,
                    Some(t) if t.status == Status::Slip => {
                        let CurvePoint { element, xi, .. } = c.points[1];
                        let master = sides[1].body.foot(&sides[1].state.configuration, element, xi, 1);
                        followed(&c.pair, &master, t.components, friction.penalty)
                    }
                    Some(_) => self.kept(c.key).and_then(|k| k.stuck).unwrap_or(c.pair.stuck),
                });
                Kept { stuck, ..self.kept(c.key).copied().unwrap_or(kept_of(c)) }
            })
            .zip(&contacts)
            .map(|(kept, c)| Kept { key: c.key, normal: c.pair.normal, ..kept })
            .collect();
        self.kept = kept;
    }

    /// Starts to follow the contacts of a state: from which side curves come.
    pub fn follow(&mut self, sides: [Searched<'_>; 2], first: [u32; 2]) {
        let step = vec![0.0; first[1] as usize + sides[1].body.unknowns()];
        self.predict(sides, first, &step);
    }

    /// Keeps what a step of all unknowns predicts, from the state before it.
    pub fn predict(&mut self, sides: [Searched<'_>; 2], first: [u32; 2], step: &[f64]) {
        let kept = (self.contacts(sides, first, Order::First).into_iter())
            .map(|c| {
                let multiplier = self.kept(c.key).map_or(0.0, |k| k.multiplier);
                let change: f64 = c.pair.unknowns.iter().zip(&c.pair.d_gap).map(|(u, d)| step[*u as usize] * d).sum();
                let predicted = (multiplier + c.penalty * (c.pair.gap + change)).min(0.0);
                // A new contact has no force that could turn.
                let is_new = c.force == 0.0 && c.geometric == 0.0;
                let predicted = if is_new { 0.0 } else { predicted };
                let stuck = self.kept(c.key).and_then(|k| k.stuck);
                Kept { key: c.key, predicted, multiplier, normal: c.pair.normal, stuck }
            })
            .collect();
        self.kept = kept;
    }

    /// Takes the forces found as multipliers (Uzawa); the largest penetration before.
    pub fn augment(&mut self, sides: [Searched<'_>; 2], first: [u32; 2]) -> f64 {
        let contacts = self.contacts(sides, first, Order::First);
        let deepest = contacts.iter().filter(|c| c.force < 0.0).fold(0.0f64, |m, c| m.max(c.pair.gap.abs()));
        let stuck = |c: &Contact| self.kept(c.key).and_then(|k| k.stuck);
        self.kept = contacts.iter().map(|c| Kept { stuck: stuck(c), ..kept_of(c) }).collect();
        deepest
    }
}

fn kept_of(c: &Contact) -> Kept {
    Kept { key: c.key, predicted: c.force, multiplier: c.force, normal: c.pair.normal, stuck: None }
}

impl Contact {
    /// Force on the slave along the normal, its share included.
    pub fn pressing(&self) -> f64 {
        -self.force * self.share.0
    }

    fn act(&self, order: Order, out: &mut Contribution) {
        let force = if order == Order::Second && self.geometric < 0.0 { self.trial } else { self.force };
        if force == 0.0 {
            return;
        }
        let (pair, (share, slope)) = (&self.pair, self.share);
        for (u, d) in pair.unknowns.iter().zip(&pair.d_gap) {
            out.forces[*u as usize] += share * force * d;
        }
        if order == Order::First {
            return;
        }
        let n = pair.unknowns.len();
        let mut block = vec![0.0; n * n];
        for k in 0..n {
            for l in 0..n {
                block[k * n + l] = share
                    * (self.penalty * pair.d_gap[k] * pair.d_gap[l] + self.geometric * pair.d2_gap[k * n + l])
                    + force * pair.d_gap[k] * slope * pair.d_parallel[l];
            }
        }
        out.add_block(&pair.unknowns, &block);
    }
}
