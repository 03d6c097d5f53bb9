//! Tangents of solids, of their loads and of contact between them, against differences.

use super::*;
use nalgebra::DMatrix;
use signorini_fem::{CellShape, Side};
use signorini_solid::{ThermalMaterial, Volumetric};

const LAWS: [StressLaw; 4] = [
    StressLaw::LinearElastic,
    StressLaw::NeoHooke(Volumetric::Quadratic),
    StressLaw::NeoHooke(Volumetric::Logarithmic),
    StressLaw::SaintVenantKirchhoff,
];

fn dense(out: &Contribution) -> DMatrix<f64> {
    let n = out.forces.len();
    let mut matrix = DMatrix::<f64>::zeros(n, n);
    for (unknowns, values) in &out.blocks {
        for (r, i) in unknowns.iter().enumerate() {
            for (c, j) in unknowns.iter().enumerate() {
                matrix[(*i as usize, *j as usize)] += values[r * unknowns.len() + c];
            }
        }
    }
    matrix
}

/// The largest difference of a tangent to central differences, relative to its largest entry.
fn difference(n: usize, u: &[f64], h: f64, of: &dyn Fn(&[f64], Order) -> Contribution) -> f64 {
    let tangent = dense(&of(u, Order::Second));
    let mut worst = 0.0f64;
    for j in 0..n {
        let moved = |h: f64| {
            let mut u = u.to_vec();
            u[j] += h;
            of(&u, Order::First).forces
        };
        let (plus, minus) = (moved(h), moved(-h));
        for i in 0..n {
            worst = worst.max((tangent[(i, j)] - (plus[i] - minus[i]) / (2.0 * h)).abs());
        }
    }
    worst / tangent.amax()
}

fn state(u: &[f64]) -> BodyState {
    BodyState { configuration: u.to_vec(), internal: Vec::new() }
}

/// A temperature that varies from place to place, with large thermal strains.
fn heated<const D: usize>(body: SolidBody<D>) -> SolidBody<D> {
    body.with_heat(ThermalMaterial {
        expansion: Some(Arc::new(|x| 0.02 * (1.0 + 0.5 * x[1]))),
        stress_free: 0.5,
        initial: Arc::new(|x| 2.0 + x[0] - 1.5 * x[0] * x[1]),
        conductivity: None,
        capacity: None,
    })
}

fn check<const D: usize>(mesh: &Mesh<D>, degree: usize, space: Space, nu: f64) {
    for (law, is_heated) in LAWS.into_iter().flat_map(|law| [(law.clone(), false), (law, true)]) {
        let elastic = Elastic { youngs_modulus: 1.0, poissons_ratio: nu };
        let groups = mesh.groups().clone();
        let body =
            SolidBody::new("body", Arc::new(mesh.clone()), degree, (elastic, law.clone()), space, groups).unwrap();
        let body = if is_heated { heated(body) } else { body };
        let start = body.start();
        let state = |u: &[f64]| BodyState { configuration: u.to_vec(), ..start.clone() };
        let n = body.unknowns();
        let seed = &mut 3u64;
        let u: Vec<f64> = (0..n).map(|_| 0.04 * noise(seed)).collect();
        let of = |u: &[f64], order: Order| {
            let mut out = Contribution::new(n);
            body.internal(&state(u), order, &mut out).unwrap();
            out
        };
        let error = difference(n, &u, 1e-5, &of);
        assert!(error < 1e-8, "{} degree {degree} {space:?}: {error:e}", law.name());
        let tangent = dense(&of(&u, Order::Second));
        assert!((&tangent - tangent.transpose()).amax() < 1e-13 * tangent.amax());
        // Forces are the slopes of the energy.
        let direction: Vec<f64> = (0..n).map(|_| noise(seed)).collect();
        let energy = |h: f64| {
            let u: Vec<f64> = u.iter().zip(&direction).map(|(u, d)| u + h * d).collect();
            body.internal(&state(&u), Order::First, &mut Contribution::new(n)).unwrap()
        };
        let slope = (energy(1e-5) - energy(-1e-5)) / 2e-5;
        let work: f64 = of(&u, Order::First).forces.iter().zip(&direction).map(|(f, d)| f * d).sum();
        assert!((slope - work).abs() < 1e-6 * work.abs(), "{}: {slope} {work}", law.name());
        // Pressure that follows, and springs.
        let loaded = |u: &[f64], order: Order| {
            let mut out = Contribution::new(n);
            let pressure = |x: &Point<3>| 1.0 + x[0];
            body.load(Some("top"), &Load::Pressure(&pressure), &state(u), order, &mut out).unwrap();
            body.load(Some("right"), &Load::Springs(v(1.0, 2.0, 3.0)), &state(u), order, &mut out).unwrap();
            if space != Space::Axisymmetric {
                let moment = if D == 2 { v(0.0, 0.0, 0.7) } else { v(0.3, -0.5, 0.7) };
                body.load(Some("top"), &Load::Moment(moment), &state(u), order, &mut out).unwrap();
            }
            out
        };
        let error = difference(n, &u, 1e-5, &loaded);
        assert!(error < 1e-8, "loads on {}: {error:e}", law.name());
    }
}

#[test]
fn of_solids_in_the_plane_and_about_an_axis() {
    for degree in 1..=3 {
        let mesh = rectangle([0.4, 0.0], [1.6, 1.0], [2, 1], degree.min(2), |x| {
            Point::<2>::new(x[0] + 0.2 * x[1] * x[0], x[1] + 0.15 * x[0] * x[0])
        });
        for space in [Space::PlaneStrain, Space::PlaneStress, Space::Axisymmetric] {
            check(&mesh, degree, space, if degree == 2 { 0.45 } else { 0.3 });
        }
    }
    let corners = [[0.5, 0.0], [1.5, 0.1], [1.4, 1.0], [0.4, 0.8]];
    let mut mesh = Mesh::<2>::new(corners.map(Point::<2>::from).to_vec());
    mesh.add_cell(CellShape::Triangle, 1, &[0, 1, 2]);
    mesh.add_cell(CellShape::Triangle, 1, &[0, 2, 3]);
    mesh.group_mut("top").sides = vec![Side { cell: 0, side: 1 }];
    mesh.group_mut("right").sides = vec![Side { cell: 0, side: 0 }];
    (1..=2).for_each(|degree| check(&mesh, degree, Space::PlaneStrain, 0.3));
}

#[test]
fn of_solids_in_space() {
    for degree in 1..=3 {
        let mesh = cuboid([0.0; 3], [1.0; 3], [1, 1, 1], |x| {
            x + Point::<3>::new(0.2 * x[1] * x[2], 0.1 * x[0] * x[2], 0.15 * x[0] * x[1])
        });
        check(&mesh, degree, Space::Solid, if degree == 2 { 0.45 } else { 0.3 });
    }
}

#[test]
fn laws_of_finite_strain_start_with_the_stiffness_of_small_strain() {
    for (degree, nu) in [(1, 0.3), (1, 0.499), (2, 0.3), (2, 0.499)] {
        let mesh = rectangle([0.0, 0.0], [2.0, 1.0], [2, 1], 1, |x| Point::<2>::new(x[0] + 0.2 * x[1], x[1]));
        let elastic = Elastic { youngs_modulus: 1.0, poissons_ratio: nu };
        let tangent = |law: StressLaw| {
            let body = solid("body", mesh.clone(), degree, elastic, law.clone());
            let mut out = Contribution::new(body.unknowns());
            body.internal(&body.start(), Order::Second, &mut out).unwrap();
            dense(&out)
        };
        let small = tangent(LAWS[0].clone());
        for law in &LAWS[1..] {
            assert!((tangent(law.clone()) - &small).amax() < 1e-12 * small.amax(), "{} {degree} {nu}", law.name());
        }
    }
}

#[test]
fn pressure_on_a_closed_surface_has_a_potential() {
    for degree in 1..=2 {
        let body = solid("body", cuboid([0.0; 3], [1.0; 3], [1, 1, 1], |x| x), degree, ELASTIC, LAWS[1].clone());
        let seed = &mut 5u64;
        let u: Vec<f64> = (0..body.unknowns()).map(|_| 0.05 * noise(seed)).collect();
        let mut out = Contribution::new(body.unknowns());
        body.load(Some("boundary"), &Load::Pressure(&|_| 1.0), &state(&u), Order::Second, &mut out).unwrap();
        let tangent = dense(&out);
        assert!((&tangent - tangent.transpose()).amax() < 1e-13 * tangent.amax());
    }
}

/// The largest difference between the tangent of a contact and differences, relative to its largest entry.
fn contact<const D: usize>(
    [upper, lower]: [Mesh<D>; 2],
    degree: usize,
    test: impl Into<Test>,
    enforcement: Enforcement,
    mu: Option<f64>,
) -> f64 {
    let bodies = vec![("upper", upper), ("lower", lower)];
    of_parts(bodies, [(0, "bottom"), (1, "top")], degree, test.into(), (enforcement, mu))
}

fn of_parts<const D: usize>(
    bodies: Vec<(&str, Mesh<D>)>,
    parts: [(usize, &str); 2],
    degree: usize,
    test: Test,
    (enforcement, mu): (Enforcement, Option<f64>),
) -> f64 {
    let mut system = System::default();
    for (name, mesh) in bodies {
        system.bodies.push(Box::new(solid(name, mesh, degree, ELASTIC, StressLaw::LinearElastic)));
    }
    touch(&mut system, parts, test, enforcement, mu);
    system.prepare().unwrap();
    let count: usize = system.bodies.iter().map(|b| b.unknowns()).sum();
    let start = system.start();
    let n = count + start.multipliers.len();
    let seed = &mut 11u64;
    let mut random =
        |size: f64| -> Vec<f64> { (0..n).map(|k| if k < count { size * noise(seed) } else { 0.0 }).collect() };
    let mut state = system.advance(&start, &random(0.005), 1.0);
    system.accept(&state).unwrap();
    state = system.advance(&state, &random(0.01), 1.0);
    let parts = match (mu, test) {
        (None, _) => 1,
        (_, Test::Mortar(_)) => D,
        _ => 3,
    };
    for own in state.multipliers.chunks_mut(parts) {
        own[0] = 3.0;
        own.iter_mut().skip(1).enumerate().for_each(|(i, t)| *t = 0.02 + 0.01 * i as f64);
    }
    let (residual, matrix) = system.linearise(&state, 0.0).unwrap();
    let own: f64 = residual[..count].iter().map(|r| r.abs()).sum();
    assert!(own > 1e-3);
    let h = 1e-6;
    let (mut worst, mut scale) = (0.0f64, 0.0f64);
    for j in 0..n {
        let moved = |h: f64| {
            let mut step = vec![0.0; n];
            step[j] = h;
            system.linearise(&system.advance(&state, &step, 1.0), 0.0).unwrap().0
        };
        let (plus, minus) = (moved(h), moved(-h));
        for i in 0..n {
            scale = scale.max(matrix.get(i, j).abs());
            worst = worst.max((matrix.get(i, j) - (plus[i] - minus[i]) / (2.0 * h)).abs());
        }
    }
    worst / scale
}

const ENFORCEMENTS: [Enforcement; 3] =
    [Enforcement::Penalty { wanted_penetration: None }, Enforcement::AugmentedLagrangian, Enforcement::Multiplier];

#[test]
fn of_contacts_in_the_plane() {
    for degree in 1..=3 {
        for sampling in [Sampling::Nodes, Sampling::GaussPoints] {
            for enforcement in ENFORCEMENTS {
                for mu in [None, Some(30.0), Some(0.05)] {
                    let order = degree.min(2);
                    let upper = rectangle([0.1, 0.0], [0.83, 0.5], [1, 1], order, |x| {
                        Point::<2>::new(x[0], x[1] - 0.02 + 0.1 * (x[0] - 0.5).powi(2))
                    });
                    let lower = rectangle([-0.3, -0.6], [1.4, 0.0], [2, 1], order, |x| {
                        Point::<2>::new(x[0], x[1] + 0.05 * x[0] * x[0] * (x[1] + 0.6))
                    });
                    let error = contact([upper, lower], degree, sampling, enforcement, mu);
                    assert!(error < 1e-6, "degree {degree} {sampling:?} {enforcement:?} {mu:?}: {error:e}");
                }
            }
        }
    }
}

#[test]
fn of_contacts_over_a_ridge() {
    // Nodes beside the faces of a roof meet its ridge.
    for mu in [None, Some(0.05), Some(30.0)] {
        let upper = rectangle([-0.1, 0.02], [0.1, 0.2], [2, 1], 1, |x| x);
        let lower = rectangle([-1.0, -2.0], [1.0, 0.0], [2, 1], 1, |x| {
            Point::<2>::new(x[0], x[1] - 1.2 * x[0].abs() * (0.5 * x[1] + 1.0))
        });
        let error = contact([upper, lower], 1, Sampling::Nodes, Enforcement::Multiplier, mu);
        // The second variation of the slip leaves out what vanishes with the gap.
        let allowed = if mu.is_none() { 1e-5 } else { 2e-2 };
        assert!(error < allowed, "{mu:?}: {error:e}");
    }
}

#[test]
fn of_contacts_in_space() {
    for degree in 1..=2 {
        for sampling in [Sampling::Nodes, Sampling::GaussPoints] {
            for (enforcement, mu) in
                [(ENFORCEMENTS[0], Some(0.05)), (ENFORCEMENTS[2], Some(30.0)), (ENFORCEMENTS[1], None)]
            {
                let upper = cuboid([0.13, 0.11, 0.0], [0.77, 0.66, 0.5], [1, 1, 1], |mut x| {
                    x[2] += 0.05 * x[0] - 0.06;
                    x
                });
                let lower = cuboid([0.0, 0.0, -0.6], [1.0, 1.0, 0.0], [1, 1, 1], |mut x| {
                    x[2] += 0.06 * x[0] * x[1] * (x[2] + 0.6) - 0.02 * x[1];
                    x
                });
                let error = contact([upper, lower], degree, sampling, enforcement, mu);
                assert!(error < 1e-6, "degree {degree} {sampling:?} {enforcement:?} {mu:?}: {error:e}");
            }
        }
    }
    // Over an edge, and over the tip of a pyramid.
    for tip in [0.0, 1.0] {
        for mu in [None, Some(30.0), Some(0.05)] {
            let upper = cuboid([-0.1, -0.12, 0.02], [0.1, 0.1, 0.2], [1, 1, 1], |x| x);
            let lower = cuboid([-1.0, -1.0, -1.0], [1.0, 1.0, 0.0], [2, 2, 1], |mut x| {
                x[2] -= (1.2 * x[0].abs() + 1.1 * tip * x[1].abs()) * 0.4 * (x[2] + 1.0);
                x
            });
            let error = contact([upper, lower], 1, Sampling::Nodes, Enforcement::Multiplier, mu);
            assert!(error < 1e-5, "tip {tip} {mu:?}: {error:e}");
        }
    }
}

/// A shoe over two cells of a block, covered completely.
fn shoe(degree: usize) -> [Mesh<2>; 2] {
    let order = degree.min(2);
    let upper = rectangle([0.1, 0.0], [0.83, 0.5], [2, 1], order, |x| {
        Point::<2>::new(x[0], x[1] - 0.02 + 0.1 * (x[0] - 0.5).powi(2))
    });
    let lower = rectangle([-0.3, -0.6], [1.4, 0.0], [3, 1], order, |x| {
        Point::<2>::new(x[0], x[1] + 0.05 * x[0] * x[0] * (x[1] + 0.6))
    });
    [upper, lower]
}

#[test]
fn of_mortar_in_the_plane() {
    for degree in 1..=3 {
        for enforcement in ENFORCEMENTS {
            for mu in [None, Some(30.0), Some(2e-3)] {
                // With many points, so that what cuts change does not hide in the error of the rule.
                let error = contact(shoe(degree), degree, Test::Mortar(8), enforcement, mu);
                println!("degree {degree} {enforcement:?} {mu:?}: {error:e}");
                assert!(error < 1e-6, "degree {degree} {enforcement:?} {mu:?}: {error:e}");
            }
        }
    }
}

/// Two meshes as one, with the bottom of the first and the top of the second.
fn joined<const D: usize>([a, b]: [Mesh<D>; 2]) -> Mesh<D> {
    let mut out = Mesh::new(a.nodes().iter().chain(b.nodes()).copied().collect());
    for (mesh, first) in [(&a, 0), (&b, a.nodes().len() as u32)] {
        for cell in 0..mesh.cell_count() {
            let nodes: Vec<u32> = mesh.cell_nodes(cell).iter().map(|n| n + first).collect();
            out.add_cell(mesh.shape(cell), mesh.map(cell).order(), &nodes);
        }
    }
    out.group_mut("bottom").sides.clone_from(&a.groups()["bottom"].sides);
    let top = b.groups()["top"].sides.iter().map(|side| Side { cell: side.cell + a.cell_count() as u32, ..*side });
    out.group_mut("top").sides = top.collect();
    out
}

#[test]
fn of_mortar_of_a_body_with_itself() {
    for degree in 1..=2 {
        for (enforcement, mu) in [(ENFORCEMENTS[2], None), (ENFORCEMENTS[1], Some(2e-3)), (ENFORCEMENTS[2], Some(30.0))]
        {
            let mesh = joined(shoe(degree));
            let parts = [(0, "bottom"), (0, "top")];
            let error = of_parts(vec![("body", mesh)], parts, degree, Test::Mortar(8), (enforcement, mu));
            println!("degree {degree} {enforcement:?} {mu:?}: {error:e}");
            assert!(error < 1e-6, "degree {degree} {enforcement:?} {mu:?}: {error:e}");
        }
    }
}

#[test]
fn of_mortar_in_space() {
    // With many points: those of a warped face move with it.
    for (enforcement, mu) in [(ENFORCEMENTS[0], Some(8e-3)), (ENFORCEMENTS[2], Some(30.0)), (ENFORCEMENTS[1], None)] {
        let upper = cuboid([0.13, 0.11, 0.0], [0.77, 0.66, 0.5], [1, 1, 1], |mut x| {
            x[2] += 0.05 * x[0] - 0.06;
            x
        });
        let lower = cuboid([0.0, 0.0, -0.6], [1.0, 1.0, 0.0], [1, 1, 1], |mut x| {
            x[2] += 0.06 * x[0] * x[1] * (x[2] + 0.6) - 0.02 * x[1];
            x
        });
        let error = contact([upper, lower], 1, Test::Mortar(6), enforcement, mu);
        println!("{enforcement:?} {mu:?}: {error:e}");
        assert!(error < 1e-6, "{enforcement:?} {mu:?}: {error:e}");
    }
}
