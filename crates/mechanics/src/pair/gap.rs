//! The gap of a pair and its variations.

use super::measures::{Column, NoPair, Pair, PairGeometry, axis};
use crate::points::{Foot, Function, Order, RigidFoot};
use nalgebra::{SMatrix, SVector};
use signorini_geometry::measures::{Measures, PartnerJet, Variation};
use signorini_geometry::shape::CurveJet;
use signorini_geometry::{Matrix, Vector};

/// Sine of the angle to the normal, and relative difference of curvatures, from which a site is beside what it meets: rounding.
const BESIDE: f64 = 1e-6;

/// A slave site and the foot of its distance on a point, a curve or a surface.
pub(super) struct AtFoot<'a, const N: usize> {
    pub encounter: &'a PairGeometry<'a>,
    pub foot: &'a Foot,
    pub normal: Vector<3>,
    pub measures: Measures<N>,
    pub columns: Vec<Column>,
    pub variations: Vec<Variation<N>>,
}

impl<'a, const N: usize> AtFoot<'a, N> {
    /// # Errors
    /// Why there is no pair.
    pub fn new(encounter: &'a PairGeometry<'a>, foot: &'a Foot) -> Result<Self, NoPair> {
        let slave = encounter.slave;
        let d = slave.x - foot.jet.x;
        let along = d.try_normalize(0.0);
        let normal = match (foot.outward, along) {
            (Some(outward), _) if N == 2 => outward,
            (Some(outward), Some(along)) => along * along.dot(&outward).signum(),
            (None, Some(along)) => along,
            (outward, None) => outward.ok_or(NoPair::NoCoordinates)?,
        };
        encounter.check_facing(&normal)?;
        let curve = CurveJet { x: foot.jet.x, d1: foot.jet.u, d2: foot.jet.uu, d3: foot.jet.uuu };
        let jet = match N {
            0 => PartnerJet::Point(&foot.jet.x),
            1 => PartnerJet::Curve(&curve),
            _ => PartnerJet::Surface(&foot.jet),
        };
        let measures = Measures::<N>::new(PartnerJet::Point(&slave.x), jet, normal).ok_or(NoPair::NoCoordinates)?;

        let mut columns = encounter.slave_columns();
        let unknown = |f: &Function| encounter.first[1] + f.unknown;
        columns.extend(foot.functions.iter().map(|f| Column {
            unknown: unknown(f),
            d: -f.value,
            d_a: f.slopes.map(|s| -s),
            d_ab: f.second.map(|s| -s),
            ..Column::default()
        }));
        columns.extend(foot.spin.iter().enumerate().map(|(k, f)| Column {
            unknown: unknown(f),
            spin: [Vector::<3>::zeros(), f.value],
            spin_slope: f.slopes[0],
            turns: Some((1, k)),
            ..Column::default()
        }));
        encounter.anchor_columns(&mut columns);
        let variations: Vec<Variation<N>> = (columns.iter())
            .map(|c| Variation {
                d: c.d,
                d_a: std::array::from_fn(|a| c.d_a[a]),
                d_ab: std::array::from_fn(|a| std::array::from_fn(|b| c.d_ab[a + b])),
            })
            .collect();
        Ok(AtFoot { encounter, foot, normal, measures, columns, variations })
    }

    /// Radii of the sections or balls of slave and master.
    pub fn radii(&self) -> [f64; 2] {
        [self.encounter.slave.radius, self.foot.radius]
    }

    /// Variations of the normal.
    fn normals(&self) -> Vec<Vector<3>> {
        let (measures, normal, jet) = (&self.measures, self.normal, &self.foot.jet);
        let base = [jet.u, jet.v];
        let second = [jet.uu, jet.uv, jet.vv];
        let inverse = measures.metric().try_inverse().unwrap_or_else(SMatrix::zeros);
        (self.columns.iter().zip(&self.variations))
            .map(|(column, variation)| {
                let xi: SVector<f64, N> = measures.coordinate_variation(variation);
                if N == 2 {
                    // -ρ^a (n·δρ_a), with the variations of the base vectors of the master.
                    let d_base = |a: usize| (0..N).fold(-column.d_a[a], |sum, b| sum + second[a + b] * xi[b]);
                    let h: SVector<f64, N> = SVector::from_fn(|a, _| normal.dot(&d_base(a)));
                    let up = inverse * h;
                    (0..N).fold(Vector::<3>::zeros(), |sum, a| sum - base[a] * up[a])
                } else {
                    let foot_motion = (0..N).fold(Vector::<3>::zeros(), |sum, a| sum + base[a] * xi[a]);
                    let change = column.d - foot_motion;
                    let across = change - normal * normal.dot(&change);
                    if measures.gap == 0.0 { Vector::<3>::zeros() } else { across / measures.gap }
                }
            })
            .collect()
    }

    fn is_beside(&self) -> bool {
        let apart = self.encounter.slave.x - self.foot.jet.x;
        let aside = apart - self.normal * self.normal.dot(&apart);
        self.foot.outward.is_some() && (N < 2 || aside.norm() > BESIDE * apart.norm())
    }

    /// The gap with its variations, without slip.
    pub fn gap(&self, order: Order) -> Pair {
        let mut pair = Pair {
            gap: self.measures.gap - self.radii()[0] - self.radii()[1],
            normal: self.normal,
            point: self.foot.point,
            is_beside: self.encounter.friction && self.is_beside(),
            unknowns: self.columns.iter().map(|c| c.unknown).collect(),
            d_gap: self.variations.iter().map(|v| self.measures.gap_variation(v)).collect(),
            d_normal: self.normals(),
            ..Pair::default()
        };
        if order == Order::Second {
            pair.d_opening = self.measures.gap_hessian(&self.variations);
            self.encounter.add_bends(&self.normal, self.columns.len(), &mut pair.d_opening);
        }
        pair.opening = pair.d_gap.clone();
        pair
    }
}

/// A slave site and the foot of its distance on a rigid body.
pub(super) struct AtRigid<'a> {
    pub encounter: &'a PairGeometry<'a>,
    pub foot: &'a RigidFoot,
    pub columns: Vec<Column>,
    arm: Vector<3>,
}

impl<'a> AtRigid<'a> {
    /// # Errors
    /// A slave that faces away.
    pub fn new(encounter: &'a PairGeometry<'a>, foot: &'a RigidFoot) -> Result<Self, NoPair> {
        encounter.check_facing(&foot.jet.normal)?;
        let arm = encounter.slave.x - foot.centre;
        // Relative motion seen from the body: δx - δc - θ × r.
        let mut columns = encounter.slave_columns();
        for (k, unknown) in foot.unknowns.iter().enumerate() {
            let Some(unknown) = unknown else { continue };
            let e = axis(k % 3);
            let (d, turn) = if k < 3 { (-e, Vector::<3>::zeros()) } else { (-e.cross(&arm), e) };
            let spin = [Vector::<3>::zeros(), turn];
            columns.push(Column { unknown: encounter.first[1] + unknown, d, spin, turn, ..Column::default() });
        }
        Ok(AtRigid { encounter, foot, columns, arm })
    }

    /// Edges and vertices are where the distance curves as that from a line or a point.
    fn is_beside(&self) -> bool {
        let jet = &self.foot.jet;
        let is_flat = jet.gap <= 0.0 || jet.hessian == Matrix::<3>::zeros();
        !is_flat && jet.gap * jet.hessian.symmetric_eigenvalues().max() > 1.0 - BESIDE
    }

    /// Whether nothing curves or turns, so that second variations are those of the position of the slave alone.
    pub fn is_plain(&self) -> bool {
        let zero = Vector::<3>::zeros();
        let is_still = |c: &Column| c.turn == zero && c.spin == [zero; 2];
        self.foot.jet.hessian == Matrix::<3>::zeros() && self.columns.iter().all(is_still)
    }

    /// Second derivatives of the position seen from the body.
    pub fn bend(&self, k: usize, l: usize) -> Vector<3> {
        let arm = self.arm;
        let [p, q] = [&self.columns[k], &self.columns[l]];
        let plain = |c: &Column| c.d + c.turn.cross(&arm);
        let mixed = p.turn.cross(&plain(q)) + q.turn.cross(&plain(p));
        (p.turn.cross(&q.turn.cross(&arm)) + q.turn.cross(&p.turn.cross(&arm))) * 0.5 - mixed
    }

    /// The gap with its variations, without slip.
    pub fn gap(&self, order: Order) -> Pair {
        let (columns, n) = (&self.columns, self.columns.len());
        let (normal, hessian) = (self.foot.jet.normal, self.foot.jet.hessian);
        let mut pair = Pair {
            gap: self.foot.jet.gap - self.encounter.slave.radius,
            normal,
            point: self.foot.point,
            is_beside: self.encounter.friction && self.is_beside(),
            unknowns: columns.iter().map(|c| c.unknown).collect(),
            d_gap: columns.iter().map(|c| normal.dot(&c.d)).collect(),
            d_normal: columns.iter().map(|c| hessian * c.d).collect(),
            turn: if self.foot.unknowns == [None; 6] { Vec::new() } else { columns.iter().map(|c| c.turn).collect() },
            ..Pair::default()
        };
        if order == Order::Second {
            pair.d_opening = vec![0.0; n * n];
            let is_plain = self.is_plain();
            for k in (0..n).filter(|_| !is_plain) {
                let curved = hessian * columns[k].d;
                for l in 0..n {
                    pair.d_opening[k * n + l] = curved.dot(&columns[l].d) + normal.dot(&self.bend(k, l));
                }
            }
            self.encounter.add_bends(&normal, n, &mut pair.d_opening);
        }
        pair.opening = pair.d_gap.clone();
        pair
    }
}
