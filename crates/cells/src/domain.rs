//! Bodies built from implicit shapes: unions, intersections, differences.
//!
//! A combination is never one function `max(φ_1, φ_2)` with kinks. Its shapes stay apart as the sheets of a partition
//! whose region is a Boolean of their signs, so that edges are integrated as well as faces.

use signorini_fem::cut::CellPartition;
use signorini_geometry::{Aabb, ImplicitShape, Matrix, Point, Vector};
use std::sync::Arc;

/// Where there is material.
#[derive(Clone)]
pub enum Domain<const D: usize> {
    /// Where a shape is negative.
    Shape(Arc<dyn ImplicitShape<D>>),
    Union(Vec<Domain<D>>),
    Intersection(Vec<Domain<D>>),
    /// Where another one is not.
    Complement(Box<Domain<D>>),
}

/// What bounds of the shapes say about a box.
#[derive(Clone)]
pub enum Restricted<const D: usize> {
    Full,
    Void,
    /// Undecided: the domain with only the shapes that matter in the box.
    Open(Domain<D>),
}

impl<const D: usize> Domain<D> {
    pub fn shape(shape: impl ImplicitShape<D> + 'static) -> Self {
        Domain::Shape(Arc::new(shape))
    }

    /// What is in any of them.
    pub fn union(parts: Vec<Domain<D>>) -> Self {
        Domain::Union(parts)
    }

    /// What is in all of them.
    pub fn intersection(parts: Vec<Domain<D>>) -> Self {
        Domain::Intersection(parts)
    }

    /// What is in this one and not in the other.
    pub fn without(self, other: Domain<D>) -> Self {
        Domain::Intersection(vec![self, Domain::Complement(Box::new(other))])
    }

    /// Negative inside: the least of a union, the greatest of an intersection.
    pub fn value(&self, x: &Point<D>) -> f64 {
        match self {
            Domain::Shape(shape) => shape.value(x),
            Domain::Union(parts) => parts.iter().map(|p| p.value(x)).fold(f64::INFINITY, nan_min),
            Domain::Intersection(parts) => parts.iter().map(|p| p.value(x)).fold(f64::NEG_INFINITY, nan_max),
            Domain::Complement(part) => -part.value(x),
        }
    }

    /// Whether a point is in the material.
    pub fn contains(&self, x: &Point<D>) -> bool {
        self.value(x) < 0.0
    }

    /// The domain as it is in a box.
    pub fn restricted(&self, b: &Aabb<D>) -> Restricted<D> {
        match self {
            Domain::Shape(shape) => match shape.range(b) {
                Some([low, _]) if low > 0.0 => Restricted::Void,
                Some([_, high]) if high < 0.0 => Restricted::Full,
                _ => Restricted::Open(self.clone()),
            },
            Domain::Complement(part) => match part.restricted(b) {
                Restricted::Full => Restricted::Void,
                Restricted::Void => Restricted::Full,
                Restricted::Open(part) => Restricted::Open(Domain::Complement(Box::new(part))),
            },
            Domain::Union(parts) => {
                let mut open = Vec::new();
                for part in parts {
                    match part.restricted(b) {
                        Restricted::Full => return Restricted::Full,
                        Restricted::Void => {}
                        Restricted::Open(part) => open.push(part),
                    }
                }
                if open.is_empty() { Restricted::Void } else { Restricted::Open(Domain::Union(open)) }
            }
            Domain::Intersection(parts) => {
                let mut open = Vec::new();
                for part in parts {
                    match part.restricted(b) {
                        Restricted::Void => return Restricted::Void,
                        Restricted::Full => {}
                        Restricted::Open(part) => open.push(part),
                    }
                }
                if open.is_empty() { Restricted::Full } else { Restricted::Open(Domain::Intersection(open)) }
            }
        }
    }

    /// The partition of space into material (region 1) and the rest (region 0).
    pub fn partition(&self) -> CellPartition<'_, D> {
        let mut sheets: Vec<Box<dyn ImplicitShape<D> + '_>> = Vec::new();
        let signs = self.signs(true, &mut sheets);
        let tags = vec![0; sheets.len()];
        CellPartition {
            sheets,
            tags,
            features: Vec::new(),
            region: Box::new(move |_, values| u32::from(signs.holds(values))),
        }
    }

    /// The Boolean of signs, with complements at the shapes only: every sheet is negative on its material side, so that
    /// a surface on a side between two cells belongs to the cell with the material.
    fn signs<'a>(&'a self, positive: bool, sheets: &mut Vec<Box<dyn ImplicitShape<D> + 'a>>) -> Signs {
        match self {
            Domain::Shape(shape) => {
                sheets.push(if positive { Box::new(&**shape) } else { Box::new(Negated(&**shape)) });
                Signs::Negative(sheets.len() - 1)
            }
            Domain::Complement(part) => part.signs(!positive, sheets),
            Domain::Union(parts) | Domain::Intersection(parts) => {
                let any = matches!(self, Domain::Union(_)) == positive;
                let parts = parts.iter().map(|p| p.signs(positive, sheets)).collect();
                if any { Signs::Any(parts) } else { Signs::All(parts) }
            }
        }
    }
}

impl<const D: usize, S: ImplicitShape<D> + 'static> From<S> for Domain<D> {
    fn from(shape: S) -> Self {
        Domain::shape(shape)
    }
}

fn nan_min(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.min(b) }
}

fn nan_max(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// A Boolean of the signs of sheets.
enum Signs {
    Negative(usize),
    Any(Vec<Signs>),
    All(Vec<Signs>),
}

impl Signs {
    fn holds(&self, values: &[f64]) -> bool {
        match self {
            Signs::Negative(sheet) => values[*sheet] < 0.0,
            Signs::Any(parts) => parts.iter().any(|p| p.holds(values)),
            Signs::All(parts) => parts.iter().all(|p| p.holds(values)),
        }
    }
}

/// What is outside a shape.
pub(crate) struct Negated<S>(pub S);

impl<const D: usize, S: ImplicitShape<D>> ImplicitShape<D> for Negated<S> {
    fn value(&self, x: &Point<D>) -> f64 {
        -self.0.value(x)
    }
    fn gradient(&self, x: &Point<D>) -> Vector<D> {
        -self.0.gradient(x)
    }
    fn range(&self, b: &Aabb<D>) -> Option<[f64; 2]> {
        self.0.range(b).map(|[low, high]| [-high, -low])
    }
    fn value_and_gradient(&self, x: &Point<D>) -> (f64, Vector<D>) {
        let (value, gradient) = self.0.value_and_gradient(x);
        (-value, -gradient)
    }
    fn hessian(&self, x: &Point<D>) -> Matrix<D> {
        -self.0.hessian(x)
    }
}
