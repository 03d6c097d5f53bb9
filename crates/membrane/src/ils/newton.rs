//! Newton's iteration on the shape of a zone.

use super::{Fixed, Run};
use crate::adhesion::{Branch, Linearised};
use crate::conditions::pushes;
use crate::equilibrium::Equilibrium;
use crate::front::{Fronts, Step, StepKind};
use crate::published::schedule::ModeSchedule;
use crate::scales::Scales;
use crate::stopping::{Decision, IterationHistory, Observation, SHARP};
use crate::zone::{Advance, Zone, contact_index};
use signorini_geometry::Point;
use signorini_solve::{Acceleration, SolveError};

/// Fronts that have torn or met so often have gone astray.
const MOST_CHANGES: usize = 10;
/// Steps down the energy before a jump is given up.
const MOST_DESCENTS: usize = 200;
/// An eigenvalue of the second variation below this fraction of the pressure's share is negative.
const UNSTABLE: f64 = -1e-6;
/// A zone of less than this part of a cell has no shape.
const SMALL: f64 = 0.7;
/// Holes of fewer cells are nowhere far from their outlines.
const FEW: f64 = 16.0;
/// Steps shorter than so many cells are made with the derivative of the discrete equations ...
const CLOSE: f64 = 0.3;
/// ... or, with adhesion, than so many: near the loss of a state the derivative in the continuum lacks much of it ...
const CLOSE_STICKY: f64 = 1.0;
/// ... on fronts that curve by less than this within a cell ...
const BLUNT: f64 = 1.0;
/// ... unless they get longer by this factor.
const LONGER: f64 = 2.0;
/// Adhesive steps shorter than this fraction of a cell are extrapolated.
const NEAR: f64 = 0.1;
/// A front moves at most this fraction of the membrane's extent in one step.
const REACH: f64 = 0.15;
/// A step may make a front so much sharper than a cell, or sharper by so much than it was: where the pressure that steers it
/// is weak, what cells make of the slope jump would bend it.
const WILD: f64 = 3.0;
const SHARPENED: f64 = 2.0;
/// So often its short waves are left out, each time those of twice the length.
const MOST_SMOOTHINGS: u32 = 4;

impl<const D: usize, Z: Zone<D>> Run<'_, '_, D, Z> {
    /// Newton's iteration on the shape of the zone.
    pub(super) fn solve_front_equation(&mut self) -> Result<Fixed, SolveError> {
        let finest = self.membrane.modes.finest();
        let mut acceleration = Acceleration::default();
        let mut schedule = ModeSchedule::default();
        let mut course = IterationHistory::default();
        self.solution.settled_within = None;
        self.solution.unfinished = false;
        self.solution.lowest_eigenvalue = None;
        let (mut count, mut descents, mut changes) = (0, 0, 0);
        let transport = self.membrane.formulation.transport();
        let shifted = self.is_shifted();
        let most_steps = self.rest.most_steps();
        while count < most_steps && changes < MOST_CHANGES && descents < MOST_DESCENTS {
            count += 1;
            if self.progress.interrupted() {
                return Ok(Fixed::Interrupted);
            }
            let zone = &self.solution.zone;
            let equilibrium = match self.known.take() {
                Some(known) => known,
                None => {
                    self.solution.iterations += 1;
                    Equilibrium::solve(self.membrane, zone, self.elements)?
                }
            };
            self.solution.unknowns = self.solution.unknowns.max(equilibrium.size());
            if self.solution.scales.is_none() {
                self.solution.scales = Some(Scales::of_free(&equilibrium));
            }
            let Some(scales) = self.solution.scales else { return Ok(Fixed::Moving) };
            if zone.is_empty() {
                self.report(0.0, "free membrane");
                self.solution.equilibrium = Some(equilibrium);
                return Ok(Fixed::AtRest);
            }
            let area = areas(&equilibrium, zone.counts().0);
            // Fronts that have left the membrane, or closed.
            let beyond = area.iter().position(|a| *a == 0.0);
            let fewer = beyond.map(|part| (zone.without(&self.membrane.grid, part), "zone left the membrane"));
            let fewer = fewer.or_else(|| Some((self.without_pressed_holes(zone)?, "hole closed")));
            if let Some((zone, what)) = fewer {
                self.report(0.0, what);
                course = IterationHistory::default();
                acceleration = Acceleration::default();
                self.solution.equilibrium = Some(equilibrium);
                self.solution.zone = zone;
                continue;
            }
            let h = self.membrane.grid.h();
            let fronts = Fronts::new(&equilibrium, self.adhering);
            if let (true, Branch::Stable) = (self.adhering, self.branch)
                && let Some(part) = lost(&equilibrium, &fronts, &area)
            {
                let zone = zone.without(&self.membrane.grid, part);
                self.report(0.0, "zone lost");
                (count, descents, course) = (0, descents + 1, IterationHistory::default());
                self.solution.jumped = true;
                self.solution.equilibrium = Some(equilibrium);
                self.solution.zone = zone;
                continue;
            }
            let residual = fronts.residual(zone, finest) / scales.slope_tolerance();
            let linearised = if self.adhering { Some(fronts.linearise(zone, finest, &scales)?) } else { None };
            let mut step = match &linearised {
                Some(linearised) => linearised.step(self.branch, &scales),
                None => match equilibrium.saddle() {
                    Some(saddle) => schedule.step(&fronts, saddle, zone, &scales)?,
                    None => fronts.newton_step(zone, &scales)?,
                },
            };
            course.take(residual, area.iter().sum::<f64>() / scales.length.powi(D as i32), step.kind, shifted);
            let bend = if D > 1 { zone.bend() } else { 0.0 };
            let sight = Observation {
                residual,
                step: step.length,
                kind: step.kind,
                bend,
                tips: bend >= SHARP && self.has_tips(zone, SHARP),
                divided: self.membrane.sizing.is_some(),
                shifted,
                adhering: self.adhering,
                kinks: scales.degree == 1,
                last: count == most_steps,
                unseen: &|share| {
                    let projection = fronts.project(zone, finest);
                    projection.norm < share * projection.remainder
                },
                farthest: &|| fronts.farthest(zone, &scales, |_| h),
            };
            let verdict = self.rest.judge(&course, &sight);
            if verdict != Decision::Moving {
                if let Some(linearised) = &linearised {
                    let spectrum = linearised.spectrum();
                    let lowest = spectrum.as_ref().and_then(|s| s.values.first().copied());
                    if let (Some(spectrum), Some(lowest), Branch::Stable) = (&spectrum, lowest, self.branch)
                        && lowest < UNSTABLE * linearised.scale
                        && descents < MOST_DESCENTS
                    {
                        let perturbation = linearised.perturbation(spectrum, h);
                        let advance = zone.advanced(&self.membrane.grid, finest, &perturbation, h);
                        self.report(residual, "at rest, but unstable");
                        (count, descents, course) = (0, descents + 10, IterationHistory::default());
                        self.solution.jumped = true;
                        self.solution.equilibrium = Some(equilibrium);
                        self.solution.zone = advance.zone;
                        continue;
                    }
                    self.solution.lowest_eigenvalue = lowest;
                }
                let settled = verdict != Decision::AtRest;
                self.report(residual, if settled { "settled" } else { "at rest" });
                self.solution.settled_within = settled.then_some(step.length);
                self.solution.unfinished = matches!(verdict, Decision::Left { .. });
                self.solution.near_enough = verdict == Decision::Left { settled: true };
                self.solution.equilibrium = Some(equilibrium);
                return Ok(Fixed::AtRest);
            }
            if step.kind == StepKind::Descent {
                (count, descents, course) = (0, descents + 1, IterationHistory::default());
                self.solution.jumped = true;
            }
            // Short of adhesion fronts rest without a slope: the pressure of the floor is nearly all of the derivative in the
            // continuum. Near the solution the rest of it, which cells add, makes the convergence quadratic.
            let close = if self.adhering { CLOSE_STICKY } else { CLOSE };
            let near = step.length < close && course.is_smooth() && bend < BLUNT && step.kind != StepKind::Descent;
            let derivative = linearised.as_ref().filter(|_| near).map(Linearised::factor);
            // A derivative that is singular leads nowhere.
            let solvable = !matches!(derivative, Some(None));
            let exact = match D > 1 && near && !shifted && equilibrium.responds() && solvable {
                true => fronts.discrete_step(zone, self.elements, &scales, derivative.flatten().as_ref())?,
                false => None,
            };
            step = exact.filter(|exact| exact.length < LONGER * step.length).unwrap_or(step);
            course.make(step.kind);
            // Far from the solution the steps are no linear iteration that could be extrapolated.
            if let Some(factor) = course.damping().filter(|_| !shifted) {
                acceleration = Acceleration::default();
                step.coefficients.iter_mut().for_each(|c| *c *= factor);
            } else if step.space == finest
                && (step.kind == StepKind::Local || (step.kind == StepKind::Adhesive && step.length < NEAR))
            {
                step.coefficients = acceleration.next(step.coefficients);
            } else {
                acceleration = Acceleration::default();
            }
            let reach = step.reach.min(REACH * scales.length);
            let advanced =
                |step: &Step| zone.transported(&self.membrane.grid, step.space, &step.coefficients, reach, transport);
            let mut advance = advanced(&step);
            if D > 1 && !self.adhering && !shifted {
                let sharpest = f64::max(WILD, SHARPENED * bend);
                // A short step that leaves as many zones and holes folds a tip.
                let folds = |zone: &Z| step.length < CLOSE && zone.counts() == self.solution.zone.counts();
                let shapeless = |advance: &Advance<Z>| match advance.topology_changed {
                    true => folds(&advance.zone),
                    false => advance.zone.bend() > sharpest,
                };
                for doublings in 0..MOST_SMOOTHINGS {
                    if !shapeless(&advance) {
                        break;
                    }
                    step.coefficients = fronts.smoothed(zone, &step, scales.h * f64::from(1u32 << doublings));
                    acceleration = Acceleration::default();
                    advance = advanced(&step);
                }
            }
            if advance.topology_changed || advance.zone.mode_offsets(finest) != zone.mode_offsets(finest) {
                acceleration = Acceleration::default();
            }
            if advance.topology_changed {
                // Another problem: what the residuals were before says nothing of it.
                changes += 1;
                course = IterationHistory::default();
            }
            let action = if advance.topology_changed { "topology changed" } else { step.kind.name() };
            let zone = if advance.topology_changed { self.resized(advance.zone) } else { advance.zone };
            self.report(residual, action);
            self.solution.equilibrium = Some(equilibrium);
            self.solution.zone = zone;
        }
        Ok(Fixed::Moving)
    }

    /// The zone without holes of a few cells in which a body pushes everywhere: there the membrane would lie below it, and
    /// Newton's method only halves such a hole in every step. None where there are no such holes.
    fn without_pressed_holes(&self, zone: &Z) -> Option<Z> {
        let membrane = self.membrane;
        if self.adhering || self.is_shifted() {
            return None;
        }
        zone.filled(&membrane.grid, &|side, outline, area| {
            let centre = outline.iter().sum::<Point<D>>() / outline.len() as f64;
            let size = membrane.cells.containing(&centre).map_or(0.0, |cell| membrane.cells.size(cell));
            let few = area < FEW * size.powi(D as i32);
            few && std::iter::once(&centre).chain(outline).all(|x| pushes(membrane, zone, side, x, size))
        })
    }
}

/// The area of each zone as it is drawn, whatever it weighs.
fn areas<const D: usize>(equilibrium: &Equilibrium<D>, zones: usize) -> Vec<f64> {
    let mut area = vec![0.0; zones];
    equilibrium.for_each_point(|_, region, x, w| {
        if let Some(a) = contact_index(region).and_then(|k| area.get_mut(k)) {
            *a += w / equilibrium.membrane.measure.weight(x);
        }
    });
    area
}

/// A zone smaller than a cell that shrinks: there is nothing that would stop it.
fn lost<const D: usize>(equilibrium: &Equilibrium<D>, fronts: &Fronts<'_, D>, area: &[f64]) -> Option<usize> {
    let cell = equilibrium.membrane.grid.h().powi(D as i32);
    let drive = fronts.drive_of_zones(area.len());
    (0..area.len()).find(|&k| area[k] < SMALL * cell && drive[k] > 0.0)
}
