//! Cells that are met by rigid bodies, cells, elements and ropes: tangents, balance, Hertz, edges.

use super::contacts::rigid;
use super::*;
use signorini_cells::facets::FacetBody;
use signorini_cells::shapes::{HalfSpace, ball, cuboid};
use signorini_contact::Coulomb;
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::rigid_shape::{Ellipsoid, Sphere};
use signorini_rope::centreline::{Closure, Continuity};
use signorini_rope::chain::{Chain, body::ReferenceLength};
use signorini_rope::path::Path;
use signorini_solid::{SolidBody, StressLaw};

pub(super) fn noise(seed: &mut u64) -> f64 {
    *seed = seed.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
    ((*seed >> 33) as f64 / (1u64 << 31) as f64) * 2.0 - 1.0
}

/// Without friction, sticking, slipping.
pub(super) const ALL: [Option<f64>; 3] = [None, Some(50.0), Some(0.05)];

pub(super) const PENALTY: Enforcement = Enforcement::Penalty { wanted_penetration: None };

pub(super) fn contact(
    slave: (&str, &dyn Body),
    master: (&str, &dyn Body),
    sampling: Sampling,
    how: Enforcement,
) -> Contact {
    Contact::new("touch", (part(0, slave.0), slave.1), (part(1, master.0), master.1), sampling, how).unwrap()
}

/// The bodies of a contact, the slave first, and the contact.
fn pair<S: Body + 'static, M: Body + 'static>(
    slave: (&str, S),
    master: (&str, M),
    sampling: Sampling,
    how: Enforcement,
) -> (Vec<Box<dyn Body>>, Contact) {
    let contact = contact((slave.0, &slave.1), (master.0, &master.1), sampling, how);
    (vec![Box::new(slave.1), Box::new(master.1)], contact)
}

/// Moves both bodies at random, and compares the tangent with differences without friction, sticking and slipping; the
/// forces of the contact have neither resultant nor moment.
fn check(
    name: &str,
    make: &dyn Fn() -> (Vec<Box<dyn Body>>, Contact),
    (size, columns): (f64, usize),
    frictions: &[Option<f64>],
) {
    for &friction in frictions {
        let (bodies, mut contact) = make();
        contact.law.friction =
            friction.map(|mu| Box::new(Coulomb::isotropic(mu).unwrap()) as Box<dyn signorini_contact::Law>);
        let mut system = System { bodies, contacts: vec![Box::new(contact)], ..System::default() };
        system.prepare().unwrap();
        let start = system.start();
        let n = system.linearise(&start, 1.0).unwrap().0.len();
        let seed = &mut 5u64;
        let mut step = || (0..n).map(|_| size * noise(seed)).collect::<Vec<f64>>();
        // Slips count from the state before.
        let before = system.advance(&start, &step(), 1.0);
        system.accept(&before).unwrap();
        let state = system.advance(&before, &step(), 1.0);
        let error = tangent_error(&system, &state, 2e-7, columns);
        let with = system.linearise(&state, 1.0).unwrap().0;
        let kept = std::mem::take(&mut system.contacts);
        let without = system.linearise(&state, 1.0).unwrap().0;
        let count: usize = system.bodies.iter().map(|b| b.unknowns()).sum();
        let forces: Vec<f64> = (0..count).map(|k| with[k] - without[k]).collect();
        let most = forces.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        let mut sums = [0.0; 6];
        let mut first = 0;
        for (body, own) in system.bodies.iter().zip(&state.bodies) {
            for (sum, mode) in sums.iter_mut().zip(body.rigid_modes(own)) {
                *sum += mode.iter().zip(&forces[first..]).map(|(m, f)| m * f).sum::<f64>();
            }
            first += body.unknowns();
        }
        let closed = kept.len();
        let imbalance = sums.iter().fold(0.0f64, |m, s| m.max(s.abs())) / most;
        println!("{name}, {friction:?}: tangent {error:e}, balance {imbalance:e} of {most:e}, {closed} contacts");
        assert!(most > 1e-6, "{name}: nothing touches");
        assert!(error < 1e-6, "{name}, {friction:?}: {error:e}");
        assert!(imbalance < 1e-10, "{name}, {friction:?}: {sums:?}");
    }
}

pub(super) fn disc(name: &str, y: f64, degree: usize) -> CellSolid<2> {
    let shape = Domain::shape(ball(Point::<2>::new(0.0, y), 1.0));
    let places = vec![("skin", Place::boundary(move |p| p.normal[1] * y < -0.5))];
    let b = if y > 0.0 { aabb([-1.0, -0.1], [1.0, 0.9]) } else { aabb([-1.0, -0.9], [1.0, 0.1]) };
    solid(name, shape, (b, [5, 3]), degree, Space::PlaneStrain, places)
}

fn block(y: f64, up: f64) -> SolidBody<2> {
    let rows = [y, y + 0.3 * up];
    let axes = [vec![-0.5, -0.2, 0.1, 0.5], vec![rows[0].min(rows[1]), rows[0].max(rows[1])]];
    let mesh = signorini_fem::block::block::<2>(&axes, 1, |x| x);
    let groups = mesh.groups().clone();
    SolidBody::new("block", Arc::new(mesh), 2, (ELASTIC, StressLaw::LinearElastic), Space::PlaneStrain, groups).unwrap()
}

#[test]
fn tangents_and_balance_in_the_plane() {
    check(
        "discs",
        &|| {
            let (upper, lower) = (disc("upper", 0.985, 3), disc("lower", -1.0, 3));
            pair(("skin", upper), ("skin", lower), Sampling::Nodes, PENALTY)
        },
        (2e-3, 20),
        &ALL,
    );
    check(
        "elements on cells",
        &|| {
            let (upper, lower) = (block(-0.03, 1.0), disc("lower", -1.0, 3));
            pair(("boundary", upper), ("skin", lower), Sampling::GaussPoints, PENALTY)
        },
        (2e-3, 20),
        &ALL,
    );
    check(
        "cells on elements",
        &|| {
            let (upper, lower) = (disc("upper", 0.985, 3), block(0.0, -1.0));
            pair(("skin", upper), ("boundary", lower), Sampling::Nodes, PENALTY)
        },
        (2e-3, 20),
        &ALL,
    );
}

/// Part of a ball in space.
fn cap(name: &str, z: f64) -> CellSolid<3> {
    let shape = Domain::shape(ball(Point::<3>::new(0.0, 0.0, z), 1.0));
    let places = vec![("skin", Place::boundary(move |p| p.normal[2] * z < -0.7))];
    let b = if z > 0.0 { aabb([-0.6, -0.6, -0.1], [0.6, 0.6, 0.4]) } else { aabb([-0.6, -0.6, -0.4], [0.6, 0.6, 0.1]) };
    solid(name, shape, (b, [2, 2, 1]), 2, Space::Solid, places)
}

#[test]
fn tangents_and_balance_in_space() {
    check(
        "caps",
        &|| {
            let (upper, lower) = (cap("upper", 0.95), cap("lower", -1.0));
            pair(("skin", upper), ("skin", lower), Sampling::Nodes, PENALTY)
        },
        (2e-3, 8),
        &ALL,
    );
    check(
        "a rope",
        &|| {
            let points: Vec<Point<3>> = (0..=6).map(|k| v(0.1 * (k as f64 - 3.0), 0.05, 0.01)).collect();
            let path = Path::points(&points, Closure::Open).unwrap().sample(6, Continuity::C0).unwrap();
            let rope = Chain::new("rope", &path, 5.0, ReferenceLength::Pretension(0.3), 0.05).unwrap();
            let lower = cap("lower", -1.0);
            pair(("", rope), ("skin", lower), Sampling::Nodes, PENALTY)
        },
        (2e-3, 8),
        &ALL,
    );
    check(
        "a free ball",
        &|| {
            let sphere = Sphere { center: v(0.03, 0.04, 0.19), radius: 0.2 };
            let mut ball = rigid("ball", sphere, Motion::Free { plane: false });
            ball.sites = vec![RigidSite { x: v(0.03, 0.04, 0.19), outward: None, radius: 0.2, weight: 1.0 }];
            let lower = cap("lower", -1.0);
            pair(("", ball), ("skin", lower), Sampling::Nodes, PENALTY)
        },
        (1e-4, 8),
        &ALL,
    );
}

/// By Nitsche's method, of which the traction is that of the stress of the cells: on other cells, on elements, on a rigid body
/// that is free to turn.
#[test]
fn tangents_and_balance_by_stress() {
    const NITSCHE: Enforcement = Enforcement::Nitsche;
    check(
        "discs",
        &|| {
            let (upper, lower) = (disc("upper", 0.985, 3), disc("lower", -1.0, 3));
            pair(("skin", upper), ("skin", lower), Sampling::GaussPoints, NITSCHE)
        },
        (2e-3, 20),
        &ALL,
    );
    check(
        "cells on elements",
        &|| {
            let (upper, lower) = (disc("upper", 0.985, 3), block(0.0, -1.0));
            pair(("skin", upper), ("boundary", lower), Sampling::GaussPoints, NITSCHE)
        },
        (2e-3, 20),
        &ALL,
    );
    check(
        "a free ellipse",
        &|| {
            let shape = Ellipsoid::new(v(0.1, 0.18, 0.0), [0.4, 0.2, 1.0]).unwrap();
            let (lower, ellipse) = (disc("lower", -1.0, 3), rigid("ellipse", shape, Motion::Free { plane: true }));
            pair(("skin", lower), ("", ellipse), Sampling::GaussPoints, NITSCHE)
        },
        (2e-3, 20),
        &ALL,
    );
    check(
        "a ball free along an axis",
        &|| {
            let sphere = Sphere { center: v(0.0, 0.19, 0.0), radius: 0.2 };
            // Beside the axis, where all unknowns are free.
            let b = aabb([0.01, -0.9], [1.0, 0.1]);
            let places = vec![("skin", Place::boundary(|p| p.normal[1] > 0.5))];
            let shape = Domain::shape(ball(-Point::<2>::y(), 1.0));
            let lower = solid("lower", shape, (b, [3, 3]), 3, Space::Axisymmetric, places);
            let upper = rigid("ball", sphere, Motion::FreeAlongAxis);
            pair(("skin", lower), ("", upper), Sampling::GaussPoints, NITSCHE)
        },
        (2e-3, 20),
        &ALL,
    );
    check(
        "a free ellipsoid",
        &|| {
            let shape = Ellipsoid::new(v(0.03, 0.04, 0.18), [0.5, 0.4, 0.2]).unwrap();
            let (lower, stone) = (cap("lower", -1.0), rigid("stone", shape, Motion::Free { plane: false }));
            pair(("skin", lower), ("", stone), Sampling::GaussPoints, NITSCHE)
        },
        (2e-3, 8),
        &ALL,
    );
}

/// Two halves of discs pressed together: by symmetry each is pressed on a rigid plane, half as deep.
#[test]
fn discs_pressed_together() {
    let reference: serde_json::Value = serde_json::from_str(include_str!("../../data/finite_cells.json")).unwrap();
    let wanted = reference["hertz_2d"]["0.03"]["P"]["value"].as_f64().unwrap();
    let disc = |name: &str, up: f64| {
        let shape = Domain::shape(ball(Point::<2>::new(0.0, up), 1.0));
        let b = if up > 0.0 { aabb([0.0, 0.0], [1.0, 1.0]) } else { aabb([0.0, -1.0], [1.0, 0.0]) };
        let middle = if up > 0.0 { Place::high(1) } else { Place::low(1) };
        let skin = Place::boundary(move |p| p.normal[1] * up < -0.5);
        solid(
            name,
            shape,
            (b, [8, 8]),
            4,
            Space::PlaneStrain,
            vec![("axis", Place::low(0)), ("middle", middle), ("skin", skin)],
        )
    };
    for (sampling, how) in [(Sampling::GaussPoints, PENALTY), (Sampling::Nodes, Enforcement::Multiplier)] {
        let (upper, lower) = (disc("upper", 1.0), disc("lower", -1.0));
        let contact = contact(("skin", &upper), ("skin", &lower), sampling, how);
        let mut system = System {
            supports: vec![
                support(0, "axis", [constant(0.0), None, None]),
                support(1, "axis", [constant(0.0), None, None]),
                support(0, "middle", [None, constant(-0.06), None]),
                support(1, "middle", [None, constant(0.0), None]),
            ],
            bodies: vec![Box::new(upper), Box::new(lower)],
            contacts: vec![Box::new(contact)],
            ..System::default()
        };
        let (_, found) = solve(&mut system);
        let force: Vector<3> = found.sites[0].iter().map(SiteResult::force).sum();
        println!("{how:?}: {} ({wanted}), {} iterations, {:?}", 2.0 * force[1], found.iterations, &found.history);
        assert!((2.0 * force[1] / wanted - 1.0).abs() < 1e-2, "{}", 2.0 * force[1]);
        assert!((found.support_forces[2][0][1] + found.support_forces[3][0][1]).abs() < 1e-10);
        assert!((found.support_forces[2][0][1] + force[1]).abs() < 1e-10);
    }
}

/// A block of cells with a flat top that runs through cells carries elements that share its sections: uniform pressure.
#[test]
fn elements_on_a_block_of_cells_press_evenly() {
    let elastic = Elastic { youngs_modulus: 1.0, poissons_ratio: 0.0 };
    let half = Domain::shape(HalfSpace { point: Point::<2>::new(0.0, 0.37), normal: Vector::<2>::y() });
    let tree = CellTree::new(aabb([0.0, 0.0], [1.0, 0.5]), [2, 2]).unwrap();
    let material = CellMaterial { solid: elastic.into(), modulus: None, space: Space::PlaneStrain };
    let body = CellBody::new(Arc::new(half), tree, Discretisation::of_degree(2), material).unwrap();
    let places = named(vec![("base", Place::low(1)), ("left", Place::low(0))]);
    let lower = CellSolid::new("lower", body, &places).unwrap();
    let mesh = signorini_fem::block::block::<2>(&[vec![0.0, 0.5, 1.0], vec![0.37, 0.67]], 1, |x| x);
    let groups = mesh.groups().clone();
    let of = (elastic, StressLaw::LinearElastic);
    let upper = SolidBody::new("upper", Arc::new(mesh), 1, of, Space::PlaneStrain, groups).unwrap();
    let how = Enforcement::AugmentedLagrangian;
    let contact = contact(("bottom", &upper), ("boundary", &lower), Sampling::GaussPoints, how);
    let mut system = System {
        supports: vec![
            support(1, "base", [None, constant(0.0), None]),
            support(1, "left", [constant(0.0), None, None]),
            support(0, "top", [constant(0.0), constant(-0.01), None]),
        ],
        bodies: vec![Box::new(upper), Box::new(lower)],
        contacts: vec![Box::new(contact)],
        ..System::default()
    };
    let (_, found) = solve(&mut system);
    let pressure = 0.01 / 0.67;
    for site in &found.sites[0] {
        assert!((site.pressure / pressure - 1.0).abs() < 1e-6, "{} {pressure}", site.pressure);
    }
}

/// A rigid ball beside the edge and the corner of a cube of cells meets edge and corner.
#[test]
fn edges_and_corners_are_met() {
    let b = aabb([-1.0; 3], [1.0; 3]);
    let whole = aabb([-0.7; 3], [0.65; 3]);
    let smooth = solid("cube", cuboid(&whole), (b, [3; 3]), 1, Space::Solid, Vec::new());
    let corner = |k: usize| Point::<3>::from_fn(|i, _| if k >> i & 1 == 0 { -0.7 } else { 0.65 });
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let triangles: Vec<[u32; 3]> = sides.iter().flat_map(|s| [[s[0], s[1], s[2]], [s[0], s[2], s[3]]]).collect();
    let mesh = TriangleMesh::new((0..8).map(corner).collect(), &triangles).unwrap();
    let cells = CellTree::new(b, [3; 3]).unwrap();
    let facets = Arc::new(FacetBody::new(mesh).unwrap());
    let facets = CellBody::new(facets, cells, Discretisation::of_degree(1), material(Space::Solid)).unwrap();
    assert!((facets.volume() - 1.35f64.powi(3)).abs() < 1e-12);
    let facets = CellSolid::new("facets", facets, &BTreeMap::new()).unwrap();
    for body in [smooth, facets] {
        let start = body.start();
        let master = body.master(None, &start).unwrap();
        for (x, coordinates, distance) in [
            (v(0.3, 0.2, 0.85), 2, 0.2),
            (v(0.3, 0.85, 0.85), 1, 0.2 * 2f64.sqrt()),
            (v(0.85, 0.85, 0.85), 0, 0.2 * 3f64.sqrt()),
            (v(-0.9, 0.66, 0.1), 1, 0.2f64.hypot(0.01)),
            (v(0.64, 0.64, 0.6), 2, 0.01),
        ] {
            let Some(MasterProjection::Foot(foot)) = master.nearest(&x, 1.0, None) else { panic!("{x}") };
            assert!(((foot.jet.x - x).norm() - distance).abs() < 1e-12 && foot.coordinates == coordinates, "{x}");
        }
        assert!(master.nearest(&v(3.0, 3.0, 3.0), 1.0, None).is_none());
    }
}
