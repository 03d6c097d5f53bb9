//! The ghost penalty: pairs of neighbouring cells, and how much they need each other.

use super::elements::Elements;
use super::unknowns::Unknowns;
use crate::method::Formulation;
use crate::problem::Membrane;
use crate::quadrature::{Cell, Quadrature};
use signorini_fem::cut::RegionId;
use std::collections::HashMap;

/// Weight of the ghost penalty at a sliver; smaller ones lose positive definiteness when a straight boundary cuts slivers only.
pub(crate) fn ghost_weight(degree: usize) -> f64 {
    if degree == 1 { 0.5 } else { 0.2 }
}

/// What is left of that weight at a sliver of no size: enough for round-off.
const LEAST: f64 = 1e-4;

/// Two neighbouring cells whose polynomials a ghost penalty holds together.
pub(crate) struct GhostPair {
    /// Among the neighbours of the elements.
    pub number: usize,
    pub region: RegionId,
    pub dofs: Vec<u32>,
    pub cells: [usize; 2],
    lean: GhostWeight,
    measure: f64,
    pub tension: f64,
}

impl GhostPair {
    /// By how much they need it.
    pub fn need(&self) -> f64 {
        self.measure * self.lean.need()
    }

    /// How fast that changes as shares and lengths do.
    pub fn need_rate(&self, shares: [f64; 2], held: [f64; 2]) -> f64 {
        self.measure * self.lean.rate(shares, held)
    }
}

/// How much two neighbouring cells need each other. A full cell needs no help, a sliver as much as it is held along: the
/// method of Nitsche leans on no more. The weight is continuous in the cut, also as slivers come and go whose neighbours would
/// each have them be different, so the slope jump is continuous in the front.
pub(crate) struct GhostWeight {
    /// What the region fills of each cell.
    shares: [f64; 2],
    /// Along which part of a side each cell is held, at most along a whole one.
    held: [f64; 2],
}

impl GhostWeight {
    fn need(&self) -> f64 {
        let [a, b] = self.shares;
        let along = self.along();
        (1.0 - a.min(b)).powi(2) * (LEAST + (1.0 - LEAST) * along * (2.0 - along))
    }

    /// Of the two the smaller counts more.
    fn along(&self) -> f64 {
        let ([a, b], [of_a, of_b]) = (self.shares, self.held);
        (of_a * b + of_b * a) / (a + b).max(f64::MIN_POSITIVE)
    }

    fn rate(&self, shares: [f64; 2], held: [f64; 2]) -> f64 {
        let ([a, b], [of_a, of_b]) = (self.shares, self.held);
        let along = self.along();
        let smaller = if a < b { shares[0] } else { shares[1] };
        let grows = held[0] * b + of_a * shares[1] + held[1] * a + of_b * shares[0] - along * (shares[0] + shares[1]);
        let along_rate = grows / (a + b).max(f64::MIN_POSITIVE);
        let missing = 1.0 - a.min(b);
        let leant = LEAST + (1.0 - LEAST) * along * (2.0 - along);
        -2.0 * missing * smaller * leant + missing.powi(2) * (1.0 - LEAST) * 2.0 * (1.0 - along) * along_rate
    }
}

pub(crate) fn ghost_pairs<const D: usize>(
    membrane: &Membrane<D>,
    elements: &Elements<D>,
    quadrature: &Quadrature<D>,
    unknowns: &Unknowns,
) -> Vec<GhostPair> {
    let mut pairs = Vec::new();
    let is_cut = |cell: usize| matches!(quadrature.cells[cell], Cell::Cut(_));
    let held = held_along(membrane, quadrature);
    for (number, neighbours) in elements.neighbours.iter().enumerate() {
        let [lower, upper] = neighbours.cells;
        if !is_cut(lower) && !is_cut(upper) {
            continue;
        }
        for (region, dofs) in unknowns.of_cell(lower) {
            let Some(others) = unknowns.of(upper, region) else { continue };
            // The coefficients where the region is; outside the membrane they may not be defined.
            let x = [lower, upper]
                .iter()
                .find_map(|&cell| match &quadrature.cells[cell] {
                    Cell::Whole(_) => Some(membrane.cells.bounds_of(cell).center()),
                    Cell::Cut(rule) => rule.volume(region).first().map(|p| p.x),
                    Cell::Outside => None,
                })
                .unwrap_or_else(|| membrane.cells.bounds_of(lower).center());
            let lean = GhostWeight {
                shares: neighbours.cells.map(|cell| share(membrane, quadrature, cell, region)),
                held: neighbours.cells.map(|cell| held.get(&cell).map_or(1.0, |along| along.min(1.0))),
            };
            let (measure, tension) = (membrane.measure.weight(&x), membrane.tension.value(&x));
            pairs.push(GhostPair {
                number,
                region,
                dofs: [dofs, others].concat(),
                cells: neighbours.cells,
                lean,
                measure,
                tension,
            });
        }
    }
    pairs
}

/// Along which part of a side the displacement is imposed in each cell; with multipliers slivers lean on other things.
fn held_along<const D: usize>(membrane: &Membrane<D>, quadrature: &Quadrature<D>) -> HashMap<usize, f64> {
    let mut along = HashMap::new();
    if membrane.formulation != Formulation::OneSided {
        return along;
    }
    let fronts = quadrature.front.iter().map(|p| (p.cell, p.x, p.weight));
    let rim = quadrature.rim.iter().map(|p| (p.cell, p.x, p.weight));
    for (cell, x, weight) in fronts.chain(rim) {
        let side = membrane.cells.volume(cell) / membrane.cells.size(cell);
        *along.entry(cell).or_insert(0.0) += weight / membrane.measure.weight(&x) / side;
    }
    along
}

/// The share of a cell that a region fills.
pub(crate) fn share<const D: usize>(
    membrane: &Membrane<D>,
    quadrature: &Quadrature<D>,
    cell: usize,
    region: RegionId,
) -> f64 {
    match &quadrature.cells[cell] {
        Cell::Cut(rule) => {
            let volume: f64 = rule.volume(region).iter().map(|p| p.weight / membrane.measure.weight(&p.x)).sum();
            (volume / membrane.cells.volume(cell)).min(1.0)
        }
        _ => 1.0,
    }
}
