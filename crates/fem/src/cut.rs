//! Quadrature on cells that implicit surfaces divide into regions.
//!
//! Dimension reduction after R. Saye, *High-order quadrature methods for implicitly defined surfaces and volumes in
//! hyperrectangles*, SIAM J. Sci. Comput. 37 (2015): a *height direction* is chosen along which every surface is a
//! graph over the rest of the cell, the base is broken where a surface meets the two faces normal to it, and on each
//! line in the height direction the surfaces are single roots. The roots carry the surface rule with the weight
//! `|∇φ| / |∂_k φ|`; the segments between them carry the volume rules. All weights are positive. Where no direction
//! serves, the cell is split.
//!
//! One pass yields the rules of *all* regions, so the volumes of a cell's parts add up to the cell to round-off.
//!
//! [`cut_cell`] is the rule of lines and of the plane; [`height`] does the same by recursion over the dimension, in
//! space too, with the curves in which surfaces intersect; [`simplices`] cuts sub-cells along chords.

pub mod height;
mod material;
pub mod simplices;

pub use height::{End, height_functions};
pub use material::material;
pub use simplices::{space_tree, sub_cells};

use signorini_geometry::rule::gauss_legendre;
use signorini_geometry::{Aabb, ImplicitShape, Point, Vector};

/// Names a region: what lies between the surfaces.
pub type RegionId = u32;

/// What divides one cell.
pub struct CellPartition<'a, const D: usize> {
    /// The surfaces that may cross the cell.
    pub sheets: Vec<Box<dyn ImplicitShape<D> + 'a>>,
    /// What each surface is called in [`SurfacePoint::tag`].
    pub tags: Vec<u32>,
    /// Points at which the cell is split before anything else: corners of surfaces, and one point of any closed
    /// surface that lies within the cell.
    pub features: Vec<Point<D>>,
    /// The region of a point, given the values of the sheets there.
    pub region: Box<dyn Fn(&Point<D>, &[f64]) -> RegionId + 'a>,
}

/// A division of space into regions by implicit surfaces.
pub trait Partition<const D: usize>: Sync {
    /// What divides the cell with the given box.
    fn in_cell(&self, cell: usize, bounds: &Aabb<D>) -> CellPartition<'_, D>;
}

/// A quadrature point of a volume.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct QuadraturePoint<const D: usize> {
    pub x: Point<D>,
    pub weight: f64,
}

/// A quadrature point of a surface between two regions.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint<const D: usize> {
    pub x: Point<D>,
    pub weight: f64,
    /// Unit normal, from the negative to the positive side of the sheet.
    pub normal: Vector<D>,
    pub tag: u32,
    /// The regions on the negative and on the positive side.
    pub minus: RegionId,
    pub plus: RegionId,
}

/// The quadrature of one cell.
#[derive(Clone, Debug, Default)]
pub struct CellRule<const D: usize> {
    /// Volume rules of the regions present, sorted by region.
    pub volumes: Vec<(RegionId, Vec<QuadraturePoint<D>>)>,
    pub surfaces: Vec<SurfacePoint<D>>,
    /// Whether any surface crosses the cell.
    pub cut: bool,
}

impl<const D: usize> CellRule<D> {
    /// The volume rule of one region; empty where the region is absent.
    pub fn volume(&self, region: RegionId) -> &[QuadraturePoint<D>] {
        self.volumes.iter().find(|(r, _)| *r == region).map_or(&[], |(_, points)| points)
    }

    fn points_of(&mut self, region: RegionId) -> &mut Vec<QuadraturePoint<D>> {
        let at = self.volumes.binary_search_by_key(&region, |(r, _)| *r).unwrap_or_else(|at| {
            self.volumes.insert(at, (region, Vec::new()));
            at
        });
        &mut self.volumes[at].1
    }
}

/// Samples along each edge of a box when looking for surfaces.
const SAMPLES: usize = 5;
/// Samples along a face when looking for roots.
const FACE_SAMPLES: usize = 9;
/// How often a cell is halved before the general root search takes over.
const MAX_DEPTH: usize = 6;
/// Least slope `|∂_k φ| / |∇φ|` along the height direction.
const MIN_SLOPE: f64 = 0.2;

/// The quadrature of one cell with `order` Gauss points per direction and smooth piece.
pub fn cut_cell<const D: usize>(partition: &CellPartition<'_, D>, cell: &Aabb<D>, order: usize) -> CellRule<D> {
    if D > 2 {
        return height_functions(partition, cell, order);
    }
    let mut rule = CellRule::default();
    let sheets: Vec<usize> = (0..partition.sheets.len()).collect();
    let gauss = gauss_legendre(order);
    Cutter { partition, gauss: &gauss }.split(cell, &sheets, &partition.features, 0, &mut rule);
    rule
}

struct Cutter<'a, const D: usize> {
    partition: &'a CellPartition<'a, D>,
    gauss: &'a [(f64, f64)],
}

/// How the roots of a sheet on a line are found.
#[derive(Clone, Copy, PartialEq)]
enum Search {
    /// The sheet is monotone along the line: at most one root.
    Single,
    /// Any number of roots, found by sampling.
    Scan,
}

impl<const D: usize> Cutter<'_, D> {
    fn split(&self, b: &Aabb<D>, sheets: &[usize], features: &[Point<D>], depth: usize, rule: &mut CellRule<D>) {
        let slack = 1e-9 * b.size();
        let strictly_inside = |x: &Point<D>| (0..D).all(|k| x[k] > b.min[k] + slack[k] && x[k] < b.max[k] - slack[k]);
        if let Some(at) = features.iter().position(strictly_inside) {
            for part in b.split_at(&features[at]) {
                self.split(&part, sheets, features, depth, rule);
            }
            return;
        }
        let active: Vec<usize> = sheets.iter().copied().filter(|&s| self.crosses(s, b)).collect();
        if active.is_empty() {
            return self.whole(b, rule);
        }
        rule.cut = true;
        if D == 1 {
            return self.line(b.min, 0, b, &active, 1.0, Search::Scan, rule);
        }
        let slopes = self.least_slopes(&active, b);
        let (slope, k) = (0..D)
            .map(|k| (slopes[k], k))
            .fold((f64::NEG_INFINITY, 0), |best, new| if new.0 > best.0 { new } else { best });
        if slope >= MIN_SLOPE {
            self.column(b, k, &active, Search::Single, rule);
        } else if depth < MAX_DEPTH {
            for part in b.split_at(&b.center()) {
                self.split(&part, &active, features, depth + 1, rule);
            }
        } else {
            self.column(b, k, &active, Search::Scan, rule);
        }
    }

    /// An undivided box: the tensor-product Gauss rule.
    fn whole(&self, b: &Aabb<D>, rule: &mut CellRule<D>) {
        let region = self.region(&b.center());
        let points = rule.points_of(region);
        for i in 0..self.gauss.len().pow(D as u32) {
            let mut index = i;
            let mut weight = b.volume();
            let xi = Point::from_fn(|_, _| {
                let (x, w) = self.gauss[index % self.gauss.len()];
                index /= self.gauss.len();
                weight *= w;
                x
            });
            points.push(QuadraturePoint { x: b.at(&xi), weight });
        }
    }

    fn region(&self, x: &Point<D>) -> RegionId {
        let values: Vec<f64> = self.partition.sheets.iter().map(|s| s.value(x)).collect();
        (self.partition.region)(x, &values)
    }

    /// Whether a sheet has points in the box, also when it only bulges in through one face.
    fn crosses(&self, sheet: usize, b: &Aabb<D>) -> bool {
        let sheet = &*self.partition.sheets[sheet];
        let negative = sheet.value(&b.center()) < 0.0;
        if samples(b).any(|x| (sheet.value(&x) < 0.0) != negative) {
            return true;
        }
        D == 2
            && (0..D).any(|k| {
                [b.min, b.max].iter().any(|face| {
                    let mut along = *face;
                    !scan_roots(b.min[k], b.max[k], FACE_SAMPLES, |t| {
                        along[k] = t;
                        let (v, g) = sheet.value_and_gradient(&along);
                        (v, g[k])
                    })
                    .is_empty()
                })
            })
    }

    /// The least slopes of the active sheets along each direction; negative where the sign of the slope changes.
    fn least_slopes(&self, active: &[usize], b: &Aabb<D>) -> Vector<D> {
        let mut least = Vector::<D>::repeat(f64::INFINITY);
        for &s in active {
            let sheet = &*self.partition.sheets[s];
            let mut low = Vector::<D>::repeat(f64::INFINITY);
            let mut high = -low;
            for x in samples(b) {
                let g = sheet.gradient(&x);
                let direction = g / g.norm().max(f64::MIN_POSITIVE);
                low = low.inf(&direction);
                high = high.sup(&direction);
            }
            least = least.inf(&low.sup(&-high));
        }
        least
    }

    /// Integrates over lines in direction `k` above the other direction of a rectangle.
    fn column(&self, b: &Aabb<D>, k: usize, active: &[usize], search: Search, rule: &mut CellRule<D>) {
        let base = 1 - k;
        let (lo, hi) = (b.min[base], b.max[base]);
        let mut breaks = vec![lo, hi];
        for &s in active {
            let sheet = &*self.partition.sheets[s];
            for face in [b.min[k], b.max[k]] {
                let mut x = b.min;
                x[k] = face;
                breaks.extend(scan_roots(lo, hi, FACE_SAMPLES, |t| {
                    x[base] = t;
                    let (v, g) = sheet.value_and_gradient(&x);
                    (v, g[base])
                }));
            }
        }
        if active.len() > 1 {
            breaks.extend(self.intersections(b, k, active));
        }
        breaks.sort_by(f64::total_cmp);
        for pair in breaks.windows(2) {
            let width = pair[1] - pair[0];
            if width <= 1e-15 * (hi - lo) {
                continue;
            }
            for &(t, w) in self.gauss {
                let mut x = b.min;
                x[base] = pair[0] + t * width;
                self.line(x, k, b, active, w * width, search, rule);
            }
        }
    }

    /// Base positions at which two sheets intersect, so that the integrand has a kink there.
    fn intersections(&self, b: &Aabb<D>, k: usize, active: &[usize]) -> Vec<f64> {
        let base = 1 - k;
        let root = |s: usize, t: f64| {
            let mut x = b.min;
            x[base] = t;
            self.roots_on_line(s, x, k, b, Search::Single).first().copied()
        };
        let mut found = Vec::new();
        for (i, &s) in active.iter().enumerate() {
            for &r in &active[i + 1..] {
                let difference = |t: f64| Some(root(s, t)? - root(r, t)?);
                let at = |j: usize| b.min[base] + (b.max[base] - b.min[base]) * j as f64 / FACE_SAMPLES as f64;
                for j in 0..FACE_SAMPLES {
                    let (mut lo, mut hi) = (at(j), at(j + 1));
                    if let (Some(a), Some(c)) = (difference(lo), difference(hi))
                        && (a < 0.0) != (c < 0.0)
                    {
                        for _ in 0..60 {
                            let middle = 0.5 * (lo + hi);
                            match difference(middle) {
                                Some(d) if (d < 0.0) == (a < 0.0) => lo = middle,
                                _ => hi = middle,
                            }
                        }
                        found.push(0.5 * (lo + hi));
                    }
                }
            }
        }
        found
    }

    fn roots_on_line(&self, sheet: usize, mut x: Point<D>, k: usize, b: &Aabb<D>, search: Search) -> Vec<f64> {
        let sheet = &*self.partition.sheets[sheet];
        let (lo, hi) = (b.min[k], b.max[k]);
        let along = |t: f64| {
            x[k] = t;
            let (v, g) = sheet.value_and_gradient(&x);
            (v, g[k])
        };
        scan_roots(lo, hi, if search == Search::Single { 1 } else { FACE_SAMPLES }, along)
    }

    /// Volume and surface points on one line through `x` in direction `k`.
    #[allow(clippy::too_many_arguments)]
    fn line(
        &self,
        x: Point<D>,
        k: usize,
        b: &Aabb<D>,
        active: &[usize],
        weight: f64,
        search: Search,
        rule: &mut CellRule<D>,
    ) {
        let at = |t: f64| {
            let mut y = x;
            y[k] = t;
            y
        };
        let mut roots: Vec<(f64, usize)> = active
            .iter()
            .flat_map(|&s| self.roots_on_line(s, x, k, b, search).into_iter().map(move |t| (t, s)))
            .collect();
        roots.sort_by(|a, c| a.0.total_cmp(&c.0));
        let ends: Vec<f64> =
            std::iter::once(b.min[k]).chain(roots.iter().map(|r| r.0)).chain(std::iter::once(b.max[k])).collect();
        let regions: Vec<RegionId> = ends.windows(2).map(|e| self.region(&at(0.5 * (e[0] + e[1])))).collect();
        for (pair, &region) in ends.windows(2).zip(&regions) {
            let length = pair[1] - pair[0];
            if length > 1e-15 * (b.max[k] - b.min[k]) {
                let points = rule.points_of(region);
                points.extend(
                    self.gauss
                        .iter()
                        .map(|&(t, w)| QuadraturePoint { x: at(pair[0] + t * length), weight: weight * w * length }),
                );
            }
        }
        for (&(t, s), between) in roots.iter().zip(regions.windows(2)) {
            if between[0] == between[1] {
                continue;
            }
            let x = at(t);
            let gradient = self.partition.sheets[s].gradient(&x);
            let rising = gradient[k] > 0.0;
            let (minus, plus) = if rising { (between[0], between[1]) } else { (between[1], between[0]) };
            let norm = gradient.norm();
            rule.surfaces.push(SurfacePoint {
                x,
                weight: weight * norm / gradient[k].abs().max(f64::MIN_POSITIVE),
                normal: gradient / norm,
                tag: self.partition.tags[s],
                minus,
                plus,
            });
        }
    }
}

/// A lattice of points of a box, corners included.
fn samples<const D: usize>(b: &Aabb<D>) -> impl Iterator<Item = Point<D>> + '_ {
    (0..SAMPLES.pow(D as u32)).map(|mut i| {
        b.at(&Point::from_fn(|_, _| {
            let v = i % SAMPLES;
            i /= SAMPLES;
            v as f64 / (SAMPLES - 1) as f64
        }))
    })
}

/// The roots in `[a, b]` of a function given with its slope, from `pieces` intervals.
///
/// An interval whose ends have one sign is searched for an extremum that reaches across zero, so that a surface that
/// only bulges through a face is not lost. Zero counts as positive.
pub fn scan_roots(a: f64, b: f64, pieces: usize, mut f: impl FnMut(f64) -> (f64, f64)) -> Vec<f64> {
    let mut roots = Vec::new();
    let mut left = (a, f(a));
    for i in 1..=pieces {
        let t = if i == pieces { b } else { a + (b - a) * i as f64 / pieces as f64 };
        let right = (t, f(t));
        let sign = |v: f64| if v < 0.0 { -1.0 } else { 1.0 };
        let s = sign(left.1.0);
        if s != sign(right.1.0) {
            roots.push(bracketed_root(left, right, &mut f));
        } else if s * left.1.1 < 0.0 && s * right.1.1 > 0.0 {
            // |f| has a minimum inside: bisect the slope until the minimum, or a change of sign, is found.
            let (mut lo, mut hi) = (left.0, right.0);
            for _ in 0..50 {
                let middle = 0.5 * (lo + hi);
                let value = f(middle);
                if sign(value.0) != s {
                    roots.push(bracketed_root(left, (middle, value), &mut f));
                    roots.push(bracketed_root((middle, value), right, &mut f));
                    break;
                }
                if s * value.1 < 0.0 { lo = middle } else { hi = middle }
            }
        }
        left = right;
    }
    roots
}

/// Newton's method, kept in a bracket by bisection.
fn bracketed_root(a: (f64, (f64, f64)), b: (f64, (f64, f64)), f: &mut impl FnMut(f64) -> (f64, f64)) -> f64 {
    let negative_left = a.1.0 < 0.0;
    let (mut lo, mut hi) = (a.0, b.0);
    let tolerance = 1e-16 * (hi - lo).abs() + f64::EPSILON * lo.abs().max(hi.abs());
    // The secant is the first guess: exact for straight surfaces.
    let mut t = lo + (hi - lo) * (a.1.0 / (a.1.0 - b.1.0)).clamp(0.0, 1.0);
    for _ in 0..80 {
        let (value, slope) = f(t);
        if value == 0.0 {
            return t;
        }
        if (value < 0.0) == negative_left {
            lo = t
        } else {
            hi = t
        }
        let newton = t - value / slope;
        let next = if newton > lo.min(hi) && newton < lo.max(hi) { newton } else { 0.5 * (lo + hi) };
        if (next - t).abs() <= tolerance {
            return next;
        }
        t = next;
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Grid;
    use signorini_geometry::{Ellipsoid, HalfSpace};
    use std::f64::consts::PI;

    struct Inside<'a>(&'a dyn ImplicitShape<2>);

    impl Partition<2> for Inside<'_> {
        fn in_cell(&self, _: usize, _: &Aabb<2>) -> CellPartition<'_, 2> {
            CellPartition {
                sheets: vec![Box::new(self.0)],
                tags: vec![7],
                features: Vec::new(),
                region: Box::new(|_, v| u32::from(v[0] < 0.0)),
            }
        }
    }

    /// Area, perimeter, and the vector ∫ x·n n over the boundary, on an n × n grid.
    fn measures(shape: &dyn ImplicitShape<2>, n: usize, order: usize) -> (f64, f64, Vector<2>, f64) {
        let bounds = Aabb::new(Point::<2>::new(-1.03, -1.03), Point::<2>::new(1.03, 1.03));
        let grid = Grid::<2>::new(bounds, [n, n], 1);
        let partition = Inside(shape);
        let (mut area, mut perimeter, mut closed, mut flux, mut total) = (0.0, 0.0, Vector::zeros(), 0.0, 0.0);
        for cell in 0..grid.cell_count() {
            let b = grid.cell_box(cell);
            let rule = cut_cell(&partition.in_cell(cell, &b), &b, order);
            total += rule.volumes.iter().flat_map(|v| &v.1).map(|p| p.weight).sum::<f64>();
            area += rule.volume(1).iter().map(|p| p.weight).sum::<f64>();
            for p in &rule.surfaces {
                assert_eq!((p.minus, p.plus, p.tag), (1, 0, 7));
                assert!(p.weight > 0.0);
                perimeter += p.weight;
                closed += p.weight * p.normal;
                flux += p.weight * p.normal.dot(&p.x);
            }
        }
        assert!((total - bounds.volume()).abs() < 1e-13);
        (area, perimeter, closed, flux)
    }

    #[test]
    fn circles_of_any_size_have_their_area_and_perimeter() {
        // The third touches grid lines; the last lies within a cell's width.
        for (center, r) in [([0.0, 0.0], 0.6), ([0.01, 0.02], 0.9), ([0.0, 0.0], 0.618), ([0.1, -0.3], 0.2)] {
            let disc = Ellipsoid { center: center.into(), semi_axes: [r, r] };
            let (area, perimeter, closed, flux) = measures(&disc, 10, 9);
            assert!((area - PI * r * r).abs() < 1e-11, "radius {r}: {}", area - PI * r * r);
            assert!((perimeter - 2.0 * PI * r).abs() < 1e-10, "radius {r}: {}", perimeter - 2.0 * PI * r);
            assert!(closed.norm() < 1e-10);
            assert!((flux - 2.0 * area).abs() < 1e-10);
        }
    }

    #[test]
    fn the_error_falls_with_the_order_of_the_rule() {
        let disc = Ellipsoid { center: Point::zeros(), semi_axes: [0.6, 0.6] };
        let error = |order| (measures(&disc, 10, order).1 - 1.2 * PI).abs();
        assert!(error(5) < 1e-7 && error(6) < 0.2 * error(5) && error(8) < 1e-10);
    }

    #[test]
    fn a_straight_line_on_a_grid_line_is_found_once() {
        let line = HalfSpace { point: Point::<2>::new(0.0, 0.0), normal: Vector::<2>::new(1.0, 0.0) };
        let (area, perimeter, ..) = measures(&line, 10, 3);
        assert!((area - 2.06 * 1.03).abs() < 1e-13 && (perimeter - 2.06).abs() < 1e-13);
    }

    #[test]
    fn roots_that_only_bulge_through_are_found() {
        let roots = scan_roots(0.0, 1.0, 4, |t| {
            let s = t - 0.37;
            (s * s - 1e-8, 2.0 * s)
        });
        assert_eq!(roots.len(), 2);
        assert!((roots[1] - roots[0] - 2e-4).abs() < 1e-12);
    }
}
