//! Bodies without contact against exact solutions: every term of stiffness, loads and supports is needed for one of them.

use crate::system::{part, run};
use signorini_fem::Mesh;
use signorini_fem::block::block;
use signorini_fem::gmsh::GmshFile;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::*;
use signorini_solid::{Elastic, SolidBody, Space, StressLaw};
use std::sync::Arc;

const E: f64 = 7.0;
const NU: f64 = 0.3;

fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| from + (to - from) * k as f64 / n as f64).collect()
}

fn system<const D: usize>(mesh: Mesh<D>, degree: usize, poissons_ratio: f64, space: Space) -> System {
    let law = (Elastic { youngs_modulus: E, poissons_ratio }, StressLaw::LinearElastic);
    let mut groups = mesh.groups().clone();
    groups.insert("all".into(), signorini_fem::Group { sides: mesh.boundary(), ..Default::default() });
    let body = SolidBody::new("body", Arc::new(mesh), degree, law, space, groups).unwrap();
    System { bodies: vec![Box::new(body)], ..System::default() }
}

/// The largest error of the displacement where it is shown.
fn error(system: &System, state: &SystemState, exact: &dyn Fn(&Point<3>) -> Point<3>) -> f64 {
    let fields = system.bodies[0].fields(&state.bodies[0]);
    let list = fields.points.iter().zip(&fields.displacement);
    list.map(|(x, u)| (u - exact(x)).norm()).fold(0.0, f64::max)
}

/// A displacement prescribed on the whole boundary that solves the equations inside.
fn prescribed<const D: usize>(
    mesh: Mesh<D>,
    degree: usize,
    poissons_ratio: f64,
    exact: fn(&Point<3>) -> Point<3>,
) -> f64 {
    let space = if D == 2 { Space::PlaneStrain } else { Space::Solid };
    let mut system = system(mesh, degree, poissons_ratio, space);
    let along =
        |i: usize| -> Option<system::TimeField> { (i < D).then(|| Arc::new(move |x: &Point<3>, _| exact(x)[i]) as _) };
    system.supports.push(Support {
        name: "all".into(),
        part: part(0, "all"),
        displacement: std::array::from_fn(along),
        ..Support::default()
    });
    let (state, _) = run(&mut system, &[1.0]);
    error(&system, &state, &exact)
}

#[test]
fn linear_fields_on_all_cells() {
    let plane = |x: &Point<3>| Point::<3>::new(0.1 + 0.3 * x[0] - 0.2 * x[1], 0.4 * x[0] + 0.1 * x[1], 0.0);
    let space = |x: &Point<3>| {
        Point::<3>::new(0.3 * x[0] - 0.2 * x[1] + 0.5 * x[2], 0.1 * x[0] + x[2], 0.2 * x[1] - 0.4 * x[2] + 0.3)
    };
    let read = |name: &str| {
        let path = format!("{}/../fem/tests/data/{name}_41_txt.msh", env!("CARGO_MANIFEST_DIR"));
        GmshFile::parse(&std::fs::read(path).unwrap()).unwrap()
    };
    for (name, degree) in [("tri3", 1), ("tri6", 2), ("quad8", 2), ("quad9", 2)] {
        let found = prescribed::<2>(read(name).mesh(None).unwrap(), degree, NU, plane);
        assert!(found < 1e-12, "{name}: {found:e}");
    }
    for (name, degree) in
        [("tet4", 1), ("tet10", 2), ("wedge6", 1), ("wedge15", 2), ("wedge18", 2), ("hex20", 2), ("hex27", 2)]
    {
        let found = prescribed::<3>(read(name).mesh(None).unwrap(), degree, NU, space);
        assert!(found < 1e-12, "{name}: {found:e}");
    }
}

/// Gradients of harmonic polynomials need the edge and side functions, and the fit of what is prescribed on them.
#[test]
fn quadratic_and_cubic_fields() {
    let quadratic = |x: &Point<3>| Point::<3>::new(3.0 * (x[0] * x[0] - x[1] * x[1]), -6.0 * x[0] * x[1], 0.0);
    let quartic = |x: &Point<3>| {
        let (a, b) = (x[0], x[1]);
        Point::<3>::new(4.0 * a.powi(3) - 12.0 * a * b * b, -12.0 * a * a * b + 4.0 * b.powi(3), 0.0)
    };
    let in_space = |x: &Point<3>| Point::<3>::new(x[1] * x[2], x[0] * x[2], x[0] * x[1]);
    let plane =
        || block::<2>(&[even(0.0, 1.0, 3), even(-0.5, 0.5, 2)], 1, |x| Point::<2>::new(x[0] + 0.2 * x[1], x[1]));
    for degree in [2, 3, 5] {
        // Nearly incompressible too: these fields keep their volume, and the pressure is projected.
        for poissons_ratio in [NU, 0.4999] {
            let found = prescribed::<2>(plane(), degree, poissons_ratio, quadratic);
            assert!(found < 1e-10, "degree {degree}, {poissons_ratio}: {found:e}");
            if degree > 2 {
                let found = prescribed::<2>(plane(), degree, poissons_ratio, quartic);
                assert!(found < 1e-10, "degree {degree}, {poissons_ratio}: {found:e}");
            }
        }
        let mesh = block::<3>(&[even(0.0, 1.0, 2), even(0.0, 1.0, 2), even(0.0, 2.0, 2)], 1, |x| x);
        assert!(prescribed::<3>(mesh, degree, NU, in_space) < 1e-11);
    }
}

#[test]
fn beds_body_forces_tractions_and_plane_stress() {
    let bar = || block::<2>(&[even(0.0, 0.5, 2), even(0.0, 2.0, 4)], 1, |x| x);
    let hold = |group: &str, values: [Option<f64>; 3]| crate::system::hold(0, group, values);
    let load = |group: &str, load: TimedLoad| crate::system::load(0, group, load);

    // Its own weight: u = -w (L y - y²/2) / E.
    let mut weight = system(bar(), 2, 0.0, Space::PlaneStress);
    weight.supports.push(hold("bottom", [Some(0.0), Some(0.0), None]));
    weight.loads.push(load("", TimedLoad::BodyForce(Arc::new(|_, _| Vector::<3>::new(0.0, -0.3, 0.0)))));
    let (state, results) = run(&mut weight, &[1.0]);
    let exact = |x: &Point<3>| Point::<3>::new(0.0, -0.3 * (2.0 * x[1] - 0.5 * x[1] * x[1]) / E, 0.0);
    assert!(error(&weight, &state, &exact) < 1e-13);
    assert!((results[0].support_forces[0][0][1] - 0.3).abs() < 1e-13);

    // Pulled in plane stress: the bar becomes thinner by ν σ / E.
    let mut pulled = system(bar(), 1, NU, Space::PlaneStress);
    pulled.supports.extend([hold("bottom", [None, Some(0.0), None]), hold("left", [Some(0.0), None, None])]);
    pulled.loads.push(load("top", TimedLoad::Traction(Arc::new(|_, _| Vector::<3>::new(0.0, 0.7, 0.0)))));
    let (state, _) = run(&mut pulled, &[1.0]);
    let exact = |x: &Point<3>| Point::<3>::new(-NU * 0.7 / E * x[0], 0.7 / E * x[1], 0.0);
    assert!(error(&pulled, &state, &exact) < 1e-13);

    // On a bed of stiffness 4 per area: the bar sinks by p / 4 as a whole besides.
    let mut bedded = system(bar(), 2, NU, Space::PlaneStress);
    bedded.supports.push(hold("left", [Some(0.0), None, None]));
    bedded.loads.push(load("bottom", TimedLoad::Springs(Vector::<3>::new(0.0, 4.0, 0.0))));
    bedded.loads.push(load("top", TimedLoad::Traction(Arc::new(|_, _| Vector::<3>::new(0.0, -0.6, 0.0)))));
    assert_eq!(bedded.free_motion(0).unwrap(), None);
    let (state, _) = run(&mut bedded, &[1.0]);
    let exact = |x: &Point<3>| Point::<3>::new(NU * 0.6 / E * x[0], -0.6 / 4.0 - 0.6 / E * x[1], 0.0);
    assert!(error(&bedded, &state, &exact) < 1e-12);
}

/// What supports and beds leave free is named.
#[test]
fn free_motions_are_those_that_supports_leave() {
    let square = || block::<2>(&[even(0.0, 1.0, 2), even(0.0, 1.0, 2)], 1, |x| x);
    let free = |support: Option<Support>, load: Option<PlacedLoad>| {
        let mut system = system(square(), 1, NU, Space::PlaneStrain);
        system.supports.extend(support);
        system.loads.extend(load);
        system.free_motion(0).unwrap()
    };
    let hold = |values: [Option<f64>; 3]| Some(crate::system::hold(0, "bottom", values));
    let bed = crate::system::load(0, "bottom", TimedLoad::Springs(Vector::<3>::new(0.0, 4.0, 0.0)));
    assert_eq!(free(None, None).as_deref(), Some("moving along x"));
    assert_eq!(free(None, Some(bed)).as_deref(), Some("moving along x"));
    assert_eq!(free(hold([Some(0.0), None, None]), None).as_deref(), Some("moving along y"));
    assert_eq!(free(hold([Some(0.0), Some(0.0), None]), None), None);
}
