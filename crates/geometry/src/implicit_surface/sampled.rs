//! Functions given by their values on a regular grid.

use super::ScalarField;
use crate::jet::Jet;
use crate::shape::ShapeError;
use crate::{Matrix, Point, Vector};

/// Values on a regular grid joined by a tricubic spline: twice continuously differentiable.
#[derive(Clone, Debug)]
pub struct SampledField {
    origin: Point<3>,
    spacing: [f64; 3],
    count: [usize; 3],
    coefficients: Vec<f64>,
}

impl SampledField {
    /// The spline through `values[(i * count[1] + j) * count[2] + k]` at `origin + (i, j, k) * spacing`. Beyond the grid
    /// it goes on as at the nearest point inside.
    ///
    /// # Errors
    /// Fewer than four values in a direction, another number of values than the grid has, values that are not finite,
    /// a spacing that is not positive.
    pub fn new(origin: Point<3>, spacing: [f64; 3], count: [usize; 3], values: &[f64]) -> Result<Self, ShapeError> {
        crate::shape::check_position("origin", &origin)?;
        if spacing.iter().any(|h| !(h.is_finite() && *h > 0.0)) {
            return Err(ShapeError::new("spacing", format!("{spacing:?} must be greater than zero")));
        }
        if count.iter().any(|&n| n < 4) {
            return Err(ShapeError::new("count", format!("{count:?}: a spline needs four values in each direction")));
        }
        let expected = count[0] * count[1] * count[2];
        if values.len() != expected {
            return Err(ShapeError::new("values", format!("{} numbers, the grid has {expected}", values.len())));
        }
        if let Some(value) = values.iter().find(|v| !v.is_finite()) {
            return Err(ShapeError::new("values", format!("{value} is not a finite number")));
        }
        let mut coefficients = values.to_vec();
        let strides = [count[1] * count[2], count[2], 1];
        for axis in 0..3 {
            let n = count[axis];
            let mut line = vec![0.0; n];
            for start in 0..expected {
                if !(start / strides[axis]).is_multiple_of(n) {
                    continue;
                }
                for (m, value) in line.iter_mut().enumerate() {
                    *value = coefficients[start + m * strides[axis]];
                }
                prefilter(&mut line);
                for (m, value) in line.iter().enumerate() {
                    coefficients[start + m * strides[axis]] = *value;
                }
            }
        }
        Ok(SampledField { origin, spacing, count, coefficients })
    }
}

/// Coefficients of the cubic spline with natural ends through values: `(c_{i-1} + 4 c_i + c_{i+1}) / 6 = f_i`, with
/// `c_{-1} = 2 c_0 - c_1` at both ends, so that the end coefficients are the end values.
fn prefilter(f: &mut [f64]) {
    let n = f.len();
    let inner = n - 2;
    // Thomas on the inner unknowns, the ends being known.
    let mut diagonal = vec![4.0; inner];
    let mut rhs: Vec<f64> = (1..=inner).map(|i| 6.0 * f[i]).collect();
    rhs[0] -= f[0];
    rhs[inner - 1] -= f[n - 1];
    for i in 1..inner {
        let factor = 1.0 / diagonal[i - 1];
        diagonal[i] -= factor;
        rhs[i] -= factor * rhs[i - 1];
    }
    for i in (0..inner).rev() {
        let above = if i + 1 < inner { f[i + 2] } else { 0.0 };
        f[i + 1] = (rhs[i] - above) / diagonal[i];
    }
}

impl ScalarField for SampledField {
    fn jet(&self, x: &Point<3>) -> Jet<3> {
        let mut weights = [[[0.0; 4]; 3]; 3];
        let mut index = [[0usize; 4]; 3];
        let mut mirrored = [[[0.0f64; 2]; 4]; 3];
        for a in 0..3 {
            let n = self.count[a];
            let t = ((x[a] - self.origin[a]) / self.spacing[a]).clamp(0.0, (n - 1) as f64);
            let cell = (t.floor() as usize).min(n - 2);
            let s = t - cell as f64;
            let h = self.spacing[a];
            weights[a] = [
                [
                    (1.0 - s).powi(3) / 6.0,
                    (4.0 - 6.0 * s * s + 3.0 * s.powi(3)) / 6.0,
                    (1.0 + 3.0 * s + 3.0 * s * s - 3.0 * s.powi(3)) / 6.0,
                    s.powi(3) / 6.0,
                ],
                [
                    -0.5 * (1.0 - s).powi(2) / h,
                    (-2.0 * s + 1.5 * s * s) / h,
                    (0.5 + s - 1.5 * s * s) / h,
                    0.5 * s * s / h,
                ],
                [(1.0 - s) / (h * h), (3.0 * s - 2.0) / (h * h), (1.0 - 3.0 * s) / (h * h), s / (h * h)],
            ];
            for m in 0..4 {
                // Beyond the ends the coefficients go on in a straight line: 2 c_0 - c_1.
                let i = cell as i64 + m as i64 - 1;
                index[a][m] = i.clamp(0, n as i64 - 1) as usize;
                mirrored[a][m] = if i < 0 || i >= n as i64 { [2.0, -1.0] } else { [1.0, 0.0] };
            }
        }
        // Fold what lies beyond into the two outermost coefficients.
        for a in 0..3 {
            let n = self.count[a];
            for m in 0..4 {
                if mirrored[a][m][1] != 0.0 {
                    let (end, next) = if index[a][m] == 0 { (0, 1) } else { (n - 1, n - 2) };
                    for order in 0..3 {
                        let w = weights[a][order][m];
                        weights[a][order][m] = 0.0;
                        for l in 0..4 {
                            if l != m && index[a][l] == end && mirrored[a][l][1] == 0.0 {
                                weights[a][order][l] += 2.0 * w;
                            } else if l != m && index[a][l] == next {
                                weights[a][order][l] -= w;
                            }
                        }
                    }
                }
            }
        }
        let mut jet = Jet { value: 0.0, gradient: Vector::<3>::zeros(), hessian: Matrix::<3>::zeros() };
        for i in 0..4 {
            for j in 0..4 {
                for k in 0..4 {
                    let c =
                        self.coefficients[(index[0][i] * self.count[1] + index[1][j]) * self.count[2] + index[2][k]];
                    let w = |p: usize, q: usize, r: usize| weights[0][p][i] * weights[1][q][j] * weights[2][r][k] * c;
                    jet.value += w(0, 0, 0);
                    jet.gradient += Vector::<3>::new(w(1, 0, 0), w(0, 1, 0), w(0, 0, 1));
                    let (xy, xz, yz) = (w(1, 1, 0), w(1, 0, 1), w(0, 1, 1));
                    jet.hessian += Matrix::<3>::new(w(2, 0, 0), xy, xz, xy, w(0, 2, 0), yz, xz, yz, w(0, 0, 2));
                }
            }
        }
        jet
    }
}
