//! Linear elements as accurate as the elements of a state at hand: the load is changed by what they get wrong of that state.
//!
//! (Deferred correction: Stetter, Numer. Math. 29, 1978; the τ of a full approximation scheme, Brandt, Math. Comp. 31, 1977.)
//! Else the tips of zones that are about to merge would lag behind by many cells.

use crate::equilibrium::Equilibrium;
use crate::equilibrium::system::System;
use crate::problem::Membrane;
use crate::quadrature::{FrontPoint, Quadrature};
use crate::zone::{Zone, contact_of};
use signorini_fem::lagrange::Tabulation;
use signorini_geometry::Point;

/// On cells smaller than this part of its own a state tells nothing that linear elements do not.
const SMALLEST: f64 = 0.4;

/// A state and its zone, whose fronts need not be at rest.
pub struct Known<'a, const D: usize, Z> {
    pub state: &'a Equilibrium<D>,
    pub zone: &'a Z,
}

impl<const D: usize, Z: Zone<D>> Known<'_, D, Z> {
    /// The load of linear elements under which they take the displacement of this state, at nodes in its zone under the
    /// pressure of the body, elsewhere freely: where they are not much smaller than those of the state, and away from its
    /// fronts, which may not be at rest.
    pub(crate) fn load(&self, membrane: &Membrane<D>, system: &System<D>, nodes: &[Point<D>]) -> Vec<f64> {
        let mut displacements: Vec<Option<f64>> = nodes.iter().map(|x| self.displacement(x, x)).collect();
        for (cell, _, dofs) in system.unknowns.all() {
            let center = membrane.cells.bounds_of(cell).center();
            for &i in dofs {
                // Nodes beyond the membrane have the displacement of cells that it cuts.
                let i = i as usize;
                displacements[i] = displacements[i].or_else(|| self.displacement(&nodes[i], &center));
            }
        }
        let values: Vec<f64> = displacements.iter().map(|u| u.unwrap_or(0.0)).collect();
        let mut load = system.matrix.multiply(&values);
        let quadrature = Quadrature::new(membrane, self.zone);
        let mut told: Vec<bool> = displacements.iter().map(Option::is_some).collect();
        let pressed: Vec<bool> = nodes.iter().map(|x| contact_of(self.zone.region_at(x)).is_some()).collect();
        let mut t = Tabulation::default();
        for (cell, _, dofs) in system.unknowns.all() {
            let own = &self.state.membrane.cells;
            let size = own.containing(&membrane.cells.bounds_of(cell).center()).map_or(0.0, |cell| own.size(cell));
            let small = membrane.cells.size(cell) < SMALLEST * size;
            let volumes = quadrature.volumes(membrane, cell);
            if small || dofs.iter().any(|i| displacements[*i as usize].is_none()) {
                dofs.iter().for_each(|&i| told[i as usize] = false);
            }
            for (region, points) in volumes {
                let Some((side, _)) = contact_of(region) else { continue };
                for p in points.iter() {
                    membrane.cells.tabulate(cell, &p.x, &mut t);
                    let force = p.weight * side.sign() * membrane.pressure(side, &p.x);
                    for (&i, v) in dofs.iter().zip(&t.value).filter(|(i, _)| pressed[**i as usize]) {
                        load[i as usize] -= force * v;
                    }
                }
            }
        }
        for p in &quadrature.front {
            let Some((_, dofs)) = system.unknowns.of_cell(p.cell).next() else { continue };
            membrane.cells.tabulate(p.cell, &p.x, &mut t);
            let force = p.weight * self.kink(p);
            for (&i, v) in dofs.iter().zip(&t.value) {
                load[i as usize] += force * v;
            }
        }
        let changed = load.into_iter().zip(&system.rhs).zip(told);
        changed.map(|((load, plain), told)| if told { load } else { *plain }).collect()
    }

    /// The force per length that would hold the kink of the displacement at a point of a front.
    fn kink(&self, p: &FrontPoint<D>) -> f64 {
        let membrane = &self.state.membrane;
        let evaluated = membrane.cells.containing(&p.x).and_then(|cell| self.state.evaluate(cell, p.free, &p.x));
        let slope = membrane.obstacles.jet(p.side, &p.x).gradient;
        evaluated.map_or(0.0, |(_, gradient)| membrane.tension.value(&p.x) * (gradient - slope).dot(&p.normal))
    }

    /// The displacement at a point as the cell at another place has it.
    fn displacement(&self, x: &Point<D>, near: &Point<D>) -> Option<f64> {
        let region = self.zone.region_at(x);
        match contact_of(region) {
            Some((side, _)) => Some(self.state.membrane.obstacles.height(side, x)),
            None => self.state.evaluate(self.state.membrane.cells.containing(near)?, region, x).map(|v| v.0),
        }
    }
}
