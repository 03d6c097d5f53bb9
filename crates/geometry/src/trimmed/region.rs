//! The part of a surface that its loops of edges leave: on which side of them parameters lie.
//!
//! A loop is followed by straight segments in parameters that are scaled to lengths. Nothing crosses the way from a point to the
//! nearest of all segments, so that the side of that segment is the side of the region: loops need not close in the plane of the
//! parameters, as they do not around cylinders and poles, and seams, with the region on both sides, are left out. Within `band`
//! of the segments the edges themselves decide, in space.

use super::edge::FaceUse;
use crate::bvh::Bvh;
use crate::{Aabb, Point};
use std::cell::Cell;

/// A straight part of a loop, in scaled parameters.
#[derive(Clone, Debug)]
pub(super) struct Segment {
    pub ends: [[f64; 2]; 2],
    /// Number among the uses of edges by the face, and the parameters of the edge at both ends.
    pub of: usize,
    pub t: [f64; 2],
    /// The segments before and after it in its loop.
    beside: [Option<usize>; 2],
}

#[derive(Clone, Debug)]
pub(super) struct Region {
    pub scale: [f64; 2],
    /// Scaled, and where each begins.
    periods: [Option<f64>; 2],
    pub start: [f64; 2],
    pub segments: Vec<Segment>,
    tree: Option<Bvh>,
    /// Largest distance of the segments from the edges, doubled.
    pub band: f64,
    left: f64,
}

impl Region {
    /// Of loops that have the region on their left, or right; `deviation` is the largest distance of samples from the chords.
    pub fn new(
        uses: &[FaceUse],
        [scale, start]: [[f64; 2]; 2],
        periods: [Option<f64>; 2],
        is_left: bool,
        deviation: f64,
    ) -> Self {
        let periods = [0, 1].map(|k| periods[k].map(|p| p * scale[k]));
        let mut segments: Vec<Segment> = Vec::new();
        let near = 1e-6
            * uses
                .iter()
                .flat_map(|u| &u.samples)
                .map(|s| (s.1[0] * scale[0]).abs().max((s.1[1] * scale[1]).abs()))
                .fold(0.0, f64::max)
            + 2.0 * deviation;
        let mut loops = 0..0;
        let mut place = usize::MAX;
        let close = |segments: &mut Vec<Segment>, range: std::ops::Range<usize>| {
            let n = range.len();
            for k in 0..n {
                let (a, b) = (range.start + k, range.start + (k + 1) % n);
                let gap = [0, 1].map(|i| {
                    let d = segments[b].ends[0][i] - segments[a].ends[1][i];
                    periods[i].map_or(d, |p| d - p * (d / p).round())
                });
                if gap[0].hypot(gap[1]) <= near {
                    segments[a].beside[1] = Some(b);
                    segments[b].beside[0] = Some(a);
                }
            }
        };
        for (of, use_) in uses.iter().enumerate() {
            if use_.of_loop != place {
                close(&mut segments, loops.clone());
                loops = segments.len()..segments.len();
                place = use_.of_loop;
            }
            if use_.is_seam {
                continue;
            }
            let mut add = |a: &(f64, [f64; 2]), b: &(f64, [f64; 2])| {
                let mut ends = [a.1, b.1].map(|z| [z[0] * scale[0], z[1] * scale[1]]);
                for k in 0..2 {
                    if let Some(p) = periods[k] {
                        let middle = 0.5 * (ends[0][k] + ends[1][k]);
                        let shift = ((middle - start[k] * scale[k]) / p).floor() * p;
                        ends.iter_mut().for_each(|e| e[k] -= shift);
                    }
                }
                segments.push(Segment { ends, of, t: [a.0, b.0], beside: [None; 2] });
            };
            match use_.forward {
                true => use_.samples.windows(2).for_each(|w| add(&w[0], &w[1])),
                false => use_.samples.windows(2).rev().for_each(|w| add(&w[1], &w[0])),
            }
            loops.end = segments.len();
        }
        close(&mut segments, loops);
        let boxes: Vec<Aabb<3>> = segments
            .iter()
            .map(|s| {
                let [a, b] = s.ends.map(|e| Point::<3>::new(e[0], e[1], 0.0));
                Aabb::new(a.inf(&b), a.sup(&b))
            })
            .collect();
        let tree = (!segments.is_empty()).then(|| Bvh::new(&boxes));
        Region { scale, periods, start, segments, tree, band: 2.0 * deviation, left: if is_left { 1.0 } else { -1.0 } }
    }

    /// Scaled parameters where the periods begin, and their images a period to both sides.
    fn images(&self, z: [f64; 2]) -> impl Iterator<Item = [f64; 2]> {
        let first = [0, 1].map(|k| {
            let x = z[k] * self.scale[k];
            let from = self.start[k] * self.scale[k];
            self.periods[k].map_or(x, |p| from + (x - from).rem_euclid(p))
        });
        let steps = self.periods.map(|p| if p.is_some() { 3 } else { 1 });
        let period = self.periods.map(Option::unwrap_or_default);
        let shifts = [0.0, -1.0, 1.0];
        (0..steps[0]).flat_map(move |i| {
            (0..steps[1]).map(move |j| [first[0] + shifts[i] * period[0], first[1] + shifts[j] * period[1]])
        })
    }

    /// Distance to the loops in scaled parameters, positive within the region, and the nearest segment; infinite without loops.
    pub fn signed(&self, z: [f64; 2]) -> (f64, usize) {
        let Some(tree) = &self.tree else { return (f64::INFINITY, usize::MAX) };
        let best = Cell::new((f64::INFINITY, usize::MAX, 0.0, [0.0; 2]));
        for p in self.images(z) {
            tree.nearest(&Point::<3>::new(p[0], p[1], 0.0), best.get().0, |k| {
                let (share, squared) = nearest_on(&self.segments[k].ends, p);
                if squared < best.get().0 {
                    best.set((squared, k, share, p));
                }
                best.get().0
            });
        }
        let (squared, k, share, p) = best.get();
        let own = &self.segments[k];
        let mut across = left_of(&own.ends);
        let at_end = if share == 0.0 {
            Some(0)
        } else if share == 1.0 {
            Some(1)
        } else {
            None
        };
        if let Some(other) = at_end.and_then(|side: usize| own.beside[side]) {
            let [x, y] = left_of(&self.segments[other].ends);
            across = [across[0] + x, across[1] + y];
        }
        let foot = [0, 1].map(|i| own.ends[0][i] + share * (own.ends[1][i] - own.ends[0][i]));
        let side = ((p[0] - foot[0]) * across[0] + (p[1] - foot[1]) * across[1]) * self.left;
        (if side < 0.0 { -squared.sqrt() } else { squared.sqrt() }, k)
    }

    /// Numbers of the uses of edges whose segments are within a distance, each with a parameter of the edge there.
    pub fn near(&self, z: [f64; 2], distance: f64) -> Vec<(usize, f64)> {
        let mut found: Vec<(usize, f64, f64)> = Vec::new();
        let Some(tree) = &self.tree else { return Vec::new() };
        let limit = distance * distance;
        for p in self.images(z) {
            tree.nearest(&Point::<3>::new(p[0], p[1], 0.0), limit, |k| {
                let Segment { ends, of, t, .. } = &self.segments[k];
                let (share, squared) = nearest_on(ends, p);
                if squared <= limit {
                    let t = t[0] + share * (t[1] - t[0]);
                    match found.iter_mut().find(|f| f.0 == *of) {
                        Some(known) if known.2 <= squared => {}
                        Some(known) => (known.1, known.2) = (t, squared),
                        None => found.push((*of, t, squared)),
                    }
                }
                limit
            });
        }
        found.into_iter().map(|f| (f.0, f.1)).collect()
    }
}

/// The unit vector to the left of a segment; zero of one without length.
fn left_of([a, b]: &[[f64; 2]; 2]) -> [f64; 2] {
    let d = [b[0] - a[0], b[1] - a[1]];
    let length = d[0].hypot(d[1]).max(f64::MIN_POSITIVE);
    [-d[1] / length, d[0] / length]
}

/// The share of a segment at its point nearest to `p`, and the squared distance.
fn nearest_on([a, b]: &[[f64; 2]; 2], p: [f64; 2]) -> (f64, f64) {
    let (d, e) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let squared = d[0] * d[0] + d[1] * d[1];
    let share = if squared > 0.0 { ((d[0] * e[0] + d[1] * e[1]) / squared).clamp(0.0, 1.0) } else { 0.0 };
    let rest = [e[0] - share * d[0], e[1] - share * d[1]];
    (share, rest[0] * rest[0] + rest[1] * rest[1])
}
