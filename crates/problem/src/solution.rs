//! How the equations are solved.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the equations are solved.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Solution {
    /// What solves the linear equations of Newton's method; chosen by the program if left out.
    pub linear: Option<LinearMethod>,
}

/// What solves the linear equations of Newton's method.
#[derive(Clone, Debug, Deserialize, Serialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum LinearMethod {
    /// PETSc, with options as on its command line, such as "-ksp_type gmres -pc_type gamg"; "" for the methods of this program. A run
    /// of several processes always uses it.
    Petsc(String),
}
