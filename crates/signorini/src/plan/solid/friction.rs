//! Laws of friction between solids.

use crate::plan::planner::Planner;
use crate::problem::units::{NONE, PRESSURE};
use crate::problem::{self, CaseError, Value};
use signorini_contact::law::{Coulomb, Law, LawError, Tresca, Viscous};

impl Planner<'_> {
    /// The law of friction.
    pub(in crate::plan) fn law(&self, key: &problem::Friction) -> Result<Box<dyn Law>, CaseError> {
        let key = match key {
            problem::Friction::Tresca(key) => {
                let limit = self.reader.number(&key.limit, PRESSURE)?;
                let law = Tresca::new(limit).map_err(|e| self.not_negative(&key.limit, e))?;
                return Ok(Box::new(law));
            }
            problem::Friction::Viscous(key) => {
                let mu = self.reader.number(&key.mu, NONE)?;
                let velocity = self.reader.positive(&key.velocity, [1, 0, -1])?;
                let law = Viscous::new(mu, velocity).map_err(|e| self.not_negative(&key.mu, e))?;
                return Ok(Box::new(law));
            }
            problem::Friction::Coulomb(key) => key,
        };
        let list = &key.mu.0;
        let coefficient = |k: usize| {
            let mu = self.reader.number(&list[k], NONE)?;
            Coulomb::isotropic(mu).map_err(|e| self.not_negative(&list[k], e))?;
            Ok::<f64, CaseError>(mu)
        };
        let mu = match list.len() {
            1 => [coefficient(0)?; 2],
            2 => [coefficient(0)?, coefficient(1)?],
            found => {
                return Err(self
                    .problem
                    .error(&key.mu, format!("{found} coefficients of friction"))
                    .help("mu = 0.3, or along `axis` and across it  mu = [0.3, 0.5]"));
            }
        };
        let law = Coulomb::orthotropic(mu).map_err(|e| self.not_negative(&list[0], e))?;
        Ok(Box::new(law))
    }

    fn not_negative(&self, value: &Value, LawError { value: found }: LawError) -> CaseError {
        let error = self.problem.error(value, format!("the value is {found}: it must not be negative"));
        error.help("leave `friction` out for frictionless contact")
    }
}
