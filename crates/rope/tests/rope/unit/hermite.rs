//! Of `hermite`.

use signorini_rope::hermite::{
    FOUR, THREE, TWO, cubic, cubic_first, cubic_second, cubic_third, gauss, lobatto, quadratic, quadratic_first,
};

#[test]
fn functions_reproduce_cubics_and_quadratics_with_their_derivatives() {
    let h = 1.7;
    for k in 0..=10 {
        let xi = k as f64 / 10.0;
        // s³ - s has the nodal values and slopes below.
        let nodes = [0.0, -1.0, h * h * h - h, 3.0 * h * h - 1.0];
        let of = |n: [f64; 4]| n.iter().zip(nodes).map(|(n, v)| n * v).sum::<f64>();
        let s = h * xi;
        let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-13, "{a} {b}");
        near(of(cubic(xi, h)), s * s * s - s);
        near(of(cubic_first(xi, h)), h * (3.0 * s * s - 1.0));
        near(of(cubic_second(xi, h)), h * h * 6.0 * s);
        near(of(cubic_third(h)), h * h * h * 6.0);
        let f = |x: f64| 2.0 - x + 3.0 * x * x;
        let of = |n: [f64; 3]| n[0] * f(0.0) + n[1] * f(1.0) + n[2] * f(0.5);
        near(of(quadratic(xi)), f(xi));
        near(of(quadratic_first(xi)), 6.0 * xi - 1.0);
    }
}

#[test]
fn rules_are_exact_to_their_degree() {
    for n in 1..=9 {
        for degree in 0..2 * n {
            let sum: f64 = gauss(n).iter().map(|(x, w)| w * x.powi(degree as i32)).sum();
            assert!((sum - 1.0 / (degree as f64 + 1.0)).abs() < 1e-14);
        }
    }
    for n in 2..=8 {
        let rule = lobatto(n);
        assert!(rule[0].0.abs() < 1e-15 && (rule[n - 1].0 - 1.0).abs() < 1e-15);
        for degree in 0..2 * n - 2 {
            let sum: f64 = rule.iter().map(|(x, w)| w * x.powi(degree as i32)).sum();
            assert!((sum - 1.0 / (degree as f64 + 1.0)).abs() < 1e-14, "{n} {degree}");
        }
    }
    for (written, computed) in [(&TWO[..], gauss(2)), (&THREE[..], gauss(3)), (&FOUR[..], gauss(4))] {
        written
            .iter()
            .zip(&computed)
            .for_each(|(a, b)| assert!((a.0 - b.0).abs() < 4e-15 && (a.1 - b.1).abs() < 4e-15, "{a:?} {b:?}"));
    }
}
