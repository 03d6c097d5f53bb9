//! A choice that has nothing to choose.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A table without keys.
#[derive(Clone, Debug, Default, Deserialize, Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Nothing {}
