//! Laws of friction between solids.

use crate::plan::mechanics::is_tangent;
use crate::plan::planner::Planner;
use crate::problem::units::{NONE, PRESSURE};
use crate::problem::{self, CaseError, Value};
use signorini_contact::law::{Coulomb, Law, LawError, Tresca, Viscous};
use signorini_geometry::Point;
use signorini_solid::Friction;
use std::sync::Arc;

/// The friction of a contact.
#[derive(Clone, Debug)]
pub struct PlannedFriction<const D: usize> {
    law: Arc<dyn Law>,
    axis: Option<Point<D>>,
}

impl<const D: usize> PlannedFriction<D> {
    /// The friction of a contact of solids.
    pub fn friction(&self) -> Friction<D> {
        Friction { law: Box::new(Arc::clone(&self.law)), axis: self.axis }
    }
}

impl Planner<'_> {
    /// The friction of a contact of solids: the law and its axis.
    pub(super) fn friction<const D: usize>(&self, key: &problem::Friction) -> Result<PlannedFriction<D>, CaseError> {
        let law = self.planned_law(key, D)?;
        let problem::Friction::Coulomb(coulomb) = key else { return Ok(PlannedFriction { law, axis: None }) };
        let axis = match &coulomb.axis {
            Some(axis) if is_tangent(axis) => {
                return Err(self
                    .problem
                    .error(axis, "a solid has no tangent direction of its own")
                    .help("axis = [1, 0, 0]; `\"tangent\"` is for ropes and beams"));
            }
            Some(axis) => {
                let direction = Point::<D>::from(self.reader.numbers::<D>(&axis.0, NONE)?);
                Some(
                    direction
                        .try_normalize(0.0)
                        .ok_or_else(|| self.problem.error(axis, "the direction vector is zero"))?,
                )
            }
            None if law.per_pressure().is_some_and(|mu| mu[0] != mu[1]) => {
                return Err(self
                    .problem
                    .error(&coulomb.mu, "two coefficients of friction require the direction of the first one")
                    .help("axis = [1, 0, 0]"));
            }
            None => None,
        };
        Ok(PlannedFriction { law, axis })
    }

    /// The law of friction in so many dimensions.
    pub(in crate::plan) fn law(&self, key: &problem::Friction, dimension: usize) -> Result<Box<dyn Law>, CaseError> {
        Ok(Box::new(self.planned_law(key, dimension)?))
    }

    fn planned_law(&self, key: &problem::Friction, dimension: usize) -> Result<Arc<dyn Law>, CaseError> {
        let key = match key {
            problem::Friction::Tresca(key) => {
                let limit = self.reader.number(&key.limit, PRESSURE)?;
                let law = Tresca::new(limit).map_err(|e| self.not_negative(&key.limit, e))?;
                return Ok(Arc::new(law));
            }
            problem::Friction::Viscous(key) => {
                let mu = self.reader.number(&key.mu, NONE)?;
                let velocity = self.reader.positive(&key.velocity, [1, 0, -1])?;
                let law = Viscous::new(mu, velocity).map_err(|e| self.not_negative(&key.mu, e))?;
                return Ok(Arc::new(law));
            }
            problem::Friction::Coulomb(key) => key,
        };
        let list = &key.mu.0;
        let coefficient = |k: usize| {
            let mu = self.reader.number(&list[k], NONE)?;
            Coulomb::isotropic(mu).map_err(|e| self.not_negative(&list[k], e))?;
            Ok::<f64, CaseError>(mu)
        };
        let mu = match (list.len(), dimension) {
            (1, _) => [coefficient(0)?; 2],
            (2, 3) => [coefficient(0)?, coefficient(1)?],
            (2, _) => {
                return Err(self
                    .problem
                    .error(&key.mu, "in the plane slip has one direction, so there is one coefficient")
                    .help("mu = 0.3"));
            }
            (found, _) => {
                return Err(self
                    .problem
                    .error(&key.mu, format!("{found} coefficients of friction"))
                    .help("mu = 0.3, or along `axis` and across it  mu = [0.3, 0.5]"));
            }
        };
        let law = Coulomb::orthotropic(mu).map_err(|e| self.not_negative(&list[0], e))?;
        Ok(Arc::new(law))
    }

    fn not_negative(&self, value: &Value, LawError { value: found }: LawError) -> CaseError {
        let error = self.problem.error(value, format!("the value is {found}: it must not be negative"));
        error.help("leave `friction` out for frictionless contact")
    }
}
