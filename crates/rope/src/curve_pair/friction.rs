//! Friction between curves: along the axis of the slave and around it.
//!
//! The slip since material points touched, `e`, has the trial `t_α = λ_α + ε E_α·e` along `E_1 = τ` and `E_2 = n × τ`; a law
//! returns it to the admissible `T_α`. Forces are `T·S_k` with the variations `S_k` of the slip, and their derivative
//! `S_k·dT + T·dS_k`, with `dT = Σ dT_α E_α + T_α dE_α` and `dT_α = ∂T_α/∂t_β ε (dE_β·e + E_β·de) + ∂T_α/∂p dp`. Points that
//! touched are kept as material points, of both curves and of both sections: the slip does not depend on motions of both
//! together, and passes from element to element. After slip the point on the master follows, so that `ε e = T`.

use super::measure::{CurvePair, Stuck};
use nalgebra::SMatrix;
use signorini_contact::law::{Law, LawPoint, Status};
use signorini_geometry::Vector;
use signorini_mechanics::body::{Foot, Order};

/// A law, the multiplier along both axes, the force per slip that stands for sticking, and the time of the increment.
#[derive(Clone, Copy, Debug)]
pub struct CurveFriction<'a> {
    pub law: &'a dyn Law,
    pub multiplier: [f64; 2],
    pub penalty: f64,
    pub duration: f64,
}

/// Slip since points touched, with variations.
pub type ElasticSlip = (Vector<3>, Vec<u32>, Vec<Vector<3>>);

/// Friction of a contact.
#[derive(Clone, Debug)]
pub struct Tangential {
    /// Those of the pair, then those of the points that touched.
    pub unknowns: Vec<u32>,
    /// Of the unknowns of the pair.
    pub forces: Vec<f64>,
    /// Row by row, of all unknowns; the rows of the points that touched are zero.
    pub tangent: Vec<f64>,
    /// Along the axis of the slave and around it; conjugate to the slip of the slave, so that what acts on it is opposite.
    pub components: [f64; 2],
    /// What the law made them from, and its variations.
    pub trial: [f64; 2],
    pub d_trial: Vec<[f64; 2]>,
    /// The part of the slip since points touched that cannot come back.
    pub slipped: [f64; 2],
    pub status: Status,
}

/// Where a law is linearised.
#[derive(Clone, Copy, Debug)]
pub enum Linearised {
    /// At the trial itself, for forces that are told.
    Here,
    /// The same in the first linear system of a contact, of which no force turns with the axes yet.
    New,
    /// At the pressing force and the trial that the step before predicts: what it predicts to stick sticks in the linear
    /// system, and what turns with the axes is the friction that it predicts.
    About([f64; 3]),
}

/// Friction under a pressing force, whose variations are those of the unknowns of the pair.
pub fn tangential(
    pair: &CurvePair,
    slip: &ElasticSlip,
    (pressing, d_pressing): (f64, &[f64]),
    friction: CurveFriction<'_>,
    linearised: Linearised,
    order: Order,
) -> Tangential {
    let (e, slip_unknowns, d_e) = slip;
    let axes = [pair.axial, pair.circumferential()];
    let trial: [f64; 2] = std::array::from_fn(|a| friction.multiplier[a] + friction.penalty * axes[a].dot(e));
    let now = [pressing, trial[0], trial[1]];
    let about = match linearised {
        Linearised::About(about) => about,
        _ => now,
    };
    let projected = friction
        .law
        .traction(about, &LawPoint { per_gap: friction.penalty, duration: friction.duration, ..LawPoint::default() });
    let d = &projected.derivative;
    let predicted = [projected.traction[1], projected.traction[2]];
    let components: [f64; 2] =
        std::array::from_fn(|a| predicted[a] + (0..3).map(|b| d[1 + a][b] * (now[b] - about[b])).sum::<f64>());
    let turning = match linearised {
        Linearised::New => [0.0; 2],
        _ => predicted,
    };
    let traction = axes[0] * components[0] + axes[1] * components[1];
    let turns = axes[0] * turning[0] + axes[1] * turning[1];
    let n = pair.unknowns.len();
    let mut unknowns = pair.unknowns.clone();
    unknowns.extend(slip_unknowns);
    let m = unknowns.len();
    let zero = Vector::<3>::zeros();
    let forces = pair.slip.iter().map(|s| traction.dot(s)).collect();
    let d_axes = |l: usize| {
        let d_second = pair.d_normal[l].cross(&axes[0]) + pair.normal.cross(&pair.d_axial[l]);
        [pair.d_axial[l], d_second]
    };
    let d_trial: Vec<[f64; 2]> = (0..m)
        .map(|l| match l < n {
            true => d_axes(l).map(|d| friction.penalty * d.dot(e)),
            false => axes.map(|axis| friction.penalty * axis.dot(&d_e[l - n])),
        })
        .collect();
    let mut tangent = Vec::new();
    if order == Order::Second {
        tangent = vec![0.0; m * m];
        let d_traction: Vec<Vector<3>> = (0..m)
            .map(|l| {
                let (d_pressure, turned) = match l < n {
                    true => (d_pressing[l], d_axes(l)),
                    false => (0.0, [zero; 2]),
                };
                (0..2).fold(zero, |sum, a| {
                    let change = d[1 + a][0] * d_pressure + d[1 + a][1] * d_trial[l][0] + d[1 + a][2] * d_trial[l][1];
                    sum + axes[a] * change + turned[a] * turning[a]
                })
            })
            .collect();
        for k in 0..n {
            for l in 0..m {
                let own = if l < n { pair.slip_hessian(&turns, k, l) } else { 0.0 };
                tangent[k * m + l] = pair.slip[k].dot(&d_traction[l]) + own;
            }
        }
    }
    let slipped = std::array::from_fn(|a| (trial[a] - components[a]) / friction.penalty);
    Tangential { unknowns, forces, tangent, components, trial, d_trial, slipped, status: projected.status }
}

/// Singular values of two tangents, relative to the largest, below which they are one direction.
const ONE_DIRECTION: f64 = 1e-3;

/// The points that count as having touched after slip, so far apart that the slip is that of the traction: along the
/// master and about the axis of a section that turns, and along both curves where none does. `feet` are those that touch.
pub fn followed(pair: &CurvePair, feet: [&Foot; 2], components: [f64; 2], penalty: f64) -> Stuck {
    let back = (pair.axial * components[0] + pair.circumferential() * components[1]) / penalty;
    let mut stuck = pair.stuck;
    let lengths = feet.map(|f| f.jet.u.norm());
    let tangents = [0, 1].map(|s| feet[s].jet.u / lengths[s]);
    let Some(side) = [1, 0].into_iter().find(|s| !feet[*s].spin.is_empty() && feet[*s].radius > 0.0) else {
        let both = SMatrix::<f64, 3, 2>::from_columns(&[tangents[0], -tangents[1]]);
        let moved = both.svd(true, true).solve(&back, ONE_DIRECTION).unwrap_or_default();
        (0..2).for_each(|s| stuck.points[s].xi[0] += moved[s] / lengths[s]);
        return stuck;
    };
    stuck.points[1].xi[0] -= back.dot(&tangents[1]) / lengths[1];
    // A turn of the direction in which the section touches.
    let around = tangents[1].cross(&pair.normal);
    let (outward, sign) = if side == 1 { (pair.normal, -1.0) } else { (-pair.normal, 1.0) };
    let angle = sign * back.dot(&around) / feet[side].radius;
    stuck.directions[side] = feet[side].frame.transpose() * (outward * angle.cos() + around * angle.sin());
    stuck
}
