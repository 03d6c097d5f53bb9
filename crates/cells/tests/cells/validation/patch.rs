//! Patch tests: a linear displacement is reproduced whatever the cut, slivers of a millionth of a cell included, to the
//! share that the fictitious stiffness has in the equations.

use super::case::Case;
use super::material;
use signorini_cells::shapes::HalfSpace;
use signorini_cells::*;
use signorini_geometry::{Aabb, Matrix, Point, Vector};
use std::sync::Arc;

/// The fictitious stiffness, and what of it is left in the displacement.
const FICTITIOUS: f64 = 1e-12;
const BOUND: f64 = 1e3 * FICTITIOUS;

/// How the cut boundary is held.
#[derive(Clone, Copy, PartialEq)]
enum Cut {
    Loaded,
    Held,
}

fn error<const D: usize>(normal: Vector<D>, at: f64, n: usize, degree: usize, cut: Cut, space: Space) -> f64 {
    let b = Aabb::new(Point::<D>::zeros(), Point::<D>::repeat(1.0));
    let normal = normal.normalize();
    let half = HalfSpace { point: normal * at, normal };
    let setup = Discretisation { fictitious: FICTITIOUS, ..Discretisation::of_degree(degree) };
    let tree = CellTree::new(b, [n; D]).unwrap();
    let body = CellBody::new(Arc::new(Domain::shape(half)), tree, setup, material(space)).unwrap();
    let gradient = Matrix::<D>::from_fn(|i, j| 0.3 - 0.1 * i as f64 + 0.25 * j as f64 - 0.2 * (i * j) as f64);
    let exact = move |x: &Point<D>| gradient * x + Vector::<D>::repeat(0.1);
    let mut case = Case::new(&body).held_at(Place::low(0), exact);
    if cut == Cut::Held {
        case = case.held_at(Place::boundary(|_| true), exact);
    }
    // The stress of the linear field, from the body itself at any point.
    let mut in_space = nalgebra::Matrix3::zeros();
    for i in 0..D {
        for j in 0..D {
            in_space[(i, j)] = gradient[(i, j)];
        }
    }
    let full = body.stress_at(&b.center(), &in_space);
    let stress = Matrix::<D>::from_fn(|i, j| full[(i, j)]);
    for axis in 0..D {
        for end in End::BOTH {
            let (e, side) =
                (Vector::<D>::from_fn(|k, _| if k == axis { end.sign() } else { 0.0 }), Place::Side { axis, end });
            // A side beyond the cut has no material.
            if (axis == 0 && end == End::Low) || body.points_on(&side).is_err() {
                continue;
            }
            case = case.traction(side, move |_| stress * e);
        }
    }
    if cut == Cut::Loaded {
        case = case.traction(Place::boundary(|_| true), move |_| stress * normal);
    }
    let u = case.displacement();
    // In the mean square over the material: within a corner sliver of less material than the fictitious stiffness is
    // worth, of a volume of some 1e-15, the displacement is nobody's.
    let mut square = 0.0f64;
    body.for_each_volume_point(|cell, x, w| {
        square += w * (body.state_at(cell, x, &u).displacement - exact(x)).norm_squared();
    });
    square.sqrt()
}

#[test]
fn linear_fields_in_the_plane() {
    for space in [Space::PlaneStrain, Space::PlaneStress] {
        for degree in 1..=4 {
            for (i, depth) in [0.3, 1e-2, 1e-4, 1e-6].into_iter().enumerate() {
                let tilt = 0.17 * i as f64;
                for cut in [Cut::Loaded, Cut::Held] {
                    let straight = error(Vector::<2>::new(1.0, 0.0), 0.75 + 0.25 * depth, 4, degree, cut, space);
                    let tilted = error(Vector::<2>::new(1.0, tilt), 0.75 + 0.25 * depth, 4, degree, cut, space);
                    assert!(straight < BOUND && tilted < BOUND, "{degree} {depth}: {straight:e} {tilted:e}");
                }
            }
        }
    }
}

#[test]
fn linear_fields_in_space() {
    for (degree, depth) in [(1, 1e-6), (2, 0.2), (2, 1e-5)] {
        for cut in [Cut::Loaded, Cut::Held] {
            let normal = Vector::<3>::new(1.0, 0.2, 0.4);
            let straight = error(Vector::<3>::x(), 0.5 + 0.5 * depth, 2, degree, cut, Space::Solid);
            let tilted = error(normal, 0.55 + 0.5 * depth, 2, degree, cut, Space::Solid);
            assert!(straight < BOUND && tilted < BOUND, "{degree} {depth}: {straight:e} {tilted:e}");
        }
    }
}

/// A ball under pressure all around, as a half disc around its axis: `u = -p (1 - 2ν) x / E`.
#[test]
fn a_linear_field_around_an_axis() {
    let b = Aabb::new(Point::<2>::new(0.0, 0.0), Point::<2>::new(1.1, 1.1));
    let ball = signorini_cells::shapes::ball(Point::<2>::zeros(), 0.9);
    let setup = Discretisation { fictitious: 1e-12, ..Discretisation::of_degree(3) };
    let tree = CellTree::new(b, [4, 4]).unwrap();
    let body = CellBody::new(Arc::new(Domain::shape(ball)), tree, setup, material(Space::Axisymmetric)).unwrap();
    let volume = 2.0 / 3.0 * std::f64::consts::PI * 0.729;
    assert!((body.volume() / volume - 1.0).abs() < 1e-10, "{:e}", body.volume() / volume - 1.0);
    let u = Case::new(&body).symmetric(&[0, 1]).pressure(Place::boundary(|_| true), 2.0).displacement();
    for x in [Point::<2>::new(0.3, 0.2), Point::<2>::new(0.6, 0.6)] {
        let state = body.state_at(body.cell_at(&x).unwrap(), &x, &u);
        assert!((state.displacement + x * (2.0 * 0.4)).norm() < 1e-7, "{}", state.displacement);
        assert!((state.stress + nalgebra::Matrix3::identity() * 2.0).norm() < 1e-6, "{}", state.stress);
    }
}
