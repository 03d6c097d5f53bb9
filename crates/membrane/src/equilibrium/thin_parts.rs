//! Parts of the free membrane that no cell holds well.
//!
//! The strip between a front and a free edge beside it may consist of slivers only. The method of Nitsche then has no flux
//! to lean on, however the ghost penalty ties the slivers together, and the equations are not positive definite. Such parts
//! come and go while fronts move; a stiffness beyond the membrane holds them meanwhile.

use super::elements::{Elements, add_stiffness};
use super::ghost::share;
use super::unknowns::Unknowns;
use crate::problem::Membrane;
use crate::quadrature::{Cell, Quadrature};
use signorini_fem::lagrange::Tabulation;
use signorini_solve::SymmetricMatrix;
use std::collections::BTreeMap;

/// Stiffens the parts that fill no cell to the share `needed`, as if their cells were filled to it.
pub(crate) fn hold_thin_parts<const D: usize>(
    membrane: &Membrane<D>,
    elements: &Elements<D>,
    quadrature: &Quadrature<D>,
    unknowns: &Unknowns,
    matrix: &mut SymmetricMatrix,
    needed: f64,
) {
    // Fronts and the boundary may cut a region into parts that have no unknowns in common.
    let part = parts(unknowns);
    let mut best: BTreeMap<u32, f64> = BTreeMap::new();
    for (cell, region, dofs) in unknowns.all() {
        let most = best.entry(part[dofs[0] as usize]).or_insert(0.0);
        if *most < needed {
            *most = most.max(share(membrane, quadrature, cell, region));
        }
    }
    best.retain(|_, share| *share < needed);
    if best.is_empty() {
        return;
    }
    let mut scratch = Tabulation::default();
    for (cell, region, dofs) in unknowns.all() {
        let Some(share) = best.get(&part[dofs[0] as usize]) else { continue };
        // Beyond the membrane the tension may not be defined.
        let within = match &quadrature.cells[cell] {
            Cell::Cut(rule) => rule.volume(region).first().map(|p| p.x),
            _ => None,
        };
        let x = within.unwrap_or_else(|| membrane.cells.bounds_of(cell).center());
        let scale = (needed - share) * membrane.tension.value(&x) * membrane.measure.weight(&x);
        let mut local = vec![0.0; dofs.len() * dofs.len()];
        for (i, p) in membrane.cells.rule(cell).iter().enumerate() {
            let t = match elements.of(membrane, cell) {
                Some(element) => &element.tabulated[i],
                None => {
                    membrane.cells.tabulate(cell, &p.x, &mut scratch);
                    &scratch
                }
            };
            add_stiffness(&mut local, t, p.weight);
        }
        matrix.add(dofs, &local, scale);
    }
}

/// For each unknown the least number of those that it hangs together with.
fn parts(unknowns: &Unknowns) -> Vec<u32> {
    fn root(part: &mut [u32], mut i: u32) -> u32 {
        while part[i as usize] != i {
            part[i as usize] = part[part[i as usize] as usize];
            i = part[i as usize];
        }
        i
    }
    let mut part: Vec<u32> = (0..unknowns.count as u32).collect();
    for (_, _, dofs) in unknowns.all() {
        for pair in dofs.windows(2) {
            let (a, b) = (root(&mut part, pair[0]), root(&mut part, pair[1]));
            part[a.max(b) as usize] = a.min(b);
        }
    }
    (0..unknowns.count as u32).map(|i| root(&mut part, i)).collect()
}
