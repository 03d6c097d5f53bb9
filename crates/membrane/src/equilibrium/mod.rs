//! Equilibrium of the free membrane outside a given contact zone: the one-sided formulation.
//!
//! In contact the displacement is the floor and the pressure is known, so only the free regions are solved for. On
//! their boundary the displacement is imposed weakly by the symmetric method of Nitsche; a ghost penalty keeps cells
//! that are cut to slivers stable. For every test function `v`
//!
//! ```text
//! ∫ T ∇u·∇v - ∫_Γ T (∂_ν u v + ∂_ν v u) + (β T/h) ∫_Γ u v + s_h(u, v)
//!     = ∫ f v - ∫_Γ T ∂_ν v G + (β T/h) ∫_Γ G v
//! ```
//!
//! with `β = 8 p² + 4`, and the flux `T ∂_n u_h + (β T/h)(u_h - G)` is the variational one: tested against smooth functions
//! it converges with twice the order of the gradient. The matrix is symmetric and positive definite. Each connected
//! free region has unknowns of its own, so a thin wall of contact between two of them couples nothing.

pub(crate) mod elements;
pub(crate) mod free;
pub(crate) mod ghost;
pub(crate) mod system;
mod thin_parts;
pub(crate) mod unknowns;

use crate::method::Formulation;
use crate::problem::Membrane;
use crate::published::saddle::Saddle;
use crate::quadrature::{Cell, Quadrature, RimPoint};
use crate::zone::{Zone, contact_of};
use elements::penalty;
use free::evaluate;
use signorini_fem::cut::RegionId;
use signorini_fem::lagrange::Tabulation;
use signorini_geometry::{Point, Vector};
use signorini_solve::{Factor, SolveError};
use system::{HOLDS, System};
use unknowns::Unknowns;

pub use elements::Elements;
pub use free::FreeState;

/// The state of a membrane with a given contact zone.
pub struct Equilibrium<const D: usize> {
    pub membrane: Membrane<D>,
    pub quadrature: Quadrature<D>,
    unknowns: Unknowns,
    /// None where other means than a factorisation found the displacement.
    factor: Option<Factor>,
    /// Values at the nodes of the free regions.
    u: Vec<f64>,
    /// In the published formulation, the other side and the multipliers.
    saddle: Option<Saddle<D>>,
}

impl<const D: usize> Equilibrium<D> {
    /// Solves for the free membrane around a zone.
    pub fn solve<Z: Zone<D>>(membrane: &Membrane<D>, zone: &Z, elements: &mut Elements<D>) -> Result<Self, SolveError> {
        if let (Formulation::Published(published), false) = (membrane.formulation, zone.is_empty()) {
            let System { quadrature, unknowns, matrix, rhs } = System::assemble(membrane, zone, elements);
            let (saddle, u) =
                Saddle::solve(membrane, zone, elements, &quadrature, &unknowns, matrix, rhs, published.multiplier)?;
            let membrane = membrane.clone();
            return Ok(Self { membrane, quadrature, unknowns, factor: None, u, saddle: Some(saddle) });
        }
        let mut system = System::assemble(membrane, zone, elements);
        let mut factor = elements.symbolic.factor(system.matrix);
        for hold in HOLDS {
            if let Err(SolveError::NotPositiveDefinite { .. }) = factor {
                system = System::held(membrane, system.quadrature, elements, hold);
                factor = elements.symbolic.factor(system.matrix);
            }
        }
        let factor = factor?;
        let u = factor.solve_accurately(&system.rhs)?;
        let System { quadrature, unknowns, .. } = system;
        Ok(Self { membrane: membrane.clone(), quadrature, unknowns, factor: Some(factor), u, saddle: None })
    }

    /// A state whose displacement is found by other means, and given by [`Equilibrium::set_values`]; its fronts cannot
    /// respond to each other.
    pub(crate) fn unsolved(membrane: Membrane<D>, quadrature: Quadrature<D>, unknowns: Unknowns) -> Self {
        let u = vec![0.0; unknowns.count];
        Self { membrane, quadrature, unknowns, factor: None, u, saddle: None }
    }

    /// The displacement of the free membrane.
    pub fn free(&self) -> FreeState<'_, D> {
        FreeState { membrane: &self.membrane, quadrature: &self.quadrature, unknowns: &self.unknowns, u: &self.u }
    }

    pub(crate) fn unknowns(&self) -> &Unknowns {
        &self.unknowns
    }

    /// Whether the response of the membrane to its fronts can be computed.
    pub fn responds(&self) -> bool {
        self.factor.is_some()
    }

    /// The values of the unknowns.
    pub(crate) fn values(&self) -> &[f64] {
        &self.u
    }

    pub(crate) fn set_values(&mut self, value: impl Fn(usize) -> f64) {
        self.u.iter_mut().enumerate().for_each(|(i, u)| *u = value(i));
    }

    /// Number of unknowns of the linear system.
    pub fn size(&self) -> usize {
        self.unknowns.count
    }

    /// Displacement and its gradient at a point of a cell, by the polynomial of one of its regions.
    pub fn evaluate(&self, cell: usize, region: RegionId, x: &Point<D>) -> Option<(f64, Vector<D>)> {
        evaluate(&self.membrane, &self.unknowns, &self.u, cell, region, x)
    }

    /// The regions with unknowns in a cell.
    pub fn free_regions(&self, cell: usize) -> impl Iterator<Item = RegionId> + '_ {
        self.unknowns.of_cell(cell).map(|(region, _)| region)
    }

    /// Calls `visit(cell, region, x, weight)` at every volume point of the membrane.
    pub fn for_each_point(&self, mut visit: impl FnMut(usize, RegionId, &Point<D>, f64)) {
        for cell in 0..self.quadrature.cells.len() {
            for (region, points) in self.quadrature.volumes(&self.membrane, cell) {
                for p in points.iter() {
                    visit(cell, region, &p.x, p.weight);
                }
            }
        }
    }

    /// The other side of the fronts and the multipliers, in the published formulation.
    pub fn saddle(&self) -> Option<&Saddle<D>> {
        self.saddle.as_ref()
    }

    /// The slope with which the gap opens at each point of the fronts, `ρ = ∂_n u + (β/h)(u - h) - ∂_n h`, and its
    /// opposite below a ceiling. In the published formulation the multiplier over the tension is the slope of the membrane.
    pub fn slope_jump(&self) -> Vec<f64> {
        if let Some(saddle) = &self.saddle {
            return saddle.slope_jump(&self.free());
        }
        self.quadrature
            .front
            .iter()
            .map(|p| {
                let (u, gradient) = self.evaluate(p.cell, p.free, &p.x).unwrap_or((0.0, Vector::zeros()));
                let h = self.membrane.obstacles.jet(p.side, &p.x);
                let jump = (gradient - h.gradient).dot(&p.normal) + penalty(&self.membrane, p.cell) * (u - h.value);
                p.side.sign() * jump
            })
            .collect()
    }

    /// The flux `T ∂_ν u` out of the membrane at a point of its boundary; zero on a free edge.
    pub fn support_flux(&self, p: &RimPoint<D>) -> f64 {
        let Some(support) = &self.membrane.supports[p.piece] else { return 0.0 };
        if let Some((side, _)) = contact_of(p.region) {
            // In contact up to the support: the membrane follows the body.
            let slope = self.membrane.obstacles.jet(side, &p.x).gradient;
            self.membrane.tension.value(&p.x) * slope.dot(&p.normal)
        } else {
            let (u, gradient) = self.evaluate(p.cell, p.region, &p.x).unwrap_or((0.0, Vector::zeros()));
            nitsche_flux(&self.membrane, p.cell, &p.x, &p.normal, u - support.displacement.value(&p.x), &gradient)
        }
    }

    /// The rate at which the slope of the gap changes on the fronts where the gap itself changes at the rate `data`: the
    /// normal derivative of the field that takes these values there, vanishes on the supports and is in equilibrium without
    /// load. This is the Dirichlet-to-Neumann map, from the factorisation at hand.
    pub fn normal_derivative_of_extension(&self, data: &[f64]) -> Result<Vec<f64>, SolveError> {
        let membrane = &self.membrane;
        let mut rhs = vec![0.0; self.unknowns.count];
        let mut t = Tabulation::default();
        for (p, &value) in self.quadrature.front.iter().zip(data) {
            if value == 0.0 {
                continue;
            }
            let Some(dofs) = self.unknowns.of(p.cell, p.free) else { continue };
            membrane.cells.tabulate(p.cell, &p.x, &mut t);
            let penalty = penalty(membrane, p.cell);
            let w = p.weight * membrane.tension.value(&p.x) * p.side.sign() * value;
            for (a, &i) in dofs.iter().enumerate() {
                rhs[i as usize] += w * (t.gradient[a].dot(&p.normal) + penalty * t.value[a]);
            }
        }
        let z = self.respond(&rhs)?;
        Ok(self
            .quadrature
            .front
            .iter()
            .zip(data)
            .map(|(p, &value)| {
                let (v, gradient) =
                    evaluate(membrane, &self.unknowns, &z, p.cell, p.free, &p.x).unwrap_or((0.0, Vector::zeros()));
                let sign = p.side.sign();
                sign * gradient.dot(&p.normal) + penalty(membrane, p.cell) * (sign * v - value)
            })
            .collect())
    }

    /// What the unknowns are under other forces, by the factorisation at hand.
    pub(crate) fn respond(&self, forces: &[f64]) -> Result<Vec<f64>, SolveError> {
        match &self.factor {
            Some(factor) => factor.solve(forces),
            None => Err(SolveError::NotFactorised { size: forces.len() }),
        }
    }

    /// The displacement at a point in any region: the solution where free, the body in contact, none outside.
    pub fn displacement<Z: Zone<D>>(&self, zone: &Z, x: &Point<D>) -> Option<f64> {
        if !self.membrane.contains(x) {
            return None;
        }
        let cell = self.membrane.cells.containing(x)?;
        let region = match &self.quadrature.cells[cell] {
            Cell::Whole(region) => *region,
            _ => zone.region_at(x),
        };
        match contact_of(region) {
            Some((side, _)) => Some(self.membrane.obstacles.height(side, x)),
            None => self.evaluate(cell, region, x).map(|v| v.0),
        }
    }
}

/// The variational flux `T (∂_ν u - (β/h)(u - G))` through a point where the displacement is imposed weakly.
pub(crate) fn nitsche_flux<const D: usize>(
    membrane: &Membrane<D>,
    cell: usize,
    x: &Point<D>,
    outward: &Vector<D>,
    mismatch: f64,
    gradient: &Vector<D>,
) -> f64 {
    membrane.tension.value(x) * (gradient.dot(outward) - penalty(membrane, cell) * mismatch)
}
