//! Several processes that solve one case together, started by `mpirun`.
//!
//! Each of them reads the case and takes the same decisions. The first one writes the results and speaks for all, unless another
//! one is the first that something is wrong with.

use crate::plan::mechanics::{Kind, MechanicsPlan};
#[cfg(feature = "petsc")]
use crate::plan::{Size, check_memory};
#[cfg(feature = "petsc")]
use crate::problem::LinearMethod;
use crate::problem::{CaseError, Problem};
use crate::run::environment::fnv1a;
#[cfg(feature = "petsc")]
use crate::run::environment::resident_memory;
use signorini_mechanics::processes::Processes;
#[cfg(feature = "petsc")]
use signorini_petsc::World;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// The process that speaks for all.
static SPEAKER: AtomicUsize = AtomicUsize::new(0);

/// How many processes were started together, by the environment.
pub fn started() -> usize {
    signorini_petsc::started()
}

/// How many of them are on this machine.
pub fn started_here() -> usize {
    signorini_petsc::started_here()
}

/// Connects processes that were started together. The thread that calls it is the one that has to run the case.
///
/// # Errors
/// A program that was built without the feature `petsc`; what PETSc and MPI cannot do.
#[cfg(feature = "petsc")]
pub fn connect() -> Result<(), CaseError> {
    World::start().map(drop).map_err(CaseError::new)
}

/// Connects processes that were started together: none can be in a program without the feature `petsc`.
///
/// # Errors
/// Always.
#[cfg(not(feature = "petsc"))]
pub fn connect() -> Result<(), CaseError> {
    let message = match started() {
        1 => "this program was built without PETSc".to_string(),
        n => format!(
            "{n} processes were started together, but this program was built without MPI: each would do the same"
        ),
    };
    Err(CaseError::new(message).help("build it with  --features petsc  (docs/cluster.md), or run one process"))
}

#[cfg(feature = "petsc")]
fn world() -> Option<World> {
    World::started()
}

/// The number of this process, from 0.
#[cfg(feature = "petsc")]
pub fn rank() -> usize {
    world().map_or(0, |world| world.rank())
}

/// The number of this process, from 0.
#[cfg(not(feature = "petsc"))]
pub fn rank() -> usize {
    0
}

/// Whether this process prints: one of those that were started together.
pub fn speaks() -> bool {
    let rank = if is_connected() { rank() } else { signorini_petsc::started_as() };
    rank == SPEAKER.load(Ordering::Relaxed)
}

/// All processes, where there are several: to share the work of making bodies.
#[cfg(feature = "petsc")]
pub(crate) fn several() -> Option<Arc<dyn Processes>> {
    world().filter(|world| world.count() > 1).map(|world| Arc::new(world) as _)
}

/// All processes, where there are several.
#[cfg(not(feature = "petsc"))]
pub(crate) fn several() -> Option<Arc<dyn Processes>> {
    None
}

/// The least of the numbers of all processes, of what they might see differently, such as the memory that is free.
pub(crate) fn least(own: f64) -> f64 {
    let all = several().map_or_else(Vec::new, |processes| processes.gather(&[own]));
    all.into_iter().flatten().fold(own, f64::min)
}

/// Whether all processes have the same bytes.
pub(crate) fn agree(bytes: &[u8]) -> bool {
    let Some(processes) = several() else { return true };
    let hash = fnv1a(bytes);
    let own = [bytes.len() as f64, (hash >> 32) as f64, (hash & u64::from(u32::MAX)) as f64];
    processes.gather(&own).iter().all(|other| *other == own)
}

/// The word of the first process, on all of them: of what they might see differently, such as the time.
#[cfg(feature = "petsc")]
pub(crate) fn agreed(own: bool) -> bool {
    match world().filter(|world| world.count() > 1) {
        Some(world) => {
            let mut word = [f64::from(u8::from(own && world.rank() == 0))];
            world.sum(&mut word);
            word[0] > 0.0
        }
        None => own,
    }
}

/// The word of the first process, on all of them.
#[cfg(not(feature = "petsc"))]
pub(crate) fn agreed(own: bool) -> bool {
    own
}

/// Unknowns of a system that is divided, what solves its equations, and about how much memory that takes on this machine.
///
/// # Errors
/// Less memory than that.
#[cfg(feature = "petsc")]
fn size_of(plan: &MechanicsPlan, world: World) -> Result<Size, CaseError> {
    let share = plan.system.share().copied().unwrap_or_default();
    let (own, iterates) = world.memory(&share, || plan.system.factor_memory());
    let here = started_here().min(world.count());
    let needed = world.largest(own) * here as f64;
    let by = if iterates { "iterations of PETSc" } else { "factors of MUMPS" };
    let how = format!("{by} in {} processes, {here} of them on this machine,", world.count());
    check_memory(
        &plan.head.problem,
        &format!("the equations of {} unknowns, solved by {how}", share.unknowns),
        needed,
    )?;
    // Bodies are there already.
    let bodies = world.largest(resident_memory().unwrap_or(0) as f64) * here as f64;
    Ok(Size::new(share.unknowns, how.trim_end_matches(','), needed + bodies))
}

/// What is wrong on one process is wrong on all; the first of them tells it.
///
/// # Errors
/// Its own, or that of the first process with one.
#[cfg(feature = "petsc")]
pub fn all<T, E: std::fmt::Display + From<CaseError>>(own: Result<T, E>) -> Result<T, E> {
    let Some(world) = world().filter(|world| world.count() > 1) else { return own };
    let word = own.as_ref().err().map(|error| format!("{} {error}", world.rank()));
    match world.first_word(word) {
        None => own,
        Some(word) => {
            let (rank, message) = word.split_once(' ').unwrap_or(("0", &word));
            SPEAKER.store(rank.parse().unwrap_or(0), Ordering::Relaxed);
            match own {
                Err(error) => Err(error),
                Ok(_) => Err(CaseError::new(format!("process {rank}: {message}")).into()),
            }
        }
    }
}

/// What is wrong on one process is wrong on all.
///
/// # Errors
/// Its own.
#[cfg(not(feature = "petsc"))]
pub fn all<T, E: std::fmt::Display + From<CaseError>>(own: Result<T, E>) -> Result<T, E> {
    own
}

/// Ends this process in order: all of them do.
pub fn end() {
    #[cfg(feature = "petsc")]
    if let Some(world) = world() {
        world.end();
    }
}

/// Ends all processes at once, where this one cannot go on and others do not know of it.
pub fn abort(code: u8) {
    #[cfg(feature = "petsc")]
    if let Some(world) = world().filter(|world| world.count() > 1) {
        world.abort(code);
    }
    let _ = code;
}

/// Options of PETSc that nothing used, as a warning.
pub(crate) fn remark() -> Option<String> {
    #[cfg(feature = "petsc")]
    if let Some(world) = world() {
        let unused = world.unused_options();
        if !unused.is_empty() {
            let names: Vec<String> = unused.iter().map(|name| format!("`-{name}`")).collect();
            return Some(format!(
                "PETSc did not use the options {}: no solver of this run has them (see  -help  of PETSc)",
                names.join(", ")
            ));
        }
    }
    None
}

/// Refuses what is not for several processes, of a model that is none of bodies in one system.
///
/// # Errors
/// Where there are several.
pub fn refuse(what: &str) -> Result<(), CaseError> {
    match started() {
        n if n > 1 && is_connected() => Err(not_yet(what)),
        _ => Ok(()),
    }
}

#[cfg(feature = "petsc")]
fn is_connected() -> bool {
    world().is_some()
}

#[cfg(not(feature = "petsc"))]
fn is_connected() -> bool {
    false
}

fn not_yet(what: &str) -> CaseError {
    CaseError::new(format!("{what} cannot be solved by several processes"))
        .help("run it with one process; docs/cluster.md tells what several can solve")
}

/// Whether PETSc solves a problem: where there are several processes, or it is asked for.
pub(crate) fn by_petsc(problem: &Problem) -> bool {
    is_connected() || problem.method.as_ref().is_some_and(|method| method.linear.is_some())
}

/// Divides the system of a plan among the processes, where there are several or PETSc is asked for.
///
/// # Errors
/// What only one process can solve; a program without PETSc that is asked for; more processes than cells.
pub(crate) fn divide(plan: &mut MechanicsPlan) -> Result<(), CaseError> {
    let problem = &plan.head.problem;
    if !by_petsc(problem) {
        return Ok(());
    }
    let wanted = problem.method.as_ref().and_then(|method| method.linear.as_ref());
    let at = |error: CaseError| match wanted {
        Some(linear) => CaseError { help: error.help.clone(), ..problem.error(linear, error.message) },
        None => error,
    };
    let kind = |k: &Kind| match k {
        Kind::Curve { .. } => Some("ropes and beams"),
        Kind::Rigid { is_free: true, .. } => Some("free rigid bodies"),
        Kind::Solid | Kind::Cells | Kind::Rigid { .. } => None,
    };
    let what = plan.kinds.iter().find_map(kind);
    let what = what.or_else(|| plan.motion.dynamics.iter().any(Option::is_some).then_some("motion with inertia"));
    let what = what.or_else(|| plan.follows_a_path().then_some("a path of equilibria"));
    if let Some(what) = what {
        return Err(at(not_yet(what)));
    }
    connect().map_err(at)?;
    #[cfg(feature = "petsc")]
    {
        let world = World::start().map_err(|message| at(CaseError::new(message)))?;
        if let Some(LinearMethod::Petsc(options)) = wanted {
            world.options(options).map_err(|message| at(CaseError::new(message)))?;
        }
        let divided = plan.system.divide(Arc::new(world));
        divided.map_err(|error| at(CaseError::new(error.to_string())))?;
        let size = size_of(plan, world);
        let size = all(size)?;
        plan.notes.push(size.told.clone());
        plan.head.size = Some(size);
        if plan.system.bodies.iter().any(|body| !body.is_rigid() && !body.is_linear()) {
            let message = "states at finite strain are not tested for stability where PETSc solves";
            plan.head.warnings.push(message.into());
        }
    }
    Ok(())
}
