//! Fronts as a sampled level set: where zones merge, split, appear and vanish.

use signorini_fem::Grid;
use signorini_geometry::outline::Samples;
use signorini_geometry::{Aabb, ClosedCurve, Point, polygon};

/// Samples along the longer side beyond which cells are not divided for the raster.
const ENOUGH: usize = 800;

/// Samples per cell edge.
fn refinement(grid: &Grid<2>) -> usize {
    let longest = grid.cells().into_iter().max().unwrap_or(1);
    (ENOUGH / longest).clamp(1, if grid.degree() == 1 { 3 } else { 4 })
}

/// A function sampled on a grid finer than the cells, which reaches a few cells beyond the membrane so that a zone may
/// run over a free edge.
pub struct Raster(Samples);

impl Raster {
    fn frame(grid: &Grid<2>) -> (Aabb<2>, [usize; 2]) {
        const MARGIN: usize = 3;
        let size = grid.cell_size();
        let bounds = grid.bounds();
        let margin = MARGIN as f64 * size;
        let cells = grid.cells().map(|n| (n + 2 * MARGIN) * refinement(grid));
        (Aabb::new(bounds.min - margin, bounds.max + margin), cells)
    }

    /// Samples a function; nodes beyond the grid take the value at the nearest point of the grid.
    pub fn of_function(grid: &Grid<2>, f: &mut dyn FnMut(&Point<2>) -> f64) -> Self {
        let (frame, cells) = Self::frame(grid);
        Self(Samples::of(frame, cells, |x| f(&grid.bounds().clamp(x))))
    }

    /// The signed distance to oriented curves near them, and elsewhere its sign: a point is inside where the curves
    /// wind round it at least once, so overlapping zones unite and zones turned inside out vanish.
    pub fn of_curves(grid: &Grid<2>, curves: &[ClosedCurve]) -> Self {
        let (frame, cells) = Self::frame(grid);
        let far = frame.radius();
        let mut samples = Samples { bounds: frame, cells, values: vec![far; (cells[0] + 1) * (cells[1] + 1)] };
        let size = Point::<2>::from_fn(|k, _| frame.size()[k] / cells[k] as f64);
        let mut distance = samples.values.clone();
        let mut crossings: Vec<Vec<(f64, i32)>> = vec![Vec::new(); cells[1] + 1];
        let index = |v: f64, k: usize| (v - frame.min[k]) / size[k];
        let clamp = |v: f64, k: usize| (v.max(0.0) as usize).min(cells[k]);
        for (a, b) in curves.iter().flat_map(|c| polygon::edges(c.samples())) {
            let range = |k: usize| clamp(index(a[k].min(b[k]), k) - 1.0, k)..=clamp(index(a[k].max(b[k]), k) + 2.0, k);
            for j in range(1) {
                for i in range(0) {
                    let at = j * (cells[0] + 1) + i;
                    distance[at] = distance[at].min(polygon::segment_distance(a, b, &samples.node(i, j)));
                }
            }
            let (low, high, direction) = if a[1] <= b[1] { (a, b, 1) } else { (b, a, -1) };
            let row = |y: f64| index(y, 1).ceil().max(0.0) as usize;
            for (j, crossed) in crossings.iter_mut().enumerate().take(row(high[1])).skip(row(low[1])) {
                let y = samples.node(0, j)[1];
                crossed.push((low[0] + (high[0] - low[0]) * (y - low[1]) / (high[1] - low[1]), direction));
            }
        }
        for (j, mut crossed) in crossings.into_iter().enumerate() {
            crossed.sort_by(|a, b| b.0.total_cmp(&a.0));
            // From the right: upward crossings to the right of a point wind round it once.
            let (mut winding, mut next) = (0, 0);
            for i in (0..=cells[0]).rev() {
                let x = samples.node(i, j)[0];
                while next < crossed.len() && crossed[next].0 > x {
                    winding += crossed[next].1;
                    next += 1;
                }
                let at = j * (cells[0] + 1) + i;
                samples.values[at] = if winding >= 1 { -distance[at] } else { distance[at] };
            }
        }
        Self(samples)
    }

    /// Replaces every value by a function of it and that of another raster.
    pub fn combine(&mut self, other: &Self, f: fn(f64, f64) -> f64) {
        for (a, b) in self.0.values.iter_mut().zip(&other.0.values) {
            *a = f(*a, *b);
        }
    }

    pub fn outlines(&self) -> Vec<Vec<Point<2>>> {
        self.0.outlines()
    }
}
