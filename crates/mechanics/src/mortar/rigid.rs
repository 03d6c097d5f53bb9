//! Points of slave faces that meet a rigid body: pairs by its closest points, and what they add to residual and tangent.

use super::cover::{CoveredPoint, FacingPart};
use super::face_terms::{FaceTerms, Line, Traction, Wanted};
use super::measured::Matched;
use super::terms::NodeTractions;
use crate::pair::{AxisChoice, NoPair, Pair, PairGeometry, Stuck};
use crate::points::{Master, MaterialPoint, Order};
use crate::surface::{Local, Surface};
use rayon::prelude::*;
use signorini_geometry::Vector;
use std::collections::BTreeMap;

/// A surface of faces and a rigid body.
#[derive(Clone, Copy)]
pub(super) struct OnRigid<'a> {
    pub slave: &'a dyn Surface,
    pub master: &'a dyn Master,
    /// First unknowns of both.
    pub first: [u32; 2],
    /// The rotation vector of the body at the last state.
    pub since: Vector<3>,
    /// Whether slip is wanted.
    pub friction: bool,
}

/// Rows of nodes, by component of the traction, over the unknowns of a face.
type Rows = BTreeMap<(u32, usize), Vec<f64>>;

impl OnRigid<'_> {
    /// The pair of a point of a face, with its slip since an anchor if there is one.
    ///
    /// # Errors
    /// Why there is no pair.
    fn pair(&self, (face, s): (usize, &Local), on: Option<MaterialPoint>, order: Order) -> Result<Pair, NoPair> {
        let slave = self.slave.placed(face, s);
        let met = self.master.nearest(&slave.x, f64::INFINITY, None).ok_or(NoPair::NoCoordinates)?;
        let anchored = on.map(|point| (Stuck { point, ..Stuck::default() }, self.master.at(&point)));
        let stuck = anchored.as_ref().map(|(stuck, anchor)| (stuck, anchor));
        let (first, since, friction) = (self.first, [self.since; 2], self.friction);
        let axis = AxisChoice::Material;
        PairGeometry { slave: &slave, met: &met, first, stuck, since, friction, axis }.measure(order)
    }

    /// The pairs of all points, and how many could not be measured.
    pub fn pairs(&self, cover: &FacingPart) -> (Vec<Vec<Option<Pair>>>, usize) {
        let of = |point: &CoveredPoint| self.pair((point.face, &point.s), None, Order::First);
        let found: Vec<Vec<Result<Pair, NoPair>>> =
            cover.points.par_iter().map(|list| list.iter().map(of).collect()).collect();
        let is_lost = |pair: &&Result<Pair, NoPair>| matches!(pair, Err(NoPair::NoCoordinates));
        let lost = found.iter().flatten().filter(is_lost).count();
        (found.into_iter().map(|list| list.into_iter().map(Result::ok).collect()).collect(), lost)
    }

    /// The pair of a matched point, with its slip since then.
    pub fn matched(&self, matched: &Matched) -> Option<Pair> {
        self.pair((matched.face, &matched.s), Some(matched.on), Order::First).ok()
    }

    /// What the points of a face add.
    pub fn terms(
        &self,
        carried: &NodeTractions<'_>,
        (points, pairs): (&[CoveredPoint], &[Option<Pair>]),
        wanted: Wanted,
    ) -> FaceTerms {
        let found: Vec<(&CoveredPoint, &Pair)> = (points.iter().zip(pairs))
            .filter_map(|(point, pair)| Some((point, pair.as_ref()?)))
            .filter(|(point, _)| carried.has_part_in(&point.shares))
            .collect();
        let over = Over::new(found.iter().map(|(_, pair)| *pair));
        let size = over.unknowns.len();
        let mut forces = vec![[0.0; 2]; size];
        let mut stiffness = vec![0.0; if wanted == Wanted::Tangent { size * size } else { 0 }];
        let (mut pushes, mut gaps) = (Rows::new(), Rows::new());
        for (point, pair) in found {
            let traction = carried.traction_at(&point.shares, &pair.normal);
            let place = over.places(pair);
            for (a, at) in place.iter().enumerate() {
                let pushes = -traction.pressure * pair.opening[a];
                let rubbed = pair.slip.get(a).map_or(0.0, |s| traction.friction.dot(s));
                forces[*at][0] += pushes + rubbed;
                forces[*at][1] += pushes.abs() + rubbed.abs();
            }
            if wanted == Wanted::Forces {
                continue;
            }
            if wanted == Wanted::Tangent
                && let Ok(pair) = self.pair((point.face, &point.s), None, Order::Second)
            {
                add_stiffness(&pair, &traction, &place, (&mut stiffness, size));
            }
            for (node, share) in point.shares.iter().filter(|(node, _)| carried.acts[*node as usize]) {
                let line = |rows: &mut Rows, slot: usize, of: &dyn Fn(usize) -> f64| {
                    let row = rows.entry((*node, slot)).or_insert_with(|| vec![0.0; size]);
                    place.iter().enumerate().for_each(|(a, at)| row[*at] += share * of(a));
                };
                line(&mut pushes, 0, &|a| -pair.opening[a]);
                line(&mut gaps, 0, &|a| pair.d_gap[a]);
                for (slot, e) in carried.contact.axes_of(*node, &pair.normal) {
                    line(&mut pushes, slot, &|a| e.dot(&pair.slip[a]));
                }
            }
        }
        let part = |i: usize| over.unknowns.iter().zip(&forces).map(|(u, f)| (*u, f[i])).collect();
        FaceTerms {
            forces: part(0),
            sizes: part(1),
            pushes: over.lines(pushes),
            gaps: over.lines(gaps),
            slips: Vec::new(),
            stiffness: if stiffness.is_empty() { Default::default() } else { (over.unknowns, stiffness) },
        }
    }
}

/// How the points of a face that were matched at the last state change the slips of the nodes; with directions that stay where
/// `is_linear`.
pub(super) fn slips(carried: &NodeTractions<'_>, list: &[(&Matched, &Pair)], is_linear: bool) -> FaceTerms {
    let contact = carried.contact;
    let over = Over::new(list.iter().map(|(_, pair)| *pair));
    let mut rows = Rows::new();
    for (matched, pair) in list {
        let place = over.places(pair);
        for (node, share) in matched.shares.iter().filter(|(node, _)| carried.acts[*node as usize]) {
            let Some(axes) = contact.axes(*node, &pair.normal) else { continue };
            for &slot in &contact.law.slots()[1..] {
                let row = rows.entry((*node, slot)).or_insert_with(|| vec![0.0; over.unknowns.len()]);
                let by_normal = axes.by_normal[slot - 1].transpose() * pair.elastic;
                for (a, at) in place.iter().enumerate() {
                    let turned = if is_linear { 0.0 } else { by_normal.dot(&pair.d_normal[a]) };
                    row[*at] += share * (axes.e[slot - 1].dot(&pair.d_elastic[a]) + turned);
                }
            }
        }
    }
    FaceTerms { slips: over.lines(rows), ..FaceTerms::default() }
}

/// How the forces of a pair change.
fn add_stiffness(pair: &Pair, traction: &Traction, place: &[usize], (out, size): (&mut [f64], usize)) {
    let n = pair.unknowns.len();
    let bent = if pair.slip.is_empty() { Vec::new() } else { pair.slip_hessian(&traction.friction) };
    for a in 0..n {
        let turned = pair.slip.get(a).map(|s| traction.turning.transpose() * s);
        let row = &mut out[place[a] * size..(place[a] + 1) * size];
        for b in 0..n {
            let opened = pair.d_opening.get(a * n + b).map_or(0.0, |d| -traction.pressure * d);
            let rubbed = turned.map_or(0.0, |turned| bent[a * n + b] + turned.dot(&pair.d_normal[b]));
            row[place[b]] += opened + rubbed;
        }
    }
}

/// The unknowns that the pairs of a face bring together, in ascending order.
struct Over {
    unknowns: Vec<u32>,
}

impl Over {
    fn new<'a>(pairs: impl Iterator<Item = &'a Pair>) -> Self {
        let mut unknowns: Vec<u32> = pairs.flat_map(|pair| pair.unknowns.iter().copied()).collect();
        unknowns.sort_unstable();
        unknowns.dedup();
        Over { unknowns }
    }

    fn places(&self, pair: &Pair) -> Vec<usize> {
        pair.unknowns.iter().map(|u| self.unknowns.partition_point(|k| k < u)).collect()
    }

    fn lines(&self, rows: Rows) -> Vec<Line> {
        let line = |((node, slot), row): ((u32, usize), Vec<f64>)| {
            let entries = self.unknowns.iter().copied().zip(row).filter(|e| e.1 != 0.0).collect();
            Line { node, slot, entries }
        };
        rows.into_iter().map(line).collect()
    }
}
