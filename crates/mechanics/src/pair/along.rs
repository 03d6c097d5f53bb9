//! Gap and slip of a curve along the averaged normal of a master surface of facets.
//!
//! The closest point of a facetted surface stays on an edge while a point passes it: a rope that sticks there has neither
//! slip nor a place. Along a normal that changes without jumps over the facets gap and foot move on (Yang, Laursen & Meng
//! 2005, with the normal of the master, as curves have none).
//!
//! | symbol | meaning |
//! |---|---|
//! | `ν(η)`, `n = ν/|ν|` | averaged outward normal of the master, and the direction of the gap |
//! | `D = x_s - x_m(η) = g n(η)` | determines `g` and coordinates `η` |
//! | `S = δD - g δn` at fixed `η` | the slip, zero in a rigid motion of both |
//! | `S = g' n + (ρ_a + g n_a) η'^a` | gives the variations of gap and coordinates, by the dual basis |
//! | `n·δD` | the opening: pressure acts along `n` on both sides |
//!
//! Gap, opening and slip change without jumps over the facets, the motion of the foot does not: sections of curves cannot turn
//! here, and forces act on the lines themselves. They have neither resultant nor moment. The opening is not the
//! variation of the gap, so that the tangent is unsymmetric.

use super::measures::{Column, NoPair, Pair, PairGeometry, SecondVariation, Stuck};
use crate::points::{Foot, NormalField, Order};
use signorini_geometry::{Matrix, Vector};

type V = Vector<3>;

/// A point of a curve and the point from which it lies along the normal.
pub(super) struct AtAlong<'a> {
    encounter: &'a PairGeometry<'a>,
    foot: &'a Foot,
    field: &'a NormalField,
    /// Distance of both points.
    distance: f64,
    normal: V,
    /// Length of the averaged normal.
    length: f64,
    /// `n_a`.
    slopes: [V; 2],
    columns: Vec<Column>,
    /// By column at fixed coordinates: variation of the averaged normal and of its slopes, and of the normal.
    d_field: Vec<(V, [V; 2])>,
    d_normal: Vec<V>,
    /// Variations of gap and coordinates, by column.
    varied: Vec<V>,
}

impl<'a> AtAlong<'a> {
    /// # Errors
    /// A normal along the surface, or a point on its focal set.
    pub fn new(encounter: &'a PairGeometry<'a>, foot: &'a Foot, field: &'a NormalField) -> Result<Self, NoPair> {
        let length = field.vector.norm();
        let normal = field.vector / length;
        let distance = normal.dot(&(encounter.slave.x - foot.jet.x));
        let own = encounter.slave_count();
        let columns = encounter.columns_with_normal(foot, (1, &field.functions));
        let mut d_field = vec![(V::zeros(), [V::zeros(); 2]); columns.len()];
        d_field[own..].iter_mut().zip(&field.functions).for_each(|(d, f)| *d = (f.value, f.slopes));
        let turned = |d: &V| (d - normal * normal.dot(d)) / length;
        let slopes = field.slopes.each_ref().map(turned);
        let basis = [foot.jet.u + slopes[0] * distance, foot.jet.v + slopes[1] * distance];
        let dual =
            Matrix::<3>::from_columns(&[normal, basis[0], basis[1]]).try_inverse().ok_or(NoPair::NoCoordinates)?;
        let d_normal: Vec<V> = d_field.iter().map(|(d, _)| turned(d)).collect();
        let varied = columns.iter().zip(&d_normal).map(|(c, dn)| dual * (c.d - dn * distance)).collect();
        Ok(AtAlong { encounter, foot, field, distance, normal, length, slopes, columns, d_field, d_normal, varied })
    }

    /// Second derivative of the unit normal from first and second ones of the averaged one.
    fn second(&self, x: &V, y: &V, xy: &V) -> V {
        let n = &self.normal;
        let unit = |d: &V| (d - n * n.dot(d)) / self.length;
        let (nx, ny) = (unit(x), unit(y));
        unit(xy) - (ny * n.dot(x) + nx * n.dot(y) + n * ny.dot(x)) / self.length
    }

    /// A vector that depends on the coordinates by these slopes, as they vary.
    fn carried(&self, slopes: &[V; 2], l: usize) -> V {
        slopes[0] * self.varied[l][1] + slopes[1] * self.varied[l][2]
    }

    /// How the variation of the relative position at fixed coordinates changes.
    fn bent(&self, k: usize, l: usize) -> V {
        self.carried(&self.columns[k].d_a, l)
    }

    /// Variation of the normal, with the coordinates.
    fn d_normal(&self, l: usize) -> V {
        self.d_normal[l] + self.carried(&self.slopes, l)
    }

    /// The gap with its variation and the opening, without slip.
    pub fn gap(&self, order: Order) -> Pair {
        let (columns, n) = (&self.columns, self.columns.len());
        let d_normal: Vec<V> = (0..n).map(|l| self.d_normal(l)).collect();
        let mut pair = Pair {
            gap: self.distance - self.encounter.slave.radius - self.foot.radius,
            normal: self.normal,
            point: self.foot.point,
            unknowns: columns.iter().map(|c| c.unknown).collect(),
            d_gap: self.varied.iter().map(|v| v[0]).collect(),
            opening: columns.iter().map(|c| self.normal.dot(&c.d)).collect(),
            ..Pair::default()
        };
        if order == Order::Second {
            let entry = |k: usize, l: usize| d_normal[l].dot(&columns[k].d) + self.normal.dot(&self.bent(k, l));
            pair.d_opening = (0..n * n).map(|i| entry(i / n, i % n)).collect();
        }
        pair.d_normal = d_normal;
        pair
    }

    /// Adds slip to the measures of a pair that has its gap.
    pub fn add_slip(&self, order: Order, pair: &mut Pair) {
        let (columns, n) = (&self.columns, self.columns.len());
        let base = [self.foot.jet.u, self.foot.jet.v];
        pair.slip = columns.iter().zip(&self.d_normal).map(|(c, dn)| c.d - dn * self.distance).collect();
        if order == Order::Second {
            let list = self.slip_variation();
            pair.second = SecondVariation::Full([0, 1, 2].map(|i| list.iter().map(|h| h[i]).collect()));
        }
        pair.stuck = Some(Stuck { point: self.foot.point, ..Stuck::default() });
        pair.d_elastic = vec![V::zeros(); n];
        if let Some((_, anchor)) = self.encounter.stuck {
            let slaves = self.encounter.slave_count();
            pair.elastic = self.foot.jet.x - anchor.x;
            for (k, c) in columns.iter().enumerate() {
                // The material of the master moves by -δD of its own functions.
                let own = if k >= slaves { -c.d } else { V::zeros() };
                pair.d_elastic[k] = own + self.carried(&base, k) - c.anchor;
            }
        }
        pair.axis = self.encounter.axis(columns, self.foot.jet.u);
    }

    /// Second variation of the slip, row by row.
    fn slip_variation(&self) -> Vec<V> {
        let n = self.columns.len();
        let own = self.encounter.slave_count();
        let place = |unknown: u32| self.field.functions.iter().position(|f| f.unknown == unknown).map(|k| own + k);
        let mut bends = vec![V::zeros(); n * n];
        for bend in &self.field.bends {
            let [Some(i), Some(j)] = bend.unknowns.map(place) else { continue };
            bends[i * n + j] += bend.value;
            if i != j {
                bends[j * n + i] += bend.value;
            }
        }
        let entry = |k: usize, l: usize| {
            let (value, slopes) = &self.d_field[k];
            let of = |a: usize| self.second(value, &self.field.slopes[a], &slopes[a]);
            let turned = self.second(value, &self.d_field[l].0, &bends[k * n + l]) + self.carried(&[of(0), of(1)], l);
            self.bent(k, l) - self.d_normal[k] * self.varied[l][0] - turned * self.distance
        };
        (0..n * n).map(|i| entry(i / n, i % n)).collect()
    }
}
