//! Equations known by products with their matrix alone.

use nalgebra::DMatrix;

/// Solves `A x = b` for an `A` near the identity by the method of generalised conjugate residuals (Eisenstat, Elman & Schultz,
/// SIAM J. Numer. Anal. 20, 1983), until the residual is below `tolerance` times `b`; none where `most` products do not get
/// there, or one is none.
///
/// # Errors
/// Those of the products.
///
/// ```
/// use signorini_solve::krylov::conjugate_residuals;
///
/// let product = |x: &[f64]| Ok::<_, ()>(Some(vec![x[0] + 0.1 * x[1], 0.9 * x[1]]));
/// let x = conjugate_residuals(vec![1.0, 2.0], product, 1e-12, 3).unwrap().unwrap();
/// assert!((x[1] - 2.0 / 0.9).abs() < 1e-12);
/// ```
pub fn conjugate_residuals<E>(
    b: Vec<f64>,
    product: impl Fn(&[f64]) -> Result<Option<Vec<f64>>, E>,
    tolerance: f64,
    most: usize,
) -> Result<Option<Vec<f64>>, E> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let subtract = |a: &mut [f64], c: f64, b: &[f64]| a.iter_mut().zip(b).for_each(|(a, b)| *a -= c * b);
    let enough = tolerance * tolerance * dot(&b, &b);
    let mut x = vec![0.0; b.len()];
    let mut residual = b;
    // Directions, and their products, which are orthogonal to each other.
    let mut known: Vec<(Vec<f64>, Vec<f64>)> = Vec::new();
    while dot(&residual, &residual) > enough {
        if known.len() == most {
            return Ok(None);
        }
        let mut direction = residual.clone();
        let Some(mut image) = product(&direction)? else { return Ok(None) };
        for (d, i) in &known {
            let c = dot(&image, i) / dot(i, i);
            subtract(&mut image, c, i);
            subtract(&mut direction, c, d);
        }
        let square = dot(&image, &image);
        let c = dot(&residual, &image) / square;
        if square == 0.0 || !c.is_finite() {
            return Ok(None);
        }
        subtract(&mut x, -c, &direction);
        subtract(&mut residual, c, &image);
        known.push((direction, image));
    }
    Ok(Some(x))
}

/// What conjugate gradients found.
#[derive(Clone, Debug)]
pub struct Found {
    pub x: Vec<f64>,
    pub iterations: usize,
    /// Condition of the preconditioned matrix, from the coefficients of the iteration (Lanczos).
    pub condition: f64,
}

/// Why iterations gave no solution.
#[derive(Clone, Debug, PartialEq)]
pub enum Stopped<E> {
    /// Told by the product or the preconditioner.
    Equations(E),
    /// The matrix or the preconditioner is not positive definite.
    Indefinite,
    /// After so many iterations the residual was still this part of the first.
    TooMany { iterations: usize, residual: f64 },
}

impl<E> From<E> for Stopped<E> {
    fn from(error: E) -> Self {
        Stopped::Equations(error)
    }
}

/// Solves `A x = b` for a positive definite `A` by conjugate gradients, until the residual in the norm of the preconditioner
/// is `tolerance` times the first one.
///
/// # Errors
/// Those of the preconditioner; a matrix that is not positive definite; as many iterations as `most` without an end.
pub fn conjugate_gradients<E>(
    b: &[f64],
    product: impl Fn(&[f64]) -> Vec<f64>,
    precondition: impl Fn(&[f64]) -> Result<Vec<f64>, E>,
    tolerance: f64,
    most: usize,
) -> Result<Found, Stopped<E>> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut x = vec![0.0; b.len()];
    let mut r = b.to_vec();
    let mut z = precondition(&r)?;
    let mut p = z.clone();
    let mut rz = dot(&r, &z);
    let first = rz;
    let (mut steps, mut ratios): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    while rz > tolerance * tolerance * first {
        if steps.len() == most {
            return Err(Stopped::TooMany { iterations: most, residual: (rz / first).sqrt() });
        }
        let ap = product(&p);
        let energy = dot(&p, &ap);
        if energy.is_nan() || energy <= 0.0 {
            return Err(Stopped::Indefinite);
        }
        let step = rz / energy;
        for i in 0..x.len() {
            x[i] += step * p[i];
            r[i] -= step * ap[i];
        }
        z = precondition(&r)?;
        let next = dot(&r, &z);
        if next.is_nan() || next < 0.0 {
            return Err(Stopped::Indefinite);
        }
        let ratio = next / rz;
        rz = next;
        steps.push(step);
        ratios.push(ratio);
        for i in 0..p.len() {
            p[i] = z[i] + ratio * p[i];
        }
    }
    Ok(Found { x, iterations: steps.len(), condition: condition(&steps, &ratios) })
}

/// The condition from the tridiagonal matrix that the coefficients of conjugate gradients make.
fn condition(steps: &[f64], ratios: &[f64]) -> f64 {
    let n = steps.len();
    if n == 0 {
        return 1.0;
    }
    let mut t = DMatrix::<f64>::zeros(n, n);
    for i in 0..n {
        t[(i, i)] = 1.0 / steps[i] + if i > 0 { ratios[i - 1] / steps[i - 1] } else { 0.0 };
        if i + 1 < n {
            t[(i, i + 1)] = ratios[i].sqrt() / steps[i];
            t[(i + 1, i)] = t[(i, i + 1)];
        }
    }
    let values = t.symmetric_eigenvalues();
    values.max() / values.min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn conjugate_gradients_find_the_solution_and_the_condition() {
        let values = [1.0, 10.0, 4.0, 2.0];
        let product = |x: &[f64]| (0..8).map(|i| values[i % 4] * x[i]).collect::<Vec<f64>>();
        let b: Vec<f64> = (1..9).map(f64::from).collect();
        let same = |r: &[f64]| Ok::<_, ()>(r.to_vec());
        let found = conjugate_gradients(&b, product, same, 1e-12, 9).expect("four different values");
        assert!((0..8).all(|i| (values[i % 4] * found.x[i] - b[i]).abs() < 1e-10));
        assert!(found.iterations <= 4 && (found.condition - 10.0).abs() < 1e-6, "{found:?}");
        let turned = |x: &[f64]| product(x).iter().map(|v| -v).collect::<Vec<f64>>();
        assert!(matches!(conjugate_gradients(&b, turned, same, 1e-12, 9), Err(Stopped::Indefinite)));
        assert!(matches!(
            conjugate_gradients(&b, product, same, 1e-12, 1),
            Err(Stopped::TooMany { iterations: 1, .. })
        ));
    }

    #[test]
    fn as_many_products_do_as_there_are_eigenvalues() {
        let values = [1.0, 1.2, 0.7];
        let product = |x: &[f64]| Ok::<_, ()>(Some((0..9).map(|i| values[i % 3] * x[i]).collect()));
        let b: Vec<f64> = (1..10).map(f64::from).collect();
        let solve = |most| conjugate_residuals(b.clone(), product, 1e-12, most);
        let x = solve(3).ok().flatten().expect("three products");
        assert!((0..9).all(|i| (values[i % 3] * x[i] - b[i]).abs() < 1e-11), "{x:?}");
        assert_eq!(solve(2), Ok(None));
        assert_eq!(conjugate_residuals(b, |_| Err(7), 0.1, 1), Err(7));
    }

    #[test]
    fn a_matrix_that_takes_all_away_has_no_solution() {
        assert_eq!(conjugate_residuals(vec![1.0], |_| Ok::<_, ()>(Some(vec![0.0])), 0.1, 3), Ok(None));
        assert_eq!(conjugate_residuals(vec![0.0], |_| Ok::<_, ()>(None), 0.1, 3), Ok(Some(vec![0.0])));
    }
}
