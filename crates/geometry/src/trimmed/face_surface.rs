//! Surfaces on which faces lie: those with a closed form, without end, and splines.
//!
//! | surface | position at `(u, v)` |
//! |---|---|
//! | plane | `o + u ex + v ey` |
//! | cylinder | `o + r e(u) + v ez`, `e(u) = cos u ex + sin u ey` |
//! | cone | `o + v (sin γ e(u) + cos γ ez)`, `v ≥ 0`, the apex at `o` |
//! | sphere | `o + r (cos v e(u) + sin v ez)` |
//! | torus | `o + (R + r cos v) e(u) + r sin v ez` |
//! | spline | its own parameters |
//!
//! The normal is `r_u × r_v`: away from the axis, out of the tube, or that of the spline.

use crate::closest::{Query, closest};
use crate::frame::SurfaceFrame;
use crate::rigid_shape::{self, GapJet, RigidShape};
use crate::shape::{Axes, Shape, Surface};
use crate::{Matrix, Point, Vector};
use std::f64::consts::TAU;

/// The surface of a face.
#[derive(Clone, Debug)]
pub enum FaceSurface {
    Plane {
        axes: Axes,
    },
    Cylinder {
        axes: Axes,
        radius: f64,
    },
    /// The origin of the axes is the apex, `ez` points along the one nappe that there is.
    Cone {
        axes: Axes,
        half_angle: f64,
    },
    Sphere {
        axes: Axes,
        radius: f64,
    },
    Torus {
        axes: Axes,
        major: f64,
        minor: f64,
    },
    Spline(Box<Surface>),
}

/// Position and tangents.
pub(super) struct Tangents {
    pub x: Point<3>,
    pub u: Vector<3>,
    pub v: Vector<3>,
}

impl FaceSurface {
    /// As messages call it.
    pub fn noun(&self) -> &'static str {
        match self {
            FaceSurface::Plane { .. } => "plane",
            FaceSurface::Cylinder { .. } => "cylinder",
            FaceSurface::Cone { .. } => "cone",
            FaceSurface::Sphere { .. } => "sphere",
            FaceSurface::Torus { .. } => "torus",
            FaceSurface::Spline(_) => "spline surface",
        }
    }

    /// The gap to the whole surface, by the closed form of the body that it bounds; none of a spline. It has no other local
    /// minimum of the distance than this closest point, or a circle or sphere of them.
    pub(super) fn gap(&self, x: &Point<3>) -> Option<GapJet<3>> {
        Some(match *self {
            FaceSurface::Plane { axes } => rigid_shape::Plane { point: axes.origin, normal: axes.ez }.gap(x),
            FaceSurface::Cylinder { axes, radius } => {
                rigid_shape::Cylinder { point: axes.origin, axis: axes.ez, radius }.gap(x)
            }
            FaceSurface::Cone { axes, half_angle } => {
                rigid_shape::Cone { apex: axes.origin, axis: axes.ez, half_angle }.gap(x)
            }
            FaceSurface::Sphere { axes, radius } => rigid_shape::Sphere { center: axes.origin, radius }.gap(x),
            FaceSurface::Torus { axes, major, minor } => {
                rigid_shape::Torus { center: axes.origin, axis: axes.ez, major, minor }.gap(x)
            }
            FaceSurface::Spline(_) => return None,
        })
    }

    /// The gap of a point whose closest point on the surface is given, with the normal of the surface.
    pub(super) fn gap_from(&self, x: &Point<3>, foot: [f64; 2]) -> Option<GapJet<3>> {
        let FaceSurface::Spline(s) = self else { return self.gap(x) };
        let jet = s.jet(foot[0], foot[1]);
        let frame = SurfaceFrame::new(&jet)?;
        let gap = frame.normal.dot(&(x - jet.x));
        let curved = |(k, e): (f64, Vector<3>)| e * e.transpose() * (-k / (1.0 - gap * k));
        let hessian = frame.principal_curvatures().map(curved).into_iter().sum::<Matrix<3>>();
        Some(GapJet { gap, normal: frame.normal, hessian })
    }

    /// Parameters of a position on the surface, or of its closest point; a spline is searched near `near`, else all over.
    pub(super) fn parameters(&self, x: &Point<3>, near: Option<[f64; 2]>) -> [f64; 2] {
        let about = |axes: &Axes| {
            let l = axes.local(x);
            (l.y.atan2(l.x), l.x.hypot(l.y), l.z)
        };
        match self {
            FaceSurface::Plane { axes } => {
                let l = axes.local(x);
                [l.x, l.y]
            }
            FaceSurface::Cylinder { axes, .. } => {
                let (u, _, z) = about(axes);
                [u, z]
            }
            FaceSurface::Cone { axes, half_angle } => {
                let (u, rho, z) = about(axes);
                [u, rho * half_angle.sin() + z * half_angle.cos()]
            }
            FaceSurface::Sphere { axes, .. } => {
                let (u, rho, z) = about(axes);
                [u, z.atan2(rho)]
            }
            FaceSurface::Torus { axes, major, .. } => {
                let (u, rho, z) = about(axes);
                [u, z.atan2(rho - major)]
            }
            FaceSurface::Spline(s) => {
                if let Some(found) = near.and_then(|z| polish(s, x, z)) {
                    return found;
                }
                let found = closest(&Shape::Point(*x), &Shape::Surface(s.clone()), &Query::default()).closest;
                let &[u, v] = found.b.parameters() else { return [0.0; 2] };
                [u, v]
            }
        }
    }

    /// Whether all values of `u` are one point.
    pub(super) fn is_singular(&self, [u, v]: [f64; 2]) -> bool {
        // What rounding leaves of a distance from the axis.
        const NEAR: f64 = 1e-9;
        match self {
            FaceSurface::Cone { axes, .. } => v.abs() <= NEAR * (v.abs() + axes.origin.norm()) || v <= 0.0,
            FaceSurface::Sphere { .. } => v.cos() <= NEAR,
            FaceSurface::Spline(s) => {
                let jet = s.jet(u, v);
                jet.u.norm() <= NEAR * s.size()
            }
            _ => false,
        }
    }

    /// The periods of the parameters.
    pub(super) fn periods(&self) -> [Option<f64>; 2] {
        match self {
            FaceSurface::Plane { .. } => [None; 2],
            FaceSurface::Torus { .. } => [Some(TAU); 2],
            FaceSurface::Spline(s) => [0, 1].map(|k| s.closed()[k].then(|| s.domain()[k][1] - s.domain()[k][0])),
            _ => [Some(TAU), None],
        }
    }

    /// Where the parameters of a surface end that is not cut off: splines, and poles.
    pub(super) fn ends(&self) -> [Option<[f64; 2]>; 2] {
        match self {
            FaceSurface::Sphere { .. } => [None, Some([-0.25 * TAU, 0.25 * TAU])],
            FaceSurface::Spline(s) => s.domain().map(Some),
            _ => [None; 2],
        }
    }

    /// Lengths of the tangents at a typical place.
    pub(super) fn scale(&self, size: f64) -> [f64; 2] {
        match self {
            FaceSurface::Plane { .. } => [1.0; 2],
            FaceSurface::Cylinder { radius, .. } => [*radius, 1.0],
            FaceSurface::Cone { half_angle, .. } => [size * half_angle.sin(), 1.0],
            FaceSurface::Sphere { radius, .. } => [*radius; 2],
            FaceSurface::Torus { major, minor, .. } => [*major, *minor],
            FaceSurface::Spline(s) => {
                let d = s.domain();
                // Means over a grid, without its sides, which can be poles.
                const GRID: usize = 4;
                let mut sum = [0.0; 2];
                for i in 0..GRID * GRID {
                    let at = |k: usize, i: usize| d[k][0] + (d[k][1] - d[k][0]) * (i as f64 + 0.5) / GRID as f64;
                    let jet = s.jet(at(0, i / GRID), at(1, i % GRID));
                    sum[0] += jet.u.norm();
                    sum[1] += jet.v.norm();
                }
                sum.map(|s| (s / (GRID * GRID) as f64).max(f64::MIN_POSITIVE))
            }
        }
    }

    /// Position and tangents.
    pub(super) fn tangents(&self, [u, v]: [f64; 2]) -> Tangents {
        let round = |axes: &Axes| {
            let (sin, cos) = u.sin_cos();
            (axes.ex * cos + axes.ey * sin, axes.ey * cos - axes.ex * sin)
        };
        match self {
            FaceSurface::Plane { axes } => {
                Tangents { x: axes.origin + axes.ex * u + axes.ey * v, u: axes.ex, v: axes.ey }
            }
            FaceSurface::Cylinder { axes, radius } => {
                let (e, f) = round(axes);
                Tangents { x: axes.origin + e * *radius + axes.ez * v, u: f * *radius, v: axes.ez }
            }
            FaceSurface::Cone { axes, half_angle } => {
                let (e, f) = round(axes);
                let (sin, cos) = half_angle.sin_cos();
                let along = e * sin + axes.ez * cos;
                Tangents { x: axes.origin + along * v, u: f * (v * sin), v: along }
            }
            FaceSurface::Sphere { axes, radius } => {
                let (e, f) = round(axes);
                let (sin, cos) = v.sin_cos();
                let x = axes.origin + (e * cos + axes.ez * sin) * *radius;
                Tangents { x, u: f * (cos * radius), v: (axes.ez * cos - e * sin) * *radius }
            }
            FaceSurface::Torus { axes, major, minor } => {
                let (e, f) = round(axes);
                let (sin, cos) = v.sin_cos();
                let across = major + minor * cos;
                let x = axes.origin + e * across + axes.ez * (minor * sin);
                Tangents { x, u: f * across, v: (axes.ez * cos - e * sin) * *minor }
            }
            FaceSurface::Spline(s) => {
                let jet = s.jet(u, v);
                Tangents { x: jet.x, u: jet.u, v: jet.v }
            }
        }
    }

    pub(super) fn position(&self, z: [f64; 2]) -> Point<3> {
        self.tangents(z).x
    }

    /// The unit normal at a point of the surface with these parameters; none at an apex.
    pub(super) fn normal(&self, x: &Point<3>, z: [f64; 2]) -> Option<Vector<3>> {
        match self {
            FaceSurface::Plane { axes } => Some(axes.ez),
            FaceSurface::Cylinder { axes, .. } => {
                let d = x - axes.origin;
                (d - axes.ez * axes.ez.dot(&d)).try_normalize(0.0)
            }
            FaceSurface::Sphere { axes, .. } => (x - axes.origin).try_normalize(0.0),
            FaceSurface::Cone { .. } if self.is_singular(z) => None,
            FaceSurface::Spline(s) => {
                let jet = s.jet(z[0], z[1]);
                // At a pole the growth of the tangent away from it takes its place.
                let normal = SurfaceFrame::new(&jet).map(|f| f.normal);
                normal.or_else(|| {
                    let d = s.domain()[1];
                    let away = if z[1] - d[0] < d[1] - z[1] { 1.0 } else { -1.0 };
                    (jet.uv * away).cross(&jet.v).try_normalize(1e-9 * jet.uv.norm() * jet.v.norm())
                })
            }
            _ => {
                let t = self.tangents(z);
                t.u.cross(&t.v).try_normalize(0.0)
            }
        }
    }
}

/// Newton's method for the closest point of a spline from nearby; none where it does not arrive.
fn polish(s: &Surface, x: &Point<3>, start: [f64; 2]) -> Option<[f64; 2]> {
    // It converges quadratically or not at all; along ends it alternates between them.
    const MOST: usize = 30;
    let (domain, closed) = (s.domain(), s.closed());
    let mut z = start;
    for _ in 0..MOST {
        let jet = s.jet(z[0], z[1]);
        let d = jet.x - x;
        let g = [jet.u.dot(&d), jet.v.dot(&d)];
        let mut h = [
            [jet.u.norm_squared() + jet.uu.dot(&d), jet.u.dot(&jet.v) + jet.uv.dot(&d)],
            [0.0, jet.v.norm_squared() + jet.vv.dot(&d)],
        ];
        let held =
            [0, 1].map(|k| !closed[k] && (z[k] <= domain[k][0] && g[k] >= 0.0 || z[k] >= domain[k][1] && g[k] <= 0.0));
        for k in 0..2 {
            if held[k] {
                (h[k][k], h[0][1]) = (1.0, 0.0);
            }
        }
        let g = [0, 1].map(|k| if held[k] { 0.0 } else { g[k] });
        let det = h[0][0] * h[1][1] - h[0][1] * h[0][1];
        if det.is_nan() || det <= 1e-14 * (h[0][0] * h[1][1]).abs() {
            return None;
        }
        let step = [(g[0] * h[1][1] - g[1] * h[0][1]) / det, (g[1] * h[0][0] - g[0] * h[0][1]) / det];
        let mut moved = 0.0;
        for k in 0..2 {
            let next = if closed[k] { z[k] - step[k] } else { (z[k] - step[k]).clamp(domain[k][0], domain[k][1]) };
            moved += (next - z[k]).abs() * [jet.u, jet.v][k].norm();
            z[k] = next;
        }
        if moved <= 4.0 * f64::EPSILON * s.size() {
            return Some(z);
        }
        if moved > s.size() {
            return None;
        }
        if moved <= 1e-13 * s.size() {
            return Some(z);
        }
    }
    None
}
