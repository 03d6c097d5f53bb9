//! Control nets, and grids of Bezier pieces cut until they are easy to bound.

use super::Parts;
use crate::Point;
use crate::patch::SurfaceChart;
use crate::patch::net::Net;
use crate::patch::weights::even_middle;
use crate::shape::curve::{DEEPEST, homogeneous, is_high};
use crate::shape::error::{ShapeError, position, weight};

pub fn control_net(points: &[Vec<Point<3>>], weights: Option<&[Vec<f64>]>) -> Result<Net, ShapeError> {
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
pub fn bezier_grid(breaks: [Vec<f64>; 2], may_turn: [Vec<bool>; 2], nets: Vec<Net>) -> Parts {
    let depth = [0, 1].map(|axis| vec![0; breaks[axis].len() - 1]);
    let mut grid = Grid { breaks, may_turn, depth, nets };
    // Directions in turn: a cut in one makes the weights more even in the other too.
    while grid.cut(0) | grid.cut(1) {}
    let (nets, ratios): (Vec<Net>, Vec<[f64; 2]>) = grid.nets.iter().map(Net::even).unzip();
    let charts = nets.iter().map(SurfaceChart::bezier).collect();
    Parts { charts, ratios, breaks: grid.breaks, may_turn: grid.may_turn }
}

/// Bezier pieces on a grid of parameters, row by row, the second direction fastest.
struct Grid {
    breaks: [Vec<f64>; 2],
    may_turn: [Vec<bool>; 2],
    /// How often each interval was cut.
    depth: [Vec<u32>; 2],
    nets: Vec<Net>,
}

impl Grid {
    /// Cuts every interval in one direction that still needs it; whether there was any.
    fn cut(&mut self, axis: usize) -> bool {
        let count = [self.breaks[0].len() - 1, self.breaks[1].len() - 1];
        let places: Vec<Option<f64>> = (0..count[axis]).map(|k| self.place(axis, k, count)).collect();
        if places.iter().all(Option::is_none) {
            return false;
        }
        let (mut breaks, mut may_turn, mut depth) = (vec![self.breaks[axis][0]], Vec::new(), Vec::new());
        for (k, place) in places.iter().enumerate() {
            let (from, to) = (self.breaks[axis][k], self.breaks[axis][k + 1]);
            if let Some(t) = place {
                breaks.push(from + (to - from) * t);
                may_turn.push(false);
                depth.push(self.depth[axis][k] + 1);
            }
            breaks.push(to);
            may_turn.push(self.may_turn[axis][k]);
            depth.push(self.depth[axis][k] + u32::from(place.is_some()));
        }
        let mut nets = Vec::with_capacity(2 * self.nets.len());
        for (i, row) in self.nets.chunks(count[1]).enumerate() {
            let parts = |j: usize| match places[[i, j][axis]] {
                Some(t) => row[j].cut(axis, t).to_vec(),
                None => vec![row[j].clone()],
            };
            let parts: Vec<Vec<Net>> = (0..count[1]).map(parts).collect();
            if axis == 0 {
                (0..parts[0].len()).for_each(|half| nets.extend(parts.iter().map(|p| p[half].clone())));
            } else {
                nets.extend(parts.into_iter().flatten());
            }
        }
        self.nets = nets;
        self.breaks[axis] = breaks;
        self.may_turn[axis] = may_turn;
        self.depth[axis] = depth;
        true
    }

    /// Where in `[0, 1]` an interval must be cut: in the even middle of its first piece that is not even.
    fn place(&self, axis: usize, k: usize, count: [usize; 2]) -> Option<f64> {
        let depth = self.depth[axis][k];
        let uneven = |l: usize| {
            let (net, ratio) = self.nets[if axis == 0 { k * count[1] + l } else { l * count[1] + k }].even();
            net.is_uneven(axis).then(|| even_middle(ratio[axis]))
        };
        let t = (0..count[1 - axis]).find_map(uneven).or(is_high(self.nets[0].degree[axis], depth).then_some(0.5))?;
        let (from, to) = (self.breaks[axis][k], self.breaks[axis][k + 1]);
        let resolved = (to - from) * t.min(1.0 - t) > 32.0 * f64::EPSILON * from.abs().max(to.abs());
        (resolved && depth < DEEPEST).then_some(t)
    }
}
