//! Of `deferred`.

use signorini_fem::Grid;
use signorini_geometry::{Aabb, Ellipsoid, Jet, Point, Real};
use signorini_membrane::active_set::{NodalStart, solve_beside};
use signorini_membrane::domain::{Domain, DomainOnCells, ImplicitDomain};
use signorini_membrane::equilibrium::Elements;
use signorini_membrane::field::{Constant, Formula, SharedField};
use signorini_membrane::ils::{self, Reason, Start, StoppingRule};
use signorini_membrane::obstacle::{Obstacle, Obstacles, Side};
use signorini_membrane::plane_zone::PlaneZone;
use signorini_membrane::problem::{Measure, Membrane, Support};
use signorini_membrane::testing::Known;
use signorini_solve::Silent;
use std::sync::Arc;

/// A disc over a wavy floor.
fn membrane() -> Membrane<2> {
    let bounds = Aabb::new(Point::<2>::new(-1.03, -1.03), Point::<2>::new(1.03, 1.03));
    let grid = Grid::new(bounds, [16, 16], 3);
    let domain: Arc<dyn Domain<2>> =
        Arc::new(ImplicitDomain(Ellipsoid { center: Point::zeros(), semi_axes: [1.0, 1.0] }));
    let c = |v: f64| Jet::<2>::constant(v);
    let wave =
        move |[x, y]: [Jet<2>; 2]| c(-0.1) - c(0.01) * (c(1.0) - c(6.0) * x * x) * (c(1.0) - c(4.0) * (y - c(0.1)) * y);
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
        ils::solve::<2, PlaneZone>(&membrane, &mut elements, Start::Free, StoppingRule::Final, (0, 1.0), &mut Silent);
    assert_eq!(found.reason, Reason::Converged);
    let state = found.equilibrium.expect("a state");
    let known = Known { state: &state, zone: &found.zone };
    let linear = membrane.on(membrane.cells.linear(1));
    let off = |known: Option<&Known<'_, 2, PlaneZone>>| {
        let nodal = solve_beside(&linear, NodalStart::Nested, known, &|| false).expect("a solution");
        assert!(nodal.converged);
        let nodes = nodal.nodes.iter().enumerate().filter_map(|(i, node)| node.filter(|n| n.inside).map(|n| (i, n)));
        let differ = nodes.map(|(i, node)| {
            let u = state.displacement(&found.zone, &linear.cells.node(i)).expect("within the membrane");
            (node.displacement - u).abs()
        });
        differ.fold(0.0, f64::max)
    };
    let (plain, corrected) = (off(None), off(Some(&known)));
    assert!(corrected < 0.2 * plain, "{corrected:e} against {plain:e}");
}
