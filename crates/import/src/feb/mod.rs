//! Input files of FEBio: the solid part of the formats 2.5, 3.0 and 4.0.

mod conditions;
mod contact;
mod curves;
mod material;
mod mesh;
mod rigid;

use crate::deck::{Deck, Step};
use crate::xml::{self, File};
use crate::{ImportError, What};
use std::path::Path;

/// Sections that change nothing in the results here.
const WITHOUT_INFLUENCE: [&str; 4] = ["Globals", "Output", "Material", "LoadData"];

/// Reads a file.
pub(crate) fn read(path: &Path, what: What) -> Result<Deck, ImportError> {
    let text =
        std::fs::read_to_string(path).map_err(|e| ImportError::new(path, None, format!("cannot be read: {e}")))?;
    let options = roxmltree::ParsingOptions { allow_dtd: true, ..roxmltree::ParsingOptions::default() };
    let document = roxmltree::Document::parse_with_options(&text, options)
        .map_err(|e| ImportError::new(path, e.pos().row as usize, format!("not XML: {e}")))?;
    let file = File { path, document: &document };
    let root = document.root_element();
    if root.tag_name().name() != "febio_spec" {
        return Err(file.wrong(root, "not a file of FEBio: expected `febio_spec`"));
    }
    let version = root.attribute("version").unwrap_or_default();
    if !["2.5", "3.0", "4.0"].contains(&version) {
        return Err(file.wrong(root, format!("version {version} of the format: valid are 2.5, 3.0 and 4.0")));
    }
    let mut deck = Deck { file: path.to_path_buf(), finite_strain: true, ..Deck::default() };
    for name in ["Geometry", "Mesh", "MeshDomains"] {
        for section in xml::children(root, name) {
            mesh::read(&file, section, &mut deck)?;
        }
    }
    if what == What::Mesh {
        return Ok(deck);
    }
    let curves = curves::read(&file, root)?;
    material::read(&file, root, &mut deck)?;
    let parts: Vec<roxmltree::Node> = root.children().filter(|n| n.is_element()).collect();
    let steps: Vec<roxmltree::Node> = parts
        .iter()
        .filter(|n| n.tag_name().name() == "Step")
        .flat_map(|n| {
            let inner: Vec<roxmltree::Node> = xml::children(*n, "step").collect();
            if inner.is_empty() { vec![*n] } else { inner }
        })
        .collect();
    for section in &parts {
        if section.tag_name().name() != "Step" {
            part(&file, *section, &curves, &mut deck)?;
        }
    }
    for step in &steps {
        for section in step.children().filter(|n| n.is_element()) {
            let is_control = section.tag_name().name() == "Control";
            let is_empty = !section.children().any(|n| n.is_element());
            if steps.len() > 1 && !is_control && !is_empty {
                return Err(file.wrong(
                    section,
                    "cannot be imported: supports and loads of one of several steps; here they hold at all times",
                ));
            }
            part(&file, section, &curves, &mut deck)?;
        }
    }
    if deck.steps.is_empty() {
        return Err(file.wrong(root, "there is no `Control` with `time_steps` and `step_size`"));
    }
    rigid::tie(&file, &mut deck)?;
    Ok(deck)
}

/// A section of the file or of a step.
fn part(file: &File, section: roxmltree::Node, curves: &curves::Curves, deck: &mut Deck) -> Result<(), ImportError> {
    match section.tag_name().name() {
        "Module" => match section.attribute("type").unwrap_or("solid") {
            "solid" => Ok(()),
            other => Err(file.wrong(section, format!("cannot be imported: the module `{other}`; valid is `solid`"))),
        },
        "Geometry" | "Mesh" | "MeshDomains" => Ok(()),
        "Control" => control(file, section, deck),
        "Boundary" => conditions::boundary(file, section, curves, deck),
        "Rigid" => rigid::read(file, section, curves, deck),
        "Loads" => conditions::loads(file, section, curves, deck),
        "Contact" => contact::read(file, section, deck),
        name if WITHOUT_INFLUENCE.contains(&name) => Ok(()),
        _ if !section.children().any(|n| n.is_element()) => Ok(()),
        "MeshData" => {
            deck.remark(file.line(section), "MeshData: maps of values are left out");
            Ok(())
        }
        name => Err(file.wrong(section, format!("cannot be imported: the section `{name}` is not known here"))),
    }
}

/// Time steps of the analysis.
fn control(file: &File, section: roxmltree::Node, deck: &mut Deck) -> Result<(), ImportError> {
    let analysis = xml::child(section, "analysis");
    if let Some(node) = analysis {
        let kind = node.attribute("type").map_or_else(|| xml::text(node), str::to_string).to_uppercase();
        if !["STATIC", "STEADY-STATE", "0", ""].contains(&kind.as_str()) {
            return Err(
                file.wrong(node, format!("cannot be imported: the analysis {kind}; dynamics do not exist here"))
            );
        }
    }
    let number = |name: &str| -> Result<f64, ImportError> {
        let none = || file.wrong(section, format!("`{name}` is missing"));
        file.number(xml::child(section, name).ok_or_else(none)?)
    };
    let (count, size) = (number("time_steps")?, number("step_size")?);
    if !(count >= 1.0 && size > 0.0) {
        return Err(file.wrong(section, format!("{count} time steps of {size}: both must be positive")));
    }
    let from = deck.steps.last().map_or(0.0, |s| s.to);
    // Twelve digits: 24 steps of 0.1 end at 2.4.
    let to = format!("{:.11e}", from + count * size).parse().unwrap_or(from + count * size);
    deck.steps.push(Step { to, increments: count as usize });
    Ok(())
}
