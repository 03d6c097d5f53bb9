//! How the point of contact wanders over a side since the anchor: along the arc, not the chord.
//!
//! In the axes of a side the point of contact has come by the chord `c`, and the axes of contact (the normal, and what is
//! across it) have turned by `ψ` against the side. The path between is taken for that of a uniform screw, of which both are
//! the result: in the axes of contact as they are now its velocity is `V^-1 c` with `V = ∫ exp(-tψ) dt` over `t` from 0 to 1,
//! the translation of the logarithm of a rigid motion. Whole turns add their angle times the distance to the axis. That is
//! exact where a surface of revolution turns about its axis, by any angle, where a ball or a cylinder rolls, and on planes;
//! elsewhere it is of third order in `ψ`.
//!
//! The axes of contact turn as little as the normal does; where both sides spin about the normal they spin with the slower.

use crate::rotation;
use signorini_geometry::Vector;

type V = Vector<3>;

/// A vector and its variations, unknown by unknown.
#[derive(Clone, Debug)]
pub(super) struct Varied {
    pub value: V,
    pub variation: Vec<V>,
}

impl Varied {
    pub fn less(&self, other: &Varied) -> Varied {
        let variation = self.variation.iter().zip(&other.variation).map(|(a, b)| a - b).collect();
        Varied { value: self.value - other.value, variation }
    }

    pub fn plus(&self, other: &Varied) -> Varied {
        self.less(&other.times(-1.0))
    }

    pub fn times(&self, factor: f64) -> Varied {
        Varied { value: self.value * factor, variation: self.variation.iter().map(|v| v * factor).collect() }
    }
}

/// How the axes of contact have turned since the last state, and their spins.
pub(super) struct ContactAxes<'a> {
    /// The normal then and now.
    pub before: V,
    pub normal: &'a Varied,
    /// The turn of both sides about any axis, where both are known, with their spins.
    pub turned: Option<[&'a Varied; 2]>,
}

impl ContactAxes<'_> {
    /// The rotation vector of each side's axes of contact against the side, which turned by `side` with the spins `spins`.
    pub fn against(&self, side: &V, spins: &[V]) -> Varied {
        let (normal, d_normal) = (self.normal.value, &self.normal.variation);
        let still = Varied { value: self.before, variation: vec![V::zeros(); d_normal.len()] };
        let swung = least_turn(&still, self.normal);
        // The common part of the spins about the normal.
        let common = self.turned.and_then(|both| {
            let about = both.map(|t| t.value.dot(&normal));
            let k = usize::from(about[1].abs() < about[0].abs());
            (about[0] * about[1] > 0.0).then_some((about[k], both[k]))
        });
        let about = common.map_or(0.0, |(sigma, _)| sigma);
        let spun = rotation::turn(&(normal * about));
        let whole = spun * rotation::turn(&swung.value) * rotation::turn(side).inverse();
        let value = rotation::unwrapped(&whole, &(swung.value + normal * about - side));
        let (of_spin, carried) = (rotation::of_spin(&value), rotation::turn(&value));
        let [swing, twist] = [swung.value, normal * about].map(|psi| rotation::spin(&psi));
        let variation = (0..d_normal.len())
            .map(|k| {
                let more = common.map_or(0.0, |(_, turn)| {
                    let change = rotation::of_spin(&turn.value) * turn.variation[k];
                    change.dot(&normal) + turn.value.dot(&d_normal[k])
                });
                let own = twist * (normal * more + d_normal[k] * about) + spun * (swing * swung.variation[k]);
                of_spin * (own - carried * spins[k])
            })
            .collect();
        Varied { value, variation }
    }
}

/// The rotation vector of the least turn from one unit vector to another.
pub(super) fn least_turn(from: &Varied, to: &Varied) -> Varied {
    let (a, b) = (from.value, to.value);
    let (across, cosine) = (a.cross(&b), a.dot(&b));
    let sine = across.norm();
    let angle = sine.atan2(cosine);
    // The angle over its sine, and how that changes with the cosine.
    let (ratio, slope) = if sine < 1e-4 && cosine > 0.0 {
        let square = angle * angle;
        (1.0 + square / 6.0, -1.0 / 3.0 - 2.0 * square / 15.0)
    } else {
        let sine = sine.max(f64::MIN_POSITIVE.sqrt());
        (angle / sine, (angle * cosine / sine - 1.0) / (sine * sine))
    };
    let of = |(da, db): (&V, &V)| across * (slope * (da.dot(&b) + a.dot(db))) + (da.cross(&b) + a.cross(db)) * ratio;
    Varied { value: across * ratio, variation: from.variation.iter().zip(&to.variation).map(of).collect() }
}

/// The way of the point of contact along a side: by the chord, the turn of the axes of contact against the side, and the
/// arm from the point about which the side turns.
pub(super) fn arc(chord: &Varied, psi: &Varied, arm: &Varied) -> Varied {
    let turns = rotation::whole_turns(&psi.value);
    let rest = turns - psi.value;
    let straight = rotation::of_spin(&rest);
    let (axis, share) = match psi.value.try_normalize(0.0).filter(|_| turns != V::zeros()) {
        Some(axis) => (axis, turns.norm() / psi.value.norm()),
        None => (V::zeros(), 0.0),
    };
    let of = |k: usize| {
        let d_psi = psi.variation[k];
        // Whole turns change with their axis only.
        let d_turns = (d_psi - axis * axis.dot(&d_psi)) * share;
        let bent = rotation::of_spin_change(&rest, &(d_turns - d_psi), &chord.value);
        straight * chord.variation[k] + bent + d_turns.cross(&arm.value) + turns.cross(&arm.variation[k])
    };
    let value = straight * chord.value + turns.cross(&arm.value);
    Varied { value, variation: (0..psi.variation.len()).map(of).collect() }
}
