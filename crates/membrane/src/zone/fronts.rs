//! The fronts of a zone, and the functions by which they move.

use crate::method::{ModeSpace, Modes};
use crate::mode_matrix::Clique;
use signorini_geometry::{Point, Vector};

/// A point of a front: curvature and the modes that do not vanish there.
#[derive(Clone, Debug)]
pub struct FrontFrame {
    /// Divergence of the normal that points out of the zone.
    pub curvature: f64,
    /// Pairs of mode and value, the modes of all fronts numbered through.
    pub modes: Vec<(usize, f64)>,
}

impl FrontFrame {
    /// The value of one mode.
    pub fn value(&self, mode: usize) -> f64 {
        self.modes.iter().filter(|(i, _)| *i == mode).map(|(_, v)| v).sum()
    }
}

/// The point of a front nearest to another point: where it is, and the modes there.
#[derive(Clone, Debug)]
pub struct FrontFoot<const D: usize> {
    pub position: Point<D>,
    /// Where along the front, from 0 to 1.
    pub parameter: f64,
    /// Unit normal, out of the zone.
    pub normal: Vector<D>,
    /// Its divergence.
    pub curvature: f64,
    /// Modes that do not vanish there: number, value, and gradient along the front.
    pub modes: Vec<(usize, f64, Vector<D>)>,
}

/// The fronts of a zone, numbered through, oriented with the zone on their left: their normal points out of the zone into the
/// free membrane.
pub trait ZoneFronts<const D: usize> {
    /// The point of a front nearest to a point.
    fn foot(&self, front: usize, x: &Point<D>, modes: ModeSpace) -> FrontFoot<D>;
    fn frame(&self, front: usize, x: &Point<D>, modes: ModeSpace) -> FrontFrame {
        let foot = self.foot(front, x, modes);
        FrontFrame { curvature: foot.curvature, modes: foot.modes.iter().map(|(i, v, _)| (*i, *v)).collect() }
    }
    fn front_count(&self) -> usize;
    /// The number of modes of the poorest front, where that is less than what is asked for: its cells tell no more apart.
    fn fewer_modes(&self, asked: Modes) -> Option<usize> {
        let Modes::Fourier { most } = asked else { return None };
        let fewest = self.mode_offsets(asked.finest()).windows(2).map(|o| o[1] - o[0]).min()?;
        // A cosine comes with its sine.
        (D > 1 && most < usize::MAX && fewest + 1 < most).then_some(fewest)
    }
    /// First mode of each front, and the number of all modes at the end.
    fn mode_offsets(&self, modes: ModeSpace) -> Vec<usize>;
    /// The matrix `weight ∫ w_s v_s` over a front.
    fn stiffness(&self, modes: ModeSpace, front: usize, weight: f64) -> Vec<Clique>;
    /// The largest curvature of any front, to judge whether the grid resolves it.
    fn sharpest(&self) -> f64;
    /// The smallest length in the fronts: a radius of curvature, or the distance between two that are near each other.
    fn least_feature(&self) -> f64;
    /// The largest product of the curvature of a front and the size of the cells there.
    fn bend(&self) -> f64;
    /// Whether no front is so short, counted in cells, that a coarse look would miss it.
    fn fronts_are_long(&self) -> bool {
        true
    }
    /// Whether fronts curve by so much or more within a cell, and only such as are many cells long: tips, not holes or zones of a
    /// few cells.
    fn has_tips(&self, _bend: f64) -> bool {
        false
    }
    /// Whether there are tips sharper than a cell.
    fn has_lost_tips(&self) -> bool {
        self.has_tips(1.0)
    }
}
