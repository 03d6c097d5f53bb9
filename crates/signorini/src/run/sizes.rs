//! What a run of a membrane would have to do, and what looks wrong before it starts.

use super::increment::LINEAR;
use crate::case::CaseError;
use crate::case::value::Interpreted;
use crate::plan::{MembranePlan, Plan, memory_estimate};
use serde_json::{Value, json};
use signorini_membrane::conditions::least_free_gap;
use signorini_membrane::equilibrium::{Elements, Equilibrium};
use signorini_membrane::field::Constant;
use signorini_membrane::line_zone::LineZone;
use signorini_membrane::obstacle::Side;
use signorini_membrane::plane_zone::PlaneZone;
use signorini_membrane::problem::Membrane;
use signorini_membrane::zone::Zone;
use std::sync::Arc;

/// Solves that an increment takes, about.
const SOLVES: [f64; 2] = [6.0, 12.0];
/// More unknowns than this are not solved for just to look.
const LOOK: usize = 200_000;

/// What a run of a plan would have to do: size, time, for a membrane the gap before any load, and warnings; after checking
/// the fields at the first and the last time.
///
/// # Errors
/// Fields that cannot be used, at their place.
pub fn sizes(plan: &Plan) -> Result<Value, CaseError> {
    match plan {
        Plan::Line(plan) => of_membrane::<1, LineZone>(plan),
        Plan::Plane(plan) => of_membrane::<2, PlaneZone>(plan),
        Plan::PlaneSolids(plan) => super::solid_sizes(plan),
        Plan::Solids(plan) => super::solid_sizes(plan),
    }
}

fn of_membrane<const D: usize, Z: Zone<D>>(plan: &MembranePlan<D>) -> Result<Value, CaseError> {
    for time in [plan.increments.first(), plan.increments.last()].into_iter().flatten().map(|i| i.time) {
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
    let mut warnings = plan.warnings.clone();
    let mut sizes = json!({
        "method": plan.method.name(),
        "cells": plan.cells.count(),
        "cell_size": plan.grid.h(),
        "degree": plan.cells.degree(),
        "unknowns_at_most": unknowns,
        "memory_at_most": format!(
            "{:.2} GiB",
            memory_estimate(unknowns as f64, plan.cells.degree(), D) / f64::from(1u32 << 30)
        ),
        "increments": plan.increments.len(),
        "supports": plan.supports.len(),
        "loads": plan.loads.len(),
        "contact": if plan.contacts.is_empty() { "none".to_string() } else { contacts.join(", ") },
    });
    if unknowns <= LOOK {
        look::<D, Z>(plan, &mut sizes, &mut warnings);
    }
    sizes["interpreted"] = plan.interpreted.iter().map(Interpreted::to_json).collect();
    sizes["warnings"] = json!(warnings);
    Ok(sizes)
}

/// Solves for the membrane without contact, at rest and under its last load.
fn look<const D: usize, Z: Zone<D>>(plan: &MembranePlan<D>, sizes: &mut Value, warnings: &mut Vec<String>) {
    let (Some(first), Some(last)) = (plan.increments.first(), plan.increments.last()) else { return };
    let none = Z::empty(&plan.grid);
    let free = |membrane: &Membrane<D>| Equilibrium::solve(membrane, &none, &mut Elements::new(membrane)).ok();
    let at_rest = Membrane { load: Arc::new(Constant(0.0)), ..plan.at(first.range[0]) };
    if let (Some(state), false) = (free(&at_rest), at_rest.obstacles.is_empty()) {
        let (gap, _, x) = least_free_gap(&state, &none);
        let place: Vec<String> = x.iter().map(|v| format!("{v:.4}")).collect();
        sizes["least_gap_before_load"] = json!(format!("{gap:.4e} at ({})", place.join(", ")));
    }
    let start = std::time::Instant::now();
    let Some(state) = free(&plan.at(last.time)) else {
        warnings.push("the membrane without contact could not be solved for: is it held?".into());
        return;
    };
    let seconds = start.elapsed().as_secs_f64() * SOLVES[D - 1] * plan.increments.len() as f64;
    sizes["time_about"] = json!(if seconds < 1.0 { "below a second".into() } else { format!("{seconds:.0} s") });
    let mut steepest = 0.0f64;
    state.for_each_point(|cell, region, x, _| {
        steepest = state.evaluate(cell, region, x).map_or(steepest, |(_, slope)| steepest.max(slope.norm()));
    });
    sizes["steepest_slope_without_contact"] = json!(format!("{steepest:.2e}"));
    if plan.document.case.units.is_some() && steepest > LINEAR {
        warnings.push(format!(
            "without contact slopes would reach {steepest:.1}: the linear theory holds below about {LINEAR}"
        ));
    }
    if plan.document.case.units.is_some() && steepest > 100.0 {
        warnings.push("such slopes come from units that do not fit: are load and tension what they should be?".into());
    }
}
