//! Points, directions and curves.

use super::bspline::Bspline;
use super::model::{Entity, numbers, references};
use super::{StepError, StepFile};
use signorini_geometry::closest::{Query, closest};
use signorini_geometry::shape::{Axes, Curve, Shape};
use signorini_geometry::similarity::Similarity;
use signorini_geometry::{Point, Vector};
use std::f64::consts::TAU;

const DAMAGED: &str = "export the file again: it is damaged";
/// Curves that are others with more said of them.
pub(super) const WRAPPED: [(&str, usize); 4] =
    [("SURFACE_CURVE", 1), ("SEAM_CURVE", 1), ("INTERSECTION_CURVE", 1), ("TRIMMED_CURVE", 1)];
/// Parameters, in parts of a period or a domain, that are the same.
const SAME: f64 = 1e-9;

impl StepFile {
    pub(super) fn point(&self, id: u64, place: &Similarity) -> Result<Point<3>, StepError> {
        let entity = self.entity(id)?;
        match entity.numbers(1)?[..] {
            [x, y, z] if entity.name() == "CARTESIAN_POINT" => Ok(place.point(&Point::<3>::new(x, y, z))),
            _ => Err(entity.error("it is no point in space", DAMAGED)),
        }
    }

    pub(super) fn direction(&self, id: u64, place: &Similarity) -> Result<Vector<3>, StepError> {
        let entity = self.entity(id)?;
        let list = entity.numbers(1)?;
        let found = match list[..] {
            [x, y, z] => Vector::<3>::new(x, y, z).try_normalize(f64::MIN_POSITIVE),
            _ => None,
        };
        found.map(|e| place.direction(&e)).ok_or_else(|| entity.error("it is no direction in space", DAMAGED))
    }

    /// Origin and axes of a placement; those left out are as the standard says.
    pub(super) fn axes(&self, id: u64, place: &Similarity) -> Result<Axes, StepError> {
        let entity = self.entity(id)?;
        if entity.name() != "AXIS2_PLACEMENT_3D" {
            return Err(self.unknown(id, "placement", "AXIS2_PLACEMENT_3D"));
        }
        let origin = self.point(entity.reference(1)?, place)?;
        let stated = |k: usize, otherwise: Vector<3>| match entity.reference(k) {
            Ok(id) => self.direction(id, place),
            Err(_) => Ok(place.direction(&otherwise)),
        };
        let ez = stated(2, Vector::<3>::z())?;
        let towards = stated(3, Vector::<3>::x())?;
        let across = |v: Vector<3>| (v - ez * ez.dot(&v)).try_normalize(1e-9);
        let ex = across(towards)
            .or_else(|| across(place.direction(&Vector::<3>::x())))
            .or_else(|| across(place.direction(&Vector::<3>::y())))
            .ok_or_else(|| entity.error("its axes are parallel", DAMAGED))?;
        Axes::new(origin, ex, ez.cross(&ex)).map_err(|e| entity.error(e.to_string(), DAMAGED))
    }

    /// A curve as B-splines: those of files, and whole circles and ellipses; none of others.
    pub(super) fn bspline(&self, id: u64, place: &Similarity) -> Result<Option<Bspline>, StepError> {
        let entity = self.entity(id)?;
        match entity.name() {
            "CIRCLE" => {
                let (axes, r) = (self.axes(entity.reference(1)?, place)?, self.length(&entity, 2, place)?);
                return Ok(Some(Bspline::ellipse(axes.origin, axes.ex * r, axes.ey * r)));
            }
            "ELLIPSE" => {
                let axes = self.axes(entity.reference(1)?, place)?;
                let (a, b) = (self.length(&entity, 2, place)?, self.length(&entity, 3, place)?);
                return Ok(Some(Bspline::ellipse(axes.origin, axes.ex * a, axes.ey * b)));
            }
            _ => {}
        }
        // Alone, or as parts of a complex instance.
        let (degree, points, multiplicities, knots) = if entity.name() == "B_SPLINE_CURVE_WITH_KNOTS" {
            (entity.count(1)?, entity.references(2)?, entity.numbers(6)?, entity.numbers(7)?)
        } else if let (Some(curve), Some(with)) =
            (self.record(id, "B_SPLINE_CURVE"), self.record(id, "B_SPLINE_CURVE_WITH_KNOTS"))
        {
            (curve.count(0)?, curve.references(1)?, with.numbers(0)?, with.numbers(1)?)
        } else {
            return Ok(None);
        };
        let weights = match self.record(id, "RATIONAL_B_SPLINE_CURVE") {
            Some(rational) => rational.numbers(0)?,
            None => vec![1.0; points.len()],
        };
        if weights.len() != points.len() {
            return Err(entity.error(format!("{} weights for {} points", weights.len(), points.len()), DAMAGED));
        }
        let points = points.iter().map(|p| self.point(*p, place)).collect::<Result<Vec<_>, _>>()?;
        let knots = repeated(&entity, &multiplicities, &knots)?;
        let out = Bspline { degree, knots, control: points.into_iter().zip(weights).collect() };
        self.curve_of(&entity, &out)?;
        Ok(Some(out))
    }

    fn curve_of(&self, entity: &Entity<'_>, b: &Bspline) -> Result<Curve, StepError> {
        Curve::nurbs(b.degree, &b.knots, &b.points(), Some(&b.weights()), false)
            .map_err(|e| entity.error(e.to_string(), DAMAGED))
    }

    /// A positive length.
    pub(super) fn length(&self, entity: &Entity<'_>, k: usize, place: &Similarity) -> Result<f64, StepError> {
        match entity.number(k)? {
            x if x > 0.0 => Ok(x * place.factor),
            x => Err(entity.error(format!("the length {x} is not positive"), DAMAGED)),
        }
    }

    /// The part of a curve between two points of it, in the direction of its parameter, and whether that is from the first to
    /// the second. Between one and the same point it is the whole of a closed curve.
    pub(super) fn edge_curve(
        &self,
        id: u64,
        [from, to]: [Point<3>; 2],
        is_closed: bool,
        forward: bool,
        place: &Similarity,
    ) -> Result<(Curve, bool), StepError> {
        let entity = self.behind(id, &WRAPPED)?;
        let id = entity.id;
        let wrong = |e: signorini_geometry::shape::ShapeError| entity.error(e.to_string(), DAMAGED);
        let [first, last] = if forward { [from, to] } else { [to, from] };
        // Of a turn from one angle to the next.
        let turn = |[a, b]: [f64; 2]| {
            let mut d = (b - a).rem_euclid(TAU);
            if is_closed || d <= SAME {
                d = TAU;
            }
            [a, a + d]
        };
        match entity.name() {
            "LINE" => {
                if is_closed {
                    return Err(entity.error("an edge on a line ends where it begins", DAMAGED));
                }
                return Ok((Curve::segment(from, to).map_err(wrong)?, true));
            }
            "CIRCLE" => {
                let axes = self.axes(entity.reference(1)?, place)?;
                let radius = self.length(&entity, 2, place)?;
                let angle = |x: &Point<3>| axes.local(x).y.atan2(axes.local(x).x);
                let range = turn([angle(&first), angle(&last)]);
                return Ok((Curve::circle(axes, radius, range, false).map_err(wrong)?, forward));
            }
            "ELLIPSE" => {
                let axes = self.axes(entity.reference(1)?, place)?;
                let (a, b) = (self.length(&entity, 2, place)?, self.length(&entity, 3, place)?);
                let angle = |x: &Point<3>| (axes.local(x).y / b).atan2(axes.local(x).x / a);
                let range = turn([angle(&first), angle(&last)]);
                return Ok((Curve::ellipse(axes, a, b, range, false).map_err(wrong)?, forward));
            }
            _ => {}
        }
        let Some(whole) = self.bspline(id, place)? else {
            return Err(self.unknown(id, "curve", "LINE, CIRCLE, ELLIPSE, B_SPLINE_CURVE_WITH_KNOTS"));
        };
        let [low, high] = whole.domain();
        let curve = self.curve_of(&entity, &whole)?;
        if is_closed {
            return Ok((curve, forward));
        }
        let shape: Shape = curve.clone().into();
        let parameter = |x: &Point<3>| {
            let found = closest(&Shape::Point(*x), &shape, &Query::default()).closest;
            let t = found.b.parameters().first().copied().unwrap_or(low);
            // The ends themselves, where the vertex is there.
            [low, high].into_iter().find(|end| (t - end).abs() <= SAME * (high - low)).unwrap_or(t)
        };
        let (mut a, mut b) = (parameter(&first), parameter(&last));
        let meets = (curve.position(low) - curve.position(high)).norm() <= SAME * curve.size();
        if meets && a == high {
            a = low;
        }
        if meets && b == low {
            b = high;
        }
        let part = match (a, b) {
            (a, b) if a == low && b == high => return Ok((curve, forward)),
            (a, b) if a < b => whole.part(a, b),
            (a, b) if meets && a > b => whole.part(a, high).followed_by(&whole.part(low, b)),
            _ => return Err(entity.error("the vertices of an edge lie on it in the wrong order", DAMAGED)),
        };
        Ok((self.curve_of(&entity, &part)?, forward))
    }
}

/// Knots as often as they are said to be there.
pub(super) fn repeated(entity: &Entity<'_>, multiplicities: &[f64], knots: &[f64]) -> Result<Vec<f64>, StepError> {
    // More than the largest degree and one are none.
    let fits = multiplicities.iter().all(|m| m.fract() == 0.0 && (1.0..=64.0).contains(m));
    if multiplicities.len() != knots.len() || !fits {
        return Err(entity.error("knots and their multiplicities do not fit", DAMAGED));
    }
    Ok(multiplicities.iter().zip(knots).flat_map(|(m, k)| std::iter::repeat_n(*k, *m as usize)).collect())
}

/// A net of points, the first direction slowest, with weights.
pub(super) fn net(
    entity: &Entity<'_>,
    points: &Entity<'_>,
    k: usize,
    weights: Option<Entity<'_>>,
    place: &Similarity,
) -> Result<Vec<Vec<(Point<3>, f64)>>, StepError> {
    let rows = points.rows(k, references)?;
    let weights = match weights {
        Some(rational) => rational.rows(0, numbers)?,
        None => rows.iter().map(|r| vec![1.0; r.len()]).collect(),
    };
    if rows.len() != weights.len() || rows.iter().zip(&weights).any(|(r, w)| r.len() != w.len()) {
        return Err(entity.error("points and weights do not fit", DAMAGED));
    }
    let row = |(row, weights): (&Vec<u64>, &Vec<f64>)| {
        row.iter()
            .zip(weights)
            .map(|(p, w)| Ok((entity.file.point(*p, place)?, *w)))
            .collect::<Result<Vec<_>, StepError>>()
    };
    rows.iter().zip(&weights).map(row).collect()
}
