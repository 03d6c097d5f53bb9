//! A rope on triangle meshes of a known body, clean and with noise: the table of docs/paths.md.

use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::rigid_shape::{Ellipsoid, RigidShape};
use signorini_geometry::{Jet, Point, Vector};
use signorini_paths::curve::Analytic;
use signorini_paths::darboux::{Darboux, darboux};
use signorini_paths::friction::Friction;
use signorini_paths::smooth_mesh::SmoothMesh;
use signorini_paths::theorem::{limits_of_points, tension_limits};
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

/// Errors of `k_n` and `k_g`, root mean square relative to that of `k_n`, of the limit of `ln T₁/T₀`, and the noise told.
fn errors(n: usize, noise: f64) -> [f64; 4] {
    let exact = Ellipsoid::new(Point::<3>::zeros(), AXES).unwrap();
    let wave = |t: Jet<1>| {
        let v = (t * 2.0).sin() * 0.15;
        [t.cos() * v.cos() * AXES[0], t.sin() * v.cos() * AXES[1], v.sin() * AXES[2]]
    };
    let wave = Analytic::new(wave, [0.2, 3.0]).unwrap();
    let mesh = SmoothMesh::new(&mesh(n, noise)).unwrap();
    let count = 400;
    let parameters: Vec<f64> = (0..count).map(|k| 0.2 + 2.8 * (k as f64 + 0.5) / f64::from(count)).collect();
    let frames = |surface: &dyn RigidShape| darboux(surface, &wave, &parameters).unwrap();
    let (known, found) = (frames(&exact), frames(&mesh));
    let mean =
        |of: &dyn Fn(usize) -> f64| ((0..known.len()).map(|k| of(k).powi(2)).sum::<f64>() / known.len() as f64).sqrt();
    let scale = mean(&|k| known[k].k_n);
    let friction = Friction::Carried { along: 0.3, across: 0.6 };
    let list: Vec<(Darboux, f64)> = (found.iter().enumerate())
        .map(|(k, f)| {
            let end = |j: usize| 0.5 * (found[j].s + found[j + 1].s);
            let ends = [if k == 0 { 0.0 } else { end(k - 1) }, if k + 1 == found.len() { f.s } else { end(k) }];
            (*f, ends[1] - ends[0])
        })
        .collect();
    let same: Vec<(Darboux, f64)> = known.iter().zip(&list).map(|(f, (_, w))| (*f, *w)).collect();
    let limit = |list: &[(Darboux, f64)]| limits_of_points(list, &friction).unwrap().log_ratio[1];
    // The quadrature by the points errs as little as the finest mesh would let see.
    assert!((limit(&same) / tension_limits(&exact, &wave, &friction).unwrap().log_ratio[1] - 1.0).abs() < 5e-3);
    [
        mean(&|k| found[k].k_n - known[k].k_n) / scale,
        mean(&|k| found[k].k_g - known[k].k_g) / scale,
        (limit(&list) / limit(&same) - 1.0).abs(),
        mesh.scatter(),
    ]
}

#[test]
fn curvatures_and_tensions_of_a_rope_on_meshes_converge() {
    for noise in [0.0, 1e-3] {
        let rows: Vec<(usize, [f64; 4])> = [7, 13, 26].map(|n| (12 * n * n, errors(n, noise))).to_vec();
        for (triangles, [k_n, k_g, limit, scatter]) in &rows {
            println!(
                "noise {noise:e}: {triangles} triangles: k_n {k_n:.1e}, k_g {k_g:.1e}, ln T {limit:.1e}, scatter {scatter:.1e}"
            );
        }
        let order = |k: usize| (rows[0].1[k] / rows[2].1[k]).ln() / (26.0f64 / 7.0).ln();
        println!("orders {:.2} {:.2} {:.2}", order(0), order(1), order(2));
        if noise == 0.0 {
            assert!(order(0) > 1.7 && order(1) > 2.3 && order(2) > 1.7);
        } else {
            // Curvatures err by the noise over the square of the edges, and tensions by its mean along the rope; it is told.
            let [k_n, k_g, limit, scatter] = rows[2].1;
            assert!((scatter / noise - 1.0).abs() < 0.3 && k_n < 0.2 && k_g < 0.05 && limit < 2e-2);
        }
    }
}
