//! The scales that a problem supplies itself: all tolerances are relative to them, so no unit is hidden anywhere.

use crate::equilibrium::Equilibrium;
use crate::equilibrium::elements::nitsche_penalty;
use crate::problem::Membrane;
use crate::zone::is_free;

/// Reference gap, pressure, tension and length of a problem.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Scales {
    /// Span of the gap between the free membrane and what it may touch; the gap itself where adhesion may bridge it.
    pub gap: f64,
    /// The larger of the load and the pressure that would bend the membrane by the reference gap.
    pub pressure: f64,
    pub tension: f64,
    /// Extent of the domain.
    pub length: f64,
    /// Size of the cells at the fronts, in the mean.
    pub h: f64,
    pub degree: usize,
    pub dimension: usize,
}

impl Scales {
    /// Reads the scales off the membrane without contact.
    pub fn of_free<const D: usize>(free: &Equilibrium<D>) -> Self {
        let membrane: &Membrane<D> = &free.membrane;
        let (mut lowest, mut highest) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
        let (mut load, mut tension) = (0.0f64, 0.0f64);
        free.for_each_point(|cell, region, x, _| {
            if is_free(region)
                && let Some((u, _)) = free.evaluate(cell, region, x)
            {
                let mut measure = |k: usize, gap: f64| {
                    lowest[k] = lowest[k].min(gap);
                    highest[k] = highest[k].max(gap);
                };
                if membrane.obstacles.is_empty() {
                    measure(0, u);
                }
                membrane
                    .obstacles
                    .sides()
                    .enumerate()
                    .for_each(|(k, side)| measure(k, membrane.obstacles.gap(side, x, u)));
                load = load.max(membrane.load.value(x).abs());
                tension = tension.max(membrane.tension.value(x));
            }
        });
        let length = membrane.size();
        let sticky = membrane.obstacles.are_sticky();
        let spans = lowest.iter().zip(&highest).filter(|(low, high)| low <= high).map(|(low, high)| {
            let span = high - low;
            if sticky { span.max(high.abs()) } else { span }
        });
        let gap = spans.fold(f64::MIN_POSITIVE, f64::max);
        Self {
            gap,
            pressure: load.max(tension * gap / (length * length)),
            tension,
            length,
            h: membrane.front_size(),
            degree: membrane.grid.degree(),
            dimension: D,
        }
    }

    fn relative_h(&self) -> f64 {
        self.h / self.length
    }

    /// What the slope jump must fall below, in the norm of `H⁻¹` of the fronts: the solver's own accuracy, or a
    /// hundredth of what the grid resolves where that is more; in the plane three of them at degree 1, whose slope jump has
    /// kinks of that size wherever fronts pass vertices of cells.
    pub fn slope_tolerance(&self) -> f64 {
        let slope = self.pressure * self.length / self.tension;
        let resolved = 1e-2 * self.relative_h().powi(2 * self.degree as i32);
        if self.dimension == 1 {
            // Fronts are points: the norm has no length in it, and one more solve costs nothing.
            let least = if self.degree == 1 { resolved } else { 1e-11 };
            return least * slope;
        }
        let resolved = if self.degree == 1 { 3.0 * resolved } else { resolved };
        // The flux is a difference of displacements times the penalty over h, and inherits their round-off.
        let round_off = 400.0 * f64::EPSILON * nitsche_penalty(self.degree) / self.relative_h();
        resolved.max(round_off).max(1e-10) * slope * self.length.sqrt()
    }

    /// Penetration that counts as none in a cell of size `h`: a fraction of the cell's share of the gap, and what a
    /// polynomial of this degree misses of a curved membrane, as long as that is little beside the gap.
    pub fn gap_tolerance(&self, h: f64) -> f64 {
        let relative = h / self.length;
        let missed = 0.2 * self.pressure / self.tension * h.powi(2) * relative.powi(self.degree as i32 - 1);
        1e-3 * relative.powi(2) * self.gap + missed.min(0.1 * self.gap)
    }

    /// Suction that counts as none.
    pub fn pressure_tolerance(&self) -> f64 {
        1e-9 * self.pressure
    }
}
