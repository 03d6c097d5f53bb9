//! Where a point is: its cell, its reference coordinates in a cell, the boundary next to it.

use super::curved::edges;
use super::{DRAWN, MeshCells};
use crate::cells::Cells;
use crate::grid::Grid;
use crate::hierarchic::Values;
use crate::lists::Lists;
use crate::reference::Local;
use crate::small;
use signorini_geometry::{Aabb, Matrix, Point};

/// How far beyond its cell, in reference coordinates, a point still belongs to it.
const ON_THE_EDGE: f64 = 1e-9;

impl MeshCells {
    /// The cell in which a point lies, to rounding.
    pub(super) fn cell_of(&self, x: &Point<2>) -> Option<usize> {
        if (0..2).any(|k| x[k] < self.bounds().min[k] || x[k] > self.bounds().max[k]) {
            return None;
        }
        let inside = |cell: usize| {
            let b = self.bounds_of(cell);
            (0..2).all(|k| x[k] >= b.min[k] && x[k] <= b.max[k])
        };
        let mut best = (ON_THE_EDGE, None);
        let cells_in = self
            .cells_in
            .get_or_init(|| self.lists(|visit| (0..self.count()).for_each(|cell| visit(cell, cell as u32))));
        for &cell in cells_in.of(self.buckets.cell_containing(x)) {
            if !inside(cell as usize) {
                continue;
            }
            let beyond = self.beyond(cell as usize, x);
            if beyond < best.0 {
                best = (beyond, Some(cell as usize));
            }
        }
        best.1
    }

    /// The point of the boundary that is closest to `x`, to a fraction of a cell, if there is one within `reach`.
    pub fn closest_on_boundary(&self, x: &Point<2>, reach: f64) -> Option<Point<2>> {
        let sides_in = self
            .sides_in
            .get_or_init(|| self.lists(|visit| self.sides.iter().zip(0..).for_each(|(side, k)| visit(side.cell, k))));
        let mut best: Option<(f64, Point<2>)> = None;
        let reach_vector = Point::<2>::repeat(reach);
        for_each_bucket(&self.buckets, &Aabb::new(x - reach_vector, x + reach_vector), |bucket| {
            for &k in sides_in.of(bucket) {
                let side = &self.sides[k as usize];
                for (i, pair) in self.drawn[k as usize].windows(2).enumerate() {
                    let (a, along) = (pair[0], pair[1] - pair[0]);
                    let t = ((x - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
                    // A curve is no farther from its chord than that is long.
                    let nearest = (x - a - t * along).norm() - along.norm();
                    if nearest > best.map_or(reach, |b| b.0) {
                        continue;
                    }
                    let y = self.on_side(side, (i as f64 + t) / DRAWN as f64).x;
                    let distance = (x - y).norm();
                    if distance <= reach && best.is_none_or(|(d, _)| distance < d) {
                        best = Some((distance, y));
                    }
                }
            }
        });
        best.map(|(_, y)| y)
    }

    /// For each bucket the numbers that `all` visits with cells which reach into it.
    fn lists(&self, all: impl Fn(&mut dyn FnMut(usize, u32))) -> Lists<u32> {
        Lists::new(self.buckets.cell_count(), |visit| {
            all(&mut |cell, number| {
                for_each_bucket(&self.buckets, &self.bounds_of(cell), |bucket| visit(bucket, number))
            });
        })
    }

    /// Position and derivatives of the map of a cell at reference coordinates.
    pub(super) fn at(&self, cell: usize, xi: &Local) -> (Point<2>, Matrix<2>) {
        if self.bent(cell).is_none() {
            let corners = self.corners(cell);
            let jacobian = edges(&corners);
            return (corners[0] + jacobian * Point::<2>::new(xi[0], xi[1]), jacobian);
        }
        let mut at = Values::default();
        self.mesh.map(cell).tabulate(xi, &mut at);
        self.mesh.jacobian(cell, &at)
    }

    /// Reference coordinates of a point in a cell or near it, and where there are none, far beyond a strongly curved cell,
    /// those of the linear map of its centre.
    pub(super) fn local(&self, cell: usize, x: &Point<2>) -> Local {
        let Some(bent) = self.bent(cell) else {
            let corners = self.corners(cell);
            let first = small::inverse(&edges(&corners)) * (x - corners[0]);
            return [first[0], first[1], 0.0];
        };
        let middle = self.mesh.shape(cell).centre();
        let first = bent.inverse * (x - bent.centre);
        let linear: Local = [middle[0] + first[0], middle[1] + first[1], 0.0];
        // A cell with a nearly straight corner folds just beyond it: of two places for a point the one inside counts.
        let vertices = self.mesh.shape(cell).vertices().iter();
        let vertices = vertices.map(|v| [0, 1, 2].map(|k| middle[k] + 0.8 * (v[k] - middle[k])));
        let mut best: Option<(f64, Local)> = None;
        for start in [linear, middle].into_iter().chain(vertices) {
            let Some(xi) = self.newton(cell, x, start) else { continue };
            let beyond = self.mesh.shape(cell).beyond(&xi);
            if best.is_none_or(|(b, _)| beyond < b) {
                best = Some((beyond, xi));
            }
            if beyond < ON_THE_EDGE || bent.regular {
                break;
            }
        }
        best.map_or(linear, |(_, xi)| xi)
    }

    /// Newton's method for the place of a point; none where it fails or ends where the cell is folded over.
    fn newton(&self, cell: usize, x: &Point<2>, start: Local) -> Option<Local> {
        let mut xi = start;
        for _ in 0..30 {
            let (y, jacobian) = self.at(cell, &xi);
            let step = small::inverse(&jacobian) * (x - y);
            let length = step.norm();
            if !length.is_finite() {
                return None;
            }
            let factor = (0.5 / length).min(1.0);
            xi[0] += factor * step[0];
            xi[1] += factor * step[1];
            if length < 1e-14 {
                break;
            }
        }
        let (y, jacobian) = self.at(cell, &xi);
        let found = (x - y).norm() < 1e-10 * self.bounds_of(cell).radius() && small::determinant(&jacobian) > 0.0;
        found.then_some(xi)
    }

    /// How far a point lies beyond a cell, in reference coordinates.
    fn beyond(&self, cell: usize, x: &Point<2>) -> f64 {
        self.mesh.shape(cell).beyond(&self.local(cell, x))
    }
}

pub(super) fn for_each_bucket(buckets: &Grid<2>, b: &Aabb<2>, mut visit: impl FnMut(usize)) {
    let [low, high] = [&b.min, &b.max].map(|x| buckets.cell_index(buckets.cell_containing(x)));
    for j in low[1]..=high[1] {
        for i in low[0]..=high[0] {
            visit(buckets.cell_at([i, j]));
        }
    }
}
