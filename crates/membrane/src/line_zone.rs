//! Contact zones in one dimension: intervals.

use crate::method::ModeSpace;
use crate::mode_matrix::Clique;
use crate::obstacle::Side;
use crate::sizing::Sizing;
use crate::zone::{
    Advance, Division, FrontFoot, FrontsInCell, Stored, Zone, ZoneFronts, ZoneMotion, ZoneSizes, ZoneTopology, contact,
    free,
};
use serde_json::{Value, json};
use signorini_fem::Grid;
use signorini_fem::cut::RegionId;
use signorini_geometry::{Aabb, ImplicitShape, Point, Vector};
use std::sync::Arc;

/// Zones that touch different sides are at least this fraction of a cell apart.
const APART: f64 = 1e-3;

/// Disjoint intervals in ascending order. An end beyond the membrane is not a front: there the zone reaches the end.
#[derive(Clone, Debug)]
pub struct LineZone {
    pub intervals: Vec<[f64; 2]>,
    /// What each of them touches.
    sides: Vec<Side>,
    grid: Grid<1>,
}

/// The signed distance to an end of an interval.
struct End {
    at: f64,
    normal: f64,
}

impl ImplicitShape<1> for End {
    fn value(&self, x: &Point<1>) -> f64 {
        self.normal * (x[0] - self.at)
    }
    fn gradient(&self, _: &Point<1>) -> Vector<1> {
        Vector::<1>::new(self.normal)
    }
}

impl LineZone {
    /// Intervals that overlap are united; where they touch different sides the left one keeps what they share.
    pub fn new(grid: &Grid<1>, mut intervals: Vec<(Side, [f64; 2])>) -> Self {
        let bounds = grid.bounds();
        intervals.retain(|(_, [a, b])| b > a && *b > bounds.min[0] && *a < bounds.max[0]);
        intervals.sort_by(|a, b| a.1[0].total_cmp(&b.1[0]));
        let mut merged: Vec<(Side, [f64; 2])> = Vec::new();
        for (side, [a, b]) in intervals {
            match merged.last_mut() {
                Some((same, last)) if a <= last[1] && *same == side => last[1] = last[1].max(b),
                Some((_, last)) if a <= last[1] => {
                    let a = last[1] + APART * grid.h();
                    merged.extend((b > a).then_some((side, [a, b])));
                }
                _ => merged.push((side, [a, b])),
            }
        }
        let (sides, intervals) = merged.into_iter().unzip();
        Self { intervals, sides, grid: grid.clone() }
    }

    fn parts(&self) -> Vec<(Side, [f64; 2])> {
        self.sides.iter().copied().zip(self.intervals.iter().copied()).collect()
    }

    /// The same zone with its intervals elsewhere.
    fn moved(&self, grid: &Grid<1>, to: impl Fn(usize, [f64; 2]) -> [f64; 2]) -> Self {
        Self::new(grid, self.parts().into_iter().enumerate().map(|(k, (side, ends))| (side, to(k, ends))).collect())
    }

    /// Front `2 i` is the left end of interval `i`, front `2 i + 1` its right end.
    fn end(&self, front: usize) -> End {
        End { at: self.intervals[front / 2][front % 2], normal: if front.is_multiple_of(2) { -1.0 } else { 1.0 } }
    }

    fn bounds(&self) -> &Aabb<1> {
        self.grid.bounds()
    }

    /// The intervals where a sampled function is negative, reaching beyond the ends where it is negative there.
    fn where_negative(grid: &Grid<1>, f: &mut dyn FnMut(&Point<1>) -> f64) -> Vec<[f64; 2]> {
        let (a, length) = (grid.bounds().min[0], grid.bounds().size()[0]);
        let n = grid.cells()[0] * 8 * grid.degree();
        let at = |i: usize| a + length * i as f64 / n as f64;
        let values: Vec<f64> = (0..=n).map(|i| f(&Point::<1>::new(at(i)))).collect();
        let mut found = Vec::new();
        let mut begin = (values[0] < 0.0).then_some(a - length);
        for i in 0..n {
            let crossing = at(i) + (at(i + 1) - at(i)) * values[i] / (values[i] - values[i + 1]);
            match (values[i] < 0.0, values[i + 1] < 0.0) {
                (false, true) => begin = Some(crossing),
                (true, false) => found.extend(begin.take().map(|b| [b, crossing])),
                _ => {}
            }
        }
        found.extend(begin.map(|b| [b, a + 2.0 * length]));
        found
    }

    /// The region of a point that lies on the inner side of the ends for which `inner` holds.
    fn region_by(&self, inner: impl Fn(usize) -> bool) -> RegionId {
        match (0..self.intervals.len()).find(|i| inner(2 * i) && inner(2 * i + 1)) {
            Some(k) => contact(self.sides[k], k),
            None => free((0..self.intervals.len()).filter(|i| !inner(2 * i + 1)).count()),
        }
    }
}

impl Division<1> for LineZone {
    fn fronts_in(&self, b: &Aabb<1>) -> FrontsInCell<'_, 1> {
        let near: Vec<usize> = (0..self.front_count())
            .filter(|&i| {
                let at = self.end(i).at;
                at >= b.min[0] && at <= b.max[0]
            })
            .collect();
        let center = b.center();
        let fronts = near.clone();
        FrontsInCell {
            sheets: near.iter().map(|&i| Box::new(self.end(i)) as Box<dyn ImplicitShape<1>>).collect(),
            features: Vec::new(),
            region: Box::new(move |values| {
                // On which side of each end: by its sheet where it is near, else as the centre of the cell.
                self.region_by(|front| {
                    let near = fronts.iter().position(|f| *f == front).and_then(|at| values.get(at));
                    near.copied().unwrap_or_else(|| self.end(front).value(&center)) < 0.0
                })
            }),
            fronts: near,
        }
    }
}

impl Zone<1> for LineZone {
    fn empty(grid: &Grid<1>) -> Self {
        Self::new(grid, Vec::new())
    }
    fn is_empty(&self) -> bool {
        self.intervals.is_empty()
    }
    fn counts(&self) -> (usize, usize) {
        (self.intervals.len(), 0)
    }
    fn side_of(&self, zone: usize) -> Side {
        self.sides[zone]
    }
    fn holes_of(&self, _: usize) -> usize {
        0
    }
    fn distance(&self, x: &Point<1>, _: f64) -> f64 {
        (0..self.front_count()).map(|i| (self.end(i).at - x[0]).abs()).fold(f64::INFINITY, f64::min)
    }
    fn region_at(&self, x: &Point<1>) -> RegionId {
        self.region_by(|front| self.end(front).value(x) < 0.0)
    }
    fn outlines(&self) -> Vec<Vec<Point<1>>> {
        self.intervals.iter().map(|i| i.iter().map(|&x| self.bounds().clamp(&Point::<1>::new(x))).collect()).collect()
    }
}

impl ZoneFronts<1> for LineZone {
    fn foot(&self, front: usize, _: &Point<1>, _: ModeSpace) -> FrontFoot<1> {
        let End { at, normal } = self.end(front);
        FrontFoot {
            position: Point::<1>::new(at),
            parameter: 0.0,
            normal: Vector::<1>::new(normal),
            curvature: 0.0,
            modes: vec![(front, 1.0, Vector::zeros())],
        }
    }
    fn front_count(&self) -> usize {
        2 * self.intervals.len()
    }
    fn mode_offsets(&self, _: ModeSpace) -> Vec<usize> {
        (0..=self.front_count()).collect()
    }
    fn stiffness(&self, _: ModeSpace, front: usize, weight: f64) -> Vec<Clique> {
        // A point has no length; an end beyond the membrane stays where it is.
        vec![(vec![front as u32], vec![weight])]
    }
    fn sharpest(&self) -> f64 {
        let shortest = self.intervals.iter().map(|[a, b]| b - a).fold(f64::INFINITY, f64::min);
        2.0 / shortest
    }
    fn least_feature(&self) -> f64 {
        f64::INFINITY
    }
    fn bend(&self) -> f64 {
        0.0
    }
}

impl ZoneMotion<1> for LineZone {
    fn advanced(&self, grid: &Grid<1>, _: ModeSpace, step: &[f64], reach: f64) -> Advance<Self> {
        let step = |front: usize| step[front].clamp(-reach, reach);
        let zone = self.moved(grid, |i, [a, b]| [a - step(2 * i), b + step(2 * i + 1)]);
        Advance { topology_changed: zone.intervals.len() != self.intervals.len(), zone }
    }
    fn extrapolated(&self, grid: &Grid<1>, before: &[(&Self, f64)]) -> Option<Self> {
        if before.iter().any(|(zone, _)| zone.sides != self.sides) {
            return None;
        }
        let ahead = |k: usize, side: usize| {
            let now = self.intervals[k][side];
            now + before.iter().map(|(zone, multiple)| multiple * (now - zone.intervals[k][side])).sum::<f64>()
        };
        Some(self.moved(grid, |k, _| [ahead(k, 0), ahead(k, 1)]))
            .filter(|zone| zone.intervals.len() == self.intervals.len())
    }
}

impl ZoneTopology<1> for LineZone {
    fn united(&self, grid: &Grid<1>, side: Side, f: &mut dyn FnMut(&Point<1>) -> f64) -> Self {
        let mut all = self.parts();
        all.extend(Self::where_negative(grid, f).into_iter().map(|interval| (side, interval)));
        Self::new(grid, all)
    }
    fn reduced(&self, grid: &Grid<1>, f: &mut dyn FnMut(&Point<1>) -> f64) -> Self {
        let holes = Self::where_negative(grid, f);
        let mut left = self.parts();
        for [c, d] in holes {
            let around = |&(side, [a, b]): &(Side, [f64; 2])| [(side, [a, b.min(c)]), (side, [a.max(d), b])];
            left = left.iter().flat_map(around).filter(|(_, [a, b])| b > a).collect();
        }
        Self::new(grid, left)
    }
    fn without(&self, grid: &Grid<1>, part: usize) -> Self {
        let kept = self.parts().into_iter().enumerate().filter(|(i, _)| *i != part).map(|(_, interval)| interval);
        Self::new(grid, kept.collect())
    }
    fn seeded(&self, grid: &Grid<1>, side: Side, x: &Point<1>, radius: f64) -> Self {
        let mut all = self.parts();
        all.push((side, [x[0] - radius, x[0] + radius]));
        Self::new(grid, all)
    }
}

impl ZoneSizes<1> for LineZone {
    fn within(grid: &Grid<1>, _: &Arc<Sizing<1>>, _: &[(Side, Vec<Point<1>>)]) -> Self {
        Self::empty(grid)
    }
    fn on_grid(&self, grid: &Grid<1>) -> Self {
        Self::new(grid, self.parts())
    }
}

impl Stored<1> for LineZone {
    fn to_json(&self) -> Value {
        json!({"intervals": self.intervals, "above": self.sides.iter().map(|s| *s == Side::Above).collect::<Vec<_>>()})
    }
    fn from_json(grid: &Grid<1>, value: &Value) -> Option<Self> {
        let intervals: Vec<[f64; 2]> = serde_json::from_value(value["intervals"].clone()).ok()?;
        let above: Vec<bool> = serde_json::from_value(value["above"].clone()).ok()?;
        let side = |above: bool| if above { Side::Above } else { Side::Below };
        (above.len() == intervals.len()).then(|| Self::new(grid, above.into_iter().map(side).zip(intervals).collect()))
    }
}
