//! The rigid bodies that a membrane may touch: floors below it and ceilings above.

use crate::field::SharedField;
use signorini_geometry::{Jet, Point, Real};

/// Where a rigid body lies, seen from the membrane.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum Side {
    Below,
    Above,
}

impl Side {
    pub const BOTH: [Self; 2] = [Self::Below, Self::Above];

    /// The direction in which a body on this side pushes, along z.
    pub fn sign(self) -> f64 {
        match self {
            Self::Below => 1.0,
            Self::Above => -1.0,
        }
    }
}

/// A rigid body beside a membrane.
#[derive(Clone)]
pub struct Obstacle<const D: usize> {
    pub side: Side,
    /// Height of its surface.
    pub height: SharedField<D>,
    /// Energy that each area of contact gives back, where the body is sticky.
    pub adhesion: Option<SharedField<D>>,
}

/// All bodies beside a membrane. On each side the one that reaches farthest towards it counts.
#[derive(Clone, Default)]
pub struct Obstacles<const D: usize>(pub Vec<Obstacle<D>>);

impl<const D: usize> Obstacles<D> {
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Whether any of them is sticky.
    pub fn are_sticky(&self) -> bool {
        self.0.iter().any(|o| o.adhesion.is_some())
    }

    /// The sides on which there are bodies.
    pub fn sides(&self) -> impl Iterator<Item = Side> + '_ {
        Side::BOTH.into_iter().filter(|side| self.0.iter().any(|o| o.side == *side))
    }

    /// The number of the body that a membrane would touch at a point, from one side.
    pub fn index_at(&self, side: Side, x: &Point<D>) -> Option<usize> {
        let mut of_side = self.0.iter().enumerate().filter(|(_, o)| o.side == side);
        let first = of_side.next()?;
        // Nearly always there is one.
        let mut best: Option<(usize, f64)> = None;
        for (i, o) in of_side {
            let (_, least) = *best.get_or_insert_with(|| (first.0, side.sign() * first.1.height.value(x)));
            let reach = side.sign() * o.height.value(x);
            if reach > least {
                best = Some((i, reach));
            }
        }
        Some(best.map_or(first.0, |b| b.0))
    }

    /// The body that a membrane would touch at a point, from one side.
    pub fn at(&self, side: Side, x: &Point<D>) -> Option<&Obstacle<D>> {
        self.index_at(side, x).map(|i| &self.0[i])
    }

    /// The height of what there is on a side: infinitely far where there is nothing.
    pub fn height(&self, side: Side, x: &Point<D>) -> f64 {
        self.at(side, x).map_or(-side.sign() * f64::INFINITY, |o| o.height.value(x))
    }

    /// The height of a side with its derivatives.
    pub fn jet(&self, side: Side, x: &Point<D>) -> Jet<D> {
        self.at(side, x).map_or_else(|| Jet::constant(-side.sign() * f64::INFINITY), |o| o.height.jet(x))
    }

    /// The gap between a side and a membrane of displacement `u`, negative where it penetrates.
    pub fn gap(&self, side: Side, x: &Point<D>, u: f64) -> f64 {
        side.sign() * (u - self.height(side, x))
    }

    /// The least of the gaps at a point, and its side.
    pub fn least_gap(&self, x: &Point<D>, u: f64) -> (f64, Side) {
        self.sides()
            .map(|side| (self.gap(side, x, u), side))
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap_or((f64::INFINITY, Side::Below))
    }
}
