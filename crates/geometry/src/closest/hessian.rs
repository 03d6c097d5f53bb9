//! The second derivatives of the distance of a point to a shape.

use super::result::ClosestPair;
use crate::feature::{Entity, FeatureKind};
use crate::measures::{Measures, PartnerJet, Variation};
use crate::patch::Border;
use crate::shape::{CurveJet, Shape};
use crate::{Matrix, Vector};

/// The Hessian of the distance of a point `a` to the shape `b` in the position of the point, with the sign of the unit
/// vector `normal` along which it counts.
///
/// Inside a face it is that of the curved surface; at an edge or corner that of the distance to a curve or a point. Zero
/// where the shape has no such derivative: at poles and inner creases, and on edges themselves.
pub fn gap_hessian(pair: &ClosestPair, b: &Shape, normal: &Vector<3>) -> Matrix<3> {
    let point = &pair.a.point;
    let at = PartnerJet::Point(point);
    let foot = &pair.b;
    let along = |jet: CurveJet| of::<1>(Measures::new(at, PartnerJet::Curve(&jet), *normal));
    let corner = || of::<0>(Measures::new(at, PartnerJet::Point(&foot.point), *normal));
    let zero = Vector::<3>::zeros();
    let on_border = |border: Border| match border {
        Border::U0 | Border::U1 => Some([0.0, 1.0]),
        Border::V0 | Border::V1 => Some([1.0, 0.0]),
        Border::Diagonal => Some([1.0, -1.0]),
        Border::Start | Border::End => None,
    };
    let found = match (b, foot.feature.kind, foot.feature.entity) {
        (Shape::Surface(s), FeatureKind::Interior, Entity::Whole) => {
            let &[u, v] = foot.parameters() else { return Matrix::<3>::zeros() };
            of::<2>(Measures::new(at, PartnerJet::Surface(&s.jet(u, v)), *normal))
        }
        _ if pair.distance == 0.0 => None,
        (Shape::Surface(s), FeatureKind::Edge, Entity::Border(border)) => {
            let (&[u, v], Some([p, q])) = (foot.parameters(), on_border(border)) else {
                return Matrix::<3>::zeros();
            };
            let j = s.jet(u, v);
            along(CurveJet {
                x: j.x,
                d1: j.u * p + j.v * q,
                d2: j.uu * (p * p) + j.uv * (2.0 * p * q) + j.vv * (q * q),
                d3: zero,
            })
        }
        (Shape::Mesh(m), FeatureKind::Edge, Entity::Border(border)) => {
            let [a, b, c] = m.corners(foot.element);
            let d1 = match border {
                Border::U0 | Border::U1 => c - a,
                Border::V0 | Border::V1 => b - a,
                _ => c - b,
            };
            along(CurveJet { x: foot.point, d1, d2: zero, d3: zero })
        }
        (Shape::Surface(_) | Shape::Mesh(_), FeatureKind::Vertex, _) | (Shape::Point(_), ..) => corner(),
        _ => None,
    };
    found.unwrap_or_else(Matrix::<3>::zeros)
}

/// The Hessian in the position of the first partner.
fn of<const N: usize>(measures: Option<Measures<N>>) -> Option<Matrix<3>> {
    let moves: [Variation<N>; 3] = std::array::from_fn(|i| {
        let mut d = Vector::<3>::zeros();
        d[i] = 1.0;
        Variation { d, d_a: [Vector::<3>::zeros(); N], d_ab: [[Vector::<3>::zeros(); N]; N] }
    });
    Some(Matrix::<3>::from_row_slice(&measures?.gap_hessian(&moves)))
}
