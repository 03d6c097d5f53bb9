//! What the method needs to know of a contact zone, in one dimension or two.

use crate::ils::Solution;
use crate::mode_matrix::Clique;
use crate::obstacle::Side;
use crate::problem::Membrane;
use crate::published::Transport;
use crate::sizing::Sizing;
use serde_json::Value;
use signorini_fem::cut::RegionId;
use signorini_fem::{Cells, Grid};
use signorini_geometry::{Aabb, ImplicitShape, Point, Vector};
use signorini_solve::{Progress, SolveError};
use std::sync::Arc;

/// Beyond the membrane.
pub const OUTSIDE: RegionId = 0;
const BELOW: RegionId = 1 << 24;
const FREE: RegionId = 2 << 24;
const ABOVE: RegionId = 3 << 24;
const INDEX: RegionId = (1 << 24) - 1;

/// The region of the `k`-th connected zone of contact, which touches a body on one side.
pub fn contact(side: Side, k: usize) -> RegionId {
    k as u32
        | match side {
            Side::Below => BELOW,
            Side::Above => ABOVE,
        }
}

/// The region of the `k`-th connected part of the free membrane.
pub fn free(k: usize) -> RegionId {
    FREE | k as u32
}

/// The side that is touched and the number of the zone, if a region is one of contact.
pub fn contact_of(region: RegionId) -> Option<(Side, usize)> {
    let side = match region & !INDEX {
        BELOW => Side::Below,
        ABOVE => Side::Above,
        _ => return None,
    };
    Some((side, (region & INDEX) as usize))
}

/// The number of the zone, if a region is one of contact.
pub fn contact_index(region: RegionId) -> Option<usize> {
    contact_of(region).map(|c| c.1)
}

/// Whether a region is free membrane.
pub fn is_free(region: RegionId) -> bool {
    region & !INDEX == FREE
}

/// The fronts that may cross a box.
pub struct FrontsInCell<'a, const D: usize> {
    pub sheets: Vec<Box<dyn ImplicitShape<D> + 'a>>,
    /// Front of each sheet.
    pub fronts: Vec<usize>,
    pub features: Vec<Point<D>>,
    /// The region of a point inside the membrane, given the values of the sheets.
    pub region: Box<dyn Fn(&[f64]) -> RegionId + 'a>,
}

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

/// How finely fronts may move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModeSpace {
    /// At most so many modes for each front: for the first, long steps.
    Coarse(usize),
    /// As many as the grid can tell apart.
    Fine,
    /// At most so many trigonometric functions of the arc length for each front, and no more than the grid can tell apart.
    Fourier(usize),
}

/// The functions along a front by which it moves.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Modes {
    /// Periodic splines, each of which moves a short piece: for fronts of any shape.
    #[default]
    Local,
    /// Trigonometric functions of the arc length: few suffice where fronts are nearly circles.
    Fourier {
        /// How many each front has at most.
        most: usize,
    },
}

impl Modes {
    /// As many as the grid can tell apart.
    pub fn finest(self) -> ModeSpace {
        match self {
            Modes::Local => ModeSpace::Fine,
            Modes::Fourier { most } => ModeSpace::Fourier(most),
        }
    }

    /// The number of modes of the poorest front of a zone, where that is less than what is asked for: its cells tell no more
    /// apart.
    pub fn reduced<const D: usize, Z: Zone<D>>(self, zone: &Z) -> Option<usize> {
        let Modes::Fourier { most } = self else { return None };
        let fewest = zone.mode_offsets(self.finest()).windows(2).map(|o| o[1] - o[0]).min()?;
        // A cosine comes with its sine.
        (D > 1 && most < usize::MAX && fewest + 1 < most).then_some(fewest)
    }

    /// At most so many for each front.
    pub fn at_most(self, count: usize) -> ModeSpace {
        match self {
            Modes::Local => ModeSpace::Coarse(count),
            Modes::Fourier { most } => ModeSpace::Fourier(count.min(most)),
        }
    }
}

/// What became of a zone whose fronts were moved.
pub struct Advance<Z> {
    pub zone: Z,
    /// Whether zones or holes appeared, merged, split or vanished.
    pub topology_changed: bool,
}

/// What divides a membrane into contact and free regions.
pub trait Division<const D: usize>: Sync {
    /// The fronts that may cross a box.
    fn fronts_in(&self, bounds: &Aabb<D>) -> FrontsInCell<'_, D>;
}

/// A membrane without contact.
pub struct NoZone;

impl<const D: usize> Division<D> for NoZone {
    fn fronts_in(&self, _: &Aabb<D>) -> FrontsInCell<'_, D> {
        FrontsInCell { sheets: vec![], fronts: vec![], features: vec![], region: Box::new(|_| free(0)) }
    }
}

/// A contact zone: its connected parts, bounded by fronts.
///
/// Fronts are oriented with the zone on their left, so their normal points out of the zone into the free membrane.
pub trait Zone<const D: usize>: Division<D> + Clone + Send {
    /// No contact at all.
    fn empty(grid: &Grid<D>) -> Self;
    fn is_empty(&self) -> bool;
    /// Number of connected zones and of holes in them.
    fn counts(&self) -> (usize, usize);
    /// What a zone touches.
    fn side_of(&self, zone: usize) -> Side;
    /// Holes of one zone.
    fn holes_of(&self, zone: usize) -> usize;

    /// The point of a front nearest to a point.
    fn foot(&self, front: usize, x: &Point<D>, modes: ModeSpace) -> FrontFoot<D>;
    fn frame(&self, front: usize, x: &Point<D>, modes: ModeSpace) -> FrontFrame {
        let foot = self.foot(front, x, modes);
        FrontFrame { curvature: foot.curvature, modes: foot.modes.iter().map(|(i, v, _)| (*i, *v)).collect() }
    }
    fn front_count(&self) -> usize;
    /// First mode of each front, and the number of all modes at the end.
    fn mode_offsets(&self, modes: ModeSpace) -> Vec<usize>;
    /// The matrix `weight ∫ w_s v_s` over a front.
    fn stiffness(&self, modes: ModeSpace, front: usize, weight: f64) -> Vec<Clique>;

    /// Moves the fronts by `step` (coefficients of the modes) along their normals, nowhere further than `reach` and
    /// nowhere so far that they would fold.
    fn advanced(&self, grid: &Grid<D>, modes: ModeSpace, step: &[f64], reach: f64) -> Advance<Self>;

    /// Moves the fronts as [`Zone::advanced`] does, or as the level set of a function on the nodes of the grid; in one
    /// dimension that makes no difference.
    fn transported(
        &self,
        grid: &Grid<D>,
        modes: ModeSpace,
        step: &[f64],
        reach: f64,
        _transport: Transport,
    ) -> Advance<Self> {
        self.advanced(grid, modes, step, reach)
    }

    /// The zone with its fronts moved by a sum of multiples of the ways that they have come since earlier zones; none where
    /// these differ in more than the place of the fronts.
    fn extrapolated(&self, grid: &Grid<D>, before: &[(&Self, f64)]) -> Option<Self>;

    /// How far the fronts are from those of a zone that was extrapolated from the same one, at the place where that is
    /// farthest relative to a size; none where that is not told.
    fn farthest_from(&self, _other: &Self, _size: &dyn Fn(&Point<D>) -> f64) -> Option<f64> {
        None
    }

    /// The zone within outlines on each side, with modes as long as cells of the given sizes can tell apart.
    fn within(grid: &Grid<D>, _sizing: &Arc<Sizing<D>>, _outlines: &[(Side, Vec<Point<D>>)]) -> Self {
        Self::empty(grid)
    }

    /// Adds the set where `f < 0`, which lies outside the zone and touches one side.
    fn united(&self, grid: &Grid<D>, side: Side, f: &mut dyn FnMut(&Point<D>) -> f64) -> Self;
    /// Removes the set where `f < 0`.
    fn reduced(&self, grid: &Grid<D>, f: &mut dyn FnMut(&Point<D>) -> f64) -> Self;
    /// The zone without one of its parts.
    fn without(&self, grid: &Grid<D>, part: usize) -> Self;
    /// The zone without those holes of which this says so, from the side that is touched round them, their outlines and
    /// areas; none where it does of no hole.
    fn filled(&self, _grid: &Grid<D>, _closes: &dyn Fn(Side, &[Point<D>], f64) -> bool) -> Option<Self> {
        None
    }
    /// A small zone about a point that touches one side, added.
    fn seeded(&self, grid: &Grid<D>, side: Side, x: &Point<D>, radius: f64) -> Self;
    /// Distance from `x` to the nearest front, if that is near: of fronts beyond `within` none need be known.
    fn distance(&self, x: &Point<D>, within: f64) -> f64;
    /// The region of a point of the membrane.
    fn region_at(&self, x: &Point<D>) -> RegionId;
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
    /// The zone with fronts of as many modes as another grid can tell apart.
    fn on_grid(&self, grid: &Grid<D>) -> Self;
    /// The zone with fronts whose modes are as long as cells of the given sizes can tell apart, the smallest of which are
    /// those of the grid.
    fn on_sizes(&self, grid: &Grid<D>, _sizing: &Arc<Sizing<D>>) -> Self {
        self.on_grid(grid)
    }
    /// The zone with fronts of as many modes as the cells of a membrane can tell apart.
    fn on_cells(&self, membrane: &Membrane<D>) -> Self {
        match &membrane.sizing {
            Some(sizing) => self.on_sizes(&membrane.grid, sizing),
            None => self.on_grid(&membrane.grid),
        }
    }
    /// The sizes that the fronts want of cells: those of `grid` divided at least and at most so often, and `finer` times more
    /// often than would do; none where cells are not divided or need not be.
    fn sizing(&self, _grid: &Grid<D>, _divisions: [usize; 2], _finer: usize) -> Option<Sizing<D>> {
        None
    }
    /// Cells divided near the fronts as the sizes say, at most so often, and elsewhere where `also` says so of a cell's box and
    /// how often it was divided; none where cells are not divided.
    fn divided(
        &self,
        _cells: &Arc<dyn Cells<D>>,
        _sizing: &Sizing<D>,
        _most: usize,
        _also: &dyn Fn(&Aabb<D>, usize) -> bool,
    ) -> Option<Arc<dyn Cells<D>>> {
        None
    }
    /// The zone as numbers, from which [`Zone::from_json`] makes the same one again.
    fn to_json(&self) -> Value;
    /// The zone of such numbers, on a grid or one as much finer as it was; none where they make no zone.
    fn from_json(grid: &Grid<D>, value: &Value) -> Option<Self>;
    /// The state of a large membrane by multigrid; none where that is not the way.
    ///
    /// # Errors
    /// Equations that cannot be solved.
    fn by_multigrid(
        _membrane: &Membrane<D>,
        _at: (usize, f64),
        _progress: &mut dyn Progress,
    ) -> Result<Option<Solution<D, Self>>, SolveError> {
        Ok(None)
    }
    /// Points along every front, for pictures and files; one in one dimension.
    fn outlines(&self) -> Vec<Vec<Point<D>>>;
}
