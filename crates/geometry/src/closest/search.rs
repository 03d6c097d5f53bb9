//! The global minimum of the distance of two shapes, certified by branch and bound over their cells.
//!
//! Best first: the pair of cells with the lowest bound is taken, refined, and either proved to hold nothing better
//! than what is known, or proved convex and solved by Newton, or halved. When the lowest bound reaches the best known
//! distance, nothing better exists. The search goes on a little further, by `tie`, to find minimisers that share the
//! distance.

use std::collections::BinaryHeap;

use super::bounds::{PairExpansion, SecondOrder, box_bound};
use super::newton::{Difference, minimise};
use super::partner::{Pair, Partner, held};
use super::result::Certificate;
use crate::Point;
use crate::patch::{Atlas, Chart};

/// How far a search goes.
#[derive(Clone, Copy, Debug)]
pub struct Effort {
    /// Minimisers within this of the best are found as well.
    pub tie: f64,
    /// What rounding leaves undecided.
    pub tolerance: f64,
    /// The distance is proved where nothing is closer by more than this.
    pub proof: f64,
    /// Cell pairs after which the search gives up proving and reports what it could prove.
    pub most_pairs: usize,
    /// Size of the coordinates.
    pub magnitude: f64,
}

/// A local minimiser in terms of pieces and local parameters.
#[derive(Clone, Copy, Debug)]
pub struct Candidate<const A: usize, const B: usize> {
    pub piece: [u32; 2],
    pub a: [f64; A],
    pub b: [f64; B],
    pub xa: Point<3>,
    pub xb: Point<3>,
    pub distance: f64,
}

impl<const A: usize, const B: usize> Candidate<A, B> {
    /// The parameters of both partners in one list; `N = A + B`.
    pub fn parameters<const N: usize>(&self) -> [f64; N] {
        std::array::from_fn(|k| if k < A { self.a[k] } else { self.b[k - A] })
    }
}

/// What a search found.
#[derive(Clone, Debug)]
pub struct Found<const A: usize, const B: usize> {
    /// Every minimiser within `tie` of the best, the best first; found in cells proved convex.
    pub isolated: Vec<Candidate<A, B>>,
    /// Minimisers within rounding of the best from cells that could not be proved convex.
    pub degenerate: Vec<Candidate<A, B>>,
    /// No pair of points is closer than the distance less this.
    pub certified_to: f64,
    /// Every pair of points outside the cells of the minimisers is farther than the distance plus this.
    pub margin: f64,
    /// Cell pairs examined.
    pub pairs: usize,
    /// The search stopped at intersecting surfaces, which share a whole curve.
    pub intersecting: bool,
    pub certificate: Certificate,
}

/// The number of cells sampled where the minimum is degenerate.
const SAMPLES: usize = 48;

struct Search<'a, const A: usize, const B: usize, const N: usize, CA, CB> {
    a: Partner<'a, A, CA>,
    b: Partner<'a, B, CB>,
    effort: Effort,
    /// An upper bound of the distance: the distance of some pair of points.
    best: f64,
    /// The points that are `best` apart, and whether Newton has started from them.
    nearest: Option<(Candidate<A, B>, bool)>,
    isolated: Vec<Candidate<A, B>>,
    heap: BinaryHeap<Pair>,
    /// The smallest bound of all that was pruned.
    pruned: f64,
}

/// Finds the closest points of two atlases; `N = A + B`.
pub fn search<const A: usize, const B: usize, const N: usize, CA: Chart<A>, CB: Chart<B>>(
    a: &Atlas<A, CA>,
    b: &Atlas<B, CB>,
    effort: Effort,
) -> Found<A, B> {
    assert_eq!(A + B, N);
    let mut search = Search::<A, B, N, CA, CB> {
        a: Partner::new(a),
        b: Partner::new(b),
        effort,
        best: f64::INFINITY,
        nearest: None,
        isolated: Vec::new(),
        heap: BinaryHeap::new(),
        pruned: f64::INFINITY,
    };
    search.push(0, 0);
    search.run()
}

impl<const A: usize, const B: usize, const N: usize, CA: Chart<A>, CB: Chart<B>> Search<'_, A, B, N, CA, CB> {
    fn push(&mut self, a: u32, b: u32) {
        let (cell_a, cell_b) = (self.a.cell(a), self.b.cell(b));
        // Most pairs end here, before the rest of the cells is read.
        let boxes = box_bound(cell_a, cell_b);
        if boxes > self.best + self.effort.tie || cell_a.is_group() || cell_b.is_group() {
            self.push_bound(Pair { bound: boxes, a, b });
            return;
        }
        let expansion = PairExpansion::<N>::new(cell_a, cell_b);
        if expansion.distance < self.best {
            self.best = expansion.distance;
            let nearest = Candidate {
                piece: [cell_a.piece, cell_b.piece],
                a: cell_a.middle,
                b: cell_b.middle,
                xa: cell_a.x,
                xb: cell_b.x,
                distance: expansion.distance,
            };
            self.nearest = Some((nearest, false));
        }
        let bound = expansion.linear_bound(cell_a, cell_b).max(boxes);
        self.push_bound(Pair { bound, a, b });
    }

    fn push_bound(&mut self, pair: Pair) {
        if pair.bound > self.best + self.effort.tie {
            self.pruned = self.pruned.min(pair.bound);
        } else {
            self.heap.push(pair);
        }
    }

    fn run(mut self) -> Found<A, B> {
        let mut pairs = 0;
        let mut flat: Vec<Pair> = Vec::new();
        let mut intersecting = false;
        while let Some(pair) = self.heap.pop() {
            if pair.bound > self.best + self.effort.tie {
                self.pruned = self.pruned.min(pair.bound);
                break;
            }
            pairs += 1;
            if pairs > self.effort.most_pairs {
                self.heap.push(pair);
                break;
            }
            if pairs >= 8 && pairs.is_power_of_two() {
                self.improve();
            }
            if let Some(left) = self.examine(pair) {
                flat.push(left);
            }
            if N == 4 && self.best <= self.effort.tolerance {
                intersecting = true;
                break;
            }
        }
        let margin = (self.pruned - self.best).max(0.0);
        let stopped = !intersecting && pairs > self.effort.most_pairs;
        let mut open = flat;
        if stopped {
            open.extend(std::mem::take(&mut self.heap).into_sorted_vec().into_iter().rev());
        }
        let certified_to = open.iter().map(|p| self.best - p.bound).fold(0.0, f64::max);
        if intersecting {
            open.extend(self.heap.drain().take(1));
        }
        let certificate =
            if stopped && certified_to > self.effort.proof { Certificate::Stopped } else { Certificate::Complete };
        let mut degenerate = self.sample(&open);
        let mut best = self.isolated.iter().chain(&degenerate).map(|c| c.distance).fold(f64::INFINITY, f64::min);
        // What all bounds were compared with is an answer too, though no cell led to it.
        if let Some((nearest, _)) = self.nearest
            && best > self.best + self.effort.tolerance
        {
            let (found, _) = self.newton(nearest.piece, &[-1.0; N], &[1.0; N], nearest.parameters());
            degenerate.push(if found.distance <= nearest.distance { found } else { nearest });
            best = best.min(found.distance).min(nearest.distance);
        }
        let tie = self.effort.tie;
        self.isolated.retain(|c| c.distance <= best + tie);
        self.isolated.sort_by(|p, q| p.distance.total_cmp(&q.distance).then(p.piece.cmp(&q.piece)));
        let degenerate = degenerate.into_iter().filter(|c| c.distance <= best + tie).collect();
        Found { isolated: self.isolated, degenerate, certified_to, margin, pairs, intersecting, certificate }
    }

    /// Works on one pair of cells; returns it where nothing more can be decided.
    fn examine(&mut self, pair: Pair) -> Option<Pair> {
        let (a, b) = (self.a.cell(pair.a), self.b.cell(pair.b));
        if a.is_group() || b.is_group() {
            self.halve(pair);
            return None;
        }
        let expansion = PairExpansion::<N>::new(a, b);
        // No expansion helps where it ends below what is known and the tangents turn by as much as they are.
        let reaches = expansion.distance - a.rho3 - b.rho3 > self.best;
        let turning =
            |s: &[f64], j: &[f64]| (s.iter().map(|s| s * s).sum::<f64>(), j.iter().map(|j| j * j).sum::<f64>());
        let ((sa, ja), (sb, jb)) = (turning(&a.sigma, &a.j_norm), turning(&b.sigma, &b.j_norm));
        if N > 2 && !reaches && sa + sb > 0.25 * (ja + jb) {
            self.halve(pair);
            return None;
        }
        let second = expansion.second_order(a, b);
        let bound = pair.bound.max(expansion.quadratic_bound(&second, a, b));
        if bound > self.best + self.effort.tie {
            self.pruned = self.pruned.min(bound);
            return None;
        }
        let mut free = [false; N];
        for k in 0..A {
            free[k] = a.half[k] > 0.0;
        }
        for k in 0..B {
            free[A + k] = b.half[k] > 0.0;
        }
        // Where the Hessian moves more than it is, no certificate can succeed.
        let settled = (0..N).map(|k| second.drift[k][k]).sum::<f64>()
            < 2.0 * (0..N).map(|k| second.hessian[k][k].abs()).sum::<f64>();
        if settled && second.is_convex(&free) {
            let width = a.radius() + b.radius();
            if self.solve(pair) {
                return None;
            }
            if width <= self.effort.tolerance {
                return Some(Pair { bound, ..pair });
            }
            self.halve(Pair { bound, ..pair });
            return None;
        }
        let width = a.radius() + b.radius();
        if N > 1
            && settled
            && second.excludes_stationary(
                &expansion.gram,
                &expansion.g,
                &free,
                &held(&self.a, &self.b, pair),
                &[0.0; N],
            )
        {
            return None;
        }
        if self.reduce(pair, &expansion, &second, &free) {
            return None;
        }
        let tolerance = self.effort.tolerance;
        if bound >= self.best - tolerance && width <= 1e-4 * self.effort.magnitude || width <= tolerance {
            return Some(Pair { bound, ..pair });
        }
        self.halve(Pair { bound, ..pair });
        None
    }

    /// Newton from the closest middles so far: a good upper bound lets bad cells go early.
    fn improve(&mut self) {
        let Some((nearest, false)) = self.nearest else { return };
        self.nearest = Some((nearest, true));
        let (candidate, _) = self.newton(nearest.piece, &[-1.0; N], &[1.0; N], nearest.parameters());
        if candidate.distance < self.best {
            self.take(candidate);
        }
    }

    fn halve(&mut self, pair: Pair) {
        let (a, b) = (self.a.cell(pair.a), self.b.cell(pair.b));
        // What is straight gains little from halving.
        let weight = |radius: f64, rho: f64, group: bool, width: bool| {
            let weight = match width {
                _ if group => radius,
                false => -1.0,
                true => radius - 0.5 * f64::from(u8::from(rho == 0.0)) * radius,
            };
            // Groups first.
            (group, weight)
        };
        let width_a = a.half.iter().any(|&h| h > 0.0);
        let width_b = b.half.iter().any(|&h| h > 0.0);
        let of_a = weight(a.radius(), a.rho2, a.is_group(), width_a);
        let of_b = weight(b.radius(), b.rho2, b.is_group(), width_b);
        if of_a >= of_b {
            for child in self.a.children(pair.a) {
                self.push(child, pair.b);
            }
        } else {
            for child in self.b.children(pair.b) {
                self.push(pair.a, child);
            }
        }
    }

    /// Uses a direction in which the distance certainly grows: the minimum lies on the low side of the cells, which
    /// the neighbouring cells contain too unless it is a side of the piece.
    fn reduce(&mut self, pair: Pair, expansion: &PairExpansion<N>, second: &SecondOrder<N>, free: &[bool; N]) -> bool {
        for k in 0..N {
            if !free[k] {
                continue;
            }
            let sign = second.slope_sign(&expansion.g, k);
            if sign == 0 {
                continue;
            }
            let high = sign < 0;
            let target = if high { 1.0 } else { -1.0 };
            if k < A {
                let cell = self.a.cell(pair.a);
                let side = self.a.atlas.pieces[cell.piece as usize].sides[k][usize::from(high)];
                if cell.range(k)[usize::from(high)] == target && !side.is_smooth() {
                    let face = self.a.face(pair.a, k, high);
                    self.push(face, pair.b);
                }
            } else {
                let cell = self.b.cell(pair.b);
                let side = self.b.atlas.pieces[cell.piece as usize].sides[k - A][usize::from(high)];
                if cell.range(k - A)[usize::from(high)] == target && !side.is_smooth() {
                    let face = self.b.face(pair.b, k - A, high);
                    self.push(pair.a, face);
                }
            }
            return true;
        }
        false
    }

    fn range(&self, pair: Pair) -> ([f64; N], [f64; N]) {
        let (a, b) = (self.a.cell(pair.a), self.b.cell(pair.b));
        let mut low = [0.0; N];
        let mut high = [0.0; N];
        for k in 0..A {
            [low[k], high[k]] = a.range(k);
        }
        for k in 0..B {
            [low[A + k], high[A + k]] = b.range(k);
        }
        (low, high)
    }

    /// The minimum of a pair of cells proved convex; false where Newton does not arrive at it.
    fn solve(&mut self, pair: Pair) -> bool {
        let (a, b) = (self.a.cell(pair.a), self.b.cell(pair.b));
        let piece = [a.piece, b.piece];
        let (low, high) = self.range(pair);
        // A known stationary point inside is the minimum of the cell.
        let inside = |c: &Candidate<A, B>| {
            c.piece == piece
                && (0..A).all(|k| c.a[k] >= low[k] && c.a[k] <= high[k])
                && (0..B).all(|k| c.b[k] >= low[A + k] && c.b[k] <= high[A + k])
        };
        if self.isolated.iter().any(inside) {
            return true;
        }
        let start = std::array::from_fn(|k| 0.5 * (low[k] + high[k]));
        let (mut candidate, stationary) = self.newton(piece, &low, &high, start);
        if !stationary {
            return false;
        }
        let stopped = |z: f64, k: usize| z.abs() < 1.0 && (z == low[k] || z == high[k]);
        if (0..A).any(|k| stopped(candidate.a[k], k)) || (0..B).any(|k| stopped(candidate.b[k], A + k)) {
            // Where the cell ends but not the piece, the neighbours hold something better.
            candidate = self.newton(piece, &[-1.0; N], &[1.0; N], candidate.parameters()).0;
        }
        if candidate.distance > self.best + self.effort.tie {
            return true;
        }
        self.take(candidate);
        true
    }

    /// Keeps what Newton found.
    fn take(&mut self, candidate: Candidate<A, B>) {
        if candidate.distance < self.best {
            self.best = candidate.distance;
            self.nearest = Some((candidate, true));
        }
        if self.is_minimiser(&candidate) {
            self.isolated.push(candidate);
        }
    }

    /// Newton inside a box, and whether it arrived.
    fn newton(&self, piece: [u32; 2], low: &[f64; N], high: &[f64; N], start: [f64; N]) -> (Candidate<A, B>, bool) {
        let chart_a = &self.a.atlas.pieces[piece[0] as usize].chart;
        let chart_b = &self.b.atlas.pieces[piece[1] as usize].chart;
        let found = minimise::<A, B, N>(chart_a, chart_b, low, high, start, self.effort.magnitude);
        let a: [f64; A] = std::array::from_fn(|k| found.z[k]);
        let b: [f64; B] = std::array::from_fn(|k| found.z[A + k]);
        let (xa, xb) = (chart_a.position(&a), chart_b.position(&b));
        (Candidate { piece, a, b, xa, xb, distance: found.distance }, found.stationary)
    }

    /// Whether the gradient vanishes, or presses against a side behind which the shape does not simply go on.
    fn is_minimiser(&self, c: &Candidate<A, B>) -> bool {
        let piece_a = &self.a.atlas.pieces[c.piece[0] as usize];
        let piece_b = &self.b.atlas.pieces[c.piece[1] as usize];
        let z: [f64; N] = c.parameters();
        let at = Difference::<N>::new(&piece_a.chart, &piece_b.chart, &z);
        (0..N).all(|k| {
            let length = at.metric[k][k].sqrt();
            if at.g[k].abs() <= 1e-7 * length * (c.distance + 1e-3 * self.effort.magnitude) {
                return true;
            }
            let high = at.g[k] < 0.0;
            let value = z[k];
            if value != (if high { 1.0 } else { -1.0 }) {
                return false;
            }
            let side =
                if k < A { piece_a.sides[k][usize::from(high)] } else { piece_b.sides[k - A][usize::from(high)] };
            !side.is_smooth()
        })
    }

    /// Minimisers reached from the pairs that could not be decided.
    fn sample(&mut self, open: &[Pair]) -> Vec<Candidate<A, B>> {
        let open: Vec<Pair> =
            open.iter().copied().filter(|p| !self.a.cell(p.a).is_group() && !self.b.cell(p.b).is_group()).collect();
        let count = open.len().min(SAMPLES);
        (0..count)
            .map(|k| {
                let pair = open[k * open.len() / count];
                let piece = [self.a.cell(pair.a).piece, self.b.cell(pair.b).piece];
                let (low, high) = self.range(pair);
                let start = std::array::from_fn(|k| 0.5 * (low[k] + high[k]));
                // First inside the cells, then wherever the piece allows: the cells may only touch the minimum.
                let (near, _) = self.newton(piece, &low, &high, start);
                self.newton(piece, &[-1.0; N], &[1.0; N], near.parameters()).0
            })
            .collect()
    }
}
