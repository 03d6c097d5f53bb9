//! What friction allows on a shortest path.
//!
//! Along a geodesic `k_g = 0`: the tension may change by `∫μ_τ |k_n| ds` of its logarithm. Sideways a taut rope may run on
//! curves with `|λ| = |k_g/k_n| <= μ_g`. To first order in `μ_g` these leave a contact with a drift `δ` and a rotation `δ'`
//! across the geodesic, `(δ, δ')(ℓ) = ∫λ|k_n| (r, ∂_ℓ r)(ℓ; s) ds`: the convex set with the support function
//! `h(p) = μ_g ∫|k_n| |p·(r, r')(ℓ; s)| ds`, `r(ℓ; s) = a(s) r(ℓ) - r(s) a(ℓ)`.

use super::path::{Contact, WrappedPath};
use super::route::Body;
use crate::PathError;
use crate::darboux::Along;
use crate::friction::Friction;
use crate::geodesic::{GeodesicState, geodesic};
use signorini_geometry::rigid_shape::RigidShape;

/// Gauss points per step of a geodesic: the steps are of order eight.
const GAUSS: [(f64, f64); 5] = [
    (0.046_910_077_030_668, 0.118_463_442_528_094_54),
    (0.230_765_344_947_158_45, 0.239_314_335_249_683_23),
    (0.5, 0.284_444_444_444_444_44),
    (0.769_234_655_052_841_5, 0.239_314_335_249_683_23),
    (0.953_089_922_969_332, 0.118_463_442_528_094_54),
];

/// What friction allows along a path.
#[derive(Clone, Debug, PartialEq)]
pub struct PathTensions {
    /// The limits of `ln(T_1/T_0)` from the start to the end of the path.
    pub log_ratio: [f64; 2],
    /// Of each contact: the limits of its own, and the range sideways where the axes of friction go along with the rope.
    pub contacts: Vec<([f64; 2], Option<Sideways>)>,
}

impl PathTensions {
    /// The tensions at the end that friction holds against one at the start.
    pub fn end_tensions(&self, start: f64) -> [f64; 2] {
        self.log_ratio.map(|l| start * l.exp())
    }

    /// The share of friction along the path that two end tensions use; above one the rope slips.
    pub fn utilisation(&self, start: f64, end: f64) -> f64 {
        let log = (end / start).ln();
        let limit = self.log_ratio[usize::from(log >= 0.0)];
        if log == 0.0 { 0.0 } else { log / limit }
    }
}

/// How far friction holds a rope beside its shortest path where it leaves a body.
#[derive(Clone, Debug, PartialEq)]
pub struct Sideways {
    /// The largest drift across the path at the exit.
    pub drift: f64,
    /// The largest rotation of the path there, in radians.
    pub rotation: f64,
    /// Moments `|k_n| ds` with `(r, r')(ℓ; s)` at the places of the quadrature, times `μ_g`.
    moments: Vec<(f64, [f64; 2])>,
}

impl Sideways {
    /// `max p·(δ, δ')` over all that friction holds.
    pub fn support(&self, p: [f64; 2]) -> f64 {
        self.moments.iter().map(|(w, r)| w * (p[0] * r[0] + p[1] * r[1]).abs()).sum()
    }

    /// The drift and the rotation that `p` is most in favour of: a corner of the set.
    pub fn corner(&self, p: [f64; 2]) -> [f64; 2] {
        let mut sum = [0.0; 2];
        for (w, r) in &self.moments {
            let sign = (p[0] * r[0] + p[1] * r[1]).signum();
            sum[0] += w * sign * r[0];
            sum[1] += w * sign * r[1];
        }
        sum
    }
}

impl WrappedPath {
    /// What friction allows on this path.
    ///
    /// # Errors
    /// Coefficients out of range.
    pub fn tensions(&self, bodies: &[Body<'_>], friction: &Friction) -> Result<PathTensions, PathError> {
        friction.check()?;
        let contacts = self.contacts.iter().map(|c| contact(c, bodies, friction)).collect::<Result<Vec<_>, _>>()?;
        let log_ratio = [0, 1].map(|side| contacts.iter().map(|c| c.0[side]).sum());
        Ok(PathTensions { log_ratio, contacts })
    }
}

fn contact(
    contact: &Contact,
    bodies: &[Body<'_>],
    friction: &Friction,
) -> Result<([f64; 2], Option<Sideways>), PathError> {
    let shape = bodies[contact.body].shape;
    let way = geodesic(shape, &contact.x, &contact.tau, contact.length)?;
    let mut log_ratio = [0.0; 2];
    let mut moments = Vec::new();
    let end = *way.end();
    let across = match friction {
        Friction::Carried { across, .. } => Some(*across),
        Friction::Attached { .. } => None,
    };
    for (state, weight) in gauss_points(shape, &way.states)? {
        let level = shape.level(&state.x);
        let along = Along::new(&level, &state.tau);
        let frame = crate::darboux::Darboux::from_parts(state.s, state.x, state.tau, &along, 0.0, 0.0);
        let [low, high] = friction.range(&frame, along.k_n.min(0.0), 0.0).unwrap_or_default();
        log_ratio[0] += weight * low;
        log_ratio[1] += weight * high;
        if let Some(across) = across {
            let field = |at: usize| state.a[0] * end.r[at] - state.r[0] * end.a[at];
            moments.push((across * along.k_n.abs() * weight, [field(0), field(1)]));
        }
    }
    let sideways = across.map(|_| {
        let mut s = Sideways { drift: 0.0, rotation: 0.0, moments };
        (s.drift, s.rotation) = (s.support([1.0, 0.0]), s.support([0.0, 1.0]));
        s
    });
    Ok((log_ratio, sideways))
}

/// States at the Gauss points of the steps of a geodesic, with their weights.
fn gauss_points(shape: &dyn RigidShape, states: &[GeodesicState]) -> Result<Vec<(GeodesicState, f64)>, PathError> {
    let mut out = Vec::with_capacity(GAUSS.len() * states.len());
    for w in states.windows(2) {
        let step = w[1].s - w[0].s;
        for (place, weight) in GAUSS {
            let way = geodesic(shape, &w[0].x, &w[0].tau, place * step)?;
            let there = way.end();
            // The Jacobi fields from the start go on as combinations of those from the step.
            let field = |f: [f64; 2]| [0, 1].map(|i| f[0] * there.a[i] + f[1] * there.r[i]);
            let s = w[0].s + place * step;
            let state = GeodesicState { s, x: there.x, tau: there.tau, a: field(w[0].a), r: field(w[0].r) };
            out.push((state, weight * step));
        }
    }
    Ok(out)
}
