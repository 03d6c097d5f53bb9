//! Contact mechanics that puts geometry first: the statement of a problem, its run, its results.
pub mod exact;
pub mod explain;
pub mod fields;
pub mod fit;
pub mod gallery;
pub mod height_map;
pub mod mesh_file;
mod npy;
pub mod output;
pub mod paths;
pub mod plan;
pub mod queries;
pub mod relief;
pub mod report;
pub mod reproduce;
pub mod run;
pub mod scene;
pub mod snapshot;
pub mod template;
mod text_table;
pub mod verify;

pub use signorini_expression as expression;
pub use signorini_problem::{self as problem, case};
