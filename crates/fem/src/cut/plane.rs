//! Cells of lines and of the plane: columns of lines, each with the roots of the surfaces on it.

use super::height::height_functions;
use super::partition::{CellPartition, CellRule, QuadraturePoint, RegionId, SurfacePoint};
use super::roots::scan_roots;
use signorini_geometry::rule::gauss_legendre;
use signorini_geometry::{Aabb, Point, Vector};

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

#[cfg(test)]
mod tests;
