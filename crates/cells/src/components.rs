//! What of the material hangs together: within a cell, across cells, and in the support of a function.
//!
//! A polynomial cannot jump. Where a cell, or the cells around a function, hold several pieces of material, each piece
//! needs a function of its own, or pieces that only lie near to each other are glued together. So a cell is copied once
//! for each piece of its material, and a function once for each connected part of the pieces in its support: two copies
//! of a cell that meet again next door share the functions that see the connection, and no others.
//!
//! Pieces of a cell are found on a lattice of samples, and only where the boundary faces itself (two normals with
//! `n·m < -0.3`): elsewhere a thin band of material between samples would be torn apart. What touches across a side is
//! found from quadrature points of the side.

use crate::region::{Filling, MaterialRule, Region};
use crate::tree::CellTree;
use rayon::prelude::*;
use signorini_fem::cut::End;
use signorini_geometry::{Point, Vector};

/// Samples in each direction of a cell.
const LATTICE: usize = 10;
/// Two normals with a product below this face each other.
const FACING: f64 = -0.3;
/// Two normals with a product below this are turned by half a radian: around a tip of a curvature of half a cell's
/// inverse, or at an edge.
const TURNED: f64 = 0.877_582_561_890_372_8;

/// Whether different pieces of the material in a cell have unknowns of their own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pieces {
    Split,
    Shared,
}

/// The pieces of material in one leaf, and the points of its rule by piece.
#[derive(Clone, Debug)]
pub struct LeafPieces<const D: usize> {
    /// Material samples with the number of their piece; empty where there is one piece.
    samples: Vec<(Point<D>, usize)>,
    /// How many pieces there are; zero in a void leaf.
    pub count: usize,
}

impl<const D: usize> LeafPieces<D> {
    /// The piece to which a point belongs: that of the nearest sample.
    pub fn at(&self, x: &Point<D>) -> usize {
        let nearest = |a: &&(Point<D>, usize), b: &&(Point<D>, usize)| {
            (a.0 - x).norm_squared().total_cmp(&(b.0 - x).norm_squared())
        };
        self.samples.iter().min_by(nearest).map_or(0, |s| s.1)
    }
}

/// Whether the boundary in a cell faces itself.
pub fn faces_itself<const D: usize>(rule: &MaterialRule<D>) -> bool {
    has_normals_below(rule, FACING)
}

/// Whether the boundary in a cell faces itself, or turns by more than half a radian.
pub fn is_narrow<const D: usize>(rule: &MaterialRule<D>) -> bool {
    has_normals_below(rule, TURNED)
}

fn has_normals_below<const D: usize>(rule: &MaterialRule<D>, product: f64) -> bool {
    // Some two hundred of the points show every turn that a quadrature rule resolves.
    let normals: Vec<Vector<D>> = rule.boundary.iter().map(|p| p.normal).collect();
    let stride = (normals.len() / 200).max(1);
    let few: Vec<&Vector<D>> = normals.iter().step_by(stride).collect();
    few.iter().enumerate().any(|(i, n)| few[..i].iter().any(|m| n.dot(m) < product))
}

/// The pieces of material in a leaf.
pub fn pieces_of<const D: usize>(
    region: &dyn Region<D>,
    bounds: &signorini_geometry::Aabb<D>,
    rule: &MaterialRule<D>,
    pieces: Pieces,
) -> LeafPieces<D> {
    if rule.filling == Filling::Void {
        return LeafPieces { samples: Vec::new(), count: 0 };
    }
    let one = LeafPieces { samples: Vec::new(), count: 1 };
    if rule.filling == Filling::Full
        || pieces == Pieces::Shared
        || !faces_itself(rule)
        || !region.has_points_in_material()
    {
        return one;
    }
    let total = LATTICE.pow(D as u32);
    let place = |i: usize| -> [usize; D] { std::array::from_fn(|k| i / LATTICE.pow(k as u32) % LATTICE) };
    let points: Vec<Point<D>> =
        (0..total).map(|i| bounds.at(&Point::from_fn(|k, _| (place(i)[k] as f64 + 0.5) / LATTICE as f64))).collect();
    let material: Vec<bool> = points.iter().map(|x| region.contains(x)).collect();
    let mut label = vec![usize::MAX; total];
    let mut count = 0;
    for start in 0..total {
        if !material[start] || label[start] != usize::MAX {
            continue;
        }
        label[start] = count;
        let mut stack = vec![start];
        while let Some(i) = stack.pop() {
            let at = place(i);
            for k in 0..D {
                for up in [false, true] {
                    if if up { at[k] + 1 == LATTICE } else { at[k] == 0 } {
                        continue;
                    }
                    let step = LATTICE.pow(k as u32);
                    let j = if up { i + step } else { i - step };
                    if material[j] && label[j] == usize::MAX {
                        label[j] = count;
                        stack.push(j);
                    }
                }
            }
        }
        count += 1;
    }
    if count < 2 {
        return one;
    }
    let samples = (0..total).filter(|&i| material[i]).map(|i| (points[i], label[i])).collect();
    LeafPieces { samples, count }
}

/// All pieces of all leaves, and which of them touch.
#[derive(Clone, Debug)]
pub struct PieceGraph<const D: usize> {
    pub leaves: Vec<LeafPieces<D>>,
    /// Number of the first piece of each leaf, and of all pieces.
    pub start: Vec<usize>,
    /// Pieces that touch each piece, sorted.
    pub touching: Vec<Vec<usize>>,
}

impl<const D: usize> PieceGraph<D> {
    pub fn new(region: &dyn Region<D>, tree: &CellTree<D>, rules: &[MaterialRule<D>], pieces: Pieces) -> Self {
        let leaves: Vec<LeafPieces<D>> = (tree.leaves().par_iter().zip(rules))
            .map(|(leaf, rule)| pieces_of(region, &leaf.bounds, rule, pieces))
            .collect();
        let mut start = vec![0];
        for leaf in &leaves {
            start.push(start[start.len() - 1] + leaf.count);
        }
        let found: Vec<Vec<[usize; 2]>> =
            (0..leaves.len())
                .into_par_iter()
                .map(|i| {
                    if leaves[i].count == 0 { Vec::new() } else { touching_of(region, tree, rules, &leaves, &start, i) }
                })
                .collect();
        let mut touching = vec![Vec::new(); start[leaves.len()]];
        for [a, b] in found.into_iter().flatten() {
            touching[a].push(b);
            touching[b].push(a);
        }
        for list in &mut touching {
            list.sort_unstable();
            list.dedup();
        }
        PieceGraph { leaves, start, touching }
    }

    /// The leaf of a piece.
    pub fn leaf_of(&self, piece: usize) -> usize {
        self.start.partition_point(|s| *s <= piece) - 1
    }

    /// For each of some pieces the smallest number among those that it is connected with through them.
    pub fn connected(&self, pieces: &[usize]) -> Vec<usize> {
        let place = |p: usize| pieces.iter().position(|q| *q == p);
        let mut root: Vec<usize> = vec![usize::MAX; pieces.len()];
        let mut order: Vec<usize> = (0..pieces.len()).collect();
        order.sort_by_key(|&i| pieces[i]);
        for &i in &order {
            if root[i] != usize::MAX {
                continue;
            }
            root[i] = pieces[i];
            let mut stack = vec![pieces[i]];
            while let Some(p) = stack.pop() {
                for j in self.touching[p].iter().filter_map(|&q| place(q)) {
                    if root[j] == usize::MAX {
                        root[j] = pieces[i];
                        stack.push(pieces[j]);
                    }
                }
            }
        }
        root
    }

    /// The parts of the whole body that do not hang together: the number of the part of each piece, and how many.
    pub fn parts(&self) -> (Vec<usize>, usize) {
        let mut part = vec![usize::MAX; self.touching.len()];
        let mut count = 0;
        for first in 0..part.len() {
            if part[first] != usize::MAX {
                continue;
            }
            part[first] = count;
            let mut stack = vec![first];
            while let Some(p) = stack.pop() {
                for &q in &self.touching[p] {
                    if part[q] == usize::MAX {
                        part[q] = count;
                        stack.push(q);
                    }
                }
            }
            count += 1;
        }
        (part, count)
    }
}

/// Pairs of touching pieces across the sides of a leaf.
fn touching_of<const D: usize>(
    region: &dyn Region<D>,
    tree: &CellTree<D>,
    rules: &[MaterialRule<D>],
    leaves: &[LeafPieces<D>],
    start: &[usize],
    i: usize,
) -> Vec<[usize; 2]> {
    let b = tree.leaves()[i].bounds;
    let mut out = Vec::new();
    for axis in 0..D {
        for end in End::BOTH {
            let outer = tree.bounds();
            if end.sign() * (end.of(&b, axis) - end.of(outer, axis)) >= 0.0 {
                continue;
            }
            let points: Vec<Point<D>> = if rules[i].filling == Filling::Full {
                // Points enough to meet every smaller neighbour.
                let n = 4usize;
                (0..n.pow(D as u32 - 1))
                    .map(|mut j| {
                        let mut x = b.at(&Point::from_fn(|k, _| {
                            if k == axis {
                                return 0.5;
                            }
                            let t = (j % n) as f64;
                            j /= n;
                            (t + 0.5) / n as f64
                        }));
                        x[axis] = end.of(&b, axis);
                        x
                    })
                    .collect()
            } else {
                region.places_on_side(&b, axis, end)
            };
            for x in points {
                let mut beyond = x;
                beyond[axis] += 1e-9 * end.sign() * b.size()[axis];
                let j = tree.leaf_at(&beyond);
                if leaves[j].count > 0 && i != j {
                    let pair = [start[i] + leaves[i].at(&x), start[j] + leaves[j].at(&beyond)];
                    if out.last() != Some(&pair) {
                        out.push(pair);
                    }
                }
            }
        }
    }
    out
}
