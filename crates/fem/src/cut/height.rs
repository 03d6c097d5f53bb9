//! Quadrature by height functions in one, two and three dimensions, by recursion over the dimension.
//!
//! After R. Saye, SIAM J. Sci. Comput. 37 (2015). With `k` the height direction of a box and `φ_i` its surfaces, the base
//! (the box without direction `k`) is resolved for the functions whose zeros are kinks of the integrals along `k`:
//!
//! - `φ_i` on the lower and on the upper face normal to `k`,
//! - for each pair `D_ij(s) = φ_i(s, t_j(s))`, with `t_j` the height of surface `j` kept within the box and
//!   `∇D_ij = ∇_s φ_i - (∂_k φ_i / ∂_k φ_j) ∇_s φ_j`: where two surfaces intersect.
//!
//! Above every base point the roots of all `φ_i` are found and Gauss points are put into each segment. A root carries a
//! surface point of weight `w |∇φ| / |∂_k φ|`. All weights are positive, and the points of all regions together
//! integrate the whole box.

mod sheet;

use super::partition::{CellPartition, CellRule, QuadraturePoint, SurfacePoint};
use sheet::{Crossing, IfFlat, MIN_SLOPE, Sheet, Slopes, crossing, slopes, steepest, with};
use signorini_geometry::rule::gauss_legendre;
use signorini_geometry::{Aabb, Point, Vector};

/// How often a box is halved before lines are searched for several roots instead.
const MAX_DEPTH: usize = 6;
/// Intervals of a line in which roots are searched where no direction serves, and on lines of the base.
const PIECES: usize = 8;

/// The quadrature of one cell with `order` Gauss points per direction and smooth piece, in up to three dimensions.
pub fn height_functions<const D: usize>(partition: &CellPartition<'_, D>, cell: &Aabb<D>, order: usize) -> CellRule<D> {
    let mut rule = CellRule::default();
    let sheets: Vec<Sheet<'_, D>> = partition.sheets.iter().map(|s| Sheet::Given(&**s)).collect();
    let numbered: Vec<(usize, &Sheet<'_, D>)> = sheets.iter().enumerate().collect();
    let axes: Vec<usize> = (0..D).collect();
    let resolver = Resolver { partition, gauss: gauss_legendre(order) };
    resolver.at_features(cell, &axes, &numbered, &mut rule);
    rule
}

/// An end of a box along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum End {
    Low,
    High,
}

impl End {
    pub const BOTH: [End; 2] = [End::Low, End::High];

    /// The coordinate of the end of a box.
    pub fn of<const D: usize>(self, b: &Aabb<D>, axis: usize) -> f64 {
        if self == End::High { b.max[axis] } else { b.min[axis] }
    }

    /// The component of the outward normal: -1 or 1.
    pub fn sign(self) -> f64 {
        if self == End::High { 1.0 } else { -1.0 }
    }
}

/// Quadrature of one region on a side of a box, with `order` Gauss points per direction.
pub fn side_points<const D: usize>(
    partition: &CellPartition<'_, D>,
    cell: &Aabb<D>,
    axis: usize,
    end: End,
    order: usize,
    region: u32,
) -> Vec<QuadraturePoint<D>> {
    let at = end.of(cell, axis);
    // Just within the box: a shape that ends on this side has its material there.
    let inwards = at - 1e-9 * end.sign() * cell.size()[axis];
    let given: Vec<Sheet<'_, D>> = partition.sheets.iter().map(|s| Sheet::Given(&**s)).collect();
    let sheets: Vec<Sheet<'_, D>> = given.iter().map(|of| Sheet::Face { of, axis, at: inwards }).collect();
    let numbered: Vec<(usize, &Sheet<'_, D>)> = sheets.iter().enumerate().collect();
    let axes: Vec<usize> = (0..D).filter(|&k| k != axis).collect();
    let b = Aabb::new(with(&cell.min, axis, inwards), with(&cell.max, axis, inwards));
    let mut rule = CellRule::default();
    let resolver = Resolver { partition, gauss: gauss_legendre(order) };
    let mut sink = Regions { partition, gauss: &resolver.gauss, region: 0, rule: &mut rule };
    if axes.is_empty() {
        sink.start_box(&b.min);
        sink.point(b.min, 1.0);
    } else {
        resolver.resolve(&b, &axes, &numbered, 0, &mut sink);
    }
    let found = rule.volume(region).iter();
    found.map(|p| QuadraturePoint { x: with(&p.x, axis, at), weight: p.weight }).collect()
}

/// What receives points.
trait Sink<const D: usize> {
    /// A box without zeros.
    fn start_box(&mut self, inside: &Point<D>);
    fn point(&mut self, x: Point<D>, weight: f64);
    /// The roots on a line through `x` in direction `k`, sorted, with the number of their sheet; the surfaces that are wanted
    /// are those of some sheets.
    fn roots(&mut self, x: &Point<D>, k: usize, ends: [f64; 2], roots: &[(f64, usize)], weight: f64, of: &[usize]);
}

struct Resolver<'a, const D: usize> {
    partition: &'a CellPartition<'a, D>,
    gauss: Vec<(f64, f64)>,
}

impl<const D: usize> Resolver<'_, D> {
    /// Splits a box at the features given for it.
    fn at_features(&self, b: &Aabb<D>, axes: &[usize], sheets: &[(usize, &Sheet<'_, D>)], rule: &mut CellRule<D>) {
        let inside = |x: &&Point<D>| (0..D).all(|k| strictly_within(b, k, x[k]));
        if let Some(feature) = self.partition.features.iter().find(inside) {
            for part in b.split_at(feature) {
                self.at_features(&part, axes, sheets, rule);
            }
            return;
        }
        let mut sink = Regions { partition: self.partition, gauss: &self.gauss, region: 0, rule };
        self.resolve(b, axes, sheets, 0, &mut sink);
    }

    fn resolve(
        &self,
        b: &Aabb<D>,
        axes: &[usize],
        sheets: &[(usize, &Sheet<'_, D>)],
        depth: usize,
        sink: &mut dyn Sink<D>,
    ) {
        let mut active: Vec<(usize, &Sheet<'_, D>)> = Vec::new();
        for &(number, sheet) in sheets {
            match crossing(sheet, b, axes) {
                Crossing::None => {}
                Crossing::Some => active.push((number, sheet)),
                Crossing::Hidden(x) => {
                    let split: Vec<usize> = axes.iter().copied().filter(|&k| strictly_within(b, k, x[k])).collect();
                    if depth < MAX_DEPTH && !split.is_empty() {
                        for part in parts(b, &split, &x) {
                            self.resolve(&part, axes, sheets, depth + 1, sink);
                        }
                        return;
                    }
                    active.push((number, sheet));
                }
            }
        }
        if active.is_empty() {
            return self.whole(b, axes, sink);
        }
        if let [k] = axes {
            return self.line((&b.min, 1.0), *k, b, &active, PIECES, &Column::of_all(&active), sink);
        }
        let flat = if depth < MAX_DEPTH { IfFlat::Divide } else { IfFlat::TakeSteepest };
        let slopes: Vec<Slopes<D>> = active.iter().map(|(_, sheet)| slopes(sheet, b, axes, flat)).collect();
        let (slope, k) =
            steepest(slopes.iter().fold(Vector::repeat(f64::INFINITY), |a: Vector<D>, s| a.inf(&s.least)), axes);
        if slope >= MIN_SLOPE {
            return self.columns(b, axes, &active, k, 1, &Column::of_all(&active), sink);
        }
        // Faces of a box, or a bore and the face that it ends in: what does not depend on a direction is no obstacle.
        let least = |k: usize| slopes.iter().filter(|s| !s.is_constant(k)).map(|s| s.least[k]).fold(1.0, f64::min);
        let allowed = axes.iter().copied().filter(|&k| slopes.iter().all(|s| s.allow(k, axes)));
        if let Some(k) = allowed.reduce(|a, c| if least(c) > least(a) { c } else { a }) {
            for (k, column) in columns(&active, &slopes, axes, k) {
                self.columns(b, axes, &active, k, 1, &column, sink);
            }
            return;
        }
        if depth < MAX_DEPTH {
            // A direction on which nothing depends needs no division.
            let split: Vec<usize> =
                axes.iter().copied().filter(|&k| slopes.iter().any(|s| !s.is_constant(k))).collect();
            for part in parts(b, &split, &b.center()) {
                self.resolve(&part, axes, &active, depth + 1, sink);
            }
            return;
        }
        for (k, column) in columns(&active, &slopes, axes, k) {
            self.columns(b, axes, &active, k, PIECES / 2, &column, sink);
        }
    }

    /// Lines in direction `k` above the points of the base.
    #[allow(clippy::too_many_arguments)]
    fn columns(
        &self,
        b: &Aabb<D>,
        axes: &[usize],
        active: &[(usize, &Sheet<'_, D>)],
        k: usize,
        pieces: usize,
        column: &Column,
        sink: &mut dyn Sink<D>,
    ) {
        let base: Vec<usize> = axes.iter().copied().filter(|&a| a != k).collect();
        let mut below: Vec<Sheet<'_, D>> = Vec::new();
        let on_lines = |number: usize| column.surfaces.contains(&number);
        for (i, &(number, of)) in active.iter().enumerate() {
            if column.constant.contains(&number) {
                below.push(Sheet::Face { of, axis: k, at: b.min[k] });
                continue;
            }
            if column.has_volume || on_lines(number) {
                below.extend([b.min[k], b.max[k]].map(|at| Sheet::Face { of, axis: k, at }));
            }
            for (j, &(other, graph)) in active.iter().enumerate() {
                // Of two that lines meet once one graph is enough.
                if i != j && on_lines(other) && (i < j || !on_lines(number)) {
                    below.push(Sheet::Graph { of, graph, axis: k, ends: [b.min[k], b.max[k]] });
                }
            }
        }
        let below: Vec<(usize, &Sheet<'_, D>)> = below.iter().enumerate().collect();
        let mut points = Points::default();
        self.resolve(b, &base, &below, 0, &mut points);
        for (x, weight) in points.0 {
            self.line((&x, weight), k, b, active, pieces, column, sink);
        }
    }

    /// The tensor-product Gauss rule of a box.
    fn whole(&self, b: &Aabb<D>, axes: &[usize], sink: &mut dyn Sink<D>) {
        let n = self.gauss.len();
        let (size, center) = (b.size(), b.center());
        let mut inside = b.min;
        axes.iter().for_each(|&k| inside[k] = center[k]);
        sink.start_box(&inside);
        for mut i in 0..n.pow(axes.len() as u32) {
            let (mut x, mut weight) = (b.min, 1.0);
            for &k in axes {
                let (t, w) = self.gauss[i % n];
                i /= n;
                x[k] = b.min[k] + t * size[k];
                weight *= w * size[k];
            }
            sink.point(x, weight);
        }
    }

    #[allow(clippy::too_many_arguments)]
    fn line(
        &self,
        (x, weight): (&Point<D>, f64),
        k: usize,
        b: &Aabb<D>,
        active: &[(usize, &Sheet<'_, D>)],
        pieces: usize,
        column: &Column,
        sink: &mut dyn Sink<D>,
    ) {
        let ends = [b.min[k], b.max[k]];
        let mut roots: Vec<(f64, usize)> = Vec::with_capacity(active.len());
        for &(number, sheet) in active {
            let found = sheet.roots(x, k, ends, pieces);
            roots.extend(found.into_iter().map(|t| (t, number)));
        }
        roots.sort_by(|a, c| a.0.total_cmp(&c.0));
        let mut from = ends[0];
        for to in roots.iter().map(|r| r.0).chain([ends[1]]).filter(|_| column.has_volume) {
            let length = to - from;
            if length > 1e-15 * (ends[1] - ends[0]) {
                sink.start_box(&with(x, k, 0.5 * (from + to)));
                for &(t, w) in &self.gauss {
                    sink.point(with(x, k, from + t * length), weight * w * length);
                }
            }
            from = to;
        }
        sink.roots(x, k, ends, &roots, weight, &column.surfaces);
    }
}

/// What lines in one direction give: the volumes, and the surfaces of these sheets.
struct Column {
    has_volume: bool,
    surfaces: Vec<usize>,
    /// Sheets that do not depend on the direction: their shadow on the base is all of them.
    constant: Vec<usize>,
}

impl Column {
    /// Of a direction that is steep for all sheets.
    fn of_all<const D: usize>(active: &[(usize, &Sheet<'_, D>)]) -> Self {
        Column { has_volume: true, surfaces: active.iter().map(|a| a.0).collect(), constant: Vec::new() }
    }
}

/// The directions of lines where none is steep for all sheets: one for the volumes, and for every sheet that is not steep
/// along it another one for its surface alone.
fn columns<const D: usize>(
    active: &[(usize, &Sheet<'_, D>)],
    slopes: &[Slopes<D>],
    axes: &[usize],
    k: usize,
) -> Vec<(usize, Column)> {
    if active.len() == 1 {
        return vec![(k, Column::of_all(active))];
    }
    let numbers = |holds: &dyn Fn(&Slopes<D>) -> bool| -> Vec<usize> {
        active.iter().zip(slopes).filter(|(_, s)| holds(s)).map(|(a, _)| a.0).collect()
    };
    let along = |s: &Slopes<D>| if s.least[k] >= MIN_SLOPE { k } else { steepest(s.least, axes).1 };
    let of = |a: usize| Column {
        has_volume: a == k,
        surfaces: numbers(&|s| along(s) == a),
        constant: numbers(&|s| s.is_constant(a)),
    };
    let others = axes.iter().copied().filter(|&a| a != k).map(|a| (a, of(a)));
    [(k, of(k))].into_iter().chain(others.filter(|(_, c)| !c.surfaces.is_empty())).collect()
}

/// Points of a base.
#[derive(Default)]
struct Points<const D: usize>(Vec<(Point<D>, f64)>);

impl<const D: usize> Sink<D> for Points<D> {
    fn start_box(&mut self, _: &Point<D>) {}
    fn point(&mut self, x: Point<D>, weight: f64) {
        self.0.push((x, weight));
    }
    fn roots(&mut self, _: &Point<D>, _: usize, _: [f64; 2], _: &[(f64, usize)], _: f64, _: &[usize]) {}
}

/// The rule of a cell.
struct Regions<'a, const D: usize> {
    partition: &'a CellPartition<'a, D>,
    gauss: &'a [(f64, f64)],
    region: u32,
    rule: &'a mut CellRule<D>,
}

impl<const D: usize> Regions<'_, D> {
    fn region_at(&self, x: &Point<D>) -> u32 {
        let values: Vec<f64> = self.partition.sheets.iter().map(|s| s.value(x)).collect();
        (self.partition.region)(x, &values)
    }
}

impl<const D: usize> Sink<D> for Regions<'_, D> {
    fn start_box(&mut self, inside: &Point<D>) {
        self.region = self.region_at(inside);
        self.rule.points_of(self.region).reserve(self.gauss.len());
    }

    fn point(&mut self, x: Point<D>, weight: f64) {
        self.rule.points_of(self.region).push(QuadraturePoint { x, weight });
    }

    /// Roots closer together than rounding can tell apart make one surface: that of the sheet which changes sign in the
    /// sense in which the region does.
    fn roots(&mut self, x: &Point<D>, k: usize, ends: [f64; 2], roots: &[(f64, usize)], weight: f64, of: &[usize]) {
        self.rule.cut |= !roots.is_empty();
        let same = 1e-11 * (ends[1] - ends[0]);
        let step = 1e-6 * (ends[1] - ends[0]);
        let mut first = 0;
        while first < roots.len() {
            let mut last = first;
            while last + 1 < roots.len() && roots[last + 1].0 - roots[first].0 <= same {
                last += 1;
            }
            let before = if first == 0 { f64::INFINITY } else { roots[first].0 - roots[first - 1].0 };
            let after = roots.get(last + 1).map_or(f64::INFINITY, |r| r.0 - roots[last].0);
            let below = self.region_at(&with(x, k, roots[first].0 - step.min(0.5 * before)));
            let above = self.region_at(&with(x, k, roots[last].0 + step.min(0.5 * after)));
            let (t, sheet) = roots[first];
            if below != above && of.contains(&sheet) {
                let at = with(x, k, t);
                let gradient = self.partition.sheets[sheet].gradient(&at);
                let norm = gradient.norm();
                let (minus, plus) = if gradient[k] > 0.0 { (below, above) } else { (above, below) };
                self.rule.surfaces.push(SurfacePoint {
                    x: at,
                    weight: weight * norm / gradient[k].abs().max(f64::MIN_POSITIVE),
                    normal: gradient / norm,
                    tag: self.partition.tags[sheet],
                    minus,
                    plus,
                });
            }
            first = last + 1;
        }
    }
}

fn strictly_within<const D: usize>(b: &Aabb<D>, k: usize, x: f64) -> bool {
    let slack = 1e-9 * (b.max[k] - b.min[k]);
    x > b.min[k] + slack && x < b.max[k] - slack
}

/// The parts of a box split at a point in some directions.
fn parts<const D: usize>(b: &Aabb<D>, axes: &[usize], x: &Point<D>) -> Vec<Aabb<D>> {
    let mut parts = vec![*b];
    for &k in axes {
        parts = parts
            .into_iter()
            .flat_map(|p| [Aabb::new(p.min, with(&p.max, k, x[k])), Aabb::new(with(&p.min, k, x[k]), p.max)])
            .collect();
    }
    parts
}

#[cfg(test)]
mod tests;
