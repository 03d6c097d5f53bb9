//! Gmsh meshes: MSH 2.2 and 4.1, ASCII and binary, with physical groups.
//!
//! Cells of order 1 and 2 are read: triangles, quadrilaterals, tetrahedra, hexahedra and wedges, serendipity cells
//! included (their missing nodes are where the serendipity map puts them).

use crate::cell_map::CellMap;
use crate::mesh::{Mesh, Side};
use crate::reference::{CellShape, Local};
use signorini_geometry::Point;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// A mesh file that cannot be used, and where it is wrong.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum GmshError {
    #[error("this is no Gmsh mesh: it does not begin with $MeshFormat")]
    NotGmsh,
    #[error("version {found} of the format is not known: save the mesh as version 4.1 or 2.2")]
    Version { found: String },
    #[error("line {line}: expected {wanted}, found `{found}`")]
    Malformed { line: usize, wanted: &'static str, found: String },
    #[error("the file ends within {section}")]
    Truncated { section: &'static str },
    #[error("{section}: {count} is no possible number here")]
    Count { section: &'static str, count: i64 },
    #[error("element {element} is a {what}, which cannot be used: only cells of order 1 and 2, no pyramids")]
    Element { element: u64, what: String },
    /// `place` is the line of a text file, with what parts it from the rest; empty where there is none.
    #[error("{place}element {element} has the node {node}, which the file does not define")]
    NoNode { place: String, element: u64, node: u64 },
    #[error("node {node} appears twice")]
    Twice { node: u64 },
    #[error("there is no physical group `{group}` of dimension {dimension}; the file has {known}")]
    NoGroup { group: String, dimension: usize, known: String },
    #[error("the file has no cells of dimension {dimension}: {hint}")]
    NoCells { dimension: usize, hint: &'static str },
    #[error("node {node} is at z = {z}: a plane mesh lies in z = 0")]
    NotPlane { node: u64, z: f64 },
}

#[derive(Clone, Debug)]
struct Element {
    number: u64,
    kind: i64,
    /// The curve, surface or volume that it is a part of.
    entity: i64,
    groups: Vec<i64>,
    nodes: Vec<u64>,
}

impl Element {
    /// Dimension of its shape, which is known once it was read.
    fn dimension(&self) -> usize {
        kind(self.kind).and_then(|kind| kind.shape).map_or(0, CellShape::dimension)
    }
}

/// What a mesh file holds.
#[derive(Clone, Debug, Default)]
pub struct GmshFile {
    nodes: HashMap<u64, [f64; 3]>,
    elements: Vec<Element>,
    /// Names of physical groups by dimension and number.
    names: BTreeMap<(usize, i64), String>,
}

/// Reads tokens, or raw numbers where the file is binary.
struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
    binary: bool,
    swapped: bool,
    section: &'static str,
}

impl<'a> Source<'a> {
    fn line_number(&self) -> usize {
        1 + self.bytes[..self.at.min(self.bytes.len())].iter().filter(|b| **b == b'\n').count()
    }

    fn token(&mut self) -> Result<&'a str, GmshError> {
        while self.bytes.get(self.at).is_some_and(|b| b.is_ascii_whitespace()) {
            self.at += 1;
        }
        let start = self.at;
        while self.bytes.get(self.at).is_some_and(|b| !b.is_ascii_whitespace()) {
            self.at += 1;
        }
        if start == self.at {
            return Err(GmshError::Truncated { section: self.section });
        }
        std::str::from_utf8(&self.bytes[start..self.at]).map_err(|_| self.malformed("text", "bytes"))
    }

    fn malformed(&self, wanted: &'static str, found: &str) -> GmshError {
        GmshError::Malformed { line: self.line_number(), wanted, found: found.chars().take(40).collect() }
    }

    /// The rest of the line, for example after a count that binary data follow.
    fn end_line(&mut self) {
        while self.bytes.get(self.at).is_some_and(|b| *b != b'\n') {
            self.at += 1;
        }
        self.at = (self.at + 1).min(self.bytes.len());
    }

    fn raw<const N: usize>(&mut self) -> Result<[u8; N], GmshError> {
        let slice = self.bytes.get(self.at..self.at + N).ok_or(GmshError::Truncated { section: self.section })?;
        self.at += N;
        let mut out = [0; N];
        out.copy_from_slice(slice);
        if self.swapped {
            out.reverse();
        }
        Ok(out)
    }

    fn text_integer(&mut self) -> Result<i64, GmshError> {
        let token = self.token()?;
        token.parse().map_err(|_| self.malformed("a whole number", token))
    }

    /// Four bytes where binary.
    fn integer(&mut self) -> Result<i64, GmshError> {
        if self.binary { Ok(i64::from(i32::from_le_bytes(self.raw()?))) } else { self.text_integer() }
    }

    /// Eight bytes where binary.
    fn size(&mut self) -> Result<i64, GmshError> {
        if self.binary { Ok(i64::from_le_bytes(self.raw()?)) } else { self.text_integer() }
    }

    fn number(&mut self) -> Result<f64, GmshError> {
        if self.binary {
            return Ok(f64::from_le_bytes(self.raw()?));
        }
        let token = self.token()?;
        token.parse().map_err(|_| self.malformed("a number", token))
    }

    /// A count of things, each of which takes at least one byte.
    fn count(&self, count: i64) -> Result<usize, GmshError> {
        if count < 0 || count as u64 > self.bytes.len() as u64 {
            return Err(GmshError::Count { section: self.section, count });
        }
        Ok(count as usize)
    }

    /// The head of a section of version 4.1: the number of its blocks, then three that are not needed.
    fn blocks(&mut self) -> Result<usize, GmshError> {
        let blocks = self.size()?;
        for _ in 0..3 {
            self.size()?;
        }
        self.count(blocks)
    }

    /// Moves behind the next line that is exactly this one; false at the end of the file.
    fn skip_to(&mut self, line: &str) -> bool {
        let mut at = self.at;
        while at < self.bytes.len() {
            let end = self.bytes[at..].iter().position(|b| *b == b'\n').map_or(self.bytes.len(), |n| at + n);
            if self.bytes[at..end].trim_ascii() == line.as_bytes() {
                self.at = (end + 1).min(self.bytes.len());
                return true;
            }
            at = end + 1;
        }
        false
    }
}

impl GmshFile {
    /// Reads a file.
    ///
    /// # Errors
    /// What is wrong with it, and in which line of a text file.
    pub fn parse(bytes: &[u8]) -> Result<Self, GmshError> {
        let mut s = Source { bytes, at: 0, binary: false, swapped: false, section: "$MeshFormat" };
        if !s.skip_to("$MeshFormat") {
            return Err(GmshError::NotGmsh);
        }
        let version = s.token()?.to_string();
        let is_binary = s.text_integer()? == 1;
        s.text_integer()?;
        let new = match version.as_str() {
            "4.1" => true,
            "2.2" | "2" | "2.0" | "2.1" => false,
            _ => return Err(GmshError::Version { found: version }),
        };
        if is_binary {
            s.end_line();
            s.binary = true;
            if s.integer()? != 1 {
                s.swapped = true;
            }
            s.binary = false;
        }
        let mut file = GmshFile::default();
        // Physical groups of the entities, by dimension and number.
        let mut entities: HashMap<(i64, i64), Vec<i64>> = HashMap::new();
        if s.skip_to("$PhysicalNames") {
            s.section = "$PhysicalNames";
            let n = s.text_integer()?;
            for _ in 0..s.count(n)? {
                let (dimension, number) = (s.text_integer()?, s.text_integer()?);
                let start = s.at;
                s.end_line();
                let line = String::from_utf8_lossy(&bytes[start..s.at]);
                let name = line.trim().trim_matches('"').to_string();
                if !(0..=3).contains(&dimension) {
                    return Err(GmshError::Count { section: s.section, count: dimension });
                }
                file.names.insert((dimension as usize, number), name);
            }
        }
        if new && s.skip_to("$Entities") {
            s.section = "$Entities";
            s.binary = is_binary;
            let mut counts = [0; 4];
            for c in &mut counts {
                let n = s.size()?;
                *c = s.count(n)?;
            }
            for (dimension, count) in counts.into_iter().enumerate() {
                for _ in 0..count {
                    let tag = s.integer()?;
                    for _ in 0..if dimension == 0 { 3 } else { 6 } {
                        s.number()?;
                    }
                    let n = s.size()?;
                    let groups = (0..s.count(n)?).map(|_| s.integer()).collect::<Result<Vec<_>, _>>()?;
                    if dimension > 0 {
                        let n = s.size()?;
                        for _ in 0..s.count(n)? {
                            s.integer()?;
                        }
                    }
                    // Negative numbers say that the entity is used the other way round.
                    entities.insert((dimension as i64, tag), groups.into_iter().map(i64::abs).collect());
                }
            }
            s.binary = false;
        }
        if !s.skip_to("$Nodes") {
            return Err(GmshError::Truncated { section: "the part before $Nodes" });
        }
        s.section = "$Nodes";
        if new {
            file.nodes_41(&mut s, is_binary)?
        } else {
            file.nodes_22(&mut s, is_binary)?
        }
        if !s.skip_to("$Elements") {
            return Err(GmshError::Truncated { section: "the part before $Elements" });
        }
        s.section = "$Elements";
        if new {
            file.elements_41(&mut s, is_binary, &entities)?
        } else {
            file.elements_22(&mut s, is_binary)?
        }
        Ok(file)
    }

    fn node(&mut self, tag: i64, x: [f64; 3]) -> Result<(), GmshError> {
        match self.nodes.insert(tag as u64, x) {
            Some(_) => Err(GmshError::Twice { node: tag as u64 }),
            None => Ok(()),
        }
    }

    fn nodes_22(&mut self, s: &mut Source<'_>, binary: bool) -> Result<(), GmshError> {
        let n = s.text_integer()?;
        let n = s.count(n)?;
        if binary {
            s.end_line();
        }
        s.binary = binary;
        for _ in 0..n {
            let tag = s.integer()?;
            let x = [s.number()?, s.number()?, s.number()?];
            self.node(tag, x)?;
        }
        s.binary = false;
        Ok(())
    }

    fn nodes_41(&mut self, s: &mut Source<'_>, binary: bool) -> Result<(), GmshError> {
        s.binary = binary;
        for _ in 0..s.blocks()? {
            let dimension = s.integer()?;
            s.integer()?;
            let parametric = s.integer()? != 0;
            let n = s.size()?;
            let tags = (0..s.count(n)?).map(|_| s.size()).collect::<Result<Vec<_>, _>>()?;
            for tag in tags {
                let x = [s.number()?, s.number()?, s.number()?];
                for _ in 0..if parametric { dimension.clamp(0, 3) } else { 0 } {
                    s.number()?;
                }
                self.node(tag, x)?;
            }
        }
        s.binary = false;
        Ok(())
    }

    fn elements_22(&mut self, s: &mut Source<'_>, binary: bool) -> Result<(), GmshError> {
        let n = s.text_integer()?;
        let n = s.count(n)?;
        if !binary {
            for _ in 0..n {
                let (number, kind) = (s.text_integer()? as u64, s.text_integer()?);
                let tags = s.text_integer()?;
                let tags = (0..s.count(tags)?).map(|_| s.text_integer()).collect::<Result<Vec<_>, _>>()?;
                let nodes = (0..node_count(number, kind)?).map(|_| Ok(s.text_integer()? as u64));
                let nodes = nodes.collect::<Result<Vec<u64>, GmshError>>()?;
                self.check_nodes(s, number, &nodes)?;
                self.element(number, kind, &tags, nodes);
            }
            return Ok(());
        }
        s.end_line();
        s.binary = true;
        let mut read = 0;
        while read < n {
            let kind = s.integer()?;
            let (block, tags) = (s.integer()?, s.integer()?);
            let (block, tags) = (s.count(block)?, s.count(tags)?);
            if block == 0 {
                return Err(GmshError::Count { section: s.section, count: 0 });
            }
            for _ in 0..block {
                let number = s.integer()? as u64;
                let tags = (0..tags).map(|_| s.integer()).collect::<Result<Vec<_>, _>>()?;
                let nodes = (0..node_count(number, kind)?).map(|_| Ok(s.integer()? as u64));
                let nodes = nodes.collect::<Result<Vec<u64>, GmshError>>()?;
                self.check_nodes(s, number, &nodes)?;
                self.element(number, kind, &tags, nodes);
            }
            read += block;
        }
        s.binary = false;
        Ok(())
    }

    /// Whether the nodes of an element that was just read are there, of cells and of parts of their boundary alike.
    fn check_nodes(&self, s: &Source<'_>, element: u64, nodes: &[u64]) -> Result<(), GmshError> {
        let Some(&node) = nodes.iter().find(|n| !self.nodes.contains_key(n)) else { return Ok(()) };
        let place = if s.binary { String::new() } else { format!("line {}: ", s.line_number()) };
        Err(GmshError::NoNode { place, element, node })
    }

    /// In version 2 the first tag is the physical group, where zero is none, and the second the entity.
    fn element(&mut self, number: u64, kind: i64, tags: &[i64], nodes: Vec<u64>) {
        let groups = tags.first().filter(|g| **g != 0).map(|g| g.abs()).into_iter().collect();
        let entity = tags.get(1).copied().unwrap_or(0);
        self.elements.push(Element { number, kind, entity, groups, nodes });
    }

    fn elements_41(
        &mut self,
        s: &mut Source<'_>,
        binary: bool,
        entities: &HashMap<(i64, i64), Vec<i64>>,
    ) -> Result<(), GmshError> {
        s.binary = binary;
        for _ in 0..s.blocks()? {
            let (dimension, entity, kind) = (s.integer()?, s.integer()?, s.integer()?);
            let n = s.size()?;
            let groups = entities.get(&(dimension, entity)).cloned().unwrap_or_default();
            for _ in 0..s.count(n)? {
                let number = s.size()? as u64;
                let nodes = (0..node_count(number, kind)?).map(|_| Ok(s.size()? as u64));
                let nodes = nodes.collect::<Result<Vec<u64>, GmshError>>()?;
                self.check_nodes(s, number, &nodes)?;
                self.elements.push(Element { number, kind, entity, groups: groups.clone(), nodes });
            }
        }
        s.binary = false;
        Ok(())
    }

    fn name(&self, dimension: usize, group: i64) -> String {
        self.names.get(&(dimension, group)).cloned().unwrap_or_else(|| group.to_string())
    }

    /// The elements of all cells of a dimension, or of those in a physical group.
    fn cells<'a>(&'a self, dimension: usize, group: Option<&'a str>) -> impl Iterator<Item = &'a Element> {
        self.elements.iter().filter(move |e| {
            let named = |name: &str| e.groups.iter().any(|g| self.name(dimension, *g) == name);
            e.dimension() == dimension && group.is_none_or(named)
        })
    }

    /// Where a cell of [`GmshFile::mesh`] comes from: the number of its element, and in words its surface or volume with
    /// the physical groups of it.
    pub fn origin<const D: usize>(&self, group: Option<&str>, cell: usize) -> Option<(u64, String)> {
        let element = self.cells(D, group).nth(cell)?;
        let what = if D == 2 { "surface" } else { "volume" };
        let names: Vec<String> = element.groups.iter().map(|g| format!("`{}`", self.name(D, *g))).collect();
        let names = if names.is_empty() { String::new() } else { format!(" ({})", names.join(", ")) };
        Some((element.number, format!("{what} {}{names}", element.entity)))
    }

    /// The mesh of all cells, or of those in a physical group, with the other groups that touch it.
    ///
    /// # Errors
    /// An unknown group, no cells, nodes that do not exist, or a plane mesh out of its plane.
    pub fn mesh<const D: usize>(&self, group: Option<&str>) -> Result<Mesh<D>, GmshError> {
        let mut known = BTreeSet::new();
        for e in &self.elements {
            for g in &e.groups {
                known.insert((e.dimension(), self.name(e.dimension(), *g)));
            }
        }
        if let Some(group) = group
            && !known.contains(&(D, group.to_string()))
        {
            let list: Vec<String> = known.iter().map(|(d, n)| format!("`{n}` ({d})")).collect();
            let known = if list.is_empty() { "none".into() } else { list.join(", ") };
            return Err(GmshError::NoGroup { group: group.to_string(), dimension: D, known });
        }
        let cells: Vec<&Element> = self.cells(D, group).collect();
        if cells.is_empty() {
            let hint =
                "are the cells left out because no physical group holds them, or is the dimension of `space` another?";
            return Err(GmshError::NoCells { dimension: D, hint });
        }
        let mut numbers: HashMap<u64, u32> = HashMap::new();
        let mut positions: Vec<Point<D>> = Vec::new();
        let mut magnitude = 0.0f64;
        for e in &cells {
            for tag in &e.nodes {
                let Some(x) = self.nodes.get(tag) else {
                    return Err(GmshError::NoNode { place: String::new(), element: e.number, node: *tag });
                };
                magnitude = x.iter().fold(magnitude, |m, v| m.max(v.abs()));
                numbers.entry(*tag).or_insert_with(|| {
                    positions.push(Point::<D>::from_fn(|k, _| x[k]));
                    positions.len() as u32 - 1
                });
            }
        }
        if D == 2 {
            for tag in numbers.keys() {
                let z = self.nodes[tag][2];
                if z.abs() > 1e-9 * magnitude {
                    return Err(GmshError::NotPlane { node: *tag, z });
                }
            }
        }
        let mut lists = Vec::new();
        let mut added: HashMap<Vec<u32>, u32> = HashMap::new();
        for e in &cells {
            let Some(kind) = kind(e.kind) else { continue };
            let Some(shape) = kind.shape else { continue };
            let given: Vec<u32> = e.nodes.iter().map(|n| numbers[n]).collect();
            lists.push((shape, kind.order, kind.arrange(shape, &given, &mut positions, &mut added)));
        }
        // A plane mesh that faces the other way is turned over.
        if D == 2 && lists.iter().all(|(shape, order, nodes)| signed_area(*shape, *order, nodes, &positions) < 0.0) {
            for (shape, order, nodes) in &mut lists {
                *nodes = turned_over(*shape, *order, nodes);
            }
        }
        let mut mesh = Mesh::<D>::new(positions);
        for (shape, order, nodes) in &lists {
            mesh.add_cell(*shape, *order, nodes);
        }
        self.groups(&mut mesh, &cells, &numbers);
        Ok(mesh)
    }

    fn groups<const D: usize>(&self, mesh: &mut Mesh<D>, cells: &[&Element], numbers: &HashMap<u64, u32>) {
        for (k, e) in cells.iter().enumerate() {
            for g in &e.groups {
                mesh.group_mut(&self.name(D, *g)).cells.push(k as u32);
            }
        }
        let mut sides: HashMap<Vec<u32>, Vec<Side>> = HashMap::new();
        for side in mesh.all_sides() {
            let mut key = mesh.side_vertices(side);
            key.sort_unstable();
            sides.entry(key).or_default().push(side);
        }
        for e in &self.elements {
            let Some(kind) = kind(e.kind) else { continue };
            let dimension = kind.shape.map_or(0, CellShape::dimension);
            if e.groups.is_empty() || dimension >= D {
                continue;
            }
            let vertices: Option<Vec<u32>> =
                (e.nodes.iter().take(kind.vertices()).map(|n| numbers.get(n).copied())).collect();
            let Some(mut vertices) = vertices else { continue };
            for g in &e.groups {
                let name = self.name(dimension, *g);
                if dimension + 1 == D {
                    vertices.sort_unstable();
                    // Sides between two cells belong to both.
                    if let Some(found) = sides.get(&vertices) {
                        mesh.group_mut(&name).sides.extend(found);
                    }
                } else {
                    mesh.group_mut(&name).vertices.extend(&vertices);
                }
            }
        }
        let boundary = mesh.boundary();
        if !mesh.groups().contains_key("boundary") {
            mesh.group_mut("boundary").sides = boundary;
        }
    }
}

/// The cells of a shape by its name and number of nodes, in the order of a Gmsh file.
pub struct ListedCells<'a> {
    pub shape: &'a str,
    pub nodes: &'a [Vec<u32>],
}

impl GmshFile {
    /// The file that would hold some points and cells, with neither groups nor sides.
    ///
    /// # Errors
    /// In words: an unknown shape or number of nodes, of which cell; a node that is no point.
    pub fn from_arrays(points: Vec<[f64; 3]>, cells: &[ListedCells]) -> Result<Self, String> {
        let count = points.len();
        let nodes = points.into_iter().enumerate().map(|(k, x)| (k as u64, x)).collect();
        let mut elements = Vec::new();
        for block in cells {
            for (cell, list) in block.nodes.iter().enumerate() {
                let what = || format!("cell {cell} of the {}s", block.shape);
                let kind = match (block.shape, list.len()) {
                    ("triangle", 3) => 2,
                    ("quadrilateral", 4) => 3,
                    ("tetrahedron", 4) => 4,
                    ("hexahedron", 8) => 5,
                    ("wedge", 6) => 6,
                    ("triangle", 6) => 9,
                    ("quadrilateral", 9) => 10,
                    ("tetrahedron", 10) => 11,
                    ("hexahedron", 27) => 12,
                    ("wedge", 18) => 13,
                    ("quadrilateral", 8) => 16,
                    ("hexahedron", 20) => 17,
                    ("wedge", 15) => 18,
                    (_, found) => return Err(format!("{}: no such cell has {found} nodes", what())),
                };
                if let Some(beyond) = list.iter().find(|n| **n as usize >= count) {
                    return Err(format!("{}: there is no point {beyond}, the last is {}", what(), count.max(1) - 1));
                }
                let number = elements.len() as u64;
                let nodes = list.iter().map(|n| u64::from(*n)).collect();
                elements.push(Element { number, kind, entity: 0, groups: Vec::new(), nodes });
            }
        }
        Ok(Self { nodes, elements, names: BTreeMap::new() })
    }
}

fn signed_area<const D: usize>(shape: CellShape, order: usize, nodes: &[u32], x: &[Point<D>]) -> f64 {
    let corners: Vec<Point<D>> =
        CellMap::new(shape, order).vertex_nodes().iter().map(|&k| x[nodes[k] as usize]).collect();
    let n = corners.len();
    (0..n).map(|k| corners[k][0] * corners[(k + 1) % n][1] - corners[k][1] * corners[(k + 1) % n][0]).sum()
}

/// The nodes with the two directions of the reference cell exchanged.
fn turned_over(shape: CellShape, order: usize, nodes: &[u32]) -> Vec<u32> {
    let places = CellMap::new(shape, order).nodes();
    places
        .iter()
        .map(|p| {
            let at = places.iter().position(|q| close(q, &[p[1], p[0], 0.0])).unwrap_or(0);
            nodes[at]
        })
        .collect()
}

fn close(p: &Local, q: &Local) -> bool {
    (0..3).all(|k| (p[k] - q[k]).abs() < 1e-9)
}

/// A type of element.
struct Kind {
    /// `None` for a point.
    shape: Option<CellShape>,
    order: usize,
    /// Vertices between which the nodes after the vertices lie, in the order of Gmsh.
    between: &'static [&'static [usize]],
}

const HEX_EDGES: [&[usize]; 12] =
    [&[0, 1], &[0, 3], &[0, 4], &[1, 2], &[1, 5], &[2, 3], &[2, 6], &[3, 7], &[4, 5], &[4, 7], &[5, 6], &[6, 7]];
const HEX_27: [&[usize]; 19] = [
    HEX_EDGES[0],
    HEX_EDGES[1],
    HEX_EDGES[2],
    HEX_EDGES[3],
    HEX_EDGES[4],
    HEX_EDGES[5],
    HEX_EDGES[6],
    HEX_EDGES[7],
    HEX_EDGES[8],
    HEX_EDGES[9],
    HEX_EDGES[10],
    HEX_EDGES[11],
    &[0, 3, 2, 1],
    &[0, 1, 5, 4],
    &[0, 4, 7, 3],
    &[1, 2, 6, 5],
    &[2, 3, 7, 6],
    &[4, 5, 6, 7],
    &[0, 1, 2, 3, 4, 5, 6, 7],
];
const WEDGE_18: [&[usize]; 12] = [
    &[0, 1],
    &[0, 2],
    &[0, 3],
    &[1, 2],
    &[1, 4],
    &[2, 5],
    &[3, 4],
    &[3, 5],
    &[4, 5],
    &[0, 1, 4, 3],
    &[0, 2, 5, 3],
    &[1, 2, 5, 4],
];
const QUAD_9: [&[usize]; 5] = [&[0, 1], &[1, 2], &[2, 3], &[3, 0], &[0, 1, 2, 3]];
const TETRAHEDRON_10: [&[usize]; 6] = [&[0, 1], &[1, 2], &[2, 0], &[3, 0], &[2, 3], &[1, 3]];

fn kind(number: i64) -> Option<Kind> {
    use CellShape::*;
    let make = |shape, order, between| Some(Kind { shape: Some(shape), order, between });
    match number {
        1 => make(Line, 1, &[]),
        2 => make(Triangle, 1, &[]),
        3 => make(Quadrilateral, 1, &[]),
        4 => make(Tetrahedron, 1, &[]),
        5 => make(Hexahedron, 1, &[]),
        6 => make(Wedge, 1, &[]),
        8 => make(Line, 2, &QUAD_9[..1]),
        9 => make(Triangle, 2, &[&[0, 1], &[1, 2], &[2, 0]]),
        10 => make(Quadrilateral, 2, &QUAD_9),
        11 => make(Tetrahedron, 2, &TETRAHEDRON_10),
        12 => make(Hexahedron, 2, &HEX_27),
        13 => make(Wedge, 2, &WEDGE_18),
        15 => Some(Kind { shape: None, order: 1, between: &[] }),
        16 => make(Quadrilateral, 2, &QUAD_9[..4]),
        17 => make(Hexahedron, 2, &HEX_27[..12]),
        18 => make(Wedge, 2, &WEDGE_18[..9]),
        _ => None,
    }
}

fn node_count(element: u64, number: i64) -> Result<usize, GmshError> {
    match kind(number) {
        Some(kind) => Ok(kind.vertices() + kind.between.len()),
        None => {
            let what = match number {
                7 | 14 | 19 => "pyramid".to_string(),
                other => format!("cell of type {other}"),
            };
            Err(GmshError::Element { element, what })
        }
    }
}

impl Kind {
    fn vertices(&self) -> usize {
        self.shape.map_or(1, |s| s.vertices().len())
    }

    /// The nodes in the order of [`CellMap`]; those that serendipity cells lack are made.
    fn arrange<const D: usize>(
        &self,
        shape: CellShape,
        given: &[u32],
        positions: &mut Vec<Point<D>>,
        added: &mut HashMap<Vec<u32>, u32>,
    ) -> Vec<u32> {
        let corners = shape.vertices();
        let middle = |between: &[usize]| -> Local {
            std::array::from_fn(|k| between.iter().map(|&v| corners[v][k]).sum::<f64>() / between.len() as f64)
        };
        let places: Vec<Local> = corners.iter().copied().chain(self.between.iter().map(|b| middle(b))).collect();
        CellMap::new(shape, self.order)
            .nodes()
            .iter()
            .map(|x| {
                if let Some(k) = places.iter().position(|p| close(p, x)) {
                    return given[k];
                }
                // The corners of the side or cell in whose middle the node lies.
                let around: Vec<usize> = (0..corners.len())
                    .filter(|&v| shape == CellShape::Hexahedron && close(x, &[0.0; 3]) || on_common_side(shape, v, x))
                    .collect();
                let mut key: Vec<u32> = around.iter().map(|&v| given[v]).collect();
                key.sort_unstable();
                if let Some(&node) = added.get(&key) {
                    return node;
                }
                let of_edges = if around.len() == 8 { 0.25 } else { 0.5 };
                let mut position = Point::<D>::zeros();
                for &v in &around {
                    position -= positions[given[v] as usize] * 0.25;
                }
                for (k, between) in self.between.iter().enumerate() {
                    if between.iter().all(|v| around.contains(v)) {
                        position += positions[given[corners.len() + k] as usize] * of_edges;
                    }
                }
                positions.push(position);
                let node = positions.len() as u32 - 1;
                added.insert(key, node);
                node
            })
            .collect()
    }
}

/// Whether a vertex belongs to the quadrilateral (a side, or the cell itself) whose middle is `x`.
fn on_common_side(shape: CellShape, vertex: usize, x: &Local) -> bool {
    if shape == CellShape::Quadrilateral {
        return true;
    }
    shape.sides().iter().any(|corners| {
        let centre: Local = std::array::from_fn(|k| {
            corners.iter().map(|&v| shape.vertices()[v][k]).sum::<f64>() / corners.len() as f64
        });
        corners.len() == 4 && close(&centre, x) && corners.contains(&vertex)
    })
}
