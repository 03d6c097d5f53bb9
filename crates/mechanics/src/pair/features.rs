//! The measures of two features of polyhedra that face each other.
//!
//! With the points `x`, `y` of both bodies, `D = x - y = g n`, and the change `ν = δn` of the normal, which is that of a facet, of what is
//! across two edges, or of a distance:
//!
//! `δg = n·δD`,  `δ²g = n·δ²D + ν·δD + δD·ν - g ν·ν`,  slip `S = δD - n δg - g ν`
//!
//! as the points follow the features, so that `n·D` does not change by the way that they go along these.

use super::measures::SecondVariation;
use super::{Axis, AxisChoice, Pair, any_tangent};
use crate::body::Carried;
use crate::points::Order;
use signorini_geometry::polyhedra::Meeting;
use signorini_geometry::{Matrix, Vector};

/// One unknown: the motion of its body's point, and spin.
struct Column {
    unknown: u32,
    side: usize,
    local: u32,
    moved: Vector<3>,
    spin: Vector<3>,
}

impl Pair {
    /// The pair of two features, with what carries the point of each.
    pub fn of_features(
        met: &Meeting,
        carried: [&Carried; 2],
        first: [u32; 2],
        (order, choice): (Order, AxisChoice),
    ) -> Pair {
        let (normal, gap) = (met.normal, met.gap);
        let columns: Vec<Column> = (0..2)
            .flat_map(|side| {
                let own = carried[side];
                own.functions.iter().map(move |f| {
                    let spin =
                        own.spin.iter().find(|s| s.unknown == f.unknown).map_or(Vector::<3>::zeros(), |s| s.value);
                    let moved = if side == 0 { f.value } else { -f.value };
                    Column { unknown: first[side] + f.unknown, side, local: f.unknown, moved, spin }
                })
            })
            .collect();
        let spins = |c: &Column| {
            let mut out = [Vector::<3>::zeros(); 2];
            out[c.side] = c.spin;
            out
        };
        let rates: Vec<Vector<3>> = columns.iter().map(|c| met.normal_rate(&c.moved, spins(c))).collect();
        let opening: Vec<f64> = columns.iter().map(|c| normal.dot(&c.moved)).collect();
        let slip = (0..columns.len()).map(|k| columns[k].moved - normal * opening[k] - rates[k] * gap).collect();
        let direction = match choice {
            AxisChoice::OnSlave(v) => carried[0].frame * v,
            AxisChoice::OnMaster(v) => carried[1].frame * v,
            AxisChoice::Material | AxisChoice::Tangent => any_tangent(&normal),
        };
        let axis = Axis { direction, variation: vec![Vector::<3>::zeros(); columns.len()] };
        let mut pair = Pair {
            gap,
            normal,
            unknowns: columns.iter().map(|c| c.unknown).collect(),
            d_gap: opening.clone(),
            opening,
            d_normal: rates,
            slip,
            axis,
            ..Pair::default()
        };
        if order == Order::Second {
            pair.add_second(&columns, carried);
        }
        pair
    }

    fn add_second(&mut self, columns: &[Column], carried: [&Carried; 2]) {
        let (n, count) = (self.normal, columns.len());
        let bend = |k: &Column, l: &Column| {
            if k.side != l.side {
                return Vector::<3>::zeros();
            }
            let pair = [k.local.min(l.local), k.local.max(l.local)];
            let found = carried[k.side].bends.iter().find(|b| {
                let [i, j] = b.unknowns;
                [i.min(j), i.max(j)] == pair
            });
            found.map_or(Vector::<3>::zeros(), |b| if k.side == 0 { b.value } else { -b.value })
        };
        let mut parts: [Vec<f64>; 3] = std::array::from_fn(|_| vec![0.0; count * count]);
        self.d_opening = vec![0.0; count * count];
        for k in 0..count {
            for l in 0..count {
                let bent = bend(&columns[k], &columns[l]);
                let rates = [self.d_normal[k], self.d_normal[l]];
                let turned = rates[0].dot(&columns[l].moved) + rates[1].dot(&columns[k].moved);
                self.d_opening[k * count + l] = n.dot(&bent) + turned - self.gap * rates[0].dot(&rates[1]);
                let slipped = bent - rates[0] * self.d_gap[l] - rates[1] * self.d_gap[k];
                let across: Matrix<3> = Matrix::<3>::identity() - n * n.transpose();
                let slipped = across * slipped;
                (0..3).for_each(|i| parts[i][k * count + l] = slipped[i]);
            }
        }
        self.second = SecondVariation::Full(parts);
    }
}
