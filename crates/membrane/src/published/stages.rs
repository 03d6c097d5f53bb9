//! The iteration on the shape, front by front, for what a solution does not hold.

use super::schedule::ModeSchedule;
use crate::equilibrium::Equilibrium;
use crate::equilibrium::elements::Elements;
use crate::front::Fronts;
use crate::method::ModeSpace;
use crate::obstacle::Side;
use crate::plane_zone::PlaneZone;
use crate::problem::Membrane;
use crate::scales::Scales;
use crate::zone::{Zone, ZoneFronts, ZoneMotion, ZoneTopology};
use signorini_solve::SolveError;

/// A front on its way.
pub struct Stage {
    pub outline: Vec<[f64; 2]>,
    /// Mean distance from the origin.
    pub radius: f64,
    /// Norm of the slope jump over the front.
    pub slope_jump: f64,
    /// The slope jump in the first modes of the arc length: mean, and cosine and sine of each wave number together.
    pub waves: Vec<f64>,
}

/// The stages of the front from the zone that the free membrane penetrates, for at most so many steps; with as many modes as
/// it takes, or with the mean alone.
///
/// # Errors
/// Equations that cannot be solved.
pub fn stages(membrane: &Membrane<2>, most: usize, mean_only: bool) -> Result<Vec<Stage>, SolveError> {
    let mut elements = Elements::new(membrane);
    let none = PlaneZone::empty(&membrane.grid);
    let free = Equilibrium::solve(membrane, &none, &mut elements)?;
    let scales = Scales::of_free(&free);
    let mut zone = none.united(&membrane.grid, Side::Below, &mut |x| {
        free.displacement(&none, x).map_or(1.0, |u| membrane.obstacles.gap(Side::Below, x, u))
    });
    let mut out = Vec::new();
    let mut schedule = ModeSchedule::default();
    for _ in 0..=most {
        let state = Equilibrium::solve(membrane, &zone, &mut elements)?;
        let fronts = Fronts::new(&state, false);
        out.push(stage(&zone, &state, &fronts));
        let step = match (state.saddle(), mean_only) {
            (Some(saddle), false) => schedule.step(&fronts, saddle, &zone, &scales),
            (Some(saddle), true) => ModeSchedule::default().step(&fronts, saddle, &zone, &scales),
            (None, _) => fronts.newton_step(&zone, &scales),
        };
        let step = step?;
        zone = zone.advanced(&membrane.grid, step.space, &step.coefficients, f64::INFINITY).zone;
    }
    Ok(out)
}

const WAVES: ModeSpace = ModeSpace::Fourier(17);

fn stage(zone: &PlaneZone, state: &Equilibrium<2>, fronts: &Fronts<'_, 2>) -> Stage {
    let points = &state.quadrature.front;
    let length: f64 = points.iter().map(|p| p.weight).sum();
    let radius = points.iter().map(|p| p.weight * p.x.norm()).sum::<f64>() / length;
    let square: f64 = points.iter().zip(&fronts.slope_jump).map(|(p, r)| p.weight * r * r).sum();
    let mut moments = vec![0.0; zone.mode_offsets(WAVES)[zone.front_count()].max(1)];
    for (p, rho) in points.iter().zip(&fronts.slope_jump) {
        for (mode, value) in zone.frame(p.front, &p.x, WAVES).modes {
            moments[mode] += p.weight * rho * value;
        }
    }
    let waves = moments[1..].chunks(2).map(|pair| 2.0 / length * pair.iter().map(|v| v * v).sum::<f64>().sqrt());
    let waves = std::iter::once(moments[0].abs() / length).chain(waves).collect();
    let outline = zone.outlines().into_iter().next().unwrap_or_default();
    let outline: Vec<[f64; 2]> = outline.iter().chain(outline.first()).map(|x| [x[0], x[1]]).collect();
    Stage { outline, radius, slope_jump: square.sqrt(), waves }
}
