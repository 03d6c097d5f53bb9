//! The slope jump on the fronts, and the Newton step that drives it to zero.

use crate::equilibrium::Equilibrium;
use crate::equilibrium::elements::Elements;
use crate::method::{ModeSpace, Modes};
use crate::mode_matrix::{Clique, ModeMatrix, add_cliques};
use crate::quadrature::FrontPoint;
use crate::scales::Scales;
use crate::shape_rate::ShapeRate;
use crate::zone::{FrontFrame, Zone};
use signorini_geometry::{Point, Real};
use signorini_solve::krylov::conjugate_residuals;
use signorini_solve::{SolveError, dense};
use std::borrow::Cow;
use std::cell::OnceCell;

/// A floor pressure below this fraction of the reference pressure does not steer a local step any more.
const WEAK_PRESSURE: f64 = 0.02;
/// A local step longer than this fraction of the grid's resolution gives way to one with the response of the membrane.
const LOCAL_REACH: f64 = 0.6;

/// A front of so few modes is short.
const FEW_MODES: usize = 12;

/// What the discrete step leaves of its equations, and the products with their matrix that it may take.
const LEFT: f64 = 1e-3;
const MOST_PRODUCTS: usize = 12;

/// Modes whose response is computed at most.
const MOST_RESPONSES: usize = 240;

/// The fronts of a state: slope jump, pressure of the bodies and tension at every quadrature point.
pub struct Fronts<'a, const D: usize> {
    pub(crate) equilibrium: &'a Equilibrium<D>,
    /// `ρ`: positive where the floor would have to pull, negative where the membrane penetrates.
    pub slope_jump: Vec<f64>,
    pub pressure: Vec<f64>,
    pub(crate) tension: Vec<f64>,
    /// `∂_n T`.
    pub(crate) tension_slope: Vec<f64>,
    /// The slope at which adhesion holds the front, and its normal derivative; zero without.
    pub(crate) adhesive_slope: Vec<f64>,
    pub(crate) adhesive_slope_rate: Vec<f64>,
    first_frames: OnceCell<(ModeSpace, Vec<FrontFrame>)>,
}

/// The slope jump in a space of modes.
pub struct Projection {
    /// `‖P ρ‖` over the fronts: what the modes can still drive to zero.
    pub norm: f64,
    /// `‖ρ - P ρ‖`: what they cannot.
    pub remainder: f64,
}

/// A proposed displacement of the fronts.
pub struct Step {
    /// Root mean square of the displacement, relative to the cells that the fronts lie in.
    pub length: f64,
    pub space: ModeSpace,
    pub coefficients: Vec<f64>,
    pub kind: StepKind,
    /// How far the fronts may move at most.
    pub reach: f64,
}

/// Which part of the derivative a step is made with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepKind {
    /// The pressure of the floor alone: near the solution, where nothing else survives.
    Local,
    /// With the response of the membrane.
    Full,
    /// With all of the derivative of the discrete equations.
    Exact,
    /// Towards the slope at which adhesion holds, with all of the derivative.
    Adhesive,
    /// Down the energy, where the state is unstable.
    Descent,
}

impl StepKind {
    pub fn name(self) -> &'static str {
        match self {
            StepKind::Local => "local step",
            StepKind::Full => "full step",
            StepKind::Exact => "exact step",
            StepKind::Adhesive => "adhesive step",
            StepKind::Descent => "unstable: down the energy",
        }
    }
}

impl<'a, const D: usize> Fronts<'a, D> {
    /// The fronts of a state, held by what adhesion there is, or by nothing.
    pub fn new(equilibrium: &'a Equilibrium<D>, adhering: bool) -> Self {
        let membrane = &equilibrium.membrane;
        let points = &equilibrium.quadrature.front;
        let tension: Vec<_> = points.iter().map(|p| membrane.tension.jet(&p.x)).collect();
        let held = |p: &FrontPoint<D>| {
            if !adhering {
                return (0.0, 0.0);
            }
            let (slope, gradient) = membrane.adhesive_slope(p.side, &p.x);
            (slope, gradient.dot(&p.normal))
        };
        let (adhesive_slope, adhesive_slope_rate) = points.iter().map(held).unzip();
        Self {
            slope_jump: equilibrium.slope_jump(),
            pressure: points.iter().map(|p| membrane.pressure(p.side, &p.x)).collect(),
            tension_slope: tension.iter().zip(points).map(|(t, p)| t.gradient.dot(&p.normal)).collect(),
            tension: tension.iter().map(|t| t.value()).collect(),
            adhesive_slope,
            adhesive_slope_rate,
            first_frames: OnceCell::new(),
            equilibrium,
        }
    }

    fn weights(&self) -> impl Iterator<Item = f64> + '_ {
        self.equilibrium.quadrature.front.iter().map(|p| p.weight)
    }

    fn modes(&self) -> Modes {
        self.equilibrium.membrane.modes
    }

    /// `∫ f ω_n` in the finest modes.
    pub(crate) fn moments<Z: Zone<D>>(&self, zone: &Z, f: &[f64]) -> Vec<f64> {
        let finest = self.modes().finest();
        let mut out = vec![0.0; zone.mode_offsets(finest)[zone.front_count()]];
        for ((frame, w), f) in self.frames(zone, finest).iter().zip(self.weights()).zip(f) {
            frame.modes.iter().for_each(|(i, v)| out[*i] += w * f * v);
        }
        out
    }

    /// Mean over the fronts of `T (ρ² - ρ_a²)/2`, the energy to be gained from a smaller zone.
    pub fn drive(&self) -> f64 {
        let points = self.weights().enumerate();
        let (sum, total) = points.fold((0.0, 0.0), |(s, t), (i, w)| (s + w * self.shrinking_force(i), t + w));
        sum / f64::max(total, f64::MIN_POSITIVE)
    }

    /// Of each connected zone the force `∫ T (ρ² - ρ_a²)/2` on its fronts, which shrinks it where positive.
    pub(crate) fn drive_of_zones(&self, zones: usize) -> Vec<f64> {
        let mut out = vec![0.0; zones];
        for (i, p) in self.equilibrium.quadrature.front.iter().enumerate() {
            if let Some(force) = out.get_mut(p.zone) {
                *force += p.weight * self.shrinking_force(i);
            }
        }
        out
    }

    /// `T (ρ² - ρ_a²)/2` at a point of the fronts; a membrane that penetrates drives them outwards.
    fn shrinking_force(&self, i: usize) -> f64 {
        let (rho, held) = (self.slope_jump[i], self.adhesive_slope[i]);
        0.5 * self.tension[i] * (rho * rho.abs() - held * held)
    }

    /// `ρ - ρ_a`: what the fronts still lack.
    pub(crate) fn excess(&self) -> Vec<f64> {
        self.slope_jump.iter().zip(&self.adhesive_slope).map(|(r, a)| r - a).collect()
    }

    /// The frame of every point, in the zone that the state was solved around. Those of the modes that are asked for first
    /// are kept.
    pub(crate) fn frames<Z: Zone<D>>(&self, zone: &Z, space: ModeSpace) -> Cow<'_, [FrontFrame]> {
        let frames = || self.equilibrium.quadrature.front.iter().map(|p| zone.frame(p.front, &p.x, space)).collect();
        let (kept, first) = self.first_frames.get_or_init(|| (space, frames()));
        if *kept == space { Cow::Borrowed(first) } else { Cow::Owned(frames()) }
    }

    /// The matrix `∫ c w_m ω_n` and the vector `∫ f ω_n`.
    fn galerkin(&self, frames: &[FrontFrame], n: usize, c: &[f64], f: &[f64]) -> (ModeMatrix, Vec<f64>) {
        let mut vector = vec![0.0; n];
        for ((frame, w), f) in frames.iter().zip(self.weights()).zip(f) {
            frame.modes.iter().for_each(|(i, v)| vector[*i] += w * f * v);
        }
        (
            ModeMatrix::of_products(n, frames.iter().map(|f| &f.modes[..]), self.weights().zip(c).map(|(w, c)| w * c)),
            vector,
        )
    }

    /// Stiffness for modes that live, wholly or in part, beyond the membrane, where nothing else determines them; `diagonal` is
    /// that of the matrix to which it is added.
    pub(crate) fn stiffness_outside<Z: Zone<D>>(
        &self,
        zone: &Z,
        space: ModeSpace,
        frames: &[FrontFrame],
        diagonal: &[f64],
        scale: f64,
    ) -> Vec<Clique> {
        let offsets = zone.mode_offsets(space);
        let h = self.equilibrium.membrane.grid.h();
        let largest = diagonal.iter().fold(f64::MIN_POSITIVE, |m, d| m.max(d.abs()));
        let mut out = Vec::new();
        let mut weight = vec![0.0; diagonal.len()];
        for (frame, w) in frames.iter().zip(self.weights()) {
            frame.modes.iter().for_each(|(i, v)| weight[*i] += w * v * v);
        }
        let heaviest = weight.iter().fold(0.0f64, |m, w| m.max(*w));
        for front in 0..zone.front_count() {
            let lightest = weight[offsets[front]..offsets[front + 1]].iter().fold(f64::INFINITY, |m, w| m.min(*w));
            if lightest < 1e-3 * heaviest {
                out.extend(zone.stiffness(space, front, 1e-3 * scale * h * h));
                out.extend((offsets[front]..offsets[front + 1]).map(|i| (vec![i as u32], vec![1e-10 * largest])));
            }
        }
        out
    }

    /// Adds that stiffness to a row-major matrix.
    pub(crate) fn hold_modes_outside<Z: Zone<D>>(
        &self,
        zone: &Z,
        space: ModeSpace,
        frames: &[FrontFrame],
        matrix: &mut [f64],
        scale: f64,
    ) {
        let n = zone.mode_offsets(space)[zone.front_count()];
        let diagonal: Vec<f64> = (0..n).map(|i| matrix[i * n + i]).collect();
        add_cliques(matrix, n, &self.stiffness_outside(zone, space, frames, &diagonal, scale));
    }

    /// Splits what the slope jump lacks into what the modes see and what they do not.
    pub fn project<Z: Zone<D>>(&self, zone: &Z, space: ModeSpace) -> Projection {
        let (mass, b) = self.mass(zone, space);
        let square: f64 = self.weights().zip(self.excess()).map(|(w, r)| w * r * r).sum();
        let seen = mass.solve(&b).map_or(square, |c| c.iter().zip(&b).map(|(c, b)| c * b).sum::<f64>());
        Projection { norm: seen.max(0.0).sqrt(), remainder: (square - seen).max(0.0).sqrt() }
    }

    /// What the slope jump lacks, as far as the modes see it, in the norm of `H⁻¹` of the fronts: `(bᵀ (M + l² K)⁻¹ b)^½`
    /// with the mass and stiffness of the modes and `l` the extent of the membrane over 2π.
    ///
    /// The variational flux is true to `h^{2p}` against smooth functions, and only there: from cell to cell it goes up and
    /// down by `h^p`, so do fronts, and `L²` would see little else. In one dimension fronts are points, each with a slope jump
    /// of its own, whatever the length of the circle that it stands for.
    pub fn residual<Z: Zone<D>>(&self, zone: &Z, space: ModeSpace) -> f64 {
        if D == 1 {
            return self.excess().iter().map(|r| r * r).sum::<f64>().sqrt();
        }
        let (mut matrix, b) = self.mass(zone, space);
        let length = self.equilibrium.membrane.size() / std::f64::consts::TAU;
        stiffen(&mut matrix, zone, space, length);
        let square = matrix.solve(&b).map(|c| c.iter().zip(&b).map(|(c, b)| c * b).sum::<f64>());
        square.map_or_else(|| self.project(zone, space).norm, |square| square.max(0.0).sqrt())
    }

    /// The coefficients of a step without its waves that are shorter than about 2π times a length.
    pub fn smoothed<Z: Zone<D>>(&self, zone: &Z, step: &Step, length: f64) -> Vec<f64> {
        let (mut matrix, _) = self.mass(zone, step.space);
        let moments = matrix.multiply(&step.coefficients);
        stiffen(&mut matrix, zone, step.space, length);
        matrix.solve(&moments).unwrap_or_else(|| step.coefficients.clone())
    }

    /// The mass matrix of the modes, and the moments of what the slope jump lacks.
    fn mass<Z: Zone<D>>(&self, zone: &Z, space: ModeSpace) -> (ModeMatrix, Vec<f64>) {
        let n = zone.mode_offsets(space)[zone.front_count()];
        let frames = self.frames(zone, space);
        let (mut mass, b) = self.galerkin(&frames, n, &vec![1.0; frames.len()], &self.excess());
        mass.add(self.stiffness_outside(zone, space, &frames, &mass.diagonal(), 1.0));
        (mass, b)
    }

    /// How far the floor's pressure would have the modes of the fronts move, at the place where that is farthest relative to
    /// a size.
    pub fn farthest<Z: Zone<D>>(&self, zone: &Z, scales: &Scales, size: impl Fn(&Point<D>) -> f64) -> f64 {
        let space = self.modes().finest();
        let frames = self.frames(zone, space);
        let (matrix, _, b) = self.local_system(zone, space, &frames, &self.local_rate(scales), scales);
        let Some(step) = matrix.solve(&b) else { return f64::INFINITY };
        let moved = |frame: &FrontFrame| frame.modes.iter().map(|(i, v)| v * step[*i]).sum::<f64>();
        let points = self.equilibrium.quadrature.front.iter().zip(frames.iter());
        points.map(|(p, frame)| moved(frame).abs() / size(&p.x)).fold(0.0, f64::max)
    }

    /// The fewest modes that see the better part of the slope jump.
    fn leading_space<Z: Zone<D>>(&self, zone: &Z) -> ModeSpace {
        let finest = self.modes().finest();
        let fine = zone.mode_offsets(finest)[zone.front_count()];
        (3..)
            .map(|k| self.modes().at_most(1 << k))
            .take_while(|&space| zone.mode_offsets(space)[zone.front_count()] < fine)
            .find(|&space| {
                let p = self.project(zone, space);
                p.remainder < p.norm
            })
            .unwrap_or(finest)
    }

    /// The rate of change `ρ°` of the slope jump at the points of a front that moves with the normal speed `w`:
    ///
    /// `ρ°[w] = Λ_T(ρ w) - κ ρ w - (∂_n T / T) ρ w + (p / T) w`
    ///
    /// with the Dirichlet-to-Neumann map `Λ_T` of the free membrane.
    pub fn slope_jump_rate<Z: Zone<D>>(&self, zone: &Z, speed: &[f64]) -> Result<Vec<f64>, SolveError> {
        let data: Vec<f64> = self.slope_jump.iter().zip(speed).map(|(r, w)| -r * w).collect();
        let response = self.equilibrium.normal_derivative_of_extension(&data)?;
        let points = &self.equilibrium.quadrature.front;
        Ok((0..points.len())
            .map(|i| {
                let p = &points[i];
                let kappa = zone.frame(p.front, &p.x, ModeSpace::Fine).curvature
                    + self.equilibrium.membrane.measure.curvature(&p.x, p.normal[0]);
                let rho = self.slope_jump[i];
                response[i]
                    + speed[i]
                        * (self.pressure[i] / self.tension[i] - rho * (kappa + self.tension_slope[i] / self.tension[i]))
            })
            .collect())
    }

    /// The Newton step on the shape.
    ///
    /// Near the solution only the local part of the derivative survives, `ρ° → (p/T) w`, and the step costs no solve.
    /// Far from it, where the zone is too large by more than the grid resolves, the response of the membrane is kept,
    /// in a few modes per front: one solve each with the factorisation at hand. Where the zone is too small (`ρ < 0`)
    /// the response would take away the sign of the operator in short waves, and is left out.
    pub fn newton_step<Z: Zone<D>>(&self, zone: &Z, scales: &Scales) -> Result<Step, SolveError> {
        let local = self.local_rate(scales);
        let sizes = self.cell_sizes();
        let ways = self.slope_jump.iter().zip(&local).zip(&sizes);
        let beyond = ways.map(|((r, l), h)| r / l / h).fold(0.0, f64::max) > LOCAL_REACH;
        // Local steps cost nothing in the finest modes; but on fronts of a few cells these follow what the cells do.
        let finest = self.modes().finest();
        let offsets = zone.mode_offsets(finest);
        let short = offsets.windows(2).any(|o| o[1] - o[0] <= FEW_MODES);
        // Fronts that come to divided cells were found on others, or by the nodal method: what is left of their way is short
        // waves, which full steps in a few modes would not see.
        let whole = beyond && self.equilibrium.membrane.sizing.is_none();
        let schedule = (whole || short) && self.equilibrium.responds();
        let space = if schedule { self.leading_space(zone) } else { finest };
        let n = zone.mode_offsets(space)[zone.front_count()];
        // With very many modes their responses cost more than a few careful local steps.
        let far = whole && n <= MOST_RESPONSES && self.equilibrium.responds();
        let frames = self.frames(zone, space);
        let (matrix, _, mut b) = self.local_system(zone, space, &frames, &local, scales);
        let kind = if far { StepKind::Full } else { StepKind::Local };
        for v in &mut b {
            *v = -*v;
        }
        // The matrix is the sum of a positive mass and a positive response; only a front without points is singular.
        let solved = if far {
            let mut matrix = matrix.dense();
            self.add_response(zone, space, &frames, n, &mut matrix)?;
            dense::solve(&matrix, &b)
        } else {
            matrix.solve(&b)
        };
        let coefficients = solved.unwrap_or_else(|| vec![0.0; n]);
        let length = self.length(&frames, &coefficients);
        let largest = sizes.iter().copied().fold(0.0, f64::max);
        let reach = if beyond && !far { largest } else { f64::INFINITY };
        Ok(Step { length, space, coefficients, kind, reach })
    }

    /// `p/T`, the local part of the derivative; nowhere less than steers a step.
    fn local_rate(&self, scales: &Scales) -> Vec<f64> {
        let least = WEAK_PRESSURE * scales.pressure;
        self.pressure.iter().zip(&self.tension).map(|(p, t)| p.max(least) / t).collect()
    }

    /// The matrix of that with what holds modes beyond the membrane, the latter alone, and `∫ ρ ω_n`.
    fn local_system<Z: Zone<D>>(
        &self,
        zone: &Z,
        space: ModeSpace,
        frames: &[FrontFrame],
        local: &[f64],
        scales: &Scales,
    ) -> (ModeMatrix, ModeMatrix, Vec<f64>) {
        let n = zone.mode_offsets(space)[zone.front_count()];
        let (mut matrix, b) = self.galerkin(frames, n, local, &self.excess());
        let held = self.stiffness_outside(zone, space, frames, &matrix.diagonal(), scales.pressure / scales.tension);
        matrix.add(held.clone());
        (matrix, ModeMatrix::of_cliques(n, held), b)
    }

    /// The sizes of the cells that the points of the fronts lie in.
    pub(crate) fn cell_sizes(&self) -> Vec<f64> {
        let Equilibrium { membrane, quadrature, .. } = self.equilibrium;
        let size = |p: &FrontPoint<D>| match membrane.sizing {
            None => membrane.grid.h(),
            Some(_) => membrane.cells.size(p.cell),
        };
        quadrature.front.iter().map(size).collect()
    }

    /// Root mean square of a displacement of the fronts, in cells.
    fn length(&self, frames: &[FrontFrame], coefficients: &[f64]) -> f64 {
        let total: f64 = self.weights().sum();
        let at = |f: &FrontFrame| f.modes.iter().map(|(i, v)| v * coefficients[*i]).sum::<f64>();
        let points = frames.iter().zip(self.cell_sizes()).zip(self.weights());
        let square: f64 = points.map(|((f, h), w)| w * (at(f) / h).powi(2)).sum();
        (square / total.max(f64::MIN_POSITIVE)).sqrt()
    }

    /// The Newton step with the derivative of the discrete slope jump, near the solution. Most of that is the pressure of the
    /// floor, or with adhesion the `derivative` in the continuum, so the method of generalised conjugate residuals needs few
    /// products with it; none where these do not get there.
    ///
    /// # Errors
    /// A state that was not found by a factorisation.
    pub fn discrete_step<Z: Zone<D>>(
        &self,
        zone: &Z,
        elements: &Elements<D>,
        scales: &Scales,
        derivative: Option<&dense::Factor>,
    ) -> Result<Option<Step>, SolveError> {
        let space = self.modes().finest();
        let frames = self.frames(zone, space);
        let (matrix, held, b) = self.local_system(zone, space, &frames, &self.local_rate(scales), scales);
        let nearly = |moments: &[f64]| match derivative {
            Some(factor) => Some(factor.solve(moments)),
            None => matrix.solve(moments),
        };
        let rate = ShapeRate::new(self.equilibrium, elements, zone, space);
        let image = |step: &[f64]| -> Result<Option<Vec<f64>>, SolveError> {
            let mut moments = rate.of_moments(step)?;
            moments.iter_mut().zip(held.multiply(step)).for_each(|(m, h)| *m += h);
            if derivative.is_some() {
                self.subtract_adhesive_rate(&frames, step, &mut moments);
            }
            Ok(nearly(&moments))
        };
        let Some(first) = nearly(&b) else { return Ok(None) };
        let first = first.iter().map(|v| -v).collect();
        let Some(coefficients) = conjugate_residuals(first, image, LEFT, MOST_PRODUCTS)? else { return Ok(None) };
        let length = self.length(&frames, &coefficients);
        Ok(Some(Step { length, space, coefficients, kind: StepKind::Exact, reach: f64::INFINITY }))
    }

    /// Subtracts the rate of change of `∫ ρ_a ω_n`, which is `∫ (∂_n ρ_a + κ ρ_a) w ω_n`.
    fn subtract_adhesive_rate(&self, frames: &[FrontFrame], step: &[f64], moments: &mut [f64]) {
        for (i, (frame, weight)) in frames.iter().zip(self.weights()).enumerate() {
            let w: f64 = frame.modes.iter().map(|(m, v)| v * step[*m]).sum();
            let rate = w * (self.adhesive_slope_rate[i] + frame.curvature * self.adhesive_slope[i]);
            frame.modes.iter().for_each(|(m, v)| moments[*m] -= weight * rate * v);
        }
    }

    /// Adds `∫ Λ_T(ρ⁺ w_m) ω_n`, and for fronts on which it stays safely positive `-∫ κ ρ⁺ w_m ω_n`.
    fn add_response<Z: Zone<D>>(
        &self,
        zone: &Z,
        space: ModeSpace,
        frames: &[FrontFrame],
        n: usize,
        matrix: &mut [f64],
    ) -> Result<(), SolveError> {
        let points = &self.equilibrium.quadrature.front;
        let positive: Vec<f64> = self.slope_jump.iter().map(|r| r.max(0.0)).collect();
        let mut curvature_part = vec![0.0; n * n];
        for mode in 0..n {
            let speed: Vec<f64> = frames.iter().map(|f| f.value(mode)).collect();
            let data: Vec<f64> = positive.iter().zip(&speed).map(|(r, w)| -r * w).collect();
            if data.iter().all(|v| *v == 0.0) {
                continue;
            }
            let response = self.equilibrium.normal_derivative_of_extension(&data)?;
            for (i, p) in points.iter().enumerate() {
                let kappa = frames[i].curvature + self.equilibrium.membrane.measure.curvature(&p.x, p.normal[0]);
                for &(row, v) in &frames[i].modes {
                    matrix[row * n + mode] += p.weight * v * response[i];
                    curvature_part[row * n + mode] -= p.weight * v * kappa * positive[i] * speed[i];
                }
            }
        }
        let offsets = zone.mode_offsets(space);
        for front in 0..zone.front_count() {
            let range = offsets[front]..offsets[front + 1];
            let mean = |m: &[f64]| {
                range.clone().flat_map(|i| range.clone().map(move |j| (i, j))).map(|(i, j)| m[i * n + j]).sum::<f64>()
            };
            let (whole, part) = (mean(matrix), mean(&curvature_part));
            if whole + part > 0.5 * whole {
                for i in range.clone() {
                    for j in range.clone() {
                        matrix[i * n + j] += curvature_part[i * n + j];
                    }
                }
            }
        }
        Ok(())
    }
}

/// Adds `l² K`, the stiffness of the modes of all fronts for a length.
fn stiffen<const D: usize, Z: Zone<D>>(matrix: &mut ModeMatrix, zone: &Z, space: ModeSpace, length: f64) {
    (0..zone.front_count()).for_each(|front| matrix.add(zone.stiffness(space, front, length * length)));
}
