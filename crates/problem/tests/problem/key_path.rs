//! The way to a part of a problem.

use signorini_problem::{Body, Domain, GridMesh, Interval, Membrane, Mesh, Problem, Space, Step, Support};

#[test]
fn the_way_to_a_part_is_found_by_where_it_lies() {
    let mut problem = Problem::new(Space::Line);
    let grid = GridMesh { cells: Some([20].into()), ..GridMesh::default() };
    let domain = Domain::Interval(Interval { from: (-1.0).into(), to: 1.0.into() });
    let film = Membrane { domain: Some(domain), mesh: Mesh::Grid(grid), degree: Some(2), tension: 1.0.into() };
    problem.bodies.insert("film".into(), Body::Membrane(film));
    let rim = Support { on: "film:boundary".into(), displacement: Some(0.0.into()), ..Support::default() };
    problem.supports.insert("rim".into(), rim);
    problem.steps.extend([Step::default(), Step { events: Some(1.0), ..Step::default() }]);
    let Some(Body::Membrane(film)) = problem.bodies.get("film") else { panic!("a membrane") };
    assert_eq!(problem.key(&film.tension).to_string(), "bodies.film.membrane.tension");
    assert_eq!(problem.key(film).to_string(), "bodies.film.membrane");
    let Some(Domain::Interval(interval)) = &film.domain else { panic!("an interval") };
    // The first part of a whole lies where the whole does, and is another type.
    assert_eq!(problem.key(interval).to_string(), "bodies.film.membrane.domain.interval");
    assert_eq!(problem.key(&interval.from).to_string(), "bodies.film.membrane.domain.interval.from");
    let Mesh::Grid(grid) = &film.mesh else { panic!("a grid") };
    let cells = grid.cells.as_ref().expect("cells");
    assert_eq!(problem.key(cells).to_string(), "bodies.film.membrane.mesh.grid.cells");
    assert_eq!(problem.key(&cells[0]).to_string(), "bodies.film.membrane.mesh.grid.cells[0]");
    assert_eq!(problem.key(problem.steps[1].events.as_ref().expect("events")).to_string(), "steps[1].events");
    let displacement = problem.supports["rim"].displacement.as_ref().expect("one");
    assert_eq!(problem.key(&displacement.0[0]).to_string(), "supports.rim.displacement");
}
