//! Cells divided into four, all of them or some.

use super::curved::box_round;
use super::place::for_each_bucket;
use super::{MOST_ON_TRIANGLES, MeshCells, Parent};
use crate::cell_parts::{PARTS, parts};
use crate::cells::Cells;
use crate::lists::Lists;
use crate::mesh::Mesh;
use signorini_geometry::{Aabb, Point};
use std::sync::Arc;

/// Cells are near a place that is less than so many of their extents away.
const NEAR: f64 = 2.0;

impl MeshCells {
    /// The same functions on the mesh with every cell divided into four.
    pub fn refined(self: &Arc<Self>) -> Self {
        let mesh = self.mesh.refined(&self.adjacency);
        let mut fine = Self::with(mesh, self.adjacency.refined(&self.mesh), self.degree);
        let mut nodes = vec![[0; 4]; fine.nodes.len()];
        for cell in 0..fine.count() {
            let coarse = cell / PARTS;
            let corners = self.corner_functions(coarse);
            let part = parts(self.mesh.shape(coarse))[cell % PARTS];
            for (function, corner) in fine.corner_functions(cell).iter().zip(part) {
                nodes[*function as usize] = corner.map(|v| corners[usize::from(v)]);
            }
        }
        fine.parent = Some(Parent { cells: self.clone(), nodes });
        fine
    }

    /// The same functions on the mesh before any such division, with cells divided until those near each of the places are no
    /// larger than the size wanted there, at most so often, and as long as `also` says so of a cell's box and how often it was
    /// divided. None of a degree that triangles do not have, which lie beside divided cells.
    pub fn graded(
        self: &Arc<Self>,
        places: &[(Point<2>, f64)],
        most: usize,
        also: &dyn Fn(&Aabb<2>, usize) -> bool,
    ) -> Option<Self> {
        if self.degree > MOST_ON_TRIANGLES {
            return None;
        }
        if let Some(whole) = &self.whole {
            return whole.graded(places, most, also);
        }
        let about = |b: &Aabb<2>, extent: f64| {
            let reach = Point::<2>::repeat(NEAR * extent);
            Aabb::new(b.min - reach, b.max + reach)
        };
        let in_buckets = Lists::new(self.buckets.cell_count(), |visit| {
            places.iter().zip(0u32..).for_each(|((x, _), k)| visit(self.buckets.cell_containing(x), k));
        });
        let near: Vec<Vec<u32>> = (0..self.count())
            .map(|cell| {
                let reach = about(&self.bounds_of(cell), self.extent(cell));
                let mut near = Vec::new();
                for_each_bucket(&self.buckets, &reach, |bucket| near.extend_from_slice(in_buckets.of(bucket)));
                near.retain(|&k| reach.contains(&places[k as usize].0));
                near
            })
            .collect();
        let mut wanted = |mesh: &Mesh<2>, cell: usize, of: usize, level: usize| {
            let b = box_round(mesh.cell_nodes(cell).iter().map(|&n| mesh.nodes()[n as usize]));
            let extent = self.extent(of) / f64::from(1u32 << level);
            let reach = about(&b, extent);
            let mut near = near[of].iter().map(|&k| &places[k as usize]);
            (level < most && near.any(|(x, size)| extent > *size && reach.contains(x))) || also(&b, level)
        };
        let (mesh, levels) = self.mesh.graded(&mut wanted);
        Some(Self { whole: Some(self.clone()), levels, ..Self::new(mesh, self.degree) })
    }

    /// Functions of degree 1 on the same mesh, and on those of which its cells were divided.
    pub fn of_degree_one(&self) -> Self {
        match &self.parent {
            Some(parent) => Arc::new(parent.cells.of_degree_one()).refined(),
            None => Self::new(self.mesh.clone(), 1),
        }
    }
}
