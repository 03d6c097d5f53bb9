//! Cells pressed on finer elements: force and pressure by Nitsche's method, with points as dense as these need.

use super::*;
use signorini_cells::shapes::{HalfSpace, ball};
use signorini_solid::{SolidBody, StressLaw};

/// A quarter of a disc below the origin in elements, fine where it is touched.
fn elements() -> SolidBody<2> {
    // Equal cells up to 0.2, then ever larger ones.
    let mut axis: Vec<f64> = (0..=12).map(|k| k as f64 / 60.0).collect();
    let (mut at, mut size): (f64, f64) = (0.2, 1.0 / 60.0);
    while at < 0.9 {
        size *= 1.3;
        at = (at + size).min(1.0);
        axis.push(at);
    }
    *axis.last_mut().unwrap() = 1.0;
    let up: Vec<f64> = axis.iter().rev().map(|t| 1.0 - t).collect();
    // A square onto a quarter of a disc, about its middle.
    let map = |p: Point<2>| {
        let [u, v] = [p[0], p[1]];
        Point::<2>::new(u * (1.0 - 0.5 * v * v).sqrt(), v * (1.0 - 0.5 * u * u).sqrt() - 1.0)
    };
    let mesh = signorini_fem::block::block::<2>(&[axis, up], 2, map);
    let groups = mesh.groups().clone();
    SolidBody::new("lower", Arc::new(mesh), 2, (ELASTIC, StressLaw::LinearElastic), Space::PlaneStrain, groups).unwrap()
}

/// By symmetry each of both discs is pressed on a rigid plane, half as deep. Cells of degree 4 are three times as large as the
/// elements; without points for these the pressure ripples by a tenth.
#[test]
fn pressure_on_finer_elements_does_not_ripple() {
    let reference: serde_json::Value = serde_json::from_str(include_str!("../../data/finite_cells.json")).unwrap();
    let wanted = |key: &str| reference["hertz_2d"]["0.03"][key]["value"].as_f64().unwrap();
    let press = |dense: bool| {
        let mut tree = CellTree::new(aabb([0.0, 0.0], [1.0, 1.0]), [5, 5]).unwrap();
        for reach in [0.3, 0.2] {
            tree.refine(|leaf| leaf.bounds.clamp(&Point::<2>::zeros()).norm() < reach).unwrap();
        }
        let shape = Domain::shape(ball(Point::<2>::new(0.0, 1.0), 1.0));
        let skin = Place::boundary(|p| p.normal[1] < -0.5);
        let places = named(vec![("axis", Place::low(0)), ("middle", Place::high(1)), ("skin", skin)]);
        let upper = CellSolid::new("upper", cells(shape, tree, 4, Space::PlaneStrain).unwrap(), &places).unwrap();
        let mut bodies: Vec<Box<dyn Body>> = vec![Box::new(upper), Box::new(elements())];
        let sides = [part(0, "skin"), part(1, "top")];
        if dense {
            test_densely(&mut bodies, [&sides[0], &sides[1]]);
        }
        let [a, b] = sides;
        let touch = ((a, &*bodies[0]), (b, &*bodies[1]));
        let contact = Contact::new("touch", touch.0, touch.1, Sampling::GaussPoints, Enforcement::Nitsche).unwrap();
        let mut system = System {
            supports: vec![
                support(0, "axis", [constant(0.0), None, None]),
                support(1, "left", [constant(0.0), None, None]),
                support(0, "middle", [None, constant(-0.06), None]),
                support(1, "bottom", [None, constant(0.0), None]),
            ],
            bodies,
            contacts: vec![Box::new(contact)],
            ..System::default()
        };
        let (_, found) = solve(&mut system);
        let force: Vector<3> = found.sites[0].iter().map(SiteResult::force).sum();
        assert!((found.support_forces[2][0][1] + found.support_forces[3][0][1]).abs() < 1e-10);
        let a = (4.0 * 2.0 * force[1].abs() * (1.0 - 0.09) / std::f64::consts::PI).sqrt();
        let inner: Vec<&SiteResult> = found.sites[0].iter().filter(|s| s.x[0] < 0.8 * a).collect();
        let powers = nalgebra::DMatrix::from_fn(inner.len(), 4, |k, j| {
            inner[k].weight.sqrt() * (inner[k].x[0] / a).powi(2 * j as i32)
        });
        let pressures = nalgebra::DVector::from_fn(inner.len(), |k, _| inner[k].weight.sqrt() * inner[k].pressure);
        let fit = powers.clone().svd(true, true).solve(&pressures, 1e-14).unwrap();
        let scatter = (powers * &fit - &pressures).norm() / pressures.norm();
        println!(
            "dense {dense}: {} sites, force {} ({}), peak {} ({}), scatter {scatter:.2e}, {} iterations",
            found.sites[0].len(),
            2.0 * force[1].abs(),
            wanted("P"),
            fit[0],
            wanted("p0"),
            found.iterations
        );
        (2.0 * force[1].abs() / wanted("P") - 1.0, fit[0] / wanted("p0") - 1.0, scatter)
    };
    let (force, peak, scatter) = press(true);
    assert!(force.abs() < 2e-3 && peak.abs() < 1e-2 && scatter < 1e-2);
    assert!(press(false).2 > 5.0 * scatter);
}

/// Half of a disc pressed on a block of cells half as large: with points as dense as those of the block Newton's method ends; with
/// its own it opens and closes the same sites for ever.
#[test]
fn coarse_cells_on_finer_ones_converge() {
    let b = aabb([-1.0, 0.0], [1.0, 1.0]);
    let skin = Place::boundary(|p| p.x[1] < 0.3);
    let places = vec![("middle", Place::high(1)), ("skin", skin)];
    let disc = Domain::shape(ball(Point::<2>::y(), 1.0));
    let upper = solid("upper", disc, (b, [10, 5]), 3, Space::PlaneStrain, places);
    let below = Domain::shape(HalfSpace { point: Point::<2>::zeros(), normal: Vector::<2>::y() });
    let b = aabb([-1.0, -1.0], [1.0, 0.05]);
    let lower = solid("lower", below, (b, [20, 11]), 3, Space::PlaneStrain, vec![("base", Place::low(1))]);
    let mut bodies: Vec<Box<dyn Body>> = vec![Box::new(upper), Box::new(lower)];
    let [a, b] = [part(0, "skin"), part(1, "boundary")];
    let count = bodies[0].sites(Some("skin"), Sampling::GaussPoints).unwrap().len();
    test_densely(&mut bodies, [&a, &b]);
    let touch = ((a, &*bodies[0]), (b, &*bodies[1]));
    let contact = Contact::new("touch", touch.0, touch.1, Sampling::GaussPoints, Enforcement::Nitsche).unwrap();
    assert!(contact.sites().len() > 3 * count / 2, "{} of {count}", contact.sites().len());
    let mut system = System {
        supports: vec![
            support(0, "middle", [constant(0.0), constant(-0.02), None]),
            support(1, "base", [constant(0.0), constant(0.0), None]),
        ],
        bodies,
        contacts: vec![Box::new(contact)],
        ..System::default()
    };
    let (_, found) = solve(&mut system);
    println!("{} iterations, {:?}", found.iterations, found.support_forces);
    assert!(found.iterations <= 12, "{}", found.iterations);
    assert!((found.support_forces[0][0] + found.support_forces[1][0]).norm() < 1e-10);
    // That of cells as large as those of the block.
    assert!((-found.support_forces[0][0][1] / 0.006057 - 1.0).abs() < 2e-3);
}
