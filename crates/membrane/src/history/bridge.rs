//! The narrowest places between parts of zones.

use crate::zone::Zone;
use signorini_geometry::Point;

/// Two parts that have come near each other: the tips.
#[derive(Clone, Debug)]
pub struct Bridge<const D: usize> {
    pub tips: [Point<D>; 2],
}

impl<const D: usize> Bridge<D> {
    pub fn middle(&self) -> Point<D> {
        (self.tips[0] + self.tips[1]) * 0.5
    }

    pub fn length(&self) -> f64 {
        (self.tips[0] - self.tips[1]).norm()
    }

    pub fn along(&self) -> Point<D> {
        (self.tips[1] - self.tips[0]) / self.length()
    }

    /// The same bridge in another state of the zones, in which it may be up to about twice as long.
    pub fn between<Z: Zone<D>>(&self, zone: &Z) -> Option<Self> {
        beside(zone, &self.middle(), &turned(&self.along()), self.length())
    }

    /// The narrowest place of the neck of a zone where this bridge was.
    pub fn neck<Z: Zone<D>>(&self, zone: &Z) -> Option<Self> {
        beside(zone, &self.middle(), &self.along(), self.length())
    }
}

/// A direction turned to the left by a right angle.
pub fn turned<const D: usize>(d: &Point<D>) -> Point<D> {
    Point::from_fn(|k, _| if k == 0 { -d[D - 1] } else { d[0] })
}

/// The nearest points of the pieces of outlines on the two sides of a line, near a point of it.
fn beside<const D: usize, Z: Zone<D>>(zone: &Z, middle: &Point<D>, line: &Point<D>, length: f64) -> Option<Bridge<D>> {
    let across = turned(line);
    let mut sides: [Vec<Vec<Point<D>>>; 2] = Default::default();
    for outline in zone.outlines() {
        let mut last = None;
        for p in outline {
            let from = p - middle;
            let near = from.dot(line).abs() <= length && from.norm() <= 2.0 * length;
            let side = near.then(|| usize::from(from.dot(&across) > 0.0));
            if let Some(k) = side {
                if last != side {
                    sides[k].push(Vec::new());
                }
                if let Some(piece) = sides[k].last_mut() {
                    piece.push(p);
                }
            }
            last = side;
        }
    }
    nearest(&sides[0], &sides[1])
}

/// The nearest points of two sets of outlines.
pub fn nearest<const D: usize>(a: &[Vec<Point<D>>], b: &[Vec<Point<D>>]) -> Option<Bridge<D>> {
    let mut best: Option<(f64, Bridge<D>)> = None;
    for (points, others, swapped) in [(a, b, false), (b, a, true)] {
        for p in points.iter().flatten() {
            for ends in others.iter().flat_map(|o| o.windows(2)) {
                let d = ends[1] - ends[0];
                let s = ((p - ends[0]).dot(&d) / d.norm_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
                let q = ends[0] + d * s;
                let square = (p - q).norm_squared();
                if best.as_ref().is_none_or(|(least, _)| square < *least) {
                    best = Some((square, Bridge { tips: if swapped { [q, *p] } else { [*p, q] } }));
                }
            }
        }
    }
    best.map(|(_, bridge)| bridge)
}
