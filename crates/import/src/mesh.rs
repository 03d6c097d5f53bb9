//! The mesh of a body from the elements of a deck, with its sets and surfaces as groups.
//!
//! Cells of order 2 that lack nodes in the middle of faces get them where the serendipity map puts them, so a hexahedron of
//! 20 nodes has 27. A set of nodes holds all faces and edges whose nodes are all in it.

use crate::ImportError;
use crate::adjust::{Adjustment, moved};
use crate::components::components;
use crate::deck::{Deck, Element};
use signorini_fem::gmsh::{GmshFile, ListedCells};
use signorini_fem::{Mesh, NodeBetween, Side};
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// Which elements of a deck form a body, and further groups.
#[derive(Clone, Debug, Default)]
pub struct Selection {
    /// A set of elements, or a part; all elements if left out.
    pub group: Option<String>,
    /// A node: only the connected part that contains it.
    pub connected_to: Option<u64>,
    /// Further groups by their nodes.
    pub nodes: Vec<(String, Vec<u64>)>,
    /// Further groups by their faces: an element or a set of elements, and the number of the face, as in `12 S3`.
    pub sides: Vec<(String, Vec<String>)>,
    /// Nodes that are moved onto surfaces.
    pub adjust: Vec<Adjustment>,
}

/// The places of the selected elements in the list of the deck.
///
/// # Errors
/// A set or node that does not exist.
pub fn selected(deck: &Deck, selection: &Selection) -> Result<Vec<usize>, ImportError> {
    let wrong = |message: String| ImportError::new(&deck.file, None, message);
    let list = deck.elements_of(selection.group.as_deref()).ok_or_else(|| {
        let group = selection.group.as_deref().unwrap_or_default();
        wrong(format!("there is no set of elements `{group}`; the file has {}", deck.element_sets.names()))
    })?;
    let Some(node) = selection.connected_to else { return Ok(list) };
    let parts = components(list.iter().map(|k| (*k, &deck.elements[*k])));
    let holds = |part: &Vec<usize>| part.iter().any(|k| deck.elements[*k].nodes.contains(&node));
    parts.into_iter().find(holds).ok_or_else(|| wrong(format!("no element of the body has the node {node}")))
}

/// The mesh of the selected elements. Sets and surfaces that touch it are its groups.
///
/// # Errors
/// Sets, nodes or faces that do not exist; elements of another dimension than the space.
pub fn build<const D: usize>(deck: &Deck, selection: &Selection) -> Result<Mesh<D>, ImportError> {
    let wrong = |message: String| ImportError::new(&deck.file, None, message);
    let list = selected(deck, selection)?;
    let elements: Vec<&Element> = list.iter().map(|k| &deck.elements[*k]).collect();
    if let Some(other) = elements.iter().find(|e| e.kind.dimension() != D) {
        let found = other.kind.dimension();
        return Err(wrong(format!("the element {} has dimension {found}, but the case has {D}", other.number)));
    }
    if elements.is_empty() {
        return Err(wrong("there are no elements".into()));
    }
    let mut positions: BTreeMap<u64, [f64; 3]> = BTreeMap::new();
    for adjustment in &selection.adjust {
        positions.extend(moved(deck, adjustment).map_err(|m| wrong(format!("adjust: {m}")))?);
    }
    let mut numbers: HashMap<u64, u32> = HashMap::new();
    let mut points = Vec::new();
    for element in &elements {
        for node in &element.nodes {
            let Some(x) = positions.get(node).or(deck.nodes.get(node)) else {
                return Err(wrong(format!("the element {} has the node {node}, which does not exist", element.number)));
            };
            numbers.entry(*node).or_insert_with(|| {
                points.push(*x);
                points.len() as u32 - 1
            });
        }
    }
    let cells: Vec<Vec<u32>> = elements.iter().map(|e| e.nodes.iter().map(|node| numbers[node]).collect()).collect();
    let listed: Vec<ListedCells> = (elements.iter().zip(&cells))
        .map(|(e, nodes)| ListedCells { shape: e.kind.shape(), nodes: std::slice::from_ref(nodes) })
        .collect();
    let file = GmshFile::from_arrays(points, &listed).map_err(wrong)?;
    let mesh = file.mesh::<D>(None).map_err(|e| wrong(e.to_string()))?;
    let mut groups = Groups::new(mesh, elements.iter().map(|e| e.number).collect(), numbers);
    groups.add_all(deck);
    for (name, nodes) in &selection.nodes {
        if !groups.add_nodes(name, nodes) {
            return Err(wrong(format!("the group `{name}` contains no node of the body")));
        }
    }
    for (name, faces) in &selection.sides {
        let faces = faces_of(deck, faces).map_err(|m| wrong(format!("the group `{name}`: {m}")))?;
        if !groups.add_faces(name, &faces) {
            return Err(wrong(format!("the group `{name}` contains no face of the body")));
        }
    }
    Ok(groups.mesh)
}

/// The vertices of faces that are given as `ELEMENT-OR-SET FACE`, such as `12 S3` or `TOP P1`.
///
/// # Errors
/// In words: what is no face.
pub fn faces_of(deck: &Deck, list: &[String]) -> Result<Vec<Vec<u64>>, String> {
    let mut places: Option<HashMap<u64, usize>> = None;
    let mut out = Vec::new();
    for text in list {
        let wrong =
            || format!("`{text}` is no face: expected an element or a set of elements and a face, as in \"12 S3\"");
        let (of, face) = text.trim().rsplit_once(char::is_whitespace).ok_or_else(wrong)?;
        let face: usize = face.trim_start_matches(['S', 's', 'P', 'p']).parse().map_err(|_| wrong())?;
        let numbers = match of.trim().parse::<u64>() {
            Ok(number) => vec![number],
            Err(_) => {
                let known = || format!("there is no set of elements `{}`", of.trim());
                deck.element_sets.get(of.trim()).ok_or_else(known)?.1.clone()
            }
        };
        let places =
            places.get_or_insert_with(|| deck.elements.iter().enumerate().map(|(k, e)| (e.number, k)).collect());
        for number in numbers {
            let none = || format!("there is no element {number}");
            let element = &deck.elements[*places.get(&number).ok_or_else(none)?];
            let faces = element.kind.faces();
            let corners = face.checked_sub(1).and_then(|k| faces.get(k)).ok_or_else(|| {
                format!(
                    "the element {number}, a {}, has the faces 1 to {}, not {face}",
                    element.kind.shape(),
                    faces.len()
                )
            })?;
            out.push(corners.iter().map(|v| element.nodes[*v]).collect());
        }
    }
    Ok(out)
}

/// A mesh whose groups are being made.
struct Groups<const D: usize> {
    mesh: Mesh<D>,
    /// The number of each cell in the deck.
    elements: Vec<u64>,
    /// The nodes of the mesh by their numbers in the deck.
    numbers: HashMap<u64, u32>,
    is_vertex: HashSet<u32>,
    boundary: Vec<Side>,
    by_vertices: HashMap<Vec<u32>, Vec<Side>>,
    /// The nodes that are no vertices.
    between: BTreeMap<u32, NodeBetween>,
}

impl<const D: usize> Groups<D> {
    fn new(mut mesh: Mesh<D>, elements: Vec<u64>, numbers: HashMap<u64, u32>) -> Self {
        let is_vertex: HashSet<u32> = (0..mesh.cell_count()).flat_map(|c| mesh.vertices(c)).collect();
        let boundary = mesh.boundary();
        let mut by_vertices: HashMap<Vec<u32>, Vec<Side>> = HashMap::new();
        for side in mesh.all_sides() {
            let mut key = mesh.side_vertices(side);
            key.sort_unstable();
            by_vertices.entry(key).or_default().push(side);
        }
        let mut between = BTreeMap::new();
        for cell in 0..mesh.cell_count() {
            for (place, node) in mesh.cell_nodes(cell).iter().enumerate().filter(|(_, n)| !is_vertex.contains(n)) {
                between.entry(*node).or_insert(NodeBetween { node: *node, cell: cell as u32, place: place as u8 });
            }
        }
        mesh.group_mut("boundary").sides = boundary.clone();
        Self { mesh, elements, numbers, is_vertex, boundary, by_vertices, between }
    }

    /// The sets and surfaces of a deck.
    fn add_all(&mut self, deck: &Deck) {
        for (name, numbers) in deck.element_sets.iter() {
            let wanted: HashSet<u64> = numbers.iter().copied().collect();
            let cells: Vec<u32> =
                (0..self.elements.len() as u32).filter(|c| wanted.contains(&self.elements[*c as usize])).collect();
            if !cells.is_empty() {
                self.mesh.group_mut(&deck.element_group(name)).cells = cells;
            }
        }
        for (name, nodes) in deck.node_sets.iter() {
            self.add_nodes(&deck.node_group(name), nodes);
        }
        for (name, surface) in deck.surfaces.iter() {
            self.add_faces(name, &surface.faces);
            if !surface.nodes.is_empty() {
                self.add_touching(name, &surface.nodes);
            }
        }
    }

    fn of_mesh(&self, nodes: &[u64]) -> BTreeSet<u32> {
        nodes.iter().filter_map(|n| self.numbers.get(n).copied()).collect()
    }

    /// Whether all nodes of a side that the deck has are in a list; nodes that were added in the middle of faces are not asked.
    fn is_whole(&self, side: Side, within: &BTreeSet<u32>) -> bool {
        let vertices = self.mesh.side_vertices(side);
        if !vertices.iter().all(|v| within.contains(v)) {
            return false;
        }
        let cell = side.cell as usize;
        let (map, shape) = (self.mesh.map(cell), self.mesh.shape(cell));
        if map.order() == 1 {
            return true;
        }
        let corners = shape.sides()[side.side as usize];
        let reference = map.nodes();
        let given = self.numbers.len() as u32;
        shape.edges().iter().filter(|e| e.iter().all(|v| corners.contains(v))).all(|[a, b]| {
            let [p, q] = [a, b].map(|v| shape.vertices()[*v]);
            let middle = reference.iter().position(|x| (0..3).all(|k| (x[k] - 0.5 * (p[k] + q[k])).abs() < 1e-9));
            middle.is_none_or(|k| {
                let node = self.mesh.cell_nodes(cell)[k];
                node >= given || within.contains(&node)
            })
        })
    }

    /// Adds a group of nodes; false if the body has none of them.
    fn add_nodes(&mut self, name: &str, nodes: &[u64]) -> bool {
        let within = self.of_mesh(nodes);
        if within.is_empty() {
            return false;
        }
        let sides = self.boundary.iter().copied().filter(|s| self.is_whole(*s, &within)).collect();
        let cells = (0..self.mesh.cell_count())
            .filter(|c| self.mesh.cell_nodes(*c).iter().all(|n| *n >= self.numbers.len() as u32 || within.contains(n)))
            .map(|c| c as u32)
            .collect();
        let vertices = within.iter().copied().filter(|n| self.is_vertex.contains(n)).collect();
        let between = within.iter().filter_map(|n| self.between.get(n).copied()).collect();
        let group = self.mesh.group_mut(name);
        (group.sides, group.cells, group.vertices, group.between) = (sides, cells, vertices, between);
        true
    }

    /// Adds a group of faces, given by their vertices; false if the body has none of them.
    fn add_faces(&mut self, name: &str, faces: &[Vec<u64>]) -> bool {
        let mut sides: BTreeSet<Side> = BTreeSet::new();
        for face in faces {
            let vertices: Option<Vec<u32>> = face.iter().map(|n| self.numbers.get(n).copied()).collect();
            let Some(mut vertices) = vertices else { continue };
            vertices.sort_unstable();
            sides.extend(self.by_vertices.get(&vertices).into_iter().flatten());
        }
        if sides.is_empty() {
            return false;
        }
        self.mesh.group_mut(name).sides.extend(sides);
        true
    }

    /// Adds the faces whose vertices are all in a surface of nodes; if there are none, all faces that have one of its nodes.
    fn add_touching(&mut self, name: &str, nodes: &[u64]) {
        let within = self.of_mesh(nodes);
        let with = |whole: bool| -> Vec<Side> {
            (self.boundary.iter().copied())
                .filter(|s| {
                    let vertices = self.mesh.side_vertices(*s);
                    let mut inside = vertices.iter().map(|v| within.contains(v));
                    if whole { inside.all(|v| v) } else { inside.any(|v| v) }
                })
                .collect()
        };
        let mut sides = with(true);
        if sides.is_empty() {
            sides = with(false);
        }
        if !sides.is_empty() {
            self.mesh.group_mut(name).sides.extend(sides);
        }
    }
}
