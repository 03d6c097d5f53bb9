//! Of `legendre`.

use signorini_cells::legendre::{MAX_DEGREE, integrated_legendre, integrated_legendre_jets};
use signorini_geometry::rule::gauss_legendre;

#[test]
fn bubbles_vanish_at_the_ends_and_their_slopes_are_orthonormal() {
    for k in 2..=MAX_DEGREE {
        assert!(integrated_legendre(8, 1.0)[k][0].abs() < 1e-15 && integrated_legendre(8, -1.0)[k][0].abs() < 1e-15);
        for j in 2..=MAX_DEGREE {
            let product: f64 = gauss_legendre(9)
                .iter()
                .map(|(t, w)| {
                    let n = integrated_legendre(8, 2.0 * t - 1.0);
                    2.0 * w * n[j][1] * n[k][1]
                })
                .sum();
            assert!((product - f64::from(u8::from(j == k))).abs() < 1e-13);
        }
    }
}

#[test]
fn higher_derivatives_are_those_of_differences() {
    let (x, h) = (0.37, 1e-5);
    let [minus, at, plus] = [x - h, x, x + h].map(|x| integrated_legendre_jets(8, x));
    for k in 0..=MAX_DEGREE {
        for d in 0..3 {
            let difference = (plus[k][d] - minus[k][d]) / (2.0 * h);
            assert!((at[k][d + 1] - difference).abs() < 1e-6 * (1.0 + difference.abs()), "{k} {d}");
        }
    }
}
