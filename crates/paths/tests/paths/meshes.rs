//! Triangle meshes as smooth surfaces, clean and with noise, and ropes on them: the table of docs/paths.md.

use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::rigid_shape::{Ellipsoid, RigidShape};
use signorini_geometry::{Jet, Point, Vector};
use signorini_paths::curve::Analytic;
use signorini_paths::darboux::{Darboux, darboux};
use signorini_paths::friction::Friction;
use signorini_paths::smooth_mesh::SmoothMesh;
use signorini_paths::theorem::{limits_of_points, tension_limits};
use signorini_paths::wrapping::{Anchor, Body, Route, Station, Wrapping};
use std::collections::HashMap;

const AXES: [f64; 3] = [2.0, 1.5, 1.0];

/// The ellipsoid as a cube blown up, each side divided into `n` by `n`, with vertices moved along it by up to a third of an
/// edge, so that no two triangles are alike, and off it by noise of a given root mean square.
fn mesh(n: usize, noise: f64) -> TriangleMesh {
    let mut seed = 7u64;
    let mut random = || {
        seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (seed >> 33) as f64 / (1u64 << 30) as f64 - 1.0
    };
    let m = n as i64;
    let mut numbers: HashMap<[i64; 3], u32> = HashMap::new();
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for side in 0..6 {
        let (axis, sign) = (side / 2, if side % 2 == 0 { 1 } else { -1 });
        let mut number = |i: i64, j: i64| {
            let mut x = [0; 3];
            (x[axis], x[(axis + 1) % 3], x[(axis + 2) % 3]) = (sign * m, 2 * i - m, 2 * j - m);
            *numbers.entry(x).or_insert_with(|| {
                let moved = x.map(|v| v as f64 + 0.4 * random());
                let x = Vector::<3>::from(moved).normalize().component_mul(&Vector::<3>::from(AXES));
                let outward = x.component_div(&Vector::<3>::from(AXES.map(|a| a * a))).normalize();
                vertices.push(x + outward * (noise * 3f64.sqrt() * random()));
                vertices.len() as u32 - 1
            })
        };
        for i in 0..m {
            for j in 0..m {
                let [a, b, c, d] = [number(i, j), number(i + 1, j), number(i + 1, j + 1), number(i, j + 1)];
                let two = if sign > 0 { [[a, b, c], [a, c, d]] } else { [[a, c, b], [a, d, c]] };
                triangles.extend(two);
            }
        }
    }
    TriangleMesh::new(vertices, &triangles).unwrap()
}

/// What is found on a mesh.
struct Found {
    /// Errors of `k_n` and `k_g`, root mean square relative to that of `k_n`, and those of the limits of `ln T₁/T₀`,
    /// relative.
    errors: [f64; 3],
    /// What the mesh tells: its noise, and the error of curvatures relative to them.
    noise: f64,
    told: f64,
}

/// Ropes that wind about the three axes of the ellipsoid.
fn found(n: usize, noise: f64) -> Found {
    let exact = Ellipsoid::new(Point::<3>::zeros(), AXES).unwrap();
    let mesh = SmoothMesh::new(&mesh(n, noise)).unwrap();
    let friction = Friction::Carried { along: 0.3, across: 0.6 };
    let mut squares = [0.0; 4];
    for axis in 0..3 {
        let wave = move |t: Jet<1>| {
            let v = (t * 2.0).sin() * 0.15;
            let mut x = [t.cos() * v.cos(), t.sin() * v.cos(), v.sin()];
            x.rotate_right(axis);
            [x[0] * AXES[0], x[1] * AXES[1], x[2] * AXES[2]]
        };
        let turn = std::f64::consts::TAU;
        let wave = Analytic::new(wave, [0.0, turn]).unwrap();
        let parameters: Vec<f64> = (0..800).map(|k| turn * (f64::from(k) + 0.5) / 800.0).collect();
        let frames = |surface: &dyn RigidShape| darboux(surface, &wave, &parameters).unwrap();
        let (known, found) = (frames(&exact), frames(&mesh));
        for (k, f) in known.iter().zip(&found) {
            let add = [f.k_n - k.k_n, f.k_g - k.k_g, k.k_n];
            (0..3).for_each(|i| squares[i] += add[i] * add[i]);
        }
        let shares = |list: &[Darboux]| -> Vec<(Darboux, f64)> {
            let end = |j: usize| 0.5 * (list[j].s + list[(j + 1).min(list.len() - 1)].s);
            (0..list.len()).map(|k| (list[k], end(k) - if k == 0 { 0.0 } else { end(k - 1) })).collect()
        };
        let limit = |list: &[Darboux]| limits_of_points(&shares(list), &friction).unwrap().log_ratio[1];
        // The quadrature by the points errs as little as the finest mesh would let see.
        assert!((limit(&known) / tension_limits(&exact, &wave, &friction).unwrap().log_ratio[1] - 1.0).abs() < 5e-3);
        squares[3] += (limit(&found) / limit(&known) - 1.0).powi(2) / 3.0;
    }
    let mean = |k: usize| (squares[k] / squares[2]).sqrt();
    let [curvature, error] = mesh.curvature();
    let errors = [mean(0), mean(1), squares[3].sqrt()];
    Found { errors, noise: mesh.scatter(), told: error / curvature }
}

/// The noise of the vertices of a mesh: that of an instrument, or a share of the edges.
#[derive(Clone, Copy, Debug)]
enum Noise {
    Of(f64),
    OfEdges(f64),
}

#[test]
fn curvatures_and_tensions_of_ropes_on_meshes_converge() {
    for noise in [Noise::Of(0.0), Noise::OfEdges(0.01), Noise::Of(1e-3), Noise::Of(5e-3)] {
        let rows = [7, 13, 26].map(|n| {
            let deviation = match noise {
                Noise::Of(deviation) => deviation,
                // Edges of the sides of the cube on a ball of the mean radius.
                Noise::OfEdges(share) => share * 0.5 * std::f64::consts::PI * 1.5 / n as f64,
            };
            (12 * n * n, deviation, found(n, deviation))
        });
        for (triangles, deviation, Found { errors: [k_n, k_g, limit], noise: scatter, told }) in &rows {
            println!(
                "{noise:?}: {triangles} triangles, noise {deviation:.1e} (told {scatter:.1e}): k_n {k_n:.1e} (told {told:.1e}), k_g \
                 {k_g:.1e}, ln T {limit:.1e}"
            );
            assert!(*told > 0.8 * k_n && *told < 6.0 * k_n);
        }
        let order = |k: usize| (rows[0].2.errors[k] / rows[2].2.errors[k]).ln() / (26.0f64 / 7.0).ln();
        println!("orders {:.2} {:.2} {:.2}", order(0), order(1), order(2));
        let (_, deviation, finest) = &rows[2];
        let [k_n, k_g, limit] = finest.errors;
        assert!(*deviation == 0.0 || (finest.noise / deviation - 1.0).abs() < 0.05);
        // Of fits with bias and noise in balance: order 4/5 for noise in proportion to the edges, 2/5 for the same noise.
        match noise {
            Noise::Of(0.0) => assert!(order(0) > 1.9 && order(1) > 2.3 && limit < 1e-3),
            Noise::OfEdges(_) => assert!(order(0) > 0.6 && order(1) > 0.6 && limit < 5e-3),
            Noise::Of(_) => assert!(order(0) > 0.0 && k_n < 0.08 && k_g < 1e-2 && limit < 2e-2),
        }
    }
}

#[test]
fn derivatives_of_the_level() {
    // With narrow fits, and with wide ones.
    for noise in [0.0, 5e-3] {
        let mesh = SmoothMesh::new(&mesh(13, noise)).unwrap();
        assert_eq!(noise > 0.0, mesh.fit_radius() > 3.0);
        let x = Point::<3>::new(1.1, 0.7, 0.72);
        let at = mesh.level(&x);
        for k in 0..3 {
            let mut step = Vector::<3>::zeros();
            step[k] = 1e-5;
            let [up, down] = [mesh.level(&(x + step)), mesh.level(&(x - step))];
            assert!(((up.value - down.value) / 2e-5 - at.gradient[k]).abs() < 1e-8);
            assert!(((up.gradient - down.gradient) / 2e-5 - at.hessian.column(k)).norm() < 1e-6);
        }
        let found = mesh.gap(&Point::<3>::new(3.0, 0.0, 0.0));
        assert!((found.gap - 1.0).abs() < 0.02 && (found.normal.x - 1.0).abs() < 1e-2, "{found:?}");
        assert!((mesh.edge() / 0.25 - 1.0).abs() < 0.5, "{}", mesh.edge());
    }
    let open = TriangleMesh::new(vec![Point::<3>::zeros(), Vector::<3>::x(), Vector::<3>::y()], &[[0, 1, 2]]).unwrap();
    assert!(SmoothMesh::new(&open).is_err());
}

/// The shortest path over the mesh of an ellipsoid tends to that over the ellipsoid.
#[test]
fn paths_over_meshes_converge() {
    let errors = [8, 16].map(|n| {
        let mesh = SmoothMesh::new(&mesh(n, 0.0)).unwrap();
        let route = Route {
            start: Anchor::fixed(Point::<3>::new(-3.0, 0.5, 0.3)),
            stations: vec![Station::Around { body: 0, turns: 0 }],
            end: Anchor::fixed(Point::<3>::new(2.2, 1.6, -0.9)),
        };
        let path = Wrapping::new(route).solve(&[Body::fixed(&mesh)]).unwrap();
        (path.length - 5.488_014_095_081).abs()
    });
    println!("{errors:?}");
    assert!(errors[1] < 2e-4 && errors[0] > 4.0 * errors[1], "{errors:?}");
}
