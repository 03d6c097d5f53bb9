//! The laws of contacts with more or less friction than stated, to find out whether friction is what an equilibrium lacks.

use crate::plan::planner::Planner;
use crate::problem::{CaseError, Components, Friction, List, Problem, Value};
use signorini_contact::law::Law;

/// The laws of contacts, by their names, with so many times the coefficients of Coulomb friction; none of contacts without.
///
/// # Errors
/// Those of the case.
pub fn laws_with_friction_times(
    problem: &Problem,
    contacts: &[String],
    times: f64,
) -> Result<Vec<Option<Box<dyn Law>>>, CaseError> {
    let mut other = problem.clone();
    for contact in other.contacts.values_mut() {
        if let Some(Friction::Coulomb(coulomb)) = &mut contact.friction {
            let scaled = |mu: &Value| match mu {
                Value::Number(mu) => Value::Number(times * mu),
                Value::Text(text) => Value::Text(format!("{times}*({text})")),
                other => other.clone(),
            };
            coulomb.mu = Components(List(coulomb.mu.0.iter().map(scaled).collect()));
        }
    }
    let planner = Planner::new(&other)?;
    let law = |name: &String| match planner.contact_key(name) {
        Some(key) if matches!(key.friction, Some(Friction::Coulomb(_))) => planner.interface(key),
        _ => Ok(None),
    };
    contacts.iter().map(law).collect()
}
