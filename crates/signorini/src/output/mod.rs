//! Result files: each written under another name first and then renamed, so that a file is whole or absent.

mod camera;
pub mod chart;
pub mod figure;
pub mod film;
pub mod folder;
mod level;
mod page;
pub mod pictures;
mod render;
pub mod solid_fields;
pub mod solid_pictures;
mod solid_space;
pub mod tables;
pub mod vtk;

pub use folder::{Earlier, Folder, OutputError};
