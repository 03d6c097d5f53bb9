//! Bodies from images: a modulus in every voxel, and what a body is like as a piece of a material.

use super::contacts::{moved, rigid};
use super::*;
use signorini_cells::description::{Cells, Description, Geometry, Part as PlacePart, build};
use signorini_cells::image::ImageData;
use signorini_cells::shapes::ball;
use signorini_cells::voxels::Voxels;
use signorini_cells::{End, VolumePoints};
use signorini_geometry::rigid_shape::Plane;

/// A cube of voxels with moduli, between a floor that holds it and a plate that comes down by 0.01.
fn pressed(
    modulus: impl Fn(usize, usize, usize) -> f64,
    poissons_ratio: f64,
) -> (System, SystemState, IncrementResult) {
    let n = 6;
    let values = (0..n * n * n).map(|i| modulus(i % n, i / n % n, i / (n * n))).collect();
    let image = ImageData { count: vec![n; 3], spacing: vec![1.0 / n as f64; 3], origin: vec![0.0; 3], values };
    let elastic = Elastic { youngs_modulus: 2.0, poissons_ratio };
    let mut d = Description::new("cube", Geometry::Moduli(image), Space::Solid, Cells::Count([3, 3, 2]), 2, elastic);
    for (name, end) in [("bottom", End::Low), ("top", End::High)] {
        d.places.insert(name.into(), PlacePart::Side { axis: 2, end });
    }
    let body = build(&d).unwrap().body;
    let plane = Plane { point: v(0.0, 0.0, 1.0), normal: -Vector::<3>::z() };
    let plate = rigid("plate", plane, moved(v(0.0, 0.0, -0.01)));
    let sides = ((part(0, "top"), &*body), (part(1, ""), &plate as &dyn Body));
    let contact =
        Contact::new("touch", sides.0, sides.1, Sampling::GaussPoints, Enforcement::AugmentedLagrangian).unwrap();
    let mut system = System {
        supports: vec![support(0, "bottom", [constant(0.0), constant(0.0), constant(0.0)])],
        bodies: vec![body, Box::new(plate)],
        contacts: vec![Box::new(contact)],
        ..System::default()
    };
    let (state, found) = solve(&mut system);
    (system, state, found)
}

/// Layers in series, without Poisson's effect: `F = δ / Σ h/E`, and all of it is in the means.
#[test]
fn a_plate_presses_an_image_of_moduli() {
    let (system, state, found) = pressed(|_, _, k| [1.0, 1.0, 1.0, 0.25, 0.25, 0.25][k], 0.0);
    let force: f64 = found.sites[0].iter().map(|s| s.force()[2]).sum();
    let exact = -0.01 / (0.5 / 2.0 + 0.5 / 0.5);
    println!("{force} {exact}, {} iterations, {} sites", found.iterations, found.sites[0].len());
    assert!((force / exact - 1.0).abs() < 1e-7, "{force} {exact}");
    let means = system.bodies[0].means(&state.bodies[0]).unwrap();
    assert!((means.stress[2] / exact - 1.0).abs() < 1e-7 && means.stress[0].abs() < 1e-9, "{means:?}");
    let strain = means.strain.map(|s| s.unwrap());
    assert!((strain[2] + 0.01).abs() < 1e-9 && strain[0].abs() < 1e-9, "{means:?}");
}

/// Voxels side by side: stiffness between what series and parallels of voxels have; the forces balance.
#[test]
fn an_image_of_many_moduli_is_pressed_in_few_steps() {
    let modulus = |i: usize, j: usize, k: usize| if (i / 2 + j / 2 + k / 2).is_multiple_of(2) { 1.0 } else { 0.01 };
    let (system, state, found) = pressed(modulus, 0.3);
    let force: f64 = found.sites[0].iter().map(|s| s.force()[2]).sum();
    println!("{force}, {} iterations", found.iterations);
    assert!((force + found.support_forces[0][0][2]).abs() < 1e-9 * force.abs());
    assert!(found.iterations <= 30, "{}", found.iterations);
    assert!(-force > 0.01 * 2.0 / (0.5 + 50.0) && -force < 0.01 * 2.0 * 1.01, "{force}");
    let means = system.bodies[0].means(&state.bodies[0]).unwrap();
    assert!((means.stress[2] / force - 1.0).abs() < 1e-6, "{means:?} {force}");
}

/// Few points in place of many integrate the same stiffness.
#[test]
fn fitted_points_are_those_in_the_material() {
    let n = 8;
    let values = (0..n * n * n)
        .map(|i| {
            let [x, y, z] = [i % n, i / n % n, i / (n * n)].map(|k| (k as f64 + 0.5) / n as f64);
            (5.0 * x + 0.3).sin() * (5.0 * y).cos()
                + (5.0 * y).sin() * (5.0 * z).cos()
                + (5.0 * z).sin() * (5.0 * x).cos()
        })
        .collect();
    let image = Voxels::<3>::new(Point::<3>::zeros(), [1.0 / n as f64; 3], [n; 3], values).unwrap();
    let region: Arc<dyn Region<3>> = Arc::new(Domain::shape(image.above(-0.4, 1.0).unwrap()));
    let tree = CellTree::new(image.bounds(), [2; 3]).unwrap();
    let bodies = [VolumePoints::InMaterial, VolumePoints::Fitted].map(|volume_points| {
        let setup = Discretisation { volume_points, ..Discretisation::of_degree(2) };
        CellBody::new(region.clone(), tree.clone(), setup, material(Space::Solid)).unwrap()
    });
    let [many, few] = &bodies;
    let points = |b: &CellBody<3>| b.cells().iter().map(|c| c.rule.volume.len()).max().unwrap();
    assert!(points(few) <= 125 && points(many) > 1000, "{} {}", points(few), points(many));
    assert!((many.volume() - few.volume()).abs() < 1e-12);
    let area = |b: &CellBody<3>| b.sites(&|_| true).iter().map(|s| s.weight).sum::<f64>();
    assert!((area(many) - area(few)).abs() < 1e-12 * area(many));
    for (a, b) in many.stiffness().iter().zip(few.stiffness()) {
        assert!((&**a - &*b).amax() < 1e-12 * a.amax());
    }
}

/// A block with a hole and many vertices: a cycle of multigrid in place of a factorisation, with about as many iterations.
#[test]
fn many_vertices_are_coarsened() {
    let mut counts = Vec::new();
    for n in [8, 16] {
        let b = aabb([0.0; 3], [1.0; 3]);
        let hole = Domain::Complement(Box::new(Domain::shape(ball(Point::<3>::repeat(0.5), 0.37))));
        let body = cells(hole, CellTree::new(b, [n; 3]).unwrap(), 1, Space::Solid).unwrap();
        assert_eq!(body.schwarz_sets().coarser.is_empty(), n == 8);
        let body =
            CellSolid::new("block", body, &named(vec![("bottom", Place::low(2)), ("top", Place::high(2))])).unwrap();
        let mut system = System {
            supports: vec![
                support(0, "bottom", [constant(0.0), constant(0.0), constant(0.0)]),
                support(0, "top", [constant(0.01), constant(0.0), constant(-0.1)]),
            ],
            bodies: vec![Box::new(body)],
            solver: LinearSolver::Iterative,
            ..System::default()
        };
        let (_, found) = solve(&mut system);
        let Solved::Iterative { most_iterations, .. } = found.solved else { panic!("{:?}", found.solved) };
        assert!((found.support_forces[0][0] + found.support_forces[1][0]).norm() < 1e-9);
        counts.push(most_iterations);
    }
    println!("{counts:?}");
    assert!(counts[1] <= counts[0] + 10, "{counts:?}");
}
