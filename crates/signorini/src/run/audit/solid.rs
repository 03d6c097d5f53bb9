//! Linear solids as plain data.

use super::{ROUNDING, STRAIN, around, extent, law_of, mean_work, restored, saved, surface};
use crate::output::solid_fields::{ContactDisplay, SolidDisplay, SolidFields};
use crate::plan::Placed;
use crate::plan::solid::{Opposite, SolidPlan, evaluate};
use crate::problem::Space as Stated;
use crate::report::{StepReport, vector};
use crate::run::solid::load;
use serde_json::Value;
use signorini_audit::{
    Acting, Body, Boundary, Carries, Contact, Finding, Form, Placement, Rigid, Setting, Solid, Space, Stability, State,
    Touch, audit, gaps,
};
use signorini_contact::Status;
use signorini_geometry::{Point, Vector};
use signorini_solid::loads::resultant;
use signorini_solid::{Model, State as Solved, SupportKind};
use std::sync::Arc;

/// What the check of solids remembers from increment to increment.
#[derive(Default)]
pub struct SolidAudit {
    setting: Option<Setting>,
    before: Option<State>,
    /// Displacements of the unknowns before.
    u: Vec<f64>,
}

/// What the check looks at.
pub struct Looked<'a, const D: usize> {
    pub plan: &'a SolidPlan<D>,
    pub model: &'a Model<D>,
    pub display: &'a SolidDisplay<D>,
}

impl SolidAudit {
    /// Checks the state at the start.
    pub fn start<const D: usize>(&mut self, of: &Looked<'_, D>) -> Vec<Finding> {
        let setting = self.setting.get_or_insert_with(|| setting(of));
        let contacts = vec![Vec::new(); of.plan.contacts.len()];
        let bodies = placements(of, &of.display.at_rest(), 0.0);
        let state = State { bodies, contacts, stored: Some(0.0), ..State::default() };
        let found = gaps::check_start(setting, &state);
        self.before = Some(state);
        found
    }

    /// Checks the end of an increment.
    pub fn increment<const D: usize>(
        &mut self,
        of: &Looked<'_, D>,
        solved: &Solved<D>,
        (fields, contacts): (&SolidFields<D>, &[ContactDisplay<D>]),
        step: &StepReport,
    ) -> Vec<Finding> {
        let setting = self.setting.get_or_insert_with(|| setting(of));
        let plan = of.plan;
        let now = State {
            time: step.time,
            bodies: placements(of, fields, step.time),
            contacts: (0..plan.contacts.len()).map(|k| touches(solved, k, &contacts[k])).collect(),
            forces: forces(of, solved, step.time, self.before.as_ref().map(|b| (b, &self.u[..]))),
            stored: Some(solved.energy),
            dissipated: plan.contacts.iter().map(|c| step.contacts.get(&c.name)?.dissipation).collect(),
        };
        let found = audit(setting, self.before.as_ref(), &now, &Stability::NotTested);
        self.before = Some(now);
        self.u.clone_from(&solved.u);
        found
    }

    /// What a later run needs to go on.
    pub fn save(&self) -> Value {
        let mut value = self.before.as_ref().map_or(Value::Null, saved);
        if !value.is_null() {
            value["u"] = self.u.clone().into();
        }
        value
    }

    /// Goes on from a state that was saved, at its time.
    pub fn restore<const D: usize>(&mut self, value: &Value, of: &Looked<'_, D>, time: f64) {
        let Ok(u) = serde_json::from_value::<Vec<f64>>(value["u"].clone()) else { return };
        let unknowns = of.model.bodies.list.last().map_or(0, |b| b.first + b.unknowns());
        if u.len() == unknowns {
            let fields = of.display.fields(of.model, &u);
            self.before = restored(value, time, placements(of, &fields, time));
            self.u = u;
        }
    }
}

fn space(stated: Stated) -> Space {
    match stated {
        Stated::ThreeD => Space::ThreeD,
        Stated::Axisymmetric => Space::Axisymmetric,
        _ => Space::Plane,
    }
}

/// The rigid bodies of a plan, each once, by name.
fn rigid_bodies<const D: usize>(plan: &SolidPlan<D>) -> Vec<&crate::plan::RigidBody> {
    let mut out: Vec<&crate::plan::RigidBody> = Vec::new();
    for contact in &plan.contacts {
        if let Opposite::Rigid(body) = &contact.opposite
            && out.iter().all(|b| b.name != body.name)
        {
            out.push(body);
        }
    }
    out
}

fn setting<const D: usize>(of: &Looked<'_, D>) -> Setting {
    let (plan, in_space) = (of.plan, D == 3);
    let rest = of.display.at_rest();
    let mut bodies = Vec::new();
    for (k, body) in plan.bodies.iter().enumerate() {
        let fields = of.display.of_body(&body.name, k as u32, &rest);
        let points: Vec<Point<3>> = fields.points.iter().map(|x| Point::<3>::from(*x)).collect();
        let cells: Vec<Vec<u32>> = fields.cells.into_iter().map(|c| c.1).collect();
        let around = around(&points);
        let boundary = Boundary::new(&points, &cells, in_space);
        let order = (0..body.mesh.cell_count()).map(|c| body.mesh.map(c).order()).max().unwrap_or(1);
        let parts = body.degree.max(order) as f64;
        let form =
            Form::Solid(Solid { rest: points, cells, boundary, parts, is_cut: false, strain_limit: Some(STRAIN) });
        let size = around.map_or(0.0, |b| extent(&b, in_space));
        let rounding = ROUNDING * body.material.youngs_modulus * size.powi(D as i32 - 1);
        bodies.push(Body { name: body.name.clone(), form, rounding });
    }
    let tools = rigid_bodies(plan);
    for body in &tools {
        let shape = body.touched();
        let bounds = shape.bounds();
        let points = bounds.map_or(Vec::new(), |b| surface(shape.as_ref(), &b, in_space));
        let centre = body.shape().centre();
        let size = bounds.map_or(0.0, |b| extent(&b, in_space));
        let gap = Arc::new(move |x: &Point<3>| shape.gap(x));
        let form = Form::Rigid(Rigid { gap, surface: points, balls: Vec::new(), centre, is_free: false, size });
        bodies.push(Body { name: body.name.clone(), form, rounding: 0.0 });
    }
    let contact = |c: &crate::plan::solid::SolidContact<D>| {
        let other = match &c.opposite {
            Opposite::Body { body, .. } => *body,
            Opposite::Rigid(rigid) => {
                plan.bodies.len() + tools.iter().position(|b| b.name == rigid.name).unwrap_or_default()
            }
        };
        Contact {
            name: c.name.clone(),
            bodies: [c.body, other],
            law: c.friction.as_ref().map(|f| law_of(f.friction().law.as_ref(), &plan.head.problem, &c.name)),
            is_small_sliding: true,
            carries: Carries::Traction,
            wanted_penetration: 0.0,
            at_places: false,
        }
    };
    Setting { space: space(plan.space), bodies, contacts: plan.contacts.iter().map(contact).collect() }
}

fn placements<const D: usize>(of: &Looked<'_, D>, fields: &SolidFields<D>, time: f64) -> Vec<Placement> {
    let display = of.display;
    let deformed = |k: usize| {
        let own = (0..display.points.len()).filter(|p| display.body[*p] as usize == k);
        Placement::Points(
            own.map(|p| Point::<3>::from(vector(&(display.points[p] + fields.displacement[p])))).collect(),
        )
    };
    let tools = rigid_bodies(of.plan).into_iter().map(|body| {
        let rest = || {
            signorini_geometry::rigid::RigidMotion::new(Vector::<3>::zeros(), Point::<3>::zeros(), Vector::<3>::zeros())
        };
        Placement::Moved(body.motion(&of.plan.head.problem, time).unwrap_or_else(|_| rest()))
    });
    (0..of.plan.bodies.len()).map(deformed).chain(tools).collect()
}

/// The nodes of a contact that have a part of it.
fn touches<const D: usize>(solved: &Solved<D>, contact: usize, shown: &ContactDisplay<D>) -> Vec<Touch> {
    let result = &solved.contacts[contact];
    let spatial = |x: &Point<D>| Vector::<3>::from(vector(x));
    let nodes = || result.nodes.iter().filter(|n| n.weight > 0.0);
    let whole: f64 = nodes().filter(|n| n.active).map(|n| n.weight).sum();
    let touch = |node: &signorini_solid::PressureNode<D>| {
        let x = spatial(&(node.x + shown.displacement[node.number as usize]));
        let friction = spatial(&node.rubbing.traction);
        let normal = (spatial(&node.force) - friction * node.weight) * node.multiplier.signum();
        let size = normal.norm() / node.weight;
        let normal = normal.try_normalize(0.0).unwrap_or_default();
        Touch {
            x,
            foot: x - normal * if node.active { node.gap } else { 0.0 },
            normal,
            weight: node.weight,
            area: if node.active { result.area * node.weight / whole } else { 0.0 },
            is_closed: node.active,
            slips: node.rubbing.status == Status::Slip,
            pressure: size.copysign(node.multiplier),
            friction,
            slip: spatial(&node.rubbing.increment),
        }
    };
    nodes().map(touch).collect()
}

/// Supports and loads with their work since the state before, of which the displacements are told too.
fn forces<const D: usize>(
    of: &Looked<'_, D>,
    solved: &Solved<D>,
    time: f64,
    before: Option<(&State, &[f64])>,
) -> Vec<Acting> {
    let (plan, bodies) = (of.plan, &of.model.bodies);
    let mut out: Vec<Acting> = Vec::new();
    let spatial = |x: &Point<D>| Vector::<3>::from(vector(x));
    let earlier = |k: usize| before.and_then(|b| b.0.forces.get(k)).map_or(Vector::<3>::zeros(), |f| f.force);
    for (support, force) in plan.supports.iter().zip(&solved.support_forces) {
        let force = spatial(force);
        let moved = before.and_then(|(was, _)| Some(uniform(plan, support, time)? - uniform(plan, support, was.time)?));
        // The radial forces around an axis have no resultant that does work.
        let known = moved.filter(|m| plan.space != Stated::Axisymmetric || m[0] == 0.0);
        let work = known.map(|m| mean_work(&earlier(out.len()), &force, &m));
        let drives = moved.is_none_or(|m| m.norm() > 0.0);
        out.push(Acting {
            name: support.name.clone(),
            body: support.body,
            force,
            moment: None,
            work,
            drives,
            reacts: true,
        });
    }
    for l in &plan.loads {
        let at = |t: f64| {
            let value = |p: &Placed, x: &Point<D>| evaluate(&plan.head.problem, p, x, t).unwrap_or(0.0);
            load(bodies, l, &value)
        };
        let own = at(time);
        let force = spatial(&resultant(bodies, &own));
        let work = before.map(|(was, u)| {
            let step = |k: usize| solved.u[k] - u.get(k).copied().unwrap_or(0.0);
            let power = |f: &[f64]| f.iter().enumerate().map(|(k, f)| f * step(k)).sum::<f64>();
            let [first, last] = [power(&at(was.time)), power(&own)];
            [0.5 * (first + last), 0.5 * (last - first).abs()]
        });
        out.push(Acting {
            name: l.name.clone(),
            body: l.body,
            force,
            moment: None,
            work,
            drives: false,
            reacts: false,
        });
    }
    out
}

/// The displacement that a support prescribes where it is the same all over the body; none where it differs, or where what is
/// held is no component.
fn uniform<const D: usize>(
    plan: &SolidPlan<D>,
    support: &crate::plan::solid::SolidSupport,
    time: f64,
) -> Option<Vector<3>> {
    if !matches!(support.kind, SupportKind::Components(_)) {
        return None;
    }
    let nodes = plan.bodies[support.body].mesh.nodes();
    let at = |x: &Point<D>| -> Option<Vector<3>> {
        let mut out = Vector::<3>::zeros();
        for (k, value) in support.values.iter().enumerate() {
            if let Some(p) = value {
                out[k] = evaluate(&plan.head.problem, p, x, time).ok()?;
            }
        }
        Some(out)
    };
    let first = at(nodes.first()?)?;
    let same = |k: usize| at(&nodes[k]) == Some(first);
    [nodes.len() - 1, nodes.len() / 2, nodes.len() / 3].into_iter().all(same).then_some(first)
}
