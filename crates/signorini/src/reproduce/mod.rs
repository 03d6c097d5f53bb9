//! The figures of the publication, computed anew: M. Graveleau, N. Chevaugeon & N. Moës, The inequality level-set approach to
//! handle contact: membrane case, Adv. Model. Simul. Eng. Sci. 2:16 (2015).
//!
//! Each figure is a picture and a page of its numbers, with what differs from the publication and why.

mod figures;
mod newton;
mod plot;

pub use figures::FIGURES;

use crate::output::Folder;
use crate::problem::Problem;
use crate::run::run;
use plot::Plot;
use serde_json::{Value, json};
use signorini_solve::Silent;
use std::fmt::Write;
use std::path::Path;

/// A figure of the publication.
pub struct Figure {
    pub name: &'static str,
    pub about: &'static str,
    make: fn(&Path) -> Result<Page, String>,
}

/// What a figure comes to: text, tables and pictures.
#[derive(Default)]
struct Page {
    text: String,
    plots: Vec<(String, Plot)>,
}

impl Page {
    fn paragraph(&mut self, text: &str) {
        let _ = writeln!(self.text, "{text}\n");
    }

    fn table(&mut self, head: &[&str], rows: &[Vec<String>]) {
        let _ = writeln!(self.text, "| {} |\n|{}", head.join(" | "), "---|".repeat(head.len()));
        for row in rows {
            let _ = writeln!(self.text, "| {} |", row.join(" | "));
        }
        self.text.push('\n');
    }

    fn plot(&mut self, name: &str, plot: Plot) {
        let _ = writeln!(self.text, "![{}]({name}.svg)\n", plot.title);
        self.plots.push((name.into(), plot));
    }
}

/// Computes a figure and writes its page and its pictures into a folder.
///
/// # Errors
/// In words, where a case does not run to its end or a file cannot be written.
pub fn reproduce(figure: &Figure, folder: &Path) -> Result<String, String> {
    std::fs::create_dir_all(folder).map_err(|e| format!("{}: {e}", folder.display()))?;
    let scratch = folder.join(format!(".{}-{}", figure.name, std::process::id()));
    let page = (figure.make)(&scratch);
    // What cannot be removed is hidden at least.
    let _ = std::fs::remove_dir_all(&scratch);
    let page = page?;
    let out = Folder::of_earlier_run(folder);
    for (name, plot) in &page.plots {
        let svg = plot.draw().map_err(|e| e.to_string())?;
        out.write(&format!("{name}.svg"), svg.as_bytes()).map_err(|e| e.to_string())?;
    }
    let mut title = figure.about.to_string();
    title[..1].make_ascii_uppercase();
    let text = format!("# {title}\n\n{}`signorini reproduce {}` computes this page.\n", page.text, figure.name);
    out.write(&format!("{}.md", figure.name), text.as_bytes()).map_err(|e| e.to_string())?;
    Ok(text)
}

/// Runs a case of the gallery, changed in some keys; its summary.
fn solved(scratch: &Path, case: &str, set: &[String]) -> Result<Value, String> {
    let mut set = set.to_vec();
    set.push("output.pictures=false".into());
    let problem = problem(case, &set)?;
    // Every run has a folder of its own kind: the last one goes.
    let _ = std::fs::remove_dir_all(scratch);
    let outcome = run(&problem, scratch, &mut Silent).map_err(|e| e.to_string())?;
    if !outcome.summary.converged {
        return Err(format!("{case} with {set:?}: {}", outcome.summary.verdict));
    }
    Ok(json!(outcome.summary))
}

fn problem(case: &str, set: &[String]) -> Result<Problem, String> {
    let example = crate::gallery::find(case).ok_or_else(|| format!("no case `{case}`"))?;
    crate::case::read(example.name, example.case, set).map_err(|e| e.one_line())
}
