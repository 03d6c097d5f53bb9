//! Points of a boundary spread evenly: where contact is tested, and what discs stand for.

use crate::cell::Site;
use signorini_geometry::Point;
use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap};

/// Product of normals above which two points are on the same face.
pub const SAME_FACE: f64 = -0.3;

/// Points chosen of some that lie on a boundary: again and again the one farthest from all chosen before on its face, until
/// none is as far as its spacing. Gives the chosen ones, for each point the place of the nearest among them, and the
/// largest distance that is left, in spacings.
pub fn farthest_points<const D: usize>(sites: &[Site<D>], spacing: &[f64]) -> (Vec<usize>, Vec<usize>, f64) {
    let distance = |i: usize, j: usize| {
        let [a, b] = [&sites[i], &sites[j]];
        if a.normal.dot(&b.normal) <= SAME_FACE { f64::INFINITY } else { (a.x - b.x).norm() / spacing[i] }
    };
    let widest = spacing.iter().fold(0.0f64, |m, s| m.max(*s));
    let mut chosen = vec![0];
    let mut nearest: Vec<(f64, usize)> = (0..sites.len()).map(|i| (distance(i, 0), 0)).collect();
    // The farthest first, of several the one with the lowest number; entries that are out of date are passed over. Distances
    // are not negative, so that their bits are in their order.
    let entry = |i: usize, d: f64| (d.to_bits(), Reverse(i));
    let mut queue: BinaryHeap<(u64, Reverse<usize>)> = nearest.iter().enumerate().map(|(i, n)| entry(i, n.0)).collect();
    let mut boxes: Option<Boxes<D>> = None;
    while let Some((bits, Reverse(at))) = queue.pop() {
        let far = nearest[at].0;
        if far.to_bits() != bits {
            continue;
        }
        if far < 1.0 {
            return (chosen, nearest.into_iter().map(|n| n.1).collect(), far);
        }
        let number = chosen.len();
        chosen.push(at);
        let mut take = |i: usize| {
            let d = distance(i, at);
            if d < nearest[i].0 {
                nearest[i] = (d, number);
                queue.push(entry(i, d));
            }
        };
        // Only what lies nearer than the farthest can come nearer.
        let reach = far * widest;
        if !reach.is_finite() {
            (0..sites.len()).for_each(take);
            continue;
        }
        let around = match boxes.take() {
            Some(boxes) if boxes.edge < 2.0 * reach => boxes,
            _ => Boxes::new(sites, reach),
        };
        around.visit(&sites[at].x, &mut take);
        boxes = Some(around);
    }
    (chosen, nearest.into_iter().map(|n| n.1).collect(), 0.0)
}

/// Points in boxes of a grid.
struct Boxes<const D: usize> {
    edge: f64,
    list: BTreeMap<[i64; D], Vec<u32>>,
}

impl<const D: usize> Boxes<D> {
    fn new(sites: &[Site<D>], edge: f64) -> Self {
        let mut out = Boxes { edge, list: BTreeMap::new() };
        for (i, site) in sites.iter().enumerate() {
            let place = out.place(&site.x);
            out.list.entry(place).or_default().push(i as u32);
        }
        out
    }

    fn place(&self, x: &Point<D>) -> [i64; D] {
        std::array::from_fn(|k| (x[k] / self.edge).floor() as i64)
    }

    /// All points that are nearer than an edge, and some more.
    fn visit(&self, x: &Point<D>, take: &mut dyn FnMut(usize)) {
        let at = self.place(x);
        for neighbour in 0..3usize.pow(D as u32) {
            let key: [i64; D] = std::array::from_fn(|k| at[k] + (neighbour / 3usize.pow(k as u32) % 3) as i64 - 1);
            self.list.get(&key).into_iter().flatten().for_each(|i| take(*i as usize));
        }
    }
}
