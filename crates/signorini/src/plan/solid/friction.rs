//! Laws of friction between solids.

use crate::plan::Planner;
use crate::problem::units::{NONE, PRESSURE};
use crate::problem::{self, CaseError, Value};
use signorini_contact::law::{Coulomb, LawError, Tresca};
use signorini_geometry::Point;
use signorini_solid::Friction;

/// The friction of a contact.
#[derive(Clone, Copy, Debug)]
pub struct PlannedFriction<const D: usize> {
    law: PlannedLaw,
    axis: Option<Point<D>>,
}

#[derive(Clone, Copy, Debug)]
enum PlannedLaw {
    Coulomb(Coulomb),
    Tresca(Tresca),
}

impl<const D: usize> PlannedFriction<D> {
    /// The friction of a contact of solids.
    pub fn friction(&self) -> Friction<D> {
        let law: Box<dyn signorini_contact::Law> = match self.law {
            PlannedLaw::Coulomb(law) => Box::new(law),
            PlannedLaw::Tresca(law) => Box::new(law),
        };
        Friction { law, axis: self.axis }
    }
}

impl Planner<'_> {
    pub(super) fn friction<const D: usize>(&self, key: &problem::Friction) -> Result<PlannedFriction<D>, CaseError> {
        match key {
            problem::Friction::Tresca(key) => {
                let limit = self.reader.number(&key.limit, PRESSURE)?;
                let law = Tresca::new(limit).map_err(|e| self.not_negative(&key.limit, e))?;
                Ok(PlannedFriction { law: PlannedLaw::Tresca(law), axis: None })
            }
            problem::Friction::Coulomb(key) => self.coulomb(key),
        }
    }

    fn coulomb<const D: usize>(&self, key: &problem::CoulombFriction) -> Result<PlannedFriction<D>, CaseError> {
        let list = &key.mu.0;
        let coefficient = |k: usize| {
            let mu = self.reader.number(&list[k], NONE)?;
            Coulomb::isotropic(mu).map_err(|e| self.not_negative(&list[k], e))?;
            Ok::<f64, CaseError>(mu)
        };
        let mu = match (list.len(), D) {
            (1, _) => [coefficient(0)?; 2],
            (2, 3) => [coefficient(0)?, coefficient(1)?],
            (2, _) => {
                return Err(self
                    .problem
                    .error(&key.mu, "in the plane bodies slide in one direction: there is one coefficient")
                    .help("mu = 0.3"));
            }
            (found, _) => {
                return Err(self
                    .problem
                    .error(&key.mu, format!("{found} coefficients of friction"))
                    .help("mu = 0.3, or along `axis` and across it  mu = [0.3, 0.5]"));
            }
        };
        let axis = match &key.axis {
            Some(axis) => {
                let direction = Point::<D>::from(self.reader.numbers::<D>(axis, NONE)?);
                Some(
                    direction
                        .try_normalize(0.0)
                        .ok_or_else(|| self.problem.error(axis, "the direction has no length"))?,
                )
            }
            None if mu[0] != mu[1] => {
                return Err(self
                    .problem
                    .error(&key.mu, "two coefficients of friction need the direction of the first")
                    .help("axis = [1, 0, 0]"));
            }
            None => None,
        };
        let law = Coulomb::orthotropic(mu).map_err(|e| self.not_negative(&list[0], e))?;
        Ok(PlannedFriction { law: PlannedLaw::Coulomb(law), axis })
    }

    fn not_negative(&self, value: &Value, LawError { value: found }: LawError) -> CaseError {
        let error = self.problem.error(value, format!("the value is {found}: friction takes no less than zero"));
        error.help("leave `friction` out where there is none")
    }
}
