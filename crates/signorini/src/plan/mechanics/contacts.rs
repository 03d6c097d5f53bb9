//! Contacts of a system: who may touch whom, tested where, kept how, with which friction.

use super::sides::Sides;
use super::{ContactInfo, Kind, Numbers};
use crate::plan::planner::Planner;
use crate::problem::units::{LENGTH, NONE};
use crate::problem::{self, AxisOn, CaseError, Components, CurveForm, Enforcement, Method, Value};
use crate::report::TractionKind;
use signorini_cells::disc_contact::{Centres, CoverFindings, DiscCovering, DiscPairs};
use signorini_geometry::Vector;
use signorini_mechanics::contact::Part;
use signorini_mechanics::{
    AxisChoice, Contact, Enforcement as Kept, Interaction, Pairing, Sampling, System, test_densely,
};
use signorini_rope::curve_pair::{CurveContact, Form};

impl Planner<'_> {
    pub(super) fn system_contacts(
        &self,
        numbers: &Numbers,
        system: &mut System,
        kinds: &[Kind],
    ) -> Result<(Vec<Box<dyn Interaction>>, Vec<ContactInfo>), CaseError> {
        let problem = self.problem;
        let mut out = Vec::new();
        let mut told = Vec::new();
        for (name, key) in &problem.contacts {
            let pairs: Vec<(String, [&String; 2])> = match (&key.between, &key.self_contact, &key.all) {
                (Some(pair), None, None) if pair.len() == 2 && pair[0].trim() == pair[1].trim() => {
                    let message = format!("`between` names `{}` twice", pair[0].trim());
                    return Err(problem
                        .error(pair, message)
                        .help(format!("for self-contact:  self_contact = \"{}\"", pair[0].trim())));
                }
                (Some(pair), None, None) if pair.len() == 2 => vec![(name.clone(), [&pair[0], &pair[1]])],
                (None, _, _) if key.slave.is_some() => {
                    return Err(problem
                        .error(key.slave.as_ref().expect("it is stated"), "`slave` requires `between`")
                        .help("leave `slave` out"));
                }
                (None, Some(body), None) => vec![(name.clone(), [body, body])],
                (None, None, Some(true)) => {
                    let names: Vec<&String> = numbers.keys().collect();
                    let fixed = |n: &String| system.bodies[numbers[n]].unknowns() == 0;
                    let all = (0..names.len()).flat_map(|k| (k + 1..names.len()).map(move |l| [k, l]));
                    let all = all.map(|[k, l]| [names[k], names[l]]);
                    let moving = all.filter(|[first, second]| !(fixed(first) && fixed(second)));
                    let (tested, untested): (Vec<_>, Vec<_>) =
                        moving.partition(|pair| !cannot_meet(system, numbers, pair));
                    for [first, second] in untested {
                        self.warn(format!(
                            "contact `{name}`: contact between `{first}` and `{second}` is not tested: rigid bodies \
                             of these shapes have no slave points (spheres and triangle meshes have)"
                        ));
                    }
                    tested.into_iter().map(|pair| (format!("{name}_{}_{}", pair[0], pair[1]), pair)).collect()
                }
                _ => {
                    return Err(problem
                        .error(key, "the bodies of the contact are missing")
                        .help("between = [\"BODY\", \"BODY\"]; or  self_contact = \"BODY\"; or  all = true"));
                }
            };
            for (name, pair) in pairs {
                let (contact, mut tested) = self.system_contact(&name, key, pair, (numbers, system, kinds))?;
                self.check_sliding(key, &tested, contact.parts(), (system, kinds))?;
                tested.swapped = contact.bodies()[0] != self.part(pair[0], numbers)?.body;
                out.push(contact);
                told.push(tested);
            }
        }
        Ok((out, told))
    }

    fn system_contact(
        &self,
        name: &str,
        key: &problem::Contact,
        on: [&String; 2],
        (numbers, system, kinds): (&Numbers, &mut System, &[Kind]),
    ) -> Result<(Box<dyn Interaction>, ContactInfo), CaseError> {
        let problem = self.problem;
        let Sides { parts, swapped } = self.sides(key, on, (numbers, system, kinds))?;
        let on = if swapped { [on[1], on[0]] } else { on };
        let body = |part: &Part| system.bodies[part.body].as_ref();
        let [slave, master] = parts;
        if body(&slave).unknowns() == 0 && body(&master).unknowns() == 0 {
            return Err(
                problem.error(key, format!("both bodies of contact `{name}` are fixed or have a prescribed motion"))
            );
        }
        if let Some(found) = self.tied(name, key, [&slave, &master], (system, kinds))? {
            return Ok(found);
        }
        if let Some(found) = self.between_curves(name, key, [&slave, &master], system)? {
            return Ok(found);
        }
        if let Some(found) = self.by_mortar(name, key, [&slave, &master], (system, kinds))? {
            return Ok(found);
        }
        if let Some(Method::Discs(stated)) = &key.method {
            return self.by_discs(name, key, stated, [&slave, &master], system);
        }
        let kind = &kinds[slave.body];
        let straight = match problem.bodies.get(body(&slave).name()) {
            Some(problem::Body::Rope(rope)) => rope.continuity != Some(problem::Continuity::C1),
            _ => false,
        };
        // The stress of cells keeps them from what they touch, if nothing else is stated: their pressure then does not ripple.
        // Lines of load have penalties.
        let is_inelastic = body(&slave).is_inelastic();
        let by_stress = !matches!(kinds[master.body], Kind::Curve { .. }) && !is_inelastic;
        let is_rigid = body(&slave).is_rigid();
        let (sampling, enforcement, method) =
            self.system_method(key, (is_rigid, by_stress), (straight, body(&slave).is_linear(), is_inelastic), kind)?;
        if sampling == Sampling::GaussPoints {
            test_densely(&mut system.bodies, [&slave, &master]);
        }
        let body = |part: &Part| system.bodies[part.body].as_ref();
        let mut contact =
            Contact::new(name, (slave.clone(), body(&slave)), (master.clone(), body(&master)), sampling, enforcement)
                .map_err(|error| {
                if cannot_meet(system, numbers, &on) {
                    return problem
                        .error(key, format!("contact `{name}`: neither of the two rigid bodies has slave points"))
                        .help(
                            "use a sphere, a box or a triangle mesh for one of them, or a solid of a stiff material",
                        );
                }
                let side = on.iter().find(|on| on.split(':').next().is_some_and(|name| name.trim() == error.body()));
                self.misplaced(side.unwrap_or(&on[0]), &error)
            })?;
        let is_line = matches!(kind, Kind::Curve { .. }) || self::is_curve(system, &slave);
        if is_line || matches!(kinds[master.body], Kind::Curve { .. }) {
            self.refuse_of_curves(key)?;
        }
        if let Some(problem::Friction::Coulomb(coulomb)) = &key.friction {
            contact.axis = self.axis_choice(coulomb)?;
        }
        contact.law.friction = self.interface(key)?;
        contact.restitution = self.restitution(key)?;
        let is_polyhedron = |part: &Part| body(part).polyhedron(&body(part).start()).is_some();
        let grows = contact.law.friction.as_ref().is_none_or(|law| law.per_pressure().is_some());
        if let (Some(friction), false, true, true) =
            (&key.friction, grows, is_polyhedron(&slave), is_polyhedron(&master))
        {
            let message = "friction that does not grow with pressure acts per area, and rigid bodies of flat faces touch in points";
            return Err(problem.error(friction, message).help("friction.coulomb = { mu = 0.3 }"));
        }
        // What of a body of small strains faces another part of it turns little within an increment.
        let keeps = contact.law.friction.is_none() || matches!(kind, Kind::Cells);
        if slave.body == master.body && body(&slave).is_linear() && keeps {
            contact.pairing = Pairing::AtStart;
        }
        let along_a_curve = matches!(kind, Kind::Curve { .. });
        let is_curve = self::is_curve(system, &slave);
        let carries = match kind {
            Kind::Rigid { .. } => TractionKind::Force,
            Kind::Curve { .. } => TractionKind::LineLoad,
            _ if is_curve => TractionKind::LineLoad,
            _ => TractionKind::Pressure,
        };
        let at_nodes = matches!(kind, Kind::Cells) && sampling == Sampling::Nodes;
        let tested = ContactInfo { along_a_curve, carries, at_nodes, ..ContactInfo::by(method, contact.axis) };
        Ok((Box::new(contact), tested))
    }

    /// The coefficient of restitution of a contact.
    fn restitution(&self, key: &problem::Contact) -> Result<f64, CaseError> {
        match &key.restitution {
            Some(e) if !(0.0..=1.0).contains(e) => Err(self
                .problem
                .error(e, format!("a coefficient of restitution of {e} is not between 0 and 1"))
                .help("0 where bodies that strike do not rebound, 1 where they rebound without loss of energy")),
            stated => Ok(stated.unwrap_or(0.0)),
        }
    }

    /// Contact between two curves, or of one with itself, where no other method is stated.
    fn between_curves(
        &self,
        name: &str,
        key: &problem::Contact,
        [slave, master]: [&Part; 2],
        system: &System,
    ) -> Result<Option<(Box<dyn Interaction>, ContactInfo)>, CaseError> {
        let curve = |p: &&Part| system.bodies[p.body].curve(p.group.as_deref());
        let curves = [slave, master].iter().all(|p| curve(p).is_some());
        if !curves || !matches!(&key.method, None | Some(Method::Curve(_))) {
            return Ok(None);
        }
        self.refuse_of_curves(key)?;
        let stated = key.method.as_ref().and_then(|m| if let Method::Curve(k) = m { Some(k) } else { None });
        let kept = self.kept(stated.and_then(|k| k.enforcement.as_ref()), Kept::AugmentedLagrangian, "curve")?;
        let side = |part: &Part| (part.clone(), system.bodies[part.body].as_ref());
        let mut contact = CurveContact::new(name, side(slave), side(master), kept)
            .map_err(|e| self.problem.error(key, e.to_string()))?;
        let is_sharp = [slave, master].iter().all(|p| curve(p).is_some_and(|c| c.radius() == 0.0));
        match stated.and_then(|k| k.form) {
            Some(form @ (CurveForm::Line | CurveForm::Blend)) if is_sharp => {
                let word = if form == CurveForm::Line { "line" } else { "blend" };
                return Err(self
                    .problem
                    .error(
                        key,
                        format!(
                            "form = \"{word}\" requires a radius: curves without a radius have no gap along each \
                             other"
                        ),
                    )
                    .help("form = \"point\" for contact at crossing points; or give one of them a radius"));
            }
            Some(CurveForm::Point) => contact.form = Form::Point,
            Some(CurveForm::Line) => contact.form = Form::Line,
            Some(CurveForm::Blend) | None => {}
        }
        let axis = match &key.friction {
            Some(friction) => {
                contact.law.friction = Some(self.law(friction)?);
                match friction {
                    problem::Friction::Coulomb(coulomb) => self.axis_choice(coulomb)?,
                    _ => AxisChoice::Tangent,
                }
            }
            None => AxisChoice::Tangent,
        };
        if let (AxisChoice::OnSlave(_) | AxisChoice::OnMaster(_), Some(problem::Friction::Coulomb(law))) =
            (&axis, &key.friction)
        {
            let at = law.axis.as_ref().map_or_else(|| self.key(key), |axis| self.key(axis));
            return Err(self
                .problem
                .error(&at, "between curves the axis of friction is the tangent of the first curve")
                .help("axis = \"tangent\", or leave it out"));
        }
        Ok(Some((Box::new(contact), ContactInfo { carries: TractionKind::Force, ..ContactInfo::by("curve", axis) })))
    }

    /// Refuses laws that ropes, beams and edges do not have.
    fn refuse_of_curves(&self, key: &problem::Contact) -> Result<(), CaseError> {
        self.refuse_interface(key, "in contact of curves")?;
        match &key.adhesion {
            Some(adhesion) => Err(self.unavailable(adhesion, "adhesion of ropes, beams and edges")),
            None => Ok(()),
        }
    }

    /// Contact by discs on both surfaces.
    fn by_discs(
        &self,
        name: &str,
        key: &problem::Contact,
        stated: &problem::DiscMethod,
        [first, second]: [&Part; 2],
        system: &System,
    ) -> Result<(Box<dyn Interaction>, ContactInfo), CaseError> {
        let problem = self.problem;
        if let Some(friction) = &key.friction {
            return Err(problem
                .error(friction, "contact by discs is frictionless")
                .help("method.cell_surface = {} for contact with friction"));
        }
        self.refuse_interface(key, "in contact by discs")?;
        if let Some(adhesion) = &key.adhesion {
            return Err(problem.error(adhesion, "contact by discs has no adhesion").help("method.cell_surface = {}"));
        }
        let length = |value: &Option<Value>| value.as_ref().map(|v| self.reader.positive(v, LENGTH)).transpose();
        let cover = DiscCovering {
            radius: length(&stated.radius)?,
            spacing: length(&stated.spacing)?,
            centres: match stated.centres {
                Some(problem::DiscCentres::OnBoundary) => Centres::OnBoundary,
                _ => Centres::Within,
            },
        };
        let wanted = stated.penalty.as_ref().map(|p| length(&p.penetration)).transpose()?.flatten();
        let body = |part: &Part| (part.clone(), system.bodies[part.body].as_ref());
        let other = (first != second).then(|| body(second));
        let (pairs, found) = DiscPairs::new(name, body(first), other, &cover, wanted)
            .map_err(|e| problem.error(key, e.to_string()).help("method.cell_surface = {}"))?;
        let (mut notes, mut warnings) = (Vec::new(), Vec::new());
        let overlap = pairs.overlap_at_start();
        if overlap > 0.0 {
            warnings.push(format!(
                "contact `{name}`: discs overlap by {overlap:.3e} at the start, and the bodies repel each other at \
                 once: with centres on the boundary the bodies must start two radii apart (centres = \"within\" \
                 avoids this)"
            ));
        }
        for (f, part) in found.iter().zip([first, second]) {
            let body = system.bodies[part.body].name();
            let CoverFindings { discs, radius, spacing, thickness } = *f;
            notes.push(format!(
                "contact `{name}`: {discs} discs of radius {radius:.4e} on `{body}`, at most {spacing:.4e} apart"
            ));
            if f.is_too_small() {
                warnings.push(format!(
                    "contact `{name}`: discs of radius {radius:.3e} on `{body}` have a spacing of {spacing:.3e}, so \
                     other discs slip through: the radius should be at least the spacing (radius = {spacing:.3e}, or \
                     a smaller spacing)"
                ));
            }
            if f.is_too_large() {
                warnings.push(format!(
                    "contact `{name}`: discs of radius {radius:.3e} do not fit into `{body}`, which is \
                     {thickness:.3e} thick: their centres lie beyond those of the opposite face (use a radius below \
                     {:.3e})",
                    0.5 * thickness
                ));
            }
        }
        let tested = ContactInfo { notes, warnings, ..ContactInfo::by("discs", AxisChoice::Material) };
        Ok((Box::new(pairs), tested))
    }

    /// How a contact is kept.
    pub(in crate::plan) fn kept(
        &self,
        stated: Option<&Enforcement>,
        otherwise: Kept,
        method: &str,
    ) -> Result<Kept, CaseError> {
        Ok(match stated {
            None => otherwise,
            Some(Enforcement::Multiplier(_)) => Kept::Multiplier,
            Some(Enforcement::AugmentedLagrangian(_)) => Kept::AugmentedLagrangian,
            Some(Enforcement::Penalty(k)) => Kept::Penalty { wanted_penetration: self.wanted_penetration(k)? },
            Some(Enforcement::Nitsche(_)) if method == "cell_surface" => Kept::Nitsche,
            Some(nitsche @ Enforcement::Nitsche(_)) => {
                return Err(self
                    .problem
                    .error(nitsche, "Nitsche's method is by mortar or at quadrature points of linear elastic solids, and for finite cells")
                    .help("enforcement.multiplier = {}"));
            }
        })
    }

    /// The penetration that a penalty may leave; none where it is left to the program.
    fn wanted_penetration(&self, key: &problem::Penalty) -> Result<Option<f64>, CaseError> {
        key.penetration.as_ref().map(|v| self.reader.positive(v, LENGTH)).transpose()
    }

    /// Where contact is tested, how it is kept, and the method in a word.
    fn system_method(
        &self,
        key: &problem::Contact,
        (rigid, by_stress): (bool, bool),
        (straight, knows_stress, is_inelastic): (bool, bool, bool),
        kind: &Kind,
    ) -> Result<(Sampling, Kept, &'static str), CaseError> {
        let problem = self.problem;
        // Straight elements meet at nodes, which carry for them.
        let of_curve = if rigid || straight { Sampling::Nodes } else { Sampling::GaussPoints };
        if let (Kind::Solid, Some(Method::Mortar(k) | Method::GaussPoint(k))) = (kind, &key.method)
            && let Some(nitsche @ Enforcement::Nitsche(_)) = &k.enforcement
        {
            if !knows_stress {
                let message = "Nitsche's method is for linear elastic solids and for finite cells";
                return Err(problem.error(nitsche, message).help("enforcement.multiplier = {}"));
            }
            return Ok((Sampling::GaussPoints, Kept::Nitsche, "gauss_point"));
        }
        let (sampling, word, stated) = match &key.method {
            None => match kind {
                Kind::Solid => (of_curve, "gauss_point", None),
                // Of stresses with a history nothing is known on the surface: multipliers at as many points as functions.
                Kind::Cells if is_inelastic && !rigid => (Sampling::Nodes, "cell_surface", None),
                Kind::Cells => (of_curve, "cell_surface", None),
                _ => (of_curve, "curve", None),
            },
            Some(Method::CellSurface(k)) if matches!(kind, Kind::Cells) => {
                // Multipliers at as many points as there are functions; penalties wherever there is pressure.
                let at_nodes = is_inelastic && k.enforcement.is_none()
                    || matches!(k.enforcement, Some(Enforcement::Multiplier(_) | Enforcement::AugmentedLagrangian(_)));
                let sampling = if at_nodes { Sampling::Nodes } else { Sampling::GaussPoints };
                (sampling, "cell_surface", k.enforcement.as_ref())
            }
            Some(Method::Curve(k)) => (of_curve, "curve", k.enforcement.as_ref()),
            Some(Method::GaussPoint(k)) => {
                let word = if matches!(kind, Kind::Cells) { "cell_surface" } else { "gauss_point" };
                (Sampling::GaussPoints, word, k.enforcement.as_ref())
            }
            Some(Method::Node(k)) => (Sampling::Nodes, "node", k.enforcement.as_ref()),
            Some(other) => {
                return Err(problem.error(other, "this method is for other bodies").help(
                    "for ropes, beams and free bodies:  method.curve = {},  method.node = {}  or  method.gauss_point \
                     = {}; for solids also  method.mortar = {}",
                ));
            }
        };
        let otherwise = match sampling {
            _ if rigid => Kept::AugmentedLagrangian,
            // Every node of straight elements carries by itself; points of Gauss are more than the elements can follow.
            Sampling::Nodes => Kept::Multiplier,
            Sampling::GaussPoints if by_stress && word == "cell_surface" => Kept::Nitsche,
            Sampling::GaussPoints => Kept::Penalty { wanted_penetration: None },
        };
        if let (Some(nitsche @ Enforcement::Nitsche(_)), true) = (stated, is_inelastic) {
            let message = "Nitsche's method is for elastic bodies: the stress of others is not known on their surface";
            return Err(problem.error(nitsche, message).help("enforcement.multiplier = {}"));
        }
        let kept = self.kept(stated, otherwise, word)?;
        Ok((sampling, kept, word))
    }

    /// What carries the axis of friction.
    pub(super) fn axis_choice(&self, key: &problem::CoulombFriction) -> Result<AxisChoice, CaseError> {
        if key.axis.is_none() && key.mu.0.len() == 2 && self.space != problem::Space::ThreeD {
            let message = "in the plane slip has one direction, so there is one coefficient";
            return Err(self.problem.error(&key.mu, message).help("mu = 0.3"));
        }
        let Some(axis) = &key.axis else {
            return Ok(if key.mu.0.len() == 2 { AxisChoice::Tangent } else { AxisChoice::Material });
        };
        if is_tangent(axis) {
            return Ok(AxisChoice::Tangent);
        }
        let direction = self.position(&axis.0, NONE)?.try_normalize(0.0);
        let direction: Vector<3> = direction.ok_or_else(|| self.problem.error(axis, "the direction vector is zero"))?;
        Ok(match key.on {
            Some(AxisOn::Master) => AxisChoice::OnMaster(direction),
            _ => AxisChoice::OnSlave(direction),
        })
    }
}

/// Whether a place is a curve: a rope, a beam, an edge of a solid.
fn is_curve(system: &System, part: &Part) -> bool {
    system.bodies[part.body].curve(part.group.as_deref()).is_some()
}

/// Whether two bodies are both rigid, and neither has points that could be tested against the other.
fn cannot_meet(system: &System, numbers: &Numbers, pair: &[&String; 2]) -> bool {
    pair.iter().all(|on| {
        let name = on.split(':').next().unwrap_or_default().trim();
        let body = numbers.get(name).map(|number| &system.bodies[*number]);
        body.is_some_and(|body| body.is_rigid() && body.sites(None, Sampling::Nodes).is_err())
    })
}

/// Whether an axis is that of a curve.
pub(in crate::plan) fn is_tangent(axis: &Components) -> bool {
    matches!(&axis.0[..], [Value::Text(text)] if text.trim() == "tangent")
}
