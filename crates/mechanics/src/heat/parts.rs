//! Where temperatures are prescribed and heat comes from.

use super::{Blocks, ThermalBody};
use crate::body::PlaceError;
use crate::part::Part;
use crate::placed::TimeField;
use signorini_geometry::Point;

/// A place whose temperature is prescribed.
#[derive(Clone)]
pub struct PrescribedTemperature {
    pub name: String,
    pub part: Part,
    pub temperature: TimeField,
    /// The time after which it holds, from the start if none, and the last at which it does, for ever if none.
    pub from: Option<f64>,
    pub until: Option<f64>,
}

impl PrescribedTemperature {
    pub(super) fn holds_at(&self, time: f64) -> bool {
        self.from.is_none_or(|from| time > from) && self.until.is_none_or(|until| time <= until)
    }
}

/// What brings heat into a body.
#[derive(Clone)]
pub enum HeatLoad {
    /// Per time and reference area.
    Flux(TimeField),
    /// Per time and reference volume.
    Source(TimeField),
    /// Exchange with a fluid, per reference area and difference of temperature, and the temperature of the fluid.
    Convection { coefficient: TimeField, ambient: TimeField },
}

/// Heat at its place.
#[derive(Clone)]
pub struct PlacedHeat {
    pub name: String,
    pub part: Part,
    pub load: HeatLoad,
}

impl PlacedHeat {
    /// Adds the heat that does not depend on the temperature; the blocks `∫ α N_a N_b` of what does.
    ///
    /// # Errors
    /// A place where it cannot act.
    pub fn act(&self, body: &dyn ThermalBody, time: f64, out: &mut [f64]) -> Result<Blocks, PlaceError> {
        let on = self.part.group.as_deref();
        match &self.load {
            HeatLoad::Flux(q) => body.add_flux(on, &|x| q(x, time), out).map(|()| Vec::new()),
            HeatLoad::Source(r) => body.add_source(on, &|x| r(x, time), out).map(|()| Vec::new()),
            HeatLoad::Convection { coefficient, ambient } => {
                body.add_flux(on, &|x: &Point<3>| coefficient(x, time) * ambient(x, time), out)?;
                body.film(on, &|x| coefficient(x, time))
            }
        }
    }
}
