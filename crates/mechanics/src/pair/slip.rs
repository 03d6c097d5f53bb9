//! The slip of a pair: variation, second variation, and what has slipped since the anchor.

use super::arc::{ContactAxes, Varied, arc, least_turn};
use super::gap::{AtFoot, AtRigid};
use super::measures::{Column, Pair, SecondVariation, Stuck, any_tangent, axis};
use crate::points::{Anchor, Order, RigidFoot};
use crate::rotation;
use nalgebra::{SMatrix, SVector};
use signorini_geometry::{Matrix, Point, Vector};

impl<const N: usize> AtFoot<'_, N> {
    /// Adds slip to the measures of a pair that has its gap.
    pub fn add_slip(&self, order: Order, pair: &mut Pair) {
        let (slave, foot, normal) = (self.encounter.slave, self.foot, self.normal);
        let (measures, columns, variations) = (&self.measures, &self.columns, &self.variations);
        let (n, gap, radii) = (columns.len(), pair.gap, self.radii());
        let base = [foot.jet.u, foot.jet.v];
        let second = [foot.jet.uu, foot.jet.uv, foot.jet.vv];
        let xi: Vec<SVector<f64, N>> = variations.iter().map(|v| measures.coordinate_variation(v)).collect();
        // Variations of the base vectors of the master, and of the motion of the foot along it.
        let d_base = |k: usize, a: usize| (0..N).fold(-columns[k].d_a[a], |sum, b| sum + second[a + b] * xi[k][b]);
        let foot_motion = |k: usize| (0..N).fold(Vector::<3>::zeros(), |sum, a| sum + base[a] * xi[k][a]);
        let turns = !slave.spin.is_empty() || slave.turn.is_some() || !foot.spin.is_empty();
        let exact = N == 2 && !turns;
        // The part of the gap that turns with the normal; where sections cannot turn forces act on the lines themselves.
        let lever = if turns || radii == [0.0; 2] { 1.0 } else { 0.0 };
        pair.slip = (0..n)
            .map(|k| {
                if exact {
                    foot_motion(k)
                } else {
                    columns[k].d - self.encounter.levers(&columns[k], &normal, radii) - pair.d_normal[k] * (lever * gap)
                }
            })
            .collect();
        if order == Order::Second {
            let inverse = measures.metric().try_inverse().unwrap_or_else(SMatrix::zeros);
            let third = [foot.jet.uuu, foot.jet.uuv, foot.jet.uvv, foot.jet.vvv];
            // The part across itself of the second variation of the normal of a surface: what keeps the normal on the base
            // vectors, `δ²n·ρ_a = -δ_k n·δ_l ρ_a - δ_l n·δ_k ρ_a - n·δ²ρ_a`.
            let normal_bend = |k: usize, l: usize| {
                let both: SVector<f64, N> = measures.coordinate_second_variation(&variations[k], &variations[l]);
                if N < 2 {
                    // That of `D/|D|`.
                    if measures.gap == 0.0 {
                        return Vector::<3>::zeros();
                    }
                    let mut bent = -(pair.d_normal[k] * pair.d_gap[l] + pair.d_normal[l] * pair.d_gap[k]);
                    for a in 0..N {
                        bent += columns[k].d_a[a] * xi[l][a] + columns[l].d_a[a] * xi[k][a];
                        bent -= second[2 * a] * (xi[k][a] * xi[l][a]) + base[a] * both[a];
                    }
                    return bent / measures.gap;
                }
                let down: SVector<f64, N> = SVector::from_fn(|a, _| {
                    let mut bent = Vector::<3>::zeros();
                    for b in 0..N {
                        bent += second[a + b] * both[b];
                        bent -= columns[k].d_ab[a + b] * xi[l][b] + columns[l].d_ab[a + b] * xi[k][b];
                        (0..N).for_each(|c| bent += third[a + b + c] * (xi[k][b] * xi[l][c]));
                    }
                    -(pair.d_normal[k].dot(&d_base(l, a)) + pair.d_normal[l].dot(&d_base(k, a)) + normal.dot(&bent))
                });
                let up = inverse * down;
                (0..N).fold(Vector::<3>::zeros(), |sum, a| sum + base[a] * up[a])
            };
            let hessian = |k: usize, l: usize| {
                if exact {
                    let h = measures.coordinate_second_variation(&variations[k], &variations[l]);
                    (0..N).fold(Vector::<3>::zeros(), |sum, a| sum + d_base(l, a) * xi[k][a] + base[a] * h[a])
                } else {
                    let along = (0..N).fold(Vector::<3>::zeros(), |sum, a| sum + columns[k].d_a[a] * xi[l][a]);
                    let gap_turns = pair.d_normal[k] * (lever * pair.d_gap[l]) + normal_bend(k, l) * (lever * gap);
                    let [of_slave, of_master] = self.encounter.spin_variation(&columns[k], &columns[l]);
                    let moved = if N == 1 { columns[k].spin_slope * xi[l][0] } else { Vector::<3>::zeros() };
                    let spun = (of_slave * radii[0] + (of_master + moved) * radii[1]).cross(&normal);
                    along - self.encounter.levers(&columns[k], &pair.d_normal[l], radii) - spun - gap_turns
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
                (0..3).for_each(|i| self.encounter.add_bends(&axis(i), n, &mut parts[i]));
            }
            pair.second = SecondVariation::Full(parts);
        }
        pair.stuck = Some(Stuck {
            point: foot.point,
            on_slave: slave.frame.transpose() * normal,
            on_master: foot.frame.transpose() * normal,
        });
        (pair.elastic, pair.d_elastic) = match self.encounter.stuck {
            Some(anchor) if turns => self.rolled(anchor, pair),
            Some(anchor) => self.slid(anchor, exact, &foot_motion),
            None => (Vector::<3>::zeros(), vec![Vector::<3>::zeros(); n]),
        };
        pair.axis = self.encounter.axis(columns, foot.jet.u);
    }
}

impl<const N: usize> AtFoot<'_, N> {
    /// The slip since material points were in touch, without sections that turn: how far they are apart, or with an exact
    /// motion of the foot along the master how far that is from where it was.
    fn slid(
        &self,
        (_, anchor): (&Stuck, &Anchor),
        exact: bool,
        foot_motion: &dyn Fn(usize) -> Vector<3>,
    ) -> (Vector<3>, Vec<Vector<3>>) {
        let of_slave = self.encounter.slave_count();
        let from = if exact { self.foot.jet.x } else { self.encounter.slave.x };
        let of = |(k, c): (usize, &Column)| match (exact, k < of_slave) {
            // The material of the master at the foot moves by -δD of its own functions.
            (true, true) => foot_motion(k) - c.anchor,
            (true, false) => foot_motion(k) - c.d - c.anchor,
            (false, true) => c.d - c.anchor,
            (false, false) => -c.anchor,
        };
        (from - anchor.x, self.columns.iter().enumerate().map(of).collect())
    }

    /// The slip of sections that turn: how far the points of contact are apart, less their ways over both sections.
    fn rolled(&self, (stuck, anchor): (&Stuck, &Anchor), pair: &Pair) -> (Vector<3>, Vec<Vector<3>>) {
        let (slave, columns, [r_s, r_m]) = (self.encounter.slave, &self.columns, self.radii());
        let normal = Varied { value: self.normal, variation: pair.d_normal.clone() };
        let turned = |own: Vector<3>, spin: &dyn Fn(&Column) -> Vector<3>| Varied {
            value: own,
            variation: columns.iter().map(|c| spin(c).cross(&own)).collect(),
        };
        let on_slave = turned(slave.frame * stuck.on_slave, &|c| c.spin[0]);
        let on_master = turned(anchor.frame * stuck.on_master, &|c| c.anchor_spin);
        let spins: Vec<Vector<3>> = columns.iter().map(|c| c.spin[0]).collect();
        let against_slave = match slave.turn {
            Some(now) => {
                let turn = rotation::between(&self.encounter.since[0], &now);
                let before = rotation::turn(&-turn) * on_slave.value;
                ContactAxes { before, normal: &normal, turned: None }.against(&turn, &spins)
            }
            None => least_turn(&on_slave, &normal),
        };
        let around = |from: &Varied, psi: &Varied, radius: f64| {
            arc(&normal.less(from).times(radius), psi, &normal.times(radius))
        };
        let over_slave = around(&on_slave, &against_slave, r_s);
        let over_master = around(&on_master, &least_turn(&on_master, &normal), r_m);
        let apart = |k: usize| {
            let own = if k < self.encounter.slave_count() { columns[k].d } else { Vector::<3>::zeros() };
            own - columns[k].anchor - normal.variation[k] * (r_s + r_m)
        };
        let value = slave.x - anchor.x - normal.value * (r_s + r_m) + over_slave.value + over_master.value;
        let of = |k: usize| apart(k) + over_slave.variation[k] + over_master.variation[k];
        (value, (0..columns.len()).map(of).collect())
    }
}

impl AtRigid<'_> {
    /// The slip since the anchor: the way of the point of contact over the master, less that over a section of the given
    /// radius that turns. Variations are seen from the master.
    fn wandered(
        &self,
        (stuck, anchor): (&Stuck, &Anchor),
        pair: &Pair,
        radius: Option<f64>,
    ) -> (Vector<3>, Vec<Vector<3>>) {
        let (slave, columns, normal) = (self.encounter.slave, &self.columns, self.foot.jet.normal);
        let turning = anchor.turning.unwrap_or_default();
        let since = self.encounter.since;
        // In space, of what is seen from the master.
        let in_space = |value: Vector<3>, seen: &dyn Fn(usize) -> Vector<3>| Varied {
            value,
            variation: (0..columns.len()).map(|k| seen(k) + columns[k].turn.cross(&value)).collect(),
        };
        let contact_normal = in_space(normal, &|k| pair.d_normal[k]);
        let spun = |value: Vector<3>, spin: &dyn Fn(&Column) -> Vector<3>| Varied {
            value,
            variation: columns.iter().map(spin).collect(),
        };
        let master = spun(rotation::between(&since[1], &turning.turn), &|c| c.turn);
        let own = slave.turn.map(|now| spun(rotation::between(&since[0], &now), &|c| c.spin[0]));
        let axes = ContactAxes {
            before: rotation::turn(&-master.value) * turning.normal,
            normal: &contact_normal,
            turned: own.as_ref().map(|own| [own, &master]),
        };
        let point = slave.x - normal * radius.unwrap_or(self.foot.jet.gap);
        let moved = |k: usize| match radius {
            Some(radius) => columns[k].d - pair.d_normal[k] * radius,
            None => pair.slip[k],
        };
        let over_master = arc(
            &in_space(point - anchor.x, &moved),
            &axes.against(&master.value, &master.variation),
            &in_space(point - turning.about, &moved),
        );
        let radius = radius.unwrap_or(0.0);
        let over_slave = (radius != 0.0).then(|| {
            let before = slave.frame * stuck.on_slave;
            let before =
                Varied { value: before, variation: columns.iter().map(|c| c.spin[0].cross(&before)).collect() };
            let psi = match &own {
                Some(own) => axes.against(&own.value, &own.variation),
                None => least_turn(&before, &contact_normal),
            };
            arc(&contact_normal.less(&before).times(radius), &psi, &contact_normal.times(radius))
        });
        let way = over_slave.map_or(over_master.clone(), |over| over_master.plus(&over));
        let seen = |k: usize| way.variation[k] - columns[k].turn.cross(&way.value);
        (way.value, (0..columns.len()).map(seen).collect())
    }

    /// Adds slip to the measures of a pair that has its gap.
    pub fn add_slip(&self, order: Order, pair: &mut Pair) {
        let (slave, foot, columns) = (self.encounter.slave, self.foot, &self.columns);
        let (normal, hessian) = (foot.jet.normal, foot.jet.hessian);
        let (n, gap) = (columns.len(), pair.gap);
        let turns = !slave.spin.is_empty() || slave.turn.is_some();
        // Without a section that turns the ball about the slave point moves with the foot.
        let distance = if turns { gap } else { foot.jet.gap };
        let lever = if turns { slave.radius } else { 0.0 };
        let across = Matrix::<3>::identity() - normal * normal.transpose();
        let relative_spin = |c: &Column| c.spin[0] - c.spin[1];
        pair.slip = (columns.iter())
            .map(|c| across * c.d - hessian * c.d * distance - relative_spin(c).cross(&normal) * lever)
            .collect();
        let is_plain = self.is_plain();
        if order == Order::Second && !(is_plain && slave.bends.is_empty()) {
            let third = curvature_slopes(foot, distance, slave.x);
            let mut parts: [Vec<f64>; 3] = std::array::from_fn(|_| vec![0.0; n * n]);
            for k in (0..n).filter(|_| !is_plain) {
                let curved_k = hessian * columns[k].d;
                for l in 0..n {
                    let curved_l = hessian * columns[l].d;
                    let bent = self.bend(k, l);
                    let mut h = bent - hessian * bent * distance;
                    h -= curved_l * pair.d_gap[k] + curved_k * pair.d_gap[l];
                    h -= relative_spin(&columns[k]).cross(&curved_l) * lever;
                    // Spins, seen from the body.
                    let [of_slave, of_body] = self.encounter.spin_variation(&columns[k], &columns[l]);
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
                self.encounter.add_bends(&along, n, &mut parts[i]);
            }
            pair.second = SecondVariation::Full(parts);
        }
        pair.stuck = Some(Stuck {
            point: foot.point,
            on_slave: slave.frame.transpose() * normal,
            on_master: Vector::<3>::zeros(),
        });
        (pair.elastic, pair.d_elastic) = match self.encounter.stuck {
            Some(anchor) => self.wandered(anchor, pair, turns.then_some(lever)),
            None => (Vector::<3>::zeros(), vec![Vector::<3>::zeros(); n]),
        };
        pair.axis = self.encounter.axis(columns, any_tangent(&normal));
    }
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
