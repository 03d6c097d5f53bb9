//! Fronts that go on the way that they went.

use super::motion::FOLD;
use super::{CROWDED, PlaneZone};
use signorini_fem::Grid;
use signorini_geometry::{ClosedCurve, CurvePoint, Point, polygon};

/// Fronts that would move by less than this part of a cell have been there before.
const SAME: f64 = 1e-9;

impl PlaneZone {
    /// The zone with its fronts moved by a sum of multiples of the ways that they have come since earlier zones. They are told as
    /// finely as this zone, which may be on smaller cells than the next solve begins with.
    pub(super) fn ahead(&self, grid: &Grid<2>, before: &[(&Self, f64)]) -> Option<Self> {
        if before.iter().any(|(zone, _)| zone.hole != self.hole || zone.sides != self.sides) {
            return None;
        }
        let mut moved = Vec::with_capacity(self.curves.len());
        let mut farthest = 0.0f64;
        for (i, now) in self.curves.iter().enumerate() {
            let ahead = |x: &Point<2>| -> f64 {
                let way = |zone: &Self| {
                    let then = &zone.curves[i];
                    then.signed_distance(x, 0..then.samples().len()).0
                };
                before.iter().map(|(zone, multiple)| multiple * way(zone)).sum()
            };
            // Fronts that have little to do with each other, or sharp ones, are better left where they are.
            let mut small = |p: &CurvePoint| {
                let w = ahead(&p.position);
                farthest = farthest.max(w.abs());
                w.abs() < 2.0 * grid.h() && -w * p.curvature < 1.0 - FOLD
            };
            if !(0..now.samples().len()).all(|k| small(&now.point(now.sample_parameter(k)))) {
                return None;
            }
            let n = 4 * now.knots();
            let mut ways: Vec<f64> = (0..n).map(|k| ahead(&now.position(k as f64 / n as f64))).collect();
            if self.grid.degree() == 1 {
                // Waves as short as the cells of a state come and go with these: from one state to another they only add up.
                ways = without_waves(&ways, n / self.mode_counts[i]);
            }
            let curve = now.offset(n, |p| ways[(p.s * n as f64).round() as usize % n]);
            // The next cells have sizes of their own, and modes too.
            moved.push(if now.unevenness() > CROWDED {
                curve
            } else {
                curve.by_arc_length(Self::knots(&self.grid, polygon::perimeter(curve.samples()) / self.grid.h()))
            });
        }
        if farthest < SAME * self.grid.h() {
            return Some(self.clone());
        }
        Self::is_valid(&moved).then(|| self.with_curves(&self.grid, moved))
    }

    /// How far the fronts are from those of another zone, at the place where that is farthest relative to a size.
    pub(super) fn farthest_way(&self, other: &Self, size: &dyn Fn(&Point<2>) -> f64) -> Option<f64> {
        if other.hole != self.hole || other.sides != self.sides {
            return None;
        }
        let of_curve = |(own, other): (&ClosedCurve, &ClosedCurve)| {
            let way = |x: &Point<2>| other.signed_distance(x, 0..other.samples().len()).0.abs() / size(x);
            own.samples().iter().map(way).fold(0.0, f64::max)
        };
        Some(self.curves.iter().zip(&other.curves).map(of_curve).fold(0.0, f64::max))
    }
}

/// Values evenly round a curve without their waves of a length, given in values: they are gone, those twice as long are halved.
pub fn without_waves(values: &[f64], length: usize) -> Vec<f64> {
    let n = values.len();
    if length == 0 || 2 * length > n {
        return values.to_vec();
    }
    let bell: Vec<f64> =
        (0..2 * length).map(|k| 1.0 - (std::f64::consts::PI * k as f64 / length as f64).cos()).collect();
    let mean = |i: usize| bell.iter().enumerate().map(|(k, w)| w * values[(i + n + k - length) % n]).sum::<f64>();
    (0..n).map(|i| mean(i) / (2 * length) as f64).collect()
}
