//! Contacts.

use crate::ImportError;
use crate::curve::Curve;
use crate::deck::{ContactPair, Deck, Friction};
use crate::xml::{File, child, text};
use roxmltree::Node;

/// The section `Contact`.
pub(super) fn read(file: &File, section: Node, deck: &mut Deck) -> Result<(), ImportError> {
    for node in section.children().filter(Node::is_element) {
        let kind = file.attribute(node, "type")?;
        let friction = match kind {
            "sliding-node-on-facet"
            | "sliding-facet-on-facet"
            | "sliding-elastic"
            | "sliding_with_gaps"
            | "facet-to-facet sliding"
            | "sliding2" => match child(node, "fric_coeff").map(|n| file.number(n)).transpose()? {
                Some(mu) if mu > 0.0 => Friction::Coulomb(Curve::constant(mu)),
                _ => Friction::None,
            },
            "tied-node-on-facet" | "tied-facet-on-facet" | "tied-elastic" | "tied" | "facet-to-facet tied" => {
                let within = child(node, "max_distance").map(|n| file.number(n)).transpose()?;
                Friction::Tied { within: within.filter(|within| *within > 0.0) }
            }
            "sticky" => sticky(file, node, deck)?,
            other => {
                return Err(file.wrong(
                    node,
                    format!(
                        "cannot be imported: a contact of type `{other}`; valid are sliding-node-on-facet, \
                         sliding-facet-on-facet, sliding-elastic, tied-node-on-facet, tied-facet-on-facet, \
                         tied-elastic and sticky"
                    ),
                ));
            }
        };
        if file.is_on(node, "tension")? {
            return Err(file.wrong(node, "cannot be imported: `tension`, surfaces that pull each other"));
        }
        if let Some(offset) = child(node, "offset").filter(|n| file.number(*n).is_ok_and(|v| v != 0.0)) {
            return Err(file.wrong(offset, "cannot be imported: surfaces with an offset"));
        }
        let pair = file.attribute(node, "surface_pair")?;
        let [slave, master] = surfaces(file, node, pair)?;
        for surface in [&slave, &master] {
            if !deck.surfaces.contains(surface) {
                return Err(file.wrong(node, format!("there is no surface `{surface}`")));
            }
        }
        let line = file.line(node);
        deck.remark(line, "penalties and tolerances of contacts are left out: here surfaces do not penetrate");
        if file.is_on(node, "two_pass")? {
            deck.remark(line, format!("`{pair}`, two_pass: one pass with the first surface as slave is enough here"));
        }
        let name = node.attribute("name").unwrap_or(pair).to_string();
        deck.contacts.push(ContactPair { name, slave, master, friction, stiffness: None, line });
    }
    Ok(())
}

/// A sticky contact: springs of its penalty that let go at a traction; without one a tie.
fn sticky(file: &File, node: Node, deck: &mut Deck) -> Result<Friction, ImportError> {
    let number = |name: &str| child(node, name).map(|n| file.number(n)).transpose();
    let Some(strength) = number("max_traction")?.filter(|v| *v > 0.0) else {
        return Ok(Friction::Tied { within: None });
    };
    let penalty = number("penalty")?.filter(|v| *v > 0.0).unwrap_or(1.0);
    let message = "sticky contacts let go suddenly at their largest traction; here the traction falls to zero over an opening \
                   as long as that at which it is reached";
    deck.remark(file.line(node), message);
    Ok(Friction::Sticky { strength, opening: strength / penalty })
}

/// The surfaces of a pair: slave, master.
fn surfaces(file: &File, node: Node, pair: &str) -> Result<[String; 2], ImportError> {
    let root = file.document.root_element();
    let found = root
        .descendants()
        .find(|n| n.tag_name().name() == "SurfacePair" && n.attribute("name") == Some(pair))
        .ok_or_else(|| file.wrong(node, format!("there is no surface pair `{pair}`")))?;
    let surface = |names: [&str; 2]| {
        let part = names.iter().find_map(|name| child(found, name));
        let part = part.ok_or_else(|| file.wrong(found, format!("`{}` is missing", names[0])))?;
        let name = part.attribute("surface").map_or_else(|| text(part), str::to_string);
        Ok::<String, ImportError>(name.strip_prefix("@surface:").unwrap_or(&name).to_string())
    };
    Ok([surface(["primary", "slave"])?, surface(["secondary", "master"])?])
}
