//! The edges of a solid.

use super::SolidBody;
use super::edge::{EDGES, EdgeCurve, EdgeError, EdgeOf, PlacedEdge};
use signorini_material::Space;
use signorini_mechanics::Site;
use std::collections::BTreeMap;

impl<const D: usize> SolidBody<D> {
    /// The solid with edges that may touch as curves, by name: each the chain of cell edges along which two groups of sides
    /// meet.
    ///
    /// # Errors
    /// Edges that are not there, that branch, turn or fall into pieces, and a body in the plane.
    #[inline(never)]
    pub fn with_edges(mut self, edges: &BTreeMap<String, EdgeOf>) -> Result<Self, EdgeError> {
        if self.space() != Space::Solid && !edges.is_empty() {
            return Err(EdgeError::Plane);
        }
        let mut first = 0;
        for (name, edge) in edges {
            if self.groups.contains_key(name) {
                return Err(EdgeError::Taken { edge: name.clone() });
            }
            if !(edge.radius >= 0.0 && edge.radius.is_finite()) {
                return Err(EdgeError::Radius { edge: name.clone(), radius: edge.radius });
            }
            let mut curve = EdgeCurve::new(&self, name, edge)?;
            curve.first = first;
            first += curve.elements.len() as u32;
            self.edges.insert(name.clone(), curve);
        }
        Ok(self)
    }

    /// The edge that a site is on, and the element of it.
    pub(super) fn edge_at(&self, site: &Site) -> Option<(&EdgeCurve, usize)> {
        let number = site.patch.checked_sub(EDGES)?;
        let edge = self.edges.values().find(|e| (e.first..e.first + e.elements.len() as u32).contains(&number))?;
        Some((edge, (number - edge.first) as usize))
    }

    /// An edge as a curve.
    pub(super) fn edge<'a>(&'a self, name: &str) -> Option<PlacedEdge<'a, D>> {
        self.edges.get(name).map(|edge| PlacedEdge { edge, faces: &self.faces })
    }
}
