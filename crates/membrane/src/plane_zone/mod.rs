//! Contact zones in the plane, bounded by smooth closed fronts.

pub(crate) mod extrapolation;
mod modes;
pub(crate) mod motion;
mod near;
mod regions;
mod sheets;
mod sizes;
mod stored;
mod topology;

use crate::obstacle::Side;
use crate::sizing::Sizing;
use crate::zone::{Zone, contact_of};
use near::{NearFronts, rows_enclosed};
pub(crate) use sheets::Straightened;
use signorini_fem::Grid;
use signorini_fem::cut::RegionId;
use signorini_geometry::{Aabb, ClosedCurve, CurvePoint, Point, polygon};
use std::sync::Arc;

/// Fewest knots of a front, which still draw a circle to 3e-5 of its radius.
const FEWEST_KNOTS: f64 = 5.0;
/// Degree of a curve along a level set that is linear between nodes.
const LEVEL_SET_DEGREE: usize = 3;
/// A front that keeps its parameter has so many knots for each mode: in the space of its modes, on another parameter, a few
/// hundredths of the short waves of a step would be left behind. Longer steps begin anew there, so that what no mode sees of a
/// front is what is left of its last, short steps.
const SPLIT: usize = 2;
/// The speed of a front between states of a path differs by this factor at most.
const CROWDED: f64 = 1.5;
/// A front of so many cells is long.
const LONG: f64 = 12.0;

/// Zones bounded by closed curves: outer fronts run counter-clockwise, the rims of holes clockwise.
#[derive(Clone, Debug)]
pub struct PlaneZone {
    curves: Vec<ClosedCurve>,
    /// What the zone that a curve bounds touches.
    sides: Vec<Side>,
    grid: Grid<2>,
    /// How long modes are where they differ in length.
    sizing: Option<Arc<Sizing<2>>>,
    /// The smallest box round each curve.
    boxes: Vec<Aabb<2>>,
    /// Absolute areas: of the curves round a point, the smallest decides where it lies.
    areas: Vec<f64>,
    hole: Vec<bool>,
    /// For each curve, its number among the outer fronts or among the holes.
    number: Vec<usize>,
    /// How many modes each curve has; see [`SPLIT`].
    mode_counts: Vec<usize>,
    near: NearFronts,
    /// For each row of cells, the columns whose centres a curve encloses: first, one behind the last, and the curve.
    rows: Vec<Vec<[u32; 3]>>,
}

impl PlaneZone {
    /// The zone bounded by the given curves, which neither cross each other nor themselves, and what it touches there.
    pub fn new(grid: &Grid<2>, fronts: Vec<(Side, ClosedCurve)>) -> Self {
        let (sides, curves): (Vec<Side>, Vec<ClosedCurve>) = fronts.into_iter().unzip();
        let areas: Vec<f64> = curves.iter().map(|c| polygon::signed_area(c.samples())).collect();
        let hole: Vec<bool> = areas.iter().map(|a| *a < 0.0).collect();
        let mut counts = [0, 0];
        let number = hole
            .iter()
            .map(|&h| {
                counts[usize::from(h)] += 1;
                counts[usize::from(h)] - 1
            })
            .collect();
        let near = NearFronts::new(grid, &curves);
        // As many as can be told apart: its own, but for curves that follow a level set more closely.
        let most = |c: &ClosedCurve| match c.degree() {
            LEVEL_SET_DEGREE => c.knots().min(Self::knots(grid, polygon::perimeter(c.samples()) / grid.h())),
            _ => c.knots(),
        };
        let mode_counts = curves.iter().map(most).collect();
        let rows = rows_enclosed(grid, &curves);
        Self {
            boxes: curves.iter().map(|c| bounding_box(c.samples())).collect(),
            areas: areas.iter().map(|a| a.abs()).collect(),
            hole,
            number,
            mode_counts,
            near,
            rows,
            curves,
            sides,
            grid: grid.clone(),
            sizing: None,
        }
    }

    pub fn curves(&self) -> &[ClosedCurve] {
        &self.curves
    }

    /// The fronts, each with as many knots as modes.
    fn fronts(&self) -> Vec<(Side, ClosedCurve)> {
        let plain = |(c, &modes): (&ClosedCurve, &usize)| {
            if c.degree() != LEVEL_SET_DEGREE && c.knots() == SPLIT * modes {
                self.redrawn(c, modes)
            } else {
                c.clone()
            }
        };
        self.sides.iter().copied().zip(self.curves.iter().zip(&self.mode_counts).map(plain)).collect()
    }

    /// The same zone with other curves in the place of its own.
    fn with_curves(&self, grid: &Grid<2>, curves: Vec<ClosedCurve>) -> Self {
        Self { sizing: self.sizing.clone(), ..Self::new(grid, self.sides.iter().copied().zip(curves).collect()) }
    }

    /// The same zone without some of its curves.
    fn keeping(&self, grid: &Grid<2>, keep: impl Fn(usize) -> bool) -> Self {
        let kept: Vec<usize> = (0..self.curves.len()).filter(|&i| keep(i)).collect();
        let curves = kept.iter().map(|&i| (self.sides[i], self.curves[i].clone())).collect();
        let mode_counts = kept.iter().map(|&i| self.mode_counts[i]).collect();
        Self { mode_counts, sizing: self.sizing.clone(), ..Self::new(grid, curves) }
    }

    /// A curve with so many knots, as far from each other as its cells are large.
    fn redrawn(&self, curve: &ClosedCurve, knots: usize) -> ClosedCurve {
        match &self.sizing {
            None => curve.by_arc_length(knots),
            Some(sizing) => curve.evenly(knots, |x| 1.0 / sizing.at(x)),
        }
    }

    /// The length of a curve relative to the size of its cells.
    fn relative_length(&self, curve: &ClosedCurve) -> f64 {
        match &self.sizing {
            None => polygon::perimeter(curve.samples()) / self.grid.h(),
            Some(sizing) => {
                at_knots(curve).map(|p| p.speed / sizing.at(&p.position)).sum::<f64>() / curve.knots() as f64
            }
        }
    }

    /// The largest product of the curvature of one front and the size of the cells there.
    fn bend_of(&self, front: usize) -> f64 {
        let curve = &self.curves[front];
        match &self.sizing {
            None => curvatures(curve).fold(0.0, f64::max) * self.grid.h(),
            Some(sizing) => at_knots(curve).map(|p| p.curvature.abs() * sizing.at(&p.position)).fold(0.0, f64::max),
        }
    }

    /// The diameter of the disc that is as large as the smallest zone; infinite where there is none.
    pub(crate) fn smallest(&self) -> f64 {
        let areas = self.areas.iter().zip(&self.hole).filter(|(_, hole)| !**hole).map(|(area, _)| *area);
        2.0 * (areas.fold(f64::INFINITY, f64::min) / std::f64::consts::PI).sqrt()
    }

    /// Whether a curve is the rim of a hole.
    pub fn is_hole(&self, curve: usize) -> bool {
        self.hole[curve]
    }

    /// Degree of the front for a grid: `2 p + 1`, so that the geometry is as accurate as the slope jump, and at least 7,
    /// so that a few knots suffice for a round front.
    pub fn front_degree(grid: &Grid<2>) -> usize {
        (2 * grid.degree() + 1).max(7)
    }

    /// The number of knots that the first front would get.
    pub(crate) fn wanted_knots(&self, grid: &Grid<2>) -> usize {
        Self::knots(grid, self.relative_length(&self.curves[0]))
    }

    /// As many knots as the slope jump can tell apart modes on a front of the given length in cells. The front lives in the
    /// space of its modes: what they do not see they could not smooth either.
    fn knots(grid: &Grid<2>, relative: f64) -> usize {
        let (spacing, enough) = match grid.degree() {
            1 => (4.0, (relative / 2.0).clamp(FEWEST_KNOTS, 8.0)),
            2 => (1.5, relative.clamp(FEWEST_KNOTS, 12.0)),
            _ => (1.0, relative.clamp(FEWEST_KNOTS, 12.0)),
        };
        // A short front has as many modes as its shape needs, a very short one no more than it has cells.
        enough.max(relative / spacing).ceil() as usize
    }
}

impl Zone<2> for PlaneZone {
    fn empty(grid: &Grid<2>) -> Self {
        Self::new(grid, Vec::new())
    }

    fn is_empty(&self) -> bool {
        self.curves.is_empty()
    }

    fn counts(&self) -> (usize, usize) {
        let holes = self.hole.iter().filter(|h| **h).count();
        (self.curves.len() - holes, holes)
    }

    fn side_of(&self, zone: usize) -> Side {
        let outer = (0..self.curves.len()).find(|&i| !self.hole[i] && self.number[i] == zone);
        outer.map_or(Side::Below, |i| self.sides[i])
    }

    fn holes_of(&self, zone: usize) -> usize {
        (0..self.curves.len())
            .filter(|&i| self.hole[i])
            .filter(|&i| {
                let x = &self.curves[i].samples()[0];
                let around = (0..self.curves.len())
                    .filter(|&j| j != i && polygon::winding_number(self.curves[j].samples(), x) != 0);
                contact_of(self.region_within(around)).is_some_and(|c| c.1 == zone)
            })
            .count()
    }

    fn distance(&self, x: &Point<2>, within: f64) -> f64 {
        self.distance_to_fronts(x, within)
    }
    fn region_at(&self, x: &Point<2>) -> RegionId {
        self.region_of_point(x)
    }
    fn outlines(&self) -> Vec<Vec<Point<2>>> {
        self.curves.iter().map(|c| c.samples().to_vec()).collect()
    }
}

/// The points of a curve at its knots.
fn at_knots(curve: &ClosedCurve) -> impl Iterator<Item = CurvePoint> + '_ {
    let knots = curve.knots();
    (0..knots).map(move |k| curve.point(k as f64 / knots as f64))
}

/// The curvatures of a curve at its samples, without their signs.
fn curvatures(curve: &ClosedCurve) -> impl Iterator<Item = f64> + '_ {
    (0..curve.samples().len()).map(|i| curve.point(curve.sample_parameter(i)).curvature.abs())
}

/// The smallest box round points.
fn bounding_box(points: &[Point<2>]) -> Aabb<2> {
    Aabb::around(points.iter().copied()).expect("a curve has points")
}
