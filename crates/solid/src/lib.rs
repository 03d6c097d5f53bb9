//! Elastic solids in contact: bodies, supports, loads, and their equilibrium.
//!
//! - [`material`]: linear elasticity in the plane, around an axis and in space.
//! - [`body`]: bodies and the parts of their boundary.
//! - [`stiffness`]: cells, and how they avoid locking.
//! - [`supports`]: what is prescribed, and the unknowns that remain; [`rigid_modes`]: what nothing holds;
//!   `reactions`: the forces of the supports; `held`: whether contact can hold the rest.
//! - [`contact`]: two sides that may touch; [`friction`]: stick and slip between them.
//! - [`loads`]: forces on sides and in volumes.
//! - [`model`]: everything together, solved at one time, with contacts that slide little.
//! - [`state`]: what comes out.
//! - [`solid_body`]: a solid as one of many bodies of any kind, with [`hyperelastic`] laws at finite strain.

mod assembly;
pub mod body;
pub mod compiled;
mod condensed;
pub mod contact;
mod enforced;
pub mod friction;
mod held;
pub mod hyperelastic;
pub mod loads;
pub use signorini_fem::elastic as material;
pub mod model;
mod nitsche;
mod outcome;
mod reactions;
pub mod rigid_modes;
pub mod solid_body;
pub mod state;
pub mod step_error;
pub mod stiffness;
pub mod supports;

pub use body::{Bodies, Body, BodySurface};
pub use contact::{Contact, ContactResult, Enforcement, Master, Method, PressureNode, RigidGap, facing};
pub use friction::{Friction, FrictionHistory, FrictionResult, RigidMotion, Rubbing};
pub use hyperelastic::{StrainError, StressLaw, Volumetric};
pub use loads::{Load, LoadKind};
pub use material::{Elastic, Space, von_mises};
pub use model::{Circumstances, Memory, Model};
pub use signorini_contact::Route;
pub use solid_body::{EdgeError, EdgeOf, SolidBody, SolidError};
pub use state::State;
pub use step_error::StepError;
pub use supports::{Support, SupportError, SupportKind};

/// Inner parts for the tests in `tests`; no part of the interface.
#[doc(hidden)]
pub mod testing {
    pub use crate::assembly::assemble;
    pub use crate::friction::solve::separated;
    use crate::model::Model;
    use crate::supports::Reduction;
    use signorini_contact::WeightedGap;
    use signorini_solve::cholesky::Cost;

    /// What a factorisation takes, by the matrix itself; none where a step has taken that matrix.
    pub fn exact_cost<const D: usize>(model: &mut Model<D>) -> Option<Cost> {
        model.assemble();
        let matrix = model.reduced.take()?;
        model.symbolic.cost(&matrix).ok()
    }

    /// A row of gaps in the free unknowns.
    pub fn reduced<const D: usize>(row: &WeightedGap, reduction: &Reduction<D>, offset: &[f64]) -> WeightedGap {
        crate::condensed::reduced(row, reduction, offset)
    }
}
