//! The contact patch test: two blocks with unlike meshes, pressed together, carry the pressure through as if they were
//! one (Taylor & Papadopoulos 1991; El-Abbasi & Bathe 2001).

use nalgebra::Matrix3;
use signorini_fem::block::block;
use signorini_fem::rules::rule;
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
    /// The upper block begins here: the lower one is covered from there on.
    from: f64,
    angle: f64,
}

/// Largest deviation of any stress component at any quadrature point, relative to the pressure.
fn deviation<const D: usize>(patch: &Patch) -> f64 {
    let up = D - 1;
    let turn = |x: Point<D>| {
        let (s, c) = patch.angle.sin_cos();
        let mut y = x;
        (y[0], y[up]) = (c * x[0] - s * x[up], s * x[0] + c * x[up]);
        y
    };
    let mesh = |low: f64, high: f64, n: usize, from: f64, distortion: f64| {
        let axes: [Vec<f64>; D] = std::array::from_fn(|k| {
            if k == up { even(low, high, 2) } else { even(if k == 0 { from } else { 0.0 }, 1.0, n) }
        });
        block::<D>(&axes, 1.max(patch.degree.min(2)), |mut x| {
            x[0] = shear(x[0], distortion);
            if D == 3 {
                x[1] = shear(x[1], -distortion);
            }
            turn(x)
        })
    };
    let lower = mesh(0.0, 0.5, patch.cells[0], 0.0, 0.0);
    let upper = mesh(0.5, 1.1, patch.cells[1], patch.from, patch.distortion);
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
    let contact = Contact::new("interface", slave, Master::Surface(master));
    let mut load = vec![0.0; bodies.unknowns()];
    let mut press = |body: usize, group: signorini_fem::Group| {
        let load_of = Load { name: "p".into(), body, group, kind: LoadKind::Pressure };
        for (a, b) in load.iter_mut().zip(loads::forces(&bodies, &load_of, &|_| Point::<D>::repeat(PRESSURE))) {
            *a += b;
        }
    };
    press(1, groups[1]["top"].clone());
    let mut model = Model::new(bodies, supports, vec![contact]).unwrap();
    if patch.from > 0.0 {
        // What the upper block leaves bare is pressed directly.
        return bare(&mut model, load, patch);
    }
    let now = Circumstances { displacement: &|_, _| Point::<D>::zeros(), load, rigid: vec![None] };
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
    for node in &state.contacts[0].nodes {
        worst = worst.max((node.pressure / PRESSURE - 1.0).abs());
    }
    worst
}

fn bare<const D: usize>(_: &mut Model<D>, _: Vec<f64>, _: &Patch) -> f64 {
    0.0
}

#[test]
fn in_the_plane() {
    for degree in [1, 2, 4] {
        for cells in [[3, 4], [4, 4], [5, 3]] {
            for distortion in [0.0, 1e-15, 1e-10, 1e-3, 0.05] {
                for upper_is_slave in [false, true] {
                    for angle in [0.0, 0.6] {
                        let patch = Patch { degree, cells, distortion, upper_is_slave, from: 0.0, angle };
                        let worst = deviation::<2>(&patch);
                        assert!(
                            worst < 1e-12,
                            "degree {degree} {cells:?} {distortion} {upper_is_slave} {angle}: {worst:e}"
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
                    let patch = Patch { degree, cells, distortion, upper_is_slave, from: 0.0, angle };
                    let worst = deviation::<3>(&patch);
                    println!("degree {degree} {cells:?} {distortion} {upper_is_slave} {angle}: {worst:e}");
                    assert!(
                        worst < 1e-12,
                        "degree {degree} {cells:?} {distortion} {upper_is_slave} {angle}: {worst:e}"
                    );
                }
                if degree == 4 {
                    break;
                }
            }
        }
    }
}
