//! What is compiled here once for each dimension: crates above call it without compiling the method again.

use crate::conditions::least_free_gap;
use crate::equilibrium::Equilibrium;
use crate::equilibrium::elements::Elements;
use crate::history::{History, Statement, WithZones};
use crate::ils::{self, StoppingRule};
use crate::line_zone::LineZone;
use crate::obstacle::Side;
use crate::plane_zone::PlaneZone;
use crate::problem::Membrane;
use crate::quadrature::Quadrature;
use crate::solution::{Solution, Start};
use crate::zone::{NoZone, Zone};
use signorini_geometry::Point;
use signorini_solve::{Progress, SolveError};
use std::rc::Rc;

/// A membrane without contact, in equilibrium.
pub struct FreeMembrane<const D: usize> {
    /// The least gap, to what, and where.
    pub least_gap: (f64, Side, Point<D>),
    /// The largest slope.
    pub steepest: f64,
    /// The displacement at a point; none outside the membrane.
    pub displacement: Box<dyn Fn(&Point<D>) -> Option<f64>>,
}

/// Entry points to the method in one dimension or two.
pub struct Kernel<const D: usize> {
    /// A history at its beginning.
    pub history: fn(Rc<dyn Statement<D>>) -> Box<dyn History<D>>,
    /// The membrane without contact.
    pub free: fn(&Membrane<D>) -> Result<FreeMembrane<D>, SolveError>,
    /// The integration points of the membrane without contact.
    pub quadrature: fn(&Membrane<D>) -> Quadrature<D>,
}

impl Kernel<1> {
    /// Strings and round membranes.
    pub const LINE: Self = Self { history: history_on_line, free: free_on_line, quadrature: quadrature_on_line };
}

impl Kernel<2> {
    /// Membranes in the plane.
    pub const PLANE: Self = Self { history: history_in_plane, free: free_in_plane, quadrature: quadrature_in_plane };
}

// Functions with names: a closure in a constant is compiled where the constant is used.

fn history_on_line(statement: Rc<dyn Statement<1>>) -> Box<dyn History<1>> {
    Box::new(WithZones::<1, LineZone>::new(statement))
}

fn history_in_plane(statement: Rc<dyn Statement<2>>) -> Box<dyn History<2>> {
    Box::new(WithZones::<2, PlaneZone>::new(statement))
}

fn free_on_line(membrane: &Membrane<1>) -> Result<FreeMembrane<1>, SolveError> {
    free::<1, LineZone>(membrane)
}

fn free_in_plane(membrane: &Membrane<2>) -> Result<FreeMembrane<2>, SolveError> {
    free::<2, PlaneZone>(membrane)
}

fn quadrature_on_line(membrane: &Membrane<1>) -> Quadrature<1> {
    Quadrature::new(membrane, &NoZone)
}

fn quadrature_in_plane(membrane: &Membrane<2>) -> Quadrature<2> {
    Quadrature::new(membrane, &NoZone)
}

impl<const D: usize> Clone for Kernel<D> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<const D: usize> Copy for Kernel<D> {}

fn free<const D: usize, Z: Zone<D> + Sync + 'static>(membrane: &Membrane<D>) -> Result<FreeMembrane<D>, SolveError> {
    let none = Z::empty(&membrane.grid);
    let state = Equilibrium::solve(membrane, &none, &mut Elements::new(membrane))?;
    let least_gap = least_free_gap(&state, &none);
    let mut steepest = 0.0f64;
    state.for_each_point(|cell, region, x, _| {
        steepest = state.evaluate(cell, region, x).map_or(steepest, |(_, slope)| steepest.max(slope.norm()));
    });
    Ok(FreeMembrane { least_gap, steepest, displacement: Box::new(move |x| state.displacement(&none, x)) })
}

/// A membrane on a line in contact, from the membrane without contact on.
pub fn solve_line(membrane: &Membrane<1>, progress: &mut dyn Progress) -> Solution<1, LineZone> {
    ils::solve(membrane, &mut Elements::new(membrane), Start::Free, StoppingRule::Final, (0, 0.0), progress)
}

/// The equilibrium of a membrane on a line around a zone.
///
/// # Errors
/// Equations that cannot be solved.
pub fn equilibrium_on_line(
    membrane: &Membrane<1>,
    zone: &LineZone,
    elements: &mut Elements<1>,
) -> Result<Equilibrium<1>, SolveError> {
    Equilibrium::solve(membrane, zone, elements)
}
