//! Heat through contacts: conductance at the sites that are closed, and the heat of friction.

use super::{Heat, ThermalBody};
use crate::body::PlaceError;
use crate::interaction::Bodies;
use crate::points::Function;
use crate::site_result::SiteResult;
use crate::system::{AssemblyError, System, SystemState};
use signorini_contact::Status;
use signorini_geometry::Point;

/// Conductance of surfaces that touch: heat per time, area and jump of temperature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Conductance {
    Constant(f64),
    /// `h_0 (p/p_0)^m`. Of rough surfaces of metals `m = 0.95` (Cooper, Mikic and Yovanovich, *Int. J. Heat Mass Transfer* 12,
    /// 1969).
    OfPressure {
        conductance: f64,
        pressure: f64,
        exponent: f64,
    },
}

impl Conductance {
    pub fn at(&self, p: f64) -> f64 {
        match self {
            Conductance::Constant(h) => *h,
            Conductance::OfPressure { conductance, pressure, exponent } => {
                conductance * (p.max(0.0) / pressure).powf(*exponent)
            }
        }
    }
}

/// What passes through a contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatContact {
    /// None where no heat passes.
    pub conductance: Option<Conductance>,
    /// Part of the heat of friction that the slave takes.
    pub slave_share: f64,
}

/// Mean values over a site on slave and master: functions of each body with their weights, which sum to one. Nothing on a rigid
/// body.
pub type Means = [Vec<(u32, f64)>; 2];

/// An interaction through which heat passes.
pub trait Conducting {
    /// The unknowns of the bodies that move the mean positions of both sides of each site of
    /// [`results`](crate::Interaction::results), the first of each function; none of interactions through which none can pass.
    ///
    /// # Errors
    /// Bodies that cannot be tested or touched.
    fn means(&self, _at: Bodies<'_>) -> Result<Option<Vec<Means>>, PlaceError> {
        Ok(None)
    }

    /// Whether [`means`](Conducting::means) are known.
    fn conducts(&self) -> bool {
        false
    }
}

/// The functions that move a point along the first axis, by the first unknown of each.
pub(crate) fn first_unknowns(functions: &[Function], dimension: usize) -> Vec<(u32, f64)> {
    let first = functions.iter().filter(|f| (f.unknown as usize).is_multiple_of(dimension));
    first.map(|f| (f.unknown, f.value[0])).collect()
}

/// A site through which heat passes, in the coefficients of all temperatures.
pub(super) struct HeatSite {
    /// `Σ a_f T_f` is the temperature of each side; the constant is that of a rigid body.
    pub sides: [(Vec<(u32, f64)>, f64); 2],
    /// Conductance times area.
    pub conductance: f64,
    /// Heat of friction into each side.
    pub friction: [f64; 2],
}

impl HeatSite {
    pub fn jump(&self, temperature: &[f64]) -> f64 {
        let of = |(terms, known): &(Vec<(u32, f64)>, f64)| {
            known + terms.iter().map(|(f, a)| a * temperature[*f as usize]).sum::<f64>()
        };
        of(&self.sides[0]) - of(&self.sides[1])
    }
}

impl System {
    /// The sites of a contact through which heat passes in a state that an increment of a duration came to. `first` are the
    /// first coefficients of the temperatures of bodies.
    pub(super) fn heat_sites(
        &self,
        heat: &Heat,
        contact: usize,
        (state, sites): (&SystemState, &[SiteResult]),
        (time, duration): (f64, f64),
        first: &[Option<u32>],
    ) -> Result<Vec<HeatSite>, AssemblyError> {
        let Some(law) = &heat.contacts[contact] else { return Ok(Vec::new()) };
        let (unknowns, _) = self.numbering();
        let interaction = &self.contacts[contact];
        let means = interaction.means(self.bodies_in(state, &unknowns))?.unwrap_or_default();
        let bodies = interaction.bodies();
        let thermal: [Option<&dyn ThermalBody>; 2] = bodies.map(|b| self.bodies[b].thermal());
        let origin = Point::<3>::zeros();
        let known = [0, 1].map(|k| match (thermal[k], heat.known.get(&bodies[k])) {
            (None, Some(temperature)) => temperature(&origin, time),
            _ => 0.0,
        });
        let of = |(site, means): (&SiteResult, Means)| {
            if site.status == Status::Open {
                return None;
            }
            let side = |k: usize| {
                let terms = match (first[bodies[k]], thermal[k]) {
                    (Some(start), Some(body)) => {
                        let function = |(u, a): &(u32, f64)| (start + u / body.dimension() as u32, *a);
                        means[k].iter().map(function).collect()
                    }
                    _ => Vec::new(),
                };
                (terms, known[k])
            };
            let power = if duration > 0.0 { site.dissipated() / duration } else { 0.0 };
            Some(HeatSite {
                sides: [side(0), side(1)],
                conductance: site.weight * law.conductance.map_or(0.0, |h| h.at(site.pressure)),
                friction: [law.slave_share * power, (1.0 - law.slave_share) * power],
            })
        };
        Ok(sites.iter().zip(means).filter_map(of).collect())
    }
}
