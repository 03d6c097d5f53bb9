//! How the slope jump of a discrete equilibrium changes as its fronts move.
//!
//! In the continuum a front at rest has `ρ° = (p/T) w`. What cells make of the slope jump goes up and down by `h^p` from one
//! to the next, so its derivative is off by `h^{p-1}` of that, and steps with `p/T` alone gain no more than such a factor
//! each. Here is the derivative of the discrete equations themselves. The modes move the points of a front along its
//! normals; an integral over the front then changes at the rate
//!
//! ```text
//! ∫ (∂_n F w + ∂F/∂n · n° + κ F w)  +  Σ [F] w ds/dw,      n° = -∇_Γ w
//! ```
//!
//! where the sum runs over the sides of cells that the front crosses: `F` jumps there, and as the front moves by `w` the
//! crossing slides along it by `(ds/dw) w`. An integral over the free membrane loses `∫ F w` on the front. The rate of the
//! displacement follows from that of the equations by one solve with the factorisation at hand.

use crate::equilibrium::Equilibrium;
use crate::equilibrium::elements::{Elements, penalty};
use crate::equilibrium::ghost::{GhostPair, ghost_pairs, ghost_weight};
use crate::method::ModeSpace;
use crate::quadrature::FrontPoint;
use crate::zone::{FrontFoot, Zone};
use signorini_fem::cut::RegionId;
use signorini_fem::lagrange::Tabulation;
use signorini_geometry::{Point, Vector};
use signorini_solve::SolveError;
use std::collections::HashMap;

/// Step of the differences that take a derivative of polynomials, relative to their cell.
const DIFFERENCE: f64 = 1e-4;
/// Halvings that lead to where a front crosses a side, and how far aside of it, relative to the nearest point, it is asked
/// where another front would.
const HALVINGS: usize = 45;
const ASIDE: f64 = 0.05;
/// Points of one front further apart than so many cells have nothing between them.
const APART: f64 = 1.5;

/// The polynomials of a cell at a point of a front, and what the equations make of the displacement there.
struct Trace<const D: usize> {
    cell: usize,
    region: RegionId,
    dofs: Vec<u32>,
    value: Vec<f64>,
    gradient: Vec<Vector<D>>,
    /// Second derivatives along the normal.
    bend: Vec<f64>,
    sign: f64,
    tension: f64,
    tension_slope: f64,
    penalty: f64,
    load: f64,
    /// `u - h` with its gradient and second derivative along the normal.
    lack: f64,
    lack_slope: Vector<D>,
    lack_bend: f64,
    /// The gradient and the second derivative of `u`.
    slope: Vector<D>,
    u_bend: f64,
    normal: Vector<D>,
}

impl<const D: usize> Trace<D> {
    fn new(equilibrium: &Equilibrium<D>, p: &FrontPoint<D>, x: &Point<D>, normal: Vector<D>) -> Option<Self> {
        let membrane = &equilibrium.membrane;
        let cells = &*membrane.cells;
        let dofs = equilibrium.unknowns().of(p.cell, p.free)?.to_vec();
        let mut t = Tabulation::default();
        let step = DIFFERENCE * cells.size(p.cell);
        let mut slopes = |x: Point<D>| -> Vec<f64> {
            cells.tabulate(p.cell, &x, &mut t);
            t.gradient.iter().map(|g| g.dot(&normal)).collect()
        };
        let (ahead, behind) = (slopes(x + step * normal), slopes(x - step * normal));
        let bend: Vec<f64> = ahead.iter().zip(&behind).map(|(a, b)| (a - b) / (2.0 * step)).collect();
        cells.tabulate(p.cell, x, &mut t);
        let (mut u, mut slope, mut u_bend) = (0.0, Vector::zeros(), 0.0);
        for (a, &i) in dofs.iter().enumerate() {
            let c = equilibrium.values()[i as usize];
            u += c * t.value[a];
            slope += c * t.gradient[a];
            u_bend += c * bend[a];
        }
        let (h, tension) = (membrane.obstacles.jet(p.side, x), membrane.tension.jet(x));
        Some(Self {
            cell: p.cell,
            region: p.free,
            dofs,
            value: t.value,
            gradient: t.gradient,
            bend,
            sign: p.side.sign(),
            tension: tension.value,
            tension_slope: tension.gradient.dot(&normal),
            penalty: penalty(membrane, p.cell),
            load: membrane.load.value(x),
            lack: u - h.value,
            lack_slope: slope - h.gradient,
            lack_bend: u_bend - normal.dot(&(h.hessian * normal)),
            slope,
            u_bend,
            normal,
        })
    }

    /// Adds `value v + gradient·∇v + bend ∂_nn v` for the functions of the cell.
    fn add(&self, value: f64, gradient: &Vector<D>, bend: f64, out: &mut [f64]) {
        for (a, &i) in self.dofs.iter().enumerate() {
            out[i as usize] += value * self.value[a] + gradient.dot(&self.gradient[a]) + bend * self.bend[a];
        }
    }

    /// What the equations integrate along the front, as factors of a function and its gradient:
    /// `T ((β/h)(u - h) v + ∂_n u v + ∂_n v (u - h))`.
    fn imposed(&self) -> (f64, Vector<D>) {
        let pull = self.penalty * self.lack + self.slope.dot(&self.normal);
        (self.tension * pull, self.normal * (self.tension * self.lack))
    }

    /// The slope jump.
    fn jump(&self) -> f64 {
        self.sign * (self.lack_slope.dot(&self.normal) + self.penalty * self.lack)
    }

    /// The slope jump of a rate of the displacement that vanishes on the body.
    fn jump_of(&self, z: &[f64]) -> f64 {
        let values = self.dofs.iter().enumerate();
        let sum =
            values.map(|(a, &i)| z[i as usize] * (self.gradient[a].dot(&self.normal) + self.penalty * self.value[a]));
        self.sign * sum.sum::<f64>()
    }
}

/// What modes do at a point: each with its value and gradient along the front.
type Modes<const D: usize> = Vec<(usize, f64, Vector<D>)>;

struct Along<const D: usize> {
    trace: Trace<D>,
    weight: f64,
    curvature: f64,
    modes: Modes<D>,
}

/// Where a front leaves a cell for the next.
struct Crossing<const D: usize> {
    before: Trace<D>,
    after: Trace<D>,
    /// How far it slides along the front as that moves by one.
    slide: f64,
    modes: Modes<D>,
}

/// A ghost penalty, with the forces that it would exert for a weight of one.
struct Tie {
    pair: GhostPair,
    forces: Vec<f64>,
}

/// The derivative of the discrete slope jump at a state.
pub struct ShapeRate<'a, const D: usize> {
    equilibrium: &'a Equilibrium<D>,
    count: usize,
    along: Vec<Along<D>>,
    crossings: Vec<Crossing<D>>,
    ties: Vec<Tie>,
}

impl<'a, const D: usize> ShapeRate<'a, D> {
    /// At a state, around the zone that it was solved for.
    pub fn new<Z: Zone<D>>(
        equilibrium: &'a Equilibrium<D>,
        elements: &Elements<D>,
        zone: &Z,
        space: ModeSpace,
    ) -> Self {
        let membrane = &equilibrium.membrane;
        let points = &equilibrium.quadrature.front;
        let feet: Vec<FrontFoot<D>> = points.iter().map(|p| zone.foot(p.front, &p.x, space)).collect();
        let along = points.iter().zip(&feet).filter_map(|(p, foot)| {
            let trace = Trace::new(equilibrium, p, &p.x, p.normal)?;
            Some(Along { trace, weight: p.weight, curvature: foot.curvature, modes: foot.modes.clone() })
        });
        let along = along.collect();
        let crossings = crossings(equilibrium, zone, space, &feet);
        let u = equilibrium.values();
        let weight = ghost_weight(membrane.cells.degree());
        let pairs = ghost_pairs(membrane, elements, &equilibrium.quadrature, equilibrium.unknowns());
        let ties = pairs.into_iter().map(|pair| {
            let (matrix, n) = (elements.ghost(membrane, pair.number), pair.dofs.len());
            let row = |a: usize| (0..n).map(|b| matrix[a * n + b] * u[pair.dofs[b] as usize]).sum::<f64>();
            let forces = (0..n).map(|a| weight * pair.tension * row(a)).collect();
            Tie { pair, forces }
        });
        let ties = ties.collect();
        let count = zone.mode_offsets(space)[zone.front_count()];
        Self { equilibrium, count, along, crossings, ties }
    }

    /// The rate of change of `∫ ρ ω_n` for all modes as the fronts move by a sum of them.
    ///
    /// # Errors
    /// A state that was not found by a factorisation.
    pub fn of_moments(&self, step: &[f64]) -> Result<Vec<f64>, SolveError> {
        let speed = |modes: &Modes<D>| -> (f64, Vector<D>) {
            modes.iter().fold((0.0, Vector::zeros()), |(w, g), (m, v, d)| (w + step[*m] * v, g + step[*m] * d))
        };
        let membrane = &self.equilibrium.membrane;
        let mut equations = vec![0.0; self.equilibrium.size()];
        let mut moments = vec![0.0; self.count];
        // What regions lose of cells, and how the fronts in a cell lengthen.
        let mut volumes: HashMap<(usize, RegionId), f64> = HashMap::new();
        let mut lengths: HashMap<usize, f64> = HashMap::new();
        for Along { trace, weight, curvature, modes } in &self.along {
            let (w, along) = speed(modes);
            let turn = -along;
            let n = &trace.normal;
            let Trace { tension, tension_slope, penalty, lack, lack_slope, slope, .. } = trace;
            let (u_n, lack_n) = (slope.dot(n), lack_slope.dot(n));
            let (pull, pull_gradient) = trace.imposed();
            let value = w
                * (trace.load + tension_slope * (penalty * lack + u_n) + tension * (penalty * lack_n + trace.u_bend))
                + curvature * w * pull
                + tension * slope.dot(&turn);
            let normal = w * (tension_slope * lack + tension * (penalty * lack + u_n + lack_n));
            let gradient =
                *n * normal + pull_gradient * (curvature * w) - slope * (w * tension) + turn * (tension * lack);
            trace.add(weight * value, &(gradient * *weight), weight * w * tension * lack, &mut equations);
            let rate = trace.sign * (w * (trace.lack_bend + penalty * lack_n) + lack_slope.dot(&turn))
                + curvature * w * trace.jump();
            modes.iter().for_each(|(m, v, _)| moments[*m] += weight * v * rate);
            *volumes.entry((trace.cell, trace.region)).or_insert(0.0) -= weight * w;
            *lengths.entry(trace.cell).or_insert(0.0) += weight * curvature * w;
        }
        for Crossing { before, after, slide, modes } in &self.crossings {
            let slid = slide * speed(modes).0;
            for (trace, part) in [(before, slid), (after, -slid)] {
                let (value, gradient) = trace.imposed();
                trace.add(part * value, &(gradient * part), 0.0, &mut equations);
                modes.iter().for_each(|(m, v, _)| moments[*m] += part * v * trace.jump());
                *lengths.entry(trace.cell).or_insert(0.0) += part;
            }
        }
        for Tie { pair, forces } in &self.ties {
            let share =
                |cell: usize| volumes.get(&(cell, pair.region)).map_or(0.0, |v| v / membrane.cells.volume(cell));
            let held = |cell: usize| {
                lengths.get(&cell).map_or(0.0, |v| v * membrane.cells.size(cell) / membrane.cells.volume(cell))
            };
            let rate = pair.need_rate(pair.cells.map(share), pair.cells.map(held));
            pair.dofs.iter().zip(forces).for_each(|(&i, f)| equations[i as usize] += rate * f);
        }
        equations.iter_mut().for_each(|r| *r = -*r);
        let z = self.equilibrium.respond(&equations)?;
        for Along { trace, weight, modes, .. } in &self.along {
            let rate = weight * trace.jump_of(&z);
            modes.iter().for_each(|(m, v, _)| moments[*m] += v * rate);
        }
        Ok(moments)
    }
}

/// Where fronts pass from one cell to the next.
fn crossings<const D: usize, Z: Zone<D>>(
    equilibrium: &Equilibrium<D>,
    zone: &Z,
    space: ModeSpace,
    feet: &[FrontFoot<D>],
) -> Vec<Crossing<D>> {
    let membrane = &equilibrium.membrane;
    let points = &equilibrium.quadrature.front;
    let mut order: Vec<usize> = (0..points.len()).collect();
    order.sort_by(|&a, &b| {
        (points[a].front, feet[a].parameter)
            .partial_cmp(&(points[b].front, feet[b].parameter))
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    let mut out = Vec::new();
    for same in order.chunk_by(|&a, &b| points[a].front == points[b].front) {
        for (k, &a) in same.iter().enumerate() {
            let b = same[(k + 1) % same.len()];
            let (p, q) = (&points[a], &points[b]);
            let chord = q.x - p.x;
            let h = membrane.cells.size(p.cell);
            if p.cell == q.cell || p.free != q.free || chord.norm() > APART * h {
                continue;
            }
            // The cubic between the two, and curves beside it.
            let tangent = |foot: &FrontFoot<D>| {
                let t = chord - foot.normal * foot.normal.dot(&chord);
                t / t.norm().max(f64::MIN_POSITIVE) * chord.norm()
            };
            let (from, to) = (tangent(&feet[a]), tangent(&feet[b]));
            let beside = |t: f64, shift: f64| -> Point<D> {
                let (bulge, end) = ((1.0 - t) * (1.0 - t) * t, t * t * (t - 1.0));
                let normal = feet[a].normal * (1.0 - t) + feet[b].normal * t;
                p.x + chord * (t * t * (3.0 - 2.0 * t)) + from * bulge + to * end + normal * shift
            };
            let crossing = |shift: f64| -> f64 {
                let (mut inside, mut beyond) = (0.0, 1.0);
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (inside + beyond);
                    if membrane.cells.containing(&beside(middle, shift)) == Some(p.cell) {
                        inside = middle;
                    } else {
                        beyond = middle;
                    }
                }
                0.5 * (inside + beyond)
            };
            let t = crossing(0.0);
            let x = beside(t, 0.0);
            // Not so far aside that the crossing would leave the piece between the two points.
            let shift = ASIDE * chord.norm() * t.min(1.0 - t);
            let slid = beside(crossing(shift), shift) - beside(crossing(-shift), -shift);
            let foot = zone.foot(p.front, &x, space);
            let ahead = chord - foot.normal * foot.normal.dot(&chord);
            let slide = slid.dot(&ahead) / ahead.norm().max(f64::MIN_POSITIVE) / (2.0 * shift);
            let trace = |at: &FrontPoint<D>| Trace::new(equilibrium, at, &x, foot.normal);
            let (Some(before), Some(after)) = (trace(p), trace(q)) else { continue };
            out.push(Crossing { before, after, slide, modes: foot.modes });
        }
    }
    out
}
