//! What a solution amounts to: forces, areas, pressures, energy, and the balance that proves them.

use crate::ils::Solution;
use crate::zone::{Zone, contact_index, is_free};
use signorini_geometry::Point;

/// One connected zone of contact.
#[derive(Clone, Debug)]
pub struct Component<const D: usize> {
    pub area: f64,
    /// Force of the floor on the membrane within the zone, its front included.
    pub force: f64,
    pub centroid: Point<D>,
    pub holes: usize,
}

/// The figures of a contact.
#[derive(Clone, Debug)]
pub struct ContactReport<const D: usize> {
    pub force: f64,
    pub area: f64,
    pub components: Vec<Component<D>>,
    pub holes: usize,
    /// Length of all fronts; their number in one dimension.
    pub boundary_length: f64,
    /// Part of the force that acts as a line load on the fronts; it vanishes with the slope jump.
    pub line_force: f64,
    /// What adhesion gives back over the zone, `∫ γ`.
    pub adhesion_energy: f64,
    /// Zero where the least gap is positive.
    pub max_penetration: f64,
    /// Least gap further than half a cell from the fronts; none without free membrane.
    pub min_gap_outside: Option<f64>,
    pub max_pressure: f64,
    pub min_pressure: f64,
}

/// The figures of a state.
#[derive(Clone, Debug)]
pub struct Report<const D: usize> {
    /// Force of each named support on the membrane.
    pub support_forces: Vec<f64>,
    /// Resultant of the load.
    pub load_force: f64,
    /// `∫ T/2 |∇u|² - f u`.
    pub energy: f64,
    /// `∫ u`, the volume between the membrane and its plane.
    pub volume: f64,
    /// The steepest slope `|∇u|` of the membrane.
    pub max_slope: f64,
    /// Sum of all forces, relative to the largest.
    pub equilibrium_residual: f64,
    pub contact: ContactReport<D>,
}

impl<const D: usize> Report<D> {
    /// Evaluates a solution; none if there is no state at all.
    pub fn new<Z: Zone<D>>(solution: &Solution<D, Z>) -> Option<Self> {
        let equilibrium = solution.equilibrium.as_ref()?;
        let membrane = &equilibrium.membrane;
        let zone = &solution.zone;
        let count = zone.counts().0;
        let mut components = vec![Component { area: 0.0, force: 0.0, centroid: Point::zeros(), holes: 0 }; count];
        let (mut load_force, mut energy, mut volume, mut adhesion_energy) = (0.0, 0.0, 0.0, 0.0);
        let mut max_slope = 0.0f64;
        equilibrium.for_each_point(|cell, region, x, w| {
            let f = membrane.load.value(x);
            load_force += w * f;
            let (u, gradient) = if is_free(region) {
                let Some(state) = equilibrium.evaluate(cell, region, x) else { return };
                state
            } else if let (Some(k), Some(floor)) = (contact_index(region), &membrane.floor) {
                if let Some(component) = components.get_mut(k) {
                    component.area += w;
                    component.force -= w * f;
                    component.centroid += w * x;
                }
                adhesion_energy += membrane.adhesion.as_ref().map_or(0.0, |energy| w * energy.value(x));
                let h = floor.jet(x);
                (h.value, h.gradient)
            } else {
                return;
            };
            volume += w * u;
            max_slope = max_slope.max(gradient.norm());
            energy += w * (0.5 * membrane.tension.value(x) * gradient.norm_squared() - f * u);
        });
        let (mut boundary_length, mut line_force) = (0.0, 0.0);
        for (p, rho) in equilibrium.quadrature.front.iter().zip(equilibrium.slope_jump()) {
            let tension = membrane.tension.value(&p.x);
            let floor_slope = membrane.floor.as_ref().map_or(0.0, |h| h.jet(&p.x).gradient.dot(&p.normal));
            boundary_length += p.weight;
            line_force -= p.weight * tension * rho;
            if let Some(component) = components.get_mut(p.zone) {
                component.force -= p.weight * tension * (rho + floor_slope);
            }
        }
        let mut support_forces = vec![0.0; membrane.support_count];
        for p in &equilibrium.quadrature.rim {
            let flux = p.weight * equilibrium.support_flux(p);
            if let Some(support) = &membrane.supports[p.piece] {
                support_forces[support.index] += flux;
            }
            if let Some(component) = contact_index(p.region).and_then(|k| components.get_mut(k)) {
                component.force -= flux;
            }
        }
        for (k, component) in components.iter_mut().enumerate() {
            component.centroid /= component.area.max(f64::MIN_POSITIVE);
            component.holes = zone.holes_of(k);
        }
        let force: f64 = components.iter().map(|c| c.force).fold(0.0, |a, b| a + b);
        let supports: f64 = support_forces.iter().sum();
        // Without load the two parts of the contact force may cancel.
        let parts = force.abs().max(line_force.abs());
        let largest = parts.max(supports.abs()).max(load_force.abs()).max(f64::MIN_POSITIVE);
        let conditions = solution.conditions.as_ref();
        Some(Self {
            support_forces,
            load_force,
            energy,
            volume,
            max_slope,
            equilibrium_residual: (force + supports + load_force).abs() / largest,
            contact: ContactReport {
                force,
                area: components.iter().map(|c| c.area).fold(0.0, |a, b| a + b),
                holes: zone.counts().1,
                boundary_length,
                line_force,
                adhesion_energy,
                max_penetration: conditions.map_or(0.0, |c| (-c.least_gap).max(0.0)),
                min_gap_outside: conditions.map(|c| c.least_gap_outside).filter(|g| g.is_finite()),
                max_pressure: conditions.map_or(0.0, |c| c.largest_pressure.max(0.0)),
                min_pressure: conditions
                    .map_or(0.0, |c| if c.least_pressure.is_finite() { c.least_pressure } else { 0.0 }),
                components,
            },
        })
    }
}
