//! Values at the quadrature points of a cell as polynomials of one degree less than the displacement: for stresses that are
//! known at these points only, since they have a history.

use crate::body::CellBody;
use crate::by_law::CellPoints;
use crate::legendre::integrated_legendre;
use nalgebra::{DMatrix, DVector};
use signorini_geometry::{Aabb, Point};

/// The best fit, weighted as the points are.
pub(crate) struct Fit<const D: usize> {
    bounds: Aabb<D>,
    degree: usize,
    /// From values at the points to coefficients.
    solve: DMatrix<f64>,
}

impl<const D: usize> Fit<D> {
    /// Of lower degree where a cell has too few points for more.
    pub fn new(body: &CellBody<D>, cell: usize, at: &CellPoints<D>) -> Self {
        let bounds = *body.bounds_of(cell);
        let fit = |degree: usize| {
            let columns: Vec<DVector<f64>> = at.x.iter().map(|x| polynomials(&bounds, degree, x)).collect();
            let psi = DMatrix::from_columns(&columns);
            let mut weighted = psi.clone();
            weighted.column_iter_mut().zip(&at.weights).for_each(|(mut c, w)| c *= *w);
            let solve = (&weighted * psi.transpose()).cholesky()?.solve(&weighted);
            Some(Fit { bounds, degree, solve })
        };
        // Weights of points add up to more than nothing, so that a constant always fits.
        (0..body.degree()).rev().find_map(fit).unwrap_or_else(|| Fit {
            bounds,
            degree: 0,
            solve: DMatrix::from_element(1, at.x.len(), 1.0 / at.x.len().max(1) as f64),
        })
    }

    /// The shares of the values at the points in that at a place.
    pub fn shares(&self, x: &Point<D>) -> Vec<f64> {
        self.solve.tr_mul(&polynomials(&self.bounds, self.degree, x)).as_slice().to_vec()
    }

    /// Coefficients of values, a column for each quantity.
    pub fn coefficients(&self, values: &DMatrix<f64>) -> DMatrix<f64> {
        &self.solve * values
    }

    /// Quantities at a place by their coefficients.
    pub fn at(&self, coefficients: &DMatrix<f64>, x: &Point<D>) -> DVector<f64> {
        coefficients.tr_mul(&polynomials(&self.bounds, self.degree, x))
    }
}

/// Products of Legendre polynomials of a total degree in a box.
fn polynomials<const D: usize>(b: &Aabb<D>, degree: usize, x: &Point<D>) -> DVector<f64> {
    let lines: Vec<Vec<f64>> = (0..D)
        .map(|k| {
            // The slopes of integrated Legendre functions are Legendre polynomials.
            let xi = (2.0 * x[k] - b.min[k] - b.max[k]) / (b.max[k] - b.min[k]);
            integrated_legendre(degree + 1, xi)[1..=degree + 1].iter().map(|n| n[1]).collect()
        })
        .collect();
    let count = (degree + 1).pow(D as u32);
    let digits =
        |number: usize| -> Vec<usize> { (0..D).map(|k| number / (degree + 1).pow(k as u32) % (degree + 1)).collect() };
    let values: Vec<f64> = (0..count)
        .map(digits)
        .filter(|d| d.iter().sum::<usize>() <= degree)
        .map(|d| (0..D).map(|k| lines[k][d[k]]).product())
        .collect();
    DVector::from_vec(values)
}
