//! The quadrature rule of a reference cell, tabulated for its map and its functions.

use crate::cell_map::CellMap;
use crate::hierarchic::{HierarchicBasis, Values};
use crate::rules::{Rule, rule};
use crate::whole_rule::whole_order;

/// A point of a quadrature rule in a reference cell.
pub(super) struct RulePoint {
    pub(super) weight: f64,
    pub(super) map: Values,
    pub(super) functions: Values,
}

pub(super) fn tabulated(map: &CellMap, degree: usize) -> Vec<RulePoint> {
    let basis = HierarchicBasis::new(map.shape(), degree);
    let points: Rule = rule(map.shape(), whole_order(degree) + usize::from(map.order() > 1));
    points
        .into_iter()
        .map(|(x, w)| {
            let mut point = RulePoint { weight: w, map: Values::default(), functions: Values::default() };
            map.tabulate(&x, &mut point.map);
            basis.tabulate(&x, &mut point.functions);
            point
        })
        .collect()
}
