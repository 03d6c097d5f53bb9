//! What a closest-point query answers.

use crate::feature::Feature;
use crate::{Point, Vector};

/// A closest point on one partner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foot {
    pub point: Point<3>,
    pub feature: Feature,
    /// The triangle of a mesh; of other shapes the smooth piece, counted along the parameters, where the search used one.
    pub element: usize,
    dimension: usize,
    parameters: [f64; 2],
    /// Local parameters on the smooth piece.
    local: [f64; 2],
}

impl Foot {
    pub(crate) fn new(point: Point<3>, feature: Feature, parameters: &[f64]) -> Self {
        let mut filled = [0.0; 2];
        filled[..parameters.len()].copy_from_slice(parameters);
        Foot { point, feature, element: 0, dimension: parameters.len(), parameters: filled, local: [0.0; 2] }
    }

    pub(crate) fn on_piece(mut self, piece: usize, local: &[f64]) -> Self {
        self.element = piece;
        self.local[..local.len()].copy_from_slice(local);
        self
    }

    pub(crate) fn place(&mut self, (piece, local): (usize, [f64; 2])) {
        self.element = piece;
        self.local = local;
    }

    pub(crate) fn local(&self, k: usize) -> f64 {
        self.local[k]
    }

    pub(crate) fn on_element(self, element: usize) -> Self {
        Foot { element, ..self }
    }

    pub(crate) fn of_point(point: Point<3>) -> Self {
        Self::new(point, Feature::POINT, &[])
    }

    /// The foot in coordinates this many times as large, as are the parameters that are lengths.
    pub(crate) fn scaled(mut self, factor: f64, lengths: [bool; 2]) -> Self {
        self.point *= factor;
        for (parameter, _) in self.parameters.iter_mut().zip(lengths).filter(|(_, is_length)| *is_length) {
            *parameter *= factor;
        }
        self
    }

    /// As many numbers as the shape has parameters.
    pub fn parameters(&self) -> &[f64] {
        &self.parameters[..self.dimension]
    }
}

/// A minimiser of the distance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClosestPair {
    pub distance: f64,
    pub a: Foot,
    pub b: Foot,
    /// Smallest eigenvalue of the Hessian of `½ D·D` in the metric of the shapes, over the parameters that are free:
    /// positive at a strict minimum, zero on a focal set. For a point and a surface it is `1 - d κ`. Infinite where no
    /// parameter is free, not a number where the parametrisation degenerates.
    pub lambda_min: f64,
}

impl ClosestPair {
    /// Unit vector from the closest point of `b` to that of `a`; `None` where they coincide.
    pub fn direction(&self) -> Option<Vector<3>> {
        crate::scale::direction(&(self.a.point - self.b.point))
    }

    pub(crate) fn swapped(self) -> Self {
        ClosestPair { a: self.b, b: self.a, ..self }
    }
}

/// Whether the closest pair of points is the only one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Uniqueness {
    Unique,
    /// Several separate minimisers at the same distance; all are listed.
    Multiple,
    /// A curve (1) or surface (2) of minimisers; the listed ones are samples of it.
    Continuum {
        dimension: usize,
    },
    /// One minimiser in double precision, in a valley this flat.
    NearContinuum {
        lambda: f64,
    },
}

impl Uniqueness {
    /// Whether one pair of points is closer than every other.
    pub fn is_unique(self) -> bool {
        matches!(self, Uniqueness::Unique | Uniqueness::NearContinuum { .. })
    }
}

/// Whether it is proved that nothing is closer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Certificate {
    /// The search came to its end, or there is a closed form.
    Complete,
    /// The search reached the most pairs of cells that it examines: something closer, by `certified_to` at most, is not
    /// excluded.
    Stopped,
}

/// The answer to a closest-point query.
#[derive(Clone, Debug, PartialEq)]
pub struct Projection {
    /// A global minimiser.
    pub closest: ClosestPair,
    pub uniqueness: Uniqueness,
    /// Further minimisers: those at the same distance, and every other local one where the query asked for them.
    pub others: Vec<ClosestPair>,
    /// No pair of points is closer than the distance less this; rounding, except where the minimum is degenerate.
    pub certified_to: f64,
    /// Away from the minimisers every pair of points is farther by at least this.
    pub margin: f64,
    /// Pairs of cells that were examined; zero for a closed form.
    pub effort: usize,
    pub certificate: Certificate,
}

impl Projection {
    /// The answer of a closed form, which needs no search.
    pub(crate) fn known(closest: ClosestPair, uniqueness: Uniqueness, others: Vec<ClosestPair>) -> Self {
        let certificate = Certificate::Complete;
        Projection { closest, uniqueness, others, certified_to: 0.0, margin: 0.0, effort: 0, certificate }
    }

    pub fn distance(&self) -> f64 {
        self.closest.distance
    }
}
