//! The points of places: those of the rules of cells, some of them spread evenly, and more of them where what touches a place
//! varies over less than a cell.

use super::hold::SideFunctions;
use super::weak::WeakHold;
use super::{BOUNDARY, CellSolid};
use crate::cell::Site;
use crate::place::Place;
use crate::shapes::spatial;
use crate::spread::farthest_points;
use signorini_geometry::Point;
use signorini_mechanics as mechanics;
use signorini_mechanics::PlaceError;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Boxes along each direction of a cell at most: a cell that would need more is too coarse for what it touches whatever the
/// points.
const MOST_PARTS: usize = 8;

/// The points of a place, and how it is held.
pub(super) struct Surface<const D: usize> {
    pub place: Place<D>,
    /// Numbers of the first of its points and of the one after the last.
    pub points: [usize; 2],
    pub held: HeldBy<D>,
    /// Points spread evenly, with what they stand for.
    pub spread: OnceLock<Vec<mechanics::Site>>,
}

pub(super) enum HeldBy<const D: usize> {
    /// Unknowns of functions on a side of the box.
    Side(SideFunctions<D>),
    /// Nitsche's terms, made when they are first asked for.
    Terms(OnceLock<WeakHold<D>>),
}

impl<const D: usize> CellSolid<D> {
    pub(super) fn surface(&self, on: Option<&str>) -> Result<&Surface<D>, PlaceError> {
        let name = on.unwrap_or(BOUNDARY);
        self.surfaces.get(name).ok_or_else(|| PlaceError::Unknown {
            body: self.name.clone(),
            group: name.to_string(),
            known: self.surfaces.keys().cloned().collect(),
        })
    }

    pub(super) fn points_of(&self, surface: &Surface<D>) -> &[Site<D>] {
        &self.points[surface.points[0]..surface.points[1]]
    }

    /// Points a spacing apart, each in the middle of those that it stands for, and how far the farthest point is from them,
    /// in spacings.
    pub(super) fn spread(
        &self,
        surface: &Surface<D>,
        spacing: &dyn Fn(&Site<D>) -> f64,
    ) -> (Vec<mechanics::Site>, f64) {
        let points = self.points_of(surface);
        let spacing: Vec<f64> = points.iter().map(spacing).collect();
        let (chosen, nearest, far) = farthest_points(points, &spacing);
        let mut sums = vec![(0.0, Point::<D>::zeros()); chosen.len()];
        for (p, n) in points.iter().zip(&nearest) {
            sums[*n].0 += p.weight;
            sums[*n].1 += p.x * p.weight;
        }
        let mut middle: Vec<(f64, usize)> = vec![(f64::INFINITY, 0); chosen.len()];
        for (k, (p, n)) in points.iter().zip(&nearest).enumerate() {
            let distance = (p.x - sums[*n].1 / sums[*n].0).norm();
            if distance < middle[*n].0 {
                middle[*n] = (distance, k);
            }
        }
        let site = |((weight, _), (_, k)): (&(f64, Point<D>), &(f64, usize))| mechanics::Site {
            patch: (surface.points[0] + k) as u32,
            xi: [0.0; 2],
            weight: *weight,
        };
        (sums.iter().zip(&middle).map(site).collect(), far)
    }

    /// How far apart the points of a cell are.
    pub(super) fn distance_of_points(&self, cell: usize) -> f64 {
        self.body.bounds_of(cell).size().max() / self.body.points_along() as f64
    }

    /// Replaces the points of a place by those of parts of their cells, where these are farther apart than told.
    pub(super) fn divide(&mut self, on: Option<&str>, apart: &dyn Fn(&Point<3>) -> f64) {
        let name = on.unwrap_or(BOUNDARY);
        let Some(surface) = self.surfaces.get(name) else { return };
        let points = self.points_of(surface);
        let mut parts: BTreeMap<usize, usize> = BTreeMap::new();
        for p in points {
            // As dense as wanted up to rounding.
            let times = self.distance_of_points(p.cell) / apart(&spatial(&p.x)) - 1e-6;
            let wanted = times.ceil().clamp(1.0, MOST_PARTS as f64) as usize;
            if wanted > 1 {
                parts.entry(p.cell).and_modify(|most| *most = wanted.max(*most)).or_insert(wanted);
            }
        }
        if parts.is_empty() {
            return;
        }
        let new: Vec<Site<D>> = self.body.points_in_parts(&surface.place, points, &parts);
        self.sheets.include(&self.body, &new);
        // Points of contacts that were made before keep their numbers.
        let range = [self.points.len(), self.points.len() + new.len()];
        self.points.extend(new);
        if let Some(surface) = self.surfaces.get_mut(name) {
            surface.points = range;
            surface.spread = OnceLock::new();
            if let HeldBy::Terms(terms) = &mut surface.held {
                *terms = OnceLock::new();
            }
        }
    }
}
