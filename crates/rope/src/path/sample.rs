//! Division of a path into elements by its length.

use super::{Path, PathError, array};
use crate::centreline::{Closure, Continuity};
use crate::hermite::gauss;
use signorini_geometry::bvh::Bvh;
use signorini_geometry::{Aabb, Point, Vector};

/// A path divided into elements.
#[derive(Clone, Debug)]
pub struct Sampled {
    /// Positions of the nodes; of a closed path the first one is not repeated.
    pub positions: Vec<Point<3>>,
    /// Unit tangents at the nodes.
    pub tangents: Vec<Vector<3>>,
    /// Length of the path along each element.
    pub lengths: Vec<f64>,
    pub closure: Closure,
    pub continuity: Continuity,
}

/// Gauss points of a part of the path: lengths of smooth curves to round-off.
const POINTS: usize = 8;
/// Parts into which each smooth piece is cut.
const PARTS: usize = 8;
/// Turns below this angle, in radians, are rounding of the input.
const STRAIGHT: f64 = 1e-6;

/// Length of the path as a function of its parameter.
struct Measured<'a> {
    path: &'a Path,
    rule: Vec<(f64, f64)>,
    parameters: Vec<f64>,
    lengths: Vec<f64>,
}

impl<'a> Measured<'a> {
    fn new(path: &'a Path) -> Self {
        let rule = gauss(POINTS);
        let mut parameters = vec![path.breaks[0]];
        for b in path.breaks.windows(2) {
            parameters.extend((1..=PARTS).map(|k| b[0] + (b[1] - b[0]) * k as f64 / PARTS as f64));
        }
        let mut out = Measured { path, rule, parameters, lengths: vec![0.0] };
        for k in 0..out.parameters.len() - 1 {
            let part = out.between(out.parameters[k], out.parameters[k + 1]);
            out.lengths.push(out.lengths[k] + part);
        }
        out
    }

    fn between(&self, from: f64, to: f64) -> f64 {
        self.rule.iter().map(|(x, w)| w * (to - from) * self.path.curve.jet(from + x * (to - from)).d1.norm()).sum()
    }

    fn total(&self) -> f64 {
        self.lengths[self.lengths.len() - 1]
    }

    /// The parameter up to which the path has a given length.
    fn parameter(&self, length: f64) -> f64 {
        let k = self.lengths.partition_point(|l| *l <= length).clamp(1, self.lengths.len() - 1) - 1;
        let (from, to) = (self.parameters[k], self.parameters[k + 1]);
        let wanted = length - self.lengths[k];
        let (mut low, mut high) = (from, to);
        let mut t = from + (to - from) * wanted / (self.lengths[k + 1] - self.lengths[k]);
        // Newton's method, kept between bounds that shrink.
        for _ in 0..60 {
            let error = self.between(from, t) - wanted;
            if error.abs() <= 4.0 * f64::EPSILON * self.total() {
                break;
            }
            if error > 0.0 {
                high = t
            } else {
                low = t
            }
            let next = t - error / self.path.curve.jet(t).d1.norm();
            t = if next > low && next < high { next } else { 0.5 * (low + high) };
        }
        t
    }
}

impl Path {
    /// Length of the path.
    pub fn length(&self) -> f64 {
        Measured::new(self).total()
    }

    pub fn closure(&self) -> Closure {
        self.closure
    }

    /// Turns of the tangent between smooth pieces, with their parameters and angles.
    fn kinks(&self) -> Vec<(f64, f64)> {
        let n = self.breaks.len();
        let size = self.breaks[1] - self.breaks[0];
        let near = 1e-9 * size;
        let interior = self.breaks[1..n - 1].iter().map(|&b| (b - near, b + near, b));
        let seam = (self.closure == Closure::Closed)
            .then(|| (self.breaks[n - 1] - near, self.breaks[0] + near, self.breaks[0]));
        (interior.chain(seam))
            .filter_map(|(before, after, at)| {
                let (p, q) = (self.curve.jet(before).d1, self.curve.jet(after).d1);
                let angle = p.cross(&q).norm().atan2(p.dot(&q));
                (angle > STRAIGHT).then_some((at, angle))
            })
            .collect()
    }

    /// Divides the path into so many elements: of equal length where a smooth curve is wanted, and of about equal length
    /// with a node at each kink where straight ones are.
    ///
    /// # Errors
    /// Kinks of what is to be smooth, too few elements, a path that crosses itself.
    pub fn sample(&self, cells: usize, continuity: Continuity) -> Result<Sampled, PathError> {
        let kinks = self.kinks();
        let measured = Measured::new(self);
        let needed = if self.closure == Closure::Closed { 3 } else { 1 };
        let total = measured.total();
        let mut at: Vec<f64> = Vec::new();
        match continuity {
            Continuity::C1 => {
                if let Some((t, angle)) = kinks.first() {
                    let at = array(&self.curve.position(*t));
                    return Err(PathError::Kink { at, degrees: angle.to_degrees() });
                }
                if cells < needed {
                    return Err(PathError::TooFewCells { given: cells, needed });
                }
                at.extend((0..=cells).map(|k| total * k as f64 / cells as f64));
            }
            Continuity::C0 => {
                let first = self.breaks[0];
                let mut stops: Vec<f64> =
                    kinks.iter().filter(|k| k.0 > first).map(|k| measured.between_breaks(k.0)).collect();
                stops.insert(0, 0.0);
                stops.push(total);
                let needed = needed.max(stops.len() - 1);
                if cells < needed {
                    return Err(PathError::TooFewCells { given: cells, needed });
                }
                let spans: Vec<f64> = stops.windows(2).map(|s| s[1] - s[0]).collect();
                for (k, count) in apportion(&spans, cells).into_iter().enumerate() {
                    at.extend((0..count).map(|j| stops[k] + spans[k] * j as f64 / count as f64));
                }
                at.push(total);
            }
        }
        let jets: Vec<_> = at.iter().map(|&s| self.curve.jet(measured.parameter(s))).collect();
        let nodes = if self.closure == Closure::Closed { cells } else { cells + 1 };
        let sampled = Sampled {
            positions: jets[..nodes].iter().map(|j| j.x).collect(),
            tangents: jets[..nodes].iter().map(|j| j.d1.normalize()).collect(),
            lengths: at.windows(2).map(|s| s[1] - s[0]).collect(),
            closure: self.closure,
            continuity,
        };
        sampled.check_crossings(total)?;
        Ok(sampled)
    }
}

impl Measured<'_> {
    fn between_breaks(&self, parameter: f64) -> f64 {
        let k = self.parameters.partition_point(|p| *p < parameter - 1e-12 * parameter.abs());
        self.lengths[k.min(self.lengths.len() - 1)]
    }
}

/// Numbers of elements of spans, at least one each, that make the longest element short.
fn apportion(spans: &[f64], cells: usize) -> Vec<usize> {
    let mut counts = vec![1; spans.len()];
    for _ in spans.len()..cells {
        let longest = (0..spans.len())
            .max_by(|&i, &j| (spans[i] / counts[i] as f64).total_cmp(&(spans[j] / counts[j] as f64)).then(j.cmp(&i)));
        counts[longest.unwrap_or(0)] += 1;
    }
    counts
}

impl Sampled {
    /// Straight chords that are no neighbours must not meet.
    fn check_crossings(&self, total: f64) -> Result<(), PathError> {
        let n = self.lengths.len();
        let end = |e: usize| self.positions[(e + 1) % self.positions.len()];
        let boxes: Vec<Aabb<3>> =
            (0..n).map(|e| Aabb::new(self.positions[e].inf(&end(e)), self.positions[e].sup(&end(e)))).collect();
        let tree = Bvh::new(&boxes);
        // Nearer than rounding of the positions.
        let touch = 1e-9 * total;
        for (i, j) in tree.pairs_within(&tree, (&boxes, &boxes), touch) {
            let are_neighbours = i + 1 == j || (self.closure == Closure::Closed && i == 0 && j == n - 1);
            if i >= j || are_neighbours {
                continue;
            }
            let (s, t, distance) = segments([self.positions[i], end(i)], [self.positions[j], end(j)]);
            // An open path may end where it started, as a loop does.
            let meets_ends = self.closure == Closure::Open && i == 0 && j == n - 1 && s == 0.0 && t == 1.0;
            if distance <= touch && !meets_ends {
                let arc = |e: usize, x: f64| self.lengths[..e].iter().sum::<f64>() + x * self.lengths[e];
                let at = self.positions[i] + (end(i) - self.positions[i]) * s;
                return Err(PathError::CrossesItself { at: array(&at), first: arc(i, s), second: arc(j, t) });
            }
        }
        Ok(())
    }
}

/// Closest parameters of two segments and their distance (Ericson 2005, 5.1.9).
pub(crate) fn segments(a: [Point<3>; 2], b: [Point<3>; 2]) -> (f64, f64, f64) {
    let (u, v, w) = (a[1] - a[0], b[1] - b[0], a[0] - b[0]);
    let (uu, uv, vv, uw, vw) = (u.dot(&u), u.dot(&v), v.dot(&v), u.dot(&w), v.dot(&w));
    let determinant = uu * vv - uv * uv;
    let clamp = |x: f64| if x.is_nan() { 0.0 } else { x.clamp(0.0, 1.0) };
    let mut s = if determinant > 1e-14 * uu * vv { clamp((uv * vw - uw * vv) / determinant) } else { 0.0 };
    let mut t = (uv * s + vw) / vv;
    if t.is_nan() {
        t = 0.0;
    }
    if !(0.0..=1.0).contains(&t) {
        t = clamp(t);
        s = clamp((uv * t - uw) / uu);
    }
    (s, t, (w + u * s - v * t).norm())
}
