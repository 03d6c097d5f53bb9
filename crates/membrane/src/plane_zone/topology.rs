//! Zones to which something is added, or from which it is taken away.

use super::{PlaneZone, bounding_box};
use crate::obstacle::Side;
use crate::raster::Raster;
use crate::zone::{Zone, ZoneTopology, contact_of};
use signorini_fem::Grid;
use signorini_geometry::{Aabb, ClosedCurve, Point, polygon};

/// Knots of a circle that is put where penetration is too small for the raster.
const SEED_KNOTS: usize = 16;
/// A front that encloses less than this multiple of `h²` after a step has collapsed.
pub(super) const COLLAPSED: f64 = 0.01;

impl PlaneZone {
    /// Whether the curves are simple, apart, and alternate between fronts and holes from the outside in.
    pub(super) fn is_valid(curves: &[ClosedCurve]) -> bool {
        let boxes: Vec<Aabb<2>> = curves.iter().map(|c| bounding_box(c.samples())).collect();
        let simple = |c: &ClosedCurve| polygon::self_crossing(c.samples()).is_none();
        curves.iter().all(simple)
            && curves.iter().enumerate().all(|(i, a)| {
                let mut depth = 0;
                for (j, b) in curves.iter().enumerate() {
                    if i == j || (0..2).any(|k| boxes[i].max[k] < boxes[j].min[k] || boxes[j].max[k] < boxes[i].min[k])
                    {
                        continue;
                    }
                    let mut inside = a.samples().iter().map(|x| polygon::winding_number(b.samples(), x));
                    let first = inside.next().unwrap_or(0);
                    if inside.any(|w| w != first) {
                        return false;
                    }
                    depth += first;
                }
                depth == i32::from(a.is_hole())
            })
    }

    /// The fronts that are kept and those along outlines found on a raster; outlines too small to hold a front are dropped.
    pub(super) fn from_outlines(
        grid: &Grid<2>,
        mut kept: Vec<(Side, ClosedCurve)>,
        side: Side,
        outlines: &[Vec<Point<2>>],
        least: f64,
    ) -> Self {
        for outline in outlines.iter().filter(|o| polygon::signed_area(o).abs() > least * grid.h().powi(2)) {
            let knots = Self::knots(grid, polygon::perimeter(outline) / grid.h());
            kept.push((side, ClosedCurve::along(outline, Self::front_degree(grid), knots)));
        }
        Self::new(grid, kept)
    }

    /// Joins the raster of a function to the zone by `combine`, or adds its outlines as curves of their own where they
    /// keep clear of the fronts.
    fn combined(
        &self,
        grid: &Grid<2>,
        side: Side,
        f: &mut dyn FnMut(&Point<2>) -> f64,
        reverse: bool,
        combine: fn(f64, f64) -> f64,
    ) -> Self {
        let other = Raster::of_function(grid, f);
        let mut outlines = other.outlines();
        if reverse {
            for outline in &mut outlines {
                outline.reverse();
            }
        }
        let clear = outlines
            .iter()
            .flatten()
            .all(|x| self.curves.iter().flat_map(|c| c.samples()).all(|y| (x - y).norm() > 0.75 * grid.h()));
        if clear {
            let zone = Self::from_outlines(grid, self.fronts(), side, &outlines, 1e-3);
            if Self::is_valid(&zone.curves) {
                return zone;
            }
        }
        let (own, others): (Vec<_>, Vec<_>) = self.fronts().into_iter().partition(|f| f.0 == side);
        let own: Vec<ClosedCurve> = own.into_iter().map(|f| f.1).collect();
        let mut raster = Raster::of_curves(grid, &own);
        raster.combine(&other, combine);
        Self::from_outlines(grid, others, side, &raster.outlines(), COLLAPSED)
    }
}

impl ZoneTopology<2> for PlaneZone {
    fn united(&self, grid: &Grid<2>, side: Side, f: &mut dyn FnMut(&Point<2>) -> f64) -> Self {
        self.combined(grid, side, f, false, f64::min)
    }

    fn reduced(&self, grid: &Grid<2>, f: &mut dyn FnMut(&Point<2>) -> f64) -> Self {
        let both = Side::BOTH.iter().all(|side| self.sides.contains(side));
        Side::BOTH.into_iter().filter(|side| self.sides.contains(side)).fold(self.clone(), |zone, side| {
            let other = |x: &Point<2>| both && contact_of(self.region_at(x)).is_some_and(|c| c.0 != side);
            let mut own = |x: &Point<2>| if other(x) { 1.0 } else { f(x) };
            zone.combined(grid, side, &mut own, true, |zone, removed| zone.max(-removed))
        })
    }

    fn without(&self, grid: &Grid<2>, part: usize) -> Self {
        let Some(outer) = (0..self.curves.len()).find(|&i| !self.hole[i] && self.number[i] == part) else {
            return self.clone();
        };
        let within = |i: usize| {
            self.hole[i] && polygon::winding_number(self.curves[outer].samples(), &self.curves[i].samples()[0]) != 0
        };
        self.keeping(grid, |i| i != outer && !within(i))
    }

    fn filled(&self, grid: &Grid<2>, closes: &dyn Fn(Side, &[Point<2>], f64) -> bool) -> Option<Self> {
        let empty = |i: usize| {
            let hole = self.curves[i].samples();
            let within = |c: &ClosedCurve| polygon::winding_number(hole, &c.samples()[0]) != 0;
            (0..self.curves.len()).all(|j| j == i || !within(&self.curves[j]))
        };
        let closing =
            |i: usize| self.hole[i] && closes(self.sides[i], self.curves[i].samples(), self.areas[i]) && empty(i);
        let kept: Vec<bool> = (0..self.curves.len()).map(|i| !closing(i)).collect();
        kept.contains(&false).then(|| self.keeping(grid, |i| kept[i]))
    }

    fn seeded(&self, grid: &Grid<2>, side: Side, x: &Point<2>, radius: f64) -> Self {
        let circle: Vec<Point<2>> = (0..SEED_KNOTS)
            .map(|i| {
                let (sin, cos) = (std::f64::consts::TAU * i as f64 / SEED_KNOTS as f64).sin_cos();
                x + radius * Point::<2>::new(cos, sin)
            })
            .collect();
        let mut fronts = self.fronts();
        fronts.push((side, ClosedCurve::through(&circle, Self::front_degree(grid))));
        let zone = Self::new(grid, fronts);
        if Self::is_valid(&zone.curves) { zone } else { self.clone() }
    }
}
