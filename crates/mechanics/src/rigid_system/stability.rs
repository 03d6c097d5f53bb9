//! Whether rigid bodies in equilibrium would leave it: the second variation of the energy on the motions that contacts leave.

use super::motion::{Motion, Stepped};
use crate::body::BodyState;
use crate::system::AssemblyError;
use nalgebra::{DMatrix, DVector};

/// Stiffness, relative to a load per size, below which a motion is neutral.
const NEUTRAL: f64 = 1e-7;
/// Eigenvalues relative to the largest that are rounding.
const RANK: f64 = 1e-10;

impl Motion<'_> {
    /// The motion, of largest part one in sizes, in which the bodies leave an equilibrium; none where it is stable or neutral.
    /// Points that carry neither open nor, with friction, slip.
    ///
    /// # Errors
    /// Loads and supports that cannot act.
    pub fn unstable(
        &self,
        bodies: &[BodyState],
        found: &Stepped<'_>,
        time: f64,
    ) -> Result<Option<Vec<f64>>, AssemblyError> {
        let n = self.turns.len();
        let most = found.loaded.iter().map(|l| l.force[0]).fold(0.0f64, f64::max);
        if most == 0.0 {
            return Ok(None);
        }
        let carries = |force: f64| force > 1e-9 * most;
        let mut stiffness = self.loads(bodies, time)?.stiffness;
        let mut rows: Vec<DVector<f64>> = Vec::new();
        let mut light: Vec<DVector<f64>> = Vec::new();
        for l in &found.loaded {
            let unknowns = &l.point.pair.unknowns;
            let row = |values: &dyn Fn(usize) -> f64| {
                let mut out = DVector::zeros(n);
                unknowns.iter().enumerate().for_each(|(a, u)| out[*u as usize] += values(a));
                out
            };
            let opening = row(&|a| l.point.pair.opening[a]);
            if !carries(l.force[0]) {
                light.push(opening);
                continue;
            }
            rows.push(opening);
            let axes = l.point.slip_axes();
            (1..l.point.rows()).for_each(|k| rows.push(row(&|a| l.point.axes[axes[k - 1]].dot(&l.point.pair.slip[a]))));
            let own = self.geometric(&l.point, &l.force);
            for (i, u) in unknowns.iter().enumerate() {
                for (j, v) in unknowns.iter().enumerate() {
                    stiffness[(*u as usize, *v as usize)] += own[(i, j)];
                }
            }
        }
        let (single, coupled) = self.held(bodies, time)?;
        for held in single.iter().chain(&coupled) {
            let mut out = DVector::zeros(n);
            held.constraint.terms.iter().for_each(|(u, f)| out[*u as usize] += f);
            rows.push(out);
        }
        // In units in which the sizes are one.
        let unit = DVector::from_iterator(n, (0..n).map(|k| if self.turns[k] { 1.0 } else { self.size }));
        let mut gram = DMatrix::<f64>::zeros(n, n);
        for row in &rows {
            let row = row.component_mul(&unit);
            let square = row.norm_squared();
            if square > 0.0 {
                gram.ger(1.0 / square, &row, &row, 1.0);
            }
        }
        let eigen = gram.symmetric_eigen();
        let free: Vec<usize> = (0..n).filter(|k| eigen.eigenvalues[*k] <= RANK * eigen.eigenvalues.amax()).collect();
        if free.is_empty() {
            return Ok(None);
        }
        let basis = eigen.eigenvectors.select_columns(&free);
        let scaled = DMatrix::from_fn(n, n, |i, j| stiffness[(i, j)] * unit[i] * unit[j]);
        let modes = (basis.transpose() * scaled * &basis).symmetric_eigen();
        let least = modes.eigenvalues.imin();
        if modes.eigenvalues[least] >= -NEUTRAL * self.load * self.size {
            return Ok(None);
        }
        let mode = &basis * modes.eigenvectors.column(least);
        let mode = mode.component_mul(&unit);
        let largest = (0..n).map(|k| self.relative(k, mode[k])).fold(0.0f64, f64::max);
        let mode = mode / largest;
        // Both ways lead down: the one that closes no gap, and of two the one on the side of a fixed direction.
        let opens = |d: &DVector<f64>| light.iter().all(|row| row.dot(d) >= -RANK * self.size);
        let side: f64 = self.side(bodies, &mode);
        let first = if side < 0.0 { -mode } else { mode };
        let second = -&first;
        Ok([first, second].into_iter().find(opens).map(|d| d.as_slice().to_vec()))
    }

    /// Which way a motion goes: its largest displacement along a direction that no problem prefers.
    fn side(&self, bodies: &[BodyState], mode: &DVector<f64>) -> f64 {
        let mut most = (0.0f64, 0.0);
        for (k, body) in self.system.bodies.iter().enumerate().filter(|(_, b)| b.unknowns() > 0) {
            let first = self.first[k] as usize;
            let modes = body.rigid_modes(&bodies[k]);
            for (component, weight) in [1.0, 0.618, 0.382].iter().enumerate() {
                for turning in [false, true] {
                    let axis = &modes[component + if turning { 3 } else { 0 }];
                    let kept = |i: &usize| self.turns[first + i] == turning;
                    let value: f64 = (0..axis.len()).filter(kept).map(|i| axis[i] * mode[first + i]).sum();
                    let size = if turning { value.abs() * self.size } else { value.abs() } * weight;
                    if size > most.0 * (1.0 + 1e-6) {
                        most = (size, value);
                    }
                }
            }
        }
        most.1
    }
}
