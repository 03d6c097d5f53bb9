//! Contact by mortar between bodies of a system.

use super::places::normals_of;
use super::{ContactInfo, Kind};
use crate::plan::planner::Planner;
use crate::problem::{self, CaseError, Enforcement, Friction, Method, Sliding};
use signorini_mechanics::contact::Part;
use signorini_mechanics::{AxisChoice, Enforcement as Kept, Interaction, Mortar, System};

/// Sine of the angle to the normal from which on a direction is one along the surface.
const ALONG: f64 = 1e-6;

impl Planner<'_> {
    /// Contact of a solid with another one, or with a rigid body, where `method.mortar` is stated or no method at all.
    pub(super) fn by_mortar(
        &self,
        name: &str,
        key: &problem::Contact,
        [slave, master]: [&Part; 2],
        (system, kinds): (&System, &[Kind]),
    ) -> Result<Option<(Box<dyn Interaction>, ContactInfo)>, CaseError> {
        let problem = self.problem;
        let body = |part: &Part| system.bodies[part.body].as_ref();
        let unfit = if !matches!(kinds[slave.body], Kind::Solid) {
            Some((slave, "has no faces for mortar: the slave must be a solid"))
        } else if !matches!(kinds[master.body], Kind::Solid | Kind::Rigid { .. }) {
            Some((master, "has no faces for mortar: the master must be a solid or a rigid body"))
        } else {
            None
        };
        let stated = match (&key.method, unfit) {
            // By the stress at points, without unknowns of its own.
            (Some(Method::Mortar(problem::SolidMethod { enforcement: Some(Enforcement::Nitsche(_)), .. })), None) => {
                return Ok(None);
            }
            (Some(Method::Mortar(stated)), None) => stated.enforcement.as_ref(),
            (Some(method @ Method::Mortar(_)), Some((part, what))) => {
                return Err(problem.error(method, format!("`{}` {what}", body(part).name())).help(
                    "method.gauss_point = {}  or  method.node = {}, for finite cells  method.cell_surface = {}, or \
                     leave the method out",
                ));
            }
            // The axis of friction that turns with a free body is known at single points only.
            (None, None) if !matches!(kinds[master.body], Kind::Rigid { is_free: true, .. }) => None,
            _ => return Ok(None),
        };
        let kept = self.kept(stated, Kept::Multiplier, "mortar")?;
        let mut contact = Mortar::new(name, (slave.clone(), body(slave)), (master.clone(), body(master)), kept)
            .map_err(|error| problem.error(key, error.to_string()))?;
        contact.law.friction = self.interface(key)?;
        if let Some(Friction::Coulomb(coulomb)) = &key.friction {
            contact.set_axis(self.axis_choice(coulomb)?);
            self.check_axis(coulomb, contact.axis(), &kinds[master.body])?;
            self.check_along(coulomb, contact.axis(), (slave, system))?;
        }
        let slides_little = key.sliding == Some(Sliding::Small);
        if slides_little {
            contact.slides_little();
        }
        let tested = ContactInfo { slides_little, ..ContactInfo::by("mortar", contact.axis()) };
        Ok(Some((Box::new(contact), tested)))
    }

    /// Whether small sliding may be chosen.
    pub(super) fn check_sliding(
        &self,
        key: &problem::Contact,
        tested: &ContactInfo,
        bodies: [&Part; 2],
        (system, kinds): (&System, &[Kind]),
    ) -> Result<(), CaseError> {
        let Some(sliding) = key.sliding.as_ref().filter(|sliding| **sliding == Sliding::Small) else { return Ok(()) };
        let fits = |part: &&Part| match kinds[part.body] {
            Kind::Rigid { is_free, .. } => !is_free,
            _ => system.bodies[part.body].is_linear(),
        };
        let message = match bodies.iter().find(|part| !fits(part)) {
            Some(part) => format!(
                "small sliding is for solids of small strain and rigid bodies that do not move freely, but not for `{}`",
                system.bodies[part.body].name()
            ),
            None if tested.method != "mortar" => "small sliding requires contact by mortar".to_string(),
            None => return Ok(()),
        };
        Err(self.problem.error(sliding, message).help("leave `sliding` out: any sliding distance is possible then"))
    }

    /// An axis that no face of the slave has along itself.
    fn check_along(
        &self,
        law: &problem::CoulombFriction,
        axis: AxisChoice,
        (slave, system): (&Part, &System),
    ) -> Result<(), CaseError> {
        let (AxisChoice::OnSlave(v) | AxisChoice::OnMaster(v)) = axis else { return Ok(()) };
        let body = system.bodies[slave.body].as_ref();
        let start = body.start();
        let normals = body.surface(slave.group.as_deref(), &start).map_or_else(Vec::new, |s| normals_of(s.as_ref()));
        let at = law.axis.as_ref().map_or_else(|| self.key(&law.mu), |axis| self.key(axis));
        match normals.is_empty() || normals.iter().any(|n| n.cross(&v).norm() > ALONG) {
            true => Ok(()),
            false => Err(self
                .problem
                .error(&at, "the axis of friction is normal to the surface")
                .help("give a direction along the surface of the slave")),
        }
    }

    /// Axes of friction that a mortar does not have.
    fn check_axis(&self, law: &problem::CoulombFriction, axis: AxisChoice, master: &Kind) -> Result<(), CaseError> {
        let at = || law.axis.as_ref().map_or_else(|| self.key(&law.mu), |axis| self.key(axis));
        if axis == AxisChoice::Tangent && self.space == problem::Space::ThreeD {
            return Err(self
                .problem
                .error(
                    &at(),
                    "a surface has no tangent direction of its own: two coefficients of friction require an axis",
                )
                .help("axis = [1, 0, 0]"));
        }
        if matches!((axis, master), (AxisChoice::OnMaster(_), Kind::Rigid { is_free: true, .. })) {
            return Err(self
                .problem
                .error(&at(), "with mortar the axes of friction do not rotate with a free body")
                .help("on = \"slave\", or method.gauss_point = {}"));
        }
        Ok(())
    }
}
