//! Nodes of a surface that are moved onto another surface before anything is computed (`ADJUST` of a contact pair).

use crate::deck::{Deck, Surface};
use signorini_geometry::Point;
use signorini_geometry::mesh::TriangleMesh;
use std::collections::{BTreeMap, BTreeSet};

/// Which nodes are moved onto which surface.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Adjustment {
    /// The surface whose nodes are moved.
    pub surface: String,
    /// The surface onto which they are moved, to their closest points.
    pub to: String,
    /// Only nodes at most this far away, on either side.
    pub within: Option<f64>,
    /// Only nodes of this set, wherever they are.
    pub nodes: Option<String>,
}

/// New positions of the nodes that move.
///
/// # Errors
/// In words: surfaces and sets that do not exist or have no faces.
pub fn moved(deck: &Deck, adjustment: &Adjustment) -> Result<BTreeMap<u64, [f64; 3]>, String> {
    let surface = |name: &str| {
        let (_, surface) = deck.surfaces.get(name).ok_or_else(|| format!("there is no surface `{name}`"))?;
        Ok::<&Surface, String>(surface)
    };
    let target = faces(deck, surface(&adjustment.to)?).map_err(|e| format!("`{}`: {e}", adjustment.to))?;
    let mut candidates = nodes(deck, surface(&adjustment.surface)?);
    if let Some(name) = &adjustment.nodes {
        let (_, set) = deck.node_sets.get(name).ok_or_else(|| format!("there is no set of nodes `{name}`"))?;
        let set: BTreeSet<u64> = set.iter().copied().collect();
        candidates.retain(|n| set.contains(n));
    }
    let mut out = BTreeMap::new();
    for node in candidates {
        let Some(x) = deck.nodes.get(&node).map(|x| Point::<3>::from(*x)) else { continue };
        let Some(foot) = target.closest(&x, 0.0).into_iter().next() else { continue };
        if adjustment.within.is_none_or(|within| foot.distance <= within) {
            out.insert(node, foot.point.into());
        }
    }
    Ok(out)
}

/// Faces as triangles; edges in the plane become strips of the width 2 across it.
fn faces(deck: &Deck, surface: &Surface) -> Result<TriangleMesh, String> {
    let (mut points, mut triangles): (Vec<Point<3>>, Vec<[u32; 3]>) = (Vec::new(), Vec::new());
    for face in &surface.faces {
        let list: Option<Vec<Point<3>>> =
            face.iter().map(|n| deck.nodes.get(n).map(|x| Point::<3>::from(*x))).collect();
        let Some(mut corners) = list else { continue };
        if let [a, b] = corners[..] {
            let across = Point::<3>::z();
            corners = vec![a - across, b - across, b + across, a + across];
        }
        let first = points.len() as u32;
        triangles.extend((2..corners.len() as u32).map(|k| [first, first + k - 1, first + k]));
        points.extend(corners);
    }
    if triangles.is_empty() {
        return Err("the surface has no faces".into());
    }
    TriangleMesh::new(points, &triangles).map_err(|e| e.to_string())
}

/// The nodes of a surface, also those in the middle of its edges.
fn nodes(deck: &Deck, surface: &Surface) -> BTreeSet<u64> {
    let mut out: BTreeSet<u64> = surface.nodes.iter().copied().chain(surface.faces.iter().flatten().copied()).collect();
    let edges: BTreeSet<[u64; 2]> = (surface.faces.iter())
        .flat_map(|face| (0..face.len()).map(|k| ordered([face[k], face[(k + 1) % face.len()]])))
        .collect();
    for element in &deck.elements {
        let vertices = element.kind.vertex_count();
        for (place, edge) in element.kind.edges().iter().enumerate() {
            if edges.contains(&ordered(edge.map(|v| element.nodes[v]))) {
                out.insert(element.nodes[vertices + place]);
            }
        }
    }
    out
}

fn ordered([a, b]: [u64; 2]) -> [u64; 2] {
    [a.min(b), a.max(b)]
}
