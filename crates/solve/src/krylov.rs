//! Equations known by products with their matrix alone.

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

#[cfg(test)]
mod tests {
    use super::*;

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
