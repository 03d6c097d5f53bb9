//! The laws of contacts with more friction than stated, to find out whether friction is what an equilibrium lacks.

use crate::plan::planner::Planner;
use crate::problem::{CaseError, Components, Friction, List, Problem, Value};
use signorini_contact::law::Law;

/// The laws of contacts, by their names, with coefficients of Coulomb friction so many times larger; none of contacts without.
///
/// # Errors
/// Those of the case.
pub fn laws_with_more_friction(
    problem: &Problem,
    contacts: &[String],
    times: f64,
) -> Result<Vec<Option<Box<dyn Law>>>, CaseError> {
    let mut more = problem.clone();
    for contact in more.contacts.values_mut() {
        if let Some(Friction::Coulomb(coulomb)) = &mut contact.friction {
            let larger = |mu: &Value| match mu {
                Value::Number(mu) => Value::Number(times * mu),
                Value::Text(text) => Value::Text(format!("{times}*({text})")),
                other => other.clone(),
            };
            coulomb.mu = Components(List(coulomb.mu.0.iter().map(larger).collect()));
        }
    }
    let planner = Planner::new(&more)?;
    let law = |name: &String| match planner.contact_key(name) {
        Some(key) if matches!(key.friction, Some(Friction::Coulomb(_))) => planner.interface(key),
        _ => Ok(None),
    };
    contacts.iter().map(law).collect()
}
