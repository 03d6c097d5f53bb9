//! The roots of a function on an interval.

/// The roots in `[a, b]` of a function given with its slope, from `pieces` intervals.
///
/// An interval whose ends have one sign is searched for an extremum that reaches across zero, so that a surface that
/// only bulges through a face is not lost. Zero counts as positive.
pub fn scan_roots(a: f64, b: f64, pieces: usize, mut f: impl FnMut(f64) -> (f64, f64)) -> Vec<f64> {
    let mut roots = Vec::new();
    let mut left = (a, f(a));
    for i in 1..=pieces {
        let t = if i == pieces { b } else { a + (b - a) * i as f64 / pieces as f64 };
        let right = (t, f(t));
        let sign = |v: f64| if v < 0.0 { -1.0 } else { 1.0 };
        let s = sign(left.1.0);
        if s != sign(right.1.0) {
            roots.push(bracketed_root(left, right, &mut f));
        } else if s * left.1.1 < 0.0 && s * right.1.1 > 0.0 {
            // |f| has a minimum inside: bisect the slope until the minimum, or a change of sign, is found.
            let (mut lo, mut hi) = (left.0, right.0);
            for _ in 0..50 {
                let middle = 0.5 * (lo + hi);
                let value = f(middle);
                if sign(value.0) != s {
                    roots.push(bracketed_root(left, (middle, value), &mut f));
                    roots.push(bracketed_root((middle, value), right, &mut f));
                    break;
                }
                if s * value.1 < 0.0 { lo = middle } else { hi = middle }
            }
        }
        left = right;
    }
    roots
}

/// Newton's method, kept in a bracket by bisection.
fn bracketed_root(a: (f64, (f64, f64)), b: (f64, (f64, f64)), f: &mut impl FnMut(f64) -> (f64, f64)) -> f64 {
    let negative_left = a.1.0 < 0.0;
    let (mut lo, mut hi) = (a.0, b.0);
    let tolerance = 1e-16 * (hi - lo).abs() + f64::EPSILON * lo.abs().max(hi.abs());
    // The secant is the first guess: exact for straight surfaces.
    let mut t = lo + (hi - lo) * (a.1.0 / (a.1.0 - b.1.0)).clamp(0.0, 1.0);
    for _ in 0..80 {
        let (value, slope) = f(t);
        if value == 0.0 {
            return t;
        }
        if (value < 0.0) == negative_left {
            lo = t
        } else {
            hi = t
        }
        let newton = t - value / slope;
        let next = if newton > lo.min(hi) && newton < lo.max(hi) { newton } else { 0.5 * (lo + hi) };
        if (next - t).abs() <= tolerance {
            return next;
        }
        t = next;
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn roots_that_only_bulge_through_are_found() {
        let roots = scan_roots(0.0, 1.0, 4, |t| {
            let s = t - 0.37;
            (s * s - 1e-8, 2.0 * s)
        });
        assert_eq!(roots.len(), 2);
        assert!((roots[1] - roots[0] - 2e-4).abs() < 1e-12);
    }
}
