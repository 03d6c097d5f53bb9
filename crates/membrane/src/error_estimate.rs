//! How far front, area and force may be off: the fronts of a state, judged with finer functions: of one degree more, or,
//! where cells have no such, on cells of half the size.
//!
//! The variational slope jump of the finer functions does not vanish where the fronts are; the Newton step that would make
//! it vanish is, to leading order, what they are off. On halved cells that lacks what these are off themselves, 2^-2p of
//! it.

use crate::adhesion::Branch;
use crate::equilibrium::Equilibrium;
use crate::equilibrium::elements::Elements;
use crate::front::Fronts;
use crate::method::{Formulation, ModeSpace, Modes};
use crate::problem::Membrane;
use crate::solution::Solution;
use crate::zone::{Zone, contact_of};
use signorini_solve::SolveError;

/// The estimate is as likely too small as too large: this makes it seldom too small.
const SAFETY: f64 = 1.5;
/// Errors of either sign cancel in area and force, and functions of one degree more tell what is left. Fronts of linear
/// functions have so few modes that what these cannot follow counts too: of what could cancel so much is added.
const CANCELLED: f64 = 0.3;

/// What the discretisation leaves uncertain.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ErrorEstimate {
    /// Root mean square of the distance between the fronts and the exact ones.
    pub front: f64,
    /// Of the area of contact.
    pub area: f64,
    /// Of the force of the floor on the membrane.
    pub force: f64,
    /// Of the largest pressure.
    pub max_pressure: f64,
}

impl ErrorEstimate {
    /// Estimates the errors of a solution, at the price of one solve; none without contact, or where the cells have no
    /// finer functions.
    ///
    /// # Errors
    /// Equations that cannot be solved.
    pub fn of<const D: usize, Z: Zone<D>>(solution: &Solution<D, Z>) -> Result<Option<Self>, SolveError> {
        let (Some(coarse), Some(scales)) = (&solution.equilibrium, &solution.scales) else { return Ok(None) };
        let zone = &solution.zone;
        let Some(finer) = finer(&coarse.membrane).filter(|_| !zone.is_empty()) else { return Ok(None) };
        // Splines see what a few waves may have left out.
        let membrane = Membrane { modes: Modes::Local, formulation: Formulation::OneSided, ..finer };
        let fine = Equilibrium::solve(&membrane, zone, &mut Elements::new(&membrane))?;
        let sticky = membrane.obstacles.are_sticky();
        let fronts = Fronts::new(&fine, sticky);
        let step = if sticky {
            fronts.linearise(zone, ModeSpace::Fine, scales)?.step(Branch::Nearest, scales)
        } else {
            fronts.newton_step(zone, scales)?
        };
        let frames = fronts.frames(zone, step.space);
        let (mut area, mut area_size, mut force, mut force_size) = (0.0, 0.0, 0.0, 0.0);
        let (mut square, mut total) = (0.0, 0.0);
        // In contact the pressure follows from the shape of the body: what is uncertain is where it is largest, between the
        // points of the quadrature, and at a front, which may lie on either side of where it was found.
        let found = peaks(coarse);
        let mut peak = peaks(&fine);
        for (i, (p, frame)) in fine.quadrature.front.iter().zip(&*frames).enumerate() {
            let w: f64 = frame.modes.iter().map(|(k, v)| v * step.coefficients[*k]).sum();
            // The force is that of the pressure within, less what adhesion pulls along the front.
            let curvature = frame.curvature + membrane.measure.curvature(&p.x, p.normal[0]);
            let pull = fronts.tension[i] * fronts.adhesive_slope[i] * curvature;
            let rate = fronts.pressure[i] - pull;
            (square, total) = (square + p.weight * w * w, total + p.weight);
            area += p.weight * w;
            area_size += p.weight * w.abs();
            force += p.weight * w * rate;
            force_size += p.weight * (w * rate).abs();
            let Some(body) = membrane.obstacles.index_at(p.side, &p.x) else { continue };
            for x in [p.x + w * p.normal, p.x - w * p.normal] {
                peak[body] = peak[body].max(membrane.pressure(p.side, &x));
            }
        }
        // What Newton's method left of the slope jump pulls too.
        let rest = Fronts::new(coarse, sticky);
        let points = coarse.quadrature.front.iter().zip(&rest.tension).zip(rest.excess());
        let left: f64 = points.map(|((p, tension), excess)| p.weight * tension * excess).sum();
        let cancelled = if coarse.membrane.cells.degree() == 1 { CANCELLED } else { 0.0 };
        let front = f64::sqrt(square / f64::max(total, f64::MIN_POSITIVE)).max(4.0 * f64::EPSILON * scales.length);
        Ok(Some(Self {
            front,
            area: SAFETY * area.abs() + cancelled * area_size,
            force: SAFETY * force.abs() + cancelled * force_size + left.abs(),
            max_pressure: SAFETY
                * found.iter().zip(&peak).map(|(a, b)| (a - b).abs()).filter(|e| e.is_finite()).fold(0.0, f64::max),
        }))
    }
}

/// The largest pressure of each body at the points of a state that are in contact; below all numbers where there is none.
fn peaks<const D: usize>(state: &Equilibrium<D>) -> Vec<f64> {
    let membrane = &state.membrane;
    let mut peaks = vec![f64::NEG_INFINITY; membrane.obstacles.0.len()];
    state.for_each_point(|_, region, x, _| {
        if let Some((side, _)) = contact_of(region)
            && let Some(body) = membrane.obstacles.index_at(side, x)
        {
            peaks[body] = peaks[body].max(membrane.pressure(side, x));
        }
    });
    peaks
}

/// The same membrane with finer functions: of one degree more, or on halved cells.
fn finer<const D: usize>(membrane: &Membrane<D>) -> Option<Membrane<D>> {
    match membrane.cells.raised() {
        Some(cells) => Some(Membrane { cells, ..membrane.clone() }),
        None => Some(membrane.on(membrane.cells.clone().halved()?)),
    }
}
