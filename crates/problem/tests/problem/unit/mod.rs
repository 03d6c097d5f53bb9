//! Parts by themselves.

mod case_override_key;
mod case_renamed;
mod case_schema;
mod case_toml_error;
mod error;
mod units;
