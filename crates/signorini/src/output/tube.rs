//! Tubes about curves.

use super::render::{Body, Paint};
use signorini_geometry::Vector;
use signorini_mechanics::pair::any_tangent;

/// Corners of the polygon that is drawn for a section.
const AROUND_SECTION: usize = 12;

/// A tube about lines between points, painted by what holds at the points.
pub fn tube(points: &[Vector<3>], cells: &[[u32; 2]], radius: f64, paint: Paint) -> Body {
    let n = points.len();
    let mut tangents = vec![Vector::<3>::zeros(); n];
    for [a, b] in cells {
        let d = points[*b as usize] - points[*a as usize];
        let d = d.try_normalize(0.0).unwrap_or_default();
        tangents[*a as usize] += d;
        tangents[*b as usize] += d;
    }
    let first = tangents.first().and_then(|t| t.try_normalize(0.0)).unwrap_or_else(Vector::<3>::x);
    let mut across = any_tangent(&first);
    let mut rings: Vec<Vec<Vector<3>>> = Vec::with_capacity(n);
    for tangent in &tangents {
        let t = tangent.try_normalize(0.0).unwrap_or_else(Vector::<3>::x);
        // Turned about the curve as little as can be.
        across = (across - t * t.dot(&across)).try_normalize(1e-9).unwrap_or_else(|| any_tangent(&t));
        let other = t.cross(&across);
        let ring = (0..AROUND_SECTION).map(|k| {
            let angle = std::f64::consts::TAU * k as f64 / AROUND_SECTION as f64;
            across * angle.cos() + other * angle.sin()
        });
        rings.push(ring.collect());
    }
    let mut body = Body::empty(paint.clone());
    let mut values = Vec::new();
    for [a, b] in cells {
        let first = body.points.len() as u32;
        for end in [*a as usize, *b as usize] {
            body.points.extend(rings[end].iter().map(|r| points[end] + r * radius));
            if let Paint::Field(colours) = &paint {
                values.extend(std::iter::repeat_n(colours[end], AROUND_SECTION));
            }
        }
        let m = AROUND_SECTION as u32;
        for k in 0..m {
            let next = (k + 1) % m;
            let (p, q) = (&rings[*a as usize], &rings[*b as usize]);
            body.triangles.push([first + k, first + next, first + m + next]);
            body.normals.push([p[k as usize], p[next as usize], q[next as usize]]);
            body.triangles.push([first + k, first + m + next, first + m + k]);
            body.normals.push([p[k as usize], q[next as usize], q[k as usize]]);
        }
    }
    if let Paint::Field(colours) = &mut body.paint {
        *colours = values;
    }
    body
}
