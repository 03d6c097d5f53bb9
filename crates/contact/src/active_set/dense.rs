//! The dense system of the active rows and the springs.
//!
//! With the compliance `S` of the rows, `G` of the rows under spring forces, `H` of the springs under pressures and `C` of
//! the springs less what they give themselves:
//!
//! ```text
//! [ S  G ] [ λ ]     [ gaps ]
//! [ H  C ] [ φ ] = - [ lack ]
//! ```
//!
//! `S` is positive definite, as the springs hold all bodies. Of bodies that are otherwise free `C = 0`, and the small
//! complement `C - H S⁻¹ G` says whether the active rows hold them.

use super::error::ActiveSetError;
use nalgebra::{Cholesky, DMatrix, DVector, DVectorView, Dyn, FullPivLU};

/// Pivots, and stiffness of a body on its contact relative to its spring, below which there is none.
const SINGULAR: f64 = 1e-11;

enum Factored {
    Definite(Cholesky<f64, Dyn>),
    General(Box<FullPivLU<f64, Dyn, Dyn>>),
}

impl Factored {
    fn new(matrix: DMatrix<f64>, symmetric: bool) -> Result<Self, ActiveSetError> {
        if symmetric && let Some(factor) = matrix.clone().cholesky() {
            return Ok(Factored::Definite(factor));
        }
        let largest = matrix.amax();
        let lu = matrix.full_piv_lu();
        if lu.u().diagonal().iter().any(|p| p.abs() <= SINGULAR * largest) {
            return Err(ActiveSetError::Dependent);
        }
        Ok(Factored::General(Box::new(lu)))
    }

    fn solve(&self, b: &DMatrix<f64>) -> Result<DMatrix<f64>, ActiveSetError> {
        match self {
            Factored::Definite(factor) => Ok(factor.solve(b)),
            Factored::General(factor) => factor.solve(b).ok_or(ActiveSetError::Dependent),
        }
    }
}

/// The factorised system, scaled so that its diagonal is one.
pub(super) struct Dense {
    rows: Factored,
    scale: DVector<f64>,
    /// `S⁻¹ G` and `H`, scaled.
    under_springs: DMatrix<f64>,
    on_springs: DMatrix<f64>,
    complement: FullPivLU<f64, Dyn, Dyn>,
}

impl Dense {
    /// Factorises the matrix of `active` rows and, after them, of springs of these stiffnesses.
    ///
    /// # Errors
    /// Rows that depend on each other; where `must_hold`, a motion of the springs that the rows do not resist.
    pub fn new(
        mut matrix: DMatrix<f64>,
        active: usize,
        stiffness: &[f64],
        symmetric: bool,
        must_hold: bool,
    ) -> Result<Self, ActiveSetError> {
        let m = stiffness.len();
        // Compliances of bodies and springs may differ by orders of magnitude: with a diagonal of ones pivots say
        // something.
        let scale = DVector::from_fn(active + m, |k, _| match k.checked_sub(active) {
            None => 1.0 / matrix[(k, k)].abs().sqrt(),
            Some(s) => stiffness[s].sqrt(),
        });
        for r in 0..active + m {
            for c in 0..active + m {
                matrix[(r, c)] *= scale[r] * scale[c];
            }
        }
        let rows = Factored::new(matrix.view((0, 0), (active, active)).into_owned(), symmetric)?;
        let on_springs = matrix.view((active, 0), (m, active)).into_owned();
        let under_springs = rows.solve(&matrix.view((0, active), (active, m)).into_owned())?;
        let complement = matrix.view((active, active), (m, m)) - &on_springs * &under_springs;
        if must_hold && m > 0 {
            let svd = complement.clone().svd(false, true);
            let least = svd.singular_values.argmin();
            if least.1.is_nan() || least.1 <= SINGULAR * svd.singular_values.max().max(1.0) {
                let motion = svd.v_t.map_or(Vec::new(), |v| v.row(least.0).iter().copied().collect());
                return Err(ActiveSetError::Free { motion });
            }
        }
        Ok(Dense { rows, scale, under_springs, on_springs, complement: complement.full_piv_lu() })
    }

    /// Pressures of the active rows and forces at the springs that bring the defects to zero.
    pub fn solve(&self, defects: &[f64]) -> Result<(Vec<f64>, Vec<f64>), ActiveSetError> {
        let rhs = -DVector::from_column_slice(defects).component_mul(&self.scale);
        let active = self.under_springs.nrows();
        let mut pressures = self.rows.solve(&DMatrix::from_column_slice(active, 1, &rhs.as_slice()[..active]))?;
        let lack = DVectorView::from_slice(&rhs.as_slice()[active..], rhs.len() - active);
        let forces = if lack.is_empty() {
            DMatrix::zeros(0, 1)
        } else {
            let lack = lack - &self.on_springs * pressures.column(0);
            self.complement
                .solve(&DMatrix::from_column_slice(lack.len(), 1, lack.as_slice()))
                .ok_or_else(|| ActiveSetError::Free { motion: Vec::new() })?
        };
        pressures -= &self.under_springs * &forces;
        let mut x = pressures.iter().chain(&forces).zip(&self.scale).map(|(x, s)| x * s);
        let pressures = x.by_ref().take(active).collect();
        Ok((pressures, x.collect()))
    }
}
