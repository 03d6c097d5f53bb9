//! An elliptic pore that closes: half of a square plate, pressed from above and below.

use super::{reference, stuff};
use signorini_cells::discs::*;
use signorini_cells::shapes::Ellipsoid;
use signorini_cells::*;
use signorini_geometry::{Aabb, Point};
use std::sync::Arc;

fn close(delta: f64, radius: Option<f64>, centres: Centres) -> (f64, DiscSolution<2>) {
    let b = Aabb::new(Point::<2>::new(0.0, -1.0), Point::<2>::new(1.0, 1.0));
    let pore = Ellipsoid { center: Point::<2>::zeros(), semi_axes: [0.5, 0.1] };
    let domain = Domain::Complement(Box::new(Domain::shape(pore)));
    let setup = Discretisation { refine_narrow: 2, ..Discretisation::of_degree(3) };
    let tree = CellTree::new(b, [8, 16]).unwrap();
    let body = CellBody::new(Arc::new(domain), tree, setup, stuff(Space::PlaneStrain)).unwrap();
    let mut system = System::new(&body);
    system.support(&Support::symmetric(Place::low(0))).unwrap();
    system.support(&Support::component(Place::high(1), 1, -delta)).unwrap();
    system.support(&Support::component(Place::low(1), 1, delta)).unwrap();
    let contact = DiscContact {
        on: Place::boundary(|p| p.x[0] < 0.499),
        spacing: 0.02,
        radius,
        stiffness: 100.0,
        centres,
        increments: 4,
    };
    let found = contact.solve(&system).unwrap();
    (-system.reaction(&found.displacement, 1, End::High, 1).unwrap(), found)
}

#[test]
fn the_force_is_that_of_fitted_elements() {
    let curve = reference()["pore_closure"]["curve"].as_array().unwrap().clone();
    let of = |delta: f64, key: &str| {
        let row = curve.iter().find(|r| (r["delta"].as_f64().unwrap() - delta).abs() < 1e-9);
        row.unwrap_or_else(|| panic!("{delta}"))[key].as_f64().unwrap()
    };
    // Open: no pair touches, not even neighbours.
    let (force, open) = close(0.05, None, Centres::Within);
    println!("pore .05: {force} {}, radius {}, {} discs", of(0.05, "F"), open.radius, open.discs.len());
    assert!(open.pairs.is_empty() && (force / of(0.05, "F") - 1.0).abs() < 2e-3);
    let (force, closed) = close(0.12, None, Centres::Within);
    println!("pore .12: {force} {}, {} pairs, {} iterations", of(0.12, "F"), closed.pairs.len(), closed.iterations);
    assert!(!closed.pairs.is_empty() && (force / of(0.12, "F") - 1.0).abs() < 3e-3);
    // Action and reaction: discs of both faces carry the same.
    let sum: f64 = closed.discs.iter().map(|d| d.pressure * d.site.weight * d.site.normal[1].signum()).sum();
    assert!(sum.abs() < 1e-9, "{sum:e}");
    // Centres on the boundary meet too early, by a radius each.
    let (early, _) = close(0.12, None, Centres::OnBoundary);
    println!("published centres: {early}");
    assert!(early > 1.02 * force);
}
