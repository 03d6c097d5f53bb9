//! Axis-aligned boxes.

use crate::Point;

/// An axis-aligned box: an interval, a rectangle or a cuboid.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb<const D: usize> {
    pub min: Point<D>,
    pub max: Point<D>,
}

impl<const D: usize> Aabb<D> {
    /// The box between two corners.
    pub fn new(min: Point<D>, max: Point<D>) -> Self {
        Self { min, max }
    }

    /// The smallest box around points; none without points.
    pub fn around(points: impl IntoIterator<Item = Point<D>>) -> Option<Self> {
        points.into_iter().map(|x| Self::new(x, x)).reduce(|a, b| a.joined(&b))
    }

    /// The smallest box around two.
    pub fn joined(&self, other: &Self) -> Self {
        Self::new(self.min.inf(&other.min), self.max.sup(&other.max))
    }

    /// Whether two boxes have no point in common.
    pub fn is_apart(&self, other: &Self) -> bool {
        (0..D).any(|k| self.min[k] > other.max[k] || other.min[k] > self.max[k])
    }

    pub fn center(&self) -> Point<D> {
        0.5 * (self.min + self.max)
    }

    pub fn size(&self) -> Point<D> {
        self.max - self.min
    }

    /// Half the length of the diagonal.
    pub fn radius(&self) -> f64 {
        0.5 * self.size().norm()
    }

    pub fn volume(&self) -> f64 {
        self.size().iter().product()
    }

    /// The point at relative coordinates `xi` in `[0, 1]^D`.
    pub fn at(&self, xi: &Point<D>) -> Point<D> {
        self.min + self.size().component_mul(xi)
    }

    pub fn contains(&self, x: &Point<D>) -> bool {
        (0..D).all(|k| x[k] >= self.min[k] && x[k] <= self.max[k])
    }

    /// The point of the box nearest to `x`.
    pub fn clamp(&self, x: &Point<D>) -> Point<D> {
        Point::from_fn(|k, _| x[k].clamp(self.min[k], self.max[k]))
    }

    /// The box with every half-width multiplied by `factor`.
    pub fn scaled(&self, factor: f64) -> Self {
        let half = 0.5 * factor * self.size();
        Self::new(self.center() - half, self.center() + half)
    }

    /// Splits the box at a point into its `2^D` parts; parts without extent are left out.
    pub fn split_at(&self, x: &Point<D>) -> Vec<Self> {
        (0..1usize << D)
            .map(|part| {
                let upper = |k: usize| part >> k & 1 == 1;
                Self::new(
                    Point::from_fn(|k, _| if upper(k) { x[k] } else { self.min[k] }),
                    Point::from_fn(|k, _| if upper(k) { self.max[k] } else { x[k] }),
                )
            })
            .filter(|part| part.size().iter().all(|&s| s > 0.0))
            .collect()
    }
}
