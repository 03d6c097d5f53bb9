//! The contact patch test: two blocks with unlike meshes, pressed together, carry the pressure through as if they were
//! one (Taylor & Papadopoulos 1991; El-Abbasi & Bathe 2001).

use nalgebra::Matrix3;
use signorini_contact::ContactSurface;
use signorini_fem::block::block;
use signorini_fem::rules::rule;
use signorini_fem::{CellShape, Mesh, Side};
use signorini_geometry::Point;
use signorini_solid::stiffness::displacement_at;
use signorini_solid::*;

const E: f64 = 1000.0;
const NU: f64 = 0.3;
/// A strain of one part in a hundred: with less, the round-off of the gaps shows.
const PRESSURE: f64 = 10.0;

fn even(from: f64, to: f64, n: usize) -> Vec<f64> {
    (0..=n).map(|k| from + (to - from) * k as f64 / n as f64).collect()
}

fn shear(x: f64, amplitude: f64) -> f64 {
    x + amplitude * (std::f64::consts::PI * x).sin()
}

struct Patch {
    degree: usize,
    /// Cells along the interface, below and above.
    cells: [usize; 2],
    /// Moves the nodes of the upper block along the interface.
    distortion: f64,
    upper_is_slave: bool,
    angle: f64,
    enforcement: Enforcement,
}

/// Largest deviation of any stress component at any quadrature point, and of the pressure at any node, relative to the
/// pressure.
fn deviation<const D: usize>(patch: &Patch) -> (f64, f64) {
    let up = D - 1;
    let turn = |x: Point<D>| {
        let (s, c) = patch.angle.sin_cos();
        let mut y = x;
        (y[0], y[up]) = (c * x[0] - s * x[up], s * x[0] + c * x[up]);
        y
    };
    let mesh = |low: f64, high: f64, n: usize, distortion: f64| {
        let axes: [Vec<f64>; D] = std::array::from_fn(|k| if k == up { even(low, high, 2) } else { even(0.0, 1.0, n) });
        block::<D>(&axes, 1.max(patch.degree.min(2)), |mut x| {
            x[0] = shear(x[0], distortion);
            if D == 3 {
                x[1] = shear(x[1], -distortion);
            }
            turn(x)
        })
    };
    let lower = mesh(0.0, 0.5, patch.cells[0], 0.0);
    let upper = mesh(0.5, 1.1, patch.cells[1], patch.distortion);
    lower.check().unwrap();
    upper.check().unwrap();
    let groups = [lower.groups().clone(), upper.groups().clone()];
    let mut bodies = Bodies::<D>::new(if D == 2 { Space::PlaneStrain } else { Space::Solid });
    let material = Elastic { youngs_modulus: E, poissons_ratio: NU };
    bodies.add("lower", lower, patch.degree, material);
    bodies.add("upper", upper, patch.degree, material);
    let normal = |name: &str, body: usize, group: &str| Support {
        name: name.into(),
        body,
        group: groups[body][group].clone(),
        kind: SupportKind::Normal,
    };
    let mut supports = vec![normal("base", 0, "bottom")];
    for body in 0..2 {
        supports.push(normal("x", body, "right"));
        if D == 3 {
            supports.push(normal("y", body, "front"));
        }
    }
    let surfaces =
        [bodies.surface(0, groups[0]["top"].sides.clone()), bodies.surface(1, groups[1]["bottom"].sides.clone())];
    let [low, high] = surfaces;
    let (slave, master) = if patch.upper_is_slave { (high, low) } else { (low, high) };
    let mut contact = Contact::new("interface", slave, Master::Surface(master));
    contact.enforcement = patch.enforcement;
    let mut load = vec![0.0; bodies.unknowns()];
    let mut press = |body: usize, group: signorini_fem::Group| {
        let load_of = Load { name: "p".into(), body, group, kind: LoadKind::Pressure };
        for (a, b) in load.iter_mut().zip(loads::forces(&bodies, &load_of, &|_| Point::<D>::repeat(PRESSURE))) {
            *a += b;
        }
    };
    press(1, groups[1]["top"].clone());
    let mut model = Model::new(bodies, supports, vec![contact]).unwrap();
    let now = Circumstances { displacement: &|_, _| Point::<D>::zeros(), load, rigid: vec![None], motion: vec![] };
    let state = model.solve(&now, &mut |_, _| true).unwrap();
    assert!(state.iterations <= 3);
    let direction = turn(Point::<D>::from_fn(|k, _| f64::from(u8::from(k == up)))) - turn(Point::<D>::zeros());
    let n = nalgebra::Vector3::from_fn(|k, _| if k < D { direction[k] } else { 0.0 });
    let mut exact = -PRESSURE * n * n.transpose();
    if D == 2 {
        exact[(2, 2)] = -NU * PRESSURE;
    }
    let mut worst = 0.0f64;
    for body in &model.bodies.list {
        for cell in 0..body.mesh.cell_count() {
            for (xi, _) in rule(body.mesh.shape(cell), patch.degree + 1) {
                let u = &state.u[body.first..body.first + body.unknowns()];
                let (_, _, gradient) = displacement_at(&body.mesh, &body.dofs, model.bodies.space, cell, &xi, u);
                let stress: Matrix3<f64> = material.stress(model.bodies.space, &gradient);
                worst = worst.max((stress - exact).amax() / PRESSURE);
            }
        }
    }
    let pressure = state.contacts[0].nodes.iter().map(|n| (n.pressure / PRESSURE - 1.0).abs()).fold(0.0, f64::max);
    (worst, pressure)
}

#[test]
fn in_the_plane() {
    for degree in [1, 2, 4] {
        for cells in [[3, 4], [4, 4], [5, 3]] {
            for distortion in [0.0, 1e-15, 1e-10, 1e-3, 0.05] {
                for upper_is_slave in [false, true] {
                    for angle in [0.0, 0.6] {
                        let patch = Patch {
                            degree,
                            cells,
                            distortion,
                            upper_is_slave,
                            angle,
                            enforcement: Enforcement::Multiplier,
                        };
                        let (worst, pressure) = deviation::<2>(&patch);
                        assert!(
                            worst < 1e-12 && pressure < 1e-11,
                            "degree {degree} {cells:?} {distortion} {upper_is_slave} {angle}: {worst:e} {pressure:e}"
                        );
                    }
                }
            }
        }
    }
}

#[test]
fn in_space() {
    for degree in [1, 2, 4] {
        for cells in [[2, 3], [3, 3]] {
            for distortion in [0.0, 1e-12, 0.05] {
                for upper_is_slave in [false, true] {
                    let angle = if distortion == 0.0 { 0.0 } else { 0.4 };
                    let patch = Patch {
                        degree,
                        cells,
                        distortion,
                        upper_is_slave,
                        angle,
                        enforcement: Enforcement::Multiplier,
                    };
                    let (worst, pressure) = deviation::<3>(&patch);
                    assert!(
                        worst < 1e-12 && pressure < 1e-11,
                        "degree {degree} {cells:?} {distortion} {upper_is_slave} {angle}: {worst:e} {pressure:e}"
                    );
                }
                // Skewed faces at degree 4 take a minute.
                if degree == 4 {
                    break;
                }
            }
        }
    }
}

/// The upper block covers the lower one from 0 to `end` only; the rest is pressed directly. Faces are covered by any
/// share, down to a sliver.
fn overhang(degree: usize, end: f64, upper_is_slave: bool) -> (f64, usize) {
    let lower = block::<2>(&[even(0.0, 1.0, 4), even(0.0, 0.5, 2)], 1, |x| x);
    let upper = block::<2>(&[even(0.0, end, 3), even(0.5, 1.0, 2)], 1, |x| x);
    let groups = [lower.groups().clone(), upper.groups().clone()];
    let mut bodies = Bodies::<2>::new(Space::PlaneStrain);
    let material = Elastic { youngs_modulus: E, poissons_ratio: NU };
    bodies.add("lower", lower, degree, material);
    bodies.add("upper", upper, degree, material);
    let normal = |body: usize, group: &str| Support {
        name: group.into(),
        body,
        group: groups[body][group].clone(),
        kind: SupportKind::Normal,
    };
    let supports = vec![normal(0, "bottom"), normal(0, "left"), normal(1, "left")];
    let [low, high] =
        [(0, "top"), (1, "bottom")].map(|(b, g): (usize, &str)| bodies.surface(b, groups[b][g].sides.clone()));
    let press = Load { name: "p".into(), body: 1, group: groups[1]["top"].clone(), kind: LoadKind::Pressure };
    let mut load = loads::forces(&bodies, &press, &|_| Point::<2>::repeat(PRESSURE));
    // The bare part of the lower block, face by face.
    let mut trace = Vec::new();
    for face in 0..low.face_count() {
        let at = |s: f64| low.at(face, &[s, 0.0, 0.0]).x[0];
        let (a, b) = (at(-1.0), at(1.0));
        let cut = (2.0 * (end - a) / (b - a) - 1.0).clamp(-1.0, 1.0);
        let (from, to) = if b > a { (cut, 1.0) } else { (-1.0, cut) };
        for (s, w) in rule(CellShape::Line, degree + 1) {
            let s = [from + (to - from) * 0.5 * (1.0 + s[0]), 0.0, 0.0];
            trace.clear();
            low.trace(face, &s, &mut trace);
            for (unknown, v) in &trace {
                load[*unknown as usize + 1] -= PRESSURE * v * w * 0.5 * (to - from) * 0.5 * (b - a).abs();
            }
        }
    }
    let (slave, master) = if upper_is_slave { (high, low) } else { (low, high) };
    let contact = Contact::new("interface", slave, Master::Surface(master));
    let mut model = Model::new(bodies, supports, vec![contact]).unwrap();
    let now = Circumstances { displacement: &|_, _| Point::<2>::zeros(), load, rigid: vec![None], motion: vec![] };
    let state = model.solve(&now, &mut |_, _| true).unwrap();
    let mut exact = Matrix3::zeros();
    (exact[(1, 1)], exact[(2, 2)]) = (-PRESSURE, -NU * PRESSURE);
    let mut worst = 0.0f64;
    for body in &model.bodies.list {
        for cell in 0..body.mesh.cell_count() {
            for (xi, _) in rule(body.mesh.shape(cell), degree + 1) {
                let u = &state.u[body.first..body.first + body.unknowns()];
                let (_, _, gradient) = displacement_at(&body.mesh, &body.dofs, model.bodies.space, cell, &xi, u);
                worst = worst.max((material.stress(model.bodies.space, &gradient) - exact).amax() / PRESSURE);
            }
        }
    }
    (worst, state.iterations)
}

#[test]
fn partly_covered_faces() {
    for degree in [1, 2, 4] {
        for end in [0.5, 0.5 + 1e-9, 0.5 + 1e-4, 0.53, 0.6, 0.7, 0.74, 0.75 - 1e-10, 0.875, 1.0 - 1e-6] {
            for upper_is_slave in [false, true] {
                let (worst, iterations) = overhang(degree, end, upper_is_slave);
                assert!(
                    worst < 1e-11 && iterations <= 4,
                    "degree {degree}, covered to {end}, {upper_is_slave}: {worst:e} in {iterations}"
                );
            }
        }
    }
}

/// Every cell of a box cut into six tetrahedra (Kuhn), with the groups of the box.
fn tetrahedra(box_mesh: &Mesh<3>, order: usize) -> Mesh<3> {
    let mut out = Mesh::<3>::new(box_mesh.nodes().to_vec());
    for cell in 0..box_mesh.cell_count() {
        let nodes = box_mesh.cell_nodes(cell);
        let n = box_mesh.map(cell).order();
        let at = |c: [usize; 3]| nodes[c[0] + (n + 1) * (c[1] + (n + 1) * c[2])];
        for axes in [[0, 1, 2], [1, 2, 0], [2, 0, 1], [0, 2, 1], [2, 1, 0], [1, 0, 2]] {
            let mut corners = vec![[0usize; 3]];
            for axis in axes {
                let mut next = corners[corners.len() - 1];
                next[axis] = n;
                corners.push(next);
            }
            // Odd permutations turn the other way round.
            if [[0, 2, 1], [2, 1, 0], [1, 0, 2]].contains(&axes) {
                corners.swap(1, 2);
            }
            let mut list: Vec<u32> = corners.iter().map(|c| at(*c)).collect();
            if order == 2 {
                for &[a, b] in CellShape::Tetrahedron.edges() {
                    list.push(at(std::array::from_fn(|k| (corners[a][k] + corners[b][k]) / 2)));
                }
            }
            out.add_cell(CellShape::Tetrahedron, order, &list);
        }
    }
    // Sides of the tetrahedra whose vertices all lie on a group of the box.
    let boundary = out.boundary();
    for (name, group) in box_mesh.groups() {
        let on: std::collections::HashSet<u32> = group.sides.iter().flat_map(|s| box_mesh.side_vertices(*s)).collect();
        let sides: Vec<Side> =
            boundary.iter().copied().filter(|s| out.side_vertices(*s).iter().all(|v| on.contains(v))).collect();
        out.group_mut(name).sides = sides;
    }
    out
}

/// Triangular faces on quadrilateral ones, of degree 1 and 2, either side slave.
#[test]
fn tetrahedra_on_hexahedra() {
    for degree in [1, 2] {
        for upper_is_slave in [false, true] {
            let axes = |n: usize, low: f64, high: f64| [even(0.0, 1.0, n), even(0.0, 1.0, n), even(low, high, 2)];
            let lower = block::<3>(&axes(2, 0.0, 0.5), 1, |x| x);
            let upper = tetrahedra(&block::<3>(&axes(3, 0.5, 1.1), degree, |x| x), degree);
            lower.check().unwrap();
            upper.check().unwrap();
            let groups = [lower.groups().clone(), upper.groups().clone()];
            let mut bodies = Bodies::<3>::new(Space::Solid);
            let material = Elastic { youngs_modulus: E, poissons_ratio: NU };
            bodies.add("lower", lower, degree, material);
            bodies.add("upper", upper, degree, material);
            let normal = |body: usize, group: &str| Support {
                name: group.into(),
                body,
                group: groups[body][group].clone(),
                kind: SupportKind::Normal,
            };
            let mut supports = vec![normal(0, "bottom")];
            supports.extend((0..2).flat_map(|b| [normal(b, "left"), normal(b, "front")]));
            let press = Load { name: "p".into(), body: 1, group: groups[1]["top"].clone(), kind: LoadKind::Pressure };
            let load = loads::forces(&bodies, &press, &|_| Point::<3>::repeat(PRESSURE));
            let [low, high] =
                [(0, "top"), (1, "bottom")].map(|(b, g): (usize, &str)| bodies.surface(b, groups[b][g].sides.clone()));
            let (slave, master) = if upper_is_slave { (high, low) } else { (low, high) };
            let contact = Contact::new("interface", slave, Master::Surface(master));
            let mut model = Model::new(bodies, supports, vec![contact]).unwrap();
            let now =
                Circumstances { displacement: &|_, _| Point::<3>::zeros(), load, rigid: vec![None], motion: vec![] };
            let state = model.solve(&now, &mut |_, _| true).unwrap();
            let mut exact = Matrix3::zeros();
            exact[(2, 2)] = -PRESSURE;
            let mut worst = 0.0f64;
            for body in &model.bodies.list {
                for cell in 0..body.mesh.cell_count() {
                    for (xi, _) in rule(body.mesh.shape(cell), 2) {
                        let u = &state.u[body.first..body.first + body.unknowns()];
                        let (_, _, gradient) = displacement_at(&body.mesh, &body.dofs, Space::Solid, cell, &xi, u);
                        worst = worst.max((material.stress(Space::Solid, &gradient) - exact).amax() / PRESSURE);
                    }
                }
            }
            assert!(worst < 1e-12, "degree {degree}, {upper_is_slave}: {worst:e}");
        }
    }
}

/// By Nitsche's method the stress of the slave side stands for the pressure, on the same points.
#[test]
fn by_nitsches_method() {
    for degree in [1, 2, 4] {
        for (distortion, upper_is_slave, angle) in [(0.0, false, 0.0), (0.05, true, 0.6), (1e-10, false, 0.6)] {
            let enforcement = Enforcement::Nitsche;
            let plane = Patch { degree, cells: [3, 4], distortion, upper_is_slave, angle, enforcement };
            let (worst, pressure) = deviation::<2>(&plane);
            assert!(worst < 1e-11 && pressure < 1e-11, "{degree} {distortion}: {worst:e} {pressure:e}");
            if degree < 4 {
                let (worst, pressure) = deviation::<3>(&Patch { cells: [2, 3], ..plane });
                assert!(worst < 1e-11 && pressure < 1e-11, "{degree} {distortion}: {worst:e} {pressure:e}");
            }
        }
    }
}

/// Two plates of one body behind each other: the one behind is not met.
#[test]
fn masters_behind_each_other() {
    let plates = |gap: f64| {
        let mesh = |low: f64, high: f64, n: usize| {
            block::<3>(&[even(0.0, 1.0, n), even(0.0, 1.0, n), even(low, high, 1)], 1, |x| x)
        };
        let upper = mesh(0.5, 1.0, 2);
        // One mesh of two blocks, 0.1 and 0.2 thick, one over the other.
        let parts = [mesh(0.0, 0.1, 3), mesh(0.1 + gap, 0.5, 3)];
        let mut nodes = parts[0].nodes().to_vec();
        nodes.extend_from_slice(parts[1].nodes());
        let mut lower = signorini_fem::Mesh::<3>::new(nodes);
        for (part, shift) in parts.iter().zip([0, parts[0].nodes().len() as u32]) {
            for cell in 0..part.cell_count() {
                let list: Vec<u32> = part.cell_nodes(cell).iter().map(|n| n + shift).collect();
                lower.add_cell(part.shape(cell), 1, &list);
            }
        }
        let tops: Vec<_> = (lower.boundary().into_iter())
            .filter(|s| {
                let (x, [a, b]) = lower.on_side(*s, &[0.0; 3]);
                let up = a[0] * b[1] - a[1] * b[0];
                up > 0.0 && x[2] > 0.05
            })
            .collect();
        (upper, lower, tops)
    };
    let (upper, lower, tops) = plates(0.1);
    assert_eq!(tops.len(), 18);
    let bottom = upper.groups()["bottom"].sides.clone();
    let mut bodies = Bodies::<3>::new(Space::Solid);
    let material = Elastic { youngs_modulus: E, poissons_ratio: NU };
    bodies.add("lower", lower, 1, material);
    bodies.add("upper", upper, 1, material);
    let (slave, master) = (bodies.surface(1, bottom), bodies.surface(0, tops));
    let nodes = signorini_contact::PressureNodes::new(&slave);
    let points = signorini_contact::segments(&slave, &master, &nodes, 1.0);
    let area: f64 = points.iter().flatten().map(|p| p.weight).sum();
    assert!((area - 1.0).abs() < 1e-12, "{area}");
    assert!(points.iter().flatten().all(|p| p.gap.abs() < 1e-12));
}

/// A block in a box, raised on by a rigid plane, with the exact displacement prescribed on one side of it: the nodes of the
/// contact on that side, at vertices and between them, are held, and the pressure is the same everywhere.
#[test]
fn nodes_that_are_held_may_touch() {
    const RAISED: f64 = 0.01;
    for (degree, method) in [(1, Method::Mortar), (2, Method::Mortar), (3, Method::Mortar), (2, Method::Node)] {
        let mesh = block::<3>(&std::array::from_fn(|_| even(0.0, 1.0, 2)), 1, |x| x);
        let groups = mesh.groups().clone();
        let mut bodies = Bodies::<3>::new(Space::Solid);
        bodies.add("block", mesh, degree, Elastic { youngs_modulus: E, poissons_ratio: NU });
        let support = |group: &str, kind: SupportKind| Support {
            name: group.into(),
            body: 0,
            group: groups[group].clone(),
            kind,
        };
        let mut supports = vec![support("left", SupportKind::Components(vec![true; 3]))];
        supports.extend(["right", "front", "back", "top"].map(|group| support(group, SupportKind::Normal)));
        let slave = bodies.surface(0, groups["bottom"].sides.clone());
        let mut contact = Contact::new("touch", slave, Master::Rigid);
        contact.method = method;
        let mut model = Model::new(bodies, supports, vec![contact]).unwrap();
        let now = Circumstances {
            displacement: &|s, x| Point::<3>::new(0.0, 0.0, if s == 0 { RAISED * (1.0 - x[2]) } else { 0.0 }),
            load: vec![0.0; model.bodies.unknowns()],
            rigid: vec![Some(Box::new(|x: &Point<3>| {
                signorini_contact::GapJet::flat(x[2] - RAISED, Point::<3>::new(0.0, 0.0, 1.0))
            }))],
            motion: vec![],
        };
        let state = model.solve(&now, &mut |_, _| true).unwrap_or_else(|e| panic!("degree {degree}, {method:?}: {e}"));
        let pressure = RAISED * E * (1.0 - NU) / ((1.0 + NU) * (1.0 - 2.0 * NU));
        for node in &state.contacts[0].nodes {
            let off = node.pressure / pressure - 1.0;
            assert!(off.abs() < 1e-8, "degree {degree}, {method:?}, {:?}: {off:e}", node.x);
        }
    }
}
