//! Small decks: what is read of them, what is refused, and the case that is written.

mod curves;
mod feb;
mod inp;
mod mesh;
mod paths;
mod step;
mod vtu;

use signorini_import::{Deck, ImportError, case, read};
use std::path::PathBuf;
use tempfile::TempDir;

/// Files in a folder of their own; the first is the deck.
fn written(files: &[(&str, &str)]) -> (TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let deck = folder.path().join(files[0].0);
    (folder, deck)
}

fn deck(name: &str, text: &str) -> Result<Deck, ImportError> {
    let (_folder, path) = written(&[(name, text)]);
    read(&path)
}

/// The text of the case of a deck that can be imported.
fn case_of(name: &str, text: &str) -> String {
    case::text(&deck(name, text).unwrap(), name).unwrap()
}

/// The line and the message of a deck that cannot be imported.
fn refused(name: &str, text: &str) -> (Option<usize>, String) {
    let error = deck(name, text).map(|deck| case::text(&deck, name));
    let error = match error {
        Err(error) | Ok(Err(error)) => error,
        Ok(Ok(case)) => panic!("imported as {case}"),
    };
    (error.line, error.message)
}
