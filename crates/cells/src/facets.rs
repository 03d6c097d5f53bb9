//! Bodies bounded by a closed surface of triangles.
//!
//! Facets are clipped with the cell. With `F(x) = ∫_{x_0}^{min(x, x_1)} f dx` over a cell from `x_0` to `x_1`, the
//! divergence theorem in the column of the cell gives `∫_{cell ∩ body} f = Σ ∫_{facets at x > x_0} F n_x`: no test on
//! which side a point lies, and no case of how facets and cell meet. With `f` the Lagrange polynomials on fixed Gauss
//! points these integrals are the weights of a rule that is exact for the stiffness. Some weights may be negative.

use crate::error::CellsError;
use crate::polygon::{area_vector, clip, clip_line, fan, triangle_points};
use crate::region::{BoundaryPoint, FacetFoot, Filling, Integration, MaterialRule, Region};
use signorini_fem::QuadraturePoint;
use signorini_fem::cut::End;
use signorini_geometry::closest::FeatureKind;
use signorini_geometry::mesh::TriangleMesh;
use signorini_geometry::rule::gauss_legendre;
use signorini_geometry::{Aabb, Point, Vector};
use std::collections::BTreeMap;

/// The body inside a surface of triangles.
#[derive(Debug)]
pub struct FacetBody {
    mesh: TriangleMesh,
}

/// Share of the section of a column that an open surface may leave out or count twice.
const OPEN: f64 = 1e-3;
/// Columns in each direction in which a surface with holes is examined.
const COLUMNS: usize = 16;
/// Lines in each direction along which overlaps are looked for.
const LINES: usize = 32;

impl FacetBody {
    /// The body inside a surface, whose triangles are counter-clockwise seen from outside. Small holes are allowed.
    ///
    /// # Errors
    /// A surface so open that columns through it do not end.
    pub fn new(mesh: TriangleMesh) -> Result<Self, CellsError> {
        let body = FacetBody { mesh };
        if body.mesh.quality().has_inside() {
            body.check_overlap()?
        } else {
            body.check_columns()?
        }
        Ok(body)
    }

    /// Along lines through the body it begins and ends in turn: where it begins twice its parts overlap, or a cavity has its
    /// outside inwards, and the material there would count twice.
    fn check_overlap(&self) -> Result<(), CellsError> {
        let b = *self.mesh.bounds();
        let size = b.size();
        // Off the middle, where edges often lie.
        let at = |k: usize, n: usize| b.min[k] + size[k] * (n as f64 + 0.5 / (k as f64 + 0.414)) / LINES as f64;
        let mut roots: BTreeMap<[usize; 2], Vec<(f64, f64)>> = BTreeMap::new();
        for k in 0..self.mesh.triangles().len() {
            let corners = self.mesh.corners(k);
            let across = |p: [f64; 2], i: usize, j: usize| {
                (corners[i][1] - p[0]) * (corners[j][2] - p[1]) - (corners[i][2] - p[1]) * (corners[j][1] - p[0])
            };
            let lines = |axis: usize| {
                let low = corners.iter().map(|c| c[axis]).fold(f64::INFINITY, f64::min);
                let high = corners.iter().map(|c| c[axis]).fold(f64::NEG_INFINITY, f64::max);
                (0..LINES).filter(move |n| (low..=high).contains(&at(axis, *n)))
            };
            for m in lines(2) {
                for n in lines(1) {
                    let p = [at(1, n), at(2, m)];
                    let w = [across(p, 1, 2), across(p, 2, 0), across(p, 0, 1)];
                    let sum: f64 = w.iter().sum();
                    if sum != 0.0 && w.iter().all(|w| w * sum > 0.0) {
                        let x = (0..3).map(|i| w[i] * corners[i][0]).sum::<f64>() / sum;
                        // The body begins where its outward normal looks back.
                        roots.entry([n, m]).or_default().push((x, -sum.signum()));
                    }
                }
            }
        }
        for ([n, m], mut list) in roots {
            list.sort_by(|a, b| a.0.total_cmp(&b.0));
            let mut count = 0.0;
            for pair in list.windows(2) {
                count += pair[0].1;
                if !(0.0..=1.0).contains(&count) && pair[1].0 - pair[0].0 > OPEN * size[0] {
                    let at = vec![0.5 * (pair[0].0 + pair[1].0), at(1, n), at(2, m)];
                    return Err(CellsError::OverlappingSurface { at });
                }
            }
        }
        Ok(())
    }

    fn check_columns(&self) -> Result<(), CellsError> {
        let b = *self.mesh.bounds();
        let size = b.size();
        for i in 0..COLUMNS * COLUMNS {
            let at = |k: usize, n: usize| b.min[k] + size[k] * n as f64 / COLUMNS as f64;
            let (j, k) = (i % COLUMNS, i / COLUMNS);
            let column = Aabb::new(
                Point::<3>::new(b.min[0] - size[0], at(1, j), at(2, k)),
                Point::<3>::new(b.max[0] + size[0], at(1, j + 1), at(2, k + 1)),
            );
            let section = (size[1] * size[2]) / (COLUMNS * COLUMNS) as f64;
            let sum: f64 = self.pieces(&column).iter().map(|(_, p)| area_vector(p)[0]).sum();
            if sum.abs() > OPEN * section {
                let middle = column.center();
                return Err(CellsError::OpenSurface { y: middle[1], z: middle[2], share: sum.abs() / section });
            }
        }
        Ok(())
    }

    /// The triangles clipped with the column of a box, from its lower end in the first direction on, with their number.
    fn pieces(&self, b: &Aabb<3>) -> Vec<(usize, Vec<Point<3>>)> {
        let mut out = Vec::new();
        for k in 0..self.mesh.triangles().len() {
            let corners = self.mesh.corners(k);
            let apart = |axis: usize| {
                let (low, high) = corners
                    .iter()
                    .fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), c| (l.min(c[axis]), h.max(c[axis])));
                high < b.min[axis] || (axis > 0 && low > b.max[axis])
            };
            if (0..3).any(apart) {
                continue;
            }
            let mut polygon = clip(corners.to_vec(), 0, b.min[0], 1.0);
            for axis in 1..3 {
                polygon = clip(clip(polygon, axis, b.min[axis], 1.0), axis, b.max[axis], -1.0);
            }
            if polygon.len() > 2 {
                out.push((k, polygon));
            }
        }
        out
    }

    fn facet_normal(&self, triangle: usize) -> Vector<3> {
        let [a, b, c] = self.mesh.corners(triangle);
        (b - a).cross(&(c - a)).try_normalize(0.0).unwrap_or_default()
    }
}

impl Region<3> for FacetBody {
    fn rule(&self, b: &Aabb<3>, _: &Integration, degree: usize) -> MaterialRule<3> {
        let line = gauss_legendre(2 * degree + 1);
        let (n, size) = (line.len(), b.size());
        let nodes: Vec<f64> = line.iter().map(|p| p.0).collect();
        let weights: Vec<f64> = line.iter().map(|p| p.1).collect();
        let lagrange = Lagrange::new(nodes.clone());
        // Of facets beyond the cell only their shadow on it counts.
        let mut shadow = vec![0.0; n * n];
        let mut moments = vec![0.0; n * n * n];
        let mut boundary = Vec::new();
        let unit = |x: &Point<3>, k: usize| (x[k] - b.min[k]) / size[k];
        for (triangle, polygon) in self.pieces(b) {
            let normal = self.facet_normal(triangle);
            let within = clip(polygon.clone(), 0, b.max[0], -1.0);
            let slack = 1e-12 * size[0];
            let beyond = clip(polygon, 0, b.max[0], 1.0);
            let reaches = |p: &[Point<3>], sign: f64| p.iter().any(|x| sign * (x[0] - b.max[0]) > slack);
            let lies_on_end = !reaches(&within, -1.0);
            for part in fan(&beyond) {
                if lies_on_end || reaches(&beyond, 1.0) {
                    for (x, w) in triangle_points(&part, 2 * degree + 1) {
                        let (y, z) = (lagrange.values(unit(&x, 1)), lagrange.values(unit(&x, 2)));
                        for j in 0..n {
                            (0..n).for_each(|k| shadow[n * k + j] += w * normal[0] * y[j] * z[k]);
                        }
                    }
                }
            }
            if on_material_side(&within, b, &normal) {
                let points = fan(&within).flat_map(|part| triangle_points(&part, degree + 2));
                boundary.extend(points.map(|(x, weight)| BoundaryPoint { x, weight, normal }));
            }
            for part in fan(&within).filter(|_| !lies_on_end) {
                for (x, w) in triangle_points(&part, 3 * degree + 2) {
                    let integral = lagrange.integrals(unit(&x, 0));
                    let (y, z) = (lagrange.values(unit(&x, 1)), lagrange.values(unit(&x, 2)));
                    for k in 0..n {
                        for j in 0..n {
                            let c = w * normal[0] * size[0] * y[j] * z[k];
                            for i in 0..n {
                                moments[n * (n * k + j) + i] += c * integral[i];
                            }
                        }
                    }
                }
            }
        }
        let mut volume = Vec::with_capacity(n * n * n);
        let mut measure = 0.0;
        for k in 0..n {
            for j in 0..n {
                for i in 0..n {
                    let weight = moments[n * (n * k + j) + i] + size[0] * weights[i] * shadow[n * k + j];
                    measure += weight;
                    let xi = Point::<3>::new(nodes[i], nodes[j], nodes[k]);
                    volume.push(QuadraturePoint { x: b.at(&xi), weight });
                }
            }
        }
        let share = measure / b.volume();
        if share < 1e-13 {
            MaterialRule::empty(Filling::Void)
        } else if share > 1.0 - 1e-12 && boundary.is_empty() {
            MaterialRule::empty(Filling::Full)
        } else if share > 1.0 - 1e-12 {
            MaterialRule { boundary, ..MaterialRule::empty(Filling::Full) }
        } else {
            MaterialRule { volume, boundary, ..MaterialRule::empty(Filling::Cut) }
        }
    }

    /// By 12 × 12 points, each in the material or not.
    fn side_rule(&self, b: &Aabb<3>, axis: usize, end: End, _: usize) -> Vec<QuadraturePoint<3>> {
        const SIDE: usize = 12;
        let others: Vec<usize> = (0..3).filter(|&k| k != axis).collect();
        let size = b.size();
        let weight = size[others[0]] * size[others[1]] / (SIDE * SIDE) as f64;
        let mut out = Vec::new();
        for i in 0..SIDE * SIDE {
            let mut x = if end == End::High { b.max } else { b.min };
            for (k, at) in others.iter().zip([i % SIDE, i / SIDE]) {
                x[*k] = b.min[*k] + size[*k] * (at as f64 + 0.5) / SIDE as f64;
            }
            let mut inside = x;
            inside[axis] -= 1e-9 * end.sign() * size[axis];
            if self.contains(&inside) {
                out.push(QuadraturePoint { x, weight });
            }
        }
        out
    }

    /// Points inside, and the middle of what each facet cuts out of the side: the section of a body that is small against a
    /// side ends within it.
    fn places_on_side(&self, b: &Aabb<3>, axis: usize, end: End) -> Vec<Point<3>> {
        let mut out: Vec<Point<3>> = self.side_rule(b, axis, end, 0).iter().map(|p| p.x).collect();
        let at = end.of(b, axis);
        // Off the corners of facets that lie in the side.
        let height = at - 1e-9 * end.sign() * b.size()[axis];
        for k in 0..self.mesh.triangles().len() {
            let corners = self.mesh.corners(k);
            let cuts: Vec<Point<3>> = [[0, 1], [1, 2], [2, 0]]
                .iter()
                .map(|[i, j]| [corners[*i], corners[*j]])
                .filter(|[p, q]| (p[axis] >= height) != (q[axis] >= height))
                .map(|[p, q]| p + (q - p) * ((height - p[axis]) / (q[axis] - p[axis])))
                .collect();
            let [p, q] = cuts[..] else { continue };
            let mut line = vec![p, q];
            for k in (0..3).filter(|k| *k != axis) {
                line = clip_line(&clip_line(&line, k, b.min[k], 1.0), k, b.max[k], -1.0);
            }
            if let [p, q] = line[..] {
                let mut middle = p + (q - p) * 0.5;
                middle[axis] = at;
                out.push(middle);
            }
        }
        out
    }

    fn contains(&self, x: &Point<3>) -> bool {
        let foot = self.mesh.closest(x, 0.0)[0];
        foot.gap.unwrap_or_else(|| (x - foot.point).dot(&foot.normal)) < 0.0
    }

    fn has_points_in_material(&self) -> bool {
        false
    }

    fn facet_at(&self, x: &Point<3>) -> Option<FacetFoot<3>> {
        let foot = *self.mesh.closest(x, 0.0).first()?;
        let face = self.facet_normal(foot.triangle);
        let [a, b, c] = self.mesh.corners(foot.triangle);
        // Triangles that share a plane have no edge between them.
        let is_flat = foot.normal.dot(&face) > 1.0 - 1e-12;
        let planes = match foot.feature.kind {
            FeatureKind::Interior => vec![face],
            _ if is_flat => vec![face],
            FeatureKind::Edge => {
                let side = [b - a, c - a, c - b].into_iter().min_by(|s, t| {
                    // The side on which the point lies.
                    let off = |d: &Vector<3>, from: &Point<3>| (foot.point - from).cross(&d.normalize()).norm();
                    let at = |d: &Vector<3>| if *d == c - b { off(d, &b) } else { off(d, &a) };
                    at(s).total_cmp(&at(t))
                })?;
                vec![face, face.cross(&side).normalize()]
            }
            _ => vec![Vector::<3>::x(), Vector::<3>::y(), Vector::<3>::z()],
        };
        Some(FacetFoot { x: foot.point, planes, normal: foot.normal })
    }
}

/// Whether a piece within a box, or on a side of it with the material on this side, belongs to it.
fn on_material_side(part: &[Point<3>], b: &Aabb<3>, normal: &Vector<3>) -> bool {
    (0..3).all(|k| {
        let slack = 1e-12 * (b.max[k] - b.min[k]);
        let on = |at: f64| part.iter().all(|x| (x[k] - at).abs() <= slack);
        let beyond = (on(b.max[k]) && normal[k] < 0.0) || (on(b.min[k]) && normal[k] > 0.0);
        !beyond
    })
}

/// Lagrange polynomials on `[0, 1]`.
struct Lagrange {
    nodes: Vec<f64>,
    /// Products of differences of nodes.
    scale: Vec<f64>,
    gauss: Vec<(f64, f64)>,
}

impl Lagrange {
    fn new(nodes: Vec<f64>) -> Self {
        let others = |i: usize| (0..nodes.len()).filter(move |j| *j != i);
        let scale = (0..nodes.len()).map(|i| others(i).map(|j| nodes[i] - nodes[j]).product()).collect();
        let gauss = gauss_legendre(nodes.len().div_ceil(2));
        Lagrange { scale, nodes, gauss }
    }

    fn values(&self, x: f64) -> Vec<f64> {
        let n = self.nodes.len();
        let product = |i: usize| (0..n).filter(|j| *j != i).map(|j| x - self.nodes[j]).product::<f64>();
        (0..n).map(|i| product(i) / self.scale[i]).collect()
    }

    /// Integrals from 0 to `x`.
    fn integrals(&self, x: f64) -> Vec<f64> {
        let mut out = vec![0.0; self.nodes.len()];
        for (t, w) in &self.gauss {
            self.values(t * x).iter().zip(&mut out).for_each(|(v, o)| *o += w * x * v);
        }
        out
    }
}
