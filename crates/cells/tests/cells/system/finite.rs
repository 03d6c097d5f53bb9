//! Cells of laws at finite strain and with plastic strain.

use super::contacts::{moved, rigid};
use super::*;
use signorini_cells::shapes::ball;
use signorini_cells::{BoundaryPoint, SolidMaterial, StressLaw};
use signorini_contact::Coulomb;
use signorini_geometry::Matrix;
use signorini_geometry::implicit::HalfSpace;
use signorini_geometry::rigid_shape::{Plane, Sphere};
use signorini_material::Volumetric;
use signorini_material::law::{ElasticPlastic, Hardening};

fn neo_hooke() -> SolidMaterial {
    (ELASTIC, StressLaw::NeoHooke(Volumetric::Quadratic)).into()
}

fn plastic(is_finite: bool) -> SolidMaterial {
    let hardening = Hardening::new(&[[0.01, 0.0]], 0.1).unwrap();
    (ELASTIC, StressLaw::ElasticPlastic(ElasticPlastic { hardening, kinematic: 0.0, is_finite })).into()
}

/// A half plane that cuts cells obliquely, or a half space.
fn oblique<const D: usize>() -> Domain<D> {
    let normal = Vector::<D>::from_fn(|k, _| [0.3, 1.0, 0.2][k]);
    Domain::shape(HalfSpace { point: Point::<D>::from_fn(|_, _| 0.6), normal: normal.normalize() })
}

fn body<const D: usize>(
    material: SolidMaterial,
    (domain, n): (Domain<D>, [usize; D]),
    degree: usize,
    space: Space,
    places: Vec<(&str, Place<D>)>,
) -> CellSolid<D> {
    // Beside the axis: on it unknowns vanish.
    let mut corners = [[0.0; D], [1.0; D]];
    if space == Space::Axisymmetric {
        corners.iter_mut().for_each(|x| x[0] += 0.3);
    }
    let tree = CellTree::new(aabb(corners[0], corners[1]), n).unwrap();
    let material = CellMaterial { solid: material, modulus: None, space };
    let body = CellBody::new(Arc::new(domain), tree, Discretisation::of_degree(degree), material).unwrap();
    CellSolid::new("body", body, &named(places)).unwrap()
}

/// Coefficients of a displacement that is linear in the position.
fn linear<const D: usize>(solid: &CellSolid<D>, gradient: Matrix<3>) -> Vec<f64> {
    let mut u = vec![0.0; solid.unknowns()];
    let at_rest = solid.rigid_modes(&solid.start());
    // Turns about the axes give the positions of the functions that span linear fields.
    for f in 0..u.len() / D {
        let z = if D == 3 { -at_rest[3][D * f + 1] } else { 0.0 };
        let position = v(at_rest[5][D * f + 1], -at_rest[5][D * f], z);
        (0..D).for_each(|i| u[D * f + i] = (gradient * position)[i]);
    }
    u
}

/// Forces of a deformed body without supports.
fn forces<const D: usize>(solid: &CellSolid<D>, u: Vec<f64>) -> (f64, Vec<f64>) {
    let mut out = Contribution::new(solid.unknowns());
    let state = BodyState { configuration: u, internal: solid.start().internal };
    let energy = solid.internal(&state, Order::First, &mut out).unwrap();
    (energy, out.forces)
}

#[test]
fn a_turn_has_no_stress_and_a_stretch_that_of_its_law() {
    let turn = |angle: f64| {
        let (s, c) = angle.sin_cos();
        Matrix::<3>::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)
    };
    let stretch = Matrix::<3>::new(1.4, 0.3, 0.0, 0.1, 0.8, 0.0, 0.0, 0.0, 1.0);
    let one = Matrix::<3>::identity();
    for material in [neo_hooke(), plastic(true), (ELASTIC, StressLaw::SaintVenantKirchhoff).into()] {
        let solid = body::<2>(material.clone(), (oblique(), [3, 3]), 3, Space::PlaneStrain, Vec::new());
        let (energy, found) = forces(&solid, linear(&solid, turn(2.0) - one));
        let most = found.iter().fold(0.0f64, |m, f| m.max(f.abs()));
        assert!(energy.abs() < 1e-14 && most < 1e-14, "a turn has energy {energy:e} and forces {most:e}");
        // A turned stretch has the same energy, that of the material, to rounding: cut cells add nothing.
        let solid3 = body::<3>(material.clone(), (oblique(), [2, 2, 2]), 2, Space::Solid, Vec::new());
        let law = material.law();
        let per_volume = law.response(&ELASTIC, &stretch).unwrap().energy;
        for f in [stretch, turn(1.0) * stretch] {
            for (solid, volume) in [
                (forces(&solid, linear(&solid, f - one)).0, solid.cells().volume()),
                (forces(&solid3, linear(&solid3, f - one)).0, solid3.cells().volume()),
            ] {
                assert!((solid / volume / per_volume - 1.0).abs() < 1e-12, "{solid} {volume} {per_volume}");
            }
        }
    }
}

/// All boundary of a cut body held at a stretch by Nitsche's method, or loaded by the tractions of the stretch: the stretch is
/// found, up to rounding and not to the fictitious stiffness.
#[test]
fn a_stretch_of_cut_cells_is_found() {
    let gradient = [[0.4, 0.2], [0.1, -0.25]];
    for degree in [1, 2, 3] {
        let place = Place::boundary(|_| true);
        let places =
            vec![("cut", place), ("left", Place::low(0)), ("bottom", Place::low(1)), ("right", Place::high(0))];
        let solid = body::<2>(neo_hooke(), (oblique(), [3, 3]), degree, Space::PlaneStrain, places);
        let field = |k: usize| -> Option<Arc<dyn Fn(&Point<3>) -> f64 + Send + Sync>> {
            Some(Arc::new(move |x: &Point<3>| gradient[k][0] * x[0] + gradient[k][1] * x[1]))
        };
        let mut system = System { bodies: vec![Box::new(solid)], ..System::default() };
        for on in ["cut", "left", "bottom", "right"] {
            system.supports.push(support(0, on, [field(0), field(1), None]));
        }
        let (state, result) = solve(&mut system);
        let fields = system.bodies[0].fields(&state.bodies[0]);
        let error = (fields.points.iter().zip(&fields.displacement))
            .map(|(x, u)| (0..2).map(|k| (u[k] - gradient[k][0] * x[0] - gradient[k][1] * x[1]).abs()).sum::<f64>())
            .fold(0.0, f64::max);
        println!("degree {degree}: {error:e} in {} iterations", result.iterations);
        assert!(error < 1e-10, "degree {degree}: {error:e}");
    }
}

/// A tube on a rigid shaft of a radius 1.25 times that of its bore: pressure and outer radius by an integration of the equation
/// of equilibrium along the radius.
#[test]
fn a_tube_is_shrunk_on_a_shaft() {
    let (pressure, outer) = (0.2543533657929, 2.165640156287);
    let ring = |radius: f64| Domain::shape(ball(Point::<2>::zeros(), radius));
    let tree = CellTree::new(aabb([0.0, 0.0], [2.05, 2.05]), [6, 6]).unwrap();
    let solid = (Elastic { youngs_modulus: 2.6, poissons_ratio: 0.3 }, StressLaw::NeoHooke(Volumetric::Quadratic));
    let material = CellMaterial { solid: solid.into(), modulus: None, space: Space::PlaneStrain };
    let domain = ring(2.0).without(ring(1.0));
    let body = CellBody::new(Arc::new(domain), tree, Discretisation::of_degree(4), material).unwrap();
    let places = vec![
        ("left", Place::low(0)),
        ("bottom", Place::low(1)),
        ("bore", Place::boundary(|p: &BoundaryPoint<2>| p.x.norm() < 1.5)),
    ];
    let body = CellSolid::new("tube", body, &named(places)).unwrap();
    let shaft = rigid("shaft", Sphere { center: Point::<3>::zeros(), radius: 1.25 }, moved(v(0.0, 0.0, 0.0)));
    let contact = Contact::new(
        "fit",
        (part(0, "bore"), &body),
        (part(1, ""), &shaft),
        Sampling::GaussPoints,
        Enforcement::Nitsche,
    );
    let mut system = System {
        supports: vec![
            support(0, "left", [constant(0.0), None, None]),
            support(0, "bottom", [None, constant(0.0), None]),
        ],
        contacts: vec![Box::new(contact.unwrap())],
        bodies: vec![Box::new(body), Box::new(shaft)],
        ..System::default()
    };
    let (state, found) = solve(&mut system);
    let force: Vector<3> = found.sites[0].iter().map(SiteResult::force).sum();
    let error = force[0] / (1.25 * pressure) - 1.0;
    let fields = system.bodies[0].fields(&state.bodies[0]);
    let farthest =
        fields.points.iter().zip(&fields.displacement).map(|(x, u)| (x + u).norm()).fold(0.0, f64::max) / outer - 1.0;
    println!("pressure {error:e}, radius {farthest:e}, {} iterations", found.iterations);
    assert!(error.abs() < 1e-5 && farthest.abs() < 1e-5, "{error:e} {farthest:e}");
}

/// Taylor remainders of second order by central differences: forces, weak supports, pressure that follows and contact by the
/// stress at finite strain.
#[test]
fn tangents_are_derivatives() {
    for (material, space) in [
        (neo_hooke(), Space::PlaneStrain),
        (neo_hooke(), Space::PlaneStress),
        (neo_hooke(), Space::Axisymmetric),
        (plastic(false), Space::PlaneStrain),
        (plastic(true), Space::PlaneStrain),
        (plastic(false), Space::PlaneStress),
        (plastic(true), Space::PlaneStress),
    ] {
        let has_history = material.law().has_history();
        let places = vec![
            ("cut", Place::boundary(|p| p.x[0] < 0.5)),
            ("loaded", Place::boundary(|p| p.x[0] > 0.5)),
            ("bottom", Place::low(1)),
        ];
        let solid = body::<2>(material, (oblique(), [2, 2]), 2, space, places);
        let mut system = System { bodies: vec![Box::new(solid)], ..System::default() };
        system.supports.push(support(0, "bottom", [constant(0.0), constant(0.0), None]));
        system.supports.push(support(0, "cut", [constant(0.02), constant(0.05), None]));
        let load = TimedLoad::Pressure(Arc::new(|x: &Point<3>, t: f64| t * (0.02 + 0.01 * x[0])));
        system.loads.push(PlacedLoad { name: "pressure".into(), part: part(0, "loaded"), load });
        if !has_history && space != Space::Axisymmetric {
            // A tilted plane that reaches into the body, with friction.
            let normal = v(-0.2, -1.0, 0.0).normalize();
            let lid = rigid("lid", Plane { point: Point::<3>::new(0.6, 0.5, 0.0), normal }, moved(v(0.0, 0.0, 0.0)));
            let slave = (part(0, "loaded"), system.bodies[0].as_ref());
            let mut contact =
                Contact::new("touch", slave, (part(1, ""), &lid), Sampling::GaussPoints, Enforcement::Nitsche).unwrap();
            contact.law.friction = Some(Box::new(Coulomb::isotropic(0.3).unwrap()));
            system.bodies.push(Box::new(lid));
            system.contacts.push(Box::new(contact));
        }
        system.prepare().unwrap();
        let start = system.start();
        let unknowns = system.linearise(&start, 1.0).unwrap().0.len();
        let step: Vec<f64> = (0..unknowns).map(|k| 0.03 * (1.3 * k as f64).sin()).collect();
        let state = system.advance(&start, &step, 1.0);
        let error = tangent_error(&system, &state, 1e-6, 40);
        println!("{space:?} {has_history}: {error:e}");
        assert!(error < 1e-7, "{space:?} {has_history}: {error:e}");
    }
}
