//! Bodies of any kind in one system.
//!
//! - [`body`]: what a body is to the system.
//! - [`curve`]: what a curve is to contact between curves.
//! - `rigid_system`: systems in which all that moves is rigid.
//! - [`rigid_body`]: rigid bodies, moved or free; `rotation`: their rotation vectors.
//! - [`pair`]: gap and slip of a contact pair in the unknowns of its bodies.
//! - [`surface`]: what a surface of faces is to contact by mortar, which is [`mortar`].
//! - `density`: how densely a body is tested against faces.
//! - [`contact_law`]: law and enforcement at a point; [`contact`]: the sites of two sides.
//! - [`interaction`]: what acts between bodies, as the system sees it.
//! - [`dynamics`]: masses and motion with inertia; `in_time`: an increment of it, by the equations of [`time_step`], with its
//!   momenta (`moving`) and energy (`energy_in_time`).
//! - [`heat`]: temperatures of bodies, heat through contacts, and both with mechanics in turn.
//! - [`system`]: bodies, supports, loads (`placed`) and contacts, assembled; `linear_constraint`: equations between single nodes.
//! - [`condensed`]: Newton's step with linear bodies factorised once; `eliminated`: with multipliers eliminated.
//! - [`iterative`]: Newton's step of large systems by iterations.
//! - [`processes`]: several processes that solve one system together; `divided`: a system that is divided among them, by the
//!   `partition` of its cells.
//! - [`passage`]: how far steps may be followed so that nothing passes through; `inside`: what lies inside of a rigid body.
//! - [`stability`]: whether a state is stable, on what may move (`admissible`); `branch`: from an unstable state to a stable one.
//! - [`increment`]: equilibrium at one time, by Newton's method (`equilibrium`), other ways where that fails (`homotopy`,
//!   `free`), and outer iterations (`augmentation`); `arc_length`: with the time as an unknown; [`saved`]: what it goes on from.

mod admissible;
mod arc_length;
mod assembler;
mod augmentation;
mod axes;
pub mod body;
mod branch;
pub mod condensed;
mod conserved;
mod constitution;
pub mod contact;
pub mod contact_law;
pub mod curve;
mod density;
mod divided;
mod drawn_tight;
pub mod dynamics;
mod eliminated;
mod energy_in_time;
pub mod enforcement;
mod equilibrium;
mod free;
pub mod heat;
mod homotopy;
mod in_time;
pub mod increment;
pub mod increment_error;
mod inside;
pub mod interaction;
pub mod iterative;
mod linear_bodies;
mod linear_constraint;
pub mod linear_solver;
mod met;
pub mod mortar;
mod moving;
mod nitsche;
mod outer;
pub mod pair;
pub mod part;
mod partition;
pub mod passage;
mod placed;
pub mod points;
mod prepare;
pub mod processes;
mod rest;
mod resultants;
pub mod rigid_body;
mod rigid_system;
mod rotation;
pub mod saved;
pub mod shown_surface;
mod simpler;
mod site_result;
mod slack;
pub mod stability;
pub mod surface;
pub mod system;
pub mod time_step;
mod unstable;

pub use arc_length::{Path, PathIncrement};
pub use axes::Axes;
pub use body::{
    Body, BodyError, BodyFields, BodyState, BoxOfMaterial, Constitution, Constraint, ContactSides, Contribution,
    Elimination, Hold, Kinematics, Load, Means, PlaceError, PointValues, Samples, Slack, UnstableMaterial,
};
pub use contact::{Contact, Pairing, SiteMemory};
pub use contact_law::ContactLaw;
pub use curve::Curve;
pub use density::test_densely;
pub use divided::DivisionError;
pub use dynamics::{Dynamics, Inertial, Mass, Moved, Moving, SpinInertia};
pub use enforcement::Enforcement;
pub use heat::{Conducting, Heat, HeatError, HeatResult, Thermal, ThermalBody};
pub use increment::IncrementResult;
pub use increment_error::IncrementError;
pub use inside::Inside;
pub use interaction::{Assembler, Bodies, Drawn, Interaction, InteractionUnknowns, Iterated, Passing};
pub use linear_constraint::{ConstraintTerm, LinearConstraint};
pub use linear_solver::{Coarse, LinearSolver, Solved, Subspaces};
pub use mortar::{Mortar, Tie, TieFindings};
pub use pair::AxisChoice;
pub use part::Part;
pub use points::{
    Anchor, Direction, Foot, Function, Master, MasterProjection, MaterialPoint, NormalField, Order, RigidFoot,
    Sampling, SecondDerivative, Site, SlavePoint, Turning,
};
pub use rigid_body::{Motion, RigidBody, RigidMass, RigidSite};
pub use saved::Saved;
pub use shown_surface::{SharedSite, ShownSurface};
pub use simpler::SimplerFriction;
pub use site_result::{OfSurface, SiteResult};
pub use stability::{Stability, Unstable};
pub use surface::Surface;
pub use system::{AssemblyError, PlacedLoad, Support, System, SystemState, TimedLoad};

/// Inner parts for the tests in `tests`; no part of the interface.
#[doc(hidden)]
pub mod testing {
    pub use crate::admissible::Admissible;
    use crate::body::BodyState;
    use crate::increment_error::IncrementError;
    pub use crate::partition::bisected;
    use crate::points::Order;
    pub use crate::rotation::{between, of_spin, of_spin_change, spin, turn, unwrapped, whole_turns};
    use crate::system::{AssemblyError, System, SystemState};
    use signorini_solve::general::Entries;

    /// The first unknown of each body, and how many there are.
    pub fn numbering(system: &System) -> (Vec<u32>, usize) {
        system.numbering()
    }

    /// A state that is not predicted from others.
    pub fn state(bodies: Vec<BodyState>, multipliers: Vec<f64>, unknowns: usize) -> SystemState {
        SystemState { bodies, multipliers, travel: vec![0.0; unknowns], ..SystemState::default() }
    }

    /// Begins an increment in time: its equations are those that are assembled from now on.
    pub fn in_time(system: &mut System, from: &mut SystemState, time: f64) -> Result<(), IncrementError> {
        if let Some(dynamics) = system.dynamics {
            system.step = Some(system.time_step(from, time, &dynamics)?);
        }
        Ok(())
    }

    /// The residual at a state at the start, and its tangent.
    pub fn assembled(system: &System, state: &SystemState, order: Order) -> Result<(Vec<f64>, Entries), AssemblyError> {
        system.assemble(state, 0.0, order).map(|at| (at.residual, at.tangent))
    }
}
