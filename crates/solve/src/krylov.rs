//! Equations known by products with their matrix alone.

use nalgebra::DMatrix;

/// Vectors and their products with one matrix `W`: what was found out about it, for equations that contain it.
#[derive(Clone, Debug, Default)]
pub struct Products(Vec<[Vec<f64>; 2]>);

impl Products {
    /// Forgets all of them.
    pub fn clear(&mut self) {
        self.0.clear();
    }

    /// Number of products known.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }
}

/// Equations `A x = b` with `A x` a function of `x` and `W x` alone, such as rows that are either open or closed.
pub struct Equations<'a, E> {
    /// `W x`.
    pub product: &'a dyn Fn(&[f64]) -> Result<Vec<f64>, E>,
    /// `A x` from `x` and `W x`, linear in both together.
    pub image: &'a dyn Fn(&[f64], &[f64]) -> Vec<f64>,
}

/// The solution of [`Equations`] with the least residual that the products known allow.
#[derive(Clone, Debug)]
pub struct Least {
    pub x: Vec<f64>,
    /// `W x`.
    pub product: Vec<f64>,
    /// `|b - A x| / |b|`.
    pub relative: f64,
}

/// Share of a vector, after what others say is taken away, below which nothing is left of it but rounding.
const EXHAUSTED: f64 = 1e-14;
/// A residual that fell at least to this share is a good next direction; else the last image is, which makes a new one in any
/// case (Jiránek & Rozložník, Adaptive version of Simpler GMRES, Numer. Algorithms 53, 2010).
const FELL: f64 = 0.9;

impl<E> Equations<'_, E> {
    /// The `x` of least residual among all combinations of the vectors in `known` and of a Krylov space that grows until the
    /// residual is below `tolerance` times `b`, until `known` has `most` vectors, or until nothing new comes out. The matrix
    /// may be unsymmetric and indefinite. New products are added to those known.
    ///
    /// # Errors
    /// Those of the products.
    pub fn least_residual(&self, b: &[f64], known: &mut Products, tolerance: f64, most: usize) -> Result<Least, E> {
        let whole = dot(b, b).sqrt();
        let mut space = Space { images: Vec::new(), coefficients: Vec::new(), used: Vec::new() };
        let mut residual = b.to_vec();
        let mut parts = Vec::new();
        let mut take = |space: &mut Space, residual: &mut Vec<f64>, which: usize, image: Vec<f64>| {
            let is_new = space.add(which, image);
            if is_new && let Some(image) = space.images.last() {
                let part = dot(image, residual);
                subtract(residual, part, image);
                parts.push(part);
            }
            is_new
        };
        for (which, [x, wx]) in known.0.iter().enumerate() {
            take(&mut space, &mut residual, which, (self.image)(x, wx));
        }
        let mut size = dot(&residual, &residual).sqrt();
        let mut falls = true;
        while size > tolerance * whole && known.len() < most {
            let mut next = match space.images.last() {
                Some(image) if !falls => image.clone(),
                _ => residual.clone(),
            };
            let length = dot(&next, &next).sqrt();
            next.iter_mut().for_each(|v| *v /= length);
            let product = (self.product)(&next)?;
            let image = (self.image)(&next, &product);
            known.0.push([next, product]);
            if !take(&mut space, &mut residual, known.len() - 1, image) {
                if !falls {
                    break;
                }
                // The residual itself says nothing new: the last image may.
                falls = false;
                continue;
            }
            let now = dot(&residual, &residual).sqrt();
            (falls, size) = (now < FELL * size, now);
        }
        let mut out = Least { x: vec![0.0; b.len()], product: vec![0.0; b.len()], relative: 0.0 };
        for (which, factor) in space.factors(&parts) {
            let [x, wx] = &known.0[which];
            subtract(&mut out.x, -factor, x);
            subtract(&mut out.product, -factor, wx);
        }
        if whole > 0.0 {
            out.relative = size / whole;
        }
        Ok(out)
    }
}

/// Orthonormal images `A V = C R` of the vectors used.
struct Space {
    images: Vec<Vec<f64>>,
    /// Columns of `R`.
    coefficients: Vec<Vec<f64>>,
    used: Vec<usize>,
}

impl Space {
    /// Adds an image; false where it says nothing new.
    fn add(&mut self, which: usize, mut image: Vec<f64>) -> bool {
        let whole = dot(&image, &image).sqrt();
        let mut column = vec![0.0; self.images.len()];
        let mut left = whole;
        // Twice, where much cancels, is enough (Kahan; Parlett 1980).
        for _ in 0..2 {
            let before = left;
            for (c, other) in column.iter_mut().zip(&self.images) {
                let part = dot(&image, other);
                subtract(&mut image, part, other);
                *c += part;
            }
            left = dot(&image, &image).sqrt();
            if left > 0.5 * before {
                break;
            }
        }
        if left.is_nan() || left <= EXHAUSTED * whole {
            return false;
        }
        image.iter_mut().for_each(|v| *v /= left);
        column.push(left);
        self.images.push(image);
        self.coefficients.push(column);
        self.used.push(which);
        true
    }

    /// The vectors used with their factors, from the parts of the solution along the images.
    fn factors(&self, parts: &[f64]) -> Vec<(usize, f64)> {
        let mut y = parts.to_vec();
        for j in (0..y.len()).rev() {
            y[j] /= self.coefficients[j][j];
            let (before, from) = y.split_at_mut(j);
            subtract(before, from[0], &self.coefficients[j][..j]);
        }
        self.used.iter().copied().zip(y).collect()
    }
}

/// A scalar product, in lanes that a processor works on together.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; 8];
    let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        (0..8).for_each(|k| lanes[k] += a[k] * b[k]);
    }
    lanes.iter().sum::<f64>() + rest
}

fn subtract(a: &mut [f64], factor: f64, b: &[f64]) {
    a.iter_mut().zip(b).for_each(|(a, b)| *a -= factor * b);
}

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

    /// A saddle point, and a closed row that opens: what was found out about the matrix serves both.
    #[test]
    fn saddle_points_and_changed_rows_share_their_products() {
        let n = 60;
        let entry = |i: usize, j: usize| (-0.4 * (i as f64 - j as f64).abs()).exp() + f64::from(u8::from(i == j));
        // W with a border without a diagonal.
        let border = |i: usize| 1.0 + 0.02 * i as f64;
        let product = |x: &[f64]| {
            let mut y: Vec<f64> =
                (0..n).map(|i| (0..n).map(|j| entry(i, j) * x[j]).sum::<f64>() + border(i) * x[n]).collect();
            y.push((0..n).map(|j| border(j) * x[j]).sum());
            Ok::<_, ()>(y)
        };
        let b: Vec<f64> = (0..=n).map(|i| (i as f64).sin()).collect();
        let mut known = Products::default();
        let mut counts = Vec::new();
        for open in [n + 1, 7] {
            let image = |x: &[f64], wx: &[f64]| (0..=n).map(|i| if i == open { x[i] } else { wx[i] }).collect();
            let equations = Equations { product: &product, image: &image };
            let found = equations.least_residual(&b, &mut known, 1e-13, 200).unwrap();
            assert!(found.relative < 1e-13);
            let wx = product(&found.x).unwrap();
            let left: Vec<f64> = image(&found.x, &wx);
            assert!(left.iter().zip(&b).all(|(l, b)| (l - b).abs() < 1e-11));
            assert!(wx.iter().zip(&found.product).all(|(a, b)| (a - b).abs() < 1e-11));
            counts.push(known.len());
        }
        assert!(counts[1] - counts[0] < counts[0], "{counts:?}");
        // Nothing reaches a part that the matrix does not have.
        let image = |x: &[f64], wx: &[f64]| (0..=n).map(|i| if i == 3 { 0.0 * x[i] } else { wx[i] }).collect();
        let found = Equations { product: &product, image: &image }.least_residual(&b, &mut known, 1e-13, 300).unwrap();
        assert!(found.relative > 1e-3 && known.len() < 300);
    }

    #[test]
    fn a_matrix_that_takes_all_away_has_no_solution() {
        assert_eq!(conjugate_residuals(vec![1.0], |_| Ok::<_, ()>(Some(vec![0.0])), 0.1, 3), Ok(None));
        assert_eq!(conjugate_residuals(vec![0.0], |_| Ok::<_, ()>(None), 0.1, 3), Ok(Some(vec![0.0])));
    }
}
