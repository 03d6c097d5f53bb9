//! What is told of a state of a system.

use crate::output::figure::{told, told_vector};
use crate::output::system::{CurveShown, SystemShown, frames};
use crate::plan::mechanics::{AXIS_SUPPORT, ContactInfo, GRAVITY, Kind, MechanicsPlan};
use crate::problem::Space;
use crate::report::{
    BodyHeat, CellsReport, Component, ContactHeatReport, ContactReport, CurveReport, HeatReport, MotionReport, Pose,
    Probe, Reason, RopeLimits, SectionReport, StabilityReport, StepReport, TractionKind, UnitNames, vector,
};
use crate::run::contact_verdict::{contact_verdict, sticking};
use crate::run::mechanics::warnings::most_strained;
use crate::run::record::Record;
use signorini_contact::Status;
use signorini_geometry::{Point, Vector};
use signorini_mechanics::{
    AxisChoice, BodyState, Coarse, HeatResult, IncrementResult, Interaction, SiteResult, Solved, Stability, System,
    SystemState, rigid_body,
};
use signorini_paths::darboux::Darboux;
use signorini_paths::friction::Friction;
use signorini_paths::theorem::limits_of_points;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What solves the equations where nothing else is said.
pub const SOLVER: &str = "direct";

/// What solved them, and the most iterations that one linear system took.
fn solver(solved: Solved) -> (&'static str, Option<usize>) {
    match solved {
        Solved::Direct => (SOLVER, None),
        Solved::Condensed => ("condensed", None),
        Solved::Eliminated => ("direct with krylov", None),
        Solved::Distributed { most_iterations, .. } => ("petsc", most_iterations),
        Solved::Iterative { most_iterations, coarse, .. } => {
            let word = match coarse {
                Coarse::Factorised => "schwarz",
                Coarse::Multigrid => "multigrid",
            };
            (word, Some(most_iterations))
        }
    }
}

/// The step of the summary that a state is.
pub fn step_report(
    plan: &MechanicsPlan,
    state: &SystemState,
    result: &IncrementResult,
    shown: &SystemShown,
    index: usize,
) -> StepReport {
    let system = &plan.system;
    let mut supports: BTreeMap<String, Vector<3>> = BTreeMap::new();
    for (support, forces) in system.supports.iter().zip(&result.support_forces) {
        if support.name == AXIS_SUPPORT {
            continue;
        }
        *supports.entry(support.name.clone()).or_insert_with(Vector::<3>::zeros) += forces[0];
    }
    // Around an axis all moments vanish.
    let about = (plan.space != Space::Axisymmetric).then_some(plan.moments_about);
    let shifted = |force: &Vector<3>, moment: &Vector<3>| moment - plan.moments_about.cross(force);
    let mut support_moments: BTreeMap<String, Vector<3>> = BTreeMap::new();
    let moments = about.and_then(|_| system.support_moments(state, shown.time).ok()).unwrap_or_default();
    for ((support, forces), moment) in system.supports.iter().zip(&result.support_forces).zip(&moments) {
        let moment = shifted(&forces[0], moment);
        *support_moments.entry(support.name.clone()).or_insert_with(Vector::<3>::zeros) += moment;
    }
    let mut load_moments: BTreeMap<String, [f64; 3]> = BTreeMap::new();
    let is_spring = |name: &str| name != GRAVITY && !plan.head.problem.loads.contains_key(name);
    let mut loads: BTreeMap<String, [f64; 3]> = BTreeMap::new();
    for (k, load) in system.loads.iter().enumerate() {
        let Ok([force, moment]) = system.load_resultant(k, state, shown.time) else { continue };
        let moment = shifted(&force, &moment);
        if is_spring(&load.name) {
            // A spring is part of a support.
            *supports.entry(load.name.clone()).or_insert_with(Vector::<3>::zeros) += force;
            *support_moments.entry(load.name.clone()).or_insert_with(Vector::<3>::zeros) += moment;
        } else {
            // Gravity acts on several bodies.
            let add = |sums: &mut BTreeMap<String, [f64; 3]>, v: &Vector<3>| {
                let sum = sums.entry(load.name.clone()).or_default();
                (0..3).for_each(|i| sum[i] += v[i]);
            };
            add(&mut loads, &force);
            add(&mut load_moments, &moment);
        }
    }
    let poses = system.bodies.iter().zip(&plan.kinds).zip(&state.bodies).filter_map(|((body, kind), state)| {
        let Kind::Rigid { centre, is_free: true, .. } = kind else { return None };
        let pose = rigid_body::Pose::of(state);
        let displacement = vector(&(pose.centre - centre));
        Some((
            body.name().to_string(),
            Pose { displacement, rotation: vector(&pose.turn), turned: vector(&pose.turned) },
        ))
    });
    let means = system.bodies.iter().zip(&state.bodies).filter_map(|(body, state)| {
        let own = body.means(state)?;
        Some((body.name().to_string(), CellsReport { mean_stress: own.stress, mean_strain: own.strain }))
    });
    let moved = result.moved.iter().flat_map(|moved| system.bodies.iter().zip(&moved.after));
    let motion: BTreeMap<String, MotionReport> = moved
        .filter(|(_, own)| own.mass > 0.0)
        .map(|(body, own)| {
            let report = MotionReport {
                mass: own.mass,
                kinetic_energy: own.kinetic_energy,
                velocity: vector(&(own.momentum / own.mass)),
                angular_momentum: vector(&own.angular_momentum),
            };
            (body.name().to_string(), report)
        })
        .collect();
    StepReport {
        index,
        time: shown.time,
        converged: true,
        reason: Reason::Converged,
        iterations: result.iterations,
        solver: solver(result.solved).0.into(),
        linear_iterations: solver(result.solved).1,
        residual_history: result.history.clone(),
        energy: Some(result.energy),
        plastic_dissipation: (system.bodies.iter().any(|b| b.is_inelastic()))
            .then(|| result.dissipated_in_bodies.iter().sum()),
        stability: result.stability.as_ref().map(|told| stability_report(system, told)),
        equilibrium_residual: Some(result.imbalance),
        support_forces: supports.iter().map(|(name, force)| (name.clone(), vector(force))).collect(),
        constraint_forces: (system.constraints.iter().map(|c| c.name.clone()))
            .zip(result.constraint_forces.iter().copied())
            .collect(),
        load_forces: loads,
        moments_about: about.map(|x| vector(&x)),
        support_moments: (support_moments.iter().filter(|_| about.is_some()))
            .map(|(name, moment)| (name.clone(), vector(moment)))
            .collect(),
        load_moments: if about.is_some() { load_moments } else { BTreeMap::new() },
        contacts: (system.contacts.iter().zip(&plan.contacts).zip(&result.sites))
            .zip(&result.dissipated)
            .map(|(((contact, tested), sites), dissipated)| {
                let report = contact_report(plan, (contact.as_ref(), tested), sites);
                let dissipation = contact.friction().map(|_| *dissipated);
                (contact.name().to_string(), ContactReport { dissipation, ..report })
            })
            .collect(),
        probes: plan.probes.iter().map(|(name, x)| (name.clone(), probed(system, &state.bodies, shown, x))).collect(),
        curves: shown
            .curves
            .iter()
            .map(|c| (c.name.clone(), curve_report(c, end_tensions(system, (state, shown.time), c))))
            .collect(),
        cells: means.collect(),
        free_bodies: poses.collect(),
        kinetic_energy: (!motion.is_empty()).then(|| motion.values().map(|m| m.kinetic_energy).sum()),
        damping_dissipation: result.moved.as_ref().map(|moved| moved.damped),
        motion,
        heat: result.heat.as_ref().map(|heat| heat_report(plan, heat)),
        max_strain: most_strained(plan, shown).map(|(_, strained)| strained.strain),
        ..StepReport::default()
    }
}

/// Temperatures and flows of heat.
fn heat_report(plan: &MechanicsPlan, found: &HeatResult) -> HeatReport {
    let system = &plan.system;
    let Some(heat) = &system.heat else { return HeatReport::default() };
    let body = |k: usize| {
        let [min, max] = found.ranges[k]?;
        let given = heat.known.contains_key(&k).then(|| found.known[k]);
        Some((system.bodies[k].name().to_string(), BodyHeat { min, max, stored: found.stored[k], given }))
    };
    let contact = |k: usize| {
        heat.contacts[k]?;
        let (flow, contact) = (found.contacts[k], &system.contacts[k]);
        let mut bodies = contact.bodies().map(|b| system.bodies[b].name().to_string());
        let (mut conducted, mut into) = (flow.conducted, flow.into);
        if plan.contacts[k].swapped {
            bodies.reverse();
            into.reverse();
            conducted = -conducted;
        }
        let report = ContactHeatReport { conducted, friction: flow.friction, bodies, into };
        Some((contact.name().to_string(), report))
    };
    HeatReport {
        passes: found.passes,
        history: found.history.clone(),
        balance: found.imbalance,
        bodies: (0..system.bodies.len()).filter_map(body).collect(),
        supports: heat.supports.iter().map(|s| s.name.clone()).zip(found.supports.iter().copied()).collect(),
        loads: heat.loads.iter().map(|l| l.name.clone()).zip(found.loads.iter().copied()).collect(),
        contacts: (0..system.contacts.len()).filter_map(contact).collect(),
    }
}

pub(super) fn stability_report(system: &System, told: &Stability) -> StabilityReport {
    StabilityReport {
        stable: told.negative_eigenvalues == 0,
        negative_eigenvalues: told.negative_eigenvalues,
        followed: told.followed,
        body: told.body.map(|k| system.bodies[k].name().to_string()),
        critical_time: told.critical_time,
    }
}

/// The forces in a rope at its ends: its tension there. The axial force of a beam is one component of them.
fn end_tensions(system: &System, (state, time): (&SystemState, f64), curve: &CurveShown) -> Option<[f64; 2]> {
    let body = system.bodies.iter().position(|b| b.name() == curve.name).filter(|_| curve.is_rope)?;
    Some(system.end_forces(body, state, time)?.map(|force| force.norm()))
}

fn curve_report(curve: &CurveShown, ends: Option<[f64; 2]>) -> CurveReport {
    let forces = &curve.forces;
    let in_cells = || Some([*forces.first()?, *forces.last()?]);
    let [start_tension, end_tension] = ends.or_else(in_cells).unwrap_or_default();
    let all = || forces.iter().chain(ends.iter().flatten()).copied();
    CurveReport {
        start_tension,
        end_tension,
        max_tension: all().fold(f64::NEG_INFINITY, f64::max),
        min_tension: all().fold(f64::INFINITY, f64::min),
        slack_cells: curve.slack_cells(),
        section: section_report(curve),
        unstrained_length: curve.unstrained_length,
    }
}

fn section_report(curve: &CurveShown) -> Option<SectionReport> {
    let moments = &curve.bending_moments;
    let (at, most) = moments.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
    if curve.is_rope && *most == 0.0 {
        return None;
    }
    let largest = |list: &[f64]| list.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs()));
    Some(SectionReport {
        start_bending_moment: *moments.first()?,
        end_bending_moment: *moments.last()?,
        max_bending_moment: *most,
        max_bending_moment_at: curve.arc.get(at).copied().unwrap_or(0.0),
        max_shear_force: largest(&curve.shear_forces),
        max_torque: largest(&curve.torques),
    })
}

/// Runs of neighbouring sites that carry: along a curve these are the zones of contact.
fn runs(sites: &[SiteResult]) -> Vec<Vec<&SiteResult>> {
    let mut out: Vec<Vec<&SiteResult>> = Vec::new();
    let mut open = true;
    for site in sites {
        if site.status == Status::Open {
            open = true;
            continue;
        }
        match out.last_mut() {
            Some(run) if !open => run.push(site),
            _ => out.push(vec![site]),
        }
        open = false;
    }
    out
}

/// The sites that carry, by connected zones where the contact tells them.
fn zones(sites: &[SiteResult]) -> Vec<Vec<&SiteResult>> {
    let mut out: BTreeMap<usize, Vec<&SiteResult>> = BTreeMap::new();
    for site in sites.iter().filter(|s| s.status != Status::Open) {
        out.entry(site.of_surface.map_or(0, |own| own.zone)).or_default().push(site);
    }
    out.into_values().collect()
}

/// Part of the forces that cancel which is left by rounding, and by iterations that end.
const LEFT: f64 = 1e-10;

/// The sum of forces; components are zero where all that is left of forces that cancel is rounding.
fn resultant(forces: impl Iterator<Item = Vector<3>> + Clone) -> Vector<3> {
    let size: f64 = forces.clone().map(|f| f.norm()).sum();
    forces.sum::<Vector<3>>().map(|f| if f.abs() <= LEFT * size { 0.0 } else { f })
}

fn contact_report(
    plan: &MechanicsPlan,
    (contact, tested): (&dyn Interaction, &ContactInfo),
    sites: &[SiteResult],
) -> ContactReport {
    let closed = || sites.iter().filter(|s| s.status != Status::Open);
    let [slave, _] = contact.bodies();
    let is_curve = matches!(plan.kinds[slave], Kind::Curve { .. });
    // What acts on the first body that the case names.
    let side = if tested.swapped { -1.0 } else { 1.0 };
    // Without negative zeros.
    let on_first = |force: Vector<3>| vector(&force.map(|f| side * f + 0.0));
    let component = |run: &Vec<&SiteResult>| {
        let area: f64 = run.iter().map(|s| s.contact_area()).sum();
        let force = resultant(run.iter().map(|s| s.force()));
        // A single node may carry over no area that could be told.
        let part = |s: &SiteResult| if area > 0.0 { s.contact_area() } else { s.weight };
        let whole: f64 = run.iter().map(|s| part(s)).sum();
        let middle: Vector<3> = run.iter().map(|s| s.x * part(s)).sum::<Vector<3>>() / whole;
        Component { area, force: on_first(force), centroid: vector(&middle), holes: None }
    };
    let zones = if is_curve { runs(sites) } else { zones(sites) };
    let components: Vec<Component> = zones.iter().map(component).collect();
    let rubs = contact.friction().is_some();
    let law = contact.law().friction.as_deref();
    let (holds, wears) = (law.is_some_and(|law| law.strength()[0] > 0.0), law.is_some_and(|law| law.wear() > 0.0));
    let area_of_contact: f64 = sites.iter().map(SiteResult::contact_area).sum();
    // The sum of nothing is a negative zero.
    let area = |status: Status| closed().filter(|s| s.status == status).map(|s| s.contact_area()).sum::<f64>() + 0.0;
    ContactReport {
        slave: Some(plan.system.bodies[slave].name().to_string()),
        force: on_first(resultant(closed().map(|s| s.force()))),
        moment: (plan.space != Space::Axisymmetric)
            .then(|| on_first(resultant(closed().map(|s| (s.acts_at() - plan.moments_about).cross(&s.force()))))),
        carries: tested.carries,
        area: area_of_contact,
        zones: components.len(),
        radius: (tested.carries == TractionKind::Pressure)
            .then(|| ContactReport::radius_of(plan.space, area_of_contact, components.len()))
            .flatten(),
        components,
        max_penetration: sites.iter().filter_map(|s| s.gap).map(|g| -g).fold(0.0, f64::max),
        min_gap_outside: sites.iter().filter(|s| s.status == Status::Open).filter_map(|s| s.gap).reduce(f64::min),
        max_pressure: sites.iter().map(|s| s.shown_pressure()).fold(0.0, f64::max),
        min_pressure: closed().map(|s| s.shown_pressure()).reduce(f64::min),
        stick_area: rubs.then(|| area(Status::Stick)),
        slip_area: rubs.then(|| area(Status::Slip)),
        max_slip: rubs.then(|| closed().map(|s| s.slip).fold(0.0, f64::max)),
        max_friction_utilisation: rubs.then(|| closed().map(|s| s.utilisation).fold(0.0, f64::max)),
        friction_force: rubs.then(|| on_first(resultant(closed().map(|s| s.acting_friction() * s.weight)))),
        max_tension: holds.then(|| closed().map(|s| -s.pressure).fold(0.0, f64::max)),
        max_wear: wears.then(|| sites.iter().map(|s| s.worn).fold(0.0, f64::max)),
        worn_volume: wears.then(|| sites.iter().map(|s| s.worn * s.weight).sum()),
        rope: tested.along_a_curve.then(|| rope_limits((contact, tested), sites)).flatten(),
        ..ContactReport::default()
    }
}

/// What friction could hold of a rope where it touches; none where its law has no coefficients, or no axes that stay.
fn rope_limits((contact, tested): (&dyn Interaction, &ContactInfo), sites: &[SiteResult]) -> Option<RopeLimits> {
    let [along, across] = contact.friction()?.per_pressure()?;
    let friction = match tested.axis {
        AxisChoice::OnMaster(axis) => {
            Friction::Attached { coefficients: [along, across], axis: Arc::new(move |_| axis) }
        }
        AxisChoice::OnSlave(_) | AxisChoice::Material if along != across => return None,
        _ => Friction::Carried { along, across },
    };
    // Friction acts at the surface, tension on the centre line: of a thick rope a part of the lever arm only.
    let thick = |frame: &Darboux, site: &SiteResult| site.weight * (1.0 + site.radius * frame.k_n).max(0.0);
    let of_site = |(frame, site): (Option<Darboux>, &SiteResult)| frame.map(|frame| (frame, thick(&frame, site)));
    let list: Vec<(Darboux, f64)> = frames(sites).into_iter().zip(sites).filter_map(of_site).collect();
    let found = limits_of_points(&list, &friction).ok()?;
    let worst = list.iter().find(|(frame, _)| frame.s == found.steepest.s)?;
    let (tan_alpha, lateral) = (found.steepest.value, friction.lateral(&worst.0));
    let [low, high] = found.log_ratio.map(f64::exp);
    let sideways = if tan_alpha > lateral { "slides sideways" } else { "is closest to sliding sideways" };
    let verdict = format!(
        "{sideways} at s = {:.4}: |tan α| = {tan_alpha:.4}, μ_g = {lateral:.4}; friction along it, without weight, \
         admits T₁/T₀ from {low:.4} to {high:.4}",
        found.steepest.s
    );
    Some(RopeLimits {
        log_ratio: found.log_ratio,
        max_tan_alpha: tan_alpha,
        at: found.steepest.s,
        lateral_limit: lateral,
        verdict,
    })
}

/// The result in a sentence.
pub fn verdict(plan: &MechanicsPlan, record: &Record) -> String {
    let Some(step) = record.steps.last() else { return "No increment was requested.".into() };
    let units = plan.head.unit_names();
    let unit = |of: fn(&UnitNames) -> &String| units.as_ref().map_or("", |u| of(u));
    let space = if plan.space == Space::ThreeD { 3 } else { 2 };
    let mut list: Vec<String> = Vec::new();
    for (name, c) in &step.contacts {
        let on_surface = |kind: &Kind| matches!(kind, Kind::Solid | Kind::Cells);
        let place = plan.system.contacts.iter().find(|contact| contact.name() == name);
        if place.is_some_and(|contact| on_surface(&plan.kinds[contact.bodies()[0]])) {
            let extent = if space == 3 || plan.space == Space::Axisymmetric { "area" } else { "length" };
            list.push(contact_verdict((name, c), (space, extent), units.as_ref(), false));
            continue;
        }
        if c.zones == 0 {
            list.push(format!("`{name}` is open"));
            continue;
        }
        let rubbing = sticking(c);
        let force = told_vector(&c.force[..space], None, unit(|u| &u.force));
        let zones = if c.zones == 1 { String::new() } else { format!(" in {} zones", c.zones) };
        list.push(format!("`{name}` transmits {force}{zones}{rubbing}"));
        if let Some(rope) = &c.rope {
            list.push(rope.verdict.clone());
        }
    }
    for (name, c) in &step.curves {
        let ends = [c.start_tension, c.end_tension].map(|t| told(t, None, unit(|u| &u.force)));
        let slack = match c.slack_cells {
            0 => String::new(),
            n => format!(", {n} cell{} slack", if n == 1 { "" } else { "s" }),
        };
        list.push(format!("the tension of `{name}` is {} at its start and {} at its end{slack}", ends[0], ends[1]));
    }
    for (name, section) in step.curves.iter().filter_map(|(name, c)| Some((name, c.section.as_ref()?))) {
        let of_moments = units.as_ref().map_or(String::new(), |u| format!("{} {}", u.force, u.length));
        let moment = told(section.max_bending_moment, None, &of_moments);
        list.push(format!("the largest bending moment of `{name}` is {moment}"));
    }
    for (name, pose) in &step.free_bodies {
        let moved = told_vector(&pose.displacement[..space], None, unit(|u| &u.length));
        let turned = Vector::<3>::from(pose.turned).norm();
        let turned =
            if turned > 0.0 { format!(" and rotated by {}", told(turned, None, "rad")) } else { String::new() };
        list.push(format!("`{name}` moved by {moved}{turned}"));
    }
    for (name, motion) in &step.motion {
        let velocity = told_vector(&motion.velocity[..space], None, unit(|u| &u.velocity));
        list.push(format!("`{name}` moves with {velocity}"));
    }
    let balance = step.equilibrium_residual.unwrap_or(f64::NAN);
    if list.is_empty() {
        list.push("The bodies are in equilibrium".into());
    }
    format!("{}; forces balance to {balance:.0e}.", list.join("; "))
}

/// What is known of a point of a body: where no body has values at any point, those of the nearest point that is shown.
fn probed(system: &System, states: &[BodyState], shown: &SystemShown, x: &Point<3>) -> Option<Probe> {
    let probe = |at: Point<3>, displacement: [f64; 3], von_mises: Option<f64>, temperature: Option<f64>| Probe {
        at: vector(&at),
        displacement,
        in_contact: None,
        pressure: None,
        von_mises,
        temperature,
    };
    if let Some(found) = system.bodies.iter().zip(states).find_map(|(body, state)| body.at(state, x)) {
        return Some(probe(*x, vector(&found.displacement), Some(found.von_mises), found.temperature));
    }
    let points = shown.bodies.iter().flat_map(|b| {
        let u = b.array("displacement").unwrap_or_default();
        let (stress, heat) = (b.array("von_mises"), b.array("temperature"));
        let at = move |(k, (x, u)): (usize, (&[f64; 3], &[f64]))| {
            (Point::<3>::from(*x), [u[0], u[1], u[2]], stress.map(|s| s[k]), heat.map(|t| t[k]))
        };
        b.points.iter().zip(u.chunks(3)).enumerate().map(at)
    });
    let nearest = points.min_by(|a, b| (a.0 - x).norm().total_cmp(&(b.0 - x).norm()))?;
    Some(probe(nearest.0, nearest.1, nearest.2, nearest.3))
}
