//! Bodies given by functions that are negative inside: the exact closest point of their boundary.
//!
//! `φ/|∇φ|` is not a distance. Here the closest point solves `y - x + Σ λ_i ∇φ_i = 0`, `φ_i(y) = 0` by Newton, with one
//! function on a face of the body, two on an edge and three at a vertex of a union, intersection or difference. Newton
//! starts from a triangulation of the boundary on a grid, which makes the answer global up to features smaller than a
//! cell.

mod triangulate;

use triangulate::triangulate;

use crate::feature::FeatureKind;
use crate::implicit::{ImplicitBody, ImplicitShape};
use crate::mesh::TriangleMesh;
use crate::scale::length;
use crate::shape::error::{self, ShapeError};
use crate::{Aabb, Matrix, Point, Vector};

/// A shape that takes part in a body, with the sign with which it does.
type Part<'a> = (&'a dyn ImplicitShape<3>, f64);

/// The shapes of a body with the signs that they have in it.
fn leaves<'a>(body: &'a ImplicitBody<3>, sign: f64, out: &mut Vec<Part<'a>>) {
    match body {
        ImplicitBody::Shape(shape) => out.push((&**shape, sign)),
        ImplicitBody::Union(parts) | ImplicitBody::Intersection(parts) => {
            parts.iter().for_each(|p| leaves(p, sign, out));
        }
        ImplicitBody::Complement(body) => leaves(body, -sign, out),
    }
}

/// The boundary of a body inside a box.
pub struct ImplicitSurface {
    body: ImplicitBody<3>,
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
    pub fn new(body: ImplicitBody<3>, bounds: Aabb<3>, cells: usize) -> Result<Self, ShapeError> {
        error::position("box", &bounds.min)?;
        error::position("box", &bounds.max)?;
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

    pub fn body(&self) -> &ImplicitBody<3> {
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
        self::leaves(&self.body, 1.0, &mut leaves);
        let mut found: Vec<(f64, Point<3>, Vec<usize>)> = Vec::new();
        for start in starts.iter().take(16) {
            for set in self.nearby(&leaves, &start.point) {
                let Some(y) = newton(x, &leaves, &set, start.point, size) else { continue };
                // The leaves in the set must make the boundary there.
                if self.body.value(&y).abs() > 1e-9 * size * gradient_scale(&leaves, &set, &y) {
                    continue;
                }
                let distance = length(&(x - y));
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
                let jet = leaves[k].0.jet(y);
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
            let jet = leaf.jet(y);
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
            let mean: Vector<3> = set.iter().map(|&k| (leaves[k].0.jet(y).gradient * leaves[k].1).normalize()).sum();
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
    set.iter().map(|&k| leaves[k].0.jet(y).gradient.norm()).fold(0.0, f64::max).max(1e-300)
}

type Matrix6 = nalgebra::SMatrix<f64, 6, 6>;
type Vector6 = nalgebra::SVector<f64, 6>;

/// Least-squares multipliers of `y - x + Σ λ ∇φ = 0`.
fn multipliers(x: &Point<3>, leaves: &[Part<'_>], set: &[usize], y: &Point<3>) -> [f64; 3] {
    let gradients: Vec<Vector<3>> = set.iter().map(|&k| leaves[k].0.jet(y).gradient).collect();
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
        let jet = leaves[k].0.jet(y);
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
            .map(|(i, &k)| (r[3 + i] / leaves[k].0.jet(y).gradient.norm().max(1e-300)).powi(2))
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
