//! Nodes, elements, sets and surfaces of a deck.

use super::card::{Card, Data};
use crate::deck::{Deck, Element, Surface};
use crate::element::{Kind, Space};
use crate::mesh::faces_of;
use crate::{ImportError, What};
use std::collections::{BTreeSet, HashMap};

/// Reads a card of the mesh; others are left alone.
pub(super) fn read(card: &Card, deck: &mut Deck, what: What) -> Result<(), ImportError> {
    match card.name().as_str() {
        "NODE" => nodes(card, deck),
        "ELEMENT" => elements(card, deck, what),
        "NSET" => node_set(card, deck),
        "ELSET" => element_set(card, deck),
        "SYSTEM" => {
            Err(card.wrong(None, "nodes in another system of coordinates are not read; write global coordinates"))
        }
        "PART" | "ASSEMBLY" | "INSTANCE" => Err(card.wrong(
            None,
            "decks with parts and assemblies are not read: write a flat deck (in Abaqus/CAE, Model > Edit attributes > \
             Do not use parts and assemblies in input files)",
        )),
        _ => Ok(()),
    }
}

fn nodes(card: &Card, deck: &mut Deck) -> Result<(), ImportError> {
    if card.value("SYSTEM").is_some_and(|s| s != "R") {
        return Err(card.wrong(None, "only SYSTEM=R, Cartesian coordinates, is read"));
    }
    let mut numbers = Vec::new();
    for data in &card.data {
        let number = card.whole(data, 0, "the number of a node")?;
        let mut x = [0.0; 3];
        for (k, value) in x.iter_mut().enumerate() {
            *value = card.number(data, k + 1)?.unwrap_or(0.0);
        }
        deck.nodes.insert(number, x);
        numbers.push(number);
    }
    if let Some(set) = card.value("NSET") {
        deck.node_sets.entry(set).extend(numbers);
    }
    Ok(())
}

/// The shape of a type of elements, the space that it is for, and what is different here.
fn kind(name: &str) -> Option<(Kind, Space, &'static str)> {
    const REDUCED: &str =
        "reduced integration: the cells here are integrated fully, with a projection of the dilatation";
    const MODES: &str = "incompatible modes: the cells here have none; for bending set `degree = 2`";
    const MIXED: &str = "a pressure of its own: the cells here have a projection of the dilatation in its place";
    let name = name.to_uppercase();
    // A hybrid formulation has an H at the end, tetrahedra of modified formulation an M.
    let (plain, hybrid) = name.strip_suffix('H').map_or((name.as_str(), false), |n| (n, true));
    let (kind, space, differs) = match plain {
        "C3D4" => (Kind::Tetrahedron4, Space::Solid, ""),
        "C3D6" => (Kind::Wedge6, Space::Solid, ""),
        "C3D8" => (Kind::Hexahedron8, Space::Solid, ""),
        "C3D8R" => (Kind::Hexahedron8, Space::Solid, REDUCED),
        "C3D8I" => (Kind::Hexahedron8, Space::Solid, MODES),
        "C3D10" | "C3D10M" | "C3D10T" | "C3D10HS" => (Kind::Tetrahedron10, Space::Solid, ""),
        "C3D15" => (Kind::Wedge15, Space::Solid, ""),
        "C3D20" => (Kind::Hexahedron20, Space::Solid, ""),
        "C3D20R" => (Kind::Hexahedron20, Space::Solid, REDUCED),
        _ => {
            let (space, rest) = if let Some(rest) = plain.strip_prefix("CPE") {
                (Space::PlaneStrain, rest)
            } else if let Some(rest) = plain.strip_prefix("CPS") {
                (Space::PlaneStress, rest)
            } else {
                (Space::Axisymmetric, plain.strip_prefix("CAX")?)
            };
            let (kind, differs) = match rest {
                "3" => (Kind::Triangle3, ""),
                "4" => (Kind::Quadrilateral4, ""),
                "4R" => (Kind::Quadrilateral4, REDUCED),
                "4I" => (Kind::Quadrilateral4, MODES),
                "6" | "6M" => (Kind::Triangle6, ""),
                "8" => (Kind::Quadrilateral8, ""),
                "8R" => (Kind::Quadrilateral8, REDUCED),
                _ => return None,
            };
            (kind, space, differs)
        }
    };
    Some((kind, space, if hybrid { MIXED } else { differs }))
}

fn elements(card: &Card, deck: &mut Deck, what: What) -> Result<(), ImportError> {
    let name = card.required("TYPE")?;
    let Some((kind, space, differs)) = kind(name) else {
        let message = format!(
            "elements of type {name} are not known here: valid are C3D4, 6, 8, 10, 15, 20 and CPE, CPS, CAX with 3, 4, 6, 8 \
             nodes; there are no shells, beams, springs or masses"
        );
        // A mesh is read for its solids.
        return if what == What::Mesh { Ok(()) } else { Err(card.wrong(None, message)) };
    };
    if deck.space.is_some_and(|s| s != space) {
        return Err(card.wrong(None, format!("elements of type {name} beside others for `{}`", deck.space())));
    }
    deck.space = Some(space);
    if !differs.is_empty() {
        deck.remark(card.line, format!("elements {name} have {differs}"));
    }
    let mut pending: Vec<u64> = Vec::new();
    let mut numbers = Vec::new();
    for data in &card.data {
        let fields = data.fields.len() - usize::from(data.fields.last().is_some_and(String::is_empty));
        for field in 0..fields {
            pending.push(card.whole(data, field, "the number of an element or node")?);
        }
        if pending.len() > kind.node_count() + 1 {
            let message =
                format!("the element {} of type {name} has more than {} nodes", pending[0], kind.node_count());
            return Err(card.wrong(data, message));
        }
        if pending.len() == kind.node_count() + 1 {
            let number = pending[0];
            deck.elements.push(Element { number, kind, nodes: kind.reordered(&pending[1..]) });
            numbers.push(number);
            pending.clear();
        }
    }
    if let Some(number) = pending.first() {
        return Err(card.wrong(card.data.last(), format!("the element {number} has too few nodes")));
    }
    if let Some(set) = card.value("ELSET") {
        deck.element_sets.entry(set).extend(numbers);
    }
    Ok(())
}

/// The numbers of a set: listed, generated, or those of other sets.
fn numbers(card: &Card, known: impl Fn(&str) -> Option<Vec<u64>>) -> Result<Vec<u64>, ImportError> {
    let mut out = Vec::new();
    for data in &card.data {
        if card.has("GENERATE") {
            let [first, last] = [0, 1].map(|k| card.whole(data, k, "a number"));
            let (first, last) = (first?, last?);
            let by =
                if data.fields.get(2).is_some_and(|f| !f.is_empty()) { card.whole(data, 2, "a number")? } else { 1 };
            if by == 0 || last < first {
                return Err(card.wrong(data, "expected first, last, increment in ascending order"));
            }
            out.extend((first..=last).step_by(by as usize));
            continue;
        }
        for field in data.fields.iter().filter(|f| !f.is_empty()) {
            match field.parse() {
                Ok(number) => out.push(number),
                Err(_) => {
                    out.extend(known(field).ok_or_else(|| card.wrong(data, format!("there is no set `{field}`")))?)
                }
            }
        }
    }
    Ok(out)
}

fn note_unknown(card: &Card, known: &[&str], deck: &mut Deck) {
    for name in card.unknown(known) {
        deck.remark(card.line, format!("*{}: the parameter {name} is not known and left out", card.keyword));
    }
}

fn node_set(card: &Card, deck: &mut Deck) -> Result<(), ImportError> {
    note_unknown(card, &["NSET", "GENERATE", "UNSORTED", "INTERNAL", "ELSET"], deck);
    let mut list = numbers(card, |name| deck.node_sets.get(name).map(|(_, l)| l.clone()))?;
    if let Some(set) = card.value("ELSET") {
        let none = || card.wrong(None, format!("there is no set of elements `{set}`"));
        let places = deck.elements_of(Some(set)).ok_or_else(none)?;
        list.extend(places.iter().flat_map(|k| deck.elements[*k].nodes.iter().copied()).collect::<BTreeSet<u64>>());
    }
    deck.node_sets.entry(card.required("NSET")?).extend(list);
    Ok(())
}

fn element_set(card: &Card, deck: &mut Deck) -> Result<(), ImportError> {
    note_unknown(card, &["ELSET", "GENERATE", "INTERNAL"], deck);
    let list = numbers(card, |name| deck.element_sets.get(name).map(|(_, l)| l.clone()))?;
    deck.element_sets.entry(card.required("ELSET")?).extend(list);
    Ok(())
}

/// Reads a surface of faces or of nodes.
pub(super) fn surface(card: &Card, deck: &mut Deck) -> Result<(), ImportError> {
    note_unknown(card, &["NAME", "TYPE", "INTERNAL"], deck);
    let name = card.required("NAME")?;
    let mut surface = Surface::default();
    match card.value("TYPE").unwrap_or("ELEMENT").to_uppercase().as_str() {
        "NODE" => surface.nodes = numbers(card, |set| deck.node_sets.get(set).map(|(_, l)| l.clone()))?,
        "ELEMENT" => {
            for data in &card.data {
                let faces = match data.fields.get(1).filter(|f| !f.is_empty()) {
                    Some(face) => faces_of(deck, &[format!("{} {face}", data.fields[0])]),
                    None => free_faces(deck, &data.fields[0]),
                };
                surface.faces.extend(faces.map_err(|message| card.wrong(data, message))?);
            }
        }
        other => return Err(card.wrong(None, format!("TYPE={other}: valid are ELEMENT and NODE"))),
    }
    let entry = deck.surfaces.entry(name);
    entry.faces.extend(surface.faces);
    entry.nodes.extend(surface.nodes);
    Ok(())
}

/// The faces of a set of elements that no other element of the mesh has.
fn free_faces(deck: &Deck, set: &str) -> Result<Vec<Vec<u64>>, String> {
    let places = deck.elements_of(Some(set)).ok_or_else(|| format!("there is no set of elements `{set}`"))?;
    let corners = |element: &Element| -> Vec<Vec<u64>> {
        element.kind.faces().iter().map(|face| face.iter().map(|v| element.nodes[*v]).collect()).collect()
    };
    let key = |face: &Vec<u64>| {
        let mut key = face.clone();
        key.sort_unstable();
        key
    };
    let mut uses: HashMap<Vec<u64>, usize> = HashMap::new();
    deck.elements.iter().flat_map(corners).for_each(|face| *uses.entry(key(&face)).or_default() += 1);
    Ok(places.iter().flat_map(|k| corners(&deck.elements[*k])).filter(|face| uses[&key(face)] == 1).collect())
}

/// The nodes that a field names: a node or a set.
pub(super) fn nodes_of(card: &Card, data: &Data, deck: &Deck) -> Result<Vec<u64>, ImportError> {
    let text = data.fields.first().map_or("", String::as_str);
    if let Ok(number) = text.parse() {
        return if deck.nodes.contains_key(&number) {
            Ok(vec![number])
        } else {
            Err(card.wrong(data, format!("there is no node {number}")))
        };
    }
    let set = deck.node_sets.get(text).ok_or_else(|| {
        card.wrong(data, format!("there is no set of nodes `{text}`; the deck has {}", deck.node_sets.names()))
    })?;
    Ok(set.1.clone())
}
