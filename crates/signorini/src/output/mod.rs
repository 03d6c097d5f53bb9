//! Result files: each written under another name first and then renamed, so that a file is whole or absent.

pub mod chart;
pub mod figure;
pub mod film;
pub mod folder;
pub mod pictures;
pub mod solid_fields;
pub mod solid_pictures;
pub mod tables;
pub mod vtk;

pub use folder::{Earlier, Folder, OutputError};
