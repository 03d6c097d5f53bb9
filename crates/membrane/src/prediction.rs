//! What is known of a zone before its fronts are: whether there is one, and about where.

use crate::active_set::{self, NodalStart};
use crate::conditions::least_free_gap;
use crate::deferred::Known;
use crate::equilibrium::Equilibrium;
use crate::equilibrium::elements::Elements;
use crate::problem::Membrane;
use crate::scales::Scales;
use crate::zone::Zone;
use signorini_fem::Grid;
use signorini_solve::SolveError;

/// A gap of this fraction of the scale counts as none: without contact nothing but round-off disturbs it.
pub(crate) const FREE: f64 = -1e-10;

/// The zone by the nodal method on linear elements, which is cheap, and cannot go astray however the zone is connected. Its
/// front is true to a fraction of a cell, or of smaller ones where the question is what has merged.
pub(crate) fn prediction<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    known: Option<&Known<'_, D, Z>>,
    interrupted: &dyn Fn() -> bool,
) -> Result<Z, SolveError> {
    let finer = if membrane.cells.degree() >= 3 { 2 } else { 1 };
    let nodal = membrane.on(membrane.cells.linear(finer));
    let solution = active_set::solve_beside::<D, Z>(&nodal, NodalStart::Nested, known, interrupted)?;
    if let Some(sizing) = &membrane.sizing {
        let outlines = |side| {
            let found = nodal.cells.outlines(&solution.predictor(&nodal, side, true));
            found.map(|found| found.into_iter().map(move |outline| (side, outline)).collect::<Vec<_>>())
        };
        if let Some(outlines) = nodal.obstacles.sides().map(outlines).collect::<Option<Vec<_>>>() {
            let linear = Grid::new(*membrane.grid.bounds(), membrane.grid.cells(), 1);
            return Ok(Z::within(&linear, sizing, &outlines.concat()));
        }
    }
    let grid = membrane.samples();
    Ok(nodal.obstacles.sides().fold(Z::empty(&grid), |zone, side| {
        let predictor = solution.predictor(&nodal, side, false);
        zone.united(&grid, side, &mut |x| predictor(x))
    }))
}

/// Whether a membrane without contact would penetrate a body.
pub fn reaches_obstacle<const D: usize, Z: Zone<D>>(
    membrane: &Membrane<D>,
    elements: &mut Elements<D>,
) -> Result<bool, SolveError> {
    if membrane.obstacles.is_empty() {
        return Ok(false);
    }
    let none = Z::empty(&membrane.grid);
    let free = Equilibrium::solve(membrane, &none, elements)?;
    Ok(!is_clear(&free, &none))
}

/// Whether a membrane without contact stays clear of all bodies.
pub(crate) fn is_clear<const D: usize, Z: Zone<D>>(free: &Equilibrium<D>, none: &Z) -> bool {
    least_free_gap(free, none).0 >= FREE * Scales::of_free(free).gap
}
