//! Units of a representation.

use super::exchange::Parameter;
use super::model::Entity;
use super::{StepError, StepFile};

/// Units of the numbers of a representation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct FileUnits {
    /// Metres of a unit of length.
    pub metres: f64,
    /// Radians of a unit of angle.
    pub radians: f64,
    /// Distance within which points are the same, in units of length.
    pub uncertainty: f64,
}

impl StepFile {
    /// The units of the context of a representation; millimetres and radians where it states none, as CAD programs do.
    pub(super) fn units(&self, context: u64) -> Result<FileUnits, StepError> {
        let mut units = FileUnits { metres: 1e-3, radians: 1.0, uncertainty: 0.0 };
        if let Some(assigned) = self.record(context, "GLOBAL_UNIT_ASSIGNED_CONTEXT") {
            for id in assigned.references(0)? {
                if self.record(id, "LENGTH_UNIT").is_some() {
                    units.metres = self.unit(id, "METRE")?;
                } else if self.record(id, "PLANE_ANGLE_UNIT").is_some() {
                    units.radians = self.unit(id, "RADIAN")?;
                }
            }
        }
        if let Some(assigned) = self.record(context, "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT") {
            for id in assigned.references(0)? {
                if let Some(stated) = self.record(id, "UNCERTAINTY_MEASURE_WITH_UNIT") {
                    let is_length = matches!(stated.get(0), Parameter::Typed(name, _) if name == "LENGTH_MEASURE");
                    if is_length {
                        units.uncertainty = stated.number(0)?;
                    }
                }
            }
        }
        Ok(units)
    }

    /// The size of a unit, in `base`.
    fn unit(&self, id: u64, base: &str) -> Result<f64, StepError> {
        self.unit_within(id, base, 0)
    }

    fn unit_within(&self, id: u64, base: &str, depth: usize) -> Result<f64, StepError> {
        if let Some(si) = self.record(id, "SI_UNIT") {
            // Within a complex instance the prefix comes first.
            let words: Vec<&str> = (0..3)
                .filter_map(|k| match si.get(k) {
                    Parameter::Enumeration(word) => Some(word.as_str()),
                    _ => None,
                })
                .collect();
            let (prefix, name) = match words[..] {
                [prefix, name] => (Some(prefix), name),
                [name] => (None, name),
                _ => (None, ""),
            };
            let factor = match prefix {
                None => 1.0,
                Some("KILO") => 1e3,
                Some("DECI") => 1e-1,
                Some("CENTI") => 1e-2,
                Some("MILLI") => 1e-3,
                Some("MICRO") => 1e-6,
                Some("NANO") => 1e-9,
                Some(other) => return Err(si.error(format!("the prefix `{other}` is not known"), KNOWN)),
            };
            if name != base {
                return Err(si.error(format!("the unit `{name}` is not known"), KNOWN));
            }
            return Ok(factor);
        }
        if let Some(converted) = self.record(id, "CONVERSION_BASED_UNIT") {
            let measure: Entity<'_> = converted.entity(1)?;
            // One of the file's own records, or of a complex instance.
            let of = self.record(measure.id, "MEASURE_WITH_UNIT").unwrap_or(measure);
            let unit = of.reference(1)?;
            // A unit of a unit of a unit and so on is a circle.
            if depth > 8 {
                return Err(converted.error("a unit is stated by itself", KNOWN));
            }
            return Ok(of.number(0)? * self.unit_within(unit, base, depth + 1)?);
        }
        Err(self.error(id, "the unit is not known", KNOWN))
    }
}

const KNOWN: &str = "export the file with lengths in millimetres, metres or inches";
