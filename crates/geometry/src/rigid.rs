//! Rigid motion of shapes.

use std::sync::Arc;

use crate::patch::{Atlas, CurveChart, Piece, SurfaceChart};
use crate::shape::{Axes, Curve, CurveKind, Shape, Surface, SurfaceKind};
use crate::{Matrix, Point, Vector};

/// A rotation followed by a translation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMotion {
    pub rotation: Matrix<3>,
    pub translation: Vector<3>,
}

impl RigidMotion {
    /// The rotation by the length of `rotation` about its direction through `centre`, then a displacement.
    pub fn new(rotation: Vector<3>, centre: Point<3>, displacement: Vector<3>) -> Self {
        let rotation = nalgebra::Rotation3::new(rotation).into_inner();
        RigidMotion { rotation, translation: centre + displacement - rotation * centre }
    }

    /// Where a position goes.
    pub fn point(&self, x: &Point<3>) -> Point<3> {
        self.rotation * x + self.translation
    }

    /// Where a direction goes.
    pub fn vector(&self, v: &Vector<3>) -> Vector<3> {
        self.rotation * v
    }

    /// The box around a moved box.
    pub(crate) fn hull(&self, [low, high]: &[Point<3>; 2]) -> [Point<3>; 2] {
        let (middle, half) = (self.point(&((low + high) * 0.5)), self.rotation.abs() * ((high - low) * 0.5));
        [middle - half, middle + half]
    }

    fn axes(&self, a: &Axes) -> Axes {
        Axes { origin: self.point(&a.origin), ex: self.vector(&a.ex), ey: self.vector(&a.ey), ez: self.vector(&a.ez) }
    }

    /// Homogeneous coefficients of powers: the weight of each carries the translation.
    fn coefficients(&self, c: &[[f64; 4]], rational: bool) -> Vec<[f64; 4]> {
        c.iter()
            .enumerate()
            .map(|(k, c)| {
                let x = self.rotation * Vector::<3>::new(c[0], c[1], c[2]);
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
                axis: self.vector(axis),
                profile: self.curve_chart(profile),
                middle: *middle,
                half: *half,
                bounds: *bounds,
            },
        }
    }

    /// A moved curve.
    pub fn curve(&self, c: &Curve) -> Curve {
        let kind = match &c.kind {
            CurveKind::Segment { p0, p1 } => CurveKind::Segment { p0: self.point(p0), p1: self.point(p1) },
            CurveKind::Circle { axes, radius } => CurveKind::Circle { axes: self.axes(axes), radius: *radius },
            CurveKind::Ellipse { axes, a, b } => CurveKind::Ellipse { axes: self.axes(axes), a: *a, b: *b },
            CurveKind::Other => CurveKind::Other,
        };
        let pieces = moved(&c.atlas.pieces, |chart| self.curve_chart(chart));
        c.with(kind, Atlas::new(pieces))
    }

    /// A moved surface.
    pub fn surface(&self, s: &Surface) -> Surface {
        let kind = match &s.kind {
            SurfaceKind::Plane { axes } => SurfaceKind::Plane { axes: self.axes(axes) },
            SurfaceKind::Cylinder { axes, radius } => SurfaceKind::Cylinder { axes: self.axes(axes), radius: *radius },
            SurfaceKind::Cone { axes, sin, cos } => SurfaceKind::Cone { axes: self.axes(axes), sin: *sin, cos: *cos },
            SurfaceKind::Sphere { axes, radius } => SurfaceKind::Sphere { axes: self.axes(axes), radius: *radius },
            SurfaceKind::Ellipsoid { axes, semi_axes } => {
                SurfaceKind::Ellipsoid { axes: self.axes(axes), semi_axes: *semi_axes }
            }
            SurfaceKind::Torus { axes, major, minor } => {
                SurfaceKind::Torus { axes: self.axes(axes), major: *major, minor: *minor }
            }
            SurfaceKind::Triangle { nodes } => SurfaceKind::Triangle { nodes: nodes.map(|n| self.point(&n)) },
            SurfaceKind::Other => SurfaceKind::Other,
        };
        let pieces = moved(&s.atlas.pieces, |chart| self.surface_chart(chart));
        s.with(kind, Atlas::new(pieces), |chart| self.surface_chart(chart))
    }

    /// A moved shape. An implicit surface keeps its functions and cannot be moved: `None`.
    pub fn shape(&self, shape: &Shape) -> Option<Shape> {
        Some(match shape {
            Shape::Point(p) => Shape::Point(self.point(p)),
            Shape::Curve(c) => self.curve(c).into(),
            Shape::Surface(s) => self.surface(s).into(),
            Shape::Mesh(m) => {
                let mut mesh = m.as_ref().clone();
                mesh.move_vertices(m.vertices().iter().map(|v| self.point(v)).collect()).ok()?;
                mesh.into()
            }
            Shape::Implicit(s)
                if *self == Self::new(Vector::<3>::zeros(), Point::<3>::zeros(), Vector::<3>::zeros()) =>
            {
                Shape::Implicit(Arc::clone(s))
            }
            Shape::Implicit(_) => return None,
        })
    }
}

fn moved<const M: usize, C>(pieces: &[Piece<M, C>], chart: impl Fn(&C) -> C) -> Vec<Piece<M, C>> {
    pieces.iter().map(|p| Piece { chart: chart(&p.chart), map: p.map.clone(), sides: p.sides }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::closest::{Query, closest};

    #[test]
    fn moving_both_partners_changes_no_distance() {
        let motion = RigidMotion::new(
            Vector::<3>::new(0.3, -0.8, 0.5),
            Point::<3>::new(0.2, 0.1, 0.0),
            Vector::<3>::new(1.0, 2.0, -0.5),
        );
        let axes = Axes::standard(Point::<3>::new(0.1, 0.2, 0.3));
        let points = [[0.0, 0.0, 0.0], [1.0, 0.3, 0.2], [0.4, 1.2, -0.3], [1.1, 1.0, 0.5]].map(Point::<3>::from);
        let weights = [1.0, 0.5, 2.0, 1.5];
        let curve = Curve::bezier(&points, Some(&weights)).unwrap();
        let shapes: Vec<Shape> = vec![
            Shape::Point(Point::<3>::new(2.0, -1.0, 1.0)),
            Curve::helix(axes, 0.5, 0.2, [0.0, 6.0]).unwrap().into(),
            Surface::revolution(&curve, Point::<3>::new(3.0, 0.0, 0.0), Vector::<3>::z(), [0.0, 2.0], false)
                .unwrap()
                .into(),
            curve.into(),
            Surface::quad4(&points).unwrap().into(),
            Surface::tri3(&[points[0], points[1], points[2]]).unwrap().into(),
            Surface::torus(axes, 1.0, 0.3, [[0.0, 3.0], [0.0, 3.0]], [false; 2]).unwrap().into(),
        ];
        for (k, a) in shapes.iter().enumerate() {
            for b in &shapes[k + 1..] {
                let before = closest(a, b, &Query::default()).distance();
                let after = closest(&motion.shape(a).unwrap(), &motion.shape(b).unwrap(), &Query::default()).distance();
                assert!((before - after).abs() < 1e-12, "{before} {after}");
            }
            let z = [0.4, 0.3];
            if let (Shape::Surface(s), Shape::Surface(t)) = (a, motion.shape(a).unwrap()) {
                assert!((motion.point(&s.position(z[0], z[1])) - t.position(z[0], z[1])).norm() < 1e-14);
            }
        }
    }
}
