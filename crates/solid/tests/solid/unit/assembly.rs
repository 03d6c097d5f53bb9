//! Identities of stiffness, loads, supports and free modes, on boxes small enough to know all of them.

use nalgebra::Matrix3;
use signorini_fem::Group;
use signorini_fem::block::block;
use signorini_geometry::Point;
use signorini_solid::body::Bodies;
use signorini_solid::loads::{Load, LoadKind, forces, resultant};
use signorini_solid::material::{Elastic, Space};
use signorini_solid::rigid_modes::free_modes;
use signorini_solid::supports::{Reduction, Support, SupportError, SupportKind};
use signorini_solid::testing::assemble;

const ELASTIC: Elastic = Elastic { youngs_modulus: 2.0, poissons_ratio: 0.3 };

/// A box of 2 × 3 (× 2) cells, 1 × 1.5 (× 0.8), turned and sheared by an affine map; its corner is away from the axis.
fn bodies<const D: usize>(space: Space, degree: usize, map: impl Fn(Point<D>) -> Point<D>) -> Bodies<D> {
    let axes = std::array::from_fn(|k| [vec![0.0, 0.4, 1.0], vec![0.0, 0.5, 1.1, 1.5], vec![0.0, 0.3, 0.8]][k].clone());
    let mut out = Bodies::<D>::new(space);
    out.add("box", block::<D>(&axes, 1, map), degree, ELASTIC);
    out
}

fn sheared<const D: usize>(x: Point<D>) -> Point<D> {
    Point::<D>::from_fn(|k, _| x[k] + 0.3 * x[(k + 1) % D] + if k == 0 { 2.0 } else { 0.0 })
}

/// The coefficients of an affine displacement: its values at vertices, and nothing of higher functions.
fn affine<const D: usize>(bodies: &Bodies<D>, u: impl Fn(&Point<D>) -> Point<D>) -> Vec<f64> {
    let mut out = vec![0.0; bodies.unknowns()];
    let body = &bodies.list[0];
    for (node, x) in body.mesh.nodes().iter().enumerate() {
        if let Some(f) = body.dofs.vertex(node as u32) {
            (0..D).for_each(|i| out[f as usize * D + i] = u(x)[i]);
        }
    }
    out
}

fn group<const D: usize>(bodies: &Bodies<D>, name: &str) -> Group {
    bodies.list[0].mesh.groups()[name].clone()
}

fn support<const D: usize>(bodies: &Bodies<D>, name: &str, on: &str, kind: SupportKind) -> Support {
    Support { name: name.into(), body: 0, group: group(bodies, on), kind }
}

/// The displacement gradient of the tests.
fn gradient(d: usize) -> Matrix3<f64> {
    let full = Matrix3::new(0.02, 0.05, -0.01, -0.03, 0.01, 0.04, 0.02, -0.02, 0.03);
    Matrix3::from_fn(|i, j| if i < d && j < d { full[(i, j)] } else { 0.0 })
}

/// The energy of a uniform strain is `½ σ:ε` times the volume, and no force acts within.
fn uniform_strain<const D: usize>(space: Space, degree: usize) {
    let bodies = bodies::<D>(space, degree, sheared);
    let stiffness = assemble(&bodies, &[]);
    let h = gradient(D);
    let u = affine(&bodies, |x| Point::<D>::from_fn(|i, _| (0..D).map(|j| h[(i, j)] * x[j]).sum()));
    let forces = stiffness.multiply(&u);
    let energy = 0.5 * forces.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>();
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
    // Forces are the tractions on the boundary.
    let boundary = Load { name: "all".into(), body: 0, group: group(&bodies, "boundary"), kind: LoadKind::Traction };
    let body = &bodies.list[0];
    let on_boundary: std::collections::BTreeSet<usize> = forces_of_sides(&bodies, &boundary);
    for k in (0..body.unknowns()).filter(|k| !on_boundary.contains(k)) {
        assert!(forces[k].abs() < 1e-14, "unknown {k}: {}", forces[k]);
    }
}

/// The unknowns of sides.
fn forces_of_sides<const D: usize>(bodies: &Bodies<D>, load: &Load) -> std::collections::BTreeSet<usize> {
    let body = &bodies.list[0];
    let functions = load.group.sides.iter().flat_map(|side| {
        let list = body.dofs.functions(side.cell as usize);
        body.dofs.on_side(*side).into_iter().map(move |k| list[k] as usize)
    });
    functions.flat_map(|f| (0..D).map(move |i| f * D + i)).collect()
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
        let bodies = bodies::<2>(Space::Axisymmetric, degree, |x| Point::<2>::new(x[0] + 1.0, x[1]));
        let u = affine(&bodies, |x| Point::<2>::new(a * x[0], b * x[1]));
        let forces = assemble(&bodies, &[]).multiply(&u);
        let energy = 0.5 * forces.iter().zip(&u).map(|(f, u)| f * u).sum::<f64>();
        let (lambda, mu) = ELASTIC.lame(Space::Axisymmetric);
        let density = 0.5 * lambda * (2.0 * a + b).powi(2) + mu * (2.0 * a * a + b * b);
        let exact = density * std::f64::consts::PI * (4.0 - 1.0) * 1.5;
        assert!((energy / exact - 1.0).abs() < 1e-12, "degree {degree}: {energy}, {exact}");
    }
}

fn rigid_motions<const D: usize>(space: Space) {
    let bodies = bodies::<D>(space, 2, sheared);
    let stiffness = assemble(&bodies, &[]);
    let most = stiffness.largest();
    let mut spin = Matrix3::zeros();
    (spin[(0, 1)], spin[(1, 0)]) = (-1.0, 1.0);
    if D == 3 {
        (spin[(1, 2)], spin[(2, 1)]) = (0.7, -0.7);
    }
    for k in 0..=D {
        let u = affine(&bodies, |x| match k {
            k if k < D => Point::<D>::from_fn(|i, _| f64::from(u8::from(i == k))),
            _ => Point::<D>::from_fn(|i, _| (0..D).map(|j| spin[(i, j)] * x[j]).sum()),
        });
        let worst = stiffness.multiply(&u).iter().fold(0.0f64, |m, f| m.max(f.abs()));
        assert!(worst < 1e-13 * most, "motion {k}: {worst:e}");
    }
}

#[test]
fn rigid_motions_meet_no_force() {
    rigid_motions::<2>(Space::PlaneStress);
    rigid_motions::<3>(Space::Solid);
}

/// A pressure on the whole boundary has no resultant, one on a side pushes it inwards, a force is spread over its area, and a
/// body force counts by volume.
#[test]
fn loads_have_their_resultants() {
    let bodies = bodies::<3>(Space::Solid, 2, |x| x);
    let load = |on: &str, kind| Load { name: "load".into(), body: 0, group: group(&bodies, on), kind };
    let of = |on: &str, kind, value: [f64; 3]| {
        resultant(&bodies, &forces(&bodies, &load(on, kind), &|_| Point::<3>::from(value)))
    };
    assert!(of("boundary", LoadKind::Pressure, [2.0, 0.0, 0.0]).norm() < 1e-13);
    let near = |found: Point<3>, exact: [f64; 3]| (found - Point::<3>::from(exact)).norm() < 1e-13;
    assert!(near(of("top", LoadKind::Pressure, [2.0, 0.0, 0.0]), [0.0, 0.0, -2.0 * 1.5]));
    assert!(near(of("left", LoadKind::Pressure, [2.0, 0.0, 0.0]), [2.0 * 1.5 * 0.8, 0.0, 0.0]));
    assert!(near(of("top", LoadKind::Traction, [1.0, 2.0, 3.0]), [1.5, 3.0, 4.5]));
    assert!(near(of("right", LoadKind::Force, [1.0, 2.0, 3.0]), [1.0, 2.0, 3.0]));
    let mut whole = load("boundary", LoadKind::BodyForce);
    whole.group.cells = (0..bodies.list[0].mesh.cell_count() as u32).collect();
    let weight = resultant(&bodies, &forces(&bodies, &whole, &|_| Point::<3>::new(0.0, 0.0, -1.0)));
    assert!(near(weight, [0.0, 0.0, -1.2]));
}

/// Where two supports prescribe the same direction of a point they have to agree, and where they do they count once.
#[test]
fn supports_may_overlap_but_not_contradict() {
    let bodies = bodies::<2>(Space::PlaneStrain, 2, |x| x);
    let all = || SupportKind::Components(vec![true, true]);
    let supports = [
        support(&bodies, "floor", "bottom", all()),
        support(&bodies, "wall", "left", SupportKind::Components(vec![true, false])),
    ];
    let reduction = Reduction::new(&bodies, &supports).unwrap();
    let line = |x: &Point<2>| Point::<2>::new(0.3 * x[1], 0.1 * x[0]);
    let offset = reduction.offset(&bodies, &supports, &|_, x| line(x)).unwrap();
    let corner = bodies.list[0].mesh.nodes().iter().position(|x| x.norm() == 0.0).unwrap();
    let at = 2 * bodies.list[0].dofs.vertex(corner as u32).unwrap() as usize;
    assert!(reduction.is_held(at) && reduction.is_held(at + 1) && offset[at] == 0.0 && offset[at + 1] == 0.0);
    // The affine displacement that they prescribe is kept by all of its functions.
    let u = affine(&bodies, line);
    for (k, (c, u)) in offset.iter().zip(&u).enumerate() {
        let wanted = if reduction.is_held(k) { *u } else { 0.0 };
        assert!((c - wanted).abs() < 1e-15, "unknown {k}: {c}, {wanted}");
    }
    let moved = |support: usize, x: &Point<2>| line(x) + Point::<2>::repeat(if support == 0 { 0.0 } else { 0.01 });
    match reduction.offset(&bodies, &supports, &moved) {
        Err(SupportError::Contradiction { first, second, a, b, .. }) => {
            assert_eq!((first.as_str(), second.as_str()), ("floor", "wall"));
            assert!((b - a - 0.01).abs() < 1e-15);
        }
        other => panic!("{:?}", other.err()),
    }
}

/// Along the normal of a tilted side one direction goes, the other stays; `T` and `c` are normal to each other.
#[test]
fn a_normal_support_leaves_what_slides() {
    let turn = nalgebra::Rotation2::new(0.4);
    let bodies = bodies::<2>(Space::PlaneStrain, 2, |x| turn * x);
    let supports = [support(&bodies, "ramp", "bottom", SupportKind::Normal)];
    let reduction = Reduction::new(&bodies, &supports).unwrap();
    let functions = reduction.constraints(0).count();
    assert_eq!(functions, 1);
    let offset = reduction.offset(&bodies, &supports, &|_, _| Point::<2>::new(0.2, 0.0)).unwrap();
    let (along, normal) = (turn * Point::<2>::new(1.0, 0.0), turn * Point::<2>::new(0.0, -1.0));
    let y: Vec<f64> = (0..reduction.unknowns).map(|k| (k as f64 + 0.5).sin()).collect();
    let u = reduction.expand(&y, &offset);
    for (f, direction) in
        (0..bodies.unknowns() / 2).filter_map(|f| Some((f, reduction.constraints(f as u32).next()?.1)))
    {
        let u = Point::<2>::new(u[2 * f], u[2 * f + 1]);
        assert!((direction - normal).norm() < 1e-14);
        // 0.2 along the outward normal at vertices; higher functions have no part of a constant.
        let is_vertex = offset[2 * f] != 0.0 || offset[2 * f + 1] != 0.0;
        let wanted = if is_vertex { 0.2 } else { 0.0 };
        assert!((u.dot(&normal) - wanted).abs() < 1e-14 && u.dot(&along).abs() > 0.0);
    }
    // `Tᵀ` is the transpose of `T`.
    let f: Vec<f64> = (0..bodies.unknowns()).map(|k| (0.7 * k as f64).cos()).collect();
    let zero = vec![0.0; f.len()];
    let (left, right): (f64, f64) = (
        reduction.expand(&y, &zero).iter().zip(&f).map(|(a, b)| a * b).sum(),
        reduction.restrict(&f).iter().zip(&y).map(|(a, b)| a * b).sum(),
    );
    assert!((left - right).abs() < 1e-13);
    // A bent side has no normal of its own.
    let bent = self::bodies::<2>(Space::PlaneStrain, 1, |x| Point::<2>::new(x[0], x[1] + 0.1 * x[0] * x[0]));
    let supports = [support(&bent, "ramp", "bottom", SupportKind::Normal)];
    assert!(matches!(Reduction::new(&bent, &supports), Err(SupportError::NotFlat { degrees, .. }) if degrees > 1.0));
}

#[test]
fn a_uniform_support_has_one_displacement_for_all() {
    let bodies = bodies::<2>(Space::PlaneStrain, 2, |x| x);
    let supports = [support(&bodies, "plate", "top", SupportKind::Uniform(vec![false, true]))];
    let reduction = Reduction::new(&bodies, &supports).unwrap();
    // Three vertices and two edges along y: one unknown in place of five.
    assert_eq!((reduction.tied(), reduction.unknowns), (1, bodies.unknowns() - 5 + 1));
    let mut y = vec![0.0; reduction.unknowns];
    y[0] = 0.7;
    let u = reduction.expand(&y, &vec![0.0; bodies.unknowns()]);
    assert_eq!(u.iter().filter(|v| **v == 0.7).count(), 3);
    assert_eq!(u.iter().filter(|v| **v != 0.0).count(), 3);
}

/// An elastic bed under a rigid push has the energy `½ k A d²`, and holds nothing else.
#[test]
fn a_bed_is_a_spring_for_each_area() {
    let bodies = bodies::<3>(Space::Solid, 2, |x| x);
    let supports = [support(&bodies, "soil", "bottom", SupportKind::Spring(vec![0.0, 0.0, 7.0]))];
    let stiffness = assemble(&bodies, &supports);
    for (direction, exact) in [(0, 0.0), (2, 0.5 * 7.0 * 1.5 * 0.01)] {
        let u = affine(&bodies, |_| Point::<3>::from_fn(|i, _| if i == direction { 0.1 } else { 0.0 }));
        let energy = 0.5 * stiffness.multiply(&u).iter().zip(&u).map(|(f, u)| f * u).sum::<f64>();
        assert!((energy - exact).abs() < 1e-14, "along {direction}: {energy}");
    }
}

#[test]
fn free_modes_are_those_that_supports_leave() {
    fn count<const D: usize>(space: Space, on: Option<(&str, SupportKind)>) -> usize {
        let bodies = bodies::<D>(space, 1, |x| Point::<D>::from_fn(|k, _| x[k] + if k == 0 { 1.0 } else { 0.0 }));
        let supports: Vec<Support> = on.into_iter().map(|(on, kind)| support(&bodies, "s", on, kind)).collect();
        let reduction = Reduction::new(&bodies, &supports).unwrap();
        free_modes(&bodies, &supports, &reduction).len()
    }
    let along = |which: &[bool]| SupportKind::Components(which.to_vec());
    assert_eq!(count::<2>(Space::PlaneStrain, None), 3);
    assert_eq!(count::<2>(Space::Axisymmetric, None), 1);
    assert_eq!(count::<3>(Space::Solid, None), 6);
    assert_eq!(count::<2>(Space::PlaneStrain, Some(("bottom", along(&[false, true])))), 1);
    assert_eq!(count::<2>(Space::PlaneStrain, Some(("bottom", along(&[true, false])))), 2);
    assert_eq!(count::<3>(Space::Solid, Some(("bottom", along(&[false, false, true])))), 3);
    assert_eq!(count::<3>(Space::Solid, Some(("bottom", SupportKind::Normal))), 3);
    assert_eq!(count::<3>(Space::Solid, Some(("bottom", SupportKind::Spring(vec![0.0, 0.0, 1.0])))), 3);
    assert_eq!(count::<3>(Space::Solid, Some(("bottom", along(&[true; 3])))), 0);
}
