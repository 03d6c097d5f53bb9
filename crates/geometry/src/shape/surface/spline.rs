//! Bezier and B-spline surfaces, and height fields.

use super::grid::{bezier_grid, control_net};
use super::{Surface, SurfaceKind};
use crate::Point;
use crate::patch::Chart;
use crate::patch::bernstein::{Control, MAX_DEGREE, bezier_spans};
use crate::patch::net::Net;
use crate::shape::error::{Axes, ShapeError, knots, number, positive};

impl Surface {
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
