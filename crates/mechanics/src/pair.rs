//! The measures of a contact pair in the unknowns that move its partners: gap, normal and slip with their variations.
//!
//! Between surfaces of facets the gap is measured along the averaged normal of the slave (`cut`), between a curve and such
//! a surface along that of the master (`along`). Otherwise
//! geometry gives the closest point; the measures at it are those of Konyukhov & Schweizerhof (2013), in the coordinates
//! of whatever is met: a surface, a curve, a point, or a rigid body through its gap function.
//!
//! | symbol | meaning |
//! |---|---|
//! | `D = x_s - x_m`, `n` | relative position, unit vector along it, outward from the master |
//! | `g = D·n - R_s - R_m` | gap between the sections or balls of the given radii |
//! | `X^a` | variation of the coordinates of the closest point |
//! | `S` | variation of the slip of the slave along the master, at the point where they touch |
//! | `e` | slip since both sides had a common point, the anchor: along the arc where bodies turn (`arc`) |
//!
//! On a surface, without sections that turn, `S = ρ_a X^a` is the motion of the closest point along the surface, with
//! exact second variations. Everywhere else `S = δD - R_s θ_s × n - R_m θ_m × n - g δn`, which turns into the same where
//! nothing spins; its second variation is exact too. Either way a rigid motion of both partners is no slip, so that the forces
//! have neither resultant nor moment.

mod along;
mod arc;
mod cut;
mod features;
mod gap;
mod measures;
mod slip;

pub use measures::{Axis, AxisChoice, NoPair, Pair, PairGeometry, Stuck, any_tangent, axis};

use crate::points::{Foot, Function, MasterProjection, Order};
use along::AtAlong;
use cut::AtCut;
use gap::{AtFoot, AtRigid};
use measures::Column;
use signorini_geometry::Vector;

/// How far a surface must look away from the outward normal of the other to be met, as a cosine: rounding of normals.
const FACING: f64 = 1e-6;

impl PairGeometry<'_> {
    /// The measures of the pair.
    ///
    /// # Errors
    /// Why there is no pair.
    pub fn measure(&self, order: Order) -> Result<Pair, NoPair> {
        match self.met {
            MasterProjection::Foot(foot) => match foot.coordinates {
                0 => self.with_foot::<0>(foot, order),
                1 => self.with_foot::<1>(foot, order),
                _ => self.with_foot::<2>(foot, order),
            },
            MasterProjection::Along(foot, field) => {
                let at = AtAlong::new(self, foot, field)?;
                let mut pair = at.gap(order);
                if self.friction {
                    at.add_slip(order, &mut pair);
                }
                Ok(pair)
            }
            MasterProjection::Cut(foot) => {
                let at = AtCut::new(self, foot)?;
                let mut pair = at.gap(order);
                if self.friction {
                    at.add_slip(order, &mut pair);
                }
                Ok(pair)
            }
            MasterProjection::Rigid(foot) => {
                let at = AtRigid::new(self, foot)?;
                let mut pair = at.gap(order);
                if self.friction {
                    at.add_slip(order, &mut pair);
                }
                Ok(pair)
            }
        }
    }

    fn with_foot<const N: usize>(&self, foot: &Foot, order: Order) -> Result<Pair, NoPair> {
        let at = AtFoot::<N>::new(self, foot)?;
        let mut pair = at.gap(order);
        if self.friction {
            at.add_slip(order, &mut pair);
        }
        Ok(pair)
    }

    /// Columns of the slave side.
    fn slave_columns(&self) -> Vec<Column> {
        let unknown = |f: &Function| self.first[0] + f.unknown;
        let moves = self.slave.functions.iter().map(|f| Column {
            unknown: unknown(f),
            d: f.value,
            tangent: f.slopes[0],
            ..Column::default()
        });
        let turns = self.slave.spin.iter().enumerate().map(|(k, f)| Column {
            unknown: unknown(f),
            spin: [f.value, Vector::<3>::zeros()],
            turns: Some((0, k)),
            ..Column::default()
        });
        moves.chain(turns).collect()
    }

    /// Columns of the slave, of what moves the averaged normal of a side, of a foot on a surface, and of the anchor.
    fn columns_with_normal(&self, foot: &Foot, (side, normal): (usize, &[Function])) -> Vec<Column> {
        let mut columns = self.slave_columns();
        let unknown = |side: usize, f: &Function| self.first[side] + f.unknown;
        columns.extend(normal.iter().map(|f| Column { unknown: unknown(side, f), ..Column::default() }));
        columns.extend(foot.functions.iter().map(|f| Column {
            unknown: unknown(1, f),
            d: -f.value,
            d_a: f.slopes.map(|s| -s),
            ..Column::default()
        }));
        self.anchor_columns(&mut columns);
        columns
    }

    /// Columns of the anchor.
    fn anchor_columns(&self, columns: &mut Vec<Column>) {
        let Some((_, anchor)) = self.stuck else { return };
        if !self.friction {
            return;
        }
        let unknown = |f: &Function| self.first[1] + f.unknown;
        columns.extend(anchor.functions.iter().map(|f| Column {
            unknown: unknown(f),
            anchor: f.value,
            anchor_tangent: f.slopes[0],
            ..Column::default()
        }));
        columns.extend(anchor.spin.iter().map(|f| Column {
            unknown: unknown(f),
            anchor_spin: f.value,
            ..Column::default()
        }));
    }

    fn check_facing(&self, normal: &Vector<3>) -> Result<(), NoPair> {
        match self.slave.outward {
            Some(outward) if outward.dot(normal) > -FACING * outward.norm() => Err(NoPair::FacesAway),
            _ => Ok(()),
        }
    }
    fn slave_count(&self) -> usize {
        self.slave.functions.len() + self.slave.spin.len()
    }

    /// Second variation of the spins of both partners. A spin is no derivative of a rotation vector; in the coordinates in
    /// which second derivatives along geodesics are symmetric it varies by half the product of two spins. A section that turns
    /// with displacements tells its own.
    fn spin_variation(&self, k: &Column, l: &Column) -> [Vector<3>; 2] {
        let master = match self.met {
            MasterProjection::Foot(foot) => (&foot.spin_bends[..], foot.spin.len()),
            _ => (&[][..], 0),
        };
        let told = [(&self.slave.spin_bends[..], self.slave.spin.len()), master];
        [0, 1].map(|side| {
            let (bends, count) = told[side];
            match (k.turns, l.turns) {
                (Some((a, i)), Some((b, j))) if (a, b) == (side, side) && !bends.is_empty() => bends[i * count + j],
                _ => l.spin[side].cross(&k.spin[side]) * 0.5,
            }
        })
    }

    /// What the spins of the sections do at the point of contact.
    fn levers(&self, c: &Column, normal: &Vector<3>, radii: [f64; 2]) -> Vector<3> {
        (c.spin[0] * radii[0] + c.spin[1] * radii[1]).cross(normal)
    }

    /// The direction from which friction takes its first axis; `otherwise` where nothing is stuck yet.
    fn axis(&self, columns: &[Column], otherwise: Vector<3>) -> Axis {
        let of = |direction: Vector<3>, variation: &dyn Fn(&Column) -> Vector<3>| Axis {
            direction,
            variation: columns.iter().map(variation).collect(),
        };
        match (self.axis, self.stuck) {
            (AxisChoice::Tangent, _) => {
                let direction = self.slave.tangent.unwrap_or_default();
                of(direction, &|c| c.tangent - c.turn.cross(&direction))
            }
            (AxisChoice::OnSlave(v), _) => {
                let direction = self.slave.frame * v;
                of(direction, &|c| (c.spin[0] - c.turn).cross(&direction))
            }
            (AxisChoice::OnMaster(v), Some((_, anchor))) => {
                let direction = anchor.frame * v;
                of(direction, &|c| c.anchor_spin.cross(&direction))
            }
            (AxisChoice::OnMaster(v), None) => of(v, &|_| Vector::<3>::zeros()),
            (AxisChoice::Material, Some((_, anchor))) => of(anchor.tangent, &|c| c.anchor_tangent),
            (AxisChoice::Material, None) => of(otherwise, &|_| Vector::<3>::zeros()),
        }
    }

    /// Second derivatives of the slave's position along a direction.
    fn add_bends(&self, along: &Vector<3>, n: usize, out: &mut [f64]) {
        let place = |unknown: u32| self.slave.functions.iter().position(|f| f.unknown == unknown);
        for bend in &self.slave.bends {
            let (Some(i), Some(j)) = (place(bend.unknowns[0]), place(bend.unknowns[1])) else { continue };
            let value = along.dot(&bend.value);
            out[i * n + j] += value;
            if i != j {
                out[j * n + i] += value;
            }
        }
    }
}
