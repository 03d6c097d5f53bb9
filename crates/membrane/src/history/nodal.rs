//! Increments by the nodal method.

use super::increment::{Increment, Sample, Stability};
use super::remark::{Remark, RemarkKind};
use crate::active_set::{self, NodalSolution, NodalStart};
use crate::conditions::Extremes;
use crate::problem::Membrane;
use crate::report::{ContactReport, Report};
use crate::solution::Reason;
use crate::staircase::Staircase;
use crate::zone::Zone;
use signorini_geometry::Point;
use signorini_solve::{Iteration, Progress};

/// One increment by the nodal method.
pub fn increment<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    start: NodalStart,
    at: (usize, f64),
    progress: &mut dyn Progress,
) -> Increment<D> {
    let failed = |message: String| Increment {
        converged: false,
        reason: Reason::LinearSolver(message.clone()),
        iterations: 0,
        before: 0,
        residuals: Vec::new(),
        unknowns: 0,
        solver: "direct",
        remarks: vec![Remark::new(RemarkKind::LinearSolver, message).at_time(at.1)],
        report: None,
        outlines: Vec::new(),
        sample: None,
        stability: Stability::default(),
        resolved: true,
        errors: None,
    };
    if membrane.obstacles.is_empty() {
        return failed("method.active_set requires a rigid body".into());
    }
    let solved = {
        let shared = &*progress;
        active_set::solve::<D, Z>(membrane, start, &|| shared.interrupted())
    };
    let solution = match solved {
        Ok(solution) => solution,
        Err(error) => return failed(error.to_string()),
    };
    let zones = Staircase::new(membrane, &solution);
    for (i, changed) in solution.changes.iter().enumerate() {
        progress.iteration(&Iteration {
            step: at.0,
            time: at.1,
            iteration: i + 1,
            residual: *changed as f64,
            action: "active set",
            figures: &[("zones", zones.components.len() as f64)],
        });
    }
    let reason = match (solution.converged, progress.interrupted(), zones.components.is_empty()) {
        (true, _, true) => Reason::NoContact,
        (true, ..) => Reason::Converged,
        (false, true, _) => Reason::Interrupted,
        (false, false, _) => Reason::IterationLimit,
    };
    let report = nodal_report(membrane, &solution, &zones);
    let membrane = membrane.clone();
    Increment {
        converged: solution.converged,
        reason,
        iterations: solution.iterations,
        before: 0,
        residuals: solution.changes.iter().map(|c| *c as f64).collect(),
        unknowns: solution.unknowns,
        solver: "direct",
        remarks: Vec::new(),
        report: Some(report),
        outlines: zones.outlines,
        stability: Stability::default(),
        resolved: true,
        errors: None,
        sample: Some(Box::new(move |x| {
            Some(Sample {
                displacement: solution.displacement(&membrane, x),
                in_contact: solution.contact(&membrane, x).is_some(),
                pressure: solution.pressure(&membrane, x),
            })
        })),
    }
}

fn nodal_report<const D: usize>(
    membrane: &Membrane<D>,
    solution: &NodalSolution<D>,
    zones: &Staircase<D>,
) -> Report<D> {
    let obstacles = &membrane.obstacles;
    let supports: f64 = solution.support_forces.iter().sum();
    let forces = zones.components.iter().map(|c| c.force);
    let largest = forces.clone().chain([supports, solution.load_force]).fold(f64::MIN_POSITIVE, |m, f| m.max(f.abs()));
    let length = |o: &Vec<Point<D>>| -> f64 {
        if D == 1 { 2.0 } else { o.iter().zip(o.iter().cycle().skip(1)).map(|(a, b)| (b - a).norm()).sum() }
    };
    let contact = |k: usize| {
        let side = obstacles.0[k].side;
        let mut extremes = Extremes::default();
        for (i, node) in solution.nodes.iter().enumerate() {
            let Some(node) = node.filter(|n| n.inside) else { continue };
            let x = membrane.grid.node(i);
            if obstacles.index_at(side, &x) != Some(k) {
                continue;
            }
            if node.contact == Some(side) {
                extremes.add_pressure(node.pressure());
            } else {
                extremes.add_gap(obstacles.gap(side, &x, node.displacement), true);
            }
        }
        let own = zones.components.iter().filter(|c| c.obstacle == k).cloned().collect();
        // Outlines are not told apart by bodies: with several of them the length is that of all.
        ContactReport::of(own, zones.outlines.iter().map(length).sum(), Some(&extremes))
    };
    Report {
        support_forces: solution.support_forces.clone(),
        load_force: solution.load_force,
        energy: solution.energy,
        max_slope: 0.0,
        volume: solution.nodes.iter().flatten().map(|n| n.share * n.displacement).sum(),
        equilibrium_residual: (forces.sum::<f64>() + supports + solution.load_force).abs() / largest,
        contacts: (0..obstacles.0.len()).map(contact).collect(),
    }
}
