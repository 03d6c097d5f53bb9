//! The cells of a spline that a face has part in, and the closest point among those of the face.
//!
//! Inside a face the closest point is one where the distance is stationary. A cell is left where its bounds show that it holds
//! nothing closer, or nothing stationary; where the distance is convex over it, Newton's method finds the one such point, which
//! counts if the face contains it. The borders of the face are edges of the body, and searched as such; what the surface has
//! inside besides, creases and poles, are cells without width.

use super::region::Region;
use crate::closest::bounds::{PairExpansion, box_bound};
use crate::closest::newton::minimise;
use crate::patch::{Cell, PointChart, Side};
use crate::shape::Surface;
use crate::{Aabb, Point};

/// Cells of a piece that are kept; a search refines further where it must.
const CELLS_PER_PIECE: usize = 127;
/// Cells flatter than this share of their size are left to the search.
const FLATNESS: f64 = 0.06;
/// Cells after which a search takes what it has: a point equally far from a whole part of a surface, of which each place is as
/// good to rounding.
const MOST_CELLS: usize = 100_000;
/// Cosine of the angle between distance and tangent up to which a cell's end is looked at as stationary: far above rounding.
const NEARLY: f64 = 1e-6;

#[derive(Clone, Debug)]
pub(super) struct Leaf {
    cell: Cell<2>,
    is_inside: bool,
}

#[derive(Clone, Debug)]
pub(super) struct SplineTree {
    pub leaves: Vec<Leaf>,
    /// Points at which all values of one parameter meet.
    pub poles: Vec<[f64; 2]>,
}

/// The closest point so far.
#[derive(Clone, Copy, Debug)]
pub(super) struct Best {
    pub distance: f64,
    pub z: [f64; 2],
    pub x: Point<3>,
}

/// A search from a point.
pub(super) struct Search<'a> {
    pub surface: &'a Surface,
    pub region: &'a Region,
    pub from: Point<3>,
    at: Cell<0>,
    /// Below this no difference counts.
    pub rounding: f64,
    pub best: Option<Best>,
    /// Nothing farther than this is wanted.
    pub limit: f64,
    cells: usize,
}

/// Where parameters of a cell lie.
#[derive(PartialEq)]
enum Place {
    Inside,
    Outside,
    Across,
}

fn place(surface: &Surface, region: &Region, cell: &Cell<2>) -> Place {
    let map = &surface.atlas.pieces[cell.piece as usize].map;
    let [low, high] = [0, 1].map(|side| map.apply(&[cell.range(0)[side], cell.range(1)[side]]));
    let middle = [0, 1].map(|k| 0.5 * (low[k] + high[k]));
    let half = [0, 1].map(|k| 0.5 * (high[k] - low[k]) * region.scale[k]);
    let reach = half[0].hypot(half[1]) + region.band;
    match region.signed(middle).0 {
        d if d > reach => Place::Inside,
        d if d < -reach => Place::Outside,
        _ => Place::Across,
    }
}

impl SplineTree {
    pub fn new(surface: &Surface, region: &Region) -> Self {
        let (mut leaves, mut poles) = (Vec::new(), Vec::new());
        let atlas = &surface.atlas;
        for (number, piece) in atlas.pieces.iter().enumerate() {
            let mut roots = vec![([0.0; 2], [1.0; 2])];
            // Creases are lines, and points where they cross.
            let creases = |k: usize| {
                [0, 1]
                    .into_iter()
                    .filter(move |s| matches!(piece.sides[k][*s], Side::Crease(_)))
                    .map(|s| [-1.0, 1.0][s])
            };
            roots.extend(creases(0).map(|s| ([s, 0.0], [0.0, 1.0])));
            roots.extend(creases(1).map(|s| ([0.0, s], [1.0, 0.0])));
            roots.extend(creases(0).flat_map(|s| creases(1).map(move |t| ([s, t], [0.0; 2]))));
            for k in 0..2 {
                for side in 0..2 {
                    if matches!(piece.sides[k][side], Side::Pole | Side::Collapsed(_)) {
                        let mut s = [0.0; 2];
                        s[k] = [-1.0, 1.0][side];
                        poles.push(piece.map.apply(&s));
                    }
                }
            }
            let mut stack: Vec<(Cell<2>, bool)> =
                roots.into_iter().map(|(m, h)| (atlas.cell(number as u32, m, h), false)).collect();
            let mut count = 0;
            while let Some((cell, is_inside)) = stack.pop() {
                let is_inside = is_inside
                    || match place(surface, region, &cell) {
                        Place::Outside => continue,
                        other => other == Place::Inside,
                    };
                count += 1;
                let is_flat = cell.rho2 <= FLATNESS * (cell.radius() - cell.rho2);
                let is_point = cell.half == [0.0; 2];
                if is_point || count > CELLS_PER_PIECE || is_flat && (is_inside || count > CELLS_PER_PIECE / 2) {
                    leaves.push(Leaf { cell, is_inside });
                } else {
                    stack.extend(atlas.halve(&cell).map(|half| (half, is_inside)));
                }
            }
        }
        SplineTree { leaves, poles }
    }

    pub fn bounds(&self) -> Aabb<3> {
        let boxes = self.leaves.iter().map(Leaf::bounds);
        boxes.reduce(|a, b| a.joined(&b)).unwrap_or(Aabb::new(Point::<3>::zeros(), Point::<3>::zeros()))
    }
}

impl Leaf {
    pub fn bounds(&self) -> Aabb<3> {
        Aabb::new(self.cell.hull[0], self.cell.hull[1])
    }
}

impl<'a> Search<'a> {
    pub fn new(surface: &'a Surface, region: &'a Region, from: Point<3>, limit: f64) -> Self {
        let map = crate::patch::ParameterMap::Projective { low: [], high: [], ratio: [] };
        let point = crate::patch::Atlas::new(vec![crate::patch::Piece::new(PointChart(from), map, [])]);
        let at = point.cell(0, [], []);
        let rounding = 64.0 * f64::EPSILON * surface.atlas.magnitude.max(from.amax());
        Search { surface, region, from, at, rounding, best: None, limit, cells: 0 }
    }

    /// Looks through a leaf; `contains` says whether parameters and the position there are of the face.
    pub fn leaf(&mut self, leaf: &Leaf, contains: &dyn Fn([f64; 2], &Point<3>) -> bool) {
        self.descend(&leaf.cell, leaf.is_inside, contains);
    }

    fn offer(&mut self, piece: u32, s: &[f64; 2], contains: &dyn Fn([f64; 2], &Point<3>) -> bool) {
        let piece = &self.surface.atlas.pieces[piece as usize];
        let x = crate::patch::Chart::position(&piece.chart, s);
        let distance = (x - self.from).norm();
        if distance >= self.limit {
            return;
        }
        let z = piece.map.apply(s);
        if contains(z, &x) {
            self.limit = distance;
            self.best = Some(Best { distance, z, x });
        }
    }

    fn descend(&mut self, cell: &Cell<2>, is_inside: bool, contains: &dyn Fn([f64; 2], &Point<3>) -> bool) {
        let enough = self.limit - self.rounding;
        if box_bound(&self.at, cell) >= enough || self.cells > MOST_CELLS {
            return;
        }
        self.cells += 1;
        let expansion = PairExpansion::<2>::new(&self.at, cell);
        if is_inside {
            self.offer(cell.piece, &cell.middle, &|_, _| true);
        }
        if expansion.linear_bound(&self.at, cell) >= enough {
            return;
        }
        let free = cell.half.map(|h| h > 0.0);
        if free == [false; 2] {
            self.offer(cell.piece, &cell.middle, contains);
            return;
        }
        let second = expansion.second_order(&self.at, cell);
        if expansion.quadratic_bound(&second, &self.at, cell) >= enough {
            return;
        }
        if (0..2).any(|k| free[k] && second.slope_sign(&expansion.g, k) != 0) {
            return;
        }
        let settled = (0..2).map(|k| second.drift[k][k]).sum::<f64>()
            < 2.0 * (0..2).map(|k| second.hessian[k][k].abs()).sum::<f64>();
        if settled && second.is_convex(&free) && self.solve(cell, free, contains) {
            return;
        }
        if settled && second.excludes_stationary(&expansion.gram, &expansion.g, &free, &[[false; 2]; 2], &[0.0; 2]) {
            return;
        }
        if cell.radius() <= self.rounding {
            self.offer(cell.piece, &cell.middle, contains);
            return;
        }
        let mut halves = self.surface.atlas.halve(cell);
        if (halves[1].x - self.from).norm_squared() < (halves[0].x - self.from).norm_squared() {
            halves.swap(0, 1);
        }
        for half in &halves {
            let inside = is_inside
                || match place(self.surface, self.region, half) {
                    Place::Outside => continue,
                    other => other == Place::Inside,
                };
            self.descend(half, inside, contains);
        }
    }

    /// The minimum over a cell that is convex; false where Newton's method does not arrive at it.
    fn solve(&mut self, cell: &Cell<2>, free: [bool; 2], contains: &dyn Fn([f64; 2], &Point<3>) -> bool) -> bool {
        let chart = &self.surface.atlas.pieces[cell.piece as usize].chart;
        let point = PointChart(self.from);
        let (low, high) = ([0, 1].map(|k| cell.range(k)[0]), [0, 1].map(|k| cell.range(k)[1]));
        let magnitude = self.surface.atlas.magnitude.max(self.from.amax());
        let found = minimise::<0, 2, 2>(&point, chart, &low, &high, cell.middle, magnitude);
        if !found.stationary {
            return false;
        }
        // Where it is pressed against an end of the cell, nothing in the cell is stationary: at most its neighbour goes on.
        let jet = crate::patch::Chart::jet(chart, &found.z);
        let d = jet.x - self.from;
        let slope = |k: usize| jet.d[k].dot(&d).abs() / (jet.d[k].norm() * (d.norm() + 1e-3 * magnitude));
        if (0..2).any(|k| free[k] && slope(k) > NEARLY) {
            return true;
        }
        let at_end = (0..2).any(|k| free[k] && (found.z[k] == low[k] || found.z[k] == high[k]));
        let mut z = found.z;
        if at_end {
            let bounds = |side: f64| [0, 1].map(|k| if free[k] { side } else { cell.middle[k] });
            z = minimise::<0, 2, 2>(&point, chart, &bounds(-1.0), &bounds(1.0), found.z, magnitude).z;
        }
        self.offer(cell.piece, &z, contains);
        true
    }
}
