//! Control nets, and grids of Bezier pieces cut until they are easy to bound.

use super::Parts;
use crate::Point;
use crate::patch::SurfaceChart;
use crate::patch::bernstein::Net;
use crate::shape::curve::{homogeneous, uneven};
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
pub fn bezier_grid(mut breaks: [Vec<f64>; 2], mut may_turn: [Vec<bool>; 2], mut nets: Vec<Net>) -> Parts {
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
