//! Input decks of other programs as cases.

use crate::commands::{DONE, report};
use crate::console::{self, say};
use serde_json::json;
use signorini::import::case_text;
use signorini::output::atomic;
use signorini::problem::CaseError;
use std::path::{Component, Path, PathBuf};

/// Writes the case of a deck, beside the deck or to a file; to standard output for `-`.
pub fn import(deck: &Path, output: Option<PathBuf>, keeps_stiffness: bool, json: bool) -> u8 {
    let output = output.unwrap_or_else(|| deck.with_extension("toml"));
    match written(deck, &output, keeps_stiffness) {
        Err(error) => report(&error, json),
        Ok(text) if output == Path::new("-") => {
            console::print(format_args!("{text}"));
            DONE
        }
        Ok(text) => {
            let remarks: Vec<&str> =
                text.lines().take_while(|l| l.starts_with('#')).filter_map(|l| l.strip_prefix("# - ")).collect();
            if json {
                say!("{}", json!({"case": output.display().to_string(), "remarks": remarks}));
            } else {
                say!("{}", output.display());
                remarks.iter().for_each(|remark| say!("  {remark}"));
                say!("\nRun it with  signorini run {}", output.display());
            }
            DONE
        }
    }
}

/// The text of the case, which is written unless it goes to standard output.
fn written(deck: &Path, output: &Path, keeps_stiffness: bool) -> Result<String, CaseError> {
    let to_file = output != Path::new("-");
    let folder = if to_file { output.parent().unwrap_or(Path::new("")) } else { Path::new("") };
    let text = case_text(deck, &way(folder, deck), keeps_stiffness).map_err(|e| CaseError::new(e.to_string()))?;
    if to_file {
        atomic::write(output, text.as_bytes()).map_err(|error| {
            CaseError::new(format!("cannot write `{}`: {error}", output.display()))
                .help("check that the folder exists and that this program may write there")
        })?;
    }
    Ok(text)
}

/// The path of a file from a folder, with slashes.
fn way(folder: &Path, file: &Path) -> String {
    let whole = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf());
    let (folder, file) = (whole(folder), whole(file));
    let parts = |path: &Path| -> Vec<String> {
        path.components()
            .filter(|c| !matches!(c, Component::CurDir))
            .map(|c| c.as_os_str().to_string_lossy().into_owned())
            .collect()
    };
    let (from, to) = (parts(&folder), parts(&file));
    let common = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    if common == 0 {
        return file.display().to_string();
    }
    let up = std::iter::repeat_n("..", from.len() - common);
    up.chain(to[common..].iter().map(String::as_str)).collect::<Vec<_>>().join("/")
}
