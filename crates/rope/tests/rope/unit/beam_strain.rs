//! Of `beam::strain`.

use nalgebra::{SMatrix, SVector};
use signorini_geometry::Vector;
use signorini_rope::beam::strain::{curvature, curvature_hessian, force_strain, force_strain_hessian};
use signorini_rope::quaternion;

/// Central differences of a gradient and of a weighted sum of gradients.
fn check<const N: usize>(
    x: &SVector<f64, N>,
    value: impl Fn(&SVector<f64, N>) -> f64,
    gradient: impl Fn(&SVector<f64, N>) -> SVector<f64, N>,
    hessian: &SMatrix<f64, N, N>,
) {
    let e = 1e-5;
    for k in 0..N {
        let moved = |s: f64| {
            let mut y = *x;
            y[k] += s;
            y
        };
        let slope = (value(&moved(e)) - value(&moved(-e))) / (2.0 * e);
        assert!((slope - gradient(x)[k]).abs() < 1e-8, "{slope} {}", gradient(x)[k]);
        let column = (gradient(&moved(e)) - gradient(&moved(-e))) / (2.0 * e);
        assert!((column - hessian.column(k)).norm() < 1e-7, "{column} {}", hessian.column(k));
    }
    assert!((hessian - hessian.transpose()).norm() < 1e-13);
}

#[test]
fn derivatives_of_the_strains_are_exact() {
    let weight = Vector::<3>::new(0.7, -1.2, 0.4);
    let x = SVector::<f64, 7>::from_column_slice(&[0.9, 0.2, -0.3, 0.8, 0.3, -0.5, 0.2]);
    let split = |x: &SVector<f64, 7>| (x.fixed_rows::<3>(0).into_owned(), x.fixed_rows::<4>(3).into_owned());
    let gradient = |x: &SVector<f64, 7>| {
        let (r, q) = split(x);
        let g = force_strain(&r, &q).gradient;
        g[0] * weight[0] + g[1] * weight[1] + g[2] * weight[2]
    };
    let (r, q) = split(&x);
    let value = |x: &SVector<f64, 7>| force_strain(&split(x).0, &split(x).1).value.dot(&weight);
    check(&x, value, gradient, &force_strain_hessian(&r, &q, &weight));
    // The strains are the components of r' in the axes of the section.
    let expected = quaternion::rotation(&q).transpose() * r;
    assert!((force_strain(&r, &q).value - expected).norm() < 1e-14);

    let x = SVector::<f64, 8>::from_column_slice(&[0.8, 0.3, -0.5, 0.2, 0.4, -0.1, 0.7, 0.3]);
    let split = |x: &SVector<f64, 8>| (x.fixed_rows::<4>(0).into_owned(), x.fixed_rows::<4>(4).into_owned());
    let gradient = |x: &SVector<f64, 8>| {
        let (q, p) = split(x);
        let g = curvature(&q, &p).gradient;
        g[0] * weight[0] + g[1] * weight[1] + g[2] * weight[2]
    };
    let (q, p) = split(&x);
    let value = |x: &SVector<f64, 8>| curvature(&split(x).0, &split(x).1).value.dot(&weight);
    check(&x, value, gradient, &curvature_hessian(&q, &p, &weight));
}
