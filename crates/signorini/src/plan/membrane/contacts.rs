//! Reads what a membrane may touch.

use super::PlannedSupport;
use crate::plan::planner::Planner;
use crate::plan::surface::{self, Contact};
use crate::problem::units::FORCE_PER_LENGTH;
use crate::problem::{self, Body, CaseError, suggestion};
use crate::report::Warning;
use signorini_fem::Grid;
use signorini_geometry::{Point, Vector};
use signorini_membrane::history::MethodChoice;

impl Planner<'_> {
    /// All contacts of the membrane, which have one method.
    pub(super) fn contacts<const D: usize>(
        &self,
        body: &str,
        supports: &[PlannedSupport],
        grid: &Grid<D>,
        warnings: &mut Vec<Warning>,
    ) -> Result<(Vec<Contact>, MethodChoice), CaseError> {
        let problem = self.problem;
        let levels: Option<Vec<f64>> = supports.iter().map(|s| s.displacement.expression.constant()).collect();
        let corner = |x: Point<D>| Vector::<2>::new(x[0], if D == 2 { x[D - 1] } else { 0.0 });
        let mut scene = surface::Scene {
            level: levels.and_then(|l| l.into_iter().reduce(f64::max)),
            around: [corner(grid.bounds().min), corner(grid.bounds().max)],
            resolution: 0.5 * grid.h(),
            warnings,
        };
        let mut out: Vec<Contact> = Vec::new();
        let stated = problem.contacts.values().find(|c| c.method.is_some());
        let size = grid.bounds().size().max();
        let method = stated.map_or(Ok(MethodChoice::default()), |c| self.method(c, size))?;
        for (name, key) in &problem.contacts {
            let contact = key;
            if let Some(friction) = &contact.friction {
                return Err(self
                    .unavailable(friction, "friction of a membrane")
                    .help("leave `friction` out: contact of membranes is frictionless; `adhesion` is available"));
            }
            self.refuse_interface(contact, "in contact of a membrane")?;
            if let Some(strength) = contact.adhesion.as_ref().and_then(|a| a.strength.as_ref()) {
                return Err(problem
                    .error(strength, "the adhesion of a membrane acts at the front of the zone, without a strength")
                    .help("leave `strength` out"));
            }
            if let Some(own) = &contact.method
                && self.method(contact, size)? != method
            {
                return Err(problem
                    .error(own, format!("`{name}` has another method than the contact before it"))
                    .help("all contacts of a membrane are solved together: give the method once"));
            }
            let adhesion = match &contact.adhesion {
                None => None,
                Some(adhesion) => {
                    let placed = self.placed(&adhesion.energy, FORCE_PER_LENGTH)?;
                    (placed.expression.constant() != Some(0.0)).then_some(placed)
                }
            };
            if let (Some(adhesion), MethodChoice::ActiveSet(_)) = (&adhesion, method) {
                return Err(problem
                    .error(&adhesion.key, "method.active_set has no adhesion")
                    .help("method.inequality_level_set = {}"));
            }
            let touched = self.touched(body, key)?;
            for other in &touched {
                if let Some(before) = out.iter().find(|c| c.body == *other) {
                    let message = format!("`{other}` already has the contact `{}`", before.name);
                    return Err(problem
                        .error(key, message)
                        .help("each body has at most one contact with the membrane"));
                }
                let Some(Body::Rigid(rigid)) = problem.bodies.get(other) else {
                    return Err(problem.error(key, format!("`{other}` is not rigid")));
                };
                let name = if touched.len() == 1 { name.clone() } else { format!("{name}:{other}") };
                let contact = surface::read(self, &name, other, rigid, &mut scene)?;
                out.push(Contact { adhesion: adhesion.clone(), ..contact });
            }
        }
        Ok((out, method))
    }

    /// The rigid bodies that a contact names.
    fn touched(&self, body: &str, key: &problem::Contact) -> Result<Vec<String>, CaseError> {
        let problem = self.problem;
        let rigid: Vec<&str> =
            problem.bodies.iter().filter(|(_, b)| matches!(b, Body::Rigid(_))).map(|(n, _)| n.as_str()).collect();
        match (&key.between, &key.self_contact, &key.all) {
            (Some(pair), None, None) => {
                let bodies: Vec<&str> = problem.bodies.keys().map(String::as_str).collect();
                for b in pair {
                    let plain = b.split(':').next().unwrap_or("");
                    if !bodies.contains(&plain) {
                        return Err(problem
                            .error(b, format!("there is no body `{plain}`"))
                            .help(suggestion(plain, &bodies)));
                    }
                }
                let others: Vec<&String> = pair.iter().filter(|b| *b != body).collect();
                let known = others.iter().all(|b| rigid.contains(&b.as_str()));
                match known && others.len() + 1 == pair.len() && !others.is_empty() {
                    true => Ok(others.into_iter().cloned().collect()),
                    false => Err(problem
                        .error(pair, "a contact is between the membrane and a rigid body")
                        .help(format!("between = [\"{body}\", \"{}\"]", rigid.first().unwrap_or(&"floor")))),
                }
            }
            (None, None, Some(all)) if *all => match rigid.is_empty() {
                false => Ok(rigid.into_iter().map(str::to_string).collect()),
                true => Err(problem
                    .error(all, "the case has no rigid body for the contact")
                    .help("add for example  [bodies.floor.rigid]  shape.height = \"-0.1\"")),
            },
            _ => Err(problem
                .error(key, "the bodies of the contact are missing or given twice")
                .help(format!("between = [\"{body}\", \"{}\"]", rigid.first().unwrap_or(&"floor")))),
        }
    }
}
