//! Whether rigid bodies may rest where they are: forces within the cones of friction that balance all loads.
//!
//! The forces are those of the convex set "in balance, and within all cones" with the least sum of squares, where friction
//! counts in shares of its coefficient: the point of the set nearest to the balanced forces of least size, by the alternating
//! projections of Dykstra (Boyle & Dykstra 1986). So they depend neither on names nor on orders where they are not unique.

use super::complementarity::{Block, Kind};
use nalgebra::{DMatrix, DVector};

/// Forces out of balance, and beyond cones, relative to the largest force, with which bodies rest: what Newton's method reaches.
const BALANCED: f64 = 1e-10;
const WITHIN: f64 = 1e-9;
/// Eigenvalues relative to the largest that are rounding.
const RANK: f64 = 1e-12;
const MOST_PROJECTIONS: usize = 4000;
/// Projections after which forces that are still as far apart, to this part, meet nowhere.
const STRIDE: usize = 100;
const APART: f64 = 0.97;

/// The forces of all rows with which what acts is in balance: `rows` are the rows of all blocks in the unknowns, in a metric in
/// which forces and moments count alike, and so is the `load`. None where there are none.
pub fn rest(blocks: &[Block<'_>], rows: &DMatrix<f64>, load: &DVector<f64>) -> Option<DVector<f64>> {
    let m = rows.nrows();
    let most = load.amax();
    if most == 0.0 {
        return Some(DVector::zeros(m));
    }
    if m == 0 {
        return None;
    }
    // Friction in shares of its coefficient: all cones are those of a half right angle.
    let mut share = DVector::from_element(m, 1.0);
    for b in blocks {
        if let Kind::Contact { law: Some(law), .. } = b.kind
            && let Some(mu) = law.per_pressure()
        {
            (1..b.rows).for_each(|k| share[b.first + k] = mu[b.axes[k - 1]]);
        }
    }
    let mut scaled = rows.clone();
    (0..m).for_each(|i| scaled.row_mut(i).scale_mut(share[i]));
    // The pseudo-inverse of `rowsᵀ`, by the eigenvalues of the smaller of both products.
    let balance = Balance::new(&scaled);
    let start = balance.balanced(&DVector::zeros(m), load);
    if (scaled.tr_mul(&start) + load).amax() > BALANCED * most {
        return None;
    }
    let mut r = start;
    let mut correction = DVector::zeros(m);
    let mut apart = f64::INFINITY;
    for k in 0..MOST_PROJECTIONS {
        let before = &r + &correction;
        let within = in_cones(blocks, &before);
        correction = &before - &within;
        let beyond = (&within - &r).amax();
        if beyond <= WITHIN * r.amax() {
            return Some(r.component_mul(&share));
        }
        // Sets that do not meet stay apart.
        if k % STRIDE == STRIDE - 1 {
            if beyond > APART * apart {
                return None;
            }
            apart = beyond;
        }
        r = balance.balanced(&within, load);
    }
    None
}

/// Projection onto the forces in balance.
struct Balance<'a> {
    rows: &'a DMatrix<f64>,
    inverse: DMatrix<f64>,
}

impl<'a> Balance<'a> {
    fn new(rows: &'a DMatrix<f64>) -> Self {
        let gram = rows.tr_mul(rows).symmetric_eigen();
        let largest = gram.eigenvalues.amax();
        let inverse = gram.eigenvalues.map(|v| if v > RANK * largest { 1.0 / v } else { 0.0 });
        let inverse = &gram.eigenvectors * DMatrix::from_diagonal(&inverse) * gram.eigenvectors.transpose();
        Balance { rows, inverse }
    }

    /// The nearest forces in balance; twice, for the digits that the products of rows lose.
    fn balanced(&self, r: &DVector<f64>, load: &DVector<f64>) -> DVector<f64> {
        let mut out = r.clone();
        for _ in 0..2 {
            let lacks = self.rows.tr_mul(&out) + load;
            out -= self.rows * (&self.inverse * lacks);
        }
        out
    }
}

/// The nearest forces within the cones of all contacts.
fn in_cones(blocks: &[Block<'_>], r: &DVector<f64>) -> DVector<f64> {
    let mut out = r.clone();
    for b in blocks {
        let Kind::Contact { law, .. } = b.kind else { continue };
        let normal = r[b.first];
        let Some(law) = law.filter(|_| b.rows > 1) else {
            out[b.first] = normal.max(0.0);
            (1..b.rows).for_each(|k| out[b.first + k] = 0.0);
            continue;
        };
        if law.per_pressure().is_none() {
            let found = b.project([normal, r[b.first + 1], if b.rows > 2 { r[b.first + 2] } else { 0.0 }]);
            (0..b.rows).for_each(|k| out[b.first + k] = found.force[k]);
            continue;
        }
        let across = (1..b.rows).map(|k| r[b.first + k].powi(2)).sum::<f64>().sqrt();
        let has_friction = law.per_pressure().is_some_and(|mu| (1..b.rows).any(|k| mu[b.axes[k - 1]] > 0.0));
        let (new, factor) = if !has_friction {
            (normal.max(0.0), 0.0)
        } else if across <= normal {
            (normal, 1.0)
        } else if across <= -normal {
            (0.0, 0.0)
        } else {
            let middle = 0.5 * (normal + across);
            (middle, middle / across)
        };
        out[b.first] = new;
        (1..b.rows).for_each(|k| out[b.first + k] *= factor);
    }
    out
}
