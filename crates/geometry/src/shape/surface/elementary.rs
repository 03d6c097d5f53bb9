//! Planes, quadrics, tori, graphs and surfaces of revolution.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::grid::bezier_grid;
use super::{Parts, Surface, SurfaceKind};
use crate::patch::SurfaceChart;
use crate::patch::net::Net;
use crate::shape::Curve;
use crate::shape::curve::{closed_range, homogeneous};
use crate::shape::error::{Axes, ShapeError, interval, number, position, positive};
use crate::{Point, Vector};

impl Surface {
    /// `o + u ex + v ey` over a rectangle.
    ///
    /// # Errors
    /// An empty range.
    pub fn plane(axes: Axes, range: [[f64; 2]; 2]) -> Result<Self, ShapeError> {
        let [u, v] = [interval("range", range[0])?, interval("range", range[1])?];
        let at = |s: f64, t: f64| {
            let (s, t) = (u[0] + (u[1] - u[0]) * s, v[0] + (v[1] - v[0]) * t);
            homogeneous(&(axes.origin + axes.ex * s + axes.ey * t), 1.0)
        };
        let parts =
            bezier_grid(range.map(|r| r.to_vec()), [vec![true], vec![true]], vec![Net::interpolating([1, 1], at)]);
        Ok(Self::assemble(SurfaceKind::Plane { axes }, parts, [false; 2], false))
    }

    fn quadric(
        kind: SurfaceKind,
        origin: Point<3>,
        axes: [Vector<3>; 3],
        [f, g]: [[f64; 3]; 2],
        range: [[f64; 2]; 2],
        closed: [bool; 2],
    ) -> Result<Self, ShapeError> {
        closed_range(range[0], closed[0])?;
        let turning = f[2] != 0.0 || g[2] != 0.0;
        let breaks = [
            cuts(interval("range", range[0])?, FRAC_PI_2),
            cuts(interval("range", range[1])?, if turning { FRAC_PI_2 } else { f64::INFINITY }),
        ];
        let mut charts = Vec::new();
        for u in breaks[0].windows(2) {
            for v in breaks[1].windows(2) {
                let middle = [0.5 * (u[0] + u[1]), 0.5 * (v[0] + v[1])];
                let half = [0.5 * (u[1] - u[0]), 0.5 * (v[1] - v[0])];
                charts.push(SurfaceChart::Quadric { origin, axes, f, g, middle, half });
            }
        }
        let may_turn = [vec![false; breaks[0].len()], vec![false; breaks[1].len()]];
        let ratios = vec![[1.0; 2]; charts.len()];
        Ok(Self::assemble(kind, Parts { breaks, may_turn, charts, ratios }, closed, turning))
    }

    /// `o + r cos u ex + r sin u ey + v ez`.
    ///
    /// # Errors
    /// A radius that is not positive, or an empty range.
    pub fn cylinder(axes: Axes, radius: f64, range: [[f64; 2]; 2], closed: bool) -> Result<Self, ShapeError> {
        positive("r", radius)?;
        let kind = SurfaceKind::Cylinder { axes, radius };
        let form = [[radius, 0.0, 0.0], [0.0, 1.0, 0.0]];
        Self::quadric(kind, axes.origin, [axes.ex, axes.ey, axes.ez], form, range, [closed, false])
    }

    /// `o + v (sin (cos u ex + sin u ey) + cos ez)` with sine and cosine of the half angle, `v >= 0`.
    ///
    /// # Errors
    /// An angle that is not between 0 and 90 degrees, a negative `v`, an empty range.
    pub fn cone(axes: Axes, sin: f64, cos: f64, range: [[f64; 2]; 2], closed: bool) -> Result<Self, ShapeError> {
        positive("sin", sin)?;
        positive("cos", cos)?;
        if (sin.hypot(cos) - 1.0).abs() > 1e-8 {
            return Err(ShapeError::new("sin", "sin² + cos² is not 1"));
        }
        if range[1][0] < 0.0 {
            return Err(ShapeError::new("range", "v must not be negative: a cone begins at its apex"));
        }
        let kind = SurfaceKind::Cone { axes, sin, cos };
        let form = [[0.0, sin, 0.0], [0.0, cos, 0.0]];
        Self::quadric(kind, axes.origin, [axes.ex, axes.ey, axes.ez], form, range, [closed, false])
    }

    /// `o + r (cos v cos u ex + cos v sin u ey + sin v ez)`, `v` the latitude.
    ///
    /// # Errors
    /// A radius that is not positive, an empty range, a latitude beyond the poles.
    pub fn sphere(axes: Axes, radius: f64, range: [[f64; 2]; 2], closed: bool) -> Result<Self, ShapeError> {
        positive("r", radius)?;
        latitude(range[1])?;
        let kind = SurfaceKind::Sphere { axes, radius };
        let vectors = [axes.ex * radius, axes.ey * radius, axes.ez * radius];
        Self::quadric(kind, axes.origin, vectors, [[0.0, 0.0, 1.0]; 2], range, [closed, false])
    }

    /// Like the sphere, with three semi-axes.
    ///
    /// # Errors
    /// A semi-axis that is not positive, an empty range, a latitude beyond the poles.
    pub fn ellipsoid(axes: Axes, semi_axes: [f64; 3], range: [[f64; 2]; 2], closed: bool) -> Result<Self, ShapeError> {
        for a in semi_axes {
            positive("abc", a)?;
        }
        latitude(range[1])?;
        let vectors = [axes.ex * semi_axes[0], axes.ey * semi_axes[1], axes.ez * semi_axes[2]];
        Self::quadric(
            SurfaceKind::Ellipsoid { axes, semi_axes },
            axes.origin,
            vectors,
            [[0.0, 0.0, 1.0]; 2],
            range,
            [closed, false],
        )
    }

    /// `o + (R + r cos v)(cos u ex + sin u ey) + r sin v ez`.
    ///
    /// # Errors
    /// Radii that are not positive, or an empty range.
    pub fn torus(
        axes: Axes,
        major: f64,
        minor: f64,
        range: [[f64; 2]; 2],
        closed: [bool; 2],
    ) -> Result<Self, ShapeError> {
        positive("R", major)?;
        positive("r", minor)?;
        closed_range(range[1], closed[1])?;
        let kind = SurfaceKind::Torus { axes, major, minor };
        let form = [[major, 0.0, minor], [0.0, 0.0, minor]];
        Self::quadric(kind, axes.origin, [axes.ex, axes.ey, axes.ez], form, range, closed)
    }

    /// `o + u ex + v ey + (A u² + B v² + C u v) ez`.
    ///
    /// # Errors
    /// Numbers that are not finite, or an empty range.
    pub fn graph(axes: Axes, [a, b, c]: [f64; 3], range: [[f64; 2]; 2]) -> Result<Self, ShapeError> {
        for value in [a, b, c] {
            number("abc", value)?;
        }
        let [p, q] = [interval("range", range[0])?, interval("range", range[1])?];
        let at = |s: f64, t: f64| {
            let (u, v) = (p[0] + (p[1] - p[0]) * s, q[0] + (q[1] - q[0]) * t);
            let height = a * u * u + b * v * v + c * u * v;
            homogeneous(&(axes.origin + axes.ex * u + axes.ey * v + axes.ez * height), 1.0)
        };
        let parts =
            bezier_grid(range.map(|r| r.to_vec()), [vec![true], vec![true]], vec![Net::interpolating([2, 2], at)]);
        Ok(Self::assemble(SurfaceKind::Other, parts, [false; 2], false))
    }

    /// A profile curve (parameter `v`) turned about `axis` through `origin` by the angle `u`.
    ///
    /// # Errors
    /// An axis of no length, or an empty range.
    pub fn revolution(
        profile: &Curve,
        origin: Point<3>,
        axis: Vector<3>,
        range: [f64; 2],
        closed: bool,
    ) -> Result<Self, ShapeError> {
        position("o", &origin)?;
        position("axis", &axis)?;
        let axis = axis.try_normalize(1e-150).ok_or_else(|| ShapeError::new("axis", "has no length"))?;
        let range = interval("range", range)?;
        closed_range(range, closed)?;
        let turns = cuts(range, FRAC_PI_2);
        let pieces = &profile.atlas.pieces;
        let mut along: Vec<f64> = pieces.iter().map(|p| p.map.interval(0).from).collect();
        along.push(profile.domain()[1]);
        let (mut charts, mut ratios) = (Vec::new(), Vec::new());
        for u in turns.windows(2) {
            for piece in pieces {
                let (middle, half) = (0.5 * (u[0] + u[1]), 0.5 * (u[1] - u[0]));
                charts.push(SurfaceChart::revolved(origin, axis, piece.chart.clone(), middle, half));
                ratios.push([1.0, piece.map.interval(0).ratio]);
            }
        }
        let may_turn = [vec![false; turns.len()], vec![true; along.len()]];
        let parts = Parts { breaks: [turns, along], may_turn, charts, ratios };
        Ok(Self::assemble(SurfaceKind::Other, parts, [closed, profile.is_closed()], false))
    }
}

fn latitude(range: [f64; 2]) -> Result<(), ShapeError> {
    if range[0] < -FRAC_PI_2 - 1e-12 || range[1] > FRAC_PI_2 + 1e-12 {
        return Err(ShapeError::new("range", "a latitude beyond a pole"));
    }
    Ok(())
}

/// Equal parts no longer than `most`.
fn cuts([from, to]: [f64; 2], most: f64) -> Vec<f64> {
    let count = ((to - from) / most - 1e-9).ceil().clamp(1.0, 4.0 * TAU) as usize;
    (0..=count).map(|k| if k == count { to } else { from + (to - from) * k as f64 / count as f64 }).collect()
}
