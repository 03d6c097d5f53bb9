//! From a plan of solids to their model, and what the plan has for it at each time.

use super::failure::explained;
use crate::plan::Placed;
use crate::plan::pieces::{Apart, UNITE};
use crate::plan::solid::{Opposite, SolidLoad, SolidPlan, evaluate};
use crate::problem::{Body, CaseError, KeyPath, Problem, Space as Stated};
use crate::report::vector;
use signorini_contact::GapJet;
use signorini_geometry::Point;
use signorini_solid::loads::forces;
use signorini_solid::{
    Bodies, Circumstances, Contact, Load, LoadKind, Master, Model, RigidGap, RigidMotion, Space, StepError, Support,
    SupportError, SupportKind, facing,
};
use signorini_solve::cholesky::Cost;
use std::cell::RefCell;
use std::collections::BTreeSet;

/// Bodies, supports and contacts of a plan.
pub fn model<const D: usize>(plan: &SolidPlan<D>) -> Result<Model<D>, CaseError> {
    let space = match plan.space {
        Stated::PlaneStrain => Space::PlaneStrain,
        Stated::PlaneStress => Space::PlaneStress,
        Stated::Axisymmetric => Space::Axisymmetric,
        _ => Space::Solid,
    };
    let mut bodies = Bodies::<D>::new(space);
    for b in &plan.bodies {
        bodies.add(&b.name, b.mesh.clone(), b.degree, b.material);
    }
    let supports = (plan.supports.iter())
        .map(|s| Support { name: s.name.clone(), body: s.body, group: s.group.clone(), kind: s.kind.clone() })
        .collect();
    let contacts = (plan.contacts.iter())
        .map(|c| {
            let mut slave = bodies.surface(c.body, c.sides.clone());
            let master = match &c.opposite {
                Opposite::Body { body, sides, whole } => {
                    let mut master = bodies.surface(*body, sides.clone());
                    let looking = |a: &_, b: &_| facing(a, b).ok().filter(|list| !list.is_empty());
                    let of_slave = c.whole.then(|| looking(&slave, &master)).flatten();
                    let of_master = whole.then(|| looking(&master, &slave)).flatten();
                    slave = of_slave.map_or(slave, |list| bodies.surface(c.body, list));
                    master = of_master.map_or(master, |list| bodies.surface(*body, list));
                    Master::Surface(master)
                }
                Opposite::Rigid(_) => Master::Rigid,
            };
            let mut contact = Contact::new(&c.name, slave, master);
            (contact.method, contact.enforcement) = (c.method, c.enforcement);
            contact.friction = c.friction.as_ref().map(|planned| planned.friction());
            contact
        })
        .collect();
    Model::new(bodies, supports, contacts)
        .map_err(|error| plan.head.problem.error(&location(&plan.head.problem, &error), error.to_string()))
}

/// The key that an error of the solver is about; that of the space where it is about none.
fn location(problem: &Problem, error: &StepError) -> KeyPath {
    let found = match error {
        StepError::Support(
            SupportError::NotFlat { support: name, .. } | SupportError::Contradiction { second: name, .. },
        ) => problem.supports.get(name).map(|support| problem.key(support)),
        StepError::FrictionUnsupported { contact, .. } | StepError::FrictionAxis { contact, .. } => {
            let friction = problem.contacts.get(contact).and_then(|c| c.friction.as_ref());
            friction.map(|friction| problem.key(friction))
        }
        StepError::Deep { contact, .. } => problem.contacts.get(contact).map(|contact| problem.key(contact)),
        _ => None,
    };
    found.unwrap_or_else(|| problem.key(&problem.space))
}

/// Multiplications with additions that a factorisation does in a second on one core, about: `check` tells a time by it.
pub const OPERATIONS_PER_SECOND: f64 = 2e10;

/// What the factorisation of a model takes.
pub fn cost<const D: usize>(plan: &SolidPlan<D>, model: &Model<D>) -> Result<Cost, CaseError> {
    model.cost().map_err(|error| plan.head.problem.error(&plan.head.problem.space, error.to_string()))
}

/// The memory of a run, about: the factor and, of about half its size at most, matrices and results.
pub fn memory(cost: &Cost) -> f64 {
    1.5 * cost.bytes
}

/// Does something with a model and what the plan has for it at one time.
///
/// # Errors
/// An expression of the case whose value is no number there.
pub fn at_time<const D: usize, R>(
    plan: &SolidPlan<D>,
    model: &mut Model<D>,
    time: f64,
    act: impl FnOnce(&mut Model<D>, &Circumstances<'_, D>) -> R,
) -> Result<R, CaseError> {
    let problem = &plan.head.problem;
    let wrong: RefCell<Option<CaseError>> = RefCell::new(None);
    let value = |placed: &Placed, x: &Point<D>| match evaluate(problem, placed, x, time) {
        Ok(v) => v,
        Err(error) => {
            wrong.borrow_mut().get_or_insert(error);
            0.0
        }
    };
    let mut forces = vec![0.0; model.bodies.unknowns()];
    for l in &plan.loads {
        forces.iter_mut().zip(load(&model.bodies, l, &value)).for_each(|(sum, f)| *sum += f);
    }
    let displacement = |number: usize, x: &Point<D>| {
        let support = &plan.supports[number];
        let along = |k: usize| support.values.get(k).and_then(|p| p.as_ref()).map_or(0.0, |p| value(p, x));
        match support.kind {
            SupportKind::Normal => Point::<D>::from_fn(|k, _| if k == 0 { along(0) } else { 0.0 }),
            _ => Point::<D>::from_fn(|k, _| along(k)),
        }
    };
    let rigid: Vec<Option<RigidGap<D>>> = (plan.contacts.iter())
        .map(|c| match &c.opposite {
            Opposite::Rigid(body) => Ok(Some(flat_gap::<D>(body.gap_at(problem, time)?))),
            Opposite::Body { .. } => Ok(None),
        })
        .collect::<Result<_, CaseError>>()?;
    let motion: Vec<Option<RigidMotion<D>>> = (plan.contacts.iter())
        .map(|c| match (&c.opposite, &c.friction) {
            (Opposite::Rigid(body), Some(_)) => {
                let moved = body.way_at(problem, time)?;
                let of = move |x: &Point<D>| {
                    let u = moved(&Point::<3>::from(vector(x)));
                    Point::<D>::from_fn(|k, _| u[k])
                };
                Ok(Some(Box::new(of) as RigidMotion<D>))
            }
            _ => Ok(None),
        })
        .collect::<Result<_, CaseError>>()?;
    let result = act(model, &Circumstances { displacement: &displacement, load: forces, rigid, motion });
    wrong.into_inner().map_or(Ok(result), Err)
}

/// What can be said of a plan without solving: supports and loads are looked at for all times, and where the bodies lie for
/// the first. What a run would find no solution for is told in words.
///
/// # Errors
/// What a run refuses.
pub fn judge<const D: usize>(plan: &SolidPlan<D>, model: &mut Model<D>) -> Result<Option<String>, CaseError> {
    if let Some(error) = loose_piece(plan, model) {
        return Err(error);
    }
    for (index, &time) in plan.times.iter().enumerate() {
        let look = |model: &mut Model<D>, now: &Circumstances<'_, D>| match index {
            0 => model.examine(now),
            _ => model.examine_again(now),
        };
        let Err(error) = at_time(plan, model, time, look)? else { continue };
        match blamed(plan, model, time, &error) {
            Some(error) => return Err(error),
            // A run ends there.
            None => return Ok(Some(format!("at t = {time}: {}", explained(plan, &error).text))),
        }
    }
    Ok(None)
}

/// The error of a mesh that falls into pieces one of which nothing holds: neither supports nor a contact of its own, or it
/// lies on another one, to which it should hold by the nodes that they do not share.
pub fn loose_piece<const D: usize>(plan: &SolidPlan<D>, model: &Model<D>) -> Option<CaseError> {
    for (number, body) in plan.bodies.iter().enumerate() {
        let free: BTreeSet<u32> =
            (model.free_modes().iter()).filter(|m| m.body == body.name).map(|m| m.piece).collect();
        if free.is_empty() {
            continue;
        }
        let Some(apart) = Apart::new(&body.mesh) else { continue };
        let in_contact: BTreeSet<u32> = (plan.contacts.iter())
            .flat_map(|c| {
                let own = (c.body == number).then_some(&c.sides);
                let other = match &c.opposite {
                    Opposite::Body { body, sides, .. } if *body == number => Some(sides),
                    _ => None,
                };
                own.into_iter().chain(other).flatten()
            })
            .map(|side| apart.of_cell[side.cell as usize])
            .collect();
        if let Some(&loose) = free.iter().find(|piece| apart.touching.is_some() || !in_contact.contains(piece)) {
            let problem = &plan.head.problem;
            let place = match problem.bodies.get(&body.name) {
                Some(Body::Solid(solid)) => problem.key(&solid.mesh),
                _ => problem.key(&problem.space),
            };
            return Some(problem.error(&place, apart.held_by_nothing(&body.name, loose)).help(UNITE));
        }
    }
    None
}

/// The error of the case behind that of a time, at its place; none where a run may find a way.
pub fn blamed<const D: usize>(
    plan: &SolidPlan<D>,
    model: &mut Model<D>,
    time: f64,
    error: &StepError,
) -> Option<CaseError> {
    let problem = &plan.head.problem;
    let place = location(problem, error);
    match error {
        StepError::Support(_) | StepError::FrictionUnsupported { .. } | StepError::FrictionAxis { .. } => {
            Some(problem.error(&place, error.to_string()))
        }
        StepError::Deep { contact, depth } => {
            let start = at_time(plan, model, 0.0, |model, now| model.examine(now));
            match start {
                Ok(Err(StepError::Deep { depth, .. })) => Some(
                    problem
                        .error(&place, format!("the bodies of `{contact}` start {depth:.4e} deep in each other"))
                        .help(
                            "separate them; check whether the normal of a rigid plane points into the body, or `side` \
                             names the wrong side",
                        ),
                ),
                _ => Some(
                    problem
                        .error(
                            &place,
                            format!(
                                "the first increment, to t = {time}, is too large: it leads to a penetration of \
                                 {depth:.4e} between the bodies of `{contact}`"
                            ),
                        )
                        .help(
                            "use more `increments`, a smaller motion, or  sliding = \"finite\"  in the contact, for \
                             which increments that are too large are cut back",
                        ),
                ),
            }
        }
        _ => None,
    }
}

/// The forces of a load on the unknowns of the bodies.
pub fn load<const D: usize>(bodies: &Bodies<D>, l: &SolidLoad, value: &dyn Fn(&Placed, &Point<D>) -> f64) -> Vec<f64> {
    let load = Load { name: l.name.clone(), body: l.body, group: l.group.clone(), kind: l.kind };
    forces(bodies, &load, &|x| {
        Point::<D>::from_fn(|k, _| {
            let k = if l.kind == LoadKind::Pressure { 0 } else { k };
            l.values.get(k).map_or(0.0, |p| value(p, x))
        })
    })
}

pub fn flat_gap<const D: usize>(gap: impl Fn(&Point<3>) -> GapJet<3> + Sync + Send + 'static) -> RigidGap<D> {
    Box::new(move |x| {
        let found = gap(&Point::<3>::from(vector(x)));
        GapJet {
            gap: found.gap,
            normal: Point::<D>::from_fn(|k, _| found.normal[k]),
            hessian: signorini_geometry::Matrix::<D>::from_fn(|r, c| found.hessian[(r, c)]),
        }
    })
}
