//! Shapes turned, moved and scaled.

use super::{Axes, Curve, CurveKind, Shape, Surface, SurfaceKind};
use crate::Vector;
use crate::mesh::TriangleMesh;
use crate::patch::{CurveChart, Piece, SurfaceChart};
use crate::similarity::Similarity;

impl Similarity {
    fn axes(&self, a: &Axes) -> Axes {
        Axes {
            origin: self.point(&a.origin),
            ex: self.direction(&a.ex),
            ey: self.direction(&a.ey),
            ez: self.direction(&a.ez),
        }
    }

    /// Homogeneous coefficients of powers: the weight of each carries the translation.
    fn coefficients(&self, c: &[[f64; 4]], rational: bool) -> Vec<[f64; 4]> {
        c.iter()
            .enumerate()
            .map(|(k, c)| {
                let x = self.vector(&Vector::<3>::new(c[0], c[1], c[2]));
                // Without weights the function is one, whose only power is the first.
                let w = if rational { c[3] } else { f64::from(u8::from(k == 0)) };
                let x = x + self.translation * w;
                [x.x, x.y, x.z, c[3]]
            })
            .collect()
    }

    fn curve_chart(&self, chart: &CurveChart) -> CurveChart {
        match chart {
            CurveChart::Power { coefficients, rational, bounds } => CurveChart::Power {
                coefficients: self.coefficients(coefficients, *rational),
                rational: *rational,
                bounds: bounds.moved(self),
            },
            CurveChart::Harmonic { origin, a, b, c, middle, half } => CurveChart::Harmonic {
                origin: self.point(origin),
                a: self.vector(a),
                b: self.vector(b),
                c: self.vector(c),
                middle: *middle,
                half: *half,
            },
        }
    }

    fn surface_chart(&self, chart: &SurfaceChart) -> SurfaceChart {
        match chart {
            SurfaceChart::Power { degree, coefficients, rational, bounds } => SurfaceChart::Power {
                degree: *degree,
                coefficients: self.coefficients(coefficients, *rational),
                rational: *rational,
                bounds: bounds.moved(self),
            },
            SurfaceChart::Quadric { origin, axes, f, g, middle, half } => SurfaceChart::Quadric {
                origin: self.point(origin),
                axes: axes.map(|a| self.vector(&a)),
                f: *f,
                g: *g,
                middle: *middle,
                half: *half,
            },
            SurfaceChart::Revolved { origin, axis, profile, middle, half, bounds } => SurfaceChart::Revolved {
                origin: self.point(origin),
                axis: self.direction(axis),
                profile: self.curve_chart(profile),
                middle: *middle,
                half: *half,
                bounds: bounds.times(self.factor),
            },
        }
    }

    /// A moved curve.
    pub fn curve(&self, c: &Curve) -> Curve {
        let kind = match &c.kind {
            CurveKind::Segment { p0, p1 } => CurveKind::Segment { p0: self.point(p0), p1: self.point(p1) },
            CurveKind::Circle { axes, radius } => {
                CurveKind::Circle { axes: self.axes(axes), radius: radius * self.factor }
            }
            CurveKind::Ellipse { axes, a, b } => {
                CurveKind::Ellipse { axes: self.axes(axes), a: a * self.factor, b: b * self.factor }
            }
            CurveKind::Other => CurveKind::Other,
        };
        let pieces = moved(&c.atlas.pieces, |chart| self.curve_chart(chart));
        c.with(kind, pieces)
    }

    /// A moved surface.
    pub fn surface(&self, s: &Surface) -> Surface {
        let kind = match &s.kind {
            SurfaceKind::Plane { axes } => SurfaceKind::Plane { axes: self.axes(axes) },
            SurfaceKind::Cylinder { axes, radius } => {
                SurfaceKind::Cylinder { axes: self.axes(axes), radius: radius * self.factor }
            }
            SurfaceKind::Cone { axes, sin, cos } => SurfaceKind::Cone { axes: self.axes(axes), sin: *sin, cos: *cos },
            SurfaceKind::Sphere { axes, radius } => {
                SurfaceKind::Sphere { axes: self.axes(axes), radius: radius * self.factor }
            }
            SurfaceKind::Ellipsoid { axes, semi_axes } => {
                SurfaceKind::Ellipsoid { axes: self.axes(axes), semi_axes: semi_axes.map(|a| a * self.factor) }
            }
            SurfaceKind::Torus { axes, major, minor } => {
                SurfaceKind::Torus { axes: self.axes(axes), major: major * self.factor, minor: minor * self.factor }
            }
            SurfaceKind::Triangle { nodes } => SurfaceKind::Triangle { nodes: nodes.map(|n| self.point(&n)) },
            SurfaceKind::Other => SurfaceKind::Other,
        };
        let pieces = moved(&s.atlas.pieces, |chart| self.surface_chart(chart));
        s.with(kind, pieces, |chart| self.surface_chart(chart), self.factor)
    }

    /// The shape there; `None` of implicit surfaces and solids, which keep their functions and faces.
    pub fn shape(&self, shape: &Shape) -> Option<Shape> {
        Some(match shape {
            Shape::Point(p) => Shape::Point(self.point(p)),
            Shape::Curve(c) => self.curve(c).into(),
            Shape::Surface(s) => self.surface(s).into(),
            Shape::Mesh(m) => {
                let vertices = m.vertices().iter().map(|v| self.point(v)).collect();
                TriangleMesh::new(vertices, m.triangles()).ok()?.into()
            }
            Shape::Implicit(_) | Shape::Solid(_) => return None,
        })
    }
}

fn moved<const M: usize, C>(pieces: &[Piece<M, C>], chart: impl Fn(&C) -> C) -> Vec<Piece<M, C>> {
    pieces.iter().map(|p| Piece { chart: chart(&p.chart), map: p.map.clone(), sides: p.sides }).collect()
}
