//! Bodies without contact against exact solutions: every term of stiffness, loads and supports is needed for one of them.

use signorini_fem::block::block;
use signorini_fem::gmsh::GmshFile;
use signorini_fem::{Group, Mesh};
use signorini_geometry::Point;
use signorini_solid::stiffness::displacement_at;
use signorini_solid::*;

const E: f64 = 7.0;
const NU: f64 = 0.3;

fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| from + (to - from) * k as f64 / n as f64).collect()
}

fn support(name: &str, group: &Group, kind: SupportKind) -> Support {
    Support { name: name.into(), body: 0, group: group.clone(), kind }
}

fn load(bodies: &Bodies<2>, group: &Group, kind: LoadKind, value: Point<2>) -> Vec<f64> {
    loads::forces(bodies, &Load { name: "load".into(), body: 0, group: group.clone(), kind }, &|_| value)
}

fn solve<const D: usize>(
    bodies: Bodies<D>,
    supports: Vec<Support>,
    load: Vec<f64>,
    displacement: &dyn Fn(usize, &Point<D>) -> Point<D>,
) -> (Model<D>, State<D>) {
    let mut model = Model::new(bodies, supports, Vec::new()).unwrap();
    let now = Circumstances { displacement, load, rigid: Vec::new(), motion: vec![] };
    let state = model.solve(&now, &mut |_, _| true).unwrap();
    (model, state)
}

/// The largest error of the displacement at points within the cells.
fn error<const D: usize>(model: &Model<D>, state: &State<D>, exact: &dyn Fn(&Point<D>) -> Point<D>) -> f64 {
    let body = &model.bodies.list[0];
    (0..body.mesh.cell_count())
        .map(|cell| {
            let xi = body.mesh.shape(cell).centre().map(|c| c + 0.1);
            let (x, u, _) = displacement_at(&body.mesh, &body.dofs, model.bodies.space, cell, &xi, &state.u);
            (u - exact(&x)).norm()
        })
        .fold(0.0, f64::max)
}

/// A displacement prescribed on the whole boundary that solves the equations inside.
fn prescribed<const D: usize>(
    mesh: Mesh<D>,
    degree: usize,
    poissons_ratio: f64,
    exact: &dyn Fn(&Point<D>) -> Point<D>,
) -> f64 {
    let boundary = Group { sides: mesh.boundary(), ..Group::default() };
    let mut bodies = Bodies::<D>::new(if D == 2 { Space::PlaneStrain } else { Space::Solid });
    bodies.add("body", mesh, degree, Elastic { youngs_modulus: E, poissons_ratio });
    let supports = vec![support("all", &boundary, SupportKind::Components(vec![true; D]))];
    let load = vec![0.0; bodies.unknowns()];
    let (model, state) = solve(bodies, supports, load, &|_, x| exact(x));
    error(&model, &state, exact)
}

#[test]
fn linear_fields_on_all_cells() {
    let plane = |x: &Point<2>| Point::<2>::new(0.1 + 0.3 * x[0] - 0.2 * x[1], 0.4 * x[0] + 0.1 * x[1]);
    let space = |x: &Point<3>| {
        Point::<3>::new(0.3 * x[0] - 0.2 * x[1] + 0.5 * x[2], 0.1 * x[0] + x[2], 0.2 * x[1] - 0.4 * x[2] + 0.3)
    };
    let read = |name: &str| {
        let path = format!("{}/../fem/tests/data/{name}_41_txt.msh", env!("CARGO_MANIFEST_DIR"));
        GmshFile::parse(&std::fs::read(path).unwrap()).unwrap()
    };
    for (name, degree) in [("tri3", 1), ("tri6", 2), ("quad8", 2), ("quad9", 2)] {
        let found = prescribed::<2>(read(name).mesh(None).unwrap(), degree, NU, &plane);
        assert!(found < 1e-12, "{name}: {found:e}");
    }
    for (name, degree) in
        [("tet4", 1), ("tet10", 2), ("wedge6", 1), ("wedge15", 2), ("wedge18", 2), ("hex20", 2), ("hex27", 2)]
    {
        let found = prescribed::<3>(read(name).mesh(None).unwrap(), degree, NU, &space);
        assert!(found < 1e-12, "{name}: {found:e}");
    }
}

/// Gradients of harmonic polynomials need the edge and side functions, and the fit of what is prescribed on them.
#[test]
fn quadratic_and_cubic_fields() {
    let quadratic = |x: &Point<2>| Point::<2>::new(3.0 * (x[0] * x[0] - x[1] * x[1]), -6.0 * x[0] * x[1]);
    let quartic = |x: &Point<2>| {
        let (a, b) = (x[0], x[1]);
        Point::<2>::new(4.0 * a.powi(3) - 12.0 * a * b * b, -12.0 * a * a * b + 4.0 * b.powi(3))
    };
    let in_space = |x: &Point<3>| Point::<3>::new(x[1] * x[2], x[0] * x[2], x[0] * x[1]);
    let plane =
        || block::<2>(&[even(0.0, 1.0, 3), even(-0.5, 0.5, 2)], 1, |x| Point::<2>::new(x[0] + 0.2 * x[1], x[1]));
    for degree in [2, 3, 5] {
        // Nearly incompressible too: these fields keep their volume, and the pressure is projected.
        for poissons_ratio in [NU, 0.4999] {
            let found = prescribed::<2>(plane(), degree, poissons_ratio, &quadratic);
            assert!(found < 1e-10, "degree {degree}, {poissons_ratio}: {found:e}");
            if degree > 2 {
                let found = prescribed::<2>(plane(), degree, poissons_ratio, &quartic);
                assert!(found < 1e-10, "degree {degree}, {poissons_ratio}: {found:e}");
            }
        }
        let mesh = block::<3>(&[even(0.0, 1.0, 2), even(0.0, 1.0, 2), even(0.0, 2.0, 2)], 1, |x| x);
        assert!(prescribed::<3>(mesh, degree, NU, &in_space) < 1e-11);
    }
}

#[test]
fn beds_body_forces_tractions_and_plane_stress() {
    let bar = || block::<2>(&[even(0.0, 0.5, 2), even(0.0, 2.0, 4)], 1, |x| x);
    let groups = bar().groups().clone();
    let whole = Group { cells: (0..8).collect(), ..Group::default() };
    let material = |poissons_ratio| Elastic { youngs_modulus: E, poissons_ratio };
    let zero = |_: usize, _: &Point<2>| Point::<2>::zeros();

    // Its own weight: u = -w (L y - y²/2) / E.
    let mut bodies = Bodies::<2>::new(Space::PlaneStress);
    bodies.add("bar", bar(), 2, material(0.0));
    let weight = load(&bodies, &whole, LoadKind::BodyForce, Point::<2>::new(0.0, -0.3));
    assert!((loads::resultant(&bodies, &weight)[1] + 0.3).abs() < 1e-14);
    let held = vec![support("base", &groups["bottom"], SupportKind::Components(vec![true, true]))];
    let (model, state) = solve(bodies, held, weight, &zero);
    let exact = |x: &Point<2>| Point::<2>::new(0.0, -0.3 * (2.0 * x[1] - 0.5 * x[1] * x[1]) / E);
    assert!(error(&model, &state, &exact) < 1e-13);
    assert!((state.support_forces[0][1] - 0.3).abs() < 1e-13);

    // Pulled in plane stress: the bar becomes thinner by ν σ / E.
    let mut bodies = Bodies::<2>::new(Space::PlaneStress);
    bodies.add("bar", bar(), 1, material(NU));
    let pull = load(&bodies, &groups["top"], LoadKind::Traction, Point::<2>::new(0.0, 0.7));
    let held = vec![
        support("base", &groups["bottom"], SupportKind::Normal),
        support("left", &groups["left"], SupportKind::Normal),
    ];
    let (model, state) = solve(bodies, held, pull, &zero);
    let exact = |x: &Point<2>| Point::<2>::new(-NU * 0.7 / E * x[0], 0.7 / E * x[1]);
    assert!(error(&model, &state, &exact) < 1e-13);

    // On a bed of stiffness 4 per area: the bar sinks by p / 4 as a whole besides.
    let mut bodies = Bodies::<2>::new(Space::PlaneStress);
    bodies.add("bar", bar(), 2, material(NU));
    let press = load(&bodies, &groups["top"], LoadKind::Pressure, Point::<2>::new(0.6, 0.0));
    let held = vec![
        support("bed", &groups["bottom"], SupportKind::Spring(vec![0.0, 4.0])),
        support("left", &groups["left"], SupportKind::Normal),
    ];
    let (model, state) = solve(bodies, held, press, &zero);
    assert!(model.free_modes().is_empty());
    let exact = |x: &Point<2>| Point::<2>::new(NU * 0.6 / E * x[0], -0.6 / 4.0 - 0.6 / E * x[1]);
    assert!(error(&model, &state, &exact) < 1e-12);
}

/// A bed under one body does not hold another, nor across its direction.
#[test]
fn what_a_bed_does_not_hold_is_named() {
    let square = || block::<2>(&[even(0.0, 1.0, 2), even(0.0, 1.0, 2)], 1, |x| x);
    let groups = square().groups().clone();
    let mut bodies = Bodies::<2>::new(Space::PlaneStrain);
    for name in ["bedded", "loose"] {
        bodies.add(name, square(), 1, Elastic { youngs_modulus: E, poissons_ratio: NU });
    }
    let bed = support("bed", &groups["bottom"], SupportKind::Spring(vec![0.0, 4.0]));
    let model = Model::new(bodies, vec![bed], Vec::new()).unwrap();
    let of = |name: &str| model.free_modes().iter().filter(|m| m.body == name).count();
    assert_eq!((of("bedded"), of("loose")), (1, 3));
    let bedded = model.free_modes().iter().find(|m| m.body == "bedded").unwrap();
    assert_eq!(bedded.motion, "to translate along x");
}
