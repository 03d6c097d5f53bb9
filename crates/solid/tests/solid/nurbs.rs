//! Solids of spline patches: patch test, exact tubes, shrink fit, turning masters.

use super::system::{force, hold, load, part, rigid, run, solid};
use signorini_fem::Mesh;
use signorini_fem::nurbs::{NurbsPatch, mesh_of_patches};
use signorini_geometry::rigid_shape::Cylinder;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::*;
use signorini_solid::{Elastic, StressLaw, Volumetric};
use std::f64::consts::FRAC_1_SQRT_2;
use std::sync::Arc;

pub const NEO_HOOKE: StressLaw = StressLaw::NeoHooke(Volumetric::Quadratic);

/// A quarter of a ring between two radii; its sides are `left` at x = 0, `right` at y = 0, `bottom` within, `top` without.
pub fn quarter([a, b]: [f64; 2], turns: usize) -> NurbsPatch<2> {
    let turn = |[x, y]: [f64; 2]| (0..turns).fold([x, y], |[x, y], _| [-y, x]);
    let arc = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0]].map(turn);
    let points = [a, b].iter().flat_map(|r| arc.map(|x| Point::<2>::from(x) * *r)).collect();
    let knots = [vec![0.0, 0.0, 0.0, 1.0, 1.0, 1.0], vec![0.0, 0.0, 1.0, 1.0]];
    NurbsPatch::new("", [2, 1], knots, points, Some([1.0, FRAC_1_SQRT_2, 1.0].repeat(2))).unwrap()
}

/// A box of so many spans, smooth, with the control points inside moved and weights that vary by an amount.
pub fn brick<const D: usize>(
    (low, high): ([f64; D], [f64; D]),
    degree: usize,
    cells: [usize; D],
    (shift, vary): (f64, f64),
) -> Mesh<D> {
    let corners =
        (0..1 << D).map(|c| Point::<D>::from_fn(|k, _| if c >> k & 1 == 1 { high[k] } else { low[k] })).collect();
    let lines = std::array::from_fn(|_| vec![0.0, 0.0, 1.0, 1.0]);
    let mut patch = NurbsPatch::new("", [1; D], lines, corners, None).unwrap().raised(degree, cells).unwrap();
    let counts = patch.counts();
    for n in 0..patch.points.len() {
        let mut rest = n;
        let index: [usize; D] = std::array::from_fn(|k| {
            let at = rest % counts[k];
            rest /= counts[k];
            at
        });
        patch.weights[n] = 1.0 + vary * (1.3 * n as f64).sin();
        for k in (0..D).filter(|&k| index[k] > 0 && index[k] + 1 < counts[k]) {
            patch.points[n][k] += shift * (2.7 * n as f64 + k as f64).cos() * (high[k] - low[k]) / counts[k] as f64;
        }
    }
    mesh_of_patches(&[patch]).unwrap()
}

/// Two blocks pressed together: the largest deviation from one homogeneous state, relative to the displacement.
pub fn patch<const D: usize>(
    [lower, upper]: [Mesh<D>; 2],
    degree: usize,
    (law, poissons_ratio): (&StressLaw, f64),
    extra: usize,
) -> f64 {
    let mut system = System::default();
    let elastic = Elastic { youngs_modulus: 1.0, poissons_ratio };
    for (name, mesh) in [("lower", lower), ("upper", upper)] {
        system.bodies.push(Box::new(solid(name, mesh, degree, elastic, law.clone())));
    }
    let up = D - 1;
    for body in 0..2 {
        for (i, side) in ["left", "front"].into_iter().enumerate().take(D - 1) {
            system.supports.push(hold(body, side, std::array::from_fn(|k| (k == i).then_some(0.0))));
        }
    }
    system.supports.push(hold(0, "bottom", std::array::from_fn(|k| (k == up).then_some(0.0))));
    system.supports.push(hold(1, "top", std::array::from_fn(|k| (k == up).then_some(-0.1))));
    let of = |body: usize, group: &str| (part(body, group), system.bodies[body].as_ref());
    let mut contact = Mortar::new("touch", of(1, "bottom"), of(0, "top"), Enforcement::Multiplier).unwrap();
    contact.refine(extra);
    system.contacts.push(Box::new(contact));
    let (state, _) = run(&mut system, &[1.0]);
    let (mut worst, mut lateral) = (0.0f64, None);
    for (body, state) in system.bodies.iter().zip(&state.bodies) {
        let fields = body.fields(state);
        for (x, u) in fields.points.iter().zip(&fields.displacement) {
            worst = worst.max((u[up] + 0.1 * x[up]).abs());
            if x[0] > 1e-3 {
                worst = worst.max((u[0] / x[0] - *lateral.get_or_insert(u[0] / x[0])).abs());
            }
        }
    }
    worst / 0.1
}

#[test]
fn unlike_splines_pass_the_patch_test() {
    for (degree, law) in [(2, StressLaw::LinearElastic), (2, NEO_HOOKE), (3, NEO_HOOKE), (4, StressLaw::LinearElastic)]
    {
        let lower = brick::<2>(([0.0, 0.0], [1.0, 0.5]), degree, [3, 2], (0.2, 0.0));
        let upper = brick::<2>(([0.0, 0.5], [1.0, 1.0]), degree, [5, 1], (0.2, 0.0));
        // The functions of one side are no polynomials in the coordinates of the other.
        let error = patch([lower, upper], degree, (&law, 0.3), 6);
        println!("degree {degree} {}: {error:.1e}", law.name());
        assert!(error < 1e-10, "degree {degree} {}: {error:e}", law.name());
    }
    // Rational functions are integrated as well as is asked for.
    let lower = brick::<2>(([0.0, 0.0], [1.0, 0.5]), 2, [3, 2], (0.2, 0.1));
    let upper = brick::<2>(([0.0, 0.5], [1.0, 1.0]), 2, [4, 1], (0.2, 0.1));
    let error = patch([lower, upper], 2, (&NEO_HOOKE, 0.3), 6);
    println!("rational: {error:.1e}");
    assert!(error < 1e-8, "rational: {error:e}");
    let lower = brick::<3>(([0.0; 3], [1.0, 1.0, 0.5]), 2, [2, 1, 1], (0.0, 0.0));
    let upper = brick::<3>(([0.0, 0.0, 0.5], [1.0; 3]), 2, [1, 3, 1], (0.0, 0.0));
    let error = patch([lower, upper], 2, (&NEO_HOOKE, 0.3), 0);
    println!("in space: {error:.1e}");
    assert!(error < 1e-10, "in space: {error:e}");
}

/// A quarter of a tube from 1 to 2 under a pressure within: errors of the displacement at the bore and of the energy.
fn lame(degree: usize, cells: usize) -> [f64; 2] {
    let elastic = Elastic { youngs_modulus: 1.0, poissons_ratio: 0.3 };
    let mesh = mesh_of_patches(&[quarter([1.0, 2.0], 0).raised(degree, [cells, cells]).unwrap()]).unwrap();
    let mut system = System::default();
    system.bodies.push(Box::new(solid("tube", mesh, degree, elastic, StressLaw::LinearElastic)));
    system.supports.push(hold(0, "left", [Some(0.0), None, None]));
    system.supports.push(hold(0, "right", [None, Some(0.0), None]));
    system.loads.push(load(0, "bottom", TimedLoad::Pressure(Arc::new(|_, t| 0.1 * t))));
    let (state, _) = run(&mut system, &[1.0]);
    let body = &system.bodies[0];
    // u = (1+ν)/E p a²/(b²-a²) ((1-2ν) r + b²/r).
    let exact = |r: f64| 1.3 * 0.1 / 3.0 * (0.4 * r + 4.0 / r);
    let fields = body.fields(&state.bodies[0]);
    let error = (fields.points.iter().zip(&fields.displacement))
        .map(|(x, u)| (u - x.normalize() * exact(x.norm())).norm())
        .fold(0.0, f64::max);
    let mut out = Contribution::new(body.unknowns());
    let energy = body.internal(&state.bodies[0], Order::First, &mut out).unwrap();
    let wanted = 0.5 * 0.1 * exact(1.0) * std::f64::consts::FRAC_PI_2;
    [error / exact(1.0), (energy - wanted).abs() / wanted]
}

#[test]
fn a_tube_converges_with_the_order_of_its_functions() {
    for degree in [2, 3] {
        let found: Vec<[f64; 2]> = [4, 8, 16].map(|cells| lame(degree, cells)).to_vec();
        let order = |k: usize, i: usize| (found[i][k] / found[i + 1][k]).log2();
        println!("degree {degree}: {found:?}, orders {:.2} {:.2}", order(0, 1), order(1, 1));
        assert!(order(0, 1) > degree as f64 + 0.5, "{found:?}");
        assert!(order(1, 1) > 2.0 * degree as f64 - 0.3, "{found:?}");
    }
}

/// A tube from 1 to 2 pushed on a rigid shaft of radius 1.25: pressure on the shaft and outer radius, by an ordinary differential
/// equation of the radius.
const SHRUNK: [(f64, f64, f64); 2] = [(0.3, 0.2543533657929, 2.165640156287), (0.49, 0.2745640721773, 2.137596280523)];

#[test]
fn a_tube_shrinks_on_a_shaft() {
    // Blocks of at least five cells have one dilatation: at a ratio of 0.49 it takes more of them.
    for ((nu, pressure, outer), cells) in SHRUNK.into_iter().zip([[2, 4], [2, 15]]) {
        let elastic = Elastic { youngs_modulus: 2.0 * (1.0 + nu), poissons_ratio: nu };
        let mesh = mesh_of_patches(&[quarter([1.0, 2.0], 0).raised(4, cells).unwrap()]).unwrap();
        let mut system = System::default();
        system.bodies.push(Box::new(solid("tube", mesh, 4, elastic, NEO_HOOKE)));
        system.supports.push(hold(0, "left", [Some(0.0), None, None]));
        system.supports.push(hold(0, "right", [None, Some(0.0), None]));
        let widened = |i: usize| -> signorini_mechanics::system::TimeField {
            Arc::new(move |x: &Point<3>, t: f64| 0.25 * t * x[i] / x.norm())
        };
        let mut bore = hold(0, "bottom", [None; 3]);
        (0..2).for_each(|i| bore.displacement[i] = Some(widened(i)));
        system.supports.push(bore);
        let (state, _) = run(&mut system, &[0.5, 1.0]);
        let fields = system.bodies[0].fields(&state.bodies[0]);
        let ends = fields.points.iter().zip(&fields.displacement).filter(|(x, _)| x.norm() > 2.0 - 1e-9);
        let (low, high) = ends.map(|(x, u)| (x + u).norm()).fold((f64::MAX, 0.0f64), |(l, h), r| (l.min(r), h.max(r)));
        println!("nu {nu}: outer radius {low:.12} to {high:.12}");
        assert!((low - outer).abs() < 1e-6 && (high - outer).abs() < 1e-6, "{low} {high}");
        // Now by contact: the shaft is there from the start and the tube is drawn on it.
        let mesh = mesh_of_patches(&[quarter([1.0, 2.0], 0).raised(4, cells).unwrap()]).unwrap();
        let mut system = System::default();
        system.bodies.push(Box::new(solid("tube", mesh, 4, elastic, NEO_HOOKE)));
        let zero = Vector::<3>::zeros();
        system
            .bodies
            .push(Box::new(rigid(Cylinder { point: zero, axis: Vector::<3>::z(), radius: 1.25 }, move |_| zero)));
        system.supports.push(hold(0, "left", [Some(0.0), None, None]));
        system.supports.push(hold(0, "right", [None, Some(0.0), None]));
        let of = |body: usize, group: &str| (part(body, group), system.bodies[body].as_ref());
        let contact = Mortar::new("fit", of(0, "bottom"), of(1, ""), Enforcement::Multiplier).unwrap();
        system.contacts.push(Box::new(contact));
        let (state, results) = run(&mut system, &[1.0]);
        let sites = &results[0].sites[0];
        let pressures = sites.iter().map(|s| s.pressure).fold((f64::MAX, 0.0f64), |(l, h), p| (l.min(p), h.max(p)));
        let fields = system.bodies[0].fields(&state.bodies[0]);
        let ends = fields.points.iter().zip(&fields.displacement).filter(|(x, _)| x.norm() > 2.0 - 1e-9);
        let radius = ends.map(|(x, u)| (x + u).norm()).fold(0.0f64, f64::max);
        println!(
            "contact: outer radius {radius:.12}, pressure {pressures:?} x 1/1.25 {}, {}",
            pressures.1 / 1.25,
            force(&results[0], 0)
        );
        assert!((radius - outer).abs() < 1e-6, "{radius} {outer}");
        assert!((force(&results[0], 0).x / 1.25 - pressure).abs() < 1e-6, "{} {pressure}", force(&results[0], 0));
    }
}

/// A turning wheel from 0.5 to 1 under a block that is held at a height: the forces on the block, angle by angle, over as much as
/// a facet takes.
fn turned(wheel: Mesh<2>, degree: usize, [bore, rim]: [&str; 2], method: Sampling) -> Vec<f64> {
    let elastic = Elastic { youngs_modulus: 1.0, poissons_ratio: 0.3 };
    let mut system = System::default();
    let block = brick::<2>(([-0.5, 0.95], [0.5, 1.45]), 2, [14, 2], (0.0, 0.0));
    // Hard, so that it is the shape of the wheel that counts.
    let hard = Elastic { youngs_modulus: 100.0, ..elastic };
    system.bodies.push(Box::new(solid("wheel", wheel, degree, hard, NEO_HOOKE)));
    system.bodies.push(Box::new(solid("block", block, 2, elastic, NEO_HOOKE)));
    system.supports.push(hold(1, "top", [Some(0.0), Some(0.0), None]));
    let turning = |i: usize| -> signorini_mechanics::system::TimeField {
        Arc::new(move |x: &Point<3>, t: f64| {
            let (s, c) = (t - 1.0).max(0.0).sin_cos();
            [c * x.x - s * x.y, s * x.x + c * x.y][i] - x[i]
        })
    };
    let mut held = hold(0, bore, [None; 3]);
    (0..2).for_each(|i| held.displacement[i] = Some(turning(i)));
    system.supports.push(held);
    let of = |body: usize, group: &str| (part(body, group), system.bodies[body].as_ref());
    let contact = Contact::new("touch", of(1, "bottom"), of(0, rim), method, Enforcement::AugmentedLagrangian).unwrap();
    system.contacts.push(Box::new(contact));
    // A facet of the wheel takes an eighth of pi.
    let times: Vec<f64> = (0..=4).map(|k| 1.0 + k as f64 * std::f64::consts::FRAC_PI_8 / 4.0).collect();
    run(&mut system, &times).1.iter().map(|r| force(r, 0).y).collect()
}

#[test]
fn a_spline_is_a_smooth_master() {
    let ripple = |forces: &[f64]| {
        let (low, high) = forces.iter().fold((f64::MAX, f64::MIN), |(l, h), f| (l.min(*f), h.max(*f)));
        (high - low) / (0.5 * (high + low))
    };
    let quarters: Vec<_> = (0..4).map(|k| quarter([0.5, 1.0], k).raised(2, [4, 2]).unwrap()).collect();
    let splines = turned(mesh_of_patches(&quarters).unwrap(), 2, ["bottom", "top"], Sampling::GaussPoints);
    let turn = std::f64::consts::TAU;
    let even = |from: f64, to: f64, n: usize| (0..=n).map(|k| from + (to - from) * k as f64 / n as f64).collect();
    let facets = signorini_fem::block::block::<2>(&[even(0.5, 1.0, 2), even(0.0, turn, 16)], 1, |x| {
        Point::<2>::new(x[0] * x[1].cos(), x[0] * x[1].sin())
    });
    let facets = turned(facets, 2, ["left", "right"], Sampling::GaussPoints);
    println!("ripple of splines {:.2e}, of facets {:.2e}: {splines:?} {facets:?}", ripple(&splines), ripple(&facets));
    assert!(ripple(&splines) < 0.05 * ripple(&facets), "{splines:?} {facets:?}");
}

/// A shaft that is too large for its hub, both quarters of tubes with unlike cells, all turned by an angle: least and largest
/// pressure, by the Gauss points of the slave with Nitsche's method or else by mortar.
fn press_fit(slave: usize, nitsche: bool, angle: f64, excess: f64) -> [f64; 2] {
    let elastic = Elastic { youngs_modulus: 1.0, poissons_ratio: 0.3 };
    let mut system = System::default();
    for (name, radii, cells) in [("shaft", [1.0, 2.0 + excess], [6, 2]), ("hub", [2.0, 3.0], [8, 2])] {
        let mut patch = quarter(radii, 0).raised(3, cells).unwrap();
        let (s, c) = angle.sin_cos();
        patch.points.iter_mut().for_each(|x| *x = Point::<2>::new(c * x[0] - s * x[1], s * x[0] + c * x[1]));
        let mesh = mesh_of_patches(&[patch]).unwrap();
        system.bodies.push(Box::new(solid(name, mesh, 3, elastic, StressLaw::LinearElastic)));
        let body = system.bodies.len() - 1;
        // Planes of symmetry: no displacement along their normals.
        for (group, normal) in [("left", [c, s]), ("right", [-s, c])] {
            let along = Vector::<3>::new(normal[0], normal[1], 0.0);
            let mut plane = hold(body, group, [None; 3]);
            plane.along = Some((along, Arc::new(|_, _| 0.0)));
            system.supports.push(plane);
        }
    }
    let groups = ["top", "bottom"];
    let of = |body: usize| (part(body, groups[body]), system.bodies[body].as_ref());
    let contact: Box<dyn Interaction> = match nitsche {
        false => Box::new(Mortar::new("fit", of(slave), of(1 - slave), Enforcement::Multiplier).unwrap()),
        true => {
            let points = Sampling::GaussPoints;
            Box::new(Contact::new("fit", of(slave), of(1 - slave), points, Enforcement::Nitsche).unwrap())
        }
    };
    system.contacts.push(contact);
    let (_, results) = run(&mut system, &[1.0]);
    let sites = results[0].sites[0].iter();
    sites.map(|s| s.pressure).fold([f64::MAX, 0.0], |[l, h], p| [l.min(p), h.max(p)])
}

#[test]
fn a_press_fit_has_the_pressure_of_lame_whatever_the_slave_and_the_direction() {
    // p = E' δ/(b ((b²+a²)/(b²-a²) + (c²+b²)/(c²-b²))) of two tubes of one material.
    let excess = 2e-4;
    let exact = excess / 0.91 / (2.0 * (5.0 / 3.0 + 13.0 / 5.0));
    for slave in [0, 1] {
        for nitsche in [false, true] {
            let found = press_fit(slave, nitsche, 0.0, excess);
            let turned = press_fit(slave, nitsche, 0.7, excess);
            let error = found.map(|p| p / exact - 1.0);
            println!("slave {slave}, Nitsche {nitsche}: {error:?}, turned {:?}", turned.map(|p| p / exact - 1.0));
            // The stress at points, which Nitsche's method takes, is of one order less than the mean over a function.
            let most = if nitsche { 5e-3 } else { 2e-3 };
            assert!(error.iter().all(|e| e.abs() < most), "{error:?}");
            assert!((0..2).all(|k| (turned[k] / found[k] - 1.0).abs() < 1e-8), "{found:?} {turned:?}");
        }
    }
}
