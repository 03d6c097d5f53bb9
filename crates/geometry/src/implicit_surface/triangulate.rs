//! The boundary of a body as triangles, from which Newton starts.

use crate::implicit::ImplicitBody;
use crate::mesh::TriangleMesh;
use crate::shape::error::ShapeError;
use crate::{Aabb, Point, Vector};

/// Marching tetrahedra: six to a cell, around its diagonal.
pub fn triangulate(body: &ImplicitBody<3>, bounds: &Aabb<3>, cell: f64) -> Result<TriangleMesh, ShapeError> {
    let n: [usize; 3] = std::array::from_fn(|k| ((bounds.size()[k] / cell - 1e-9).ceil() as usize).max(1));
    let at = |i: usize, j: usize, k: usize| {
        bounds.at(&Point::<3>::new(i as f64 / n[0] as f64, j as f64 / n[1] as f64, k as f64 / n[2] as f64))
    };
    let number = |i: usize, j: usize, k: usize| (i * (n[1] + 1) + j) * (n[2] + 1) + k;
    let mut values = Vec::with_capacity((n[0] + 1) * (n[1] + 1) * (n[2] + 1));
    let mut positions = Vec::with_capacity(values.capacity());
    for i in 0..=n[0] {
        for j in 0..=n[1] {
            for k in 0..=n[2] {
                let x = at(i, j, k);
                let value = body.value(&x);
                if !value.is_finite() {
                    let message = format!("it is {value} at ({}, {}, {}): it must be finite in the box", x.x, x.y, x.z);
                    return Err(ShapeError::new("value", message));
                }
                values.push(value);
                positions.push(x);
            }
        }
    }
    let corner = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]];
    // Paths from corner 0 to corner 7 along the axes.
    let tetrahedra = [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];
    let mut vertices: Vec<Point<3>> = Vec::new();
    let mut on_edge: std::collections::HashMap<(usize, usize), u32> = std::collections::HashMap::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for i in 0..n[0] {
        for j in 0..n[1] {
            for k in 0..n[2] {
                for t in tetrahedra {
                    let v = t.map(|c: usize| number(i + corner[c][0], j + corner[c][1], k + corner[c][2]));
                    let inside: Vec<usize> = v.iter().copied().filter(|&a| values[a] < 0.0).collect();
                    let outside: Vec<usize> = v.iter().copied().filter(|&a| values[a] >= 0.0).collect();
                    let mut cross = |a: usize, b: usize| {
                        *on_edge.entry((a.min(b), a.max(b))).or_insert_with(|| {
                            let share = values[a] / (values[a] - values[b]);
                            vertices.push(positions[a] + (positions[b] - positions[a]) * share);
                            vertices.len() as u32 - 1
                        })
                    };
                    let mut faces: Vec<[u32; 3]> = Vec::with_capacity(2);
                    match (inside.as_slice(), outside.as_slice()) {
                        ([a], [p, q, r]) | ([p, q, r], [a]) => {
                            faces.push([cross(*a, *p), cross(*a, *q), cross(*a, *r)])
                        }
                        ([a, b], [p, q]) => {
                            let quad = [cross(*a, *p), cross(*a, *q), cross(*b, *q), cross(*b, *p)];
                            faces.push([quad[0], quad[1], quad[2]]);
                            faces.push([quad[0], quad[2], quad[3]]);
                        }
                        _ => {}
                    }
                    // Outward: from the inside corners to the outside ones.
                    let mean =
                        |set: &[usize]| set.iter().map(|&a| positions[a]).sum::<Vector<3>>() / set.len().max(1) as f64;
                    let outward = mean(&outside) - mean(&inside);
                    for mut face in faces {
                        let x = face.map(|f| vertices[f as usize]);
                        if (x[1] - x[0]).cross(&(x[2] - x[0])).dot(&outward) < 0.0 {
                            face.swap(1, 2);
                        }
                        triangles.push(face);
                    }
                }
            }
        }
    }
    if triangles.is_empty() {
        return Err(ShapeError::new("box", "the boundary of the body does not enter it, or is finer than a cell"));
    }
    TriangleMesh::new(vertices, &triangles)
}
