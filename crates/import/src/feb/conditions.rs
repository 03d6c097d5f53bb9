//! Supports and loads.

use super::curves::{Curves, scale_of, value};
use super::rigid;
use crate::ImportError;
use crate::curve::Curve;
use crate::deck::{Deck, Load, LoadKind, Place, Support};
use crate::xml::{File, child, text};
use roxmltree::Node;

/// The place that an attribute names: a set of nodes, or the nodes of a surface.
pub(super) fn place(file: &File, node: Node, name: &str, deck: &Deck) -> Result<Place, ImportError> {
    let (kind, name) = match name.strip_prefix('@').and_then(|n| n.split_once(':')) {
        Some((kind, name)) => (kind, name),
        None => ("node_set", name),
    };
    match kind {
        "node_set" if deck.node_sets.contains(name) => Ok(Place::NodeSet(name.to_string())),
        "node_set" | "surface" if deck.surfaces.contains(name) => Ok(Place::Surface(name.to_string())),
        "elem_set" if deck.element_sets.contains(name) => Ok(Place::ElementSet(name.to_string())),
        _ => Err(file.wrong(node, format!("there is no set of nodes or surface `{name}`"))),
    }
}

fn direction(file: &File, node: Node, name: &str) -> Result<usize, ImportError> {
    ["x", "y", "z"].iter().position(|d| *d == name.trim()).ok_or_else(|| {
        file.wrong(node, format!("cannot be imported: the degree of freedom `{}`; valid are x, y, z", name.trim()))
    })
}

fn directions(file: &File, node: Node, names: &str) -> Result<Vec<usize>, ImportError> {
    // Rotations of nodes belong to shells.
    names
        .split(',')
        .filter(|n| !["u", "v", "w", "sx", "sy", "sz"].contains(&n.trim()))
        .map(|n| direction(file, node, n))
        .collect()
}

/// Prescribed displacements.
pub(super) fn boundary(file: &File, section: Node, curves: &Curves, deck: &mut Deck) -> Result<(), ImportError> {
    for node in section.children().filter(Node::is_element) {
        let tag = node.tag_name().name();
        let kind = if tag == "bc" { node.attribute("type").unwrap_or_default() } else { tag };
        if tag == "rigid_body" {
            rigid::of_boundary(file, node, curves, deck)?;
            continue;
        }
        let on = |deck: &Deck| place(file, node, file.attribute(node, "node_set")?, deck);
        let mut displacement: [Option<Curve>; 3] = [None, None, None];
        match kind {
            "zero displacement" => {
                for (k, name) in ["x_dof", "y_dof", "z_dof"].into_iter().enumerate() {
                    displacement[k] = file.is_on(node, name)?.then(|| Curve::constant(0.0));
                }
            }
            "fix" => {
                let names =
                    child(node, "dofs").map_or_else(|| node.attribute("bc").unwrap_or_default().to_string(), text);
                for k in directions(file, node, &names)? {
                    displacement[k] = Some(Curve::constant(0.0));
                }
            }
            "prescribed displacement" | "prescribe" => {
                let stated =
                    child(node, "dof").map_or_else(|| node.attribute("bc").unwrap_or_default().to_string(), text);
                let amount = child(node, "value").or(child(node, "scale"));
                let amount = amount.ok_or_else(|| file.wrong(node, "`value` is missing"))?;
                if file.is_on(node, "relative")? {
                    return Err(file.wrong(node, "cannot be imported: displacements relative to the present ones"));
                }
                displacement[direction(file, node, &stated)?] = Some(value(file, amount, curves)?);
            }
            // What these nodes do follows from the motion of the body, which may be stated later.
            "rigid" => continue,
            other => {
                return Err(file.wrong(
                    node,
                    format!(
                        "cannot be imported: `{other}`; valid are zero displacement, prescribed displacement, rigid"
                    ),
                ));
            }
        }
        if displacement.iter().any(Option::is_some) {
            deck.supports.push(Support {
                on: on(deck)?,
                displacement,
                axes: None,
                tied: [false; 3],
                from: None,
                until: None,
            });
        }
    }
    Ok(())
}

/// Loads.
pub(super) fn loads(file: &File, section: Node, curves: &Curves, deck: &mut Deck) -> Result<(), ImportError> {
    for node in section.children().filter(Node::is_element) {
        let kind = node.attribute("type").unwrap_or_default();
        let (on, kind) = match (node.tag_name().name(), kind) {
            ("surface_load", "pressure") => {
                let amount = child(node, "pressure").or(child(node, "scale"));
                let amount = amount.ok_or_else(|| file.wrong(node, "`pressure` is missing"))?;
                if file.is_on(node, "linear")? {
                    deck.remark(file.line(node), "a linear pressure: here it follows the surface");
                }
                (on_surface(file, node, deck)?, LoadKind::Pressure(value(file, amount, curves)?))
            }
            ("surface_load", "traction") => {
                let vector = child(node, "traction").ok_or_else(|| file.wrong(node, "`traction` is missing"))?;
                (on_surface(file, node, deck)?, LoadKind::Traction(vector_value(file, node, vector, curves)?))
            }
            ("nodal_load", "nodal_force") => {
                let vector = child(node, "value").ok_or_else(|| file.wrong(node, "`value` is missing"))?;
                let on = place(file, node, file.attribute(node, "node_set")?, deck)?;
                (on, LoadKind::NodalForce(vector_value(file, node, vector, curves)?))
            }
            ("nodal_load", _) => {
                let stated =
                    child(node, "dof").map_or_else(|| node.attribute("bc").unwrap_or_default().to_string(), text);
                let amount = child(node, "scale").or(child(node, "value"));
                let amount = value(file, amount.ok_or_else(|| file.wrong(node, "`scale` is missing"))?, curves)?;
                let mut force = [0; 3].map(|_| Curve::constant(0.0));
                force[direction(file, node, &stated)?] = amount;
                (place(file, node, file.attribute(node, "node_set")?, deck)?, LoadKind::NodalForce(force))
            }
            (tag, kind) => {
                return Err(file.wrong(
                    node,
                    format!(
                        "cannot be imported: `{tag}` of type `{kind}`; valid are pressure, traction and nodal loads"
                    ),
                ));
            }
        };
        deck.loads.push(Load { on, kind });
    }
    Ok(())
}

fn on_surface(file: &File, node: Node, deck: &Deck) -> Result<Place, ImportError> {
    let name = file.attribute(node, "surface")?;
    match deck.surfaces.get(name) {
        Some((name, _)) => Ok(Place::Surface(name.to_string())),
        None => Err(file.wrong(node, format!("there is no surface `{name}`"))),
    }
}

/// A vector with the load curve of itself or of `scale`.
fn vector_value(file: &File, node: Node, vector: Node, curves: &Curves) -> Result<[Curve; 3], ImportError> {
    let scale = match (child(node, "scale"), scale_of(file, vector, curves)?) {
        (_, Some(curve)) => curve,
        (Some(scale), None) => value(file, scale, curves)?,
        (None, None) => Curve::constant(1.0),
    };
    Ok(file.vector(vector)?.map(|v| scale.scaled(v)))
}
