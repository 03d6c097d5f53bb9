//! On which side of a circle a path passes: the plane problem of a sphere or an infinite cylinder between two points.

use nalgebra::Vector2;

type V = Vector2<f64>;

/// What a program does with a line and a circle about zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Way {
    /// An end lies inside: the circle is not in the way.
    Inside,
    /// The line passes outside, on the wanted side.
    Straight,
    /// The line passes outside, but on the other side: the path is led around.
    OtherSide,
    /// Around the circle by the shorter way.
    Shorter,
    /// Around the circle by the longer way.
    Longer,
}

/// The way between two points, with a direction to the wanted side if there is one. Of the two pairs of tangents that is taken
/// whose points of tangency lie farther on that side.
pub(super) fn way(ends: [V; 2], radius: f64, side: Option<V>) -> Way {
    if ends.iter().any(|p| p.norm() < radius) {
        return Way::Inside;
    }
    let line = ends[1] - ends[0];
    let share = if line.norm() > 0.0 { (-ends[0].dot(&line) / line.norm_squared()).clamp(0.0, 1.0) } else { 0.0 };
    let nearest = ends[0] + line * share;
    if nearest.norm() > radius {
        return match side {
            Some(side) if side.dot(&nearest) < 0.0 => Way::OtherSide,
            _ => Way::Straight,
        };
    }
    let Some(side) = side else { return Way::Shorter };
    // The tangents from a point touch at an angle of acos(R/d) from its direction.
    let tangency = |p: &V, sign: f64| {
        let angle = p.y.atan2(p.x) + sign * (radius / p.norm()).acos();
        V::new(angle.cos(), angle.sin())
    };
    let pair = |sign: f64| [tangency(&ends[0], sign), tangency(&ends[1], -sign)];
    let far = |[a, b]: &[V; 2]| (a + b).try_normalize(1e-12).unwrap_or_else(V::zeros).dot(&side);
    let arc =
        |sign: f64, [a, b]: &[V; 2]| (sign * (a.x * b.y - a.y * b.x)).atan2(a.dot(b)).rem_euclid(std::f64::consts::TAU);
    let [left, right] = [pair(1.0), pair(-1.0)];
    let wanted_left = far(&left) >= far(&right);
    let shorter_left = arc(1.0, &left) <= arc(-1.0, &right);
    if wanted_left == shorter_left { Way::Shorter } else { Way::Longer }
}
