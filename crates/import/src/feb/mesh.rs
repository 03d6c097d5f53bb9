//! Nodes, elements, sets and surfaces.

use crate::ImportError;
use crate::deck::{Deck, Element, Section};
use crate::element::{Kind, Space};
use crate::xml::{File, children, text};
use roxmltree::Node;

/// Reads a section of the mesh.
pub(super) fn read(file: &File, section: Node, deck: &mut Deck) -> Result<(), ImportError> {
    for node in section.children().filter(Node::is_element) {
        match node.tag_name().name() {
            "Nodes" => nodes(file, node, deck)?,
            "Elements" => elements(file, node, deck)?,
            "NodeSet" => {
                let list = members(file, node, deck)?;
                deck.node_sets.entry(file.attribute(node, "name")?).extend(list);
            }
            "ElementSet" => {
                let list = members(file, node, deck)?;
                deck.element_sets.entry(file.attribute(node, "name")?).extend(list);
            }
            "Surface" => surface(file, node, deck)?,
            "SolidDomain" => {
                let (elements, material) = (file.attribute(node, "name")?, file.attribute(node, "mat")?);
                add_section(file, node, deck, elements, material);
            }
            "SurfacePair" | "PartList" | "Part" | "Edge" | "DiscreteSet" => {}
            name => return Err(file.wrong(node, format!("cannot be imported: `{name}` of a mesh is not known here"))),
        }
    }
    Ok(())
}

fn add_section(file: &File, node: Node, deck: &mut Deck, elements: &str, material: &str) {
    deck.sections.push(Section {
        elements: elements.into(),
        material: material.into(),
        axes: None,
        thickness: 1.0,
        line: file.line(node),
    });
}

fn nodes(file: &File, node: Node, deck: &mut Deck) -> Result<(), ImportError> {
    let mut list = Vec::new();
    for entry in children(node, "node") {
        let number = file.whole(entry, file.attribute(entry, "id")?)?;
        let &[number] = &number[..] else { return Err(file.wrong(entry, "expected one number as `id`")) };
        deck.nodes.insert(number, file.vector(entry)?);
        list.push(number);
    }
    if let Some(name) = node.attribute("name") {
        deck.node_sets.entry(name).extend(list);
    }
    Ok(())
}

fn elements(file: &File, node: Node, deck: &mut Deck) -> Result<(), ImportError> {
    let kind = match file.attribute(node, "type")?.to_lowercase().as_str() {
        "tet4" => Kind::Tetrahedron4,
        "tet10" => Kind::Tetrahedron10,
        "penta6" => Kind::Wedge6,
        "penta15" => Kind::Wedge15,
        "hex8" => Kind::Hexahedron8,
        "hex20" => Kind::Hexahedron20,
        "hex27" => Kind::Hexahedron27,
        other => {
            let valid =
                "valid are tet4, tet10, penta6, penta15, hex8, hex20, hex27; there are no shells, trusses or beams";
            return Err(file.wrong(node, format!("cannot be imported: elements of type {other}; {valid}")));
        }
    };
    deck.space = Some(Space::Solid);
    let mut numbers = Vec::new();
    for entry in children(node, "elem") {
        let number = file.whole(entry, file.attribute(entry, "id")?)?;
        let &[number] = &number[..] else { return Err(file.wrong(entry, "expected one number as `id`")) };
        let list = file.whole(entry, &text(entry))?;
        if list.len() != kind.node_count() {
            let message = format!("element {number}: expected {} nodes, found {}", kind.node_count(), list.len());
            return Err(file.wrong(entry, message));
        }
        deck.elements.push(Element { number, kind, nodes: kind.reordered(&list) });
        numbers.push(number);
    }
    let name = node.attribute("name").map_or_else(|| format!("part_{}", deck.sections.len() + 1), str::to_string);
    deck.element_sets.entry(&name).extend(numbers);
    if let Some(material) = node.attribute("mat") {
        add_section(file, node, deck, &name, material);
    }
    Ok(())
}

/// The members of a set: as a text, as children with an `id`, or of other sets.
fn members(file: &File, node: Node, deck: &Deck) -> Result<Vec<u64>, ImportError> {
    let mut out = file.whole(node, node.text().unwrap_or_default())?;
    for entry in node.children().filter(Node::is_element) {
        match (entry.attribute("id"), entry.attribute("node_set")) {
            (Some(id), _) => out.extend(file.whole(entry, id)?),
            (None, Some(set)) => {
                let none = || file.wrong(entry, format!("there is no set of nodes `{set}`"));
                out.extend(deck.node_sets.get(set).ok_or_else(none)?.1);
            }
            _ => out.extend(file.whole(entry, &text(entry))?),
        }
    }
    Ok(out)
}

fn surface(file: &File, node: Node, deck: &mut Deck) -> Result<(), ImportError> {
    let name = file.attribute(node, "name")?;
    let mut faces = Vec::new();
    for entry in node.children().filter(Node::is_element) {
        let vertices = match entry.tag_name().name() {
            "tri3" | "tri6" | "tri7" => 3,
            "quad4" | "quad8" | "quad9" => 4,
            other => {
                return Err(
                    file.wrong(entry, format!("`{other}` is no face: valid are tri3, tri6, quad4, quad8, quad9"))
                );
            }
        };
        let list = file.whole(entry, &text(entry))?;
        if list.len() < vertices {
            return Err(file.wrong(entry, format!("expected {vertices} nodes, found {}", list.len())));
        }
        faces.push(list[..vertices].to_vec());
    }
    deck.surfaces.entry(name).faces.extend(faces);
    Ok(())
}
