//! Fronts and the sizes of cells: how finely fronts are told, and how small cells they want.

use super::{CROWDED, PlaneZone};
use crate::obstacle::Side;
use crate::sizing::Sizing;
use crate::zone::ZoneSizes;
use signorini_fem::{Cells, Grid, RefinedGrid};
use signorini_geometry::{Aabb, ClosedCurve, Point, polygon};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Cells for each radius of curvature of a front, so that Newton's method converges as fast there as along straight ones; of
/// degree 1, whose modes are longer; and between fronts.
const CURVED: f64 = 5.0;
const CURVED_LINEAR: f64 = 8.0;
const BETWEEN: f64 = 3.0;
/// A front that bends within a cell is blunter than it would be on smaller ones: by this much times curvature and size.
const BLUNTED: f64 = 1.3;
/// Outlines that enclose less than this multiple of a cell are those of nodes, not of zones or holes.
const SHAPELESS: f64 = 4.0;

/// What the cells at a place along a front have to resolve.
pub(super) struct Feature {
    place: Point<2>,
    /// The length of front that it stands for.
    length: f64,
    pub curvature: f64,
    /// The distance to another front, or to a part of the same one that is far along it; infinite beyond two cells.
    pub apart: f64,
}

impl PlaneZone {
    /// What cells at the fronts have to resolve, at samples that are so far from each other; distances between fronts as far
    /// as cells of a grid tell them apart.
    pub(super) fn features(&self, grid: &Grid<2>, spacing: f64) -> Vec<Feature> {
        let mut features: Vec<Feature> = Vec::new();
        // For each feature its curve, and how far along it of how much.
        let mut ways: Vec<(usize, f64, f64)> = Vec::new();
        for (c, curve) in self.curves.iter().enumerate() {
            let (first, total) = (features.len(), polygon::perimeter(curve.samples()));
            let mut walked = 0.0;
            for (i, (a, b)) in polygon::edges(curve.samples()).enumerate() {
                let last = ways.last().filter(|_| features.len() > first).map_or(f64::NEG_INFINITY, |way| way.1);
                if walked - last >= spacing {
                    let curvature = curve.point(curve.sample_parameter(i)).curvature.abs().max(f64::MIN_POSITIVE);
                    features.push(Feature { place: *a, length: 0.0, curvature, apart: f64::INFINITY });
                    ways.push((c, walked, total));
                }
                walked += (b - a).norm();
            }
            // Each stands for half of the way to its neighbours.
            let n = features.len() - first;
            for k in 0..n {
                let next = (k + 1) % n;
                let step = (ways[first + next].1 - ways[first + k].1).rem_euclid(total.max(f64::MIN_POSITIVE));
                let step = if n == 1 { total } else { step };
                features[first + k].length += 0.5 * step;
                features[first + next].length += 0.5 * step;
            }
        }
        let mut within: HashMap<[i64; 2], Vec<usize>> = HashMap::new();
        let size = grid.cell_size();
        let cell = |x: &Point<2>| [0, 1].map(|k| ((x[k] - grid.bounds().min[k]) / size[k]).floor() as i64);
        for (k, feature) in features.iter().enumerate() {
            within.entry(cell(&feature.place)).or_default().push(k);
        }
        for k in 0..features.len() {
            let [i, j] = cell(&features[k].place);
            let around = (0..9).filter_map(|o| within.get(&[i + o % 3 - 1, j + o / 3 - 1])).flatten();
            let mut apart = f64::INFINITY;
            for &other in around {
                let distance = (features[k].place - features[other].place).norm();
                if distance < apart {
                    let ((c, s, total), (d, t, _)) = (ways[k], ways[other]);
                    let way = (s - t).abs().min(total - (s - t).abs());
                    // Along one curve, places far from each other on it count.
                    if c != d || way > 4.0 * distance {
                        apart = distance;
                    }
                }
            }
            features[k].apart = apart;
        }
        features
    }
}

impl ZoneSizes<2> for PlaneZone {
    fn within(grid: &Grid<2>, sizing: &Arc<Sizing<2>>, outlines: &[(Side, Vec<Point<2>>)]) -> Self {
        let along = |(side, outline): &(Side, Vec<Point<2>>)| {
            let relative: f64 =
                polygon::edges(outline).map(|(a, b)| (b - a).norm() / sizing.at(&(0.5 * (a + b)))).sum();
            let knots = Self::knots(grid, relative);
            let degree = Self::front_degree(grid);
            (*side, ClosedCurve::evenly_along(outline, degree, knots, |x| 1.0 / sizing.at(x)))
        };
        let has_shape = |(_, outline): &&(Side, Vec<Point<2>>)| {
            let centre = outline.iter().sum::<Point<2>>() / outline.len() as f64;
            polygon::signed_area(outline).abs() > SHAPELESS * sizing.at(&centre).powi(2)
        };
        let curves = outlines.iter().filter(has_shape).map(along).collect();
        Self { sizing: Some(sizing.clone()), ..Self::new(grid, curves) }
    }

    fn on_grid(&self, grid: &Grid<2>) -> Self {
        let fit = |(c, &modes): (&ClosedCurve, &usize)| {
            let wanted = Self::knots(grid, polygon::perimeter(c.samples()) / grid.h());
            let degree = Self::front_degree(grid);
            // A front that has moved far enough for its knots to crowd gets new ones.
            let same = wanted == modes && c.degree() == degree;
            if same && (c.knots() == modes || c.unevenness() < CROWDED) {
                (c.clone(), modes)
            } else {
                (ClosedCurve::along(c.samples(), degree, wanted), wanted)
            }
        };
        let (curves, mode_counts) = self.curves.iter().zip(&self.mode_counts).map(fit).unzip();
        Self { mode_counts, sizing: None, ..self.with_curves(grid, curves) }
    }

    fn on_sizes(&self, grid: &Grid<2>, sizing: &Arc<Sizing<2>>) -> Self {
        let sized = Self { sizing: Some(sizing.clone()), grid: grid.clone(), ..self.clone() };
        let degree = Self::front_degree(grid);
        let fit = |c: &ClosedCurve| {
            let wanted = Self::knots(grid, sized.relative_length(c));
            if c.degree() == degree {
                return sized.redrawn(c, wanted);
            }
            ClosedCurve::evenly_along(c.samples(), degree, wanted, |x| 1.0 / sizing.at(x))
        };
        sized.with_curves(grid, self.curves.iter().map(fit).collect())
    }

    fn sizing(&self, grid: &Grid<2>, [least, most]: [usize; 2], finer: usize) -> Option<Sizing<2>> {
        let divided = |times: usize| grid.h() / f64::from(1u32 << times);
        let places = self.features(grid, divided(most));
        let wanted = |feature: &Feature| {
            let here = self.sizing.as_ref().map_or(self.grid.h(), |s| s.at(&feature.place));
            let blunted = (BLUNTED * feature.curvature * here).max(1.0);
            let curved = if grid.degree() == 1 { CURVED_LINEAR } else { CURVED };
            let size = (1.0 / (curved * feature.curvature * blunted)).min(feature.apart / BETWEEN);
            (size / f64::from(1u32 << finer)).clamp(divided(most), divided(least))
        };
        if places.iter().all(|f| wanted(f) >= grid.h()) {
            return None;
        }
        Some(Sizing::new(places.iter().map(|f| (f.place, f.length, wanted(f)))))
    }

    fn divided(
        &self,
        cells: &Arc<dyn Cells<2>>,
        sizing: &Sizing<2>,
        most: usize,
        also: &dyn Fn(&Aabb<2>, usize) -> bool,
    ) -> Option<Arc<dyn Cells<2>>> {
        let edges: Vec<_> = self.curves.iter().flat_map(|c| polygon::edges(c.samples())).collect();
        if let Some(mesh) = cells.clone().mesh() {
            let mut places = Vec::new();
            for (a, b) in edges {
                let size = sizing.largest(&(0.5 * (a + b)));
                let parts = ((b - a).norm() / size).ceil().max(1.0);
                places.extend((0..parts as usize).map(|k| (a + (b - a) * (k as f64 / parts), size)));
            }
            return Some(Arc::new(mesh.graded(&places, most, also)?));
        }
        let grid = cells.as_grid()?;
        let divisions: Vec<usize> =
            edges.iter().map(|(a, b)| sizing.divisions(&(0.5 * (*a + *b)), grid.h()).min(most)).collect();
        // Of each level the cells of that size within two of them from a front that wants smaller ones.
        let near: Vec<HashSet<[i64; 2]>> = (0..most)
            .map(|level| {
                let size = grid.cell_size() / f64::from(1u32 << level);
                let mut found = HashSet::new();
                for ((a, b), _) in edges.iter().copied().zip(&divisions).filter(|(_, times)| **times > level) {
                    let parts = ((b - a).norm() / size.min()).ceil().max(1.0);
                    for k in 0..parts as usize {
                        let x = a + (b - a) * (k as f64 / parts);
                        let at = [0, 1].map(|k| ((x[k] - grid.bounds().min[k]) / size[k]).floor() as i64);
                        for i in 0..25 {
                            found.insert([at[0] + i % 5 - 2, at[1] + i / 5 - 2]);
                        }
                    }
                }
                found
            })
            .collect();
        let wanted = |b: &Aabb<2>, level: usize| {
            let x = b.center();
            let size = b.size();
            let at = [0, 1].map(|k| ((x[k] - grid.bounds().min[k]) / size[k]).floor() as i64);
            near.get(level).is_some_and(|cells| cells.contains(&at)) || also(b, level)
        };
        Some(Arc::new(RefinedGrid::new(grid, wanted)))
    }
}
