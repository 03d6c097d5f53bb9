//! A quarter of a plate with a hole under tension (Kirsch 1898), with the exact tractions on the far sides.

use super::case::Case;
use super::{material, reference};
use signorini_cells::shapes::ball;
use signorini_cells::*;
use signorini_geometry::{Aabb, Matrix, Point, Vector};
use signorini_mechanics::{LinearSolver, Solved};
use std::sync::Arc;

/// Stress about a hole of radius 1 under `σ_xx = 1`.
pub fn stress(x: &Point<2>) -> Matrix<2> {
    let (r2, a) = (1.0 / x.norm_squared(), x[1].atan2(x[0]));
    let r4 = r2 * r2;
    let radial = 0.5 * (1.0 - r2) + 0.5 * (1.0 - 4.0 * r2 + 3.0 * r4) * (2.0 * a).cos();
    let hoop = 0.5 * (1.0 + r2) - 0.5 * (1.0 + 3.0 * r4) * (2.0 * a).cos();
    let shear = -0.5 * (1.0 + 2.0 * r2 - 3.0 * r4) * (2.0 * a).sin();
    let turn = Matrix::<2>::new(a.cos(), -a.sin(), a.sin(), a.cos());
    turn * Matrix::<2>::new(radial, shear, shear, hoop) * turn.transpose()
}

/// Displacement in plane strain, `E = 1`, `ν = 0.3`.
pub fn displacement(x: &Point<2>) -> Vector<2> {
    let (r, a, kappa, mu) = (x.norm(), x[1].atan2(x[0]), 3.0 - 4.0 * 0.3, 0.5 / 1.3);
    let (r1, r3) = (2.0 / r, 2.0 / r.powi(3));
    let along = r * (kappa + 1.0) * a.cos() + r1 * ((1.0 + kappa) * a.cos() + (3.0 * a).cos()) - r3 * (3.0 * a).cos();
    let across = r * (kappa - 3.0) * a.sin() + r1 * ((1.0 - kappa) * a.sin() + (3.0 * a).sin()) - r3 * (3.0 * a).sin();
    Vector::<2>::new(along, across) / (8.0 * mu)
}

pub fn plate(radius: f64, n: usize, setup: Discretisation<2>, space: Space) -> CellBody<2> {
    let b = Aabb::new(Point::<2>::zeros(), Point::<2>::repeat(4.0));
    let hole = Domain::shape(ball(Point::<2>::zeros(), radius));
    let domain = Domain::Complement(Box::new(hole));
    CellBody::new(Arc::new(domain), CellTree::new(b, [n, n]).unwrap(), setup, material(space)).unwrap()
}

/// Symmetry on the near sides, exact tractions on the far ones.
pub fn loaded(body: &CellBody<2>) -> Case<2> {
    (0..2).fold(Case::new(body).symmetric(&[0, 1]), |case, axis| {
        let normal = Vector::<2>::from_fn(|k, _| f64::from(u8::from(k == axis)));
        case.traction(Place::high(axis), move |x| stress(x) * normal)
    })
}

/// Relative error of the energy.
fn energy_error(n: usize, setup: Discretisation<2>, space: Space, exact: f64) -> (f64, usize, f64) {
    let body = plate(1.0, n, setup, space);
    let found = loaded(&body).solve().unwrap();
    let top = Point::<2>::y();
    let peak = body.state_at(body.cell_at(&top).unwrap(), &top, found.displacement()).stress[(0, 0)];
    (1.0 - found.result.energy / exact, body.unknowns(), peak)
}

#[test]
fn energies_are_those_of_an_independent_code() {
    let data = &reference()["kirsch"];
    let exact = data["strain_energy_plane_strain"]["value"].as_f64().unwrap();
    for row in data["table"].as_array().unwrap() {
        let (n, p) = (row["N"].as_u64().unwrap() as usize, row["p"].as_u64().unwrap() as usize);
        let mut setup = Discretisation { fictitious: 1e-12, ..Discretisation::of_degree(p) };
        match row["tag"].as_str().unwrap() {
            "height_tensor" => {}
            "height_trunk" => setup.products = Products::Trunk,
            _ => continue,
        }
        let (error, unknowns, _) = energy_error(n, setup, Space::PlaneStrain, exact);
        let wanted = row["dU"].as_f64().unwrap();
        // Strong supports take unknowns away in neither code.
        assert_eq!(unknowns as u64, row["ndof"].as_u64().unwrap(), "{row}");
        assert!((error.abs() / wanted - 1.0).abs() < 0.02 + 1e-10 / wanted, "{error:e}: {row}");
    }
}

/// Chords change the body: the error of the energy ends at that of the area of the hole, whatever the degree, and falls
/// with the square of the sub-cells.
#[test]
fn sub_cells_have_a_floor_of_geometry() {
    let exact = reference()["kirsch"]["strain_energy_plane_strain"]["value"].as_f64().unwrap();
    let error = |degree: usize, integration: Integration| {
        let setup = Discretisation { fictitious: 1e-12, integration, ..Discretisation::of_degree(degree) };
        energy_error(8, setup, Space::PlaneStrain, exact).0
    };
    for degree in [2, 4] {
        let smooth = error(degree, Integration::Exact { points: None });
        let [coarse, fine] = [5, 10].map(|subdivision| error(degree, Integration::SubCells { subdivision }) - smooth);
        println!("sub-cells, degree {degree}: {coarse:e} {fine:e}");
        let sagitta = (0.5f64 / 10.0).powi(2) / 8.0;
        assert!(fine.abs() < sagitta && (2.0..8.0).contains(&(coarse / fine)), "{coarse:e} {fine:e} {sagitta:e}");
    }
}

#[test]
fn plane_stress_and_the_peak_of_the_hoop_stress() {
    let exact = reference()["kirsch"]["strain_energy_plane_stress"]["value"].as_f64().unwrap();
    let setup = Discretisation { fictitious: 1e-12, ..Discretisation::of_degree(6) };
    let (error, _, peak) = energy_error(8, setup, Space::PlaneStress, exact);
    assert!(error > 0.0 && error < 2e-9 && (peak - 3.0).abs() < 3e-3, "{error:e} {peak}");
}

/// The exact displacement imposed on a circle within the body.
#[test]
fn supports_on_the_recovered_boundary_have_the_error_of_the_functions() {
    let data = reference();
    let wanted = data["nitsche_dirichlet"]["errE_p1_to_p5"].as_array().unwrap();
    for (p, wanted) in (1..=5).zip(wanted) {
        let body = plate(1.3, 8, Discretisation::of_degree(p), Space::PlaneStrain);
        let u = loaded(&body).held_at(Place::boundary(|_| true), displacement).displacement();
        let (mut error, mut energy) = (0.0, 0.0);
        body.for_each_volume_point(|cell, x, w| {
            let exact = stress(x);
            let found = body.state_at(cell, x, &u).stress;
            let difference = found.fixed_view::<2, 2>(0, 0) - exact;
            let density = |s: &Matrix<2>| 1.3 * ((s * s).trace() - 0.3 * s.trace().powi(2));
            error += w * density(&difference);
            energy += w * density(&exact);
        });
        let (error, wanted) = ((error / energy).sqrt(), wanted.as_f64().unwrap());
        println!("Nitsche p = {p}: {error:e}, {wanted:e}");
        assert!(error < 1.15 * wanted, "degree {p}: {error:e}, {wanted:e}");
    }
}

/// Conjugate gradients give the same, in a number of iterations that does not depend on grid, degree or cuts.
#[test]
fn iterations_depend_on_nothing() {
    for (n, p) in [(8, 1), (16, 2), (8, 3), (16, 4)] {
        let body = plate(1.0, n, Discretisation::of_degree(p), Space::PlaneStrain);
        let direct = loaded(&body).by(LinearSolver::Direct).displacement();
        let found = loaded(&body).by(LinearSolver::Iterative).solve().unwrap();
        let Solved::Iterative { most_iterations, .. } = found.result.solved else {
            panic!("{:?}", found.result.solved)
        };
        let (iterations, condition) = loaded(&body).iterations();
        println!("{n} cells, degree {p}: {most_iterations}, {iterations} iterations, condition {condition:.1}");
        assert!(
            most_iterations.max(iterations) <= 40 && condition < 25.0,
            "{most_iterations} {iterations} {condition}"
        );
        let apart = direct.iter().zip(found.displacement()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-4, "{apart:e}");
    }
}
