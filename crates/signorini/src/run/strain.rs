//! Where the theory of small strains ends.

use crate::fields::Fields;
use crate::problem::{Body, Problem};
use crate::report::{Warning, WarningKind};
use nalgebra::Matrix3;
use signorini_geometry::Vector;

/// Strain from which the theory of small strains is off by more than a few per cent of the result: the terms left out are
/// half the square of the displacement gradient, and rotations come with strains.
pub const LARGE: f64 = 0.05;

/// Directions in which a cell is thinner than this part of its size tell nothing of a gradient.
const FLAT: f64 = 1e-3;

/// The largest strain of a body, and where.
#[derive(Clone, Copy, Debug)]
pub struct Strained {
    pub strain: f64,
    pub at: [f64; 3],
}

impl Strained {
    /// The warning that a strain is not small; none where it is.
    pub fn warning(&self, body: &str, time: f64, dimension: usize) -> Option<Warning> {
        if self.strain < LARGE {
            return None;
        }
        let x: Vec<String> = self.at[..dimension].iter().map(|v| format!("{v:.4}")).collect();
        let message = format!(
            "the strain is not small: {:.0} % at ({}) of `{body}` at t = {time}; small strains are assumed, and the \
             error is of that size from {:.0} % on",
            100.0 * self.strain,
            x.join(", "),
            100.0 * LARGE,
        );
        Some(Warning::new(WarningKind::LargeStrain, message).at_time(time).at(self.at))
    }
}

/// Whether a body is one of small strains.
pub fn is_small(problem: &Problem, body: &str) -> bool {
    match problem.bodies.get(body) {
        Some(Body::Solid(solid)) => solid.strain.as_deref() != Some("finite"),
        Some(Body::Cells(cells)) => cells.strain.as_deref() != Some("finite"),
        _ => false,
    }
}

/// The largest principal strain, by its absolute value, of the cells of a body as it is shown, from the gradient of the
/// linear displacement nearest to that of the points of each cell; none of a body without cells.
pub fn largest(fields: &Fields) -> Option<Strained> {
    let displacement = fields.array("displacement")?;
    let mut most: Option<Strained> = None;
    for (_, nodes) in &fields.cells {
        let x = |k: &u32| Vector::<3>::from(fields.points[*k as usize]);
        let u = |k: &u32| Vector::<3>::from_column_slice(&displacement[3 * *k as usize..3 * *k as usize + 3]);
        let count = nodes.len().max(1) as f64;
        let centre = nodes.iter().map(x).sum::<Vector<3>>() / count;
        let mean = nodes.iter().map(u).sum::<Vector<3>>() / count;
        let (mut extent, mut moved) = (Matrix3::zeros(), Matrix3::zeros());
        for k in nodes {
            let d = x(k) - centre;
            extent += d * d.transpose();
            moved += (u(k) - mean) * d.transpose();
        }
        let thin = FLAT * FLAT * extent.symmetric_eigenvalues().amax();
        let Ok(inverse) = extent.pseudo_inverse(thin.max(f64::MIN_POSITIVE)) else { continue };
        let gradient: Matrix3<f64> = moved * inverse;
        let strain = (0.5 * (gradient + gradient.transpose())).symmetric_eigenvalues().amax();
        if strain.is_finite() && most.is_none_or(|m| strain > m.strain) {
            most = Some(Strained { strain, at: centre.into() });
        }
    }
    most
}
