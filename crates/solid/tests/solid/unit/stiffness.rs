//! Identities of stiffness and loads, on boxes small enough to know all of them.

use nalgebra::Matrix3;
use signorini_fem::DofMap;
use signorini_fem::block::block;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::*;
use signorini_solid::{Elastic, SolidBody, SolidMaterial, Space, StressLaw};
use std::sync::Arc;

const ELASTIC: Elastic = Elastic { youngs_modulus: 2.0, poissons_ratio: 0.3 };

/// A box of 2 × 3 (× 2) cells, 1 × 1.5 (× 0.8), mapped.
fn solid<const D: usize>(
    space: Space,
    degree: usize,
    map: impl Fn(Point<D>) -> Point<D>,
) -> (SolidBody<D>, Arc<signorini_fem::Mesh<D>>) {
    let axes = std::array::from_fn(|k| [vec![0.0, 0.4, 1.0], vec![0.0, 0.5, 1.1, 1.5], vec![0.0, 0.3, 0.8]][k].clone());
    let mesh = Arc::new(block::<D>(&axes, 1, map));
    let law = (ELASTIC, StressLaw::LinearElastic);
    let groups = mesh.groups().clone();
    (SolidBody::new("box", Arc::clone(&mesh), degree, law, space, groups).unwrap(), mesh)
}

fn sheared<const D: usize>(x: Point<D>) -> Point<D> {
    Point::<D>::from_fn(|k, _| x[k] + 0.3 * x[(k + 1) % D] + if k == 0 { 2.0 } else { 0.0 })
}

/// The coefficients of an affine displacement: its values at vertices, and nothing of higher functions.
fn affine<const D: usize>(
    (body, mesh): (&SolidBody<D>, &signorini_fem::Mesh<D>),
    degree: usize,
    u: impl Fn(&Point<D>) -> Point<D>,
) -> BodyState {
    let mut state = body.start();
    let dofs = DofMap::new(mesh, degree);
    for (node, x) in mesh.nodes().iter().enumerate() {
        if let Some(f) = dofs.vertex(node as u32) {
            (0..D).for_each(|i| state.configuration[f as usize * D + i] = u(x)[i]);
        }
    }
    state
}

/// Energy and forces of a state.
fn internal<const D: usize>(body: &SolidBody<D>, state: &BodyState) -> (f64, Vec<f64>) {
    let mut out = Contribution::new(body.unknowns());
    let energy = body.internal(state, Order::First, &mut out).unwrap();
    (energy, out.forces)
}

/// The energy of a uniform strain is that of its stress, and its forces are on the boundary only.
fn uniform_strain<const D: usize>(space: Space, degree: usize) {
    let (body, mesh) = solid::<D>(space, degree, sheared);
    let mut h = Matrix3::zeros();
    for i in 0..D {
        for j in 0..D {
            h[(i, j)] = 0.01 * (1.0 + i as f64) - 0.02 * j as f64;
        }
    }
    let state = affine((&body, &mesh), degree, |x| Point::<D>::from_fn(|i, _| (0..D).map(|j| h[(i, j)] * x[j]).sum()));
    let (energy, forces) = internal(&body, &state);
    let mut strain = 0.5 * (h + h.transpose());
    let stress = ELASTIC.stress(space, &h);
    if space == Space::PlaneStress {
        strain[(2, 2)] = -ELASTIC.poissons_ratio / ELASTIC.youngs_modulus * (stress[(0, 0)] + stress[(1, 1)]);
        assert_eq!(stress[(2, 2)], 0.0);
    }
    let cube: f64 = if D == 2 { 1.5 } else { 1.2 };
    let sheared: f64 = if D == 2 { 1.0 - 0.3 * 0.3 } else { 1.0 + 0.3f64.powi(3) };
    let exact = 0.5 * stress.dot(&strain) * cube * sheared;
    assert!((energy / exact - 1.0).abs() < 1e-12, "{space:?} of degree {degree}: {energy}, {exact}");
    let dofs = DofMap::new(&mesh, degree);
    let on_side = |side: &signorini_fem::Side| {
        let list = dofs.functions(side.cell as usize).to_vec();
        dofs.on_side(*side).into_iter().map(move |k| list[k] as usize)
    };
    let boundary: std::collections::BTreeSet<usize> = mesh.boundary().iter().flat_map(on_side).collect();
    for k in (0..body.unknowns()).filter(|k| !boundary.contains(&(k / D))) {
        assert!(forces[k].abs() < 1e-14, "unknown {k}: {}", forces[k]);
    }
}

#[test]
fn uniform_strains_have_their_energy_and_no_force_within() {
    for degree in [1, 2, 3] {
        uniform_strain::<2>(Space::PlaneStrain, degree);
        uniform_strain::<2>(Space::PlaneStress, degree);
    }
    for degree in [1, 2] {
        uniform_strain::<3>(Space::Solid, degree);
    }
}

/// A radial displacement `a r` and an axial one `b z`: `ε_r = ε_θ = a`, `ε_z = b`, all uniform.
#[test]
fn a_ring_that_grows_has_hoop_strain() {
    let (a, b) = (0.02, -0.01);
    for degree in [1, 2] {
        let (body, mesh) = solid::<2>(Space::Axisymmetric, degree, |x| Point::<2>::new(x[0] + 1.0, x[1]));
        let (energy, _) = internal(&body, &affine((&body, &mesh), degree, |x| Point::<2>::new(a * x[0], b * x[1])));
        let (lambda, mu) = ELASTIC.lame(Space::Axisymmetric);
        let density = 0.5 * lambda * (2.0 * a + b).powi(2) + mu * (2.0 * a * a + b * b);
        let exact = density * std::f64::consts::PI * (4.0 - 1.0) * 1.5;
        assert!((energy / exact - 1.0).abs() < 1e-12, "degree {degree}: {energy}, {exact}");
    }
}

#[test]
fn rigid_motions_meet_no_force() {
    fn check<const D: usize>(space: Space) {
        let (body, mesh) = solid::<D>(space, 2, sheared);
        let modes = body.rigid_modes(&body.start());
        let strained = affine((&body, &mesh), 2, |x| *x);
        let most = internal(&body, &strained).1.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        for mode in modes.iter().filter(|m| m.iter().any(|v| *v != 0.0)) {
            let state = BodyState { configuration: mode.clone(), ..body.start() };
            let worst = internal(&body, &state).1.iter().fold(0.0f64, |m, f| m.max(f.abs()));
            assert!(worst < 1e-13 * most, "{worst:e}");
        }
    }
    check::<2>(Space::PlaneStress);
    check::<3>(Space::Solid);
}

/// A pressure on the whole boundary has no resultant, one on a side pushes it inwards, and a body force counts by volume; a bed
/// of springs under a push is a spring for each area, along its own direction only.
#[test]
fn loads_have_their_resultants() {
    let (body, _) = solid::<3>(Space::Solid, 2, |x| x);
    let modes = body.rigid_modes(&body.start());
    let resultant = |on: Option<&str>, load: Load<'_>, state: &BodyState| {
        let mut out = Contribution::new(body.unknowns());
        body.load(on, &load, state, Order::First, &mut out).unwrap();
        Vector::<3>::from_fn(|i, _| -modes[i].iter().zip(&out.forces).map(|(m, f)| m * f).sum::<f64>())
    };
    let start = body.start();
    let two = |_: &Point<3>| 2.0;
    let vector = |_: &Point<3>| Vector::<3>::new(1.0, 2.0, 3.0);
    let near =
        |found: Vector<3>, exact: [f64; 3]| assert!((found - Vector::<3>::from(exact)).norm() < 1e-13, "{found}");
    near(resultant(Some("boundary"), Load::Pressure(&two), &start), [0.0; 3]);
    near(resultant(Some("top"), Load::Pressure(&two), &start), [0.0, 0.0, -2.0 * 1.5]);
    near(resultant(Some("left"), Load::Pressure(&two), &start), [2.0 * 1.5 * 0.8, 0.0, 0.0]);
    near(resultant(Some("top"), Load::Traction(&vector), &start), [1.5, 3.0, 4.5]);
    near(resultant(Some("right"), Load::Force(Vector::<3>::new(1.0, 2.0, 3.0)), &start), [1.0, 2.0, 3.0]);
    near(resultant(None, Load::BodyForce(&vector), &start), [1.2, 2.4, 3.6]);
    let pushed = BodyState { configuration: modes[2].iter().map(|m| 0.1 * m).collect(), ..body.start() };
    near(resultant(Some("bottom"), Load::Springs(Vector::<3>::new(0.0, 5.0, 7.0)), &pushed), [0.0, 0.0, -0.7 * 1.5]);
}

/// A material that is told point by point, and the same everywhere, has the forces and the tractions of one that is told once: with
/// the divergence projected and not.
#[test]
fn materials_by_position_are_those_of_each_point() {
    fn check<const D: usize>(space: Space, poissons_ratio: f64, degree: usize) {
        let elastic = Elastic { youngs_modulus: 2.0, poissons_ratio };
        let law = (elastic, StressLaw::LinearElastic);
        let varying = SolidMaterial::varying(law.clone(), Arc::new(move |_| (elastic, StressLaw::LinearElastic)));
        let axes = std::array::from_fn(|k| [vec![0.0, 0.4, 1.0], vec![0.0, 0.5, 1.5], vec![0.0, 0.8]][k].clone());
        let mesh = Arc::new(block::<D>(&axes, 1, sheared));
        let groups = mesh.groups().clone();
        let of = |material: SolidMaterial| {
            SolidBody::new("box", Arc::clone(&mesh), degree, material, space, groups.clone()).unwrap()
        };
        let (once, by_point) = (of(law.into()), of(varying));
        let mut state = once.start();
        state.configuration.iter_mut().enumerate().for_each(|(k, u)| *u = 0.01 * ((k * 7 + 3) % 11) as f64);
        let (energy, forces) = internal(&once, &state);
        let (other, others) = internal(&by_point, &state);
        assert!((energy / other - 1.0).abs() < 1e-12, "{space:?} {energy} {other}");
        let most = forces.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        assert!(forces.iter().zip(&others).all(|(a, b)| (a - b).abs() < 1e-12 * most));
        for site in &once.sites(Some("top"), Sampling::GaussPoints).unwrap() {
            let [a, b] = [&once, &by_point].map(|body| body.traction(&state, site).unwrap());
            assert!((a.vector - b.vector).norm() < 1e-12 && a.functions.len() == b.functions.len());
        }
    }
    for degree in [1, 2] {
        check::<2>(Space::PlaneStrain, 0.3, degree);
        check::<2>(Space::PlaneStrain, 0.49, degree);
        check::<2>(Space::PlaneStress, 0.3, degree);
        check::<3>(Space::Solid, 0.45, degree);
    }
    check::<2>(Space::Axisymmetric, 0.3, 2);
}
