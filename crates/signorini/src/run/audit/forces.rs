//! What acts on the bodies of a system: supports, constraints, loads, inertia, damping and heat, with their work.

use super::mean_work;
use crate::plan::mechanics::{Kind, MechanicsPlan};
use crate::problem::{Body as Key, Space as Stated};
use signorini_audit::{Acting, Form, Setting, State};
use signorini_geometry::{Point, Vector};
use signorini_mechanics::system::{Support, TimedLoad};
use signorini_mechanics::{Contribution, IncrementResult, Order, System, SystemState, rigid_body};
use std::borrow::Cow;

/// Supports and loads with their work since the state before.
pub(super) fn forces(
    (plan, setting): (&MechanicsPlan, &Setting),
    (state, result): (&SystemState, &IncrementResult),
    time: f64,
    before: Option<&(State, SystemState)>,
) -> Vec<Acting> {
    let system = &plan.system;
    let mut out: Vec<Acting> = Vec::new();
    // Forces that were not there before, at the start, were none.
    let earlier = |k: usize| before.and_then(|b| b.0.forces.get(k)).map_or(Vector::<3>::zeros(), |f| f.force);
    for (support, [force, turning]) in system.supports.iter().zip(&result.support_forces) {
        let body = support.part.body;
        let turns = support.rotation.iter().any(Option::is_some);
        // A rigid body is held at its centre.
        let moment = match &plan.kinds[body] {
            Kind::Rigid { .. } if !turns => {
                Some(rigid_body::Pose::of(&state.bodies[body]).centre.cross(force) + turning)
            }
            _ => None,
        };
        let moved = before.filter(|_| !turns).and_then(|(was, _)| {
            let [start, end] = [was.time, time].map(|t| uniform(support, rest(setting, system, body).as_ref(), t));
            Some(end? - start?)
        });
        // The radial forces around an axis have no resultant that does work.
        let known = moved.filter(|m| plan.space != Stated::Axisymmetric || m[0] == 0.0);
        let work = known.map(|m| mean_work(&earlier(out.len()), force, &m));
        let drives = moved.is_none_or(|m| m.norm() > 0.0);
        out.push(Acting { name: support.name.clone(), body, force: *force, moment, work, drives, reacts: true });
    }
    for (constraint, multiplier) in system.constraints.iter().zip(&result.constraint_forces) {
        for term in &constraint.terms {
            let Ok([x, moved]) = term.place(&system.bodies, &state.bodies) else { continue };
            let force = term.factor * *multiplier;
            let moment = (plan.space != Stated::Axisymmetric).then(|| (x + moved).cross(&force));
            let work = before.and_then(|(_, from)| {
                let [_, was] = term.place(&system.bodies, &from.bodies).ok()?;
                Some(mean_work(&earlier(out.len()), &force, &(moved - was)))
            });
            let (name, body) = (constraint.name.clone(), term.part.body);
            out.push(Acting { name, body, force, moment, work, drives: false, reacts: true });
        }
    }
    // What a winch does, and where a rope runs through pulleys, is not told.
    let hauls = |k: usize| matches!(plan.head.problem.bodies.get(system.bodies[k].name()), Some(Key::Rope(r)) if r.winch.is_some() || r.pulleys.is_some());
    let force = Vector::<3>::zeros();
    out.extend((0..system.bodies.len()).filter(|k| hauls(*k)).map(|body| Acting {
        name: "winch".into(),
        body,
        force,
        moment: Some(force),
        work: None,
        drives: true,
        reacts: true,
    }));
    if let Some(moved) = &result.moved {
        for (body, (force, moment)) in moved.inertia.iter().enumerate() {
            let gained = moved.after[body].kinetic_energy - moved.before[body].kinetic_energy;
            out.push(Acting {
                name: "inertia".into(),
                body,
                force: *force,
                moment: *moment,
                work: Some([-gained, 0.0]),
                drives: true,
                reacts: false,
            });
        }
        for (body, [force, moment]) in moved.damping.iter().enumerate() {
            out.push(Acting {
                name: "damping".into(),
                body,
                force: -force,
                moment: Some(-moment),
                work: Some([0.0, 0.0]),
                drives: false,
                reacts: false,
            });
        }
        let still = Vector::<3>::zeros();
        out.push(Acting {
            name: "damping".into(),
            body: 0,
            force: still,
            moment: Some(still),
            work: Some([-moved.damped, 0.0]),
            drives: false,
            reacts: false,
        });
    }
    out.extend((0..system.bodies.len()).filter_map(|k| heat_work(system, k, before.map(|b| &b.1), state)));
    for (k, load) in system.loads.iter().enumerate() {
        let Ok([force, moment]) = system.load_resultant(k, state, time) else { continue };
        let body = load.part.body;
        let work = before.and_then(|(was, from)| {
            if !system.bodies[body].is_rigid() {
                return load_work(system, k, [(from, was.time), (state, time)]);
            }
            let [start, end] = [from, state].map(|s| rigid_body::Pose::of(&s.bodies[body]).centre);
            let turns = matches!(load.load, TimedLoad::Moment(_) | TimedLoad::FollowerMoment(_));
            let [was, _] = system.load_resultant(k, from, was.time).ok()?;
            (!turns).then(|| mean_work(&was, &force, &(end - start)))
        });
        out.push(Acting {
            name: load.name.clone(),
            body: load.part.body,
            force,
            moment: Some(moment),
            work,
            drives: false,
            reacts: false,
        });
    }
    out
}

/// What changes of the temperature add to the energy that a body stores: by the mean of what they add before and after its
/// displacement. None of bodies without a temperature.
fn heat_work(system: &System, k: usize, before: Option<&SystemState>, now: &SystemState) -> Option<Acting> {
    let body = &system.bodies[k];
    let thermal = body.thermal()?;
    let work = before.filter(|_| !body.is_inelastic()).and_then(|before| {
        let states = [&before.bodies[k], &now.bodies[k]];
        let energy = |displaced: usize, heated: usize| {
            let mut state = states[displaced].clone();
            thermal.set_temperature(&mut state, thermal.temperature(states[heated]));
            body.internal(&state, Order::First, &mut Contribution::new(body.unknowns())).ok()
        };
        let [first, last] = [energy(0, 1)? - energy(0, 0)?, energy(1, 1)? - energy(1, 0)?];
        // By how much the order of both matters: of linear laws it does not.
        Some([0.5 * (first + last), if body.is_linear() { 0.0 } else { 0.5 * (last - first).abs() }])
    });
    let still = Vector::<3>::zeros();
    Some(Acting { name: "heat".into(), body: k, force: still, moment: Some(still), work, drives: false, reacts: false })
}

/// The points of a body before it moves: those of solids are known.
fn rest<'a>(setting: &'a Setting, system: &System, body: usize) -> Cow<'a, [Point<3>]> {
    match &setting.bodies[body].form {
        Form::Solid(solid) => Cow::Borrowed(&solid.rest),
        _ => Cow::Owned(system.bodies[body].fields(&system.bodies[body].start()).points),
    }
}

/// A displacement that is the same all over a body; none of one that differs.
fn uniform(support: &Support, points: &[Point<3>], time: f64) -> Option<Vector<3>> {
    let last = points.len().saturating_sub(1);
    let at = |k: usize| points.get(k).copied().unwrap_or_default();
    let along = |i: usize, x: &Point<3>| support.along.as_ref().map_or(0.0, |(n, f)| n[i] * f(x, time));
    let value = |i: usize, x: &Point<3>| support.displacement[i].as_ref().map_or_else(|| along(i, x), |f| f(x, time));
    let prescribed = |x: &Point<3>| match &support.axes {
        Some(axes) => axes.vector(x, support.displacement.each_ref().map(|d| d.as_ref().map(|f| f(x, time)))),
        None => Some(Vector::<3>::from_fn(|i, _| value(i, x))),
    };
    let first = prescribed(&at(0))?;
    let same = |k: usize| prescribed(&at(k)) == Some(first);
    [last, last / 2, last / 3].into_iter().all(same).then_some(first)
}

/// The work of a load between two states by the mean of its forces, and how far it may be off.
fn load_work(system: &System, load: usize, states: [(&SystemState, f64); 2]) -> Option<[f64; 2]> {
    let own = system.loads[load].part.body;
    let body = &system.bodies[own];
    let ends = states.map(|(state, _)| &state.bodies[own]);
    let [from, to] = ends.map(|s| &s.configuration);
    if from.len() != body.unknowns() {
        return None;
    }
    let step: Vec<f64> = to.iter().zip(from).map(|(a, b)| a - b).collect();
    let forces = |(state, time)| system.load_forces(load, state, time).ok();
    let (first, last) = (forces(states[0])?, forces(states[1])?);
    let sum = |of: fn(f64, f64, f64) -> f64| -> f64 {
        first.iter().zip(&last).zip(&step).map(|((a, b), moved)| of(*a, *b, *moved)).sum()
    };
    // Parts of the body may move one after the other.
    Some([sum(|a, b, moved| 0.5 * (a + b) * moved), sum(|a, b, moved| 0.5 * ((b - a) * moved).abs())])
}
