//! Histories of supports and loads: piecewise linear functions of time.

/// Length of a jump, as a part of the step in which it happens.
pub const JUMP: f64 = 1e-6;

/// A piecewise linear function of time, constant before its first and after its last point.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Curve {
    /// Time and value, in ascending order of time.
    points: Vec<[f64; 2]>,
}

impl Curve {
    /// A value that does not change.
    pub fn constant(value: f64) -> Self {
        Self { points: vec![[0.0, value]] }
    }

    /// A curve through points, in ascending order of time; of points at the same time the last counts.
    pub fn through(points: impl IntoIterator<Item = [f64; 2]>) -> Self {
        let mut out = Self::default();
        points.into_iter().for_each(|[t, v]| out.push(t, v));
        out
    }

    /// Adds a point after the others.
    pub fn push(&mut self, time: f64, value: f64) {
        while self.points.last().is_some_and(|p| p[0] >= time) {
            self.points.pop();
        }
        self.points.push([time, value]);
    }

    pub fn points(&self) -> &[[f64; 2]] {
        &self.points
    }

    /// Value at a time.
    pub fn at(&self, time: f64) -> f64 {
        let next = self.points.partition_point(|p| p[0] <= time);
        match (next.checked_sub(1).map(|k| self.points[k]), self.points.get(next)) {
            (Some([t, v]), Some([u, w])) => v + (w - v) * (time - t) / (u - t),
            (Some([_, v]), None) | (None, Some(&[_, v])) => v,
            (None, None) => 0.0,
        }
    }

    /// The value, if it is the same at all times.
    pub fn as_constant(&self) -> Option<f64> {
        let first = self.points.first().map_or(0.0, |p| p[1]);
        self.points.iter().all(|p| p[1] == first).then_some(first)
    }

    /// The slope of a line through the origin that the curve is between zero and an end.
    pub fn as_ramp(&self, end: f64) -> Option<f64> {
        let last = self.points.last()?;
        let slope = last[1] / last[0];
        let on_line = |p: &[f64; 2]| (p[1] - slope * p[0]).abs() <= 1e-12 * last[1].abs();
        (last[0] >= end && self.points[0][0] == 0.0 && self.points.iter().all(on_line)).then_some(slope)
    }

    /// The sum of two curves, with the points of both.
    pub fn plus(&self, other: &Self) -> Self {
        let mut times: Vec<f64> = self.points.iter().chain(&other.points).map(|p| p[0]).collect();
        times.sort_by(f64::total_cmp);
        times.dedup();
        Self::through(times.into_iter().map(|t| [t, self.at(t) + other.at(t)]))
    }

    pub fn scaled(&self, factor: f64) -> Self {
        Self { points: self.points.iter().map(|[t, v]| [*t, factor * v]).collect() }
    }
}
