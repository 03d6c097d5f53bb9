//! Bodies built from implicit shapes: unions, intersections, differences.
//!
//! A combination is never one function `max(φ_1, φ_2)` with kinks. Its shapes stay apart as the sheets of a partition
//! whose region is a Boolean of their signs, so that edges are integrated as well as faces, and found exactly.

use super::{HalfSpace, ImplicitShape};
use crate::{Aabb, Point, Vector};
use std::sync::Arc;

/// What is inside: a shape, or a combination of bodies.
#[derive(Clone)]
pub enum ImplicitBody<const D: usize> {
    /// Where a shape is negative.
    Shape(Arc<dyn ImplicitShape<D>>),
    Union(Vec<ImplicitBody<D>>),
    Intersection(Vec<ImplicitBody<D>>),
    /// Where another one is not.
    Complement(Box<ImplicitBody<D>>),
}

/// What bounds of the shapes say about a box.
#[derive(Clone)]
pub enum Restricted<const D: usize> {
    Full,
    Void,
    /// Undecided: the body with only the shapes that matter in the box.
    Open(ImplicitBody<D>),
}

impl<const D: usize> ImplicitBody<D> {
    pub fn shape(shape: impl ImplicitShape<D> + 'static) -> Self {
        ImplicitBody::Shape(Arc::new(shape))
    }

    /// What is in any of them.
    pub fn union(parts: Vec<ImplicitBody<D>>) -> Self {
        ImplicitBody::Union(parts)
    }

    /// What is in all of them.
    pub fn intersection(parts: Vec<ImplicitBody<D>>) -> Self {
        ImplicitBody::Intersection(parts)
    }

    /// What is in this one and not in the other.
    pub fn without(self, other: ImplicitBody<D>) -> Self {
        ImplicitBody::Intersection(vec![self, ImplicitBody::Complement(Box::new(other))])
    }

    /// The same combination of other shapes, of another dimension possibly.
    pub fn map<const N: usize>(
        &self,
        f: &dyn Fn(&Arc<dyn ImplicitShape<D>>) -> Arc<dyn ImplicitShape<N>>,
    ) -> ImplicitBody<N> {
        let all = |parts: &[Self]| parts.iter().map(|p| p.map(f)).collect();
        match self {
            ImplicitBody::Shape(shape) => ImplicitBody::Shape(f(shape)),
            ImplicitBody::Union(parts) => ImplicitBody::Union(all(parts)),
            ImplicitBody::Intersection(parts) => ImplicitBody::Intersection(all(parts)),
            ImplicitBody::Complement(part) => ImplicitBody::Complement(Box::new(part.map(f))),
        }
    }

    /// Negative inside: the least of a union, the greatest of an intersection.
    pub fn value(&self, x: &Point<D>) -> f64 {
        match self {
            ImplicitBody::Shape(shape) => shape.value(x),
            ImplicitBody::Union(parts) => parts.iter().map(|p| p.value(x)).fold(f64::INFINITY, nan_min),
            ImplicitBody::Intersection(parts) => parts.iter().map(|p| p.value(x)).fold(f64::NEG_INFINITY, nan_max),
            ImplicitBody::Complement(part) => -part.value(x),
        }
    }

    /// Whether a point is inside.
    pub fn contains(&self, x: &Point<D>) -> bool {
        self.value(x) < 0.0
    }

    /// The body as it is in a box.
    pub fn restricted(&self, b: &Aabb<D>) -> Restricted<D> {
        match self {
            ImplicitBody::Shape(shape) => match shape.range(b) {
                Some([low, _]) if low > 0.0 => Restricted::Void,
                Some([_, high]) if high < 0.0 => Restricted::Full,
                _ => Restricted::Open(self.clone()),
            },
            ImplicitBody::Complement(part) => match part.restricted(b) {
                Restricted::Full => Restricted::Void,
                Restricted::Void => Restricted::Full,
                Restricted::Open(part) => Restricted::Open(ImplicitBody::Complement(Box::new(part))),
            },
            ImplicitBody::Union(parts) => {
                let mut open = Vec::new();
                for part in parts {
                    match part.restricted(b) {
                        Restricted::Full => return Restricted::Full,
                        Restricted::Void => {}
                        Restricted::Open(part) => open.push(part),
                    }
                }
                if open.is_empty() { Restricted::Void } else { Restricted::Open(ImplicitBody::Union(open)) }
            }
            ImplicitBody::Intersection(parts) => {
                let mut open = Vec::new();
                for part in parts {
                    match part.restricted(b) {
                        Restricted::Void => return Restricted::Void,
                        Restricted::Full => {}
                        Restricted::Open(part) => open.push(part),
                    }
                }
                if open.is_empty() { Restricted::Full } else { Restricted::Open(ImplicitBody::Intersection(open)) }
            }
        }
    }
}

impl<const D: usize, S: ImplicitShape<D> + 'static> From<S> for ImplicitBody<D> {
    fn from(shape: S) -> Self {
        ImplicitBody::shape(shape)
    }
}

fn nan_min(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.min(b) }
}

fn nan_max(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// A box with its sides along the coordinate axes.
pub fn cuboid<const D: usize>(b: &Aabb<D>) -> ImplicitBody<D> {
    let side = |k: usize, point: Point<D>, sign: f64| {
        ImplicitBody::shape(HalfSpace { point, normal: Vector::from_fn(|a, _| if a == k { sign } else { 0.0 }) })
    };
    ImplicitBody::Intersection((0..D).flat_map(|k| [side(k, b.min, -1.0), side(k, b.max, 1.0)]).collect())
}
