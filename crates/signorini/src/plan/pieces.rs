//! Bodies whose mesh falls into pieces that share no node.

use signorini_fem::mesh::position;
use signorini_fem::{Group, Mesh};
use signorini_geometry::Point;
use std::collections::{BTreeMap, BTreeSet};

/// More pieces than this are counted, not listed.
const LISTED: usize = 4;

/// What helps against pieces that should be one.
pub(crate) const UNITE: &str = "touching pieces form one body only if they share nodes: in Gmsh use `Coherence;` or \
                                BooleanFragments before meshing, or `Coherence Mesh;` after it; for pieces that move \
                                independently, make each one a body with `group`, supports and contacts";

/// The pieces of a mesh, at least two.
pub(crate) struct Apart<const D: usize> {
    /// The piece of each cell.
    pub of_cell: Vec<u32>,
    /// Number of cells and mean of their vertices, by piece.
    pieces: Vec<(usize, Point<D>)>,
    /// A place where two of them lie on each other.
    pub touching: Option<Point<D>>,
}

impl<const D: usize> Apart<D> {
    /// None of a mesh that hangs together.
    pub fn new(mesh: &Mesh<D>) -> Option<Self> {
        let of_cell = mesh.pieces();
        let count = of_cell.iter().max().map_or(0, |last| *last as usize + 1);
        if count < 2 {
            return None;
        }
        let mut pieces = vec![(0, Point::<D>::zeros()); count];
        for (cell, &piece) in of_cell.iter().enumerate() {
            let vertices: Vec<Point<D>> = mesh.vertices(cell).map(|n| mesh.nodes()[n as usize]).collect();
            let (cells, sum) = &mut pieces[piece as usize];
            *cells += 1;
            *sum += vertices.iter().sum::<Point<D>>() / vertices.len() as f64;
        }
        pieces.iter_mut().for_each(|(cells, sum)| *sum /= *cells as f64);
        let touching = mesh.touching(&of_cell).map(|place| place.at);
        Some(Self { of_cell, pieces, touching })
    }

    /// Number of pieces.
    pub fn count(&self) -> usize {
        self.pieces.len()
    }

    /// A piece in words, by its middle.
    pub fn describe(&self, piece: u32) -> String {
        let (cells, middle) = &self.pieces[piece as usize];
        format!("{cells} cell{} about {}", if *cells == 1 { "" } else { "s" }, position(middle))
    }

    /// What is to say of the mesh of a body.
    pub fn text(&self, body: &str) -> String {
        let count = self.count();
        let mut list: Vec<String> = (0..count.min(LISTED) as u32).map(|piece| self.describe(piece)).collect();
        if count > LISTED {
            list.push(format!("{} more", count - LISTED));
        }
        let touching = self.touching.map_or(String::new(), |x| format!(", two of which touch at {}", position(&x)));
        format!("the mesh of `{body}` consists of {count} pieces that share no node: {}{touching}", list.join(", "))
    }

    /// ... where nothing holds one of the pieces.
    pub fn held_by_nothing(&self, body: &str, piece: u32) -> String {
        format!("{}; no support restrains the {}", self.text(body), self.describe(piece))
    }

    /// The warning about pieces that lie on each other.
    pub fn warning(&self, body: &str) -> Option<String> {
        self.touching.map(|_| format!("{}; {UNITE}", self.text(body)))
    }
}

/// The pieces of the mesh of a body, and which of them its groups reach.
pub(crate) struct Pieces {
    pub body: String,
    /// Whether two of them lie on each other.
    pub touch: bool,
    /// What is told of each where nothing holds it.
    told: Vec<String>,
    of_group: BTreeMap<String, BTreeSet<u32>>,
}

impl Pieces {
    /// None of a mesh that hangs together.
    pub fn new<const D: usize>(body: &str, mesh: &Mesh<D>) -> Option<Self> {
        let apart = Apart::new(mesh)?;
        let mut of_vertex: BTreeMap<u32, u32> = BTreeMap::new();
        for (cell, piece) in apart.of_cell.iter().enumerate() {
            of_vertex.extend(mesh.vertices(cell).map(|v| (v, *piece)));
        }
        let reached = |group: &Group| {
            let cells = group.cells.iter().copied().chain(group.sides.iter().map(|side| side.cell));
            let vertices = group.vertices.iter().filter_map(|v| of_vertex.get(v).copied());
            cells.map(|cell| apart.of_cell[cell as usize]).chain(vertices).collect()
        };
        let of_group = mesh.groups().iter().map(|(name, group)| (name.clone(), reached(group))).collect();
        let told = (0..apart.count() as u32).map(|piece| apart.held_by_nothing(body, piece)).collect();
        Some(Pieces { body: body.into(), touch: apart.touching.is_some(), told, of_group })
    }

    /// What is told of the first piece that none of these groups reaches; the whole body where there is no group.
    pub fn loose<'a>(&self, groups: impl Iterator<Item = Option<&'a str>>) -> Option<&str> {
        let mut reached = vec![false; self.told.len()];
        for group in groups {
            match group.map(|name| self.of_group.get(name)) {
                Some(Some(pieces)) => pieces.iter().for_each(|piece| reached[*piece as usize] = true),
                _ => reached.fill(true),
            }
        }
        reached.iter().position(|reached| !reached).map(|piece| self.told[piece].as_str())
    }
}
