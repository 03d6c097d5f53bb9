//! The radius of contact that a membrane has at each measurement, as a function of adhesion and tension.

use super::Measurements;
use crate::plan::MembranePlan;
use crate::problem::{CaseError, Problem};
use crate::problem::{Fit, Space};
use rayon::prelude::*;
use signorini_geometry::Point;
use signorini_membrane::equilibrium::Elements;
use signorini_membrane::field::Constant;
use signorini_membrane::kernel::equilibrium_on_line;
use signorini_membrane::line_zone::LineZone;
use signorini_membrane::obstacle::{Obstacle, Obstacles, Side};
use signorini_membrane::problem::{Membrane, Support};
use signorini_solve::SolveError;
use std::sync::Arc;

/// Radii at which the slope is computed.
const RADII: usize = 160;
/// Points of the interpolation between them.
const POINTS: usize = 6;

/// What was measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    Radius,
    Area,
}

/// The slopes of all measurements at all radii.
pub struct Model {
    quantity: Quantity,
    space: Space,
    radii: Vec<f64>,
    tension: Vec<f64>,
    /// For each measurement and radius the slope due to the floor, and that due to the load.
    slopes: Vec<Vec<[f64; 2]>>,
}

/// A predicted radius and its derivatives with respect to the logarithms of adhesion and tension.
#[derive(Clone, Copy, Debug)]
pub struct Prediction {
    pub value: f64,
    pub rates: [f64; 2],
    /// Whether there is a state at all; if not the value is that of the last one.
    pub exists: bool,
}

impl Model {
    /// Computes the slopes at the given times.
    ///
    /// # Errors
    /// Where the membrane is not held.
    pub fn new(plan: &MembranePlan<1>, quantity: Quantity, times: &[f64]) -> Result<Self, SolveError> {
        let bounds = plan.grid.bounds();
        let side = plan.contacts.first().map_or(Side::Below, |c| c.side);
        let line = plan.space == Space::Line;
        let reach = if line { 0.5 * bounds.size()[0] } else { bounds.max[0] };
        let radii: Vec<f64> = (1..=RADII).map(|k| reach * k as f64 / (RADII + 1) as f64).collect();
        let zone = |c: f64| {
            let interval =
                if line { [bounds.center()[0] - c, bounds.center()[0] + c] } else { [bounds.min[0] - reach, c] };
            LineZone::new(&plan.grid, vec![(side, interval)])
        };
        let slope = |membrane: &Membrane<1>, c: f64| -> Result<f64, SolveError> {
            let slopes = equilibrium_on_line(membrane, &zone(c), &mut Elements::new(membrane))?.slope_jump();
            Ok(slopes.iter().sum::<f64>() / slopes.len().max(1) as f64)
        };
        let nothing = || Arc::new(Constant(0.0));
        let slopes = times
            .par_iter()
            .map(|&time| {
                let whole = plan.at(time);
                let held =
                    |s: &Option<Support<1>>| s.as_ref().map(|s| Support { displacement: nothing(), ..s.clone() });
                let by_floor = Membrane { load: nothing(), ..whole.clone() };
                let flat = Obstacle { side, height: nothing(), adhesion: None };
                let by_load = Membrane {
                    obstacles: Obstacles(vec![flat]),
                    supports: whole.supports.iter().map(held).collect(),
                    ..whole.clone()
                };
                radii.iter().map(|&c| Ok([slope(&by_floor, c)?, slope(&by_load, c)?])).collect()
            })
            .collect::<Result<_, SolveError>>()?;
        let membrane = plan.at(times.first().copied().unwrap_or(0.0));
        let middle = if line { bounds.center()[0] } else { 0.0 };
        let tension = radii.iter().map(|c| membrane.tension.value(&Point::<1>::new(middle + c))).collect();
        Ok(Self { quantity, space: plan.space, radii, tension, slopes })
    }

    /// Refuses measurements that no zone of the membrane has.
    pub(super) fn check(&self, problem: &Problem, key: &Fit, measured: &Measurements) -> Result<(), CaseError> {
        let largest = self.measure(self.radii[self.radii.len() - 1]);
        match measured.value.iter().find(|v| !(**v > 0.0 && **v < largest)) {
            None => Ok(()),
            Some(v) => Err(problem
                .error(
                    &key.data,
                    format!("`{}` is {v}: it must be between 0 and {largest:.6} for this membrane", measured.names[1]),
                )
                .help("numbers are in the base units of the case; remove rows without contact")),
        }
    }

    fn measure(&self, c: f64) -> f64 {
        match (self.quantity, self.space) {
            (Quantity::Radius, _) => c,
            (Quantity::Area, Space::Line) => 2.0 * c,
            (Quantity::Area, _) => std::f64::consts::PI * c * c,
        }
    }

    fn radius(&self, measured: f64) -> f64 {
        match (self.quantity, self.space) {
            (Quantity::Radius, _) => measured,
            (Quantity::Area, Space::Line) => 0.5 * measured,
            (Quantity::Area, _) => (measured / std::f64::consts::PI).sqrt(),
        }
    }

    /// Number of measurements.
    pub fn len(&self) -> usize {
        self.slopes.len()
    }

    pub fn is_empty(&self) -> bool {
        self.slopes.is_empty()
    }

    /// Weights and derivatives of weights of the radii next to `c`, and the first of them.
    fn interpolation(&self, c: f64) -> (usize, [[f64; 2]; POINTS]) {
        let spacing = self.radii[1] - self.radii[0];
        let at = (c - self.radii[0]) / spacing;
        let first =
            (at.floor() as isize - POINTS as isize / 2 + 1).clamp(0, (self.radii.len() - POINTS) as isize) as usize;
        let s = at - first as f64;
        let weights = std::array::from_fn(|i| {
            let others = || (0..POINTS).filter(move |&j| j != i);
            let factor = |j: usize| (s - j as f64) / (i as f64 - j as f64);
            let value = others().map(factor).product();
            let slope: f64 = others()
                .map(|k| others().filter(|&j| j != k).map(factor).product::<f64>() / (i as f64 - k as f64))
                .sum();
            [value, slope / spacing]
        });
        (first, weights)
    }

    /// `ρ - ρ_a` at a node.
    fn lacking(&self, row: usize, node: usize, adhesion: f64, tension: f64) -> f64 {
        let [floor, load] = self.slopes[row][node];
        floor + load / tension - (2.0 * adhesion / (tension * self.tension[node])).sqrt()
    }

    /// `ρ - ρ_a` at a radius, and its derivatives with respect to the radius and to the logarithms of adhesion and tension.
    fn condition(&self, row: usize, c: f64, adhesion: f64, tension: f64) -> [f64; 4] {
        let (first, weights) = self.interpolation(c);
        let mut out = [0.0; 4];
        for (k, [w, dw]) in weights.iter().enumerate() {
            let node = first + k;
            let held = (2.0 * adhesion / (tension * self.tension[node])).sqrt();
            let value = self.lacking(row, node, adhesion, tension);
            out[0] += w * value;
            out[1] += dw * value;
            out[2] -= w * 0.5 * held;
            out[3] += w * (0.5 * held - self.slopes[row][node][1] / tension);
        }
        out
    }

    /// The energy of adhesion that would explain one measurement, for the tension stated: `T ρ² / 2`.
    pub fn explained_by(&self, row: usize, measured: f64) -> f64 {
        let c = self.radius(measured);
        let rho = self.condition(row, c, 0.0, 1.0)[0].max(0.0);
        let (first, weights) = self.interpolation(c);
        let tension: f64 = weights.iter().enumerate().map(|(k, [w, _])| w * self.tension[first + k]).sum();
        0.5 * tension * rho * rho
    }

    /// What would be measured: of the stable states the one nearest to what was.
    pub fn predict(&self, row: usize, near: f64, adhesion: f64, tension: f64) -> Prediction {
        let near = self.radius(near);
        let value = |node: usize| self.lacking(row, node, adhesion, tension);
        let stable = (0..self.radii.len() - 1).filter(|&k| value(k) < 0.0 && value(k + 1) >= 0.0);
        let interval = stable.min_by(|&i, &j| (self.radii[i] - near).abs().total_cmp(&(self.radii[j] - near).abs()));
        let c = match interval {
            Some(k) => {
                let (mut low, mut high) = (self.radii[k], self.radii[k + 1]);
                for _ in 0..50 {
                    let middle = 0.5 * (low + high);
                    if self.condition(row, middle, adhesion, tension)[0] < 0.0 { low = middle } else { high = middle }
                }
                0.5 * (low + high)
            }
            None => {
                let least = (0..self.radii.len()).min_by(|&i, &j| value(i).abs().total_cmp(&value(j).abs()));
                self.radii[least.unwrap_or(0)]
            }
        };
        let [_, by_radius, by_adhesion, by_tension] = self.condition(row, c, adhesion, tension);
        let measure = match (self.quantity, self.space) {
            (Quantity::Radius, _) => 1.0,
            (Quantity::Area, Space::Line) => 2.0,
            (Quantity::Area, _) => std::f64::consts::TAU * c,
        };
        // Beyond the last state the radius would change without bound; its direction is what counts.
        let stiffness = by_radius.max(1e-3 * by_radius.abs()).max(f64::MIN_POSITIVE);
        let rates = [by_adhesion, by_tension].map(|v| -measure * v / stiffness);
        Prediction { value: self.measure(c), rates, exists: interval.is_some() }
    }
}
