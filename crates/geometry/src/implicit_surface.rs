//! Bodies given by functions that are negative inside: the exact closest point of their boundary.
//!
//! `φ/|∇φ|` is not a distance. Here the closest point solves `y - x + Σ λ_i ∇φ_i = 0`, `φ_i(y) = 0` by Newton, with one
//! function on a face of the body, two on an edge and three at a vertex of a union, intersection or difference. Newton
//! starts from a triangulation of the boundary on a grid, which makes the answer global up to features smaller than a
//! cell.

use std::sync::Arc;

use crate::closest::{FeatureKind, scaled_norm};
use crate::jet::Jet;
use crate::mesh::TriangleMesh;
use crate::shape::ShapeError;
use crate::{Aabb, Matrix, Point, Vector};

/// A twice differentiable function of position, negative inside.
pub trait ScalarField: Send + Sync {
    /// Value, gradient and Hessian.
    fn jet(&self, x: &Point<3>) -> Jet<3>;

    /// The value alone.
    fn value(&self, x: &Point<3>) -> f64 {
        self.jet(x).value
    }
}

impl<F: Fn(&Point<3>) -> Jet<3> + Send + Sync> ScalarField for F {
    fn jet(&self, x: &Point<3>) -> Jet<3> {
        self(x)
    }
}

/// A body built from functions.
#[derive(Clone)]
pub enum ImplicitBody {
    Field(Arc<dyn ScalarField>),
    Union(Vec<ImplicitBody>),
    Intersection(Vec<ImplicitBody>),
    /// What is not inside.
    Complement(Box<ImplicitBody>),
    /// Everything closer than a distance to a body, or deeper than it inside where it is negative.
    Offset(Arc<ImplicitSurface>, f64),
}

/// A function that takes part in a body, with the sign with which it does.
type Part<'a> = (&'a ImplicitBody, f64);

impl ImplicitBody {
    pub fn field(field: impl ScalarField + 'static) -> Self {
        ImplicitBody::Field(Arc::new(field))
    }

    /// What is inside this one and outside the other.
    pub fn difference(self, other: ImplicitBody) -> Self {
        ImplicitBody::Intersection(vec![self, ImplicitBody::Complement(Box::new(other))])
    }

    /// Negative inside.
    pub fn value(&self, x: &Point<3>) -> f64 {
        match self {
            ImplicitBody::Field(f) => f.value(x),
            ImplicitBody::Union(parts) => parts.iter().map(|p| p.value(x)).fold(f64::INFINITY, f64::min),
            ImplicitBody::Intersection(parts) => parts.iter().map(|p| p.value(x)).fold(f64::NEG_INFINITY, f64::max),
            ImplicitBody::Complement(body) => -body.value(x),
            ImplicitBody::Offset(surface, distance) => surface.closest(x).gap - distance,
        }
    }

    fn leaves<'a>(&'a self, sign: f64, out: &mut Vec<Part<'a>>) {
        match self {
            ImplicitBody::Field(_) | ImplicitBody::Offset(..) => out.push((self, sign)),
            ImplicitBody::Union(parts) | ImplicitBody::Intersection(parts) => {
                parts.iter().for_each(|p| p.leaves(sign, out));
            }
            ImplicitBody::Complement(body) => body.leaves(-sign, out),
        }
    }

    /// The jet of a leaf.
    fn leaf_jet(&self, x: &Point<3>) -> Jet<3> {
        match self {
            ImplicitBody::Field(f) => f.jet(x),
            ImplicitBody::Offset(surface, distance) => {
                let foot = surface.closest(x);
                Jet { value: foot.gap - distance, gradient: foot.normal, hessian: foot.hessian }
            }
            _ => unreachable!("only leaves have a jet"),
        }
    }
}

/// The boundary of a body inside a box.
pub struct ImplicitSurface {
    body: ImplicitBody,
    mesh: TriangleMesh,
    cell: f64,
}

/// The closest point of a boundary.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImplicitFoot {
    pub point: Point<3>,
    /// Distance, negative inside.
    pub gap: f64,
    /// The gradient of the gap: the unit normal, outward.
    pub normal: Vector<3>,
    /// The Hessian of the gap.
    pub hessian: Matrix<3>,
    /// Interior of a face, edge or vertex of the body.
    pub feature: FeatureKind,
    /// Another place at the same distance was found.
    pub unique: bool,
}

/// The most cells in one direction.
const MOST_CELLS: usize = 400;
const ITERATIONS: usize = 40;

impl std::fmt::Debug for ImplicitSurface {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("ImplicitSurface").field("bounds", self.mesh.bounds()).field("cell", &self.cell).finish()
    }
}

impl ImplicitSurface {
    /// The boundary of a body in a box, triangulated on `cells` cells along its longest side as the start of Newton.
    ///
    /// # Errors
    /// Values that are not finite, a box without extent, a boundary that does not enter the box.
    pub fn new(body: ImplicitBody, bounds: Aabb<3>, cells: usize) -> Result<Self, ShapeError> {
        crate::shape::check_position("box", &bounds.min)?;
        crate::shape::check_position("box", &bounds.max)?;
        if bounds.size().min() <= 0.0 {
            return Err(ShapeError::new("box", "its corners do not increase"));
        }
        if !(2..=MOST_CELLS).contains(&cells) {
            return Err(ShapeError::new("cells", format!("{cells} is not between 2 and {MOST_CELLS}")));
        }
        let cell = bounds.size().max() / cells as f64;
        let mesh = triangulate(&body, &bounds, cell)?;
        Ok(ImplicitSurface { body, mesh, cell })
    }

    pub fn body(&self) -> &ImplicitBody {
        &self.body
    }

    /// Side of a cell of the triangulation.
    pub fn cell(&self) -> f64 {
        self.cell
    }

    /// The triangulation from which Newton starts.
    pub fn mesh(&self) -> &TriangleMesh {
        &self.mesh
    }

    /// The closest point of the boundary.
    pub fn closest(&self, x: &Point<3>) -> ImplicitFoot {
        let size = self.mesh.size() + x.amax();
        // The chords of the triangulation are off by a share of a cell at most where it resolves the curvature.
        let starts = self.mesh.closest(x, 0.25 * self.cell);
        let mut leaves = Vec::new();
        self.body.leaves(1.0, &mut leaves);
        let mut found: Vec<(f64, Point<3>, Vec<usize>)> = Vec::new();
        for start in starts.iter().take(16) {
            for set in self.nearby(&leaves, &start.point) {
                let Some(y) = newton(x, &leaves, &set, start.point, size) else { continue };
                // The leaves in the set must make the boundary there.
                if self.body.value(&y).abs() > 1e-9 * size * gradient_scale(&leaves, &set, &y) {
                    continue;
                }
                let distance = scaled_norm(&(x - y));
                if found.iter().all(|(_, p, _)| (p - y).norm() > 1e-7 * size) {
                    found.push((distance, y, set));
                }
            }
        }
        found.sort_by(|p, q| p.0.total_cmp(&q.0));
        let Some((distance, y, set)) = found.first().cloned() else {
            // A boundary that is not smooth anywhere near: the triangulation is all there is.
            let foot = starts[0];
            let sign = if self.body.value(x) < 0.0 { -1.0 } else { 1.0 };
            let normal = (x - foot.point).try_normalize(0.0).map_or(foot.normal, |n| n * sign);
            return ImplicitFoot {
                point: foot.point,
                gap: sign * foot.distance,
                normal,
                hessian: Matrix::<3>::zeros(),
                feature: FeatureKind::Interior,
                unique: starts.len() == 1,
            };
        };
        let unique = found.get(1).is_none_or(|second| second.0 > distance + 1e-10 * size);
        let sign = if self.body.value(x) < 0.0 { -1.0 } else { 1.0 };
        let gap = sign * distance;
        let (normal, hessian) = self.variation(x, &y, gap, &leaves, &set);
        let feature = [FeatureKind::Interior, FeatureKind::Edge, FeatureKind::Vertex][set.len() - 1];
        ImplicitFoot { point: y, gap, normal, hessian, feature, unique }
    }

    /// Sets of one to three leaves that vanish near a point.
    fn nearby(&self, leaves: &[Part<'_>], y: &Point<3>) -> Vec<Vec<usize>> {
        let near: Vec<usize> = (0..leaves.len())
            .filter(|&k| {
                let jet = leaves[k].0.leaf_jet(y);
                jet.value.abs() <= 3.0 * self.cell * jet.gradient.norm()
            })
            .take(6)
            .collect();
        let n = near.len();
        let mut sets: Vec<Vec<usize>> = near.iter().map(|&k| vec![k]).collect();
        for i in 0..n {
            for j in i + 1..n {
                sets.push(vec![near[i], near[j]]);
                for k in j + 1..n {
                    sets.push(vec![near[i], near[j], near[k]]);
                }
            }
        }
        sets
    }

    /// Gradient and Hessian of the gap at `x` with foot `y`.
    fn variation(
        &self,
        x: &Point<3>,
        y: &Point<3>,
        gap: f64,
        leaves: &[Part<'_>],
        set: &[usize],
    ) -> (Vector<3>, Matrix<3>) {
        if let [only] = set {
            // On a face: S = P ∇∇φ P / |∇φ|, and S (I + g S)⁻¹ at the distance g; good at g = 0.
            let (leaf, sign) = leaves[*only];
            let jet = leaf.leaf_jet(y);
            let length = jet.gradient.norm();
            let normal = jet.gradient * (sign / length);
            let p = Matrix::<3>::identity() - normal * normal.transpose();
            let shape = p * jet.hessian * p * (sign / length);
            let hessian =
                (Matrix::<3>::identity() + shape * gap).try_inverse().map_or(shape, |inverse| shape * inverse);
            return (normal, (hessian + hessian.transpose()) * 0.5);
        }
        let normal = (x - y) / gap;
        if !normal.iter().all(|v| v.is_finite()) {
            // On the edge itself the normal is the mean of its faces.
            let mean: Vector<3> =
                set.iter().map(|&k| (leaves[k].0.leaf_jet(y).gradient * leaves[k].1).normalize()).sum();
            return (mean.try_normalize(0.0).unwrap_or_default(), Matrix::<3>::zeros());
        }
        // ∇∇g = (I - dy/dx - n nᵀ) / g, with dy/dx from the equations of the foot.
        let (matrix, _) = equations(x, leaves, set, y, &multipliers(x, leaves, set, y));
        let hessian = match matrix.try_inverse() {
            Some(inverse) => {
                let moved = Matrix::<3>::from_fn(|i, j| inverse[(i, j)]);
                (Matrix::<3>::identity() - moved - normal * normal.transpose()) / gap
            }
            None => Matrix::<3>::zeros(),
        };
        (normal, (hessian + hessian.transpose()) * 0.5)
    }
}

fn gradient_scale(leaves: &[Part<'_>], set: &[usize], y: &Point<3>) -> f64 {
    set.iter().map(|&k| leaves[k].0.leaf_jet(y).gradient.norm()).fold(0.0, f64::max).max(1e-300)
}

type Matrix6 = nalgebra::SMatrix<f64, 6, 6>;
type Vector6 = nalgebra::SVector<f64, 6>;

/// Least-squares multipliers of `y - x + Σ λ ∇φ = 0`.
fn multipliers(x: &Point<3>, leaves: &[Part<'_>], set: &[usize], y: &Point<3>) -> [f64; 3] {
    let gradients: Vec<Vector<3>> = set.iter().map(|&k| leaves[k].0.leaf_jet(y).gradient).collect();
    let n = set.len();
    let mut matrix = Matrix::<3>::identity();
    let mut rhs = Vector::<3>::zeros();
    for i in 0..n {
        rhs[i] = gradients[i].dot(&(x - y));
        for j in 0..n {
            matrix[(i, j)] = gradients[i].dot(&gradients[j]);
        }
    }
    matrix.lu().solve(&rhs).unwrap_or_default().into()
}

/// Jacobian and residual of the equations of the foot in `(y, λ)`; unused multipliers have unit rows.
fn equations(x: &Point<3>, leaves: &[Part<'_>], set: &[usize], y: &Point<3>, lambda: &[f64; 3]) -> (Matrix6, Vector6) {
    let mut matrix = Matrix6::identity();
    let mut residual = Vector6::zeros();
    let mut stationary = y - x;
    for (i, &k) in set.iter().enumerate() {
        let jet = leaves[k].0.leaf_jet(y);
        stationary += jet.gradient * lambda[i];
        residual[3 + i] = jet.value;
        matrix[(3 + i, 3 + i)] = 0.0;
        for a in 0..3 {
            matrix[(a, 3 + i)] = jet.gradient[a];
            matrix[(3 + i, a)] = jet.gradient[a];
            for b in 0..3 {
                matrix[(a, b)] += lambda[i] * jet.hessian[(a, b)];
            }
        }
    }
    for a in 0..3 {
        residual[a] = stationary[a];
    }
    (matrix, residual)
}

/// The foot of `x` on the common zero of a set of leaves, from a start near it.
fn newton(x: &Point<3>, leaves: &[Part<'_>], set: &[usize], start: Point<3>, size: f64) -> Option<Point<3>> {
    let mut y = start;
    let mut lambda = multipliers(x, leaves, set, &y);
    let merit = |y: &Point<3>, lambda: &[f64; 3]| {
        let (_, r) = equations(x, leaves, set, y, lambda);
        let constraint: f64 = set
            .iter()
            .enumerate()
            .map(|(i, &k)| (r[3 + i] / leaves[k].0.leaf_jet(y).gradient.norm().max(1e-300)).powi(2))
            .sum();
        (r.fixed_rows::<3>(0).norm_squared() + constraint).sqrt()
    };
    let mut value = merit(&y, &lambda);
    for _ in 0..ITERATIONS {
        if value <= 4.0 * f64::EPSILON * size {
            break;
        }
        let (matrix, residual) = equations(x, leaves, set, &y, &lambda);
        let step = matrix.lu().solve(&-residual)?;
        let mut length = 1.0;
        loop {
            let next = y + Vector::<3>::new(step[0], step[1], step[2]) * length;
            let multiplier = std::array::from_fn(|k| lambda[k] + length * step[3 + k]);
            let there = merit(&next, &multiplier);
            if there < value {
                (y, lambda, value) = (next, multiplier, there);
                break;
            }
            length *= 0.5;
            if length < 1e-4 {
                // As good as it gets: accept what rounding allows.
                return (value <= 1e-11 * size).then_some(y);
            }
        }
    }
    (value <= 1e-11 * size).then_some(y)
}

/// Marching tetrahedra: six to a cell, around its diagonal.
fn triangulate(body: &ImplicitBody, bounds: &Aabb<3>, cell: f64) -> Result<TriangleMesh, ShapeError> {
    let n: [usize; 3] = std::array::from_fn(|k| ((bounds.size()[k] / cell - 1e-9).ceil() as usize).max(1));
    let at = |i: usize, j: usize, k: usize| {
        bounds.at(&Point::<3>::new(i as f64 / n[0] as f64, j as f64 / n[1] as f64, k as f64 / n[2] as f64))
    };
    let number = |i: usize, j: usize, k: usize| (i * (n[1] + 1) + j) * (n[2] + 1) + k;
    let mut values = Vec::with_capacity((n[0] + 1) * (n[1] + 1) * (n[2] + 1));
    let mut positions = Vec::with_capacity(values.capacity());
    for i in 0..=n[0] {
        for j in 0..=n[1] {
            for k in 0..=n[2] {
                let x = at(i, j, k);
                let value = body.value(&x);
                if !value.is_finite() {
                    let message = format!("{value} at ({}, {}, {}); it must be finite in the box", x.x, x.y, x.z);
                    return Err(ShapeError::new("value", message));
                }
                values.push(value);
                positions.push(x);
            }
        }
    }
    let corner = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0], [0, 0, 1], [1, 0, 1], [0, 1, 1], [1, 1, 1]];
    // Paths from corner 0 to corner 7 along the axes.
    let tetrahedra = [[0, 1, 3, 7], [0, 3, 2, 7], [0, 2, 6, 7], [0, 6, 4, 7], [0, 4, 5, 7], [0, 5, 1, 7]];
    let mut vertices: Vec<Point<3>> = Vec::new();
    let mut on_edge: std::collections::HashMap<(usize, usize), u32> = std::collections::HashMap::new();
    let mut triangles: Vec<[u32; 3]> = Vec::new();
    for i in 0..n[0] {
        for j in 0..n[1] {
            for k in 0..n[2] {
                for t in tetrahedra {
                    let v = t.map(|c: usize| number(i + corner[c][0], j + corner[c][1], k + corner[c][2]));
                    let inside: Vec<usize> = v.iter().copied().filter(|&a| values[a] < 0.0).collect();
                    let outside: Vec<usize> = v.iter().copied().filter(|&a| values[a] >= 0.0).collect();
                    let mut cross = |a: usize, b: usize| {
                        *on_edge.entry((a.min(b), a.max(b))).or_insert_with(|| {
                            let share = values[a] / (values[a] - values[b]);
                            vertices.push(positions[a] + (positions[b] - positions[a]) * share);
                            vertices.len() as u32 - 1
                        })
                    };
                    let mut faces: Vec<[u32; 3]> = Vec::with_capacity(2);
                    match (inside.as_slice(), outside.as_slice()) {
                        ([a], [p, q, r]) | ([p, q, r], [a]) => {
                            faces.push([cross(*a, *p), cross(*a, *q), cross(*a, *r)])
                        }
                        ([a, b], [p, q]) => {
                            let quad = [cross(*a, *p), cross(*a, *q), cross(*b, *q), cross(*b, *p)];
                            faces.push([quad[0], quad[1], quad[2]]);
                            faces.push([quad[0], quad[2], quad[3]]);
                        }
                        _ => {}
                    }
                    // Outward: from the inside corners to the outside ones.
                    let mean =
                        |set: &[usize]| set.iter().map(|&a| positions[a]).sum::<Vector<3>>() / set.len().max(1) as f64;
                    let outward = mean(&outside) - mean(&inside);
                    for mut face in faces {
                        let x = face.map(|f| vertices[f as usize]);
                        if (x[1] - x[0]).cross(&(x[2] - x[0])).dot(&outward) < 0.0 {
                            face.swap(1, 2);
                        }
                        triangles.push(face);
                    }
                }
            }
        }
    }
    if triangles.is_empty() {
        return Err(ShapeError::new("box", "the boundary of the body does not enter it, or is finer than a cell"));
    }
    TriangleMesh::new(vertices, &triangles)
}

/// Values on a regular grid joined by a tricubic spline: twice continuously differentiable.
#[derive(Clone, Debug)]
pub struct SampledField {
    origin: Point<3>,
    spacing: [f64; 3],
    count: [usize; 3],
    coefficients: Vec<f64>,
}

impl SampledField {
    /// The spline through `values[(i * count[1] + j) * count[2] + k]` at `origin + (i, j, k) * spacing`. Beyond the grid
    /// it goes on as at the nearest point inside.
    ///
    /// # Errors
    /// Fewer than four values in a direction, another number of values than the grid has, values that are not finite,
    /// a spacing that is not positive.
    pub fn new(origin: Point<3>, spacing: [f64; 3], count: [usize; 3], values: &[f64]) -> Result<Self, ShapeError> {
        crate::shape::check_position("origin", &origin)?;
        if spacing.iter().any(|h| !(h.is_finite() && *h > 0.0)) {
            return Err(ShapeError::new("spacing", format!("{spacing:?} must be greater than zero")));
        }
        if count.iter().any(|&n| n < 4) {
            return Err(ShapeError::new("count", format!("{count:?}: a spline needs four values in each direction")));
        }
        let expected = count[0] * count[1] * count[2];
        if values.len() != expected {
            return Err(ShapeError::new("values", format!("{} numbers, the grid has {expected}", values.len())));
        }
        if let Some(value) = values.iter().find(|v| !v.is_finite()) {
            return Err(ShapeError::new("values", format!("{value} is not a finite number")));
        }
        let mut coefficients = values.to_vec();
        let strides = [count[1] * count[2], count[2], 1];
        for axis in 0..3 {
            let n = count[axis];
            let mut line = vec![0.0; n];
            for start in 0..expected {
                if !(start / strides[axis]).is_multiple_of(n) {
                    continue;
                }
                for (m, value) in line.iter_mut().enumerate() {
                    *value = coefficients[start + m * strides[axis]];
                }
                prefilter(&mut line);
                for (m, value) in line.iter().enumerate() {
                    coefficients[start + m * strides[axis]] = *value;
                }
            }
        }
        Ok(SampledField { origin, spacing, count, coefficients })
    }
}

/// Coefficients of the cubic spline with natural ends through values: `(c_{i-1} + 4 c_i + c_{i+1}) / 6 = f_i`, with
/// `c_{-1} = 2 c_0 - c_1` at both ends, so that the end coefficients are the end values.
fn prefilter(f: &mut [f64]) {
    let n = f.len();
    let inner = n - 2;
    // Thomas on the inner unknowns, the ends being known.
    let mut diagonal = vec![4.0; inner];
    let mut rhs: Vec<f64> = (1..=inner).map(|i| 6.0 * f[i]).collect();
    rhs[0] -= f[0];
    rhs[inner - 1] -= f[n - 1];
    for i in 1..inner {
        let factor = 1.0 / diagonal[i - 1];
        diagonal[i] -= factor;
        rhs[i] -= factor * rhs[i - 1];
    }
    for i in (0..inner).rev() {
        let above = if i + 1 < inner { f[i + 2] } else { 0.0 };
        f[i + 1] = (rhs[i] - above) / diagonal[i];
    }
}

impl ScalarField for SampledField {
    fn jet(&self, x: &Point<3>) -> Jet<3> {
        let mut weights = [[[0.0; 4]; 3]; 3];
        let mut index = [[0usize; 4]; 3];
        let mut mirrored = [[[0.0f64; 2]; 4]; 3];
        for a in 0..3 {
            let n = self.count[a];
            let t = ((x[a] - self.origin[a]) / self.spacing[a]).clamp(0.0, (n - 1) as f64);
            let cell = (t.floor() as usize).min(n - 2);
            let s = t - cell as f64;
            let h = self.spacing[a];
            weights[a] = [
                [
                    (1.0 - s).powi(3) / 6.0,
                    (4.0 - 6.0 * s * s + 3.0 * s.powi(3)) / 6.0,
                    (1.0 + 3.0 * s + 3.0 * s * s - 3.0 * s.powi(3)) / 6.0,
                    s.powi(3) / 6.0,
                ],
                [
                    -0.5 * (1.0 - s).powi(2) / h,
                    (-2.0 * s + 1.5 * s * s) / h,
                    (0.5 + s - 1.5 * s * s) / h,
                    0.5 * s * s / h,
                ],
                [(1.0 - s) / (h * h), (3.0 * s - 2.0) / (h * h), (1.0 - 3.0 * s) / (h * h), s / (h * h)],
            ];
            for m in 0..4 {
                // Beyond the ends the coefficients go on in a straight line: 2 c_0 - c_1.
                let i = cell as i64 + m as i64 - 1;
                index[a][m] = i.clamp(0, n as i64 - 1) as usize;
                mirrored[a][m] = if i < 0 || i >= n as i64 { [2.0, -1.0] } else { [1.0, 0.0] };
            }
        }
        // Fold what lies beyond into the two outermost coefficients.
        for a in 0..3 {
            let n = self.count[a];
            for m in 0..4 {
                if mirrored[a][m][1] != 0.0 {
                    let (end, next) = if index[a][m] == 0 { (0, 1) } else { (n - 1, n - 2) };
                    for order in 0..3 {
                        let w = weights[a][order][m];
                        weights[a][order][m] = 0.0;
                        for l in 0..4 {
                            if l != m && index[a][l] == end && mirrored[a][l][1] == 0.0 {
                                weights[a][order][l] += 2.0 * w;
                            } else if l != m && index[a][l] == next {
                                weights[a][order][l] -= w;
                            }
                        }
                    }
                }
            }
        }
        let mut jet = Jet { value: 0.0, gradient: Vector::<3>::zeros(), hessian: Matrix::<3>::zeros() };
        for i in 0..4 {
            for j in 0..4 {
                for k in 0..4 {
                    let c =
                        self.coefficients[(index[0][i] * self.count[1] + index[1][j]) * self.count[2] + index[2][k]];
                    let w = |p: usize, q: usize, r: usize| weights[0][p][i] * weights[1][q][j] * weights[2][r][k] * c;
                    jet.value += w(0, 0, 0);
                    jet.gradient += Vector::<3>::new(w(1, 0, 0), w(0, 1, 0), w(0, 0, 1));
                    let (xy, xz, yz) = (w(1, 1, 0), w(1, 0, 1), w(0, 1, 1));
                    jet.hessian += Matrix::<3>::new(w(2, 0, 0), xy, xz, xy, w(0, 2, 0), yz, xz, yz, w(0, 0, 2));
                }
            }
        }
        jet
    }
}
