//! Curves that are given: by a formula, by points, by the shapes of the geometry.

use crate::PathError;
use crate::banded::Banded;
use signorini_geometry::{Jet, Point, Real, Vector};

/// Position and derivatives with respect to the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveJet {
    pub x: Point<3>,
    pub d1: Vector<3>,
    pub d2: Vector<3>,
}

/// A curve with two derivatives.
pub trait Curve: Sync {
    /// The range of the parameter.
    fn domain(&self) -> [f64; 2];

    fn jet(&self, t: f64) -> CurveJet;

    /// Parameters at which higher derivatives jump: integrals are split there.
    fn breaks(&self) -> Vec<f64> {
        Vec::new()
    }
}

impl Curve for signorini_geometry::shape::Curve {
    fn domain(&self) -> [f64; 2] {
        signorini_geometry::shape::Curve::domain(self)
    }

    fn jet(&self, t: f64) -> CurveJet {
        let jet = signorini_geometry::shape::Curve::jet(self, t);
        CurveJet { x: jet.x, d1: jet.d1, d2: jet.d2 }
    }
}

/// A curve given by a formula, with exact derivatives.
#[derive(Clone, Copy, Debug)]
pub struct Analytic<F> {
    formula: F,
    domain: [f64; 2],
}

impl<F: Fn(Jet<1>) -> [Jet<1>; 3] + Sync> Analytic<F> {
    /// # Errors
    /// A range that does not increase.
    pub fn new(formula: F, domain: [f64; 2]) -> Result<Self, PathError> {
        if domain[0] < domain[1] {
            Ok(Analytic { formula, domain })
        } else {
            Err(PathError::Input { what: "the end of the range", value: domain[1], valid: "more than its start" })
        }
    }
}

impl<F: Fn(Jet<1>) -> [Jet<1>; 3] + Sync> Curve for Analytic<F> {
    fn domain(&self) -> [f64; 2] {
        self.domain
    }

    fn jet(&self, t: f64) -> CurveJet {
        let jets = (self.formula)(Jet::<1>::variable(t, 0));
        let triple = |of: fn(&Jet<1>) -> f64| Vector::<3>::from_fn(|k, _| of(&jets[k]));
        CurveJet { x: triple(|j| j.value()), d1: triple(|j| j.gradient[0]), d2: triple(|j| j.hessian[(0, 0)]) }
    }
}

/// The degree of splines through points: their second derivatives converge with the fourth power of the spacing.
const DEGREE: usize = 5;

/// The spline of degree five through points over chord lengths, its knots the means of the parameters that they stand
/// for (de Boor, A Practical Guide to Splines, XIII).
#[derive(Clone, Debug)]
pub struct PointSpline {
    knots: Vec<f64>,
    coefficients: Vec<Vector<3>>,
}

impl PointSpline {
    /// # Errors
    /// Fewer than six points, coordinates that are not finite, two equal points in succession.
    pub fn new(points: &[Point<3>]) -> Result<Self, PathError> {
        let n = points.len();
        if n <= DEGREE {
            return Err(PathError::Count { what: "points of a curve", given: n, valid: "at least six" });
        }
        let mut t = vec![0.0; n];
        for k in 1..n {
            let chord = (points[k] - points[k - 1]).norm();
            if !(chord.is_finite() && chord > 0.0) {
                let what = "the distance of two points in succession";
                return Err(PathError::Input { what, value: chord, valid: "a number greater than zero" });
            }
            t[k] = t[k - 1] + chord;
        }
        let mut knots = vec![t[0]; DEGREE + 1];
        knots.extend((1..n - DEGREE).map(|j| t[j..j + DEGREE].iter().sum::<f64>() / DEGREE as f64));
        knots.extend(vec![t[n - 1]; DEGREE + 1]);
        let mut matrix = Banded::default();
        matrix.reset(n, DEGREE, DEGREE);
        for (i, &t) in t.iter().enumerate() {
            let (first, values) = basis(&knots, t);
            for (k, value) in values[0].iter().enumerate().filter(|(_, v)| **v != 0.0) {
                matrix.add(i, first + k, *value);
            }
        }
        if !matrix.factorise() {
            return Err(PathError::Count { what: "points of a curve", given: n, valid: "their spacing is too uneven" });
        }
        let mut coefficients = vec![Vector::<3>::zeros(); n];
        for c in 0..3 {
            let mut values: Vec<f64> = points.iter().map(|p| p[c]).collect();
            matrix.solve(&mut values);
            coefficients.iter_mut().zip(values).for_each(|(x, v)| x[c] = v);
        }
        Ok(PointSpline { knots, coefficients })
    }
}

impl Curve for PointSpline {
    fn domain(&self) -> [f64; 2] {
        [self.knots[0], self.knots[self.knots.len() - 1]]
    }

    fn jet(&self, t: f64) -> CurveJet {
        let (first, values) = basis(&self.knots, t);
        let sum = |order: usize| {
            (0..=DEGREE)
                .map(|k| self.coefficients[first + k] * values[order][k])
                .fold(Vector::<3>::zeros(), |a, b| a + b)
        };
        CurveJet { x: sum(0), d1: sum(1), d2: sum(2) }
    }

    fn breaks(&self) -> Vec<f64> {
        self.knots[DEGREE + 1..self.knots.len() - DEGREE - 1].to_vec()
    }
}

/// The functions that do not vanish at `t`, with two derivatives: the index of the first and their values.
fn basis(knots: &[f64], t: f64) -> (usize, [[f64; DEGREE + 1]; 3]) {
    let n = knots.len() - DEGREE - 1;
    let t = t.clamp(knots[0], knots[n]);
    let span = knots.partition_point(|k| *k <= t).clamp(DEGREE + 1, n) - 1;
    // Values of degree p at the end of each sweep; those of degree p - 1 and p - 2 give the derivatives.
    let raise = |lower: &[f64; DEGREE + 1], p: usize| {
        let mut upper = [0.0; DEGREE + 1];
        for k in 0..p {
            let (left, right) = (knots[span + 1 + k - p], knots[span + 1 + k]);
            let share = (t - left) / (right - left);
            upper[k] += (1.0 - share) * lower[k];
            upper[k + 1] += share * lower[k];
        }
        upper
    };
    let slope = |lower: &[f64; DEGREE + 1], p: usize| {
        let mut upper = [0.0; DEGREE + 1];
        for k in 0..p {
            let rate = p as f64 / (knots[span + 1 + k] - knots[span + 1 + k - p]);
            upper[k] -= rate * lower[k];
            upper[k + 1] += rate * lower[k];
        }
        upper
    };
    let mut values = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let mut two_below = values;
    let mut one_below = values;
    for p in 1..=DEGREE {
        if p == DEGREE - 1 {
            two_below = values;
        }
        if p == DEGREE {
            one_below = values;
        }
        values = raise(&values, p);
    }
    let second = slope(&slope(&two_below, DEGREE - 1), DEGREE);
    (span - DEGREE, [values, slope(&one_below, DEGREE), second])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn helix(t: f64) -> Point<3> {
        Point::<3>::new(t.cos(), t.sin(), 0.3 * t)
    }

    #[test]
    fn splines_through_points_bend_with_order_four() {
        let errors = [21, 41].map(|n| {
            // Of uneven spacing.
            let at = |k: usize| {
                let u = k as f64 / f64::from(n - 1);
                4.0 * (u + 0.1 * (3.0 * u).sin())
            };
            let points: Vec<Point<3>> = (0..n as usize).map(|k| helix(at(k))).collect();
            let spline = PointSpline::new(&points).unwrap();
            let [from, to] = spline.domain();
            (0..=200)
                .map(|k| {
                    let jet = spline.jet(from + (to - from) * f64::from(k) / 200.0);
                    let bend = jet.d1.cross(&jet.d2).norm() / jet.d1.norm().powi(3);
                    (bend - 1.0 / 1.09).abs()
                })
                .fold(0.0, f64::max)
        });
        assert!(errors[1] < 1e-3 && errors[0] / errors[1] > 10.0, "{errors:?}");
        assert!(PointSpline::new(&[helix(0.0); 7]).is_err() && PointSpline::new(&[helix(0.0)]).is_err());
    }

    #[test]
    fn derivatives_of_splines_and_formulas() {
        let points: Vec<Point<3>> = (0..12).map(|k| helix(f64::from(k) * 0.3)).collect();
        let spline = PointSpline::new(&points).unwrap();
        let formula = |t: Jet<1>| [t.cos(), t.sin(), t * 0.3];
        let analytic = Analytic::new(formula, [0.0, 1.0]).unwrap();
        for curve in [&spline as &dyn Curve, &analytic] {
            let (t, h) = (0.7, 1e-5);
            let [up, down] = [curve.jet(t + h), curve.jet(t - h)];
            assert!(((up.x - down.x) / (2.0 * h) - curve.jet(t).d1).norm() < 1e-9);
            assert!(((up.d1 - down.d1) / (2.0 * h) - curve.jet(t).d2).norm() < 1e-9);
        }
        assert!((spline.jet(0.0).x - points[0]).norm() < 1e-14);
        assert!((spline.jet(spline.domain()[1]).x - points[11]).norm() < 1e-14);
    }
}
