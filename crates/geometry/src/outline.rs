//! Closed outlines of the set where a sampled function is negative (marching squares).

use crate::{Aabb, Point};
use std::collections::BTreeMap;

/// A function sampled at the nodes of a rectangular grid.
#[derive(Clone, Debug)]
pub struct Samples {
    pub bounds: Aabb<2>,
    /// Number of cells in each direction; there is one node more.
    pub cells: [usize; 2],
    /// Values at the nodes, the first direction fastest.
    pub values: Vec<f64>,
}

impl Samples {
    /// Samples `f` at all nodes.
    pub fn of(bounds: Aabb<2>, cells: [usize; 2], mut f: impl FnMut(&Point<2>) -> f64) -> Self {
        let mut samples = Self { bounds, cells, values: Vec::with_capacity((cells[0] + 1) * (cells[1] + 1)) };
        for j in 0..=cells[1] {
            for i in 0..=cells[0] {
                let x = samples.node(i, j);
                samples.values.push(f(&x));
            }
        }
        samples
    }

    /// Position of a node.
    pub fn node(&self, i: usize, j: usize) -> Point<2> {
        self.bounds.at(&Point::<2>::new(i as f64 / self.cells[0] as f64, j as f64 / self.cells[1] as f64))
    }

    /// Value at a node; beyond the grid everything counts as positive, so that every outline closes.
    fn at(&self, i: isize, j: isize) -> f64 {
        let inside = (0..=self.cells[0] as isize).contains(&i) && (0..=self.cells[1] as isize).contains(&j);
        if inside { self.values[j as usize * (self.cells[0] + 1) + i as usize] } else { f64::INFINITY }
    }

    /// The outlines of `{value < 0}` as closed polylines with that set on their left.
    ///
    /// Saddles are resolved by the mean of the four corners.
    pub fn outlines(&self) -> Vec<Vec<Point<2>>> {
        // An edge is named by its lower node and direction.
        let rows = -1..=self.cells[1] as isize;
        let cells = rows.flat_map(|j| (-1..=self.cells[0] as isize).map(move |i| (i, j))).map(|(i, j)| {
            [
                (self.at(i, j), (i, j, 0)),
                (self.at(i + 1, j), (i + 1, j, 1)),
                (self.at(i + 1, j + 1), (i, j + 1, 0)),
                (self.at(i, j + 1), (i, j, 1)),
            ]
        });
        // Beyond the grid everything is positive.
        outlines(cells, |edge| self.crossing(edge), 1e-12 * self.bounds.radius()).unwrap_or_default()
    }

    /// Where the function vanishes on a grid edge, by linear interpolation.
    fn crossing(&self, (i, j, direction): (isize, isize, u8)) -> Point<2> {
        let (di, dj) = if direction == 0 { (1, 0) } else { (0, 1) };
        let (a, b) = (self.at(i, j), self.at(i + di, j + dj));
        let t = if a.is_infinite() {
            1.0
        } else if b.is_infinite() {
            0.0
        } else {
            a / (a - b)
        };
        let spacing = Point::<2>::from_fn(|k, _| self.bounds.size()[k] / self.cells[k] as f64);
        let at = |i: isize, j: isize| self.bounds.min + spacing.component_mul(&Point::<2>::new(i as f64, j as f64));
        at(i, j) + t * (at(i + di, j + dj) - at(i, j))
    }
}

/// The outlines of the set where a function is negative that is linear between the corners of cells, which are named
/// counter-clockwise, as [`outlines`] has them: by the value and the place of each corner.
pub fn outlines_between<Corner: Ord + Copy>(
    cells: impl Iterator<Item = Vec<Corner>>,
    value: impl Fn(Corner) -> f64,
    place: impl Fn(Corner) -> Point<2>,
    same: f64,
) -> Option<Vec<Vec<Point<2>>>> {
    let mut values: BTreeMap<Corner, f64> = BTreeMap::new();
    let cells: Vec<Vec<_>> = cells
        .map(|corners| {
            let next = corners.iter().cycle().skip(1);
            let edge = |(&a, &b): (&Corner, &Corner)| (a, (a.min(b), a.max(b)));
            let corner = |(a, edge)| (*values.entry(a).or_insert_with(|| value(a)), edge);
            corners.iter().zip(next).map(edge).map(corner).collect()
        })
        .collect();
    let crossing = |(a, b)| {
        let (f, g) = (values[&a], values[&b]);
        place(a) + f / (f - g) * (place(b) - place(a))
    };
    outlines(cells.iter(), crossing, same)
}

/// The outlines of the set where a function is negative, as closed polylines with that set on their left: by the values at the
/// corners of cells, counter-clockwise, each with the name of the edge to the next, and where the function vanishes on an
/// edge. Points nearer than `same` are one. None where the set reaches beyond the cells.
///
/// Where more than two corners alternate, the mean of all tells which are joined.
pub fn outlines<Edge: Ord + Copy, Cell: AsRef<[(f64, Edge)]>>(
    cells: impl Iterator<Item = Cell>,
    crossing: impl Fn(Edge) -> Point<2>,
    same: f64,
) -> Option<Vec<Vec<Point<2>>>> {
    // Each directed piece runs between two crossed edges.
    let mut next: BTreeMap<Edge, Edge> = BTreeMap::new();
    for cell in cells {
        let corners = cell.as_ref();
        let n = corners.len();
        let changes = |k: usize, from: bool| (corners[k].0 < 0.0) == from && (corners[(k + 1) % n].0 < 0.0) != from;
        if (0..n).all(|k| !changes(k, true)) {
            continue;
        }
        let joined = corners.iter().map(|c| c.0).sum::<f64>() < 0.0;
        // Walking counter-clockwise round the cell, a piece enters where inside ends and leaves where it begins: joined
        // corners leave pieces that cut off the positive ones, else they cut off the negative ones.
        for f in (0..n).filter(|&k| changes(k, true)) {
            let r = (1..n).map(|i| (f + if joined { i } else { n - i }) % n).find(|&k| changes(k, false));
            next.extend(r.map(|r| (corners[f].1, corners[r].1)));
        }
    }
    let mut loops = Vec::new();
    while let Some((&start, _)) = next.first_key_value() {
        let mut polyline = Vec::new();
        let mut edge = start;
        while let Some(following) = next.remove(&edge) {
            polyline.push(crossing(edge));
            edge = following;
        }
        if edge != start {
            return None;
        }
        polyline.dedup_by(|a, b| (*a - *b).norm() < same);
        if polyline.len() >= 3 {
            loops.push(polyline);
        }
    }
    Some(loops)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::polygon::signed_area;

    fn unit_box() -> Aabb<2> {
        Aabb::new(Point::<2>::new(-1.0, -1.0), Point::<2>::new(1.0, 1.0))
    }

    #[test]
    fn a_ring_has_an_outer_outline_and_a_hole() {
        let ring = |x: &Point<2>| (x.norm() - 0.6).abs() - 0.2;
        let mut areas: Vec<f64> =
            Samples::of(unit_box(), [100, 100], ring).outlines().iter().map(|l| signed_area(l)).collect();
        areas.sort_by(f64::total_cmp);
        assert_eq!(areas.len(), 2);
        assert!((areas[0] + std::f64::consts::PI * 0.16).abs() < 2e-3);
        assert!((areas[1] - std::f64::consts::PI * 0.64).abs() < 2e-3);
    }

    #[test]
    fn a_set_that_fills_the_grid_closes_at_its_edge() {
        let loops = Samples::of(unit_box(), [4, 4], |_| -1.0).outlines();
        assert_eq!(loops.len(), 1);
        assert!((signed_area(&loops[0]) - 4.0).abs() < 0.3);
    }

    #[test]
    fn every_crossing_belongs_to_one_closed_loop() {
        let f = |x: &Point<2>| (9.0 * x[0]).cos() * (7.0 * x[1]).cos() - 0.1;
        let loops = Samples::of(unit_box(), [37, 41], f).outlines();
        let total: f64 = loops.iter().map(|l| signed_area(l)).sum();
        let count = Samples::of(unit_box(), [740, 820], f).values.iter().filter(|v| **v < 0.0).count();
        assert!((total - 4.0 * count as f64 / (741.0 * 821.0)).abs() < 0.03);
    }
}
