//! The edge or vertex of a reference face that a point lies on.

use signorini_fem::{CellShape, Local};

/// Where on a reference face a point is.
pub(super) enum Place {
    Interior,
    /// Between two vertices.
    Edge([usize; 2]),
    Vertex(usize),
}

impl Place {
    /// Within rounding of the reference coordinates.
    pub fn of(shape: CellShape, s: &Local) -> Self {
        let corners = shape.vertices();
        let part = |c: &Local| (0..3).map(|k| (c[k] - s[k]).powi(2)).sum::<f64>().sqrt();
        if let Some(v) = corners.iter().position(|c| part(c) < 1e-9) {
            return Place::Vertex(v);
        }
        for &[a, b] in shape.edges() {
            let along: f64 = (0..3).map(|k| (corners[b][k] - corners[a][k]).powi(2)).sum::<f64>().sqrt();
            if (part(&corners[a]) + part(&corners[b]) - along).abs() < 1e-9 {
                return Place::Edge([a, b]);
            }
        }
        Place::Interior
    }
}
