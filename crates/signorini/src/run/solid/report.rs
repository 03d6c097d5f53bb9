//! What is told of a state of solids.

use super::setup::load;
use crate::output::solid_fields::{ContactDisplay, SolidDisplay, SolidFields};
use crate::plan::Placed;
use crate::plan::solid::{SolidPlan, evaluate};
use crate::problem::Space as Stated;
use crate::report::{Component, ContactReport, Probe, Reason, StepReport, Warning, WarningKind, vector};
use crate::run::contact_verdict::contact_verdict;
use crate::run::record::Record;
use crate::run::strain::Strained;
use signorini_geometry::Point;
use signorini_solid::loads::resultant;
use signorini_solid::{ContactResult, FrictionResult, Method, Model, PressureNode, Route, State};
use std::collections::{BTreeMap, HashMap};

/// What solves the equations.
pub const SOLVER: &str = "direct";

/// The same, where the tractions of a large zone of contact are found by products with the compliance of the bodies.
fn solver(route: Route) -> &'static str {
    match route {
        Route::Columns => SOLVER,
        Route::Products => "direct with krylov",
    }
}

/// A state as it is shown.
pub struct Shown<const D: usize> {
    pub index: usize,
    pub time: f64,
    pub fields: SolidFields<D>,
    pub contacts: Vec<ContactDisplay<D>>,
}

impl<const D: usize> Shown<D> {
    /// The point of the display with the largest strain.
    fn most_strained(&self) -> Option<usize> {
        let strain = &self.fields.strain;
        (0..strain.len()).max_by(|&a, &b| strain[a].total_cmp(&strain[b]))
    }
}

/// The step of the summary that a state is.
pub fn step_report<const D: usize>(
    plan: &SolidPlan<D>,
    model: &Model<D>,
    display: &SolidDisplay<D>,
    state: &State<D>,
    shown: &Shown<D>,
) -> StepReport {
    let Shown { index, time, fields, contacts } = shown;
    let (index, time) = (*index, *time);
    // A support of several kinds is one for its reader; the axis is none.
    let mut supports: BTreeMap<String, Point<D>> = BTreeMap::new();
    for (support, force) in plan.supports.iter().zip(&state.support_forces) {
        if support.name != "axis" {
            *supports.entry(support.name.clone()).or_insert_with(Point::<D>::zeros) += force;
        }
    }
    let value = |p: &Placed, x: &Point<D>| evaluate(&plan.head.problem, p, x, time).unwrap_or(0.0);
    let bodies = &model.bodies;
    let loads = plan.loads.iter().map(|l| (l.name.clone(), vector(&resultant(bodies, &load(bodies, l, &value)))));
    let probe = |x: &Point<D>| {
        let distance = |k: &usize| (display.points[*k] - x).norm();
        let nearest = (0..display.points.len()).min_by(|a, b| distance(a).total_cmp(&distance(b)))?;
        Some(Probe {
            at: vector(&display.points[nearest]),
            displacement: vector(&fields.displacement[nearest]),
            in_contact: None,
            pressure: None,
            von_mises: Some(fields.von_mises[nearest]),
        })
    };
    let most = shown.most_strained();
    StepReport {
        index,
        time,
        converged: true,
        reason: Reason::Converged,
        iterations: state.iterations,
        solver: solver(state.route).into(),
        residual_history: state.residuals.clone(),
        energy: Some(state.energy),
        max_strain: most.map(|k| fields.strain[k]),
        equilibrium_residual: Some(state.imbalance),
        support_forces: supports.iter().map(|(name, force)| (name.clone(), vector(force))).collect(),
        load_forces: loads.collect(),
        contacts: (plan.contacts.iter().zip(&state.contacts).zip(contacts))
            .map(|((contact, result), shown)| (contact.name.clone(), contact_report(plan.space, result, shown)))
            .collect(),
        probes: plan.probes.iter().map(|(name, (_, x))| (name.clone(), probe(x))).collect(),
        ..StepReport::default()
    }
}

/// Warns of what looks wrong with a state.
pub fn warn<const D: usize>(
    plan: &SolidPlan<D>,
    model: &Model<D>,
    display: &SolidDisplay<D>,
    state: &State<D>,
    shown: &Shown<D>,
    record: &mut Record,
) {
    let Shown { time, fields, .. } = shown;
    let most = shown.most_strained();
    if let Some(k) = most {
        let strained = Strained { strain: fields.strain[k], at: vector(&display.points[k]) };
        strained.warning(display.body_of(model, k), *time, D).into_iter().for_each(|w| record.warn_once(w));
    }
    if state.unstable {
        let message = format!(
            "the equilibrium with friction at t = {time} is unstable: a small disturbance leads to another state"
        );
        record.warn_once(Warning::new(WarningKind::Unstable, message).at_time(*time));
    }
    for (contact, result) in plan.contacts.iter().zip(&state.contacts) {
        if let Some(friction) = &result.friction {
            warn_of_friction(&contact.name, friction, *time, record);
        }
        // Of pairs that were not named most never meet.
        if !plan.head.problem.contacts.contains_key(&contact.name) {
            continue;
        }
        let name = &contact.name;
        let warning = if result.nodes.is_empty() {
            let message =
                format!("contact `{name}`: no part of the slave faces the master; check the directions of the normals");
            Warning::new(WarningKind::NotFacing, message)
        } else if result.nodes.iter().all(|n| !n.active) {
            let gap = result.nodes.iter().map(|n| n.gap).fold(f64::INFINITY, f64::min);
            let message =
                format!("contact `{name}`: the bodies are not in contact at t = {time} (smallest gap {gap:.6e})");
            Warning::new(WarningKind::Apart, message)
        } else {
            continue;
        };
        record.warnings.push(warning.at_time(*time));
    }
}

/// Share of the contact that closes in one increment from which the way of its slip is not known well.
const CLOSES_AT_ONCE: f64 = 0.5;

/// Warns of what friction leaves undecided.
fn warn_of_friction<const D: usize>(name: &str, friction: &FrictionResult<D>, time: f64, record: &mut Record) {
    if friction.uniqueness <= 1.0 {
        let message = format!(
            "contact `{name}`: up to {:.2} times this friction each contact point has exactly one state for every \
             load, beyond it several; the equilibrium at t = {time} may not be unique, and the one reported was \
             reached from that of the increment before",
            friction.uniqueness
        );
        record.warn_once(Warning::new(WarningKind::NotUnique, message).at_time(time));
    }
    if friction.newly_closed > CLOSES_AT_ONCE {
        let message = format!(
            "contact `{name}`: {:.0} % of the contact closes in the increment to t = {time}, and its slip is measured \
             from positions before contact; use more increments if stick zones matter",
            100.0 * friction.newly_closed
        );
        record.warn_once(Warning::new(WarningKind::ClosesAtOnce, message).at_time(time));
    }
}

/// A contact of a state as it is told.
fn contact_report<const D: usize>(
    space: Stated,
    result: &ContactResult<D>,
    shown: &ContactDisplay<D>,
) -> ContactReport {
    let node: HashMap<usize, &PressureNode<D>> = result.nodes.iter().map(|n| (n.number as usize, n)).collect();
    let component = |zone: &Vec<usize>| {
        let own = || zone.iter().filter_map(|k| node.get(k));
        let whole: f64 = own().map(|n| n.weight).sum();
        let centroid = zone.iter().filter_map(|k| Some(shown.points[*k] * node.get(k)?.weight)).sum::<Point<D>>();
        let force: Point<D> = own().map(|n| n.force).sum();
        Component { area: shown.area(zone), force: vector(&force), centroid: vector(&(centroid / whole)), holes: None }
    };
    let components: Vec<Component> = shown.zones().iter().map(component).collect();
    let closed = || result.nodes.iter().filter(|n| n.active);
    let friction = result.friction.as_ref();
    ContactReport {
        force: vector(&result.force),
        area: result.area,
        zones: components.len(),
        radius: ContactReport::radius_of(space, result.area, components.len()),
        components,
        max_penetration: result.nodes.iter().map(|n| -n.gap).fold(0.0, f64::max),
        min_gap_outside: result.nodes.iter().filter(|n| !n.active).map(|n| n.gap).reduce(f64::min),
        max_pressure: result.nodes.iter().map(|n| n.pressure).fold(0.0, f64::max),
        min_pressure: closed().map(|n| n.pressure).reduce(f64::min),
        stick_area: friction.map(|f| f.stick_area),
        slip_area: friction.map(|f| f.slip_area),
        max_slip: friction.map(|f| f.max_slip),
        max_friction_utilisation: friction.map(|f| f.max_utilisation),
        friction_force: friction.map(|f| vector(&f.force)),
        dissipation: friction.map(|f| f.dissipation),
        ..ContactReport::default()
    }
}

/// One contact in a clause.
pub fn verdict<const D: usize>(plan: &SolidPlan<D>, name: &str, c: &ContactReport) -> String {
    let extent = if D == 3 || plan.space == Stated::Axisymmetric { "area" } else { "length" };
    contact_verdict((name, c), (D, extent), plan.head.unit_names().as_ref(), true)
}

/// The method of the contacts, all names where there are several.
pub fn method<const D: usize>(plan: &SolidPlan<D>) -> String {
    let name = |m: Method| match m {
        Method::Mortar => "mortar",
        Method::Node => "node",
        Method::GaussPoint => "gauss_point",
    };
    let mut list: Vec<&str> = plan.contacts.iter().map(|c| name(c.method)).collect();
    list.dedup();
    if list.is_empty() { "none".into() } else { list.join(", ") }
}
