//! Contact mechanics that puts geometry first: the statement of a problem, its run, its results.
pub mod case;
pub mod exact;
pub mod explain;
pub mod expression;
pub mod fit;
pub mod gallery;
pub mod height_map;
pub mod mesh_file;
pub mod output;
pub mod plan;
pub mod queries;
pub mod relief;
pub mod run;
pub mod scene;
pub mod snapshot;
pub mod template;
pub mod verify;
