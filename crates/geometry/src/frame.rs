//! Local geometry of curves and surfaces: metric, curvature, connection, frames.
//!
//! Notation: `r_i` base vectors, `a_ij = r_i·r_j` metric, `n` unit normal, `h_ij = r_ij·n` curvature tensor,
//! `h^i_j = a^ik h_kj` shape operator, `Γ^k_ij = a^kl r_ij·r_l`. A sphere with outward normal has `h_ij = -a_ij / R`.

use crate::shape::{CurveJet, SurfaceJet};
use crate::{Matrix, Vector};

/// The geometry of a surface at a regular point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceFrame {
    pub base: [Vector<3>; 2],
    pub normal: Vector<3>,
    /// `a_ij`.
    pub metric: Matrix<2>,
    /// `a^ij`.
    pub inverse_metric: Matrix<2>,
    /// `h_ij`.
    pub curvature: Matrix<2>,
    /// `Γ^k_ij` as `christoffel[k][(i, j)]`.
    pub christoffel: [Matrix<2>; 2],
}

impl SurfaceFrame {
    /// `None` where the parametrisation is degenerate.
    pub fn new(jet: &SurfaceJet) -> Option<Self> {
        let base = [jet.u, jet.v];
        let cross = jet.u.cross(&jet.v);
        let normal = cross.try_normalize(1e-12 * jet.u.norm() * jet.v.norm())?;
        let second = [[jet.uu, jet.uv], [jet.uv, jet.vv]];
        let metric = Matrix::<2>::from_fn(|i, j| base[i].dot(&base[j]));
        let inverse_metric = metric.try_inverse()?;
        let curvature = Matrix::<2>::from_fn(|i, j| second[i][j].dot(&normal));
        let along = |l: usize| Matrix::<2>::from_fn(|i, j| second[i][j].dot(&base[l]));
        let lower = [along(0), along(1)];
        let christoffel = [0, 1].map(|k| lower[0] * inverse_metric[(k, 0)] + lower[1] * inverse_metric[(k, 1)]);
        Some(SurfaceFrame { base, normal, metric, inverse_metric, curvature, christoffel })
    }

    /// `h^i_j`.
    pub fn shape_operator(&self) -> Matrix<2> {
        self.inverse_metric * self.curvature
    }

    /// Half the sum of the principal curvatures.
    pub fn mean_curvature(&self) -> f64 {
        0.5 * self.shape_operator().trace()
    }

    /// The product of the principal curvatures.
    pub fn gaussian_curvature(&self) -> f64 {
        self.curvature.determinant() / self.metric.determinant()
    }

    /// Principal curvatures, the smaller first, each with its unit direction in space.
    pub fn principal_curvatures(&self) -> [(f64, Vector<3>); 2] {
        // In an orthonormal tangent basis the shape operator is symmetric.
        let first = self.base[0].normalize();
        let second = self.normal.cross(&first);
        let dual = |e: &Vector<3>| {
            let lower = nalgebra::Vector2::new(e.dot(&self.base[0]), e.dot(&self.base[1]));
            self.inverse_metric * lower
        };
        let (p, q) = (dual(&first), dual(&second));
        let (a, b, c) = (p.dot(&(self.curvature * p)), p.dot(&(self.curvature * q)), q.dot(&(self.curvature * q)));
        let (mean, half) = (0.5 * (a + c), 0.5 * (a - c));
        let radius = half.hypot(b);
        // The angle of the larger curvature; at an umbilic any direction will do.
        let angle = 0.5 * b.atan2(half);
        let larger = first * angle.cos() + second * angle.sin();
        let smaller = self.normal.cross(&larger);
        [(mean - radius, smaller), (mean + radius, larger)]
    }

    /// The signed distances along the normal between which a point above here projects back here: the open interval
    /// that contains zero and no principal radius of curvature (see the module [`crate::closest`]).
    pub fn projection_interval(&self) -> [f64; 2] {
        let mut interval = [f64::NEG_INFINITY, f64::INFINITY];
        for (curvature, _) in self.principal_curvatures() {
            if curvature > 0.0 {
                interval[1] = interval[1].min(1.0 / curvature);
            } else if curvature < 0.0 {
                interval[0] = interval[0].max(1.0 / curvature);
            }
        }
        interval
    }
}

/// The frame of a curve: unit tangent, principal normal and binormal, with curvature and torsion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveFrame {
    pub tangent: Vector<3>,
    pub normal: Vector<3>,
    pub binormal: Vector<3>,
    pub curvature: f64,
    /// Zero where the curvature vanishes and torsion is not defined.
    pub torsion: f64,
    /// Length of the first derivative.
    pub speed: f64,
}

impl CurveFrame {
    /// Serret-Frenet frame; `None` where the curve has no tangent or no curvature.
    pub fn frenet(jet: &CurveJet) -> Option<Self> {
        let speed = jet.d1.norm();
        let tangent = jet.d1.try_normalize(0.0)?;
        let cross = jet.d1.cross(&jet.d2);
        let curvature = cross.norm() / speed.powi(3);
        let binormal = cross.try_normalize(1e-12 * speed * jet.d2.norm())?;
        let torsion = cross.dot(&jet.d3) / cross.norm_squared();
        Some(CurveFrame { tangent, normal: binormal.cross(&tangent), binormal, curvature, torsion, speed })
    }

    /// The Frenet frame where there is one, else the frame turned least from `previous`; with neither, the normal
    /// farthest from the coordinate axes' smallest component. `None` only where the curve has no tangent.
    pub fn robust(jet: &CurveJet, previous: Option<&CurveFrame>) -> Option<Self> {
        if let Some(frame) = Self::frenet(jet) {
            return Some(frame);
        }
        let speed = jet.d1.norm();
        let tangent = jet.d1.try_normalize(0.0)?;
        let reference = previous.map_or_else(|| Vector::<3>::ith(tangent.iamin(), 1.0), |f| f.normal);
        let normal = (reference - tangent * reference.dot(&tangent))
            .try_normalize(1e-8)
            .unwrap_or_else(|| tangent.cross(&Vector::<3>::ith(tangent.iamin(), 1.0)).normalize());
        let curvature = jet.d1.cross(&jet.d2).norm() / speed.powi(3);
        Some(CurveFrame { tangent, normal, binormal: tangent.cross(&normal), curvature, torsion: 0.0, speed })
    }

    /// Carries the frame to another point of the curve with the least turning about the tangent: two reflections (Wang
    /// et al. 2008, fourth order in the step). Curvature and torsion are those of the new point.
    pub fn transported(&self, from: &CurveJet, to: &CurveJet) -> Option<Self> {
        let speed = to.d1.norm();
        let tangent = to.d1.try_normalize(0.0)?;
        let reflect = |v: &Vector<3>, along: &Vector<3>| {
            let squared = along.norm_squared();
            if squared > 0.0 { v - along * (2.0 * along.dot(v) / squared) } else { *v }
        };
        let chord = to.x - from.x;
        let (normal, turned) = (reflect(&self.normal, &chord), reflect(&self.tangent, &chord));
        let normal = reflect(&normal, &(tangent - turned));
        let normal = (normal - tangent * normal.dot(&tangent)).try_normalize(0.0)?;
        let cross = to.d1.cross(&to.d2);
        let curvature = cross.norm() / speed.powi(3);
        let torsion = if curvature > 0.0 { cross.dot(&to.d3) / cross.norm_squared() } else { 0.0 };
        Some(CurveFrame { tangent, normal, binormal: tangent.cross(&normal), curvature, torsion, speed })
    }
}

/// The Darboux frame `(tau, g = tau × n, n)` of a curve on a surface, left-handed as in rope mechanics:
/// `tau' = k_g g + k_n n`, `g' = -k_g tau + tau_g n`, `n' = -k_n tau - tau_g g`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DarbouxFrame {
    pub tangent: Vector<3>,
    pub side: Vector<3>,
    pub normal: Vector<3>,
    pub normal_curvature: f64,
    pub geodesic_curvature: f64,
    pub geodesic_torsion: f64,
}

impl DarbouxFrame {
    /// The frame of the curve with parameter velocity `(u', v')` and acceleration `(u'', v'')` on a surface; `None`
    /// where the surface is degenerate or the curve stands still.
    pub fn new(surface: &SurfaceFrame, velocity: [f64; 2], acceleration: [f64; 2]) -> Option<Self> {
        let v = nalgebra::Vector2::from(velocity);
        let speed_squared = v.dot(&(surface.metric * v));
        let d1 = surface.base[0] * v.x + surface.base[1] * v.y;
        let tangent = d1.try_normalize(0.0)?;
        let side = tangent.cross(&surface.normal);
        let normal_curvature = v.dot(&(surface.curvature * v)) / speed_squared;
        // The covariant acceleration along the surface.
        let covariant = nalgebra::Vector2::from_fn(|k, _| acceleration[k] + v.dot(&(surface.christoffel[k] * v)));
        let along = surface.base[0] * covariant.x + surface.base[1] * covariant.y;
        let geodesic_curvature = along.dot(&side) / speed_squared;
        let lower = nalgebra::Vector2::new(side.dot(&surface.base[0]), side.dot(&surface.base[1]));
        let side_components = surface.inverse_metric * lower;
        let geodesic_torsion = v.dot(&(surface.curvature * side_components)) / speed_squared.sqrt();
        Some(DarbouxFrame {
            tangent,
            side,
            normal: surface.normal,
            normal_curvature,
            geodesic_curvature,
            geodesic_torsion,
        })
    }
}
