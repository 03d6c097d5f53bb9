//! Explicit Runge-Kutta integration of order eight with error control: the pair 8(5,3) of Dormand and Prince in the form
//! of Hairer, Nørsett & Wanner, Solving Ordinary Differential Equations I (1993), II.10.

use crate::PathError;
use nalgebra::SVector;

pub(crate) type State<const N: usize> = SVector<f64, N>;

/// `y' = f(s, y)`.
pub(crate) trait System<const N: usize> {
    fn slope(&self, s: f64, y: &State<N>) -> State<N>;

    /// Moves a state back onto what the exact solution never leaves.
    fn restore(&self, _: &mut State<N>) {}

    /// The size of each component with which its error is compared.
    fn scale(&self) -> State<N>;
}

/// What a visitor of the steps wants next.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Next {
    Continue,
    /// The integration ends here.
    Stop,
}

/// Relative error of a step, and the length that is tried first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Control {
    pub tolerance: f64,
    pub first: f64,
}

const SAFETY: f64 = 0.9;
const SHORTEN: f64 = 0.2;
const LENGTHEN: f64 = 6.0;
/// Steps after which an integration is given up.
const MOST_STEPS: usize = 200_000;

/// `y + h Σ a_k k_k`.
#[inline(always)]
fn sum<const N: usize, const M: usize>(y: &State<N>, h: f64, terms: [(f64, &State<N>); M]) -> State<N> {
    let mut out = *y;
    for i in 0..N {
        let mut slope = 0.0;
        for (a, k) in &terms {
            slope += a * k[i];
        }
        out[i] += h * slope;
    }
    out
}

/// One step: the state after it and the two estimates of its error, of order five and three.
#[inline]
pub(crate) fn step<const N: usize>(
    f: &impl System<N>,
    s: f64,
    y: &State<N>,
    k1: &State<N>,
    h: f64,
) -> (State<N>, State<N>, State<N>) {
    let at = |c: f64, y: State<N>| f.slope(s + c * h, &y);
    let k2 = at(0.052_600_151_958_767_73, sum(y, h, [(5.260_015_195_876_773e-2, k1)]));
    let k3 = at(0.078_900_227_938_151_6, sum(y, h, [(1.972_505_698_453_79e-2, k1), (5.917_517_095_361_37e-2, &k2)]));
    let k4 = at(0.118_350_341_907_227_4, sum(y, h, [(2.958_758_547_680_685e-2, k1), (8.876_275_643_042_054e-2, &k3)]));
    let k5 = at(
        0.281_649_658_092_772_6,
        sum(y, h, [(2.413_651_341_592_667e-1, k1), (-8.845_494_793_282_861e-1, &k3), (9.248_340_032_617_92e-1, &k4)]),
    );
    let k6 = at(
        1.0 / 3.0,
        sum(
            y,
            h,
            [(3.703_703_703_703_703_5e-2, k1), (1.708_286_087_294_738_6e-1, &k4), (1.254_676_875_668_224_2e-1, &k5)],
        ),
    );
    let k7 = at(
        0.25,
        sum(
            y,
            h,
            [
                (3.710_937_5e-2, k1),
                (1.702_522_110_195_440_5e-1, &k4),
                (6.021_653_898_045_596e-2, &k5),
                (-1.757_812_5e-2, &k6),
            ],
        ),
    );
    let k8 = at(
        4.0 / 13.0,
        sum(
            y,
            h,
            [
                (3.709_200_011_850_479e-2, k1),
                (1.703_839_257_122_399_8e-1, &k4),
                (1.072_620_304_463_732_8e-1, &k5),
                (-1.531_943_774_862_440_2e-2, &k6),
                (8.273_789_163_814_023e-3, &k7),
            ],
        ),
    );
    let k9 = at(
        0.651_282_051_282_051_3,
        sum(
            y,
            h,
            [
                (6.241_109_587_160_757e-1, k1),
                (-3.360_892_629_446_941_4, &k4),
                (-8.682_193_468_417_26e-1, &k5),
                (2.759_209_969_944_671e1, &k6),
                (2.015_406_755_047_789_4e1, &k7),
                (-4.348_988_418_106_996e1, &k8),
            ],
        ),
    );
    let k10 = at(
        0.6,
        sum(
            y,
            h,
            [
                (4.776_625_364_382_643_4e-1, k1),
                (-2.488_114_619_971_667_7, &k4),
                (-5.902_908_268_368_43e-1, &k5),
                (2.123_005_144_818_119_3e1, &k6),
                (1.527_923_363_288_242_3e1, &k7),
                (-3.328_821_096_898_486e1, &k8),
                (-2.033_120_170_850_862_7e-2, &k9),
            ],
        ),
    );
    let k11 = at(
        6.0 / 7.0,
        sum(
            y,
            h,
            [
                (-9.371_424_300_859_873e-1, k1),
                (5.186_372_428_844_064, &k4),
                (1.091_437_348_996_729_5, &k5),
                (-8.149_787_010_746_927, &k6),
                (-1.852_006_565_999_696e1, &k7),
                (2.273_948_709_935_050_5e1, &k8),
                (2.493_605_552_679_652_3, &k9),
                (-3.046_764_471_898_219_6, &k10),
            ],
        ),
    );
    let k12 = at(
        1.0,
        sum(
            y,
            h,
            [
                (2.273_310_147_516_538, k1),
                (-1.053_449_546_673_725e1, &k4),
                (-2.000_872_058_224_862_5, &k5),
                (-1.795_893_186_311_88e1, &k6),
                (2.794_888_452_941_996e1, &k7),
                (-2.858_998_277_135_023_5, &k8),
                (-8.872_856_933_530_63, &k9),
                (1.236_056_717_579_430_3e1, &k10),
                (6.433_927_460_157_636e-1, &k11),
            ],
        ),
    );
    let slope = sum(
        &State::<N>::zeros(),
        1.0,
        [
            (5.429_373_411_656_876e-2, k1),
            (4.450_312_892_752_409, &k6),
            (1.891_517_899_314_500_3, &k7),
            (-5.801_203_960_010_585, &k8),
            (3.111_643_669_578_199e-1, &k9),
            (-1.521_609_496_625_161e-1, &k10),
            (2.013_654_008_040_303_5e-1, &k11),
            (4.471_061_572_777_259e-2, &k12),
        ],
    );
    let fifth = sum(
        &State::<N>::zeros(),
        1.0,
        [
            (0.131_200_449_941_948_8e-1, k1),
            (-0.122_515_644_637_620_44e1, &k6),
            (-0.495_758_949_657_250_2, &k7),
            (0.166_437_718_245_498_65e1, &k8),
            (-0.350_328_848_749_973_7, &k9),
            (0.334_179_118_713_017_5, &k10),
            (0.819_232_064_851_157_1e-1, &k11),
            (-0.223_553_078_638_862_95e-1, &k12),
        ],
    );
    let third = sum(
        &slope,
        1.0,
        [(-0.244_094_488_188_976_4, k1), (-0.733_846_688_281_611_9, &k9), (-0.220_588_235_294_117_65e-1, &k12)],
    );
    (y + slope * h, fifth, third)
}

/// The error of a step in units of what is allowed.
fn error<const N: usize>(
    fifth: &State<N>,
    third: &State<N>,
    y: &State<N>,
    next: &State<N>,
    scale: &State<N>,
    h: f64,
) -> f64 {
    let (mut five, mut three) = (0.0, 0.0);
    for i in 0..N {
        let size = scale[i] + y[i].abs().max(next[i].abs());
        five += (fifth[i] / size).powi(2);
        three += (third[i] / size).powi(2);
    }
    let mean = five + 0.01 * three;
    if mean == 0.0 { 0.0 } else { h.abs() * five / (mean * N as f64).sqrt() }
}

/// The state at `to`, or where a visitor stops. `visit(from, state, to, state)` sees every step, and may end the
/// integration after it.
///
/// # Errors
/// Steps that become shorter than rounding resolves, or too many.
pub(crate) fn integrate<const N: usize>(
    f: &impl System<N>,
    [from, to]: [f64; 2],
    start: &State<N>,
    control: Control,
    mut visit: impl FnMut(f64, &State<N>, f64, &State<N>) -> Next,
) -> Result<(f64, State<N>), PathError> {
    let direction = (to - from).signum();
    let (mut s, mut y) = (from, *start);
    let scale = f.scale();
    let mut h = control.first.abs().min((to - from).abs());
    let mut slope = f.slope(s, &y);
    let mut rejected = false;
    for _ in 0..MOST_STEPS {
        let left = (to - s).abs();
        if left == 0.0 {
            return Ok((s, y));
        }
        // Two steps of even length rather than one and a short one.
        let last = h >= left * (1.0 - 1e-12);
        let length = if last {
            left
        } else if 2.0 * h > left {
            0.5 * left
        } else {
            h
        };
        let (mut next, fifth, third) = step(f, s, &y, &slope, direction * length);
        let found = error(&fifth, &third, &y, &next, &scale, length) / control.tolerance;
        if found <= 1.0 {
            let there = if last { to } else { s + direction * length };
            f.restore(&mut next);
            let stop = visit(s, &y, there, &next);
            (s, y) = (there, next);
            if stop == Next::Stop {
                return Ok((s, y));
            }
            if last {
                return Ok((s, y));
            }
            slope = f.slope(s, &y);
            let most = if rejected { 1.0 } else { LENGTHEN };
            h = length * (SAFETY * found.max(1e-16).powf(-0.125)).clamp(SHORTEN, most);
            rejected = false;
        } else {
            let share = if found.is_finite() { (SAFETY * found.powf(-0.125)).max(SHORTEN) } else { SHORTEN };
            h = length * share;
            rejected = true;
            if h <= 4.0 * f64::EPSILON * s.abs().max((to - from).abs()) {
                break;
            }
        }
    }
    Err(PathError::Stalled { at: s, of: to - from })
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Oscillator;

    impl System<2> for Oscillator {
        fn slope(&self, _: f64, y: &State<2>) -> State<2> {
            State::<2>::new(y[1], -y[0])
        }

        fn scale(&self) -> State<2> {
            State::<2>::repeat(1.0)
        }
    }

    #[test]
    fn a_step_has_order_eight() {
        let errors = [8, 16].map(|n| {
            let h = 4.0 / f64::from(n);
            let mut y = State::<2>::new(1.0, 0.0);
            for k in 0..n {
                let s = f64::from(k) * h;
                y = step(&Oscillator, s, &y, &Oscillator.slope(s, &y), h).0;
            }
            (y - State::<2>::new(4f64.cos(), -4f64.sin())).norm()
        });
        let order = (errors[0] / errors[1]).log2();
        assert!((7.5..9.5).contains(&order), "{errors:?} {order}");
    }

    #[test]
    fn the_error_is_what_was_asked_for_in_both_directions() {
        for (tolerance, to) in [(1e-8, 20.0), (1e-13, 20.0), (1e-13, -20.0)] {
            let control = Control { tolerance, first: 0.1 };
            let mut steps = 0;
            let start = State::<2>::new(1.0, 0.0);
            let (s, y) = integrate(&Oscillator, [0.0, to], &start, control, |_, _, _, _| {
                steps += 1;
                Next::Continue
            })
            .unwrap();
            assert_eq!(s, to);
            let error = (y - State::<2>::new(to.cos(), -to.sin())).norm();
            assert!(error < 10.0 * tolerance && steps < 150, "{error} {steps}");
        }
    }
}
