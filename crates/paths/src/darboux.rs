//! The frame of Darboux of a curve on a surface.
//!
//! `τ` along the curve, `n` outward, `g = τ × n`; `τ' = k_g g + k_n n`, `g' = -k_g τ + τ_g n`, `n' = -k_n τ - τ_g g`. With
//! `S = ∇∇f/|∇f|` on the tangent plane of a level function `f`: `k_n = -τ·Sτ`, `τ_g = -g·Sτ`, and across the curve
//! `k_b = -g·Sg`; Gaussian curvature `K = k_n k_b - τ_g²`. `k_n < 0` where a rope presses on a convex body. (Konyukhov &
//! Schweizerhof, Computational Contact Mechanics, 2013, ch. 11.)

use crate::PathError;
use crate::curve::Curve;
use signorini_geometry::rigid_shape::RigidShape;
use signorini_geometry::{Jet, Point, Vector};

/// The surface along a direction: all that does not depend on how the curve bends within it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Along {
    /// Unit normal, outward.
    pub n: Vector<3>,
    /// `τ × n`.
    pub g: Vector<3>,
    /// Normal curvature along the direction.
    pub k_n: f64,
    /// Normal curvature across it.
    pub k_b: f64,
    /// Geodesic torsion.
    pub tau_g: f64,
}

impl Along {
    /// From a level function and a unit tangent.
    #[inline]
    pub fn new(level: &Jet<3>, tau: &Vector<3>) -> Self {
        let inverse = 1.0 / level.gradient.norm();
        let n = level.gradient * inverse;
        let g = tau.cross(&n);
        let bent = level.hessian * tau * inverse;
        let k_b = -g.dot(&(level.hessian * g)) * inverse;
        Along { n, g, k_n: -tau.dot(&bent), k_b, tau_g: -g.dot(&bent) }
    }

    /// Gaussian curvature of the surface.
    pub fn gaussian_curvature(&self) -> f64 {
        self.k_n * self.k_b - self.tau_g * self.tau_g
    }
}

/// A point of a curve on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Darboux {
    /// Arc length from the start of the curve.
    pub s: f64,
    pub x: Point<3>,
    /// Unit tangent.
    pub tau: Vector<3>,
    /// `τ × n`.
    pub g: Vector<3>,
    /// Unit normal of the surface, outward.
    pub n: Vector<3>,
    /// Normal curvature; negative where the rope is pressed on.
    pub k_n: f64,
    /// Geodesic curvature.
    pub k_g: f64,
    /// Geodesic torsion.
    pub tau_g: f64,
    /// Distance of the curve from the surface, outside positive, to second order.
    pub gap: f64,
}

impl Darboux {
    /// `k_g/k_n`: the tangent of the angle between the force that holds the rope and the normal.
    pub fn tan_alpha(&self) -> f64 {
        self.k_g / self.k_n
    }

    pub(crate) fn from_parts(s: f64, x: Point<3>, tau: Vector<3>, along: &Along, k_g: f64, gap: f64) -> Self {
        let Along { n, g, k_n, tau_g, .. } = *along;
        Darboux { s, x, tau, g, n, k_n, k_g, tau_g, gap }
    }
}

/// The frame of a curve at a parameter, and `ds/dt` there. A curve that is not quite on the surface is measured along the
/// level surface through it. `s` is left at zero: see [`darboux`].
///
/// # Errors
/// A tangent that vanishes or is along the normal.
pub fn darboux_at(surface: &dyn RigidShape, curve: &dyn Curve, t: f64) -> Result<(Darboux, f64), PathError> {
    let jet = curve.jet(t);
    let level = surface.level(&jet.x);
    let n = level.gradient.normalize();
    let speed = jet.d1.norm();
    let flat = jet.d1 - n * n.dot(&jet.d1);
    let tau = flat.try_normalize(1e-12 * speed).ok_or(PathError::NoTangent { at: jet.x })?;
    let along = Along::new(&level, &tau);
    let k_g = jet.d2.dot(&along.g) / flat.norm_squared();
    let gap = level.value / level.gradient.norm();
    Ok((Darboux::from_parts(0.0, jet.x, tau, &along, k_g, gap), speed))
}

/// The frames at parameters that increase, with their arc lengths from the first one by adaptive quadrature.
///
/// # Errors
/// A tangent that vanishes or is along the normal; parameters that do not increase.
pub fn darboux(surface: &dyn RigidShape, curve: &dyn Curve, parameters: &[f64]) -> Result<Vec<Darboux>, PathError> {
    let mut out = Vec::with_capacity(parameters.len());
    let mut s = 0.0;
    for (k, &t) in parameters.iter().enumerate() {
        if k > 0 {
            if t <= parameters[k - 1] || t.is_nan() {
                return Err(PathError::Input { what: "a parameter", value: t, valid: "more than the one before" });
            }
            s += crate::quadrature::arc_length(curve, parameters[k - 1], t);
        }
        let (mut frame, _) = darboux_at(surface, curve, t)?;
        frame.s = s;
        out.push(frame);
    }
    Ok(out)
}

/// The frames of a curve that is known by points in order, where the outward normal of the surface is known too: tangent and
/// curvature of the circle through three of them. The curve may bend about a section: it lies on the surface at that
/// distance. First and last point take the circle of their neighbours.
pub fn of_points(points: &[Point<3>], normals: &[Option<Vector<3>>]) -> Vec<Option<Darboux>> {
    if points.len() < 3 {
        return vec![None; points.len()];
    }
    let last = points.len() - 1;
    let mut s = vec![0.0; points.len()];
    (1..=last).for_each(|k| s[k] = s[k - 1] + (points[k] - points[k - 1]).norm());
    let at = |k: usize| {
        let n = normals.get(k).copied().flatten()?;
        let m = k.clamp(1, last - 1);
        let (before, after) = (points[m] - points[m - 1], points[m + 1] - points[m]);
        let (a, b) = (before.norm(), after.norm());
        let curvature = (after / b - before / a) * (2.0 / (a + b));
        let chord = before / a * b + after / b * a;
        let tau = (chord - n * n.dot(&chord)).try_normalize(1e-12 * (a + b))?;
        let g = tau.cross(&n);
        let [n0, n1] = [m - 1, m + 1].map(|j| normals[j]);
        let tau_g = match (n0, n1) {
            (Some(n0), Some(n1)) => -(n1 - n0).dot(&g) / (a + b),
            _ => 0.0,
        };
        let (k_n, k_g) = (curvature.dot(&n), curvature.dot(&g));
        Some(Darboux { s: s[k], x: points[k], tau, g, n, k_n, k_g, tau_g, gap: 0.0 })
    };
    (0..=last).map(at).collect()
}
