//! Contacts of solids: their sides, method and enforcement.

use super::statement::{Opposite, PlannedBody, SolidContact};
use crate::plan::mechanics::contacts::SMALL_STRAIN;
use crate::plan::planner::Planner;
use crate::plan::rigid;
use crate::problem::units::LENGTH;
use crate::problem::{self, Body, CaseError, Enforcement, Method};
use signorini_fem::Side;
use signorini_geometry::Point;
use signorini_solid::Method as ContactMethod;

impl Planner<'_> {
    /// The penetration that a penalty may leave; none where it is left to the program.
    pub(in crate::plan) fn wanted_penetration(&self, key: &problem::Penalty) -> Result<Option<f64>, CaseError> {
        key.wanted_penetration.as_ref().map(|v| self.reader.positive(v, LENGTH)).transpose()
    }

    fn solid_method(&self, key: &problem::Contact) -> Result<(ContactMethod, signorini_solid::Enforcement), CaseError> {
        use signorini_solid::Enforcement as Kept;
        let Some(method) = &key.method else { return Ok((ContactMethod::Mortar, Kept::Multiplier)) };
        let (which, stated) = match method {
            Method::Mortar(k) => (ContactMethod::Mortar, &k.enforcement),
            Method::Node(k) => (ContactMethod::Node, &k.enforcement),
            Method::GaussPoint(k) => (ContactMethod::GaussPoint, &k.enforcement),
            _ => {
                return Err(self
                    .problem
                    .error(method, "this method is for membranes")
                    .help("for solids:  method.mortar = {},  method.node = {}  or  method.gauss_point = {}"));
            }
        };
        let kept = match stated {
            None if which == ContactMethod::GaussPoint => Kept::Penalty { wanted_penetration: None },
            Some(multiplier @ Enforcement::Multiplier(_)) if which == ContactMethod::GaussPoint => {
                return Err(self
                    .problem
                    .error(multiplier, "multipliers at every quadrature point over-constrain the surface")
                    .help("enforcement.penalty = {}, or method.mortar = {}"));
            }
            Some(nitsche @ Enforcement::Nitsche(_)) if which == ContactMethod::Node => {
                return Err(self
                    .problem
                    .error(nitsche, "Nitsche's method is available for mortar and at quadrature points only")
                    .help("method.mortar = { enforcement.nitsche = {} }"));
            }
            stated => self.kept(stated.as_ref(), Kept::Multiplier, SMALL_STRAIN)?,
        };
        Ok((which, kept))
    }

    /// The sides of a place, and whether they are all of the body.
    fn contact_side<const D: usize>(
        &self,
        on: &String,
        bodies: &[PlannedBody<D>],
    ) -> Result<(usize, Vec<Side>, bool), CaseError> {
        let (body, group) = self.solid_place(on, bodies)?;
        let whole = group.is_none();
        let sides = group.map_or_else(|| bodies[body].mesh.boundary(), |g| g.sides);
        if sides.is_empty() {
            return Err(self.problem.error(on, "this group contains no sides of cells"));
        }
        Ok((body, sides, whole))
    }

    pub(super) fn solid_contacts<const D: usize>(
        &self,
        bodies: &[PlannedBody<D>],
    ) -> Result<Vec<SolidContact<D>>, CaseError> {
        let problem = self.problem;
        let around = around(bodies);
        let mut out = Vec::new();
        for (name, key) in &problem.contacts {
            if let Some(within) = &key.within {
                return Err(self.unavailable(within, "self-contact"));
            }
            if let Some(adhesion) = &key.adhesion
                && self.reader.number(&adhesion.energy, [-1, 1, 0])? != 0.0
            {
                return Err(self.unavailable(&adhesion.energy, "adhesion of solids"));
            }
            let (method, enforcement) = self.solid_method(key)?;
            let friction = key.friction.as_ref().map(|friction| self.friction::<D>(friction)).transpose()?;
            let mut add = |name: String, (body, sides, whole): (usize, Vec<Side>, bool), opposite| {
                let friction = friction.clone();
                out.push(SolidContact { name, body, sides, whole, opposite, method, enforcement, friction });
            };
            match (&key.between, &key.all) {
                (Some(pair), None) if pair.len() == 2 => {
                    let rigid = |on: &String| match problem.bodies.get(on)? {
                        Body::Rigid(rigid) => Some(rigid),
                        _ => None,
                    };
                    let [first, second] = [&pair[0], &pair[1]];
                    // The slave is the solid, in whichever order they are named.
                    let [first, second] = if rigid(first).is_some() { [second, first] } else { [first, second] };
                    if rigid(first).is_some() {
                        return Err(problem.error(pair, "both bodies of this contact are rigid").help(format!(
                            "a contact is between solids, or between a solid and a rigid body: `{}`, for example",
                            bodies[0].name
                        )));
                    }
                    let opposite = match rigid(second) {
                        Some(body) => Opposite::Rigid(rigid::read::<D>(self, second, body, &around)?),
                        None => {
                            let (body, sides, whole) = self.contact_side(second, bodies)?;
                            Opposite::Body { body, sides, whole }
                        }
                    };
                    add(name.clone(), self.contact_side(first, bodies)?, opposite);
                }
                (None, Some(all)) if *all => {
                    let side = |k: usize| (k, bodies[k].mesh.boundary(), true);
                    for slave in 0..bodies.len() {
                        for master in slave + 1..bodies.len() {
                            let (body, sides, whole) = side(master);
                            let name = format!("{name}_{}_{}", bodies[slave].name, bodies[master].name);
                            add(name, side(slave), Opposite::Body { body, sides, whole });
                        }
                        for (other, body) in &problem.bodies {
                            if let Body::Rigid(rigid) = body {
                                let rigid = Opposite::Rigid(rigid::read::<D>(self, other, rigid, &around)?);
                                add(format!("{name}_{}_{other}", bodies[slave].name), side(slave), rigid);
                            }
                        }
                    }
                }
                _ => {
                    return Err(problem.error(key, "the bodies of the contact are missing").help(
                        "between = [\"BODY:GROUP\", \"BODY:GROUP\"], for two solids the slave first; or  all = true",
                    ));
                }
            }
        }
        Ok(out)
    }
}

/// The box around all bodies, twice as long.
fn around<const D: usize>(bodies: &[PlannedBody<D>]) -> signorini_geometry::Aabb<3> {
    let all = || bodies.iter().flat_map(|b| b.mesh.nodes());
    let low = all().fold(Point::<D>::repeat(f64::INFINITY), |l, x| l.inf(x));
    let high = all().fold(Point::<D>::repeat(f64::NEG_INFINITY), |h, x| h.sup(x));
    let pad = 0.5 * (high - low).amax();
    let spatial = |x: &Point<D>, by: f64| Point::<3>::from_fn(|k, _| if k < D { x[k] + by } else { 0.0 });
    rigid::flat_box::<D>(spatial(&low, -pad), spatial(&high, pad))
}
