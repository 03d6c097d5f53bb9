//! Even weights: reparametrisation of rational Bezier pieces, and where to cut those that stay uneven.
//!
//! The parameter `t'` with `t / (1 - t) = ratio t' / (1 - t')` multiplies the weight number `i` by `ratio^i` and leaves
//! the curve as it is (Farin: NURBS, 2nd ed. 1999, §5.4). The ratio that takes the slope out of the logarithms of the
//! weights is the best in the sense of least squares. Halving a piece in its even parameter halves what is left of the
//! logarithms, so that a few cuts make any weights even.

use super::bernstein::Control;
use super::net::Net;

/// How many times the least weight of a line of control points the largest may be. Bounds of a rational piece grow with
/// a power of this, pieces become more as it falls.
const APART: f64 = 4.0;

/// A line of control points in its most even parameter, with the ratio that leads there.
pub fn even(control: &[Control]) -> (Vec<Control>, f64) {
    let net = Net { degree: [control.len() - 1, 0], control: control.to_vec() };
    let (net, [ratio, _]) = net.even();
    (net.control, ratio)
}

/// The parameter in `[0, 1]` of the middle of the even parameter.
pub fn even_middle(ratio: f64) -> f64 {
    ratio / (1.0 + ratio)
}

/// Whether weights are too far apart for tight bounds.
pub fn uneven<'a>(control: impl IntoIterator<Item = &'a Control>) -> bool {
    let (mut low, mut high) = (f64::INFINITY, 0.0f64);
    for c in control {
        low = low.min(c[3]);
        high = high.max(c[3]);
    }
    high > APART * low
}

impl Net {
    /// The net in its most even parameters, with the ratios that lead there.
    pub fn even(&self) -> (Net, [f64; 2]) {
        let [n, m] = self.degree;
        let mut slope = [0.0; 2];
        for (k, c) in self.control.iter().enumerate() {
            let at = [(k / (m + 1)) as f64 - 0.5 * n as f64, (k % (m + 1)) as f64 - 0.5 * m as f64];
            let log = (c[3] / self.control[0][3]).ln();
            slope = [slope[0] + at[0] * log, slope[1] + at[1] * log];
        }
        // Sum of the squares of the positions about their mean, over all lines.
        let squares = |n: usize, lines: usize| (n * (n + 1) * (n + 2)) as f64 / 12.0 * lines as f64;
        let ratio = |slope: f64, squares: f64| if slope == 0.0 { 1.0 } else { (-slope / squares).exp() };
        let ratios = [ratio(slope[0], squares(n, m + 1)), ratio(slope[1], squares(m, n + 1))];
        let mut net = self.clone();
        for (k, c) in net.control.iter_mut().enumerate() {
            let factor = ratios[0].powi((k / (m + 1)) as i32) * ratios[1].powi((k % (m + 1)) as i32);
            *c = c.map(|x| x * factor);
        }
        (net, ratios)
    }

    /// Whether the weights of any line of control points in this direction are too far apart.
    pub fn is_uneven(&self, axis: usize) -> bool {
        (0..=self.degree[1 - axis]).any(|k| if axis == 0 { uneven(&self.column(k)) } else { uneven(self.row(k)) })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn any_weights_are_even_after_a_few_cuts() {
        use crate::patch::bernstein::cut;
        let mut state = 1u64;
        let mut random = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        fn pieces(control: &[Control]) -> usize {
            let (even, ratio) = even(control);
            if !uneven(&even) {
                return 1;
            }
            cut(control, even_middle(ratio)).iter().map(|half| pieces(half)).sum()
        }
        for degree in 1..=5 {
            for _ in 0..100 {
                let control: Vec<Control> = (0..=degree)
                    .map(|_| {
                        let w = 10f64.powf(8.0 * random() - 4.0);
                        [random() * w, random() * w, random() * w, w]
                    })
                    .collect();
                let count = pieces(&control);
                assert!(count <= if degree == 1 { 1 } else { 16 }, "degree {degree}: {count} pieces");
            }
        }
    }
}
