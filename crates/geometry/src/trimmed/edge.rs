//! Edges of faces, and where they run in the parameters of a face.

use super::face_surface::FaceSurface;
use crate::shape::{Curve, CurveJet};
use crate::{Point, Vector};

/// The use of an edge by a face.
#[derive(Clone, Debug)]
pub(super) struct FaceUse {
    pub edge: usize,
    /// Whether the loop runs as the curve does.
    pub forward: bool,
    pub of_loop: usize,
    /// Whether the face is on both sides of the edge.
    pub is_seam: bool,
    /// Parameters of the edge, ascending, and of the face there, without jumps at periods.
    pub samples: Vec<(f64, [f64; 2])>,
}

impl FaceUse {
    /// Parameters of the face near those of a point of the edge.
    pub fn near(&self, t: f64) -> [f64; 2] {
        let last = self.samples.len() - 1;
        let k = self.samples.partition_point(|s| s.0 <= t).clamp(1, last) - 1;
        let ((a, p), (b, q)) = (self.samples[k], self.samples[k + 1]);
        let share = if b > a { ((t - a) / (b - a)).clamp(0.0, 1.0) } else { 0.0 };
        [0, 1].map(|i| p[i] + share * (q[i] - p[i]))
    }

    /// The tangent in the direction of the loop.
    pub fn along(&self, jet: &CurveJet) -> Vector<3> {
        if self.forward { jet.d1 } else { -jet.d1 }
    }
}

/// Samples of an edge on a face.
pub(super) struct Samples {
    pub list: Vec<(f64, [f64; 2])>,
    /// The largest distance of a point of the edge from the chord of two samples, in scaled parameters.
    pub deviation: f64,
    /// The largest distance of the edge from the surface, and where.
    pub gap: (f64, Point<3>),
}

/// Parts of a smooth part of a curve that are looked at one by one, so that none is taken for straight by chance.
const PARTS: usize = 4;
/// How often one is halved: near poles parameters turn faster than any chord can follow.
const HALVINGS: u32 = 20;

/// Where an edge runs on a surface, by chords that are within `tolerance` of it in parameters that are scaled.
pub(super) fn sample(surface: &FaceSurface, curve: &Curve, scale: [f64; 2], tolerance: f64) -> Samples {
    let mut out = Samples { list: Vec::new(), deviation: 0.0, gap: (0.0, Point::<3>::zeros()) };
    let periods = surface.periods();
    let at = |t: f64, near: Option<[f64; 2]>, gap: &mut (f64, Point<3>)| {
        let x = curve.position(t);
        let mut z = surface.parameters(&x, near);
        let off = (surface.position(z) - x).norm();
        if off > gap.0 {
            *gap = (off, x);
        }
        if let Some(near) = near {
            if surface.is_singular(z) {
                z[0] = near[0];
            }
            for k in 0..2 {
                if let Some(p) = periods[k] {
                    z[k] -= p * ((z[k] - near[k]) / p).round();
                }
            }
        }
        z
    };
    let mut breaks: Vec<f64> = Vec::new();
    for piece in &curve.atlas.pieces {
        let interval = piece.map.interval(0);
        let step = (interval.to - interval.from) / PARTS as f64;
        breaks.extend((0..PARTS).map(|k| interval.from + step * k as f64));
    }
    breaks.push(curve.domain()[1]);
    let mut first = at(breaks[0], None, &mut out.gap);
    if surface.is_singular(first) {
        let inside = at(breaks[0] + 0.5 * (breaks[1] - breaks[0]), None, &mut out.gap);
        first[0] = inside[0];
    }
    out.list.push((breaks[0], first));
    for w in breaks.windows(2) {
        // Halves that are still to do, the first on top.
        let mut stack = vec![(w[1], HALVINGS)];
        while let Some((to, left)) = stack.pop() {
            let (from, z) = *out.list.last().expect("the first sample is there");
            let middle = 0.5 * (from + to);
            let half = at(middle, Some(z), &mut out.gap);
            let end = at(to, Some(half), &mut out.gap);
            let scaled = |k: usize, x: f64| x * scale[k];
            let off = [0, 1].map(|k| scaled(k, half[k] - 0.5 * (z[k] + end[k])));
            let deviation = off[0].hypot(off[1]);
            let leaps = (0..2).any(|k| periods[k].is_some_and(|p| (end[k] - z[k]).abs() > 0.25 * p));
            if left > 0 && (deviation > tolerance || leaps) {
                stack.push((to, left - 1));
                stack.push((middle, left - 1));
                continue;
            }
            if !leaps {
                out.deviation = out.deviation.max(deviation);
            }
            out.list.push((to, end));
        }
    }
    out
}

/// The point of a curve nearest to `x` by Newton's method from nearby, and whether it is an end of the curve.
pub(super) fn foot_on(curve: &Curve, x: &Point<3>, start: f64) -> (f64, CurveJet, bool) {
    // It converges quadratically; halvings guard the first steps.
    const MOST: usize = 40;
    let [from, to] = curve.domain();
    let mut t = start.clamp(from, to);
    let mut jet = curve.jet(t);
    for _ in 0..MOST {
        let d = jet.x - x;
        let (g, speed) = (jet.d1.dot(&d), jet.d1.norm_squared());
        let h = speed + jet.d2.dot(&d);
        let step = -g / if h > 0.1 * speed { h } else { speed.max(f64::MIN_POSITIVE) };
        let mut next = (t + step).clamp(from, to);
        let mut there = curve.jet(next);
        while (there.x - x).norm() > d.norm() * (1.0 + 1e-15) && (next - t).abs() > 1e-15 * (to - from) {
            next = 0.5 * (next + t);
            there = curve.jet(next);
        }
        let moved = (next - t).abs();
        (t, jet) = (next, there);
        if moved <= 4.0 * f64::EPSILON * (to - from) {
            break;
        }
    }
    (t, jet, t == from || t == to)
}
