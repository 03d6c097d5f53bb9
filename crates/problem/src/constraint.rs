//! Linear equations between displacements of single nodes.

use super::{List, Value};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// An equation between displacements of single nodes of solids: the sum of `factor · displacement` over all terms is `value`.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LinearConstraint {
    /// Terms of the sum.
    pub terms: List<ConstraintTerm>,
    /// The value of the sum, a length; zero if left out.
    pub value: Option<Value>,
}

/// A node, and the vector by which its displacement is multiplied.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ConstraintTerm {
    /// Group of a solid that holds one node: `BODY:GROUP`.
    pub on: String,
    /// Coefficients of the components of the displacement.
    pub factor: List<Value>,
}
