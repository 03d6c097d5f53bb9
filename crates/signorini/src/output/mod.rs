//! Result files: each written under another name first and then renamed, so that a file is whole or absent.

pub mod atomic;
mod body_fields;
pub(crate) mod camera;
pub mod chart;
pub(crate) mod colours;
pub mod figure;
pub mod film;
pub mod folder;
pub(crate) mod history;
pub(crate) mod labels;
pub(crate) mod level;
pub(crate) mod membrane_line;
pub(crate) mod membrane_map;
mod outline;
pub(crate) mod page;
pub(crate) mod panel;
pub mod pictures;
pub(crate) mod pressure_map;
mod pressure_profile;
pub(crate) mod render;
pub mod rigid;
mod section_forces;
pub mod system;
pub(crate) mod system_bodies;
mod system_contacts;
mod system_cut;
pub mod system_files;
mod system_names;
pub mod system_pictures;
mod system_plane;
mod system_scene;
pub mod tables;
pub mod vtk;

pub use folder::{Earlier, Files, Folder, OutputError};
