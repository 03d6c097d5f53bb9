//! How the slope jump changes as the fronts move: integrals over the domain.
//!
//! Functions are carried along with a velocity `w` that moves the fronts and fades out around them. Body and load stay
//! where they are. With `M = (div w) I - ∇w - ∇wᵀ` the rates satisfy the equations of the state itself with the right-hand
//! sides
//!
//! ```text
//! ∫ (∇f·w + f div w) v - ∫ (T M∇u + (∇T·w) ∇u)·∇v - ∫_Γ λ [[v]] div_Γ w
//! ∫_zone l² ∇q·∇(∇h·w) + q ∇h·w - l² M∇q·∇(u-h) - q (u-h) div w
//! -∫_Γ μ [[u]] div_Γ w
//! ```
//!
//! and the slope of the gap changes at the rate `ρ° = λ°/T - λ (∇T·w)/T² - n·(∇∇h) w - ∇h·n°`.

use super::saddle::{Saddle, combined};
use super::velocity::{Velocities, Velocity};
use crate::equilibrium::free::FreeState;
use crate::method::ModeSpace;
use crate::zone::{Zone, contact, contact_of, is_free};
use signorini_fem::lagrange::Tabulation;
use signorini_geometry::Vector;
use signorini_solve::SolveError;

/// What the fronts do as one mode moves them with unit speed.
pub struct FrontRate {
    /// `ρ°` at each of their quadrature points.
    pub slope_jump: Vec<f64>,
    /// `div_Γ w` there: how they stretch.
    pub stretch: Vec<f64>,
}

impl<const D: usize> Saddle<D> {
    /// The rates of all modes of the fronts.
    ///
    /// # Errors
    /// Equations that cannot be solved.
    pub fn rates<Z: Zone<D>>(
        &self,
        free: &FreeState<'_, D>,
        zone: &Z,
        space: ModeSpace,
    ) -> Result<Vec<FrontRate>, SolveError> {
        let modes = zone.mode_offsets(space)[zone.front_count()];
        let velocities = Velocities::new(free.membrane, zone, free.quadrature, space);
        let mut load = vec![vec![0.0; free.u.len()]; modes];
        let mut within = vec![vec![0.0; self.within.count]; modes];
        self.carry_cells(free, &velocities, &mut load, &mut within);
        let mut along = vec![vec![0.0; self.fronts.count]; modes];
        let on_fronts = self.carry_fronts(free, zone, &velocities, &mut load, &mut along);
        let lambda = (0..modes)
            .map(|m| self.lambda_rate(&load[m], &within[m], &along[m]))
            .collect::<Result<Vec<_>, SolveError>>()?;
        let points = &free.quadrature.front;
        let mut rates: Vec<FrontRate> = (0..modes)
            .map(|_| FrontRate { slope_jump: vec![0.0; points.len()], stretch: vec![0.0; points.len()] })
            .collect();
        let membrane = free.membrane;
        for (i, p) in points.iter().enumerate() {
            let (sign, tension) = (p.side.sign(), membrane.tension.jet(&p.x));
            for (rate, lambda) in rates.iter_mut().zip(&lambda) {
                rate.slope_jump[i] = sign * self.along(lambda, i) / tension.value;
            }
            let h = membrane.obstacles.jet(p.side, &p.x);
            let pull = self.along(&self.lambda, i) / tension.value.powi(2);
            for v in &on_fronts[i] {
                let bend = p.normal.dot(&(h.hessian * v.w)) + h.gradient.dot(&v.normal_rate(&p.normal));
                rates[v.mode].slope_jump[i] -= sign * (pull * tension.gradient.dot(&v.w) + bend);
                rates[v.mode].stretch[i] += v.surface_divergence(membrane.measure, &p.x, &p.normal);
            }
        }
        Ok(rates)
    }

    /// The terms over cells.
    fn carry_cells<Z: Zone<D>>(
        &self,
        free: &FreeState<'_, D>,
        velocities: &Velocities<'_, D, Z>,
        load: &mut [Vec<f64>],
        within: &mut [Vec<f64>],
    ) {
        let (membrane, quadrature) = (free.membrane, free.quadrature);
        let gradient_weight = self.gradient_weight();
        let mut t = Tabulation::default();
        let mut carried: Vec<Velocity<D>> = Vec::new();
        for cell in 0..quadrature.cells.len() {
            let b = membrane.cells.bounds_of(cell);
            let near = velocities.near(&b.center(), 0.5 * b.size().norm());
            if near.is_empty() {
                continue;
            }
            for (region, points) in quadrature.volumes(membrane, cell) {
                for p in points.iter() {
                    velocities.at(&near, &p.x, &mut carried);
                    if carried.is_empty() {
                        continue;
                    }
                    membrane.cells.tabulate(cell, &p.x, &mut t);
                    if let (true, Some(dofs)) = (is_free(region), free.unknowns.of(cell, region)) {
                        let (_, slope) = combined(&t, dofs, free.u);
                        let (tension, f) = (membrane.tension.jet(&p.x), membrane.load.jet(&p.x));
                        for v in &carried {
                            let divergence = v.divergence(membrane.measure, &p.x);
                            let flux = (slope * divergence - v.strain_times(&slope)) * tension.value
                                + slope * tension.gradient.dot(&v.w);
                            let push = f.gradient.dot(&v.w) + f.value * divergence;
                            for (a, &i) in dofs.iter().enumerate() {
                                load[v.mode][i as usize] += p.weight * (push * t.value[a] - flux.dot(&t.gradient[a]));
                            }
                        }
                    } else if let (Some((side, _)), Some(dofs)) = (contact_of(region), self.within.of(cell, region)) {
                        let (u, slope) = combined(&t, dofs, &self.displacement);
                        let h = membrane.obstacles.jet(side, &p.x);
                        let (lack, lack_slope) = (u - h.value, slope - h.gradient);
                        for v in &carried {
                            let divergence = v.divergence(membrane.measure, &p.x);
                            let rise: Vector<D> = h.hessian * v.w + v.transposed_times(&h.gradient);
                            let gradient =
                                (rise - lack_slope * divergence + v.strain_times(&lack_slope)) * gradient_weight;
                            let value = h.gradient.dot(&v.w) - lack * divergence;
                            for (a, &i) in dofs.iter().enumerate() {
                                within[v.mode][i as usize] +=
                                    p.weight * (gradient.dot(&t.gradient[a]) + value * t.value[a]);
                            }
                        }
                    }
                }
            }
        }
    }

    /// The terms along the fronts; the velocities at their points.
    fn carry_fronts<Z: Zone<D>>(
        &self,
        free: &FreeState<'_, D>,
        zone: &Z,
        velocities: &Velocities<'_, D, Z>,
        load: &mut [Vec<f64>],
        along: &mut [Vec<f64>],
    ) -> Vec<Vec<Velocity<D>>> {
        let membrane = free.membrane;
        let mut t = Tabulation::default();
        debug_assert!(zone.front_count() > 0);
        let points = free.quadrature.front.iter().enumerate();
        points
            .map(|(i, p)| {
                let mut carried = Vec::new();
                velocities.at(&[p.front], &p.x, &mut carried);
                membrane.cells.tabulate(p.cell, &p.x, &mut t);
                let lambda = self.along(&self.lambda, i);
                let (Some(beyond), Some(within)) =
                    (free.unknowns.of(p.cell, p.free), self.within.of(p.cell, contact(p.side, p.zone)))
                else {
                    return carried;
                };
                let jump = combined(&t, beyond, free.u).0 - combined(&t, within, &self.displacement).0;
                for v in &carried {
                    let stretch = p.weight * v.surface_divergence(membrane.measure, &p.x, &p.normal);
                    for (a, &dof) in beyond.iter().enumerate() {
                        load[v.mode][dof as usize] -= stretch * lambda * t.value[a];
                    }
                    for &(k, share) in &self.fronts.shares[i] {
                        along[v.mode][k] -= stretch * share * jump;
                    }
                }
                carried
            })
            .collect()
    }
}
