//! A surface of a solid as others meet it: the closest point over its faces, edges and vertices, where they are now.
//!
//! On a face there are two coordinates, on an edge one, at a vertex none; in the plane a face is a strip that reaches
//! across it, along which nothing changes. Contact of a surface with itself leaves out what hangs together with a site, and
//! takes only what faces it.

use super::axis;
use super::border::Place;
use super::faces::{Face, Faces, Surface};
use super::spatial::spatial;
use rayon::prelude::*;
use signorini_fem::hierarchic::Derivatives;
use signorini_fem::{CellShape, Local, RationalBasis};
use signorini_geometry::bvh::Bvh;
use signorini_geometry::closest::{FeatureKind, Projection, Query, closest};
use signorini_geometry::shape::{Curve, CurveJet, Shape, ShapeError, SurfaceJet};
use signorini_geometry::{Aabb, Looking, Matrix, Point, Vector};
use signorini_mechanics::{
    Anchor, Direction, Foot, Function, Master, MasterProjection, MaterialPoint, NormalField, Site,
};
use std::collections::BTreeSet;
use std::sync::OnceLock;

/// Sine of the angle to the normal of a face below which a point beside its border is over the face itself.
const OVER: f64 = 1e-8;
/// Distance to a border, in sizes of a face, that is none: direction and sign of the gap are those of the mean normal.
const TOUCHING: f64 = 1e-9;
/// Cosine between the normals of two places of a surface from which on they do not face each other.
const FACING: f64 = -0.5;

/// Newton steps to where a line crosses a face, which is nearly flat.
const MOST_STEPS: usize = 20;
/// A last step of the coordinates, whose square is rounding.
const CONVERGED: f64 = 1e-9;
/// A step of the coordinates, of which a face has two units, that leaves it for good.
const FARTHEST: f64 = 1e3;
/// How far beyond the border of a face a point counts for it, so that none is lost between two.
const BORDER: f64 = 1e-9;

/// A surface where it is now.
pub(super) struct SurfaceMaster<'a, const D: usize> {
    faces: &'a Faces<D>,
    surface: &'a Surface<D>,
    u: &'a [f64],
    shapes: Vec<Shape>,
    bvh: Bvh,
    size: f64,
    /// Averaged normals at the vertices of each face, once they are asked for.
    normals: Vec<OnceLock<Vec<Direction>>>,
}

impl<const D: usize> Faces<D> {
    /// # Errors
    /// Faces that make no shape.
    pub fn master<'a>(&'a self, group: &str, u: &'a [f64]) -> Result<SurfaceMaster<'a, D>, ShapeError> {
        let surface = self.surface(group);
        let shape = |f: &u32| match &self.face(*f).spline {
            Some(spline) => shape(self.face(*f), &spline.moved(u).iter().map(spatial).collect::<Vec<_>>()),
            None => shape(self.face(*f), &self.lattice(*f, u)),
        };
        let shapes: Vec<Shape> = surface.faces.par_iter().map(shape).collect::<Result<_, _>>()?;
        let boxes: Vec<Aabb<3>> = shapes.iter().map(Shape::bounds).collect();
        let size = shapes.iter().map(Shape::size).fold(0.0, f64::max);
        let normals = shapes.iter().map(|_| OnceLock::new()).collect();
        Ok(SurfaceMaster { faces: self, surface, u, shapes, bvh: Bvh::new(&boxes), size, normals })
    }
}

/// A site of the surface itself.
struct Own {
    /// Faces that hang together with it.
    near: BTreeSet<u32>,
    outward: Vector<3>,
    /// How deep it may be inside what it meets: half of its cell, since the far side of a wall is deeper.
    deepest: f64,
}

impl<const D: usize> SurfaceMaster<'_, D> {
    fn own(&self, site: &Site) -> Own {
        // Faces that share a vertex, and their neighbours.
        let mut near: BTreeSet<u32> = self.faces.faces_of(site).collect();
        for _ in 0..2 {
            let vertices: BTreeSet<u32> =
                near.iter().flat_map(|f| self.faces.face(*f).vertices.iter().copied()).collect();
            near.extend(vertices.iter().filter_map(|v| self.surface.around.get(v)).flatten());
        }
        Own { near, outward: self.faces.outward(site, self.u), deepest: 0.5 * self.faces.depth(site) }
    }

    fn normal(&self, face: u32, s: &Local) -> Vector<3> {
        let list = self.faces.slopes(face, s);
        spatial(&self.faces.current(face, s, &list, self.u).area_normal().normalize())
    }

    /// The mean normal of all faces that meet at a point of the border of one: it tells outside from inside.
    fn mean_normal(&self, face: u32, s: &Local) -> Vector<3> {
        let own = self.faces.face(face);
        let around = |v: usize| self.surface.around.get(&own.vertices[v]).map_or(&[][..], |l| &l[..]);
        let list: Vec<u32> = match Place::of(own.shape, s) {
            Place::Vertex(v) => around(v).to_vec(),
            Place::Edge([a, b]) if D == 3 => around(a).iter().copied().filter(|f| around(b).contains(f)).collect(),
            _ => vec![face],
        };
        // The middle of another face tells its normal well enough.
        let of = |f: u32| self.normal(f, &if f == face { *s } else { self.faces.face(f).shape.centre() });
        list.into_iter().map(of).sum::<Vector<3>>().normalize()
    }

    /// Whether the surface ends at a place on the border of a face: at a side of one face only, or a vertex of such a side.
    fn ends_at(&self, face: u32, s: &Local) -> bool {
        let around = |v: u32| self.surface.around.get(&v).map_or(&[][..], |l| &l[..]);
        let is_single = |a: u32, b: u32| around(a).iter().filter(|f| around(b).contains(f)).count() == 1;
        let own = self.faces.face(face);
        match Place::of(own.shape, s) {
            Place::Edge([a, b]) if D == 3 => is_single(own.vertices[a], own.vertices[b]),
            Place::Vertex(v) if D == 3 => {
                let v = own.vertices[v];
                around(v).iter().map(|f| self.faces.face(*f)).any(|f| {
                    let sides = f.shape.edges().iter().map(|e| e.map(|k| f.vertices[k]));
                    sides.filter(|side| side.contains(&v)).any(|[a, b]| is_single(a, b))
                })
            }
            Place::Vertex(v) => around(own.vertices[v]).len() == 1,
            _ => false,
        }
    }

    /// Whether what is closest on a face is across from a site of the surface itself.
    fn faces_each_other(&self, own: &Own, face: u32, x: &Point<3>, found: &Projection) -> bool {
        let normal = self.normal(face, &coordinates(found));
        let gap = (x - found.closest.b.point).dot(&normal);
        own.outward.dot(&normal) < FACING && gap > -own.deepest
    }

    /// Where a line crosses a face that faces it: how far along, and the coordinates.
    fn crossing(&self, face: u32, x: &Point<3>, direction: &Vector<3>) -> Option<(f64, Local)> {
        let shape = self.faces.face(face).shape;
        let mut s = shape.centre();
        for _ in 0..MOST_STEPS {
            let list = self.faces.derivatives(face, &s);
            let at = self.faces.current(face, &s, &list, self.u);
            let [x1, x2] = at.tangents.each_ref().map(spatial);
            // In the plane nothing changes across it.
            let x2 = if D == 2 { Vector::<3>::z() * x1.norm() } else { x2 };
            let off = x - spatial(&at.x);
            let step = Matrix::<3>::from_columns(&[x1, x2, -direction]).try_inverse()? * off;
            (s[0], s[1]) = (s[0] + step[0], if D == 2 { 0.0 } else { s[1] + step[1] });
            let moved = step[0].abs().max(step[1].abs());
            if moved.is_nan() || moved > FARTHEST {
                return None;
            }
            if moved <= CONVERGED {
                let facing = x1.cross(&x2).dot(direction) < 0.0;
                return (facing && is_within(shape, &s)).then_some((step[2], s));
            }
        }
        None
    }

    /// The point of a face from which a point lies along the averaged normal: how far, the coordinates, and the normal.
    fn under(&self, k: usize, x: &Point<3>) -> Option<(f64, Local, NormalField)> {
        let face = self.surface.faces[k];
        let shape = self.faces.face(face).shape;
        let normals = || &self.faces.vertex_normals(self.surface)[k];
        let known = || normals().iter().map(|normal| Faces::<D>::direction(normal, self.u)).collect();
        let at_vertices = self.normals[k].get_or_init(known);
        let field_at = |s: &Local| self.faces.normal_field(face, s, at_vertices);
        let mut s = shape.centre();
        let mut far = 0.0;
        for _ in 0..MOST_STEPS {
            let list = self.faces.derivatives(face, &s);
            let at = self.faces.current(face, &s, &list, self.u);
            let field = field_at(&s);
            let length = field.vector.norm();
            let normal = field.vector / length;
            let [x1, x2] = at.tangents.each_ref().map(spatial);
            // In the plane nothing changes across it.
            let x2 = if D == 2 { Vector::<3>::z() * x1.norm() } else { x2 };
            let turned = |a: usize| (field.slopes[a] - normal * normal.dot(&field.slopes[a])) * (far / length);
            let basis = Matrix::<3>::from_columns(&[x1 + turned(0), x2 + turned(1), normal]);
            let step = basis.try_inverse()? * (x - spatial(&at.x) - normal * far);
            (s[0], s[1]) = (s[0] + step[0], if D == 2 { 0.0 } else { s[1] + step[1] });
            far += step[2];
            let moved = step[0].abs().max(step[1].abs());
            if moved.is_nan() || moved > FARTHEST {
                return None;
            }
            if moved <= CONVERGED {
                return is_within(shape, &s).then(|| (far, s, field_at(&s)));
            }
        }
        None
    }

    fn foot(&self, k: usize, s: Local, x: &Point<3>, feature: FeatureKind) -> Foot {
        let face = self.surface.faces[k];
        let list = self.faces.derivatives(face, &s);
        let at = self.faces.current(face, &s, &list, self.u);
        let normal = spatial(&at.area_normal().normalize());
        let zero = Vector::<3>::zeros();
        let jet = match &self.shapes[k] {
            Shape::Surface(surface) => surface.jet(s[0], s[1]),
            Shape::Curve(curve) => SurfaceJet::strip(&curve.jet(s[0])),
            _ => SurfaceJet::strip(&CurveJet { x: spatial(&at.x), d1: spatial(&at.tangents[0]), d2: zero, d3: zero }),
        };
        let mut foot = Foot {
            point: MaterialPoint { patch: face, xi: s },
            jet,
            coordinates: 2,
            outward: Some(normal),
            radius: 0.0,
            functions: Vec::new(),
            spin: Vec::new(),
            spin_bends: Vec::new(),
            frame: Matrix::<3>::identity(),
        };
        if feature == FeatureKind::Interior {
            foot.functions = functions::<D>(&list, |d| [d[1], d[2], d[3], d[4], d[5]]);
            return foot;
        }
        let d = x - spatial(&at.x);
        let distance = d.norm();
        // Beside a border that is no edge, as between the faces of a plane, the point is over the face.
        let aside = (d - normal * normal.dot(&d)).norm();
        let over = aside <= OVER * distance;
        let touching = distance <= TOUCHING * self.size;
        if aside > TOUCHING * self.size && self.ends_at(face, &s) {
            // Beyond the end of a surface nothing is inside, however low it is: its outward side is where the point is.
            foot.outward = Some(d / distance);
        } else if touching || !over {
            foot.outward = Some(self.mean_normal(face, &s));
        }
        if touching || over {
            foot.functions = functions::<D>(&list, |d| [d[1], d[2], d[3], d[4], d[5]]);
            return foot;
        }
        let shape = self.faces.face(face).shape;
        let Place::Edge([a, b]) = (if D == 3 { Place::of(shape, &s) } else { Place::Interior }) else {
            foot.coordinates = 0;
            foot.functions = functions::<D>(&list, |_| [0.0; 5]);
            return foot;
        };
        let corners = shape.vertices();
        let [p, q] = [0, 1].map(|k| corners[b][k] - corners[a][k]);
        foot.coordinates = 1;
        foot.functions = functions::<D>(&list, |d| {
            [d[1] * p + d[2] * q, 0.0, d[3] * p * p + 2.0 * d[4] * p * q + d[5] * q * q, 0.0, 0.0]
        });
        let j = foot.jet;
        foot.jet.u = j.u * p + j.v * q;
        foot.jet.uu = j.uu * (p * p) + j.uv * (2.0 * p * q) + j.vv * (q * q);
        foot.jet.uuu = j.uuu * p.powi(3) + (j.uuv * (p * p * q) + j.uvv * (p * q * q)) * 3.0 + j.vvv * q.powi(3);
        foot
    }
}

impl<const D: usize> Master for SurfaceMaster<'_, D> {
    fn nearest(&self, x: &Point<3>, reach: f64, except: Option<&Site>) -> Option<MasterProjection> {
        let own = except.map(|site| self.own(site));
        let point = Shape::Point(*x);
        let limit = reach * reach;
        let mut best: Option<(usize, Projection)> = None;
        self.bvh.nearest(x, limit, |k| {
            let now = best.as_ref().map_or(limit, |b| b.1.distance().powi(2));
            let face = self.surface.faces[k];
            if own.as_ref().is_some_and(|own| own.near.contains(&face)) {
                return now;
            }
            let found = closest(&point, &self.shapes[k], &Query::default());
            let square = found.distance().powi(2);
            if own.as_ref().is_some_and(|own| !self.faces_each_other(own, face, x, &found)) {
                return now;
            }
            // Of faces at the same distance the one with the lowest number.
            let better = best
                .as_ref()
                .is_none_or(|(b, p)| found.distance() < p.distance() || (found.distance() == p.distance() && k < *b));
            if square > limit || !better {
                return now;
            }
            best = Some((k, found));
            square
        });
        let (k, found) = best?;
        let feature = found.closest.b.feature.kind;
        Some(MasterProjection::Foot(Box::new(self.foot(k, coordinates(&found), x, feature))))
    }

    fn facing(&self, x: &Point<3>, looking: &Looking) -> Option<MasterProjection> {
        let point = Shape::Point(*x);
        let limit = (looking.within + looking.rounding()).powi(2);
        let mut best: Option<(f64, usize, Foot)> = None;
        self.bvh.nearest(x, limit, |k| {
            let least = best.as_ref().map_or(limit, |(square, ..)| *square);
            let found = closest(&point, &self.shapes[k], &Query::default());
            let square = found.distance().powi(2);
            if square > least || best.as_ref().is_some_and(|(b, of, _)| (*b, *of) < (square, k)) {
                return least;
            }
            let foot = self.foot(k, coordinates(&found), x, FeatureKind::Interior);
            let under = |normal: &Vector<3>| looking.sees(normal) && looking.is_under(&(x - foot.jet.x), normal);
            if !foot.outward.as_ref().is_some_and(under) {
                return least;
            }
            best = Some((square, k, foot));
            square
        });
        best.map(|(.., foot)| MasterProjection::Foot(Box::new(foot)))
    }

    fn is_faceted(&self) -> bool {
        !self.faces.is_smooth(self.surface)
    }

    fn cut(&self, x: &Point<3>, direction: &Vector<3>, reach: f64) -> Option<MasterProjection> {
        let direction = direction.normalize();
        let limit = reach * reach;
        let mut best: Option<(f64, usize, Local)> = None;
        self.bvh.nearest(x, limit, |k| {
            let now = best.map_or(limit, |(t, ..)| t * t);
            if let Some((t, s)) = self.crossing(self.surface.faces[k], x, &direction)
                && t.abs() <= reach
                && best.is_none_or(|(b, other, _)| t.abs() < b.abs() || (t.abs() == b.abs() && k < other))
            {
                best = Some((t, k, s));
                return t * t;
            }
            now
        });
        let (_, k, s) = best?;
        Some(MasterProjection::Cut(Box::new(self.foot(k, s, x, FeatureKind::Interior))))
    }

    fn along(&self, x: &Point<3>, reach: f64) -> Option<MasterProjection> {
        let mut best: Option<(f64, usize, Local, NormalField)> = None;
        self.bvh.nearest(x, reach * reach, |k| {
            let now = best.as_ref().map_or(reach, |(t, ..)| t.abs());
            if let Some((t, s, field)) = self.under(k, x)
                && (t.abs() < now || (t.abs() == now && best.as_ref().is_none_or(|b| k < b.1)))
            {
                best = Some((t, k, s, field));
                return t * t;
            }
            now * now
        });
        let (_, k, s, field) = best?;
        Some(MasterProjection::Along(Box::new(self.foot(k, s, x, FeatureKind::Interior)), Box::new(field)))
    }

    fn at(&self, point: &MaterialPoint) -> Anchor {
        let list = self.faces.derivatives(point.patch, &point.xi);
        let at = self.faces.current(point.patch, &point.xi, &list, self.u);
        Anchor {
            x: spatial(&at.x),
            tangent: spatial(&at.tangents[0]),
            across: Some(if D == 2 { Vector::<3>::z() } else { spatial(&at.tangents[1]) }),
            functions: functions::<D>(&list, |d| [d[1], d[2], 0.0, 0.0, 0.0]),
            frame: Matrix::<3>::identity(),
            ..Anchor::default()
        }
    }
}

/// Functions with the slopes and second slopes that `of` tells, for each direction.
pub(super) fn functions<const D: usize>(
    list: &[(u32, Derivatives)],
    of: impl Fn(&Derivatives) -> [f64; 5],
) -> Vec<Function> {
    let mut out = Vec::with_capacity(D * list.len());
    for (f, d) in list {
        let slopes = of(d);
        for i in 0..D {
            let e = axis(i);
            out.push(Function {
                unknown: D as u32 * f + i as u32,
                value: e * d[0],
                slopes: [e * slopes[0], e * slopes[1]],
                second: [e * slopes[2], e * slopes[3], e * slopes[4]],
            });
        }
    }
    out
}

fn is_within(shape: CellShape, s: &Local) -> bool {
    match shape {
        CellShape::Triangle => s[0] >= -BORDER && s[1] >= -BORDER && s[0] + s[1] <= 1.0 + BORDER,
        _ => s[0].abs() <= 1.0 + BORDER && s[1].abs() <= 1.0 + BORDER,
    }
}

/// The coordinates of a closest point on a face.
fn coordinates(found: &Projection) -> Local {
    let mut s = [0.0; 3];
    s.iter_mut().zip(found.closest.b.parameters()).for_each(|(s, p)| *s = *p);
    s
}

/// A face as a shape of `geometry`, with the same coordinates.
fn shape<const D: usize>(face: &Face<D>, points: &[Point<3>]) -> Result<Shape, ShapeError> {
    if let Some(basis) = face.spline.as_ref().and_then(|spline| spline.map.rational()) {
        return span(basis, points);
    }
    Ok(match face.shape {
        CellShape::Line => Curve::lagrange(points)?.into(),
        CellShape::Triangle => signorini_geometry::shape::Surface::lagrange_triangle(points)?.into(),
        _ => {
            let grid: Vec<Vec<Point<3>>> = points.chunks(face.order + 1).map(<[_]>::to_vec).collect();
            signorini_geometry::shape::Surface::lagrange_quad(&grid)?.into()
        }
    })
}

/// A span of a spline with these control points, as a rational Bézier shape over the coordinates of the face.
fn span(basis: &RationalBasis, points: &[Point<3>]) -> Result<Shape, ShapeError> {
    let p = basis.degree();
    let knots: Vec<f64> = [vec![-1.0; p + 1], vec![1.0; p + 1]].concat();
    let values: Vec<[f64; 3]> = points.iter().map(|x| [x[0], x[1], x[2]]).collect();
    let (points, weights) = basis.bezier(&values);
    let points: Vec<Point<3>> = points.into_iter().map(Point::<3>::from).collect();
    if basis.shape() == CellShape::Line {
        return Ok(Curve::nurbs(p, &knots, &points, Some(&weights), false)?.into());
    }
    let row = |i: usize| (0..=p).map(move |j| i + j * (p + 1));
    let grid: Vec<Vec<Point<3>>> = (0..=p).map(|i| row(i).map(|k| points[k]).collect()).collect();
    let weights: Vec<Vec<f64>> = (0..=p).map(|i| row(i).map(|k| weights[k]).collect()).collect();
    let surface =
        signorini_geometry::shape::Surface::nurbs([p; 2], [&knots, &knots], &grid, Some(&weights), [false; 2])?;
    Ok(surface.into())
}
