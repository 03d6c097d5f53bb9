//! The mesh of patches: spans as cells, control points and vertices that patches share counted once, and names of the sides.

use super::join::{JoinedSides, PatchSide, joined_sides};
use super::macro_cells::macro_cells;
use super::patch::{NurbsError, NurbsPatch};
use crate::block::side_names;
use crate::mesh::{Mesh, Side};
use signorini_basis::{CellShape, RationalBasis, SpanFunctions};
use signorini_geometry::Point;
use std::sync::Arc;

/// Numbers of things of all patches, of which some are the same.
struct Merged {
    first: Vec<usize>,
    same: Vec<usize>,
}

impl Merged {
    fn new<const D: usize>(grids: &[[usize; D]], joined: &[JoinedSides]) -> Self {
        let mut first = vec![0];
        grids.iter().for_each(|grid| first.push(first[first.len() - 1] + grid.iter().product::<usize>()));
        let mut out = Merged { same: (0..first[grids.len()]).collect(), first };
        for pair in joined {
            let [a, b] = pair.sides.map(|side| side.patch);
            for [i, j] in pair.pairs([grids[a], grids[b]]) {
                let [i, j] = [out.root(out.first[a] + i), out.root(out.first[b] + j)];
                out.same[i.max(j)] = i.min(j);
            }
        }
        out
    }

    fn root(&self, mut k: usize) -> usize {
        while self.same[k] != k {
            k = self.same[k];
        }
        k
    }

    /// The number of each thing of each patch among those that differ, from `start`, and the first of each.
    fn numbers(&self, start: usize) -> (Vec<u32>, Vec<usize>) {
        let mut out = vec![0; self.same.len()];
        let mut firsts = Vec::new();
        for k in 0..self.same.len() {
            let root = self.root(k);
            if root == k {
                out[k] = (start + firsts.len()) as u32;
                firsts.push(k);
            } else {
                out[k] = out[root];
            }
        }
        (out, firsts)
    }
}

/// The mesh of patches of one degree in all directions. Its groups are `left`, `right` and so on as of a box, for a patch with a
/// name also `NAME` with its cells and `NAME_left` and so on, and `boundary`; sides that are joined are in none.
///
/// # Errors
/// Sides that meet without being the same.
pub fn mesh_of_patches<const D: usize>(patches: &[NurbsPatch<D>]) -> Result<Mesh<D>, NurbsError> {
    let joined = joined_sides(patches)?;
    let grids: Vec<[usize; D]> = patches.iter().map(NurbsPatch::counts).collect();
    let spans: Vec<[usize; D]> =
        patches.iter().map(|p| p.lines.each_ref().map(|line| line.breaks().len() - 1)).collect();
    let corners: Vec<[usize; D]> = spans.iter().map(|n| n.map(|n| n + 1)).collect();
    let (controls, vertices) = (Merged::new(&grids, &joined), Merged::new(&corners, &joined));
    let (control_of, first_controls) = controls.numbers(0);
    let (vertex_of, first_vertices) = vertices.numbers(first_controls.len());
    let patch_of = |merged: &Merged, k: usize| merged.first.partition_point(|f| *f <= k) - 1;
    let mut nodes: Vec<Point<D>> = Vec::with_capacity(first_controls.len() + first_vertices.len());
    for k in first_controls {
        let patch = patch_of(&controls, k);
        nodes.push(patches[patch].points[k - controls.first[patch]]);
    }
    for k in first_vertices {
        let patch = patch_of(&vertices, k);
        let index = index_in(k - vertices.first[patch], &corners[patch]);
        let breaks = patches[patch].lines.each_ref().map(super::line::KnotLine::breaks);
        nodes.push(patches[patch].at(&std::array::from_fn(|k| breaks[k][index[k]])));
    }
    let mut mesh = Mesh::new(nodes);
    let shape = if D == 2 { CellShape::Quadrilateral } else { CellShape::Hexahedron };
    let mut first = 0;
    for (number, patch) in patches.iter().enumerate() {
        let lines: [Vec<(usize, Arc<SpanFunctions>)>; D] = (patch.lines.each_ref())
            .map(|line| line.spans().into_iter().map(|(first, functions)| (first, Arc::new(functions))).collect());
        let degree = patch.degree();
        for cells in macro_cells(&patch.lines) {
            mesh.add_macro_cell(cells.into_iter().map(|(cell, place)| ((first + cell) as u32, place)));
        }
        for cell in 0..spans[number].iter().product() {
            let span: [usize; D] = index_in(cell, &spans[number]);
            let own = (0..(degree + 1).pow(D as u32)).map(|f| {
                let place: [usize; D] = index_in(f, &[degree + 1; D]);
                number_in(&std::array::from_fn(|k| lines[k][span[k]].0 + place[k]), &grids[number])
            });
            let own: Vec<usize> = own.collect();
            let basis = RationalBasis::new(
                (0..D).map(|k| Arc::clone(&lines[k][span[k]].1)).collect(),
                own.iter().map(|f| patch.weights[*f]).collect(),
            );
            let global: Vec<u32> = own.iter().map(|f| control_of[controls.first[number] + f]).collect();
            let at_vertex = |x: &[f64; 3]| {
                let index = std::array::from_fn(|k| span[k] + usize::from(x[k] > 0.0));
                vertex_of[vertices.first[number] + number_in(&index, &corners[number])]
            };
            let at: Vec<u32> = shape.vertices().iter().map(at_vertex).collect();
            let cell = mesh.add_span(Arc::new(basis), &global, &at);
            if !patch.name.is_empty() {
                mesh.group_mut(&patch.name).cells.push(cell);
            }
        }
        first += spans[number].iter().product::<usize>();
    }
    let mut first = 0;
    for (number, n) in spans.iter().enumerate() {
        let free = |side: &PatchSide| !joined.iter().any(|j| j.sides.contains(side));
        for side in PatchSide::all::<D>(number).filter(free) {
            let name = side_names(D)[side.across][usize::from(side.upper)];
            let of_cell = side_of(shape, &side);
            let counts = side.counts(*n);
            let mut names = vec!["boundary".to_string(), name.to_string()];
            if !patches[number].name.is_empty() {
                names.push(format!("{}_{name}", patches[number].name));
            }
            for k in 0..counts[0] * counts[1] {
                let cell = first + side.number(*n, [k % counts[0], k / counts[0]]);
                let side = Side { cell: cell as u32, side: of_cell };
                names.iter().for_each(|name| mesh.group_mut(name).sides.push(side));
            }
        }
        first += n.iter().product::<usize>();
    }
    Ok(mesh)
}

/// The side of a cell that lies on a side of its patch.
fn side_of(shape: CellShape, side: &PatchSide) -> u8 {
    let on = |corners: &&[usize]| corners.iter().all(|&c| (shape.vertices()[c][side.across] > 0.0) == side.upper);
    shape.sides().iter().position(on).unwrap_or(0) as u8
}

pub(super) fn index_in<const D: usize>(mut number: usize, grid: &[usize; D]) -> [usize; D] {
    std::array::from_fn(|k| {
        let at = number % grid[k];
        number /= grid[k];
        at
    })
}

pub(super) fn number_in<const D: usize>(index: &[usize; D], grid: &[usize; D]) -> usize {
    (0..D).rev().fold(0, |number, k| number * grid[k] + index[k])
}
