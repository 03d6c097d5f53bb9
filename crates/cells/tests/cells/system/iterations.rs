//! Newton's steps by iterations against those by factorisation.

use super::contacts::{moved, rigid};
use super::*;
use signorini_cells::shapes::ball;
use signorini_contact::Coulomb;
use signorini_geometry::rigid_shape::Plane;

/// An eighth of a ball between a plate that is moved and one of cells, both touched.
fn pressed(solver: LinearSolver, enforcement: Enforcement, mu: Option<f64>) -> (System, SystemState, IncrementResult) {
    let b = aabb([0.0, 0.0, 0.0], [1.0, 1.0, 1.0]);
    let places = vec![
        ("x", Place::low(0)),
        ("y", Place::low(1)),
        ("top", Place::high(2)),
        ("skin", Place::boundary(|p| p.normal[2] < -0.6)),
    ];
    let body = solid("ball", Domain::shape(ball(Point::<3>::z(), 1.0)), (b, [3; 3]), 2, Space::Solid, places);
    let floor = rigid("floor", Plane { point: Point::<3>::zeros(), normal: Vector::<3>::z() }, moved(v(0.0, 0.0, 0.0)));
    let mut contact =
        Contact::new("touch", (part(0, "skin"), &body), (part(1, ""), &floor), Sampling::GaussPoints, enforcement)
            .unwrap();
    contact.law.friction = mu.map(|mu| Box::new(Coulomb::isotropic(mu).unwrap()) as _);
    let mut system = System {
        supports: vec![
            support(0, "x", [constant(0.0), None, None]),
            support(0, "y", [None, constant(0.0), None]),
            support(0, "top", [None, None, constant(-0.06)]),
        ],
        bodies: vec![Box::new(body), Box::new(floor)],
        contacts: vec![Box::new(contact)],
        solver,
        ..System::default()
    };
    let (state, found) = solve(&mut system);
    (system, state, found)
}

#[test]
fn iterations_find_what_a_factorisation_finds() {
    let penalty = Enforcement::Penalty { wanted_penetration: None };
    for (enforcement, mu) in
        [(penalty, None), (Enforcement::Nitsche, None), (penalty, Some(0.2)), (Enforcement::Nitsche, Some(0.2))]
    {
        let (_, one, by_factor) = pressed(LinearSolver::Direct, enforcement, mu);
        let (_, other, found) = pressed(LinearSolver::Iterative, enforcement, mu);
        assert_eq!(by_factor.solved, Solved::Direct);
        let Solved::Iterative { systems, most_iterations, .. } = found.solved else { panic!("{:?}", found.solved) };
        println!(
            "{enforcement:?} {mu:?}: {systems} systems, at most {most_iterations} iterations, {:?}",
            found.history
        );
        assert!(most_iterations <= 60, "{most_iterations}");
        let size = one.bodies[0].configuration.iter().fold(0.0f64, |m, u| m.max(u.abs()));
        let (a, b) = (&one.bodies[0].configuration, &other.bodies[0].configuration);
        let apart = a.iter().zip(b).fold(0.0f64, |m, (a, b)| m.max((a - b).abs()));
        let force = |f: &IncrementResult| f.sites[0].iter().map(SiteResult::force).sum::<Vector<3>>();
        println!("{} {}", apart / size, (force(&by_factor) - force(&found)).norm() / force(&found).norm());
        assert!(apart < 1e-7 * size, "{}", apart / size);
        assert!((force(&by_factor) - force(&found)).norm() < 1e-8 * force(&found).norm());
    }
}
