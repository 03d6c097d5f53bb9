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
pub mod processes;
pub mod queries;
pub mod relief;
pub mod report;
pub mod reproduce;
pub mod run;
pub mod scene;
pub mod snapshot;
pub mod sweep;
pub mod template;
mod text_table;
pub mod verify;

pub use signorini_expression as expression;
pub use signorini_import as import;
pub use signorini_problem::{self as problem, case};

/// Inner parts for the tests in `tests`; no part of the interface.
#[doc(hidden)]
pub mod testing {
    pub use crate::fit::student::bound;
    pub use crate::output::camera::Camera;
    pub use crate::output::level::{CUBES, region, surface};
    pub use crate::output::membrane_line::{value_at, zones};
    pub use crate::output::membrane_map::{FREE, Field, fill};
    pub use crate::output::page::{Scale, sheet};
    pub use crate::output::panel::{Axis, Panel};
    pub use crate::output::pressure_map::{directed, distance};
    pub use crate::output::render::{Body, Look, Paint, render};
    pub use crate::paths::output::{Line, LinePoint};
    pub use crate::paths::picture::Cover;
    pub use crate::paths::surface::Surface;
    pub use crate::plan::located::LocatedExpression;
    pub use crate::plan::rigid::RigidBody;
    pub use crate::queries::points::read;
    pub use crate::queries::shapes::{KEPT, Shapes};
    pub use crate::run::driver::{Advanced, Model, drive, go_on};
    pub use crate::run::mechanics::recovered::recover;
    pub use crate::run::outcome::Ending;
    pub use crate::run::record::{Record, begin, of_earlier_run};
    pub use crate::run::strain::largest;
    pub use crate::scene::case::Scene;
    pub use crate::scene::picture::{HEAD, SIZE, bodies, camera, seen};
    pub use crate::text_table::{Numbers, rows};
}
