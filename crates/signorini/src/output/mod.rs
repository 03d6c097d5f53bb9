//! Result files: each written under another name first and then renamed, so that a file is whole or absent.

pub(crate) mod camera;
pub mod chart;
pub mod figure;
pub mod film;
pub mod folder;
pub(crate) mod history;
pub(crate) mod labels;
pub(crate) mod level;
pub(crate) mod membrane_line;
pub(crate) mod membrane_map;
pub(crate) mod page;
pub(crate) mod panel;
pub mod pictures;
pub(crate) mod render;
pub mod rigid;
pub mod solid_fields;
pub mod solid_pictures;
mod solid_plane;
pub(crate) mod solid_space;
pub mod solid_state;
pub mod system;
pub(crate) mod system_bodies;
mod system_contacts;
pub mod system_files;
pub mod system_pictures;
pub mod tables;
pub mod vtk;

pub use folder::{Earlier, Files, Folder, OutputError};
