//! Input decks of other programs: CalculiX and Abaqus (`.inp`), FEBio (`.feb`), and meshes of VTK (`.vtu`).
//!
//! A deck is read into plain types ([`Deck`]): mesh, sets, materials, supports, loads, contacts and steps. From these the
//! mesh of a body is built ([`mesh::build`]), and the text of a case ([`case::text`]). Paths of MuJoCo (`.xml`) and OpenSim (`.osim`)
//! and lines of MoorDyn (`.txt`, `.dat`) become the text of a case at once ([`case_text`]). Solids of STEP files are read into geometry ([`step`]). A keyword that is not known is an error
//! with its line; what is left out or changed is a [`Remark`] of the deck.

pub mod adjust;
pub mod case;
mod components;
pub mod curve;
pub mod deck;
pub mod element;
mod error;
mod feb;
mod inp;
pub mod mesh;
mod moordyn;
mod paths;
pub mod step;
mod vtu;
mod xml;

pub use deck::{Deck, Remark};
pub use error::ImportError;

use std::path::Path;

/// The kinds of files whose meshes are read, by their extension.
pub const EXTENSIONS: [&str; 3] = ["inp", "feb", "vtu"];

/// Whether the name of a file is that of a deck or mesh.
pub fn is_deck(file: &Path) -> bool {
    extension(file).is_some_and(|e| EXTENSIONS.contains(&e.as_str()))
}

fn extension(file: &Path) -> Option<String> {
    Some(file.extension()?.to_str()?.to_lowercase())
}

/// Reads a whole deck.
///
/// # Errors
/// A file that cannot be read, an unknown extension, and everything in the deck that has no counterpart here, with its line.
pub fn read(file: &Path) -> Result<Deck, ImportError> {
    read_as(file, What::All)
}

/// Reads the mesh of a deck with its sets and surfaces; everything else in it is skipped.
///
/// # Errors
/// A file that cannot be read, an unknown extension, nodes, elements or sets that are wrong.
pub fn read_mesh(file: &Path) -> Result<Deck, ImportError> {
    read_as(file, What::Mesh)
}

/// The case of a file of another program, as TOML: of a deck, or of a model of paths. `way` is the path of the file from the folder
/// of the case; with `keeps_stiffness` linear stiffnesses of contacts are kept as compliances.
///
/// # Errors
/// What [`read`] and [`case::text`] refuse, and models of which nothing can be imported.
pub fn case_text(file: &Path, way: &str, keeps_stiffness: bool) -> Result<String, ImportError> {
    match extension(file).as_deref() {
        Some("xml") => paths::read_mjcf(file),
        Some("osim") => paths::read_osim(file),
        Some("txt" | "dat") => moordyn::read(file),
        _ => case::text(&Deck { keeps_stiffness, ..read(file)? }, way),
    }
}

/// What is read of a deck.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum What {
    All,
    Mesh,
}

fn read_as(file: &Path, what: What) -> Result<Deck, ImportError> {
    match extension(file).as_deref() {
        Some("inp") => inp::read(file, what),
        Some("feb") => feb::read(file, what),
        Some("vtu") if what == What::Mesh => vtu::read(file),
        Some("vtu") => Err(ImportError::new(
            file,
            None,
            "a .vtu file holds a mesh and nothing else: name it in a case, as mesh.file = { file = \"NAME.vtu\" }",
        )),
        _ => Err(ImportError::new(
            file,
            None,
            "cannot be imported: expected a file named .inp (CalculiX, Abaqus), .feb (FEBio), .xml (MuJoCo), .osim (OpenSim), .txt or .dat \
             (MoorDyn)",
        )),
    }
}
