//! Connected parts of a mesh: elements that share nodes.

use crate::deck::{Deck, Element};
use std::collections::HashMap;

/// The elements of a deck by connected part, each by its place in the list of elements, in the order of the deck.
pub(crate) fn components<'a>(elements: impl Iterator<Item = (usize, &'a Element)>) -> Vec<Vec<usize>> {
    let elements: Vec<(usize, &Element)> = elements.collect();
    let mut parent: Vec<usize> = (0..elements.len()).collect();
    fn root(parent: &mut [usize], mut k: usize) -> usize {
        while parent[k] != k {
            parent[k] = parent[parent[k]];
            k = parent[k];
        }
        k
    }
    let mut first: HashMap<u64, usize> = HashMap::new();
    for (k, (_, element)) in elements.iter().enumerate() {
        for node in &element.nodes {
            let other = *first.entry(*node).or_insert(k);
            let (a, b) = (root(&mut parent, k), root(&mut parent, other));
            parent[a.max(b)] = a.min(b);
        }
    }
    let mut number: HashMap<usize, usize> = HashMap::new();
    let mut out: Vec<Vec<usize>> = Vec::new();
    for (k, (place, _)) in elements.iter().enumerate() {
        let root = root(&mut parent, k);
        let part = *number.entry(root).or_insert_with(|| {
            out.push(Vec::new());
            out.len() - 1
        });
        out[part].push(*place);
    }
    out
}

impl Deck {
    /// Places of the elements of a set, in the list of elements; of all elements without a set. `None` if there is no such set.
    pub(crate) fn elements_of(&self, set: Option<&str>) -> Option<Vec<usize>> {
        let Some(set) = set else { return Some((0..self.elements.len()).collect()) };
        let (_, numbers) = self.element_sets.get(set)?;
        let wanted: std::collections::HashSet<u64> = numbers.iter().copied().collect();
        Some((0..self.elements.len()).filter(|k| wanted.contains(&self.elements[*k].number)).collect())
    }
}
