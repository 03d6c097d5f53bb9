//! Least squares, and how far they can be trusted.

use super::model::{Model, Prediction};
use super::student;

/// Steps of the search.
const MOST_STEPS: usize = 60;
/// Two unknowns whose errors are correlated more than this cannot be told apart.
const CORRELATED: f64 = 0.98;

/// One unknown.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameter {
    pub value: f64,
    /// Bounds within which the truth lies with the confidence asked for.
    pub interval: [f64; 2],
    /// Standard error, relative to the value.
    pub relative_error: f64,
}

/// What the measurements tell.
#[derive(Clone, Debug)]
pub struct Estimate {
    /// Energy of adhesion per area.
    pub adhesion: Parameter,
    /// Tension as a multiple of the one stated.
    pub tension: Option<Parameter>,
    /// Correlation between the errors of the two.
    pub correlation: Option<f64>,
    /// What the model gives in place of each measurement, and the difference as the noise counts it.
    pub fitted: Vec<f64>,
    pub residuals: Vec<f64>,
    /// Standard deviation of the residuals.
    pub scatter: f64,
    pub converged: bool,
    pub warnings: Vec<String>,
}

/// The sum of squares at a point, and what its next step needs.
struct Squares {
    predictions: Vec<Prediction>,
    residuals: Vec<f64>,
    jacobian: Vec<[f64; 2]>,
    sum: f64,
}

fn squares(model: &Model, measured: &[f64], x: [f64; 2], relative: bool) -> Squares {
    let predictions: Vec<Prediction> =
        (0..model.len()).map(|i| model.predict(i, measured[i], x[0].exp(), x[1].exp())).collect();
    let pairs = || predictions.iter().zip(measured);
    let residuals: Vec<f64> = pairs().map(|(p, y)| if relative { (y / p.value).ln() } else { y - p.value }).collect();
    let jacobian = predictions.iter().map(|p| p.rates.map(|r| if relative { r / p.value } else { r })).collect();
    let sum = residuals.iter().map(|r| r * r).sum();
    Squares { predictions, residuals, jacobian, sum }
}

/// The matrix `JᵀJ` and the vector `Jᵀr`, for the unknowns that are free.
fn normal(s: &Squares, tension: bool) -> ([[f64; 2]; 2], [f64; 2]) {
    let (mut matrix, mut vector) = ([[0.0; 2]; 2], [0.0; 2]);
    let count = 1 + usize::from(tension);
    for (row, r) in s.jacobian.iter().zip(&s.residuals) {
        for i in 0..count {
            vector[i] += row[i] * r;
            for j in 0..count {
                matrix[i][j] += row[i] * row[j];
            }
        }
    }
    if !tension {
        matrix[1][1] = 1.0;
    }
    (matrix, vector)
}

fn inverse(m: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
    let determinant = m[0][0] * m[1][1] - m[0][1] * m[1][0];
    let inverse = [[m[1][1] / determinant, -m[0][1] / determinant], [-m[1][0] / determinant, m[0][0] / determinant]];
    let fine = determinant > 1e-12 * m[0][0] * m[1][1] && inverse.iter().flatten().all(|v| v.is_finite());
    fine.then_some(inverse)
}

/// Five digits, whatever the size.
fn figure(v: f64) -> String {
    let decimals = 4 - v.abs().log10().floor() as i64;
    if (0..=8).contains(&decimals) { format!("{v:.*}", decimals as usize) } else { format!("{v:.4e}") }
}

impl Estimate {
    /// Fits the unknowns to what was measured, with noise that is relative to it or absolute.
    pub fn new(model: &Model, measured: &[f64], with_tension: bool, relative: bool, confidence: f64) -> Self {
        // The median of what each measurement alone would tell.
        let mut alone: Vec<f64> = (0..model.len()).map(|i| model.explained_by(i, measured[i])).collect();
        alone.sort_by(f64::total_cmp);
        let largest = alone.last().copied().unwrap_or(0.0).max(f64::MIN_POSITIVE);
        let mut x = [alone[alone.len() / 2].max(1e-6 * largest).ln(), 0.0];
        let mut now = squares(model, measured, x, relative);
        let (mut damping, mut converged) = (1e-3, false);
        for _ in 0..MOST_STEPS {
            let (mut matrix, vector) = normal(&now, with_tension);
            for (i, row) in matrix.iter_mut().enumerate() {
                row[i] *= 1.0 + damping;
            }
            let Some(inverse) = inverse(matrix) else { break };
            let step: [f64; 2] = std::array::from_fn(|i| inverse[i][0] * vector[0] + inverse[i][1] * vector[1]);
            // A factor of e at most.
            let step = step.map(|s| s.clamp(-1.0, 1.0));
            let ahead = [x[0] + step[0], x[1] + step[1]];
            let next = squares(model, measured, ahead, relative);
            if next.sum.is_nan() || next.sum > now.sum {
                damping *= 10.0;
                if damping > 1e12 || step.iter().all(|s| s.abs() < 1e-9) {
                    converged = step.iter().all(|s| s.abs() < 1e-6);
                    break;
                }
                continue;
            }
            damping = (0.1 * damping).max(1e-12);
            (x, now) = (ahead, next);
            if step.iter().all(|s| s.abs() < 1e-9) {
                converged = true;
                break;
            }
        }
        Self::assess(model, x, &now, with_tension, confidence, converged)
    }

    fn assess(model: &Model, x: [f64; 2], s: &Squares, with_tension: bool, confidence: f64, converged: bool) -> Self {
        let count = 1 + usize::from(with_tension);
        let freedom = model.len().saturating_sub(count);
        let variance = s.sum / freedom as f64;
        let (matrix, _) = normal(s, with_tension);
        let covariance = inverse(matrix).map(|m| m.map(|row| row.map(|v| variance * v)));
        let factor = student::bound(confidence, freedom);
        let parameter = |k: usize| {
            let error = covariance.map_or(f64::INFINITY, |c| c[k][k].max(0.0).sqrt());
            let bound = |sense: f64| (x[k] + sense * factor * error).exp();
            Parameter { value: x[k].exp(), interval: [bound(-1.0), bound(1.0)], relative_error: error }
        };
        let correlation = covariance.filter(|_| with_tension).map(|c| c[0][1] / (c[0][0] * c[1][1]).sqrt());
        let mut warnings = Vec::new();
        let apart = correlation.is_none_or(|c| c.abs() < CORRELATED) && covariance.is_some();
        let (adhesion, tension) = (parameter(0), with_tension.then(|| parameter(1)));
        if with_tension && !apart {
            warnings.push(format!(
                "the data do not determine adhesion and tension separately{}: measure over a wider range of loads, or \
                 give the tension",
                correlation.map_or(String::new(), |c| format!(" (their errors are correlated by {c:.3})"))
            ));
        } else if adhesion.interval[1] > 4.0 * adhesion.interval[0] {
            warnings.push(
                "the data hardly determine the adhesion energy: the ends of its interval differ by more than a factor \
                 of four"
                    .into(),
            );
        }
        let lost = s.predictions.iter().filter(|p| !p.exists).count();
        if lost > 0 {
            warnings.push(format!(
                "for {lost} of the measurements the model has no contact: check the load and the units of these rows"
            ));
        }
        if !converged {
            warnings.push("the least-squares iteration did not converge: the values are not the optimum".into());
        }
        Self {
            adhesion,
            tension,
            correlation,
            fitted: s.predictions.iter().map(|p| p.value).collect(),
            residuals: s.residuals.clone(),
            scatter: variance.sqrt(),
            converged,
            warnings,
        }
    }

    /// The result in a sentence.
    pub fn verdict(&self, confidence: f64) -> String {
        let of = |what: &str, p: &Parameter| {
            let [value, low, high] = [p.value, p.interval[0], p.interval[1]].map(figure);
            format!("{what} {value} (between {low} and {high})")
        };
        let tension = self.tension.as_ref().map_or(String::new(), |p| of(", tension relative to the given one", p));
        format!(
            "{}{tension}, with a confidence of {} %; the measurements scatter by {:.2e}.",
            of("Adhesion energy", &self.adhesion),
            100.0 * confidence,
            self.scatter
        )
    }
}
