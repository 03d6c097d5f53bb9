//! Curves in space.

use std::f64::consts::FRAC_PI_2;

use super::error::{Axes, ShapeError, interval, knots, number, position, positive, weight};
use crate::patch::bernstein::{Control, MAX_DEGREE, bezier_spans, cut, interpolate};
use crate::patch::weights::{even, even_middle, uneven};
use crate::patch::{Atlas, Border, Chart, CurveChart, ParameterMap, Piece, Side};
use crate::scale::same_direction;
use crate::{Point, Vector};

/// Position and derivatives to third order with respect to the parameter.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveJet {
    pub x: Point<3>,
    pub d1: Vector<3>,
    pub d2: Vector<3>,
    pub d3: Vector<3>,
}

/// What closed forms need to know of a curve.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum CurveKind {
    Segment { p0: Point<3>, p1: Point<3> },
    Circle { axes: Axes, radius: f64 },
    Ellipse { axes: Axes, a: f64, b: f64 },
    Other,
}

/// A curve with a parameter interval, open or closed.
#[derive(Clone, Debug)]
pub struct Curve {
    pub(crate) kind: CurveKind,
    pub(crate) atlas: Atlas<1, CurveChart>,
    domain: [f64; 2],
    closed: bool,
}

/// A smooth part of a curve under construction.
struct Part {
    from: f64,
    to: f64,
    /// See [`ParameterMap::Projective`].
    ratio: f64,
    chart: CurveChart,
    /// Whether only continuity is known where it ends.
    may_turn: bool,
}

impl Curve {
    fn assemble(kind: CurveKind, parts: Vec<Part>, closed: bool) -> Self {
        let n = parts.len();
        let mut creases = 0;
        let mut ends = Vec::with_capacity(n);
        for k in 0..n {
            let side = if k + 1 == n && !closed {
                Side::Boundary(Border::End)
            } else if (k + 1 == n || parts[k].may_turn) && turns(&parts[k], &parts[(k + 1) % n]) {
                creases += 1;
                Side::Crease(creases - 1)
            } else {
                Side::Smooth
            };
            ends.push(side);
        }
        let domain = [parts[0].from, parts[n - 1].to];
        let pieces = parts
            .into_iter()
            .enumerate()
            .map(|(k, part)| {
                let start = match k {
                    0 if closed => ends[n - 1],
                    0 => Side::Boundary(Border::Start),
                    _ => ends[k - 1],
                };
                let map = ParameterMap::Projective { low: [part.from], high: [part.to], ratio: [part.ratio] };
                Piece::new(part.chart, map, [[start, ends[k]]])
            })
            .collect();
        Curve { kind, atlas: Atlas::new(pieces), domain, closed }
    }

    /// `p0 + t (p1 - p0)`, `t` in `[0, 1]`; both ends may coincide.
    ///
    /// # Errors
    /// Coordinates that are not finite.
    pub fn segment(p0: Point<3>, p1: Point<3>) -> Result<Self, ShapeError> {
        position("p0", &p0)?;
        position("p1", &p1)?;
        let parts = bezier_parts(0.0, 1.0, &[homogeneous(&p0, 1.0), homogeneous(&p1, 1.0)], true);
        Ok(Self::assemble(CurveKind::Segment { p0, p1 }, parts, false))
    }

    /// Straight lines from point to point, `t` in `[0, n - 1]`; a closed one returns to its first point.
    ///
    /// # Errors
    /// Fewer than two points, or coordinates that are not finite.
    pub fn polyline(points: &[Point<3>], closed: bool) -> Result<Self, ShapeError> {
        if points.len() < 2 {
            return Err(ShapeError::new("points", format!("{} given, but a polyline needs two", points.len())));
        }
        for p in points {
            position("points", p)?;
        }
        let last = if closed { points.len() } else { points.len() - 1 };
        let parts = (0..last)
            .flat_map(|k| {
                let (p, q) = (&points[k], &points[(k + 1) % points.len()]);
                bezier_parts(k as f64, (k + 1) as f64, &[homogeneous(p, 1.0), homogeneous(q, 1.0)], true)
            })
            .collect();
        Ok(Self::assemble(CurveKind::Other, parts, closed))
    }

    fn harmonic(
        kind: CurveKind,
        origin: Point<3>,
        [a, b, c]: [Vector<3>; 3],
        range: [f64; 2],
        closed: bool,
    ) -> Result<Self, ShapeError> {
        let range = interval("range", range)?;
        let count = ((range[1] - range[0]) / FRAC_PI_2 - 1e-9).ceil().max(1.0);
        if count > 1e6 {
            return Err(ShapeError::new("range", "more than 250 000 turns"));
        }
        let count = count as usize;
        let at =
            |k: usize| if k == count { range[1] } else { range[0] + (range[1] - range[0]) * k as f64 / count as f64 };
        let parts = (0..count)
            .map(|k| {
                let (from, to) = (at(k), at(k + 1));
                let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
                let chart = CurveChart::Harmonic { origin, a, b, c, middle, half };
                Part { from, to, ratio: 1.0, chart, may_turn: false }
            })
            .collect();
        Ok(Self::assemble(kind, parts, closed))
    }

    /// `o + r cos t ex + r sin t ey`.
    ///
    /// # Errors
    /// A radius that is not positive, or an empty range.
    pub fn circle(axes: Axes, radius: f64, range: [f64; 2], closed: bool) -> Result<Self, ShapeError> {
        positive("r", radius)?;
        closed_range(range, closed)?;
        let vectors = [axes.ex * radius, axes.ey * radius, Vector::<3>::zeros()];
        Self::harmonic(CurveKind::Circle { axes, radius }, axes.origin, vectors, range, closed)
    }

    /// `o + a cos t ex + b sin t ey`.
    ///
    /// # Errors
    /// A semi-axis that is not positive, or an empty range.
    pub fn ellipse(axes: Axes, a: f64, b: f64, range: [f64; 2], closed: bool) -> Result<Self, ShapeError> {
        positive("a", a)?;
        positive("b", b)?;
        closed_range(range, closed)?;
        Self::harmonic(
            CurveKind::Ellipse { axes, a, b },
            axes.origin,
            [axes.ex * a, axes.ey * b, Vector::<3>::zeros()],
            range,
            closed,
        )
    }

    /// `o + t ex + k t² ey`.
    ///
    /// # Errors
    /// Numbers that are not finite, or an empty range.
    pub fn parabola(axes: Axes, k: f64, range: [f64; 2]) -> Result<Self, ShapeError> {
        number("k", k)?;
        let [from, to] = interval("range", range)?;
        let at = |t: f64| axes.origin + axes.ex * t + axes.ey * (k * t * t);
        let middle = axes.origin + axes.ex * (0.5 * (from + to)) + axes.ey * (k * from * to);
        let control = [at(from), middle, at(to)].map(|p| homogeneous(&p, 1.0));
        Ok(Self::assemble(CurveKind::Other, bezier_parts(from, to, &control, true), false))
    }

    /// `o + r cos t ex + r sin t ey + c t ez`.
    ///
    /// # Errors
    /// A radius that is not positive, or an empty range.
    pub fn helix(axes: Axes, radius: f64, c: f64, range: [f64; 2]) -> Result<Self, ShapeError> {
        positive("r", radius)?;
        number("c", c)?;
        let vectors = [axes.ex * radius, axes.ey * radius, axes.ez * c];
        Self::harmonic(CurveKind::Other, axes.origin, vectors, range, false)
    }

    /// A Bezier curve over `[0, 1]`, rational with weights.
    ///
    /// # Errors
    /// Too few or too many points, weights that are not positive.
    pub fn bezier(control_points: &[Point<3>], weights: Option<&[f64]>) -> Result<Self, ShapeError> {
        let degree = control_points.len().wrapping_sub(1);
        if degree == 0 || degree > MAX_DEGREE {
            return Err(ShapeError::new(
                "control_points",
                format!("{} given, valid are 2 to {}", control_points.len(), MAX_DEGREE + 1),
            ));
        }
        let control = controls(control_points, weights)?;
        Ok(Self::assemble(CurveKind::Other, bezier_parts(0.0, 1.0, &control, true), false))
    }

    /// A B-spline, rational with weights, over `[knots[p], knots[n]]`. A closed one has no ends: its parameter is
    /// periodic, and where its tangents do not agree at the seam there is a vertex.
    ///
    /// # Errors
    /// Knots that decrease or do not fit the control points, weights that are not positive, a closed curve whose ends
    /// do not meet.
    pub fn nurbs(
        degree: usize,
        knot_vector: &[f64],
        control_points: &[Point<3>],
        weights: Option<&[f64]>,
        closed: bool,
    ) -> Result<Self, ShapeError> {
        knots("knots", degree, knot_vector, control_points.len())?;
        let control = controls(control_points, weights)?;
        let spans = bezier_spans(degree, knot_vector, &control);
        let parts: Vec<Part> = spans
            .iter()
            .flat_map(|s| bezier_parts(s.from, s.to, &s.control, s.multiplicity_at_end >= degree))
            .collect();
        let curve = Self::assemble(CurveKind::Other, parts, closed);
        if closed {
            let last = curve.atlas.pieces.len() - 1;
            let pieces = &curve.atlas.pieces;
            let gap = pieces[0].chart.position(&[-1.0]) - pieces[last].chart.position(&[1.0]);
            if gap.norm() > 1e-9 * (curve.atlas.size + curve.atlas.magnitude) {
                return Err(ShapeError::new("closed", "the ends of the curve do not meet"));
            }
        }
        Ok(curve)
    }

    /// An edge of a finite element through equidistant nodes in order, `t` in `[-1, 1]`.
    ///
    /// # Errors
    /// Fewer than two nodes or more than 16.
    pub fn lagrange(nodes: &[Point<3>]) -> Result<Self, ShapeError> {
        let degree = nodes.len().wrapping_sub(1);
        if degree == 0 || degree > MAX_DEGREE {
            return Err(ShapeError::new("nodes", format!("{} given, valid are 2 to {}", nodes.len(), MAX_DEGREE + 1)));
        }
        let values = controls(nodes, None).map_err(|e| ShapeError::new("nodes", e.message))?;
        let control = interpolate(degree, &values);
        Ok(Self::assemble(CurveKind::Other, bezier_parts(-1.0, 1.0, &control, true), false))
    }

    /// Cubic pieces through points with given tangents (derivatives with respect to `t`), `t` in `[0, n - 1]`.
    ///
    /// # Errors
    /// Fewer than two points, or as many tangents as points missing.
    pub fn hermite(points: &[Point<3>], tangents: &[Vector<3>]) -> Result<Self, ShapeError> {
        if points.len() < 2 {
            return Err(ShapeError::new("points", format!("{} given, but a curve needs two", points.len())));
        }
        if points.len() != tangents.len() {
            return Err(ShapeError::new("tangents", format!("{} for {} points", tangents.len(), points.len())));
        }
        for (p, t) in points.iter().zip(tangents) {
            position("points", p)?;
            position("tangents", t)?;
        }
        let parts = (0..points.len() - 1)
            .flat_map(|k| {
                let (p, q) = (points[k], points[k + 1]);
                let control = [p, p + tangents[k] / 3.0, q - tangents[k + 1] / 3.0, q].map(|x| homogeneous(&x, 1.0));
                bezier_parts(k as f64, (k + 1) as f64, &control, true)
            })
            .collect();
        Ok(Self::assemble(CurveKind::Other, parts, false))
    }

    /// The curve in other coordinates.
    pub(crate) fn with(&self, kind: CurveKind, pieces: Vec<Piece<1, CurveChart>>) -> Self {
        Curve { kind, atlas: Atlas::new(pieces), ..*self }
    }

    /// The parameter interval.
    pub fn domain(&self) -> [f64; 2] {
        self.domain
    }

    /// Whether the parameter is periodic.
    pub fn is_closed(&self) -> bool {
        self.closed
    }

    /// Diagonal of the bounding box.
    pub fn size(&self) -> f64 {
        self.atlas.size
    }

    /// The piece in which a parameter lies, and its local parameter.
    pub(crate) fn locate(&self, t: f64) -> (usize, f64) {
        let t = wrap(t, self.domain, self.closed);
        let pieces = &self.atlas.pieces;
        let k = pieces.partition_point(|p| p.map.interval(0).from <= t).clamp(1, pieces.len()) - 1;
        (k, pieces[k].map.interval(0).local(t))
    }

    /// Position and derivatives; parameters outside the domain are wrapped where the curve is closed, else clamped.
    pub fn jet(&self, t: f64) -> CurveJet {
        let (piece, s) = self.locate(t);
        let Piece { chart, map, .. } = &self.atlas.pieces[piece];
        let [p, q, r] = map.interval(0).derivatives(map.apply(&[s])[0]);
        let [x, d1, d2, d3] = chart.jet3(s);
        CurveJet { x, d1: d1 * p, d2: d2 * (p * p) + d1 * q, d3: d3 * (p * p * p) + d2 * (3.0 * p * q) + d1 * r }
    }

    /// Position.
    pub fn position(&self, t: f64) -> Point<3> {
        self.jet(t).x
    }
}

pub(crate) fn wrap(t: f64, [from, to]: [f64; 2], closed: bool) -> f64 {
    if closed && !(from..=to).contains(&t) { from + (t - from).rem_euclid(to - from) } else { t.clamp(from, to) }
}

pub(crate) fn homogeneous(p: &Point<3>, w: f64) -> Control {
    [p.x * w, p.y * w, p.z * w, w]
}

pub(crate) fn controls(points: &[Point<3>], weights: Option<&[f64]>) -> Result<Vec<Control>, ShapeError> {
    if let Some(w) = weights
        && w.len() != points.len()
    {
        return Err(ShapeError::new("weights", format!("{} for {} control points", w.len(), points.len())));
    }
    points
        .iter()
        .enumerate()
        .map(|(k, p)| {
            position("control_points", p)?;
            let w = weights.map_or(Ok(1.0), |w| weight(w[k]))?;
            Ok(homogeneous(p, w))
        })
        .collect()
}

/// A full turn that claims to be closed must be one.
pub(crate) fn closed_range(range: [f64; 2], closed: bool) -> Result<(), ShapeError> {
    let turn = std::f64::consts::TAU;
    if (range[1] - range[0]) > turn * (1.0 + 1e-12) {
        return Err(ShapeError::new("range", "more than a full turn"));
    }
    if closed && ((range[1] - range[0]) - turn).abs() > 1e-12 * turn {
        return Err(ShapeError::new("closed", "a closed angle needs a range of 2 pi"));
    }
    Ok(())
}

/// Cuts a Bezier curve until its powers decay and its weights are even.
fn bezier_parts(from: f64, to: f64, control: &[Control], may_turn: bool) -> Vec<Part> {
    cut_parts(from, to, control, may_turn, 0)
}

fn cut_parts(from: f64, to: f64, control: &[Control], may_turn: bool, depth: u32) -> Vec<Part> {
    let (even, ratio) = even(control);
    let t = even_middle(ratio);
    let middle = from + (to - from) * t;
    let resolved = (middle - from).min(to - middle) > 32.0 * f64::EPSILON * from.abs().max(to.abs());
    if resolved && depth < DEEPEST && (is_high(control.len() - 1, depth) || uneven(&even)) {
        let [left, right] = cut(control, t);
        let mut parts = cut_parts(from, middle, &left, false, depth + 1);
        parts.extend(cut_parts(middle, to, &right, may_turn, depth + 1));
        return parts;
    }
    vec![Part { from, to, ratio, chart: CurveChart::bezier(&even), may_turn }]
}

/// Cuts one in another that no weights need.
pub(crate) const DEEPEST: u32 = 8;

/// Whether powers of this degree decay too slowly after so many cuts: six of them may count in a piece.
pub(crate) fn is_high(degree: usize, depth: u32) -> bool {
    degree > 6 && 6 * (1usize << depth) < 2 * degree
}

/// Whether the tangent jumps between two consecutive parts.
fn turns(left: &Part, right: &Part) -> bool {
    let (p, q) = (left.chart.jet3(1.0)[1], right.chart.jet3(-1.0)[1]);
    !same_direction(&p, &q)
}
