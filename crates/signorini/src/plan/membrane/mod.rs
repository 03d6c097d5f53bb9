//! A membrane, what it may touch, and its history, ready to be solved.

mod check;
mod contacts;
mod method;
mod read;
mod supports;
mod times;

use super::domain;
use super::head::Head;
use super::located::{LocatedExpression, field};
use super::memory::{memory_at_hand, memory_estimate};
use super::surface::Contact;
use crate::problem::{self, Body, Space};
use signorini_fem::{Cells, Grid};
use signorini_geometry::Point;
use signorini_membrane::domain::{Domain, DomainOnCells};
use signorini_membrane::field::{SharedField, Sum};
use signorini_membrane::history::{MethodChoice, PlannedIncrement, Statement};
use signorini_membrane::kernel::Kernel;
use signorini_membrane::obstacle::{Obstacles, Side};
use signorini_membrane::problem::{Measure, Membrane, Support};
use signorini_membrane::refinement::Refinement;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A support: its name and the displacement it prescribes.
#[derive(Clone)]
pub struct PlannedSupport {
    pub name: String,
    pub displacement: LocatedExpression,
    pub pieces: Vec<usize>,
}

/// A membrane, what it may touch, and its history.
pub struct MembranePlan<const D: usize> {
    pub head: Head,
    pub space: Space,
    /// What the displacement is computed on.
    pub cells: Arc<dyn Cells<D>>,
    /// Where zones are told apart.
    pub grid: Grid<D>,
    pub domain: DomainOnCells<D>,
    /// Where cells are divided.
    pub refinement: Refinement<D>,
    pub tension: LocatedExpression,
    pub loads: BTreeMap<String, LocatedExpression>,
    pub supports: Vec<PlannedSupport>,
    pub body: String,
    /// What it may touch, in the order of the membrane's obstacles.
    pub contacts: Vec<Contact>,
    pub method: MethodChoice,
    /// The zone that the first increment starts from, where the case asks for one.
    pub initial_zone: Option<(Side, Arc<dyn Domain<D>>)>,
    pub increments: Vec<PlannedIncrement>,
    /// What solves for it.
    pub kernel: Kernel<D>,
    pub probes: BTreeMap<String, Point<D>>,
}

impl<const D: usize> MembranePlan<D> {
    pub(super) fn expressions(&self) -> impl Iterator<Item = &LocatedExpression> {
        let touched =
            self.contacts.iter().flat_map(|c| std::iter::once(&c.height).chain(&c.displacement).chain(&c.adhesion));
        std::iter::once(&self.tension)
            .chain(self.loads.values())
            .chain(self.supports.iter().map(|s| &s.displacement))
            .chain(touched)
    }

    /// The membrane at one time.
    pub fn at(&self, time: f64) -> Membrane<D> {
        let mut supports: Vec<Option<Support<D>>> = vec![None; self.domain.domain.pieces()];
        for (index, support) in self.supports.iter().enumerate() {
            for &piece in &support.pieces {
                let displacement = field(&support.displacement.expression, time);
                supports[piece] = Some(Support { index, displacement });
            }
        }
        let loads: Vec<SharedField<D>> = self.loads.values().map(|l| field(&l.expression, time)).collect();
        let load: SharedField<D> = match loads.as_slice() {
            [one] => one.clone(),
            _ => Arc::new(Sum(loads)),
        };
        Membrane {
            cells: self.cells.clone(),
            grid: self.grid.clone(),
            domain: self.domain.clone(),
            sizing: None,
            measure: if self.space == Space::Axisymmetric { Measure::Axisymmetric } else { Measure::Plain },
            tension: field(&self.tension.expression, time),
            load,
            obstacles: Obstacles(self.contacts.iter().map(|c| c.at(time)).collect()),
            supports,
            support_count: self.supports.len(),
            modes: self.method.modes(),
            formulation: self.method.formulation(),
        }
    }

    /// The radius of a membrane that is stated as a disc.
    pub fn disc_radius(&self) -> Option<f64> {
        let Body::Membrane(film) = self.head.problem.bodies.get(&self.body)? else { return None };
        let problem::Domain::Disc(_) = film.domain.as_ref()? else { return None };
        Some(0.5 * self.grid.bounds().size()[0] / domain::MARGIN)
    }

    /// The resultant of each load along z.
    pub fn load_resultants(&self, membrane: &Membrane<D>, time: f64) -> BTreeMap<String, f64> {
        let quadrature = (self.kernel.quadrature)(membrane);
        let fields: Vec<SharedField<D>> = self.loads.values().map(|l| field(&l.expression, time)).collect();
        let mut sums = vec![0.0; fields.len()];
        for cell in 0..quadrature.cells.len() {
            for (_, points) in quadrature.volumes(membrane, cell) {
                for p in points.iter() {
                    for (sum, f) in sums.iter_mut().zip(&fields) {
                        *sum += p.weight * f.value(&p.x);
                    }
                }
            }
        }
        self.loads.keys().cloned().zip(sums).collect()
    }

    /// What to say where a factorisation needs more memory than there is.
    pub fn lacks_memory(&self) -> Option<String> {
        let unknowns = self.cells.function_count() as f64;
        let bytes = memory_estimate(unknowns, self.cells.degree(), D);
        (bytes > memory_at_hand()).then(|| {
            format!(
                "multigrid did not find a state, and a factorisation of {unknowns:.1e} unknowns requires about {:.1} \
                 GiB, more than is free; start with fewer cells to find out why",
                bytes / f64::from(1u32 << 30)
            )
        })
    }
}

impl<const D: usize> Statement<D> for MembranePlan<D> {
    fn method(&self) -> MethodChoice {
        self.method
    }
    fn grid(&self) -> &Grid<D> {
        &self.grid
    }
    fn refinement(&self) -> &Refinement<D> {
        &self.refinement
    }
    fn initial_zone(&self) -> Option<&(Side, Arc<dyn Domain<D>>)> {
        self.initial_zone.as_ref()
    }
    fn increments(&self) -> &[PlannedIncrement] {
        &self.increments
    }
    fn has_units(&self) -> bool {
        self.head.problem.units.is_some()
    }
    fn at(&self, time: f64) -> Membrane<D> {
        self.at(time)
    }
    fn check(&self, membrane: &Membrane<D>, time: f64) -> Result<(), String> {
        self.check_fields(membrane, time).map_err(|error| error.one_line())
    }
    fn places(&self, times: &[f64]) -> Vec<f64> {
        self.places(times)
    }
    fn lacks_memory(&self) -> Option<String> {
        self.lacks_memory()
    }
}
