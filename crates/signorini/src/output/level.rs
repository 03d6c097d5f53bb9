//! Level sets in space as triangles, by marching tetrahedra.

use rayon::prelude::*;
use signorini_contact::GapJet;
use signorini_geometry::Vector;
use std::collections::{BTreeSet, HashMap};

/// A point on the edge between two corners, at a share of the way from the first.
pub type OnEdge = (u32, u32, f64);

/// The six tetrahedra of a hexahedron around the diagonal from corner 0 to corner 6, corners as in VTK.
pub const OF_HEXAHEDRON: [[usize; 4]; 6] =
    [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]];

/// Cubes along the longest side of the box in which a rigid body is drawn: each a few pixels wide.
pub const CUBES: usize = 48;
/// Those in the files of free bodies, which are written in each increment.
pub const CUBES_IN_FILES: usize = 24;
/// Cubes along the sides of the blocks with which the search for a surface begins, a power of two.
const BLOCK: usize = 8;

/// Where values at the corners of tetrahedra change sign: points on edges, and triangles between them.
pub fn level(tetrahedra: impl Iterator<Item = [u32; 4]>, value: impl Fn(u32) -> f64) -> (Vec<OnEdge>, Vec<[u32; 3]>) {
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    let mut numbers: HashMap<(u32, u32), u32> = HashMap::new();
    for corners in tetrahedra {
        let (below, above): (Vec<u32>, Vec<u32>) = corners.iter().partition(|&&k| value(k) < 0.0);
        let mut on = |a: u32, b: u32| {
            let (a, b) = (a.min(b), a.max(b));
            *numbers.entry((a, b)).or_insert_with(|| {
                points.push((a, b, value(a) / (value(a) - value(b))));
                points.len() as u32 - 1
            })
        };
        match (&below[..], &above[..]) {
            ([a], [b, c, d]) | ([b, c, d], [a]) => triangles.push([on(*a, *b), on(*a, *c), on(*a, *d)]),
            ([a, b], [c, d]) => {
                let [p, q, r, s] = [on(*a, *c), on(*a, *d), on(*b, *d), on(*b, *c)];
                triangles.extend([[p, q, r], [p, r, s]]);
            }
            _ => {}
        }
    }
    (points, triangles)
}

/// The surface of a rigid body within a box: points, their outward normals, and triangles.
///
/// `gap` is the distance to the surface, negative inside; the longest side has `cubes` cubes. Blocks of cubes that are farther from it than their corners
/// reach are left out.
pub fn surface(
    gap: &(dyn Fn(&Vector<3>) -> GapJet<3> + Sync),
    [low, high]: [Vector<3>; 2],
    cubes: usize,
) -> (Vec<Vector<3>>, Vec<Vector<3>>, Vec<[u32; 3]>) {
    let size = high - low;
    let cube = size.max() / cubes as f64;
    let count: [usize; 3] = std::array::from_fn(|k| ((size[k] / cube).ceil() as usize).max(1));
    let side: Vector<3> = Vector::<3>::from_fn(|k, _| size[k] / count[k] as f64);
    let at = |i: [f64; 3]| Vector::<3>::from_fn(|k, _| low[k] + side[k] * i[k]);
    let blocks = |k: usize| (0..count[k]).step_by(BLOCK);
    let mut cubes: Vec<[usize; 3]> =
        blocks(0).flat_map(|i| blocks(1).flat_map(move |j| blocks(2).map(move |k| [i, j, k]))).collect();
    let mut wide = BLOCK;
    loop {
        let reach = 0.5 * wide as f64 * side.norm();
        cubes = (cubes.into_par_iter())
            .filter(|c| gap(&at(c.map(|i| i as f64 + 0.5 * wide as f64))).gap.abs() <= reach * (1.0 + 1e-9))
            .collect();
        if wide == 1 {
            break;
        }
        wide /= 2;
        cubes = (cubes.into_iter())
            .flat_map(|c| (0..8).map(move |o| [0, 1, 2].map(|k| c[k] + wide * (o >> k & 1))))
            .filter(|c| (0..3).all(|k| c[k] < count[k]))
            .collect();
    }
    let number = |i: [usize; 3]| ((i[2] * (count[1] + 1) + i[1]) * (count[0] + 1) + i[0]) as u32;
    let place = |n: u32| {
        let (n, x, y) = (n as usize, count[0] + 1, count[1] + 1);
        at([n % x, n / x % y, n / (x * y)].map(|i| i as f64))
    };
    const CORNERS: [[usize; 3]; 8] =
        [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    let corners: Vec<[u32; 8]> =
        cubes.iter().map(|c| CORNERS.map(|o| number([c[0] + o[0], c[1] + o[1], c[2] + o[2]]))).collect();
    let nodes: Vec<u32> = corners.iter().flatten().copied().collect::<BTreeSet<u32>>().into_iter().collect();
    let gaps: HashMap<u32, f64> =
        nodes.par_iter().map(|&n| (n, gap(&place(n)).gap)).collect::<Vec<_>>().into_iter().collect();
    let tetrahedra = corners.iter().flat_map(|c| OF_HEXAHEDRON.map(|t| t.map(|k| c[k])));
    let (edges, mut triangles) = level(tetrahedra, |n| gaps[&n]);
    let found: Vec<(Vector<3>, Vector<3>, bool)> = (edges.par_iter())
        .map(|&(a, b, t)| {
            let x = place(a) * (1.0 - t) + place(b) * t;
            let jet = gap(&x);
            // Where the sign changes far from the surface, as beyond the rim of an open one, there is no surface.
            (x - jet.normal * jet.gap, jet.normal, jet.gap.abs() < 0.25 * cube)
        })
        .collect();
    triangles.retain(|t| t.iter().all(|&k| found[k as usize].2));
    (found.iter().map(|f| f.0).collect(), found.iter().map(|f| f.1).collect(), triangles)
}

/// Squares along the longest side of a box in the plane with which the search for a body begins, and how often they are
/// halved at its edge: the smallest are a pixel wide.
const SQUARES: f64 = 8.0;
const HALVINGS: usize = 7;

/// A rigid body in the plane, within a box: triangles, three points each, and the pieces of its edge.
///
/// `gap` is the distance to the edge, negative inside: squares that are farther from it than their corners reach are not
/// divided.
pub fn region(
    gap: &(dyn Fn(&Vector<3>) -> GapJet<3> + Sync),
    [low, high]: [Vector<3>; 2],
) -> (Vec<[Vector<3>; 3]>, Vec<[Vector<3>; 2]>) {
    let size = high - low;
    let mut side = size.x.max(size.y) / SQUARES;
    let count = [0, 1].map(|k| (size[k] / side).ceil().max(1.0) as usize);
    let corners = |x: &Vector<3>, side: f64| {
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[i, j]| x + Vector::<3>::new(i, j, 0.0) * side)
    };
    let mut squares: Vec<Vector<3>> = (0..count[0] * count[1])
        .map(|k| low + Vector::<3>::new((k % count[0]) as f64, (k / count[0]) as f64, 0.0) * side)
        .collect();
    let (mut triangles, mut edge) = (Vec::new(), Vec::new());
    for halving in 0..=HALVINGS {
        let reach = side * std::f64::consts::FRAC_1_SQRT_2 * (1.0 + 1e-9);
        let middle = Vector::<3>::new(0.5 * side, 0.5 * side, 0.0);
        let found: Vec<f64> = squares.par_iter().map(|x| gap(&(x + middle)).gap).collect();
        let inside = squares.iter().zip(&found).filter(|(_, g)| **g < -reach);
        triangles.extend(inside.flat_map(|(x, _)| {
            let [a, b, c, d] = corners(x, side);
            [[a, b, c], [a, c, d]]
        }));
        squares = squares.iter().zip(&found).filter(|(_, g)| g.abs() <= reach).map(|(x, _)| *x).collect();
        if halving < HALVINGS {
            side *= 0.5;
            squares = squares.iter().flat_map(|x| corners(x, side)).collect();
        }
    }
    let cut: Vec<_> = squares.par_iter().map(|x| cut_square(gap, corners(x, side), side)).collect();
    for (inside, pieces) in cut {
        triangles.extend(inside);
        edge.extend(pieces);
    }
    (triangles, edge)
}

/// What of a square is inside a body, and the pieces of the body's edge in it.
fn cut_square(
    gap: &(dyn Fn(&Vector<3>) -> GapJet<3> + Sync),
    corners: [Vector<3>; 4],
    side: f64,
) -> (Vec<[Vector<3>; 3]>, Vec<[Vector<3>; 2]>) {
    let values = corners.map(|x| gap(&x).gap);
    let (mut triangles, mut edge) = (Vec::new(), Vec::new());
    for t in [[0, 1, 2], [0, 2, 3]] {
        let (mut kept, mut crossed) = (Vec::new(), Vec::new());
        for k in 0..3 {
            let (a, b) = (t[k], t[(k + 1) % 3]);
            if values[a] < 0.0 {
                kept.push(corners[a]);
            }
            if (values[a] < 0.0) != (values[b] < 0.0) {
                let x = corners[a] + (corners[b] - corners[a]) * (values[a] / (values[a] - values[b]));
                let jet = gap(&x);
                // Where the sign changes far from the edge, as beyond the end of an open one, there is no edge.
                let near = jet.gap.abs() < 0.25 * side;
                let foot = if near { x - jet.normal * jet.gap } else { x };
                kept.push(foot);
                crossed.push((foot, near));
            }
        }
        triangles.extend((2..kept.len()).map(|k| [kept[0], kept[k - 1], kept[k]]));
        if let [(a, true), (b, true)] = crossed[..] {
            edge.push([a, b]);
        }
    }
    (triangles, edge)
}
