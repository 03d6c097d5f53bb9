//! From minimisers to an answer: names of features, uniqueness, continua.

use super::newton::Difference;
use super::query::Query;
use super::result::{ClosestPair, Foot, Projection, Uniqueness};
use super::search::{Candidate, Found};
use crate::feature::{Entity, Feature, FeatureKind};
use crate::patch::{Atlas, Chart, CurveChart, Piece, PointChart, Side, SurfaceChart};
use crate::scale::length;

/// Pieces that can say on which feature of the shape a local parameter lies.
pub trait Named<const M: usize> {
    fn feature(&self, s: &[f64; M]) -> Feature;
}

impl Named<0> for Piece<0, PointChart> {
    fn feature(&self, _: &[f64; 0]) -> Feature {
        Feature::POINT
    }
}

impl Named<1> for Piece<1, CurveChart> {
    fn feature(&self, s: &[f64; 1]) -> Feature {
        match side_at(&self.sides[0], s[0]) {
            Some(Side::Boundary(b) | Side::Collapsed(b)) => Feature::vertex(Entity::Border(b)),
            Some(Side::Crease(k)) => Feature::vertex(Entity::Crease(k)),
            _ => Feature::INTERIOR,
        }
    }
}

impl Named<2> for Piece<2, SurfaceChart> {
    fn feature(&self, s: &[f64; 2]) -> Feature {
        let sides = [side_at(&self.sides[0], s[0]), side_at(&self.sides[1], s[1])];
        for side in sides {
            match side {
                Some(Side::Collapsed(b)) => return Feature::vertex(Entity::Collapsed(b)),
                Some(Side::Pole) => return Feature { kind: FeatureKind::Interior, entity: Entity::Pole },
                _ => {}
            }
        }
        match sides {
            [Some(Side::Boundary(b)), Some(Side::Boundary(c))] => Feature::vertex(Entity::Corner(b.min(c), b.max(c))),
            [Some(Side::Crease(k)), Some(Side::Boundary(_) | Side::Crease(_))]
            | [Some(Side::Boundary(_)), Some(Side::Crease(k))] => Feature::vertex(Entity::CreaseEnd(k)),
            [Some(Side::Boundary(b)), _] | [_, Some(Side::Boundary(b))] => Feature::edge(b),
            [Some(Side::Crease(k)), _] | [_, Some(Side::Crease(k))] => {
                Feature { kind: FeatureKind::Edge, entity: Entity::Crease(k) }
            }
            _ => Feature::INTERIOR,
        }
    }
}

fn side_at(sides: &[Side; 2], s: f64) -> Option<Side> {
    if s == -1.0 {
        Some(sides[0])
    } else if s == 1.0 {
        Some(sides[1])
    } else {
        None
    }
}

/// Eigenvalues of the Hessian in the metric below which a direction counts as flat.
const FLAT: f64 = 1e-6;

pub fn projection<const A: usize, const B: usize, const N: usize, CA: Chart<A>, CB: Chart<B>>(
    a: &Atlas<A, CA>,
    b: &Atlas<B, CB>,
    query: &Query,
    size: f64,
    found: Found<A, B>,
) -> Projection
where
    Piece<A, CA>: Named<A>,
    Piece<B, CB>: Named<B>,
{
    let describe = |c: &Candidate<A, B>| describe::<A, B, N, CA, CB>(a, b, c);
    let apart =
        |p: &ClosestPair, q: &ClosestPair| length(&(p.a.point - q.a.point)).max(length(&(p.b.point - q.b.point)));
    // Where the Hessian is singular or undefined, rounding leaves the minimiser this uncertain.
    let same = |p: &ClosestPair, q: &ClosestPair| {
        let least = p.lambda_min.min(q.lambda_min);
        let radius = if least < 1e-3 {
            2e-2
        } else if p.lambda_min.is_nan() || q.lambda_min.is_nan() {
            1e-3
        } else {
            1e-6
        };
        apart(p, q) <= radius * size
    };
    let best = found.isolated.iter().chain(&found.degenerate).map(|c| c.distance).fold(f64::INFINITY, f64::min);
    let rounding = 1e-13 * (size + best);
    let tie = query.tie * size + rounding;

    // Samples of a degenerate minimum, as good as the best one to rounding, no two at the same place.
    let mut flat: Vec<(ClosestPair, usize)> = Vec::new();
    for c in found.degenerate.iter().filter(|c| c.distance <= best + rounding) {
        let (pair, flat_directions) = describe(c);
        if !flat.iter().any(|(p, _)| same(p, &pair)) {
            flat.push((pair, flat_directions));
        }
    }
    let mut pairs: Vec<ClosestPair> = Vec::new();
    for c in &found.isolated {
        let (pair, _) = describe(c);
        if !pairs.iter().chain(flat.iter().map(|(p, _)| p)).any(|p| same(p, &pair)) {
            pairs.push(pair);
        }
    }
    let dimension = flat.iter().map(|f| f.1).max().unwrap_or(0);
    let order = |p: &ClosestPair, q: &ClosestPair| {
        let key = |x: &ClosestPair| [x.a, x.b].map(|f| f.parameters().to_vec());
        key(p).partial_cmp(&key(q)).unwrap_or(std::cmp::Ordering::Equal)
    };
    let uniqueness;
    if found.intersecting {
        uniqueness = Uniqueness::Continuum { dimension: 1 };
        pairs.splice(0..0, flat.into_iter().map(|(p, _)| p));
    } else if flat.len() >= 3 && dimension > 0 {
        uniqueness = Uniqueness::Continuum { dimension };
        let mut samples: Vec<ClosestPair> = flat.into_iter().map(|(p, _)| p).collect();
        samples.sort_by(order);
        pairs.splice(0..0, samples);
    } else {
        pairs.splice(0..0, flat.into_iter().map(|(p, _)| p));
        pairs.sort_by(|p, q| p.distance.total_cmp(&q.distance));
        let ties = pairs.iter().filter(|p| p.distance <= pairs[0].distance + tie).count();
        uniqueness = match pairs[0].lambda_min {
            _ if ties > 1 => Uniqueness::Multiple,
            lambda if lambda > 0.0 && lambda < FLAT => Uniqueness::NearContinuum { lambda },
            _ => Uniqueness::Unique,
        };
    }
    let mut pairs = pairs.into_iter();
    let closest = pairs.next().expect("a minimiser over a compact domain");
    Projection {
        closest,
        uniqueness,
        others: pairs.collect(),
        certified_to: found.certified_to,
        margin: found.margin,
        effort: found.pairs,
        certificate: found.certificate,
    }
}

/// A candidate in the parameters of the shapes, with the number of flat directions.
pub fn describe<const A: usize, const B: usize, const N: usize, CA: Chart<A>, CB: Chart<B>>(
    a: &Atlas<A, CA>,
    b: &Atlas<B, CB>,
    c: &Candidate<A, B>,
) -> (ClosestPair, usize)
where
    Piece<A, CA>: Named<A>,
    Piece<B, CB>: Named<B>,
{
    let (piece_a, piece_b) = (&a.pieces[c.piece[0] as usize], &b.pieces[c.piece[1] as usize]);
    let z: [f64; N] = c.parameters();
    let at = Difference::<N>::new(&piece_a.chart, &piece_b.chart, &z);
    let free = std::array::from_fn(|k| {
        let sides = if k < A { &piece_a.sides[k] } else { &piece_b.sides[k - A] };
        side_at(sides, z[k]).is_none_or(Side::is_smooth)
    });
    let (eigenvalues, count) = at.eigenvalues(&free);
    let eigenvalues = &eigenvalues[..count];
    let flat = eigenvalues.iter().filter(|&&e| e.abs() < FLAT).count();
    let least = eigenvalues.iter().copied().fold(f64::INFINITY, f64::min);
    let lambda_min = if eigenvalues.iter().any(|e| e.is_nan()) { f64::NAN } else { least };
    let pair = ClosestPair {
        distance: c.distance,
        a: Foot::new(c.xa, piece_a.feature(&c.a), &piece_a.map.apply(&c.a)).on_piece(c.piece[0] as usize, &c.a),
        b: Foot::new(c.xb, piece_b.feature(&c.b), &piece_b.map.apply(&c.b)).on_piece(c.piece[1] as usize, &c.b),
        lambda_min,
    };
    (pair, flat)
}
