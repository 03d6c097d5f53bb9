//! What the cells of a system leave uncertain: the change with functions of one degree more and with cells of half the size, the
//! larger of both, over the whole history.

use super::{MechanicsModel, report};
use crate::output::system::SystemShown;
use crate::plan::Plan;
use crate::plan::mechanics::{MechanicsPlan, cells};
use crate::problem::{Body, Problem, SolidMesh, Space};
use crate::report::{ErrorEstimate, StepReport};
use signorini_contact::Status;
use signorini_mechanics::{IncrementResult, Solved};
use signorini_solve::{Iteration, Progress};

/// The most unknowns of one degree more, times increments, for which errors are estimated: some seconds. Where the whole tangent
/// is factorised in every iteration, unknowns cost several times as much, and in space again; so they do in space where faces of
/// two bodies that deform are cut with each other.
const AFFORDABLE: f64 = 60_000.0;
const FACTORISED: [f64; 2] = [0.25, 0.0625];

/// Iterations that the finer functions may take, in those of the run.
const PATIENCE: usize = 4;

/// Says nothing, but stops where it is asked to, or after so many iterations.
struct Quiet<'a> {
    of: &'a dyn Progress,
    left: usize,
}

impl Progress for Quiet<'_> {
    fn iteration(&mut self, _: &Iteration) {
        self.left = self.left.saturating_sub(1);
    }

    fn interrupted(&self) -> bool {
        self.left == 0 || self.of.interrupted()
    }
}

/// A problem with finer functions, and by how many times these are more along a line.
struct Finer {
    /// With functions of one degree more, and the growth; none where a degree is known to a mesh only.
    raised: Option<(Problem, f64)>,
    /// Whether cells may be halved.
    halves: bool,
    /// Whether halved cells keep the shape of the bodies: of linear cells with curved sides they keep the facets.
    keeps_shape: bool,
}

/// None with bodies whose functions have no degree, ropes and beams, or where all bodies are rigid.
fn finer(problem: &Problem) -> Option<Finer> {
    let mut raised = problem.clone();
    let mut least = None::<i64>;
    let (mut is_known, mut halves, mut deforms, mut is_straight) = (true, true, false, true);
    for body in raised.bodies.values_mut() {
        let (degree, usual) = match body {
            Body::Solid(solid) => {
                let of_box = matches!(solid.mesh, SolidMesh::Box(_)).then_some(1);
                is_straight &= match &solid.mesh {
                    SolidMesh::Box(b) => b.map.is_none(),
                    // Splines keep their shape whatever their degree.
                    mesh => matches!(mesh, SolidMesh::Nurbs(_)),
                };
                (&mut solid.degree, of_box)
            }
            Body::Cells(cells) => {
                halves = false;
                (&mut cells.degree, Some(cells::DEGREE as i64))
            }
            Body::Rigid(_) => continue,
            _ => return None,
        };
        deforms = true;
        let Some(own) = degree.or(usual) else {
            is_known = false;
            continue;
        };
        *degree = Some(own + 1);
        least = Some(least.map_or(own, |l| l.min(own)));
    }
    let raised = least.filter(|_| is_known).map(|degree| (raised, 1.0 + 1.0 / degree as f64));
    // Halved cells have more nodes, and each would carry the force.
    halves &= problem.loads.values().all(|load| load.nodal_force.is_none());
    let keeps_shape = is_straight || least.is_some_and(|degree| degree >= 2);
    deforms.then_some(Finer { raised, halves, keeps_shape })
}

impl Finer {
    /// The plans that are finer, if they grow by no more than so many times along a line: with functions of one degree more, and
    /// with cells of half the size. One alone may agree with the run by chance, as where a zone ends in the same cell.
    fn plans(&self, problem: &Problem, most: f64) -> Vec<MechanicsPlan> {
        let raised = self.raised.as_ref().filter(|(_, growth)| *growth <= most);
        let raised = raised.and_then(|(raised, _)| crate::plan::plan(raised).ok());
        let suits = self.keeps_shape || raised.is_none();
        let halved = if self.halves && suits && most >= 2.0 { crate::plan::halved(problem).ok() } else { None };
        let system = |plan| if let Plan::Mechanics(plan) = plan { Some(*plan) } else { None };
        raised.into_iter().chain(halved).filter_map(system).collect()
    }
}

/// Estimates the errors of the last step of a run with so many unknowns, solved in a way, if that is affordable and has a solution.
pub fn estimate(
    model: &MechanicsModel,
    (unknowns, solved): (usize, Solved),
    record: &[StepReport],
    step: &mut StepReport,
    progress: &mut dyn Progress,
) {
    let plan = &model.plan;
    let in_space = plan.space == Space::ThreeD;
    let deforms = |body: &usize| !plan.system.bodies[*body].is_rigid();
    let cuts = in_space && plan.system.contacts.iter().any(|c| c.bodies().iter().all(deforms));
    let share = if solved == Solved::Condensed && !cuts { 1.0 } else { FACTORISED[usize::from(in_space)] };
    let affordable = share * AFFORDABLE;
    let work = (unknowns * plan.times.len()) as f64;
    // Finer functions come to other states along a path.
    if plan.system.contacts.is_empty() || plan.follows_a_path() || work > affordable {
        return;
    }
    let most = (affordable / work).powf(if in_space { 1.0 / 3.0 } else { 0.5 });
    let Some(finer) = finer(&plan.head.problem) else { return };
    let taken: usize = record.iter().chain([&*step]).map(|s| s.iterations).sum();
    for plan in finer.plans(&plan.head.problem, most) {
        let mut quiet = Quiet { of: progress, left: PATIENCE * taken };
        let Some(fine) = last_step(MechanicsModel::new(plan), &mut quiet) else { continue };
        for (name, found) in &mut step.contacts {
            let Some(fine) = fine.contacts.get(name) else { continue };
            let force: f64 = fine.force.iter().zip(&found.force).map(|(a, b)| (a - b).powi(2)).sum();
            let (area, pressure) = (fine.area - found.area, fine.max_pressure - found.max_pressure);
            let own = ErrorEstimate::of_changes(force.sqrt(), area, pressure);
            found.error_estimate = Some(found.error_estimate.map_or(own, |other| other.larger(&own)));
        }
    }
    for (k, contact) in plan.system.contacts.iter().enumerate().filter(|(_, c)| c.as_points().is_some()) {
        let Ok(sites) = plan.system.sites(k, &model.state) else { continue };
        let closed = sites.iter().filter(|site| site.status != Status::Open).count();
        let Some(found) = step.contacts.get_mut(contact.name()) else { continue };
        if let Some(own) = found.error_estimate.as_mut().filter(|_| closed > 0) {
            own.area = own.area.max(found.area * edge_of_points(plan.space, closed));
        }
    }
}

/// The part of an area, counted by so many points, that lies within half their distance of its edge: finer cells may by chance
/// count the same area. Of a disc in space, and of a zone with two ends, or one around an axis.
fn edge_of_points(space: Space, points: usize) -> f64 {
    match space {
        Space::ThreeD => (std::f64::consts::PI / points as f64).sqrt(),
        _ => 1.0 / points as f64,
    }
}

/// The report of the last step of a run; none where it does not get there.
fn last_step(mut model: MechanicsModel, progress: &mut dyn Progress) -> Option<StepReport> {
    let mut last: Option<(IncrementResult, f64)> = None;
    let mut before = 0.0;
    for (index, time) in model.plan.times.clone().into_iter().enumerate() {
        if last.is_some() {
            model.plan.system.accept(&model.state).ok()?;
        }
        model.set_in_motion(index);
        last = Some((model.reach(index, [before, time], progress).ok()?.ok()?, time));
        before = time;
    }
    let (result, time) = last?;
    let shown = SystemShown::new(&model.plan, &model.state, &result, time);
    Some(report::step_report(&model.plan, &model.state, &result, &shown, model.plan.times.len() - 1))
}
