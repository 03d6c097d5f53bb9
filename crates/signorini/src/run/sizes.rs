//! The plans as the runner sees them: what a run would have to do, what looks wrong before it starts, and the models.

use super::driver::Model;
use super::mechanics::MechanicsModel;
use super::membrane::MembraneModel;
use super::outcome::RunError;
use super::planned::Planned;
use crate::output::{pictures, system_pictures};
use crate::plan::mechanics::{MechanicsPlan, odd_length};
use crate::plan::{MembranePlan, memory_estimate, mesh_multigrid_estimate, multigrid_estimate};
use crate::problem::CaseError;
use crate::processes;
use crate::report::{Warning, WarningKind};
use crate::snapshot::{DisplayMesh, Snapshot};
use serde_json::{Value, json};
use signorini_geometry::Point;
use signorini_mechanics::Body;
use signorini_membrane::field::Constant;
use signorini_membrane::history::{LINEAR, Sample, Statement};
use signorini_membrane::obstacle::Side;
use signorini_membrane::problem::Membrane;
use signorini_membrane::quadrature::Cell;
use std::sync::Arc;

/// Solves that an increment takes, about.
const SOLVES: [f64; 2] = [6.0, 12.0];
/// A surface may leave the straight line within a cell by this part of its height.
const BENDS: f64 = 0.1;
/// More unknowns than this are not solved for just to look.
const LOOK: usize = 200_000;

/// What a run of a system of bodies would have to do.
fn of_system(plan: &MechanicsPlan) -> Value {
    let contacts: Vec<&str> = plan.system.contacts.iter().map(|c| c.name()).collect();
    let unknowns: usize = plan.system.bodies.iter().map(|b| b.unknowns()).sum();
    let mut methods = plan.contacts.iter().map(|c| c.method).collect::<Vec<_>>();
    methods.dedup();
    json!({
        "method": if methods.is_empty() { "none".to_string() } else { methods.join(", ") },
        "bodies": plan.system.bodies.len(),
        "unknowns": unknowns,
        "points_tested": points_tested(plan),
        "free": free(plan),
        "increments": plan.times.len(),
        "supports": plan.head.problem.supports.len(),
        "loads": plan.head.problem.loads.len(),
        "contacts": contacts.join(", "),
        "found": plan.notes,
        "interpreted": plan.head.interpreted,
        "warnings": plan.head.warnings,
    })
}

/// Bodies that nothing but contact holds.
fn free(plan: &MechanicsPlan) -> Vec<String> {
    let free = |(k, body): (usize, &dyn Body)| {
        if !body.is_linear() || body.unknowns() == 0 {
            return None;
        }
        let motion = plan.system.free_motion(k).ok().flatten()?;
        Some(format!("`{}` is free {motion} until it is in contact", body.name()))
    };
    plan.system.bodies.iter().map(AsRef::as_ref).enumerate().filter_map(free).collect()
}

/// Points of the contacts of a system at the start; null where they are found only as bodies come near.
fn points_tested(plan: &MechanicsPlan) -> Option<usize> {
    let start = plan.system.start();
    let mut count = 0;
    for (k, tested) in plan.contacts.iter().enumerate() {
        let sites = plan.system.sites(k, &start).ok()?;
        if sites.is_empty() && !tested.along_a_curve {
            return None;
        }
        count += sites.len();
    }
    Some(count)
}

fn of_membrane<const D: usize>(plan: &MembranePlan<D>) -> Result<Value, CaseError> {
    let times = plan.known_times();
    for &time in &times {
        plan.check_fields(&plan.at(time), time)?;
    }
    let unknowns = plan.cells.function_count();
    let contacts: Vec<String> = plan
        .contacts
        .iter()
        .map(|c| {
            let place = if c.side == Side::Below { "on" } else { "under" };
            format!("{}: {} {place} {}", c.name, plan.body, c.body)
        })
        .collect();
    let mut warnings = plan.head.warnings.clone();
    let membrane = plan.at(plan.increments.first().map_or(0.0, |i| i.range[0]));
    let multigrid = plan.by_multigrid(&membrane);
    let estimate = |n: f64, p: usize| match (multigrid, plan.cells.as_grid()) {
        (true, Some(_)) => multigrid_estimate(n, p, membrane.tension.constant().is_some()),
        (true, None) => mesh_multigrid_estimate(n, p),
        (false, _) => memory_estimate(n, p, D),
    };
    let bytes = estimate(unknowns as f64, plan.cells.degree());
    let mut sizes = json!({
        "method": plan.method.name(),
        "cells": plan.cells.count(),
        "cell_size": plan.grid.h(),
        "degree": plan.cells.degree(),
        "unknowns_at_most": unknowns,
        "memory_at_most": format!(
            "{:.2} GiB",
            bytes / f64::from(1u32 << 30)
        ),
        "solver": if multigrid { "multigrid" } else { "direct" },
        "increments": plan.increments.len(),
        "supports": plan.supports.len(),
        "loads": plan.loads.len(),
        "contact": if plan.contacts.is_empty() { "none".to_string() } else { contacts.join(", ") },
    });
    warnings
        .extend(unresolved(plan, plan.increments.first().map_or(0.0, |i| i.range[0])).into_iter().map(Warning::from));
    if let Some(units) = plan.head.units {
        warnings.extend(odd_length(units, plan.grid.bounds().size().max(), "the membrane").map(Warning::from));
    }
    if unknowns <= LOOK {
        look(plan, times.last().copied().unwrap_or(0.0), &mut sizes, &mut warnings);
    }
    sizes["interpreted"] = json!(plan.head.interpreted);
    sizes["warnings"] = json!(warnings);
    Ok(sizes)
}

impl<const D: usize> Planned for MembranePlan<D> {
    fn sizes(&self) -> Result<Value, CaseError> {
        of_membrane(self)
    }

    fn preview(&self) -> Result<Option<String>, RunError> {
        let time = self.increments.first().map_or(0.0, |i| i.range[0]);
        let membrane = Membrane { load: Arc::new(Constant(0.0)), ..self.at(time) };
        let mesh = DisplayMesh::new(self, &membrane);
        let Ok(free) = (self.kernel.free)(&membrane) else { return Ok(None) };
        if mesh.cells.is_empty() {
            return Ok(None);
        }
        let sample =
            |x: &Point<D>| Some(Sample { displacement: (free.displacement)(x)?, in_contact: false, pressure: 0.0 });
        let snapshot = Snapshot::new(&mesh, &membrane, time, Vec::new(), sample);
        Ok(Some(pictures::preview(self, &mesh, &snapshot)?))
    }

    fn model(self: Box<Self>) -> Result<Box<dyn Model>, CaseError> {
        processes::refuse("a membrane")?;
        Ok(Box::new(MembraneModel::new(*self)?))
    }
}

impl Planned for MechanicsPlan {
    fn sizes(&self) -> Result<Value, CaseError> {
        Ok(of_system(self))
    }

    fn preview(&self) -> Result<Option<String>, RunError> {
        Ok(Some(system_pictures::preview(self)?))
    }

    fn model(mut self: Box<Self>) -> Result<Box<dyn Model>, CaseError> {
        processes::divide(&mut self)?;
        Ok(Box::new(MechanicsModel::new(*self)))
    }
}

/// Bodies whose surface leaves the straight line within a cell by more than a part of its height are not resolved.
fn unresolved<const D: usize>(plan: &MembranePlan<D>, time: f64) -> Vec<String> {
    let membrane = plan.at(time);
    let none = (plan.kernel.quadrature)(&membrane);
    let mut out = Vec::new();
    for (contact, obstacle) in plan.contacts.iter().zip(&membrane.obstacles.0) {
        let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
        let mut worst = (0.0f64, Point::<D>::zeros());
        for cell in (0..none.cells.len()).filter(|&cell| matches!(none.cells[cell], Cell::Whole(_))) {
            let b = plan.cells.bounds_of(cell);
            let corners = (0..1usize << D).map(|k| Point::<D>::from_fn(|i, _| [b.min, b.max][k >> i & 1][i]));
            let heights: Vec<f64> = corners.map(|x| obstacle.height.value(&x)).collect();
            let middle = obstacle.height.value(&b.center());
            let bend = (heights.iter().sum::<f64>() / heights.len() as f64 - middle).abs();
            low = heights.iter().fold(low, |m, h| m.min(*h));
            high = heights.iter().fold(high, |m, h| m.max(*h));
            if bend > worst.0 {
                worst = (bend, b.center());
            }
        }
        // What is flat bends by rounding only.
        let rounding = 1e-12 * high.abs().max(low.abs());
        if worst.0 > (BENDS * (high - low)).max(rounding) {
            let place: Vec<String> = worst.1.iter().map(|v| format!("{v:.4}")).collect();
            out.push(format!(
                "`{}` curves within a cell, near ({}), by {:.0} % of its height: use more cells, or `refine` in the \
                 mesh",
                contact.body,
                place.join(", "),
                100.0 * worst.0 / (high - low)
            ));
        }
    }
    out
}

/// A membrane that its load brings nearer to a body by less than this part of the gap is hardly loaded.
const HARDLY: f64 = 1e-2;

/// Why a membrane touches nothing at a time: the least gap, and whether the load moves it away or hardly at all; none where it
/// touches something, or cannot be looked at.
pub(super) fn clearance<const D: usize>(plan: &MembranePlan<D>, time: f64) -> Option<String> {
    let loaded = plan.at(time);
    if plan.cells.function_count() > LOOK || loaded.obstacles.is_empty() {
        return None;
    }
    let least = |membrane: &Membrane<D>| Some((plan.kernel.free)(membrane).ok()?.least_gap);
    let (gap, side, x) = least(&loaded).filter(|(gap, ..)| *gap > 0.0)?;
    let (before, ..) = least(&Membrane { load: Arc::new(Constant(0.0)), ..loaded.clone() })?;
    let nearer = before - gap;
    let away = if side == Side::Below { "up, away from the bodies below" } else { "down, away from the bodies above" };
    let hint = if nearer < 0.0 {
        format!("; the load moves it {away}: `normal` is positive upwards")
    } else if nearer < HARDLY * before {
        let size = plan.grid.bounds().size().max();
        let unit = plan.head.units.map_or(String::new(), |u| format!(" {}", u.names[0]));
        format!(
            "; the load reduces the gap by only {nearer:.1e}: the membrane is {size:.4}{unit} wide; check that its \
             size, load and tension are in the units of the case"
        )
    } else if let Some(sag) = sag(&loaded, &x).filter(|sag| *sag > gap) {
        format!(
            "; but within a cell it may sag by {sag:.1e}, which degree 1 cannot represent: use more cells, or degree \
             2"
        )
    } else {
        String::new()
    };
    Some(format!("the smallest gap at t = {time} is {gap:.4e}{hint}"))
}

/// Whether a membrane without contact would reach a body at a time before the last one; of large ones with many times only those
/// are looked at that can be in little time.
fn touches_before<const D: usize>(plan: &MembranePlan<D>, last: f64) -> bool {
    let times = plan.known_times();
    let every = (plan.cells.function_count() * times.len()).div_ceil(LOOK).max(1);
    let reaches = |time: &f64| {
        let membrane = plan.at(*time);
        (plan.kernel.free)(&membrane).is_ok_and(|state| state.least_gap.0 <= 0.0)
    };
    times.iter().rev().step_by(every).filter(|time| **time != last).any(reaches)
}

/// How far a membrane of degree 1 hangs through, unseen, within the cell about a point: a string as long as the cell under the
/// load there. None of higher degrees.
fn sag<const D: usize>(membrane: &Membrane<D>, x: &Point<D>) -> Option<f64> {
    let string = || membrane.load.value(x).abs() * membrane.cell_size(x).powi(2) / (8.0 * membrane.tension.value(x));
    (membrane.grid.degree() == 1).then(string)
}

/// Solves for the membrane without contact, at rest and under its last load.
fn look<const D: usize>(plan: &MembranePlan<D>, last: f64, sizes: &mut Value, warnings: &mut Vec<Warning>) {
    let Some(first) = plan.increments.first() else { return };
    let free = |membrane: &Membrane<D>| (plan.kernel.free)(membrane).ok();
    let at_rest = Membrane { load: Arc::new(Constant(0.0)), ..plan.at(first.range[0]) };
    if let (Some(state), false) = (free(&at_rest), at_rest.obstacles.is_empty()) {
        let (gap, _, x) = state.least_gap;
        let place: Vec<String> = x.iter().map(|v| format!("{v:.4}")).collect();
        sizes["least_gap_before_load"] = json!(format!("{gap:.4e} at ({})", place.join(", ")));
    }
    let apart = clearance(plan, last).filter(|_| !touches_before(plan, last));
    let apart = apart.map(|why| format!("the membrane is not in contact: {why}"));
    warnings.extend(apart.map(|message| Warning::new(WarningKind::Apart, message).at_time(last)));
    let start = std::time::Instant::now();
    let Some(state) = free(&plan.at(last)) else {
        warnings.push("the membrane without contact could not be solved for; check its supports".into());
        return;
    };
    let seconds = start.elapsed().as_secs_f64() * SOLVES[D - 1] * plan.increments.len() as f64;
    sizes["time_about"] = json!(if seconds < 1.0 { "below a second".into() } else { format!("{seconds:.0} s") });
    let steepest = state.steepest;
    sizes["steepest_slope_without_contact"] = json!(format!("{steepest:.2e}"));
    if plan.head.problem.units.is_some() && steepest > LINEAR {
        warnings.push(
            format!(
                "without contact slopes would reach {steepest:.1}; the linear theory is valid below about {LINEAR}"
            )
            .into(),
        );
    }
    if plan.head.problem.units.is_some() && steepest > 100.0 {
        warnings.push("such slopes indicate wrong units: check load and tension".into());
    }
}
