//! Points on bodies, four times as dense along each direction as the cells that show them where something is near.

use crate::nearest::{extent, mean};
use crate::state::{Curve, Form, Placement, Rigid, Solid};
use rayon::prelude::*;
use signorini_geometry::{Aabb, Point};

/// A point of a body, or a ball about it.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    pub x: Point<3>,
    /// Where it was before anything moved.
    pub rest: Point<3>,
    pub radius: f64,
    /// Size of the cell of the solver that it lies in, and of the part of it that is shown.
    pub cell: f64,
    pub part: f64,
    /// How far the body may lie off what is shown.
    pub off: f64,
}

/// Parts of each side of a facet.
const DENSE: usize = 4;
/// Share of the size of a rigid body that counts as its cell: contact between rigid bodies is exact but for a part of it.
pub const OF_RIGID: f64 = 0.1;

/// The points of a body. `at_least` tells a distance that nothing that may be touched is nearer than.
pub fn of_body(
    form: &Form,
    placement: &Placement,
    rigid_too: bool,
    at_least: &(dyn Fn(&Point<3>) -> f64 + Sync),
) -> Vec<Sample> {
    match form {
        Form::Solid(solid) => of_solid(solid, placement.points(), at_least),
        Form::Curve(curve) => of_curve(curve, placement.points()),
        Form::Rigid(rigid) => of_rigid(rigid, placement, rigid_too),
    }
}

fn of_solid(solid: &Solid, points: &[Point<3>], at_least: &(dyn Fn(&Point<3>) -> f64 + Sync)) -> Vec<Sample> {
    let boundary = &solid.boundary;
    let mut near = vec![f64::INFINITY; points.len()];
    let found: Vec<f64> = boundary.points.par_iter().map(|k| at_least(&points[*k as usize])).collect();
    boundary.points.iter().zip(found).for_each(|(k, gap)| near[*k as usize] = gap);
    let mut out = Vec::new();
    for (k, (facet, turn)) in boundary.facets.iter().zip(&boundary.turn).enumerate() {
        let size = extent(points, facet);
        if facet.iter().all(|k| near[*k as usize] > size) {
            continue;
        }
        let [cell, part] = solid.cell_at(k);
        for shares in lattice(facet.len()) {
            let at = |list: &[Point<3>]| facet.iter().zip(&shares).map(|(k, s)| list[*k as usize] * *s).sum();
            let (x, rest) = (at(points), at(&solid.rest));
            out.push(Sample { x, rest, radius: 0.0, cell, part, off: size * turn / 8.0 });
        }
    }
    out
}

/// Shares of the corners of a facet at points spread over it, corners among them.
fn lattice(corners: usize) -> Vec<Vec<f64>> {
    let share = |k: usize| k as f64 / DENSE as f64;
    let all = || (0..=DENSE).flat_map(|i| (0..=DENSE).map(move |j| (i, j)));
    match corners {
        2 => (0..=DENSE).map(|i| vec![1.0 - share(i), share(i)]).collect(),
        3 => (all().filter(|(i, j)| i + j <= DENSE))
            .map(|(i, j)| vec![1.0 - share(i) - share(j), share(i), share(j)])
            .collect(),
        _ => all()
            .map(|(i, j)| {
                let (s, t) = (share(i), share(j));
                vec![(1.0 - s) * (1.0 - t), s * (1.0 - t), s * t, (1.0 - s) * t]
            })
            .collect(),
    }
}

fn of_curve(curve: &Curve, points: &[Point<3>]) -> Vec<Sample> {
    let turn = turns(curve, points);
    let sample = |piece: &[u32; 2]| {
        let part = (points[piece[1] as usize] - points[piece[0] as usize]).norm();
        let off = part * turn[piece[0] as usize].max(turn[piece[1] as usize]) / 8.0;
        let [from, to] = piece.map(|k| k as usize);
        (0..=DENSE).map(move |k| {
            let s = k as f64 / DENSE as f64;
            let at = |list: &[Point<3>]| list[from] * (1.0 - s) + list[to] * s;
            Sample { x: at(points), rest: at(&curve.rest), radius: curve.radius, cell: part * curve.parts, part, off }
        })
    };
    curve.pieces.iter().flat_map(sample).collect()
}

/// The angle between the pieces that meet at each point of a curve.
pub fn turns(curve: &Curve, points: &[Point<3>]) -> Vec<f64> {
    let mut out = vec![0.0f64; points.len()];
    let direction = |p: &[u32; 2]| (points[p[1] as usize] - points[p[0] as usize]).try_normalize(0.0);
    let closing = curve.pieces.last().zip(curve.pieces.first()).map(|(a, b)| [*a, *b]);
    let pairs = curve.pieces.windows(2).map(|w| [w[0], w[1]]).chain(closing);
    for [a, b] in pairs.filter(|[a, b]| a[1] == b[0]) {
        if let (Some(d), Some(e)) = (direction(&a), direction(&b)) {
            out[a[1] as usize] = d.dot(&e).clamp(-1.0, 1.0).acos();
        }
    }
    out
}

fn of_rigid(rigid: &Rigid, placement: &Placement, balls: bool) -> Vec<Sample> {
    let motion = placement.motion();
    let cell = OF_RIGID * rigid.size;
    let sample = |rest: &Point<3>, radius: f64| Sample {
        x: motion.point(rest),
        rest: *rest,
        radius,
        cell,
        part: cell,
        off: 0.0,
    };
    if balls && !rigid.balls.is_empty() {
        return rigid.balls.iter().map(|(x, radius)| sample(x, *radius)).collect();
    }
    rigid.surface.iter().map(|x| sample(x, 0.0)).collect()
}

/// The smallest extent of a solid along the axes.
pub fn thickness(points: &[Point<3>], directions: &[usize]) -> f64 {
    let size = Aabb::around(points.iter().copied()).map_or(Point::<3>::zeros(), |bounds| bounds.size());
    directions.iter().map(|i| size[*i]).fold(f64::INFINITY, f64::min)
}

/// The middle of all points of a body.
pub fn middle(form: &Form, placement: &Placement) -> Point<3> {
    match form {
        Form::Rigid(rigid) => placement.motion().point(&rigid.centre),
        _ => mean(placement.points()),
    }
}
