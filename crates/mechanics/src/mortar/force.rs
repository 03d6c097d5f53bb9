//! Residual and tangent of a mortar contact, added up face by face.

use super::Mortar;
use super::cover::{Cover, CoveredPoint};
use super::measure::{NodeMeasure, Separation, Sides};
use crate::interaction::{Own, Target};
use crate::pair::{NoPair, Pair};
use crate::points::Order;
use rayon::prelude::*;
use signorini_contact::Status;
use signorini_contact::law::Projected;
use signorini_geometry::{Matrix, Vector};
use std::collections::HashMap;

/// The part of its scale by which a multiplier resists change within a Newton step, in the tangent alone: what several
/// nodes carry together need not be unique.
const UNDETERMINED: f64 = 1e-6;

/// A contact with its sides in a state, and what was found there.
pub(super) struct Assembly<'a> {
    pub contact: &'a Mortar,
    pub sides: &'a Sides<'a>,
    pub own: Own<'a>,
    pub measures: &'a [NodeMeasure],
    pub projected: &'a [Projected],
}

/// Rows and columns of the unknowns that one face brings together.
struct Block {
    unknowns: Vec<u32>,
    place: HashMap<u32, usize>,
    values: Vec<f64>,
}

impl Block {
    fn new(lists: impl Iterator<Item = u32>) -> Block {
        let mut unknowns: Vec<u32> = lists.collect();
        unknowns.sort_unstable();
        unknowns.dedup();
        let place = unknowns.iter().enumerate().map(|(k, u)| (*u, k)).collect();
        let values = vec![0.0; unknowns.len() * unknowns.len()];
        Block { unknowns, place, values }
    }

    fn places(&self, list: &[u32]) -> Vec<usize> {
        list.iter().map(|u| self.place[u]).collect()
    }
}

/// A row or column of a multiplier over the unknowns of a face.
type Lines = HashMap<(u32, usize), Vec<f64>>;

impl Assembly<'_> {
    /// Number of a multiplier among all unknowns.
    fn row(&self, node: u32, component: usize) -> u32 {
        self.own.first + node * self.contact.components() as u32 + component as u32
    }

    /// The equations of the nodes, without what other unknowns change in them.
    pub fn add_nodes(&self, out: &mut Target<'_>) {
        let contact = self.contact;
        for (node, projected) in (0u32..).zip(self.projected) {
            let k = node as usize;
            let lambda = contact.multiplier(k, self.own.multipliers);
            let scale = contact.weights[k] / contact.stiffness[k];
            let parts = contact.slots();
            for (i, &slot) in parts.iter().enumerate() {
                let row = self.row(node, i);
                let traction = projected.traction[slot];
                out.residual[row as usize] += scale * (traction - lambda[slot]);
                out.sizes[row as usize] += scale * (traction.abs() + lambda[slot].abs());
                let Some(tangent) = &mut out.tangent else { continue };
                for (j, &other) in parts.iter().enumerate() {
                    // Tractions that nothing determines stay where they are.
                    let own = if i == j { 1.0 + UNDETERMINED } else { 0.0 };
                    let follows = (1.0 - contact.softness) * projected.derivative[slot][other];
                    if follows != own {
                        tangent.add(row, self.row(node, j), scale * (follows - own));
                    }
                }
            }
        }
    }

    /// Forces of a face, with their derivatives, and how the gaps of its points change those of the nodes.
    pub fn add_face(&self, points: &[CoveredPoint], pairs: &[Option<Pair>], out: &mut Target<'_>) {
        let contact = self.contact;
        let rubs = contact.friction.is_some();
        let acts = |node: &u32| {
            let k = *node as usize;
            self.projected[k].status != Status::Open || contact.multiplier(k, self.own.multipliers) != [0.0; 3]
        };
        let found: Vec<(&CoveredPoint, &Pair)> = (points.iter().zip(pairs))
            .filter_map(|(point, pair)| Some((point, pair.as_ref()?)))
            .filter(|(point, _)| point.shares.iter().any(|(node, _)| acts(node)))
            .collect();
        if found.is_empty() {
            return;
        }
        let mut block = match &out.tangent {
            Some(_) => Block::new(found.iter().flat_map(|(_, pair)| pair.unknowns.iter().copied())),
            None => Block::new(std::iter::empty()),
        };
        let (mut columns, mut rows): (Lines, Lines) = (HashMap::new(), HashMap::new());
        let size = block.unknowns.len();
        for (point, pair) in found {
            let is_linear = contact.small.is_some();
            let measured = (out.tangent.is_some() && !is_linear)
                .then(|| self.sides.pair(point, rubs, Order::Second).ok())
                .flatten();
            let linearised = if is_linear { out.tangent.as_ref().map(|_| pair) } else { measured.as_ref() };
            let (mut pressure, mut friction, mut turning) = (0.0, Vector::<3>::zeros(), Matrix::<3>::zeros());
            for (node, share) in &point.shares {
                let lambda = contact.multiplier(*node as usize, self.own.multipliers);
                pressure += share * lambda[0];
                if let Some(axes) = contact.axes(*node, &pair.normal).filter(|_| rubs) {
                    for i in 0..2 {
                        friction += axes.e[i] * (share * lambda[1 + i]);
                        turning += axes.by_normal[i] * (share * lambda[1 + i]);
                    }
                }
            }
            for (a, unknown) in pair.unknowns.iter().enumerate() {
                let pushes = -pressure * pair.opening[a];
                let rubbed = if rubs { friction.dot(&pair.slip[a]) } else { 0.0 };
                out.residual[*unknown as usize] += pushes + rubbed;
                out.sizes[*unknown as usize] += pushes.abs() + rubbed.abs();
            }
            let Some(pair) = linearised else { continue };
            let n = pair.unknowns.len();
            let place = block.places(&pair.unknowns);
            let bent = if rubs { pair.slip_hessian(&friction) } else { Vec::new() };
            for a in 0..n {
                let turned = if rubs { turning.transpose() * pair.slip[a] } else { Vector::<3>::zeros() };
                let row = &mut block.values[place[a] * size..(place[a] + 1) * size];
                for b in 0..n {
                    let mut value = pair.d_opening.get(a * n + b).map_or(0.0, |d| -pressure * d);
                    if rubs {
                        value += bent[a * n + b] + turned.dot(&pair.d_normal[b]);
                    }
                    row[place[b]] += value;
                }
            }
            for (node, share) in point.shares.iter().filter(|(node, _)| acts(node)) {
                let line = |lines: &mut Lines, i: usize, of: &dyn Fn(usize) -> f64| {
                    let line = lines.entry((*node, i)).or_insert_with(|| vec![0.0; size]);
                    (0..n).for_each(|a| line[place[a]] += share * of(a));
                };
                line(&mut columns, 0, &|a| -pair.opening[a]);
                line(&mut rows, 0, &|a| pair.d_gap[a]);
                if let Some(axes) = contact.axes(*node, &pair.normal).filter(|_| rubs) {
                    for (i, &slot) in contact.slots().iter().enumerate().skip(1) {
                        line(&mut columns, i, &|a| axes.e[slot - 1].dot(&pair.slip[a]));
                    }
                }
            }
        }
        let Some(tangent) = &mut out.tangent else { return };
        tangent.add_block(&block.unknowns, &block.values);
        for ((node, i), line) in sorted(columns) {
            let row = self.row(node, i);
            block.unknowns.iter().zip(line).for_each(|(u, v)| tangent.add(*u, row, v));
        }
        for ((node, _), line) in sorted(rows) {
            let k = node as usize;
            if self.projected[k].status == Status::Open {
                continue;
            }
            for (i, &slot) in contact.slots().iter().enumerate() {
                // ζ_n = λ - c g: the scale of the equation has 1/c.
                let factor = -contact.weights[k] / self.measures[k].weight * self.projected[k].derivative[slot][0];
                if factor != 0.0 {
                    let row = self.row(node, i);
                    block.unknowns.iter().zip(&line).for_each(|(u, v)| tangent.add(row, *u, factor * v));
                }
            }
        }
    }

    /// How the points matched at the last state change the slips of the nodes.
    pub fn add_slips(&self, separations: &[Option<Separation>], out: &mut Target<'_>) {
        let contact = self.contact;
        let Some(tangent) = &mut out.tangent else { return };
        let list: Vec<_> = contact.matched.iter().zip(separations).collect();
        for of_face in list.chunk_by(|a, b| a.0.face == b.0.face) {
            let unknowns =
                of_face.iter().filter_map(|(_, apart)| apart.as_ref()).flat_map(|a| a.unknowns.iter().copied());
            let block = Block::new(unknowns);
            let mut rows: Lines = HashMap::new();
            for (matched, apart) in of_face {
                let Some(apart) = apart else { continue };
                let place = block.places(&apart.unknowns);
                for (node, share) in &matched.shares {
                    if self.projected[*node as usize].status == Status::Open {
                        continue;
                    }
                    let Some(axes) = contact.axes(*node, &apart.normal) else { continue };
                    for &slot in &contact.slots()[1..] {
                        let line = rows.entry((*node, slot)).or_insert_with(|| vec![0.0; block.unknowns.len()]);
                        let by_normal = axes.by_normal[slot - 1].transpose() * apart.vector;
                        for (b, at) in place.iter().enumerate() {
                            let slope = axes.e[slot - 1].dot(&apart.d_vector[b]) + by_normal.dot(&apart.d_normal[b]);
                            line[*at] += share * slope;
                        }
                    }
                }
            }
            for ((node, by), line) in sorted(rows) {
                let k = node as usize;
                for (i, &slot) in contact.slots().iter().enumerate() {
                    let factor = contact.weights[k] / self.measures[k].matched * self.projected[k].derivative[slot][by];
                    if factor != 0.0 {
                        let row = self.row(node, i);
                        block.unknowns.iter().zip(&line).for_each(|(u, v)| tangent.add(row, *u, factor * v));
                    }
                }
            }
        }
    }
}

/// In the same order whatever the hashes.
fn sorted(lines: Lines) -> Vec<((u32, usize), Vec<f64>)> {
    let mut out: Vec<_> = lines.into_iter().collect();
    out.sort_by_key(|(key, _)| *key);
    out
}

impl Mortar {
    /// The pairs of all points, and how many could not be measured.
    pub(super) fn pairs(&self, sides: &Sides<'_>, cover: &Cover) -> (Vec<Vec<Option<Pair>>>, usize) {
        let of = |point: &CoveredPoint| sides.pair(point, self.friction.is_some(), Order::First);
        let found: Vec<Vec<Result<Pair, NoPair>>> =
            cover.points.par_iter().map(|list| list.iter().map(of).collect()).collect();
        let is_lost = |pair: &&Result<Pair, NoPair>| matches!(pair, Err(NoPair::NoCoordinates));
        let lost = found.iter().flatten().filter(is_lost).count();
        (found.into_iter().map(|list| list.into_iter().map(Result::ok).collect()).collect(), lost)
    }

    /// How far all matched points are apart.
    pub(super) fn separations(&self, sides: &Sides<'_>) -> Vec<Option<Separation>> {
        self.matched.par_iter().map(|m| sides.separation(m).ok()).collect()
    }
}
