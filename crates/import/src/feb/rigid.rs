//! Rigid bodies: how they move, and the nodes that move with them.

use super::conditions::place;
use super::curves::{Curves, value};
use super::material::name_of;
use crate::ImportError;
use crate::curve::Curve;
use crate::deck::{Deck, RigidMotion, Support};
use crate::xml::{File, child, children, text};
use roxmltree::Node;

/// The names of the components: displacements, then rotations.
const COMPONENTS: [[&str; 3]; 6] = [
    ["x", "Rx", "Rx_dof"],
    ["y", "Ry", "Ry_dof"],
    ["z", "Rz", "Rz_dof"],
    ["u", "Ru", "Ru_dof"],
    ["v", "Rv", "Rv_dof"],
    ["w", "Rw", "Rw_dof"],
];

fn component(file: &File, node: Node, name: &str) -> Result<usize, ImportError> {
    COMPONENTS.iter().position(|names| names.contains(&name.trim())).ok_or_else(|| {
        file.wrong(node, format!("`{}` is no component of a rigid body: valid are Rx, Ry, Rz, Ru, Rv, Rw", name.trim()))
    })
}

/// The motion of the rigid body that a material number or name stands for.
fn motion<'d>(file: &File, node: Node, stated: &str, deck: &'d mut Deck) -> Result<&'d mut RigidMotion, ImportError> {
    let root = file.document.root_element();
    let name = name_of(root, deck, stated).map(|(name, _)| name.to_string());
    let known = name.filter(|name| deck.rigid.contains(name));
    let name = known.ok_or_else(|| file.wrong(node, format!("there is no rigid body `{stated}`")))?;
    Ok(deck.rigid.entry(&name))
}

/// The section `Rigid`.
pub(super) fn read(file: &File, section: Node, curves: &Curves, deck: &mut Deck) -> Result<(), ImportError> {
    for node in section.children().filter(Node::is_element) {
        let body = child(node, "rb").map(text).unwrap_or_default();
        let kind = node.attribute("type").unwrap_or_default();
        let dof = child(node, "dof").map(text).unwrap_or_default();
        let amount = || child(node, "value").ok_or_else(|| file.wrong(node, "`value` is missing"));
        match (node.tag_name().name(), kind) {
            ("rigid_bc" | "rigid_constraint", "rigid_fixed" | "fix") => {
                let list: Vec<String> = match child(node, "dofs") {
                    Some(dofs) => text(dofs).split(',').map(str::to_string).collect(),
                    None => {
                        let mut on = Vec::new();
                        for [.., name] in COMPONENTS {
                            if file.is_on(node, name)? {
                                on.push(name.to_string());
                            }
                        }
                        on
                    }
                };
                let motion = motion(file, node, &body, deck)?;
                for name in list {
                    motion.components[component(file, node, &name)?] = Some(Curve::constant(0.0));
                }
            }
            ("rigid_bc" | "rigid_constraint", "rigid_displacement" | "rigid_rotation" | "prescribe") => {
                if file.is_on(node, "relative")? {
                    return Err(file.wrong(node, "cannot be imported: motions relative to the present one"));
                }
                let curve = value(file, amount()?, curves)?;
                let place = component(file, node, &dof)?;
                motion(file, node, &body, deck)?.components[place] = Some(curve);
            }
            ("rigid_load", "rigid_force" | "force") => {
                let curve = value(file, amount()?, curves)?;
                let place = component(file, node, &dof)?;
                let motion = motion(file, node, &body, deck)?;
                match motion.force.get_mut(place) {
                    Some(force) => *force = Some(curve),
                    None => return Err(file.wrong(node, "cannot be imported: moments on rigid bodies")),
                }
            }
            (tag, kind) => {
                return Err(file.wrong(
                    node,
                    format!(
                        "cannot be imported: `{tag}` of type `{kind}`; rigid bodies are fixed, moved or pushed here"
                    ),
                ));
            }
        }
    }
    Ok(())
}

/// `rigid_body` in the section `Boundary` of version 2.5.
pub(super) fn of_boundary(file: &File, node: Node, curves: &Curves, deck: &mut Deck) -> Result<(), ImportError> {
    let body = file.attribute(node, "mat")?;
    for entry in node.children().filter(Node::is_element) {
        let place = component(file, entry, file.attribute(entry, "bc")?)?;
        let wrong = |what: &str| file.wrong(entry, format!("cannot be imported: `{what}` of a rigid body"));
        match entry.tag_name().name() {
            "fixed" => motion(file, node, body, deck)?.components[place] = Some(Curve::constant(0.0)),
            "prescribed" => {
                let curve = value(file, entry, curves)?;
                motion(file, node, body, deck)?.components[place] = Some(curve);
            }
            "force" => {
                let curve = value(file, entry, curves)?;
                let motion = motion(file, node, body, deck)?;
                *motion.force.get_mut(place).ok_or_else(|| wrong("moment"))? = Some(curve);
            }
            other => return Err(wrong(other)),
        }
    }
    Ok(())
}

/// Supports of nodes that move with rigid bodies: these move without turning.
pub(super) fn tie(file: &File, deck: &mut Deck) -> Result<(), ImportError> {
    let root = file.document.root_element();
    let boundaries: Vec<Node> = root.descendants().filter(|n| n.tag_name().name() == "Boundary").collect();
    for node in boundaries.into_iter().flat_map(|b| children(b, "bc").collect::<Vec<_>>()) {
        if node.attribute("type") != Some("rigid") {
            continue;
        }
        let body = child(node, "rb").map_or_else(|| node.attribute("rb").unwrap_or_default().to_string(), text);
        let on = place(file, node, file.attribute(node, "node_set")?, deck)?;
        let motion = motion(file, node, &body, deck)?.clone();
        let turns = motion.components[3..].iter().any(|c| c.as_ref().and_then(Curve::as_constant) != Some(0.0));
        if turns || motion.force.iter().any(Option::is_some) {
            deck.carried.push((on, body));
            continue;
        }
        let [x, y, z, ..] = &motion.components;
        let displacement = [x.clone(), y.clone(), z.clone()];
        let tied = displacement.each_ref().map(Option::is_none);
        deck.supports.push(Support { on, displacement, axes: None, tied, from: None, until: None });
    }
    Ok(())
}
