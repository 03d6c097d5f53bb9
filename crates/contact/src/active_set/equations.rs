//! The equations of a set of active rows: what they still lack, and their solution by products with the compliance.

use super::error::ActiveSetError;
use crate::compliance::{Compliance, RowProducts, Solved};
use crate::mortar::WeightedGap;
use crate::softness::{Softness, Spring};
use signorini_solve::SolveError;
use std::cell::OnceCell;

/// What is solved for: rows, how they give way, springs, and the displacement without contact.
pub(super) struct Problem<'a> {
    pub(super) system: &'a dyn Compliance,
    pub(super) rows: &'a [WeightedGap],
    pub(super) soft: &'a [Softness],
    pub(super) springs: &'a [Spring],
    pub(super) load: &'a [f64],
    /// Displacement of the touched unknowns without contact, springs included.
    pub(super) free_at: Vec<f64>,
    /// The weighted gaps with it, and what springs move.
    pub(super) free: Vec<f64>,
    pub(super) products: OnceCell<RowProducts<'a>>,
}

/// Weighted gaps of the active rows, and what the springs lack, from the values of all rows.
pub(super) fn defects(
    problem: &Problem<'_>,
    left: f64,
    active: &[usize],
    values: &[f64],
    (pressures, forces): (&[f64], &[f64]),
) -> Vec<f64> {
    let Problem { rows, soft, .. } = *problem;
    let gap = |(place, &k): (usize, &usize)| {
        let carried = pressures.get(place).copied().unwrap_or(0.0) - soft[k].shift;
        values[k] + soft[k].compliance * carried
    };
    let lack = |(s, spring): (usize, &Spring)| {
        let force = forces.get(s).copied().unwrap_or(0.0);
        values[rows.len() + s] - force / (spring.stiffness * (1.0 - left))
    };
    (active.iter().enumerate().map(gap)).chain(taken(problem, left).iter().enumerate().map(lack)).collect()
}

pub(super) fn by_products<'p, 'a>(problem: &'p Problem<'a>) -> Result<&'p RowProducts<'a>, SolveError> {
    if let Some(known) = problem.products.get() {
        return Ok(known);
    }
    let made = RowProducts::new(problem.system, problem.rows, problem.springs)?;
    Ok(problem.products.get_or_init(|| made))
}

/// The size of the traction of every row: one over the root of how it gives way.
pub(super) fn scales(problem: &Problem<'_>, active: &[usize]) -> Result<Vec<f64>, SolveError> {
    let products = by_products(problem)?;
    products.require(active.iter().copied());
    let soft = |r: usize| problem.soft.get(r).map_or(0.0, |s| s.compliance);
    let scale = |own: f64| if own > 0.0 { 1.0 / own.sqrt() } else { 1.0 };
    Ok((0..products.count()).map(|r| scale(products.own(r) + soft(r))).collect())
}

/// The equations of the active rows and of the springs that are taken away, in tractions; those of all other rows are that
/// they carry nothing.
pub(super) fn image<'a>(
    problem: &'a Problem<'_>,
    left: f64,
    active: &'a [usize],
    scale: &'a [f64],
) -> impl Fn(&[f64], &[f64]) -> Vec<f64> + 'a {
    let first = problem.rows.len();
    move |x, wx| {
        let mut out = x.to_vec();
        for &k in active {
            out[k] = scale[k].powi(2) * (wx[k] + problem.soft[k].compliance * x[k]);
        }
        for (s, spring) in taken(problem, left).iter().enumerate() {
            let r = first + s;
            out[r] = scale[r].powi(2) * (wx[r] - x[r] / (spring.stiffness * (1.0 - left)));
        }
        out
    }
}

/// Tractions of all rows and springs that bring the defects of the active ones to zero.
pub(super) fn solved(
    problem: &Problem<'_>,
    left: f64,
    active: &[usize],
    defects: &[f64],
) -> Result<Solved, ActiveSetError> {
    let scale = scales(problem, active)?;
    let mut b = vec![0.0; scale.len()];
    let first = problem.rows.len();
    let wanted = active.iter().copied().chain(first..first + taken(problem, left).len());
    wanted.zip(defects).for_each(|(r, d)| b[r] = -scale[r].powi(2) * d);
    let found = by_products(problem)?.solve(&scale, active, &image(problem, left, active, &scale), &b)?;
    found.ok_or(ActiveSetError::Dependent)
}

/// The springs whose forces are taken away: none while all of them is left.
pub(super) fn taken<'a>(problem: &Problem<'a>, left: f64) -> &'a [Spring] {
    if left < 1.0 { problem.springs } else { &[] }
}
