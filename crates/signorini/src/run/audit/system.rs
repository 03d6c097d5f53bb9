//! A system of bodies as plain data.

use super::forces::forces;
use super::{ROUNDING, STRAIN, extent, law_of, restored, saved, surface};
use crate::plan::mechanics::{Kind, MechanicsPlan};
use crate::plan::planner::Planner;
use crate::problem::units::LENGTH;
use crate::problem::{Body as Key, Enforcement, Method, Penalty, Space as Stated};
use crate::report::{StepReport, TractionKind};
use serde_json::Value;
use signorini_audit::{
    Body, Boundary, Carries, Check, Contact, Curve, Finding, ForceBounds, Form, Placement, Rigid, Setting, Solid,
    Space, Stability, State, Surfaces, Touch, audited, gaps,
};
use signorini_contact::{Law, Status};
use signorini_geometry::rigid::RigidMotion;
use signorini_geometry::{Aabb, Point, Vector};
use signorini_mechanics::{
    BodyFields, BodyState, Contribution, IncrementResult, Order, Sampling, SiteResult, SystemState, Unstable,
    rigid_body,
};
use std::sync::Arc;

/// Gap relative to the size of the bodies with which they do not touch.
const PARTED: f64 = 1e-9;

/// What the check of a system remembers from increment to increment.
#[derive(Default)]
pub struct SystemAudit {
    setting: Option<Setting>,
    before: Option<(State, SystemState)>,
    bounds: Vec<ForceBounds>,
}

impl SystemAudit {
    /// Checks the state at the start.
    pub fn start(&mut self, plan: &MechanicsPlan) -> Vec<Finding> {
        let mut start = plan.system.start();
        for (body, state) in plan.system.bodies.iter().zip(&mut start.bodies) {
            body.prescribe(0.0, state);
        }
        let setting = self.setting.get_or_insert_with(|| setting(plan));
        let state = State {
            bodies: placements(plan, setting, &start.bodies, &[]),
            stored: stored(plan, &start),
            ..State::default()
        };
        let found = gaps::check_start(setting, &state);
        let contacts = vec![Vec::new(); plan.system.contacts.len()];
        self.before = Some((State { contacts, ..state }, start));
        found
    }

    /// Checks the end of an increment.
    pub fn increment(
        &mut self,
        plan: &MechanicsPlan,
        (state, result): (&SystemState, &IncrementResult),
        (step, placed): (&StepReport, &[Vec<Point<3>>]),
    ) -> Vec<Finding> {
        let setting = self.setting.get_or_insert_with(|| setting(plan));
        // Coefficients of friction may change with time.
        for (told, contact) in setting.contacts.iter_mut().zip(&plan.system.contacts) {
            told.law = contact.friction().map(|law| law_of(law, &plan.head.problem, contact.name()));
        }
        let bodies = placements(plan, setting, &state.bodies, placed);
        let mut contacts: Vec<Vec<Touch>> =
            result.sites.iter().map(|sites| sites.iter().map(touch).collect()).collect();
        // Forces of rigid bodies in motion are means of an increment in which momenta change.
        let are_means = result.moved.is_some() && plan.system.is_rigid();
        if are_means {
            // What struck and has parted since is open.
            let apart = PARTED * plan.system.size();
            for touch in contacts.iter_mut().flatten().filter(|t| (t.x - t.foot).dot(&t.normal) > apart) {
                (touch.is_closed, touch.pressure, touch.friction) = (false, 0.0, Vector::<3>::zeros());
            }
        }
        let before = self.before.take();
        let forces = forces((plan, setting), (state, result), step.time, before.as_ref());
        let dissipated = plan.system.contacts.iter().map(|c| step.contacts.get(c.name()).and_then(|c| c.dissipation));
        let now = State {
            time: step.time,
            bodies,
            way: result.way.iter().map(|bodies| placements(plan, setting, bodies, &[])).collect(),
            contacts,
            forces,
            // Less what the method still owes of an increment that it could not correct at once.
            stored: Some(result.energy - state.owed.iter().sum::<f64>()),
            dissipated: dissipated.collect(),
            dissipated_in_bodies: result.dissipated_in_bodies.iter().sum(),
            in_motion: result.moved.is_some(),
        };
        let mut found = audited(setting, before.as_ref().map(|b| &b.0), &now, &stability(plan, step));
        if are_means {
            let of_rest = [Check::Balance, Check::Path, Check::Uniqueness, Check::Tractions];
            found.findings.retain(|f| !of_rest.contains(&f.check));
            found.bounds.clear();
        }
        self.before = Some((State { way: Vec::new(), ..now }, state.clone()));
        self.bounds = found.bounds;
        found.findings
    }

    /// Bounds of forces that balance did not determine in the last increment.
    pub fn bounds(&self) -> &[ForceBounds] {
        &self.bounds
    }

    /// What a later run needs to go on.
    pub fn save(&self) -> Value {
        self.before.as_ref().map_or(Value::Null, |(before, _)| saved(before))
    }

    /// Goes on from a state that was saved, at its time.
    pub fn restore(&mut self, value: &Value, plan: &MechanicsPlan, state: &SystemState, time: f64) {
        let setting = self.setting.get_or_insert_with(|| setting(plan));
        let bodies = placements(plan, setting, &state.bodies, &[]);
        self.before = restored(value, time, bodies).map(|before| (before, state.clone()));
    }
}

fn setting(plan: &MechanicsPlan) -> Setting {
    let space = match plan.space {
        Stated::ThreeD => Space::ThreeD,
        Stated::Axisymmetric => Space::Axisymmetric,
        _ => Space::Plane,
    };
    let start = plan.system.start();
    let bodies = (plan.system.bodies.iter().zip(&plan.kinds).zip(&start.bodies)).map(|((body, kind), state)| {
        let form = match kind {
            Kind::Rigid { shape, centre, is_free } => {
                let placed = body.sites(None, Sampling::Nodes).unwrap_or_default();
                let placed: Vec<_> = placed.iter().map(|site| body.placed(state, site)).collect();
                let balls = placed.iter().filter(|p| p.radius > 0.0).map(|p| (p.x, p.radius)).collect();
                let mut points: Vec<Point<3>> = placed.iter().filter(|p| p.radius == 0.0).map(|p| p.x).collect();
                // Of a disc, too, which is a cylinder without ends.
                let reach = placed.iter().flat_map(|p| [-p.radius, p.radius].map(|r| p.x + Vector::<3>::repeat(r)));
                let around = shape.bounds().or_else(|| Aabb::around(reach));
                let in_space = space == Space::ThreeD;
                points.extend(around.iter().flat_map(|bounds| surface(shape.as_ref(), bounds, in_space)));
                let size = around.map_or(0.0, |b| extent(&b, in_space));
                let shape = Arc::clone(shape);
                let gap = Arc::new(move |x: &Point<3>| shape.gap(x));
                Form::Rigid(Rigid { gap, surface: points, balls, centre: *centre, is_free: *is_free, size })
            }
            Kind::Curve { radius } => Form::Curve(curve(plan, body.name(), *radius, &body.fields(state))),
            Kind::Solid | Kind::Cells => Form::Solid(solid(plan, body.name(), body.fields(state), space)),
        };
        // The force that moves a place by a unit of length, times what rounding moves it by.
        // A place on an axis has none.
        let sites =
            [None, Some("boundary")].into_iter().filter_map(|on| body.sites(on, Sampling::Nodes).ok()).flatten();
        let stiffness = sites.map(|site| body.site_stiffness(&site)).filter(|c| c.is_finite()).fold(0.0, f64::max);
        let rounding = ROUNDING * stiffness * body.size();
        Body { name: body.name().to_string(), form, rounding }
    });
    Setting { space, bodies: bodies.collect(), contacts: contacts(plan) }
}

fn solid(plan: &MechanicsPlan, name: &str, fields: BodyFields, space: Space) -> Solid {
    let boundary = Boundary::new(&fields.points, &fields.cells, space == Space::ThreeD);
    let parts = match plan.head.problem.bodies.get(name) {
        Some(Key::Cells(cells)) => cells.degree.unwrap_or(crate::plan::mechanics::cells::DEGREE as i64),
        Some(Key::Solid(solid)) => solid.degree.unwrap_or(1),
        _ => 1,
    };
    let strain_limit = crate::run::strain::is_small(&plan.head.problem, name).then_some(STRAIN);
    let is_cut = matches!(plan.head.problem.bodies.get(name), Some(Key::Cells(_)));
    Solid { rest: fields.points, cells: fields.cells, boundary, parts: parts.max(1) as f64, is_cut, strain_limit }
}

fn curve(plan: &MechanicsPlan, name: &str, radius: f64, fields: &BodyFields) -> Curve {
    let is_beam = matches!(plan.head.problem.bodies.get(name), Some(Key::Beam(_)));
    let elements = fields.cell_data.iter().find(|d| d.0 == "element").and_then(|d| d.2.last()).map_or(0.0, |e| e + 1.0);
    Curve {
        rest: fields.points.clone(),
        pieces: fields.cells.iter().map(|c| [c[0], c[1]]).collect(),
        parts: if elements > 0.0 { fields.cells.len() as f64 / elements } else { 1.0 },
        radius,
        strain_limit: is_beam.then_some(STRAIN),
        bends: is_beam,
    }
}

fn contacts(plan: &MechanicsPlan) -> Vec<Contact> {
    let problem = &plan.head.problem;
    let planner = Planner::new(problem).ok();
    let contact = |k: usize| {
        let (contact, tested) = (&plan.system.contacts[k], &plan.contacts[k]);
        let bodies = contact.bodies();
        let carries = match tested.carries {
            TractionKind::LineLoad => Carries::LineLoad,
            TractionKind::Force => Carries::Force,
            TractionKind::Pressure => Carries::Traction,
        };
        let penalty = problem.contacts.get(contact.name()).and_then(|key| penalty_of(key.method.as_ref()?));
        let wanted = penalty.and_then(|p| planner.as_ref()?.reader.positive(p.penetration.as_ref()?, LENGTH).ok());
        Contact {
            name: contact.name().to_string(),
            bodies,
            law: contact.friction().map(|law| law_of(law, problem, contact.name())),
            is_small_sliding: tested.slides_little,
            carries,
            wanted_penetration: wanted.or(tested.tied_overlap).unwrap_or(0.0),
            at_places: !["mortar", "discs"].contains(&tested.method),
            surfaces: surfaces(contact.law().friction.as_deref()),
        }
    };
    (0..plan.system.contacts.len()).map(contact).collect()
}

/// The penalty that a method states.
fn penalty_of(method: &Method) -> Option<&Penalty> {
    let enforcement = match method {
        Method::Mortar(m) | Method::GaussPoint(m) | Method::Node(m) | Method::CellSurface(m) => m.enforcement.as_ref(),
        Method::Curve(m) => m.enforcement.as_ref(),
        Method::Discs(m) => return m.penalty.as_ref(),
        _ => None,
    };
    match enforcement {
        Some(Enforcement::Penalty(penalty)) => Some(penalty),
        _ => None,
    }
}

fn touch(s: &SiteResult) -> Touch {
    let n = s.normal;
    Touch {
        x: s.touches_at(),
        foot: s.touches_at() - n * s.gap.unwrap_or(0.0),
        normal: n,
        weight: s.weight,
        area: s.contact_area(),
        is_closed: s.status != Status::Open,
        slips: s.status == Status::Slip,
        pressure: if s.status == Status::Open { 0.0 } else { s.pressure },
        friction: if s.status == Status::Open { Vector::<3>::zeros() } else { s.friction },
        on_centre_line: s.on_centre_line.filter(|_| s.status != Status::Open).map(|friction| (s.x, friction)),
        slip: s.increment,
        worn: s.worn,
    }
}

/// What surfaces do besides keeping each other out and rubbing.
fn surfaces(law: Option<&dyn Law>) -> Surfaces {
    let Some(law) = law else { return Surfaces::default() };
    let gap_at = law.compliance().map(|c| Arc::new(move |p| c.gap(p)) as Arc<dyn Fn(f64) -> f64 + Send + Sync>);
    Surfaces { strength: law.strength(), range: law.range(), gap_at, wear: law.wear() }
}

/// How stable the state is, where that is known; unstable states that are asked for are warned of elsewhere.
fn stability(plan: &MechanicsPlan, step: &StepReport) -> Stability {
    match &step.stability {
        Some(told) if told.stable => Stability::Stable,
        Some(told) if plan.system.unstable == Unstable::Follow => {
            Stability::Unstable { negative: told.negative_eigenvalues, body: told.body.clone().unwrap_or_default() }
        }
        _ => Stability::NotTested,
    }
}

/// The energy that bodies store as they start: of a pretension.
fn stored(plan: &MechanicsPlan, start: &SystemState) -> Option<f64> {
    let bodies = plan.system.bodies.iter().zip(&start.bodies);
    bodies.map(|(b, state)| b.internal(state, Order::First, &mut Contribution::new(b.unknowns())).ok()).sum()
}

/// Where the bodies are; `placed` are the points of solids where they are known. What of a rope is on a winch is not shown: its
/// points are taken anew.
fn placements(
    plan: &MechanicsPlan,
    setting: &mut Setting,
    states: &[BodyState],
    placed: &[Vec<Point<3>>],
) -> Vec<Placement> {
    let mut out = Vec::new();
    for (k, (body, state)) in plan.system.bodies.iter().zip(states).enumerate() {
        out.push(match &plan.kinds[k] {
            Kind::Rigid { centre, .. } => {
                let pose = rigid_body::Pose::of(state);
                Placement::Moved(RigidMotion::new(pose.turn, *centre, pose.centre - centre))
            }
            Kind::Solid | Kind::Cells if placed.get(k).is_some_and(|points| !points.is_empty()) => {
                Placement::Points(placed[k].clone())
            }
            kind => {
                let fields = body.fields(state);
                if let (Form::Curve(known), Kind::Curve { radius }) = (&setting.bodies[k].form, kind)
                    && known.rest.len() != fields.points.len()
                {
                    setting.bodies[k].form = Form::Curve(curve(plan, body.name(), *radius, &fields));
                }
                Placement::Points(fields.points.iter().zip(&fields.displacement).map(|(x, u)| x + u).collect())
            }
        });
    }
    out
}
