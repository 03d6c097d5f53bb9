//! Contacts of a system: who may touch whom, tested where, kept how, with which friction.

use super::{Kind, Numbers};
use crate::plan::Planner;
use crate::problem::units::{LENGTH, NONE};
use crate::problem::{self, AxisOn, CaseError, Components, Enforcement, Method, Value};
use signorini_geometry::Vector;
use signorini_mechanics::contact::Part;
use signorini_mechanics::{AxisChoice, Contact, Enforcement as Kept, Sampling, System};

impl Planner<'_> {
    pub(super) fn system_contacts(
        &self,
        numbers: &Numbers,
        system: &System,
        kinds: &[Kind],
    ) -> Result<(Vec<Contact>, Vec<&'static str>), CaseError> {
        let problem = self.problem;
        let mut out = Vec::new();
        let mut methods = Vec::new();
        for (name, key) in &problem.contacts {
            if let Some(adhesion) = &key.adhesion {
                return Err(self.unavailable(adhesion, "adhesion in a system of bodies"));
            }
            let mut add = |name: String, pair: [&String; 2]| -> Result<(), CaseError> {
                let (contact, method) = self.system_contact(&name, key, pair, (numbers, system, kinds))?;
                out.push(contact);
                methods.push(method);
                Ok(())
            };
            match (&key.between, &key.within, &key.all) {
                (Some(pair), None, None) if pair.len() == 2 => add(name.clone(), [&pair[0], &pair[1]])?,
                (None, Some(body), None) => add(name.clone(), [body, body])?,
                (None, None, Some(true)) => {
                    let names: Vec<&String> = numbers.keys().collect();
                    for (k, first) in names.iter().enumerate() {
                        for second in &names[k + 1..] {
                            let fixed = |n: &String| system.bodies[numbers[n]].unknowns() == 0;
                            if !(fixed(first) && fixed(second)) {
                                add(format!("{name}_{first}_{second}"), [first, second])?;
                            }
                        }
                    }
                }
                _ => {
                    return Err(problem
                        .error(key, "who touches whom is not said")
                        .help("between = [\"BODY\", \"BODY\"], the one whose points are tested first; or  within = \"BODY\"; or  all = true"));
                }
            }
        }
        Ok((out, methods))
    }

    fn system_contact(
        &self,
        name: &str,
        key: &problem::Contact,
        on: [&String; 2],
        (numbers, system, kinds): (&Numbers, &System, &[Kind]),
    ) -> Result<(Contact, &'static str), CaseError> {
        let problem = self.problem;
        let mut parts: [Part; 2] = [self.part(on[0], numbers)?, self.part(on[1], numbers)?];
        let mut on = on;
        let body = |part: &Part| system.bodies[part.body].as_ref();
        let points = |part: &Part| body(part).sites(part.group.as_deref(), Sampling::Nodes);
        // A body without points of its own is touched by the other.
        if points(&parts[0]).is_err() && points(&parts[1]).is_ok() {
            parts.swap(0, 1);
            on.swap(0, 1);
        }
        let [slave, master] = parts;
        if body(&slave).unknowns() == 0 && body(&master).unknowns() == 0 {
            return Err(problem.error(key, format!("neither body of contact `{name}` can move")));
        }
        let kind = &kinds[slave.body];
        let straight = match problem.bodies.get(body(&slave).name()) {
            Some(problem::Body::Rope(rope)) => rope.continuity != Some(problem::Continuity::C1),
            _ => false,
        };
        let (sampling, enforcement, method) = self.system_method(key, body(&slave).is_rigid(), straight, kind)?;
        let mut contact =
            Contact::new(name, (slave.clone(), body(&slave)), (master.clone(), body(&master)), sampling, enforcement)
                .map_err(|error| self.misplaced(on[0], &error))?;
        if let Some(friction) = &key.friction {
            let law = self.law(friction, 3)?;
            contact.axis = match friction {
                problem::Friction::Coulomb(coulomb) => self.axis_choice(coulomb)?,
                problem::Friction::Tresca(_) => AxisChoice::Material,
            };
            contact.friction = Some(law);
        }
        Ok((contact, method))
    }

    /// Where contact is tested, how it is kept, and the method in a word.
    fn system_method(
        &self,
        key: &problem::Contact,
        rigid: bool,
        straight: bool,
        kind: &Kind,
    ) -> Result<(Sampling, Kept, &'static str), CaseError> {
        let problem = self.problem;
        // Straight elements meet at nodes, which carry for them.
        let of_curve = if rigid || straight { Sampling::Nodes } else { Sampling::GaussPoints };
        let (sampling, word, stated) = match &key.method {
            None => match kind {
                Kind::Solid => (of_curve, "gauss_point", None),
                Kind::Cells => (of_curve, "cell_surface", None),
                _ => (of_curve, "curve", None),
            },
            Some(Method::CellSurface(k)) if matches!(kind, Kind::Cells) => {
                // Multipliers at as many points as there are functions; penalties wherever there is pressure.
                let at_nodes =
                    matches!(k.enforcement, Some(Enforcement::Multiplier(_) | Enforcement::AugmentedLagrangian(_)));
                let sampling = if at_nodes { Sampling::Nodes } else { Sampling::GaussPoints };
                (sampling, "cell_surface", k.enforcement.as_ref())
            }
            Some(Method::Curve(k)) => (of_curve, "curve", k.enforcement.as_ref()),
            Some(Method::GaussPoint(k)) => (Sampling::GaussPoints, "gauss_point", k.enforcement.as_ref()),
            Some(Method::Node(k)) => (Sampling::Nodes, "node", k.enforcement.as_ref()),
            Some(other) => {
                return Err(problem
                    .error(other, "this method is for other bodies")
                    .help("ropes, beams and free bodies have  method.curve = {},  method.node = {}  and  method.gauss_point = {}"));
            }
        };
        let kept = match stated {
            None if rigid => Kept::AugmentedLagrangian,
            // Every node of straight elements carries by itself; points of Gauss are more than the elements can follow.
            None if sampling == Sampling::Nodes => Kept::Multiplier,
            None => Kept::Penalty { wanted_penetration: None },
            Some(Enforcement::Multiplier(_)) => Kept::Multiplier,
            Some(Enforcement::AugmentedLagrangian(_)) => Kept::AugmentedLagrangian,
            Some(Enforcement::Penalty(k)) => Kept::Penalty {
                wanted_penetration: k
                    .wanted_penetration
                    .as_ref()
                    .map(|v| self.reader.positive(v, LENGTH))
                    .transpose()?,
            },
            Some(nitsche @ Enforcement::Nitsche(_)) => {
                return Err(problem
                    .error(nitsche, "Nitsche's method is for solids")
                    .help("enforcement.multiplier = {}"));
            }
        };
        Ok((sampling, kept, word))
    }

    /// What carries the axis of friction.
    fn axis_choice(&self, key: &problem::CoulombFriction) -> Result<AxisChoice, CaseError> {
        let Some(axis) = &key.axis else {
            return Ok(if key.mu.0.len() == 2 { AxisChoice::Tangent } else { AxisChoice::Material });
        };
        if is_tangent(axis) {
            return Ok(AxisChoice::Tangent);
        }
        let direction = self.position(&axis.0, NONE)?.try_normalize(0.0);
        let direction: Vector<3> = direction.ok_or_else(|| self.problem.error(axis, "the direction has no length"))?;
        Ok(match key.on {
            Some(AxisOn::Master) => AxisChoice::OnMaster(direction),
            _ => AxisChoice::OnSlave(direction),
        })
    }
}

/// Whether an axis is that of a curve.
pub(in crate::plan) fn is_tangent(axis: &Components) -> bool {
    matches!(&axis.0[..], [Value::Text(text)] if text.trim() == "tangent")
}
