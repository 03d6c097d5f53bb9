//! A membrane at one instant: where it is, what pulls, pushes and holds it, and the bodies below and above.

use crate::domain::{CellStatus, DomainOnCells};
use crate::field::SharedField;
use crate::method::{Formulation, Modes};
use crate::obstacle::{Obstacles, Side};
use crate::sizing::{Sizing, coarsened};
use signorini_fem::{Cells, Grid};
use signorini_geometry::{Point, Vector};
use std::sync::Arc;

/// Cells along a side of a grid on which functions are sampled where cells differ in size.
const MOST_SAMPLES: usize = 512;

/// Cells beside others are that much larger than what is wanted of these.
const BESIDE: f64 = 1.5;

/// What a unit of the coordinates measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// Length or area themselves.
    Plain,
    /// The coordinate is a radius: integrals run over the whole disc, with the weight `2π r`.
    Axisymmetric,
}

impl Measure {
    pub fn weight<const D: usize>(self, x: &Point<D>) -> f64 {
        match self {
            Measure::Plain => 1.0,
            Measure::Axisymmetric => std::f64::consts::TAU * x[0],
        }
    }

    /// What the measure adds to the divergence of a normal with component `n` along the first axis.
    pub fn curvature<const D: usize>(self, x: &Point<D>, n: f64) -> f64 {
        match self {
            Measure::Plain => 0.0,
            Measure::Axisymmetric => n / x[0],
        }
    }
}

/// What holds one piece of the boundary.
#[derive(Clone)]
pub struct Support<const D: usize> {
    /// Which of the named supports this is.
    pub index: usize,
    /// The prescribed displacement.
    pub displacement: SharedField<D>,
}

/// A membrane of tension `T` under the load `f`, over a floor of height `h`: find `u >= h` with
/// `div(T ∇u) + f + p = 0`, `p >= 0`, `p (u - h) = 0`; under a ceiling the inequalities are turned round.
#[derive(Clone)]
pub struct Membrane<const D: usize> {
    /// What the displacement is computed on.
    pub cells: Arc<dyn Cells<D>>,
    /// Where zones are told apart: the cells themselves, or a grid of about their size.
    pub grid: Grid<D>,
    /// How large cells and modes are where they differ; none where cells are as large as those of the grid.
    pub sizing: Option<Arc<Sizing<D>>>,
    pub domain: DomainOnCells<D>,
    pub measure: Measure,
    /// Force per length.
    pub tension: SharedField<D>,
    /// Force per area along +z: negative where it presses downwards.
    pub load: SharedField<D>,
    /// What it may touch.
    pub obstacles: Obstacles<D>,
    /// What holds each piece of the boundary; a piece without support is a free edge.
    pub supports: Vec<Option<Support<D>>>,
    /// Number of named supports.
    pub support_count: usize,
    /// How fronts move.
    pub modes: Modes,
    /// How the equilibrium beside a zone is formulated.
    pub formulation: Formulation,
}

impl<const D: usize> Membrane<D> {
    /// The pressure with which a body in contact pushes: `p = -div(T ∇h) - f` upwards, or its opposite downwards.
    pub fn pressure(&self, side: Side, x: &Point<D>) -> f64 {
        let h = self.obstacles.jet(side, x);
        // In polar coordinates the Laplacian has one more term, h'/r, which tends to h'' at the axis.
        let polar = match self.measure {
            Measure::Axisymmetric if x[0] == 0.0 => h.hessian[(0, 0)],
            measure => measure.curvature(x, h.gradient[0]),
        };
        let laplacian = h.laplacian() + polar;
        let bend = match self.tension.constant() {
            Some(t) => t * laplacian,
            None => {
                let t = self.tension.jet(x);
                t.value * laplacian + t.gradient.dot(&h.gradient)
            }
        };
        -side.sign() * (bend + self.load.value(x))
    }

    /// The slope at which adhesion holds a front, `ρ_a = √(2γ/T)`, and its gradient; zero where nothing is sticky.
    pub fn adhesive_slope(&self, side: Side, x: &Point<D>) -> (f64, Vector<D>) {
        let Some(adhesion) = self.obstacles.at(side, x).and_then(|o| o.adhesion.as_ref()) else {
            return (0.0, Vector::zeros());
        };
        let (energy, tension) = (adhesion.jet(x), self.tension.jet(x));
        if energy.value <= 0.0 {
            return (0.0, Vector::zeros());
        }
        let slope = (2.0 * energy.value / tension.value).sqrt();
        // The derivative of a logarithm, halved.
        (slope, (energy.gradient / energy.value - tension.gradient / tension.value) * (0.5 * slope))
    }

    /// Whether a point belongs to the membrane.
    pub fn contains(&self, x: &Point<D>) -> bool {
        let Some(cell) = self.cells.containing(x) else { return false };
        match self.domain.status[cell] {
            CellStatus::Inside => self.grid.bounds().contains(x),
            CellStatus::Outside => false,
            CellStatus::Crossed => {
                let boundary = self.domain.domain.boundary_in(&self.cells.bounds_of(cell));
                let values: Vec<f64> = boundary.sheets.iter().map(|s| s.value(x)).collect();
                self.domain.domain.contains(x, &values)
            }
        }
    }

    /// The grid on which functions are sampled to tell zones apart: the grid itself, where its cells are not the smallest of
    /// a few.
    pub fn samples(&self) -> Grid<D> {
        if self.sizing.is_some() { coarsened(&self.grid, MOST_SAMPLES) } else { self.grid.clone() }
    }

    /// The size of the cells at the fronts, in the mean.
    pub fn front_size(&self) -> f64 {
        self.sizing.as_ref().map_or(self.grid.h(), |sizing| sizing.mean())
    }

    /// The size of the cells at a place, or of somewhat larger ones beside it.
    pub fn cell_size(&self, x: &Point<D>) -> f64 {
        let Some(sizing) = &self.sizing else { return self.grid.h() };
        let own = self.cells.containing(x).map_or(0.0, |cell| self.cells.size(cell));
        own.max(BESIDE * sizing.at(x))
    }

    /// The largest extent of the grid.
    pub fn size(&self) -> f64 {
        self.grid.bounds().size().max()
    }

    /// The same membrane on other cells.
    pub fn on(&self, cells: Arc<dyn Cells<D>>) -> Self {
        let domain = DomainOnCells::new(self.domain.domain.clone(), &*cells);
        Self { cells, domain, sizing: None, ..self.clone() }
    }

    /// The same membrane on the cells of another one of the same domain.
    pub fn on_cells_of(self, other: &Self) -> Self {
        let Self { cells, grid, domain, sizing, .. } = other.clone();
        Self { cells, grid, domain, sizing, ..self }
    }
}
