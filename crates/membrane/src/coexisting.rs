//! Other equilibria of an adhesive membrane at the same load.
//!
//! Zones of growing size are tried: where the membrane comes nearest to a body, and where it is softest. Between a zone
//! whose front the adhesion would let go and one whose front it would pull on lies an equilibrium.

use crate::adhesion::Branch;
use crate::equilibrium::Equilibrium;
use crate::equilibrium::elements::Elements;
use crate::field::Constant;
use crate::front::Fronts;
use crate::obstacle::{Obstacles, Side};
use crate::prediction::is_clear;
use crate::problem::Membrane;
use crate::refinement::Refinement;
use crate::report::Report;
use crate::solution::{Reason, Solution, Start};
use crate::zone::{Zone, is_free};
use signorini_geometry::Point;
use signorini_solve::{Silent, SolveError};
use std::sync::Arc;

/// Sizes that are tried, in one dimension and in two.
const SIZES: [usize; 2] = [32, 8];
/// States whose areas differ by less than this fraction of the membrane's are one.
const SAME: f64 = 1e-5;

/// Another equilibrium.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OtherState {
    pub area: f64,
    /// Energy with that of adhesion.
    pub energy_total: f64,
    pub stable: bool,
}

/// The equilibria beside one with a known area of contact, by growing area. Without `zones` only the membrane without
/// contact is looked at, which costs one solve.
pub fn others<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    refinement: &Refinement<D>,
    known: f64,
    zones: bool,
) -> Result<Vec<OtherState>, SolveError> {
    if membrane.obstacles.is_empty() {
        return Ok(Vec::new());
    }
    let mut elements = Elements::new(membrane);
    let none = Z::empty(&membrane.grid);
    let free = Equilibrium::solve(membrane, &none, &mut elements)?;
    let whole: f64 = {
        let mut area = 0.0;
        free.for_each_point(|_, _, _, w| area += w);
        area
    };
    let mut states: Vec<OtherState> = Vec::new();
    let mut known = vec![known];
    let mut add = |state: OtherState| {
        let other = |a: &f64| (a - state.area).abs() > SAME * whole || (*a == 0.0) != (state.area == 0.0);
        if known.iter().all(other) {
            known.push(state.area);
            states.push(state);
        }
    };
    if is_clear(&free, &none) {
        add(OtherState { area: 0.0, energy_total: energy(&free), stable: true });
    }
    if zones {
        for family in families(membrane, &free, &mut elements)? {
            for zone in near_equilibria(membrane, &family, &mut elements)? {
                let start = Start::Asked(zone, Branch::Nearest);
                let solution: Solution<D, Z> =
                    refinement.solve(membrane, &mut elements, start, None, (0, 0.0), &mut Silent);
                if let (Reason::Converged, Some(report)) = (&solution.reason, Report::new(&solution)) {
                    add(OtherState {
                        area: report.area(),
                        energy_total: report.energy_total(),
                        stable: solution.lowest_eigenvalue.is_some_and(|v| v > 0.0),
                    });
                }
            }
        }
    }
    states.sort_by(|a, b| a.area.total_cmp(&b.area));
    Ok(states)
}

/// `∫ T |∇u|² / 2 - f u` of a membrane without contact.
fn energy<const D: usize>(free: &Equilibrium<D>) -> f64 {
    let membrane = &free.membrane;
    let mut sum = 0.0;
    free.for_each_point(|cell, region, x, w| {
        if let Some((u, gradient)) = free.evaluate(cell, region, x).filter(|_| is_free(region)) {
            sum += w * (0.5 * membrane.tension.value(x) * gradient.norm_squared() - membrane.load.value(x) * u);
        }
    });
    sum
}

/// Zones of growing size: below the levels of the gap of the free membrane, and above those of its softness, the
/// deflection under a unit load.
fn families<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    free: &Equilibrium<D>,
    elements: &mut Elements<D>,
) -> Result<Vec<Vec<Z>>, SolveError> {
    let grid = &membrane.grid;
    let none = Z::empty(grid);
    let mut out = Vec::new();
    for_each_level::<D, Z>(membrane, free, elements, &mut |side, level, [low, high]| {
        // In one dimension very small zones too, which cost little there.
        let least = 1.0 / (SIZES[D - 1] + 1) as f64;
        let tiny = (1..=if D == 1 { 4 } else { 0 }).rev().map(|k| least * 0.5f64.powi(k));
        let family = tiny.chain((1..=SIZES[D - 1]).map(|k| k as f64 * least)).map(|part| {
            // The size of a small zone grows with the root of the level.
            let s = low + part * part * (high - low);
            none.united(grid, side, &mut |x| level(x).map_or(1.0, |v| (v - s) / (high - low)))
        });
        out.push(family.filter(|z| !z.is_empty()).collect());
    })?;
    Ok(out)
}

/// A function of position, where there is membrane.
type Level<'a, const D: usize> = &'a dyn Fn(&Point<D>) -> Option<f64>;

/// Visits the functions whose sublevel sets are likely zones, with their ranges.
fn for_each_level<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    free: &Equilibrium<D>,
    elements: &mut Elements<D>,
    visit: &mut dyn FnMut(Side, Level<'_, D>, [f64; 2]),
) -> Result<(), SolveError> {
    let grid = &membrane.grid;
    let none = Z::empty(grid);
    let softness = Membrane { load: Arc::new(Constant(-1.0)), obstacles: Obstacles::default(), ..membrane.clone() };
    let soft = Equilibrium::solve(&softness, &none, elements)?;
    let reach = 2.0 * grid.h();
    let at = |state: &Equilibrium<D>, x: &Point<D>| {
        let x = if membrane.contains(x) { *x } else { membrane.domain.domain.pulled_inside(x, reach)? };
        state.displacement(&none, &x)
    };
    let depth = |x: &Point<D>| at(&soft, x);
    for side in membrane.obstacles.sides() {
        let gap = |x: &Point<D>| Some(membrane.obstacles.gap(side, x, at(free, x)?));
        for level in [&gap as Level<'_, D>, &depth] {
            let (mut low, mut high) = (f64::INFINITY, f64::NEG_INFINITY);
            free.for_each_point(|_, _, x, _| {
                if let Some(v) = level(x) {
                    (low, high) = (low.min(v), high.max(v));
                }
            });
            if high - low > 1e-6 * high.abs().max(low.abs()) {
                visit(side, level, [low, high]);
            }
        }
    }
    Ok(())
}

/// A likely zone of about the given area: where the free membrane comes nearest to the floor, or is softest.
pub fn zone_of_area<const D: usize, Z: Zone<D>>(membrane: &Membrane<D>, area: f64) -> Result<Option<Z>, SolveError> {
    let mut elements = Elements::new(membrane);
    let none = Z::empty(&membrane.grid);
    let free = Equilibrium::solve(membrane, &none, &mut elements)?;
    let mut found = None;
    for_each_level::<D, Z>(membrane, &free, &mut elements, &mut |side, level, [low, high]| {
        if found.is_some() {
            return;
        }
        let mut points = Vec::new();
        free.for_each_point(|_, _, x, w| points.extend(level(x).map(|v| (v, w))));
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut sum = 0.0;
        let s = points.iter().find(|(_, w)| {
            sum += w;
            sum >= area
        });
        let s = s.map_or(high, |p| p.0);
        found = Some(none.united(&membrane.grid, side, &mut |x| level(x).map_or(1.0, |v| (v - s) / (high - low))));
    })?;
    Ok(found.filter(|z| !z.is_empty()))
}

/// The zones next to which the drive of the fronts changes its sign.
fn near_equilibria<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    family: &[Z],
    elements: &mut Elements<D>,
) -> Result<Vec<Z>, SolveError> {
    let mut out = Vec::new();
    let mut last: Option<(f64, &Z)> = None;
    for zone in family {
        let equilibrium = Equilibrium::solve(membrane, zone, elements)?;
        let drive = Fronts::new(&equilibrium, true).drive();
        if let Some((before, smaller)) = last
            && before * drive < 0.0
        {
            out.push(if before.abs() < drive.abs() { smaller.clone() } else { zone.clone() });
        }
        last = Some((drive, zone));
    }
    Ok(out)
}
