//! Adaptive quadrature: Gauss-Kronrod with 7 and 15 points, the interval with the largest error halved first (Piessens et
//! al., QUADPACK, 1983).

use crate::curve::Curve;

const NODES: [f64; 8] = [
    0.991_455_371_120_812_6,
    0.949_107_912_342_758_5,
    0.864_864_423_359_769_1,
    0.741_531_185_599_394_4,
    0.586_087_235_467_691_1,
    0.405_845_151_377_397_2,
    0.207_784_955_007_898_47,
    0.0,
];
const KRONROD: [f64; 8] = [
    0.022_935_322_010_529_224,
    0.063_092_092_629_978_55,
    0.104_790_010_322_250_18,
    0.140_653_259_715_525_92,
    0.169_004_726_639_267_9,
    0.190_350_578_064_785_4,
    0.204_432_940_075_298_9,
    0.209_482_141_084_727_82,
];
/// Of the nodes with odd number.
const GAUSS: [f64; 4] =
    [0.129_484_966_168_869_7, 0.279_705_391_489_276_7, 0.381_830_050_505_118_9, 0.417_959_183_673_469_4];

/// Intervals after which the halving ends.
const MOST_INTERVALS: usize = 2000;

struct Piece<const M: usize> {
    from: f64,
    to: f64,
    value: [f64; M],
    error: f64,
}

fn piece<const M: usize>(f: &mut impl FnMut(f64) -> [f64; M], from: f64, to: f64) -> Piece<M> {
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let (mut fine, mut coarse) = ([0.0; M], [0.0; M]);
    for k in 0..8 {
        let places: &[f64] = if k == 7 { &[0.0] } else { &[-NODES[k], NODES[k]] };
        for x in places {
            let value = f(middle + half * x);
            for m in 0..M {
                fine[m] += KRONROD[k] * value[m];
                if k % 2 == 1 {
                    coarse[m] += GAUSS[k / 2] * value[m];
                }
            }
        }
    }
    let error = (0..M).map(|m| ((fine[m] - coarse[m]) * half).abs()).fold(0.0, f64::max);
    Piece { from, to, value: fine.map(|v| v * half), error }
}

/// The integrals of `M` functions between breaks, to `tolerance` relative to the largest one; the error that is left.
pub(crate) fn integrate<const M: usize>(
    mut f: impl FnMut(f64) -> [f64; M],
    breaks: &[f64],
    tolerance: f64,
) -> ([f64; M], f64) {
    let mut pieces: Vec<Piece<M>> = breaks.windows(2).map(|w| piece(&mut f, w[0], w[1])).collect();
    loop {
        let mut total = [0.0; M];
        for p in &pieces {
            for m in 0..M {
                total[m] += p.value[m];
            }
        }
        let error: f64 = pieces.iter().map(|p| p.error).sum();
        let size = total.iter().fold(0.0f64, |a, v| a.max(v.abs()));
        let worst = (0..pieces.len()).max_by(|&i, &j| pieces[i].error.total_cmp(&pieces[j].error));
        let Some(worst) = worst else { return (total, 0.0) };
        // The difference of the two rules is far above the error of the better one; the rounding of the sum is left out.
        let done = error <= tolerance.max(8.0 * f64::EPSILON) * size || pieces.len() >= MOST_INTERVALS;
        let Piece { from, to, .. } = pieces[worst];
        let middle = 0.5 * (from + to);
        if done || !(from < middle && middle < to) {
            return (total, error);
        }
        pieces[worst] = piece(&mut f, from, middle);
        pieces.push(piece(&mut f, middle, to));
    }
}

/// Length of a curve between two parameters.
pub(crate) fn arc_length(curve: &dyn Curve, from: f64, to: f64) -> f64 {
    integrate(|t| [curve.jet(t).d1.norm()], &breaks_between(curve, from, to), 1e-13).0[0]
}

/// The ends of an interval and the breaks of a curve inside it.
pub(crate) fn breaks_between(curve: &dyn Curve, from: f64, to: f64) -> Vec<f64> {
    let inside = curve.breaks().into_iter().filter(|b| *b > from && *b < to);
    std::iter::once(from).chain(inside).chain([to]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exact_for_polynomials_and_adaptive_for_roots() {
        let (value, _) = integrate(|x| [x.powi(20), (x - 0.3).abs().sqrt()], &[-1.0, 1.0], 1e-12);
        assert!((value[0] - 2.0 / 21.0).abs() < 1e-14, "{value:?}");
        let root = 2.0 / 3.0 * (1.3f64.powf(1.5) + 0.7f64.powf(1.5));
        assert!((value[1] - root).abs() < 1e-10, "{value:?}");
    }
}
