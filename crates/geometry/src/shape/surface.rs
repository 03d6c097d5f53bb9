//! Surfaces in space.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::Curve;
use super::curve::{affine, closed_range, homogeneous, uneven, wrap};
use super::error::{Axes, ShapeError, interval, knots, number, position, positive, weight};
use crate::patch::bernstein::{Control, MAX_DEGREE, Net, bezier_spans, combine};
use crate::patch::{Atlas, Border, Chart, Jet3, ParameterMap, Piece, Side, SurfaceChart};
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
}

impl Surface {
    fn assemble(kind: SurfaceKind, parts: Parts, closed: [bool; 2], smooth_poles: bool) -> Self {
        let Parts { breaks, may_turn, charts } = parts;
        let (n, m) = (breaks[0].len() - 1, breaks[1].len() - 1);
        let at = |i: usize, j: usize| &charts[i * m + j];
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
                        let (p, q) = if axis == 0 { (at(k, l), at(next, l)) } else { (at(l, k), at(l, next)) };
                        *side = meet(p, q, axis, creases);
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
                let map = ParameterMap::Affine {
                    low: [breaks[0][i], breaks[1][j]],
                    high: [breaks[0][i + 1], breaks[1][j + 1]],
                };
                pieces.push(Piece::new(at(i, j).clone(), map, sides));
            }
        }
        let domain = [0, 1].map(|a| [breaks[a][0], *breaks[a].last().expect("two breaks at least")]);
        Surface { kind, atlas: Atlas::new(pieces), domain, closed, breaks, triangle: None }
    }

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
        Ok(Self::assemble(kind, Parts { breaks, may_turn, charts }, closed, turning))
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
        let mut along: Vec<f64> = pieces.iter().map(|p| affine(&p.map)[0][0]).collect();
        along.push(profile.domain()[1]);
        let mut charts = Vec::new();
        for u in turns.windows(2) {
            for piece in pieces {
                let (middle, half) = (0.5 * (u[0] + u[1]), 0.5 * (u[1] - u[0]));
                charts.push(SurfaceChart::revolved(origin, axis, piece.chart.clone(), middle, half));
            }
        }
        let may_turn = [vec![false; turns.len()], vec![true; along.len()]];
        let parts = Parts { breaks: [turns, along], may_turn, charts };
        Ok(Self::assemble(SurfaceKind::Other, parts, [closed, profile.is_closed()], false))
    }

    /// A Bezier surface over the unit square, `control_points[i][j]` with `i` along `u`.
    ///
    /// # Errors
    /// Rows of different length, a degree out of range, weights that are not positive.
    pub fn bezier(control_points: &[Vec<Point<3>>], weights: Option<&[Vec<f64>]>) -> Result<Self, ShapeError> {
        let net = control_net(control_points, weights)?;
        if net.degree.iter().any(|&d| d == 0 || d > MAX_DEGREE) {
            return Err(ShapeError::new(
                "control_points",
                format!("{} by {}, valid are 2 to {} each way", net.degree[0] + 1, net.degree[1] + 1, MAX_DEGREE + 1),
            ));
        }
        let parts = bezier_grid([vec![0.0, 1.0], vec![0.0, 1.0]], [vec![true], vec![true]], vec![net]);
        Ok(Self::assemble(SurfaceKind::Other, parts, [false; 2], false))
    }

    /// A B-spline surface, rational with weights, `control_points[i][j]` with `i` along `u`.
    ///
    /// # Errors
    /// Knots that decrease or do not fit the control points, weights that are not positive, a closed direction in
    /// which the ends do not meet.
    pub fn nurbs(
        degree: [usize; 2],
        knot_vectors: [&[f64]; 2],
        control_points: &[Vec<Point<3>>],
        weights: Option<&[Vec<f64>]>,
        closed: [bool; 2],
    ) -> Result<Self, ShapeError> {
        let net = control_net(control_points, weights)?;
        let [rows, columns] = [net.degree[0] + 1, net.degree[1] + 1];
        knots("knots_u", degree[0], knot_vectors[0], rows)?;
        knots("knots_v", degree[1], knot_vectors[1], columns)?;
        // Bezier form first along u for every column of control points, then along v for every row that results.
        let by_column: Vec<_> =
            (0..columns).map(|j| bezier_spans(degree[0], knot_vectors[0], &net.column(j))).collect();
        let (mut breaks, mut may_turn) = ([Vec::new(), Vec::new()], [Vec::new(), Vec::new()]);
        breaks[0].push(by_column[0][0].from);
        let mut nets = Vec::new();
        for span in 0..by_column[0].len() {
            breaks[0].push(by_column[0][span].to);
            may_turn[0].push(by_column[0][span].multiplicity_at_end >= degree[0]);
            let by_row: Vec<_> = (0..=degree[0])
                .map(|i| {
                    let row: Vec<Control> = by_column.iter().map(|c| c[span].control[i]).collect();
                    bezier_spans(degree[1], knot_vectors[1], &row)
                })
                .collect();
            for k in 0..by_row[0].len() {
                if span == 0 {
                    if k == 0 {
                        breaks[1].push(by_row[0][0].from);
                    }
                    breaks[1].push(by_row[0][k].to);
                    may_turn[1].push(by_row[0][k].multiplicity_at_end >= degree[1]);
                }
                nets.push(Net { degree, control: by_row.iter().flat_map(|r| r[k].control.clone()).collect() });
            }
        }
        let surface = Self::assemble(SurfaceKind::Other, bezier_grid(breaks, may_turn, nets), closed, false);
        for axis in 0..2 {
            if closed[axis] {
                surface.ends_meet(axis)?;
            }
        }
        Ok(surface)
    }

    fn ends_meet(&self, axis: usize) -> Result<(), ShapeError> {
        let [n, m] = [self.breaks[0].len() - 1, self.breaks[1].len() - 1];
        let across = if axis == 0 { m } else { n };
        for l in 0..across {
            let (first, last) = if axis == 0 { (l, (n - 1) * m + l) } else { (l * m, l * m + m - 1) };
            for s in [-1.0, 0.0, 1.0] {
                let mut at = [[s; 2]; 2];
                at[0][axis] = -1.0;
                at[1][axis] = 1.0;
                let pieces = &self.atlas.pieces;
                let gap = pieces[first].chart.position(&at[0]) - pieces[last].chart.position(&at[1]);
                if gap.norm() > 1e-9 * (self.atlas.size + self.atlas.magnitude) {
                    return Err(ShapeError::new("closed", "the ends of the surface do not meet"));
                }
            }
        }
        Ok(())
    }

    /// Heights on a regular grid, `heights[i][j]` above `o + i spacing[0] ex + j spacing[1] ey`, joined by a B-spline
    /// that passes through them: linear pieces, or smooth ones of degree 2 to 5. Parameters are the coordinates in the
    /// plane.
    ///
    /// # Errors
    /// Rows of different length, fewer heights in a direction than the degree needs, more than 2000, a spacing that is
    /// not positive.
    pub fn height_field(
        axes: Axes,
        spacing: [f64; 2],
        heights: &[Vec<f64>],
        degree: usize,
    ) -> Result<Self, ShapeError> {
        for h in spacing {
            positive("spacing", h)?;
        }
        let (rows, columns) = (heights.len(), heights.first().map_or(0, Vec::len));
        if !(1..=5).contains(&degree) {
            return Err(ShapeError::new("degree", format!("{degree} is not between 1 and 5")));
        }
        if rows <= degree || columns <= degree || rows > 2000 || columns > 2000 {
            let message = format!("{rows} by {columns}, valid are {} to 2000 each way", degree + 1);
            return Err(ShapeError::new("heights", message));
        }
        if let Some(row) = heights.iter().find(|r| r.len() != columns) {
            return Err(ShapeError::new("heights", format!("a row of {} among rows of {columns}", row.len())));
        }
        for &height in heights.iter().flatten() {
            number("heights", height)?;
        }
        let along = [InterpolatingSpline::new(rows, degree), InterpolatingSpline::new(columns, degree)];
        let table = nalgebra::DMatrix::from_fn(rows, columns, |i, j| heights[i][j]);
        let coefficients = along[0].solve(&along[1].solve(&table.transpose()).transpose());
        let points: Vec<Vec<Point<3>>> = (0..rows)
            .map(|i| {
                (0..columns)
                    .map(|j| {
                        let (u, v) = (along[0].greville[i] * spacing[0], along[1].greville[j] * spacing[1]);
                        axes.origin + axes.ex * u + axes.ey * v + axes.ez * coefficients[(i, j)]
                    })
                    .collect()
            })
            .collect();
        let [u, v] = [0, 1].map(|k| along[k].knots.iter().map(|t| t * spacing[k]).collect::<Vec<f64>>());
        Self::nurbs([degree; 2], [&u, &v], &points, None, [false; 2])
    }

    /// A quadrilateral of any order over `[-1, 1]²` through a grid of nodes, `nodes[i][j]` with `i` along `u`.
    ///
    /// # Errors
    /// Rows of different length, an order out of range.
    pub fn lagrange_quad(nodes: &[Vec<Point<3>>]) -> Result<Self, ShapeError> {
        let values = control_net(nodes, None).map_err(|e| ShapeError::new("nodes", e.message))?;
        if values.degree.iter().any(|&d| d == 0 || d > MAX_DEGREE) {
            return Err(ShapeError::new("nodes", "valid are 2 to 16 nodes each way"));
        }
        let net = values
            .map_columns(|c| crate::patch::bernstein::interpolate(values.degree[0], c))
            .map_rows(|r| crate::patch::bernstein::interpolate(values.degree[1], r));
        let parts = bezier_grid([vec![-1.0, 1.0], vec![-1.0, 1.0]], [vec![true], vec![true]], vec![net]);
        Ok(Self::assemble(SurfaceKind::Other, parts, [false; 2], false))
    }

    /// Four nodes, counter-clockwise from `(-1, -1)`.
    ///
    /// # Errors
    /// Coordinates that are not finite.
    pub fn quad4(n: &[Point<3>; 4]) -> Result<Self, ShapeError> {
        Self::lagrange_quad(&[vec![n[0], n[3]], vec![n[1], n[2]]])
    }

    /// Nine nodes: corners counter-clockwise from `(-1, -1)`, middles of the sides from `(0, -1)`, centre.
    ///
    /// # Errors
    /// Coordinates that are not finite.
    pub fn quad9(n: &[Point<3>; 9]) -> Result<Self, ShapeError> {
        Self::lagrange_quad(&[vec![n[0], n[7], n[3]], vec![n[4], n[8], n[6]], vec![n[1], n[5], n[2]]])
    }

    /// A triangle of any order over `xi, eta >= 0`, `xi + eta <= 1`. Nodes sit at `(i/p, j/p)`, row by row: all of
    /// `j = 0` first, `i` fastest.
    ///
    /// # Errors
    /// A number of nodes that is not `(p + 1)(p + 2)/2`, an order above 10.
    pub fn lagrange_triangle(nodes: &[Point<3>]) -> Result<Self, ShapeError> {
        let order = (1..=10).find(|p| (p + 1) * (p + 2) / 2 == nodes.len()).ok_or_else(|| {
            ShapeError::new(
                "nodes",
                format!("{} given, valid are 3, 6, 10, ... (p + 1)(p + 2)/2 up to p = 10", nodes.len()),
            )
        })?;
        for p in nodes {
            position("nodes", p)?;
        }
        let at = |xi: f64, eta: f64| -> Control {
            let mut sum = [0.0; 4];
            let mut k = 0;
            for j in 0..=order {
                for i in 0..=order - j {
                    let shape = triangle_shape(order, [i, j], xi, eta);
                    sum = combine(1.0, &sum, shape, &homogeneous(&nodes[k], 1.0));
                    k += 1;
                }
            }
            sum
        };
        let kind = match nodes {
            [a, b, c] => SurfaceKind::Triangle { nodes: [*a, *b, *c] },
            _ => SurfaceKind::Other,
        };
        Ok(Self::triangle_of(kind, order, at))
    }

    fn triangle_of(kind: SurfaceKind, order: usize, at: impl Fn(f64, f64) -> Control) -> Self {
        let whole = SurfaceChart::bezier(&Net::interpolating([order, order], &at));
        // Three quadrilaterals around the centroid: corner, middle of a side, centroid, middle of the other side.
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        let borders = [Border::V0, Border::Diagonal, Border::U0];
        let middle = |a: usize, b: usize| [0, 1].map(|k| 0.5 * (corners[a][k] + corners[b][k]));
        let pieces = (0..3)
            .map(|k| {
                let (next, before) = ((k + 1) % 3, (k + 2) % 3);
                let quad = [corners[k], middle(k, next), [1.0 / 3.0; 2], middle(k, before)];
                let map = ParameterMap::Bilinear(quad);
                let net = Net::interpolating([order, order], |s, t| {
                    let p = map.apply(&[2.0 * s - 1.0, 2.0 * t - 1.0]);
                    at(p[0], p[1])
                });
                let sides = [[Side::Boundary(borders[before]), Side::Inner], [Side::Boundary(borders[k]), Side::Inner]];
                Piece::new(SurfaceChart::bezier(&net), map, sides)
            })
            .collect();
        Surface {
            kind,
            atlas: Atlas::new(pieces),
            domain: [[0.0, 1.0]; 2],
            closed: [false; 2],
            breaks: [Vec::new(), Vec::new()],
            triangle: Some(whole),
        }
    }

    /// Three corners.
    ///
    /// # Errors
    /// Coordinates that are not finite.
    pub fn tri3(nodes: &[Point<3>; 3]) -> Result<Self, ShapeError> {
        Self::lagrange_triangle(nodes)
    }

    /// Three corners, then the middles of the sides 12, 23, 31.
    ///
    /// # Errors
    /// Coordinates that are not finite.
    pub fn tri6(n: &[Point<3>; 6]) -> Result<Self, ShapeError> {
        Self::lagrange_triangle(&[n[0], n[3], n[1], n[5], n[4], n[2]])
    }

    pub(crate) fn with(
        &self,
        kind: SurfaceKind,
        atlas: Atlas<2, SurfaceChart>,
        chart: impl Fn(&SurfaceChart) -> SurfaceChart,
    ) -> Self {
        Surface { kind, atlas, breaks: self.breaks.clone(), triangle: self.triangle.as_ref().map(chart), ..*self }
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
            return scaled(&chart.jet3(&[2.0 * u - 1.0, 2.0 * v - 1.0]), [0.5; 2]);
        }
        let (piece, s) = self.locate([u, v]);
        let [low, high] = affine(&self.atlas.pieces[piece].map);
        scaled(&self.atlas.pieces[piece].chart.jet3(&s), [0, 1].map(|k| 0.5 * (high[k] - low[k])))
    }

    /// The piece in which parameters lie, and its local parameters; not for triangles.
    pub(crate) fn locate(&self, z: [f64; 2]) -> (usize, [f64; 2]) {
        let mut number = 0;
        let mut s = [0.0; 2];
        for k in 0..2 {
            let t = wrap(z[k], self.domain[k], self.closed[k]);
            let breaks = &self.breaks[k];
            let interval = breaks.partition_point(|&b| b <= t).clamp(1, breaks.len() - 1) - 1;
            let [from, to] = [breaks[interval], breaks[interval + 1]];
            s[k] = ((t - from) - (to - t)) / (to - from);
            number = if k == 0 { interval * (self.breaks[1].len() - 1) } else { number + interval };
        }
        (number, s)
    }

    /// Position.
    pub fn position(&self, u: f64, v: f64) -> Point<3> {
        self.jet(u, v).x
    }
}

/// A clamped spline of given degree through values at `0, 1, ..., n - 1`.
struct InterpolatingSpline {
    knots: Vec<f64>,
    /// Where control points must sit for the parameter to be the coordinate.
    greville: Vec<f64>,
    inverse: nalgebra::LU<f64, nalgebra::Dyn, nalgebra::Dyn>,
}

impl InterpolatingSpline {
    fn new(n: usize, degree: usize) -> Self {
        // Interior knots by averaging (de Boor): one control point per value.
        let mut knots = vec![0.0; degree + 1];
        for j in 1..n - degree {
            knots.push((j..j + degree).sum::<usize>() as f64 / degree as f64);
        }
        knots.extend(vec![(n - 1) as f64; degree + 1]);
        let greville = (0..n).map(|i| knots[i + 1..=i + degree].iter().sum::<f64>() / degree as f64).collect();
        let mut matrix = nalgebra::DMatrix::zeros(n, n);
        for i in 0..n {
            let t = i as f64;
            let span = knots[degree..n].partition_point(|&k| k <= t).max(1) + degree - 1;
            let mut basis = vec![1.0];
            for p in 1..=degree {
                let mut next = vec![0.0; p + 1];
                for (r, value) in basis.iter().enumerate() {
                    let (low, high) = (knots[span + 1 + r - p], knots[span + 1 + r]);
                    let share = (t - low) / (high - low);
                    next[r] += (1.0 - share) * value;
                    next[r + 1] += share * value;
                }
                basis = next;
            }
            for (r, value) in basis.into_iter().enumerate() {
                matrix[(i, span - degree + r)] = value;
            }
        }
        InterpolatingSpline { knots, greville, inverse: matrix.lu() }
    }

    fn solve(&self, values: &nalgebra::DMatrix<f64>) -> nalgebra::DMatrix<f64> {
        self.inverse.solve(values).expect("collocation at Greville-like points is regular")
    }
}

fn scaled(j: &Jet3, [h, k]: [f64; 2]) -> SurfaceJet {
    SurfaceJet {
        x: j.x,
        u: j.d[0] / h,
        v: j.d[1] / k,
        uu: j.dd[0] / (h * h),
        uv: j.dd[1] / (h * k),
        vv: j.dd[2] / (k * k),
        uuu: j.ddd[0] / (h * h * h),
        uuv: j.ddd[1] / (h * h * k),
        uvv: j.ddd[2] / (h * k * k),
        vvv: j.ddd[3] / (k * k * k),
    }
}

/// Lagrange polynomial of the node `(i/p, j/p)` of a triangle.
fn triangle_shape(order: usize, [i, j]: [usize; 2], xi: f64, eta: f64) -> f64 {
    let p = order as f64;
    let factor = |n: usize, x: f64| (0..n).map(|k| (p * x - k as f64) / (n - k) as f64).product::<f64>();
    factor(i, xi) * factor(j, eta) * factor(order - i - j, 1.0 - xi - eta)
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

fn control_net(points: &[Vec<Point<3>>], weights: Option<&[Vec<f64>]>) -> Result<Net, ShapeError> {
    let columns = points.first().map_or(0, Vec::len);
    if columns == 0 {
        return Err(ShapeError::new("control_points", "empty"));
    }
    if let Some(w) = weights
        && (w.len() != points.len() || w.iter().any(|row| row.len() != columns))
    {
        return Err(ShapeError::new("weights", format!("not {} rows of {columns}", points.len())));
    }
    let mut control = Vec::with_capacity(points.len() * columns);
    for (i, row) in points.iter().enumerate() {
        if row.len() != columns {
            return Err(ShapeError::new(
                "control_points",
                format!("row {i} has {} points, the first has {columns}", row.len()),
            ));
        }
        for (j, p) in row.iter().enumerate() {
            position("control_points", p)?;
            let w = weights.map_or(Ok(1.0), |w| weight(w[i][j]))?;
            control.push(homogeneous(p, w));
        }
    }
    Ok(Net { degree: [points.len() - 1, columns - 1], control })
}

/// Cuts rows and columns of Bezier pieces until powers decay and weights are even.
fn bezier_grid(mut breaks: [Vec<f64>; 2], mut may_turn: [Vec<bool>; 2], mut nets: Vec<Net>) -> Parts {
    for axis in 0..2 {
        let mut depth = vec![0u32; breaks[axis].len() - 1];
        loop {
            let count = [breaks[0].len() - 1, breaks[1].len() - 1];
            let needed: Vec<bool> = (0..count[axis])
                .map(|k| {
                    let mut along = (0..count[1 - axis])
                        .map(|l| &nets[if axis == 0 { k * count[1] + l } else { l * count[1] + k }]);
                    let high = nets[0].degree[axis] > 6 && 6 * (1usize << depth[k]) < 2 * nets[0].degree[axis];
                    let wide = breaks[axis][k + 1] - breaks[axis][k]
                        > 64.0 * f64::EPSILON * breaks[axis][k].abs().max(breaks[axis][k + 1].abs());
                    wide && depth[k] < 6 && (high || along.any(|net| uneven_along(net, axis)))
                })
                .collect();
            if !needed.contains(&true) {
                break;
            }
            let (mut b, mut t, mut d) = (vec![breaks[axis][0]], Vec::new(), Vec::new());
            for k in 0..count[axis] {
                if needed[k] {
                    b.push(0.5 * (breaks[axis][k] + breaks[axis][k + 1]));
                    t.push(false);
                    d.push(depth[k] + 1);
                }
                b.push(breaks[axis][k + 1]);
                t.push(may_turn[axis][k]);
                d.push(depth[k] + u32::from(needed[k]));
            }
            nets = if axis == 0 {
                (0..count[0])
                    .flat_map(|i| {
                        let row = &nets[i * count[1]..(i + 1) * count[1]];
                        if needed[i] {
                            let halves: Vec<[Net; 2]> = row.iter().map(|n| n.halves(0)).collect();
                            let first = halves.iter().map(|h| h[0].clone());
                            first.chain(halves.iter().map(|h| h[1].clone())).collect::<Vec<_>>()
                        } else {
                            row.to_vec()
                        }
                    })
                    .collect()
            } else {
                nets.iter()
                    .enumerate()
                    .flat_map(|(k, n)| if needed[k % count[1]] { n.halves(1).to_vec() } else { vec![n.clone()] })
                    .collect()
            };
            breaks[axis] = b;
            may_turn[axis] = t;
            depth = d;
        }
    }
    Parts { charts: nets.iter().map(SurfaceChart::bezier).collect(), breaks, may_turn }
}

/// Whether the weights of any line of control points in this direction differ by more than a factor of two.
fn uneven_along(net: &Net, axis: usize) -> bool {
    (0..=net.degree[1 - axis]).any(|k| {
        let line = if axis == 0 { net.column(k) } else { net.row(k).to_vec() };
        uneven(&line)
    })
}

/// How two consecutive pieces join, judged at several points of their common side.
fn meet(left: &SurfaceChart, right: &SurfaceChart, axis: usize, number: u32) -> Side {
    let mut side = Side::Smooth;
    for k in 0..=8 {
        let s = -1.0 + 0.25 * k as f64;
        let (mut at, mut then) = ([s; 2], [s; 2]);
        at[axis] = 1.0;
        then[axis] = -1.0;
        let (p, q) = (left.jet(&at), right.jet(&then));
        let (cross_p, cross_q) = (p.d[axis], q.d[axis]);
        let parallel = |a: &Vector<3>, b: &Vector<3>| a.dot(b) > 0.0 && a.cross(b).norm() <= 1e-8 * a.norm() * b.norm();
        if parallel(&cross_p, &cross_q) {
            continue;
        }
        let (n, m) = (p.d[0].cross(&p.d[1]), q.d[0].cross(&q.d[1]));
        if !parallel(&n, &m) {
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
            let Some(n) = jet.d[axis].cross(&jet.dd[0][1]).try_normalize(0.0) else { return false };
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
