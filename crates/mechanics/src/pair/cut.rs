//! Gap and slip along the averaged normal of a slave surface of facets.
//!
//! The closest point of a facetted surface jumps where its facets meet, and with it the direction of the gap: Newton's
//! method stops where a site passes from facet to facet. Along a direction that belongs to the slave, and changes without
//! jumps over it, gap and opposite point are continuous over the facets of both (Yang, Laursen & Meng 2005; Popp, Gee &
//! Wall 2009).
//!
//! | symbol | meaning |
//! |---|---|
//! | `ν`, `n = -ν/|ν|` | averaged outward normal of the slave, and the direction of the gap, outward from the master |
//! | `D = x_s - x_m(η) = g n` | determines gap `g` and coordinates `η` |
//! | `g' = m·q`, `η'^a = m^a·q` | with `q = δD - g δn` and the dual basis `m, m^1, m^2` of `n, ρ_1, ρ_2` |
//! | `n·δD` | the opening: pressure acts along `n` on both sides |
//! | `S = δD - g δn` | the slip, zero in a rigid motion of both |
//!
//! Forces act along a line through both points, so that they have neither resultant nor moment. The opening is not the
//! variation of the gap, so that the tangent is unsymmetric.

use super::measures::{Column, NoPair, Pair, PairGeometry, SecondVariation, Stuck, axis};
use crate::points::{Foot, Order};
use signorini_geometry::{Matrix, Vector};

/// A slave site and the point across from it.
pub(super) struct AtCut<'a> {
    encounter: &'a PairGeometry<'a>,
    foot: &'a Foot,
    gap: f64,
    normal: Vector<3>,
    /// Length of the averaged normal, and its variation by column.
    length: f64,
    d_averaged: Vec<Vector<3>>,
    columns: Vec<Column>,
    d_normal: Vec<Vector<3>>,
    /// Variations of gap and coordinates, by column.
    varied: Vec<Vector<3>>,
}

impl<'a> AtCut<'a> {
    /// # Errors
    /// A slave without an averaged normal, or one along the surface that it meets.
    pub fn new(encounter: &'a PairGeometry<'a>, foot: &'a Foot) -> Result<Self, NoPair> {
        let slave = encounter.slave;
        let averaged = slave.averaged.as_ref().ok_or(NoPair::NoCoordinates)?;
        let length = averaged.vector.norm();
        let normal = -averaged.vector / length;
        let gap = normal.dot(&(slave.x - foot.jet.x));
        let basis = Matrix::<3>::from_columns(&[normal, foot.jet.u, foot.jet.v]);
        let dual = basis.try_inverse().ok_or(NoPair::NoCoordinates)?;
        let own = encounter.slave_count();
        let columns = encounter.columns_with_normal(foot, (0, &averaged.functions));
        let mut d_averaged = vec![Vector::<3>::zeros(); columns.len()];
        d_averaged[own..].iter_mut().zip(&averaged.functions).for_each(|(d, f)| *d = f.value);
        let d_normal: Vec<Vector<3>> = d_averaged.iter().map(|d| (normal * normal.dot(d) - d) / length).collect();
        let varied = columns.iter().zip(&d_normal).map(|(c, dn)| dual * (c.d - dn * gap)).collect();
        Ok(AtCut { encounter, foot, gap, normal, length, d_averaged, columns, d_normal, varied })
    }

    /// How the variation of the relative position at fixed coordinates changes.
    fn along(&self, k: usize, l: usize) -> Vector<3> {
        let d_a = &self.columns[k].d_a;
        d_a[0] * self.varied[l][1] + d_a[1] * self.varied[l][2]
    }

    /// The gap with its variation and the opening, without slip.
    pub fn gap(&self, order: Order) -> Pair {
        let (columns, n) = (&self.columns, self.columns.len());
        let mut pair = Pair {
            gap: self.gap,
            normal: self.normal,
            point: self.foot.point,
            unknowns: columns.iter().map(|c| c.unknown).collect(),
            d_gap: self.varied.iter().map(|v| v[0]).collect(),
            opening: columns.iter().map(|c| self.normal.dot(&c.d)).collect(),
            d_normal: self.d_normal.clone(),
            ..Pair::default()
        };
        if order == Order::Second {
            let entry = |k: usize, l: usize| self.d_normal[l].dot(&columns[k].d) + self.normal.dot(&self.along(k, l));
            pair.d_opening = (0..n * n).map(|i| entry(i / n, i % n)).collect();
        }
        pair
    }

    /// Adds slip to the measures of a pair that has its gap.
    pub fn add_slip(&self, order: Order, pair: &mut Pair) {
        let (columns, n, gap) = (&self.columns, self.columns.len(), self.gap);
        pair.slip = columns.iter().zip(&self.d_normal).map(|(c, dn)| c.d - dn * gap).collect();
        if order == Order::Second {
            let mut parts: [Vec<f64>; 3] = std::array::from_fn(|_| vec![0.0; n * n]);
            for k in 0..n {
                for l in 0..n {
                    let h = self.along(k, l) - self.d_normal[k] * pair.d_gap[l] - self.turning(k, l) * gap;
                    (0..3).for_each(|i| parts[i][k * n + l] = h[i]);
                }
            }
            self.add_turns(&mut parts);
            pair.second = SecondVariation::Full(parts);
        }
        pair.stuck = Some(Stuck { point: self.foot.point, ..Stuck::default() });
        pair.d_elastic = vec![Vector::<3>::zeros(); n];
        if let Some((_, anchor)) = self.encounter.stuck {
            let slaves = self.encounter.slave_count();
            pair.elastic = self.foot.jet.x - anchor.x;
            for (k, c) in columns.iter().enumerate() {
                // The material of the master moves by -δD of its own functions.
                let own = if k >= slaves { -c.d } else { Vector::<3>::zeros() };
                let moved = self.foot.jet.u * self.varied[k][1] + self.foot.jet.v * self.varied[k][2];
                pair.d_elastic[k] = own + moved - c.anchor;
            }
        }
        pair.axis = self.encounter.axis(columns, self.foot.jet.u);
    }

    /// Second variation of the normal, without second derivatives of the averaged one.
    fn turning(&self, k: usize, l: usize) -> Vector<3> {
        let [first, second] = [&self.d_averaged[k], &self.d_averaged[l]];
        let (dn_k, dn_l) = (self.d_normal[k], self.d_normal[l]);
        let n = &self.normal;
        (dn_l * n.dot(first) + n * dn_l.dot(first) + dn_k * n.dot(second)) / self.length
    }

    /// What second derivatives of the averaged normal add to the second variation of the slip.
    fn add_turns(&self, parts: &mut [Vec<f64>; 3]) {
        let Some(averaged) = &self.encounter.slave.averaged else { return };
        let n = self.columns.len();
        let own = self.encounter.slave_count();
        let place = |unknown: u32| averaged.functions.iter().position(|f| f.unknown == unknown).map(|k| own + k);
        for bend in &averaged.bends {
            let [Some(i), Some(j)] = bend.unknowns.map(place) else { continue };
            let value = (bend.value - self.normal * self.normal.dot(&bend.value)) * (self.gap / self.length);
            for (a, part) in parts.iter_mut().enumerate() {
                let along = axis(a).dot(&value);
                part[i * n + j] += along;
                if i != j {
                    part[j * n + i] += along;
                }
            }
        }
    }
}
