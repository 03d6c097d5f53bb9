//! Paths of equilibria on which not the time is given but a measure of how far one has come: the area of contact, or the
//! arc length in area and time. They pass the folds at which a path in time ends.

use crate::equilibrium::Equilibrium;
use crate::equilibrium::elements::Elements;
use crate::front::Fronts;
use crate::problem::Membrane;
use crate::refinement::Refinement;
use crate::scales::Scales;
use crate::stopping::SHARPEST;
use crate::zone::{Zone, contact_index};
use signorini_solve::{Progress, SolveError, dense};

/// Corrections of a state before it is given up ...
const MOST_CORRECTIONS: usize = 25;
/// ... on so many cells.
const MOST_CELLS: usize = 3;
/// What a constraint may lack, relative to its scales; and what it may where a correction does not lessen that.
const EXACT: f64 = 1e-10;
const MET: f64 = 1e-6;
/// The time moves at most by this fraction of its range in one correction.
const TIME_REACH: f64 = 0.25;
/// A front moves at most this fraction of the membrane's extent in one correction.
const REACH: f64 = 0.1;

/// A state on a path.
#[derive(Clone)]
pub struct PathState<const D: usize, Z> {
    pub zone: Z,
    /// The membrane on the cells that the state was found on.
    pub cells: Membrane<D>,
    pub time: f64,
    pub area: f64,
    /// Direction of the path in area and time, of unit length in their scales.
    pub tangent: [f64; 2],
    /// The front condition there, from which the path goes on.
    linear: Linear,
}

/// What a step along a path prescribes: `weights · (area, time) = value`.
#[derive(Clone, Copy, Debug)]
pub struct Constraint {
    pub weights: [f64; 2],
    pub value: f64,
}

/// A membrane whose data depend on time, where its cells are divided, and the scales of its path.
pub struct Path<'a, const D: usize> {
    pub membrane: &'a dyn Fn(f64) -> Membrane<D>,
    pub refinement: &'a Refinement<D>,
    pub scales: Scales,
    /// Scales of area and time.
    pub size: [f64; 2],
}

/// The front condition at a state, linearised in fronts and time.
#[derive(Clone, Debug)]
struct Linear {
    n: usize,
    residual: Vec<f64>,
    matrix: Vec<f64>,
    by_time: Vec<f64>,
    growth: Vec<f64>,
    area: f64,
    /// Size of the residual relative to its tolerance.
    error: f64,
    solves: usize,
}

impl<const D: usize> Path<'_, D> {
    /// A step of length `ds` along the path.
    pub fn constraint<Z>(&self, from: &PathState<D, Z>, ds: f64) -> Constraint {
        let weights = [0, 1].map(|k| from.tangent[k] / self.size[k]);
        Constraint { weights, value: weights[0] * from.area + weights[1] * from.time + ds }
    }

    /// The state that satisfies the front condition and the constraint, from one near it, and the equilibrium solves it
    /// took; none where the iteration does not end, or the zone vanishes. `forward` tells the sense of the tangent.
    pub fn correct<Z: Zone<D>>(
        &self,
        zone: Z,
        mut time: f64,
        constraint: Constraint,
        forward: [f64; 2],
        progress: &dyn Progress,
    ) -> Result<(Option<PathState<D, Z>>, usize), SolveError> {
        let (mut solves, mut divided) = (0, 1);
        let (mut cells, mut zone) = self.divided(zone, time);
        let mut before = f64::INFINITY;
        for _ in 0..MOST_CORRECTIONS {
            // A front that has no shape any more leads nowhere, and costs as much as all others.
            if zone.is_empty() || zone.bend() > SHARPEST || progress.interrupted() {
                break;
            }
            let linear = self.linearise(&zone, time, &cells)?;
            solves += linear.solves;
            let [a, t] = constraint.weights;
            let lacking = constraint.value - a * linear.area - t * time;
            let scale = a.abs() * self.size[0] + t.abs() * self.size[1];
            // Cells tell an area only so far: then what it lacks does not get less.
            let met = lacking.abs() <= EXACT * scale || (lacking.abs() <= MET * scale && lacking.abs() > 0.5 * before);
            before = lacking.abs();
            if linear.error <= 0.5 && met {
                if divided == MOST_CELLS || self.refinement.resolves(&(self.membrane)(time), &cells, &zone) {
                    let tangent = linear.tangent(forward, self.size);
                    return Ok((Some(PathState { zone, cells, time, area: linear.area, tangent, linear }), solves));
                }
                divided += 1;
                (cells, zone) = self.divided(zone, time);
                continue;
            }
            let Some((mut step, tau)) = linear.solve(constraint.weights, lacking) else { break };
            let part = (TIME_REACH * self.size[1].abs() / tau.abs()).min(1.0);
            step.iter_mut().for_each(|w| *w *= part);
            time += part * tau;
            zone = zone.advanced(&cells.grid, cells.modes.finest(), &step, REACH * self.scales.length).zone;
        }
        Ok((None, solves))
    }

    /// The state that is at rest at a time, with the direction in which the path goes on as the time grows by `sense`.
    pub fn begin<Z: Zone<D>>(&self, zone: Z, time: f64, sense: f64) -> Result<PathState<D, Z>, SolveError> {
        let (cells, zone) = self.divided(zone, time);
        let linear = self.linearise(&zone, time, &cells)?;
        let tangent = linear.tangent([0.0, sense], self.size);
        Ok(PathState { zone, cells, time, area: linear.area, tangent, linear })
    }

    /// The membrane at a time on cells divided about a zone, and the zone with modes as these can tell them apart.
    fn divided<Z: Zone<D>>(&self, zone: Z, time: f64) -> (Membrane<D>, Z) {
        let cells = self.refinement.about(&(self.membrane)(time), &zone);
        let zone = zone.on_cells(&cells);
        (cells, zone)
    }

    /// A zone and a time that satisfy a constraint, ahead of a state: the start of the next correction.
    pub fn predict<Z: Zone<D>>(&self, from: &PathState<D, Z>, constraint: &Constraint) -> (Z, f64) {
        let Some((step, tau)) = from.linear.direction(constraint.weights) else {
            return (from.zone.clone(), from.time);
        };
        let ds = constraint.value - constraint.weights[0] * from.area - constraint.weights[1] * from.time;
        let step: Vec<f64> = step.iter().map(|w| w * ds).collect();
        let Membrane { grid, modes, .. } = &from.cells;
        let zone = from.zone.advanced(grid, modes.finest(), &step, REACH * self.scales.length).zone;
        (zone, from.time + tau * ds)
    }

    fn linearise<Z: Zone<D>>(&self, zone: &Z, time: f64, cells: &Membrane<D>) -> Result<Linear, SolveError> {
        let membrane = (self.membrane)(time).on_cells_of(cells);
        let scales = self.scales.on(cells);
        let equilibrium = Equilibrium::solve(&membrane, zone, &mut Elements::new(&membrane))?;
        let fronts = Fronts::new(&equilibrium, true);
        let linearised = fronts.linearise(zone, membrane.modes.finest(), &scales)?;
        let error = fronts.residual(zone, membrane.modes.finest()) / scales.slope_tolerance();
        // The same zone a little later: its quadrature is the same.
        let dt = 1e-5 * self.size[1];
        let later = (self.membrane)(time + dt).on_cells_of(cells);
        let state = Equilibrium::solve(&later, zone, &mut Elements::new(&later))?;
        let after = Fronts::new(&state, true).excess();
        let rate: Vec<f64> = fronts.excess().iter().zip(&after).map(|(a, b)| (b - a) / dt).collect();
        let mut area = 0.0;
        equilibrium.for_each_point(|_, region, _, w| {
            if contact_index(region).is_some() {
                area += w;
            }
        });
        let by_time = fronts.moments(zone, &rate);
        Ok(Linear {
            n: by_time.len(),
            residual: linearised.residual,
            matrix: linearised.rate,
            by_time,
            growth: linearised.growth,
            area,
            error,
            solves: 2,
        })
    }
}

impl Linear {
    /// Solves the front condition together with `weights · (area, time) = lacking`.
    fn solve(&self, weights: [f64; 2], lacking: f64) -> Option<(Vec<f64>, f64)> {
        let right: Vec<f64> = self.residual.iter().map(|r| -r).chain([lacking]).collect();
        self.bordered(weights, &right)
    }

    /// The motion of fronts and time along the path that meets `weights · (area, time) = 1`.
    fn direction(&self, weights: [f64; 2]) -> Option<(Vec<f64>, f64)> {
        let right: Vec<f64> = std::iter::repeat_n(0.0, self.n).chain([1.0]).collect();
        self.bordered(weights, &right)
    }

    fn bordered(&self, weights: [f64; 2], right: &[f64]) -> Option<(Vec<f64>, f64)> {
        let n = self.n;
        let mut matrix = Vec::with_capacity((n + 1) * (n + 1));
        for row in 0..n {
            matrix.extend(&self.matrix[row * n..(row + 1) * n]);
            matrix.push(self.by_time[row]);
        }
        matrix.extend(self.growth.iter().map(|g| weights[0] * g));
        matrix.push(weights[1]);
        let mut x = dense::solve(&matrix, right)?;
        let time = x.pop()?;
        Some((x, time))
    }

    /// The direction of the path in area and time, of unit length in their sizes, in the sense of `forward`.
    fn tangent(&self, forward: [f64; 2], size: [f64; 2]) -> [f64; 2] {
        // Either measure may be stationary; their sum with any weights hardly is.
        let weights = [0, 1].map(|k| (if forward[k] == 0.0 { 0.1 } else { forward[k] }) / size[k]);
        let Some((step, time)) = self.direction(weights) else { return forward };
        let area: f64 = step.iter().zip(&self.growth).map(|(w, g)| w * g).sum();
        let scaled = [area / size[0], time / size[1]];
        let length = scaled[0].hypot(scaled[1]);
        let sense = if scaled[0] * forward[0] + scaled[1] * forward[1] < 0.0 { -1.0 } else { 1.0 };
        scaled.map(|v| sense * v / length)
    }
}
