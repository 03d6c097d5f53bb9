//! A root between two places at which a function has different signs.

const ITERATIONS: usize = 200;

/// By the method of Illinois, halving where that is slow; to the last digits.
pub(crate) fn bracketed(mut f: impl FnMut(f64) -> f64, [mut a, mut b]: [f64; 2]) -> f64 {
    let (mut fa, mut fb) = (f(a), f(b));
    if fa == 0.0 {
        return a;
    }
    let mut width = (b - a).abs();
    for k in 0..ITERATIONS {
        if fb == 0.0 || (b - a).abs() <= 2.0 * f64::EPSILON * (a.abs() + b.abs()) {
            return b;
        }
        let secant = b - fb * (b - a) / (fb - fa);
        let inside = secant > a.min(b) && secant < a.max(b);
        // Every third step halves where the interval has not shrunk by as much in two.
        let halve = k % 3 == 2 && (b - a).abs() > 0.25 * width;
        if k % 3 == 2 {
            width = (b - a).abs();
        }
        let c = if inside && !halve { secant } else { 0.5 * (a + b) };
        let fc = f(c);
        if (fc < 0.0) == (fb < 0.0) {
            fa *= 0.5;
        } else {
            (a, fa) = (b, fb);
        }
        (b, fb) = (c, fc);
    }
    b
}

#[cfg(test)]
mod tests {
    #[test]
    fn roots_to_the_last_digits() {
        for (f, from, to, root) in [
            ((|x: f64| x * x - 2.0) as fn(f64) -> f64, 0.0, 5.0, 2f64.sqrt()),
            (|x: f64| x.powi(9) - 1e-9, 0.0, 4.0, 0.1),
            (|x: f64| (x - 0.3).signum(), 0.0, 1.0, 0.3),
        ] {
            let mut calls = 0;
            let found = super::bracketed(
                |x| {
                    calls += 1;
                    f(x)
                },
                [from, to],
            );
            assert!((found - root).abs() < 1e-15 * 8.0 && calls < 130, "{found} {root} {calls}");
        }
    }
}
