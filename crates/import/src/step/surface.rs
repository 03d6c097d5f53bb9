//! Surfaces of faces.

use super::bspline::{Bspline, Weighted};
use super::curve::{WRAPPED, net, repeated};
use super::model::Entity;
use super::{StepError, StepFile};
use signorini_geometry::shape::{Axes, Surface};
use signorini_geometry::similarity::Similarity;
use signorini_geometry::trimmed::FaceSurface;
use signorini_geometry::{Aabb, Point, Vector};
use std::f64::consts::FRAC_PI_2;

/// A surface, and whether its normal is that of the file.
pub(super) type Oriented = (FaceSurface, bool);

const DAMAGED: &str = "export the file again: it is damaged";
/// Sizes of a surface within which points are the same.
const SAME: f64 = 1e-9;

impl StepFile {
    /// The surface of a face within a box.
    pub(super) fn surface(
        &self,
        id: u64,
        around: Option<Aabb<3>>,
        radians: f64,
        place: &Similarity,
    ) -> Result<Oriented, StepError> {
        let entity = self.behind(id, &[("RECTANGULAR_TRIMMED_SURFACE", 1)])?;
        let id = entity.id;
        let axes = || self.axes(entity.reference(1)?, place);
        Ok(match entity.name() {
            "PLANE" => (FaceSurface::Plane { axes: axes()? }, true),
            "CYLINDRICAL_SURFACE" => {
                (FaceSurface::Cylinder { axes: axes()?, radius: self.length(&entity, 2, place)? }, true)
            }
            "SPHERICAL_SURFACE" => {
                (FaceSurface::Sphere { axes: axes()?, radius: self.length(&entity, 2, place)? }, true)
            }
            "TOROIDAL_SURFACE" => {
                let (major, minor) = (self.length(&entity, 2, place)?, self.length(&entity, 3, place)?);
                if minor >= major {
                    let message = format!("the torus meets itself: its radii are {major} and {minor}");
                    return Err(entity.error(message, "let the CAD program convert it to B-splines"));
                }
                (FaceSurface::Torus { axes: axes()?, major, minor }, true)
            }
            "CONICAL_SURFACE" => (cone(&entity, axes()?, radians, around, place)?, true),
            "SURFACE_OF_LINEAR_EXTRUSION" => self.extruded(&entity, around, place)?,
            "SURFACE_OF_REVOLUTION" => self.revolved(&entity, around, place)?,
            _ => match self.bspline_surface(&entity, place)? {
                Some(found) => found,
                None => {
                    let valid = "PLANE, CYLINDRICAL_SURFACE, CONICAL_SURFACE, SPHERICAL_SURFACE, TOROIDAL_SURFACE, \
                                 B_SPLINE_SURFACE_WITH_KNOTS, SURFACE_OF_REVOLUTION, SURFACE_OF_LINEAR_EXTRUSION";
                    return Err(self.unknown(id, "surface", valid));
                }
            },
        })
    }

    fn bspline_surface(&self, entity: &Entity<'_>, place: &Similarity) -> Result<Option<Oriented>, StepError> {
        let id = entity.id;
        let (degree, points, k, with, first) = if entity.name() == "B_SPLINE_SURFACE_WITH_KNOTS" {
            ([entity.count(1)?, entity.count(2)?], *entity, 3, *entity, 8)
        } else if let (Some(surface), Some(with)) =
            (self.record(id, "B_SPLINE_SURFACE"), self.record(id, "B_SPLINE_SURFACE_WITH_KNOTS"))
        {
            ([surface.count(0)?, surface.count(1)?], surface, 2, with, 0)
        } else {
            return Ok(None);
        };
        let net = net(entity, &points, k, self.record(id, "RATIONAL_B_SPLINE_SURFACE"), place)?;
        let knots = [0, 1].map(|k| repeated(entity, &with.numbers(first + k)?, &with.numbers(first + 2 + k)?));
        let [u, v] = knots;
        spline(entity, degree, [u?, v?], net).map(Some)
    }

    fn extruded(
        &self,
        entity: &Entity<'_>,
        around: Option<Aabb<3>>,
        place: &Similarity,
    ) -> Result<Oriented, StepError> {
        let vector = entity.entity(2)?;
        let along = self.direction(vector.reference(1)?, place)?;
        let curve = self.behind(entity.reference(1)?, &WRAPPED)?;
        if curve.name() == "LINE" {
            let origin = self.point(curve.reference(1)?, place)?;
            let ex = self.direction(curve.entity(2)?.reference(1)?, place)?;
            let ez = ex.cross(&along).try_normalize(SAME);
            let ez = ez.ok_or_else(|| entity.error("a line is swept along itself", DAMAGED))?;
            let axes = Axes::new(origin, ex, ez.cross(&ex)).map_err(|e| entity.error(e.to_string(), DAMAGED))?;
            return Ok((FaceSurface::Plane { axes }, true));
        }
        let profile = self.profile(&curve, place)?;
        let Some(around) = around else { return Err(entity.error("a swept face without edges has no end", DAMAGED)) };
        // How far the face reaches along the direction, and the curve itself.
        let (near, far) = range(corners(&around).iter().map(|x| along.dot(x)));
        let (low, high) = range(profile.control.iter().map(|c| along.dot(&c.0)));
        let pad = SAME.sqrt() * (far - near + high - low);
        let ends = [near - high - pad, far - low + pad];
        let net = profile.control.iter().map(|(x, w)| ends.map(|v| (x + along * v, *w)).to_vec()).collect();
        let [from, to] = ends;
        spline(entity, [profile.degree, 1], [profile.knots, vec![from, from, to, to]], net)
    }

    fn revolved(
        &self,
        entity: &Entity<'_>,
        around: Option<Aabb<3>>,
        place: &Similarity,
    ) -> Result<Oriented, StepError> {
        let axis = entity.entity(2)?;
        let origin = self.point(axis.reference(1)?, place)?;
        let ez = match axis.reference(2) {
            Ok(id) => self.direction(id, place)?,
            Err(_) => place.direction(&Vector::<3>::z()),
        };
        let curve = self.behind(entity.reference(1)?, &WRAPPED)?;
        let profile = if curve.name() == "LINE" {
            // As much of the line as the face can need.
            let point = self.point(curve.reference(1)?, place)?;
            let along = self.direction(curve.entity(2)?.reference(1)?, place)?;
            return self.line_around(entity, [point, along], [origin, ez], around);
        } else {
            self.profile(&curve, place)?
        };
        // Of a whole turn of each point of the profile.
        let rows: Vec<Vec<Weighted>> = profile
            .control
            .iter()
            .map(|(x, w)| {
                let d = x - origin;
                let centre = origin + ez * ez.dot(&d);
                let a = x - centre;
                let circle = Bspline::ellipse(centre, a, ez.cross(&a));
                circle.control.into_iter().map(|(p, v)| (p, v * w)).collect()
            })
            .collect();
        let turns = Bspline::ellipse(Point::<3>::zeros(), Vector::<3>::x(), Vector::<3>::y()).knots;
        let net = (0..9).map(|i| rows.iter().map(|r| r[i]).collect()).collect();
        spline(entity, [2, profile.degree], [turns, profile.knots], net)
    }

    /// A line turned about an axis in one plane with it: a cylinder, a cone or a plane.
    fn line_around(
        &self,
        entity: &Entity<'_>,
        [point, along]: [Point<3>; 2],
        [origin, ez]: [Point<3>; 2],
        around: Option<Aabb<3>>,
    ) -> Result<Oriented, StepError> {
        let d = point - origin;
        let scale = d.norm().max(around.map_or(0.0, |b| b.size().norm()));
        let wrong = |e: signorini_geometry::shape::ShapeError| entity.error(e.to_string(), DAMAGED);
        let cross = ez.cross(&along);
        if cross.norm() > SAME && d.dot(&cross).abs() > SAME * scale {
            let help = "let the CAD program convert it to B-splines";
            return Err(entity.error("a line that turns about an axis askew is not read", help));
        }
        // A point off the axis, and the way out there.
        let off = |x: Point<3>| (x - origin) - ez * ez.dot(&(x - origin));
        let at = if off(point).norm() > SAME * scale { point } else { point + along * scale.max(1.0) };
        let radius = off(at).norm();
        if radius == 0.0 {
            return Err(entity.error("a line that turns about itself is no surface", DAMAGED));
        }
        let ex = off(at) / radius;
        let (outward, rising) = (ex.dot(&along), ez.dot(&along));
        let centre = origin + ez * ez.dot(&(at - origin));
        let axes = |origin: Point<3>, ez: Vector<3>| Axes::new(origin, ex, ez.cross(&ex)).map_err(wrong);
        // The normal of the file is that of the turn times the line.
        let normal = ez.cross(&ex).cross(&along);
        let (surface, own) = if outward.abs() <= SAME {
            (FaceSurface::Cylinder { axes: axes(centre, ez)?, radius }, ex)
        } else if rising.abs() <= SAME {
            (FaceSurface::Plane { axes: axes(centre, ez)? }, ez)
        } else {
            let apex = centre - ez * (radius * rising / outward);
            // The nappe of the face.
            let side = around.map_or(1.0, |b| if ez.dot(&(b.center() - apex)) < 0.0 { -1.0 } else { 1.0 });
            let half_angle = (outward / rising).abs().atan();
            let ez = ez * side;
            (FaceSurface::Cone { axes: axes(apex, ez)?, half_angle }, ex * half_angle.cos() - ez * half_angle.sin())
        };
        Ok((surface, normal.dot(&own) > 0.0))
    }

    /// The profile of a swept surface as B-splines.
    fn profile(&self, curve: &Entity<'_>, place: &Similarity) -> Result<Bspline, StepError> {
        let valid = "LINE, CIRCLE, ELLIPSE, B_SPLINE_CURVE_WITH_KNOTS";
        self.bspline(curve.id, place)?.ok_or_else(|| self.unknown(curve.id, "profile", valid))
    }
}

fn cone(
    entity: &Entity<'_>,
    axes: Axes,
    radians: f64,
    around: Option<Aabb<3>>,
    place: &Similarity,
) -> Result<FaceSurface, StepError> {
    let (radius, half_angle) = (entity.number(2)? * place.factor, entity.number(3)? * radians);
    if half_angle.is_nan() || half_angle <= 0.0 || half_angle >= FRAC_PI_2 || radius < 0.0 {
        return Err(entity.error(format!("its half angle is {half_angle}, its radius {radius}"), DAMAGED));
    }
    let apex = axes.origin - axes.ez * (radius / half_angle.tan());
    // The surface has two nappes; a face lies on one of them.
    let axes = match around {
        Some(around) if axes.ez.dot(&(around.center() - apex)) < 0.0 => {
            Axes::new(apex, axes.ex, -axes.ey).map_err(|e| entity.error(e.to_string(), DAMAGED))?
        }
        _ => Axes { origin: apex, ..axes },
    };
    Ok(FaceSurface::Cone { axes, half_angle })
}

fn corners(b: &Aabb<3>) -> [Point<3>; 8] {
    std::array::from_fn(|k| Point::<3>::from_fn(|i, _| if k >> i & 1 == 0 { b.min[i] } else { b.max[i] }))
}

fn range(values: impl Iterator<Item = f64>) -> (f64, f64) {
    values.fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(x), b.max(x)))
}

/// A surface of B-splines, closed where its ends meet. A side that is one point is made one of `v`.
fn spline(
    entity: &Entity<'_>,
    degree: [usize; 2],
    knots: [Vec<f64>; 2],
    net: Vec<Vec<Weighted>>,
) -> Result<Oriented, StepError> {
    let columns = net.first().map_or(0, Vec::len);
    if columns == 0 || net.iter().any(|r| r.len() != columns) {
        return Err(entity.error("rows of points have different lengths", DAMAGED));
    }
    let all = net.iter().flatten().map(|c| c.0);
    let size = Aabb::around(all).map_or(0.0, |b| b.size().norm());
    let near = |a: &Point<3>, b: &Point<3>| (a - b).norm() <= SAME * size;
    let is_point = |row: &[Weighted]| row.iter().all(|c| near(&c.0, &row[0].0));
    if is_point(&net[0]) || is_point(&net[net.len() - 1]) {
        let turned = (0..columns).map(|j| net.iter().map(|r| r[j]).collect()).collect();
        let [u, v] = knots;
        let [p, q] = degree;
        let column = |j: usize| net.iter().map(|r| r[j]).collect::<Vec<_>>();
        if is_point(&column(0)) || is_point(&column(columns - 1)) {
            let help = "split the face in the CAD program";
            return Err(entity.error("sides of both directions are single points", help));
        }
        let (surface, is_same) = spline(entity, [q, p], [v, u], turned)?;
        return Ok((surface, !is_same));
    }
    let same = |a: &Weighted, b: &Weighted| near(&a.0, &b.0);
    let closed = [
        net[0].iter().zip(&net[net.len() - 1]).all(|(a, b)| same(a, b)),
        net.iter().all(|r| same(&r[0], &r[columns - 1])),
    ];
    let points: Vec<Vec<Point<3>>> = net.iter().map(|r| r.iter().map(|c| c.0).collect()).collect();
    let weights: Vec<Vec<f64>> = net.iter().map(|r| r.iter().map(|c| c.1).collect()).collect();
    let made = |closed| Surface::nurbs(degree, [&knots[0], &knots[1]], &points, Some(&weights), closed);
    // Ends that meet with other weights, or not all along, are no closed surface.
    let surface = made(closed).or_else(|_| made([false; 2])).map_err(|e| entity.error(e.to_string(), DAMAGED))?;
    Ok((FaceSurface::Spline(Box::new(surface)), true))
}
