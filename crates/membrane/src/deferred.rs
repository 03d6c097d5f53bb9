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
pub(crate) struct Known<'a, const D: usize, Z> {
    pub state: &'a Equilibrium<D>,
    pub zone: &'a Z,
}

impl<const D: usize, Z: Zone<D>> Known<'_, D, Z> {
    /// The load of linear elements under which they take the displacement of this state, at nodes in its zone under the
    /// pressure of the body, elsewhere freely: where they are not much smaller than those of the state, and away from its
    /// fronts, which may not be at rest.
    pub fn load(&self, membrane: &Membrane<D>, system: &System<D>, nodes: &[Point<D>]) -> Vec<f64> {
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::active_set::{NodalStart, solve_beside};
    use crate::domain::{Domain, DomainOnCells, ImplicitDomain};
    use crate::equilibrium::Elements;
    use crate::field::{Constant, Formula, SharedField};
    use crate::ils::{self, Reason, Rest, Start};
    use crate::obstacle::{Obstacle, Obstacles, Side};
    use crate::plane_zone::PlaneZone;
    use crate::problem::{Measure, Support};
    use signorini_fem::Grid;
    use signorini_geometry::{Aabb, Ellipsoid, Jet, Real};
    use signorini_solve::Silent;
    use std::sync::Arc;

    /// A disc over a wavy floor.
    fn membrane() -> Membrane<2> {
        let bounds = Aabb::new(Point::<2>::new(-1.03, -1.03), Point::<2>::new(1.03, 1.03));
        let grid = Grid::new(bounds, [16, 16], 3);
        let domain: Arc<dyn Domain<2>> =
            Arc::new(ImplicitDomain(Ellipsoid { center: Point::zeros(), semi_axes: [1.0, 1.0] }));
        let c = |v: f64| Jet::<2>::constant(v);
        let wave = move |[x, y]: [Jet<2>; 2]| {
            c(-0.1) - c(0.01) * (c(1.0) - c(6.0) * x * x) * (c(1.0) - c(4.0) * (y - c(0.1)) * y)
        };
        let height: SharedField<2> = Arc::new(Formula(wave));
        Membrane {
            domain: DomainOnCells::new(domain, &grid),
            cells: grid.as_cells(),
            grid,
            sizing: None,
            measure: Measure::Plain,
            tension: Arc::new(Constant(1.0)),
            load: Arc::new(Constant(-1.0)),
            obstacles: Obstacles(vec![Obstacle { side: Side::Below, height, adhesion: None }]),
            supports: vec![Some(Support { index: 0, displacement: Arc::new(Constant(0.0)) })],
            support_count: 1,
            modes: Default::default(),
            formulation: Default::default(),
        }
    }

    #[test]
    fn linear_elements_repeat_what_is_known() {
        let membrane = membrane();
        let mut elements = Elements::new(&membrane);
        let found =
            ils::solve::<2, PlaneZone>(&membrane, &mut elements, Start::Free, Rest::Final, (0, 1.0), &mut Silent);
        assert_eq!(found.reason, Reason::Converged);
        let state = found.equilibrium.expect("a state");
        let known = Known { state: &state, zone: &found.zone };
        let linear = membrane.on(membrane.cells.linear(1));
        let off = |known: Option<&Known<'_, 2, PlaneZone>>| {
            let nodal = solve_beside(&linear, NodalStart::Nested, known, &|| false).expect("a solution");
            assert!(nodal.converged);
            let nodes =
                nodal.nodes.iter().enumerate().filter_map(|(i, node)| node.filter(|n| n.inside).map(|n| (i, n)));
            let differ = nodes.map(|(i, node)| {
                let u = state.displacement(&found.zone, &linear.cells.node(i)).expect("within the membrane");
                (node.displacement - u).abs()
            });
            differ.fold(0.0, f64::max)
        };
        let (plain, corrected) = (off(None), off(Some(&known)));
        assert!(corrected < 0.2 * plain, "{corrected:e} against {plain:e}");
    }
}
