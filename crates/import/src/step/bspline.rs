//! B-splines of files: parts of them, and the surfaces that they sweep.

use signorini_geometry::Point;

/// A point with its weight.
pub(super) type Weighted = (Point<3>, f64);

/// A curve of rational B-splines.
#[derive(Clone, Debug)]
pub(super) struct Bspline {
    pub degree: usize,
    pub knots: Vec<f64>,
    pub control: Vec<Weighted>,
}

impl Bspline {
    pub fn domain(&self) -> [f64; 2] {
        [self.knots[self.degree], self.knots[self.control.len()]]
    }

    pub fn points(&self) -> Vec<Point<3>> {
        self.control.iter().map(|c| c.0).collect()
    }

    pub fn weights(&self) -> Vec<f64> {
        self.control.iter().map(|c| c.1).collect()
    }

    /// A whole circle or ellipse `o + cos t a + sin t b`, from `t = 0`.
    pub fn ellipse(origin: Point<3>, a: Point<3>, b: Point<3>) -> Self {
        let corners =
            [(1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (-1.0, 1.0), (-1.0, 0.0), (-1.0, -1.0), (0.0, -1.0), (1.0, -1.0)];
        let at = |k: usize| {
            let (p, q) = corners[k % 8];
            let weight = if k.is_multiple_of(2) { 1.0 } else { std::f64::consts::FRAC_1_SQRT_2 };
            (origin + a * p + b * q, weight)
        };
        let quarter = |k: i32| std::f64::consts::FRAC_PI_2 * f64::from(k);
        let knots = [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4].map(quarter).to_vec();
        Bspline { degree: 2, knots, control: (0..9).map(at).collect() }
    }

    /// The part between two parameters of the domain.
    pub fn part(&self, from: f64, to: f64) -> Self {
        let whole = self.with_knot(from).with_knot(to);
        let p = self.degree;
        let last = whole.knots.iter().rposition(|t| *t == from).unwrap_or(p);
        let first = whole.knots.iter().position(|t| *t == to).unwrap_or(whole.control.len());
        let control = whole.control[last - p..first].to_vec();
        let mut knots = vec![from; p + 1];
        knots.extend(whole.knots.iter().filter(|t| **t > from && **t < to));
        knots.extend(vec![to; p + 1]);
        Bspline { degree: p, knots, control }
    }

    /// The same curve with a knot as often as the degree (Boehm 1980).
    fn with_knot(&self, t: f64) -> Self {
        let p = self.degree;
        let mut out = self.clone();
        while out.knots.iter().filter(|k| **k == t).count() < p {
            let span = out.knots.partition_point(|k| *k <= t) - 1;
            let homogeneous = |(x, w): &Weighted| (x * *w, *w);
            let old: Vec<Weighted> = out.control.iter().map(homogeneous).collect();
            let control = (0..=old.len()).map(|i| {
                if i + p <= span {
                    return old[i];
                }
                if i > span {
                    return old[i - 1];
                }
                let share = (t - out.knots[i]) / (out.knots[i + p] - out.knots[i]);
                let (a, b) = (&old[i - 1], &old[i]);
                (a.0 * (1.0 - share) + b.0 * share, a.1 * (1.0 - share) + b.1 * share)
            });
            out.control = control.map(|(x, w)| (x / w, w)).collect();
            out.knots.insert(span + 1, t);
        }
        out
    }

    /// Two curves of one degree, one after the other, of which the second begins where the first ends.
    pub fn followed_by(&self, next: &Self) -> Self {
        let (p, shift) = (self.degree, self.domain()[1] - next.domain()[0]);
        let scale = self.control[self.control.len() - 1].1 / next.control[0].1;
        let mut knots = self.knots[..self.knots.len() - 1].to_vec();
        knots.extend(next.knots[p + 1..].iter().map(|t| t + shift));
        let mut control = self.control.clone();
        control.extend(next.control[1..].iter().map(|(x, w)| (*x, w * scale)));
        Bspline { degree: p, knots, control }
    }
}
