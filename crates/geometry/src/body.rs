//! Bodies made of many shapes: the closest pair between two of them, and the pairs that may come to touch.

use crate::bvh::Bvh;
use crate::closest::{Projection, Query, closest};
use crate::scale::length;
use crate::shape::Shape;
use crate::{Aabb, Point};

/// Shapes under one search tree; they are known by their position in the list.
#[derive(Clone, Debug)]
pub struct Body {
    shapes: Vec<Shape>,
    boxes: Vec<Aabb<3>>,
    bvh: Bvh,
}

/// The closest pair of points of two bodies: which shapes, and their projection.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyPair {
    pub shapes: [usize; 2],
    pub projection: Projection,
}

impl Body {
    pub fn new(shapes: Vec<Shape>) -> Self {
        let boxes: Vec<Aabb<3>> = shapes.iter().map(Shape::bounds).collect();
        let bvh = Bvh::new(&boxes);
        Body { shapes, boxes, bvh }
    }

    pub fn shapes(&self) -> &[Shape] {
        &self.shapes
    }

    /// Replaces the shapes by as many others, near where they were, and refits the tree.
    ///
    /// # Panics
    /// If the number of shapes differs.
    pub fn move_to(&mut self, shapes: Vec<Shape>) {
        self.boxes = shapes.iter().map(Shape::bounds).collect();
        self.bvh.refit(&self.boxes);
        self.shapes = shapes;
    }

    /// The closest shape to a point; `None` for an empty body.
    pub fn closest_to_point(&self, p: &Point<3>, query: &Query) -> Option<BodyPair> {
        let point = Shape::Point(*p);
        let mut best: Option<BodyPair> = None;
        self.bvh.nearest(p, f64::INFINITY, |k| offer(&mut best, [0, k], || closest(&point, &self.shapes[k], query)));
        best
    }

    /// The closest pair of points of two bodies; `None` if one is empty. Of pairs at the same distance the one with the
    /// lowest numbers is returned.
    pub fn closest(&self, other: &Body, query: &Query) -> Option<BodyPair> {
        let mut best: Option<BodyPair> = None;
        self.bvh.nearest_pairs(&other.bvh, f64::INFINITY, |i, j| {
            let limit = best.as_ref().map_or(f64::INFINITY, |b| b.projection.distance());
            let apart = (self.boxes[i].min - other.boxes[j].max).sup(&(other.boxes[j].min - self.boxes[i].max));
            if length(&apart.map(|x| x.max(0.0))) > limit {
                return limit * limit;
            }
            offer(&mut best, [i, j], || closest(&self.shapes[i], &other.shapes[j], query))
        });
        best
    }

    /// All pairs of shapes whose boxes are no farther apart than `reach`, in ascending order: with `reach` the sum of
    /// how far both bodies may move, no other pair can touch meanwhile.
    pub fn pairs_within(&self, other: &Body, reach: f64) -> Vec<(usize, usize)> {
        self.bvh.pairs_within(&other.bvh, (&self.boxes, &other.boxes), reach)
    }
}

fn offer(best: &mut Option<BodyPair>, shapes: [usize; 2], compute: impl FnOnce() -> Projection) -> f64 {
    let projection = compute();
    let better = best.as_ref().is_none_or(|b| {
        projection.distance() < b.projection.distance()
            || (projection.distance() == b.projection.distance() && shapes < b.shapes)
    });
    if better {
        *best = Some(BodyPair { shapes, projection });
    }
    best.as_ref().map_or(f64::INFINITY, |b| b.projection.distance().powi(2))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::shape::{Axes, Curve, Surface};

    #[test]
    fn the_closest_pair_of_bodies_is_the_closest_of_all_pairs() {
        let at = |k: usize, x: f64| {
            Point::<3>::new(x + (1.7 * k as f64).sin(), (2.3 * k as f64).cos(), (0.9 * k as f64).sin())
        };
        let body = |x: f64| {
            let shapes: Vec<Shape> = (0..12)
                .map(|k| match k % 3 {
                    0 => Surface::sphere(
                        Axes::standard(at(k, x)),
                        0.1,
                        [[0.0, std::f64::consts::TAU], [-1.5, 1.5]],
                        true,
                    )
                    .unwrap()
                    .into(),
                    1 => Curve::segment(at(k, x), at(k + 5, x)).unwrap().into(),
                    _ => Shape::Point(at(k, x)),
                })
                .collect();
            Body::new(shapes)
        };
        let (a, b) = (body(0.0), body(2.5));
        let query = Query::default();
        let found = a.closest(&b, &query).unwrap();
        let mut brute = f64::INFINITY;
        for p in a.shapes() {
            for q in b.shapes() {
                brute = brute.min(closest(p, q, &query).distance());
            }
        }
        assert_eq!(found.projection.distance(), brute);
        assert!(a.pairs_within(&b, brute).contains(&(found.shapes[0], found.shapes[1])));
        let mut moved = a.clone();
        moved.move_to(b.shapes().to_vec());
        assert_eq!(moved.closest(&b, &query).unwrap().projection.distance(), 0.0);
    }
}
