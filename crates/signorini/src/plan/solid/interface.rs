//! Laws of interfaces between solids: friction, with compliance, cohesion, adhesion or wear.

use crate::plan::planner::Planner;
use crate::problem::units::{Dimension, FORCE_PER_LENGTH, LENGTH, NONE, PRESSURE};
use crate::problem::{self, CaseError, SofteningKey, Value};
use signorini_contact::law::{Cohesion, CohesionKeys, Compliance, Coulomb, Law, Rough, Softening, Worn};

/// One over a pressure.
const PER_PRESSURE: Dimension = [-PRESSURE[0], -PRESSURE[1], -PRESSURE[2], 0];

/// Why bodies of other kinds have no such law.
const AT_POINTS: &str = "it is available for solids and finite cells that touch at points or by mortar";

impl Planner<'_> {
    /// The law of a contact of solids; none where bodies do not penetrate and slide freely.
    pub(in crate::plan) fn interface(&self, key: &problem::Contact) -> Result<Option<Box<dyn Law>>, CaseError> {
        let friction = key.friction.as_ref().map(|friction| self.law(friction)).transpose()?;
        let stated = [
            ("adhesion", key.adhesion.as_ref().map(|k| self.key(k))),
            ("cohesion", key.cohesion.as_ref().map(|k| self.key(k))),
            ("compliance", key.compliance.as_ref().map(|k| self.key(k))),
            ("wear", key.wear.as_ref().map(|k| self.key(k))),
        ];
        let mut stated = stated.iter().filter_map(|(name, at)| at.as_ref().map(|at| (name, at)));
        let (first, second) = (stated.next(), stated.next());
        if let (Some(friction @ problem::Friction::RateAndState(_)), Some((other, _))) = (&key.friction, first) {
            let message = format!("`friction.rate_and_state` and `{other}` in one contact");
            return Err(self.problem.error(friction, message).help("leave one of them out"));
        }
        if let (Some((first, _)), Some((second, at))) = (first, second) {
            let message = format!("`{first}` and `{second}` in one contact");
            return Err(self.problem.error(at, message).help("a contact has one of them, with or without friction"));
        }
        let free = || Coulomb::isotropic(0.0).map(|law| Box::new(law) as Box<dyn Law>);
        let rubbing = |friction: Option<Box<dyn Law>>| friction.map_or_else(free, Ok);
        if let Some(own) = &key.compliance {
            if let Some(penalty) = stated_penalty(key) {
                return Err(self
                    .problem
                    .error(penalty, "a penalty gives way besides the compliance of the surfaces")
                    .help("leave `penalty` out: the compliance is enforced exactly"));
            }
            let law =
                Rough::new(self.compliance(own)?, friction).map_err(|e| self.problem.error(own, e.to_string()))?;
            return Ok(Some(Box::new(law)));
        }
        if let Some(own) = &key.cohesion {
            let strength = self.reader.positive(&own.strength, PRESSURE)?;
            let length = |v: &Option<Value>| v.as_ref().map_or(Ok(0.0), |v| self.reader.number(v, LENGTH));
            let shear = own.shear_strength.as_ref().map(|v| self.reader.positive(v, PRESSURE)).transpose()?;
            let keys = CohesionKeys {
                strength,
                energy: self.reader.positive(&own.energy, FORCE_PER_LENGTH)?,
                softening: softening(own.softening),
                opening: length(&own.opening)?,
                shear: shear.map_or(1.0, |shear| shear / strength),
                heals: false,
            };
            let at: &Value = own.opening.as_ref().unwrap_or(&own.energy);
            let law = rubbing(friction).and_then(|friction| Cohesion::new(keys, friction)).map_err(|_| {
                let most = 2.0 * keys.energy / strength;
                self.problem
                    .error(at, format!("the strength is reached at an opening of {}", keys.opening))
                    .help(format!("from 0 to below 2 energy/strength = {most}, where the whole energy would be spent"))
            })?;
            return Ok(Some(Box::new(law)));
        }
        if let Some(own) = &key.adhesion {
            let Some(strength) = &own.strength else {
                return Err(self
                    .problem
                    .error(own, "between solids, adhesion requires a strength: the largest attraction")
                    .help("strength = \"1 MPa\": with a higher one the attraction reaches less far, over 2 energy/strength"));
            };
            let keys = CohesionKeys {
                strength: self.reader.positive(strength, PRESSURE)?,
                energy: self.reader.positive(&own.energy, FORCE_PER_LENGTH)?,
                softening: softening(own.softening),
                opening: 0.0,
                shear: 0.0,
                heals: true,
            };
            let law = rubbing(friction).and_then(|friction| Cohesion::new(keys, friction));
            let law = law.map_err(|e| self.problem.error(own, e.to_string()))?;
            return Ok(Some(Box::new(law)));
        }
        if let Some(wear) = &key.wear {
            let coefficient = self.reader.number(wear, PER_PRESSURE)?;
            let law = rubbing(friction).and_then(|friction| Worn::new(coefficient, friction));
            let law = law.map_err(|e| {
                self.problem.error(wear, format!("the coefficient of wear is {}: it must not be negative", e.value))
            })?;
            return Ok(Some(Box::new(law)));
        }
        Ok(friction)
    }

    /// Refuses what curves, discs and membranes do not have.
    pub(in crate::plan) fn refuse_interface(&self, key: &problem::Contact, what: &str) -> Result<(), CaseError> {
        let rate_and_state = key.friction.as_ref().filter(|f| matches!(f, problem::Friction::RateAndState(_)));
        let stated = [
            ("cohesion", key.cohesion.as_ref().map(|k| self.key(k))),
            ("compliance", key.compliance.as_ref().map(|k| self.key(k))),
            ("wear", key.wear.as_ref().map(|k| self.key(k))),
            ("friction.rate_and_state", rate_and_state.map(|k| self.key(k))),
        ];
        match stated.into_iter().find_map(|(name, at)| at.map(|at| (name, at))) {
            Some((name, at)) => Err(self.problem.error(&at, format!("`{name}` {what}")).help(AT_POINTS)),
            None => Ok(()),
        }
    }

    fn compliance(&self, key: &problem::Compliance) -> Result<Compliance, CaseError> {
        Ok(match key {
            problem::Compliance::Exponential(own) => Compliance::Exponential {
                pressure: self.reader.positive(&own.pressure, PRESSURE)?,
                length: self.reader.positive(&own.length, LENGTH)?,
            },
            problem::Compliance::Power(own) => {
                let exponent = own.exponent.as_ref().map_or(Ok(1.0), |v| self.reader.number(v, NONE))?;
                if exponent < 1.0 {
                    let at = own.exponent.as_ref().map_or_else(|| self.key(own), |v| self.key(v));
                    let message = format!("the exponent is {exponent}: it must be 1 or more");
                    return Err(self
                        .problem
                        .error(&at, message)
                        .help("1 is a bed of springs, 1.5 to 3 rough surfaces"));
                }
                let penetration = self.reader.positive(&own.penetration, LENGTH)?;
                let pressure = self.reader.positive(&own.pressure, PRESSURE)?;
                Compliance::Power { coefficient: pressure / penetration.powf(exponent), exponent }
            }
        })
    }
}

fn softening(key: Option<SofteningKey>) -> Softening {
    match key {
        Some(SofteningKey::Exponential) => Softening::Exponential,
        Some(SofteningKey::Linear) | None => Softening::Linear,
    }
}

/// The penalty of a contact of solids, if it states one.
fn stated_penalty(key: &problem::Contact) -> Option<&problem::Penalty> {
    use problem::Method;
    let enforcement = match key.method.as_ref()? {
        Method::Mortar(m) | Method::GaussPoint(m) | Method::Node(m) | Method::CellSurface(m) => {
            m.enforcement.as_ref()?
        }
        _ => return None,
    };
    if let problem::Enforcement::Penalty(penalty) = enforcement { Some(penalty) } else { None }
}
