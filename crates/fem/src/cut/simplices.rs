//! Quadrature on sub-cells: a lattice of small boxes, each of simplices, cut along chords.
//!
//! The rule of the published finite cell method (`10 × 10` sub-cells). The corners of the chord of a cut simplex are
//! roots along its edges, by bisection on the region itself, so that any region will do. The geometry is off by the
//! sagitta `s² κ / 8` of the chords, with `s` the size of a sub-cell, whatever the order.

use super::partition::{CellPartition, CellRule, QuadraturePoint, RegionId, SurfacePoint};
use signorini_geometry::rule::gauss_legendre;
use signorini_geometry::{Aabb, Point, Vector};

/// The rule of a cell in the plane or in space on `subdivision` sub-cells in each direction, exact for polynomials of
/// degree `2 order - D` on each; surfaces lie between `material` and anything else.
///
/// # Panics
/// In one dimension, where there are no chords.
pub fn sub_cells<const D: usize>(
    partition: &CellPartition<'_, D>,
    cell: &Aabb<D>,
    subdivision: usize,
    order: usize,
    material: RegionId,
) -> CellRule<D> {
    let region = |x: &Point<D>| {
        let values: Vec<f64> = partition.sheets.iter().map(|s| s.value(x)).collect();
        (partition.region)(x, &values)
    };
    let gauss = gauss_legendre(order);
    let mut rule = CellRule::default();
    let h = cell.size() / subdivision as f64;
    for mut number in 0..subdivision.pow(D as u32) {
        let low = Point::<D>::from_fn(|k, _| {
            let at = number % subdivision;
            number /= subdivision;
            cell.min[k] + h[k] * at as f64
        });
        let corners: Vec<Point<D>> = (0..1usize << D)
            .map(|c| Point::<D>::from_fn(|k, _| low[k] + if c >> k & 1 == 1 { h[k] } else { 0.0 }))
            .collect();
        let regions: Vec<RegionId> = corners.iter().map(&region).collect();
        if regions.iter().all(|r| *r == regions[0]) {
            let points = rule.points_of(regions[0]);
            for mut i in 0..order.pow(D as u32) {
                let mut weight = h.product();
                let x = Point::<D>::from_fn(|k, _| {
                    let (t, w) = gauss[i % order];
                    i /= order;
                    weight *= w;
                    low[k] + t * h[k]
                });
                points.push(QuadraturePoint { x, weight });
            }
            continue;
        }
        rule.cut = true;
        for path in paths::<D>() {
            // Kuhn's simplex of a permutation: from the lowest corner one axis after the other.
            let mut corner = 0;
            let mut simplex = vec![0usize];
            for k in path {
                corner |= 1 << k;
                simplex.push(corner);
            }
            let inside: Vec<bool> = simplex.iter().map(|&c| regions[c] == material).collect();
            let points: Vec<Point<D>> = simplex.iter().map(|&c| corners[c]).collect();
            let other = simplex.iter().map(|&c| regions[c]).find(|r| *r != material).unwrap_or(material);
            cut_simplex(&points, &inside, [material, other], &|x| region(x) == material, &gauss, &mut rule);
        }
    }
    rule
}

/// Bisection into `2^D` leaves down to a depth where the region changes, with the Gauss points of each leaf counted to the
/// region in which they lie: the classic rule, without a surface.
pub fn space_tree<const D: usize>(
    partition: &CellPartition<'_, D>,
    cell: &Aabb<D>,
    depth: usize,
    order: usize,
) -> CellRule<D> {
    let mut rule = CellRule::default();
    let gauss = gauss_legendre(order);
    let region = |x: &Point<D>| {
        let values: Vec<f64> = partition.sheets.iter().map(|s| s.value(x)).collect();
        (partition.region)(x, &values)
    };
    let mut stack = vec![(*cell, 0)];
    while let Some((b, level)) = stack.pop() {
        let known = partition.sheets.iter().all(|s| s.range(&b).is_some_and(|[low, high]| low > 0.0 || high < 0.0));
        // Five samples in each direction: what is smaller than a quarter of a leaf is not seen.
        let mut lattice = (0..5usize.pow(D as u32))
            .map(|i| b.at(&Point::<D>::from_fn(|k, _| (i / 5usize.pow(k as u32) % 5) as f64 / 4.0)));
        let first = region(&b.min);
        let cut = !known && lattice.any(|x| region(&x) != first);
        if cut && level < depth {
            stack.extend(b.split_at(&b.center()).into_iter().rev().map(|part| (part, level + 1)));
            continue;
        }
        rule.cut |= cut;
        for mut i in 0..order.pow(D as u32) {
            let mut weight = b.volume();
            let x = b.at(&Point::<D>::from_fn(|_, _| {
                let (t, w) = gauss[i % order];
                i /= order;
                weight *= w;
                t
            }));
            rule.points_of(if cut { region(&x) } else { first }).push(QuadraturePoint { x, weight });
        }
    }
    rule
}

/// All orders of the axes.
fn paths<const D: usize>() -> Vec<Vec<usize>> {
    match D {
        2 => vec![vec![0, 1], vec![1, 0]],
        _ => vec![vec![0, 1, 2], vec![0, 2, 1], vec![1, 0, 2], vec![1, 2, 0], vec![2, 0, 1], vec![2, 1, 0]],
    }
}

/// The parts of a simplex in and out of the material, and the chord between them.
fn cut_simplex<const D: usize>(
    points: &[Point<D>],
    inside: &[bool],
    regions: [RegionId; 2],
    is_inside: &dyn Fn(&Point<D>) -> bool,
    gauss: &[(f64, f64)],
    rule: &mut CellRule<D>,
) {
    let [ins, outs] = [true, false].map(|side| (0..=D).filter(|&i| inside[i] == side).collect::<Vec<usize>>());
    if ins.is_empty() || outs.is_empty() {
        return simplex_rule(points, regions[usize::from(ins.is_empty())], gauss, rule);
    }
    let crossing = |i: usize, o: usize| bisect(&points[i], &points[o], is_inside);
    // Crossings in rows: one row for each corner inside.
    let rows: Vec<Vec<Point<D>>> = ins.iter().map(|&i| outs.iter().map(|&o| crossing(i, o)).collect()).collect();
    let wedge = |a: [Point<D>; 3], b: [Point<D>; 3]| {
        // A prism between two triangles as three simplices.
        [vec![a[0], a[1], a[2], b[2]], vec![a[0], a[1], b[1], b[2]], vec![a[0], b[0], b[1], b[2]]]
    };
    match (ins.len(), outs.len()) {
        (1, _) | (_, 1) => {
            // One corner is cut off: a simplex, and what remains.
            let (apex, rest) = if ins.len() == 1 { (ins[0], &outs) } else { (outs[0], &ins) };
            let [near, far] = if ins.len() == 1 { regions } else { [regions[1], regions[0]] };
            let chord: Vec<Point<D>> =
                if ins.len() == 1 { rows[0].clone() } else { rows.iter().map(|r| r[0]).collect() };
            simplex_rule(&[vec![points[apex]], chord.clone()].concat(), near, gauss, rule);
            let far_points: Vec<Point<D>> = rest.iter().map(|&i| points[i]).collect();
            if D == 2 {
                simplex_rule(&[chord[0], chord[1], far_points[0]], far, gauss, rule);
                simplex_rule(&[chord[1], far_points[0], far_points[1]], far, gauss, rule);
            } else {
                let take = |v: &[Point<D>]| [v[0], v[1], v[2]];
                for part in wedge(take(&chord), take(&far_points)) {
                    simplex_rule(&part, far, gauss, rule);
                }
            }
            let outwards = points[outs[0]] - points[ins[0]];
            let sign = if area_vector(&chord).dot(&outwards) < 0.0 { -1.0 } else { 1.0 };
            facet_rule(&chord, sign, regions, gauss, rule);
        }
        _ => {
            // Two corners on each side: two prisms.
            let [[a, b], [c, d]] = [[rows[0][0], rows[0][1]], [rows[1][0], rows[1][1]]];
            let ([i, j], [k, l]) = ([ins[0], ins[1]].map(|n| points[n]), [outs[0], outs[1]].map(|n| points[n]));
            for part in wedge([i, a, b], [j, c, d]) {
                simplex_rule(&part, regions[0], gauss, rule);
            }
            for part in wedge([k, a, c], [l, b, d]) {
                simplex_rule(&part, regions[1], gauss, rule);
            }
            // The sense of both halves of the chord is that of the corners, also where they are thin or folded.
            let edges = [j - i, k - i, l - i];
            let sign = edges[0].dot(&cross(&edges[1], &edges[2])).signum();
            facet_rule(&[a, b, d], sign, regions, gauss, rule);
            facet_rule(&[a, d, c], sign, regions, gauss, rule);
        }
    }
}

/// The vector product in space.
fn cross<const D: usize>(a: &Vector<D>, b: &Vector<D>) -> Vector<D> {
    Vector::<D>::from_fn(|k, _| {
        let (p, q) = ((k + 1) % D, (k + 2) % D);
        a[p] * b[q] - a[q] * b[p]
    })
}

/// A normal of a segment of the plane as long as that, or of a triangle of space twice as long as its area.
fn area_vector<const D: usize>(corners: &[Point<D>]) -> Vector<D> {
    let edge = corners[1] - corners[0];
    if D == 2 {
        return Vector::<D>::from_fn(|k, _| if k == 0 { edge[1] } else { -edge[0] });
    }
    cross(&edge, &(corners[2] - corners[0]))
}

/// Where the region ends between a point inside and one outside.
fn bisect<const D: usize>(inside: &Point<D>, outside: &Point<D>, is_inside: &dyn Fn(&Point<D>) -> bool) -> Point<D> {
    let (mut a, mut b) = (0.0, 1.0);
    for _ in 0..52 {
        let middle = 0.5 * (a + b);
        if is_inside(&(inside + (outside - inside) * middle)) { a = middle } else { b = middle }
    }
    inside + (outside - inside) * (0.5 * (a + b))
}

/// Gauss points of a simplex, collapsed from the cube.
fn simplex_rule<const D: usize>(corners: &[Point<D>], region: RegionId, gauss: &[(f64, f64)], rule: &mut CellRule<D>) {
    let edges: Vec<Vector<D>> = (1..=D).map(|i| corners[i] - corners[0]).collect();
    let volume = crate::small::determinant(&signorini_geometry::Matrix::<D>::from_columns(&edges)).abs();
    if volume == 0.0 {
        return;
    }
    let points = rule.points_of(region);
    for mut i in 0..gauss.len().pow(D as u32) {
        // x = a (1 - b) (1 - c), b (1 - c), c.
        let (mut x, mut weight, mut shrink) = (corners[0], volume, 1.0);
        for k in (0..D).rev() {
            let (t, w) = gauss[i % gauss.len()];
            i /= gauss.len();
            x += edges[k] * (t * shrink);
            weight *= w * (1.0 - t).powi(k as i32);
            shrink *= 1.0 - t;
        }
        points.push(QuadraturePoint { x, weight });
    }
}

/// Surface points of a chord, with the sign that turns its own normal outwards.
fn facet_rule<const D: usize>(
    corners: &[Point<D>],
    sign: f64,
    [minus, plus]: [RegionId; 2],
    gauss: &[(f64, f64)],
    rule: &mut CellRule<D>,
) {
    let edges: Vec<Vector<D>> = (1..D).map(|i| corners[i] - corners[0]).collect();
    let normal = area_vector(corners) * sign;
    let area = normal.norm();
    if area == 0.0 {
        return;
    }
    let normal = normal / area;
    for mut i in 0..gauss.len().pow(D as u32 - 1) {
        let (mut x, mut weight, mut shrink) = (corners[0], area, 1.0);
        for k in (0..D - 1).rev() {
            let (t, w) = gauss[i % gauss.len()];
            i /= gauss.len();
            x += edges[k] * (t * shrink);
            weight *= w * (1.0 - t).powi(k as i32);
            shrink *= 1.0 - t;
        }
        rule.surfaces.push(SurfacePoint { x, weight, normal, tag: 0, minus, plus });
    }
}
