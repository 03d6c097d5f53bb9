//! Bodies: connected parts of the mesh with one material. Parts of several materials that share nodes are bodies that are tied.

use super::Names;
use crate::ImportError;
use crate::adjust::Adjustment;
use crate::components::components;
use crate::deck::{Deck, Law};
use signorini_geometry::Point;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// A body of the case.
#[derive(Clone, Debug)]
pub(super) struct Body {
    pub(super) name: String,
    /// Places of its elements in the list of the deck.
    pub(super) elements: BTreeSet<usize>,
    pub(super) contained: BTreeSet<u64>,
    pub(super) group: Option<String>,
    pub(super) connected_to: Option<u64>,
    pub(super) law: Law,
    pub(super) material: String,
    pub(super) axes: Option<[[f64; 3]; 2]>,
    pub(super) is_rigid: bool,
    /// Whether it shares nodes with other bodies, of other materials.
    pub(super) is_split: bool,
    /// Whether it is rigid and does not turn, and is a solid that is held everywhere: it is then touched on the surfaces that
    /// the deck states, and not on all of its boundary.
    pub(super) is_held: bool,
    /// Of a rigid body that is touched on a flat surface: a point of it and the outward normal.
    pub(super) plane: Option<[[f64; 3]; 2]>,
    /// Groups of nodes and faces that supports and loads need.
    pub(super) nodes: Vec<(String, Vec<u64>)>,
    pub(super) sides: Vec<(String, Vec<String>)>,
    pub(super) adjust: Vec<Adjustment>,
}

/// Sine of the angle, and distance relative to the size, within which a surface is flat.
const FLAT: f64 = 1e-6;

/// The plane in which all surfaces lie on which a rigid body is touched, if it does not turn.
pub(super) fn plane(deck: &Deck, body: &Body) -> Option<[[f64; 3]; 2]> {
    let motion = deck.rigid.get(&body.material).map(|(_, motion)| motion);
    let turns = |c: &Option<crate::curve::Curve>| c.as_ref().is_none_or(|c| c.as_constant() != Some(0.0));
    if deck.space().dimension() == 2 || motion.is_some_and(|m| m.components[3..].iter().any(turns)) {
        return None;
    }
    let surfaces = deck.contacts.iter().flat_map(|pair| [&pair.slave, &pair.master]);
    let faces: Vec<&Vec<u64>> = surfaces
        .filter_map(|name| deck.surfaces.get(name))
        .flat_map(|(_, surface)| &surface.faces)
        .filter(|face| face.iter().all(|n| body.contained.contains(n)))
        .collect();
    let at = |n: &u64| Point::<3>::from(deck.nodes[n]);
    let first = faces.first()?;
    let [a, b, c] = [0, 1, 2].map(|k| at(&first[k]));
    let mut normal = (b - a).cross(&(c - a)).try_normalize(0.0)?;
    let size = faces.iter().flat_map(|f| f.iter()).map(|n| (at(n) - a).norm()).fold(0.0, f64::max);
    let is_flat = |n: &u64| (at(n) - a).dot(&normal).abs() <= FLAT * size;
    if !faces.iter().flat_map(|face| face.iter()).all(is_flat) {
        return None;
    }
    let middle = body.contained.iter().map(at).sum::<Point<3>>() / body.contained.len() as f64;
    if (middle - a).dot(&normal) > 0.0 {
        normal = -normal;
    }
    Some([a.into(), (normal + Point::<3>::zeros()).into()])
}

/// Whether a rigid body moves as prescribed without turning.
pub(super) fn is_moved(deck: &Deck, body: &Body) -> bool {
    let Some((_, motion)) = deck.rigid.get(&body.material) else { return true };
    let dimension = deck.space().dimension();
    let turns: &[usize] = if dimension == 3 { &[3, 4, 5] } else { &[5] };
    let rests = |c: &usize| motion.components[*c].as_ref().and_then(|c| c.as_constant()) == Some(0.0);
    turns.iter().all(rests) && motion.components[..dimension].iter().all(Option::is_some)
}

/// The bodies of a deck, in the order of their first elements.
pub(super) fn bodies(deck: &Deck) -> Result<Vec<Body>, ImportError> {
    let wrong = |line: Option<usize>, message: String| ImportError::new(&deck.file, line, message);
    let mut section_of: Vec<Option<usize>> = vec![None; deck.elements.len()];
    for (s, section) in deck.sections.iter().enumerate() {
        let none = || wrong(Some(section.line), format!("there is no set of elements `{}`", section.elements));
        for element in deck.elements_of(Some(&section.elements)).ok_or_else(none)? {
            section_of[element] = Some(s);
        }
    }
    let mut names = Names::default();
    let all = components(deck.elements.iter().enumerate());
    if all.is_empty() {
        return Err(wrong(None, "the deck has no elements".into()));
    }
    let sets: HashMap<&str, BTreeSet<u64>> =
        deck.element_sets.iter().map(|(name, list)| (name, list.iter().copied().collect())).collect();
    let material = |s: usize| {
        let section = &deck.sections[s];
        let none = || wrong(Some(section.line), format!("there is no material `{}`", section.material));
        let (_, material) = deck.materials.get(&section.material).ok_or_else(none)?;
        let none =
            || wrong(Some(material.line), format!("the material `{}` has no law that is known here", section.material));
        material.law.clone().ok_or_else(none)
    };
    // Connected parts; those of several materials by section, which share nodes then.
    let mut parts: Vec<(Vec<usize>, usize, bool)> = Vec::new();
    for part in &all {
        let mut by_section: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
        for element in part {
            let none = || {
                let number = deck.elements[*element].number;
                wrong(None, format!("the element {number} has no section, and so no material"))
            };
            by_section.entry(section_of[*element].ok_or_else(none)?).or_default().push(*element);
        }
        let Some(first) = by_section.keys().next().copied() else { continue };
        let law = material(first)?;
        let density = |section: usize| deck.density(&deck.sections[section].material);
        let mut is_one = true;
        for section in by_section.keys() {
            is_one &= material(*section)? == law
                && density(*section) == density(first)
                && deck.sections[*section].axes == deck.sections[first].axes;
        }
        if is_one {
            parts.push((part.clone(), first, false));
            continue;
        }
        for (section, elements) in by_section {
            let own = components(elements.into_iter().map(|k| (k, &deck.elements[k])));
            parts.extend(own.into_iter().map(|elements| (elements, section, true)));
        }
    }
    let mut out = Vec::new();
    for (part, first, is_split) in &parts {
        let law = material(*first)?;
        let numbers: BTreeSet<u64> = part.iter().map(|k| deck.elements[*k].number).collect();
        let own = &deck.sections[*first].elements;
        let is_own = |name: &str| sets.get(name).is_some_and(|set| *set == numbers);
        let own_name = deck.element_sets.get(own).map_or(own.as_str(), |(name, _)| name);
        let mut equal: Vec<&str> = sets.keys().copied().filter(|name| is_own(name)).collect();
        equal.sort_unstable();
        let group = if is_own(own_name) { Some(own_name) } else { equal.first().copied() };
        // Of a part that shares nodes with others the elements of its section tell it from them.
        let by_section = (*is_split && group.is_none()).then_some(own_name);
        let first_node = deck.elements[part[0]].nodes[0];
        out.push(Body {
            name: names.take(group.unwrap_or(own_name)),
            elements: part.iter().copied().collect(),
            contained: part.iter().flat_map(|k| deck.elements[*k].nodes.iter().copied()).collect(),
            group: group.filter(|_| parts.len() > 1).or(by_section).map(str::to_string),
            connected_to: (group.is_none() && parts.len() > 1).then_some(first_node),
            is_split: *is_split,
            is_rigid: law == Law::Rigid,
            is_held: false,
            plane: None,
            law,
            material: deck.sections[*first].material.clone(),
            axes: deck.sections[*first].axes,
            nodes: Vec::new(),
            sides: Vec::new(),
            adjust: Vec::new(),
        });
    }
    Ok(out)
}
