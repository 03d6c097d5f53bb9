//! What of an increment goes into the summary.

use crate::plan::MembranePlan;
use crate::problem::Space;
use crate::report::{self, Event, EventKind, LocatedBy, Reason, StepReport, Warning, WarningKind, vector};
use signorini_geometry::Point;
use signorini_membrane::history::{self, Increment, Remark, RemarkKind};
use signorini_membrane::obstacle::Side;
use signorini_membrane::report::{Component, ContactReport};
use signorini_membrane::solution;
use std::collections::BTreeMap;

/// Why an increment ended.
pub fn reason(reason: &solution::Reason) -> Reason {
    match reason {
        solution::Reason::Converged => Reason::Converged,
        solution::Reason::NoContact => Reason::NoContact,
        solution::Reason::NoSuchState => Reason::NoSuchState,
        solution::Reason::IterationLimit => Reason::IterationLimit,
        solution::Reason::Interrupted => Reason::Interrupted,
        solution::Reason::LinearSolver(_) => Reason::LinearSolver,
    }
}

/// A remark as a warning.
pub fn warning(remark: Remark) -> Warning {
    let kind = match remark.kind {
        RemarkKind::Kink => WarningKind::Kink,
        RemarkKind::SteepSlopes => WarningKind::SteepSlopes,
        RemarkKind::SharpFront => WarningKind::SharpFront,
        RemarkKind::NotRefined => WarningKind::NotRefined,
        RemarkKind::FewerModes => WarningKind::FewerModes,
        RemarkKind::FrontsAtRest => WarningKind::FrontsAtRest,
        RemarkKind::NotResolved => WarningKind::NotResolved,
        RemarkKind::LinearSolver => WarningKind::LinearSolver,
        RemarkKind::Path => WarningKind::Path,
        RemarkKind::Jump => WarningKind::Jump,
        RemarkKind::Unstable => WarningKind::Unstable,
        RemarkKind::EventInterval => WarningKind::EventInterval,
    };
    let at = remark.at.map(|x| std::array::from_fn(|k| x.get(k).copied().unwrap_or(0.0)));
    Warning { kind, message: remark.message, time: remark.time, at }
}

/// An event as the summary tells it.
pub fn event<const D: usize>(plan: &MembranePlan<D>, event: &history::Event<D>) -> Event {
    let kind = match event.kind {
        history::EventKind::Nucleation => EventKind::Nucleation,
        history::EventKind::Release => EventKind::Release,
        history::EventKind::Merge => EventKind::Merge,
        history::EventKind::Split => EventKind::Split,
        history::EventKind::HoleOpened => EventKind::HoleOpened,
        history::EventKind::HoleClosed => EventKind::HoleClosed,
        history::EventKind::SnapIn => EventKind::SnapIn,
        history::EventKind::PullOff => EventKind::PullOff,
    };
    let by = match event.by {
        history::LocatedBy::Bisection => LocatedBy::Bisection,
        history::LocatedBy::Extrapolation => LocatedBy::Extrapolation,
    };
    let touched = event.obstacle.and_then(|k| plan.contacts.get(k));
    Event {
        contact: touched.map_or(String::new(), |c| c.name.clone()),
        kind,
        time: event.time,
        within: event.within,
        by,
        at: vector(&event.at),
        above: event.side == Side::Above,
        zones_before: event.zones[0],
        zones_after: event.zones[1],
        holes_before: event.holes[0],
        holes_after: event.holes[1],
        area_before: event.area[0],
        area_after: event.area[1],
        force_before: event.force[0],
        force_after: event.force[1],
        load_force: plan.load_resultants(&plan.at(event.time), event.time).values().sum(),
        energy_released: event.energy_released,
    }
}

/// The entry of the summary, with the resultants of the loads.
pub fn step_report<const D: usize>(
    increment: &Increment<D>,
    plan: &MembranePlan<D>,
    (index, time): (usize, f64),
    loads: &BTreeMap<String, f64>,
) -> StepReport {
    let upward = |f: f64| [0.0, 0.0, f];
    let step = StepReport {
        index,
        time,
        converged: increment.converged,
        reason: reason(&increment.reason),
        iterations: increment.iterations,
        iterations_before: increment.before,
        solver: increment.solver.into(),
        residual_history: increment.residuals.clone(),
        ..StepReport::default()
    };
    let Some(report) = &increment.report else { return step };
    let probe = |x: &Point<D>| {
        let found = increment.sample.as_ref().and_then(|sample| sample(x))?;
        Some(report::Probe {
            at: vector(x),
            displacement: upward(found.displacement),
            in_contact: Some(found.in_contact),
            pressure: Some(found.pressure),
            von_mises: None,
            temperature: None,
        })
    };
    let supports = plan.supports.iter().zip(&report.support_forces);
    let contacts = plan.contacts.iter().zip(&report.contacts);
    StepReport {
        energy: Some(report.energy),
        energy_total: Some(report.energy_total()),
        volume: Some(report.volume),
        max_slope: Some(report.max_slope),
        equilibrium_residual: Some(report.equilibrium_residual),
        support_forces: supports.map(|(support, force)| (support.name.clone(), upward(*force))).collect(),
        load_forces: loads.iter().map(|(name, force)| (name.clone(), upward(*force))).collect(),
        contacts: contacts.map(|(c, found)| (c.name.clone(), contact_report(increment, found, plan.space))).collect(),
        probes: plan.probes.iter().map(|(name, x)| (name.clone(), probe(x))).collect(),
        ..step
    }
}

fn contact_report<const D: usize>(
    increment: &Increment<D>,
    c: &ContactReport<D>,
    space: Space,
) -> report::ContactReport {
    let component = |k: &Component<D>| report::Component {
        area: k.area,
        force: [0.0, 0.0, k.force],
        centroid: vector(&k.centroid),
        holes: Some(k.holes),
    };
    report::ContactReport {
        force: [0.0, 0.0, c.force],
        area: c.area,
        zones: c.components.len(),
        holes: Some(c.holes),
        components: c.components.iter().map(component).collect(),
        radius: radius(increment, c, space),
        boundary_length: Some(c.boundary_length),
        max_penetration: c.max_penetration,
        min_gap_outside: c.min_gap_outside,
        max_pressure: c.max_pressure,
        min_pressure: Some(c.min_pressure),
        line_force: Some(c.line_force),
        adhesion_energy: Some(c.adhesion_energy),
        stable: Some(increment.stability.lowest_eigenvalue.is_none_or(|v| v > 0.0)),
        lowest_eigenvalue: increment.stability.lowest_eigenvalue,
        error_estimate: increment.errors.map(|e| report::ErrorEstimate {
            front: Some(e.front),
            area: e.area,
            force: e.force,
            max_pressure: Some(e.max_pressure),
        }),
        ..report::ContactReport::default()
    }
}

/// The radius of a zone that is a disc to two hundredths, or half the length of one that is an interval.
fn radius<const D: usize>(increment: &Increment<D>, c: &ContactReport<D>, space: Space) -> Option<f64> {
    let [component] = c.components.as_slice() else { return None };
    let disc = (c.area / std::f64::consts::PI).sqrt();
    match (space, D) {
        (Space::Line, _) => Some(0.5 * c.area),
        (Space::Axisymmetric, _) => {
            let outer = increment.outlines.first()?.last()?[0];
            ((outer - disc).abs() < 0.02 * outer).then_some(disc)
        }
        _ => {
            let [outline] = increment.outlines.as_slice() else { return None };
            let radii = outline.iter().map(|p| (p - component.centroid).norm());
            let (lo, hi) = radii.fold((f64::INFINITY, 0.0f64), |(l, h), r| (l.min(r), h.max(r)));
            (hi - lo < 0.02 * hi).then_some(disc)
        }
    }
}
