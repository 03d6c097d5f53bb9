//! Laws of friction between solids.

use crate::expression::{Expression, Scope};
use crate::plan::planner::Planner;
use crate::problem::units::{LENGTH, NONE, PRESSURE, TIME, VELOCITY};
use crate::problem::{self, CaseError, Value};
use signorini_contact::law::{
    Coulomb, Evolution, Law, LawError, RateAndState, RateAndStateKeys, Scheduled, Tresca, Viscous,
};

/// Times of a step, beside its start, at which a coefficient that changes is checked.
const SAMPLES: u32 = 20;

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
                let velocity = self.reader.positive(&key.velocity, VELOCITY)?;
                let law = Viscous::new(mu, velocity).map_err(|e| self.not_negative(&key.mu, e))?;
                return Ok(Box::new(law));
            }
            problem::Friction::RateAndState(key) => return self.rate_and_state(key),
            problem::Friction::Coulomb(key) => key,
        };
        let list = &key.mu.0;
        if let [mu] = &list[..]
            && self.reader.number(mu, NONE).is_err()
            && let Ok(expression) = self.reader.expression(mu, NONE, &["t"])
        {
            return self.scheduled(mu, expression);
        }
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

    fn rate_and_state(&self, key: &problem::RateAndStateFriction) -> Result<Box<dyn Law>, CaseError> {
        let [mu, b] = [&key.mu, &key.b].map(|value| {
            let found = self.reader.number(value, NONE)?;
            Coulomb::isotropic(found).map_err(|e| self.not_negative(value, e))?;
            Ok::<f64, CaseError>(found)
        });
        let velocity = self.reader.positive(&key.velocity, VELOCITY)?;
        let distance = self.reader.positive(&key.distance, LENGTH)?;
        let keys = RateAndStateKeys {
            mu: mu?,
            a: self.reader.positive(&key.a, NONE)?,
            b: b?,
            velocity,
            distance,
            evolution: match key.evolution {
                Some(problem::StateEvolution::Slip) => Evolution::Slip,
                Some(problem::StateEvolution::Aging) | None => Evolution::Aging,
            },
            state: key.state.as_ref().map_or(Ok(distance / velocity), |v| self.reader.positive(v, TIME))?,
        };
        let law = RateAndState::new(keys).map_err(|e| self.not_negative(&key.mu, e))?;
        Ok(Box::new(law))
    }

    /// A coefficient that changes with time.
    fn scheduled(&self, mu: &Value, expression: Expression) -> Result<Box<dyn Law>, CaseError> {
        let at = move |time: f64| expression.evaluate(&Scope { position: [0.0; 3], time });
        let mut from = 0.0;
        for step in &self.problem.steps {
            let to = self.reader.number(&step.to, TIME)?;
            let times = (0..=SAMPLES).map(|k| from + (to - from) * f64::from(k) / f64::from(SAMPLES));
            if let Some((time, value)) = times.map(|t| (t, at(t))).find(|(_, mu)| !(*mu >= 0.0 && mu.is_finite())) {
                let message = format!("the coefficient of friction is {value} at t = {time}");
                return Err(self.problem.error(mu, message).help("0 or more at all times"));
            }
            from = to;
        }
        Ok(Box::new(Scheduled::new(Box::new(at))))
    }

    fn not_negative(&self, value: &Value, LawError { value: found }: LawError) -> CaseError {
        let error = self.problem.error(value, format!("the value is {found}: it must not be negative"));
        error.help("leave `friction` out for frictionless contact")
    }
}
