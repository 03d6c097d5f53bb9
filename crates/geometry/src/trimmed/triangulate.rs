//! Triangles of the faces: of their parameters, Delaunay within the chords of the edges, and in space.

use super::face::Face;
use super::{FaceSurface, TrimmedSolid};
use crate::mesh::TriangleMesh;
use crate::shape::Curve;
use crate::{Point, Vector};
use spade::handles::{FixedFaceHandle, FixedVertexHandle, InnerTag};
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};
use std::collections::HashMap;
use std::f64::consts::PI;

type Delaunay = ConstrainedDelaunayTriangulation<Point2<f64>>;

/// Turns of edges and surfaces by less than this are one chord: of a circle it is a thousandth of the radius from the arc.
const TURN: f64 = PI / 36.0;
/// Parts into which a smooth part of a spline is divided, each way.
const PARTS: usize = 8;
/// Sizes of the domain within which parameters are on a side of it: files put edges that far off, and chords are longer by far.
const SNAP: f64 = 1e-6;
/// Sizes of the body within which corners are the same.
const SAME: f64 = 1e-10;

/// A chord of an edge in the scaled parameters of a face, in the direction of its loop.
pub(super) struct Chord {
    pub of: usize,
    pub t: [f64; 2],
    pub ends: [[f64; 2]; 2],
}

/// Corners in scaled parameters, with the position of those on edges, and triangles that run around to the left.
pub(super) struct Flat {
    pub corners: Vec<([f64; 2], Option<Point<3>>)>,
    pub triangles: Vec<[usize; 3]>,
    pub chords: Vec<Chord>,
}

/// Parameters that divide a curve into chords.
pub(super) fn divided(curve: &Curve) -> Vec<f64> {
    let mut list = Vec::new();
    for piece in &curve.atlas.pieces {
        let interval = piece.map.interval(0);
        let at = |k: usize, n: usize| interval.from + (interval.to - interval.from) * k as f64 / n as f64;
        let tangents: Vec<Vector<3>> =
            (0..=PARTS).map(|k| curve.jet(at(k, PARTS)).d1.try_normalize(0.0).unwrap_or_default()).collect();
        let turn: f64 = tangents.windows(2).map(|w| w[0].cross(&w[1]).norm().atan2(w[0].dot(&w[1]))).sum();
        let count = (turn / TURN).ceil().clamp(1.0, 360.0) as usize;
        list.extend((0..count).map(|k| at(k, count)));
    }
    list.push(curve.domain()[1]);
    list
}

/// What the faces of a body share: parameters of chords on its edges.
pub(super) fn chords(solid: &TrimmedSolid) -> Vec<Vec<f64>> {
    solid.edges.iter().map(|e| divided(&e.curve)).collect()
}

/// Sizes of a body by which its faces are off the triangles: a chord of a turn is this far from its arc, and one of a spline less
/// than its part is long.
const OFF: f64 = 1e-2;

impl TrimmedSolid {
    /// How far the faces are off the triangles at most.
    pub(crate) fn off_triangles(&self) -> f64 {
        OFF * self.size
    }

    pub(super) fn triangulate(&self) -> Option<TriangleMesh> {
        let divided = chords(self);
        let mut numbers: HashMap<[i64; 3], u32> = HashMap::new();
        let (mut vertices, mut triangles): (Vec<Point<3>>, Vec<[u32; 3]>) = (Vec::new(), Vec::new());
        let unit = SAME * self.size;
        for face in &self.faces {
            let flat = face.triangles(self, &divided);
            let scale = face.region.scale;
            // Corners of no triangle lie beyond the face.
            let mut number = |k: usize| {
                let (z, on_edge) = &flat.corners[k];
                let x = on_edge.unwrap_or_else(|| face.surface.position([z[0] / scale[0], z[1] / scale[1]]));
                let key = [0, 1, 2].map(|k| (x[k] / unit).round() as i64);
                *numbers.entry(key).or_insert_with(|| {
                    vertices.push(x);
                    vertices.len() as u32 - 1
                })
            };
            for t in &flat.triangles {
                let [a, b, c] = t.map(&mut number);
                if a != b && b != c && c != a {
                    triangles.push(if face.sign > 0.0 { [a, b, c] } else { [a, c, b] });
                }
            }
        }
        TriangleMesh::new(vertices, &triangles).ok()
    }
}

impl Face {
    /// The chords of its edges, with the positions of their ends.
    fn chords(&self, solid: &TrimmedSolid, divided: &[Vec<f64>]) -> Vec<(Chord, [Point<3>; 2])> {
        let (scale, periods) = (self.region.scale, self.surface.periods());
        let mut out = Vec::new();
        for (of, use_) in self.uses.iter().enumerate().filter(|(_, u)| !u.is_seam) {
            let edge = &solid.edges[use_.edge];
            let samples: Vec<(f64, [f64; 2], Point<3>)> = divided[use_.edge]
                .iter()
                .enumerate()
                .map(|(k, &t)| {
                    let near = use_.near(t);
                    let x = edge.curve.position(t);
                    let mut z = self.surface.parameters(&x, Some(near));
                    if self.surface.is_singular(z) {
                        z[0] = near[0];
                    }
                    for k in 0..2 {
                        if let Some(p) = periods[k] {
                            z[k] -= p * ((z[k] - near[k]) / p).round();
                        }
                    }
                    let last = divided[use_.edge].len() - 1;
                    let x = if k == 0 {
                        solid.vertices[edge.ends[0]]
                    } else if k == last {
                        solid.vertices[edge.ends[1]]
                    } else {
                        x
                    };
                    (t, z, x)
                })
                .collect();
            let mut add = |a: &(f64, [f64; 2], Point<3>), b: &(f64, [f64; 2], Point<3>)| {
                let mut ends = [a.1, b.1];
                for k in 0..2 {
                    if let Some(p) = periods[k] {
                        let from = self.region.start[k];
                        let shift = ((0.5 * (ends[0][k] + ends[1][k]) - from) / p).floor() * p;
                        ends.iter_mut().for_each(|e| e[k] -= shift);
                    }
                }
                let ends = ends.map(|z| [z[0] * scale[0], z[1] * scale[1]]);
                out.push((Chord { of, t: [a.0, b.0], ends }, [a.2, b.2]));
            };
            match use_.forward {
                true => samples.windows(2).for_each(|w| add(&w[0], &w[1])),
                false => samples.windows(2).rev().for_each(|w| add(&w[1], &w[0])),
            }
        }
        out
    }

    /// Triangles of its scaled parameters.
    pub(super) fn triangles(&self, solid: &TrimmedSolid, divided: &[Vec<f64>]) -> Flat {
        let own = self.chords(solid, divided);
        let scale = self.region.scale;
        let (periods, ends) = (self.surface.periods(), self.surface.ends());
        let mut low = [f64::INFINITY; 2];
        let mut high = [f64::NEG_INFINITY; 2];
        for (chord, _) in &own {
            for k in 0..2 {
                low[k] = low[k].min(chord.ends[0][k]).min(chord.ends[1][k]);
                high[k] = high[k].max(chord.ends[0][k]).max(chord.ends[1][k]);
            }
        }
        for k in 0..2 {
            if let Some([from, to]) = ends[k] {
                (low[k], high[k]) = (from * scale[k], to * scale[k]);
            }
            if let Some(p) = periods[k] {
                low[k] = self.region.start[k] * scale[k];
                high[k] = low[k] + p * scale[k];
            }
        }
        if self.has_apex() {
            low[1] = 0.0;
        }
        let snap = SNAP * (high[0] - low[0]).max(high[1] - low[1]);
        let snapped = |mut z: [f64; 2]| {
            for k in 0..2 {
                if (z[k] - low[k]).abs() <= snap {
                    z[k] = low[k];
                } else if (z[k] - high[k]).abs() <= snap {
                    z[k] = high[k];
                }
            }
            z
        };
        let mut cdt = Delaunay::new();
        let mut on_edge: HashMap<usize, Point<3>> = HashMap::new();
        // With whether the face is on one side only, that of the loops.
        let mut lines: Vec<([[f64; 2]; 2], bool)> = Vec::new();
        for (chord, at) in &own {
            // Over the side where a period begins a chord is cut.
            let [mut a, mut b] = chord.ends.map(snapped);
            let mut places = [Some(at[0]), Some(at[1])];
            for k in (0..2).filter(|k| periods[*k].is_some()) {
                let p = high[k] - low[k];
                let side = [low[k], high[k]].into_iter().find(|s| (a[k] - s) * (b[k] - s) < 0.0);
                if let Some(side) = side {
                    let share = (side - a[k]) / (b[k] - a[k]);
                    let mut cut = [a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])];
                    cut[k] = side;
                    let (outer, is_first) = if a[k] < low[k] || a[k] > high[k] { (a, true) } else { (b, false) };
                    let shift = if outer[k] < low[k] { p } else { -p };
                    let moved = |z: [f64; 2]| std::array::from_fn(|i| if i == k { z[i] + shift } else { z[i] });
                    let (inner, outer) = (cut, [moved(cut), moved(outer)]);
                    if let Ok(handle) = cdt.insert(Point2::new(outer[1][0], outer[1][1])) {
                        on_edge.insert(handle.index(), at[usize::from(!is_first)]);
                    }
                    lines.push((if is_first { [outer[1], outer[0]] } else { outer }, true));
                    if is_first {
                        (a, places[0]) = (inner, None);
                    } else {
                        (b, places[1]) = (inner, None);
                    }
                }
            }
            for (z, x) in [a, b].into_iter().zip(places) {
                if let (Ok(handle), Some(x)) = (cdt.insert(Point2::new(z[0], z[1])), x) {
                    on_edge.insert(handle.index(), x);
                }
            }
            lines.push(([a, b], true));
        }
        let grid = self.grid([low, high]);
        if !matches!(self.surface, FaceSurface::Plane { .. }) {
            let corners = [[low[0], low[1]], [high[0], low[1]], [high[0], high[1]], [low[0], high[1]]];
            lines.extend([0, 1, 2, 3].map(|k| ([corners[k], corners[(k + 1) % 4]], false)));
            // Sides that are one line of the surface have the same corners.
            for k in (0..2).filter(|k| periods[*k].is_some()) {
                for x in [low[k], high[k]] {
                    for y in &grid[1 - k] {
                        let z = if k == 0 { [x, *y] } else { [*y, x] };
                        _ = cdt.insert(Point2::new(z[0], z[1]));
                    }
                }
            }
        }
        let inner = |z: &[f64; 2]| {
            let distance = self.region.signed([z[0] / scale[0], z[1] / scale[1]]).0;
            distance > self.region.band + 0.2 * (grid_step(&grid[0]).min(grid_step(&grid[1])))
        };
        for x in &grid[0] {
            for y in grid[1].iter().filter(|y| inner(&[*x, **y])) {
                _ = cdt.insert(Point2::new(*x, *y));
            }
        }
        let mut ends: Vec<[FixedVertexHandle; 2]> = Vec::new();
        for ([a, b], is_chord) in lines {
            let handles = [a, b].map(|z| cdt.insert(Point2::new(z[0], z[1])));
            if let [Ok(from), Ok(to)] = handles
                && from != to
                && cdt.can_add_constraint(from, to)
            {
                cdt.add_constraint(from, to);
                if is_chord {
                    ends.push([from, to]);
                }
            }
        }
        let mut flat = Flat { corners: Vec::new(), triangles: Vec::new(), chords: Vec::new() };
        for vertex in cdt.vertices() {
            let p = vertex.position();
            flat.corners.push(([p.x, p.y], on_edge.get(&vertex.fix().index()).copied()));
        }
        let is_inside = self.inside(&cdt, &ends, scale);
        for triangle in cdt.inner_faces().filter(|f| is_inside[f.fix().index()]) {
            flat.triangles.push(triangle.vertices().map(|v| v.fix().index()));
        }
        flat.chords = own.into_iter().map(|c| c.0).collect();
        flat
    }

    /// Which triangles, by their numbers, are of the face: those on its side of chords, and all that no line parts from them.
    fn inside(&self, cdt: &Delaunay, chords: &[[FixedVertexHandle; 2]], scale: [f64; 2]) -> Vec<bool> {
        let mut known: Vec<Option<bool>> = vec![None; cdt.num_all_faces()];
        let mut stack: Vec<(FixedFaceHandle<InnerTag>, bool)> = Vec::new();
        for [from, to] in chords {
            let Some(edge) = cdt.get_edge_from_neighbors(*from, *to) else { continue };
            let (left, right) = (edge.face().as_inner(), edge.rev().face().as_inner());
            stack.extend(left.map(|f| (f.fix(), self.sign > 0.0)));
            stack.extend(right.map(|f| (f.fix(), self.sign < 0.0)));
        }
        let spread = |known: &mut Vec<Option<bool>>, stack: &mut Vec<(FixedFaceHandle<InnerTag>, bool)>| {
            while let Some((face, side)) = stack.pop() {
                if known[face.index()].is_some() {
                    continue;
                }
                known[face.index()] = Some(side);
                for edge in cdt.face(face).adjacent_edges() {
                    let next = edge.rev().face().as_inner();
                    if let Some(next) = next.filter(|_| !edge.is_constraint_edge()) {
                        stack.push((next.fix(), side));
                    }
                }
            }
        };
        spread(&mut known, &mut stack);
        // What no chord reaches: all of a surface without loops, and parts beyond the side where a period begins.
        for face in cdt.inner_faces() {
            if known[face.fix().index()].is_none() {
                let mean = face.vertices().map(|v| v.position());
                let mean = [mean.map(|p| p.x), mean.map(|p| p.y)].map(|x| x.iter().sum::<f64>() / 3.0);
                let side = self.region.signed([mean[0] / scale[0], mean[1] / scale[1]]).0 > 0.0;
                stack.push((face.fix(), side));
                spread(&mut known, &mut stack);
            }
        }
        known.into_iter().map(|k| k == Some(true)).collect()
    }

    /// Scaled parameters of a grid that follows the surface.
    fn grid(&self, [low, high]: [[f64; 2]; 2]) -> [Vec<f64>; 2] {
        let steps = |k: usize, step: f64| {
            let n = ((high[k] - low[k]) / step).ceil().clamp(1.0, 1000.0) as usize;
            (1..n).map(|i| low[k] + (high[k] - low[k]) * i as f64 / n as f64).collect::<Vec<f64>>()
        };
        let [p, q] = self.region.scale;
        match &self.surface {
            FaceSurface::Plane { .. } => [Vec::new(), Vec::new()],
            FaceSurface::Cylinder { .. } | FaceSurface::Cone { .. } => [steps(0, TURN * p), steps(1, 4.0 * TURN * p)],
            FaceSurface::Sphere { .. } | FaceSurface::Torus { .. } => [steps(0, TURN * p), steps(1, TURN * q)],
            FaceSurface::Spline(s) => [0, 1].map(|k| {
                let mut breaks: Vec<f64> = Vec::new();
                for piece in &s.atlas.pieces {
                    let interval = piece.map.interval(k);
                    let step = (interval.to - interval.from) / PARTS as f64;
                    breaks.extend((0..PARTS).map(|i| (interval.from + step * i as f64) * self.region.scale[k]));
                }
                breaks.sort_by(f64::total_cmp);
                breaks.dedup_by(|a, b| (*a - *b).abs() <= SNAP * (high[k] - low[k]));
                breaks.remove(0);
                breaks
            }),
        }
    }
}

/// The distance of lines of a grid.
fn grid_step(lines: &[f64]) -> f64 {
    lines.windows(2).map(|w| w[1] - w[0]).fold(f64::INFINITY, f64::min).min(f64::MAX)
}
