//! Surfaces in space.

mod element;
mod elementary;
mod grid;
mod spline;

use super::curve::{CurveJet, wrap};
use super::error::Axes;
use crate::patch::{Atlas, Border, Chart, Jet3, ParameterMap, Piece, Side, SurfaceChart};
use crate::scale::{direction, same_direction};
use crate::{Point, Vector};

/// Position and partial derivatives to third order with respect to the parameters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceJet {
    pub x: Point<3>,
    pub u: Vector<3>,
    pub v: Vector<3>,
    pub uu: Vector<3>,
    pub uv: Vector<3>,
    pub vv: Vector<3>,
    pub uuu: Vector<3>,
    pub uuv: Vector<3>,
    pub uvv: Vector<3>,
    pub vvv: Vector<3>,
}

impl SurfaceJet {
    /// A curve in the plane as a strip along z, as wide as the curve is fast.
    pub fn strip(curve: &CurveJet) -> Self {
        let zero = Vector::<3>::zeros();
        SurfaceJet {
            x: curve.x,
            u: curve.d1,
            v: Vector::<3>::z() * curve.d1.norm(),
            uu: curve.d2,
            uuu: curve.d3,
            uv: zero,
            vv: zero,
            uuv: zero,
            uvv: zero,
            vvv: zero,
        }
    }
}

/// What closed forms need to know of a surface.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum SurfaceKind {
    Plane { axes: Axes },
    Cylinder { axes: Axes, radius: f64 },
    Cone { axes: Axes, sin: f64, cos: f64 },
    Sphere { axes: Axes, radius: f64 },
    Ellipsoid { axes: Axes, semi_axes: [f64; 3] },
    Torus { axes: Axes, major: f64, minor: f64 },
    Triangle { nodes: [Point<3>; 3] },
    Other,
}

impl SurfaceKind {
    /// Which parameters are lengths.
    pub fn length_parameters(&self) -> [bool; 2] {
        match self {
            SurfaceKind::Plane { .. } => [true; 2],
            SurfaceKind::Cylinder { .. } | SurfaceKind::Cone { .. } => [false, true],
            _ => [false; 2],
        }
    }
}

/// A surface with its parameter domain: a rectangle, periodic or not in either direction, or the unit triangle.
#[derive(Clone, Debug)]
pub struct Surface {
    pub(crate) kind: SurfaceKind,
    pub(crate) atlas: Atlas<2, SurfaceChart>,
    domain: [[f64; 2]; 2],
    closed: [bool; 2],
    /// Parameters at which the pieces meet, in both directions; empty for triangles.
    breaks: [Vec<f64>; 2],
    /// The one chart of a triangle, over the square around it.
    triangle: Option<SurfaceChart>,
}

/// Smooth parts of a surface on a grid of parameters.
struct Parts {
    breaks: [Vec<f64>; 2],
    /// Whether only continuity is known at the end of each interval.
    may_turn: [Vec<bool>; 2],
    /// Row by row, the second direction fastest.
    charts: Vec<SurfaceChart>,
    /// Of each chart, see [`ParameterMap::Projective`].
    ratios: Vec<[f64; 2]>,
}

impl Surface {
    fn assemble(kind: SurfaceKind, parts: Parts, closed: [bool; 2], smooth_poles: bool) -> Self {
        let Parts { breaks, may_turn, charts, ratios } = parts;
        let (n, m) = (breaks[0].len() - 1, breaks[1].len() - 1);
        let at = |i: usize, j: usize| &charts[i * m + j];
        let ratio = |i: usize, j: usize, axis: usize| ratios[i * m + j][axis];
        let size = charts.iter().map(|c| c.jet(&[0.0; 2]).d.iter().map(|d| d.norm()).sum::<f64>()).fold(0.0, f64::max);
        let mut creases = 0;
        // What lies at the end of every interval, for every piece along it.
        let mut ends: [Vec<Vec<Side>>; 2] = [Vec::new(), Vec::new()];
        for axis in 0..2 {
            let (count, across) = if axis == 0 { (n, m) } else { (m, n) };
            for k in 0..count {
                let last = k + 1 == count;
                let border = if axis == 0 { Border::U1 } else { Border::V1 };
                if last && !closed[axis] {
                    ends[axis].push(vec![Side::Boundary(border); across]);
                    continue;
                }
                let mut sides = vec![Side::Smooth; across];
                if last || may_turn[axis][k] {
                    let next = (k + 1) % count;
                    for (l, side) in sides.iter_mut().enumerate() {
                        let ((i, j), (p, q)) = if axis == 0 { ((k, l), (next, l)) } else { ((l, k), (l, next)) };
                        let shift = ratio(i, j, 1 - axis) / ratio(p, q, 1 - axis);
                        *side = meet(at(i, j), at(p, q), axis, shift, creases);
                    }
                    if sides.iter().any(|s| matches!(s, Side::Crease(_))) {
                        creases += 1;
                    }
                }
                ends[axis].push(sides);
            }
        }
        let mut pieces = Vec::with_capacity(charts.len());
        for i in 0..n {
            for j in 0..m {
                let mut sides = [[Side::Smooth; 2]; 2];
                for axis in 0..2 {
                    let (k, l, count) = if axis == 0 { (i, j, n) } else { (j, i, m) };
                    let border = if axis == 0 { Border::U0 } else { Border::V0 };
                    let low = match k {
                        0 if !closed[axis] => Side::Boundary(border),
                        0 => ends[axis][count - 1][l],
                        _ => ends[axis][k - 1][l],
                    };
                    sides[axis] = [low, ends[axis][k][l]];
                    for (which, side) in sides[axis].iter_mut().enumerate() {
                        if let Side::Boundary(border) = *side
                            && is_collapsed(at(i, j), axis, which == 1, size)
                        {
                            let pole =
                                smooth_poles && closed[1 - axis] || is_pole(&charts, n, m, axis, which == 1, closed);
                            *side = if pole { Side::Pole } else { Side::Collapsed(border) };
                        }
                    }
                }
                let map = ParameterMap::Projective {
                    low: [breaks[0][i], breaks[1][j]],
                    high: [breaks[0][i + 1], breaks[1][j + 1]],
                    ratio: ratios[i * m + j],
                };
                pieces.push(Piece::new(at(i, j).clone(), map, sides));
            }
        }
        let domain = [0, 1].map(|a| [breaks[a][0], *breaks[a].last().expect("two breaks at least")]);
        Surface { kind, atlas: Atlas::new(pieces), domain, closed, breaks, triangle: None }
    }

    /// The surface in other coordinates, in which parameters that are lengths are this many times as large.
    pub(crate) fn with(
        &self,
        kind: SurfaceKind,
        pieces: Vec<Piece<2, SurfaceChart>>,
        chart: impl Fn(&SurfaceChart) -> SurfaceChart,
        lengths: f64,
    ) -> Self {
        let factor = kind.length_parameters().map(|is_length| if is_length { lengths } else { 1.0 });
        Surface {
            kind,
            atlas: Atlas::new(pieces.into_iter().map(|p| Piece { map: p.map.scaled(factor), ..p }).collect()),
            domain: [0, 1].map(|k| self.domain[k].map(|t| t * factor[k])),
            closed: self.closed,
            breaks: [0, 1].map(|k| self.breaks[k].iter().map(|t| t * factor[k]).collect()),
            triangle: self.triangle.as_ref().map(chart),
        }
    }

    pub(crate) fn into_pieces(self) -> Vec<Piece<2, SurfaceChart>> {
        self.atlas.pieces
    }

    /// The ranges of both parameters; `[0, 1]` each for triangles.
    pub fn domain(&self) -> [[f64; 2]; 2] {
        self.domain
    }

    /// In which directions the parameter is periodic.
    pub fn closed(&self) -> [bool; 2] {
        self.closed
    }

    /// Whether the domain is the triangle `u, v >= 0`, `u + v <= 1`.
    pub fn is_triangle(&self) -> bool {
        self.triangle.is_some()
    }

    /// Diagonal of the bounding box.
    pub fn size(&self) -> f64 {
        self.atlas.size
    }

    /// Position and derivatives; parameters outside the domain are wrapped in closed directions, else clamped.
    pub fn jet(&self, u: f64, v: f64) -> SurfaceJet {
        if let Some(chart) = &self.triangle {
            let (u, v) = (u.clamp(0.0, 1.0), v.clamp(0.0, 1.0));
            return in_parameters(&chart.jet3(&[2.0 * u - 1.0, 2.0 * v - 1.0]), [[2.0, 0.0, 0.0]; 2]);
        }
        let (piece, s) = self.locate([u, v]);
        let Piece { chart, map, .. } = &self.atlas.pieces[piece];
        let z = map.apply(&s);
        in_parameters(&chart.jet3(&s), [0, 1].map(|k| map.interval(k).derivatives(z[k])))
    }

    /// The piece in which parameters lie, and its local parameters; not for triangles.
    pub(crate) fn locate(&self, z: [f64; 2]) -> (usize, [f64; 2]) {
        let t = [0, 1].map(|k| wrap(z[k], self.domain[k], self.closed[k]));
        let [i, j] = [0, 1].map(|k| {
            let breaks = &self.breaks[k];
            breaks.partition_point(|&b| b <= t[k]).clamp(1, breaks.len() - 1) - 1
        });
        let number = i * (self.breaks[1].len() - 1) + j;
        (number, [0, 1].map(|k| self.atlas.pieces[number].map.interval(k).local(t[k])))
    }

    /// Position.
    pub fn position(&self, u: f64, v: f64) -> Point<3> {
        self.jet(u, v).x
    }
}

/// A jet in the parameters of the surface, from the first three derivatives of the local ones.
fn in_parameters(j: &Jet3, [[p, p2, p3], [q, q2, q3]]: [[f64; 3]; 2]) -> SurfaceJet {
    let ([u, v], [uu, uv, vv], [uuu, uuv, uvv, vvv]) = (j.d, j.dd, j.ddd);
    SurfaceJet {
        x: j.x,
        u: u * p,
        v: v * q,
        uu: uu * (p * p) + u * p2,
        uv: uv * (p * q),
        vv: vv * (q * q) + v * q2,
        uuu: uuu * (p * p * p) + uu * (3.0 * p * p2) + u * p3,
        uuv: uuv * (p * p * q) + uv * (p2 * q),
        uvv: uvv * (p * q * q) + uv * (p * q2),
        vvv: vvv * (q * q * q) + vv * (3.0 * q * q2) + v * q3,
    }
}

/// How two consecutive pieces join, judged at several points of their common side, on which the ratio of the left one
/// is `shift` times that of the right one.
fn meet(left: &SurfaceChart, right: &SurfaceChart, axis: usize, shift: f64, number: u32) -> Side {
    let mut side = Side::Smooth;
    for k in 0..=8 {
        let s = -1.0 + 0.25 * k as f64;
        let (before, after) = (1.0 - s, shift * (1.0 + s));
        let (mut at, mut then) = ([s; 2], [(after - before) / (after + before); 2]);
        at[axis] = 1.0;
        then[axis] = -1.0;
        let (p, q) = (left.jet(&at), right.jet(&then));
        let (cross_p, cross_q) = (p.d[axis], q.d[axis]);
        if same_direction(&cross_p, &cross_q) {
            continue;
        }
        let (n, m) = (p.d[0].cross(&p.d[1]), q.d[0].cross(&q.d[1]));
        if !same_direction(&n, &m) {
            return Side::Crease(number);
        }
        side = Side::Inner;
    }
    side
}

fn is_collapsed(chart: &SurfaceChart, axis: usize, high: bool, size: f64) -> bool {
    let at = |s: f64| {
        let mut z = [s; 2];
        z[axis] = if high { 1.0 } else { -1.0 };
        chart.jet(&z)
    };
    (0..=4).all(|k| at(-1.0 + 0.5 * f64::from(k)).d[1 - axis].norm() <= 1e-12 * size)
}

/// Whether a collapsed side, all around, is one point with one tangent plane.
fn is_pole(charts: &[SurfaceChart], n: usize, m: usize, axis: usize, high: bool, closed: [bool; 2]) -> bool {
    if !closed[1 - axis] {
        return false;
    }
    let mut normal: Option<Vector<3>> = None;
    let across = if axis == 0 { m } else { n };
    for l in 0..across {
        let chart = match (axis, high) {
            (0, false) => &charts[l],
            (0, true) => &charts[(n - 1) * m + l],
            (_, false) => &charts[l * m],
            (_, true) => &charts[l * m + m - 1],
        };
        for s in [-1.0, 0.0, 1.0] {
            let mut z = [s; 2];
            z[axis] = if high { 1.0 } else { -1.0 };
            let jet = chart.jet(&z);
            // The side itself has no tangent; its rate of growth away from the pole takes that place.
            let Some(n) = direction(&jet.d[axis].cross(&jet.dd[0][1])) else { return false };
            let reference = *normal.get_or_insert(n);
            if n.cross(&reference).norm() > 1e-8 || n.dot(&reference) < 0.0 {
                return false;
            }
        }
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, TAU};

    #[test]
    fn height_fields_pass_through_their_heights() {
        let axes = Axes::standard(Point::<3>::new(1.0, 2.0, 3.0));
        let heights: Vec<Vec<f64>> =
            (0..7).map(|i| (0..9).map(|j| f64::from(i * i - 3 * j) + f64::from(i * j).sin()).collect()).collect();
        for degree in 1..=5 {
            let s = Surface::height_field(axes, [0.5, 0.25], &heights, degree).unwrap();
            for (i, row) in heights.iter().enumerate() {
                for (j, height) in row.iter().enumerate() {
                    let (u, v) = (0.5 * i as f64, 0.25 * j as f64);
                    let exact = Point::<3>::new(1.0 + u, 2.0 + v, 3.0 + height);
                    assert!((s.position(u, v) - exact).norm() < 1e-11, "degree {degree}");
                }
            }
        }
        assert!(Surface::height_field(axes, [0.5, 0.0], &heights, 3).is_err());
        assert!(Surface::height_field(axes, [0.5, 0.5], &heights, 9).is_err());
        assert!(Surface::height_field(axes, [0.5, 0.5], &heights[..2], 3).is_err());
    }

    #[test]
    fn poles_and_collapsed_sides_are_told_apart() {
        use crate::patch::Side;
        let axes = Axes::standard(Point::<3>::zeros());
        let turn = [0.0, TAU];
        let sphere = Surface::sphere(axes, 1.0, [turn, [-FRAC_PI_2, FRAC_PI_2]], true).unwrap();
        assert_eq!(sphere.atlas.pieces[0].sides[1][0], Side::Pole);
        let octant = Surface::sphere(axes, 1.0, [[0.0, FRAC_PI_2], [0.0, FRAC_PI_2]], false).unwrap();
        assert_eq!(octant.atlas.pieces[0].sides[1][1], Side::Collapsed(Border::V1));
        let cone = Surface::cone(axes, 0.6, 0.8, [turn, [0.0, 1.0]], true).unwrap();
        assert_eq!(cone.atlas.pieces[0].sides[1][0], Side::Collapsed(Border::V0));
    }
}
