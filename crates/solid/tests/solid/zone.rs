//! The area of contact against Hertz (1882) and Sneddon (1965): a body of revolution on a rigid plane, with the
//! displacement of a half space far away (Boussinesq 1885). The edge of the zone has the radius 1.

use crate::pressed::{MORTAR, Way, pressed};
use signorini_contact::{NodeState, zone};
use signorini_fem::block::{block, graded};
use signorini_geometry::rigid_shape::{Plane, Sphere};
use signorini_geometry::{Point, Vector};
use signorini_mechanics::SiteResult;
use signorini_solid::{Bodies, Elastic, Space};
use std::f64::consts::PI;

const NU: f64 = 0.3;
const SLOPE: f64 = 1e-3;
const FAR: f64 = 30.0;

#[derive(Clone, Copy, Debug)]
enum Profile {
    /// `r²/2R`.
    Sphere,
    /// `r tan α`.
    Cone,
}

/// Relative error of the area of contact. Cells are even up to `even`.
fn error(profile: Profile, way: Way, degree: usize, cells: usize, even: f64) -> f64 {
    let h = even / cells as f64;
    let growth = 1.25f64.powf(8.0 / cells as f64 * even);
    let reach = |m: i32| h * growth * (growth.powi(m) - 1.0) / (growth - 1.0);
    let growing = (1..).find(|&m| reach(m) >= FAR - even).unwrap() as usize;
    let axis = |to: f64, n: usize| {
        let mut out = vec![0.0];
        out.extend(graded(0.0, to, n, 1.0));
        out.extend(graded(to, FAR, growing, growth));
        out
    };
    let height = |r: f64| match profile {
        Profile::Sphere => 0.5 * SLOPE * r * r,
        Profile::Cone => SLOPE * r,
    };
    let mesh = block::<2>(&[axis(even, cells), axis(0.5 * even, cells / 2)], degree, |x| {
        Point::<2>::new(x[0], x[1] + height(x[0]) * (1.0 - x[1] / FAR))
    });
    let modulus = 1.0 / (1.0 - NU * NU);
    let (force, depth) = match profile {
        Profile::Sphere => (4.0 / 3.0 * modulus * SLOPE, SLOPE),
        Profile::Cone => (0.5 * PI * modulus * SLOPE, 0.5 * PI * SLOPE),
    };
    let elastic = Elastic { youngs_modulus: 1.0, poissons_ratio: NU };
    let far = |x: &Point<3>, p: &[f64]| {
        let (d, c) = (x.xy().norm(), p[0] * (1.0 + NU) / (2.0 * PI));
        // On the axis the radial displacement vanishes by itself.
        if x[0] < 1e-12 && x[1] < FAR - 1e-9 {
            return Point::<3>::zeros();
        }
        Point::<3>::new(
            c * (x[0] * x[1] / d.powi(3) - (1.0 - 2.0 * NU) * x[0] / (d * (d + x[1]))),
            c * (x[1] * x[1] / d.powi(3) + 2.0 * (1.0 - NU) / d) - p[1],
            0.0,
        )
    };
    let held = [("top", [true, true, false]), ("right", [true, true, false]), ("left", [true, false, false])];
    let plane = Plane { point: Point::<3>::zeros(), normal: Vector::<3>::y() };
    let sites = pressed(mesh, Space::Axisymmetric, (degree, elastic), way, &held, far, (&[force, depth], plane));
    sites.iter().map(SiteResult::contact_area).sum::<f64>() / PI - 1.0
}

/// The largest error with the edge in two places of a cell.
fn worst(profile: Profile, way: Way, degree: usize, cells: usize) -> f64 {
    [1.5, 1.55].iter().map(|even| error(profile, way, degree, cells, *even).abs()).fold(0.0, f64::max)
}

/// Counted nodes would be off by half a cell: 6 % with the finer cells.
#[test]
fn areas_are_of_second_order() {
    for profile in [Profile::Sphere, Profile::Cone] {
        for degree in [1, 2] {
            let [coarse, fine] = [6, 24].map(|n| worst(profile, MORTAR, degree, n));
            let order = 0.5 * (coarse / fine).log2();
            println!("{profile:?}, degree {degree}: {coarse:e} {fine:e}, order {order}");
            assert!(fine < 2e-3 && order > 1.7, "{profile:?}, degree {degree}: {coarse:e} {fine:e}, order {order}");
        }
    }
}

/// In space: a block on a rigid sphere, contact over five cells. In the theory of Hertz the mean pressure is two thirds of
/// the largest; counted nodes are off by 5 %.
#[test]
fn areas_in_space() {
    let mut axis = vec![0.0];
    axis.extend(graded(0.0, 1.7, 8, 1.0));
    axis.extend(graded(1.7, 6.0, 4, 1.6));
    let mut depth = vec![0.0];
    depth.extend(graded(0.0, 6.0, 5, 1.7));
    let mesh = block::<3>(&[axis.clone(), axis, depth], 1, |x| x);
    let elastic = Elastic { youngs_modulus: 1.0, poissons_ratio: NU };
    let held = [("top", [true; 3]), ("left", [true, false, false]), ("front", [false, true, false])];
    let ball = Sphere { center: Point::<3>::new(0.0, 0.0, -100.0), radius: 100.0 };
    let down = |x: &Point<3>, _: &[f64]| Point::<3>::new(0.0, 0.0, if x[2] > 5.9 { -0.0085 } else { 0.0 });
    let sites = pressed(mesh, Space::Solid, (1, elastic), MORTAR, &held, down, (&[], ball));
    let area: f64 = sites.iter().map(SiteResult::contact_area).sum();
    let force: f64 = sites.iter().map(|s| s.force()[2]).sum();
    let peak = sites.iter().map(SiteResult::shown_pressure).fold(0.0, f64::max);
    let error = area * peak / (1.5 * force) - 1.0;
    assert!(error.abs() < 0.015, "{error}");
}

/// A single open node among active ones is rounding of the mesh, and moves the edge of the zone nowhere.
#[test]
fn a_pinhole_is_no_edge() {
    let axis: Vec<f64> = (0..=12).map(|k| f64::from(k) / 6.0).collect();
    let mesh = block::<3>(&[axis.clone(), axis, vec![0.0, 1.0]], 1, |x| x);
    let bottom = mesh.groups()["bottom"].sides.clone();
    let mut bodies = Bodies::<3>::new(Space::Solid);
    bodies.add("block", mesh, 2, Elastic { youngs_modulus: 1.0, poissons_ratio: NU });
    let slave = bodies.surface(0, bottom);
    let nodes = signorini_contact::PressureNodes::new(&slave);
    let points = signorini_contact::unpressed(&slave, &nodes);
    let area = |pinhole: bool| {
        let state = |x: &Point<3>| match x.norm() {
            r if pinhole && (r - 0.5).abs() < 1e-9 && x[1] == 0.0 => NodeState::Open(Some(1e-6)),
            r if r < 1.03 => NodeState::Active,
            r => NodeState::Open(Some((r - 1.03).powf(1.5))),
        };
        let states: Vec<NodeState> = nodes.positions.iter().map(state).collect();
        assert_eq!(states.contains(&NodeState::Open(Some(1e-6))), pinhole);
        zone(&slave, &nodes, &points, &states).face_area.iter().sum::<f64>()
    };
    let exact = 0.25 * PI * 1.03f64.powi(2);
    assert!((area(false) / exact - 1.0).abs() < 4e-3, "{} {exact}", area(false));
    assert_eq!(area(true), area(false));
}
