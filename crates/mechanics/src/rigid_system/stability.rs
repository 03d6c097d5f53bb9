//! Whether rigid bodies in equilibrium would leave it: the second variation of the energy on the motions that contacts leave.

use super::motion::{Loaded, Motion, Stepped};
use crate::body::BodyState;
use crate::system::AssemblyError;
use nalgebra::{DMatrix, DVector};

/// Stiffness, relative to a load per size, below which a motion is neutral.
const NEUTRAL: f64 = 1e-7;
/// Eigenvalues relative to the largest that are rounding.
const RANK: f64 = 1e-10;
/// Force relative to the largest from which a point carries.
const CARRIES: f64 = 1e-9;

/// A motion in which an equilibrium is left.
pub struct Leaving {
    /// Number of independent ones.
    pub negative: usize,
    /// By unknowns, of largest part one in sizes.
    pub direction: Vec<f64>,
}

impl Motion<'_> {
    /// The motion in which the bodies leave an equilibrium; none where it is stable or neutral. Points that carry neither open
    /// nor, with friction, slip.
    ///
    /// # Errors
    /// Loads and supports that cannot act.
    pub fn unstable(
        &self,
        bodies: &[BodyState],
        found: &Stepped<'_>,
        time: f64,
    ) -> Result<Option<Leaving>, AssemblyError> {
        let n = self.turns.len();
        let most = found.loaded.iter().map(|l| l.force[0]).fold(0.0f64, f64::max);
        if most == 0.0 {
            return Ok(None);
        }
        let (carrying, light): (Vec<_>, Vec<_>) = found.loaded.iter().partition(|l| l.force[0] > CARRIES * most);
        let mut stiffness = self.loads(bodies, time)?.stiffness;
        for l in &carrying {
            l.point.add_to(&mut stiffness, &self.geometric(&l.point, &l.force));
        }
        let points = |list: &[&Loaded<'_>]| -> DMatrix<f64> {
            self.rows(&list.iter().map(|l| &l.point).collect::<Vec<_>>(), &[]).1
        };
        let (single, coupled) = self.system.held(bodies, time)?;
        let supports = single.iter().chain(&coupled).map(|held| {
            let mut out = DVector::zeros(n);
            held.constraint.terms.iter().for_each(|(u, f)| out[*u as usize] += f);
            out
        });
        // In units in which the sizes are one.
        let unit = DVector::from_iterator(n, (0..n).map(|k| if self.turns[k] { 1.0 } else { self.size }));
        let mut gram = DMatrix::<f64>::zeros(n, n);
        let of_points = points(&carrying);
        for row in of_points.row_iter().map(|row| row.transpose()).chain(supports) {
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
        let falls = |value: &f64| *value < -NEUTRAL * self.load * self.size;
        let negative = modes.eigenvalues.iter().filter(|v| falls(v)).count();
        if negative == 0 {
            return Ok(None);
        }
        let mode = &basis * modes.eigenvectors.column(modes.eigenvalues.imin());
        let mode = mode.component_mul(&unit);
        let largest = (0..n).map(|k| self.relative(k, mode[k])).fold(0.0f64, f64::max);
        let mode = mode / largest;
        // Both ways lead down: the one that closes no gap, and of two the one on the side of a fixed direction.
        let opening = |d: &DVector<f64>, l: &Loaded<'_>| -> f64 {
            l.point.pair.unknowns.iter().zip(&l.point.pair.opening).map(|(u, o)| d[*u as usize] * o).sum()
        };
        let opens = |d: &DVector<f64>| light.iter().all(|l| opening(d, l) >= -RANK * self.size);
        let first = if self.side(bodies, &mode) < 0.0 { -mode } else { mode };
        let second = -&first;
        let direction = [first, second].into_iter().find(opens).map(|d| d.as_slice().to_vec());
        Ok(direction.map(|direction| Leaving { negative, direction }))
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
