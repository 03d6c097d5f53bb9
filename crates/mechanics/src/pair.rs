//! The measures of a contact pair in the unknowns that move its partners: gap, normal and slip with their variations.
//!
//! Geometry gives the closest point; the measures at it are those of Konyukhov & Schweizerhof (2013), in the coordinates
//! of whatever is met: a surface, a curve, a point, or a rigid body through its gap function.
//!
//! | symbol | meaning |
//! |---|---|
//! | `D = x_s - x_m`, `n` | relative position, unit vector along it, outward from the master |
//! | `g = D·n - R_s - R_m` | gap between the sections or balls of the given radii |
//! | `X^a` | variation of the coordinates of the closest point |
//! | `S` | variation of the slip of the slave along the master, at the point where they touch |
//! | `e` | slip since both sides had a common point, the anchor |
//!
//! On a surface, without sections that turn, `S = ρ_a X^a` is the motion of the closest point along the surface, with
//! exact second variations. Everywhere else `S = δD - R_s θ_s × n - R_m θ_m × n - g δn`, which turns into the same where
//! nothing spins; its second variation leaves out `g δ²n`, which vanishes with the gap. Either way a rigid motion of
//! both partners is no slip, so that the forces have neither resultant nor moment.

use crate::body::{Anchor, Foot, Function, MaterialPoint, Met, Order, Placed, RigidFoot};
use nalgebra::{SMatrix, SVector};
use signorini_geometry::measures::{Measures, PartnerJet, Variation};
use signorini_geometry::shape::CurveJet;
use signorini_geometry::{Matrix, Point, Vector};

/// Why two things that are near each other make no pair.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum NoPair {
    /// The slave surface faces away.
    FacesAway,
    /// The coordinates of the pair do not exist: on a focal set.
    NoCoordinates,
}

/// Where both sides had a common point: the material point of the master, and the direction in which the sections of
/// both touched, in their own axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stuck {
    pub point: MaterialPoint,
    pub on_slave: Vector<3>,
    pub on_master: Vector<3>,
}

/// One unknown and how it moves the partners, at fixed coordinates.
#[derive(Clone, Copy, Debug, Default)]
struct Column {
    unknown: u32,
    /// `δD`, `δD_a`, `δD_ab`.
    d: Vector<3>,
    d_a: [Vector<3>; 2],
    d_ab: [Vector<3>; 3],
    spin: [Vector<3>; 2],
    /// Motion of the anchor, and of its tangent.
    anchor: Vector<3>,
    anchor_tangent: Vector<3>,
    anchor_spin: Vector<3>,
    /// Motion of the slave's tangent.
    tangent: Vector<3>,
    /// Turn of the axes in which vectors are compared: of a rigid master.
    turn: Vector<3>,
}

/// A direction from which friction takes its first axis, with its variations.
#[derive(Clone, Debug, Default)]
pub struct Axis {
    pub direction: Vector<3>,
    pub variation: Vec<Vector<3>>,
}

/// The measures of a pair.
#[derive(Clone, Debug, Default)]
pub struct Pair {
    pub gap: f64,
    pub normal: Vector<3>,
    /// The material point of the master that is met.
    pub point: MaterialPoint,
    /// Unknowns of the system; one may be named twice, its contributions add up.
    pub unknowns: Vec<u32>,
    pub d_gap: Vec<f64>,
    /// Row by row; empty where only first variations were asked for.
    pub d2_gap: Vec<f64>,
    /// Variation of the normal (seen from the master if that is rigid).
    pub d_normal: Vec<Vector<3>>,
    /// Variation of the slip.
    pub slip: Vec<Vector<3>>,
    /// Slip since the anchor and its variation.
    pub elastic: Vector<3>,
    pub d_elastic: Vec<Vector<3>>,
    /// The direction from which friction takes its first axis.
    pub axis: Axis,
    /// Where the pair touches, as an anchor of what follows.
    pub stuck: Option<Stuck>,
    second: SecondVariation,
}

/// What the second variation of the slip needs.
#[derive(Clone, Debug, Default)]
enum SecondVariation {
    #[default]
    None,
    /// Third-order tensor, component by component: `T·δS` is the sum of `T_i` times these matrices.
    Full([Vec<f64>; 3]),
}

impl Pair {
    /// `T · Δδ slip`, row by row.
    pub fn slip_hessian(&self, traction: &Vector<3>) -> Vec<f64> {
        let n = self.unknowns.len();
        let mut out = vec![0.0; n * n];
        if let SecondVariation::Full(parts) = &self.second {
            for (part, t) in parts.iter().zip(traction.iter()) {
                out.iter_mut().zip(part).for_each(|(o, p)| *o += t * p);
            }
        }
        out
    }
}

/// A slave site with what it meets.
pub struct Encounter<'a> {
    pub slave: &'a Placed,
    pub met: &'a Met,
    /// First unknown of the slave's body and of the master's body in the system.
    pub first: [u32; 2],
    /// Where slips count from, with what moves it.
    pub stuck: Option<(&'a Stuck, &'a Anchor)>,
    /// Whether slip is wanted.
    pub friction: bool,
    pub axis: AxisChoice,
}

/// What carries the first axis of friction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum AxisChoice {
    /// Any direction that moves with the material of the master: for laws without axes.
    #[default]
    Material,
    /// The tangent of the slave, which is a curve.
    Tangent,
    /// A direction that turns with the slave or the master if that is rigid, and else stays.
    OnSlave(Vector<3>),
    OnMaster(Vector<3>),
}

/// How far a surface must look away from the outward normal of the other to be met, as a cosine: rounding of normals.
const FACING: f64 = 1e-6;

impl Encounter<'_> {
    /// The measures of the pair.
    ///
    /// # Errors
    /// Why there is no pair.
    pub fn measure(&self, order: Order) -> Result<Pair, NoPair> {
        match self.met {
            Met::Foot(foot) => match foot.coordinates {
                0 => self.with_foot::<0>(foot, order),
                1 => self.with_foot::<1>(foot, order),
                _ => self.with_foot::<2>(foot, order),
            },
            Met::Rigid(foot) => self.with_rigid(foot, order),
        }
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
        let turns = self.slave.spin.iter().map(|f| Column {
            unknown: unknown(f),
            spin: [f.value, Vector::<3>::zeros()],
            ..Column::default()
        });
        moves.chain(turns).collect()
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

    fn with_foot<const N: usize>(&self, foot: &Foot, order: Order) -> Result<Pair, NoPair> {
        let slave = self.slave;
        let d = slave.x - foot.jet.x;
        let along = d.try_normalize(0.0);
        let normal = match (foot.outward, along) {
            (Some(outward), _) if N == 2 => outward,
            (Some(outward), Some(along)) => along * along.dot(&outward).signum(),
            (None, Some(along)) => along,
            (outward, None) => outward.ok_or(NoPair::NoCoordinates)?,
        };
        self.check_facing(&normal)?;
        let curve = CurveJet { x: foot.jet.x, d1: foot.jet.u, d2: foot.jet.uu, d3: foot.jet.uuu };
        let jet = match N {
            0 => PartnerJet::Point(&foot.jet.x),
            1 => PartnerJet::Curve(&curve),
            _ => PartnerJet::Surface(&foot.jet),
        };
        let measures = Measures::<N>::new(PartnerJet::Point(&slave.x), jet, normal).ok_or(NoPair::NoCoordinates)?;
        let radii = [slave.radius, foot.radius];
        let gap = measures.gap - radii[0] - radii[1];

        let mut columns = self.slave_columns();
        let unknown = |f: &Function| self.first[1] + f.unknown;
        columns.extend(foot.functions.iter().map(|f| Column {
            unknown: unknown(f),
            d: -f.value,
            d_a: f.slopes.map(|s| -s),
            d_ab: f.second.map(|s| -s),
            ..Column::default()
        }));
        columns.extend(foot.spin.iter().map(|f| Column {
            unknown: unknown(f),
            spin: [Vector::<3>::zeros(), f.value],
            ..Column::default()
        }));
        self.anchor_columns(&mut columns);
        let variations: Vec<Variation<N>> = (columns.iter())
            .map(|c| Variation {
                d: c.d,
                d_a: std::array::from_fn(|a| c.d_a[a]),
                d_ab: std::array::from_fn(|a| std::array::from_fn(|b| c.d_ab[a + b])),
            })
            .collect();
        let mut pair = Pair {
            gap,
            normal,
            point: foot.point,
            unknowns: columns.iter().map(|c| c.unknown).collect(),
            d_gap: variations.iter().map(|v| measures.gap_variation(v)).collect(),
            ..Pair::default()
        };
        let n = columns.len();
        if order == Order::Second {
            pair.d2_gap = measures.gap_hessian(&variations);
            self.add_bends(&normal, n, &mut pair.d2_gap);
        }
        if !self.friction {
            return Ok(pair);
        }

        let base = [foot.jet.u, foot.jet.v];
        let second = [foot.jet.uu, foot.jet.uv, foot.jet.vv];
        let xi: Vec<SVector<f64, N>> = variations.iter().map(|v| measures.coordinate_variation(v)).collect();
        // Variations of the base vectors of the master, and of the motion of the foot along it.
        let d_base = |k: usize, a: usize| (0..N).fold(-columns[k].d_a[a], |sum, b| sum + second[a + b] * xi[k][b]);
        let foot_motion = |k: usize| (0..N).fold(Vector::<3>::zeros(), |sum, a| sum + base[a] * xi[k][a]);
        let inverse = measures.metric().try_inverse().unwrap_or_else(SMatrix::zeros);
        pair.d_normal = (0..n)
            .map(|k| {
                if N == 2 {
                    // -ρ^a (n·δρ_a).
                    let h: SVector<f64, N> = SVector::from_fn(|a, _| normal.dot(&d_base(k, a)));
                    let up = inverse * h;
                    (0..N).fold(Vector::<3>::zeros(), |sum, a| sum - base[a] * up[a])
                } else {
                    let change = columns[k].d - foot_motion(k);
                    let across = change - normal * normal.dot(&change);
                    if measures.gap == 0.0 { Vector::<3>::zeros() } else { across / measures.gap }
                }
            })
            .collect();
        let turns = !slave.spin.is_empty() || !foot.spin.is_empty();
        let exact = N == 2 && !turns;
        // The part of the gap that turns with the normal; where sections cannot turn forces act on the lines themselves.
        let lever = if turns || radii == [0.0; 2] { 1.0 } else { 0.0 };
        pair.slip = (0..n)
            .map(|k| {
                if exact {
                    foot_motion(k)
                } else {
                    columns[k].d - self.levers(&columns[k], &normal, radii) - pair.d_normal[k] * (lever * gap)
                }
            })
            .collect();
        if order == Order::Second {
            let hessian = |k: usize, l: usize| {
                if exact {
                    let h = measures.coordinate_second_variation(&variations[k], &variations[l]);
                    (0..N).fold(Vector::<3>::zeros(), |sum, a| sum + d_base(l, a) * xi[k][a] + base[a] * h[a])
                } else {
                    let along = (0..N).fold(Vector::<3>::zeros(), |sum, a| sum + columns[k].d_a[a] * xi[l][a]);
                    let gap_turns = pair.d_normal[k] * (lever * pair.d_gap[l]);
                    let [of_slave, of_master] = spin_variation(&columns[k], &columns[l]);
                    let spun = (of_slave * radii[0] + of_master * radii[1]).cross(&normal);
                    along - self.levers(&columns[k], &pair.d_normal[l], radii) - spun - gap_turns
                }
            };
            let mut parts: [Vec<f64>; 3] = std::array::from_fn(|_| vec![0.0; n * n]);
            for k in 0..n {
                for l in 0..n {
                    let h = hessian(k, l);
                    (0..3).for_each(|i| parts[i][k * n + l] = h[i]);
                }
            }
            if !exact {
                (0..3).for_each(|i| self.add_bends(&axis(i), n, &mut parts[i]));
            }
            pair.second = SecondVariation::Full(parts);
        }
        pair.stuck = Some(Stuck {
            point: foot.point,
            on_slave: slave.frame.transpose() * normal,
            on_master: foot.frame.transpose() * normal,
        });
        if let Some((stuck, anchor)) = self.stuck {
            // Material points that were in touch: x_s - R_s Q_s m_s and x_m + R_m Q_m m_m; with an exact motion of the
            // foot along the master it is that of the foot.
            let arms = if turns {
                [slave.frame * stuck.on_slave * radii[0], anchor.frame * stuck.on_master * radii[1]]
            } else {
                [Vector::<3>::zeros(); 2]
            };
            let from = if exact { foot.jet.x } else { slave.x };
            pair.elastic = from - arms[0] - anchor.x - arms[1];
            pair.d_elastic = (0..n)
                .map(|k| {
                    let c = &columns[k];
                    if exact {
                        // The material of the master at the foot moves by -δD of its own functions.
                        let own = if k >= self.slave_count() { -c.d } else { Vector::<3>::zeros() };
                        own + foot_motion(k) - c.anchor
                    } else {
                        let slave_side = if k < self.slave_count() { c.d } else { Vector::<3>::zeros() };
                        slave_side - c.spin[0].cross(&arms[0]) - c.anchor - c.anchor_spin.cross(&arms[1])
                    }
                })
                .collect();
        } else {
            pair.d_elastic = vec![Vector::<3>::zeros(); n];
        }
        pair.axis = self.axis(&columns, foot.jet.u);
        Ok(pair)
    }

    fn slave_count(&self) -> usize {
        self.slave.functions.len() + self.slave.spin.len()
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

    fn with_rigid(&self, foot: &RigidFoot, order: Order) -> Result<Pair, NoPair> {
        let slave = self.slave;
        let (normal, hessian) = (foot.jet.normal, foot.jet.hessian);
        self.check_facing(&normal)?;
        let gap = foot.jet.gap - slave.radius;
        let arm = slave.x - foot.centre;
        // Relative motion seen from the body: δx - δc - θ × r.
        let mut columns = self.slave_columns();
        for (k, unknown) in foot.unknowns.iter().enumerate() {
            let Some(unknown) = unknown else { continue };
            let e = axis(k % 3);
            let (d, turn) = if k < 3 { (-e, Vector::<3>::zeros()) } else { (-e.cross(&arm), e) };
            let spin = [Vector::<3>::zeros(), turn];
            columns.push(Column { unknown: self.first[1] + unknown, d, spin, turn, ..Column::default() });
        }
        let n = columns.len();
        // Second derivatives of the position seen from the body.
        let bend = |k: usize, l: usize| {
            let [p, q] = [&columns[k], &columns[l]];
            let plain = |c: &Column| c.d + c.turn.cross(&arm);
            let mixed = p.turn.cross(&plain(q)) + q.turn.cross(&plain(p));
            (p.turn.cross(&q.turn.cross(&arm)) + q.turn.cross(&p.turn.cross(&arm))) * 0.5 - mixed
        };
        let mut pair = Pair {
            gap,
            normal,
            point: foot.point,
            unknowns: columns.iter().map(|c| c.unknown).collect(),
            d_gap: columns.iter().map(|c| normal.dot(&c.d)).collect(),
            ..Pair::default()
        };
        if order == Order::Second {
            pair.d2_gap = vec![0.0; n * n];
            for k in 0..n {
                let curved = hessian * columns[k].d;
                for l in 0..n {
                    pair.d2_gap[k * n + l] = curved.dot(&columns[l].d) + normal.dot(&bend(k, l));
                }
            }
            self.add_bends(&normal, n, &mut pair.d2_gap);
        }
        if !self.friction {
            return Ok(pair);
        }
        pair.d_normal = columns.iter().map(|c| hessian * c.d).collect();
        let turns = !slave.spin.is_empty();
        // Without a section that turns the ball about the slave point moves with the foot.
        let distance = if turns { gap } else { foot.jet.gap };
        let lever = if turns { slave.radius } else { 0.0 };
        let across = Matrix::<3>::identity() - normal * normal.transpose();
        let relative_spin = |c: &Column| c.spin[0] - c.spin[1];
        pair.slip = (columns.iter())
            .map(|c| across * c.d - hessian * c.d * distance - relative_spin(c).cross(&normal) * lever)
            .collect();
        if order == Order::Second {
            let third = curvature_slopes(foot, distance, slave.x);
            let mut parts: [Vec<f64>; 3] = std::array::from_fn(|_| vec![0.0; n * n]);
            for k in 0..n {
                let curved_k = hessian * columns[k].d;
                for l in 0..n {
                    let curved_l = hessian * columns[l].d;
                    let bent = bend(k, l);
                    let mut h = bent - hessian * bent * distance;
                    h -= curved_l * pair.d_gap[k] + curved_k * pair.d_gap[l];
                    h -= relative_spin(&columns[k]).cross(&curved_l) * lever;
                    // Spins, seen from the body.
                    let [of_slave, of_body] = spin_variation(&columns[k], &columns[l]);
                    let [slave, body] = columns[k].spin;
                    let turned = columns[l].turn.cross(&(slave - body));
                    h -= (of_slave - of_body - turned).cross(&normal) * lever;
                    // As the motion of a foot changes, but for what turns with the body.
                    for i in 0..3 {
                        let slope = distance * (third[i] * columns[k].d).dot(&columns[l].d);
                        parts[i][k * n + l] = h[i] - slope;
                    }
                }
            }
            for i in 0..3 {
                let along = axis(i) - hessian * axis(i) * distance;
                self.add_bends(&along, n, &mut parts[i]);
            }
            pair.second = SecondVariation::Full(parts);
        }
        pair.stuck = Some(Stuck {
            point: foot.point,
            on_slave: slave.frame.transpose() * normal,
            on_master: Vector::<3>::zeros(),
        });
        if let Some((stuck, anchor)) = self.stuck {
            if turns {
                let contact = slave.frame * stuck.on_slave * lever;
                pair.elastic = slave.x - contact - anchor.x;
                let seen = |c: &Column| c.d - c.spin[0].cross(&contact);
                // The anchor turns with the body, and so does what is compared with it.
                pair.d_elastic = (columns.iter()).map(|c| seen(c) + c.turn.cross(&contact)).collect();
            } else {
                pair.elastic = slave.x - normal * foot.jet.gap - anchor.x;
                pair.d_elastic = pair.slip.clone();
            }
        } else {
            pair.d_elastic = vec![Vector::<3>::zeros(); n];
        }
        pair.axis = self.axis(&columns, any_tangent(&normal));
        Ok(pair)
    }
}

/// Second variation of the spins of both partners. A spin is no derivative of a rotation vector; in the coordinates in
/// which second derivatives along geodesics are symmetric it varies by half the product of two spins.
fn spin_variation(k: &Column, l: &Column) -> [Vector<3>; 2] {
    [0, 1].map(|side: usize| l.spin[side].cross(&k.spin[side]) * 0.5)
}

/// The derivative of the Hessian of the gap along the three axes, by central differences; zero without a gap.
fn curvature_slopes(foot: &RigidFoot, distance: f64, x: Point<3>) -> [Matrix<3>; 3] {
    if distance == 0.0 || foot.jet.hessian == Matrix::<3>::zeros() {
        return [Matrix::<3>::zeros(); 3];
    }
    // The best step for a second-order difference, relative to the radius of curvature.
    let step = f64::EPSILON.cbrt() / foot.jet.hessian.abs().max();
    let turned = |x: Point<3>| {
        let y = foot.origin + foot.rotation.transpose() * (x - foot.centre);
        foot.rotation * foot.shape.gap(&y).hessian * foot.rotation.transpose()
    };
    std::array::from_fn(|i| (turned(x + axis(i) * step) - turned(x - axis(i) * step)) / (2.0 * step))
}

/// The unit vector along an axis.
pub fn axis(i: usize) -> Vector<3> {
    Vector::<3>::from_fn(|k, _| f64::from(u8::from(k == i)))
}

/// Some direction across a normal.
pub fn any_tangent(normal: &Vector<3>) -> Vector<3> {
    let across = axis(normal.iamin());
    (across - normal * normal.dot(&across)).normalize()
}
