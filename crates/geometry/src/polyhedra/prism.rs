//! Polygons in the plane, as prisms across it: their sides are facets, and a corner is an edge across the plane for what touches
//! it, and a point of the plane where it touches.

use super::{Corner, Facet, Features};
use crate::mass_properties::MassProperties;
use crate::mesh::TriangleMesh;
use crate::{Point, Vector};

/// Cosine of the angle between the normal of an upright facet and `z`: rounding.
const UPRIGHT: f64 = 1e-9;

impl Features {
    /// The features of a closed prism that stands upright on both sides of the plane `z = 0`: those of its section with the plane.
    /// None of a mesh that is not closed.
    pub fn of_prism(mesh: TriangleMesh) -> Option<Self> {
        let mut out = Self::new(mesh)?;
        let stands = |normal: &Vector<3>| normal[2].abs() <= UPRIGHT;
        let mut kept = Vec::new();
        let numbers: Vec<Option<usize>> = (out.facets.iter().enumerate())
            .map(|(k, facet)| {
                stands(&facet.normal).then(|| {
                    kept.push(k);
                    kept.len() - 1
                })
            })
            .collect();
        let in_plane = |facet: Facet| Facet { point: Point::<3>::new(facet.point[0], facet.point[1], 0.0), ..facet };
        out.facets = kept.iter().map(|k| in_plane(out.facets[*k])).collect();
        out.facet_of.iter_mut().for_each(|of| *of = of.and_then(|k| numbers[k]));
        let mut edges = Vec::new();
        let numbers: Vec<Option<usize>> = (out.edges.iter())
            .map(|edge| {
                let [Some(a), Some(b)] = edge.facets.map(|f| numbers[f]) else { return None };
                let mut edge = *edge;
                edge.facets = [a, b];
                edges.push(edge);
                Some(edges.len() - 1)
            })
            .collect();
        out.edge_of.iter_mut().for_each(|of| *of = of.and_then(|k| numbers[k]));
        out.corner_of.iter_mut().for_each(|of| *of = None);
        out.corners = (edges.iter())
            .map(|edge| {
                let normal = edge.facets.map(|f| out.facets[f].normal).iter().sum::<Vector<3>>();
                Corner {
                    point: edge.ends[0] - edge.along * (edge.ends[0][2] / edge.along[2]),
                    along: edge.inwards.to_vec(),
                    facets: edge.facets.to_vec(),
                    hollow: if edge.is_convex { Vec::new() } else { edge.facets.to_vec() },
                    normal: normal.try_normalize(0.0).unwrap_or_default(),
                }
            })
            .collect();
        out.edges = edges;
        // Twice the area over the circumference, by those of the sides of the prism.
        let sides: f64 = (0..out.mesh.triangles().len())
            .filter(|k| out.facet_of[*k].is_some())
            .map(|k| {
                let [a, b, c] = out.mesh.corners(k);
                0.5 * (b - a).cross(&(c - a)).norm()
            })
            .sum();
        out.width = 2.0 * MassProperties::polyhedron(&out.mesh).volume / sides;
        let points: Vec<Point<3>> = out.corners.iter().map(|c| c.point).collect();
        let [low, high] = [Point::<3>::inf, Point::<3>::sup].map(|by| points.iter().fold(points[0], |m, x| by(&m, x)));
        (out.middle, out.radius) = ((low + high) * 0.5, 0.5 * (high - low).norm());
        out.is_flat = true;
        Some(out)
    }
}
