//! How large cells and modes are to be, as a smooth function of the place: small where the fronts need it, and growing
//! gradually from there.

use signorini_fem::Grid;
use signorini_geometry::Point;

/// Cells grow by this much on the way of one length.
const GROWTH: f64 = 0.25;
/// Cells may be larger than wanted by this power of two.
const SLACK: f64 = 0.25;

/// A place along the fronts and the size that is wanted there.
#[derive(Clone, Copy, Debug)]
struct Wanted<const D: usize> {
    place: Point<D>,
    size: f64,
    /// Its part in the mean.
    share: f64,
}

/// A size for every place: `s(x)⁻⁴ = (2g/π) ∫ (s(y)² + g² |x - y|²)⁻² dy / s(y)` over the fronts, which is the size wanted
/// along a straight front that wants the same everywhere, and grows like `g |x - y|` away from a place `y` that wants less.
/// It is as smooth as modes must be that vary in length with it.
#[derive(Clone, Debug)]
pub struct Sizing<const D: usize>(Vec<Wanted<D>>);

impl<const D: usize> Sizing<D> {
    /// From places along the fronts, the length of front that each stands for, and the size that is wanted there.
    pub fn new(wanted: impl Iterator<Item = (Point<D>, f64, f64)>) -> Self {
        let share = |length: f64, size: f64| 2.0 * GROWTH / std::f64::consts::PI * length / size;
        Self(wanted.map(|(place, length, size)| Wanted { place, size, share: share(length, size) }).collect())
    }

    /// The size that is wanted at a place.
    pub fn at(&self, x: &Point<D>) -> f64 {
        let of = |w: &Wanted<D>| {
            let square = w.size * w.size + GROWTH * GROWTH * (x - w.place).norm_squared();
            w.share / (square * square)
        };
        self.0.iter().map(of).sum::<f64>().sqrt().sqrt().recip()
    }

    /// The mean size along the fronts.
    pub fn mean(&self) -> f64 {
        let [size, length] =
            self.0.iter().fold([0.0; 2], |[s, l], w| [s + w.share * w.size * w.size, l + w.share * w.size]);
        size / length.max(f64::MIN_POSITIVE)
    }

    /// The size of the largest cells that need not be divided at a place.
    pub fn largest(&self, x: &Point<D>) -> f64 {
        self.at(x) * SLACK.exp2()
    }

    /// How often cells of the given size are to be divided at a place.
    pub fn divisions(&self, x: &Point<D>, size: f64) -> usize {
        (size / self.largest(x)).log2().ceil().max(0.0) as usize
    }
}

/// A grid with cells twice as large as long as there are more than so many along a side.
pub fn coarsened<const D: usize>(grid: &Grid<D>, most: usize) -> Grid<D> {
    let mut cells = grid.cells();
    while cells.iter().any(|n| *n > most) && cells.iter().all(|n| n.is_multiple_of(2)) {
        cells = cells.map(|n| n / 2);
    }
    Grid::new(*grid.bounds(), cells, grid.degree())
}
