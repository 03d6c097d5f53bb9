//! Closest points followed through time at the price of Newton, with the guarantee of the search.
//!
//! After a search the tracker keeps a box `C` of parameters around the minimiser on which `F` is convex, and a lower
//! bound `reach` of the distance of all points outside `C`. When the bodies have moved by at most `δ` in all since then,
//! nothing outside `C` is closer than `reach - δ`. As long as `F` is still convex on `C` and Newton finds a minimum
//! inside it that is closer than that, it is the global one; otherwise the search runs again.

use std::collections::BinaryHeap;

use super::bounds::{PairExpansion, box_bound};
use super::classify::{Named, describe};
use super::newton::minimise;
use super::partner::{Pair, Partner, held};
use super::result::Certificate as CertificateOfSearch;
use super::scaled::unit_of;
use super::search::Candidate;
use super::{ClosestPair, Projection, Query, Uniqueness, closest, point_atlas, swapped};
use crate::Point;
use crate::patch::{Atlas, Cell, Chart, CurveChart, Piece, PointChart, SurfaceChart};
use crate::shape::Shape;

/// Pairs of cells spent on the bound of the complement, per parameter.
const CERTIFICATE_PAIRS: usize = 120;

/// How a tracker came by its answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// Newton inside a certificate that still holds.
    Warm,
    /// A full search.
    Cold,
}

/// Follows the closest points of one pair of shapes.
///
/// ```
/// use signorini_geometry::closest::{Query, Step, Tracker};
/// use signorini_geometry::shape::{Shape, Surface};
/// use signorini_geometry::{Point, shape::Axes};
/// let graph = Surface::graph(Axes::standard(Point::<3>::zeros()), [0.3, -0.2, 0.1], [[-1.0, 1.0]; 2]).unwrap();
/// let surface: Shape = graph.into();
/// let mut tracker = Tracker::new(Query::default());
/// let (first, step) = tracker.closest(&Shape::Point(Point::<3>::new(0.1, 0.2, 0.5)), &surface, [0.0, 0.0]);
/// assert_eq!(step, Step::Cold);
/// let (next, step) = tracker.closest(&Shape::Point(Point::<3>::new(0.101, 0.2, 0.5)), &surface, [1e-3, 0.0]);
/// assert_eq!(step, Step::Warm);
/// assert!((next.distance() - first.distance()).abs() <= 1e-3);
/// ```
#[derive(Clone, Debug)]
pub struct Tracker {
    query: Query,
    certificate: Option<Certificates>,
}

#[derive(Clone, Debug)]
enum Certificates {
    PointCurve(Box<Certificate<0, 1, 1>>),
    PointSurface(Box<Certificate<0, 2, 2>>),
    CurveCurve(Box<Certificate<1, 1, 2>>),
    CurveSurface(Box<Certificate<1, 2, 3>>),
    SurfaceSurface(Box<Certificate<2, 2, 4>>),
}

#[derive(Clone, Debug)]
struct Certificate<const A: usize, const B: usize, const N: usize> {
    piece: [u32; 2],
    low: [f64; N],
    high: [f64; N],
    z: [f64; N],
    cells: (Cell<A>, Cell<B>),
    /// Nothing outside the box was closer than this when the certificate was made.
    reach: f64,
    /// How far a point may move before stationary points may appear outside; zero where only `reach` counts.
    slack: f64,
    travelled: f64,
    magnitude: f64,
}

impl Tracker {
    pub fn new(query: Query) -> Self {
        Tracker { query, certificate: None }
    }

    /// Forgets the past: the next answer is searched for.
    pub fn forget(&mut self) {
        self.certificate = None;
    }

    /// The closest points, given that since the last call no point of either shape has moved by more than `motion`
    /// (zero for a shape that is the same as then).
    pub fn closest(&mut self, a: &Shape, b: &Shape, motion: [f64; 2]) -> (Projection, Step) {
        if a.dimension() > b.dimension() {
            let (projection, step) = self.closest(b, a, [motion[1], motion[0]]);
            return (swapped(projection), step);
        }
        // The bounds of certificates are products of lengths.
        if self.query.local_minima || unit_of(a, b) != 1.0 {
            return (closest(a, b, &self.query), Step::Cold);
        }
        let warm = match (&mut self.certificate, a, b) {
            (Some(Certificates::PointCurve(c)), Shape::Point(p), Shape::Curve(d)) => {
                c.follow(&point_atlas(p), &d.atlas, motion)
            }
            (Some(Certificates::PointSurface(c)), Shape::Point(p), Shape::Surface(s)) => {
                c.follow(&point_atlas(p), &s.atlas, motion)
            }
            (Some(Certificates::CurveCurve(c)), Shape::Curve(d), Shape::Curve(e)) => {
                c.follow(&d.atlas, &e.atlas, motion)
            }
            (Some(Certificates::CurveSurface(c)), Shape::Curve(d), Shape::Surface(s)) => {
                c.follow(&d.atlas, &s.atlas, motion)
            }
            (Some(Certificates::SurfaceSurface(c)), Shape::Surface(s), Shape::Surface(t)) => {
                c.follow(&s.atlas, &t.atlas, motion)
            }
            _ => None,
        };
        if let Some(projection) = warm {
            return (projection, Step::Warm);
        }
        let projection = closest(a, b, &self.query);
        self.certificate = None;
        // A closed form costs less than its certificate.
        let proved = projection.certificate == CertificateOfSearch::Complete;
        if proved && projection.uniqueness == Uniqueness::Unique && projection.effort > 0 {
            let found = &projection.closest;
            self.certificate = match (a, b) {
                (Shape::Point(p), Shape::Curve(c)) => {
                    certify(&point_atlas(p), &c.atlas, found).map(Box::new).map(Certificates::PointCurve)
                }
                (Shape::Point(p), Shape::Surface(s)) => {
                    certify(&point_atlas(p), &s.atlas, found).map(Box::new).map(Certificates::PointSurface)
                }
                (Shape::Curve(c), Shape::Curve(d)) => {
                    certify(&c.atlas, &d.atlas, found).map(Box::new).map(Certificates::CurveCurve)
                }
                (Shape::Curve(c), Shape::Surface(s)) => {
                    certify(&c.atlas, &s.atlas, found).map(Box::new).map(Certificates::CurveSurface)
                }
                (Shape::Surface(s), Shape::Surface(t)) => {
                    certify(&s.atlas, &t.atlas, found).map(Box::new).map(Certificates::SurfaceSurface)
                }
                _ => None,
            };
        }
        (projection, Step::Cold)
    }
}

/// A distance by which a point may move without losing its unique closest point: half the margin of the complement, as
/// long as `F` stays convex in the box.
pub(crate) fn clearance_of(p: &Point<3>, shape: &Shape, found: &ClosestPair) -> f64 {
    fn bound<const B: usize, C: Local<B>>(p: &Point<3>, atlas: &Atlas<B, C>, found: &ClosestPair) -> f64 {
        let Some(certificate) = certify::<0, B, B, _, _>(&point_atlas(p), atlas, found) else { return 0.0 };
        let mut most = 0.5 * (certificate.reach - found.distance);
        for _ in 0..40 {
            if certificate.convex_when_moved(most) {
                return most;
            }
            most *= 0.7;
        }
        0.0
    }
    if unit_of(&Shape::Point(*p), shape) != 1.0 {
        return 0.0;
    }
    let mut found = *found;
    match shape {
        Shape::Curve(c) => {
            locate(&mut found, |t| c.locate(t));
            bound::<1, _>(p, &c.atlas, &found)
        }
        Shape::Surface(s) if !s.is_triangle() => {
            found.b.place(s.locate([found.b.parameters()[0], found.b.parameters()[1]]));
            bound::<2, _>(p, &s.atlas, &found)
        }
        _ => 0.0,
    }
}

fn locate(found: &mut ClosestPair, at: impl Fn(f64) -> (usize, f64)) {
    let (piece, s) = at(found.b.parameters()[0]);
    found.b.place((piece, [s, 0.0]));
}

/// Pieces that can be rebuilt into cells.
trait Local<const M: usize>: Chart<M> {}
impl Local<0> for PointChart {}
impl Local<1> for CurveChart {}
impl Local<2> for SurfaceChart {}

/// Cells over a box of parameters, and whether `F` is convex there.
fn convex_cells<const A: usize, const B: usize, const N: usize>(
    a: &Cell<A>,
    b: &Cell<B>,
    low: &[f64; N],
    high: &[f64; N],
) -> bool {
    let free = std::array::from_fn(|k| high[k] > low[k]);
    let expansion = PairExpansion::<N>::new(a, b);
    expansion.second_order(a, b).is_convex(&free)
}

fn cells<const A: usize, const B: usize, const N: usize, CA: Chart<A>, CB: Chart<B>>(
    a: &Atlas<A, CA>,
    b: &Atlas<B, CB>,
    piece: [u32; 2],
    low: &[f64; N],
    high: &[f64; N],
) -> (Cell<A>, Cell<B>) {
    let middle = |k: usize| 0.5 * (low[k] + high[k]);
    let half = |k: usize| 0.5 * (high[k] - low[k]);
    (
        a.cell(piece[0], std::array::from_fn(middle), std::array::from_fn(half)),
        b.cell(piece[1], std::array::from_fn(|k| middle(A + k)), std::array::from_fn(|k| half(A + k))),
    )
}

fn certify<const A: usize, const B: usize, const N: usize, CA: Local<A>, CB: Local<B>>(
    a: &Atlas<A, CA>,
    b: &Atlas<B, CB>,
    found: &ClosestPair,
) -> Option<Certificate<A, B, N>> {
    let piece = [found.a.element as u32, found.b.element as u32];
    let z: [f64; N] = std::array::from_fn(|k| if k < A { found.a.local(k) } else { found.b.local(k - A) });
    // The largest box around the minimiser on which F is convex.
    let mut half = 1.0;
    let (low, high, both) = loop {
        let low: [f64; N] = z.map(|t| (t - half).max(-1.0));
        let high: [f64; N] = z.map(|t| (t + half).min(1.0));
        let both = cells(a, b, piece, &low, &high);
        if convex_cells(&both.0, &both.1, &low, &high) {
            break (low, high, both);
        }
        half *= 0.7;
        if half < 1e-4 {
            return None;
        }
    };
    let magnitude = a.magnitude.max(b.magnitude);
    // A point that moves turns no stationary point up where the gradient is larger than its motion can change it: try
    // for a long motion first. Shapes that move in other ways have bounds of the distance only.
    let most = 0.2 * (0..B).map(|k| both.1.j_norm[k]).fold(f64::INFINITY, f64::min);
    let mut slack = if A == 0 { most } else { 0.0 };
    let reach = loop {
        let reach = complement_bound(a, b, piece, &low, &high, slack, found.distance);
        if reach >= found.distance + 2.0 * slack || slack <= 0.04 * most {
            break reach;
        }
        slack *= 0.2;
    };
    if reach <= found.distance {
        return None;
    }
    Some(Certificate { piece, low, high, z, cells: both, reach, slack, travelled: 0.0, magnitude })
}

/// A lower bound of the distance over all parameters outside a box, those left out on which no minimiser can appear while
/// the first partner, a point, moves by `slack`.
fn complement_bound<const A: usize, const B: usize, const N: usize, CA: Chart<A>, CB: Chart<B>>(
    a: &Atlas<A, CA>,
    b: &Atlas<B, CB>,
    piece: [u32; 2],
    low: &[f64; N],
    high: &[f64; N],
    slack: f64,
    distance: f64,
) -> f64 {
    let (mut a, mut b) = (Partner::new(a), Partner::new(b));
    let mut heap = BinaryHeap::new();
    let push = |heap: &mut BinaryHeap<Pair>, a: &Partner<'_, A, CA>, b: &Partner<'_, B, CB>, i: u32, j: u32| {
        let (p, q) = (a.cell(i), b.cell(j));
        if [p.piece, q.piece] == piece {
            let inside = |k: usize, range: [f64; 2]| range[0] >= low[k] && range[1] <= high[k];
            if (0..A).all(|k| inside(k, p.range(k))) && (0..B).all(|k| inside(A + k, q.range(k))) {
                return;
            }
        }
        let mut bound = box_bound(p, q);
        if !(p.is_group() || q.is_group()) {
            bound = bound.max(PairExpansion::<N>::new(p, q).linear_bound(p, q));
        }
        heap.push(Pair { bound, a: i, b: j });
    };
    push(&mut heap, &a, &b, 0, 0);
    let mut spent = 0;
    while let Some(pair) = heap.pop() {
        spent += 1;
        let enough = slack > 0.0 && pair.bound >= distance + 2.0 * slack;
        if enough || spent > CERTIFICATE_PAIRS * N {
            return pair.bound;
        }
        let (p, q) = (a.cell(pair.a), b.cell(pair.b));
        if slack > 0.0 && !q.is_group() {
            let expansion = PairExpansion::<N>::new(p, q);
            let second = expansion.second_order(p, q);
            let free = std::array::from_fn(|k| q.half[k] > 0.0);
            let motion = std::array::from_fn(|k| slack * (q.j_norm[k] + q.sigma[k]));
            let held = held(&a, &b, pair);
            if second.excludes_stationary(&expansion.gram, &expansion.g, &free, &held, &motion) {
                continue;
            }
        }
        let wide = |group: bool, radius: f64| if group { 1e30 + radius } else { radius };
        if B == 0 || (A > 0 && wide(p.is_group(), p.radius()) >= wide(q.is_group(), q.radius())) {
            for child in a.children(pair.a) {
                push(&mut heap, &a, &b, child, pair.b);
            }
        } else {
            for child in b.children(pair.b) {
                push(&mut heap, &a, &b, pair.a, child);
            }
        }
    }
    f64::INFINITY
}

impl<const A: usize, const B: usize, const N: usize> Certificate<A, B, N> {
    /// Whether `F` stays convex in the box when the difference vector moves by up to `motion`.
    fn convex_when_moved(&self, motion: f64) -> bool {
        let (a, b) = (&self.cells.0, &self.cells.1);
        let mut second = PairExpansion::<N>::new(a, b).second_order(a, b);
        for p in 0..N {
            for q in 0..N {
                second.drift[p][q] += motion
                    * if p < A && q < A {
                        a.dd_norm[p][q] + a.tau[p][q]
                    } else if p >= A && q >= A {
                        b.dd_norm[p - A][q - A] + b.tau[p - A][q - A]
                    } else {
                        0.0
                    };
            }
        }
        second.is_convex(&std::array::from_fn(|k| self.high[k] > self.low[k]))
    }

    /// The closest points while the certificate holds.
    fn follow<CA: Local<A>, CB: Local<B>>(
        &mut self,
        a: &Atlas<A, CA>,
        b: &Atlas<B, CB>,
        motion: [f64; 2],
    ) -> Option<Projection>
    where
        Piece<A, CA>: Named<A>,
        Piece<B, CB>: Named<B>,
    {
        let (piece_a, piece_b) = (a.pieces.get(self.piece[0] as usize)?, b.pieces.get(self.piece[1] as usize)?);
        self.travelled += motion[0] + motion[1];
        if self.slack > 0.0 && (motion[1] > 0.0 || self.travelled > self.slack) {
            return None;
        }
        // Written so that a motion that is not a number fails.
        if !(motion.iter().all(|m| *m >= 0.0) && self.travelled < self.reach) {
            return None;
        }
        if motion[0] > 0.0 {
            self.cells.0 = cells::<A, B, N, CA, CB>(a, b, self.piece, &self.low, &self.high).0;
        }
        if motion[1] > 0.0 {
            self.cells.1 = cells::<A, B, N, CA, CB>(a, b, self.piece, &self.low, &self.high).1;
        }
        if !convex_cells(&self.cells.0, &self.cells.1, &self.low, &self.high) {
            return None;
        }
        let found = minimise::<A, B, N>(&piece_a.chart, &piece_b.chart, &self.low, &self.high, self.z, self.magnitude);
        let margin = self.reach - self.travelled - found.distance;
        // On a side of the box that is not one of the shape the minimum may lie beyond.
        let held = (0..N).all(|k| {
            let side = |high: bool| {
                if k < A { piece_a.sides[k][usize::from(high)] } else { piece_b.sides[k - A][usize::from(high)] }
            };
            let z = found.z[k];
            (z > self.low[k] || (z == -1.0 && !side(false).is_smooth()))
                && (z < self.high[k] || (z == 1.0 && !side(true).is_smooth()))
        });
        if !held || !found.stationary || margin.is_nan() || margin <= 64.0 * f64::EPSILON * self.magnitude {
            return None;
        }
        self.z = found.z;
        let (za, zb): ([f64; A], [f64; B]) =
            (std::array::from_fn(|k| found.z[k]), std::array::from_fn(|k| found.z[A + k]));
        let candidate = Candidate {
            piece: self.piece,
            a: za,
            b: zb,
            xa: piece_a.chart.position(&za),
            xb: piece_b.chart.position(&zb),
            distance: found.distance,
        };
        let (closest, _) = describe::<A, B, N, CA, CB>(a, b, &candidate);
        Some(Projection { margin, ..Projection::known(closest, Uniqueness::Unique, Vec::new()) })
    }
}
