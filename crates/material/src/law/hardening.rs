//! Yield stress by the equivalent plastic strain.

use std::sync::Arc;

/// A polygon of yield stress over equivalent plastic strain, from 0 on; beyond its last point it goes on with a slope.
#[derive(Clone, Debug, PartialEq)]
pub struct Hardening {
    points: Arc<[[f64; 2]]>,
    slope: f64,
}

/// A curve of hardening that is none.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum HardeningError {
    #[error("the first yield stress is {stress}: it must be positive")]
    NotPositive { stress: f64 },
    #[error("the first plastic strain is {strain}: it must be 0")]
    Start { strain: f64 },
    #[error("the plastic strain {strain} of row {row} is not larger than the one before")]
    Strain { row: usize, strain: f64 },
    #[error(
        "the yield stress {stress} of row {row} is smaller than the one before: softening has no solution that a mesh can find"
    )]
    Softening { row: usize, stress: f64 },
    #[error("the modulus {slope} is negative: softening has no solution that a mesh can find")]
    Slope { slope: f64 },
}

impl Hardening {
    /// A polygon through `[stress, plastic strain]`, and the slope after it.
    ///
    /// # Errors
    /// Rows are counted from 1: strains that do not grow, stresses that fall, a first row without yield.
    pub fn new(points: &[[f64; 2]], slope: f64) -> Result<Self, HardeningError> {
        let [stress, strain] = points.first().copied().unwrap_or([f64::NAN, 0.0]);
        if stress.is_nan() || stress <= 0.0 {
            return Err(HardeningError::NotPositive { stress });
        }
        if strain != 0.0 {
            return Err(HardeningError::Start { strain });
        }
        for (k, pair) in points.windows(2).enumerate() {
            let ([before, at], [stress, strain]) = (pair[0], pair[1]);
            if strain.is_nan() || strain <= at {
                return Err(HardeningError::Strain { row: k + 2, strain });
            }
            if stress.is_nan() || stress < before {
                return Err(HardeningError::Softening { row: k + 2, stress });
            }
        }
        if slope.is_nan() || slope < 0.0 {
            return Err(HardeningError::Slope { slope });
        }
        Ok(Hardening { points: points.into(), slope })
    }

    /// The pieces: where each starts, the stress there, its slope, and where it ends.
    fn pieces(&self) -> impl Iterator<Item = [f64; 4]> + '_ {
        (0..self.points.len()).map(|k| {
            let [stress, from] = self.points[k];
            match self.points.get(k + 1) {
                Some([next, to]) => [from, stress, (next - stress) / (to - from), *to],
                None => [from, stress, self.slope, f64::INFINITY],
            }
        })
    }

    /// The yield stress at a plastic strain.
    pub fn stress(&self, strain: f64) -> f64 {
        self.at(strain).0
    }

    /// The yield stress at a plastic strain, and its slope from there on.
    pub fn at(&self, strain: f64) -> (f64, f64) {
        let piece = self.pieces().find(|[_, _, _, to]| strain < *to);
        piece.map_or((f64::NAN, f64::NAN), |[from, stress, slope, _]| (stress + slope * (strain - from), slope))
    }

    /// The increment `Δ` of plastic strain with `trial - stiffness Δ = stress(strain + Δ)`, for a trial above the yield stress,
    /// and the slope of the yield stress there: exact, piece by piece.
    pub fn increment(&self, trial: f64, stiffness: f64, strain: f64) -> [f64; 2] {
        for [from, stress, slope, to] in self.pieces().filter(|piece| strain < piece[3]) {
            let here = stress + slope * (strain - from);
            let increment = (trial - here) / (stiffness + slope);
            if strain + increment <= to {
                return [increment, slope];
            }
        }
        [f64::NAN; 2]
    }

    /// `∫ stress` over the plastic strain: what is dissipated per volume.
    pub fn dissipated(&self, from: f64, to: f64) -> f64 {
        self.pieces()
            .map(|[start, _, _, end]| (from.max(start), to.min(end)))
            .filter(|(a, b)| b > a)
            .map(|(a, b)| 0.5 * (self.stress(a) + self.stress(b)) * (b - a))
            .sum()
    }
}
