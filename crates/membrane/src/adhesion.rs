//! Fronts held by adhesion: the linearised front condition, and the stability of what satisfies it.
//!
//! With an energy `γ` for each area of contact the fronts rest where `T ρ² / 2 = γ`, at the slope `ρ_a = √(2γ/T)`. A front
//! that moves with the normal speed `w` changes the condition by
//!
//! ```text
//! ρ°[w] - w ∂_n ρ_a = Λ_T(ρ w) - (κ + ∂_n T / T) ρ w + (p / T) w - w ∂_n ρ_a
//! ```
//!
//! of which, unlike without adhesion, nothing vanishes at the solution. Weighted by `T ρ_a` this is the second variation
//! of the energy `∫ T |∇u|² / 2 - f u - γ |zone|`, a symmetric form: the state is stable while it is positive.

use crate::equilibrium::Equilibrium;
use crate::front::{Fronts, Step, StepKind};
use crate::method::ModeSpace;
use crate::scales::Scales;
use crate::zone::Zone;
use rayon::prelude::*;
use signorini_solve::{SolveError, dense};

/// A mode whose stiffness is less than this fraction of that of the pressure alone is on the verge of instability.
const VERGE: f64 = 0.02;
/// Down the energy no mode counts as softer than this, lest fronts creep past a state that has just been lost.
const SOFTEST: f64 = 1e-4;
/// On the verge fronts move by two cells or this fraction of the extent, lest they leap over the next equilibrium.
const CAREFUL: f64 = 0.03;

/// Modes beyond the membrane are that much stiffer than others, so that none of them is the softest.
const OUTSIDE_STIFFNESS: f64 = 1e6;

/// Which equilibrium is wanted where adhesion admits several.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Branch {
    /// The stable one to which the energy descends.
    Stable,
    /// The one next to the start, stable or not.
    Nearest,
}

/// The front condition and its derivatives in the modes of the fronts.
pub struct Linearised {
    space: ModeSpace,
    n: usize,
    /// `∫ (ρ - ρ_a) ω_n`.
    pub residual: Vec<f64>,
    /// `∫ (ρ°[w_m] - w_m ∂_n ρ_a) ω_n`, row by row.
    pub rate: Vec<f64>,
    /// `∫ w_m`: by how much the zone grows.
    pub growth: Vec<f64>,
    /// `∫ T ρ (ρ - ρ_a) ω_n` and its derivative, the second variation of the energy.
    force: Vec<f64>,
    second_variation: Vec<f64>,
    mass: Vec<f64>,
    /// The mass with lengths in cells.
    mass_in_cells: Vec<f64>,
    /// Stiffness of a mode that the floor's pressure alone would give.
    pub scale: f64,
}

/// Eigenvalues and eigenvectors of the second variation, ascending.
pub struct Spectrum {
    pub values: Vec<f64>,
    vectors: Vec<Vec<f64>>,
}

impl<const D: usize> Fronts<'_, D> {
    /// Linearises the front condition in a space of modes: one solve for each, with the factorisation at hand.
    pub fn linearise<Z: Zone<D>>(&self, zone: &Z, space: ModeSpace, scales: &Scales) -> Result<Linearised, SolveError> {
        let n = zone.mode_offsets(space)[zone.front_count()];
        let equilibrium: &Equilibrium<D> = self.equilibrium;
        let points = &equilibrium.quadrature.front;
        let frames = self.frames(zone, space);
        // Where the membrane penetrates the response would take away the sign of short waves: the slope at the solution
        // takes its place, which leaves the order of convergence as it is. It vanishes nowhere, for the form's sake.
        let largest = self.adhesive_slope.iter().fold(0.0f64, |m, r| m.max(*r));
        let slope: Vec<f64> =
            self.slope_jump.iter().zip(&self.adhesive_slope).map(|(r, a)| r.max(*a).max(1e-3 * largest)).collect();
        let own: Vec<f64> = (0..points.len())
            .map(|i| {
                let kappa =
                    frames[i].curvature + equilibrium.membrane.measure.curvature(&points[i].x, points[i].normal[0]);
                self.pressure[i] / self.tension[i]
                    - slope[i] * (kappa + self.tension_slope[i] / self.tension[i])
                    - self.adhesive_slope_rate[i]
            })
            .collect();
        let one_sided = || {
            let column = |mode| {
                let speed: Vec<f64> = frames.iter().map(|f| f.value(mode)).collect();
                let data: Vec<f64> = slope.iter().zip(&speed).map(|(r, w)| -r * w).collect();
                let response = equilibrium.normal_derivative_of_extension(&data)?;
                Ok(response.iter().zip(own.iter().zip(&speed)).map(|(r, (o, w))| r + o * w).collect())
            };
            (0..n).into_par_iter().map(column).collect::<Result<Vec<Vec<f64>>, SolveError>>()
        };
        let columns = match equilibrium.saddle() {
            None => one_sided()?,
            Some(saddle) => {
                let held = |mode: usize, i: usize| frames[i].value(mode) * self.adhesive_slope_rate[i];
                let rates = saddle.rates(&equilibrium.free(), zone, space)?.into_iter().enumerate();
                rates
                    .map(|(m, rate)| rate.slope_jump.iter().enumerate().map(|(i, r)| r - held(m, i)).collect())
                    .collect()
            }
        };
        let mut out = Linearised {
            space,
            n,
            residual: vec![0.0; n],
            rate: vec![0.0; n * n],
            growth: vec![0.0; n],
            force: vec![0.0; n],
            second_variation: vec![0.0; n * n],
            mass: vec![0.0; n * n],
            mass_in_cells: vec![0.0; n * n],
            scale: 0.0,
        };
        let (excess, cells) = (self.excess(), self.cell_sizes());
        let mut total = 0.0;
        for (i, p) in points.iter().enumerate() {
            let (weight, stiffness) = (p.weight, self.tension[i] * slope[i]);
            total += weight;
            out.scale += weight * slope[i] * scales.pressure;
            let residual = excess[i];
            for &(row, v) in &frames[i].modes {
                out.residual[row] += weight * residual * v;
                out.force[row] += weight * stiffness * residual * v;
                out.growth[row] += weight * v;
                for (mode, column) in columns.iter().enumerate() {
                    out.rate[row * n + mode] += weight * v * column[i];
                    out.second_variation[row * n + mode] += weight * stiffness * v * column[i];
                }
                for &(mode, w) in &frames[i].modes {
                    let part = weight * v * w;
                    out.mass[row * n + mode] += part;
                    out.mass_in_cells[row * n + mode] += part / (cells[i] * cells[i]);
                }
            }
        }
        out.scale /= total.max(f64::MIN_POSITIVE);
        self.hold_modes_outside(zone, space, &frames, &mut out.rate, scales.pressure / scales.tension);
        self.hold_modes_outside(zone, space, &frames, &mut out.second_variation, OUTSIDE_STIFFNESS * out.scale);
        self.hold_modes_outside(zone, space, &frames, &mut out.mass, 1.0);
        Ok(out)
    }
}

impl Linearised {
    /// The derivative of the front condition, factorised; none where it is singular.
    pub fn factor(&self) -> Option<dense::Factor> {
        dense::Factor::new(self.n, &self.rate)
    }

    /// The spectrum of the second variation; none where the modes depend on each other.
    pub fn spectrum(&self) -> Option<Spectrum> {
        let (values, vectors) = dense::symmetric_eigen(&self.second_variation, &self.mass)?;
        Some(Spectrum { values, vectors })
    }

    /// The second variation of the energy along a displacement of the fronts.
    pub fn second_variation(&self, displacement: &[f64]) -> f64 {
        let n = self.n;
        let row = |i: usize| (0..n).map(|j| self.second_variation[i * n + j] * displacement[j]).sum::<f64>();
        (0..n).map(|i| displacement[i] * row(i)).sum()
    }

    /// A step towards the wanted equilibrium.
    pub fn step(&self, branch: Branch, scales: &Scales) -> Step {
        let careful = (CAREFUL * scales.length).max(2.0 * scales.h);
        let verge = VERGE * self.scale;
        let newton = || {
            let negative: Vec<f64> = self.residual.iter().map(|r| -r).collect();
            dense::solve(&self.rate, &negative).unwrap_or_else(|| vec![0.0; self.n])
        };
        let step = |coefficients: Vec<f64>, kind, reach| {
            let length = self.mean(&self.mass_in_cells, &coefficients);
            Step { length, space: self.space, coefficients, kind, reach }
        };
        let spectrum = if branch == Branch::Stable { self.spectrum() } else { None };
        let Some(spectrum) = spectrum else { return step(newton(), StepKind::Adhesive, f64::INFINITY) };
        let lowest = spectrum.values.first().copied().unwrap_or(0.0);
        if lowest <= 0.0 {
            return step(self.descent(&spectrum), StepKind::Descent, careful);
        }
        let coefficients = newton();
        // On a zone of the size of a cell the two derivatives may contradict each other; the energy has the last word.
        let far = self.size(&coefficients) > 0.1 * scales.h;
        if far && coefficients.iter().zip(&self.force).map(|(w, f)| w * f).sum::<f64>() > 0.0 {
            return step(self.descent(&spectrum), StepKind::Descent, careful);
        }
        step(coefficients, StepKind::Adhesive, if lowest < verge { careful } else { f64::INFINITY })
    }

    /// Down the energy: along every eigenvector by its force over the size of its stiffness.
    fn descent(&self, spectrum: &Spectrum) -> Vec<f64> {
        let mut step = vec![0.0; self.n];
        for (value, vector) in spectrum.values.iter().zip(&spectrum.vectors) {
            let force: f64 = vector.iter().zip(&self.force).map(|(v, f)| v * f).sum();
            let amount = -force / value.abs().max(SOFTEST * self.scale);
            step.iter_mut().zip(vector).for_each(|(s, v)| *s += amount * v);
        }
        step
    }

    /// A small step off an unstable equilibrium, along its most unstable direction, the way that enlarges the zone.
    pub fn perturbation(&self, spectrum: &Spectrum, h: f64) -> Vec<f64> {
        let Some(vector) = spectrum.vectors.first() else { return vec![0.0; self.n] };
        let growth: f64 = vector.iter().zip(&self.growth).map(|(v, g)| v * g).sum();
        let length = self.size(vector).max(f64::MIN_POSITIVE);
        vector.iter().map(|v| v * growth.signum() * 0.5 * h / length).collect()
    }

    /// Root mean square of a displacement of the fronts.
    fn size(&self, coefficients: &[f64]) -> f64 {
        self.mean(&self.mass, coefficients)
    }

    /// Root mean square of a displacement of the fronts by a mass of the modes.
    fn mean(&self, mass: &[f64], coefficients: &[f64]) -> f64 {
        let n = self.n;
        let square: f64 =
            (0..n).map(|i| coefficients[i] * (0..n).map(|j| mass[i * n + j] * coefficients[j]).sum::<f64>()).sum();
        let total: f64 = self.growth.iter().sum();
        (square.max(0.0) / total.max(f64::MIN_POSITIVE)).sqrt()
    }
}
