//! More points on a surface where what it touches varies over less than a cell.

use super::{BOUNDARY, CellSolid, HeldBy};
use crate::body::Site;
use crate::shapes::spatial;
use signorini_geometry::Point;
use std::collections::BTreeMap;
use std::sync::OnceLock;

/// Boxes along each direction of a cell at most: a cell that would need more is too coarse for what it touches whatever the
/// points.
const MOST_PARTS: usize = 8;

impl<const D: usize> CellSolid<D> {
    /// Replaces the points of a place by those of parts of their cells, where these are farther apart than told.
    pub(super) fn divide(&mut self, on: Option<&str>, apart: &dyn Fn(&Point<3>) -> f64) {
        let name = on.unwrap_or(BOUNDARY);
        let Some(surface) = self.surfaces.get(name) else { return };
        let points = self.points_of(surface);
        let mut parts: BTreeMap<usize, usize> = BTreeMap::new();
        for p in points {
            let between = self.body.bounds_of(p.cell).size().max() / self.body.points_along() as f64;
            let wanted = (between / apart(&spatial(&p.x))).ceil().clamp(1.0, MOST_PARTS as f64) as usize;
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
