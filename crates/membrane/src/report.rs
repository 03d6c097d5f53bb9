//! What a solution amounts to: forces, areas, pressures, energy, and the balance that proves them.

use crate::conditions::Extremes;
use crate::solution::Solution;
use crate::zone::{Zone, contact_index, contact_of, is_free};
use signorini_geometry::Point;

/// One connected zone of contact.
#[derive(Clone, Debug)]
pub struct Component<const D: usize> {
    /// The body that it touches, or most of it.
    pub obstacle: usize,
    pub area: f64,
    /// Force of the body on the membrane within the zone, its front included.
    pub force: f64,
    pub centroid: Point<D>,
    pub holes: usize,
}

/// The figures of the contact with one body.
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

impl<const D: usize> ContactReport<D> {
    /// The contact that consists of given zones, with what is known of gaps and pressures.
    pub fn of(components: Vec<Component<D>>, boundary_length: f64, extremes: Option<&Extremes>) -> Self {
        let finite = |v: f64| if v.is_finite() { v } else { 0.0 };
        Self {
            force: components.iter().map(|c| c.force).fold(0.0, |a, b| a + b),
            area: components.iter().map(|c| c.area).fold(0.0, |a, b| a + b),
            holes: components.iter().map(|c| c.holes).sum(),
            boundary_length,
            line_force: 0.0,
            adhesion_energy: 0.0,
            max_penetration: extremes.map_or(0.0, |e| (-e.least_gap).max(0.0)),
            min_gap_outside: extremes.map(|e| e.least_gap_outside).filter(|g| g.is_finite()),
            max_pressure: extremes.map_or(0.0, |e| e.largest_pressure.max(0.0)),
            min_pressure: extremes.map_or(0.0, |e| finite(e.least_pressure)),
            components,
        }
    }
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
    /// With each body.
    pub contacts: Vec<ContactReport<D>>,
}

impl<const D: usize> Report<D> {
    /// Evaluates a solution; none if there is no state at all.
    pub fn new<Z: Zone<D>>(solution: &Solution<D, Z>) -> Option<Self> {
        let equilibrium = solution.equilibrium.as_ref()?;
        let membrane = &equilibrium.membrane;
        let zone = &solution.zone;
        let count = zone.counts().0;
        let mut components =
            vec![Component { obstacle: 0, area: 0.0, force: 0.0, centroid: Point::zeros(), holes: 0 }; count];
        let obstacles = &membrane.obstacles;
        // Of each zone the area before each body, and of each body the energy.
        let mut before = vec![vec![0.0; obstacles.0.len()]; count];
        let mut adhesion_energy = vec![0.0; obstacles.0.len()];
        let (mut load_force, mut load_size, mut energy, mut volume) = (0.0, 0.0, 0.0, 0.0);
        let mut max_slope = 0.0f64;
        equilibrium.for_each_point(|cell, region, x, w| {
            let f = membrane.load.value(x);
            load_force += w * f;
            load_size += w * f.abs();
            let (u, gradient) = if is_free(region) {
                let Some(state) = equilibrium.evaluate(cell, region, x) else { return };
                state
            } else if let Some((side, k)) = contact_of(region)
                && let Some(touched) = obstacles.index_at(side, x)
            {
                if let Some(component) = components.get_mut(k) {
                    component.area += w;
                    component.force -= w * f;
                    component.centroid += w * x;
                    before[k][touched] += w;
                }
                let obstacle = &obstacles.0[touched];
                adhesion_energy[touched] += obstacle.adhesion.as_ref().map_or(0.0, |energy| w * energy.value(x));
                let h = obstacle.height.jet(x);
                (h.value, h.gradient)
            } else {
                return;
            };
            volume += w * u;
            max_slope = max_slope.max(gradient.norm());
            energy += w * (0.5 * membrane.tension.value(x) * gradient.norm_squared() - f * u);
        });
        for ((k, component), before) in components.iter_mut().enumerate().zip(&before) {
            component.obstacle = (0..before.len()).max_by(|&a, &b| before[a].total_cmp(&before[b])).unwrap_or(0);
            component.centroid /= component.area.max(f64::MIN_POSITIVE);
            component.holes = zone.holes_of(k);
        }
        let mut fronts = vec![(0.0, 0.0); obstacles.0.len()];
        for (p, rho) in equilibrium.quadrature.front.iter().zip(equilibrium.slope_jump()) {
            let tension = membrane.tension.value(&p.x);
            let slope = obstacles.jet(p.side, &p.x).gradient.dot(&p.normal);
            let opening = p.side.sign() * rho;
            if let Some(component) = components.get_mut(p.zone) {
                component.force -= p.weight * tension * (opening + slope);
                let (length, line_force) = &mut fronts[component.obstacle];
                *length += p.weight;
                *line_force -= p.weight * tension * opening;
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
        let force: f64 = components.iter().map(|c| c.force).fold(0.0, |a, b| a + b);
        let supports: f64 = support_forces.iter().sum();
        // Without load the two parts of the contact force may cancel.
        let line_force: f64 = fronts.iter().map(|f| f.1.abs()).sum();
        let parts = components.iter().fold(line_force, |most, c| most.max(c.force.abs()));
        let largest = parts.max(supports.abs()).max(load_size).max(f64::MIN_POSITIVE);
        let conditions = solution.conditions.as_ref();
        Some(Self {
            support_forces,
            load_force,
            energy,
            volume,
            max_slope,
            equilibrium_residual: (force + supports + load_force).abs() / largest,
            contacts: (0..obstacles.0.len())
                .map(|i| {
                    let own = components.iter().filter(|c| c.obstacle == i).cloned().collect();
                    let (length, line_force) = fronts[i];
                    let report = ContactReport::of(own, length, conditions.and_then(|c| c.extremes.get(i)));
                    ContactReport { line_force, adhesion_energy: adhesion_energy[i], ..report }
                })
                .collect(),
        })
    }

    /// Area of all contacts.
    pub fn area(&self) -> f64 {
        self.contacts.iter().map(|c| c.area).fold(0.0, |a, b| a + b)
    }

    /// Force of all contacts on the membrane, along z.
    pub fn force(&self) -> f64 {
        self.contacts.iter().map(|c| c.force).fold(0.0, |a, b| a + b)
    }

    /// Energy with what adhesion gives back.
    pub fn energy_total(&self) -> f64 {
        self.energy - self.contacts.iter().map(|c| c.adhesion_energy).sum::<f64>()
    }
}
