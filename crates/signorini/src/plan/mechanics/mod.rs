//! From the statement to bodies of any kind in one system: ropes, beams, free rigid bodies.

mod axes;
pub(crate) mod cells;
mod constraints;
pub(super) mod contacts;
mod curves;
mod fields;
mod heat;
mod images;
mod mortar;
mod motion;
pub mod other_friction;
mod places;
mod rigid;
mod sides;
mod solids;
mod tie;
mod winches;

pub use fields::Wrong;
pub use motion::{GRAVITY, Motion};

use super::head::{Head, Size};
use super::history::{ArcLengthIncrement, SystemIncrements};
use super::memory::check_memory;
use super::pieces::{Pieces, UNITE};
use super::planner::Planner;
use crate::problem::units::{LENGTH, Units};
use crate::problem::{self, Body, CaseError, Problem, Space, UnstableStates};
use crate::processes;
use crate::report::{TractionKind, Warning};
use signorini_geometry::Point;
use signorini_geometry::rigid_shape::RigidShape;
use signorini_mechanics::contact::Part;
use signorini_mechanics::system::TimeField;
use signorini_mechanics::{AxisChoice, IncrementError, PlacedLoad, Support, System, TimedLoad, Unstable};
use signorini_rope::curve_pair::search::{SearchScope, Searched, crossings};
use solids::PlannedSolid;
use std::collections::BTreeMap;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// What a body of the system is, for results and pictures.
#[derive(Clone)]
pub enum Kind {
    /// A rope or a beam, with the radius of its section.
    Curve {
        radius: f64,
    },
    /// A solid of finite elements.
    Solid,
    /// A solid of finite cells.
    Cells,
    Rigid {
        shape: Arc<dyn RigidShape>,
        centre: Point<3>,
        is_free: bool,
    },
}

/// What a contact is, for results and pictures.
#[derive(Clone, Debug)]
pub struct ContactInfo {
    /// The method in a word.
    pub method: &'static str,
    pub axis: AxisChoice,
    /// Whether its points are those of a curve, in order.
    pub along_a_curve: bool,
    /// Whether the slave is the second of the bodies that the case names.
    pub swapped: bool,
    /// What the slave carries.
    pub carries: TractionKind,
    /// Whether sliding is small by choice: gaps and slips are linear in the displacements.
    pub slides_little: bool,
    /// Whether it is kept at single nodes of a surface that has none by nature.
    pub at_nodes: bool,
    /// How deep sides that are tied lie in each other at the start; none of others.
    pub tied_overlap: Option<f64>,
    /// What was found out about it.
    pub notes: Vec<String>,
    pub warnings: Vec<String>,
}

impl ContactInfo {
    /// By a method, at points in no order, with nothing to say of it.
    fn by(method: &'static str, axis: AxisChoice) -> Self {
        let carries = TractionKind::Pressure;
        let (notes, warnings) = (Vec::new(), Vec::new());
        ContactInfo {
            method,
            axis,
            along_a_curve: false,
            swapped: false,
            carries,
            slides_little: false,
            at_nodes: false,
            tied_overlap: None,
            notes,
            warnings,
        }
    }
}

/// Bodies in one system, what holds and pushes them, and who may touch whom.
pub struct MechanicsPlan {
    pub head: Head,
    pub space: Space,
    pub system: System,
    /// Of each body of the system.
    pub kinds: Vec<Kind>,
    /// The ends of all increments; of those along a path of equilibria as if time were given.
    pub times: Vec<f64>,
    /// Of each increment, if it is along a path.
    pub arc_lengths: Vec<Option<ArcLengthIncrement>>,
    /// Time to which events of each increment are located.
    pub events: Vec<Option<f64>>,
    /// How bodies move with inertia.
    pub motion: Motion,
    pub probes: BTreeMap<String, Point<3>>,
    /// The point about which moments are told.
    pub moments_about: Point<3>,
    /// Values of the case that were no numbers.
    pub wrong: Wrong,
    /// What each contact of the system is.
    pub contacts: Vec<ContactInfo>,
    /// What was found out about images and bodies of finite cells.
    pub notes: Vec<String>,
}

impl MechanicsPlan {
    /// Whether a step follows a path of equilibria.
    pub fn follows_a_path(&self) -> bool {
        self.arc_lengths.iter().any(Option::is_some)
    }
}

/// Whether a problem is one of bodies in space or in a plane: all but membranes.
pub fn is_system(problem: &Problem) -> bool {
    let bodies = || problem.bodies.values();
    let deforms = |body: &Body| matches!(body, Body::Rope(_) | Body::Beam(_) | Body::Cells(_) | Body::Solid(_));
    let is_free =
        |body: &Body| matches!(body, Body::Rigid(rigid) if matches!(rigid.motion, Some(problem::Motion::Free(_))));
    !bodies().any(|b| matches!(b, Body::Membrane(_))) && bodies().any(|b| deforms(b) || is_free(b))
}

/// Unknowns of a system, what solves its equations, and about how much memory that takes; an error where there is less.
fn size_of(problem: &Problem, system: &System) -> Result<Size, CaseError> {
    let unknowns: usize = system.bodies.iter().map(|b| b.unknowns()).sum();
    let how = if system.iterates() { "iterations" } else { "a factorisation" };
    let needed = system.memory();
    check_memory(problem, &format!("{unknowns} unknowns, solved by {how},"), needed)?;
    Ok(Size::new(unknowns, how, needed))
}

/// Part of its radius that a curve may start deep inside of what it touches without a word.
const DEEP: f64 = 0.1;

/// Depth relative to the size of the bodies with which rigid bodies do not overlap.
const OVERLAP: f64 = 1e-9;

/// The name of what holds solids on the axis of rotation, which nobody stated.
pub const AXIS_SUPPORT: &str = "axis";

/// Where a name stands among the bodies of the system.
pub(super) type Numbers = BTreeMap<String, usize>;

impl Planner<'_> {
    pub(super) fn mechanics(&self) -> Result<MechanicsPlan, CaseError> {
        let problem = self.problem;
        self.check_space()?;
        let wrong = Wrong::default();
        let unstable = match problem.stability {
            None | Some(UnstableStates::Follow) => Unstable::Follow,
            Some(UnstableStates::Tell) => Unstable::Tell,
        };
        let mut system = System { unstable, ..System::default() };
        let mut kinds = Vec::new();
        let mut warnings = Vec::new();
        let mut notes = Vec::new();
        let mut axis = Vec::new();
        let mut pieces = Vec::new();
        let mut numbers = Numbers::new();
        let mut boxes: Vec<(&str, [Point<3>; 2])> = Vec::new();
        // Rigid shapes given by heights are known around the bodies that are there.
        let mut around: Option<[Point<3>; 2]> = None;
        for (name, body) in &problem.bodies {
            let (deformable, kind) = match body {
                Body::Rope(rope) => {
                    self.rope(name, rope, &wrong).map(|(body, radius)| (body, Kind::Curve { radius }))?
                }
                Body::Beam(beam) => self.beam(name, beam).map(|(body, radius)| (body, Kind::Curve { radius }))?,
                Body::Solid(solid) => {
                    let PlannedSolid { body, on_axis, pieces: own } = self.system_solid(name, solid, &mut warnings)?;
                    pieces.extend(own);
                    if on_axis {
                        let part = Part { body: system.bodies.len(), group: Some(solids::AXIS.to_string()) };
                        let zero: TimeField = Arc::new(|_, _| 0.0);
                        let (displacement, rotation) = ([Some(zero), None, None], [None, None, None]);
                        axis.push(Support {
                            name: AXIS_SUPPORT.into(),
                            part,
                            displacement,
                            rotation,
                            ..Support::default()
                        });
                    }
                    (body, Kind::Solid)
                }
                Body::Cells(cells) => (self.cells_body(name, cells, &mut notes)?.body, Kind::Cells),
                Body::Rigid(_) => continue,
                _ => {
                    return Err(problem
                        .error(body, format!("the body `{name}` cannot be part of a system"))
                        .help("valid bodies here are `solid`, `cells`, `rope`, `beam` and `rigid`"));
                }
            };
            let shown = deformable.fields(&deformable.start());
            let join = |found: Option<[Point<3>; 2]>, x: &Point<3>| {
                let [low, high] = found.unwrap_or([*x; 2]);
                Some([low.inf(x), high.sup(x)])
            };
            around = shown.points.iter().fold(around, join);
            if let Some(corners) = shown.points.iter().fold(None, join) {
                boxes.push((name.as_str(), corners));
            }
            numbers.insert(name.clone(), system.bodies.len());
            system.bodies.push(deformable);
            kinds.push(kind);
        }
        for (name, body) in &problem.bodies {
            let Body::Rigid(key) = body else { continue };
            let (rigid, kind) = self.rigid_body(name, key, around, &wrong)?;
            numbers.insert(name.clone(), system.bodies.len());
            system.bodies.push(Box::new(rigid));
            kinds.push(kind);
        }
        system.supports = self.system_supports(&numbers, &system, &wrong)?;
        system.supports.append(&mut axis);
        system.constraints = self.linear_constraints(&numbers, &system, &wrong)?;
        let (loads, springs) = self.system_loads(&numbers, &system, &kinds, &wrong)?;
        system.loads = loads;
        system.loads.extend(springs.into_iter().map(|(name, part, load)| PlacedLoad { name, part, load }));
        let (acting, contacts) = self.system_contacts(&numbers, &mut system, &kinds)?;
        system.contacts = acting;
        system.heat = self.heat(&numbers, &system, &kinds, &wrong)?;
        self.check_restitution(&system)?;
        let SystemIncrements { times, arc_lengths, events, steps } = self.system_increments()?;
        let motion = self.motion(&numbers, &mut system, &steps, &wrong, &mut warnings)?;
        // What is told of the solver is told of steps in motion.
        system.dynamics = motion.dynamics.iter().copied().flatten().next();
        system.prepare().map_err(|e| self.unprepared(&e))?;
        // Inertia holds what nothing else does.
        if motion.dynamics.first().is_none_or(Option::is_none) {
            self.check_pieces(&pieces, &system)?;
            self.check_held(&system)?;
        }
        self.tell_idle(&system, &mut warnings)?;
        if arc_lengths.iter().any(Option::is_some) {
            system.unstable = Unstable::Tell;
        }
        for time in &times {
            system.check_supports(*time).map_err(|e| self.unprepared(&e.into()))?;
        }
        if let Some(error) = wrong.take(problem) {
            return Err(error);
        }
        self.check_start(&system, &kinds, &contacts, &mut warnings)?;
        self.check_inside(&system)?;
        if motion.dynamics.first().is_some_and(Option::is_some) && system.is_rigid() {
            self.check_apart(&system)?;
        }
        self.check_crossings(&system, &kinds, &contacts)?;
        self.tell_stretched(&system, &numbers, &mut warnings)?;
        notes.extend(contacts.iter().flat_map(|c| c.notes.iter().cloned()));
        warnings.extend(contacts.iter().flat_map(|c| c.warnings.iter().map(|w| Warning::from(w.as_str()))));
        // Where PETSc solves, the size is told as the system is divided.
        let is_sized = kinds.iter().any(|k| matches!(k, Kind::Solid | Kind::Cells)) && !processes::by_petsc(problem);
        let size = is_sized.then(|| size_of(problem, &system)).transpose()?;
        notes.extend(size.iter().map(|size| size.told.clone()));
        if system.contacts.is_empty() && system.constraints.is_empty() && system.bodies.len() > 1 {
            warnings.push("the case has no contact, so the bodies do not interact (add [contacts.NAME])".into());
        }
        if arc_lengths.iter().zip(&events).any(|(path, event)| path.is_some() && event.is_some()) {
            warnings.push("`events` are not located along a path by arc length".into());
        }
        let mut probes = BTreeMap::new();
        for (name, at) in &problem.output.probes {
            let x = self.position(at, LENGTH)?;
            warnings.extend(outside(name, &x, &boxes).map(Warning::from));
            probes.insert(name.clone(), x);
        }
        if let Some(units) = self.reader.units {
            warnings.extend(odd_sizes(problem, units, &boxes));
        }
        Ok(MechanicsPlan {
            head: Head { size, ..self.head(warnings)? },
            space: self.space,
            system,
            kinds,
            times,
            arc_lengths,
            events,
            motion,
            probes,
            moments_about: match &problem.output.moments_about {
                Some(at) => self.position(at, LENGTH)?,
                None => Point::<3>::zeros(),
            },
            wrong,
            contacts,
            notes,
        })
    }

    /// Whether bodies that rebound by a coefficient are rigid.
    fn check_restitution(&self, system: &System) -> Result<(), CaseError> {
        let problem = self.problem;
        let stated = problem.contacts.values().find_map(|key| key.restitution.as_ref());
        match stated {
            Some(e) if !system.is_rigid() => Err(problem
                .error(e, "a coefficient of restitution is for systems in which all that moves is rigid")
                .help("leave `restitution` out: bodies that deform rebound by their elasticity")),
            _ => Ok(()),
        }
    }

    /// Ropes and beams lie in space.
    fn check_space(&self) -> Result<(), CaseError> {
        let problem = self.problem;
        for (name, body) in &problem.bodies {
            let fits = match body {
                Body::Rope(_) | Body::Beam(_) => self.space == Space::ThreeD,
                Body::Solid(_) | Body::Cells(_) => !matches!(self.space, Space::Line | Space::Plane),
                Body::Rigid(_) if self.space == Space::Axisymmetric => true,
                _ => matches!(self.space, Space::ThreeD | Space::PlaneStrain | Space::PlaneStress),
            };
            if !fits {
                return Err(problem
                    .error(&problem.space, format!("the body `{name}` is not possible in this space"))
                    .help("ropes and beams require  space = \"3d\""));
            }
        }
        Ok(())
    }

    /// Whether something holds each piece of a mesh that does not hang together: supports or contacts; of pieces that lie on each
    /// other, which should be one, supports.
    fn check_pieces(&self, pieces: &[Pieces], system: &System) -> Result<(), CaseError> {
        let problem = self.problem;
        for own in pieces {
            let of_body = |part: &Part| system.bodies[part.body].name() == own.body;
            let supports = system.supports.iter().map(|support| &support.part);
            let springs = system.loads.iter().filter(|l| matches!(l.load, TimedLoad::Springs(_))).map(|l| &l.part);
            let contacts = system.contacts.iter().filter(|_| !own.touch).flat_map(|contact| contact.parts());
            let constraints = system.constraints.iter().flat_map(|c| c.terms.iter().map(|term| &term.part));
            let parts = supports.chain(springs).chain(constraints).chain(contacts).filter(|part| of_body(part));
            if let Some(told) = own.loose(parts.map(|part| part.group.as_deref())) {
                let place = match problem.bodies.get(&own.body) {
                    Some(Body::Solid(solid)) => self.key(&solid.mesh),
                    _ => self.key(&problem.space),
                };
                return Err(problem.error(&place, told).help(UNITE));
            }
        }
        Ok(())
    }

    /// Whether something holds each body of small strains.
    fn check_held(&self, system: &System) -> Result<(), CaseError> {
        let problem = self.problem;
        let Some((body, motion)) = system.unheld().map_err(|e| self.unprepared(&e.into()))? else {
            return Ok(());
        };
        let name = system.bodies[body].name();
        let message = format!("nothing restrains `{name}` against {motion}");
        let help = "add a support, springs, or a contact of this body";
        Err(match problem.bodies.get(name) {
            Some(key) => problem.error(key, message),
            None => problem.error(&problem.space, message),
        }
        .help(help))
    }

    /// Whether curves start outside of what they touch: as far as their radius and half of their cells may reach in.
    fn check_start(
        &self,
        system: &System,
        kinds: &[Kind],
        contacts: &[ContactInfo],
        warnings: &mut Vec<Warning>,
    ) -> Result<(), CaseError> {
        let problem = self.problem;
        let start = system.start();
        for (k, contact) in system.contacts.iter().enumerate() {
            let [slave, master] = contact.bodies();
            let Kind::Curve { radius } = kinds[slave] else { continue };
            if !contacts[k].along_a_curve {
                continue;
            }
            let sites = system.sites(k, &start).map_err(|e| problem.error(&problem.space, e.to_string()))?;
            let deepest = sites.iter().filter_map(|s| Some((s.gap?, s))).min_by(|a, b| a.0.total_cmp(&b.0));
            let Some((gap, site)) = deepest else { continue };
            if gap < -radius.max(0.5 * site.weight) {
                let names = [slave, master].map(|b| system.bodies[b].name());
                return Err(self
                    .deep_inside(names, -gap, &site.x)
                    .help("give a path outside of the body, at a distance of at least the radius"));
            }
            if -gap > DEEP * radius.max(0.5 * site.weight) {
                let [name, other] = [slave, master].map(|b| system.bodies[b].name());
                warnings.push(
                    format!(
                        "`{name}` starts {:.4e} deep inside `{other}`, with a radius of {radius:.4e}: it is pushed \
                         out at once; to avoid this, give a path outside of the body at a distance of at least the \
                         radius",
                        -gap
                    )
                    .into(),
                );
            }
        }
        Ok(())
    }

    /// Whether surfaces start outside of the rigid bodies that they may touch, but for an interference that contact undoes.
    fn check_inside(&self, system: &System) -> Result<(), CaseError> {
        let problem = self.problem;
        let mut start = system.start();
        system.bodies.iter().zip(&mut start.bodies).for_each(|(body, state)| body.prescribe(0.0, state));
        match system.check_inside(&start, true) {
            Ok(()) => Ok(()),
            Err(IncrementError::Inside { contact, body, depth, x }) => {
                let of = system.contacts.iter().find(|c| c.name() == contact).map(|c| c.bodies());
                let names = of.map(|bodies| bodies.map(|b| system.bodies[b].name()));
                let other = names.map_or("the rigid body", |[_, master]| master);
                let at: Vec<String> = x.iter().map(|v| format!("{v:.4}")).collect();
                let place = problem.contacts.get(&contact).map_or(self.key(&problem.space), |key| self.key(key));
                let message = format!("`{body}` starts {depth:.4e} deep inside `{other}`, at ({})", at.join(", "));
                Err(problem.error(&place, message).help(
                    "separate them; check whether the normal of a rigid plane points into the body, or `side` names \
                     the wrong side",
                ))
            }
            Err(error) => Err(problem.error(&problem.space, error.to_string())),
        }
    }

    /// Whether rigid bodies that move with inertia start outside of each other: nothing tells how fast an overlap would open.
    fn check_apart(&self, system: &System) -> Result<(), CaseError> {
        let problem = self.problem;
        let mut start = system.start();
        system.bodies.iter().zip(&mut start.bodies).for_each(|(body, state)| body.prescribe(0.0, state));
        for (k, contact) in system.contacts.iter().enumerate() {
            let sites = system.sites(k, &start).map_err(|e| problem.error(&problem.space, e.to_string()))?;
            let points = sites.iter().filter_map(|s| Some((s.gap?, s.x))).chain(system.deepest_overlap(k, &start));
            let deepest = points.min_by(|a, b| a.0.total_cmp(&b.0));
            let Some((gap, x)) = deepest.filter(|(gap, _)| *gap < -OVERLAP * system.size()) else { continue };
            let [name, other] = contact.bodies().map(|b| system.bodies[b].name());
            let place = problem.contacts.get(contact.name()).map_or(self.key(&problem.space), |key| self.key(key));
            let at: Vec<String> = x.iter().map(|v| format!("{v:.4}")).collect();
            let message = format!("`{name}` starts {:.4e} deep inside `{other}`, at ({})", -gap, at.join(", "));
            return Err(problem
                .error(&place, message)
                .help("bodies that move with inertia start apart, or in touch: move one of them"));
        }
        Ok(())
    }

    /// A curve that starts inside of another body, or of another curve.
    fn deep_inside(&self, [name, other]: [&str; 2], depth: f64, x: &Point<3>) -> CaseError {
        let at: Vec<String> = x.iter().map(|v| format!("{v:.4}")).collect();
        let message = format!("`{name}` starts {depth:.4e} deep inside `{other}`, at ({})", at.join(", "));
        let place = match self.problem.bodies.get(name) {
            Some(Body::Rope(rope)) => self.key(&rope.path),
            Some(Body::Beam(beam)) => self.key(&beam.path),
            _ => self.key(&self.problem.space),
        };
        self.problem.error(&place, message)
    }

    /// Whether curves that may touch start outside of each other: deeper than the thinner one is thick nothing tells on which
    /// side.
    fn check_crossings(&self, system: &System, kinds: &[Kind], contacts: &[ContactInfo]) -> Result<(), CaseError> {
        let start = system.start();
        for (contact, tested) in system.contacts.iter().zip(contacts) {
            let bodies = contact.bodies();
            let [Kind::Curve { radius: own }, Kind::Curve { radius: other }] = bodies.map(|b| &kinds[b]) else {
                continue;
            };
            if tested.along_a_curve || bodies[0] == bodies[1] {
                continue;
            }
            let [Some(a), Some(b)] = bodies.map(|k| system.bodies[k].curve(None)) else { continue };
            let configuration = |k: usize| &start.bodies[bodies[k]].configuration[..];
            let sides = [
                Searched { curve: a.as_ref(), configuration: configuration(0) },
                Searched { curve: b.as_ref(), configuration: configuration(1) },
            ];
            for near in crossings(sides[0], sides[1], SearchScope::Two, 0.0) {
                let depth = own + other - near.distance;
                if depth > own.min(*other) {
                    let x = a.jet(configuration(0), near.points[0].element, near.points[0].xi).x;
                    let names = bodies.map(|b| system.bodies[b].name());
                    let help = "give paths at a distance of at least the sum of the radii";
                    return Err(self.deep_inside(names, depth, &x).help(help));
                }
            }
        }
        Ok(())
    }

    /// Says which ropes are shorter than the distance of their ends.
    fn tell_stretched(
        &self,
        system: &System,
        numbers: &BTreeMap<String, usize>,
        warnings: &mut Vec<Warning>,
    ) -> Result<(), CaseError> {
        let start = system.start();
        for (name, body) in &self.problem.bodies {
            let Body::Rope(rope) = body else { continue };
            let (Some(stated), Some(curve)) = (&rope.unstrained_length, system.bodies[numbers[name]].curve(None))
            else {
                continue;
            };
            let length = self.reader.positive(stated, LENGTH)?;
            let configuration = &start.bodies[numbers[name]].configuration;
            let end = |element: usize, xi: f64| curve.jet(configuration, element, xi).x;
            let distance = (end(curve.elements() - 1, 1.0) - end(0, 0.0)).norm();
            if length < distance {
                let by = 100.0 * (distance / length - 1.0);
                let message = format!(
                    "`{name}` is shorter than the distance of its ends, {length} of {distance}: it starts with a \
                     strain of {by:.3} %; give a longer `unstrained_length`, or the intended `pretension`"
                );
                warnings.push(Warning::from(message));
            }
        }
        Ok(())
    }

    /// Components of a vector in this space; in the plane the third is zero.
    fn position(
        &self,
        values: &problem::List<problem::Value>,
        dimension: problem::units::Dimension,
    ) -> Result<Point<3>, CaseError> {
        if self.space == Space::ThreeD {
            return Ok(Point::<3>::from(self.reader.numbers::<3>(values, dimension)?));
        }
        let [x, y] = self.reader.numbers::<2>(values, dimension)?;
        Ok(Point::<3>::new(x, y, 0.0))
    }
}

/// Lengths in metres and Young's moduli in pascals beyond these look wrong.
const LENGTHS: RangeInclusive<f64> = 1e-9..=1e5;
const MODULI: RangeInclusive<f64> = 1e1..=3e12;

/// What is odd about sizes and stiffness of solids.
fn odd_sizes(problem: &Problem, units: Units, boxes: &[(&str, [Point<3>; 2])]) -> Vec<Warning> {
    let mut out = Vec::new();
    for (name, [low, high]) in boxes {
        let Some(Body::Solid(_)) = problem.bodies.get(*name) else { continue };
        out.extend(odd_length(units, (high - low).max(), &format!("`{name}`")).map(Warning::from));
    }
    out
}

/// What is odd about the size of a body.
pub(crate) fn odd_length(units: Units, length: f64, what: &str) -> Option<String> {
    let metres = length * units.length;
    (!LENGTHS.contains(&metres)).then(|| format!("{what} is {metres:.1e} m long; check the units"))
}

/// What is odd about the stiffness of a body.
pub(super) fn odd_modulus(units: Units, youngs_modulus: f64, body: &str) -> Option<String> {
    let pascals = youngs_modulus * units.force / units.length.powi(2);
    let than = if pascals < *MODULI.start() { "softer than" } else { "stiffer than" };
    let told = || format!("the modulus of `{body}` is {pascals:.1e} Pa, {than} any solid; check the units");
    (!MODULI.contains(&pascals)).then(told)
}

/// What is told of a probe outside of all bodies.
fn outside(name: &str, x: &Point<3>, boxes: &[(&str, [Point<3>; 2])]) -> Option<String> {
    let away = |[low, high]: &[Point<3>; 2]| (low - x).sup(&(x - high)).sup(&Point::<3>::zeros()).norm();
    let (body, corners) = boxes.iter().min_by(|a, b| away(&a.1).total_cmp(&away(&b.1)))?;
    let size = (corners[1] - corners[0]).norm();
    let at: Vec<String> = x.iter().map(f64::to_string).collect();
    (away(corners) > NEAR * size).then(|| {
        format!(
            "the probe `{name}` at ({}) lies outside all bodies: the nearest point of `{body}` is used",
            at.join(", ")
        )
    })
}

/// Part of the size of a body beyond its box at which a probe is on it but for rounding.
const NEAR: f64 = 1e-9;
